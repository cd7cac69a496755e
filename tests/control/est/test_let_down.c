/* How law EST comes down, from both sides of each limit. */
#include "control/est/let_down.h"
#include "control/thrust.h"
#include "unity.h"

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(2.0e-4F, expected, actual)

static let_down_t down;

void setUp(void)
{
    down = (let_down_t){.ceiling_n = 0.0F};
    let_down_arm(&down, 7.0F);
}

void tearDown(void) {}

/* A cycle high in the air whose law wants wanted_n. */
static float step_n(est_mode_t mode, float wanted_n, float step_s)
{
    let_down_step(&down, mode, &(let_down_signs_t){.height_m = 1.0F, .pushes = true, .step_s = step_s});
    return let_down_limit_n(&down, mode, wanted_n, 7.0F);
}

void test_a_landing_slows_down_towards_the_ground(void)
{
    NEAR(-0.275F, let_down_mps(EST_MODE_LAND, 0.5F));
    NEAR(-0.3F, let_down_mps(EST_MODE_LAND, 2.0F));
    NEAR(-0.15F, let_down_mps(EST_MODE_LAND, -0.1F));
}

void test_a_descent_without_heights_has_one_speed(void)
{
    NEAR(-0.3F, let_down_mps(EST_MODE_SINK, 0.5F));
    NEAR(-0.3F, let_down_mps(EST_MODE_SINK, 6.0F));
    NEAR(-0.3F, let_down_mps(EST_MODE_SINK, -0.1F));
}

void test_the_ceiling_of_a_descent_starts_above_the_entrys_hover_thrust_and_falls(void)
{
    NEAR(8.5F, step_n(EST_MODE_LAND, 20.0F, 0.5F));
    NEAR(8.4F, step_n(EST_MODE_LAND, 20.0F, 0.5F)); /* 0.2 N/s */
    NEAR(7.5F, step_n(EST_MODE_SINK, 20.0F, 0.5F));
    NEAR(7.4F, step_n(EST_MODE_SINK, 20.0F, 0.5F)); /* 0.2 N/s */
    NEAR(7.3F, step_n(EST_MODE_LAND, 20.0F, 0.5F)); /* and never rises again */
    TEST_ASSERT_EQUAL_FLOAT(0.0F, step_n(EST_MODE_LAND, 20.0F, 100.0F));
    let_down_arm(&down, 7.0F);
    NEAR(THRUST_MAX_N, step_n(EST_MODE_HOLD, 20.0F, 0.5F));
}

/* A gust may be met with all thrust then. When the mirrors agree no more, the ceiling is there at once. */
void test_a_landing_that_two_mirrors_see_has_no_ceiling_and_a_descent_without_heights_has(void)
{
    let_down_step(&down, EST_MODE_LAND, &(let_down_signs_t){1.0F, false, true, true, 5.0F});
    NEAR(11.0F, let_down_limit_n(&down, EST_MODE_LAND, 11.0F, 7.0F));
    NEAR(8.5F, step_n(EST_MODE_LAND, 20.0F, 0.1F));
    let_down_arm(&down, 7.0F);
    let_down_step(&down, EST_MODE_SINK, &(let_down_signs_t){1.0F, false, true, true, 0.1F});
    NEAR(7.5F, let_down_limit_n(&down, EST_MODE_SINK, 11.0F, 7.0F));
    /* they have come back */
    let_down_step(&down, EST_MODE_LAND, &(let_down_signs_t){1.0F, false, true, true, 0.1F});
    NEAR(11.0F, let_down_limit_n(&down, EST_MODE_LAND, 11.0F, 7.0F));
    NEAR(7.48F, step_n(EST_MODE_LAND, 20.0F, 0.1F));
}

static float held_n(est_mode_t mode, float height_m, float step_s)
{
    let_down_step(&down, mode, &(let_down_signs_t){.height_m = height_m, .rocks = true, .step_s = step_s});
    return let_down_limit_n(&down, mode, 20.0F, 7.0F);
}

