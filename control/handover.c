/* A table of the edges of doubts, and one function for each other thing that comes or goes.
 * What breaks: an estimate that is not told flies on what was believed before. */
#include "control/handover.h"

#include <math.h>

#include "control/between.h"
#include "control/sense/accelerometer.h"

#define LIFTED_MPS 0.25F /* what the largest bias, 0.25 m/s2, adds up to on the ground: STANDING_TIME_S */

/* Two sigma of their difference over level ground: 0.14 and 0.09 m/s rms, 60 flights that lose their heights.
 */
#define SPEEDS_APART_MPS 0.33F

/* What the estimate goes on from. */
typedef enum {
    AMEND_NOT,
    AMEND_BLINDLY,         /* height and speed of the worlds in which all mirrors lie */
    AMEND_BY_HEIGHTS,      /* the heights, with the accelerometer's bias */
    AMEND_BY_HEIGHTS_ALONE /* the heights, no bias; in doubt of them too, the speed of those worlds */
} amend_t;

/* Where an edge counts. */
typedef enum { ANYWHERE, IN_THE_AIR, IN_THE_AIR_OR_UNSEEN } place_t;

/* One edge of the doubts. */
typedef struct {
    uint16_t came, gone; /* any of these */
    place_t place;
    amend_t amend;
    bool engages; /* law EST starts again, from the previous thrust and the sure hover thrust */
} edge_t;

/* Before law EST is told what is doubted now, and after it. */
static const edge_t first_edges[] = {
    {.came = DOUBT_SIGHT, .place = ANYWHERE, .amend = AMEND_BLINDLY},
    {.came = DOUBT_SIGHT, .gone = DOUBT_THRUST, .place = IN_THE_AIR_OR_UNSEEN, .engages = true},
    {.gone = DOUBT_SIGHT, .place = IN_THE_AIR, .amend = AMEND_BY_HEIGHTS, .engages = true},
};
static const edge_t last_edges[] = {
    {.came = DOUBT_IMU, .place = IN_THE_AIR, .amend = AMEND_BY_HEIGHTS_ALONE, .engages = true},
};

/* Law EST flies from now on. hover_n: best known hover thrust. */
static void engage_at(est_law_t *est, where_t *where, float hover_n)
{
    contact_fly(&where->contact);
    est_law_engage(est, hover_n);
}

static void engage(est_law_t *est, where_t *where)
{
    engage_at(est, where, where->hover.thrust_n);
}

static void amend(est_law_t *est, const evidence_t *evidence, amend_t how)
{
    switch (how) {
    case AMEND_BLINDLY:
        estimator_amend(&est->estimator, evidence->blind_height_m, evidence->speed_mps, evidence->bias_mps2);
        break;
    case AMEND_BY_HEIGHTS:
        estimator_amend(&est->estimator, evidence->height_m, evidence->rise_mps, evidence->bias_mps2);
        break;
    case AMEND_BY_HEIGHTS_ALONE:
        if (doubts(evidence, DOUBT_SIGHT)) {
            estimator_amend(&est->estimator, est->estimator.now.height_m, evidence->speed_mps, 0.0F);
        } else {
            estimator_amend(&est->estimator, evidence->height_m, evidence->rise_mps, 0.0F);
        }
        break;
    case AMEND_NOT:
    default:
        break;
    }
}

/* What came and went in this cycle. */
typedef struct {
    uint16_t came, gone;
} change_t;

static bool is_place(place_t place, const change_t *change, const situation_t *now)
{
    const bool unseen = (change->came & DOUBT_SIGHT) != 0U && now->evidence->sways;

    return place == ANYWHERE || now->where->contact.airborne || (place == IN_THE_AIR_OR_UNSEEN && unseen);
}

static void tell(est_law_t *est, where_t *where, const edge_t *edges, uint16_t count, const change_t *change,
                 const situation_t *now)
{
    for (uint16_t k = 0U; k < count; ++k) {
        const edge_t *edge = &edges[k];
        const bool is_edge = (edge->came & change->came) != 0U || (edge->gone & change->gone) != 0U;

        if (!is_edge || !is_place(edge->place, change, now)) {
            continue;
        }
        amend(est, now->evidence, edge->amend);
        if (edge->engages) {
            engage(est, where);
        }
    }
}

