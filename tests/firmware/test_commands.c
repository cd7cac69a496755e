/* Operator's lines from their octets to the servers and the answers; parser, parameter table and texts are
 * real, the servers, the verbs of other files and the radio are mocked. */
#include "firmware/commands.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "drivers/decimal.h"
#include "kernel.h"
#include "mock_calibrator.h"
#include "mock_ground.h"
#include "mock_servers.h"
#include "mock_timebase.h"
#include "mock_verbs.h"
#include "mock_xbee_port.h"
#include "firmware/listing.h"
#include "firmware/version.h"
#include "unity.h"

#define ANSWERS_MAX 80U
#define ARRIVAL_US 123456U

static parameters_t parameters;
static reference_sample_t reference;
static uint16_t parameter_writes;
static uint16_t reference_writes;
static char answers[ANSWERS_MAX][TELEMETRY_ANSWER_MAX + 1U];
static uint16_t answered;

static void parameters_read(parameters_t *set, int calls)
{
    (void)calls;
    *set = parameters;
}

static void parameters_write(const parameters_t *set, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, answered, "answered before it was done");
    parameters = *set;
    parameter_writes++;
}

static void reference_read(reference_sample_t *sample, int calls)
{
    (void)calls;
    *sample = reference;
}

static void reference_write(const reference_sample_t *sample, int calls)
{
    (void)calls;
    reference = *sample;
    reference_writes++;
}

/* Every answer, whatever it says, is one line that begins with its verdict. */
static void answer(const telemetry_line_t *line, int calls)
{
    char *text = answers[answered];

    (void)calls;
    TEST_ASSERT_LESS_THAN(ANSWERS_MAX, answered);
    TEST_ASSERT_FALSE_MESSAGE(line->overflowed, "the answer does not fit");
    TEST_ASSERT_LESS_OR_EQUAL_UINT16(TELEMETRY_ANSWER_MAX, line->length);
    TEST_ASSERT_GREATER_THAN_UINT16(2, line->length);
    (void)memcpy(text, line->text, line->length);
    text[line->length] = '\0';
    TEST_ASSERT_EQUAL_STRING("\r\n", &text[line->length - 2U]);
    text[line->length - 2U] = '\0';
    TEST_ASSERT_NULL(strpbrk(text, "\r\n"));
    TEST_ASSERT_TRUE_MESSAGE(strncmp(text, "OK ", 3) == 0 || strncmp(text, "ERR ", 4) == 0, text);
    answered++;
}

static bool spare(const telemetry_line_t *line, int calls)
{
    answer(line, calls);
    return true;
}

static bool on_ground;

static bool ground(int calls)
{
    (void)calls;
    return on_ground;
}

static bool in_the_air;

static bool left(int calls)
{
    (void)calls;
    return in_the_air;
}

static uint16_t stops; /* of a hover calibration */

static void stop(int calls)
{
    (void)calls;
    stops++;
}

static flight_outputs_t flight;

static void flight_read(flight_outputs_t *outputs, int calls)
{
    (void)calls;
    *outputs = flight;
}

static bool overtaken;
static uint32_t arrival_us;

void setUp(void)
{
    kernel_reset();
    parameters_init(&parameters);
    reference = (reference_sample_t){
        .reference_m = 0.0F, .sequence = 7U, .link_time_us = 11U, .link_sequence = 40U};
    parameter_writes = reference_writes = answered = 0U;
    parameters.value[PARAMETER_IAXES] = (float)AXES_PROVED;
    flight = (flight_outputs_t){.state = FLIGHT_GROUND};
    flight_status_server_read_Stub(flight_read);
    parameter_server_read_Stub(parameters_read);
    parameter_server_write_Stub(parameters_write);
    reference_server_read_Stub(reference_read);
    reference_server_write_Stub(reference_write);
    xbee_port_answer_Stub(answer);
    xbee_port_spare_Stub(spare);
    overtaken = false;
    arrival_us = ARRIVAL_US;
    calibrator_stop_Stub(stop);
    ground_waits_Stub(ground);
    ground_left_Stub(left);
    on_ground = true;
    in_the_air = false;
    stops = 0U;
}

void tearDown(void)
{
    kernel_check();
}

static void execute(const telecommand_line_t *line)
{
    const xbee_message_t message = {.line = *line, .arrival_us = arrival_us, .overtaken = overtaken};

    commands_execute(&message);
    TEST_ASSERT_FALSE(listing_more());
}

/* The characters of one line, without its end, as they come from the radio. */
static void type_characters(const char *text, size_t length)
{
    telecommand_collector_t collector;

    telecommand_collector_init(&collector);
    answered = 0U;
    for (size_t i = 0; i < length; i++) {
        TEST_ASSERT_FALSE(telecommand_collect(&collector, octet_of((uint16_t)text[i])));
    }
    TEST_ASSERT_TRUE(telecommand_collect(&collector, '\n'));
    execute(&collector.line);
}

static void type(const char *text)
{
    type_characters(text, strlen(text));
}

static void assert_answer(const char *expected, const char *line)
{
    type(line);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, answers[0], line);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(1, answered, line);
}

