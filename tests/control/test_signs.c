#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

static command_t described(void)
{
    return signs_of_command(&now, &in, 0.1F);
}

void test_off_the_ground_is_where_only_the_commanded_thrust_carries_it(void)
{
    static const struct {
        flight_state_t state;
        bool airborne, lifting, has_throttle;
        float height_mm;
        bool off_ground;
    } rows[] = {{FLIGHT_GROUND, true, false, true, 500.0F, false},
                {FLIGHT_CUT, true, false, true, 500.0F, false},
                {FLIGHT_TAKEOFF, true, true, true, 0.0F, true},
                {FLIGHT_TAKEOFF, false, true, true, 500.0F, false},
                {FLIGHT_FLYING, true, false, true, 0.0F, true},
                {FLIGHT_FLYING, true, true, true, 500.0F, false},
                {FLIGHT_FLYING, true, false, false, 500.0F, false},
                {FLIGHT_FLOATING, true, false, true, 500.0F, true},
                {FLIGHT_LANDING, true, false, true, 90.0F, true},
                {FLIGHT_LANDING, true, false, true, 89.9F, false},
                {FLIGHT_LANDING, true, false, false, 500.0F, false},
                {FLIGHT_COASTING, true, false, true, 0.0F, true},
                {FLIGHT_COASTING, true, false, false, 500.0F, false},
                {FLIGHT_DESCENDING, true, false, true, 0.0F, true}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        in_state(rows[i].state);
        lifting(rows[i].lifting);
        airborne(rows[i].airborne);
        at_mm(rows[i].height_mm);
        in.has_throttle = rows[i].has_throttle;
        TEST_ASSERT_EQUAL(rows[i].off_ground, described().off_ground);
    }
    in_state(FLIGHT_FLOATING);
    mode_is(FLIGHT_MODE_HOVER);
    TEST_ASSERT_FALSE(described().off_ground);
}

void test_the_flight_is_described_to_the_consistency_check(void)
{
    in.now_us = 700000U;
    in.reference_sequence = 3U;
    cycle_was_at_us(true, 600000U);
    order_was(3U);
    hovers_at_n(7.2F);
    now.thrust_n = 7.9F;
    band_is_n(0.2F);
    noise_is_mps2(0.7F);
    command_t flown = described();
    NEAR(0.1F, flown.step_s);
    TEST_ASSERT_FALSE(flown.grounded || flown.standing || flown.ordered);
    TEST_ASSERT_TRUE(flown.off_ground && flown.ours);
    NEAR(7.7F, flown.thrust_n);
    NEAR(7.2F, flown.hover_n);
    NEAR(est_law_vehicle(&est, &parameters).authority_mps2_per_n, flown.authority_mps2_per_n);
    NEAR(2.5F, flown.damping_per_s);
    NEAR(0.1F, flown.wanted_m);
    NEAR(0.7F, flown.noise_mps2);
    in.now_us += 5000000U;
    in.reference_sequence = 4U;
    in.has_throttle = false;
    in_state(FLIGHT_GROUND);
    flown = described();
    NEAR(0.5F, flown.step_s);
    TEST_ASSERT_TRUE(flown.grounded && flown.ordered);
    TEST_ASSERT_FALSE(flown.ours);
    cycle_was_at_us(false, 600000U);
    in_state(FLIGHT_TAKEOFF);
    lifting(true);
    flown = described();
    TEST_ASSERT_EQUAL_FLOAT(0.0F, flown.step_s);
    TEST_ASSERT_TRUE(flown.standing);
}

static bool may_be_in_hands(void)
{
    return signs_of_vertical(&now, false).in_hands;
}

void test_it_may_be_carried_on_the_ground_without_a_pin_or_in_a_descent_that_began_so(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        in_state(FLIGHT_GROUND);
        evidence.in_hands = i != 1;
        set(PARAMETER_SEL, (i == 2) ? (float)SEL_PIN : (float)SEL_NONE);
        TEST_ASSERT_EQUAL(i == 0, may_be_in_hands());
    }
    in_state(FLIGHT_DESCENDING);
    sway(true);
    TEST_ASSERT_FALSE(may_be_in_hands());
    given_back(0.06F);
    TEST_ASSERT_TRUE(may_be_in_hands());
    frame_was_s_ago(1.0F); /* an IMU that tells nothing does not tell that either */
    TEST_ASSERT_FALSE(may_be_in_hands());
    frame_was_s_ago(0.0F);
    sway(false);
    TEST_ASSERT_FALSE(may_be_in_hands());
}

