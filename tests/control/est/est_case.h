/* Law EST in a case that is said in words, for the tests of its calls and of those who tell it something.
 * This is the only file of these tests that knows how it remembers. */
#ifndef TESTS_CONTROL_EST_CASE_H
#define TESTS_CONTROL_EST_CASE_H

#include "control/est/est_law.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define GRAV_N 7.0F
#define FRAME_AGE_US UINT32_C(23600) /* FRAME_AGE_US of imu_sample.h plus half a period */

static parameters_t parameters;
static est_law_t est;
static float commanded_n;  /* in the cycle before */
static float sure_hover_n; /* and known then */
static bool descends;

static inline void set(parameter_id_t id, float value)
{
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, id, value));
}

/* ---- the estimate */

static inline void estimated(float height_m, float speed_mps, float bias_mps2)
{
    estimator_start(&est.estimator, height_m, speed_mps, bias_mps2);
    est.estimator.unchecked_count = 0U;
}

/* No height has checked the speed yet. */
static inline void unchecked(void)
{
    const estimate_t *is = &est.estimator.now;

    estimator_start(&est.estimator, is->height_m, is->speed_mps, is->bias_mps2);
}

static inline void confirmed(bool is_confirmed)
{
    est.estimator.confirmed = is_confirmed;
}

static inline void innovation_is_m(float innovation_m)
{
    est.estimator.innovation_m = innovation_m;
}

static inline void noise_is_mps2(float noise_mps2)
{
    est.estimator.credit.noise_mps2 = noise_mps2;
}

static inline void lose_the_estimate(void)
{
    est.estimator.initialised = false;
}

static inline void no_frame_has_come(void)
{
    est.estimator.has_frames = false;
}

static inline void accelerations_come(bool felt)
{
    est.estimator.felt = felt;
}

static inline void upright_is(float upright)
{
    est.estimator.upright = upright;
}

/* The terrain rises at this rate; it has risen by so much. */
static inline void terrain_rises(float terrain_mps, float terrain_height_m)
{
    est.estimator.now.terrain_mps = terrain_mps;
    est.estimator.terrain_height_m = terrain_height_m;
}

/* By heights and speed, while it passes over the terrain. */
static inline void ground_rose_mps(float ground_mps)
{
    est.estimator.ground_mps = ground_mps;
}

static inline void frame_was_s_ago(float frameless_s)
{
    est.frameless_s = frameless_s;
}

static inline void height_was_s_ago(float heightless_s)
{
    est.heightless_s = heightless_s;
}

static inline void rays_were_at_us(uint32_t rays_us)
{
    est.rays_us = rays_us;
}

/* ---- thrust */

static inline void est_hovers_at_n(float thrust_n)
{
    est.hover.thrust_n = thrust_n;
}

static inline void gust_is_n(float gust_n)
{
    est.hover.gust_n = gust_n;
}

static inline void delivers_n(float thrust_n)
{
    est.actuator.thrust_n = est.actuator.demand_n = commanded_n = thrust_n;
    est.actuator.count = 0U;
}

static inline void band_is_n(float band_n)
{
    est.deadband.band_n = band_n;
}

/* ---- take-off */

static inline void ground_was_at_m(float height_m)
{
    est.lift.ground_m = height_m;
}

static inline void lifts_at(float lift_mps2)
{
    est.lift.up_mps2 = lift_mps2;
}

/* Delivered thrust and speed that belong to that acceleration. */
static inline void lifts_with(float lift_n, float lift_mps)
{
    est.lift.thrust_n = lift_n;
    est.lift.up_mps = lift_mps;
}

/* A cycle begins. */
static inline void est_predicts(bool airborne, const imu_sample_t *frames, uint16_t count, uint32_t now_us)
{
    const est_before_t before = {
        .airborne = airborne, .thrust_n = commanded_n, .hover_n = sure_hover_n, .descends = descends};

    est_law_predict(&est, &parameters, &before, frames, count, now_us);
}

/* Law EST flies in this cycle. A vehicle that descends goes on with it until it says otherwise. */
static inline float est_flies_n(bool airborne, est_mode_t mode, float reference_m)
{
    descends = descends || mode != EST_MODE_HOLD;
    const est_order_t order = {.mode = mode,
                               .reference_m = reference_m,
                               .airborne = airborne,
                               .hover_n = sure_hover_n,
                               .descends = descends};

    return est_law_step(&est, &parameters, &order);
}

/* In the air at 0.5 m and at rest, all sensors fresh; hover thrust, thrust and GRAV 7 N. */
static inline void est_begin(uint32_t now_us)
{
    const imu_sample_t frame = {.sequence = 1U,
                                .arrival_us = now_us,
                                .ready = true,
                                .has_acceleration = true,
                                .down_mps2 = IMU_GRAVITY_MPS2};
    const altitude_t altitude = {.valid = true, .slant_mm = 500.0F};

    commanded_n = sure_hover_n = GRAV_N;
    descends = false;
    parameters_init(&parameters);
    est_law_init(&est);
    est_predicts(false, NULL, 0U, now_us - FRAME_AGE_US);
    est_law_reset(&est, &parameters, false);
    est_predicts(false, &frame, 1U, now_us);
    frame_was_s_ago(0.0F);
    height_was_s_ago(0.0F);
    accelerations_come(true);
    (void)estimator_fuse_height(&est.estimator, &altitude, now_us - FRAME_AGE_US, false);
    estimated(0.5F, 0.0F, 0.0F);
    est_law_engage(&est, GRAV_N);
    delivers_n(GRAV_N);
}

#endif
