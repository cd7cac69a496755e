/* The scanner on its bracket: where each of its rays begins and points. Three mirrors on arms bend the rays
 * that meet them to the ground (or two, on the bracket of two beams); those between them go straight on.
 *
 * Written from the bracket's drawing (seed document, figures 5.7 and 5.8, Annex III), independently of the
 * product's correction. */
#ifndef SIM_DEVICES_BRACKET_H
#define SIM_DEVICES_BRACKET_H

#include "sim/devices/place.h"
#include "sim/devices/quadrotor.h"

#define BRACKET_FRONT 0 /* the seed's three mirrors come first */
#define BRACKET_AFT 1
#define BRACKET_FORE 2
#define BRACKET_MIRRORS 5

/* One mirror: the steps that look into it, and the place of reflection in vehicle axes with the vehicle
 * level: `out` along the lateral axis towards the mirror's side, `fore` along the nose, `up` above the gear's
 * lowest point. */
typedef struct {
    int first_step, last_step;
    double path_mm;
    double out_mm, fore_mm, up_mm;
    double axis_step; /* the ray that meets its middle square */
} bracket_mirror_t;

extern const bracket_mirror_t bracket_mirrors[BRACKET_MIRRORS];

/* The mirror that a step looks into; -1: none. */
int bracket_mirror_at(int step);

/* The vehicle in the place's axes, millimetres. */
typedef struct {
    place_vector_t centre, fore, right, up; /* centre: on the gear's plane */
} bracket_pose_t;

bracket_pose_t bracket_pose(const quadrotor_state_t *state);

/* A ray of the sensor, from where it leaves the mirror, or the sensor where there is none. */
typedef struct {
    place_vector_t from, direction; /* millimetres; length 1 */
    place_vector_t across;          /* sideways, as the sensor turns */
    double before_mm;               /* its way up to there */
} bracket_ray_t;

/* mirror: bracket_mirror_at(step). */
bracket_ray_t bracket_ray(int mirror, const bracket_pose_t *pose, int step);

#endif
