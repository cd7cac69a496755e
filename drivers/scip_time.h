/* The sensor's clock against the host's: which host time belongs to a time stamp or to a ray. The sensor counts
 * milliseconds modulo 2^24 and runs up to a third of a percent wrong. Pure.
 *
 * Use: TM0, up to ten TM1 with scip_time_sample() each, TM2, scip_time_settle(); then scan. TM stops the scanning, so
 * between two scans nothing is asked; when time mode is entered again later (after a restart, or every few minutes of
 * rest), the second settling also measures how much faster or slower the sensor's clock runs.
 *
 * Host times are microseconds, wrapping at 2^32. */
#ifndef DRIVERS_SCIP_TIME_H
#define DRIVERS_SCIP_TIME_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/scip_info.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCIP_TIME_SAMPLES 10U

typedef struct {
    uint32_t stamp_ms;
    int32_t late_us;        /* host time of it, against what the first exchange of the series promises */
} scip_time_exchange_t;

typedef struct {
    bool known;             /* settled at least once */
    uint32_t stamp_ms;      /* the sensor's clock showed this ... */
    uint32_t host_us;       /* ... at this host time */
    int32_t skew_ppm;       /* the sensor's clock is slow by this: it needs (1 + skew) host seconds for its second */
    /* private */
    uint16_t samples;
    uint32_t first_stamp_ms;
    uint32_t first_us;      /* middle of the first exchange */
    scip_time_exchange_t series[SCIP_TIME_SAMPLES]; /* the latest last */
} scip_time_t;

void scip_time_init(scip_time_t *time);

/* One TM1: sent_us when the command's last octet left, received_us when the first octet of the reply came, timestamp_ms
 * from the reply. Samples of one series lie within 16 s; those over SCIP_TIME_SAMPLES are left out. */
void scip_time_sample(scip_time_t *time, uint32_t sent_us, uint32_t received_us, uint32_t timestamp_ms);

/* Ends the series: its median exchange becomes the pair (stamp_ms, host_us). When a pair was known, 30 s to 30 min old, skew_ppm
 * is measured too; one beyond 1 % is a restarted clock and changes nothing. False (nothing changed) without samples. */
bool scip_time_settle(scip_time_t *time);

/* Host time at which the sensor's clock showed timestamp_ms. Right for stamps within 35 minutes of the pair, where the
 * host's microseconds too are unambiguous. */
uint32_t scip_time_host_us(const scip_time_t *time, uint32_t timestamp_ms);

/* When a step is sampled after the instant of the scan's time stamp (step 0), microseconds. step: 0..ares. */
uint32_t scip_time_step_us(const scip_limits_t *limits, uint16_t step);

#ifdef __cplusplus
}
#endif

#endif
