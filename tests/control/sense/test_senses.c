#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_the_pushed_speed_waits_on_the_ground_and_starts_at_the_felt_one(void)
{
    static const struct {
        bool off_ground, grounded, has_height, felt_counts, doubted;
        float height_m, sway_rad2, speed_mps;
        bool waits;
    } rows[] = {
        {true, false, true, true, false, 0.091F, 0.0F, 0.0F, false},
        {true, false, true, true, false, 0.09F, 0.0F, 0.0F, false},
        {true, false, true, true, false, 0.089F, 0.0F, 0.6F, true},
        {true, false, true, true, false, 0.089F, 4.1e-4F, 0.0F, false},
        {true, false, false, true, false, 0.089F, 0.0F, 0.0F, false},
        {false, false, true, true, false, 0.5F, 0.0F, 0.6F, true},
        {false, true, true, true, false, 0.5F, 0.0F, 0.0F, true},
        {false, false, true, false, false, 0.5F, 0.0F, 0.0F, true},
        {false, false, true, true, true, 0.5F, 0.0F, 0.0F, true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        flown.off_ground = rows[i].off_ground;
        flown.grounded = rows[i].grounded;
        senses.heights.known = rows[i].has_height;
        at_m(rows[i].height_m);
        sways_rad2(rows[i].sway_rad2);
        doubted(rows[i].doubted ? DOUBT_IMU : 0U);
        senses.accelerometer.felt = (witness_t){.speed_mps = 0.6F,
                                                .running_s = rows[i].felt_counts ? 0.51F : 0.5F};
        senses.push.pushed = (witness_t){.speed_mps = 0.0F, .off_m = 0.3F, .running_s = 1.0F};
        sensed_thrust(&flown);
        TEST_ASSERT_EQUAL_FLOAT(rows[i].speed_mps, senses.push.pushed.speed_mps);
        NEAR(rows[i].waits ? 0.0F : 1.025F, senses.push.pushed.running_s);
        NEAR(rows[i].waits ? 0.0F : 0.3F, senses.push.pushed.off_m);
    }
}

void test_standing_is_the_ground_or_a_take_off_that_has_not_left_it(void)
{
    for (int i = 0; i < 4; i++) {
        flown.grounded = (i & 1) != 0;
        flown.standing = (i & 2) != 0;
        sensed_thrust(&flown);
        TEST_ASSERT_EQUAL(i != 0, senses.standing);
    }
}

void test_noise_beyond_twice_the_usual_shakes_with_the_power_of_one_and_a_half(void)
{
    static const float rows[][2] = {{0.2F, 1.0F}, {0.9F, 1.0F}, {1.8F, 2.82843F}, {3.6F, 8.0F}};
    for (int i = 0; i < 4; i++) {
        flown.noise_mps2 = rows[i][0];
        sensed_thrust(&flown);
        NEAR(rows[i][1], senses.accelerometer.shaken);
    }
}

void test_a_new_order_on_the_ground_forgets_and_one_in_the_air_does_not(void)
{
    for (int grounded = 0; grounded < 2; grounded++) {
        setUp();
        flown.ordered = true;
        flown.grounded = grounded != 0;
        doubted(DOUBT_SIGHT | DOUBT_IMU | DOUBT_THRUST);
        senses.accelerometer.felt.seen_m = senses.accelerometer.felt.off_m = verdict.contrary_s = 0.4F;
        sensed_thrust(&flown);
        TEST_ASSERT_EQUAL_UINT16((grounded != 0) ? DOUBT_IMU : 7U, verdict.doubts);
        TEST_ASSERT_EQUAL_FLOAT((grounded != 0) ? 0.0F : 0.4F, senses.accelerometer.felt.seen_m);
        TEST_ASSERT_EQUAL_FLOAT((grounded != 0) ? 0.0F : 0.4F, senses.accelerometer.felt.off_m);
        TEST_ASSERT_EQUAL_FLOAT((grounded != 0) ? 0.0F : 0.4F, verdict.contrary_s);
    }
}

void test_the_felt_speed_is_none_in_doubt_and_less_when_it_is_noisy(void)
{
    senses.accelerometer.felt = (witness_t){.speed_mps = 0.4F, .running_s = 0.51F};
    NEAR(0.4F, sensed_felt_mps());
    doubted(DOUBT_IMU);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, sensed_felt_mps());
    doubted(0U);
    shaken_by(2.0F);
    NEAR(0.2F, sensed_felt_mps());
    senses.accelerometer.felt.running_s = 0.5F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, sensed_felt_mps());
}

