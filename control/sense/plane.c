/* Evidence is a difference of logarithms of likelihoods, in nats. The way of mounting that the parameters
 * describe may take any size of noise (the likeliest one), each other way has the stated noise.
 * What breaks: a mirror that is blocked while the vehicle hovers shows what a wrong sign of roll shows. So a
 * scan with a mirror that is believed to lie counts for nothing. */
#include "control/sense/plane.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/seconds.h"

/* 35 rays of 5 mm and 3 mm of each mirror's own (sim/devices/scene.h), 1.5 mm by tilt and climb */
#define MIRROR_NOISE_MM 4.0F
#define FRAME_AGE_US UINT32_C(73600) /* of a median: FRAME_AGE_US and TILT_AGE_US of estimator.c */
#define GAP_LONG_S (HEIGHT_FRESH_S + 0.5F * SCAN_S) /* as long as a height is fresh, give or take */
#define MEANS ((float)ZEROS_MEAN)                   /* 5 s, some swings of the vehicle */
#define FORGET (1.0F - 0.5F / MEANS)                /* of the squares, with twice the scans of their mean */
#define CHANGED 16.0F                               /* 4 sigmas in every way: the ground has changed */
#define SURE_NATS 13.8F /* a million to one: one wrong mounting in 1000, one false name in 1000 of them */

#define OFFSET_SIGMAS 3.0F /* one in 700 when it is off by just that degree */
#define OFFSET_SCANS 10U   /* as ZEROS_SCANS */
/* Of a difference, beyond the noise. Measured: flights of sound vehicles, tools/campaign/mounts.py. */
#define FLOWN_MM 1.5F
#define PLANE_ABOVE 30U /* chosen: 3 s; at a walk it is still where it stood */
#define ABOVE_MOST_MM \
    1500.0F /* there a ray that is 2 degrees aside is off by 2 mm in a sway of 2 degrees \
             */

/* Share of each mirror in the two differences, and the sum of the squares. */
static const float shares[PLANE_COUNT][MIRROR_COUNT] = {
    [PLANE_FORE_AFT] = {[MIRROR_FORE] = 1.0F, [MIRROR_AFT] = -1.0F},
    [PLANE_ABEAM] = {[MIRROR_FRONT] = 1.0F, [MIRROR_FORE] = -0.5F, [MIRROR_AFT] = -0.5F}};
static const float noises_mm2[PLANE_COUNT] = {[PLANE_FORE_AFT] = 2.0F * MIRROR_NOISE_MM * MIRROR_NOISE_MM,
                                              [PLANE_ABEAM] = 1.5F * MIRROR_NOISE_MM * MIRROR_NOISE_MM};

/* Bits of a way's number. 0: as the parameters describe. */
#define WAY_ROLL 1U
#define WAY_PITCH 2U
#define WAY_SWAPPED 4U

static imu_fault_t fault_of(uint16_t way)
{
    static const imu_fault_t faults[] = {IMU_SOUND, IMU_ROLL, IMU_PITCH, IMU_BOTH};

    return ((way & WAY_SWAPPED) != 0U) ? IMU_SWAPPED : faults[way];
}

/* ---- one scan */

/* Roll and pitch that the IMU told of this instant. */
static void told_at(const plane_scan_t *scan, uint32_t instant_us, float told_rad[2])
{
    const imu_sample_t *frames = scan->frames;
    const uint32_t shown_us = instant_us + FRAME_AGE_US;
    uint16_t i = (uint16_t)(scan->frame_count - 1U);
    float share = 1.0F;

    while (i > 1U && (int32_t)(shown_us - frames[i - 1U].arrival_us) < 0) {
        --i;
    }
    const attitude_t *to = &frames[i].median;
    const attitude_t *from = (i > 0U) ? &frames[i - 1U].median : to;
    if (i > 0U && frames[i].arrival_us != frames[i - 1U].arrival_us) {
        share = between(0.0F,
                        seconds_between(frames[i - 1U].arrival_us, shown_us) /
                            seconds_between(frames[i - 1U].arrival_us, frames[i].arrival_us),
                        1.0F);
    }
    told_rad[0] = from->roll_rad + share * (to->roll_rad - from->roll_rad);
    told_rad[1] = from->pitch_rad + share * (to->pitch_rad - from->pitch_rad);
}

static void add_mirror(plane_t *plane, const plane_scan_t *scan, uint16_t m)
{
    const altitude_t *shown = &scan->shown[m];
    float told_rad[2];

    told_at(scan, scan->rays_us + (uint32_t)shown->later_us, told_rad);
    const float upright = cosf(told_rad[0]) * cosf(told_rad[1]);
    const float slopes[2] = {sinf(told_rad[0]), sinf(told_rad[1])};
    for (uint16_t d = 0U; d < PLANE_COUNT; ++d) {
        plane_sight_t *sight = &plane->sights[d];
        const float share = shares[d][m];

        sight->shown_mm += share * ((shown->slant_mm - shown->distance_mm) * upright - shown->leg_mm);
        sight->later_s += share * (float)shown->later_us * 1.0e-6F;
        plane->arm_mm[d] += share * shown->arm_mm;
        plane->fore_mm[d] += share * shown->fore_mm;
        for (uint16_t angle = 0U; angle < 2U; ++angle) {
            sight->by_arm_mm[angle] += share * shown->arm_mm * slopes[angle];
            sight->by_fore_mm[angle] += share * shown->fore_mm * slopes[angle];
        }
    }
    plane->height_mm[0] += shown->height_mm / (float)MIRROR_COUNT;
}

