#include "where/supervised.h"

#include <stdio.h>

#define SEED 77031U

void setUp(void)
{
    begin();
}

void tearDown(void) {}

static void pilot_takes_it(float height_mm);

/* The sensor's two-character distances end at 4095 mm; 205 mm of it lie above the gear. */
void test_the_take_over_above_the_highest_reference_is_still_in_range_of_the_sensor(void)
{
    TEST_ASSERT_TRUE(FLIGHT_REFERENCE_MAX_M + 0.8F < 4.095F - 0.205F);
}

/* ---- every transition once, through the inputs */

void test_ground_to_floating_when_a_pilot_has_been_aloft_for_a_second(void)
{
    watch(151.0F, 10);
    state_is(FLIGHT_GROUND);
    watch(151.0F, 1);
    state_is(FLIGHT_FLOATING);
}

/* ---- blocked mirrors at rest, or a stand that is smaller than they are */

/* It has stood for a second, its height is this, and its tilt is still. */
static void stand(void)
{
    begin();
    estimate.sways = false;
    estimate.calm = true;
    watch(0.0F, 10);
    blind(400);
}

static void is_withdrawn(void)
{
    state_is(FLIGHT_GROUND);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
}

/* The reference stays withdrawn when somebody frees the mirrors. */
void test_a_vehicle_that_stands_above_90_mm_does_not_take_off_and_the_mirrors_flag_says_so(void)
{
    stand();
    watch(91.0F, 3);
    flags_are(0U);
    watch(110.0F, 1); /* within 27 mm of the first */
    flags_are(FLIGHT_FLAG_MIRRORS);
    setr(0.5F);
    watch(91.0F, 1);
    is_withdrawn();
    watch(0.0F, 20);
    flags_are(0U);
    is_withdrawn();
    setr(0.5F);
    watch(0.0F, 1);
    state_is(FLIGHT_TAKEOFF);
}

/* A doubt of the sight that ends by the order, a scanner that is late. */
void test_a_reference_that_waits_for_a_height_is_withdrawn_when_the_height_shows_no_ground(void)
{
    stand();
    setr(0.5F);
    watch(300.0F, 3);
    state_is(FLIGHT_GROUND);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
    watch(300.0F, 1);
    is_withdrawn();
}

/* What was found holds over noise and lost scans, until a height shows the ground. */
void test_a_stand_that_was_found_is_found_in_each_scan(void)
{
    stand();
    watch(300.0F, 5);
    for (int i = 0; i < 200; i++) {
        if (i % 9 < 5) {
            see(i % 2 == 0 ? 280.0F : 320.0F);
        }
        setr(0.5F);
        cycle(100);
        is_withdrawn();
        TEST_ASSERT_TRUE((s.flags & FLIGHT_FLAG_MIRRORS) != 0U);
    }
}

/* It stands, but for one thing; then a reference comes. */
static flight_state_t set_above_the_ground(float height_mm, float moves_mm, bool calm, bool piloted)
{
    stand();
    estimate.calm = calm;
    in.has_throttle = !piloted;
    for (int i = 0; i < 8; i++) {
        watch(height_mm + moves_mm * (float)i, 1);
    }
    in.has_throttle = true;
    setr(0.5F);
    watch(height_mm + moves_mm * 8.0F, 1);
    return s.state;
}

void test_one_that_may_fly_already_takes_off_in_the_air(void)
{
    TEST_ASSERT_EQUAL(FLIGHT_GROUND, set_above_the_ground(300.0F, 0.0F, true, false));
    TEST_ASSERT_EQUAL(FLIGHT_TAKEOFF, set_above_the_ground(300.0F, 0.0F, false, false));
    TEST_ASSERT_EQUAL(FLIGHT_TAKEOFF, set_above_the_ground(300.0F, 0.0F, true, true));
    TEST_ASSERT_EQUAL(FLIGHT_TAKEOFF, set_above_the_ground(300.0F, 28.0F, true, false));
    TEST_ASSERT_EQUAL(FLIGHT_TAKEOFF, set_above_the_ground(90.0F, 0.0F, true, false));
}

void test_ground_to_takeoff_by_a_reference(void)
{
    take_off();
    TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
}

void test_takeoff_to_coasting_without_height(void)
{
    take_off();
    blind(200);
    state_is(FLIGHT_TAKEOFF);
    blind(100);
    state_is(FLIGHT_COASTING);
}

void test_takeoff_to_landing_by_setr_0(void)
{
    take_off();
    setr(0.0F);
    watch(20.0F, 1);
    state_is(FLIGHT_LANDING);
}

void test_takeoff_to_lowering_when_too_high(void)
{
    take_off();
    estimate = (vertical_estimate_t){.known = true, .height_mm = 1310.0F};
    watch(140.0F, 1);
    state_is(FLIGHT_LOWERING);
}

void test_takeoff_to_flying_above_90_mm(void)
{
    take_off();
    watch(90.0F, 1);
    state_is(FLIGHT_TAKEOFF);
    watch(90.5F, 1);
    state_is(FLIGHT_FLYING);
}

void test_flying_to_coasting_without_height(void)
{
    fly();
    blind(200);
    state_is(FLIGHT_FLYING); /* 10 ms + 200 ms */
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
    blind(100);
    state_is(FLIGHT_COASTING); /* 310 ms */
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_HEIGHT, s.flags);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
}

void test_flying_to_landing_by_setr_0(void)
{
    land();
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
}

void test_flying_to_lowering_when_too_high_twice(void)
{
    fly();
    watch(1290.0F, 30);
    state_is(FLIGHT_FLYING);
    watch(1301.0F, 1);
    watch(1299.0F, 2);
    watch(1301.0F, 1);
    state_is(FLIGHT_FLYING);
    watch(1301.0F, 1);
    state_is(FLIGHT_LOWERING);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_TOO_HIGH, s.flags);
}

/* Scans of 0.1 s from 2 m above the reference until it is lowered; at most 40. */
static int scans_until_lowered(float felt_mm_s)
{
    int scans = 0;

    fly();
    estimate.tells_falls = true;
    estimate.felt_mm_s = felt_mm_s;
    while (s.state == FLIGHT_FLYING && scans < 40) {
        watch(2500.0F, 1);
        scans++;
    }
    return scans;
}

/* Over an edge or a slope that falls. Half a metre was flown, or was not sunk by as a descent would. */
void test_no_height_is_too_high_by_which_the_ground_has_fallen(void)
{
    TEST_ASSERT_EQUAL_INT(40, scans_until_lowered(-310.0F));
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
    estimate.tells_falls = false;
    watch(2500.0F, 1);
    state_is(FLIGHT_LOWERING);
}

void test_a_height_that_was_flown_is_too_high_wherever_the_ground_is(void)
{
    TEST_ASSERT_INT_WITHIN(1, 5, scans_until_lowered(700.0F));
}

void test_a_law_that_does_not_return_over_fallen_ground_is_lowered(void)
{
    TEST_ASSERT_INT_WITHIN(1, 17, scans_until_lowered(0.0F));
}

void test_near_the_reference_what_was_flown_is_forgotten(void)
{
    fly();
    estimate.tells_falls = true;
    estimate.felt_mm_s = 700.0F;
    watch(2500.0F, 4);
    watch(500.0F, 3);
    watch(2500.0F, 4);
    state_is(FLIGHT_FLYING);
    watch(2500.0F, 2);
    state_is(FLIGHT_LOWERING);
}

