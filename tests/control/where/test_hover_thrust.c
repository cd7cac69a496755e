#include "control/thrust.h"
#include "control/where/hover_thrust.h"
#include "unity.h"

#include <string.h>

#define GRAV_N 7.0F
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(2.0e-4F, expected, actual)

static hover_thrust_t hover;
static hover_lesson_t lesson;

/* In flight, cycles of 0.1 s; nothing is doubted; law EST has found 7 N, as GRAV says. */
void setUp(void)
{
    memset(&hover, 0, sizeof hover);
    lesson = (hover_lesson_t){.gravity_n = GRAV_N,
                              .step_s = 0.1F,
                              .flies = true,
                              .sees = true,
                              .teaches = true,
                              .estimated = true,
                              .estimated_n = GRAV_N,
                              .holds = true,
                              .thrust_n = GRAV_N};
    hover_thrust_lift_off(&hover, GRAV_N);
}

void tearDown(void) {}

static float learn_n(void)
{
    hover_thrust_step(&hover, &lesson);
    return hover.thrust_n;
}

static void learned_for(int cycles)
{
    for (int i = 0; i < cycles; i++) {
        (void)learn_n();
    }
}

void test_it_follows_the_first_estimates_and_then_their_mean_over_2_5_s(void)
{
    static const struct {
        int cycles;
        float hover_n;
    } rows[] = {{0, 7.4F},    {1, 7.4F},   {2, 7.2F},    {5, 7.08F},
                {7, 7.0571F}, {10, 7.04F}, {25, 7.016F}, {60, 7.016F}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        learned_for(rows[i].cycles);
        lesson.estimated_n = 7.4F;
        NEAR(rows[i].hover_n, learn_n());
    }
}

void test_without_an_estimate_it_is_a_mean_of_the_thrust_that_holds_a_height(void)
{
    for (int holds = 0; holds < 2; holds++) {
        setUp();
        learned_for(30);
        lesson.estimated = false;
        lesson.estimated_n = 6.0F;
        lesson.holds = holds != 0;
        lesson.thrust_n = 7.5F;
        NEAR((holds != 0) ? 7.02F : 7.0F, learn_n());
    }
}

void test_heights_that_may_be_of_a_blocked_beam_teach_nothing_but_at_first(void)
{
    for (int cycles = 0; cycles < 2; cycles++) {
        setUp();
        learned_for(cycles);
        lesson.teaches = false;
        lesson.estimated_n = 7.4F;
        NEAR((cycles == 0) ? 7.4F : 7.0F, learn_n());
    }
}

void test_what_the_flight_has_learned_is_given_up_on_the_ground(void)
{
    lesson.estimated_n = 7.6F;
    NEAR(7.6F, learn_n());
    lesson.flies = false; /* the pilot has the throttle, or it descends */
    lesson.estimated_n = 6.0F;
    NEAR(7.6F, learn_n());
    lesson.grounded = true;
    NEAR(GRAV_N, learn_n());
    lesson.grounded = false;
    NEAR(GRAV_N, learn_n()); /* nothing was learned since */
    lesson.flies = true;
    lesson.estimated_n = 7.6F;
    NEAR(7.6F, learn_n()); /* anew, at once */
    lesson.flies = false;
    NEAR(7.6F, learn_n());
    lesson.flies = lesson.grounded = true; /* a take-off that has not left the ground */
    NEAR(GRAV_N, learn_n());
}

void test_nothing_is_learned_without_sight(void)
{
    lesson.sees = false;
    lesson.estimated_n = 7.4F;
    NEAR(GRAV_N, learn_n());
}

void test_it_stays_within_one_and_a_half_newton_of_gravity_and_what_a_battery_takes_in_a_cycle(void)
{
    static const struct {
        float gravity_n, estimated_n, hover_n;
    } rows[] = {{7.0F, 9.0F, 8.506F}, {7.0F, 5.0F, 5.5F}, {0.5F, -1.0F, 0.0F}, {11.5F, 13.0F, THRUST_MAX_N}};
    for (int i = 0; i < 4; i++) {
        setUp();
        lesson.gravity_n = rows[i].gravity_n;
        lesson.estimated_n = rows[i].estimated_n;
        NEAR(rows[i].hover_n, learn_n());
    }
}

/* 0.06 N/s: a gust of 10 s moves the limit by 0.6 N, a battery in its time by all that it takes. */
void test_a_battery_that_empties_moves_the_upper_limit_slowly_and_only_that(void)
{
    lesson.estimated_n = 10.0F;
    learned_for(100);
    NEAR(8.5F + 0.6F, hover.thrust_n);
    learned_for(1000);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 10.0F, hover.thrust_n);
    lesson.estimated_n = 4.0F;
    learned_for(1000);
    NEAR(5.5F, hover.thrust_n);
}

void test_the_limit_stands_while_nothing_is_learned_and_is_forgotten_on_the_ground(void)
{
    lesson.estimated_n = 10.0F;
    learned_for(1000);
    lesson.sees = false;
    learned_for(1000);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 10.0F, hover.thrust_n);
    lesson.grounded = true;
    NEAR(GRAV_N, learn_n());
    lesson.grounded = false;
    lesson.sees = true;
    NEAR(8.506F, learn_n());
}

void test_a_descent_by_heights_corrects_it(void)
{
    hover_thrust_correct(&hover, 0.4F);
    NEAR(7.4F, hover.thrust_n);
}

void test_a_wrong_accelerometer_takes_back_what_was_learned_for_less_than_2_5_s(void)
{
    for (int cycles = 24; cycles < 27; cycles += 2) {
        setUp();
        lesson.estimated_n = 7.6F;
        learned_for(cycles);
        hover_thrust_distrust(&hover, GRAV_N);
        NEAR((cycles == 24) ? GRAV_N : 7.6F, hover.thrust_n);
        lesson.estimated_n = 7.4F;
        NEAR((cycles == 24) ? 7.4F : 7.592F, learn_n());
    }
}

void test_a_lift_off_tells_it_for_this_flight(void)
{
    lesson.grounded = true;
    (void)learn_n();
    hover_thrust_lift_off(&hover, 7.3F);
    lesson.grounded = lesson.flies = false;
    NEAR(7.3F, learn_n());
}
