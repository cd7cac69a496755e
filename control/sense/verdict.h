/* Who is believed: today's rules, each with a name. A source is doubted when it contradicts the two others:
 *
 *   the heights contradict both others          DOUBT_SIGHT: treat the heights as lost
 *   the accelerometer contradicts both others   DOUBT_IMU: fly without accelerations
 *   the thrust contradicts both others          DOUBT_THRUST: a pilot flies, or something holds the vehicle;
 *                                               the thrust stays near the last known hover thrust
 *
 * Metres, seconds, newtons per motor. Pure; the caller owns the state, all zero at first. Context: one
 * Task. */
#ifndef CONTROL_SENSE_VERDICT_H
#define CONTROL_SENSE_VERDICT_H

#include <stdbool.h>
#include <stdint.h>

#include "control/facts.h"
#include "control/sense/senses.h"

/* The rule that raised a doubt. */
typedef enum {
    VERDICT_NONE,
    /* DOUBT_SIGHT */
    VERDICT_STEPS,    /* the height makes steps for most of the time */
    VERDICT_STIFF,    /* the tilt sways, and the slant does not change */
    VERDICT_WHITE,    /* the tilt sways, and the slant contains only white noise for long */
    VERDICT_SUNK,     /* heights below the ground while the law wants to climb */
    VERDICT_ALOFT,    /* the law takes it to stand, but it sways or has climbed as in the air */
    VERDICT_UNSEEN,   /* both witnesses climb, and the heights have stopped */
    VERDICT_STILL,    /* the witnesses predict a motion, and the slant is still */
    VERDICT_UNPROVED, /* the first climb after the ground shows in the accelerometer only */
    VERDICT_RUNAWAY,  /* both witnesses have a fast climb or fall, and the heights do not move */
    VERDICT_NO_CLIMB, /* since a step towards the vehicle the thrust has pushed, and no climb has shown */
    VERDICT_BOTH,     /* both witnesses contradict the heights in the same direction */
    VERDICT_VAIN,     /* the law has pushed for long, and no height moved */
    VERDICT_FELT,     /* the accelerometer alone contradicts them; nothing else tells */
    /* DOUBT_IMU */
    VERDICT_REST,  /* at rest it does not measure g */
    VERDICT_ALONE, /* the accelerometer contradicts heights and thrust */
    VERDICT_MOVED, /* heights that move are right against both */
    /* DOUBT_THRUST */
    VERDICT_NO_EFFECT, /* the thrust pushes in vain, and the accelerometer agrees with the heights */
    VERDICT_COUNT
} verdict_reason_t;

#define VERDICT_DOUBTS 3U /* SIGHT, IMU, THRUST */

typedef struct {
    uint16_t doubts; /* DOUBT_* */
    verdict_reason_t
        reasons[VERDICT_DOUBTS]; /* of the doubts SIGHT, IMU, THRUST; VERDICT_NONE: not doubted */
    float felt_least_m;          /* smallest sum of the accelerometer's innovations while unconfirmed, <= 0 */
    float swaying_s;             /* how long the tilt has swayed and the slant not, while standing */
    float swaying_from_m;        /* height at its start */
    float vain_s;                /* how long the law has pushed while no height moved */
    float lost_m;                /* error of the height when DOUBT_SIGHT rose: measured minus predicted */
    float agreed_s;              /* how long heights and witnesses have agreed during a doubt */
    float held_n;                /* hover thrust when DOUBT_THRUST rose */
    bool held_down;              /* the law wanted to descend at that instant */
} verdict_t;

/* After the frames of a cycle: an accelerometer that does not measure g at rest is doubted. */
void verdict_rest(verdict_t *verdict, const accelerometer_t *accelerometer);

/* A new #SETR on the ground clears DOUBT_SIGHT and DOUBT_THRUST. */
void verdict_order(verdict_t *verdict, senses_t *senses);

/* One verdict per height, after senses_height(): a new doubt, or the end of one. Nothing is judged while
 * command->grounded is true or the pilot has the throttle. A doubt clears sums of *senses. */
void verdict_height(verdict_t *verdict, senses_t *senses, const command_t *command,
                    const height_change_t *change);

/* The accelerometer's witness is valid and its source is not in doubt. */
bool verdict_felt_valid(const verdict_t *verdict, const senses_t *senses);

/* Accelerometer and rate of the heights differ by more than 0.5 m/s. */
bool verdict_apart(const verdict_t *verdict, const senses_t *senses);

/* Vertical speed without the heights: the mean of both witnesses, or the one that is valid and not doubted; 0
 * when there is none. */
float verdict_speed_mps(const verdict_t *verdict, const senses_t *senses);

/* Rule of the doubt that verdict_doubt_name() names; VERDICT_NONE: no doubt. */
verdict_reason_t verdict_reason(const verdict_t *verdict);

/* Name for the telemetry: "SIGHT", "IMU" or "THRUST", of several the first in this order; NULL: no doubt. */
const char *verdict_doubt_name(uint16_t doubts);

/* Name of a rule, lower case: "unseen"; VERDICT_NONE: "-". */
const char *verdict_reason_name(uint16_t reason);

#endif
