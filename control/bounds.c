/* Each limit is a function of what is known and of its own memory; none of them reads the law's thrust.
 * What breaks: two limits that exclude each other. The later one in the table wins, so the ground wins
 * against the air, and the actuator against all. */
#include "control/bounds.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/laws/descent.h"
#include "control/seconds.h"
#include "control/sense/accelerometer.h"
#include "control/thrust.h"
#include "control/touchdown.h"

#define BLINDLY_S 1.0F /* chosen: ten scans; what falls is found in fewer, see docs/ablation.md */
#define UNCONFIRMED_MPS (0.001F * DESCENT_RATE_MM_S) /* no faster than a descent */

#define UNCHECKED_BELOW_N (2.0F * NEAR_HOVER_N) /* to sink is safer than to climb */

#define BACK_BELOW_N NEAR_HOVER_N /* sinks at 0.3 m/s */
/* What the usual bias, 0.15 m/s2 (sim/devices/razor9dof.h), makes of the speed. By the largest, 0.25, a light
 * vehicle climbs a third farther before it is lowered (tests/integration/test_pilots_and_losses.py). */
#define BACK_MOVES_MPS (0.15F * ACCELEROMETER_IN_HANDS_S)
#define BACK_N_PER_M 2.0F /* chosen: a climb of 1 m/s lowers it by 1.5 N before that is forgotten */
#define BACK_BRAKE_N (BACK_BELOW_N + HOVER_THRUST_MARGIN_N) /* what these two may have sunk */
#define BACK_MAX_S 60.0F                                    /* above DESCENT_TIMEOUT_US in supervisor.c */

/* chosen: in 2 s too low to fly; the accelerometer shows a fall before it is fast */
#define STANDING_N_PER_S 1.0F

#define FLOAT_TRIM_N HOVER_THRUST_TRIM_N /* GRAV is trimmed so much too low, or less */
#define FLOAT_TRIM_N_PER_M_S 8.0F        /* tried 4 and 8: half of it after a second 25 mm too low */

typedef struct {
    float least_n, most_n;
} interval_t;

static const interval_t anything = {-INFINITY, INFINITY};

static interval_t most(float most_n)
{
    return (interval_t){-INFINITY, most_n};
}

static interval_t least(float least_n)
{
    return (interval_t){least_n, INFINITY};
}

static interval_t about(float middle_n, float below_n, float above_n)
{
    return (interval_t){middle_n - below_n, middle_n + above_n};
}

/* Thrust above the hover thrust that makes a climb rate, by the vehicle's model. */
static float climbing_n(const situation_t *now, float climb_mps)
{
    const cascade_vehicle_t vehicle = est_law_vehicle(now->est, now->parameters);

    return vehicle.damping_per_s * climb_mps / vehicle.authority_mps2_per_n;
}

/* The same, for a speed that is to become another one: as the law would. */
static float braking_n(const situation_t *now, float speed_mps, float wanted_mps)
{
    const float more_mps2 = now->parameters->value[PARAMETER_VELK] * (wanted_mps - speed_mps);

    return climbing_n(now, speed_mps) +
           more_mps2 / est_law_vehicle(now->est, now->parameters).authority_mps2_per_n;
}

/* More than the hover thrust, of a climb at UNCONFIRMED_MPS. A faster one that the heights do not show is
 * braked to it, no harder than a slow descent needs. Thrust and accelerometer tell its speed; where they
 * differ, the less of both. */
static float slow_climb_n(const situation_t *now)
{
    const evidence_t *evidence = now->evidence;
    const float climb_mps = at_least(fminf(evidence->push_mps, felt_mps(evidence)), UNCONFIRMED_MPS);
    const float braked_n = at_least(braking_n(now, climb_mps, UNCONFIRMED_MPS), -NEAR_HOVER_N);
    const float slow_n = climbing_n(now, UNCONFIRMED_MPS);

    return (evidence->rise_mps < 0.5F * UNCONFIRMED_MPS) ? at_most(braked_n, slow_n) : slow_n;
}

/* Where the heights stand still, what the law knows of the speed is theirs: a vehicle of little drag fell at
 * 1 m/s by them. So then the speed is that of the worlds in which all mirrors lie. */
static bool falls_unshown(const evidence_t *evidence)
{
    return evidence->speed_mps < -UNCONFIRMED_MPS && fabsf(evidence->rise_mps) < 0.5F * UNCONFIRMED_MPS;
}

/* As slow_climb_n(), of a descent. */
static float slow_descent_n(const situation_t *now)
{
    const evidence_t *evidence = now->evidence;

    return falls_unshown(evidence)
               ? at_most(braking_n(now, evidence->speed_mps, -UNCONFIRMED_MPS), NEAR_HOVER_N)
               : climbing_n(now, -UNCONFIRMED_MPS);
}

/* By the thrust. By the accelerometer too, while its heights show the vehicle on the ground yet: too small a
 * hover thrust looks like a climb there, and its limit would keep it there. Nor is a take-off slowed before
 * it is fast: a slow one tells the belief little, and blocked beams were found 0.2 m higher. */
