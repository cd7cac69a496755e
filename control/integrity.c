#include "control/integrity.h"

#include <math.h>
#include <stddef.h>

#include "control/between.h"

#define HALF_TURN_RAD 3.14159265F

/* Tilt: 20 degrees within one frame are 800 degrees per second. A burst of six bad frames shows in six
 * medians. */
#define JUMP_RAD 0.35F
#define JUMPS_HELD 6U
#define ANGLE_MAX_RAD 7.0F
#define UP_MAX_MPS2 200.0F
#define TILTED_COS 0.70710678F
#define TILT_GAP_US UINT32_C(250000)

/* Scans: the third that says the same in all its digits. Noise of 3 mm: once in some millions. */
#define COPIES_MAX 2U
#define COUNT_MAX 1000U
#define HEIGHT_MIN_MM (-50.0F)
#define HEIGHT_MAX_MM 5000.0F

/* A beam that is blocked. Tried: none of 960 sound flights that the thrust contradicts is so still. */
#define STILL_MM2 4.0F
#define RIGID_SCANS 2U
#define STILL_MOST_MM2 \
    40.0F /* chosen: twice the sensor's noise of 3 mm; bars on the floor are white too, and more */
#define STILL_SHARE 0.4F
#define STILL_SCANS 16U
#define STILL_BOTH_M 0.10F
#define STILL_FELT_M 0.05F

/* Accelerometer at rest. */
#define REST_TIME_S 2.0F
#define REST_HELD_S 1.0F
#define REST_UNFIT_MPS2 1.5F
#define REST_FIT_MPS2 1.2F

/* Witnesses. */
#define FRAME_GAP_US UINT32_C(300000)
#define STEP_MAX_S 0.5F
#define SHAKEN_MPS2 0.9F
#define BIAS_TIME_S 5.0F
#define OLD_S 2.0F
#define WARM_S 0.5F
#define STANDING_TIME_S 1.0F
#define LAG_S 0.15F          /* motors and delay, as one */
#define FELT_LEAK_PER_S 1.8F /* of a witness that is OLD_S old; in proportion before */
#define FELT_PULL_PER_S2 0.81F
#define PUSHED_LEAK_PER_S 0.4F

/* Heights. */
#define STEP_M 0.10F
#define LOW_M 0.08F
#define GAP_ALLOWS_MPS 0.3F
#define GAP_MAX_S 1.5F
#define CONFIRMED_M 0.12F
#define QUIET_S 0.5F
#define QUIET_M 0.10F
#define GLITCH_S 0.25F
#define STEPS_TIME_S 2.0F
#define STEPS_MAX 12.0F

/* Standing: the thrust tells a fall that nobody feels. 0.9 degrees, both angles together: in the air it sways
 * more. */
#define FALL_MPS 0.8F
#define STANDS_S 0.6F
#define SWAY_TIME_S 1.5F
#define SWAY_RAD2 2.5e-4F
#define STILL_S 1.0F        /* chosen: two thirds of SWAY_TIME_S */
#define STILL_TIME_S 2.0F   /* chosen: an offset of 0.15 m/s2 makes 0.3 m/s of it */
#define FELL_MPS 0.4F       /* chosen: half of the fall that is asked for */
#define FALL_STILL_MPS 0.5F /* chosen: above that half */
#define UNHEARD_S \
    0.5F /* without heights the estimate's offset of the accelerometer follows what the thrust should do */
#define SWAY_AIR_RAD2 4.0e-4F

/* Verdicts. */
#define AGAINST_M 0.50F
#define BOTH_M 0.28F
#define WITH_M 0.20F
#define ALONE_M 0.60F
#define ALONE_SHARE \
    0.4F /* chosen: the thrust tells of a true motion by at least half, its damping is known so well */
