/* Law EST: estimator, hover thrust and cascade control together. The cascade acts on the predicted state at
 * the instant when its command takes effect, DELAY from now: a Smith predictor in state space. The same
 * model gives the estimator the acceleration that the thrust should cause. The noisier the accelerometer, the
 * more weight that acceleration gets.
 * What breaks: the actuator's model needs every command that was really given (est_law_record_command), or
 * hover thrust and prediction drift. While the pilot flies nothing may be learned (est_law_disengage).
 * Constants marked "fitted": docs/control.md; make tune LAW=EST ARGS="--constants est" repeats the search. */
#include "control/est/est_law.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/seconds.h"
#include "control/thrust.h"
#include "control/touchdown.h"

#define STEP_MAX_S 0.5F /* chosen: longer pauses count as this long */

#define HOVER_BOUND_N 2.0F           /* mass 20 % off (1.4 N), battery, gusts; see hover_thrust.c */
#define HOVER_SIGMA_START_N 0.7F     /* half of a mass 20 % off */
#define NEUTRAL_SIGMA_N 0.07F        /* chosen: the thrust in the middle of the stick is known well */
#define HOVER_SIGMA_TAKE_OVER_N 0.5F /* chosen: as TRANSFER_START_N in laws.c */
#define SPEED_DOUBT_N_PER_MPS 0.5F   /* chosen: the damping may be wrong by a quarter */
#define IN_THE_AIR_M 0.04F           /* chosen: ten times the noise of a height */
#define MODEL_NOISE_MPS2 0.84F       /* fitted */
#define HEIGHTS_MISSING_S 0.2F       /* two scans of 0.1 s */
#define FRAMES_FRESH_S ((float)ESTIMATOR_FRESH_US * 1.0e-6F)
#define FRAMES_LATE_S 0.15F          /* chosen: a frame of an IMU as slow as 0.1 s, and its age */
#define LATE_WINDOW_N 0.5F           /* chosen: as TRANSFER_START_N in laws.c */
#define AGE_MAX_S 3600.0F            /* chosen: one hour; the counters stop here */
#define MODEL_NOISE_ALONE_MPS2 0.15F /* chosen: a biased accelerometer drifts away, the model does not */
#define GUST_MPS2_PER_M 39.2F        /* fitted as 28 N/m on a vehicle that hovers at 7 N */
#define NO_ACC_TIME_S 3.0F           /* tried 1.5 to 6: the model's bias becomes hover thrust */
#define NO_ACC_CLIMB_TIME_S 30.0F    /* tried 3 to 30: the middle of the stick is known well */
#define NO_ACC_DEADBAND 0.1F         /* tried 0 to 1: the model's bias tells the deadband late */
#define NO_ACC_HEIGHT_S 0.4F         /* chosen: rays of 70 ms, and three scans */
#define NO_ACC_LIFT_OFF_M 0.035F     /* chosen: five times the noise of a height on a noisy vehicle, 7 mm */

#define RAMP_START 0.68F     /* below the lightest vehicle, 0.8 of GRAV */
#define RAMP_N_PER_S 4.0F    /* chosen: leaves the ground in 0.6 s */
#define RAMP_MOST 1.35F      /* above the heaviest vehicle, 1.2 of GRAV */
#define LIFT_OFF_M 0.030F    /* chosen: ten times the noise of a height */
#define LIFT_OFF_SURE_M 0.1F /* chosen: a height that no noise makes */
#define LIFT_OFF_MPS2 0.9F   /* chosen: twice the accelerometer's usual noise */
#define LIFT_OFF_SIGMAS 1.2F /* chosen: of the measured noise, on a mean of three frames */
#define LIFT_OFF_SHARE 0.7F  /* chosen: below the lightest vehicle, 0.8 of GRAV */
#define LIFT_FILTER_S 0.08F  /* chosen: three frames */
#define LIFT_TIME_S 1.0F     /* as STANDING_TIME_S in accelerometer.c */

