#include "sim/devices/echo.h"

#include <math.h>
#include <string.h>

#include "unity.h"

#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

static place_t place;
static noise_t noise;
/* Straight down from 1 m over (x, 0), with 100 mm behind it. */
static bracket_ray_t ray;

void setUp(void)
{
    place_init(&place);
    noise_init(&noise, 1, "echo");
    ray = (bracket_ray_t){
        .from = {0, 0, 1000.0}, .direction = {0, 0, -1.0}, .across = {1.0, 0, 0}, .before_mm = 100.0};
}

void tearDown(void) {}

static void put(double height_m, double bottom_m, const char *surface)
{
    TEST_ASSERT_TRUE(place_add(&place, &(place_block_t){.length_m = 1.0,
                                                        .width_m = 1.0,
                                                        .bottom_m = bottom_m,
                                                        .near_top_m = height_m,
                                                        .far_top_m = height_m,
                                                        .surface = *surface_find(surface)}));
}

static echo_t look(double spot_rad)
{
    return echo_of(&place, &ray, spot_rad, 0.0, &noise);
}

void test_a_plain_floor_gives_its_distance(void)
{
    const echo_t echo = look(0.006);

    NEAR(2e-2, 1100.0, echo.mm);
    NEAR(1e-9, 1.0, echo.signal);
    TEST_ASSERT_TRUE(echo.plain);
    TEST_ASSERT_FALSE(echo.edged);
}

void test_nothing_in_reach_gives_no_signal(void)
{
    ray.direction.z = 1.0;
    NEAR(1e-12, 0.0, look(0.0).signal);
    ray.direction.z = -1.0;
    ray.from.z = 5700.0;
    NEAR(1e-12, 0.0, look(0.0).signal);
}

/* A pane at 0.4 m over a white floor: 0.02/0.9 + 0.08/0.9 = 0.1111 from the pane at 700 mm, 0.81 from the
 * floor at 1100: (77.78 + 891) / 0.9211 = 1051.7. */
void test_a_glass_table_lets_most_of_the_light_through(void)
{
    put(0.4, 0.39, "glass");
    place.floor[0] = *surface_find("white");
    const echo_t echo = look(0.0);

    NEAR(1e-6, 0.1 / 0.9 + 0.81, echo.signal);
    NEAR(0.1, 1051.7, echo.mm);
    TEST_ASSERT_FALSE(echo.plain);
}

/* Aslant the glint goes elsewhere, and the floor alone is seen. */
void test_glass_met_aslant_is_hardly_there(void)
{
    put(0.4, 0.39, "glass");
    ray.direction = (place_vector_t){sin(0.4), 0.0, -cos(0.4)};
    const echo_t echo = look(0.0);

    TEST_ASSERT_TRUE(echo.mm > 100.0 + 1000.0 / cos(0.4) - 20.0);
}

/* Eight millimetres of pile: the mean is four deeper, each ray its own. */
void test_a_carpets_rays_end_within_its_pile(void)
{
    double sum = 0.0, least = 1e9, most = 0.0;

    place.floor[0] = *surface_find("carpet");
    for (int i = 0; i < 2000; i++) {
        const double mm = look(0.0).mm;

        sum += mm;
        least = fmin(least, mm);
        most = fmax(most, mm);
    }
    NEAR(0.2, 1104.0, sum / 2000.0);
    TEST_ASSERT_TRUE(least >= 1100.0 && least < 1100.1 && most <= 1108.0 && most > 1107.9);
}

void test_a_dark_tile_reads_too_far(void)
{
    place.floor[0] = *surface_find("white");
    place.floor[1] = *surface_find("black");
    place.tile_m = 0.3;
    ray.from.x = ray.from.y = 150.0;
    NEAR(1e-6, 1100.0, look(0.0).mm);
    ray.from.x = 450.0;
    NEAR(1e-6, 1110.0, look(0.0).mm);
    ray.from.y = -150.0;
    NEAR(1e-6, 1100.0, look(0.0).mm);
    ray.from.x = -450.0;
    NEAR(1e-6, 1110.0, look(0.0).mm);
}

/* The block's edge at x = 0.5, 0.4 m high, 600 mm under the ray: its rim at 6 mrad is 3.6 mm wide. Two mm
 * outside of it one of five parts still lights the block: (4 * 1100 + 700) / 5. Ten outside none does. */
void test_a_spot_over_an_edge_tells_the_mean_by_the_light(void)
{
    put(0.4, 0.0, "plain");
    ray.from.x = 502.0;
    const echo_t mixed = look(0.006);
    NEAR(0.1, (4.0 * 1100.0 + 700.0) / 5.0, mixed.mm);
    TEST_ASSERT_TRUE(mixed.edged);
    ray.from.x = 510.0;
    NEAR(0.1, 1100.0, look(0.006).mm);
    TEST_ASSERT_FALSE(look(0.006).edged);
    ray.from.x = 502.0;
    TEST_ASSERT_FALSE(look(0.0).edged);
}
