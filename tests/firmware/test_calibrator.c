/* Between the two tasks; the calibration itself is real. */
#include "firmware/calibrator.h"

#include <string.h>

#include "kernel.h"
#include "control/thrust.h"
#include "unity.h"

static flight_inputs_t in;
static flight_outputs_t out;
static calibration_t progress;

void setUp(void)
{
    kernel_reset();
    memset(&in, 0, sizeof in);
    in.height_valid = true;
}

void tearDown(void)
{
    calibrator_stop();
    in.now_us += 1U;
    calibrator_overlay(5.0F, &in, &out);
    kernel_check();
}

static void cycle(void)
{
    in.now_us += 108000U;
    out = (flight_outputs_t){.state = FLIGHT_GROUND, .pulse_us = THRUST_IDLE_PULSE_US};
    calibrator_overlay(5.0F, &in, &out);
    calibrator_look(&progress);
}

void test_what_one_task_starts_the_other_does(void)
{
    cycle();
    TEST_ASSERT_EQUAL_FLOAT(0.0F, out.thrust_n);
    (void)calibrator_start(0.0F, 40U, 2U);
    cycle();
    TEST_ASSERT_EQUAL(CALIBRATION_RUNNING, progress.end);
    TEST_ASSERT_EQUAL_UINT16(4126U, progress.compare_counts);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.2257F, out.thrust_n);
    for (int i = 0; i < 20; i++) {
        cycle();
    }
    TEST_ASSERT_EQUAL_UINT16(4086U, progress.compare_counts);
}

void test_the_progress_names_the_request_that_it_belongs_to(void)
{
    const uint16_t sequence = calibrator_start(0.0F, 30U, 5U);

    calibrator_look(&progress);
    TEST_ASSERT_NOT_EQUAL(sequence, progress.sequence);
    cycle();
    TEST_ASSERT_EQUAL_UINT16(sequence, progress.sequence);
}

void test_a_stop_ends_it_with_the_next_cycle_and_counts_once(void)
{
    uint16_t sequence = calibrator_start(0.0F, 30U, 5U);

    cycle();
    calibrator_stop();
    calibrator_stop();
    cycle();
    TEST_ASSERT_EQUAL(CALIBRATION_STOPPED, progress.end);
    TEST_ASSERT_EQUAL_UINT16((uint16_t)(sequence + 1U), progress.sequence);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, out.thrust_n);
}

void test_the_lower_task_copies_with_interrupts_off_and_the_higher_one_without_a_lock(void)
{
    const uint16_t before = kernel.hwi.disabled;

    (void)calibrator_start(0.0F, 30U, 5U);
    TEST_ASSERT_EQUAL_UINT16(before + 1U, kernel.hwi.disabled);
    calibrator_overlay(5.0F, &in, &out);
    TEST_ASSERT_EQUAL_UINT16(before + 1U, kernel.hwi.disabled);
    calibrator_look(&progress);
    TEST_ASSERT_EQUAL_UINT16(before + 2U, kernel.hwi.disabled);
}
