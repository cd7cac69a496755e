#include "tools/rta/analysis.h"

#include <math.h>
#include <stdio.h>

#include "unity.h"

#define MS(x) round((x)*RTA_PS_PER_MS)

static rta_table_t table;
static rta_options_t options;
static unsigned long state;

void setUp(void)
{
    table.rows = 0;
    options = (rta_options_t){.switches = 0.0};
}

void tearDown(void) {}

static rta_row_t *add(rta_kind_t kind, int priority, double period_ms, double deadline_ms, double cost_ms)
{
    rta_row_t *row = &table.row[table.rows++];

    *row = (rta_row_t){.kind = kind,
                       .priority = priority,
                       .period = MS(period_ms),
                       .deadline = MS(deadline_ms),
                       .cost = MS(cost_ms)};
    snprintf(row->name, sizeof row->name, "row%d", table.rows);
    return row;
}

static void expect_response(double expected_ms, int task)
{
    TEST_ASSERT_EQUAL_DOUBLE(expected_ms, rta_response(&table, &options, task) / RTA_PS_PER_MS);
}

/* ---- known answers ---- */

/* Burns and Wellings, Real-Time Systems and Programming Languages: periods 7, 12, 20, costs 3, 3, 5. */
void test_textbook_responses_of_three_tasks(void)
{
    add(RTA_TASK, 3, 7, 7, 3);
    add(RTA_TASK, 2, 12, 12, 3);
    add(RTA_TASK, 1, 20, 20, 5);
    expect_response(3, 0);
    expect_response(6, 1);
    expect_response(20, 2);
    TEST_ASSERT_TRUE(rta_holds(&table, &options));
}

/* The same book: harmonic periods 80, 40, 20, the processor fully used, and still in time. */
void test_a_full_processor_may_be_in_time(void)
{
    add(RTA_TASK, 1, 80, 80, 40);
    add(RTA_TASK, 2, 40, 40, 10);
    add(RTA_TASK, 3, 20, 20, 5);
    expect_response(80, 0);
    expect_response(15, 1);
    expect_response(5, 2);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, rta_load(&table, &options).total);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, round(rta_growth(&table, &options, false).factor * 1e5) / 1e5);
}

/* Lehoczky 1990, deadlines beyond the period: responses of the second task's jobs are 114, 102, 116, 104,
 * 118, 106, 94. */
void test_the_worst_job_of_a_busy_window_need_not_be_its_first(void)
{
    add(RTA_TASK, 2, 70, 70, 26);
    add(RTA_TASK, 1, 100, 118, 62);
    expect_response(26, 0);
    expect_response(118, 1);
    TEST_ASSERT_TRUE(rta_holds(&table, &options));
    table.row[1].deadline = MS(117.9);
    TEST_ASSERT_FALSE(rta_holds(&table, &options));
}

void test_an_overloaded_level_has_no_bound(void)
{
    add(RTA_TASK, 2, 2, 2, 1.5);
    add(RTA_TASK, 1, 4, 1000, 1.1);
    expect_response(1.5, 0);
    TEST_ASSERT_TRUE(isinf(rta_response(&table, &options, 1)));
    TEST_ASSERT_FALSE(rta_holds(&table, &options));
    TEST_ASSERT_TRUE(rta_growth(&table, &options, false).factor < 1.0);
    TEST_ASSERT_EQUAL_INT(1, rta_growth(&table, &options, false).first_missed);
}

void test_a_busy_window_without_end_has_no_bound(void)
{
    rta_row_t *task = add(RTA_TASK, 1, 4, 1000, 4);

    task->blocking = MS(1);
    TEST_ASSERT_TRUE(isinf(rta_response(&table, &options, 0)));
}

/* By hand: w = 3 + ceil(w/4) gives 4; one ms of jitter makes it 3 + ceil((w+1)/4) = 5, seen 6 after the due
 * time. */
void test_jitter_brings_releases_closer_and_adds_to_the_response(void)
{
    add(RTA_TASK, 2, 4, 4, 1);
    add(RTA_TASK, 1, 20, 20, 3);
    expect_response(4, 1);
    options.jitter = MS(1);
    expect_response(2, 0);
    expect_response(6, 1);
}

