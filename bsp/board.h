/* The board as a whole: clocks, pins, peripherals of the LAUNCHXL-F28377S.
 * Call from main() before BIOS_start(), once. */
#ifndef BSP_BOARD_H
#define BSP_BOARD_H

/* Initialises the board, in this order:
 *   - The watchdog is off.
 *   - The throttle pin is low: no pulse, so the autopilot sees a lost receiver.
 *   - SYSCLK is 200 MHz from the crystal (driverlib sets the PLL, not SYS/BIOS), LSPCLK is 100 MHz.
 *   - The throttle has its idle pulse. With wrong clocks a pulse could be too short, which is full thrust.
 *   - The pins of the three UARTs and of the selector are set, the LEDs are off, the microsecond time runs.
 *
 * When the crystal does not start, driverlib waits for ever: the throttle pin stays low, the red LED is on.
 * When driverlib reports a failed crystal, the idle pulse runs from the internal oscillator, the red LED is
 * on, and this function does not return. */
void bsp_board_init(void);

#endif
