/* The one time source: CPU timer 1, free running, one count per microsecond. For what is too short for it,
 * CPU timer 2, one count per cycle of SYSCLK. */
#ifndef BSP_TIME_H
#define BSP_TIME_H

#include <stdint.h>

#define BSP_CYCLE_NS 5U

/* From bsp_board_init() only, after the clocks are set: SysCtl_setClock() borrows both timers. */
void bsp_time_init(void);

/* Microseconds since bsp_time_init(), wraps after 71.6 min: compare by subtraction. Any context. */
uint32_t bsp_time_us(void);

/* Cycles of BSP_CYCLE_NS, wraps after 21.5 s: for differences. Any context. */
uint32_t bsp_time_cycles(void);

#endif
