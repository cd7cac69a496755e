/* Dips: the ground falls away and comes back within some scans. Then the heights were wrong, or
 * the ground had a gap. What made one dip makes the next one, so for a while a fall of the ground must
 * last longer than the dip did before it is believed. A rise of the ground never waits: it is dangerous.
 *
 * Metres; one call each scan. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_DIPS_H
#define CONTROL_DIPS_H

#include <stdint.h>

typedef struct {
    float fall_m;      /* of the latest step that was believed, > 0; 0: it was a rise */
    uint16_t since;    /* scans since that step, up to one more than a dip lasts */
    uint16_t lasted;   /* scans of the latest dip */
    uint16_t recalled; /* scans for which it is still remembered */
} dips_t;

/* Before the height of each scan is tested. */
void dips_scan(dips_t *dips);

/* So many heights in a row are rejected before a fall of the ground is believed; 0: as without dips.
 * innovation_m: of the latest, measured minus predicted; > 0 where the ground falls. */
uint16_t dips_wait(const dips_t *dips, float innovation_m);

/* So many heights in a row were rejected, the latest with this innovation, and the next one was as predicted:
 * a dip that was not believed is over. */
void dips_over(dips_t *dips, uint16_t rejected, float innovation_m);

/* A step of the ground was believed, with this innovation. */
void dips_step(dips_t *dips, float innovation_m);

#endif
