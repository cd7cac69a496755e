#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "commands.h"
#include "figures.h"
#include "measure.h"
#include "nearest.h"
#include "output.h"
#include "place.h"
#include "scenario_file.h"
#include "vehicle.h"
#include "sim/json.h"
#include "sim/scenarios/flight.h"
#include "sim/scenarios/plant.h"
#include "sim/ti/f021/flash.h"

#define HEIGHT_MAX_M 5.0
#define SECONDS_MAX 1e6 /* eleven days */

static const char usage[] =
    "usage: plomada fly SCENARIO [OPTION]...\n\n"
    "Flies one scenario with the unmodified firmware on the PC board, in virtual time. SCENARIO: a name, or "
    "a file of your\n"
    "own (docs/campaign.md); a file's name has a dot or a slash in it.\n\n"
    "  --seed N            noise, phases and turbulence (default 1)\n"
    "  --csv FILE          log at 100 Hz: the columns of #LOG (docs/operator.md), then the truth: height_m "
    "above the ground,\n"
    "                      abs_m, terrain_m, and the throttle pulse_us\n"
    "  --log FILE          what an operator saves who types #LOG RATE FAST before the flight and #LOG after "
    "it: all lines\n"
    "                      of the radio. `plomada log FILE` makes a CSV of it, for `make fit`\n"
    "  --radio FILE        all lines of the radio, and neither of these orders: #LOG answers for minutes\n"
    "  --json FILE         metrics. - as FILE of --csv or --json is stdout; the table then goes to stderr. "
    "Each file has a\n"
    "                      name of its own: one for two of these options, or one that is read too, is "
    "refused\n"
    "  --storage FILE      the chip's flash: what #SAVE has stored there in one run is in force in the next. "
    "Without it the\n"
    "                      storage is blank at power-on. The file is made when there is none\n"
    "  --record DIR        everything at the firmware's pins, in DIR/flight.plomada: `plomada replay DIR` "
    "gives the same run\n"
    "                      again. DIR is made when there is none; a recording in it is never overwritten\n"
    "  --vehicle FILE      the figures of the vehicle that `make fit` found; a --set behind it wins\n"
    "  --set NAME=VALUE    a telecommand parameter (see `plomada params`) or a plant figure; may be "
    "repeated\n"
    "  --timing            observed response times, blocking, inversions and latency\n"
    "  --limits FILE       the same next to the bounds that tools/rta/limits.py prints; beyond a bound or a "
    "deadline the\n"
    "                      flight is not met\n"
    "  --trace FILE        the schedule, for https://ui.perfetto.dev or chrome://tracing; about 2 MB per "
    "second\n"
    "  --cost-scale X      every execution cost and context switch X times, 0.01..100 (default 1)\n"
    "  --laser DEVICE      a real scanner, IMU or radio on a serial port (or a pseudo-terminal, see `plomada "
    "laser`) in\n"
    "  --imu DEVICE        place of the model. The port follows the rates that the firmware sets. The flight "
    "is then\n"
    "  --xbee DEVICE|pty   paced by the wall clock, and the scenario sends no commands. pty: the radio stays "
    "modelled, its\n"
    "                      ground end is a pseudo-terminal whose name is the first line of the output; "
    "tools/ground/bridge.py\n"
    "                      offers it to a browser. Without --xbee the telemetry goes to stdout. The figures "
    "are then\n"
    "                      those that need no plan, of the references that were in force; none is judged\n"
    "  --realtime          paced by the wall clock; needs one of the three above, but for bench\n"
    "  --duration S        the landing command comes after S seconds instead of at the scenario's time, and "
    "the battery\n"
    "                      lasts longer in proportion. With --realtime or bench: ends after S seconds "
    "(default: Ctrl-C ends it; bench in virtual time: 30)\n"
    "  --until-down S      ends as soon as the vehicle is down and its motors are off for a second, at the "
    "latest S seconds\n"
    "                      after the landing command\n"
    "  --fault SPEC        on the scanner's line, as in `plomada laser --help`; octets count from power-on, "
    "some 1000 a\n"
    "                      second once it scans; may be repeated. With --set LINK=S above 0 the operator "
    "keeps sending\n"
    "                      #PING\n"
    "  --place FILE        the vehicle flies in the place, and by the way, that FILE describes "
    "(docs/campaign.md). The log then\n"
    "                      has x_m, y_m and heading_rad\n"
    "  --height M          bench: the landing gear is at M metres above the floor, 0..5 (default 0)\n\n"
    "bench has no flight: the vehicle stands still, the telemetry goes to stdout, and the last line is the "
    "answer to\n"
    "#LASER. It needs no commands; those of --set are typed soon after power-up.\n\n"
    "Printed: each figure that applies, what it must be in this scenario, and what it means. MET: all are as "
    "they must be;\n"
    "NOT MET: the figures marked ! are not.\n\n"
    "Exit status: 0 the flight met the scenario's expectations (real time and bench: it came to its end), 1 "
    "it did not,\n"
    "2 usage, or a file that cannot be read or written.\n\n"
    "Plant figures (as `plomada list --plant`): name, unit, value unless set, meaning\n";

