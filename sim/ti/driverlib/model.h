/* Between the parts of the chip model: clocks, pins, UARTs, throttle PWM, timers. One chip per process. */
#ifndef SIM_TI_DRIVERLIB_MODEL_H
#define SIM_TI_DRIVERLIB_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "sim/timeline.h"

/* Says what the model does not know, then aborts. */
_Noreturn void chip_unmodelled(const char *what);

/* Clocks. A failed crystal makes SysCtl_setClock() return false and SYSCLK the 10 MHz of the internal
 * oscillator. Lasts until chip_reset(). */
void sysctl_reset(void);
void sysctl_fail_crystal(void);
uint32_t sysctl_sysclk_hz(void);
uint32_t sysctl_lspclk_hz(void);
uint32_t sysctl_epwmclk_hz(void);
/* peripheral: a SysCtl_PeripheralPCLOCKCR. */
bool sysctl_clocked(uint32_t peripheral);
bool sysctl_register(const char *name, uint32_t *value);

/* Pins. */
void gpio_reset(void);
uint32_t gpio_pin(uint32_t pin_config);
/* True when the pin of this pin_map.h word has this function now. */
bool gpio_routed(uint32_t pin_config);
/* Level from outside on the pin of this pin_map.h word. */
bool gpio_input(uint32_t pin_config);
/* Throttle pin: what drives it may have changed at `when` (<= now). Reports the pulse that ends so. */
void gpio_throttle_changed(sim_time_t when);
bool gpio_register(const char *name, uint32_t *value);

/* UARTs. */
void sci_reset(void (*raise)(int interrupt));
/* A pin level or a pin function may have changed. */
void sci_lines_changed(void);
/* Level on a transmit pin, true = mark; false from `sci_drives` when the pin is no transmit pin now. */
bool sci_drives(uint32_t pin, bool *level);
bool sci_register(const char *name, uint32_t *value);

/* Throttle PWM. */
void epwm_reset(void);
/* Around any change of clocks or gates. */
void epwm_clocks_change(void);
void epwm_clocks_changed(void);
/* Works off what the counter has passed up to now. */
void epwm_catch_up(void);
bool epwm_level(void);
bool epwm_register(const char *name, uint32_t *value);

/* Time stamps of edges. */
void ecap_reset(void);
/* The outside world has changed the level on a pin. */
void ecap_pin_changed(uint32_t pin, bool level);

/* Analog-to-digital converter. */
void adc_reset(void);

/* Watchdog and causes of reset. */
void watchdog_power_on(void);
/* All but the causes. */
void watchdog_reset(void);
bool watchdog_register(const char *name, uint32_t *value);

/* CPU timers. */
void cputimer_reset(void);
/* Before any change of clocks or gates. */
void cputimer_clocks_change(void);
/* What SysCtl_setClock() leaves in a timer that it borrowed. */
void cputimer_disturb(unsigned timer, uint32_t count);

#endif
