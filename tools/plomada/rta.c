#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "measured.h"
#include "output.h"
#include "sim/json.h"
#include "tools/rta/analysis.h"
#include "tools/rta/table.h"

static const char usage[] =
    "usage: plomada rta [seed|plomada|plomada-est|FILE] [OPTION]...\n\n"
    "Response-time analysis of a table of tasks, Swis and interrupts: the seed's (default), this firmware's, "
    "the\n"
    "same with the releases of law EST, or a CSV file.\n"
    "Per task, times in ms: the demand W(D) up to its deadline as the seed computed it, with its horizons "
    "corrected, with\n"
    "the context switches of every job; the true worst response time, and the slack it leaves before the "
    "deadline.\n"
    "The first three look at the table alone; the options below change the response, load and growth.\n\n"
    "  --switch-ms MS      two context switches, per task job and per blocking (default 0.057; the first "
    "three as well)\n"
    "  --access-ms MS      one server access, for the column accesses (default 0.0093; the first three as "
    "well)\n"
    "  --jitter MS         every release may come this late (default 0)\n"
    "  --bursts            rows with burst_n come in frames of burst_n every burst_period_ms, not as endless "
    "streams\n"
    "  --chain A,B,...,Z   also the worst time from what releases A to the end of task Z, when each releases "
    "the next; with\n"
    "                      --bursts A may be an interrupt with burst_n: the last one of its frame\n"
    "  --set ROW.COLUMN=VALUE\n"
    "                      changes a number of the table; may be repeated\n"
    "  --measured FILE     a saved answer to #PERF COSTS (text, or a console log of XCTU): costs, responses, "
    "slack and growth\n"
    "                      of that board beside the table's; the other figures are then the board's\n"
    "  --json FILE         the same figures\n"
    "  --print             prints the table itself, as CSV, and does nothing else\n\n"
    "A FILE begins with name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings and may add\n"
    "accesses,burst_n,burst_period_ms,jitter_ms,blocked_by; kind is hwi, swi or task. --print shows an "
    "example.\n\n"
    "Exit status: 0 all deadlines hold, 1 one does not, 2 usage or not a table.\n";

enum {
    OPT_SWITCH = 1,
    OPT_ACCESS,
    OPT_JITTER,
    OPT_BURSTS,
    OPT_CHAIN,
    OPT_SET,
    OPT_MEASURED,
    OPT_JSON,
    OPT_PRINT,
    OPT_HELP
};

static const struct option long_options[] = {
    {"switch-ms", required_argument, NULL, OPT_SWITCH},
    {"access-ms", required_argument, NULL, OPT_ACCESS},
    {"jitter", required_argument, NULL, OPT_JITTER},
    {"bursts", no_argument, NULL, OPT_BURSTS},
    {"chain", required_argument, NULL, OPT_CHAIN},
    {"set", required_argument, NULL, OPT_SET},
    {"measured", required_argument, NULL, OPT_MEASURED},
    {"json", required_argument, NULL, OPT_JSON},
    {"print", no_argument, NULL, OPT_PRINT},
    {"help", no_argument, NULL, OPT_HELP},
    {NULL, 0, NULL, 0},
};

#define SETTINGS_MAX 64

typedef struct {
    const char *table_name, *json_path, *chain_text, *measured_path;
    const char *setting[SETTINGS_MAX];
    int settings;
    bool print, help;
    rta_options_t options;
    rta_table_t table; /* of the board, where one was measured */
    rta_table_t assumed;
    measured_t measured;
    int chain[RTA_ROWS_MAX];
    int chain_members;
} request_t;

static bool complain(const char *subject, const char *what)
{
    fprintf(stderr, "plomada rta: %s: %s\n", subject, what);
    return false;
}

/* ---- arguments ---- */

static bool read_ms(const char *text, rta_ps_t *time)
{
    char *end;
    double ms = strtod(text, &end);

    *time = round(ms * RTA_PS_PER_MS);
    return (strspn(text, "0123456789.") == strlen(text) && text[0] != '\0' && *end == '\0' &&
            ms <= 100000.0) ||
           complain(text, "not a time in ms");
}

