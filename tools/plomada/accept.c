#include "accept.h"

#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "commands.h"
#include "lines.h"
#include "output.h"
#include "sim/json.h"
#include "sim/scenarios/wires.h"
#include "terminal.h"
#include "world.h"

#define ITEMS_MAX 32

static const char usage[] =
    "usage: plomada accept --laser DEVICE --imu DEVICE --xbee DEVICE [OPTION]...\n\n"
    "A fresh board, item by item, without motors and propellers: the PC plays scanner, IMU, operator and "
    "airframe over three\n"
    "serial adapters. docs/acceptance.md says how to wire it. `plomada board` is a board to try it on.\n\n"
    "  --report PREFIX     writes PREFIX.md and PREFIX.json (default acceptance); a finished report there is "
    "kept unless --afresh\n"
    "  --pulses FILE       what a logic analyser records of the throttle pin meanwhile, by sigrok-cli -O "
    "csv\n"
    "  --bits LINE=FILE    the same of the board's transmit pin of a line (laser, imu, xbee): its bit times "
    "are measured; may be\n"
    "                      repeated\n"
    "  --power COMMAND     takes the board's power away and gives it back; without it you are asked to\n"
    "  --unattended        asks nobody: what needs somebody is skipped\n"
    "  --flight S          seconds in the air, 10..180 (default 180)\n"
    "  --items A,B,...     these only: ";
static const char usage_end[] =
    "\n"
    "  --afresh            begins anew; without it an interrupted acceptance goes on where it was "
    "(PREFIX.state)\n\n"
    "Exit status: 0 all of them passed, 1 one failed, or it was interrupted, 2 usage or no such device, 3 "
    "none failed, but "
    "one was skipped.\n";

enum { OPT_REPORT = 1, OPT_POWER, OPT_UNATTENDED, OPT_FLIGHT, OPT_ITEMS, OPT_AFRESH };

static const struct option long_options[] = {
    {"report", required_argument, NULL, OPT_REPORT},
    {"power", required_argument, NULL, OPT_POWER},
    {"unattended", no_argument, NULL, OPT_UNATTENDED},
    {"flight", required_argument, NULL, OPT_FLIGHT},
    {"items", required_argument, NULL, OPT_ITEMS},
    {"afresh", no_argument, NULL, OPT_AFRESH},
    LINE_BITS_OPTION,
    LINE_OPTIONS,
};

static const char *const verdicts[] = {
    [ACCEPT_OPEN] = "open", [ACCEPT_PASS] = "pass", [ACCEPT_FAIL] = "FAIL", [ACCEPT_SKIP] = "skipped"};

static struct {
    const char *report, *items;
    accept_means_t means;
    bool afresh;
} order;

static struct {
    accept_verdict_t verdict[ITEMS_MAX];
    char detail[ITEMS_MAX][ACCEPT_DETAIL_MAX];
    char date[32];
} found;

static bool complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada accept: %s: %s\n", subject, what);
    return false;
}

/* ---- arguments ---- */

static bool chosen(const char *name)
{
    const size_t length = strlen(name);

    for (const char *at = order.items; at != NULL;
         at = strchr(at, ',') != NULL ? strchr(at, ',') + 1 : NULL) {
        if (strncmp(at, name, length) == 0 && (at[length] == ',' || at[length] == '\0')) {
            return true;
        }
    }
    return order.items == NULL;
}

static bool read_items(const char *text)
{
    order.items = text;
    for (const char *at = text; at != NULL; at = strchr(at, ',') != NULL ? strchr(at, ',') + 1 : NULL) {
        bool known = false;

        for (int i = 0; i < accept_item_count; i++) {
            const size_t length = strlen(accept_items[i].name);

            known = known || (strncmp(at, accept_items[i].name, length) == 0 &&
                              (at[length] == ',' || at[length] == '\0'));
        }
        if (!known) {
            return complain("no such item, see --help", at);
        }
    }
    return true;
}

static bool read_flight(const char *text)
{
    char *end;

    order.means.flight_s = strtod(text, &end);
    return (*end == '\0' && order.means.flight_s >= 10.0 && order.means.flight_s <= 180.0) ||
           complain("not 10..180 s", text);
}

static bool read_option(int option, const char *argument)
{
    switch (option) {
    case OPT_REPORT:
        order.report = argument;
        return true;
    case OPT_POWER:
        order.means.power = argument;
        return true;
    case OPT_UNATTENDED:
        order.means.ask = false;
        return true;
    case OPT_FLIGHT:
        return read_flight(argument);
    case OPT_ITEMS:
        return read_items(argument);
    case OPT_AFRESH:
        order.afresh = true;
        return true;
    default:
        return false;
    }
}

static bool read_arguments(int argc, char **argv)
{
    memset(&order, 0, sizeof order);
    order.report = "acceptance";
    order.means = (accept_means_t){.ask = true, .flight_s = 180.0};
    return lines_read("accept", argc, argv, long_options, read_option, &order.means.lines) &&
           (optind == argc || complain("not understood", argv[optind]));
}

/* ---- what was found so far ---- */

