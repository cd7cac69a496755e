/* The reference from a parsed line to its server and its answer; the servers and the radio are mocked. */
#include "firmware/verb_reference.h"

#include <math.h>
#include <string.h>

#include "control/battery.h"
#include "control/flight_io.h"
#include "mock_servers.h"
#include "mock_xbee_port.h"
#include "unity.h"

static reference_sample_t reference;
static uint16_t writes;
static char sent[TELEMETRY_ANSWER_MAX + 1U];

static void read(reference_sample_t *sample, int calls)
{
    (void)calls;
    *sample = reference;
}

static void write(const reference_sample_t *sample, int calls)
{
    (void)calls;
    reference = *sample;
    writes++;
}

static void answer_sent(const telemetry_line_t *line, int calls)
{
    (void)calls;
    (void)memcpy(sent, line->text, line->length);
    sent[line->length - 2U] = '\0'; /* CR LF */
}

static flight_outputs_t flight;
static parameters_t parameters;

static void read_flight(flight_outputs_t *outputs, int calls)
{
    (void)calls;
    *outputs = flight;
}

static void read_parameters(parameters_t *set, int calls)
{
    (void)calls;
    *set = parameters;
}

void setUp(void)
{
    flight = (flight_outputs_t){.state = FLIGHT_GROUND};
    parameters_init(&parameters);
    flight_status_server_read_Stub(read_flight);
    parameter_server_read_Stub(read_parameters);
    reference = (reference_sample_t){
        .reference_m = 0.2F, .sequence = 7U, .link_time_us = 5U, .link_sequence = 3U};
    writes = 0U;
    reference_server_read_Stub(read);
    reference_server_write_Stub(write);
    xbee_port_answer_Stub(answer_sent);
}

void tearDown(void) {}

static bool type(bool (*verb)(answer_t *answer), const char *name, const char *argument)
{
    telecommand_t command = {.name_length = (uint16_t)strlen(name),
                             .argument_length = (uint16_t)strlen(argument)};
    answer_t answer = {.command = &command};

    (void)memcpy(command.name, name, strlen(name));
    (void)memcpy(command.argument, argument, strlen(argument));
    return verb(&answer);
}

static void assert_refused(const char *expected, const char *argument)
{
    TEST_ASSERT_FALSE(type(verb_setr, "SETR", argument));
    TEST_ASSERT_EQUAL_STRING(expected, sent);
    TEST_ASSERT_EQUAL_UINT16(0, writes);
}

void test_a_reference_is_written_with_the_next_sequence_and_answered(void)
{
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "0.6"));
    TEST_ASSERT_EQUAL_STRING("OK SETR 0.6", sent);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, reference.reference_m);
    TEST_ASSERT_EQUAL_UINT32(8, reference.sequence);
    TEST_ASSERT_EQUAL_UINT32(3, reference.link_sequence); /* commands.c counts the valid lines */
    TEST_ASSERT_EQUAL_UINT16(1, writes);
}

void test_the_limits_are_0_and_the_highest_reference(void)
{
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "3"));
    TEST_ASSERT_EQUAL_FLOAT(FLIGHT_REFERENCE_MAX_M, reference.reference_m);
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "-0"));
    TEST_ASSERT_FALSE(signbit(reference.reference_m));
    writes = 0U;
    assert_refused("ERR SETR out of range 0..3 m", "3.0001");
    assert_refused("ERR SETR out of range 0..3 m", "-0.0001");
    assert_refused("ERR SETR not a number", "nan");
    assert_refused("ERR SETR not a number", "0.6 m");
    assert_refused("ERR SETR value missing", "");
}

/* Nobody waits for a take-off that does not come. In the air every order counts. */
void test_on_the_ground_an_empty_battery_refuses_a_reference_and_never_a_landing(void)
{
    flight.battery = BATTERY_EMPTY;
    assert_refused("ERR SETR battery EMPTY, see #VOLTS", "0.6");
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "0"));
    flight.state = FLIGHT_FLYING;
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "0.6"));
    flight.state = FLIGHT_GROUND;
    flight.battery = BATTERY_LOW;
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "0.6"));
}

void test_land_and_stop_withdraw_the_reference_whatever_stands_behind_them(void)
{
    TEST_ASSERT_TRUE(type(verb_land, "STOP", "now!"));
    TEST_ASSERT_EQUAL_STRING("OK STOP", sent);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, reference.reference_m);
    TEST_ASSERT_EQUAL_UINT32(8, reference.sequence);
}

/* ---- an IMU that must not be flown by */

void test_a_take_off_by_wrong_angles_is_refused_by_the_name_of_what_is_wrong(void)
{
    static const struct {
        imu_fault_t fault;
        const char *answer;
    } rows[] = {
        {IMU_ROLL, "ERR SETR IMU ROLL against gravity, see #IMU"},
        {IMU_PITCH, "ERR SETR IMU PITCH against gravity, see #IMU"},
        {IMU_BOTH, "ERR SETR IMU ROLL+PITCH against gravity, see #IMU"},
        {IMU_SWAPPED, "ERR SETR IMU SWAPPED: roll is pitch, see #IMU"},
        {IMU_RADIANS, "ERR SETR IMU RADIANS: angles too small, see #IMU"},
        {IMU_OTHER, "ERR SETR IMU ANGLES against gravity, see #IMU"},
    };

    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        flight.imu_fault = rows[i].fault;
        assert_refused(rows[i].answer, "0.5");
        assert_refused(rows[i].answer, "0.0005");
    }
}

void test_a_landing_and_a_flight_that_flies_are_never_refused_for_it(void)
{
    flight.imu_fault = IMU_ROLL;
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "0"));
    TEST_ASSERT_EQUAL_STRING("OK SETR 0", sent);
    flight.state = FLIGHT_FLYING;
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "0.5"));
    TEST_ASSERT_EQUAL_STRING("OK SETR 0.5", sent);
}

void test_axes_that_were_proved_by_hand_fly_against_gravity(void)
{
    flight.imu_fault = IMU_ROLL;
    parameters.value[PARAMETER_IAXES] = (float)AXES_PROVED;
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "0.5"));
}

void test_axes_that_were_typed_are_proved_first(void)
{
    parameters.value[PARAMETER_IPITCH] = (float)AXIS_MINUS_PITCH;
    assert_refused("ERR SETR IMU axes set but not proved, see #IMU", "0.5");
    parameters.value[PARAMETER_IAXES] = (float)AXES_PROVED;
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "0.5"));
}

void test_accelerations_that_are_wrong_are_remarked_upon(void)
{
    flight.imu_fault = IMU_UNIT;
    TEST_ASSERT_TRUE(type(verb_setr, "SETR", "0.5"));
    TEST_ASSERT_EQUAL_STRING("OK SETR 0.5 (IMU UNIT wrong, see #IMU)", sent);
}
