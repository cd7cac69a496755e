/* SCIP_FREE_EDGE: the windows lie 5 steps inside the mirrors' edges, and as much is left for the edge itself:
 * half a cluster, and a window that was measured a few steps aside. */
#include "drivers/scip_free.h"

#include <stdbool.h>

uint16_t scip_free_every(const scip_scan_t *scan)
{
    return (scan->cluster > 1U) ? scan->cluster : 1U;
}

static bool meets(const scip_group_t *mirror, uint32_t first, uint32_t last)
{
    return last + SCIP_FREE_EDGE >= mirror->first_step &&
           first <= (uint32_t)mirror->last_step + SCIP_FREE_EDGE;
}

static bool meets_a_mirror(const scip_layout_t *layout, uint32_t first, uint32_t last)
{
    bool one = false;

    for (uint16_t i = 0U; i < layout->group_count; ++i) {
        one = one || meets(&layout->groups[i], first, last);
    }
    return one;
}

static bool is_told(const scip_scan_t *scan, uint16_t mm)
{
    return mm >= SCIP_CODE_LIMIT_MM && ((scan->characters == 3U) ? mm <= SCIP_DMAX_MM : mm < SCIP_FAR_2_MM);
}

void scip_free_ranges(uint16_t *ranges, const scip_scan_t *scan, const scip_layout_t *layout)
{
    const uint16_t cluster = scip_free_every(scan);
    uint32_t first = scan->first_step;

    for (uint16_t i = 0U; i < scan->points; ++i) {
        const uint16_t mm = scan->distance_mm[i];

        if (meets_a_mirror(layout, first, first + cluster - 1U)) {
            ranges[i] = SCIP_FREE_UNSEEN;
        } else {
            ranges[i] = is_told(scan, mm) ? mm : SCIP_FREE_NOTHING;
        }
        first += cluster;
    }
}

float scip_free_step(const scip_scan_t *scan, uint16_t index)
{
    const uint32_t cluster = scip_free_every(scan);

    return (float)(scan->first_step + cluster * index) + 0.5F * (float)(cluster - 1U);
}
