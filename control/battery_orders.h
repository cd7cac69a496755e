/* What an empty battery orders: to land, as #SETR 0 does. It orders once. Who orders another reference after
 * that in the air has it for 10 s, then it lands again. On the ground no reference counts until there is
 * another battery, or BAT NONE.
 *
 * Nothing but BATTERY_EMPTY orders: a voltage that is not believed never lands a vehicle. While the pilot has
 * the throttle the order waits for the hand-back, as any other. Pure; the caller owns the state, all zero at
 * first. */
#ifndef CONTROL_BATTERY_ORDERS_H
#define CONTROL_BATTERY_ORDERS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/battery.h"
#include "control/flight_io.h"

typedef struct {
    uint32_t heard; /* sequence of the latest reference of the operator, or of the stick */
    uint32_t ordered;
    float reference_m;
    bool landing; /* ordered, and nobody has ordered anything since */
    float wait_s; /* until it may order again */
    uint32_t now_us;
} battery_orders_t;

/* One cycle, before flight_step() and behind stick_orders_step(): changes the reference of *in. before:
 * outputs of the cycle before. */
void battery_orders_step(battery_orders_t *orders, battery_verdict_t verdict, const flight_outputs_t *before,
                         flight_inputs_t *in);

/* Whether a reference above 0 would not count now. */
bool battery_orders_forbid(battery_verdict_t verdict, flight_state_t state);

#endif
