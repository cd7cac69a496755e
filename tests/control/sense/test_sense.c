#include "control/altitude.h"
#include "control/sense/sense.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define DEGREE_RAD 0.0174532925F

#define HOVER_N 7.4F

/* A vehicle that moves as its thrust says, and what its sensors tell of it: a scan every 0.1 s, a frame every
 * 25 ms. It sways by 3 degrees, and the rays have 3 mm of noise. Front mirror alone, or all three. */
static sense_t it;
static evidence_t seen;
static command_t flown;
static flight_inputs_t in;
static imu_sample_t frame;
static altitude_geometry_t geometry;
static altitude_t mirrors[MIRROR_COUNT];
static struct {
    float height_m, speed_mps, terrain_m, felt_lie_mps2, lagged_n, gust_mps2;
    float shown_m; /* what blocks the beams is where they would show this height, if level; NAN: nothing */
    bool powerless, deaf, steady, three;
    uint32_t cycles, seed;
} world;

void setUp(void)
{
    memset(&it, 0, sizeof it);
    sense_init(&it);
    memset(&world, 0, sizeof world);
    memset(&in, 0, sizeof in);
    memset(&frame, 0, sizeof frame);
    geometry = altitude_geometry_default();
    frame.ready = frame.has_acceleration = true;
    world.lagged_n = HOVER_N;
    world.shown_m = NAN;
    world.seed = 1U;
    flown = (command_t){.step_s = 0.025F,
                        .off_ground = true,
                        .ours = true,
                        .thrust_n = HOVER_N,
                        .hover_n = HOVER_N,
                        .authority_mps2_per_n = 9.80665F / HOVER_N,
                        .damping_per_s = 2.5F,
                        .noise_mps2 = 0.4F};
}

void tearDown(void) {}

/* Deviation 1, within 2 to either side. */
static float noise(void)
{
    float sum = 0.0F;

    for (int k = 0; k < 4; k++) {
        world.seed = world.seed * 1664525U + 1013904223U;
        sum += (float)(world.seed >> 8) / 16777216.0F - 0.5F;
    }
    return sum * 1.7320508F;
}

static void move(void)
{
    const float push_n = world.powerless ? 0.0F : world.lagged_n - HOVER_N;
    const float mps2 = 9.80665F / HOVER_N * push_n - 2.5F * world.speed_mps + world.gust_mps2;

    world.lagged_n += 0.025F / 0.15F * (flown.thrust_n - world.lagged_n);
    world.speed_mps += mps2 * 0.025F;
    world.height_m += world.speed_mps * 0.025F;
    frame.down_mps2 = 9.80665F + mps2 + world.felt_lie_mps2;
}

/* One cycle with the frame, and with a new height when height_mm is one. */
static void sense_a_frame(const altitude_t *altitude)
{
    frame.sequence++;
    frame.arrival_us += 25000U;
    in.now_us = in.attitude_time_us = frame.arrival_us;
    in.frames = world.deaf ? NULL : &frame;
    in.frame_count = (uint16_t)(world.deaf ? 0 : 1);
    in.height_valid = altitude != NULL;
    if (altitude != NULL) {
        in.height_sequence++;
        in.height_time_us = frame.arrival_us;
        in.height_stamp_ms = frame.arrival_us / 1000U;
        in.altitude = *altitude;
    }
    seen = sense_step(&it, &flown, &in);
}

static float slant_of(mirror_t mirror, float height_mm, float roll_rad)
{
    const mirror_geometry_t *at = &geometry.mirror[mirror];
    const float none_mm = altitude_under_mirror(at, 0.0F, roll_rad, 0.0F);

    return (height_mm - none_mm) / (altitude_under_mirror(at, 1.0F, roll_rad, 0.0F) - none_mm);
}

/* What blocks a beam has a length of its own, which no tilt moves. */
static altitude_t scan(float roll_rad)
{
    mirror_range_t ranges[MIRROR_COUNT];

    for (int m = 0; m < MIRROR_COUNT; m++) {
        const float slant_mm = isfinite(world.shown_m)
                                   ? slant_of((mirror_t)m, 1000.0F * world.shown_m, 0.0F)
                                   : slant_of((mirror_t)m, 1000.0F * (world.height_m - world.terrain_m),
                                              roll_rad);
        ranges[m] = (mirror_range_t){.mirror = (mirror_t)m,
                                     .valid = true,
                                     .slant_mm = slant_mm + 3.0F * noise(),
                                     .spread_mm = 18.0F + noise(),
                                     .good_rays = 35U};
    }
    altitude_of_mirrors(mirrors, &geometry, ranges, MIRROR_COUNT, roll_rad, 0.0F);
    in.mirrors = world.three ? mirrors : NULL;
    return world.three ? altitude_mean(mirrors, altitude_weights_equal, MIRROR_COUNT) : mirrors[MIRROR_FRONT];
}

static void cycle(void)
{
    move();
    frame.median.roll_rad = world.steady ? 0.0F : 0.05F * sinf((float)frame.sequence * 0.1F);
    frame.level = frame.median;
    in.roll_rad = frame.median.roll_rad;
    const altitude_t altitude = scan(frame.median.roll_rad);
    sense_a_frame((++world.cycles % 4U == 0U) ? &altitude : NULL);
}

static void run(float seconds)
{
    for (int i = (int)lroundf(seconds * 40.0F); i > 0; i--) {
        cycle();
    }
}

