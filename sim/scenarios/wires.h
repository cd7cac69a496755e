/* Real devices in place of models: serial ports of the PC on the board's wires, at the rates that the
 * firmware sets, and the operator's terminal on a pseudo-terminal. All of it is paced by the wall clock
 * (sim/host/pace.h). */
#ifndef SIM_SCENARIOS_WIRES_H
#define SIM_SCENARIOS_WIRES_H

#include "sim/board.h"

/* The option that names each wire, without its dashes. */
extern const char *const wire_names[]; /* BOARD_WIRES */

#define WIRES_PTY "pty"

/* A device's path for each wire, NULL: its model. WIRES_PTY for the radio: the model's ground end is a
 * pseudo-terminal, whose name is printed on stdout. NULL when fine (then
 * wires_close()), else what failed, on wire *failed. */
const char *wires_open(const char *const device[BOARD_WIRES], board_wire_t *failed);

/* After board_power_on() and pace_begin(). `heard` gets what the firmware gives to a real radio. */
void wires_connect(board_terminal_t heard, void *heard_context);

/* The operator's terminal shows an octet; nothing when it is on none. */
void wires_show(unsigned octet);

/* Shape of kernel_set_pacer(): gives the ports the firmware's present rates, then waits. */
void wires_pace(sim_time_t next);

void wires_close(void);

#endif
