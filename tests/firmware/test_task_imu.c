/* TaskIMU with the real parser and attitude filter, between a scripted port and a recording server. The task
 * keeps its sample from one test to the next, as it does from frame to frame: what counts up is compared with
 * the first write. */
#include "firmware/tasks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "jobs.h"
#include "kernel.h"
#include "mock_boot.h"
#include "mock_imu_port.h"
#include "mock_servers.h"
#include "firmware/imu_exchange.h"
#include "unity.h"

#define FRAMES_MAX 64U
#define OFFSET_FRAMES 20U
#define RAD_PER_DEGREE 0.017453293F

static imu_message_t frames[FRAMES_MAX];
static uint16_t frame_count;
static uint16_t next_frame;
static imu_sample_t written[FRAMES_MAX];
static uint16_t write_count;

static void port_create(int calls)
{
    TEST_ASSERT_EQUAL_INT(0, calls);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.task.created);
    kernel_note("port");
}

static void port_wait(imu_message_t *message, int calls)
{
    (void)calls;
    kernel_note("wait");
    if (next_frame == frame_count) {
        kernel_block();
    }
    *message = frames[next_frame++];
}

static void server_write(const imu_sample_t *sample, int calls)
{
    (void)calls;
    kernel_note("write");
    TEST_ASSERT_LESS_THAN(FRAMES_MAX, write_count);
    written[write_count++] = *sample;
}

void task_control_imu_arrived(void)
{
    kernel_note("release");
}

static uint16_t rolls;

void task_control_rolls(void)
{
    TEST_ASSERT_EQUAL_UINT16(ATTITUDE_ROLLED_FRAMES, written[write_count - 1U].rolled);
    rolls++;
}

static bool restart;
static attitude_t kept;
static uint16_t kept_count;

static bool kept_offset(attitude_t *offset, int calls)
{
    (void)calls;
    if (restart) {
        *offset = kept;
    }
    return restart;
}

static void keep_offset(const attitude_t *offset, int calls)
{
    (void)calls;
    kept = *offset;
    kept_count++;
}

/* With which sign the vehicle's roll is the IMU's. */
static void mount(control_axis_t roll)
{
    parameters_t parameters;

    parameters_init(&parameters);
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, PARAMETER_IROLL, (float)roll));
    imu_exchange_mount(&parameters);
}

void setUp(void)
{
    kernel_reset();
    frame_count = next_frame = write_count = 0U;
    imu_port_create_Stub(port_create);
    imu_port_wait_Stub(port_wait);
    imu_server_write_Stub(server_write);
    boot_kept_offset_Stub(kept_offset);
    boot_keep_offset_Stub(keep_offset);
    restart = false;
    kept_count = 0U;
    jobs_reset();
    mount(AXIS_ROLL);
    task_imu_create();
}

void tearDown(void)
{
    kernel_check();
}

static void frame(const char *text)
{
    imu_message_t *message = &frames[frame_count];

    TEST_ASSERT_LESS_THAN(FRAMES_MAX, frame_count);
    message->text.length = (uint16_t)strlen(text);
    (void)memcpy(message->text.text, text, message->text.length);
    message->arrival_us = 25000U * (frame_count + 1U);
    frame_count++;
}

/* The yaw lives, as that of every Razor does: frames that repeat are none. */
static void angles(double yaw, double pitch, double roll)
{
    char text[RAZOR_FRAME_MAX];

    (void)snprintf(text, sizeof text, "#YPR=%.2f,%.2f,%.2f", yaw + 0.01 * (frame_count % 2U), pitch, roll);
    frame(text);
}

static void at_rest(double pitch, double roll)
{
    for (uint16_t n = 0; n < OFFSET_FRAMES; n++) {
        angles(0.0, pitch, roll);
    }
}

void test_create_makes_the_port_first_and_then_one_task_of_priority_6(void)
{
    TEST_ASSERT_EQUAL_STRING("port ", kernel.notes);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.task.created);
    TEST_ASSERT_EQUAL_STRING("TaskIMU", kernel.task.name);
    TEST_ASSERT_EQUAL_INT(6, kernel.task.params.priority);
    TEST_ASSERT_EQUAL_UINT64(1152, kernel.task.params.stackSize);
}

void test_each_frame_is_waited_for_and_then_published(void)
{
    angles(1.0, 2.0, 3.0);
    angles(1.0, 2.0, 3.0);
    kernel_run_task();
    TEST_ASSERT_EQUAL_STRING("port wait write release wait write release wait ", kernel.notes);
}

