/* TaskReceiveLaser with the real ray groups and altitude correction, between a scripted port and recording
 * servers. The task keeps its sample from one test to the next: what counts up is compared with the first
 * write. */
#include "firmware/tasks.h"

#include <math.h>
#include <string.h>

#include "firmware/geometry.h"
#include "jobs.h"
#include "kernel.h"
#include "mock_laser_port.h"
#include "mock_servers.h"
#include "unity.h"

#define MESSAGES_MAX 40U
#define POINTS 35U

static laser_message_t messages[MESSAGES_MAX];
static uint16_t message_count;
static uint16_t next_message;
static imu_sample_t imu;
static altitude_sample_t written[MESSAGES_MAX];
static uint16_t write_count;

static const urg_config_t config = {.first_rate = 115200U};

static void port_create(const urg_config_t *order, int calls)
{
    TEST_ASSERT_EQUAL_INT(0, calls);
    TEST_ASSERT_EQUAL_PTR(&config, order);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.task.created);
    kernel_note("port");
}

static void port_wait(laser_message_t *message, int calls)
{
    (void)calls;
    kernel_note("wait");
    if (next_message == message_count) {
        kernel_block();
    }
    *message = messages[next_message++];
    message->scan.distance_mm = message->distance_mm;
}

static void imu_read(imu_sample_t *sample, int calls)
{
    (void)calls;
    kernel_note("imu");
    *sample = imu;
}

static void altitude_write(const altitude_sample_t *sample, int calls)
{
    (void)calls;
    kernel_note("altitude");
    written[write_count++] = *sample;
}

/* TaskControl's. */
void task_control_altitude_arrived(void)
{
    kernel_note("arrived");
}

/* One mirror of the vehicle as delivered, one value of it another. */
static void mount(parameter_id_t id, float value)
{
    parameters_t parameters;

    parameters_init(&parameters);
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, PARAMETER_LAYOUT, (float)LAYOUT_FRONT));
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, id, value));
    geometry_mount(&parameters);
}

void setUp(void)
{
    kernel_reset();
    mount(PARAMETER_L, 220.0F);
    message_count = next_message = write_count = 0U;
    (void)memset(&imu, 0, sizeof imu);
    (void)memset(messages, 0, sizeof messages);
    laser_port_create_Stub(port_create);
    laser_port_wait_Stub(port_wait);
    imu_server_read_Stub(imu_read);
    altitude_server_write_Stub(altitude_write);
    jobs_reset();
    task_receive_laser_create(&config);
}

void tearDown(void)
{
    kernel_check();
}

static laser_message_t *scan(uint16_t distance_mm)
{
    laser_message_t *message = &messages[message_count];

    TEST_ASSERT_LESS_THAN(MESSAGES_MAX, message_count);
    message_count++;
    message->scan.points = POINTS;
    message->scan.characters = 2U;
    message->scan.first_step = 372U;
    message->scan.cluster = 1U;
    message->scan.timestamp_ms = 7000U + 100U * message_count;
    message->arrival_us = 50000U + 100000U * message_count;
    message->bit_rate = 250000U;
    for (uint16_t i = 0; i < POINTS; i++) {
        message->distance_mm[i] = distance_mm;
    }
    return message;
}

/* Of the first message's good rays: their mean along the axis of the mirror, step 384, and how far to the
 * fore of it their spot lies. control/altitude.h */
static float along_mm, fore_mm;

static void look_along_the_axis(void)
{
    float sum = 0.0F, aside = 0.0F, aside2 = 0.0F, rays = 0.0F;

    for (uint16_t i = 0; i < POINTS; i++) {
        const float mm = messages[0].distance_mm[i], rad = (float)(i - 12) * 0.006135923F;
        const float good = (mm >= 20.0F && mm < 4095.0F) ? 1.0F : 0.0F;

        rays += good;
        sum += good * mm;
        aside += good * rad;
        aside2 += good * rad * rad;
    }
    along_mm = sum / rays / (1.0F + 0.5F * aside2 / rays);
    fore_mm = along_mm * aside / rays;
}

void test_create_makes_the_port_at_the_sensors_first_rate_and_then_one_task_of_priority_5(void)
{
    TEST_ASSERT_EQUAL_STRING("port ", kernel.notes);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.task.created);
    TEST_ASSERT_EQUAL_STRING("TaskReceiveLaser", kernel.task.name);
    TEST_ASSERT_EQUAL_INT(5, kernel.task.params.priority);
    TEST_ASSERT_EQUAL_UINT64(1152, kernel.task.params.stackSize);
}