/* A refusal leaves everything as it is, the link's life sign included. */
static void assert_refused(const char *expected, const char *line)
{
    const parameters_t parameters_before = parameters;
    const reference_sample_t reference_before = reference;

    parameter_writes = reference_writes = 0U;
    assert_answer(expected, line);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, parameter_writes, line);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, reference_writes, line);
    TEST_ASSERT_EQUAL_MEMORY(&parameters_before, &parameters, sizeof parameters);
    TEST_ASSERT_EQUAL_MEMORY(&reference_before, &reference, sizeof reference);
}

void test_a_parameter_is_set_written_once_and_answered_with_its_value(void)
{
    assert_answer("OK KP 0.02 (LAW EST does not use it)", "#KP 0.02");
    TEST_ASSERT_EQUAL_FLOAT(0.02F, parameters.value[PARAMETER_KP]);
    TEST_ASSERT_EQUAL_UINT32(1, parameters.generation);
    TEST_ASSERT_EQUAL_UINT16(1, parameter_writes);
}

void test_only_the_named_parameter_changes(void)
{
    parameters_t expected;

    for (uint16_t id = PARAMETER_KP; id < PARAMETER_LAW; id++) {
        char line[40];
        char text[80];

        expected = parameters;
        expected.value[id] = 0.5F;
        expected.generation++;
        (void)snprintf(line, sizeof line, "#%s 0.5", parameter_table[id].name);
        (void)snprintf(text, sizeof text, "OK %s 0.5%s", parameter_table[id].name,
                       parameter_is_used((parameter_id_t)id, LAW_EST) ? "" : " (LAW EST does not use it)");
        assert_answer(text, line);
        TEST_ASSERT_EQUAL_MEMORY(&expected, &parameters, sizeof expected);
    }
}

void test_the_reference_goes_to_its_own_server_with_the_next_sequence(void)
{
    const parameters_t before = parameters;

    assert_answer("OK SETR 0.6", "#SETR 0.6");
    TEST_ASSERT_EQUAL_FLOAT(0.6F, reference.reference_m);
    TEST_ASSERT_EQUAL_UINT32(8, reference.sequence);
    TEST_ASSERT_EQUAL_UINT16(0, parameter_writes);
    TEST_ASSERT_EQUAL_MEMORY(&before, &parameters, sizeof before);
    assert_answer("OK SETR 0", "#SETR 0");
    TEST_ASSERT_EQUAL_FLOAT(0.0F, reference.reference_m);
    TEST_ASSERT_EQUAL_UINT32(9, reference.sequence);
}

void test_the_same_reference_again_is_a_new_command(void)
{
    assert_answer("OK SETR 0.6", "#SETR 0.6");
    assert_answer("OK SETR 0.6", "#SETR 0.6");
    TEST_ASSERT_EQUAL_UINT32(9, reference.sequence);
}

void test_a_reference_of_minus_zero_is_zero(void)
{
    assert_answer("OK SETR 0", "#SETR -0");
    TEST_ASSERT_FALSE(signbit(reference.reference_m));
}

void test_the_limits_themselves_are_accepted_and_the_next_number_is_not(void)
{
    for (uint16_t id = 0; id < PARAMETER_COUNT; id++) {
        const parameter_row_t *row = &parameter_table[id];
        char line[TELECOMMAND_LINE_MAX + 1U];
        char text[TELEMETRY_LINE_MAX];
        const float limits[2] = {row->minimum, row->maximum};

        if (row->choices != NULL) {
            continue;
        }
        for (uint16_t i = 0; i < 2U; i++) {
            (void)snprintf(line, sizeof line, "#%s %.9g", row->name, (double)limits[i]);
            type(line);
            TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE("OK ", answers[0], 3, line);
        }
        (void)snprintf(text, sizeof text, "ERR %s out of range %.4g..%.4g %s", row->name,
                       (double)row->minimum, (double)row->maximum, row->unit);
        (void)snprintf(line, sizeof line, "#%s %.9g", row->name, (double)nextafterf(row->maximum, INFINITY));
        assert_refused(text, line);
        (void)snprintf(line, sizeof line, "#%s %.9g", row->name,
                       (double)nextafterf(row->minimum, -1.0F) - 1e-6);
        assert_refused(text, line);
        (void)snprintf(line, sizeof line, "#%s 1e9", row->name);
        assert_refused(text, line);
    }
}

void test_the_limits_are_told_with_their_unit(void)
{
    assert_refused("ERR SETR out of range 0..3 m", "#SETR -1");
    assert_refused("ERR SETR out of range 0..3 m", "#SETR 3.001");
    assert_refused("ERR KP out of range 0..1 N/mm", "#KP 1e9");
    assert_refused("ERR USAT out of range 0..11.76 N", "#USAT 12");
    assert_refused("ERR LINK out of range 0..60 s", "#LINK 61");
}

