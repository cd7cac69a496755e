/* The observations that supervisor_step() is made of, each at its limits. They are looked at from inside, so
 * this file includes the source. What the states make of them: test_supervisor.c, test_flight_state.c. */
#include "control/supervisor.c"
#include "unity.h"

#include <string.h>

static supervisor_t s;
static flight_inputs_t in;
static vertical_estimate_t estimate;

/* FLYING at 0.5 m towards 0.6 m, everything fresh; cycles of 0.1 s. */
void setUp(void)
{
    supervisor_init(&s);
    s.state = s.kept_state = FLIGHT_FLYING;
    s.started = true;
    s.now_us = s.height.time_us = s.attitude_time_us = 1000000U;
    s.step_us = 100000U;
    s.height.age_us = s.attitude_age_us = s.link_age_us = s.estimate_age_us = 0U;
    s.height.height_mm = 500.0F;
    s.height.sequence = 5U;
    s.height.is_new = true;
    s.link_sequence = 3U;
    s.reference_m = 0.6F;
    s.reference_sequence = 2U;
    s.level = true;
    in = (flight_inputs_t){.now_us = 1100000U,
                           .height_valid = true,
                           .altitude = {.valid = true, .height_mm = 520.0F},
                           .height_sequence = 6U,
                           .height_time_us = 1080000U,
                           .attitude_ready = true,
                           .attitude_time_us = 1090000U,
                           .link_sequence = 3U,
                           .reference_m = 0.6F,
                           .reference_sequence = 2U,
                           .has_throttle = true};
    s.sways = true;
    estimate = (vertical_estimate_t){
        .known = true, .height_mm = 500.0F, .upright = 1.0F, .sways = true, .hands_over = true};
}

void tearDown(void) {}

/* ---- times */

void test_ages_stop_at_an_hour(void)
{
    TEST_ASSERT_EQUAL_UINT32(150U, add_time(100U, 50U));
    TEST_ASSERT_EQUAL_UINT32(UINT32_C(3600000000), add_time(UINT32_C(3599999999), 1U));
    TEST_ASSERT_EQUAL_UINT32(UINT32_C(3600000000), add_time(UINT32_C(3600000000), UINT32_C(4000000000)));
    TEST_ASSERT_EQUAL_UINT32(UINT32_C(3599999999), add_time(UINT32_C(3599999998), 1U));
    TEST_ASSERT_EQUAL_UINT32(UINT32_C(3600000000), elapsed(UINT32_C(3600000005), 5U));
    TEST_ASSERT_EQUAL_UINT32(0U, elapsed(UINT32_C(3600000006), 5U)); /* later than now */
    TEST_ASSERT_EQUAL_UINT32(0U, elapsed(5U, 6U));
}

void test_a_hold_counts_from_its_second_cycle(void)
{
    hold_t hold = {false, 7U};
    update_hold(&hold, true, 100U);
    TEST_ASSERT_EQUAL_UINT32(0U, hold.for_us);
    update_hold(&hold, true, 100U);
    TEST_ASSERT_EQUAL_UINT32(100U, hold.for_us);
    update_hold(&hold, false, 100U);
    TEST_ASSERT_EQUAL_UINT32(0U, hold.for_us);
    TEST_ASSERT_FALSE(hold.on);
}

void test_the_first_cycle_has_no_duration(void)
{
    s.state_us = 200000U;
    observe_time(&s, &in);
    TEST_ASSERT_EQUAL_UINT32(100000U, s.step_us);
    TEST_ASSERT_EQUAL_UINT32(300000U, s.state_us);
    TEST_ASSERT_EQUAL_UINT32(1100000U, s.now_us);
    s.started = false;
    s.now_us = 0U;
    observe_time(&s, &in);
    TEST_ASSERT_EQUAL_UINT32(0U, s.step_us);
    TEST_ASSERT_TRUE(s.started);
}

/* ---- heights */