/* A pilot's turn of seven seconds took 1.4 N off the ceiling. */
void test_the_ceiling_of_a_landing_that_a_pilot_holds_up_starts_anew_at_the_hand_back(void)
{
    NEAR(8.5F, step_n(EST_MODE_LAND, 20.0F, 0.1F));
    NEAR(7.1F, held_n(EST_MODE_LAND, 1.2F, 7.0F));
    NEAR(8.5F, step_n(EST_MODE_LAND, 20.0F, 0.1F));
    NEAR(8.4F, step_n(EST_MODE_LAND, 20.0F, 0.5F));
    NEAR(7.5F, held_n(EST_MODE_SINK, 1.0F, 0.5F));
    NEAR(7.4F, step_n(EST_MODE_SINK, 20.0F, 0.5F)); /* without heights nothing tells it */
}

/* It looks held up too. With a new ceiling each time it climbed to 12 m, with the old one to 7 m. */
void test_what_has_lost_a_load_and_climbs_keeps_its_ceiling(void)
{
    NEAR(8.5F, step_n(EST_MODE_LAND, 20.0F, 0.1F)); /* at 1 m */
    NEAR(7.5F, held_n(EST_MODE_LAND, 1.31F, 5.0F));
    let_down_step(&down, EST_MODE_LAND, &(let_down_signs_t){1.31F, true, false, true, 0.5F});
    NEAR(7.4F, let_down_limit_n(&down, EST_MODE_LAND, 20.0F, 7.0F));
    NEAR(7.3F, held_n(EST_MODE_LAND, 1.29F, 0.5F));
    let_down_step(&down, EST_MODE_LAND, &(let_down_signs_t){1.29F, true, false, true, 0.5F});
    NEAR(8.5F, let_down_limit_n(&down, EST_MODE_LAND, 20.0F, 7.0F));
}

void test_a_hover_thrust_that_is_learned_in_the_descent_does_not_count(void)
{
    NEAR(8.5F, step_n(EST_MODE_LAND, 20.0F, 0.1F));
    let_down_step(&down, EST_MODE_LAND, &(let_down_signs_t){1.0F, false, false, true, 0.1F});
    TEST_ASSERT_TRUE(let_down_limit_n(&down, EST_MODE_LAND, 20.0F, 9.0F) < 8.5F);
}

void test_without_heights_the_thrust_is_not_cut_too_far(void)
{
    NEAR(6.5F, step_n(EST_MODE_SINK, 0.0F, 0.1F)); /* 0.5 N below the entry's */
    NEAR(0.0F, step_n(EST_MODE_LAND, 0.0F, 0.1F));
    let_down_arm(&down, 0.4F);
    NEAR(0.0F, step_n(EST_MODE_SINK, -1.0F, 0.1F));
}

static float low_n(est_mode_t mode, bool rocks, float step_s)
{
    let_down_step(&down, mode, &(let_down_signs_t){0.02F, rocks, false, true, step_s});
    return let_down_limit_n(&down, mode, 7.2F, 7.0F);
}

void test_the_end_of_a_landing_fades_the_thrust_out(void)
{
    NEAR(7.2F, low_n(EST_MODE_LAND, false, 0.1F));
    NEAR(7.0F + 0.5F - 2.0F * 0.6F, low_n(EST_MODE_LAND, false, 0.5F));
    NEAR(7.0F + 0.5F - 2.0F * 0.8F, low_n(EST_MODE_LAND, true, 0.2F));
    NEAR(7.0F + 0.5F - 2.0F * 0.81F, low_n(EST_MODE_LAND, true, 0.1F)); /* it is in the air yet: a tenth */
}

void test_another_mode_ends_the_end_of_a_landing(void)
{
    static const est_mode_t others[] = {EST_MODE_SINK, EST_MODE_HOLD};

    for (int i = 0; i < 2; i++) {
        setUp();
        (void)low_n(EST_MODE_LAND, false, 1.0F);
        (void)low_n(others[i], false, 0.1F);
        NEAR(7.2F, low_n(EST_MODE_LAND, false, 0.1F));
    }
    (void)low_n(EST_MODE_LAND, false, 1.0F);
    let_down_reset(&down);
    let_down_arm(&down, 7.0F);
    NEAR(7.2F, low_n(EST_MODE_LAND, false, 0.1F));
}
