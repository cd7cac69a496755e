/* The options --laser, --imu and --xbee of every command that has the three serial lines outside. */
#ifndef TOOLS_PLOMADA_LINES_H
#define TOOLS_PLOMADA_LINES_H

#include <getopt.h>
#include <stdbool.h>

#include "sim/board.h"

/* Beyond a command's own options, whose numbers begin at 1. */
#define LINE_OPTION 1000

/* For its table of getopt_long(). */
#define LINE_OPTIONS \
    {"laser", required_argument, NULL, LINE_OPTION + BOARD_LASER}, \
        {"imu", required_argument, NULL, LINE_OPTION + BOARD_IMU}, \
    { \
        "xbee", required_argument, NULL, LINE_OPTION + BOARD_RADIO \
    }

/* True when the option is one of them: its path is kept. */
bool lines_option(int option, const char *argument, const char *path[BOARD_WIRES]);

/* False, and said on stderr which is missing, when not all three are there. */
bool lines_all_given(const char *command, const char *const path[BOARD_WIRES]);

#endif