static bool add_setting(request_t *request, const char *text)
{
    if (request->settings == SETTINGS_MAX) {
        return complain(text, "too many settings");
    }
    request->setting[request->settings++] = text;
    return true;
}

static bool read_option(request_t *request, int option, const char *argument)
{
    switch (option) {
    case OPT_SWITCH:
        return read_ms(argument, &request->options.switches);
    case OPT_ACCESS:
        return read_ms(argument, &request->options.access);
    case OPT_JITTER:
        return read_ms(argument, &request->options.jitter);
    case OPT_BURSTS:
        request->options.bursts = true;
        return true;
    case OPT_CHAIN:
        request->chain_text = argument;
        return true;
    case OPT_SET:
        return add_setting(request, argument);
    case OPT_MEASURED:
        request->measured_path = argument;
        return true;
    case OPT_JSON:
        request->json_path = argument;
        return true;
    case OPT_PRINT:
        request->print = true;
        return true;
    case OPT_HELP:
        request->help = true;
        return true;
    default:
        return false;
    }
}

static bool read_arguments(request_t *request, int argc, char **argv)
{
    int option;

    optind = 1;
    while ((option = getopt_long(argc, argv, "", long_options, NULL)) != -1) {
        if (!read_option(request, option, optarg)) {
            return false;
        }
    }
    if (optind < argc) {
        request->table_name = argv[optind++];
    }
    return optind == argc || complain(argv[optind], "one table is enough");
}

/* ---- the table ---- */

static const char *load_text(const char *name)
{
    static char text[RTA_TEXT_MAX];
    const char *builtin = rta_table_builtin(name);
    FILE *file;
    size_t count;

    if (builtin != NULL) {
        return builtin;
    }
    file = fopen(name, "r");
    if (file == NULL) {
        complain(name, "no table of that name, and no file that can be read");
        return NULL;
    }
    count = fread(text, 1, sizeof text, file);
    if (ferror(file) || count == sizeof text || memchr(text, '\0', count) != NULL) {
        complain(name, "not a text of less than 65536 characters");
        fclose(file);
        return NULL;
    }
    fclose(file);
    text[count] = '\0';
    return text;
}

static bool load_table(request_t *request, const char *text)
{
    rta_error_t error;

    if (!rta_table_read(&request->table, text, &error)) {
        fprintf(stderr, "plomada rta: %s:%d: %s\n", request->table_name, error.line, error.reason);
        return false;
    }
    return rta_table_set(&request->table, request->setting, request->settings, &error) ||
           complain("--set", error.reason);
}

static bool goes_before_last(const rta_table_t *table, const int *chain, int members)
{
    const rta_row_t *last = &table->row[chain[members - 1]];

    for (int i = 0; i < members - 1; i++) {
        const rta_row_t *row = &table->row[chain[i]];

        if (row == last || (row->kind == RTA_TASK && row->priority < last->priority)) {
            return false;
        }
    }
    return last->kind == RTA_TASK;
}

static bool read_chain(request_t *request)
{
    for (const char *at = request->chain_text; at != NULL;) {
        size_t length = strcspn(at, ",");
        int row = rta_table_find(&request->table, at, (int)length);

        if (row < 0 || request->chain_members == RTA_ROWS_MAX) {
            return complain(at, "--chain: no such row");
        }
        request->chain[request->chain_members++] = row;
        at = at[length] == ',' ? at + length + 1 : NULL;
    }
    return request->chain_members == 0 ||
           goes_before_last(&request->table, request->chain, request->chain_members) ||
           complain(request->chain_text,
                    "--chain: the last must be a task, and none before it of lower priority");
}

/* ---- report ---- */

static const char *ms(char text[32], rta_ps_t time)
{
    if (isinf(time)) {
        strcpy(text, "-");
    } else {
        snprintf(text, 32, "%.4f", time / RTA_PS_PER_MS);
    }
    return text;
}

static void print_task(const request_t *request, int task)
{
    const rta_row_t *row = &request->table.row[task];
    rta_ps_t response = rta_response(&request->table, &request->options, task);
    char text[5][32];

    printf("%-18s %4d %8g %10s %10s %10s %10s %10s%s\n", row->name, row->priority,
           row->deadline / RTA_PS_PER_MS,
           ms(text[0], rta_demand_seed(&request->table, &request->options, task)),
           ms(text[1], rta_demand(&request->table, &request->options, task)),
           ms(text[2], rta_demand_switching(&request->table, &request->options, task)), ms(text[3], response),
           isinf(response) ? "-" : ms(text[4], row->deadline - response),
           response > row->deadline ? "  LATE" : "");
}

