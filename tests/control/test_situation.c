#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

static bool has_risen(float height_mm, float ground_m)
{
    at_mm(height_mm);
    ground_was_at_m(ground_m);
    return situation_is_risen(&where, &est);
}

void test_it_has_risen_when_it_is_nine_centimetres_above_what_was_measured_on_the_ground(void)
{
    TEST_ASSERT_TRUE(has_risen(91.0F, 0.0F));
    TEST_ASSERT_FALSE(has_risen(89.0F, 0.0F));
    TEST_ASSERT_FALSE(has_risen(389.0F, 0.3F)); /* something blocked the beam there */
    TEST_ASSERT_TRUE(has_risen(391.0F, 0.3F));
    TEST_ASSERT_TRUE(has_risen(71.0F, -0.02F));
    TEST_ASSERT_FALSE(has_risen(69.0F, -0.02F));
    TEST_ASSERT_FALSE(has_risen(-5.0F, 0.0F));
}

void test_a_tilt_rocks_while_an_imu_says_so(void)
{
    static const struct {
        bool sways, heard, rocks;
    } rows[] = {{true, true, true}, {false, true, false}, {true, false, false}, {false, false, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        sway(rows[i].sways);
        frame_was_s_ago(rows[i].heard ? 0.0F : 1.0F);
        TEST_ASSERT_EQUAL(rows[i].rocks, situation_is_rocking(&evidence, &est));
    }
}
