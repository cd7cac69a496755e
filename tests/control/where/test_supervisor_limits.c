/* Each limit of the supervisor from both sides, by its inputs. What the states make of them:
 * test_supervisor.c, test_flight_state.c. */
#include "where/supervised.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

static void cycle_us(uint32_t us)
{
    in.now_us += us;
    in.attitude_time_us = in.now_us;
    step();
}

/* A new height, of just now. */
static void see_in_us(float height_mm, uint32_t us)
{
    see(height_mm);
    in.height_time_us = in.now_us + us;
    cycle_us(us);
}

/* ---- ages */

void test_a_height_is_fresh_for_300_ms_and_lost_after_1500(void)
{
    fly();
    see_in_us(500.0F, 100000U);
    cycle_us(300000U);
    state_is(FLIGHT_FLYING);
    flags_are(0U);
    cycle_us(1U);
    state_is(FLIGHT_COASTING);
    flags_are(FLIGHT_FLAG_HEIGHT);
    cycle_us(1199999U);
    state_is(FLIGHT_COASTING);
    cycle_us(1U);
    state_is(FLIGHT_DESCENDING);
}

void test_an_estimate_is_held_for_350_ms(void)
{
    fly();
    TEST_ASSERT_FALSE(supervisor_has_estimate(&s));
    estimate.known = true;
    cycle_us(100000U);
    TEST_ASSERT_TRUE(supervisor_has_estimate(&s));
    estimate.known = false;
    cycle_us(350000U);
    TEST_ASSERT_TRUE(supervisor_has_estimate(&s));
    cycle_us(1U);
    TEST_ASSERT_FALSE(supervisor_has_estimate(&s));
}

void test_an_attitude_is_fresh_for_250_ms(void)
{
    watch(0.0F, 1);
    flags_are(0U);
    in.now_us += 250000U;
    step();
    flags_are(0U);
    in.now_us += 1U;
    step();
    flags_are(FLIGHT_FLAG_ATTITUDE);
    cycle_us(1U);
    flags_are(0U);
    in.attitude_ready = false;
    cycle_us(1U);
    flags_are(FLIGHT_FLAG_ATTITUDE);
}

void test_attitudes_without_their_offset_are_not_looked_at(void)
{
    fly();
    in.attitude_ready = false;
    in.roll_rad = 1.0F;
    watch(500.0F, 10);
    state_is(FLIGHT_FLYING);
}

void test_a_silent_link_is_flagged_at_its_limit_and_obeyed_five_seconds_later(void)
{
    link_s = 2.0F;
    fly();
    line();
    for (uint32_t at_us = 100000U; at_us <= 7000000U; at_us += 100000U) {
        see_in_us(500.0F, 100000U);
        flags_are((at_us > 2000000U) ? FLIGHT_FLAG_LINK : 0U);
        if (at_us == 2000000U) {
            cycle_us(1U);
            flags_are(FLIGHT_FLAG_LINK);
            in.now_us--;
        }
    }
    state_is(FLIGHT_FLYING);
    cycle_us(2U);
    state_is(FLIGHT_LANDING);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
}

void test_a_line_has_the_age_of_its_arrival(void)
{
    link_s = 2.0F;
    fly();
    line();
    in.link_time_us -= 500000U;
    watch(500.0F, 15);
    flags_are(0U);
    watch(500.0F, 1);
    flags_are(FLIGHT_FLAG_LINK);
    in.link_sequence++;
    in.link_time_us = in.now_us + 200000U; /* later than now: it counts as now */
    watch(500.0F, 1);
    flags_are(0U);
}

/* ---- heights */

