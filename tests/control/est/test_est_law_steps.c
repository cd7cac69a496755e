/* Law EST one call at a time: what each call may learn, limit and pass on to the estimator, the actuator's
 * model and the cascade, which have tests of their own. How the law flies is in test_est_law.c. */
#include "control/est/est_law.h"
#include "control/thrust.h"
#include "est/est_case.h"

#define G_MPS2 9.80665F
#define T_US UINT32_C(4294500000) /* wraps within the tests */
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(2.0e-4F, expected, actual)
#define AUTHORITY (G_MPS2 / GRAV_N)

static imu_sample_t frame;
static uint32_t clock_us;
static est_law_t before;
static bool flies; /* as contact tells it */

static void airborne(bool is_airborne)
{
    flies = is_airborne;
}

static void predict(const imu_sample_t *frames, uint16_t count)
{
    est_predicts(flies, frames, count, clock_us);
}

/* A cycle of the law, with the lift-off as contact is told of it. */
static float step(est_mode_t mode, float reference_m)
{
    const float thrust_n = est_flies_n(flies, mode, reference_m);

    flies = flies || est_law_left_ground(&est);
    return thrust_n;
}

static void reset(void)
{
    est_law_reset(&est, &parameters, flies);
    airborne(false);
    descends = false;
}

/* As the hand-over does both. */
static void engage(float hover_n)
{
    airborne(true);
    est_law_engage(&est, hover_n);
}

static void disengage(void)
{
    airborne(false);
    est_law_disengage(&est);
}

/* In the air at 0.5 m and at rest; hover thrust and GRAV 7 N. */
void setUp(void)
{
    est_begin(T_US);
    airborne(true);
    hover_init(&est.hover, GRAV_N, 0.1F, 5.0F, 9.0F);
    noise_is_mps2(0.4F);
    clock_us = T_US;
    frame = (imu_sample_t){.sequence = 1U, .ready = true, .has_acceleration = true, .down_mps2 = G_MPS2};
}

void tearDown(void) {}

/* One cycle of 25 ms with one frame that feels up_mps2. */
static void cycle(float up_mps2)
{
    before = est;
    clock_us += 25000U;
    frame.sequence++;
    frame.arrival_us = clock_us;
    frame.down_mps2 = G_MPS2 + up_mps2;
    predict(&frame, 1U);
}

/* Time passes without a frame, and none is missed. */
static void pass(float seconds)
{
    clock_us += (uint32_t)lroundf(seconds * 1.0e6F);
    predict(NULL, 0U);
    frame_was_s_ago(0.0F);
}

/* Given now, and in each cycle from now on. */
static void command_n(float thrust_n)
{
    const float step_s = est.step_s;

    commanded_n = thrust_n;
    predict(NULL, 0U);
    est.step_s = step_s;
}

/* A cycle of another law, in which the vehicle does not descend. */
static void sure_hover_is_n(float hover_n)
{
    sure_hover_n = hover_n;
    descends = false;
    predict(NULL, 0U);
    predict(NULL, 0U);
}

/* The same with a frame at its end; whoever says then what is estimated. */
static void pass_seeing(float seconds)
{
    clock_us += (uint32_t)lroundf(seconds * 1.0e6F);
    frame.sequence++;
    frame.arrival_us = clock_us;
    frame.down_mps2 = G_MPS2;
    predict(&frame, 1U);
}

static void deaf(void)
{
    accelerations_come(false);
    frame.has_acceleration = false;
}

void test_it_begins_with_nothing_known(void)
{
    memset(&est, 0x55, sizeof est);
    est_law_init(&est);
    airborne(false);
    TEST_ASSERT_FALSE(est_law_has_imu(&est) || est_law_ready(&est));
    TEST_ASSERT_FALSE(est_law_has_acceleration(&est));
    est_predicts(flies, NULL, 0U, T_US);
    reset();
    NEAR(0.68F * GRAV_N, step(EST_MODE_HOLD, 0.6F)); /* the ramp, no time yet */
}

/* ---- the vehicle's model */

void test_the_authority_is_gravity_by_the_hover_thrust(void)
{
    set(PARAMETER_GAIN, 1.2F);
    estimated(0.5F, 0.0F, 0.5F);
    gust_is_n(0.3F);
    upright_is(0.9F);
    cascade_vehicle_t vehicle = est_law_vehicle(&est, &parameters);
    NEAR(1.2F * AUTHORITY, vehicle.authority_mps2_per_n);
    NEAR(7.0F, vehicle.hover_n);
    NEAR(7.3F, vehicle.need_n);
    NEAR(0.9F, vehicle.upright);
    est_hovers_at_n(0.5F);
    NEAR(1.2F * G_MPS2, est_law_vehicle(&est, &parameters).authority_mps2_per_n); /* of 1 N at least */
    est_hovers_at_n(7.0F);
    accelerations_come(false); /* the filter's bias is then the model's error */
    NEAR(7.0F + 0.5F / (1.2F * AUTHORITY), est_law_vehicle(&est, &parameters).need_n);
    set(PARAMETER_PLANT, PLANT_CLIMB);
    vehicle = est_law_vehicle(&est, &parameters);
    NEAR(1.0F / 0.25F, vehicle.authority_mps2_per_n);
    NEAR(4.0F, vehicle.damping_per_s);
    NEAR(1.0F, vehicle.upright); /* the autopilot sees to that */
    NEAR(7.125F, vehicle.need_n);
}

/* ---- what is learned in the air */

/* Newton: thrust less what climb and drag took; its noise: the accelerometer's and 0.33 per m/s. */
static void assert_learned(bool learned)
{
    hover_t expected = before.hover;
    const estimator_t *e = &est.estimator;
    const float authority = G_MPS2 / before.hover.thrust_n;
    const float taken_n = (e->up_mps2 - e->now.bias_mps2 + 2.5F * e->now.speed_mps) / authority;
    if (learned) {
        hover_step(&expected, est.actuator.thrust_n * e->upright - taken_n,
                   e->credit.noise_mps2 / authority + 0.33F * fabsf(e->now.speed_mps), 0.025F);
        TEST_ASSERT_TRUE(fabsf(expected.thrust_n - before.hover.thrust_n) > 0.001F);
    }
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected.thrust_n, est.hover.thrust_n);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, expected.variance_n2, est.hover.variance_n2);
}

