/* Consistency check of heights, accelerometer and thrust; the source is analytical redundancy, any text on
 * fault detection; PX4's EKF2 has a simpler kinematic consistency check of its range finder.
 *
 * What breaks: a limit that is too low doubts a healthy sensor in a gust, and the vehicle then descends. A
 * limit that is too high lets a wrong sensor move the vehicle by that much. The limits have to be above the
 * drift of the witnesses in healthy flights. Unless a comment says otherwise they are chosen; `make campaign
 * ARGS=--faults` flies them against faults. */
#include "control/sense/verdict.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"
#include "control/credible.h"

/* A still slant, see also beam.c. */
#define RIGID_SCANS 2U     /* chosen: one scan alone may be chance */
#define NOISE_SCANS 19U    /* tried: at 16 one of 40 healthy flights in FLOATING was doubted */
#define STILL_BOTH_M 0.10F /* chosen: low, because the still slant is evidence too */
#define FLAT_FELT_M 0.15F  /* chosen: half of BOTH_M; the thrust must then show AGAINST_M */
#define FLAT_SCANS 6U      /* tried: without it 1 of 100 healthy flights of climb rates was doubted */
#define STILL_FELT_M 0.05F /* chosen: half of that; the thrust must then show BOTH_M */

/* A lift-off that the heights do not show. */
#define SWAYING_S 1.5F     /* chosen: 15 scans; a lift-off that the heights see takes less than a second */
#define STRONG_SHARE 1.3F  /* chosen: of GRAV; lifts the heaviest vehicle, 1.2 of GRAV, at 0.8 m/s2 */
#define STRONG_COUNTS 3.0F /* chosen: then half a second is enough, which lifts it by 0.1 m */
#define SWAYING_M 0.05F    /* chosen: ten times the noise of a height */
#define ALOFT_M 0.08F      /* chosen: as LOW_M */

#define AGAINST_M 0.50F      /* chosen: five times WITNESS_STEP_M */
#define BOTH_M 0.28F         /* chosen: about half of AGAINST_M, for the second witness */
#define WITH_M 0.20F         /* chosen: less than that counts as agreement */
#define ALONE_M 0.60F        /* chosen: above AGAINST_M, because only one witness contradicts */
#define ALONE_SHARE 0.4F     /* chosen: with the damping wrong, the thrust still shows half of a motion */
#define NO_AUTHORITY_M 1.30F /* chosen: twice ALONE_M; wrong hover thrust alone makes this witness drift */
#define MOVED_M 0.30F        /* chosen: above BOTH_M, so that the agreement is about a real motion */
#define AGREED_S 1.5F        /* chosen: 15 scans */
#define PUSH_N 0.7F          /* chosen: a tenth of GRAV as delivered, 7 N */
#define VAIN_S 3.0F          /* chosen: twice AGREED_S, because only one witness is left */
#define VAIN_MPS 0.12F       /* chosen: below LAND_MPS in est_law.c, 0.15 m/s */
#define VAIN_M 0.15F         /* chosen: above CONTENT_M */
#define RUN_AWAY_MPS 0.7F    /* chosen: above the speed of unconfirmed climbs, 0.35 and 0.6 m/s */
#define RUN_AWAY_M 0.38F     /* chosen: between BOTH_M and AGAINST_M */
#define APART_MPS 0.5F       /* chosen: about as much as the heights lag behind at a lift-off */
#define UNSEEN_MPS 0.6F      /* tried: no healthy flight of 1800; at 0.5 two are doubted */
#define UNSEEN_FELT_M 0.25F  /* tried: with 0.20 no healthy flight of 1800, with 0.15 two */
#define UNSEEN_PUSHED_M 0.1F /* chosen: less than UNSEEN_FELT_M, its hover thrust has just been learned */
#define UNMOVED_MPS 0.2F     /* chosen: heights that change more slowly do not move */
#define CONTENT_M 0.10F      /* chosen: a law so near its reference is not misled by a wrong height */
#define CONTENT_SHARE 1.8F   /* chosen: near the reference the limits nearly double */
#define ALIVE_SHARE 1.4F     /* tried: 1.8 helps no more; a slant that changes with the tilt is not blocked */
#define UNCONFIRMED_M 0.35F  /* chosen: above BOTH_M; the climb is slow meanwhile */
#define UNPROVED_M 0.35F     /* chosen: twice what the lift-off of a drawn vehicle shows */
#define UNCONFIRMED_N 0.2F   /* chosen: a small part of PUSH_N, because the climb is slow */

