/* Stand-in for TI's C2000Ware driverlib (f2837xs): the subset that this firmware uses, same names, types and
 * values, on models of the peripherals in virtual time (chip.h). No call takes virtual time. */
#ifndef DRIVERLIB_H
#define DRIVERLIB_H

#include "inc/hw_ints.h"
#include "inc/hw_memmap.h"
#include "adc.h"
#include "cpu.h"
#include "cputimer.h"
#include "ecap.h"
#include "epwm.h"
#include "gpio.h"
#include "pin_map.h"
#include "sci.h"
#include "sysctl.h"
#include "xbar.h"

#endif
