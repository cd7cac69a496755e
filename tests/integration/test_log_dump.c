/* `#LOG` of the running firmware after a flight, over the radio and beside everything else that is sent
 * there. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "firmware/flight_recorder.h"
#include "firmware/probe.h"
#include "firmware/published.h"
#include "unity.h"

#define TERMINAL_MAX 400000
#define COLUMNS 33

typedef struct {
    char text[TERMINAL_MAX];
    size_t length;
    double asked_s, first_ping_s, end_s;
} dump_t;

typedef struct {
    const char *layout, *law, *question;
} order_t;

static dump_t flight;

void setUp(void) {}
void tearDown(void) {}

static void take(void *terminal, unsigned octet)
{
    dump_t *f = terminal;

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

static void run_until_told(dump_t *f, const char *text, double *when)
{
    size_t from = f->length;

    while (strstr(f->text + from, text) == NULL && now_s() < 600.0) {
        run_for(0.01);
    }
    *when = now_s();
}

/* A flight of 60 s, then everything from the ground; pings meanwhile. */
static void fly_and_ask(void *argument, void *result)
{
    const order_t *order = argument;
    dump_t *f = result;
    board_config_t config = board_config(1);
    double dummy;

    board_power_on(&config, take, f);
    run_for(14.0);
    type(order->layout);
    run_for(5.0); /* the scanner starts anew */
    type(order->law);
    type("#SETR 0.6\n");
    run_for(60.0);
    type("#SETR 0\n");
    run_for(10.0);
    f->length = 0;
    memset(f->text, 0, sizeof f->text);
    type(order->question);
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

static void ask_with(const char *layout, const char *law, const char *question)
{
    order_t order = {layout, law, question};

    memset(&flight, 0, sizeof flight);
    child_run(fly_and_ask, &order, &flight, sizeof flight);
}

static void ask(const char *law, const char *question)
{
    ask_with("#LAYOUT FRONT\n", law, question);
}

typedef struct {
    double t_s, meas_m, est_m, ref_m, thrust_n;
    char state[16];
} row_t;

/* The next row of the log behind *at; false at the end. Fails the test when it is no row of CSV. */
static bool next_row(const char **at, row_t *row)
{
    char line[240];
    int commas = 0;

    do {
        *at = strstr(*at, "OK LOG ");
        if (*at == NULL) {
            return false;
        }
        *at += strlen("OK LOG ");
    } while (**at < '1' || **at > '9');
    TEST_ASSERT_NOT_NULL(strchr(*at, ' '));
    *at = strchr(*at, ' ') + 1;
    TEST_ASSERT_EQUAL_INT(1, sscanf(*at, "%239[^\r\n]", line));
    for (const char *p = line; *p != '\0'; p++) {
        commas += *p == ',';
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(COLUMNS - 1, commas, line);
    memset(row, 0, sizeof *row);
    if (sscanf(line, "%lf,%lf,%lf,,%lf,%lf,%*[^,],%*[^,],%15[^,]", &row->t_s, &row->meas_m, &row->est_m,
               &row->ref_m, &row->thrust_n, row->state) != 6) {
        (void)sscanf(line, "%lf", &row->t_s);
    }
    return true;
}

void test_a_whole_flight_comes_down_in_order_beside_telemetry_and_commands(void)
{
    const char *at = flight.text;
    row_t row = {.t_s = 0.0}, before = {.t_s = 0.0};
    int rows = 0, flying = 0, telemetry = 0, expected = 0;
    size_t octets = 0;
    double first_s = 0.0;

    ask("#LAW PID\n", "#LOG\n");
    TEST_ASSERT_EQUAL_INT(1, sscanf(strstr(flight.text, "OK LOG records:"), "OK LOG records:%d", &expected));
    TEST_ASSERT_NOT_NULL(strstr(
        flight.text, "OK LOG 0 t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,"
                     "up_mps2,pulse_us,age_s,bat_v,doubt,limit,bat,mf_rays,mf_mm,mf_spread_mm,mf_ms,mf_lie,"
                     "m1_rays,m1_mm,m1_spread_mm,m1_ms,m1_lie,m2_rays,m2_mm,m2_spread_mm,m2_ms,"
                     "m2_lie,out*"));
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
        octets += strcspn(at, "\n") + 1U;
    }
    TEST_ASSERT_EQUAL_INT(expected, rows);
    TEST_ASSERT_TRUE_MESSAGE(before.t_s - first_s > 60.0, "a minute of flight at least");
    TEST_ASSERT_TRUE(flying > 400);
    TEST_ASSERT_TRUE_MESSAGE(flight.first_ping_s < 0.6, "an answer came late");
    for (at = flight.text; (at = strstr(at, "\nalt:")) != NULL; at++) {
        telemetry++;
    }
    TEST_ASSERT_FLOAT_WITHIN(6.0F, (float)(5.0 * (flight.end_s - flight.asked_s)), (float)telemetry);
    printf("dump of %d rows: %.1f s, %.1f octets/s\n", rows, flight.end_s - flight.asked_s,
           (double)octets / (flight.end_s - flight.asked_s));
    /* 960 octets/s, less 5 telemetry lines of about 62, one of the beams of about 37, and 9 before each row
     */
    TEST_ASSERT_TRUE_MESSAGE((double)octets > 550.0 * (flight.end_s - flight.asked_s),
                             "slower than the radio");
}

/* The figures of docs/operator.md. */
static void check_est(const char *layout, float takes)
{
    const char *at = flight.text;
    row_t row = {.t_s = 0.0};
    double first_s = 0.0;
    int rows = 0;

    ask_with(layout, "#LAW EST\n", "#LOG\n");
    while (next_row(&at, &row)) {
        first_s = rows == 0 ? row.t_s : first_s;
        rows++;
    }
    const double flown_s = row.t_s - first_s;
    TEST_ASSERT_TRUE_MESSAGE(flown_s > 60.0, "a minute of flight at least");
    TEST_ASSERT_FLOAT_WITHIN(1.5F, 62.5F, (float)(FLIGHT_RECORDER_RECORDS * flown_s / (rows - 1)));
    printf("%sa minute takes %.2f\n", layout, (flight.end_s - flight.asked_s) / flown_s);
    TEST_ASSERT_FLOAT_WITHIN(0.15F, takes, (float)((flight.end_s - flight.asked_s) / flown_s));
}

void test_under_law_est_the_recorder_holds_62_s_and_a_minute_takes_four(void)
{
    check_est("#LAYOUT FRONT\n", 3.9F);
    check_est("#LAYOUT THREE\n", 4.4F);
}

/* What finding the vehicle in a flight needs; the figures of docs/operator.md. */
static void check_fast(const char *law, double least_s, double most_s)
{
    const char *at = flight.text;
    row_t row, before = {.t_s = 0.0};
    double first_s = 0.0, gap_s = 0.0;
    int rows = 0;

    ask(law, "#LOG\n");
    while (next_row(&at, &row)) {
        first_s = rows == 0 ? row.t_s : first_s;
        gap_s = rows == 0 ? 0.0 : fmax(gap_s, row.t_s - before.t_s);
        before = row;
        rows++;
    }
    printf("%d rows, %.1f s, at most %.3f s apart\n", rows, row.t_s - first_s, gap_s);
    TEST_ASSERT_EQUAL_INT(FLIGHT_RECORDER_RECORDS, rows);
    TEST_ASSERT_TRUE(row.t_s - first_s > least_s && row.t_s - first_s < most_s);
    TEST_ASSERT_TRUE(gap_s > 0.02 && gap_s < 0.0285);
}

void test_at_the_fast_rate_no_two_records_are_further_apart_than_two_frames(void)
{
    check_fast("#LOG RATE FAST\n#LAW EST\n", 24.5, 26.5);
    check_fast("#LOG RATE FAST\n#LAW PID\n", 24.5, 27.0);
}

void test_the_last_seconds_alone_come_quickly(void)
{
    const char *at = flight.text;
    row_t row, first = {.t_s = 0.0}, last = {.t_s = 0.0};
    int rows = 0;

    ask("#LAW PID\n", "#LOG 8\n");
    while (next_row(&at, &row)) {
        if (rows == 0) {
            first = row;
        }
        last = row;
        rows++;
    }
    TEST_ASSERT_TRUE(rows > 60 && rows < 170); /* a landing by the estimate has twice as many */
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 8.0F, (float)(last.t_s - first.t_s));
    TEST_ASSERT_TRUE(flight.end_s - flight.asked_s <
                     4.0 * 8.0); /* four minutes for a minute, as operator.md says */
}