void handover_doubts(handover_t *handover, est_law_t *est, where_t *where, const situation_t *now)
{
    const uint16_t doubted = now->evidence->doubts;
    const pilot_state_t *pilot = &where->pilot;
    const change_t change = {
        .came = doubted & (uint16_t)~handover->doubts,
        .gone = handover->doubts & (uint16_t)~doubted,
    };

    if ((change.came & DOUBT_IMU) != 0U) {
        hover_thrust_distrust(&where->hover, now->parameters->value[PARAMETER_GRAV]);
    }
    tell(est, where, first_edges, sizeof first_edges / sizeof first_edges[0], &change, now);
    est_law_doubt(est, &(est_doubts_t){
                           .without_authority = (doubted & DOUBT_THRUST) != 0U ||
                                                (pilot_is_unknown(pilot) && !pilot_shows_effect(pilot)),
                           .accelerations = (doubted & DOUBT_IMU) != 0U,
                           .no_effect = situation_without_effect(now),
                           .rocks = now->rocks,
                           .seen = now->evidence->mirrors.agree,
                       });
    tell(est, where, last_edges, sizeof last_edges / sizeof last_edges[0], &change, now);
    handover->doubts = doubted;
}

/* The IMU is back in flight: the estimate starts again. From what thrust and heights tell, or without sight
 * the belief, not from rest, and with the bias from before; also where the heights are gone. */
static void restart(est_law_t *est, const situation_t *now)
{
    const evidence_t *evidence = now->evidence;
    estimator_t *estimator = &est->estimator;

    if (estimator->initialised || !now->where->contact.airborne || !est_law_has_imu(est)) {
        return;
    }
    const float height_m = doubts(evidence, DOUBT_SIGHT) ? estimator->now.height_m
                                                         : evidence->height_m + evidence->moved_m;
    const float speed_mps = doubts(evidence, DOUBT_SIGHT) ? evidence->speed_mps : evidence->pushed_mps;

    estimator_start(estimator, height_m, speed_mps, estimator->felt ? evidence->bias_mps2 : 0.0F);
}

/* The height of this cycle, if there is one that is believed. */
static void fuse(est_law_t *est, const situation_t *now, const flight_inputs_t *in)
{
    const supervisor_t *supervisor = &now->where->supervisor;
    const est_height_t height = {
        {&in->altitude, in->mirrors, now->evidence->mirrors.doubted, now->evidence->mirrors.liars},
        in->height_stamp_ms,
        in->height_time_us,
        in->height_age_us};

    if (supervisor->height.is_new) {
        est_law_fuse_height(est, &height, now->where->contact.airborne, supervisor_is_at_rest(supervisor));
    }
}

/* First hover thrust after lift-off: the delivered thrust less what acceleration and drag need. */
static float lifting_n(const situation_t *now)
{
    const est_law_t *est = now->est;
    const cascade_vehicle_t vehicle = est_law_vehicle(est, now->parameters);
    const float taken_mps2 = est->lift.up_mps2 + vehicle.damping_per_s * now->evidence->felt_mps;
    const float hover_n = est->actuator.thrust_n - taken_mps2 / vehicle.authority_mps2_per_n;

    return est_law_ready(est) && est_law_has_acceleration(est)
               ? hover_thrust_near(now->parameters->value[PARAMETER_GRAV], hover_n)
               : now->where->hover.thrust_n;
}

/* True when the vehicle has left the ground, by the heights or by the accelerometer. For the laws that do not
 * detect their lift-off themselves. */
static bool flies(const situation_t *now)
{
    const flight_state_t state = now->where->supervisor.state;
    const bool felt = now->evidence->felt_mps > LIFTED_MPS * now->evidence->shaken;

    return (state == FLIGHT_FLYING && (!now->where->contact.lifting || now->risen)) ||
           ((state == FLIGHT_FLYING || state == FLIGHT_TAKEOFF) && felt);
}

/* The take-off was given up on the ground, and the accelerometer feels that the vehicle has left it after
 * all. */
static void notice_lift(est_law_t *est, where_t *where, const situation_t *now)
{
    if (est_law_ready(est) && felt_mps(now->evidence) > LIFTED_MPS) {
        hover_thrust_lift_off(&where->hover, lifting_n(now));
        contact_lift_off(&where->contact);
        engage(est, where);
    }
}

