#include "lines.h"

#include <stdio.h>

#include "sim/scenarios/wires.h"

bool lines_option(int option, const char *argument, const char *path[BOARD_WIRES])
{
    if (option < LINE_OPTION || option >= LINE_OPTION + BOARD_WIRES) {
        return false;
    }
    path[option - LINE_OPTION] = argument;
    return true;
}

bool lines_all_given(const char *command, const char *const path[BOARD_WIRES])
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        if (path[i] == NULL) {
            fprintf(stderr, "plomada %s: --%s is needed\n", command, wire_names[i]);
            return false;
        }
    }
    return true;
}
