/* The board as a whole: clocks, pins, peripherals of the LAUNCHXL-F28377S.
 * Call from main() before BIOS_start(), once. */
#ifndef BSP_BOARD_H
#define BSP_BOARD_H

/* Watchdog off; throttle pin held low first of all (no pulse: the autopilot sees a lost receiver), idle pulse
 * as soon as the clocks are right (before that a pulse could be too short, which is full thrust); SYSCLK 200
 * MHz from the crystal (the PLL is left to driverlib, not to SYS/BIOS), LSPCLK 100 MHz, the three UARTs'
 * pins, the selector's pin, LEDs off, microsecond time running.
 *
 * A crystal that never starts keeps driverlib waiting for ever: the pin stays low and the red LED lit. A
 * crystal that driverlib reports as failed: the idle pulse runs from the internal oscillator, red LED lit;
 * never returns. */
void bsp_board_init(void);

#endif
