#include "control/sense/mirrors.h"

#include <math.h>
#include <string.h>

#include "unity.h"

static mirrors_t mirrors;
static altitude_geometry_t geometry;
static mirror_range_t ranges[MIRROR_COUNT];

static const mirror_t order[] = {MIRROR_AFT, MIRROR_FRONT, MIRROR_FORE};

static float copied_mm; /* a mirror at this height gives the same digits in each scan */

static void forget(void)
{
    memset(&mirrors, 0, sizeof mirrors);
}

void setUp(void)
{
    forget();
    copied_mm = -1.0F;
    geometry = altitude_geometry_default();
}

void tearDown(void) {}

static altitude_t look(float roll_rad, float pitch_rad)
{
    altitude_t shown[MIRROR_COUNT];

    altitude_of_mirrors(shown, &geometry, ranges, 3U, roll_rad, pitch_rad);
    mirrors_scan(&mirrors, shown, 0.1F, 0.08F, true);
    return mirrors.altitude;
}

/* Level: the slant of each mirror from its height; 0: it has no distance. */
static altitude_t scan(float aft_mm, float front_mm, float fore_mm)
{
    const float height_mm[] = {aft_mm, front_mm, fore_mm};
    static float spread_mm;

    spread_mm = (spread_mm == 10.0F) ? 11.0F : 10.0F; /* no scan is a copy of the one before */
    for (int i = 0; i < 3; i++) {
        const mirror_geometry_t *at = &geometry.mirror[order[i]];
        ranges[i] = (mirror_range_t){.mirror = order[i],
                                     .valid = height_mm[i] != 0.0F,
                                     .slant_mm = height_mm[i] + at->distance_mm + at->leg_mm,
                                     .spread_mm = (height_mm[i] == copied_mm) ? 12.0F : spread_mm,
                                     .good_rays = 8U,
                                     .later_us = (i - 1) * 25000};
    }
    return look(0.0F, 0.0F);
}

static void assert_height(float expected_mm, uint16_t count, int32_t later_us, altitude_t altitude)
{
    TEST_ASSERT_TRUE(altitude.valid);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, expected_mm, altitude.height_mm);
    TEST_ASSERT_EQUAL_UINT16(count * 8U, altitude.good_rays);
    TEST_ASSERT_INT32_WITHIN(250, later_us, altitude.later_us);
}

void test_three_that_lie_together_are_their_mean(void)
{
    const altitude_t altitude = scan(610.0F, 600.0F, 590.0F);

    assert_height(600.0F, 3U, 0, altitude);
    TEST_ASSERT_EQUAL_UINT16(24U, altitude.good_rays);
    TEST_ASSERT_FALSE(altitude.disagree);
}

/* Each of them, near and far, at any height of the vehicle, in the first scan already. */
void test_one_beam_that_is_blocked_tells_nothing(void)
{
    for (float at_mm = 300.0F; at_mm < 2500.0F; at_mm += 100.0F) {
        forget();
        assert_height(at_mm, 2U, 12500, scan(-60.0F, at_mm, at_mm));
        forget();
        assert_height(at_mm, 2U, 0, scan(at_mm, -60.0F, at_mm));
        forget();
        assert_height(at_mm, 2U, -12500, scan(at_mm, at_mm, 3000.0F));
        TEST_ASSERT_FALSE(mirrors.altitude.disagree);
    }
}

void test_an_edge_counts_when_the_second_beam_has_passed_it(void)
{
    assert_height(600.0F, 2U, -12500, scan(600.0F, 600.0F, 850.0F));
    assert_height(850.0F, 2U, 12500, scan(600.0F, 850.0F, 850.0F));
    assert_height(850.0F, 3U, 0, scan(850.0F, 850.0F, 850.0F));
}

void test_three_far_apart_are_the_middle_one(void)
{
    assert_height(600.0F, 1U, 25000, scan(300.0F, 900.0F, 600.0F));
    assert_height(600.0F, 1U, -25000, scan(600.0F, 300.0F, 900.0F));
    assert_height(600.0F, 1U, 0, scan(900.0F, 600.0F, 300.0F));
}

void test_a_slope_is_its_middle_whatever_its_gradient(void)
{
    for (float rise_mm = -300.0F; rise_mm <= 300.0F; rise_mm += 10.0F) {
        forget();
        TEST_ASSERT_FLOAT_WITHIN(0.05F, 600.0F, scan(600.0F - rise_mm, 600.0F, 600.0F + rise_mm).height_mm);
    }
}

