#include "laser_scan.h"

#include <math.h>
#include <plomada/scip_layout.h>

#define TURN_RAD 6.2831853F
#define MINUTE_US 60000000UL

static uint16_t steps_a_point(const scip_scan_t *scan)
{
    return scan->cluster > 1U ? scan->cluster : 1U;
}

/* Of a stream: MS or MD. */
static uint32_t wire_us(const scip_scan_t *scan, uint32_t bit_rate)
{
    const scip_kind_t kind = scan->characters == 3U ? SCIP_STREAM_3 : SCIP_STREAM_2;
    const uint32_t bits = 10U * (uint32_t)scip_scan_octets(kind, scan->points);

    return bit_rate > 0U ? (uint32_t)((uint64_t)bits * 1000000U / bit_rate) : 0U;
}

laser_scan_shape_t laser_scan_shape(const scip_limits_t *limits, const scip_scan_t *scan, uint32_t bit_rate)
{
    const float step = TURN_RAD / (float)limits->ares;
    const float cluster = (float)steps_a_point(scan);
    const uint32_t turn_us = MINUTE_US / limits->scan_rpm;
    const float turn_s = 60.0F / (float)limits->scan_rpm;
    laser_scan_shape_t shape = {0};

    shape.angle_increment = step * cluster;
    shape.angle_min = step * ((float)scan->first_step - (float)limits->afrt + (cluster - 1.0F) / 2.0F);
    shape.angle_max = shape.angle_min + shape.angle_increment * (float)(scan->points - 1);
    shape.time_increment = turn_s * cluster / (float)limits->ares;
    shape.scan_time = turn_s;
    shape.range_min = (float)limits->dmin_mm / 1000.0F;
    shape.range_max = (float)limits->dmax_mm / 1000.0F;
    shape.first_ray_age_us = turn_us - (uint32_t)((uint64_t)turn_us * scan->first_step / limits->ares) +
                             wire_us(scan, bit_rate);
    return shape;
}

float laser_scan_range(const scip_limits_t *limits, const scip_scan_t *scan, uint16_t point)
{
    const uint16_t distance_mm = scan->distance_mm[point];

    if (distance_mm < limits->dmin_mm) {
        return NAN;
    }
    if (distance_mm > limits->dmax_mm || (scan->characters == 2U && distance_mm == SCIP_FAR_2_MM)) {
        return INFINITY;
    }
    return (float)distance_mm / 1000.0F;
}