#define POWERLESS_M 1.30F
#define MOVED_M 0.30F
#define AGREED_S 1.5F
#define ALOFT_M 0.08F
#define PUSH_N 0.7F
#define VAIN_S 3.0F
#define VAIN_MPS 0.12F
#define VAIN_M 0.15F
#define RUN_AWAY_MPS 0.7F
#define RUN_AWAY_M 0.38F
#define STILL_MPS 0.2F
#define CONTENT_M 0.10F /* a law that is where it wants to be has nothing that a lie could do */
#define CONTENT_SHARE 1.8F
#define UNCONFIRMED_M 0.35F
#define UNPROVED_M 0.35F /* chosen: twice what the lift-off of a drawn vehicle shows */
#define UNCONFIRMED_N 0.2F
#define RISE_TIME_S 0.2F
#define WAY_TIME_S 1.0F
#define MOVED_S 1.0F  /* chosen: what the witnesses remember of that time is gone by half */
#define MOVES_M 0.15F /* chosen: no thing in front of a mirror moves so far */

void integrity_init(integrity_t *integrity)
{
    *integrity = (integrity_t){.shaken = 1.0F};
}

bool integrity_doubts(const integrity_t *integrity, uint16_t doubt)
{
    return (integrity->doubts & doubt) != 0U;
}

const char *integrity_doubt_name(uint16_t doubts)
{
    if ((doubts & DOUBT_SIGHT) != 0U) {
        return "SIGHT";
    }
    if ((doubts & DOUBT_IMU) != 0U) {
        return "IMU";
    }
    return ((doubts & DOUBT_THRUST) != 0U) ? "THRUST" : NULL;
}

static void set_doubt(integrity_t *i, uint16_t doubt, bool on)
{
    i->doubts = (uint16_t)(on ? (i->doubts | doubt) : (i->doubts & (uint16_t)~doubt));
}

static void forget(integrity_t *i)
{
    i->felt.off_m = i->felt.seen_m = i->felt.moved_m = 0.0F;
    i->pushed.off_m = i->pushed.seen_m = i->pushed.moved_m = 0.0F;
    i->agreed_s = 0.0F;
}

/* ---- tilt */

static float turn_rad(float from_rad, float to_rad)
{
    const float turn = fabsf(to_rad - from_rad);
    return (turn > HALF_TURN_RAD) ? fabsf(2.0F * HALF_TURN_RAD - turn) : turn;
}

static bool believe_tilt(integrity_t *i, float roll_rad, float pitch_rad, uint32_t time_us)
{
    const bool recent = i->levelled && time_us - i->tilt_time_us <= TILT_GAP_US;
    const bool told = fabsf(roll_rad) < ANGLE_MAX_RAD && fabsf(pitch_rad) < ANGLE_MAX_RAD; /* no NaN */
    const bool jump = turn_rad(i->roll_rad, roll_rad) > JUMP_RAD ||
                      turn_rad(i->pitch_rad, pitch_rad) > JUMP_RAD;

    if (!told) {
        return false;
    }
    i->tilt_time_us = time_us;
    if (recent && jump && i->jumped < JUMPS_HELD) {
        ++i->jumped;
        return false;
    }
    i->levelled = true;
    i->jumped = 0U;
    i->roll_rad = roll_rad;
    i->pitch_rad = pitch_rad;
    if (cosf(roll_rad) * cosf(pitch_rad) >= TILTED_COS) {
        i->tilted = 0U;
    } else if (i->tilted < COUNT_MAX) {
        ++i->tilted;
    }
    return true;
}

void integrity_tilt(integrity_t *integrity, const imu_sample_t *frames, uint16_t count, float roll_rad,
                    float pitch_rad, uint32_t time_us)
{
    for (uint16_t k = imu_first_after(frames, count, integrity->tilt_sequence); k < count; ++k) {
        const imu_sample_t *frame = &frames[k];

        integrity->tilt_sequence = frame->sequence;
        if (!believe_tilt(integrity, frame->median.roll_rad, frame->median.pitch_rad, frame->arrival_us)) {
            integrity->unfit_sequence = frame->sequence;
        }
    }
    if (count == 0U && (!integrity->levelled || time_us != integrity->tilt_time_us)) {
        (void)believe_tilt(integrity, roll_rad, pitch_rad, time_us);
    }
}

/* ---- scans */