void test_the_supervisor_hears_of_an_estimate_that_a_height_has_confirmed(void)
{
    estimated(0.52F, 0.3F, 0.0F);
    evidence.upright = 0.9F;
    for (int i = 0; i < 3; i++) {
        confirmed(i != 1);
        frame_was_s_ago((i == 2) ? 1.0F : 0.0F);
        TEST_ASSERT_EQUAL(i == 0, signs_of_vertical(&now, false).known);
    }
    const vertical_estimate_t told = signs_of_vertical(&now, true);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 520.0F, told.height_mm);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 300.0F, told.climb_mm_s);
    NEAR(0.9F, told.upright);
    TEST_ASSERT_TRUE(told.hands_over && !told.stands && !told.sways && !told.rocks);
    sway(true);
    TEST_ASSERT_TRUE(signs_of_vertical(&now, true).sways && signs_of_vertical(&now, true).rocks);
}

void test_falls_of_the_ground_are_told_by_the_accelerometer_where_two_mirrors_agree_and_law_est_flies(void)
{
    for (int missing = 0; missing < 4; missing++) {
        now.law = (missing == 1) ? LAW_PIDT : LAW_EST;
        evidence.mirrors.agree = missing != 2;
        evidence.felt_valid = missing != 3;
        evidence.felt_mps = -0.4F;
        TEST_ASSERT_EQUAL(missing == 0, signs_of_vertical(&now, false).tells_falls);
    }
    TEST_ASSERT_EQUAL_FLOAT(-400.0F, signs_of_vertical(&now, false).felt_mm_s);
}

void test_it_stands_by_the_sensors_or_without_thrust_where_contact_ends_so(void)
{
    TEST_ASSERT_FALSE(signs_of_vertical(&now, false).stands);
    evidence.stands = true;
    TEST_ASSERT_TRUE(signs_of_vertical(&now, false).stands);
    evidence.stands = false;
    took_off_in_vain();
    now.idle_n = 0.8F;
    now.thrust_n = 0.81F;
    TEST_ASSERT_FALSE(signs_of_vertical(&now, false).stands);
    TEST_ASSERT_TRUE(signs_of_landing(&now).powered);
    now.thrust_n = 0.8F;
    TEST_ASSERT_TRUE(signs_of_vertical(&now, false).stands);
    TEST_ASSERT_FALSE(signs_of_landing(&now).powered);
}

void test_contact_is_told_state_height_and_tilt(void)
{
    at_mm(39.0F);
    in_state(FLIGHT_LANDING);
    sway(true);
    now.risen = false;
    const contact_signs_t signs = signs_of_contact(&now);
    TEST_ASSERT_TRUE(signs.state == FLIGHT_LANDING && !signs.risen && signs.sways);
    const landing_signs_t landing = signs_of_landing(&now);
    TEST_ASSERT_TRUE(landing.state == FLIGHT_LANDING && landing.rocks && landing.sees);
    NEAR(0.039F, landing.height_m);
    NEAR(0.1F, landing.step_s);
    evidence.doubts = DOUBT_SIGHT;
    TEST_ASSERT_FALSE(signs_of_landing(&now).sees);
}

void test_the_guard_is_told_of_a_fifth_to_either_side_of_grav_and_of_an_order_off_the_ground(void)
{
    now.idle_n = 0.8F;
    guard_case_t told = signs_of_guard(&now, 7.7F);
    TEST_ASSERT_TRUE(told.ordered && told.confirmed);
    NEAR(7.7F, told.wanted_n);
    NEAR(0.8F, told.idle_n);
    NEAR(8.9F, told.heaviest_n);
    NEAR(5.6F, told.lightest_n);
    NEAR(0.1F, told.step_s);
    evidence.unshown.climb = true;
    set(PARAMETER_GRAV, 8.0F);
    told = signs_of_guard(&now, 7.7F);
    NEAR(9.6F, told.heaviest_n);
    NEAR(5.9F, told.lightest_n);
    TEST_ASSERT_FALSE(told.confirmed);
    for (int state = 0; state < FLIGHT_STATE_COUNT; state++) {
        in_state((flight_state_t)state);
        TEST_ASSERT_EQUAL(state != FLIGHT_GROUND && state != FLIGHT_CUT, signs_of_guard(&now, 7.7F).ordered);
    }
}

