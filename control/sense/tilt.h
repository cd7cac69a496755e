/* Which tilt is believed. A tilt that jumps by more than 14 degrees is rejected until six in a row were
 * rejected, or until they show a steady turn. In the air a tilt beyond 20 degrees is rejected also while the
 * mirrors refute it, a level vehicle explains their slants better: at once if it jumped or is over 45
 * degrees, else when the scans in sum refute it with 99 %.
 *
 * Radians. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_SENSE_TILT_H
#define CONTROL_SENSE_TILT_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/imu_sample.h"

typedef struct {
    bool levelled;             /* at least one tilt was accepted */
    float roll_rad, pitch_rad; /* latest accepted tilt */
    float upright;             /* its cosine */
    uint16_t jumped;           /* tilts in a row that were rejected: they jumped, or the scans refuted them */
    float told_rad[2];         /* latest roll and pitch, accepted or not */
    uint16_t tilted;           /* frames in a row above 45 degrees, their accepted tilt too */
    uint32_t time_us;          /* arrival of the latest tilt, accepted or not */
    uint32_t sequence;         /* latest frame that tilt_step() processed */
    uint32_t unfit_sequence;   /* frames up to this one must not be used: their tilt was rejected */
    uint32_t accepted_us;      /* arrival of the latest accepted tilt */
    bool leapt;                /* the first of those that were rejected was a jump */
    float level_mm, told_mm;   /* height by the latest scan, if the vehicle is level, or as it is told */
    float against_nats;        /* the scans' evidence against told_rad; valid for a while after refuted_us */
    uint32_t refuted_us;
} tilt_t;

void tilt_init(tilt_t *tilt);

/* Checks the tilt, once in each cycle. frames: oldest first, borrowed for the call; frames that were
 * processed before change nothing. When count is 0, roll_rad, pitch_rad and time_us (arrival) are one sample
 * instead. Angles that are NaN or beyond 7 rad are rejected. Writes roll_rad, pitch_rad, upright, tilted and
 * unfit_sequence. */
void tilt_step(tilt_t *tilt, const imu_sample_t *frames, uint16_t count, float roll_rad, float pitch_rad,
               uint32_t time_us);

/* One scan: do its slants refute the tilt that is told? shown: `count` of them, those that are not valid
 * count for nothing. height_mm: the height before; way_mm: from it to this one, by the speed. aloft: false on
 * the ground, where nothing is refuted. */
void tilt_scan(tilt_t *tilt, const altitude_t *shown, uint16_t count, float height_mm, float way_mm,
               bool aloft);

#endif