static void look(plane_t *plane, const plane_scan_t *scan)
{
    plane->height_mm[1] = plane->height_mm[0];
    plane->height_mm[0] = 0.0F;
    plane->gap_s = scan->gap_s;
    plane->held = (uint16_t)(plane->held + (plane->held < 2U));
    for (uint16_t d = 0U; d < PLANE_COUNT; ++d) {
        plane->sights[d] = (plane_sight_t){.shown_mm = 0.0F};
        plane->arm_mm[d] = 0.0F;
        plane->fore_mm[d] = 0.0F;
    }
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        add_mirror(plane, scan, m);
    }
}

/* ---- the records */

static float foretold_mm(const plane_sight_t *sight, uint16_t way)
{
    const uint16_t roll = ((way & WAY_SWAPPED) != 0U) ? 1U : 0U;
    const float by_roll_mm = sight->by_arm_mm[roll];
    const float by_pitch_mm = sight->by_fore_mm[1U - roll];

    return (((way & WAY_ROLL) != 0U) ? -by_roll_mm : by_roll_mm) +
           (((way & WAY_PITCH) != 0U) ? -by_pitch_mm : by_pitch_mm);
}

/* Takes one scan over. Returns false when no way explains it: the ground has changed. */
static bool record(plane_record_t *record, const float off_mm[PLANE_WAYS], float noise_mm2)
{
    const float variance_mm2 = noise_mm2 * (1.0F + 1.0F / at_least(record->weight, 1.0F));
    float least = CHANGED + 1.0F;

    for (uint16_t way = 0U; way < PLANE_WAYS && record->weight > 0.0F; ++way) {
        const float rest_mm = off_mm[way] - record->mean_mm[way];
        least = at_most(rest_mm * rest_mm / variance_mm2, least);
    }
    const bool first = record->weight == 0.0F;
    const bool same = least <= CHANGED;
    record->weight = same ? at_most(record->weight + 1.0F, MEANS) : 1.0F;
    record->count = same ? FORGET * record->count + 1.0F : record->count;
    for (uint16_t way = 0U; way < PLANE_WAYS; ++way) {
        const float rest_mm = off_mm[way] - record->mean_mm[way];

        record->mean_mm[way] += rest_mm / record->weight;
        if (same) {
            record->squares[way] = FORGET * record->squares[way] + rest_mm * rest_mm / variance_mm2;
        }
    }
    return same || first;
}

static bool take(plane_t *plane, float speed_mm_s)
{
    bool same = true;

    for (uint16_t d = 0U; d < PLANE_COUNT; ++d) {
        const plane_sight_t *sight = &plane->sights[d];
        const float shown_mm = sight->shown_mm - speed_mm_s * sight->later_s;
        float off_mm[PLANE_WAYS];

        for (uint16_t way = 0U; way < PLANE_WAYS; ++way) {
            off_mm[way] = shown_mm - foretold_mm(sight, way);
        }
        same = record(&plane->records[d], off_mm, noises_mm2[d]) && same;
    }
    return same;
}

/* Of the way that the parameters describe, with the likeliest size of the noise; not below the stated one. */
static float likelihood(const plane_record_t *record)
{
    const float squares = record->squares[0];

    return (squares <= record->count) ? -0.5F * squares
                                      : -0.5F * record->count * (1.0F + logf(squares / record->count));
}

static void judge_mounting(plane_t *plane)
{
    const float sound = likelihood(&plane->records[0]) + likelihood(&plane->records[1]);
    float best = sound + SURE_NATS;

    for (uint16_t way = 1U; way < PLANE_WAYS; ++way) {
        const float likely = -0.5F * (plane->records[0].squares[way] + plane->records[1].squares[way]);

        if (likely > best) {
            best = likely;
            plane->mounting = fault_of(way);
        }
    }
}

/* ---- the offset */

/* Roll and pitch that make these differences. Mirrors in one place make them NaN or infinite, and nothing of
 * that is named. */
static void tilt_of(const plane_t *plane, const float off_mm[PLANE_COUNT], float tilt_rad[2])
{
    tilt_rad[1] = off_mm[PLANE_FORE_AFT] / plane->fore_mm[PLANE_FORE_AFT];
    tilt_rad[0] = (off_mm[PLANE_ABEAM] - plane->fore_mm[PLANE_ABEAM] * tilt_rad[1]) /
                  plane->arm_mm[PLANE_ABEAM];
}

