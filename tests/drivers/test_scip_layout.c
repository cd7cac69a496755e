#include "unity.h"

#include <math.h>
#include <string.h>

#include "drivers/scip_layout.h"
#include "drivers/scip_request.h"

static uint16_t points[SCIP_POINTS_MAX];
static scip_scan_t scan;

void setUp(void)
{
    memset(points, 0, sizeof points);
    scan = (scip_scan_t){.distance_mm = points,
                         .capacity = SCIP_POINTS_MAX,
                         .points = 35,
                         .characters = 2,
                         .first_step = 372,
                         .cluster = 1};
}

void tearDown(void) {}

static void fill(uint16_t value)
{
    for (uint16_t i = 0; i < scan.points; i++) {
        points[i] = value;
    }
}

static scip_group_mean_t mean_of(uint16_t first, uint16_t last)
{
    const scip_group_t group = {first, last};
    return scip_group_mean(&scan, &group);
}

static scip_group_steps_t steps_of(uint16_t first, uint16_t last)
{
    const scip_group_t group = {first, last};
    const scip_group_mean_t mean = scip_group_mean(&scan, &group);
    return scip_group_steps(&scan, &group, &mean);
}

/* --- the table
 * ---------------------------------------------------------------------------------------------------- */

void test_every_layout_can_be_asked_for_and_holds_its_groups(void)
{
    uint16_t largest = 0;
    for (int id = 0; id < SCIP_LAYOUT_COUNT; id++) {
        const scip_layout_t *layout = &scip_layouts[id];
        const scip_range_t range = scip_layout_range(layout, 250000U);
        scip_request_t request;
        TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_STREAM_2, &range));
        largest = request.points > largest ? request.points : largest;
        TEST_ASSERT_GREATER_OR_EQUAL_UINT16(SCIP_STEP_FIRST, layout->first_step);
        TEST_ASSERT_LESS_OR_EQUAL_UINT16(SCIP_STEP_LAST, layout->last_step);
        TEST_ASSERT_EQUAL_UINT16(id + 1, layout->group_count);
        TEST_ASSERT_EQUAL_UINT16(layout->first_step, layout->groups[0].first_step);
        TEST_ASSERT_EQUAL_UINT16(layout->last_step, layout->groups[layout->group_count - 1].last_step);
        for (uint16_t g = 0; g < layout->group_count; g++) {
            TEST_ASSERT_LESS_OR_EQUAL_UINT16(layout->groups[g].last_step, layout->groups[g].first_step);
            if (g > 0) {
                TEST_ASSERT_GREATER_THAN_UINT16(layout->groups[g - 1].last_step,
                                                layout->groups[g].first_step);
            }
        }
    }
    TEST_ASSERT_LESS_OR_EQUAL_UINT16(SCIP_LAYOUT_POINTS_MAX, largest);
}

void test_the_layouts_are_those_of_the_vehicle(void)
{
    const scip_layout_t *front = &scip_layouts[SCIP_LAYOUT_FRONT];
    const scip_layout_t *beams = &scip_layouts[SCIP_LAYOUT_TWO_BEAMS];
    const scip_layout_t *mirrors = &scip_layouts[SCIP_LAYOUT_THREE_MIRRORS];
    TEST_ASSERT_EQUAL_STRING("front", front->name);
    TEST_ASSERT_EQUAL_UINT16(372, front->first_step);
    TEST_ASSERT_EQUAL_UINT16(406, front->last_step);
    TEST_ASSERT_EQUAL_STRING("two-beams", beams->name);
    TEST_ASSERT_EQUAL_UINT16(249, beams->first_step);
    TEST_ASSERT_EQUAL_UINT16(519, beams->last_step);
    TEST_ASSERT_EQUAL_UINT16(277, beams->groups[0].last_step);
    TEST_ASSERT_EQUAL_UINT16(491, beams->groups[1].first_step);
    for (uint16_t g = 0; g < 2; g++) { /* two beams of about 10 degrees */
        TEST_ASSERT_FLOAT_WITHIN(0.3F, 10.0F,
                                 scip_step_degrees(beams->groups[g].last_step + 1) -
                                     scip_step_degrees(beams->groups[g].first_step));
    }
    TEST_ASSERT_EQUAL_STRING("three-mirrors", mirrors->name);
    for (uint16_t g = 0; g < 3; g++) { /* mirrors at 30, 120 and 210 degrees; the front is 120 */
        const uint16_t centre = scip_step_at_degrees(90.0F * (float)g - 90.0F);
        TEST_ASSERT_EQUAL_UINT16(128 + 256 * g, centre);
        TEST_ASSERT_EQUAL_UINT16(34, mirrors->groups[g].last_step - mirrors->groups[g].first_step);
        TEST_ASSERT_TRUE(mirrors->groups[g].first_step <= centre - 5);
        TEST_ASSERT_TRUE(mirrors->groups[g].last_step >= centre + 5);
    }
}

/* --- the mean
 * ----------------------------------------------------------------------------------------------------- */

