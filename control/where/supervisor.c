/* A state machine as data. Each cycle evaluates the conditions as bits, then makes at most one transition of
 * the table in flight_state.c. The states have no action here; flight.c computes the thrust of each state.
 * What breaks: times. The microseconds wrap after 71 minutes, so ages are summed from step to step and stop
 * at an hour. Only the conditions AT_REST, DESCENT_TIMEOUT and LOWERING_LIMIT depend on the state. The test
 * of the table takes all others as independent of the state, so it does not cover a further one. */
#include "control/where/supervisor.h"

#include <math.h>
#include <stddef.h>

#include "control/attitude.h"
#include "control/between.h"
#include "control/credible.h"
#include "control/est/est_law.h"

#define ATTITUDE_FRESH_US UINT32_C(250000)              /* ten frames of 25 ms */
#define REST_HELD_US ((uint32_t)(REST_HELD_S * 1.0e6F)) /* on the ground; and off it, in a pilot's hands */
/* A landing from 4.095 m, the scanner's range, is over: 11.7 s at 0.3 m/s down to 0.6 m, 2.8 s from there
 * (log(0.3 / 0.15) by 0.25 1/s, laws/descent.h), and REST_HELD_S. */
#define REST_ROCKS_MAX_US UINT32_C(15500000)
#define LINK_HOLD_US UINT32_C(5000000)        /* it warns first: PX4, COM_FAIL_ACT_T */
#define DESCENT_TIMEOUT_US UINT32_C(45000000) /* the thrust of a blind descent has fallen to 0, descent.c */
#define AGE_MAX_US UINT32_C(3600000000)       /* one hour: below the wrap of 71 minutes */

#define REST_FALL_MM 20.0F                                      /* three HEIGHT_SIGMA_M, 19.2 mm */
#define STAND_MOVES_MM (3000.0F * HEIGHT_SIGMA_M * 1.41421356F) /* three sigmas of two heights */
/* Above the highest reference, 3 m, the scanner sees 0.89 m more: 4.095 m less 0.205 m of the front mirror's
 * way. Rounded down. */
#define TOO_HIGH_MM 800.0F
#define RECOVERED_MM (1000.0F * LAW_REACH_M)  /* the law reaches it again without help */
#define FLOWN_MM (TOO_HIGH_MM - RECOVERED_MM) /* flown, where no ground has fallen */
#define TOO_HIGH_HEIGHTS 2U                   /* one height may be wrong */
#define RATE_CHANGE_MAX_MM_S2 10000.0F        /* 1 g: the vehicle cannot change its speed faster */
#define CLIMB_AHEAD_S 0.40F /* sum of the age of a height, one more scan, and the lag of the motors */
/* The slowest vehicle of tools/campaign/plan.py: lag of the motors 150 ms, delay 20 ms, a pulse 14 ms; a
 * frame 25 ms and 15 ms old. */
#define ESTIMATE_AHEAD_S 0.22F
#define ESTIMATE_HELD_US (HEIGHT_FRESH_US + UINT32_C(50000)) /* and half a scan: give or take */
/* The law cannot fly the vehicle. By law EST 8 of 990 healthy flights are taken over, in 13.1 h
 * (docs/reliability.md). So within LOWERINGS_FORGOTTEN_US a second one comes by chance once in 290, a third
 * once in 87000. */
#define LOWERINGS_MAX 3U
#define LOWERINGS_FORGOTTEN_US UINT32_C(20000000) /* chosen: the length of the seed's flights */
/* 18 degrees: six sigma of the liveliest sway, 3 degrees (tools/campaign/plan.py), as for heights */
#define LEVEL_COS 0.95105652F

void supervisor_init(supervisor_t *supervisor)
{
    *supervisor = (supervisor_t){
        .state = FLIGHT_GROUND,
        .kept_state = FLIGHT_STATE_COUNT,
        .height.age_us = AGE_MAX_US,
        .attitude.age_us = AGE_MAX_US,
        .link.age_us = AGE_MAX_US,
        .climb.estimated_peak_mm = NAN,
        .climb.estimate_age_us = AGE_MAX_US,
    };
}

static uint32_t add_time(uint32_t age_us, uint32_t by_us)
{
    return (by_us < AGE_MAX_US - age_us) ? age_us + by_us : AGE_MAX_US;
}

static uint32_t elapsed(uint32_t now_us, uint32_t then_us)
{
    const uint32_t ago_us = now_us - then_us;
    return (ago_us <= AGE_MAX_US) ? ago_us : 0U;
}

