/* The functions that flight_step() is made of, each on a state that is written down: which inputs, limits and
 * modes it passes on. They are looked at from inside, so this file includes the source. How it flies:
 * test_flight.c, est/test_est_law.c. */
#include "control/flight.c"
#include "unity.h"

#include <string.h>

#define GRAV_N 7.0F
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, expected, actual)

static flight_t f;
static parameters_t parameters;
static flight_inputs_t in;
static flight_outputs_t out;

static void set(parameter_id_t id, float value)
{
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, id, value));
}

/* FLYING with law EST at 0.5 m, all sensors fresh, cycles of 100 ms; hover thrust 7 N. */
void setUp(void)
{
    parameters_init(&parameters);
    flight_init(&f);
    est_law_predict(&f.est, &parameters, NULL, 0U, 0U);
    est_law_reset(&f.est, &parameters);
    f.est.estimator.initialised = f.est.estimator.has_frames = f.est.estimator.felt = true;
    f.est.estimator.confirmed = true;
    f.est.estimator.now.height_m = f.est.estimator.delayed.height_m = 0.5F;
    f.est.airborne = true;
    f.supervisor.state = FLIGHT_FLYING;
    f.supervisor.started = true;
    f.supervisor.step_us = 100000U;
    f.supervisor.height.height_mm = 500.0F;
    f.supervisor.height.sequence = 5U;
    f.supervisor.reference_m = 0.6F;
    f.mode = FLIGHT_MODE_EST_HOLD;
    f.active_law = LAW_EST;
    f.hover_n = f.thrust_n = f.setpoint_n = GRAV_N;
    f.hover_learned = true;
    f.learned_s = 2.5F;
    f.est.actuator.thrust_n = GRAV_N;
    in = (flight_inputs_t){.attitude_ready = true, .has_throttle = true};
    memset(&out, 0, sizeof out);
    f.evidence = (evidence_t){.teaches = true, .calm = true, .upright = 1.0F, .shaken = 1.0F};
}

void tearDown(void) {}

static void sway(bool sways)
{
    f.evidence.sways = f.evidence.rocks = sways;
    f.evidence.calm = !sways;
}

static void feel(float felt_mps)
{
    f.evidence.felt_mps = felt_mps;
    f.evidence.felt_valid = true;
}

static void lose_the_estimate(void)
{
    f.est.estimator.initialised = false;
}

void test_it_begins_with_nothing_known(void)
{
    supervisor_t supervisor;
    supervisor_init(&supervisor);
    memset(&f, 0x55, sizeof f);
    flight_init(&f);
    TEST_ASSERT_EQUAL(supervisor.state, f.supervisor.state);
    TEST_ASSERT_EQUAL(supervisor.kept_state, f.supervisor.kept_state);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, f.sense.senses.accelerometer.shaken);
    TEST_ASSERT_EQUAL(IMU_SOUND, f.axes.fault);
    TEST_ASSERT_EQUAL_FLOAT(0.4F, f.est.estimator.noise_mps2);
    TEST_ASSERT_EQUAL(FLIGHT_MODE_IDLE, f.mode);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.hover_n + f.thrust_n + f.transfer_n + f.learned_s);
}

/* ---- sure hover thrust */

void test_the_sure_hover_thrust_follows_the_estimated_one_slowly(void)
{
    static const struct {
        float learned_s, hover_n, then_s;
    } rows[] = {{1.0F, 7.04F, 1.1F},
                {0.59F, 7.4F, 0.69F},
                {0.61F, 7.0656F, 0.71F},
                {2.5F, 7.016F, 2.5F},
                {0.0F, 7.4F, 0.1F}};
    for (int i = 0; i < 5; i++) {
        setUp();
        f.est.hover.thrust_n = 7.4F;
        f.learned_s = rows[i].learned_s;
        follow_hover(&f);
        TEST_ASSERT_FLOAT_WITHIN(2.0e-4F, rows[i].hover_n, f.hover_n);
        NEAR(rows[i].then_s, f.learned_s);
    }
    setUp(); /* a pause counts as half a second */
    f.est.hover.thrust_n = 7.4F;
    f.supervisor.step_us = 5000000U;
    follow_hover(&f);
    NEAR(7.08F, f.hover_n);
}

void test_without_an_estimate_it_is_a_mean_of_the_thrust_in_flight(void)
{
    static const struct {
        flight_state_t state;
        flight_mode_t mode;
        bool throttle_unknown, airborne, follows;
    } rows[] = {{FLIGHT_FLYING, FLIGHT_MODE_LAW, false, true, true},
                {FLIGHT_TAKEOFF, FLIGHT_MODE_LAW, false, true, false},
                {FLIGHT_FLOATING, FLIGHT_MODE_FLOAT, false, true, true},
                {FLIGHT_FLOATING, FLIGHT_MODE_HOVER, false, true, false},
                {FLIGHT_FLOATING, FLIGHT_MODE_FLOAT, true, true, false}};
    for (int i = 0; i < 5; i++) {
        setUp();
        lose_the_estimate();
        f.est.hover.thrust_n = 6.0F;
        f.thrust_n = 7.5F;
        f.supervisor.state = rows[i].state;
        f.mode = rows[i].mode;
        f.throttle_unknown = rows[i].throttle_unknown;
        follow_hover(&f);
        NEAR(rows[i].follows ? 7.02F : 7.0F, f.hover_n);
    }
    setUp();
    f.est.airborne = false; /* an estimate of a vehicle on the ground is none */
    f.thrust_n = 7.5F;
    follow_hover(&f);
    NEAR(7.02F, f.hover_n);
}

void test_heights_that_may_be_of_a_blocked_beam_teach_nothing_but_at_first(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        f.est.hover.thrust_n = 7.4F;
        f.evidence.teaches = i == 2;
        f.learned_s = (i == 3) ? 0.0F : 1.0F;
        follow_hover(&f);
        NEAR((i < 2) ? 7.0F : (i == 2) ? 7.04F : 7.4F, f.hover_n);
    }
}

void test_what_the_flight_has_learned_is_given_up_on_the_ground(void)
{
    static const struct {
        flight_state_t state;
        bool learned, lifting;
        float hover_n;
    } rows[] = {{FLIGHT_GROUND, true, false, 7.0F},     {FLIGHT_FLYING, true, false, 7.6F},
                {FLIGHT_FLYING, true, true, 7.0F},      {FLIGHT_TAKEOFF, false, false, 7.6F},
                {FLIGHT_FLOATING, true, false, 7.6F},   {FLIGHT_DESCENDING, false, false, 7.0F},
                {FLIGHT_DESCENDING, true, false, 7.6F}, {FLIGHT_DESCENDING, true, true, 7.6F},
                {FLIGHT_FLOATING, false, false, 7.6F}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        f.supervisor.state = rows[i].state;
        f.hover_learned = rows[i].learned;
        f.lifting = rows[i].lifting;
        f.hover_n = f.est.hover.thrust_n = 7.6F;
        update_hover(&f, GRAV_N);
        NEAR(rows[i].hover_n, f.hover_n);
        if (rows[i].hover_n < 7.5F) {
            TEST_ASSERT_EQUAL_FLOAT(0.0F, f.learned_s);
        }
        NEAR(rows[i].hover_n, f.est.sure_hover_n);
    }
}

void test_nothing_is_learned_without_sight_or_in_doubt(void)
{
    for (int why = 0; why < 5; why++) {
        setUp();
        f.est.hover.thrust_n = 7.4F;
        f.supervisor.flags = (why == 1) ? FLIGHT_FLAG_HEIGHT : 0U;
        f.evidence.doubts = (uint16_t)((why == 2)   ? DOUBT_SIGHT
                                       : (why == 3) ? DOUBT_THRUST
                                       : (why == 4) ? DOUBT_IMU
                                                    : 0U);
        update_hover(&f, GRAV_N);
        NEAR((why == 0 || why == 4) ? 7.016F : 7.0F, f.hover_n);
    }
}

void test_the_sure_hover_thrust_stays_within_one_and_a_half_newton_of_gravity(void)
{
    f.hover_n = f.est.hover.thrust_n = 9.0F;
    update_hover(&f, GRAV_N);
    NEAR(8.5F, f.hover_n);
    f.hover_n = f.est.hover.thrust_n = 5.0F;
    update_hover(&f, GRAV_N);
    NEAR(5.5F, f.hover_n);
    f.hover_n = f.est.hover.thrust_n = -1.0F;
    update_hover(&f, 0.5F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.hover_n);
    f.hover_n = f.est.hover.thrust_n = 13.0F;
    update_hover(&f, 11.5F);
    TEST_ASSERT_EQUAL_FLOAT(THRUST_MAX_N, f.hover_n);
}

void test_a_descent_keeps_the_hover_thrust_of_its_entry(void)
{
    static const flight_state_t states[] = {FLIGHT_DESCENDING, FLIGHT_LANDING, FLIGHT_LOWERING,
                                            FLIGHT_COASTING};
    for (int i = 0; i < 4; i++) {
        setUp();
        f.supervisor.state = states[i];
        f.est.entry_hover_n = 6.0F;
        f.hover_n = 7.2F;
        update_hover(&f, GRAV_N);
        NEAR((i < 3) ? 6.0F : 7.2F, f.est.entry_hover_n);
    }
}

/* ---- changes of the mode */

static void spoil_laws(void)
{
    f.pid = (pid_state_t){.integral_n = 0.5F, .primed = true};
    f.pidt = (pidt_state_t){.integral_n = 0.5F, .primed = true};
}

void test_a_law_resumes_with_its_integral_and_others_forget_it_but_in_coasting(void)
{
    spoil_laws();
    f.hover_n = 7.3F;
    change_mode(&f, FLIGHT_MODE_HOVER, FLIGHT_MODE_LAW, GRAV_N);
    NEAR(0.5F, f.pid.integral_n);
    NEAR(0.5F, f.pidt.integral_n);
    TEST_ASSERT_FALSE(f.pid.primed || f.pidt.primed);
    change_mode(&f, FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_LAW, GRAV_N);
    NEAR(0.3F, f.pidt.integral_n); /* what law EST has found */
    f.supervisor.state = FLIGHT_TAKEOFF;
    f.pidt.integral_n = 0.5F;
    change_mode(&f, FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_LAW, GRAV_N);
    NEAR(0.5F, f.pidt.integral_n);
    spoil_laws();
    f.supervisor.state = FLIGHT_COASTING;
    change_mode(&f, FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, GRAV_N);
    NEAR(0.5F, f.pid.integral_n);
    NEAR(0.5F, f.pidt.integral_n);
    f.supervisor.state = FLIGHT_FLOATING;
    change_mode(&f, FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, GRAV_N);
    NEAR(0.0F, f.pid.integral_n);
    NEAR(0.0F, f.pidt.integral_n);
    spoil_laws();
    f.supervisor.state = FLIGHT_COASTING;
    change_mode(&f, FLIGHT_MODE_LAW, FLIGHT_MODE_FLOAT, GRAV_N);
    NEAR(0.5F, f.pid.integral_n);
    NEAR(0.0F, f.pidt.integral_n);
}

