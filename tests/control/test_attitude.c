#include "control/attitude.h"
#include "unity.h"

#include <math.h>

static attitude_filter_t filter;
static attitude_t level, median;

static bool step(float roll, float pitch, float yaw)
{
    const attitude_t raw = {roll, pitch, yaw};
    return attitude_step(&filter, &raw, &level, &median);
}

static void learn(float roll, float pitch)
{
    for (unsigned i = 0; i < ATTITUDE_OFFSET_FRAMES; i++) {
        TEST_ASSERT_FALSE(step(roll, pitch, 1.0F));
    }
}

void setUp(void)
{
    attitude_init(&filter);
    level = median = (attitude_t){9.0F, 9.0F, 9.0F};
}

void tearDown(void) {}

void test_nothing_is_given_before_the_offset_is_known(void)
{
    TEST_ASSERT_FALSE(step(0.1F, 0.2F, 0.3F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, level.roll_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, level.yaw_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, median.roll_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, median.pitch_rad);
    TEST_ASSERT_FALSE(filter.ready);
}

void test_twenty_frames_make_the_offset_and_the_next_is_the_first_to_use_it(void)
{
    for (unsigned i = 0; i < 19; i++) {
        TEST_ASSERT_FALSE(step(0.05F, -0.03F, 2.0F));
        TEST_ASSERT_FALSE(filter.ready);
    }
    TEST_ASSERT_FALSE(step(0.05F, -0.03F, 2.0F));
    TEST_ASSERT_TRUE(filter.ready);
    TEST_ASSERT_TRUE(step(0.06F, -0.05F, 2.5F));
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.01F, level.roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, -0.02F, level.pitch_rad);
}

void test_the_offset_is_the_mean_of_its_frames(void)
{
    for (int i = 0; i < 20; i++) {
        (void)step(0.001F * (float)i, (i % 2 == 0) ? 0.1F : -0.1F, 0.0F);
    }
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.0095F, filter.offset.roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.0F, filter.offset.pitch_rad);
}

void test_yaw_keeps_its_offset_at_zero(void)
{
    learn(0.0F, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, filter.offset.yaw_rad);
    (void)step(0.0F, 0.0F, 2.5F);
    TEST_ASSERT_EQUAL_FLOAT(2.5F, level.yaw_rad);
    TEST_ASSERT_EQUAL_FLOAT(2.5F, median.yaw_rad);
}

void test_an_offset_over_ten_degrees_is_refused_and_taken_anew(void)
{
    static const float tilts[][2] = {{0.176F, 0.0F}, {-0.176F, 0.0F}, {0.0F, 0.176F}, {0.0F, -0.176F}};
    for (unsigned i = 0; i < 4; i++) {
        attitude_init(&filter);
        learn(tilts[i][0], tilts[i][1]);
        TEST_ASSERT_FALSE(filter.ready);
        TEST_ASSERT_EQUAL_UINT16(1, filter.refusals);
        learn(0.02F, 0.0F);
        TEST_ASSERT_TRUE(filter.ready);
        TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.02F, filter.offset.roll_rad);
        TEST_ASSERT_EQUAL_UINT16(1, filter.refusals);
    }
}

void test_an_offset_just_under_ten_degrees_is_taken(void)
{
    learn(0.174F, -0.174F);
    TEST_ASSERT_TRUE(filter.ready);
    TEST_ASSERT_EQUAL_UINT16(0, filter.refusals);
}

void test_a_nan_cannot_become_the_offset(void)
{
    (void)step(NAN, 0.0F, 0.0F);
    for (unsigned i = 0; i < 19; i++) {
        (void)step(0.0F, 0.0F, 0.0F);
    }
    TEST_ASSERT_FALSE(filter.ready);
    learn(0.0F, 0.0F);
    TEST_ASSERT_TRUE(filter.ready);
}

void test_the_count_of_refusals_stays_at_its_end(void)
{
    filter.refusals = UINT16_MAX;
    learn(1.0F, 0.0F);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, filter.refusals);
}

void test_spikes_leave_the_median_alone(void)
{
    learn(0.0F, 0.0F);
    for (int i = 0; i < 200; i++) {
        const bool spike = i % 5 == 4;
        (void)step(spike ? 0.35F : 0.01F, spike ? -0.35F : -0.01F, spike ? -2.0F : 3.0F);
        if (i >= 2) {
            TEST_ASSERT_EQUAL_FLOAT(0.01F, median.roll_rad);
            TEST_ASSERT_EQUAL_FLOAT(-0.01F, median.pitch_rad);
            TEST_ASSERT_EQUAL_FLOAT(3.0F, median.yaw_rad);
        }
    }
}

