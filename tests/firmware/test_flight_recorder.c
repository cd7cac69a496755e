#include "firmware/flight_recorder.h"

#include <math.h>
#include <string.h>

#include "kernel.h"
#include "unity.h"

#define CYCLE_US 108000U

static flight_inputs_t in;
static flight_outputs_t out;

void setUp(void)
{
    kernel_reset();
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

static flight_log_t newest(void)
{
    flight_log_t record;

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
    flight_log_t record;

    fly(7.01F);
    in.altitude.height_mm = 601.0F;
    in.roll_rad = 0.05F;
    in.pitch_rad = -0.02F;
    out.reference_m = 0.6F;
    out.flags = 3U;
    out.estimate_mm = 598.0F;
    out.innovation_mm = -4.0F;
    take(CYCLE_US);
    record = newest();
    TEST_ASSERT_EQUAL_FLOAT(598.0F, record.estimate_mm);
    TEST_ASSERT_EQUAL_FLOAT(-4.0F, record.innovation_mm);
    TEST_ASSERT_EQUAL_FLOAT(601.0F, record.height_mm);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, record.reference_m);
    TEST_ASSERT_EQUAL_FLOAT(7.01F, record.thrust_n);
    TEST_ASSERT_FLOAT_WITHIN(0.0001F, 0.05F, record.roll_rad);
    TEST_ASSERT_FLOAT_WITHIN(0.0001F, -0.02F, record.pitch_rad);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLYING, record.state);
    TEST_ASSERT_EQUAL_UINT16(3U, record.flags);
    in.height_valid = false;
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
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_GROUND, newest().state);
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

void test_sixty_seconds_are_held_at_every_rate_of_the_control_cycle(void)
{
    static const uint32_t cycles_us[] = {25000U, 50000U, 100000U, 108000U};

    for (size_t i = 0; i < sizeof cycles_us / sizeof cycles_us[0]; i++) {
        const flight_recorder_span_t *span;
        flight_recorder_span_t now;
        flight_log_t oldest;

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

void test_overwritten_and_future_records_are_not_read(void)
{
    flight_recorder_span_t span;
    flight_log_t record;

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
