/* A scan as sensor_msgs/LaserScan tells it: radians, metres, seconds, and what REP 117 writes where there is
 * no distance. Nothing of ROS is needed here, so it is tested without. */
#ifndef LASER_SCAN_H
#define LASER_SCAN_H

#include <plomada/scip_info.h>
#include <plomada/scip_parser.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    float angle_min, angle_max, angle_increment; /* rad; 0 is ahead, > 0 left of it */
    float time_increment, scan_time;             /* s: from ray to ray, from turn to turn */
    float range_min, range_max;                  /* m */
    uint32_t first_ray_age_us;                   /* when the scan's last octet arrives */
} laser_scan_shape_t;

/* The sensor samples step s of ares steps s/ares of a turn after its time stamp, and sends when the turn is
 * over. bit_rate: of the line; 0 where it takes no time, as USB. */
laser_scan_shape_t laser_scan_shape(const scip_limits_t *limits, const scip_scan_t *scan, uint32_t bit_rate);

/* Metres; infinity where nothing was there, NaN where the sensor tells an error. */
float laser_scan_range(const scip_limits_t *limits, const scip_scan_t *scan, uint16_t point);

#ifdef __cplusplus
}
#endif

#endif
