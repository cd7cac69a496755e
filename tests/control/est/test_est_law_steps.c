/* Law EST one call at a time, on a state that is written down: what each call may learn, limit and pass on to
 * the estimator, the actuator's model and the cascade, which have tests of their own. How the law flies is in
 * test_est_law.c. */
#include "control/est/est_law.h"
#include "control/thrust.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define G_MPS2 9.80665F
#define T_US UINT32_C(4294500000) /* wraps within the tests */
#define FRAME_AGE_US UINT32_C(23600)
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(2.0e-4F, expected, actual)

static est_law_t law, before;
static parameters_t parameters;
static imu_sample_t frame;

static void set(parameter_id_t id, float value)
{
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, id, value));
}

/* In the air at 0.5 m and at rest; hover thrust and GRAV 7 N; the next cycle is 25 ms later. */
void setUp(void)
{
    parameters_init(&parameters);
    est_law_init(&law);
    est_law_predict(&law, &parameters, NULL, 0U, T_US);
    est_law_reset(&law, &parameters);
    estimator_t *e = &law.estimator;
    e->initialised = e->has_frames = e->felt = true;
    e->delayed_us = e->rays_us = e->now_us = e->felt_us = T_US - FRAME_AGE_US;
    e->filter.estimate.height_m = e->now.height_m = e->roughness.previous_m[0] = e->roughness.previous_m[1] =
        0.5F;
    e->latest.time_us = e->now_us;
    law.authority_mps2_per_n = G_MPS2 / 7.0F;
    law.airborne = true;
    law.hover.variance_n2 = 0.01F;
    law.actuator.time_us = e->now_us;
    law.actuator.thrust_n = law.actuator.demand_n = 7.0F;
    law.sure_hover_n = law.entry_hover_n = 7.0F;
    cascade_init(&law.cascade, 7.0F);
    frame = (imu_sample_t){.ready = true, .has_acceleration = true, .down_mps2 = G_MPS2};
}

void tearDown(void) {}

/* One cycle with one frame that feels up_mps2. */
static void cycle(float up_mps2)
{
    before = law;
    frame.sequence++;
    frame.arrival_us = law.now_us + 25000U;
    frame.down_mps2 = G_MPS2 + up_mps2;
    est_law_predict(&law, &parameters, &frame, 1U, law.now_us + 25000U);
}

/* ---- start */

void test_it_begins_with_nothing_known(void)
{
    ray_clock_t ray_clock;
    ray_clock_init(&ray_clock);
    memset(&law, 0x55, sizeof law);
    est_law_init(&law);
    TEST_ASSERT_FALSE(law.started || law.airborne || law.ramping || law.without_authority || law.rocks);
    TEST_ASSERT_FALSE(law.accelerations_doubted);
    TEST_ASSERT_EQUAL(ray_clock.started, law.ray_clock.started);
    TEST_ASSERT_EQUAL_UINT32(ray_clock.stamp_ms, law.ray_clock.stamp_ms);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.heightless_s + law.frameless_s + law.flown_hover_n + law.near_ground_s);
    TEST_ASSERT_EQUAL_FLOAT(0.4F, law.estimator.credit.noise_mps2);
    est_law_predict(&law, &parameters, NULL, 0U, T_US);
    TEST_ASSERT_TRUE(law.started);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.step_s);
    TEST_ASSERT_EQUAL_UINT32(T_US, law.actuator.time_us);
}

/* ---- the vehicle's model */

void test_the_authority_is_gravity_by_the_hover_thrust(void)
{
    set(PARAMETER_GAIN, 1.2F);
    law.hover.gust_n = 0.3F;
    law.estimator.upright = 0.9F;
    law.estimator.now.bias_mps2 = 0.5F;
    cascade_vehicle_t vehicle = est_law_vehicle(&law, &parameters);
    NEAR(1.2F * G_MPS2 / 7.0F, vehicle.authority_mps2_per_n);
    NEAR(7.0F, vehicle.hover_n);
    NEAR(7.3F, vehicle.need_n);
    NEAR(0.9F, vehicle.upright);
    law.hover.thrust_n = 0.5F;
    NEAR(1.2F * G_MPS2, est_law_vehicle(&law, &parameters).authority_mps2_per_n); /* of 1 N at least */
    law.hover.thrust_n = 7.0F;
    law.estimator.felt = false; /* the filter's bias is then the model's error */
    vehicle = est_law_vehicle(&law, &parameters);
    NEAR(7.0F + 0.5F * 7.0F / (1.2F * G_MPS2), vehicle.need_n);
    set(PARAMETER_PLANT, PLANT_CLIMB);
    vehicle = est_law_vehicle(&law, &parameters);
    NEAR(1.0F / 0.25F, vehicle.authority_mps2_per_n);
    NEAR(4.0F, vehicle.damping_per_s);
    NEAR(1.0F, vehicle.upright); /* the autopilot sees to that */
    NEAR(7.125F, vehicle.need_n);
}

/* ---- what is learned in the air */

