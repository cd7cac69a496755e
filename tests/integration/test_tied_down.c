/* `#CALIBRATE` of the running firmware: the vehicle tied down, and one whose ropes give way. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "firmware/probe.h"
#include "sim/devices/quadrotor.h"
#include "unity.h"

#define READY_S 14.0 /* sensor wait and start-up are over */
#define IDLE_US (4166 * 0.48)

typedef struct {
    child_terminal_t terminal;
    double shortest_us; /* throttle pulse */
    double last_us;
    double highest_m;
} flown_t;

typedef struct {
    bool tied;
    const char *lines; /* "@s": waits so many seconds */
} session_t;

static flown_t flown;

void setUp(void) {}
void tearDown(void) {}

static void watch_for(flown_t *f, double seconds)
{
    sim_time_t until = timeline_now() + (sim_time_t)(seconds * 1e9);

    while (timeline_now() < until) {
        const quadrotor_state_t *state;

        kernel_run_until(timeline_now() + 20 * SIM_MS);
        state = quadrotor_state(board_quadrotor());
        f->last_us = board_pulse_us();
        f->shortest_us = f->last_us < f->shortest_us ? f->last_us : f->shortest_us;
        f->highest_m = state->height_m > f->highest_m ? state->height_m : f->highest_m;
    }
}

static void run_session(void *argument, void *result)
{
    const session_t *session = argument;
    flown_t *f = result;
    board_config_t config = board_config(1);

    config.quadrotor.anchored = session->tied;
    config.quadrotor.bench_height_m = 0.0;
    board_power_on(&config, child_terminal_take, &f->terminal);
    kernel_run_until((sim_time_t)(READY_S * 1e9));
    f->shortest_us = 1e9;
    f->terminal.length = 0;
    for (const char *next = session->lines; *next != '\0'; next = strchr(next, '\n') + 1) {
        if (*next == '@') {
            watch_for(f, atof(next + 1));
        } else if (*next == '~') { /* the Enter key of XCTU's console */
            board_type("\r", 1);
            watch_for(f, 0.3);
        } else {
            board_type(next, strcspn(next, "\n") + 1);
            watch_for(f, 0.3);
        }
    }
    if (kernel_halt_reason() != NULL) {
        abort();
    }
}

static void run(bool tied, const char *lines)
{
    session_t session = {tied, lines};

    memset(&flown, 0, sizeof flown);
    child_run(run_session, &session, &flown, sizeof flown);
}

static bool answered(const char *line)
{
    char needle[128];

    snprintf(needle, sizeof needle, "\n%s", line);
    return strstr(flown.terminal.text, needle) != NULL;
}

static void assert_idle(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.5F, (float)IDLE_US, (float)flown.last_us);
}

void test_every_step_is_reported_and_on_the_throttle_until_a_command_ends_it(void)
{
    run(true, "#LINK 60\n#CALIBRATE 30 2\n@1\n#PING 1\n@20\n#GET KP\n@0.5\n");
    TEST_ASSERT_TRUE(answered("OK CALIBRATE counts:30 seconds:2"));
    for (int step = 1; step <= 10; step++) {
        char line[64];

        snprintf(line, sizeof line, "OK CALIBRATE thr:%.2f compare:%d", (312 + 30 * step) / 177.21,
                 4166 - 312 - 30 * step);
        TEST_ASSERT_TRUE_MESSAGE(answered(line), line);
    }
    TEST_ASSERT_TRUE(answered("OK PING 1"));
    TEST_ASSERT_TRUE(answered("OK CALIBRATE end:COMMAND thr:3.62 compare:3524 grav:3.62"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(flown.terminal.text, " thr:3.45 state:GROUND"),
                                 "the telemetry shows it too");
    TEST_ASSERT_FLOAT_WITHIN(0.5F, (float)((4166 - 312 - 330) * 0.48), (float)flown.shortest_us);
    assert_idle();
}

void test_any_line_ends_it_a_damaged_one_too(void)
{
    static const char *const lines[] = {"#LINK 60\n#CALIBRATE 200 1\n@2\n#FOO\n@0.4\n",
                                        "#LINK 60\n#CALIBRATE 200 1\n@2\n#\n@0.4\n",
                                        "#LINK 60\n#CALIBRATE 200 1\n@2\n#KP 99\n@0.4\n"};

    for (int i = 0; i < 3; i++) {
        run(true, lines[i]);
        TEST_ASSERT_TRUE(flown.shortest_us < IDLE_US - 150);
        TEST_ASSERT_TRUE(answered("OK CALIBRATE end:COMMAND"));
        assert_idle();
    }
}

/* What somebody types who sees the ropes give way. */
void test_enter_a_word_or_ctrl_c_end_it_too(void)
{
    static const char *const lines[] = {
        "#LINK 60\n#CALIBRATE 200 1\n@2\n~\n@0.4\n", "#LINK 60\n#CALIBRATE 200 1\n@2\n\n@0.4\n",
        "#LINK 60\n#CALIBRATE 200 1\n@2\nstop\n@0.4\n", "#LINK 60\n#CALIBRATE 200 1\n@2\n\x03\n@0.4\n",
        "#LINK 60\n#CALIBRATE 200 1\n@2\n#STOP\n@0.4\n"};

    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        run(true, lines[i]);
        TEST_ASSERT_TRUE(flown.shortest_us < IDLE_US - 150);
        TEST_ASSERT_TRUE_MESSAGE(answered("OK CALIBRATE end:COMMAND"), lines[i]);
        assert_idle();
    }
}

