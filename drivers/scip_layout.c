#include "drivers/scip_layout.h"

#include <stddef.h>

#define DEGREES_PER_STEP 0.3515625F /* 360 / 1024 */
#define NEAR_MEDIAN_MM 25U          /* chosen: five times the noise of one ray over smooth ground, 5 mm */

const scip_layout_t scip_layouts[] = {
    [SCIP_LAYOUT_FRONT] = {"front", 372U, 406U, 1U, {{372U, 406U}}},
    [SCIP_LAYOUT_TWO_BEAMS] = {"two-beams", 249U, 519U, 2U, {{249U, 277U}, {491U, 519U}}},
    [SCIP_LAYOUT_THREE_MIRRORS] =
        {"three-mirrors", 111U, 657U, 3U, {{111U, 145U}, {372U, 406U}, {623U, 657U}}},
};
typedef char
    every_layout_has_its_row[(sizeof scip_layouts / sizeof scip_layouts[0] == SCIP_LAYOUT_COUNT) ? 1 : -1];

/* The rays of layout THREE_MIRRORS are then 79 ms old at 250000 bit/s, with 1 they are 113
 * (test_scip_layout). A larger one gains 3 ms at most. Eight points of a mirror are left, which tell its mean
 * within 2 mm. */
#define SEVERAL_GROUPS_CLUSTER 4U

/* By how much the mean of clusters is too near, in mean deviations of these clusters: for 1, 2, ... 8 steps.
 * A cluster tells the nearest of its rays. Order statistics of white normal noise (Harter, 1961): mean of the
 * least of n, over its standard deviation; over the sqrt(2 / pi) that a mean deviation is of that. */
static const float nearer_by[] = {0.0F, 0.86F, 1.42F, 1.84F, 2.18F, 2.46F, 2.71F, 2.92F};
#define NEARER_ROWS (sizeof nearer_by / sizeof nearer_by[0])

#define REVOLUTION_US 100000U  /* data sheet, 600 rpm */
#define STEP_FRONT_MIDDLE 389U /* middle of layout FRONT, 372..406 */
#define RAYS_FRONT_US 34000U   /* assumed: from the time stamp to that step, as the plant's model */
#define HANDLING_US 460U       /* assumed: sensor's start and receiver's interrupt; gives FRONT 70.5 ms */

#define TURN_RAD 6.2831853F

typedef struct {
    uint32_t sum, least, most;
    uint16_t bad;
} tally_t;

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* With two characters the largest value is a code, "far or unknown". */
static uint16_t largest_distance(const scip_scan_t *scan, const scip_limits_t *limits)
{
    return scan->characters == 3U ? limits->dmax_mm : (uint16_t)smaller(limits->dmax_mm, SCIP_FAR_2_MM - 1U);
}

/* A cluster of 0 is one of 1, by the protocol. */
static uint16_t steps_per_point(const scip_scan_t *scan)
{
    return scan->cluster > 1U ? scan->cluster : 1U;
}

/* Steps from the scan's first to this one; 0 when it lies before. */
static uint32_t steps_into(const scip_scan_t *scan, uint32_t step)
{
    return larger(step, scan->first_step) - scan->first_step;
}

/* Index of the first point that begins at the step or after it. */
static uint32_t point_from(const scip_scan_t *scan, uint32_t step, uint32_t cluster)
{
    const uint32_t into = steps_into(scan, step);
    return cluster == 1U ? into : (into + cluster - 1U) / cluster;
}

/* Number of points that end before the step. */
static uint32_t points_before(const scip_scan_t *scan, uint32_t step, uint32_t cluster)
{
    const uint32_t into = steps_into(scan, step);
    return smaller(cluster == 1U ? into : into / cluster, scan->points);
}

/* A ray that may be bad is noted too; tally() looks at the extremes afterwards. */
static void note_ray(tally_t *t, uint32_t ray)
{
    t->sum += ray;
    t->least = smaller(ray, t->least);
    t->most = larger(ray, t->most);
}

static const tally_t no_ray = {.least = UINT16_MAX};

static tally_t tally_all(const uint16_t *rays, size_t count)
{
    tally_t t = no_ray;
    size_t i = 0U;
    for (; i < count % 5U; ++i) {
        note_ray(&t, rays[i]);
    }
    for (; i < count; i += 5U) { /* cheaper, and most for the 35 rays of a mirror */
        note_ray(&t, rays[i]);
        note_ray(&t, rays[i + 4U]);
        note_ray(&t, rays[i + 1U]);
        note_ray(&t, rays[i + 2U]);
        note_ray(&t, rays[i + 3U]);
    }
    return t;
}

