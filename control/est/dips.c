/* What breaks: a gap between two tables looks like a dip. Then the vehicle stays high over the next gap, and
 * behind the last table for as long as that gap took. */
#include "control/est/dips.h"

#include <math.h>
#include <stdbool.h>

#include "control/est/roughness.h"

#define DIP_SCANS 6U        /* chosen: 0.6 s; a pit of 0.24 m at 0.4 m/s, the speed of the seed's course */
#define RECALLED_SCANS 100U /* chosen: 10 s */

static void remember(dips_t *dips, uint16_t scans)
{
    dips->lasted = (scans < DIP_SCANS) ? scans : DIP_SCANS; /* else it could wait longer after each dip */
    dips->recalled = RECALLED_SCANS;
}

void dips_scan(dips_t *dips)
{
    dips->since = (uint16_t)(dips->since + (dips->since <= DIP_SCANS));
    dips->recalled = (uint16_t)(dips->recalled - (dips->recalled > 0U));
}

uint16_t dips_wait(const dips_t *dips, float innovation_m)
{
    return (dips->recalled > 0U && innovation_m > 0.0F) ? dips->lasted : 0U;
}

void dips_over(dips_t *dips, uint16_t rejected, float innovation_m)
{
    if (rejected > 1U && innovation_m > 0.0F) {
        remember(dips, rejected);
    }
}

void dips_step(dips_t *dips, float innovation_m)
{
    const bool back = dips->fall_m > 0.0F && fabsf(innovation_m + dips->fall_m) < INNOVATION_LIMIT_MAX_M;

    if (back && dips->since <= DIP_SCANS) {
        remember(dips, dips->since);
    }
    dips->fall_m = fmaxf(innovation_m, 0.0F);
    dips->since = 0U;
}
