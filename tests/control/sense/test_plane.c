/* Three heights above a plane, and an IMU that tells the truth or something else of it. */
#include "control/sense/plane.h"

#include <math.h>

#include "unity.h"

#define DEG 0.017453293F
#define FRAMES 16
#define SCAN_US 100000U
#define FRAME_US 25000U
#define RAYS_US 75000U   /* from the rays of the front mirror to the scan's arrival */
#define MEDIAN_US 73600U /* from an instant to the arrival of its median */
#define LONG_SCANS 600U

typedef struct {
    float arm_mm, fore_mm, distance_mm, leg_mm;
    int32_t later_us;
} place_t;

static const place_t places[MIRROR_COUNT] = {[MIRROR_FRONT] = {220.0F, 0.0F, 105.0F, 100.0F, 0},
                                             [MIRROR_FORE] = {115.0F, 107.0F, 107.0F, 105.0F, 25000},
                                             [MIRROR_AFT] = {115.0F, -115.0F, 115.0F, 98.0F, -25000}};

/* What the world is like. */
static struct {
    float sway_deg[2];             /* amplitudes of roll and pitch */
    float noise_mm;                /* of each mirror, its own */
    float length_mm[MIRROR_COUNT]; /* that its mirror is told wrong by */
    float slope_rad[2];            /* of the ground under the vehicle */
    float rough_mm;                /* of the ground under each mirror */
    float height_mm, climb_mm_s;
    bool rest;
} world;
/* And what the IMU tells of it. */
static struct {
    float sign[2], off_deg[2];
    bool swapped;
} imu;

static plane_t plane;
static zeros_t zeros;
static imu_sample_t frames[FRAMES];
static altitude_t shown[MIRROR_COUNT];
static plane_scan_t scan;
static uint32_t now_us, random_state;

void setUp(void)
{
    plane = (plane_t){.axes = 0U};
    zeros = (zeros_t){.wrong = 0U};
    world.sway_deg[0] = 2.0F;
    world.sway_deg[1] = 2.0F;
    world.noise_mm = 3.0F;
    world.rough_mm = 0.0F;
    world.height_mm = 600.0F;
    world.climb_mm_s = 0.0F;
    world.rest = false;
    for (int m = 0; m < MIRROR_COUNT; m++) {
        world.length_mm[m] = 0.0F;
    }
    for (int a = 0; a < 2; a++) {
        world.slope_rad[a] = 0.0F;
        imu.sign[a] = 1.0F;
        imu.off_deg[a] = 0.0F;
    }
    imu.swapped = false;
    scan = (plane_scan_t){.shown = shown,
                          .frames = frames,
                          .frame_count = FRAMES,
                          .gap_s = 0.1F,
                          .honest = true,
                          .zeros = &zeros,
                          .axes = 7U};
    now_us = 0xFFF00000U; /* the clock wraps */
    random_state = 1U;
}

void tearDown(void) {}

static float noise(void)
{
    float sum = 0.0F;
    for (int i = 0; i < 12; i++) {
        random_state = random_state * 1664525U + 1013904223U;
        sum += (float)(random_state >> 8) / 16777216.0F - 0.5F;
    }
    return sum;
}

/* Two sways that do not go together; on the ground there is none. */
static void true_tilt(uint32_t at_us, float tilt_rad[2])
{
    const float t = (float)(at_us - 0xFFF00000U) * 1.0e-6F;

    tilt_rad[0] = world.rest ? 0.0F : world.sway_deg[0] * DEG * sinf(4.4F * t);
    tilt_rad[1] = world.rest ? 0.0F : world.sway_deg[1] * DEG * sinf(3.1F * t + 1.0F);
}

static void tell_frames(void)
{
    for (uint32_t i = 0; i < FRAMES; i++) {
        const uint32_t arrival_us = now_us - (FRAMES - 1U - i) * FRAME_US;
        float tilt[2];

        true_tilt(arrival_us - MEDIAN_US, tilt);
        const float roll = imu.sign[0] * tilt[imu.swapped ? 1 : 0] + imu.off_deg[0] * DEG + 0.002F * noise();
        const float pitch = imu.sign[1] * tilt[imu.swapped ? 0 : 1] + imu.off_deg[1] * DEG + 0.002F * noise();
        frames[i] = (imu_sample_t){.ready = true, .arrival_us = arrival_us};
        frames[i].median.roll_rad = roll;
        frames[i].median.pitch_rad = pitch;
    }
}

