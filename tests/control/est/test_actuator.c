#include "control/est/actuator.h"
#include "unity.h"

#include <math.h>

#define DELAY_US 18500U

static actuator_t actuator;

void setUp(void)
{
    actuator_init(&actuator, 0xFFFFFF00U); /* wraps at once */
    actuator_describe(&actuator, 0.0185F, 0.12F);
}

void tearDown(void) {}

static uint32_t after(uint32_t us)
{
    return 0xFFFFFF00U + us;
}

void test_a_command_does_nothing_before_the_dead_time(void)
{
    actuator_command(&actuator, 8.0F, after(0U));
    actuator_advance(&actuator, after(DELAY_US));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, actuator.thrust_n);
    actuator_advance(&actuator, after(DELAY_US + 5000U));
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 8.0F * (1.0F - expf(-5.0F / 120.0F)), actuator.thrust_n);
}

void test_the_lag_is_120_ms_in_steps_of_any_length(void)
{
    for (uint32_t step_us = 500U; step_us < 60000U; step_us *= 3U) {
        setUp();
        actuator_command(&actuator, 5.0F, after(0U));
        for (uint32_t us = 0U; us <= DELAY_US + 240000U; us += step_us) {
            actuator_advance(&actuator, after(us));
        }
        actuator_advance(&actuator, after(DELAY_US + 240000U));
        TEST_ASSERT_FLOAT_WITHIN(0.05F, 5.0F * (1.0F - expf(-2.0F)), actuator.thrust_n);
    }
}

void test_commands_take_effect_in_their_order_and_at_their_time(void)
{
    actuator_command(&actuator, 4.0F, after(0U));
    actuator_command(&actuator, 6.0F, after(25000U));
    actuator_advance(&actuator, after(DELAY_US + 24000U));
    TEST_ASSERT_EQUAL_FLOAT(4.0F, actuator.demand_n);
    actuator_advance(&actuator, after(DELAY_US + 25000U));
    TEST_ASSERT_EQUAL_FLOAT(6.0F, actuator.demand_n);
    TEST_ASSERT_EQUAL_UINT16(0, actuator.count);
}

void test_an_earlier_instant_changes_nothing(void)
{
    actuator_command(&actuator, 8.0F, after(0U));
    actuator_advance(&actuator, after(100000U));
    const actuator_t before = actuator;
    actuator_advance(&actuator, after(50000U));
    TEST_ASSERT_EQUAL_FLOAT(before.thrust_n, actuator.thrust_n);
    TEST_ASSERT_EQUAL_UINT32(before.time_us, actuator.time_us);
}

void test_too_many_commands_let_the_oldest_take_effect(void)
{
    for (uint16_t i = 0U; i <= ACTUATOR_COMMANDS; i++) {
        actuator_command(&actuator, (float)i, after(i));
    }
    TEST_ASSERT_EQUAL_UINT16(ACTUATOR_COMMANDS, actuator.count);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, actuator.demand_n);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, actuator.coming[0].thrust_n);
}

void test_a_long_pause_ends_at_the_demand(void)
{
    actuator_command(&actuator, 7.0F, after(0U));
    actuator_advance(&actuator, after(1000U));
    actuator_advance(&actuator, after(30000000U));
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 7.0F, actuator.thrust_n);
}

void test_lag_and_dead_time_are_those_that_are_told(void)
{
    actuator_describe(&actuator, 0.040F, 0.06F);
    actuator_command(&actuator, 8.0F, after(0U));
    actuator_advance(&actuator, after(40000U));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, actuator.thrust_n);
    actuator_advance(&actuator, after(70000U));
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 8.0F * (1.0F - expf(-0.5F)), actuator.thrust_n);
}

/* ---- one step */

void test_times_are_rounded_to_microseconds(void)
{
    actuator_describe(&actuator, 0.0000104F, 0.1F);
    TEST_ASSERT_EQUAL_UINT32(10U, actuator.delay_us);
    actuator_describe(&actuator, 0.0000106F, 0.1F);
    TEST_ASSERT_EQUAL_UINT32(11U, actuator.delay_us);
}

/* A share of step / (lag + half a step), which is never more than all of it. */
void test_a_step_takes_its_share_of_what_is_missing(void)
{
    static const struct {
        uint32_t step_us;
        float share;
    } rows[] = {
        {12000U, 0.095238F}, {120000U, 0.666667F}, {239000U, 0.997912F}, {480000U, 1.0F}, {1000000U, 1.0F}};
    for (int i = 0; i < 5; i++) {
        setUp();
        actuator.demand_n = 10.0F;
        actuator_advance(&actuator, after(rows[i].step_us));
        TEST_ASSERT_FLOAT_WITHIN(1e-4F, 10.0F * rows[i].share, actuator.thrust_n);
        TEST_ASSERT_EQUAL_UINT32(after(rows[i].step_us), actuator.time_us);
        actuator_advance(&actuator, after(rows[i].step_us - 1000U));
        TEST_ASSERT_EQUAL_UINT32(after(rows[i].step_us), actuator.time_us);
    }
}

void test_commands_take_effect_one_after_the_other(void)
{
    for (uint32_t i = 0U; i < 3U; i++) {
        actuator_command(&actuator, 1.0F + (float)i, after(1000U * i));
    }
    TEST_ASSERT_EQUAL_UINT16(3U, actuator.count);
    actuator_advance(&actuator, after(DELAY_US + 500U));
    TEST_ASSERT_EQUAL_FLOAT(1.0F, actuator.demand_n);
    TEST_ASSERT_EQUAL_UINT16(2U, actuator.count);
    TEST_ASSERT_EQUAL_FLOAT(2.0F, actuator.coming[0].thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(3.0F, actuator.coming[1].thrust_n);
    actuator_advance(&actuator, after(DELAY_US + 2000U));
    TEST_ASSERT_EQUAL_FLOAT(3.0F, actuator.demand_n);
    TEST_ASSERT_EQUAL_UINT16(0U, actuator.count);
    for (uint16_t i = 0U; i < ACTUATOR_COMMANDS + 1U; i++) { /* one too many: the oldest acts at once */
        actuator_command(&actuator, 10.0F + (float)i, after(50000U));
    }
    TEST_ASSERT_EQUAL_UINT16(ACTUATOR_COMMANDS, actuator.count);
    TEST_ASSERT_EQUAL_FLOAT(10.0F, actuator.demand_n);
    TEST_ASSERT_EQUAL_FLOAT(11.0F, actuator.coming[0].thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(22.0F, actuator.coming[ACTUATOR_COMMANDS - 1U].thrust_n);
}