static float variance(const float *value)
{
    float mean = 0.0F;
    float square = 0.0F;

    for (uint16_t k = 0U; k < INTEGRITY_SCANS; ++k) {
        mean += value[k] / (float)INTEGRITY_SCANS;
    }
    for (uint16_t k = 0U; k < INTEGRITY_SCANS; ++k) {
        square += (value[k] - mean) * (value[k] - mean);
    }
    return square / (float)(INTEGRITY_SCANS - 1U);
}

static float noise(const float *value)
{
    float square = 0.0F;

    for (uint16_t k = 2U; k < INTEGRITY_SCANS; ++k) {
        const float bend = value[k] - 2.0F * value[k - 1U] + value[k - 2U];
        square += bend * bend;
    }
    return square / (6.0F * (float)(INTEGRITY_SCANS - 2U));
}

/* A beam that is blocked has a length of its own: it does not grow and shrink as the mirror rises and falls
 * with the tilt, and the height made of it does. What is left of the length is white noise. */
static void watch_slant(integrity_t *i, const altitude_t *altitude)
{
    for (uint16_t k = 1U; k < INTEGRITY_SCANS; ++k) {
        i->slants_mm[k - 1U] = i->slants_mm[k];
    }
    i->slants_mm[INTEGRITY_SCANS - 1U] = altitude->slant_mm;
    i->scans = (uint16_t)(i->scans + (i->scans < INTEGRITY_SCANS));
    const float slant_mm2 = variance(i->slants_mm);
    const bool still = i->scans == INTEGRITY_SCANS && slant_mm2 < STILL_MOST_MM2 &&
                       (slant_mm2 < STILL_MM2 || noise(i->slants_mm) > STILL_SHARE * slant_mm2);
    const bool rigid = i->scans == INTEGRITY_SCANS && slant_mm2 < STILL_MM2;
    i->rigid = rigid ? (uint16_t)(i->rigid + (i->rigid < STILL_SCANS)) : 0U;
    i->still = still ? (uint16_t)(i->still + (i->still < STILL_SCANS)) : 0U;
}

bool integrity_scan(integrity_t *integrity, const altitude_t *altitude)
{
    const bool copy = altitude->spread_mm > 0.0F && altitude->slant_mm == integrity->slant_mm &&
                      altitude->spread_mm == integrity->spread_mm;

    integrity->slant_mm = altitude->slant_mm;
    integrity->spread_mm = altitude->spread_mm;
    if (!copy) {
        integrity->copies = 0U;
    } else if (integrity->copies < COUNT_MAX) {
        ++integrity->copies;
    }
    if (altitude->spread_mm > 0.0F && fabsf(altitude->height_mm) <= HEIGHT_MAX_MM) {
        watch_slant(integrity, altitude);
    }
    return integrity->copies < COPIES_MAX && altitude->height_mm >= HEIGHT_MIN_MM &&
           altitude->height_mm <= HEIGHT_MAX_MM;
}

/* ---- witnesses */

static void start(witness_t *witness, float speed_mps)
{
    *witness = (witness_t){.speed_mps = speed_mps};
}

static void move(witness_t *witness, float mps2, float dt_s)
{
    witness->off_m -= (witness->speed_mps + 0.5F * mps2 * dt_s) * dt_s;
    witness->speed_mps += mps2 * dt_s;
    witness->moved_m += fabsf(witness->speed_mps) * dt_s;
    witness->running_s = at_most(witness->running_s + dt_s, OLD_S);
}

static bool counts(const witness_t *witness)
{
    return witness->running_s > WARM_S;
}

/* The accelerometer's witness may be asked. */
static bool feels(const integrity_t *i)
{
    return counts(&i->felt) && !integrity_doubts(i, DOUBT_IMU);
}

static void feel_rest(integrity_t *i, float dt_s)
{
    i->rested_s = at_most(i->rested_s + dt_s, REST_TIME_S);
    i->rest_mps2 += at_most(dt_s / i->rested_s, 1.0F) * (i->up_mps2 - i->rest_mps2);
    i->bias_mps2 = i->rest_mps2;
    start(&i->felt, 0.0F);
    if (i->rested_s > REST_HELD_S && fabsf(i->rest_mps2) > REST_UNFIT_MPS2) {
        set_doubt(i, DOUBT_IMU, true);
    } else if (i->rested_s > REST_HELD_S && fabsf(i->rest_mps2) < REST_FIT_MPS2) {
        set_doubt(i, DOUBT_IMU, false);
    }
}