/* What a rule looks at. */
typedef struct {
    const verdict_t *verdict;
    const senses_t *senses;
    const command_t *command;
    const witness_t *felt, *pushed;
    float felt_off_m;  /* sum of the accelerometer's innovations, less when it is noisy */
    bool felt_valid;   /* the accelerometer's witness counts and is not doubted */
    bool pushed_valid; /* the thrust's witness counts */
} case_t;

bool verdict_felt_valid(const verdict_t *verdict, const senses_t *senses)
{
    return witness_counts(&senses->accelerometer.felt) && (verdict->doubts & DOUBT_IMU) == 0U;
}

static case_t case_of(const verdict_t *verdict, const senses_t *senses, const command_t *command)
{
    return (case_t){
        .verdict = verdict,
        .senses = senses,
        .command = command,
        .felt = &senses->accelerometer.felt,
        .pushed = &senses->push.pushed,
        .felt_off_m = accelerometer_off_m(&senses->accelerometer),
        .felt_valid = verdict_felt_valid(verdict, senses),
        .pushed_valid = witness_counts(&senses->push.pushed),
    };
}

/* ---- what several rules ask */

/* The heights contradict the witness of the accelerometer by more than at_least_m. */
static bool felt_against(const case_t *c, float at_least_m)
{
    return c->felt_valid && fabsf(c->felt_off_m) > at_least_m;
}

/* Neither witness contradicts the heights by the smallest limit of any rule below. */
static bool both_agree(const case_t *c)
{
    return fabsf(c->felt->seen_m) < STILL_FELT_M && fabsf(c->pushed->seen_m) < STILL_BOTH_M;
}

/* Both contradict the heights in the same direction. */
static bool same_side(const case_t *c)
{
    return c->felt->seen_m * c->pushed->seen_m > 0.0F;
}

static bool heights_rest(const case_t *c)
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

/* Both witnesses contradict the heights in the same direction, by that share of the limits. */
static bool both_against(const case_t *c, float share)
{
    const bool content = fabsf(c->command->wanted_m) < CONTENT_M && !c->senses->beam.flat;
    const float sure = content ? share * CONTENT_SHARE : share;

    if (!witness_against(c->pushed, sure * BOTH_M)) {
        return false;
    }
    const float pushed_m = c->pushed->seen_m;

    return felt_against(c, sure * BOTH_M) && c->felt_off_m * pushed_m > 0.0F &&
           at_least(fabsf(c->felt_off_m), fabsf(pushed_m)) > sure * AGAINST_M;
}

/* ---- rules of DOUBT_SIGHT */

static bool is_steps(const case_t *c)
{
    return heights_are_steps(&c->senses->heights);
}

static bool is_stiff(const case_t *c)
{
    return c->senses->beam.rigid == BEAM_STILL_SCANS && sway_as_in_the_air(&c->senses->sway);
}

static bool is_white(const case_t *c)
{
    return c->senses->beam.white == BEAM_WHITE_SCANS;
}

static bool is_sunk(const case_t *c)
{
    return c->senses->confirmation.sunk == CONFIRMATION_SUNK;
}

/* The law takes the vehicle to be on the ground still. But the tilt sways as in the air, for long; or the
 * beam is still or its height above the ground, and the accelerometer has measured a climb. */
static bool is_aloft(const case_t *c)
{
    const senses_t *s = c->senses;
    const bool odd = s->beam.rigid >= RIGID_SCANS || (s->heights.height_m > LOW_M && beam_is_still(&s->beam));

    return c->verdict->swaying_s > SWAYING_S ||
           (c->command->standing && s->confirmation.unconfirmed && odd && sway_as_in_the_air(&s->sway) &&
            c->verdict->felt_least_m < -ALOFT_M);
}

/* A beam may be blocked during a climb, so this does not wait until heights_moved() is over. slower_mps lags
 * like rise_mps: a vehicle that has just turned upwards is not doubted. */
