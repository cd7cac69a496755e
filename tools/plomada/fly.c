#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "sim/scenarios/flight.h"

static const char usage[] =
    "usage: plomada fly SCENARIO [OPTION]...\n\n"
    "Flies one scenario with the unmodified firmware on the PC board, in virtual time.\n\n"
    "  --seed N            noise, phases and turbulence (default 1)\n"
    "  --csv FILE          log at 100 Hz: t_s,height_m,abs_m,terrain_m,est_m,ref_m,thrust_n,pulse_us,state,flags\n"
    "  --json FILE         metrics\n"
    "  --set NAME=VALUE    a telecommand parameter (see `plomada params`) or a plant figure; may be repeated\n"
    "  --realtime --xbee pty|DEVICE\n"
    "                      paced by the wall clock with the radio on a pseudo-terminal (its name is the first line of\n"
    "                      the output) or an existing serial port at 9600; the scenario then sends no commands\n"
    "  --duration S        with --realtime: ends after S seconds (default: Ctrl-C ends it)\n\n"
    "Exit status: 0 the flight met the scenario's expectations, 1 it did not, 2 usage.\n\n"
    "Plant figures:\n";

enum { OPT_SEED = 1, OPT_CSV, OPT_JSON, OPT_SET, OPT_REALTIME, OPT_XBEE, OPT_DURATION, OPT_HELP };

static const struct option long_options[] = {
    {"seed", required_argument, NULL, OPT_SEED},         {"csv", required_argument, NULL, OPT_CSV},
    {"json", required_argument, NULL, OPT_JSON},         {"set", required_argument, NULL, OPT_SET},
    {"realtime", no_argument, NULL, OPT_REALTIME},       {"xbee", required_argument, NULL, OPT_XBEE},
    {"duration", required_argument, NULL, OPT_DURATION}, {"help", no_argument, NULL, OPT_HELP},
    {NULL, 0, NULL, 0},
};

typedef struct {
    flight_options_t flight;
    const scenario_t *scenario;
    const char *csv_path, *json_path;
    bool help;
} request_t;

static bool complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada fly: %s: %s\n", subject, what);
    return false;
}

static bool read_seed(request_t *request, const char *text)
{
    char *end;

    request->flight.seed = strtoul(text, &end, 10);
    return (*text >= '0' && *text <= '9' && *end == '\0') || complain("not a seed (0, 1, 2 ...)", text);
}

static bool read_duration(request_t *request, const char *text)
{
    char *end;

    request->flight.duration_s = strtod(text, &end);
    return (*text != '\0' && *end == '\0' && request->flight.duration_s > 0.0 && isfinite(request->flight.duration_s)) ||
           complain("not a number of seconds", text);
}

static bool read_option(request_t *request, int option, const char *argument)
{
    const char *error;

    switch (option) {
    case OPT_SEED: return read_seed(request, argument);
    case OPT_CSV: request->csv_path = argument; return true;
    case OPT_JSON: request->json_path = argument; return true;
    case OPT_SET:
        error = flight_override(&request->flight, argument);
        return error == NULL || complain(error, argument);
    case OPT_REALTIME: request->flight.realtime = true; return true;
    case OPT_XBEE: request->flight.radio = argument; return true;
    case OPT_DURATION: return read_duration(request, argument);
    case OPT_HELP: request->help = true; return true;
    default: return false;
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
    if (request->help) {
        return true;
    }
    if (optind + 1 != argc) {
        return complain("one SCENARIO is needed, see `plomada list`", optind < argc ? argv[optind + 1] : "fly");
    }
    request->scenario = scenario_find(argv[optind]);
    if (request->scenario == NULL) {
        return complain("no such scenario, see `plomada list`", argv[optind]);
    }
    if (request->flight.realtime != (request->flight.radio != NULL)) {
        return complain("--realtime and --xbee go together", "fly");
    }
    return request->flight.realtime || request->flight.duration_s == 0.0 ||
           complain("goes with --realtime", "--duration");
}

static void print_table(const request_t *request, const flight_result_t *result)
{
    printf("%s, seed %lu\n", request->scenario->name, request->flight.seed);
    for (int i = 0; i < METRIC_COUNT; i++) {
        double value = result->metrics.value[i];

        if (isnan(value)) {
            printf("  %-20s -\n", metric_names[i]);
        } else {
            printf("  %-20s %.*f\n", metric_names[i], i >= METRIC_SCANS || i == METRIC_GROUND_CONTACTS ? 0 : 3, value);
        }
    }
}

static bool print_verdict(const request_t *request, const flight_result_t *result)
{
    const expectation_t *broken;
    bool met;

    if (result->halt != NULL) {
        printf("NOT MET: the firmware stopped: %s\n", result->halt);
        return false;
    }
    if (!result->started) {
        printf("NOT MET: the sensors did not come up within 60 s\n");
        return false;
    }
    if (request->flight.realtime) {
        return true;
    }
    met = scenario_met(request->scenario, &result->metrics, &broken);
    if (met) {
        printf("MET: all expectations of %s\n", request->scenario->name);
    } else if (broken != NULL) {
        printf("NOT MET: %s is not within %g..%g\n", metric_names[broken->metric], broken->minimum, broken->maximum);
    } else {
        printf("NOT MET: %s\n", result->metrics.failed ? result->metrics.failure : "it was to fail, and did not");
    }
    return met;
}

static void write_json(FILE *out, const request_t *request, const flight_result_t *result, bool met)
{
    fprintf(out, "{\n  \"scenario\": \"%s\",\n  \"seed\": %lu,\n  \"met\": %s,\n  \"failed\": %s", request->scenario->name,
            request->flight.seed, met ? "true" : "false", result->metrics.failed ? "true" : "false");
    for (int i = 0; i < METRIC_COUNT; i++) {
        if (isnan(result->metrics.value[i])) {
            fprintf(out, ",\n  \"%s\": null", metric_names[i]);
        } else {
            fprintf(out, ",\n  \"%s\": %.6g", metric_names[i], result->metrics.value[i]);
        }
    }
    fprintf(out, "\n}\n");
}

static FILE *open_output(const char *path)
{
    FILE *file = fopen(path, "w");

    if (file == NULL) {
        perror(path);
    }
    return file;
}

static int run(request_t *request)
{
    static flight_result_t result;
    FILE *json = NULL;
    const char *error;
    bool met;

    if ((request->csv_path != NULL && (request->flight.csv = open_output(request->csv_path)) == NULL) ||
        (request->json_path != NULL && (json = open_output(request->json_path)) == NULL)) {
        return 2;
    }
    if (!flight_run(request->scenario, &request->flight, &result, &error)) {
        complain(error, request->flight.radio);
        return 2;
    }
    print_table(request, &result);
    met = print_verdict(request, &result);
    if (json != NULL) {
        write_json(json, request, &result, met);
        fclose(json);
    }
    if (request->flight.csv != NULL) {
        fclose(request->flight.csv);
    }
    return met ? 0 : 1;
}

int command_fly(int argc, char **argv)
{
    static request_t request;

    request.flight.seed = 1;
    if (!read_arguments(&request, argc, argv)) {
        fprintf(stderr, "`plomada fly --help` tells more.\n");
        return 2;
    }
    if (request.help) {
        fputs(usage, stdout);
        flight_print_plant_figures(stdout);
        return 0;
    }
    return run(&request);
}
