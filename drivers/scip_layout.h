/* Ray layouts: which steps of the scan belong to which group (mirror), the mean distance of a group, and the
 * times of the rays. One table holds the layouts.
 *
 * Steps are counted counter-clockwise, seen from above: 1024 per revolution, 360/1024 = 0.3515625 degrees
 * each. Step 0 is sampled first; step 384 looks to the front. Pure; any context. Pointers are borrowed for
 * the call. */
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
#define SCIP_CODE_LIMIT_MM 20U /* smaller values are error codes, not distances */
#define SCIP_FAR_2_MM 4095U    /* largest value of two characters: far or unknown */
#define SCIP_DMAX_MM 5600U     /* data sheet, DMAX: larger values of three characters are no distances */

#define SCIP_STEP_FRONT 384U
#define SCIP_STEP_FIRST 44U /* data sheet, AMIN and AMAX: only these steps are measured */
#define SCIP_STEP_LAST 725U

typedef struct {
    uint16_t first_step;
    uint16_t last_step;
} scip_group_t;

typedef struct {
    const char *name;
    uint16_t first_step; /* first and last step requested from the sensor */
    uint16_t last_step;
    uint16_t group_count;
    scip_group_t groups[SCIP_GROUPS_MAX]; /* measured on the vehicle, 5 steps inside each mirror's edges */
} scip_layout_t;

typedef enum {
    SCIP_LAYOUT_FRONT,
    SCIP_LAYOUT_TWO_BEAMS,
    SCIP_LAYOUT_THREE_MIRRORS,
    SCIP_LAYOUT_COUNT
} scip_layout_id_t;
extern const scip_layout_t scip_layouts[]; /* SCIP_LAYOUT_COUNT */

/* Largest number of points in a scan of any layout: several groups in steps 44..725, with a cluster of 4. */
#define SCIP_LAYOUT_POINTS_MAX 171U

/* Layout of groups around these middle steps, which ascend, each `reach` steps to either side. count:
 * 1..SCIP_GROUPS_MAX. */
scip_layout_t scip_layout_around(const uint16_t middles[], uint16_t count, uint16_t reach);

typedef struct {
    bool valid;         /* at least half of the group's rays were good */
    float mean_mm;      /* mean of the good rays near their median; 0 when there is none */
    uint16_t spread_mm; /* largest minus smallest good ray */
    uint16_t good_rays;
    uint16_t nearest_mm, furthest_mm; /* of the rays in mean_mm; 0 when there is none */
} scip_group_mean_t;

/* Robust mean distance of one group: the mean of the good rays within 25 mm of their median. So a leg or a
 * rope in front of some rays does not change the mean much. A good ray has at least 20 mm, and less than 4095
 * mm (two characters) or at most 5600 mm (three characters). Rays that are not in the scan count as bad. With
 * a cluster, a ray is a point whose steps are all in the group; it tells the nearest of them, so the mean is
 * raised by what that takes away from rays with such a white noise. What is no noise is the plane that the
 * group looks at: its slope, and that a ray aside of the group's middle is longer. */
scip_group_mean_t scip_group_mean(const scip_scan_t *scan, const scip_group_t *group);

/* The same, with dmin_mm and dmax_mm of *limits (scip_info_limits()) as limits of a good ray. */
scip_group_mean_t scip_group_mean_within(const scip_scan_t *scan, const scip_group_t *group,
                                         const scip_limits_t *limits);

/* Where the rays in a group's mean are: their steps. With a cluster, a point is a ray in each of its steps. A
 * group of no rays is one ray at its first step. mean: of the same scan and group. */
typedef struct {
    float mean;
    float variance;
} scip_group_steps_t;
scip_group_steps_t scip_group_steps(const scip_scan_t *scan, const scip_group_t *group,
                                    const scip_group_mean_t *mean);

/* Largest difference between two neighbouring good rays of the group, mm; 0 when no two good rays are
 * neighbours. Good rays as in scip_group_mean(). Over any slope of the ground the difference is small. It is
 * usually large in a damaged scan whose sums are right by chance. */
uint16_t scip_group_step_mm(const scip_scan_t *scan, const scip_group_t *group);

/* Direction of a step in degrees; > 0 is left of the front. The result is exact. */
float scip_step_degrees(uint16_t step);

/* Step nearest to a direction in degrees, limited to 44..725. NaN gives 44. */
uint16_t scip_step_at_degrees(float degrees);

/* Age of a stream's scan when its last octet arrives without delay: time since the middle one of its rays, in
 * microseconds. It is the sum of the rest of the revolution, the transmission of the scan at this bit rate,
 * and the handling in sensor and receiver. Two assumptions: the sensor sends at the end of the revolution,
 * and step 389 is sampled 34 ms after the time stamp. bit_rate: one of SCIP's. */
uint32_t scip_rays_age_us(const scip_scan_t *scan, uint32_t bit_rate);

/* Time from the scan's middle step to that of the group, which may have been sampled before: then it is below
 * 0. */
int32_t scip_group_later_us(const scip_scan_t *scan, const scip_group_t *group);

/* Cluster of a layout: 1 for one group and 4 for several, so that the scan is short on the line; more where
 * its stream would not leave a tenth of each revolution free, as that of THREE_MIRRORS at 19200 bit/s.
 * bit_rate: in bits per second. */
uint16_t scip_layout_cluster(const scip_layout_t *layout, uint32_t bit_rate);

/* The range to request for a layout: its steps in whole clusters, without end. Steps that fill no cluster are
 * left out: some sensors make a point of them, others do not, and then no scan has the expected length. */
scip_range_t scip_layout_range(const scip_layout_t *layout, uint32_t bit_rate);

/* Time from the scan's time stamp (step 0) to the sampling of a step, in microseconds, at 600 rpm. step:
 * 0..1023. */
uint32_t scip_step_delay_us(uint16_t step);

#ifdef __cplusplus
}
#endif

#endif