static bool is_unseen(const case_t *c)
{
    return c->senses->slower_mps - c->senses->heights.rise_mps > UNSEEN_MPS &&
           c->pushed->seen_m < -UNSEEN_PUSHED_M && c->felt_valid && c->pushed_valid &&
           c->felt_off_m < -UNSEEN_FELT_M && heights_rest(c);
}

static bool is_still(const case_t *c)
{
    const beam_t *beam = &c->senses->beam;
    const bool felt = !c->felt_valid || (same_side(c) && felt_against(c, STILL_FELT_M));
    const bool rigid = beam->rigid >= RIGID_SCANS;
    const bool both = felt_against(c, STILL_BOTH_M) && witness_against(c->pushed, STILL_BOTH_M);
    const bool flat = beam->flat && beam->white >= FLAT_SCANS && felt && felt_against(c, FLAT_FELT_M) &&
                      witness_against(c->pushed, AGAINST_M);

    return (felt && both && rigid) || flat ||
           ((felt || rigid) && witness_against(c->pushed, BOTH_M) && beam->white >= NOISE_SCANS);
}

/* It is believed, because it measured g at rest a moment ago. The thrust does not help: the hover thrust is
 * not known yet. */
static bool is_unproved(const case_t *c)
{
    return confirmation_is_first(&c->senses->confirmation) && !heights_move(&c->senses->heights) &&
           c->felt_valid && c->felt_off_m < -UNPROVED_M;
}

static bool is_runaway(const case_t *c)
{
    const float rise_mps = c->senses->heights.rise_mps;
    const float felt_mps = (c->felt->speed_mps - rise_mps) / c->senses->accelerometer.shaken;
    const float pushed_mps = c->pushed->speed_mps - rise_mps;

    return heights_rest(c) && felt_mps * pushed_mps > 0.0F && felt_mps * c->felt->seen_m < 0.0F &&
           at_most(fabsf(felt_mps), fabsf(pushed_mps)) > RUN_AWAY_MPS &&
           at_most(fabsf(c->felt_off_m), fabsf(c->pushed->seen_m)) > RUN_AWAY_M;
}

/* The accelerometer does not contradict that. */
static bool is_no_climb(const case_t *c)
{
    const confirmation_t *confirmation = &c->senses->confirmation;
    const float pushed_m = c->pushed->seen_m;
    const bool flew = confirmation->proved ||
                      confirmation->near_m > WITNESS_STEP_M; /* a step after the lift-off moves near_m up */

    return confirmation->unconfirmed && (flew || c->verdict->felt_least_m < -WITH_M) &&
           c->pushed->running_s >= WITNESS_OLD_S && fabsf(pushed_m) > UNCONFIRMED_M &&
           pushes_in_vain(c->senses, c->command, UNCONFIRMED_N) &&
           !(felt_against(c, WITH_M) && c->felt_off_m * pushed_m < 0.0F);
}

/* The thrust's witness of a vehicle unlike the model drifts, and the accelerometer's bias may jump. */
static bool is_both(const case_t *c)
{
    return heights_rest(c) && both_against(c, (c->senses->beam.still == 0U) ? ALIVE_SHARE : 1.0F);
}

static bool is_vain(const case_t *c)
{
    return c->verdict->vain_s > VAIN_S;
}

/* Near the ground the accelerometer alone is not believed against heights that move: it misses the knocks of
 * a touchdown on a rough floor. */
static bool is_felt(const case_t *c)
{
    return (c->senses->heights.height_m > LOW_M || beam_is_still(&c->senses->beam)) &&
           felt_against(c, ALONE_M);
}

/* When a rule is asked, by the witnesses that count. */
#define ALWAYS 1U   /* whatever else is known */
#define UNMOVED 2U  /* the heights have not moved lately, and somebody contradicts them */
#define OF_BOTH 4U  /* and both witnesses count */
#define OF_PUSH 8U  /* only that of the thrust */
#define OF_FELT 16U /* only that of the accelerometer, or none */

