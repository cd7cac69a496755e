/* TaskControl with the real flight cycle; the linker lets the test look at what goes into flight_step() and
 * what comes out (--wrap). A script changes the servers from wait to wait. */
#include "firmware/tasks.h"

#include <math.h>
#include <string.h>

#include "control/flight.h"
#include "jobs.h"
#include "kernel.h"
#include "mock_alive.h"
#include "mock_calibrator.h"
#include "mock_flight_recorder.h"
#include "mock_receiver.h"
#include "mock_selector.h"
#include "mock_pulse_stream.h"
#include "mock_servers.h"
#include "mock_throttle.h"
#include "mock_timebase.h"
#include "mock_voltmeter.h"
#include "control/thrust.h"
#include "unity.h"

#define CYCLES_MAX 200U
#define IDLE_PULSE_US 1999.68F /* 4166 counts of 0.48 us */

void __real_flight_step(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in,
                        flight_outputs_t *out);
void __wrap_flight_step(flight_t *flight, const parameters_t *parameters, const flight_inputs_t *in,
                        flight_outputs_t *out);

#define ROLLS Event_Id_03 /* part of every wait */

static altitude_sample_t altitude;
static imu_sample_t imu;
static imu_sample_t imu_before;
static reference_sample_t reference;
static parameters_t parameters;
static uint32_t now_us;

static flight_inputs_t inputs[CYCLES_MAX];
static flight_outputs_t outputs[CYCLES_MAX];
static parameters_t used[CYCLES_MAX];
static float pulses_us[CYCLES_MAX];
static flight_outputs_t published[CYCLES_MAX];
static UInt masks[CYCLES_MAX + 1U];
static uint16_t waits;
static uint16_t cycles; /* to run */
static uint16_t steps;
static uint16_t pulse_count;
static uint16_t publications;
static void (*between)(uint16_t wait); /* changes the world while the task waits, or NULL */
static UInt released_by;               /* what Event_pend() returns */
static float overlay_us;               /* what the calibrator adds */
static uint16_t alive_reports;

void __wrap_flight_step(flight_t *flight, const parameters_t *set, const flight_inputs_t *in,
                        flight_outputs_t *out)
{
    kernel_note("step");
    kernel_no_lock();
    inputs[steps] = *in;
    used[steps] = *set;
    __real_flight_step(flight, set, in, out);
    outputs[steps++] = *out;
}

static void altitude_read(altitude_sample_t *sample, int calls)
{
    (void)calls;
    kernel_note("altitude");
    *sample = altitude;
}

static uint16_t imu_history(imu_sample_t history[IMU_HISTORY], int calls)
{
    (void)calls;
    kernel_note("imu");
    history[0] = imu.sequence < 2U ? imu : imu_before;
    history[1] = imu;
    return imu.sequence < 2U ? (uint16_t)imu.sequence : 2U;
}

static void reference_read(reference_sample_t *sample, int calls)
{
    (void)calls;
    kernel_note("reference");
    *sample = reference;
}

static void parameters_read(parameters_t *set, int calls)
{
    (void)calls;
    kernel_note("parameters");
    *set = parameters;
}

static void status_write(const flight_outputs_t *status, int calls)
{
    (void)calls;
    kernel_note("publish");
    published[publications++] = *status;
}

static void set_pulse(float pulse_us, int calls)
{
    (void)calls;
    kernel_note("pulse");
    pulses_us[pulse_count++] = pulse_us;
}

static uint32_t time_us(int calls)
{
    (void)calls;
    kernel_note("time");
    return now_us;
}

static UInt pend(UInt mask)
{
    masks[waits] = mask;
    if (waits == cycles) {
        kernel_block();
    }
    if (between != NULL) {
        between(waits);
    }
    waits++;
    now_us += 108000U;
    return released_by;
}

static float heard_us; /* pulse of the receiver in each cycle; 0: none */

static bool receiver_take(float *pulse_us, int calls)
{
    (void)calls;
    kernel_note("stick");
    *pulse_us = heard_us;
    return heard_us > 0.0F;
}

static float pin_v; /* voltage of the battery's divider in each cycle */

static bool voltmeter_take(float *volts, int calls)
{
    (void)calls;
    kernel_note("volts");
    *volts = pin_v;
    return true;
}