void test_the_hover_thrust_is_learned_by_newton(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        setUp();
        estimated(0.5F, 0.4F * side, -0.3F * side);
        frame.median.roll_rad = 0.3F;
        cycle(1.0F * side);
        assert_learned(true);
    }
}

void test_nothing_is_learned_that_no_height_confirms(void)
{
    for (int why = 0; why < 8; why++) {
        setUp();
        height_was_s_ago((why == 1) ? 0.28F : 0.27F);
        est_law_doubt(&est, &(est_doubts_t){.without_authority = why == 3, .no_effect = why == 7});
        airborne(why != 4);
        estimated((why == 5 || why == 6) ? 0.035F : 0.045F, 0.0F, 0.0F);
        if (why == 2) {
            unchecked();
        }
        cycle((why == 6) ? -1.0F : 1.0F);
        assert_learned(why == 0 || why == 6); /* low, but the thrust needed is more than known */
    }
}

/* Without accelerations the bias of the filter moves into the hover thrust within 3 s. */
void test_without_accelerations_the_models_error_becomes_hover_thrust(void)
{
    for (int why = 0; why < 4; why++) {
        setUp();
        deaf();
        estimated(0.5F, 0.0F, 0.6F);
        height_was_s_ago((why == 1) ? 0.28F : 0.27F);
        est_law_doubt(&est, &(est_doubts_t){.without_authority = why == 2});
        sure_hover_n = (why == 3) ? 6.5F : GRAV_N;
        hover_init(&est.hover, GRAV_N, 0.1F, 5.0F, (why == 3) ? 7.001F : 9.0F);
        cycle(0.0F);
        const float moved_n = (why == 0) ? 0.025F / 3.0F * 0.6F / AUTHORITY : (why == 3) ? 0.001F : 0.0F;
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 7.0F + moved_n, est.hover.thrust_n);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 0.6F - moved_n * AUTHORITY, est.estimator.now.bias_mps2);
    }
}

/* Half the width of the dead band, as it is compensated far from neutral. */
static float band_n(void)
{
    return deadband_compensate(&est.deadband, 0.0F, 1.0F) - 1.0F;
}

void test_a_climb_rate_autopilot_is_learned_and_its_deadband_too(void)
{
    for (int felt = 0; felt < 2; felt++) {
        for (int low = 0; low < 2; low++) {
            setUp();
            set(PARAMETER_PLANT, PLANT_CLIMB);
            if (felt == 0) {
                deaf();
            }
            estimated((low != 0) ? 0.035F : 0.05F, 0.0F, (felt != 0) ? 0.0F : 0.6F);
            delivers_n(7.4F);
            band_is_n(0.2F);
            cycle(0.0F);
            deadband_t expected = {0.2F};
            if (low == 0 && felt != 0) {
                const float taken_n = (est.estimator.up_mps2 + 4.0F * est.estimator.now.speed_mps) / 4.0F;
                deadband_learn(&expected, 7.4F - est.hover.thrust_n, 7.4F - taken_n - est.hover.thrust_n,
                               0.025F);
            } else if (low == 0) {
                deadband_learn(&expected, 0.4F, 0.15F, 0.1F * 0.025F);
            }
            TEST_ASSERT_FLOAT_WITHIN(2.0e-5F, deadband_compensate(&expected, 0.0F, 1.0F) - 1.0F, band_n());
            if (felt == 0) {
                TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 7.0F + 0.025F / 3.0F * 0.6F / 4.0F, est.hover.thrust_n);
            }
        }
    }
}

void test_a_plain_autopilot_has_no_deadband(void)
{
    band_is_n(0.2F);
    cycle(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, band_n());
}

/* ---- what the thrust should do */

/* By how much the speed has grown in a cycle of 25 ms in which nothing was felt, as an acceleration. */
static float moved_mps2(void)
{
    const float from_mps = est.estimator.now.speed_mps;

    cycle(0.0F);
    return (est.estimator.now.speed_mps - from_mps) / 0.025F;
}

/* Share of a model with this error, by the accelerometer's noise. */
static float share_against(float model_mps2)
{
    const float noise_mps2 = 0.4F; /* as it begins */

    return noise_mps2 * noise_mps2 / (model_mps2 * model_mps2 + noise_mps2 * noise_mps2);
}

/* Share of the model, whose 1.4 m/s2 is not felt. */
static float model_share(void)
{
    delivers_n(8.0F);
    return moved_mps2() / AUTHORITY;
}

void test_the_modelled_motion_is_thrust_less_hover_and_drag(void)
{
    deaf(); /* the model alone moves the estimate */
    delivers_n(7.7F);
    estimated(0.5F, 0.2F, 0.0F);
    upright_is(0.95F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, AUTHORITY * (7.7F * 0.95F - 7.0F) - 2.5F * 0.2F, moved_mps2());
    setUp(); /* with accelerations, the gust is part of the model */
    gust_is_n(0.4F);
    delivers_n(7.7F);
    TEST_ASSERT_FLOAT_WITHIN(2.0e-3F, share_against(0.84F) * AUTHORITY * 0.3F, moved_mps2());
}

void test_the_model_is_known_in_the_air_alone(void)
{
    for (int why = 0; why < 6; why++) {
        setUp();
        est_law_doubt(&est, &(est_doubts_t){.without_authority = why == 2});
        estimated((why >= 4) ? 0.035F : 0.045F, 0.0F, 0.0F);
        airborne(why != 1);
        height_was_s_ago((why == 5) ? 0.18F : 0.17F);
        if (why == 3) {
            lose_the_estimate();
            cycle(0.0F);
            estimated(0.045F, 0.0F, 0.0F); /* in the frame before it was not known */
        } else {
            TEST_ASSERT_EQUAL(why == 0 || why == 5, model_share() > 0.01F);
        }
    }
}

