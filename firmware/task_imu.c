#include <stddef.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "attitude.h"
#include "imu_port.h"
#include "razor.h"
#include "schedule.h"
#include "servers.h"
#include "tasks.h"

static attitude_filter_t filter;

static void take(imu_sample_t *sample, const razor_frame_t *frame, uint32_t arrival_us)
{
    attitude_t raw;

    raw.roll_rad = frame->roll_rad;
    raw.pitch_rad = frame->pitch_rad;
    raw.yaw_rad = frame->yaw_rad;
    sample->ready = attitude_step(&filter, &raw, &sample->level, &sample->median);
    sample->has_acceleration = frame->has_acceleration;
    sample->forward_mps2 = frame->forward_mps2;
    sample->right_mps2 = frame->right_mps2;
    sample->down_mps2 = frame->down_mps2;
    sample->arrival_us = arrival_us;
    sample->sequence++;
}

static Void task_imu(UArg unused0, UArg unused1)
{
    static imu_message_t message;
    static imu_sample_t sample;
    razor_frame_t frame = {0};

    (void)unused0;
    (void)unused1;
    attitude_init(&filter);
    for (;;) {
        imu_port_wait(&message);
        if (razor_parse(&message.text, &frame) == RAZOR_OK) {
            take(&sample, &frame, message.arrival_us);
        } else {
            sample.malformed++;
        }
        imu_server_write(&sample);
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
    (void)Task_create(task_imu, &params, NULL);
}
