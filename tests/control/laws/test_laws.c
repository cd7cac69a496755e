#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

static void spoil_laws(void)
{
    f.laws.pid = (pid_state_t){.integral_n = 0.5F, .primed = true};
    f.laws.pidt = (pidt_state_t){.integral_n = 0.5F, .primed = true};
}

void test_a_law_resumes_with_its_integral_and_others_forget_it_but_in_coasting(void)
{
    spoil_laws();
    f.where.hover.thrust_n = 7.3F;
    change_mode(FLIGHT_MODE_HOVER, FLIGHT_MODE_LAW);
    NEAR(0.5F, f.laws.pid.integral_n);
    NEAR(0.5F, f.laws.pidt.integral_n);
    TEST_ASSERT_FALSE(f.laws.pid.primed || f.laws.pidt.primed);
    change_mode(FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_LAW);
    NEAR(0.3F, f.laws.pidt.integral_n); /* what law EST has found */
    f.where.supervisor.state = FLIGHT_TAKEOFF;
    f.laws.pidt.integral_n = 0.5F;
    change_mode(FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_LAW);
    NEAR(0.5F, f.laws.pidt.integral_n);
    spoil_laws();
    f.where.supervisor.state = FLIGHT_COASTING;
    change_mode(FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER);
    NEAR(0.5F, f.laws.pid.integral_n);
    NEAR(0.5F, f.laws.pidt.integral_n);
    f.where.supervisor.state = FLIGHT_FLOATING;
    change_mode(FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER);
    NEAR(0.0F, f.laws.pid.integral_n);
    NEAR(0.0F, f.laws.pidt.integral_n);
    spoil_laws();
    f.where.supervisor.state = FLIGHT_COASTING;
    change_mode(FLIGHT_MODE_LAW, FLIGHT_MODE_FLOAT);
    NEAR(0.5F, f.laws.pid.integral_n);
    NEAR(0.0F, f.laws.pidt.integral_n);
}

void test_a_descent_starts_from_the_measured_rate_and_leaves_its_trim(void)
{
    f.where.supervisor.height.rate_mm_s = -150.0F;
    f.laws.descent.trim_n = 0.4F;
    change_mode(FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_DESCENT);
    NEAR(150.0F, f.laws.descent.sink_mm_s);
    NEAR(0.0F, f.laws.descent.trim_n);
    NEAR(7.0F, f.where.hover.thrust_n);
    f.laws.descent.trim_n = 0.4F;
    change_mode(FLIGHT_MODE_DESCENT, FLIGHT_MODE_BLIND_DESCENT);
    NEAR(7.4F, f.where.hover.thrust_n);
    f.laws.descent.sink_mm_s = 77.0F;
    change_mode(FLIGHT_MODE_LAW, FLIGHT_MODE_EST_LAND);
    NEAR(77.0F, f.laws.descent.sink_mm_s);
}

void test_the_thrust_passes_over_without_a_jump(void)
{
    static const struct {
        flight_mode_t before, now;
        float thrust_n, transfer_n;
        bool law_changed;
    } rows[] = {{FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, 6.8F, -0.2F, false},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, 6.0F, -0.5F, false}, /* half a newton from hover */
                {FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, 9.0F, 0.5F, false},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_LAW, 9.0F, 2.0F, true},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_IDLE, 6.8F, 0.0F, false},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_DESCENT, 6.8F, 0.0F, false},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_EST_LAND, 6.8F, 0.0F, true},
                {FLIGHT_MODE_IDLE, FLIGHT_MODE_LAW, 6.8F, 0.0F, false},
                {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_LAND, 6.8F, 0.24F, false}, /* fades: 0.4 of 0.5 s */
                {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_SINK, 6.8F, 0.24F, false},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_LAW, 6.8F, 0.24F, false},
                {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_BLIND_DESCENT, 6.8F, -0.2F, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        f.mode = rows[i].now;
        f.thrust_n = rows[i].thrust_n;
        f.laws.transfer_n = 0.3F;
        transfer(rows[i].before, rows[i].law_changed);
        NEAR(rows[i].transfer_n, f.laws.transfer_n);
    }
    for (int lifting = 0; lifting < 2; lifting++) {
        setUp();
        f.mode = FLIGHT_MODE_EST_HOLD;
        f.thrust_n = 6.8F;
        f.where.contact.lifting = lifting != 0;
        transfer(FLIGHT_MODE_HOVER, false);
        NEAR((lifting != 0) ? 0.0F : -0.2F, f.laws.transfer_n);
    }
}

/* Else the armed idle would go on for a second after a disarming. */
void test_a_change_of_the_law_on_the_ground_adds_nothing_to_the_idle(void)
{
    f.mode = FLIGHT_MODE_IDLE;
    f.thrust_n = 1.8F;
    f.laws.setpoint_n = 0.0F;
    f.laws.transfer_n = 0.3F;
    transfer(FLIGHT_MODE_IDLE, true);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.laws.transfer_n);
}

