/* The two tables that the program carries. */
#include <math.h>
#include <string.h>

#include "control/parameters.h"
#include "firmware/schedule.h"
#include "firmware/uart_port.h"
#include "tools/rta/analysis.h"
#include "tools/rta/table.h"
#include "unity.h"

#define SEED_TASKS 6

static rta_table_t table;
static rta_options_t options;
static int task[RTA_ROWS_MAX];
static int tasks;

static void load(const char *name)
{
    rta_error_t error;

    TEST_ASSERT_TRUE_MESSAGE(rta_table_read(&table, rta_table_builtin(name), &error), error.reason);
    tasks = rta_tasks(&table, task);
}

void setUp(void)
{
    options = (rta_options_t){.switches = round(0.057 * RTA_PS_PER_MS),
                              .access = round(0.0093 * RTA_PS_PER_MS)};
    load("seed");
    TEST_ASSERT_EQUAL_INT(SEED_TASKS, tasks);
}

void tearDown(void) {}

typedef rta_ps_t (*figure_t)(const rta_table_t *table, const rta_options_t *options, int task);

static void expect_all(const double expected_ms[SEED_TASKS], figure_t figure)
{
    for (int i = 0; i < SEED_TASKS; i++) {
        TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(expected_ms[i], figure(&table, &options, task[i]) / RTA_PS_PER_MS,
                                         table.row[task[i]].name);
    }
}

/* Figura A4.1 of the seed document. */
void test_the_seed_table_is_figure_a4_1(void)
{
    static const struct {
        const char *name;
        rta_kind_t kind;
        int priority;
        double period, deadline, cost, blocking;
        int blockings;
    } rows[] = {
        {"Clock", RTA_HWI, 0, 1, 0, 0.015, 0, 0},
        {"SCIA_RX", RTA_HWI, 0, 0.04, 0, 0.0024, 0, 0},
        {"SCIA_TX", RTA_HWI, 0, 0.04, 0, 0.002, 0, 0},
        {"SCIB_RX", RTA_HWI, 0, 0.173, 0, 0.0024, 0, 0},
        {"SCIB_TX", RTA_HWI, 0, 0.173, 0, 0.002, 0, 0},
        {"SCIC_RX", RTA_HWI, 0, 0.938, 0, 0.0024, 0, 0},
        {"SCIC_TX", RTA_HWI, 0, 0.938, 0, 0.002, 0, 0},
        {"IMU_SWI", RTA_SWI, 0, 25, 0, 0.081, 0, 0},
        {"Laser_SWI", RTA_SWI, 0, 100, 0, 0.302, 0, 0},
        {"XBee_SWI", RTA_SWI, 0, 300, 0, 0.124, 0, 0},
        {"TaskIMU", RTA_TASK, 6, 25, 25, 0.16, 0.0093, 1},
        {"TaskReceiveLaser", RTA_TASK, 5, 100, 100, 1.02, 0.0186, 2},
        {"TaskControl", RTA_TASK, 4, 108, 108, 0.4, 0.0279, 3},
        {"TaskSendLaser", RTA_TASK, 3, 150, 150, 0.0068, 0.0186, 2},
        {"TaskSendComm", RTA_TASK, 2, 200, 200, 1, 0.0093, 1},
        {"TaskReceiveComm", RTA_TASK, 1, 300, 300, 0.83, 0, 0},
    };

    TEST_ASSERT_EQUAL_INT(sizeof rows / sizeof rows[0], table.rows);
    for (int i = 0; i < table.rows; i++) {
        TEST_ASSERT_EQUAL_STRING(rows[i].name, table.row[i].name);
        TEST_ASSERT_EQUAL_INT(rows[i].kind, table.row[i].kind);
        TEST_ASSERT_EQUAL_INT(rows[i].priority, table.row[i].priority);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].period, table.row[i].period / RTA_PS_PER_MS);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].deadline, table.row[i].deadline / RTA_PS_PER_MS);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].cost, table.row[i].cost / RTA_PS_PER_MS);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].blocking, table.row[i].blocking / RTA_PS_PER_MS);
        TEST_ASSERT_EQUAL_INT(rows[i].blockings, table.row[i].blockings);
        TEST_ASSERT_EQUAL_INT(0, table.row[i].accesses);
    }
}

/* Figura A4.2 of the seed document. */
void test_the_seed_demand_is_figure_a4_2_to_the_digit(void)
{
    static const double expected[SEED_TASKS] = {4.6151, 18.061, 20.7323, 22.5766, 24.8147, 29.7308};

    expect_all(expected, rta_demand_seed);
}

/* Computed once by an independent script in rational arithmetic, as are all figures below. */
void test_the_corrected_demand(void)
{
    static const double horizons[SEED_TASKS] = {4.6151, 18.061, 21.3323, 28.4266, 37.6083, 57.5676};
    static const double switching[SEED_TASKS] = {4.6721, 18.346, 21.7883, 29.0536, 38.4633, 58.8786};

    expect_all(horizons, rta_demand);
    expect_all(switching, rta_demand_switching);
}

