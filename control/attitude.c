#include "control/attitude.h"

#include <math.h>

#include "control/angle.h"
#include "control/credible.h"
#include "control/median.h"

#define FOLLOWS_RAD (ATTITUDE_SPIKE_RAD - ATTITUDE_STIRS_RAD) /* below the least spike */
#define FOLLOWS_SPIKE_RAD (2.0F * FOLLOWS_RAD)                /* in two frames, one of them a spike */
#define STRAYED_FRAMES ATTITUDE_ROLLED_FRAMES                 /* a burst of bad frames is over */
#define BENT_RAD 0.17453293F /* 10 degrees: three sigma of the liveliest sway, 3 degrees, rounded up */

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

static bool are_close(const attitude_t *a, const attitude_t *b, float most_rad)
{
    return arc_rad(a->roll_rad, b->roll_rad) < most_rad && arc_rad(a->pitch_rad, b->pitch_rad) < most_rad;
}

/* The frame so many before this one. */
static const attitude_t *earlier(const attitude_filter_t *filter, uint16_t frames)
{
    return &filter->history[(filter->next + ATTITUDE_MEDIAN_FRAMES - frames) % ATTITUDE_MEDIAN_FRAMES];
}

static bool stirs(float before_rad, float last_rad)
{
    const float step_rad = fabsf(last_rad - before_rad);
    return step_rad > ATTITUDE_STIRS_RAD && step_rad < FOLLOWS_RAD;
}

/* True when the frame before this one, level yet, has begun a turn already. A vehicle in the air moves less
 * from frame to frame, a spike more. */
static bool has_begun(const attitude_filter_t *filter)
{
    const attitude_t *const last = earlier(filter, 1U);
    const attitude_t *const before = earlier(filter, 2U);
    return filter->rolled == 0U && filter->held > 1U &&
           (stirs(before->roll_rad, last->roll_rad) || stirs(before->pitch_rad, last->pitch_rad));
}

/* Adds a frame to the turn. The last of them only counts beyond 45 degrees. */
static void count_frame(attitude_filter_t *filter, const attitude_t *level, bool sure)
{
    const bool is_beyond = sure && tilts_beyond(level, TILTED_RAD);

    filter->beyond = (uint16_t)(filter->beyond + (is_beyond && filter->beyond < ATTITUDE_TILTED_FRAMES));
    const bool lies = is_beyond && filter->beyond == ATTITUDE_TILTED_FRAMES;
    const uint16_t most = lies ? ATTITUDE_ROLLED_FRAMES : ATTITUDE_ROLLED_FRAMES - 1U;
    filter->rolled = (filter->rolled < most) ? (uint16_t)(filter->rolled + 1U) : most;
}

/* Counts the frames since the vehicle was last level, or bent without turning. */
static void count_roll(attitude_filter_t *filter, const attitude_t *level, bool follows, bool rests)
{
    if (!tilts_beyond(level, BENT_RAD) || (rests && !tilts_beyond(level, TILTED_RAD))) {
        filter->rolled = 0U;
        filter->beyond = 0U;
        return;
    }
    if (!follows) {
        filter->rolled = ATTITUDE_TILTED_FRAMES - 1U;
        filter->beyond = 0U;
    } else if (has_begun(filter)) {
        filter->rolled = 1U;
    }
    count_frame(filter, level, true);
}

/* A turn is continuous; a burst of bad frames is short. So the frames of a turn are counted from the first
 * one that is not level, which must follow from a level one; that one counts too when it had begun to turn.
 * A frame after a jump does not follow; within a turn it counts, because it may be a spike. When the frame
 * before was the only one that did not follow, a frame beside it goes on with the turn. */
static void watch_roll(attitude_filter_t *filter, const attitude_t *level)
{
    const bool is_near = are_close(&filter->followed, level, FOLLOWS_SPIKE_RAD);
    const attitude_t *const last = earlier(filter, 1U);
    const bool beside = filter->strayed == 1U && are_close(&filter->followed, last, FOLLOWS_SPIKE_RAD) &&
                        are_close(last, level, FOLLOWS_RAD);
    const bool follows = (filter->strayed == 0U) ? are_close(&filter->followed, level, FOLLOWS_RAD)
                                                 : is_near || beside;

    if (!follows && filter->held > 0U && filter->strayed + 1U < STRAYED_FRAMES) {
        ++filter->strayed;
        filter->rolled = has_begun(filter) ? 1U : filter->rolled;
        if (filter->rolled > 0U) {
            count_frame(filter, level, is_near);
        }
        return;
    }
    const bool rests = are_close(&filter->followed, level, ATTITUDE_STIRS_RAD);
    filter->followed = *level;
    filter->strayed = 0U;
    count_roll(filter, level, follows, rests);
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
