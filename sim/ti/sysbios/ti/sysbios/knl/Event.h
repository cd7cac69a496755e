/* Events: a set of up to 16 flags that one task waits for. */
#ifndef ti_sysbios_knl_Event__include
#define ti_sysbios_knl_Event__include

#include <xdc/std.h>
#include <xdc/runtime/Error.h>

typedef struct Event_Object *Event_Handle;

#define Event_Id_NONE (0U)
#define Event_Id_00 (0x1U)
#define Event_Id_01 (0x2U)
#define Event_Id_02 (0x4U)
#define Event_Id_03 (0x8U)
#define Event_Id_04 (0x10U)
#define Event_Id_05 (0x20U)
#define Event_Id_06 (0x40U)
#define Event_Id_07 (0x80U)
#define Event_Id_08 (0x100U)
#define Event_Id_09 (0x200U)
#define Event_Id_10 (0x400U)
#define Event_Id_11 (0x800U)
#define Event_Id_12 (0x1000U)
#define Event_Id_13 (0x2000U)
#define Event_Id_14 (0x4000U)
#define Event_Id_15 (0x8000U)

typedef struct {
    xdc_runtime_IInstance_Params *instance;
    xdc_runtime_IInstance_Params __iprms;
} Event_Params;

static inline Void Event_Params_init(Event_Params *params)
{
    *params = (Event_Params){.instance = NULL};
    params->instance = &params->__iprms;
}

/* main() or Task. */
Event_Handle Event_create(const Event_Params *params, Error_Block *eb);

/* Returns and consumes what matched: all of andMask once all of it is posted, and whatever is posted of
 * orMask; 0 when `timeout` ticks passed first. Waits in a Task only, one task at a time, with the scheduler
 * enabled; with BIOS_NO_WAIT any context. Finite timeout < 65535; one mask at least is not 0. */
UInt Event_pend(Event_Handle handle, UInt andMask, UInt orMask, UInt32 timeout);
Void Event_post(Event_Handle handle, UInt eventMask); /* any context; eventMask is not 0 */
UInt Event_getPostedEvents(Event_Handle handle);

#endif
