#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_the_felt_speed_is_the_integral_of_the_acceleration_without_the_bias(void)
{
    feel(0.0F);
    bias_is_mps2(0.5F);
    felt_is((witness_t){0});
    feel(2.0F); /* trapezium: 1 m/s2 on the mean */
    NEAR((1.0F - 0.5F) * 0.025F, senses.accelerometer.felt.speed_mps);
    VERY_NEAR(-0.5F * 0.5F * 0.025F * 0.025F, senses.accelerometer.felt.off_m);
    for (int i = 0; i < 39; i++) {
        feel(2.0F);
    }
    NEAR(0.0125F + 39.0F * 0.025F * 1.5F, senses.accelerometer.felt.speed_mps);
    NEAR(1.0F, senses.accelerometer.felt.running_s);
    /* v t + a t2 / 2 over the 0.975 s after the first step, and that step */
    TEST_ASSERT_FLOAT_WITHIN(0.001F, -0.01219F - 0.71297F - 0.00016F, senses.accelerometer.felt.off_m);
    for (int i = 0; i < 50; i++) {
        feel(-3.0F);
    }
    TEST_ASSERT_EQUAL_FLOAT(2.0F, senses.accelerometer.felt.running_s);
}

void test_frames_that_are_old_unfit_not_ready_or_without_accelerations_add_nothing(void)
{
    feel(0.0F);
    feel(1.0F);
    const witness_t before = senses.accelerometer.felt;
    sensed_frames(&flown, &frame, 1U);
    TEST_ASSERT_EQUAL_FLOAT(before.speed_mps, senses.accelerometer.felt.speed_mps);
    senses.tilt.unfit_sequence = 3U;
    feel(1.0F);
    TEST_ASSERT_EQUAL_FLOAT(before.speed_mps, senses.accelerometer.felt.speed_mps);
    frame.ready = false;
    feel(1.0F);
    frame.ready = true;
    frame.has_acceleration = false;
    feel(1.0F);
    frame.has_acceleration = true;
    feel(200.1F);
    feel(-200.1F);
    feel(NAN);
    TEST_ASSERT_EQUAL_FLOAT(before.speed_mps, senses.accelerometer.felt.speed_mps);
    TEST_ASSERT_EQUAL_UINT32(5U,
                             senses.accelerometer.sequence); /* that without accelerations told the tilt */
    feel(199.0F);
    TEST_ASSERT_EQUAL_UINT32(9U, senses.accelerometer.sequence);
    NEAR(before.speed_mps + 100.0F * 0.175F, senses.accelerometer.felt.speed_mps);
}

void test_after_twelve_lost_frames_the_felt_speed_starts_from_the_thrusts(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        for (int warm = 0; warm < 2; warm++) {
            setUp();
            feel(0.0F);
            feel(1.0F);
            senses.push.pushed = (witness_t){.speed_mps = 0.7F, .running_s = (warm != 0) ? 0.51F : 0.5F};
            has_rested_s((float)more_us);
            frame.arrival_us += 275000U + more_us;
            feel(2.0F);
            if (more_us == 0U) {
                NEAR(0.0125F + 1.5F * 0.3F, senses.accelerometer.felt.speed_mps);
            } else {
                TEST_ASSERT_EQUAL_FLOAT((warm != 0) ? 0.7F : 0.0F, senses.accelerometer.felt.speed_mps);
                TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.running_s);
                TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.rested_s);
                NEAR(2.0F, senses.accelerometer.rest_mps2);
            }
        }
    }
}

void test_at_rest_the_mean_is_the_bias_of_the_last_two_seconds(void)
{
    flown.grounded = true;
    feel(0.0F);
    has_rested_s(0.0F);
    rests_at_mps2(0.0F);
    feel(0.4F);
    NEAR(0.4F, senses.accelerometer.bias_mps2);
    feel(0.8F);
    NEAR(0.6F, senses.accelerometer.bias_mps2);
    NEAR(0.6F, senses.accelerometer.rest_mps2);
    NEAR(0.05F, senses.accelerometer.rested_s);
    has_rested_s(2.0F);
    feel(1.0F);
    TEST_ASSERT_EQUAL_FLOAT(2.0F, senses.accelerometer.rested_s);
    NEAR(0.6F + 0.4F * 0.025F / 2.0F, senses.accelerometer.rest_mps2);
    senses.accelerometer.felt.speed_mps = 1.0F;
    feel(1.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.speed_mps);
}

