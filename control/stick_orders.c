#include "control/stick_orders.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/imu_axes.h"
#include "control/seconds.h"

/* chosen: 60 us of a pulse. PX4 has 0.1 (MPC_HOLD_DZ), for sticks that spring to the middle; a throttle's
 * stick does not. */
#define DEAD_BAND 0.15F
#define HELD_S 1.0F        /* what the stick says so long is meant: PX4, COM_RC_ARM_HYST */
#define RAISED_MOST_M 1.0F /* chosen: half a room */
#define LEAD_MOST_M LAW_REACH_M
#define TAKE_OFF_UP 0.3F          /* PX4's FlightTaskManualAltitude::_checkTakeoff() */
#define TAKE_OFF_M LEAD_MOST_M    /* from the ground */
#define MOTORS_STOP_PERCENT 10.0F /* the autopilot stops its motors below it, docs/operator.md */
#define STEP_MOST_S 0.2F          /* a control cycle comes within 150 ms */
#define MIDDLE_PERCENT 50.0F      /* of 0 to 100 */
#define US_PER_PERCENT 10.0F      /* a pulse of 1 to 2 ms */

static bool is_wired(const parameters_t *parameters)
{
    return parameters_choice(parameters, PARAMETER_STICK) == STICK_PIN &&
           parameters_choice(parameters, PARAMETER_SEL) == SEL_PIN;
}

static void order(stick_orders_t *orders, float reference_m)
{
    orders->reference_m = reference_m;
    orders->landing = reference_m == 0.0F;
    ++orders->references.by_stick;
}

static void arm(stick_orders_t *orders, bool armed)
{
    orders->arm = armed;
    ++orders->arms.by_stick;
}

/* True when the radio has asked for something in this cycle. */
static bool listen(stick_orders_t *orders, const flight_inputs_t *in)
{
    const bool referred = in->reference_sequence != orders->references.by_radio;

    if (referred) {
        orders->references.by_radio = in->reference_sequence;
        orders->reference_m = in->reference_m;
        orders->landing = false;
    }
    if (in->arm_sequence != orders->arms.by_radio) {
        orders->arms.by_radio = in->arm_sequence;
        orders->arm = in->arm;
    }
    return referred;
}

/* In the pilot's hands, on the ground: he opens the throttle to keep the motors running, and then hands over.
 */
static void watch_throttle(stick_orders_t *orders, const stick_t *stick, float middle_us, float step_s)
{
    const float percent = MIDDLE_PERCENT + (middle_us - stick_pulse_us(stick)) / US_PER_PERCENT;
    const bool differs = orders->opened ? percent < MOTORS_STOP_PERCENT : percent > MOTORS_STOP_PERCENT;

    orders->open_s = differs ? orders->open_s + step_s : 0.0F;
    if (orders->open_s >= HELD_S) {
        orders->open_s = 0.0F;
        orders->opened = !orders->opened;
        arm(orders, orders->opened);
    }
}

static void watch_middle(stick_orders_t *orders, float up, float step_s)
{
    const bool middle = fabsf(up) <= DEAD_BAND;

    orders->middle_s = middle ? at_most(orders->middle_s + step_s, HELD_S) : 0.0F;
    if (middle) {
        orders->pushed = false;
        orders->raised_m = 0.0F;
        orders->held_s = 0.0F;
    }
    orders->counts = orders->counts || orders->middle_s >= HELD_S;
}

/* Held so for long enough: an order that is given once. */
static bool held(stick_orders_t *orders, bool so, float step_s)
{
    orders->held_s = (so && !orders->pushed) ? orders->held_s + step_s : 0.0F;
    if (orders->held_s < HELD_S) {
        return false;
    }
    orders->held_s = 0.0F;
    orders->pushed = true;
    return true;
}

static float rate_mps(float up, float most_mps)
{
    const float beyond = fabsf(up) - DEAD_BAND;

    return (beyond <= 0.0F) ? 0.0F : copysignf(most_mps * beyond / (1.0F - DEAD_BAND), up);
}

