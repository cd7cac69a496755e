/* The sensors one by one, without a verdict: what each of them has shown of the vertical motion. Three
 * sources tell it: the heights, the accelerometer, and the commanded thrust together with the vehicle's
 * model. Each of them may be wrong; verdict.h says when.
 *
 * Metres, seconds, newtons per motor, radians; positive is upwards. Pure; the caller owns the state. Context:
 * one Task, in the order of sense_step(): tilt, frames, thrust, then scan and height when there is a new
 * scan. */
#ifndef CONTROL_SENSE_SENSES_H
#define CONTROL_SENSE_SENSES_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/facts.h"
#include "control/imu_sample.h"
#include "control/sense/accelerometer.h"
#include "control/sense/confirmation.h"
#include "control/sense/heights.h"
#include "control/sense/mirrors.h"
#include "control/sense/push.h"
#include "control/sense/stand.h"
#include "control/sense/sway.h"
#include "control/sense/tilt.h"

typedef struct {
    bool standing; /* on the ground, or take-off commanded and not yet off the ground */
    tilt_t tilt;
    sway_t sway;
    mirrors_t mirrors;
    heights_t heights;
    confirmation_t confirmation;
    accelerometer_t accelerometer;
    push_t push;
    stand_t stand;
} senses_t;

/* Begins a state that is all zero. */
void senses_init(senses_t *senses);

/* Moves the accelerometer's witness, once in each cycle. frames: oldest first, borrowed for the call; frames
 * that were processed before, or whose tilt was rejected, change nothing. On the ground it measures the
 * bias. */
void senses_frames(senses_t *senses, const command_t *command, const imu_sample_t *frames, uint16_t count);

/* Moves the thrust's witness, once in each cycle. felt_valid: the accelerometer is not doubted. */
void senses_thrust(senses_t *senses, const command_t *command, bool felt_valid);

/* Compares one accepted height with both witnesses. height_m: the height. gap_s: time since the height
 * before, > 0. age_s: time since its rays were taken. believed: heights correct the accelerometer's witness.
 * Returns what the height was. */
height_change_t senses_height(senses_t *senses, float height_m, float gap_s, float age_s, bool believed);

/* Clears the sums of the innovations. */
void senses_forget(senses_t *senses);

#endif
