/* The first C code after a reset: called by SYS/BIOS's start-up code (ccs_project/app.cfg, Reset.fxns), on
 * the main stack, before any variable has its initial value. Nobody else calls it.
 *
 * Turns the watchdog off, which runs from reset and bites after 13 ms. Sets every variable without an
 * initialiser to zero: in the COFF format neither compiler nor linker nor TI's start-up code does
 * ("Initializing Static and Global Variables in COFF ABI Mode", SPRU514), and all of the firmware relies on
 * it. */
#ifndef BSP_START_H
#define BSP_START_H

void bsp_start(void);

#endif