/* Newton: thrust less what climb and drag took; its noise: the accelerometer's and a half per m/s. */
static void assert_learned(bool learned)
{
    hover_t expected = before.hover;
    const estimator_t *e = &law.estimator;
    const float authority = G_MPS2 / before.hover.thrust_n;
    const float taken_n = (e->up_mps2 - e->now.bias_mps2 + 2.5F * e->now.speed_mps) / authority;
    if (learned) {
        hover_step(&expected, law.actuator.thrust_n * e->upright - taken_n,
                   e->credit.noise_mps2 / authority + 0.5F * fabsf(e->now.speed_mps), 0.025F);
        TEST_ASSERT_TRUE(fabsf(expected.thrust_n - before.hover.thrust_n) > 0.001F);
    }
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected.thrust_n, law.hover.thrust_n);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, expected.variance_n2, law.hover.variance_n2);
}

void test_the_hover_thrust_is_learned_by_newton(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        setUp();
        law.estimator.now.speed_mps = 0.4F * side;
        law.estimator.now.bias_mps2 = law.estimator.filter.estimate.bias_mps2 = -0.3F * side;
        frame.median.roll_rad = 0.3F;
        cycle(1.0F * side);
        assert_learned(true);
    }
}

void test_nothing_is_learned_that_no_height_confirms(void)
{
    for (int why = 0; why < 8; why++) {
        setUp();
        law.heightless_s = (why == 1) ? 0.28F : 0.27F;
        law.estimator.unchecked_count = (why == 2) ? 1U : 0U;
        law.without_authority = why == 3;
        law.estimator.credit.accused_frames = (why == 4) ? 5U : 0U;
        law.airborne = why != 5;
        law.estimator.now.height_m = law.estimator.filter.estimate.height_m = (why == 6) ? 0.035F : 0.045F;
        cycle((why == 7) ? -1.0F : 1.0F);
        if (why == 7) { /* low, but the thrust needed is more than known */
            assert_learned(true);
        } else {
            assert_learned(why == 0);
        }
    }
    setUp();
    law.estimator.now.height_m = law.estimator.filter.estimate.height_m = 0.035F;
    cycle(-1.0F);
    assert_learned(true);
}

/* Without accelerations the bias of the filter moves into the hover thrust within 3 s. */
void test_without_accelerations_the_models_error_becomes_hover_thrust(void)
{
    for (int why = 0; why < 4; why++) {
        setUp();
        law.estimator.felt = frame.has_acceleration = false;
        law.estimator.now.bias_mps2 = law.estimator.filter.estimate.bias_mps2 = 0.6F;
        law.heightless_s = (why == 1) ? 0.28F : 0.27F;
        law.without_authority = why == 2;
        law.hover.most_n = (why == 3) ? 7.001F : 9.0F;
        cycle(0.0F);
        const float authority = G_MPS2 / 7.0F;
        const float moved_n = (why == 0) ? 0.025F / 3.0F * 0.6F / authority : (why == 3) ? 0.001F : 0.0F;
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 7.0F + moved_n, law.hover.thrust_n);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 0.6F - moved_n * authority, law.estimator.now.bias_mps2);
    }
}

void test_a_climb_rate_autopilot_is_learned_slowly_and_its_deadband_too(void)
{
    for (int felt = 0; felt < 2; felt++) {
        for (int low = 0; low < 2; low++) {
            setUp();
            set(PARAMETER_PLANT, PLANT_CLIMB);
            law.estimator.felt = frame.has_acceleration = felt != 0;
            law.estimator.now.height_m = (low != 0) ? 0.035F : 0.05F;
            law.estimator.now.bias_mps2 = law.estimator.filter.estimate.bias_mps2 = (felt != 0) ? 0.0F : 0.6F;
            law.actuator.thrust_n = law.actuator.demand_n = 7.4F;
            law.deadband.band_n = 0.2F;
            cycle(0.0F);
            deadband_t expected = {0.2F};
            if (low == 0 && felt != 0) {
                const float taken_n = (law.estimator.up_mps2 + 4.0F * law.estimator.now.speed_mps) / 4.0F;
                deadband_learn(&expected, 7.4F - law.hover.thrust_n, 7.4F - taken_n - law.hover.thrust_n,
                               0.025F);
            } else if (low == 0) {
                deadband_learn(&expected, 0.4F, 0.15F, 0.1F * 0.025F);
            }
            TEST_ASSERT_FLOAT_WITHIN(2.0e-5F, expected.band_n, law.deadband.band_n);
            if (felt == 0) {
                TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 7.0F + 0.025F / 30.0F * 0.6F / 4.0F, law.hover.thrust_n);
            }
        }
    }
}

void test_a_plain_autopilot_has_no_deadband(void)
{
    law.deadband.band_n = 0.2F;
    cycle(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.deadband.band_n);
}

/* ---- what the thrust should do */

