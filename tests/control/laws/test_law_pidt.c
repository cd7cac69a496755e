#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_pidt_gets_its_gains_the_time_between_rays_and_a_window_about_gravity(void)
{
    set(PARAMETER_LAW, (float)LAW_PIDT);
    set(PARAMETER_PKP, 4.0F);
    set(PARAMETER_PKI, 1.0F);
    set(PARAMETER_PKD, 3.0F);
    f.laws.pidt = (pidt_state_t){.integral_n = 0.2F, .height_m = 0.49F, .rate_mps = 0.05F, .primed = true};
    f.laws.pidt_rays_us = 1000000U;
    f.est.rays_us = 1120000U;
    f.where.supervisor.height.is_new = true;
    pidt_state_t pidt = f.laws.pidt;
    const pidt_gains_t gains = {4.0F, 1.0F, 3.0F, 7.0F, 10.0F, 4.0F};
    const float expected_n = pidt_step(&pidt, &gains, 0.6F, 0.5F, 0.12F);
    step_pidt(0.6F);
    NEAR(expected_n, f.laws.setpoint_n);
    NEAR(pidt.integral_n, f.laws.pidt.integral_n);
    NEAR(pidt.rate_mps, f.laws.pidt.rate_mps);
    TEST_ASSERT_EQUAL_UINT32(1120000U, f.laws.pidt_rays_us);
    f.where.supervisor.height.age_us = 80000U;
    f.laws.setpoint_n = 1.0F;
    f.where.supervisor.height.is_new = false;
    step_pidt(0.6F);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, f.laws.setpoint_n);
    set(PARAMETER_PKP, 50.0F);
    f.laws.pidt.primed = false;
    step_pidt(3.0F);
    NEAR(10.0F, f.laws.setpoint_n);
    f.laws.pidt.primed = false;
    step_pidt(-3.0F);
    NEAR(4.0F, f.laws.setpoint_n);
    set(PARAMETER_GRAV, 2.0F);
    f.laws.pidt.primed = false;
    step_pidt(-3.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.laws.setpoint_n);
    set(PARAMETER_GRAV, 9.0F);
    f.laws.pidt.primed = false;
    step_pidt(3.0F);
    NEAR(THRUST_MAX_N, f.laws.setpoint_n);
}

void test_in_place_of_est_pidt_has_0_65_of_its_gains(void)
{
    set(PARAMETER_LAW, (float)LAW_EST);
    set(PARAMETER_PKP, 4.0F);
    set(PARAMETER_PKI, 1.0F);
    set(PARAMETER_PKD, 3.0F);
    f.laws.pidt = (pidt_state_t){.integral_n = 0.2F, .height_m = 0.49F, .rate_mps = 0.05F, .primed = true};
    f.est.rays_us = 120000U;
    f.where.supervisor.height.is_new = true;
    pidt_state_t pidt = f.laws.pidt;
    const pidt_gains_t gains = {2.6F, 0.65F, 1.95F, 7.0F, 10.0F, 4.0F};
    const float expected_n = pidt_step(&pidt, &gains, 0.6F, 0.5F, 0.12F);
    step_pidt(0.6F);
    NEAR(expected_n, f.laws.setpoint_n);
    NEAR(pidt.integral_n, f.laws.pidt.integral_n);
}

void test_a_long_gap_of_rays_counts_as_300_ms(void)
{
    float setpoint_n[2];
    for (uint32_t i = 0U; i < 2U; i++) {
        setUp();
        f.laws.pidt = (pidt_state_t){.height_m = 0.4F, .primed = true};
        f.est.rays_us = 300000U + 500000U * i;
        f.where.supervisor.height.is_new = true;
        step_pidt(0.6F);
        setpoint_n[i] = f.laws.setpoint_n;
    }
    NEAR(setpoint_n[0], setpoint_n[1]);
}

void test_pidt_holds_no_push_while_heights_are_late(void)
{
    f.laws.pidt.primed = true;
    f.where.hover.thrust_n = 7.2F;
    f.laws.setpoint_n = 9.0F;
    f.where.supervisor.height.age_us = 170000U;
    step_pidt(0.6F);
    NEAR(9.0F, f.laws.setpoint_n);
    f.where.supervisor.height.age_us = 170001U;
    step_pidt(0.6F);
    NEAR(7.7F, f.laws.setpoint_n);
    f.laws.setpoint_n = 4.0F;
    step_pidt(0.6F);
    NEAR(6.7F, f.laws.setpoint_n);
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
        f.laws.pidt.primed = true;
        f.where.supervisor.height.age_us = rows[i].age_us;
        f.est.airborne = rows[i].airborne;
        f.laws.setpoint_n = rows[i].setpoint_n;
        step_pidt(0.6F);
        NEAR(rows[i].then_n, f.laws.setpoint_n);
    }
}
