#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "firmware/version.h"

typedef struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *summary;
} subcommand_t;

static const subcommand_t subcommands[] = {
    {"accept", command_accept, "a fresh board, item by item, with a report"},
    {"board", command_board, "the firmware in real time, its three lines outside, as a LaunchPad's"},
    {"fly", command_fly, "fly a scenario with the unmodified firmware"},
    {"hil", command_hil, "fly a real board: the PC plays scanner, IMU, operator and airframe"},
    {"laser", command_laser, "serve the scanner model on a pseudo-terminal"},
    {"list", command_list, "the scenarios and what each must look like"},
    {"log", command_log, "#LOG dumps in what a terminal or XCTU saved, as CSV"},
    {"params", command_params, "the parameters an operator may set"},
    {"replay", command_replay, "run the firmware again on what a flight recorded at its pins"},
    {"scip", command_scip, "scanner recordings and real scanners: decode, mirrors, record"},
    {"why", command_why, "why a flight went so: tries each cause on its log"},
};
#define SUBCOMMAND_COUNT (sizeof subcommands / sizeof subcommands[0])

static void print_usage(FILE *out)
{
    fprintf(out, "usage: plomada SUBCOMMAND [ARGUMENT]...\n\n");
    for (size_t i = 0; i < SUBCOMMAND_COUNT; i++) {
        fprintf(out, "  %-8s %s\n", subcommands[i].name, subcommands[i].summary);
    }
    fprintf(out, "\n`plomada SUBCOMMAND --help` tells more, `plomada --version` the version.\n");
}

/* What was printed and did not reach its file (a full disk) is no result. */
static int after_printing(int status)
{
    errno = 0;
    if (fflush(stdout) == 0 && ferror(stdout) == 0) {
        return status;
    }
    fprintf(stderr, "plomada: stdout: %s\n", errno != 0 ? strerror(errno) : "could not be written");
    return 2;
}

static int run(int argc, char **argv)
{
    if (argc < 2) {
        print_usage(stderr);
        return 2;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_usage(stdout);
        return 0;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("plomada " PLOMADA_VERSION "\n");
        return 0;
    }
    for (size_t i = 0; i < SUBCOMMAND_COUNT; i++) {
        if (strcmp(argv[1], subcommands[i].name) == 0) {
            return subcommands[i].run(argc - 1, argv + 1);
        }
    }
    fprintf(stderr, "plomada: no subcommand '%s'\n\n", argv[1]);
    print_usage(stderr);
    return 2;
}

int main(int argc, char **argv)
{
    return after_printing(run(argc, argv));
}