void test_equal_rays_give_that_distance_and_no_spread(void)
{
    fill(600);
    scip_group_mean_t mean = mean_of(372, 406);
    TEST_ASSERT_TRUE(mean.valid);
    TEST_ASSERT_EQUAL_FLOAT(600.0F, mean.mean_mm);
    TEST_ASSERT_EQUAL_UINT16(0, mean.spread_mm);
    TEST_ASSERT_EQUAL_UINT16(35, mean.good_rays);
}

void test_codes_and_overrange_take_no_part(void)
{
    fill(1000);
    for (uint16_t i = 0; i < 10; i++) {
        points[i] = i < 5 ? i : 4095;
    }
    points[10] = 19;
    points[11] = 20;
    points[12] = 4094;
    scip_group_mean_t mean = mean_of(372, 406);
    TEST_ASSERT_EQUAL_UINT16(24, mean.good_rays);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 1000.0F,
                             mean.mean_mm); /* 20 and 4094 are good, and far from the median */
    TEST_ASSERT_EQUAL_UINT16(4074, mean.spread_mm);
    TEST_ASSERT_TRUE(mean.valid);
}

void test_three_character_scans_reach_to_5600(void)
{
    static const uint16_t sent[] = {4095, 5600, 5601, 65535};
    static const uint16_t good[] = {1, 1, 0, 0};
    scan.characters = 3;
    for (unsigned i = 0; i < 4; i++) {
        points[0] = sent[i];
        TEST_ASSERT_EQUAL_UINT16(good[i], mean_of(372, 372).good_rays);
        TEST_ASSERT_EQUAL(good[i] != 0, mean_of(372, 372).valid);
    }
}

void test_half_of_the_rays_must_be_good(void)
{
    for (uint16_t good = 0; good <= 35; good++) {
        fill(0);
        for (uint16_t i = 0; i < good; i++) {
            points[34 - i] = (uint16_t)(500 + i);
        }
        scip_group_mean_t mean = mean_of(372, 406);
        TEST_ASSERT_EQUAL_UINT16(good, mean.good_rays);
        TEST_ASSERT_EQUAL(good >= 18, mean.valid);
        TEST_ASSERT_EQUAL_UINT16(good > 0 ? good - 1 : 0, mean.spread_mm);
        TEST_ASSERT_FLOAT_WITHIN(0.01F, good > 0 ? 500.0F + (float)(good - 1) / 2 : 0.0F, mean.mean_mm);
    }
    fill(0);
    points[0] = points[1] = 700;
    TEST_ASSERT_TRUE(mean_of(372, 375).valid);  /* 2 of 4 */
    TEST_ASSERT_FALSE(mean_of(372, 376).valid); /* 2 of 5 */
}

void test_only_the_group_counts(void)
{
    for (uint16_t i = 0; i < 35; i++) {
        points[i] = (uint16_t)(1000 + i);
    }
    scip_group_mean_t mean = mean_of(380, 390);
    TEST_ASSERT_EQUAL_UINT16(11, mean.good_rays);
    TEST_ASSERT_EQUAL_FLOAT(1013.0F, mean.mean_mm);
    TEST_ASSERT_EQUAL_UINT16(10, mean.spread_mm);
    mean = mean_of(372, 372);
    TEST_ASSERT_EQUAL_FLOAT(1000.0F, mean.mean_mm);
    mean = mean_of(406, 406);
    TEST_ASSERT_EQUAL_FLOAT(1034.0F, mean.mean_mm);
}

void test_rays_that_the_scan_does_not_hold_are_bad(void)
{
    fill(800);
    TEST_ASSERT_EQUAL_UINT16(9, mean_of(362, 380).good_rays); /* of 19 */
    TEST_ASSERT_FALSE(mean_of(362, 380).valid);
    TEST_ASSERT_TRUE(mean_of(363, 380).valid); /* 9 of 18 */
    TEST_ASSERT_EQUAL_UINT16(7, mean_of(400, 413).good_rays);
    TEST_ASSERT_TRUE(mean_of(400, 413).valid);
    TEST_ASSERT_FALSE(mean_of(400, 414).valid);
    TEST_ASSERT_EQUAL_UINT16(35, mean_of(0, 768).good_rays);
    TEST_ASSERT_FALSE(mean_of(0, 768).valid);
    TEST_ASSERT_EQUAL_UINT16(0, mean_of(0, 371).good_rays);
    TEST_ASSERT_EQUAL_UINT16(0, mean_of(407, 500).good_rays);
    TEST_ASSERT_FALSE(mean_of(500, 600).valid);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, steps_of(407, 500).variance);
    scan.points = 0;
    TEST_ASSERT_EQUAL_UINT16(0, mean_of(372, 406).good_rays);
}

