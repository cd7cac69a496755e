/* TaskControl preempts TaskReceiveComm and not the other way round: the writer needs no lock, the reader
 * turns interrupts off for the copy of one record. */
#include "firmware/flight_recorder.h"

#include <math.h>
#include <string.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <xdc/std.h>

#define RECORDS FLIGHT_RECORDER_RECORDS
#define CYCLE_MIN_MS 45U
#define US_PER_MS 1000U
#define MS_PER_S 1000U

/* Above 10000H there is memory that stacks cannot use. */
#ifdef __TMS320C28XX__
#pragma DATA_SECTION(ring, ".flight_log")
#endif
static uint16_t ring[RECORDS][FLIGHT_LOG_CELLS];
static uint32_t oldest; /* changed by both tasks */
static uint32_t next;

static struct {
    uint32_t now_us;
    uint32_t rest_us; /* not yet a millisecond */
    uint32_t now_ms;
    uint32_t taken_ms;
    bool active; /* the latest cycle was one to record */
} clock;

static uint32_t tell_ms(uint32_t now_us)
{
    clock.rest_us += now_us - clock.now_us;
    clock.now_us = now_us;
    clock.now_ms += clock.rest_us / US_PER_MS;
    clock.rest_us %= US_PER_MS;
    return clock.now_ms;
}

static void append(const flight_log_t *record)
{
    flight_log_pack(ring[next % RECORDS], record);
    next++;
    if (next - oldest > RECORDS) {
        oldest = next - RECORDS;
    }
    clock.taken_ms = record->time_ms;
}

void flight_recorder_take(const flight_inputs_t *in, const flight_outputs_t *out)
{
    const bool active = out->state != FLIGHT_GROUND || out->thrust_n > out->idle_n;
    const bool wanted = active || clock.active;
    const float height_mm = in->height_valid ? in->altitude.height_mm : NAN;
    const flight_log_t record = {
        .time_ms = tell_ms(in->now_us),
        .height_mm = height_mm,
        .estimate_mm = out->estimate_mm,
        .innovation_mm = out->innovation_mm,
        .reference_m = out->reference_m,
        .thrust_n = out->thrust_n,
        .roll_rad = in->attitude_ready ? in->roll_rad : NAN,
        .pitch_rad = in->attitude_ready ? in->pitch_rad : NAN,
        .state = (uint16_t)out->state,
        .flags = out->flags,
    };

    clock.active = active;
    if (wanted && (next == oldest || record.time_ms - clock.taken_ms >= CYCLE_MIN_MS)) {
        append(&record);
    }
}

flight_recorder_span_t flight_recorder_span(void)
{
    UInt key = Hwi_disable();
    const flight_recorder_span_t span = {oldest, next};

    Hwi_restore(key);
    return span;
}

bool flight_recorder_read(uint32_t number, flight_log_t *record)
{
    uint16_t cells[FLIGHT_LOG_CELLS];
    UInt key = Hwi_disable();
    const bool there = number - oldest < next - oldest;

    if (there) {
        (void)memcpy(cells, ring[number % RECORDS], sizeof cells);
    }
    Hwi_restore(key);
    if (there) {
        flight_log_unpack(record, cells);
    }
    return there;
}

uint32_t flight_recorder_since(uint16_t seconds)
{
    const flight_recorder_span_t span = flight_recorder_span();
    const uint32_t back_ms = (uint32_t)seconds * MS_PER_S;
    uint32_t first = span.next;
    flight_log_t newest;
    flight_log_t record;

    if (!flight_recorder_read(span.next - 1U, &newest)) {
        return first;
    }
    while (flight_recorder_read(first - 1U, &record) && newest.time_ms - record.time_ms <= back_ms) {
        first--;
    }
    return first;
}

void flight_recorder_clear(void)
{
    UInt key = Hwi_disable();

    oldest = next;
    Hwi_restore(key);
}
