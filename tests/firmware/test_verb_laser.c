/* `#LASER` with the real answer writer; port, server and radio are mocked. */
#include "firmware/verbs.h"

#include <stdio.h>
#include <string.h>

#include "mock_laser_port.h"
#include "mock_servers.h"
#include "mock_xbee_port.h"
#include "unity.h"

#define LINES 1U

static laser_statistics_t statistics;
static laser_sample_t laser;
static char sent[LINES][TELEMETRY_ANSWER_MAX + 1U];
static uint16_t sends;

static void radio(const telemetry_line_t *line, int calls)
{
    (void)calls;
    TEST_ASSERT_LESS_THAN(LINES, sends);
    TEST_ASSERT_FALSE(line->overflowed);
    (void)memcpy(sent[sends], line->text, line->length);
    sent[sends][line->length] = '\0';
    sends++;
}

static void look(laser_statistics_t *seen, int calls)
{
    (void)calls;
    *seen = statistics;
}

static void read(laser_sample_t *sample, int calls)
{
    (void)calls;
    *sample = laser;
}

void setUp(void)
{
    (void)memset(&statistics, 0, sizeof statistics);
    (void)memset(&laser, 0, sizeof laser);
    sends = 0U;
    laser_port_statistics_Stub(look);
    laser_server_read_Stub(read);
    xbee_port_answer_Stub(radio);
}

void tearDown(void) {}

static void ask(void)
{
    static telecommand_t command = {.name = "LASER", .name_length = 5U};
    answer_t answer = {.command = &command};

    sends = 0U;
    TEST_ASSERT_TRUE(verb_laser(&answer));
    TEST_ASSERT_EQUAL_UINT16(LINES, sends);
}

void test_before_the_first_octet_all_is_zero(void)
{
    laser.rate = 115200U;
    ask();
    TEST_ASSERT_EQUAL_STRING("OK LASER state:WAIT rate:115200 frames:0 timeout:0 restart:0 overrun:0 "
                             "framing:0 sum:0 length:0 echo:0 char:0 seq:0 last:-\r\n",
                             sent[0]);
}

void test_every_number_stands_in_its_own_field(void)
{
    laser.status = URG_OK;
    laser.rate = 250000U;
    laser.timeouts = 3U;
    laser.restarts = 4U;
    laser.seen.scan_count = 99U; /* older than the port's */
    statistics.urg.seen.scan_count = 731U;
    statistics.overruns = 5U;
    statistics.urg.seen.framing_count = 6U;
    statistics.urg.scip.damaged[SCIP_DAMAGE_NONE] = 77U;
    statistics.urg.scip.damaged[SCIP_DAMAGE_SUM] = 7U;
    statistics.urg.scip.damaged[SCIP_DAMAGE_LENGTH] = 8U;
    statistics.urg.scip.damaged[SCIP_DAMAGE_ECHO] = 9U;
    statistics.urg.scip.damaged[SCIP_DAMAGE_CHARACTER] = 10U;
    statistics.urg.scip.damaged[SCIP_DAMAGE_SEQUENCE] = 11U;
    statistics.urg.last_damage = SCIP_DAMAGE_ECHO;
    ask();
    TEST_ASSERT_EQUAL_STRING("OK LASER state:OK rate:250000 frames:731 timeout:3 restart:4 overrun:5 "
                             "framing:6 sum:7 length:8 echo:9 char:10 seq:11 last:echo\r\n",
                             sent[0]);
}

void test_every_cause_has_a_name_of_its_own(void)
{
    static const char *const names[SCIP_DAMAGE_COUNT] = {"-", "sum", "length", "echo", "char", "seq"};

    for (uint16_t cause = 0; cause < SCIP_DAMAGE_COUNT; cause++) {
        char end[16];

        (void)snprintf(end, sizeof end, " last:%s\r\n", names[cause]);
        statistics.urg.last_damage = (scip_damage_t)cause;
        ask();
        TEST_ASSERT_EQUAL_STRING(end, &sent[0][strlen(sent[0]) - strlen(end)]);
    }
}

void test_every_state_is_told_by_its_name(void)
{
    for (uint16_t status = 0; status < URG_STATUS_COUNT; status++) {
        char begin[32];

        (void)snprintf(begin, sizeof begin, "OK LASER state:%s rate:", urg_status_name((urg_status_t)status));
        laser.status = (urg_status_t)status;
        ask();
        TEST_ASSERT_EQUAL_STRING_LEN(begin, sent[0], strlen(begin));
    }
}

void test_of_a_sensor_that_is_too_old_it_says_what_to_do(void)
{
    laser.status = URG_OLD;
    laser.rate = 115200U;
    ask();
    TEST_ASSERT_EQUAL_STRING(
        "OK LASER state:OLD rate:115200 frames:0 timeout:0 restart:0 overrun:0 framing:0 "
        "do:update the sensor's firmware to 3.0 or later\r\n",
        sent[0]);
}

/* After the longest flight, on the worst cable. */
void test_the_largest_counts_fit(void)
{
    (void)memset(&statistics, 0xFF, sizeof statistics);
    (void)memset(&laser, 0xFF, sizeof laser);
    laser.status = URG_SWITCH;
    statistics.urg.last_damage = SCIP_DAMAGE_LENGTH;
    ask();
    TEST_ASSERT_EQUAL_STRING(
        "OK LASER state:SWITCH rate:4294967295 frames:4294967295 timeout:4294967295 "
        "restart:4294967295 overrun:4294967295 framing:4294967295 sum:4294967295 "
        "length:4294967295 echo:4294967295 char:4294967295 seq:4294967295 last:length\r\n",
        sent[0]);
}