void test_with_a_cluster_a_ray_is_a_point_wholly_inside_the_group(void)
{
    scan.first_step = 100;
    scan.cluster = 5;
    scan.points = 20; /* 100..104, 105..109, .. 195..199 */
    for (uint16_t i = 0; i < 20; i++) {
        points[i] = (uint16_t)(500 + i + (i == 3 ? 6 : 0));
    }
    scip_group_mean_t mean = mean_of(110, 124);
    TEST_ASSERT_EQUAL_UINT16(3, mean.good_rays);
    /* 502, 509, 504: from their line -2, 4, -2; what 1 / cos bends at 505 mm adds 0.08, 0.16, 0.08 to that.
     * One of three points is free; 2.18 such mean deviations, because each point is the nearest of five rays
     */
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 505.0F + 2.18F * (8.0F + 0.32F) / 2.0F, mean.mean_mm);
    TEST_ASSERT_EQUAL_FLOAT(117.0F, steps_of(110, 124).mean);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, (15.0F * 15.0F - 1.0F) / 12.0F, steps_of(110, 124).variance);
    mean = mean_of(109, 125);
    TEST_ASSERT_EQUAL_UINT16(3, mean.good_rays);
    TEST_ASSERT_TRUE(mean.valid);
    mean = mean_of(111, 123);
    TEST_ASSERT_EQUAL_UINT16(1, mean.good_rays);
    TEST_ASSERT_EQUAL_FLOAT(509.0F, mean.mean_mm);
    TEST_ASSERT_EQUAL_FLOAT(117.0F, steps_of(111, 123).mean);
    TEST_ASSERT_EQUAL_FLOAT(2.0F, steps_of(111, 123).variance);
    TEST_ASSERT_EQUAL_UINT16(0, mean_of(111, 114).good_rays);
    TEST_ASSERT_FALSE(mean_of(111, 114).valid);
    TEST_ASSERT_EQUAL_UINT16(20, mean_of(100, 199).good_rays);
}

/* A tilted fan above level ground, as its rays tell it without noise: whole millimetres, the nearest of four.
 */
void test_a_plane_that_a_cluster_looks_at_aslant_is_no_noise(void)
{
    scan.first_step = 372;
    scan.cluster = 4;
    scan.points = 8;
    for (int slope = -10; slope <= 10; slope += 5) {
        double mean_mm = 0.0, nearest_mm = 0.0;

        for (int i = 0; i < 32; i++) {
            const double a = (372 + i - 384) * 0.006135923, q = tan(slope * 0.0174533);
            const double ray_mm = 105.0 + 700.0 / (cos(a) - q * sin(a));

            mean_mm += ray_mm / 32.0;
            nearest_mm = (i % 4 == 0) ? ray_mm : fmin(nearest_mm, ray_mm);
            points[i / 4] = (uint16_t)lround(nearest_mm);
        }
        /* As noise the slope alone would add 12 mm at 10 degrees. The nearest of four is up to 1.1 mm nearer.
         */
        TEST_ASSERT_FLOAT_WITHIN(1.2F, (float)mean_mm, mean_of(372, 406).mean_mm);
    }
}

void test_with_a_cluster_of_two_every_point_has_two_steps(void)
{
    scan.cluster = 2; /* 35 points: 372..441 */
    fill(700);
    TEST_ASSERT_EQUAL_UINT16(5, mean_of(372, 381).good_rays);
    TEST_ASSERT_EQUAL_UINT16(35, mean_of(372, 441).good_rays);
}

void test_a_cluster_of_zero_is_one_as_on_the_wire(void)
{
    fill(700);
    scan.cluster = 0;
    TEST_ASSERT_EQUAL_UINT16(35, mean_of(372, 406).good_rays);
    TEST_ASSERT_TRUE(mean_of(372, 406).valid);
}

void test_the_largest_group_of_the_largest_distances_does_not_overflow(void)
{
    scan.first_step = 0;
    scan.points = 769;
    scan.characters = 3;
    fill(5600);
    scip_group_mean_t mean = mean_of(0, 768);
    TEST_ASSERT_EQUAL_UINT16(769, mean.good_rays);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 5600.0F, mean.mean_mm);
}

/* --- directions and times
 * ----------------------------------------------------------------------------------------- */

void test_steps_are_1024_to_the_turn_from_the_front_to_the_left(void)
{
    static const struct {
        uint16_t step;
        float degrees;
    } rows[] = {
        {384, 0.0F},        {372, -4.21875F},  {406, 7.734375F},    {249, -47.4609375F},
        {519, 47.4609375F}, {44, -119.53125F}, {725, 119.8828125F},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_FLOAT_WITHIN(0.000001F, rows[i].degrees, scip_step_degrees(rows[i].step));
        TEST_ASSERT_EQUAL_UINT16(rows[i].step, scip_step_at_degrees(rows[i].degrees));
    }
}

void test_a_direction_finds_its_nearest_step(void)
{
    for (uint16_t step = SCIP_STEP_FIRST; step <= SCIP_STEP_LAST; step++) {
        TEST_ASSERT_EQUAL_UINT16(step, scip_step_at_degrees(scip_step_degrees(step) + 0.17F));
        TEST_ASSERT_EQUAL_UINT16(step, scip_step_at_degrees(scip_step_degrees(step) - 0.17F));
    }
}

