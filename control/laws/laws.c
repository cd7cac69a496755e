/* The mode computes the thrust. In the air every change of the mode is without a jump of the thrust: bumpless
 * transfer, as in any text on control. */
#include "control/laws/laws.h"

#include "control/between.h"
#include "control/credible.h"
#include "control/flight_io.h"
#include "control/touchdown.h"

#define TRANSFER_TIME_S 0.4F /* chosen: four scans */

static float no_thrust(laws_t *laws, est_law_t *est, const situation_t *now)
{
    (void)laws;
    (void)est;
    (void)now;
    return 0.0F;
}

float law_hover_step(laws_t *laws, est_law_t *est, const situation_t *now)
{
    (void)laws;
    (void)est;
    return now->where->hover.thrust_n;
}

/* By mode; LAW has rows of its own. */
static const law_step_t steps_of_mode[FLIGHT_MODE_COUNT] = {
    [FLIGHT_MODE_IDLE] = no_thrust,           [FLIGHT_MODE_LAW] = no_thrust,
    [FLIGHT_MODE_HOVER] = law_hover_step,     [FLIGHT_MODE_FLOAT] = law_pidt_step,
    [FLIGHT_MODE_DESCENT] = law_descent_step, [FLIGHT_MODE_BLIND_DESCENT] = law_blind_step,
    [FLIGHT_MODE_EST_HOLD] = law_est_hold,    [FLIGHT_MODE_EST_LAND] = law_est_land,
    [FLIGHT_MODE_EST_SINK] = law_est_sink,
};
/* By the law in force, where the chosen law flies. */
#define LAW_ROW(name, step, cycles) {step, cycles},
static const struct {
    law_step_t step;
    law_cycles_t cycles;
} law_rows[LAW_COUNT] = {LAWS(LAW_ROW)};
#undef LAW_ROW

static void reset(laws_t *laws)
{
    pid_reset(&laws->pid);
    pidt_reset(&laws->pidt);
}

static void resume_law(laws_t *laws, const situation_t *now)
{
    const bool flying = now->where->supervisor.state == FLIGHT_FLYING;

    pid_resume(&laws->pid);
    pidt_resume(&laws->pidt);
    if (modes_use_estimate(now->mode_before) && flying) { /* as EST has estimated it */
        laws->pidt.integral_n = now->where->hover.thrust_n - now->parameters->value[PARAMETER_GRAV];
    }
}

void laws_change(laws_t *laws, const situation_t *now)
{
    if (now->mode == FLIGHT_MODE_DESCENT) {
        descent_start(&laws->descent, now->where->supervisor.height.rate_mm_s);
    }
    if (now->mode == FLIGHT_MODE_LAW) {
        resume_law(laws, now);
    } else if (now->mode == FLIGHT_MODE_FLOAT) {
        pidt_reset(&laws->pidt);
    } else if (now->where->supervisor.state != FLIGHT_COASTING) {
        reset(laws);
    }
}

/* A new GRAV changes no thrust of a law that flies: its integral takes the difference over. PD has none, so
 * its thrust follows. FLOATING follows too: GRAV is what a pilot will be given. */
static void take_gravity(laws_t *laws, const situation_t *now)
{
    const float gravity_n = now->parameters->value[PARAMETER_GRAV];

    if (now->mode == FLIGHT_MODE_LAW && now->mode_before == FLIGHT_MODE_LAW) {
        laws->pid.integral_n -= gravity_n - laws->gravity_n;
        laws->pidt.integral_n -= gravity_n - laws->gravity_n;
    }
    laws->gravity_n = gravity_n;
}

/* The setpoint of the mode. Returns true when the law has gained or lost its integral action. */
static bool take_sample(laws_t *laws, est_law_t *est, const situation_t *now)
{
    const law_step_t step = (now->mode == FLIGHT_MODE_LAW) ? law_rows[now->law].step
                                                           : steps_of_mode[now->mode];
    const bool had_integral = laws->integral;

    take_gravity(laws, now);
    laws->setpoint_n = step(laws, est, now);
    return laws->integral != had_integral;
}

static void ramp_down(laws_t *laws, const situation_t *now)
{
    laws->setpoint_n = now->thrust_n - LANDED_FADE_N_PER_S * where_step_s(now->where);
    laws->transfer_n = 0.0F;
}

/* Another law goes on without the estimate. The latest command may have been an answer to noise. */
static bool loses_estimate(const situation_t *now)
{
    return modes_use_estimate(now->mode_before) && !est_law_ready(now->est);
}

/* The mode starts with its own thrust. */
static bool starts_at_once(const situation_t *now)
{
    return now->mode == FLIGHT_MODE_DESCENT || now->mode == FLIGHT_MODE_EST_LAND ||
           now->mode_before == FLIGHT_MODE_IDLE ||
           (now->mode_before == FLIGHT_MODE_HOVER && contact_lifts(&now->where->contact));
}

/* The mode has changed, but not from law EST to itself; or the thrust need not stay near hover any more. */
static bool changes(laws_t *laws, const situation_t *now)
{
    const bool both_est = modes_use_estimate(now->mode_before) && modes_use_estimate(now->mode);
    const bool floated = laws->floated;

    laws->floated = now->where->supervisor.state == FLIGHT_FLOATING;
    return (now->mode_before != now->mode && !both_est) || (floated && !laws->floated);
}

/* law_changed: the law, or its integral action. */
static void transfer(laws_t *laws, const situation_t *now, bool law_changed)
{
    const float hover_n = now->where->hover.thrust_n;
    const bool changed = changes(laws, now);

    if (now->mode == FLIGHT_MODE_IDLE || (changed && starts_at_once(now))) {
        laws->transfer_n = 0.0F;
    } else if (law_changed && !loses_estimate(now)) {
        laws->transfer_n = now->thrust_n - laws->setpoint_n;
    } else if (changed) {
        laws->transfer_n = between(hover_n - NEAR_HOVER_N, now->thrust_n, hover_n + NEAR_HOVER_N) -
                           laws->setpoint_n;
    } else {
        laws->transfer_n *= TRANSFER_TIME_S / (TRANSFER_TIME_S + where_step_s(now->where));
    }
}

float laws_step(laws_t *laws, est_law_t *est, const situation_t *now, bool law_changed)
{
    bool changed = law_changed;

    if (where_stops(now->where)) {
        ramp_down(laws, now);
    } else {
        changed = take_sample(laws, est, now) || changed;
    }
    transfer(laws, now, changed);
    return laws->setpoint_n + laws->transfer_n;
}

uint16_t laws_releases(const parameters_t *parameters, flight_mode_t mode)
{
    const law_cycles_t cycles = law_rows[parameters_choice(parameters, PARAMETER_LAW)].cycles;

    if (modes_use_estimate(mode) || cycles == CYCLES_BY_FRAME) {
        return FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME;
    }
    if (cycles == CYCLES_BY_HEIGHT || parameters_choice(parameters, PARAMETER_RELEASE) == RELEASE_SCAN) {
        return FLIGHT_RELEASE_HEIGHT;
    }
    return FLIGHT_RELEASE_PERIOD;
}
