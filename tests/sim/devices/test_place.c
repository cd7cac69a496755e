#include "sim/devices/place.h"

#include <math.h>

#include "sim/noise.h"
#include "unity.h"

#define DEG (M_PI / 180.0)
#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

static place_t place;
static const place_vector_t down = {0.0, 0.0, -1.0};

void setUp(void)
{
    place_init(&place);
}

void tearDown(void) {}

static void stand(place_block_t block)
{
    TEST_ASSERT_TRUE(place_add(&place, &block));
}

static double ground_m(double x_m, double y_m)
{
    return place_below(&place, x_m, y_m, 10.0, 0.0).at.z;
}

static place_hit_t cast(double x, double y, double z, place_vector_t direction)
{
    place_hit_t hit;

    TEST_ASSERT_TRUE(place_cast(&place, (place_vector_t){x, y, z}, direction, 50.0, 0.0, &hit));
    return hit;
}

void test_an_empty_place_is_a_level_floor(void)
{
    NEAR(1e-12, 0.0, ground_m(3.0, -7.0));
    NEAR(1e-12, 1.5, cast(1.0, 2.0, 1.5, down).distance_m);
    NEAR(1e-12, 1.0, cast(1.0, 2.0, 1.5, down).incidence_cos);
    TEST_ASSERT_EQUAL_INT(-1, cast(1.0, 2.0, 1.5, down).block);
}

/* By hand: 30 degrees off straight down from 0.6 m is 0.6 / cos 30 away, 0.6 tan 30 aside. */
void test_a_slanting_ray_meets_the_floor_aside(void)
{
    const place_hit_t hit = cast(0.0, 0.0, 0.6, (place_vector_t){sin(30.0 * DEG), 0.0, -cos(30.0 * DEG)});

    NEAR(1e-9, 0.692820323, hit.distance_m);
    NEAR(1e-9, 0.346410162, hit.at.x);
    NEAR(1e-12, cos(30.0 * DEG), hit.incidence_cos);
}

void test_a_ray_upwards_or_level_meets_no_floor(void)
{
    place_hit_t hit;

    TEST_ASSERT_FALSE(
        place_cast(&place, (place_vector_t){0, 0, 1}, (place_vector_t){0, 0, 1}, 50.0, 0.0, &hit));
    TEST_ASSERT_FALSE(
        place_cast(&place, (place_vector_t){0, 0, 1}, (place_vector_t){1, 0, 0}, 50.0, 0.0, &hit));
}

void test_a_block_is_as_high_as_it_is_and_no_wider(void)
{
    stand((place_block_t){
        .x_m = 2, .y_m = 1, .length_m = 1, .width_m = 0.5, .near_top_m = 0.3, .far_top_m = 0.3});
    NEAR(1e-12, 0.3, ground_m(2.0, 1.0));
    NEAR(1e-12, 0.3, ground_m(1.501, 0.751));
    NEAR(1e-12, 0.0, ground_m(1.499, 1.0));
    NEAR(1e-12, 0.0, ground_m(2.0, 1.251));
    TEST_ASSERT_EQUAL_INT(0, place_below(&place, 2.0, 1.0, 10.0, 0.0).block);
}

/* A quarter of a turn makes its length its width. */
void test_a_turned_block_lies_across(void)
{
    stand((place_block_t){
        .heading_rad = 90.0 * DEG, .length_m = 2, .width_m = 0.2, .near_top_m = 1, .far_top_m = 1});
    NEAR(1e-12, 1.0, ground_m(0.0, 0.99));
    NEAR(1e-12, 0.0, ground_m(0.99, 0.0));
}

/* The seed's ramp: 0.28 m long, 0.25 m high; its slope is 0.892857, its normal 41.76 degrees off. */
void test_a_ramp_rises_evenly_along_its_heading(void)
{
    stand((place_block_t){.x_m = 0.14, .length_m = 0.28, .width_m = 1, .near_top_m = 0.0, .far_top_m = 0.25});
    NEAR(1e-9, 0.0625, ground_m(0.07, 0.3));
    NEAR(1e-9, 0.1875, ground_m(0.21, -0.3));
    const place_hit_t hit = place_below(&place, 0.1, 0.0, 5.0, 0.0);
    NEAR(1e-9, 0.892857143, hit.slope_x);
    NEAR(1e-12, 0.0, hit.slope_y);
    NEAR(1e-9, 0.745937662, hit.incidence_cos);
}

