/* Reads the throttle channel of the pilot's receiver: pulses on GPIO10 (J8.78), timed by eCAP1. An open pin
 * is high (pull-up), so a wire that is missing or broken gives no pulses. docs/hardware.md has the circuit.
 */
#ifndef BSP_RECEIVER_H
#define BSP_RECEIVER_H

#include <stdbool.h>

/* Sets the pin as an input with pull-up, and starts eCAP1. A level counts after six equal samples, 13 us at
 * 200 MHz. bsp_board_init() only. */
void bsp_receiver_init(void);

/* Takes the first whole pulse since the previous call: *pulse_us is its length, 0 to 21 s. False: there was
 * none, *pulse_us does not change. Any context, but one caller. */
bool bsp_receiver_take(float *pulse_us);

#endif
