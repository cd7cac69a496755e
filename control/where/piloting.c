/* What breaks: a pilot's own motions look like an effect of the commands for a moment, so an effect is judged
 * over seconds (est/effect.c). */
#include "control/where/piloting.h"

#include "control/between.h"
#include "control/credible.h"
#include "control/laws/descent.h"
#include "control/touchdown.h"
#include "control/where/contact.h"
#include "control/where/hover_thrust.h"

#define GIVEN_BACK_N_PER_S 0.06F /* chosen: little, because the pilot may fly on for long */

static void watch_descent(pilot_state_t *pilot, const pilot_signs_t *signs)
{
    if (signs->state != FLIGHT_DESCENDING) {
        pilot->given_back = false;
    } else if (signs->handed_over && signs->entered) {
        pilot->given_back = true;
        /* a pin tells that he has given it back: then as without heights */
        pilot->sink_n_per_s = signs->has_pin ? SINK_FADE_N_PER_S : GIVEN_BACK_N_PER_S;
    }
}

/* LANDING: how long it has had far too little thrust to fly, and does not sink. */
static void watch_landing(pilot_state_t *pilot, const pilot_signs_t *signs)
{
    const bool weak = pilot_is_unknown(pilot) || signs->thrust_n < signs->hover_n - HOVER_THRUST_MARGIN_N;
    const bool sinks = signs->height_mm < LOW_MM || signs->rise_mps < -0.001F * DESCENT_RATE_MM_S;

    if (!weak || sinks || signs->entered) {
        pilot->vain_s = 0.0F;
    } else {
        pilot->vain_s = at_most(pilot->vain_s + signs->step_s, UNPOWERED_S);
    }
}

/* A landing too: a vehicle that has lost a load sinks as little as one that a pilot holds up, but it obeys.
 */
static bool shows_effect_in(flight_state_t state)
{
    return state == FLIGHT_FLOATING || state == FLIGHT_LANDING;
}

/* The throttle is unknown: does the vehicle do what is commanded? */
static pilot_news_t watch_effect(pilot_state_t *pilot, const pilot_signs_t *signs, bool begins)
{
    const uint32_t since_us = signs->frame_us - pilot->effect_us;
    const bool had_effect = pilot->effect.has_effect;

    pilot->effect_us = signs->frame_us;
    if (begins || !shows_effect_in(signs->state) || !signs->felt || since_us > FRAME_GAP_US) {
        effect_init(&pilot->effect);
    } else if (since_us > 0U) {
        effect_step(&pilot->effect, signs->pushed_mps2, signs->felt_mps2, (float)since_us * 1.0e-6F);
        return (pilot->effect.has_effect && !had_effect) ? PILOT_SHOWS_EFFECT : PILOT_NO_NEWS;
    }
    return PILOT_NO_NEWS;
}

bool pilot_holds_up(const pilot_state_t *pilot, flight_state_t state)
{
    return state == FLIGHT_LANDING && pilot->vain_s >= UNPOWERED_S;
}

pilot_news_t pilot_step(pilot_state_t *pilot, const pilot_signs_t *signs)
{
    const bool before = pilot_is_unknown(pilot);

    watch_descent(pilot, signs);
    if (signs->state == FLIGHT_LANDING) {
        watch_landing(pilot, signs);
    }
    const bool unsure = (signs->state == FLIGHT_FLOATING && signs->has_throttle) ||
                        pilot_holds_up(pilot, signs->state);
    const bool unknown = pilot->given_back || (unsure && !signs->has_pin);

    pilot->throttle = unknown ? THROTTLE_UNKNOWN : signs->has_throttle ? THROTTLE_OURS : THROTTLE_PILOT;
    if (unknown) {
        return watch_effect(pilot, signs, !before);
    }
    return (before && signs->state != FLIGHT_GROUND) ? PILOT_IS_SURE : PILOT_NO_NEWS;
}