void test_a_scan_is_published_before_control_is_released(void)
{
    (void)scan(700U);
    kernel_run_task();
    TEST_ASSERT_EQUAL_STRING("port wait imu altitude arrived wait ", kernel.notes);
}

void test_a_level_vehicle_is_as_high_as_the_slant_less_mirror_and_leg(void)
{
    (void)scan(805U);
    look_along_the_axis();
    kernel_run_task();
    TEST_ASSERT_TRUE(written[0].scan_valid);
    TEST_ASSERT_TRUE(written[0].altitude.valid);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, along_mm - 205.0F, written[0].altitude.height_mm); /* 105 and 100 */
    TEST_ASSERT_FLOAT_WITHIN(0.01F, along_mm, written[0].altitude.slant_mm);
    TEST_ASSERT_TRUE(along_mm < 804.0F);
    TEST_ASSERT_EQUAL_UINT16(POINTS, written[0].altitude.good_rays);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, written[0].altitude.spread_mm);
    TEST_ASSERT_EQUAL_UINT32(7100, written[0].sensor_time_ms);
    TEST_ASSERT_EQUAL_UINT32(150000, written[0].arrival_us);
    TEST_ASSERT_EQUAL_UINT32(70500, written[0].age_us);
}

void test_the_tilt_is_the_imus_median_with_roll_and_pitch_in_their_places(void)
{
    imu.median.roll_rad = 0.1F;
    imu.median.pitch_rad = 0.2F;
    imu.level.roll_rad = 1.0F;
    imu.level.pitch_rad = -1.0F;
    (void)scan(1105U);
    look_along_the_axis();
    kernel_run_task();
    TEST_ASSERT_FLOAT_WITHIN(0.01F,
                             (along_mm - 105.0F) * cosf(0.2F) * cosf(0.1F) - 220.0F * sinf(0.1F) -
                                 fore_mm * sinf(0.2F) - 100.0F,
                             written[0].altitude.height_mm);
}

void test_a_changed_measure_acts_from_the_next_scan(void)
{
    mount(PARAMETER_LF, 130.0F);
    (void)scan(805U);
    look_along_the_axis();
    kernel_run_task();
    TEST_ASSERT_FLOAT_WITHIN(0.01F, along_mm - 235.0F, written[0].altitude.height_mm); /* 105 and 130 */
    mount(PARAMETER_L, 325.0F);
    imu.median.roll_rad = 0.1F;
    imu.median.pitch_rad = 0.2F;
    (void)scan(1105U);
    kernel_run_task();
    along_mm *= 1105.0F / 805.0F;
    fore_mm *= 1105.0F / 805.0F;
    TEST_ASSERT_FLOAT_WITHIN(0.01F,
                             (along_mm - 105.0F) * cosf(0.2F) * cosf(0.1F) - 325.0F * sinf(0.1F) -
                                 fore_mm * sinf(0.2F) - 100.0F,
                             written[1].altitude.height_mm);
}

void test_the_mean_is_of_the_good_rays_alone(void)
{
    laser_message_t *message = scan(800U);

    for (uint16_t i = 0; i < 17U; i++) {
        message->distance_mm[2U * i] = (i % 2U == 0U) ? 19U : 4095U;
    }
    message->distance_mm[1] = 820U;
    look_along_the_axis();
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(18, written[0].altitude.good_rays);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, along_mm, written[0].altitude.slant_mm);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 20.0F, written[0].altitude.spread_mm);
}

void test_a_heightless_scan_is_counted_and_keeps_the_last_height(void)
{
    (void)scan(805U);
    (void)scan(4095U);
    (void)scan(19U);
    (void)scan(905U);
    look_along_the_axis();
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(4, write_count);
    for (uint16_t n = 1; n <= 2U; n++) {
        altitude_sample_t expected = written[0];

        expected.scan_valid = false;
        expected.heightless += n;
        expected.signal = written[n].signal; /* below */
        TEST_ASSERT_FALSE(written[n].scan_valid);
        TEST_ASSERT_EQUAL_UINT32(expected.heightless, written[n].heightless);
        TEST_ASSERT_EQUAL_UINT32(expected.sequence, written[n].sequence);
        TEST_ASSERT_EQUAL_UINT32(expected.arrival_us, written[n].arrival_us);
        TEST_ASSERT_EQUAL_FLOAT(expected.altitude.height_mm, written[n].altitude.height_mm);
        TEST_ASSERT_EQUAL_MEMORY(&expected, &written[n], sizeof expected);
    }
    TEST_ASSERT_TRUE(written[3].scan_valid);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 905.0F / 805.0F * along_mm - 205.0F, written[3].altitude.height_mm);
    TEST_ASSERT_EQUAL_UINT32(written[0].sequence + 1U, written[3].sequence);
    TEST_ASSERT_EQUAL_UINT32(written[0].heightless + 2U, written[3].heightless);
    TEST_ASSERT_EQUAL_UINT32(450000, written[3].arrival_us);
    TEST_ASSERT_EQUAL_UINT32(7400, written[3].sensor_time_ms);
}