void test_the_true_responses_of_the_seed_table(void)
{
    static const double expected[SEED_TASKS] = {0.9461, 2.3086, 2.9155, 2.913, 4.1009, 5.073};

    expect_all(expected, rta_response);
    TEST_ASSERT_TRUE(rta_holds(&table, &options));
}

void test_the_seed_table_grows_5_19_times_before_it_is_late(void)
{
    rta_growth_t growth = rta_growth(&table, &options, false);

    TEST_ASSERT_DOUBLE_WITHIN(2e-5, 5.188649, growth.factor);
    TEST_ASSERT_EQUAL_STRING("TaskReceiveComm", table.row[growth.first_missed].name);
    TEST_ASSERT_DOUBLE_WITHIN(2e-5, 5.095312, rta_growth(&table, &options, true).factor);
}

void test_the_load_of_the_seed_table(void)
{
    rta_load_t load_of = rta_load(&table, &options);

    TEST_ASSERT_DOUBLE_WITHIN(5e-4, 0.155, load_of.kind[RTA_HWI]);
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, 0.007, load_of.kind[RTA_SWI]);
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, 0.028, load_of.kind[RTA_TASK]);
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, 0.004, load_of.switches);
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, 0.194, load_of.total);
}

static void expect_control(double expected_ms)
{
    TEST_ASSERT_EQUAL_DOUBLE(expected_ms, rta_response(&table, &options, task[2]) / RTA_PS_PER_MS);
}

void test_variants_of_the_control_task(void)
{
    options.jitter = 3.0 * RTA_PS_PER_MS;
    expect_control(3.0 + 3.4727);
    options.jitter = 0.0;
    options.bursts = true;
    expect_control(2.7531);
    options.bursts = false;
    for (int i = 0; i < table.rows; i++) {
        table.row[i].cost += table.row[i].kind == RTA_SWI ? options.switches : 0.0;
    }
    expect_control(3.1367);
    load("seed");
    table.row[task[2]].blocking -= 3 * options.switches;
    expect_control(2.7137);
}

void test_from_a_scan_to_the_pulse(void)
{
    const int chain[] = {rta_table_find(&table, "Laser_SWI", 9), task[1], task[2]};

    TEST_ASSERT_EQUAL_DOUBLE(3.0895, rta_chain(&table, &options, chain, 3) / RTA_PS_PER_MS);
    options.bursts = true;
    TEST_ASSERT_EQUAL_DOUBLE(2.9021, rta_chain(&table, &options, chain, 3) / RTA_PS_PER_MS);
}

/* By hand, in microseconds, for the frame's last octet: own 302 + 1020 + 400, 7 accesses, 2 jobs' switches, 3
 * blockings; from above 226.3 + 81 + 124, in 2.7495 ms 3 ticks of 15 + 7.2, octets of 2.4: 8, 23, 3, and of
 * 2: 17, 18. */
void test_from_a_scan_to_the_pulse_of_this_firmware(void)
{
    load("plomada");
    const int chain[] = {rta_table_find(&table, "SCIA_RX", 7), rta_table_find(&table, "Laser_SWI", 9),
                         task[1], task[2]};

    options.bursts = true;
    TEST_ASSERT_EQUAL_DOUBLE(1722 + 7 * 9.3 + 2 * 57 + 3 * 66.3 + 226.3 + 81 + 124 + 3 * 22.2 + 34 * 2.4 +
                                 35 * 2,
                             round(rta_chain(&table, &options, chain, 4) / 1e5) / 10.0);
}

