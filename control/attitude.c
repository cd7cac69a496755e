#include "control/attitude.h"

#include <math.h>

#include "control/angle.h"
#include "control/credible.h"
#include "control/median.h"

#define FOLLOWS_RAD 0.30F /* chosen: 690 degrees a second in frames of 25 ms, below a spike of 20 degrees */
#define FOLLOWS_SPIKE_RAD 0.60F /* chosen: the same in two frames, one of them a spike */
#define STRAYED_FRAMES 7U       /* chosen: a burst of six bad frames is over */
#define STRAYED_COUNT 3U        /* chosen: so many of them count as frames of a turn */
#define BENT_RAD 0.17453293F    /* chosen: 10 degrees, above the tilts of a flight */
#define BEYOND_FRAMES 3U        /* chosen: one or two beyond 45 degrees may be a gust's */

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

static bool tilts_beyond(const attitude_t *level, float limit_rad)
{
    return fabsf(level->roll_rad) > limit_rad || fabsf(level->pitch_rad) > limit_rad;
}

/* Counts the frames since the vehicle was last level. The last of them only counts beyond 45 degrees. */
static void count_roll(attitude_filter_t *filter, const attitude_t *level, bool follows)
{
    if (!tilts_beyond(level, BENT_RAD)) {
        filter->rolled = 0U;
    } else if (!follows) {
        filter->rolled = STRAYED_COUNT;
    } else {
        ++filter->rolled;
    }
    filter->beyond = tilts_beyond(level, TILTED_RAD) ? (uint16_t)(filter->beyond + 1U) : 0U;
    filter->beyond = (filter->beyond < BEYOND_FRAMES) ? filter->beyond : BEYOND_FRAMES;
    const uint16_t most = (filter->beyond == BEYOND_FRAMES) ? ATTITUDE_ROLLED_FRAMES
                                                            : ATTITUDE_ROLLED_FRAMES - 1U;
    filter->rolled = (filter->rolled < most) ? filter->rolled : most;
}

/* A turn is continuous; a burst of bad frames is short. So the frames of a turn are counted from the first
 * one that is not level, which must follow from a level one. A frame after a jump does not follow; within a
 * turn it counts, because it may be a spike. */
static void watch_roll(attitude_filter_t *filter, const attitude_t *level)
{
    const float most_rad = (filter->strayed == 0U) ? FOLLOWS_RAD : FOLLOWS_SPIKE_RAD;
    const bool follows = arc_rad(filter->followed.roll_rad, level->roll_rad) < most_rad &&
                         arc_rad(filter->followed.pitch_rad, level->pitch_rad) < most_rad;

    if (!follows && filter->held > 0U && filter->strayed + 1U < STRAYED_FRAMES) {
        ++filter->strayed;
        filter->rolled = (uint16_t)(filter->rolled +
                                    (filter->rolled > 0U && filter->rolled + 1U < ATTITUDE_ROLLED_FRAMES));
        return;
    }
    filter->followed = *level;
    filter->strayed = 0U;
    count_roll(filter, level, follows);
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
