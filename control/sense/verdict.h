/* Who is believed. A source is doubted when it contradicts the two others:
 *
 *   the heights contradict both others          DOUBT_SIGHT: treat the heights as lost
 *   the accelerometer contradicts both others   DOUBT_IMU: fly without accelerations
 *   the thrust contradicts both others          DOUBT_THRUST: a pilot flies, or something holds the vehicle;
 *                                               the thrust stays near the last known hover thrust
 *
 * The belief tells which of them contradicts (mirrors.h).
 *
 * Metres, seconds, newtons per motor. Pure; the caller owns the state, all zero at first. Context: one
 * Task. */
#ifndef CONTROL_SENSE_VERDICT_H
#define CONTROL_SENSE_VERDICT_H

#include <stdbool.h>
#include <stdint.h>

#include "control/facts.h"
#include "control/sense/senses.h"

/* What raised a doubt. */
typedef enum {
    VERDICT_NONE,
    VERDICT_BLIND,     /* DOUBT_SIGHT: every mirror lies, more than 99 % */
    VERDICT_REST,      /* DOUBT_IMU: at rest the accelerometer does not measure g */
    VERDICT_ALONE,     /* DOUBT_IMU: it lies, more than 99 %, or no bias explains it */
    VERDICT_NO_EFFECT, /* DOUBT_THRUST: it pushes in vain, and has no effect, more than 99 % */
    VERDICT_COUNT
} verdict_reason_t;

typedef struct {
    uint16_t doubts;          /* DOUBT_* */
    verdict_reason_t why_imu; /* of DOUBT_IMU, while there is one */
    float blind_height_m;     /* height when DOUBT_SIGHT rose, by the worlds in which all mirrors lie */
    float contrary_s; /* time of scans against the present verdict on the thrust, less that of the others */
    float sure_n;     /* hover thrust when the thrust last did not push in vain */
    float held_n;     /* the same, when DOUBT_THRUST rose */
    bool held_down;   /* the law wanted to descend at that instant */
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

/* Reason of the first doubt, in the order SIGHT, IMU, THRUST; VERDICT_NONE: no doubt. */
verdict_reason_t verdict_reason(const verdict_t *verdict);

/* Its name, with the source that is doubted: "SIGHT/blind"; VERDICT_NONE: "-". reason: a verdict_reason_t. */
const char *verdict_name(uint16_t reason);

#endif
