/* Who has the throttle? Where nothing tells, the thrust does: a pilot, or somebody who holds the vehicle,
 * makes it push in vain. The source is analytical redundancy, any text on fault detection.
 *
 * What breaks: a limit that is too low doubts the thrust in a gust, and then it may not push against that.
 * The limits have to be above the drift of the witnesses in healthy flights. */
#include "control/sense/rules.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"
#include "control/credible.h"

#define WITH_M 0.20F         /* chosen: less than that counts as agreement */
#define NO_AUTHORITY_M 1.30F /* chosen: wrong hover thrust alone makes this witness drift */
#define MOVED_M 0.30F        /* chosen: above WITH_M, so that the agreement is about a real motion */
#define PUSH_N 0.7F          /* chosen: a tenth of GRAV as delivered, 7 N */
#define PUSHED_M 0.15F       /* chosen: above CONTENT_M; a law pushes for such a distance */

rule_case_t rules_case(const senses_t *senses, const command_t *command, bool felt_valid)
{
    return (rule_case_t){
        .senses = senses,
        .command = command,
        .felt = &senses->accelerometer.felt,
        .pushed = &senses->push.pushed,
        .felt_off_m = accelerometer_off_m(&senses->accelerometer),
        .felt_valid = felt_valid,
        .pushed_valid = witness_counts(&senses->push.pushed),
    };
}

/* The heights contradict the witness of the accelerometer by more than at_least_m. */
static bool felt_against(const rule_case_t *c, float at_least_m)
{
    return c->felt_valid && fabsf(c->felt_off_m) > at_least_m;
}

bool rules_push_in_vain(const rule_case_t *c)
{
    const float push_n = c->senses->push.lagged_n - c->command->hover_n;

    return fabsf(push_n) > PUSH_N && push_n * c->command->wanted_m > 0.0F &&
           c->pushed->seen_m * push_n < 0.0F;
}

bool rules_against_thrust(const rule_case_t *c)
{
    return c->senses->confirmation.proved && !c->senses->effect.has_effect &&
           fabsf(c->command->wanted_m) > PUSHED_M && witness_against(c->pushed, NO_AUTHORITY_M) &&
           c->felt_valid && !felt_against(c, WITH_M) && rules_push_in_vain(c);
}

/* Heights and witnesses agree, over a real motion. */
bool rules_agree(const rule_case_t *c)
{
    const witness_t *mover = c->pushed_valid ? c->pushed : c->felt;

    return !felt_against(c, WITH_M) && !witness_against(c->pushed, WITH_M) && mover->moved_m > MOVED_M;
}

/* Error of the height by the valid witnesses, mean of both when both are valid. */
float rules_lost_m(const rule_case_t *c)
{
    if (c->felt_valid && c->pushed_valid) {
        return 0.5F * (c->felt->seen_m + c->pushed->seen_m);
    }
    return c->pushed_valid ? c->pushed->seen_m : c->felt->seen_m;
}

static const char *const reason_names[] = {
    [VERDICT_NONE] = "-",          [VERDICT_BLIND] = "SIGHT/blind",         [VERDICT_REST] = "IMU/rest",
    [VERDICT_ALONE] = "IMU/alone", [VERDICT_NO_EFFECT] = "THRUST/noeffect",
};
typedef char
    every_reason_has_a_name[(sizeof reason_names / sizeof reason_names[0] == VERDICT_COUNT) ? 1 : -1];

const char *rules_name(uint16_t reason)
{
    return reason_names[reason];
}
