/* Delivered thrust, less what the measured acceleration and the drag took of it.
 * What breaks: while no height confirms the estimated speed, nothing may be learned: the error of the speed
 * would become hover thrust. */
#include "control/est/learning.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"

/* The damping is anywhere in 1.5 .. 3 1/s (plan.py): off DAMP, 2.4 1/s, by sqrt(1.5^2 / 12 + 0.15^2) = 0.46
 * 1/s rms; times 7 N / 9.81 m/s2. */
#define SPEED_DOUBT_N_PER_MPS 0.33F
#define NO_ACC_TIME_S 3.0F   /* tried 1.5 to 6: the model's bias becomes hover thrust */
#define NO_ACC_DEADBAND 0.1F /* tried 0 to 1: the model's bias tells the deadband late */

void learning_by_accelerations(hover_t *hover, deadband_t *deadband, const estimator_t *estimator,
                               const lesson_t *lesson)
{
    const estimate_t *now = &estimator->now;
    const cascade_vehicle_t *vehicle = &lesson->vehicle;
    const float drag_mps2 = vehicle->damping_per_s * now->speed_mps;
    const float taken_n = (estimator->up_mps2 - now->bias_mps2 + drag_mps2) / vehicle->authority_mps2_per_n;
    const float seen_n = lesson->delivered_n * vehicle->upright - taken_n;
    const float doubt_n = SPEED_DOUBT_N_PER_MPS * fabsf(now->speed_mps);

    if (!lesson->confirmed || estimator->unchecked_count > 0U) {
        hover_fade_gust(hover, lesson->dt_s);
        return; /* no height confirms the estimated speed */
    }
    if (now->height_m > IN_THE_AIR_M || seen_n > hover->thrust_n) {
        hover_step(hover, seen_n, estimator->credit.noise_mps2 / vehicle->authority_mps2_per_n + doubt_n,
                   lesson->dt_s);
    }
    if (lesson->is_climb && now->height_m > IN_THE_AIR_M) {
        deadband_learn(deadband, lesson->delivered_n - hover->thrust_n, seen_n - hover->thrust_n,
                       lesson->dt_s);
    }
}

void learning_by_model(hover_t *hover, deadband_t *deadband, estimator_t *estimator, const lesson_t *lesson)
{
    const cascade_vehicle_t *vehicle = &lesson->vehicle;
    const float moved_mps2 = lesson->dt_s / NO_ACC_TIME_S * estimator->now.bias_mps2;
    const float before_n = hover->thrust_n;

    if (!lesson->confirmed) {
        return;
    }
    if (lesson->is_climb && estimator->now.height_m > IN_THE_AIR_M) {
        deadband_learn(deadband, lesson->delivered_n - before_n, vehicle->need_n - before_n,
                       NO_ACC_DEADBAND * lesson->dt_s);
    }
    hover->thrust_n = between(hover->least_n, before_n + moved_mps2 / vehicle->authority_mps2_per_n,
                              hover->most_n);
    estimator_move_bias(estimator, (before_n - hover->thrust_n) * vehicle->authority_mps2_per_n);
}
