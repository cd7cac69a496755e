#include "control/integrity.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define HOVER_N 7.4F
#define DEGREE_RAD 0.0174532925F

/* A vehicle that moves as its thrust says, and what its sensors tell of it: a height every 0.1 s, a frame
 * every 25 ms. */
static integrity_t it;
static flown_t flown;
static imu_sample_t frame;
static struct {
    float height_m, speed_mps, lie_m, felt_lie_mps2, lagged_n;
    bool frozen_height, powerless, deaf, steady;
    uint32_t cycles;
} world;

void setUp(void)
{
    integrity_init(&it);
    memset(&world, 0, sizeof world);
    memset(&frame, 0, sizeof frame);
    frame.ready = frame.has_acceleration = true;
    world.lagged_n = HOVER_N;
    flown = (flown_t){.step_s = 0.025F,
                      .off_ground = true,
                      .ours = true,
                      .thrust_n = HOVER_N,
                      .hover_n = HOVER_N,
                      .authority_mps2_per_n = 9.80665F / HOVER_N,
                      .damping_per_s = 2.5F,
                      .noise_mps2 = 0.4F};
}

void tearDown(void) {}

static void move(void)
{
    const float push_n = world.powerless ? 0.0F : world.lagged_n - HOVER_N;
    const float mps2 = 9.80665F / HOVER_N * push_n - 2.5F * world.speed_mps;

    world.lagged_n += 0.025F / 0.15F * (flown.thrust_n - world.lagged_n);
    world.speed_mps += mps2 * 0.025F;
    world.height_m += world.speed_mps * 0.025F;
    frame.down_mps2 = 9.80665F + mps2 + world.felt_lie_mps2;
}

static void cycle(void)
{
    const float seen_m = world.frozen_height ? 0.3F : world.height_m + world.lie_m;

    move();
    frame.sequence++;
    frame.arrival_us += 25000U;
    frame.median.roll_rad = world.steady ? 0.0F : 0.05F * sinf((float)frame.sequence * 0.1F);
    if (!world.deaf) {
        integrity_frames(&it, &flown, &frame, 1U);
    }
    integrity_thrust(&it, &flown);
    if (++world.cycles % 4U == 0U) {
        integrity_height(&it, &flown, seen_m, 0.1F, 0.0F);
    }
}

static void run(float seconds)
{
    for (int i = (int)lroundf(seconds * 40.0F); i > 0; i--) {
        cycle();
    }
}