static void overlay(float link_s, const flight_inputs_t *in, flight_outputs_t *out, int calls)
{
    (void)calls;
    kernel_note("overlay");
    TEST_ASSERT_EQUAL_FLOAT(parameters.value[PARAMETER_LINK], link_s);
    TEST_ASSERT_EQUAL_MEMORY(&inputs[steps - 1U], in, sizeof *in);
    out->pulse_us += overlay_us;
    outputs[steps - 1U] = *out;
}

static void record(const flight_inputs_t *in, const flight_outputs_t *out, int calls)
{
    (void)calls;
    kernel_note("record");
    TEST_ASSERT_EQUAL_MEMORY(&inputs[steps - 1U], in, sizeof *in);
    TEST_ASSERT_EQUAL_MEMORY(&outputs[steps - 1U], out, sizeof *out);
}

static void alive(alive_t task, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL(ALIVE_CONTROL, task);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(alive_reports + 1U, publications, "alive before the cycle was complete");
    alive_reports++;
}

static uint16_t streamed;

static void stream(float pulse_us, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_FLOAT_MESSAGE(pulses_us[pulse_count - 1U], pulse_us, "not the pulse of this cycle");
    streamed++;
}

void setUp(void)
{
    kernel_reset();
    (void)memset(&altitude, 0, sizeof altitude);
    (void)memset(&imu, 0, sizeof imu);
    (void)memset(&reference, 0, sizeof reference);
    parameters_init(&parameters);
    parameters.value[PARAMETER_LAW] = (float)LAW_PID;
    now_us = 0xFFFF0000U; /* wraps on the way */
    waits = steps = pulse_count = publications = 0U;
    cycles = 1U;
    between = NULL;
    released_by = Event_Id_00;
    kernel.event.on_pend = pend;
    altitude_server_read_Stub(altitude_read);
    imu_server_history_Stub(imu_history);
    reference_server_read_Stub(reference_read);
    parameter_server_read_Stub(parameters_read);
    flight_status_server_write_Stub(status_write);
    bsp_throttle_set_pulse_us_Stub(set_pulse);
    bsp_time_us_Stub(time_us);
    bsp_receiver_take_Stub(receiver_take);
    pin_v = 0.0F;
    bsp_voltmeter_take_Stub(voltmeter_take);
    heard_us = 0.0F;
    calibrator_overlay_Stub(overlay);
    flight_recorder_take_Stub(record);
    alive_report_Stub(alive);
    pulse_stream_take_Stub(stream);
    streamed = 0U;
    overlay_us = 0.0F;
    alive_reports = 0U;
    jobs_reset();
    task_control_create();
}

void tearDown(void)
{
    kernel_check();
}

static void run(uint16_t count)
{
    cycles = count;
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(count, steps);
    TEST_ASSERT_EQUAL_UINT16(count, pulse_count);
    TEST_ASSERT_EQUAL_UINT16(count, publications);
}

void test_create_makes_an_event_a_clock_of_108_ms_and_one_task_of_priority_4(void)
{
    TEST_ASSERT_EQUAL_UINT16(1, kernel.event.created);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.clock.created);
    TEST_ASSERT_EQUAL_UINT(108, kernel.clock.timeout);
    TEST_ASSERT_EQUAL_UINT32(108, kernel.clock.params.period);
    TEST_ASSERT_TRUE(kernel.clock.params.startFlag);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.task.created);
    TEST_ASSERT_EQUAL_STRING("TaskControl", kernel.task.name);
    TEST_ASSERT_EQUAL_INT(4, kernel.task.params.priority);
    TEST_ASSERT_EQUAL_UINT64(1792, kernel.task.params.stackSize);
}

void test_the_clock_an_altitude_an_imu_frame_and_a_roll_post_one_event_each(void)
{
    kernel.clock.function(kernel.clock.params.arg);
    TEST_ASSERT_EQUAL_HEX16(Event_Id_00, kernel.event.posted);
    kernel.event.posted = 0U;
    task_control_altitude_arrived();
    TEST_ASSERT_EQUAL_HEX16(Event_Id_01, kernel.event.posted);
    kernel.event.posted = 0U;
    task_control_imu_arrived();
    TEST_ASSERT_EQUAL_HEX16(Event_Id_02, kernel.event.posted);
    kernel.event.posted = 0U;
    task_control_rolls();
    TEST_ASSERT_EQUAL_HEX16(ROLLS, kernel.event.posted);
}