void test_a_choice_is_set_by_its_name_in_either_case_and_answered_by_it(void)
{
    assert_answer("OK LAW PD", "#LAW PD");
    TEST_ASSERT_EQUAL_FLOAT((float)LAW_PD, parameters.value[PARAMETER_LAW]);
    assert_answer("OK KI 0.01 (LAW PD does not use it)", "#KI 0.01");
    assert_answer("OK KP 0.015", "#KP 0.015");
    assert_answer("OK PKI 1 (LAW PD does not use it)", "#PKI 1");
    assert_answer("OK LAW PID", "#law pid");
    TEST_ASSERT_EQUAL_FLOAT((float)LAW_PID, parameters.value[PARAMETER_LAW]);
    assert_answer("OK RELEASE SCAN", "#RELEASE scan");
    TEST_ASSERT_EQUAL_FLOAT((float)RELEASE_SCAN, parameters.value[PARAMETER_RELEASE]);
    assert_answer("OK RELEASE FREE", "#Release Free");
    TEST_ASSERT_EQUAL_FLOAT((float)RELEASE_FREE, parameters.value[PARAMETER_RELEASE]);
    TEST_ASSERT_EQUAL_UINT16(7, parameter_writes);
}

void test_a_choice_by_another_name_or_by_number_is_refused_with_the_list(void)
{
    assert_refused("ERR LAW one of PD|PID|PIDT|EST", "#LAW ESTX");
    assert_refused("ERR LAW one of PD|PID|PIDT|EST", "#LAW 1");
    assert_refused("ERR LAW one of PD|PID|PIDT|EST", "#LAW P");
    assert_refused("ERR LAW one of PD|PID|PIDT|EST", "#LAW PIDD");
    assert_refused("ERR RELEASE one of FREE|SCAN", "#RELEASE 0");
}

void test_what_is_no_number_is_refused(void)
{
    static const char *const bad[] = {"nan", "inf", "-inf", "0x1", "1,5",  "1.5m", "0.6 0.7",
                                      "--1", "1e",  ".",    "+",   "1e99", "six"};

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char line[TELECOMMAND_LINE_MAX + 1U];

        (void)snprintf(line, sizeof line, "#SETR %s", bad[i]);
        assert_refused("ERR SETR not a number", line);
        (void)snprintf(line, sizeof line, "#KP %s", bad[i]);
        assert_refused("ERR KP not a number", line);
    }
}

void test_a_missing_value_is_refused(void)
{
    assert_refused("ERR KP value missing", "#KP");
    assert_refused("ERR KP value missing", "#KP   ");
    assert_refused("ERR SETR value missing", "#SETR");
    assert_refused("ERR LAW value missing", "#LAW");
}

void test_an_unknown_command_is_refused_by_the_name_as_far_as_it_is_kept(void)
{
    assert_refused("ERR FLY unknown command, try #HELP", "#FLY 1");
    assert_refused("ERR GE unknown command, try #HELP", "#GE");
    assert_refused("ERR GETS unknown command, try #HELP", "#GETS KP");
    assert_refused("ERR KPP unknown command, try #HELP", "#KPP 0.1");
    assert_refused("ERR ABCDEFGHIJKL unknown command, try #HELP", "#ABCDEFGHIJKLMNOP 1");
    assert_refused("ERR A unknown command, try #HELP", "#A");
}

void test_lines_that_are_no_command_are_refused_with_their_reason(void)
{
    assert_refused("ERR - empty command", "#");
    assert_refused("ERR - empty command", "#   \t ");
    assert_refused("ERR - line too long", "#PING 123456789 123456789 1234567");
    assert_refused("ERR - line too long", "#SETR 0.600000000000000000000000000000000000");
    assert_refused("ERR - bad character", "#KP\x01 0.1");
    assert_refused("ERR - bad character", "#SETR \xE9");
    assert_refused("ERR - bad character", "#KP=0.1");
}

void test_get_of_one_parameter_answers_its_value(void)
{
    parameters.value[PARAMETER_KI] = 0.0125F;
    reference.reference_m = 0.45F;
    assert_answer("OK KP 0.015", "#GET KP");
    assert_answer("OK KI 0.0125", "#get ki");
    assert_answer("OK LAW EST", "#GET LAW");
    assert_answer("OK RELEASE FREE", "#GET  release ");
    assert_answer("OK SETR 0.45", "#GET SETR"); /* the reference server's, not the table's */
    TEST_ASSERT_EQUAL_UINT16(0, parameter_writes);
    TEST_ASSERT_EQUAL_UINT32(7, reference.sequence);
}

void test_get_of_an_unknown_parameter_is_refused(void)
{
    assert_refused("ERR GET unknown parameter", "#GET K");
    assert_refused("ERR GET unknown parameter", "#GET PING");
    assert_refused("ERR GET unknown parameter", "#GET KP KD");
}

static void assert_end(const char *format, unsigned lines)
{
    char expected[64];

    (void)snprintf(expected, sizeof expected, format, lines);
    TEST_ASSERT_EQUAL_STRING(expected, answers[answered - 1U]);
}