void test_a_ramp_is_followed_two_frames_late(void)
{
    learn(0.0F, 0.0F);
    for (int i = 0; i < 30; i++) {
        (void)step(0.01F * (float)i, 0.0F, 0.0F);
        TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.01F * (float)i, level.roll_rad);
        if (i >= 4) {
            TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.01F * (float)(i - 2), median.roll_rad);
        }
    }
}

void test_the_first_frames_give_the_median_of_what_there_is(void)
{
    learn(0.0F, 0.0F);
    (void)step(0.03F, 0.0F, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.03F, median.roll_rad);
    (void)step(0.01F, 0.0F, 0.0F);
    TEST_ASSERT_TRUE(median.roll_rad == 0.03F || median.roll_rad == 0.01F);
    (void)step(0.02F, 0.0F, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.02F, median.roll_rad);
    TEST_ASSERT_EQUAL_UINT16(3, filter.held);
}

void test_yaw_passes_the_seam_without_a_jump_through_zero(void)
{
    learn(0.0F, 0.0F);
    for (int i = 0; i < 20; i++) {
        float yaw = 3.0F + 0.02F * (float)i;
        yaw = yaw > 3.14159265F ? yaw - 6.2831853F : yaw;
        (void)step(0.0F, 0.0F, yaw);
        TEST_ASSERT_TRUE(fabsf(median.yaw_rad) > 2.9F);
    }
}

void test_a_restored_offset_is_used_at_once(void)
{
    const attitude_t offset = {0.04F, -0.02F, 0.0F};
    learn(0.5F, 0.5F);
    attitude_restore(&filter, &offset);
    TEST_ASSERT_TRUE(filter.ready);
    TEST_ASSERT_TRUE(step(0.05F, 0.0F, 1.0F));
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.01F, level.roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.02F, median.pitch_rad);
    TEST_ASSERT_EQUAL_UINT16(1, filter.held);
}

/* ---- turning over */

#define DEGREE_RAD 0.0174532925F

/* As an IMU tells it. */
static float within_half_a_turn(float degrees)
{
    return (degrees > 180.0F) ? degrees - 360.0F : (degrees < -180.0F) ? degrees + 360.0F : degrees;
}

/* Frames that are added to a level vehicle's roll and pitch, then what `rolled` came to at most. */
static uint16_t most_rolled(const float *degrees, unsigned frames, bool pitch)
{
    uint16_t most = 0U;

    const attitude_t level_from_the_start = {0.0F, 0.0F, 0.0F};

    attitude_restore(&filter, &level_from_the_start);
    for (unsigned i = 0; i < frames + 15U; i++) {
        const float told = (i >= 5U && i < frames + 5U) ? degrees[i - 5U] * DEGREE_RAD : 0.0F;
        (void)step(pitch ? 0.0F : told, pitch ? told : 0.0F, 0.0F);
        most = (filter.rolled > most) ? filter.rolled : most;
    }
    return most;
}

void test_a_roll_of_400_degrees_a_second_is_seen_at_its_seventh_frame_beyond_10_degrees(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        learn(0.0F, 0.0F);
        for (int i = 0; i <= 22; i++) { /* and through the half turn */
            const float roll_rad = within_half_a_turn((float)sign * 10.1F * (float)i) * DEGREE_RAD;
            (void)step(roll_rad, 0.0F, 0.0F);
            TEST_ASSERT_EQUAL_INT(i < (int)ATTITUDE_ROLLED_FRAMES ? i : (int)ATTITUDE_ROLLED_FRAMES,
                                  filter.rolled);
        }
        attitude_init(&filter);
    }
}

/* Frames of a roll until it is seen; a spike is added to one of them. */
static unsigned frames_until_seen(float first_degrees, float more_degrees, unsigned spiked,
                                  float spike_degrees)
{
    const attitude_t level_from_the_start = {0.0F, 0.0F, 0.0F};

    attitude_restore(&filter, &level_from_the_start);
    for (unsigned i = 0; i < 4; i++) {
        (void)step(0.0F, 0.0F, 0.0F);
    }
    for (unsigned i = 0; i < 16; i++) {
        const float told = first_degrees + more_degrees * (float)i + (i == spiked ? spike_degrees : 0.0F);
        (void)step(told * DEGREE_RAD, 0.0F, 0.0F);
        if (filter.rolled == ATTITUDE_ROLLED_FRAMES) {
            return i + 1U;
        }
    }
    return 0U;
}

void test_the_first_frame_of_a_roll_counts_once_it_has_moved_by_3_degrees(void)
{
    TEST_ASSERT_EQUAL_UINT(8U, frames_until_seen(2.5F, 15.0F, 99U, 0.0F));
    TEST_ASSERT_EQUAL_UINT(7U, frames_until_seen(3.2F, 15.0F, 99U, 0.0F));
    TEST_ASSERT_EQUAL_UINT(7U, frames_until_seen(9.0F, 10.0F, 99U, 0.0F));
    TEST_ASSERT_EQUAL_UINT(8U, frames_until_seen(4.0F, 10.0F, 99U, 0.0F)); /* the third beyond 45 degrees */
}

