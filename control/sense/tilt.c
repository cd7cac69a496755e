/* A spike or a lost frame makes a jump, and a vehicle that turns over makes one too. They differ in what
 * follows: bad frames jump and then turn differently.
 * What breaks: a jump that is never accepted leaves the vehicle without a tilt, so the seventh is accepted
 * whatever it is. */
#include "control/sense/tilt.h"

#include <math.h>

#include "control/angle.h"
#include "control/credible.h"

#define JUMP_RAD 0.35F       /* chosen: 20 degrees within a frame of 25 ms, 800 degrees a second */
#define STEADY_MIN_RAD 0.05F /* chosen: 110 degrees a second, faster than an attitude that is held */
#define STEADY_MAX_RAD 0.25F /* as FOLLOWS_RAD in attitude.c; a spike or a lost frame makes one step more */
#define JUMPS_HELD 6U        /* chosen: a burst of six bad frames shows in six medians */
#define ANGLE_MAX_RAD 7.0F   /* chosen: above 2 pi */
#define TILT_GAP_US UINT32_C(250000) /* ten frames of 25 ms: after such a gap any tilt is accepted */
#define TILTED_MAX 1000U             /* chosen: the counter stops here and does not wrap */

void tilt_init(tilt_t *tilt)
{
    *tilt = (tilt_t){.upright = 1.0F};
}

/* One axis of turns_on(). */
static bool turns_steadily(float accepted_rad, float before_rad, float now_rad, uint16_t frames)
{
    const float step_rad = turn_rad(before_rad, now_rad);
    const float rest_rad = turn_rad(accepted_rad, now_rad) - (float)frames * step_rad;

    return fabsf(step_rad) > STEADY_MIN_RAD && fabsf(step_rad) < STEADY_MAX_RAD &&
           fabsf(rest_rad) < STEADY_MAX_RAD;
}

/* The tilts that were rejected go on turning, and at the same rate they have turned since the accepted one:
 * the vehicle turns over, and a spike or a lost frame made the jump. */
static bool turns_on(const tilt_t *tilt, float roll_rad, float pitch_rad)
{
    const uint16_t frames = (uint16_t)(tilt->jumped + 1U);

    return tilt->jumped > 0U && (turns_steadily(tilt->roll_rad, tilt->told_rad[0], roll_rad, frames) ||
                                 turns_steadily(tilt->pitch_rad, tilt->told_rad[1], pitch_rad, frames));
}

/* Accepts or rejects one tilt. True: accepted. */
static bool accept_tilt(tilt_t *tilt, float roll_rad, float pitch_rad, uint32_t time_us)
{
    const bool recent = tilt->levelled && time_us - tilt->time_us <= TILT_GAP_US;
    const bool told = fabsf(roll_rad) < ANGLE_MAX_RAD && fabsf(pitch_rad) < ANGLE_MAX_RAD; /* no NaN */
    const bool jump = arc_rad(tilt->roll_rad, roll_rad) > JUMP_RAD ||
                      arc_rad(tilt->pitch_rad, pitch_rad) > JUMP_RAD;

    if (!told) {
        return false;
    }
    tilt->time_us = time_us;
    if (recent && jump && tilt->jumped < JUMPS_HELD && !turns_on(tilt, roll_rad, pitch_rad)) {
        ++tilt->jumped;
        tilt->told_rad[0] = roll_rad;
        tilt->told_rad[1] = pitch_rad;
        return false;
    }
    tilt->levelled = true;
    tilt->jumped = 0U;
    tilt->roll_rad = roll_rad;
    tilt->pitch_rad = pitch_rad;
    tilt->upright = cosf(roll_rad) * cosf(pitch_rad);
    return true;
}

/* Counts tilted frames. The median of a burst of bad frames outlasts it by two: the frame itself must be
 * tilted too. */
static void count_tilted(tilt_t *tilt, const imu_sample_t *frame)
{
    if (frame->rolled == ATTITUDE_ROLLED_FRAMES) {
        tilt->tilted = TILTED_MAX;
    } else if (tilt->upright >= TILTED_COS) {
        tilt->tilted = 0U;
    } else if (cosf(frame->level.roll_rad) * cosf(frame->level.pitch_rad) < TILTED_COS) {
        tilt->tilted = (uint16_t)(tilt->tilted + (tilt->tilted < TILTED_MAX));
    }
}

void tilt_step(tilt_t *tilt, const imu_sample_t *frames, uint16_t count, float roll_rad, float pitch_rad,
               uint32_t time_us)
{
    for (uint16_t k = imu_first_after(frames, count, tilt->sequence); k < count; ++k) {
        const imu_sample_t *frame = &frames[k];

        tilt->sequence = frame->sequence;
        if (!accept_tilt(tilt, frame->median.roll_rad, frame->median.pitch_rad, frame->arrival_us)) {
            tilt->unfit_sequence = frame->sequence;
        }
        count_tilted(tilt, frame);
    }
    if (count == 0U && (!tilt->levelled || time_us != tilt->time_us)) {
        (void)accept_tilt(tilt, roll_rad, pitch_rad, time_us);
    }
}
