#include "firmware/flight_recorder.h"

#include <math.h>
#include <string.h>

#include "kernel.h"
#include "unity.h"

#define CYCLE_US 108000U

static flight_inputs_t in;
static flight_outputs_t out;
static imu_sample_t frames[4];

void setUp(void)
{
    kernel_reset();
    flight_recorder_set_rate(FLIGHT_RECORDER_SLOW);
    in.frame_count = 0U;
    in.frames = frames;
    in.height_valid = true;
    in.attitude_ready = true;
    out.state = FLIGHT_GROUND;
    out.thrust_n = 0.0F;
    in.now_us += 1000000U;
    flight_recorder_take(&in, &out); /* ends what the test before began */
    in.now_us += 1000000U;
    flight_recorder_take(&in, &out);
    flight_recorder_clear();
}

void tearDown(void)
{
    kernel_check();
}

static void take(uint32_t after_us)
{
    in.now_us += after_us;
    flight_recorder_take(&in, &out);
}

static uint32_t held(void)
{
    const flight_recorder_span_t span = flight_recorder_span();

    return span.next - span.oldest;
}

static published_t newest(void)
{
    published_t record;

    TEST_ASSERT_TRUE(flight_recorder_read(flight_recorder_span().next - 1U, &record));
    return record;
}

static void fly(float thrust_n)
{
    out.state = FLIGHT_FLYING;
    out.thrust_n = thrust_n;
}

void test_a_cycle_is_recorded_as_it_was(void)
{
    published_t record;

    fly(7.01F);
    out.height_mm = 601.0F;
    in.roll_rad = 0.05F;
    in.pitch_rad = -0.02F;
    out.reference_m = 0.6F;
    out.flags = 3U;
    out.estimate_mm = 598.0F;
    out.innovation_mm = -4.0F;
    take(CYCLE_US);
    record = newest();
    TEST_ASSERT_EQUAL_FLOAT(598.0F, record.flight.estimate_mm);
    TEST_ASSERT_EQUAL_FLOAT(-4.0F, record.flight.innovation_mm);
    TEST_ASSERT_EQUAL_FLOAT(601.0F, record.height_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, record.flight.reference_m);
    TEST_ASSERT_EQUAL_FLOAT(7.01F, record.flight.thrust_n);
    TEST_ASSERT_FLOAT_WITHIN(0.0001F, 0.05F, record.roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(0.0001F, -0.02F, record.pitch_rad);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLYING, record.flight.state);
    TEST_ASSERT_EQUAL_UINT16(3U, record.flight.flags);
    out.height_mm = NAN;
    in.attitude_ready = false;
    take(CYCLE_US);
    record = newest();
    TEST_ASSERT_TRUE(isnan(record.height_mm) && isnan(record.roll_rad) && isnan(record.pitch_rad));
}

void test_on_the_ground_nothing_is_recorded_but_the_one_cycle_after_a_flight(void)
{
    take(CYCLE_US);
    TEST_ASSERT_EQUAL_UINT32(0, held());
    fly(7.0F);
    take(CYCLE_US);
    take(CYCLE_US);
    out.state = FLIGHT_GROUND;
    out.thrust_n = 0.0F;
    for (int i = 0; i < 100; i++) {
        take(CYCLE_US);
    }
    TEST_ASSERT_EQUAL_UINT32(3, held());
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_GROUND, newest().flight.state);
    out.thrust_n = 0.17F;
    take(CYCLE_US);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(4, held(), "thrust on the ground is recorded: hover calibration");
}

/* An hour of armed motors must not overwrite the flight before it. */
void test_the_armed_idle_on_the_ground_is_not_recorded(void)
{
    out.state = FLIGHT_GROUND;
    out.thrust_n = out.idle_n = 1.764F;
    for (int i = 0; i < 100; i++) {
        take(CYCLE_US);
    }
    TEST_ASSERT_EQUAL_UINT32(0, held());
    out.thrust_n = 1.9F;
    take(CYCLE_US);
    TEST_ASSERT_EQUAL_UINT32(1, held());
}

void test_fast_cycles_are_thinned_out_to_one_in_fifty_milliseconds(void)
{
    fly(7.0F);
    for (int i = 0; i < 400; i++) {
        take(25000U);
    }
    TEST_ASSERT_UINT32_WITHIN(1, 200, held());
}

/* So many new frames, 25 ms apart, the latest so long before the cycle. All but the latest four are lost. */
static void frames_before(uint16_t count, uint32_t latest_us)
{
    static uint32_t sequence;

    in.frame_count = count;
    for (uint16_t i = 0U; i < count; i++) {
        frames[i] = (imu_sample_t){.sequence = ++sequence,
                                   .arrival_us = in.now_us - latest_us - 25000U * (uint32_t)(count - 1U - i),
                                   .ready = true,
                                   .has_acceleration = true,
                                   .median = {.roll_rad = 0.001F * (float)i},
                                   .down_mps2 = 9.80665F + (float)i};
    }
}

