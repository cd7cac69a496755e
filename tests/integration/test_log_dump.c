/* `#LOG` of the running firmware after a flight, over the radio and beside everything else that is sent there. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "firmware/watch.h"
#include "unity.h"

#define TERMINAL_MAX 200000
#define COLUMNS 10

typedef struct {
    char text[TERMINAL_MAX];
    size_t length;
    double asked_s, first_ping_s, end_s;
} flight_t;

static flight_t flight;

void setUp(void) {}
void tearDown(void) {}

static void take(void *terminal, unsigned octet)
{
    flight_t *f = terminal;

    if (f->length < sizeof f->text - 1) {
        f->text[f->length++] = (char)octet;
    }
}

static void run_for(double seconds)
{
    kernel_run_until(timeline_now() + (sim_time_t)(seconds * 1e9));
}

static void type(const char *line)
{
    board_type(line, strlen(line));
}

static double now_s(void)
{
    return (double)timeline_now() * 1e-9;
}

static void run_until_told(flight_t *f, const char *text, double *when)
{
    size_t from = f->length;

    while (strstr(f->text + from, text) == NULL && now_s() < 400.0) {
        run_for(0.01);
    }
    *when = now_s();
}

/* A flight of 60 s, then everything from the ground; pings meanwhile. */
static void fly_and_ask(void *argument, void *result)
{
    flight_t *f = result;
    board_config_t config = board_config(1);
    double dummy;

    board_power_on(&config, take, f);
    run_for(14.0);
    type("#LAW PID\n");
    type("#SETR 0.6\n");
    run_for(60.0);
    type("#SETR 0\n");
    run_for(10.0);
    f->length = 0;
    memset(f->text, 0, sizeof f->text);
    type(argument);
    f->asked_s = now_s();
    run_for(5.0);
    type("#PING here\n");
    dummy = now_s();
    run_until_told(f, "OK PING here", &f->first_ping_s);
    f->first_ping_s -= dummy;
    run_until_told(f, "OK LOG END", &f->end_s);
    run_for(0.5);
    if (kernel_halt_reason() != NULL) {
        abort();
    }
}

static void ask(const char *line)
{
    memset(&flight, 0, sizeof flight);
    child_run(fly_and_ask, (void *)(size_t)line, &flight, sizeof flight);
}

typedef struct {
    double t_s, meas_m, est_m, ref_m, thrust_n;
    char state[16];
} row_t;

/* The next row of the log behind *at; false at the end. Fails the test when it is no row of CSV. */
static bool next_row(const char **at, row_t *row)
{
    char line[160];
    int commas = 0;

    do {
        *at = strstr(*at, "OK LOG ");
        if (*at == NULL) {
            return false;
        }
        *at += strlen("OK LOG ");
    } while (**at < '0' || **at > '9');
    TEST_ASSERT_EQUAL_INT(1, sscanf(*at, "%159[^\r\n]", line));
    for (const char *p = line; *p != '\0'; p++) {
        commas += *p == ',';
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(COLUMNS - 1, commas, line);
    memset(row, 0, sizeof *row);
    if (sscanf(line, "%lf,%lf,%lf,,%lf,%lf,%*[^,],%*[^,],%15[^,]", &row->t_s, &row->meas_m, &row->est_m, &row->ref_m,
               &row->thrust_n, row->state) != 6) {
        (void)sscanf(line, "%lf", &row->t_s);
    }
    return true;
}

void test_a_whole_flight_comes_down_in_order_beside_telemetry_and_commands(void)
{
    const char *at = flight.text;
    row_t row = {.t_s = 0.0}, before = {.t_s = 0.0};
    int rows = 0, flying = 0, telemetry = 0, expected = 0;
    double first_s = 0.0;

    ask("#LOG\n");
    TEST_ASSERT_EQUAL_INT(1, sscanf(strstr(flight.text, "OK LOG records:"), "OK LOG records:%d", &expected));
    TEST_ASSERT_NOT_NULL(strstr(flight.text, "OK LOG t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags"));
    while (next_row(&at, &row)) {
        first_s = rows == 0 ? row.t_s : first_s;
        TEST_ASSERT_TRUE_MESSAGE(row.t_s > before.t_s, "not in order");
        TEST_ASSERT_TRUE_MESSAGE(rows == 0 || row.t_s - before.t_s < 0.16, "a gap");
        if (strcmp(row.state, "FLYING") == 0 && row.t_s - first_s > 10.0) {
            TEST_ASSERT_FLOAT_WITHIN(0.35F, 0.6F, (float)row.meas_m);
            TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.6F, (float)row.ref_m);
            TEST_ASSERT_TRUE(row.thrust_n > 5.0 && row.thrust_n < 10.0);
            flying++;
        }
        before = row;
        rows++;
    }
    TEST_ASSERT_EQUAL_INT(expected, rows);
    TEST_ASSERT_TRUE_MESSAGE(before.t_s - first_s > 60.0, "a minute of flight at least");
    TEST_ASSERT_TRUE(flying > 400);
    TEST_ASSERT_TRUE_MESSAGE(flight.first_ping_s < 0.6, "an answer came late");
    for (at = flight.text; (at = strstr(at, "\nalt:")) != NULL; at++) {
        telemetry++;
    }
    TEST_ASSERT_FLOAT_WITHIN(6.0F, (float)(5.0 * (flight.end_s - flight.asked_s)), (float)telemetry);
    TEST_ASSERT_TRUE_MESSAGE(flight.end_s - flight.asked_s < 90.0, "slower than the radio");
}

void test_the_last_seconds_alone_come_quickly(void)
{
    const char *at = flight.text;
    row_t row, first = {.t_s = 0.0}, last = {.t_s = 0.0};
    int rows = 0;

    ask("#LOG 8\n");
    while (next_row(&at, &row)) {
        if (rows == 0) {
            first = row;
        }
        last = row;
        rows++;
    }
    TEST_ASSERT_TRUE(rows > 60 && rows < 90);
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 8.0F, (float)(last.t_s - first.t_s));
    TEST_ASSERT_TRUE(flight.end_s - flight.asked_s < 12.0);
}
