/* A spike or a lost frame makes a jump, and a vehicle that turns over makes one too. They differ in what
 * follows: bad frames jump and then turn differently. And they differ in what the mirrors show: the heights
 * by all of them agree at the true tilt alone, and go on from the height before.
 * A tilt that wanders away makes no jump, so there the evidence of
 * the scans is summed up: one scan over an edge must not decide.
 * What breaks: a tilt over 45 degrees cuts the thrust. The seventh jump is accepted whatever it is, unless
 * the mirrors refute it; and those are asked again in each scan. */
#include "control/sense/tilt.h"

#include <math.h>

#include "control/angle.h"
#include "control/between.h"
#include "control/credible.h"

/* Three spikes of five frames are their median: a spike, less what the vehicle has turned meanwhile. By the
 * liveliest sway, 3 degrees rms, that jumps by 0.28 rad at least. */
#define JUMP_RAD (ATTITUDE_SPIKE_RAD - 2.0F * ATTITUDE_STIRS_RAD)
#define JUMPS_HELD (ATTITUDE_ROLLED_FRAMES - 1U) /* a burst of bad frames shows in as many medians */
#define ANGLE_MAX_RAD 7.0F                       /* 2 pi, rounded up */
#define TILT_GAP_US UINT32_C(250000) /* ten frames of 25 ms: after such a gap any tilt is accepted */
#define REFUTED_US TILT_GAP_US       /* so long a scan refutes: two may be missing */
#define TILTED_MAX 1000U             /* any above what is asked: the counter stops here */
/* Evidence is a logarithm of a ratio of likelihoods, in nats. */
#define SURE_NATS 4.6F /* 99 % */
#define SCAN_NATS 3.0F /* one scan in 20 shows ground that is no plane, and then tells nothing */
#define MOST_NATS (SURE_NATS + SCAN_NATS) /* one such scan leaves it sure */

void tilt_init(tilt_t *tilt)
{
    *tilt = (tilt_t){.upright = 1.0F};
}

/* One axis of turns_on(). */
static bool turns_steadily(float accepted_rad, float before_rad, float now_rad, uint16_t frames)
{
    const float step_rad = turn_rad(before_rad, now_rad);
    const float rest_rad = turn_rad(accepted_rad, now_rad) - (float)frames * step_rad;

    return fabsf(step_rad) > ATTITUDE_STIRS_RAD && fabsf(step_rad) < JUMP_RAD && fabsf(rest_rad) < JUMP_RAD;
}

/* The tilts that were rejected go on turning, and at the same rate they have turned since the accepted one:
 * the vehicle turns over, and a spike or a lost frame made the jump. */
static bool turns_on(const tilt_t *tilt, float roll_rad, float pitch_rad)
{
    const uint16_t frames = (uint16_t)(tilt->jumped + 1U);

    return tilt->jumped > 0U && (turns_steadily(tilt->roll_rad, tilt->told_rad[0], roll_rad, frames) ||
                                 turns_steadily(tilt->pitch_rad, tilt->told_rad[1], pitch_rad, frames));
}

static bool is_refuted(const tilt_t *tilt, uint32_t time_us)
{
    return tilt->against_nats > 0.0F && time_us - tilt->refuted_us <= REFUTED_US;
}

static bool is_jump(const tilt_t *tilt, float roll_rad, float pitch_rad)
{
    return arc_rad(tilt->roll_rad, roll_rad) > JUMP_RAD || arc_rad(tilt->pitch_rad, pitch_rad) > JUMP_RAD;
}

/* Beyond 20 degrees the scans may refute it. */
static bool is_steep(float roll_rad, float pitch_rad)
{
    return arc_rad(0.0F, roll_rad) > ATTITUDE_SPIKE_RAD || arc_rad(0.0F, pitch_rad) > ATTITUDE_SPIKE_RAD;
}

static void believe(tilt_t *tilt, float roll_rad, float pitch_rad)
{
    tilt->roll_rad = roll_rad;
    tilt->pitch_rad = pitch_rad;
    tilt->upright = cosf(roll_rad) * cosf(pitch_rad);
}

static void reject(tilt_t *tilt, bool jump, bool refuted)
{
    tilt->leapt = (tilt->jumped > 0U) ? tilt->leapt : jump;
    tilt->jumped = (uint16_t)(tilt->jumped + (tilt->jumped < JUMPS_HELD));
    if (refuted && is_steep(tilt->roll_rad, tilt->pitch_rad)) {
        believe(tilt, 0.0F, 0.0F); /* what was accepted on the way there was refuted with it */
    }
}

