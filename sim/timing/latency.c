#include "sim/timing/latency.h"

#include <string.h>

#include "control/flight_io.h"
#include "sim/firmware_view.h"
#include "sim/ti/driverlib/chip.h"

void latency_init(latency_t *latency)
{
    memset(latency, 0, sizeof *latency);
}

void latency_octet(latency_t *latency, unsigned octet)
{
    if (octet == '\n' && latency->previous_octet == '\n') {
        latency->reply_end = timeline_now();
    }
    latency->previous_octet = octet;
}

static bool left(kernel_event_t event, int gate, const char *name)
{
    return event == KERNEL_GATE_LEFT && strcmp(kernel_gate_name(gate), name) == 0;
}

static int release_in_force(void)
{
    const uint16_t releases = firmware_view_releases();

    if ((releases & FLIGHT_RELEASE_FRAME) != 0U) {
        return LATENCY_FRAME;
    }
    return (releases & FLIGHT_RELEASE_HEIGHT) != 0U ? (int)RELEASE_SCAN : (int)RELEASE_FREE;
}

static void note_write(latency_t *latency)
{
    const uint32_t heights = firmware_view_heights();

    if (heights != latency->written.sequence) {
        latency->written.sequence = heights;
        latency->written.scan_end = latency->reply_end;
        latency->written.release = release_in_force();
    }
}

static void count(latency_figures_t *figures, sim_time_t scan_end, sim_time_t taken)
{
    if (figures->answers == 0 || taken < figures->shortest) {
        figures->shortest = taken;
    }
    if (taken > figures->longest) {
        figures->longest = taken;
        figures->longest_since = scan_end;
    }
    figures->answers++;
    figures->total += taken;
}

static void answer(latency_t *latency, sim_time_t when)
{
    latency->answered = true;
    latency->answer_to = latency->read.scan_end;
    latency->answered_sequence = latency->read.sequence;
    count(&latency->by_release[latency->read.release], latency->read.scan_end, when - latency->read.scan_end);
}

static void follow_control(latency_t *latency, sim_time_t when, kernel_event_t event, int detail)
{
    uint32_t compare = chip_register("EPWM2.CMPA");

    if (latency->read.sequence != latency->answered_sequence &&
        (compare != latency->compare || event == KERNEL_FINISHED)) {
        answer(latency, when);
    }
    latency->compare = compare;
    if (left(event, detail, "Altitude_server")) {
        latency->read = latency->written;
    }
}

void latency_observe(void *context, sim_time_t when, kernel_event_t event, const kernel_job_t *job,
                     int detail)
{
    latency_t *latency = context;

    latency->answered = false;
    if (job->kind != KERNEL_TASK) {
        return;
    }
    if (strcmp(job->name, "TaskReceiveLaser") == 0 && left(event, detail, "Altitude_server")) {
        note_write(latency);
    } else if (strcmp(job->name, "TaskControl") == 0) {
        follow_control(latency, when, event, detail);
    }
}
