#include "control/calibration.h"

#include <string.h>

#include "control/thrust.h"
#include "unity.h"

#define LINK_S 5.0F
#define CYCLE_US 108000U

static calibration_t calibration;
static calibration_request_t request;
static flight_inputs_t in;
static flight_outputs_t out;
static flight_outputs_t flown; /* what the flight logic wants */
static float link_s;

void setUp(void)
{
    memset(&calibration, 0, sizeof calibration);
    memset(&request, 0, sizeof request);
    memset(&in, 0, sizeof in);
    memset(&flown, 0, sizeof flown);
    in.now_us = 4294000000U; /* wraps within a second */
    in.height_valid = true;
    in.altitude.height_mm = 4.0F;
    flown.state = FLIGHT_GROUND;
    flown.pulse_us = THRUST_IDLE_PULSE_US;
    link_s = LINK_S;
}

void tearDown(void) {}

static void cycle(void)
{
    in.now_us += CYCLE_US;
    out = flown;
    calibration_step(&calibration, &request, link_s, &in, &out);
}

static void ask(bool run)
{
    request.sequence++;
    request.run = run;
    request.step_counts = 30U;
    request.period_s = 5U;
}

static void start(void)
{
    ask(true);
    cycle();
}

static void assert_idle(calibration_end_t end)
{
    TEST_ASSERT_EQUAL(end, calibration.end);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, out.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(THRUST_IDLE_PULSE_US, out.pulse_us);
}

void test_without_a_request_nothing_is_touched(void)
{
    flown.thrust_n = 3.0F;
    flown.pulse_us = 1500.0F;
    flown.flags = 5U;
    for (int i = 0; i < 100; i++) {
        cycle();
        TEST_ASSERT_EQUAL_MEMORY(&flown, &out, sizeof out);
    }
    TEST_ASSERT_EQUAL(CALIBRATION_NONE, calibration.end);
}

/* Compare values 4136, 4106, ... and T = (4166 - compare) / 177.21: seed document, eq. 4-5. */
void test_every_five_seconds_the_compare_value_is_thirty_counts_lower(void)
{
    start();
    for (uint16_t k = 1U; k <= 50U; k++) {
        TEST_ASSERT_EQUAL(CALIBRATION_RUNNING, calibration.end);
        TEST_ASSERT_EQUAL_UINT16(k, calibration.steps);
        TEST_ASSERT_EQUAL_UINT16(4166U - 30U * k, calibration.compare_counts);
        TEST_ASSERT_FLOAT_WITHIN(0.001F, (float)(30U * k) / 177.21F, out.thrust_n);
        TEST_ASSERT_FLOAT_WITHIN(0.01F, (float)(4166U - 30U * k) * 0.48F, out.pulse_us);
        for (int i = 0; i < 46; i++) { /* 46 cycles of 108 ms are 4.97 s, the 47th is after 5.08 s */
            TEST_ASSERT_EQUAL_UINT16(k, calibration.steps);
            cycle();
        }
        cycle();
    }
}

void test_it_ends_before_the_step_that_would_pass_the_limit(void)
{
    float most_n = 0.0F;
    int cycles = 0;

    request.period_s = 1U;
    ask(true);
    request.period_s = 1U;
    do {
        cycle();
        most_n = (out.thrust_n > most_n) ? out.thrust_n : most_n;
    } while (calibration.end == CALIBRATION_RUNNING && ++cycles < 2000);
    assert_idle(CALIBRATION_LIMIT);
    TEST_ASSERT_TRUE(most_n <= 8.5F && most_n > 8.5F - 30.0F / 177.21F);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(50, calibration.steps, "1500 counts are 8.464 N, 1530 are 8.634 N");
    TEST_ASSERT_FLOAT_WITHIN(0.001F, most_n, calibration.thrust_n);
}

void test_a_stop_ends_it_in_its_cycle_and_a_stop_without_a_run_is_nothing(void)
{
    start();
    ask(false);
    cycle();
    assert_idle(CALIBRATION_STOPPED);
    setUp();
    ask(false);
    cycle();
    assert_idle(CALIBRATION_NONE);
}

