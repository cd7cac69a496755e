/* What the firmware says of itself (`#PERF`, `#LASER`) and how it takes its octets, against what the kernel's
 * observer and the wires have seen of the same run. */
#include <stdio.h>
#include <string.h>

#include "firmware/probe.h"
#include "sim/board.h"
#include "sim/costs.h"
#include "unity.h"

#define TASKS 6

static const char *const names[TASKS] = {"TaskIMU",       "TaskReceiveLaser", "TaskControl",
                                         "TaskSendLaser", "TaskSendComm",     "TaskReceiveComm"};
static sim_time_t longest[TASKS];
static long interrupts;
static char text[24000];
static size_t length;

static void terminal(void *context, unsigned octet)
{
    (void)context;
    TEST_ASSERT_LESS_THAN_UINT64(sizeof text - 1U, length);
    text[length++] = (char)octet;
    text[length] = '\0';
}

static void observe(void *context, sim_time_t when, kernel_event_t event, const kernel_job_t *job, int detail)
{
    (void)context;
    (void)detail;
    interrupts += event == KERNEL_FINISHED && job->kind == KERNEL_HWI;
    if (event != KERNEL_FINISHED || job->kind != KERNEL_TASK) {
        return;
    }
    for (int i = 0; i < TASKS; i++) {
        if (strcmp(job->name, names[i]) == 0 && when - job->released > longest[i]) {
            longest[i] = when - job->released;
        }
    }
}

static void run_until_s(double seconds)
{
    TEST_ASSERT_TRUE_MESSAGE(kernel_run_until((sim_time_t)(seconds * 1e9)), kernel_halt_reason());
}

static void type(const char *line)
{
    board_type(line, strlen(line));
}

static void start(const kernel_costs_t *costs)
{
    board_config_t config = board_config(1);

    config.costs = costs;
    memset(longest, 0, sizeof longest);
    length = 0;
    kernel_observe(observe, NULL);
    board_power_on(&config, terminal, NULL);
}

/* The figures are those of one mirror's scans. */
static void read_one_mirror(void)
{
    run_until_s(1.0);
    type("#LAYOUT FRONT\n");
}

void setUp(void)
{
    start(&costs_annex_iv);
    read_one_mirror();
}

void tearDown(void)
{
    board_power_off();
    kernel_observe(NULL, NULL);
}

static unsigned long field(const char *line_begin, const char *name)
{
    const char *line = strstr(text, line_begin);
    const char *at = line != NULL ? strstr(line, name) : NULL;
    unsigned long value = 0;

    TEST_ASSERT_NOT_NULL_MESSAGE(at, line_begin);
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, sscanf(at + strlen(name), "%lu", &value), name);
    return value;
}

/* The scanner's and the IMU's tasks are released by a Swi here, by the octet before it there. */
static const double head_start_us[TASKS] = {300.0, 600.0, 0.0, 0.0, 0.0, 300.0};

void test_responses_are_those_that_the_kernel_saw(void)
{
    run_until_s(12.0);
    type("#SETR 0.6\n");
    run_until_s(30.0);
    length = 0;
    for (int i = 0; i < TASKS; i++) {
        char begin[40];
        /* What the kernel sees of TaskReceiveComm are also the turns of a long answer, which answer no line.
         */
        const double before_us = strcmp(names[i], "TaskReceiveComm") == 0 ? 500.0
                                                                          : (double)longest[i] / 1000.0;

        type("#PERF\n");
        run_until_s(32.0 + 2.0 * i);
        (void)snprintf(begin, sizeof begin, "OK PERF %s ", names[i]);
        const double told_us = (double)field(begin, "worst_us:");

        TEST_ASSERT_TRUE_MESSAGE(told_us >= before_us - 1.0 &&
                                     told_us <= (double)longest[i] / 1000.0 + head_start_us[i] + 1.0,
                                 begin);
        TEST_ASSERT_EQUAL_UINT64(0, field(begin, "late:"));
        length = 0;
    }
}

void test_reset_forgets_the_worst(void)
{
    run_until_s(15.0);
    type("#PERF\n");
    run_until_s(17.0);
    const unsigned long before = field("OK PERF TaskSendLaser ", "worst_us:");

    type("#PERF RESET\n");
    run_until_s(18.0);
    length = 0;
    type("#PERF\n");
    run_until_s(20.0);
    const unsigned long after = field("OK PERF TaskSendLaser ", "worst_us:");

    TEST_ASSERT_TRUE(after <= before);
    TEST_ASSERT_TRUE(after > 0);
}

/* Annex IV's costs and the octets of a stream: some percent. */
void test_the_load_is_told_in_percent(void)
{
    run_until_s(15.0);
    length = 0;
    type("#PERF\n");
    run_until_s(16.0);
    TEST_ASSERT_UINT64_WITHIN(6, 8, field("OK PERF reset:POWER ", "load:"));
}