void test_directions_outside_the_field_of_view_end_at_its_edges(void)
{
    TEST_ASSERT_EQUAL_UINT16(44, scip_step_at_degrees(-120.0F));
    TEST_ASSERT_EQUAL_UINT16(44, scip_step_at_degrees(-1.0e9F));
    TEST_ASSERT_EQUAL_UINT16(44, scip_step_at_degrees(-INFINITY));
    TEST_ASSERT_EQUAL_UINT16(44, scip_step_at_degrees(NAN));
    TEST_ASSERT_EQUAL_UINT16(725, scip_step_at_degrees(121.0F));
    TEST_ASSERT_EQUAL_UINT16(725, scip_step_at_degrees(1.0e9F));
    TEST_ASSERT_EQUAL_UINT16(725, scip_step_at_degrees(INFINITY));
}

/* --- something in front of some rays
 * ------------------------------------------------------------------------------ */

/* The plain mean would be wrong by up to 157 mm with a fifth of the rays on a leg at 215 mm. */
void test_a_leg_in_front_of_fewer_than_half_of_the_rays_does_not_move_the_mean(void)
{
    for (uint16_t blocked = 0; blocked <= 17; blocked++) {
        for (uint16_t first = 0; first + blocked <= 35; first++) {
            fill(1000);
            for (uint16_t i = 0; i < 35; i++) {
                points[i] = (uint16_t)(990 + i * 13 % 21);
            }
            for (uint16_t i = first; i < first + blocked; i++) {
                points[i] = (uint16_t)(215 + i);
            }
            const scip_group_mean_t mean = mean_of(372, 406);
            TEST_ASSERT_FLOAT_WITHIN(6.0F, 1000.0F, mean.mean_mm);
            TEST_ASSERT_EQUAL_UINT16(35, mean.good_rays);
            TEST_ASSERT_TRUE(mean.valid);
        }
    }
}

/* A slow reference: sort the good rays, take the lower median, then the mean of what is near it. */
static scip_group_mean_t reference_mean(uint16_t begin, uint16_t end, uint16_t furthest,
                                        scip_group_steps_t *where)
{
    uint16_t sorted[35], count = 0;
    uint32_t sum = 0, near = 0, steps = 0,
             steps2 = 0; /* steps behind 372: whole numbers, exact where double is float */
    scip_group_mean_t mean = {.good_rays = 0};
    for (uint16_t i = begin; i < end; i++) {
        uint16_t at = count;
        if (points[i] < 20 || points[i] > furthest) {
            continue;
        }
        for (; at > 0 && sorted[at - 1] > points[i]; at--) {
            sorted[at] = sorted[at - 1];
        }
        sorted[at] = points[i];
        count++;
    }
    for (uint16_t i = 0; i < count; i++) {
        const int32_t off = (int32_t)sorted[i] - (int32_t)sorted[(count - 1) / 2];
        if (off >= -25 && off <= 25) {
            sum += sorted[i];
            near++;
        }
    }
    for (uint16_t i = begin; i < end; i++) {
        const int32_t off = (int32_t)points[i] - (count > 0 ? (int32_t)sorted[(count - 1) / 2] : 0);
        if (points[i] >= 20 && points[i] <= furthest && off >= -25 && off <= 25) {
            steps += i;
            steps2 += (uint32_t)i * i;
        }
    }
    if (count > 0) {
        where->mean = 372.0F + (float)steps / (float)near;
        where->variance = (float)(near * steps2 - steps * steps) / (float)(near * near);
        mean.mean_mm = (float)sum / (float)near;
        mean.spread_mm = (uint16_t)(sorted[count - 1] - sorted[0]);
    }
    mean.good_rays = count;
    return mean;
}

/* Groups of any rays of the scan, some of them bad; in every second run distances about the furthest that
 * count, in every third about the nearest. */
void test_the_mean_is_that_of_the_good_rays_within_25_mm_of_their_median(void)
{
    uint32_t noise = 20261U;
    for (uint32_t run = 0; run < 6000; run++) {
        const uint32_t width = 1U + run % 300U;
        const uint16_t base = run % 2U == 0U ? 4030U : (run % 3U == 0U ? 10U : 400U);
        const uint16_t begin = (uint16_t)(run % 7U == 0U ? 0U : (noise >> 9) % 20U);
        const uint16_t end = (uint16_t)(run % 7U == 0U ? 35U : begin + 1U + (noise >> 17) % (35U - begin));
        for (uint16_t i = 0; i < 35; i++) {
            noise = noise * 1664525U + 1013904223U;
            points[i] = (uint16_t)(base + (noise >> 8) % width * ((noise >> 30) == 0U ? 3U : 1U));
            points[i] = (noise >> 25) % 5U == 0U && run % 5U == 0U ? 7U : points[i];
        }
        scip_group_steps_t where = {.mean = 0.0F};
        const scip_group_mean_t expected = reference_mean(begin, end, 4094, &where);
        const scip_group_mean_t mean = mean_of((uint16_t)(372 + begin), (uint16_t)(372 + end - 1));
        TEST_ASSERT_EQUAL_UINT16(expected.good_rays, mean.good_rays);
        TEST_ASSERT_EQUAL_UINT16(expected.spread_mm, mean.spread_mm);
        TEST_ASSERT_FLOAT_WITHIN(0.001F, expected.mean_mm, mean.mean_mm);
        const scip_group_steps_t steps = steps_of((uint16_t)(372 + begin), (uint16_t)(372 + end - 1));
        if (expected.good_rays > 0U) {
            TEST_ASSERT_FLOAT_WITHIN(0.001F, where.mean, steps.mean);
            TEST_ASSERT_FLOAT_WITHIN(0.001F, where.variance, steps.variance);
        }
        TEST_ASSERT_EQUAL(2 * expected.good_rays >= end - begin, mean.valid);
    }
}

