/* A descent by the heights, held at first. What breaks: with a pilot the same output moves nothing, so its
 * own heights tell nothing about it; the bounds keep it near the hover thrust. */
#include "control/laws/stuck_pin.h"

#include "control/between.h"
#include "control/credible.h"
#include "control/seconds.h"
#include "control/thrust.h"

#define PIN_TRUSTED_S 5.0F /* it warns first: PX4, COM_FAIL_ACT_T */
/* A wrong height may ask for it: so much climbs at 1.2 m/s at most, the speed of a hard touch, with the
 * lightest vehicle, 5.6 N, and the least damping, 1.5 1/s (tools/campaign/plan.py): 1.2 m/s * 1.5 1/s * 5.6 N
 * / 9.81 m/s2.
 */
#define PIN_ABOVE_N 1.0F
#define PIN_BELOW_N (2.0F * PIN_ABOVE_N) /* a load of a newton is let go, and as much to sink */
#define VAIN_S 0.7F /* chosen of 0.5, 0.7 and 1 by lies: about 1 / damping, 1.5 1/s at the least */
#define RISES_MM (1000.0F * LAW_REACH_M) /* more than a pilot who holds a height */

static void reset(stuck_pin_t *pin)
{
    pin->piloted_s = 0.0F;
    pin->more_n = 0.0F;
    pin->vain_s = 0.0F;
    pin->obeys = false;
    pin->stepped = false;
}

/* A new height that is a step shows no motion. Two in a row do: what moves fast and is not felt steps in each
 * scan. */
static bool is_step(stuck_pin_t *pin, const situation_t *now)
{
    if (now->where->supervisor.height.is_new) {
        pin->stepped = now->evidence->stepped && !pin->stepped;
    }
    return pin->stepped;
}

/* A vehicle with 1.5 N too little sinks, unless a pilot holds it up. He moves it to and fro, so a moment of
 * sinking takes back no more than a moment. Once that is known, the thrust returns near the hover thrust,
 * because he may give the throttle back before the pin tells. That is a test too: a vehicle that has only
 * lost a load rises then, so it obeys. The thrust with which it did not sink is then about its hover thrust.
 * Both stay known for this turn. */
static bool is_in_vain(stuck_pin_t *pin, const situation_t *now, bool step)
{
    const height_track_t *height = &now->where->supervisor.height;
    const bool fresh = height->age_us <= HEIGHT_FRESH_US;

    if (pin->vain_s < VAIN_S) {
        const float step_s = where_step_s(now->where);
        const bool stays = fresh && height->rate_mm_s >= -0.5F * pin->descent.sink_mm_s;
        const bool weak = pin->more_n < -HOVER_THRUST_MARGIN_N;

        pin->vain_s = weak ? at_least(pin->vain_s + (stays ? step_s : -step_s), 0.0F) : 0.0F;
        pin->vain_mm = height->height_mm;
    } else if (step) {
        pin->vain_mm = height->height_mm; /* the pilot has flown over an edge */
    } else if (!pin->obeys && fresh && height->height_mm > pin->vain_mm + RISES_MM) {
        pin->obeys = true;
        pin->descent.trim_n = -HOVER_THRUST_MARGIN_N;
    }
    return pin->vain_s >= VAIN_S && !pin->obeys;
}

/* Thrust of a descent by heights, or without them; it only holds the height while the pin is trusted. */
static float descent_n(stuck_pin_t *pin, const situation_t *now, bool step)
{
    const supervisor_t *supervisor = &now->where->supervisor;
    const height_track_t *height = &supervisor->height;
    const float hover_n = now->where->hover.thrust_n;
    const bool holds = pin->piloted_s < PIN_TRUSTED_S && !supervisor->land;

    if (height->age_us > HEIGHT_LOST_US) {
        return holds ? hover_n : descent_blind(hover_n, seconds_at_most(height->age_us, DESCENT_BLIND_MAX_S));
    }
    if (!height->is_new || step) {
        return hover_n + pin->more_n;
    }
    pin->descent.holds = holds;
    pin->descent.rocks = now->rocks;
    return descent_step(&pin->descent, hover_n, height->height_mm, height->rate_mm_s,
                        seconds_at_most(height->gap_us, HEIGHT_FRESH_S));
}

void stuck_pin_step(stuck_pin_t *pin, const situation_t *now)
{
    const bool piloted = (now->where->supervisor.flags & FLIGHT_FLAG_PILOT) != 0U;

    if (now->mode != now->mode_before) {
        reset(pin);
    }
    if (now->mode != FLIGHT_MODE_HOVER) {
        return;
    }
    if (!piloted || pin->piloted_s <= 0.0F) {
        descent_start(&pin->descent, 0.0F);
        reset(pin);
    }
    if (piloted) {
        pin->piloted_s += where_step_s(now->where);
        const bool step = is_step(pin, now);
        const bool in_vain = is_in_vain(pin, now, step);

        /* his motions must not add up: so a fall is braked at once when he has given it back */
        pin->descent.trim_n = in_vain ? 0.0F : pin->descent.trim_n;
        const float wanted_n = descent_n(pin, now, step) - now->where->hover.thrust_n;
        const float sunk_n = in_vain ? NEAR_HOVER_N : PIN_BELOW_N;
        const float least_n = (pin->descent.near_ground_s > 0.0F) ? -THRUST_MAX_N : -sunk_n;

        pin->more_n = at_least(between(least_n, wanted_n, PIN_ABOVE_N), now->idle_n - now->thrust_n);
    }
}