/* Without accelerations the model alone moves the estimate: it can be read there. */
void test_the_modelled_motion_is_thrust_less_hover_and_drag(void)
{
    law.estimator.felt = frame.has_acceleration = false;
    law.actuator.thrust_n = law.actuator.demand_n = 7.7F;
    law.estimator.now.speed_mps = law.estimator.filter.estimate.speed_mps = 0.2F;
    law.estimator.now.bias_mps2 = law.estimator.filter.estimate.bias_mps2 = 0.3F;
    law.estimator.upright = 0.95F;
    cycle(0.0F);
    NEAR(G_MPS2 / 7.0F * (7.7F * 0.95F - 7.0F) - 2.5F * 0.2F, law.estimator.latest.motion.up_mps2);
    NEAR(1.0F, law.estimator.latest.motion.share);
    setUp(); /* with accelerations, the gust is part of the model */
    law.hover.gust_n = 0.4F;
    law.actuator.thrust_n = law.actuator.demand_n = 7.7F;
    cycle(0.0F);
    const float share = 0.84F * 0.84F / (0.84F * 0.84F + 0.16F);
    NEAR(share, law.estimator.latest.motion.share);
    NEAR((1.0F - share) * G_MPS2 / 7.0F * 0.3F, law.estimator.latest.motion.up_mps2);
}

void test_the_model_is_known_in_the_air_alone(void)
{
    for (int why = 0; why < 6; why++) {
        setUp();
        law.airborne = why != 1;
        law.without_authority = why == 2;
        law.estimator.initialised = why != 3;
        law.estimator.now.height_m = (why >= 4) ? 0.035F : 0.045F;
        law.heightless_s = (why == 5) ? 0.18F : 0.17F;
        cycle(0.0F);
        TEST_ASSERT_EQUAL(why == 0 || why == 5, law.estimator.latest.motion.share < 0.99F);
    }
}

void test_without_heights_the_model_has_more_weight(void)
{
    law.heightless_s = 0.17F; /* 0.195 s then */
    cycle(0.0F);
    NEAR(0.81514F, law.estimator.latest.motion.share); /* 0.84 against 0.4 m/s2 */
    setUp();
    law.heightless_s = 0.18F;
    cycle(0.0F);
    NEAR(0.0225F / 0.1825F, law.estimator.latest.motion.share); /* 0.15 */
}

/* ---- cycles */

void test_the_step_of_a_cycle_is_between_none_and_half_a_second(void)
{
    est_law_predict(&law, &parameters, NULL, 0U, T_US + 30000U);
    NEAR(0.03F, law.step_s);
    NEAR(0.03F, law.heightless_s);
    NEAR(0.03F, law.frameless_s);
    TEST_ASSERT_EQUAL_UINT32(T_US + 30000U, law.now_us);
    est_law_predict(&law, &parameters, NULL, 0U, T_US + 1030000U);
    NEAR(0.5F, law.step_s);
    est_law_predict(&law, &parameters, NULL, 0U, T_US + 1029000U);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.step_s);
    law.heightless_s = law.frameless_s = 3600.0F;
    est_law_predict(&law, &parameters, NULL, 0U, T_US + 2000000U);
    TEST_ASSERT_EQUAL_FLOAT(3600.0F, law.heightless_s);
    TEST_ASSERT_EQUAL_FLOAT(3600.0F, law.frameless_s);
}

void test_a_frame_moves_the_actuators_model_and_the_age_of_frames(void)
{
    law.actuator.demand_n = 8.0F;
    actuator_t expected = law.actuator;
    actuator_describe(&expected, 0.0185F, 0.12F);
    actuator_advance(&expected, T_US + 25000U - FRAME_AGE_US);
    cycle(0.0F);
    NEAR(expected.thrust_n, law.actuator.thrust_n);
    NEAR(0.0236F, law.frameless_s);
    NEAR(G_MPS2 / 7.0F, law.authority_mps2_per_n);
}

void test_without_frames_for_250_ms_the_actuators_model_moves_with_the_clock(void)
{
    for (int late = 0; late < 2; late++) {
        setUp();
        law.actuator.demand_n = 8.0F;
        law.frameless_s = (late != 0) ? 0.226F : 0.224F;
        actuator_t expected = law.actuator;
        actuator_describe(&expected, 0.0185F, 0.12F);
        actuator_advance(&expected, T_US + 300000U);
        est_law_predict(&law, &parameters, NULL, 0U, T_US + 25000U);
        est_law_predict(&law, &parameters, NULL, 0U, T_US + 25000U);
        NEAR(7.0F, law.actuator.thrust_n); /* 225 ms ago is before its own time still */
        law.frameless_s = (late != 0) ? 0.26F : -1.0F;
        est_law_predict(&law, &parameters, NULL, 0U, T_US + 550000U);
        NEAR((late != 0) ? expected.thrust_n : 7.0F, law.actuator.thrust_n);
    }
}

void test_imu_and_estimate_are_ready_while_they_are_fresh(void)
{
    law.frameless_s = 0.25F;
    TEST_ASSERT_TRUE(est_law_has_imu(&law));
    TEST_ASSERT_TRUE(est_law_ready(&law));
    law.estimator.initialised = false;
    TEST_ASSERT_FALSE(est_law_ready(&law));
    law.estimator.initialised = true;
    law.frameless_s = 0.251F;
    TEST_ASSERT_FALSE(est_law_has_imu(&law));
    TEST_ASSERT_FALSE(est_law_ready(&law));
    law.frameless_s = 0.0F;
    law.estimator.has_frames = false;
    TEST_ASSERT_FALSE(est_law_has_imu(&law));
    law.estimator.has_frames = true;
    law.heightless_s = 5.0F;
    TEST_ASSERT_TRUE(est_law_ready(&law));
    law.estimator.felt = false;
    TEST_ASSERT_FALSE(est_law_ready(&law));
    law.heightless_s = 0.4F;
    TEST_ASSERT_TRUE(est_law_ready(&law));
    law.heightless_s = 0.41F;
    TEST_ASSERT_FALSE(est_law_ready(&law));
}

