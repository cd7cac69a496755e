#include "sim/devices/view.h"

#include <math.h>

#include "sim/devices/bracket.h"
#include "sim/devices/echo.h"

#define HIGH_M 50.0 /* above everything that stands in a place */

static place_vector_t metres(place_vector_t millimetres)
{
    return (place_vector_t){0.001 * millimetres.x, 0.001 * millimetres.y, 0.001 * millimetres.z};
}

static view_beam_t beam_of(const place_t *place, const bracket_pose_t *pose, int mirror, double t_s)
{
    const bracket_ray_t ray = bracket_ray(mirror, pose, (int)lround(bracket_mirrors[mirror].axis_step));
    const double reach_m = 0.001 * (ECHO_REACH_MM - ray.before_mm);
    view_beam_t beam = {.from = metres(ray.from)};
    place_hit_t hit;

    beam.meets = place_cast(place, beam.from, ray.direction, reach_m, t_s, &hit);
    beam.to = (place_vector_t){beam.from.x + hit.distance_m * ray.direction.x,
                               beam.from.y + hit.distance_m * ray.direction.y,
                               beam.from.z + hit.distance_m * ray.direction.z};
    return beam;
}

view_t view_of(const place_t *place, const quadrotor_state_t *vehicle, double t_s)
{
    const bracket_pose_t pose = bracket_pose(vehicle);
    const double c = cos(vehicle->heading_rad), s = sin(vehicle->heading_rad);
    view_t view;

    for (int i = 0; i < VIEW_POINTS; i++) {
        const double ahead_m = VIEW_FIRST_M + i * VIEW_STEP_M;

        view.ground_m[i] =
            place_below(place, vehicle->x_m + c * ahead_m, vehicle->y_m + s * ahead_m, HIGH_M, t_s).at.z;
    }
    for (int i = 0; i < VIEW_BEAMS; i++) {
        view.beam[i] = beam_of(place, &pose, i, t_s);
    }
    return view;
}
