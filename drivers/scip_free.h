/* The rays of a scan that no mirror bends: they go straight on, and tell what stands around. Pure; any
 * context. */
#ifndef DRIVERS_SCIP_FREE_H
#define DRIVERS_SCIP_FREE_H

#include <stdint.h>

#include "drivers/scip_layout.h"
#include "drivers/scip_parser.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCIP_FREE_NOTHING \
    0U /* nothing in reach, or the ray was lost: the sensor does not tell these apart \
        */
#define SCIP_FREE_UNSEEN 0xFFFFU /* the ray looks at a mirror, or at its edge */

/* Writes one value for each point of the scan, as many as it has: millimetres, or one of the two above. A
 * mirror is as wide as its group, and SCIP_FREE_EDGE steps more to either side. */
#define SCIP_FREE_EDGE 10U
void scip_free_ranges(uint16_t *ranges, const scip_scan_t *scan, const scip_layout_t *layout);

/* Middle of point `index` in steps; the points follow each other by the scan's cluster. */
float scip_free_step(const scip_scan_t *scan, uint16_t index);
/* Steps from one point to the next. */
uint16_t scip_free_every(const scip_scan_t *scan);

#ifdef __cplusplus
}
#endif

#endif