void test_it_ends_by_itself_below_the_limit(void)
{
    run(true, "#LINK 60\n#CALIBRATE 200 1\n@12\n");
    TEST_ASSERT_TRUE(answered("OK CALIBRATE end:LIMIT thr:7.40 compare:2854"));
    TEST_ASSERT_FLOAT_WITHIN(0.5F, (float)(2854 * 0.48), (float)flown.shortest_us);
    assert_idle();
}

void test_a_silent_link_ends_it(void)
{
    run(true, "#LINK 3\n#CALIBRATE 30 1\n@2\n#PING 1\n@2.5\n#PING 2\n@6\n");
    TEST_ASSERT_FALSE(answered("OK CALIBRATE end:COMMAND"));
    TEST_ASSERT_TRUE(answered("OK CALIBRATE end:LINK"));
    TEST_ASSERT_TRUE_MESSAGE(flown.shortest_us < IDLE_US - 7 * 30 * 0.48, "the pings kept it going");
    assert_idle();
}

void test_without_an_armed_link_or_with_a_reference_it_does_not_begin(void)
{
    run(true, "#CALIBRATE\n");
    TEST_ASSERT_TRUE(answered("ERR CALIBRATE link not armed, see #LINK"));
    TEST_ASSERT_FLOAT_WITHIN(0.5F, (float)IDLE_US, (float)flown.shortest_us);
}

void test_when_it_lifts_off_all_the_same_the_thrust_is_gone_at_once(void)
{
    run(false, "#LINK 60\n#CALIBRATE 100 1\n@20\n");
    TEST_ASSERT_TRUE(answered("OK CALIBRATE end:HEIGHT"));
    TEST_ASSERT_TRUE_MESSAGE(flown.highest_m > 0.1 && flown.highest_m < 0.6, "highest");
    TEST_ASSERT_NULL(strstr(flown.terminal.text, "state:FL"));
    assert_idle();
}

void test_in_the_air_it_is_refused(void)
{
    run(false, "#LINK 60\n#SETR 0.5\n@4\n#CALIBRATE\n@0.5\n");
    TEST_ASSERT_TRUE(answered("ERR CALIBRATE not on the ground"));
    TEST_ASSERT_NOT_NULL(strstr(flown.terminal.text, "state:FLYING"));
}

void test_the_seeds_laws_are_advised_of_less_than_the_lift_off_thrust(void)
{
    run(true, "#LAW PID\n#LINK 60\n#CALIBRATE 200 1\n@2.5\n\n@0.5\n");
    TEST_ASSERT_TRUE(answered("OK CALIBRATE end:COMMAND thr:5.15 compare:3254 grav:4.75"));
}

void test_armed_motors_idle_before_and_after_it_and_stop_with_stop(void)
{
    run(true, "#ARM\n#LINK 60\n@0.2\n");
    TEST_ASSERT_TRUE(answered("OK ARM idle:15%"));
    TEST_ASSERT_FLOAT_WITHIN(0.5F, (float)(IDLE_US - 312.6 * 0.48), (float)flown.last_us);
    run(true, "#ARM\n#LINK 60\n#CALIBRATE 200 1\n@2.5\n\n@0.5\n");
    TEST_ASSERT_TRUE(flown.shortest_us < IDLE_US - 500 * 0.48);
    TEST_ASSERT_FLOAT_WITHIN(0.5F, (float)(IDLE_US - 312.6 * 0.48), (float)flown.last_us);
    run(true, "#ARM\n@0.2\n#STOP\n@0.2\n");
    assert_idle();
}