static void watch_sway(integrity_t *i, const imu_sample_t *frame, float dt_s)
{
    const float share = at_most(dt_s / SWAY_TIME_S, 1.0F);
    const float roll_rad = frame->median.roll_rad - i->mean_rad[0];
    const float pitch_rad = frame->median.pitch_rad - i->mean_rad[1];

    i->mean_rad[0] += share * roll_rad;
    i->mean_rad[1] += share * pitch_rad;
    i->sway_rad2 += share * (roll_rad * roll_rad + pitch_rad * pitch_rad - i->sway_rad2);
}

/* Of the two speeds only what is new counts, as the felt one may be wrong from before, and drift. */
static void watch_still(integrity_t *i, float dt_s)
{
    const bool fell = i->felt.speed_mps < i->still_mps[0] - FELL_MPS;

    if (i->sway_rad2 >= SWAY_RAD2 || fell || i->still_s == 0.0F) {
        i->still_mps[0] = i->felt.speed_mps;
        i->still_mps[1] = i->pushed.speed_mps;
        i->still_s = 0.0F;
    }
    const float share = at_most(dt_s / STILL_TIME_S, 1.0F);
    i->still_mps[0] += share * (i->felt.speed_mps - i->still_mps[0]);
    i->still_mps[1] += share * (i->pushed.speed_mps - i->still_mps[1]);
    i->still_s = (i->sway_rad2 < SWAY_RAD2) ? i->still_s + dt_s : 0.0F;
}

static void watch_fall(integrity_t *i, float dt_s)
{
    watch_still(i, dt_s);
    const float felt_mps = i->felt.speed_mps - i->still_mps[0];
    const float pushed_mps = i->pushed.speed_mps - i->still_mps[1];
    const bool apart = i->pushed.speed_mps < i->felt.speed_mps - FALL_MPS ||
                       (i->still_s > STILL_S && pushed_mps < felt_mps - FALL_STILL_MPS);
    const bool falls = counts(&i->pushed) && counts(&i->felt) && apart && i->pushed.speed_mps < -FALL_MPS;

    i->stands_s = (falls && i->sway_rad2 < SWAY_RAD2) ? i->stands_s + dt_s : 0.0F;
}

static void feel(integrity_t *i, const flown_t *flown, const imu_sample_t *frame)
{
    const uint32_t gap_us = frame->arrival_us - i->frame_time_us;
    const float dt_s = (float)gap_us * 1.0e-6F;
    const float before_mps2 = i->up_mps2;

    i->frame_time_us = frame->arrival_us;
    i->up_mps2 = motion_up_mps2(frame);
    if (gap_us > FRAME_GAP_US) {
        i->rested_s = 0.0F;
        i->rest_mps2 = i->up_mps2;
        start(&i->felt, counts(&i->pushed) ? i->pushed.speed_mps : 0.0F);
        return;
    }
    watch_sway(i, frame, dt_s);
    if (flown->grounded) {
        feel_rest(i, dt_s);
    } else {
        i->rested_s = 0.0F;
        watch_fall(i, dt_s);
        if (i->unheard_s < UNHEARD_S) {
            i->bias_mps2 += dt_s / BIAS_TIME_S * (flown->bias_mps2 - i->bias_mps2);
        }
        move(&i->felt, 0.5F * (before_mps2 + i->up_mps2) - i->bias_mps2, dt_s);
        if (flown->standing) {
            i->felt.speed_mps *= 1.0F - dt_s / STANDING_TIME_S;
            i->felt.running_s = 0.0F;
        }
    }
}

void integrity_frames(integrity_t *integrity, const flown_t *flown, const imu_sample_t *frames,
                      uint16_t count)
{
    for (uint16_t k = imu_first_after(frames, count, integrity->frame_sequence); k < count; ++k) {
        const imu_sample_t *frame = &frames[k];
        const bool fit = (int32_t)(frame->sequence - integrity->unfit_sequence) > 0;
        if (fit && frame->ready && frame->has_acceleration && fabsf(motion_up_mps2(frame)) < UP_MAX_MPS2) {
            integrity->frame_sequence = frame->sequence;
            feel(integrity, flown, frame);
        }
    }
}

