/* `#RC` with the real answer writer; servers and radio are mocked. */
#include "firmware/verbs.h"

#include <math.h>
#include <string.h>

#include "control/where/flight_state.h"
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
    parameters.value[PARAMETER_STICK] = (float)STICK_PIN;
    parameters.value[PARAMETER_SEL] = (float)SEL_PIN;
    flight_status_server_read_Stub(flight_read);
    parameter_server_read_Stub(parameters_read);
    xbee_port_answer_Stub(radio);
}

void tearDown(void) {}

static void expect(const char *text)
{
    static telecommand_t command = {.name = "RC", .name_length = 2U};
    answer_t answer = {.command = &command};

    TEST_ASSERT_TRUE(verb_rc(&answer));
    TEST_ASSERT_EQUAL_STRING(text, sent);
}

void test_it_tells_the_pulse_and_that_it_counts(void)
{
    flight.stick_us = 1511.6F;
    expect("OK RC pulse:1512 stick:COUNTS\r\n");
}

void test_it_tells_why_it_does_not(void)
{
    flight.flags = FLIGHT_FLAG_STICK;
    expect("OK RC pulse:- stick:SILENT (no pulses, or noise)\r\n");
    flight.stick_us = 1804.4F;
    expect("OK RC pulse:1804 stick:WAITS (for the middle)\r\n");
    parameters.value[PARAMETER_SEL] = (float)SEL_NONE;
    expect("OK RC pulse:1804 stick:OFF (#SEL PIN)\r\n");
}

/* So that SMID can be found before the stick is used. */
void test_switched_off_it_tells_the_pulse_all_the_same(void)
{
    parameters.value[PARAMETER_STICK] = (float)STICK_NONE;
    flight.stick_us = 1520.0F;
    expect("OK RC pulse:1520 stick:OFF (#STICK PIN)\r\n");
    flight.stick_us = NAN;
    expect("OK RC pulse:- stick:OFF (#STICK PIN)\r\n");
}
