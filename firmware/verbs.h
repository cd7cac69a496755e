/* The commands that are no parameters: one function a verb, one file a subject. Each sends its answers and returns
 * whether the line was valid. TaskReceiveComm only. */
#ifndef FIRMWARE_VERBS_H
#define FIRMWARE_VERBS_H

#include <stdbool.h>

#include "firmware/answer.h"

/* verb_laser.c: `#LASER`: one line of state, rate, frames and losses, one of damages by cause and the last cause. */
bool verb_laser(answer_t *answer);

/* verb_imu.c: `#IMU`: what comes from the IMU, as it is and as it is understood; `#IMU LEVEL`, `RIGHT`, `NOSE` find its
 * unit and axes, on the ground without thrust. */
bool verb_imu(answer_t *answer);

/* verb_perf.c: `#PERF`: cause of the reset and processor load, per task response, missed deadlines and stack, per server
 * the longest wait. `#PERF RESET` clears what can be cleared. */
bool verb_perf(answer_t *answer);

/* verb_save.c: `#SAVE`, `#LOAD`, `#DEFAULTS`: the parameters to and from the board's storage, and back to what `#HELP`
 * says. On the ground without a reference only. */
bool verb_save(answer_t *answer);
bool verb_load(answer_t *answer);
bool verb_defaults(answer_t *answer);
/* Puts the stored set in force, if there is one, and reports that as `#LOAD` does. main(), with the radio's port made. */
void verb_load_at_start(void);

/* verb_log.c: `#LOG`, `#LOG seconds`, `#LOG CLEAR`, `#LOG STOP`: the flight recorder. */
bool verb_log(answer_t *answer);

/* verb_calibrate.c: `#CALIBRATE counts seconds`: hover calibration, to be called again until it ends. */
bool verb_calibrate(answer_t *answer);

/* verb_bench.c, for a board on the bench: `#STREAM PULSE|OFF`: the throttle pulse of every control cycle in place of the
 * telemetry; `#HANG TASK`: TaskSendLaser never completes a cycle again, so that the watchdog must bite. On the ground
 * without a reference only. */
bool verb_stream(answer_t *answer);
bool verb_hang(answer_t *answer);

/* Long answers go on between the lines: each sends what fits now and returns whether there is more to come. */
bool verb_log_more(void);
bool verb_calibrate_more(void);

#endif
