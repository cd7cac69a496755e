/* A sensor of one ray at 100 Hz (as a TFmini, in millimetres): its groups, and flights by them. SYNTHETIC:
 * white noise of 5 mm, 10 ms late; the vehicle is that of noisy_plant.h. */
#include "readings.h"
#include "control/thrust.h"
#include "noisy_plant.h"
#include "unity.h"

#include <stdio.h>

static readings_t readings;
static mirror_range_t group;
static uint32_t rays_us;

static noisy_t world;
static flight_t flight;
static parameters_t parameters;
static flight_inputs_t in;
static flight_outputs_t out;
static double blocked_mm, highest_m;
static bool grouped, frozen;
static float digits_mm;

void setUp(void)
{
    memset(&readings, 0, sizeof readings);
}

void tearDown(void) {}

/* ---- groups */

static int groups_of(const float *slant_mm, int count, uint32_t from_us, uint32_t step_us)
{
    int groups = 0;

    for (int i = 0; i < count; i++) {
        groups += readings_take(&readings, slant_mm[i], from_us + step_us * (uint32_t)i, MIRROR_AFT, &group,
                                &rays_us);
    }
    return groups;
}

void test_a_group_is_a_tenth_of_a_second_with_mean_spread_and_the_instant_of_the_mean(void)
{
    static const float slant_mm[] = {700.0F, 702.0F, 704.0F, 706.0F, 708.0F, 710.0F,
                                     712.0F, 714.0F, 716.0F, 718.0F, 999.0F};

    TEST_ASSERT_EQUAL_INT(1, groups_of(slant_mm, 11, UINT32_C(4294950000), 10000U)); /* wraps */
    TEST_ASSERT_TRUE(group.valid && group.mirror == MIRROR_AFT);
    TEST_ASSERT_EQUAL_UINT16(10U, group.good_rays);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 709.0F, group.slant_mm);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 18.0F, group.spread_mm);
    TEST_ASSERT_EQUAL_UINT32(UINT32_C(4294950000) + 45000U, rays_us);
}

void test_what_a_sensor_does_not_see_is_left_out_of_mean_and_instant(void)
{
    static const float slant_mm[] = {NAN, 700.0F, NAN, 710.0F, NAN, NAN, NAN, NAN, INFINITY, NAN, 999.0F};

    TEST_ASSERT_EQUAL_INT(1, groups_of(slant_mm, 11, 5U, 10000U));
    TEST_ASSERT_EQUAL_UINT16(2U, group.good_rays);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 705.0F, group.slant_mm);
    TEST_ASSERT_EQUAL_UINT32(5U + 20000U, rays_us);
}

void test_a_group_of_one_or_no_reading_is_not_valid(void)
{
    for (int good = 0; good < 2; good++) {
        float slant_mm[11] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, 999.0F};

        slant_mm[3] = (good != 0) ? 700.0F : NAN;
        setUp();
        TEST_ASSERT_EQUAL_INT(1, groups_of(slant_mm, 11, 0U, 10000U));
        TEST_ASSERT_FALSE(group.valid);
        TEST_ASSERT_EQUAL_UINT16(0U, group.good_rays);
    }
}

void test_readings_before_a_gap_are_a_group_of_their_own(void)
{
    static const float before_mm[] = {700.0F, 702.0F}, after_mm[] = {900.0F};

    TEST_ASSERT_EQUAL_INT(0, groups_of(before_mm, 2, 0U, 10000U));
    TEST_ASSERT_EQUAL_INT(1, groups_of(after_mm, 1, 5000000U, 0U));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 701.0F, group.slant_mm);
    TEST_ASSERT_EQUAL_UINT32(5000U, rays_us);
}

void test_a_sensor_of_any_rate_has_groups_of_the_same_duration(void)
{
    for (uint32_t step_us = 1000U; step_us <= 50000U; step_us += 1000U) {
        int groups = 0;

        setUp();
        for (uint32_t t = 0U; t <= 10000000U; t += step_us) {
            groups += readings_take(&readings, 700.0F, t, MIRROR_FRONT, &group, &rays_us);
        }
        const uint32_t group_us = (100000U + step_us - 1U) / step_us * step_us;

        TEST_ASSERT_EQUAL_INT(10000000U / group_us, groups);
    }
}

/* ---- flights */

static void tell(const mirror_range_t *range, uint32_t taken_us)
{
    const altitude_geometry_t geometry = altitude_geometry_default();

    in.altitude = altitude_from_ranges(&geometry, range, 1, in.roll_rad, 0.0F);
    in.height_valid = in.altitude.valid;
    if (in.height_valid) {
        in.height_time_us = in.now_us;
        in.height_age_us = in.now_us - taken_us;
        in.height_stamp_ms = in.now_us / 1000U & 0xFFFFFFU;
        in.height_sequence++;
    }
}

static float seen_mm(void)
{
    const double roll = noisy_roll(&world, 10000U);
    const double true_mm = 105.0 + ((world.body.height_m - world.body.terrain_m) * 1000.0 + 100.0 +
                                    220.0 * sin(roll)) /
                                       cos(roll);
    const double slant_mm = (blocked_mm > 0.0 ? blocked_mm : true_mm) +
                            (frozen ? 0.0 : 5.0 * noisy_gauss(&world));

    return digits_mm * roundf((float)slant_mm / digits_mm);
}

