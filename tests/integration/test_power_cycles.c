/* `#SAVE`, `#LOAD` and `#DEFAULTS` of the running firmware, over power cycles of the board with the same
 * flash. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "child.h"
#include "drivers/parameter_image.h"
#include "firmware/probe.h"
#include "sim/ti/f021/flash.h"
#include "unity.h"

#define SAVE_CELLS_MAX (FLASH_SECTOR_CELLS + PARAMETER_IMAGE_CELLS_MAX)

typedef struct {
    child_terminal_t terminal;
    parameters_t parameters;
} power_on_t;

typedef struct {
    const char *lines; /* "@s": waits so many seconds */
    long cut_after;    /* cells; negative: never */
} session_t;

static const char image[] = SCRATCH "/storage.bin";
static power_on_t seen;

void setUp(void)
{
    (void)remove(image);
}

void tearDown(void)
{
    (void)remove(image);
}

static void power_on(void *argument, void *result)
{
    const session_t *session = argument;
    power_on_t *out = result;
    board_config_t config = board_config(1);
    const char *next = session->lines;

    if (flash_load(image) != NULL) {
        abort();
    }
    flash_cut_power_after(session->cut_after);
    board_power_on(&config, child_terminal_take, &out->terminal);
    kernel_run_until(500 * SIM_MS);
    for (; *next != '\0'; next = strchr(next, '\n') + 1) {
        sim_time_t wait = *next == '@' ? (sim_time_t)(atof(next + 1) * 1e9) : 300 * SIM_MS;

        if (*next != '@') {
            board_type(next, strcspn(next, "\n") + 1);
        }
        kernel_run_until(timeline_now() + wait);
    }
    out->parameters = *probe_parameters;
    if (kernel_halt_reason() != NULL || flash_store(image) != NULL) {
        abort();
    }
}

static void type_and_cut(const char *lines, long cut_after)
{
    session_t session = {lines, cut_after};

    memset(&seen, 0, sizeof seen);
    child_run(power_on, &session, &seen, sizeof seen);
}

static void type(const char *lines)
{
    type_and_cut(lines, -1);
}

static bool answered(const char *line)
{
    char needle[128];

    snprintf(needle, sizeof needle, "\n%s\r\n", line);
    return strstr(seen.terminal.text, needle) != NULL ||
           strncmp(seen.terminal.text, needle + 1, strlen(needle + 1)) == 0;
}

void test_what_is_saved_is_in_force_after_a_power_cycle(void)
{
    type("#KP 0.021\n#LAW PD\n#LINK 2\n#SAVE\n#KI 0.005\n");
    TEST_ASSERT_TRUE(answered("OK SAVE generation:1"));
    type("#GET KP\n#GET LAW\n#GET LINK\n#GET KI\n");
    TEST_ASSERT_TRUE(answered("OK LOAD generation:1"));
    TEST_ASSERT_TRUE(answered("OK KP 0.021"));
    TEST_ASSERT_TRUE(answered("OK LAW PD"));
    TEST_ASSERT_TRUE(answered("OK LINK 2"));
    TEST_ASSERT_TRUE(answered("OK KI 0.01"));
}

void test_nothing_is_said_of_an_empty_storage_unless_asked(void)
{
    type("#PING 1\n");
    TEST_ASSERT_NULL(strstr(seen.terminal.text, "LOAD"));
    type("#LOAD\n");
    TEST_ASSERT_TRUE(answered("ERR LOAD nothing stored"));
}

void test_load_brings_back_what_was_saved_and_defaults_what_was_delivered(void)
{
    type("#KP 0.021\n#SAVE\n#KP 0.03\n#LOAD\n#GET KP\n#DEFAULTS\n#GET KD\n#KD 0.009\n");
    TEST_ASSERT_TRUE(answered("OK LOAD generation:1"));
    TEST_ASSERT_TRUE(answered("OK KP 0.021"));
    TEST_ASSERT_TRUE(answered("OK DEFAULTS"));
    TEST_ASSERT_EQUAL_FLOAT(0.015F, seen.parameters.value[PARAMETER_KP]);
    type("#GET KP\n");
    TEST_ASSERT_TRUE_MESSAGE(answered("OK KP 0.021"), "the defaults were not saved");
}

void test_the_reference_is_never_stored(void)
{
    type("#SETR 0.5\n#SAVE\n#SETR 0\n#SAVE\n");
    TEST_ASSERT_TRUE(answered("ERR SAVE not on the ground"));
    TEST_ASSERT_TRUE(answered("OK SAVE generation:1"));
    type("#GET SETR\n");
    TEST_ASSERT_TRUE(answered("OK SETR 0"));
}

void test_in_the_air_nothing_is_saved_loaded_or_reset(void)
{
    type("#KP 0.014\n#SAVE\n#KP 0.0151\n@13\n#SETR 0.6\n@4\n#SAVE\n#LOAD\n#DEFAULTS\n");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(seen.terminal.text, "state:FLYING"), "it never flew");
    TEST_ASSERT_TRUE(answered("ERR SAVE not on the ground"));
    TEST_ASSERT_TRUE(answered("ERR LOAD not on the ground"));
    TEST_ASSERT_TRUE(answered("ERR DEFAULTS not on the ground"));
    TEST_ASSERT_EQUAL_FLOAT(0.0151F, seen.parameters.value[PARAMETER_KP]);
    type("#PING 1\n");
    TEST_ASSERT_EQUAL_FLOAT(0.014F, seen.parameters.value[PARAMETER_KP]);
}

void test_power_that_fails_during_a_save_leaves_the_old_set_or_the_new_one(void)
{
    static const long cuts[] = {0,
                                1,
                                FLASH_SECTOR_CELLS - 1,
                                FLASH_SECTOR_CELLS,
                                FLASH_SECTOR_CELLS + 1,
                                FLASH_SECTOR_CELLS + 8,
                                FLASH_SECTOR_CELLS + 20,
                                SAVE_CELLS_MAX};

    for (size_t i = 0; i < sizeof cuts / sizeof cuts[0]; i++) {
        (void)remove(image);
        type("#KP 0.011\n#KD 0.011\n#SAVE\n#KP 0.012\n#KD 0.012\n#SAVE\n");
        type_and_cut("#KP 0.013\n#KD 0.013\n#SAVE\n", cuts[i]);
        TEST_ASSERT_EQUAL(cuts[i] < SAVE_CELLS_MAX, answered("ERR SAVE storage fault"));
        type("");
        TEST_ASSERT_EQUAL_FLOAT(seen.parameters.value[PARAMETER_KP], seen.parameters.value[PARAMETER_KD]);
        TEST_ASSERT_EQUAL_FLOAT(cuts[i] == SAVE_CELLS_MAX ? 0.013F : 0.012F,
                                seen.parameters.value[PARAMETER_KP]);
    }
}

void test_a_worn_out_copy_is_told_at_power_on_and_the_defaults_fly(void)
{
    FILE *file;

    type("#KP 0.011\n#SAVE\n");
    file = fopen(image, "r+b");
    TEST_ASSERT_NOT_NULL(file);
    for (long slot = 0; slot < FLASH_SECTORS; slot++) {
        fseek(file, slot * FLASH_SECTOR_CELLS * 2 + 20, SEEK_SET);
        fputc(0, file);
    }
    fclose(file);
    type("#GET KP\n");
    TEST_ASSERT_TRUE(answered("ERR LOAD stored set damaged"));
    TEST_ASSERT_TRUE(answered("OK KP 0.015"));
}