static const struct {
    verdict_reason_t reason;
    uint16_t when;
    bool (*is)(const case_t *c);
} sight_rules[] = {
    {VERDICT_STEPS, ALWAYS, is_steps},      {VERDICT_STIFF, ALWAYS, is_stiff},
    {VERDICT_WHITE, ALWAYS, is_white},      {VERDICT_SUNK, ALWAYS, is_sunk},
    {VERDICT_ALOFT, ALWAYS, is_aloft},      {VERDICT_UNSEEN, ALWAYS, is_unseen},
    {VERDICT_STILL, UNMOVED, is_still},     {VERDICT_UNPROVED, UNMOVED, is_unproved},
    {VERDICT_RUNAWAY, OF_BOTH, is_runaway}, {VERDICT_NO_CLIMB, OF_BOTH | OF_PUSH, is_no_climb},
    {VERDICT_BOTH, OF_BOTH, is_both},       {VERDICT_VAIN, OF_PUSH, is_vain},
    {VERDICT_FELT, OF_FELT, is_felt},
};

static uint16_t circumstances(const case_t *c)
{
    const uint16_t who = c->pushed_valid ? (c->felt_valid ? OF_BOTH : OF_PUSH) : OF_FELT;

    if (heights_moved(&c->senses->heights) || (c->felt_valid && both_agree(c))) {
        return ALWAYS;
    }
    return (uint16_t)(ALWAYS | UNMOVED | who);
}

/* The first rule that applies. */
static verdict_reason_t against_sight(const case_t *c)
{
    const uint16_t now = circumstances(c);

    for (uint16_t k = 0U; k < sizeof sight_rules / sizeof sight_rules[0]; ++k) {
        if ((sight_rules[k].when & now) != 0U && sight_rules[k].is(c)) {
            return sight_rules[k].reason;
        }
    }
    return VERDICT_NONE;
}

/* ---- rules of the other doubts */

/* The hover thrust may have been learned from a wrong accelerometer. Then both witnesses have the same error,
 * and heights that move are right against both. */
static verdict_reason_t against_imu(const case_t *c)
{
    const bool alone = !witness_against(c->pushed, ALONE_SHARE * fabsf(c->felt->seen_m)) ||
                       c->felt->seen_m * c->pushed->seen_m < 0.0F;

    if (both_agree(c) || beam_is_still(&c->senses->beam) || is_unproved(c)) {
        return VERDICT_NONE;
    }
    if (felt_against(c, ALONE_M) && c->pushed_valid && alone) {
        return VERDICT_ALONE;
    }
    return (heights_move(&c->senses->heights) && felt_against(c, AGAINST_M) && both_against(c, 1.0F))
               ? VERDICT_MOVED
               : VERDICT_NONE;
}

static verdict_reason_t against_thrust(const case_t *c)
{
    const bool vain = c->senses->confirmation.proved && fabsf(c->command->wanted_m) > VAIN_M &&
                      witness_against(c->pushed, NO_AUTHORITY_M) && c->felt_valid &&
                      !felt_against(c, WITH_M) && pushes_in_vain(c->senses, c->command, PUSH_N);

    return vain ? VERDICT_NO_EFFECT : VERDICT_NONE;
}

/* ---- doubts come and go */

static void forget(verdict_t *verdict, senses_t *senses)
{
    senses_forget(senses);
    verdict->agreed_s = 0.0F;
}

/* Writes the reason of each of the given doubts. */
static void give_reason(verdict_t *verdict, uint16_t doubt, verdict_reason_t reason)
{
    for (uint16_t k = 0U; k < VERDICT_DOUBTS; ++k) {
        if ((doubt & (1U << k)) != 0U) {
            verdict->reasons[k] = reason;
        }
    }
}

static void set_doubt(verdict_t *verdict, uint16_t doubt, verdict_reason_t reason)
{
    verdict->doubts |= doubt;
    give_reason(verdict, doubt, reason);
}

static void clear_doubt(verdict_t *verdict, uint16_t doubt)
{
    verdict->doubts &= (uint16_t)~doubt;
    give_reason(verdict, doubt, VERDICT_NONE);
}

void verdict_rest(verdict_t *verdict, const accelerometer_t *accelerometer)
{
    const rest_t rest = accelerometer_judge_rest(accelerometer);

    if (rest == REST_UNFIT && (verdict->doubts & DOUBT_IMU) == 0U) {
        set_doubt(verdict, DOUBT_IMU, VERDICT_REST);
    } else if (rest == REST_FIT) {
        clear_doubt(verdict, DOUBT_IMU);
    }
}

