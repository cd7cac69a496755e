/* What each frame, scan, command and height adds to the evidence: one at a time, against the sums and time
 * constants that integrity.h and the text books of filters give. The verdicts on it are in
 * test_integrity_verdicts.c. */
#include "control/integrity.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define G_MPS2 9.80665F
#define DEGREE_RAD 0.0174532925F
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, expected, actual)
#define VERY_NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, expected, actual)

static integrity_t it;
static flown_t flown;
static imu_sample_t frame;

void setUp(void)
{
    integrity_init(&it);
    flown = (flown_t){.step_s = 0.025F, .off_ground = true, .ours = true, .authority_mps2_per_n = 1.4F};
    frame = (imu_sample_t){.ready = true, .has_acceleration = true, .down_mps2 = G_MPS2};
}

void tearDown(void) {}

/* ---- tilt */

static void tilt(float roll_rad, float pitch_rad)
{
    frame.sequence++;
    frame.arrival_us += 25000U;
    frame.median.roll_rad = roll_rad;
    frame.median.pitch_rad = pitch_rad;
    frame.level = frame.median;
    integrity_tilt(&it, &frame, 1U, 0.0F, 0.0F, 0U);
}

void test_twenty_degrees_in_a_frame_are_a_jump_of_either_angle_to_either_side(void)
{
    for (int axis = 0; axis < 2; axis++) {
        for (float side = -1.0F; side < 2.0F; side += 2.0F) {
            setUp();
            tilt(0.0F, 0.0F);
            tilt((axis == 0) ? 0.355F * side : 0.0F, (axis == 1) ? 0.355F * side : 0.0F);
            TEST_ASSERT_EQUAL_UINT16(1U, it.jumped);
            TEST_ASSERT_EQUAL_UINT32(2U, it.unfit_sequence);
            tilt((axis == 0) ? 0.345F * side : 0.0F, (axis == 1) ? 0.345F * side : 0.0F);
            TEST_ASSERT_EQUAL_UINT16(0U, it.jumped);
            TEST_ASSERT_EQUAL_FLOAT((axis == 0) ? 0.345F * side : 0.0F, it.roll_rad);
            TEST_ASSERT_EQUAL_FLOAT((axis == 1) ? 0.345F * side : 0.0F, it.pitch_rad);
            TEST_ASSERT_EQUAL_UINT32(2U, it.unfit_sequence);
        }
    }
}

void test_the_way_through_the_half_turn_is_the_short_one(void)
{
    tilt(3.0F, 0.0F);
    tilt(-3.0F, 0.0F); /* 0.283 rad */
    TEST_ASSERT_EQUAL_FLOAT(-3.0F, it.roll_rad);
    tilt(2.9F, 0.0F); /* 0.383 rad */
    TEST_ASSERT_EQUAL_UINT16(1U, it.jumped);
}

void test_a_jump_within_ten_frames_of_silence_is_one_and_after_them_none(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        setUp();
        tilt(0.0F, 0.0F);
        frame.arrival_us += 225000U + more_us;
        tilt(1.0F, 0.0F);
        TEST_ASSERT_EQUAL_UINT16(1U - more_us, it.jumped);
    }
}

void test_the_time_of_a_refused_tilt_counts_as_news(void)
{
    tilt(0.0F, 0.0F);
    frame.arrival_us += 200000U;
    tilt(1.0F, 0.0F);
    frame.arrival_us += 100000U;
    tilt(1.0F, 0.0F);
    TEST_ASSERT_EQUAL_UINT16(2U, it.jumped);
    TEST_ASSERT_EQUAL_UINT32(frame.arrival_us, it.tilt_time_us);
}

void test_six_jumps_in_a_row_are_counted_anew_after_a_good_tilt(void)
{
    tilt(0.0F, 0.0F);
    for (int burst = 0; burst < 2; burst++) {
        for (int i = 0; i < 6; i++) {
            tilt(1.0F, 0.0F);
            TEST_ASSERT_EQUAL_FLOAT(0.0F, it.roll_rad);
        }
        tilt(0.0F, 0.0F);
    }
}

void test_angles_beyond_seven_radians_or_without_a_number_are_refused(void)
{
    static const float bad[] = {7.1F, -7.1F, NAN};
    for (int i = 0; i < 3; i++) {
        setUp();
        tilt(bad[i], 0.0F);
        tilt(0.0F, bad[i]);
        TEST_ASSERT_FALSE(it.levelled);
        TEST_ASSERT_EQUAL_UINT32(2U, it.unfit_sequence);
        TEST_ASSERT_EQUAL_UINT32(0U, it.tilt_time_us);
    }
    tilt(6.9F, -6.9F);
    TEST_ASSERT_TRUE(it.levelled);
}

void test_tilted_are_45_degrees_of_one_angle_or_less_of_two(void)
{
    static const struct {
        float roll_deg, pitch_deg;
        uint16_t tilted;
    } rows[] = {
        {44.5F, 0.0F, 0U}, {45.5F, 0.0F, 1U}, {0.0F, -45.5F, 1U}, {34.0F, 30.0F, 0U}, {34.0F, 33.0F, 1U}};
    for (int i = 0; i < 5; i++) {
        setUp();
        tilt(rows[i].roll_deg * DEGREE_RAD, rows[i].pitch_deg * DEGREE_RAD);
        TEST_ASSERT_EQUAL_UINT16(rows[i].tilted, it.tilted);
    }
    NEAR(0.69528F, it.upright); /* cos 34 cos 33 */
    tilt(0.5F, 0.5F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.tilted);
    it.tilted = 999U;
    tilt(0.8F, 0.8F);
    tilt(0.8F, 0.8F);
    TEST_ASSERT_EQUAL_UINT16(1000U, it.tilted); /* and does not wrap */
}

void test_a_sample_or_a_frame_counts_once(void)
{
    integrity_tilt(&it, NULL, 0U, 0.1F, 0.0F, 0U);
    integrity_tilt(&it, NULL, 0U, 1.0F, 0.0F, 0U);
    TEST_ASSERT_EQUAL_UINT16(0U, it.jumped);
    integrity_tilt(&it, NULL, 0U, 1.0F, 0.0F, 25000U);
    TEST_ASSERT_EQUAL_UINT16(1U, it.jumped);
    frame.arrival_us = 25000U;
    tilt(-1.0F, 0.0F);
    TEST_ASSERT_EQUAL_UINT16(2U, it.jumped);
    integrity_tilt(&it, &frame, 1U, 0.0F, 0.0F, 0U);
    TEST_ASSERT_EQUAL_UINT16(2U, it.jumped);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, it.roll_rad);
}

/* Between the steps of an attitude that is held (0.05 rad) and those that are no turn any more (0.25 rad),
 * and within 0.25 rad of where that rate leads from the accepted tilt. */
void test_rejected_tilts_that_go_on_turning_are_a_turn(void)
{
    static const struct {
        float first_rad, second_rad;
        bool turn;
    } rows[] = {{0.40F, 0.64F, true},  {0.40F, 0.66F, false},  {0.36F, 0.42F, false}, {0.40F, 0.60F, true},
                {0.40F, 0.54F, false}, {-0.40F, -0.60F, true}, {0.60F, 0.77F, false}, {0.43F, 0.63F, true},
                {0.40F, 0.56F, true},  {0.40F, 0.40F, false},  {0.64F, 0.40F, false}};
    for (int axis = 0; axis < 2; axis++) {
        for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
            const float first_rad = rows[i].first_rad, second_rad = rows[i].second_rad;
            setUp();
            tilt(0.0F, 0.0F);
            tilt((axis == 0) ? first_rad : 0.0F, (axis == 1) ? first_rad : 0.0F);
            TEST_ASSERT_EQUAL_UINT16(1U, it.jumped);
            tilt((axis == 0) ? second_rad : 0.0F, (axis == 1) ? second_rad : 0.0F);
            TEST_ASSERT_EQUAL_UINT16(rows[i].turn ? 0U : 2U, it.jumped);
        }
    }
}