void test_frames_are_counted_and_keep_their_arrival_time(void)
{
    at_rest(0.0, 0.0);
    angles(0.0, 0.0, 0.0);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(21, write_count);
    for (uint16_t n = 0; n < write_count; n++) {
        TEST_ASSERT_EQUAL_UINT32(written[0].sequence + n, written[n].sequence);
        TEST_ASSERT_EQUAL_UINT32(25000U * (n + 1U), written[n].arrival_us);
        TEST_ASSERT_EQUAL_UINT32(written[0].malformed, written[n].malformed);
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, written[0].sequence);
}

void test_after_twenty_frames_the_offset_is_known_and_removed(void)
{
    at_rest(1.5, -2.5);
    angles(30.0, 2.5, 1.5);
    kernel_run_task();
    for (uint16_t n = 0; n < OFFSET_FRAMES; n++) {
        TEST_ASSERT_FALSE(written[n].ready);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, written[n].level.roll_rad);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, written[n].median.pitch_rad);
    }
    TEST_ASSERT_TRUE(written[20].ready);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 4.0F * RAD_PER_DEGREE, written[20].level.roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 1.0F * RAD_PER_DEGREE, written[20].level.pitch_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 30.0F * RAD_PER_DEGREE, written[20].level.yaw_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 4.0F * RAD_PER_DEGREE, written[20].median.roll_rad);
    /* angles() takes pitch before roll: 1.5 and 2.5 degrees as the IMU shows them, offset and all */
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, written[20].median.roll_rad - 2.5F * RAD_PER_DEGREE,
                             written[20].tilt_roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, written[20].median.pitch_rad + 1.5F * RAD_PER_DEGREE,
                             written[20].tilt_pitch_rad);
}

void test_a_spike_is_in_the_level_angles_but_not_in_the_median(void)
{
    at_rest(0.0, 0.0);
    for (uint16_t n = 0; n < 4U; n++) {
        angles(0.0, 1.0, 2.0);
    }
    angles(0.0, 40.0, -50.0);
    kernel_run_task();
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, -50.0F * RAD_PER_DEGREE, written[24].level.roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 40.0F * RAD_PER_DEGREE, written[24].level.pitch_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.0F * RAD_PER_DEGREE, written[24].median.roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 1.0F * RAD_PER_DEGREE, written[24].median.pitch_rad);
}

void test_the_acceleration_is_published_when_the_frame_has_one(void)
{
    frame("#A-C=128.00,-64.00,256.00\n#YPR=0.00,0.00,0.00");
    angles(0.0, 0.0, 0.0);
    kernel_run_task();
    TEST_ASSERT_TRUE(written[0].has_acceleration);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 4.903325F, written[0].forward_mps2);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, -2.4516625F, written[0].right_mps2);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 9.80665F, written[0].down_mps2);
    TEST_ASSERT_FALSE(written[1].has_acceleration);
}

void test_a_malformed_frame_is_counted_and_changes_nothing_else(void)
{
    static const char *const bad[] = {"#YPR=nan,0.00,0.00",       "#YPR=1.00,2.00",
                                      "#YPR=1.00,2.00,3.00,4.00", "#YPR=",
                                      "#YPR=0.00,361.00,0.00",    "#A-C=1.00,2.00\n#YPR=1.00,2.00,3.00"};
    const uint16_t kinds = sizeof bad / sizeof bad[0];

    at_rest(0.0, 0.0);
    frame("#A-C=128.00,-64.00,256.00\n#YPR=5.00,2.00,3.00");
    for (uint16_t i = 0; i < kinds; i++) {
        frame(bad[i]);
    }
    angles(0.0, 0.0, 0.0);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(22U + kinds, write_count);
    for (uint16_t i = 0; i < kinds; i++) {
        imu_sample_t expected = written[20];

        expected.malformed += i + 1U;
        TEST_ASSERT_EQUAL_UINT32(expected.malformed, written[21U + i].malformed);
        TEST_ASSERT_EQUAL_UINT32(expected.sequence, written[21U + i].sequence);
        TEST_ASSERT_EQUAL_UINT32(expected.arrival_us, written[21U + i].arrival_us);
        TEST_ASSERT_EQUAL_MEMORY(&expected, &written[21U + i], sizeof expected);
    }
    TEST_ASSERT_EQUAL_UINT32(written[20].sequence + 1U, written[21U + kinds].sequence);
    TEST_ASSERT_EQUAL_UINT32(written[20].malformed + kinds, written[21U + kinds].malformed);
}

void test_a_frame_that_comes_again_and_again_is_refused_from_the_sixth_time_on(void)
{
    for (int k = 0; k < 9; k++) {
        frame("#YPR=1.00,2.00,3.00");
    }
    frame("#YPR=1.01,2.00,3.00");
    kernel_run_task();
    for (uint16_t n = 0; n < 10U; n++) {
        const uint16_t refused = (n < 5U) ? 0U : (n < 9U) ? (uint16_t)(n - 4U) : 4U;

        TEST_ASSERT_EQUAL_UINT32(written[0].malformed + refused, written[n].malformed);
        TEST_ASSERT_EQUAL_UINT32(written[0].sequence + n - refused, written[n].sequence);
    }
}