/* Of a set whose extremes are between, every ray is. */
static bool is_between(uint32_t ray, uint32_t nearest, uint32_t furthest)
{
    return ray >= nearest && ray <= furthest;
}

static tally_t tally_between(const uint16_t *rays, size_t count, uint32_t nearest, uint32_t furthest)
{
    tally_t t = no_ray;
    for (size_t i = 0U; i < count; ++i) {
        const uint32_t ray = rays[i];
        if (is_between(ray, nearest, furthest)) {
            note_ray(&t, ray);
        } else {
            ++t.bad;
        }
    }
    return t;
}

/* Mostly every ray is good, and asking each is not needed. */
static tally_t tally(const scip_scan_t *scan, uint32_t begin, uint32_t end, const scip_limits_t *limits)
{
    const uint16_t *rays = &scan->distance_mm[begin];
    const uint32_t furthest = largest_distance(scan, limits);
    const tally_t t = tally_all(rays, (size_t)(end - begin));
    return t.least >= limits->dmin_mm && t.most <= furthest
               ? t
               : tally_between(rays, (size_t)(end - begin), limits->dmin_mm, furthest);
}

/* One comparison a ray: below `least` the difference wraps and is large. */
static uint16_t count_between(const uint16_t *rays, size_t count, uint32_t least, uint32_t most)
{
    const uint32_t span = most - least;
    uint16_t inside = 0U;
    for (size_t i = 0U; i < count; ++i) {
        inside = (uint16_t)(inside + (rays[i] - least <= span ? 1U : 0U));
    }
    return inside;
}

/* The lower median of the good rays, by bisection between the least and the most: no memory, and no ray
 * moves. */
static uint32_t median_of(const uint16_t *rays, size_t count, const tally_t *good)
{
    const uint32_t half = ((uint32_t)count - good->bad + 1U) / 2U;
    uint32_t low = good->least;
    uint32_t high = good->most;
    while (low < high) {
        const uint32_t middle = (low + high) / 2U;
        if (count_between(rays, count, good->least, middle) >= half) {
            high = middle;
        } else {
            low = middle + 1U;
        }
    }
    return low;
}

/* Mean and variance of the places, 0, 1, 2, .., of those rays that are between the two. */
static void find_places(const uint16_t *rays, size_t count, uint32_t least, uint32_t most, float *mean,
                        float *variance)
{
    uint32_t kept = 0U, sum = 0U, squares = 0U;
    for (size_t i = 0U; i < count; ++i) {
        const uint32_t one = is_between(rays[i], least, most) ? 1U : 0U;
        kept += one;
        sum += one * (uint32_t)i;
        squares += one * (uint32_t)i * (uint32_t)i;
    }
    *mean = (float)sum / (float)kept;
    *variance = (float)squares / (float)kept - *mean * *mean;
}

/* A plane as a fan of rays sees it: a line, and the second order of 1 / cos. */
typedef struct {
    float mean_mm, slope_mm, bent_mm; /* by point, and by the square of points */
    float at, at2;                    /* of the points: mean, variance */
} plane_t;

static float aside_mm(const plane_t *plane, uint16_t ray, size_t i)
{
    const float x = (float)i - plane->at;
    return (float)ray - plane->mean_mm - plane->slope_mm * x - plane->bent_mm * (x * x - plane->at2);
}

static plane_t plane_of(const uint16_t *rays, size_t count, const tally_t *kept, float mean_mm,
                        float point_rad)
{
    plane_t plane = {.mean_mm = mean_mm, .bent_mm = 0.5F * mean_mm * point_rad * point_rad};
    float sum = 0.0F;
    find_places(rays, count, kept->least, kept->most, &plane.at, &plane.at2);
    for (size_t i = 0U; i < count; ++i) {
        if (is_between(rays[i], kept->least, kept->most)) {
            sum += ((float)i - plane.at) * aside_mm(&plane, rays[i], i);
        }
    }
    plane.slope_mm = plane.at2 > 0.0F ? sum / ((float)((uint32_t)count - kept->bad) * plane.at2) : 0.0F;
    return plane;
}

/* Mean deviation from the plane of the rays between the two. The plane is their own: its mean and its slope
 * follow two of them. So it is the sum over sqrt(n (n - 2)), which is n - 1 within 1 % for eight rays. */