void test_a_doubt_of_the_accelerations_drops_them_once_and_ignores_them(void)
{
    est_law_doubt(&law, &(est_doubts_t){.accelerations = true});
    TEST_ASSERT_FALSE(law.estimator.felt);
    law.estimator.felt = true;
    est_law_doubt(&law, &(est_doubts_t){.accelerations = true});
    TEST_ASSERT_TRUE(law.estimator.felt);
    law.estimator.felt = false;
    cycle(3.0F);
    TEST_ASSERT_FALSE(est_law_has_acceleration(&law));
    est_law_doubt(&law, &(est_doubts_t){.accelerations = false});
    TEST_ASSERT_FALSE(law.estimator.felt);
    cycle(0.0F);
    TEST_ASSERT_TRUE(est_law_has_acceleration(&law));
}

/* ---- the lift-off */

void test_the_lift_off_is_watched_through_80_ms_and_its_speed_decays_within_a_second(void)
{
    law.airborne = false;
    law.ramping = true;
    law.lift_mps2 = 0.2F;
    law.lift_n = 6.0F;
    law.lift_mps = 0.4F;
    law.estimator.now.bias_mps2 = law.estimator.filter.estimate.bias_mps2 = 0.1F;
    cycle(1.1F);
    NEAR(0.2F + 0.3125F * 0.8F, law.lift_mps2); /* 25 of 80 ms */
    NEAR(6.0F + 0.3125F * 1.0F, law.lift_n);
    NEAR(0.4F * 0.975F + 0.025F, law.lift_mps);
    law.ramping = false;
    cycle(1.1F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.lift_mps);
    setUp();
    law.estimator.felt = frame.has_acceleration = false;
    law.estimator.up_mps2 = 3.0F;
    law.lift_mps2 = 1.0F;
    cycle(0.0F);
    NEAR(0.6875F, law.lift_mps2); /* nothing felt is no acceleration */
}

/* On the ramp, with this lift acceleration, noise, height above the ground, thrust and GRAV 7 N. */
static bool lifts(float lift_mps2, float noise_mps2, float height_m, float thrust_n)
{
    setUp();
    law.airborne = false;
    law.lift_mps2 = lift_mps2;
    law.estimator.credit.noise_mps2 = noise_mps2;
    law.ground_m = 0.02F;
    law.estimator.now.height_m = 0.02F + height_m;
    law.actuator.thrust_n = thrust_n;
    law.step_s = 0.025F;
    (void)est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F);
    TEST_ASSERT_TRUE(law.ramping);
    return law.airborne;
}

void test_it_is_off_the_ground_by_acceleration_or_height_and_enough_thrust(void)
{
    TEST_ASSERT_TRUE(lifts(0.91F, 0.4F, 0.0F, 4.91F));
    TEST_ASSERT_FALSE(lifts(0.89F, 0.4F, 0.0F, 4.91F));
    TEST_ASSERT_FALSE(lifts(0.91F, 0.4F, 0.0F, 4.89F)); /* 0.7 of GRAV */
    TEST_ASSERT_TRUE(lifts(1.21F, 1.0F, 0.0F, 4.91F));
    TEST_ASSERT_FALSE(lifts(1.19F, 1.0F, 0.0F, 4.91F)); /* 1.2 sigma */
    TEST_ASSERT_TRUE(lifts(0.0F, 0.4F, 0.0305F, 4.91F));
    TEST_ASSERT_FALSE(lifts(0.0F, 0.4F, 0.0295F, 4.91F));
    TEST_ASSERT_FALSE(lifts(0.0F, 0.4F, 0.0995F, 4.89F));
    TEST_ASSERT_TRUE(lifts(0.0F, 0.4F, 0.1005F, 4.89F));
}

void test_without_accelerations_the_height_has_to_show_more(void)
{
    for (int high = 0; high < 2; high++) {
        setUp();
        law.airborne = law.estimator.felt = false;
        law.ground_m = 0.02F;
        law.estimator.now.height_m = (high != 0) ? 0.0555F : 0.0545F;
        law.actuator.thrust_n = 7.0F;
        (void)est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F);
        TEST_ASSERT_EQUAL(high != 0, law.airborne);
    }
}

void test_the_ramp_grows_by_4_newtons_a_second_to_a_third_above_gravity(void)
{
    law.airborne = false;
    law.actuator.thrust_n = 0.0F;
    law.ground_m = 0.5F;
    law.step_s = 0.1F;
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 0.68F * 7.0F + 0.4F,
                             est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 0.68F * 7.0F + 0.8F,
                             est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F));
    law.ramp_n = 9.4F;
    NEAR(1.35F * 7.0F, est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F));
    law.flown_hover_n = 7.4F; /* the battery was that empty */
    NEAR(9.85F, est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F));
    NEAR(1.35F * 7.4F, est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F));
    NEAR(1.35F * 7.4F - 0.2F, est_law_step(&law, &parameters, EST_MODE_LAND, 0.0F)); /* 2 N/s down */
    law.ramp_n = 0.1F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, est_law_step(&law, &parameters, EST_MODE_SINK, 0.0F));
}

