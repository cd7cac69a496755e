#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

static uint16_t white_before;

static float sway_before_rad2;

/* The twelfth scan: a ramp of slope_mm a scan, and noise_mm to either side by turns. */
static float scan_height_m = 0.5F;

static void scan_of(float slope_mm, float noise_mm)
{
    float slants_mm[BEAM_SCANS];
    for (int k = 0; k < (int)BEAM_SCANS; k++) {
        slants_mm[k] = 700.0F + slope_mm * ((float)k - 5.5F) + ((k % 2 == 0) ? noise_mm : -noise_mm);
    }
    setUp();
    senses.beam.slants_mm[0] = 99.0F; /* drops out */
    memcpy(senses.beam.slants_mm + 1, slants_mm, sizeof slants_mm - sizeof slants_mm[0]);
    slants_known(BEAM_SCANS - 1U);
    white_scans(white_before);
    at_m(scan_height_m);
    sways_rad2(sway_before_rad2);
    TEST_ASSERT_TRUE(senses_scan(&senses, &(altitude_t){.height_mm = 500.0F,
                                                        .slant_mm = slants_mm[BEAM_SCANS - 1U],
                                                        .good_rays = 35U,
                                                        .spread_mm = 9.0F}));
    TEST_ASSERT_EQUAL_UINT16(BEAM_SCANS, senses.beam.scans);
}

/* The sample variance of noise a by turns is 12/11 a2. */
void test_a_slant_below_two_millimetres_rms_is_rigid(void)
{
    scan_of(0.0F, 1.90F);
    TEST_ASSERT_EQUAL_UINT16(1U, senses.beam.rigid);
    TEST_ASSERT_EQUAL_UINT16(1U, senses.beam.still);
    scan_of(0.0F, 1.93F);
    TEST_ASSERT_EQUAL_UINT16(0U, senses.beam.rigid);
    TEST_ASSERT_EQUAL_UINT16(1U, senses.beam.still);
    scan_of(0.5F, 0.1F); /* rigid, and hardly noise */
    TEST_ASSERT_EQUAL_UINT16(1U, senses.beam.rigid);
    TEST_ASSERT_EQUAL_UINT16(1U, senses.beam.still);
}

void test_a_slant_beyond_eight_millimetres_rms_is_not_still(void)
{
    scan_of(0.0F, 7.6F);
    TEST_ASSERT_EQUAL_UINT16(1U, senses.beam.still);
    scan_of(0.0F, 7.7F);
    TEST_ASSERT_EQUAL_UINT16(0U, senses.beam.still);
}

/* Noise by second differences 16/6 a2; variance with a ramp s (143 s2 + 12 a2 - 12 a s) / 11. With a = 2 mm
 * the noise is 0.4 of it at s = 1.396 mm. */
void test_a_slant_is_still_when_noise_makes_two_fifths_of_its_variance(void)
{
    scan_of(1.38F, 2.0F);
    TEST_ASSERT_EQUAL_UINT16(1U, senses.beam.still);
    TEST_ASSERT_EQUAL_UINT16(0U, senses.beam.rigid);
    scan_of(1.41F, 2.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, senses.beam.still);
}

void test_less_than_twelve_scans_say_nothing_and_a_moving_one_begins_anew(void)
{
    for (int scan = 1; scan <= 40; scan++) {
        const altitude_t altitude = {
            .height_mm = 500.0F, .slant_mm = 700.0F, .good_rays = 35U, .spread_mm = 9.0F + (float)(scan % 2)};
        TEST_ASSERT_TRUE(senses_scan(&senses, &altitude));
        const int still = (scan < 12) ? 0 : (scan < 27) ? scan - 11 : 16;
        TEST_ASSERT_EQUAL_UINT16(still, senses.beam.still);
        TEST_ASSERT_EQUAL_UINT16(still, senses.beam.rigid);
        TEST_ASSERT_EQUAL(still > 8, beam_is_still(&senses.beam));
    }
    TEST_ASSERT_TRUE(
        senses_scan(&senses, &(altitude_t){.slant_mm = 800.0F, .good_rays = 35U, .spread_mm = 9.0F}));
    TEST_ASSERT_EQUAL_UINT16(0U, senses.beam.still);
    TEST_ASSERT_EQUAL_UINT16(0U, senses.beam.rigid);
}