static void update_hold(hold_t *held, bool condition, uint32_t step_us)
{
    held->for_us = (condition && held->on) ? add_time(held->for_us, step_us) : 0U;
    held->on = condition;
}

static void observe_time(supervisor_t *s, const flight_inputs_t *in)
{
    s->step_us = s->started ? in->now_us - s->now_us : 0U;
    s->state_us = add_time(s->state_us, s->step_us);
    s->now_us = in->now_us;
    s->started = true;
}

static float rate_after(const height_track_t *before, float height_mm, uint32_t gap_us)
{
    if (before->age_us > HEIGHT_LOST_US || gap_us == 0U) {
        return 0.0F;
    }
    const float gap_s = (float)gap_us * 1.0e-6F;
    const float change_mm_s = RATE_CHANGE_MAX_MM_S2 * gap_s;
    const float most_mm_s = 1000.0F * SPEED_MAX_MPS;
    const float rate_mm_s = between(-most_mm_s, (height_mm - before->height_mm) / gap_s, most_mm_s);
    return between(before->rate_mm_s - change_mm_s, rate_mm_s, before->rate_mm_s + change_mm_s);
}

static void observe_height(supervisor_t *s, const flight_inputs_t *in)
{
    height_track_t *track = &s->height;
    const bool plausible = in->altitude.height_mm >= HEIGHT_MIN_MM && in->altitude.height_mm <= HEIGHT_MAX_MM;

    track->age_us = add_time(track->age_us, s->step_us);
    track->is_new = in->height_valid && in->height_sequence != track->sequence && plausible;
    if (!track->is_new) {
        return;
    }
    track->gap_us = in->height_time_us - track->time_us;
    track->rate_mm_s = rate_after(track, in->altitude.height_mm, track->gap_us);
    track->height_mm = in->altitude.height_mm;
    track->time_us = in->height_time_us;
    track->sequence = in->height_sequence;
    track->age_us = elapsed(in->now_us, in->height_time_us);
}

static void observe_attitude(supervisor_t *s, const flight_inputs_t *in, float upright)
{
    const bool is_new = in->attitude_time_us != s->attitude.time_us;
    s->attitude.age_us = is_new ? elapsed(in->now_us, in->attitude_time_us)
                                : add_time(s->attitude.age_us, s->step_us);
    s->attitude.time_us = in->attitude_time_us;
    const bool counts = is_new && in->attitude_ready;

    if (counts) {
        s->attitude.level = upright > LEVEL_COS;
    }
    if (in->frames != NULL) {
        s->attitude.tilted_count = (in->tilted_frames < ATTITUDE_TILTED_FRAMES) ? in->tilted_frames
                                                                                : ATTITUDE_TILTED_FRAMES;
    } else if (counts) {
        const bool tilted = upright < TILTED_COS;
        s->attitude.tilted_count = tilted ? (uint16_t)(s->attitude.tilted_count +
                                                       (s->attitude.tilted_count < ATTITUDE_TILTED_FRAMES))
                                          : 0U;
    }
}

static void observe_link(supervisor_t *s, const flight_inputs_t *in)
{
    const bool is_new = in->link_sequence != s->link.sequence;
    s->link.age_us = is_new ? elapsed(in->now_us, in->link_time_us) : add_time(s->link.age_us, s->step_us);
    s->link.sequence = in->link_sequence;
}

static bool link_silent(const supervisor_t *s, float link_s, uint32_t longer_us)
{
    const uint32_t limit_us = (uint32_t)(link_s * 1.0e6F) + longer_us;
    return link_s > 0.0F && s->link.sequence != 0U && s->link.age_us > limit_us;
}

static void observe_reference(supervisor_t *s, float link_s, const flight_inputs_t *in)
{
    const bool is_new = in->reference_sequence != s->reference_sequence;
    const bool plausible = in->reference_m >= 0.0F && in->reference_m <= FLIGHT_REFERENCE_MAX_M;

    s->reference_sequence = in->reference_sequence;
    /* until it is done; a pilot's turn interrupts it, and it goes on at the hand-back */
    s->land = is_new ? in->reference_m == 0.0F : s->land && s->state != FLIGHT_GROUND;
    if (is_new) {
        s->link.age_us = 0U;
    }
    if (is_new && plausible) {
        s->reference_m = in->reference_m;
        s->climb.lowerings = 0U;
    }
    if (link_silent(s, link_s, LINK_HOLD_US)) {
        s->reference_m = 0.0F;
    }
}

