/* What a picture of the flight shows: the ground along the vehicle's nose, as seen from its right side, and
 * where the beams of the three mirrors end. */
#ifndef SIM_DEVICES_VIEW_H
#define SIM_DEVICES_VIEW_H

#include <stdbool.h>

#include "sim/devices/place.h"
#include "sim/devices/quadrotor.h"

#define VIEW_BEAMS 3
#define VIEW_POINTS 161
#define VIEW_STEP_M 0.025
#define VIEW_FIRST_M (-2.0) /* the first point of the ground, behind the vehicle; the last is 2 m ahead */

/* Of the ray along a mirror's axis, in the place's axes. */
typedef struct {
    place_vector_t from, to;
    bool meets; /* else it ends where the sensor's reach does */
} view_beam_t;

typedef struct {
    double ground_m[VIEW_POINTS]; /* the highest surface, every VIEW_STEP_M along the nose */
    view_beam_t beam[VIEW_BEAMS]; /* in the order of bracket_mirrors: front, aft, fore */
} view_t;

view_t view_of(const place_t *place, const quadrotor_state_t *vehicle, double t_s);

#endif