static void gust(float mps2, float seconds)
{
    world.gust_mps2 = mps2;
    run(seconds);
    world.gust_mps2 = 0.0F;
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
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
}

/* Of twenty noises each, the front mirror alone and all three. */
static void fly_anew(uint32_t flight)
{
    setUp();
    world.three = flight % 2U != 0U;
    world.seed = 7919U * (flight + 1U);
    fly();
}
#define FLIGHTS 40U

static float until(uint16_t doubt, float at_most_s)
{
    float passed_s = 0.0F;
    while (!doubts(&seen, doubt) && passed_s < at_most_s) {
        cycle();
        passed_s += 0.025F;
    }
    TEST_ASSERT_EQUAL_UINT16(doubt, seen.doubts);
    return passed_s;
}

/* ---- nothing is doubted */

void test_a_sound_flight_with_climbs_and_descents_is_believed(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        for (int i = 0; i < 20; i++) {
            flown.thrust_n = HOVER_N + (i % 2 == 0 ? 1.0F : -1.0F);
            flown.wanted_m = i % 2 == 0 ? 0.5F : -0.5F;
            run(1.5F);
            TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.15F, world.speed_mps, seen.speed_mps);
    }
}

void test_steps_of_the_terrain_are_believed_be_they_as_high_as_they_like(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        for (int i = 0; i < 6; i++) {
            bool stepped = false;

            world.terrain_m = i % 2 == 0 ? -0.8F : 0.0F;
            for (int k = 0; k < 12; k++) {
                run(0.025F);
                stepped = stepped || seen.stepped;
            }
            run(1.7F);
            TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
            TEST_ASSERT_TRUE(stepped && !seen.stepped);
        }
    }
}

/* It hovers without a gust, and the tilt is still: everything repeats itself, and nobody is suspected. */
void test_a_vehicle_that_hovers_as_if_it_stood_is_believed(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        world.steady = true;
        for (int i = 0; i < 60; i++) {
            run(1.0F);
            TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
        }
    }
}

/* The accelerometer tells a gust, and the thrust does not. */
void test_a_gust_is_believed_up_and_down(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        for (int i = 0; i < 10; i++) {
            gust(((i % 2 == 0) ? 3.0F : -3.0F), 0.3F);
            run(1.5F);
            TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
        }
    }
}

/* A ramp under it: 0.25 m/s of the ground, for 2 s up and for 2 s down. */
void test_a_slope_is_believed(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        for (int i = 0; i < 320; i++) {
            world.terrain_m += ((i / 80) % 2 == 0) ? 0.00625F : -0.00625F;
            cycle();
            TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
        }
    }
}

void test_a_far_fall_of_the_terrain_is_unconfirmed_until_a_descent_shows(void)
{
    fly();
    world.terrain_m = -0.3F;
    run(0.3F);
    TEST_ASSERT_FALSE(seen.unshown.descent);
    world.terrain_m = -0.8F;
    run(0.3F);
    TEST_ASSERT_TRUE(seen.unshown.descent);
    flown.thrust_n = HOVER_N - 0.6F;
    run(0.5F);
    TEST_ASSERT_TRUE(seen.unshown.descent);
    run(1.0F);
    TEST_ASSERT_FALSE(seen.unshown.descent);
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
}

void test_the_number_of_the_ground_is_passed_on_with_the_height(void)
{
    fly();
    TEST_ASSERT_NOT_EQUAL_UINT16(0U, in.altitude.ground);
    TEST_ASSERT_EQUAL_UINT16(it.senses.mirrors.ground, in.altitude.ground);
}

void test_a_hover_thrust_a_quarter_of_a_newton_off_is_believed(void)
{
    flown.hover_n = HOVER_N - 0.25F;
    fly();
    run(20.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
}

/* The hover thrust is found a quarter of a newton too small. */
void test_what_a_flight_has_learned_of_the_thrust_the_next_one_has_not(void)
{
    flown.hover_n = HOVER_N - 0.25F;
    fly();
    run(10.0F);

    TEST_ASSERT_TRUE(it.senses.mirrors.belief.worlds[0].push_known > 0.1F);
    TEST_ASSERT_TRUE(it.senses.mirrors.belief.worlds[0].push_off_mps2 < -0.1F);
    world.height_m = world.speed_mps = 0.0F;
    flown.grounded = true;
    flown.off_ground = false;
    run(0.1F);
    for (int k = 0; k < (int)BELIEF_WORLDS; k++) {
        TEST_ASSERT_EQUAL_FLOAT(0.0F, it.senses.mirrors.belief.worlds[k].push_known);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, it.senses.mirrors.belief.worlds[k].push_off_mps2);
    }
}

/* ---- heights */

void test_heights_that_do_not_show_a_climb_that_both_others_tell_are_doubted(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        const float from_m = world.height_m;

        world.shown_m = 0.3F;
        flown.wanted_m = 0.5F;
        flown.thrust_n = HOVER_N + 1.5F;
        const float after_s = until(DOUBT_SIGHT, 3.0F);
        TEST_ASSERT_TRUE(after_s > 0.4F && after_s < 1.5F);
        TEST_ASSERT_FLOAT_WITHIN(0.2F * (world.height_m - from_m) + 0.03F, world.height_m,
                                 seen.blind_height_m);
        TEST_ASSERT_FLOAT_WITHIN(0.3F, world.speed_mps, seen.speed_mps);
    }
}