/* By hand: 2 + 0.5 ceil(w) = 4 as a stream of one per ms; frames of 3 in 10 ms give 2 + 3 x 0.5 = 3.5. */
void test_a_frame_costs_no_more_than_its_octets(void)
{
    rta_row_t *stream = add(RTA_HWI, 0, 1, 0, 0.5);

    add(RTA_TASK, 1, 100, 100, 2);
    stream->burst_n = 3;
    stream->burst_period = MS(10);
    expect_response(4, 1);
    options.bursts = true;
    expect_response(3.5, 1);
    table.row[1].cost = MS(8.5);
    expect_response(10, 1);
    table.row[1].cost = MS(9);
    expect_response(11, 1);
    TEST_ASSERT_EQUAL_DOUBLE(0.15, rta_load(&table, &options).kind[RTA_HWI]);
    stream->burst_n = 0;
    expect_response(9, 1);
}

/* A frame may come late and the next in time, but octets of a wire come no closer: by hand, w = 9 + 0.5 (3 +
 * 3), w = 2 + 0.5 x 3 and, with frames of 10, w = 2 + 0.5 ceil(w). */
void test_late_frames_do_not_speed_up_the_wire(void)
{
    rta_row_t *stream = add(RTA_HWI, 0, 1, 0, 0.5);

    add(RTA_TASK, 1, 100, 100, 9);
    stream->burst_n = 3;
    stream->burst_period = MS(10);
    options.bursts = true;
    options.jitter = MS(5);
    expect_response(5 + 12, 1);
    table.row[1].cost = MS(2);
    expect_response(5 + 3.5, 1);
    stream->burst_n = 10;
    stream->burst_period = MS(20);
    expect_response(5 + 4, 1);
}

/* By hand: 1 + 0.1 own, 2 x 0.05 + 2 x 0.1 blocked, 2 + 0.1 from above; the Swi switches nothing. */
void test_switches_count_per_job_and_per_blocking_and_not_for_interrupts(void)
{
    rta_row_t *low;

    add(RTA_SWI, 0, 50, 0, 0.5);
    add(RTA_TASK, 2, 50, 50, 2);
    low = add(RTA_TASK, 1, 50, 50, 1);
    low->blocking = MS(0.1);
    low->blockings = 2;
    options.switches = MS(0.1);
    expect_response(1.1 + 0.3 + 2.1 + 0.5, 2);
    TEST_ASSERT_EQUAL_DOUBLE(0.004, rta_load(&table, &options).switches);
}

void test_server_accesses_add_to_the_cost_of_their_task(void)
{
    add(RTA_TASK, 2, 50, 50, 1)->accesses = 3;
    add(RTA_TASK, 1, 50, 50, 1)->accesses = 2;
    options.access = MS(0.01);
    expect_response(1.03, 0);
    expect_response(2.05, 1);
    TEST_ASSERT_EQUAL_DOUBLE(MS(2.05), rta_demand(&table, &options, 1));
}

void test_equal_priorities_count_against_each_other(void)
{
    add(RTA_TASK, 1, 50, 50, 1);
    add(RTA_TASK, 1, 50, 50, 2);
    expect_response(3, 0);
    expect_response(3, 1);
}

/* By hand: the last of the chain waits for its own blocking (0.1) and for that of the one before (0.2). */
void test_a_chain_bears_the_blocking_of_all_its_members(void)
{
    const int chain[] = {0, 1, 2};

    add(RTA_SWI, 0, 100, 0, 0.5);
    add(RTA_TASK, 2, 100, 100, 2)->blocking = MS(0.2);
    add(RTA_TASK, 1, 100, 100, 1)->blocking = MS(0.1);
    expect_response(3.6, 2);
    TEST_ASSERT_EQUAL_DOUBLE(MS(3.8), rta_chain(&table, &options, chain, 3));
    TEST_ASSERT_EQUAL_DOUBLE(MS(3.6), rta_chain(&table, &options, &chain[2], 1));
}