static void print_growth(const request_t *request)
{
    rta_growth_t costs = rta_growth(&request->table, &request->options, false);
    rta_growth_t all = rta_growth(&request->table, &request->options, true);

    printf("growth: at %.2f times these costs %s is late; context switches too: %.2f\n", costs.factor,
           request->table.row[costs.first_missed].name, all.factor);
}

static void print_chain(const request_t *request)
{
    char text[32];

    if (request->chain_members > 0) {
        printf(
            "%s: %s\n", request->chain_text,
            ms(text, rta_chain(&request->table, &request->options, request->chain, request->chain_members)));
    }
}

/* ---- a board beside the table ---- */

static void print_costs(const request_t *request)
{
    const char *gate;
    const rta_ps_t hold = measured_hold(&request->measured, &gate);
    char text[2][32];

    printf("longest, with server accesses and switches\n%-18s %10s %10s\n", request->table_name, "table",
           "board");
    for (int i = 0; i < request->assumed.rows; i++) {
        const rta_row_t *row = &request->assumed.row[i];
        const rta_ps_t cost = measured_cost(&request->measured, row->name);
        const rta_ps_t assumed = row->cost + row->accesses * request->options.access +
                                 (row->kind == RTA_TASK ? request->options.switches : 0.0);

        printf("%-18s %10s %10s\n", row->name, ms(text[0], assumed),
               ms(text[1], cost > 0.0 ? cost : INFINITY));
    }
    printf("%-18s %10s %10s %s\n\n", "hold of a gate", ms(text[0], request->options.access),
           ms(text[1], hold > 0.0 ? hold : INFINITY), gate);
}

static void print_responses(const request_t *request)
{
    int task[RTA_ROWS_MAX];
    int tasks = rta_tasks(&request->table, task);

    printf("%-18s %8s %10s %10s %10s %10s\n", "response", "D", "table", "board", "slack", "board");
    for (int i = 0; i < tasks; i++) {
        const rta_row_t *row = &request->table.row[task[i]];
        const rta_ps_t assumed = rta_response(&request->assumed, &request->options, task[i]);
        const rta_ps_t board = rta_response(&request->table, &request->options, task[i]);
        char text[4][32];

        printf("%-18s %8g %10s %10s %10s %10s%s\n", row->name, row->deadline / RTA_PS_PER_MS,
               ms(text[0], assumed), ms(text[1], board), ms(text[2], row->deadline - assumed),
               isinf(board) ? "-" : ms(text[3], row->deadline - board),
               board > row->deadline ? "  LATE" : "");
    }
}

static void print_board(const request_t *request, bool holds)
{
    const rta_growth_t assumed = rta_growth(&request->assumed, &request->options, false);
    const rta_growth_t board = rta_growth(&request->table, &request->options, false);

    print_costs(request);
    print_responses(request);
    print_chain(request);
    printf("load: table %.4f, board %.4f\n", rta_load(&request->assumed, &request->options).total,
           rta_load(&request->table, &request->options).total);
    printf("growth: at %.2f times the table's costs %s is late, at %.2f times the board's %s\n",
           assumed.factor, request->table.row[assumed.first_missed].name, board.factor,
           request->table.row[board.first_missed].name);
    printf("%s on this board\n", holds ? "all deadlines hold" : "NOT all deadlines hold");
}

static void print_report(const request_t *request, bool holds)
{
    rta_load_t load = rta_load(&request->table, &request->options);
    int task[RTA_ROWS_MAX];
    int tasks = rta_tasks(&request->table, task);

    printf("%-18s %4s %8s %10s %10s %10s %10s %10s\n", request->table_name, "prio", "D", "seed W(D)", "W(D)",
           "switching", "response", "slack");
    for (int i = 0; i < tasks; i++) {
        print_task(request, task[i]);
    }
    print_chain(request);
    printf("load: hwi %.4f, swi %.4f, tasks %.4f, switches %.4f, total %.4f\n", load.kind[RTA_HWI],
           load.kind[RTA_SWI], load.kind[RTA_TASK], load.switches, load.total);
    print_growth(request);
    printf("%s\n", holds ? "all deadlines hold" : "NOT all deadlines hold");
}

