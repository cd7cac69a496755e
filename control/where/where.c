#include "control/where/where.h"

#include "control/seconds.h"

float where_step_s(const where_t *where)
{
    return seconds_at_most(where->supervisor.step_us, CYCLE_MAX_S);
}

float where_gap_s(const where_t *where, uint32_t now_us)
{
    const supervisor_t *supervisor = &where->supervisor;

    return supervisor->started ? seconds_at_most(now_us - supervisor->now_us, CYCLE_MAX_S) : 0.0F;
}

bool where_stops(const where_t *where)
{
    return contact_stops(&where->contact, where->supervisor.state);
}

bool where_descends(const where_t *where)
{
    const flight_state_t state = where->supervisor.state;

    return state == FLIGHT_DESCENDING || state == FLIGHT_LANDING || state == FLIGHT_LOWERING;
}

bool where_lets_down(const where_t *where)
{
    return where_descends(where) && !where->pilot.given_back;
}
