#include "control/laws/laws.h"
#include "flight_case.h"

static laws_t laws;
static pidt_state_t expected;
static pidt_gains_t gains;

/* Law PIDT flies at 0.5 m towards 0.6 m, as the one that is expected does. */
void setUp(void)
{
    begin();
    memset(&laws, 0, sizeof laws);
    mode_is(FLIGHT_MODE_IDLE);
    (void)laws_step(&laws, &est, &now, false); /* it has stood on the ground */
    pidt_reset(&expected);
    mode_is(FLIGHT_MODE_LAW);
    now.law = LAW_PIDT;
    set(PARAMETER_LAW, (float)LAW_PIDT);
    set(PARAMETER_PKP, 4.0F);
    set(PARAMETER_PKI, 1.0F);
    set(PARAMETER_PKD, 3.0F);
    gains = (pidt_gains_t){4.0F, 1.0F, 3.0F, GRAV_N, 10.0F, 4.0F};
}

void tearDown(void) {}

static float step_n(void)
{
    (void)laws_step(&laws, &est, &now, false);
    return laws.setpoint_n;
}

/* A new height, of rays that are that late after the ones before. */
static float see_n(float height_m, uint32_t gap_us)
{
    at_mm(1000.0F * height_m);
    height_is_new(true, 0U);
    rays_were_at_us(est.rays_us + gap_us);
    return step_n();
}

static float expected_n(float height_m, float gap_s)
{
    return pidt_step(&expected, &gains, 0.6F, height_m, gap_s);
}

void test_pidt_gets_its_gains_and_the_time_between_rays(void)
{
    (void)expected_n(0.49F, 0.0F);
    (void)see_n(0.49F, 0U);
    NEAR(expected_n(0.5F, 0.12F), see_n(0.5F, 120000U));
    NEAR(expected_n(0.52F, 0.1F), see_n(0.52F, 100000U));
}

void test_a_pause_longer_than_a_height_is_fresh_is_no_derivative(void)
{
    (void)see_n(0.49F, 0U);
    (void)see_n(0.5F, 100000U);
    NEAR(GRAV_N + 4.0F * -0.3F + laws.pidt.integral_n, see_n(0.9F, 310000U));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, laws.pidt.rate_mps);
}

void test_between_two_heights_pidt_holds_its_thrust(void)
{
    (void)see_n(0.49F, 0U);
    const float before_n = see_n(0.5F, 120000U);
    at_mm(400.0F);
    height_is_new(false, 80000U);
    TEST_ASSERT_EQUAL_FLOAT(before_n, step_n());
}

/* The window is 2.83 N to either side of GRAV, within the actuator's. */
void test_pidt_stays_in_a_window_about_gravity(void)
{
    static const struct {
        float gravity_n, aim_m, thrust_n;
    } rows[] = {
        {7.0F, 3.0F, 9.8267F}, {7.0F, -3.0F, 4.1733F}, {2.0F, -3.0F, 0.0F}, {9.0F, 3.0F, THRUST_MAX_N}};

    for (int i = 0; i < 4; i++) {
        setUp();
        set(PARAMETER_PKP, 50.0F);
        set(PARAMETER_GRAV, rows[i].gravity_n);
        now.aim_m = rows[i].aim_m;
        NEAR(rows[i].thrust_n, see_n(0.5F, 0U));
    }
}

void test_in_place_of_est_pidt_has_all_of_its_gains(void)
{
    set(PARAMETER_LAW, (float)LAW_EST);
    gains = (pidt_gains_t){4.0F, 1.0F, 3.0F, GRAV_N, 10.0F, 4.0F};
    (void)expected_n(0.49F, 0.0F);
    (void)see_n(0.49F, 0U);
    NEAR(expected_n(0.5F, 0.12F), see_n(0.5F, 120000U));
    NEAR(expected_n(0.52F, 0.1F), see_n(0.52F, 100000U));
}

/* What is held is at most half a newton from hover after 0.17 s without a height. */
void test_pidt_does_not_hold_a_push_while_heights_are_late(void)
{
    static const struct {
        uint32_t age_us;
        bool airborne;
        float aim_m, held_n, then_n;
    } rows[] = {{170000U, true, 3.0F, 9.8267F, 9.8267F},
                {170001U, true, 3.0F, 9.8267F, 7.7F},
                {170001U, true, -3.0F, 4.1733F, 6.7F},
                {170001U, false, 3.0F, 9.8267F, 9.8267F}};
    for (int i = 0; i < 4; i++) {
        setUp();
        hovers_at_n(7.2F);
        set(PARAMETER_PKP, 50.0F);
        now.aim_m = rows[i].aim_m;
        NEAR(rows[i].held_n, see_n(0.5F, 0U));
        height_is_new(false, rows[i].age_us);
        airborne(rows[i].airborne);
        NEAR(rows[i].then_n, step_n());
    }
}
