/* From the last octet of a scan on the wire to the compare value that answers it.
 *
 * An altitude is answered by the first cycle of TaskControl that has read it, and at the instant of the
 * write; a write of the same value cannot be seen and counts when the cycle ends. Altitudes that no cycle
 * read are not counted. */
#ifndef SIM_TIMING_LATENCY_H
#define SIM_TIMING_LATENCY_H

#include <stdbool.h>
#include <stdint.h>

#include "control/parameters.h"
#include "sim/ti/sysbios/kernel.h"

/* What TaskControl waits for: its period, each height, or each height and IMU frame. */
enum { LATENCY_FRAME = RELEASE_COUNT, LATENCY_RELEASES };

typedef struct {
    long answers;
    sim_time_t shortest, longest, total;
    sim_time_t longest_since; /* last octet of that scan */
} latency_figures_t;

typedef struct {
    latency_figures_t by_release[LATENCY_RELEASES]; /* the release in force when the altitude was written */
    bool answered;                                  /* since latency_observe() was last called: an answer */
    sim_time_t answer_to;                           /* last octet of its scan */

    unsigned previous_octet;
    sim_time_t reply_end; /* latest LF LF on the wire */
    struct {
        uint32_t sequence;
        sim_time_t scan_end;
        int release;
    } written, read; /* in the Altitude server by TaskReceiveLaser, from it by TaskControl */
    uint32_t answered_sequence;
    uint32_t compare;
} latency_t;

void latency_init(latency_t *latency);

/* An octet of the scanner has come to the firmware's pin, now. */
void latency_octet(latency_t *latency, unsigned octet);

/* A kernel_observer_t; context is the latency_t. */
void latency_observe(void *latency, sim_time_t when, kernel_event_t event, const kernel_job_t *job,
                     int detail);

#endif