/* 97.66 us a step: step 384 at 37.5 ms, step 725 at 70.8 ms. */
void test_steps_are_sampled_one_after_the_other(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, scip_step_delay_us(0));
    TEST_ASSERT_EQUAL_UINT32(37500, scip_step_delay_us(384));
    TEST_ASSERT_EQUAL_UINT32(70800, scip_step_delay_us(725));
    TEST_ASSERT_EQUAL_UINT32(99902, scip_step_delay_us(1023));
}

/* Revolution, less the rays' instant, and the scan's octets: 101, 587, 1157 of them, 40 or 86.8 us each. */
void test_the_age_of_the_rays_follows_from_layout_and_bit_rate(void)
{
    static const struct {
        uint16_t first, last, characters;
        uint32_t rate, age_us;
    } rows[] = {
        {372, 406, 2, 250000, 70500},  {372, 406, 2, 115200, 75233},  {249, 519, 2, 250000, 90428},
        {249, 519, 2, 115200, 117903}, {111, 657, 2, 250000, 113228}, {111, 657, 2, 115200, 167382},
        {372, 406, 3, 250000, 71900},
    };
    for (uint16_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        scan.first_step = rows[i].first;
        scan.points = (uint16_t)(rows[i].last - rows[i].first + 1);
        scan.characters = rows[i].characters;
        TEST_ASSERT_UINT32_WITHIN(40, rows[i].age_us, scip_rays_age_us(&scan, rows[i].rate));
    }
    scan.first_step = 372;
    scan.points = 35;
    scan.characters = 2;
    TEST_ASSERT_EQUAL_UINT32(70500, scip_rays_age_us(&scan, 250000));
    scan.points = 547; /* 1157 octets */
    scan.first_step = 111;
    TEST_ASSERT_EQUAL_UINT32(100000 - (34000 + scip_step_delay_us(384) - scip_step_delay_us(389)) + 602604 +
                                 460,
                             scip_rays_age_us(&scan, 19200));
    scan.first_step = 372;
    scan.points = 12;
    scan.cluster = 3;
    TEST_ASSERT_UINT32_WITHIN(100, 70500 - 23 * 2 * 40, scip_rays_age_us(&scan, 250000));
}

/* The seed's equations 27 and 28 say 46.3 ms. They count two octets fewer for a short answer and eight for a
 * long one, and leave out that the middle of the two beams is five steps before that of the front's. */
void test_the_rays_of_the_seeds_first_bracket_were_47_ms_older_than_those_of_its_last(void)
{
    const scip_scan_t two_beams = {.first_step = 249, .points = 271, .cluster = 1, .characters = 2};
    const scip_scan_t front = {.first_step = 372, .points = 35, .cluster = 1, .characters = 2};

    TEST_ASSERT_UINT32_WITHIN(100, 47400,
                              scip_rays_age_us(&two_beams, 115200) - scip_rays_age_us(&front, 250000));
}

void test_several_mirrors_are_asked_for_by_four_steps_a_point(void)
{
    for (uint16_t i = 0U; i < SCIP_LAYOUT_COUNT; i++) {
        const uint16_t expected = scip_layouts[i].group_count > 1U ? 4U : 1U;

        TEST_ASSERT_EQUAL_UINT16(expected, scip_layout_cluster(&scip_layouts[i], 115200U));
        TEST_ASSERT_EQUAL_UINT16(expected, scip_layout_cluster(&scip_layouts[i], 250000U));
    }
    TEST_ASSERT_EQUAL_UINT16(8U, scip_layout_cluster(&scip_layouts[SCIP_LAYOUT_THREE_MIRRORS], 19200U));
}

/* Octets of a scan, their time on the line, and the age of the front's rays. */
void test_what_three_mirrors_cost_on_the_line(void)
{
    static const struct {
        uint32_t bit_rate;
        uint16_t cluster, octets;
        uint32_t age_us;
    } rows[] = {{250000U, 1U, 1157U, 113228U}, {250000U, 4U, 309U, 79504U}, {115200U, 4U, 309U, 93966U}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        scip_scan_t seen = {.first_step = 111, .characters = 2, .cluster = rows[i].cluster};

        seen.points = (uint16_t)(547U / rows[i].cluster);
        TEST_ASSERT_EQUAL_UINT16(rows[i].octets, scip_scan_octets(SCIP_STREAM_2, seen.points));
        TEST_ASSERT_UINT32_WITHIN(2, rows[i].age_us, scip_rays_age_us(&seen, rows[i].bit_rate));
    }
}

