/* What the PC board asks of the chip model behind the driverlib stand-in: wires on the UARTs, the throttle
 * pin, LEDs and interrupt lines. The firmware never includes this. */
#ifndef SIM_TI_DRIVERLIB_CHIP_H
#define SIM_TI_DRIVERLIB_CHIP_H

#include <stdbool.h>
#include <stdint.h>

#include "sim/timeline.h"

/* Power-on state of every register. raise(interrupt) is called when an enabled interrupt condition rises,
 * with the SYS/BIOS number (INT_xxx >> 16). */
void chip_reset(void (*raise)(int interrupt));

/* Any other reset: every register as after power-on, but the causes of reset. Wires stay connected. */
void chip_restart(void);

/* Called when the watchdog overflows, from an event of the timeline, with the cause set. It is the board that
 * then restarts chip and firmware. NULL: nobody, and the watchdog rests. */
void chip_watchdog_connect(void (*reset)(void *context), void *context);

/* An NMI, as of the flash's error correction: the vector is taken at once, nobody services the NMI, and 65536
 * periods of SYSCLK later the NMI watchdog resets the chip as above. What the processor was at ends there:
 * the caller lets nothing take effect any more. */
void chip_nmi(void);
/* NMIs since power-on. */
unsigned chip_nmis(void);

/* A transmitted octet, delivered at the end of its stop bit; bit_ns is the length of one bit as sent. */
typedef void (*chip_octet_t)(void *context, unsigned octet, double bit_ns);
void chip_sci_connect(uint32_t base, chip_octet_t transmitted, void *context);
/* The same for GPIO84, the LaunchPad's USB serial port: what SCIA transmits while that pin is its own. It
 * does not reach the pin that chip_sci_connect() is about. */
void chip_usb_connect(chip_octet_t transmitted, void *context);

/* An octet arrives on the receive pin, at the end of its stop bit. When bit_ns is off by more than 4.5 % from
 * the receiver's own rate, or the pin is not muxed to this SCI, it is a framing error or nothing, as on the
 * chip. */
void chip_sci_receive(uint32_t base, unsigned octet, double bit_ns);

/* The rate that is set now, bits per second (0 while the SCI is in reset). */
double chip_sci_rate(uint32_t base);

/* The throttle pin: called at each falling edge with the high time; the pin is only driven when GPIO2 is
 * muxed to EPWM2A and the time base runs. */
typedef void (*chip_pulse_t)(void *context, sim_time_t high_ns);
void chip_pwm_connect(chip_pulse_t pulse, void *context);

/* Level on an output pin. */
bool chip_pin(uint32_t pin);
/* How often a pin has gone from high to low by a GPIO function since the latest reset, for however short a
 * time. */
unsigned chip_pin_falls(uint32_t pin);
/* Level that the outside world puts on an input pin. */
void chip_drive_pin(uint32_t pin, bool level);

/* Voltage that the outside world puts on analog input ADCINA<channel>, and the resistance behind it. Stays
 * through every reset. */
void chip_drive_analog(uint32_t channel, double volts, double ohms);

/* Whether a store to a protected register takes effect now: between EALLOW and EDIS. Without it the chip
 * ignores the store, and says nothing. */
bool chip_protected_writable(void);

/* Raw register values for tests: "SCIA.BRR", "LOSPCP", "PERCLKDIVSEL", "EPWM2.TBPRD", "EPWM2.TBCTL",
 * "EPWM2.CMPA", "EPWM2.AQCTLA", "GPIO64.MUX", ... Aborts on an unknown name. */
uint32_t chip_register(const char *name);

#endif
