/* Processor intrinsics, as in TI's header of this name. */
#ifndef CPU_H
#define CPU_H

#include <stdlib.h>

/* Emulation stop: halts under a debugger on the chip, ends the program here. */
#define ESTOP0 abort()

/* Access to protected registers on and off: open to all here. */
#define EALLOW
#define EDIS

#endif