void test_each_reason_ends_it_at_once_and_for_good(void)
{
    for (int reason = 0; reason < 7; reason++) {
        static const calibration_end_t ends[] = {CALIBRATION_LINK,   CALIBRATION_LINK,   CALIBRATION_LIFTED,
                                                 CALIBRATION_LIFTED, CALIBRATION_LIFTED, CALIBRATION_STATE,
                                                 CALIBRATION_STATE};

        setUp();
        start();
        cycle();
        TEST_ASSERT_TRUE(out.thrust_n > 0.0F);
        switch (reason) {
        case 0:
            flown.flags = FLIGHT_FLAG_LINK;
            break;
        case 1:
            link_s = 0.0F;
            break;
        case 2:
            in.altitude.height_mm = 101.0F;
            break;
        case 3:
            in.height_valid = false;
            break;
        case 4:
            flown.flags = FLIGHT_FLAG_HEIGHT;
            break;
        case 5:
            flown.state = FLIGHT_FLOATING;
            break;
        default:
            flown.reference_m = 0.5F;
            break;
        }
        cycle();
        TEST_ASSERT_EQUAL(ends[reason], calibration.end);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&flown, &out, sizeof out, "the flight logic has it again");
        flown.flags = 0U;
        flown.state = FLIGHT_GROUND;
        flown.reference_m = 0.0F;
        link_s = LINK_S;
        in.altitude.height_mm = 0.0F;
        in.height_valid = true;
        for (int i = 0; i < 100; i++) {
            cycle();
            assert_idle(ends[reason]);
        }
    }
}

void test_a_reason_that_is_there_from_the_start_gives_no_thrust_at_all(void)
{
    flown.flags = FLIGHT_FLAG_LINK;
    start();
    assert_idle(CALIBRATION_LINK);
}

/* 15 % are 312 counts, 1.76 N. */
void test_it_begins_one_step_above_the_idle_that_keeps_motors_turning(void)
{
    request.idle_percent = 15.0F;
    start();
    TEST_ASSERT_EQUAL_UINT16(4166U - 312U - 30U, calibration.compare_counts);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 342.0F / 177.21F, out.thrust_n);
}

void test_at_its_end_the_armed_idle_is_there_again(void)
{
    flown.thrust_n = flown.idle_n = 1.764F;
    flown.pulse_us = thrust_to_pulse_us(1.764F);
    start();
    TEST_ASSERT_TRUE(out.pulse_us < flown.pulse_us || request.idle_percent == 0.0F);
    ask(false);
    cycle();
    TEST_ASSERT_EQUAL_MEMORY(&flown, &out, sizeof out);
}

void test_a_new_start_begins_with_the_first_step_again(void)
{
    start();
    for (int i = 0; i < 300; i++) {
        cycle();
    }
    TEST_ASSERT_TRUE(calibration.steps > 5U);
    start();
    TEST_ASSERT_EQUAL_UINT16(1U, calibration.steps);
    TEST_ASSERT_EQUAL_UINT16(4136U, calibration.compare_counts);
}

void test_in_flight_it_never_acts_whatever_is_asked(void)
{
    for (int state = FLIGHT_GROUND + 1; state < FLIGHT_STATE_COUNT; state++) {
        setUp();
        flown.state = (flight_state_t)state;
        flown.thrust_n = 6.9F;
        flown.pulse_us = thrust_to_pulse_us(6.9F);
        for (int i = 0; i < 50; i++) {
            ask(true);
            cycle();
            TEST_ASSERT_EQUAL_MEMORY(&flown, &out, sizeof out);
        }
    }
}

void test_a_long_pause_of_the_control_cycle_makes_one_step_and_not_many(void)
{
    start();
    in.now_us += 60000000U;
    cycle();
    TEST_ASSERT_EQUAL_UINT16(2U, calibration.steps);
    cycle();
    TEST_ASSERT_EQUAL_UINT16(2U, calibration.steps);
}

void test_the_seeds_laws_get_less_than_the_thrust_that_lifts(void)
{
    parameters_t parameters;

    parameters_init(&parameters);
    for (int law = 0; law < LAW_COUNT; law++) {
        parameters.value[PARAMETER_LAW] = (float)law;
        TEST_ASSERT_FLOAT_WITHIN(0.0001F, (law == LAW_PD || law == LAW_PID) ? 6.6F : 7.0F,
                                 calibration_gravity_n(&parameters, 7.0F));
    }
}
