/* The chip's watchdog. */
#ifndef BSP_WATCHDOG_H
#define BSP_WATCHDOG_H

/* Starts the watchdog. It resets the chip when bsp_watchdog_service() is not called for 0.84 s: its 8 bits
 * count internal oscillator 1 (10 MHz within 3 %) / 512 / 64. main(). */
void bsp_watchdog_start(void);

/* Services the watchdog. Any context, one at a time. */
void bsp_watchdog_service(void);

#endif
