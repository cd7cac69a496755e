/* Which tilt is believed: a tilt that jumps by more than 20 degrees is rejected until six in a row were
 * rejected, or until they show a steady turn.
 *
 * Radians. Pure; the caller owns the state. Context: one Task. */
#ifndef CONTROL_SENSE_TILT_H
#define CONTROL_SENSE_TILT_H

#include <stdbool.h>
#include <stdint.h>

#include "control/imu_sample.h"

typedef struct {
    bool levelled;             /* at least one tilt was accepted */
    float roll_rad, pitch_rad; /* latest accepted tilt */
    float upright;             /* its cosine */
    uint16_t jumped;           /* tilts in a row that were rejected because they jumped */
    float told_rad[2];         /* roll and pitch of the latest of them */
    uint16_t tilted;           /* frames in a row above 45 degrees, their accepted tilt too */
    uint32_t time_us;          /* arrival of the latest tilt, accepted or not */
    uint32_t sequence;         /* latest frame that tilt_step() processed */
    uint32_t unfit_sequence;   /* frames up to this one must not be used: their tilt was rejected */
} tilt_t;

void tilt_init(tilt_t *tilt);

/* Checks the tilt, once in each cycle. frames: oldest first, borrowed for the call; frames that were
 * processed before change nothing. When count is 0, roll_rad, pitch_rad and time_us (arrival) are one sample
 * instead. Angles that are NaN or beyond 7 rad are rejected. Writes roll_rad, pitch_rad, upright, tilted and
 * unfit_sequence. */
void tilt_step(tilt_t *tilt, const imu_sample_t *frames, uint16_t count, float roll_rad, float pitch_rad,
               uint32_t time_us);

#endif
