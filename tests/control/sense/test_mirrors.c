#include "control/sense/mirrors.h"

#include <math.h>
#include <string.h>

#include "unity.h"

static mirrors_t mirrors;
static altitude_geometry_t geometry;
static mirror_range_t ranges[MIRROR_COUNT];

static const mirror_t order[] = {MIRROR_AFT, MIRROR_FRONT, MIRROR_FORE};

static float gap_s, age_s; /* of each scan, and of its rays */
static float copied_mm;    /* a mirror at this height gives the same digits in each scan */

static void forget(void)
{
    memset(&mirrors, 0, sizeof mirrors);
}

void setUp(void)
{
    forget();
    gap_s = 0.1F;
    age_s = 0.08F;
    copied_mm = -1.0F;
    geometry = altitude_geometry_default();
}

void tearDown(void) {}

static altitude_t look(float roll_rad, float pitch_rad)
{
    altitude_t shown[MIRROR_COUNT];

    altitude_of_mirrors(shown, &geometry, ranges, 3U, roll_rad, pitch_rad);
    mirrors_scan(&mirrors, shown, gap_s, age_s, true, false);
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

/* In 15 cycles of 0.1 s: HEIGHT_LOST_S. It said for ever that the vehicle moves, and its motors ran on the
 * ground. */
void test_what_a_scan_told_is_forgotten_when_it_is_lost(void)
{
    for (int i = 0; i < 20; i++) {
        const float at_mm = 600.0F + 30.0F * (float)i; /* a climb */
        (void)scan(at_mm, at_mm, at_mm);
    }
    TEST_ASSERT_TRUE(mirrors.agree && mirrors.moves && mirrors.stirs);
    for (int cycle = 1; cycle < 15; cycle++) {
        mirrors_wait(&mirrors, 0.1F);
    }
    TEST_ASSERT_TRUE(mirrors.agree && mirrors.moves && mirrors.stirs);
    mirrors_wait(&mirrors, 0.11F);
    TEST_ASSERT_FALSE(mirrors.agree || mirrors.moves || mirrors.stirs);
    for (int i = 0; i < 3; i++) {
        (void)scan(1200.0F, 1200.0F, 1200.0F);
    }
    mirrors_wait(&mirrors, 0.1F);
    TEST_ASSERT_TRUE(mirrors.agree);
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
        const float at_mm = 600.0F + 10.0F * (float)((i * 7) % 5);

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

static bool tells(float slant_mm, uint16_t good_rays, float spread_mm)
{
    const altitude_t shown[MIRROR_COUNT] = {[MIRROR_FRONT] = {.valid = true,
                                                              .height_mm = slant_mm - 200.0F,
                                                              .slant_mm = slant_mm,
                                                              .good_rays = good_rays,
                                                              .spread_mm = spread_mm}};

    return mirrors_scan(&mirrors, shown, gap_s, age_s, true, false);
}

void test_a_group_that_repeats_every_digit_tells_nothing_also_without_a_spread(void)
{
    TEST_ASSERT_TRUE(tells(700.0F, 2U, 0.0F));
    TEST_ASSERT_FALSE(tells(700.0F, 2U, 0.0F));
}

void test_a_slant_or_a_spread_that_differs_is_another_scan(void)
{
    TEST_ASSERT_TRUE(tells(700.0F, 35U, 9.0F));
    TEST_ASSERT_TRUE(tells(700.1F, 35U, 9.0F));
    TEST_ASSERT_TRUE(tells(700.1F, 35U, 9.1F));
    TEST_ASSERT_TRUE(tells(700.0F, 35U, 9.0F)); /* that before the latest */
}

void test_one_ray_alone_is_no_copy_of_another(void)
{
    TEST_ASSERT_TRUE(tells(700.0F, 1U, 0.0F));
    TEST_ASSERT_TRUE(tells(700.0F, 1U, 0.0F));
}

void test_a_copy_tells_nothing_however_often_it_comes(void)
{
    TEST_ASSERT_TRUE(tells(700.0F, 35U, 9.0F));
    for (uint32_t i = 0; i < 70000U; i++) { /* more than a counter of 16 bits holds */
        TEST_ASSERT_FALSE(tells(700.0F, 35U, 9.0F));
    }
    TEST_ASSERT_TRUE(tells(700.0F, 35U, 8.0F));
}

void test_what_is_out_of_reach_tells_nothing_and_leaves_nothing_behind(void)
{
    static const float odd_mm[] = {5000.1F, NAN, INFINITY, -INFINITY, 1e38F, -1e38F};

    for (unsigned i = 0U; i < sizeof odd_mm / sizeof odd_mm[0]; i++) {
        TEST_ASSERT_FALSE(tells(odd_mm[i] + 200.0F, 35U, (float)i));
        TEST_ASSERT_TRUE(tells(700.0F, 35U, (float)i));
        TEST_ASSERT_FLOAT_WITHIN(0.01F, 500.0F, mirrors.altitude.height_mm);
    }
}

/* Half believed, it is still among the others, and moves the height less than they do. */
void test_a_mirror_counts_as_much_as_it_is_probably_honest(void)
{
    bool half = false;

    for (int k = 0; k < 40; k++) {
        const float at_mm = 600.0F + 15.0F * (float)((k * 7) % 5);
        const float blocked_mm = 630.0F + (float)(k % 2);
        const altitude_t altitude = scan(at_mm, at_mm + 1.0F, (k < 5) ? at_mm - 1.0F : blocked_mm);
        float lies[MIRROR_COUNT];

        if ((mirrors_tell(&mirrors, lies) & (1U << MIRROR_FORE)) == 0U && lies[MIRROR_FORE] > 0.05F) {
            const float honest = 1.0F - lies[MIRROR_FORE];
            const float equal_mm = (2.0F * at_mm + 1.0F + blocked_mm) / 3.0F;
            const float soft_mm = (2.0F * at_mm + 1.0F + honest * blocked_mm) / (2.0F + honest);

            half = true;
            TEST_ASSERT_FLOAT_WITHIN(0.1F * fabsf(equal_mm - at_mm) + 0.5F, soft_mm, altitude.height_mm);
            TEST_ASSERT_TRUE(fabsf(soft_mm - altitude.height_mm) <= fabsf(equal_mm - altitude.height_mm));
        }
    }
    TEST_ASSERT_TRUE(half);
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
void test_mirrors_that_are_all_blocked_agree_no_more_within_four_seconds_and_lie_by_nine_in_ten_within_eight(
    void)
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

/* ---- what all of them tell together */

#define STEP_S 0.005F
#define STEPS 64 /* of the height, 0.32 s, for rays that are old */

/* A vehicle that moves as it is told; its thrust tells of all of it but a touch, and the accelerometer of all
 * of it, plus a lie. */
static struct {
    float height_mm[STEPS], speed_mps, touch_mps2, lie_mps2, blocked_mm;
    unsigned step, swings, seed;
} vehicle;

static float noise_mm(void)
{
    vehicle.seed = vehicle.seed * 1664525U + 1013904223U;
    return (float)((int)(vehicle.seed >> 24) - 128) / 128.0F * 5.0F; /* 2.9 mm rms */
}

static void vehicle_begin(unsigned seed)
{
    forget();
    memset(&vehicle, 0, sizeof vehicle);
    vehicle.seed = seed;
    for (int k = 0; k < STEPS; k++) {
        vehicle.height_mm[k] = 800.0F;
    }
}

/* Up and down make the thrust as unsure. The rays are 0.08 s old, so four fifths wait for the next scan. */
void test_a_thrust_that_is_not_delivered_yet_counts_up_and_down_at_the_time_of_the_rays(void)
{
    mirrors_thrust(&mirrors, 0.0F, 0.02F, 0.0F);
    mirrors_thrust(&mirrors, 0.0F, -0.03F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.05F, mirrors.undelivered.gained);
    (void)scan(500.0F, 500.0F, 500.0F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.04F, mirrors.undelivered.left);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, mirrors.undelivered.gained);
}

static float height_then_mm(float ago_s)
{
    return vehicle.height_mm[(vehicle.step - (unsigned)lroundf(ago_s / STEP_S)) % STEPS];
}

/* One gap with this acceleration, and the scan at its end. */
static void vehicle_moves(float mps2)
{
    for (long k = lroundf(gap_s / STEP_S); k > 0; k--) {
        const float before_mm = height_then_mm(0.0F);

        mirrors_thrust(&mirrors, (mps2 - vehicle.touch_mps2 + 2.4F * vehicle.speed_mps) * STEP_S, 0.0F,
                       2.4F * STEP_S);
        mirrors_frame(&mirrors, (mps2 + vehicle.lie_mps2) * STEP_S, STEP_S);
        vehicle.speed_mps += mps2 * STEP_S;
        vehicle.height_mm[++vehicle.step % STEPS] = before_mm + 1000.0F * vehicle.speed_mps * STEP_S;
    }
    const float seen_mm = (vehicle.blocked_mm > 0.0F) ? vehicle.blocked_mm : height_then_mm(age_s);

    (void)scan(seen_mm + noise_mm(), seen_mm + noise_mm(), seen_mm + noise_mm());
}

/* Up and down, by 0.5 m/s2 and 0.5 s each. */
static void vehicle_swings(int scans)
{
    for (int k = 0; k < scans; k++) {
        const unsigned phase = vehicle.swings++ % 20U;

        vehicle_moves((phase < 5U || phase >= 15U) ? 0.5F : -0.5F);
    }
}

void test_before_the_first_scan_nothing_is_seen_and_nothing_doubted(void)
{
    TEST_ASSERT_FALSE(mirrors.sees || mirrors.blind || mirrors.moves || mirrors.felt_lies);
}

void test_a_vehicle_that_moves_is_seen_to_move(void)
{
    int moves = 0;

    for (unsigned seed = 1U; seed <= 20U; seed++) {
        vehicle_begin(seed);
        vehicle_swings(10);
        for (int k = 0; k < 40; k++) {
            vehicle_swings(1);
            TEST_ASSERT_FALSE(mirrors.blind || mirrors.felt_lies);
            TEST_ASSERT_TRUE(!mirrors.moves || mirrors.sees); /* who is surer of it rather thinks so */
        }
        vehicle_moves(3.0F);
        vehicle_moves(0.0F);
        vehicle_moves(0.0F);
        moves += mirrors.moves && mirrors.sees;
    }
    TEST_ASSERT_INT_WITHIN(1, 19, moves);
}

/* Then nobody can tell a block from the ground: neither sight nor a lie. */
void test_what_stands_is_not_seen_to_move_and_nobody_lies(void)
{
    for (unsigned seed = 1U; seed <= 20U; seed++) {
        vehicle_begin(seed);
        for (int k = 0; k < 200; k++) {
            vehicle_moves(0.0F);
            TEST_ASSERT_FALSE(mirrors.blind || mirrors.felt_lies || mirrors.moves);
            TEST_ASSERT_FALSE(k > 40 && mirrors.sees);
        }
    }
}

void test_a_scan_without_any_mirror_is_neither_blind_nor_sight(void)
{
    vehicle_begin(1U);
    vehicle_swings(20);
    vehicle_moves(3.0F);
    (void)scan(0.0F, 0.0F, 0.0F);
    TEST_ASSERT_FALSE(mirrors.sees || mirrors.blind);
}

/* All three at once: a climb at 0.5 m/s of which no mirror tells, for 5 s. */
void test_a_climb_that_no_mirror_shows_is_blind_within_two_seconds_and_stays_so(void)
{
    for (unsigned seed = 1U; seed <= 40U; seed++) {
        int found = -1;

        vehicle_begin(seed);
        vehicle_swings(30);
        vehicle.blocked_mm = 500.0F;
        for (int k = 0; k < 50; k++) {
            vehicle_moves((k < 5) ? 1.0F : 0.0F);
            found = (found < 0 && mirrors.blind) ? k : found;
            TEST_ASSERT_TRUE(found < 0 || mirrors.blind);
            const float none = belief_of_none(&mirrors.belief, 7U);

            TEST_ASSERT_EQUAL(none > 0.99F, mirrors.blind);
            TEST_ASSERT_FALSE(mirrors.sees && none > 0.01F);
        }
        TEST_ASSERT_INT_WITHIN(9, 11, found);
    }
}

/* The mirrors are free again, and it moves: within 2 s one sees. */
void test_sight_comes_back_with_a_motion(void)
{
    for (unsigned seed = 1U; seed <= 40U; seed++) {
        int seen = -1;

        vehicle_begin(seed);
        vehicle_swings(30);
        vehicle.blocked_mm = 500.0F;
        for (int k = 0; k < 40; k++) {
            vehicle_moves((k < 5) ? 1.0F : 0.0F);
        }
        TEST_ASSERT_FALSE(mirrors.sees);
        vehicle.blocked_mm = 0.0F;
        for (int k = 0; k < 30; k++) {
            vehicle_moves((k < 10) ? -1.0F : 0.0F);
            seen = (seen < 0 && mirrors.sees) ? k : seen;
        }
        TEST_ASSERT_INT_WITHIN(10, 10, seen);
        TEST_ASSERT_FALSE(mirrors.blind);
    }
}

void test_an_accelerometer_that_jumps_lies_and_no_mirror_does(void)
{
    static const float lies_mps2[] = {-10.0F, -6.0F, -4.0F, 4.0F, 6.0F, 10.0F};

    for (unsigned seed = 0U; seed < 60U; seed++) {
        int found = -1;

        vehicle_begin(seed + 1U);
        vehicle_swings(30);
        vehicle.lie_mps2 = lies_mps2[seed % 6U];
        for (int k = 0; k < 30; k++) {
            vehicle_swings(1);
            found = (found < 0 && mirrors.felt_lies) ? k : found;
            TEST_ASSERT_FALSE(mirrors.blind);
            TEST_ASSERT_FALSE(mirrors.moves && mirrors.felt_lies);
            TEST_ASSERT_EQUAL_HEX16(0U, mirrors_liars(&mirrors, true));
        }
        TEST_ASSERT_INT_WITHIN(5, 5, found); /* within a second */
    }
}

/* 0.6 m/s within a scan, of which the thrust does not tell: all mirrors show it. */
void test_a_touch_is_no_lie_of_anybody(void)
{
    for (unsigned seed = 1U; seed <= 20U; seed++) {
        vehicle_begin(seed);
        vehicle_swings(30);
        for (int k = 0; k < 24; k++) {
            vehicle.touch_mps2 = (k == 0) ? 6.0F : (k == 3) ? -6.0F : 0.0F;
            vehicle_moves(vehicle.touch_mps2);
            TEST_ASSERT_FALSE(mirrors.felt_lies || mirrors.blind);
        }
        TEST_ASSERT_EQUAL_HEX16(0U, mirrors_liars(&mirrors, false));
    }
}

/* 5 m/s2 for a scan, of which nobody else tells. */
void test_one_scan_of_a_wrong_accelerometer_is_no_doubt(void)
{
    for (unsigned seed = 1U; seed <= 20U; seed++) {
        vehicle_begin(seed);
        vehicle_swings(30);
        vehicle.lie_mps2 = (seed % 2U == 0U) ? 5.0F : -5.0F;
        vehicle_moves(0.0F);
        vehicle.lie_mps2 = 0.0F;
        for (int k = 0; k < 20; k++) {
            TEST_ASSERT_FALSE(mirrors.felt_lies || mirrors.blind);
            vehicle_swings(1);
        }
        TEST_ASSERT_EQUAL_HEX16(0U, mirrors_liars(&mirrors, false));
    }
}

/* From rest to 1 m/s and back to rest, in gaps that are not of one length, with rays of any age. */
void test_what_the_frames_tell_counts_once_whatever_the_gaps(void)
{
    static const float gaps_s[][4] = {{0.1F, 0.1F, 0.1F, 0.1F},
                                      {0.05F, 0.15F, 0.05F, 0.15F},
                                      {0.1F, 0.2F, 0.1F, 0.3F},
                                      {0.15F, 0.1F, 0.05F, 0.1F}};
    static const float ages_s[] = {0.0F, 0.05F, 0.08F, 0.1F};

    for (unsigned row = 0U; row < 16U; row++) {
        float time_s = 0.0F;

        vehicle_begin(row + 1U);
        age_s = ages_s[row % 4U];
        for (unsigned k = 0U; time_s < 3.0F; k++) {
            gap_s = gaps_s[row / 4U][k % 4U];
            time_s += gap_s;
            vehicle_moves((time_s < 1.05F) ? 1.0F : (time_s < 2.05F) ? 0.0F : -1.0F);
            TEST_ASSERT_FALSE(mirrors.felt_lies || mirrors.blind);
        }
        const float told_mps = vehicle.speed_mps;

        for (int k = 0; k < 3; k++) {
            gap_s = 0.1F;
            vehicle_moves(0.0F);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.06F, told_mps, 0.001F * mirrors.belief.worlds[0].rate_mm_s);
    }
}

void test_the_ground_has_one_number_until_it_steps_or_a_scan_is_held_up(void)
{
    vehicle_begin(1U);
    TEST_ASSERT_EQUAL_UINT16(0U, mirrors.ground);
    vehicle_swings(30);
    const uint16_t ground = mirrors.ground;

    TEST_ASSERT_NOT_EQUAL_UINT16(0U, ground);
    vehicle_swings(5);
    TEST_ASSERT_EQUAL_UINT16(ground, mirrors.ground);
    (void)scan(1200.0F, 1200.0F, 1200.0F);
    TEST_ASSERT_EQUAL_UINT16(ground + 1U, mirrors.ground);
    (void)scan(0.0F, 0.0F, 0.0F);
    TEST_ASSERT_EQUAL_UINT16(ground + 2U, mirrors.ground); /* who sees nothing may have missed a step */
}

void test_a_scan_that_was_held_up_has_a_ground_of_its_own(void)
{
    for (int held_up = 0; held_up <= 1; held_up++) {
        altitude_t shown[MIRROR_COUNT];

        vehicle_begin(1U);
        vehicle_swings(30);
        const uint16_t ground = mirrors.ground;

        for (uint16_t m = 0U; m < MIRROR_COUNT; m++) {
            ranges[m].spread_mm = 20.0F; /* no copy */
        }
        altitude_of_mirrors(shown, &geometry, ranges, 3U, 0.0F, 0.0F);
        mirrors_scan(&mirrors, shown, gap_s, age_s, true, held_up != 0);
        TEST_ASSERT_EQUAL_UINT16(ground + (uint16_t)held_up, mirrors.ground);
    }
}

void test_a_ground_after_65535_has_the_number_1(void)
{
    vehicle_begin(1U);
    mirrors.ground = UINT16_MAX;
    vehicle_swings(1); /* the first scan: nothing was there to step from */
    TEST_ASSERT_EQUAL_UINT16(1U, mirrors.ground);
}

/* Five scans up and five down, faster by 0.4 m/s in each, as the thrust tells. Frames that come tell nothing
 * of it; they cover so much of each scan. */
static float lies_felt_after(float covered_s)
{
    float height_mm = 500.0F;
    float speed_mps = 0.0F;

    vehicle_begin(1U);
    for (int k = 0; k < 20; k++) {
        mirrors_frame(&mirrors, 0.0F, gap_s);
        (void)scan(height_mm + noise_mm(), height_mm + noise_mm(), height_mm + noise_mm());
    }
    for (int k = 1; k <= 10; k++) {
        const float gained_mps = (k <= 5) ? 0.4F : -0.4F;

        mirrors_frame(&mirrors, 0.0F, covered_s);
        mirrors_thrust(&mirrors, gained_mps, 0.0F, 1.0e-6F);
        height_mm += 100.0F * (speed_mps + 0.5F * gained_mps);
        speed_mps += gained_mps;
        (void)scan(height_mm + noise_mm(), height_mm + noise_mm(), height_mm + noise_mm());
    }
    return belief_of_motions(&mirrors.belief).felt_lies;
}

void test_an_accelerometer_whose_frames_miss_most_of_the_scans_time_is_not_heard(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 1.0F, lies_felt_after(0.1F));
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 1.0F, lies_felt_after(0.06F));
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.0F, lies_felt_after(0.04F));
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.0F, lies_felt_after(0.0F));
}

