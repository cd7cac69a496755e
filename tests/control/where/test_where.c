#include "control/where/where.h"
#include "unity.h"

static where_t where;

void setUp(void)
{
    where = (where_t){.hover.thrust_n = 0.0F};
    supervisor_init(&where.supervisor);
}

void tearDown(void) {}

void test_a_pause_counts_as_half_a_second(void)
{
    where.supervisor.step_us = 25000U;
    TEST_ASSERT_EQUAL_FLOAT(0.025F, where_step_s(&where));
    where.supervisor.step_us = 5000000U;
    TEST_ASSERT_EQUAL_FLOAT(0.5F, where_step_s(&where));
}

void test_the_first_cycle_has_no_time_before_it(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.0F, where_gap_s(&where, 700000U));
    where.supervisor.started = true;
    where.supervisor.now_us = UINT32_MAX - 49999U;
    TEST_ASSERT_EQUAL_FLOAT(0.1F, where_gap_s(&where, 50000U)); /* across the wrap */
}

void test_three_states_descend(void)
{
    int descends = 0;

    for (int state = 0; state < FLIGHT_STATE_COUNT; state++) {
        where.supervisor.state = (flight_state_t)state;
        descends += where_descends(&where) ? 1 : 0;
    }
    TEST_ASSERT_EQUAL_INT(3, descends);
    where.supervisor.state = FLIGHT_LOWERING;
    TEST_ASSERT_TRUE(where_descends(&where));
}
