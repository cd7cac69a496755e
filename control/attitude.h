/* Filter for roll, pitch and yaw. First it measures the angles of the vehicle at rest, as the mean of
 * ATTITUDE_OFFSET_FRAMES frames. This offset is then subtracted from every frame. A moving median of
 * ATTITUDE_MEDIAN_FRAMES frames removes the spikes of the sensor (seed document, 5.2.1.1). The median of
 * yaw works across the +-pi wrap; the offset of yaw stays 0.
 *
 * Radians. Pure; the caller owns the filter. Context: Task. */
#ifndef CONTROL_ATTITUDE_H
#define CONTROL_ATTITUDE_H

#include <stdbool.h>
#include <stdint.h>

#define ATTITUDE_OFFSET_FRAMES 20U          /* seed 5.2.1.1 */
#define ATTITUDE_MEDIAN_FRAMES 5U           /* seed 5.2.1.1 */
#define ATTITUDE_OFFSET_MAX_RAD 0.17453293F /* 10 degrees; a larger offset is refused, and measured again */

/* A spike of the Razor, 20 degrees, in one angle of 200 (sim/devices/razor9dof.h). */
#define ATTITUDE_SPIKE_RAD 0.35F
/* What an angle changes by from frame to frame: four sigma of noise and sway, 13 mrad. The noise is 0.5
 * degrees in each of both frames, the sway 3 degrees rms at 0.6 Hz (tools/campaign/plan.py). */
#define ATTITUDE_STIRS_RAD 0.05F
/* So many tilted frames in a row are no spikes: three are, by chance, once in a million, in 7 hours. */
#define ATTITUDE_TILTED_FRAMES 3U

typedef struct {
    float roll_rad;
    float pitch_rad;
    float yaw_rad; /* -pi .. pi */
} attitude_t;

typedef struct {
    attitude_t sum;
    uint16_t summed;   /* frames in sum */
    bool ready;        /* the offset is known */
    uint16_t refusals; /* offsets refused so far */
    attitude_t offset;
    attitude_t history[ATTITUDE_MEDIAN_FRAMES]; /* latest angles, offset removed */
    uint16_t held;                              /* valid entries of history */
    uint16_t next;
    attitude_t followed; /* latest frame that continued the motion */
    uint16_t strayed;    /* frames since then */
    uint16_t rolled;     /* frames of the present turn; the last only counts beyond 45 degrees */
    uint16_t beyond;     /* those beyond 45 degrees, at most 3 */
} attitude_filter_t;

/* So many of them are a vehicle that turns over: one more than a burst of bad frames may have. The median
 * would tell it later. */
#define ATTITUDE_ROLLED_FRAMES 7U

void attitude_init(attitude_filter_t *filter);

/* Starts with a known offset, after a watchdog reset. The filter is ready at once. */
void attitude_restore(attitude_filter_t *filter, const attitude_t *offset);

/* Processes one frame. raw: angles as measured, finite. Returns true from the first frame after the offset
 * is known. Then *level is raw without the offset, and *median is the moving median of the frames so far.
 * During the frames that measure the offset it returns false and writes zeros to both; the last of these
 * frames sets `ready`. */
bool attitude_step(attitude_filter_t *filter, const attitude_t *raw, attitude_t *level, attitude_t *median);

#endif
