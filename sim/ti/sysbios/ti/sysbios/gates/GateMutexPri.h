/* Mutual exclusion between tasks with priority inheritance. The gate goes to the waiting task of highest
 * priority. TI's gate passes a raised priority on to the owner only: a task that waits for one gate while it
 * holds another does not hand down what it inherits. This one does, so firmware must not rely on it: hold one
 * gate at a time. */
#ifndef ti_sysbios_gates_GateMutexPri__include
#define ti_sysbios_gates_GateMutexPri__include

#include <xdc/std.h>
#include <xdc/runtime/Error.h>

typedef struct GateMutexPri_Object *GateMutexPri_Handle;

typedef struct {
    xdc_runtime_IInstance_Params *instance;
    xdc_runtime_IInstance_Params __iprms;
} GateMutexPri_Params;

static inline Void GateMutexPri_Params_init(GateMutexPri_Params *params)
{
    *params = (GateMutexPri_Params){.instance = NULL};
    params->instance = &params->__iprms;
}

/* main() or Task. */
GateMutexPri_Handle GateMutexPri_create(const GateMutexPri_Params *params, Error_Block *eb);

/* Task or main(), in pairs, innermost first; the owner may enter again. leave takes what its enter returned.
 */
IArg GateMutexPri_enter(GateMutexPri_Handle handle);
Void GateMutexPri_leave(GateMutexPri_Handle handle, IArg key);

#endif
