/* Consistency check of heights, accelerometer and thrust; integrity.h explains the idea and the word witness.
 * The source is analytical redundancy, any text on fault detection; PX4's EKF2 has a simpler kinematic
 * consistency check of its range finder.
 *
 * Each innovation goes into a leaky sum, because a wrong sensor contradicts the others for seconds and noise
 * does not. The leak also forgets the slow errors of a witness: bias of the accelerometer, wrong hover thrust
 * or damping. The witness of the accelerometer is a third-order observer, corrected slowly by the heights. It
 * has a bias of its own: the estimator's bias also contains errors of the thrust model, so with it a wrong
 * thrust model would move both witnesses. The witness of the thrust needs no such correction, because the
 * damping bounds its speed.
 *
 * What breaks: a limit that is too low doubts a healthy sensor in a gust, and the vehicle then descends. A
 * limit that is too high lets a wrong sensor move the vehicle by that much. Unless a comment says otherwise
 * the limits are chosen; `make campaign ARGS=--faults` flies them against faults. */
#include "control/integrity.h"

#include <math.h>
#include <stddef.h>

#include "control/angle.h"
#include "control/between.h"
#include "control/credible.h"

/* Tilt. */
#define JUMP_RAD 0.35F       /* chosen: 20 degrees within a frame of 25 ms, 800 degrees a second */
#define STEADY_MIN_RAD 0.05F /* chosen: 110 degrees a second, faster than an attitude that is held */
#define STEADY_MAX_RAD 0.25F /* as FOLLOWS_RAD in attitude.c; a spike or a lost frame makes one step more */
#define JUMPS_HELD 6U        /* chosen: a burst of six bad frames shows in six medians */
#define ANGLE_MAX_RAD 7.0F   /* chosen: above 2 pi */
#define TILT_GAP_US UINT32_C(250000) /* ten frames of 25 ms: after such a gap any tilt is accepted */

/* Scans. With a sensor noise of 3 mm, chance makes two scans with the same digits once in some thousands. */
#define COPIES_MAX 1U   /* chosen: the second identical scan is rejected; one in a climb misleads the law */
#define COUNT_MAX 1000U /* chosen: counters stop here and do not wrap */
#define HEIGHT_BACK_MM (-30.0F) /* chosen: hysteresis of 20 mm, above five times the noise */

/* Blocked beam. Tried: 960 healthy flights; in none does the thrust contradict the heights while the slant is
 * so still. */
#define STILL_MM2 4.0F /* tried, see above: 2 mm rms */
#define RIGID_SCANS 2U /* chosen: one scan alone may be chance */
#define STILL_MOST_MM2 \
    64.0F /* chosen: 8 mm rms, above the noise of any drawn sensor; bars on a floor make more */
#define STILL_SHARE 0.4F   /* chosen: white noise alone makes 1, a swinging slant next to 0 */
#define STILL_SCANS 16U    /* chosen: 1.6 s of scans */
#define NOISE_SCANS 19U    /* tried: at 16 one of 40 healthy flights in FLOATING was doubted */
#define WHITE_SCANS 40U    /* tried: 120 healthy drawn flights reach 24, a blocked beam 40 within 4 to 6 s */
#define STILL_BOTH_M 0.10F /* chosen: low, because the still slant is evidence too */
#define FLAT_FELT_M 0.15F  /* chosen: half of BOTH_M; the thrust must then show AGAINST_M */
#define FLAT_SCANS 6U      /* tried: without it 1 of 100 healthy flights of climb rates was doubted */
#define STILL_FELT_M 0.05F /* chosen: half of that; the thrust must then show BOTH_M */

/* Accelerometer at rest. */
#define REST_TIME_S 2.0F     /* chosen: a mean of 80 frames */
#define REST_HELD_S 1.0F     /* chosen: 40 frames */
#define REST_UNFIT_MPS2 1.5F /* the largest bias that the estimator represents, BIAS_MAX_MPS2 */
#define REST_FIT_MPS2 1.2F   /* chosen: hysteresis of a fifth */

/* Witnesses. */
#define STEP_MAX_S 0.5F        /* chosen: longer pauses count as this long; as in flight.c */
#define SHAKEN_MPS2 0.9F       /* chosen: about twice the usual noise, NOISE_START_MPS2 in estimator.c */
#define OLD_S 2.0F             /* chosen: full leak and correction after that time */
#define WARM_S 0.5F            /* chosen: five scans before a witness counts */
#define STANDING_TIME_S 1.0F   /* chosen: on the ground the felt speed decays, the bias must not add up */
#define LAG_S 0.15F            /* LAG of 0.12 s and DELAY of 18.5 ms, as one lag */
#define FELT_LEAK_PER_S 1.8F   /* chosen: 2 x 0.9, critically damped without the bias, poles at 0.9 1/s */
#define FELT_PULL_PER_S2 0.81F /* 0.9 squared, see FELT_LEAK_PER_S */
#define BIAS_PULL_PER_S3 0.1F  /* chosen: the bias follows in 8 s, 0.81 / 0.1; slower than the verdicts */
#define PUSHED_LEAK_PER_S 0.4F /* chosen: time constant of 2.5 s, as the sure hover thrust in flight.c */

/* Heights. */
#define STEP_M 0.10F         /* chosen: above INNOVATION_LIMIT_MAX_M in estimator.c, 0.08 m */
#define LOW_M 0.08F          /* chosen: as LOW_MM in flight.c */
#define GAP_ALLOWS_MPS 0.3F  /* chosen: the speed error of a witness that still counts as agreement */
#define CONFIRMED_M 0.12F    /* chosen: just above STEP_M */
#define TERRAIN_FALL_M 0.40F /* chosen: above the edge of the seed's course, 0.25 m */
#define PULLED_TIME_S 2.0F   /* chosen: as OLD_S */
#define SUNK_M 0.025F        /* chosen: five times the noise of a height; no vehicle flies below its ground */
#define SUNK_SCANS 3U        /* chosen: 0.3 s */
#define QUIET_S 1.0F         /* tried: 60 drawn vehicles whose blocked beam shows the reference; ten scans */
#define QUIET_M 0.10F        /* chosen: as CONTENT_M */
#define GLITCH_S 0.25F       /* chosen: two scans and a half */
#define STEPS_TIME_S 2.0F    /* chosen: 20 scans */
#define STEPS_MAX 12.0F      /* chosen: more than half of the scans of STEPS_TIME_S are steps */