void test_a_layout_around_its_middles_is_that_of_the_vehicle(void)
{
    static const uint16_t middles[] = {128U, 389U, 640U};
    const scip_layout_t *of_table = &scip_layouts[SCIP_LAYOUT_THREE_MIRRORS];
    const scip_layout_t three = scip_layout_around(middles, 3U, 17U);
    const scip_layout_t front = scip_layout_around(&middles[1], 1U, 17U);

    TEST_ASSERT_EQUAL_UINT16(of_table->first_step, three.first_step);
    TEST_ASSERT_EQUAL_UINT16(of_table->last_step, three.last_step);
    TEST_ASSERT_EQUAL_UINT16(3U, three.group_count);
    TEST_ASSERT_EQUAL_MEMORY(of_table->groups, three.groups, sizeof three.groups);
    TEST_ASSERT_EQUAL_UINT16(1U, front.group_count);
    TEST_ASSERT_EQUAL_UINT16(0U, front.groups[1].first_step); /* one middle is read, and no more */
    TEST_ASSERT_EQUAL_UINT16(372U, front.first_step);
    TEST_ASSERT_EQUAL_UINT16(406U, front.last_step);
}

/* A quarter of a revolution apart, less the 5 steps by which the front's windows is off its axis. */
void test_each_mirror_was_seen_at_its_own_time(void)
{
    const scip_layout_t *three = &scip_layouts[SCIP_LAYOUT_THREE_MIRRORS];
    const scip_scan_t seen = {.first_step = 111, .points = 136, .cluster = 4, .characters = 2};
    const scip_scan_t alone = {.first_step = 372, .points = 35, .cluster = 1, .characters = 2};

    TEST_ASSERT_INT32_WITHIN(100, -24900, scip_group_later_us(&seen, &three->groups[0]));
    TEST_ASSERT_INT32_WITHIN(100, 630, scip_group_later_us(&seen, &three->groups[1]));
    TEST_ASSERT_INT32_WITHIN(100, 25100, scip_group_later_us(&seen, &three->groups[2]));
    TEST_ASSERT_EQUAL_INT32(0, scip_group_later_us(&alone, &scip_layouts[SCIP_LAYOUT_FRONT].groups[0]));
}

/* The lower one of the two in the middle, of group and scan alike. */
void test_a_scan_of_an_even_number_of_steps_was_seen_when_its_group_was(void)
{
    const scip_scan_t even = {.first_step = 372, .points = 34, .cluster = 1, .characters = 2};
    const scip_group_t whole = {372, 405};

    TEST_ASSERT_EQUAL_INT32(0, scip_group_later_us(&even, &whole));
}

static unsigned long draw;

/* Sum of twelve even ones: mean 0, deviation 1. */
static double normal(void)
{
    double sum = -6.0;

    for (int i = 0; i < 12; i++) {
        draw = (draw * 1103515245UL + 12345UL) & 0x7FFFFFFFUL;
        sum += (double)draw / 2147483648.0;
    }
    return sum;
}

/* 5 mm of white noise: a cluster tells the nearest of its rays, the mean of a mirror is right all the same.
 */
void test_the_mean_of_clusters_is_not_too_near(void)
{
    draw = 1UL;
    for (uint16_t cluster = 1U; cluster <= 8U; cluster++) {
        double sum_mm = 0.0;

        for (int turn = 0; turn < 60; turn++) {
            scan = (scip_scan_t){.first_step = 372,
                                 .points = 32U / cluster,
                                 .cluster = cluster,
                                 .characters = 2,
                                 .distance_mm = points};
            for (uint16_t i = 0U; i < scan.points; i++) {
                double nearest_mm = 1e9;

                for (uint16_t k = 0U; k < cluster; k++) {
                    const double mm = 1000.0 + 5.0 * normal();
                    nearest_mm = mm < nearest_mm ? mm : nearest_mm;
                }
                points[i] = (uint16_t)(nearest_mm + 0.5);
            }
            sum_mm += (double)mean_of(372, 403).mean_mm;
        }
        TEST_ASSERT_FLOAT_WITHIN_MESSAGE(1.0F, 1000.0F, (float)(sum_mm / 60.0), "mean, mm");
    }
}

/* Mean deviation of points from the plane that they show: level ground at their mean distance, and their own
 * slope. Less two of them, because mean and slope are theirs. */
static double off_plane_mm(uint16_t count, uint16_t cluster)
{
    const double step_rad = 0.006135923 * cluster, middle = 0.5 * (count - 1);
    double mean = 0.0, aslant = 0.0, wide = 0.0, bent = 0.0, sum = 0.0;

    for (uint16_t i = 0U; i < count; i++) {
        mean += (double)points[i] / count;
        aslant += (i - middle) * points[i];
        wide += (i - middle) * (i - middle);
    }
    for (uint16_t i = 0U; i < count; i++) {
        bent = 0.5 * mean * step_rad * step_rad * ((i - middle) * (i - middle) - wide / count);
        sum += fabs(points[i] - mean - aslant / wide * (i - middle) - bent);
    }
    return sum / (count - 1.0);
}

