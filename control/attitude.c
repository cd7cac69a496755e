#include "control/attitude.h"

#include <math.h>

#include "control/median.h"

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
    filter->history[filter->next] = *level;
    filter->next = (uint16_t)((filter->next + 1U) % ATTITUDE_MEDIAN_FRAMES);
    if (filter->held < ATTITUDE_MEDIAN_FRAMES) {
        ++filter->held;
    }
    *median = median_attitude(filter);
    return true;
}