/* Standing on the ground. The thrust predicts a fall, and the accelerometer does not measure one. */
#define FALL_MPS 0.8F        /* chosen: above SINK_MAX_MPS in est_law.c, 0.6 m/s */
#define STANDS_S 0.6F        /* chosen: 24 frames */
#define SWAY_TIME_S 1.5F     /* chosen: 60 frames */
#define SPIKE_RAD2 1.2e-3F   /* chosen: 2 degrees; a wrong frame in ten on the ground is no sway of the air */
#define SWAY_RAD2 2.5e-4F    /* chosen: 0.9 degrees rms, both angles together; in the air it sways more */
#define STILL_S 1.0F         /* chosen: two thirds of SWAY_TIME_S */
#define STILL_TIME_S 2.0F    /* chosen: a bias of 0.15 m/s2 makes 0.3 m/s in that time */
#define FELL_MPS 0.4F        /* chosen: half of FALL_MPS */
#define FALL_STILL_MPS 0.5F  /* chosen: above FELL_MPS */
#define ROCKED_RAD 0.017F    /* chosen: 1 degree, four times the noise of an angle */
#define ROCKED_BELOW_M 0.10F /* as LANDED_NO_MORE_M in touchdown.h */
#define ROCKED_S 0.8F        /* chosen: 32 frames; at 0.5 s 2 of 96 blocked flights rested in the air */
#define SWAY_HAND_RAD2 0.012F     /* chosen: 6 degrees rms; who tilts a vehicle by hand tilts it more */
#define CARRIED_S 1.5F            /* chosen: above ROCKED_S, so that a nudge on the ground starts nothing */
#define CARRIED_TIME_S 2.0F       /* chosen: above the period of a pilot's swings */
#define CARRIED_BIAS_TIME_S 20.0F /* chosen: ten times that; the bias was measured at rest */
#define SWAYING_S 1.5F        /* chosen: 15 scans; a lift-off that the heights see takes less than a second */
#define STRONG_SHARE 1.3F     /* chosen: of GRAV; lifts the heaviest vehicle, 1.2 of GRAV, at 0.8 m/s2 */
#define STRONG_COUNTS 3.0F    /* chosen: then half a second is enough, which lifts it by 0.1 m */
#define SWAYING_M 0.05F       /* chosen: ten times the noise of a height */
#define SWAY_AIR_RAD2 4.0e-4F /* chosen: 1.1 degrees rms; between this and SWAY_RAD2 neither is certain */

/* Verdicts. These limits have to be above the drift of the witnesses in healthy flights. A wrong sensor may
 * move the vehicle by about as much before it is doubted. */
#define AGAINST_M 0.50F      /* chosen: five times STEP_M */
#define BOTH_M 0.28F         /* chosen: about half of AGAINST_M, for the second witness */
#define WITH_M 0.20F         /* chosen: less than that counts as agreement */
#define ALONE_M 0.60F        /* chosen: above AGAINST_M, because only one witness contradicts */
#define ALONE_SHARE 0.4F     /* chosen: with the damping wrong, the thrust still shows half of a motion */
#define NO_AUTHORITY_M 1.30F /* chosen: twice ALONE_M; wrong hover thrust alone makes this witness drift */
#define MOVED_M 0.30F        /* chosen: above BOTH_M, so that the agreement is about a real motion */
#define AGREED_S 1.5F        /* chosen: 15 scans */
#define ALOFT_M 0.08F        /* chosen: as LOW_M */
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
#define STILL_MPS 0.2F       /* chosen: heights that change more slowly do not move */
#define CONTENT_M 0.10F      /* chosen: a law so near its reference is not misled by a wrong height */
#define CONTENT_SHARE 1.8F   /* chosen: near the reference the limits nearly double */
#define ALIVE_SHARE 1.4F     /* tried: 1.8 helps no more; a slant that changes with the tilt is not blocked */
#define UNCONFIRMED_M 0.35F  /* chosen: above BOTH_M; the climb is slow meanwhile */
#define UNPROVED_M 0.35F     /* chosen: twice what the lift-off of a drawn vehicle shows */
#define UNCONFIRMED_N 0.2F   /* chosen: a small part of PUSH_N, because the climb is slow */
#define RISE_TIME_S 0.2F     /* chosen: two scans */
#define WAY_TIME_S 1.0F      /* chosen: ten scans */
#define MOVED_S 1.0F         /* chosen: as WAY_TIME_S */
#define MOVES_M 0.15F        /* chosen: nothing in front of a mirror moves so far */
#define MOVED_LEAST_M 0.10F  /* tried 0.10 and 0.15: with the latter a steep ramp was doubted, 2 of 600 */

