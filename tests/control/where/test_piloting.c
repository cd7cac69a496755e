#include "control/credible.h"
#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_a_pilots_next_turn_begins_without_what_was_added(void)
{
    for (int i = 0; i < 2; i++) {
        setUp();
        set(PARAMETER_SEL, SEL_NONE);
        f.where.supervisor.state = FLIGHT_FLOATING;
        f.aim.floating_m = 0.5F;
        unknown(i == 1);
        f.bounds.trim_n = 0.3F;
        (void)bounded_n(7.0F); /* the cycle before */
        update_throttle(true);
        TEST_ASSERT_TRUE(pilot_is_unknown(&f.where.pilot));
        NEAR((i == 1) ? 0.3F : 0.0F, f.bounds.trim_n);
    }
}

void test_floating_without_a_pin_is_unsure_and_its_end_engages(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        f.where.supervisor.state = (i == 1) ? FLIGHT_FLYING : FLIGHT_FLOATING;
        set(PARAMETER_SEL, (i == 2) ? (float)SEL_PIN : (float)SEL_NONE);
        update_throttle(i != 3);
        TEST_ASSERT_EQUAL(i == 0, pilot_is_unknown(&f.where.pilot));
    }
    static const struct {
        flight_state_t state;
        bool before, engaged;
    } rows[] = {{FLIGHT_FLYING, true, true},
                {FLIGHT_FLYING, false, false},
                {FLIGHT_GROUND, true, false},
                {FLIGHT_FLOATING, true, false}};
    for (int i = 0; i < 4; i++) {
        setUp();
        f.where.supervisor.state = rows[i].state;
        unknown(rows[i].before);
        f.est.airborne = false;
        f.where.hover.thrust_n = 7.3F;
        f.thrust_n = 6.7F;
        update_throttle(true);
        TEST_ASSERT_EQUAL(rows[i].engaged, f.est.airborne);
        if (rows[i].engaged) {
            NEAR(7.3F, f.est.hover.thrust_n);
            NEAR(6.7F, f.est.cascade.thrust_n);
        }
    }
}

/* One frame of FLOATING without a pin, whose accelerometer measures this share of a jump of the thrust. */
static void float_a_frame(uint32_t step_us, bool felt)
{
    f.est.estimator.now_us += step_us;
    f.est.estimator.felt = felt;
    update_throttle(true);
}

void test_a_vehicle_that_floats_without_a_pin_learns_its_hover_thrust_once_it_obeys(void)
{
    f.where.supervisor.state = FLIGHT_FLOATING;
    parameters.value[PARAMETER_SEL] = (float)SEL_NONE;
    f.where.hover.thrust_n = 7.3F;
    f.thrust_n = 6.7F;
    f.est.authority_mps2_per_n = 1.4F;
    float_a_frame(25000U, true);
    TEST_ASSERT_TRUE(pilot_is_unknown(&f.where.pilot) && f.where.pilot.effect.running_s == 0.0F);
    for (int i = 0; i < 100 && !f.where.pilot.effect.has_effect; i++) {
        f.est.actuator.thrust_n = 7.0F + 0.5F * (float)(i % 3);
        f.est.estimator.up_mps2 = 1.4F * f.est.actuator.thrust_n - 9.0F;
        TEST_ASSERT_FALSE(pilot_shows_effect(&f.where.pilot));
        float_a_frame(25000U, true);
    }
    TEST_ASSERT_TRUE(pilot_shows_effect(&f.where.pilot));
    NEAR(7.3F, f.est.hover.thrust_n);
    NEAR(6.7F, f.est.cascade.thrust_n);
    f.est.cascade.thrust_n = 1.0F;
    float_a_frame(0U, true); /* no new frame */
    TEST_ASSERT_TRUE(pilot_shows_effect(&f.where.pilot));
    float_a_frame(25000U, true);
    NEAR(1.0F, f.est.cascade.thrust_n); /* engaged once */
    effect_t known = f.where.pilot.effect;
    float_a_frame(FRAME_GAP_US + 1U, true);
    TEST_ASSERT_FALSE(pilot_shows_effect(&f.where.pilot));
    f.where.pilot.effect = known;
    float_a_frame(25000U, false);
    TEST_ASSERT_FALSE(pilot_shows_effect(&f.where.pilot));
    f.where.pilot.effect = known;
    f.where.pilot.given_back = true;
    f.where.supervisor.state = FLIGHT_DESCENDING;
    float_a_frame(25000U, true);
    TEST_ASSERT_TRUE(pilot_is_unknown(&f.where.pilot) && !pilot_shows_effect(&f.where.pilot));
}

