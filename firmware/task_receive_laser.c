#include <stddef.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "control/altitude.h"
#include "firmware/geometry.h"
#include "firmware/laser_port.h"
#include "firmware/monitor.h"
#include "firmware/schedule.h"
#include "drivers/scip_layout.h"
#include "firmware/servers.h"
#include "firmware/tasks.h"

/* The slants of one scan, as heights. Which of them are believed is for control/sense to say. */
static void heights_of(altitude_t *mirrors, const geometry_t *geometry, const scip_scan_t *scan,
                       const attitude_t *tilt)
{
    mirror_range_t ranges[SCIP_GROUPS_MAX];

    for (uint16_t i = 0U; i < geometry->layout.group_count; ++i) {
        const scip_group_t *const group = &geometry->layout.groups[i];
        const scip_group_mean_t mean = scip_group_mean(scan, group);
        const scip_group_steps_t steps = scip_group_steps(scan, group, &mean);

        ranges[i].mirror = geometry->windows.mirror[i];
        ranges[i].valid = mean.valid;
        ranges[i].slant_mm = mean.mean_mm;
        ranges[i].spread_mm = mean.spread_mm;
        ranges[i].good_rays = mean.good_rays;
        ranges[i].aside_steps = steps.mean - geometry->windows.axis[i];
        ranges[i].wide_steps2 = steps.variance;
        ranges[i].later_us = scip_group_later_us(scan, group);
    }
    altitude_of_mirrors(mirrors, &geometry->places, ranges, geometry->layout.group_count, tilt->roll_rad,
                        tilt->pitch_rad);
}

static beam_signal_t beam_of(const altitude_t *mirror, uint32_t age_us)
{
    return (beam_signal_t){
        .looked = true,
        .told = mirror->valid,
        .good_rays = mirror->good_rays,
        .slant_mm = mirror->slant_mm,
        .spread_mm = mirror->spread_mm,
        .age_us = age_us - (uint32_t)mirror->later_us,
    };
}

/* Of every scan: one without a height is the one that people want to see. */
static void tell_signal(scan_signal_t *signal, const altitude_t *mirrors, const mirror_windows_t *windows,
                        uint32_t arrival_us, uint32_t age_us)
{
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        signal->beams[m] = (beam_signal_t){.looked = false};
    }
    for (uint16_t i = 0U; i < windows->count; ++i) {
        signal->beams[windows->mirror[i]] = beam_of(&mirrors[windows->mirror[i]], age_us);
    }
    signal->arrival_us = arrival_us;
    ++signal->scans;
}

static void publish_height(altitude_sample_t *sample, const laser_message_t *message)
{
    imu_sample_t imu;
    altitude_t mirrors[MIRROR_COUNT];
    geometry_t geometry;
    const uint32_t age_us = scip_rays_age_us(&message->scan, message->bit_rate);

    /* The latest tilt, not that of the rays, which are 70 ms older. The estimator corrects that with
     * its history; the other laws fly as the seed's did. */
    imu_server_read(&imu);
    /* For each scan: the operator may have set another layout between the order and this scan. Rays
     * that were not ordered then are missing, and their group is not valid. */
    geometry_mounted(&geometry);
    heights_of(mirrors, &geometry, &message->scan, &imu.median);
    tell_signal(&sample->signal, mirrors, &geometry.windows, message->arrival_us, age_us);
    const altitude_t altitude = altitude_mean(mirrors, altitude_weights_equal, MIRROR_COUNT);
    sample->scan_valid = altitude.valid;
    /* Without a height the old one stays, with its own times: the supervisor sees by them how old it
     * is. */
    if (altitude.valid) {
        sample->altitude = altitude;
        sample->mirror_count = geometry.windows.count;
        for (uint16_t i = 0U; i < MIRROR_COUNT; ++i) {
            sample->mirrors[i] = mirrors[i];
        }
        sample->sensor_time_ms = message->scan.timestamp_ms;
        sample->arrival_us = message->arrival_us;
        sample->age_us = age_us - (uint32_t)altitude.later_us;
        ++sample->sequence;
    } else {
        ++sample->heightless;
    }
    altitude_server_write(sample);
    /* Also without a height: a law that is released by scans must run to notice that heights are
     * missing. */
    task_control_altitude_arrived();
}

static Void task_receive_laser(UArg unused0, UArg unused1)
{
    static laser_message_t message;
    static altitude_sample_t sample;

    (void)unused0;
    (void)unused1;
    for (;;) {
        laser_port_wait(&message);
        monitor_begin(MONITOR_RECEIVE_LASER);
        publish_height(&sample, &message);
        monitor_done(MONITOR_RECEIVE_LASER);
    }
}

void task_receive_laser_create(const urg_config_t *config)
{
    Task_Params params;

    laser_port_create(config);
    Task_Params_init(&params);
    params.instance->name = "TaskReceiveLaser";
    params.priority = TASK_RECEIVE_LASER_PRIORITY;
    params.stackSize = TASK_STACK_CELLS;
    monitor_watch(MONITOR_RECEIVE_LASER, Task_create(task_receive_laser, &params, NULL));
}
