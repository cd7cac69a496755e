/* Reads who has the throttle, from SEL of the RC multiplexer.
 * GPIO3 (J8.79), high = this firmware, low = the pilot. An open pin is high (the chip has a pull-up, but no
 * pull-down). So a wire that breaks in the air does not end the height control. docs/hardware.md has the
 * circuit. */
#ifndef BSP_SELECTOR_H
#define BSP_SELECTOR_H

#include <stdbool.h>

/* Sets the pin as an input with pull-up. A level counts after six equal samples, 13 us at 200 MHz.
 * bsp_board_init() only. */
void bsp_selector_init(void);

/* True when the autopilot receives the pulse of this firmware. Any context. */
bool bsp_selector_ours(void);

#endif