/* Eight points, every second one 4 mm farther; a point behind them in memory, as near as they are, is another
 * mirror's. The factors are the drivers' table. */
void test_the_mean_of_clusters_is_raised_by_the_table_up_to_eight_steps_and_no_more_beyond(void)
{
    static const double raised_by[] = {0.0, 0.86, 1.42, 1.84, 2.18, 2.46, 2.71, 2.92, 2.92, 2.92};

    for (uint16_t cluster = 1U; cluster <= 10U; cluster++) {
        scan = (scip_scan_t){
            .first_step = 372, .points = 9, .cluster = cluster, .characters = 2, .distance_mm = points};
        for (uint16_t i = 0U; i < 8U; i++) {
            points[i] = (uint16_t)(1000U + 4U * (i % 2U));
        }
        points[8] = 1004U;
        const scip_group_mean_t mean = mean_of(372, (uint16_t)(371U + 8U * cluster));
        TEST_ASSERT_EQUAL_UINT16(8U, mean.good_rays);
        TEST_ASSERT_FLOAT_WITHIN(
            0.001F, (float)(1002.0 + off_plane_mm(8U, cluster) * raised_by[cluster - 1U]), mean.mean_mm);
    }
}

void test_bad_rays_take_no_part_in_the_deviation_of_clusters(void)
{
    scan = (scip_scan_t){
        .first_step = 372, .points = 8, .cluster = 2, .characters = 2, .distance_mm = points};
    for (uint16_t i = 0U; i < 8U; i++) {
        points[i] = (uint16_t)(i < 6U ? 1000U + 4U * (i % 2U) : 7U);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.001F, (float)(1002.0 + off_plane_mm(6U, 2U) * 0.86),
                             mean_of(372, 387).mean_mm);
}

void test_two_points_have_a_plane_of_their_own_and_nothing_added(void)
{
    scan = (scip_scan_t){
        .first_step = 372, .points = 2, .cluster = 8, .characters = 2, .distance_mm = points};
    points[0] = 600U;
    points[1] = 604U;
    TEST_ASSERT_FLOAT_WITHIN(0.0F, 602.0F, mean_of(372, 387).mean_mm);
}

/* A group in the middle of a scan: its points begin behind its first step. */
void test_of_clusters_of_two_those_of_the_group_alone_count(void)
{
    scan = (scip_scan_t){
        .first_step = 372, .points = 16, .cluster = 2, .characters = 2, .distance_mm = points};
    for (uint16_t i = 0U; i < scan.points; i++) {
        points[i] = (uint16_t)(i >= 4U && i < 8U ? 600U : 900U);
    }
    const scip_group_mean_t mean = mean_of(380, 387);
    TEST_ASSERT_EQUAL_UINT16(4U, mean.good_rays);
    TEST_ASSERT_EQUAL_UINT16(0U, mean.spread_mm);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 600.0F, mean.mean_mm); /* a plane is bent by that */
}

/* A point far from the others is no noise: neither the mean nor its correction knows it. */
void test_a_point_beside_the_mirror_does_not_raise_the_mean_of_clusters(void)
{
    float mean_mm[2];

    for (int far = 0; far < 2; far++) {
        scan = (scip_scan_t){
            .first_step = 372, .points = 16, .cluster = 2, .characters = 2, .distance_mm = points};
        for (uint16_t i = 0U; i < scan.points; i++) {
            points[i] = (uint16_t)(1000U + i % 3U);
        }
        points[7] = (uint16_t)((far != 0) ? 3000U : 1001U);
        mean_mm[far] = mean_of(372, 403).mean_mm;
    }
    TEST_ASSERT_FLOAT_WITHIN(0.2F, mean_mm[0], mean_mm[1]);
}

/* 488 points take 1035 octets, nine tenths of a revolution at 115000 bit/s; 489 take 1037. */
void test_the_cluster_is_the_smallest_whose_scan_leaves_a_tenth_of_the_revolution(void)
{
    scip_layout_t layout = {.first_step = 100, .last_step = 587};

    TEST_ASSERT_EQUAL_UINT16(1U, scip_layout_cluster(&layout, 115000U));
    layout.last_step = 588;
    TEST_ASSERT_EQUAL_UINT16(2U, scip_layout_cluster(&layout, 115000U));
    layout.first_step = 0;
    layout.last_step = 975; /* 976 steps: 488 points of two */
    TEST_ASSERT_EQUAL_UINT16(2U, scip_layout_cluster(&layout, 115000U));
    layout.last_step = 976;
    TEST_ASSERT_EQUAL_UINT16(3U, scip_layout_cluster(&layout, 115000U));
    layout.last_step = 9;
    TEST_ASSERT_EQUAL_UINT16(10U, scip_layout_cluster(&layout, 100U)); /* not even one point fits */
}

