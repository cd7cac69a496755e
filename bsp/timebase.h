/* Time sources: CPU timer 1 counts microseconds, for all times of the firmware. CPU timer 2 counts cycles of
 * SYSCLK, for short times. */
#ifndef BSP_TIME_H
#define BSP_TIME_H

#include <stdint.h>

#define BSP_CYCLE_NS 5U

/* bsp_board_init() only, after the clocks are set, because SysCtl_setClock() uses both timers. */
void bsp_time_init(void);

/* Microseconds since bsp_time_init(). Wraps after 71.6 min, so compare by subtraction. Any context. */
uint32_t bsp_time_us(void);

/* Cycles of BSP_CYCLE_NS. Wraps after 21.5 s: use differences only. Any context. */
uint32_t bsp_time_cycles(void);

#endif
