/* Who has the throttle, as the RC multiplexer's SEL says: a level on GPIO3 (J8.79), high = this firmware, low
 * = the pilot. An open pin is high (the chip's pull-up; it has no pull-down): a wire that breaks in the air
 * does not end the control of the height. docs/hardware.md says what drives the pin. */
#ifndef BSP_SELECTOR_H
#define BSP_SELECTOR_H

#include <stdbool.h>

/* Input, with pull-up; a level counts after six samples that agree, 13 us at 200 MHz. Called by
 * bsp_board_init(). */
void bsp_selector_init(void);

/* The firmware's pulse is the one that the autopilot gets. Any context. */
bool bsp_selector_ours(void);

#endif