void test_a_descent_handed_over_without_heights_is_carried_to_its_end(void)
{
    static const struct {
        flight_state_t state;
        bool handed_over, before, carried;
        uint32_t state_us;
    } rows[] = {{FLIGHT_DESCENDING, true, false, true, 0U},
                {FLIGHT_DESCENDING, true, false, false, 1U},
                {FLIGHT_DESCENDING, false, false, false, 0U},
                {FLIGHT_DESCENDING, false, true, true, 5U},
                {FLIGHT_LANDING, true, true, false, 0U}};
    for (int i = 0; i < 5; i++) {
        for (int pin = 0; pin < 2; pin++) {
            setUp();
            set(PARAMETER_SEL, (pin != 0) ? (float)SEL_PIN : (float)SEL_NONE);
            f.where.supervisor.state = rows[i].state;
            f.where.supervisor.handed_over = rows[i].handed_over;
            f.where.supervisor.state_us = rows[i].state_us;
            f.where.pilot.given_back = rows[i].before;
            update_throttle(true);
            TEST_ASSERT_EQUAL(rows[i].carried, f.where.pilot.given_back);
            TEST_ASSERT_EQUAL(rows[i].carried, pilot_is_unknown(&f.where.pilot));
            NEAR((i == 0) ? ((pin != 0) ? 0.15F : 0.06F) : 0.0F, f.where.pilot.sink_n_per_s);
        }
    }
}

void test_a_landing_with_too_little_thrust_to_fly_that_does_not_sink_is_in_vain(void)
{
    static const struct {
        float thrust_n, height_mm, rise_mps, before_s;
        uint32_t state_us;
        bool vain;
    } rows[] = {{5.4F, 100.0F, -0.29F, 0.95F, 1U, true},  {5.4F, 100.0F, -0.29F, 0.85F, 1U, false},
                {5.6F, 100.0F, -0.29F, 0.95F, 1U, false}, {5.4F, 79.0F, -0.29F, 0.95F, 1U, false},
                {5.4F, 100.0F, -0.31F, 0.95F, 1U, false}, {5.4F, 100.0F, -0.29F, 0.95F, 0U, false}};
    for (int i = 0; i < 6; i++) {
        setUp();
        f.where.supervisor.state = FLIGHT_LANDING;
        f.where.supervisor.state_us = rows[i].state_us;
        f.where.supervisor.height.height_mm = rows[i].height_mm;
        f.evidence.rise_mps = rows[i].rise_mps;
        f.thrust_n = rows[i].thrust_n;
        f.where.pilot.vain_s = rows[i].before_s;
        update_throttle(true);
        TEST_ASSERT_EQUAL(rows[i].vain, pilot_holds_up(&f.where.pilot, f.where.supervisor.state));
        NEAR(i == 0 ? 1.0F : i == 1 ? 0.95F : 0.0F, f.where.pilot.vain_s);
        aim_judge(&f.aim, &f.where);
        TEST_ASSERT_EQUAL(rows[i].vain, f.aim.out_of_reach);
        f.where.supervisor.state = FLIGHT_DESCENDING;
        TEST_ASSERT_FALSE(pilot_holds_up(&f.where.pilot, f.where.supervisor.state));
    }
}

void test_without_a_pin_a_landing_in_vain_keeps_a_thrust_near_hover(void)
{
    for (int pin = 0; pin < 2; pin++) {
        setUp();
        set(PARAMETER_SEL, (pin != 0) ? (float)SEL_PIN : (float)SEL_NONE);
        f.where.supervisor.state = FLIGHT_LANDING;
        f.where.supervisor.state_us = 1U;
        f.where.supervisor.height.height_mm = 500.0F;
        f.thrust_n = 5.0F;
        f.where.pilot.vain_s = 1.0F;
        update_throttle(true);
        TEST_ASSERT_EQUAL(pin == 0, pilot_is_unknown(&f.where.pilot));
        f.thrust_n = 7.0F; /* it stays so */
        update_throttle(true);
        TEST_ASSERT_EQUAL(pin == 0, pilot_is_unknown(&f.where.pilot));
        f.bounds.sunk_n = 0.4F;
        NEAR((pin == 0) ? 7.0F - 2.0F - 0.42F : 3.0F, bounded_n(3.0F));
    }
}