#define FALL_MPS2 3.96F          /* fitted: 0.4 g */
#define BELOW_HOVER_N 3.0F       /* chosen: the rotors keep turning */
#define BRAKE_MPS2 8.0F          /* chosen: turns a climb into a descent */
#define BRAKE_BELOW_HOVER_N 6.0F /* chosen: may go down to a quarter of the hover thrust */

#define LAND_MPS 0.15F              /* chosen: touches at 0.15 m/s, a drop from 1 mm */
#define LAND_PER_S 0.25F            /* chosen: with LAND_MPS 0.4 m/s from 1 m */
#define LAND_MAX_MPS 0.40F          /* chosen: from 1 m down within 5 s */
#define SINK_MPS 0.28F              /* chosen: without heights the touchdown comes without warning */
#define SINK_PER_S 0.07F            /* chosen: 0.35 m/s at 1 m */
#define SINK_MAX_MPS 0.6F           /* chosen: from 3 m down within 10 s */
#define SINK_ABOVE_HOVER_N 0.5F     /* chosen: room for gusts at first */
#define SINK_BELOW_HOVER_N 1.3F     /* chosen: by the vehicle model a sink rate of at most 0.7 m/s */
#define SINK_FADE_N_PER_S 0.2F      /* chosen: at the hover thrust after 2.5 s */
#define LAND_ABOVE_HOVER_N 1.5F     /* chosen: as HOVER_MARGIN_N in hover_thrust.c */
#define LAND_FADE_N_PER_S 0.1F      /* chosen: at the hover thrust after 15 s */
#define TERRAIN_KEEP_S 30.0F        /* chosen: drift of the summed terrain height is forgotten */
#define LOWEST_OVER_TERRAIN_M 0.15F /* the height of OFF_GROUND in supervisor.c */

void est_law_init(est_law_t *law)
{
    *law = (est_law_t){.now_us = 0U};
    estimator_init(&law->estimator);
    ray_clock_init(&law->ray_clock);
}

static bool is_climb(const parameters_t *parameters)
{
    return parameters_choice(parameters, PARAMETER_PLANT) == PLANT_CLIMB;
}

static inline cascade_vehicle_t vehicle_model(const est_law_t *law, const parameters_t *parameters)
{
    const estimator_t *e = &law->estimator;
    const float *value = parameters->value;
    cascade_vehicle_t vehicle = {
        .authority_mps2_per_n = value[PARAMETER_GAIN] * IMU_GRAVITY_MPS2 /
                                at_least(law->hover.thrust_n, 1.0F),
        .damping_per_s = value[PARAMETER_DAMP],
        .hover_n = law->hover.thrust_n,
        .need_n = law->hover.thrust_n,
        .upright = e->upright,
    };
    if (is_climb(parameters)) {
        vehicle.damping_per_s = 1.0F / value[PARAMETER_CLAG];
        vehicle.authority_mps2_per_n = value[PARAMETER_CRATE] / value[PARAMETER_CLAG];
        vehicle.upright = 1.0F;
    }
    vehicle.need_n += e->felt ? law->hover.gust_n : e->now.bias_mps2 / vehicle.authority_mps2_per_n;
    return vehicle;
}

/* Hover thrust from accelerations. On the ground they only show that the hover thrust is at least the present
 * thrust. */
static void learn_hover(est_law_t *law, const parameters_t *parameters, float dt_s)
{
    const estimator_t *e = &law->estimator;
    const cascade_vehicle_t vehicle = vehicle_model(law, parameters);
    const float drag_mps2 = vehicle.damping_per_s * e->now.speed_mps;
    const float taken_n = (e->up_mps2 - e->now.bias_mps2 + drag_mps2) / vehicle.authority_mps2_per_n;
    const float seen_n = law->actuator.thrust_n * vehicle.upright - taken_n;
    const float doubt_n = SPEED_DOUBT_N_PER_MPS * fabsf(e->now.speed_mps);

    if (law->heightless_s > HEIGHT_FRESH_S || e->unchecked_count > 0U || law->without_authority ||
        estimator_accuses(e)) {
        hover_fade_gust(&law->hover, dt_s);
        return; /* no height confirms the estimated speed */
    }
    if (e->now.height_m > IN_THE_AIR_M || seen_n > law->hover.thrust_n) {
        hover_step(&law->hover, seen_n, e->credit.noise_mps2 / vehicle.authority_mps2_per_n + doubt_n, dt_s);
    }
    if (is_climb(parameters) && e->now.height_m > IN_THE_AIR_M) {
        deadband_learn(&law->deadband, law->actuator.thrust_n - law->hover.thrust_n,
                       seen_n - law->hover.thrust_n, dt_s);
    }
}