void test_law_est_leaves_its_estimate_and_its_innovation(void)
{
    const char *at = flight.text;
    row_t row;
    int rows = 0, flying = 0;
    double meas_m, est_m, innov_m, apart_m = 0.0;
    char state[16];

    ask("#LAW EST\n", "#LOG 30\n");
    while (next_row(&at, &row)) {
        rows++;
        if (sscanf(at, "%*f,%lf,%lf,%lf,%*f,%*f,%*[^,],%*[^,],%15[^,]", &meas_m, &est_m, &innov_m, state) ==
                4 &&
            strcmp(state, "FLYING") == 0) {
            TEST_ASSERT_DOUBLE_WITHIN(0.1, 0.0, innov_m);
            apart_m = fmax(apart_m, fabs(est_m - meas_m));
            flying++;
        }
    }
    TEST_ASSERT_TRUE(rows > 200 && flying > 150);
    TEST_ASSERT_TRUE_MESSAGE(apart_m > 0.004, "the estimate is no copy of the measurement");
}

/* ---- the log of the PC board */

#define ROWS_MAX 4000

typedef struct {
    double est_m, innov_m, ref_m, thrust_n;
    char state[16];
    unsigned flags;
} sample_t;

typedef struct {
    char titles[400];
    sample_t pc[ROWS_MAX], ring[ROWS_MAX];
    int pc_rows, ring_rows;
} logs_t;

