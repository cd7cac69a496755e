/* Thrust per motor and throttle pulse: seed document eq. 4-5, in microseconds. The autopilot's throttle is
 * inverted: a shorter pulse is more thrust. "Newton" here is the seed's actuator unit, not a calibrated
 * force. Pure; any context. */
#ifndef CONTROL_THRUST_H
#define CONTROL_THRUST_H

#define THRUST_MAX_N 11.76F /* seed eq. 4-5: where the pulse is 1 ms */
/* Of the hover thrust; the rotors keep turning. IDLE as delivered, 15 % of the throttle, is 1.76 N: a quarter
 * of the seed's 7 N. */
#define THRUST_LEAST_SHARE 0.25F
#define THRUST_STEP_US 0.48F                            /* the seed's resolution of the pulse */
#define THRUST_IDLE_PULSE_US (4166.0F * THRUST_STEP_US) /* no thrust, "2 ms" */
#define THRUST_FULL_PULSE_US (2082.0F * THRUST_STEP_US) /* full thrust, "1 ms" */

/* Pulse length for a thrust: (4166 - 177.21 T) counts of 0.48 us, clipped to the two ends. NaN gives the
 * idle pulse. */
float thrust_to_pulse_us(float thrust_n);

/* Inverse of thrust_to_pulse_us(), clipped to 0 .. THRUST_MAX_N. NaN gives 0. */
float thrust_from_pulse_us(float pulse_us);

/* Converts percent of the throttle's range, as the autopilot shows it, to newtons per motor. */
float thrust_of_percent(float percent);

#endif