void test_a_slow_turn_of_the_other_angle_is_none(void)
{
    for (int turns = 0; turns < 2; turns++) {
        setUp();
        const float rate_rad = (turns != 0) ? 0.052F : 0.048F;
        tilt(0.0F, 0.0F);
        tilt(1.0F, rate_rad);
        tilt(1.0F, 2.0F * rate_rad);
        TEST_ASSERT_EQUAL_UINT16((turns != 0) ? 0U : 2U, it.jumped);
    }
}

void test_a_turn_goes_through_the_half_turn(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        setUp();
        tilt(3.0F * side, 0.0F);
        tilt(-2.88F * side, 0.0F); /* 0.4 rad on */
        TEST_ASSERT_EQUAL_UINT16(1U, it.jumped);
        tilt(-2.68F * side, 0.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, it.jumped);
        setUp();
        tilt(2.6F * side, 0.0F);
        tilt(3.05F * side, 0.0F);
        tilt(-3.033F * side, 0.0F); /* 0.2 rad on */
        TEST_ASSERT_EQUAL_UINT16(0U, it.jumped);
    }
}

void test_frames_that_were_level_themselves_are_no_tilt(void)
{
    for (int level = 0; level < 3; level++) {
        setUp();
        frame.sequence++;
        frame.median.roll_rad = 1.0F;
        frame.level.roll_rad = (level == 1) ? 0.78F : 0.79F;
        frame.rolled = (level == 2) ? ATTITUDE_ROLLED_FRAMES : 0;
        integrity_tilt(&it, &frame, 1U, 0.0F, 0.0F, 0U);
        TEST_ASSERT_EQUAL_UINT16((level == 0) ? 1U : (level == 1) ? 0U : 1000U, it.tilted);
    }
}

/* ---- scans */

static uint16_t white_before;
static float sway_before_rad2;

/* The twelfth scan: a ramp of slope_mm a scan, and noise_mm to either side by turns. */
static float scan_height_m = 0.5F;

static void scan_of(float slope_mm, float noise_mm)
{
    float slants_mm[INTEGRITY_SCANS];
    for (int k = 0; k < (int)INTEGRITY_SCANS; k++) {
        slants_mm[k] = 700.0F + slope_mm * ((float)k - 5.5F) + ((k % 2 == 0) ? noise_mm : -noise_mm);
    }
    setUp();
    it.slants_mm[0] = 99.0F; /* drops out */
    memcpy(it.slants_mm + 1, slants_mm, sizeof slants_mm - sizeof slants_mm[0]);
    it.scans = INTEGRITY_SCANS - 1U;
    it.white = white_before;
    it.height_m = scan_height_m;
    it.sway_rad2 = sway_before_rad2;
    TEST_ASSERT_TRUE(integrity_scan(
        &it,
        &(altitude_t){.height_mm = 500.0F, .slant_mm = slants_mm[INTEGRITY_SCANS - 1U], .spread_mm = 9.0F}));
    TEST_ASSERT_EQUAL_UINT16(INTEGRITY_SCANS, it.scans);
}

/* The sample variance of noise a by turns is 12/11 a2. */
void test_a_slant_below_two_millimetres_rms_is_rigid(void)
{
    scan_of(0.0F, 1.90F);
    TEST_ASSERT_EQUAL_UINT16(1U, it.rigid);
    TEST_ASSERT_EQUAL_UINT16(1U, it.still);
    scan_of(0.0F, 1.93F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.rigid);
    TEST_ASSERT_EQUAL_UINT16(1U, it.still);
    scan_of(0.5F, 0.1F); /* rigid, and hardly noise */
    TEST_ASSERT_EQUAL_UINT16(1U, it.rigid);
    TEST_ASSERT_EQUAL_UINT16(1U, it.still);
}

void test_a_slant_beyond_eight_millimetres_rms_is_not_still(void)
{
    scan_of(0.0F, 7.6F);
    TEST_ASSERT_EQUAL_UINT16(1U, it.still);
    scan_of(0.0F, 7.7F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.still);
}

/* Noise by second differences 16/6 a2; variance with a ramp s (143 s2 + 12 a2 - 12 a s) / 11. With a = 2 mm
 * the noise is 0.4 of it at s = 1.396 mm. */
void test_a_slant_is_still_when_noise_makes_two_fifths_of_its_variance(void)
{
    scan_of(1.38F, 2.0F);
    TEST_ASSERT_EQUAL_UINT16(1U, it.still);
    TEST_ASSERT_EQUAL_UINT16(0U, it.rigid);
    scan_of(1.41F, 2.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.still);
}

void test_less_than_twelve_scans_say_nothing_and_a_moving_one_begins_anew(void)
{
    for (int scan = 1; scan <= 40; scan++) {
        const altitude_t altitude = {
            .height_mm = 500.0F, .slant_mm = 700.0F, .spread_mm = 9.0F + (float)(scan % 2)};
        TEST_ASSERT_TRUE(integrity_scan(&it, &altitude));
        const int still = (scan < 12) ? 0 : (scan < 27) ? scan - 11 : 16;
        TEST_ASSERT_EQUAL_UINT16(still, it.still);
        TEST_ASSERT_EQUAL_UINT16(still, it.rigid);
        TEST_ASSERT_EQUAL(still > 8, integrity_still(&it));
    }
    TEST_ASSERT_TRUE(integrity_scan(&it, &(altitude_t){.slant_mm = 800.0F, .spread_mm = 9.0F}));
    TEST_ASSERT_EQUAL_UINT16(0U, it.still);
    TEST_ASSERT_EQUAL_UINT16(0U, it.rigid);
}

void test_one_ray_has_no_spread_and_is_neither_a_copy_nor_a_slant(void)
{
    const altitude_t altitude = {.height_mm = 500.0F, .slant_mm = 700.0F};
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE(integrity_scan(&it, &altitude));
    }
    TEST_ASSERT_EQUAL_UINT16(0U, it.scans);
    const altitude_t narrow = {.height_mm = 500.0F, .slant_mm = 700.0F, .spread_mm = 0.0005F};
    TEST_ASSERT_TRUE(integrity_scan(&it, &narrow)); /* the smallest spread is one */
    TEST_ASSERT_FALSE(integrity_scan(&it, &narrow));
    TEST_ASSERT_EQUAL_UINT16(2U, it.scans);
}

void test_heights_out_of_reach_leave_the_slants_alone(void)
{
    static const float heights_mm[] = {-5001.0F, 5001.0F, NAN, -5000.0F, 5000.0F};
    for (int i = 0; i < 5; i++) {
        (void)integrity_scan(
            &it, &(altitude_t){.height_mm = heights_mm[i], .slant_mm = (float)i, .spread_mm = 1.0F});
        TEST_ASSERT_EQUAL_UINT16((i < 3) ? 0 : i - 2, it.scans);
    }
}

void test_the_limits_of_a_height_belong_to_it(void)
{
    TEST_ASSERT_TRUE(integrity_scan(&it, &(altitude_t){.height_mm = 5000.0F}));
    TEST_ASSERT_TRUE(integrity_scan(&it, &(altitude_t){.height_mm = -50.0F}));
    TEST_ASSERT_FALSE(integrity_scan(&it, &(altitude_t){.height_mm = -50.1F}));
    TEST_ASSERT_TRUE(it.below_ground);
    TEST_ASSERT_TRUE(integrity_scan(&it, &(altitude_t){.height_mm = -30.0F}));
    TEST_ASSERT_FALSE(it.below_ground);
}

void test_copies_are_counted_to_a_thousand(void)
{
    const altitude_t altitude = {.height_mm = 500.0F, .slant_mm = 700.0F, .spread_mm = 9.0F};
    (void)integrity_scan(&it, &altitude);
    it.copies = 998U;
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FALSE(integrity_scan(&it, &altitude));
        TEST_ASSERT_EQUAL_UINT16((i == 0) ? 999U : 1000U, it.copies);
    }
}