static bool is_beyond(float angle_rad, float limit_rad)
{
    return fabsf(angle_rad) > limit_rad;
}

/* The offset is one with the heights at rest taken off, and without. At rest the first is what the IMU tells:
 * the mirrors' noise is in both, and goes. */
static bool has_offset(plane_t *plane, const plane_scan_t *scan)
{
    static const plane_direction_t of_angle[2] = {PLANE_ABEAM, PLANE_FORE_AFT};
    const float bases_mm[2] = {plane->arm_mm[PLANE_ABEAM], plane->fore_mm[PLANE_FORE_AFT]};
    const float rested = scan->rest ? 0.0F : 1.0F / (float)zeros_scans(scan->zeros);
    float whole_mm[PLANE_COUNT], rested_mm[PLANE_COUNT], whole_rad[2];
    bool found = false;

    for (uint16_t d = 0U; d < PLANE_COUNT; ++d) {
        whole_mm[d] = -plane->records[d].mean_mm[0];
        rested_mm[d] = whole_mm[d];
        for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
            rested_mm[d] += shares[d][m] * scan->zeros->zeros[m].mm;
        }
    }
    tilt_of(plane, whole_mm, whole_rad);
    tilt_of(plane, rested_mm, plane->off_rad);
    for (uint16_t angle = 0U; angle < 2U; ++angle) {
        const uint16_t d = (uint16_t)of_angle[angle];
        const float way_mm2 = scan->rest ? 0.0F : FLOWN_MM * FLOWN_MM;
        const float noise_mm2 = noises_mm2[d] * (1.0F / plane->records[d].weight + rested) + way_mm2;
        const float limit_rad = IMU_OFFSET_RAD + OFFSET_SIGMAS * sqrtf(noise_mm2) / bases_mm[angle];
        const float rested_rad = scan->rest ? IMU_OFFSET_RAD : limit_rad;

        found = found ||
                (is_beyond(whole_rad[angle], limit_rad) && is_beyond(plane->off_rad[angle], rested_rad) &&
                 (whole_rad[angle] > 0.0F) == (plane->off_rad[angle] > 0.0F));
    }
    return found;
}

/* Above the ground that it has stood on, or there. */
static void judge_offset(plane_t *plane, const plane_scan_t *scan)
{
    const float scans = at_most(plane->records[0].weight, plane->records[1].weight);

    plane->off_known = zeros_scans(scan->zeros) > 0U && scans >= (float)OFFSET_SCANS;
    if (plane->off_known) {
        plane->offset = has_offset(plane, scan);
    } else if (scan->rest) {
        plane->offset = false;
    }
}

static void forget_means(plane_t *plane)
{
    plane->records[0].weight = 0.0F;
    plane->records[1].weight = 0.0F;
}

static void follow(plane_t *plane, const plane_scan_t *scan, bool same)
{
    if (scan->rest) {
        plane->above = 0U;
        judge_offset(plane, scan);
    } else if (plane->above > 0U && plane->above < PLANE_ABOVE) {
        const bool low = same && plane->height_mm[0] < ABOVE_MOST_MM;

        plane->above = low ? (uint16_t)(plane->above + 1U) : PLANE_ABOVE;
        if (low) {
            judge_offset(plane, scan);
        }
    } else if (plane->above == 0U && plane->height_mm[0] > GROUND_WITHIN_MM) {
        plane->above = 1U;
        forget_means(plane);
    }
}

static void begin(plane_t *plane, const plane_scan_t *scan)
{
    if (scan->axes != plane->axes) {
        *plane = (plane_t){.axes = scan->axes, .above = PLANE_ABOVE};
    }
    if (scan->rest && !plane->rested) {
        forget_means(plane);
    }
    plane->rested = scan->rest;
}

static bool is_of_use(const plane_scan_t *scan)
{
    bool all = scan->honest && scan->frame_count > 0U && scan->frames[scan->frame_count - 1U].ready;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        all = all && scan->shown[m].valid;
    }
    return all;
}

void plane_scan(plane_t *plane, const plane_scan_t *scan)
{
    begin(plane, scan);
    if (!is_of_use(scan) || scan->gap_s > GAP_LONG_S) {
        plane->held = 0U;
        if (!scan->honest) {
            forget_means(plane);
            plane->above = PLANE_ABOVE;
        }
        return;
    }
    if (plane->held == 2U) {
        float height_mm = 0.0F;
        for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
            height_mm += scan->shown[m].height_mm / (float)MIRROR_COUNT;
        }
        const bool same = take(plane, (height_mm - plane->height_mm[1]) / (scan->gap_s + plane->gap_s));

        judge_mounting(plane);
        follow(plane, scan, same);
    }
    look(plane, scan);
}

imu_fault_t plane_fault(const plane_t *plane)
{
    if (plane->mounting != IMU_SOUND) {
        return plane->mounting;
    }
    return plane->offset ? IMU_OFFSET : IMU_SOUND;
}