void test_a_descent_starts_from_the_measured_rate_and_leaves_its_trim(void)
{
    f.supervisor.height.rate_mm_s = -150.0F;
    f.descent.trim_n = 0.4F;
    change_mode(&f, FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_DESCENT, GRAV_N);
    NEAR(150.0F, f.descent.sink_mm_s);
    NEAR(0.0F, f.descent.trim_n);
    NEAR(7.0F, f.hover_n);
    f.descent.trim_n = 0.4F;
    change_mode(&f, FLIGHT_MODE_DESCENT, FLIGHT_MODE_BLIND_DESCENT, GRAV_N);
    NEAR(7.4F, f.hover_n);
    f.descent.sink_mm_s = 77.0F;
    change_mode(&f, FLIGHT_MODE_LAW, FLIGHT_MODE_EST_LAND, GRAV_N);
    NEAR(77.0F, f.descent.sink_mm_s);
}

void test_law_est_is_engaged_where_it_takes_over_in_the_air(void)
{
    static const struct {
        flight_mode_t before, now;
        flight_state_t state;
        bool lifting, engaged;
    } rows[] = {{FLIGHT_MODE_LAW, FLIGHT_MODE_EST_HOLD, FLIGHT_FLYING, false, true},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_EST_LAND, FLIGHT_LANDING, false, true},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_EST_SINK, FLIGHT_DESCENDING, false, true},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_EST_HOLD, FLIGHT_FLYING, true, false},
                {FLIGHT_MODE_IDLE, FLIGHT_MODE_EST_HOLD, FLIGHT_TAKEOFF, false, false},
                {FLIGHT_MODE_IDLE, FLIGHT_MODE_EST_SINK, FLIGHT_DESCENDING, false, true},
                {FLIGHT_MODE_EST_LAND, FLIGHT_MODE_EST_HOLD, FLIGHT_FLYING, false, false},
                {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_SINK, FLIGHT_DESCENDING, false, false},
                {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_LAW, FLIGHT_FLYING, false, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        f.est.airborne = false;
        f.supervisor.state = rows[i].state;
        f.lifting = rows[i].lifting;
        f.thrust_n = 6.6F;
        f.hover_n = 7.2F;
        change_mode(&f, rows[i].before, rows[i].now, GRAV_N);
        TEST_ASSERT_EQUAL(rows[i].engaged, f.est.airborne);
        if (rows[i].engaged) {
            NEAR(6.6F, f.est.cascade.thrust_n);
            NEAR(7.2F, f.est.hover.thrust_n);
        }
    }
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
        f.transfer_n = 0.3F;
        bumpless_transfer(&f, rows[i].before, rows[i].law_changed);
        NEAR(rows[i].transfer_n, f.transfer_n);
    }
    for (int lifting = 0; lifting < 2; lifting++) {
        setUp();
        f.mode = FLIGHT_MODE_EST_HOLD;
        f.thrust_n = 6.8F;
        f.lifting = lifting != 0;
        bumpless_transfer(&f, FLIGHT_MODE_HOVER, false);
        NEAR((lifting != 0) ? 0.0F : -0.2F, f.transfer_n);
    }
}

/* Else the armed idle would go on for a second after a disarming. */
void test_a_change_of_the_law_on_the_ground_adds_nothing_to_the_idle(void)
{
    f.mode = FLIGHT_MODE_IDLE;
    f.thrust_n = 1.8F;
    f.setpoint_n = 0.0F;
    f.transfer_n = 0.3F;
    bumpless_transfer(&f, FLIGHT_MODE_IDLE, true);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.transfer_n);
}

/* ---- the laws */

void test_the_seeds_law_gets_its_gains_and_the_error(void)
{
    for (int integral = 0; integral < 2; integral++) {
        setUp();
        set(PARAMETER_KP, 0.02F);
        set(PARAMETER_KD, 0.005F);
        set(PARAMETER_KI, 0.03F);
        set(PARAMETER_USAT, 2.5F);
        set(PARAMETER_DSAT, 1.5F);
        f.active_law = (integral != 0) ? LAW_PID : LAW_PD;
        f.pid = (pid_state_t){.integral_n = 0.1F, .last_error_mm = 80.0F, .primed = true};
        pid_state_t pid = f.pid;
        const pid_gains_t gains = {0.02F, 0.005F, (integral != 0) ? 0.03F : 0.0F, 7.0F, 2.5F, 1.5F};
        const float expected_n = pid_step(&pid, &gains, 100.0F);
        TEST_ASSERT_EQUAL(integral != 0, step_pid(&f, &parameters)); /* the integral has come */
        NEAR(expected_n, f.setpoint_n);
        NEAR(pid.integral_n, f.pid.integral_n);
        TEST_ASSERT_FALSE(step_pid(&f, &parameters));
    }
}

void test_with_release_scan_a_sample_needs_a_new_height_or_is_the_first(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        set(PARAMETER_RELEASE, (i == 3) ? (float)RELEASE_FREE : (float)RELEASE_SCAN);
        f.active_law = LAW_PID;
        f.pid.primed = i != 2;
        f.pid.last_error_mm = 50.0F;
        f.supervisor.height.is_new = i == 1;
        (void)step_pid(&f, &parameters);
        TEST_ASSERT_EQUAL_FLOAT((i == 0) ? 50.0F : 100.0F, f.pid.last_error_mm);
    }
}

void test_pidt_gets_its_gains_the_time_between_rays_and_a_window_about_gravity(void)
{
    set(PARAMETER_LAW, (float)LAW_PIDT);
    set(PARAMETER_PKP, 4.0F);
    set(PARAMETER_PKI, 1.0F);
    set(PARAMETER_PKD, 3.0F);
    f.pidt = (pidt_state_t){.integral_n = 0.2F, .height_m = 0.49F, .rate_mps = 0.05F, .primed = true};
    f.pidt_rays_us = 1000000U;
    f.est.rays_us = 1120000U;
    f.supervisor.height.is_new = true;
    pidt_state_t pidt = f.pidt;
    const pidt_gains_t gains = {4.0F, 1.0F, 3.0F, 7.0F, 10.0F, 4.0F};
    const float expected_n = pidt_step(&pidt, &gains, 0.6F, 0.5F, 0.12F);
    step_pidt(&f, &parameters, 0.6F);
    NEAR(expected_n, f.setpoint_n);
    NEAR(pidt.integral_n, f.pidt.integral_n);
    NEAR(pidt.rate_mps, f.pidt.rate_mps);
    TEST_ASSERT_EQUAL_UINT32(1120000U, f.pidt_rays_us);
    f.supervisor.height.age_us = 80000U;
    f.setpoint_n = 1.0F;
    f.supervisor.height.is_new = false;
    step_pidt(&f, &parameters, 0.6F);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, f.setpoint_n);
    set(PARAMETER_PKP, 50.0F);
    f.pidt.primed = false;
    step_pidt(&f, &parameters, 3.0F);
    NEAR(10.0F, f.setpoint_n);
    f.pidt.primed = false;
    step_pidt(&f, &parameters, -3.0F);
    NEAR(4.0F, f.setpoint_n);
    set(PARAMETER_GRAV, 2.0F);
    f.pidt.primed = false;
    step_pidt(&f, &parameters, -3.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.setpoint_n);
    set(PARAMETER_GRAV, 9.0F);
    f.pidt.primed = false;
    step_pidt(&f, &parameters, 3.0F);
    NEAR(THRUST_MAX_N, f.setpoint_n);
}

void test_in_place_of_est_pidt_has_0_65_of_its_gains(void)
{
    set(PARAMETER_LAW, (float)LAW_EST);
    set(PARAMETER_PKP, 4.0F);
    set(PARAMETER_PKI, 1.0F);
    set(PARAMETER_PKD, 3.0F);
    f.pidt = (pidt_state_t){.integral_n = 0.2F, .height_m = 0.49F, .rate_mps = 0.05F, .primed = true};
    f.est.rays_us = 120000U;
    f.supervisor.height.is_new = true;
    pidt_state_t pidt = f.pidt;
    const pidt_gains_t gains = {2.6F, 0.65F, 1.95F, 7.0F, 10.0F, 4.0F};
    const float expected_n = pidt_step(&pidt, &gains, 0.6F, 0.5F, 0.12F);
    step_pidt(&f, &parameters, 0.6F);
    NEAR(expected_n, f.setpoint_n);
    NEAR(pidt.integral_n, f.pidt.integral_n);
}

void test_an_estimate_that_no_height_has_checked_coasts_near_the_hover_thrust(void)
{
    f.hover_n = 7.2F;
    for (int i = 0; i < 3; i++) {
        f.supervisor.state = (i == 1) ? FLIGHT_FLYING : FLIGHT_COASTING;
        f.est.estimator.unchecked_count = (uint16_t)((i == 2) ? 0 : 1);
        NEAR((i == 0) ? 7.7F : 9.0F, within_coasting_n(&f, 9.0F));
        NEAR((i == 0) ? 6.2F : 5.0F, within_coasting_n(&f, 5.0F));
        NEAR(7.5F, within_coasting_n(&f, 7.5F));
    }
}

void test_a_long_gap_of_rays_counts_as_300_ms(void)
{
    float setpoint_n[2];
    for (uint32_t i = 0U; i < 2U; i++) {
        setUp();
        f.pidt = (pidt_state_t){.height_m = 0.4F, .primed = true};
        f.est.rays_us = 300000U + 500000U * i;
        f.supervisor.height.is_new = true;
        step_pidt(&f, &parameters, 0.6F);
        setpoint_n[i] = f.setpoint_n;
    }
    NEAR(setpoint_n[0], setpoint_n[1]);
}

void test_a_descent_by_heights_samples_new_heights_and_its_start(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        f.supervisor.height.is_new = i == 1;
        f.supervisor.height.gap_us = 100000U;
        f.supervisor.height.rate_mm_s = -100.0F;
        f.hover_n = 7.3F;
        f.setpoint_n = 1.0F;
        descent_t expected = f.descent;
        const float expected_n = descent_step(&expected, 7.3F, 500.0F, -100.0F, (i == 1) ? 0.1F : 0.0F);
        step_descent(&f, i == 2);
        NEAR((i == 0) ? 1.0F : expected_n, f.setpoint_n);
    }
    f.supervisor.height.is_new = true;
    f.supervisor.height.gap_us = 5000000U;
    f.descent.sink_mm_s = 0.0F;
    step_descent(&f, false);
    NEAR(90.0F, f.descent.sink_mm_s); /* 300 mm/s2, of 0.3 s at most */
}