static published_t back(uint32_t records)
{
    published_t record;

    TEST_ASSERT_TRUE(flight_recorder_read(flight_recorder_span().next - 1U - records, &record));
    return record;
}

void test_fast_records_each_frame_with_what_the_cycle_before_it_commanded(void)
{
    flight_recorder_set_rate(FLIGHT_RECORDER_FAST);
    fly(7.0F);
    out.height_mm = 600.0F;
    in.height_time_us = in.now_us + 108000U - 10000U;
    in.height_age_us = 72000U;
    take(CYCLE_US);
    TEST_ASSERT_FLOAT_WITHIN(0.01e3F, 82.0e3F, newest().age_us);
    in.now_us += 100000U;
    frames_before(4U, 20000U);
    out.thrust_n = 8.0F;
    const uint32_t before = held();

    take(0U);
    TEST_ASSERT_EQUAL_UINT32(before + 5U, held());
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 8.0F, newest().flight.thrust_n);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, thrust_to_pulse_us(8.0F), newest().flight.pulse_us);
    TEST_ASSERT_TRUE_MESSAGE(isnan(newest().up_mps2), "the latest frame has a record of its own");
    for (uint32_t i = 1U; i <= 4U; i++) {
        TEST_ASSERT_FLOAT_WITHIN(0.001F, 7.0F, back(i).flight.thrust_n);
        TEST_ASSERT_EQUAL_UINT32(newest().time_ms - 20U - 25U * (i - 1U), back(i).time_ms);
        TEST_ASSERT_FLOAT_WITHIN(0.002F, 4.0F - (float)i, back(i).up_mps2);
        TEST_ASSERT_FLOAT_WITHIN(0.0002F, 0.001F * (4.0F - (float)i), back(i).roll_rad);
        TEST_ASSERT_FLOAT_WITHIN(1.1e3F, 182.0e3F - 20.0e3F - 25.0e3F * (float)(i - 1U), back(i).age_us);
    }
}

void test_a_frame_that_releases_the_cycle_is_one_record_with_it(void)
{
    flight_recorder_set_rate(FLIGHT_RECORDER_FAST);
    fly(7.0F);
    take(25000U);
    for (int i = 0; i < 40; i++) {
        in.now_us += 25000U;
        frames_before(1U, 400U);
        take(0U);
        TEST_ASSERT_FLOAT_WITHIN(0.002F, 0.0F, newest().up_mps2);
    }
    TEST_ASSERT_EQUAL_UINT32(41, held());
    take(25000U);
    TEST_ASSERT_TRUE_MESSAGE(isnan(newest().up_mps2), "no frame is shown twice");
}

void test_fast_holds_over_twenty_seconds_of_every_frame_under_every_law(void)
{
    static const uint32_t cycles_us[] = {25000U, 100000U, 108000U};

    for (size_t i = 0; i < sizeof cycles_us / sizeof cycles_us[0]; i++) {
        published_t oldest;
        published_t record;
        uint32_t gap_ms = 0U;

        setUp();
        flight_recorder_set_rate(FLIGHT_RECORDER_FAST);
        fly(7.0F);
        for (uint32_t t = 0U; t < 100000000U; t += cycles_us[i]) {
            in.now_us += cycles_us[i];
            frames_before((uint16_t)(cycles_us[i] / 25000U), (i == 0U) ? 400U : 7000U);
            take(0U);
        }
        TEST_ASSERT_TRUE(flight_recorder_read(flight_recorder_span().oldest, &oldest));
        TEST_ASSERT_TRUE(newest().time_ms - oldest.time_ms >= 20000U);
        for (uint32_t n = flight_recorder_span().oldest + 1U; flight_recorder_read(n, &record); n++) {
            gap_ms = record.time_ms - oldest.time_ms > gap_ms ? record.time_ms - oldest.time_ms : gap_ms;
            oldest = record;
        }
        TEST_ASSERT_UINT32_WITHIN(8, 26, gap_ms);
    }
}

void test_sixty_seconds_are_held_at_every_rate_of_the_control_cycle(void)
{
    static const uint32_t cycles_us[] = {25000U, 50000U, 100000U, 108000U};

    for (size_t i = 0; i < sizeof cycles_us / sizeof cycles_us[0]; i++) {
        const flight_recorder_span_t *span;
        flight_recorder_span_t now;
        published_t oldest;

        setUp();
        fly(7.0F);
        for (uint32_t t = 0U; t < 300000000U; t += cycles_us[i]) {
            take(cycles_us[i]);
        }
        now = flight_recorder_span();
        span = &now;
        TEST_ASSERT_EQUAL_UINT32(FLIGHT_RECORDER_RECORDS, span->next - span->oldest);
        TEST_ASSERT_TRUE(flight_recorder_read(span->oldest, &oldest));
        TEST_ASSERT_TRUE(newest().time_ms - oldest.time_ms >= 60000U);
    }
}

