/* storage.c on mocks of driverlib and of the flash library, every call in its order. */
#include "bsp/storage.h"

#include <signal.h>
#include <sys/mman.h>

#include "mock_F021_F2837xS_C28x.h"
#include "mock_cpu.h"
#include "mock_flash.h"
#include "mock_sysctl.h"
#include "unity.h"

#define PAGE 4096

/* The bank's code: a read of it traps while nothing else may be read there, and is counted. */
extern const volatile uint16_t flash_code[PAGE / sizeof(uint16_t)];
const volatile uint16_t flash_code[PAGE / sizeof(uint16_t)] __attribute__((aligned(PAGE)));
static volatile int code_reads;

uint16_t flash_sectors_m_n[BSP_STORAGE_SLOTS][BSP_STORAGE_CELLS];
Fapi_FmcRegistersType f021_registers;
int GlobalExpectCount, GlobalVerifyOrder;

static void protect_code(int how)
{
    TEST_ASSERT_EQUAL_INT(0, mprotect((void *)(uintptr_t)flash_code, PAGE, how));
}

static void on_read(int signal_number)
{
    (void)signal_number;
    code_reads++;
    protect_code(PROT_READ);
}

void setUp(void)
{
    GlobalExpectCount = GlobalVerifyOrder = 0;
    code_reads = 0;
    (void)signal(SIGSEGV, on_read);
    protect_code(PROT_NONE);
}

void tearDown(void)
{
    (void)signal(SIGSEGV, SIG_DFL);
    protect_code(PROT_READ);
}

static void expect_correction(bool on)
{
    if (on) {
        Flash_enableECC_Expect(0x0005FB00U);
    } else {
        Flash_disableECC_Expect(0x0005FB00U);
    }
    driverlib_flash_delay_Expect();
}

static void expect_open(void)
{
    Flash_claimPumpSemaphore_Expect(0x00050024U, FLASH_BANK0_WRAPPER);
    expect_correction(false);
    driverlib_eallow_Expect();
    Fapi_initializeAPI_ExpectAndReturn(&f021_registers, 200U, Fapi_Status_Success);
    Fapi_setActiveFlashBank_ExpectAndReturn(Fapi_FlashBank0, Fapi_Status_Success);
    expect_correction(true);
    driverlib_eallow_Expect();
}

static void expect_close(void)
{
    driverlib_edis_Expect();
    Flash_releasePumpSemaphore_Expect(0x00050024U);
}

static void expect_wait(unsigned busy)
{
    for (; busy > 0U; busy--) {
        Fapi_checkFsmForReady_ExpectAndReturn(Fapi_Status_FsmBusy);
        SysCtl_serviceWatchdog_Expect();
        driverlib_eallow_Expect();
    }
    Fapi_checkFsmForReady_ExpectAndReturn(Fapi_Status_FsmReady);
}

void test_cells_are_read_with_the_error_correction_off(void)
{
    uint16_t cells[2];

    flash_sectors_m_n[1][1] = 0x1234U;
    expect_correction(false);
    expect_correction(true);
    bsp_storage_read(1U, cells, 2U);
    TEST_ASSERT_EQUAL_HEX16(0x1234U, cells[1]);
}

void test_an_erasure_waits_for_the_flash_and_services_the_watchdog_meanwhile(void)
{
    expect_open();
    Fapi_issueAsyncCommandWithAddress_ExpectAndReturn(
        Fapi_EraseSector, (uint32 *)(void *)flash_sectors_m_n[1], Fapi_Status_Success);
    expect_wait(3U);
    Fapi_getFsmStatus_ExpectAndReturn(0U);
    expect_close();
    TEST_ASSERT_TRUE(bsp_storage_erase(1U));
}

void test_a_status_other_than_zero_is_a_fault(void)
{
    expect_open();
    Fapi_issueAsyncCommandWithAddress_ExpectAndReturn(
        Fapi_EraseSector, (uint32 *)(void *)flash_sectors_m_n[0], Fapi_Status_Success);
    expect_wait(1U);
    Fapi_getFsmStatus_ExpectAndReturn(0x10U);
    expect_close();
    TEST_ASSERT_FALSE(bsp_storage_erase(0U));
}

void test_a_block_is_programmed_with_its_error_correction(void)
{
    const uint16_t cells[BSP_STORAGE_BLOCK] = {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U};

    expect_open();
    Fapi_issueProgrammingCommand_ExpectAndReturn((uint32 *)(void *)&flash_sectors_m_n[0][16],
                                                 (uint16 *)(uintptr_t)cells, 8U, NULL, 0U,
                                                 Fapi_AutoEccGeneration, Fapi_Status_Success);
    Fapi_issueProgrammingCommand_IgnoreArg_pu16DataBuffer();
    expect_wait(2U);
    Fapi_getFsmStatus_ExpectAndReturn(0U);
    expect_close();
    TEST_ASSERT_TRUE(bsp_storage_program(0U, 16U, cells));
}

void test_a_library_that_refuses_to_start_is_a_fault_and_the_pump_is_given_back(void)
{
    Flash_claimPumpSemaphore_Expect(0x00050024U, FLASH_BANK0_WRAPPER);
    expect_correction(false);
    driverlib_eallow_Expect();
    Fapi_initializeAPI_ExpectAndReturn(&f021_registers, 200U, Fapi_Error_InvalidHclkValue);
    expect_correction(true);
    driverlib_eallow_Expect();
    expect_close();
    TEST_ASSERT_FALSE(bsp_storage_erase(0U));
}

/* Else the controller might answer the first read behind an erasure with what it held before. */
void test_lines_that_the_flash_controller_holds_are_replaced_by_others_of_the_same_bank(void)
{
    expect_open();
    Fapi_issueAsyncCommandWithAddress_ExpectAndReturn(
        Fapi_EraseSector, (uint32 *)(void *)flash_sectors_m_n[1], Fapi_Status_Success);
    expect_wait(0U);
    Fapi_getFsmStatus_ExpectAndReturn(0U);
    expect_close();
    TEST_ASSERT_TRUE(bsp_storage_erase(1U));
    TEST_ASSERT_EQUAL_INT(1, code_reads);
}
