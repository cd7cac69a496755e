/* A supervisor and its inputs: cycles, heights, lines and orders in words, and the way into each state. */
#ifndef TESTS_CONTROL_SUPERVISED_H
#define TESTS_CONTROL_SUPERVISED_H

#include "control/where/supervisor.h"
#include "unity.h"

#include <math.h>
#include <string.h>

static supervisor_t s;
static flight_inputs_t in;
static float link_s;
static vertical_estimate_t estimate;
static struct {
    flight_state_t from, to;
} change; /* the latest */

static inline void begin(void)
{
    supervisor_init(&s);
    estimate = (vertical_estimate_t){.known = false, .sways = true};
    change.from = change.to = FLIGHT_GROUND;
    in = (flight_inputs_t){.now_us = 0xFFF00000U, /* the clock wraps a second later */
                           .attitude_ready = true,
                           .has_throttle = true};
    link_s = 0.0F;
}

static inline void step(void)
{
    const flight_state_t from = s.state;

    estimate.upright = cosf(in.roll_rad) * cosf(in.pitch_rad);
    supervisor_step(&s, link_s, &in, &estimate);
    if (s.state != from) {
        change.from = from;
        change.to = s.state;
    }
}

static inline void cycle(uint32_t ms)
{
    in.now_us += ms * 1000U;
    in.attitude_time_us = in.now_us;
    step();
}

static inline void see(float height_mm)
{
    in.height_valid = true;
    in.altitude.height_mm = height_mm;
    in.height_time_us = in.now_us + 90000U; /* arrives 10 ms before the next cycle of 100 ms */
    in.height_sequence++;
}

/* Cycles of 100 ms, each with a new height. */
static inline void watch(float height_mm, int cycles)
{
    for (int i = 0; i < cycles; i++) {
        see(height_mm);
        cycle(100);
    }
}

static inline void blind(uint32_t ms)
{
    for (; ms >= 100U; ms -= 100U) {
        cycle(100);
    }
}

static inline void setr(float reference_m)
{
    in.reference_m = reference_m;
    in.reference_sequence++;
}

static inline void line(void)
{
    in.link_time_us = in.now_us;
    in.link_sequence++;
}

static inline void state_is(flight_state_t state)
{
    TEST_ASSERT_EQUAL_STRING(flight_state_name(state), flight_state_name(s.state));
}

static inline void take_off(void)
{
    watch(0.0F, 3);
    setr(0.5F);
    watch(0.0F, 1);
    state_is(FLIGHT_TAKEOFF);
}

static inline void fly(void)
{
    take_off();
    watch(500.0F, 10);
    state_is(FLIGHT_FLYING);
}

static inline void coast(void)
{
    fly();
    blind(300);
    state_is(FLIGHT_COASTING);
}

static inline void descend(void)
{
    coast();
    blind(1100);
    state_is(FLIGHT_COASTING);
    blind(100);
    state_is(FLIGHT_DESCENDING);
}

static inline void land(void)
{
    fly();
    setr(0.0F);
    watch(500.0F, 1);
    state_is(FLIGHT_LANDING);
}

static inline void lower(void)
{
    fly();
    watch(1310.0F, 2);
    state_is(FLIGHT_LOWERING);
}

static inline void floating(void)
{
    watch(400.0F, 11);
    state_is(FLIGHT_FLOATING);
}

static inline void flags_are(uint16_t flags)
{
    TEST_ASSERT_EQUAL_UINT16(flags, s.flags);
}

#endif