enum {
    OPT_SEED = 1,
    OPT_CSV,
    OPT_JSON,
    OPT_LOG,
    OPT_RADIO,
    OPT_STORAGE,
    OPT_RECORD,
    OPT_SET,
    OPT_VEHICLE,
    OPT_TIMING,
    OPT_LIMITS,
    OPT_TRACE,
    OPT_COST_SCALE,
    OPT_REALTIME,
    OPT_LASER,
    OPT_IMU,
    OPT_XBEE,
    OPT_DURATION,
    OPT_UNTIL_DOWN,
    OPT_FAULT,
    OPT_HEIGHT,
    OPT_PLACE,
    OPT_HELP
};

static const struct option long_options[] = {
    {"seed", required_argument, NULL, OPT_SEED},
    {"csv", required_argument, NULL, OPT_CSV},
    {"json", required_argument, NULL, OPT_JSON},
    {"log", required_argument, NULL, OPT_LOG},
    {"radio", required_argument, NULL, OPT_RADIO},
    {"storage", required_argument, NULL, OPT_STORAGE},
    {"record", required_argument, NULL, OPT_RECORD},
    {"set", required_argument, NULL, OPT_SET},
    {"vehicle", required_argument, NULL, OPT_VEHICLE},
    {"timing", no_argument, NULL, OPT_TIMING},
    {"limits", required_argument, NULL, OPT_LIMITS},
    {"trace", required_argument, NULL, OPT_TRACE},
    {"cost-scale", required_argument, NULL, OPT_COST_SCALE},
    {"realtime", no_argument, NULL, OPT_REALTIME},
    {"laser", required_argument, NULL, OPT_LASER},
    {"imu", required_argument, NULL, OPT_IMU},
    {"xbee", required_argument, NULL, OPT_XBEE},
    {"duration", required_argument, NULL, OPT_DURATION},
    {"height", required_argument, NULL, OPT_HEIGHT},
    {"place", required_argument, NULL, OPT_PLACE},
    {"until-down", required_argument, NULL, OPT_UNTIL_DOWN},
    {"fault", required_argument, NULL, OPT_FAULT},
    {"help", no_argument, NULL, OPT_HELP},
    {NULL, 0, NULL, 0},
};

typedef struct {
    flight_options_t flight;
    const scenario_t *scenario;
    output_t csv, json, log, trace, record;
    const char *scenario_path, *vehicle_path, *storage_path, *record_dir, *place_path, *limits_path;
    double cost_scale;
    bool help, height, timing;
    bool record_made, storage_made; /* the folder, the file: not there before */
} request_t;

static bool complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada fly: %s: %s\n", subject, what);
    return false;
}

static bool read_seed(request_t *request, const char *text)
{
    char *end;

    errno = 0;
    request->flight.seed = strtoul(text, &end, 10);
    return (*text >= '0' && *text <= '9' && *end == '\0' && errno == 0 && request->flight.seed <= LONG_MAX) ||
           complain("not a seed (0, 1, 2 ... 9223372036854775807)", text);
}

