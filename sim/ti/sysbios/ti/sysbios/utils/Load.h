/* Processor load: everything but the idle task. */
#ifndef ti_sysbios_utils_Load__include
#define ti_sysbios_utils_Load__include

#include <xdc/std.h>

/* Percent, 0..100, of the latest whole window of 500 ms; 0 before the first has ended. */
UInt32 Load_getCPULoad(Void);

#endif