static void read_once(void)
{
    const uint32_t taken_us = in.now_us - 10000U;
    mirror_range_t one = {.mirror = MIRROR_FRONT, .valid = true, .slant_mm = seen_mm(), .good_rays = 1U};
    uint32_t mean_us = taken_us;

    if (!grouped) {
        tell(&one, taken_us);
    } else if (readings_take(&readings, one.slant_mm, taken_us, MIRROR_FRONT, &one, &mean_us)) {
        tell(&one, mean_us);
        world.released = true;
    }
}

static void advance(void)
{
    flight_inputs_t scans = in; /* those of the scanner are thrown away */

    noisy_step(&world, &scans, 0U);
    in.frames = scans.frames;
    in.frame_count = scans.frame_count;
    in.now_us = scans.now_us;
    in.attitude_time_us = scans.attitude_time_us;
    in.roll_rad = scans.roll_rad;
    if (world.body.time_us % 10000U == 0U) {
        read_once();
    }
    if (world.released) {
        flight_step(&flight, &parameters, &in, &out);
        world.body.command_n = (double)thrust_from_pulse_us(out.pulse_us);
    }
    highest_m = fmax(highest_m, world.body.height_m);
}

static void run(double seconds)
{
    for (long i = lround(seconds * 2000.0); i > 0; i--) {
        advance();
    }
}

static void take_off(uint32_t seed)
{
    world = noisy_on_ground(seed);
    flight_init(&flight);
    parameters_init(&parameters);
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, PARAMETER_LAW, LAW_EST));
    memset(&in, 0, sizeof in);
    memset(&out, 0, sizeof out);
    memset(&readings, 0, sizeof readings);
    in.attitude_ready = in.has_throttle = true;
    blocked_mm = highest_m = 0.0;
    frozen = false;
    run(3.0);
    in.reference_m = 0.6F;
    in.reference_sequence++;
    run(7.0);
}

static void a_good_sensor(void)
{
    grouped = true;
    digits_mm = 1.0F;
}

void test_it_hovers_by_a_sensor_of_one_ray_and_doubts_nothing(void)
{
    a_good_sensor();
    for (uint32_t seed = 1U; seed <= 20U; seed++) {
        double square = 0.0;

        take_off(seed);
        TEST_ASSERT_EQUAL_STRING("FLYING", flight_state_name(out.state));
        for (int i = 0; i < 30 * 2000; i++) {
            advance();
            square += pow(world.body.height_m - 0.6, 2.0);
            TEST_ASSERT_EQUAL_UINT16(0U,
                                     out.flags & (FLIGHT_FLAG_SIGHT | FLIGHT_FLAG_IMU | FLIGHT_FLAG_THRUST));
        }
        TEST_ASSERT_TRUE(sqrt(square / (30.0 * 2000.0)) < 0.03);
    }
}

void test_a_blocked_beam_of_one_ray_is_doubted_and_it_comes_down(void)
{
    uint32_t let_down = 0U;

    a_good_sensor();
    for (uint32_t seed = 1U; seed <= 20U; seed++) {
        bool doubted = false;

        take_off(seed);
        blocked_mm = 205.0 +
                     45.0 * (double)seed; /* 40 to 1000 mm of height, on both sides of the reference */
        for (int i = 0; i < 60 * 2000 && out.state != FLIGHT_GROUND; i++) {
            advance();
            doubted = doubted || (out.flags & FLIGHT_FLAG_SIGHT) != 0U;
        }
        printf("blocked at %.0f mm: doubted %d, highest %.2f m, %s\n", blocked_mm, doubted, highest_m,
               flight_state_name(out.state));
        /* A beam that shows more than the reference sets it down. There nothing tells that it stands. */
        TEST_ASSERT_TRUE(doubted || world.body.height_m < 0.001);
        TEST_ASSERT_TRUE(out.state == FLIGHT_GROUND || world.body.height_m < 0.001);
        TEST_ASSERT_TRUE(highest_m < 0.6 + 1.2); /* tools/campaign/harm.py: beyond it is harmed */
        let_down += out.state == FLIGHT_GROUND ? 1U : 0U;
    }
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(17U, let_down);
}

void test_a_frozen_sensor_of_one_ray_is_a_copy(void)
{
    a_good_sensor();
    take_off(3U);
    blocked_mm = 800.0;
    frozen = true;
    run(1.0);
    TEST_ASSERT_EQUAL_STRING("COASTING", flight_state_name(out.state));
}

void test_readings_that_are_not_grouped_and_digits_coarser_than_the_noise_do_not_take_off(void)
{
    for (int coarse = 0; coarse < 2; coarse++) {
        grouped = coarse != 0;
        digits_mm = (coarse != 0) ? 50.0F : 1.0F;
        take_off(4U);
        TEST_ASSERT_EQUAL_STRING("GROUND", flight_state_name(out.state));
        TEST_ASSERT_TRUE((out.flags & FLIGHT_FLAG_HEIGHT) != 0U);
    }
}
