/* A flight's recording through the unmodified firmware once more. */
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "commands.h"
#include "control/parameters.h"
#include "output.h"
#include "replay_log.h"
#include "sim/scenarios/flight.h"

static const char usage[] =
    "usage: plomada replay RECORDING [OPTION]...\n\n"
    "Gives the firmware what a flight recorded at its pins, to the nanosecond, and writes the log that it "
    "makes of that.\n"
    "RECORDING is the DIR of `plomada fly --record DIR`, or the file in it. The log is the one of the flight "
    "itself,\n"
    "octet for octet, as long as the firmware is the same.\n\n"
    "A RECORDING without octets, a CSV of `plomada log` or `fly --csv`, or telemetry as a terminal saved it, "
    "is flown open\n"
    "loop: the firmware's control, with the parameters as delivered and those of --set, is given the "
    "heights, "
    "tilts,\n"
    "accelerations and references that are there. For the command before it takes the one that was flown: "
    "this one moved\n"
    "the vehicle. thrust_n is what it would command next, flown_n what was; `make plot` draws both. What is "
    "not there is\n"
    "named on stderr. A dump of #LOG is refused: `plomada log` makes a CSV of it.\n\n"
    "  --csv FILE          the log (default: stdout). Never the RECORDING itself\n"
    "  --set NAME=VALUE    a telecommand parameter in place of what was typed for it. The vehicle does not "
    "answer to what\n"
    "                      the firmware commands then (open loop): the log shows in thrust_n what it would "
    "have\n"
    "                      commanded, beside flown_n, until the heights that it sees are no longer those "
    "that it "
    "would\n"
    "                      have flown\n"
    "  --telemetry         the lines that the firmware sent by radio, on stderr\n\n"
    "Exit status: 0 replayed to its end, 1 the firmware stopped, or the recording is cut, 2 usage, or a file "
    "that cannot be\n"
    "read or written.\n";

enum { OPT_CSV = 1, OPT_SET, OPT_TELEMETRY, OPT_HELP };

static const struct option long_options[] = {
    {"csv", required_argument, NULL, OPT_CSV},
    {"set", required_argument, NULL, OPT_SET},
    {"telemetry", no_argument, NULL, OPT_TELEMETRY},
    {"help", no_argument, NULL, OPT_HELP},
    {NULL, 0, NULL, 0},
};

typedef struct {
    const char *path;
    output_t csv;
    flight_options_t sets; /* its overrides alone are used: they were checked */
    bool telemetry, help;
} request_t;

static bool complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada replay: %s: %s\n", subject, what);
    return false;
}

static bool read_set(request_t *request, const char *argument)
{
    const char *error = flight_override(&request->sets, argument);

    if (error == NULL && strncasecmp(argument, "plant.", 6) == 0) {
        error = "no vehicle flies in a replay";
    }
    return error == NULL || complain(error, argument);
}

static bool read_arguments(request_t *request, int argc, char **argv)
{
    int option;

    optind = 1;
    while ((option = getopt_long(argc, argv, "", long_options, NULL)) != -1) {
        switch (option) {
        case OPT_CSV:
            request->csv.path = optarg;
            break;
        case OPT_SET:
            if (!read_set(request, optarg)) {
                return false;
            }
            break;
        case OPT_TELEMETRY:
            request->telemetry = true;
            break;
        case OPT_HELP:
            request->help = true;
            return true;
        default:
            return false;
        }
    }
    if (optind + 1 != argc) {
        return complain("one RECORDING is needed", "replay");
    }
    request->path = argv[optind];
    return true;
}

/* The file that is meant: RECORDING, or the one in that directory. Stands until the next call. */
static const char *file_of(const char *given)
{
    static char path[PATH_MAX];
    struct stat what;

    snprintf(path, sizeof path, "%s", given);
    if (stat(given, &what) == 0 && S_ISDIR(what.st_mode)) {
        snprintf(path, sizeof path, "%s/%s", given, RECORDING_NAME);
    }
    return path;
}

static tape_t *load(const char *given, const char *path)
{
    const char *error = NULL;
    tape_t *tape;
    FILE *in;

    in = fopen(path, "r");
    if (in == NULL) {
        const bool in_folder = errno == ENOENT && strcmp(given, path) != 0;

        complain(in_folder ? "a folder without a recording: no " RECORDING_NAME " in it" : strerror(errno),
                 given);
        return NULL;
    }
    tape = tape_read(in, &error);
    fclose(in);
    if (tape == NULL) {
        complain(error, path);
    }
    return tape;
}