/* What it shows is near the height that it showed. Three that are blocked at once are less likely, so their
 * jump has to be larger. */
void test_a_beam_blocked_near_its_height_is_doubted_before_the_vehicle_has_climbed_a_metre(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        const float from_m = world.height_m;
        const float jump_m = world.three ? 0.2F : 0.1F;
        world.shown_m = from_m + ((flight % 4U < 2U) ? jump_m : -jump_m);
        flown.wanted_m = 0.5F;
        flown.thrust_n = HOVER_N + 2.5F;
        (void)until(DOUBT_SIGHT, 4.0F);
        TEST_ASSERT_FLOAT_WITHIN(0.45F, 0.55F, world.height_m - from_m);
    }
}

void test_a_slow_climb_after_the_ground_came_nearer_at_once_is_doubted_too(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        world.shown_m = 0.3F;
        flown.wanted_m = 0.5F;
        run(0.2F);
        TEST_ASSERT_TRUE(world.three || seen.unshown.climb);
        flown.thrust_n = HOVER_N + 0.66F;
        TEST_ASSERT_TRUE(until(DOUBT_SIGHT, 4.0F) < 2.5F);
    }
}

void test_a_climb_that_shows_after_a_step_confirms_it(void)
{
    fly();
    world.terrain_m = 0.3F;
    flown.wanted_m = 0.3F;
    run(0.2F);
    TEST_ASSERT_TRUE(seen.unshown.climb);
    flown.thrust_n = HOVER_N + 0.66F;
    run(1.2F);
    TEST_ASSERT_FALSE(seen.unshown.climb);
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
}

/* Not after a take-off: all of them may be blocked from there on. */
void test_a_step_that_the_mirrors_agree_on_needs_no_climb(void)
{
    fly();
    world.terrain_m = 0.3F;
    run(0.2F);
    TEST_ASSERT_TRUE(seen.unshown.climb);
    for (int agree = 0; agree < 2; agree++) {
        for (int proved = 0; proved < 2; proved++) {
            it.senses.mirrors.agree = agree != 0;
            it.senses.confirmation.proved = proved != 0;
            sense_a_frame(NULL);
            TEST_ASSERT_EQUAL_INT((agree != 0 && proved != 0) ? 0 : 1, seen.unshown.climb ? 1 : 0);
        }
    }
}

void test_heights_that_follow_again_are_believed_again(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        world.shown_m = 0.3F;
        flown.wanted_m = 0.5F;
        flown.thrust_n = HOVER_N + 1.5F;
        (void)until(DOUBT_SIGHT, 3.0F);
        flown.wanted_m = NAN;
        flown.thrust_n = HOVER_N - 0.5F;
        for (int i = 0; i < 30; i++) {
            run(0.1F);
            TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, seen.doubts);
        }
        world.shown_m = NAN;
        run(4.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
    }
}

/* What blocks it now stands farther away: it is still no sight. */
void test_a_block_that_moves_away_is_no_sight(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        world.shown_m = 0.3F;
        flown.wanted_m = 0.5F;
        flown.thrust_n = HOVER_N + 1.5F;
        (void)until(DOUBT_SIGHT, 3.0F);
        flown.wanted_m = NAN;
        flown.thrust_n = HOVER_N - 0.5F;
        run(1.0F);
        world.shown_m = 0.5F;
        for (int i = 0; i < 20; i++) {
            run(0.1F);
            TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, seen.doubts);
        }
    }
}

static void lose_sight(void)
{
    fly();
    world.shown_m = 0.3F;
    flown.wanted_m = 0.5F;
    flown.thrust_n = HOVER_N + 1.5F;
    (void)until(DOUBT_SIGHT, 3.0F);
}

void test_the_ground_forgets_a_doubt_of_sight_by_a_new_order_alone(void)
{
    lose_sight();
    flown.grounded = true;
    flown.off_ground = false;
    run(3.0F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, seen.doubts);
    flown.ordered = true;
    cycle();
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
}

void test_an_order_in_the_air_forgets_no_doubt(void)
{
    lose_sight();
    flown.ordered = true;
    cycle();
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, seen.doubts);
}

void test_nothing_is_judged_while_a_pilot_flies(void)
{
    fly();
    flown.ours = false;
    world.shown_m = 0.3F;
    world.felt_lie_mps2 = 5.0F;
    run(5.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
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
            const altitude_t altitude = {.valid = true,
                                         .slant_mm = 705.0F + noise_mm + (blocked ? 0.0F : swing_mm),
                                         .height_mm = 500.0F + noise_mm + (blocked ? swing_mm : 0.0F),
                                         .good_rays = 35U,
                                         .spread_mm = 18.0F + (float)(scan % 3)};
            for (int k = 0; k < 4; k++) {
                frame.median.roll_rad = 0.05F * sinf((float)frame.sequence * 0.1F);
                frame.level = frame.median;
                frame.down_mps2 = 9.80665F;
                sense_a_frame((k == 0) ? &altitude : NULL);
                TEST_ASSERT_TRUE(k != 0 || in.height_valid || blocked != 0);
            }
        }
        TEST_ASSERT_EQUAL_UINT16(blocked ? DOUBT_SIGHT : 0U, seen.doubts);
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
    world.shown_m = 0.3F;
    flown.wanted_m = 0.5F;
    flown.thrust_n = HOVER_N + 0.8F;
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
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
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
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, seen.doubts);
}

