/* `#IMU`, `#IMU LEVEL`, `RIGHT`, `NOSE`: from frames to answers and parameters. */
#include <string.h>

#include "kernel.h"
#include "mock_servers.h"
#include "mock_xbee_port.h"
#include "firmware/imu_exchange.h"
#include "firmware/listing.h"
#include "firmware/verbs.h"
#include "unity.h"

#define DEG 0.017453293F

static parameters_t parameters;
static flight_outputs_t flight;
static char lines[8][TELEMETRY_ANSWER_MAX + 1U];
static uint16_t line_count, writes;

static void read_parameters(parameters_t *set, int calls)
{
    (void)calls;
    *set = parameters;
}

static void write_parameters(const parameters_t *set, int calls)
{
    (void)calls;
    parameters = *set;
    writes++;
}

static void read_flight(flight_outputs_t *status, int calls)
{
    (void)calls;
    *status = flight;
}

static void latest(imu_sample_t *sample, int calls)
{
    (void)calls;
    *sample = (imu_sample_t){.malformed = 7U};
}

static uint16_t history_count;
static bool history_ready;

static uint16_t history(imu_sample_t samples[IMU_HISTORY], int calls)
{
    (void)calls;
    samples[0] = (imu_sample_t){.ready = history_ready,
                                .median = {.roll_rad = -1.5F * DEG, .pitch_rad = 2.0F * DEG},
                                .has_acceleration = true,
                                .forward_mps2 = 0.15F,
                                .right_mps2 = -0.5F,
                                .down_mps2 = 9.73F};
    return history_count;
}

static void radio(const telemetry_line_t *line, int calls)
{
    (void)calls;
    TEST_ASSERT_FALSE(line->overflowed);
    TEST_ASSERT_LESS_THAN_UINT16(8U, line_count);
    (void)memcpy(lines[line_count], line->text, line->length);
    lines[line_count][line->length] = '\0';
    line_count++;
}

static bool spare(const telemetry_line_t *line, int calls)
{
    radio(line, calls);
    return true;
}

static void show(float roll_deg, float pitch_deg, bool accelerations, float z_counts)
{
    razor_text_t text = {.length = 0U};
    const char *const sent = "#A-C=4.00,-12.00,254.00\n#YPR=178.50,-1.17,0.00";
    const imu_raw_t raw = {.roll_rad = roll_deg * DEG,
                           .pitch_rad = pitch_deg * DEG,
                           .has_acceleration = accelerations,
                           .z_counts = z_counts};

    text.length = (uint16_t)strlen(sent);
    (void)memcpy(text.text, sent, text.length);
    imu_exchange_show(&text, RAZOR_OK, &raw, 1000000U);
    imu_exchange_show(&text, RAZOR_OK, &raw, 1020000U);
}

static void frames_go_on(void)
{
    TEST_ASSERT_EQUAL_UINT32(60, kernel.task.slept_ticks);
}

void setUp(void)
{
    kernel_reset();
    kernel.task.on_sleep = frames_go_on;
    parameters_init(&parameters);
    flight = (flight_outputs_t){.state = FLIGHT_GROUND};
    line_count = writes = 0U;
    history_count = 1U;
    history_ready = true;
    parameter_server_read_Stub(read_parameters);
    parameter_server_write_Stub(write_parameters);
    flight_status_server_read_Stub(read_flight);
    imu_server_history_Stub(history);
    imu_server_read_Stub(latest);
    xbee_port_answer_Stub(radio);
    xbee_port_spare_Stub(spare);
    show(1.0F, -1.0F, true, 254.0F);
}

void tearDown(void)
{
    kernel_check();
}

static bool type(const char *argument)
{
    telecommand_t command = {.name = "IMU", .name_length = 3U};
    answer_t answer = {.command = &command};

    (void)memcpy(command.argument, argument, strlen(argument));
    command.argument_length = (uint16_t)strlen(argument);
    line_count = 0U;
    return verb_imu(&answer);
}

static void assert_answer(const char *expected, const char *argument)
{
    TEST_ASSERT_EQUAL(strncmp(expected, "OK", 2U) == 0, type(argument));
    TEST_ASSERT_EQUAL_UINT16(1, line_count);
    TEST_ASSERT_EQUAL_STRING(expected, lines[0]);
}

void test_without_a_word_it_shows_what_comes_and_what_is_made_of_it(void)
{
    TEST_ASSERT_TRUE(type(""));
    TEST_ASSERT_FALSE(listing_more());
    TEST_ASSERT_EQUAL_UINT16(4, line_count);
    TEST_ASSERT_EQUAL_STRING("OK IMU raw:#A-C=4.00,-12.00,254.00|#YPR=178.50,-1.17,0.00\r\n", lines[0]);
    TEST_ASSERT_EQUAL_STRING("OK IMU roll_deg:-1.5 pitch_deg:2.0 forward:0.15 right:-0.50 down:9.73\r\n",
                             lines[1]);
    TEST_ASSERT_EQUAL_STRING_LEN("OK IMU seen:accelerations+angles period_ms:20 frames:", lines[2], 53);
    TEST_ASSERT_NOT_NULL(strstr(lines[2], " refused:7 IAXES:"));
    TEST_ASSERT_EQUAL_STRING("OK IMU END lines:3\r\n", lines[3]);
}