void verdict_order(verdict_t *verdict, senses_t *senses)
{
    clear_doubt(verdict, DOUBT_SIGHT | DOUBT_THRUST);
    forget(verdict, senses);
}

/* Heights and witnesses agree, over a real motion. */
static bool agrees(const case_t *c)
{
    const witness_t *mover = c->pushed_valid ? c->pushed : c->felt;

    return !felt_against(c, WITH_M) && !witness_against(c->pushed, WITH_M) && mover->moved_m > MOVED_M;
}

/* Clears a doubt after enough agreement. */
static void judge_again(verdict_t *verdict, senses_t *senses, const case_t *c, float gap_s)
{
    const bool seen = heights_move(&senses->heights) && heights_step_less(&senses->heights);
    const bool contradicted = felt_against(c, AGAINST_M) || witness_against(c->pushed, AGAINST_M);

    verdict->agreed_s = (agrees(c) && senses->beam.still < BEAM_STILL_SCANS) ? verdict->agreed_s + gap_s
                                                                             : 0.0F;
    if (verdict->agreed_s > AGREED_S || (seen && (verdict->doubts & DOUBT_SIGHT) != 0U)) {
        clear_doubt(verdict, DOUBT_SIGHT | DOUBT_THRUST);
        forget(verdict, senses);
    } else if (contradicted) {
        forget(verdict, senses);
    }
}

/* Error of the height by the valid witnesses, mean of both when both are valid. */
static float lost_m(const case_t *c)
{
    if (c->felt_valid && c->pushed_valid) {
        return 0.5F * (c->felt->seen_m + c->pushed->seen_m);
    }
    return c->pushed_valid ? c->pushed->seen_m : c->felt->seen_m;
}

static void doubt_sight(verdict_t *verdict, senses_t *senses, const case_t *c, verdict_reason_t reason)
{
    set_doubt(verdict, DOUBT_SIGHT, reason);
    verdict->lost_m = lost_m(c);
    accelerometer_take_back(&senses->accelerometer);
    forget(verdict, senses);
}

static void doubt_thrust(verdict_t *verdict, senses_t *senses, const command_t *command)
{
    set_doubt(verdict, DOUBT_THRUST, VERDICT_NO_EFFECT);
    verdict->held_n = command->hover_n;
    verdict->held_down = command->wanted_m < 0.0F;
    forget(verdict, senses);
}

static void judge_imu(verdict_t *verdict, senses_t *senses, const command_t *command)
{
    const case_t c = case_of(verdict, senses, command);
    const verdict_reason_t reason = ((verdict->doubts & DOUBT_IMU) == 0U) ? against_imu(&c) : VERDICT_NONE;

    if (reason != VERDICT_NONE) {
        set_doubt(verdict, DOUBT_IMU, reason);
        forget(verdict, senses);
    }
}

static void judge(verdict_t *verdict, senses_t *senses, const command_t *command, float gap_s)
{
    judge_imu(verdict, senses, command);
    const case_t c = case_of(verdict, senses, command);

    if ((verdict->doubts & (DOUBT_SIGHT | DOUBT_THRUST)) != 0U) {
        judge_again(verdict, senses, &c, gap_s);
        return;
    }
    const verdict_reason_t reason = against_sight(&c);
    if (reason != VERDICT_NONE) {
        doubt_sight(verdict, senses, &c, reason);
    } else if (against_thrust(&c) != VERDICT_NONE) {
        doubt_thrust(verdict, senses, command);
    }
}

/* How long the tilt has swayed as in the air, and the beam has shown nothing of it. */
static void watch_lift_off(verdict_t *verdict, const senses_t *senses, const command_t *command, float gap_s)
{
    if (!command->standing) {
        verdict->swaying_s = 0.0F;
        return;
    }
    const float height_m = senses->heights.height_m;
    const bool strong = senses->push.lagged_n >
                        STRONG_SHARE * command->hover_n; /* no vehicle stays on the ground */
    const bool sways = senses->confirmation.unconfirmed && sway_as_in_the_air(&senses->sway) &&
                       (strong || beam_is_still(&senses->beam));

    if (!sways || fabsf(height_m - verdict->swaying_from_m) > SWAYING_M) {
        verdict->swaying_s = 0.0F;
        verdict->swaying_from_m = height_m;
    } else {
        verdict->swaying_s += strong ? STRONG_COUNTS * gap_s : gap_s;
    }
}

