/* `#SAVE`, `#LOAD`, `#DEFAULTS`: what is asked of the store and what is answered. */
#include <string.h>

#include "mock_ground.h"
#include "mock_parameter_store.h"
#include "mock_servers.h"
#include "mock_xbee_port.h"
#include "unity.h"
#include "firmware/version.h"
#include "firmware/verbs.h"

static parameters_t parameters;
static parameters_t stored;
static uint16_t writes;
static uint16_t saves;
static uint32_t stored_rate;
static uint16_t answers;
static char answer_text[TELEMETRY_ANSWER_MAX + 1U];
static parameter_store_result_t result;
static bool idle;
static bool armed;

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

static parameter_store_result_t load(parameters_t *set, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&parameters, set, sizeof parameters, "not the set in force");
    if (result.status == PARAMETER_STORE_DONE) {
        set->value[PARAMETER_KP] = 0.5F;
        set->generation += 9U;
    }
    return result;
}

static parameter_store_result_t save(const parameters_t *set, uint32_t laser_rate, int calls)
{
    (void)calls;
    stored_rate = laser_rate;
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&parameters, set, sizeof parameters, "not the set in force");
    stored = *set;
    saves++;
    return result;
}

static void read_laser(laser_sample_t *sample, int calls)
{
    (void)calls;
    *sample = (laser_sample_t){.rate = 250000U, .power_up_rate = 19200U};
}

static void radio(const telemetry_line_t *line, int calls)
{
    (void)calls;
    TEST_ASSERT_FALSE(line->overflowed);
    memcpy(answer_text, line->text, line->length);
    answer_text[line->length] = '\0';
    answers++;
}

static bool on_ground(int calls)
{
    (void)calls;
    return idle;
}

static bool waits(int calls)
{
    (void)calls;
    return idle || armed;
}

void setUp(void)
{
    armed = false;
    parameters_init(&parameters);
    parameters.generation = 5U;
    writes = saves = answers = 0U;
    result = (parameter_store_result_t){PARAMETER_STORE_DONE, 4U, PARAMETER_COUNT};
    idle = true;
    parameter_server_read_Stub(read_parameters);
    laser_server_read_Stub(read_laser);
    parameter_server_write_Stub(write_parameters);
    parameter_store_load_Stub(load);
    parameter_store_save_Stub(save);
    ground_idle_Stub(on_ground);
    ground_waits_Stub(waits);
    xbee_port_answer_Stub(radio);
}

void tearDown(void) {}

static bool type(const char *name, const char *argument)
{
    telecommand_t command;
    answer_t answer = {.command = &command};

    memcpy(command.name, name, strlen(name));
    command.name_length = (uint16_t)strlen(name);
    memcpy(command.argument, argument, strlen(argument));
    command.argument_length = (uint16_t)strlen(argument);
    answers = 0U;
    if (strcmp(name, "SAVE") == 0) {
        return verb_save(&answer);
    }
    return strcmp(name, "LOAD") == 0 ? verb_load(&answer) : verb_defaults(&answer);
}

static void assert_answer(const char *expected)
{
    TEST_ASSERT_EQUAL_UINT16(1, answers);
    TEST_ASSERT_EQUAL_STRING(expected, answer_text);
}

void test_save_stores_the_set_in_force_and_tells_its_generation(void)
{
    parameters.value[PARAMETER_KP] = 0.02F;
    TEST_ASSERT_TRUE(type("SAVE", ""));
    TEST_ASSERT_EQUAL_UINT16(1, saves);
    TEST_ASSERT_EQUAL_MEMORY(&parameters, &stored, sizeof stored);
    TEST_ASSERT_EQUAL_UINT32(19200, stored_rate);
    TEST_ASSERT_EQUAL_UINT16(0, writes);
    assert_answer("OK SAVE generation:4\r\n");
}

void test_load_puts_the_stored_set_in_force_once(void)
{
    TEST_ASSERT_TRUE(type("LOAD", ""));
    TEST_ASSERT_EQUAL_UINT16(1, writes);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, parameters.value[PARAMETER_KP]);
    assert_answer("OK LOAD generation:4\r\n");
}

void test_defaults_are_those_of_the_table_and_a_new_generation(void)
{
    parameters.value[PARAMETER_KP] = 0.02F;
    TEST_ASSERT_TRUE(type("DEFAULTS", ""));
    for (uint16_t id = 0U; id < PARAMETER_COUNT; id++) {
        TEST_ASSERT_EQUAL_FLOAT(parameter_table[id].initial, parameters.value[id]);
    }
    TEST_ASSERT_EQUAL_UINT32(6U, parameters.generation);
    TEST_ASSERT_EQUAL_UINT16(1, writes);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, saves, "the stored set stays");
    assert_answer("OK DEFAULTS\r\n");
}