void test_get_alone_answers_one_line_per_parameter_in_the_tables_order_and_their_number(void)
{
    reference.reference_m = 1.25F;
    type("#GET");
    TEST_ASSERT_EQUAL_UINT16(PARAMETER_COUNT + 2U, answered);
    assert_end("OK GET END lines:%u", PARAMETER_COUNT + 1U);
    TEST_ASSERT_EQUAL_STRING("OK SETR 1.25", answers[0]);
    TEST_ASSERT_EQUAL_STRING("OK GRAV 7", answers[1U + PARAMETER_GRAV]);
    TEST_ASSERT_EQUAL_STRING("OK LAW EST", answers[1U + PARAMETER_LAW]);
    for (uint16_t id = 0; id < PARAMETER_COUNT; id++) {
        const size_t length = strlen(parameter_table[id].name);

        TEST_ASSERT_EQUAL_STRING_LEN(parameter_table[id].name, &answers[1U + id][3], length);
        TEST_ASSERT_EQUAL_INT(' ', answers[1U + id][3U + length]);
    }
}

void test_every_answer_of_get_can_be_typed_back_as_a_command(void)
{
    static char told[ANSWERS_MAX][TELEMETRY_ANSWER_MAX + 1U];
    parameters_t before;

    parameters.value[PARAMETER_KP] = 0.0123456F;
    parameters.value[PARAMETER_LAW] = (float)LAW_PD;
    reference.reference_m = 0.333333F;
    before = parameters;
    type("#GET");
    (void)memcpy(told, answers, sizeof told);
    for (uint16_t i = 0; i <= PARAMETER_COUNT; i++) {
        char line[TELEMETRY_ANSWER_MAX + 2U];

        (void)snprintf(line, sizeof line, "#%s", &told[i][3]);
        type(line);
        TEST_ASSERT_EQUAL_UINT16(1, answered);
        TEST_ASSERT_EQUAL_STRING_LEN(told[i], answers[0], strlen(told[i]));
    }
    TEST_ASSERT_EQUAL_MEMORY(before.value, parameters.value, sizeof before.value);
    TEST_ASSERT_EQUAL_FLOAT(0.333333F, reference.reference_m);
}

void test_ping_answers_its_own_text(void)
{
    assert_answer("OK PING 17", "#PING 17");
    assert_answer("OK PING", "#PING");
    assert_answer("OK PING Are you  there?", "#ping Are you  there? ");
    assert_answer("OK PING 12345678901234567890123456",
                  "#PING 12345678901234567890123456"); /* 32 characters */
    TEST_ASSERT_EQUAL_UINT16(0, parameter_writes);
}

void test_version_answers_three_numbers(void)
{
    unsigned major, minor, patch;
    int end = 0;

    type("#VERSION");
    TEST_ASSERT_EQUAL_INT(3, sscanf(answers[0], "OK VERSION %u.%u.%u%n", &major, &minor, &patch, &end));
    TEST_ASSERT_EQUAL_STRING("", &answers[0][end]);
    assert_answer("OK VERSION " PLOMADA_VERSION, "#version");
    assert_refused("ERR VERSION takes no value", "#VERSION 2");
    assert_refused("ERR ARM takes no value", "#ARM off");
    assert_refused("ERR SAVE takes no value", "#SAVE KP");
}

void test_help_tells_every_parameter_and_every_verb_with_limits_and_meaning(void)
{
    type("#HELP");
    TEST_ASSERT_GREATER_THAN_UINT16(PARAMETER_COUNT + 3U, answered);
    for (uint16_t id = 0; id < PARAMETER_COUNT; id++) {
        char begin[32];
        char end[TELEMETRY_LINE_MAX];
        const size_t length = strlen(answers[id]);

        (void)snprintf(begin, sizeof begin, "OK HELP #%s ", parameter_table[id].name);
        (void)snprintf(end, sizeof end, " - %s", parameter_table[id].meaning);
        TEST_ASSERT_EQUAL_STRING_LEN(begin, answers[id], strlen(begin));
        TEST_ASSERT_GREATER_THAN_UINT64(strlen(begin) + strlen(end), length);
        TEST_ASSERT_EQUAL_STRING(end, &answers[id][length - strlen(end)]);
    }
    TEST_ASSERT_EQUAL_STRING_LEN("OK HELP #SETR 0..3 m - ", answers[PARAMETER_COUNT], 23);
    TEST_ASSERT_EQUAL_STRING_LEN("OK HELP #USAT 0..11.76 N - ", answers[PARAMETER_USAT], 27);
    TEST_ASSERT_EQUAL_STRING_LEN("OK HELP #LAW PD|PID|PIDT|EST - ", answers[PARAMETER_LAW], 31);
    TEST_ASSERT_EQUAL_STRING_LEN("OK HELP #RELEASE FREE|SCAN - ", answers[PARAMETER_RELEASE], 29);
    TEST_ASSERT_EQUAL_STRING_LEN("OK HELP #ARM - ", answers[PARAMETER_COUNT + 1U], 15);
    TEST_ASSERT_EQUAL_STRING("OK HELP #HELP - this list", answers[answered - 2U]);
    assert_end("OK HELP END lines:%u", answered - 1U);
}

static bool verb_took;

static bool verb(answer_t *answer, int calls)
{
    (void)calls;
    TEST_ASSERT_NOT_NULL(answer->command);
    verb_took = true;
    return true;
}

