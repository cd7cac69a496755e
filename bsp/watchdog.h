/* The chip's watchdog. */
#ifndef BSP_WATCHDOG_H
#define BSP_WATCHDOG_H

/* From now on the chip is reset when bsp_watchdog_service() was not called for 0.84 s: the 8 bits count
 * internal oscillator 1 (10 MHz within 3 %) / 512 / 64. main(). */
void bsp_watchdog_start(void);

/* Any context, one at a time. */
void bsp_watchdog_service(void);

#endif
