/* A recording played again is the same run: the same pulses at the same nanoseconds and the same octets on
 * the radio. */
#include "sim/tape.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "sim/ti/f021/flash.h"
#include "unity.h"

#define TAPE SCRATCH "/flight.plomada"
#define PULSES_MAX 4000

typedef struct {
    sim_time_t pulse_ends[PULSES_MAX], pulses[PULSES_MAX];
    size_t pulse_count;
    child_terminal_t radio;
} outcome_t;

typedef struct {
    unsigned long seed;
    double end_s;
    const char *name, *value; /* typed otherwise in the replay; NULL: nothing */
} order_t;

static outcome_t *seen;
static outcome_t flown, replayed;

void setUp(void)
{
    memset(&flown, 0, sizeof flown);
    memset(&replayed, 0, sizeof replayed);
}

void tearDown(void) {}

static void pulse(sim_time_t high_ns)
{
    if (seen->pulse_count < PULSES_MAX) {
        seen->pulse_ends[seen->pulse_count] = timeline_now();
        seen->pulses[seen->pulse_count++] = high_ns;
    }
}

static void watch(outcome_t *outcome)
{
    seen = outcome;
    board_probe(BOARD_PROBE_TIMING, &(board_probes_t){.pulse = pulse});
}

static void until(double t_s)
{
    (void)kernel_run_until((sim_time_t)(t_s * 1e9));
}

static void type(const char *text)
{
    board_type(text, strlen(text));
}

/* The stick stands in the middle, and is pushed up for a second from 17 s on. */
static void receiver(void *unused)
{
    const bool up = timeline_now() >= 17 * SIM_S && timeline_now() < 18 * SIM_S;

    (void)unused;
    board_stick((up ? 1100 : 1500) * SIM_US);
    timeline_after(20 * SIM_MS, receiver, NULL);
}

/* What may come to the pins: stored parameters, a damaged and a mute scanner, the pilot's switch and stick, a
 * landing. */
static void fly(void *argument, void *result)
{
    static const line_fault_spec_t faults[] = {
        {.kind = LINE_FAULT_FLIP, .position = 15000, .argument = 3},
        {.kind = LINE_FAULT_MUTE, .position = 17000, .argument = 700},
    };
    const order_t *order = argument;
    unsigned short cells[FLASH_SECTORS * FLASH_SECTOR_CELLS];
    board_config_t config = board_config(order->seed);
    FILE *out = fopen(TAPE, "w");

    config.laser_faults = faults;
    config.laser_fault_count = 2;
    config.stick.connected = 1.0;
    config.battery.connected = 1.0;
    flash_read_all(cells);
    memset(cells, 0, 200); /* no whole image: the firmware says so */
    flash_write_all(cells);
    watch(result);
    board_power_on(&config, child_terminal_take, &((outcome_t *)result)->radio);
    tape_record(out);
    tape_key("scenario", "none");
    timeline_after(20 * SIM_MS, receiver, NULL);
    until(13.0);
    type("#LAW EST\n");
    until(13.5);
    type("#KP 0.02\n");
    until(13.7);
    type("#SEL PIN\n");
    type("#STICK PIN\n");
    type("#BAT PIN\n");
    until(14.0);
    type("#SETR 0.6\n");
    until(20.0);
    board_select(false);
    until(21.0);
    board_select(true);
    until(24.0);
    type("#SETR 0\n");
    tape_truth(&(tape_truth_t){0.1, 0.2, 0.1 + 0.2, 6.5, -0.75, 1.5, 0.25});
    until(order->end_s);
    tape_stop();
    fclose(out);
    board_power_off();
}

static void replay(void *argument, void *result)
{
    const order_t *order = argument;
    const char *error = "";
    FILE *in = fopen(TAPE, "r");
    tape_t *tape = tape_read(in, &error);
    board_config_t config = board_config(order->seed + 1000); /* the models are off: their noise is another */

    if (tape == NULL || (order->name != NULL && !tape_retype(tape, order->name, order->value))) {
        abort();
    }
    watch(result);
    tape_restore_flash(tape);
    board_power_on(&config, NULL, NULL);
    tape_play(tape, child_terminal_take, &((outcome_t *)result)->radio);
    until(order->end_s);
    board_power_off();
    tape_free(tape);
    fclose(in);
}

