#include "control/sense/belief_world.h"

#include <math.h>
#include <string.h>

#include "unity.h"

#define GAP_S 0.1F

static belief_world_t world;
static belief_beam_t beams[MIRROR_COUNT];
static belief_mean_t slant[MIRROR_COUNT], height[MIRROR_COUNT];
static belief_scan_t scan;
static belief_motion_t motion[MIRROR_COUNT][BELIEF_MOTIONS];

/* A vehicle at 500 mm that has stood for ten scans; every mirror tells. */
void setUp(void)
{
    memset(&world, 0, sizeof world);
    belief_world_start(&world);
    for (int m = 0; m < MIRROR_COUNT; m++) {
        world.level_mm[m] = 500.0F;
        beams[m] = (belief_beam_t){true, 700.0F, 500.0F};
        slant[m] = (belief_mean_t){700.0F, 10.0F};
        height[m] = (belief_mean_t){500.0F, 10.0F};
    }
    scan = (belief_scan_t){.beams = beams, .told = 7U, .gap_s = GAP_S, .motion = motion};
    belief_world_loosen(motion, 1.0F);
}

void tearDown(void) {}

/* The density of this scan, in a copy of the world. */
static float density(uint16_t liars)
{
    belief_world_t copy = world;

    belief_world_look(&scan, slant, height);
    return belief_world_scan(&copy, &scan, liars);
}

/* Of one mirror, whatever its height: steps reach 4 m up and down. The accelerometer's part is the same for
 * each height, when it tells nothing. */
void test_the_density_of_an_honest_height_is_one_over_all_heights(void)
{
    float sum = 0.0F;

    scan.told = 1U << MIRROR_FRONT;
    for (float at_mm = -3500.0F; at_mm < 4500.0F; at_mm += 1.0F) {
        beams[MIRROR_FRONT].height_mm = at_mm;
        sum += density(0U);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 1.0F, sum / density_of_strange(0.0F, STRANGE_MPS2));
}

void test_the_density_of_a_liars_slant_is_one_over_the_scanners_range(void)
{
    float sum = 0.0F;

    scan.told = 1U << MIRROR_FRONT;
    for (float at_mm = 0.0F; at_mm < 4000.0F; at_mm += 1.0F) {
        beams[MIRROR_FRONT].slant_mm = at_mm;
        sum += density(1U << MIRROR_FRONT);
    }
    beams[MIRROR_FRONT].slant_mm = 700.0F;
    scan.told = 0U;
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 1.0F, sum / density(0U));
}

/* Of all kinds of motion together; no mirror tells, and the thrust carries nothing. */
static float density_over_its_range(float undelivered_mps)
{
    float sum = 0.0F;

    scan.told = 0U;
    for (float mps2 = -2.0F * 9.80665F; mps2 < 2.0F * 9.80665F; mps2 += 0.01F) {
        scan.felt = (belief_felt_t){.gained_mps = mps2 * GAP_S, .undelivered_mps = undelivered_mps};
        sum += 0.01F * density(0U);
    }
    return sum;
}

/* Of what stands, a fifth of the scans, it is less: at its peak as dense as in flight, and narrower. */
void test_the_density_of_what_the_accelerometer_tells_is_one_over_its_range(void)
{
    const float all = 1.0F - 0.2F * (1.0F - REST_MPS2 / STRANGE_MPS2);

    TEST_ASSERT_FLOAT_WITHIN(0.01F, all, density_over_its_range(0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, all, density_over_its_range(0.4F));
}

/* By heights that stay, with this thrust above the hover thrust: one scan. */
static void stays_with(float push_mps2, float height_mm, uint16_t liars)
{
    setUp();
    scan.told = 1U << MIRROR_FRONT;
    world.level_mm[MIRROR_FRONT] = world.height_mm = beams[MIRROR_FRONT].height_mm = height_mm;
    height[MIRROR_FRONT].mm = height_mm;
    scan.felt = (belief_felt_t){.pushed_mps = push_mps2 * GAP_S, .dragged = 0.24F};
    belief_world_look(&scan, slant, height);
    (void)belief_world_scan(&world, &scan, liars);
}

/* How probably it stands then, over how probably the thrust has no effect. */
static float stands_with(float push_mps2, float height_mm, uint16_t liars)
{
    stays_with(push_mps2, height_mm, liars);
    return world.motions[BELIEF_STANDS] / world.motions[BELIEF_HELD];
}

void test_no_vehicle_stands_that_its_thrust_lifts(void)
{
    for (float push_mps2 = 2.0F; push_mps2 < 6.0F; push_mps2 += 1.0F) {
        TEST_ASSERT_TRUE(stands_with(push_mps2, 0.0F, 0U) < 0.25F * stands_with(0.0F, 0.0F, 0U));
        TEST_ASSERT_TRUE(stands_with(push_mps2, 500.0F, 0U) < 0.25F * stands_with(0.0F, 500.0F, 0U));
    }
}

/* On the ground too small a thrust is carried. Above it, by a mirror that is honest, it would sink. */
void test_no_vehicle_stands_in_the_air_whose_thrust_is_too_small(void)
{
    for (float push_mps2 = -2.0F; push_mps2 > -6.0F; push_mps2 -= 1.0F) {
        TEST_ASSERT_TRUE(stands_with(push_mps2, 500.0F, 0U) < 0.25F * stands_with(0.0F, 500.0F, 0U));
        TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 1.0F,
                                 stands_with(push_mps2, 40.0F, 0U) / stands_with(0.0F, 40.0F, 0U));
        TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 1.0F,
                                 stands_with(push_mps2, 500.0F, 1U << MIRROR_FRONT) /
                                     stands_with(0.0F, 500.0F, 1U << MIRROR_FRONT));
    }
}