void test_a_climb_counts_for_0_4_seconds_and_its_brake_and_a_descent_not_at_all(void)
{
    fly();
    watch(600.0F, 1);
    watch(700.0F, 1);
    watch(800.0F, 1);
    state_is(FLIGHT_FLYING); /* 1 m/s: 400 mm and 125 mm more, 1325 */
    watch(900.0F, 1);
    state_is(FLIGHT_LOWERING);
    watch(700.0F, 1);
    watch(1280.0F, 3);
    watch(1310.0F, 1);
    watch(1290.0F, 2);
    state_is(FLIGHT_FLYING);
}

void test_floating_to_flying_by_a_reference(void)
{
    floating();
    setr(0.6F);
    watch(400.0F, 1);
    state_is(FLIGHT_FLYING);
}

void test_floating_to_landing_by_setr_0(void)
{
    floating();
    setr(0.0F);
    watch(400.0F, 1);
    state_is(FLIGHT_LANDING);
}

void test_floating_to_descending_by_setr_0_without_height(void)
{
    floating();
    blind(1000);
    state_is(FLIGHT_FLOATING);
    setr(0.0F);
    blind(100);
    state_is(FLIGHT_DESCENDING);
}

void test_floating_to_descending_when_the_height_is_lost_and_no_pilot_flies(void)
{
    floating();
    blind(1400);
    state_is(FLIGHT_FLOATING);
    blind(200);
    state_is(FLIGHT_DESCENDING);
    setUp();
    floating();
    in.has_throttle = false;
    blind(20000);
    state_is(FLIGHT_FLOATING);
}

/* Not on the ground, where nothing sways, and not while a height tells. */
void test_ground_to_descending_by_a_flying_vehicle_handed_over_without_a_height(void)
{
    for (int sways = 0; sways < 2; sways++) {
        for (int sees = 0; sees < 2; sees++) {
            setUp();
            estimate.sways = sways;
            estimate.hands_over = true;
            in.has_throttle = false;
            blind(2000);
            if (sees) {
                watch(0.0F, 2);
            }
            state_is(FLIGHT_GROUND);
            in.has_throttle = true;
            blind(100);
            state_is(sways && !sees ? FLIGHT_DESCENDING : FLIGHT_GROUND);
        }
    }
}

void test_without_a_pin_an_armed_vehicle_that_is_carried_counts_as_handed_over(void)
{
    estimate.in_hands = true;
    blind(60000);
    state_is(FLIGHT_GROUND);
    estimate.hands_over = true;
    blind(100);
    state_is(FLIGHT_DESCENDING);
    estimate.hands_over = false; /* which counts on the ground only */
    blind(60000);
    state_is(FLIGHT_DESCENDING);
    estimate.in_hands = false;
    blind(100);
    state_is(FLIGHT_GROUND);
}

/* DESIGN: nothing moves without an order. */
void test_a_pilot_without_heights_gives_it_back_in_vain_when_nobody_has_armed_it(void)
{
    in.has_throttle = false;
    blind(2000);
    in.has_throttle = true;
    estimate.in_hands = true;
    blind(60000);
    state_is(FLIGHT_GROUND);
}

void test_heights_above_a_vehicle_that_does_not_move_are_not_a_flight(void)
{
    estimate.sways = false;
    watch(700.0F, 100);
    state_is(FLIGHT_GROUND);
    estimate.sways = true;
    watch(700.0F, 1);
    state_is(FLIGHT_FLOATING);
}

void test_heights_of_a_vehicle_that_is_tilted_or_has_lost_its_imu_are_not_a_flight(void)
{
    watch(0.0F, 5);
    in.roll_rad = 0.5F;
    watch(700.0F, 100);
    state_is(FLIGHT_GROUND);
    in.roll_rad = 0.0F;
    for (int i = 0; i < 100; i++) {
        see(700.0F);
        in.now_us += 100000U;
        in.attitude_time_us = (i % 5 == 0) ? in.now_us : in.attitude_time_us; /* a frame in half a second */
        step();
    }
    state_is(FLIGHT_GROUND);
    watch(700.0F, 12);
    state_is(FLIGHT_FLOATING);
}

void test_nothing_takes_off_whose_imu_has_fallen_silent_since_its_zero_is_known(void)
{
    watch(0.0F, 5);
    for (int i = 0; i < 10; i++) {
        see(0.0F);
        in.now_us += 100000U; /* and no attitude */
        if (i == 4) {
            setr(0.5F);
        }
        step();
        state_is(FLIGHT_GROUND);
    }
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_ATTITUDE, s.flags);
    watch(0.0F, 1);
    state_is(FLIGHT_TAKEOFF);
}

void test_a_vehicle_with_heights_is_not_handed_over_while_it_is_carried(void)
{
    estimate.in_hands = estimate.hands_over = true;
    watch(0.0F, 50);
    state_is(FLIGHT_GROUND);
}

void test_a_throttle_that_was_never_the_pilots_is_not_handed_over(void)
{
    estimate.hands_over = true;
    blind(5000);
    state_is(FLIGHT_GROUND);
}

void test_a_beam_past_an_edge_does_not_lift_a_vehicle_that_stands(void)
{
    land();
    estimate.stands = true;
    watch(700.0F, 1);
    state_is(FLIGHT_GROUND);
    watch(700.0F, 40);
    watch(780.0F, 40);
    state_is(FLIGHT_GROUND);
    watch(800.0F, 12); /* somebody flies it */
    state_is(FLIGHT_FLOATING);
}

void test_the_first_height_after_a_blind_descent_is_the_ground_and_so_is_any_lower_one(void)
{
    descend();
    estimate.stands = true;
    blind(100);
    state_is(FLIGHT_GROUND);
    watch(500.0F, 20);
    state_is(FLIGHT_GROUND);
    watch(10.0F, 3);
    watch(91.0F, 20);
    state_is(FLIGHT_GROUND);
    watch(110.0F, 12);
    state_is(FLIGHT_FLOATING);
}

void test_a_descent_and_a_landing_end_where_the_vehicle_stands_and_a_flight_does_not(void)
{
    descend();
    estimate.stands = true;
    blind(100);
    state_is(FLIGHT_GROUND);
    setUp();
    land();
    estimate.stands = true;
    watch(700.0F, 1);
    state_is(FLIGHT_GROUND);
    setUp();
    fly();
    estimate.stands = true;
    watch(500.0F, 30);
    state_is(FLIGHT_FLYING);
    pilot_takes_it(500.0F);
    watch(500.0F, 5);
    state_is(FLIGHT_FLOATING);
}

void test_floating_to_ground_at_rest(void)
{
    floating();
    watch(10.0F, 11); /* the first only starts the comparison */
    state_is(FLIGHT_FLOATING);
    watch(10.0F, 1);
    state_is(FLIGHT_GROUND);
}

void test_coasting_to_descending_by_setr_0(void)
{
    coast();
    setr(0.0F);
    blind(100);
    state_is(FLIGHT_DESCENDING);
}

void test_coasting_to_flying_when_the_height_is_back(void)
{
    coast();
    watch(480.0F, 1);
    state_is(FLIGHT_FLYING);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
}