/* ---- the speed, if all mirrors lie ---- */

/* The thrust does not carry it yet, as far as anybody knows: only the accelerometer tells. */
static void lifts(float mps2, bool heard)
{
    for (long k = lroundf(gap_s / STEP_S); k > 0; k--) {
        if (heard) {
            mirrors_frame(&mirrors, mps2 * STEP_S, STEP_S);
        }
    }
    (void)scan(40.0F + noise_mm(), 40.0F + noise_mm(), 40.0F + noise_mm());
}

/* Of what has just left the ground it is not known when, so it is too slow at first. */
void test_a_take_off_with_blocked_mirrors_has_the_speed_of_the_accelerometer(void)
{
    float sum_mps = 0.0F;

    for (unsigned seed = 1U; seed <= 20U; seed++) {
        vehicle_begin(seed);
        for (int k = 0; k < 100; k++) {
            lifts(0.0F, true);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.0F, mirrors_blind_mps(&mirrors, true));
        for (int k = 0; k < 5; k++) {
            lifts(1.5F, true);
        }
        sum_mps += mirrors_blind_mps(&mirrors, true);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 0.55F, sum_mps / 20.0F);
}

void test_since_the_latest_scan_the_thrust_tells_where_no_accelerometer_is_heard(void)
{
    vehicle_begin(1U);
    lifts(0.0F, true); /* its frames are of the next scan's time */
    lifts(0.0F, true);
    const float before_mps = mirrors_blind_mps(&mirrors, true);

    mirrors_frame(&mirrors, 0.2F, STEP_S);
    mirrors_thrust(&mirrors, 0.1F, 0.0F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, before_mps + 0.2F, mirrors_blind_mps(&mirrors, true));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, before_mps + 0.1F,
                             mirrors_blind_mps(&mirrors, false)); /* doubted since */
    mirrors_rest(&mirrors, false);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, before_mps + 0.2F, mirrors_blind_mps(&mirrors, true));
    mirrors_rest(&mirrors, true);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.0F, mirrors_blind_mps(&mirrors, true));
    lifts(0.0F, false);
    lifts(0.0F, false); /* the frame above was of the scan before */
    const float unheard_mps = mirrors_blind_mps(&mirrors, true);

    mirrors_frame(&mirrors, 0.2F, STEP_S);
    mirrors_thrust(&mirrors, 0.1F, 0.0F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, unheard_mps + 0.1F, mirrors_blind_mps(&mirrors, true));
}