static bool climbs_fast(const situation_t *now)
{
    const evidence_t *evidence = now->evidence;
    const height_track_t *height = &now->where->supervisor.height;
    const bool shown_low = height->age_us <= HEIGHT_FRESH_US && height->height_mm < LOW_MM;
    const bool felt = doubts(evidence, DOUBT_IMU) || felt_mps(evidence) > UNCONFIRMED_MPS;

    return evidence->push_mps > UNCONFIRMED_MPS && (felt || !(evidence->unshown.first_climb && shown_low));
}

/* Limits the climb without use of the estimate while no height has confirmed it: a blocked beam looks like a
 * step towards the vehicle. */
static interval_t of_climb(bounds_t *bounds, const situation_t *now)
{
    (void)bounds;
    return (now->evidence->unshown.climb && climbs_fast(now) && modes_hold_reference(now->mode, now->law))
               ? most(now->where->hover.thrust_n + slow_climb_n(now))
               : anything;
}

/* A blocked beam looks like a step away from the vehicle, too. While all mirrors may lie and are believed, it
 * may sink onto ground that they do not show. Only for a while: what sinks slowly tells the belief little. */
static bool sinks_blindly(bounds_t *bounds, const situation_t *now)
{
    const evidence_t *evidence = now->evidence;
    const bool blindly = evidence->mirrors.suspected && !doubts(evidence, DOUBT_SIGHT) &&
                         evidence->push_mps < 0.0F;

    const float step_s = where_step_s(now->where);

    /* scans that tell nothing take a doubt away for a moment: that must not begin a second anew */
    bounds->blindly_s = between(0.0F, bounds->blindly_s + (blindly ? step_s : -step_s), BLINDLY_S);
    return blindly && bounds->blindly_s < BLINDLY_S;
}

/* Limits a descent as of_climb() a climb: after a far step of the terrain that nothing has confirmed, and
 * while it sinks blindly. What is lowered because it is too high is only braked: its hover thrust may be one
 * that climbs. */
static interval_t of_descent(bounds_t *bounds, const situation_t *now)
{
    const bool slow = sinks_blindly(bounds, now) || now->evidence->unshown.descent;
    const bool lowered = now->where->supervisor.state == FLIGHT_LOWERING && falls_unshown(now->evidence);

    return (slow && (lowered || modes_hold_reference(now->mode, now->law)))
               ? least(now->where->hover.thrust_n + slow_descent_n(now))
               : anything;
}

/* Nothing checks the estimate; or its heights are doubted and not lost yet, so that the law flies by what it
 * was amended to: a vehicle that stood on a table hopped by that. */
static interval_t of_coasting(bounds_t *bounds, const situation_t *now)
{
    const bool unchecked = now->where->supervisor.state == FLIGHT_COASTING &&
                           now->est->estimator.unchecked_count > 0U;

    const bool unseen = now->where->supervisor.state == FLIGHT_FLYING && doubts(now->evidence, DOUBT_SIGHT);

    (void)bounds;
    return unchecked ? about(now->where->hover.thrust_n, UNCHECKED_BELOW_N, NEAR_HOVER_N)
           : unseen  ? most(now->where->hover.thrust_n + NEAR_HOVER_N)
                     : anything;
}

/* A pilot may fly, or has given the throttle back: nothing tells. So the thrust stays just below the best
 * known hover thrust, and sinks slowly, because that may be wrong; faster while a climb is felt. */
static float given_back_n(bounds_t *bounds, const situation_t *now)
{
    const where_t *where = now->where;
    const float speed_mps = now->est->estimator.now.speed_mps;
    const float felt_mps = speed_mps - between(-BACK_MOVES_MPS, speed_mps, BACK_MOVES_MPS);
    const float sunk_n = where->pilot.sink_n_per_s * seconds_at_most(where->supervisor.state_us, BACK_MAX_S);

    bounds->felt_n = between(0.0F, bounds->felt_n + BACK_N_PER_M * felt_mps * where_step_s(where),
                             HOVER_BOUND_N);
    return where->hover.thrust_n - BACK_BELOW_N - at_most(sunk_n, HOVER_THRUST_MARGIN_N) - bounds->felt_n -
           at_least(climbing_n(now, felt_mps), -BACK_BRAKE_N);
}

static interval_t while_unknown(bounds_t *bounds, const situation_t *now)
{
    const float hover_n = now->where->hover.thrust_n;

    if (now->where->pilot.given_back) {
        const float only_n = given_back_n(bounds, now);

        return (interval_t){only_n, only_n};
    }
    return (interval_t){hover_n - HOVER_BOUND_N - bounds->sunk_n, hover_n + HOVER_BOUND_N};
}

/* While commands have no effect, and where a pilot may fly without a pin that reports it, the thrust stays
 * near the hover thrust. So it fits when the commands get their effect back. In a descent the limit falls
 * with time: the thrust that was held may be one that climbs. */