void test_coasting_to_descending_when_the_height_is_lost(void)
{
    coast();
    blind(1100);
    state_is(FLIGHT_COASTING); /* 1410 ms */
    blind(100);
    state_is(FLIGHT_DESCENDING); /* 1510 ms */
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
}

void test_descending_to_flying_by_a_new_reference_once_the_height_is_back(void)
{
    descend();
    setr(0.4F);
    blind(100);
    state_is(FLIGHT_DESCENDING);
    TEST_ASSERT_EQUAL_FLOAT(0.4F, s.reference_m);
    watch(480.0F, 1);
    state_is(FLIGHT_FLYING);
}

void test_descending_to_landing_when_the_height_is_back(void)
{
    descend();
    watch(480.0F, 1);
    state_is(FLIGHT_LANDING);
    watch(480.0F, 20);
    state_is(FLIGHT_LANDING); /* latched */
}

void test_descending_to_ground_after_45_seconds(void)
{
    descend();
    blind(44900);
    state_is(FLIGHT_DESCENDING);
    blind(100);
    state_is(FLIGHT_GROUND);
}

void test_landing_to_flying_by_a_new_reference(void)
{
    land();
    setr(0.7F);
    watch(480.0F, 1);
    state_is(FLIGHT_FLYING);
    TEST_ASSERT_EQUAL_FLOAT(0.7F, s.reference_m);
}

void test_landing_to_descending_without_height(void)
{
    land();
    blind(200);
    state_is(FLIGHT_LANDING);
    blind(100);
    state_is(FLIGHT_DESCENDING);
}

void test_landing_to_ground_at_rest(void)
{
    land();
    watch(49.0F, 11);
    state_is(FLIGHT_LANDING);
    watch(49.0F, 1);
    state_is(FLIGHT_GROUND);
}

/* Heights of the ground, from a vehicle that still moves as in the air: the beam may be blocked. */
void test_heights_alone_are_no_ground_while_the_tilt_moves(void)
{
    land();
    estimate.rocks = true;
    watch(20.0F, 40);
    state_is(FLIGHT_LANDING);
    estimate.rocks = false;
    watch(20.0F, 1);
    state_is(FLIGHT_GROUND);
    setUp();
    land();
    estimate.rocks = true;
    watch(20.0F, 150);
    state_is(FLIGHT_LANDING);
    watch(20.0F, 7);
    state_is(FLIGHT_GROUND);
}

void test_lowering_to_coasting_without_height(void)
{
    lower();
    blind(300);
    state_is(FLIGHT_COASTING);
}

void test_lowering_to_landing_by_setr_0(void)
{
    lower();
    setr(0.0F);
    watch(1310.0F, 1);
    state_is(FLIGHT_LANDING);
}

void test_lowering_goes_on_while_the_vehicle_still_climbs(void)
{
    lower();
    watch(1510.0F, 1);
    watch(1810.0F, 1); /* at 2 m/s */
    watch(790.0F, 1);  /* the rate may fall by 1 m/s: 1 m/s is left, the climb ends at 1315 */
    state_is(FLIGHT_LOWERING);
    watch(790.0F, 1);
    state_is(FLIGHT_FLYING);
}

void test_lowering_to_flying_below_reference_and_300_mm(void)
{
    lower();
    watch(801.0F, 1);
    state_is(FLIGHT_LOWERING);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_TOO_HIGH, s.flags);
    watch(799.0F, 1);
    state_is(FLIGHT_FLYING);
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
}

static void lower_again(void)
{
    watch(700.0F, 3);
    state_is(FLIGHT_FLYING);
    watch(1310.0F, 2);
}

void test_the_third_lowering_lands_and_withdraws_the_reference(void)
{
    lower();
    lower_again();
    state_is(FLIGHT_LOWERING);
    lower_again();
    watch(1310.0F, 1);
    state_is(FLIGHT_LANDING);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
    watch(500.0F, 20);
    state_is(FLIGHT_LANDING);
}

void test_a_new_reference_forgets_the_lowerings(void)
{
    lower();
    lower_again();
    setr(0.5F);
    for (int times = 1; times <= 2; times++) {
        lower_again();
        watch(1310.0F, 5);
        state_is(FLIGHT_LOWERING);
    }
    lower_again();
    watch(1310.0F, 1);
    state_is(FLIGHT_LANDING);
}

void test_twenty_seconds_of_flight_forget_the_lowerings(void)
{
    lower();
    for (int times = 2; times <= 6; times++) {
        watch(700.0F, 203);
        state_is(FLIGHT_FLYING);
        watch(1310.0F, 5);
        state_is(FLIGHT_LOWERING);
    }
}

void test_nineteen_seconds_of_flight_do_not(void)
{
    lower();
    for (int times = 2; times <= 3; times++) {
        watch(700.0F, 190);
        watch(1310.0F, 3);
    }
    state_is(FLIGHT_LANDING);
}

/* ---- the pilot has the throttle */

static void pilot_takes_it(float height_mm)
{
    in.has_throttle = false;
    watch(height_mm, 1);
    state_is(FLIGHT_FLOATING);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_PILOT, s.flags & FLIGHT_FLAG_PILOT);
}

static void pilot_takes_it_blind(void)
{
    in.has_throttle = false;
    blind(100);
    state_is(FLIGHT_FLOATING);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_PILOT | FLIGHT_FLAG_HEIGHT, s.flags);
}

static void pilot_gives_it_back(float height_mm)
{
    in.has_throttle = true;
    watch(height_mm, 1);
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
}

void test_takeoff_to_floating_by_the_pilots_switch(void)
{
    take_off();
    pilot_takes_it(30.0F);
}

void test_flying_to_floating_and_back_by_the_pilots_switch_with_the_reference_of_before(void)
{
    fly();
    pilot_takes_it(500.0F);
    watch(900.0F, 100);
    state_is(FLIGHT_FLOATING);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_PILOT, s.flags);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
    pilot_gives_it_back(900.0F);
    state_is(FLIGHT_FLYING);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
}

void test_landing_to_floating_by_the_pilots_switch_and_it_lands_when_he_gives_it_back(void)
{
    land();
    pilot_takes_it(400.0F);
    watch(400.0F, 20);
    state_is(FLIGHT_FLOATING);
    pilot_gives_it_back(400.0F);
    watch(400.0F, 1);
    state_is(FLIGHT_LANDING);
}

