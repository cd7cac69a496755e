/* The store on the real storage.c and the model of the flash; only SYS/BIOS is mocked. */
#include "firmware/parameter_store.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "kernel.h"
#include "drivers/parameter_image.h"
#include "sim/ti/f021/flash.h"
#include "bsp/storage.h"
#include "unity.h"

extern uint16_t flash_sectors_m_n[FLASH_SECTORS][FLASH_SECTOR_CELLS];
bool __real_bsp_storage_erase(uint16_t slot);
bool __real_bsp_storage_program(uint16_t slot, uint16_t first, const uint16_t cells[BSP_STORAGE_BLOCK]);

static parameters_t parameters;
static parameter_store_result_t result;

bool __wrap_bsp_storage_erase(uint16_t slot)
{
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(1, kernel.hwi.depth, "interrupts are on while the flash is busy");
    return __real_bsp_storage_erase(slot);
}

static bool cell_sticks; /* a cell that was not programmed, and nobody says so */

bool __wrap_bsp_storage_program(uint16_t slot, uint16_t first, const uint16_t cells[BSP_STORAGE_BLOCK])
{
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(1, kernel.hwi.depth, "interrupts are on while the flash is busy");
    const bool programmed = __real_bsp_storage_program(slot, first, cells);

    if (cell_sticks && first == BSP_STORAGE_BLOCK) {
        flash_sectors_m_n[slot][first] ^= 1U;
    }
    return programmed;
}

void setUp(void)
{
    kernel_reset();
    cell_sticks = false;
    flash_blank();
    parameters_init(&parameters);
}

void tearDown(void)
{
    kernel_check();
}

/* A set in which every number tells which set it is. */
static void mark(float number)
{
    parameters.value[PARAMETER_KP] = 0.001F * number;
    parameters.value[PARAMETER_KD] = 0.002F * number;
    parameters.value[PARAMETER_KI] = 0.003F * number;
    parameters.value[PARAMETER_LINK] = number;
}

static float marked(void)
{
    const float number = parameters.value[PARAMETER_LINK];

    TEST_ASSERT_TRUE_MESSAGE(parameters.value[PARAMETER_KP] == 0.001F * number &&
                                 parameters.value[PARAMETER_KD] == 0.002F * number &&
                                 parameters.value[PARAMETER_KI] == 0.003F * number,
                             "a mix of two sets");
    return number;
}

static parameter_store_status_t save(float number)
{
    mark(number);
    result = parameter_store_save(&parameters, 0U);
    return result.status;
}

static parameter_store_status_t load(void)
{
    parameters_init(&parameters);
    result = parameter_store_load(&parameters);
    return result.status;
}

static void assert_loads(float number, uint32_t generation)
{
    TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, load());
    TEST_ASSERT_EQUAL_FLOAT(number, marked());
    TEST_ASSERT_EQUAL_UINT32(generation, result.generation);
}

/* Changes a stored copy: decodes it, lets the caller edit it, writes it back with a right sum. */
static void edit(uint16_t slot, void (*change)(parameter_image_t *image))
{
    static parameter_image_t image;

    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_GOOD, parameter_image_read(&image, flash_sectors_m_n[slot]));
    change(&image);
    (void)parameter_image_write(flash_sectors_m_n[slot], &image);
}

static void assert_nothing_loads(parameter_store_status_t why)
{
    parameters_t before;

    mark(33.0F);
    parameters.generation = 77U;
    before = parameters;
    result = parameter_store_load(&parameters);
    TEST_ASSERT_EQUAL(why, result.status);
    TEST_ASSERT_EQUAL_MEMORY(&before, &parameters, sizeof before);
}

void test_every_value_comes_back(void)
{
    parameters_t expected;

    for (uint16_t id = 0U; id < PARAMETER_COUNT; id++) {
        const parameter_row_t *row = &parameter_table[id];

        parameters.value[id] = row->choices != NULL ? row->maximum
                                                    : row->minimum * 0.7F + row->maximum * 0.3F;
    }
    expected = parameters;
    result = parameter_store_save(&parameters, 0U);
    TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, result.status);
    parameters_init(&parameters);
    result = parameter_store_load(&parameters);
    TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, result.status);
    TEST_ASSERT_EQUAL_MEMORY(expected.value, parameters.value, sizeof expected.value);
    TEST_ASSERT_TRUE_MESSAGE(parameters.generation > 0U, "readers must see that something changed");
}

void test_the_set_has_room(void)
{
    TEST_ASSERT_TRUE(PARAMETER_COUNT <= PARAMETER_IMAGE_VALUES_MAX);
}

