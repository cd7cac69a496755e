/* The first C code after a reset: called by SYS/BIOS's start-up code (ccs_project/app.cfg, Reset.fxns), on
 * the main stack, before any variable has its initial value. Do not call it from elsewhere.
 *
 * Switches the watchdog off; it runs from reset and would reset the chip after 13 ms. Sets every variable
 * without an initialiser to zero, because all of the firmware relies on that. In the COFF format neither
 * compiler nor linker nor TI's start-up code does it ("Initializing Static and Global Variables in COFF ABI
 * Mode", SPRU514). */
#ifndef BSP_START_H
#define BSP_START_H

void bsp_start(void);

#endif