/* Half a second of a fall by 2 m/s2, of which the thrust tells the half; liars: of the one mirror that tells
 * something. Returns how probably it stands. */
static float stands_after_a_fall(uint16_t liars)
{
    setUp();
    scan.told = 1U << MIRROR_FRONT;
    scan.felt = (belief_felt_t){.gained_mps = -2.0F * GAP_S, .pushed_mps = -1.0F * GAP_S, .dragged = 0.24F};
    for (int k = 0; k < 5; k++) {
        belief_world_look(&scan, slant, height);
        (void)belief_world_scan(&world, &scan, liars);
    }
    return world.motions[BELIEF_STANDS];
}

void test_what_falls_where_no_mirror_tells_it_does_not_stand(void)
{
    TEST_ASSERT_TRUE(stands_after_a_fall(1U << MIRROR_FRONT) < 0.02F);
}

/* Motors shake an IMU by as much. */
void test_where_the_heights_stand_still_an_accelerometer_alone_refutes_it_hardly(void)
{
    TEST_ASSERT_TRUE(stands_after_a_fall(0U) > 0.2F);
}

#define CALM 1U /* a kind of motion: it flies in calm air */

/* How much more probably the thrust has no effect where it is so much too small than where it is as much too
 * large, by heights that stay: a kind that flies bears both alike. */
static float held_by(float missing_mps2, float height_mm, uint16_t liars)
{
    float ratio[2];

    for (int lifts = 0; lifts < 2; lifts++) {
        stays_with((lifts != 0) ? missing_mps2 : -missing_mps2, height_mm, liars);
        ratio[lifts] = world.motions[BELIEF_HELD] / world.motions[CALM];
    }
    return ratio[0] / ratio[1];
}

/* A rope, a branch, a hand: it would sink, and stands still. What is lifted does not hang. */
void test_something_may_hold_it_still_in_the_air_by_too_small_a_thrust(void)
{
    for (float missing_mps2 = 2.0F; missing_mps2 < 6.0F; missing_mps2 += 1.0F) {
        TEST_ASSERT_FLOAT_WITHIN(0.4F, 1.5F, held_by(missing_mps2, 500.0F, 0U));
        TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 1.0F, held_by(missing_mps2, 40.0F, 0U)); /* the ground does */
        TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 1.0F, held_by(missing_mps2, 500.0F, 1U << MIRROR_FRONT));
    }
}

/* Without the accelerometer the thrust foretells that it sinks: held against one that stands, a vehicle that
 * a pilot holds would have blocked mirrors. Over the kind that no thrust changes. */
void test_where_the_accelerometer_tells_nothing_too_small_a_thrust_tells_nothing_of_standing(void)
{
    float ratio[2];

    for (int pushed = 0; pushed < 2; pushed++) {
        setUp();
        scan.told = 1U << MIRROR_FRONT;
        world.height_mm = 500.0F;
        scan.felt = (belief_felt_t){
            .untold = true, .pushed_mps = (pushed != 0) ? -3.0F * GAP_S : 0.0F, .dragged = 0.24F};
        belief_world_look(&scan, slant, height);
        (void)belief_world_scan(&world, &scan, 0U);
        ratio[pushed] = world.motions[BELIEF_STANDS] / world.motions[BELIEF_FELT_LIES];
    }
    TEST_ASSERT_TRUE(ratio[1] > 0.5F * ratio[0]);
}