/* One mirror goes away from two others: the height follows less and less, and never jumps. */
void test_the_height_has_no_jump_where_a_mirror_ceases_to_count(void)
{
    float before_mm = 600.0F, most_mm = 0.0F;

    for (float at_mm = 600.0F; at_mm < 1000.0F; at_mm += 1.0F) {
        forget();
        const float height_mm = scan(600.0F, 600.0F, at_mm).height_mm;

        TEST_ASSERT_FLOAT_WITHIN(1.5F, before_mm, height_mm); /* 1.3 where its weight ends */
        most_mm = (height_mm > most_mm) ? height_mm : most_mm;
        before_mm = height_mm;
    }
    TEST_ASSERT_FLOAT_WITHIN(3.0F, 618.0F,
                             most_mm); /* x exp(-(x/75)^2/2) / (2 + ...) is largest near x = 85 */
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 600.0F, before_mm);
}

void test_of_two_the_one_nearer_to_the_height_before_counts(void)
{
    (void)scan(600.0F, 600.0F, 600.0F);
    assert_height(620.0F, 1U, 0, scan(150.0F, 620.0F, 0.0F));
    assert_height(640.0F, 1U, 25000, scan(0.0F, 1500.0F, 640.0F));
    forget(); /* a front mirror that jumps to 1500 mm and back may lie */
    (void)scan(600.0F, 600.0F, 600.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 635.0F, scan(0.0F, 640.0F, 630.0F).height_mm);
}

void test_of_two_without_a_height_before_the_lower_counts(void)
{
    assert_height(300.0F, 1U, 25000, scan(800.0F, 0.0F, 300.0F));
}

void test_the_only_beam_left_is_the_height(void)
{
    (void)scan(600.0F, 600.0F, 600.0F);
    assert_height(900.0F, 1U, 25000, scan(0.0F, 0.0F, 900.0F));
}

void test_without_a_beam_there_is_no_height_and_the_one_before_is_kept(void)
{
    (void)scan(600.0F, 600.0F, 600.0F);
    (void)scan(0.0F, 0.0F, 0.0F);
    TEST_ASSERT_FALSE(mirrors.agree);
    assert_height(610.0F, 1U, -25000, scan(610.0F, 2000.0F, 0.0F));
}

/* A frozen scanner, while the vehicle tilts: no new height comes of it. */
void test_copies_of_all_three_are_no_scan(void)
{
    const altitude_t before = scan(600.0F, 605.0F, 595.0F);

    for (int i = 1; i < 20; i++) {
        const altitude_t altitude = look(0.01F * (float)i, 0.005F * (float)i);
        TEST_ASSERT_EQUAL_MEMORY(&before, &altitude, sizeof before);
        TEST_ASSERT_FALSE(mirrors.agree);
    }
}

/* For people: which mirror does not count, and how probably it lies. A mirror that is blind is not left out.
 */
void test_it_is_told_which_mirror_is_left_out_and_how_probably_it_lies(void)
{
    float lies[MIRROR_COUNT];

    (void)scan(610.0F, 600.0F, 590.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, mirrors_tell(&mirrors, lies));
    (void)scan(600.0F, 600.0F, 850.0F); /* an edge under the last one: not yet with the others */
    TEST_ASSERT_EQUAL_UINT16(1U << order[2], mirrors_tell(&mirrors, lies));
    (void)scan(600.0F, 0.0F, 600.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, mirrors_tell(&mirrors, lies));
    (void)scan(0.0F, 0.0F, 0.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, mirrors_tell(&mirrors, lies));
    forget();
    for (int i = 0; i < 30; i++) { /* something in front of the first one */
        const float at_mm = 600.0F + 60.0F * (float)((i * 7) % 5);

        (void)scan(-60.0F + (float)(i % 2), at_mm, at_mm + 1.0F);
    }
    TEST_ASSERT_EQUAL_UINT16(1U << order[0], mirrors_tell(&mirrors, lies));
    TEST_ASSERT_TRUE(lies[order[0]] > 0.9F && lies[order[1]] < 0.1F && lies[order[2]] < 0.1F);
}

/* Tilted, the three see the same ground over slants that differ by centimetres. */
void test_heights_are_compared_and_not_slants(void)
{
    const float roll_rad = 0.2F, pitch_rad = -0.15F;

    for (int i = 0; i < 3; i++) {
        const mirror_geometry_t *at = &geometry.mirror[order[i]];
        const float none_mm = altitude_under_mirror(at, 0.0F, roll_rad, pitch_rad);
        const float per_mm = altitude_under_mirror(at, 1.0F, roll_rad, pitch_rad) - none_mm;

        ranges[i] = (mirror_range_t){
            .mirror = order[i], .valid = true, .slant_mm = (600.0F - none_mm) / per_mm, .good_rays = 8U};
    }
    assert_height(600.0F, 3U, 0, look(roll_rad, pitch_rad));
}