static void name_file(char path[PATH_MAX], const char *suffix)
{
    snprintf(path, PATH_MAX, "%s.%s", order.report, suffix);
}

static bool is_there(const char *suffix)
{
    char path[PATH_MAX];

    name_file(path, suffix);
    return access(path, F_OK) == 0;
}

static bool write_file(const char *suffix, void (*content)(FILE *out))
{
    char path[PATH_MAX];
    output_t output = {.path = path};

    name_file(path, suffix);
    if (!output_open(&output)) {
        return false;
    }
    content(output.file);
    return output_close(&output);
}

static void write_state(FILE *out)
{
    for (int i = 0; i < accept_item_count; i++) {
        if (found.verdict[i] != ACCEPT_OPEN) {
            fprintf(out, "%s\t%d\t%s\n", accept_items[i].name, (int)found.verdict[i], found.detail[i]);
        }
    }
}

static void take_state(const char *name, int verdict, const char *detail)
{
    for (int i = 0; i < accept_item_count; i++) {
        if (strcmp(accept_items[i].name, name) == 0 && verdict > ACCEPT_OPEN && verdict <= ACCEPT_SKIP) {
            found.verdict[i] = (accept_verdict_t)verdict;
            snprintf(found.detail[i], sizeof found.detail[i], "%s", detail);
        }
    }
}

static void load_state(void)
{
    char path[PATH_MAX], line[512], name[32], detail[400];
    int verdict;

    name_file(path, "state");
    FILE *file = order.afresh ? NULL : fopen(path, "r");
    if (file == NULL) {
        return;
    }
    while (fgets(line, sizeof line, file) != NULL) {
        detail[0] = '\0';
        if (sscanf(line, "%31[^\t]\t%d\t%399[^\n]", name, &verdict, detail) >= 2) {
            take_state(name, verdict, detail);
        }
    }
    fclose(file);
    printf("going on with %s.state (--afresh begins anew)\n", order.report);
}

/* ---- what it comes to ---- */

#define ACCEPT_INCOMPLETE 3

static int count(accept_verdict_t verdict)
{
    int result = 0;

    for (int i = 0; i < accept_item_count; i++) {
        result += found.verdict[i] == verdict ? 1 : 0;
    }
    return result;
}

static int count_tried(void)
{
    return count(ACCEPT_PASS) + count(ACCEPT_FAIL);
}

static bool all_done(void)
{
    for (int i = 0; i < accept_item_count; i++) {
        if (chosen(accept_items[i].name) && found.verdict[i] == ACCEPT_OPEN) {
            return false;
        }
    }
    return true;
}

static int status(void)
{
    if (count(ACCEPT_FAIL) > 0 || !all_done()) {
        return 1;
    }
    return count(ACCEPT_SKIP) > 0 ? ACCEPT_INCOMPLETE : 0;
}

static const char *words(void)
{
    static char text[64];
    const int tried = count_tried();

    switch (status()) {
    case 0:
        snprintf(text, sizeof text, "passed: %d of %d items tried", tried, accept_item_count);
        break;
    case ACCEPT_INCOMPLETE:
        snprintf(text, sizeof text, "incomplete: %d of %d items tried", tried, accept_item_count);
        break;
    default:
        snprintf(text, sizeof text, "NOT passed: %d failed, %d of %d items tried", count(ACCEPT_FAIL), tried,
                 accept_item_count);
    }
    return text;
}

/* ---- the report ---- */

static const char *firmware_version(void)
{
    for (int i = 0; i < accept_item_count; i++) {
        if (strcmp(accept_items[i].name, "version") == 0 && found.verdict[i] == ACCEPT_PASS) {
            return found.detail[i];
        }
    }
    return "not told";
}

static void write_json(FILE *out)
{
    json_t json;

    json_begin(&json, out);
    json_flag(&json, "passed", status() == 0);
    json_text(&json, "verdict", words());
    json_whole(&json, "tried", count_tried());
    json_text(&json, "date", found.date);
    json_text(&json, "chip", "TMS320F28377S (LAUNCHXL-F28377S)");
    json_text(&json, "firmware", firmware_version());
    json_object(&json, "adapters");
    for (int i = 0; i < BOARD_WIRES; i++) {
        json_text(&json, wire_names[i], order.means.lines.path[i]);
    }
    json_close(&json);
    json_text(&json, "pulses",
              order.means.lines.pulses != NULL ? order.means.lines.pulses : "told by the board");
    json_array(&json, "items");
    for (int i = 0; i < accept_item_count; i++) {
        json_object(&json, NULL);
        json_text(&json, "item", accept_items[i].name);
        json_text(&json, "verdict", verdicts[found.verdict[i]]);
        json_text(&json, "detail", found.detail[i]);
        json_close(&json);
    }
    json_close(&json);
    json_end(&json);
}