/* ---- accelerometer */

static void feel(float up_mps2)
{
    frame.sequence++;
    frame.arrival_us += 25000U;
    frame.down_mps2 = G_MPS2 + up_mps2;
    integrity_frames(&it, &flown, &frame, 1U);
}

void test_the_felt_speed_is_the_integral_of_the_acceleration_without_the_bias(void)
{
    feel(0.0F);
    it.bias_mps2 = 0.5F;
    it.felt = (witness_t){0};
    feel(2.0F); /* trapezium: 1 m/s2 on the mean */
    NEAR((1.0F - 0.5F) * 0.025F, it.felt.speed_mps);
    VERY_NEAR(-0.5F * 0.5F * 0.025F * 0.025F, it.felt.off_m);
    for (int i = 0; i < 39; i++) {
        feel(2.0F);
    }
    NEAR(0.0125F + 39.0F * 0.025F * 1.5F, it.felt.speed_mps);
    NEAR(1.0F, it.felt.running_s);
    /* v t + a t2 / 2 over the 0.975 s after the first step, and that step */
    TEST_ASSERT_FLOAT_WITHIN(0.001F, -0.01219F - 0.71297F - 0.00016F, it.felt.off_m);
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.75F, it.felt.moved_m);
    for (int i = 0; i < 50; i++) {
        feel(-3.0F);
    }
    TEST_ASSERT_EQUAL_FLOAT(2.0F, it.felt.running_s);
    TEST_ASSERT_TRUE(it.felt.moved_m > 1.0F); /* a way, not a place */
}

void test_frames_that_are_old_unfit_not_ready_or_without_accelerations_add_nothing(void)
{
    feel(0.0F);
    feel(1.0F);
    const witness_t before = it.felt;
    integrity_frames(&it, &flown, &frame, 1U);
    TEST_ASSERT_EQUAL_FLOAT(before.speed_mps, it.felt.speed_mps);
    it.unfit_sequence = 3U;
    feel(1.0F);
    TEST_ASSERT_EQUAL_FLOAT(before.speed_mps, it.felt.speed_mps);
    frame.ready = false;
    feel(1.0F);
    frame.ready = true;
    frame.has_acceleration = false;
    feel(1.0F);
    frame.has_acceleration = true;
    feel(200.1F);
    feel(-200.1F);
    feel(NAN);
    TEST_ASSERT_EQUAL_FLOAT(before.speed_mps, it.felt.speed_mps);
    TEST_ASSERT_EQUAL_UINT32(5U, it.frame_sequence); /* that without accelerations told the tilt */
    feel(199.0F);
    TEST_ASSERT_EQUAL_UINT32(9U, it.frame_sequence);
    NEAR(before.speed_mps + 100.0F * 0.175F, it.felt.speed_mps);
}

void test_after_twelve_lost_frames_the_felt_speed_starts_from_the_thrusts(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        for (int warm = 0; warm < 2; warm++) {
            setUp();
            feel(0.0F);
            feel(1.0F);
            it.pushed = (witness_t){.speed_mps = 0.7F, .running_s = (warm != 0) ? 0.51F : 0.5F};
            it.rested_s = (float)more_us;
            frame.arrival_us += 275000U + more_us;
            feel(2.0F);
            if (more_us == 0U) {
                NEAR(0.0125F + 1.5F * 0.3F, it.felt.speed_mps);
            } else {
                TEST_ASSERT_EQUAL_FLOAT((warm != 0) ? 0.7F : 0.0F, it.felt.speed_mps);
                TEST_ASSERT_EQUAL_FLOAT(0.0F, it.felt.running_s);
                TEST_ASSERT_EQUAL_FLOAT(0.0F, it.rested_s);
                NEAR(2.0F, it.rest_mps2);
            }
        }
    }
}

void test_at_rest_the_mean_is_the_bias_of_the_last_two_seconds(void)
{
    flown.grounded = true;
    feel(0.0F);
    it.rested_s = it.rest_mps2 = 0.0F;
    feel(0.4F);
    NEAR(0.4F, it.bias_mps2);
    feel(0.8F);
    NEAR(0.6F, it.bias_mps2);
    NEAR(0.6F, it.rest_mps2);
    NEAR(0.05F, it.rested_s);
    it.rested_s = 2.0F;
    feel(1.0F);
    TEST_ASSERT_EQUAL_FLOAT(2.0F, it.rested_s);
    NEAR(0.6F + 0.4F * 0.025F / 2.0F, it.rest_mps2);
    it.felt.speed_mps = 1.0F;
    feel(1.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.felt.speed_mps);
}

/* One frame at rest, whose mean is then rest_mps2. */
static uint16_t rested(uint16_t doubts, float rested_s, float rest_mps2)
{
    setUp();
    flown.grounded = true;
    it.doubts = doubts;
    it.frame_time_us = frame.arrival_us;
    it.rested_s = rested_s;
    it.rest_mps2 = rest_mps2;
    feel(rest_mps2);
    return it.doubts;
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

void test_a_pilot_that_lifts_the_vehicle_spoils_the_rest(void)
{
    for (int standing = 0; standing < 2; standing++) {
        setUp();
        feel(0.0F);
        it.rested_s = 1.0F;
        it.bias_mps2 = 0.3F;
        it.rise_mps = 0.2F;
        it.felt.off_m = 0.1F;
        flown.standing = standing != 0;
        feel(0.0F);
        TEST_ASSERT_EQUAL_FLOAT((standing != 0) ? 0.3F : 0.0F, it.bias_mps2);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, it.rested_s);
        if (standing == 0) {
            NEAR(0.2F, it.felt.speed_mps);
            it.rise_mps = 5.0F;
            feel(0.0F);
            NEAR(0.2F, it.felt.speed_mps);
        }
    }
}

void test_while_standing_the_felt_speed_dies_within_a_second_and_does_not_count(void)
{
    flown.standing = true;
    feel(0.0F);
    it.felt.speed_mps = 1.0F;
    it.felt.running_s = 2.0F;
    feel(0.0F);
    NEAR(0.975F, it.felt.speed_mps);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.felt.running_s);
}

/* ---- sway and rest of the tilt */

void test_the_sway_is_the_mean_square_of_both_angles_about_their_mean(void)
{
    feel(0.0F);
    it.mean_rad[0] = it.mean_rad[1] = 0.0F;
    it.sway_rad2 = 0.0F;
    frame.median.roll_rad = 0.06F;
    frame.median.pitch_rad = -0.03F;
    feel(0.0F);
    VERY_NEAR(0.06F / 60.0F, it.mean_rad[0]);
    VERY_NEAR(-0.03F / 60.0F, it.mean_rad[1]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-8F, (0.0036F + 0.0009F) / 60.0F, it.sway_rad2);
    for (int i = 0; i < 600; i++) { /* ten time constants: a lasting tilt is no sway */
        feel(0.0F);
    }
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 0.06F, it.mean_rad[0]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -0.03F, it.mean_rad[1]);
    TEST_ASSERT_FLOAT_WITHIN(2.0e-6F, 0.0F, it.sway_rad2);
}

static void rock(float roll_rad, float pitch_rad)
{
    frame.median.roll_rad = roll_rad;
    frame.median.pitch_rad = pitch_rad;
    feel(0.0F);
}

