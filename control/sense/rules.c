/* Consistency check of heights, accelerometer and thrust; the source is analytical redundancy, any text on
 * fault detection; PX4's EKF2 has a simpler kinematic consistency check of its range finder.
 *
 * What breaks: a limit that is too low doubts a healthy sensor in a gust, and the vehicle then descends. A
 * limit that is too high lets a wrong sensor move the vehicle by that much. The limits have to be above the
 * drift of the witnesses in healthy flights. Unless a comment says otherwise they are chosen; `make campaign
 * ARGS=--faults` flies them against faults. */
#include "control/sense/rules.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"
#include "control/credible.h"

/* A lift-off that the heights do not show. */
#define RIGID_SCANS 2U     /* one scan alone may be chance */
#define STRONG_SHARE 1.3F  /* chosen: of GRAV; lifts the heaviest vehicle, 1.2 of GRAV, at 0.8 m/s2 */
#define STRONG_COUNTS 3.0F /* chosen: then half a second is enough, which lifts it by 0.1 m */

#define AGAINST_M 0.50F      /* chosen: five times WITNESS_STEP_M */
#define BOTH_M 0.28F         /* chosen: about half of AGAINST_M, for the second witness */
#define WITH_M 0.20F         /* chosen: less than that counts as agreement */
#define ALONE_M 0.60F        /* chosen: above AGAINST_M, because only one witness contradicts */
#define NO_AUTHORITY_M 1.30F /* chosen: twice ALONE_M; wrong hover thrust alone makes this witness drift */
#define MOVED_M 0.30F        /* chosen: above BOTH_M, so that the agreement is about a real motion */
#define PUSH_N 0.7F          /* chosen: a tenth of GRAV as delivered, 7 N */
#define PUSHED_M 0.15F       /* chosen: above CONTENT_M; a law pushes for such a distance */
#define NOISE_SCANS 19U      /* tried: at 16 one of 40 healthy flights in FLOATING was doubted */
#define FLAT_FELT_M (0.5F * BOTH_M) /* the thrust must then show AGAINST_M */
#define FLAT_SCANS 6U       /* tried: without it 1 of 100 healthy flights of climb rates was doubted */
#define UNSEEN_MPS 0.6F     /* tried: no healthy flight of 1800; at 0.5 two are doubted */
#define UNSEEN_FELT_M 0.25F /* tried: with 0.20 no healthy flight of 1800, with 0.15 two */
#define UNMOVED_MPS 0.2F    /* chosen: heights that change more slowly do not move */
#define UNSHOWN_M 0.35F     /* chosen: above BOTH_M; a climb that no height has shown is slow meanwhile */
#define UNSHOWN_N 0.2F      /* chosen: a small part of PUSH_N, because that climb is slow */

rule_case_t rules_case(const rules_t *rules, const senses_t *senses, const command_t *command,
                       bool felt_valid)
{
    return (rule_case_t){
        .rules = rules,
        .senses = senses,
        .command = command,
        .felt = &senses->accelerometer.felt,
        .pushed = &senses->push.pushed,
        .felt_off_m = accelerometer_off_m(&senses->accelerometer),
        .felt_valid = felt_valid,
        .pushed_valid = witness_counts(&senses->push.pushed),
    };
}

/* ---- what several rules ask */

/* The heights contradict the witness of the accelerometer by more than at_least_m. */
static bool felt_against(const rule_case_t *c, float at_least_m)
{
    return c->felt_valid && fabsf(c->felt_off_m) > at_least_m;
}

static bool heights_rest(const rule_case_t *c)
{
    return fabsf(c->senses->heights.rise_mps) < UNMOVED_MPS;
}

/* The thrust pushes towards the reference by more than least_n, and the heights do not follow. */
static bool pushes_in_vain(const senses_t *senses, const command_t *command, float least_n)
{
    const float push_n = senses->push.lagged_n - command->hover_n;

    return fabsf(push_n) > least_n && push_n * command->wanted_m > 0.0F &&
           senses->push.pushed.seen_m * push_n < 0.0F;
}

/* Both witnesses contradict the heights in the same direction. */
static bool both_against(const rule_case_t *c)
{
    return felt_against(c, AGAINST_M) && witness_against(c->pushed, BOTH_M) &&
           c->felt_off_m * c->pushed->seen_m > 0.0F;
}

