/* Thrust that brings the vehicle down at a bounded speed, with a height and without one, around a hover thrust that
 * may be wrong by a fifth. Pure; the caller owns the state. */
#ifndef CONTROL_DESCENT_H
#define CONTROL_DESCENT_H

#define DESCENT_RATE_MM_S 300.0F        /* high up; less and less below 0.6 m, 0.15 m/s at the ground */

typedef struct {
    float sink_mm_s;    /* wanted now */
    float trim_n;       /* learned on the way down: true hover thrust less the given one, as far as the rate tells */
    float near_ground_s;/* for how long it has been within 40 mm of the ground */
} descent_t;

/* Before the first step of a descent: the wanted sink rate grows from the present one. */
void descent_start(descent_t *descent, float rate_mm_s);

/* One new height, dt_s after the one before; rate_mm_s > 0 is up. A climb of 0.7 m/s or more is braked harder than the
 * rest is controlled. Within 40 mm of the ground the most thrust falls by 2 N/s, so that nothing lifts the vehicle again.
 * Returns newtons per motor, at least a quarter of hover_n but there, upwards not clipped. */
float descent_step(descent_t *descent, float hover_n, float height_mm, float rate_mm_s, float dt_s);

/* Without a height, elapsed_s after it was given up: sinks at 0.3 m/s where vertical damping is 2.4 1/s, then slowly
 * faster, and falls to 0 without a jump within 45 s. Newtons per motor, >= 0. */
float descent_blind(float hover_n, float elapsed_s);

#endif