/* Hover thrust without accelerations. The filter's bias is then the error of the model: modelled minus true
 * acceleration. Its constant part moves slowly into the hover thrust, out of the bias. */
static void learn_hover_by_model(est_law_t *law, const parameters_t *parameters, float dt_s)
{
    const cascade_vehicle_t vehicle = vehicle_model(law, parameters);
    const float time_s = is_climb(parameters) ? NO_ACC_CLIMB_TIME_S : NO_ACC_TIME_S;
    const float moved_mps2 = dt_s / time_s * law->estimator.now.bias_mps2;
    const float before_n = law->hover.thrust_n;

    if (law->heightless_s > HEIGHT_FRESH_S || law->without_authority) {
        return;
    }
    if (is_climb(parameters) && law->estimator.now.height_m > IN_THE_AIR_M) {
        deadband_learn(&law->deadband, law->actuator.thrust_n - before_n, vehicle.need_n - before_n,
                       NO_ACC_DEADBAND * dt_s);
    }
    law->hover.thrust_n = between(law->hover.least_n, before_n + moved_mps2 / vehicle.authority_mps2_per_n,
                                  law->hover.most_n);
    estimator_move_bias(&law->estimator, (before_n - law->hover.thrust_n) * vehicle.authority_mps2_per_n);
}

/* True when heights have been missing for more than two scans. */
static bool heights_missing(const est_law_t *law)
{
    return law->heightless_s > HEIGHTS_MISSING_S;
}

/* Acceleration by the thrust model; known in the air only. Without heights the estimated height is too
 * uncertain to tell. */
static modelled_motion_t modelled_motion(const est_law_t *law, const parameters_t *parameters)
{
    const cascade_vehicle_t vehicle = vehicle_model(law, parameters);
    const estimate_t *now = &law->estimator.now;

    return (modelled_motion_t){
        .known = law->airborne && !law->without_authority && law->estimator.initialised &&
                 (now->height_m > IN_THE_AIR_M || heights_missing(law)),
        .up_mps2 = vehicle.authority_mps2_per_n * (law->actuator.thrust_n * vehicle.upright -
                                                   (law->estimator.felt ? vehicle.need_n : vehicle.hover_n)) -
                   vehicle.damping_per_s * now->speed_mps,
        .noise_mps2 = heights_missing(law) ? MODEL_NOISE_ALONE_MPS2 : MODEL_NOISE_MPS2,
    };
}

/* Acceleration, speed and thrust around the lift-off. The speed is summed up from standstill; it decays
 * within LIFT_TIME_S, so that an error of the bias does not add up while the vehicle still stands. */
static void watch_lift(est_law_t *law, float felt_mps2, float dt_s)
{
    const float share = at_most(dt_s / LIFT_FILTER_S, 1.0F);

    law->lift_mps2 += share * (felt_mps2 - law->lift_mps2);
    law->lift_n += share * (law->actuator.thrust_n - law->lift_n);
    law->lift_mps = law->ramping ? law->lift_mps * (1.0F - dt_s / LIFT_TIME_S) + felt_mps2 * dt_s : 0.0F;
}

static void predict_frame(est_law_t *law, const parameters_t *parameters, const imu_sample_t *frame)
{
    const uint32_t before_us = law->estimator.now_us;
    imu_sample_t used = *frame;

    used.has_acceleration = frame->has_acceleration && !law->accelerations_doubted;
    estimator_predict(&law->estimator, &used, modelled_motion(law, parameters));
    const float dt_s = seconds_between(before_us, law->estimator.now_us);
    if (dt_s <= 0.0F || dt_s > STEP_MAX_S) {
        return;
    }
    actuator_advance(&law->actuator, law->estimator.now_us);
    law->frameless_s = seconds_between(law->estimator.now_us, law->now_us);
    const float felt_mps2 = est_law_has_acceleration(law)
                                ? law->estimator.up_mps2 - law->estimator.now.bias_mps2
                                : 0.0F;
    watch_lift(law, felt_mps2, dt_s);
    if (law->airborne && est_law_has_acceleration(law)) {
        learn_hover(law, parameters, dt_s);
    } else if (law->airborne) {
        learn_hover_by_model(law, parameters, dt_s);
    }
}

