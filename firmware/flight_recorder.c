/* TaskControl preempts TaskReceiveComm and not the other way round: the writer needs no lock, the reader
 * turns interrupts off for the copy of one record. */
#include "firmware/flight_recorder.h"

#include <math.h>
#include <string.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <xdc/std.h>

#include "control/est/estimator.h"

#define RECORDS FLIGHT_RECORDER_RECORDS
#define FRONT_CELLS (PUBLISHED_CELLS / 2U)
#define CYCLE_MIN_MS 45U
#define SAME_INSTANT_US UINT32_C(3000) /* a frame that releases a cycle is not recorded apart from it */
#define US_PER_MS 1000U
#define MS_PER_S 1000U

/* Above 10000H there is memory that stacks cannot use. */
#ifdef __TMS320C28XX__
#pragma DATA_SECTION(front, ".flight_log")
#pragma DATA_SECTION(back, ".flight_log")
#endif
/* Halves of the same records: an array may have 32767 octets at most where an int has 16 bits. */
static uint16_t front[RECORDS][FRONT_CELLS];
static uint16_t back[RECORDS][PUBLISHED_CELLS - FRONT_CELLS];
static uint32_t oldest; /* changed by both tasks */
static uint32_t next;
static flight_recorder_rate_t rate;

static struct {
    uint32_t now_us;
    uint32_t rest_us; /* not yet a millisecond */
    uint32_t now_ms;
    uint32_t taken_ms;
    bool active; /* the latest cycle was one to record */
} clock;

static struct {
    published_t record;      /* of the latest cycle: what it commanded is in force until the next */
    uint32_t height_time_us; /* arrival of its height */
    uint32_t height_age_us;  /* that it had then */
    uint32_t frame;          /* sequence of the latest frame that was recorded */
    uint32_t scans;          /* so many had come when the beams were recorded last */
} latest;

/* The clock in microseconds wraps after 71 minutes. This one counts on, and keeps the remainder, so
 * that it does not lag. */
static uint32_t tell_ms(uint32_t now_us)
{
    clock.rest_us += now_us - clock.now_us;
    clock.now_us = now_us;
    clock.now_ms += clock.rest_us / US_PER_MS;
    clock.rest_us %= US_PER_MS;
    return clock.now_ms;
}

/* The oldest record goes. A flight's end matters more than its beginning: that is where things went
 * wrong. */
static void append(const published_t *record)
{
    uint16_t cells[PUBLISHED_CELLS];

    published_pack(cells, record);
    (void)memcpy(front[next % RECORDS], cells, sizeof front[0]);
    (void)memcpy(back[next % RECORDS], &cells[FRONT_CELLS], sizeof back[0]);
    ++next;
    if (next - oldest > RECORDS) {
        oldest = next - RECORDS;
    }
    clock.taken_ms = record->time_ms;
}

static float age_us(uint32_t instant_us)
{
    return (float)(instant_us - latest.height_time_us + latest.height_age_us);
}

static published_t record_of(const flight_inputs_t *in, const flight_outputs_t *out)
{
    return (published_t){
        .time_ms = tell_ms(in->now_us),
        .height_mm = out->height_mm,
        .age_us = NAN,
        .roll_rad = in->attitude_ready ? in->roll_rad : NAN,
        .pitch_rad = in->attitude_ready ? in->pitch_rad : NAN,
        .up_mps2 = NAN,
        .beams = flight_beams_none(),
        .flight = *out,
    };
}

/* Each scan once: what its beams showed goes on counting until the next one. */
static flight_beams_t new_beams(const flight_inputs_t *in, const flight_outputs_t *out)
{
    if (out->signal.scans == latest.scans) {
        return flight_beams_none();
    }
    latest.scans = out->signal.scans;
    return published_beams_of(out, in->now_us);
}

/* A difference beyond half the range is a frame from before, not one of the far future. */
static bool is_new(const imu_sample_t *frame)
{
    return frame->sequence - latest.frame < UINT32_C(0x80000000) && frame->sequence != latest.frame &&
           frame->ready && frame->has_acceleration;
}

