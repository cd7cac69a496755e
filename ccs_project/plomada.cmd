/* Memory of the TMS320F28377S for SYS/BIOS, addresses and lengths in 16-bit words.
 *
 * BEGIN, FLASHA and D01SARAM are names that SYS/BIOS's generated linker file refers to: its reset vector, and the routine
 * that starts the flash, loaded there and run here.
 *
 * Only flash bank 0 is used: the other has a controller of its own, which nobody starts. Its last two sectors, M and N,
 * are bsp/storage.c's. No code lies in the last 16 words of the bank and the last 8 of M1 (erratum: prefetch beyond valid
 * memory).
 *
 * SP has 16 bits, so every stack must lie below 0x10000: the main stack in LS45SARAM, M01SARAM being too small for it
 * (docs/memory.md); in RAMGS02 what SYS/BIOS puts into .ebss:taskStackSection, the idle task's stack and the heap, of
 * which the other tasks' stacks are made.
 *
 * Variables lie in one piece, because bsp/start.c sets them to zero: .ebss must not be split (>>). */
MEMORY
{
PAGE 0:
    BEGIN     : origin = 0x080000, length = 0x000002
    FLASHA    : origin = 0x080002, length = 0x001FFE
    FLASH     : origin = 0x082000, length = 0x03A000    /* sectors B to L */
    LS03SARAM : origin = 0x008000, length = 0x002000
    D01SARAM  : origin = 0x00B000, length = 0x001000
    RESET     : origin = 0x3FFFC0, length = 0x000002

PAGE 1:
    BOOT_RSVD : origin = 0x000002, length = 0x000120    /* stack of the boot ROM */
    M01SARAM  : origin = 0x000122, length = 0x0006D6
    LS45SARAM : origin = 0x00A000, length = 0x001000
    RAMGS02   : origin = 0x00C000, length = 0x002FF0
    RETAINED  : origin = 0x00EFF0, length = 0x000010    /* of GS2; outlives a reset */
    RAMGS39   : origin = 0x00F000, length = 0x0067F8
    RAMGS915  : origin = 0x015800, length = 0x006800    /* from within GS9 on */
}

SECTIONS
{
    codestart   : > BEGIN,  PAGE = 0
    .text       : > FLASH,  PAGE = 0, ALIGN(8), START(_flash_code)
    .cinit      : > FLASH,  PAGE = 0, ALIGN(8)
    .binit      : > FLASH,  PAGE = 0, ALIGN(8)
    .pinit      : > FLASH,  PAGE = 0, ALIGN(8)
    .econst     : >> FLASHA | FLASH, PAGE = 0, ALIGN(8)   /* sector A has little else; FLASH is left to the code */
    .switch     : > FLASH,  PAGE = 0, ALIGN(8)
    .args       : > FLASH,  PAGE = 0, ALIGN(8)
    .reset      : > RESET,  PAGE = 0, TYPE = DSECT      /* not used */

    /* What must run from RAM, TI's flash library with it: copied there by the start-up code, no memcpy in main(). */
    .TI.ramfunc : { *(.TI.ramfunc)
                    -l F021_API_F2837xS_FPU32.lib (.text)
                    -l F021_API_F2837xS_FPU32.lib (.econst) }
                  LOAD = FLASH, RUN = LS03SARAM, table(BINIT), PAGE = 0, ALIGN(8)

    .stack      : > LS45SARAM,  PAGE = 1
    .ebss:taskStackSection : > RAMGS02, PAGE = 1
    .ebss       : > RAMGS39,    PAGE = 1, START(_ebss_start), SIZE(_ebss_size)
    .data       : > RAMGS39,    PAGE = 1
    .esysmem    : > RAMGS39,    PAGE = 1
    .cio        : > RAMGS39,    PAGE = 1
    .retained   : > RETAINED,   PAGE = 1
    .flight_log : > RAMGS915,   PAGE = 1
}

/* COFF puts an underscore before C's names. */
_flash_sectors_m_n = 0x0BC000;