/* "OK HELP #NAME ..." -> "#NAME" */
static void name_told(const char *told, char *line)
{
    size_t length;

    TEST_ASSERT_EQUAL_STRING_LEN("OK HELP #", told, 9);
    length = 1U + strcspn(&told[9], " ");
    (void)memcpy(line, &told[8], length);
    line[length] = '\0';
}

void test_every_command_that_help_tells_of_is_known(void)
{
    static char told[ANSWERS_MAX][TELEMETRY_ANSWER_MAX + 1U];
    uint16_t count;

    verb_rc_Stub(verb);
    verb_volts_Stub(verb);
    verb_mirrors_Stub(verb);
    verb_laser_Stub(verb);
    verb_imu_Stub(verb);
    verb_perf_Stub(verb);
    verb_save_Stub(verb);
    verb_load_Stub(verb);
    verb_defaults_Stub(verb);
    verb_log_Stub(verb);
    verb_calibrate_Stub(verb);
    verb_stream_Stub(verb);
    verb_hang_Stub(verb);
    type("#HELP");
    count = (uint16_t)(answered - 1U);
    (void)memcpy(told, answers, sizeof told);
    for (uint16_t i = 0; i < count; i++) {
        char line[TELEMETRY_ANSWER_MAX + 1U];

        name_told(told[i], line);
        verb_took = false;
        type(line);
        TEST_ASSERT_TRUE_MESSAGE(verb_took || answered > 0U, line);
        TEST_ASSERT_NULL_MESSAGE(verb_took ? NULL : strstr(answers[0], "unknown"), line);
    }
}

static bool verb_refuses(answer_t *answer, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_UINT16(4, answer->command->name_length);
    TEST_ASSERT_EQUAL_STRING_LEN("PERF", answer->command->name, 4);
    TEST_ASSERT_EQUAL_STRING_LEN("x", answer->command->argument, 1);
    return false;
}

void test_a_verb_gets_the_command_and_its_verdict_is_the_links_life_sign(void)
{
    verb_perf_Stub(verb_refuses);
    type("#perf x");
    TEST_ASSERT_EQUAL_UINT16(0, reference_writes);
    verb_perf_Stub(verb);
    type("#PERF");
    TEST_ASSERT_EQUAL_UINT16(1, reference_writes);
    TEST_ASSERT_EQUAL_UINT32(41, reference.link_sequence);
}

void test_every_valid_line_is_a_life_sign_of_the_link(void)
{
    static const char *const valid[] = {"#PING",     "#GET",    "#GET KP", "#HELP",    "#KP 0.01",
                                        "#SETR 0.5", "#LAW PD", "#LINK 2", "#VERSION", "#PING x"};

    for (uint32_t i = 0; i < sizeof valid / sizeof valid[0]; i++) {
        reference.link_time_us = 0U;
        type(valid[i]);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(ARRIVAL_US, reference.link_time_us, valid[i]);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(41U + i, reference.link_sequence, valid[i]);
    }
    TEST_ASSERT_EQUAL_UINT32(8, reference.sequence); /* the one #SETR */
    TEST_ASSERT_EQUAL_FLOAT(0.5F, reference.reference_m);
}

/* As the radio's port marks it when the UART has lost octets: `#SETR 0.3` that comes as `#SETR 3`. */
void test_a_damaged_line_never_executes(void)
{
    static const char *const lines[] = {"#SETR 3", "#KP 1",  "#LAW PD", "#GET", "#PING 1",
                                        "#HELP",   "#LASER", "#",       "#?"};
    const parameters_t parameters_before = parameters;

    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        telecommand_line_t line = {.damaged = true};

        answered = 0U;
        line.length = (uint16_t)strlen(lines[i]);
        (void)memcpy(line.text, lines[i], line.length);
        execute(&line);
        TEST_ASSERT_EQUAL_UINT16(1, answered);
        TEST_ASSERT_EQUAL_STRING("ERR - line damaged", answers[0]);
    }
    TEST_ASSERT_EQUAL_UINT16(0, parameter_writes);
    TEST_ASSERT_EQUAL_UINT16(0, reference_writes);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, reference.reference_m);
    TEST_ASSERT_EQUAL_MEMORY(&parameters_before, &parameters, sizeof parameters);
}

void test_a_command_after_a_refused_one_works(void)
{
    assert_refused("ERR KP not a number", "#KP nan");
    assert_answer("OK KP 0.02 (LAW EST does not use it)", "#KP 0.02");
    assert_refused("ERR - line too long", "#PING 123456789 123456789 1234567");
    assert_answer("OK SETR 0.6", "#SETR 0.6");
    assert_refused("ERR - empty command", "#");
    assert_answer("OK PING 1", "#PING 1");
}

/* Commands with some characters changed, cut or doubled. */
static size_t damaged_line(char *line)
{
    static const char *const seeds[] = {"#SETR 0.6", "#KP 0.015", "#LAW PID", "#GET USAT", "#RELEASE SCAN",
                                        "#PING 5",   "#LINK 10",  "#HELP",    "#GET"};
    size_t length;

    (void)strcpy(line, seeds[kernel_random(sizeof seeds / sizeof seeds[0])]);
    length = strlen(line);
    for (uint16_t n = kernel_random(4U); n > 0U; n--) {
        const size_t at = 1U + kernel_random((uint32_t)length);

        if (kernel_random(4U) == 0U && length < 60U) {
            (void)memmove(&line[at + 1U], &line[at], length + 1U - at);
            length++;
        } else if (at < length) {
            line[at] = (char)(1U + kernel_random(255U));
            if (strchr("\r\n#\x03\x08\x7F", line[at]) != NULL) {
                line[at] = '0';
            }
        }
    }
    return strlen(line);
}