/* A wrong pin: what the output adds, from heights that sink by 0.1 m/s. */
void test_what_is_added_while_the_pin_says_pilot_depends_on_time_order_and_heights(void)
{
    static const struct {
        uint16_t flags;
        float piloted_s;
        bool land;
        uint32_t age_us;
        bool is_new;
        float added_n;
    } rows[] = {
        {0U, 3.0F, true, 0U, true, 0.0F},
        {FLIGHT_FLAG_PILOT, 1.0F, false, 0U, true, 0.0959F}, /* 0.03 m/s, for one height */
        {FLIGHT_FLAG_PILOT, 1.0F, true, 0U, true, -0.8359F}, /* the whole rate at once, 0.275 at 0.5 m */
        {FLIGHT_FLAG_PILOT, 5.0F, false, 0U, true, -0.8359F},
        {FLIGHT_FLAG_PILOT, 5.0F, false, 0U, false, -0.2F}, /* as before */
        {FLIGHT_FLAG_PILOT, 1.0F, false, 2000000U, false, 0.0F},
        {FLIGHT_FLAG_PILOT, 1.0F, true, 2000000U, false, -0.527F}, /* 7.3 % and the fade of 2 s */
        {FLIGHT_FLAG_PILOT, 9.0F, false, 60000000U, false, -2.0F},
    };
    for (int i = 0; i < 8; i++) {
        setUp();
        f.supervisor.state = FLIGHT_FLOATING;
        f.supervisor.flags = rows[i].flags;
        f.supervisor.land = rows[i].land;
        f.supervisor.height = (height_track_t){.height_mm = 500.0F,
                                               .rate_mm_s = -100.0F,
                                               .gap_us = 100000U,
                                               .age_us = rows[i].age_us,
                                               .is_new = rows[i].is_new};
        f.descent.sink_mm_s = 300.0F;
        f.piloted_s = rows[i].piloted_s;
        f.stuck_pin_n = -0.2F;
        step_stuck_pin(&f);
        TEST_ASSERT_FLOAT_WITHIN(0.005F, rows[i].added_n, f.stuck_pin_n);
        NEAR((rows[i].flags != 0U) ? rows[i].piloted_s + 0.1F : 0.0F, f.piloted_s);
        NEAR(7.0F, f.hover_n);
    }
}

void test_what_is_added_is_limited_and_ends_with_the_pilots_turn(void)
{
    static const struct {
        float rate_mm_s, near_ground_s, idle_n, added_n;
    } rows[] = {{-800.0F, 0.0F, 0.0F, 1.0F},
                {1500.0F, 0.0F, 0.0F, -2.0F},
                {0.0F, 4.0F, 0.0F, -7.0F}, /* lies on the ground */
                {0.0F, 4.0F, 0.6F, -6.4F}};
    for (int i = 0; i < 4; i++) {
        setUp();
        f.supervisor.flags = FLIGHT_FLAG_PILOT;
        f.supervisor.height = (height_track_t){
            .height_mm = 30.0F, .rate_mm_s = rows[i].rate_mm_s, .gap_us = 100000U, .is_new = true};
        f.supervisor.height.height_mm = (rows[i].near_ground_s > 0.0F) ? 30.0F : 500.0F;
        f.descent.near_ground_s = rows[i].near_ground_s;
        f.idle_n = rows[i].idle_n;
        f.piloted_s = 6.0F;
        step_stuck_pin(&f);
        NEAR(rows[i].added_n, f.stuck_pin_n);
        write_outputs(&f, &parameters, &out);
        NEAR(7.0F + rows[i].added_n, out.thrust_n);
        NEAR(thrust_to_pulse_us(7.0F + rows[i].added_n), out.pulse_us);
        change_mode(&f, FLIGHT_MODE_HOVER, FLIGHT_MODE_EST_HOLD, GRAV_N);
        NEAR(0.0F, f.stuck_pin_n + f.piloted_s);
    }
}

/* The present height is 0.5 m; the cycle takes 0.1 s. */
void test_floating_without_a_pin_adds_thrust_while_it_is_too_low_until_the_effect_shows(void)
{
    static const struct {
        float floating_m, before_n;
        bool felt, shown, est;
        float added_n;
    } rows[] = {{0.55F, 0.1F, true, false, true, 0.14F}, {0.55F, 0.38F, true, false, true, 0.4F},
                {0.45F, 0.1F, true, false, true, 0.06F}, {0.45F, 0.02F, true, false, true, 0.0F},
                {0.55F, 0.1F, false, false, true, 0.0F}, {0.55F, 0.1F, true, true, true, 0.0F},
                {0.55F, 0.1F, true, false, false, 0.0F}};
    for (int i = 0; i < 7; i++) {
        setUp();
        f.supervisor.state = FLIGHT_FLOATING;
        f.throttle_unknown = true;
        f.mode = rows[i].est ? FLIGHT_MODE_EST_HOLD : FLIGHT_MODE_FLOAT;
        f.floating_m = rows[i].floating_m;
        f.float_trim_n = rows[i].before_n;
        f.est.estimator.felt = rows[i].felt;
        f.effect.has_effect = rows[i].shown;
        NEAR(6.8F + rows[i].added_n, within_power_n(&f, 6.8F));
        NEAR(rows[i].added_n, f.float_trim_n);
        NEAR(7.0F, f.hover_n);
    }
    setUp(); /* the limit of all of it */
    f.throttle_unknown = true;
    f.float_trim_n = 0.4F;
    f.floating_m = 0.6F;
    NEAR(9.0F, within_power_n(&f, 8.9F));
}

void test_a_pilots_next_turn_begins_without_what_was_added(void)
{
    for (int i = 0; i < 2; i++) {
        setUp();
        set(PARAMETER_SEL, SEL_NONE);
        f.supervisor.state = FLIGHT_FLOATING;
        f.throttle_unknown = i == 1;
        f.float_trim_n = 0.3F;
        update_throttle_unknown(&f, &parameters, true);
        TEST_ASSERT_TRUE(f.throttle_unknown);
        NEAR((i == 1) ? 0.3F : 0.0F, f.float_trim_n);
    }
}

void test_the_cycles_follow_the_frames_while_a_pilot_flies(void)
{
    set(PARAMETER_LAW, LAW_PID);
    f.mode = FLIGHT_MODE_HOVER;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_PERIOD, flight_releases(&f, &parameters));
    f.piloted_s = 0.1F; /* the pin is read in each of them */
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME, flight_releases(&f, &parameters));
}

void test_the_tilt_of_a_silent_imu_does_not_rock(void)
{
    sway(true);
    TEST_ASSERT_TRUE(rocks(&f));
    step_descent(&f, false);
    TEST_ASSERT_TRUE(f.descent.rocks);
    f.est.frameless_s = 1.0F;
    TEST_ASSERT_FALSE(rocks(&f));
    f.est.frameless_s = 0.0F;
    sway(false);
    TEST_ASSERT_FALSE(rocks(&f));
}

void test_a_hover_thrust_learned_in_this_flight_is_not_learned_anew_after_another_law(void)
{
    for (int i = 0; i < 2; i++) {
        setUp();
        f.est.airborne = i == 1;
        f.est.hover.thrust_n = 7.4F;
        f.est.hover.variance_n2 = 0.01F;
        f.hover_n = 6.9F;
        change_mode(&f, FLIGHT_MODE_LAW, FLIGHT_MODE_EST_HOLD, 7.0F);
        NEAR((i == 1) ? 7.4F : 6.9F, f.est.hover.thrust_n);
        NEAR((i == 1) ? 0.01F : 0.25F, f.est.hover.variance_n2);
    }
}

void test_pidt_holds_no_push_while_heights_are_late(void)
{
    f.pidt.primed = true;
    f.hover_n = 7.2F;
    f.setpoint_n = 9.0F;
    f.supervisor.height.age_us = 170000U;
    step_pidt(&f, &parameters, 0.6F);
    NEAR(9.0F, f.setpoint_n);
    f.supervisor.height.age_us = 170001U;
    step_pidt(&f, &parameters, 0.6F);
    NEAR(7.7F, f.setpoint_n);
    f.setpoint_n = 4.0F;
    step_pidt(&f, &parameters, 0.6F);
    NEAR(6.7F, f.setpoint_n);
}

void test_each_mode_has_its_thrust(void)
{
    f.mode = FLIGHT_MODE_IDLE;
    TEST_ASSERT_FALSE(run_mode(&f, &parameters, false));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.setpoint_n);
    f.mode = FLIGHT_MODE_HOVER;
    f.hover_n = 7.2F;
    TEST_ASSERT_FALSE(run_mode(&f, &parameters, false));
    NEAR(7.2F, f.setpoint_n);
    f.mode = FLIGHT_MODE_BLIND_DESCENT;
    sway(true);
    f.supervisor.state_us = 5000000U;
    TEST_ASSERT_FALSE(run_mode(&f, &parameters, false));
    NEAR(descent_blind(7.2F, 5.0F), f.setpoint_n);
    f.hover_n = 100.0F; /* so that a minute leaves something */
    f.supervisor.state_us = 90000000U;
    (void)run_mode(&f, &parameters, false);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, descent_blind(100.0F, 60.0F), f.setpoint_n);
    f.hover_n = 7.2F;
    f.mode = FLIGHT_MODE_LAW;
    f.active_law = LAW_PID;
    TEST_ASSERT_TRUE(run_mode(&f, &parameters, false));
    TEST_ASSERT_TRUE(f.pid.primed);
    f.active_law = LAW_PIDT;
    TEST_ASSERT_FALSE(run_mode(&f, &parameters, false));
    TEST_ASSERT_TRUE(f.pidt.primed);
    f.pidt.primed = false;
    f.mode = FLIGHT_MODE_FLOAT;
    f.supervisor.state = FLIGHT_FLOATING;
    f.floating_m = 0.5F;
    (void)run_mode(&f, &parameters, false);
    NEAR(7.0F, f.setpoint_n); /* it is at the height that it holds */
    f.mode = FLIGHT_MODE_DESCENT;
    f.setpoint_n = -1.0F;
    (void)run_mode(&f, &parameters, false);
    TEST_ASSERT_EQUAL_FLOAT(-1.0F, f.setpoint_n);
    (void)run_mode(&f, &parameters, true);
    TEST_ASSERT_TRUE(f.setpoint_n > 3.0F);
}

void test_law_est_is_asked_to_hold_to_land_or_to_sink(void)
{
    static const flight_mode_t modes[] = {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_LAND, FLIGHT_MODE_EST_SINK};
    static const est_mode_t asked[] = {EST_MODE_HOLD, EST_MODE_LAND, EST_MODE_SINK};
    for (int i = 0; i < 3; i++) {
        setUp();
        f.mode = modes[i];
        f.est.step_s = 0.1F;
        est_law_t expected = f.est;
        const float expected_n = est_law_step(&expected, &parameters, asked[i], 0.6F);
        TEST_ASSERT_FALSE(run_mode(&f, &parameters, false));
        NEAR(expected_n, f.setpoint_n);
    }
}

