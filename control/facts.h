/* What the rooms of control/ tell each other: evidence_t says what the sensors show, command_t what the
 * vehicle was told to do. Each has one maker; everybody else gets it as const.
 *
 * Metres, seconds, newtons per motor, radians; positive is upwards. */
#ifndef CONTROL_FACTS_H
#define CONTROL_FACTS_H

#include <stdbool.h>
#include <stdint.h>

/* Bits of evidence_t.doubts. */
#define DOUBT_SIGHT 1U
#define DOUBT_IMU 2U
#define DOUBT_THRUST 4U

/* By the belief about the mirrors. */
typedef struct {
    bool agree;       /* two or more do not lie, with 99 % */
    bool no_effect;   /* the thrust has none, with 99 % */
    bool suspected;   /* all may lie, with more than 1 % */
    uint16_t doubted; /* bits: they are disbelieved */
    uint16_t liars;   /* bits: those for which that lasts, see mirrors_liars() */
} mirrors_told_t;

/* What the heights have not shown yet. */
typedef struct {
    bool climb; /* after a take-off or a step of the terrain towards the vehicle, until they show one: the
                 * beam may be blocked, keep climbs slow */
    bool first_climb; /* none has shown since the ground */
    bool descent;     /* after a step of more than 0.4 m away from the vehicle, until they show one: they may
                       * be wrong, keep descents slow */
} unshown_t;

/* When DOUBT_THRUST rose. */
typedef struct {
    float hover_n;
    bool down; /* the law wanted to descend */
} held_t;

/* What the sensors show, in the present cycle. Made by sense/. */
typedef struct {
    uint16_t doubts; /* DOUBT_* */
    uint16_t reason; /* what raised the latest doubt, verdict_reason_t of sense/verdict.h; 0: none */
    unshown_t unshown;
    bool teaches;   /* false: learn nothing from the heights: they are unconfirmed */
    bool sways;     /* roll and pitch sway as in the air */
    bool calm;      /* they sway as on the ground; between the two neither is certain */
    bool rocks;     /* the tilt has moved by a degree within the last 0.8 s */
    bool in_hands;  /* state GROUND without heights: a pilot flies it, or somebody holds it */
    bool may_stand; /* calm for so long that it may stand on the ground: lower the thrust to find out */
    bool stands;    /* too little thrust to fly, no felt fall, and calm: it stands on the ground */
    float upright;  /* cosine of the believed tilt */
    mirrors_told_t mirrors;
    float height_m;       /* latest height that was no copy and within range, believed or not */
    bool stepped;         /* no witness explains it: a step of the terrain, or of what blocks the mirrors */
    float rise_mps;       /* low-passed rate of the heights, without steps */
    float blind_height_m; /* when DOUBT_SIGHT rose: without what the mirrors have shown since they lie */
    float felt_mps;       /* speed of the accelerometer's witness, whatever it is worth */
    bool felt_valid;      /* that witness counts, and is not doubted */
    float shaken;         /* >= 1: a noisy accelerometer's speed counts so much less */
    float bias_mps2;      /* of the accelerometer */
    float push_mps;       /* speed of the thrust's witness, whatever it is worth */
    float pushed_mps; /* the same less the error that the heights have shown; else the rate of the heights */
    float moved_m;    /* way since the rays of the latest height, by the thrust */
    float speed_mps;  /* without the heights: by the accelerometer that is not doubted, and the thrust */
    held_t held;
} evidence_t;

/* What the vehicle was told to do in the previous cycle, and what that should cause. Made by flight.c. */
typedef struct {
    float step_s;    /* time since the previous cycle */
    bool grounded;   /* state GROUND: on the ground without thrust */
    bool standing;   /* take-off commanded; the vehicle has not left the ground, as far as is known */
    bool off_ground; /* only its own thrust carries the vehicle: the witness of the thrust is valid */
    bool ours;       /* false: the pilot has the throttle, in this cycle */
    bool ordered;    /* a new #SETR in this cycle; on the ground it clears DOUBT_SIGHT and DOUBT_THRUST */
    float thrust_n;  /* commanded thrust, less the dead band */
    float authority_mps2_per_n, damping_per_s; /* vehicle model, as in cascade.h */
    float lag_s;                               /* of the thrust: dead time and motors as one lag, > 0 */
    float hover_n;                             /* sure hover thrust, where/hover_thrust.h */
    float wanted_m;   /* reference minus height, > 0: the law wants to climb; NAN: no height is held */
    float noise_mps2; /* rms noise of the accelerometer, measured by the estimator */
} command_t;

/* True when at least one of the given DOUBT_* bits is set. */
static inline bool doubts(const evidence_t *evidence, uint16_t doubt)
{
    return (evidence->doubts & doubt) != 0U;
}

/* Vertical speed by the accelerometer, less when it is noisy; 0 while it is not valid. */
static inline float felt_mps(const evidence_t *evidence)
{
    return evidence->felt_valid ? evidence->felt_mps / evidence->shaken : 0.0F;
}

#endif
