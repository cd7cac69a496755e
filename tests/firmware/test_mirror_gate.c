/* What the operator is told of the mirrors before a take-off; the servers and the radio are mocked. */
#include "firmware/mirror_gate.h"

#include <string.h>

#include "mock_servers.h"
#include "mock_xbee_port.h"
#include "unity.h"

#define FRONT (1U << MIRROR_FRONT)
#define FORE (1U << MIRROR_FORE)
#define AFT (1U << MIRROR_AFT)

static flight_outputs_t flight;
static char sent[TELEMETRY_ANSWER_MAX + 1U];
static telecommand_t command = {.name = "ARM", .name_length = 3U};
static answer_t answer = {.command = &command};

static void read_flight(flight_outputs_t *outputs, int calls)
{
    (void)calls;
    *outputs = flight;
}

static void answer_sent(const telemetry_line_t *line, int calls)
{
    (void)calls;
    (void)memcpy(sent, line->text, line->length);
    sent[line->length - 2U] = '\0'; /* CR LF */
}

void setUp(void)
{
    flight = (flight_outputs_t)FLIGHT_OUTPUTS_INITIAL;
    sent[0] = '\0';
    flight_status_server_read_Stub(read_flight);
    xbee_port_answer_Stub(answer_sent);
}

void tearDown(void) {}

static void remark(const char *expected)
{
    answer_begin(&answer);
    mirror_gate_remark(&answer);
    answer_send(&answer);
    TEST_ASSERT_EQUAL_STRING(expected, sent);
}

static void refuses_on_the_ground_alone(bool (*refuses)(answer_t *answer), const char *expected)
{
    flight.state = FLIGHT_GROUND;
    TEST_ASSERT_TRUE(refuses(&answer));
    TEST_ASSERT_EQUAL_STRING(expected, sent);
    for (int state = FLIGHT_GROUND + 1; state < FLIGHT_STATE_COUNT; state++) {
        sent[0] = '\0';
        flight.state = (flight_state_t)state;
        TEST_ASSERT_FALSE(refuses(&answer));
        TEST_ASSERT_EQUAL_STRING("", sent);
    }
    sent[0] = '\0';
}

void test_two_mirrors_without_ground_are_refused_on_the_ground_alone(void)
{
    flight.mirrors.wrong = FORE | AFT;
    refuses_on_the_ground_alone(mirror_gate_refuses_arm, "ERR ARM two mirrors show no ground, see #MIRRORS");
    refuses_on_the_ground_alone(mirror_gate_refuses_reference,
                                "ERR ARM two mirrors show no ground, see #MIRRORS");
}

/* A pilot may take off with blocked mirrors, and hand over in the air. So the motors may be armed. */
void test_a_height_that_is_not_the_ground_s_refuses_a_reference_and_arms(void)
{
    flight.stands_high = true;
    refuses_on_the_ground_alone(mirror_gate_refuses_reference,
                                "ERR ARM height shows no ground: mirrors blocked, or past an edge");
    flight.state = FLIGHT_GROUND;
    TEST_ASSERT_FALSE(mirror_gate_refuses_arm(&answer));
    TEST_ASSERT_EQUAL_STRING("", sent);
    flight.mirrors.wrong = FORE | AFT; /* #MIRRORS tells more */
    refuses_on_the_ground_alone(mirror_gate_refuses_reference,
                                "ERR ARM two mirrors show no ground, see #MIRRORS");
}

void test_one_mirror_is_not_refused_but_remarked_upon(void)
{
    flight.mirrors.wrong = FRONT;
    TEST_ASSERT_FALSE(mirror_gate_refuses_reference(&answer));
    remark("OK ARM (mirror FRONT shows no ground, see #MIRRORS)");
    flight.state = FLIGHT_FLYING;
    remark("OK ARM");
}

void test_mirrors_that_show_the_ground_are_not_spoken_of(void)
{
    TEST_ASSERT_FALSE(mirror_gate_refuses_reference(&answer));
    remark("OK ARM");
}

static void names(uint16_t mirrors, const char *expected)
{
    answer_begin(&answer);
    telemetry_text(&answer.line, " ");
    mirror_gate_names(&answer, mirrors);
    answer_send(&answer);
    TEST_ASSERT_EQUAL_STRING(expected, sent);
}

void test_each_mirror_has_its_name(void)
{
    names(0U, "OK ARM -");
    names(FRONT, "OK ARM FRONT");
    names(FORE, "OK ARM FORE");
    names(AFT | FRONT, "OK ARM FRONT+AFT");
}
