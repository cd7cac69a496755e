/* Which rays look at which mirror: ray-group layouts in one table, and the mean over a group's good rays.
 * Pure.
 *
 * Steps run counter-clockwise seen from above, 1024 to the turn (360/1024 = 0.3515625 degrees); step 384
 * looks to the front, step 0 is sampled first. */
#ifndef DRIVERS_SCIP_LAYOUT_H
#define DRIVERS_SCIP_LAYOUT_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/scip_info.h"
#include "drivers/scip_parser.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCIP_GROUPS_MAX 3U
#define SCIP_CODE_LIMIT_MM 20U /* smaller values are codes, not distances */
#define SCIP_FAR_2_MM 4095U    /* two characters end here: far or unknown */
#define SCIP_DMAX_MM 5600U     /* the sensor's own DMAX: larger values of three characters are no distances */

#define SCIP_STEP_FRONT 384U
#define SCIP_STEP_FIRST 44U /* AMIN and AMAX: outside them nothing is measured */
#define SCIP_STEP_LAST 725U

typedef struct {
    uint16_t first_step;
    uint16_t last_step;
} scip_group_t;

typedef struct {
    const char *name;
    uint16_t first_step; /* asked of the sensor */
    uint16_t last_step;
    uint16_t group_count;
    scip_group_t groups[SCIP_GROUPS_MAX]; /* 5 steps inside each mirror's edges, measured on the vehicle */
} scip_layout_t;

typedef enum {
    SCIP_LAYOUT_FRONT,
    SCIP_LAYOUT_TWO_BEAMS,
    SCIP_LAYOUT_THREE_MIRRORS,
    SCIP_LAYOUT_COUNT
} scip_layout_id_t;
extern const scip_layout_t scip_layouts[]; /* SCIP_LAYOUT_COUNT */

/* Largest number of points any layout asks for (three mirrors: 111..657), with a cluster of 1. */
#define SCIP_LAYOUT_POINTS_MAX 547U

typedef struct {
    bool valid;         /* at least half of the group's rays were good */
    float mean_mm;      /* of the good rays near their median; 0 when there is none */
    uint16_t spread_mm; /* largest minus smallest good ray */
    uint16_t good_rays;
} scip_group_mean_t;

/* Mean over those good rays of one group that lie within 25 mm of their median: a leg or a rope in front of
 * some rays does not pull it. Good means 20 mm or more, and below 4095 mm (two characters) or up to 5600 mm
 * (three). Rays that the scan does not hold count as bad. With a cluster a ray is a point whose steps all lie
 * in the group. */
scip_group_mean_t scip_group_mean(const scip_scan_t *scan, const scip_group_t *group);

/* The same with the limits that a sensor tells (dmin_mm and dmax_mm of scip_info_limits()). */
scip_group_mean_t scip_group_mean_within(const scip_scan_t *scan, const scip_group_t *group,
                                         const scip_limits_t *limits);

/* The largest difference between two neighbouring good rays of the group, mm; 0 when no two are neighbours.
 * Good means the limits of scip_group_mean(). On ground it stays small however the ground slopes; a scan with
 * two damages whose sums cancel out mostly shows a large one. */
uint16_t scip_group_step_mm(const scip_scan_t *scan, const scip_group_t *group);

/* Direction of a step, degrees, positive to the left of the front. Exact. */
float scip_step_degrees(uint16_t step);

/* The step nearest to a direction, kept within 44..725 (NaN: 44). */
uint16_t scip_step_at_degrees(float degrees);

/* How long after its rays' middle a stream's scan has arrived with its last octet, microseconds, when nothing
 * hinders it: the rest of the revolution, the scan's octets at this bit rate, and what sensor and receiver
 * add. The sensor sends at the end of the revolution; what it counts as step 0 is taken to be 34 ms before
 * step 389, as in the model of the plant. bit_rate: one of SCIP's. */
uint32_t scip_rays_age_us(const scip_scan_t *scan, uint32_t bit_rate);

/* The least cluster with which a layout's stream leaves a tenth of each revolution free. Three mirrors at
 * 115200 need 2: their 1157 octets of single steps take longer than the revolution, and the sensor falls
 * behind. bit_rate: one of SCIP's. */
uint16_t scip_layout_cluster(const scip_layout_t *layout, uint32_t bit_rate);

/* When a step is sampled, microseconds after the instant of the scan's time stamp (step 0), at 600
 * revolutions a minute. step: 0..1023. */
uint32_t scip_step_delay_us(uint16_t step);

#ifdef __cplusplus
}
#endif

#endif
