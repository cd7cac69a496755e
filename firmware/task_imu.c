#include <stdbool.h>
#include <stddef.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "control/attitude.h"
#include "firmware/boot.h"
#include "firmware/imu_port.h"
#include "firmware/monitor.h"
#include "drivers/razor.h"
#include "firmware/schedule.h"
#include "firmware/servers.h"
#include "firmware/tasks.h"

static attitude_filter_t filter;

static void take(imu_sample_t *sample, const razor_frame_t *frame, uint32_t arrival_us)
{
    bool was_ready = filter.ready;
    attitude_t raw;

    raw.roll_rad = frame->roll_rad;
    raw.pitch_rad = frame->pitch_rad;
    raw.yaw_rad = frame->yaw_rad;
    sample->ready = attitude_step(&filter, &raw, &sample->level, &sample->median);
    if (filter.ready && !was_ready) {
        boot_keep_offset(&filter.offset);
    }
    sample->has_acceleration = frame->has_acceleration;
    sample->forward_mps2 = frame->forward_mps2;
    sample->right_mps2 = frame->right_mps2;
    sample->down_mps2 = frame->down_mps2;
    sample->arrival_us = arrival_us;
    sample->sequence++;
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
    razor_frame_t frame = {0};

    (void)unused0;
    (void)unused1;
    begin();
    for (;;) {
        imu_port_wait(&message);
        monitor_begin(MONITOR_IMU);
        if (razor_parse(&message.text, &frame) == RAZOR_OK) {
            take(&sample, &frame, message.arrival_us);
        } else {
            sample.malformed++;
        }
        imu_server_write(&sample);
        task_control_imu_arrived();
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
