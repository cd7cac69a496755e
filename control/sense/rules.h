/* The rules by which a source contradicts the two others, each with a name. They decide nothing: verdict.h
 * does.
 *
 * Metres, seconds, newtons per motor. Pure; the caller owns the state, all zero at first. Context: one Task.
 */
#ifndef CONTROL_SENSE_RULES_H
#define CONTROL_SENSE_RULES_H

#include <stdbool.h>
#include <stdint.h>

#include "control/facts.h"
#include "control/sense/senses.h"

/* The rule that raised a doubt. */
typedef enum {
    VERDICT_NONE,
    /* DOUBT_SIGHT */
    VERDICT_BLIND,    /* every mirror lies, more than 99 % */
    VERDICT_STIFF,    /* the tilt sways, and the slant does not change */
    VERDICT_WHITE,    /* the tilt sways, and the slant contains only white noise for long */
    VERDICT_SUNK,     /* heights below the ground while the law wants to climb */
    VERDICT_ALOFT,    /* the law takes it to stand, but it sways or has climbed as in the air */
    VERDICT_UNSEEN,   /* both witnesses climb, and the heights have stopped */
    VERDICT_STILL,    /* the witnesses predict a motion, and the slant is still */
    VERDICT_UNPROVED, /* the first climb after the ground shows in the accelerometer only */
    VERDICT_NO_CLIMB, /* since a step towards the vehicle the thrust has pushed, and no climb has shown */
    /* DOUBT_IMU */
    VERDICT_REST,  /* at rest it does not measure g */
    VERDICT_ALONE, /* the accelerometer contradicts heights and thrust */
    VERDICT_MOVED, /* heights that move are right against both */
    /* DOUBT_THRUST */
    VERDICT_NO_EFFECT, /* the thrust pushes in vain, and the accelerometer agrees with the heights */
    VERDICT_COUNT
} verdict_reason_t;

/* What takes time to show. */
typedef struct {
    float felt_least_m;   /* smallest sum of the accelerometer's innovations while unconfirmed, <= 0 */
    float swaying_s;      /* how long the tilt has swayed and the slant not, while standing */
    float swaying_from_m; /* height at its start */
} rules_t;

/* What a rule looks at. */
typedef struct {
    const rules_t *rules;
    const senses_t *senses;
    const command_t *command;
    const witness_t *felt, *pushed;
    float felt_off_m;  /* sum of the accelerometer's innovations, less when it is noisy */
    bool felt_valid;   /* the accelerometer's witness counts and is not doubted */
    bool pushed_valid; /* the thrust's witness counts */
} rule_case_t;

/* Once per height, before the rules are asked. gap_s: time since the height before. */
void rules_watch(rules_t *rules, const senses_t *senses, const command_t *command, float gap_s);

/* The case of this height. The pointers are borrowed for as long as it is asked. */
rule_case_t rules_case(const rules_t *rules, const senses_t *senses, const command_t *command,
                       bool felt_valid);

/* The first rule that applies, or VERDICT_NONE. */
verdict_reason_t rules_against_sight(const rule_case_t *c);
verdict_reason_t rules_against_imu(const rule_case_t *c);
verdict_reason_t rules_against_thrust(const rule_case_t *c);

/* Heights and witnesses agree, over a real motion. */
bool rules_agree(const rule_case_t *c);

/* Error of the height by the valid witnesses, mean of both when both are valid. */
float rules_lost_m(const rule_case_t *c);

/* Name of a rule, with the source that it doubts: "SIGHT/unseen"; VERDICT_NONE: "-". */
const char *rules_name(uint16_t reason);

#endif
