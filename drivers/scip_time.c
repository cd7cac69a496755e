#include "drivers/scip_time.h"

#define STAMP_MASK ((uint32_t)0xFFFFFFUL)
#define STAMP_SIGN ((uint32_t)0x800000UL)
#define SKEW_AFTER_MS 30000
#define SKEW_BEFORE_MS 1800000
#define SKEW_MOST_PPM 10000
#define MINUTE_US ((uint32_t)60000000UL)

/* Sensor milliseconds from one stamp to another, -2^23..2^23 - 1. */
static int32_t between_ms(uint32_t from_ms, uint32_t to_ms)
{
    const uint32_t ahead = (to_ms - from_ms) & STAMP_MASK;
    return ahead < STAMP_SIGN ? (int32_t)ahead : -(int32_t)(STAMP_MASK + 1U - ahead);
}

static uint32_t us_of(int32_t ms)
{
    return (uint32_t)ms * 1000U;
}

/* The difference of two wrapping times, -2^31..2^31 - 1. */
static int32_t difference(uint32_t later_us, uint32_t earlier_us)
{
    const uint32_t ahead = later_us - earlier_us;
    return ahead <= (uint32_t)INT32_MAX ? (int32_t)ahead : -(int32_t)(UINT32_MAX - ahead) - 1;
}

void scip_time_init(scip_time_t *time)
{
    *time = (scip_time_t){ .known = false };
}

static uint32_t due_us(const scip_time_t *time, uint32_t stamp_ms)
{
    return time->first_us + us_of(between_ms(time->first_stamp_ms, stamp_ms));
}

void scip_time_sample(scip_time_t *time, uint32_t sent_us, uint32_t received_us, uint32_t timestamp_ms)
{
    const uint32_t middle_us = sent_us + (received_us - sent_us) / 2U;
    uint16_t i = time->samples;
    if (i == SCIP_TIME_SAMPLES) {
        return;
    }
    if (i == 0U) {
        time->first_stamp_ms = timestamp_ms;
        time->first_us = middle_us;
    }
    const int32_t late_us = difference(middle_us, due_us(time, timestamp_ms));
    while (i > 0U && time->series[i - 1U].late_us > late_us) {
        time->series[i] = time->series[i - 1U];
        i--;
    }
    time->series[i] = (scip_time_exchange_t){ timestamp_ms, late_us };
    time->samples++;
}

/* Parts per million by which the host's clock gained on the sensor's between the two pairs. */
static void measure_skew(scip_time_t *time, uint32_t stamp_ms, uint32_t host_us)
{
    const int32_t elapsed_ms = between_ms(time->stamp_ms, stamp_ms);
    const int32_t gained_us = difference(host_us, time->host_us + us_of(elapsed_ms));
    if (elapsed_ms < SKEW_AFTER_MS || elapsed_ms > SKEW_BEFORE_MS) {
        return;
    }
    const int32_t skew_ppm = gained_us / (elapsed_ms / 1000);
    if (skew_ppm <= SKEW_MOST_PPM && skew_ppm >= -SKEW_MOST_PPM) {
        time->skew_ppm = skew_ppm;
    }
}

bool scip_time_settle(scip_time_t *time)
{
    if (time->samples == 0U) {
        return false;
    }
    const scip_time_exchange_t median = time->series[time->samples / 2U];
    const uint32_t host_us = due_us(time, median.stamp_ms) + (uint32_t)median.late_us;
    if (time->known) {
        measure_skew(time, median.stamp_ms, host_us);
    }
    time->known = true;
    time->stamp_ms = median.stamp_ms;
    time->host_us = host_us;
    time->samples = 0U;
    return true;
}

uint32_t scip_time_host_us(const scip_time_t *time, uint32_t timestamp_ms)
{
    const int32_t elapsed_ms = between_ms(time->stamp_ms, timestamp_ms);
    const int32_t skew_us = elapsed_ms / 1000 * time->skew_ppm + elapsed_ms % 1000 * time->skew_ppm / 1000;
    return time->host_us + us_of(elapsed_ms) + (uint32_t)skew_us;
}

uint32_t scip_time_step_us(const scip_limits_t *limits, uint16_t step)
{
    const uint32_t revolution_us = MINUTE_US / limits->scan_rpm;
    return revolution_us / limits->ares * step + revolution_us % limits->ares * step / limits->ares;
}
