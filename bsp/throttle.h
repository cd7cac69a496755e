/* The throttle pulse on ePWM2A (GPIO2, J8.80): period 13.6 ms, high from the start of the period. */
#ifndef BSP_THROTTLE_H
#define BSP_THROTTLE_H

#include <stdint.h>

#define BSP_THROTTLE_PERIOD_COUNTS 28332U /* TBPRD, seed eq. 14: (28332 + 1) * 0.48 us = 13.60 ms */
#define BSP_THROTTLE_IDLE_COUNTS 4166U    /* compare for no thrust, "2 ms", eq. 15 */
#define BSP_THROTTLE_FULL_COUNTS 2082U    /* compare for full thrust, "1 ms", eq. 16 */

/* Sets time base, shadow loads at zero and action qualifiers; the pulse is idle. bsp_board_init() only. */
void bsp_throttle_init(void);

/* Sets the high time in microseconds, from the next period on. It is rounded to the nearest count of 0.48 us
 * and limited to full .. idle; NaN gives idle. Any context. */
void bsp_throttle_set_pulse_us(float pulse_us);

/* Sets the idle pulse (no thrust) from the next period on. Any context, interrupts on or off. */
void bsp_throttle_idle(void);

#endif