static bool height_fresh(const supervisor_t *s)
{
    return s->height.age_us <= HEIGHT_FRESH_US;
}

static bool attitude_fresh(const supervisor_t *s)
{
    return s->attitude.age_us <= ATTITUDE_FRESH_US;
}

static bool is_level(const supervisor_t *s)
{
    return s->attitude.level && attitude_fresh(s);
}

/* An IMU that has fallen silent tells no tilt, however well its zero is known. */
static bool is_ready(const supervisor_t *s, const flight_inputs_t *in)
{
    return in->attitude_ready && attitude_fresh(s);
}

bool supervisor_is_at_rest(const supervisor_t *supervisor)
{
    return supervisor->state == FLIGHT_GROUND && supervisor->ground.rest.on;
}

bool supervisor_has_estimate(const supervisor_t *supervisor)
{
    return supervisor->climb.estimate_age_us <= ESTIMATE_HELD_US;
}

/* Where a climb ends, above the reference, once it is braked after ahead_s; a descent does not count. */
static float peak_mm(const supervisor_t *s, float height_mm, float rate_mm_s, float ahead_s)
{
    const float climb_mm_s = at_least(rate_mm_s, 0.0F);
    return height_mm - s->reference_m * 1000.0F +
           climb_mm_s * (ahead_s + climb_mm_s * (0.0005F / EST_FALL_MPS2));
}

/* A step of the terrain looks like a climb, but not to an estimate: heights have less to say where there is
 * one. */
static float measured_peak_mm(const supervisor_t *s)
{
    const float ahead_s = supervisor_has_estimate(s) ? 0.0F : CLIMB_AHEAD_S;
    return peak_mm(s, s->height.height_mm, s->height.rate_mm_s, ahead_s);
}

/* Ground that was found by its calm, not by heights: the heights may see past an edge, and go on doing so. */
static void follow_ground(supervisor_t *s)
{
    if (s->height.is_new) {
        s->ground.height_mm = s->ground.sought ? s->height.height_mm
                                               : at_most(s->ground.height_mm, s->height.height_mm);
        s->ground.height_mm = at_least(s->ground.height_mm, 0.0F);
        s->ground.sought = false;
    }
}

/* On the ground, by all but its height: the tilt is still, and no pilot hands it over in the air. */
static bool is_still(const supervisor_t *s, const flight_inputs_t *in, bool calm)
{
    return s->ground.ours.for_us >= HEIGHT_FRESH_US && calm && is_ready(s, in);
}

/* How long a height above the ground has come, and how long it has stayed. */
static void watch_height(ground_watch_t *ground, bool high, float height_mm, uint32_t step_us)
{
    const bool begins = !ground->watched.on;
    const bool stays = begins || fabsf(height_mm - ground->high_from_mm) <= STAND_MOVES_MM;

    update_hold(&ground->watched, high, step_us);
    update_hold(&ground->high, high && stays, step_us);
    ground->high_from_mm = (ground->high.on && !begins) ? ground->high_from_mm : height_mm;
}

/* It stands, and its mirrors are blocked, or look past what it stands on. What is found holds until a height
 * shows the ground, or somebody moves the vehicle. */
static void observe_stand(supervisor_t *s, const flight_inputs_t *in, bool calm)
{
    ground_watch_t *ground = &s->ground;
    const bool low = height_fresh(s) && s->height.height_mm <= LOW_MM;

    update_hold(&ground->ours, in->has_throttle, s->step_us);
    if (s->state != FLIGHT_GROUND) {
        ground->watched.on = ground->high.on = ground->stands_high = false;
        return;
    }
    const bool still = is_still(s, in, calm);
    watch_height(ground, still && height_fresh(s) && !low, s->height.height_mm, s->step_us);
    ground->stands_high = still && !low && (ground->stands_high || ground->high.for_us >= HEIGHT_FRESH_US);
    s->reference_m = ground->stands_high ? 0.0F : s->reference_m;
}

static void observe_ground(supervisor_t *s)
{
    const float height_mm = s->height.height_mm;
    const bool fresh = height_fresh(s);
    const bool resting = fresh && height_mm < GROUND_WITHIN_MM &&
                         height_mm >= s->ground.rest_from_mm - REST_FALL_MM;

    follow_ground(s);
    /* a height shows nothing while the tilt that corrects it is not known, or looks past the ground */
    update_hold(&s->ground.aloft, fresh && is_level(s) && height_mm > s->ground.height_mm + LOW_MM,
                s->step_us);
    update_hold(&s->ground.rest, resting, s->step_us);
    s->ground.rest_from_mm = resting ? s->ground.rest_from_mm : height_mm;
}

