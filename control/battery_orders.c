#include "control/battery_orders.h"

#include "control/seconds.h"

#define AGAIN_S 10.0F /* as long as it takes to be found empty, control/battery.c */

/* Not on its way down yet. */
static bool flies(flight_state_t state)
{
    return state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING || state == FLIGHT_FLOATING ||
           state == FLIGHT_COASTING || state == FLIGHT_LOWERING;
}

bool battery_orders_forbid(battery_verdict_t verdict, flight_state_t state)
{
    return verdict == BATTERY_EMPTY && state == FLIGHT_GROUND;
}

static void listen(battery_orders_t *orders, battery_verdict_t verdict, const flight_outputs_t *before,
                   const flight_inputs_t *in)
{
    if (in->reference_sequence == orders->heard) {
        return;
    }
    orders->heard = in->reference_sequence;
    orders->reference_m = battery_orders_forbid(verdict, before->state) ? 0.0F : in->reference_m;
    orders->landing = false;
    orders->wait_s = (verdict == BATTERY_EMPTY) ? AGAIN_S : 0.0F;
}

void battery_orders_step(battery_orders_t *orders, battery_verdict_t verdict, const flight_outputs_t *before,
                         flight_inputs_t *in)
{
    orders->wait_s = at_least(orders->wait_s - seconds_at_most(in->now_us - orders->now_us, CYCLE_MAX_S),
                              0.0F);
    orders->now_us = in->now_us;
    listen(orders, verdict, before, in);
    if (before->state == FLIGHT_GROUND) {
        orders->landing = false;
    } else if (verdict == BATTERY_EMPTY && !orders->landing && orders->wait_s <= 0.0F &&
               flies(before->state)) {
        orders->reference_m = 0.0F;
        orders->landing = true;
        ++orders->ordered;
    }
    in->reference_m = orders->reference_m;
    in->reference_sequence = orders->heard + orders->ordered;
}
