#include "tools/rta/table.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define HEADER_NEEDED \
    "the first line must be name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings"
#define CELLS_MAX 16
#define CELL_SIZE (RTA_NAMES_MAX + 1)
#define LINE_SIZE 512
#define TIME_MAX_MS 100000.0
#define COUNT_MAX 100000
#define NO_BURST (-1)

typedef struct {
    char text[CELL_SIZE];
} cell_t;

static const char *const kind_names[] = {"hwi", "swi", "task"};
_Static_assert(sizeof kind_names / sizeof kind_names[0] == RTA_KINDS, "every kind has a name");

/* ---- one cell into one field: NULL, or what is wrong ---- */

static bool is_blank(const char *text)
{
    return text[0] == '\0' || strcmp(text, "-") == 0;
}

static const char *read_time(const char *text, rta_ps_t *time)
{
    size_t digits = strspn(text, "0123456789");
    size_t fraction = text[digits] == '.' ? strspn(text + digits + 1, "0123456789") : 0;
    double ms;

    if (digits == 0 || (text[digits] == '.' && fraction == 0) ||
        text[digits + (fraction > 0 ? fraction + 1 : 0)] != '\0') {
        return "not a time in ms";
    }
    ms = strtod(text, NULL);
    if (ms > TIME_MAX_MS) {
        return "over 100000 ms";
    }
    *time = round(ms * RTA_PS_PER_MS);
    return NULL;
}

static const char *read_positive_time(const char *text, rta_ps_t *time)
{
    const char *wrong = read_time(text, time);

    return wrong == NULL && *time == 0.0 ? "must be over 0" : wrong;
}

static const char *read_count(const char *text, int *count)
{
    size_t digits = strspn(text, "0123456789");

    if (digits == 0 || digits > 6 || text[digits] != '\0' || atoi(text) > COUNT_MAX) {
        return "not a whole number of 0..100000";
    }
    *count = atoi(text);
    return NULL;
}

static const char *set_name(rta_row_t *row, const char *text)
{
    if (text[0] == '\0') {
        return "missing";
    }
    if (strlen(text) > RTA_NAME_MAX) {
        return "longer than 31 characters";
    }
    for (const char *at = text; *at != '\0'; at++) {
        if (!isprint((unsigned char)*at) || strchr("\"\\=", *at) != NULL) {
            return "holds a character that names have not";
        }
    }
    strcpy(row->name, text);
    return NULL;
}

static const char *set_kind(rta_row_t *row, const char *text)
{
    for (int kind = 0; kind < RTA_KINDS; kind++) {
        if (strcasecmp(text, kind_names[kind]) == 0) {
            row->kind = (rta_kind_t)kind;
            return NULL;
        }
    }
    return "not hwi, swi or task";
}

static const char *set_priority(rta_row_t *row, const char *text)
{
    return read_count(text, &row->priority);
}

static const char *set_period(rta_row_t *row, const char *text)
{
    return read_positive_time(text, &row->period);
}

static const char *set_deadline(rta_row_t *row, const char *text)
{
    return read_positive_time(text, &row->deadline);
}

static const char *set_cost(rta_row_t *row, const char *text)
{
    return read_positive_time(text, &row->cost);
}

static const char *set_blocking(rta_row_t *row, const char *text)
{
    return is_blank(text) ? NULL : read_time(text, &row->blocking);
}

static const char *set_blockings(rta_row_t *row, const char *text)
{
    return is_blank(text) ? NULL : read_count(text, &row->blockings);
}

static const char *set_blocked_by(rta_row_t *row, const char *text)
{
    snprintf(row->blocked_by, sizeof row->blocked_by, "%s", is_blank(text) ? "" : text);
    return NULL;
}

static const char *set_jitter(rta_row_t *row, const char *text)
{
    return is_blank(text) ? NULL : read_time(text, &row->jitter);
}

static const char *set_accesses(rta_row_t *row, const char *text)
{
    return is_blank(text) ? NULL : read_count(text, &row->accesses);
}

