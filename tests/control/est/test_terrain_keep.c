/* TERRAIN IGNORE, in numbers. */
#include "control/est/terrain_keep.h"
#include "unity.h"

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected, actual)

static terrain_keep_t keep;

void setUp(void)
{
    keep = (terrain_keep_t){.reference_m = 0.0F};
    terrain_keep_start(&keep, 0.0F);
}

void tearDown(void) {}

static float setpoint_m(float reference_m, float terrain_m, bool follows)
{
    const terrain_keep_ground_t ground = {.height_m = terrain_m,
                                          .how = follows ? TERRAIN_KEEP_NOT : TERRAIN_KEEP_STEPS};

    return terrain_keep_setpoint_m(&keep, reference_m, &ground, 0.1F);
}

void test_ignored_terrain_moves_the_setpoint_by_its_height(void)
{
    NEAR(0.55F, setpoint_m(0.55F, 0.0F, false));
    NEAR(0.60F, setpoint_m(0.60F, 0.05F, false)); /* a new reference counts from the terrain of now */
    NEAR(0.55F, setpoint_m(0.60F, 0.10F, false)); /* 5 cm above it, and so 55 cm over the terrain of now */
    NEAR(0.55F + 0.05F * 0.1F / 30.0F, setpoint_m(0.60F, 0.10F, false)); /* forgotten within 30 s */
    NEAR(0.60F, setpoint_m(0.60F, 0.10F, true));
    NEAR(0.60F, setpoint_m(0.60F, 0.10F, false));
}

void test_ground_that_is_a_state_is_forgotten_ten_times_slower(void)
{
    const terrain_keep_ground_t ground = {.height_m = 0.1F, .how = TERRAIN_KEEP_GROUND};

    (void)setpoint_m(0.60F, 0.0F, false);
    (void)setpoint_m(0.60F, 0.1F, false);
    const float before_m = terrain_keep_setpoint_m(&keep, 0.60F, &ground, 0.0F);
    (void)terrain_keep_setpoint_m(&keep, 0.60F, &ground, 1.0F);
    const float after_m = terrain_keep_setpoint_m(&keep, 0.60F, &ground, 0.0F);
    NEAR(before_m + (0.60F - before_m) / 300.0F, after_m);
}

/* Steps count at once, also in a climb. */
void test_the_rate_of_the_terrain_counts_once_the_reference_was_reached(void)
{
    terrain_keep_ground_t ground = {.rate_mps = -0.05F, .how = TERRAIN_KEEP_STEPS};
    float held_m[2];

    for (int arrived = 0; arrived < 2; arrived++) {
        setUp();
        ground.height_m = 0.0F;
        (void)terrain_keep_setpoint_m(&keep, 0.60F, &ground, 0.0F);
        keep.arrived_m = (arrived != 0) ? 0.60F : 0.0F;
        for (int k = 0; k < 10; k++) {
            held_m[arrived] = terrain_keep_setpoint_m(&keep, 0.60F, &ground, 0.1F);
            ground.height_m -= 0.005F;
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(0.006F, 0.60F, held_m[0]); /* a cycle late */
    TEST_ASSERT_FLOAT_WITHIN(0.002F, 0.645F, held_m[1]);
}

void test_a_reference_that_comes_back_is_reached_anew(void)
{
    for (int started = 0; started < 2; started++) {
        setUp();
        (void)setpoint_m(0.60F, 0.0F, false);
        keep.arrived_m = 0.60F;
        (void)setpoint_m(0.60F, 0.0F, false);
        TEST_ASSERT_EQUAL_FLOAT(0.60F, keep.arrived_m);
        if (started != 0) {
            terrain_keep_start(&keep, 0.0F);
        } else {
            (void)setpoint_m(0.90F, 0.0F, false);
            (void)setpoint_m(0.60F, 0.0F, false);
        }
        TEST_ASSERT_EQUAL_FLOAT(0.0F, keep.arrived_m);
    }
}

void test_a_start_forgets_what_the_terrain_has_done(void)
{
    (void)setpoint_m(0.60F, 0.0F, false);
    terrain_keep_start(&keep, 0.3F);
    NEAR(0.60F, setpoint_m(0.60F, 0.3F, false));
}

void test_fifteen_centimetres_over_the_terrain_are_kept(void)
{
    (void)setpoint_m(0.60F, 0.0F, false);
    NEAR(0.16F, setpoint_m(0.60F, 0.44F, false));
    NEAR(0.15F, setpoint_m(0.60F, 0.9F, false));
}

/* 3.96 m/s2 of brake: the square root of 2 a h; and by 2 1/s below 0.15 m. A command acts after 0.2 s. */
void test_the_height_shrinks_no_faster_than_a_brake_stops_above_fifteen_centimetres(void)
{
    static const cascade_gains_t gains = {.height_per_s = 2.0F, .up_mps = 0.7F, .down_mps = 1.0F};
    static const float rows[][3] = {{0.15F, 0.0F, 0.0F}, {0.25F, 0.0F, -0.88994F}, {0.35F, 0.5F, -0.38994F},
                                    {0.05F, 0.0F, 0.2F}, {0.15F, 0.9F, 0.7F},      {0.05F, -0.5F, -0.5F}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        NEAR(rows[i][2], terrain_keep_above_mps(rows[i][0], rows[i][1], 0.2F, &gains, -1.0F));
        NEAR(0.69F + 0.01F * (float)(rows[i][2] > 0.69F),
             terrain_keep_above_mps(rows[i][0], rows[i][1], 0.2F, &gains, 0.69F));
    }
}
