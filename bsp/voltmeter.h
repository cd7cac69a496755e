/* Reads the voltage of the power module's divider: ADCINA0 (J3.27), ADC A. In the chip 50 kOhm pull this pin
 * to ground, so a wire that is missing or broken reads as 0 V. docs/hardware.md has the circuit. */
#ifndef BSP_VOLTMETER_H
#define BSP_VOLTMETER_H

#include <stdbool.h>

/* What the converter's full scale stands for, VREFHI. TI's data sheet allows 2.4 V .. VDDA, 3.3 V; which of
 * these this LaunchPad has was not at hand. What is told is too high then, never too low, and VDIV takes it
 * in. */
#define BSP_VOLTMETER_FULL_SCALE_V 3.3F
#define BSP_VOLTMETER_STEP_V (BSP_VOLTMETER_FULL_SCALE_V / 4096.0F)

/* Powers up ADC A. bsp_board_init() only, after bsp_time_init(). */
void bsp_voltmeter_init(void);

/* Takes the conversion that the previous call started, and starts the next: *pin_v is the voltage at the pin.
 * False: there is none yet, *pin_v does not change; so it is in the first millisecond. Any context, but one
 * caller. */
bool bsp_voltmeter_take(float *pin_v);

#endif
