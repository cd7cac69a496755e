#include "control/sense/stand.h"
#include "unity.h"

#include <string.h>

#define FRAME_S 0.025F

static stand_t stand;
static witness_t felt, pushed;

/* Both witnesses count. */
void setUp(void)
{
    memset(&stand, 0, sizeof stand);
    felt = pushed = (witness_t){.running_s = 2.0F};
}

void tearDown(void) {}

/* So many calm frames with these speeds. */
static void lie(int frames, float felt_mps, float pushed_mps)
{
    felt.speed_mps = felt_mps;
    pushed.speed_mps = pushed_mps;
    for (int i = 0; i < frames; i++) {
        stand_frame(&stand, &felt, &pushed, true, FRAME_S);
    }
}

void test_it_may_stand_when_the_tilt_has_been_calm_for_a_second(void)
{
    lie(39, 0.0F, 0.0F);
    TEST_ASSERT_FALSE(stand_is_possible(&stand));
    lie(2, 0.0F, 0.0F);
    TEST_ASSERT_TRUE(stand_is_possible(&stand));
    stand_frame(&stand, &felt, &pushed, false, FRAME_S);
    TEST_ASSERT_FALSE(stand_is_possible(&stand));
    lie(39, 0.0F, 0.0F);
    TEST_ASSERT_FALSE(stand_is_possible(&stand));
}

void test_it_stands_while_the_thrust_says_a_fall_of_0_8_that_is_not_felt_for_0_6_s(void)
{
    static const struct {
        float felt_mps, pushed_mps;
        bool stands;
    } rows[] = {{0.0F, -0.81F, true},  {0.0F, -0.79F, false}, {-0.1F, -0.89F, false},
                {-0.1F, -0.91F, true}, {0.5F, -0.79F, false}, {0.0F, 0.81F, false}};
    for (int i = 0; i < 6; i++) {
        setUp();
        lie(23, rows[i].felt_mps, rows[i].pushed_mps);
        TEST_ASSERT_FALSE(stand_is_sure(&stand));
        lie(2, rows[i].felt_mps, rows[i].pushed_mps);
        TEST_ASSERT_EQUAL(rows[i].stands, stand_is_sure(&stand));
    }
}

void test_a_sway_or_a_witness_that_does_not_count_ends_the_standing(void)
{
    for (int what = 0; what < 4; what++) {
        setUp();
        lie(30, 0.0F, -0.9F);
        TEST_ASSERT_TRUE(stand_is_sure(&stand));
        felt.running_s = (what == 1) ? 0.5F : 0.51F;
        pushed.running_s = (what == 2) ? 0.5F : 0.51F;
        stand_frame(&stand, &felt, &pushed, what != 3, FRAME_S);
        TEST_ASSERT_EQUAL(what == 0, stand_is_sure(&stand));
    }
}

void test_a_felt_fall_of_0_4_begins_the_calm_anew(void)
{
    for (int fell = 0; fell < 2; fell++) {
        setUp();
        lie(60, 0.0F, 0.0F);
        lie(1, (fell != 0) ? -0.42F : -0.38F, 0.0F);
        TEST_ASSERT_EQUAL(fell == 0, stand_is_possible(&stand));
    }
}

/* The speeds that are compared follow within two seconds: 0.16 m/s2 stay 0.32 m/s behind. */
void test_a_drift_of_the_felt_speed_is_no_fall(void)
{
    for (int i = 0; i < 400; i++) {
        lie(1, -0.004F * (float)i, 0.0F);
        TEST_ASSERT_EQUAL(i >= 40, stand_is_possible(&stand));
    }
    setUp();
    for (int i = 0; i < 200; i++) {
        lie(1, -0.02F * (float)i, 0.0F);
        TEST_ASSERT_FALSE(stand_is_possible(&stand));
    }
}
