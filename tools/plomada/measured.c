#include "measured.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "saved.h"

#define MARK "OK PERF "
#define PS_PER_NS 1000.0

/* "COSTS 3 SCIA_TX longest_ns:2000". A first line begins a new answer. */
static void take_cost(measured_t *measured, const char *text)
{
    char name[RTA_NAME_MAX + 1], kind[16];
    unsigned long number, ns;

    if (sscanf(text, "COSTS %lu %31s %15[a-z]_ns:%lu", &number, name, kind, &ns) != 4 || number < 1 ||
        number > RTA_ROWS_MAX) {
        return;
    }
    if (number == 1 || measured->ended) {
        *measured = (measured_t){.rows = 0};
    }
    strcpy(measured->row[number - 1].name, name);
    measured->row[number - 1].time = (rta_ps_t)ns * PS_PER_NS;
    measured->row[number - 1].hold = strcmp(kind, "hold") == 0;
}

static void take_line(void *context, const char *line)
{
    measured_t *measured = context;
    const char *text = line + strlen(MARK);
    int lines;

    if (strncmp(line, MARK, strlen(MARK)) != 0) {
        return;
    }
    take_cost(measured, text);
    if (!measured->ended && measured->row[0].name[0] != '\0' && sscanf(text, "END lines:%d", &lines) == 1) {
        measured->ended = true;
        measured->rows = lines < RTA_ROWS_MAX ? lines : RTA_ROWS_MAX;
    }
}

static bool whole(const measured_t *measured)
{
    for (int i = 0; i < measured->rows; i++) {
        if (measured->row[i].name[0] == '\0') {
            return false;
        }
    }
    return measured->ended && measured->rows > 0;
}

bool measured_read(measured_t *measured, const char *path)
{
    char rest[SAVED_LINE];
    FILE *in = fopen(path, "r");

    if (in == NULL) {
        fprintf(stderr, "plomada rta: %s: %s\n", path, strerror(errno));
        return false;
    }
    *measured = (measured_t){.rows = 0};
    saved_read(in, take_line, measured, rest);
    fclose(in);
    if (!whole(measured)) {
        fprintf(stderr, "plomada rta: %s: no whole answer to #PERF COSTS in it; ask again\n", path);
        return false;
    }
    return true;
}

static const rta_ps_t *job_called(const measured_t *measured, const char *name, size_t length)
{
    for (int i = 0; i < measured->rows; i++) {
        if (!measured->row[i].hold && strlen(measured->row[i].name) == length &&
            strncmp(measured->row[i].name, name, length) == 0) {
            return &measured->row[i].time;
        }
    }
    return NULL;
}

/* Clock_swi is a job, TaskControl_height a row of TaskControl. */
rta_ps_t measured_cost(const measured_t *measured, const char *name)
{
    const rta_ps_t *time = job_called(measured, name, strlen(name));

    if (time == NULL) {
        time = job_called(measured, name, strcspn(name, "_"));
    }
    return time != NULL ? *time : 0.0;
}

rta_ps_t measured_hold(const measured_t *measured, const char **gate)
{
    rta_ps_t longest = 0.0;

    *gate = "-";
    for (int i = 0; i < measured->rows; i++) {
        if (measured->row[i].hold && measured->row[i].time > longest) {
            longest = measured->row[i].time;
            *gate = measured->row[i].name;
        }
    }
    return longest;
}

void measured_apply(const measured_t *measured, rta_table_t *table)
{
    const char *gate;
    const rta_ps_t hold = measured_hold(measured, &gate);

    for (int i = 0; i < table->rows; i++) {
        rta_row_t *row = &table->row[i];
        const rta_ps_t cost = measured_cost(measured, row->name);

        if (cost > 0.0) {
            row->cost = cost;
            row->accesses = 0;
            row->whole = true;
        }
        if (hold > 0.0) {
            row->blocking = row->blockings * hold;
        }
    }
}
