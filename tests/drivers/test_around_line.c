/* The line of the sectors. What the page makes of these lines: ground/tests/unit/around.test.ts, with the
 * same vectors, tests/fixtures/around/vectors.txt: the line, then a distance for each sector ("." nothing,
 * "-" nobody looks). */
#include "drivers/around_line.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

static uint16_t sectors[AROUND_LINE_SECTORS];
static telemetry_line_t line;

static void all(uint16_t mm)
{
    for (uint16_t i = 0U; i < AROUND_LINE_SECTORS; ++i) {
        sectors[i] = mm;
    }
}

void setUp(void)
{
    all(AROUND_LINE_UNSEEN);
}

void tearDown(void) {}

static void assert_line(const char *expected)
{
    around_line(&line, sectors, NULL);
    TEST_ASSERT_FALSE(line.overflowed);
    TEST_ASSERT_EQUAL_size_t(strlen(expected), line.length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, line.length);
}

void test_where_nobody_looks_two_rows_are_told(void)
{
    assert_line("w:-z-B\r\n");
}

void test_a_row_of_one_has_its_count_too(void)
{
    all(AROUND_LINE_NOTHING);
    sectors[3] = AROUND_LINE_UNSEEN;
    assert_line("w:...-1....................................................................\r\n");
}

void test_nothing_that_was_met_is_a_point_and_not_unseen(void)
{
    sectors[70] = AROUND_LINE_NOTHING;
    assert_line("w:-z-9.-1\r\n");
}

void test_a_step_begins_where_it_is_told(void)
{
    sectors[0] = 20U;
    sectors[1] = 100U;
    sectors[2] = 105U;
    sectors[3] = 106U;
    sectors[4] = 1034U;
    sectors[5] = 1033U;
    sectors[6] = 3861U;
    sectors[7] = 3862U;
    sectors[8] = 5600U;
    assert_line("w:0001dcyzz-z-2\r\n");
}

/* The greatest that a scanner of 240 degrees can tell. */
void test_the_longest_line_of_a_scanner_of_240_degrees_fits_a_packet(void)
{
    for (uint16_t i = 0U; i < 72U; ++i) {
        sectors[i] = (i < 2U || i > 50U || i == 20U) ? AROUND_LINE_UNSEEN : 1000U;
    }
    around_line(&line, sectors, NULL);
    TEST_ASSERT_FALSE(line.overflowed);
    TEST_ASSERT_EQUAL_size_t(2U + 48U + 3U * 2U + 2U, line.length);
}

/* Cuts the first word off and returns it; NULL: there is none. */
static char *cut_word(char **rest)
{
    char *word = *rest;
    char *end = word;

    while (*end != ' ' && *end != '\n' && *end != '\0') {
        ++end;
    }
    *rest = (*end == '\0') ? end : end + 1;
    *end = '\0';
    return (end == word) ? NULL : word;
}

static uint16_t value_of(const char *word)
{
    if (*word == '.' || *word == '-') {
        return (*word == '.') ? AROUND_LINE_NOTHING : AROUND_LINE_UNSEEN;
    }
    return (uint16_t)strtoul(word, NULL, 10);
}

void test_the_vectors_that_the_page_reads_too(void)
{
    char text[1024];
    int count = 0;
    FILE *file = fopen(FIXTURES "/around/vectors.txt", "r");

    TEST_ASSERT_NOT_NULL(file);
    while (fgets(text, sizeof text, file) != NULL) {
        if (text[0] == '#') {
            continue;
        }
        char *rest = text;
        const char *expected = cut_word(&rest);

        for (uint16_t i = 0U; i < AROUND_LINE_SECTORS; ++i) {
            const char *word = cut_word(&rest);

            TEST_ASSERT_NOT_NULL(word);
            sectors[i] = value_of(word);
        }
        around_line(&line, sectors, NULL);
        TEST_ASSERT_EQUAL_size_t(strlen(expected) + 2U, line.length);
        TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, strlen(expected));
        count++;
    }
    (void)fclose(file);
    TEST_ASSERT_EQUAL_INT(4, count);
}

void test_what_comes_near_stands_behind_the_sectors(void)
{
    const around_line_wall_t near = {44.6F, 1204.0F, 604.0F, 20.0F};
    const char *expected = "w:-z-B near:45,120,60\r\n";

    around_line(&line, sectors, &near);
    TEST_ASSERT_EQUAL_size_t(strlen(expected), line.length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, line.length);
}

void test_the_longest_warning_fits_behind_the_longest_line(void)
{
    const around_line_wall_t near = {359.0F, 4100.0F, 9999.0F, 0.0F};

    for (uint16_t i = 0U; i < 72U; ++i) {
        sectors[i] = (i < 2U || i > 50U || i == 20U) ? AROUND_LINE_UNSEEN : 1000U;
    }
    around_line(&line, sectors, &near);
    TEST_ASSERT_FALSE(line.overflowed);
}

static void assert_drift(const char *expected, const around_line_wall_t walls[], uint16_t count)
{
    around_line_drift(&line, walls, count);
    TEST_ASSERT_FALSE(line.overflowed);
    TEST_ASSERT_EQUAL_size_t(strlen(expected), line.length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, line.length);
}

void test_the_drift_tells_each_wall_with_its_error(void)
{
    const around_line_wall_t walls[] = {
        {-264.6F, 1320.0F, -30.0F, 21.0F}, {365.0F, 2200.0F, 120.0F, 40.0F}, {-0.3F, 999.0F, 0.0F, 0.2F}};

    assert_drift("drift:-\r\n", walls, 0U);
    assert_drift("drift:95,132,-3,2\r\n", walls, 1U);
    assert_drift("drift:95,132,-3,2/5,220,12,4/0,100,0,1\r\n", walls, 3U);
}
