/* Roll, pitch and yaw made fit for use: the offset that the vehicle shows at rest is taken over the first
 * ATTITUDE_OFFSET_FRAMES frames and subtracted, then a moving median of ATTITUDE_MEDIAN_FRAMES removes the spikes of
 * the sensor (seed document, 5.2.1.1). Yaw is medianed across the +-pi wrap and keeps its offset at zero.
 * Pure: the caller owns the filter; Task context. */
#ifndef CONTROL_ATTITUDE_H
#define CONTROL_ATTITUDE_H

#include <stdbool.h>
#include <stdint.h>

#define ATTITUDE_OFFSET_FRAMES 20U /* seed 5.2.1.1 */
#define ATTITUDE_MEDIAN_FRAMES 5U /* seed 5.2.1.1 */
#define ATTITUDE_OFFSET_MAX_RAD 0.17453293F /* 10 degrees: a larger offset is refused and taken anew */

typedef struct {
    float roll_rad;
    float pitch_rad;
    float yaw_rad;      /* -pi .. pi */
} attitude_t;

typedef struct {
    attitude_t sum;
    uint16_t summed;                                /* frames in sum */
    bool ready;                                     /* offset accepted */
    uint16_t refusals;                              /* offsets refused so far */
    attitude_t offset;
    attitude_t history[ATTITUDE_MEDIAN_FRAMES];     /* offset removed */
    uint16_t held;                                  /* valid entries of history */
    uint16_t next;
} attitude_filter_t;

void attitude_init(attitude_filter_t *filter);

/* Starts with an offset known from before (after a watchdog reset): ready at once. */
void attitude_restore(attitude_filter_t *filter, const attitude_t *offset);

/* Takes one frame's angles (finite). Returns true from the first frame after the offset is known; then *level is the
 * angles less the offset and *median the moving median of the frames held so far. The frames that make the offset
 * (the last of them sets `ready`) return false, and both are written as zero. */
bool attitude_step(attitude_filter_t *filter, const attitude_t *raw, attitude_t *level, attitude_t *median);

#endif
