/* Direct register access, as in TI's header of this name, for reading only: a write does not compile here. */
#ifndef HW_TYPES_H
#define HW_TYPES_H

#include <stdint.h>

/* The value of the 16-bit register at a word address, read afresh by each call. SCI registers only, others
 * abort. */
const volatile uint16_t *driverlib_halfword(uint32_t address);

#define HWREGH(x) (*driverlib_halfword(x))

#endif