/* By hand: own 3 and the Swi's 0.5, then 0.1 and a switch of 0.01 for each blocking, 0.01 for each of the two
 * jobs. */
void test_a_task_blocks_a_chain_once_at_most(void)
{
    const int chain[] = {0, 1, 2};

    add(RTA_SWI, 0, 100, 0, 0.5);
    for (int i = 1; i <= 2; i++) {
        rta_row_t *row = add(RTA_TASK, 5 - i, 100, 100, 3 - i);

        row->blockings = 2;
        row->blocking = MS(0.2);
    }
    options.switches = MS(0.01);
    TEST_ASSERT_EQUAL_DOUBLE(MS(3.96), rta_chain(&table, &options, chain, 3));
    snprintf(table.row[1].blocked_by, sizeof table.row[1].blocked_by, "low+lower");
    TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(MS(3.96), rta_chain(&table, &options, chain, 3),
                                     "the last one's blockers are not told");
    snprintf(table.row[2].blocked_by, sizeof table.row[2].blocked_by, "lower+lowest");
    TEST_ASSERT_EQUAL_DOUBLE(MS(3.85), rta_chain(&table, &options, chain, 3));
    snprintf(table.row[2].blocked_by, sizeof table.row[2].blocked_by, "low+lower");
    TEST_ASSERT_EQUAL_DOUBLE(MS(3.74), rta_chain(&table, &options, chain, 3));
    table.row[1].blockings = table.row[2].blockings = 0;
    table.row[1].blocking = table.row[2].blocking = 0.0;
    TEST_ASSERT_EQUAL_DOUBLE(MS(3.52), rta_chain(&table, &options, chain, 3));
}

/* By hand: up to 3 octets wait for the fourth, so a window of 2 ms sees 5: 2 + 0.05 x 5 = 2.25, which ends
 * within the same octet's time; the wait of the task itself adds to its response. */
void test_what_waits_comes_at_once(void)
{
    rta_row_t *stream = add(RTA_HWI, 0, 1, 0, 0.05);
    rta_row_t *task = add(RTA_TASK, 1, 100, 100, 1.7);

    expect_response(1.8, 1);
    stream->jitter = MS(3);
    expect_response(1.95, 1);
    task->jitter = MS(0.5);
    expect_response(2.45, 1);
    stream->burst_n = 4;
    stream->burst_period = MS(50);
    options.bursts = true;
    expect_response(0.5 + 1.7 + 0.2, 1);
}

/* By hand, frames of 10 octets, 1 ms each, in 50 ms: a chain that begins with a frame's last octet sees that
 * one and no other before 40 ms have gone; one that does not sees all 10. */
void test_a_frame_that_has_ended_does_not_come_again_at_once(void)
{
    const int chain[] = {0, 1, 2};
    rta_row_t *stream = add(RTA_HWI, 0, 1, 0, 0.5);

    add(RTA_SWI, 0, 1000, 0, 2);
    add(RTA_TASK, 1, 1000, 1000, 3);
    stream->burst_n = 10;
    stream->burst_period = MS(50);
    TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(MS(10), rta_chain(&table, &options, chain, 3), "an endless stream");
    options.bursts = true;
    TEST_ASSERT_EQUAL_DOUBLE(MS(5.5), rta_chain(&table, &options, chain, 3));
    TEST_ASSERT_EQUAL_DOUBLE(MS(10), rta_chain(&table, &options, &chain[1], 2));
    table.row[2].cost = MS(30);
    TEST_ASSERT_EQUAL_DOUBLE(MS(32.5), rta_chain(&table, &options, chain, 3));
    TEST_ASSERT_EQUAL_DOUBLE(MS(37), rta_chain(&table, &options, &chain[1], 2));
    stream->jitter = MS(2);
    TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(MS(33.5), rta_chain(&table, &options, chain, 3),
                                     "two had waited for the last");
    table.row[2].cost = MS(37.6);
    TEST_ASSERT_TRUE_MESSAGE(rta_chain(&table, &options, chain, 3) > MS(41.1), "the next frame");
}