void test_a_cycle_waits_looks_steps_drives_the_throttle_publishes_and_records(void)
{
    run(2U);
    TEST_ASSERT_EQUAL_STRING(
        "parameters "
        "pend parameters altitude imu reference time stick volts step overlay pulse publish record "
        "pend parameters altitude imu reference time stick volts step overlay pulse publish record "
        "pend ",
        kernel.notes);
}

void test_the_stick_moves_the_reference_of_the_next_step_and_its_absence_is_a_flag(void)
{
    parameters.value[PARAMETER_STICK] = (float)STICK_PIN;
    run(1U);
    TEST_ASSERT_EQUAL_HEX16(FLIGHT_FLAG_STICK, published[0].flags & FLIGHT_FLAG_STICK);
    TEST_ASSERT_EQUAL_UINT32(reference.sequence, inputs[0].reference_sequence);
}

static void push_up(uint16_t wait)
{
    heard_us = (wait < 20U) ? 1500.0F : 1100.0F;
    reference.arm = true;
    reference.arm_sequence = 1U;
}

void test_an_armed_vehicle_takes_off_by_the_stick(void)
{
    parameters.value[PARAMETER_STICK] = (float)STICK_PIN;
    parameters.value[PARAMETER_SEL] = (float)SEL_PIN;
    parameters.value[PARAMETER_IAXES] = (float)AXES_PROVED;
    bsp_selector_ours_IgnoreAndReturn(true);
    between = push_up;
    run(40U);
    TEST_ASSERT_EQUAL_HEX16(0, published[39].flags & FLIGHT_FLAG_STICK);
    TEST_ASSERT_EQUAL_UINT32(inputs[0].reference_sequence + 1U, inputs[39].reference_sequence);
    TEST_ASSERT_EQUAL_FLOAT(0.3F, inputs[39].reference_m);
    TEST_ASSERT_EQUAL_FLOAT(1100.0F, published[39].stick_us);
    TEST_ASSERT_TRUE(isnan(published[0].stick_us));
}

void test_without_a_battery_none_is_published(void)
{
    pin_v = 1.6F;
    run(100U);
    TEST_ASSERT_EQUAL_UINT16(BATTERY_OFF, published[99].battery);
    TEST_ASSERT_TRUE(isnan(published[99].battery_v));
}

void test_the_battery_is_read_in_each_cycle_and_published(void)
{
    parameters.value[PARAMETER_BAT] = (float)BAT_PIN;
    pin_v = 1.5F;
    run(100U);
    TEST_ASSERT_EQUAL_UINT16(BATTERY_GOOD, published[99].battery);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 15.15F, published[99].battery_v);
    TEST_ASSERT_EQUAL_UINT32(reference.sequence, inputs[99].reference_sequence);
}

void test_a_wait_is_for_any_of_its_events_and_at_most_150_ms(void)
{
    run(1U);
    TEST_ASSERT_EQUAL_HEX16(Event_Id_NONE, kernel.event.and_mask);
    TEST_ASSERT_EQUAL_UINT32(150, kernel.event.timeout);
}

void test_a_time_out_runs_a_cycle_like_any_release(void)
{
    released_by = 0U;
    run(3U);
}

static void change_the_release(uint16_t wait)
{
    parameters.value[PARAMETER_RELEASE] = (wait == 1U || wait == 2U) ? (float)RELEASE_SCAN
                                                                     : (float)RELEASE_FREE;
}

void test_the_next_wait_follows_the_release_parameter(void)
{
    between = change_the_release;
    run(5U);
    TEST_ASSERT_EQUAL_HEX16(Event_Id_00 | ROLLS, masks[0]);
    TEST_ASSERT_EQUAL_HEX16(Event_Id_00 | ROLLS, masks[1]); /* FREE in the cycle before */
    TEST_ASSERT_EQUAL_HEX16(Event_Id_01 | ROLLS, masks[2]);
    TEST_ASSERT_EQUAL_HEX16(Event_Id_01 | ROLLS, masks[3]);
    TEST_ASSERT_EQUAL_HEX16(Event_Id_00 | ROLLS, masks[4]);
    TEST_ASSERT_EQUAL_HEX16(Event_Id_00 | ROLLS, masks[5]);
}

void test_the_very_first_wait_follows_the_release_parameter_too(void)
{
    parameters.value[PARAMETER_RELEASE] = (float)RELEASE_SCAN;
    run(1U);
    TEST_ASSERT_EQUAL_HEX16(Event_Id_01 | ROLLS, masks[0]);
}