static size_t first_difference(void)
{
    size_t i = 0;

    while (i < flown.pulse_count && i < replayed.pulse_count && flown.pulses[i] == replayed.pulses[i] &&
           flown.pulse_ends[i] == replayed.pulse_ends[i]) {
        i++;
    }
    return i;
}

void test_a_replay_gives_the_same_pulses_and_the_same_words_to_the_nanosecond(void)
{
    for (unsigned long seed = 1; seed <= 4; seed++) {
        order_t order = {seed, 27.0, NULL, NULL};

        child_run(fly, &order, &flown, sizeof flown);
        child_run(replay, &order, &replayed, sizeof replayed);
        TEST_ASSERT_GREATER_THAN_size_t(1900, flown.pulse_count);
        TEST_ASSERT_EQUAL_size_t(flown.pulse_count, replayed.pulse_count);
        TEST_ASSERT_EQUAL_size_t(flown.pulse_count, first_difference());
        TEST_ASSERT_EQUAL_STRING(flown.radio.text, replayed.radio.text);
        TEST_ASSERT_NOT_NULL(strstr(flown.radio.text, "ERR LOAD")); /* the flash came along */
        TEST_ASSERT_NOT_NULL(strstr(flown.radio.text, "state:FLYING"));
        TEST_ASSERT_NOT_NULL(strstr(flown.radio.text, "state:FLOATING")); /* and the pilot's switch */
        TEST_ASSERT_NOT_NULL(strstr(flown.radio.text, "ref:0.8"));        /* and his stick */
        TEST_ASSERT_NOT_NULL(strstr(flown.radio.text, "bat:16."));        /* and the battery */
    }
}

void test_a_line_typed_otherwise_changes_what_follows_and_nothing_before(void)
{
    order_t order = {1, 27.0, NULL, NULL}, other = {1, 27.0, "LAW", "PIDT"};
    size_t same;

    child_run(fly, &order, &flown, sizeof flown);
    child_run(replay, &other, &replayed, sizeof replayed);
    TEST_ASSERT_NOT_NULL(strstr(replayed.radio.text, "OK LAW PIDT"));
    TEST_ASSERT_NULL(strstr(replayed.radio.text, "OK LAW EST"));
    same = first_difference();
    TEST_ASSERT_TRUE_MESSAGE(flown.pulse_ends[same] > 14 * SIM_S,
                             "something was different before the take-off");
    TEST_ASSERT_TRUE_MESSAGE(flown.pulse_ends[same] < 16 * SIM_S, "another law gave the same thrust");
}

void test_a_parameter_that_nobody_typed_is_typed_before_the_reference(void)
{
    order_t order = {1, 16.0, NULL, NULL}, other = {1, 16.0, "GRAV", "6.6"};
    const char *answer;

    child_run(fly, &order, &flown, sizeof flown);
    child_run(replay, &other, &replayed, sizeof replayed);
    answer = strstr(replayed.radio.text, "OK GRAV 6.6");
    TEST_ASSERT_NOT_NULL(answer);
    TEST_ASSERT_NOT_NULL(strstr(answer, "OK SETR 0.6"));
}

