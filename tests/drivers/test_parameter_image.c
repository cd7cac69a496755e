#include "drivers/parameter_image.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "unity.h"

#define CELLS_OF_FIVE 19U /* five values: 7 + 2 * 5 + 2, without the filling */

static uint16_t cells[PARAMETER_IMAGE_CELLS_MAX];
static parameter_image_t image;

static void fill(uint16_t count)
{
    image.names = UINT32_C(0x89ABCDEF);
    image.generation = UINT32_C(0x00010002);
    image.count = count;
    for (uint16_t i = 0U; i < count; i++) {
        image.values[i] = (float)i * 0.37F - 3.0F;
    }
}

static parameter_image_status_t read_cells(parameter_image_t *back)
{
    return parameter_image_read(back, cells);
}

void setUp(void)
{
    for (uint16_t i = 0U; i < PARAMETER_IMAGE_CELLS_MAX; i++) {
        cells[i] = 0xFFFFU;
    }
    fill(5U);
}

void tearDown(void) {}

/* CRC-32/ISO-HDLC: its check value of "123456789" is CBF43926H; the cells below by Python's zlib.crc32. */
void test_the_layout_is_pinned(void)
{
    static const uint16_t expected[] = {0x504C, 0x0001, 0x0002, 0xCDEF, 0x89AB, 0x0002, 0x0001, 0x0000,
                                        0x3F80, 0x0000, 0xC120, 0x4DFE, 0xAA18, 0xFFFF, 0xFFFF, 0xFFFF};

    image.count = 2U;
    image.values[0] = 1.0F;
    image.values[1] = -10.0F;
    memset(cells, 0, sizeof cells); /* the filling is written, too */
    TEST_ASSERT_EQUAL_UINT16(16, parameter_image_write(cells, &image));
    TEST_ASSERT_EQUAL_HEX16_ARRAY(expected, cells, 16);
}

void test_what_was_written_is_read_back_whatever_the_count(void)
{
    for (uint16_t count = 1U; count <= PARAMETER_IMAGE_VALUES_MAX; count++) {
        parameter_image_t back;
        uint16_t used;

        setUp();
        fill(count);
        used = parameter_image_write(cells, &image);
        TEST_ASSERT_EQUAL_UINT16(0, used % PARAMETER_IMAGE_BLOCK);
        TEST_ASSERT_TRUE(used <= PARAMETER_IMAGE_CELLS_MAX);
        TEST_ASSERT_EQUAL(PARAMETER_IMAGE_GOOD, read_cells(&back));
        TEST_ASSERT_EQUAL_UINT16(count, back.count);
        TEST_ASSERT_EQUAL_HEX32(image.names, back.names);
        TEST_ASSERT_EQUAL_HEX32(image.generation, back.generation);
        for (uint16_t i = 0U; i < count; i++) {
            TEST_ASSERT_TRUE(image.values[i] == back.values[i]);
        }
    }
}

void test_values_keep_their_bits_also_where_they_are_no_numbers(void)
{
    parameter_image_t back;

    image.values[0] = NAN;
    image.values[1] = -INFINITY;
    image.values[2] = -0.0F;
    image.values[3] = 1.0e-42F;
    (void)parameter_image_write(cells, &image);
    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_GOOD, read_cells(&back));
    TEST_ASSERT_TRUE(isnan(back.values[0]));
    TEST_ASSERT_TRUE(isinf(back.values[1]) && back.values[1] < 0.0F);
    TEST_ASSERT_TRUE(signbit(back.values[2]) != 0);
    TEST_ASSERT_TRUE(back.values[3] == 1.0e-42F);
}

void test_any_flipped_bit_of_any_cell_is_noticed(void)
{
    (void)parameter_image_write(cells, &image);
    for (uint16_t i = 0U; i < CELLS_OF_FIVE; i++) {
        for (uint16_t bit = 0U; bit < 16U; bit++) {
            const uint16_t whole = cells[i];
            parameter_image_t back;

            memset(&back, 0, sizeof back);
            cells[i] = (uint16_t)(whole ^ (1U << bit));
            TEST_ASSERT_NOT_EQUAL(PARAMETER_IMAGE_GOOD, read_cells(&back));
            TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, back.count, "a refused copy was handed out");
            cells[i] = whole;
        }
    }
}