void test_the_later_laws_have_releases_of_their_own(void)
{
    parameters.value[PARAMETER_LAW] = (float)LAW_PIDT;
    run(1U);
    TEST_ASSERT_EQUAL_HEX16(Event_Id_01 | ROLLS, masks[1]);
    TEST_ASSERT_EQUAL_UINT32(100000, jobs[MONITOR_CONTROL].deadline_us);
    waits = steps = pulse_count = publications = alive_reports = 0U;
    parameters.value[PARAMETER_LAW] = (float)LAW_EST;
    run(1U);
    TEST_ASSERT_EQUAL_HEX16(Event_Id_01 | Event_Id_02 | ROLLS, masks[1]);
    TEST_ASSERT_EQUAL_UINT32(25000, jobs[MONITOR_CONTROL].deadline_us);
}

void test_released_by_scans_the_clock_does_not_run_a_cycle(void)
{
    parameters.value[PARAMETER_RELEASE] = (float)RELEASE_SCAN;
    kernel.event.on_pend = NULL;
    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(0, steps);
    task_control_altitude_arrived();
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(1, steps);
}

void test_released_by_the_clock_an_altitude_does_not_run_a_cycle(void)
{
    kernel.event.on_pend = NULL;
    task_control_altitude_arrived();
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(0, steps);
    kernel.clock.function(kernel.clock.params.arg);
    kernel_run_task();
    TEST_ASSERT_EQUAL_UINT16(1, steps);
}

void test_every_value_of_the_servers_reaches_its_own_place_in_the_inputs(void)
{
    const flight_inputs_t *in = &inputs[0];

    altitude.scan_valid = true;
    altitude.altitude.height_mm = 601.0F;
    altitude.altitude.slant_mm = 1.0F;
    imu_before.sequence = 11U;
    imu_before.arrival_us = 0xFFFE0010U;
    imu.has_acceleration = true;
    imu.forward_mps2 = 0.11F;
    imu.right_mps2 = 0.12F;
    imu.down_mps2 = 9.8F;
    altitude.altitude.disagree = true;
    altitude.sensor_time_ms = 2U;
    altitude.arrival_us = 0xFFFE0001U;
    altitude.age_us = 12345U;
    altitude.sequence = 4U;
    altitude.heightless = 5U;
    altitude.signal = (scan_signal_t){.scans = 6U, .arrival_us = 0xFFFE0002U};
    imu.ready = true;
    imu.level.roll_rad = 0.6F;
    imu.level.pitch_rad = 0.7F;
    imu.median.roll_rad = 0.08F;
    imu.median.pitch_rad = -0.09F;
    imu.median.yaw_rad = 1.0F;
    imu.arrival_us = 0xFFFE0011U;
    imu.sequence = 12U;
    reference.reference_m = 0.75F;
    reference.sequence = 14U;
    reference.link_time_us = 0xFFFE0015U;
    reference.link_sequence = 16U;
    run(1U);
    TEST_ASSERT_EQUAL_UINT32(0xFFFF0000U + 108000U, in->now_us);
    TEST_ASSERT_TRUE(in->height_valid);
    TEST_ASSERT_EQUAL_FLOAT(601.0F, in->altitude.height_mm);
    TEST_ASSERT_EQUAL_HEX32(0xFFFE0001U, in->height_time_us);
    TEST_ASSERT_EQUAL_UINT32(4, in->height_sequence);
    TEST_ASSERT_TRUE(in->altitude.disagree);
    TEST_ASSERT_TRUE(in->attitude_ready);
    TEST_ASSERT_EQUAL_FLOAT(0.08F, in->roll_rad);
    TEST_ASSERT_EQUAL_FLOAT(-0.09F, in->pitch_rad);
    TEST_ASSERT_EQUAL_HEX32(0xFFFE0011U, in->attitude_time_us);
    TEST_ASSERT_EQUAL_FLOAT(0.75F, in->reference_m);
    TEST_ASSERT_EQUAL_UINT32(14, in->reference_sequence);
    TEST_ASSERT_EQUAL_HEX32(0xFFFE0015U, in->link_time_us);
    TEST_ASSERT_EQUAL_UINT32(16, in->link_sequence);
    TEST_ASSERT_EQUAL_UINT32(2, in->height_stamp_ms);
    TEST_ASSERT_EQUAL_UINT32(12345, in->height_age_us);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, in->altitude.slant_mm);
    TEST_ASSERT_EQUAL_UINT16(2, in->frame_count);
    TEST_ASSERT_EQUAL_UINT32(11, in->frames[0].sequence);
    TEST_ASSERT_FALSE(in->frames[0].has_acceleration);
    TEST_ASSERT_EQUAL_HEX32(0xFFFE0010U, in->frames[0].arrival_us);
    TEST_ASSERT_EQUAL_UINT32(12, in->frames[1].sequence);
    TEST_ASSERT_TRUE(in->frames[1].ready);
    TEST_ASSERT_TRUE(in->frames[1].has_acceleration);
    TEST_ASSERT_EQUAL_FLOAT(0.11F, in->frames[1].forward_mps2);
    TEST_ASSERT_EQUAL_FLOAT(0.12F, in->frames[1].right_mps2);
    TEST_ASSERT_EQUAL_FLOAT(9.8F, in->frames[1].down_mps2);
    TEST_ASSERT_EQUAL_FLOAT(0.08F, in->frames[1].median.roll_rad);
    TEST_ASSERT_EQUAL_FLOAT(-0.09F, in->frames[1].median.pitch_rad);
}

