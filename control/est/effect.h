/* Do the commands have an effect? Without a pin nothing tells whether a pilot flies. The quick changes of the
 * commanded thrust tell: when the firmware has the throttle, the accelerometer measures them; when a pilot
 * has it, it does not. The share of them that it measures is a regression over the last seconds: noise of
 * the accelerometer makes it uncertain, but does not move its mean.
 *
 * Accelerations in m/s2, upwards. Pure; the caller owns the state. */
#ifndef CONTROL_EFFECT_H
#define CONTROL_EFFECT_H

#include <stdbool.h>

typedef struct {
    float pushed_mps2, felt_mps2;    /* slow means of both */
    float product, pushed_2, felt_2; /* means of the products of the quick rest, m2/s4 */
    float running_s;                 /* at most the time of these means */
    bool has_effect;
} effect_t;

/* Nothing known: has_effect is false. */
void effect_init(effect_t *effect);

/* One frame, dt_s > 0 after the one before. pushed_mps2: acceleration by the delivered thrust as commanded;
 * felt_mps2: by the accelerometer. A constant error of both does not matter. Writes has_effect. */
void effect_step(effect_t *effect, float pushed_mps2, float felt_mps2, float dt_s);

#endif
