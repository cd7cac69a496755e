#include "tools/rta/table.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

#define HEADER "name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings\n"
#define LONG_HEADER \
    "name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings,accesses,burst_n,burst_period_" \
    "ms\n"
#define TASK "A,task,2,10,9.5,0.0024,0.0093,1\n"

static rta_table_t table;
static rta_error_t error;

void setUp(void) {}
void tearDown(void) {}

static void expect_good(const char *text)
{
    TEST_ASSERT_TRUE_MESSAGE(rta_table_read(&table, text, &error), error.reason);
}

static void expect_bad(int line, const char *reason, const char *text)
{
    TEST_ASSERT_FALSE_MESSAGE(rta_table_read(&table, text, &error), text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(line, error.line, error.reason);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.reason, reason), error.reason);
}

static bool set(const char *assignment)
{
    return rta_table_set(&table, &assignment, 1, &error);
}

void test_a_row_is_read_to_the_picosecond(void)
{
    expect_good(HEADER TASK);
    TEST_ASSERT_EQUAL_INT(1, table.rows);
    TEST_ASSERT_EQUAL_STRING("A", table.row[0].name);
    TEST_ASSERT_EQUAL_INT(RTA_TASK, table.row[0].kind);
    TEST_ASSERT_EQUAL_INT(2, table.row[0].priority);
    TEST_ASSERT_EQUAL_DOUBLE(10e9, table.row[0].period);
    TEST_ASSERT_EQUAL_DOUBLE(9.5e9, table.row[0].deadline);
    TEST_ASSERT_EQUAL_DOUBLE(2400000.0, table.row[0].cost);
    TEST_ASSERT_EQUAL_DOUBLE(9300000.0, table.row[0].blocking);
    TEST_ASSERT_EQUAL_INT(1, table.row[0].blockings);
    TEST_ASSERT_EQUAL_INT(0, table.row[0].accesses);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, table.row[0].burst_period);
}

void test_what_interrupts_do_not_have_is_not_looked_at(void)
{
    expect_good(HEADER "I,hwi,HW,0.04,-,0.0024,-,-\nS,Swi,,25,none,0.1,?,-1\n" TASK);
    TEST_ASSERT_EQUAL_INT(3, table.rows);
    TEST_ASSERT_EQUAL_INT(RTA_HWI, table.row[0].kind);
    TEST_ASSERT_EQUAL_INT(RTA_SWI, table.row[1].kind);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, table.row[0].blocking);
    TEST_ASSERT_EQUAL_INT(0, table.row[1].blockings);
}

void test_blanks_comments_cr_lf_and_a_missing_last_line_end_are_fine(void)
{
    expect_good("# mine\r\n\r\n"
                "name, kind ,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings\r\n"
                "\t\n A , task , 1 , 10 , 10 , 1 , , - ");
    TEST_ASSERT_EQUAL_INT(1, table.rows);
    TEST_ASSERT_EQUAL_STRING("A", table.row[0].name);
}

void test_further_columns_are_found_by_name(void)
{
    expect_good("name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings,burst_period_ms,"
                "accesses,burst_n\n"
                "I,hwi,,1,,0.1,,,100,,99\nA,task,1,10,10,1,0,0,,3,\n");
    TEST_ASSERT_EQUAL_INT(99, table.row[0].burst_n);
    TEST_ASSERT_EQUAL_DOUBLE(100e9, table.row[0].burst_period);
    TEST_ASSERT_EQUAL_INT(3, table.row[1].accesses);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, table.row[1].burst_period);
}

void test_jitter_and_who_blocks_are_further_columns_too(void)
{
    expect_good(
        "name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings,jitter_ms,blocked_by\n"
        "I,hwi,,1,,0.1,,,0.25,\nA,task,2,10,10,1,0.1,1,,B+C\nB,task,1,10,10,1,0,0,,-\nC,task,1,10,10,1,0,0,,"
        "\n");
    TEST_ASSERT_EQUAL_DOUBLE(0.25e9, table.row[0].jitter);
    TEST_ASSERT_EQUAL_STRING("B+C", table.row[1].blocked_by);
    TEST_ASSERT_EQUAL_STRING("", table.row[2].blocked_by);
    TEST_ASSERT_TRUE(set("I.jitter_ms=0.5"));
    TEST_ASSERT_EQUAL_DOUBLE(0.5e9, table.row[0].jitter);
    TEST_ASSERT_FALSE(set("A.blocked_by=B"));
    expect_bad(2, "A: blocked_by: no such row",
               "name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings,blocked_by\nA,task,2,"
               "10,10,1,0.1,1,A+D\n");
}

void test_a_wrong_header_is_refused(void)
{
    expect_bad(1, "first line must be name,kind", "");
    expect_bad(1, "first line must be", TASK);
    expect_bad(2, "first line must be", "\nname,kind,priority\n");
    expect_bad(1, "first line must be",
               "kind,name,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings\n" TASK);
    expect_bad(1, "colour: no such column",
               "name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings,colour\n");
    expect_bad(1, "cost_ms: twice",
               "name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings,cost_ms\n");
}

void test_a_table_without_tasks_is_refused(void)
{
    expect_bad(1, "no task", HEADER);
    expect_bad(2, "no task", HEADER "I,hwi,,1,,0.1,,\n");
}

