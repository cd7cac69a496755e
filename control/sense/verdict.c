/* Doubts come and go, as the belief tells.
 * What breaks: a thrust that is doubted in a gust may not push against that. After each verdict the sums of
 * the witnesses start anew, or the same evidence counts twice. */
#include "control/sense/verdict.h"

#include <math.h>

#include "control/between.h"

#define PUSH_N 0.7F  /* chosen: a tenth of GRAV as delivered, 7 N */
#define LASTS_S 1.5F /* chosen: 15 more scans that tell it than scans that do not */

bool verdict_felt_valid(const verdict_t *verdict, const senses_t *senses)
{
    return witness_counts(&senses->accelerometer.felt) && (verdict->doubts & DOUBT_IMU) == 0U;
}

/* The thrust pushes towards the reference, and the heights do not follow. */
static bool pushes_in_vain(const senses_t *senses, const command_t *command)
{
    const float push_n = senses->push.lagged_n - command->hover_n;

    return fabsf(push_n) > PUSH_N && push_n * command->wanted_m > 0.0F &&
           senses->push.pushed.seen_m * push_n < 0.0F;
}

static void forget(verdict_t *verdict, senses_t *senses)
{
    senses_forget(senses);
    verdict->contrary_s = 0.0F;
}

static void end_doubt(verdict_t *verdict, senses_t *senses, uint16_t doubt)
{
    verdict->doubts &= (uint16_t)~doubt;
    forget(verdict, senses);
}

void verdict_rest(verdict_t *verdict, const accelerometer_t *accelerometer)
{
    const rest_t rest = accelerometer_judge_rest(accelerometer);

    if (rest == REST_UNFIT && (verdict->doubts & DOUBT_IMU) == 0U) {
        verdict->doubts |= DOUBT_IMU;
        verdict->why_imu = VERDICT_REST;
    } else if (rest == REST_FIT) {
        verdict->doubts &= (uint16_t)~DOUBT_IMU;
    }
}

void verdict_order(verdict_t *verdict, senses_t *senses)
{
    end_doubt(verdict, senses, DOUBT_SIGHT | DOUBT_THRUST);
}

static void doubt_sight(verdict_t *verdict, senses_t *senses, float age_s)
{
    const bool felt = (verdict->doubts & DOUBT_IMU) == 0U;

    verdict->doubts |= DOUBT_SIGHT;
    verdict->blind_height_m = 0.001F * belief_blind(&senses->mirrors.belief).height_mm +
                              mirrors_blind_mps(&senses->mirrors, felt) * age_s;
    forget(verdict, senses);
}

static void doubt_thrust(verdict_t *verdict, senses_t *senses, const command_t *command)
{
    verdict->doubts |= DOUBT_THRUST;
    verdict->held_n = verdict->sure_n; /* in vain the hover thrust learns what is not so */
    verdict->held_down = command->wanted_m < 0.0F;
    forget(verdict, senses);
}

static void judge_imu(verdict_t *verdict, senses_t *senses)
{
    if ((verdict->doubts & DOUBT_IMU) == 0U &&
        (senses->mirrors.felt_lies || accelerometer_is_beyond(&senses->accelerometer))) {
        verdict->doubts |= DOUBT_IMU;
        verdict->why_imu = VERDICT_ALONE;
        forget(verdict, senses);
    }
}

/* The belief tells whether the sight lies, and when what it sees moves again. */
static void judge_sight(verdict_t *verdict, senses_t *senses, float age_s)
{
    if ((verdict->doubts & DOUBT_SIGHT) == 0U && senses->mirrors.blind) {
        doubt_sight(verdict, senses, age_s);
    } else if ((verdict->doubts & DOUBT_SIGHT) != 0U && senses->mirrors.sees) {
        end_doubt(verdict, senses, DOUBT_SIGHT);
    }
}

/* A pilot, or somebody who holds the vehicle, makes the thrust push in vain. That it has no effect the belief
 * tells, scan by scan. It forgets a motion within a second, so what it tells has to last. A gust pushes
 * harder. The thrust is held against the heights, so only while these are believed. */
static void judge_thrust(verdict_t *verdict, senses_t *senses, const command_t *command, float gap_s)
{
    const bool doubted = (verdict->doubts & DOUBT_THRUST) != 0U;
    const bool in_vain = pushes_in_vain(senses, command);
    const bool against = senses->confirmation.proved && senses->mirrors.unpushed && in_vain;
    const bool contrary = doubted ? !senses->mirrors.unpushed : against;

    if (!in_vain) {
        verdict->sure_n = command->hover_n;
    }
    if ((verdict->doubts & DOUBT_SIGHT) != 0U) {
        return;
    }
    verdict->contrary_s = between(0.0F, verdict->contrary_s + (contrary ? gap_s : -gap_s), LASTS_S);
    if (!contrary || verdict->contrary_s < LASTS_S) {
        return;
    }
    if (doubted) {
        end_doubt(verdict, senses, DOUBT_THRUST);
    } else {
        doubt_thrust(verdict, senses, command);
    }
}

static void judge(verdict_t *verdict, senses_t *senses, const command_t *command,
                  const height_change_t *change)
{
    judge_imu(verdict, senses);
    judge_sight(verdict, senses, change->age_s);
    judge_thrust(verdict, senses, command, change->gap_s);
}

void verdict_height(verdict_t *verdict, senses_t *senses, const command_t *command,
                    const height_change_t *change)
{
    verdict->contrary_s = change->first_climb ? 0.0F : verdict->contrary_s;
    confirmation_wait(&senses->confirmation, change, command->wanted_m);
    if (command->ours && !command->grounded) {
        judge(verdict, senses, command, change);
        return;
    }
    verdict->sure_n = command->hover_n;
    if (!command->ours) {
        forget(verdict, senses);
        witness_start(&senses->accelerometer.felt, senses->heights.rise_mps);
    }
}

verdict_reason_t verdict_reason(const verdict_t *verdict)
{
    if ((verdict->doubts & DOUBT_SIGHT) != 0U) {
        return VERDICT_BLIND;
    }
    if ((verdict->doubts & DOUBT_IMU) != 0U) {
        return verdict->why_imu;
    }
    return (verdict->doubts != 0U) ? VERDICT_NO_EFFECT : VERDICT_NONE;
}

static const char *const reason_names[] = {
    [VERDICT_NONE] = "-",          [VERDICT_BLIND] = "SIGHT/blind",         [VERDICT_REST] = "IMU/rest",
    [VERDICT_ALONE] = "IMU/alone", [VERDICT_NO_EFFECT] = "THRUST/noeffect",
};
typedef char
    every_reason_has_a_name[(sizeof reason_names / sizeof reason_names[0] == VERDICT_COUNT) ? 1 : -1];

const char *verdict_name(uint16_t reason)
{
    return reason_names[reason];
}
