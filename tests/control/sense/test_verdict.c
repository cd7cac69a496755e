/* How doubts come and go, from both sides of each limit. */
#include "sense/judged.h"

void setUp(void)
{
    evidence_begin();
}

void tearDown(void) {}

/* ---- the end of a doubt */

/* A doubt, and agreement of agreed_s over a motion of moved_m. */
static uint16_t again(uint16_t doubts, float agreed_s, float moved_m, float felt_m, float pushed_m)
{
    setUp();
    doubted(doubts);
    has_agreed_s(agreed_s);
    senses.push.pushed.moved_m = moved_m;
    return judged(felt_m, pushed_m);
}

void test_agreement_of_a_second_and_a_half_over_a_motion_ends_a_doubt(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, again(DOUBT_SIGHT, 1.51F, 0.31F, 0.0F, 0.0F));
    TEST_ASSERT_EQUAL_UINT16(0U, again(DOUBT_THRUST, 1.51F, 0.31F, 0.2F, -0.2F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.seen_m);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, again(DOUBT_SIGHT | DOUBT_IMU, 1.51F, 0.31F, 0.0F, 0.0F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, again(DOUBT_SIGHT, 1.50F, 0.31F, 0.0F, 0.0F));
    TEST_ASSERT_EQUAL_FLOAT(1.5F, verdict.agreed_s);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, again(DOUBT_SIGHT, 1.51F, 0.30F, 0.0F, 0.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, verdict.agreed_s);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, again(DOUBT_SIGHT, 1.51F, 0.31F, 0.21F, 0.0F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, again(DOUBT_SIGHT, 1.51F, 0.31F, 0.0F, 0.21F));
}

void test_the_motion_is_the_accelerometers_where_the_thrust_does_not_count(void)
{
    doubted(DOUBT_SIGHT);
    has_agreed_s(1.51F);
    senses.push.pushed.running_s = 0.5F;
    senses.accelerometer.felt.moved_m = 0.31F;
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F));
    setUp();
    doubted(DOUBT_SIGHT);
    has_agreed_s(1.51F);
    senses.accelerometer.felt.moved_m = 0.31F;
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(0.0F, 0.0F));
}

void test_a_slant_of_noise_alone_does_not_agree(void)
{
    for (uint16_t still = 15U; still <= 16U; still++) {
        setUp();
        doubted(DOUBT_SIGHT);
        has_agreed_s(1.51F);
        senses.push.pushed.moved_m = 0.31F;
        still_scans(still);
        TEST_ASSERT_EQUAL_UINT16((still == 15U) ? 0U : DOUBT_SIGHT, judged(0.0F, 0.0F));
    }
}

void test_heights_that_move_end_a_doubt_of_the_sight_alone(void)
{
    static const struct {
        uint16_t doubts;
        float way_m;
        uint16_t left;
    } rows[] = {{DOUBT_SIGHT, 0.16F, 0U},
                {DOUBT_SIGHT, -0.16F, 0U},
                {DOUBT_SIGHT, 0.15F, DOUBT_SIGHT},
                {DOUBT_THRUST, 0.16F, DOUBT_THRUST},
                {DOUBT_THRUST | DOUBT_SIGHT, 0.16F, 0U}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        doubted(rows[i].doubts);
        has_moved_m(rows[i].way_m);
        TEST_ASSERT_EQUAL_UINT16(rows[i].left, judged(0.0F, 0.0F));
    }
}

/* ---- who is judged */

void test_on_the_ground_and_under_a_pilot_nothing_is_judged(void)
{
    flown.grounded = true;
    TEST_ASSERT_EQUAL_UINT16(0U, judged(-0.7F, -0.7F));
    TEST_ASSERT_EQUAL_FLOAT(-0.7F, senses.accelerometer.felt.seen_m);
    setUp();
    flown.ours = false;
    rises_mps(0.3F);
    senses.accelerometer.felt.speed_mps = 1.0F;
    TEST_ASSERT_EQUAL_UINT16(0U, judged(-0.7F, -0.7F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.push.pushed.seen_m);
    TEST_ASSERT_EQUAL_FLOAT(0.3F, senses.accelerometer.felt.speed_mps);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.running_s);
}
