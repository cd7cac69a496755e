#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

static bool accepts(float height_mm)
{
    const altitude_t altitude = {.height_mm = height_mm};

    return senses_scan(&senses, &altitude);
}

void test_the_lower_limit_of_a_height_belongs_to_it(void)
{
    TEST_ASSERT_TRUE(accepts(-50.0F));
    TEST_ASSERT_FALSE(accepts(-50.1F));
}

void test_what_is_no_number_is_no_height_and_the_next_height_is_one(void)
{
    static const float odd_mm[] = {NAN, -INFINITY};

    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_FALSE(accepts(odd_mm[i]));
        TEST_ASSERT_TRUE(accepts(500.0F));
    }
}

/* Three sigma of 6.4 mm higher, 19.2 mm. */
void test_a_height_below_the_ground_counts_again_when_no_noise_explains_it(void)
{
    TEST_ASSERT_FALSE(accepts(-50.1F));
    TEST_ASSERT_TRUE(senses.beam.below_ground);
    TEST_ASSERT_FALSE(accepts(-30.9F));
    TEST_ASSERT_TRUE(accepts(-30.7F));
    TEST_ASSERT_FALSE(senses.beam.below_ground);
    TEST_ASSERT_TRUE(accepts(-50.0F));
}