void test_each_of_several_frames_counts(void)
{
    imu_sample_t frames[3];
    feel(0.0F);
    for (uint32_t i = 0U; i < 3U; i++) {
        frames[i] = frame;
        frames[i].sequence += i + 1U;
        frames[i].arrival_us += 25000U * (i + 1U);
        frames[i].down_mps2 = G_MPS2 + 1.0F;
    }
    sensed_frames(&flown, frames, 3U);
    NEAR(0.0625F, senses.accelerometer.felt.speed_mps);
    TEST_ASSERT_EQUAL_UINT32(4U, senses.accelerometer.sequence);
    for (int i = 0; i < 3; i++) {
        frames[i].level.roll_rad = frames[i].median.roll_rad = 0.8F;
    }
    tilt_step(&senses.tilt, frames, 3U, 0.0F, 0.0F, 0U);
    TEST_ASSERT_EQUAL_UINT16(3U, senses.tilt.tilted);
    TEST_ASSERT_EQUAL_UINT32(4U, senses.tilt.sequence);
}

/* The belief is told what the frames and the thrust say of the motion, in the air and on the ground. */
void test_frames_tell_the_belief_a_change_of_speed_less_the_bias(void)
{
    for (int grounded = 0; grounded < 2; grounded++) {
        setUp();
        flown.grounded = grounded != 0;
        bias_is_mps2(0.25F);
        feel(1.0F);
        const float before_mps = senses.mirrors.felt.gained;
        const float bias_mps2 = senses.accelerometer.bias_mps2;
        feel(1.0F);
        NEAR((1.0F - bias_mps2) * 0.025F, senses.mirrors.felt.gained - before_mps);
    }
}

/* A pilot lifts it off in state GROUND: its acceleration is no bias, and not that of the firmware's thrust.
 * Taken for a bias, a third of the motion was missing, and the belief doubted the accelerometer. */
void test_what_somebody_lifts_in_state_ground_is_not_at_rest(void)
{
    flown.grounded = true;
    flown.off_ground = false;
    for (int i = 0; i < 400; i++) { /* ten seconds at rest, with a bias */
        feel(-0.2F);
    }
    NEAR(-0.2F, senses.accelerometer.bias_mps2);
    height(0.0F);
    sensed_thrust(&flown);
    VERY_NEAR(0.0F, senses.mirrors.undelivered.gained);
    stirs(true);
    at_m(0.5F);
    for (int i = 0; i < 40; i++) {
        feel(2.8F);
    }
    NEAR(-0.2F, senses.accelerometer.bias_mps2);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 3.0F, senses.accelerometer.felt.speed_mps);
    sensed_thrust(&flown);
    NEAR(G_MPS2 * 0.025F, senses.mirrors.undelivered.gained);
    VERY_NEAR(0.0F, senses.mirrors.pushed.gained);
    at_m(0.08F); /* a foot below the mirror */
    for (int i = 0; i < 80; i++) {
        feel(0.1F);
    }
    NEAR(0.1F, senses.accelerometer.bias_mps2);
}

void test_the_thrust_tells_the_belief_its_motion_where_it_alone_carries_the_vehicle(void)
{
    static const struct {
        bool off_ground;
        float height_m, gained_mps, dragged;
    } rows[] = {
        {true, 0.5F, 1.4F * 0.025F, 2.5F * 0.025F}, {false, 0.5F, 0.0F, 0.0F}, {true, 0.08F, 0.0F, 0.0F}};

    for (int i = 0; i < 3; i++) {
        hover();
        flown.damping_per_s = 2.5F;
        flown.off_ground = rows[i].off_ground;
        flown.hover_n = 6.0F;
        flown.thrust_n = 7.0F;
        pushes_n(7.0F);
        at_m(rows[i].height_m);
        sensed_thrust(&flown);
        NEAR(rows[i].gained_mps, senses.mirrors.pushed.gained);
        NEAR(rows[i].dragged, senses.mirrors.dragged.gained);
    }
}