void test_saves_take_the_two_slots_in_turn_and_the_newer_one_counts(void)
{
    for (uint16_t i = 1U; i <= 9U; i++) {
        TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, save((float)i));
        TEST_ASSERT_EQUAL_UINT32(i, result.generation);
        assert_loads((float)i, i);
    }
}

void test_an_empty_storage_is_told(void)
{
    assert_nothing_loads(PARAMETER_STORE_EMPTY);
}

void test_a_damaged_newer_copy_leaves_the_older_one(void)
{
    (void)save(1.0F);
    (void)save(2.0F);
    flash_sectors_m_n[1][9] ^= 1U;
    assert_loads(1.0F, 1U);
    (void)save(3.0F);
    assert_loads(3.0F, 2U);
    flash_sectors_m_n[0][9] ^= 1U;
    assert_loads(3.0F, 2U);
    flash_sectors_m_n[1][9] ^= 1U;
    assert_nothing_loads(PARAMETER_STORE_DAMAGED);
}

static void other_names(parameter_image_t *image)
{
    image->names ^= 0x10U;
}

static void one_value_less(parameter_image_t *image)
{
    image->count--;
}

void test_copies_of_other_parameters_are_refused_and_kept_as_long_as_there_is_room(void)
{
    (void)save(1.0F);
    edit(0U, other_names);
    assert_nothing_loads(PARAMETER_STORE_FOREIGN);
    TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, save(2.0F));
    assert_loads(2.0F, 2U);
    TEST_ASSERT_EQUAL_HEX16(0x504CU, flash_sectors_m_n[0][0]);
    edit(1U, one_value_less);
    assert_nothing_loads(PARAMETER_STORE_FOREIGN);
    TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, save(3.0F));
    assert_loads(3.0F, 3U);
}

/* Folded here once more: a set under an old name, or with a choice under another, must not be read as this
 * one. */
static uint32_t names_of_parameters(void)
{
    uint32_t names = 0U;

    for (uint16_t id = 0U; id < PARAMETER_COUNT; id++) {
        const parameter_row_t *row = &parameter_table[id];

        names = parameter_image_name(names, row->name);
        for (uint16_t i = 0U; row->choices != NULL && i <= (uint16_t)row->maximum; i++) {
            names = parameter_image_name(names, row->choices[i]);
        }
    }
    return names;
}

void test_a_copy_is_signed_with_the_names_of_all_parameters_and_choices(void)
{
    uint16_t cells[PARAMETER_IMAGE_CELLS_MAX];
    parameter_image_t image;
    const uint32_t names = parameter_image_name(names_of_parameters(), "laser power-up rate");

    TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, save(1.0F));
    bsp_storage_read(0U, cells, PARAMETER_IMAGE_CELLS_MAX);
    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_GOOD, parameter_image_read(&image, cells));
    TEST_ASSERT_EQUAL_HEX32(names, image.names);
}

void test_a_foreign_newer_copy_does_not_hide_our_older_one(void)
{
    (void)save(1.0F);
    (void)save(2.0F);
    edit(1U, other_names);
    assert_loads(1.0F, 1U);
    (void)save(3.0F);
    assert_loads(3.0F, 3U);
}

void test_another_layout_is_refused(void)
{
    (void)save(1.0F);
    flash_sectors_m_n[0][1] = 2U;
    assert_nothing_loads(PARAMETER_STORE_FOREIGN);
}

static void too_much_kd(parameter_image_t *image)
{
    image->values[PARAMETER_KD] = 1.5F;
}

static void no_number(parameter_image_t *image)
{
    image->values[PARAMETER_KP] = NAN;
}

static void half_a_choice(parameter_image_t *image)
{
    image->values[PARAMETER_LAW] = 0.5F;
}

void test_a_value_outside_its_limits_refuses_the_whole_copy_and_is_named(void)
{
    static const struct {
        void (*change)(parameter_image_t *image);
        parameter_id_t culprit;
    } cases[] = {{too_much_kd, PARAMETER_KD}, {no_number, PARAMETER_KP}, {half_a_choice, PARAMETER_LAW}};

    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        setUp();
        (void)save(1.0F);
        edit(0U, cases[i].change);
        assert_nothing_loads(PARAMETER_STORE_RANGE);
        TEST_ASSERT_EQUAL(cases[i].culprit, result.parameter);
    }
}

static void last_generation(parameter_image_t *image)
{
    image->generation = UINT32_C(0xFFFFFFFF);
}