void test_bad_rows_name_their_line_and_column(void)
{
    expect_bad(3, "period_ms: not a time", HEADER TASK "B,task,1,ten,10,1,0,0\n");
    expect_bad(2, "priority: not a whole number", HEADER "B,task,,10,10,1,0,0\n");
    expect_bad(2, "priority", HEADER "B,task,-1,10,10,1,0,0\n");
    expect_bad(2, "priority", HEADER "B,task,1000001,10,10,1,0,0\n");
    expect_bad(2, "deadline_ms: not a time", HEADER "B,task,1,10,,1,0,0\n");
    expect_bad(2, "cost_ms: must be over 0", HEADER "B,task,1,10,10,0,0,0\n");
    expect_bad(2, "period_ms: must be over 0", HEADER "B,task,1,0.0,10,1,0,0\n");
    expect_bad(2, "deadline_ms: over 100000", HEADER "B,task,1,10,100001,1,0,0\n");
    expect_bad(2, "cost_ms: not a time", HEADER "B,task,1,10,10,nan,0,0\n");
    expect_bad(2, "cost_ms: not a time", HEADER "B,task,1,10,10,1e3,0,0\n");
    expect_bad(2, "cost_ms: not a time", HEADER "B,task,1,10,10,-1,0,0\n");
    expect_bad(2, "cost_ms: not a time", HEADER "B,task,1,10,10,1.,0,0\n");
    expect_bad(2, "cost_ms: not a time", HEADER "B,task,1,10,10,.5,0,0\n");
    expect_bad(2, "cost_ms: not a time", HEADER "B,task,1,10,10,1.2.3,0,0\n");
    expect_bad(2, "blockings: not a whole number", HEADER "B,task,1,10,10,1,0,1.5\n");
    expect_bad(2, "kind: not hwi, swi or task", HEADER "B,thread,1,10,10,1,0,0\n");
    expect_bad(2, "name: missing", HEADER ",task,1,10,10,1,0,0\n");
    expect_bad(2, "name: longer", HEADER "B23456789012345678901234567890123,task,1,10,10,1,0,0\n");
    expect_bad(2, "name: holds", HEADER "B\"x,task,1,10,10,1,0,0\n");
    expect_bad(3, "A: twice", HEADER TASK TASK);
    expect_bad(2, "7 cells, not 8", HEADER "B,task,1,10,10,1,0\n");
    expect_bad(2, "9 cells, not 8", HEADER "B,task,1,10,10,1,0,0,\n");
    expect_bad(2, "too long",
               HEADER "B,task,1,10,10,1,0,000000000000000000000000000000000000000000000000000\n");
    expect_bad(2, "go together", LONG_HEADER "I,hwi,,1,,0.1,,,,5,\n" TASK);
    expect_bad(2, "go together", LONG_HEADER "I,hwi,,1,,0.1,,,,,5\n" TASK);
    expect_bad(2, "burst_period_ms: must be over 0", LONG_HEADER "I,hwi,,1,,0.1,,,,5,0\n" TASK);
}

void test_an_endless_line_is_refused(void)
{
    static char text[4000] = HEADER;

    memset(text + strlen(HEADER), 'x', 2000);
    expect_bad(2, "line too long", text);
}

void test_at_most_64_rows(void)
{
    static char text[8000];
    int length = snprintf(text, sizeof text, "%s", HEADER);

    for (int i = 0; i < RTA_ROWS_MAX; i++) {
        length += snprintf(text + length, sizeof text - (size_t)length, "T%d,task,1,10,10,0.01,0,0\n", i);
    }
    expect_good(text);
    TEST_ASSERT_EQUAL_INT(RTA_ROWS_MAX, table.rows);
    snprintf(text + length, sizeof text - (size_t)length, "T64,task,1,10,10,0.01,0,0\n");
    expect_bad(RTA_ROWS_MAX + 2, "over 64 rows", text);
}

void test_any_cut_of_a_table_is_read_or_refused(void)
{
    const char *whole = rta_table_builtin("plomada");
    static char text[RTA_TEXT_MAX];

    for (size_t length = 0; length < strlen(whole); length++) {
        memcpy(text, whole, length);
        text[length] = '\0';
        if (!rta_table_read(&table, text, &error)) {
            TEST_ASSERT_GREATER_THAN_INT(0, error.line);
            TEST_ASSERT_NOT_EQUAL('\0', error.reason[0]);
        }
    }
}

void test_one_number_of_one_row_can_be_set(void)
{
    const char *const frames[] = {"A.burst_period_ms=50", "A.burst_n=4"};

    expect_good(HEADER "I.x,hwi,,1,,0.1,,\n" TASK);
    TEST_ASSERT_TRUE(set("A.period_ms=25.5"));
    TEST_ASSERT_EQUAL_DOUBLE(25.5e9, table.row[1].period);
    TEST_ASSERT_TRUE(set("I.x.cost_ms=0.2"));
    TEST_ASSERT_EQUAL_DOUBLE(0.2e9, table.row[0].cost);
    TEST_ASSERT_TRUE(rta_table_set(&table, frames, 2, &error));
    TEST_ASSERT_EQUAL_INT(4, table.row[1].burst_n);
    TEST_ASSERT_EQUAL_DOUBLE(50e9, table.row[1].burst_period);
}

void test_what_cannot_be_set_says_why(void)
{
    const char *const bad[][2] = {
        {"A", "ROW.COLUMN=VALUE"},      {"A=3", "ROW.COLUMN=VALUE"},      {"=", "ROW.COLUMN=VALUE"},
        {"B.cost_ms=1", "no such row"}, {"A.colour=1", "no such number"}, {"A.name=C", "no such number"},
        {"A.kind=hwi", "no such"},      {"I.deadline_ms=3", "no such"},   {"A.cost_ms=", "not a time"},
        {"A.cost_ms=0", "over 0"},      {"A.priority=x", "whole number"}, {"A.burst_n=3", "go together"},
    };

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        expect_good(HEADER "I,hwi,,1,,0.1,,\n" TASK);
        TEST_ASSERT_FALSE_MESSAGE(set(bad[i][0]), bad[i][0]);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.reason, bad[i][1]), error.reason);
    }
}
