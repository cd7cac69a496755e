#include "control/est/terrain_ways.h"

#include <math.h>

#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

/* Before a scan of these mirrors: 1 % of steps, 20 % of a ramp that rises by 25 mm. */
static terrain_ways_t before(uint16_t told)
{
    terrain_ways_t ways = {.told = told, .variance_m2 = 1.0e-4F, .rise_m = 0.025F, .rise_m2 = 1.0e-4F};

    ways.common_m2 = ways.variance_m2 + TERRAIN_COMMON_M * TERRAIN_COMMON_M;
    for (int m = 0; m < MIRROR_COUNT; m++) {
        ways.steps[m] = 0.01F;
        ways.rises[m] = 0.2F;
    }
    return ways;
}

void test_the_density_of_one_height_is_one_over_all_heights(void)
{
    float sum = 0.0F;

    for (float off_m = -3.0F; off_m < 3.0F; off_m += 1.0e-3F) {
        terrain_ways_t ways = before(1U);

        ways.off_m[0] = off_m;
        terrain_ways_add(&ways);
        sum += ways.density * 1.0e-3F;
    }
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 1.0F, sum);
}

/* Two heights at once, on a grid that covers the ramp and the noises; steps lie beyond. */
void test_the_density_of_two_heights_is_one_less_the_steps(void)
{
    float sum = 0.0F;

    for (float one_m = -0.15F; one_m < 0.15F; one_m += 3.0e-3F) {
        for (float two_m = -0.15F; two_m < 0.15F; two_m += 3.0e-3F) {
            terrain_ways_t ways = before(3U);

            ways.off_m[0] = one_m;
            ways.off_m[1] = two_m;
            terrain_ways_add(&ways);
            sum += ways.density * 9.0e-6F;
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(0.015F, 0.985F, sum); /* 1 - 2 x 0.01, and the steps that stay within 0.15 m */
}

/* The least squares of one height that is 10 mm too high: the gain of a Kalman filter. */
void test_without_ramp_and_step_it_is_the_update_of_a_kalman_filter(void)
{
    terrain_ways_t ways = before(1U);
    const float own_m2 = TERRAIN_OWN_M * TERRAIN_OWN_M;

    ways.steps[0] = 0.0F;
    ways.rises[0] = 0.0F;
    ways.off_m[0] = 0.01F;
    terrain_ways_add(&ways);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 0.01F * ways.common_m2 / (ways.common_m2 + own_m2),
                             ways.off / ways.density);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 0.01F / (ways.common_m2 + own_m2), ways.pull / ways.density);
    TEST_ASSERT_FLOAT_WITHIN(1.0F, 1.0F / (ways.common_m2 + own_m2), ways.gain / ways.density);
}

/* All three rise by what the ramp was expected to: the ramp is the likelier reason than a vehicle that is 25
 * mm lower than predicted, and the vehicle stays. */
void test_a_ramp_that_goes_on_moves_the_ground_and_not_the_vehicle(void)
{
    terrain_ways_t ways = before(7U);

    for (int m = 0; m < MIRROR_COUNT; m++) {
        ways.rises[m] = 0.85F;
        ways.off_m[m] = -0.025F;
    }
    terrain_ways_add(&ways);
    TEST_ASSERT_TRUE(ways.ramp > 0.9F * ways.density);
    TEST_ASSERT_FLOAT_WITHIN(0.003F, 0.0F, ways.off / ways.density);
    TEST_ASSERT_FLOAT_WITHIN(0.005F, 0.025F, ways.ground_m[MIRROR_FRONT] / ways.density);
}
