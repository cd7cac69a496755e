/* A descent by the heights, held at first. What breaks: with a pilot the same output moves nothing, so its
 * own heights tell nothing about it; the bounds keep it near the hover thrust. */
#include "control/laws/stuck_pin.h"

#include "control/between.h"
#include "control/credible.h"
#include "control/seconds.h"
#include "control/thrust.h"

#define PIN_TRUSTED_S 5.0F               /* chosen: a loose contact is over sooner */
#define PIN_BELOW_N (2.0F * PIN_ABOVE_N) /* the load is let go, and as much to sink */
#define PIN_ABOVE_N 1.0F                 /* chosen: a load of a newton */

static void reset(stuck_pin_t *pin)
{
    pin->piloted_s = 0.0F;
    pin->more_n = 0.0F;
}

/* Thrust of a descent by heights, or without them; it only holds the height while the pin is trusted. */
static float descent_n(stuck_pin_t *pin, const situation_t *now)
{
    const supervisor_t *supervisor = &now->where->supervisor;
    const height_track_t *height = &supervisor->height;
    const float hover_n = now->where->hover.thrust_n;
    const bool holds = pin->piloted_s < PIN_TRUSTED_S && !supervisor->land;

    if (height->age_us > HEIGHT_LOST_US) {
        return holds ? hover_n : descent_blind(hover_n, seconds_at_most(height->age_us, DESCENT_BLIND_MAX_S));
    }
    if (!height->is_new) {
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
        descent_start(&pin->descent);
        reset(pin);
    }
    if (piloted) {
        pin->piloted_s += where_step_s(now->where);
        const float wanted_n = descent_n(pin, now) - now->where->hover.thrust_n;
        const float least_n = (pin->descent.near_ground_s > 0.0F) ? -THRUST_MAX_N : -PIN_BELOW_N;

        pin->more_n = at_least(between(least_n, wanted_n, PIN_ABOVE_N), now->idle_n - now->thrust_n);
    }
}