void test_generations_wrap(void)
{
    (void)save(1.0F);
    edit(0U, last_generation);
    TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, save(2.0F));
    assert_loads(2.0F, 0U);
    TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, save(3.0F));
    assert_loads(3.0F, 1U);
}

void test_a_cell_that_does_not_take_is_a_fault_and_the_copy_before_counts(void)
{
    (void)save(1.0F);
    flash_cut_power_after(FLASH_SECTOR_CELLS + 3);
    TEST_ASSERT_EQUAL(PARAMETER_STORE_FAULT, save(2.0F));
    assert_loads(1.0F, 1U);
}

static void cut_and_check(long cut, const uint16_t *before, float old, float new)
{
    char where[40];

    (void)snprintf(where, sizeof where, "power failed after %ld cells", cut);
    memcpy(flash_sectors_m_n, before, sizeof flash_sectors_m_n);
    flash_cut_power_after(cut);
    (void)save(new);
    flash_cut_power_after(-1);
    TEST_ASSERT_EQUAL_MESSAGE(PARAMETER_STORE_DONE, load(), where);
    if (marked() != old) {
        TEST_ASSERT_EQUAL_FLOAT_MESSAGE(new, marked(), where);
    }
    TEST_ASSERT_EQUAL_MESSAGE(PARAMETER_STORE_DONE, save(9.0F), where);
    TEST_ASSERT_EQUAL_MESSAGE(PARAMETER_STORE_DONE, load(), where);
    TEST_ASSERT_EQUAL_FLOAT_MESSAGE(9.0F, marked(), where);
}

void test_power_may_fail_at_every_cell_of_a_save(void)
{
    static uint16_t before[FLASH_SECTORS * FLASH_SECTOR_CELLS];
    long cells;

    for (uint16_t saves = 1U; saves <= 3U; saves++) { /* one copy, two, the older one in either slot */
        setUp();
        for (uint16_t i = 1U; i <= saves; i++) {
            (void)save((float)i);
        }
        memcpy(before, flash_sectors_m_n, sizeof before);
        cells = flash_cells_changed();
        (void)save(8.0F);
        cells = flash_cells_changed() - cells;
        TEST_ASSERT_TRUE(cells > FLASH_SECTOR_CELLS + 16 &&
                         cells <= FLASH_SECTOR_CELLS + PARAMETER_IMAGE_CELLS_MAX);
        for (long cut = 0; cut <= cells; cut += (cut < 200 || cut >= FLASH_SECTOR_CELLS - 1) ? 1 : 13) {
            cut_and_check(cut, before, (float)saves, 8.0F);
        }
    }
}

void test_the_first_save_ever_may_fail_and_nothing_is_loaded_then(void)
{
    for (long cut = FLASH_SECTOR_CELLS; cut < FLASH_SECTOR_CELLS + 16; cut++) {
        setUp();
        flash_cut_power_after(cut);
        TEST_ASSERT_EQUAL(PARAMETER_STORE_FAULT, save(1.0F));
        flash_cut_power_after(-1);
        TEST_ASSERT_NOT_EQUAL(PARAMETER_STORE_DONE, load());
    }
}

void test_what_was_programmed_is_read_back(void)
{
    cell_sticks = true;
    TEST_ASSERT_EQUAL(PARAMETER_STORE_FAULT, save(1.0F));
    cell_sticks = false;
    TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, save(2.0F));
    assert_loads(2.0F, 1U);
}

/* A newer copy of another version is overwritten first: the own one stays until the new one is complete. */
void test_a_save_keeps_the_latest_copy_of_its_own_version(void)
{
    static parameter_image_t image;

    (void)save(1.0F);
    (void)save(2.0F);
    const uint16_t newer = (parameter_image_read(&image, flash_sectors_m_n[1]) == PARAMETER_IMAGE_GOOD &&
                            image.generation == 2U)
                               ? 1U
                               : 0U;
    edit(newer, other_names);
    TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, save(3.0F));
    TEST_ASSERT_EQUAL(PARAMETER_IMAGE_GOOD, parameter_image_read(&image, flash_sectors_m_n[1U - newer]));
    TEST_ASSERT_EQUAL_UINT32(1U, image.generation);
    assert_loads(3.0F, 3U);
}

/* ---- the scanner's power-up rate ---- */

