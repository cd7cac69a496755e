#include <math.h>
#include <stddef.h>
#include <string.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "drivers/decimal.h"
#include "firmware/boot.h"
#include "firmware/monitor.h"
#include "firmware/pulse_stream.h"
#include "firmware/schedule.h"
#include "firmware/servers.h"
#include "firmware/surroundings.h"
#include "firmware/tasks.h"
#include "firmware/published.h"
#include "bsp/timebase.h"
#include "firmware/xbee_port.h"

/* Of 95 octets at most: each second they take a tenth of the radio's 960 at most. */
#define JOBS_A_BEAMS_LINE 5U
#define JOBS_BEFORE_DRIFT 1U /* not with the line of the beams: together they would not leave in time */

static Semaphore_Handle tick;
static uint16_t jobs; /* since the latest line of the beams */

static Void release(UArg unused)
{
    (void)unused;
    monitor_released(MONITOR_SEND_COMM, bsp_time_us());
    Semaphore_post(tick);
}

#define BATTERY_TEXT_MAX (DECIMAL_TEXT_MAX + 8U)

/* "14.8", or with a warning "14.1/LOW". NULL: not measured. */
static const char *battery_of(const flight_outputs_t *flight, char text[BATTERY_TEXT_MAX])
{
    size_t length;

    if (flight->battery == (uint16_t)BATTERY_OFF) {
        return NULL;
    }
    length = decimal_write(text, DECIMAL_TEXT_MAX, flight->battery_v, 1U);
    if (length == 0U) {
        text[length++] = '-';
    }
    text[length] = '\0';
    if (battery_warns((battery_verdict_t)flight->battery)) {
        text[length++] = '/';
        (void)strcpy(&text[length], battery_name(flight->battery));
    }
    return text;
}

/* The line tells one of reset, doubt and limit: with two of them it might not fit one packet. The flags tell
 * a doubt too, and the recorder all three. The battery goes behind it where that fits. A battery that warns
 * has the place of a limit, and every other line that of a doubt. */
static void report(telemetry_line_t *line, const flight_outputs_t *flight, const char *reset)
{
    static bool turn;
    char battery[BATTERY_TEXT_MAX];
    laser_sample_t laser;
    published_t now = {.age_us = NAN, .roll_rad = NAN, .pitch_rad = NAN, .up_mps2 = NAN};

    laser_server_read(&laser);
    now.flight = *flight;
    /* As the supervisor sees it: a height that it does not count must not look like one on the
     * operator's screen. */
    now.height_mm = ((now.flight.flags & FLIGHT_FLAG_HEIGHT) == 0U) ? now.flight.height_mm : NAN;
    now.laser = urg_status_name(laser.status);
    now.battery = battery_of(&now.flight, battery);
    const bool warns = battery_warns((battery_verdict_t)now.flight.battery);
    turn = warns && !turn;
    if (reset != NULL) {
        now.reset = reset;
    } else if (now.flight.reason != VERDICT_NONE && !turn) {
        now.doubt = verdict_name(now.flight.reason);
    } else if (!warns && now.flight.bound != BOUND_NONE && now.flight.state != FLIGHT_GROUND) {
        now.limit = bound_name(now.flight.bound);
    }
    published_telemetry(line, &now);
    if (line->overflowed) {
        now.battery = NULL;
        published_telemetry(line, &now);
    }
}

/* Answers and lists go before these lines, but not before a warning. */
static void send_surroundings(telemetry_line_t *line, const flight_outputs_t *flight)
{
    if (surroundings_line(line, flight)) {
        if (surroundings_warn()) {
            xbee_port_report(line);
        } else {
            (void)xbee_port_spare(line);
        }
    }
    if (jobs == JOBS_BEFORE_DRIFT && surroundings_drift(line)) {
        (void)xbee_port_spare(line);
    }
}

static void send(telemetry_line_t *line, const char *reset)
{
    static flight_outputs_t flight;

    flight_status_server_read(&flight);
    report(line, &flight, reset);
    xbee_port_report(line);
    send_surroundings(line, &flight);
    ++jobs;
    if (jobs == JOBS_A_BEAMS_LINE) {
        const flight_beams_t beams = published_beams_of(&flight, bsp_time_us());

        flight_beams_line(line, &beams);
        xbee_port_report(line);
        jobs = 0U;
    }
}

static Void task_send_comm(UArg unused0, UArg unused1)
{
    static telemetry_line_t line;
    const char *reset = boot_cause();

    (void)unused0;
    (void)unused1;
    for (;;) {
        (void)Semaphore_pend(tick, BIOS_WAIT_FOREVER);
        monitor_begin(MONITOR_SEND_COMM);
        /* Both would not fit the radio's 9600 bit/s, and the operator asked for the pulses. */
        if (!pulse_stream_on()) {
            send(&line, reset);
        }
        /* Told once, by the first line: whoever looks later has it by #PERF. */
        reset = NULL;
        monitor_done(MONITOR_SEND_COMM);
    }
}

void task_send_comm_create(void)
{
    Task_Params task;
    Clock_Params clock;
    Semaphore_Params semaphore;

    jobs = 0U;
    Semaphore_Params_init(&semaphore);
    semaphore.mode = Semaphore_Mode_BINARY;
    tick = Semaphore_create(0, &semaphore, NULL);
    Clock_Params_init(&clock);
    clock.period = SEND_COMM_PERIOD_MS;
    clock.startFlag = TRUE;
    (void)Clock_create(release, SEND_COMM_PERIOD_MS, &clock, NULL);
    Task_Params_init(&task);
    task.instance->name = "TaskSendComm";
    task.priority = TASK_SEND_COMM_PRIORITY;
    task.stackSize = TASK_STACK_CELLS;
    monitor_watch(MONITOR_SEND_COMM, Task_create(task_send_comm, &task, NULL));
}
