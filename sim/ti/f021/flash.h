/* What the PC board asks of the flash model: the last two sectors of bank 0, which keep their cells from
 * power-on to power-on of the board, and which may lose power in the middle of an operation. The firmware
 * never includes this.
 *
 * TI's library reads cells of TI's own, whose correction bits are wrong on some parts, while it makes a bank
 * active, and cells of bank 1, which nobody starts, when it flushes the pipeline. Both are an NMI
 * (chip_nmi()); the first is none while the error correction is off. What it was at then ends without
 * success.
 *
 * An erased cell is FFFFH; programming only clears bits, eight cells at a time, once between two erasures. No
 * operation takes virtual time. */
#ifndef SIM_TI_F021_FLASH_H
#define SIM_TI_F021_FLASH_H

#include <stdbool.h>

#define FLASH_SECTORS 2
#define FLASH_SECTOR_CELLS 8192

/* All cells erased, power for ever. So it is at first. */
void flash_blank(void);

/* The cells from and to a file of FLASH_SECTORS * FLASH_SECTOR_CELLS cells of two octets, the low one first.
 * A file that does not exist loads as blank. A store replaces the file in one step: whenever it is
 * interrupted, the file is the old one or the new one. NULL when fine; else what failed, and cells and file
 * stay as they were. */
const char *flash_load(const char *path);
const char *flash_store(const char *path);

/* All cells at once, the lower sector first, as flash_load() and flash_store() see them. */
void flash_read_all(unsigned short cells[FLASH_SECTORS * FLASH_SECTOR_CELLS]);
void flash_write_all(const unsigned short cells[FLASH_SECTORS * FLASH_SECTOR_CELLS]);

/* Power fails after so many more cells have been erased or programmed: the next one is left half done, and
 * nothing changes any more. Negative: never. Power is back with the next call of this function or of
 * flash_blank(). */
void flash_cut_power_after(long cells);

/* Cells erased and programmed since flash_blank(). */
long flash_cells_changed(void);

/* Whether errors in bank 0 are corrected now. */
bool flash_corrects(void);

#endif