void test_a_spike_delays_the_sight_of_a_roll_by_at_most_two_frames(void)
{
    for (unsigned spiked = 0; spiked < 9; spiked++) {
        for (float first = 0.5F; first < 10.0F; first += 1.0F) {
            const unsigned without = frames_until_seen(first, 10.0F, 99U, 0.0F);
            for (float spike = -20.0F; spike <= 20.0F; spike += 40.0F) {
                const unsigned seen = frames_until_seen(first, 10.0F, spiked, spike);
                TEST_ASSERT_GREATER_OR_EQUAL_UINT(6U, seen);
                TEST_ASSERT_LESS_OR_EQUAL_UINT(without + 2U, seen);
            }
        }
    }
}

void test_six_bad_frames_are_no_roll_while_the_vehicle_flies_forward(void)
{
    const attitude_t level_from_the_start = {0.0F, 0.0F, 0.0F};

    for (float drift = 8.0F; drift <= 16.0F; drift += 0.5F) {
        attitude_restore(&filter, &level_from_the_start);
        for (unsigned i = 0; i < 40; i++) {
            const float sway = (i % 2U == 0U) ? 12.4F : 11.6F;
            const float told = (i >= 20U && i < 26U) ? drift * (float)(i - 19U) : 0.0F;
            (void)step(0.0F, (sway + told) * DEGREE_RAD, 0.0F);
            TEST_ASSERT_LESS_THAN_UINT16(ATTITUDE_ROLLED_FRAMES, filter.rolled);
        }
    }
}

void test_a_slow_roll_is_seen_at_its_third_frame_beyond_45_degrees(void)
{
    learn(0.0F, 0.0F);
    for (int i = 0; i < 30; i++) {
        (void)step(0.0F, 3.1F * DEGREE_RAD * (float)i, 0.0F);
        const bool seen = 3.1F * (float)(i - 2) > 45.0F;
        TEST_ASSERT_EQUAL_INT(seen, filter.rolled == ATTITUDE_ROLLED_FRAMES);
    }
}

void test_the_fastest_roll_that_is_followed_is_650_degrees_a_second(void)
{
    float roll[10];

    for (unsigned i = 0; i < 10; i++) {
        roll[i] = 16.5F * (float)(i + 1U);
    }
    TEST_ASSERT_EQUAL_UINT16(ATTITUDE_ROLLED_FRAMES, most_rolled(roll, 10, false));
    TEST_ASSERT_LESS_THAN_UINT16(ATTITUDE_ROLLED_FRAMES, most_rolled(roll, 6, false));
}

void test_a_spike_of_20_degrees_before_six_bad_frames_is_no_frame_of_a_turn(void)
{
    for (float drift = -16.0F; drift <= 16.0F; drift += 2.0F) {
        float told[7] = {20.0F};
        for (unsigned i = 1; i < 7; i++) {
            told[i] = 16.0F + drift * (float)(i - 1U);
        }
        TEST_ASSERT_LESS_THAN_UINT16(ATTITUDE_ROLLED_FRAMES, most_rolled(told, 7, drift > 0.0F));
    }
}

void test_one_spike_on_the_way_does_not_hide_a_roll(void)
{
    for (unsigned spike = 1; spike < 8; spike++) {
        float roll[12];
        for (unsigned i = 0; i < 12; i++) {
            roll[i] = 10.0F * (float)(i + 1U) + (i == spike ? 25.0F : 0.0F);
        }
        TEST_ASSERT_EQUAL_UINT16(ATTITUDE_ROLLED_FRAMES, most_rolled(roll, 12, spike % 2U == 0U));
    }
}

void test_up_to_six_bad_frames_are_no_roll_whatever_they_tell(void)
{
    bool pitch = false;

    for (float first = -160.0F; first <= 160.0F; first += 12.5F) {
        for (float drift = -36.0F; drift <= 36.0F; drift += 4.0F) {
            float told[6];
            for (unsigned i = 0; i < 6; i++) {
                told[i] = within_half_a_turn(first + drift * (float)i);
            }
            TEST_ASSERT_LESS_THAN_UINT16(ATTITUDE_ROLLED_FRAMES, most_rolled(told, 6, pitch));
            pitch = !pitch;
        }
    }
}

void test_a_vehicle_that_stays_on_its_side_is_seen_although_it_got_there_unseen(void)
{
    float told[11];

    for (unsigned i = 0; i < 11; i++) {
        told[i] = 90.0F;
    }
    TEST_ASSERT_EQUAL_UINT16(ATTITUDE_ROLLED_FRAMES, most_rolled(told, 11, false));
    TEST_ASSERT_LESS_THAN_UINT16(ATTITUDE_ROLLED_FRAMES, most_rolled(told, 10, false));
}