void integrity_thrust(integrity_t *integrity, const flown_t *flown)
{
    const float dt_s = at_most(flown->step_s, STEP_MAX_S);
    const float upright = cosf(integrity->roll_rad) * cosf(integrity->pitch_rad);

    if (flown->ordered && flown->grounded) {
        set_doubt(integrity, DOUBT_SIGHT | DOUBT_THRUST, false);
        forget(integrity);
    }
    const bool stands = integrity->heard && integrity->height_m < LOW_M && !integrity_sways(integrity);
    const float shaken = at_least(flown->noise_mps2 / SHAKEN_MPS2, 1.0F);
    integrity->shaken = shaken * sqrtf(shaken);
    integrity->unheard_s = at_most(integrity->unheard_s + dt_s, OLD_S);
    integrity->standing = flown->grounded || flown->standing;
    integrity->lagged_n += dt_s / (LAG_S + dt_s) * (flown->thrust_n - integrity->lagged_n);
    if (!flown->off_ground || stands) {
        start(&integrity->pushed, flown->grounded || !feels(integrity) ? 0.0F : integrity->felt.speed_mps);
        return;
    }
    const float excess_mps2 = flown->authority_mps2_per_n * (integrity->lagged_n * upright - flown->hover_n);
    const float mps2 = (excess_mps2 - flown->damping_per_s * integrity->pushed.speed_mps) /
                       (1.0F + flown->damping_per_s * dt_s);
    move(&integrity->pushed, mps2, dt_s);
}

float integrity_speed_mps(const integrity_t *integrity)
{
    const bool felt = counts(&integrity->felt) && !integrity_doubts(integrity, DOUBT_IMU);
    const bool pushed = counts(&integrity->pushed) && !integrity_doubts(integrity, DOUBT_THRUST);

    if (felt && pushed) {
        return 0.5F * (integrity->felt.speed_mps + integrity->pushed.speed_mps);
    }
    return felt ? integrity->felt.speed_mps : pushed ? integrity->pushed.speed_mps : 0.0F;
}

/* ---- heights against the witnesses */

static bool follows(const witness_t *witness, float rise_m, float gap_s)
{
    return witness->running_s > 0.0F &&
           fabsf(rise_m - witness->speed_mps * gap_s) <= STEP_M + GAP_ALLOWS_MPS * gap_s;
}

static void compare(witness_t *witness, float rise_m, float gap_s, float age_s, float leak_per_s,
                    float pull_per_s2)
{
    witness->off_m += rise_m;
    const float seen_m = witness->off_m + witness->speed_mps * age_s;
    witness->off_m -= at_most(leak_per_s * gap_s, 1.0F) * seen_m;
    witness->speed_mps += pull_per_s2 * gap_s * seen_m;
    witness->seen_m = seen_m;
}

/* The first climb that shows in the heights: what was foretold by a thrust that was not known yet is
 * forgotten. */
static void confirm(integrity_t *i)
{
    i->pushed.speed_mps = i->rise_mps;
    forget(i);
}

/* Back where a glitch began: nothing came nearer. */
static bool returns(const integrity_t *i, float height_m)
{
    return i->since_rise_s < GLITCH_S && fabsf(height_m - i->before_rise_m) < STEP_M;
}

/* A thing in front of a mirror stays where it is: heights that move on and on are not made by one. */
static bool heights_move(const integrity_t *i)
{
    return fabsf(i->way_m) > MOVES_M;
}

static bool heights_moved(const integrity_t *i)
{
    return i->unmoved_s < MOVED_S;
}