void test_without_heights_the_lasting_errors_of_model_and_accelerometer_share_the_weight(void)
{
    height_was_s_ago(0.17F); /* 0.195 s then */
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, share_against(0.84F), model_share());
    setUp();
    height_was_s_ago(0.18F);
    const float hover_mps2 = AUTHORITY * sqrtf(est.hover.variance_n2);
    const float bias_variance = est.estimator.filter.covariance[FILTER_BIAS][FILTER_BIAS];
    const float felt = bias_variance + 0.4F * 0.4F / 40.0F; /* of the noise a second's mean */
    const float model = 0.15F * 0.15F + hover_mps2 * hover_mps2;

    TEST_ASSERT_TRUE(bias_variance > 0.0F && hover_mps2 > 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, felt / (model + felt), model_share());
}

/* ---- cycles */

/* The take-off's ramp, which grows by 4 N/s, tells the duration of a cycle. */
static float ramp_n(void)
{
    return step(EST_MODE_HOLD, 0.6F);
}

static void stand(void)
{
    reset();
    ground_was_at_m(0.5F);
    delivers_n(0.0F);
}

void test_the_step_of_a_cycle_is_between_none_and_half_a_second(void)
{
    stand();
    const float from_n = 0.68F * GRAV_N;
    pass(0.03F);
    NEAR(from_n + 0.12F, ramp_n());
    pass(1.0F);
    NEAR(from_n + 2.12F, ramp_n());
    clock_us -= 1000U;
    pass(0.0F);
    NEAR(from_n + 2.12F, ramp_n());
}

void test_a_frame_moves_the_actuators_model(void)
{
    command_n(8.0F);
    actuator_t expected = est.actuator;
    cycle(0.0F);
    cycle(0.0F);
    actuator_advance(&expected, T_US + 50000U - FRAME_AGE_US);
    TEST_ASSERT_TRUE(expected.thrust_n > 7.01F);
    NEAR(expected.thrust_n, est.actuator.thrust_n);
}

void test_without_frames_for_250_ms_the_actuators_model_moves_with_the_clock(void)
{
    command_n(8.0F);
    actuator_t expected = est.actuator;
    for (int i = 1; i <= 5; i++) { /* 250 ms */
        actuator_command(&expected, 8.0F, clock_us);
        clock_us += 50000U;
        predict(NULL, 0U);
        NEAR(7.0F, est.actuator.thrust_n);
    }
    actuator_command(&expected, 8.0F, clock_us);
    clock_us += 100000U;
    predict(NULL, 0U);
    actuator_advance(&expected, clock_us - ESTIMATOR_FRESH_US);
    TEST_ASSERT_TRUE(expected.thrust_n > 7.1F);
    NEAR(expected.thrust_n, est.actuator.thrust_n);
}

void test_imu_and_estimate_are_ready_while_they_are_fresh(void)
{
    frame_was_s_ago(0.25F);
    TEST_ASSERT_TRUE(est_law_has_imu(&est) && est_law_ready(&est));
    frame_was_s_ago(0.251F);
    TEST_ASSERT_FALSE(est_law_has_imu(&est) || est_law_ready(&est));
    frame_was_s_ago(0.0F);
    height_was_s_ago(5.0F);
    TEST_ASSERT_TRUE(est_law_ready(&est));
    accelerations_come(false);
    TEST_ASSERT_FALSE(est_law_ready(&est));
    height_was_s_ago(0.41F);
    TEST_ASSERT_FALSE(est_law_ready(&est));
    height_was_s_ago(0.4F);
    TEST_ASSERT_TRUE(est_law_ready(&est));
    lose_the_estimate();
    TEST_ASSERT_FALSE(est_law_ready(&est));
    TEST_ASSERT_TRUE(est_law_has_imu(&est));
    no_frame_has_come();
    TEST_ASSERT_FALSE(est_law_has_imu(&est));
}

void test_the_age_of_frames_and_heights_grows_with_the_clock(void)
{
    clock_us += 250000U;
    predict(NULL, 0U);
    TEST_ASSERT_TRUE(est_law_has_imu(&est));
    est_predicts(flies, NULL, 0U, clock_us + 1000U);
    TEST_ASSERT_FALSE(est_law_has_imu(&est));
    setUp();
    deaf();
    for (int i = 1; i <= 17; i++) {
        cycle(0.0F);
        TEST_ASSERT_TRUE(i == 16 || est_law_ready(&est) == (i < 16)); /* 0.4 s */
    }
}

void test_a_doubt_of_the_accelerations_drops_them_once_and_ignores_them(void)
{
    est_law_doubt(&est, &(est_doubts_t){.accelerations = true});
    TEST_ASSERT_FALSE(est_law_has_acceleration(&est));
    accelerations_come(true);
    est_law_doubt(&est, &(est_doubts_t){.accelerations = true});
    TEST_ASSERT_TRUE(est_law_has_acceleration(&est));
    accelerations_come(false);
    cycle(3.0F);
    TEST_ASSERT_FALSE(est_law_has_acceleration(&est));
    est_law_doubt(&est, &(est_doubts_t){.accelerations = false});
    TEST_ASSERT_FALSE(est_law_has_acceleration(&est));
    cycle(0.0F);
    TEST_ASSERT_TRUE(est_law_has_acceleration(&est));
}

/* ---- the lift-off */

void test_the_lift_off_is_watched_through_80_ms(void)
{
    stand();
    lifts_at(0.2F);
    estimated(0.5F, 0.0F, 0.1F);
    cycle(1.1F);
    NEAR(0.2F + 0.3125F * 0.8F, est.lift.up_mps2); /* 25 of 80 ms */
    setUp();
    deaf();
    lifts_at(1.0F);
    cycle(0.0F);
    NEAR(0.6875F, est.lift.up_mps2); /* nothing felt is no acceleration */
}