void test_before_the_offset_is_known_there_are_no_angles(void)
{
    history_ready = false;
    TEST_ASSERT_TRUE(type(""));
    TEST_ASSERT_FALSE(listing_more());
    TEST_ASSERT_EQUAL_STRING("OK IMU not level yet\r\n", lines[1]);
    history_ready = true;
    history_count = 0U;
    TEST_ASSERT_TRUE(type(""));
    TEST_ASSERT_FALSE(listing_more());
    TEST_ASSERT_EQUAL_STRING("OK IMU not level yet\r\n", lines[1]);
}

void test_what_is_no_letter_is_shown_as_a_bar_and_the_period_is_rounded(void)
{
    razor_text_t text = {.length = 4U, .text = " ~\x7f\x1f"};
    const imu_raw_t raw = {.has_acceleration = false};

    imu_exchange_show(&text, RAZOR_OK, &raw, 3000000U);
    imu_exchange_show(&text, RAZOR_OK, &raw, 3020500U);
    TEST_ASSERT_TRUE(type(""));
    TEST_ASSERT_FALSE(listing_more());
    TEST_ASSERT_EQUAL_STRING("OK IMU raw: ~||\r\n", lines[0]);
    TEST_ASSERT_NOT_NULL(strstr(lines[2], " period_ms:21 "));
}

static void spike_in_the_last_frame(void)
{
    static uint16_t looks;

    looks++;
    if (looks % 3U == 2U) {
        show(-45.0F, 40.0F, true, 10.0F);
    }
}

void test_a_spike_among_three_frames_is_not_looked_at(void)
{
    kernel.task.on_sleep = spike_in_the_last_frame;
    assert_answer("OK IMU LEVEL IUNIT:256.00 IDOWN:Z\r\n", "LEVEL");
    show(21.0F, -1.0F, true, 240.0F);
    assert_answer("OK IMU RIGHT IROLL:ROLL IAXES:ASSUMED\r\n", "RIGHT");
}

void test_axes_that_were_typed_as_proved_stay_so_while_a_side_shows_the_same(void)
{
    (void)type("LEVEL");
    parameters.value[PARAMETER_IROLL] = (float)AXIS_ROLL;
    parameters.value[PARAMETER_IPITCH] = (float)AXIS_MINUS_ROLL; /* never found by these tests */
    parameters.value[PARAMETER_IAXES] = (float)AXES_PROVED;
    show(21.0F, 0.0F, true, 240.0F);
    assert_answer("OK IMU RIGHT IROLL:ROLL IAXES:PROVED\r\n", "RIGHT");
    show(-21.0F, 0.0F, true, 240.0F);
    assert_answer("OK IMU RIGHT IROLL:-ROLL IAXES:ASSUMED\r\n", "RIGHT");
}

void test_level_right_and_nose_find_what_they_say(void)
{
    assert_answer("OK IMU LEVEL IUNIT:256.00 IDOWN:Z\r\n", "LEVEL");
    show(21.0F, 0.0F, true, 240.0F);
    assert_answer("OK IMU RIGHT IROLL:ROLL IAXES:ASSUMED\r\n", "right");
    TEST_ASSERT_EQUAL_UINT16(AXIS_ROLL, parameters_choice(&parameters, PARAMETER_IROLL));
    show(2.0F, -21.0F, true, 240.0F);
    assert_answer("OK IMU NOSE IPITCH:-PITCH IAXES:PROVED\r\n", "NOSE");
    TEST_ASSERT_EQUAL_UINT16(AXIS_MINUS_PITCH, parameters_choice(&parameters, PARAMETER_IPITCH));
    TEST_ASSERT_EQUAL_UINT16(3, writes);
}

void test_axes_once_proved_stay_proved_until_they_are_others(void)
{
    (void)type("LEVEL");
    show(-21.0F, 0.0F, true, 240.0F);
    (void)type("RIGHT");
    show(2.0F, 21.0F, true, 240.0F);
    assert_answer("OK IMU NOSE IPITCH:PITCH IAXES:PROVED\r\n", "NOSE");
    assert_answer("OK IMU NOSE IPITCH:PITCH IAXES:PROVED\r\n", "NOSE");
    parameters.value[PARAMETER_IROLL] = (float)AXIS_ROLL; /* as typed */
    parameters.value[PARAMETER_IAXES] = (float)AXES_ASSUMED;
    assert_answer("OK IMU NOSE IPITCH:PITCH IAXES:ASSUMED\r\n", "NOSE");
    show(-21.0F, 0.0F, true, 240.0F);
    assert_answer("OK IMU RIGHT IROLL:-ROLL IAXES:PROVED\r\n", "RIGHT");
}