/* 1.2 m/s of climb at a constant speed: the accelerometer tells nothing, the thrust meets the drag. A world
 * in which no mirror tells it, and that thinks it slower, knows the speed by the drag. */
static float climb_after(int scans, uint16_t kind, float push_known)
{
    scan.told = 0U;
    world.rate_mm_s = 900.0F;
    for (uint16_t k = 0U; k < BELIEF_MOTIONS; k++) {
        world.motions[k] = (k == kind) ? 1.0F : 0.0F;
    }
    scan.felt = (belief_felt_t){.pushed_mps = 0.24F * 1.2F, .dragged = 0.24F};
    world.push_known = push_known;
    for (int k = 0; k < scans; k++) {
        belief_world_look(&scan, slant, height);
        (void)belief_world_scan(&world, &scan, 0U);
    }
    return world.rate_mm_s;
}

void test_where_no_mirror_tells_the_drag_tells_the_speed(void)
{
    TEST_ASSERT_FLOAT_WITHIN(100.0F, 1200.0F, climb_after(60, CALM, 1.0F));
}

/* It may be off by 2 m/s2: that is a seventeenth of the evidence. */
void test_by_a_thrust_that_is_not_known_yet_it_tells_little(void)
{
    const float gained_mm_s = climb_after(5, CALM, 0.0F) - 900.0F;

    setUp();
    TEST_ASSERT_FLOAT_WITHIN(0.03F, 0.06F, gained_mm_s / (climb_after(5, CALM, 1.0F) - 900.0F));
}

/* Nothing tells how long it has moved: the speed of what moves is that since a scan before which it stood. */
void test_what_has_just_left_the_ground_has_no_speed(void)
{
    scan.told = 0U;
    world.rate_mm_s = 300.0F;
    world.motions[BELIEF_STANDS] = 1.0F;
    for (int k = 1; k < (int)BELIEF_MOTIONS; k++) {
        world.motions[k] = 0.0F;
    }
    scan.felt.gained_mps = 0.1F;
    belief_world_look(&scan, slant, height);
    (void)belief_world_scan(&world, &scan, 0U);
    TEST_ASSERT_FLOAT_WITHIN(1.0F, 100.0F, world.rate_mm_s);
}

/* Two liars whose noise is one: 10 mm up, both. It costs less than 10 mm up and 10 mm down. */
void test_a_noise_that_liars_share_is_no_evidence_for_them_being_honest(void)
{
    beams[MIRROR_FRONT].slant_mm = 710.0F;
    beams[MIRROR_AFT].slant_mm = 710.0F;
    const float together = density(1U << MIRROR_FRONT | 1U << MIRROR_AFT);

    beams[MIRROR_AFT].slant_mm = 690.0F;
    TEST_ASSERT_TRUE(density(1U << MIRROR_FRONT | 1U << MIRROR_AFT) < 0.5F * together);
}

static void go(float higher_mm)
{
    for (int m = 0; m < MIRROR_COUNT; m++) {
        beams[m].height_mm = 500.0F + higher_mm;
        beams[m].slant_mm = 700.0F + higher_mm;
    }
    belief_world_look(&scan, slant, height);
    (void)belief_world_scan(&world, &scan, 0U);
}

/* 4 m/s2 for 0.1 s are 20 mm. */
void test_what_the_accelerometer_and_the_thrust_tell_is_believed(void)
{
    scan.felt = (belief_felt_t){.gained_mps = 0.4F, .pushed_mps = 0.4F};
    go(20.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, world.motions[BELIEF_MOTIONS - 1U]);
    TEST_ASSERT_FLOAT_WITHIN(20.0F, 400.0F, world.rate_mm_s);
    TEST_ASSERT_FLOAT_WITHIN(1.0F, 520.0F, world.level_mm[MIRROR_AFT]);
}

/* 25 mm that nothing has told, in one scan, and in the next none. As long as a push lasts it explains
 * everything, so it must not last where it would have been felt. */
static float pushed_after(bool untold, uint16_t told)
{
    setUp();
    scan.told = told;
    scan.felt.untold = untold;
    go(25.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 0.85F, world.motions[BELIEF_PUSHED]);
    world.rate_mm_s = 0.0F;
    for (int m = 0; m < MIRROR_COUNT; m++) {
        world.level_mm[m] = 525.0F;
    }
    go(25.0F);
    return world.motions[BELIEF_PUSHED];
}

void test_a_push_lasts_where_nothing_would_tell_it_or_one_mirror_alone_does(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.08F, 0.08F, pushed_after(false, 7U));
    TEST_ASSERT_FLOAT_WITHIN(0.08F, 0.08F, pushed_after(false, 5U));
    TEST_ASSERT_FLOAT_WITHIN(0.35F, 0.65F, pushed_after(false, 1U));
    TEST_ASSERT_FLOAT_WITHIN(0.35F, 0.65F, pushed_after(true, 7U));
}

