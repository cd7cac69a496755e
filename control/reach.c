#include "control/reach.h"

#include <math.h>

#include "control/credible.h"

#define REACHED_MM (1000.0F * CONTENT_M)
#define NEARER_MM (0.5F * REACHED_MM)

#define STUCK_MAX_US UINT32_C(60000000) /* the counter stops, it need not wrap */

void reach_reset(reach_t *reach)
{
    *reach = (reach_t){.on = false};
}

static void begin(reach_t *reach, float off_mm)
{
    reach->on = true;
    reach->above = off_mm > 0.0F;
    reach->nearest_mm = fabsf(off_mm);
    reach->stuck_us = 0U;
}

bool reach_step(reach_t *reach, float off_mm, uint32_t step_us)
{
    const float distance_mm = fabsf(off_mm);
    const bool nearer = distance_mm < reach->nearest_mm - NEARER_MM;

    if (!reach->on || nearer || reach->above != (off_mm > 0.0F) || distance_mm <= REACHED_MM) {
        begin(reach, off_mm);
    } else if (reach->stuck_us < STUCK_MAX_US) {
        reach->stuck_us += (step_us < REACH_RISES_US) ? step_us : REACH_RISES_US;
    }
    return reach->stuck_us >= REACH_RISES_US;
}