/* ---- where it is */

void test_a_wanted_height_is_there_while_one_is_held(void)
{
    for (int state = 0; state < (int)FLIGHT_STATE_COUNT; state++) {
        setUp();
        f.supervisor.state = (flight_state_t)state;
        f.floating_m = 0.8F;
        const bool holds = state == FLIGHT_TAKEOFF || state == FLIGHT_FLYING || state == FLIGHT_LOWERING;
        if (state == FLIGHT_FLOATING) {
            NEAR(0.3F, wanted_m(&f));
            f.mode = FLIGHT_MODE_HOVER;
            TEST_ASSERT_TRUE(isnan(wanted_m(&f)));
        } else if (holds) {
            NEAR(0.1F, wanted_m(&f));
        } else {
            TEST_ASSERT_TRUE(isnan(wanted_m(&f)));
        }
    }
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
                {FLIGHT_LANDING, true, false, true, 80.0F, true},
                {FLIGHT_LANDING, true, false, true, 79.9F, false},
                {FLIGHT_LANDING, true, false, false, 500.0F, false},
                {FLIGHT_COASTING, true, false, true, 0.0F, true},
                {FLIGHT_COASTING, true, false, false, 500.0F, false},
                {FLIGHT_DESCENDING, true, false, true, 0.0F, true}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        f.supervisor.state = rows[i].state;
        f.est.airborne = rows[i].airborne;
        f.lifting = rows[i].lifting;
        f.supervisor.height.height_mm = rows[i].height_mm;
        in.has_throttle = rows[i].has_throttle;
        TEST_ASSERT_EQUAL(rows[i].off_ground, is_off_ground(&f, &in));
    }
    f.supervisor.state = FLIGHT_FLOATING;
    f.mode = FLIGHT_MODE_HOVER;
    TEST_ASSERT_FALSE(is_off_ground(&f, &in));
}

void test_the_flight_is_described_to_the_consistency_check(void)
{
    in.now_us = 700000U;
    in.reference_sequence = 3U;
    f.supervisor.now_us = 600000U;
    f.supervisor.reference_sequence = 3U;
    f.hover_n = 7.2F;
    f.thrust_n = 7.9F;
    f.est.deadband.band_n = 0.2F;
    f.est.estimator.noise_mps2 = 0.7F;
    situation_t flown = describe(&f, &parameters, &in);
    NEAR(0.1F, flown.step_s);
    TEST_ASSERT_FALSE(flown.grounded || flown.standing || flown.ordered);
    TEST_ASSERT_TRUE(flown.off_ground && flown.ours);
    NEAR(deadband_effect(&f.est.deadband, 7.2F, 7.9F), flown.thrust_n);
    NEAR(7.2F, flown.hover_n);
    NEAR(est_law_vehicle(&f.est, &parameters).authority_mps2_per_n, flown.authority_mps2_per_n);
    NEAR(2.5F, flown.damping_per_s);
    NEAR(0.1F, flown.wanted_m);
    NEAR(0.7F, flown.noise_mps2);
    in.now_us += 5000000U;
    in.reference_sequence = 4U;
    in.has_throttle = false;
    f.supervisor.state = FLIGHT_GROUND;
    flown = describe(&f, &parameters, &in);
    NEAR(0.5F, flown.step_s);
    TEST_ASSERT_TRUE(flown.grounded && flown.ordered);
    TEST_ASSERT_FALSE(flown.ours);
    f.supervisor.started = false;
    f.supervisor.state = FLIGHT_TAKEOFF;
    f.lifting = true;
    flown = describe(&f, &parameters, &in);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, flown.step_s);
    TEST_ASSERT_TRUE(flown.standing);
}

void test_it_has_risen_and_may_stand_by_heights_above_the_ground(void)
{
    f.est.ground_m = 0.1F;
    f.supervisor.height.height_mm = 181.0F;
    TEST_ASSERT_TRUE(has_risen(&f));
    f.supervisor.height.height_mm = 179.0F;
    TEST_ASSERT_FALSE(has_risen(&f));
    TEST_ASSERT_FALSE(may_stand(&f)); /* flying */
    f.lifting = true;
    TEST_ASSERT_FALSE(may_stand(&f)); /* and airborne */
    f.est.airborne = false;
    TEST_ASSERT_TRUE(may_stand(&f));
    f.supervisor.state = FLIGHT_FLOATING;
    TEST_ASSERT_TRUE(may_stand(&f));
    sway(true);
    TEST_ASSERT_FALSE(may_stand(&f));
    sway(false);
    f.supervisor.height.height_mm = 181.0F;
    TEST_ASSERT_FALSE(may_stand(&f));
}

void test_it_flies_by_the_heights_or_by_a_felt_climb(void)
{
    static const struct {
        flight_state_t state;
        bool lifting;
        float height_mm, felt_mps, shaken;
        bool flies;
    } rows[] = {
        {FLIGHT_FLYING, false, 0.0F, 0.0F, 1.0F, true},    {FLIGHT_FLYING, true, 0.0F, 0.0F, 1.0F, false},
        {FLIGHT_FLYING, true, 81.0F, 0.0F, 1.0F, true},    {FLIGHT_FLYING, true, 0.0F, 0.26F, 1.0F, true},
        {FLIGHT_FLYING, true, 0.0F, 0.25F, 1.0F, false},   {FLIGHT_TAKEOFF, true, 0.0F, 0.26F, 1.0F, true},
        {FLIGHT_TAKEOFF, false, 81.0F, 0.0F, 1.0F, false}, {FLIGHT_FLYING, true, 0.0F, 0.49F, 2.0F, false},
        {FLIGHT_FLYING, true, 0.0F, 0.51F, 2.0F, true},    {FLIGHT_LANDING, false, 81.0F, 0.5F, 1.0F, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        f.est.ground_m = 0.0F;
        f.supervisor.state = rows[i].state;
        f.lifting = rows[i].lifting;
        f.supervisor.height.height_mm = rows[i].height_mm;
        f.evidence.felt_mps = rows[i].felt_mps;
        f.evidence.shaken = rows[i].shaken;
        TEST_ASSERT_EQUAL(rows[i].flies, flies(&f));
    }
}

void test_a_take_off_that_was_given_up_flies_when_a_climb_is_felt(void)
{
    static const struct {
        flight_state_t state;
        bool estimated;
        float felt_mps;
        bool flies;
    } rows[] = {{FLIGHT_LANDING, true, 0.26F, true},
                {FLIGHT_LANDING, true, 0.25F, false},
                {FLIGHT_LANDING, false, 0.26F, false},
                {FLIGHT_TAKEOFF, true, 0.26F, false}};
    for (int i = 0; i < 4; i++) {
        setUp();
        f.not_lifted = true;
        f.hover_learned = false;
        f.est.airborne = false;
        f.supervisor.state = rows[i].state;
        feel(rows[i].felt_mps);
        if (!rows[i].estimated) {
            lose_the_estimate();
        }
        update_estimator(&f, &parameters, &in);
        TEST_ASSERT_EQUAL(rows[i].flies, !f.not_lifted);
        TEST_ASSERT_EQUAL(rows[i].flies, f.hover_learned);
        TEST_ASSERT_EQUAL(rows[i].flies, f.est.airborne);
    }
}

void test_the_first_hover_thrust_of_another_law_is_newtons(void)
{
    f.est.actuator.thrust_n = 8.0F;
    f.est.lift_mps2 = 0.6F;
    f.evidence.felt_mps = 0.2F;
    f.hover_n = 6.9F;
    NEAR(8.0F - 1.1F * 7.0F / 9.80665F, lifting_n(&f, &parameters));
    f.est.actuator.thrust_n = 11.0F;
    NEAR(8.5F, lifting_n(&f, &parameters));
    f.est.actuator.thrust_n = 4.0F;
    NEAR(5.5F, lifting_n(&f, &parameters));
    f.est.estimator.felt = false;
    NEAR(6.9F, lifting_n(&f, &parameters));
    f.est.estimator.felt = true;
    lose_the_estimate();
    NEAR(6.9F, lifting_n(&f, &parameters));
}

/* ---- doubts */

void test_a_doubt_of_the_sight_corrects_the_estimate_by_the_error_found(void)
{
    f.evidence.doubts = DOUBT_SIGHT;
    f.evidence.lost_m = -0.4F;
    f.evidence.speed_mps = 0.3F;
    f.evidence.bias_mps2 = 0.15F;
    f.thrust_n = 7.7F;
    f.hover_n = 7.1F;
    change_doubts(&f, GRAV_N);
    NEAR(0.9F, f.est.estimator.now.height_m);
    NEAR(0.3F, f.est.estimator.now.speed_mps);
    NEAR(0.15F, f.est.estimator.now.bias_mps2);
    NEAR(7.1F, f.est.hover.thrust_n);
    NEAR(7.7F, f.est.cascade.thrust_n);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, f.doubts);
    f.evidence.lost_m = 0.4F;
    f.est.hover.thrust_n = 6.5F;
    change_doubts(&f, GRAV_N); /* once */
    NEAR(0.9F, f.est.estimator.now.height_m);
    NEAR(6.5F, f.est.hover.thrust_n);
}

void test_the_end_of_a_doubt_of_the_sight_starts_the_estimate_from_the_heights(void)
{
    for (int airborne = 0; airborne < 2; airborne++) {
        setUp();
        f.est.airborne = airborne != 0;
        f.doubts = DOUBT_SIGHT;
        f.evidence.height_m = 0.45F;
        f.evidence.rise_mps = -0.6F;
        f.evidence.bias_mps2 = 0.15F;
        f.est.estimator.delayed.height_m = f.est.estimator.now.height_m = 0.9F;
        f.est.estimator.delayed.speed_mps = f.est.estimator.now.speed_mps = 2.0F;
        f.est.hover.thrust_n = 6.5F;
        f.thrust_n = 4.5F;
        f.hover_n = 7.1F;
        change_doubts(&f, GRAV_N);
        NEAR((airborne != 0) ? 0.45F : 0.9F, f.est.estimator.now.height_m);
        NEAR((airborne != 0) ? -0.6F : 2.0F, f.est.estimator.now.speed_mps);
        NEAR((airborne != 0) ? 7.1F : 6.5F, f.est.hover.thrust_n);
        if (airborne != 0) {
            NEAR(0.15F, f.est.estimator.now.bias_mps2);
            NEAR(4.5F, f.est.cascade.thrust_n);
        }
        TEST_ASSERT_EQUAL_UINT16(0U, f.doubts);
    }
}