static interval_t of_power(bounds_t *bounds, const situation_t *now)
{
    const bool doubted = doubts(now->evidence, DOUBT_THRUST);
    const bool unknown = pilot_is_unknown(&now->where->pilot);

    bounds->felt_n = now->where->pilot.given_back ? bounds->felt_n : 0.0F;
    bounds->sunk_n = ((doubted || unknown) && where_descends(now->where))
                         ? bounds->sunk_n + SINK_FADE_N_PER_S * where_step_s(now->where)
                         : 0.0F;
    if (unknown) {
        return while_unknown(bounds, now);
    }
    if (!doubted || now->mode == FLIGHT_MODE_IDLE) {
        return anything;
    }
    const float held_n = now->evidence->held.hover_n - bounds->sunk_n;
    return now->evidence->held.down ? least(held_n - NEAR_HOVER_N) : most(held_n + NEAR_HOVER_N);
}

/* A landing that a height has shown near the ground ends there, also when the next heights are missing or
 * contradict the estimate: a mirror that loses most of its rays shows few. */
static interval_t of_landing(bounds_t *bounds, const situation_t *now)
{
    (void)bounds;
    return most(touchdown_limit_n(now->where->contact.touching_s, now->where->hover.thrust_n));
}

/* Finds the end of a descent. While the vehicle may stand on the ground, the thrust is lowered step by step.
 * If the accelerometer measures a fall, the vehicle is in the air and the thrust returns. If it does not, the
 * vehicle stands. */
static interval_t of_standing(bounds_t *bounds, const situation_t *now)
{
    const bool by_estimate = now->mode == FLIGHT_MODE_EST_SINK || now->mode == FLIGHT_MODE_EST_LAND;
    const bool blind = now->mode == FLIGHT_MODE_BLIND_DESCENT && !doubts(now->evidence, DOUBT_IMU);
    const float step_n = STANDING_N_PER_S * where_step_s(now->where);

    if (!(by_estimate || blind) || !now->evidence->may_stand) {
        bounds->standing_n = THRUST_MAX_N;
        return anything;
    }
    bounds->standing_n = at_least(at_most(bounds->standing_n, now->thrust_n) - step_n, 0.0F);
    return most(bounds->standing_n);
}

static interval_t of_actuator(bounds_t *bounds, const situation_t *now)
{
    (void)bounds;
    return (interval_t){now->idle_n, THRUST_MAX_N};
}

static const struct {
    bound_t id;
    interval_t (*of)(bounds_t *bounds, const situation_t *now);
} table[] = {
    {BOUND_CLIMB, of_climb},       {BOUND_DESCENT, of_descent}, {BOUND_COASTING, of_coasting},
    {BOUND_POWER, of_power},       {BOUND_LANDING, of_landing}, {BOUND_STANDING, of_standing},
    {BOUND_ACTUATOR, of_actuator},
};

static float trim_n(bounds_t *bounds, const situation_t *now)
{
    const where_t *where = now->where;
    const bool unknown = pilot_is_unknown(&where->pilot) && !where->pilot.given_back;
    const bool trims = unknown && now->mode == FLIGHT_MODE_EST_HOLD && est_law_has_acceleration(now->est) &&
                       !pilot_shows_effect(&where->pilot);
    const float below_m = now->aim_m - where->supervisor.height.height_mm * 0.001F;
    const float more_n = bounds->trim_n + FLOAT_TRIM_N_PER_M_S * below_m * where_step_s(where);

    bounds->trim_n = trims ? between(0.0F, more_n, FLOAT_TRIM_N) : 0.0F;
    return bounds->trim_n;
}

float bounds_apply(bounds_t *bounds, const situation_t *now, float law_n)
{
    float thrust_n = law_n + trim_n(bounds, now);

    bounds->holds = BOUND_NONE;
    for (uint16_t k = 0U; k < sizeof table / sizeof table[0]; ++k) {
        const interval_t interval = table[k].of(bounds, now);
        const float before_n = thrust_n;

        thrust_n = between(interval.least_n, thrust_n, interval.most_n);
        bounds->holds = (thrust_n != before_n) ? table[k].id : bounds->holds;
    }
    if (bounds->holds == BOUND_NONE && thrust_n >= THRUST_MAX_N) {
        bounds->holds = BOUND_ACTUATOR; /* a law asks for no more than there is */
    }
    return thrust_n;
}

static const char *const names[] = {
    [BOUND_NONE] = "-",
    [BOUND_CLIMB] = "CLIMB",
    [BOUND_DESCENT] = "DESCENT",
    [BOUND_COASTING] = "COASTING",
    [BOUND_POWER] = "POWER",
    [BOUND_LANDING] = "LANDING",
    [BOUND_STANDING] = "STANDING",
    [BOUND_ACTUATOR] = "ACTUATOR",
};
typedef char every_bound_has_a_name[(sizeof names / sizeof names[0] == BOUND_COUNT) ? 1 : -1];

const char *bound_name(uint16_t limit)
{
    return names[limit];
}