/* Heights near the wanted one leave the law content; the beam's stillness tells. */
void test_a_beam_of_nothing_but_noise_is_doubted_also_near_the_reference(void)
{
    fly();
    world.shown_m = 0.3F;
    flown.wanted_m = 0.05F;
    flown.thrust_n = HOVER_N + 0.7F;
    TEST_ASSERT_TRUE(until(DOUBT_SIGHT, 6.0F) < 5.5F);
}

void test_an_accelerometer_is_not_blamed_by_a_beam_that_may_be_blocked(void)
{
    fly();
    world.shown_m = 0.3F;
    run(2.4F);
    flown.hover_n = HOVER_N + 0.8F; /* so the thrust tells of no climb */
    flown.thrust_n = HOVER_N + 0.8F;
    flown.wanted_m = 0.05F;
    run(2.0F);
    TEST_ASSERT_FALSE(doubts(&seen, DOUBT_IMU));
}

/* Whether the height of one more scan is passed on. */
static bool passes(float height_mm, float slant_mm, float spread_mm)
{
    /* not marked valid: in.height_valid tells it */
    const altitude_t altitude = {
        .height_mm = height_mm, .slant_mm = slant_mm, .good_rays = 35U, .spread_mm = spread_mm};

    sense_a_frame(&altitude);
    return in.height_valid;
}

void test_a_scan_that_says_the_same_as_the_one_before_is_a_copy(void)
{
    TEST_ASSERT_TRUE(passes(500.0F, 705.3F, 21.0F));
    TEST_ASSERT_FALSE(passes(500.0F, 705.3F, 21.0F));
    TEST_ASSERT_FALSE(passes(500.0F, 705.3F, 21.0F));
    TEST_ASSERT_TRUE(passes(500.0F, 705.3F, 22.0F));
    TEST_ASSERT_TRUE(passes(500.0F, 705.4F, 22.0F));
}

void test_heights_out_of_reach_are_none(void)
{
    static const float bad_mm[] = {-51.0F, 5001.0F, NAN, INFINITY};
    static const float good_mm[] = {-29.0F, 0.0F, 4999.0F};
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_FALSE(passes(bad_mm[i], (float)i, 0.0F));
    }
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(passes(good_mm[i], good_mm[i] + 200.0F, 0.0F));
    }
}

/* ---- the line to the scanner */

/* Scans that wait on the line, with the scanner's own time. */
typedef struct {
    altitude_t mirrors[MIRROR_COUNT];
    uint32_t stamp_ms;
} waiting_t;
static struct {
    waiting_t scans[8];
    int count;
} line;

static void turn_of_the_scanner(void)
{
    (void)scan(frame.median.roll_rad);
    memcpy(line.scans[line.count].mirrors, mirrors, sizeof mirrors);
    line.scans[line.count].stamp_ms = frame.arrival_us / 1000U;
    line.count++;
}

/* One cycle; `delivers`: the oldest scan that waits comes with it. */
static void cycle_of_the_line(bool turns, bool delivers)
{
    move();
    frame.median.roll_rad = 0.05F * sinf((float)frame.sequence * 0.1F);
    frame.level = frame.median;
    in.roll_rad = frame.median.roll_rad;
    frame.sequence++;
    frame.arrival_us += 25000U;
    if (turns) {
        turn_of_the_scanner();
    }
    in.now_us = in.attitude_time_us = frame.arrival_us;
    in.frames = &frame;
    in.frame_count = 1U;
    in.height_valid = delivers && line.count > 0;
    if (in.height_valid) {
        in.height_sequence++;
        in.height_time_us = frame.arrival_us;
        in.height_stamp_ms = line.scans[0].stamp_ms;
        memcpy(mirrors, line.scans[0].mirrors, sizeof mirrors);
        in.mirrors = world.three ? mirrors : NULL;
        in.altitude = world.three ? altitude_mean(mirrors, altitude_weights_equal, MIRROR_COUNT)
                                  : mirrors[MIRROR_FRONT];
        line.count--;
        memmove(&line.scans[0], &line.scans[1], sizeof line.scans - sizeof line.scans[0]);
    }
    seen = sense_step(&it, &flown, &in);
}

/* Up and down; each second the line holds what comes for so many turns of the scanner, and then gives it
 * cycle by cycle. */
static void fly_by_a_line_that_holds(int turns, int seconds)
{
    line.count = 0;
    for (int k = 0; k < 40 * seconds; k++) {
        flown.thrust_n = HOVER_N + (((k / 60) % 2 == 0) ? 3.0F : -3.0F);
        flown.wanted_m = ((k / 60) % 2 == 0) ? 0.5F : -0.5F;
        cycle_of_the_line(k % 4 == 3, k % 40 >= 4 * turns);
        TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
        TEST_ASSERT_EQUAL_UINT16(0U, seen.mirrors.liars);
    }
}

void test_a_line_that_holds_scans_up_makes_nobody_a_liar(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        fly_by_a_line_that_holds((int)(flight / 2U) % 6, 20);
    }
}

/* The belief after a scan, before which the frames told of this acceleration. together: with three that have
 * waited, of which it is the second. */
static belief_t belief_after(float felt_mps2, bool together)
{
    setUp();
    fly();
    line.count = 0;
    for (int k = 1; k <= 12; k++) {
        cycle_of_the_line(k % 4 == 0, !together);
    }
    if (together) {
        cycle_of_the_line(false, true);
    }
    world.felt_lie_mps2 = felt_mps2;
    for (int k = (together ? 4 : 1); k <= 4; k++) {
        cycle_of_the_line(k == 4 && !together, true);
    }
    TEST_ASSERT_EQUAL_INT(together ? 1 : 0, line.count);
    return it.senses.mirrors.belief;
}