void est_law_predict(est_law_t *law, const parameters_t *parameters, const imu_sample_t *frames,
                     uint16_t count, uint32_t now_us)
{
    if (!law->started) {
        law->started = true;
        law->now_us = now_us;
        actuator_init(&law->actuator, now_us);
    }
    actuator_describe(&law->actuator, parameters->value[PARAMETER_DELAY], parameters->value[PARAMETER_LAG]);
    if (!is_climb(parameters)) {
        deadband_init(&law->deadband);
    }
    law->authority_mps2_per_n = vehicle_model(law, parameters).authority_mps2_per_n;
    law->step_s = between(0.0F, seconds_between(law->now_us, now_us), STEP_MAX_S);
    law->now_us = now_us;
    law->heightless_s = at_most(law->heightless_s + law->step_s, AGE_MAX_S);
    law->frameless_s = at_most(law->frameless_s + law->step_s, AGE_MAX_S);
    for (uint16_t i = imu_first_after(frames, count, law->estimator.sequence); i < count; ++i) {
        predict_frame(law, parameters, &frames[i]);
    }
    if (law->frameless_s > FRAMES_FRESH_S) {
        actuator_advance(&law->actuator,
                         now_us - ESTIMATOR_FRESH_US); /* without frames nothing else advances the model */
    }
}

static float lift_off_threshold_mps2(const est_law_t *law)
{
    return at_least(LIFT_OFF_SIGMAS * law->estimator.credit.noise_mps2, LIFT_OFF_MPS2);
}

/* True during the take-off ramp, while the vehicle does not yet accelerate upwards: less than 0.4 (chosen) of
 * the lift-off threshold. */
static bool on_ground(const est_law_t *law)
{
    return !law->airborne && law->ramping && law->lift_mps2 < 0.4F * lift_off_threshold_mps2(law);
}

void est_law_fuse_height(est_law_t *law, const altitude_t *altitude, uint32_t stamp_ms, uint32_t arrival_us,
                         uint32_t age_us, bool at_rest)
{
    law->rays_us = ray_clock_step(&law->ray_clock, stamp_ms, arrival_us, age_us);
    law->heightless_s = seconds_between(law->rays_us, law->now_us);
    if (law->frameless_s > FRAMES_LATE_S) {
        estimator_forget_frame(&law->estimator);
    }
    const height_outcome_t outcome = estimator_fuse_height(&law->estimator, altitude, law->rays_us,
                                                           at_rest || on_ground(law));
    if (law->airborne && outcome == HEIGHT_FUSED && law->estimator.felt) {
        const float expected = 1.0F - law->estimator.latest.motion.share;
        hover_nudge(&law->hover,
                    -GUST_MPS2_PER_M * expected * law->estimator.innovation_m / law->authority_mps2_per_n);
    }
}

bool est_law_has_imu(const est_law_t *law)
{
    return law->estimator.has_frames && law->frameless_s <= FRAMES_FRESH_S;
}

bool est_law_ready(const est_law_t *law)
{
    return law->estimator.initialised && est_law_has_imu(law) &&
           (law->estimator.felt || law->heightless_s <= NO_ACC_HEIGHT_S);
}

bool est_law_has_acceleration(const est_law_t *law)
{
    return law->estimator.felt;
}

static void start_hover(est_law_t *law, const parameters_t *parameters, float thrust_n, float sigma_n)
{
    const float gravity_n = parameters->value[PARAMETER_GRAV];
    hover_init(&law->hover, thrust_n, sigma_n, at_least(gravity_n - HOVER_BOUND_N, 0.0F),
               at_least(gravity_n, law->flown_hover_n) + HOVER_BOUND_N);
}

