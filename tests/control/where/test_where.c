#include "control/where/where.h"
#include "unity.h"

#include <string.h>

static where_t where;

void setUp(void)
{
    memset(&where, 0, sizeof where);
    supervisor_init(&where.supervisor);
}

void tearDown(void) {}

static void cycle_at(uint32_t now_us)
{
    const flight_inputs_t in = {.now_us = now_us};
    const vertical_estimate_t estimate = {.upright = 1.0F};

    supervisor_step(&where.supervisor, 0.0F, &in, &estimate);
}

void test_a_pause_counts_as_half_a_second(void)
{
    cycle_at(1000000U);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, where_step_s(&where));
    cycle_at(1025000U);
    TEST_ASSERT_EQUAL_FLOAT(0.025F, where_step_s(&where));
    cycle_at(6025000U);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, where_step_s(&where));
}

void test_the_first_cycle_has_no_time_before_it(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.0F, where_gap_s(&where, 700000U));
    cycle_at(UINT32_MAX - 49999U);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, where_gap_s(&where, 50000U)); /* across the wrap */
    TEST_ASSERT_EQUAL_FLOAT(0.5F, where_gap_s(&where, 5000000U));
}

void test_three_states_descend(void)
{
    for (int state = 0; state < FLIGHT_STATE_COUNT; state++) {
        where.supervisor.state = (flight_state_t)state;
        const bool descends = state == FLIGHT_LANDING || state == FLIGHT_LOWERING ||
                              state == FLIGHT_DESCENDING;
        TEST_ASSERT_EQUAL(descends, where_descends(&where));
    }
}