/* The frames since the scan before are of another time than its rays. */
void test_what_frames_tell_is_not_shown_to_a_scan_that_waited_with_others(void)
{
    for (int together = 0; together < 2; together++) {
        const belief_t still = belief_after(0.0F, together != 0);
        const belief_t pushed = belief_after(3.0F, together != 0);

        TEST_ASSERT_EQUAL(together != 0, memcmp(&still, &pushed, sizeof still) == 0);
    }
}

void test_rays_are_timed_by_the_scanners_own_clock(void)
{
    static const uint32_t late_us[] = {0U, 40000U, 10000U, 30000U, 0U, 45000U};
    uint32_t before_us = 0U;

    for (uint32_t k = 0U; k < 60U; k++) {
        in.height_sequence++;
        in.height_valid = true;
        in.height_stamp_ms = 5000U + 100U * k;
        in.height_time_us = 1000000U + 100000U * k + late_us[k % 6U];
        in.height_age_us = 70000U;
        in.altitude = (altitude_t){.valid = true,
                                   .height_mm = 500.0F,
                                   .slant_mm = 700.0F + (float)k,
                                   .good_rays = 35U,
                                   .spread_mm = 9.0F};
        seen = sense_step(&it, &flown, &in);
        if (k > 0U) {
            TEST_ASSERT_UINT32_WITHIN(2100U, 100000U, it.rays_us - before_us); /* 0.5 % of drift */
        }
        before_us = it.rays_us;
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
        TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, seen.doubts);
    }
    setUp();
    rest(1.4F, 5.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 1.4F, seen.bias_mps2);
}

void test_one_that_feels_g_again_is_believed_again_on_the_ground_alone(void)
{
    rest(3.0F, 2.0F);
    flown.grounded = false;
    flown.off_ground = true;
    world.felt_lie_mps2 = 0.0F;
    run(10.0F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, seen.doubts);
    rest(0.0F, 8.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
}

/* The belief must say so in two scans in a row, 0.1 s apart. */
void test_an_accelerometer_against_heights_and_thrust_is_doubted_a_scan_after_a_second(void)
{
    for (float lie_mps2 = -4.0F; lie_mps2 < 5.0F; lie_mps2 += 8.0F) {
        setUp();
        fly();
        world.felt_lie_mps2 = lie_mps2;
        TEST_ASSERT_FLOAT_WITHIN(0.3F, 0.85F, until(DOUBT_IMU, 2.0F));
    }
}

void test_the_bias_follows_the_heights_whatever_the_thrust_model_says(void)
{
    flown.hover_n = HOVER_N - 0.2F;
    fly();
    world.felt_lie_mps2 = 0.4F;
    run(5.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.12F, 0.22F, seen.bias_mps2);
    run(25.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.04F, 0.4F, seen.bias_mps2);
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
}

void test_a_noisy_accelerometer_is_asked_less(void)
{
    fly();
    flown.noise_mps2 = 1.8F;
    run(0.1F);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 2.83F, seen.shaken);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, seen.felt_mps / seen.shaken, felt_mps(&seen));
}

/* ---- thrust */

void test_commands_without_an_effect_are_doubted_once_the_law_pushes(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        setUp();
        world.terrain_m = -2.0F; /* over a shaft, so that it has where to sink */
        fly();
        world.powerless = true;
        run(5.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
        flown.wanted_m = 0.5F * side;
        flown.thrust_n = HOVER_N + 2.0F * side;
        TEST_ASSERT_TRUE(until(DOUBT_THRUST, 4.0F) < 2.5F);
        TEST_ASSERT_EQUAL(side < 0.0F, seen.held.down);
        TEST_ASSERT_EQUAL_FLOAT(HOVER_N, seen.held.hover_n);
        run(1.0F); /* later it may as well be a load, push_off_mps2 in belief_world.h */
        TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, seen.doubts);
        flown.thrust_n = HOVER_N + 0.5F * side; /* as far as it may then push, bounds.c */
        world.powerless = false;
        run(6.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
    }
}

/* A pilot climbs at 0.4 m/s while the law lets it sink: before any doubt nothing is learned from that thrust.
 */