/* Keeps the hover thrust for the next flight: a battery that has emptied needs more thrust then. */
static void remember_flight(est_law_t *law, float gravity_n)
{
    if (law->airborne) {
        law->flown_hover_n = law->sure_hover_n;
        law->flown_gravity_n = gravity_n;
    } else if (gravity_n != law->flown_gravity_n) {
        law->flown_hover_n = 0.0F;
    }
}

void est_law_reset(est_law_t *law, const parameters_t *parameters)
{
    remember_flight(law, parameters->value[PARAMETER_GRAV]);
    law->airborne = false;
    law->ramping = false;
    law->without_authority = false;
    law->ground_m = law->estimator.now.height_m;
    law->ceiling_n = THRUST_MAX_N;
    law->ramp_n = RAMP_START * parameters->value[PARAMETER_GRAV];
    law->reference_terrain_m = law->estimator.terrain_height_m;
    law->near_ground_s = 0.0F;
    start_hover(law, parameters, parameters->value[PARAMETER_GRAV], HOVER_SIGMA_START_N);
    cascade_init(&law->cascade, law->ramp_n);
}

void est_law_engage(est_law_t *law, float thrust_n, float hover_n)
{
    law->airborne = true;
    law->reference_terrain_m = law->estimator.terrain_height_m;
    law->near_ground_s = 0.0F;
    law->hover.thrust_n = between(law->hover.least_n, hover_n, law->hover.most_n);
    law->hover.variance_n2 = HOVER_SIGMA_TAKE_OVER_N * HOVER_SIGMA_TAKE_OVER_N;
    law->hover.gust_n = 0.0F;
    cascade_init(&law->cascade, thrust_n);
}

void est_law_set_sure_hover(est_law_t *law, float hover_n, bool descending)
{
    law->sure_hover_n = hover_n;
    if (!descending) {
        law->ceiling_n = THRUST_MAX_N;
        law->entry_hover_n = hover_n;
    }
}

void est_law_doubt(est_law_t *law, const est_doubts_t *doubts)
{
    law->without_authority = doubts->without_authority;
    if (doubts->without_authority) {
        law->hover.thrust_n = between(law->hover.least_n, law->sure_hover_n, law->hover.most_n);
        law->hover.gust_n = 0.0F;
    }
    if (doubts->accelerations && !law->accelerations_doubted) {
        estimator_drop_accelerations(&law->estimator);
    }
    law->accelerations_doubted = doubts->accelerations;
    law->rocks = doubts->rocks;
}

cascade_vehicle_t est_law_vehicle(const est_law_t *law, const parameters_t *parameters)
{
    return vehicle_model(law, parameters);
}

void est_law_disengage(est_law_t *law)
{
    law->airborne = false;
    law->ramping = false;
}

/* Estimate and thrust, predicted to the instant when a command given now takes effect. */
static cascade_state_t predict_ahead(const est_law_t *law, const cascade_vehicle_t *vehicle)
{
    const estimate_t *now = &law->estimator.now;
    const float ahead_s = seconds_between(law->estimator.now_us, law->now_us + law->actuator.delay_us);
    actuator_t then = law->actuator;

    actuator_advance(&then, law->now_us + law->actuator.delay_us);
    const float thrust_n = 0.5F * (law->actuator.thrust_n + then.thrust_n) * vehicle->upright;
    const float acceleration_mps2 = vehicle->authority_mps2_per_n * (thrust_n - vehicle->need_n) -
                                    vehicle->damping_per_s * now->speed_mps;
    return (cascade_state_t){
        .height_m = now->height_m +
                    (now->speed_mps - now->terrain_mps + 0.5F * acceleration_mps2 * ahead_s) * ahead_s,
        .speed_mps = now->speed_mps + acceleration_mps2 * ahead_s,
        .terrain_mps = now->terrain_mps,
        .thrust_n = then.thrust_n,
    };
}

/* Without accelerations the heights show the lift-off late. The thrust ramps by r newtons a second, so after
 * t seconds the vehicle has risen by a r t^3 / 6 (a: authority). The height gives t. Height, speed and the
 * thrust at lift-off follow from t. */