void test_a_ramp_turned_round_falls_along_x(void)
{
    stand((place_block_t){
        .heading_rad = 180.0 * DEG, .length_m = 1, .width_m = 1, .near_top_m = 0.0, .far_top_m = 0.4});
    NEAR(1e-9, 0.3, ground_m(-0.25, 0.0));
    NEAR(1e-9, 0.1, ground_m(0.25, 0.0));
    NEAR(1e-9, -0.4, place_below(&place, 0.1, 0.0, 5.0, 0.0).slope_x);
}

void test_a_level_ray_meets_a_wall_and_passes_over_a_low_one(void)
{
    stand((place_block_t){.x_m = 3, .length_m = 0.1, .width_m = 4, .near_top_m = 1, .far_top_m = 1});
    NEAR(1e-12, 2.95, cast(0.0, 0.0, 0.5, (place_vector_t){1, 0, 0}).distance_m);
    NEAR(1e-12, 1.0, cast(0.0, 0.0, 0.5, (place_vector_t){1, 0, 0}).incidence_cos);
    place_hit_t hit;
    TEST_ASSERT_FALSE(
        place_cast(&place, (place_vector_t){0, 0, 1.01}, (place_vector_t){1, 0, 0}, 50.0, 0.0, &hit));
}

void test_under_a_table_is_the_floor_and_over_it_the_board(void)
{
    stand(
        (place_block_t){.length_m = 1, .width_m = 1, .bottom_m = 0.7, .near_top_m = 0.73, .far_top_m = 0.73});
    NEAR(1e-12, 0.73, place_below(&place, 0, 0, 1.2, 0.0).at.z);
    NEAR(1e-12, 0.0, place_below(&place, 0, 0, 0.4, 0.0).at.z);
    NEAR(1e-12, 0.3, cast(0, 0, 0.4, (place_vector_t){0, 0, 1}).distance_m); /* its underside */
}

void test_the_nearest_of_several_is_met(void)
{
    for (int i = 0; i < 5; i++) {
        stand(
            (place_block_t){.x_m = 5.0 - i, .length_m = 0.1, .width_m = 1, .near_top_m = 1, .far_top_m = 1});
    }
    NEAR(1e-12, 0.95, cast(0, 0, 0.5, (place_vector_t){1, 0, 0}).distance_m);
}

void test_a_foot_is_there_in_its_time_alone(void)
{
    stand((place_block_t){
        .length_m = 1, .width_m = 1, .near_top_m = 0.1, .far_top_m = 0.1, .there = {5.0, 2.0}});
    NEAR(1e-12, 0.0, place_below(&place, 0, 0, 1, 4.999).at.z);
    NEAR(1e-12, 0.1, place_below(&place, 0, 0, 1, 5.0).at.z);
    NEAR(1e-12, 0.0, place_below(&place, 0, 0, 1, 7.0).at.z);
}

/* Up 0.6 m at 0.3 m/s from 10 s, stays 3 s: at the top from 12 to 15 s, down again at 17 s. */
TEST_CASE(9.0, 0.0, 0.0)
TEST_CASE(11.0, 0.3, 0.3)
TEST_CASE(13.0, 0.6, 0.0)
TEST_CASE(16.0, 0.3, -0.3)
TEST_CASE(18.0, 0.0, 0.0)
void test_a_lift_rises_stays_and_sinks(double t_s, double z_m, double rises_mps)
{
    stand((place_block_t){.length_m = 1,
                          .width_m = 1,
                          .bottom_m = -0.6,
                          .travel_m = 0.6,
                          .travel_mps = 0.3,
                          .travel_start_s = 10.0,
                          .stay_s = 3.0});
    const place_hit_t hit = place_below(&place, 0, 0, 2.0, t_s);
    NEAR(1e-9, z_m, hit.at.z);
    NEAR(1e-12, rises_mps, hit.rises_mps);
}