/* A take-off is unconfirmed too. */
static void hear(integrity_t *i, float height_m, float gap_s, float age_s)
{
    const float rise_m = height_m - i->height_m;
    const bool fresh = i->heard && gap_s < GAP_MAX_S;
    const bool jumps = fabsf(rise_m) > STEP_M;
    const bool step = fresh && jumps && !follows(&i->felt, rise_m, gap_s) &&
                      !follows(&i->pushed, rise_m, gap_s);
    const float age = i->felt.running_s / OLD_S;

    i->proved = i->proved && !i->standing;
    if (i->standing || (step && rise_m < 0.0F && !returns(i, height_m))) {
        i->unconfirmed = true;
        i->near_m = height_m;
        i->quiet_s = 0.0F;
    } else if (!fresh || rise_m > STEP_M || height_m > i->near_m + CONFIRMED_M ||
               (i->quiet_s > QUIET_S && !integrity_still(i))) {
        if (i->unconfirmed && !i->proved) {
            i->proved = true;
            confirm(i);
        }
        i->unconfirmed = false;
    }
    i->way_m = (step || !fresh) ? 0.0F : i->way_m * (1.0F - at_most(gap_s / WAY_TIME_S, 1.0F)) + rise_m;
    i->unmoved_s = heights_move(i)    ? 0.0F
                   : (step || !fresh) ? MOVED_S
                                      : at_most(i->unmoved_s + gap_s, MOVED_S);
    i->since_rise_s = (step && rise_m > 0.0F) ? 0.0F : at_most(i->since_rise_s + gap_s, GAP_MAX_S);
    i->before_rise_m = (i->since_rise_s > 0.0F) ? i->before_rise_m : i->height_m;
    i->height_m = height_m;
    i->heard = true;
    i->rise_mps += gap_s / (RISE_TIME_S + gap_s) *
                   ((step ? i->rise_mps : rise_m / at_least(gap_s, 0.01F)) - i->rise_mps);
    i->steps = at_least(i->steps * (1.0F - at_most(gap_s / STEPS_TIME_S, 1.0F)), 0.0F) + (step ? 1.0F : 0.0F);
    if (!fresh) {
        i->felt.off_m = 0.0F;
        i->pushed.off_m = 0.0F;
        return;
    }
    compare(&i->felt, step ? i->felt.speed_mps * gap_s : rise_m, gap_s, age_s, FELT_LEAK_PER_S * age,
            integrity_doubts(i, DOUBT_SIGHT) ? 0.0F : FELT_PULL_PER_S2 * age);
    compare(&i->pushed, step ? i->pushed.speed_mps * gap_s : rise_m, gap_s, age_s, PUSHED_LEAK_PER_S, 0.0F);
}

/* ---- verdicts */

/* Heights went one way, and this witness another. */
static bool against(const witness_t *witness, float at_least_m)
{
    return counts(witness) && fabsf(witness->seen_m) > at_least_m;
}

/* In steps of the accelerometer's own noise, where that is large. */
static float felt_off_m(const integrity_t *i)
{
    return i->felt.seen_m / i->shaken;
}

static bool feels_against(const integrity_t *i, float at_least_m)
{
    return feels(i) && fabsf(felt_off_m(i)) > at_least_m;
}

/* The law pushes where it wants to go, and the heights do not. */
static bool pushes_in_vain(const integrity_t *i, const flown_t *flown, float least_n)
{
    const float push_n = i->lagged_n - flown->hover_n;
    return fabsf(push_n) > least_n && push_n * flown->wanted_m > 0.0F && i->pushed.seen_m * push_n < 0.0F;
}

/* Both tell a climb (or a fall) that the heights do not show. */
static bool both_run_away(const integrity_t *i)
{
    const float felt_mps = (i->felt.speed_mps - i->rise_mps) / i->shaken;
    const float pushed_mps = i->pushed.speed_mps - i->rise_mps;
    return fabsf(i->rise_mps) < STILL_MPS && felt_mps * pushed_mps > 0.0F &&
           felt_mps * i->felt.seen_m < 0.0F && at_most(fabsf(felt_mps), fabsf(pushed_mps)) > RUN_AWAY_MPS &&
           at_most(fabsf(felt_off_m(i)), fabsf(i->pushed.seen_m)) > RUN_AWAY_M;
}

/* It should still stand, by the law, and by a beam that is still or tells a height without a ground; but it
 * sways, and has felt a climb. */
