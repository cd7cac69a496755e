/* The ground under the flight path as a function of scenario time. */
#ifndef SIM_DEVICES_TERRAIN_H
#define SIM_DEVICES_TERRAIN_H

#include <stdbool.h>

typedef struct {
    bool ramp;           /* false: flat floor */
    double ramp_start_s; /* 7.3 */
    double ramp_end_s;   /* 8.0 */
    double height_m;     /* 0.25 */
    double edge_s;       /* 11.0 */
} terrain_t;

extern const terrain_t terrain_flat;
extern const terrain_t terrain_platform; /* the seed's chapter 6 */

double terrain_height_m(const terrain_t *terrain, double t_s);

#endif
