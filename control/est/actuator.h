/* The way of a commanded thrust to the rotors: a dead time (pulse, autopilot) and a first-order lag (motors). Keeps the
 * thrust that is delivered at one instant, and tells what the commands on their way will make of it. Pure; the caller
 * owns the state. */
#ifndef CONTROL_ACTUATOR_H
#define CONTROL_ACTUATOR_H

#include <stdint.h>

#define ACTUATOR_DELAY_US UINT32_C(18500)   /* half a pulse period 6.8, the pulse 1.5, the autopilot 10 ms (assumed) */
#define ACTUATOR_LAG_S 0.12F                /* assumed of motors and rotors of this size */
#define ACTUATOR_COMMANDS 12U               /* more than come within the delay */

typedef struct {
    uint32_t due_us;        /* takes effect */
    float thrust_n;
} actuator_command_t;

typedef struct {
    uint32_t time_us;       /* thrust_n and demand_n hold here */
    float thrust_n;         /* delivered, newtons per motor */
    float demand_n;         /* the command in effect */
    uint16_t count;
    actuator_command_t coming[ACTUATOR_COMMANDS];   /* oldest first */
} actuator_t;

void actuator_init(actuator_t *actuator, uint32_t now_us);

/* A command given now. Too many on their way: the oldest takes effect at once. */
void actuator_command(actuator_t *actuator, float thrust_n, uint32_t now_us);

/* Brings thrust_n to a later instant; an earlier one changes nothing. */
void actuator_advance(actuator_t *actuator, uint32_t time_us);

#endif