/* 20 scans of a flight that goes up and down, in which one mirror gives the same digits again and again. */
void test_a_mirror_that_repeats_its_scan_is_left_out(void)
{
    copied_mm = 640.0F;
    for (int m = 0; m < 3; m++) {
        forget();
        for (int k = 0; k < 20; k++) {
            const float at_mm = 600.0F + 15.0F * (float)((k * 7) % 5);
            float height_mm[] = {at_mm, at_mm + 1.0F, at_mm - 1.0F};

            height_mm[m] = copied_mm;
            const altitude_t altitude = scan(height_mm[0], height_mm[1], height_mm[2]);
            if (k > 0) {
                TEST_ASSERT_EQUAL_UINT16(16U, altitude.good_rays);
                TEST_ASSERT_FLOAT_WITHIN(1.5F, at_mm, altitude.height_mm);
            }
        }
    }
}

/* What the accelerometer has told counts when the rays are so old, once, and only while it is believed. */
void test_two_that_agree_are_known_to_agree_and_one_alone_is_not(void)
{
    (void)scan(600.0F, 601.0F, 599.0F);
    TEST_ASSERT_TRUE(mirrors.agree);
    (void)scan(603.0F, 602.0F, 0.0F);
    TEST_ASSERT_TRUE(mirrors.agree);
    (void)scan(0.0F, 604.0F, 0.0F);
    TEST_ASSERT_FALSE(mirrors.agree);
}

/* 600 mm above the ground; blocked_mm: what all mirrors show in place of it, 0: nothing blocks them. */
static void sway(int k, float blocked_mm)
{
    static const float noise_mm[] = {2.0F, -3.0F, 1.0F, -2.0F, 3.0F, -1.0F, 0.0F};
    const float roll_rad = 0.15F * sinf(0.3F * (float)k);

    for (int i = 0; i < 3; i++) {
        const mirror_geometry_t *at = &geometry.mirror[order[i]];
        const float true_mm = at->distance_mm +
                              (600.0F + at->leg_mm + at->arm_mm * sinf(roll_rad)) / cosf(roll_rad);

        ranges[i] = (mirror_range_t){.mirror = order[i],
                                     .valid = true,
                                     .slant_mm = ((blocked_mm > 0.0F) ? blocked_mm : true_mm) +
                                                 noise_mm[(k + 2 * i) % 7],
                                     .spread_mm = 10.0F,
                                     .good_rays = 8U};
    }
    (void)look(roll_rad, 0.0F);
}

/* The tilt alone tells it, here: no thrust, and an accelerometer that feels nothing. */
void test_mirrors_that_are_all_blocked_agree_no_more_within_four_seconds_and_lie_by_nine_in_ten_within_eight(void)
{
    for (int k = 0; k < 100; k++) {
        sway(k, 0.0F);
        TEST_ASSERT_FALSE(mirrors.blind);
    }
    for (int k = 0; k < 40; k++) {
        sway(k, 800.0F);
    }
    TEST_ASSERT_FALSE(mirrors.agree);
    for (int k = 40; k < 80; k++) {
        sway(k, 800.0F);
    }
    TEST_ASSERT_TRUE(belief_of_none(&mirrors.belief, 7U) > 0.9F);
    (void)scan(0.0F, 0.0F, 0.0F);
    TEST_ASSERT_FALSE(mirrors.blind);
}

void test_a_mirror_that_is_disbelieved_is_doubted_at_once_and_lies_when_that_lasts(void)
{
    const uint16_t fore = 1U << MIRROR_FORE;
    int doubted = 0;
    int lies = 0;

    for (int k = 0; k < 80; k++) {
        const float at_mm = 600.0F + 15.0F * (float)((k * 7) % 5);

        (void)scan(at_mm, at_mm + 1.0F, 640.0F);
        doubted += (mirrors_liars(&mirrors, false) == fore) ? 1 : 0;
        lies += (mirrors_liars(&mirrors, true) == fore) ? 1 : 0;
    }
    TEST_ASSERT_TRUE(doubted > 60);
    TEST_ASSERT_INT_WITHIN(1, doubted - 20, lies); /* 2 s */
    for (int k = 0; k < 200; k++) {
        const float at_mm = 600.0F + 15.0F * (float)((k * 7) % 5);
        (void)scan(at_mm, at_mm + 1.0F, at_mm - 1.0F);
    }
    TEST_ASSERT_EQUAL_HEX16(0U, mirrors_liars(&mirrors, false));
    TEST_ASSERT_EQUAL_HEX16(0U, mirrors_liars(&mirrors, true));
}