/* Four scans of a healthy flight that swings, stairs/7/EST of seed 2620 (tools/campaign/healthy.toml), and
 * what was believed before them. Its motors lag less than LAG. m/s by the accelerometer and by the thrust;
 * how much higher the mirrors are than foretold. */
static const struct {
    float gained_mps, pushed_mps, off_mm[MIRROR_COUNT];
} swing[] = {
    {-0.410F, -0.233F, {14.6F, 11.9F, 28.6F}},
    {0.102F, 0.011F, {23.0F, 36.7F, 12.2F}},
    {0.467F, 0.138F, {33.9F, 42.6F, 15.0F}},
    {0.348F, 0.070F, {19.5F, 22.1F, 7.7F}},
};

static float lies_in_the_swing(float undelivered_mps)
{
    setUp();
    memcpy(world.motions, (const float[BELIEF_MOTIONS]){0.0F, 0.083F, 0.021F, 0.801F, 0.0F, 0.095F},
           sizeof world.motions);
    world.rate_mm_s = -737.0F;
    for (unsigned k = 0U; k < sizeof swing / sizeof swing[0]; k++) {
        scan.felt = (belief_felt_t){.gained_mps = swing[k].gained_mps,
                                    .pushed_mps = swing[k].pushed_mps,
                                    .undelivered_mps = undelivered_mps,
                                    .dragged = 0.24F};
        for (int m = 0; m < MIRROR_COUNT; m++) {
            beams[m].height_mm = world.level_mm[m] +
                                 (world.rate_mm_s + 500.0F * swing[k].gained_mps) * GAP_S +
                                 swing[k].off_mm[m];
        }
        belief_world_look(&scan, slant, height);
        (void)belief_world_scan(&world, &scan, 0U);
    }
    return world.motions[BELIEF_FELT_LIES];
}

void test_a_thrust_that_is_not_delivered_yet_is_no_lie_of_the_accelerometer(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 0.8F, lies_in_the_swing(0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.05F, lies_in_the_swing(0.3F));
}

/* The thrust and the heights tell of none of it. */
void test_what_the_accelerometer_alone_tells_is_taken_back(void)
{
    scan.felt = (belief_felt_t){.gained_mps = 0.4F, .dragged = 0.24F};
    for (int k = 0; k < 5; k++) {
        go(0.0F);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 1.0F, world.motions[BELIEF_FELT_LIES]);
    TEST_ASSERT_FLOAT_WITHIN(60.0F, 0.0F, world.rate_mm_s);
    TEST_ASSERT_FLOAT_WITHIN(3.0F, 500.0F, world.level_mm[MIRROR_AFT]);
}

/* Of those that tell something in this scan; none of them lies here. */
void test_the_height_is_that_of_the_honest_mirrors(void)
{
    scan.told = (1U << MIRROR_FRONT) | (1U << MIRROR_AFT);
    world.level_mm[MIRROR_FRONT] = beams[MIRROR_FRONT].height_mm = 500.0F;
    world.level_mm[MIRROR_AFT] = beams[MIRROR_AFT].height_mm = 600.0F;
    (void)density(0U);
    belief_world_look(&scan, slant, height);
    (void)belief_world_scan(&world, &scan, 0U);
    TEST_ASSERT_FLOAT_WITHIN(5.0F, 550.0F, world.height_mm);
    (void)belief_world_scan(&world, &scan, 1U << MIRROR_FRONT);
    TEST_ASSERT_FLOAT_WITHIN(5.0F, 600.0F, world.height_mm);
}

/* 4 s at 0.5 m/s up, and then down: not below the ground. */
void test_where_no_mirror_tells_it_the_rate_tells_the_height(void)
{
    scan.told = 0U;
    for (int down = 0; down < 2; down++) {
        world.height_mm = 1000.0F;
        for (int k = 0; k < 40; k++) {
            world.rate_mm_s = (down != 0) ? -500.0F : 500.0F;
            for (uint16_t m = 0U; m < BELIEF_MOTIONS; m++) {
                world.motions[m] = (m == CALM) ? 1.0F : 0.0F;
            }
            belief_world_look(&scan, slant, height);
            (void)belief_world_scan(&world, &scan, 0U);
        }
        TEST_ASSERT_FLOAT_WITHIN(60.0F, (down != 0) ? 0.0F : 3000.0F, world.height_mm);
    }
}
