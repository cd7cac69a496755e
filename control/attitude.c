#include "control/attitude.h"

#include <math.h>

#include "control/angle.h"
#include "control/credible.h"
#include "control/median.h"

#define FOLLOWS_RAD 0.25F       /* chosen: 570 degrees a second in frames of 25 ms */
#define FOLLOWS_SPIKE_RAD 0.40F /* chosen: 460 degrees a second in two frames, one of them a spike */
#define STRAYED_FRAMES 7U       /* chosen: a burst of six bad frames is over */

void attitude_init(attitude_filter_t *filter)
{
    *filter = (attitude_filter_t){.ready = false};
}

void attitude_restore(attitude_filter_t *filter, const attitude_t *offset)
{
    *filter = (attitude_filter_t){.ready = true, .offset = *offset};
}

static void gather_offset(attitude_filter_t *filter, const attitude_t *raw)
{
    filter->sum.roll_rad += raw->roll_rad;
    filter->sum.pitch_rad += raw->pitch_rad;
    ++filter->summed;
    if (filter->summed < ATTITUDE_OFFSET_FRAMES) {
        return;
    }
    const attitude_t mean = {
        .roll_rad = filter->sum.roll_rad / (float)ATTITUDE_OFFSET_FRAMES,
        .pitch_rad = filter->sum.pitch_rad / (float)ATTITUDE_OFFSET_FRAMES,
    };
    filter->ready = fabsf(mean.roll_rad) <= ATTITUDE_OFFSET_MAX_RAD &&
                    fabsf(mean.pitch_rad) <= ATTITUDE_OFFSET_MAX_RAD;
    if (filter->ready) {
        filter->offset = mean;
        return;
    }
    filter->sum = (attitude_t){.roll_rad = 0.0F};
    filter->summed = 0U;
    if (filter->refusals < UINT16_MAX) {
        ++filter->refusals;
    }
}

static attitude_t median_attitude(const attitude_filter_t *filter)
{
    float roll_rad[ATTITUDE_MEDIAN_FRAMES];
    float pitch_rad[ATTITUDE_MEDIAN_FRAMES];
    float yaw_rad[ATTITUDE_MEDIAN_FRAMES];

    for (uint16_t i = 0U; i < filter->held; ++i) {
        roll_rad[i] = filter->history[i].roll_rad;
        pitch_rad[i] = filter->history[i].pitch_rad;
        yaw_rad[i] = filter->history[i].yaw_rad;
    }
    return (attitude_t){
        .roll_rad = median_of(roll_rad, filter->held),
        .pitch_rad = median_of(pitch_rad, filter->held),
        .yaw_rad = median_of_angles(yaw_rad, filter->held),
    };
}

/* A frame after a jump is not counted, nor are those after it, until one continues the motion from before the
 * jump, or the burst of bad frames must be over. */
static void watch_roll(attitude_filter_t *filter, const attitude_t *level)
{
    const float most_rad = (filter->strayed == 0U) ? FOLLOWS_RAD : FOLLOWS_SPIKE_RAD;
    const bool follows = arc_rad(filter->followed.roll_rad, level->roll_rad) < most_rad &&
                         arc_rad(filter->followed.pitch_rad, level->pitch_rad) < most_rad;

    if (!follows && filter->held > 0U && filter->strayed + 1U < STRAYED_FRAMES) {
        ++filter->strayed;
        return;
    }
    const bool tilted = fabsf(level->roll_rad) > TILTED_RAD || fabsf(level->pitch_rad) > TILTED_RAD;
    const bool counts = tilted && follows;

    filter->followed = *level;
    filter->strayed = 0U;
    filter->rolled = counts ? (uint16_t)(filter->rolled + (filter->rolled < ATTITUDE_ROLLED_FRAMES)) : 0U;
}

bool attitude_step(attitude_filter_t *filter, const attitude_t *raw, attitude_t *level, attitude_t *median)
{
    if (!filter->ready) {
        gather_offset(filter, raw);
        *level = (attitude_t){.roll_rad = 0.0F};
        *median = *level;
        return false;
    }
    *level = (attitude_t){
        .roll_rad = raw->roll_rad - filter->offset.roll_rad,
        .pitch_rad = raw->pitch_rad - filter->offset.pitch_rad,
        .yaw_rad = raw->yaw_rad,
    };
    watch_roll(filter, level);
    filter->history[filter->next] = *level;
    filter->next = (uint16_t)((filter->next + 1U) % ATTITUDE_MEDIAN_FRAMES);
    if (filter->held < ATTITUDE_MEDIAN_FRAMES) {
        ++filter->held;
    }
    *median = median_attitude(filter);
    return true;
}