void test_the_scanners_rate_comes_back_and_is_kept_while_it_is_not_known(void)
{
    TEST_ASSERT_EQUAL_UINT32(0U, parameter_store_laser_rate());
    mark(3.0F);
    (void)parameter_store_save(&parameters, 19200U);
    TEST_ASSERT_EQUAL_UINT32(19200U, parameter_store_laser_rate());
    for (uint32_t i = 0U; i < 3U; i++) { /* in either slot */
        TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, save(4.0F));
        TEST_ASSERT_EQUAL_UINT32(19200U, parameter_store_laser_rate());
    }
    (void)parameter_store_save(&parameters, 250000U);
    TEST_ASSERT_EQUAL_UINT32(250000U, parameter_store_laser_rate());
    assert_loads(4.0F, 5U);
}

/* As it was stored before. */
static void without_rate(parameter_image_t *image)
{
    image->count = PARAMETER_COUNT;
    image->names = names_of_parameters();
}

void test_a_copy_without_the_scanners_rate_still_loads(void)
{
    (void)save(6.0F);
    edit(0U, without_rate);
    assert_loads(6.0F, 1U);
    TEST_ASSERT_EQUAL_UINT32(0U, parameter_store_laser_rate());
    mark(7.0F);
    (void)parameter_store_save(&parameters, 57600U);
    assert_loads(7.0F, 2U);
    TEST_ASSERT_EQUAL_UINT32(57600U, parameter_store_laser_rate());
}

/* As a firmware stored it that did not know LAYOUT and what is behind it. */
static uint32_t names_of_older(void)
{
    uint32_t names = 0U;

    for (uint16_t id = 0U; id < PARAMETER_LAYOUT; id++) {
        const parameter_row_t *row = &parameter_table[id];

        names = parameter_image_name(names, row->name);
        for (uint16_t i = 0U; row->choices != NULL && i <= (uint16_t)row->maximum; i++) {
            names = parameter_image_name(names, row->choices[i]);
        }
    }
    return names;
}

static void older(parameter_image_t *image)
{
    image->count = PARAMETER_LAYOUT;
    image->names = names_of_older();
}

static void older_with_rate(parameter_image_t *image)
{
    image->values[PARAMETER_LAYOUT] = 57600.0F;
    image->count = PARAMETER_LAYOUT + 1U;
    image->names = parameter_image_name(names_of_older(), "laser power-up rate");
}

void test_a_copy_of_an_older_firmware_loads_and_what_it_lacks_is_as_it_flew_then(void)
{
    static void (*const edits[])(parameter_image_t * image) = {older, older_with_rate};

    for (uint16_t i = 0U; i < 2U; i++) {
        flash_blank();
        (void)save(6.0F);
        edit(0U, edits[i]);
        parameters.value[PARAMETER_LAYOUT] = (float)LAYOUT_TWO; /* in force before #LOAD */
        parameters.value[PARAMETER_S1] = 200.0F;
        result = parameter_store_load(&parameters);
        TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, result.status);
        TEST_ASSERT_EQUAL_FLOAT(6.0F, marked());
        TEST_ASSERT_EQUAL_FLOAT((float)LAYOUT_FRONT, parameters.value[PARAMETER_LAYOUT]);
        TEST_ASSERT_EQUAL_FLOAT(128.0F, parameters.value[PARAMETER_S1]);
        TEST_ASSERT_EQUAL_UINT32(i == 0U ? 0U : 57600U, parameter_store_laser_rate());
        TEST_ASSERT_EQUAL(PARAMETER_STORE_DONE, save(7.0F)); /* keeps the rate */
        TEST_ASSERT_EQUAL_UINT32(i == 0U ? 0U : 57600U, parameter_store_laser_rate());
    }
}

static void older_out_of_range(parameter_image_t *image)
{
    older(image);
    image->values[PARAMETER_KD] = 1.5F;
}

void test_an_older_copy_with_a_value_out_of_range_changes_nothing(void)
{
    (void)save(6.0F);
    edit(0U, older_out_of_range);
    assert_nothing_loads(PARAMETER_STORE_RANGE);
}

static void with_another_rate(parameter_image_t *image)
{
    image->values[PARAMETER_COUNT] = 9600.0F;
}

static void with_another_count(parameter_image_t *image)
{
    image->count = PARAMETER_COUNT;
}

void test_a_rate_that_is_none_of_scips_is_none_and_a_copy_cut_short_is_foreign(void)
{
    mark(8.0F);
    (void)parameter_store_save(&parameters, 19200U);
    edit(0U, with_another_rate);
    TEST_ASSERT_EQUAL_UINT32(0U, parameter_store_laser_rate());
    assert_loads(8.0F, 1U);
    edit(0U, with_another_count);
    assert_nothing_loads(PARAMETER_STORE_FOREIGN);
    TEST_ASSERT_EQUAL_UINT32(0U, parameter_store_laser_rate());
}