void test_heights_from_minus_50_to_5000_mm_count(void)
{
    static const struct {
        float height_mm;
        bool counts;
    } rows[] = {{-50.0F, true}, {-50.1F, false}, {5000.0F, true}, {5000.1F, false}};

    for (int i = 0; i < 4; i++) {
        begin();
        watch(10.0F, 2);
        watch(rows[i].height_mm, 1);
        TEST_ASSERT_EQUAL(rows[i].counts, s.height.is_new);
        TEST_ASSERT_EQUAL_FLOAT(rows[i].counts ? rows[i].height_mm : 10.0F, s.height.height_mm);
    }
    begin();
    see(10.0F);
    in.height_valid = false;
    cycle_us(100000U);
    TEST_ASSERT_FALSE(s.height.is_new);
}

void test_a_rate_needs_a_height_before_that_is_not_lost(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        begin();
        see_in_us(500.0F, 100000U);
        see_in_us(800.0F, 1500000U + more_us);
        TEST_ASSERT_FLOAT_WITHIN(0.01F, (more_us == 0U) ? 200.0F : 0.0F, s.height.rate_mm_s);
        TEST_ASSERT_EQUAL_UINT32(1500000U + more_us, s.height.gap_us);
    }
}

/* ---- how high */

/* With an estimate a step of the terrain looks like no climb: the heights look ahead by 0.15 s then. 500 mm
 * is the reference, braking from 1 m/s takes 125 mm. */
void test_beside_an_estimate_the_heights_look_not_ahead(void)
{
    fly();
    estimate = (vertical_estimate_t){.known = true, .height_mm = 500.0F};
    for (float height_mm = 600.0F; height_mm < 1250.0F; height_mm += 100.0F) {
        watch(height_mm, 1);
        state_is(FLIGHT_FLYING); /* 1200 is the first too high one: 700 + 126 */
    }
    flags_are(0U);
    watch(1300.0F, 1);
    state_is(FLIGHT_LOWERING);
}

void test_an_estimate_looks_ahead_by_220_ms(void)
{
    static const float below_mm = 500.0F + 800.0F - 220.0F - 126.26F; /* 1 m/s by 3.96 m/s2 */

    for (int above = 0; above < 2; above++) {
        begin();
        fly();
        estimate = (vertical_estimate_t){
            .known = true, .height_mm = below_mm + ((above != 0) ? 1.0F : -1.0F), .climb_mm_s = 1000.0F};
        watch(500.0F, 1);
        state_is((above != 0) ? FLIGHT_LOWERING : FLIGHT_FLYING);
    }
}

void test_nothing_is_too_high_without_a_reference_or_a_fresh_height(void)
{
    for (int why = 0; why < 3; why++) {
        begin();
        fly();
        estimate = (vertical_estimate_t){.known = true, .height_mm = 3000.0F};
        if (why == 1) {
            setr(0.0F);
        }
        if (why == 2) {
            in.now_us += 300000U;
        }
        cycle_us(100000U);
        TEST_ASSERT_EQUAL(why == 0, (s.flags & FLIGHT_FLAG_TOO_HIGH) != 0U);
    }
}

void test_the_highest_reference_is_three_metres(void)
{
    fly();
    setr(3.0F);
    watch(500.0F, 1);
    TEST_ASSERT_EQUAL_FLOAT(3.0F, s.reference_m);
    setr(3.01F);
    watch(500.0F, 1);
    TEST_ASSERT_EQUAL_FLOAT(3.0F, s.reference_m);
}

/* ---- the ground */

static void land_at_40_mm(void)
{
    begin();
    land();
    watch(40.0F, 2);
}

void test_at_rest_is_below_50_mm_without_a_fall_of_more_than_20(void)
{
    static const struct {
        float height_mm;
        bool rests;
    } rows[] = {{49.9F, true}, {50.0F, false}, {20.0F, true}, {19.9F, false}};

    for (int i = 0; i < 4; i++) {
        land_at_40_mm();
        watch(rows[i].height_mm, 1);
        watch(40.0F, 8);
        state_is(FLIGHT_LANDING);
        watch(40.0F, 2);
        state_is(rows[i].rests ? FLIGHT_GROUND : FLIGHT_LANDING);
    }
}