void test_a_degree_of_either_angle_is_a_rock_and_the_next_is_measured_from_there(void)
{
    for (int axis = 0; axis < 2; axis++) {
        setUp();
        feel(0.0F);
        rock(0.0F, 0.0F);
        rock((axis == 0) ? 0.0165F : 0.0F, (axis == 1) ? -0.0165F : 0.0F);
        NEAR(0.075F, it.unrocked_s);
        rock((axis == 0) ? -0.0175F : 0.0F, (axis == 1) ? 0.0175F : 0.0F);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, it.unrocked_s);
        rock((axis == 0) ? -0.03F : 0.0F, (axis == 1) ? 0.03F : 0.0F);
        NEAR(0.025F, it.unrocked_s);
        rock(0.0F, 0.0F);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, it.unrocked_s);
    }
    for (int i = 0; i < 33; i++) {
        rock(0.0F, 0.0F);
    }
    TEST_ASSERT_EQUAL_FLOAT(0.8F, it.unrocked_s);
    TEST_ASSERT_FALSE(integrity_rocks(&it));
}

void test_rocking_is_looked_at_near_the_ground_alone(void)
{
    feel(0.0F);
    it.height_m = 0.10F;
    it.unrocked_s = 0.5F;
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.unrocked_s);
    it.height_m = 0.099F;
    feel(0.0F);
    NEAR(0.025F, it.unrocked_s);
}

void test_what_sways_and_rocks_is_told_by_limits(void)
{
    it.sway_rad2 = 4.0e-4F;
    TEST_ASSERT_FALSE(integrity_sways(&it));
    it.sway_rad2 = 4.1e-4F;
    TEST_ASSERT_TRUE(integrity_sways(&it));
    it.sway_rad2 = 2.5e-4F;
    TEST_ASSERT_FALSE(integrity_rocks(&it));
    it.sway_rad2 = 2.6e-4F;
    TEST_ASSERT_TRUE(integrity_rocks(&it));
    it.unrocked_s = 0.79F;
    TEST_ASSERT_TRUE(integrity_rocks(&it));
    it.unrocked_s = 0.8F;
    TEST_ASSERT_FALSE(integrity_rocks(&it));
    it.still_s = 1.0F;
    TEST_ASSERT_FALSE(integrity_may_stand(&it));
    it.still_s = 1.01F;
    TEST_ASSERT_TRUE(integrity_may_stand(&it));
    it.stands_s = 0.6F;
    TEST_ASSERT_FALSE(integrity_stands(&it));
    it.stands_s = 0.61F;
    TEST_ASSERT_TRUE(integrity_stands(&it));
}

/* One frame of 25 ms of a still vehicle whose witnesses have these speeds, still_s after the tilt came to
 * rest; sums of standing and of stillness run from 0.3 s and still_s. */
static void lie_still(float felt_mps, float pushed_mps, float still_s)
{
    setUp();
    feel(0.0F);
    it.felt = (witness_t){.speed_mps = felt_mps, .running_s = 2.0F};
    it.pushed = (witness_t){.speed_mps = pushed_mps, .running_s = 2.0F};
    it.still_s = still_s;
    it.stands_s = 0.3F;
}

void test_it_stands_while_the_thrust_says_a_fall_of_0_8_that_is_not_felt(void)
{
    static const struct {
        float felt_mps, pushed_mps;
        bool stands;
    } rows[] = {{0.0F, -0.81F, true},  {0.0F, -0.79F, false}, {-0.1F, -0.89F, false},
                {-0.1F, -0.91F, true}, {0.5F, -0.79F, false}, {0.0F, 0.81F, false}};
    for (int i = 0; i < 6; i++) {
        lie_still(rows[i].felt_mps, rows[i].pushed_mps, 0.5F);
        it.still_mps[0] = rows[i].felt_mps;
        it.still_mps[1] = rows[i].pushed_mps;
        feel(0.0F);
        NEAR(rows[i].stands ? 0.325F : 0.0F, it.stands_s);
        NEAR(0.525F, it.still_s);
    }
}

/* Since the tilt came to rest the speeds have changed from these: only the changes are compared then, and a
 * 80th of them has been taken into the means. */
void test_after_a_second_of_stillness_the_changes_of_the_speeds_tell_it_too(void)
{
    static const struct {
        float still_s, felt0_mps, pushed0_mps;
        bool stands;
    } rows[] = {{1.01F, -1.0F, -0.39F, true},
                {1.01F, -1.0F, -0.41F, false},
                {0.97F, -1.0F, -0.39F, false},
                {1.01F, -0.9F, -0.39F, false},
                {1.01F, -0.9F, -0.28F, true}};
    for (int i = 0; i < 5; i++) {
        lie_still(-1.0F, -0.9F, rows[i].still_s);
        it.still_mps[0] = rows[i].felt0_mps;
        it.still_mps[1] = rows[i].pushed0_mps;
        feel(0.0F);
        NEAR(rows[i].stands ? 0.325F : 0.0F, it.stands_s);
    }
}

void test_a_sway_or_a_witness_that_does_not_count_ends_the_standing(void)
{
    for (int what = 0; what < 4; what++) {
        lie_still(0.0F, -0.9F, 0.5F);
        it.sway_rad2 = (what == 1) ? 2.6e-4F : 2.5e-4F; /* a 60th is forgotten first */
        it.sway_rad2 += it.sway_rad2 / 59.5F * (what == 1);
        it.felt.running_s = (what == 2) ? 0.5F : 0.51F;
        it.pushed.running_s = (what == 3) ? 0.5F : 0.51F;
        feel(0.0F);
        NEAR((what == 0) ? 0.325F : 0.0F, it.stands_s);
        NEAR((what == 1) ? 0.0F : 0.525F, it.still_s);
    }
}

void test_stillness_begins_anew_with_a_fall_and_keeps_the_speeds_of_that_time(void)
{
    lie_still(-0.41F, -0.2F, 0.5F);
    feel(0.0F);
    NEAR(0.025F, it.still_s); /* felt: 0.41 m/s less than before */
    NEAR(-0.41F, it.still_mps[0]);
    NEAR(-0.2F, it.still_mps[1]);
    lie_still(-0.39F, -0.2F, 0.5F);
    feel(0.0F);
    NEAR(0.525F, it.still_s);
    NEAR(-0.39F / 80.0F, it.still_mps[0]); /* 25 ms of 2 s */
    NEAR(-0.2F / 80.0F, it.still_mps[1]);
    lie_still(0.3F, 0.2F, 0.0F);
    feel(0.0F);
    NEAR(0.3F, it.still_mps[0]);
    NEAR(0.2F, it.still_mps[1]);
    lie_still(0.3F, 0.2F, 0.5F);
    it.sway_rad2 = 1.0e-3F;
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.still_s);
    NEAR(0.3F, it.still_mps[0]);
}

/* ---- thrust */

void test_the_thrust_arrives_through_a_lag_of_150_ms(void)
{
    flown.thrust_n = 7.0F;
    integrity_thrust(&it, &flown);
    NEAR(1.0F, it.lagged_n); /* 0.025 / 0.175 */
    flown.step_s = 3.0F;
    integrity_thrust(&it, &flown);
    NEAR(1.0F + 6.0F * 0.5F / 0.65F, it.lagged_n); /* a pause counts as half a second */
}

void test_the_pushed_speed_is_the_models(void)
{
    flown.thrust_n = it.lagged_n = 8.0F;
    flown.hover_n = 7.0F;
    it.upright = 0.95F;
    it.pushed.speed_mps = 0.2F;
    flown.damping_per_s = 2.0F;
    integrity_thrust(&it, &flown);
    /* implicit: a = (1.4 (8 x 0.95 - 7) - 2 x 0.2) / (1 + 2 x 0.025) */
    NEAR(0.2F + 0.44F / 1.05F * 0.025F, it.pushed.speed_mps);
    NEAR(0.025F, it.pushed.running_s);
    VERY_NEAR(-(0.2F + 0.5F * 0.41905F * 0.025F) * 0.025F, it.pushed.off_m);
}

