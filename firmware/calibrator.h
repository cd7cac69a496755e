/* Hover calibration: the exchange between two tasks. TaskReceiveComm starts, stops and reports it.
 * TaskControl performs it (control/calibration.h). */
#ifndef FIRMWARE_CALIBRATOR_H
#define FIRMWARE_CALIBRATOR_H

#include <stdint.h>

#include "control/calibration.h"

/* Starts a calibration. idle_percent: of the throttle's range. step_counts, period_s: limits as in
 * calibration.h, checked by the caller. Returns the sequence number of the request. TaskReceiveComm. */
uint16_t calibrator_start(float idle_percent, uint16_t step_counts, uint16_t period_s);

/* Stops the calibration in TaskControl's next cycle. Does nothing when none runs. TaskReceiveComm. */
void calibrator_stop(void);

/* Copies the progress to *progress. progress->sequence is the latest request that TaskControl has
 * processed. TaskReceiveComm. */
void calibrator_look(calibration_t *progress);

/* Replaces thrust and pulse in *out while a calibration runs. link_s: parameter LINK in seconds, 0 = off.
 * TaskControl, after flight_step() and before the throttle is written. */
void calibrator_overlay(float link_s, const flight_inputs_t *in, flight_outputs_t *out);

#endif
