/* Where the one who steers wants the vehicle to be: a pilot's roll, pitch and yaw sticks, or a waypoint
 * course. The height is not his business here: that is the throttle's.
 *
 * Legs follow each other. Each begins at its time, or when the one before has ended, and leads in a straight
 * line to (x, y) at its speed, taken up and given up at COURSE_MPS2. Axes and angles as in place.h; the
 * course begins at the origin, nose along x. */
#ifndef SIM_DEVICES_COURSE_H
#define SIM_DEVICES_COURSE_H

#include <stdbool.h>

#define COURSE_LEGS_MAX 64
#define COURSE_MPS2 1.5 /* a lean of 9 degrees */

typedef struct {
    double start_s; /* scenario time; later when the leg before lasts longer */
    double x_m, y_m;
    double speed_mps;   /* above 0 */
    double heading_rad; /* turns to it at `turn_radps` from the leg's start on */
    double turn_radps;  /* 0: keeps its heading */
} course_leg_t;

typedef struct {
    bool carried; /* the vehicle goes exactly as the course says, whatever its lean does: a flight of which
                   * only the times are known at which it was where */
    int count;
    course_leg_t legs[COURSE_LEGS_MAX];
} course_t;

/* What is wanted now. */
typedef struct {
    int leg; /* under way; -1: none yet */
    bool on_leg;
    double x_m, y_m, vx_mps, vy_mps, ax_mps2, ay_mps2, heading_rad;
} course_point_t;

/* The origin. */
void course_begin(course_point_t *point);
/* One step on. t_s: scenario time at its end. */
void course_step(const course_t *course, course_point_t *point, double t_s, double step_s);

#endif