/* By geometry, independently of the product: the ground's plane under a tilted vehicle. */
static void show_mirror(int m)
{
    const place_t *place = &places[m];
    const float late_s = (float)place->later_us * 1.0e-6F;
    float tilt[2];

    true_tilt(scan.rays_us + (uint32_t)place->later_us, tilt);
    const float roll = tilt[0] - world.slope_rad[0], pitch = tilt[1] - world.slope_rad[1];
    const float height = world.rest ? 0.0F : world.height_mm + world.climb_mm_s * late_s;
    const float down = height + place->arm_mm * sinf(roll) + place->fore_mm * sinf(pitch);
    shown[m] = (altitude_t){.valid = true,
                            .slant_mm = place->distance_mm + place->leg_mm +
                                        down / (cosf(roll) * cosf(pitch)) + world.length_mm[m] +
                                        world.noise_mm * noise() + world.rough_mm * noise(),
                            .height_mm = height,
                            .distance_mm = place->distance_mm,
                            .leg_mm = place->leg_mm,
                            .arm_mm = place->arm_mm,
                            .fore_mm = place->fore_mm,
                            .later_us = place->later_us};
}

static void fly(unsigned scans)
{
    for (unsigned i = 0; i < scans; i++) {
        now_us += SCAN_US;
        scan.rays_us = now_us - RAYS_US;
        scan.rest = world.rest;
        tell_frames();
        for (int m = 0; m < MIRROR_COUNT; m++) {
            show_mirror(m);
        }
        zeros_scan(&zeros, shown, world.rest ? ZEROS_REST : ZEROS_AWAY);
        plane_scan(&plane, &scan);
        world.height_mm += world.rest ? 0.0F : world.climb_mm_s * 0.1F;
    }
}

static void stand(unsigned scans)
{
    world.rest = true;
    fly(scans);
    world.rest = false;
}

/* Scans in the air until this is named; LONG_SCANS: never. */
static unsigned named_after(imu_fault_t fault)
{
    unsigned scans = 0;
    while (scans < LONG_SCANS && plane_fault(&plane) != fault) {
        fly(1);
        scans++;
    }
    return scans;
}

/* ---- signs and axes */

TEST_CASE(-1.0, 1.0, 0, IMU_ROLL)
TEST_CASE(1.0, -1.0, 0, IMU_PITCH)
TEST_CASE(-1.0, -1.0, 0, IMU_BOTH)
TEST_CASE(1.0, 1.0, 1, IMU_SWAPPED)
TEST_CASE(-1.0, 1.0, 1, IMU_SWAPPED)
TEST_CASE(1.0, -1.0, 1, IMU_SWAPPED)
TEST_CASE(-1.0, -1.0, 1, IMU_SWAPPED)
void test_each_wrong_mounting_is_named_within_five_seconds_of_sway(double roll, double pitch, int swapped,
                                                                   int fault)
{
    imu.sign[0] = (float)roll;
    imu.sign[1] = (float)pitch;
    imu.swapped = swapped != 0;
    TEST_ASSERT_LESS_THAN_UINT(50, named_after((imu_fault_t)fault));
    fly(100);
    TEST_ASSERT_EQUAL(fault, plane_fault(&plane));
}

void test_a_sound_imu_is_never_named(void)
{
    for (uint32_t seed = 1; seed <= 20; seed++) {
        setUp();
        random_state = seed;
        stand(20);
        fly(LONG_SCANS);
        TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
    }
}

void test_uneven_ground_of_any_size_proves_nothing(void)
{
    static const float rough_mm[] = {3.0F, 6.0F, 12.0F, 25.0F, 60.0F, 200.0F};
    for (uint32_t i = 0; i < 30; i++) {
        setUp();
        random_state = 100 + i;
        world.rough_mm = rough_mm[i % 6];
        stand(20);
        fly(LONG_SCANS);
        TEST_ASSERT_EQUAL(IMU_SOUND, plane.mounting);
    }
}

void test_a_vehicle_that_does_not_sway_tells_nothing(void)
{
    imu.sign[0] = -1.0F;
    world.sway_deg[0] = 0.05F;
    world.sway_deg[1] = 0.05F;
    fly(LONG_SCANS);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
}

/* It shows what a wrong sign of roll shows, where the height is held. */
void test_scans_in_which_a_mirror_lies_count_for_nothing(void)
{
    imu.sign[0] = -1.0F;
    scan.honest = false;
    fly(LONG_SCANS);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
}

