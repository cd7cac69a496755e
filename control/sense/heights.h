/* How the heights move: rate, and steps of the terrain.
 *
 * Metres and seconds. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_HEIGHTS_H
#define CONTROL_SENSE_HEIGHTS_H

#include <stdbool.h>

typedef struct {
    bool known;        /* at least one height was received */
    float height_m;    /* latest height */
    bool stepped;      /* the latest height was a step */
    float rise_mps;    /* low-passed rate of the heights, without steps */
    bool below_ground; /* so low that no noise explains it: the beam is blocked */
} heights_t;

/* One height against the one before. */
typedef struct {
    float height_m;
    float rise_m;     /* change of the height */
    float gap_s;      /* time since the height before, > 0 */
    float age_s;      /* time since its rays were taken */
    bool fresh;       /* the height before was not lost */
    bool step;        /* a step of the terrain: no witness explains the change */
    bool first_climb; /* it shows the first climb since the ground */
} height_change_t;

/* One scan, exactly once. Returns true when this can be a height: it is no less than -50 mm. */
bool heights_can_be(heights_t *heights, float height_mm);

/* What the change is, before it is taken over. step: as far as the heights alone tell. */
height_change_t heights_change(const heights_t *heights, float height_m, float gap_s, float age_s);

/* Takes the height over. */
void heights_update(heights_t *heights, const height_change_t *change);

#endif
