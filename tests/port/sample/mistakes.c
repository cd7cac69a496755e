/* What passes on a PC and is wrong on a C28x, a test each: test_machine.py sees which of the runs finds it.
 */
#include <stddef.h>
#include <stdint.h>

#include "drivers/octet.h"
#include "unity.h"

static volatile uint16_t one = 1;

void setUp(void) {}

void tearDown(void) {}

void test_right_everywhere(void)
{
    TEST_ASSERT_EQUAL_UINT16(300, 299 + one);
}

void test_wrong_everywhere(void)
{
    TEST_ASSERT_EQUAL_UINT16(299, 299 + one);
}

void test_an_octet_wraps_at_256(void)
{
    octet_t sum = 255;

    sum = (octet_t)(sum + one);
    TEST_ASSERT_EQUAL_UINT16(0, sum);
}

void test_an_int_has_32_bits(void)
{
    const int product = 300 * (int)one * 300;

    TEST_ASSERT_TRUE(product / 300 == 300);
}

void test_a_long_has_four_sizes_of_char(void)
{
    TEST_ASSERT_TRUE(sizeof(uint32_t) == 4U * sizeof(char));
}

void test_a_char_is_negative_above_127(void)
{
    const char c = (char)(127 + one);

    TEST_ASSERT_TRUE(c < 0);
}