/* From the ground: the climb proves heights and thrust. */
static void fly(void)
{
    flown.grounded = true;
    flown.off_ground = false;
    flown.thrust_n = HOVER_N;
    world.lagged_n = HOVER_N;
    run(2.0F);
    flown.grounded = false;
    flown.off_ground = true;
    flown.wanted_m = 0.5F;
    flown.thrust_n = HOVER_N + 0.7F;
    run(1.5F);
    flown.wanted_m = 0.0F;
    flown.thrust_n = HOVER_N;
    run(3.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
}

static float until(uint16_t doubt, float at_most_s)
{
    float passed_s = 0.0F;
    while (!integrity_doubts(&it, doubt) && passed_s < at_most_s) {
        cycle();
        passed_s += 0.025F;
    }
    TEST_ASSERT_EQUAL_UINT16(doubt, it.doubts);
    return passed_s;
}

/* ---- nothing is doubted */

void test_a_sound_flight_with_climbs_and_descents_is_believed(void)
{
    fly();
    for (int i = 0; i < 20; i++) {
        flown.thrust_n = HOVER_N + (i % 2 == 0 ? 1.0F : -1.0F);
        flown.wanted_m = i % 2 == 0 ? 0.5F : -0.5F;
        run(1.5F);
        TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.15F, world.speed_mps, integrity_speed_mps(&it));
}

void test_steps_of_the_terrain_are_believed_be_they_as_high_as_they_like(void)
{
    fly();
    for (int i = 0; i < 6; i++) {
        world.lie_m = i % 2 == 0 ? 0.8F : 0.0F;
        run(2.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
    }
}

void test_a_far_fall_of_the_terrain_is_unconfirmed_until_a_descent_shows(void)
{
    fly();
    world.lie_m = 0.3F;
    run(0.3F);
    TEST_ASSERT_FALSE(integrity_terrain_fell(&it));
    world.lie_m = 0.8F;
    run(0.3F);
    TEST_ASSERT_TRUE(integrity_terrain_fell(&it));
    flown.thrust_n = HOVER_N - 0.6F;
    run(0.5F);
    TEST_ASSERT_TRUE(integrity_terrain_fell(&it));
    run(1.0F);
    TEST_ASSERT_FALSE(integrity_terrain_fell(&it));
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
}

void test_a_hover_thrust_a_quarter_of_a_newton_off_is_believed(void)
{
    flown.hover_n = HOVER_N - 0.25F;
    fly();
    run(20.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
}

/* ---- heights */

void test_heights_that_do_not_show_a_climb_that_both_others_tell_are_doubted(void)
{
    fly();
    world.frozen_height = true;
    flown.wanted_m = 0.5F;
    flown.thrust_n = HOVER_N + 1.5F;
    const float after_s = until(DOUBT_SIGHT, 3.0F);
    TEST_ASSERT_TRUE(after_s > 0.5F && after_s < 1.5F);
    TEST_ASSERT_TRUE(it.lost_m < -0.2F && it.lost_m > -0.8F);
    TEST_ASSERT_FLOAT_WITHIN(0.3F, world.speed_mps, integrity_speed_mps(&it));
}

void test_a_slow_climb_after_the_ground_came_nearer_at_once_is_doubted_too(void)
{
    fly();
    world.frozen_height = true;
    flown.wanted_m = 0.5F;
    run(0.2F);
    TEST_ASSERT_TRUE(integrity_unconfirmed(&it));
    flown.thrust_n = HOVER_N + 0.66F;
    TEST_ASSERT_TRUE(until(DOUBT_SIGHT, 4.0F) < 2.5F);
}

void test_a_climb_that_shows_after_a_step_confirms_it(void)
{
    fly();
    world.lie_m = -0.3F;
    flown.wanted_m = 0.3F;
    run(0.2F);
    TEST_ASSERT_TRUE(integrity_unconfirmed(&it));
    flown.thrust_n = HOVER_N + 0.66F;
    run(1.2F);
    TEST_ASSERT_FALSE(integrity_unconfirmed(&it));
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
}

void test_heights_that_follow_again_are_believed_again(void)
{
    fly();
    world.frozen_height = true;
    flown.wanted_m = 0.5F;
    flown.thrust_n = HOVER_N + 1.5F;
    (void)until(DOUBT_SIGHT, 3.0F);
    flown.wanted_m = NAN;
    flown.thrust_n = HOVER_N - 0.5F;
    run(3.0F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, it.doubts);
    world.frozen_height = false;
    run(4.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
}

void test_without_accelerations_a_push_in_vain_is_what_doubts_the_heights(void)
{
    fly();
    world.deaf = true;
    run(0.5F);
    integrity_init(&it);
    it.shaken = 1.0F;
    world.frozen_height = true;
    flown.wanted_m = 0.3F;
    flown.thrust_n = HOVER_N + 1.0F;
    const float after_s = until(DOUBT_SIGHT, 6.0F);
    TEST_ASSERT_TRUE(after_s > 2.5F && after_s < 4.5F);
}

void test_the_ground_forgets_a_doubt_of_sight_by_a_new_order_alone(void)
{
    it.doubts = DOUBT_SIGHT | DOUBT_THRUST;
    flown.grounded = true;
    flown.off_ground = false;
    run(3.0F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT | DOUBT_THRUST, it.doubts);
    flown.ordered = true;
    cycle();
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
}

void test_nothing_is_judged_while_a_pilot_flies(void)
{
    fly();
    flown.ours = false;
    world.frozen_height = true;
    world.felt_lie_mps2 = 5.0F;
    run(5.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
}

void test_a_doubt_has_a_name_and_the_gravest_is_told(void)
{
    TEST_ASSERT_NULL(integrity_doubt_name(0U));
    TEST_ASSERT_EQUAL_STRING("THRUST", integrity_doubt_name(DOUBT_THRUST));
    TEST_ASSERT_EQUAL_STRING("IMU", integrity_doubt_name(DOUBT_IMU | DOUBT_THRUST));
    TEST_ASSERT_EQUAL_STRING("SIGHT", integrity_doubt_name(DOUBT_SIGHT | DOUBT_IMU));
}

void test_a_glitch_that_returns_to_where_it_began_is_no_ground_that_came_nearer(void)
{
    fly();
    flown.wanted_m = 0.3F;
    world.lie_m = 0.35F;
    run(0.1F);
    world.lie_m = 0.0F;
    run(0.1F);
    TEST_ASSERT_FALSE(integrity_unconfirmed(&it));
    run(1.0F);
    world.lie_m = -0.35F;
    run(0.1F);
    TEST_ASSERT_TRUE(integrity_unconfirmed(&it));
}

/* ---- scans */

/* Roll swings the mirror by 8 mm, and the height is corrected for it: a beam with a length of its own is
 * blocked. */
void test_a_beam_that_does_not_swing_with_the_mirror_is_blocked(void)
{
    for (int blocked = 0; blocked < 2; blocked++) {
        setUp();
        fly();
        for (int scan = 0; scan < 60; scan++) {
            const float swing_mm = 11.0F * sinf((float)scan * 0.4F);
            const float noise_mm = (scan % 2 == 0) ? 1.5F : -1.5F;
            const altitude_t altitude = {.slant_mm = 705.0F + noise_mm + (blocked ? 0.0F : swing_mm),
                                         .height_mm = 500.0F + noise_mm + (blocked ? swing_mm : 0.0F),
                                         .spread_mm = 18.0F + (float)(scan % 3)};
            TEST_ASSERT_TRUE(integrity_scan(&it, &altitude));
        }
        run(0.3F);
        TEST_ASSERT_EQUAL_UINT16(blocked ? DOUBT_SIGHT : 0U, it.doubts);
    }
}

/* Beam of a blocked mirror: a length of its own, with noise. */
static void scan_blocked(int scans)
{
    for (int scan = 0; scan < scans; scan++) {
        const altitude_t altitude = {.slant_mm = 705.0F + ((scan % 2 == 0) ? 1.0F : -1.0F),
                                     .height_mm = 300.0F,
                                     .spread_mm = 18.0F + (float)(scan % 3)};
        TEST_ASSERT_TRUE(integrity_scan(&it, &altitude));
    }
}

/* On the ground by its heights; but the tilt sways as in the air, and a climb has been felt. */
void test_a_take_off_that_no_height_shows_is_doubted(void)
{
    flown.grounded = true;
    flown.off_ground = false;
    run(2.0F);
    flown.grounded = false;
    flown.standing = true;
    world.frozen_height = true;
    flown.wanted_m = 0.5F;
    flown.thrust_n = HOVER_N + 0.8F;
    scan_blocked(14);
    TEST_ASSERT_TRUE(until(DOUBT_SIGHT, 3.0F) > 0.3F);
}

/* The same hop, of a vehicle that hardly lifts: a beam that moves is not blocked. */
void test_a_vehicle_that_hardly_lifts_is_not_doubted(void)
{
    flown.grounded = true;
    flown.off_ground = false;
    run(2.0F);
    flown.grounded = false;
    flown.standing = true;
    flown.wanted_m = 0.5F;
    flown.thrust_n = HOVER_N + 0.1F;
    run(6.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
}

/* The thrust that carries it was learned from an accelerometer that is wrong: both tell the same, and the
 * heights move. */
void test_heights_that_move_on_and_on_are_believed_against_both(void)
{
    fly();
    flown.hover_n = HOVER_N + 1.5F;
    world.felt_lie_mps2 = -4.0F;
    flown.thrust_n = HOVER_N + 0.7F;
    flown.wanted_m = 0.5F;
    TEST_ASSERT_TRUE(until(DOUBT_IMU, 2.0F) > 0.2F);
    run(2.0F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, it.doubts);
}

/* Heights near the wanted one leave the law content; the beam's stillness tells, and the thrust. */
void test_a_beam_of_nothing_but_noise_is_doubted_as_soon_as_thrust_and_accelerometer_climb(void)
{
    for (int blocked = 0; blocked < 2; blocked++) {
        setUp();
        fly();
        world.frozen_height = true;
        flown.wanted_m = 0.05F;
        flown.thrust_n = HOVER_N + 0.7F;
        if (blocked != 0) {
            scan_blocked(14);
        }
        run(1.4F);
        TEST_ASSERT_EQUAL_UINT16(blocked != 0 ? DOUBT_SIGHT : 0U, it.doubts);
    }
}

void test_an_accelerometer_is_not_blamed_by_a_beam_that_may_be_blocked(void)
{
    fly();
    world.frozen_height = true;
    scan_blocked(24);
    TEST_ASSERT_TRUE(integrity_still(&it));
    flown.hover_n = HOVER_N + 0.8F; /* and so the thrust tells of no climb */
    flown.thrust_n = HOVER_N + 0.8F;
    flown.wanted_m = 0.05F;
    run(2.0F);
    TEST_ASSERT_FALSE(integrity_doubts(&it, DOUBT_IMU));
}

void test_a_scan_that_says_the_same_as_the_one_before_is_a_copy(void)
{
    altitude_t altitude = {.height_mm = 500.0F, .slant_mm = 705.3F, .spread_mm = 21.0F};
    TEST_ASSERT_TRUE(integrity_scan(&it, &altitude));
    TEST_ASSERT_FALSE(integrity_scan(&it, &altitude));
    TEST_ASSERT_FALSE(integrity_scan(&it, &altitude));
    altitude.spread_mm = 22.0F;
    TEST_ASSERT_TRUE(integrity_scan(&it, &altitude));
    altitude.slant_mm = 705.4F;
    TEST_ASSERT_TRUE(integrity_scan(&it, &altitude));
}

void test_heights_out_of_reach_are_none(void)
{
    static const float bad_mm[] = {-51.0F, 5001.0F, NAN, INFINITY};
    static const float good_mm[] = {-49.0F, 0.0F, 4999.0F};
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_FALSE(integrity_scan(&it, &(altitude_t){.height_mm = bad_mm[i], .slant_mm = (float)i}));
    }
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(
            integrity_scan(&it, &(altitude_t){.height_mm = good_mm[i], .slant_mm = 9.0F + (float)i}));
    }
}

/* ---- accelerometer */

static void rest(float lie_mps2, float seconds)
{
    flown.grounded = true;
    flown.off_ground = false;
    world.felt_lie_mps2 = lie_mps2;
    run(seconds);
}

void test_an_accelerometer_that_does_not_feel_g_at_rest_is_doubted(void)
{
    static const float lies_mps2[] = {-2.0F, 1.6F, -9.81F + 1.0F, -19.6F};
    for (unsigned i = 0; i < 4; i++) {
        setUp();
        rest(lies_mps2[i], 2.0F);
        TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, it.doubts);
    }
    setUp();
    rest(1.4F, 5.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 1.4F, it.bias_mps2);
}

void test_one_that_feels_g_again_is_believed_again_on_the_ground_alone(void)
{
    rest(3.0F, 2.0F);
    flown.grounded = false;
    flown.off_ground = true;
    world.felt_lie_mps2 = 0.0F;
    run(10.0F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, it.doubts);
    rest(0.0F, 8.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
}

void test_an_accelerometer_against_heights_and_thrust_is_doubted_within_a_second(void)
{
    for (float lie_mps2 = -4.0F; lie_mps2 < 5.0F; lie_mps2 += 8.0F) {
        setUp();
        fly();
        world.felt_lie_mps2 = lie_mps2;
        TEST_ASSERT_TRUE(until(DOUBT_IMU, 2.0F) < 1.0F);
    }
}

void test_the_bias_follows_the_heights_whatever_the_thrust_model_says(void)
{
    flown.hover_n = HOVER_N - 0.2F;
    fly();
    world.felt_lie_mps2 = 0.4F;
    run(5.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.12F, 0.22F, it.bias_mps2);
    run(25.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.04F, 0.4F, it.bias_mps2);
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
}

void test_a_noisy_accelerometer_is_asked_less(void)
{
    fly();
    flown.noise_mps2 = 1.8F;
    run(0.1F);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 2.83F, it.shaken);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, it.felt.speed_mps / it.shaken, integrity_felt_mps(&it));
}

/* ---- thrust */

void test_commands_without_an_effect_are_doubted_once_the_law_pushes(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        setUp();
        fly();
        world.powerless = true;
        run(5.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
        flown.wanted_m = 0.5F * side;
        flown.thrust_n = HOVER_N + 2.0F * side;
        TEST_ASSERT_TRUE(until(DOUBT_THRUST, 4.0F) < 2.5F);
        TEST_ASSERT_EQUAL(side < 0.0F, it.held_down);
        TEST_ASSERT_EQUAL_FLOAT(HOVER_N, it.held_n);
        flown.thrust_n = HOVER_N + 0.6F * side;
        run(6.0F);
        TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, it.doubts);
        world.powerless = false;
        run(5.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
    }
}

/* ---- heights below the ground */

void test_heights_below_the_ground_count_again_only_when_well_above(void)
{
    static const struct {
        float height_mm;
        bool counts;
    } rows[] = {{-49.0F, true},  {-51.0F, false}, {-49.0F, false},
                {-31.0F, false}, {-29.0F, true},  {-49.0F, true}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const altitude_t altitude = {
            .height_mm = rows[i].height_mm, .slant_mm = 150.0F + (float)i, .spread_mm = 20.0F};
        TEST_ASSERT_EQUAL(rows[i].counts, integrity_scan(&it, &altitude));
    }
}

/* ---- standing */

void test_it_stands_where_little_thrust_does_not_make_it_fall(void)
{
    fly();
    world.steady = true;
    world.powerless = true;
    flown.wanted_m = NAN;
    run(6.0F);
    TEST_ASSERT_FALSE(integrity_stands(&it));
    flown.thrust_n = 0.5F * HOVER_N;
    run(2.5F);
    TEST_ASSERT_TRUE(integrity_stands(&it));
    TEST_ASSERT_FALSE(integrity_sways(&it));
}

void test_a_speed_felt_wrongly_from_before_does_not_hide_that_it_stands(void)
{
    fly();
    world.steady = true;
    flown.wanted_m = NAN;
    world.powerless = true;
    world.felt_lie_mps2 = -0.8F; /* what a touch that was not felt leaves */
    world.frozen_height = true;
    run(1.0F);
    world.felt_lie_mps2 = 0.0F;
    it.doubts = DOUBT_SIGHT;
    run(5.0F);
    TEST_ASSERT_TRUE(it.felt.speed_mps < -0.4F);
    TEST_ASSERT_TRUE(integrity_may_stand(&it));
    flown.thrust_n = 0.9F * HOVER_N;
    run(1.0F);
    TEST_ASSERT_FALSE(integrity_stands(&it));
    flown.thrust_n = 0.6F * HOVER_N;
    run(2.5F);
    TEST_ASSERT_TRUE(integrity_stands(&it));
}

void test_a_still_vehicle_may_stand_until_it_feels_a_fall(void)
{
    fly();
    world.steady = true;
    flown.wanted_m = NAN;
    run(0.5F);
    TEST_ASSERT_FALSE(integrity_may_stand(&it));
    run(9.5F);
    TEST_ASSERT_TRUE(integrity_may_stand(&it));
    flown.thrust_n = 0.8F * HOVER_N;
    run(1.0F);
    TEST_ASSERT_FALSE(integrity_may_stand(&it));
    TEST_ASSERT_FALSE(integrity_stands(&it));
}

void test_it_does_not_stand_while_it_falls_or_sways(void)
{
    fly();
    world.steady = true;
    flown.wanted_m = NAN;
    flown.thrust_n = 0.5F * HOVER_N;
    run(3.0F);
    TEST_ASSERT_FALSE(integrity_stands(&it));
    setUp();
    fly();
    world.powerless = true;
    flown.wanted_m = NAN;
    flown.thrust_n = 0.5F * HOVER_N;
    run(3.0F);
    TEST_ASSERT_FALSE(integrity_stands(&it));
    TEST_ASSERT_TRUE(integrity_sways(&it));
}

/* ---- carried */

/* On the ground for the state, without heights; who has it swings it so fast. */
static void carry(float seconds, float swing_mps2, float sway_rad)
{
    for (int k = 0; k < (int)lroundf(seconds * 40.0F); k++) {
        frame.sequence++;
        frame.arrival_us += 25000U;
        frame.median.roll_rad = sway_rad * sinf((float)frame.sequence * 0.15F);
        frame.down_mps2 = 9.80665F + 0.3F + swing_mps2 * sinf((float)frame.sequence * 0.1F);
        integrity_frames(&it, &flown, &frame, 1U);
    }
}

void test_a_vehicle_that_sways_on_the_ground_without_heights_is_carried(void)
{
    flown.grounded = true;
    carry(5.0F, 0.0F, 0.0F);
    TEST_ASSERT_FALSE(integrity_carried(&it));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.3F, it.bias_mps2);
    carry(0.25F, 10.0F, 0.05F); /* the lift does not spoil the bias that was measured at rest */
    carry(6.0F, 1.0F, 0.05F);
    TEST_ASSERT_TRUE(integrity_carried(&it));
    TEST_ASSERT_FLOAT_WITHIN(0.15F, 0.3F, it.bias_mps2);
    TEST_ASSERT_FLOAT_WITHIN(0.4F, 0.0F, it.felt.speed_mps);
    TEST_ASSERT_EQUAL_UINT16(0U, it.doubts);
    carry(8.0F, 0.0F, 0.0F);
    TEST_ASSERT_FALSE(integrity_carried(&it));
}

void test_who_tilts_it_by_hand_or_has_heights_does_not_carry_it(void)
{
    flown.grounded = true;
    carry(5.0F, 0.0F, 0.0F);
    carry(6.0F, 1.0F, 0.3F);
    TEST_ASSERT_FALSE(integrity_carried(&it));
    setUp();
    flown.grounded = true;
    for (int k = 0; k < 100; k++) {
        carry(0.1F, 1.0F, 0.05F);
        integrity_height(&it, &flown, 0.5F, 0.1F, 0.0F);
        TEST_ASSERT_FALSE(integrity_carried(&it));
    }
}

static void stand_tilted(float seconds, float roll_rad)
{
    it.standing = true; /* as integrity_thrust() finds in state GROUND */
    for (int k = 0; k < (int)lroundf(seconds * 40.0F); k++) {
        frame.sequence++;
        frame.arrival_us += 25000U;
        frame.median.roll_rad = roll_rad;
        integrity_frames(&it, &flown, &frame, 1U);
        TEST_ASSERT_FALSE(integrity_carried(&it));
    }
}

/* It stands without heights. */
void test_tilts_by_hand_nudges_and_wrong_frames_are_no_carried_vehicle(void)
{
    flown.grounded = true;
    carry(5.0F, 0.0F, 0.0F);
    for (int k = 0; k < 200; k++) { /* the signs of the IMU are tried */
        carry(0.1F, 0.0F, 0.3F);
        TEST_ASSERT_FALSE(integrity_carried(&it));
    }
    for (float roll_rad = 0.02F; roll_rad < 0.4F; roll_rad += 0.02F) { /* put down, each time another way */
        stand_tilted(8.0F, roll_rad);
        stand_tilted(0.2F, 0.5F * roll_rad);
        stand_tilted(8.0F, 0.0F);
    }
    for (int k = 0; k < 200; k++) {
        stand_tilted(0.475F, 0.0F);
        stand_tilted(0.025F, (k % 2 == 0) ? 0.5F : -0.5F);
    }
}

/* ---- tilt */

static void tilt(float degrees, int frames)
{
    for (int i = 0; i < frames; i++) {
        frame.sequence++;
        frame.arrival_us += 25000U;
        frame.level.roll_rad = frame.median.roll_rad = degrees * DEGREE_RAD;
        integrity_tilt(&it, &frame, 1U, 0.0F, 0.0F, 0U);
    }
}

void test_a_tilt_that_comes_in_one_jump_is_believed_after_six_frames(void)
{
    tilt(2.0F, 20);
    tilt(70.0F, 6);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 2.0F * DEGREE_RAD, it.roll_rad);
    TEST_ASSERT_EQUAL_UINT16(0U, it.tilted);
    TEST_ASSERT_EQUAL_UINT32(frame.sequence, it.unfit_sequence);
    tilt(1.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 1.0F * DEGREE_RAD, it.roll_rad);
    tilt(70.0F, 9);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 70.0F * DEGREE_RAD, it.roll_rad);
    TEST_ASSERT_EQUAL_UINT16(3U, it.tilted);
}