/* A frame between two cycles: what the cycle before it commanded is in force. */
static void append_frame(const imu_sample_t *frame, uint32_t before_us)
{
    published_t record = latest.record;

    record.time_ms = clock.now_ms - before_us / US_PER_MS;
    record.roll_rad = frame->median.roll_rad;
    record.pitch_rad = frame->median.pitch_rad;
    record.up_mps2 = imu_up_mps2(frame);
    record.age_us = isnan(record.height_mm) ? NAN : age_us(frame->arrival_us);
    append(&record);
}

/* Records the new frames that came before this cycle; gives the acceleration of the one that came with it. */
static float take_frames(const flight_inputs_t *in, bool apart)
{
    float up_mps2 = NAN;

    for (uint16_t i = 0U; i < in->frame_count; ++i) {
        const imu_sample_t *frame = &in->frames[i];
        const uint32_t before_us = in->now_us - frame->arrival_us;

        if (!is_new(frame)) {
            continue;
        }
        latest.frame = frame->sequence;
        up_mps2 = imu_up_mps2(frame);
        if (apart && before_us > SAME_INSTANT_US &&
            latest.record.time_ms <= clock.now_ms - before_us / US_PER_MS) {
            append_frame(frame, before_us);
            up_mps2 = NAN;
        }
    }
    return up_mps2;
}

static void keep(const flight_inputs_t *in, published_t *record)
{
    latest.height_time_us = in->height_time_us;
    latest.height_age_us = in->height_age_us;
    record->age_us = isnan(record->height_mm) ? NAN : age_us(in->now_us);
    latest.record = *record;
}

void flight_recorder_take(const flight_inputs_t *in, const flight_outputs_t *out)
{
    const bool active = out->state != FLIGHT_GROUND || out->thrust_n > out->idle_n;
    /* One cycle more than the flight has: it shows the thrust that the landing ended with. */
    const bool wanted = active || clock.active;
    const bool fast = rate == FLIGHT_RECORDER_FAST;
    published_t record = record_of(in, out);
    const bool due = wanted && (fast || next == oldest || record.time_ms - clock.taken_ms >= CYCLE_MIN_MS);

    if (due) {
        record.up_mps2 = take_frames(in, fast && clock.active);
    }
    clock.active = active;
    keep(in, &record);
    if (due) {
        record.beams = new_beams(in, out);
        append(&record);
    }
}

void flight_recorder_set_rate(flight_recorder_rate_t wanted)
{
    rate = wanted;
}

flight_recorder_span_t flight_recorder_span(void)
{
    UInt key = Hwi_disable();
    const flight_recorder_span_t span = {oldest, next};

    Hwi_restore(key);
    return span;
}

/* Interrupts are off for the copy only. The numbers are unpacked behind it: that takes longer, and
 * no interrupt has to wait for it. */
bool flight_recorder_read(uint32_t number, published_t *record)
{
    uint16_t cells[PUBLISHED_CELLS];
    UInt key = Hwi_disable();
    const bool there = number - oldest < next - oldest;

    if (there) {
        (void)memcpy(cells, front[number % RECORDS], sizeof front[0]);
        (void)memcpy(&cells[FRONT_CELLS], back[number % RECORDS], sizeof back[0]);
    }
    Hwi_restore(key);
    if (there) {
        published_unpack(record, cells);
    }
    return there;
}

/* From the newest record back, not from now: after the landing the last 10 s are those of the flight. */
uint32_t flight_recorder_since(uint16_t seconds)
{
    const flight_recorder_span_t span = flight_recorder_span();
    const uint32_t back_ms = (uint32_t)seconds * MS_PER_S;
    uint32_t first = span.next;
    published_t newest;
    published_t record;

    if (!flight_recorder_read(span.next - 1U, &newest)) {
        return first;
    }
    while (flight_recorder_read(first - 1U, &record) && newest.time_ms - record.time_ms <= back_ms) {
        --first;
    }
    return first;
}

void flight_recorder_clear(void)
{
    UInt key = Hwi_disable();

    oldest = next;
    Hwi_restore(key);
}
