/* The two LEDs of the LaunchPad (active low): red LD9 = GPIO12, blue LD10 = GPIO13. Any context. */
#ifndef BSP_LED_H
#define BSP_LED_H

#include <stdbool.h>

void bsp_led_init(void);
void bsp_led_red(bool on);
void bsp_led_blue(bool on);

#endif
