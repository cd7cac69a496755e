/* What a cycle tells the rest of the firmware. */
#ifndef CONTROL_OUTPUTS_H
#define CONTROL_OUTPUTS_H

#include "control/flight_io.h"
#include "control/situation.h"

/* Everything but bound, imu_fault and releases. out_of_reach: the vehicle does not get to the reference.
 * thrust_n: as the guard has left it. */
void outputs_write(const situation_t *now, bool out_of_reach, float thrust_n, flight_outputs_t *out);

#endif
