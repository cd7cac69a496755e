/* Non-volatile storage: the last two sectors (M and N) of flash bank 0 as two slots of 16-bit cells. main()
 * or Task.
 *
 * While the bank is erased or programmed, nothing can be read from it, not even code. So the caller disables
 * the interrupts around each call below that changes a slot. These functions run from RAM. To erase a new
 * sector takes some tens of milliseconds, longer when it is old (data sheet, flash parameters). To program a
 * block takes well below one millisecond. Meanwhile the throttle pulse does not change, the watchdog is
 * serviced, and received octets are lost. */
#ifndef BSP_STORAGE_H
#define BSP_STORAGE_H

#include <stdbool.h>
#include <stdint.h>

#define BSP_STORAGE_SLOTS 2U
#define BSP_STORAGE_CELLS 8192U   /* cells in a slot */
#define BSP_STORAGE_BLOCK 8U      /* cells that are programmed together, once between two erasures */
#define BSP_STORAGE_BLANK 0xFFFFU /* an erased cell */

/* Copies the first `count` cells of a slot, count <= BSP_STORAGE_CELLS, with any content. The error
 * correction is off during the copy, because incompletely erased or programmed cells would cause an NMI. */
void bsp_storage_read(uint16_t slot, uint16_t *cells, uint16_t count);

/* Erases a slot. Returns false when the flash reports a fault. */
bool bsp_storage_erase(uint16_t slot);

/* Programs one block of an erased slot. first: its first cell, a multiple of BSP_STORAGE_BLOCK. Returns false
 * when the flash reports a fault. */
bool bsp_storage_program(uint16_t slot, uint16_t first, const uint16_t cells[BSP_STORAGE_BLOCK]);

#endif
