/* The evidence is written into the state, and one height is judged: for the tests of the verdict. */
#ifndef TESTS_CONTROL_SENSE_JUDGED_H
#define TESTS_CONTROL_SENSE_JUDGED_H

#include "sense/sensed.h"

/* So short that no sum moves: what is written is what is judged. */
#define AT_ONCE_S 1.0e-9F
#define HOVER_N 7.0F

static command_t flown;

/* In the air, warm and proved; the heights do not move, nobody contradicts. */
static inline void evidence_begin(void)
{
    sensed_begin();
    senses.heights.known = senses.confirmation.proved = true;
    at_m(0.5F);
    came_near_at_m(0.5F);
    senses.accelerometer.felt.running_s = senses.push.pushed.running_s = 2.0F;
    pushes_n(HOVER_N);
    flown = (command_t){.step_s = 0.025F,
                        .off_ground = true,
                        .ours = true,
                        .thrust_n = HOVER_N,
                        .hover_n = HOVER_N,
                        .authority_mps2_per_n = 1.4F,
                        .damping_per_s = 2.5F,
                        .wanted_m = 0.5F,
                        .noise_mps2 = 0.4F};
}

static inline uint16_t judged(float felt_m, float pushed_m)
{
    senses.accelerometer.felt.off_m = felt_m;
    senses.push.pushed.off_m = pushed_m;
    sensed_height(&flown, senses.heights.height_m, AT_ONCE_S, 0.0F);
    return verdict.doubts;
}

#endif
