/* Who has the throttle? A pin tells it, or nothing does. Without a pin the vehicle tells: while the firmware
 * has the throttle the accelerometer measures what the commands ask for.
 *
 * Newtons per motor, seconds. Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_WHERE_PILOTING_H
#define CONTROL_WHERE_PILOTING_H

#include <stdbool.h>
#include <stdint.h>

#include "control/est/effect.h"
#include "control/where/flight_state.h"

typedef enum { THROTTLE_OURS, THROTTLE_PILOT, THROTTLE_UNKNOWN } throttle_t;

typedef struct {
    throttle_t throttle;
    bool given_back;    /* DESCENDING that began in a pilot's hands, without heights */
    float sink_n_per_s; /* rate at which its thrust sinks */
    float vain_s;       /* how long a landing has had too little thrust to fly, and it does not sink */
    effect_t effect;    /* valid while the throttle is unknown; judged in FLOATING and LANDING */
    uint32_t effect_us; /* latest frame in it */
} pilot_state_t;

/* What one cycle shows, after the supervisor's step. */
typedef struct {
    flight_state_t state;
    bool entered;      /* the state began in this cycle */
    bool handed_over;  /* it began because the throttle was given back without heights */
    bool has_throttle; /* by the pin; always true without one */
    bool has_pin;
    float step_s;
    float height_mm, rise_mps;
    float thrust_n, hover_n; /* previous command, sure hover thrust */
    bool felt;               /* accelerations are believed */
    uint32_t frame_us;       /* latest frame */
    float pushed_mps2;       /* acceleration by the delivered thrust as commanded */
    float felt_mps2;         /* by the accelerometer, in that frame */
} pilot_signs_t;

/* What the estimate has to be told. */
typedef enum {
    PILOT_NO_NEWS,
    PILOT_SHOWS_EFFECT, /* the throttle is unknown, and now the commands have an effect */
    PILOT_IS_SURE       /* the throttle is no longer unknown, off the ground */
} pilot_news_t;

/* One cycle. */
pilot_news_t pilot_step(pilot_state_t *pilot, const pilot_signs_t *signs);

/* The throttle is unknown: FLOATING without a pin, a descent that began in a pilot's hands, or a landing that
 * does not sink. */
static inline bool pilot_is_unknown(const pilot_state_t *pilot)
{
    return pilot->throttle == THROTTLE_UNKNOWN;
}

/* It is unknown, and the vehicle shows that the firmware has it. */
static inline bool pilot_shows_effect(const pilot_state_t *pilot)
{
    return pilot_is_unknown(pilot) && pilot->effect.has_effect;
}

/* A landing of a vehicle that a pilot holds up: nothing tells it. */
bool pilot_holds_up(const pilot_state_t *pilot, flight_state_t state);

#endif