void test_the_hover_thrust_is_learned_in_flight_without_a_doubt(void)
{
    static const struct {
        flight_state_t state;
        flight_mode_t mode;
        bool throttle_unknown, effect, flies, holds;
    } rows[] = {{FLIGHT_FLYING, FLIGHT_MODE_LAW, false, false, true, true},
                {FLIGHT_TAKEOFF, FLIGHT_MODE_LAW, false, false, true, false},
                {FLIGHT_FLOATING, FLIGHT_MODE_FLOAT, false, false, true, true},
                {FLIGHT_FLOATING, FLIGHT_MODE_HOVER, false, false, false, false},
                {FLIGHT_FLOATING, FLIGHT_MODE_FLOAT, true, false, false, false},
                {FLIGHT_FLOATING, FLIGHT_MODE_EST_HOLD, true, true, true, true},
                {FLIGHT_DESCENDING, FLIGHT_MODE_EST_SINK, false, false, false, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        in_state(rows[i].state);
        mode_is(rows[i].mode);
        unknown(rows[i].throttle_unknown);
        commands_show(rows[i].effect);
        const hover_lesson_t lesson = signs_of_hover(&now);
        TEST_ASSERT_EQUAL(rows[i].flies, lesson.flies);
        TEST_ASSERT_EQUAL(rows[i].holds, lesson.holds);
        TEST_ASSERT_FALSE(lesson.grounded);
    }
    for (int why = 0; why < 5; why++) {
        setUp();
        flagged((why == 1) ? FLIGHT_FLAG_HEIGHT : 0U);
        evidence.doubts = (uint16_t)((why == 2)   ? DOUBT_SIGHT
                                     : (why == 3) ? DOUBT_THRUST
                                     : (why == 4) ? DOUBT_IMU
                                                  : 0U);
        TEST_ASSERT_EQUAL(why == 0 || why == 4, signs_of_hover(&now).sees);
    }
}

void test_the_lesson_of_a_hover_thrust_is_of_the_estimate_in_the_air(void)
{
    est_hovers_at_n(7.4F);
    now.thrust_n = 7.5F;
    hover_lesson_t lesson = signs_of_hover(&now);
    NEAR(7.4F, lesson.estimated_n);
    NEAR(7.5F, lesson.thrust_n);
    NEAR(GRAV_N, lesson.gravity_n);
    TEST_ASSERT_TRUE(lesson.estimated && lesson.teaches);
    evidence.mirrors.no_effect = true;
    TEST_ASSERT_FALSE(signs_of_hover(&now).teaches);
    evidence.mirrors.no_effect = false;
    evidence.teaches = false;
    airborne(false); /* an estimate of a vehicle on the ground is none */
    lesson = signs_of_hover(&now);
    TEST_ASSERT_FALSE(lesson.estimated || lesson.teaches);
    airborne(true);
    lose_the_estimate();
    TEST_ASSERT_FALSE(signs_of_hover(&now).estimated);
    lifting(true);
    TEST_ASSERT_TRUE(signs_of_hover(&now).grounded);
    cycle_takes_us(5000000U);
    NEAR(0.5F, signs_of_hover(&now).step_s);
    lifting(false);
    in_state(FLIGHT_GROUND);
    TEST_ASSERT_TRUE(signs_of_hover(&now).grounded);
}

void test_the_pilots_part_is_told_what_is_pushed_and_felt(void)
{
    set(PARAMETER_SEL, (float)SEL_PIN);
    evidence.rise_mps = -0.2F;
    now.thrust_n = 6.7F;
    hovers_at_n(7.3F);
    delivers_n(8.0F);
    in_state_for_us(FLIGHT_LANDING, 0U);
    pilot_signs_t told = signs_of_pilot(&now, true);
    TEST_ASSERT_TRUE(told.state == FLIGHT_LANDING && told.entered && !told.handed_over);
    TEST_ASSERT_TRUE(told.has_throttle && told.has_pin && told.felt);
    NEAR(500.0F, told.height_mm);
    NEAR(-0.2F, told.rise_mps);
    NEAR(6.7F, told.thrust_n);
    NEAR(7.3F, told.hover_n);
    NEAR(8.0F * IMU_GRAVITY_MPS2 / GRAV_N, told.pushed_mps2);
    NEAR(0.1F, told.step_s);
    set(PARAMETER_SEL, (float)SEL_NONE);
    in_state_for_us(FLIGHT_LANDING, 1U);
    given_back_unseen(true);
    accelerations_come(false);
    told = signs_of_pilot(&now, false);
    TEST_ASSERT_TRUE(!told.entered && told.handed_over && !told.has_throttle && !told.has_pin && !told.felt);
}
