/* Commands that are not parameters: one function per command, one file per subject. Each function sends
 * its answers and returns whether the line was valid. Context: Task, TaskReceiveComm only. */
#ifndef FIRMWARE_VERBS_H
#define FIRMWARE_VERBS_H

#include <stdbool.h>

#include "firmware/answer.h"

/* verb_laser.c: `#LASER` answers two lines: state, bit rate, frames and losses; damages by cause and the
 * latest cause. */
bool verb_laser(answer_t *answer);

/* verb_imu.c: `#IMU` shows the latest frame, as measured and in the vehicle's axes. `#IMU LEVEL`, `RIGHT`,
 * `NOSE` find unit and axes; on the ground without thrust only. */
bool verb_imu(answer_t *answer);

/* verb_mirrors.c: `#MIRRORS` shows what each mirror showed at the latest rest, which of them did not show the
 * ground, and what they tell of the IMU. With LAYOUT THREE. */
bool verb_mirrors(answer_t *answer);

/* verb_stick.c: `#RC` shows the pulse of the pilot's stick, and whether it counts, or why not. */
bool verb_rc(answer_t *answer);

/* verb_battery.c: `#VOLTS` shows the voltage of the battery and of a cell, and how it is. */
bool verb_volts(answer_t *answer);

/* verb_perf.c: `#PERF` shows the cause of the reset, the processor load, per task response time, missed
 * deadlines and stack, and per server the longest wait. `#PERF RESET` clears the values that can be
 * cleared. */
bool verb_perf(answer_t *answer);
/* Builds a line of `#PERF`, the first is number 0, without its end. False behind the last. Any task. */
bool verb_perf_line(answer_t *answer, uint16_t number);

/* verb_save.c: `#SAVE` and `#LOAD` store and load the parameters, `#DEFAULTS` sets those of `#HELP`. On
 * the ground without a reference only. */
bool verb_save(answer_t *answer);
bool verb_load(answer_t *answer);
bool verb_defaults(answer_t *answer);
/* Loads the stored parameters, if there are any, and reports that as `#LOAD` does. main(), after the
 * radio's port is created. */
void verb_load_at_start(void);

/* verb_log.c: `#LOG`, `#LOG seconds`, `#LOG CLEAR`, `#LOG STOP`, `#LOG RATE FAST|SLOW`: the flight
 * recorder. */
bool verb_log(answer_t *answer);

/* verb_calibrate.c: `#CALIBRATE counts seconds`: hover calibration. */
bool verb_calibrate(answer_t *answer);

/* verb_bench.c, for a board on a test bench; on the ground without a reference only. `#STREAM PULSE|OFF`:
 * the throttle pulse of every control cycle in place of the telemetry. `#HANG TASK`: TaskSendLaser never
 * completes a cycle again, so the watchdog must reset the chip. */
bool verb_stream(answer_t *answer);
bool verb_hang(answer_t *answer);

/* Continue long answers between two lines of the operator. Each sends what fits now and returns whether
 * there is more. */
bool verb_log_more(void);
bool verb_calibrate_more(void);

#endif
