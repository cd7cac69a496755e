/* The ground of the seed's flights as a place, and the way over it. Of its chapter 6 only times and heights
 * are known: the ramp is met at 7.3 s, the platform of 25 cm at 8.0 s, its edge is passed at 11.0 s. The
 * speed is not; at 0.4 m/s the ramp is 28 cm long and the platform 1.2 m. The vehicle is carried along this
 * course (course.h), so that it is where the seed's was when the seed's was. Over an even floor without a
 * ramp it stays where it is. */
#ifndef SIM_SCENARIOS_SEED_COURSE_H
#define SIM_SCENARIOS_SEED_COURSE_H

#include <stdbool.h>

#include "sim/devices/course.h"
#include "sim/devices/place.h"

#define SEED_COURSE_MPS 0.4

typedef struct {
    bool ramp;                               /* ramp and platform, or none */
    double platform_m;                       /* 0.25; < 0: a pit; 0: none */
    double ramp_start_s, ramp_end_s, edge_s; /* 7.3, 8, 11: at any speed */
    double speed_mps;                        /* over the ramp; 0.4 */
    double nose_rad;                         /* from the way to the nose: pi flies tail first */
    double rough_rms_m;                      /* 0: even. The whole floor but for the platform */
    double rough_s;                          /* its correlation length at that speed */
    double bars_m;                           /* their height, < 0: grooves; 0: none */
    double bars_s, bars_share;               /* from bar to bar at that speed; share that is bar */
} seed_course_t;

extern const seed_course_t seed_course_flat; /* no ramp; roughness and bars of no height */
extern const seed_course_t seed_course_ramp;

/* The waves of a rough floor by the seed. */
void seed_course_lay(const seed_course_t *wanted, unsigned long seed, place_t *place, course_t *course);
/* Roughness and bars for a place that has none of its own. */
void seed_course_floor(const seed_course_t *wanted, unsigned long seed, place_t *place);
/* The ramp a way ahead of x_m in a place without one, to be met `ahead_s` later, and the way over it, from
 * start_s on. */
void seed_course_meet(const seed_course_t *wanted, double x_m, double start_s, double ahead_s, place_t *place,
                      course_t *course);

#endif
