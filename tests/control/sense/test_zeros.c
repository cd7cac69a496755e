/* What three mirrors show of a vehicle that stands, or that somebody holds. */
#include "control/sense/zeros.h"

#include "unity.h"

#define FRONT (1U << MIRROR_FRONT)
#define FORE (1U << MIRROR_FORE)
#define AFT (1U << MIRROR_AFT)

static zeros_t zeros;
static altitude_t shown[MIRROR_COUNT];

void setUp(void)
{
    zeros = (zeros_t){.wrong = 0U};
    for (int m = 0; m < MIRROR_COUNT; m++) {
        shown[m] = (altitude_t){.valid = true, .distance_mm = 105.0F, .leg_mm = 100.0F};
    }
}

void tearDown(void) {}

static void heights_mm(float front, float fore, float aft)
{
    shown[MIRROR_FRONT].slant_mm = 205.0F + front;
    shown[MIRROR_FORE].slant_mm = 205.0F + fore;
    shown[MIRROR_AFT].slant_mm = 205.0F + aft;
}

static void scans(unsigned count, bool rest)
{
    for (unsigned i = 0; i < count; i++) {
        zeros_scan(&zeros, shown, rest ? ZEROS_REST : ZEROS_AWAY);
    }
}

void test_three_mirrors_that_show_the_ground_are_right_after_a_second(void)
{
    heights_mm(3.0F, -8.0F, 12.0F);
    scans(ZEROS_SCANS - 1U, true);
    TEST_ASSERT_EQUAL_UINT(0, zeros_scans(&zeros));
    scans(1, true);
    TEST_ASSERT_EQUAL_UINT(ZEROS_SCANS, zeros_scans(&zeros));
    TEST_ASSERT_EQUAL_HEX16(0, zeros.wrong);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 12.0F, zeros.zeros[MIRROR_AFT].mm);
}

/* No mirror, wrong steps: the room. Something in front. A length that is wrong, an edge. */
TEST_CASE(2400.0, 0.0, 0.0, 1)
TEST_CASE(0.0, -80.0, 0.0, 2)
TEST_CASE(0.0, 0.0, 60.0, 4)
TEST_CASE(0.0, 300.0, 300.0, 6)
TEST_CASE(5.0, 300.0, 700.0, 6)
void test_a_mirror_that_shows_something_else_is_named(double front, double fore, double aft, int wrong)
{
    heights_mm((float)front, (float)fore, (float)aft);
    scans(ZEROS_SCANS, true);
    TEST_ASSERT_EQUAL_HEX16(wrong, zeros.wrong);
    TEST_ASSERT_EQUAL_UINT(0, zeros_scans(&zeros));
}

void test_a_mirror_that_shows_nothing_is_named(void)
{
    shown[MIRROR_FORE].valid = false;
    heights_mm(0.0F, 0.0F, 0.0F);
    scans(ZEROS_SCANS, true);
    TEST_ASSERT_EQUAL_HEX16(FORE, zeros.wrong);
}

/* The mirrors are scanned one after the other: while it rises the last one shows more. */
void test_a_take_off_counts_for_the_verdict_and_not_for_the_means(void)
{
    heights_mm(2.0F, 2.0F, 300.0F);
    scans(5, true);
    heights_mm(30.0F, 45.0F, 330.0F);
    for (int i = 0; i < 5; i++) {
        zeros_scan(&zeros, shown, ZEROS_LIFTED);
    }
    TEST_ASSERT_EQUAL_HEX16(AFT, zeros.wrong);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 2.0F, zeros.zeros[MIRROR_FORE].mm);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 300.0F, zeros.zeros[MIRROR_AFT].mm);
}

/* L2 80 mm too large. */
void test_what_was_found_at_rest_is_not_taken_back_on_the_way_up(void)
{
    heights_mm(0.0F, -80.0F, 0.0F);
    scans(ZEROS_SCANS, true);
    TEST_ASSERT_EQUAL_HEX16(FORE, zeros.wrong);
    heights_mm(40.0F, -40.0F, 40.0F);
    zeros_scan(&zeros, shown, ZEROS_LIFTED);
    TEST_ASSERT_EQUAL_HEX16(FORE, zeros.wrong);
}

/* 45 and 55 mm: both within what honest ones may show of uneven ground. */
void test_mirrors_on_either_side_of_the_limit_are_both_right(void)
{
    heights_mm(45.0F, 40.0F, 55.0F);
    scans(3U * ZEROS_SCANS, true);
    TEST_ASSERT_EQUAL_HEX16(0, zeros.wrong);
}

void test_a_level_vehicle_in_the_hand_names_nothing(void)
{
    for (int i = 0; i < 300; i++) {
        const float lift = 300.0F * (float)(i % 30) / 30.0F;
        heights_mm(lift, lift + 20.0F, lift - 20.0F);
        scans(1, true);
        TEST_ASSERT_EQUAL_HEX16(0, zeros.wrong);
    }
    heights_mm(500.0F, 450.0F, 900.0F);
    scans(50, true);
    TEST_ASSERT_EQUAL_HEX16(0, zeros.wrong);
    TEST_ASSERT_EQUAL_UINT(0, zeros_scans(&zeros));
}

void test_what_was_found_is_kept_in_the_air_and_found_anew_at_the_next_rest(void)
{
    heights_mm(0.0F, 400.0F, 0.0F);
    scans(ZEROS_SCANS, true);
    heights_mm(900.0F, 900.0F, 900.0F);
    scans(40, false);
    TEST_ASSERT_EQUAL_HEX16(FORE, zeros.wrong);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 400.0F, zeros.zeros[MIRROR_FORE].mm);
    heights_mm(0.0F, 5.0F, 0.0F);
    scans(1, true);
    TEST_ASSERT_EQUAL_HEX16(0, zeros.wrong);
    scans(ZEROS_SCANS, true);
    TEST_ASSERT_TRUE(zeros_scans(&zeros) > 0U);
}

/* Carried from the edge of a box to the middle of it, without an order. */
void test_a_vehicle_that_is_put_elsewhere_is_looked_at_again(void)
{
    heights_mm(250.0F, 0.0F, 0.0F);
    scans(20, true);
    TEST_ASSERT_EQUAL_HEX16(FRONT, zeros.wrong);
    heights_mm(600.0F, 500.0F, 500.0F);
    scans(20, true);
    heights_mm(0.0F, 0.0F, 0.0F);
    scans(ZEROS_SCANS, true);
    TEST_ASSERT_EQUAL_HEX16(0, zeros.wrong);
}

/* A slope moves no height of a vehicle that stands on it: the tilt is not asked. */
void test_the_tilt_is_not_asked(void)
{
    heights_mm(0.0F, 0.0F, 0.0F);
    for (int m = 0; m < MIRROR_COUNT; m++) {
        shown[m].height_mm = -90.0F;
    }
    scans(ZEROS_SCANS, true);
    TEST_ASSERT_EQUAL_HEX16(0, zeros.wrong);
    TEST_ASSERT_EQUAL_UINT(ZEROS_SCANS, zeros_scans(&zeros));
}
