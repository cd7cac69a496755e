#include "control/laws/laws.h"
#include "flight_case.h"

static laws_t laws;

/* Gains with which an integral action comes before the thrust leaves its window. */
void setUp(void)
{
    begin();
    set(PARAMETER_KP, 0.005F);
    set(PARAMETER_KI, 0.0002F);
    set(PARAMETER_USAT, 3.0F);
    memset(&laws, 0, sizeof laws);
}

void tearDown(void) {}

static float step_n(flight_mode_t before, flight_mode_t mode)
{
    mode_changes(before, mode);
    (void)laws_step(&laws, &est, &now, false);
    return laws.setpoint_n;
}

static void change_mode(flight_mode_t before, flight_mode_t mode)
{
    mode_changes(before, mode);
    laws_change(&laws, &now);
}

/* PID, or PIDT, is 0.1 m too low for a while: it has an integral action. Then it is where it wants to be, and
 * the integral action is all that it asks for beyond GRAV. */
static float flown_n(control_law_t law)
{
    now.law = law;
    (void)step_n(FLIGHT_MODE_IDLE, FLIGHT_MODE_IDLE);
    at_mm(500.0F);
    for (int i = 0; i < 30; i++) {
        height_is_new(true, 0U);
        rays_were_at_us(est.rays_us + 100000U);
        (void)step_n(FLIGHT_MODE_LAW, FLIGHT_MODE_LAW);
    }
    at_mm(600.0F);
    for (int i = 0; i < 10; i++) { /* until its derivative is gone */
        height_is_new(true, 0U);
        rays_were_at_us(est.rays_us + 100000U);
        (void)step_n(FLIGHT_MODE_LAW, FLIGHT_MODE_LAW);
    }
    return laws.setpoint_n - GRAV_N;
}

/* What is left of it in the law that flies next. */
static float left_n(control_law_t law)
{
    now.law = law;
    height_is_new(true, 0U);
    return step_n(FLIGHT_MODE_LAW, FLIGHT_MODE_LAW) - GRAV_N;
}

void test_a_law_resumes_with_its_integral_and_others_forget_it_but_in_coasting(void)
{
    static const struct {
        flight_state_t state;
        flight_mode_t before, then;
        bool pid_keeps, pidt_keeps;
    } rows[] = {{FLIGHT_FLYING, FLIGHT_MODE_HOVER, FLIGHT_MODE_LAW, true, true},
                {FLIGHT_TAKEOFF, FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_LAW, true, true},
                {FLIGHT_COASTING, FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, true, true},
                {FLIGHT_FLOATING, FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, false, false},
                {FLIGHT_COASTING, FLIGHT_MODE_LAW, FLIGHT_MODE_FLOAT, true, false}};
    static const control_law_t pid_and_pidt[] = {LAW_PID, LAW_PIDT};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        for (int k = 0; k < 2; k++) {
            setUp();
            set(PARAMETER_LAW, (float)pid_and_pidt[k]);
            const float integral_n = flown_n(pid_and_pidt[k]);
            TEST_ASSERT_TRUE(integral_n > 0.1F);
            in_state(rows[i].state);
            change_mode(rows[i].before, rows[i].then);
            const bool keeps = (k == 0) ? rows[i].pid_keeps : rows[i].pidt_keeps;
            TEST_ASSERT_FLOAT_WITHIN(0.01F, keeps ? integral_n : 0.0F, left_n(pid_and_pidt[k]));
        }
    }
}

/* The next sample has no derivative: what was seen while another mode flew says nothing of a speed. */
void test_a_law_that_resumes_has_no_derivative(void)
{
    static const control_law_t pid_and_pidt[] = {LAW_PID, LAW_PIDT};

    for (int k = 0; k < 2; k++) {
        setUp();
        set(PARAMETER_LAW, (float)pid_and_pidt[k]);
        set(PARAMETER_KI, 0.0F);
        set(PARAMETER_PKI, 0.0F);
        (void)flown_n(pid_and_pidt[k]);
        change_mode(FLIGHT_MODE_HOVER, FLIGHT_MODE_LAW);
        at_mm(590.0F);
        rays_were_at_us(est.rays_us + 100000U);
        const float share_n = 0.01F * ((k == 0) ? 1000.0F * parameters.value[PARAMETER_KP]
                                                : parameters.value[PARAMETER_PKP]);
        TEST_ASSERT_FLOAT_WITHIN(0.001F, share_n, left_n(pid_and_pidt[k]));
    }
}

