#include <stdbool.h>
#include <stddef.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "control/attitude.h"
#include "control/imu_mapping.h"
#include "control/imu_repeat.h"
#include "firmware/boot.h"
#include "firmware/imu_exchange.h"
#include "firmware/imu_port.h"
#include "firmware/monitor.h"
#include "drivers/razor.h"
#include "firmware/schedule.h"
#include "firmware/servers.h"
#include "firmware/tasks.h"

static attitude_filter_t filter;

static imu_raw_t raw_of(const razor_frame_t *frame)
{
    return (imu_raw_t){
        .yaw_rad = frame->yaw_rad,
        .pitch_rad = frame->pitch_rad,
        .roll_rad = frame->roll_rad,
        .has_acceleration = frame->has_acceleration,
        .x_counts = frame->x_counts,
        .y_counts = frame->y_counts,
        .z_counts = frame->z_counts,
    };
}

/* The angles as gravity has them. */
static attitude_t tilt_of(const imu_mapping_t *mapping, const attitude_t *median)
{
    const attitude_t tilt = {.roll_rad = median->roll_rad + filter.offset.roll_rad,
                             .pitch_rad = median->pitch_rad + filter.offset.pitch_rad};

    return imu_map_angles(mapping, &tilt);
}

/* The filter works in the IMU's axes, so that its offset outlasts a change of the mapping. */
static void fill_sample(imu_sample_t *sample, const imu_raw_t *raw, uint32_t arrival_us)
{
    const bool was_ready = filter.ready;
    const attitude_t angles = {
        .roll_rad = raw->roll_rad, .pitch_rad = raw->pitch_rad, .yaw_rad = raw->yaw_rad};
    imu_mapping_t mapping;
    attitude_t level;
    attitude_t median;

    imu_exchange_mounted(&mapping);
    sample->ready = attitude_step(&filter, &angles, &level, &median);
    /* For a watchdog reset in the air, where it cannot be taken again. */
    if (filter.ready && !was_ready) {
        boot_keep_offset(&filter.offset);
    }
    sample->rolled = filter.rolled;
    sample->level = imu_map_angles(&mapping, &level);
    sample->median = imu_map_angles(&mapping, &median);
    const attitude_t tilt = tilt_of(&mapping, &median);
    sample->tilt_roll_rad = tilt.roll_rad;
    sample->tilt_pitch_rad = tilt.pitch_rad;
    sample->has_acceleration = raw->has_acceleration;
    imu_map_acceleration(&mapping, raw, &sample->forward_mps2, &sample->right_mps2, &sample->down_mps2);
    sample->arrival_us = arrival_us;
    ++sample->sequence;
}

/* The offset is taken once after power-up: after a watchdog reset the vehicle may be in the air. */
static void begin(void)
{
    attitude_t offset;

    attitude_init(&filter);
    if (boot_kept_offset(&offset)) {
        attitude_restore(&filter, &offset);
    }
}

static Void task_imu(UArg unused0, UArg unused1)
{
    static imu_message_t message;
    static imu_sample_t sample;
    static imu_repeat_t repeat;
    razor_frame_t frame = {0};

    (void)unused0;
    (void)unused1;
    begin();
    for (;;) {
        imu_port_wait(&message);
        monitor_begin(MONITOR_IMU);
        const razor_status_t status = razor_parse(&message.text, &frame);
        const imu_raw_t raw = raw_of(&frame);
        imu_exchange_show(&message.text, status, &raw, message.arrival_us);
        if (status == RAZOR_OK && !imu_repeats(&repeat, &raw)) {
            fill_sample(&sample, &raw, message.arrival_us);
        } else {
            ++sample.malformed;
        }
        /* Also when nothing could be read, or nothing new: the counter of refused frames is in the sample.
         * Its sequence stays, so nobody takes it for a new frame. */
        imu_server_write(&sample);
        task_control_imu_arrived();
        /* When the count is reached, not while it lasts: the release is for the cut, and a cut is made
         * once. */
        if (sample.rolled == ATTITUDE_ROLLED_FRAMES) {
            task_control_rolls();
        }
        monitor_done(MONITOR_IMU);
    }
}

void task_imu_create(void)
{
    Task_Params params;

    imu_port_create();
    Task_Params_init(&params);
    params.instance->name = "TaskIMU";
    params.priority = TASK_IMU_PRIORITY;
    params.stackSize = TASK_STACK_CELLS;
    monitor_watch(MONITOR_IMU, Task_create(task_imu, &params, NULL));
}