void test_a_vehicle_that_flies_unseen_is_engaged_and_one_on_the_ground_is_not(void)
{
    for (int sways = 0; sways < 2; sways++) {
        setUp();
        f.est.airborne = false;
        f.evidence.doubts = DOUBT_SIGHT;
        sway(sways != 0);
        change_doubts(&f, GRAV_N);
        TEST_ASSERT_EQUAL(sways != 0, f.est.airborne);
    }
    setUp();
    f.est.airborne = false;
    sway(true); /* and no doubt */
    f.evidence.doubts = DOUBT_THRUST;
    change_doubts(&f, GRAV_N);
    TEST_ASSERT_FALSE(f.est.airborne);
    f.evidence.doubts = 0U;
    change_doubts(&f, GRAV_N);
    TEST_ASSERT_FALSE(f.est.airborne);
}

void test_a_doubt_of_the_imu_gives_up_what_was_learned_a_short_time(void)
{
    static const struct {
        float learned_s, hover_n;
    } rows[] = {{2.5F, 7.6F}, {2.4F, 7.0F}};
    for (int i = 0; i < 2; i++) {
        setUp();
        f.hover_n = 7.6F;
        f.learned_s = rows[i].learned_s;
        f.evidence.doubts = DOUBT_IMU;
        f.evidence.height_m = 0.45F;
        f.evidence.rise_mps = -0.1F;
        f.est.estimator.now.bias_mps2 = f.est.estimator.delayed.bias_mps2 = 0.7F;
        f.thrust_n = 6.8F;
        change_doubts(&f, GRAV_N);
        NEAR(rows[i].hover_n, f.hover_n);
        TEST_ASSERT_EQUAL_FLOAT((i == 0) ? 2.5F : 0.0F, f.learned_s);
        NEAR(0.45F, f.est.estimator.now.height_m);
        NEAR(-0.1F, f.est.estimator.now.speed_mps);
        NEAR(0.0F, f.est.estimator.now.bias_mps2);
        NEAR(rows[i].hover_n, f.est.hover.thrust_n);
        NEAR(6.8F, f.est.cascade.thrust_n);
        TEST_ASSERT_TRUE(f.est.accelerations_doubted);
        TEST_ASSERT_FALSE(est_law_has_acceleration(&f.est));
    }
    setUp();
    f.est.airborne = false;
    f.evidence.doubts = DOUBT_IMU;
    f.evidence.height_m = 0.45F;
    change_doubts(&f, GRAV_N);
    NEAR(0.5F, f.est.estimator.now.height_m);
    TEST_ASSERT_FALSE(f.est.airborne);
}

void test_a_doubt_of_the_thrust_or_an_unsure_pilot_leaves_the_law_without_authority(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        f.evidence.doubts = (i == 1) ? DOUBT_THRUST : 0U;
        f.throttle_unknown = i == 2;
        change_doubts(&f, GRAV_N);
        TEST_ASSERT_EQUAL(i != 0, f.est.without_authority);
    }
    setUp();
    f.doubts = DOUBT_THRUST; /* it has gone */
    f.hover_n = 7.3F;
    change_doubts(&f, GRAV_N);
    NEAR(7.3F, f.est.hover.thrust_n);
    sway(true);
    TEST_ASSERT_FALSE(f.est.rocks);
    change_doubts(&f, GRAV_N);
    TEST_ASSERT_TRUE(f.est.rocks);
}

/* ---- which law and mode */

void test_pidt_stands_in_for_law_est(void)
{
    TEST_ASSERT_FALSE(select_law(&f, &parameters));
    lose_the_estimate();
    TEST_ASSERT_TRUE(select_law(&f, &parameters));
    TEST_ASSERT_EQUAL(LAW_PIDT, f.active_law);
    TEST_ASSERT_FALSE(select_law(&f, &parameters));
    set(PARAMETER_LAW, LAW_PID);
    TEST_ASSERT_TRUE(select_law(&f, &parameters));
    TEST_ASSERT_EQUAL(LAW_PID, f.active_law);
}

void test_the_states_fly_by_the_estimate_where_it_is_sound(void)
{
    static const struct {
        flight_state_t state;
        control_law_t law;
        bool estimate, airborne, contradicted, uses;
    } rows[] = {{FLIGHT_TAKEOFF, LAW_EST, true, true, false, true},
                {FLIGHT_FLYING, LAW_PID, true, true, false, false},
                {FLIGHT_FLYING, LAW_EST, true, false, false, true},
                {FLIGHT_COASTING, LAW_EST, false, false, false, true},
                {FLIGHT_COASTING, LAW_PID, true, true, false, true},
                {FLIGHT_COASTING, LAW_PID, true, false, false, false},
                {FLIGHT_COASTING, LAW_PID, false, true, false, false},
                {FLIGHT_LANDING, LAW_PID, true, true, false, true},
                {FLIGHT_LANDING, LAW_EST, true, true, true, false},
                {FLIGHT_LANDING, LAW_EST, false, true, false, false},
                {FLIGHT_LOWERING, LAW_PID, true, true, false, true},
                {FLIGHT_LOWERING, LAW_EST, true, true, true, false},
                {FLIGHT_DESCENDING, LAW_PID, true, true, true, true},
                {FLIGHT_DESCENDING, LAW_EST, false, true, false, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        f.supervisor.state = rows[i].state;
        f.active_law = rows[i].law;
        f.est.estimator.initialised = rows[i].estimate;
        f.est.airborne = rows[i].airborne;
        f.supervisor.estimate_age_us = rows[i].contradicted ? 60000000U : 0U;
        TEST_ASSERT_EQUAL(rows[i].uses, uses_estimate(&f));
    }
}

void test_a_pilot_makes_floating_the_hover_thrust(void)
{
    f.supervisor.state = FLIGHT_FLOATING;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_HOLD, select_mode(&f, &in));
    lose_the_estimate();
    TEST_ASSERT_EQUAL(FLIGHT_MODE_FLOAT, select_mode(&f, &in));
    in.has_throttle = false;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_HOVER, select_mode(&f, &in));
    f.supervisor.state = FLIGHT_FLYING;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_HOLD, select_mode(&f, &in));
}

void test_heights_found_wrong_are_not_held_while_coasting(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        f.supervisor.state = (i == 3) ? FLIGHT_FLYING : FLIGHT_COASTING;
        f.evidence.doubts = (i == 1) ? DOUBT_IMU : DOUBT_SIGHT;
        f.est.airborne = i != 2;
        TEST_ASSERT_EQUAL((i == 0) ? FLIGHT_MODE_EST_SINK : FLIGHT_MODE_EST_HOLD, select_mode(&f, &in));
    }
    setUp();
    f.supervisor.state = FLIGHT_COASTING;
    f.evidence.doubts = DOUBT_SIGHT;
    lose_the_estimate();
    f.active_law = LAW_PIDT;
    TEST_ASSERT_EQUAL(FLIGHT_MODE_HOVER, select_mode(&f, &in));
}

void test_floating_without_a_pin_is_unsure_and_its_end_engages(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        f.supervisor.state = (i == 1) ? FLIGHT_FLYING : FLIGHT_FLOATING;
        set(PARAMETER_SEL, (i == 2) ? (float)SEL_PIN : (float)SEL_NONE);
        update_throttle_unknown(&f, &parameters, i != 3);
        TEST_ASSERT_EQUAL(i == 0, f.throttle_unknown);
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
        f.supervisor.state = rows[i].state;
        f.throttle_unknown = rows[i].before;
        f.est.airborne = false;
        f.hover_n = 7.3F;
        f.thrust_n = 6.7F;
        update_throttle_unknown(&f, &parameters, true);
        TEST_ASSERT_EQUAL(rows[i].engaged, f.est.airborne);
        if (rows[i].engaged) {
            NEAR(7.3F, f.est.hover.thrust_n);
            NEAR(6.7F, f.est.cascade.thrust_n);
        }
    }
}

void test_floating_holds_its_first_height_within_its_reach(void)
{
    static const struct {
        bool entered, throttle_unknown, has_effect;
        flight_mode_t mode;
        float before_m, held_m;
    } rows[] = {{false, false, false, FLIGHT_MODE_FLOAT, 0.6F, 0.6F},
                {true, false, false, FLIGHT_MODE_FLOAT, 0.6F, 0.5F},
                {false, false, false, FLIGHT_MODE_HOVER, 0.6F, 0.5F},
                {false, false, true, FLIGHT_MODE_FLOAT, 0.9F, 0.8F},
                {false, false, false, FLIGHT_MODE_FLOAT, 0.1F, 0.2F},
                {false, true, false, FLIGHT_MODE_EST_HOLD, 0.9F, 0.56F},
                {false, true, false, FLIGHT_MODE_EST_HOLD, 0.1F, 0.44F},
                {false, true, true, FLIGHT_MODE_EST_HOLD, 0.9F, 0.64F},
                {false, true, true, FLIGHT_MODE_EST_HOLD, 0.1F, 0.36F}};
    for (int i = 0; i < 9; i++) {
        setUp();
        f.supervisor.state = FLIGHT_FLOATING;
        f.mode = rows[i].mode;
        f.throttle_unknown = rows[i].throttle_unknown;
        f.effect.has_effect = rows[i].has_effect;
        f.floating_m = rows[i].before_m;
        float_along(&f, rows[i].entered);
        NEAR(rows[i].held_m, f.floating_m);
        NEAR(f.floating_m, aim_m(&f));
    }
    f.supervisor.state = FLIGHT_FLYING;
    f.floating_m = 0.6F;
    float_along(&f, false);
    NEAR(0.5F, f.floating_m);
    NEAR(0.6F, aim_m(&f));
    TEST_ASSERT_TRUE(is_hold_mode(FLIGHT_MODE_EST_HOLD) && is_hold_mode(FLIGHT_MODE_FLOAT));
    TEST_ASSERT_FALSE(is_hold_mode(FLIGHT_MODE_HOVER) || is_hold_mode(FLIGHT_MODE_LAW));
}

/* One frame of FLOATING without a pin, whose accelerometer measures this share of a jump of the thrust. */
static void float_a_frame(uint32_t step_us, bool felt)
{
    f.est.estimator.now_us += step_us;
    f.est.estimator.felt = felt;
    update_throttle_unknown(&f, &parameters, true);
}

