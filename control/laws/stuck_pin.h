/* While the pin says that the pilot has the throttle, no thrust commanded here moves the vehicle, unless the
 * pin is wrong. For that case the output holds it by its heights, and lands it after a while, or when that is
 * ordered. Only the output contains this: nothing is learned from it, and a hand-back starts without it.
 *
 * Newtons per motor, seconds. Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_LAWS_STUCK_PIN_H
#define CONTROL_LAWS_STUCK_PIN_H

#include "control/laws/descent.h"
#include "control/situation.h"

typedef struct {
    float piloted_s; /* for how long the pin has said so */
    float more_n;    /* added to the output */
    float vain_s;  /* how long that has been too little to fly, and it does not sink, less how long it sank */
    float vain_mm; /* height at which that was known */
    bool obeys;    /* it rose when the thrust returned */
    bool stepped;  /* the latest height was a step, and is left out */
    descent_t descent;
} stuck_pin_t;

/* One cycle, in which the mode may be another one too. */
void stuck_pin_step(stuck_pin_t *pin, const situation_t *now);

/* What is added to the output. */
static inline float stuck_pin_added_n(const stuck_pin_t *pin)
{
    return pin->more_n;
}

/* The pin says that the pilot flies: its heights and frames are read in each cycle. */
static inline bool stuck_pin_acts(const stuck_pin_t *pin)
{
    return pin->piloted_s > 0.0F;
}

#endif
