#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

static bool accepts(float height_mm, float slant_mm, uint16_t good_rays, float spread_mm)
{
    const altitude_t altitude = {
        .height_mm = height_mm, .slant_mm = slant_mm, .good_rays = good_rays, .spread_mm = spread_mm};

    return senses_scan(&senses, &altitude);
}

void test_the_limits_of_a_height_belong_to_it(void)
{
    TEST_ASSERT_TRUE(accepts(5000.0F, 0.0F, 0U, 0.0F));
    TEST_ASSERT_FALSE(accepts(5000.1F, 0.0F, 0U, 0.0F));
    TEST_ASSERT_TRUE(accepts(-50.0F, 0.0F, 0U, 0.0F));
    TEST_ASSERT_FALSE(accepts(-50.1F, 0.0F, 0U, 0.0F));
}

void test_what_is_no_number_is_no_height_and_the_next_height_is_one(void)
{
    static const float odd_mm[] = {NAN, INFINITY, -INFINITY};

    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FALSE(accepts(odd_mm[i], 700.0F + (float)i, 35U, 9.0F));
        TEST_ASSERT_TRUE(accepts(500.0F, 710.0F + (float)i, 35U, 9.0F));
    }
}

/* Three sigma of 6.4 mm higher, 19.2 mm. */
void test_a_height_below_the_ground_counts_again_when_no_noise_explains_it(void)
{
    TEST_ASSERT_FALSE(accepts(-50.1F, 0.0F, 0U, 0.0F));
    TEST_ASSERT_TRUE(senses.beam.below_ground);
    TEST_ASSERT_FALSE(accepts(-30.9F, 0.0F, 0U, 0.0F));
    TEST_ASSERT_TRUE(accepts(-30.7F, 0.0F, 0U, 0.0F));
    TEST_ASSERT_FALSE(senses.beam.below_ground);
    TEST_ASSERT_TRUE(accepts(-50.0F, 0.0F, 0U, 0.0F));
}

void test_a_height_above_the_reach_is_not_below_the_ground(void)
{
    TEST_ASSERT_FALSE(accepts(5000.1F, 0.0F, 0U, 0.0F));
    TEST_ASSERT_FALSE(senses.beam.below_ground);
    TEST_ASSERT_TRUE(accepts(-50.0F, 0.0F, 0U, 0.0F));
}

void test_a_group_that_repeats_every_digit_is_a_copy_also_without_a_spread(void)
{
    TEST_ASSERT_TRUE(accepts(500.0F, 700.0F, 2U, 0.0F));
    TEST_ASSERT_FALSE(accepts(500.0F, 700.0F, 2U, 0.0F));
    TEST_ASSERT_FALSE(accepts(600.0F, 700.0F, 2U, 0.0F)); /* the tilt has changed, the scan has not */
}

void test_a_slant_or_a_spread_that_differs_is_another_scan(void)
{
    TEST_ASSERT_TRUE(accepts(500.0F, 700.0F, 35U, 9.0F));
    TEST_ASSERT_TRUE(accepts(500.0F, 700.1F, 35U, 9.0F));
    TEST_ASSERT_TRUE(accepts(500.0F, 700.1F, 35U, 9.1F));
    TEST_ASSERT_TRUE(accepts(500.0F, 700.0F, 35U, 9.0F)); /* that before the latest */
}

void test_one_ray_alone_is_no_copy_of_another(void)
{
    TEST_ASSERT_TRUE(accepts(500.0F, 700.0F, 1U, 0.0F));
    TEST_ASSERT_TRUE(accepts(500.0F, 700.0F, 1U, 0.0F));
}

void test_a_copy_is_refused_however_often_it_comes_and_another_scan_is_not(void)
{
    TEST_ASSERT_TRUE(accepts(500.0F, 700.0F, 35U, 9.0F));
    for (uint32_t i = 0; i < 70000U; i++) { /* more than a counter of 16 bits holds */
        TEST_ASSERT_FALSE(accepts(500.0F, 700.0F, 35U, 9.0F));
    }
    TEST_ASSERT_TRUE(accepts(500.0F, 700.0F, 35U, 8.0F));
}

void test_a_scan_that_is_refused_is_remembered_too(void)
{
    TEST_ASSERT_FALSE(accepts(-60.0F, 150.0F, 35U, 9.0F));
    TEST_ASSERT_FALSE(accepts(500.0F, 150.0F, 35U, 9.0F));
    TEST_ASSERT_TRUE(accepts(500.0F, 150.0F, 35U, 9.5F));
}