/* What the firmware told of TaskReceiveComm, asked when all is quiet again. */
static unsigned long told_of_comm(const char *name, double until_s)
{
    run_until_s(until_s - 2.0);
    length = 0;
    type("#PERF\n");
    run_until_s(until_s);
    return field("OK PERF TaskReceiveComm ", name);
}

/* A list's end, room for the answers of the lines before, a log: what a line has to wait for is no response.
 */
void test_what_waits_behind_long_answers_is_not_late(void)
{
    static const char *const before[] = {"#HELP\n", "#GET\n#GET\n", "#HELP\n#PING b\n#HELP\n", "#LOG\n"};

    run_until_s(12.0);
    for (size_t i = 0; i < sizeof before / sizeof before[0]; i++) {
        const double from_s = 12.0 + 30.0 * (double)i;

        run_until_s(from_s);
        type("#PERF RESET\n");
        run_until_s(from_s + 1.0);
        type(before[i]);
        run_until_s(from_s + 1.5);
        type("#PING a\n#PING b\n#GET KP\n");
        run_until_s(from_s + 2.0);
        type("#STOP\n#PING c\n");
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, told_of_comm("late:", from_s + 29.0), before[i]);
        TEST_ASSERT_TRUE_MESSAGE(field("OK PERF TaskReceiveComm ", "worst_us:") < 30000, before[i]);
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, field("OK PERF TaskSendComm ", "late:"), before[i]);
    }
}

/* A command that takes 0.4 s of the 0.3 s that it may. */
void test_a_missed_deadline_is_counted(void)
{
    kernel_cost_t jobs[COSTS_JOBS_MAX];
    kernel_costs_t costs = costs_annex_iv;

    for (int i = 0; i < costs.job_count; i++) {
        jobs[i] = costs_annex_iv.jobs[i];
        if (strcmp(jobs[i].name, "TaskReceiveComm") == 0) {
            jobs[i].job = 400 * SIM_MS;
        }
    }
    costs.jobs = jobs;
    board_power_off();
    start(&costs);
    run_until_s(15.0);
    type("#PING 1\n");
    run_until_s(16.0);
    length = 0;
    type("#PERF\n");
    run_until_s(18.0);
    TEST_ASSERT_EQUAL_UINT64(
        2, field("OK PERF TaskReceiveComm ", "late:")); /* the question itself is the second */
    TEST_ASSERT_UINT64_WITHIN(30000, 420000, field("OK PERF TaskReceiveComm ", "worst_us:"));
    TEST_ASSERT_EQUAL_UINT64(0, field("OK PERF TaskSendComm ", "late:"));
}

/* What a job may cost beyond its own: a server access each, and two context switches each for its release and
 * for every wait at a gate. Figures of tools/rta/plomada-est.csv. */
typedef struct {
    const char *name;
    int accesses;
    int blockings;
} planted_task_t;
static const planted_task_t planted_tasks[TASKS] = {
    {"TaskIMU", 1, 1},       {"TaskReceiveLaser", 2, 2}, {"TaskControl", 5, 2},
    {"TaskSendLaser", 1, 2}, {"TaskSendComm", 3, 1},     {"TaskReceiveComm", 37, 0},
};

static const planted_task_t *task_called(const char *name)
{
    for (int i = 0; i < TASKS; i++) {
        if (strcmp(planted_tasks[i].name, name) == 0) {
            return &planted_tasks[i];
        }
    }
    return NULL;
}

static void assert_planted(const kernel_cost_t *job, const kernel_costs_t *costs)
{
    const planted_task_t *task = task_called(job->name);
    const sim_time_t released = task == NULL ? job->job : job->job + costs->switches + costs->gate_access;
    const sim_time_t most = task == NULL ? job->job
                                         : job->job + costs->switches * (1 + task->blockings) +
                                               costs->gate_access * task->accesses;
    char row[40];

    (void)snprintf(row, sizeof row, " %s longest_ns:", job->name);
    const sim_time_t told = (sim_time_t)field(row, "longest_ns:");

    printf("%-17s %7lld ns planted, %7lld told, %7lld at most\n", job->name, (long long)released,
           (long long)told, (long long)most);
    /* Commands to the IMU fit its transmitter's FIFO, and its octets are left to the tick: these interrupts
     * do not come. */
    if (strstr("SCIB_TX SCIB_RX", job->name) != NULL) {
        TEST_ASSERT_EQUAL_INT64(0, told);
    } else {
        TEST_ASSERT_TRUE_MESSAGE(told >= released - 5 && told <= most + 5, row);
    }
}

