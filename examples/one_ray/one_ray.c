/* A TFmini Plus in place of the scanner: on its UART, for TaskReceiveLaser and TaskSendLaser. This file
 * stands for firmware/laser_port.c, task_receive_laser.c and task_send_laser.c.
 *
 * The sensor looks where the front mirror looks, through the mirror or at its place: DF, LF and L say where
 * that is, LAYOUT is FRONT. The telemetry says laser:OK, laser:STREAM (it has not repeated its order) or
 * laser:LOST. */
#include <math.h>
#include <stddef.h>
#include <string.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "bsp/led.h"
#include "bsp/timebase.h"
#include "control/altitude.h"
#include "firmware/alive.h"
#include "firmware/geometry.h"
#include "firmware/laser_port.h"
#include "firmware/monitor.h"
#include "firmware/schedule.h"
#include "firmware/servers.h"
#include "firmware/tasks.h"
#include "firmware/uart_port.h"
#include "readings.h"
#include "tfmini.h"

#define ROOM 8U /* readings that may wait for TaskReceiveLaser: 80 ms, nearly its deadline */

typedef struct {
    float slant_mm; /* NAN: none */
    uint32_t arrival_us;
} reading_t;

/* The receive Hwi's; all others use them with interrupts off. */
static tfmini_t sensor;
static reading_t waiting[ROOM];
static uint16_t first, count;
static uint32_t overruns;

static Semaphore_Handle reading_ready, tick;

/* ---- receive Hwi ---- */

static void keep_reading(uint32_t now_us)
{
    if (count == ROOM) {
        return; /* the mean of a group does without it */
    }
    waiting[((uint16_t)(first + count)) % ROOM] = (reading_t){sensor.seen ? (float)sensor.distance_mm : NAN,
                                                              now_us};
    ++count;
    monitor_released(MONITOR_RECEIVE_LASER, now_us);
    Semaphore_post(reading_ready);
}

static uint16_t received(const bsp_uart_burst_t *burst)
{
    const uint32_t now_us = bsp_time_us();

    if (burst->framing || burst->overrun) {
        tfmini_line_broken(&sensor);
        overruns += burst->overrun ? 1U : 0U;
    }
    for (uint16_t i = 0U; i < burst->count; ++i) {
        if (tfmini_feed(&sensor, octet_of(burst->octets[i]), now_us)) {
            keep_reading(now_us);
        }
    }
    return tfmini_expected(&sensor);
}

/* ---- TaskReceiveLaser ---- */

static bool next(reading_t *reading)
{
    UInt key = Hwi_disable();
    const bool any = count > 0U;

    if (any) {
        *reading = waiting[first];
        first = (uint16_t)((first + 1U) % ROOM);
        --count;
    }
    Hwi_restore(key);
    return any;
}

static void publish(const mirror_range_t *range, uint32_t arrival_us, uint32_t rays_us)
{
    static altitude_sample_t sample;
    geometry_t geometry;
    imu_sample_t imu;
    altitude_t altitude;

    geometry_mounted(&geometry);
    imu_server_read(&imu);
    altitude = altitude_from_ranges(&geometry.places, range, 1U, imu.median.roll_rad, imu.median.pitch_rad);
    sample.scan_valid = altitude.valid;
    if (altitude.valid) {
        sample.altitude = altitude;
        sample.sensor_time_ms = (arrival_us / 1000U) & 0xFFFFFFU; /* it has no clock: ours, as a scanner's */
        sample.arrival_us = arrival_us;
        sample.age_us = arrival_us - rays_us;
        ++sample.sequence;
    } else {
        ++sample.heightless;
    }
    altitude_server_write(&sample);
    task_control_altitude_arrived();
}

static void take(const reading_t *reading)
{
    static readings_t readings;
    mirror_range_t range;
    uint32_t rays_us;

    if (readings_take(&readings, reading->slant_mm, reading->arrival_us - TFMINI_FRAME_US, MIRROR_FRONT,
                      &range, &rays_us)) {
        publish(&range, reading->arrival_us, rays_us);
    }
}

