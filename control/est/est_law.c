/* Law EST: estimator, hover thrust and cascade control together. The cascade acts on the predicted state at
 * the instant when its command takes effect, DELAY from now: a Smith predictor in state space. The same
 * model gives the estimator the acceleration that the thrust should cause. The noisier the accelerometer, the
 * more weight that acceleration gets.
 * What breaks: the actuator's model needs every command that was really given (est_before_t), or hover thrust
 * and prediction drift. While the pilot flies nothing may be learned (est_law_disengage).
 * Constants marked "fitted": docs/control.md; make tune LAW=EST ARGS="--constants est" repeats the search. */
#include "control/est/est_law.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/seconds.h"
#include "control/thrust.h"
#include "control/where/hover_thrust.h"

#define HOVER_SIGMA_START_N 0.7F /* half of a mass 20 % off */
#define NEUTRAL_SIGMA_N 0.07F    /* chosen: the thrust in the middle of the stick is known well */
#define MODEL_NOISE_MPS2 0.84F   /* fitted */
/* The model does not know the air. Of turbulence of 0.2 m/s2 that lasts 0.5 s (sim/devices/quadrotor.c) the
 * mean of a second is left, as of the accelerometer's noise (credit.c): 0.2 sqrt(1 - 0.5 (1 - exp(-2))). */
#define AIR_MPS2 0.15F
#define HEIGHTS_MISSING_S 0.2F /* two scans of 0.1 s */
#define FRAMES_FRESH_S ((float)ESTIMATOR_FRESH_US * 1.0e-6F)
#define AGE_MAX_S 3600.0F                       /* any above what is asked: the counters stop here */
#define GUST_MPS2_PER_M 39.2F                   /* fitted as 28 N/m on a vehicle that hovers at 7 N */
#define HEIGHT_USED_S (HEIGHT_FRESH_S + SCAN_S) /* as long as one is fresh; its rays are a scan older */

