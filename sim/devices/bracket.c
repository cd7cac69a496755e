#include "sim/devices/bracket.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#define STEP_DEG (360.0 / 1024.0)
#define OUTWARD_STEP 384.0
#define SENSOR_OUT_MM 115.0
#define SENSOR_UP_MM 100.0
#define STEPS 769 /* of the sensor: 0 to 768 */

/* The sensor stands 115 mm out (220 - 105) and looks outwards at step 384; larger steps turn towards the
 * nose. */
const bracket_mirror_t bracket_mirrors[BRACKET_MIRRORS] = {
    {367, 411, 105.0, 220.0, 0.0, 100.0, 384.0},
    {106, 150, 115.0, 115.0, -115.0, 98.0, 128.0},
    {618, 662, 107.0, 115.0, 107.0, 105.0, 640.0},
    /* The bracket of two beams, 42.5 degrees to either side, with the same distances along the ray. */
    {244, 282, 115.0, 199.8, -77.7, 98.0, 384.0 - 42.5 / STEP_DEG},
    {486, 524, 107.0, 193.9, 72.3, 105.0, 384.0 + 42.5 / STEP_DEG},
};

int bracket_mirror_at(int step)
{
    for (int i = 0; i < BRACKET_MIRRORS; i++) {
        if (step >= bracket_mirrors[i].first_step && step <= bracket_mirrors[i].last_step) {
            return i;
        }
    }
    return -1;
}

static place_vector_t add(place_vector_t a, double times, place_vector_t b)
{
    return (place_vector_t){a.x + times * b.x, a.y + times * b.y, a.z + times * b.z};
}

static place_vector_t mixed(double cosine, double sine, place_vector_t from, place_vector_t towards)
{
    const place_vector_t none = {0.0, 0.0, 0.0};

    return add(add(none, cosine, from), sine, towards);
}

static place_vector_t turned(double angle_rad, place_vector_t from, place_vector_t towards)
{
    return mixed(cos(angle_rad), sin(angle_rad), from, towards);
}

/* Of an angle. */
typedef struct {
    bool known;
    double cosine, sine, tangent;
} angle_t;

/* Of so many steps: a flight asks for the same hundred thousands of times. */
static const angle_t *angle_of(angle_t *angle, double steps)
{
    if (!angle->known) {
        const double rad = steps * STEP_DEG * (M_PI / 180.0);

        *angle = (angle_t){.known = true, .cosine = cos(rad), .sine = sin(rad), .tangent = tan(rad)};
    }
    return angle;
}

/* Heading, then pitch about the lateral axis, then roll about the nose: as the seed draws it, about the point
 * on the gear's plane under the centre. */
bracket_pose_t bracket_pose(const quadrotor_state_t *state)
{
    const place_vector_t zenith = {0.0, 0.0, 1.0}, none = {0.0, 0.0, 0.0};
    const place_vector_t level_fore = {cos(state->heading_rad), sin(state->heading_rad), 0.0};
    const place_vector_t level_right = {sin(state->heading_rad), -cos(state->heading_rad), 0.0};
    const place_vector_t pitched_up = turned(state->pitch_rad, zenith, add(none, -1.0, level_fore));

    return (bracket_pose_t){.centre = {1000.0 * state->x_m, 1000.0 * state->y_m, 1000.0 * state->altitude_m},
                            .fore = turned(state->pitch_rad, level_fore, zenith),
                            .right = turned(state->roll_rad, level_right, pitched_up),
                            .up = turned(state->roll_rad, pitched_up, add(none, -1.0, level_right))};
}

/* The mirror stands at 45 degrees across its axis, and turns what comes along it straight down. A ray that
 * comes `aside` by an angle meets it later, and leaves it aside by the same angle: the rays of a mirror are a
 * fan. */
bracket_ray_t bracket_ray(int mirror, const bracket_pose_t *pose, int step)
{
    static angle_t bearings[BRACKET_MIRRORS], straight[STEPS], asides[BRACKET_MIRRORS][STEPS];
    const place_vector_t none = {0.0, 0.0, 0.0};
    const bracket_mirror_t *at = mirror >= 0 ? &bracket_mirrors[mirror] : NULL;
    const double axis_step = at != NULL ? at->axis_step : (double)step;
    const angle_t *bearing = angle_of(at != NULL ? &bearings[mirror] : &straight[step],
                                      axis_step - OUTWARD_STEP);
    const place_vector_t axis = mixed(bearing->cosine, bearing->sine, pose->right, pose->fore);
    const place_vector_t across = mixed(bearing->cosine, bearing->sine, pose->fore,
                                        add(none, -1.0, pose->right));
    const place_vector_t sensor = add(add(pose->centre, SENSOR_OUT_MM, pose->right),
                                      at != NULL ? at->up_mm : SENSOR_UP_MM, pose->up);

    if (at == NULL) {
        return (bracket_ray_t){sensor, axis, across, 0.0};
    }
    const angle_t *aside = angle_of(&asides[mirror][step], (double)step - axis_step);
    return (bracket_ray_t){add(add(sensor, at->path_mm, axis), at->path_mm * aside->tangent, across),
                           add(add(none, -aside->cosine, pose->up), aside->sine, across), across,
                           at->path_mm / aside->cosine};
}
