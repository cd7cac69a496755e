/* The options of every command that has the three serial lines outside: --laser, --imu, --xbee, --pulses,
 * --help. */
#ifndef TOOLS_PLOMADA_LINES_H
#define TOOLS_PLOMADA_LINES_H

#include <getopt.h>
#include <stdbool.h>

#include "sim/board.h"

typedef struct {
    const char *path[BOARD_WIRES];
    const char *pulses;            /* recording of the throttle pin, NULL: none */
    const char *bits[BOARD_WIRES]; /* recordings of the board's transmit pins, NULL: none */
    bool help;
} lines_t;

/* Beyond a command's own options, whose numbers begin at 1. */
#define LINE_OPTION 1000
#define LINE_PULSES (LINE_OPTION + BOARD_WIRES)
#define LINE_BITS (LINE_PULSES + 1)
#define LINE_HELP (LINE_BITS + 1)

/* For its table of getopt_long(). */
#define LINE_OPTIONS \
    {"laser", required_argument, NULL, LINE_OPTION + BOARD_LASER}, \
        {"imu", required_argument, NULL, LINE_OPTION + BOARD_IMU}, \
        {"xbee", required_argument, NULL, LINE_OPTION + BOARD_RADIO}, \
        {"pulses", required_argument, NULL, LINE_PULSES}, {"help", no_argument, NULL, LINE_HELP}, \
    { \
        NULL, 0, NULL, 0 \
    }

/* --bits LINE=FILE, of the commands that know it: stands before LINE_OPTIONS. */
#define LINE_BITS_OPTION \
    { \
        "bits", required_argument, NULL, LINE_BITS \
    }

/* Reads all options; `own` takes those that are the command's. False, and said on stderr, when one is not
 * understood or a line is not given. What is no option stands from argv[optind] on. */
bool lines_read(const char *command, int argc, char **argv, const struct option *table,
                bool (*own)(int option, const char *argument), lines_t *lines);

#endif