static bool read_seconds(double *seconds, const char *text)
{
    char *end;

    *seconds = strtod(text, &end);
    return (*text != '\0' && *end == '\0' && *seconds > 0.0 && *seconds <= SECONDS_MAX) ||
           complain("not a number of seconds, at most 1000000", text);
}

static bool read_fault(flight_options_t *flight, const char *text)
{
    const char *error;

    if (flight->fault_count == FLIGHT_FAULTS_MAX) {
        return complain("too many", "--fault");
    }
    error = line_fault_parse(&flight->faults[flight->fault_count++], text);
    return error == NULL || complain(error, text);
}

static bool read_height(request_t *request, const char *text)
{
    char *end;

    request->height = true;
    request->flight.height_m = strtod(text, &end);
    return (*text != '\0' && *end == '\0' && request->flight.height_m >= 0.0 &&
            request->flight.height_m <= HEIGHT_MAX_M) ||
           complain("not a height, 0..5 m", text);
}

static bool read_cost_scale(request_t *request, const char *text)
{
    char *end;

    request->cost_scale = strtod(text, &end);
    return (*text != '\0' && *end == '\0' && request->cost_scale >= 0.01 && request->cost_scale <= 100.0) ||
           complain("not a factor, 0.01..100", text);
}

static bool use_device(request_t *request, board_wire_t wire, const char *device)
{
    request->flight.device[wire] = device;
    request->flight.realtime = true;
    return true;
}

static bool read_option(request_t *request, int option, const char *argument)
{
    const char *error;

    switch (option) {
    case OPT_SEED:
        return read_seed(request, argument);
    case OPT_CSV:
        request->csv.path = argument;
        return true;
    case OPT_JSON:
        request->json.path = argument;
        return true;
    case OPT_LOG:
    case OPT_RADIO:
        if (request->log.path != NULL) {
            return complain("one of --log and --radio, once", argument);
        }
        request->log.path = argument;
        request->flight.dump = option == OPT_LOG;
        return true;
    case OPT_STORAGE:
        request->storage_path = argument;
        return true;
    case OPT_RECORD:
        request->record_dir = argument;
        return true;
    case OPT_SET:
        error = flight_override(&request->flight, argument);
        return error == NULL || complain(error, argument);
    case OPT_VEHICLE:
        request->vehicle_path = argument;
        error = vehicle_read(&request->flight, argument);
        return error == NULL || complain(error, argument);
    case OPT_TIMING:
        request->timing = true;
        return true;
    case OPT_LIMITS:
        request->timing = true;
        request->limits_path = argument;
        return true;
    case OPT_TRACE:
        request->trace.path = argument;
        return true;
    case OPT_COST_SCALE:
        return read_cost_scale(request, argument);
    case OPT_REALTIME:
        request->flight.realtime = true;
        return true;
    case OPT_LASER:
        return use_device(request, BOARD_LASER, argument);
    case OPT_IMU:
        return use_device(request, BOARD_IMU, argument);
    case OPT_XBEE:
        return use_device(request, BOARD_RADIO, argument);
    case OPT_DURATION:
        return read_seconds(&request->flight.duration_s, argument);
    case OPT_UNTIL_DOWN:
        return read_seconds(&request->flight.patience_s, argument);
    case OPT_FAULT:
        return read_fault(&request->flight, argument);
    case OPT_HEIGHT:
        return read_height(request, argument);
    case OPT_PLACE:
        request->place_path = argument;
        return true;
    case OPT_HELP:
        request->help = true;
        return true;
    default:
        return false;
    }
}

static bool anything_real(const flight_options_t *options)
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        if (options->device[i] != NULL) {
            return true;
        }
    }
    return false;
}

