/* How long a fall of the ground must last, after falls that came back. */
#include "control/est/dips.h"
#include "unity.h"

static dips_t dips;

void setUp(void)
{
    dips = (dips_t){.since = 0U};
}

void tearDown(void) {}

static void scans(int count)
{
    for (int k = 0; k < count; k++) {
        dips_scan(&dips);
    }
}

/* A fall that is believed, and what comes back after so many scans. */
static void dip(int lasts, float fall_m, float back_m)
{
    dips_step(&dips, fall_m);
    scans(lasts);
    dips_step(&dips, back_m);
}

void test_nothing_waits_before_the_first_dip(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, dips_wait(&dips, 0.4F));
    scans(1000);
    TEST_ASSERT_EQUAL_UINT16(0U, dips_wait(&dips, 0.4F));
}

void test_a_fall_waits_as_long_as_the_dip_before_and_a_rise_never(void)
{
    for (int lasts = 1; lasts <= 6; lasts++) {
        setUp();
        dip(lasts, 0.4F, -0.4F);
        TEST_ASSERT_EQUAL_UINT16(lasts, dips_wait(&dips, 0.4F));
        TEST_ASSERT_EQUAL_UINT16(lasts, dips_wait(&dips, 0.1F));
        TEST_ASSERT_EQUAL_UINT16(0U, dips_wait(&dips, -0.4F));
    }
}

void test_ground_that_is_away_for_seven_scans_is_a_pit(void)
{
    dip(7, 0.4F, -0.4F);
    TEST_ASSERT_EQUAL_UINT16(0U, dips_wait(&dips, 0.4F));
    dip(1000, 0.4F, -0.4F);
    TEST_ASSERT_EQUAL_UINT16(0U, dips_wait(&dips, 0.4F));
}

void test_only_what_comes_back_to_within_80_mm_is_a_dip(void)
{
    static const struct {
        float back_m;
        unsigned waits;
    } rows[] = {{-0.321F, 4U}, {-0.479F, 4U}, {-0.319F, 0U}, {-0.481F, 0U}, {0.4F, 0U}};

    for (int i = 0; i < 5; i++) {
        setUp();
        dip(4, 0.4F, rows[i].back_m);
        TEST_ASSERT_EQUAL_UINT16(rows[i].waits, dips_wait(&dips, 0.4F));
    }
}

/* Tables in a row: up, and down again. */
void test_a_rise_that_goes_again_is_no_dip(void)
{
    dip(4, -0.4F, 0.4F);
    TEST_ASSERT_EQUAL_UINT16(0U, dips_wait(&dips, 0.4F));
}

void test_a_dip_that_was_not_believed_counts_and_one_wrong_height_does_not(void)
{
    dips_over(&dips, 1U, 0.4F);
    TEST_ASSERT_EQUAL_UINT16(0U, dips_wait(&dips, 0.4F));
    dips_over(&dips, 3U, -0.4F);
    TEST_ASSERT_EQUAL_UINT16(0U, dips_wait(&dips, 0.4F));
    dips_over(&dips, 2U, 0.4F);
    TEST_ASSERT_EQUAL_UINT16(2U, dips_wait(&dips, 0.4F));
    dips_over(&dips, 5U, 0.4F);
    TEST_ASSERT_EQUAL_UINT16(5U, dips_wait(&dips, 0.4F));
}

/* Whatever comes: else each wait could make the next one longer, and heights were rejected for ever. */
void test_no_wait_is_longer_than_six_scans(void)
{
    for (uint16_t rejected = 2; rejected < 60000; rejected = (uint16_t)(rejected + 1 + rejected / 4)) {
        dips_over(&dips, rejected, 0.4F);
        TEST_ASSERT_EQUAL_UINT16(rejected < 6 ? rejected : 6, dips_wait(&dips, 0.4F));
    }
}

void test_a_dip_is_forgotten_after_ten_seconds(void)
{
    dip(4, 0.4F, -0.4F);
    scans(99);
    TEST_ASSERT_EQUAL_UINT16(4U, dips_wait(&dips, 0.4F));
    scans(1);
    TEST_ASSERT_EQUAL_UINT16(0U, dips_wait(&dips, 0.4F));
}
