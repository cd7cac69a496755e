/* The sum at the end of lines. */
#include "drivers/line_sum.h"

#include <string.h>

#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static uint16_t sum_of(const char *text)
{
    return line_sum(text, (uint16_t)strlen(text));
}

/* 29B1 is the check value of CRC-16/CCITT-FALSE in every catalogue of CRCs; the others by Python:
 * binascii.crc_hqx(text, 0xFFFF). */
void test_the_sum_is_the_ccitt_one_from_ffff(void)
{
    TEST_ASSERT_EQUAL_HEX16(0x29B1, sum_of("123456789"));
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, sum_of(""));
    TEST_ASSERT_EQUAL_HEX16(0x9383, sum_of("#SETR 0.6"));
    TEST_ASSERT_EQUAL_HEX16(0x2FB1, sum_of("OK LOG 1 0.007,,,,,,,,GROUND,0"));
}

void test_it_is_written_as_four_digits_in_upper_case(void)
{
    static const struct {
        uint16_t sum;
        const char *digits;
    } rows[] = {{0x0000U, "0000"}, {0x00A1U, "00A1"}, {0xFFFFU, "FFFF"}, {0x9BCDU, "9BCD"}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char digits[LINE_SUM_DIGITS + 1U] = {'~', '~', '~', '~', '~'};

        line_sum_write(digits, rows[i].sum);
        TEST_ASSERT_EQUAL_STRING_LEN(rows[i].digits, digits, LINE_SUM_DIGITS);
        TEST_ASSERT_EQUAL('~', digits[LINE_SUM_DIGITS]);
    }
}

/* What a radio's noise does: every single bit, and every pair of neighbours exchanged. */
void test_any_changed_bit_and_any_exchanged_pair_changes_it(void)
{
    static const char line[] = "#SETR 0.65";
    const uint16_t whole = sum_of(line);

    for (size_t at = 0; at < strlen(line); at++) {
        for (int bit = 0; bit < 8; bit++) {
            char other[sizeof line];

            (void)memcpy(other, line, sizeof line);
            other[at] = (char)(other[at] ^ (1 << bit));
            TEST_ASSERT_NOT_EQUAL(whole, line_sum(other, (uint16_t)strlen(line)));
        }
        if (at > 0U && line[at] != line[at - 1U]) {
            char other[sizeof line];

            (void)memcpy(other, line, sizeof line);
            other[at] = line[at - 1U];
            other[at - 1U] = line[at];
            TEST_ASSERT_NOT_EQUAL(whole, sum_of(other));
        }
    }
}