void test_a_rate_is_limited_and_changes_by_a_g(void)
{
    static const struct {
        uint32_t age_us, gap_us;
        float before_mm_s, height_mm, rate_mm_s;
    } rows[] = {{100000U, 100000U, 0.0F, 520.0F, 200.0F},       {1500000U, 100000U, 0.0F, 520.0F, 200.0F},
                {1500001U, 100000U, 50.0F, 520.0F, 0.0F},       {100000U, 0U, 50.0F, 520.0F, 0.0F},
                {100000U, 1U, 50.0F, 500.0F, 49.99F},           {100000U, 100000U, 0.0F, 650.0F, 1000.0F},
                {100000U, 100000U, 0.0F, 350.0F, -1000.0F},     {100000U, 100000U, 2500.0F, 900.0F, 3000.0F},
                {100000U, 100000U, -2500.0F, 100.0F, -3000.0F}, {100000U, 200000U, 500.0F, 520.0F, 100.0F}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const height_track_t before = {
            .height_mm = 500.0F, .rate_mm_s = rows[i].before_mm_s, .age_us = rows[i].age_us};
        TEST_ASSERT_FLOAT_WITHIN(0.01F, rows[i].rate_mm_s,
                                 rate_after(&before, rows[i].height_mm, rows[i].gap_us));
    }
}

void test_a_height_is_new_once_valid_and_within_reach(void)
{
    static const struct {
        float height_mm;
        bool valid;
        uint32_t sequence;
        bool is_new;
    } rows[] = {{520.0F, true, 6U, true},  {520.0F, false, 6U, false}, {520.0F, true, 5U, false},
                {-50.0F, true, 6U, true},  {-50.1F, true, 6U, false},  {5000.0F, true, 6U, true},
                {5000.1F, true, 6U, false}};
    for (int i = 0; i < 7; i++) {
        setUp();
        in.altitude.height_mm = rows[i].height_mm;
        in.height_valid = rows[i].valid;
        in.height_sequence = rows[i].sequence;
        observe_height(&s, &in);
        TEST_ASSERT_EQUAL(rows[i].is_new, s.height.is_new);
        TEST_ASSERT_EQUAL_UINT32(rows[i].is_new ? 20000U : 100000U, s.height.age_us);
        TEST_ASSERT_EQUAL_FLOAT(rows[i].is_new ? rows[i].height_mm : 500.0F, s.height.height_mm);
        TEST_ASSERT_EQUAL_UINT32(rows[i].is_new ? 1080000U : 1000000U, s.height.time_us);
        TEST_ASSERT_EQUAL_UINT32(rows[i].is_new ? 6U : 5U, s.height.sequence);
        TEST_ASSERT_EQUAL_UINT32(rows[i].is_new ? 80000U : 0U, s.height.gap_us);
    }
}

/* Whether a condition is met at these ages. */
static bool met(uint16_t condition)
{
    return (conditions(&s, &in) & condition) != 0U;
}

void test_a_height_is_fresh_for_300_ms_and_lost_after_1500(void)
{
    s.height.age_us = 300000U;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_HEIGHT));
    s.height.age_us = 300001U;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_HEIGHT));
    s.height.age_us = 1500000U;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_LOST));
    s.height.age_us = 1500001U;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_LOST));
}

void test_an_estimate_is_held_for_350_ms(void)
{
    s.estimate_age_us = 350000U;
    TEST_ASSERT_TRUE(supervisor_has_estimate(&s));
    s.estimate_age_us = 350001U;
    TEST_ASSERT_FALSE(supervisor_has_estimate(&s));
    observe_estimate(&s, &estimate);
    TEST_ASSERT_EQUAL_UINT32(0U, s.estimate_age_us);
    estimate.known = false;
    observe_estimate(&s, &estimate);
    TEST_ASSERT_EQUAL_UINT32(100000U, s.estimate_age_us);
    TEST_ASSERT_TRUE(isnan(s.estimated_peak_mm));
}

/* ---- attitude */

void test_an_attitude_is_fresh_for_250_ms_and_level_within_20_degrees(void)
{
    s.attitude_age_us = 250000U;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_LEVEL));
    s.attitude_age_us = 250001U;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_LEVEL));
    observe_attitude(&s, &in, 0.940F);
    TEST_ASSERT_TRUE(s.level);
    TEST_ASSERT_EQUAL_UINT32(10000U, s.attitude_age_us);
    observe_attitude(&s, &in, 0.9F); /* not new */
    TEST_ASSERT_TRUE(s.level);
    TEST_ASSERT_EQUAL_UINT32(110000U, s.attitude_age_us);
    in.attitude_time_us++;
    observe_attitude(&s, &in, 0.939F);
    TEST_ASSERT_FALSE(s.level);
    in.attitude_time_us++;
    in.attitude_ready = false;
    observe_attitude(&s, &in, 1.0F);
    TEST_ASSERT_FALSE(s.level);
}

