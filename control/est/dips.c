/* What breaks: a pit that is wider than a dip, and a table that is passed in less. The first is believed
 * after the wait; over the second the vehicle stays high a little longer. */
#include "control/est/dips.h"

#include <math.h>
#include <stdbool.h>

#include "control/est/roughness.h"

#define DIP_SCANS 6U /* 5.5: the bracket, 0.22 m long, at 0.4 m/s, the speed of the seed's course */
#define RECALLED_SCANS \
    100U /* 10 s: two runs of outliers, which come every 4 s at most in tools/campaign/musts.toml */

static void remember(dips_t *dips, uint16_t scans)
{
    dips->lasted = scans;
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
