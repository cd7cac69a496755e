/* The plane through three heights checks the IMU. Over flat ground the heights of three mirrors tell roll and
 * pitch without the IMU. What the IMU tells must follow them:
 *
 *   signs and axes   each way to mount the IMU foretells how the heights differ when the vehicle sways. The
 * way that the parameters describe must be likelier than each other one offset           the difference that
 * stays. A slope looks the same. So it is judged only above the ground that the vehicle has stood on: there,
 * and in the first scans above it
 *
 * Uneven ground proves nothing: it may explain any difference of the heights, of any size, at no cost.
 * Another way of mounting must explain them as well as the stated noise of the mirrors lets it.
 *
 * Where the mirrors are wrong by some millimetres, they show a tilt of a degree. The heights at rest tell by
 * how much, unless the ground was uneven there. So an offset counts only when it is one both with the
 * heights at rest taken off and without.
 *
 * Millimetres, radians, seconds. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_SENSE_PLANE_H
#define CONTROL_SENSE_PLANE_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/imu_axes.h"
#include "control/imu_sample.h"
#include "control/sense/zeros.h"

#define PLANE_WAYS 8U /* each angle for itself or for the other, with either sign */

/* What three heights tell: which two combinations of them a tilt moves. */
typedef enum { PLANE_FORE_AFT, PLANE_ABEAM, PLANE_COUNT } plane_direction_t;

/* What one scan shows of one direction. */
typedef struct {
    float shown_mm;      /* difference of the heights without a correction by the tilt */
    float later_s;       /* and of the instants of their rays */
    float by_arm_mm[2];  /* what the IMU's angles, roll and pitch, would make of it as the vehicle's roll */
    float by_fore_mm[2]; /* and as its pitch */
} plane_sight_t;

typedef struct {
    float mean_mm[PLANE_WAYS]; /* what stays of shown less foretold */
    float squares[PLANE_WAYS]; /* of the rest, in variances of the stated noise; forgotten slowly */
    float weight;              /* scans in the means, up to a most */
    float count;               /* scans in the squares */
} plane_record_t;

typedef struct {
    /* The heights move while the mirrors are scanned. Their speed is known when the next scan has come. */
    uint16_t held; /* scans in a row, 2 at most */
    plane_sight_t sights[PLANE_COUNT];
    float height_mm[2];                              /* of the latest scan and of that before */
    float gap_s;                                     /* between them */
    float arm_mm[PLANE_COUNT], fore_mm[PLANE_COUNT]; /* change by a radian of roll, of pitch */
    plane_record_t records[PLANE_COUNT];
    bool rested;          /* in the scan before */
    uint16_t above;       /* scans above the ground of the latest rest; plane.c has the most */
    uint16_t axes;        /* parameters that it was found with */
    bool off_known;       /* at rest or just above it, and the mirrors showed the ground there */
    float off_rad[2];     /* roll and pitch that the IMU tells, less those that the mirrors show */
    imu_fault_t mounting; /* IMU_SOUND, ROLL, PITCH, BOTH, SWAPPED; kept until the parameters change */
    bool offset;          /* of the latest rest, or just above it */
} plane_t;

/* One scan. */
typedef struct {
    const altitude_t *shown;    /* one for each mirror_t */
    const imu_sample_t *frames; /* the latest, oldest first */
    uint16_t frame_count;
    uint32_t rays_us;     /* instant of shown[].later_us 0, on the clock of the frames */
    float gap_s;          /* since the scan before, > 0 */
    bool honest;          /* no mirror is believed to lie */
    bool rest;            /* on the ground without thrust */
    const zeros_t *zeros; /* after zeros_scan() */
    uint16_t axes;        /* another number for each setting of the IMU's axes */
} plane_scan_t;

/* Pointers are borrowed for the call. */
void plane_scan(plane_t *plane, const plane_scan_t *scan);

/* What is wrong with the IMU: IMU_SOUND when nothing was found. */
imu_fault_t plane_fault(const plane_t *plane);

#endif
