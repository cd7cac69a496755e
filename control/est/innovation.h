/* The innovation test: is a height used? One whose innovation exceeds a bound (80 mm at most; more over a
 * rough floor) is rejected, unless the belief tells that the ground has not stepped since the latest height
 * that was used: then the vehicle has moved as the filter does not know. Two rejected heights in a row that
 * agree are a step of the terrain. The third one in a row always resets the filter. So no state of the filter
 * can reject heights for ever. After a dip (dips.h) a fall of the ground must last longer than the dip did,
 * and the reset waits for so many heights more: six at most.
 *
 * Metres; one call each height. Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_INNOVATION_H
#define CONTROL_INNOVATION_H

#include <stdint.h>

#include "control/est/dips.h"

typedef enum { HEIGHT_FUSED, HEIGHT_REJECTED, HEIGHT_TERRAIN_STEP, HEIGHT_RESET } height_outcome_t;

typedef struct {
    uint16_t rejected; /* heights in a row */
    float latest_m;    /* innovation of the latest of them */
    uint16_t ground;   /* number of the ground at the latest height that was used, see altitude.h */
    dips_t dips;       /* falls of the ground that came back */
} innovation_test_t;

/* A new height. innovation_m: measured minus predicted; variance_m2 > 0: what is expected of its square.
 * floor_m: rms noise of the floor. ground: as in altitude.h. After
 * HEIGHT_TERRAIN_STEP and HEIGHT_RESET the caller sets the filter to this height. */
height_outcome_t innovation_test(innovation_test_t *test, float innovation_m, float variance_m2,
                                 float floor_m, uint16_t ground);

/* A height that is fused without the test. */
void innovation_untested(innovation_test_t *test, uint16_t ground);

#endif