void test_a_vehicle_that_floats_without_a_pin_learns_its_hover_thrust_once_it_obeys(void)
{
    f.supervisor.state = FLIGHT_FLOATING;
    parameters.value[PARAMETER_SEL] = (float)SEL_NONE;
    f.hover_n = 7.3F;
    f.thrust_n = 6.7F;
    f.est.authority_mps2_per_n = 1.4F;
    float_a_frame(25000U, true);
    TEST_ASSERT_TRUE(f.throttle_unknown && f.effect.running_s == 0.0F);
    for (int i = 0; i < 100 && !f.effect.has_effect; i++) {
        f.est.actuator.thrust_n = 7.0F + 0.5F * (float)(i % 3);
        f.est.estimator.up_mps2 = 1.4F * f.est.actuator.thrust_n - 9.0F;
        TEST_ASSERT_FALSE(carries_floating(&f));
        float_a_frame(25000U, true);
    }
    TEST_ASSERT_TRUE(carries_floating(&f));
    NEAR(7.3F, f.est.hover.thrust_n);
    NEAR(6.7F, f.est.cascade.thrust_n);
    f.est.cascade.thrust_n = 1.0F;
    float_a_frame(0U, true); /* no new frame */
    TEST_ASSERT_TRUE(carries_floating(&f));
    float_a_frame(25000U, true);
    NEAR(1.0F, f.est.cascade.thrust_n); /* engaged once */
    effect_t known = f.effect;
    float_a_frame(FRAME_GAP_US + 1U, true);
    TEST_ASSERT_FALSE(carries_floating(&f));
    f.effect = known;
    float_a_frame(25000U, false);
    TEST_ASSERT_FALSE(carries_floating(&f));
    f.effect = known;
    f.carried = true;
    f.supervisor.state = FLIGHT_DESCENDING;
    float_a_frame(25000U, true);
    TEST_ASSERT_TRUE(f.throttle_unknown && !carries_floating(&f));
}

/* ---- limits of the thrust */

/* A law that wants 11 N, of a vehicle with 2 m/s2 per newton less or more and a damping of 2.5 1/s. */
static float climbing_n(flight_state_t state, flight_mode_t mode, bool unconfirmed, float pushed_mps,
                        float felt_mps)
{
    f.supervisor.state = state;
    f.mode = mode;
    f.evidence.unconfirmed = unconfirmed;
    f.evidence.push_mps = pushed_mps;
    feel(felt_mps);
    return within_climb_n(&f, &parameters, 11.0F);
}

void test_a_climb_has_a_thrust_by_the_vehicles_model(void)
{
    const float per_mps = 2.5F * 7.0F / 9.80665F; /* newtons against the drag of 1 m/s */
    NEAR(7.0F + 0.35F * per_mps, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_EST_HOLD, true, 0.26F, 0.0F));
    NEAR(11.0F, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_EST_HOLD, true, 0.24F, 0.0F));
    NEAR(7.0F + 1.1F * per_mps, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_EST_HOLD, false, 1.01F, 0.0F));
    NEAR(11.0F, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_EST_HOLD, false, 0.99F, 0.0F));
    NEAR(7.0F + 0.6F * per_mps, climbing_n(FLIGHT_TAKEOFF, FLIGHT_MODE_EST_HOLD, true, 0.51F, 0.51F));
    NEAR(11.0F, climbing_n(FLIGHT_TAKEOFF, FLIGHT_MODE_EST_HOLD, true, 0.49F, 0.51F));
    NEAR(11.0F, climbing_n(FLIGHT_TAKEOFF, FLIGHT_MODE_EST_HOLD, true, 0.51F, 0.49F));
    NEAR(11.0F, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_LAW, true, 0.3F, 0.0F)); /* law EST does not fly */
    NEAR(11.0F, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_DESCENT, true, 0.3F, 0.0F));
    f.active_law = LAW_PIDT;
    NEAR(7.0F + 0.35F * per_mps, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_LAW, true, 0.3F, 0.0F));
    NEAR(11.0F, climbing_n(FLIGHT_FLYING, FLIGHT_MODE_FLOAT, true, 0.3F, 0.0F));
    NEAR(6.5F, within_climb_n(&f, &parameters, 6.5F));
}

void test_a_descent_over_a_far_fall_of_the_terrain_has_one_too(void)
{
    const float least_n = 7.0F - 0.35F * 2.5F * 7.0F / 9.80665F;
    NEAR(3.0F, within_descent_n(&f, &parameters, 3.0F));
    f.evidence.terrain_fell = true;
    NEAR(least_n, within_descent_n(&f, &parameters, 3.0F));
    NEAR(8.0F, within_descent_n(&f, &parameters, 8.0F));
    f.mode = FLIGHT_MODE_LAW;
    NEAR(3.0F, within_descent_n(&f, &parameters, 3.0F));
    f.active_law = LAW_PIDT;
    NEAR(least_n, within_descent_n(&f, &parameters, 3.0F));
    f.mode = FLIGHT_MODE_FLOAT;
    NEAR(3.0F, within_descent_n(&f, &parameters, 3.0F));
}

void test_a_thrust_in_doubt_stays_near_the_held_one_on_one_side(void)
{
    f.evidence.doubts = DOUBT_THRUST;
    f.evidence.held_n = 7.2F;
    NEAR(7.8F, within_power_n(&f, 11.0F));
    NEAR(3.0F, within_power_n(&f, 3.0F));
    f.evidence.held_down = true;
    NEAR(6.6F, within_power_n(&f, 3.0F));
    NEAR(11.0F, within_power_n(&f, 11.0F));
    f.supervisor.state = FLIGHT_LANDING;
    f.held_sunk_n = 0.5F;
    NEAR(6.6F - 0.52F, within_power_n(&f, 3.0F)); /* 0.2 N/s */
    f.supervisor.step_us = 5000000U;
    NEAR(6.6F - 0.62F, within_power_n(&f, 3.0F));
    f.mode = FLIGHT_MODE_IDLE;
    NEAR(0.0F, within_power_n(&f, 0.0F));
    f.supervisor.state = FLIGHT_FLYING;
    (void)within_power_n(&f, 3.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.held_sunk_n);
    f.held_sunk_n = 0.5F;
    f.supervisor.state = FLIGHT_LANDING;
    f.evidence.doubts = DOUBT_SIGHT;
    f.mode = FLIGHT_MODE_EST_LAND;
    NEAR(3.0F, within_power_n(&f, 3.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.held_sunk_n);
}

void test_where_a_pilot_may_fly_the_thrust_is_within_two_newtons_of_hover(void)
{
    f.throttle_unknown = true;
    NEAR(9.0F, within_power_n(&f, 11.0F));
    NEAR(5.0F, within_power_n(&f, 3.0F));
    NEAR(7.5F, within_power_n(&f, 7.5F));
}

void test_the_end_of_a_descent_is_tried_by_a_newton_a_second(void)
{
    static const struct {
        flight_mode_t mode;
        uint16_t doubts;
        bool still, tries;
    } rows[] = {
        {FLIGHT_MODE_EST_SINK, 0U, true, true},      {FLIGHT_MODE_EST_LAND, DOUBT_IMU, true, true},
        {FLIGHT_MODE_BLIND_DESCENT, 0U, true, true}, {FLIGHT_MODE_BLIND_DESCENT, DOUBT_IMU, true, false},
        {FLIGHT_MODE_EST_HOLD, 0U, true, false},     {FLIGHT_MODE_EST_SINK, 0U, false, false},
        {FLIGHT_MODE_DESCENT, 0U, true, false}};
    for (int i = 0; i < 7; i++) {
        setUp();
        f.mode = rows[i].mode;
        f.evidence.doubts = rows[i].doubts;
        f.evidence.may_stand = rows[i].still;
        f.stand_test_n = 6.0F;
        f.thrust_n = 6.5F;
        NEAR(rows[i].tries ? 5.9F : 8.0F, stand_test_n(&f, 8.0F));
        NEAR(rows[i].tries ? 5.9F : THRUST_MAX_N, f.stand_test_n);
        NEAR(3.0F, stand_test_n(&f, 3.0F));
    }
    setUp();
    f.mode = FLIGHT_MODE_EST_SINK;
    f.evidence.may_stand = true;
    f.stand_test_n = THRUST_MAX_N;
    f.thrust_n = 6.5F;
    NEAR(6.4F, stand_test_n(&f, 8.0F));
    f.supervisor.step_us = 5000000U;
    NEAR(5.9F, stand_test_n(&f, 8.0F));
    f.stand_test_n = 0.05F;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, stand_test_n(&f, 8.0F));
}

void test_time_runs_three_times_as_fast_in_a_blind_descent_whose_tilt_is_still(void)
{
    f.hover_n = 7.2F;
    f.mode = FLIGHT_MODE_BLIND_DESCENT;
    f.supervisor.state = FLIGHT_DESCENDING;
    f.supervisor.state_us = 10000000U;
    f.blind_ahead_s = 9.0F;
    sway(false);
    (void)run_mode(&f, &parameters, true);
    NEAR(descent_blind(7.2F, 10.0F), f.setpoint_n);
    (void)run_mode(&f, &parameters, false); /* 0.1 s */
    NEAR(descent_blind(7.2F, 10.2F), f.setpoint_n);
    (void)run_mode(&f, &parameters, false);
    NEAR(descent_blind(7.2F, 10.4F), f.setpoint_n);
    f.evidence.calm = false;
    (void)run_mode(&f, &parameters, false);
    NEAR(descent_blind(7.2F, 10.4F), f.setpoint_n);
    sway(false);
    f.est.frameless_s = 0.3F; /* an IMU that tells nothing is still too */
    (void)run_mode(&f, &parameters, false);
    NEAR(descent_blind(7.2F, 10.4F), f.setpoint_n);
}

void test_a_landing_near_the_ground_goes_on_there_while_heights_are_missing(void)
{
    f.hover_n = 7.0F;
    f.supervisor.state = FLIGHT_DESCENDING;
    f.supervisor.height.height_mm = 30.0F;
    NEAR(8.0F, within_landing_n(&f, 8.0F)); /* a height of before the landing tells nothing */
    f.supervisor.state = FLIGHT_LANDING;
    f.supervisor.height.height_mm = 41.0F;
    NEAR(8.0F, within_landing_n(&f, 8.0F));
    f.supervisor.height.height_mm = 39.0F;
    NEAR(7.3F, within_landing_n(&f, 8.0F)); /* 0.5 N above, after 0.1 s at 2 N/s */
    f.supervisor.state = FLIGHT_DESCENDING;
    NEAR(7.1F, within_landing_n(&f, 8.0F));
    NEAR(3.0F, within_landing_n(&f, 3.0F));
    f.supervisor.state = FLIGHT_LANDING;
    NEAR(6.7F, within_landing_n(&f, 8.0F));
    f.supervisor.height.height_mm = 101.0F;
    NEAR(8.0F, within_landing_n(&f, 8.0F));
    f.supervisor.height.height_mm = 30.0F;
    NEAR(7.3F, within_landing_n(&f, 8.0F));
    f.evidence.doubts = DOUBT_SIGHT;
    NEAR(8.0F, within_landing_n(&f, 8.0F));
    f.evidence.doubts = 0U;
    f.landed_s = 1.0F;
    f.supervisor.state = FLIGHT_LOWERING;
    NEAR(8.0F, within_landing_n(&f, 8.0F));
    NEAR(0.0F, f.landed_s);
}