/* What goes together, once the scenario is known. */
static bool check_arguments(const request_t *request)
{
    const flight_options_t *options = &request->flight;

    if (request->log.path != NULL && (request->scenario->bench || options->realtime)) {
        return complain("goes with a flight in virtual time", options->dump ? "--log" : "--radio");
    }
    if (request->scenario->bench) {
        return true;
    }
    if (request->height) {
        return complain("goes with bench", "--height");
    }
    if (options->realtime && !anything_real(options)) {
        return complain("needs one of --laser, --imu, --xbee", "--realtime");
    }
    if (options->realtime && options->patience_s > 0.0) {
        return complain("goes with virtual time", "--until-down");
    }
    return options->realtime || options->duration_s == 0.0 || options->duration_s > METRICS_REFERENCE_S ||
           complain("must be more than 1 s, when the reference comes", "--duration");
}

static bool no_such_scenario(const char *name)
{
    const char *names[64];
    size_t count = 0;

    for (int i = 0; i < scenario_count && count < sizeof names / sizeof names[0]; i++) {
        names[count++] = scenarios[i].name;
    }
    const char *meant = nearest(name, names, count);

    if (meant == NULL) {
        return complain("no such scenario, see `plomada list`", name);
    }
    fprintf(stderr, "plomada fly: %s: no such scenario; did you mean %s?\n", name, meant);
    return false;
}

static bool find_scenario(request_t *request, const char *name)
{
    if (scenario_file_named(name)) {
        request->scenario_path = name;
        request->scenario = scenario_file_read("fly", name);
        return request->scenario != NULL;
    }
    request->scenario = scenario_find(name);
    return request->scenario != NULL || no_such_scenario(name);
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
        return complain("one SCENARIO is needed, see `plomada list`",
                        optind < argc ? argv[optind + 1] : "fly");
    }
    return find_scenario(request, argv[optind]) && check_arguments(request);
}

/* Whether --place took away the course of which this is expected. */
static bool lost_course(const request_t *request, metric_t metric)
{
    switch (metric) {
    case METRIC_OVERSHOOT_MM:
    case METRIC_HOVER_RMS_MM:
    case METRIC_HOVER_MEAN_ERROR_MM:
    case METRIC_THRUST_STD_N:
    case METRIC_TERRAIN_RMS_MM:
    case METRIC_RECOVERY_S:
    case METRIC_SETTLED_S:
    case METRIC_UNDERSHOOT_MM:
    case METRIC_MAX_ERROR_MM:
    case METRIC_ALTITUDE_ERROR_MM:
        return request->place_path != NULL;
    default:
        return false;
    }
}

/* What is expected behind the landing command of --duration cannot be. */
static bool landed_before(const request_t *request, const metrics_t *metrics, metric_t metric)
{
    return request->flight.duration_s != 0.0 && metrics->untold[metric];
}

/* What --duration and --place leave of the scenario. */
static scenario_t as_flown(const request_t *request, const metrics_t *metrics)
{
    scenario_t flown = *request->scenario;

    flown.expectation_count = 0;
    for (int i = 0; i < request->scenario->expectation_count; i++) {
        const expectation_t *e = &request->scenario->expectations[i];

        if (!lost_course(request, e->metric) && !landed_before(request, metrics, e->metric)) {
            flown.expectations[flown.expectation_count++] = *e;
        }
    }
    return flown;
}

static void tell_left_out(FILE *out, const request_t *request, const metrics_t *metrics)
{
    static const char *const why[] = {"the flight lands before", "--place is another course"};

    for (int lost = 0; lost < 2; lost++) {
        bool any = false;

        for (int i = 0; i < request->scenario->expectation_count; i++) {
            const metric_t metric = request->scenario->expectations[i].metric;

            if (lost_course(request, metric) ? lost : !lost && landed_before(request, metrics, metric)) {
                if (!any) {
                    fprintf(out, "Not judged, for %s:", why[lost]);
                }
                fprintf(out, "%s %s", any ? "," : "", metric_names[metric]);
                any = true;
            }
        }
        fputs(any ? "\n" : "", out);
    }
}

