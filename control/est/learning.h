/* What a flight teaches law EST about its vehicle: the hover thrust, the gust, and the dead band.
 *
 * Newtons per motor, seconds. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_LEARNING_H
#define CONTROL_LEARNING_H

#include <stdbool.h>

#include "control/est/cascade.h"
#include "control/est/deadband.h"
#include "control/est/estimator.h"
#include "control/est/hover.h"

/* What one IMU frame of a vehicle in the air shows. */
typedef struct {
    cascade_vehicle_t vehicle; /* present model */
    float delivered_n;
    bool is_climb;  /* PLANT CLIMB: the throttle commands a climb rate */
    bool confirmed; /* heights are fresh, and commands have an effect */
    float dt_s;     /* time since the frame before, > 0 */
} lesson_t;

/* From accelerations. On the ground they only show that the hover thrust is at least the present thrust. */
void learning_by_accelerations(hover_t *hover, deadband_t *deadband, const estimator_t *estimator,
                               const lesson_t *lesson);

/* Without accelerations. The filter's bias is then the error of the model: modelled minus true acceleration.
 * Its constant part moves slowly into the hover thrust, out of the bias. */
void learning_by_model(hover_t *hover, deadband_t *deadband, estimator_t *estimator, const lesson_t *lesson);

#endif
