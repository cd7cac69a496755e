/* The chip's watchdog, and what the latest reset was. */
#ifndef BSP_WATCHDOG_H
#define BSP_WATCHDOG_H

typedef enum {
    BSP_RESET_POWER,        /* power-on */
    BSP_RESET_PIN,          /* the reset pin: push button, debugger */
    BSP_RESET_WATCHDOG,
    BSP_RESET_NMI,          /* an NMI that nobody serviced: missing clock, uncorrectable memory error */
    BSP_RESET_OTHER
} bsp_reset_t;

/* What the latest reset was, and forgets it. main(), once. */
bsp_reset_t bsp_reset_cause(void);

/* From now on the chip is reset when bsp_watchdog_service() was not called for 0.84 s: the 8 bits count internal
 * oscillator 1 (10 MHz within 3 %) / 512 / 64. main(). */
void bsp_watchdog_start(void);

/* Any context, one at a time. */
void bsp_watchdog_service(void);

#endif
