/* Whether the vehicle gets to its reference: a battery that is too weak, a load that is too heavy, limits that are too
 * narrow leave it off for ever, and nothing else would tell. Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_REACH_H
#define CONTROL_REACH_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    float nearest_mm;       /* so far, on that side */
    bool above;
    bool on;                /* under way to a reference */
    uint32_t stuck_us;      /* since it came nearer last, stops at a minute */
} reach_t;

/* With no reference, or another one: the beginning. */
void reach_reset(reach_t *reach);

/* One control cycle, step_us after the one before, that far above (or, negative, below) the reference. True: for 3 s it has been
 * over 0.1 m off on one side without coming 50 mm nearer. */
bool reach_step(reach_t *reach, float off_mm, uint32_t step_us);

#endif