static void write_json_ms(json_t *json, const char *key, rta_ps_t time)
{
    json_number(json, key, time / RTA_PS_PER_MS, 9);
}

static void write_json_task(json_t *json, const request_t *request, int task)
{
    const rta_table_t *table = &request->table;
    rta_ps_t response = rta_response(table, &request->options, task);

    json_object(json, NULL);
    json_text(json, "name", table->row[task].name);
    json_whole(json, "priority", table->row[task].priority);
    write_json_ms(json, "period_ms", table->row[task].period);
    write_json_ms(json, "deadline_ms", table->row[task].deadline);
    write_json_ms(json, "demand_seed_ms", rta_demand_seed(table, &request->options, task));
    write_json_ms(json, "demand_ms", rta_demand(table, &request->options, task));
    write_json_ms(json, "demand_switching_ms", rta_demand_switching(table, &request->options, task));
    write_json_ms(json, "response_ms", response);
    write_json_ms(json, "slack_ms", table->row[task].deadline - response);
    json_close(json);
}

static void write_json_load(json_t *json, const request_t *request)
{
    const rta_load_t load = rta_load(&request->table, &request->options);

    json_object(json, "load");
    json_fixed(json, "hwi", load.kind[RTA_HWI], 6);
    json_fixed(json, "swi", load.kind[RTA_SWI], 6);
    json_fixed(json, "tasks", load.kind[RTA_TASK], 6);
    json_fixed(json, "switches", load.switches, 6);
    json_fixed(json, "total", load.total, 6);
    json_close(json);
}

static void write_json(FILE *out, const request_t *request, bool holds)
{
    int task[RTA_ROWS_MAX];
    int tasks = rta_tasks(&request->table, task);
    json_t json;

    json_begin(&json, out);
    json_flag(&json, "holds", holds);
    json_array(&json, "tasks");
    for (int i = 0; i < tasks; i++) {
        write_json_task(&json, request, task[i]);
    }
    json_close(&json);
    write_json_load(&json, request);
    if (request->chain_members > 0) {
        json_object(&json, "chain");
        json_text(&json, "members", request->chain_text);
        write_json_ms(&json, "response_ms",
                      rta_chain(&request->table, &request->options, request->chain, request->chain_members));
        json_close(&json);
    }
    json_number(&json, "growth", rta_growth(&request->table, &request->options, false).factor, 6);
    json_number(&json, "growth_with_switches", rta_growth(&request->table, &request->options, true).factor,
                6);
    json_end(&json);
}

static int run(request_t *request)
{
    const char *text = load_text(request->table_name);
    output_t json = {.path = request->json_path};
    bool holds;

    if (text == NULL || !load_table(request, text) || !read_chain(request)) {
        return 2;
    }
    if (request->print) {
        fputs(text, stdout);
        return 0;
    }
    request->assumed = request->table;
    if (request->measured_path != NULL) {
        if (!measured_read(&request->measured, request->measured_path)) {
            return 2;
        }
        measured_apply(&request->measured, &request->table);
    }
    holds = rta_holds(&request->table, &request->options);
    if (!output_open(&json)) {
        return 2;
    }
    if (json.file != NULL) {
        write_json(json.file, request, holds);
    }
    if (!output_close(&json)) {
        return 2;
    }
    if (request->measured_path != NULL) {
        print_board(request, holds);
    } else {
        print_report(request, holds);
    }
    return holds ? 0 : 1;
}

int command_rta(int argc, char **argv)
{
    static request_t request;

    request.table_name = "seed";
    request.options.switches = round(0.057 * RTA_PS_PER_MS);
    request.options.access = round(0.0093 * RTA_PS_PER_MS);
    if (!read_arguments(&request, argc, argv)) {
        fprintf(stderr, "`plomada rta --help` tells more.\n");
        return 2;
    }
    if (request.help) {
        fputs(usage, stdout);
        return 0;
    }
    return run(&request);
}