void test_keys_and_truth_come_back_as_they_were_written(void)
{
    order_t order = {1, 25.0, NULL, NULL};
    const char *error = "";
    tape_truth_t truth;
    FILE *in;
    tape_t *tape;

    child_run(fly, &order, &flown, sizeof flown);
    in = fopen(TAPE, "r");
    tape = tape_read(in, &error);
    fclose(in);
    TEST_ASSERT_NOT_NULL_MESSAGE(tape, error);
    TEST_ASSERT_EQUAL_STRING("none", tape_value(tape, "scenario", 0));
    TEST_ASSERT_NULL(tape_value(tape, "scenario", 1));
    TEST_ASSERT_TRUE(tape_truth_row(tape, 0, &truth));
    TEST_ASSERT_EQUAL_DOUBLE(0.1 + 0.2, truth.terrain_m);
    TEST_ASSERT_EQUAL_DOUBLE(6.5, truth.thrust_n);
    TEST_ASSERT_EQUAL_DOUBLE(-0.75, truth.x_m);
    TEST_ASSERT_EQUAL_DOUBLE(1.5, truth.y_m);
    TEST_ASSERT_EQUAL_DOUBLE(0.25, truth.heading_rad);
    TEST_ASSERT_FALSE(tape_truth_row(tape, 1, &truth));
    TEST_ASSERT_INT64_WITHIN(SIM_S / 10, 25 * SIM_S, tape_end(tape));
    TEST_ASSERT_EQUAL(TAPE_WHOLE, tape_state(tape));
    tape_free(tape);
}

static const char *read_text(const char *text)
{
    const char *error = NULL;
    FILE *file = tmpfile();
    tape_t *tape;

    fputs(text, file);
    rewind(file);
    tape = tape_read(file, &error);
    fclose(file);
    if (tape != NULL) {
        tape_free(tape);
        return NULL;
    }
    return error;
}

static tape_state_t state_of(const char *text)
{
    const char *error = NULL;
    FILE *file = tmpfile();
    tape_t *tape;
    tape_state_t state;

    fputs(text, file);
    rewind(file);
    tape = tape_read(file, &error);
    fclose(file);
    TEST_ASSERT_NOT_NULL_MESSAGE(tape, error);
    state = tape_state(tape);
    tape_free(tape);
    return state;
}

void test_a_recording_without_its_end_line_is_cut_and_an_older_one_may_be(void)
{
    TEST_ASSERT_EQUAL(TAPE_WHOLE, state_of("plomada-recording 2\nseed 1\nend 5\n"));
    TEST_ASSERT_EQUAL(TAPE_CUT, state_of("plomada-recording 2\nseed 1\n"));
    TEST_ASSERT_EQUAL(TAPE_CUT, state_of("plomada-recording 2\nseed 1\nend 5"));
    TEST_ASSERT_EQUAL(TAPE_UNTOLD, state_of("plomada-recording 1\nseed 1\n"));
    TEST_ASSERT_EQUAL(TAPE_CUT, state_of("plomada-recording 1\nseed 1\noctets im"));
}

void test_a_damaged_recording_is_refused_with_its_line_and_one_cut_off_is_read(void)
{
    TEST_ASSERT_EQUAL_STRING("line 1: not a recording of plomada", read_text("t_s,meas_m\n"));
    TEST_ASSERT_EQUAL_STRING("line 2: not hex", read_text("plomada-recording 1\noctets imu 5 173611 4Z\n"));
    TEST_ASSERT_EQUAL_STRING("line 2: not hex", read_text("plomada-recording 1\noctets imu 5 173611 4\n"));
    TEST_ASSERT_EQUAL_STRING("line 2: no such wire",
                             read_text("plomada-recording 1\noctets gps 5 173611 41\n"));
    TEST_ASSERT_EQUAL_STRING("line 2: octets WIRE T_NS LENGTH_NS HEX",
                             read_text("plomada-recording 1\noctets imu 5 0 41\n"));
    TEST_ASSERT_EQUAL_STRING("line 3: select T_NS 0|1",
                             read_text("plomada-recording 1\nseed 1\nselect 7 2\n"));
    TEST_ASSERT_EQUAL_STRING("line 2: flash OFFSET CELLS",
                             read_text("plomada-recording 1\nflash 99999 0000\n"));
    TEST_ASSERT_EQUAL_STRING("line 2: no value", read_text("plomada-recording 1\nhello\n"));
    TEST_ASSERT_NULL(read_text("plomada-recording 1\noctets imu 5 173611 41\noctets imu 900000 173611 4"));
}