void test_three_tilted_attitudes_are_counted_or_told_by_the_frames(void)
{
    const imu_sample_t frame = {.sequence = 1U};
    for (uint16_t i = 1U; i < 5U; i++) {
        in.attitude_time_us++;
        observe_attitude(&s, &in, 0.706F);
        TEST_ASSERT_EQUAL_UINT16((i < 3U) ? i : 3U, s.tilted_count);
        TEST_ASSERT_EQUAL(i >= 3U, met(FLIGHT_IF_TILTED));
        observe_attitude(&s, &in, 0.706F);
        TEST_ASSERT_EQUAL_UINT16((i < 3U) ? i : 3U, s.tilted_count);
    }
    in.attitude_time_us++;
    observe_attitude(&s, &in, 0.708F);
    TEST_ASSERT_EQUAL_UINT16(0U, s.tilted_count);
    in.frames = &frame;
    in.tilted_frames = 2U;
    observe_attitude(&s, &in, 1.0F);
    TEST_ASSERT_EQUAL_UINT16(2U, s.tilted_count);
    in.tilted_frames = 900U;
    observe_attitude(&s, &in, 1.0F);
    TEST_ASSERT_EQUAL_UINT16(3U, s.tilted_count);
}

/* ---- link and reference */

void test_a_silent_link_is_flagged_at_its_limit_and_obeyed_five_seconds_later(void)
{
    s.link_age_us = 2000000U;
    TEST_ASSERT_FALSE(link_silent(&s, 2.0F, 0U));
    s.link_age_us = 2000001U;
    TEST_ASSERT_TRUE(link_silent(&s, 2.0F, 0U));
    TEST_ASSERT_FALSE(link_silent(&s, 0.0F, 0U));
    TEST_ASSERT_TRUE(link_silent(&s, 0.0005F, 0U));
    s.link_sequence = 0U;
    TEST_ASSERT_FALSE(link_silent(&s, 2.0F, 0U));
    s.link_sequence = 3U;
    s.link_age_us = 7000000U;
    observe_reference(&s, 2.0F, &in);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, s.reference_m);
    s.link_age_us = 7000001U;
    observe_reference(&s, 2.0F, &in);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
}

void test_a_new_line_of_the_link_has_its_arrivals_age(void)
{
    s.link_age_us = 500000U;
    observe_link(&s, &in);
    TEST_ASSERT_EQUAL_UINT32(600000U, s.link_age_us);
    in.link_sequence = 4U;
    in.link_time_us = 1070000U;
    observe_link(&s, &in);
    TEST_ASSERT_EQUAL_UINT32(30000U, s.link_age_us);
    TEST_ASSERT_EQUAL_UINT32(4U, s.link_sequence);
}

void test_a_new_reference_is_within_its_range_and_counts_as_a_line(void)
{
    static const struct {
        float reference_m;
        bool accepted, land;
    } rows[] = {{0.9F, true, false},
                {3.0F, true, false},
                {3.01F, false, false},
                {0.0F, true, true},
                {-0.01F, false, false}};
    for (int i = 0; i < 5; i++) {
        setUp();
        in.reference_sequence = 3U;
        in.reference_m = rows[i].reference_m;
        s.link_age_us = 5U;
        s.lowerings = 2U;
        observe_reference(&s, 0.0F, &in);
        TEST_ASSERT_EQUAL_FLOAT(rows[i].accepted ? rows[i].reference_m : 0.6F, s.reference_m);
        TEST_ASSERT_EQUAL_UINT16(rows[i].accepted ? 0U : 2U, s.lowerings);
        TEST_ASSERT_EQUAL(rows[i].land, s.land);
        TEST_ASSERT_EQUAL_UINT32(0U, s.link_age_us);
        TEST_ASSERT_EQUAL_UINT32(3U, s.reference_sequence);
    }
    s.land = true;
    s.state = FLIGHT_GROUND;
    observe_reference(&s, 0.0F, &in);
    TEST_ASSERT_FALSE(s.land); /* it is done */
    s.land = true;
    s.state = FLIGHT_LANDING; /* which a pilot's turn may interrupt */
    observe_reference(&s, 0.0F, &in);
    s.state = FLIGHT_FLOATING;
    observe_reference(&s, 0.0F, &in);
    TEST_ASSERT_TRUE(s.land);
}

/* ---- how high */