void test_a_scan_tells_its_signal_with_a_height_and_without_one(void)
{
    const beam_signal_t *front = &written[0].signal.beams[MIRROR_FRONT];

    (void)scan(805U);
    (void)scan(4095U);
    messages[0].distance_mm[3] = 4095U;
    messages[0].distance_mm[4] = 811U;
    look_along_the_axis();
    kernel_run_task();
    TEST_ASSERT_TRUE(front->looked && front->told);
    TEST_ASSERT_EQUAL_UINT16(POINTS - 1U, front->good_rays);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, along_mm, front->slant_mm);
    TEST_ASSERT_EQUAL_FLOAT(6.0F, front->spread_mm);
    TEST_ASSERT_EQUAL_UINT32(70500U, front->age_us);
    TEST_ASSERT_FALSE(written[0].signal.beams[MIRROR_AFT].looked);
    TEST_ASSERT_FALSE(written[0].signal.beams[MIRROR_FORE].looked);
    front = &written[1].signal.beams[MIRROR_FRONT];
    TEST_ASSERT_TRUE(front->looked && !front->told);
    TEST_ASSERT_EQUAL_UINT16(0U, front->good_rays);
    TEST_ASSERT_EQUAL_UINT32(written[0].signal.scans + 1U, written[1].signal.scans);
    TEST_ASSERT_EQUAL_UINT32(messages[1].arrival_us, written[1].signal.arrival_us);
}

/* The scanner turns from step 1 on: the aft mirror's rays are the oldest. */
void test_the_three_mirrors_rays_have_their_own_ages(void)
{
    const scan_signal_t *signal = &written[0].signal;

    mount(PARAMETER_LAYOUT, (float)LAYOUT_THREE);
    laser_message_t *message = scan(0U);

    message->scan.first_step = 111U;
    message->scan.points = 137U;
    message->scan.cluster = 4U;
    for (uint16_t i = 0; i < 137U; i++) {
        message->distance_mm[i] = (i < 100U) ? 805U : 19U;
    }
    kernel_run_task();
    TEST_ASSERT_TRUE(signal->beams[MIRROR_AFT].told && signal->beams[MIRROR_FRONT].told);
    TEST_ASSERT_TRUE(signal->beams[MIRROR_FORE].looked && !signal->beams[MIRROR_FORE].told);
    TEST_ASSERT_EQUAL_UINT16(0U, signal->beams[MIRROR_FORE].good_rays);
    TEST_ASSERT_UINT32_WITHIN(600U, 25000U,
                              signal->beams[MIRROR_AFT].age_us - signal->beams[MIRROR_FRONT].age_us);
}

void test_a_heightless_scan_releases_control_all_the_same(void)
{
    (void)scan(4095U);
    kernel_run_task();
    TEST_ASSERT_EQUAL_STRING("port wait imu altitude arrived wait ", kernel.notes);
}

void test_each_height_has_the_next_sequence_number(void)
{
    for (uint16_t n = 0; n < 30U; n++) {
        (void)scan((uint16_t)(400U + 100U * n));
    }
    look_along_the_axis();
    kernel_run_task();
    TEST_ASSERT_GREATER_THAN_UINT32(0, written[0].sequence);
    for (uint16_t n = 0; n < 30U; n++) {
        TEST_ASSERT_EQUAL_UINT32(written[0].sequence + n, written[n].sequence);
        TEST_ASSERT_FLOAT_WITHIN(0.01F, along_mm * (4.0F + (float)n) / 4.0F - 205.0F,
                                 written[n].altitude.height_mm);
    }
}

void test_every_scan_is_one_job_that_its_arrival_has_released(void)
{
    (void)scan(805U);
    (void)scan(4095U);
    kernel_run_task();
    jobs_assert(MONITOR_RECEIVE_LASER, 2U);
    TEST_ASSERT_EQUAL_UINT16(0, jobs[MONITOR_RECEIVE_LASER].released); /* the port's */
}
