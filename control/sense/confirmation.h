/* What the heights have not shown yet: the climb of a take-off, the climb after a step of the terrain towards
 * the vehicle, and a motion after a far fall of the terrain. Until then the beam may be blocked.
 *
 * Metres and seconds. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_CONFIRMATION_H
#define CONTROL_SENSE_CONFIRMATION_H

#include <stdbool.h>

#include "control/sense/heights.h"

typedef struct {
    bool unconfirmed;   /* after a take-off or a step towards the vehicle: no climb has shown since */
    bool proved;        /* the heights have confirmed a climb since the ground */
    float near_m;       /* height after the step that made `unconfirmed` true */
    float quiet_s;      /* how long the law has not wanted to climb */
    bool terrain_fell;  /* the terrain has fallen far, and the heights have shown no motion since */
    float after_fall_m; /* height after that step */
} confirmation_t;

/* One height. standing: on the ground, or not yet off it. True: it shows the first climb since the ground. */
bool confirmation_height(confirmation_t *confirmation, const height_change_t *change, bool standing);

/* The same height, after the witnesses were compared. wanted_m: reference minus height, NAN: none is held. */
void confirmation_wait(confirmation_t *confirmation, const height_change_t *change, float wanted_m);

/* The first climb since the ground is still to come. */
static inline bool confirmation_is_first(const confirmation_t *confirmation)
{
    return confirmation->unconfirmed && !confirmation->proved;
}

#endif
