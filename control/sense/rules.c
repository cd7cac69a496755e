/* Who has the throttle? Where nothing tells, the thrust does: a pilot, or somebody who holds the vehicle,
 * makes it push in vain. That it has no effect the belief tells, scan by scan (belief_world.c).
 *
 * What breaks: a thrust that is doubted in a gust may not push against that. */
#include "control/sense/rules.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"
#include "control/credible.h"

#define PUSH_N 0.7F /* chosen: a tenth of GRAV as delivered, 7 N */

rule_case_t rules_case(const senses_t *senses, const command_t *command, bool felt_valid)
{
    return (rule_case_t){
        .senses = senses,
        .command = command,
        .felt = &senses->accelerometer.felt,
        .pushed = &senses->push.pushed,
        .felt_valid = felt_valid,
        .pushed_valid = witness_counts(&senses->push.pushed),
    };
}

bool rules_push_in_vain(const rule_case_t *c)
{
    const float push_n = c->senses->push.lagged_n - c->command->hover_n;

    return fabsf(push_n) > PUSH_N && push_n * c->command->wanted_m > 0.0F &&
           c->pushed->seen_m * push_n < 0.0F;
}

bool rules_against_thrust(const rule_case_t *c)
{
    return c->senses->confirmation.proved && c->senses->mirrors.unpushed && rules_push_in_vain(c);
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
