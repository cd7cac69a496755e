/* `#CALIBRATE` and its reports; the calibrator is mocked. */
#include <string.h>

#include "mock_calibrator.h"
#include "mock_ground.h"
#include "mock_servers.h"
#include "mock_xbee_port.h"
#include "unity.h"
#include "firmware/verbs.h"

static parameters_t parameters;
static calibration_t progress;
static uint16_t sequence;
static uint16_t counts, seconds;
static uint16_t starts;
static uint16_t answers;
static char last[TELEMETRY_ANSWER_MAX + 1U];
static bool idle;

static void read_parameters(parameters_t *set, int calls)
{
    (void)calls;
    *set = parameters;
}

static uint16_t start(float idle_percent, uint16_t step_counts, uint16_t period_s, int calls)
{
    TEST_ASSERT_EQUAL_FLOAT(15.0F, idle_percent);
    (void)calls;
    counts = step_counts;
    seconds = period_s;
    starts++;
    return ++sequence;
}

static void look(calibration_t *out, int calls)
{
    (void)calls;
    *out = progress;
}

static void radio(const telemetry_line_t *line, int calls)
{
    (void)calls;
    TEST_ASSERT_FALSE(line->overflowed);
    memcpy(last, line->text, line->length);
    last[line->length] = '\0';
    answers++;
}

static bool on_ground(int calls)
{
    (void)calls;
    return idle;
}

void setUp(void)
{
    parameters_init(&parameters);
    parameters.value[PARAMETER_LINK] = 5.0F;
    starts = answers = 0U;
    sequence = 0xFFFEU; /* wraps during the tests */
    progress = (calibration_t){.end = CALIBRATION_NONE, .sequence = 0xFFFEU};
    idle = true;
    parameter_server_read_Stub(read_parameters);
    calibrator_start_Stub(start);
    calibrator_look_Stub(look);
    ground_waits_Stub(on_ground);
    xbee_port_answer_Stub(radio);
}

static void end_it(calibration_end_t end)
{
    progress.sequence = sequence;
    progress.end = end;
    (void)verb_calibrate_more();
}

void tearDown(void)
{
    end_it(CALIBRATION_STOPPED);
}

static bool type(const char *argument)
{
    telecommand_t command = {.name = "CALIBRATE", .name_length = 9U};
    answer_t answer = {.command = &command};

    memcpy(command.argument, argument, strlen(argument));
    command.argument_length = (uint16_t)strlen(argument);
    answers = 0U;
    return verb_calibrate(&answer);
}

static void assert_last(const char *expected)
{
    TEST_ASSERT_EQUAL_UINT16(1, answers);
    TEST_ASSERT_EQUAL_STRING(expected, last);
    answers = 0U;
}

void test_without_numbers_it_goes_as_the_seed_did(void)
{
    TEST_ASSERT_TRUE(type(""));
    TEST_ASSERT_EQUAL_UINT16(30, counts);
    TEST_ASSERT_EQUAL_UINT16(5, seconds);
    assert_last("OK CALIBRATE counts:30 seconds:5\r\n");
}

void test_counts_and_seconds_may_be_given(void)
{
    TEST_ASSERT_TRUE(type("60"));
    assert_last("OK CALIBRATE counts:60 seconds:5\r\n");
    TEST_ASSERT_TRUE(type("1  60"));
    TEST_ASSERT_EQUAL_UINT16(1, counts);
    TEST_ASSERT_EQUAL_UINT16(60, seconds);
    TEST_ASSERT_TRUE(type("200\t1"));
    TEST_ASSERT_EQUAL_UINT16(200, counts);
    TEST_ASSERT_EQUAL_UINT16(1, seconds);
}

void test_numbers_that_are_none_or_too_large_are_refused(void)
{
    static const char *const wrong[] = {"0",      "201", "-1",   "30.5",   "30 0", "30 61",
                                        "30 1.5", "x",   "30 x", "30 5 1", "nan"};

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(type(wrong[i]), wrong[i]);
        assert_last("ERR CALIBRATE 1..200 counts, 1..60 s\r\n");
    }
    TEST_ASSERT_EQUAL_UINT16(0, starts);
}

void test_it_starts_on_the_ground_with_an_armed_link_only(void)
{
    idle = false;
    TEST_ASSERT_FALSE(type(""));
    assert_last("ERR CALIBRATE not on the ground\r\n");
    idle = true;
    parameters.value[PARAMETER_LINK] = 0.0F;
    TEST_ASSERT_FALSE(type(""));
    assert_last("ERR CALIBRATE link not armed, see #LINK\r\n");
    TEST_ASSERT_EQUAL_UINT16(0, starts);
    TEST_ASSERT_FALSE(verb_calibrate_more());
}

void test_each_step_is_reported_once(void)
{
    (void)type("");
    answers = 0U;
    TEST_ASSERT_TRUE_MESSAGE(verb_calibrate_more(), "TaskControl has not seen it yet");
    TEST_ASSERT_EQUAL_UINT16(0, answers);
    progress = (calibration_t){CALIBRATION_RUNNING, 1U, 4136U, 0.1693F, sequence, 0U, 0U};
    TEST_ASSERT_TRUE(verb_calibrate_more());
    assert_last("OK CALIBRATE thr:0.17 compare:4136\r\n");
    TEST_ASSERT_TRUE(verb_calibrate_more());
    TEST_ASSERT_EQUAL_UINT16(0, answers);
    progress.steps = 41U;
    progress.compare_counts = 2936U;
    progress.thrust_n = 6.941F;
    TEST_ASSERT_TRUE(verb_calibrate_more());
    assert_last("OK CALIBRATE thr:6.94 compare:2936\r\n");
}

void test_the_end_is_reported_once_with_its_reason_and_the_last_thrust(void)
{
    static const struct {
        calibration_end_t end;
        const char *expected;
    } rows[] = {{CALIBRATION_STOPPED, "OK CALIBRATE end:COMMAND thr:6.94 compare:2936 grav:6.94\r\n"},
                {CALIBRATION_LIMIT, "OK CALIBRATE end:LIMIT thr:6.94 compare:2936\r\n"},
                {CALIBRATION_LINK, "OK CALIBRATE end:LINK thr:6.94 compare:2936\r\n"},
                {CALIBRATION_LIFTED, "OK CALIBRATE end:HEIGHT thr:6.94 compare:2936\r\n"},
                {CALIBRATION_STATE, "OK CALIBRATE end:STATE thr:6.94 compare:2936\r\n"}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        (void)type("");
        answers = 0U;
        progress = (calibration_t){rows[i].end, 41U, 2936U, 6.941F, sequence, 0U, 0U};
        TEST_ASSERT_FALSE(verb_calibrate_more());
        assert_last(rows[i].expected);
        TEST_ASSERT_FALSE(verb_calibrate_more());
        TEST_ASSERT_EQUAL_UINT16(0, answers);
    }
}