void test_the_thrust_at_the_lift_off_is_the_first_hover_thrust(void)
{
    law.airborne = false;
    law.actuator.thrust_n = 8.0F;
    law.lift_n = 7.5F;
    law.lift_mps2 = 1.0F;
    law.lift_mps = 0.1F;
    law.step_s = 0.025F;
    law.ground_m = 0.5F;
    (void)est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F);
    TEST_ASSERT_TRUE(law.airborne);
    NEAR(7.5F - (1.0F + 2.5F * 0.1F) * 7.0F / G_MPS2, law.hover.thrust_n);
    NEAR(0.49F, law.hover.variance_n2);
    NEAR(5.0F, law.hover.least_n);
    NEAR(9.0F, law.hover.most_n);
    setUp();
    law.airborne = false;
    law.actuator.thrust_n = 8.0F;
    law.lift_n = 7.5F;
    law.lift_mps2 = 1.0F;
    law.lift_mps = -0.1F; /* no drag of a sinking vehicle on the ground */
    law.ground_m = 0.5F;
    (void)est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F);
    NEAR(7.5F - 1.0F * 7.0F / G_MPS2, law.hover.thrust_n);
}

void test_a_climb_rate_autopilot_hovers_in_the_middle_of_the_stick(void)
{
    for (int flown = 0; flown < 2; flown++) {
        setUp();
        set(PARAMETER_PLANT, PLANT_CLIMB);
        law.airborne = false;
        law.flown_hover_n = (flown != 0) ? 7.4F : 0.0F;
        law.lift_mps2 = 2.0F;
        law.actuator.thrust_n = 8.0F;
        law.ground_m = 0.5F;
        (void)est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F);
        NEAR((flown != 0) ? 7.4F : 7.0F, law.hover.thrust_n);
        NEAR((flown != 0) ? 0.49F : 0.0049F, law.hover.variance_n2);
        NEAR((flown != 0) ? 9.4F : 9.0F, law.hover.most_n);
    }
}

/* The thrust grows by 4 N/s: after t the vehicle has risen by a 4 t3 / 6. At 40 mm t is 0.22 s. */
void test_without_accelerations_the_height_tells_when_it_left_the_ground(void)
{
    law.airborne = law.estimator.felt = false;
    law.ground_m = 0.5F;
    law.estimator.now.height_m = law.estimator.filter.estimate.height_m = 0.54F;
    law.estimator.now.bias_mps2 = law.estimator.filter.estimate.bias_mps2 = 0.2F;
    law.actuator.thrust_n = law.actuator.demand_n = 7.9F;
    law.heightless_s = 0.05F;
    const float jerk = 4.0F * G_MPS2 / 7.0F;
    const float t = cbrtf(6.0F * 0.04F / jerk) + 0.05F;
    (void)est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F);
    NEAR(7.9F - 4.0F * t, law.hover.thrust_n);
    NEAR(0.5F + jerk * t * t * t / 6.0F, law.estimator.now.height_m);
    NEAR(0.5F * jerk * t * t, law.estimator.now.speed_mps);
    NEAR(0.0F, law.estimator.now.bias_mps2);
}

/* ---- heights */

static void see(float height_m, bool at_rest)
{
    const altitude_t altitude = {.valid = true, .slant_mm = 1000.0F * height_m};
    before = law;
    est_law_fuse_height(&law, &altitude, 1000U, law.now_us, 70000U, at_rest);
}

void test_a_height_is_as_old_as_its_rays(void)
{
    see(0.5F, false);
    TEST_ASSERT_EQUAL_UINT32(T_US - 70000U, law.rays_us);
    NEAR(0.07F, law.heightless_s);
}

void test_an_innovation_is_a_gust_as_far_as_the_model_has_weight(void)
{
    for (int why = 0; why < 4; why++) {
        setUp();
        law.estimator.latest.motion.share = 0.8F;
        law.airborne = why != 1;
        law.estimator.felt = why != 2;
        see((why == 3) ? 0.9F : 0.51F, false);
        hover_t expected = before.hover;
        if (why == 0) {
            hover_nudge(&expected, -39.2F * 0.2F * law.estimator.innovation_m / (G_MPS2 / 7.0F));
            TEST_ASSERT_TRUE(fabsf(expected.gust_n) > 0.01F);
        }
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected.gust_n, law.hover.gust_n);
    }
}