void test_a_copy_cut_off_at_any_cell_is_not_good(void)
{
    uint16_t whole[PARAMETER_IMAGE_CELLS_MAX];
    parameter_image_t back;

    (void)parameter_image_write(cells, &image);
    memcpy(whole, cells, sizeof whole);
    setUp();
    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_NONE, read_cells(&back));
    for (uint16_t i = 0U; i < CELLS_OF_FIVE; i++) {
        TEST_ASSERT_NOT_EQUAL(PARAMETER_IMAGE_GOOD, read_cells(&back));
        cells[i] = whole[i];
    }
    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_GOOD, read_cells(&back));
}

void test_other_versions_and_impossible_counts_are_told_apart(void)
{
    parameter_image_t back;

    (void)parameter_image_write(cells, &image);
    cells[1] = 2U;
    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_VERSION_UNKNOWN, read_cells(&back));
    cells[1] = 0xFFFFU;
    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_DAMAGED, read_cells(&back));
    cells[1] = 1U;
    cells[2] = 0U;
    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_DAMAGED, read_cells(&back));
    cells[2] = PARAMETER_IMAGE_VALUES_MAX + 1U;
    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_DAMAGED, read_cells(&back));
    cells[2] = 0xFFFFU;
    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_DAMAGED, read_cells(&back));
}

void test_random_cells_are_never_a_good_copy(void)
{
    uint32_t state = 20261121U;
    parameter_image_t back;

    printf("seed 20261121\n");
    for (uint16_t round = 0U; round < 2000U; round++) {
        for (uint16_t i = 0U; i < PARAMETER_IMAGE_CELLS_MAX; i++) {
            state = state * UINT32_C(1664525) + UINT32_C(1013904223);
            cells[i] = (uint16_t)(state >> 16);
        }
        cells[0] = 0x504CU;
        cells[1] = 1U;
        cells[2] = (uint16_t)(1U + round % PARAMETER_IMAGE_VALUES_MAX);
        TEST_ASSERT_EQUAL(PARAMETER_IMAGE_DAMAGED, read_cells(&back));
    }
}

static uint32_t names_of(const char *const *names)
{
    uint32_t folded = 0U;

    for (; *names != NULL; names++) {
        folded = parameter_image_name(folded, *names);
    }
    return folded;
}

void test_names_tell_lists_apart_by_content_order_and_borders(void)
{
    static const char *const lists[][4] = {
        {NULL},         {"KP", NULL},       {"KP", "KD", NULL},       {"KD", "KP", NULL},
        {"KPKD", NULL}, {"K", "PKD", NULL}, {"KP", "KD", "KI", NULL}, {"KP", "", "KD", NULL}};
    enum { LISTS = sizeof lists / sizeof lists[0] };

    for (int i = 0; i < LISTS; i++) {
        TEST_ASSERT_EQUAL_HEX32(names_of(lists[i]), names_of(lists[i]));
        for (int k = 0; k < i; k++) {
            TEST_ASSERT_TRUE(names_of(lists[i]) != names_of(lists[k]));
        }
    }
}

void test_newer_holds_across_the_wrap(void)
{
    TEST_ASSERT_TRUE(parameter_image_newer(2U, 1U));
    TEST_ASSERT_FALSE(parameter_image_newer(1U, 2U));
    TEST_ASSERT_FALSE(parameter_image_newer(7U, 7U));
    TEST_ASSERT_TRUE(parameter_image_newer(0U, UINT32_C(0xFFFFFFFF)));
    TEST_ASSERT_FALSE(parameter_image_newer(UINT32_C(0xFFFFFFFF), 0U));
}

void test_of_two_generations_half_the_numbers_apart_neither_is_newer(void)
{
    TEST_ASSERT_TRUE(parameter_image_newer(UINT32_C(0x7FFFFFFF), 0U));
    TEST_ASSERT_FALSE(parameter_image_newer(UINT32_C(0x80000000), 0U));
    TEST_ASSERT_FALSE(parameter_image_newer(0U, UINT32_C(0x80000000)));
}

void test_names_that_differ_in_their_first_character_only_differ(void)
{
    TEST_ASSERT_NOT_EQUAL(parameter_image_name(0U, "KP"), parameter_image_name(0U, "XP"));
}