static logs_t logs;

/* A row's columns: NaN where there is nothing. */
static void read_sample(char *line, sample_t *sample)
{
    double values[8];
    char *at = line;

    for (int column = 0; column < 8; column++) {
        values[column] = *at == ',' ? NAN : strtod(at, &at);
        at++;
    }
    *sample = (sample_t){.est_m = values[2], .innov_m = values[3], .ref_m = values[4], .thrust_n = values[5]};
    (void)sscanf(at, "%15[^,],%u", sample->state, &sample->flags);
}

static void read_csv(FILE *csv, logs_t *l)
{
    char line[300];

    rewind(csv);
    if (fgets(l->titles, sizeof l->titles, csv) == NULL) {
        abort();
    }
    while (l->pc_rows < ROWS_MAX && fgets(line, sizeof line, csv) != NULL) {
        read_sample(line, &l->pc[l->pc_rows++]);
    }
}

static void read_ring(logs_t *l)
{
    const flight_recorder_span_t span = flight_recorder_span();
    telemetry_line_t line;
    published_t record;

    for (uint32_t number = span.oldest; number != span.next && flight_recorder_read(number, &record);
         number++) {
        telemetry_begin_answer(&line);
        published_row(&line, &record);
        line.text[line.length] = '\0';
        read_sample(line.text, &l->ring[l->ring_rows++]);
    }
}

static void fly_with_both_logs(void *scenario, void *result)
{
    static flight_options_t options;
    static flight_result_t flown;

    options.seed = 3;
    options.csv = tmpfile();
    if (options.csv == NULL || flight_prepare(scenario_find(scenario), &options) != NULL) {
        abort();
    }
    flight_run(scenario_find(scenario), &options, &flown);
    read_csv(options.csv, result);
    read_ring(result);
}

static bool near(double left, double right, double tolerance)
{
    return isnan(left) ? isnan(right) : fabs(left - right) <= tolerance;
}

static bool same(const sample_t *pc, const sample_t *ring)
{
    return near(pc->est_m, ring->est_m, 0.00056) && near(pc->innov_m, ring->innov_m, 0.00056) &&
           near(pc->ref_m, ring->ref_m, 0.0005) && near(pc->thrust_n, ring->thrust_n, 0.00056) &&
           strcmp(pc->state, ring->state) == 0 && pc->flags == ring->flags;
}

static void compare_logs(const char *scenario)
{
    int at = 0, found = 0;

    memset(&logs, 0, sizeof logs);
    child_run(fly_with_both_logs, (void *)(size_t)scenario, &logs, sizeof logs);
    for (int row = 0; row < logs.ring_rows; row++) {
        int next = at;

        while (next < logs.pc_rows && !same(&logs.pc[next], &logs.ring[row])) {
            next++;
        }
        if (next < logs.pc_rows) {
            at = next;
            found++;
        }
    }
    printf("%s: %d of %d records of the flight recorder are rows of the PC's log\n", scenario, found,
           logs.ring_rows);
    TEST_ASSERT_TRUE(logs.ring_rows > 150);
    TEST_ASSERT_TRUE(found <= logs.ring_rows && 100 * found >= 98 * logs.ring_rows);
}

/* But for a cycle that another one follows before the PC board looks, 10 ms later. */
void test_the_flight_recorder_holds_rows_of_the_pc_boards_log(void)
{
    compare_logs("est-60cm-ramp");
    compare_logs("pid-60cm-ramp");
}

void test_both_logs_have_the_same_columns_and_the_pc_boards_some_more(void)
{
    telemetry_line_t line;
    char expected[400];

    telemetry_begin_answer(&line);
    published_titles(&line);
    snprintf(expected, sizeof expected, "%.*s,height_m,abs_m,terrain_m,x_m,y_m,heading_rad\n",
             (int)line.length, line.text);
    child_run(fly_with_both_logs, (void *)(size_t) "pid-40cm", &logs, sizeof logs);
    TEST_ASSERT_EQUAL_STRING(expected, logs.titles);
}
