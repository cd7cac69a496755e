#include "sim/timing/instruments.h"

#include "sim/board.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/timing/trace.h"

static struct {
    bool tracing;
    timing_t timing;
    latency_t latency;
    trace_t trace;
} instruments;

static void observe(void *unused, sim_time_t when, kernel_event_t event, const kernel_job_t *job, int detail)
{
    (void)unused;
    timing_observe(&instruments.timing, when, event, job, detail);
    latency_observe(&instruments.latency, when, event, job, detail);
    if (instruments.tracing) {
        trace_observe(&instruments.trace, when, event, job, detail);
        if (instruments.latency.answered) {
            trace_answer(&instruments.trace, instruments.latency.answer_to, chip_register("EPWM2.CMPA"));
        }
    }
}

static void octet_arrived(board_wire_t wire, unsigned octet, double bit_ns)
{
    if (wire != BOARD_LASER) {
        return;
    }
    latency_octet(&instruments.latency, octet);
    if (instruments.tracing) {
        trace_laser_octet(&instruments.trace, octet, bit_ns);
    }
}

static void pulse(sim_time_t high_ns)
{
    if (instruments.tracing) {
        trace_pulse(&instruments.trace, high_ns);
    }
}

void instruments_connect(const timing_limits_t *limits, int limit_count, FILE *trace)
{
    instruments.tracing = trace != NULL;
    timing_init(&instruments.timing, limits, limit_count);
    latency_init(&instruments.latency);
    if (instruments.tracing) {
        trace_open(&instruments.trace, trace);
    }
    kernel_observe(observe, NULL);
    board_probe(BOARD_PROBE_TIMING, &(board_probes_t){.octet = octet_arrived, .pulse = pulse});
}

void instruments_disconnect(void)
{
    kernel_observe(NULL, NULL);
    board_probe(BOARD_PROBE_TIMING, NULL);
    timing_conclude(&instruments.timing);
    if (instruments.tracing) {
        trace_close(&instruments.trace);
    }
    instruments.tracing = false;
}

const timing_t *instruments_timing(void)
{
    return &instruments.timing;
}

const latency_t *instruments_latency(void)
{
    return &instruments.latency;
}