void test_planted_costs_come_back_to_the_cycle(void)
{
    static const char *const gates[] = {"altitude", "imu", "laser", "reference", "parameters", "flight"};
    kernel_cost_t jobs[COSTS_JOBS_MAX];
    kernel_costs_t costs = costs_annex_iv;

    for (int i = 0; i < costs.job_count; i++) {
        jobs[i] = costs_annex_iv.jobs[i];
        jobs[i].job += jobs[i].job / 10 * (i % 7); /* each another share of its own */
    }
    costs.jobs = jobs;
    costs.gate_access = 11 * SIM_US;
    board_power_off();
    start(&costs);
    read_one_mirror();
    run_until_s(12.0);
    type("#SETR 0.6\n");
    run_until_s(30.0);
    length = 0;
    type("#PERF COSTS\n");
    run_until_s(33.0);
    for (int i = 0; i < costs.job_count; i++) {
        assert_planted(&jobs[i], &costs);
    }
    for (int i = 0; i < 6; i++) {
        char row[40];

        (void)snprintf(row, sizeof row, " %s hold_ns:", gates[i]);
        TEST_ASSERT_UINT64_WITHIN(5, 11000, field(row, "hold_ns:"));
    }
    TEST_ASSERT_EQUAL_UINT64(costs.job_count + 6, field("OK PERF END", "lines:"));
}

/* Saved as the radio said it, telemetry between the lines: tests/tools/rta analyses it. */
void test_the_costs_of_a_flight_are_saved_whole(void)
{
    run_until_s(12.0);
    type("#SETR 0.6\n");
    run_until_s(30.0);
    length = 0;
    type("#PERF COSTS\n");
    run_until_s(33.0);
    TEST_ASSERT_GREATER_THAN_UINT64(0, field("OK PERF END", "lines:"));
    FILE *file = fopen(COSTS_PATH, "w");

    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL_size_t(length, fwrite(text, 1, length, file));
    TEST_ASSERT_EQUAL_INT(0, fclose(file));
}

/* With an interrupt per octet they were 3690: 1000 ticks, 1010 octets of scans, 2000 of the IMU. */
void test_streaming_sensors_take_few_interrupts(void)
{
    run_until_s(15.0);
    interrupts = 0;
    run_until_s(25.0);
    printf("%.1f interrupts per second\n", (double)interrupts / 10.0);
    TEST_ASSERT_INT_WITHIN(200, 11400, interrupts);
}

static void fly_and_ask(void)
{
    run_until_s(2.0);
    type("#LAW PID\n");
    run_until_s(12.0);
    type("#SETR 0.6\n");
    run_until_s(40.0);
    length = 0;
    type("#LASER\n");
    run_until_s(41.5);
}

void test_no_octet_is_lost_even_when_everything_takes_twelve_times_as_long(void)
{
    static const double factors[] = {1.0, 6.0, 12.0};

    for (int i = 0; i < 3; i++) {
        static costs_stretched_t stretched;

        board_power_off();
        start(costs_stretch(&stretched, &costs_annex_iv, factors[i]));
        fly_and_ask();
        TEST_ASSERT_EQUAL_UINT64(0, field("OK LASER state:OK", "overrun:"));
        TEST_ASSERT_EQUAL_UINT64(0, field("OK LASER state:OK", "framing:"));
        TEST_ASSERT_EQUAL_UINT64(0, field("OK LASER state:OK", "length:"));
        TEST_ASSERT_UINT64_WITHIN(6, 297,
                                  field("OK LASER state:OK", "frames:")); /* from 11.7 s on, ten a second */
        TEST_ASSERT_EQUAL_UINT32(0, probe_imu->malformed);
        TEST_ASSERT_UINT32_WITHIN(4, 41 * 40 + 20, probe_imu->sequence);
    }
}

/* The tick fetches what makes no interrupt. */
void test_no_frame_waits_longer_than_a_tick(void)
{
    static const char *const frames[2] = {"#A-C=1.00,-2.00,256.00\r\n#YPR=10.00,-5.25,3.50\r",
                                          "#A-C=1.00,-2.00,256.00\r\n#YPR=10.01,-5.25,3.50\r"};
    const sim_time_t octet = (sim_time_t)(10e9 / 57603.7);

    board_connect(BOARD_IMU, NULL, NULL);
    run_until_s(15.0);
    for (int phase = 0; phase < 100; phase++) {
        const sim_time_t begin = 15 * SIM_S + phase * (50 * SIM_MS + 10 * SIM_US);
        const uint32_t before = probe_imu->sequence;
        const char *frame = frames[phase % 2]; /* one that repeats is none, imu_repeat.h */

        TEST_ASSERT_TRUE(kernel_run_until(begin));
        board_receive(BOARD_IMU, frame, strlen(frame));
        TEST_ASSERT_TRUE(kernel_run_until(begin + 40 * SIM_MS));
        TEST_ASSERT_EQUAL_UINT32(before + 1U, probe_imu->sequence);
        const double late_us = (double)probe_imu->arrival_us -
                               (double)(begin + (sim_time_t)strlen(frame) * octet) / 1000.0;

        TEST_ASSERT_TRUE_MESSAGE(late_us > -5.0 && late_us < 1030.0, "a frame was older than a tick");
    }
}
