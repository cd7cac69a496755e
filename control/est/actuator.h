/* Model of the actuator, from the commanded thrust to the delivered thrust: a dead time (pulse and
 * autopilot), then a first-order lag (motors and rotors). It keeps the commands that have been given but
 * have no effect yet. The estimator and the Smith predictor use it.
 *
 * Newtons per motor. Times are in microseconds on one wrapping 32-bit clock. Pure; the caller owns the
 * state. */
#ifndef CONTROL_ACTUATOR_H
#define CONTROL_ACTUATOR_H

#include <stdint.h>

#define ACTUATOR_COMMANDS 12U /* more commands than the dead time can hold */

typedef struct {
    uint32_t due_us; /* when the command takes effect */
    float thrust_n;
} actuator_command_t;

typedef struct {
    uint32_t delay_us; /* dead time */
    float lag_s;       /* > 0 */
    uint32_t time_us;  /* instant of thrust_n and demand_n */
    float thrust_n;    /* delivered thrust */
    float demand_n;    /* command in effect; thrust_n approaches it with the lag */
    uint16_t count;
    actuator_command_t coming[ACTUATOR_COMMANDS]; /* commands within the dead time, oldest first */
} actuator_t;

/* No thrust, no command; delay_s and lag_s must be told by actuator_describe(). */
void actuator_init(actuator_t *actuator, uint32_t now_us);

/* Dead time and lag, > 0, from now on. Commands that have been given keep their dead time. */
void actuator_describe(actuator_t *actuator, float delay_s, float lag_s);

/* Records a command that is given at now_us. If too many commands are within the dead time, the oldest one
 * takes effect at once. */
void actuator_command(actuator_t *actuator, float thrust_n, uint32_t now_us);

/* Moves the model forward to time_us. A time before actuator->time_us changes nothing. */
void actuator_advance(actuator_t *actuator, uint32_t time_us);

/* The model as it will be then, if no other command is given. */
actuator_t actuator_at(const actuator_t *actuator, uint32_t time_us);

#endif