static const char *set_burst_n(rta_row_t *row, const char *text)
{
    return is_blank(text) ? NULL : read_count(text, &row->burst_n);
}

static const char *set_burst_period(rta_row_t *row, const char *text)
{
    return is_blank(text) ? NULL : read_positive_time(text, &row->burst_period);
}

typedef struct {
    const char *name;
    const char *(*set)(rta_row_t *row, const char *text);
    bool tasks_only;
} column_t;

static const column_t columns[] = {
    {"name", set_name, false},
    {"kind", set_kind, false},
    {"priority", set_priority, true},
    {"period_ms", set_period, false},
    {"deadline_ms", set_deadline, true},
    {"cost_ms", set_cost, false},
    {"blocking_ms", set_blocking, true},
    {"blockings", set_blockings, true},
    {"accesses", set_accesses, false},
    {"burst_n", set_burst_n, false},
    {"burst_period_ms", set_burst_period, false},
    {"jitter_ms", set_jitter, false},
    {"blocked_by", set_blocked_by, true},
};
#define COLUMN_COUNT ((int)(sizeof columns / sizeof columns[0]))
#define FIXED_COLUMNS 8
#define FIRST_NUMBER 2

static const column_t *find_column(const char *name, size_t length)
{
    for (int i = 0; i < COLUMN_COUNT; i++) {
        if (strlen(columns[i].name) == length && strncmp(columns[i].name, name, length) == 0) {
            return &columns[i];
        }
    }
    return NULL;
}

/* ---- lines ---- */

typedef struct {
    const column_t *column[CELLS_MAX];
    int columns;
} header_t;

static bool fail(rta_error_t *error, const char *what, const char *why)
{
    snprintf(error->reason, sizeof error->reason, "%s%s%s", what, what[0] != '\0' ? ": " : "", why);
    return false;
}

/* Cells without the blanks around them; -1 when one is too long or there are too many. */
static int split(const char *line, cell_t cells[CELLS_MAX])
{
    int count = 0;

    for (const char *at = line;; at++) {
        const char *end = at + strcspn(at, ",");
        const char *last = end;

        while (at < end && isspace((unsigned char)*at)) {
            at++;
        }
        while (last > at && isspace((unsigned char)last[-1])) {
            last--;
        }
        if (count == CELLS_MAX || last - at >= CELL_SIZE) {
            return -1;
        }
        memcpy(cells[count].text, at, (size_t)(last - at));
        cells[count].text[last - at] = '\0';
        count++;
        if (*end == '\0') {
            return count;
        }
        at = end;
    }
}

static bool read_header(header_t *header, const cell_t *cells, int count, rta_error_t *error)
{
    for (int i = 0; i < FIXED_COLUMNS; i++) {
        if (i >= count || strcmp(cells[i].text, columns[i].name) != 0) {
            return fail(error, "", HEADER_NEEDED);
        }
    }
    for (header->columns = 0; header->columns < count; header->columns++) {
        const char *name = cells[header->columns].text;
        const column_t *column = find_column(name, strlen(name));

        for (int i = 0; i < header->columns; i++) {
            if (header->column[i] == column) {
                return fail(error, name, "twice");
            }
        }
        if (column == NULL) {
            return fail(error, name, "no such column");
        }
        header->column[header->columns] = column;
    }
    return true;
}

static bool check_row(const rta_row_t *row, rta_error_t *error)
{
    return (row->burst_n >= 0) == (row->burst_period > 0.0) ||
           fail(error, row->name, "burst_n and burst_period_ms go together");
}

static bool read_row(rta_table_t *table, const header_t *header, const cell_t *cells, int count,
                     rta_error_t *error)
{
    rta_row_t row = {.kind = RTA_HWI, .burst_n = NO_BURST};

    if (count != header->columns) {
        char why[64];

        snprintf(why, sizeof why, "%d cells, not %d", count, header->columns);
        return fail(error, "", why);
    }
    for (int i = 0; i < count; i++) {
        const char *wrong = NULL;

        if (!header->column[i]->tasks_only || row.kind == RTA_TASK) {
            wrong = header->column[i]->set(&row, cells[i].text);
        }
        if (wrong != NULL) {
            return fail(error, header->column[i]->name, wrong);
        }
    }
    if (rta_table_find(table, row.name, (int)strlen(row.name)) >= 0) {
        return fail(error, row.name, "twice");
    }
    if (table->rows == RTA_ROWS_MAX) {
        return fail(error, "", "over 64 rows");
    }
    table->row[table->rows++] = row;
    return check_row(&row, error);
}

