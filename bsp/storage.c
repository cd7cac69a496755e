/* What runs while the bank is busy must not lie in it: these functions and TI's flash library are linked to
 * run from RAM. Waiting for the flash needs no time limit: its state machine gives up by itself. */
#ifdef __TMS320C28XX__
#pragma CODE_SECTION(open_bank, ".TI.ramfunc")
#pragma CODE_SECTION(close_bank, ".TI.ramfunc")
#pragma CODE_SECTION(finished, ".TI.ramfunc")
#pragma CODE_SECTION(bsp_storage_erase, ".TI.ramfunc")
#pragma CODE_SECTION(bsp_storage_program, ".TI.ramfunc")
#pragma CODE_SECTION(Fapi_serviceWatchdogTimer, ".TI.ramfunc")
#pragma CODE_SECTION(SysCtl_serviceWatchdog, ".TI.ramfunc")
#endif

#include "bsp/storage.h"

#include "F021_F2837xS_C28x.h"
#include "device.h"
#include "flash.h"

#define SYSCLK_MHZ (DEVICE_SYSCLK_FREQ / 1000000U)

/* The linker command file says where: 0BC000H. */
extern uint16_t flash_sectors_m_n[BSP_STORAGE_SLOTS][BSP_STORAGE_CELLS];

Fapi_StatusType Fapi_serviceWatchdogTimer(void);

/* Called back by the flash library too, six times while it stores pulse widths and pump voltages: driverlib's
 * function ends with EDIS, and every store of the library behind it would be lost. An erasure may take longer
 * than the watchdog. */
Fapi_StatusType Fapi_serviceWatchdogTimer(void)
{
    SysCtl_serviceWatchdog();
    EALLOW;
    return Fapi_Status_Success;
}

static bool open_bank(void)
{
    Flash_claimPumpSemaphore(FLASHPUMPSEMAPHORE_BASE, FLASH_BANK0_WRAPPER);
    EALLOW;
    return Fapi_initializeAPI(F021_CPU0_W0_BASE_ADDRESS, SYSCLK_MHZ) == Fapi_Status_Success &&
           Fapi_setActiveFlashBank(Fapi_FlashBank0) == Fapi_Status_Success;
}

static void close_bank(void)
{
    Fapi_flushPipeline();
    EDIS;
    Flash_releasePumpSemaphore(FLASHPUMPSEMAPHORE_BASE);
}

static bool finished(Fapi_StatusType issued)
{
    while (Fapi_checkFsmForReady() != Fapi_Status_FsmReady) {
        (void)Fapi_serviceWatchdogTimer();
    }
    return issued == Fapi_Status_Success && Fapi_getFsmStatus() == 0U;
}

void bsp_storage_read(uint16_t slot, uint16_t *cells, uint16_t count)
{
    const volatile uint16_t *stored = flash_sectors_m_n[slot];
    uint16_t i;

    Flash_disableECC(FLASH0ECC_BASE);
    for (i = 0U; i < count; i++) {
        cells[i] = stored[i];
    }
    Flash_enableECC(FLASH0ECC_BASE);
}

bool bsp_storage_erase(uint16_t slot)
{
    const bool erased = open_bank() && finished(Fapi_issueAsyncCommandWithAddress(
                                           Fapi_EraseSector, (uint32 *)(void *)flash_sectors_m_n[slot]));

    close_bank();
    return erased;
}

bool bsp_storage_program(uint16_t slot, uint16_t first, const uint16_t cells[BSP_STORAGE_BLOCK])
{
    uint16 block[BSP_STORAGE_BLOCK];
    bool programmed;
    uint16_t i;

    for (i = 0U; i < BSP_STORAGE_BLOCK; i++) {
        block[i] = cells[i];
    }
    programmed = open_bank() && finished(Fapi_issueProgrammingCommand(
                                    (uint32 *)(void *)&flash_sectors_m_n[slot][first], block,
                                    BSP_STORAGE_BLOCK, 0, 0U, Fapi_AutoEccGeneration));
    close_bank();
    return programmed;
}