void test_a_thrust_without_effect_is_known_before_any_doubt(void)
{
    for (uint32_t flight = 0U; flight < FLIGHTS; flight++) {
        fly_anew(flight);
        run(3.0F);
        TEST_ASSERT_FALSE(seen.mirrors.no_effect);
        world.powerless = true;
        flown.thrust_n = HOVER_N - 2.5F;
        world.gust_mps2 = 1.0F;
        run(1.0F);
        TEST_ASSERT_TRUE(seen.mirrors.no_effect);
        TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
        world.powerless = false;
        world.gust_mps2 = 0.0F;
        flown.thrust_n = HOVER_N + 2.5F;
        run(1.0F);
        TEST_ASSERT_FALSE(seen.mirrors.no_effect);
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
        TEST_ASSERT_EQUAL(rows[i].counts, passes(rows[i].height_mm, 150.0F + (float)i, 20.0F));
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
    TEST_ASSERT_FALSE(seen.stands);
    flown.thrust_n = 0.5F * HOVER_N;
    run(2.5F);
    TEST_ASSERT_TRUE(seen.stands);
    TEST_ASSERT_FALSE(seen.sways);
}

static void calm_without_heights(float seconds)
{
    world.steady = true;
    for (int i = (int)lroundf(seconds * 40.0F); i > 0; i--) {
        move();
        frame.median.roll_rad = 0.0F;
        frame.level = frame.median;
        sense_a_frame(NULL);
    }
}

/* Calm air is as calm as the ground. What the latest scan told,
 * that it moves, is of no use after 1.5 s. */
void test_without_heights_it_may_stand_when_by_the_thrust_it_has_come_down(void)
{
    fly();
    calm_without_heights(5.0F);
    TEST_ASSERT_FALSE(seen.may_stand);
    flown.thrust_n = 0.9F * HOVER_N; /* 0.39 m/s downwards */
    calm_without_heights(1.0F);
    TEST_ASSERT_FALSE(seen.may_stand);
    calm_without_heights(4.0F);
    TEST_ASSERT_TRUE(seen.may_stand);
}

void test_a_speed_felt_wrongly_from_before_does_not_hide_that_it_stands(void)
{
    fly();
    world.steady = true;
    flown.wanted_m = NAN;
    world.powerless = true;
    world.felt_lie_mps2 = -0.8F; /* what a touch that was not felt leaves */
    world.shown_m = 0.3F;
    run(1.0F);
    world.felt_lie_mps2 = 0.0F;
    flown.thrust_n = 0.9F * HOVER_N; /* by it the vehicle comes down */
    calm_without_heights(5.0F);
    TEST_ASSERT_TRUE(seen.felt_mps < -0.4F);
    TEST_ASSERT_TRUE(seen.may_stand);
    run(1.0F);
    TEST_ASSERT_FALSE(seen.stands);
    flown.thrust_n = 0.6F * HOVER_N;
    run(2.5F);
    TEST_ASSERT_TRUE(seen.stands);
}

void test_a_still_vehicle_may_stand_until_it_feels_a_fall(void)
{
    fly();
    world.steady = true;
    flown.wanted_m = NAN;
    run(0.5F);
    TEST_ASSERT_FALSE(seen.may_stand);
    run(9.5F);
    TEST_ASSERT_TRUE(seen.may_stand);
    flown.thrust_n = 0.8F * HOVER_N;
    run(1.0F);
    TEST_ASSERT_FALSE(seen.may_stand);
    TEST_ASSERT_FALSE(seen.stands);
}

void test_it_does_not_stand_while_it_falls_or_sways(void)
{
    fly();
    world.steady = true;
    flown.wanted_m = NAN;
    flown.thrust_n = 0.5F * HOVER_N;
    run(3.0F);
    TEST_ASSERT_FALSE(seen.stands);
    setUp();
    fly();
    world.powerless = true;
    flown.wanted_m = NAN;
    flown.thrust_n = 0.5F * HOVER_N;
    run(3.0F);
    TEST_ASSERT_FALSE(seen.stands);
    TEST_ASSERT_TRUE(seen.sways);
}

/* Propellers off, or ropes that hold it: a take-off without a lift-off, then a landing. The accelerometer's
 * bias has become another since it was measured. */
void test_a_take_off_that_stands_for_a_minute_doubts_nothing(void)
{
    for (float bias_mps2 = -0.1F; bias_mps2 < 0.15F; bias_mps2 += 0.2F) {
        setUp();
        world.steady = world.powerless = true;
        flown.grounded = true;
        flown.off_ground = false;
        run(5.0F);
        flown.grounded = false;
        flown.standing = true;
        flown.thrust_n = 1.3F * HOVER_N;
        world.felt_lie_mps2 = bias_mps2;
        run(60.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
        flown.standing = false;
        flown.wanted_m = NAN;
        flown.thrust_n = 0.9F * HOVER_N;
        run(3.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
    }
}

/* ---- carried */

/* On the ground for the state, without heights; who has it swings it so fast. */
static void carry(float seconds, float swing_mps2, float sway_rad)
{
    for (int k = 0; k < (int)lroundf(seconds * 40.0F); k++) {
        frame.median.roll_rad = sway_rad * sinf((float)frame.sequence * 0.15F);
        frame.level = frame.median;
        frame.down_mps2 = 9.80665F + 0.3F + swing_mps2 * sinf((float)frame.sequence * 0.1F);
        sense_a_frame(NULL);
    }
}

void test_a_vehicle_that_sways_on_the_ground_without_heights_is_carried(void)
{
    flown.grounded = true;
    carry(5.0F, 0.0F, 0.0F);
    TEST_ASSERT_FALSE(seen.in_hands);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.3F, seen.bias_mps2);
    carry(0.25F, 10.0F, 0.05F); /* the lift does not spoil the bias that was measured at rest */
    carry(6.0F, 1.0F, 0.05F);
    TEST_ASSERT_TRUE(seen.in_hands);
    TEST_ASSERT_FLOAT_WITHIN(0.15F, 0.3F, seen.bias_mps2);
    TEST_ASSERT_FLOAT_WITHIN(0.4F, 0.0F, seen.felt_mps);
    TEST_ASSERT_EQUAL_UINT16(0U, seen.doubts);
    carry(8.0F, 0.0F, 0.0F);
    TEST_ASSERT_FALSE(seen.in_hands);
}

void test_who_tilts_it_by_hand_or_has_heights_does_not_carry_it(void)
{
    flown.grounded = true;
    carry(5.0F, 0.0F, 0.0F);
    carry(6.0F, 1.0F, 0.3F);
    TEST_ASSERT_FALSE(seen.in_hands);
    setUp();
    flown.grounded = true;
    for (int k = 0; k < 100; k++) {
        carry(0.1F, 1.0F, 0.05F);
        (void)passes(500.0F, (float)(k % 7), 9.0F);
        TEST_ASSERT_FALSE(seen.in_hands);
    }
}

static void stand_tilted(float seconds, float roll_rad)
{
    for (int k = 0; k < (int)lroundf(seconds * 40.0F); k++) {
        frame.median.roll_rad = roll_rad;
        frame.level = frame.median;
        sense_a_frame(NULL);
        TEST_ASSERT_FALSE(seen.in_hands);
    }
}

/* It stands without heights. */
void test_tilts_by_hand_nudges_and_wrong_frames_are_no_carried_vehicle(void)
{
    flown.grounded = true;
    carry(5.0F, 0.0F, 0.0F);
    for (int k = 0; k < 200; k++) { /* the signs of the IMU are tried */
        carry(0.1F, 0.0F, 0.3F);
        TEST_ASSERT_FALSE(seen.in_hands);
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
        frame.level.roll_rad = frame.median.roll_rad = degrees * DEGREE_RAD;
        sense_a_frame(NULL);
    }
}

void test_a_tilt_that_comes_in_one_jump_is_believed_after_six_frames(void)
{
    tilt(2.0F, 20);
    tilt(70.0F, 6);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 2.0F * DEGREE_RAD, in.roll_rad);
    TEST_ASSERT_EQUAL_UINT16(0U, in.tilted_frames);
    TEST_ASSERT_EQUAL_UINT16(0U, in.frame_count); /* it is not passed on */
    tilt(1.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 1.0F * DEGREE_RAD, in.roll_rad);
    tilt(70.0F, 9);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 70.0F * DEGREE_RAD, in.roll_rad);
    TEST_ASSERT_EQUAL_UINT16(3U, in.tilted_frames);
}