void test_tasks_are_listed_by_priority_and_equals_in_their_order(void)
{
    int index[RTA_ROWS_MAX];

    add(RTA_TASK, 1, 10, 10, 1);
    add(RTA_HWI, 0, 10, 0, 1);
    add(RTA_TASK, 7, 10, 10, 1);
    add(RTA_TASK, 1, 10, 10, 1);
    add(RTA_TASK, 3, 10, 10, 1);
    TEST_ASSERT_EQUAL_INT(4, rta_tasks(&table, index));
    TEST_ASSERT_EQUAL_INT(2, index[0]);
    TEST_ASSERT_EQUAL_INT(4, index[1]);
    TEST_ASSERT_EQUAL_INT(0, index[2]);
    TEST_ASSERT_EQUAL_INT(3, index[3]);
}

/* By hand: interrupts of 0.1 per 1 ms; the first and second are counted up to the second deadline (20), the
 * third up to the third (30), where the last task's true demand has 30 of each. */
void test_the_seed_freezes_the_horizon_of_each_interrupt(void)
{
    add(RTA_HWI, 0, 1, 0, 0.1);
    add(RTA_HWI, 0, 1, 0, 0.1);
    add(RTA_HWI, 0, 1, 0, 0.1);
    add(RTA_TASK, 3, 10, 10, 1);
    add(RTA_TASK, 2, 20, 20, 1);
    add(RTA_TASK, 1, 30, 30, 1);
    TEST_ASSERT_EQUAL_DOUBLE(MS(3 + 1), rta_demand_seed(&table, &options, 3));
    TEST_ASSERT_EQUAL_DOUBLE(MS(6 + 2 + 1), rta_demand_seed(&table, &options, 4));
    TEST_ASSERT_EQUAL_DOUBLE(MS(2 + 2 + 3 + 3 + 2 + 1), rta_demand_seed(&table, &options, 5));
    TEST_ASSERT_EQUAL_DOUBLE(MS(3 + 3 + 3 + 3 + 2 + 1), rta_demand(&table, &options, 5));
    options.switches = MS(0.5);
    TEST_ASSERT_EQUAL_DOUBLE(MS(3 + 3 + 3 + 3 + 2 + 1 + 6 * 0.5), rta_demand_switching(&table, &options, 5));
}

void test_one_task_alone_has_one_horizon(void)
{
    add(RTA_HWI, 0, 1, 0, 0.1);
    add(RTA_HWI, 0, 1, 0, 0.1);
    add(RTA_TASK, 1, 10, 10, 1);
    TEST_ASSERT_EQUAL_DOUBLE(MS(3), rta_demand_seed(&table, &options, 2));
}

void test_a_window_that_ends_with_a_release_does_not_count_it(void)
{
    add(RTA_HWI, 0, 0.04, 0, 0.0024);
    add(RTA_TASK, 1, 1000, 1000, 0.1 - 3 * 0.0024);
    expect_response(0.1, 1);
    table.row[1].cost += MS(0.02);
    expect_response(0.12, 1);
    table.row[1].cost += 1.0;
    TEST_ASSERT_EQUAL_DOUBLE(MS(0.1224) + 1.0, rta_response(&table, &options, 1));
}

/* ---- random tables ---- */

static double random_of(double least, double most)
{
    state = (state * 1103515245UL + 12345UL) & 0x7FFFFFFFUL;
    return least + (most - least) * ((double)(state >> 8) / (double)(0x7FFFFFFFUL >> 8));
}

static int random_int(int least, int most)
{
    int value = least + (int)random_of(0.0, (double)(most - least + 1));

    return value > most ? most : value;
}

