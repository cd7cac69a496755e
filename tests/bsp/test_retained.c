/* Memory that outlives a reset. Its section is looked at directly: a reset, a loss of power and a flipped bit
 * are what the test makes of it. */
#include "bsp/retained.h"

#include <string.h>

#include "unity.h"

/* The file itself: its block is what a reset leaves. */
#include "bsp/retained.c"

static uint32_t back[BSP_RETAINED_WORDS];
static const uint32_t words[BSP_RETAINED_WORDS] = {0x3D4CCCCDUL, 0xBDCCCCCDUL, 0x80000001UL};

void setUp(void)
{
    (void)memset(&block, 0, sizeof block);
    (void)memset(back, 0x5A, sizeof back);
}

void tearDown(void) {}

void test_what_is_stored_is_loaded(void)
{
    bsp_retained_store(words);
    TEST_ASSERT_TRUE(bsp_retained_load(back));
    TEST_ASSERT_EQUAL_HEX32_ARRAY(words, back, BSP_RETAINED_WORDS);
}

void test_the_latest_store_counts(void)
{
    static const uint32_t older[BSP_RETAINED_WORDS] = {1U, 2U, 3U};

    bsp_retained_store(older);
    bsp_retained_store(words);
    TEST_ASSERT_TRUE(bsp_retained_load(back));
    TEST_ASSERT_EQUAL_HEX32_ARRAY(words, back, BSP_RETAINED_WORDS);
}

void test_memory_without_a_store_is_refused_whatever_uniform_value_it_has(void)
{
    for (uint16_t value = 0; value < 256U; value++) {
        (void)memset(&block, value, sizeof block);
        TEST_ASSERT_FALSE(bsp_retained_load(back));
        TEST_ASSERT_EACH_EQUAL_HEX32(0x5A5A5A5AUL, back, BSP_RETAINED_WORDS);
    }
}

void test_any_flipped_bit_and_any_two_are_found(void)
{
    uint32_t *cells = (uint32_t *)&block;
    const uint32_t bits = 32U * (BSP_RETAINED_WORDS + 1U);

    for (uint32_t a = 0; a < bits; a++) {
        for (uint32_t b = a; b < bits; b++) {
            bsp_retained_store(words);
            cells[a / 32U] ^= (uint32_t)1U << (a % 32U);
            cells[b / 32U] ^= (a == b) ? 0U : (uint32_t)1U << (b % 32U);
            TEST_ASSERT_FALSE(bsp_retained_load(back));
        }
    }
}

void test_a_store_that_the_reset_cut_short_is_refused(void)
{
    static const uint32_t newer[BSP_RETAINED_WORDS] = {1U, 2U, 3U};

    for (uint16_t written = 1; written <= BSP_RETAINED_WORDS; written++) {
        bsp_retained_store(words);
        (void)memcpy(block.words, newer, written * sizeof newer[0]);
        TEST_ASSERT_FALSE(bsp_retained_load(back));
    }
}

/* CRC-32 (IEEE 802.3) of the octets 6D 6F 6C 50 CD CC 4C 3D CD CC CC BD 01 00 00 80, by Python's zlib.crc32.
 */
void test_the_sum_is_the_crc_of_magic_and_words_from_the_lowest_octet_on(void)
{
    bsp_retained_store(words);
    TEST_ASSERT_EQUAL_HEX32(0x6A83DD54UL, block.sum);
}