/* One frame at rest, whose mean is then rest_mps2. */
static uint16_t rested(uint16_t doubts, float rested_s, float rest_mps2)
{
    setUp();
    flown.grounded = true;
    doubted(doubts);
    senses.accelerometer.time_us = frame.arrival_us;
    has_rested_s(rested_s);
    rests_at_mps2(rest_mps2);
    feel(rest_mps2);
    return verdict.doubts;
}

/* A pilot's flight without heights looks like a rest for some frames. One of them, 1.5 m/s2, was the bias of
 * a flight that then climbed for 20 s, 55 m high. */
void test_a_moment_of_rest_tells_no_bias_once_a_whole_one_has(void)
{
    flown.grounded = true;
    feel(0.3F);
    NEAR(0.3F, senses.accelerometer.bias_mps2); /* better than none */
    for (int i = 0; i < 400; i++) {
        feel(0.1F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.1F, senses.accelerometer.bias_mps2);
    flown.grounded = false;
    feel(0.1F);
    flown.grounded = true;
    for (int i = 0; i < 40; i++) { /* 1.0 s */
        feel(1.5F);
        TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.1F, senses.accelerometer.bias_mps2);
    }
    feel(1.5F);
    feel(1.5F);
    NEAR(1.5F, senses.accelerometer.bias_mps2);
}

void test_an_unfit_accelerometer_is_one_and_a_half_off_for_a_second(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, rested(0U, 1.0F, 1.51F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, rested(0U, 1.0F, -1.51F));
    TEST_ASSERT_EQUAL_UINT16(0U, rested(0U, 1.0F, 1.49F));
    TEST_ASSERT_EQUAL_UINT16(0U, rested(0U, 0.97F, 1.51F));
    TEST_ASSERT_EQUAL_UINT16(0U, rested(DOUBT_IMU, 1.0F, 1.19F));
    TEST_ASSERT_EQUAL_UINT16(0U, rested(DOUBT_IMU, 1.0F, -1.19F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, rested(DOUBT_IMU, 1.0F, 1.21F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, rested(DOUBT_IMU, 0.97F, 1.19F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, rested(DOUBT_SIGHT | DOUBT_IMU, 1.0F, 0.0F));
}

/* Heights that stand, and an accelerometer that tells this all the time. */
static bool is_beyond_after_s(float lie_mps2, float time_s)
{
    accelerometer_t told;

    memset(&told, 0, sizeof told);
    for (int k = 0; k < (int)(time_s / 0.025F + 0.5F); k++) {
        accelerometer_move(&told, lie_mps2, false, 0.025F);
        if (k % 4 == 3) {
            accelerometer_compare(&told, 0.0F, 0.1F, 0.07F, true);
        }
    }
    TEST_ASSERT_TRUE(fabsf(told.bias_mps2) <= 1.5F);
    return accelerometer_is_beyond(&told);
}

void test_in_the_air_an_accelerometer_is_beyond_when_no_bias_explains_it(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        TEST_ASSERT_TRUE(is_beyond_after_s(2.3F * (float)sign, 12.0F));
        TEST_ASSERT_FALSE(is_beyond_after_s(2.3F * (float)sign, 1.0F));
        TEST_ASSERT_FALSE(is_beyond_after_s(1.2F * (float)sign, 600.0F));
    }
}

void test_rest_ends_what_was_beyond(void)
{
    accelerometer_t told = {.beyond_s = 2.0F};

    accelerometer_rest(&told, 0.025F);
    TEST_ASSERT_FALSE(accelerometer_is_beyond(&told));
}

void test_a_pilot_that_lifts_the_vehicle_spoils_the_rest(void)
{
    for (int standing = 0; standing < 2; standing++) {
        setUp();
        feel(0.0F);
        has_rested_s(1.0F);
        bias_is_mps2(0.3F);
        rises_mps(0.2F);
        senses.accelerometer.felt.off_m = 0.1F;
        flown.standing = standing != 0;
        feel(0.0F);
        TEST_ASSERT_EQUAL_FLOAT((standing != 0) ? 0.3F : 0.0F, senses.accelerometer.bias_mps2);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.rested_s);
        if (standing == 0) {
            NEAR(0.2F, senses.accelerometer.felt.speed_mps);
            rises_mps(5.0F);
            feel(0.0F);
            NEAR(0.2F, senses.accelerometer.felt.speed_mps);
        }
    }
}

void test_while_standing_the_felt_speed_dies_within_a_second_and_does_not_count(void)
{
    flown.standing = true;
    feel(0.0F);
    senses.accelerometer.felt.speed_mps = 1.0F;
    senses.accelerometer.felt.running_s = 2.0F;
    feel(0.0F);
    NEAR(0.975F, senses.accelerometer.felt.speed_mps);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.running_s);
}