void test_the_pushed_speed_waits_on_the_ground_and_starts_at_the_felt_one(void)
{
    static const struct {
        bool off_ground, grounded, has_height, felt_counts, doubted;
        float height_m, sway_rad2, speed_mps;
        bool waits;
    } rows[] = {
        {true, false, true, true, false, 0.081F, 0.0F, 0.0F, false},
        {true, false, true, true, false, 0.08F, 0.0F, 0.0F, false},
        {true, false, true, true, false, 0.079F, 0.0F, 0.6F, true},
        {true, false, true, true, false, 0.079F, 4.1e-4F, 0.0F, false},
        {true, false, false, true, false, 0.079F, 0.0F, 0.0F, false},
        {false, false, true, true, false, 0.5F, 0.0F, 0.6F, true},
        {false, true, true, true, false, 0.5F, 0.0F, 0.0F, true},
        {false, false, true, false, false, 0.5F, 0.0F, 0.0F, true},
        {false, false, true, true, true, 0.5F, 0.0F, 0.0F, true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        flown.off_ground = rows[i].off_ground;
        flown.grounded = rows[i].grounded;
        it.has_height = rows[i].has_height;
        it.height_m = rows[i].height_m;
        it.sway_rad2 = rows[i].sway_rad2;
        it.doubts = rows[i].doubted ? DOUBT_IMU : 0U;
        it.felt = (witness_t){.speed_mps = 0.6F, .running_s = rows[i].felt_counts ? 0.51F : 0.5F};
        it.pushed = (witness_t){.speed_mps = 0.0F, .off_m = 0.3F, .running_s = 1.0F};
        integrity_thrust(&it, &flown);
        TEST_ASSERT_EQUAL_FLOAT(rows[i].speed_mps, it.pushed.speed_mps);
        NEAR(rows[i].waits ? 0.0F : 1.025F, it.pushed.running_s);
        NEAR(rows[i].waits ? 0.0F : 0.3F, it.pushed.off_m);
    }
}

void test_standing_is_the_ground_or_a_take_off_that_has_not_left_it(void)
{
    for (int i = 0; i < 4; i++) {
        flown.grounded = (i & 1) != 0;
        flown.standing = (i & 2) != 0;
        integrity_thrust(&it, &flown);
        TEST_ASSERT_EQUAL(i != 0, it.standing);
    }
}

void test_noise_beyond_twice_the_usual_shakes_with_the_power_of_one_and_a_half(void)
{
    static const float rows[][2] = {{0.2F, 1.0F}, {0.9F, 1.0F}, {1.8F, 2.82843F}, {3.6F, 8.0F}};
    for (int i = 0; i < 4; i++) {
        flown.noise_mps2 = rows[i][0];
        integrity_thrust(&it, &flown);
        NEAR(rows[i][1], it.shaken);
    }
}

void test_a_new_order_on_the_ground_forgets_and_one_in_the_air_does_not(void)
{
    for (int grounded = 0; grounded < 2; grounded++) {
        setUp();
        flown.ordered = true;
        flown.grounded = grounded != 0;
        it.doubts = DOUBT_SIGHT | DOUBT_IMU | DOUBT_THRUST;
        it.felt.seen_m = it.felt.off_m = it.felt.moved_m = it.agreed_s = 0.4F;
        integrity_thrust(&it, &flown);
        TEST_ASSERT_EQUAL_UINT16((grounded != 0) ? DOUBT_IMU : 7U, it.doubts);
        TEST_ASSERT_EQUAL_FLOAT((grounded != 0) ? 0.0F : 0.4F, it.felt.seen_m);
        TEST_ASSERT_EQUAL_FLOAT((grounded != 0) ? 0.0F : 0.4F, it.felt.off_m);
        TEST_ASSERT_EQUAL_FLOAT((grounded != 0) ? 0.0F : 0.4F, it.felt.moved_m);
        TEST_ASSERT_EQUAL_FLOAT((grounded != 0) ? 0.0F : 0.4F, it.agreed_s);
    }
}

void test_the_speed_without_heights_is_that_of_the_witnesses_that_are_left(void)
{
    it.felt = (witness_t){.speed_mps = 0.4F, .running_s = 0.51F};
    it.pushed = (witness_t){.speed_mps = 0.8F, .running_s = 0.51F};
    NEAR(0.6F, integrity_speed_mps(&it));
    it.doubts = DOUBT_IMU;
    NEAR(0.8F, integrity_speed_mps(&it));
    it.doubts = DOUBT_THRUST;
    NEAR(0.4F, integrity_speed_mps(&it));
    it.doubts = DOUBT_THRUST | DOUBT_IMU;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, integrity_speed_mps(&it));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, integrity_felt_mps(&it));
    it.doubts = 0U;
    it.shaken = 2.0F;
    NEAR(0.2F, integrity_felt_mps(&it));
    it.pushed.running_s = 0.5F;
    NEAR(0.4F, integrity_speed_mps(&it));
    it.felt.running_s = 0.5F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, integrity_speed_mps(&it));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, integrity_felt_mps(&it));
}

/* ---- heights */

/* In the air at 0.5 m; nothing known of the past. */
static void hover(void)
{
    setUp();
    it.has_height = it.proved = true;
    it.height_m = it.near_m = 0.5F;
    it.since_rise_s = 1.5F;
    it.unmoved_s = 1.0F;
    flown.wanted_m = 0.5F;
}

static void height(float height_m)
{
    integrity_height(&it, &flown, height_m, 0.1F, 0.0F);
}

void test_a_height_moves_the_rate_the_way_and_the_sums(void)
{
    hover();
    it.felt = (witness_t){.speed_mps = 0.3F, .running_s = 2.0F};
    it.way_m = 0.1F;
    it.rise_mps = 0.1F;
    it.felt.off_m = 0.07F;
    it.pushed.off_m = -0.02F;
    integrity_height(&it, &flown, 0.53F, 0.1F, 0.1F);
    NEAR(0.1F + (0.3F - 0.1F) / 3.0F, it.rise_mps); /* 0.1 of 0.2 + 0.1 s */
    NEAR(0.1F * 0.9F + 0.03F, it.way_m);
    NEAR(0.13F, it.felt.seen_m); /* 0.07 + 0.03, and 0.3 m/s x 0.1 s of age */
    NEAR(0.1F - 0.18F * 0.13F, it.felt.off_m);
    NEAR(0.3F + 0.081F * 0.13F, it.felt.speed_mps);
    VERY_NEAR(-0.01F * 0.13F, it.bias_mps2);
    NEAR(0.01F, it.pushed.seen_m);
    VERY_NEAR(0.01F - 0.04F * 0.01F, it.pushed.off_m);
    TEST_ASSERT_EQUAL_FLOAT(0.53F, it.height_m);
}

void test_a_young_witness_and_doubted_heights_correct_less(void)
{
    hover();
    it.felt = (witness_t){.off_m = 0.1F, .running_s = 1.0F};
    height(0.5F);
    NEAR(0.1F - 0.09F * 0.1F, it.felt.off_m);
    NEAR(0.0405F * 0.1F, it.felt.speed_mps);
    VERY_NEAR(-0.005F * 0.1F, it.bias_mps2);
    hover();
    it.doubts = DOUBT_SIGHT;
    it.felt = (witness_t){.off_m = 0.1F, .running_s = 2.0F};
    height(0.5F);
    NEAR(0.082F, it.felt.off_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.felt.speed_mps);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.bias_mps2);
}

void test_the_bias_ends_at_one_and_a_half_to_either_side(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        hover();
        it.bias_mps2 = -1.499F * side;
        it.felt = (witness_t){.off_m = 0.45F * side, .running_s = 2.0F};
        height(0.5F);
        NEAR(-1.5F * side, it.bias_mps2);
    }
}