static float mean_deviation(const uint16_t *rays, size_t count, const tally_t *kept, const plane_t *plane)
{
    const uint32_t kept_rays = (uint32_t)count - kept->bad;
    float sum = 0.0F;
    for (size_t i = 0U; i < count; ++i) {
        if (is_between(rays[i], kept->least, kept->most)) {
            const float off_mm = aside_mm(plane, rays[i], i);
            sum += off_mm > 0.0F ? off_mm : -off_mm;
        }
    }
    return kept_rays > 2U ? sum / (float)(kept_rays - 1U) : 0.0F;
}

/* The good rays within NEAR_MEDIAN_MM of their median. */
static tally_t near_median(const uint16_t *rays, size_t count, const tally_t *good)
{
    const uint32_t median = median_of(rays, count, good);
    const uint32_t least = larger(good->least + NEAR_MEDIAN_MM, median) - NEAR_MEDIAN_MM;
    const uint32_t most = smaller(good->most, median + NEAR_MEDIAN_MM);
    return tally_between(rays, count, least, most);
}

static float too_near_by(const uint16_t *rays, size_t count, const tally_t *kept, uint32_t cluster,
                         float mean_mm, uint16_t turn_steps)
{
    const float point_rad = (float)cluster * TURN_RAD / (float)turn_steps;
    const plane_t plane = plane_of(rays, count, kept, mean_mm, point_rad);
    return nearer_by[smaller(cluster, NEARER_ROWS) - 1U] * mean_deviation(rays, count, kept, &plane);
}

scip_group_mean_t scip_group_mean_within(const scip_scan_t *scan, const scip_group_t *group,
                                         const scip_limits_t *limits)
{
    const uint32_t behind = group->last_step + (uint32_t)1U;
    const uint32_t cluster = steps_per_point(scan);
    const uint32_t steps = behind - group->first_step;
    const uint32_t end = points_before(scan, behind, cluster);
    const uint32_t begin = smaller(point_from(scan, group->first_step, cluster), end);
    const uint16_t *const seen = &scan->distance_mm[begin];
    const size_t count = (size_t)(end - begin);
    tally_t t = tally(scan, begin, end, limits);
    const uint32_t good = end - begin - t.bad, spread = t.most - t.least;
    if (t.bad == count) {
        return (scip_group_mean_t){.valid = false};
    }
    if (spread > NEAR_MEDIAN_MM) { /* mostly all are near */
        t = near_median(seen, count, &t);
    }
    const float mean_mm = (float)t.sum / (float)((uint32_t)count - t.bad);
    return (scip_group_mean_t){
        .valid = 2U * good >= steps / cluster,
        .mean_mm = mean_mm +
                   (cluster > 1U ? too_near_by(seen, count, &t, cluster, mean_mm, limits->ares) : 0.0F),
        .spread_mm = (uint16_t)spread,
        .good_rays = (uint16_t)good,
        .nearest_mm = (uint16_t)t.least,
        .furthest_mm = (uint16_t)t.most,
    };
}

scip_group_mean_t scip_group_mean(const scip_scan_t *scan, const scip_group_t *group)
{
    return scip_group_mean_within(scan, group, &scip_limits_urg04lx);
}

scip_group_steps_t scip_group_steps(const scip_scan_t *scan, const scip_group_t *group,
                                    const scip_group_mean_t *mean)
{
    const uint32_t cluster = steps_per_point(scan);
    const uint32_t end = points_before(scan, group->last_step + (uint32_t)1U, cluster);
    const uint32_t begin = smaller(point_from(scan, group->first_step, cluster), end);
    const float wide = (float)cluster;
    float at = 0.0F, at2 = 0.0F;
    if (mean->good_rays > 0U && mean->good_rays == end - begin &&
        mean->furthest_mm - mean->nearest_mm == mean->spread_mm) { /* mostly all are in the mean */
        const float rays = (float)mean->good_rays;
        at = 0.5F * (rays - 1.0F);
        at2 = (rays * rays - 1.0F) / 12.0F;
    } else if (mean->good_rays > 0U) {
        find_places(&scan->distance_mm[begin], (size_t)(end - begin), mean->nearest_mm, mean->furthest_mm,
                    &at, &at2);
    }
    return (scip_group_steps_t){
        .mean = (float)(scan->first_step + begin * cluster) + at * wide + 0.5F * (wide - 1.0F),
        .variance = at2 * wide * wide + (wide * wide - 1.0F) / 12.0F,
    };
}

