/* Lets the host's gcc read TI's headers for the C28x, syntax and types only. Sizes stay the host's: this is
 * no port. */
#ifndef TOOLS_TI_PRELUDE_H
#define TOOLS_TI_PRELUDE_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* driverlib defines both types 16 bits wide, which a C28x lacks and the host has. */
#define uint8_t ti_uint8_t
#define int8_t ti_int8_t

/* What cl2000 knows by itself. */
#define __TMS320C28XX__ 1
#define _TMS320C28X 1
#define __TI_COMPILER_VERSION__ 20002005
#define __cregister
#define __interrupt
#define interrupt
#define far
#define __byte(pointer, index) (*(volatile uint16_t *)(pointer))
#define __byte_peripheral_32(pointer) (*(pointer))
void __eallow(void);
void __edis(void);
unsigned int __disable_interrupts(void);
unsigned int __enable_interrupts(void);
void __restore_interrupts(unsigned int state);

#endif