void test_lowering_to_floating_by_the_pilots_switch(void)
{
    lower();
    pilot_takes_it(1310.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
}

void test_the_third_lowering_withdraws_the_reference_from_the_pilots_turn_too(void)
{
    lower();
    for (int times = 2; times <= 3; times++) {
        watch(700.0F, 3);
        state_is(FLIGHT_FLYING);
        watch(1310.0F, 2);
        state_is(FLIGHT_LOWERING);
    }
    pilot_takes_it(1310.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
}

void test_coasting_to_floating_by_the_pilots_switch(void)
{
    coast();
    pilot_takes_it_blind();
    TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
}

void test_descending_to_floating_by_the_pilots_switch_without_a_reference(void)
{
    descend();
    pilot_takes_it_blind();
    watch(480.0F, 5);
    pilot_gives_it_back(480.0F);
    state_is(FLIGHT_FLOATING);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
}

void test_the_pilots_switch_counts_more_than_a_tilt_and_a_lost_height(void)
{
    fly();
    blind(200);
    in.has_throttle = false;
    in.roll_rad = 1.0F;
    blind(3000);
    state_is(FLIGHT_FLOATING);
    in.has_throttle = true;
    watch(500.0F, 20);
    state_is(FLIGHT_FLOATING);
    in.roll_rad = 0.0F;
    watch(500.0F, 1);
    state_is(FLIGHT_FLYING);
}

void test_cut_to_floating_only_by_a_pilot_who_holds_it_aloft_and_upright(void)
{
    fly();
    in.roll_rad = 1.0F;
    watch(500.0F, 3);
    state_is(FLIGHT_CUT);
    in.has_throttle = false;
    watch(500.0F, 20);
    state_is(FLIGHT_CUT);
    in.roll_rad = 0.0F;
    watch(80.0F, 2);
    watch(500.0F, 10);
    state_is(FLIGHT_CUT);
    watch(500.0F, 1);
    state_is(FLIGHT_FLOATING);
    pilot_gives_it_back(500.0F);
    state_is(FLIGHT_FLOATING);
}

void test_a_reference_waits_on_the_ground_for_the_pilots_switch(void)
{
    in.has_throttle = false;
    watch(0.0F, 3);
    setr(0.5F);
    watch(0.0F, 100);
    state_is(FLIGHT_GROUND);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_PILOT, s.flags);
    pilot_gives_it_back(0.0F);
    state_is(FLIGHT_TAKEOFF);
}

void test_a_reference_or_setr_0_leaves_a_pilots_vehicle_floating(void)
{
    floating();
    in.has_throttle = false;
    setr(0.6F);
    watch(400.0F, 20);
    state_is(FLIGHT_FLOATING);
    TEST_ASSERT_EQUAL_FLOAT(0.6F, s.reference_m);
    setr(0.0F);
    watch(400.0F, 1);
    blind(3000);
    setr(0.0F);
    blind(100);
    state_is(FLIGHT_FLOATING);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
}

void test_an_order_to_land_in_the_pilots_turn_is_executed_when_he_gives_back(void)
{
    fly();
    pilot_takes_it(600.0F);
    setr(0.0F);
    watch(600.0F, 20);
    state_is(FLIGHT_FLOATING);
    pilot_gives_it_back(600.0F);
    state_is(FLIGHT_LANDING);
}

void test_a_pilot_who_lands_withdraws_the_reference(void)
{
    fly();
    pilot_takes_it(500.0F);
    watch(10.0F, 15);
    state_is(FLIGHT_GROUND);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
    pilot_gives_it_back(10.0F);
    watch(10.0F, 50);
    state_is(FLIGHT_GROUND);
}

void test_a_tilt_that_frames_have_shown_thrice_counts_in_a_slower_cycle_at_once(void)
{
    const imu_sample_t frame = {.ready = true};

    fly();
    in.frames = &frame;
    in.tilted_frames = 2U;
    watch(500.0F, 5);
    state_is(FLIGHT_FLYING);
    in.tilted_frames = 3U;
    watch(500.0F, 1);
    state_is(FLIGHT_CUT);
}

/* ---- tilt */

static void tilt(float degrees)
{
    in.roll_rad = degrees * 0.0174532925F;
}

static void tilt_cuts(void (*enter)(void), float height_mm)
{
    setUp();
    enter();
    const flight_state_t from = s.state;
    tilt(46.0F);
    watch(height_mm, 2);
    TEST_ASSERT_EQUAL_STRING(flight_state_name(from), flight_state_name(s.state));
    watch(height_mm, 1);
    state_is(FLIGHT_CUT);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_TILT, s.flags & ~FLIGHT_FLAG_TOO_HIGH);
}

void test_takeoff_to_cut_by_tilt(void)
{
    tilt_cuts(take_off, 30.0F);
}

void test_flying_to_cut_by_tilt(void)
{
    tilt_cuts(fly, 500.0F);
}

void test_landing_to_cut_by_tilt(void)
{
    tilt_cuts(land, 500.0F);
}

void test_lowering_to_cut_by_tilt(void)
{
    tilt_cuts(lower, 1310.0F);
}

void test_coasting_to_cut_by_tilt(void)
{
    coast();
    tilt(-50.0F);
    blind(200);
    state_is(FLIGHT_COASTING);
    blind(100);
    state_is(FLIGHT_CUT);
}

void test_descending_to_cut_by_tilt(void)
{
    descend();
    in.pitch_rad = 0.8F;
    blind(300);
    state_is(FLIGHT_CUT);
}

void test_cut_to_ground_level_and_at_rest(void)
{
    fly();
    tilt(60.0F);
    watch(500.0F, 3);
    watch(20.0F, 20);
    state_is(FLIGHT_CUT); /* lies on its side */
    tilt(19.0F);
    watch(20.0F, 10);
    state_is(FLIGHT_CUT);
    tilt(17.0F);
    watch(20.0F, 1);
    state_is(FLIGHT_GROUND);
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
    watch(20.0F, 30);
    state_is(FLIGHT_GROUND); /* the reference of before does not fly again */
}

void test_a_cut_is_latched_against_a_new_reference(void)
{
    fly();
    tilt(60.0F);
    watch(500.0F, 3);
    tilt(0.0F);
    setr(0.8F);
    watch(500.0F, 50);
    state_is(FLIGHT_CUT);
}

void test_a_reference_given_while_cut_does_not_start_the_motors_on_the_ground(void)
{
    fly();
    tilt(60.0F);
    watch(500.0F, 3);
    setr(0.8F);
    tilt(0.0F);
    watch(20.0F, 30);
    state_is(FLIGHT_GROUND);
    setr(0.8F);
    watch(20.0F, 1);
    state_is(FLIGHT_TAKEOFF);
}

void test_both_angles_make_the_tilt_and_44_degrees_do_not(void)
{
    fly();
    in.roll_rad = in.pitch_rad = 0.56F; /* cos cos = 0.718 */
    watch(500.0F, 30);
    state_is(FLIGHT_FLYING);
    in.roll_rad = in.pitch_rad = 0.58F; /* 0.700 */
    watch(500.0F, 3);
    state_is(FLIGHT_CUT);
}

void test_spikes_and_attitudes_that_stand_still_do_not_cut(void)
{
    fly();
    for (int i = 0; i < 30; i++) {
        tilt(i % 3 == 2 ? 0.0F : 70.0F);
        watch(500.0F, 1);
    }
    state_is(FLIGHT_FLYING);
    tilt(70.0F);
    for (int i = 0; i < 30; i++) { /* one frame, seen again and again */
        see(500.0F);
        in.now_us += 100000U;
        step();
    }
    state_is(FLIGHT_FLYING);
}

void test_an_attitude_that_is_no_number_does_not_cut(void)
{
    fly();
    in.roll_rad = NAN;
    watch(500.0F, 30);
    state_is(FLIGHT_FLYING);
}

void test_a_tilted_vehicle_does_not_take_off_and_a_pilots_is_not_cut(void)
{
    tilt(50.0F);
    watch(0.0F, 3);
    setr(0.5F);
    watch(0.0F, 30);
    state_is(FLIGHT_GROUND);
    setUp();
    floating();
    tilt(80.0F);
    watch(400.0F, 30);
    state_is(FLIGHT_FLOATING);
}