void integrity_init(integrity_t *integrity)
{
    *integrity = (integrity_t){.shaken = 1.0F, .upright = 1.0F};
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

/* Clears the sums of the innovations. */
static void forget(integrity_t *i)
{
    i->felt.off_m = i->felt.seen_m = i->felt.moved_m = 0.0F;
    i->pushed.off_m = i->pushed.seen_m = i->pushed.moved_m = 0.0F;
    i->agreed_s = 0.0F;
}

/* From now on the question is whether a climb shows in the heights: forgets that they showed more than the
 * witnesses. */
static void forget_sinking(integrity_t *i)
{
    i->felt.off_m = at_most(i->felt.off_m, 0.0F);
    i->pushed.off_m = at_most(i->pushed.off_m, 0.0F);
}

/* ---- tilt */

/* One axis of turns_on(). */
static bool turns_steadily(float accepted_rad, float before_rad, float now_rad, uint16_t frames)
{
    const float step_rad = turn_rad(before_rad, now_rad);
    const float rest_rad = turn_rad(accepted_rad, now_rad) - (float)frames * step_rad;

    return fabsf(step_rad) > STEADY_MIN_RAD && fabsf(step_rad) < STEADY_MAX_RAD &&
           fabsf(rest_rad) < STEADY_MAX_RAD;
}

/* The tilts that were rejected go on turning, and at the same rate they have turned since the accepted one:
 * the vehicle turns over, and a spike or a lost frame made the jump. Bad frames jump and then turn
 * differently. */
static bool turns_on(const integrity_t *i, float roll_rad, float pitch_rad)
{
    const uint16_t frames = (uint16_t)(i->jumped + 1U);

    return i->jumped > 0U && (turns_steadily(i->roll_rad, i->told_rad[0], roll_rad, frames) ||
                              turns_steadily(i->pitch_rad, i->told_rad[1], pitch_rad, frames));
}

/* Accepts or rejects one tilt. True: accepted. */
static bool accept_tilt(integrity_t *i, float roll_rad, float pitch_rad, uint32_t time_us)
{
    const bool recent = i->levelled && time_us - i->tilt_time_us <= TILT_GAP_US;
    const bool told = fabsf(roll_rad) < ANGLE_MAX_RAD && fabsf(pitch_rad) < ANGLE_MAX_RAD; /* no NaN */
    const bool jump = arc_rad(i->roll_rad, roll_rad) > JUMP_RAD ||
                      arc_rad(i->pitch_rad, pitch_rad) > JUMP_RAD;

    if (!told) {
        return false;
    }
    i->tilt_time_us = time_us;
    if (recent && jump && i->jumped < JUMPS_HELD && !turns_on(i, roll_rad, pitch_rad)) {
        ++i->jumped;
        i->told_rad[0] = roll_rad;
        i->told_rad[1] = pitch_rad;
        return false;
    }
    i->levelled = true;
    i->jumped = 0U;
    i->roll_rad = roll_rad;
    i->pitch_rad = pitch_rad;
    i->upright = cosf(roll_rad) * cosf(pitch_rad);
    return true;
}

/* Counts tilted frames. The median of a burst of bad frames outlasts it by two: the frame itself must be
 * tilted too. */
static void count_tilted(integrity_t *i, const imu_sample_t *frame)
{
    if (frame->rolled == ATTITUDE_ROLLED_FRAMES) {
        i->tilted = COUNT_MAX;
    } else if (i->upright >= TILTED_COS) {
        i->tilted = 0U;
    } else if (cosf(frame->level.roll_rad) * cosf(frame->level.pitch_rad) < TILTED_COS) {
        i->tilted = (uint16_t)(i->tilted + (i->tilted < COUNT_MAX));
    }
}

void integrity_tilt(integrity_t *integrity, const imu_sample_t *frames, uint16_t count, float roll_rad,
                    float pitch_rad, uint32_t time_us)
{
    for (uint16_t k = imu_first_after(frames, count, integrity->tilt_sequence); k < count; ++k) {
        const imu_sample_t *frame = &frames[k];

        integrity->tilt_sequence = frame->sequence;
        if (!accept_tilt(integrity, frame->median.roll_rad, frame->median.pitch_rad, frame->arrival_us)) {
            integrity->unfit_sequence = frame->sequence;
        }
        count_tilted(integrity, frame);
    }
    if (count == 0U && (!integrity->levelled || time_us != integrity->tilt_time_us)) {
        (void)accept_tilt(integrity, roll_rad, pitch_rad, time_us);
    }
}

/* ---- scans */

/* Sample variance of INTEGRITY_SCANS values. Differences from the first value keep the squares small. */
static float variance(const float *value)
{
    float sum = 0.0F;
    float square = 0.0F;

    for (uint16_t k = 1U; k < INTEGRITY_SCANS; ++k) {
        const float off = value[k] - value[0];
        sum += off;
        square += off * off;
    }
    return (square - sum * sum / (float)INTEGRITY_SCANS) / (float)(INTEGRITY_SCANS - 1U);
}

/* Variance of the white noise in the values: the second difference of white noise has six times its
 * variance, and a smooth motion adds little. */
static float noise(const float *value)
{
    float square = 0.0F;

    for (uint16_t k = 2U; k < INTEGRITY_SCANS; ++k) {
        const float bend = value[k] - 2.0F * value[k - 1U] + value[k - 2U];
        square += bend * bend;
    }
    return square / (6.0F * (float)(INTEGRITY_SCANS - 2U));
}

/* In the air the tilt raises and lowers the mirror, so the slant distance changes with it. The slant of a
 * blocked beam does not change: only white noise is left in it. */
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
    i->flat = i->scans == INTEGRITY_SCANS && slant_mm2 < STILL_MOST_MM2 && i->shaken <= 1.0F;
    i->rigid = rigid ? (uint16_t)(i->rigid + (i->rigid < STILL_SCANS)) : 0U;
    i->still = still ? (uint16_t)(i->still + (i->still < STILL_SCANS)) : 0U;
    if (!integrity_sways(i) || i->height_m < LOW_M) { /* so low it may touch the ground */
        i->white = 0U;
    } else if (still) {
        i->white = (uint16_t)(i->white + (i->white < WHITE_SCANS));
    } else {
        i->white = (uint16_t)(i->white - (i->white > 0U));
    }
}

/* The slant changes by more than white noise, and no step made it so. Or nothing is known about it. */
static bool slant_lives(const integrity_t *i)
{
    return i->still == 0U && (i->scans == INTEGRITY_SCANS || i->scans == 0U);
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
    integrity->below_ground = !(altitude->height_mm >=
                                (integrity->below_ground ? HEIGHT_BACK_MM : HEIGHT_MIN_MM));
    return integrity->copies < COPIES_MAX && !integrity->below_ground && altitude->height_mm <= HEIGHT_MAX_MM;
}

/* ---- witnesses */

/* Starts at a known speed, with empty sums. */
static void start(witness_t *witness, float speed_mps)
{
    *witness = (witness_t){.speed_mps = speed_mps};
}