void test_a_group_that_repeats_every_digit_is_a_copy_also_without_a_spread(void)
{
    const altitude_t altitude = {.height_mm = 500.0F, .slant_mm = 700.0F, .good_rays = 2U};
    TEST_ASSERT_TRUE(senses_scan(&senses, &altitude));
    TEST_ASSERT_FALSE(senses_scan(&senses, &altitude));
    TEST_ASSERT_EQUAL_UINT16(2U, senses.beam.scans);
}

void test_heights_out_of_reach_leave_the_slants_alone(void)
{
    static const float heights_mm[] = {-5001.0F, 5001.0F, NAN, -5000.0F, 5000.0F};
    for (int i = 0; i < 5; i++) {
        (void)senses_scan(&senses, &(altitude_t){.height_mm = heights_mm[i],
                                                 .slant_mm = (float)i,
                                                 .good_rays = 35U,
                                                 .spread_mm = 1.0F});
        TEST_ASSERT_EQUAL_UINT16((i < 3) ? 0 : i - 2, senses.beam.scans);
    }
}

void test_the_limits_of_a_height_belong_to_it(void)
{
    TEST_ASSERT_TRUE(senses_scan(&senses, &(altitude_t){.height_mm = 5000.0F}));
    TEST_ASSERT_TRUE(senses_scan(&senses, &(altitude_t){.height_mm = -50.0F}));
    TEST_ASSERT_FALSE(senses_scan(&senses, &(altitude_t){.height_mm = -50.1F}));
    TEST_ASSERT_TRUE(senses.beam.below_ground);
    TEST_ASSERT_TRUE(senses_scan(&senses, &(altitude_t){.height_mm = -30.79F})); /* 19.2 mm higher */
    TEST_ASSERT_FALSE(senses.beam.below_ground);
}

void test_a_copy_is_refused_however_often_it_comes_and_another_scan_is_not(void)
{
    altitude_t altitude = {.height_mm = 500.0F, .slant_mm = 700.0F, .good_rays = 35U, .spread_mm = 9.0F};

    TEST_ASSERT_TRUE(senses_scan(&senses, &altitude));
    for (uint32_t i = 0; i < 70000U; i++) { /* more than a counter of 16 bits holds */
        TEST_ASSERT_FALSE(senses_scan(&senses, &altitude));
    }
    altitude.spread_mm = 8.0F;
    TEST_ASSERT_TRUE(senses_scan(&senses, &altitude));
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
        TEST_ASSERT_EQUAL_UINT16(rows[i].after, senses.beam.white);
    }
    for (int low = 0; low < 2; low++) { /* so low the vehicle may touch the ground */
        white_before = 5U;
        sway_before_rad2 = 4.1e-4F;
        scan_height_m = (low == 0) ? 0.091F : 0.089F;
        scan_of(0.0F, 5.0F);
        TEST_ASSERT_EQUAL_UINT16((low == 0) ? 6U : 0U, senses.beam.white);
    }
    white_before = 0U;
    sway_before_rad2 = 0.0F;
    scan_height_m = 0.5F;
}

void test_a_step_restarts_the_slants_and_a_sensor_without_spread_has_none(void)
{
    static const struct {
        float height_m;
        uint16_t before, after;
    } rows[] = {{0.7F, 12U, 1U}, {0.3F, 12U, 1U}, {0.55F, 12U, 12U}, {0.7F, 0U, 0U}};
    for (int i = 0; i < 4; i++) {
        hover();
        slants_known(rows[i].before);
        height(rows[i].height_m);
        TEST_ASSERT_EQUAL_UINT16(rows[i].after, senses.beam.scans);
    }
}
