/* From recorded octets of scanner and IMU to height and thrust, by drivers/ and control/ as the tasks join
 * them; what must come out is computed by tests/fixtures/flight/pin.py, which shares no code with them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control/altitude.h"
#include "control/attitude.h"
#include "control/imu_mapping.h"
#include "control/laws/pid.h"
#include "drivers/razor.h"
#include "drivers/scip_layout.h"
#include "drivers/scip_parser.h"
#include "unity.h"

#define DEGREE 0.017453292F
#define REFERENCE_MM 600.0F
#define POINTS_MAX 700U

static razor_collector_t imu;
static attitude_filter_t filter;
static attitude_t tilt; /* of the vehicle */
static scip_parser_t laser;
static uint16_t distance_mm[POINTS_MAX];
static scip_scan_t scan;
static parameters_t parameters;
static pid_gains_t gains;
static pid_state_t law;
static FILE *expected;
static unsigned rows;

void setUp(void)
{
    razor_collector_init(&imu);
    attitude_init(&filter);
    scip_parser_init(&laser);
    scan = (scip_scan_t){.distance_mm = distance_mm, .capacity = POINTS_MAX};
    scip_parser_scan_into(&laser, &scan);
    parameters_init(&parameters);
    gains = (pid_gains_t){
        .kp_n_per_mm = parameters.value[PARAMETER_KP],
        .kd_n_per_mm = parameters.value[PARAMETER_KD],
        .ki_n_per_mm = parameters.value[PARAMETER_KI],
        .gravity_n = parameters.value[PARAMETER_GRAV],
        .ascension_n = parameters.value[PARAMETER_USAT],
        .descension_n = parameters.value[PARAMETER_DSAT],
    };
    pid_reset(&law);
    tilt = (attitude_t){.roll_rad = 0.0F};
    expected = NULL;
    rows = 0U;
}

void tearDown(void)
{
    if (expected != NULL) {
        fclose(expected);
    }
}

static FILE *open_fixture(const char *name)
{
    char path[512];
    FILE *file;

    snprintf(path, sizeof path, FIXTURES "/%s", name);
    file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    return file;
}

static void expect_scans(uint16_t first, uint16_t last, uint16_t scans)
{
    const scip_range_t range = {first, last, 1U, 0U, scans};
    scip_request_t request;

    TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_STREAM_2, &range));
    scip_parser_expect(&laser, &request);
}

/* The next line of expected.csv against what the product makes of the scan. */
static void compare_scan(void)
{
    const scip_group_t *const front = &scip_layouts[SCIP_LAYOUT_FRONT].groups[0];
    const scip_group_mean_t mean = scip_group_mean(&scan, front);
    const scip_group_steps_t steps = scip_group_steps(&scan, front, &mean);
    const mirror_range_t range = {.mirror = MIRROR_FRONT,
                                  .valid = mean.valid,
                                  .slant_mm = mean.mean_mm,
                                  .spread_mm = mean.spread_mm,
                                  .good_rays = mean.good_rays,
                                  .aside_steps = steps.mean - SCANNER_RIGHT_STEP,
                                  .wide_steps2 = steps.variance};
    const altitude_geometry_t geometry = altitude_geometry_of(&parameters);
    const altitude_t altitude = altitude_from_ranges(&geometry, &range, 1, tilt.roll_rad, tilt.pitch_rad);
    unsigned long stamp_ms;
    float mean_mm, roll_deg, pitch_deg, height_mm, thrust_n;

    TEST_ASSERT_EQUAL_INT(6, fscanf(expected, "%lu,%f,%f,%f,%f,%f\n", &stamp_ms, &mean_mm, &roll_deg,
                                    &pitch_deg, &height_mm, &thrust_n));
    rows++;
    TEST_ASSERT_EQUAL_UINT32(stamp_ms, scan.timestamp_ms);
    TEST_ASSERT_TRUE(altitude.valid);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, mean_mm, mean.mean_mm);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, roll_deg, tilt.roll_rad / DEGREE);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, pitch_deg, tilt.pitch_rad / DEGREE);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, height_mm, altitude.height_mm);
    TEST_ASSERT_FLOAT_WITHIN(0.0005F, thrust_n, pid_step(&law, &gains, REFERENCE_MM - altitude.height_mm));
}

static void take_frame(void)
{
    const imu_mapping_t mapping = imu_mapping_of(&parameters);
    razor_frame_t frame;
    attitude_t level, median;

    TEST_ASSERT_EQUAL(RAZOR_OK, razor_parse(&imu.gathered, &frame));
    (void)attitude_step(
        &filter,
        &(attitude_t){.roll_rad = frame.roll_rad, .pitch_rad = frame.pitch_rad, .yaw_rad = frame.yaw_rad},
        &level, &median);
    tilt = imu_map_angles(&mapping, &median);
}

static void take_octet(bool is_imu, octet_t octet)
{
    if (is_imu && razor_collect(&imu, octet)) {
        take_frame();
    }
    if (!is_imu && scip_parser_feed(&laser, octet) == SCIP_SCAN) {
        compare_scan();
    }
}

void test_height_and_thrust_of_a_recorded_flight_are_those_of_the_independent_computation(void)
{
    static char wire[8], hex[20000];
    FILE *recording = open_fixture("flight/octets.txt");

    expected = open_fixture("flight/expected.csv");
    expect_scans(372U, 406U, 0U);
    while (fscanf(recording, "octets %7s %*s %*s %19999s\n", wire, hex) == 2) {
        for (const char *at = hex; *at != '\0'; at += 2) {
            const char digits[3] = {at[0], at[1], '\0'};

            take_octet(wire[0] == 'i', (octet_t)strtoul(digits, NULL, 16));
        }
    }
    TEST_ASSERT_NOT_EQUAL(0, feof(recording));
    fclose(recording);
    TEST_ASSERT_EQUAL_INT(EOF, fgetc(expected));
    TEST_ASSERT_EQUAL_UINT(57, rows);
    TEST_ASSERT_EQUAL_UINT32(0, imu.cut + imu.overlong);
}

void test_a_real_scan_gives_the_height_of_the_independent_computation_at_any_tilt(void)
{
    static const float tilts_deg[][2] = {{0.0F, 0.0F}, {5.0F, -3.0F}, {-8.0F, 6.5F}};

    expected = open_fixture("flight/expected_real.csv");
    for (size_t i = 0; i < 3; i++) {
        FILE *octets = open_fixture("scip/real_ms_0044_0725.bin");

        pid_reset(&law);
        tilt = (attitude_t){.roll_rad = tilts_deg[i][0] * DEGREE, .pitch_rad = tilts_deg[i][1] * DEGREE};
        expect_scans(44U, 725U, 10U);
        for (int octet = fgetc(octets); octet != EOF; octet = fgetc(octets)) {
            take_octet(false, (octet_t)octet);
        }
        fclose(octets);
    }
    TEST_ASSERT_EQUAL_UINT(3, rows);
    TEST_ASSERT_EQUAL_INT(EOF, fgetc(expected));
}