void test_a_tilt_that_grows_is_believed_at_once(void)
{
    for (int i = 0; i <= 10; i++) {
        tilt(10.0F * (float)i, 1); /* 400 degrees per second */
        TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 10.0F * (float)i * DEGREE_RAD, in.roll_rad);
    }
    TEST_ASSERT_EQUAL_UINT16(6U, in.tilted_frames);
}

void test_a_roll_whose_median_jumps_once_is_believed_at_its_second_frame(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        setUp();
        for (int i = 0; i <= 10; i++) { /* from the third on one frame ahead: a spike in the five */
            tilt((float)sign * 11.0F * (float)(i + (i > 2)), 1);
            TEST_ASSERT_EQUAL_UINT16(i == 3 ? 0U : 1U, in.frame_count);
        }
        TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, (float)sign * 121.0F * DEGREE_RAD, in.roll_rad);
    }
}

void test_bad_frames_that_jump_and_drift_are_no_roll(void)
{
    for (float drift = -5.0F; drift <= 20.0F; drift += 2.5F) {
        setUp();
        tilt(2.0F, 5);
        for (int i = 0; i < 6; i++) {
            tilt(60.0F + drift * (float)i, 1);
            TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 2.0F * DEGREE_RAD, in.roll_rad);
        }
        tilt(1.0F, 1);
        TEST_ASSERT_EQUAL_UINT16(0U, in.tilted_frames);
    }
}

void test_a_median_that_outlasts_its_frames_does_not_count_as_tilted(void)
{
    tilt(14.0F, 1);
    tilt(28.0F, 1);
    tilt(42.0F, 1);
    tilt(55.0F, 2);
    TEST_ASSERT_EQUAL_UINT16(2U, in.tilted_frames);
    frame.level.roll_rad = 0.0F;
    sense_a_frame(NULL);
    TEST_ASSERT_EQUAL_UINT16(2U, in.tilted_frames);
    tilt(42.0F, 1);
    TEST_ASSERT_EQUAL_UINT16(0U, in.tilted_frames);
}

void test_a_vehicle_that_has_rolled_over_is_tilted_before_its_median_says_so(void)
{
    tilt(2.0F, 5);
    frame.rolled = ATTITUDE_ROLLED_FRAMES - 1U;
    tilt(2.0F, 1);
    TEST_ASSERT_EQUAL_UINT16(0U, in.tilted_frames);
    frame.rolled = ATTITUDE_ROLLED_FRAMES;
    tilt(2.0F, 1);
    TEST_ASSERT_GREATER_THAN_UINT16(3U, in.tilted_frames);
}

void test_a_tilt_after_a_silence_or_through_the_half_turn_is_no_jump(void)
{
    tilt(2.0F, 5);
    frame.arrival_us += 300000U;
    tilt(70.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 70.0F * DEGREE_RAD, in.roll_rad);
    tilt(175.0F, 9);
    tilt(-175.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -175.0F * DEGREE_RAD, in.roll_rad);
}

static void sample(float roll_rad, float pitch_rad, uint32_t time_us)
{
    in = (flight_inputs_t){.roll_rad = roll_rad, .pitch_rad = pitch_rad, .attitude_time_us = time_us};
    seen = sense_step(&it, &flown, &in);
}

