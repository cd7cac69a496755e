#include "accept.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "commands.h"
#include "lines.h"
#include "sim/scenarios/wires.h"
#include "terminal.h"
#include "world.h"

#define ITEMS_MAX 32

static const char usage[] =
    "usage: plomada accept --laser DEVICE --imu DEVICE --xbee DEVICE [OPTION]...\n\n"
    "A fresh board, item by item, without motors and propellers: the PC plays scanner, IMU, operator and "
    "airframe over three\n"
    "serial adapters. docs/acceptance.md says how to wire it. `plomada board` is a board to try it on.\n\n"
    "  --report PREFIX     writes PREFIX.md and PREFIX.json (default acceptance)\n"
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
    "Exit status: 0 no item failed, 1 one did, or it was interrupted, 2 usage or no such device.\n";

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

static FILE *open_file(const char *suffix, const char *mode)
{
    char path[512];

    snprintf(path, sizeof path, "%s.%s", order.report, suffix);
    return fopen(path, mode);
}

static void keep_state(void)
{
    FILE *file = open_file("state", "w");

    if (file == NULL) {
        return;
    }
    for (int i = 0; i < accept_item_count; i++) {
        if (found.verdict[i] != ACCEPT_OPEN) {
            fprintf(file, "%s\t%d\t%s\n", accept_items[i].name, (int)found.verdict[i], found.detail[i]);
        }
    }
    fclose(file);
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
    FILE *file = order.afresh ? NULL : open_file("state", "r");
    char line[512], name[32], detail[400];
    int verdict;

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

/* ---- the report ---- */

static void write_string(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\') {
            fputc('\\', out);
        }
        fputc((unsigned char)*text < 0x20 ? ' ' : *text, out);
    }
    fputc('"', out);
}

static const char *firmware_version(void)
{
    for (int i = 0; i < accept_item_count; i++) {
        if (strcmp(accept_items[i].name, "version") == 0 && found.verdict[i] == ACCEPT_PASS) {
            return found.detail[i];
        }
    }
    return "not told";
}

static void write_json(FILE *out, const char *date, bool passed)
{
    fprintf(out,
            "{\n  \"passed\": %s,\n  \"date\": \"%s\",\n  \"chip\": \"TMS320F28377S (LAUNCHXL-F28377S)\",\n  "
            "\"firmware\": ",
            passed ? "true" : "false", date);
    write_string(out, firmware_version());
    fprintf(out, ",\n  \"adapters\": {");
    for (int i = 0; i < BOARD_WIRES; i++) {
        fprintf(out, "%s\"%s\": ", i == 0 ? "" : ", ", wire_names[i]);
        write_string(out, order.means.lines.path[i]);
    }
    fprintf(out, "},\n  \"pulses\": ");
    write_string(out, order.means.lines.pulses != NULL ? order.means.lines.pulses : "told by the board");
    fprintf(out, ",\n  \"items\": [");
    for (int i = 0; i < accept_item_count; i++) {
        fprintf(out, "%s\n    {\"item\": \"%s\", \"verdict\": \"%s\", \"detail\": ", i == 0 ? "" : ",",
                accept_items[i].name, verdicts[found.verdict[i]]);
        write_string(out, found.detail[i]);
        fputc('}', out);
    }
    fprintf(out, "\n  ]\n}\n");
}

static void write_markdown(FILE *out, const char *date, bool passed)
{
    fprintf(out, "# Acceptance of a board: %s\n\n%s, TMS320F28377S on a LAUNCHXL-F28377S, firmware: %s.\n",
            passed ? "passed" : "NOT passed", date, firmware_version());
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

static bool write_report(bool passed)
{
    const time_t now = time(NULL);
    char date[32];
    FILE *json = open_file("json", "w"), *markdown = open_file("md", "w");

    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", gmtime(&now));
    if (json != NULL && markdown != NULL) {
        write_json(json, date, passed);
        write_markdown(markdown, date, passed);
    }
    if (json != NULL) {
        fclose(json);
    }
    if (markdown != NULL) {
        fclose(markdown);
    }
    return (json != NULL && markdown != NULL) || complain("cannot be written", order.report);
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
        keep_state();
    }
}

static bool try_all(void)
{
    bool failed = false, open = false;

    for (int i = 0; i < accept_item_count && !open; i++) {
        if (found.verdict[i] == ACCEPT_OPEN && chosen(accept_items[i].name)) {
            try_item(i);
            open = found.verdict[i] == ACCEPT_OPEN;
        }
        failed = failed || found.verdict[i] == ACCEPT_FAIL;
    }
    if (open) {
        printf("interrupted: the same command goes on from here\n");
    }
    return !failed && !open;
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

static void forget_state(void)
{
    char path[512];

    snprintf(path, sizeof path, "%s.state", order.report);
    unlink(path);
}

static int run(void)
{
    world_config_t config = {
        .seed = 1, .terrain = terrain_flat, .quadrotor = quadrotor_default, .line = terminal_line};
    board_wire_t failed;
    const char *error;
    bool passed;

    memcpy(config.device, order.means.lines.path, sizeof config.device);
    terminal_begin();
    error = world_open(&config, &failed);
    if (error != NULL) {
        fprintf(stderr, "plomada accept: --%s %s: %s\n", wire_names[failed], order.means.lines.path[failed],
                error);
        return 2;
    }
    load_state();
    (void)world_run_until(SIM_S / 2); /* what still comes from before is no answer */
    passed = try_all();
    world_close();
    if (!write_report(passed)) {
        return 2;
    }
    if (all_done()) {
        forget_state();
    }
    printf("%s: %s.md, %s.json\n", passed ? "ACCEPTED" : "NOT ACCEPTED", order.report, order.report);
    return passed ? 0 : 1;
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