static bool aloft_unseen(const integrity_t *i, const flown_t *flown)
{
    const bool odd = i->rigid >= RIGID_SCANS || (i->height_m > LOW_M && integrity_still(i));

    return flown->standing && i->unconfirmed && odd && integrity_sways(i) && i->felt_least_m < -ALOFT_M;
}

/* The thrust tells of a motion, and the beam of none at all. */
static bool still_against(const integrity_t *i)
{
    const bool felt = !feels(i) ||
                      (i->felt.seen_m * i->pushed.seen_m > 0.0F && feels_against(i, STILL_FELT_M));
    const bool rigid = i->rigid >= RIGID_SCANS;
    const bool both = feels_against(i, STILL_BOTH_M) && against(&i->pushed, STILL_BOTH_M);

    return (felt && both && rigid) ||
           ((felt || rigid) && against(&i->pushed, BOTH_M) && i->still == STILL_SCANS);
}

/* Both tell of a motion that the heights do not show. */
static bool both_against(const integrity_t *i, const flown_t *flown)
{
    const float felt_m = felt_off_m(i);
    const float pushed_m = i->pushed.seen_m;
    const float sure = (fabsf(flown->wanted_m) < CONTENT_M) ? CONTENT_SHARE : 1.0F;

    return feels(i) && counts(&i->pushed) && felt_m * pushed_m > 0.0F &&
           at_least(fabsf(felt_m), fabsf(pushed_m)) > sure * AGAINST_M &&
           at_most(fabsf(felt_m), fabsf(pushed_m)) > sure * BOTH_M;
}

static bool vain_since_step(const integrity_t *i, const flown_t *flown)
{
    const float pushed_m = i->pushed.seen_m;

    return i->unconfirmed && (i->proved || i->felt_least_m < -WITH_M) && i->pushed.running_s >= OLD_S &&
           fabsf(pushed_m) > UNCONFIRMED_M && pushes_in_vain(i, flown, UNCONFIRMED_N) &&
           !(feels_against(i, WITH_M) && felt_off_m(i) * pushed_m < 0.0F);
}

/* The first climb is felt by an accelerometer that was right at rest a moment ago, while what thrust carries
 * the vehicle is not known yet, and no height has moved since the ground. */
static bool unproved_against(const integrity_t *i)
{
    return i->unconfirmed && !i->proved && !heights_move(i) && feels(i) && felt_off_m(i) < -UNPROVED_M;
}

static bool sight_is_wrong(const integrity_t *i, const flown_t *flown)
{
    const bool stiff = i->rigid == STILL_SCANS &&
                       integrity_sways(i); /* the mirror swings, the beam does not */

    if (i->steps > STEPS_MAX || stiff || aloft_unseen(i, flown)) {
        return true;
    }
    if (heights_moved(i)) {
        return false;
    }
    if (still_against(i) || unproved_against(i)) {
        return true;
    }
    if (feels(i) && counts(&i->pushed)) {
        return both_run_away(i) || vain_since_step(i, flown) ||
               (fabsf(i->rise_mps) < STILL_MPS && both_against(i, flown));
    }
    if (counts(&i->pushed)) {
        return vain_since_step(i, flown) || i->vain_s > VAIN_S;
    }
    return feels_against(i, ALONE_M);
}

/* The thrust that carries it may have been learned from the accelerometer: against heights that move the two
 * are one. */
static bool imu_is_wrong(const integrity_t *i, const flown_t *flown)
{
    const bool alone = !against(&i->pushed, at_least(WITH_M, ALONE_SHARE * fabsf(i->felt.seen_m))) ||
                       i->felt.seen_m * i->pushed.seen_m < 0.0F;

    if (integrity_still(i) || unproved_against(i)) {
        return false;
    }
    return (feels_against(i, ALONE_M) && counts(&i->pushed) && alone) ||
           (heights_move(i) && feels_against(i, AGAINST_M) && both_against(i, flown));
}

static bool thrust_is_wrong(const integrity_t *i, const flown_t *flown)
{
    if (!i->proved && !flown->displaced) {
        return false;
    }
    if (flown->displaced) {
        return true;
    }
    return fabsf(flown->wanted_m) > VAIN_M && against(&i->pushed, POWERLESS_M) && feels(i) &&
           !feels_against(i, WITH_M) && pushes_in_vain(i, flown, PUSH_N);
}