void test_a_full_place_takes_no_more(void)
{
    const place_block_t block = {.length_m = 1, .width_m = 1, .near_top_m = 1, .far_top_m = 1};

    for (int i = 0; i < PLACE_BLOCKS_MAX; i++) {
        TEST_ASSERT_TRUE(place_add(&place, &block));
    }
    TEST_ASSERT_FALSE(place_add(&place, &block));
    TEST_ASSERT_EQUAL_INT(PLACE_BLOCKS_MAX, place.count);
}

void test_the_side_of_a_block_is_run_into_and_its_top_carries(void)
{
    stand((place_block_t){.length_m = 1, .width_m = 1, .near_top_m = 0.4, .far_top_m = 0.4});
    TEST_ASSERT_TRUE(place_inside(&place, (place_vector_t){0.4, 0, 0.2}, 0.0));
    TEST_ASSERT_FALSE(place_inside(&place, (place_vector_t){0.6, 0, 0.2}, 0.0));
    TEST_ASSERT_FALSE(place_inside(&place, (place_vector_t){0.4, 0, 0.39}, 0.0));
    NEAR(1e-12, 0.4, place_below(&place, 0.4, 0, 0.39, 0.0).at.z);
}

/* Matern 3/2 with l = correlation / 2: at distance r the covariance is (1 + r/l) exp(-r/l); at r = l 0.7358.
 */
void test_a_rough_floor_has_its_rms_and_its_correlation(void)
{
    const place_rough_t rough = {.rms_m = 0.02, .correlation_m = 0.4};
    double squares = 0.0, products = 0.0;
    const int floors = 400, points = 25;

    for (int seed = 1; seed <= floors; seed++) {
        place_init(&place);
        place_roughen(&place, &rough, (unsigned long)seed);
        for (int i = 0; i < points; i++) {
            const double a = ground_m(i * 1.7, i * -0.9), b = ground_m(i * 1.7 + 0.2, i * -0.9);
            squares += a * a;
            products += a * b;
        }
    }
    const double variance = squares / (floors * points);
    NEAR(0.0008, 0.02, sqrt(variance));
    NEAR(0.03, 0.7358, products / (floors * points) / variance);
}

void test_a_rough_floor_has_the_slope_that_its_heights_have(void)
{
    const place_rough_t rough = {.rms_m = 0.02, .correlation_m = 0.4};

    place_roughen(&place, &rough, 3);
    for (double x = -2.0; x < 2.0; x += 0.37) {
        const double step = 1e-6;
        NEAR(1e-4, (ground_m(x + step, 0.2) - ground_m(x - step, 0.2)) / (2.0 * step),
             place_below(&place, x, 0.2, 1.0, 0.0).slope_x);
    }
}