/* A sensor that makes a point of steps that fill no cluster, and one that makes none, send the same. */
void test_a_range_is_asked_for_in_whole_clusters(void)
{
    scip_layout_t layout = {.first_step = 100, .last_step = 1075}; /* 976 steps: 488 points of two */

    for (uint16_t i = 0U; i < SCIP_LAYOUT_COUNT; i++) {
        const scip_range_t all = scip_layout_range(&scip_layouts[i], 250000U);
        TEST_ASSERT_EQUAL_UINT16(scip_layouts[i].first_step, all.first_step);
        TEST_ASSERT_EQUAL_UINT16(i == SCIP_LAYOUT_FRONT       ? 406U
                                 : i == SCIP_LAYOUT_TWO_BEAMS ? 516U
                                                              : 654U,
                                 all.last_step);
        TEST_ASSERT_EQUAL_UINT16(i == SCIP_LAYOUT_FRONT ? 1U : 4U, all.cluster);
        TEST_ASSERT_EQUAL_UINT16(0U, all.interval);
        TEST_ASSERT_EQUAL_UINT16(0U, all.scans);
    }
    TEST_ASSERT_EQUAL_UINT16(1075U, scip_layout_range(&layout, 115000U).last_step);
    layout.last_step = 1076U;
    TEST_ASSERT_EQUAL_UINT16(3U, scip_layout_range(&layout, 115000U).cluster);
    TEST_ASSERT_EQUAL_UINT16(1074U, scip_layout_range(&layout, 115000U).last_step);
}

/* --- a sensor's own limits
 * ---------------------------------------------------------------------------------------- */

void test_the_limits_may_be_those_that_a_sensor_tells(void)
{
    static const scip_limits_t near = {100, 3000, 1024, 44, 725, 384, 600};
    static const scip_limits_t far = {20, 30000, 1024, 44, 725, 384, 600};
    const scip_group_t group = {372, 406};
    fill(1000);
    points[0] = 99;
    points[1] = 100;
    points[2] = 3000;
    points[3] = 3001;
    points[4] = 4095;
    TEST_ASSERT_EQUAL_UINT16(32, scip_group_mean_within(&scan, &group, &near).good_rays);
    TEST_ASSERT_EQUAL_UINT16(2900, scip_group_mean_within(&scan, &group, &near).spread_mm);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 1000.0F, scip_group_mean_within(&scan, &group, &near).mean_mm);
    TEST_ASSERT_EQUAL_UINT16(
        34, scip_group_mean_within(&scan, &group, &far).good_rays); /* 4095 is none of two characters */
    scan.characters = 3;
    points[5] = 30000;
    points[6] = 30001;
    TEST_ASSERT_EQUAL_UINT16(34, scip_group_mean_within(&scan, &group, &far).good_rays);
    TEST_ASSERT_EQUAL_UINT16(29901, scip_group_mean_within(&scan, &group, &far).spread_mm);
}

/* --- steps from ray to ray
 * ---------------------------------------------------------------------------------------- */

static uint16_t step_of(uint16_t first, uint16_t last)
{
    const scip_group_t group = {first, last};
    return scip_group_step_mm(&scan, &group);
}

void test_a_slope_has_small_steps_and_a_large_spread(void)
{
    for (uint16_t i = 0; i < 35; i++) {
        points[i] = (uint16_t)(600 + 10 * i);
    }
    TEST_ASSERT_EQUAL_UINT16(10, step_of(372, 406));
    TEST_ASSERT_EQUAL_UINT16(340, mean_of(372, 406).spread_mm);
}

void test_the_largest_step_counts_up_or_down_anywhere_in_the_group(void)
{
    for (uint16_t at = 0; at < 35; at++) {
        for (uint16_t up = 0; up < 2; up++) {
            fill(1000);
            points[at] = up != 0 ? 1064 : 936;
            TEST_ASSERT_EQUAL_UINT16(64, step_of(372, 406));
        }
    }
    fill(1000);
    points[0] = 900;
    TEST_ASSERT_EQUAL_UINT16(0, step_of(373, 406));
    points[34] = 900;
    TEST_ASSERT_EQUAL_UINT16(0, step_of(373, 405));
}

void test_steps_are_only_between_neighbours_that_are_both_good(void)
{
    fill(1000);
    points[10] = 19;
    points[11] = 2000;
    points[12] = 4095;
    TEST_ASSERT_EQUAL_UINT16(0, step_of(372, 406));
    points[20] = 20;
    TEST_ASSERT_EQUAL_UINT16(980, step_of(372, 406));
    fill(0);
    TEST_ASSERT_EQUAL_UINT16(0, step_of(372, 406));
    TEST_ASSERT_EQUAL_UINT16(0, step_of(300, 310));
    scan.characters = 3;
    fill(5600);
    points[7] = 5601;
    points[8] = 5500;
    TEST_ASSERT_EQUAL_UINT16(100, step_of(372, 406));
}