void est_law_init(est_law_t *law)
{
    memset(law, 0, sizeof *law); /* as in flight.c */
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

/* True when heights have been missing for more than two scans. */
static bool heights_missing(const est_law_t *law)
{
    return law->heightless_s > HEIGHTS_MISSING_S;
}

/* Of the model without heights: the hover thrust is off by its deviation, and goes on being it. */
static float alone_mps2(const est_law_t *law, float authority_mps2_per_n)
{
    const float hover_mps2 = authority_mps2_per_n * authority_mps2_per_n * law->hover.variance_n2;

    return sqrtf(AIR_MPS2 * AIR_MPS2 + hover_mps2);
}

/* Acceleration by the thrust model, known in the air only. Without heights the height does not tell that. */
static modelled_motion_t modelled_motion(const est_law_t *law, const parameters_t *parameters, bool airborne)
{
    const cascade_vehicle_t vehicle = vehicle_model(law, parameters);
    const estimate_t *now = &law->estimator.now;
    const bool alone = heights_missing(law);

    return (modelled_motion_t){
        .known = airborne && !law->doubted.without_authority && law->estimator.initialised &&
                 (now->height_m > IN_THE_AIR_M || alone),
        .up_mps2 = vehicle.authority_mps2_per_n * (law->actuator.thrust_n * vehicle.upright -
                                                   (law->estimator.felt ? vehicle.need_n : vehicle.hover_n)) -
                   vehicle.damping_per_s * now->speed_mps,
        .noise_mps2 = alone ? alone_mps2(law, vehicle.authority_mps2_per_n) : MODEL_NOISE_MPS2,
        .bias_mps2 = alone ? sqrtf(law->estimator.filter.covariance[FILTER_BIAS][FILTER_BIAS]) : 0.0F,
    };
}

static void learn(est_law_t *law, const parameters_t *parameters, float dt_s)
{
    const lesson_t lesson = {
        .vehicle = vehicle_model(law, parameters),
        .delivered_n = law->actuator.thrust_n,
        .is_climb = is_climb(parameters),
        .confirmed = law->heightless_s <= HEIGHT_FRESH_S && !law->doubted.without_authority &&
                     !law->doubted.no_effect,
        .dt_s = dt_s,
    };

    if (est_law_has_acceleration(law)) {
        learning_by_accelerations(&law->hover, &law->deadband, &law->estimator, &lesson);
    } else {
        learning_by_model(&law->hover, &law->deadband, &law->estimator, &lesson);
    }
}

static void predict_frame(est_law_t *law, const parameters_t *parameters, bool airborne,
                          const imu_sample_t *frame)
{
    const uint32_t before_us = law->estimator.now_us;
    imu_sample_t used = *frame;

    used.has_acceleration = frame->has_acceleration && !law->doubted.accelerations;
    estimator_predict(&law->estimator, &used, modelled_motion(law, parameters, airborne));
    const float dt_s = seconds_between(before_us, law->estimator.now_us);
    if (dt_s <= 0.0F || dt_s > CYCLE_MAX_S) {
        return;
    }
    actuator_advance(&law->actuator, law->estimator.now_us);
    law->frameless_s = seconds_between(law->estimator.now_us, law->now_us);
    const float felt_mps2 = est_law_has_acceleration(law)
                                ? law->estimator.up_mps2 - law->estimator.now.bias_mps2
                                : 0.0F;
    lift_off_watch(&law->lift, felt_mps2, law->actuator.thrust_n, dt_s);
    if (airborne) {
        learn(law, parameters, dt_s);
    }
}

/* The command of the cycle before is on its way to the rotors. */
static void take_command(est_law_t *law, const parameters_t *parameters, float thrust_n, uint32_t now_us)
{
    if (law->started) {
        actuator_command(&law->actuator, deadband_effect(&law->deadband, law->hover.thrust_n, thrust_n),
                         law->now_us);
    } else {
        law->started = true;
        law->now_us = now_us;
        actuator_init(&law->actuator, now_us);
    }
    actuator_describe(&law->actuator, parameters->value[PARAMETER_DELAY], parameters->value[PARAMETER_LAG]);
}

/* The sure hover thrust; a descent that begins goes on from it. */
static void know_hover(est_law_t *law, float hover_n, bool descends)
{
    law->sure_hover_n = hover_n;
    law->hover.most_n = at_least(law->hover.most_n, hover_n + (HOVER_BOUND_N - HOVER_THRUST_MARGIN_N));
    if (!descends) {
        let_down_arm(&law->down, hover_n);
    }
}

void est_law_predict(est_law_t *law, const parameters_t *parameters, const est_before_t *before,
                     const imu_sample_t *frames, uint16_t count, uint32_t now_us)
{
    take_command(law, parameters, before->thrust_n, now_us);
    if (!law->flew) {
        know_hover(law, before->hover_n, before->descends);
        law->terrain.ignores = false;
        law->terrain.ignored_m = 0.0F;
    }
    law->flew = false;
    law->left_ground = false;
    if (!is_climb(parameters)) {
        deadband_init(&law->deadband);
    }
    law->authority_mps2_per_n = vehicle_model(law, parameters).authority_mps2_per_n;
    law->step_s = between(0.0F, seconds_between(law->now_us, now_us), CYCLE_MAX_S);
    law->now_us = now_us;
    law->heightless_s = at_most(law->heightless_s + law->step_s, AGE_MAX_S);
    law->frameless_s = at_most(law->frameless_s + law->step_s, AGE_MAX_S);
    for (uint16_t i = imu_first_after(frames, count, law->estimator.sequence); i < count; ++i) {
        predict_frame(law, parameters, before->airborne, &frames[i]);
    }
    if (law->frameless_s > FRAMES_FRESH_S) {
        actuator_advance(&law->actuator,
                         now_us - ESTIMATOR_FRESH_US); /* without frames nothing else advances the model */
    }
}

/* Ground is passed over by accelerations and by more than one mirror. */
static height_outcome_t correct(est_law_t *law, const est_height_t *height, bool at_rest)
{
    estimator_t *e = &law->estimator;

    estimator_pass_over(e, law->terrain.ignores && terrain_sees_ground(&height->sight, e->passes_over) &&
                               e->has_frames && e->initialised && e->felt);
    return e->passes_over ? estimator_fuse_over(e, &height->sight, law->rays_us)
                          : estimator_fuse_height(e, height->sight.altitude, law->rays_us, at_rest);
}

void est_law_fuse_height(est_law_t *law, const est_height_t *height, bool airborne, bool at_rest)
{
    const bool stands = !airborne && lift_off_stands(&law->lift, law->estimator.credit.noise_mps2);

    law->rays_us = ray_clock_step(&law->ray_clock, height->stamp_ms, height->arrival_us, height->age_us);
    law->heightless_s = seconds_between(law->rays_us, law->now_us);
    if (law->frameless_s > FRAMES_FRESH_S) {
        estimator_forget_frame(&law->estimator);
    }
    const height_outcome_t outcome = correct(law, height, at_rest || stands);
    ahead_look(&law->ahead, &law->estimator, &height->sight, law->rays_us);
    if (airborne && outcome == HEIGHT_FUSED && law->estimator.felt) {
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
           (law->estimator.felt || law->heightless_s <= HEIGHT_USED_S);
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
static void remember_flight(est_law_t *law, float gravity_n, bool airborne)
{
    if (airborne) {
        law->flown_hover_n = law->sure_hover_n;
        law->flown_gravity_n = gravity_n;
    } else if (gravity_n != law->flown_gravity_n) {
        law->flown_hover_n = 0.0F;
    }
}

/* The height of the ground. Without heights it stands where it stood: the accelerometer's bias would carry it
 * away, and the next height would look like a lift-off. */
static float hold_ground_m(est_law_t *law)
{
    if (law->heightless_s <= HEIGHT_USED_S || !law->estimator.initialised) {
        return law->estimator.now.height_m;
    }
    estimator_amend(&law->estimator, law->lift.ground_m, 0.0F, law->estimator.now.bias_mps2);
    return law->lift.ground_m;
}

void est_law_reset(est_law_t *law, const parameters_t *parameters, bool airborne)
{
    const float gravity_n = parameters->value[PARAMETER_GRAV];

    remember_flight(law, gravity_n, airborne);
    law->doubted.without_authority = false;
    law->doubted.no_effect = false;
    law->terrain.arrived_m = 0.0F;
    law->terrain.ignores = false;
    lift_off_reset(&law->lift, gravity_n, hold_ground_m(law));
    let_down_reset(&law->down);
    terrain_keep_start(&law->terrain, law->estimator.terrain_height_m);
    law->ahead = (ahead_t){.known = false};
    start_hover(law, parameters, gravity_n, HOVER_SIGMA_START_N);
}

void est_law_engage(est_law_t *law, float hover_n)
{
    terrain_keep_start(&law->terrain, law->estimator.terrain_height_m);
    law->down.near_ground_s = 0.0F;
    law->hover.thrust_n = between(law->hover.least_n, hover_n, law->hover.most_n);
    law->hover.variance_n2 = NEAR_HOVER_N * NEAR_HOVER_N;
    law->hover.gust_n = 0.0F;
}

void est_law_doubt(est_law_t *law, const est_doubts_t *doubts)
{
    if (doubts->without_authority) {
        law->hover.thrust_n = between(law->hover.least_n, law->sure_hover_n, law->hover.most_n);
        law->hover.gust_n = 0.0F;
    }
    if (doubts->accelerations && !law->doubted.accelerations) {
        estimator_drop_accelerations(&law->estimator);
    }
    law->doubted = *doubts;
}

cascade_vehicle_t est_law_vehicle(const est_law_t *law, const parameters_t *parameters)
{
    return vehicle_model(law, parameters);
}

void est_law_disengage(est_law_t *law)
{
    law->lift.ramping = false;
}

/* Estimate and thrust, predicted to the instant when a command given now takes effect. */
static cascade_state_t predict_ahead(const est_law_t *law, const cascade_vehicle_t *vehicle)
{
    const estimate_t *now = &law->estimator.now;
    const float ahead_s = seconds_between(law->estimator.now_us, law->now_us + law->actuator.delay_us);
    const actuator_t then = actuator_at(&law->actuator, law->now_us + law->actuator.delay_us);
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

/* The thrust at the lift-off. Without accelerations the heights show that moment late. */
static float lift_off_hover_n(est_law_t *law, const cascade_vehicle_t *vehicle, const lift_off_signs_t *signs)
{
    if (signs->felt) {
        const float drag_mps2 = vehicle->damping_per_s * at_least(law->lift.up_mps, 0.0F);

        return law->lift.thrust_n - (law->lift.up_mps2 + drag_mps2) / vehicle->authority_mps2_per_n;
    }
    const lifted_t lifted = lift_off_by_height(&law->lift, signs, law->heightless_s,
                                               vehicle->authority_mps2_per_n);

    estimator_amend(&law->estimator, lifted.height_m, lifted.speed_mps, 0.0F);
    return lifted.thrust_n;
}

/* The thrust ramps up. Returns true when the vehicle has left the ground. */
static bool take_off(est_law_t *law, const parameters_t *parameters)
{
    const cascade_vehicle_t vehicle = vehicle_model(law, parameters);
    const float gravity_n = parameters->value[PARAMETER_GRAV];
    const float known_n = at_least(gravity_n, law->flown_hover_n);
    const bool neutral = is_climb(parameters) && known_n == gravity_n;
    const lift_off_signs_t signs = {
        .height_m = law->estimator.now.height_m,
        .delivered_n = law->actuator.thrust_n,
        .noise_mps2 = law->estimator.credit.noise_mps2,
        .felt = est_law_has_acceleration(law),
        .most_mps2 = is_climb(parameters) ? INFINITY
                                          : vehicle.authority_mps2_per_n *
                                                (law->lift.thrust_n - gravity_n + HOVER_THRUST_MARGIN_N),
    };

    if (!lift_off_is_seen(&law->lift, &signs)) {
        lift_off_ramp(&law->lift, known_n, law->step_s);
        return false;
    }
    const float hover_n = lift_off_hover_n(law, &vehicle, &signs);
    start_hover(law, parameters, is_climb(parameters) ? known_n : hover_n,
                neutral ? NEUTRAL_SIGMA_N : HOVER_SIGMA_START_N);
    return true;
}

/* A command acts after the dead time, and then the motors lag. */
static float over_ground_to_come_m(const est_law_t *law, const cascade_gains_t *gains, float setpoint_m)
{
    const actuator_t *actuator = &law->actuator;
    return ahead_setpoint_m(&law->ahead, gains, setpoint_m,
                            law->now_us + actuator->delay_us + (uint32_t)(actuator->lag_s * 1.0e6F));
}

static float speed_setpoint_mps(est_law_t *law, const parameters_t *parameters, const cascade_gains_t *gains,
                                const cascade_state_t *state, est_mode_t mode, float reference_m)
{
    const bool follows = parameters_choice(parameters, PARAMETER_TERRAIN) == TERRAIN_FOLLOW;
    const terrain_keep_how_t how = follows                      ? TERRAIN_KEEP_NOT
                                   : law->estimator.passes_over ? TERRAIN_KEEP_GROUND
                                                                : TERRAIN_KEEP_STEPS;

    if (mode != EST_MODE_HOLD) {
        law->terrain.ignored_m = 0.0F;
        law->terrain.ignores = false;
        return let_down_mps(mode, state->height_m);
    }
    const terrain_keep_ground_t ground = {
        .height_m = law->estimator.terrain_height_m, .rate_mps = law->estimator.now.terrain_mps, .how = how};
    const float setpoint_m = terrain_keep_setpoint_m(&law->terrain, reference_m, &ground, law->step_s);
    law->terrain.ignored_m = reference_m - setpoint_m;
    if (fabsf(setpoint_m - state->height_m) < CONTENT_M) {
        law->terrain.arrived_m = reference_m;
    }
    law->terrain.ignores = !follows && law->terrain.arrived_m == reference_m;
    const float acts_s = law->heightless_s + (float)law->actuator.delay_us * 1.0e-6F;
    const float held_m = follows ? over_ground_to_come_m(law, gains, setpoint_m) : setpoint_m;
    const float wanted_mps = cascade_speed_to(gains, state, held_m);
    return (follows || law->heightless_s > HEIGHT_FRESH_S)
               ? wanted_mps
               : terrain_keep_above_mps(state->height_m, law->estimator.ground_mps, acts_s, gains,
                                        wanted_mps);
}

/* The thrust on the ground: of the ramp, or of its end. */
static float standing_n(est_law_t *law, est_mode_t mode)
{
    if (mode != EST_MODE_HOLD) {
        lift_off_give_up(&law->lift, law->step_s);
    }
    return law->lift.ramp_n;
}

float est_law_step(est_law_t *law, const parameters_t *parameters, const est_order_t *order)
{
    const float *value = parameters->value;
    const est_mode_t mode = order->mode;
    const cascade_gains_t gains = {
        .height_per_s = value[PARAMETER_POSK],
        .speed_per_s = value[PARAMETER_VELK],
        .up_mps = value[PARAMETER_VUP],
        .down_mps = value[PARAMETER_VDN],
    };

    law->flew = true;
    know_hover(law, order->hover_n, order->descends);
    law->left_ground = !order->airborne && mode == EST_MODE_HOLD && take_off(law, parameters);
    if (!order->airborne && !law->left_ground) {
        return standing_n(law, mode);
    }
    const cascade_vehicle_t vehicle = vehicle_model(law, parameters);
    const cascade_state_t state = predict_ahead(law, &vehicle);
    const float speed_mps = speed_setpoint_mps(law, parameters, &gains, &state, mode, order->reference_m);
    const float thrust_n = cascade_thrust_n(&gains, &vehicle, &state, speed_mps);

    let_down_step(&law->down, mode,
                  &(let_down_signs_t){state.height_m, law->doubted.rocks, law->doubted.seen,
                                      !law->doubted.without_authority, law->step_s});
    const float limited_n = let_down_limit_n(&law->down, mode, thrust_n, law->hover.thrust_n);
    return deadband_compensate(&law->deadband, law->hover.thrust_n, limited_n);
}

bool est_law_left_ground(const est_law_t *law)
{
    return law->left_ground;
}
