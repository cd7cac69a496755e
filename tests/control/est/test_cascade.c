#include "control/est/cascade.h"
#include "control/thrust.h"
#include "unity.h"

#include <math.h>

static const cascade_gains_t gains = {2.25F, 7.2F, 0.5F, 1.3F};
static cascade_vehicle_t vehicle;
static cascade_state_t state;

void setUp(void)
{
    vehicle = (cascade_vehicle_t){9.81F / 7.4F, 2.5F, 7.4F, 7.4F, 1.0F};
    state = (cascade_state_t){0.6F, 0.0F, 0.0F, 7.4F};
}

void tearDown(void) {}

static float settle(float speed_mps)
{
    for (int i = 0; i < 40; i++) {
        state.thrust_n = cascade_thrust_n(&gains, &vehicle, &state, speed_mps);
    }
    return state.thrust_n;
}

void test_at_its_reference_it_wants_no_speed_and_hovers(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.0F, cascade_speed_to(&gains, &state, 0.6F));
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 7.4F, settle(0.0F));
}

void test_near_the_reference_the_speed_is_proportional_and_far_it_is_more_within_its_limits(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.0225F, cascade_speed_to(&gains, &state, 0.61F));
    TEST_ASSERT_TRUE(cascade_speed_to(&gains, &state, 0.80F) > 2.25F * 0.2F);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, cascade_speed_to(&gains, &state, 2.0F));
    TEST_ASSERT_EQUAL_FLOAT(-1.3F, cascade_speed_to(&gains, &state, -2.0F));
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, cascade_speed_to(&gains, &state, 0.65F),
                             -cascade_speed_to(&gains, &state, 0.55F));
}

void test_a_rising_terrain_is_climbed_with(void)
{
    state.terrain_mps = 0.2F;
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.2F, cascade_speed_to(&gains, &state, 0.6F));
}

void test_the_drag_of_a_steady_climb_is_met(void)
{
    state.speed_mps = 0.4F;
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 7.4F + 2.5F * 0.4F / vehicle.authority_mps2_per_n, settle(0.4F));
}

void test_a_tilted_vehicle_gets_more_and_at_most_a_quarter_more(void)
{
    vehicle.upright = 0.9F;
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 7.4F / 0.9F, settle(0.0F));
    vehicle.upright = 0.3F;
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 7.4F / 0.8F, settle(0.0F));
}

void test_gusts_are_met(void)
{
    vehicle.need_n = 7.9F;
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 7.9F, settle(0.0F));
}

void test_the_command_leads_the_thrust(void)
{
    state.speed_mps = -0.05F;
    state.thrust_n = 7.4F;
    const float steady_n = 7.4F + (7.2F - 2.5F) * 0.05F / vehicle.authority_mps2_per_n;
    const float thrust_n = cascade_thrust_n(&gains, &vehicle, &state, 0.0F);
    TEST_ASSERT_TRUE(thrust_n > steady_n && thrust_n < 7.4F + 2.0F * (steady_n - 7.4F));
}

void test_the_command_stays_in_its_range_whatever_the_state(void)
{
    uint32_t bits = 5U;
    for (int32_t i = 0; i < 50000; i++) {
        float any[4];
        for (int k = 0; k < 4; k++) {
            bits = bits * 1664525U + 1013904223U;
            any[k] = (float)(bits >> 8) / 8388608.0F - 1.0F;
        }
        vehicle.hover_n = 7.0F + 4.0F * any[0];
        vehicle.need_n = vehicle.hover_n + any[1];
        vehicle.upright = any[2];
        state = (cascade_state_t){5.0F * any[3], 4.0F * any[1], 0.5F * any[2], 6.0F + 5.0F * any[3]};
        const float speed_mps = cascade_speed_to(&gains, &state, 3.0F * any[0]);
        const float thrust_n = cascade_thrust_n(&gains, &vehicle, &state, speed_mps);
        TEST_ASSERT_TRUE(thrust_n >= 0.25F * vehicle.hover_n && thrust_n <= THRUST_MAX_N);
    }
}

/* ---- one step, each share of it alone */

static float step(float speed_mps)
{
    return cascade_thrust_n(&gains, &vehicle, &state, speed_mps);
}

void test_beyond_two_decimetres_the_speed_per_metre_is_three_tenths_more(void)
{
    const cascade_gains_t free_gains = {2.0F, 7.2F, 5.0F, 5.0F};
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.0F * 1.15F * 0.1F, cascade_speed_to(&free_gains, &state, 0.7F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, -2.0F * 1.15F * 0.1F, cascade_speed_to(&free_gains, &state, 0.5F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.0F * 1.3F * 0.2F, cascade_speed_to(&free_gains, &state, 0.8F));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.0F * 1.3F * 0.5F, cascade_speed_to(&free_gains, &state, 1.1F));
}

void test_the_acceleration_is_limited_upwards_and_downwards(void)
{
    vehicle.authority_mps2_per_n = 4.0F;
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 7.4F + 1.3F * 7.2F * 0.4F / 4.0F, step(0.4F));
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 7.4F + 1.3F * 3.96F / 4.0F, step(2.0F));
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 7.4F - 3.96F / 4.0F, step(-2.0F));
}

void test_the_drag_that_is_met_ends_at_the_speed_of_a_climb(void)
{
    static const float speeds_mps[][2] = {{0.4F, 0.4F}, {2.0F, 0.5F}, {-0.4F, -0.4F}, {-3.0F, -0.5F}};
    vehicle.authority_mps2_per_n = 4.0F;
    vehicle.damping_per_s = 2.0F;
    for (int i = 0; i < 4; i++) {
        state.speed_mps = speeds_mps[i][0];
        TEST_ASSERT_FLOAT_WITHIN(1e-3F, 7.4F + 1.3F * 2.0F * speeds_mps[i][1] / 4.0F, step(speeds_mps[i][0]));
    }
}

void test_a_quarter_of_the_hover_thrust_is_kept(void)
{
    state.speed_mps = 3.0F;
    vehicle.authority_mps2_per_n = 0.5F;
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 0.25F * 7.4F, step(-3.0F));
}

void test_the_lead_is_three_tenths_beyond_what_is_delivered(void)
{
    state.thrust_n = 7.0F;
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 7.0F + 1.3F * 0.4F, step(0.0F));
}

void test_tilt_is_met_to_37_degrees(void)
{
    vehicle.upright = 0.81F;
    state.thrust_n = 7.4F / 0.81F;
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 7.4F / 0.81F, step(0.0F));
    vehicle.upright = 0.5F;
    state.thrust_n = 7.4F / 0.8F;
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 7.4F / 0.8F, step(0.0F));
}

void test_the_range_of_the_actuator_is_kept(void)
{
    vehicle.hover_n = vehicle.need_n = state.thrust_n = 9.5F;
    TEST_ASSERT_EQUAL_FLOAT(THRUST_MAX_N, step(3.0F));
}
