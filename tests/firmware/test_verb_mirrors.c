/* `#MIRRORS` with the real answer writer; servers and radio are mocked. */
#include <math.h>
#include <string.h>

#include "firmware/verbs.h"
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
    parameters.value[PARAMETER_LAYOUT] = (float)LAYOUT_THREE;
    flight_status_server_read_Stub(flight_read);
    parameter_server_read_Stub(parameters_read);
    xbee_port_answer_Stub(radio);
}

void tearDown(void) {}

static void expect(const char *text)
{
    static telecommand_t command = {.name = "MIRRORS", .name_length = 7U};
    answer_t answer = {.command = &command};

    TEST_ASSERT_TRUE(verb_mirrors(&answer));
    TEST_ASSERT_EQUAL_STRING(text, sent);
}

void test_before_the_first_scan_nothing_is_known(void)
{
    expect(
        "OK MIRRORS front_mm:- fore_mm:- aft_mm:- wrong:- imu_roll_off_deg:- imu_pitch_off_deg:- imu:-\r\n");
}

void test_it_tells_what_each_mirror_showed_and_what_they_tell_of_the_imu(void)
{
    flight.mirrors = (flight_mirrors_t){
        .rest_mm = {[MIRROR_FRONT] = 2.4F, [MIRROR_FORE] = 411.7F, [MIRROR_AFT] = -3.0F},
        .wrong = 1U << MIRROR_FORE,
        .imu = IMU_OFFSET,
        .off_roll_rad = -0.0524F,
        .off_pitch_rad = 0.0017F};
    expect(
        "OK MIRRORS front_mm:2 fore_mm:412 aft_mm:-3 wrong:FORE imu_roll_off_deg:-3.0 imu_pitch_off_deg:0.1 "
        "imu:OFFSET\r\n");
}

void test_with_another_layout_it_says_how_to_ask_for_it(void)
{
    parameters.value[PARAMETER_LAYOUT] = (float)LAYOUT_TWO;
    expect("OK MIRRORS OFF (#LAYOUT THREE)\r\n");
}