/* ---- every row of the table is taken by inputs */

static void aloft(void)
{
    watch(400.0F, 11);
}

static void withdraw_on_take_off(void)
{
    take_off();
    setr(0.0F);
    watch(0.0F, 1);
}

static void lose_height_on_take_off(void)
{
    take_off();
    blind(300);
}

static void rise_too_high_on_take_off(void)
{
    take_off();
    estimate = (vertical_estimate_t){.known = true, .height_mm = 1310.0F};
    watch(140.0F, 1);
}

static void leave_the_ground(void)
{
    take_off();
    watch(151.0F, 1);
}

static void tilt_on(void (*enter)(void), float height_mm)
{
    enter();
    tilt(60.0F);
    watch(height_mm, 3);
}

static void tilt_on_take_off(void)
{
    tilt_on(take_off, 30.0F);
}
static void tilt_in_flight(void)
{
    tilt_on(fly, 500.0F);
}
static void tilt_on_landing(void)
{
    tilt_on(land, 500.0F);
}
static void tilt_on_lowering(void)
{
    tilt_on(lower, 1310.0F);
}

static void tilt_blind(void (*enter)(void))
{
    enter();
    tilt(60.0F);
    blind(300);
}

static void tilt_on_coasting(void)
{
    tilt_blind(coast);
}
static void tilt_on_descending(void)
{
    tilt_blind(descend);
}

static void take_over_from_the_pilot(void)
{
    floating();
    setr(0.6F);
    watch(400.0F, 1);
}

static void land_for_the_pilot(void)
{
    floating();
    setr(0.0F);
    watch(400.0F, 1);
}

static void descend_for_the_pilot(void)
{
    floating();
    blind(1000);
    setr(0.0F);
    blind(100);
}

static void float_blind(void)
{
    floating();
    blind(1400);
    state_is(FLIGHT_FLOATING);
    blind(200);
}

static void stand_after_a_descent(void)
{
    descend();
    estimate.stands = true;
    blind(100);
}

static void be_handed_a_flying_vehicle(void)
{
    estimate.hands_over = true;
    in.has_throttle = false;
    blind(2000);
    estimate.sways = true;
    state_is(FLIGHT_GROUND);
    in.has_throttle = true;
    blind(100);
}

static void be_put_down_by_the_pilot(void)
{
    floating();
    watch(10.0F, 20);
}

/* At most 0.5 s old: not LOST. */
static void withdraw_on_coasting(void)
{
    coast();
    setr(0.0F);
    blind(100);
    TEST_ASSERT_LESS_THAN_UINT32(1000000, s.height.age_us);
}

static void see_again_on_coasting(void)
{
    coast();
    watch(480.0F, 1);
}

static void new_reference_on_descending(void)
{
    descend();
    setr(0.4F);
    watch(480.0F, 1);
}

static void see_again_on_descending(void)
{
    descend();
    watch(480.0F, 1);
}

static void descend_to_the_end(void)
{
    descend();
    blind(45000);
}

static void new_reference_on_landing(void)
{
    land();
    setr(0.7F);
    watch(480.0F, 1);
}

static void lose_height_on_landing(void)
{
    land();
    blind(300);
}

static void touch_down(void)
{
    land();
    watch(20.0F, 20);
}

static void lose_height_on_lowering(void)
{
    lower();
    blind(300);
}

static void withdraw_on_lowering(void)
{
    lower();
    setr(0.0F);
    watch(1310.0F, 1);
}

static void be_lowered(void)
{
    lower();
    watch(700.0F, 3);
}

static void be_lowered_thrice(void)
{
    lower();
    for (int times = 2; times <= 3; times++) {
        watch(700.0F, 3);
        watch(1310.0F, 3);
    }
}

static void lie_level_after_a_cut(void)
{
    tilt_in_flight();
    tilt(0.0F);
    watch(20.0F, 20);
}

static void hand_over(void (*enter)(void), float height_mm)
{
    enter();
    in.has_throttle = false;
    watch(height_mm, 1);
}

static void hand_over_on_take_off(void)
{
    hand_over(take_off, 30.0F);
}
static void hand_over_in_flight(void)
{
    hand_over(fly, 500.0F);
}
static void hand_over_on_landing(void)
{
    hand_over(land, 500.0F);
}
static void hand_over_on_lowering(void)
{
    hand_over(lower, 1310.0F);
}
static void hand_over_on_coasting(void)
{
    hand_over(coast, 480.0F);
}
static void hand_over_on_descending(void)
{
    hand_over(descend, 480.0F);
}

static void recover_from_a_cut(void)
{
    tilt_in_flight();
    tilt(0.0F);
    in.has_throttle = false;
    watch(500.0F, 20);
}

