/* What runs while the bank is busy, and what changes the flash's registers, must not lie in the bank: it is
 * linked to run from RAM, as TI's flash library is. Not those functions that driverlib puts there itself
 * (Flash_enableECC). Waiting for the flash needs no time limit: its state machine gives up by itself. */
#ifdef __TMS320C28XX__
#pragma CODE_SECTION(correct_errors, ".TI.ramfunc")
#pragma CODE_SECTION(forget_lines, ".TI.ramfunc")
#pragma CODE_SECTION(activate, ".TI.ramfunc")
#pragma CODE_SECTION(open_bank, ".TI.ramfunc")
#pragma CODE_SECTION(close_bank, ".TI.ramfunc")
#pragma CODE_SECTION(finished, ".TI.ramfunc")
#pragma CODE_SECTION(bsp_storage_read, ".TI.ramfunc")
#pragma CODE_SECTION(bsp_storage_erase, ".TI.ramfunc")
#pragma CODE_SECTION(bsp_storage_program, ".TI.ramfunc")
#pragma CODE_SECTION(Fapi_serviceWatchdogTimer, ".TI.ramfunc")
#pragma CODE_SECTION(Flash_disableECC, ".TI.ramfunc")
#pragma CODE_SECTION(Flash_claimPumpSemaphore, ".TI.ramfunc")
#pragma CODE_SECTION(Flash_releasePumpSemaphore, ".TI.ramfunc")
#pragma CODE_SECTION(SysCtl_serviceWatchdog, ".TI.ramfunc")
#endif

#include "bsp/storage.h"

#include "F021_F2837xS_C28x.h"
#include "device.h"
#include "flash.h"

#define SYSCLK_MHZ (DEVICE_SYSCLK_FREQ / 1000000U)

/* As Fapi_flushPipeline() reads, but that one reads bank 1, which nobody starts. */
#define LINES 4U
#define LINE_DISTANCE 0x100U

/* The linker command file says where: 0BC000H, and where the code begins, in the same bank. */
extern uint16_t flash_sectors_m_n[BSP_STORAGE_SLOTS][BSP_STORAGE_CELLS];
extern const volatile uint16_t flash_code[];

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

static void correct_errors(bool on)
{
    if (on) {
        Flash_enableECC(FLASH0ECC_BASE);
    } else {
        Flash_disableECC(FLASH0ECC_BASE);
    }
    FLASH_DELAY_CONFIG;
}

/* Cache and prefetch hold lines as they were before an erasure: others take their place. */
static void forget_lines(void)
{

    for (uint16_t line = 0U; line < LINES; ++line) {
        (void)flash_code[line * LINE_DISTANCE];
    }
}

/* Without error correction: the library reads 48 of TI's own cells, whose correction bits are wrong on some
 * parts; it would be an NMI ("C2000 Flash FAQ", TI's wiki). TI's own programs do it in the same order
 * (F2837x_sci_flash_kernels.c). */
static bool activate(void)
{

    correct_errors(false);
    EALLOW;
    const bool active = Fapi_initializeAPI(F021_CPU0_W0_BASE_ADDRESS, SYSCLK_MHZ) == Fapi_Status_Success &&
                        Fapi_setActiveFlashBank(Fapi_FlashBank0) == Fapi_Status_Success;
    correct_errors(true);
    return active;
}

static bool open_bank(void)
{

    Flash_claimPumpSemaphore(FLASHPUMPSEMAPHORE_BASE, FLASH_BANK0_WRAPPER);
    const bool active = activate();
    EALLOW;
    return active;
}

static void close_bank(void)
{
    forget_lines();
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

    correct_errors(false);
    for (uint16_t i = 0U; i < count; ++i) {
        cells[i] = stored[i];
    }
    correct_errors(true);
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

    for (uint16_t i = 0U; i < BSP_STORAGE_BLOCK; ++i) {
        block[i] = cells[i];
    }
    const bool programmed = open_bank() && finished(Fapi_issueProgrammingCommand(
                                               (uint32 *)(void *)&flash_sectors_m_n[slot][first], block,
                                               BSP_STORAGE_BLOCK, 0, 0U, Fapi_AutoEccGeneration));
    close_bank();
    return programmed;
}