/* The ground, a pilot's turn and a lift-off. */
static void touch_or_fly(est_law_t *est, where_t *where, const situation_t *now, bool has_throttle)
{
    const flight_state_t state = where->supervisor.state;

    if (state == FLIGHT_GROUND) {
        est_law_reset(est, now->parameters, where->contact.airborne);
        contact_end_flight(&where->contact);
    } else if (state == FLIGHT_FLOATING && !has_throttle) {
        est_law_disengage(est);
        contact_end_flight(&where->contact);
    } else if (where->contact.gave_up && state != FLIGHT_TAKEOFF) {
        notice_lift(est, where, now);
    } else if (now->mode == FLIGHT_MODE_LAW && !where->contact.airborne && flies(now)) {
        engage_at(est, where, lifting_n(now));
    }
}

/* The heights have just gone. They told the speed, so over ground that rises that is the speed above the
 * ground; the accelerometer's witness feels the vehicle's own. Where the two are farther apart than both are
 * wrong over level ground, the ground moves. */
static void lose_heights(est_law_t *est, const situation_t *now)
{
    const supervisor_t *supervisor = &now->where->supervisor;
    const evidence_t *evidence = now->evidence;
    const float apart_mps = evidence->felt_mps - est->estimator.now.speed_mps;
    const bool gone = supervisor->height.age_us > HEIGHT_FRESH_US &&
                      supervisor->height.age_us - supervisor->step_us <= HEIGHT_FRESH_US;
    const bool tells = now->where->contact.airborne && evidence->felt_valid && est_law_ready(est) &&
                       !doubts(evidence, DOUBT_SIGHT | DOUBT_IMU);

    if (gone && tells && fabsf(apart_mps) > SPEEDS_APART_MPS) {
        estimator_move_ground(&est->estimator, apart_mps, evidence->bias_mps2);
    }
}

void handover_place(est_law_t *est, where_t *where, const situation_t *now, const flight_inputs_t *in,
                    pilot_news_t news, float trim_n)
{
    restart(est, now);
    fuse(est, now, in);
    lose_heights(est, now);
    touch_or_fly(est, where, now, in->has_throttle);
    if (news == PILOT_SHOWS_EFFECT) { /* now its hover thrust is learned */
        engage_at(est, where, where->hover.thrust_n + trim_n);
    } else if (news == PILOT_IS_SURE) {
        engage(est, where);
    }
}

/* Law EST takes over. A hover thrust that it has learned in this flight is not learned anew from a vehicle
 * that may swing yet. */
static void take_over(est_law_t *est, where_t *where, const situation_t *now)
{
    const bool flew = now->mode_before == FLIGHT_MODE_LAW || now->mode_before == FLIGHT_MODE_DESCENT;
    const bool knows = flew && where->contact.airborne;
    const hover_t learned = est->hover;

    if (!knows) {
        engage(est, where);
        return;
    }
    engage_at(est, where, learned.thrust_n);
    est->hover.variance_n2 = learned.variance_n2;
}

void handover_mode(est_law_t *est, where_t *where, const situation_t *now)
{
    const bool given_back = where->supervisor.state == FLIGHT_DESCENDING; /* by a pilot, without heights */
    const bool from_idle = now->mode_before == FLIGHT_MODE_IDLE;

    if (!modes_use_estimate(now->mode)) {
        return;
    }
    if (given_back && from_idle) {
        estimator_amend(&est->estimator, 0.0F, now->evidence->felt_mps, now->evidence->bias_mps2);
    }
    if (!modes_use_estimate(now->mode_before) &&
        (given_back || (!from_idle && !contact_lifts(&where->contact)))) {
        take_over(est, where, now);
    }
}

void handover_given_back(est_law_t *est, const situation_t *now)
{
    const estimate_t *estimate = &est->estimator.now;
    const float share = where_step_s(now->where) / ACCELEROMETER_IN_HANDS_S;

    estimator_amend(&est->estimator, 0.0F, estimate->speed_mps * (1.0F - share),
                    estimate->bias_mps2 + share * estimate->speed_mps / ACCELEROMETER_IN_HANDS_BIAS_S);
}