/* Must this tilt be rejected? Of a recent one only: after a gap any tilt is accepted that the mirrors do not
 * refute. */
static bool is_rejected(tilt_t *tilt, float roll_rad, float pitch_rad, uint32_t time_us)
{
    const bool recent = tilt->levelled && time_us - tilt->time_us <= TILT_GAP_US;
    const bool jump = is_jump(tilt, roll_rad, pitch_rad);
    const bool strange = jump || cosf(roll_rad) * cosf(pitch_rad) < TILTED_COS;
    const bool steep = is_steep(roll_rad, pitch_rad);
    const bool refuted = is_refuted(tilt, time_us) && (strange || (steep && tilt->against_nats > SURE_NATS));
    const bool held = recent && jump && tilt->jumped < JUMPS_HELD && !turns_on(tilt, roll_rad, pitch_rad);

    if (refuted || held) {
        reject(tilt, jump, refuted);
    }
    return refuted || held;
}

/* Accepts or rejects one tilt. True: accepted. */
static bool accept_tilt(tilt_t *tilt, float roll_rad, float pitch_rad, uint32_t time_us)
{
    if (!(fabsf(roll_rad) < ANGLE_MAX_RAD && fabsf(pitch_rad) < ANGLE_MAX_RAD)) { /* NaN too */
        return false;
    }
    const bool rejected = is_rejected(tilt, roll_rad, pitch_rad, time_us);

    tilt->time_us = time_us;
    tilt->told_rad[0] = roll_rad;
    tilt->told_rad[1] = pitch_rad;
    if (rejected) {
        return false;
    }
    tilt->levelled = true;
    tilt->jumped = 0U;
    tilt->accepted_us = time_us;
    believe(tilt, roll_rad, pitch_rad);
    return true;
}

/* Squares by which the heights at this tilt are off the one before, a way further; about their own
 * mean when that one was taken with tilts that led there. Each tilt goes on from its own heights, so a
 * vehicle that climbs does not leave them. */
static float misfit_mm2(float *height_mm, const altitude_t *shown, uint16_t count, const float tilt_rad[2],
                        float way_mm, bool goes_on)
{
    float sum_mm = 0.0F;
    float squares_mm2 = 0.0F;
    float valid = 0.0F;

    *height_mm += way_mm;
    for (uint16_t m = 0U; m < count; ++m) {
        if (shown[m].valid) {
            const float off_mm = altitude_at_tilt(&shown[m], tilt_rad[0], tilt_rad[1]) - *height_mm;

            sum_mm += off_mm;
            squares_mm2 += off_mm * off_mm;
            valid += 1.0F;
        }
    }
    if (valid == 0.0F) {
        return 0.0F;
    }
    *height_mm += sum_mm / valid;
    return goes_on ? squares_mm2 : squares_mm2 - sum_mm * sum_mm / valid;
}

void tilt_scan(tilt_t *tilt, const altitude_t *shown, uint16_t count, float height_mm, float way_mm,
               bool aloft)
{
    static const float level_rad[2] = {0.0F, 0.0F};
    const float noise_mm = 1000.0F * HEIGHT_SIGMA_M;
    const bool goes_on = tilt->jumped > 0U && tilt->leapt;

    if (!goes_on) {
        tilt->level_mm = tilt->told_mm = height_mm;
    }
    const float level_mm2 = misfit_mm2(&tilt->level_mm, shown, count, level_rad, way_mm, goes_on);
    const float told_mm2 = misfit_mm2(&tilt->told_mm, shown, count, tilt->told_rad, way_mm, goes_on);
    const float nats = (told_mm2 - level_mm2) / (2.0F * noise_mm * noise_mm);

    tilt->refuted_us = tilt->time_us; /* mirrors that show nothing leave the sum as it was */
    if (!aloft || !tilt->levelled || !is_steep(tilt->told_rad[0], tilt->told_rad[1])) {
        tilt->against_nats = 0.0F;
    } else if (goes_on) {
        tilt->against_nats += nats;
    } else {
        tilt->against_nats = between(-MOST_NATS, tilt->against_nats + between(-SCAN_NATS, nats, SCAN_NATS),
                                     MOST_NATS);
    }
}

/* Counts tilted frames. The median of a burst of bad frames outlasts it by two: the frame itself must be
 * tilted too. */
static void count_tilted(tilt_t *tilt, const imu_sample_t *frame)
{
    if (is_refuted(tilt, frame->arrival_us)) {
        tilt->tilted = 0U;
    } else if (frame->rolled == ATTITUDE_ROLLED_FRAMES) {
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
