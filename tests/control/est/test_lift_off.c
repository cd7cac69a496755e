/* The take-off's ramp, from both sides of each limit. */
#include "control/est/lift_off.h"
#include "unity.h"

#include <math.h>

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(2.0e-4F, expected, actual)
#define GRAV_N 7.0F
#define GROUND_M 0.02F

static lift_off_t lift;

void setUp(void)
{
    lift = (lift_off_t){.ramping = false};
    lift_off_reset(&lift, GRAV_N, GROUND_M);
}

void tearDown(void) {}

static void begin_ramp(void)
{
    lift_off_ramp(&lift, GRAV_N, 0.0F);
}

/* Feels that acceleration for a second: the low-pass has it then. */
static void feel(float up_mps2)
{
    for (int i = 0; i < 40; i++) {
        lift_off_watch(&lift, up_mps2, 6.0F, 0.025F);
    }
}

static bool lifts(float up_mps2, float noise_mps2, float height_m, float thrust_n, bool felt)
{
    const lift_off_signs_t signs = {.height_m = GROUND_M + height_m,
                                    .delivered_n = thrust_n,
                                    .noise_mps2 = noise_mps2,
                                    .felt = felt,
                                    .most_mps2 = 9.0F};
    setUp();
    feel(up_mps2);
    return lift_off_is_seen(&lift, &signs);
}

void test_it_is_off_the_ground_by_acceleration_or_height(void)
{
    TEST_ASSERT_TRUE(lifts(0.87F, 0.4F, 0.0F, 4.91F, true));
    TEST_ASSERT_FALSE(lifts(0.85F, 0.4F, 0.0F, 4.91F, true));
    TEST_ASSERT_TRUE(lifts(1.30F, 1.0F, 0.0F, 4.91F, true));
    TEST_ASSERT_FALSE(lifts(1.28F, 1.0F, 0.0F, 4.91F, true)); /* three sigma behind the low-pass */
    TEST_ASSERT_TRUE(lifts(0.0F, 0.4F, 0.0321F, 4.91F, true));
    TEST_ASSERT_FALSE(lifts(0.0F, 0.4F, 0.0319F, 4.91F, true));
}

void test_an_acceleration_counts_as_far_as_the_lightest_vehicle_would_feel_it(void)
{
    lift_off_signs_t signs = {.height_m = GROUND_M, .noise_mps2 = 0.4F, .felt = true};

    feel(3.0F);
    signs.most_mps2 = 0.85F;
    TEST_ASSERT_FALSE(lift_off_is_seen(&lift, &signs));
    signs.most_mps2 = 0.87F;
    TEST_ASSERT_TRUE(lift_off_is_seen(&lift, &signs));
    signs.most_mps2 = -1.0F;
    signs.height_m = GROUND_M + 0.0321F; /* its height shows it too */
    TEST_ASSERT_TRUE(lift_off_is_seen(&lift, &signs));
}

void test_without_accelerations_the_height_alone_shows_it(void)
{
    TEST_ASSERT_TRUE(lifts(0.0F, 0.4F, 0.0321F, 7.0F, false));
    TEST_ASSERT_FALSE(lifts(0.0F, 0.4F, 0.0319F, 7.0F, false));
}

void test_the_ramp_grows_by_4_newtons_a_second_to_a_third_above_gravity(void)
{
    lift_off_ramp(&lift, GRAV_N, 0.1F);
    NEAR(0.68F * GRAV_N + 0.4F, lift.ramp_n);
    lift_off_ramp(&lift, GRAV_N, 0.1F);
    NEAR(0.68F * GRAV_N + 0.8F, lift.ramp_n);
    for (int i = 0; i < 50; i++) {
        lift_off_ramp(&lift, GRAV_N, 0.1F);
    }
    NEAR(1.35F * GRAV_N, lift.ramp_n);
    lift_off_ramp(&lift, 7.4F, 1.0F); /* the battery was that empty */
    NEAR(1.35F * 7.4F, lift.ramp_n);
    lift_off_give_up(&lift, 0.1F);
    NEAR(1.35F * 7.4F - 0.2F, lift.ramp_n); /* 2 N/s down */
    lift_off_give_up(&lift, 10.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, lift.ramp_n);
}

void test_the_lift_off_is_watched_through_80_ms_and_its_speed_decays_within_a_second(void)
{
    begin_ramp();
    lift_off_watch(&lift, 0.8F, 4.0F, 0.025F);
    NEAR(0.3125F * 0.8F, lift.up_mps2); /* 25 of 80 ms */
    NEAR(0.3125F * 4.0F, lift.thrust_n);
    NEAR(0.02F, lift.up_mps);
    lift_off_watch(&lift, 1.0F, 4.0F, 0.025F);
    NEAR(0.25F + 0.3125F * 0.75F, lift.up_mps2);
    NEAR(0.02F * 0.975F + 0.025F, lift.up_mps);
    lift_off_watch(&lift, 0.0F, 4.0F, 0.2F); /* longer than the filter: all of it */
    NEAR(0.0F, lift.up_mps2);
    setUp();
    lift_off_watch(&lift, 1.0F, 4.0F, 0.025F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, lift.up_mps); /* no ramp, no lift-off */
}

void test_on_the_ramp_a_vehicle_that_does_not_accelerate_stands(void)
{
    static const struct {
        bool ramping;
        float up_mps2, noise_mps2;
        bool stands;
    } rows[] = {{true, 0.85F, 0.4F, true},
                {true, 0.87F, 0.4F, false},
                {false, 0.0F, 0.4F, false},
                {true, 1.28F, 1.0F, true},
                {true, 1.30F, 1.0F, false}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        if (rows[i].ramping) {
            begin_ramp();
        }
        feel(rows[i].up_mps2);
        TEST_ASSERT_EQUAL(rows[i].stands, lift_off_stands(&lift, rows[i].noise_mps2));
    }
}

/* The thrust grows by 4 N/s: after t the vehicle has risen by a 4 t3 / 6. At 40 mm t is 0.22 s. */
void test_without_accelerations_the_height_tells_when_it_left_the_ground(void)
{
    const float jerk = 4.0F * 1.4F;
    const float t = cbrtf(6.0F * 0.04F / jerk) + 0.05F;
    const lift_off_signs_t signs = {
        .height_m = GROUND_M + 0.04F,
        .delivered_n = 7.9F,
    };
    const lifted_t lifted = lift_off_by_height(&lift, &signs, 0.05F, 1.4F);

    NEAR(7.9F - 4.0F * t, lifted.thrust_n);
    NEAR(GROUND_M + jerk * t * t * t / 6.0F, lifted.height_m);
    NEAR(0.5F * jerk * t * t, lifted.speed_mps);
    const lift_off_signs_t below = {
        .height_m = 0.0F,
        .delivered_n = 7.9F,
    };
    NEAR(7.9F - 4.0F * 0.05F, lift_off_by_height(&lift, &below, 0.05F, 1.4F).thrust_n);
}