void test_defaults_seed_changes_the_law_and_its_gains_alone(void)
{
    parameters_t expected;

    parameters.value[PARAMETER_SEL] = (float)SEL_PIN;
    parameters.value[PARAMETER_KP] = 0.5F;
    expected = parameters;
    parameters_set_seed(&expected);
    TEST_ASSERT_TRUE(type("DEFAULTS", "seed"));
    TEST_ASSERT_EQUAL_MEMORY(&expected, &parameters, sizeof expected);
    TEST_ASSERT_EQUAL_FLOAT((float)LAW_PID, parameters.value[PARAMETER_LAW]);
    TEST_ASSERT_EQUAL_FLOAT((float)SEL_PIN, parameters.value[PARAMETER_SEL]);
    TEST_ASSERT_EQUAL_UINT16(1, writes);
    assert_answer("OK DEFAULTS SEED\r\n");
}

void test_off_the_ground_all_three_are_refused_and_touch_nothing(void)
{
    static const char *const names[] = {"SAVE", "LOAD", "DEFAULTS"};
    static const char *const expected[] = {"ERR SAVE not on the ground\r\n", "ERR LOAD not on the ground\r\n",
                                           "ERR DEFAULTS not on the ground\r\n"};

    idle = false;
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FALSE(type(names[i], ""));
        assert_answer(expected[i]);
    }
    TEST_ASSERT_FALSE(type("DEFAULTS", "SEED"));
    assert_answer("ERR DEFAULTS not on the ground\r\n");
    TEST_ASSERT_EQUAL_UINT16(0, saves + writes);
}

void test_while_armed_motors_idle_all_three_are_refused_with_the_remedy(void)
{
    static const char *const names[] = {"SAVE", "LOAD", "DEFAULTS"};

    idle = false;
    armed = true;
    for (int i = 0; i < 3; i++) {
        char expected[64] = "ERR ";

        TEST_ASSERT_FALSE(type(names[i], ""));
        (void)strcat(strcat(expected, names[i]), " motors idle, see #STOP\r\n");
        assert_answer(expected);
    }
    TEST_ASSERT_EQUAL_UINT16(0, saves + writes);
}

void test_defaults_of_another_name_are_refused(void)
{
    TEST_ASSERT_FALSE(type("DEFAULTS", "EST"));
    assert_answer("ERR DEFAULTS one of SEED\r\n");
    TEST_ASSERT_EQUAL_UINT16(0, writes);
}

void test_each_failure_of_the_store_has_its_reason_and_changes_nothing(void)
{
    static const struct {
        parameter_store_status_t status;
        const char *expected;
    } rows[] = {
        {PARAMETER_STORE_EMPTY, "ERR LOAD nothing stored\r\n"},
        {PARAMETER_STORE_DAMAGED, "ERR LOAD stored set damaged\r\n"},
        {PARAMETER_STORE_FOREIGN, "ERR LOAD stored by another firmware, this is " PLOMADA_VERSION "\r\n"},
        {PARAMETER_STORE_RANGE, "ERR LOAD stored KD out of range 0..1 N/mm\r\n"}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        result = (parameter_store_result_t){rows[i].status, 2U, PARAMETER_KD};
        TEST_ASSERT_FALSE(type("LOAD", ""));
        assert_answer(rows[i].expected);
    }
    TEST_ASSERT_EQUAL_UINT16(0, writes);
    result.status = PARAMETER_STORE_FAULT;
    TEST_ASSERT_FALSE(type("SAVE", ""));
    assert_answer("ERR SAVE storage fault\r\n");
}

void test_at_the_start_the_stored_set_is_in_force_without_asking_for_the_ground(void)
{
    idle = false;
    verb_load_at_start();
    TEST_ASSERT_EQUAL_FLOAT(0.5F, parameters.value[PARAMETER_KP]);
    assert_answer("OK LOAD generation:4\r\n");
}

void test_at_the_start_a_refused_set_is_told_and_an_empty_storage_is_not(void)
{
    result.status = PARAMETER_STORE_DAMAGED;
    verb_load_at_start();
    assert_answer("ERR LOAD stored set damaged\r\n");
    answers = 0U;
    result.status = PARAMETER_STORE_EMPTY;
    verb_load_at_start();
    TEST_ASSERT_EQUAL_UINT16(0, answers + writes);
}
