#include <ti/sysbios/utils/Load.h>

#include "sim/ti/sysbios/core.h"

#define WINDOW (500 * SIM_MS)

static sim_time_t window_start;
static sim_time_t idle; /* in this window */
static UInt32 latest;

void load_module_reset(void)
{
    window_start = timeline_now();
    idle = 0;
    latest = 0;
}

static void close_windows(sim_time_t now)
{
    for (; now - window_start >= WINDOW; window_start += WINDOW) {
        latest = (UInt32)((100 * (WINDOW - idle) + WINDOW / 2) / WINDOW);
        idle = 0;
    }
}

void load_idle(sim_time_t from, sim_time_t to)
{
    close_windows(from);
    while (to - window_start >= WINDOW) {
        const sim_time_t end = window_start + WINDOW;

        idle += end - from;
        close_windows(end);
        from = end;
    }
    idle += to - from;
}

UInt32 Load_getCPULoad(Void)
{
    close_windows(timeline_now());
    return latest;
}