static void write_markdown(FILE *out)
{
    fprintf(out, "# Acceptance of a board: %s\n\n%s, TMS320F28377S on a LAUNCHXL-F28377S, firmware: %s.\n",
            words(), found.date, firmware_version());
    fprintf(out,
            "Adapters: scanner %s, IMU %s, radio %s. Throttle pin: %s.\n\n| item | verdict | found "
            "|\n|---|---|---|\n",
            order.means.lines.path[BOARD_LASER], order.means.lines.path[BOARD_IMU],
            order.means.lines.path[BOARD_RADIO],
            order.means.lines.pulses != NULL ? order.means.lines.pulses : "told by the board, not measured");
    for (int i = 0; i < accept_item_count; i++) {
        fprintf(out, "| %s | %s | %s |\n", accept_items[i].title, verdicts[found.verdict[i]],
                found.detail[i]);
    }
}

static bool write_report(void)
{
    const time_t now = time(NULL);

    strftime(found.date, sizeof found.date, "%Y-%m-%dT%H:%M:%SZ", gmtime(&now));
    const bool json = write_file("json", write_json);
    return write_file("md", write_markdown) && json;
}

/* A report is one board's: that of the board before it is not lost to the next one. */
static bool is_of_another(void)
{
    return !order.afresh && is_there("json") && !is_there("state");
}

/* ---- the run ---- */

static bool radio_failed(void)
{
    for (int i = 0; i < accept_item_count; i++) {
        if (strcmp(accept_items[i].name, "radio") == 0) {
            return found.verdict[i] == ACCEPT_FAIL;
        }
    }
    return false;
}

static void try_item(int i)
{
    const accept_item_t *item = &accept_items[i];
    accept_verdict_t verdict;

    if (item->needs_radio && radio_failed()) {
        found.verdict[i] = ACCEPT_SKIP;
        snprintf(found.detail[i], sizeof found.detail[i], "needs the radio line");
        return;
    }
    verdict = item->run(&order.means, found.detail[i]);
    if (world_run_until(timeline_now() + SIM_MS)) {
        found.verdict[i] = verdict; /* else it was interrupted, and is open still */
        printf("%-8s %-9s %s\n", verdicts[verdict], item->name, found.detail[i]);
        fflush(stdout);
        (void)write_file("state", write_state); /* says so when it cannot */
    }
}

static void try_all(void)
{
    bool open = false;

    for (int i = 0; i < accept_item_count && !open; i++) {
        if (found.verdict[i] == ACCEPT_OPEN && chosen(accept_items[i].name)) {
            try_item(i);
            open = found.verdict[i] == ACCEPT_OPEN;
        }
    }
    if (open) {
        printf("interrupted: the same command goes on from here\n");
    }
}

static void forget_state(void)
{
    char path[PATH_MAX];

    name_file(path, "state");
    unlink(path);
}

/* Recordings are read, the report is written. */
static bool files_apart(void)
{
    static const char *const suffixes[] = {"state", "json", "md"};
    const lines_t *lines = &order.means.lines;
    output_use_t uses[] = {{"--report", NULL, true},
                           {"--pulses", lines->pulses, false},
                           {"--bits laser", lines->bits[BOARD_LASER], false},
                           {"--bits imu", lines->bits[BOARD_IMU], false},
                           {"--bits xbee", lines->bits[BOARD_RADIO], false}};
    char path[PATH_MAX];

    for (size_t i = 0; i < sizeof suffixes / sizeof suffixes[0]; i++) {
        name_file(path, suffixes[i]);
        uses[0].path = path;
        if (!output_apart("accept", uses, sizeof uses / sizeof uses[0])) {
            return false;
        }
    }
    return true;
}

static int run(void)
{
    world_config_t config = {.seed = 1, .quadrotor = quadrotor_default, .line = terminal_line};
    board_wire_t failed;
    const char *error;

    if (is_of_another()) {
        complain("the report of another acceptance; another --report PREFIX, or --afresh", order.report);
        return 2;
    }
    if (!files_apart()) {
        return 2;
    }
    memcpy(config.device, order.means.lines.path, sizeof config.device);
    terminal_begin();
    error = world_open(&config, &failed);
    if (error != NULL) {
        fprintf(stderr, "plomada accept: --%s %s: %s\n", wire_names[failed], order.means.lines.path[failed],
                error);
        return 2;
    }
    load_state();
    if (!write_file("state", write_state)) { /* better known before the flight than after it */
        world_close();
        return 2;
    }
    (void)world_run_until(SIM_S / 2); /* what still comes from before is no answer */
    try_all();
    world_close();
    if (!write_report()) {
        return 2;
    }
    if (all_done()) {
        forget_state();
    }
    printf("%s%s; %s.md, %s.json\n", status() == 0 && count_tried() == accept_item_count ? "ACCEPTED, " : "",
           words(), order.report, order.report);
    return status();
}

int command_accept(int argc, char **argv)
{
    if (!read_arguments(argc, argv)) {
        fprintf(stderr, "`plomada accept --help` tells more.\n");
        return 2;
    }
    if (order.means.lines.help) {
        fputs(usage, stdout);
        for (int i = 0; i < accept_item_count; i++) {
            printf("%s%s", i == 0 ? "" : ",", accept_items[i].name);
        }
        fputs(usage_end, stdout);
        return 0;
    }
    return run();
}
