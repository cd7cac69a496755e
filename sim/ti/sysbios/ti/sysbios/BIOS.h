#ifndef ti_sysbios_BIOS__include
#define ti_sysbios_BIOS__include

#include <xdc/std.h>

#define BIOS_WAIT_FOREVER (~(0U)) /* 0xFFFF on a C28x: real time-outs stay below 65535 ticks */
#define BIOS_NO_WAIT (0U)

/* From main() only; never returns. Interrupts, the tick and the tasks start here. */
Void BIOS_start(Void);

#endif
