#include "control/guard.h"
#include "control/thrust.h"
#include "unity.h"

#include <math.h>

static guard_t guard;
static guard_case_t now;

void setUp(void)
{
    guard = (guard_t){0};
    now = (guard_case_t){
        .wanted_n = 7.0F, .idle_n = 0.6F, .heaviest_n = 8.4F, .step_s = 0.025F, .ordered = true};
}

void tearDown(void) {}

void test_a_flight_passes_as_it_is(void)
{
    for (int i = 0; i < 4000; i++) { /* 100 s of hover that no height confirms */
        TEST_ASSERT_EQUAL_FLOAT(7.0F, guard_step(&guard, &now));
    }
    now.wanted_n = 11.0F;
    now.confirmed = true;
    for (int i = 0; i < 4000; i++) {
        TEST_ASSERT_EQUAL_FLOAT(11.0F, guard_step(&guard, &now));
    }
}

void test_no_order_is_no_thrust_but_the_idle(void)
{
    now.ordered = false;
    TEST_ASSERT_EQUAL_FLOAT(0.6F, guard_step(&guard, &now));
    now.idle_n = 0.0F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, guard_step(&guard, &now));
}

void test_a_number_that_is_none_is_the_idle(void)
{
    now.wanted_n = NAN;
    TEST_ASSERT_EQUAL_FLOAT(0.6F, guard_step(&guard, &now));
    now.idle_n = NAN;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, guard_step(&guard, &now));
    now = (guard_case_t){INFINITY, -1.0F, NAN, NAN, true, false};
    TEST_ASSERT_EQUAL_FLOAT(THRUST_MAX_N, guard_step(&guard, &now)); /* no time, so no impulse */
}

/* Full thrust that no height ever confirms. */
void test_an_unseen_climb_ends_at_the_hover_thrust_of_the_heaviest_vehicle(void)
{
    float impulse_ns = 0.0F;

    now.wanted_n = THRUST_MAX_N;
    for (int i = 0; i < 4000; i++) {
        impulse_ns += fmaxf(guard_step(&guard, &now) - now.heaviest_n, 0.0F) * now.step_s;
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1F, GUARD_UNSEEN_NS, impulse_ns);
    TEST_ASSERT_TRUE(impulse_ns <= GUARD_UNSEEN_NS);
    TEST_ASSERT_EQUAL_FLOAT(8.4F, guard_step(&guard, &now));
    now.wanted_n = 5.0F;
    TEST_ASSERT_EQUAL_FLOAT(5.0F, guard_step(&guard, &now)); /* down at any time */
}

void test_a_confirmed_climb_begins_the_sum_anew(void)
{
    now.wanted_n = THRUST_MAX_N;
    for (int i = 0; i < 400; i++) {
        (void)guard_step(&guard, &now);
    }
    now.confirmed = true;
    TEST_ASSERT_EQUAL_FLOAT(THRUST_MAX_N, guard_step(&guard, &now));
    now.confirmed = false;
    TEST_ASSERT_EQUAL_FLOAT(THRUST_MAX_N, guard_step(&guard, &now));
}
