/* Functions called after a number of 1 ms ticks, once or periodically, from a Swi of the highest priority. */
#ifndef ti_sysbios_knl_Clock__include
#define ti_sysbios_knl_Clock__include

#include <xdc/std.h>
#include <xdc/runtime/Error.h>

typedef struct Clock_Object *Clock_Handle;
typedef Void (*Clock_FuncPtr)(UArg arg);

typedef struct {
    xdc_runtime_IInstance_Params *instance;
    Bool startFlag; /* started by create; then timeout must not be 0 */
    UInt32 period;  /* ticks; 0 = once */
    UArg arg;
    xdc_runtime_IInstance_Params __iprms;
} Clock_Params;

static inline Void Clock_Params_init(Clock_Params *params)
{
    *params = (Clock_Params){.startFlag = FALSE};
    params->instance = &params->__iprms;
}

/* main() or Task. timeout: ticks from a start to the first call, 0..65535 (UInt has 16 bits on a C28x). */
Clock_Handle Clock_create(Clock_FuncPtr clockFxn, UInt timeout, const Clock_Params *params, Error_Block *eb);

/* Any context. The timeout must not be 0. Starting a running one starts it anew. */
Void Clock_start(Clock_Handle handle);
Void Clock_stop(Clock_Handle handle);

/* Take effect at the next start, or at the next expiry for the period. */
Void Clock_setPeriod(Clock_Handle handle, UInt32 period);
Void Clock_setTimeout(Clock_Handle handle, UInt32 timeout);

UInt32 Clock_getTicks(Void); /* since BIOS_start() */

#endif