void test_a_tilt_that_grows_is_believed_at_once(void)
{
    for (int i = 0; i <= 10; i++) {
        tilt(10.0F * (float)i, 1); /* 400 degrees per second */
        TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 10.0F * (float)i * DEGREE_RAD, it.roll_rad);
    }
    TEST_ASSERT_EQUAL_UINT16(6U, it.tilted);
}

void test_a_roll_whose_median_jumps_once_is_believed_at_its_second_frame(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        setUp();
        for (int i = 0; i <= 10; i++) { /* from the third on one frame ahead: a spike in the five */
            tilt((float)sign * 11.0F * (float)(i + (i > 2)), 1);
            TEST_ASSERT_EQUAL_UINT16(i == 3 ? 1U : 0U, it.jumped);
        }
        TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, (float)sign * 121.0F * DEGREE_RAD, it.roll_rad);
    }
}

void test_bad_frames_that_jump_and_drift_are_no_roll(void)
{
    for (float drift = -5.0F; drift <= 20.0F; drift += 2.5F) {
        setUp();
        tilt(2.0F, 5);
        for (int i = 0; i < 6; i++) {
            tilt(60.0F + drift * (float)i, 1);
            TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 2.0F * DEGREE_RAD, it.roll_rad);
        }
        tilt(1.0F, 1);
        TEST_ASSERT_EQUAL_UINT16(0U, it.tilted);
    }
}