void test_in_the_hand_it_floats_and_may_find_and_armed_it_may_not(void)
{
    flight = (flight_outputs_t){.state = FLIGHT_FLOATING, .thrust_n = 6.5F};
    assert_answer("OK IMU LEVEL IUNIT:256.00 IDOWN:Z\r\n", "LEVEL");
    flight.idle_n = 1.76F;
    assert_answer("ERR IMU needs thrust 0 and no reference\r\n", "LEVEL");
    flight = (flight_outputs_t){.state = FLIGHT_DESCENDING, .thrust_n = 6.5F};
    assert_answer("ERR IMU needs thrust 0 and no reference\r\n", "LEVEL");
}

void test_level_says_when_there_are_no_accelerations_or_strange_ones(void)
{
    show(0.0F, 0.0F, false, 0.0F);
    assert_answer("OK IMU LEVEL no accelerations\r\n", "LEVEL");
    show(0.0F, 0.0F, true, 128.0F);
    assert_answer("OK IMU LEVEL accelerations in no known unit\r\n", "LEVEL");
    TEST_ASSERT_EQUAL_UINT16(0, writes);
    show(0.0F, 0.0F, true, -9.5F);
    assert_answer("OK IMU LEVEL IUNIT:9.81 IDOWN:-Z\r\n", "LEVEL");
}

void test_an_unclear_tilt_is_refused_and_sets_nothing(void)
{
    (void)type("LEVEL");
    writes = 0U;
    assert_answer("ERR IMU tilt by 8..60 deg about one axis\r\n", "RIGHT");
    show(21.0F, 19.0F, true, 240.0F);
    assert_answer("ERR IMU tilt by 8..60 deg about one axis\r\n", "NOSE");
    TEST_ASSERT_EQUAL_UINT16(0, writes);
}

void test_with_thrust_or_a_reference_or_another_word_it_is_refused(void)
{
    assert_answer("ERR IMU one of LEVEL|RIGHT|NOSE\r\n", "LEFT");
    flight.thrust_n = 1.764F;
    assert_answer("ERR IMU needs thrust 0 and no reference\r\n", "RIGHT");
    flight.thrust_n = 0.0F;
    flight.reference_m = 0.0005F;
    assert_answer("ERR IMU needs thrust 0 and no reference\r\n", "LEVEL");
    flight = (flight_outputs_t){.state = FLIGHT_GROUND, .idle_n = 0.0005F};
    assert_answer("ERR IMU needs thrust 0 and no reference\r\n", "LEVEL");
    flight = (flight_outputs_t){.state = FLIGHT_GROUND, .thrust_n = 0.0005F};
    assert_answer("ERR IMU needs thrust 0 and no reference\r\n", "LEVEL");
    TEST_ASSERT_EQUAL_UINT16(0, writes);
}

void test_the_list_shows_whether_the_axes_are_proved_now(void)
{
    for (int i = 0; i < 4; i++) {
        parameters.value[PARAMETER_IAXES] = (float)((i % 2 == 0) ? AXES_PROVED : AXES_ASSUMED);
        TEST_ASSERT_TRUE(type(""));
        TEST_ASSERT_FALSE(listing_more());
        TEST_ASSERT_NOT_NULL(strstr(lines[2], (i % 2 == 0) ? " IAXES:PROVED " : " IAXES:ASSUMED "));
    }
}

static float spike_x, spike_y;

static void spike_aside(void)
{
    static uint16_t looks;
    const razor_text_t text = {.length = 0U};
    imu_raw_t raw = {.has_acceleration = true, .z_counts = 254.0F};

    looks++;
    if (looks % 3U == 2U) {
        raw.x_counts = spike_x;
        raw.y_counts = spike_y;
    }
    imu_exchange_show(&text, RAZOR_OK, &raw, 1040000U);
}

/* A side as large as gravity is no level: a spike of it in one frame of three is not looked at. */
void test_a_spike_to_the_side_is_not_looked_at_either(void)
{
    kernel.task.on_sleep = spike_aside;
    spike_x = 250.0F;
    assert_answer("OK IMU LEVEL IUNIT:256.00 IDOWN:Z\r\n", "LEVEL");
    spike_x = 0.0F;
    spike_y = -250.0F;
    assert_answer("OK IMU LEVEL IUNIT:256.00 IDOWN:Z\r\n", "LEVEL");
}

void test_one_letter_is_a_word_too(void)
{
    assert_answer("ERR IMU one of LEVEL|RIGHT|NOSE\r\n", "L");
}