void test_pidt_takes_over_from_est_with_the_hover_thrust_that_was_found(void)
{
    hovers_at_n(7.3F);
    set(PARAMETER_LAW, (float)LAW_PIDT);
    (void)flown_n(LAW_PIDT);
    change_mode(FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_LAW);
    NEAR(0.3F, left_n(LAW_PIDT));
}

void test_a_descent_starts_from_the_measured_rate(void)
{
    descent_t expected;

    for (int changes = 0; changes < 2; changes++) {
        setUp();
        height_is(500.0F, -150.0F, 100000U, true);
        descent_start(&expected, (changes != 0) ? -150.0F : 0.0F);
        change_mode(FLIGHT_MODE_EST_HOLD, (changes != 0) ? FLIGHT_MODE_DESCENT : FLIGHT_MODE_EST_LAND);
        NEAR(descent_step(&expected, GRAV_N, 500.0F, -150.0F, 0.1F),
             step_n(FLIGHT_MODE_DESCENT, FLIGHT_MODE_DESCENT));
    }
}

/* 0.3 N is left from a transfer before. */
static void has_left_0_3_n(void)
{
    now.thrust_n = 7.3F;
    mode_is(FLIGHT_MODE_HOVER);
    NEAR(7.3F, laws_step(&laws, &est, &now, true));
}

/* Thrust of the first cycle, less what the mode itself gives. */
static float transferred_n(bool law_changed)
{
    return laws_step(&laws, &est, &now, law_changed) - laws.setpoint_n;
}

void test_the_thrust_passes_over_without_a_jump(void)
{
    static const struct {
        flight_mode_t before, now;
        float thrust_n, starts_n;
        bool law_changed;
    } rows[] = {{FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, 6.8F, 6.8F, false},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, 6.0F, 6.5F, false}, /* half a newton from hover */
                {FLIGHT_MODE_LAW, FLIGHT_MODE_HOVER, 9.0F, 7.5F, false},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_LAW, 9.0F, 9.0F, true},
                {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_BLIND_DESCENT, 6.8F, 6.8F, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        has_left_0_3_n();
        mode_changes(rows[i].before, rows[i].now);
        now.thrust_n = rows[i].thrust_n;
        NEAR(rows[i].starts_n, laws_step(&laws, &est, &now, rows[i].law_changed));
    }
}

void test_a_descent_by_heights_a_landing_and_the_ground_start_at_once(void)
{
    static const struct {
        flight_mode_t before, now;
        bool law_changed;
    } rows[] = {{FLIGHT_MODE_LAW, FLIGHT_MODE_IDLE, false},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_DESCENT, false},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_EST_LAND, true},
                {FLIGHT_MODE_IDLE, FLIGHT_MODE_LAW, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        has_left_0_3_n();
        mode_changes(rows[i].before, rows[i].now);
        now.thrust_n = 6.8F;
        NEAR(0.0F, transferred_n(rows[i].law_changed));
    }
    for (int lifts = 0; lifts < 2; lifts++) {
        setUp();
        has_left_0_3_n();
        mode_changes(FLIGHT_MODE_HOVER, FLIGHT_MODE_EST_HOLD);
        now.thrust_n = 6.8F;
        lifting(lifts != 0);
        if (lifts != 0) {
            NEAR(0.0F, transferred_n(false));
        } else {
            NEAR(6.8F, laws_step(&laws, &est, &now, false));
        }
    }
}

/* In a cycle of 0.1 s: 0.4 of 0.5 s. */
void test_what_is_left_of_a_transfer_fades(void)
{
    static const struct {
        flight_mode_t before, now;
    } rows[] = {{FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_LAND},
                {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_SINK},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_LAW}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        has_left_0_3_n();
        mode_changes(rows[i].before, rows[i].now);
        NEAR(0.24F, transferred_n(false));
    }
}

/* Else the armed idle would go on for a second after a disarming. */
void test_a_change_of_the_law_on_the_ground_adds_nothing_to_the_idle(void)
{
    has_left_0_3_n();
    now.thrust_n = 1.8F;
    mode_is(FLIGHT_MODE_IDLE);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, laws_step(&laws, &est, &now, true));
}

void test_a_law_that_goes_on_without_the_estimate_starts_near_hover(void)
{
    for (int lost = 0; lost < 2; lost++) {
        setUp();
        (void)step_n(FLIGHT_MODE_HOVER, FLIGHT_MODE_HOVER);
        mode_changes(FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_LAW);
        now.thrust_n = 9.0F;
        if (lost != 0) {
            lose_the_estimate();
        }
        NEAR((lost != 0) ? 7.5F : 9.0F, laws_step(&laws, &est, &now, true));
    }
}