static void random_table(unsigned long seed)
{
    state = seed * 2654435761UL + 1UL;
    table.rows = 0;
    for (int i = random_int(0, 3); i > 0; i--) {
        rta_row_t *row = add(RTA_HWI, 0, random_of(0.5, 5), 0, random_of(0.01, 0.1));

        if (random_int(0, 1) == 1) {
            row->burst_n = random_int(0, 5);
            row->burst_period = MS(random_of(5, 50));
        }
        row->jitter = MS(random_of(0, 1) * random_int(0, 1));
    }
    for (int i = random_int(0, 2); i > 0; i--) {
        add(RTA_SWI, 0, random_of(10, 100), 0, random_of(0.1, 1));
    }
    for (int i = random_int(1, 5); i > 0; i--) {
        double period_ms = random_of(10, 200);
        rta_row_t *row = add(RTA_TASK, random_int(1, 6), period_ms, period_ms * random_of(0.3, 1.0),
                             random_of(0.2, 8));

        row->blockings = random_int(0, 3);
        row->blocking = MS(random_of(0, 0.3) * row->blockings);
        row->accesses = random_int(0, 4);
    }
    options = (rta_options_t){.switches = MS(random_of(0, 0.1)),
                              .access = MS(random_of(0, 0.05)),
                              .jitter = 0.0,
                              .bursts = random_int(0, 1) == 1};
}

static char note[64];
#define ASSERT_FOR(seed, condition) \
    do { \
        snprintf(note, sizeof note, "table of seed %lu", (seed)); \
        TEST_ASSERT_TRUE_MESSAGE((condition), note); \
    } while (0)

static void responses(rta_ps_t response[RTA_ROWS_MAX])
{
    for (int i = 0; i < table.rows; i++) {
        response[i] = table.row[i].kind == RTA_TASK ? rta_response(&table, &options, i) : 0.0;
    }
}

static bool none_shorter(const rta_ps_t *before, const rta_ps_t *after)
{
    for (int i = 0; i < table.rows; i++) {
        if (after[i] < before[i]) {
            return false;
        }
    }
    return true;
}

void test_dearer_later_or_more_blocked_never_shortens_a_response(void)
{
    for (unsigned long seed = 1; seed <= 500; seed++) {
        rta_ps_t before[RTA_ROWS_MAX], after[RTA_ROWS_MAX];
        int row;

        random_table(seed);
        responses(before);
        row = random_int(0, table.rows - 1);
        table.row[row].cost += MS(random_of(0, 0.5));
        responses(after);
        ASSERT_FOR(seed, none_shorter(before, after));
        ASSERT_FOR(seed, table.row[row].kind != RTA_TASK || after[row] > before[row] || isinf(before[row]));
        row = table.rows - 1;
        table.row[row].blocking += MS(0.1);
        responses(before);
        ASSERT_FOR(seed, none_shorter(after, before) && (before[row] > after[row] || isinf(after[row])));
        options.jitter = MS(random_of(0.1, 3));
        responses(after);
        ASSERT_FOR(seed, none_shorter(before, after));
        options.bursts = false;
        responses(before);
        ASSERT_FOR(seed, none_shorter(after, before));
    }
}

