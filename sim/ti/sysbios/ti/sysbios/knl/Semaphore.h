/* Semaphores. Counting ones refuse to pass 65535, binary ones stay at 1; in the _PRIORITY modes the waiting
 * task of highest priority is served first, otherwise the one that waited longest. */
#ifndef ti_sysbios_knl_Semaphore__include
#define ti_sysbios_knl_Semaphore__include

#include <xdc/std.h>
#include <xdc/runtime/Error.h>

typedef struct Semaphore_Object *Semaphore_Handle;

typedef enum {
    Semaphore_Mode_COUNTING,
    Semaphore_Mode_BINARY,
    Semaphore_Mode_COUNTING_PRIORITY,
    Semaphore_Mode_BINARY_PRIORITY
} Semaphore_Mode;

typedef struct {
    xdc_runtime_IInstance_Params *instance;
    Semaphore_Mode mode;
    xdc_runtime_IInstance_Params __iprms;
} Semaphore_Params;

static inline Void Semaphore_Params_init(Semaphore_Params *params)
{
    *params = (Semaphore_Params){.mode = Semaphore_Mode_COUNTING};
    params->instance = &params->__iprms;
}

/* main() or Task; count 0..32767. */
Semaphore_Handle Semaphore_create(Int count, const Semaphore_Params *params, Error_Block *eb);

/* FALSE when `timeout` ticks passed first. Waits in a Task only and with the scheduler enabled; with
 * BIOS_NO_WAIT any context. Finite timeout < 65535. */
Bool Semaphore_pend(Semaphore_Handle handle, UInt32 timeout);
Void Semaphore_post(Semaphore_Handle handle); /* any context */
Int Semaphore_getCount(Semaphore_Handle handle);
Void Semaphore_reset(Semaphore_Handle handle, Int count); /* no task may wait; count 0..32767 */

#endif