static bool retype(const request_t *request, tape_t *tape)
{
    for (int i = 0; i < request->sets.override_count; i++) {
        const flight_override_t *set = &request->sets.overrides[i];

        if (!tape_retype(tape, set->name, set->value)) {
            return complain("no room for the line on the recorded radio", set->name);
        }
    }
    return true;
}

static const char *value_or(const tape_t *tape, const char *key, const char *otherwise)
{
    const char *value = tape_value(tape, key, 0);

    return value != NULL ? value : otherwise;
}

static void tell(const request_t *request, const tape_t *tape, const flight_replay_t *result)
{
    fprintf(stderr, "replayed %s, seed %s: %zu rows", value_or(tape, "scenario", "?"),
            value_or(tape, "seed", "?"), result->rows);
    for (int i = 0; i < request->sets.override_count; i++) {
        fprintf(stderr, "%s %s=%s", i == 0 ? "; open loop with" : ",", request->sets.overrides[i].name,
                request->sets.overrides[i].value);
    }
    fputc('\n', stderr);
    if (tape_state(tape) == TAPE_CUT) {
        fprintf(stderr,
                "plomada replay: %s: the recording is cut: it ends at %.2f s without its end line, and the "
                "flight went on\n",
                request->path, (double)tape_end(tape) * 1e-9);
    } else if (tape_state(tape) == TAPE_UNTOLD) {
        fprintf(stderr, "plomada replay: %s: no end line, as in older recordings: it may be cut\n",
                request->path);
    }
    if (result->halt != NULL) {
        fprintf(stderr, "plomada replay: the firmware stopped after %.2f s: %s\n", result->end_s,
                result->halt);
    }
}

/* What people have of a flight when nobody recorded its octets. NULL: this is none. */
static FILE *open_log(const char *path)
{
    struct stat what;
    FILE *in = stat(path, &what) == 0 && S_ISREG(what.st_mode) ? fopen(path, "r") : NULL;

    if (in != NULL && !replay_log_reads(in)) {
        fclose(in);
        in = NULL;
    }
    return in;
}

/* The log in memory: a replay that is refused writes nothing, and leaves the file of --csv as it was. */
typedef struct {
    FILE *file;
    char *text;
    size_t length;
} kept_t;

static kept_t *keep(void)
{
    static kept_t kept;

    kept.file = open_memstream(&kept.text, &kept.length);
    if (kept.file == NULL) {
        abort();
    }
    return &kept;
}

static bool write_kept(request_t *request, kept_t *kept)
{
    fclose(kept->file);
    if (!output_open(&request->csv)) {
        return false;
    }
    fwrite(kept->text, 1, kept->length, request->csv.file);
    free(kept->text);
    return output_close(&request->csv);
}

static int run_log(request_t *request, FILE *in)
{
    kept_t *kept = keep();
    const char *error = replay_log(in, &request->sets, kept->file);

    fclose(in);
    if (error != NULL) {
        complain(error, request->path);
        return 2;
    }
    return write_kept(request, kept) ? 0 : 2;
}

static int run(request_t *request)
{
    flight_replay_t result;
    const char *error;
    const output_use_t uses[] = {{"RECORDING", file_of(request->path), false},
                                 {"--csv", request->csv.path, true}};

    if (!output_apart("replay", uses, sizeof uses / sizeof uses[0])) {
        return 2;
    }
    FILE *log = open_log(request->path);

    if (log != NULL) {
        return run_log(request, log);
    }
    tape_t *tape = load(request->path, uses[0].path);

    if (tape == NULL || !retype(request, tape)) {
        return 2;
    }
    kept_t *kept = keep();

    error = flight_replay(tape, request->sets.override_count > 0, kept->file,
                          request->telemetry ? stderr : NULL, &result);
    if (error != NULL) {
        complain(error, request->path);
        return 2;
    }
    tell(request, tape, &result);
    const bool to_its_end = result.halt == NULL && tape_state(tape) != TAPE_CUT;

    tape_free(tape);
    return !write_kept(request, kept) ? 2 : to_its_end ? 0 : 1;
}

int command_replay(int argc, char **argv)
{
    static request_t request;

    request.csv.path = "-";
    if (!read_arguments(&request, argc, argv)) {
        fputs("`plomada replay --help` tells more.\n", stderr);
        return 2;
    }
    if (request.help) {
        fputs(usage, stdout);
        return 0;
    }
    return run(&request);
}
