/* When a source contradicts the others, and when it agrees again. What mirrors and accelerometer tell is the
 * belief's to judge (mirrors.h); the thrust is held against both. These decide nothing: verdict.h does.
 *
 * Metres, seconds, newtons per motor. Pure and without state. Context: one Task. */
#ifndef CONTROL_SENSE_RULES_H
#define CONTROL_SENSE_RULES_H

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
    VERDICT_NO_EFFECT, /* DOUBT_THRUST: it pushes in vain, and the accelerometer agrees with the heights */
    VERDICT_COUNT
} verdict_reason_t;

/* What is looked at. */
typedef struct {
    const senses_t *senses;
    const command_t *command;
    const witness_t *felt, *pushed;
    float felt_off_m;  /* sum of the accelerometer's innovations, less when it is noisy */
    bool felt_valid;   /* the accelerometer's witness counts and is not doubted */
    bool pushed_valid; /* the thrust's witness counts */
} rule_case_t;

/* The case of this height. The pointers are borrowed for as long as it is asked. */
rule_case_t rules_case(const senses_t *senses, const command_t *command, bool felt_valid);

/* The thrust pushes towards the reference, and the heights do not follow. */
bool rules_push_in_vain(const rule_case_t *c);

/* It has done so for long, its changes have no effect either, and the accelerometer agrees with the heights.
 * Else a gust pushes harder. */
bool rules_against_thrust(const rule_case_t *c);

/* Heights and witnesses agree, over a real motion. */
bool rules_agree(const rule_case_t *c);

/* Error of the height by the valid witnesses, mean of both when both are valid. */
float rules_lost_m(const rule_case_t *c);

/* Name of what raised a doubt, with the source that it doubts: "SIGHT/blind"; VERDICT_NONE: "-". */
const char *rules_name(uint16_t reason);

#endif
