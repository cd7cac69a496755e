/* Software interrupts: priorities 0..15, above every Task, below every Hwi. */
#ifndef ti_sysbios_knl_Swi__include
#define ti_sysbios_knl_Swi__include

#include <xdc/std.h>
#include <xdc/runtime/Error.h>

typedef struct Swi_Object *Swi_Handle;
typedef Void (*Swi_FuncPtr)(UArg arg0, UArg arg1);

typedef struct {
    xdc_runtime_IInstance_Params *instance;
    UArg arg0, arg1;
    UInt priority; /* 0..15, default ~0 = the highest */
    xdc_runtime_IInstance_Params __iprms;
} Swi_Params;

static inline Void Swi_Params_init(Swi_Params *params)
{
    *params = (Swi_Params){.priority = ~(0U)};
    params->instance = &params->__iprms;
}

/* main() or Task. */
Swi_Handle Swi_create(Swi_FuncPtr swiFxn, const Swi_Params *params, Error_Block *eb);

/* Any context. Posting a Swi that is posted and has not begun has no effect. */
Void Swi_post(Swi_Handle handle);

/* No Swi and no task switch until Swi_restore() with what Swi_disable() returned; Hwis go on. */
UInt Swi_disable(Void);
Void Swi_restore(UInt key);

#endif