void test_a_long_gap_leaks_all_of_a_sum_and_one_of_a_second_and_a_half_forgets(void)
{
    hover();
    it.felt = (witness_t){.off_m = 0.1F, .running_s = 2.0F};
    it.pushed = (witness_t){.off_m = 0.1F, .running_s = 2.0F};
    it.way_m = 0.1F;
    integrity_height(&it, &flown, 0.5F, 1.4F, 0.0F);
    VERY_NEAR(0.0F, it.felt.off_m);
    NEAR(0.044F, it.pushed.off_m);
    VERY_NEAR(0.0F, it.way_m);
    hover();
    it.felt = (witness_t){.off_m = 0.1F, .seen_m = 0.1F, .running_s = 2.0F};
    it.pushed = it.felt;
    it.way_m = 0.1F;
    it.unmoved_s = 0.0F;
    it.unconfirmed = true;
    integrity_height(&it, &flown, 0.52F, 1.5F, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.felt.off_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.pushed.off_m);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, it.felt.seen_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.way_m);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, it.unmoved_s);
    TEST_ASSERT_FALSE(it.unconfirmed);
}

void test_what_neither_witness_explains_is_a_step_of_the_terrain(void)
{
    static const struct {
        float rise_m, felt_mps, pushed_mps;
        bool step;
    } rows[] = {{0.10F, 0.0F, 0.0F, false},   {0.125F, 0.0F, 0.0F, false}, {0.135F, 0.0F, 0.0F, true},
                {-0.125F, 0.0F, 0.0F, false}, {-0.135F, 0.0F, 0.0F, true}, {0.225F, 1.0F, 0.0F, false},
                {0.235F, 1.0F, 0.0F, true},   {0.225F, 0.0F, 1.0F, false}, {0.235F, 0.0F, 1.0F, true},
                {-0.135F, 1.0F, 1.0F, true}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        hover();
        it.felt = (witness_t){.speed_mps = rows[i].felt_mps, .running_s = 0.1F};
        it.pushed = (witness_t){.speed_mps = rows[i].pushed_mps, .running_s = 0.1F};
        it.steps = 2.0F;
        it.way_m = it.rise_mps = 0.06F;
        it.unmoved_s = 0.5F;
        height(0.5F + rows[i].rise_m);
        NEAR(rows[i].step ? 2.9F : 1.9F, it.steps); /* a twentieth leaks */
        if (rows[i].step) {
            TEST_ASSERT_EQUAL_FLOAT(0.0F, it.way_m);
            TEST_ASSERT_EQUAL_FLOAT(1.0F, it.unmoved_s);
            TEST_ASSERT_EQUAL_FLOAT(0.06F, it.rise_mps);
            NEAR(0.1F * rows[i].felt_mps, it.felt.seen_m); /* taken as if the witness had been right */
            NEAR(0.1F * rows[i].pushed_mps, it.pushed.seen_m);
        } else {
            NEAR(0.054F + rows[i].rise_m, it.way_m);
        }
    }
}

void test_witnesses_that_have_not_begun_explain_nothing(void)
{
    hover();
    height(0.615F);
    NEAR(1.0F, it.steps);
    hover();
    height(0.595F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.steps);
    setUp();
    height(0.9F); /* the first height */
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.steps);
    TEST_ASSERT_TRUE(it.has_height);
}

void test_heights_that_have_moved_are_remembered_for_a_second(void)
{
    hover();
    it.way_m = 0.2F;
    height(0.5F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.unmoved_s);
    it.way_m = 0.0F;
    height(0.5F);
    NEAR(0.1F, it.unmoved_s);
    for (int i = 0; i < 10; i++) {
        height(0.5F);
    }
    TEST_ASSERT_EQUAL_FLOAT(1.0F, it.unmoved_s);
}

/* ---- unconfirmed and terrain_fell */

void test_a_step_towards_the_vehicle_is_unconfirmed_until_twelve_centimetres_of_climb(void)
{
    hover();
    it.quiet_s = 0.3F;
    height(0.3F);
    TEST_ASSERT_TRUE(integrity_unconfirmed(&it));
    TEST_ASSERT_EQUAL_FLOAT(0.3F, it.near_m);
    height(0.36F);
    height(0.419F);
    TEST_ASSERT_TRUE(integrity_unconfirmed(&it));
    height(0.421F);
    TEST_ASSERT_FALSE(integrity_unconfirmed(&it));
}

void test_a_step_away_from_the_vehicle_confirms_at_once(void)
{
    hover();
    it.unconfirmed = true;
    it.near_m = 5.0F;
    height(0.595F);
    TEST_ASSERT_TRUE(it.unconfirmed);
    height(0.70F);
    TEST_ASSERT_FALSE(it.unconfirmed);
}

void test_a_law_that_is_content_for_a_second_confirms(void)
{
    for (int i = 0; i < 2; i++) {
        hover();
        it.unconfirmed = true;
        it.quiet_s = (i == 0) ? 1.0F : 1.01F;
        height(0.5F);
        TEST_ASSERT_EQUAL(i == 0, it.unconfirmed);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, it.quiet_s); /* the law wants to climb */
    }
}

void test_a_slant_of_noise_is_no_contentment(void)
{
    for (uint16_t still = 0U; still < 2U; still++) {
        hover();
        it.quiet_s = 0.2F;
        it.still = still;
        flown.wanted_m = 0.0F;
        height(0.5F);
        NEAR(still == 0U ? 0.3F : 0.0F, it.quiet_s);
    }
}

void test_scans_of_noise_count_while_the_tilt_sways_and_others_count_back(void)
{
    static const struct {
        uint16_t before, after;
        float noise_mm, sway_rad2;
    } rows[] = {{5U, 6U, 5.0F, 4.1e-4F},   {5U, 4U, 9.0F, 4.1e-4F}, {0U, 0U, 9.0F, 4.1e-4F},
                {40U, 40U, 5.0F, 4.1e-4F}, {5U, 0U, 5.0F, 4.0e-4F}, {5U, 0U, 9.0F, 4.0e-4F}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        white_before = rows[i].before;
        sway_before_rad2 = rows[i].sway_rad2;
        scan_of(0.0F, rows[i].noise_mm);
        TEST_ASSERT_EQUAL_UINT16(rows[i].after, it.white);
    }
    for (int low = 0; low < 2; low++) { /* so low the vehicle may touch the ground */
        white_before = 5U;
        sway_before_rad2 = 4.1e-4F;
        scan_height_m = (low == 0) ? 0.081F : 0.079F;
        scan_of(0.0F, 5.0F);
        TEST_ASSERT_EQUAL_UINT16((low == 0) ? 6U : 0U, it.white);
    }
    white_before = 0U;
    sway_before_rad2 = 0.0F;
    scan_height_m = 0.5F;
}

void test_a_slant_with_a_step_in_it_proves_no_contentment_until_twelve_scans_later(void)
{
    static const struct {
        uint16_t scans;
        float quiet_s;
    } rows[] = {{0U, 0.3F}, {1U, 0.0F}, {11U, 0.0F}, {12U, 0.3F}};
    for (int i = 0; i < 4; i++) {
        hover();
        it.quiet_s = 0.2F;
        it.scans = rows[i].scans;
        flown.wanted_m = 0.0F;
        height(0.5F);
        NEAR(rows[i].quiet_s, it.quiet_s);
    }
}

void test_a_step_restarts_the_slants_and_a_sensor_without_spread_has_none(void)
{
    static const struct {
        float height_m;
        uint16_t before, after;
    } rows[] = {{0.7F, 12U, 1U}, {0.3F, 12U, 1U}, {0.55F, 12U, 12U}, {0.7F, 0U, 0U}};
    for (int i = 0; i < 4; i++) {
        hover();
        it.scans = rows[i].before;
        height(rows[i].height_m);
        TEST_ASSERT_EQUAL_UINT16(rows[i].after, it.scans);
    }
}

