/* When the thrust is held against mirrors and accelerometer, and the reasons of all doubts. What these two
 * tell is the belief's to judge (mirrors.h). These decide nothing: verdict.h does.
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
    VERDICT_NO_EFFECT, /* DOUBT_THRUST: it pushes in vain, and has no effect, more than 99 % */
    VERDICT_COUNT
} verdict_reason_t;

/* What is looked at. */
typedef struct {
    const senses_t *senses;
    const command_t *command;
    const witness_t *felt, *pushed;
    bool felt_valid;   /* the accelerometer's witness counts and is not doubted */
    bool pushed_valid; /* the thrust's witness counts */
} rule_case_t;

/* The case of this height. The pointers are borrowed for as long as it is asked. */
rule_case_t rules_case(const senses_t *senses, const command_t *command, bool felt_valid);

/* The thrust pushes towards the reference, and the heights do not follow. */
bool rules_push_in_vain(const rule_case_t *c);

/* It does, and has no effect, as the belief tells. A gust pushes harder. The thrust was proved before. */
bool rules_against_thrust(const rule_case_t *c);

/* Error of the height by the valid witnesses, mean of both when both are valid. */
float rules_lost_m(const rule_case_t *c);

/* Name of what raised a doubt, with the source that it doubts: "SIGHT/blind"; VERDICT_NONE: "-". */
const char *rules_name(uint16_t reason);

#endif