void test_one_sample_stands_for_the_frames_where_there_are_none(void)
{
    sample(0.1F, -0.2F, 1000U);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, in.roll_rad);
    TEST_ASSERT_EQUAL_FLOAT(-0.2F, in.pitch_rad);
    sample(NAN, 0.0F, 2000U);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, in.roll_rad);
    sample(1.0F, 0.0F, 2000U);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, in.roll_rad);
}

/* ---- what is passed on */

static void give_height(uint32_t sequence, float height_mm, uint32_t time_us)
{
    in = (flight_inputs_t){
        .height_valid = true,
        .height_sequence = sequence,
        .altitude = {.valid = true,
                     .height_mm = height_mm,
                     .slant_mm = 200.0F + height_mm,
                     .good_rays = 35U,
                     .spread_mm = 9.0F},
        .height_time_us = time_us,
        .height_age_us = 70000U,
    };
    seen = sense_step(&it, &flown, &in);
}

void test_a_new_scan_is_judged_once_and_its_height_compared(void)
{
    give_height(6U, 500.0F, 1000000U);
    TEST_ASSERT_TRUE(in.height_valid);
    const float rise_mps = seen.rise_mps;
    give_height(7U, 510.0F, 1100000U);
    TEST_ASSERT_TRUE(in.height_valid);
    TEST_ASSERT_EQUAL_FLOAT(0.51F, seen.height_m);
    const float then_mps = rise_mps + (0.1F - rise_mps) / 3.0F; /* 0.1 m/s through 0.1 of 0.3 s */
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, then_mps, seen.rise_mps);
    give_height(7U, 520.0F, 1100000U); /* the same scan again */
    TEST_ASSERT_EQUAL_FLOAT(0.51F, seen.height_m);
    give_height(8U, -60.0F, 1200000U);
    TEST_ASSERT_FALSE(in.height_valid);
    TEST_ASSERT_EQUAL_FLOAT(0.51F, seen.height_m);
    give_height(9U, 520.0F, 1300000U); /* 0.2 s after the one before */
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, then_mps + 0.5F * (0.05F - then_mps), seen.rise_mps);
}

void test_only_inputs_that_are_credible_are_passed_on(void)
{
    imu_sample_t frames[3];

    memset(frames, 0, sizeof frames);
    for (uint32_t i = 0U; i < 3U; i++) {
        frames[i] = (imu_sample_t){.sequence = 11U + i, .arrival_us = 1000000U + 25000U * i, .ready = true};
    }
    frames[1].level.roll_rad = frames[1].median.roll_rad = 1.0F; /* a jump */
    frames[2].level.roll_rad = frames[2].median.roll_rad = 1.0F;
    in = (flight_inputs_t){.height_valid = true, .height_sequence = 1U, .height_time_us = 1000000U};
    in.altitude = (altitude_t){
        .valid = true, .height_mm = 100.0F, .slant_mm = 700.0F, .good_rays = 35U, .spread_mm = 9.0F};
    in.altitude.leg_mm = 100.0F;
    in.frames = frames;
    in.frame_count = 3U;
    in.roll_rad = 1.0F;
    in.pitch_rad = 0.5F;
    in.tilted_frames = 9U;
    (void)sense_step(&it, &flown, &in);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, in.roll_rad); /* the accepted ones */
    TEST_ASSERT_EQUAL_FLOAT(0.0F, in.pitch_rad);
    TEST_ASSERT_EQUAL_UINT16(0U, in.tilted_frames);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 600.0F, in.altitude.height_mm);
    TEST_ASSERT_EQUAL_UINT16(0U, in.frame_count);
    TEST_ASSERT_TRUE(in.height_valid);
}

void test_heights_in_doubt_are_not_passed_on(void)
{
    lose_sight();
    TEST_ASSERT_FALSE(passes(300.0F, 0.0F, 0.0F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, seen.doubts);
}

void test_frames_after_a_rejected_one_are_passed_on(void)
{
    imu_sample_t frames[3];

    memset(frames, 0, sizeof frames);
    for (uint32_t i = 0U; i < 3U; i++) {
        frames[i] = (imu_sample_t){.sequence = 11U + i, .arrival_us = 1000000U + 25000U * i, .ready = true};
    }
    frames[1].median.roll_rad = 1.0F;
    in = (flight_inputs_t){.frames = frames, .frame_count = 3U};
    (void)sense_step(&it, &flown, &in);
    TEST_ASSERT_EQUAL_UINT16(1U, in.frame_count);
    TEST_ASSERT_EQUAL_UINT32(13U, in.frames[0].sequence);
}

/* ---- names */

void test_every_doubt_tells_its_reason(void)
{
    fly();
    TEST_ASSERT_EQUAL_UINT16(VERDICT_NONE, seen.reason);
    world.shown_m = 0.3F;
    flown.wanted_m = 0.5F;
    flown.thrust_n = HOVER_N + 1.5F;
    (void)until(DOUBT_SIGHT, 3.0F);
    TEST_ASSERT_EQUAL_STRING("SIGHT/blind", verdict_name(seen.reason));
    flown.ordered = flown.grounded = true;
    cycle();
    TEST_ASSERT_EQUAL_STRING("-", verdict_name(seen.reason));
}

void test_no_two_reasons_have_one_name(void)
{
    for (uint16_t a = 0U; a < VERDICT_COUNT; a++) {
        for (uint16_t b = (uint16_t)(a + 1U); b < VERDICT_COUNT; b++) {
            TEST_ASSERT_TRUE(strcmp(verdict_name(a), verdict_name(b)) != 0);
        }
    }
}