void test_whatever_comes_is_answered_and_changes_all_or_nothing(void)
{
    uint16_t accepted = 0;
    uint16_t refused = 0;

    kernel_random_seed(20260719U);
    for (uint16_t n = 0; n < 20000U; n++) {
        char line[80];
        const size_t length = damaged_line(line);
        const parameters_t parameters_before = parameters;
        const reference_sample_t reference_before = reference;

        parameter_writes = reference_writes = 0U;
        type_characters(line, length);
        TEST_ASSERT_GREATER_THAN_UINT16_MESSAGE(0, answered, line);
        if (answers[0][0] == 'E') {
            refused++;
            TEST_ASSERT_EQUAL_UINT16_MESSAGE(1, answered, line);
            TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, parameter_writes, line);
            TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, reference_writes, line);
        } else {
            accepted++;
            TEST_ASSERT_EQUAL_UINT32(reference_before.link_sequence + 1U, reference.link_sequence);
            TEST_ASSERT_EQUAL_UINT32(parameters_before.generation + parameter_writes, parameters.generation);
            TEST_ASSERT_LESS_OR_EQUAL_UINT16(1, parameter_writes);
        }
        for (uint16_t id = 0; id < PARAMETER_COUNT; id++) {
            TEST_ASSERT_TRUE(parameters.value[id] >= parameter_table[id].minimum);
            TEST_ASSERT_TRUE(parameters.value[id] <= parameter_table[id].maximum);
        }
        TEST_ASSERT_TRUE(reference.reference_m >= 0.0F && reference.reference_m <= 3.0F);
    }
    TEST_ASSERT_GREATER_THAN_UINT16(2000, accepted);
    TEST_ASSERT_GREATER_THAN_UINT16(2000, refused);
}

void test_any_line_but_a_ping_ends_a_calibration(void)
{
    static const char *const others[] = {"#GET KP", "#KP 0.01", "#KP nan", "#",
                                         "#?",      "#PINGS",   "#PIN",    "#FLY"};

    type("#PING");
    type("#ping 1");
    TEST_ASSERT_EQUAL_UINT16(0, stops);
    for (uint16_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        type(others[i]);
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(i + 1U, stops, others[i]);
    }
}

void test_what_turns_the_imus_axes_round_is_for_the_ground(void)
{
    bsp_time_us_IgnoreAndReturn(ARRIVAL_US);
    in_the_air = true;
    assert_refused("ERR IROLL not on the ground", "#IROLL ROLL");
    assert_refused("ERR IPITCH not on the ground", "#IPITCH -PITCH");
    assert_refused("ERR IDOWN not on the ground", "#IDOWN -Z");
    assert_refused("ERR IUNIT not on the ground", "#IUNIT 1000");
    in_the_air = false;
    assert_answer("OK IROLL ROLL", "#IROLL roll");
    assert_answer("OK IDOWN -Z", "#IDOWN -z");
}

void test_where_the_mirrors_are_is_for_the_ground(void)
{
    bsp_time_us_IgnoreAndReturn(ARRIVAL_US);
    in_the_air = true;
    assert_refused("ERR L not on the ground", "#L 325");
    assert_refused("ERR D1 not on the ground", "#D1 120");
    in_the_air = false;
    assert_answer("OK L 325", "#L 325");
    assert_answer("OK D1 120.5", "#d1 120.5");
    assert_refused("ERR LF out of range 0..500 mm", "#LF 501");
}

void test_stop_and_land_withdraw_the_reference_whatever_stands_behind_them(void)
{
    static const struct {
        const char *line, *expected;
    } rows[] = {
        {"#STOP", "OK STOP"}, {"#LAND", "OK LAND"}, {"#stop now!", "OK STOP"}, {"#land 0.3", "OK LAND"}};

    for (uint16_t i = 0; i < 4U; i++) {
        reference.reference_m = 0.6F;
        assert_answer(rows[i].expected, rows[i].line);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, reference.reference_m);
        TEST_ASSERT_EQUAL_UINT32(8U + i, reference.sequence);
        TEST_ASSERT_EQUAL_UINT32(41U + i, reference.link_sequence);
    }
    TEST_ASSERT_EQUAL_UINT16(4, stops);
}

void test_arm_is_for_the_ground_and_stop_ends_it_but_a_landing_does_not(void)
{
    on_ground = false;
    assert_refused("ERR ARM not on the ground", "#ARM");
    on_ground = true;
    assert_answer("OK ARM idle:15%", "#ARM");
    TEST_ASSERT_TRUE(reference.arm);
    TEST_ASSERT_EQUAL_UINT32(1, reference.arm_sequence);
    TEST_ASSERT_EQUAL_UINT32(7, reference.sequence);
    assert_answer("OK LAND", "#LAND");
    TEST_ASSERT_EQUAL_UINT32(1, reference.arm_sequence);
    assert_answer("OK STOP", "#STOP");
    TEST_ASSERT_FALSE(reference.arm);
    TEST_ASSERT_EQUAL_UINT32(2, reference.arm_sequence);
}

