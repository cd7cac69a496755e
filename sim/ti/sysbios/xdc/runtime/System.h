#ifndef xdc_runtime_System__include
#define xdc_runtime_System__include

#include <xdc/std.h>

/* Both stop the whole system and never return. Any context. */
Void System_abort(CString str);
Void System_exit(Int stat);

Int System_printf(CString fmt, ...);
Void System_flush(Void);

#endif