/* 100 mm below the reference. A climb at 1 m/s ends 125 mm higher when it is braked by 4 m/s2. */
void test_a_climb_ends_where_braking_ends_it(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.01F, -100.0F + 400.0F + 125.0F, peak_mm(&s, 500.0F, 1000.0F, 0.4F));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, -100.0F, peak_mm(&s, 500.0F, -1000.0F, 0.4F));
    s.height.rate_mm_s = 1000.0F;
    TEST_ASSERT_FLOAT_WITHIN(0.01F, -100.0F + 150.0F + 125.0F, measured_peak_mm(&s));
    s.estimate_age_us = 400000U;
    TEST_ASSERT_FLOAT_WITHIN(0.01F, -100.0F + 400.0F + 125.0F, measured_peak_mm(&s));
    estimate.climb_mm_s = 1000.0F;
    observe_estimate(&s, &estimate);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, -100.0F + 250.0F + 125.0F, s.estimated_peak_mm);
}

void test_too_high_are_two_heights_or_an_estimate_beyond_800_mm(void)
{
    s.height.height_mm = 1400.5F;
    for (uint16_t i = 1U; i < 4U; i++) {
        observe_climb(&s);
        TEST_ASSERT_EQUAL_UINT16((i < 2U) ? i : 2U, s.too_high_count);
        TEST_ASSERT_EQUAL(i >= 2U, met(FLIGHT_IF_TOO_HIGH));
    }
    s.height.is_new = false;
    s.height.height_mm = 1399.5F;
    observe_climb(&s);
    TEST_ASSERT_EQUAL_UINT16(2U, s.too_high_count);
    s.height.is_new = true;
    observe_climb(&s);
    TEST_ASSERT_EQUAL_UINT16(0U, s.too_high_count);
    s.estimated_peak_mm = 800.0F;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_TOO_HIGH));
    s.estimated_peak_mm = 801.0F;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_TOO_HIGH));
    s.reference_m = 0.0005F;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_TOO_HIGH | FLIGHT_IF_REFERENCE));
    s.reference_m = 0.0F;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_TOO_HIGH));
    s.reference_m = 0.6F;
    s.height.age_us = 400000U;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_TOO_HIGH));
}

void test_recovered_is_below_300_mm_by_heights_and_estimate(void)
{
    static const struct {
        float height_mm, estimated_mm;
        bool recovered;
    } rows[] = {{899.0F, NAN, true}, {901.0F, NAN, false}, {899.0F, 299.0F, true}, {899.0F, 300.0F, false}};
    for (int i = 0; i < 4; i++) {
        setUp();
        s.height.height_mm = rows[i].height_mm;
        s.estimated_peak_mm = rows[i].estimated_mm;
        TEST_ASSERT_EQUAL(rows[i].recovered, met(FLIGHT_IF_RECOVERED));
        s.height.age_us = 400000U;
        TEST_ASSERT_FALSE(met(FLIGHT_IF_RECOVERED));
    }
}

/* ---- the ground */

void test_off_the_ground_is_above_150_mm_and_aloft_for_a_second_above_the_ground_found(void)
{
    s.height.height_mm = 150.0F;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_OFF_GROUND));
    s.height.height_mm = 150.1F;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_OFF_GROUND));
    observe_ground(&s);
    TEST_ASSERT_TRUE(s.aloft.on);
    s.aloft.for_us = 999999U;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_ALOFT));
    s.aloft.for_us = 1000000U;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_ALOFT));
    s.sways = false;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_ALOFT));
    s.level = false;
    observe_ground(&s);
    TEST_ASSERT_FALSE(s.aloft.on);
    s.level = true;
    s.ground_mm = 100.0F;
    s.height.is_new = false;
    s.height.height_mm = 250.0F;
    observe_ground(&s);
    TEST_ASSERT_FALSE(s.aloft.on);
    s.height.height_mm = 251.0F;
    observe_ground(&s);
    TEST_ASSERT_TRUE(s.aloft.on);
    s.height.age_us = 400000U;
    observe_ground(&s);
    TEST_ASSERT_FALSE(s.aloft.on);
}

void test_the_ground_found_by_stillness_follows_lower_heights(void)
{
    s.ground_sought = true;
    s.height.height_mm = 300.0F;
    follow_ground(&s);
    TEST_ASSERT_EQUAL_FLOAT(300.0F, s.ground_mm);
    TEST_ASSERT_FALSE(s.ground_sought);
    s.height.height_mm = 400.0F;
    follow_ground(&s);
    TEST_ASSERT_EQUAL_FLOAT(300.0F, s.ground_mm);
    s.height.height_mm = 200.0F;
    s.height.is_new = false;
    follow_ground(&s);
    TEST_ASSERT_EQUAL_FLOAT(300.0F, s.ground_mm);
    s.height.is_new = true;
    follow_ground(&s);
    TEST_ASSERT_EQUAL_FLOAT(200.0F, s.ground_mm);
    s.height.height_mm = -20.0F;
    follow_ground(&s);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.ground_mm);
}

