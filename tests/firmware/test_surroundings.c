/* The line of what stands around: from the latest scan, once for each, and only when it is wanted. */
#include "firmware/surroundings.h"

#include <math.h>
#include <string.h>

#include "control/where/flight_state.h"
#include "drivers/scip_layout.h"
#include "firmware/geometry.h"
#include "kernel.h"
#include "mock_laser_port.h"
#include "mock_servers.h"
#include "unity.h"

static parameters_t parameters;
static flight_outputs_t flight;
static telemetry_line_t line;
static laser_message_t scanned;
static bool newer;

static void parameters_read(parameters_t *sample, int calls)
{
    (void)calls;
    *sample = parameters;
}

static imu_sample_t frames[IMU_HISTORY];
static uint16_t frame_count;

static uint16_t imu_read(imu_sample_t history[IMU_HISTORY], int calls)
{
    (void)calls;
    (void)memcpy(history, frames, frame_count * sizeof frames[0]);
    return frame_count;
}

/* Frames every 25 ms up to 50 ms after the scan's arrival; in those from so long before it on the nose is
 * down by 12 degrees. */
static void lean(uint32_t from_before_us, uint32_t to_before_us)
{
    frame_count = IMU_HISTORY;
    for (uint16_t i = 0U; i < IMU_HISTORY; ++i) {
        const uint32_t before_us = 25000U * (uint32_t)(IMU_HISTORY - 1U - i);

        frames[i] = (imu_sample_t){.arrival_us = scanned.arrival_us - before_us};
        frames[i].level.pitch_rad = (before_us <= from_before_us && before_us >= to_before_us) ? -0.21F
                                                                                               : 0.0F;
    }
}

static bool newer_scan(laser_message_t *message, int calls)
{
    (void)calls;
    if (newer) {
        *message = scanned;
        message->scan.distance_mm = message->distance_mm;
    }
    return newer;
}

/* A wall 1.5 m off in every direction, seen by the rays between three mirrors. */
void setUp(void)
{
    kernel_reset();
    parameters_init(&parameters);
    parameters.value[PARAMETER_WALLS] = (float)WALLS_ON;
    frame_count = 0U;
    (void)memset(&flight, 0, sizeof flight);
    flight.height_mm = 600.0F;
    scanned.scan = (scip_scan_t){.first_step = 111U, .cluster = 4U, .points = 136U, .characters = 2U};
    for (uint16_t i = 0U; i < SCIP_LAYOUT_POINTS_MAX; ++i) {
        scanned.distance_mm[i] = 1500U;
    }
    scanned.arrival_us += 5000000U; /* the walls of the test before are forgotten */
    scanned.bit_rate = 250000U;
    flight.state = FLIGHT_FLYING;
    newer = true;
    parameter_server_read_Stub(parameters_read);
    imu_server_history_Stub(imu_read);
    laser_port_newer_Stub(newer_scan);
    geometry_mount(&parameters);
}

void tearDown(void)
{
    kernel_check();
}

static void assert_line(const char *expected)
{
    TEST_ASSERT_TRUE(surroundings_line(&line, &flight));
    TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, strlen(expected));
    TEST_ASSERT_EQUAL_size_t(strlen(expected) + 2U, line.length);
}

void test_between_three_mirrors_29_sectors_are_seen(void)
{
    assert_line("w:-2jjjjjjjjjjjjjj-3jjjjjjjjjjjjjjj-c");
}

void test_with_walls_off_no_line_comes_and_the_scan_is_left_alone(void)
{
    parameters.value[PARAMETER_WALLS] = (float)WALLS_OFF;
    laser_port_newer_Stub(NULL);
    TEST_ASSERT_FALSE(surroundings_line(&line, &flight));
}

void test_a_scan_is_told_once(void)
{
    newer = false;
    TEST_ASSERT_FALSE(surroundings_line(&line, &flight));
}

void test_a_ray_that_one_scan_alone_tells_is_not_told(void)
{
    for (uint16_t i = 0U; i < SCIP_LAYOUT_POINTS_MAX; ++i) {
        scanned.distance_mm[i] = (i == 20U) ? 300U : 0U;
    }
    assert_line("w:-2..............-3...............-c");
    assert_line("w:-2..............-3............I..-c");
}