/* Dead reckoning over one step of dt_s. */
static void move(witness_t *witness, float mps2, float dt_s)
{
    witness->off_m -= (witness->speed_mps + 0.5F * mps2 * dt_s) * dt_s;
    witness->speed_mps += mps2 * dt_s;
    witness->moved_m += fabsf(witness->speed_mps) * dt_s;
    witness->running_s = at_most(witness->running_s + dt_s, OLD_S);
}

/* A witness is valid after its first WARM_S. */
static bool counts(const witness_t *witness)
{
    return witness->running_s > WARM_S;
}

/* The accelerometer's witness is valid and its source is not in doubt. */
static bool acceleration_valid(const integrity_t *i)
{
    return counts(&i->felt) && !integrity_doubts(i, DOUBT_IMU);
}

/* Keeps the bias of three to four seconds ago: the end of a rest is noticed late. */
static void keep_bias(integrity_t *i, float dt_s)
{
    i->block_s += dt_s;
    if (i->block_s > REST_HELD_S) {
        i->block_s = 0.0F;
        for (uint16_t k = 1U; k < INTEGRITY_BLOCKS; ++k) {
            i->kept_bias_mps2[k - 1U] = i->kept_bias_mps2[k];
        }
        i->kept_bias_mps2[INTEGRITY_BLOCKS - 1U] = i->rest_mps2;
    }
}