void test_a_new_gravity_moves_no_thrust_of_a_law_that_flies(void)
{
    static const struct {
        control_law_t law;
        flight_mode_t before, mode;
        bool follows;
    } rows[] = {{LAW_PID, FLIGHT_MODE_LAW, FLIGHT_MODE_LAW, false},
                {LAW_PIDT, FLIGHT_MODE_LAW, FLIGHT_MODE_LAW, false},
                {LAW_PID, FLIGHT_MODE_HOVER, FLIGHT_MODE_LAW, true},
                {LAW_PIDT, FLIGHT_MODE_HOVER, FLIGHT_MODE_HOVER, true}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        set(PARAMETER_LAW, (float)rows[i].law);
        const float integral_n = flown_n(rows[i].law);
        TEST_ASSERT_TRUE(integral_n > 0.1F);
        set(PARAMETER_GRAV, 7.3F);
        (void)step_n(rows[i].before, rows[i].mode);
        TEST_ASSERT_FLOAT_WITHIN(0.01F, integral_n + (rows[i].follows ? 0.3F : 0.0F), left_n(rows[i].law));
    }
}

void test_each_mode_has_its_thrust(void)
{
    NEAR(0.0F, step_n(FLIGHT_MODE_IDLE, FLIGHT_MODE_IDLE));
    hovers_at_n(7.2F);
    NEAR(7.2F, step_n(FLIGHT_MODE_HOVER, FLIGHT_MODE_HOVER));
    in_state_for_us(FLIGHT_DESCENDING, 5000000U);
    sway(true);
    NEAR(descent_blind(7.2F, 5.0F), step_n(FLIGHT_MODE_HOVER, FLIGHT_MODE_BLIND_DESCENT));
    in_state(FLIGHT_FLYING);
    now.aim_m = 0.5F;
    NEAR(GRAV_N, step_n(FLIGHT_MODE_FLOAT, FLIGHT_MODE_FLOAT)); /* it is at the height that it holds */
    height_is_new(true, 0U);
    TEST_ASSERT_FLOAT_WITHIN(0.2F, 7.1F,
                             step_n(FLIGHT_MODE_HOVER, FLIGHT_MODE_DESCENT)); /* it begins to sink */
    now.aim_m = 0.6F;
    now.law = LAW_PD;
    NEAR(GRAV_N + 0.5F, step_n(FLIGHT_MODE_LAW, FLIGHT_MODE_LAW));
    now.law = LAW_PIDT;
    height_is_new(true, 0U);
    TEST_ASSERT_TRUE(step_n(FLIGHT_MODE_LAW, FLIGHT_MODE_LAW) > GRAV_N + 0.1F);
    est_law_t expected = est;
    const est_order_t order = {
        .mode = EST_MODE_HOLD, .reference_m = 0.6F, .airborne = where.contact.airborne, .hover_n = 7.2F};
    now.law = LAW_EST;
    NEAR(est_law_step(&expected, &parameters, &order), step_n(FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_HOLD));
}

void test_a_take_off_given_up_takes_two_newtons_a_second(void)
{
    has_left_0_3_n();
    now.thrust_n = 5.0F;
    took_off_in_vain();
    in_state(FLIGHT_LANDING);
    NEAR(4.8F, laws_step(&laws, &est, &now, false));
}

void test_the_release_is_the_laws(void)
{
    const uint16_t both = FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME;

    TEST_ASSERT_EQUAL_UINT16(both, laws_releases(&parameters, FLIGHT_MODE_EST_HOLD));
    set(PARAMETER_LAW, LAW_PID);
    TEST_ASSERT_EQUAL_UINT16(both, laws_releases(&parameters, FLIGHT_MODE_EST_HOLD));
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_PERIOD, laws_releases(&parameters, FLIGHT_MODE_LAW));
    set(PARAMETER_RELEASE, (float)RELEASE_SCAN);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_HEIGHT, laws_releases(&parameters, FLIGHT_MODE_LAW));
    set(PARAMETER_RELEASE, (float)RELEASE_FREE);
    set(PARAMETER_LAW, LAW_PIDT);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_HEIGHT, laws_releases(&parameters, FLIGHT_MODE_LAW));
    TEST_ASSERT_EQUAL_UINT16(both, laws_releases(&parameters, FLIGHT_MODE_EST_LAND));
}
