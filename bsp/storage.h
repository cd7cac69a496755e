/* Non-volatile storage: the last two sectors (M and N) of flash bank 0 as two slots of 16-bit cells. main()
 * or Task.
 *
 * While the bank is erased or programmed nothing can be read from it, not even code: the caller turns
 * interrupts off around each call below that changes a slot. The functions themselves run from RAM.
 * Interrupts wait meanwhile: some tens of milliseconds for the erasure of a young sector, longer as it ages
 * (data sheet, flash parameters), well below one for a block. The throttle pulse goes on as it is, the
 * watchdog is serviced, octets that come in are lost. */
#ifndef BSP_STORAGE_H
#define BSP_STORAGE_H

#include <stdbool.h>
#include <stdint.h>

#define BSP_STORAGE_SLOTS 2U
#define BSP_STORAGE_CELLS 8192U   /* of a slot */
#define BSP_STORAGE_BLOCK 8U      /* cells that are programmed together, once between two erasures */
#define BSP_STORAGE_BLANK 0xFFFFU /* an erased cell */

/* Copies the first `count` cells of a slot (count <= BSP_STORAGE_CELLS), whatever is there: the error
 * correction is off meanwhile, because cells whose erasure or programming was cut off would raise an NMI. */
void bsp_storage_read(uint16_t slot, uint16_t *cells, uint16_t count);

/* Erases a slot. False when the flash reports a fault. */
bool bsp_storage_erase(uint16_t slot);

/* Programs one block of an erased slot, from cell `first` (a multiple of BSP_STORAGE_BLOCK). False when the
 * flash reports a fault. */
bool bsp_storage_program(uint16_t slot, uint16_t first, const uint16_t cells[BSP_STORAGE_BLOCK]);

#endif