void test_a_new_gravity_moves_no_thrust_of_a_law_that_flies(void)
{
    static const struct {
        flight_mode_t mode, before;
        float integral_n;
    } rows[] = {{FLIGHT_MODE_LAW, FLIGHT_MODE_LAW, 0.1F},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, 0.4F},
                {FLIGHT_MODE_HOVER, FLIGHT_MODE_HOVER, 0.4F}};

    for (int i = 0; i < 3; i++) {
        setUp();
        f.law = LAW_PID;
        f.where.supervisor.height.height_mm = 600.0F; /* at its reference: the law adds nothing */
        f.mode = rows[i].mode;
        f.laws.gravity_n = 7.0F;
        f.laws.pid.integral_n = f.laws.pidt.integral_n = 0.4F;
        TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, PARAMETER_GRAV, 7.3F));
        const situation_t now = situation_after(rows[i].before);
        (void)laws_step(&f.laws, &f.est, &now);
        NEAR(rows[i].integral_n, f.laws.pid.integral_n);
        NEAR(rows[i].integral_n, f.laws.pidt.integral_n);
        NEAR(7.3F, f.laws.gravity_n);
    }
}

void test_each_mode_has_its_thrust(void)
{
    f.mode = FLIGHT_MODE_IDLE;
    TEST_ASSERT_FALSE(run_mode(false));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.laws.setpoint_n);
    f.mode = FLIGHT_MODE_HOVER;
    f.where.hover.thrust_n = 7.2F;
    TEST_ASSERT_FALSE(run_mode(false));
    NEAR(7.2F, f.laws.setpoint_n);
    f.mode = FLIGHT_MODE_BLIND_DESCENT;
    sway(true);
    f.where.supervisor.state_us = 5000000U;
    TEST_ASSERT_FALSE(run_mode(false));
    NEAR(descent_blind(7.2F, 5.0F), f.laws.setpoint_n);
    f.where.hover.thrust_n = 100.0F; /* so that a minute leaves something */
    f.where.supervisor.state_us = 90000000U;
    (void)run_mode(false);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, descent_blind(100.0F, 60.0F), f.laws.setpoint_n);
    f.where.hover.thrust_n = 7.2F;
    f.mode = FLIGHT_MODE_LAW;
    f.law = LAW_PID;
    TEST_ASSERT_TRUE(run_mode(false));
    TEST_ASSERT_TRUE(f.laws.pid.primed);
    f.law = LAW_PIDT;
    TEST_ASSERT_FALSE(run_mode(false));
    TEST_ASSERT_TRUE(f.laws.pidt.primed);
    f.laws.pidt.primed = false;
    f.mode = FLIGHT_MODE_FLOAT;
    f.where.supervisor.state = FLIGHT_FLOATING;
    f.aim.floating_m = 0.5F;
    (void)run_mode(false);
    NEAR(7.0F, f.laws.setpoint_n); /* it is at the height that it holds */
    f.mode = FLIGHT_MODE_DESCENT;
    f.laws.setpoint_n = -1.0F;
    (void)run_mode(false);
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, f.laws.setpoint_n);
    (void)run_mode(true);
    TEST_ASSERT_TRUE(f.laws.setpoint_n > 3.0F);
}

void test_the_release_is_the_laws(void)
{
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME, flight_releases(&f, &parameters));
    set(PARAMETER_LAW, LAW_PID);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME, flight_releases(&f, &parameters));
    f.mode = FLIGHT_MODE_LAW;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_PERIOD, flight_releases(&f, &parameters));
    set(PARAMETER_RELEASE, (float)RELEASE_SCAN);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_HEIGHT, flight_releases(&f, &parameters));
    set(PARAMETER_RELEASE, (float)RELEASE_FREE);
    set(PARAMETER_LAW, LAW_PIDT);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_HEIGHT, flight_releases(&f, &parameters));
    f.mode = FLIGHT_MODE_EST_LAND;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME, flight_releases(&f, &parameters));
}

void test_a_cycle_that_stops_on_the_ground_takes_two_newtons_a_second(void)
{
    f.where.supervisor.state = FLIGHT_LANDING;
    f.where.supervisor.land = true;
    f.where.contact.gave_up = true;
    f.est.airborne = false;
    f.thrust_n = 5.0F;
    f.laws.transfer_n = 0.3F;
    f.mode = FLIGHT_MODE_EST_LAND;
    f.arming.armed = true;
    in.now_us = 100000U;
    in.height_valid = false;
    flight_step(&f, &parameters, &in, &out);
    NEAR(4.8F, out.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.laws.transfer_n);
    TEST_ASSERT_EQUAL_UINT16(1U, f.est.actuator.count); /* recorded */
    NEAR(0.0F, f.est.actuator.coming[0].thrust_n - 4.8F);
}

void test_a_law_that_goes_on_without_the_estimate_starts_near_hover(void)
{
    for (int lost = 0; lost < 2; lost++) {
        setUp();
        f.mode = FLIGHT_MODE_LAW;
        f.thrust_n = 9.0F;
        f.est.estimator.initialised = lost == 0;
        transfer(FLIGHT_MODE_EST_HOLD, true);
        NEAR((lost != 0) ? 0.5F : 2.0F, f.laws.transfer_n);
    }
}