void test_arm_says_what_is_not_known_of_the_imu_and_refuses_what_is_wrong(void)
{
    on_ground = true;
    parameters.value[PARAMETER_IAXES] = (float)AXES_ASSUMED;
    assert_answer("OK ARM idle:15% (IMU axes assumed, see #IMU)", "#ARM");
    flight.imu_fault = IMU_DOWN;
    assert_answer("OK ARM idle:15% (IMU DOWN wrong, see #IMU)", "#ARM");
    flight.imu_fault = IMU_SWAPPED;
    assert_refused("ERR ARM IMU SWAPPED: roll is pitch, see #IMU", "#ARM");
}

void test_axes_that_are_typed_are_assumed_again(void)
{
    assert_answer("OK IROLL -ROLL", "#IROLL -ROLL");
    TEST_ASSERT_EQUAL_UINT16(AXES_PROVED, parameters_choice(&parameters, PARAMETER_IAXES));
    assert_answer("OK IPITCH -PITCH", "#IPITCH -PITCH");
    TEST_ASSERT_EQUAL_UINT16(AXES_ASSUMED, parameters_choice(&parameters, PARAMETER_IAXES));
}

void test_what_a_stop_has_overtaken_starts_nothing_any_more(void)
{
    overtaken = true;
    assert_refused("ERR SETR overtaken by a stop", "#SETR 0.6");
    assert_refused("ERR CALIBRATE overtaken by a stop", "#CALIBRATE 30 5");
    assert_refused("ERR ARM overtaken by a stop", "#ARM");
    assert_answer("OK PING 1", "#PING 1");
    assert_answer("OK LAW PD", "#LAW PD");
}

void test_a_bare_line_is_answered_once_a_second_and_ends_a_calibration_each_time(void)
{
    arrival_us = 0xFFFF0000U;
    assert_refused("ERR - commands begin with #", "stop");
    arrival_us += 999999U;
    type("");
    TEST_ASSERT_EQUAL_UINT16(0, answered);
    arrival_us += 1U;
    assert_refused("ERR - commands begin with #", "SETR 0.6");
    TEST_ASSERT_EQUAL_UINT16(3, stops);
}

/* Long answers. What they do is told by words: a list's line, the log, the calibration, a sleep. */
static uint16_t list_lines;
static uint16_t log_lines;
static uint16_t calibration_lines;
static bool line_waits;
static bool line_presses;
static bool clear;
static bool room;

static bool list_line(answer_t *answer, uint16_t number)
{
    answer_begin(answer);
    return number < list_lines;
}

static bool one_a_time(const telemetry_line_t *line, int calls)
{
    (void)line;
    (void)calls;
    room = !room;
    if (room) {
        kernel_note("line");
    }
    return room;
}

static bool log_more(int calls)
{
    (void)calls;
    kernel_note("log");
    if (log_lines > 0U) {
        log_lines--;
    }
    return log_lines > 0U;
}

static bool calibration_more(int calls)
{
    (void)calls;
    kernel_note("calibration");
    if (calibration_lines > 0U) {
        calibration_lines--;
    }
    return calibration_lines > 0U;
}

static bool waiting(int calls)
{
    (void)calls;
    return line_waits;
}

static bool pressing(int calls)
{
    (void)calls;
    return line_presses;
}

static bool is_clear(int calls)
{
    (void)calls;
    return clear;
}

static uint32_t now_us; /* a sleep takes a millisecond */

static uint32_t time_us(int calls)
{
    (void)calls;
    return now_us;
}

static void meanwhile(void)
{
    kernel_note("sleep");
    now_us += 1000U;
}

static void long_answers(uint16_t list, uint16_t log, uint16_t calibration)
{
    static const telecommand_t command = {.name = "GET", .name_length = 3U};
    const answer_t ask = {.command = &command};

    list_lines = list;
    log_lines = log;
    calibration_lines = calibration;
    line_waits = line_presses = false;
    clear = true;
    room = false;
    now_us = 0U;
    bsp_time_us_Stub(time_us);
    verb_log_more_Stub(log_more);
    verb_calibrate_more_Stub(calibration_more);
    xbee_port_waiting_Stub(waiting);
    xbee_port_pressing_Stub(pressing);
    xbee_port_clear_Stub(is_clear);
    xbee_port_spare_Stub(one_a_time);
    kernel.task.on_sleep = meanwhile;
    kernel.notes[0] = '\0';
    if (list > 0U) {
        (void)listing_start(&ask, list_line);
    }
}

void test_long_answers_go_on_ten_milliseconds_apart_until_both_are_complete(void)
{
    long_answers(0U, 3U, 2U);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, commands_continue(), "any line would have been taken");
    TEST_ASSERT_EQUAL_STRING("log calibration sleep log calibration sleep log calibration ", kernel.notes);
    TEST_ASSERT_EQUAL_UINT32(10, kernel.task.slept_ticks);
    long_answers(0U, 0U, 0U);
    TEST_ASSERT_EQUAL_UINT32(0, commands_continue());
    TEST_ASSERT_EQUAL_STRING("log calibration ", kernel.notes);
}