void test_it_rests_after_a_second(void)
{
    land_at_40_mm();
    for (int i = 0; i < 4; i++) {
        see_in_us(40.0F, 200000U);
    }
    see_in_us(40.0F, 199999U);
    state_is(FLIGHT_LANDING);
    see_in_us(40.0F, 1U);
    state_is(FLIGHT_GROUND);
}

void test_rest_counts_from_the_begin_of_the_landing(void)
{
    fly();
    watch(40.0F, 30);
    state_is(FLIGHT_FLYING);
    setr(0.0F);
    watch(40.0F, 11);
    state_is(FLIGHT_LANDING);
    watch(40.0F, 1);
    state_is(FLIGHT_GROUND);
}

void test_while_the_tilt_moves_a_landing_goes_on_for_15_and_a_half_seconds_at_most(void)
{
    begin();
    land();
    estimate.rocks = true;
    for (int i = 0; i < 155; i++) {
        state_is(FLIGHT_LANDING);
        see_in_us(20.0F, (i == 154) ? 99999U : 100000U);
    }
    state_is(FLIGHT_LANDING);
    see_in_us(20.0F, 1U);
    state_is(FLIGHT_GROUND);
}

void test_an_estimate_that_stands_ends_a_landing_and_a_descent_only(void)
{
    static void (*const ways[])(void) = {take_off, fly, coast, descend, land, lower};
    static const flight_state_t states[] = {FLIGHT_TAKEOFF,    FLIGHT_FLYING,  FLIGHT_COASTING,
                                            FLIGHT_DESCENDING, FLIGHT_LANDING, FLIGHT_LOWERING};

    for (int i = 0; i < 6; i++) {
        begin();
        ways[i]();
        state_is(states[i]);
        estimate.stands = true;
        cycle_us(1U);
        const bool ends = states[i] == FLIGHT_DESCENDING || states[i] == FLIGHT_LANDING;
        state_is(ends ? FLIGHT_GROUND : states[i]);
    }
}

void test_aloft_is_a_second_above_90_mm(void)
{
    see_in_us(90.1F, 100000U);
    for (int i = 0; i < 4; i++) {
        see_in_us(90.1F, 200000U);
    }
    see_in_us(90.1F, 199999U);
    state_is(FLIGHT_GROUND);
    see_in_us(90.1F, 1U);
    state_is(FLIGHT_FLOATING);
    begin();
    for (int i = 0; i < 20; i++) {
        see_in_us(90.0F, 200000U);
        state_is(FLIGHT_GROUND);
    }
}

/* Ground that was found by stillness: 90 mm count from there, but never from below 0. */
void test_a_ground_found_below_zero_is_zero(void)
{
    land();
    estimate.stands = true;
    watch(-20.0F, 2);
    state_is(FLIGHT_GROUND);
    watch(89.0F, 20);
    state_is(FLIGHT_GROUND);
    watch(91.0F, 12);
    state_is(FLIGHT_FLOATING);
}

void test_a_ground_found_by_heights_is_not_moved(void)
{
    land();
    watch(40.0F, 15);
    state_is(FLIGHT_GROUND);
    watch(151.0F, 12); /* not 190 */
    state_is(FLIGHT_FLOATING);
}

/* ---- hand-over and descents */

void test_a_flight_is_handed_over_when_its_height_is_lost(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        begin();
        watch(0.0F, 2);
        see_in_us(0.0F, 100000U);
        estimate.hands_over = estimate.in_hands = true;
        cycle_us(1500000U + more_us);
        state_is((more_us == 0U) ? FLIGHT_GROUND : FLIGHT_DESCENDING);
    }
}

void test_a_descent_ends_after_45_seconds(void)
{
    descend();
    cycle_us(44999999U);
    state_is(FLIGHT_DESCENDING);
    cycle_us(1U);
    state_is(FLIGHT_GROUND);
}