/* Ten seconds without a scan: what was felt meanwhile is no motion of this one. */
void test_after_a_long_silence_the_sums_are_dropped(void)
{
    vehicle_begin(1U);
    lifts(0.0F, true);
    lifts(0.0F, true);
    mirrors_frame(&mirrors, 5.0F, 60.0F);
    gap_s = 9.0F;
    (void)scan(40.0F, 40.0F, 40.0F);
    TEST_ASSERT_TRUE(mirrors.belief.worlds[BELIEF_WORLDS - 1U].rate_mm_s > 4000.0F);
    vehicle_begin(1U);
    gap_s = 0.1F;
    lifts(0.0F, true);
    lifts(0.0F, true);
    mirrors_frame(&mirrors, 5.0F, 60.0F);
    gap_s = MIRRORS_GAP_MOST_S;
    (void)scan(40.0F, 40.0F, 40.0F);
    TEST_ASSERT_FLOAT_WITHIN(50.0F, 0.0F, mirrors.belief.worlds[BELIEF_WORLDS - 1U].rate_mm_s);
}

/* By the thrust: what lifts a climb of 0.8 m/s evenly is eaten by its drag. */
void test_since_the_latest_scan_the_drag_counts_where_the_thrust_tells(void)
{
    vehicle_begin(1U);
    mirrors.belief.worlds[0] = (belief_world_t){.probability = 1.0F, .rate_mm_s = 800.0F};
    mirrors_thrust(&mirrors, 2.4F * 0.8F * STEP_S, 0.0F, 2.4F * STEP_S);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 0.8F, mirrors_blind_mps(&mirrors, false));
}