void test_on_the_ramp_a_vehicle_that_does_not_accelerate_is_at_rest(void)
{
    static const struct {
        bool airborne, ramping;
        float lift_mps2, noise_mps2;
        bool rests;
    } rows[] = {{false, true, 0.355F, 0.4F, true}, {false, true, 0.365F, 0.4F, false},
                {true, true, 0.0F, 0.4F, false},   {false, false, 0.0F, 0.4F, false},
                {false, true, 0.475F, 1.0F, true}, {false, true, 0.485F, 1.0F, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        law.airborne = rows[i].airborne;
        law.ramping = rows[i].ramping;
        law.lift_mps2 = rows[i].lift_mps2;
        law.estimator.credit.noise_mps2 = rows[i].noise_mps2;
        law.estimator.filter.estimate.speed_mps = 0.1F;
        law.estimator.filter.covariance[FILTER_SPEED][FILTER_SPEED] = 0.04F;
        see(0.5F, false);
        TEST_ASSERT_EQUAL(rows[i].rests, law.estimator.filter.estimate.speed_mps < 0.01F);
    }
    setUp();
    law.estimator.filter.estimate.speed_mps = 0.1F;
    see(0.5F, true);
    TEST_ASSERT_TRUE(law.estimator.filter.estimate.speed_mps < 0.01F);
}

/* ---- taking over and giving back */

void test_a_flight_leaves_its_hover_thrust_to_the_next_until_grav_changes(void)
{
    law.sure_hover_n = 7.6F;
    est_law_reset(&law, &parameters);
    NEAR(7.6F, law.flown_hover_n);
    NEAR(9.6F, law.hover.most_n);
    NEAR(5.0F, law.hover.least_n);
    NEAR(7.0F, law.hover.thrust_n);
    NEAR(0.49F, law.hover.variance_n2);
    law.sure_hover_n = 8.0F;
    est_law_reset(&law, &parameters);
    NEAR(7.6F, law.flown_hover_n);
    set(PARAMETER_GRAV, 1.5F);
    est_law_reset(&law, &parameters);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.flown_hover_n);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.hover.least_n);
    NEAR(3.5F, law.hover.most_n);
}

void test_a_reset_forgets_the_flight(void)
{
    law.ramping = law.without_authority = true;
    law.estimator.now.height_m = 0.03F;
    law.estimator.terrain_height_m = 0.2F;
    law.ceiling_n = 3.0F;
    law.near_ground_s = 2.0F;
    law.cascade.quick_n = 9.0F;
    est_law_reset(&law, &parameters);
    TEST_ASSERT_FALSE(law.airborne || law.ramping || law.without_authority);
    NEAR(0.03F, law.ground_m);
    NEAR(0.2F, law.reference_terrain_m);
    NEAR(THRUST_MAX_N, law.ceiling_n);
    NEAR(0.68F * 7.0F, law.ramp_n);
    NEAR(0.68F * 7.0F, law.cascade.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.near_ground_s);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.cascade.quick_n);
}

void test_an_engaged_law_starts_from_command_and_hover_thrust(void)
{
    est_law_disengage(&law);
    TEST_ASSERT_FALSE(law.airborne);
    law.estimator.terrain_height_m = 0.3F;
    law.near_ground_s = 1.0F;
    law.hover.gust_n = 0.4F;
    law.cascade.quick_n = 9.0F;
    est_law_engage(&law, 6.5F, 7.3F);
    TEST_ASSERT_TRUE(law.airborne);
    NEAR(0.3F, law.reference_terrain_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.near_ground_s);
    NEAR(7.3F, law.hover.thrust_n);
    NEAR(0.25F, law.hover.variance_n2);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.hover.gust_n);
    NEAR(6.5F, law.cascade.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.cascade.quick_n);
    est_law_engage(&law, 6.5F, 9.3F);
    NEAR(9.0F, law.hover.thrust_n);
    est_law_engage(&law, 6.5F, 4.3F);
    NEAR(5.0F, law.hover.thrust_n);
    law.ramping = true;
    est_law_disengage(&law);
    TEST_ASSERT_FALSE(law.ramping);
}

void test_the_hover_thrust_of_the_entry_is_that_of_before_the_descent(void)
{
    law.ceiling_n = 5.0F;
    est_law_set_sure_hover(&law, 7.5F, true);
    NEAR(7.5F, law.sure_hover_n);
    NEAR(7.0F, law.entry_hover_n);
    NEAR(5.0F, law.ceiling_n);
    est_law_set_sure_hover(&law, 7.4F, false);
    NEAR(7.4F, law.entry_hover_n);
    NEAR(THRUST_MAX_N, law.ceiling_n);
}

void test_a_thrust_without_authority_is_the_sure_one(void)
{
    law.hover.gust_n = 0.3F;
    law.sure_hover_n = 7.5F;
    est_law_doubt(&law, &(est_doubts_t){.without_authority = false});
    NEAR(7.0F, law.hover.thrust_n);
    NEAR(0.3F, law.hover.gust_n);
    est_law_doubt(&law, &(est_doubts_t){.without_authority = true});
    NEAR(7.5F, law.hover.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.hover.gust_n);
    law.sure_hover_n = 11.0F;
    est_law_doubt(&law, &(est_doubts_t){.without_authority = true});
    NEAR(9.0F, law.hover.thrust_n);
    TEST_ASSERT_TRUE(law.without_authority);
}

/* ---- flying */

/* What the cascade commands for this speed from the state at the instant when a command takes effect: 18.5 ms
 * from now, and the estimate is 23.6 ms old. The thrust until then is the mean of both instants. */