void test_the_thrust_of_the_lift_off_is_watched_likewise(void)
{
    stand();
    lifts_with(6.0F, 0.0F);
    delivers_n(7.0F);
    cycle(0.0F);
    lifts_at(1.0F);
    (void)ramp_n();
    TEST_ASSERT_TRUE(flies);
    NEAR(6.3125F - 1.0F / AUTHORITY, est.hover.thrust_n);
}

/* On the ramp, with this lift acceleration, noise, height above the ground, thrust and GRAV 7 N. */
static bool lifts(float lift_mps2, float noise_mps2, float height_m, float thrust_n)
{
    setUp();
    stand();
    noise_is_mps2(noise_mps2);
    ground_was_at_m(0.02F);
    estimated(0.02F + height_m, 0.0F, 0.0F);
    delivers_n(thrust_n);
    lifts_with(thrust_n, 0.0F);
    lifts_at(lift_mps2);
    (void)ramp_n();
    return flies;
}

void test_it_is_off_the_ground_by_acceleration_or_height(void)
{
    TEST_ASSERT_TRUE(lifts(0.87F, 0.4F, 0.0F, 6.6F));
    TEST_ASSERT_FALSE(lifts(0.85F, 0.4F, 0.0F, 6.6F));
    TEST_ASSERT_TRUE(lifts(1.30F, 1.0F, 0.0F, 6.6F));
    TEST_ASSERT_FALSE(lifts(1.28F, 1.0F, 0.0F, 6.6F)); /* three sigma behind the low-pass */
    TEST_ASSERT_TRUE(lifts(0.0F, 0.4F, 0.0321F, 4.91F));
    TEST_ASSERT_FALSE(lifts(0.0F, 0.4F, 0.0319F, 4.91F));
}

void test_an_acceleration_beyond_that_of_the_lightest_vehicle_is_noise(void)
{
    const float thrust_n = 5.5F + 0.86F / AUTHORITY; /* GRAV less 1.5 N, and what the threshold takes */

    TEST_ASSERT_TRUE(lifts(3.0F, 0.4F, 0.0F, thrust_n + 0.01F));
    TEST_ASSERT_FALSE(lifts(3.0F, 0.4F, 0.0F, thrust_n - 0.01F));
}

void test_without_accelerations_the_height_alone_shows_it(void)
{
    for (int high = 0; high < 2; high++) {
        setUp();
        stand();
        accelerations_come(false);
        ground_was_at_m(0.02F);
        estimated((high != 0) ? 0.0521F : 0.0519F, 0.0F, 0.0F);
        delivers_n(7.0F);
        (void)ramp_n();
        TEST_ASSERT_EQUAL(high != 0, flies);
    }
}

/* 30 steps of 0.1 s: the most that it gets to. */
static float most_n(void)
{
    float thrust_n = 0.0F;

    for (int i = 0; i < 30; i++) {
        pass(0.1F);
        thrust_n = ramp_n();
    }
    return thrust_n;
}

void test_the_ramp_grows_by_4_newtons_a_second_to_a_third_above_gravity(void)
{
    stand();
    pass(0.1F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 0.68F * 7.0F + 0.4F, ramp_n());
    pass(0.1F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 0.68F * 7.0F + 0.8F, ramp_n());
    NEAR(1.35F * 7.0F, most_n());
    NEAR(1.35F * 7.0F - 0.2F, step(EST_MODE_LAND, 0.0F)); /* 2 N/s down */
    for (int i = 0; i < 50; i++) {
        pass(0.1F);
        (void)step(EST_MODE_SINK, 0.0F);
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0F, step(EST_MODE_SINK, 0.0F));
}

/* A battery that has emptied needs more thrust in the next flight. */
void test_a_flight_leaves_its_hover_thrust_to_the_next_until_grav_changes(void)
{
    sure_hover_is_n(7.6F);
    stand();
    NEAR(9.6F, est.hover.most_n);
    NEAR(5.0F, est.hover.least_n);
    NEAR(7.0F, est.hover.thrust_n);
    NEAR(0.49F, est.hover.variance_n2);
    sure_hover_is_n(8.0F); /* on the ground: no flight */
    stand();
    NEAR(1.35F * 7.6F, most_n());
    set(PARAMETER_GRAV, 1.5F);
    stand();
    TEST_ASSERT_EQUAL_FLOAT(0.0F, est.hover.least_n);
    NEAR(3.5F, est.hover.most_n);
    NEAR(1.35F * 1.5F, most_n());
}

void test_the_limit_of_the_hover_thrust_follows_the_sure_one_upwards(void)
{
    sure_hover_is_n(8.5F);
    NEAR(9.0F, est.hover.most_n);
    sure_hover_is_n(9.5F);
    NEAR(10.0F, est.hover.most_n);
    sure_hover_is_n(7.0F);
    NEAR(10.0F, est.hover.most_n);
    NEAR(5.0F, est.hover.least_n);
}

void test_the_thrust_at_the_lift_off_is_the_first_hover_thrust(void)
{
    for (int sinks = 0; sinks < 2; sinks++) {
        setUp();
        stand();
        delivers_n(8.0F);
        lifts_at(1.0F);
        lifts_with(7.5F, (sinks != 0) ? -0.1F : 0.1F);
        (void)ramp_n();
        TEST_ASSERT_TRUE(flies);
        const float drag_mps2 = (sinks != 0) ? 0.0F : 2.5F * 0.1F; /* none of a vehicle on the ground */
        NEAR(7.5F - (1.0F + drag_mps2) / AUTHORITY, est.hover.thrust_n);
        NEAR(0.49F, est.hover.variance_n2);
        NEAR(5.0F, est.hover.least_n);
        NEAR(9.0F, est.hover.most_n);
    }
}

/* Felt for a second below the lift-off's threshold: the drag of that speed, which has decayed by a third,
 * takes from the first hover thrust. Before the ramp nothing is summed. */
