/* What breaks: a held height that follows too slowly pulls against a pilot. */
#include "control/aim.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"

#define UNKNOWN_REACH_M 0.06F /* tried 0.05 to 0.09; asks for 0.8 N at the delivered gains */

float aim_height_m(const aim_t *aim, const supervisor_t *supervisor)
{
    return (supervisor->state == FLIGHT_FLOATING) ? aim->floating_m : supervisor->reference_m;
}

float aim_wanted_m(const aim_t *aim, const supervisor_t *supervisor, flight_mode_t mode)
{
    const flight_state_t state = supervisor->state;
    const bool holds = state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING || state == FLIGHT_LOWERING ||
                       (state == FLIGHT_FLOATING && mode != FLIGHT_MODE_HOVER);

    return holds ? aim_height_m(aim, supervisor) - aim->ignored_m - supervisor->height.height_mm * 0.001F
                 : NAN;
}

static void hold_floating(aim_t *aim, const where_t *where, flight_mode_t mode, flight_mode_t mode_before)
{
    const pilot_state_t *pilot = &where->pilot;
    const float height_m = where->supervisor.height.height_mm * 0.001F;
    const bool holds = modes_hold(mode_before) && where->supervisor.state == FLIGHT_FLOATING &&
                       mode != FLIGHT_MODE_HOVER;
    const bool unsure = pilot_is_unknown(pilot) && !pilot_shows_effect(pilot);
    const float reach_m = unsure ? UNKNOWN_REACH_M : LAW_REACH_M;

    aim->floating_m = holds ? between(height_m - reach_m, aim->floating_m, height_m + reach_m) : height_m;
}

static void judge(aim_t *aim, const where_t *where)
{
    const supervisor_t *supervisor = &where->supervisor;
    const bool acts = supervisor->state == FLIGHT_TAKEOFF || supervisor->state == FLIGHT_FLYING;

    if (!acts || supervisor->reference_m != aim->reach_m) {
        reach_reset(&aim->reach);
    }
    aim->reach_m = supervisor->reference_m;
    aim->out_of_reach = acts ? reach_step(&aim->reach,
                                          supervisor->height.height_mm -
                                              (supervisor->reference_m - aim->ignored_m) * 1000.0F,
                                          supervisor->step_us)
                             : pilot_holds_up(&where->pilot, supervisor->state);
}

void aim_step(aim_t *aim, const situation_t *now)
{
    aim->ignored_m = now->est->terrain.ignored_m;
    hold_floating(aim, now->where, now->mode, now->mode_before);
    judge(aim, now->where);
}
