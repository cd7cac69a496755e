/* What the latest reset of the chip was. */
#ifndef BSP_RESET_H
#define BSP_RESET_H

typedef enum {
    BSP_RESET_POWER, /* power-on */
    BSP_RESET_PIN,   /* the reset pin: push button, debugger */
    BSP_RESET_WATCHDOG,
    BSP_RESET_NMI, /* an NMI that nobody serviced: missing clock, uncorrectable memory error */
    BSP_RESET_OTHER
} bsp_reset_t;

/* What the latest reset was, and forgets it. main(), once. */
bsp_reset_t bsp_reset_cause(void);

#endif