void test_the_speed_of_the_lift_off_is_summed_on_the_ramp_alone(void)
{
    float hover_n[2];

    for (int ramps = 0; ramps < 2; ramps++) {
        setUp();
        stand();
        if (ramps != 0) {
            (void)ramp_n();
        }
        for (int i = 0; i < 40; i++) {
            estimated(0.5F, 0.0F, 0.0F);
            cycle(0.5F);
        }
        estimated(0.5F, 0.0F, 0.0F);
        delivers_n(8.0F);
        const float speed_mps = est.lift.up_mps;
        lifts_at(1.0F);
        lifts_with(8.0F, speed_mps);
        (void)ramp_n();
        TEST_ASSERT_TRUE(flies);
        hover_n[ramps] = est.hover.thrust_n;
    }
    NEAR(8.0F - 1.0F / AUTHORITY, hover_n[0]);
    const float drag_mps2 = 2.5F * 0.5F * (1.0F - expf(-1.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.02F, drag_mps2 / AUTHORITY, hover_n[0] - hover_n[1]);
}

void test_a_climb_rate_autopilot_hovers_in_the_middle_of_the_stick(void)
{
    for (int flown = 0; flown < 2; flown++) {
        setUp();
        set(PARAMETER_PLANT, PLANT_CLIMB);
        sure_hover_is_n(7.4F);
        airborne(flown != 0);
        stand();
        lifts_at(2.0F);
        delivers_n(8.0F);
        (void)ramp_n();
        NEAR((flown != 0) ? 7.4F : 7.0F, est.hover.thrust_n);
        NEAR((flown != 0) ? 0.49F : 0.0049F, est.hover.variance_n2);
        NEAR((flown != 0) ? 9.4F : 9.0F, est.hover.most_n);
    }
}

/* The thrust grows by 4 N/s: after t the vehicle has risen by a 4 t3 / 6. At 40 mm t is 0.22 s. */
void test_without_accelerations_the_height_tells_when_it_left_the_ground(void)
{
    stand();
    accelerations_come(false);
    estimated(0.54F, 0.0F, 0.0F);
    delivers_n(7.9F);
    height_was_s_ago(0.05F);
    const float jerk = 4.0F * AUTHORITY;
    const float t = cbrtf(6.0F * 0.04F / jerk) + 0.05F;
    (void)ramp_n();
    NEAR(7.9F - 4.0F * t, est.hover.thrust_n);
    NEAR(0.5F + jerk * t * t * t / 6.0F, est.estimator.now.height_m);
    NEAR(0.5F * jerk * t * t, est.estimator.now.speed_mps);
    NEAR(0.0F, est.estimator.now.bias_mps2);
}

/* ---- heights */

static void see(float height_m, bool at_rest)
{
    const altitude_t altitude = {.valid = true, .slant_mm = 1000.0F * height_m};
    before = est;
    const est_height_t height = {{&altitude, NULL, 0U, 0U}, 1000U, clock_us, 70000U};
    est_law_fuse_height(&est, &height, flies, at_rest);
}

void test_a_height_is_as_old_as_its_rays(void)
{
    see(0.5F, false);
    TEST_ASSERT_EQUAL_UINT32(T_US - 70000U, est.rays_us);
    accelerations_come(false);
    frame.has_acceleration = false;
    for (int i = 1; i <= 14; i++) { /* 0.33 s more make 0.4 */
        cycle(0.0F);
        TEST_ASSERT_EQUAL(i <= 13, est_law_ready(&est));
    }
}

void test_an_innovation_is_a_gust_as_far_as_the_model_has_weight(void)
{
    for (int why = 0; why < 4; why++) {
        setUp();
        cycle(0.0F);
        airborne(why != 1);
        accelerations_come(why != 2);
        see((why == 3) ? 0.9F : 0.51F, false);
        hover_t expected = before.hover;
        if (why == 0) {
            hover_nudge(&expected, -39.2F * share_against(0.84F) * est.estimator.innovation_m / AUTHORITY);
            TEST_ASSERT_TRUE(fabsf(expected.gust_n) > 0.01F);
        }
        TEST_ASSERT_FLOAT_WITHIN(2.0e-3F, expected.gust_n, est.hover.gust_n);
    }
}

void test_on_the_ramp_a_vehicle_that_does_not_accelerate_is_at_rest(void)
{
    static const struct {
        bool airborne, ramping;
        float lift_mps2, noise_mps2;
        bool rests;
    } rows[] = {{false, true, 0.85F, 0.4F, true}, {false, true, 0.87F, 0.4F, false},
                {true, true, 0.0F, 0.4F, false},  {false, false, 0.0F, 0.4F, false},
                {false, true, 1.28F, 1.0F, true}, {false, true, 1.30F, 1.0F, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        stand();
        noise_is_mps2(rows[i].noise_mps2);
        if (rows[i].ramping) {
            (void)ramp_n();
        }
        airborne(rows[i].airborne);
        lifts_at(rows[i].lift_mps2);
        estimated(0.5F, 0.1F, 0.0F);
        see(0.5F, false);
        TEST_ASSERT_EQUAL(rows[i].rests, est.estimator.now.speed_mps < 0.01F);
    }
    setUp();
    estimated(0.5F, 0.1F, 0.0F);
    see(0.5F, true);
    TEST_ASSERT_TRUE(est.estimator.now.speed_mps < 0.01F);
    setUp();
    stand();
    (void)ramp_n();
    disengage(); /* a pilot takes the throttle: it may fly */
    estimated(0.5F, 0.1F, 0.0F);
    see(0.5F, false);
    TEST_ASSERT_TRUE(est.estimator.now.speed_mps > 0.05F);
}

/* ---- taking over and giving back */

void test_an_engaged_law_starts_from_the_hover_thrust(void)
{
    disengage();
    gust_is_n(0.4F);
    engage(7.3F);
    NEAR(7.3F, est.hover.thrust_n);
    NEAR(0.25F, est.hover.variance_n2);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, est.hover.gust_n);
    engage(9.3F);
    NEAR(9.0F, est.hover.thrust_n);
    engage(4.3F);
    NEAR(5.0F, est.hover.thrust_n);
}

/* Without them the accelerometer's bias carries the estimate of a vehicle that stands away. A height is fresh
 * for 0.3 s, and its rays are a scan older. */
void test_on_the_ground_an_estimate_without_heights_stays_where_it_stood(void)
{
    for (int i = 0; i < 2; i++) {
        setUp();
        ground_was_at_m(0.02F);
        estimated(0.3F, -0.4F, 0.1F);
        height_was_s_ago((i == 0) ? 0.39F : 0.41F);
        reset();
        NEAR((i == 0) ? 0.3F : 0.02F, est.estimator.now.height_m);
        NEAR((i == 0) ? -0.4F : 0.0F, est.estimator.now.speed_mps);
        NEAR(0.1F, est.estimator.now.bias_mps2);
        NEAR((i == 0) ? 0.3F : 0.02F, est.lift.ground_m);
    }
}

/* What a landing, a doubt or the terrain of a flight has left counts no longer in the next. */
void test_a_reset_forgets_the_flight(void)
{
    float thrust_n[2];

    est_law_doubt(&est, &(est_doubts_t){.without_authority = true, .no_effect = true});
    reset();
    airborne(true);
    TEST_ASSERT_TRUE(model_share() > 0.01F);
    setUp();
    est_law_doubt(&est, &(est_doubts_t){.no_effect = true});
    reset();
    airborne(true);
    estimated(0.5F, 0.0F, 0.0F);
    cycle(1.0F);
    assert_learned(true);
    setUp();
    for (int k = 0; k < 10; k++) {
        pass_seeing(0.1F);
        estimated(0.02F, -0.5F, 0.0F);
        (void)step(EST_MODE_LAND, 0.0F);
    }
    reset();
    airborne(true);
    pass_seeing(0.1F);
    estimated(0.02F, -0.5F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 7.3F, step(EST_MODE_LAND, 0.0F));
    for (int i = 0; i < 2; i++) {
        setUp();
        set(PARAMETER_TERRAIN, TERRAIN_IGNORE);
        (void)step(EST_MODE_HOLD, 0.6F);
        terrain_rises(0.0F, (i == 0) ? 0.0F : 0.3F); /* it has landed on something else */
        reset();
        ground_was_at_m(0.3F);
        pass_seeing(0.1F);
        estimated(0.5F, 0.0F, 0.0F);
        thrust_n[i] = step(EST_MODE_HOLD, 0.6F);
        TEST_ASSERT_TRUE(flies);
    }
    NEAR(thrust_n[0], thrust_n[1]);
}

void test_a_thrust_without_authority_is_the_sure_one(void)
{
    gust_is_n(0.3F);
    sure_hover_is_n(7.5F);
    est_law_doubt(&est, &(est_doubts_t){.without_authority = false});
    NEAR(7.0F, est.hover.thrust_n);
    NEAR(0.3F, est.hover.gust_n);
    est_law_doubt(&est, &(est_doubts_t){.without_authority = true});
    NEAR(7.5F, est.hover.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, est.hover.gust_n);
    sure_hover_is_n(4.0F);
    est_law_doubt(&est, &(est_doubts_t){.without_authority = true});
    NEAR(5.0F, est.hover.thrust_n);
}

/* ---- flying */

/* What the cascade commands for this speed from the state at the instant when a command takes effect: 18.5 ms
 * from now, and the estimate is 23.6 ms old. The thrust until then is the mean of both instants. */
static float expected_n(float (*speed_of)(const cascade_state_t *))
{
    const estimate_t now = est.estimator.now;
    const float ahead_s = 0.0236F + 0.0185F;
    const cascade_vehicle_t vehicle = est_law_vehicle(&est, &parameters);
    const cascade_gains_t gains = {2.3F, 8.0F, 0.7F, 1.1F};
    actuator_t then = est.actuator;

    actuator_advance(&then, clock_us + 18500U);
    const float mean_n = 0.5F * (est.actuator.thrust_n + then.thrust_n) * vehicle.upright;
    const float mps2 = vehicle.authority_mps2_per_n * (mean_n - vehicle.need_n) - 2.5F * now.speed_mps;
    const cascade_state_t state = {
        .height_m = now.height_m + (now.speed_mps - now.terrain_mps + 0.5F * mps2 * ahead_s) * ahead_s,
        .speed_mps = now.speed_mps + mps2 * ahead_s,
        .terrain_mps = now.terrain_mps,
        .thrust_n = then.thrust_n};
    return cascade_thrust_n(&gains, &vehicle, &state, speed_of(&state));
}

static float to_0_6_m(const cascade_state_t *state)
{
    const cascade_gains_t gains = {2.3F, 8.0F, 0.7F, 1.1F};
    return cascade_speed_to(&gains, state, 0.6F);
}

static float landing(const cascade_state_t *state)
{
    return -(0.15F + 0.25F * state->height_m);
}

static float landing_at_most(const cascade_state_t *state)
{
    (void)state;
    return -0.3F;
}

static float sinking(const cascade_state_t *state)
{
    (void)state;
    return -0.3F;
}

static void move_somehow(float height_m, float speed_mps)
{
    setUp();
    command_n(7.6F);
    pass_seeing(0.1F);
    command_n(7.3F); /* takes effect within the delay */
    estimated(height_m, speed_mps, 0.0F);
    terrain_rises(0.1F, 0.0F);
    upright_is(0.97F);
    gust_is_n(0.2F);
}

static void assert_commands(float expected, est_mode_t mode)
{
    NEAR(expected, step(mode, 0.6F));
}

void test_the_command_is_the_cascades_from_the_state_that_it_will_meet(void)
{
    move_somehow(0.5F, 0.15F);
    assert_commands(expected_n(to_0_6_m), EST_MODE_HOLD);
}

void test_a_landing_slows_down_towards_the_ground(void)
{
    move_somehow(0.5F, 0.15F);
    assert_commands(expected_n(landing), EST_MODE_LAND);
    move_somehow(2.0F, 0.15F);
    assert_commands(expected_n(landing_at_most), EST_MODE_LAND);
}

void test_a_descent_without_heights_has_one_speed(void)
{
    move_somehow(0.5F, -0.3F);
    assert_commands(expected_n(sinking), EST_MODE_SINK);
    move_somehow(6.0F, -0.3F);
    assert_commands(expected_n(sinking), EST_MODE_SINK);
}

/* One step of half a second whose cascade wants much more, or much less. */
static float descend(est_mode_t mode, bool wants_more)
{
    pass_seeing(0.5F);
    estimated(0.5F, wants_more ? -0.8F : 2.0F, 0.0F);
    gust_is_n(wants_more ? 0.4F : 0.0F);
    return step(mode, 0.5F);
}

void test_the_ceiling_of_a_descent_starts_above_the_entrys_hover_thrust_and_falls(void)
{
    NEAR(8.5F, descend(EST_MODE_LAND, true));
    sure_hover_n = 8.0F;                      /* learned since: it is not the entry's */
    NEAR(8.4F, descend(EST_MODE_LAND, true)); /* 0.2 N/s */
    NEAR(7.5F, descend(EST_MODE_SINK, true));
    NEAR(7.4F, descend(EST_MODE_SINK, true)); /* 0.2 N/s */
    NEAR(7.3F, descend(EST_MODE_LAND, true)); /* and never rises again */
    NEAR(7.3F, descend(EST_MODE_HOLD, true)); /* nor falls while it holds */
    for (int i = 0; i < 200; i++) {
        (void)descend(EST_MODE_LAND, true);
    }
    TEST_ASSERT_EQUAL_FLOAT(0.0F, descend(EST_MODE_LAND, true));
    sure_hover_is_n(7.2F); /* the descent is over */
    NEAR(8.7F, descend(EST_MODE_LAND, true));
    reset(); /* and so it is on the ground */
    engage(GRAV_N);
    NEAR(8.7F, descend(EST_MODE_LAND, true));
}

void test_without_heights_the_thrust_is_not_cut_too_far(void)
{
    NEAR(6.5F, descend(EST_MODE_SINK, false)); /* 0.5 N below the entry's */
    setUp();
    TEST_ASSERT_TRUE(descend(EST_MODE_LAND, false) < 5.6F);
    setUp();
    hover_init(&est.hover, 1.0F, 0.1F, 0.0F, 9.0F);
    sure_hover_is_n(1.0F);
    NEAR(1.0F - 3.96F / G_MPS2, descend(EST_MODE_SINK, false)); /* the cascade's own limit, 0.4 g */
}

/* A step of 0.1 s near the ground, of a vehicle that falls: the cascade wants more than may be. */
static float touch_n(est_mode_t mode)
{
    pass_seeing(0.1F);
    estimated(0.02F, -0.5F, 0.0F);
    engage(GRAV_N);
    return step(mode, 0.0F);
}

void test_the_end_of_a_landing_fades_the_thrust_out_by_two_newtons_a_second(void)
{
    float limit_n[12];

    for (int i = 0; i < 12; i++) {
        pass_seeing(0.1F);
        estimated(0.02F, -0.5F, 0.0F);
        limit_n[i] = step(EST_MODE_LAND, 0.0F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 7.0F + 0.5F - 2.0F * 0.6F, limit_n[5]);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, -0.2F, limit_n[6] - limit_n[5]);
    est_law_doubt(&est, &(est_doubts_t){.rocks = true}); /* it is in the air yet: a tenth */
    pass_seeing(0.1F);
    estimated(0.02F, -0.5F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, limit_n[11] - 0.02F, step(EST_MODE_LAND, 0.0F));
}

void test_the_end_of_a_landing_is_forgotten_in_another_mode_and_when_the_law_takes_over(void)
{
    static const est_mode_t others[] = {EST_MODE_SINK, EST_MODE_HOLD};

    for (int i = 0; i < 3; i++) {
        setUp();
        for (int k = 0; k < 10; k++) {
            pass_seeing(0.1F);
            estimated(0.02F, -0.5F, 0.0F);
            (void)step(EST_MODE_LAND, 0.0F);
        }
        if (i < 2) {
            (void)step(others[i], 0.6F);
        }
        NEAR(7.3F, touch_n(EST_MODE_LAND)); /* after 0.1 s of it */
    }
}

/* ---- terrain that is passed over */

static float hold_n(float reference_m)
{
    engage(GRAV_N);
    pass_seeing(0.1F);
    estimated(0.5F, 0.0F, 0.0F);
    return step(EST_MODE_HOLD, reference_m);
}

/* The same while the law goes on. */
static float go_on_n(float height_m, float reference_m)
{
    estimated(height_m, 0.0F, 0.0F);
    return step(EST_MODE_HOLD, reference_m);
}

void test_ignored_terrain_moves_the_setpoint_by_its_height(void)
{
    static const float heights_m[] = {0.50F, 0.45F};
    float thrust_n[2][2];

    for (int terrain = 0; terrain < 2; terrain++) { /* followed, ignored */
        for (int rises = 0; rises < 2; rises++) {
            setUp();
            set(PARAMETER_TERRAIN, (terrain != 0) ? (float)TERRAIN_IGNORE : (float)TERRAIN_FOLLOW);
            (void)hold_n(0.60F); /* counts from the terrain of now */
            engage(GRAV_N);
            terrain_rises(0.0F, 0.0F);
            (void)go_on_n(0.5F, 0.60F);
            setUp();
            set(PARAMETER_TERRAIN, (terrain != 0) ? (float)TERRAIN_IGNORE : (float)TERRAIN_FOLLOW);
            (void)hold_n(0.60F);
            terrain_rises(0.0F, (rises != 0) ? 0.05F : 0.0F);
            thrust_n[terrain][rises] = go_on_n(heights_m[rises], 0.60F);
        }
    }
    TEST_ASSERT_TRUE(thrust_n[0][1] > thrust_n[0][0] + 0.1F); /* 5 cm lower over the terrain: it climbs */
    TEST_ASSERT_FLOAT_WITHIN(0.01F, thrust_n[1][0], thrust_n[1][1]); /* it stays as high as it was */
}

void test_ignored_terrain_is_forgotten_within_30_seconds_and_by_a_new_reference(void)
{
    float thrust_n[3];

    for (int i = 0; i < 3; i++) {
        setUp();
        set(PARAMETER_TERRAIN, TERRAIN_IGNORE);
        (void)hold_n(0.60F);
        terrain_rises(0.0F, 0.05F);
        for (int k = 0; k < ((i == 1) ? 1200 : 1); k++) { /* 120 s */
            pass_seeing(0.1F);
            (void)go_on_n(0.45F, 0.60F);
        }
        sure_hover_is_n(GRAV_N);
        delivers_n(GRAV_N);
        for (int k = 0; k < 40; k++) { /* until no slew is left */
            pass_seeing(0.025F);
            delivers_n(GRAV_N);
            thrust_n[i] = go_on_n(0.45F, (i == 2) ? 0.601F : 0.60F);
        }
    }
    TEST_ASSERT_TRUE(thrust_n[1] > thrust_n[0] + 0.3F); /* now it climbs to its height over the terrain */
    TEST_ASSERT_TRUE(thrust_n[2] > thrust_n[0] + 0.3F);
}

void test_fifteen_centimetres_over_the_terrain_are_kept(void)
{
    float thrust_n[2];

    for (int i = 0; i < 2; i++) {
        setUp();
        set(PARAMETER_TERRAIN, (i == 0) ? (float)TERRAIN_FOLLOW : (float)TERRAIN_IGNORE);
        (void)hold_n((i == 0) ? 0.15F : 0.60F);
        terrain_rises(0.0F, (i == 0) ? 0.0F : 0.9F);
        for (int k = 0; k < 40; k++) { /* until no slew is left */
            pass_seeing(0.025F);
            delivers_n(GRAV_N);
            est_hovers_at_n(GRAV_N);
            gust_is_n(0.0F);
            thrust_n[i] = go_on_n(0.2F, (i == 0) ? 0.15F : 0.60F);
        }
    }
    NEAR(thrust_n[0], thrust_n[1]);
}

/* The heights shrink by 0.5 m/s. The estimated speed is 0, so the ground rises, or that speed is wrong. */
void test_near_ground_that_seems_to_rise_an_ignoring_vehicle_is_braked_and_high_above_it_is_not(void)
{
    for (float height_m = 0.2F; height_m < 0.9F; height_m += 0.3F) {
        float thrust_n[2];

        for (int rises = 0; rises < 2; rises++) {
            setUp();
            set(PARAMETER_TERRAIN, TERRAIN_IGNORE);
            (void)hold_n(0.90F);
            terrain_rises(0.0F, 0.9F - height_m);
            ground_rose_mps((rises != 0) ? 0.5F : 0.0F);
            thrust_n[rises] = go_on_n(height_m, 0.90F);
        }
        if (height_m < 0.3F) {
            TEST_ASSERT_TRUE(thrust_n[1] > thrust_n[0] + 1.0F);
        } else {
            NEAR(thrust_n[0], thrust_n[1]);
        }
    }
}

/* What the ground has done before the heights went is no rate any more: it lifted a vehicle by 0.4 m. */
void test_without_fresh_heights_no_rate_of_the_ground_lifts_an_ignoring_vehicle(void)
{
    float thrust_n[2];

    for (int rises = 0; rises < 2; rises++) {
        setUp();
        set(PARAMETER_TERRAIN, TERRAIN_IGNORE);
        (void)hold_n(0.90F);
        terrain_rises(0.0F, 0.5F);
        ground_rose_mps((rises != 0) ? 0.5F : 0.0F);
        height_was_s_ago(0.35F);
        thrust_n[rises] = go_on_n(0.3F, 0.90F);
    }
    NEAR(thrust_n[0], thrust_n[1]);
}

/* ---- commands */

void test_a_command_takes_effect_after_the_delay_and_beyond_the_deadband(void)
{
    set(PARAMETER_PLANT, PLANT_CLIMB);
    set(PARAMETER_DELAY, 0.03F);
    pass(0.0F);
    band_is_n(0.2F);
    command_n(7.5F);
    actuator_t told = est.actuator;
    actuator_advance(&told, clock_us + 30000U);
    NEAR(GRAV_N, told.thrust_n);
    actuator_advance(&told, clock_us + 3000000U);
    NEAR(7.3F, told.thrust_n);
}

void test_the_deadband_is_compensated(void)
{
    move_somehow(0.5F, 0.15F);
    set(PARAMETER_PLANT, PLANT_CLIMB);
    const est_law_t start = est;
    const float without_n = step(EST_MODE_HOLD, 0.9F);
    est = start;
    band_is_n(0.2F);
    NEAR(deadband_compensate(&est.deadband, 7.0F, without_n), step(EST_MODE_HOLD, 0.9F));
}

/* ---- frames that are missing */

/* The next heights tell the speed alone, without a test. */
void test_a_height_without_frames_for_250_ms_forgets_the_latest_one(void)
{
    for (int late = 0; late < 2; late++) {
        setUp();
        frame_was_s_ago((late != 0) ? 0.251F : 0.249F);
        see(0.5F, false);
        TEST_ASSERT_EQUAL(late != 0, est.estimator.unchecked_count > 0U);
    }
}

void test_a_gust_is_forgotten_while_no_height_confirms_the_speed(void)
{
    height_was_s_ago(0.28F);
    gust_is_n(0.4F);
    cycle(0.0F);
    NEAR(0.4F * (1.0F - 0.025F / 0.76F), est.hover.gust_n);
}