static bool read_line(rta_table_t *table, header_t *header, const char *line, rta_error_t *error)
{
    cell_t cells[CELLS_MAX];
    int count;

    if (line[strspn(line, " \t\r")] == '\0' || line[0] == '#') {
        return true;
    }
    count = split(line, cells);
    if (count < 0) {
        return fail(error, "", "a cell is too long, or there are too many");
    }
    return header->columns == 0 ? read_header(header, cells, count, error)
                                : read_row(table, header, cells, count, error);
}

static bool check_names(const rta_table_t *table, rta_error_t *error)
{
    for (int i = 0; i < table->rows; i++) {
        const char *at = table->row[i].blocked_by;

        while (*at != '\0') {
            size_t length = strcspn(at, "+");

            if (rta_table_find(table, at, (int)length) < 0) {
                return fail(error, table->row[i].name, "blocked_by: no such row");
            }
            at += length + (at[length] == '+' ? 1U : 0U);
        }
    }
    return true;
}

bool rta_table_read(rta_table_t *table, const char *text, rta_error_t *error)
{
    header_t header = {.columns = 0};
    char line[LINE_SIZE];
    int index[RTA_ROWS_MAX];

    table->rows = 0;
    error->line = 0;
    while (*text != '\0') {
        size_t length = strcspn(text, "\n");

        error->line++;
        if (length >= sizeof line) {
            return fail(error, "", "line too long");
        }
        memcpy(line, text, length);
        line[length] = '\0';
        if (!read_line(table, &header, line, error)) {
            return false;
        }
        text += length + (text[length] == '\n' ? 1 : 0);
    }
    error->line = error->line > 0 ? error->line : 1;
    if (header.columns == 0) {
        return fail(error, "", HEADER_NEEDED);
    }
    return (rta_tasks(table, index) > 0 || fail(error, "", "no task in the table")) &&
           check_names(table, error);
}

int rta_table_find(const rta_table_t *table, const char *name, int length)
{
    for (int i = 0; i < table->rows; i++) {
        if ((int)strlen(table->row[i].name) == length &&
            strncmp(table->row[i].name, name, (size_t)length) == 0) {
            return i;
        }
    }
    return -1;
}

static bool set_number(rta_table_t *table, const char *assignment, rta_error_t *error)
{
    const char *equals = strchr(assignment, '=');
    const char *dot = equals;
    const column_t *column;
    const char *wrong;
    int row;

    while (dot != NULL && dot > assignment && *dot != '.') {
        dot--;
    }
    if (dot == NULL || *dot != '.') {
        return fail(error, assignment, "not ROW.COLUMN=VALUE");
    }
    row = rta_table_find(table, assignment, (int)(dot - assignment));
    column = find_column(dot + 1, (size_t)(equals - dot - 1));
    if (row < 0) {
        return fail(error, assignment, "no such row");
    }
    if (column == NULL || column < &columns[FIRST_NUMBER] || column->set == set_blocked_by ||
        (column->tasks_only && table->row[row].kind != RTA_TASK)) {
        return fail(error, assignment, "no such number in that row");
    }
    wrong = column->set(&table->row[row], equals + 1);
    return wrong == NULL || fail(error, assignment, wrong);
}

bool rta_table_set(rta_table_t *table, const char *const *assignment, int assignments, rta_error_t *error)
{
    error->line = 0;
    for (int i = 0; i < assignments; i++) {
        if (!set_number(table, assignment[i], error)) {
            return false;
        }
    }
    for (int i = 0; i < table->rows; i++) {
        if (!check_row(&table->row[i], error)) {
            return false;
        }
    }
    return true;
}
