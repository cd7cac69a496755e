/* Input X-BAR: the used subset of TI's driverlib header of this name, plain functions. It leads a GPIO pin to
 * an eCAP module. */
#ifndef XBAR_H
#define XBAR_H

#include <stdint.h>

typedef enum { XBAR_INPUT7 = 6 /* eCAP1 */ } XBAR_InputNum;

/* Needs no EALLOW of its own. */
void XBAR_setInputPin(XBAR_InputNum input, uint16_t pin);

#endif