static float expected_n(float (*speed_of)(const cascade_state_t *), float fall_mps2, float below_n)
{
    const estimate_t now = law.estimator.now;
    const float ahead_s = 0.0236F + 0.0185F;
    const float authority = G_MPS2 / law.hover.thrust_n;
    actuator_t then = law.actuator;
    actuator_advance(&then, law.now_us + 18500U);
    const float mean_n = 0.5F * (law.actuator.thrust_n + then.thrust_n) * law.estimator.upright;
    const float mps2 = authority * (mean_n - law.hover.thrust_n - law.hover.gust_n) - 2.5F * now.speed_mps;
    const cascade_state_t state = {
        .height_m = now.height_m + (now.speed_mps - now.terrain_mps + 0.5F * mps2 * ahead_s) * ahead_s,
        .speed_mps = now.speed_mps + mps2 * ahead_s,
        .terrain_mps = now.terrain_mps,
        .thrust_n = then.thrust_n};
    const cascade_gains_t gains = {2.3F, 8.0F, 0.7F, 1.1F, fall_mps2, below_n};
    const cascade_vehicle_t vehicle = est_law_vehicle(&law, &parameters);
    cascade_t cascade = law.cascade;
    return cascade_step(&cascade, &gains, &vehicle, &state, speed_of(&state), law.step_s);
}

static float to_0_6_m(const cascade_state_t *state)
{
    const cascade_gains_t gains = {2.3F, 8.0F, 0.7F, 1.1F, 0.0F, 0.0F};
    return cascade_speed_to(&gains, state, 0.6F);
}

static float landing(const cascade_state_t *state)
{
    return -(0.15F + 0.25F * state->height_m);
}

static float landing_at_most(const cascade_state_t *state)
{
    (void)state;
    return -0.4F;
}

static float sinking(const cascade_state_t *state)
{
    return -(0.28F + 0.07F * state->height_m);
}

static float sinking_at_most(const cascade_state_t *state)
{
    (void)state;
    return -0.6F;
}

static void move_somehow(float height_m)
{
    setUp();
    law.step_s = 0.1F;
    actuator_describe(&law.actuator, 0.0185F, 0.12F);
    law.estimator.now = (estimate_t){.height_m = height_m, .speed_mps = 0.15F, .terrain_mps = 0.1F};
    law.actuator.demand_n = 7.6F;
    law.estimator.upright = 0.97F;
    law.hover.gust_n = 0.2F;
}

void test_the_command_is_the_cascades_from_the_state_that_it_will_meet(void)
{
    move_somehow(0.5F);
    NEAR(expected_n(to_0_6_m, 3.96F, 3.0F), est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F));
    NEAR(0.6F, law.reference_m);
}

void test_a_landing_slows_down_towards_the_ground(void)
{
    move_somehow(0.5F);
    NEAR(expected_n(landing, 8.0F, 6.0F), est_law_step(&law, &parameters, EST_MODE_LAND, 0.0F));
    move_somehow(2.0F);
    NEAR(expected_n(landing_at_most, 8.0F, 6.0F), est_law_step(&law, &parameters, EST_MODE_LAND, 0.0F));
}

void test_a_descent_without_heights_is_slower_near_the_ground_too(void)
{
    move_somehow(0.5F);
    law.estimator.now.speed_mps = -0.3F;
    NEAR(expected_n(sinking, 3.96F, 3.0F), est_law_step(&law, &parameters, EST_MODE_SINK, 0.0F));
    move_somehow(6.0F);
    law.estimator.now.speed_mps = -0.61F;
    NEAR(expected_n(sinking_at_most, 3.96F, 3.0F), est_law_step(&law, &parameters, EST_MODE_SINK, 0.0F));
}

/* One step whose cascade wants much more, or much less. */
static float descend(est_mode_t mode, bool wants_more)
{
    law.step_s = 0.5F; /* no slew limits */
    law.estimator.now.speed_mps = wants_more ? -2.0F : 2.0F;
    return est_law_step(&law, &parameters, mode, 0.0F);
}

void test_the_ceiling_of_a_descent_starts_above_the_entrys_hover_thrust_and_falls(void)
{
    law.ceiling_n = 20.0F;
    NEAR(8.5F, descend(EST_MODE_LAND, true));
    NEAR(8.45F, descend(EST_MODE_LAND, true)); /* 0.1 N/s */
    NEAR(7.5F, descend(EST_MODE_SINK, true));
    NEAR(7.4F, descend(EST_MODE_SINK, true));  /* 0.2 N/s */
    NEAR(7.35F, descend(EST_MODE_LAND, true)); /* and never rises again */
    law.ceiling_n = 0.01F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, descend(EST_MODE_LAND, true));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.ceiling_n);
    law.ceiling_n = 5.0F;
    (void)descend(EST_MODE_HOLD, true);
    TEST_ASSERT_EQUAL_FLOAT(5.0F, law.ceiling_n);
}

void test_without_heights_the_thrust_is_not_cut_too_far(void)
{
    NEAR(5.7F, descend(EST_MODE_SINK, false)); /* 1.3 N below the entry's */
    setUp();
    TEST_ASSERT_TRUE(descend(EST_MODE_LAND, false) < 5.6F);
    setUp();
    law.entry_hover_n = 1.0F;
    law.hover.thrust_n = 1.0F;
    law.ceiling_n = 0.0F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, descend(EST_MODE_SINK, false));
}

