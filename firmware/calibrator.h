/* Hover calibration between TaskReceiveComm, which starts, stops and reports it, and TaskControl, which does it. */
#ifndef FIRMWARE_CALIBRATOR_H
#define FIRMWARE_CALIBRATOR_H

#include <stdint.h>

#include "control/calibration.h"

/* Limits as in calibration.h. Returns the sequence number of the request. TaskReceiveComm. */
uint16_t calibrator_start(float idle_percent, uint16_t step_counts, uint16_t period_s);

/* Ends it with TaskControl's next cycle; nothing when none runs. TaskReceiveComm. */
void calibrator_stop(void);

/* How far it is, with the sequence number of the request that TaskControl has seen. TaskReceiveComm. */
void calibrator_look(calibration_t *progress);

/* TaskControl, between flight_step() and the throttle. */
void calibrator_overlay(float link_s, const flight_inputs_t *in, flight_outputs_t *out);

#endif
