/* The witness of the thrust: the vertical speed by the commanded thrust and the vehicle's model. It needs no
 * correction by the heights, because the damping bounds its speed.
 *
 * Metres, seconds, newtons per motor; positive is upwards. Pure; the caller owns the state, all zero at
 * first. Context: one Task. */
#ifndef CONTROL_SENSE_PUSH_H
#define CONTROL_SENSE_PUSH_H

#include "control/facts.h"
#include "control/sense/witness.h"

typedef struct {
    float lagged_n; /* commanded thrust through the lag of the motors */
    witness_t pushed;
} push_t;

/* Moves the lag of the motors, once in each cycle. */
void push_lag(push_t *push, const command_t *command);

/* Dead reckoning, once in each cycle in which the thrust alone carries the vehicle. upright: cosine of the
 * tilt. */
void push_move(push_t *push, const command_t *command, float upright);

/* Change of the vertical speed in this cycle by thrust and weight alone, and the share of that speed that the
 * drag takes. On the ground it does not move, whatever they say. */
float push_lift_mps(const push_t *push, const command_t *command, float upright);
float push_dragged(const command_t *command);

/* Change of the speed in this cycle by the thrust that is commanded and not delivered yet. */
float push_undelivered_mps(const push_t *push, const command_t *command, float upright);

/* Adds the innovation of one height. */
void push_compare(push_t *push, float rise_m, float gap_s, float age_s);

/* Vertical speed by the thrust, less the error that the heights have shown of it. Where the thrust does not
 * tell, rise_mps. */
float push_speed_mps(const push_t *push, float rise_mps);

/* Way since the rays of the latest height, by the thrust; > 0: upwards. */
float push_moved_m(const push_t *push);

#endif