static bool pin;
static uint16_t pin_reads;

static bool read_pin(int calls)
{
    (void)calls;
    pin_reads++;
    return pin;
}

static void switch_the_pin(uint16_t wait)
{
    pin = wait % 2U == 1U;
    parameters.value[PARAMETER_SEL] = (wait < 2U) ? (float)SEL_NONE : (float)SEL_PIN;
}

void test_the_pin_tells_who_has_the_throttle_when_sel_says_so(void)
{
    pin_reads = 0U;
    bsp_selector_ours_Stub(read_pin);
    between = switch_the_pin;
    run(4U);
    TEST_ASSERT_TRUE(inputs[0].has_throttle);
    TEST_ASSERT_TRUE(inputs[1].has_throttle);
    TEST_ASSERT_FALSE(inputs[2].has_throttle);
    TEST_ASSERT_TRUE(inputs[3].has_throttle);
    TEST_ASSERT_EQUAL_UINT16(2, pin_reads);
    TEST_ASSERT_EQUAL_HEX16(FLIGHT_FLAG_PILOT, published[2].flags & FLIGHT_FLAG_PILOT);
    TEST_ASSERT_EQUAL_HEX16(0, published[3].flags & FLIGHT_FLAG_PILOT);
}

static void set_one_flag(uint16_t wait)
{
    altitude.scan_valid = wait == 1U;
    altitude.altitude.disagree = wait == 2U;
    imu.ready = wait == 3U;
}

void test_the_three_booleans_are_not_mixed_up(void)
{
    between = set_one_flag;
    run(4U);
    for (uint16_t n = 0; n < 4U; n++) {
        TEST_ASSERT_EQUAL(n == 1U, inputs[n].height_valid);
        TEST_ASSERT_EQUAL(n == 2U, inputs[n].altitude.disagree);
        TEST_ASSERT_EQUAL(n == 3U, inputs[n].attitude_ready);
    }
}

static void change_a_gain(uint16_t wait)
{
    parameters.value[PARAMETER_KP] = 0.001F * (float)wait;
    parameters.generation = wait;
}

void test_a_change_made_during_the_wait_is_used_in_that_very_cycle(void)
{
    between = change_a_gain;
    run(4U);
    for (uint16_t n = 0; n < 4U; n++) {
        TEST_ASSERT_EQUAL_FLOAT(0.001F * (float)n, used[n].value[PARAMETER_KP]);
        TEST_ASSERT_EQUAL_UINT32(n, used[n].generation);
    }
}

void test_on_the_ground_the_pulse_is_idle_and_the_status_says_so(void)
{
    run(3U);
    for (uint16_t n = 0; n < 3U; n++) {
        TEST_ASSERT_FLOAT_WITHIN(0.01F, IDLE_PULSE_US, pulses_us[n]);
        TEST_ASSERT_EQUAL(FLIGHT_GROUND, published[n].state);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, published[n].thrust_n);
        TEST_ASSERT_EQUAL_HEX16(FLIGHT_FLAG_HEIGHT | FLIGHT_FLAG_ATTITUDE, published[n].flags);
    }
}