void test_time_goes_on_over_the_wrap_of_the_microseconds(void)
{
    uint32_t first_ms;

    fly(7.0F);
    take(CYCLE_US);
    first_ms = newest().time_ms;
    for (int i = 0; i < 100; i++) {
        take(60000000U);
    }
    TEST_ASSERT_EQUAL_UINT32(6000000U, newest().time_ms - first_ms);
}

void test_no_millisecond_is_lost_to_rounding(void)
{
    uint32_t first_ms;

    fly(7.0F);
    take(CYCLE_US);
    first_ms = newest().time_ms;
    for (int i = 0; i < 1000; i++) {
        take(100777U);
    }
    TEST_ASSERT_UINT32_WITHIN(1, 100777U, newest().time_ms - first_ms);
}

/* What a scan showed stands in the first record that knows of it, and in no other: a scan that comes again
 * and again would look like a scanner that lives. */
void test_each_scan_is_recorded_once(void)
{
    fly(7.0F);
    out.signal = (scan_signal_t){.scans = 100U};
    for (int i = 0; i < 8; i++) {
        if (i % 2 == 0) {
            out.signal.scans++;
            out.signal.arrival_us = in.now_us + 48000U;
            out.signal.beams[MIRROR_FRONT] = (beam_signal_t){true, i != 4, 30U, 612.0F, 9.0F, 70000U};
        }
        take(50000U);
        const flight_beam_t front = newest().beams.beam[FLIGHT_BEAM_F];

        TEST_ASSERT_EQUAL(i % 2 == 0, !isnan(front.rays));
        TEST_ASSERT_EQUAL(i % 2 == 0 && i != 4, !isnan(front.slant_mm));
        TEST_ASSERT_TRUE(isnan(newest().beams.beam[FLIGHT_BEAM_1].rays));
        if (i == 0) {
            TEST_ASSERT_FLOAT_WITHIN(2000.0F, 72000.0F, front.age_us);
        }
    }
}

void test_overwritten_and_future_records_are_not_read(void)
{
    flight_recorder_span_t span;
    published_t record;

    fly(7.0F);
    for (uint32_t i = 0U; i < FLIGHT_RECORDER_RECORDS + 10U; i++) {
        take(CYCLE_US);
    }
    span = flight_recorder_span();
    TEST_ASSERT_TRUE(flight_recorder_read(span.oldest, &record));
    TEST_ASSERT_TRUE(flight_recorder_read(span.next - 1U, &record));
    TEST_ASSERT_FALSE(flight_recorder_read(span.oldest - 1U, &record));
    TEST_ASSERT_FALSE(flight_recorder_read(span.next, &record));
    flight_recorder_clear();
    TEST_ASSERT_FALSE(flight_recorder_read(span.next - 1U, &record));
    TEST_ASSERT_EQUAL_UINT32(0, held());
}

void test_the_latest_seconds_are_found(void)
{
    flight_recorder_span_t span;

    TEST_ASSERT_EQUAL_UINT32(flight_recorder_span().next, flight_recorder_since(10U));
    fly(7.0F);
    for (int i = 0; i < 300; i++) {
        take(100000U);
    }
    span = flight_recorder_span();
    TEST_ASSERT_EQUAL_UINT32(101U, span.next - flight_recorder_since(10U));
    TEST_ASSERT_EQUAL_UINT32(span.oldest, flight_recorder_since(3600U));
    TEST_ASSERT_EQUAL_UINT32(11U, span.next - flight_recorder_since(1U));
}

void test_only_the_reader_turns_interrupts_off(void)
{
    const uint16_t before = kernel.hwi.disabled;

    fly(7.0F);
    take(CYCLE_US);
    TEST_ASSERT_EQUAL_UINT16(before, kernel.hwi.disabled);
    (void)newest();
    TEST_ASSERT_TRUE(kernel.hwi.disabled > before);
}

void test_slow_cycles_are_45_ms_apart_or_more(void)
{
    fly(7.0F);
    take(CYCLE_US);
    const uint32_t before = held();
    take(44000U);
    TEST_ASSERT_EQUAL_UINT32(before, held());
    take(1000U);
    TEST_ASSERT_EQUAL_UINT32(before + 1U, held());
}

void test_after_a_full_ring_a_clear_leaves_what_comes_after_it(void)
{
    fly(7.0F);
    for (uint32_t i = 0U; i < FLIGHT_RECORDER_RECORDS + 5U; i++) {
        take(CYCLE_US);
    }
    TEST_ASSERT_EQUAL_UINT32(FLIGHT_RECORDER_RECORDS, held());
    flight_recorder_clear();
    TEST_ASSERT_EQUAL_UINT32(0U, held());
    take(CYCLE_US);
    take(CYCLE_US);
    TEST_ASSERT_EQUAL_UINT32(2U, held());
}