static void expect_task(const char *name, int priority, double period_ms)
{
    int row = rta_table_find(&table, name, (int)strlen(name));

    TEST_ASSERT_TRUE_MESSAGE(row >= 0, name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(priority, table.row[row].priority, name);
    TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(period_ms, table.row[row].period / RTA_PS_PER_MS, name);
}

void test_the_firmware_table_has_the_firmware_s_priorities_and_periods(void)
{
    load("plomada");
    expect_task("TaskIMU", TASK_IMU_PRIORITY, 25);
    expect_task("TaskReceiveLaser", TASK_RECEIVE_LASER_PRIORITY, 100);
    expect_task("TaskControl", TASK_CONTROL_PRIORITY, CONTROL_PERIOD_MS);
    expect_task("TaskSendLaser", TASK_SEND_LASER_PRIORITY, SEND_LASER_SEARCH_MS);
    expect_task("TaskSendComm", TASK_SEND_COMM_PRIORITY, SEND_COMM_PERIOD_MS);
    expect_task("TaskReceiveComm", TASK_RECEIVE_COMM_PRIORITY, 300);
    TEST_ASSERT_EQUAL_INT(SEED_TASKS, tasks);
}

/* Law EST: a cycle for each IMU frame and one for each height, each done before the next frame. */
void test_the_table_of_law_est_differs_in_the_control_task_alone(void)
{
    static rta_table_t other;
    int row = 0;

    load("plomada");
    other = table;
    load("plomada-est");
    expect_task("TaskControl", TASK_CONTROL_PRIORITY, 25);
    expect_task("TaskControl_height", TASK_CONTROL_PRIORITY, 100);
    TEST_ASSERT_EQUAL_INT(other.rows + 1, table.rows);
    for (int i = 0; i < table.rows; i++) {
        rta_row_t expected = other.row[row];

        if (strncmp(table.row[i].name, "TaskControl", 11) == 0) {
            expected = other.row[rta_table_find(&other, "TaskControl", 11)];
            memcpy(expected.name, table.row[i].name, sizeof expected.name);
            expected.period = table.row[i].period;
            expected.deadline = 25 * RTA_PS_PER_MS;
        }
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&expected, &table.row[i], sizeof expected, table.row[i].name);
        row += strcmp(table.row[i].name, "TaskControl_height") != 0;
    }
    TEST_ASSERT_TRUE(rta_holds(&table, &options));
}

/* bsp/uart.h and firmware/uart_port.h: so many octets may wait for an interrupt, and come at once. */
void test_octets_wait_as_the_fifo_levels_let_them(void)
{
    static const struct {
        const char *name;
        double waiting;
    } streams[] = {
        {"SCIA_RX", UART_PORT_BURST - 1},     {"SCIB_RX", UART_PORT_BURST - 1},     {"SCIC_RX", 0},
        {"SCIA_TX", BSP_UART_FIFO_DEPTH - 1}, {"SCIC_TX", BSP_UART_FIFO_DEPTH - 1},
    };

    load("plomada");
    for (size_t i = 0; i < sizeof streams / sizeof streams[0]; i++) {
        const rta_row_t *row = &table.row[rta_table_find(&table, streams[i].name, 7)];

        TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(streams[i].waiting * row->period, row->jitter, row->name);
    }
}

void test_the_firmware_table_counts_the_accesses_of_a_get_of_everything(void)
{
    load("plomada");
    /* one per parameter, one for the reference, and two to note that the link is alive */
    TEST_ASSERT_EQUAL_INT(PARAMETER_COUNT + 3, table.row[task[5]].accesses);
}

void test_the_firmware_s_costs_and_interrupts_are_the_seed_s(void)
{
    static rta_table_t seed;

    seed = table;
    load("plomada");
    TEST_ASSERT_EQUAL_INT(seed.rows + 1, table.rows);
    for (int i = 0; i < seed.rows; i++) {
        int row = rta_table_find(&table, seed.row[i].name, (int)strlen(seed.row[i].name));

        TEST_ASSERT_TRUE_MESSAGE(row >= 0, seed.row[i].name);
        TEST_ASSERT_EQUAL_DOUBLE(seed.row[i].cost, table.row[row].cost);
    }
}

/* The tick looks at all three UARTs. */
void test_the_seed_had_no_tick_that_fetches_octets(void)
{
    rta_ps_t interrupt = table.row[rta_table_find(&table, "SCIA_RX", 7)].cost;

    TEST_ASSERT_LESS_THAN_INT(0, rta_table_find(&table, "Clock_swi", 9));
    load("plomada");
    TEST_ASSERT_EQUAL_DOUBLE(3 * interrupt, table.row[rta_table_find(&table, "Clock_swi", 9)].cost);
}

void test_every_blocking_of_the_firmware_is_one_access(void)
{
    load("plomada");
    for (int i = 0; i < SEED_TASKS; i++) {
        const rta_row_t *row = &table.row[task[i]];

        TEST_ASSERT_EQUAL_DOUBLE(row->blockings * options.access, row->blocking);
    }
}

void test_the_firmware_is_in_time_with_each_release_of_the_control_task(void)
{
    static const char *const fast[] = {"TaskControl.period_ms=25", "TaskControl.deadline_ms=25"};
    static const char *const scan[] = {"TaskControl.period_ms=100", "TaskControl.deadline_ms=100"};
    rta_error_t error;

    load("plomada");
    TEST_ASSERT_TRUE(rta_holds(&table, &options));
    TEST_ASSERT_TRUE(rta_table_set(&table, scan, 2, &error));
    TEST_ASSERT_TRUE(rta_holds(&table, &options));
    TEST_ASSERT_TRUE(rta_table_set(&table, fast, 2, &error));
    TEST_ASSERT_TRUE(rta_holds(&table, &options));
}

void test_another_name_is_no_table(void)
{
    TEST_ASSERT_NULL(rta_table_builtin("SEED"));
    TEST_ASSERT_NULL(rta_table_builtin(""));
}
