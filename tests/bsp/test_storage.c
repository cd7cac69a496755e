/* storage.c on the model of the flash. */
#include "bsp/storage.h"

#include <string.h>

#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/sysctl.h"
#include "sim/ti/f021/flash.h"
#include "sim/ti/f021/include/F021_F2837xS_C28x.h"
#include "sim/timeline.h"
#include "unity.h"

static uint16_t cells[BSP_STORAGE_CELLS];

void setUp(void)
{
    timeline_reset();
    chip_reset(NULL);
    flash_blank();
}

/* Whatever a test does: nothing that the library reads may be an NMI, and errors are corrected again. */
void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, chip_nmis(), "NMI");
    TEST_ASSERT_TRUE(flash_corrects());
}

static void fill(uint16_t *block, uint16_t from)
{
    for (uint16_t i = 0U; i < BSP_STORAGE_BLOCK; i++) {
        block[i] = (uint16_t)(from + i * 0x1111U);
    }
}

void test_an_erased_slot_is_blank_throughout(void)
{
    for (uint16_t slot = 0U; slot < BSP_STORAGE_SLOTS; slot++) {
        TEST_ASSERT_TRUE(bsp_storage_erase(slot));
        bsp_storage_read(slot, cells, BSP_STORAGE_CELLS);
        for (uint16_t i = 0U; i < BSP_STORAGE_CELLS; i++) {
            TEST_ASSERT_EQUAL_HEX16(BSP_STORAGE_BLANK, cells[i]);
        }
    }
}

void test_blocks_land_where_they_belong_and_nowhere_else(void)
{
    uint16_t block[BSP_STORAGE_BLOCK];
    const uint16_t last = BSP_STORAGE_CELLS - BSP_STORAGE_BLOCK;

    fill(block, 0x0102U);
    TEST_ASSERT_TRUE(bsp_storage_program(1U, 0U, block));
    TEST_ASSERT_TRUE(bsp_storage_program(1U, last, block));
    bsp_storage_read(1U, cells, BSP_STORAGE_CELLS);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(block, cells, BSP_STORAGE_BLOCK);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(block, &cells[last], BSP_STORAGE_BLOCK);
    TEST_ASSERT_EACH_EQUAL_HEX16(BSP_STORAGE_BLANK, &cells[BSP_STORAGE_BLOCK], last - BSP_STORAGE_BLOCK);
    bsp_storage_read(0U, cells, BSP_STORAGE_CELLS);
    TEST_ASSERT_EACH_EQUAL_HEX16(BSP_STORAGE_BLANK, cells, BSP_STORAGE_CELLS);
}

void test_a_block_is_programmed_once_between_two_erasures(void)
{
    uint16_t block[BSP_STORAGE_BLOCK];

    fill(block, 3U);
    TEST_ASSERT_TRUE(bsp_storage_program(0U, 8U, block));
    TEST_ASSERT_FALSE(bsp_storage_program(0U, 8U, block));
    TEST_ASSERT_TRUE(bsp_storage_erase(0U));
    TEST_ASSERT_TRUE(bsp_storage_program(0U, 8U, block));
}

void test_a_block_that_starts_askew_is_refused(void)
{
    uint16_t block[BSP_STORAGE_BLOCK];

    fill(block, 3U);
    TEST_ASSERT_FALSE(bsp_storage_program(0U, 4U, block));
    TEST_ASSERT_EQUAL(0, flash_cells_changed());
}

void test_a_fault_of_the_flash_is_told(void)
{
    uint16_t block[BSP_STORAGE_BLOCK];

    fill(block, 3U);
    flash_cut_power_after(100);
    TEST_ASSERT_FALSE(bsp_storage_erase(0U));
    TEST_ASSERT_FALSE(bsp_storage_program(1U, 0U, block));
}

void test_a_read_takes_no_more_than_asked(void)
{
    cells[3] = 0xABCDU;
    bsp_storage_read(0U, cells, 3U);
    TEST_ASSERT_EQUAL_HEX16(0xFFFFU, cells[2]);
    TEST_ASSERT_EQUAL_HEX16(0xABCDU, cells[3]);
}

/* driverlib's function ends with the registers closed, and the library that calls back goes on storing. */
void test_the_watchdog_is_serviced_and_the_registers_stay_open_when_the_library_calls_back(void)
{
    SysCtl_serviceWatchdog();
    TEST_ASSERT_FALSE(chip_protected_writable());
    TEST_ASSERT_EQUAL(Fapi_Status_Success, Fapi_serviceWatchdogTimer());
    TEST_ASSERT_TRUE(chip_protected_writable());
}

void test_the_registers_are_closed_again_when_the_flash_is_done_or_has_failed(void)
{
    uint16_t block[BSP_STORAGE_BLOCK];

    fill(block, 3U);
    TEST_ASSERT_TRUE(bsp_storage_erase(0U));
    TEST_ASSERT_FALSE(chip_protected_writable());
    TEST_ASSERT_TRUE(bsp_storage_program(0U, 0U, block));
    TEST_ASSERT_FALSE(chip_protected_writable());
    TEST_ASSERT_FALSE(bsp_storage_program(0U, 4U, block));
    TEST_ASSERT_FALSE(chip_protected_writable());
}