void test_leaning_forward_it_does_not_tell_the_floor(void)
{
    for (uint16_t i = 0U; i < SCIP_LAYOUT_POINTS_MAX; ++i) {
        scanned.distance_mm[i] = 3400U;
    }
    lean(400000U, 0U);
    TEST_ASSERT_TRUE(surroundings_line(&line, &flight));
    TEST_ASSERT_EQUAL_STRING_LEN("w:-2....", line.text, 8U);
    TEST_ASSERT_NULL(memchr(&line.text[20], '.', 15U)); /* behind it sees further */
}

/* They are 79 ms older than the scan's last octet. */
void test_the_tilt_is_that_of_the_instant_of_the_rays(void)
{
    for (uint16_t i = 0U; i < SCIP_LAYOUT_POINTS_MAX; ++i) {
        scanned.distance_mm[i] = 3400U;
    }
    lean(50000U, 0U);
    TEST_ASSERT_TRUE(surroundings_line(&line, &flight));
    TEST_ASSERT_NULL(memchr(line.text, '.', line.length));
    lean(100000U, 60000U);
    TEST_ASSERT_TRUE(surroundings_line(&line, &flight));
    TEST_ASSERT_EQUAL_STRING_LEN("w:-2....", line.text, 8U);
}

/* The gear on the floor, or a height that nobody believes. */
void test_without_a_height_a_far_thing_may_be_the_floor(void)
{
    for (uint16_t i = 0U; i < SCIP_LAYOUT_POINTS_MAX; ++i) {
        scanned.distance_mm[i] = 3000U;
    }
    assert_line("w:-2uuuuuuuuuuuuuu-3uuuuuuuuuuuuuuu-c");
    flight.flags = FLIGHT_FLAG_HEIGHT;
    assert_line("w:-2..............-3...............-c");
}

/* A wall to the right that comes by so much with each of `lines` lines, 0.2 s apart. Returns how many warned.
 */
static int fly_right(float mmps, int count)
{
    int warned = 0;
    float mm = 1600.0F;

    for (int k = 0; k < count && mm > 500.0F; ++k) {
        for (uint16_t i = 0U; i < SCIP_LAYOUT_POINTS_MAX; ++i) {
            const float off_rad = (112.5F + 4.0F * (float)i - 384.0F) * 0.0061359F;
            const float ray_mm = mm / cosf(off_rad);

            scanned.distance_mm[i] = (fabsf(off_rad) < 1.1F) ? (uint16_t)ray_mm : 0U;
        }
        scanned.arrival_us += 200000U;
        TEST_ASSERT_TRUE(surroundings_line(&line, &flight));
        warned += surroundings_warn() ? 1 : 0;
        mm -= 0.2F * mmps;
    }
    return warned;
}

static bool has(const char *text)
{
    line.text[line.length] = '\0';
    return strstr(line.text, text) != NULL;
}

void test_a_wall_that_comes_too_fast_is_told_in_the_line(void)
{
    TEST_ASSERT_GREATER_THAN_INT(0, fly_right(500.0F, 100));
    TEST_ASSERT_TRUE(has(" near:90,"));
    newer = false;
    TEST_ASSERT_FALSE(surroundings_line(&line, &flight));
    TEST_ASSERT_FALSE(surroundings_warn()); /* not of an older scan */
    TEST_ASSERT_FALSE(surroundings_drift(&line));
}

void test_a_wall_that_stays_is_not_told_and_its_speed_is_0(void)
{
    TEST_ASSERT_EQUAL_INT(0, fly_right(0.0F, 30));
    TEST_ASSERT_FALSE(has("near"));
    TEST_ASSERT_TRUE(surroundings_drift(&line));
    TEST_ASSERT_TRUE(has("drift:90,17")); /* 160 cm from the scanner, 11.5 more from the centre */
    TEST_ASSERT_TRUE(has(",0,"));
}

void test_on_the_ground_nothing_comes_near_in_the_direction_of_flight(void)
{
    flight.state = FLIGHT_GROUND;
    TEST_ASSERT_EQUAL_INT(0, fly_right(500.0F, 100));
}

void test_after_a_second_without_a_scan_the_walls_are_others(void)
{
    (void)fly_right(0.0F, 10);
    scanned.arrival_us += 900000U;
    (void)fly_right(0.0F, 1);
    TEST_ASSERT_TRUE(surroundings_drift(&line));
    TEST_ASSERT_TRUE(has("drift:-"));
}