/* At rest the acceleration is the bias; a large one is a fault. */
static void measure_rest(integrity_t *i, float dt_s)
{
    keep_bias(i, dt_s);
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

/* On the ground as far as the state says, no height, and the tilt sways as in the air: in the hands of a
 * pilot, or in somebody's. Its way up and down is bounded, so the means of speed and acceleration are 0. */
static void watch_carried(integrity_t *i, float mean_mps2, float dt_s)
{
    i->carried_s = (i->swing_rad2 < SWAY_HAND_RAD2) ? at_most(i->carried_s + dt_s, OLD_S) : 0.0F;
    i->bias_mps2 = (i->rested_s > 0.0F) ? i->kept_bias_mps2[0] : i->bias_mps2;
    i->rested_s = 0.0F;
    const float mps2 = mean_mps2 - i->bias_mps2;
    i->felt.speed_mps += mps2 * dt_s - i->felt.speed_mps * dt_s / CARRIED_TIME_S;
    i->bias_mps2 += mps2 * dt_s / CARRIED_BIAS_TIME_S;
}

/* One frame in state GROUND. */
static void watch_ground(integrity_t *i, float mean_mps2, float dt_s)
{
    i->unseen_s = at_most(i->unseen_s + dt_s, OLD_S);
    if (i->unseen_s > HEIGHT_LOST_S && integrity_sways(i) && integrity_rocks(i)) {
        watch_carried(i, mean_mps2, dt_s);
    } else {
        i->carried_s = 0.0F;
        measure_rest(i, dt_s);
    }
}

/* Measures how much roll and pitch sway. */
static void watch_sway(integrity_t *i, const imu_sample_t *frame, float dt_s)
{
    const float share = dt_s / SWAY_TIME_S; /* dt_s is at most FRAME_GAP_US */
    const float roll_rad = frame->median.roll_rad - i->mean_rad[0];
    const float pitch_rad = frame->median.pitch_rad - i->mean_rad[1];

    i->mean_rad[0] += share * roll_rad;
    i->mean_rad[1] += share * pitch_rad;
    const float rad2 = roll_rad * roll_rad + pitch_rad * pitch_rad;
    i->swing_rad2 += share * (rad2 - i->swing_rad2);
    i->sway_rad2 += share * ((i->standing ? at_most(rad2, SPIKE_RAD2) : rad2) - i->sway_rad2);
}

/* Measures how long the tilt has stayed where it is, near the ground. This ends within a second of a
 * touchdown, where sway_rad2 takes three. */
static void watch_rocking(integrity_t *i, const imu_sample_t *frame, float dt_s)
{
    const bool moved = fabsf(frame->median.roll_rad - i->anchor_rad[0]) > ROCKED_RAD ||
                       fabsf(frame->median.pitch_rad - i->anchor_rad[1]) > ROCKED_RAD;

    i->unrocked_s = moved ? 0.0F : at_most(i->unrocked_s + dt_s, ROCKED_S);
    if (moved) {
        i->anchor_rad[0] = frame->median.roll_rad;
        i->anchor_rad[1] = frame->median.pitch_rad;
    }
}

/* Measures how long the tilt has been still. Only changes of the two speeds since then are compared, because
 * the speed of the accelerometer may be wrong from before, and may drift. */
static void watch_still(integrity_t *i, float dt_s)
{
    const bool fell = i->felt.speed_mps < i->still_mps[0] - FELL_MPS;

    if (i->sway_rad2 >= SWAY_RAD2 || fell || i->still_s == 0.0F) {
        i->still_mps[0] = i->felt.speed_mps;
        i->still_mps[1] = i->pushed.speed_mps;
        i->still_s = 0.0F;
    }
    const float share = dt_s / STILL_TIME_S;
    i->still_mps[0] += share * (i->felt.speed_mps - i->still_mps[0]);
    i->still_mps[1] += share * (i->pushed.speed_mps - i->still_mps[1]);
    i->still_s = (i->sway_rad2 < SWAY_RAD2) ? i->still_s + dt_s : 0.0F;
}

/* The thrust predicts a fall that the accelerometer does not measure: the ground carries the vehicle. */
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

/* How the tilt moves. */
static void watch_tilt(integrity_t *i, const imu_sample_t *frame, float dt_s)
{
    watch_sway(i, frame, dt_s);
    if (i->height_m < ROCKED_BELOW_M) {
        watch_rocking(i, frame, dt_s);
    } else {
        i->unrocked_s = 0.0F;
    }
}

/* A frame without accelerations tells that too. */
static void watch_tilt_alone(integrity_t *i, const imu_sample_t *frame)
{
    const uint32_t gap_us = frame->arrival_us - i->tilt_alone_us;

    i->tilt_alone_us = frame->arrival_us;
    if (gap_us <= FRAME_GAP_US) {
        watch_tilt(i, frame, (float)gap_us * 1.0e-6F);
    }
}

/* One accepted frame. up_mps2: what its accelerometer measures. */
static void integrate_frame(integrity_t *i, const flown_t *flown, const imu_sample_t *frame, float up_mps2)
{
    const uint32_t gap_us = frame->arrival_us - i->frame_time_us;
    const float dt_s = (float)gap_us * 1.0e-6F;
    const float before_mps2 = i->up_mps2;

    i->frame_time_us = frame->arrival_us;
    i->up_mps2 = up_mps2;
    if (gap_us > FRAME_GAP_US) {
        i->rested_s = 0.0F;
        i->rest_mps2 = i->up_mps2;
        start(&i->felt, integrity_pushed_mps(i));
        return;
    }
    watch_tilt(i, frame, dt_s);
    if (flown->grounded) {
        watch_ground(i, 0.5F * (before_mps2 + up_mps2), dt_s);
    } else {
        if (i->rested_s > 0.0F && !flown->standing) { /* a pilot has lifted it: that was no rest */
            i->bias_mps2 = 0.0F;
            start(&i->felt, i->rise_mps);
        }
        i->rested_s = 0.0F;
        watch_fall(i, dt_s);
        move(&i->felt, 0.5F * (before_mps2 + up_mps2) - i->bias_mps2, dt_s);
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
        if (!fit || !frame->ready) {
            continue;
        }
        if (!frame->has_acceleration) {
            integrity->frame_sequence = frame->sequence;
            watch_tilt_alone(integrity, frame);
            continue;
        }
        const float up_mps2 = motion_up_mps2(frame);
        if (fabsf(up_mps2) < UP_MAX_MPS2) {
            integrity->frame_sequence = frame->sequence;
            integrate_frame(integrity, flown, frame, up_mps2);
        }
    }
}

void integrity_thrust(integrity_t *integrity, const flown_t *flown)
{
    const float dt_s = at_most(flown->step_s, STEP_MAX_S);

    if (flown->ordered && flown->grounded) {
        set_doubt(integrity, DOUBT_SIGHT | DOUBT_THRUST, false);
        forget(integrity);
    }
    const bool stands = integrity->has_height && integrity->height_m < LOW_M && !integrity_sways(integrity);
    const float shaken = at_least(flown->noise_mps2 / SHAKEN_MPS2, 1.0F);
    integrity->shaken = shaken * sqrtf(shaken);
    integrity->standing = flown->grounded || flown->standing;
    integrity->lagged_n += dt_s / (LAG_S + dt_s) * (flown->thrust_n - integrity->lagged_n);
    if (!flown->off_ground || stands) {
        start(&integrity->pushed,
              flown->grounded || !acceleration_valid(integrity) ? 0.0F : integrity->felt.speed_mps);
        return;
    }
    const float excess_mps2 = flown->authority_mps2_per_n *
                              (integrity->lagged_n * integrity->upright - flown->hover_n);
    const float mps2 = (excess_mps2 - flown->damping_per_s * integrity->pushed.speed_mps) /
                       (1.0F + flown->damping_per_s * dt_s);
    move(&integrity->pushed, mps2, dt_s);
}

float integrity_pushed_mps(const integrity_t *integrity)
{
    const witness_t *pushed = &integrity->pushed;

    return counts(pushed) ? pushed->speed_mps + PUSHED_LEAK_PER_S * pushed->seen_m : integrity->rise_mps;
}

float integrity_moved_m(const integrity_t *integrity)
{
    const witness_t *pushed = &integrity->pushed;

    return counts(pushed) ? pushed->seen_m - pushed->off_m : 0.0F;
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

/* True when this witness explains the change of the height: then the change is no step of the terrain. */
static bool follows(const witness_t *witness, float rise_m, float gap_s)
{
    return witness->running_s > 0.0F &&
           fabsf(rise_m - witness->speed_mps * gap_s) <= STEP_M + GAP_ALLOWS_MPS * gap_s;
}

/* Adds one innovation to the leaky sum. The height is age_s old and the prediction is not, so the sum at the
 * instant of the rays leaves out the way predicted since then. */
static void compare(witness_t *witness, float rise_m, float gap_s, float age_s, float leak_per_s,
                    float pull_per_s2)
{
    witness->off_m += rise_m;
    const float seen_m = witness->off_m + witness->speed_mps * age_s;
    witness->off_m -= at_most(leak_per_s * gap_s, 1.0F) * seen_m;
    witness->speed_mps += pull_per_s2 * gap_s * seen_m;
    witness->seen_m = seen_m;
}

/* The same for the accelerometer: while the heights are not doubted, they also correct its speed and bias. */
static void compare_felt(integrity_t *i, float rise_m, float gap_s, float age_s)
{
    const float age = i->felt.running_s / OLD_S;
    const float pull = integrity_doubts(i, DOUBT_SIGHT) ? 0.0F : age;

    compare(&i->felt, rise_m, gap_s, age_s, FELT_LEAK_PER_S * age, FELT_PULL_PER_S2 * pull);
    i->pulled_m_s += gap_s * (pull * i->felt.seen_m - i->pulled_m_s / PULLED_TIME_S);
    i->bias_mps2 -= BIAS_PULL_PER_S3 * pull * gap_s * i->felt.seen_m;
    i->bias_mps2 = between(-BIAS_MAX_MPS2, i->bias_mps2, BIAS_MAX_MPS2);
}

/* The heights are doubted now: takes back what they have corrected in the witness of the accelerometer. */
static void take_back(integrity_t *i)
{
    i->felt.speed_mps -= FELT_PULL_PER_S2 * i->pulled_m_s;
    i->bias_mps2 = between(-BIAS_MAX_MPS2, i->bias_mps2 + BIAS_PULL_PER_S3 * i->pulled_m_s, BIAS_MAX_MPS2);
    i->pulled_m_s = 0.0F;
}

/* The heights show the first climb. Until now the hover thrust was not known well, so the witness of the
 * thrust restarts from the rate of the heights. */
static void confirm(integrity_t *i)
{
    i->pushed.speed_mps = i->rise_mps;
    forget(i);
}

/* The height is back at its value before a short upward step: that was a glitch, the terrain did not rise. */
static bool returns(const integrity_t *i, float height_m)
{
    return i->since_rise_s < GLITCH_S && fabsf(height_m - i->before_rise_m) < STEP_M;
}

/* A thing in front of a mirror stays where it is. So heights that keep moving do not come from a blocked
 * beam. */
static bool heights_move(const integrity_t *i)
{
    return fabsf(i->way_m) > MOVES_M;
}

/* The same, now or within the last MOVED_S. */
static bool heights_moved(const integrity_t *i)
{
    return i->unmoved_s < MOVED_S;
}

/* After a far fall of the terrain the heights have to show that the vehicle follows it. */
static void watch_depth(integrity_t *i, float height_m, float rise_m, bool step)
{
    if (step) {
        i->terrain_fell = rise_m > TERRAIN_FALL_M;
        i->after_fall_m = height_m;
    } else if (i->standing || height_m < i->after_fall_m - CONFIRMED_M) {
        i->terrain_fell = false;
    }
}

/* A take-off is unconfirmed until a climb shows in the heights, as is a step of the terrain towards the
 * vehicle. A jump is no first climb. */
static void watch_confirmation(integrity_t *i, float height_m, float rise_m, bool step, bool fresh)
{
    i->proved = i->proved && !i->standing;
    const bool first = i->unconfirmed && !i->proved;
    if (i->standing || (step && (first || (rise_m < 0.0F && !returns(i, height_m))))) {
        i->unconfirmed = true;
        i->near_m = height_m;
        i->quiet_s = 0.0F;
        forget_sinking(i);
    } else if (!fresh || rise_m > STEP_M || height_m > i->near_m + CONFIRMED_M || i->quiet_s > QUIET_S) {
        if (first) {
            i->proved = true;
            confirm(i);
        }
        i->unconfirmed = false;
    }
}

/* Processes one height: step or not, confirmed or not, then the innovations of both witnesses. */
static void take_height(integrity_t *i, float height_m, float gap_s, float age_s)
{
    const float rise_m = height_m - i->height_m;
    const bool fresh = i->has_height && gap_s < HEIGHT_LOST_S;
    const bool jumps = fabsf(rise_m) > STEP_M;
    const bool step = fresh && jumps && !follows(&i->felt, rise_m, gap_s) &&
                      !follows(&i->pushed, rise_m, gap_s);

    watch_depth(i, height_m, rise_m, step);
    i->scans = (step && i->scans > 1U) ? 1U : i->scans; /* a step is no motion of the slant */
    watch_confirmation(i, height_m, rise_m, step, fresh);
    i->way_m = (step || !fresh) ? 0.0F : i->way_m * (1.0F - at_most(gap_s / WAY_TIME_S, 1.0F)) + rise_m;
    i->unmoved_s = fabsf(i->way_m) > MOVED_LEAST_M ? 0.0F
                   : (step || !fresh)              ? MOVED_S
                                                   : at_most(i->unmoved_s + gap_s, MOVED_S);
    i->since_rise_s = (step && rise_m > 0.0F) ? 0.0F : at_most(i->since_rise_s + gap_s, HEIGHT_LOST_S);
    i->before_rise_m = (i->since_rise_s > 0.0F) ? i->before_rise_m : i->height_m;
    i->height_m = height_m;
    i->has_height = true;
    const float share = gap_s / (RISE_TIME_S + gap_s);
    i->rise_mps += share * ((step ? i->rise_mps : rise_m / at_least(gap_s, 0.01F)) - i->rise_mps);
    i->slower_mps += share * (at_most(i->felt.speed_mps, i->pushed.speed_mps) - i->slower_mps);
    i->steps = i->steps * (1.0F - at_most(gap_s / STEPS_TIME_S, 1.0F)) + (step ? 1.0F : 0.0F);
    if (!fresh) {
        i->felt.off_m = 0.0F;
        i->pushed.off_m = 0.0F;
        return;
    }
    compare_felt(i, step ? i->felt.speed_mps * gap_s : rise_m, gap_s, age_s);
    compare(&i->pushed, step ? i->pushed.speed_mps * gap_s : rise_m, gap_s, age_s, PUSHED_LEAK_PER_S, 0.0F);
}

/* ---- verdicts */

/* The heights contradict this witness by more than at_least_m. */
static bool against(const witness_t *witness, float at_least_m)
{
    return counts(witness) && fabsf(witness->seen_m) > at_least_m;
}

/* Sum of the accelerometer's innovations, made smaller when the accelerometer is noisy. */
static float felt_off_m(const integrity_t *i)
{
    return i->felt.seen_m / i->shaken;
}

/* The heights contradict the witness of the accelerometer by more than at_least_m. */
static bool acceleration_against(const integrity_t *i, float at_least_m)
{
    return acceleration_valid(i) && fabsf(felt_off_m(i)) > at_least_m;
}

/* Neither witness contradicts the heights by the smallest limit of any rule below. */
static bool both_agree(const integrity_t *i)
{
    return fabsf(i->felt.seen_m) < STILL_FELT_M && fabsf(i->pushed.seen_m) < STILL_BOTH_M;
}

/* The thrust pushes towards the reference by more than least_n, and the heights do not follow. */
static bool pushes_in_vain(const integrity_t *i, const flown_t *flown, float least_n)
{
    const float push_n = i->lagged_n - flown->hover_n;
    return fabsf(push_n) > least_n && push_n * flown->wanted_m > 0.0F && i->pushed.seen_m * push_n < 0.0F;
}

/* Both witnesses have a fast climb (or fall), and the heights do not move. */
static bool both_run_away(const integrity_t *i)
{
    const float felt_mps = (i->felt.speed_mps - i->rise_mps) / i->shaken;
    const float pushed_mps = i->pushed.speed_mps - i->rise_mps;
    return fabsf(i->rise_mps) < STILL_MPS && felt_mps * pushed_mps > 0.0F &&
           felt_mps * i->felt.seen_m < 0.0F && at_most(fabsf(felt_mps), fabsf(pushed_mps)) > RUN_AWAY_MPS &&
           at_most(fabsf(felt_off_m(i)), fabsf(i->pushed.seen_m)) > RUN_AWAY_M;
}

/* Both witnesses climb, and the heights have stopped. A beam may be blocked during a climb, so this does not
 * wait until heights_moved() is over. slower_mps lags like rise_mps: a vehicle that has just turned upwards
 * is not doubted. */
static bool climbs_unseen(const integrity_t *i)
{
    return i->slower_mps - i->rise_mps > UNSEEN_MPS && i->pushed.seen_m < -UNSEEN_PUSHED_M &&
           acceleration_valid(i) && counts(&i->pushed) && felt_off_m(i) < -UNSEEN_FELT_M &&
           fabsf(i->rise_mps) < STILL_MPS;
}

/* The law takes the vehicle to be on the ground still. But the tilt sways as in the air, for long; or the
 * beam is still or its height above the ground, and the accelerometer has measured a climb. */
static bool aloft_unseen(const integrity_t *i, const flown_t *flown)
{
    const bool odd = i->rigid >= RIGID_SCANS || (i->height_m > LOW_M && integrity_still(i));

    return i->swaying_s > SWAYING_S ||
           (flown->standing && i->unconfirmed && odd && integrity_sways(i) && i->felt_least_m < -ALOFT_M);
}

/* The witnesses predict a motion, and the slant is still. */
static bool still_against(const integrity_t *i)
{
    const bool felt = !acceleration_valid(i) ||
                      (i->felt.seen_m * i->pushed.seen_m > 0.0F && acceleration_against(i, STILL_FELT_M));
    const bool rigid = i->rigid >= RIGID_SCANS;
    const bool both = acceleration_against(i, STILL_BOTH_M) && against(&i->pushed, STILL_BOTH_M);

    const bool flat = i->flat && i->white >= FLAT_SCANS && felt && acceleration_against(i, FLAT_FELT_M) &&
                      against(&i->pushed, AGAINST_M);

    return (felt && both && rigid) || flat ||
           ((felt || rigid) && against(&i->pushed, BOTH_M) && i->white >= NOISE_SCANS);
}

/* Both witnesses contradict the heights in the same direction, by that share of the limits. */
static bool both_against(const integrity_t *i, const flown_t *flown, float share)
{
    const bool content = fabsf(flown->wanted_m) < CONTENT_M && !i->flat;
    const float sure = content ? share * CONTENT_SHARE : share;

    if (!against(&i->pushed, sure * BOTH_M)) {
        return false;
    }
    const float felt_m = felt_off_m(i);
    const float pushed_m = i->pushed.seen_m;

    return acceleration_against(i, sure * BOTH_M) && felt_m * pushed_m > 0.0F &&
           at_least(fabsf(felt_m), fabsf(pushed_m)) > sure * AGAINST_M;
}

/* Since a step towards the vehicle the thrust has pushed, and no climb has shown in the heights. The
 * accelerometer does not contradict that. */
static bool vain_since_step(const integrity_t *i, const flown_t *flown)
{
    const float pushed_m = i->pushed.seen_m;
    const bool flew = i->proved || i->near_m > STEP_M; /* a step after the lift-off moves near_m up */

    return i->unconfirmed && (flew || i->felt_least_m < -WITH_M) && i->pushed.running_s >= OLD_S &&
           fabsf(pushed_m) > UNCONFIRMED_M && pushes_in_vain(i, flown, UNCONFIRMED_N) &&
           !(acceleration_against(i, WITH_M) && felt_off_m(i) * pushed_m < 0.0F);
}

/* The first climb after the ground shows in the accelerometer only. It is believed, because it measured g at
 * rest a moment ago. The thrust does not help: the hover thrust is not known yet. */
static bool unproved_against(const integrity_t *i)
{
    return i->unconfirmed && !i->proved && !heights_move(i) && acceleration_valid(i) &&
           felt_off_m(i) < -UNPROVED_M;
}

/* Reasons for DOUBT_SIGHT. Near the ground the accelerometer alone is not believed against heights that move:
 * it misses the knocks of a touchdown on a rough floor. */
static bool sight_is_wrong(const integrity_t *i, const flown_t *flown)
{
    const bool stiff = i->rigid == STILL_SCANS &&
                       integrity_sways(i); /* the tilt sways, and the slant does not change */

    if (i->steps > STEPS_MAX || stiff || i->white == WHITE_SCANS || i->sunk == SUNK_SCANS ||
        aloft_unseen(i, flown) || climbs_unseen(i)) {
        return true;
    }
    if (heights_moved(i) || (acceleration_valid(i) && both_agree(i))) {
        return false;
    }
    if (still_against(i) || unproved_against(i)) {
        return true;
    }
    if (acceleration_valid(i) && counts(&i->pushed)) {
        /* the thrust's witness of a vehicle unlike the model drifts, and the accelerometer's bias may jump */
        const float share = (i->still == 0U) ? ALIVE_SHARE : 1.0F;

        return both_run_away(i) || vain_since_step(i, flown) ||
               (fabsf(i->rise_mps) < STILL_MPS && both_against(i, flown, share));
    }
    if (counts(&i->pushed)) {
        return vain_since_step(i, flown) || i->vain_s > VAIN_S;
    }
    return (i->height_m > LOW_M || integrity_still(i)) && acceleration_against(i, ALONE_M);
}

/* Reasons for DOUBT_IMU. The hover thrust may have been learned from a wrong accelerometer. Then both
 * witnesses have the same error, and heights that move are right against both. */
static bool imu_is_wrong(const integrity_t *i, const flown_t *flown)
{
    const bool alone = !against(&i->pushed, ALONE_SHARE * fabsf(i->felt.seen_m)) ||
                       i->felt.seen_m * i->pushed.seen_m < 0.0F;

    if (both_agree(i) || integrity_still(i) || unproved_against(i)) {
        return false;
    }
    return (acceleration_against(i, ALONE_M) && counts(&i->pushed) && alone) ||
           (heights_move(i) && acceleration_against(i, AGAINST_M) && both_against(i, flown, 1.0F));
}

/* Reasons for DOUBT_THRUST. */
static bool thrust_is_wrong(const integrity_t *i, const flown_t *flown)
{
    return i->proved && fabsf(flown->wanted_m) > VAIN_M && against(&i->pushed, NO_AUTHORITY_M) &&
           acceleration_valid(i) && !acceleration_against(i, WITH_M) && pushes_in_vain(i, flown, PUSH_N);
}

/* Heights and witnesses agree, over a real motion. */
static bool agrees(const integrity_t *i)
{
    const witness_t *mover = counts(&i->pushed) ? &i->pushed : &i->felt;

    return !acceleration_against(i, WITH_M) && !against(&i->pushed, WITH_M) && mover->moved_m > MOVED_M;
}

/* Clears a doubt after enough agreement. */
static void judge_again(integrity_t *i, float gap_s)
{
    const bool seen = heights_move(i) && i->steps < STEPS_MAX;

    i->agreed_s = (agrees(i) && i->still < STILL_SCANS) ? i->agreed_s + gap_s : 0.0F;
    if (i->agreed_s > AGREED_S || (seen && integrity_doubts(i, DOUBT_SIGHT))) {
        i->doubts &= (uint16_t) ~(DOUBT_SIGHT | DOUBT_THRUST);
        forget(i);
    } else if (acceleration_against(i, AGAINST_M) || against(&i->pushed, AGAINST_M)) {
        forget(i);
    }
}

/* Error of the height by the valid witnesses, mean of both when both are valid. */
static float lost_m(const integrity_t *i)
{
    const bool both = counts(&i->felt) && counts(&i->pushed) && !integrity_doubts(i, DOUBT_IMU);
    return both ? 0.5F * (i->felt.seen_m + i->pushed.seen_m)
                : (counts(&i->pushed) ? i->pushed.seen_m : i->felt.seen_m);
}

/* One verdict per height: a new doubt, or the end of one. */
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
        take_back(i);
        forget(i);
    } else if (thrust_is_wrong(i, flown)) {
        set_doubt(i, DOUBT_THRUST, true);
        i->held_n = flown->hover_n;
        i->held_down = flown->wanted_m < 0.0F;
        forget(i);
    }
}