/* ---- rules of DOUBT_SIGHT */

static bool is_blind(const rule_case_t *c)
{
    return c->senses->mirrors.blind;
}

static bool is_stiff(const rule_case_t *c)
{
    return c->senses->beam.rigid == BEAM_STILL_SCANS && sway_as_in_the_air(&c->senses->sway);
}

static bool is_white(const rule_case_t *c)
{
    return c->senses->beam.white == BEAM_WHITE_SCANS;
}

static bool is_sunk(const rule_case_t *c)
{
    return c->senses->confirmation.sunk == CONFIRMATION_SUNK;
}

/* The law takes the vehicle to be on the ground still. But the tilt sways as in the air, for long; or the
 * beam is still or its height above the ground, and the accelerometer has measured a climb. */
static bool is_aloft(const rule_case_t *c)
{
    const senses_t *s = c->senses;
    const bool odd = s->beam.rigid >= RIGID_SCANS || (s->heights.height_m > LOW_M && beam_is_still(&s->beam));

    return c->rules->swaying_s > SWAY_TIME_S ||
           (c->command->standing && s->confirmation.unconfirmed && odd && sway_as_in_the_air(&s->sway) &&
            c->rules->felt_least_m < -LOW_M);
}

/* A beam may be blocked during a climb, so this does not wait until heights_moved() is over. slower_mps lags
 * like rise_mps: a vehicle that has just turned upwards is not doubted. */
static bool is_unseen(const rule_case_t *c)
{
    return c->senses->slower_mps - c->senses->heights.rise_mps > UNSEEN_MPS &&
           c->pushed->seen_m < -WITNESS_STEP_M && c->felt_valid && c->pushed_valid &&
           c->felt_off_m < -UNSEEN_FELT_M && heights_rest(c);
}

/* The slant has changed by noise alone, or stayed, and the witnesses tell a motion. So a blocked beam is
 * found that shows about the reference, where no law pushes. The stiller the slant, the less of a motion. */
static bool is_still(const rule_case_t *c)
{
    const beam_t *beam = &c->senses->beam;
    const bool same_side = c->felt->seen_m * c->pushed->seen_m > 0.0F;
    const bool flat = beam->flat && beam->white >= FLAT_SCANS && felt_against(c, FLAT_FELT_M) &&
                      witness_against(c->pushed, AGAINST_M);
    const bool rigid = beam->rigid >= RIGID_SCANS && felt_against(c, WITNESS_STEP_M) &&
                       witness_against(c->pushed, WITNESS_STEP_M);
    const bool noise = beam->white >= NOISE_SCANS && witness_against(c->pushed, BOTH_M);

    return ((flat || rigid) && same_side) || (noise && (!c->felt_valid || same_side));
}

/* It is believed, because it measured g at rest a moment ago. The thrust does not help: the hover thrust is
 * not known yet. */
static bool is_unproved(const rule_case_t *c)
{
    return confirmation_is_first(&c->senses->confirmation) && c->felt_valid && c->felt_off_m < -UNSHOWN_M;
}

static bool is_no_climb(const rule_case_t *c)
{
    return c->pushed_valid && c->senses->confirmation.unconfirmed && c->pushed->running_s >= WITNESS_OLD_S &&
           fabsf(c->pushed->seen_m) > UNSHOWN_M && pushes_in_vain(c->senses, c->command, UNSHOWN_N);
}

/* When a rule is asked. */
typedef enum {
    ALWAYS,
    UNMOVED /* the heights have not moved lately */
} when_t;

static const struct {
    verdict_reason_t reason;
    when_t when;
    bool (*is)(const rule_case_t *c);
} sight_rules[] = {
    {VERDICT_BLIND, ALWAYS, is_blind},        {VERDICT_STIFF, ALWAYS, is_stiff},
    {VERDICT_WHITE, ALWAYS, is_white},        {VERDICT_SUNK, ALWAYS, is_sunk},
    {VERDICT_ALOFT, ALWAYS, is_aloft},        {VERDICT_UNSEEN, ALWAYS, is_unseen},
    {VERDICT_STILL, UNMOVED, is_still},       {VERDICT_UNPROVED, UNMOVED, is_unproved},
    {VERDICT_NO_CLIMB, UNMOVED, is_no_climb},
};