static bool print_verdict(FILE *out, const request_t *request, const flight_result_t *result)
{
    const scenario_t flown = as_flown(request, &result->metrics);
    bool met;

    if (result->halt != NULL) {
        fprintf(out, "NOT MET: the firmware stopped: %s\n", result->halt);
        return false;
    }
    if (!result->started) {
        fprintf(out, "NOT MET: the sensors did not come up within 60 s\n");
        return false;
    }
    if (request->flight.realtime) {
        return true;
    }
    tell_left_out(out, request, &result->metrics);
    met = figures_judge(out, &flown, &result->metrics);
    if (met) {
        fprintf(out,
                flown.expectation_count < request->scenario->expectation_count
                    ? "MET: what could be judged of %s\n"
                : flown.expectation_count > 0 ? "MET: all expectations of %s\n"
                : flown.fate == FATE_EITHER   ? "Nothing was judged: %s expects nothing\n"
                                              : "MET: %s expects no figure\n",
                request->scenario->name);
    }
    return met;
}

static bool needs_no_plan(metric_t metric)
{
    return !metrics_needs_plan(metric);
}

/* The scenario has ordered nothing: what it expects is not expected of those who have. */
static void print_by_hand(FILE *out, const request_t *request, const flight_result_t *result)
{
    scenario_t plain = *request->scenario;

    plain.expectation_count = 0;
    figures_print(out, &plain, &result->metrics, needs_no_plan);
    fprintf(out, "Not judged: the scenario ordered nothing. The figures are of the references that were in "
                 "force.\n");
}

static bool print_result(FILE *out, const request_t *request, const flight_result_t *result)
{
    fprintf(out, "%s, seed %lu\n", request->scenario->name, request->flight.seed);
    if (request->flight.realtime) {
        print_by_hand(out, request, result);
    } else {
        const scenario_t flown = as_flown(request, &result->metrics);

        figures_print(out, &flown, &result->metrics, NULL);
    }
    return print_verdict(out, request, result);
}

static bool bench_ended(const flight_result_t *result)
{
    if (result->halt != NULL) {
        fprintf(stderr, "plomada fly: the firmware stopped: %s\n", result->halt);
    }
    return result->halt == NULL;
}

static void write_json(FILE *out, const request_t *request, const flight_result_t *result, bool met)
{
    json_t json;

    json_begin(&json, out);
    json_text(&json, "scenario", request->scenario->name);
    json_whole(&json, "seed", (long long)request->flight.seed);
    json_flag(&json, "met", met);
    json_flag(&json, "failed", result->metrics.failed);
    for (int i = 0; i < METRIC_COUNT; i++) {
        json_number(&json, metric_names[i], result->metrics.value[i], 6);
    }
    json_flag(&json, "started", result->started);
    json_flag(&json, "halted", result->halt != NULL);
    json_end(&json);
}

/* Stored at once as well: a file that cannot be written is better known before the flight than after it. */
static bool load_storage(request_t *request)
{
    const char *path = request->storage_path;
    const char *error = path == NULL ? NULL : flash_load(path);

    request->storage_made = path != NULL && access(path, F_OK) != 0;

    if (path != NULL && error == NULL) {
        error = flash_store(path);
    }
    return error == NULL || complain(error, path);
}

static bool keep_storage(const char *path)
{
    const char *error = path == NULL ? NULL : flash_store(path);

    return error == NULL || complain(error, path);
}

/* Where people read: stdout, or stderr where a file is written to stdout. */
static FILE *reading_matter(const request_t *request)
{
    return output_is_stdout(&request->csv) || output_is_stdout(&request->json) ? stderr : stdout;
}

static void name_record(request_t *request)
{
    static char path[PATH_MAX];

    if (request->record_dir != NULL) {
        snprintf(path, sizeof path, "%s/%s", request->record_dir, RECORDING_NAME);
        request->record.path = path;
    }
}

