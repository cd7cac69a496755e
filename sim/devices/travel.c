#include "sim/devices/travel.h"

#include <math.h>
#include <stddef.h>

#define GRAVITY_MPS2 9.80665
/* A loop that settles in 3 s, well below the attitude's 0.6 Hz. It goes at the pace of a slower attitude. */
#define PLACE_PER_S2 1.0
#define SPEED_PER_S 1.6
#define LEAN_MAX_RAD 0.35
#define DRAG_PER_S 0.3 /* chosen: 1 m/s leans by 1.7 degrees */
#define CARRIED_PER_S 3.0
#define CARRIED_MPS 1.0 /* chosen: faster than the course at most */
#define WAITS_M 0.5

void travel_init(travel_t *travel, const course_t *course)
{
    *travel = (travel_t){.course = course, .pace = 1.0};
    course_begin(&travel->wanted);
}

void travel_follow(travel_t *travel, const course_t *course)
{
    travel->course = course;
    travel->wanted.leg = -1;
    travel->wanted.on_leg = false;
}

static double lean_rad(double wanted_mps2)
{
    return fmin(fmax(-atan(wanted_mps2 / GRAVITY_MPS2), -LEAN_MAX_RAD), LEAN_MAX_RAD);
}

static bool waits(const travel_t *travel)
{
    const course_point_t *to = &travel->wanted;

    return travel->course->carried && travel->standing &&
           hypot(to->x_m - travel->x_m, to->y_m - travel->y_m) > WAITS_M;
}

void travel_steer(travel_t *travel, double t_s, double step_s, double heading_rad)
{
    const course_point_t *to = &travel->wanted;

    if (travel->course == NULL) {
        return;
    }
    const double place_per_s2 = travel->course->carried ? 0.0 : PLACE_PER_S2 * travel->pace * travel->pace;
    const double speed_per_s = travel->course->carried ? 0.0 : SPEED_PER_S * travel->pace;
    if (!waits(travel)) {
        course_step(travel->course, &travel->wanted, t_s, step_s);
    }
    const double ax = to->ax_mps2 + DRAG_PER_S * to->vx_mps + place_per_s2 * (to->x_m - travel->x_m) +
                      speed_per_s * (to->vx_mps - travel->vx_mps);
    const double ay = to->ay_mps2 + DRAG_PER_S * to->vy_mps + place_per_s2 * (to->y_m - travel->y_m) +
                      speed_per_s * (to->vy_mps - travel->vy_mps);
    travel->pitch_rad = lean_rad(ax * cos(heading_rad) + ay * sin(heading_rad));
    travel->roll_rad = lean_rad(ax * sin(heading_rad) - ay * cos(heading_rad));
}

static double carried_mps(double wanted_mps, double behind_m)
{
    return wanted_mps + fmin(fmax(CARRIED_PER_S * behind_m, -CARRIED_MPS), CARRIED_MPS);
}

static void carry(travel_t *travel, double step_s)
{
    const course_point_t *to = &travel->wanted;

    travel->vx_mps = carried_mps(to->vx_mps, to->x_m - travel->x_m);
    travel->vy_mps = carried_mps(to->vy_mps, to->y_m - travel->y_m);
    travel->x_m += step_s * travel->vx_mps;
    travel->y_m += step_s * travel->vy_mps;
}

void travel_step(travel_t *travel, double step_s, double heading_rad, double roll_rad, double pitch_rad,
                 double lift_mps2, bool on_ground)
{
    if (travel->course == NULL) {
        return;
    }
    travel->standing = on_ground;
    if (on_ground) {
        travel->vx_mps = travel->vy_mps = 0.0;
        return;
    }
    if (travel->course->carried) {
        carry(travel, step_s);
        return;
    }
    const double fore_mps2 = -lift_mps2 * sin(pitch_rad) * cos(roll_rad);
    const double right_mps2 = -lift_mps2 * sin(roll_rad);
    const double c = cos(heading_rad), s = sin(heading_rad);

    travel->vx_mps += step_s * (c * fore_mps2 + s * right_mps2 - DRAG_PER_S * travel->vx_mps);
    travel->vy_mps += step_s * (s * fore_mps2 - c * right_mps2 - DRAG_PER_S * travel->vy_mps);
    travel->x_m += step_s * travel->vx_mps;
    travel->y_m += step_s * travel->vy_mps;
}
