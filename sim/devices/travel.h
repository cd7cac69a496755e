/* How the vehicle gets about: whoever steers leans it, and what it leans to, it accelerates to.
 *
 * A pilot (or an autopilot's position loop) compares where the vehicle is with the course, and asks for a
 * lean; the attitude follows as quadrotor.c's axes do; the horizontal part of the lift accelerates, the air
 * brakes. So a tilt that the air gives it moves the vehicle too, and it wanders about its place by some
 * centimetres.
 *
 * On a course that carries it (course.h) the vehicle leans as the way asks, and keeps to it all the same;
 * what it lost on the ground it makes up for in the air, half a metre at most: then the course waits for it.
 *
 * Axes of place.h. The seed's angles: roll > 0 raises the right side, pitch > 0 the nose. */
#ifndef SIM_DEVICES_TRAVEL_H
#define SIM_DEVICES_TRAVEL_H

#include "sim/devices/course.h"

typedef struct {
    const course_t *course; /* NULL: stays at the origin, and nobody steers */
    course_point_t wanted;
    double x_m, y_m, vx_mps, vy_mps;
    double roll_rad, pitch_rad; /* asked for */
    bool standing;
    double
        pace; /* of whoever steers; 1: of an attitude of 0.6 Hz or more, a slower one needs a slower hand */
} travel_t;

/* The course is borrowed. */
void travel_init(travel_t *travel, const course_t *course);
/* Another course, from where the vehicle is wanted now. */
void travel_follow(travel_t *travel, const course_t *course);
/* One step of the one who steers; heading_rad: of the nose, in the place's axes. */
void travel_steer(travel_t *travel, double t_s, double step_s, double heading_rad);
/* One step of the vehicle. lift_mps2: along the rotors' axis. On the ground it stays where it is. */
void travel_step(travel_t *travel, double step_s, double heading_rad, double roll_rad, double pitch_rad,
                 double lift_mps2, bool on_ground);

#endif
