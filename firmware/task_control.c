#include <stddef.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Event.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "firmware/alive.h"
#include "control/battery_orders.h"
#include "firmware/calibrator.h"
#include "control/flight.h"
#include "control/stick_orders.h"
#include "firmware/flight_recorder.h"
#include "firmware/monitor.h"
#include "firmware/pulse_stream.h"
#include "firmware/schedule.h"
#include "bsp/receiver.h"
#include "bsp/selector.h"
#include "firmware/servers.h"
#include "firmware/tasks.h"
#include "bsp/throttle.h"
#include "bsp/timebase.h"
#include "bsp/voltmeter.h"

#define EVENT_PERIOD Event_Id_00
#define EVENT_ALTITUDE Event_Id_01
#define EVENT_IMU Event_Id_02
#define EVENT_ROLL Event_Id_03

static Event_Handle event;
static UInt in_force;
static flight_t flight;
static stick_t stick;
static stick_orders_t orders;
static battery_t battery;
static battery_orders_t battery_orders;

/* An event that the law does not wait for is posted all the same: the law may change, and then it is
 * there. It releases no job, so it is not measured as one. */
static void post(UInt release)
{
    if ((release & in_force) != 0U) {
        monitor_released(MONITOR_CONTROL, bsp_time_us());
    }
    Event_post(event, release);
}

static Void period_over(UArg unused)
{
    (void)unused;
    post(EVENT_PERIOD);
}

void task_control_altitude_arrived(void)
{
    post(EVENT_ALTITUDE);
}

void task_control_imu_arrived(void)
{
    post(EVENT_IMU);
}

void task_control_rolls(void)
{
    post(EVENT_ROLL);
}

static UInt events_of(uint16_t releases)
{
    return EVENT_ROLL | (((releases & FLIGHT_RELEASE_PERIOD) != 0U) ? EVENT_PERIOD : 0U) |
           (((releases & FLIGHT_RELEASE_HEIGHT) != 0U) ? EVENT_ALTITUDE : 0U) |
           (((releases & FLIGHT_RELEASE_FRAME) != 0U) ? EVENT_IMU : 0U);
}

/* The next release of the same kind: later the cycle would act on what the next one already knows
 * better. */
static uint32_t deadline_ms(UInt release)
{
    if ((release & EVENT_IMU) != 0U) {
        return TASK_CONTROL_FRAME_DEADLINE_MS;
    }
    return ((release & EVENT_ALTITUDE) != 0U) ? TASK_CONTROL_SCAN_DEADLINE_MS : TASK_CONTROL_DEADLINE_MS;
}

/* The time-out is the last resort: a scanner or an IMU that falls silent must not stop the control,
 * which has to notice exactly that. */
static void wait(uint16_t releases)
{
    in_force = events_of(releases);
    monitor_set_deadline(MONITOR_CONTROL, deadline_ms(in_force) * UINT32_C(1000));
    (void)Event_pend(event, Event_Id_NONE, in_force, CONTROL_TIMEOUT_MS);
    monitor_begin(MONITOR_CONTROL);
}

/* Returns the latest sample. */
static const imu_sample_t *read_frames(flight_inputs_t *in)
{
    static imu_sample_t history[IMU_HISTORY];

    in->frame_count = imu_server_history(history);
    in->frames = history;
    return &history[(in->frame_count > 0U) ? in->frame_count - 1U : 0U];
}

static void read_inputs(const parameters_t *parameters, flight_inputs_t *in, scan_signal_t *signal)
{
    static altitude_sample_t altitude; /* the inputs point to its mirrors */
    const imu_sample_t *imu;
    reference_sample_t reference;

    /* One after the other, not in one gate. Each value has its own instant, and the estimator wants
     * that, not that all be equally old. */
    altitude_server_read(&altitude);
    imu = read_frames(in);
    reference_server_read(&reference);
    /* Behind the reads: what was read is then never later than now. */
    in->now_us = bsp_time_us();
    in->height_valid = altitude.scan_valid;
    in->height_time_us = altitude.arrival_us;
    in->height_sequence = altitude.sequence;
    in->height_stamp_ms = altitude.sensor_time_ms;
    in->height_age_us = altitude.age_us;
    in->altitude = altitude.altitude;
    in->mirrors = (altitude.mirror_count > 1U) ? altitude.mirrors : NULL;
    *signal = altitude.signal;
    in->attitude_ready = imu->ready;
    in->roll_rad = imu->median.roll_rad;
    in->pitch_rad = imu->median.pitch_rad;
    in->attitude_time_us = imu->arrival_us;
    in->reference_m = reference.reference_m;
    in->reference_sequence = reference.sequence;
    in->arm = reference.arm;
    in->arm_sequence = reference.arm_sequence;
    in->link_time_us = reference.link_time_us;
    in->link_sequence = reference.link_sequence;
    in->has_throttle = parameters_choice(parameters, PARAMETER_SEL) == SEL_NONE || bsp_selector_ours();
}