static void a_line_comes(void)
{
    meanwhile();
    line_waits = true;
}

void test_a_line_that_waits_goes_before_the_rest_of_the_log(void)
{
    long_answers(0U, 100U, 0U);
    kernel.task.on_sleep = a_line_comes;
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, commands_continue(), "a log does not hold it up");
    TEST_ASSERT_EQUAL_STRING("log calibration sleep ", kernel.notes);
    TEST_ASSERT_EQUAL_UINT32(1000, commands_continue());
    TEST_ASSERT_EQUAL_STRING("log calibration sleep ", kernel.notes);
}

void test_a_line_that_waits_lets_a_list_end_first(void)
{
    long_answers(2U, 100U, 0U);
    line_waits = true;
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(2000, commands_continue(), "the end of the list");
    TEST_ASSERT_EQUAL_STRING("line sleep line sleep line ", kernel.notes);
}

static void the_radio_clears(void)
{
    meanwhile();
    clear = kernel.task.sleeps == 3U;
}

void test_a_line_waits_until_the_radio_has_room_for_its_answer(void)
{
    long_answers(0U, 100U, 0U);
    line_waits = true;
    clear = false;
    kernel.task.on_sleep = the_radio_clears;
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(3000, commands_continue(), "when the radio cleared");
    TEST_ASSERT_EQUAL_STRING("sleep sleep sleep ", kernel.notes);
}

static void a_stop_comes(void)
{
    meanwhile();
    line_waits = line_presses = true;
}

/* The worst that a stop waits is one sleep. */
void test_a_line_that_presses_interrupts_whatever_is_being_sent(void)
{
    long_answers(50U, 100U, 5U);
    clear = false;
    kernel.task.on_sleep = a_stop_comes;
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, commands_continue(), "a list does not hold it up");
    TEST_ASSERT_EQUAL_STRING("line sleep ", kernel.notes);
    TEST_ASSERT_EQUAL_UINT32(1000, commands_continue());
    TEST_ASSERT_EQUAL_STRING("line sleep ", kernel.notes);
    line_waits = line_presses = false;
    list_lines = 0U;
    while (listing_more()) {
    }
}

void test_lost_lines_are_told_with_their_number(void)
{
    commands_report_lost(1U);
    commands_report_lost(65535U);
    TEST_ASSERT_EQUAL_STRING("ERR - 1 lines lost: sent too fast", answers[0]);
    TEST_ASSERT_EQUAL_STRING("ERR - 65535 lines lost: sent too fast", answers[1]);
    TEST_ASSERT_EQUAL_UINT16(2, answered);
    TEST_ASSERT_EQUAL_UINT16(0, reference_writes);
}

void test_in_the_air_little_changes_within_ten_seconds(void)
{
    bsp_time_us_IgnoreAndReturn(ARRIVAL_US);
    in_the_air = true;
    flight.hover_n = 7.4F;
    assert_refused("ERR GRAV would put the hover thrust out of reach", "#GRAV 0");
    assert_refused("ERR USAT in the air by 0.2 N in 10 s at most", "#USAT 11");
    assert_refused("ERR DSAT in the air by 0.2 N in 10 s at most", "#DSAT 7");
    assert_refused("ERR KP in the air by a quarter in 10 s at most", "#KP 0");
    assert_refused("ERR SEL not on the ground", "#SEL PIN");
    assert_answer("OK GRAV 6.81", "#GRAV 6.81");
    assert_refused("ERR GRAV in the air by 0.2 N in 10 s at most", "#GRAV 6.7");
    assert_answer("OK LAW PD", "#LAW PD");
    assert_refused("ERR LAW in the air once in 10 s, EST at any time", "#LAW PID");
    assert_answer("OK SEL NONE", "#SEL NONE");
    in_the_air = false;
    assert_answer("OK GRAV 0", "#GRAV 0");
    assert_answer("OK SEL PIN", "#SEL PIN");
}

void test_a_required_sum_is_required_of_everything_but_a_stop(void)
{
    const uint32_t alive = reference.link_sequence;

    assert_answer("OK SETR 0.6", "#SETR 0.6*9383");
    assert_refused("ERR - wrong sum", "#SETR 0.7*9383");
    assert_answer("OK SUM ON", "#SUM ON");
    assert_refused("ERR - sum missing, see #SUM", "#SETR 0.5");
    assert_refused("ERR - sum missing, see #SUM", "#SUM OFF");
    TEST_ASSERT_EQUAL_UINT32(alive + 2U, reference.link_sequence);
    assert_answer("OK SETR 0.6", "#SETR 0.6*9383");
    assert_answer("OK STOP", "#STOP");
    assert_answer("OK LAND", "#LAND");
    assert_answer("OK SETR 0", "#SETR 0");
    assert_answer("OK SUM OFF", "#SUM OFF*3A0B");
    assert_answer("OK SETR 0.5", "#SETR 0.5");
}