static void observe_estimate(supervisor_t *s, const vertical_estimate_t *estimate)
{
    s->climb.estimated_peak_mm = estimate->known
                                     ? peak_mm(s, estimate->height_mm, estimate->climb_mm_s, ESTIMATE_AHEAD_S)
                                     : NAN;
    s->stands = estimate->stands && (s->state == FLIGHT_LANDING || s->state == FLIGHT_DESCENDING);
    s->rocks = estimate->rocks && (s->state == FLIGHT_LANDING || s->state == FLIGHT_DESCENDING);
    s->climb.estimate_age_us = estimate->known ? 0U : add_time(s->climb.estimate_age_us, s->step_us);
}

/* No thrust without an order (arming.h). Heights alone do not show a flight: a hand below the beam, or a beam
 * past an edge, measures the same. A tilt alone does not either: somebody may hold the vehicle. */
static void observe_hand_over(supervisor_t *s, const flight_inputs_t *in, const vertical_estimate_t *estimate)
{
    s->sways = estimate->sways;
    s->handed_over = estimate->hands_over && s->height.age_us > HEIGHT_LOST_US && in->has_throttle &&
                     (estimate->in_hands || (s->pilots && estimate->sways));
    s->in_hands = estimate->in_hands;
    s->pilots = !in->has_throttle;
}

/* How much of its height it has flown: by the accelerometer, which does not feel the terrain. A law that
 * returns sinks at least as fast as a descent does. */
static void observe_flown(supervisor_t *s, const vertical_estimate_t *estimate)
{
    climb_watch_t *climb = &s->climb;
    const float more_mm = (estimate->felt_mm_s + DESCENT_RATE_MM_S) * (float)s->step_us * 1.0e-6F;

    if (measured_peak_mm(s) < RECOVERED_MM) {
        climb->flown_mm = 0.0F;
    } else if (estimate->tells_falls) {
        climb->flown_mm = between(0.0F, climb->flown_mm + more_mm, FLOWN_MM);
    }
    climb->fallen = estimate->tells_falls && climb->flown_mm < FLOWN_MM;
}

static void observe_climb(supervisor_t *s)
{
    if (s->height.is_new) {
        const bool above = measured_peak_mm(s) > TOO_HIGH_MM;
        s->climb.too_high_count = above ? (uint16_t)(s->climb.too_high_count +
                                                     (s->climb.too_high_count < TOO_HIGH_HEIGHTS))
                                        : 0U;
    }
}

static bool too_high(const supervisor_t *s)
{
    return !s->climb.fallen &&
           (s->climb.too_high_count == TOO_HIGH_HEIGHTS || s->climb.estimated_peak_mm > TOO_HIGH_MM);
}

static bool recovered(const supervisor_t *s)
{
    return measured_peak_mm(s) < RECOVERED_MM && !(s->climb.estimated_peak_mm >= RECOVERED_MM);
}

static uint16_t bit(bool condition, uint16_t mask)
{
    return condition ? mask : 0U;
}

/* On the ground by its heights. While the tilt moves, they may be those of a blocked beam. */
static bool rests(const supervisor_t *s)
{
    const bool rocks = s->rocks && s->state_us < REST_ROCKS_MAX_US;

    return s->ground.rest.for_us >= REST_HELD_US && !rocks;
}

/* While a height above the ground has just come, a reference waits: does the vehicle stand? */
static bool may_follow_reference(const supervisor_t *s)
{
    const bool asks = s->ground.watched.on && s->ground.watched.for_us < HEIGHT_FRESH_US;

    return s->reference_m > 0.0F && !asks;
}