/* How long the tilt has swayed as in the air, and the beam has shown nothing of it. */
static void watch_lift_off(integrity_t *i, const flown_t *flown, float gap_s)
{
    if (!flown->standing) {
        i->swaying_s = 0.0F;
        return;
    }
    const bool strong = i->lagged_n > STRONG_SHARE * flown->hover_n; /* no vehicle stays on the ground */
    const bool sways = i->unconfirmed && integrity_sways(i) && (strong || integrity_still(i));

    if (!sways || fabsf(i->height_m - i->swaying_from_m) > SWAYING_M) {
        i->swaying_s = 0.0F;
        i->swaying_from_m = i->height_m;
    } else {
        i->swaying_s += strong ? STRONG_COUNTS * gap_s : gap_s;
    }
}

void integrity_height(integrity_t *integrity, const flown_t *flown, float height_m, float gap_s, float age_s)
{
    take_height(integrity, height_m, gap_s, age_s);
    integrity->unseen_s = 0.0F;
    integrity->felt_least_m = integrity->unconfirmed ? at_most(integrity->felt_least_m, felt_off_m(integrity))
                                                     : 0.0F;
    watch_lift_off(integrity, flown, gap_s);
    integrity->vain_s = (pushes_in_vain(integrity, flown, PUSH_N) && fabsf(integrity->rise_mps) < VAIN_MPS &&
                         fabsf(flown->wanted_m) > VAIN_M)
                            ? integrity->vain_s + gap_s
                            : 0.0F;
    integrity->ground_m = flown->grounded ? at_most(height_m, 0.0F)
                                          : integrity->ground_m; /* a pilot lifts it */
    integrity->sunk = (height_m < integrity->ground_m - SUNK_M && flown->wanted_m > QUIET_M)
                          ? (uint16_t)(integrity->sunk + (integrity->sunk < SUNK_SCANS))
                          : 0U;
    integrity->quiet_s = (flown->wanted_m < QUIET_M && slant_lives(integrity)) ? integrity->quiet_s + gap_s
                                                                               : 0.0F;
    if (!flown->ours) {
        forget(integrity);
        start(&integrity->felt, integrity->rise_mps);
    } else if (!flown->grounded) {
        judge(integrity, flown, gap_s);
    }
}

