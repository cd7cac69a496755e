/* A mean from the first lesson on, and a low pass of 2.5 s later: so a fault is doubted before its error is
 * learned.
 *
 * The mass is within 1.5 N of what GRAV says. An emptying battery takes as much again where the autopilot
 * does not compensate, but slowly. So the upper limit follows what is learned, no faster than a battery
 * falls.
 *
 * What breaks: learning from a vehicle that something else holds. So the caller tells when a command carries
 * it. */
#include "control/where/hover_thrust.h"

#include "control/between.h"
#include "control/thrust.h"

/* DJI's autopilots move the middle of their stick by up to 30 % of its way, 3.5 N, within a minute of a low
 * battery (owners' logs). A 4S of 5 Ah that empties in a hover, thrust by the square of its voltage: 0.02 at
 * the end. */
#define BATTERY_NPS 0.06F

static void learn(hover_thrust_t *hover, const hover_lesson_t *lesson)
{
    const bool again = hover->learned_s > 0.0F;

    if ((!lesson->estimated && !lesson->holds) || (again && !lesson->teaches)) {
        return;
    }
    const float target_n = lesson->estimated ? lesson->estimated_n : lesson->thrust_n;
    const float time_s = lesson->estimated ? hover->learned_s : HOVER_TIME_S;

    hover->thrust_n += at_most(lesson->step_s / at_least(time_s, 0.001F), 1.0F) *
                       (target_n - hover->thrust_n);
    hover->learned_s = at_most(hover->learned_s + lesson->step_s, HOVER_TIME_S);
}

static void wear(hover_thrust_t *hover, const hover_lesson_t *lesson)
{
    const float beyond_n = hover->thrust_n - (lesson->gravity_n + HOVER_THRUST_MARGIN_N);

    hover->worn_n = at_least(hover->worn_n, at_most(beyond_n, hover->worn_n + BATTERY_NPS * lesson->step_s));
}

static float held_near(const hover_thrust_t *hover, float gravity_n)
{
    return at_most(at_least(hover->thrust_n, gravity_n - HOVER_THRUST_MARGIN_N),
                   gravity_n + HOVER_THRUST_MARGIN_N + hover->worn_n);
}

void hover_thrust_step(hover_thrust_t *hover, const hover_lesson_t *lesson)
{
    hover->learned = !lesson->grounded && (hover->learned || lesson->flies);
    if (!hover->learned) {
        hover->thrust_n = lesson->gravity_n;
        hover->worn_n = 0.0F;
        hover->learned_s = 0.0F;
    } else if (lesson->flies && lesson->sees) {
        learn(hover, lesson);
        wear(hover, lesson);
    }
    hover->thrust_n = between(0.0F, held_near(hover, lesson->gravity_n), THRUST_MAX_N);
}

void hover_thrust_correct(hover_thrust_t *hover, float more_n)
{
    hover->thrust_n += more_n;
}

void hover_thrust_distrust(hover_thrust_t *hover, float gravity_n)
{
    if (hover->learned_s < HOVER_TIME_S) {
        hover->thrust_n = gravity_n;
        hover->learned_s = 0.0F;
    }
}

void hover_thrust_lift_off(hover_thrust_t *hover, float thrust_n)
{
    hover->thrust_n = thrust_n;
    hover->learned = true;
}

float hover_thrust_near(float gravity_n, float thrust_n)
{
    return between(gravity_n - HOVER_THRUST_MARGIN_N, thrust_n, gravity_n + HOVER_THRUST_MARGIN_N);
}
