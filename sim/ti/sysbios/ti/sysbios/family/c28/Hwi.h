/* Hardware interrupts of the C28x with its PIE: intNum = driverlib's INT_xxx >> 16. Number 38 (CPU timer 0)
 * is the kernel's tick. The kernel acknowledges the PIE itself. */
#ifndef ti_sysbios_family_c28_Hwi__include
#define ti_sysbios_family_c28_Hwi__include

#include <xdc/std.h>
#include <xdc/runtime/Error.h>

typedef struct Hwi_Object *Hwi_Handle;
typedef Void (*Hwi_FuncPtr)(UArg arg);
typedef Void (*Hwi_PlugFuncPtr)(Void);

typedef struct {
    xdc_runtime_IInstance_Params *instance;
    UArg arg;
    Bool enableInt; /* default TRUE */
    xdc_runtime_IInstance_Params __iprms;
} Hwi_Params;

static inline Void Hwi_Params_init(Hwi_Params *params)
{
    *params = (Hwi_Params){.enableInt = TRUE};
    params->instance = &params->__iprms;
}

/* main() or Task. intNum 1..15 or 32..223; fails when the number is taken. */
Hwi_Handle Hwi_create(Int intNum, Hwi_FuncPtr hwiFxn, const Hwi_Params *params, Error_Block *eb);

/* All interrupts off until Hwi_restore() with what Hwi_disable() returned. Any context. */
UInt Hwi_disable(Void);
Void Hwi_restore(UInt key);

/* One interrupt on; returns whether it was on. One that was raised before is taken now. */
UInt Hwi_enableInterrupt(UInt intNum);

/* Below the kernel's dispatcher: declared as TI does, halts the simulated system. */
Void Hwi_plug(UInt intNum, Hwi_PlugFuncPtr fxn);
Bits16 Hwi_enableIER(Bits16 mask);
Bits16 Hwi_enablePIEIER(UInt groupNum, Bits16 pieMask);

#endif