void test_a_response_is_at_least_the_job_and_at_most_the_demand_that_fits(void)
{
    int fitting = 0;

    for (unsigned long seed = 1; seed <= 500; seed++) {
        random_table(seed);
        options.bursts = false;
        for (int i = 0; i < table.rows; i++) {
            const rta_row_t *row = &table.row[i];
            rta_ps_t demand = rta_demand_switching(&table, &options, i);

            if (row->kind != RTA_TASK) {
                continue;
            }
            ASSERT_FOR(seed, rta_demand_seed(&table, &options, i) <= rta_demand(&table, &options, i));
            ASSERT_FOR(seed, rta_demand(&table, &options, i) <= demand);
            ASSERT_FOR(seed,
                       rta_response(&table, &options, i) >= row->cost + options.switches + row->blocking);
            if (demand <= row->deadline) {
                fitting++;
                ASSERT_FOR(seed, rta_response(&table, &options, i) <= demand);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(300, fitting);
}

void test_all_holds_exactly_when_each_response_is_in_time(void)
{
    int held = 0;

    for (unsigned long seed = 1; seed <= 500; seed++) {
        rta_ps_t response[RTA_ROWS_MAX];
        bool in_time = true;

        random_table(seed);
        responses(response);
        for (int i = 0; i < table.rows; i++) {
            in_time = in_time && (table.row[i].kind != RTA_TASK || response[i] <= table.row[i].deadline);
        }
        ASSERT_FOR(seed, in_time == rta_holds(&table, &options));
        held += in_time ? 1 : 0;
    }
    TEST_ASSERT_INT_WITHIN(200, 250, held);
}

void test_growth_is_the_edge(void)
{
    for (unsigned long seed = 1; seed <= 200; seed++) {
        random_table(seed);
        for (int switches_too = 0; switches_too < 2; switches_too++) {
            rta_growth_t growth = rta_growth(&table, &options, switches_too == 1);

            ASSERT_FOR(seed, growth.factor > 0.0 && table.row[growth.first_missed].kind == RTA_TASK);
            ASSERT_FOR(seed, rta_holds_scaled(&table, &options, growth.factor, switches_too == 1));
            ASSERT_FOR(seed,
                       !rta_holds_scaled(&table, &options, growth.factor * 1.000001, switches_too == 1));
            ASSERT_FOR(seed, rta_holds(&table, &options) ==
                                 rta_holds_scaled(&table, &options, 1.0, switches_too == 1));
        }
    }
}

/* By hand: f (1 + 1 + 2) + 2 = 10 or, with the switches, f (1 + 1 + 2 + 2) = 10. */
void test_accesses_and_critical_sections_grow_as_well(void)
{
    rta_row_t *task = add(RTA_TASK, 1, 10, 10, 1);

    task->accesses = 1;
    task->blocking = MS(2);
    task->blockings = 1;
    options.access = MS(1);
    options.switches = MS(1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 2.0, rta_growth(&table, &options, false).factor);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 10.0 / 6.0, rta_growth(&table, &options, true).factor);
}

void test_growth_is_zero_when_no_cost_is_to_blame(void)
{
    add(RTA_TASK, 1, 10, 10, 1);
    options.jitter = MS(11);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, rta_growth(&table, &options, false).factor);
}

/* ---- against a schedule played tick by tick ---- */

/* Longest response of each task when all are released together and the processor runs the first of those that
 * wait. */
static void play(int ticks, int worst[RTA_ROWS_MAX])
{
    int released[RTA_ROWS_MAX] = {0}, finished[RTA_ROWS_MAX] = {0}, left[RTA_ROWS_MAX] = {0};

    for (int i = 0; i < table.rows; i++) {
        worst[i] = 0;
    }
    for (int now = 0; now < ticks; now++) {
        int run = -1;

        for (int i = 0; i < table.rows; i++) {
            int period = (int)(table.row[i].period / RTA_PS_PER_MS);

            released[i] += now % period == 0 ? 1 : 0;
            if (released[i] > finished[i] && (run < 0 || table.row[i].priority > table.row[run].priority)) {
                run = i;
            }
        }
        if (run < 0) {
            return;
        }
        left[run] = left[run] > 0 ? left[run] : (int)(table.row[run].cost / RTA_PS_PER_MS);
        left[run]--;
        if (left[run] == 0) {
            int response = now + 1 - finished[run] * (int)(table.row[run].period / RTA_PS_PER_MS);

            finished[run]++;
            worst[run] = response > worst[run] ? response : worst[run];
        }
    }
}

void test_responses_equal_those_of_a_schedule_played_tick_by_tick(void)
{
    int played = 0, beyond_period = 0;

    for (unsigned long seed = 1; seed <= 2000; seed++) {
        int worst[RTA_ROWS_MAX], count;

        state = seed * 2654435761UL + 7UL;
        table.rows = 0;
        count = random_int(1, 4);
        for (int i = 0; i < count; i++) {
            int period = random_int(3, 40);

            add(RTA_TASK, 10 - i, period, 4 * period, random_int(1, 1 + period / 3));
        }
        if (rta_load(&table, &options).total >= 1.0) {
            continue;
        }
        play(20000, worst);
        played++;
        for (int i = 0; i < count; i++) {
            snprintf(note, sizeof note, "table of seed %lu", seed);
            TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(MS(worst[i]), rta_response(&table, &options, i), note);
            beyond_period += MS(worst[i]) > table.row[i].period ? 1 : 0;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(1000, played);
    TEST_ASSERT_GREATER_THAN_INT(10, beyond_period);
}
