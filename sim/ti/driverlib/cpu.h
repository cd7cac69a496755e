/* Processor intrinsics, as in TI's header of this name. */
#ifndef CPU_H
#define CPU_H

#include <stdlib.h>

/* Emulation stop: halts under a debugger on the chip, ends the program here. */
#define ESTOP0 abort()

/* Access to protected registers on and off. One bit, it does not nest: many functions of driverlib end with
 * it off. */
void driverlib_eallow(void);
void driverlib_edis(void);
#define EALLOW driverlib_eallow()
#define EDIS driverlib_edis()

#endif
