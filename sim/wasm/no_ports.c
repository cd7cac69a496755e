/* A WebAssembly machine has no ports and no signals: nothing real can be put on the wires, and nothing is
 * paced. */
#include <fcntl.h>
#include <limits.h>
#include <string.h>
#include <sys/stat.h>

#include "sim/host/pace.h"
#include "sim/scenarios/wires.h"
#include "sim/wasm/missing.h"

const char *const wire_names[] = {"laser", "imu", "xbee"};
_Static_assert(sizeof wire_names / sizeof wire_names[0] == BOARD_WIRES, "every wire has a name");

const char *wires_open(const char *const device[BOARD_WIRES], board_wire_t *failed)
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        if (device[i] != NULL) {
            *failed = (board_wire_t)i;
            return "there are no ports here";
        }
    }
    return NULL;
}

void wires_connect(board_terminal_t heard, void *heard_context)
{
    (void)heard;
    (void)heard_context;
}

void wires_show(unsigned octet)
{
    (void)octet;
}

void wires_pace(sim_time_t next)
{
    (void)next;
}

void wires_close(void) {}

void pace_begin(void) {}

void pace_end(void) {}

bool pace_interrupted(void)
{
    return false;
}

char *realpath(const char *path, char *resolved)
{
    struct stat status;

    return stat(path, &status) == 0 && strlen(path) < PATH_MAX ? strcpy(resolved, path) : NULL;
}