void test_a_climb_while_the_mirrors_are_scanned_is_no_tilt(void)
{
    world.noise_mm = 0.5F;
    world.climb_mm_s = 700.0F;
    world.height_mm = 0.0F;
    fly(40);
    TEST_ASSERT_FLOAT_WITHIN(1.0F, 0.0F, plane.records[PLANE_FORE_AFT].mean_mm[0]);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
}

void test_an_edge_is_forgotten_and_the_mounting_named_all_the_same(void)
{
    imu.sign[1] = -1.0F;
    world.length_mm[MIRROR_FORE] = 250.0F;
    fly(3);
    world.length_mm[MIRROR_FORE] = 0.0F;
    TEST_ASSERT_LESS_THAN_UINT(50, named_after(IMU_PITCH));
}

void test_other_axes_begin_anew(void)
{
    imu.sign[0] = -1.0F;
    TEST_ASSERT_LESS_THAN_UINT(LONG_SCANS, named_after(IMU_ROLL));
    imu.sign[0] = 1.0F;
    scan.axes = 8U;
    fly(1);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
    fly(LONG_SCANS);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
}

void test_without_frames_or_a_mirror_or_after_a_gap_nothing_is_judged(void)
{
    imu.sign[0] = -1.0F;
    scan.frame_count = 0U;
    fly(200);
    scan.frame_count = FRAMES;
    scan.gap_s = 0.5F;
    fly(200);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
}

/* ---- the offset */

TEST_CASE(0.0, 3.0)
TEST_CASE(0.0, -3.0)
TEST_CASE(4.0, 0.0)
TEST_CASE(-4.0, 0.0)
void test_an_offset_is_named_at_rest(double roll_deg, double pitch_deg)
{
    imu.off_deg[0] = (float)roll_deg;
    imu.off_deg[1] = (float)pitch_deg;
    stand(60);
    TEST_ASSERT_EQUAL(IMU_OFFSET, plane_fault(&plane));
    TEST_ASSERT_FLOAT_WITHIN(0.7F, (float)roll_deg, plane.off_rad[0] / DEG);
    TEST_ASSERT_FLOAT_WITHIN(0.5F, (float)pitch_deg, plane.off_rad[1] / DEG);
}

void test_an_offset_that_comes_with_the_take_off_is_named_above_the_same_ground(void)
{
    stand(40);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
    imu.off_deg[1] = 3.0F;
    TEST_ASSERT_LESS_THAN_UINT(40, named_after(IMU_OFFSET));
    fly(200);
    TEST_ASSERT_EQUAL(IMU_OFFSET, plane_fault(&plane));
    imu.off_deg[1] = 0.0F;
    stand(60);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
}

/* Half a degree is a slope or a trim. */
void test_half_a_degree_is_not_named(void)
{
    for (uint32_t seed = 1; seed <= 20; seed++) {
        setUp();
        random_state = seed;
        imu.off_deg[0] = 0.5F;
        imu.off_deg[1] = -0.5F;
        stand(60);
        fly(100);
        TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
    }
}

/* 5 mm are 1.3 degrees of pitch. The heights at rest tell that the mirror is wrong by them. */
void test_mirrors_that_are_mounted_five_millimetres_wrong_are_no_offset(void)
{
    world.length_mm[MIRROR_FORE] = 5.0F;
    world.length_mm[MIRROR_AFT] = -5.0F;
    world.length_mm[MIRROR_FRONT] = 5.0F;
    stand(60);
    fly(100);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
}

/* The same heights at rest, and the mirrors are right: tufts of grass. */
void test_uneven_ground_at_rest_is_no_offset_above_even_ground(void)
{
    world.length_mm[MIRROR_FORE] = 25.0F;
    stand(60);
    world.length_mm[MIRROR_FORE] = 0.0F;
    fly(100);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
}

/* Later on a slope looks the same. */
void test_a_slope_that_it_flies_to_is_no_offset(void)
{
    stand(40);
    fly(60);
    world.slope_rad[1] = 10.0F * DEG;
    fly(LONG_SCANS);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
}

void test_beyond_an_edge_at_rest_no_offset_is_known(void)
{
    world.length_mm[MIRROR_FORE] = 300.0F;
    stand(60);
    TEST_ASSERT_FALSE(plane.off_known);
    TEST_ASSERT_EQUAL(IMU_SOUND, plane_fault(&plane));
}
