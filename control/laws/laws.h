/* The laws behind one interface: each has a file, and one row in table.h.
 *
 * A law gives a thrust in each cycle. Between two heights it may hold the one before. Newtons per motor.
 * Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_LAWS_LAWS_H
#define CONTROL_LAWS_LAWS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/est/est_law.h"
#include "control/laws/descent.h"
#include "control/laws/pid.h"
#include "control/laws/pidt.h"
#include "control/laws/table.h"
#include "control/situation.h"

typedef struct {
    pid_state_t pid;
    bool integral; /* the law had an integral action in its previous sample */
    pidt_state_t pidt;
    bool floated;          /* the state of the cycle before was FLOATING: the thrust stayed near hover */
    float gravity_n;       /* GRAV of the previous cycle */
    uint32_t pidt_rays_us; /* rays of the height before, law PIDT */
    descent_t descent;
    float blind_ahead_s; /* by which a blind descent is ahead of its time */
    float setpoint_n;    /* thrust that the mode computes */
    float transfer_n;    /* added to setpoint_n; fades to 0: bumpless transfer between modes */
} laws_t;

/* One law. Returns the setpoint. est: the state of law EST. */
typedef float (*law_step_t)(laws_t *laws, est_law_t *est, const situation_t *now);

/* Initial values, when the mode has changed. The law keeps its integral action only during COASTING. */
void laws_change(laws_t *laws, const situation_t *now);

/* The thrust of the mode. Where heights or reference were lost before the vehicle left the ground, it ramps
 * down.
 *
 * Bumpless transfer: a mode that takes over in the air starts from the previous thrust, limited to 0.5 N from
 * hover. The difference then fades with a time constant of 0.4 s. Two exceptions start at once: a descent
 * with a height, and the law on the ground. A change of the law alone starts exactly from the previous
 * thrust. law_changed: it has changed in this cycle. */
float laws_step(laws_t *laws, est_law_t *est, const situation_t *now, bool law_changed);

/* What the latest descent by heights has needed on top of the hover thrust. */
static inline float laws_found_n(const laws_t *laws)
{
    return laws->descent.trim_n;
}

/* Events that release the next cycle, FLIGHT_RELEASE_*: the law's row says. While the estimator flies, with
 * every law each height and each IMU frame. */
uint16_t laws_releases(const parameters_t *parameters, flight_mode_t mode);

/* The steps of the laws, of the form law_step_t: by their rows. */
#define LAW_STEP(name, step, cycles) float step(laws_t *laws, est_law_t *est, const situation_t *now);
LAWS(LAW_STEP)
#undef LAW_STEP

/* Those of the modes, for laws.c. */
float law_est_land(laws_t *laws, est_law_t *est, const situation_t *now);
float law_est_sink(laws_t *laws, est_law_t *est, const situation_t *now);
float law_hover_step(laws_t *laws, est_law_t *est, const situation_t *now);
float law_descent_step(laws_t *laws, est_law_t *est, const situation_t *now);
float law_blind_step(laws_t *laws, est_law_t *est, const situation_t *now);

#endif
