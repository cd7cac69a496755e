/* Flash wrapper: the used subset of TI's driverlib header of this name, plain functions. */
#ifndef FLASH_H
#define FLASH_H

#include <stdbool.h>
#include <stdint.h>

#include "inc/hw_memmap.h"

typedef enum { FLASH_BANK0_WRAPPER = 0x2, FLASH_BANK1_WRAPPER = 0x1 } Flash_PumpOwnership;

/* Until what was written to the flash's registers is in force. */
void driverlib_flash_delay(void);
#define FLASH_DELAY_CONFIG driverlib_flash_delay()

void Flash_claimPumpSemaphore(uint32_t pumpSemBase, Flash_PumpOwnership wrapper);
void Flash_releasePumpSemaphore(uint32_t pumpSemBase);
void Flash_enableECC(uint32_t eccBase);
void Flash_disableECC(uint32_t eccBase);

#endif