/* The row from one state to the other which has that condition, or its absence. */
static const struct {
    flight_state_t from;
    uint16_t condition;
    flight_state_t to;
    void (*way)(void);
} ways[] = {
    {FLIGHT_GROUND, FLIGHT_IF_ALOFT, FLIGHT_FLOATING, aloft},
    {FLIGHT_GROUND, FLIGHT_IF_HANDED_OVER, FLIGHT_DESCENDING, be_handed_a_flying_vehicle},
    {FLIGHT_GROUND, FLIGHT_IF_REFERENCE, FLIGHT_TAKEOFF, take_off},
    {FLIGHT_TAKEOFF, FLIGHT_IF_HAS_THROTTLE, FLIGHT_FLOATING, hand_over_on_take_off},
    {FLIGHT_TAKEOFF, FLIGHT_IF_TILTED, FLIGHT_CUT, tilt_on_take_off},
    {FLIGHT_TAKEOFF, FLIGHT_IF_HEIGHT, FLIGHT_COASTING, lose_height_on_take_off},
    {FLIGHT_TAKEOFF, FLIGHT_IF_REFERENCE, FLIGHT_LANDING, withdraw_on_take_off},
    {FLIGHT_TAKEOFF, FLIGHT_IF_TOO_HIGH, FLIGHT_LOWERING, rise_too_high_on_take_off},
    {FLIGHT_TAKEOFF, FLIGHT_IF_OFF_GROUND, FLIGHT_FLYING, leave_the_ground},
    {FLIGHT_FLYING, FLIGHT_IF_HAS_THROTTLE, FLIGHT_FLOATING, hand_over_in_flight},
    {FLIGHT_FLYING, FLIGHT_IF_TILTED, FLIGHT_CUT, tilt_in_flight},
    {FLIGHT_FLYING, FLIGHT_IF_HEIGHT, FLIGHT_COASTING, coast},
    {FLIGHT_FLYING, FLIGHT_IF_REFERENCE, FLIGHT_LANDING, land},
    {FLIGHT_FLYING, FLIGHT_IF_TOO_HIGH, FLIGHT_LOWERING, lower},
    {FLIGHT_FLOATING, FLIGHT_IF_REFERENCE, FLIGHT_FLYING, take_over_from_the_pilot},
    {FLIGHT_FLOATING, FLIGHT_IF_LAND, FLIGHT_LANDING, land_for_the_pilot},
    {FLIGHT_FLOATING, FLIGHT_IF_LAND, FLIGHT_DESCENDING, descend_for_the_pilot},
    {FLIGHT_FLOATING, FLIGHT_IF_LOST, FLIGHT_DESCENDING, float_blind},
    {FLIGHT_FLOATING, FLIGHT_IF_AT_REST, FLIGHT_GROUND, be_put_down_by_the_pilot},
    {FLIGHT_COASTING, FLIGHT_IF_HAS_THROTTLE, FLIGHT_FLOATING, hand_over_on_coasting},
    {FLIGHT_COASTING, FLIGHT_IF_TILTED, FLIGHT_CUT, tilt_on_coasting},
    {FLIGHT_COASTING, FLIGHT_IF_REFERENCE, FLIGHT_DESCENDING, withdraw_on_coasting},
    {FLIGHT_COASTING, FLIGHT_IF_HEIGHT, FLIGHT_FLYING, see_again_on_coasting},
    {FLIGHT_COASTING, FLIGHT_IF_LOST, FLIGHT_DESCENDING, descend},
    {FLIGHT_DESCENDING, FLIGHT_IF_HAS_THROTTLE, FLIGHT_FLOATING, hand_over_on_descending},
    {FLIGHT_DESCENDING, FLIGHT_IF_TILTED, FLIGHT_CUT, tilt_on_descending},
    {FLIGHT_DESCENDING, FLIGHT_IF_REFERENCE, FLIGHT_FLYING, new_reference_on_descending},
    {FLIGHT_DESCENDING, FLIGHT_IF_HEIGHT, FLIGHT_LANDING, see_again_on_descending},
    {FLIGHT_DESCENDING, FLIGHT_IF_AT_REST, FLIGHT_GROUND, stand_after_a_descent},
    {FLIGHT_DESCENDING, FLIGHT_IF_DESCENT_TIMEOUT, FLIGHT_GROUND, descend_to_the_end},
    {FLIGHT_LANDING, FLIGHT_IF_HAS_THROTTLE, FLIGHT_FLOATING, hand_over_on_landing},
    {FLIGHT_LANDING, FLIGHT_IF_TILTED, FLIGHT_CUT, tilt_on_landing},
    {FLIGHT_LANDING, FLIGHT_IF_REFERENCE, FLIGHT_FLYING, new_reference_on_landing},
    {FLIGHT_LANDING, FLIGHT_IF_HEIGHT, FLIGHT_DESCENDING, lose_height_on_landing},
    {FLIGHT_LANDING, FLIGHT_IF_AT_REST, FLIGHT_GROUND, touch_down},
    {FLIGHT_LOWERING, FLIGHT_IF_HAS_THROTTLE, FLIGHT_FLOATING, hand_over_on_lowering},
    {FLIGHT_LOWERING, FLIGHT_IF_TILTED, FLIGHT_CUT, tilt_on_lowering},
    {FLIGHT_LOWERING, FLIGHT_IF_HEIGHT, FLIGHT_COASTING, lose_height_on_lowering},
    {FLIGHT_LOWERING, FLIGHT_IF_REFERENCE, FLIGHT_LANDING, withdraw_on_lowering},
    {FLIGHT_LOWERING, FLIGHT_IF_LOWERING_LIMIT, FLIGHT_LANDING, be_lowered_thrice},
    {FLIGHT_LOWERING, FLIGHT_IF_RECOVERED, FLIGHT_FLYING, be_lowered},
    {FLIGHT_CUT, FLIGHT_IF_HAS_THROTTLE, FLIGHT_FLOATING, recover_from_a_cut},
    {FLIGHT_CUT, FLIGHT_IF_AT_REST, FLIGHT_GROUND, lie_level_after_a_cut},
};
#define WAY_COUNT (sizeof ways / sizeof ways[0])

static bool leads_through(size_t way, const flight_transition_t *row)
{
    return ways[way].from == row->from && ways[way].to == row->to &&
           ((row->all_of | row->none_of) & ways[way].condition) != 0U;
}

static int ways_through(const flight_transition_t *row, size_t *way)
{
    int found = 0;

    for (size_t i = 0; i < WAY_COUNT; i++) {
        if (leads_through(i, row)) {
            *way = i;
            found++;
        }
    }
    return found;
}

/* A row without a way, a way without a row, and a way that ends elsewhere all fail. */
void test_every_row_is_taken_by_inputs_alone(void)
{
    char text[160];
    size_t way = 0;

    for (unsigned k = 0; k < FLIGHT_TRANSITION_COUNT; k++) {
        const flight_transition_t *row = &flight_transitions[k];

        snprintf(text, sizeof text, "row %u: %s to %s", k, flight_state_name(row->from),
                 flight_state_name(row->to));
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, ways_through(row, &way), text);
        setUp();
        ways[way].way();
        TEST_ASSERT_EQUAL_STRING_MESSAGE(flight_state_name(row->from), flight_state_name(change.from), text);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(flight_state_name(row->to), flight_state_name(change.to), text);
    }
    TEST_ASSERT_EQUAL_INT(FLIGHT_TRANSITION_COUNT, WAY_COUNT);
}

/* ---- the estimate */

static void estimate_is(float height_mm, float climb_mm_s)
{
    estimate = (vertical_estimate_t){.known = true, .height_mm = height_mm, .climb_mm_s = climb_mm_s};
}

void test_one_estimate_is_enough_to_lower(void)
{
    fly();
    estimate_is(1299.0F, 0.0F);
    watch(500.0F, 3);
    state_is(FLIGHT_FLYING);
    estimate_is(1301.0F, 0.0F);
    watch(500.0F, 1);
    state_is(FLIGHT_LOWERING);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_TOO_HIGH, s.flags);
}

void test_an_estimate_that_is_not_known_is_not_looked_at(void)
{
    fly();
    estimate_is(5000.0F, 3000.0F);
    estimate.known = false;
    watch(500.0F, 3);
    state_is(FLIGHT_FLYING);
}

void test_lowering_goes_on_while_the_estimate_is_too_high(void)
{
    lower();
    estimate_is(801.0F, 0.0F);
    watch(500.0F, 5);
    state_is(FLIGHT_LOWERING);
    estimate_is(799.0F, 0.0F);
    watch(500.0F, 1);
    state_is(FLIGHT_FLYING);
}

void test_an_estimated_climb_counts_and_an_estimated_descent_does_not(void)
{
    fly();
    estimate_is(1299.0F, -3000.0F);
    watch(500.0F, 1);
    state_is(FLIGHT_FLYING);
    estimate_is(800.0F, 1500.0F); /* the brake alone takes 281 mm, and 500 mm are left */
    watch(500.0F, 1);
    state_is(FLIGHT_LOWERING);
}

/* ---- what holds a take-off back */

void test_without_the_offset_of_the_imu_the_reference_waits(void)
{
    in.attitude_ready = false;
    watch(0.0F, 3);
    setr(0.5F);
    watch(0.0F, 50);
    state_is(FLIGHT_GROUND);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_ATTITUDE, s.flags);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
    in.attitude_ready = true;
    watch(0.0F, 1);
    state_is(FLIGHT_TAKEOFF);
}