static bool agrees(const integrity_t *i)
{
    const witness_t *mover = counts(&i->pushed) ? &i->pushed : &i->felt;

    return !feels_against(i, WITH_M) && !against(&i->pushed, WITH_M) && mover->moved_m > MOVED_M;
}

static void judge_again(integrity_t *i, float gap_s)
{
    const bool seen = heights_move(i) && i->steps < STEPS_MAX;

    i->agreed_s = (agrees(i) && i->still < STILL_SCANS) ? i->agreed_s + gap_s : 0.0F;
    if (i->agreed_s > AGREED_S || (seen && integrity_doubts(i, DOUBT_SIGHT))) {
        i->doubts &= (uint16_t) ~(DOUBT_SIGHT | DOUBT_THRUST);
        forget(i);
    } else if (feels_against(i, AGAINST_M) || against(&i->pushed, AGAINST_M)) {
        forget(i);
    }
}

static float lost_m(const integrity_t *i)
{
    const bool both = counts(&i->felt) && counts(&i->pushed) && !integrity_doubts(i, DOUBT_IMU);
    return both ? 0.5F * (i->felt.seen_m + i->pushed.seen_m)
                : (counts(&i->pushed) ? i->pushed.seen_m : i->felt.seen_m);
}

static void judge(integrity_t *i, const flown_t *flown, float gap_s)
{
    if (!integrity_doubts(i, DOUBT_IMU) && imu_is_wrong(i, flown)) {
        set_doubt(i, DOUBT_IMU, true);
        forget(i);
    }
    if (integrity_doubts(i, DOUBT_SIGHT | DOUBT_THRUST)) {
        judge_again(i, gap_s);
    } else if (sight_is_wrong(i, flown)) {
        set_doubt(i, DOUBT_SIGHT, true);
        i->lost_m = lost_m(i);
        forget(i);
    } else if (thrust_is_wrong(i, flown)) {
        set_doubt(i, DOUBT_THRUST, true);
        i->held_n = flown->hover_n;
        i->held_down = flown->wanted_m < 0.0F;
        forget(i);
    }
}

void integrity_height(integrity_t *integrity, const flown_t *flown, float height_m, float gap_s, float age_s)
{
    hear(integrity, height_m, gap_s, age_s);
    integrity->unheard_s = integrity_doubts(integrity, DOUBT_SIGHT) ? integrity->unheard_s : 0.0F;
    integrity->felt_least_m = integrity->unconfirmed ? at_most(integrity->felt_least_m, felt_off_m(integrity))
                                                     : 0.0F;
    integrity->vain_s = (pushes_in_vain(integrity, flown, PUSH_N) && fabsf(integrity->rise_mps) < VAIN_MPS &&
                         fabsf(flown->wanted_m) > VAIN_M)
                            ? integrity->vain_s + gap_s
                            : 0.0F;
    integrity->quiet_s = (flown->wanted_m < QUIET_M) ? integrity->quiet_s + gap_s : 0.0F;
    if (!flown->ours) {
        forget(integrity);
        start(&integrity->felt, integrity->rise_mps);
    } else if (!flown->grounded) {
        judge(integrity, flown, gap_s);
    }
}

float integrity_felt_mps(const integrity_t *integrity)
{
    return feels(integrity) ? integrity->felt.speed_mps / integrity->shaken : 0.0F;
}

bool integrity_unconfirmed(const integrity_t *integrity)
{
    return integrity->unconfirmed;
}

bool integrity_still(const integrity_t *integrity)
{
    return integrity->still > STILL_SCANS / 2U;
}

bool integrity_sways(const integrity_t *integrity)
{
    return integrity->sway_rad2 > SWAY_AIR_RAD2;
}

bool integrity_may_stand(const integrity_t *integrity)
{
    return integrity->still_s > STILL_S;
}

bool integrity_stands(const integrity_t *integrity)
{
    return integrity->stands_s > STANDS_S;
}
