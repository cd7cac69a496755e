/* What the operator is told of the IMU before a take-off; the servers and the radio are mocked. */
#include "firmware/imu_gate.h"

#include <string.h>

#include "mock_servers.h"
#include "mock_xbee_port.h"
#include "unity.h"

static flight_outputs_t flight;
static parameters_t parameters;
static char sent[TELEMETRY_ANSWER_MAX + 1U];
static telecommand_t command = {.name = "ARM", .name_length = 3U};
static answer_t answer = {.command = &command};

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

static void answer_sent(const telemetry_line_t *line, int calls)
{
    (void)calls;
    (void)memcpy(sent, line->text, line->length);
    sent[line->length - 2U] = '\0'; /* CR LF */
}

void setUp(void)
{
    flight = (flight_outputs_t){.state = FLIGHT_GROUND};
    parameters_init(&parameters);
    sent[0] = '\0';
    flight_status_server_read_Stub(read_flight);
    parameter_server_read_Stub(read_parameters);
    xbee_port_answer_Stub(answer_sent);
}

void tearDown(void) {}

static void remark(bool assumed_too, const char *expected)
{
    answer_begin(&answer);
    imu_gate_remark(&answer, assumed_too);
    answer_send(&answer);
    TEST_ASSERT_EQUAL_STRING(expected, sent);
}

void test_wrong_angles_are_refused_on_the_ground_alone(void)
{
    flight.imu_fault = IMU_ROLL;
    TEST_ASSERT_TRUE(imu_gate_refuses(&answer));
    TEST_ASSERT_EQUAL_STRING("ERR ARM IMU ROLL against gravity, see #IMU", sent);
    for (int state = FLIGHT_GROUND + 1; state < FLIGHT_STATE_COUNT; state++) {
        sent[0] = '\0';
        flight.state = (flight_state_t)state;
        TEST_ASSERT_FALSE(imu_gate_refuses(&answer));
        TEST_ASSERT_EQUAL_STRING("", sent);
    }
}

void test_what_the_mirrors_have_found_is_refused_with_their_name(void)
{
    flight.imu_fault = flight.mirrors.imu = IMU_PITCH;
    TEST_ASSERT_TRUE(imu_gate_refuses(&answer));
    TEST_ASSERT_EQUAL_STRING("ERR ARM IMU PITCH against the mirrors, see #MIRRORS", sent);
    flight.imu_fault = flight.mirrors.imu = IMU_SWAPPED;
    TEST_ASSERT_TRUE(imu_gate_refuses(&answer));
    TEST_ASSERT_EQUAL_STRING("ERR ARM IMU SWAPPED: roll is pitch, see #MIRRORS", sent);
    parameters.value[PARAMETER_IAXES] = (float)AXES_PROVED;
    TEST_ASSERT_FALSE(imu_gate_refuses(&answer));
}

void test_an_offset_may_be_a_slope_and_is_not_refused(void)
{
    flight.imu_fault = flight.mirrors.imu = IMU_OFFSET;
    TEST_ASSERT_FALSE(imu_gate_refuses(&answer));
    remark(true, "OK ARM (IMU OFFSET or a slope, see #MIRRORS)");
}

void test_wrong_accelerations_are_not_refused_but_remarked_upon(void)
{
    flight.imu_fault = IMU_UNIT;
    TEST_ASSERT_FALSE(imu_gate_refuses(&answer));
    remark(true, "OK ARM (IMU UNIT wrong, see #IMU)");
    flight.imu_fault = IMU_DOWN;
    remark(false, "OK ARM (IMU DOWN wrong, see #IMU)");
}

void test_what_nobody_has_proved_is_remarked_upon_where_it_is_asked_for(void)
{
    remark(true, "OK ARM (IMU axes assumed, see #IMU)");
    remark(false, "OK ARM");
    parameters.value[PARAMETER_IAXES] = (float)AXES_PROVED;
    remark(true, "OK ARM");
}