void test_without_a_height_the_reference_waits(void)
{
    setr(0.5F);
    blind(5000);
    state_is(FLIGHT_GROUND);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_HEIGHT, s.flags);
    watch(0.0F, 1);
    state_is(FLIGHT_TAKEOFF);
}

void test_a_reference_that_waits_is_withdrawn_by_setr_0(void)
{
    setr(0.5F);
    blind(500);
    setr(0.0F);
    blind(100);
    watch(0.0F, 20);
    state_is(FLIGHT_GROUND);
}

void test_a_reference_without_a_new_sequence_is_not_looked_at(void)
{
    watch(0.0F, 3);
    in.reference_m = 0.5F;
    watch(0.0F, 3);
    state_is(FLIGHT_GROUND);
    fly();
    in.reference_m = 0.0F;
    watch(500.0F, 3);
    state_is(FLIGHT_FLYING);
}

void test_a_reference_that_is_no_height_is_ignored(void)
{
    const float wrong[] = {NAN, INFINITY, -INFINITY, -0.5F, 3.01F, 1e9F};
    fly();
    for (unsigned i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        setr(wrong[i]);
        watch(500.0F, 2);
        state_is(FLIGHT_FLYING);
        TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
    }
}

void test_the_pilots_height_must_be_held_without_a_break(void)
{
    watch(400.0F, 9);
    watch(90.0F, 1);
    watch(400.0F, 7);
    state_is(FLIGHT_GROUND);
    blind(400); /* stale */
    watch(400.0F, 10);
    state_is(FLIGHT_GROUND);
    watch(400.0F, 1);
    state_is(FLIGHT_FLOATING);
}

void test_a_height_never_valid_is_the_ground(void)
{
    blind(20000);
    state_is(FLIGHT_GROUND);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_HEIGHT, s.flags);
}

void test_after_being_aloft_an_unknown_height_is_airborne(void)
{
    floating();
    in.has_throttle = false;
    blind(120000);
    state_is(FLIGHT_FLOATING);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_HEIGHT | FLIGHT_FLAG_PILOT, s.flags);
}

/* ---- the seed's flights are left alone */

void test_bounces_and_heights_of_zero_leave_flying_alone(void)
{
    fly();
    watch(0.0F, 30);
    state_is(FLIGHT_FLYING);
    watch(-40.0F, 30);
    state_is(FLIGHT_FLYING);
}

void test_overshoots_platforms_and_edges_leave_flying_alone(void)
{
    take_off();
    setr(0.3F);
    watch(0.0F, 1);
    watch(900.0F, 10); /* P alone: 0.6 m over 0.3 m */
    watch(10.0F, 10);
    watch(1090.0F, 10);
    state_is(FLIGHT_FLYING);
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
}

void test_a_vehicle_that_does_not_lift_stays_in_takeoff(void)
{
    take_off();
    watch(3.0F, 600);
    state_is(FLIGHT_TAKEOFF);
}

/* ---- the ground */

void test_a_descent_through_50_mm_is_not_rest(void)
{
    land();
    for (float height_mm = 60.0F; height_mm > -60.0F; height_mm -= 5.0F) { /* 0.05 m/s */
        watch(height_mm, 1);
        state_is(FLIGHT_LANDING);
    }
}

void test_noise_of_the_sensor_does_not_hide_the_ground(void)
{
    land();
    for (int i = 0; i < 15; i++) {
        watch((i % 2 != 0) ? 8.0F : -8.0F, 1);
    }
    state_is(FLIGHT_GROUND);
}

void test_a_platform_of_60_mm_is_not_the_ground(void)
{
    land();
    watch(60.0F, 100);
    state_is(FLIGHT_LANDING);
}

void test_a_height_that_is_gone_cannot_show_the_ground(void)
{
    land();
    watch(10.0F, 3);
    blind(2000);
    state_is(FLIGHT_DESCENDING);
}

/* ---- latches */

void test_after_a_failure_the_ground_is_not_left_without_a_new_reference(void)
{
    descend();
    watch(480.0F, 5);
    watch(0.0F, 14);
    state_is(FLIGHT_GROUND);
    watch(0.0F, 100);
    state_is(FLIGHT_GROUND);
    setr(0.5F);
    watch(0.0F, 1);
    state_is(FLIGHT_TAKEOFF);
}

void test_a_reference_given_while_descending_does_not_survive_the_ground(void)
{
    descend();
    setr(0.5F);
    blind(45000);
    state_is(FLIGHT_GROUND);
    watch(0.0F, 100);
    state_is(FLIGHT_GROUND);
}

/* ---- heights that are none */

void test_heights_that_are_no_heights_count_as_missing(void)
{
    const float wrong[] = {NAN, INFINITY, -INFINITY, 5001.0F, -501.0F, 1e30F};
    for (unsigned i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        setUp();
        fly();
        watch(wrong[i], 2);
        state_is(FLIGHT_FLYING);
        TEST_ASSERT_EQUAL_FLOAT(500.0F, s.height.height_mm);
        watch(wrong[i], 1);
        state_is(FLIGHT_COASTING);
    }
}

void test_scans_without_height_count_as_missing(void)
{
    fly();
    for (int i = 0; i < 3; i++) {
        in.height_valid = false;
        in.altitude.height_mm = 0.0F;
        cycle(100);
    }
    state_is(FLIGHT_COASTING);
}

void test_an_old_height_that_only_now_arrives_is_stale(void)
{
    watch(0.0F, 3);
    setr(0.5F);
    see(0.0F);
    in.height_time_us -= 400000U;
    cycle(100);
    state_is(FLIGHT_GROUND);
}

void test_a_height_from_just_after_now_is_fresh(void)
{
    watch(0.0F, 3);
    setr(0.5F);
    see(0.0F);
    in.height_time_us += 12000U; /* 2 ms after the cycle's now */
    cycle(100);
    TEST_ASSERT_EQUAL_UINT32(0, s.height.age_us);
    state_is(FLIGHT_TAKEOFF);
}

void test_a_height_lost_for_longer_than_the_clock_wraps_stays_lost(void)
{
    watch(0.0F, 3);
    blind(400);
    setr(0.5F);
    for (int i = 0; i < 5000; i++) { /* 83 minutes; the 32-bit clock takes 71.6 */
        cycle(1000);
        state_is(FLIGHT_GROUND);
    }
}

/* ---- rate of change */

void test_the_rate_is_between_heights_and_not_between_cycles(void)
{
    fly();
    watch(520.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 200.0F, s.height.rate_mm_s);
    TEST_ASSERT_EQUAL_UINT32(100000, s.height.gap_us);
    cycle(50);
    TEST_ASSERT_FALSE(s.height.is_new);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 200.0F, s.height.rate_mm_s);
    cycle(50);
    watch(460.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, -300.0F, s.height.rate_mm_s);
    TEST_ASSERT_EQUAL_UINT32(200000, s.height.gap_us);
}

void test_the_rate_changes_by_ten_metres_per_second_squared_at_most(void)
{
    fly();
    watch(850.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 1000.0F, s.height.rate_mm_s);
    watch(500.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.0F, s.height.rate_mm_s);
    watch(250.0F, 1);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, -1000.0F, s.height.rate_mm_s);
}

void test_the_rate_ends_at_four_metres_per_second(void)
{
    watch(0.0F, 1);
    for (int i = 1; i < 10; i++) {
        watch(500.0F * (float)i, 1);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 4000.0F, s.height.rate_mm_s);
}