void test_a_second_of_a_landing_without_thrust_is_counted(void)
{
    f.supervisor.state = FLIGHT_LANDING;
    f.idle_n = f.thrust_n = 0.8F;
    (void)within_landing_n(&f, 8.0F);
    (void)within_landing_n(&f, 8.0F);
    NEAR(0.2F, f.unpowered_s);
    f.thrust_n = 0.81F;
    (void)within_landing_n(&f, 8.0F);
    NEAR(0.0F, f.unpowered_s);
}

void test_a_landing_ends_after_more_than_a_second_without_thrust(void)
{
    static const float unpowered_s[] = {0.99F, 1.01F, 1.01F};
    for (int i = 0; i < 3; i++) {
        setUp();
        const flight_inputs_t landing = {.has_throttle = true};
        f.supervisor.state = FLIGHT_LANDING;
        f.unpowered_s = unpowered_s[i];
        f.landed_s = (i == 2) ? 0.0F : 4.0F;
        f.thrust_n = f.idle_n = 0.8F;
        supervise(&f, &parameters, &landing);
        TEST_ASSERT_EQUAL(i == 1, f.supervisor.stands);
    }
}

void test_a_take_off_that_ends_on_the_ground_stops_there(void)
{
    f.supervisor.state = FLIGHT_TAKEOFF;
    f.est.airborne = false;
    f.supervisor.state_us = 2999999U;
    TEST_ASSERT_FALSE(stops_on_ground(&f));
    TEST_ASSERT_TRUE(f.not_lifted);
    static const flight_state_t states[] = {FLIGHT_COASTING, FLIGHT_DESCENDING, FLIGHT_LANDING, FLIGHT_FLYING,
                                            FLIGHT_GROUND};
    for (int i = 0; i < 5; i++) {
        f.not_lifted = true;
        f.supervisor.state = states[i];
        TEST_ASSERT_EQUAL(i < 3, stops_on_ground(&f));
        TEST_ASSERT_EQUAL(i < 3, f.not_lifted);
    }
    f.supervisor.state = FLIGHT_TAKEOFF;
    f.supervisor.state_us = 3000000U;
    f.not_lifted = true;
    (void)stops_on_ground(&f);
    TEST_ASSERT_FALSE(f.not_lifted);
    f.supervisor.state_us = 0U;
    f.est.airborne = true;
    (void)stops_on_ground(&f);
    TEST_ASSERT_FALSE(f.not_lifted);
    f.supervisor.state = FLIGHT_LANDING;
    TEST_ASSERT_FALSE(stops_on_ground(&f));
}

/* ---- the estimator's turn */

void test_on_the_ground_the_law_is_reset_and_with_a_pilot_disengaged(void)
{
    f.supervisor.state = FLIGHT_GROUND;
    update_estimator(&f, &parameters, &in);
    TEST_ASSERT_TRUE(f.lifting);
    TEST_ASSERT_FALSE(f.est.airborne);
    setUp();
    f.supervisor.state = FLIGHT_FLOATING;
    f.lifting = true;
    update_estimator(&f, &parameters, &in);
    TEST_ASSERT_FALSE(f.lifting); /* it has risen */
    TEST_ASSERT_TRUE(f.est.airborne);
    in.has_throttle = false;
    update_estimator(&f, &parameters, &in);
    TEST_ASSERT_FALSE(f.est.airborne);
    f.supervisor.state = FLIGHT_FLYING;
    f.est.airborne = true;
    update_estimator(&f, &parameters, &in);
    TEST_ASSERT_TRUE(f.est.airborne);
}

void test_other_laws_engage_the_estimate_when_they_fly(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        f.mode = (i == 1) ? FLIGHT_MODE_EST_HOLD : FLIGHT_MODE_LAW;
        f.est.airborne = i == 2;
        f.lifting = i == 3;
        f.supervisor.height.height_mm = (i == 3) ? 50.0F : 500.0F;
        f.est.ground_m = 0.0F;
        f.thrust_n = 6.6F;
        f.est.cascade.thrust_n = 1.0F;
        update_estimator(&f, &parameters, &in);
        NEAR((i == 0) ? 6.6F : 1.0F, f.est.cascade.thrust_n);
        TEST_ASSERT_EQUAL(i == 0 || i == 2, f.est.airborne);
    }
}

void test_a_new_height_is_fused_and_on_the_ground_at_rest(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        f.supervisor.state = (i == 1) ? FLIGHT_FLYING : FLIGHT_GROUND;
        f.supervisor.rest.on = i != 2;
        f.supervisor.height.is_new = i != 3;
        f.est.estimator.delayed.speed_mps = 0.2F;
        in.altitude = (altitude_t){.valid = true, .slant_mm = 500.0F};
        in.height_stamp_ms = 4000U;
        in.height_time_us = 2000000U;
        in.height_age_us = 60000U;
        f.est.estimator.delayed_us = 1940000U;
        update_estimator(&f, &parameters, &in);
        TEST_ASSERT_EQUAL_UINT32((i != 3) ? 1940000U : 0U, f.est.rays_us);
        TEST_ASSERT_EQUAL(i == 0, f.est.estimator.delayed.speed_mps < 0.05F);
    }
}

void test_a_reference_out_of_reach_is_told_in_the_states_that_act(void)
{
    f.supervisor.reference_m = f.reach_m = 0.6F;
    f.reach = (reach_t){.on = true, .above = false, .nearest_mm = 100.0F, .stuck_us = 60000000U};
    const reach_t stuck = f.reach;
    f.supervisor.height.height_mm = 300.0F;
    judge_reach(&f);
    TEST_ASSERT_TRUE(f.out_of_reach);
    f.supervisor.state = FLIGHT_TAKEOFF;
    judge_reach(&f);
    TEST_ASSERT_TRUE(f.out_of_reach);
    f.supervisor.reference_m = 0.7F;
    judge_reach(&f);
    TEST_ASSERT_FALSE(f.out_of_reach);
    NEAR(0.7F, f.reach_m);
    f.reach = stuck;
    f.supervisor.state = FLIGHT_LANDING;
    judge_reach(&f);
    TEST_ASSERT_FALSE(f.out_of_reach);
    TEST_ASSERT_FALSE(f.reach.on);
}

/* ---- outputs */

void test_the_output_against_a_wrong_pin_is_at_most_full_thrust(void)
{
    f.thrust_n = THRUST_MAX_N - 0.4F;
    f.stuck_pin_n = 0.3F;
    write_outputs(&f, &parameters, &out);
    NEAR(THRUST_MAX_N - 0.1F, out.thrust_n);
    f.stuck_pin_n = 1.0F;
    write_outputs(&f, &parameters, &out);
    TEST_ASSERT_EQUAL_FLOAT(THRUST_MAX_N, out.thrust_n);
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

void test_the_outputs_tell_thrust_height_and_flags(void)
{
    f.thrust_n = 6.5F;
    f.idle_n = 1.7F;
    f.supervisor.flags = FLIGHT_FLAG_HEIGHT;
    f.est.estimator.innovation_m = 0.012F;
    f.est.estimator.now.height_m = 0.52F;
    f.axes.fault = IMU_ROLL;
    write_outputs(&f, &parameters, &out);
    NEAR(6.5F, out.thrust_n);
    NEAR(1.7F, out.idle_n);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, thrust_to_pulse_us(6.5F), out.pulse_us);
    TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_HEIGHT, out.flags);
    TEST_ASSERT_EQUAL(IMU_ROLL, out.imu_fault);
    NEAR(0.6F, out.reference_m);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 520.0F, out.estimate_mm);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 12.0F, out.innovation_mm);
    TEST_ASSERT_EQUAL_UINT16(0U, out.doubts);
    f.mode = FLIGHT_MODE_LAW;
    write_outputs(&f, &parameters, &out);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 520.0F, out.estimate_mm);
    f.active_law = LAW_PID;
    write_outputs(&f, &parameters, &out);
    TEST_ASSERT_EQUAL_FLOAT(500.0F, out.estimate_mm);
    TEST_ASSERT_TRUE(isnan(out.innovation_mm));
    f.supervisor.height.sequence = 0U;
    write_outputs(&f, &parameters, &out);
    TEST_ASSERT_TRUE(isnan(out.estimate_mm));
    f.mode = FLIGHT_MODE_EST_LAND;
    write_outputs(&f, &parameters, &out);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 520.0F, out.estimate_mm);
}

void test_each_lack_has_its_flag(void)
{
    for (int i = 0; i < 6; i++) {
        setUp();
        f.est.frameless_s = (i == 1 || i == 5) ? 1.0F : 0.0F;
        f.est.estimator.felt = i != 2 && i != 5;
        f.out_of_reach = i == 3;
        f.evidence.doubts = (uint16_t)((i == 4) ? (DOUBT_SIGHT | DOUBT_THRUST) : 0U);
        write_outputs(&f, &parameters, &out);
        static const uint16_t flags[] = {0U,
                                         FLIGHT_FLAG_ATTITUDE,
                                         FLIGHT_FLAG_IMU,
                                         FLIGHT_FLAG_REACH,
                                         FLIGHT_FLAG_SIGHT * (DOUBT_SIGHT | DOUBT_THRUST),
                                         FLIGHT_FLAG_ATTITUDE};
        TEST_ASSERT_EQUAL_UINT16(flags[i], out.flags);
        TEST_ASSERT_EQUAL_UINT16(f.evidence.doubts, out.doubts);
    }
    setUp();
    set(PARAMETER_LAW, LAW_PID); /* it needs no IMU */
    f.est.frameless_s = 1.0F;
    write_outputs(&f, &parameters, &out);
    TEST_ASSERT_EQUAL_UINT16(0U, out.flags);
    f.est.frameless_s = 0.0F;
    f.est.estimator.felt = false;
    write_outputs(&f, &parameters, &out);
    TEST_ASSERT_EQUAL_UINT16(0U, out.flags);
}

/* ---- a whole cycle */

void test_a_cycle_that_stops_on_the_ground_takes_two_newtons_a_second(void)
{
    f.supervisor.state = FLIGHT_LANDING;
    f.supervisor.land = true;
    f.not_lifted = true;
    f.est.airborne = false;
    f.thrust_n = 5.0F;
    f.transfer_n = 0.3F;
    f.mode = FLIGHT_MODE_EST_LAND;
    f.arming.armed = true;
    in.now_us = 100000U;
    in.height_valid = false;
    flight_step(&f, &parameters, &in, &out);
    NEAR(4.8F, out.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.transfer_n);
    TEST_ASSERT_EQUAL_UINT16(1U, f.est.actuator.count); /* recorded */
    NEAR(0.0F, f.est.actuator.coming[0].thrust_n - 4.8F);
}

