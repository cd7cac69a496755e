/* Which heights are used, at each bound from both sides. The estimator's own tests have the heights of a
 * vehicle. */
#include "control/est/innovation.h"
#include "unity.h"

#define SURE_M2 1.0e-6F /* 1 mm: the least bound counts, 53 mm */
#define SMOOTH_M 0.004F

static innovation_test_t test;

void setUp(void)
{
    test = (innovation_test_t){.rejected = 0U};
}

void tearDown(void) {}

static height_outcome_t see(float innovation_m, uint16_t ground)
{
    return innovation_test(&test, innovation_m, SURE_M2, SMOOTH_M, ground);
}

void test_the_bound_is_3_sigmas_but_53_mm_at_least_and_80_mm_at_most(void)
{
    static const struct {
        float sigma_m, bound_m;
    } bounds[] = {{0.001F, 0.053F}, {0.017F, 0.053F}, {0.02F, 0.06F}, {0.026F, 0.078F}, {0.2F, 0.08F}};

    for (unsigned i = 0; i < sizeof bounds / sizeof bounds[0]; i++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const float bound_m = (float)sign * bounds[i].bound_m;
            const float variance_m2 = bounds[i].sigma_m * bounds[i].sigma_m;

            setUp();
            TEST_ASSERT_EQUAL(HEIGHT_FUSED,
                              innovation_test(&test, 0.999F * bound_m, variance_m2, SMOOTH_M, 0U));
            TEST_ASSERT_EQUAL(HEIGHT_REJECTED,
                              innovation_test(&test, 1.001F * bound_m, variance_m2, SMOOTH_M, 0U));
        }
    }
}

void test_over_a_rough_floor_six_of_its_sigmas_are_used(void)
{
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, innovation_test(&test, 0.119F, SURE_M2, 0.02F, 0U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, innovation_test(&test, 0.121F, SURE_M2, 0.02F, 0U));
}

void test_over_the_same_ground_any_height_is_used_in_the_first_scan(void)
{
    for (float innovation_m = -3.0F; innovation_m <= 3.0F; innovation_m += 0.25F) {
        setUp();
        TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.0F, 7U));
        TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(innovation_m, 7U));
        TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(innovation_m, 7U));
    }
}

/* A scan between may have stepped, and was rejected: the next one stands on that step. */
void test_the_ground_is_that_of_the_latest_height_that_was_used(void)
{
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.0F, 7U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(-0.4F, 8U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(-0.6F, 8U));
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(-0.6F, 7U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(-0.6F, 9U));
    TEST_ASSERT_EQUAL(HEIGHT_TERRAIN_STEP, see(-0.6F, 9U));
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(-0.3F, 9U));
}

void test_a_ground_without_a_number_is_never_the_same(void)
{
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.0F, 0U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.4F, 0U));
}

void test_the_third_height_in_a_row_resets_and_its_ground_counts(void)
{
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.2F, 1U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.4F, 2U));
    TEST_ASSERT_EQUAL(HEIGHT_RESET, see(0.6F, 3U));
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.6F, 3U));
}

void test_an_untested_height_ends_the_row_and_its_ground_counts(void)
{
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.2F, 1U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.4F, 2U));
    innovation_untested(&test, 5U);
    TEST_ASSERT_EQUAL(HEIGHT_FUSED, see(0.6F, 5U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.6F, 6U));
    TEST_ASSERT_EQUAL(HEIGHT_REJECTED, see(0.8F, 6U));
}