void test_the_ground_is_the_latest_height_in_state_ground_but_none_that_a_pilot_lifts_it_to(void)
{
    static const struct {
        bool grounded;
        float height_m, ground_m;
    } rows[] = {{true, -0.02F, -0.02F}, {true, 0.01F, 0.0F}, {true, 0.9F, 0.0F}, {false, -0.02F, -0.01F}};
    for (int i = 0; i < 4; i++) {
        hover();
        flown.grounded = rows[i].grounded;
        flown.standing = true;
        it.ground_m = -0.01F;
        height(rows[i].height_m);
        NEAR(rows[i].ground_m, it.ground_m);
    }
}

void test_a_jump_upwards_is_no_first_climb(void)
{
    for (int proved = 0; proved < 2; proved++) {
        hover();
        it.unconfirmed = true;
        it.proved = proved != 0;
        height(0.7F);
        TEST_ASSERT_EQUAL(proved == 0, it.unconfirmed);
        NEAR(proved == 0 ? 0.7F : 0.5F, it.near_m);
    }
}

void test_a_step_towards_the_vehicle_forgets_that_the_heights_showed_more(void)
{
    for (int sinks = 0; sinks < 2; sinks++) {
        hover();
        it.felt.running_s = it.pushed.running_s = 2.0F;
        it.felt.off_m = (sinks == 0) ? 0.2F : -0.2F;
        it.pushed.off_m = (sinks == 0) ? 0.3F : -0.3F;
        height(0.3F);
        TEST_ASSERT_TRUE(it.unconfirmed);
        TEST_ASSERT_FLOAT_WITHIN(0.002F, (sinks == 0) ? 0.0F : -0.164F, it.felt.off_m); /* 1.8 1/s of 0.1 s */
        TEST_ASSERT_FLOAT_WITHIN(0.002F, (sinks == 0) ? 0.0F : -0.288F, it.pushed.off_m); /* 0.4 1/s */
    }
}

void test_the_speed_of_the_slower_witness_lags_by_a_third_per_scan(void)
{
    for (int row = 0; row < 2; row++) {
        hover();
        it.slower_mps = 0.1F;
        it.felt = (witness_t){.speed_mps = (row == 0) ? 0.4F : 1.0F, .running_s = 0.1F};
        it.pushed = (witness_t){.speed_mps = (row == 0) ? 1.0F : 0.4F, .running_s = 0.1F};
        height(0.5F);
        TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.2F, it.slower_mps);
    }
}

void test_corrections_by_the_heights_are_summed_and_fade_in_two_seconds(void)
{
    hover();
    it.felt = (witness_t){.running_s = 2.0F};
    it.felt.off_m = 0.3F;
    it.pulled_m_s = 0.4F;
    height(0.5F);
    TEST_ASSERT_FLOAT_WITHIN(0.0005F, 0.4F + 0.1F * 0.3F - 0.4F * 0.1F / 2.0F, it.pulled_m_s);
    it.doubts = DOUBT_SIGHT;
    it.felt.off_m = 0.3F;
    height(0.5F);
    TEST_ASSERT_FLOAT_WITHIN(0.0005F, 0.41F * 0.95F, it.pulled_m_s);
}

void test_heights_and_accelerometer_are_apart_by_half_a_metre_per_second(void)
{
    static const struct {
        float felt_mps, rise_mps, shaken, running_s;
        uint16_t doubts;
        bool apart;
    } rows[] = {{0.51F, 0.0F, 1.0F, 1.0F, 0U, true},        {0.50F, 0.0F, 1.0F, 1.0F, 0U, false},
                {-0.51F, 0.0F, 1.0F, 1.0F, 0U, true},       {0.0F, 0.51F, 1.0F, 1.0F, 0U, true},
                {0.51F, 0.02F, 1.0F, 1.0F, 0U, false},      {0.51F, 0.0F, 1.1F, 1.0F, 0U, false},
                {0.56F, 0.0F, 1.1F, 1.0F, 0U, true},        {0.51F, 0.0F, 1.0F, 0.5F, 0U, false},
                {0.51F, 0.0F, 1.0F, 1.0F, DOUBT_IMU, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        it.felt = (witness_t){.speed_mps = rows[i].felt_mps, .running_s = rows[i].running_s};
        it.rise_mps = rows[i].rise_mps;
        it.shaken = rows[i].shaken;
        it.doubts = rows[i].doubts;
        TEST_ASSERT_EQUAL(rows[i].apart, integrity_apart(&it));
    }
}

void test_a_law_is_content_below_a_decimetre_of_wanted_climb(void)
{
    static const float rows[][2] = {{0.09F, 0.3F}, {0.10F, 0.0F}, {0.2F, 0.0F}, {-1.0F, 0.3F}, {NAN, 0.0F}};
    for (int i = 0; i < 5; i++) {
        hover();
        it.quiet_s = 0.2F;
        flown.wanted_m = rows[i][0];
        height(0.5F);
        NEAR(rows[i][1], it.quiet_s);
    }
}

void test_the_first_climb_proves_the_heights_and_starts_the_pushed_speed_from_them(void)
{
    hover();
    it.proved = false;
    it.unconfirmed = true;
    it.near_m = 0.4F;
    it.pushed = (witness_t){.speed_mps = 2.0F, .off_m = 0.3F, .running_s = 1.0F};
    it.rise_mps = 0.25F;
    it.felt.off_m = 0.2F;
    height(0.521F);
    TEST_ASSERT_TRUE(it.proved);
    NEAR(0.25F, it.pushed.speed_mps);
    NEAR(0.021F, it.pushed.seen_m);
    NEAR(0.021F, it.felt.seen_m);
    hover();
    it.unconfirmed = true; /* proved before: the witness knows better */
    it.near_m = 0.3F;
    it.pushed = (witness_t){.speed_mps = 2.0F, .running_s = 1.0F};
    height(0.5F);
    TEST_ASSERT_EQUAL_FLOAT(2.0F, it.pushed.speed_mps);
}

void test_standing_takes_the_proof_back(void)
{
    hover();
    it.standing = true;
    it.terrain_fell = true;
    height(0.5F);
    TEST_ASSERT_FALSE(it.proved);
    TEST_ASSERT_FALSE(it.terrain_fell);
    TEST_ASSERT_TRUE(it.unconfirmed);
}

/* The height falls back to back_m, after_s after a step up from 0.5 to 0.8 m. */
static bool unconfirmed_after(float back_m, int heights)
{
    hover();
    height(0.8F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.since_rise_s);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, it.before_rise_m);
    for (int i = 1; i < heights; i++) {
        height(0.8F);
        NEAR(0.1F * (float)i, it.since_rise_s);
    }
    height(back_m);
    return it.unconfirmed;
}

void test_a_glitch_is_short_and_ends_where_it_began(void)
{
    TEST_ASSERT_FALSE(unconfirmed_after(0.5F, 1));
    TEST_ASSERT_FALSE(unconfirmed_after(0.595F, 1));
    TEST_ASSERT_TRUE(unconfirmed_after(0.605F, 1));
    TEST_ASSERT_FALSE(unconfirmed_after(0.405F, 1));
    TEST_ASSERT_TRUE(unconfirmed_after(0.395F, 1));
    TEST_ASSERT_FALSE(unconfirmed_after(0.5F, 3));
    TEST_ASSERT_TRUE(unconfirmed_after(0.5F, 4));
    for (int i = 0; i < 20; i++) {
        height(0.5F);
    }
    TEST_ASSERT_EQUAL_FLOAT(1.5F, it.since_rise_s);
}

void test_deep_is_a_fall_of_the_terrain_beyond_forty_centimetres(void)
{
    hover();
    height(0.895F);
    TEST_ASSERT_FALSE(integrity_terrain_fell(&it));
    hover();
    height(0.905F);
    TEST_ASSERT_TRUE(integrity_terrain_fell(&it));
    height(0.84F);
    height(0.786F);
    TEST_ASSERT_TRUE(integrity_terrain_fell(&it));
    height(0.784F);
    TEST_ASSERT_FALSE(integrity_terrain_fell(&it));
    hover();
    it.terrain_fell = true;
    height(0.2F); /* a step back */
    TEST_ASSERT_FALSE(integrity_terrain_fell(&it));
}