/* Toward where the stick shows, and never away from the height. */
static float moved_m(const stick_orders_t *orders, float reference_m, float height_m, float by_m)
{
    const float highest_m = at_most(FLIGHT_REFERENCE_MAX_M, height_m + LEAD_MOST_M);
    const float lowest_m = at_least(STICK_LEAST_M, height_m - LEAD_MOST_M);

    if (by_m > 0.0F) {
        const float left_m = at_least(RAISED_MOST_M - orders->raised_m, 0.0F);
        return at_least(at_most(reference_m + at_most(by_m, left_m), highest_m), reference_m);
    }
    return at_most(at_least(reference_m + by_m, lowest_m), reference_m);
}

static void fly(stick_orders_t *orders, const parameters_t *parameters, const flight_outputs_t *before,
                float up, float step_s)
{
    const float by_m = rate_mps(up, parameters->value[PARAMETER_SRATE]) * step_s;
    const bool lowest = before->reference_m <= STICK_LEAST_M;

    if (held(orders, lowest && up < -DEAD_BAND, step_s)) {
        order(orders, 0.0F);
    } else if (by_m != 0.0F && before->estimate_mm == before->estimate_mm) {
        const float to_m = moved_m(orders, before->reference_m, before->estimate_mm * 0.001F, by_m);
        orders->raised_m += at_least(to_m - before->reference_m, 0.0F);
        if (to_m != before->reference_m) {
            order(orders, to_m);
        }
    }
}

static bool refuses_take_off(const parameters_t *parameters, const flight_outputs_t *before)
{
    return imu_axes_forbid(before->imu_fault, parameters) || flight_mirrors_forbid(before);
}

static void command(stick_orders_t *orders, const parameters_t *parameters, const flight_outputs_t *before,
                    float up, float step_s)
{
    const bool armed = before->state == FLIGHT_GROUND && before->idle_n > 0.0F;
    const bool again = before->state == FLIGHT_LANDING && orders->landing;
    const bool floats = before->state == FLIGHT_FLOATING && before->estimate_mm == before->estimate_mm;
    const bool pushes = up > TAKE_OFF_UP;

    if (armed && pushes && refuses_take_off(parameters, before)) {
        orders->pushed = true; /* a refused push does not wait until somebody has freed the mirrors */
    }
    if (before->state == FLIGHT_FLYING) {
        fly(orders, parameters, before, up, step_s);
    } else if (armed || again) {
        if (held(orders, pushes, step_s)) {
            order(orders, TAKE_OFF_M);
        }
    } else if (floats) {
        order(orders, between(STICK_LEAST_M, before->estimate_mm * 0.001F, FLIGHT_REFERENCE_MAX_M));
    }
}

static void obey(stick_orders_t *orders, const parameters_t *parameters, const stick_t *stick,
                 const flight_outputs_t *before, bool has_throttle, float step_s)
{
    const bool good = is_wired(parameters) && stick_is_good(stick);
    const float up = good ? stick_up(stick, parameters->value[PARAMETER_SMID]) : 0.0F;

    if (!good || !has_throttle) {
        orders->counts = false;
        orders->middle_s = 0.0F;
    }
    if (good && !has_throttle && before->state == FLIGHT_GROUND) {
        watch_throttle(orders, stick, parameters->value[PARAMETER_SMID], step_s);
    } else if (good && has_throttle) {
        watch_middle(orders, up, step_s);
        if (orders->counts) {
            command(orders, parameters, before, up, step_s);
        }
    }
}

void stick_orders_step(stick_orders_t *orders, const parameters_t *parameters, const stick_t *stick,
                       const flight_outputs_t *before, flight_inputs_t *in)
{
    const float step_s = seconds_at_most(in->now_us - orders->now_us, STEP_MOST_S);

    orders->now_us = in->now_us;
    if (!listen(orders, in)) {
        obey(orders, parameters, stick, before, in->has_throttle, step_s);
    }
    in->reference_m = orders->reference_m;
    in->reference_sequence = orders->references.by_radio + orders->references.by_stick;
    in->arm = orders->arm;
    in->arm_sequence = orders->arms.by_radio + orders->arms.by_stick;
}

uint16_t stick_orders_flag(const stick_orders_t *orders, const parameters_t *parameters, const stick_t *stick,
                           bool has_throttle)
{
    const bool sets = is_wired(parameters) && stick_is_good(stick) && (orders->counts || !has_throttle);

    return (parameters_choice(parameters, PARAMETER_STICK) == STICK_PIN && !sets) ? FLIGHT_FLAG_STICK : 0U;
}