void test_the_first_height_and_one_after_a_loss_have_no_rate(void)
{
    watch(400.0F, 1);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.height.rate_mm_s);
    watch(410.0F, 1);
    blind(1600);
    watch(900.0F, 1);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.height.rate_mm_s);
}

void test_two_heights_with_one_time_have_no_rate(void)
{
    fly();
    in.height_sequence++;
    in.altitude.height_mm = 520.0F;
    cycle(100);
    TEST_ASSERT_TRUE(s.height.is_new);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.height.rate_mm_s);
}

/* ---- flags */

void test_a_silent_imu_is_a_flag_and_nothing_else(void)
{
    fly();
    for (int i = 0; i < 30; i++) {
        see(500.0F);
        in.now_us += 100000U;
        step();
        TEST_ASSERT_EQUAL_UINT16(i < 2 ? 0 : FLIGHT_FLAG_ATTITUDE, s.flags);
        state_is(FLIGHT_FLYING);
    }
    watch(500.0F, 1);
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
}

void test_disagreeing_mirrors_are_a_flag_as_long_as_there_is_a_height(void)
{
    fly();
    in.altitude.disagree = true;
    watch(500.0F, 1);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_DISAGREE, s.flags);
    blind(300);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_HEIGHT, s.flags);
}

/* ---- link */

static void silence(uint32_t ms)
{
    for (; ms >= 100U; ms -= 100U) {
        watch(500.0F, 1);
    }
}

void test_a_link_that_is_not_armed_is_never_missed(void)
{
    fly();
    line();
    silence(120000);
    state_is(FLIGHT_FLYING);
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
}

void test_an_armed_link_that_never_spoke_is_not_missed(void)
{
    link_s = 2.0F;
    fly();
    silence(120000);
    state_is(FLIGHT_FLYING);
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
}

void test_a_silent_link_flags_then_holds_for_five_seconds_then_lands(void)
{
    link_s = 2.0F;
    fly();
    line();
    silence(2000);
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
    silence(100);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_LINK, s.flags);
    silence(4900);
    state_is(FLIGHT_FLYING);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, s.reference_m);
    silence(100);
    state_is(FLIGHT_LANDING);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_LINK, s.flags);
}

void test_any_line_keeps_the_link_alive(void)
{
    link_s = 2.0F;
    fly();
    for (int i = 0; i < 20; i++) {
        line();
        silence(1900);
        TEST_ASSERT_EQUAL_UINT16(0, s.flags);
    }
    state_is(FLIGHT_FLYING);
}

void test_a_link_that_comes_back_does_not_end_the_landing_but_a_reference_does(void)
{
    link_s = 2.0F;
    fly();
    line();
    silence(7100);
    state_is(FLIGHT_LANDING);
    line();
    silence(1000);
    state_is(FLIGHT_LANDING);
    TEST_ASSERT_EQUAL_UINT16(0, s.flags);
    line();
    setr(0.5F);
    silence(100);
    state_is(FLIGHT_FLYING);
}

void test_a_reference_counts_as_life_even_when_its_line_is_reported_later(void)
{
    link_s = 2.0F;
    fly();
    line();
    silence(7100);
    setr(0.5F);
    silence(200);
    state_is(FLIGHT_FLYING);
}

void test_a_lost_link_withdraws_a_reference_that_waits_on_the_ground(void)
{
    link_s = 2.0F;
    in.attitude_ready = false;
    watch(0.0F, 3);
    line();
    setr(0.5F);
    watch(0.0F, 72);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
    in.attitude_ready = true;
    line();
    watch(0.0F, 10);
    state_is(FLIGHT_GROUND);
}

void test_a_link_silent_for_longer_than_the_clock_wraps_stays_silent(void)
{
    link_s = 60.0F;
    line();
    cycle(100);
    for (int i = 0; i < 5000; i++) {
        cycle(1000);
        TEST_ASSERT_TRUE(i < 60 || (s.flags & FLIGHT_FLAG_LINK) != 0U);
    }
}

/* ---- the whole */

void test_the_start_is_the_ground_with_every_doubt_shown(void)
{
    in.attitude_ready = false;
    step();
    state_is(FLIGHT_GROUND);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_HEIGHT | FLIGHT_FLAG_ATTITUDE, s.flags);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, s.reference_m);
    TEST_ASSERT_EQUAL_UINT32(0, s.step_us);
}

void test_the_time_in_a_state_starts_with_the_state(void)
{
    take_off();
    TEST_ASSERT_EQUAL_UINT32(0, s.state_us);
    watch(0.0F, 7);
    TEST_ASSERT_EQUAL_UINT32(700000, s.state_us);
}

static uint32_t noise = SEED;

static uint32_t any(uint32_t below)
{
    noise = noise * 1664525U + 1013904223U;
    return (noise >> 8) % below;
}

/* Whatever comes in: the state is one of the table's, a transition is a row of it, the reference in force is
 * within its limits, and the ground is reached from the air only at rest or after a spent descent. */
void test_random_inputs_never_leave_the_table(void)
{
    static const float heights[] = {NAN,    INFINITY, -9e9F,   0.0F,    20.0F, 160.0F,
                                    500.0F, 900.0F,   1900.0F, 4900.0F, 9e9F};
    static const float references[] = {NAN, 0.0F, 0.3F, 1.0F, 3.0F, -1.0F, INFINITY};
    char seed[32];
    unsigned seen = 0;
    snprintf(seed, sizeof seed, "seed %u", SEED);
    TEST_MESSAGE(seed);
    for (int32_t i = 0; i < 200000; i++) {
        const flight_state_t from = s.state;
        const bool quiet = (i / 500) % 4 == 3;
        if (!quiet && any(10) < 8) {
            see(heights[any(40) == 0 ? any(11) : 3 + (uint32_t)(i / 300) % 6]);
        }
        if (any(60) == 0) {
            setr(references[any(7)]);
        }
        if (any(30) == 0) {
            line();
        }
        link_s = (i / 5000) % 2 == 0 ? 0.0F : 1.0F;
        in.attitude_ready = any(50) != 0;
        in.pitch_rad = (i / 700) % 9 == 8 ? 1.0F : 0.1F;
        in.has_throttle = any(300) == 0 ? !in.has_throttle : in.has_throttle || any(20) == 0;
        cycle(50 + any(100));
        bool row = from == s.state;
        for (unsigned k = 0; k < FLIGHT_TRANSITION_COUNT; k++) {
            row = row || (flight_transitions[k].from == from && flight_transitions[k].to == s.state);
        }
        TEST_ASSERT_TRUE(row);
        TEST_ASSERT_TRUE(s.reference_m >= 0.0F && s.reference_m <= 3.0F);
        TEST_ASSERT_TRUE(isfinite(s.height.height_mm) && isfinite(s.height.rate_mm_s));
        if (s.state == FLIGHT_GROUND && from != FLIGHT_GROUND && from != FLIGHT_DESCENDING) {
            TEST_ASSERT_TRUE(s.height.height_mm < 50.0F);
        }
        seen |= 1U << s.state;
    }
    TEST_ASSERT_EQUAL_UINT32((1U << FLIGHT_STATE_COUNT) - 1U, seen);
}
