/* Tasks: preemptive, priorities 1..15 (0 is idle), FIFO among equals. */
#ifndef ti_sysbios_knl_Task__include
#define ti_sysbios_knl_Task__include

#include <xdc/std.h>
#include <xdc/runtime/Error.h>

typedef struct Task_Object *Task_Handle;
typedef Void (*Task_FuncPtr)(UArg arg0, UArg arg1);

typedef struct {
    xdc_runtime_IInstance_Params *instance;
    UArg arg0, arg1;
    Int priority;    /* 1..15 */
    Ptr stack;       /* NULL: from the heap. On the PC every task has a host stack instead */
    SizeT stackSize; /* words; 0 = default */
    xdc_runtime_IInstance_Params __iprms;
} Task_Params;

static inline Void Task_Params_init(Task_Params *params)
{
    *params = (Task_Params){.priority = 1};
    params->instance = &params->__iprms;
}

/* main() or Task. A function that returns ends its task. */
Task_Handle Task_create(Task_FuncPtr fxn, const Task_Params *params, Error_Block *eb);

/* Task only, scheduler enabled. Returns at the nticks-th tick from now, nticks < 65535; 0 returns at once. */
Void Task_sleep(UInt32 nticks);

/* The running task goes behind the others of its priority. Any context. */
Void Task_yield(Void);

/* No task switch until Task_restore() with what Task_disable() returned; Swis and Hwis go on. */
UInt Task_disable(Void);
Void Task_restore(UInt key);

/* Of a task's stack: its size, and the most that was ever used. On the PC octets of its host stack. */
typedef struct {
    Int priority;
    SizeT stackSize;
    SizeT used;
} Task_Stat;

/* Any context. */
Void Task_stat(Task_Handle handle, Task_Stat *statbuf);

/* Any context. BLOCKED: in a wait. INACTIVE is of TI's kernel alone: a priority of -1. */
typedef enum {
    Task_Mode_RUNNING,
    Task_Mode_READY,
    Task_Mode_BLOCKED,
    Task_Mode_TERMINATED,
    Task_Mode_INACTIVE
} Task_Mode;
Task_Mode Task_getMode(Task_Handle handle);

/* Returns the previous priority. newpri 1..15; what is inherited through a gate stays on top of it. */
Int Task_setPri(Task_Handle handle, Int newpri);

#endif