void test_the_end_of_a_landing_fades_the_thrust_out(void)
{
    law.estimator.now.height_m = 0.02F;
    law.near_ground_s = 0.5F;
    law.step_s = 0.1F;
    law.estimator.now.speed_mps = -0.5F;
    cascade_init(&law.cascade, 7.0F);
    NEAR(7.0F + 0.5F - 2.0F * 0.6F, est_law_step(&law, &parameters, EST_MODE_LAND, 0.0F));
    NEAR(0.6F, law.near_ground_s);
    law.near_ground_s = 1.0F;
    law.rocks = true;
    (void)est_law_step(&law, &parameters, EST_MODE_LAND, 0.0F);
    NEAR(1.01F, law.near_ground_s); /* it is in the air yet: a tenth */
    (void)est_law_step(&law, &parameters, EST_MODE_SINK, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.near_ground_s);
    law.near_ground_s = 1.0F;
    (void)est_law_step(&law, &parameters, EST_MODE_HOLD, 0.6F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, law.near_ground_s);
}

/* ---- terrain that is passed over */

static float hold_n(float reference_m)
{
    cascade_init(&law.cascade, 7.0F);
    law.step_s = 0.1F;
    return est_law_step(&law, &parameters, EST_MODE_HOLD, reference_m);
}

void test_ignored_terrain_moves_the_setpoint_by_its_height(void)
{
    set(PARAMETER_TERRAIN, TERRAIN_IGNORE);
    actuator_describe(&law.actuator, 0.0185F, 0.12F);
    const float level_n = hold_n(0.55F);
    law.estimator.terrain_height_m = 0.05F;
    const float over_n = hold_n(0.60F); /* a new reference counts from the terrain of now */
    NEAR(0.05F, law.reference_terrain_m);
    TEST_ASSERT_TRUE(over_n > level_n + 0.1F);
    law.estimator.terrain_height_m = 0.10F;
    NEAR(level_n, hold_n(0.60F)); /* 5 cm above it, and so 55 cm over the terrain of now */
    NEAR(0.05F + 0.05F * 0.1F / 30.0F, law.reference_terrain_m);
    set(PARAMETER_TERRAIN, TERRAIN_FOLLOW);
    NEAR(over_n, hold_n(0.60F));
    NEAR(0.10F, law.reference_terrain_m);
}

void test_fifteen_centimetres_over_the_terrain_are_kept(void)
{
    set(PARAMETER_TERRAIN, TERRAIN_IGNORE);
    actuator_describe(&law.actuator, 0.0185F, 0.12F);
    law.estimator.now.height_m = 0.2F;
    const float at_0_15_n = hold_n(0.15F);
    (void)hold_n(0.60F);
    law.estimator.terrain_height_m = 0.9F;
    NEAR(at_0_15_n, hold_n(0.60F));
}

/* ---- commands */

void test_a_command_takes_effect_after_the_delay_and_beyond_the_deadband(void)
{
    set(PARAMETER_PLANT, PLANT_CLIMB);
    law.deadband.band_n = 0.2F;
    actuator_describe(&law.actuator, 0.03F, 0.12F);
    est_law_record_command(&law, 7.5F);
    TEST_ASSERT_EQUAL_UINT16(1U, law.actuator.count);
    TEST_ASSERT_EQUAL_UINT32(T_US + 30000U, law.actuator.coming[0].due_us);
    NEAR(deadband_effect(&law.deadband, 7.0F, 7.5F), law.actuator.coming[0].thrust_n);
    move_somehow(0.5F);
    set(PARAMETER_PLANT, PLANT_CLIMB);
    const est_law_t start = law;
    const float without_n = est_law_step(&law, &parameters, EST_MODE_HOLD, 0.9F);
    law = start;
    law.deadband.band_n = 0.2F;
    NEAR(deadband_compensate(&law.deadband, 7.0F, without_n),
         est_law_step(&law, &parameters, EST_MODE_HOLD, 0.9F));
}

/* ---- frames that are late */

void test_a_height_without_frames_forgets_the_latest_one(void)
{
    for (int late = 0; late < 2; late++) {
        setUp();
        law.frameless_s = (late != 0) ? 0.151F : 0.15F;
        law.estimator.latest.motion.share = 0.8F;
        see(0.5F, false);
        TEST_ASSERT_EQUAL_FLOAT((late != 0) ? 0.0F : 0.8F, law.estimator.latest.motion.share);
    }
}

void test_without_frames_the_thrust_is_within_half_a_newton_of_hover(void)
{
    for (int side = -1; side < 2; side += 2) {
        for (int late = 0; late < 2; late++) {
            setUp();
            law.step_s = 0.5F;
            law.frameless_s = (late != 0) ? 0.151F : 0.15F;
            law.hover.thrust_n = 7.1F;
            law.estimator.now.speed_mps = -1.0F * (float)side;
            const float thrust_n = est_law_step(&law, &parameters, EST_MODE_HOLD, 0.5F);
            if (late != 0) {
                NEAR(7.1F + 0.5F * (float)side, thrust_n);
            } else {
                TEST_ASSERT_TRUE((thrust_n - 7.1F) * (float)side > 1.0F);
            }
        }
    }
}

void test_a_gust_is_forgotten_while_no_height_confirms_the_speed(void)
{
    law.heightless_s = 0.28F;
    law.hover.gust_n = 0.4F;
    cycle(0.0F);
    NEAR(0.4F * (1.0F - 0.025F / 0.76F), law.hover.gust_n);
}
