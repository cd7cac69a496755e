/* The one time source: CPU timer 1, free running, one count per microsecond. */
#ifndef BSP_TIME_H
#define BSP_TIME_H

#include <stdint.h>

/* From bsp_board_init() only, after the clocks are set: SysCtl_setClock() borrows this timer. */
void bsp_time_init(void);

/* Microseconds since bsp_time_init(), wraps after 71.6 min: compare by subtraction. Any context. */
uint32_t bsp_time_us(void);

#endif