void test_at_rest_is_below_50_mm_without_a_fall_of_20_for_1_2_seconds(void)
{
    static const struct {
        float from_mm, height_mm;
        bool rests;
    } rows[] = {{40.0F, 49.9F, true}, {40.0F, 50.0F, false}, {40.0F, 20.0F, true}, {40.0F, 19.9F, false}};
    for (int i = 0; i < 4; i++) {
        setUp();
        s.rest_from_mm = rows[i].from_mm;
        s.height.height_mm = rows[i].height_mm;
        observe_ground(&s);
        TEST_ASSERT_EQUAL(rows[i].rests, s.rest.on);
        TEST_ASSERT_EQUAL_FLOAT(rows[i].rests ? rows[i].from_mm : rows[i].height_mm, s.rest_from_mm);
    }
    s.rest.for_us = 1199999U;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_AT_REST));
    s.rest.for_us = 1200000U;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_AT_REST));
    s.rocks = true;
    s.state_us = 19999999U;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_AT_REST));
    s.state_us = 20000000U;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_AT_REST));
    s.rest.for_us = 0U;
    s.stands = true;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_AT_REST));
}

void test_what_the_estimate_says_of_standing_counts_in_descents(void)
{
    for (int state = 0; state < (int)FLIGHT_STATE_COUNT; state++) {
        setUp();
        s.state = (flight_state_t)state;
        estimate.stands = estimate.rocks = true;
        observe_estimate(&s, &estimate);
        TEST_ASSERT_EQUAL(state == FLIGHT_LANDING || state == FLIGHT_DESCENDING, s.stands);
        TEST_ASSERT_EQUAL(state == FLIGHT_LANDING || state == FLIGHT_DESCENDING, s.rocks);
    }
}

void test_a_flight_is_handed_over_by_a_pilot_without_heights(void)
{
    for (int i = 0; i < 6; i++) {
        setUp();
        s.pilots = i != 1;
        estimate.hands_over = i != 5;
        in.has_throttle = i != 2;
        estimate.sways = i != 3;
        s.height.age_us = (i == 4) ? 1500000U : 1500001U;
        observe_hand_over(&s, &in, &estimate);
        TEST_ASSERT_EQUAL(i == 0, met(FLIGHT_IF_HANDED_OVER));
        TEST_ASSERT_EQUAL(i == 2, s.pilots);
    }
}

/* ---- states */

void test_a_descent_and_the_lowerings_have_their_limits(void)
{
    s.state = FLIGHT_DESCENDING;
    s.state_us = 44999999U;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_DESCENT_TIMEOUT));
    s.state_us = 45000000U;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_DESCENT_TIMEOUT));
    s.state = FLIGHT_LANDING;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_DESCENT_TIMEOUT));
    s.lowerings = 3U;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_LOWERING_LIMIT));
    s.state = FLIGHT_LOWERING;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_LOWERING_LIMIT));
    s.lowerings = 2U;
    TEST_ASSERT_FALSE(met(FLIGHT_IF_LOWERING_LIMIT));
}

void test_twenty_seconds_of_flight_forget_the_lowerings(void)
{
    s.lowerings = 2U;
    s.state_us = 19999999U;
    enter(&s, FLIGHT_LOWERING);
    TEST_ASSERT_EQUAL_UINT16(3U, s.lowerings);
    setUp();
    s.lowerings = 2U;
    s.state_us = 20000000U;
    enter(&s, FLIGHT_LOWERING);
    TEST_ASSERT_EQUAL_UINT16(1U, s.lowerings);
    setUp();
    s.lowerings = 2U;
    s.state = FLIGHT_LANDING;
    s.state_us = 20000000U;
    enter(&s, FLIGHT_FLYING);
    TEST_ASSERT_EQUAL_UINT16(2U, s.lowerings);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, s.reference_m);
}

