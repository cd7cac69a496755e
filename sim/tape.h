/* A recording of everything that reached the firmware's pins in one run, exact enough to give the same run
 * again: each octet on the three receive wires with the instant of its stop bit, the level of the selector
 * pin, and the flash that it woke up with. What the firmware makes of it is not recorded: a replay lets the
 * firmware do it again.
 *
 * The file is text, one record a line, in the order of time:
 *
 *   plomada-recording 2
 *   KEY VALUE                      what the run was: scenario, seed, version, set NAME=VALUE, first_row_ns,
 * rows flash SECTOR OFFSET CELLS      16-bit cells in hex, four digits each; what is not named is erased
 *   octets WIRE T_NS LENGTH_NS HEX the stop bit of the first octet ended at T_NS since power-on, and the
 * others followed without a pause; each lasted LENGTH_NS, ten bits
 *   select T_NS 0|1                level of the selector pin
 *   stick T_NS 0|1                 level of the stick's pin
 *   battery T_NS MICROVOLTS        voltage on the battery's pin
 *   truth HEIGHT ABS TERRAIN THRUST X Y HEADING    of one row of the log, where a simulated vehicle flew,
 * what it was commanded (N), and where it was; older recordings end before the thrust, or before X
 *
 *   end T_NS                       the last line: nothing is missing
 *
 * A file that was cut off (a full disk, a pulled plug) is good up to its last whole line, and known by its
 * end line, which it lacks. Recordings whose first line says 1 never had one. */
#ifndef SIM_TAPE_H
#define SIM_TAPE_H

#include <stdbool.h>
#include <stdio.h>

#include "sim/board.h"

/* Recording
 * ------------------------------------------------------------------------------------------------------ */

/* After board_power_on(): from here on everything goes to `out`, the flash first. One recording at a time. */
void tape_record(FILE *out);
void tape_key(const char *key, const char *value);
typedef struct {
    double height_m, altitude_m, terrain_m, thrust_n, x_m, y_m, heading_rad;
} tape_truth_t;
void tape_truth(const tape_truth_t *truth);
/* The end, before board_power_off(). */
void tape_stop(void);

/* Replaying
 * ------------------------------------------------------------------------------------------------------ */

typedef struct tape tape_t;

/* Reads a whole recording. NULL: *error says what is wrong with it, with its line. */
tape_t *tape_read(FILE *in, const char **error);
void tape_free(tape_t *tape);

/* The n-th value of a key, from 0; NULL when there is none. */
const char *tape_value(const tape_t *tape, const char *key, size_t n);
/* False behind the last row. NAN: the recording does not have it. */
bool tape_truth_row(const tape_t *tape, size_t row, tape_truth_t *truth);
/* Whether it was recorded to its end. UNTOLD: an older one, of which nobody knows. */
typedef enum { TAPE_WHOLE, TAPE_UNTOLD, TAPE_CUT } tape_state_t;
tape_state_t tape_state(const tape_t *tape);
/* Instant of the latest thing on the recording. */
sim_time_t tape_end(const tape_t *tape);

/* Before board_power_on(): the flash as it was. */
void tape_restore_flash(const tape_t *tape);
/* After board_power_on(): the models are taken off the wires, and the recording comes in their place. `heard`
 * gets what the firmware sends by radio. The tape must outlive the run. */
void tape_play(const tape_t *tape, board_terminal_t heard, void *heard_context);

/* In place of what the operator typed for a parameter (`#NAME ...` lines) another line; where nothing was
 * typed for it, the line is typed just before the first #SETR. Changes the recording in memory. False: no
 * room on the radio's wire. */
bool tape_retype(tape_t *tape, const char *name, const char *value);

#endif