void test_a_limit_at_rest_belongs_to_the_state_before(void)
{
    static const struct {
        uint16_t doubts;
        float rested_s, rest_mps2;
        uint16_t then;
    } rows[] = {{0U, 1.0F, 2.0F, 0U},
                {0U, 1.5F, 1.5F, 0U},
                {DOUBT_IMU, 1.0F, 0.5F, DOUBT_IMU},
                {DOUBT_IMU, 1.5F, 1.2F, DOUBT_IMU}};
    for (int i = 0; i < 4; i++) {
        setUp();
        flown.grounded = true;
        feel(0.0F);
        doubted(rows[i].doubts);
        has_rested_s(rows[i].rested_s);
        rests_at_mps2(rows[i].rest_mps2);
        feel_at_once(rows[i].rest_mps2);
        TEST_ASSERT_EQUAL_UINT16(rows[i].then, verdict.doubts);
    }
}

/* On the ground without a height, and the tilt sways as in the air. */
static void carry(float unseen_s, float sway_rad2)
{
    setUp();
    flown.grounded = true;
    feel(0.0F);
    senses.mirrors.unseen_s = unseen_s;
    senses.sway.sway_rad2 = sway_rad2;
    unrocked_for_s(0.0F);
    in_hands_for_s(0.5F);
    has_rested_s(1.0F);
    rests_at_mps2(0.3F);
    bias_is_mps2(0.3F);
    senses.accelerometer.kept_bias_mps2[0] = 0.1F;
    senses.accelerometer.kept_bias_mps2[1] = 0.2F;
    senses.accelerometer.felt.speed_mps = 0.4F;
}

void test_a_vehicle_that_sways_without_heights_is_carried_and_does_not_rest(void)
{
    carry(1.51F, 5.0e-4F);
    feel(2.0F); /* on the mean 1 m/s2 */
    NEAR(0.525F, senses.accelerometer.in_hands_s);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.rested_s);
    NEAR(0.4F + 0.9F * 0.025F - 0.4F * 0.025F / 2.0F, senses.accelerometer.felt.speed_mps);
    VERY_NEAR(0.1F + 0.9F * 0.025F / 20.0F, senses.accelerometer.bias_mps2); /* the one kept from before */
    feel(2.0F);
    VERY_NEAR(0.1F + 0.9F * 0.025F / 20.0F + (2.0F - 0.101125F) * 0.025F / 20.0F,
              senses.accelerometer.bias_mps2);
    carry(1.49F, 5.0e-4F);
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.in_hands_s);
    NEAR(1.025F, senses.accelerometer.rested_s);
    carry(1.9F, 3.9e-4F);
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.in_hands_s);
}

void test_who_tilts_it_by_hand_does_not_fly_it(void)
{
    carry(1.9F, 0.0121F);
    feel(0.0F);
    NEAR(0.525F, senses.accelerometer.in_hands_s); /* a 60th of the sway is forgotten with each frame */
    carry(1.9F, 0.0123F);
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.in_hands_s);
    in_hands_for_s(1.5F);
    TEST_ASSERT_FALSE(accelerometer_is_in_hands(&senses.accelerometer));
    in_hands_for_s(1.51F);
    TEST_ASSERT_TRUE(accelerometer_is_in_hands(&senses.accelerometer));
    carry(1.9F, 5.0e-4F);
    in_hands_for_s(1.99F);
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(2.0F, senses.accelerometer.in_hands_s);
}

void test_the_bias_of_three_to_four_seconds_ago_is_kept(void)
{
    carry(0.0F, 0.0F);
    senses.accelerometer.block_s = 0.97F;
    feel(0.3F);
    NEAR(0.995F, senses.accelerometer.block_s);
    NEAR(0.1F, senses.accelerometer.kept_bias_mps2[0]);
    feel(0.3F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.block_s);
    NEAR(0.2F, senses.accelerometer.kept_bias_mps2[0]);
    NEAR(0.0F, senses.accelerometer.kept_bias_mps2[2]);
    NEAR(0.3F, senses.accelerometer.kept_bias_mps2[3]);
}