float integrity_felt_mps(const integrity_t *integrity)
{
    return acceleration_valid(integrity) ? integrity->felt.speed_mps / integrity->shaken : 0.0F;
}

bool integrity_still(const integrity_t *integrity)
{
    return integrity->still > STILL_SCANS / 2U;
}

bool integrity_apart(const integrity_t *integrity)
{
    return acceleration_valid(integrity) &&
           fabsf(integrity->felt.speed_mps - integrity->rise_mps) > APART_MPS * integrity->shaken;
}

bool integrity_sways(const integrity_t *integrity)
{
    return integrity->sway_rad2 > SWAY_AIR_RAD2;
}

bool integrity_calm(const integrity_t *integrity)
{
    return integrity->sway_rad2 < SWAY_RAD2;
}

bool integrity_rocks(const integrity_t *integrity)
{
    return integrity->unrocked_s < ROCKED_S && integrity->sway_rad2 > SWAY_RAD2;
}

bool integrity_carried(const integrity_t *integrity)
{
    return integrity->carried_s > CARRIED_S;
}

bool integrity_may_stand(const integrity_t *integrity)
{
    return integrity->still_s > STILL_S;
}

bool integrity_stands(const integrity_t *integrity)
{
    return integrity->stands_s > STANDS_S;
}