/* ---- in a pilot's hands, without a pin or without heights */

void test_it_may_be_carried_on_the_ground_without_a_pin_or_in_a_descent_that_began_so(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        f.supervisor.state = FLIGHT_GROUND;
        f.evidence.in_hands = i != 1;
        set(PARAMETER_SEL, (i == 2) ? (float)SEL_PIN : (float)SEL_NONE);
        TEST_ASSERT_EQUAL(i == 0, may_be_carried(&f, &parameters));
    }
    f.supervisor.state = FLIGHT_DESCENDING;
    sway(true);
    TEST_ASSERT_FALSE(may_be_carried(&f, &parameters));
    f.carried = true;
    TEST_ASSERT_TRUE(may_be_carried(&f, &parameters));
    sway(false);
    TEST_ASSERT_FALSE(may_be_carried(&f, &parameters));
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
            f.supervisor.state = rows[i].state;
            f.supervisor.handed_over = rows[i].handed_over;
            f.supervisor.state_us = rows[i].state_us;
            f.carried = rows[i].before;
            update_throttle_unknown(&f, &parameters, true);
            TEST_ASSERT_EQUAL(rows[i].carried, f.carried);
            TEST_ASSERT_EQUAL(rows[i].carried, f.throttle_unknown);
            NEAR((i == 0) ? ((pin != 0) ? 0.15F : 0.06F) : 0.0F, f.carried_n_per_s);
        }
    }
}

/* One step of 0.1 s with a felt speed, after felt climbs of before_n. */
static float carried_step_n(float felt_mps, float before_n)
{
    f.carried_felt_n = before_n;
    f.est.estimator.now.speed_mps = f.est.estimator.delayed.speed_mps = felt_mps;
    f.est.estimator.now.bias_mps2 = f.est.estimator.delayed.bias_mps2 = 0.2F;
    return within_power_n(&f, 3.0F);
}

void test_a_carried_vehicle_has_a_thrust_below_hover_that_sinks(void)
{
    f.carried = f.throttle_unknown = true;
    f.carried_n_per_s = 0.06F;
    f.supervisor.state_us = 10000000U;
    NEAR(7.0F - 0.5F - 0.6F, carried_step_n(0.3F, 0.0F));
    NEAR(0.285F, f.est.estimator.now.speed_mps); /* less a twentieth: 0.1 of 2 s */
    NEAR(0.0F, f.est.estimator.now.height_m);
    NEAR(0.2015F, f.est.estimator.now.bias_mps2);
    NEAR(7.0F - 0.5F - 0.6F - 0.4F, carried_step_n(-0.3F, 0.4F));
    f.supervisor.state_us = 50000000U;
    NEAR(7.0F - 0.5F - 1.2F, carried_step_n(0.0F, 0.0F));
}

void test_a_carried_vehicle_that_feels_a_climb_gives_less_and_a_fall_more(void)
{
    f.carried = f.throttle_unknown = true;
    NEAR(7.0F - 0.5F - 0.2F - 1.0F, carried_step_n(1.35F, 0.0F)); /* 1 m/s beyond: 2 N in a second */
    NEAR(0.2F, f.carried_felt_n);
    NEAR(7.0F - 0.5F + 1.0F, carried_step_n(-0.85F, 0.0F));
    NEAR(0.0F, f.carried_felt_n); /* no more than what climbs have lowered */
    NEAR(7.0F - 0.5F - 0.9F + 1.0F, carried_step_n(-0.85F, 1.0F));
    NEAR(7.0F - 0.5F + 1.8F, carried_step_n(-2.0F, 0.0F));
    (void)carried_step_n(3.0F, 1.95F);
    NEAR(2.0F, f.carried_felt_n);
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
        f.supervisor.state = FLIGHT_LANDING;
        f.supervisor.state_us = rows[i].state_us;
        f.supervisor.height.height_mm = rows[i].height_mm;
        f.evidence.rise_mps = rows[i].rise_mps;
        f.thrust_n = rows[i].thrust_n;
        f.vain_landing_s = rows[i].before_s;
        watch_landing(&f);
        TEST_ASSERT_EQUAL(rows[i].vain, lands_in_vain(&f));
        NEAR(i == 0 ? 1.0F : i == 1 ? 0.95F : 0.0F, f.vain_landing_s);
        judge_reach(&f);
        TEST_ASSERT_EQUAL(rows[i].vain, f.out_of_reach);
        f.supervisor.state = FLIGHT_DESCENDING;
        TEST_ASSERT_FALSE(lands_in_vain(&f));
    }
}

void test_without_a_pin_a_landing_in_vain_keeps_a_thrust_near_hover(void)
{
    for (int pin = 0; pin < 2; pin++) {
        setUp();
        set(PARAMETER_SEL, (pin != 0) ? (float)SEL_PIN : (float)SEL_NONE);
        f.supervisor.state = FLIGHT_LANDING;
        f.supervisor.state_us = 1U;
        f.supervisor.height.height_mm = 500.0F;
        f.thrust_n = 5.0F;
        f.vain_landing_s = 1.0F;
        update_throttle_unknown(&f, &parameters, true);
        TEST_ASSERT_EQUAL(pin == 0, f.throttle_unknown);
        f.thrust_n = 7.0F; /* it stays so */
        update_throttle_unknown(&f, &parameters, true);
        TEST_ASSERT_EQUAL(pin == 0, f.throttle_unknown);
        f.held_sunk_n = 0.4F;
        NEAR((pin == 0) ? 7.0F - 2.0F - 0.42F : 3.0F, within_power_n(&f, 3.0F));
    }
}

void test_a_carried_descent_knows_its_hover_thrust_still(void)
{
    f.supervisor.state = FLIGHT_DESCENDING;
    f.carried = true;
    f.est.entry_hover_n = 6.0F;
    f.hover_n = 7.2F;
    update_hover(&f, GRAV_N);
    NEAR(7.2F, f.est.entry_hover_n);
}

void test_a_descent_from_a_pilots_hands_starts_from_the_felt_speed(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        f.supervisor.state = (i == 1) ? FLIGHT_LANDING : FLIGHT_DESCENDING;
        f.evidence.felt_mps = 0.3F;
        f.evidence.bias_mps2 = 0.15F;
        change_mode(&f, (i == 2) ? FLIGHT_MODE_LAW : FLIGHT_MODE_IDLE, FLIGHT_MODE_EST_SINK, GRAV_N);
        NEAR((i == 0) ? 0.3F : 0.0F, f.est.estimator.now.speed_mps);
        NEAR((i == 0) ? 0.15F : 0.0F, f.est.estimator.now.bias_mps2);
        NEAR((i == 0) ? 0.0F : 0.5F, f.est.estimator.now.height_m);
    }
}

/* ---- gaps */

void test_an_imu_that_is_back_starts_the_estimate_from_thrust_and_heights(void)
{
    static const struct {
        bool airborne, frames, felt, doubted, starts;
    } rows[] = {{true, true, true, false, true},
                {false, true, true, false, false},
                {true, false, true, false, false},
                {true, true, false, false, true},
                {true, true, true, true, true}};
    for (int i = 0; i < 5; i++) {
        setUp();
        lose_the_estimate();
        f.est.airborne = rows[i].airborne;
        f.est.frameless_s = rows[i].frames ? 0.0F : 1.0F;
        f.est.estimator.felt = rows[i].felt;
        f.evidence.doubts = rows[i].doubted ? DOUBT_SIGHT : 0U;
        f.evidence.height_m = 0.7F;
        f.evidence.bias_mps2 = 0.25F;
        f.evidence.pushed_mps = 0.24F;
        f.evidence.moved_m = 0.05F;
        update_estimator(&f, &parameters, &in);
        TEST_ASSERT_EQUAL(rows[i].starts, f.est.estimator.initialised);
        if (rows[i].starts) {
            NEAR(rows[i].doubted ? 0.5F : 0.75F, f.est.estimator.now.height_m);
            NEAR(0.24F, f.est.estimator.now.speed_mps);
            NEAR(rows[i].felt ? 0.25F : 0.0F, f.est.estimator.now.bias_mps2);
        }
    }
}

void test_pidt_does_not_hold_a_push_while_heights_are_late(void)
{
    static const struct {
        uint32_t age_us;
        bool airborne;
        float setpoint_n, then_n;
    } rows[] = {{170000U, true, 9.0F, 9.0F},
                {170001U, true, 9.0F, 7.5F},
                {170001U, true, 5.0F, 6.5F},
                {170001U, true, 7.2F, 7.2F},
                {170001U, false, 9.0F, 9.0F}};
    for (int i = 0; i < 5; i++) {
        setUp();
        f.pidt.primed = true;
        f.supervisor.height.age_us = rows[i].age_us;
        f.est.airborne = rows[i].airborne;
        f.setpoint_n = rows[i].setpoint_n;
        step_pidt(&f, &parameters, 0.6F);
        NEAR(rows[i].then_n, f.setpoint_n);
    }
}

void test_a_law_that_goes_on_without_the_estimate_starts_near_hover(void)
{
    for (int lost = 0; lost < 2; lost++) {
        setUp();
        f.mode = FLIGHT_MODE_LAW;
        f.thrust_n = 9.0F;
        f.est.estimator.initialised = lost == 0;
        bumpless_transfer(&f, FLIGHT_MODE_EST_HOLD, true);
        NEAR((lost != 0) ? 0.5F : 2.0F, f.transfer_n);
    }
}

void test_a_doubted_accelerometer_does_not_free_a_climb_at_take_off(void)
{
    f.evidence.doubts = DOUBT_IMU;
    TEST_ASSERT_TRUE(climbing_n(FLIGHT_TAKEOFF, FLIGHT_MODE_EST_HOLD, true, 0.51F, 0.0F) < 9.0F);
}

void test_a_hover_thrust_learned_in_this_flight_survives_a_law_without_the_estimate(void)
{
    static const struct {
        flight_mode_t before;
        bool airborne, knows;
    } rows[] = {
        {FLIGHT_MODE_LAW, true, true}, {FLIGHT_MODE_LAW, false, false}, {FLIGHT_MODE_FLOAT, true, false}};
    for (int i = 0; i < 3; i++) {
        setUp();
        f.est.airborne = rows[i].airborne;
        f.est.hover.thrust_n = 7.6F;
        f.est.hover.variance_n2 = 0.02F;
        f.hover_n = 7.2F;
        change_mode(&f, rows[i].before, FLIGHT_MODE_EST_HOLD, GRAV_N);
        NEAR(rows[i].knows ? 7.6F : 7.2F, f.est.hover.thrust_n);
        NEAR(rows[i].knows ? 0.02F : 0.25F, f.est.hover.variance_n2);
        TEST_ASSERT_TRUE(f.est.airborne);
    }
}