void test_a_state_that_ends_a_flight_takes_the_reference_away(void)
{
    for (int state = 0; state < (int)FLIGHT_STATE_COUNT; state++) {
        setUp();
        s.lowerings = 1U;
        s.rest.on = true;
        s.state_us = 5U;
        enter(&s, (flight_state_t)state);
        const bool ends = state == FLIGHT_GROUND || state == FLIGHT_DESCENDING || state == FLIGHT_CUT;
        TEST_ASSERT_EQUAL_FLOAT(ends ? 0.0F : 0.6F, s.reference_m);
        TEST_ASSERT_EQUAL_UINT16(ends ? 0U : (state == FLIGHT_LOWERING) ? 2U : 1U, s.lowerings);
        TEST_ASSERT_EQUAL(state, s.state);
        TEST_ASSERT_EQUAL_UINT32(0U, s.state_us);
        TEST_ASSERT_FALSE(s.rest.on);
    }
    s.lowerings = 3U; /* given up */
    s.reference_m = 0.6F;
    s.state = FLIGHT_LOWERING;
    enter(&s, FLIGHT_LANDING);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
    s.lowerings = 2U;
    s.reference_m = 0.6F;
    s.state = FLIGHT_FLYING;
    enter(&s, FLIGHT_LOWERING);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, s.reference_m);
}

void test_a_ground_found_by_stillness_has_a_height(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        s.ground_mm = 33.0F;
        s.stands = i != 1;
        s.height.age_us = (i == 2) ? 400000U : 0U;
        enter(&s, (i == 3) ? FLIGHT_FLYING : FLIGHT_GROUND);
        TEST_ASSERT_EQUAL(i == 0 || i == 2, s.ground_sought);
        TEST_ASSERT_EQUAL_FLOAT((i == 0) ? 500.0F : 0.0F, s.ground_mm);
    }
}

void test_each_flag_has_its_reason(void)
{
    s.link_age_us = 2000001U;
    TEST_ASSERT_EQUAL_UINT16(0U, flags(&s, 0U, 0.0F, &in));
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_LINK, flags(&s, 0U, 2.0F, &in));
    s.attitude_age_us = 250001U;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_ATTITUDE, flags(&s, 0U, 0.0F, &in));
    s.attitude_age_us = 0U;
    in.attitude_ready = false;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_ATTITUDE, flags(&s, 0U, 0.0F, &in));
    in.attitude_ready = true;
    in.altitude.disagree = true;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_DISAGREE, flags(&s, 0U, 0.0F, &in));
    s.height.age_us = 300001U;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_HEIGHT, flags(&s, 0U, 0.0F, &in));
    s.height.age_us = 0U;
    in.altitude.disagree = false;
    in.has_throttle = false;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_PILOT, flags(&s, 0U, 0.0F, &in));
    in.has_throttle = true;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_TOO_HIGH, flags(&s, FLIGHT_IF_TOO_HIGH, 0.0F, &in));
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_TILT, flags(&s, FLIGHT_IF_TILTED, 0.0F, &in));
    s.state = FLIGHT_LOWERING;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_TOO_HIGH, flags(&s, 0U, 0.0F, &in));
    s.state = FLIGHT_CUT;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_TILT, flags(&s, 0U, 0.0F, &in));
}

/* The table is asked again only when state or conditions change. */
void test_a_cycle_that_makes_no_transition_is_remembered(void)
{
    s.kept_state = FLIGHT_STATE_COUNT;
    supervisor_step(&s, 0.0F, &in, &estimate);
    TEST_ASSERT_EQUAL(FLIGHT_FLYING, s.state);
    TEST_ASSERT_EQUAL(FLIGHT_FLYING, s.kept_state);
    TEST_ASSERT_EQUAL_UINT16(conditions(&s, &in), s.kept_conditions);
    in.reference_sequence++;
    in.reference_m = 0.0F;
    supervisor_step(&s, 0.0F, &in, &estimate);
    TEST_ASSERT_EQUAL(FLIGHT_LANDING, s.state);
    TEST_ASSERT_EQUAL(FLIGHT_STATE_COUNT, s.kept_state);
}

void test_an_armed_flight_that_somebody_carries_is_handed_over(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        s.height.age_us = (i == 1) ? 1500000U : 1500001U;
        estimate.hands_over = i != 2;
        in.has_throttle = i != 3;
        estimate.carried = true;
        observe_hand_over(&s, &in, &estimate);
        TEST_ASSERT_EQUAL(i == 0, s.handed_over);
        TEST_ASSERT_TRUE(s.carried);
    }
    estimate.carried = false;
    observe_hand_over(&s, &in, &estimate);
    TEST_ASSERT_FALSE(s.carried);
    s.state = FLIGHT_DESCENDING;
    s.state_us = 45000000U;
    TEST_ASSERT_TRUE(met(FLIGHT_IF_DESCENT_TIMEOUT));
    s.carried = true; /* a pilot may fly */
    TEST_ASSERT_FALSE(met(FLIGHT_IF_DESCENT_TIMEOUT));
}
