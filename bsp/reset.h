/* Cause of the chip's latest reset. */
#ifndef BSP_RESET_H
#define BSP_RESET_H

typedef enum {
    BSP_RESET_POWER, /* power-on */
    BSP_RESET_PIN,   /* the reset pin: push button, debugger */
    BSP_RESET_WATCHDOG,
    BSP_RESET_NMI, /* an NMI that was not serviced: missing clock, uncorrectable memory error */
    BSP_RESET_OTHER
} bsp_reset_t;

/* Returns the cause of the latest reset and clears it. main(), once. */
bsp_reset_t bsp_reset_cause(void);

#endif