void test_malformed_frames_do_not_count_towards_the_offset(void)
{
    for (uint16_t n = 0; n < OFFSET_FRAMES - 1U; n++) {
        angles(0.02 * n, 1.0, 1.0);
        frame("#YPR=nan,1.00,1.00");
    }
    angles(0.0, 1.0, 1.0);
    angles(0.0, 1.0, 1.0);
    kernel_run_task();
    TEST_ASSERT_FALSE(written[write_count - 2U].ready);
    TEST_ASSERT_TRUE(written[write_count - 1U].ready);
}

void test_a_vehicle_that_turns_over_releases_the_control_cycle_whatever_its_law_waits_for(void)
{
    rolls = 0U;
    at_rest(0.0, 0.0);
    for (int n = 1; n <= 12; n++) { /* beyond 10 degrees from the second on */
        angles(0.0, 0.0, 9.0 * n);
    }
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(5, rolls); /* at the eighth to the twelfth */
}

void test_every_frame_good_or_not_is_one_job_that_its_arrival_has_released(void)
{
    angles(1.0, 2.0, 3.0);
    frame("#YPR=1,2");
    angles(1.0, 2.0, 3.0);
    kernel_run_task();
    jobs_assert(MONITOR_IMU, 3U);
    TEST_ASSERT_EQUAL_UINT16(0, jobs[MONITOR_IMU].released); /* the port's */
}

void test_the_offset_is_kept_once_when_it_is_known(void)
{
    at_rest(-2.0, 3.0);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(1, kept_count);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 3.0F * RAD_PER_DEGREE, fabsf(kept.roll_rad));
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.0F * RAD_PER_DEGREE, fabsf(kept.pitch_rad));
    angles(1.0, 1.0, 1.0);
    angles(1.0, 1.0, 1.0);
    at_rest(4.0, 4.0);
    kernel_run_task(); /* begins anew: a second offset */
    TEST_ASSERT_EQUAL_UINT16(2, kept_count);
}

void test_before_the_offset_is_known_nothing_is_kept(void)
{
    for (uint16_t n = 0; n < OFFSET_FRAMES - 1U; n++) {
        angles(0.0, 1.0, 1.0);
    }
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(0, kept_count);
}

/* In the air the vehicle is not level: no new offset. */
void test_after_a_watchdog_reset_the_kept_offset_is_in_force_from_the_first_frame(void)
{
    imu_sample_t expected;

    at_rest(-2.0, 3.0);
    angles(0.0, 10.0, 20.0);
    kernel_run_task();
    expected = written[write_count - 1U];
    restart = true;
    angles(0.0, 10.0, 20.0);
    kernel_run_task();
    TEST_ASSERT_TRUE(written[write_count - 1U].ready);
    TEST_ASSERT_EQUAL_FLOAT(expected.level.roll_rad, written[write_count - 1U].level.roll_rad);
    TEST_ASSERT_EQUAL_FLOAT(expected.level.pitch_rad, written[write_count - 1U].level.pitch_rad);
    TEST_ASSERT_EQUAL_UINT16(1, kept_count);
}

/* Right wing down is positive in the Razor; the vehicle's right side is then low. */
void test_as_delivered_the_razors_roll_and_its_side_are_turned_round(void)
{
    mount(AXIS_MINUS_ROLL);
    at_rest(0.0, 1.0);
    frame("#A-C=0.00,64.00,256.00\n#YPR=0.00,2.00,11.00");
    kernel_run_task();
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, -10.0F * RAD_PER_DEGREE, written[20].level.roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.0F * RAD_PER_DEGREE, written[20].level.pitch_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, -2.4516625F, written[20].right_mps2);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 9.80665F, written[20].down_mps2);
}

/* The offset is one of the IMU, wherever its axes point. */
void test_a_new_mapping_acts_from_the_next_frame_and_keeps_the_offset(void)
{
    imu_view_t view;

    at_rest(0.0, 4.0);
    angles(0.0, 0.0, 6.0);
    kernel_run_task();
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.0F * RAD_PER_DEGREE, written[20].level.roll_rad);
    restart = true;
    mount(AXIS_MINUS_ROLL);
    angles(0.0, 0.0, 6.0);
    kernel_run_task();
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, -2.0F * RAD_PER_DEGREE, written[21].level.roll_rad);
    imu_exchange_look(&view);
    TEST_ASSERT_EQUAL(RAZOR_OK, view.status);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 6.0F * RAD_PER_DEGREE, view.raw.roll_rad);
    TEST_ASSERT_EQUAL_STRING_LEN("#YPR=0.01,0.00,6.00", view.text.text, view.text.length);
}
