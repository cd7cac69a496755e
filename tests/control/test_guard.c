#include "control/guard.h"
#include "control/thrust.h"
#include "unity.h"

#include <math.h>

static guard_t guard;
static guard_case_t now;

void setUp(void)
{
    guard = (guard_t){0};
    now = (guard_case_t){.wanted_n = 7.0F,
                         .idle_n = 0.6F,
                         .heaviest_n = 8.4F,
                         .lightest_n = 5.6F,
                         .step_s = 0.025F,
                         .ordered = true};
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
    now = (guard_case_t){INFINITY, -1.0F, NAN, NAN, NAN, true, false};
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

/* It hovers, and from then on commands nothing, or what is no number. */
void test_a_law_that_commands_nothing_in_the_air_lets_it_sink_and_not_fall(void)
{
    static const float nothing[] = {0.0F, NAN};

    for (int i = 0; i < 2; i++) {
        float missing_ns = 0.0F;

        setUp();
        (void)guard_step(&guard, &now);
        now.wanted_n = nothing[i];
        for (int k = 0; k < 40; k++) { /* a second: the thrust that is needed has faded by 2 N */
            missing_ns += (5.6F - guard_step(&guard, &now)) * now.step_s;
        }
        TEST_ASSERT_TRUE(missing_ns <= GUARD_FALL_NS + 1.05F); /* 1 N s by the fading */
        TEST_ASSERT_FLOAT_WITHIN(0.1F, 3.6F, guard_step(&guard, &now));
    }
}

/* A landing ends by 2 N/s, and a climb is braked for a moment by a quarter of the hover thrust. */
void test_a_landing_and_a_brake_pass_as_they_are(void)
{
    (void)guard_step(&guard, &now);
    for (int i = 0; i < 400; i++) {
        now.wanted_n = fmaxf(now.wanted_n - 2.0F * now.step_s, now.idle_n);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, now.wanted_n, guard_step(&guard, &now));
    }
    setUp();
    for (int i = 0; i < 100; i++) {
        now.wanted_n = (i % 20 < 6) ? 1.75F : 8.0F; /* 0.15 s of each half second */
        TEST_ASSERT_EQUAL_FLOAT(now.wanted_n, guard_step(&guard, &now));
    }
}

void test_more_thrust_pays_a_fall_back(void)
{
    (void)guard_step(&guard, &now);
    for (int turn = 0; turn < 5; turn++) {
        now.wanted_n = 1.0F;
        for (int i = 0; i < 20; i++) { /* 2.1 N s */
            TEST_ASSERT_EQUAL_FLOAT(1.0F, guard_step(&guard, &now));
        }
        now.wanted_n = 8.0F;
        for (int i = 0; i < 60; i++) {
            (void)guard_step(&guard, &now);
        }
    }
}

/* From the ground the thrust begins at the idle: nothing is needed there yet. */
void test_a_take_off_is_not_held_up(void)
{
    now.ordered = false;
    (void)guard_step(&guard, &now);
    now.ordered = true;
    now.wanted_n = 0.0F;
    TEST_ASSERT_EQUAL_FLOAT(0.6F, guard_step(&guard, &now));
    now.wanted_n = 4.8F;
    TEST_ASSERT_EQUAL_FLOAT(4.8F, guard_step(&guard, &now));
}
