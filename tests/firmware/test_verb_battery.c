/* `#VOLTS` with the real answer writer; servers and radio are mocked. */
#include "firmware/verbs.h"

#include <math.h>
#include <string.h>

#include "control/battery.h"
#include "mock_servers.h"
#include "mock_xbee_port.h"
#include "unity.h"

static flight_outputs_t flight;
static parameters_t parameters;
static char sent[TELEMETRY_ANSWER_MAX + 1U];

static void radio(const telemetry_line_t *line, int calls)
{
    (void)calls;
    TEST_ASSERT_FALSE(line->overflowed);
    (void)memcpy(sent, line->text, line->length);
    sent[line->length] = '\0';
}

static void flight_read(flight_outputs_t *status, int calls)
{
    (void)calls;
    *status = flight;
}

static void parameters_read(parameters_t *set, int calls)
{
    (void)calls;
    *set = parameters;
}

void setUp(void)
{
    flight = (flight_outputs_t)FLIGHT_OUTPUTS_INITIAL;
    parameters_init(&parameters);
    flight_status_server_read_Stub(flight_read);
    parameter_server_read_Stub(parameters_read);
    xbee_port_answer_Stub(radio);
}

void tearDown(void) {}

static void expect(const char *text)
{
    static telecommand_t command = {.name = "VOLTS", .name_length = 5U};
    answer_t answer = {.command = &command};

    TEST_ASSERT_TRUE(verb_volts(&answer));
    TEST_ASSERT_EQUAL_STRING(text, sent);
}

void test_it_tells_the_voltage_of_the_battery_and_of_a_cell(void)
{
    flight.battery = BATTERY_GOOD;
    flight.battery_v = 15.124F;
    expect("OK VOLTS volts:15.12 cell:3.78 battery:GOOD\r\n");
    parameters.value[PARAMETER_CELLS] = 1.0F; /* 3S */
    flight.battery = BATTERY_HIGH;
    expect("OK VOLTS volts:15.12 cell:5.04 battery:HIGH\r\n");
}

void test_what_is_not_measured_is_a_dash(void)
{
    expect("OK VOLTS volts:- cell:- battery:OFF (#BAT PIN)\r\n");
    flight.battery = BATTERY_ABSENT;
    expect("OK VOLTS volts:- cell:- battery:ABSENT\r\n");
}