void test_the_least_felt_error_is_kept_while_unconfirmed(void)
{
    hover();
    it.unconfirmed = true;
    it.felt_least_m = -0.05F;
    it.felt.off_m = -0.1F;
    height(0.5F);
    NEAR(-0.1F, it.felt_least_m);
    it.felt.off_m = 0.1F;
    height(0.5F);
    NEAR(-0.1F, it.felt_least_m);
    it.unconfirmed = false;
    height(0.5F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.felt_least_m);
}

/* ---- at the limits themselves: a frame or a height of the same instant moves no sum */

static void feel_at_once(float up_mps2)
{
    frame.arrival_us -= 25000U;
    feel(up_mps2);
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
        it.doubts = rows[i].doubts;
        it.rested_s = rows[i].rested_s;
        it.rest_mps2 = rows[i].rest_mps2;
        feel_at_once(rows[i].rest_mps2);
        TEST_ASSERT_EQUAL_UINT16(rows[i].then, it.doubts);
    }
}

void test_a_fall_and_a_rock_begin_beyond_their_limits(void)
{
    lie_still(-0.4F, -0.2F, 0.5F);
    feel_at_once(0.0F);
    NEAR(0.5F, it.still_s);
    lie_still(0.0F, -0.8F, 0.5F);
    it.still_mps[1] = -0.8F;
    feel_at_once(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.stands_s);
    setUp();
    feel(0.0F);
    rock(0.017F, -0.017F);
    NEAR(0.05F, it.unrocked_s);
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
    integrity_frames(&it, &flown, frames, 3U);
    NEAR(0.0625F, it.felt.speed_mps);
    TEST_ASSERT_EQUAL_UINT32(4U, it.frame_sequence);
    for (int i = 0; i < 3; i++) {
        frames[i].level.roll_rad = frames[i].median.roll_rad = 0.8F;
    }
    integrity_tilt(&it, frames, 3U, 0.0F, 0.0F, 0U);
    TEST_ASSERT_EQUAL_UINT16(3U, it.tilted);
    TEST_ASSERT_EQUAL_UINT32(4U, it.tilt_sequence);
}

void test_a_glitch_of_a_quarter_of_a_second_is_none(void)
{
    for (int late = 0; late < 2; late++) {
        hover();
        it.since_rise_s = (late != 0) ? 0.25F : 0.249F;
        it.before_rise_m = 0.3F;
        height(0.3F);
        TEST_ASSERT_EQUAL(late != 0, it.unconfirmed);
    }
    hover();
    height(0.8F);
    integrity_height(&it, &flown, 0.81F, 0.0005F, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, it.before_rise_m); /* however soon the next height comes */
}

void test_a_rate_is_of_ten_milliseconds_at_least(void)
{
    hover();
    integrity_height(&it, &flown, 0.511F, 0.011F, 0.0F);
    NEAR(0.011F / 0.211F, it.rise_mps);
    hover();
    integrity_height(&it, &flown, 0.505F, 0.005F, 0.0F);
    NEAR(0.5F * 0.005F / 0.205F, it.rise_mps);
}

void test_the_end_of_the_depth_lies_below_its_limit(void)
{
    hover();
    it.terrain_fell = true;
    it.after_fall_m = 0.12F;
    it.height_m = 0.05F;
    height(0.0F);
    TEST_ASSERT_TRUE(integrity_terrain_fell(&it));
    height(-0.001F);
    TEST_ASSERT_FALSE(integrity_terrain_fell(&it));
}

/* ---- in somebody's hands, and after a gap */

/* On the ground without a height, and the tilt sways as in the air. */
static void carry(float unseen_s, float sway_rad2)
{
    setUp();
    flown.grounded = true;
    feel(0.0F);
    it.unseen_s = unseen_s;
    it.sway_rad2 = it.swing_rad2 = sway_rad2;
    it.unrocked_s = 0.0F;
    it.carried_s = 0.5F;
    it.rested_s = 1.0F;
    it.rest_mps2 = it.bias_mps2 = 0.3F;
    it.kept_bias_mps2[0] = 0.1F;
    it.kept_bias_mps2[1] = 0.2F;
    it.felt.speed_mps = 0.4F;
}

void test_a_vehicle_that_sways_without_heights_is_carried_and_does_not_rest(void)
{
    carry(1.48F, 5.0e-4F);
    feel(2.0F); /* on the mean 1 m/s2 */
    NEAR(0.525F, it.carried_s);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.rested_s);
    NEAR(0.4F + 0.9F * 0.025F - 0.4F * 0.025F / 2.0F, it.felt.speed_mps);
    VERY_NEAR(0.1F + 0.9F * 0.025F / 20.0F, it.bias_mps2); /* the one kept from before */
    feel(2.0F);
    VERY_NEAR(0.1F + 0.9F * 0.025F / 20.0F + (2.0F - 0.101125F) * 0.025F / 20.0F, it.bias_mps2);
    carry(1.47F, 5.0e-4F);
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.carried_s);
    NEAR(1.025F, it.rested_s);
    NEAR(1.495F, it.unseen_s);
    carry(1.9F, 3.9e-4F);
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.carried_s);
}

void test_who_tilts_it_by_hand_does_not_fly_it(void)
{
    carry(1.9F, 0.0121F);
    feel(0.0F);
    NEAR(0.525F, it.carried_s); /* a 60th of the sway is forgotten with each frame */
    carry(1.9F, 0.0123F);
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.carried_s);
    it.carried_s = 1.5F;
    TEST_ASSERT_FALSE(integrity_carried(&it));
    it.carried_s = 1.51F;
    TEST_ASSERT_TRUE(integrity_carried(&it));
    carry(1.9F, 5.0e-4F);
    it.carried_s = 1.99F;
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(2.0F, it.carried_s);
    it.unseen_s = 1.99F;
    feel(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(2.0F, it.unseen_s);
    height(0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.unseen_s);
}

void test_the_bias_of_three_to_four_seconds_ago_is_kept(void)
{
    carry(0.0F, 0.0F);
    it.block_s = 0.97F;
    feel(0.3F);
    NEAR(0.995F, it.block_s);
    NEAR(0.1F, it.kept_bias_mps2[0]);
    feel(0.3F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, it.block_s);
    NEAR(0.2F, it.kept_bias_mps2[0]);
    NEAR(0.0F, it.kept_bias_mps2[2]);
    NEAR(0.3F, it.kept_bias_mps2[3]);
}

void test_after_a_gap_the_thrusts_witness_tells_speed_and_way(void)
{
    it.rise_mps = 0.15F;
    it.pushed = (witness_t){.speed_mps = 0.5F, .off_m = 0.1F, .seen_m = 0.3F, .running_s = 0.51F};
    NEAR(0.5F + 0.4F * 0.3F, integrity_pushed_mps(&it));
    NEAR(0.2F, integrity_moved_m(&it));
    it.pushed.running_s = 0.5F;
    NEAR(0.15F, integrity_pushed_mps(&it));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, integrity_moved_m(&it));
}

void test_a_frame_without_accelerations_tells_the_sway_too(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        setUp();
        feel(0.0F);
        const uint32_t sequence = it.frame_sequence;
        frame.has_acceleration = false;
        frame.arrival_us = 1000000U;
        feel(5.0F);
        TEST_ASSERT_EQUAL_UINT32(sequence + 1U, it.frame_sequence);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, it.sway_rad2); /* the first after long */
        frame.median.roll_rad = 0.06F;
        frame.arrival_us += 275000U + more_us;
        feel(5.0F);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-7F, (more_us == 0U) ? 0.2F * 0.0036F : 0.0F, it.sway_rad2);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, it.felt.speed_mps);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, it.up_mps2);
    }
}