static float leave_ground_by_height(est_law_t *law, const parameters_t *parameters)
{
    const float jerk_mps3 = RAMP_N_PER_S * vehicle_model(law, parameters).authority_mps2_per_n;
    const float risen_m = at_least(law->estimator.now.height_m - law->ground_m, 0.0F);
    const float since_s = cbrtf(6.0F * risen_m / jerk_mps3) + law->heightless_s;

    estimator_amend(&law->estimator, law->ground_m + jerk_mps3 * since_s * since_s * since_s / 6.0F,
                    0.5F * jerk_mps3 * since_s * since_s, 0.0F);
    return law->actuator.thrust_n - RAMP_N_PER_S * since_s;
}

/* The thrust grows until the vehicle leaves the ground. The thrust at that moment is the first hover
 * thrust. */
static bool take_off(est_law_t *law, const parameters_t *parameters)
{
    const float gravity_n = parameters->value[PARAMETER_GRAV];
    const cascade_vehicle_t vehicle = vehicle_model(law, parameters);
    const float drag_mps2 = vehicle.damping_per_s * at_least(law->lift_mps, 0.0F);
    const float taken_n = (law->lift_mps2 + drag_mps2) / vehicle.authority_mps2_per_n;
    const float height_m = law->estimator.now.height_m - law->ground_m;
    const float lift_off_m = est_law_has_acceleration(law) ? LIFT_OFF_M : NO_ACC_LIFT_OFF_M;
    const float known_n = at_least(gravity_n, law->flown_hover_n);
    const bool strong = law->actuator.thrust_n > LIFT_OFF_SHARE * gravity_n;

    law->ramping = true;
    const bool lifting = height_m > lift_off_m || law->lift_mps2 > lift_off_threshold_mps2(law);
    law->airborne = height_m > LIFT_OFF_SURE_M || (strong && lifting);
    if (law->airborne) {
        const float hover_n = est_law_has_acceleration(law) ? law->lift_n - taken_n
                                                            : leave_ground_by_height(law, parameters);
        start_hover(law, parameters, is_climb(parameters) ? known_n : hover_n,
                    is_climb(parameters) && known_n == gravity_n ? NEUTRAL_SIGMA_N : HOVER_SIGMA_START_N);
        cascade_init(&law->cascade, law->ramp_n);
    } else {
        law->ramp_n = at_most(law->ramp_n + RAMP_N_PER_S * law->step_s, RAMP_MOST * known_n);
    }
    return law->airborne;
}

static float landing_mps(float height_m)
{
    return -at_most(LAND_MPS + LAND_PER_S * at_least(height_m, 0.0F), LAND_MAX_MPS);
}

static float sinking_mps(float height_m)
{
    return -at_most(SINK_MPS + SINK_PER_S * at_least(height_m, 0.0F), SINK_MAX_MPS);
}

static void update_timers(est_law_t *law, est_mode_t mode, float height_m)
{
    const bool landing = mode == EST_MODE_LAND;

    law->near_ground_s = landing ? touchdown_time_s(law->near_ground_s, height_m, law->rocks, law->step_s)
                                 : 0.0F;
}

/* Upper limit of the thrust in a descent. It starts from the hover thrust that was sure when the descent
 * began, and it only falls. Neither learning during the descent nor a change of the kind of descent raises
 * it again. */
static void lower_ceiling(est_law_t *law, est_mode_t mode)
{
    const bool sinks = mode == EST_MODE_SINK;
    const float above_n = sinks ? SINK_ABOVE_HOVER_N : LAND_ABOVE_HOVER_N;
    const float fade_n_per_s = sinks ? SINK_FADE_N_PER_S : LAND_FADE_N_PER_S;

    if (mode == EST_MODE_HOLD) {
        return;
    }
    law->ceiling_n = at_most(law->ceiling_n - fade_n_per_s * law->step_s, law->entry_hover_n + above_n);
    law->ceiling_n = at_least(law->ceiling_n, 0.0F);
}