/* Adds what the pilot's stick orders to the operator's requests. before: outputs of the previous cycle. */
static void read_stick(const parameters_t *parameters, const flight_outputs_t *before, flight_inputs_t *in)
{
    static uint32_t read_us;
    float pulse_us = 0.0F;
    const bool came = bsp_receiver_take(&pulse_us);

    stick_step(&stick, came, pulse_us, (float)(in->now_us - read_us) * 1.0e-6F);
    read_us = in->now_us;
    stick_orders_step(&orders, parameters, &stick, before, in);
}

/* Adds what an empty battery orders to the requests of operator and stick. */
static void read_battery(const parameters_t *parameters, const flight_outputs_t *before, flight_inputs_t *in)
{
    static uint32_t read_us;
    float pin_v = 0.0F;
    const bool came = bsp_voltmeter_take(&pin_v);

    battery_step(&battery, parameters, came, pin_v, before->state != FLIGHT_GROUND,
                 (float)(in->now_us - read_us) * 1.0e-6F);
    read_us = in->now_us;
    battery_orders_step(&battery_orders, battery_verdict(&battery, parameters), before, in);
}

static Void task_control(UArg unused0, UArg unused1)
{
    static parameters_t parameters;
    static flight_inputs_t in;
    static flight_outputs_t out = FLIGHT_OUTPUTS_INITIAL;

    (void)unused0;
    (void)unused1;
    parameter_server_read(&parameters);
    /* Only for the first wait; each cycle tells what releases the next. */
    out.releases = flight_releases(&flight, &parameters);
    for (;;) {
        wait(out.releases);
        parameter_server_read(&parameters);
        read_inputs(&parameters, &in, &out.signal);
        read_stick(&parameters, &out, &in);
        read_battery(&parameters, &out, &in);
        flight_step(&flight, &parameters, &in, &out);
        out.flags |= stick_orders_flag(&orders, &parameters, &stick, in.has_throttle);
        out.stick_us = stick_is_good(&stick) ? stick_pulse_us(&stick) : NAN;
        out.battery = (uint16_t)battery_verdict(&battery, &parameters);
        out.battery_v = (out.battery == (uint16_t)BATTERY_OFF) ? NAN : battery_v(&battery);
        calibrator_overlay(parameters.value[PARAMETER_LINK], &in, &out);
        /* As soon as it is known. All that only reports comes behind. */
        bsp_throttle_set_pulse_us(out.pulse_us);
        pulse_stream_take(out.pulse_us);
        flight_status_server_write(&out);
        flight_recorder_take(&in, &out);
        monitor_done(MONITOR_CONTROL);
        /* Last: a task that hangs anywhere above must not service the watchdog. */
        alive_report(ALIVE_CONTROL);
    }
}

void task_control_create(void)
{
    Clock_Params clock;
    Task_Params task;

    flight_init(&flight);
    stick = (stick_t){.count = 0U};
    orders = (stick_orders_t){.counts = false};
    battery = (battery_t){.believed = false};
    battery_orders = (battery_orders_t){.landing = false};
    event = Event_create(NULL, NULL);
    Clock_Params_init(&clock);
    clock.period = CONTROL_PERIOD_MS;
    clock.startFlag = TRUE;
    (void)Clock_create(period_over, CONTROL_PERIOD_MS, &clock, NULL);
    Task_Params_init(&task);
    task.instance->name = "TaskControl";
    task.priority = TASK_CONTROL_PRIORITY;
    task.stackSize = TASK_CONTROL_STACK_CELLS;
    monitor_watch(MONITOR_CONTROL, Task_create(task_control, &task, NULL));
}