/* The first rule that applies. */
verdict_reason_t rules_against_sight(const rule_case_t *c)
{
    const bool moved = heights_moved(&c->senses->heights);

    for (uint16_t k = 0U; k < sizeof sight_rules / sizeof sight_rules[0]; ++k) {
        if ((sight_rules[k].when == ALWAYS || !moved) && sight_rules[k].is(c)) {
            return sight_rules[k].reason;
        }
    }
    return VERDICT_NONE;
}

/* ---- rules of the other doubts */

/* The hover thrust may have been learned from a wrong accelerometer. Then both witnesses have the same error,
 * and heights that move are right against both. */
verdict_reason_t rules_against_imu(const rule_case_t *c)
{
    if (c->senses->mirrors.felt_lies) {
        return VERDICT_ALONE;
    }
#ifndef OLD
#define OLD 1
#endif
    if (OLD == 0) { return VERDICT_NONE; }
    if (beam_is_still(&c->senses->beam)) {
        return VERDICT_NONE;
    }
    if (both_against(c)) {
        return heights_move(&c->senses->heights) ? VERDICT_MOVED : VERDICT_NONE;
    }
    return (c->pushed_valid && felt_against(c, ALONE_M)) ? VERDICT_ALONE : VERDICT_NONE;
}

verdict_reason_t rules_against_thrust(const rule_case_t *c)
{
    const bool vain = c->senses->confirmation.proved && fabsf(c->command->wanted_m) > PUSHED_M &&
                      witness_against(c->pushed, NO_AUTHORITY_M) && c->felt_valid &&
                      !felt_against(c, WITH_M) && pushes_in_vain(c->senses, c->command, PUSH_N);

    return vain ? VERDICT_NO_EFFECT : VERDICT_NONE;
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

/* ---- what takes time */

/* How long the tilt has swayed as in the air, and the beam has shown nothing of it. */
static void watch_lift_off(rules_t *rules, const senses_t *senses, const command_t *command, float gap_s)
{
    if (!command->standing) {
        rules->swaying_s = 0.0F;
        return;
    }
    const float height_m = senses->heights.height_m;
    const bool strong = senses->push.lagged_n >
                        STRONG_SHARE * command->hover_n; /* no vehicle stays on the ground */
    const bool sways = senses->confirmation.unconfirmed && sway_as_in_the_air(&senses->sway) &&
                       (strong || beam_is_still(&senses->beam));

    if (!sways || fabsf(height_m - rules->swaying_from_m) > HEIGHT_NO_NOISE_M) {
        rules->swaying_s = 0.0F;
        rules->swaying_from_m = height_m;
    } else {
        rules->swaying_s += strong ? STRONG_COUNTS * gap_s : gap_s;
    }
}

void rules_watch(rules_t *rules, const senses_t *senses, const command_t *command, float gap_s)
{
    const float off_m = accelerometer_off_m(&senses->accelerometer);

    rules->felt_least_m = senses->confirmation.unconfirmed ? at_most(rules->felt_least_m, off_m) : 0.0F;
    watch_lift_off(rules, senses, command, gap_s);
}

static const char *const reason_names[] = {
    [VERDICT_NONE] = "-",
    [VERDICT_BLIND] = "SIGHT/blind",
    [VERDICT_STIFF] = "SIGHT/stiff",
    [VERDICT_WHITE] = "SIGHT/white",
    [VERDICT_SUNK] = "SIGHT/sunk",
    [VERDICT_ALOFT] = "SIGHT/aloft",
    [VERDICT_UNSEEN] = "SIGHT/unseen",
    [VERDICT_STILL] = "SIGHT/still",
    [VERDICT_UNPROVED] = "SIGHT/unproved",
    [VERDICT_NO_CLIMB] = "SIGHT/noclimb",
    [VERDICT_REST] = "IMU/rest",
    [VERDICT_ALONE] = "IMU/alone",
    [VERDICT_MOVED] = "IMU/moved",
    [VERDICT_NO_EFFECT] = "THRUST/noeffect",
};
typedef char
    every_reason_has_a_name[(sizeof reason_names / sizeof reason_names[0] == VERDICT_COUNT) ? 1 : -1];

const char *rules_name(uint16_t reason)
{
    return reason_names[reason];
}