static float thrust_most_n(const est_law_t *law, est_mode_t mode)
{
    const float low_n = touchdown_limit_n(law->near_ground_s, law->hover.thrust_n);

    return (mode == EST_MODE_LAND) ? at_most(law->ceiling_n, low_n) : law->ceiling_n;
}

/* Without heights the estimated speed may be wrong. It must not cut the thrust so far that the vehicle
 * falls. */
static float thrust_least_n(const est_law_t *law, est_mode_t mode)
{
    return (mode == EST_MODE_SINK) ? at_least(law->entry_hover_n - SINK_BELOW_HOVER_N, 0.0F) : 0.0F;
}

static float height_setpoint_m(est_law_t *law, const parameters_t *parameters, float reference_m)
{
    const float ignored_m = law->estimator.terrain_height_m - law->reference_terrain_m;

    if (parameters_choice(parameters, PARAMETER_TERRAIN) == TERRAIN_FOLLOW ||
        reference_m != law->reference_m) {
        law->reference_terrain_m = law->estimator.terrain_height_m;
        law->reference_m = reference_m;
        return reference_m;
    }
    law->reference_terrain_m += ignored_m * law->step_s / TERRAIN_KEEP_S;
    return at_least(reference_m - ignored_m, LOWEST_OVER_TERRAIN_M);
}

static float speed_setpoint_mps(est_law_t *law, const parameters_t *parameters, const cascade_gains_t *gains,
                                const cascade_state_t *state, est_mode_t mode, float reference_m)
{
    switch (mode) {
    case EST_MODE_LAND:
        return landing_mps(state->height_m);
    case EST_MODE_SINK:
        return sinking_mps(state->height_m);
    case EST_MODE_HOLD:
    default:
        return cascade_speed_to(gains, state, height_setpoint_m(law, parameters, reference_m));
    }
}

/* Frames are missing: the latest command may have been an answer to noise, and must not last. */
static float without_frames_n(const est_law_t *law, float thrust_n)
{
    const float hover_n = law->hover.thrust_n;

    return (law->frameless_s > FRAMES_LATE_S)
               ? between(hover_n - LATE_WINDOW_N, thrust_n, hover_n + LATE_WINDOW_N)
               : thrust_n;
}

float est_law_step(est_law_t *law, const parameters_t *parameters, est_mode_t mode, float reference_m)
{
    const float *value = parameters->value;
    const bool landing = mode == EST_MODE_LAND;
    const cascade_gains_t gains = {
        .height_per_s = value[PARAMETER_POSK],
        .speed_per_s = value[PARAMETER_VELK],
        .up_mps = value[PARAMETER_VUP],
        .down_mps = value[PARAMETER_VDN],
        .fall_mps2 = landing ? BRAKE_MPS2 : FALL_MPS2,
        .below_hover_n = landing ? BRAKE_BELOW_HOVER_N : BELOW_HOVER_N,
    };

    if (!law->airborne && mode != EST_MODE_HOLD) {
        law->ramp_n = at_least(law->ramp_n - LANDED_FADE_N_PER_S * law->step_s, 0.0F);
        return law->ramp_n;
    }
    if (!law->airborne && !take_off(law, parameters)) {
        return law->ramp_n;
    }
    const cascade_vehicle_t vehicle = vehicle_model(law, parameters);
    const cascade_state_t state = predict_ahead(law, &vehicle);
    const float speed_mps = speed_setpoint_mps(law, parameters, &gains, &state, mode, reference_m);
    const float thrust_n = cascade_step(&law->cascade, &gains, &vehicle, &state, speed_mps, law->step_s);

    update_timers(law, mode, state.height_m);
    lower_ceiling(law, mode);
    const float limited_n = at_most(at_least(without_frames_n(law, thrust_n), thrust_least_n(law, mode)),
                                    thrust_most_n(law, mode));
    return deadband_compensate(&law->deadband, law->hover.thrust_n, limited_n);
}

void est_law_record_command(est_law_t *law, float thrust_n)
{
    const float effect_n = deadband_effect(&law->deadband, law->hover.thrust_n, thrust_n);
    actuator_command(&law->actuator, effect_n, law->now_us);
}