static Void task_receive_laser(UArg unused0, UArg unused1)
{
    reading_t reading;

    (void)unused0;
    (void)unused1;
    for (;;) {
        (void)Semaphore_pend(reading_ready, BIOS_WAIT_FOREVER);
        monitor_begin(MONITOR_RECEIVE_LASER);
        while (next(&reading)) {
            take(&reading);
        }
        monitor_done(MONITOR_RECEIVE_LASER);
    }
}

static Semaphore_Handle binary_semaphore(void)
{
    Semaphore_Params params;

    Semaphore_Params_init(&params);
    params.mode = Semaphore_Mode_BINARY;
    return Semaphore_create(0, &params, NULL);
}

void task_receive_laser_create(const urg_config_t *config)
{
    Task_Params params;

    (void)config; /* a scanner's */
    reading_ready = binary_semaphore();
    uart_port_create(BSP_UART_LASER, TFMINI_RATE, received);
    Task_Params_init(&params);
    params.instance->name = "TaskReceiveLaser";
    params.priority = TASK_RECEIVE_LASER_PRIORITY;
    params.stackSize = TASK_STACK_CELLS;
    monitor_watch(MONITOR_RECEIVE_LASER, Task_create(task_receive_laser, &params, NULL));
}

/* ---- TaskSendLaser ---- */

static urg_status_t status_of(const tfmini_t *now)
{
    if (bsp_time_us() - now->latest_us > TFMINI_SILENT_US || now->readings == 0U) {
        return URG_LOST;
    }
    return now->millimetres ? URG_OK : URG_STREAM;
}

static tfmini_t watched(void)
{
    tfmini_t now;
    UInt key = Hwi_disable();

    tfmini_watch(&sensor, bsp_time_us());
    now = sensor;
    Hwi_restore(key);
    return now;
}

static void supervise(void)
{
    static laser_sample_t sample;
    const tfmini_t now = watched();

    sample.status = status_of(&now);
    sample.rate = TFMINI_RATE;
    laser_server_write(&sample);
    bsp_led_blue(sample.status == URG_OK);
    bsp_led_red(sample.status == URG_LOST);
    if (!now.millimetres) {
        (void)uart_port_send(BSP_UART_LASER, tfmini_order, TFMINI_ORDER);
    }
}

static Void release(UArg unused)
{
    (void)unused;
    monitor_released(MONITOR_SEND_LASER, bsp_time_us());
    Semaphore_post(tick);
}

static Void task_send_laser(UArg unused0, UArg unused1)
{
    (void)unused0;
    (void)unused1;
    for (;;) {
        (void)Semaphore_pend(tick, BIOS_WAIT_FOREVER);
        monitor_begin(MONITOR_SEND_LASER);
        supervise();
        monitor_done(MONITOR_SEND_LASER);
        alive_report(ALIVE_SEND_LASER);
    }
}

void task_send_laser_create(void)
{
    Task_Params task;
    Clock_Params clock;

    tick = binary_semaphore();
    Clock_Params_init(&clock);
    clock.period = SEND_LASER_PERIOD_MS;
    clock.startFlag = TRUE;
    (void)Clock_create(release, SEND_LASER_PERIOD_MS, &clock, NULL);
    Task_Params_init(&task);
    task.instance->name = "TaskSendLaser";
    task.priority = TASK_SEND_LASER_PRIORITY;
    task.stackSize = TASK_STACK_CELLS;
    monitor_watch(MONITOR_SEND_LASER, Task_create(task_send_laser, &task, NULL));
}

/* For #LASER: of a scanner's figures those that this sensor has. */
void laser_port_statistics(laser_statistics_t *statistics)
{
    const tfmini_t now = watched();

    (void)memset(statistics, 0, sizeof *statistics);
    statistics->urg.status = status_of(&now);
    statistics->urg.seen.scan_count = now.readings;
    statistics->urg.scip.damaged[SCIP_DAMAGE_SUM] = now.damaged;
    statistics->overruns = overruns;
}

/* For #WALLS: one ray that looks down sees none. */
bool laser_port_newer(laser_message_t *message)
{
    (void)message;
    return false;
}