/* Against a march in steps of 0.2 mm along the ray. Drawn blocks, drawn rays; the seed is in the message. */
void test_any_ray_meets_what_a_march_along_it_meets(void)
{
    noise_t noise;
    unsigned hits = 0;

    noise_init(&noise, 77, "rays");
    for (int ray = 0; ray < 150; ray++) {
        place_init(&place);
        for (int i = 0; i < 6; i++) {
            const double bottom = noise_uniform(&noise, 0.0, 0.4),
                         top = bottom + noise_uniform(&noise, 0.1, 0.6);
            stand((place_block_t){.x_m = noise_uniform(&noise, -1, 1),
                                  .y_m = noise_uniform(&noise, -1, 1),
                                  .heading_rad = noise_uniform(&noise, -4, 4),
                                  .length_m = noise_uniform(&noise, 0.1, 1),
                                  .width_m = noise_uniform(&noise, 0.1, 1),
                                  .bottom_m = bottom,
                                  .near_top_m = top,
                                  .far_top_m = top + 0.3});
        }
        const place_vector_t from = {-3.0, noise_uniform(&noise, -1, 1), noise_uniform(&noise, 0.1, 2)};
        const double aside = noise_uniform(&noise, -0.3, 0.3), sinking = noise_uniform(&noise, -0.4, 0.1);
        const place_vector_t direction = {cos(aside) * cos(sinking), sin(aside) * cos(sinking), sin(sinking)};
        place_hit_t hit;
        const bool met = place_cast(&place, from, direction, 6.0, 0.0, &hit);
        double marched = 0.0;
        bool inside = false;

        while (marched < 6.0 && !inside) {
            const place_vector_t at = {from.x + marched * direction.x, from.y + marched * direction.y,
                                       from.z + marched * direction.z};
            inside = at.z < 0.0;
            for (int i = 0; i < place.count && !inside; i++) {
                const place_block_t *b = &place.blocks[i];
                const double c = cos(b->heading_rad), s = sin(b->heading_rad);
                const double u = c * (at.x - b->x_m) + s * (at.y - b->y_m);
                const double v = -s * (at.x - b->x_m) + c * (at.y - b->y_m);
                const double top = b->near_top_m + (u / b->length_m + 0.5) * (b->far_top_m - b->near_top_m);
                inside = fabs(u) < b->length_m / 2 && fabs(v) < b->width_m / 2 && at.z > b->bottom_m &&
                         at.z < top;
            }
            marched += inside ? 0.0 : 2e-4;
        }
        TEST_ASSERT_EQUAL_INT(inside, met);
        if (met) {
            hits++;
            /* a corner that is cut by less than a step */
            TEST_ASSERT_TRUE(hit.distance_m < marched + 1e-9);
            NEAR(0.02, marched, hit.distance_m);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(60, hits);
}

/* ---- bars ---- */

static void lay_bars(double height_m)
{
    place.bars = (place_bars_t){.height_m = height_m, .period_m = 0.4, .share = 0.25, .from_m = 1.0};
}

/* Gap from 1 to 1.3 m, bar to 1.4, gap to 1.7, and so on; none before. */
TEST_CASE(0.05, 0.05, 0.0)
TEST_CASE(-0.05, -0.05, 0.0)
void test_bars_lie_across_the_floor_in_their_period_and_share(double height_m, double bar_m, double gap_m)
{
    lay_bars(height_m);
    NEAR(1e-12, gap_m, ground_m(-3.0, 0.0));
    NEAR(1e-12, gap_m, ground_m(0.95, 0.0));
    NEAR(1e-12, gap_m, ground_m(1.29, 5.0));
    NEAR(1e-12, bar_m, ground_m(1.31, -5.0));
    NEAR(1e-12, bar_m, ground_m(1.39, 0.0));
    NEAR(1e-12, gap_m, ground_m(1.41, 0.0));
    NEAR(1e-12, bar_m, ground_m(101.35, 0.0));
}

/* Down by 45 degrees from (1.1, 0.5): the floor at 1.6; with a bar of 0.1 at 1.3..1.4 its top is passed
 * at 1.5, its side not met. From (0.85, 0.5): on the bar's level at 1.25, and into its side at 1.3, 0.05
 * high. From the other side likewise. */
TEST_CASE(1.1, 1.0, 1.6, 0.0)
TEST_CASE(0.95, 1.0, 1.35, 0.1)
TEST_CASE(0.85, 1.0, 1.3, 0.05)
TEST_CASE(1.85, -1.0, 1.4, 0.05)
TEST_CASE(1.75, -1.0, 1.35, 0.1)
TEST_CASE(0.3, 1.0, 0.8, 0.0)
TEST_CASE(0.8, -1.0, 0.3, 0.0)
void test_a_slanting_ray_meets_a_bars_top_its_side_or_the_gap(double from_m, double towards, double x_m,
                                                              double z_m)
{
    lay_bars(0.1);
    const place_hit_t hit = cast(from_m, 0.0, 0.5, (place_vector_t){towards * sqrt(0.5), 0.0, -sqrt(0.5)});
    NEAR(1e-9, x_m, hit.at.x);
    NEAR(1e-9, z_m, hit.at.z);
    NEAR(1e-9, sqrt(0.5), hit.incidence_cos);
}

/* A groove of 0.1 from 1.3 to 1.4: into it, and onto its far wall. */
TEST_CASE(0.85, 1.0, 1.4, -0.05)
TEST_CASE(1.85, -1.0, 1.3, -0.05)
TEST_CASE(0.7, 1.0, 1.2, 0.0)
void test_a_ray_meets_a_grooves_wall(double from_m, double towards, double x_m, double z_m)
{
    lay_bars(-0.1);
    const place_hit_t hit = cast(from_m, 0.0, 0.5, (place_vector_t){towards * sqrt(0.5), 0.0, -sqrt(0.5)});
    NEAR(1e-9, x_m, hit.at.x);
    NEAR(1e-9, z_m, hit.at.z);
}

/* Its foot stands in a gap beside a bar: the bar carries a gear that comes to lie on it. */
void test_a_bar_carries_what_is_within_it(void)
{
    lay_bars(0.06);
    NEAR(1e-12, 0.06, place_below(&place, 1.35, 0.0, 0.01, 0.0).at.z);
    NEAR(1e-12, 0.0, place_below(&place, 1.25, 0.0, 0.01, 0.0).at.z);
}

void test_a_floor_may_lie_lower_between_blocks(void)
{
    place.level_m = -0.5;
    stand((place_block_t){.length_m = 2.0, .width_m = 2.0, .bottom_m = -0.5});
    NEAR(1e-12, 0.0, ground_m(0.5, 0.0));
    NEAR(1e-12, -0.5, ground_m(1.5, 0.0));
    NEAR(1e-12, 1.5, cast(1.5, 0.0, 1.0, down).distance_m);
}

/* What is left out of a cast because it lies aside is never what the ray meets. */
void test_no_block_is_overlooked(void)
{
    noise_t noise;

    noise_init(&noise, 9, "casts");
    for (int n = 0; n < 3000; n++) {
        const double x = noise_uniform(&noise, -3.0, 3.0), y = noise_uniform(&noise, -3.0, 3.0);
        const double turn = noise_uniform(&noise, 0.0, 2.0 * M_PI), steep = noise_uniform(&noise, 0.05, 1.57);
        const place_vector_t direction = {cos(turn) * cos(steep), sin(turn) * cos(steep), -sin(steep)};
        const double heading = noise_uniform(&noise, 0.0, 2.0 * M_PI);
        const double half_m = noise_uniform(&noise, 0.02, 1.0);
        double first_m = 2.0 / sin(steep); /* the floor from 2 m */

        place_init(&place);
        stand((place_block_t){.heading_rad = heading,
                              .length_m = 2.0 * half_m,
                              .width_m = 0.3,
                              .near_top_m = 1.0,
                              .far_top_m = 1.0});
        /* Walks along the ray in millimetres. */
        for (double at_m = 0.0; at_m < first_m; at_m += 0.001) {
            const double px = x + at_m * direction.x, py = y + at_m * direction.y,
                         pz = 2.0 + at_m * direction.z;
            const double u = cos(heading) * px + sin(heading) * py, v = cos(heading) * py - sin(heading) * px;

            if (fabs(u) < half_m && fabs(v) < 0.15 && pz < 1.0) {
                first_m = at_m;
            }
        }
        NEAR(0.02, first_m, cast(x, y, 2.0, direction).distance_m);
    }
}

void test_a_block_is_told_as_it_is_at_a_time(void)
{
    place_block_t told;

    place_init(&place);
    place_add(&place, &(place_block_t){.length_m = 1.0,
                                       .width_m = 1.0,
                                       .bottom_m = -0.1,
                                       .travel_m = 0.5,
                                       .travel_mps = 0.25,
                                       .travel_start_s = 2.0,
                                       .stay_s = 1.0});
    place_add(&place, &(place_block_t){.length_m = 1.0, .width_m = 1.0, .there = {3.0, 1.0}});
    TEST_ASSERT_TRUE(place_block_at(&place, 0, 3.0, &told));
    NEAR(1e-12, 0.25, told.far_top_m);
    NEAR(1e-12, 0.25, told.near_top_m);
    NEAR(1e-12, 0.15, told.bottom_m);
    TEST_ASSERT_TRUE(place_block_at(&place, 0, 4.5, &told));
    NEAR(1e-12, 0.5, told.far_top_m);
    TEST_ASSERT_FALSE(place_block_at(&place, 1, 2.9, &told));
    TEST_ASSERT_TRUE(place_block_at(&place, 1, 3.5, &told));
}