static uint16_t conditions(const supervisor_t *s, const flight_inputs_t *in)
{
    const bool fresh = height_fresh(s);
    const bool reference = s->reference_m > 0.0F;
    const bool descent_timeout = s->state == FLIGHT_DESCENDING && s->state_us >= DESCENT_TIMEOUT_US &&
                                 !s->in_hands;
    const bool lowering_limit = s->state == FLIGHT_LOWERING && s->climb.lowerings == LOWERINGS_MAX;

    return (uint16_t)(bit(may_follow_reference(s), FLIGHT_IF_REFERENCE) |
                      bit(is_ready(s, in), FLIGHT_IF_READY) | bit(fresh, FLIGHT_IF_HEIGHT) |
                      bit(s->height.age_us > HEIGHT_LOST_US, FLIGHT_IF_LOST) |
                      bit(fresh && s->height.height_mm > LOW_MM, FLIGHT_IF_OFF_GROUND) |
                      bit(s->ground.aloft.for_us >= REST_HELD_US && s->sways, FLIGHT_IF_ALOFT) |
                      bit(s->stands || rests(s), FLIGHT_IF_AT_REST) |
                      bit(fresh && reference && too_high(s), FLIGHT_IF_TOO_HIGH) |
                      bit(fresh && recovered(s), FLIGHT_IF_RECOVERED) | bit(s->land, FLIGHT_IF_LAND) |
                      bit(descent_timeout, FLIGHT_IF_DESCENT_TIMEOUT) |
                      bit(lowering_limit, FLIGHT_IF_LOWERING_LIMIT) |
                      bit(s->attitude.tilted_count == ATTITUDE_TILTED_FRAMES, FLIGHT_IF_TILTED) |
                      bit(is_level(s), FLIGHT_IF_LEVEL) | bit(s->handed_over, FLIGHT_IF_HANDED_OVER) |
                      bit(in->has_throttle, FLIGHT_IF_HAS_THROTTLE));
}

static uint16_t flags(const supervisor_t *s, uint16_t met, float link_s, const flight_inputs_t *in)
{
    const bool fresh = height_fresh(s);
    const bool lowering = s->state == FLIGHT_LOWERING || (met & FLIGHT_IF_TOO_HIGH) != 0U;
    const bool tilted = s->state == FLIGHT_CUT || (met & FLIGHT_IF_TILTED) != 0U;

    return (uint16_t)(bit(!fresh, FLIGHT_FLAG_HEIGHT) | bit(!is_ready(s, in), FLIGHT_FLAG_ATTITUDE) |
                      bit(fresh && in->altitude.disagree, FLIGHT_FLAG_DISAGREE) |
                      bit(lowering, FLIGHT_FLAG_TOO_HIGH) | bit(s->ground.stands_high, FLIGHT_FLAG_MIRRORS) |
                      bit(link_silent(s, link_s, 0U), FLIGHT_FLAG_LINK) | bit(tilted, FLIGHT_FLAG_TILT) |
                      bit(!in->has_throttle, FLIGHT_FLAG_PILOT));
}

static void count_lowerings(supervisor_t *s, flight_state_t next)
{
    if (s->state == FLIGHT_FLYING && s->state_us >= LOWERINGS_FORGOTTEN_US) {
        s->climb.lowerings = 0U;
    }
    if (next == FLIGHT_LOWERING) {
        ++s->climb.lowerings;
    }
}

static void enter(supervisor_t *s, flight_state_t state)
{
    const bool given_up = s->climb.lowerings == LOWERINGS_MAX && state != FLIGHT_LOWERING;

    count_lowerings(s, state);
    s->state = state;
    s->state_us = 0U;
    s->ground.rest.on = false;
    s->ground.sought = state == FLIGHT_GROUND && s->stands;
    s->ground.height_mm = (s->ground.sought && height_fresh(s)) ? s->height.height_mm : 0.0F;
    if (state == FLIGHT_GROUND || state == FLIGHT_DESCENDING || state == FLIGHT_CUT || given_up) {
        s->reference_m = 0.0F;
        s->climb.lowerings = 0U;
    }
}

void supervisor_step(supervisor_t *supervisor, float link_s, const flight_inputs_t *in,
                     const vertical_estimate_t *estimate)
{
    observe_time(supervisor, in);
    observe_height(supervisor, in);
    observe_attitude(supervisor, in, estimate->upright);
    observe_link(supervisor, in);
    observe_reference(supervisor, link_s, in);
    observe_estimate(supervisor, estimate);
    observe_ground(supervisor);
    observe_stand(supervisor, in, estimate->calm);
    observe_hand_over(supervisor, in, estimate);
    observe_climb(supervisor);
    observe_flown(supervisor, estimate);

    const uint16_t met = conditions(supervisor, in);
    if (supervisor->state != supervisor->kept_state || met != supervisor->kept_conditions) {
        const flight_state_t next = flight_next_state(supervisor->state, met);
        supervisor->kept_state = (next == supervisor->state) ? next : FLIGHT_STATE_COUNT;
        supervisor->kept_conditions = met;
        if (next != supervisor->state) {
            enter(supervisor, next);
        }
    }
    supervisor->flags = flags(supervisor, met, link_s, in);
}