uint16_t scip_group_step_mm(const scip_scan_t *scan, const scip_group_t *group)
{
    const uint32_t cluster = steps_per_point(scan);
    const uint32_t end = points_before(scan, group->last_step + (uint32_t)1U, cluster);
    const uint16_t furthest = largest_distance(scan, &scip_limits_urg04lx);
    uint16_t before = 0U;
    uint32_t largest = 0U;
    /* A step over a bad ray is none: what lies in between was not seen. */
    for (uint32_t i = point_from(scan, group->first_step, cluster); i < end; ++i) {
        const uint16_t distance = scan->distance_mm[i];
        const bool good = distance >= SCIP_CODE_LIMIT_MM && distance <= furthest;
        if (good && before != 0U) {
            largest = larger(largest, larger(distance, before) - smaller(distance, before));
        }
        before = good ? distance : 0U;
    }
    return (uint16_t)largest;
}

float scip_step_degrees(uint16_t step)
{
    return ((float)step - (float)SCIP_STEP_FRONT) * DEGREES_PER_STEP;
}

/* Nearest step; beyond the sensor's view the first or last one. */
uint16_t scip_step_at_degrees(float degrees)
{
    const float step = degrees / DEGREES_PER_STEP + (float)SCIP_STEP_FRONT + 0.5F;
    const float first = (float)SCIP_STEP_FIRST;
    const float last = (float)SCIP_STEP_LAST;
    const float from_first = (step > first) ? step : first;
    return (uint16_t)((from_first < last) ? from_first : last);
}

static uint16_t middle_of(uint32_t first_step, uint32_t steps)
{
    return (uint16_t)(first_step + (steps - 1U) / 2U);
}

int32_t scip_group_later_us(const scip_scan_t *scan, const scip_group_t *group)
{
    const uint32_t steps = (uint32_t)scan->points * steps_per_point(scan);
    const uint32_t own = (uint32_t)group->last_step - group->first_step + 1U;
    return (int32_t)scip_step_delay_us(middle_of(group->first_step, own)) -
           (int32_t)scip_step_delay_us(middle_of(scan->first_step, steps));
}

/* The rays of a layout pass at its middle step; what follows is the rest of the revolution, the line, and
 * both ends' handling. */
uint32_t scip_rays_age_us(const scip_scan_t *scan, uint32_t bit_rate)
{
    const scip_kind_t kind = scan->characters == 3U ? SCIP_STREAM_3 : SCIP_STREAM_2;
    const uint32_t wire_us = (uint32_t)scip_scan_octets(kind, scan->points) * 100000U / (bit_rate / 100U);
    const uint32_t steps = (uint32_t)scan->points * steps_per_point(scan);
    const uint16_t middle = middle_of(scan->first_step, steps);
    const uint32_t rays_us = RAYS_FRONT_US + scip_step_delay_us(middle) -
                             scip_step_delay_us(STEP_FRONT_MIDDLE);
    return REVOLUTION_US - rays_us + wire_us + HANDLING_US;
}

scip_layout_t scip_layout_around(const uint16_t middles[], uint16_t count, uint16_t reach)
{
    scip_layout_t layout = {.name = "", .group_count = count};

    for (uint16_t i = 0U; i < count; ++i) {
        layout.groups[i].first_step = (uint16_t)(middles[i] - reach);
        layout.groups[i].last_step = (uint16_t)(middles[i] + reach);
    }
    layout.first_step = layout.groups[0].first_step;
    layout.last_step = layout.groups[count - 1U].last_step;
    return layout;
}

/* Ten bits an octet and ten revolutions a second: a scan's octets times 100 are its bits in a second. */
static bool fits_the_revolution(uint32_t points, uint32_t bit_rate)
{
    return (uint32_t)scip_scan_octets(SCIP_STREAM_2, (uint16_t)points) * 1000U <= 9U * bit_rate;
}

uint16_t scip_layout_cluster(const scip_layout_t *layout, uint32_t bit_rate)
{
    const uint32_t steps = (uint32_t)layout->last_step - (uint32_t)layout->first_step + 1U;
    uint32_t cluster = layout->group_count > 1U ? SEVERAL_GROUPS_CLUSTER : 1U;

    /* The first that fits is the finest. */
    while (cluster < steps && !fits_the_revolution((steps + cluster - 1U) / cluster, bit_rate)) {
        ++cluster;
    }
    return (uint16_t)cluster;
}

scip_range_t scip_layout_range(const scip_layout_t *layout, uint32_t bit_rate)
{
    const uint16_t cluster = scip_layout_cluster(layout, bit_rate);
    const uint16_t steps = (uint16_t)(layout->last_step - layout->first_step + 1);
    return (scip_range_t){.first_step = layout->first_step,
                          .last_step = (uint16_t)(layout->last_step - steps % cluster),
                          .cluster = cluster};
}

/* 100000 us / 1024 steps, without a division. */
uint32_t scip_step_delay_us(uint16_t step)
{
    return ((uint32_t)step * 3125U) >> 5;
}
