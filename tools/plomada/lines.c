#include "lines.h"

#include <stdio.h>
#include <string.h>

#include "sim/scenarios/wires.h"

static bool read_bits(const char *argument, const char *bits[BOARD_WIRES])
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        const size_t length = strlen(wire_names[i]);

        if (strncmp(argument, wire_names[i], length) == 0 && argument[length] == '=') {
            bits[i] = argument + length + 1;
            return true;
        }
    }
    return false;
}

static bool take(int option, const char *argument, lines_t *lines)
{
    switch (option) {
    case LINE_PULSES:
        lines->pulses = argument;
        return true;
    case LINE_BITS:
        return read_bits(argument, lines->bits);
    case LINE_HELP:
        lines->help = true;
        return true;
    default:
        lines->path[option - LINE_OPTION] = argument;
        return true;
    }
}

bool lines_read(const char *command, int argc, char **argv, const struct option *table,
                bool (*own)(int option, const char *argument), lines_t *lines)
{
    int option;

    *lines = (lines_t){.help = false};
    optind = 1;
    while ((option = getopt_long(argc, argv, "", table, NULL)) != -1) {
        if (option < LINE_OPTION && !own(option, optarg)) {
            return false;
        }
        if (option >= LINE_OPTION && !take(option, optarg, lines)) {
            fprintf(stderr, "plomada %s: --bits %s: not laser=FILE, imu=FILE or xbee=FILE\n", command,
                    optarg);
            return false;
        }
    }
    for (int i = 0; i < BOARD_WIRES && !lines->help; i++) {
        if (lines->path[i] == NULL) {
            fprintf(stderr, "plomada %s: --%s is needed\n", command, wire_names[i]);
            return false;
        }
    }
    return true;
}
