#include "sim/devices/course.h"

#include <math.h>

#define THERE_M 1e-3

void course_begin(course_point_t *point)
{
    *point = (course_point_t){.leg = -1};
}

static void rest(course_point_t *point)
{
    point->vx_mps = point->vy_mps = point->ax_mps2 = point->ay_mps2 = 0.0;
}

static void next_leg(const course_t *course, course_point_t *point, double t_s)
{
    if (!point->on_leg && point->leg + 1 < course->count && t_s >= course->legs[point->leg + 1].start_s) {
        point->leg++;
        point->on_leg = true;
    }
}

/* Speeds up, or slows down so that it stands at the end. */
static void move(const course_leg_t *leg, course_point_t *point, double step_s)
{
    const double dx = leg->x_m - point->x_m, dy = leg->y_m - point->y_m;
    const double left_m = hypot(dx, dy);
    const double before_mps = hypot(point->vx_mps, point->vy_mps);
    const double brake_mps = sqrt(2.0 * COURSE_MPS2 * left_m);
    const double speed_mps = fmin(fmin(before_mps + COURSE_MPS2 * step_s, leg->speed_mps), brake_mps);

    if (left_m < THERE_M || left_m <= speed_mps * step_s) {
        point->x_m = leg->x_m;
        point->y_m = leg->y_m;
        point->on_leg = false;
        rest(point);
        return;
    }
    const double share = speed_mps / left_m, gain_mps2 = (speed_mps - before_mps) / step_s;
    point->ax_mps2 = gain_mps2 * dx / left_m;
    point->ay_mps2 = gain_mps2 * dy / left_m;
    point->vx_mps = share * dx;
    point->vy_mps = share * dy;
    point->x_m += step_s * point->vx_mps;
    point->y_m += step_s * point->vy_mps;
}

static void turn(const course_leg_t *leg, course_point_t *point, double step_s)
{
    const double off_rad = remainder(leg->heading_rad - point->heading_rad, 2.0 * M_PI);
    const double most_rad = leg->turn_radps * step_s;

    point->heading_rad += fmin(fmax(off_rad, -most_rad), most_rad);
}

void course_step(const course_t *course, course_point_t *point, double t_s, double step_s)
{
    next_leg(course, point, t_s);
    if (point->on_leg) {
        move(&course->legs[point->leg], point, step_s);
    }
    if (point->leg >= 0) {
        turn(&course->legs[point->leg], point, step_s);
    }
}