static bool files_apart(const request_t *request)
{
    const output_use_t uses[] = {
        {"SCENARIO", request->scenario_path, false},
        {"--vehicle", request->vehicle_path, false},
        {"--place", request->place_path, false},
        {"--limits", request->limits_path, false},
        {"--storage", request->storage_path, true},
        {"--record", request->record.path, true},
        {"--record", request->record_dir, true},
        {"--csv", request->csv.path, true},
        {"--json", request->json.path, true},
        {"--trace", request->trace.path, true},
        {request->flight.dump ? "--log" : "--radio", request->log.path, true},
    };

    return output_apart("fly", uses, sizeof uses / sizeof uses[0]);
}

/* The folder of the recording, which has none yet. */
static bool make_record_folder(request_t *request)
{
    const char *path = request->record.path;

    if (path == NULL) {
        return true;
    }
    request->record_made = mkdir(request->record_dir, 0777) == 0;
    if (!request->record_made && errno != EEXIST) {
        return complain(strerror(errno), request->record_dir);
    }
    if (access(path, F_OK) == 0) {
        return complain("there is a recording already; another --record DIR, or remove it", path);
    }
    return true;
}

enum { OUTPUTS = 5 };

static output_t *const *outputs_of(request_t *request)
{
    static output_t *all[OUTPUTS];

    all[0] = &request->record;
    all[1] = &request->csv;
    all[2] = &request->json;
    all[3] = &request->log;
    all[4] = &request->trace;
    return all;
}

/* A flight that is refused leaves no file that it has made. */
static int refuse(const request_t *request)
{
    if (request->record_made) {
        rmdir(request->record_dir);
    }
    if (request->storage_made) {
        unlink(request->storage_path);
    }
    return 2;
}

static bool open_outputs(request_t *request)
{
    const bool opened = make_record_folder(request) && output_open_all(outputs_of(request), OUTPUTS);

    request->flight.csv = request->csv.file;
    request->flight.record = request->record.file;
    request->flight.telemetry = request->log.file;
    if (request->scenario->bench ||
        (request->flight.realtime && request->flight.device[BOARD_RADIO] == NULL)) {
        request->flight.telemetry = reading_matter(request);
    }
    return opened;
}

static bool close_outputs(request_t *request)
{
    bool closed = output_close(&request->trace);

    closed = output_close(&request->record) && closed;
    closed = output_close(&request->json) && closed;
    closed = output_close(&request->log) && closed;
    return output_close(&request->csv) && closed;
}

static bool load_place(request_t *request)
{
    if (request->place_path != NULL) {
        request->flight.place = place_read(request->place_path);
    }
    return request->place_path == NULL || request->flight.place != NULL;
}

static bool prepare(const request_t *request)
{
    const char *error = flight_prepare(request->scenario, &request->flight);

    if (error != NULL) {
        fprintf(stderr, "plomada fly: %s\n", error);
    }
    return error == NULL;
}

/* The outputs are opened last: what they are to replace is not lost by a flight that is refused. */
static int run(request_t *request)
{
    static flight_result_t result;
    bool met, kept;

    name_record(request);
    if (!files_apart(request) || !load_place(request) || !measure_read_limits(request->limits_path) ||
        !load_storage(request) || !prepare(request) || !open_outputs(request)) {
        return refuse(request);
    }
    request->flight.costs = measure_begin(request->cost_scale, request->trace.file);
    flight_run(request->scenario, &request->flight, &result);
    kept = keep_storage(request->storage_path);
    measure_end();
    met = request->scenario->bench ? bench_ended(&result)
                                   : print_result(reading_matter(request), request, &result);
    if (request->timing) {
        met = measure_report(reading_matter(request)) && met;
    }
    if (request->json.file != NULL) {
        write_json(request->json.file, request, &result, met);
    }
    kept = close_outputs(request) && kept;
    return !kept ? 2 : met ? 0 : 1;
}

int command_fly(int argc, char **argv)
{
    static request_t request;

    request.flight.seed = 1;
    request.cost_scale = 1.0;
    if (!read_arguments(&request, argc, argv)) {
        fprintf(stderr, "`plomada fly --help` tells more.\n");
        return 2;
    }
    if (request.help) {
        fputs(usage, stdout);
        plant_print(stdout);
        return 0;
    }
    return run(&request);
}