/* A vehicle that is told to fly and climbs. */
static void climb(uint16_t wait)
{
    altitude.scan_valid = true;
    altitude.altitude.valid = true;
    altitude.altitude.height_mm = (wait < 40U) ? 15.0F * (float)wait : 600.0F;
    altitude.altitude.slant_mm = 100.0F + altitude.altitude.height_mm;
    altitude.arrival_us = now_us + 100000U;
    altitude.sequence++;
    imu.ready = true;
    imu.arrival_us = now_us + 100000U;
    imu.sequence++;
    if (wait == 2U) {
        reference.reference_m = 0.6F;
        reference.sequence++;
    }
}

void test_in_flight_pulse_and_status_are_what_the_cycle_decided(void)
{
    bool flew = false;

    between = climb;
    run(100U);
    for (uint16_t n = 0; n < 100U; n++) {
        flew = flew || outputs[n].state == FLIGHT_FLYING;
        TEST_ASSERT_EQUAL_FLOAT(outputs[n].pulse_us, pulses_us[n]);
        TEST_ASSERT_FLOAT_WITHIN(0.01F, thrust_to_pulse_us(outputs[n].thrust_n), pulses_us[n]);
        TEST_ASSERT_EQUAL_FLOAT(outputs[n].thrust_n, published[n].thrust_n);
        TEST_ASSERT_EQUAL_FLOAT(outputs[n].reference_m, published[n].reference_m);
        TEST_ASSERT_EQUAL(outputs[n].state, published[n].state);
        TEST_ASSERT_EQUAL_HEX16(outputs[n].flags, published[n].flags);
        TEST_ASSERT_EQUAL_MEMORY(&outputs[n].estimate_mm, &published[n].estimate_mm,
                                 sizeof(float)); /* NaN too */
        TEST_ASSERT_EQUAL_MEMORY(&outputs[n].innovation_mm, &published[n].innovation_mm, sizeof(float));
    }
    TEST_ASSERT_TRUE(flew);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, published[99].reference_m);
    TEST_ASSERT_FLOAT_WITHIN(1.01F, 7.5F, published[99].thrust_n);
}

void test_a_new_create_begins_on_the_ground_again(void)
{
    between = climb;
    run(100U);
    TEST_ASSERT_EQUAL(FLIGHT_FLYING, published[99].state);
    between = NULL;
    waits = steps = pulse_count = publications = alive_reports = 0U;
    jobs_reset();
    (void)memset(&reference, 0, sizeof reference);
    task_control_create();
    run(1U);
    TEST_ASSERT_EQUAL(FLIGHT_GROUND, published[0].state);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, IDLE_PULSE_US, pulses_us[0]);
}

void test_the_pulse_is_what_the_calibrator_leaves(void)
{
    overlay_us = -250.0F;
    run(1U);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, IDLE_PULSE_US - 250.0F, pulses_us[0]);
}

void test_every_complete_cycle_is_a_sign_of_life_whatever_released_it(void)
{
    released_by = 0U;
    run(7U);
    TEST_ASSERT_EQUAL_UINT16(7, alive_reports);
}

void test_every_cycle_is_one_job(void)
{
    run(5U);
    jobs_assert(MONITOR_CONTROL, 5U);
}

/* An altitude that nobody waits for is no release. */
void test_a_job_is_measured_from_the_event_that_is_waited_for(void)
{
    for (uint16_t release = 0; release < RELEASE_COUNT; release++) {
        parameters.value[PARAMETER_RELEASE] = (float)release;
        run(1U);
        waits = steps = pulse_count = publications = alive_reports = 0U;
        jobs[MONITOR_CONTROL].released = 0U;
        now_us = 5000U;
        kernel.clock.function(kernel.clock.params.arg);
        TEST_ASSERT_EQUAL_UINT16(release == RELEASE_FREE ? 1U : 0U, jobs[MONITOR_CONTROL].released);
        TEST_ASSERT_EQUAL_UINT32(release == RELEASE_FREE ? 108000U : 100000U,
                                 jobs[MONITOR_CONTROL].deadline_us);
        now_us = 6000U;
        task_control_altitude_arrived();
        TEST_ASSERT_EQUAL_UINT16(1, jobs[MONITOR_CONTROL].released);
        TEST_ASSERT_EQUAL_UINT32(release == RELEASE_FREE ? 5000U : 6000U, jobs[MONITOR_CONTROL].released_us);
    }
}