static void watch_push(verdict_t *verdict, const senses_t *senses, const command_t *command, float gap_s)
{
    const bool vain = pushes_in_vain(senses, command, PUSH_N) && fabsf(senses->heights.rise_mps) < VAIN_MPS &&
                      fabsf(command->wanted_m) > VAIN_M;

    verdict->vain_s = vain ? verdict->vain_s + gap_s : 0.0F;
}

void verdict_height(verdict_t *verdict, senses_t *senses, const command_t *command,
                    const height_change_t *change)
{
    accelerometer_t *accelerometer = &senses->accelerometer;
    const float off_m = accelerometer_off_m(accelerometer);

    verdict->agreed_s = change->first_climb ? 0.0F : verdict->agreed_s;
    verdict->felt_least_m = senses->confirmation.unconfirmed ? at_most(verdict->felt_least_m, off_m) : 0.0F;
    watch_lift_off(verdict, senses, command, change->gap_s);
    watch_push(verdict, senses, command, change->gap_s);
    confirmation_wait(&senses->confirmation, change, command->wanted_m, command->grounded,
                      beam_lives(&senses->beam));
    if (!command->ours) {
        forget(verdict, senses);
        witness_start(&accelerometer->felt, senses->heights.rise_mps);
    } else if (!command->grounded) {
        judge(verdict, senses, command, change->gap_s);
    }
}

bool verdict_apart(const verdict_t *verdict, const senses_t *senses)
{
    const accelerometer_t *accelerometer = &senses->accelerometer;

    return verdict_felt_valid(verdict, senses) &&
           fabsf(accelerometer->felt.speed_mps - senses->heights.rise_mps) >
               APART_MPS * accelerometer->shaken;
}

float verdict_speed_mps(const verdict_t *verdict, const senses_t *senses)
{
    const float felt_mps = senses->accelerometer.felt.speed_mps;
    const float pushed_mps = senses->push.pushed.speed_mps;
    const bool felt = verdict_felt_valid(verdict, senses);
    const bool pushed = witness_counts(&senses->push.pushed) && (verdict->doubts & DOUBT_THRUST) == 0U;

    if (felt && pushed) {
        return 0.5F * (felt_mps + pushed_mps);
    }
    return felt ? felt_mps : pushed ? pushed_mps : 0.0F;
}

verdict_reason_t verdict_reason(const verdict_t *verdict)
{
    for (uint16_t k = 0U; k < VERDICT_DOUBTS; ++k) {
        if (verdict->reasons[k] != VERDICT_NONE) {
            return verdict->reasons[k];
        }
    }
    return VERDICT_NONE;
}

const char *verdict_doubt_name(uint16_t doubts)
{
    if ((doubts & DOUBT_SIGHT) != 0U) {
        return "SIGHT";
    }
    if ((doubts & DOUBT_IMU) != 0U) {
        return "IMU";
    }
    return ((doubts & DOUBT_THRUST) != 0U) ? "THRUST" : NULL;
}

static const char *const reason_names[] = {
    [VERDICT_NONE] = "-",          [VERDICT_STEPS] = "steps",      [VERDICT_STIFF] = "stiff",
    [VERDICT_WHITE] = "white",     [VERDICT_SUNK] = "sunk",        [VERDICT_ALOFT] = "aloft",
    [VERDICT_UNSEEN] = "unseen",   [VERDICT_STILL] = "still",      [VERDICT_UNPROVED] = "unproved",
    [VERDICT_RUNAWAY] = "runaway", [VERDICT_NO_CLIMB] = "noclimb", [VERDICT_BOTH] = "both",
    [VERDICT_VAIN] = "vain",       [VERDICT_FELT] = "felt",        [VERDICT_REST] = "rest",
    [VERDICT_ALONE] = "alone",     [VERDICT_MOVED] = "moved",      [VERDICT_NO_EFFECT] = "noeffect",
};
typedef char
    every_reason_has_a_name[(sizeof reason_names / sizeof reason_names[0] == VERDICT_COUNT) ? 1 : -1];

const char *verdict_reason_name(uint16_t reason)
{
    return reason_names[reason];
}