void test_a_median_that_outlasts_its_frames_does_not_count_as_tilted(void)
{
    tilt(20.0F, 1);
    tilt(39.0F, 1);
    tilt(55.0F, 2);
    TEST_ASSERT_EQUAL_UINT16(2U, it.tilted);
    frame.sequence++;
    frame.arrival_us += 25000U;
    frame.level.roll_rad = 0.0F;
    integrity_tilt(&it, &frame, 1U, 0.0F, 0.0F, 0U);
    TEST_ASSERT_EQUAL_UINT16(2U, it.tilted);
    tilt(40.0F, 1);
    TEST_ASSERT_EQUAL_UINT16(0U, it.tilted);
}

void test_a_vehicle_that_has_rolled_over_is_tilted_before_its_median_says_so(void)
{
    tilt(2.0F, 5);
    frame.rolled = ATTITUDE_ROLLED_FRAMES - 1U;
    tilt(2.0F, 1);
    TEST_ASSERT_EQUAL_UINT16(0U, it.tilted);
    frame.rolled = ATTITUDE_ROLLED_FRAMES;
    tilt(2.0F, 1);
    TEST_ASSERT_GREATER_THAN_UINT16(3U, it.tilted);
}

void test_a_tilt_after_a_silence_or_through_the_half_turn_is_no_jump(void)
{
    tilt(2.0F, 5);
    frame.arrival_us += 300000U;
    tilt(70.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 70.0F * DEGREE_RAD, it.roll_rad);
    tilt(175.0F, 9);
    tilt(-175.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -175.0F * DEGREE_RAD, it.roll_rad);
}

void test_one_sample_stands_for_the_frames_where_there_are_none(void)
{
    integrity_tilt(&it, NULL, 0U, 0.1F, -0.2F, 1000U);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, it.roll_rad);
    TEST_ASSERT_EQUAL_FLOAT(-0.2F, it.pitch_rad);
    integrity_tilt(&it, NULL, 0U, NAN, 0.0F, 2000U);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, it.roll_rad);
    integrity_tilt(&it, NULL, 0U, 1.0F, 0.0F, 2000U);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, it.roll_rad);
}
