/* The throttle pulse as it leaves GPIO2. */
#include "bsp/throttle.h"

#include <math.h>
#include <string.h>

#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/model.h"
#include "sim/timeline.h"
#include "unity.h"

#define PERIOD_NS 13599840 /* (28332 + 1) * 480 ns */
#define IDLE_NS 1999680    /* 4166 * 480 ns */
#define FULL_NS 999360     /* 2082 * 480 ns */
#define LOG 16

static sim_time_t pulses[LOG], ends[LOG];
static unsigned pulse_count;

static void on_pulse(void *context, sim_time_t high_ns)
{
    (void)context;
    if (pulse_count < LOG) {
        pulses[pulse_count] = high_ns;
        ends[pulse_count] = timeline_now();
    }
    pulse_count++;
}

static void ignore(int interrupt)
{
    (void)interrupt;
}

static void run_until(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

static void power_up(void)
{
    timeline_reset();
    chip_reset(ignore);
    chip_pwm_connect(on_pulse, NULL);
    pulse_count = 0;
    GPIO_setDirectionMode(2, GPIO_DIR_MODE_OUT);
}

void setUp(void)
{
    power_up();
    TEST_ASSERT_TRUE(SysCtl_setClock(DEVICE_SETCLOCK_CFG));
    bsp_throttle_init();
}

void tearDown(void) {}

void test_registers_are_those_of_the_seed(void)
{
    TEST_ASSERT_EQUAL_UINT32(28332, chip_register("EPWM2.TBPRD"));
    TEST_ASSERT_EQUAL_UINT32(4166, chip_register("EPWM2.CMPA"));
    /* free run, CLKDIV /8, HSPCLKDIV /6, period shadowed, up-count: TI's code on simulated registers gives
     * the same */
    TEST_ASSERT_EQUAL_HEX32(0x8D80, chip_register("EPWM2.TBCTL"));
    TEST_ASSERT_EQUAL_HEX32(0x0012, chip_register("EPWM2.AQCTLA"));
    TEST_ASSERT_EQUAL_HEX32(0x0000, chip_register("EPWM2.CMPCTL")); /* shadowed, loaded at zero */
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("PERCLKDIVSEL") & 3);
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("GPIO2.MUX"));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("PCLKCR2") >> 1 & 1);
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("PCLKCR0") >> 18 & 1);
}

void test_every_pulse_from_the_first_on_is_a_whole_idle_pulse(void)
{
    run_until(200 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(15, pulse_count);
    for (unsigned i = 0; i < pulse_count; i++) {
        TEST_ASSERT_EQUAL_INT64(IDLE_NS, pulses[i]);
        TEST_ASSERT_EQUAL_INT64(IDLE_NS + PERIOD_NS * (sim_time_t)i, ends[i]);
    }
}

void test_full_thrust_is_the_short_pulse(void)
{
    bsp_throttle_set_pulse_us(999.36F);
    run_until(30 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT32(2082, chip_register("EPWM2.CMPA"));
    TEST_ASSERT_EQUAL_INT64(IDLE_NS, pulses[0]); /* the one under way is not touched */
    TEST_ASSERT_EQUAL_INT64(FULL_NS, pulses[1]);
    TEST_ASSERT_EQUAL_INT64(PERIOD_NS + FULL_NS, ends[1]);
}

void test_idle_follows_from_the_next_period_on(void)
{
    bsp_throttle_set_pulse_us(1500.0F);
    run_until(20 * SIM_MS);
    bsp_throttle_idle();
    run_until(40 * SIM_MS);
    TEST_ASSERT_EQUAL_INT64(3125 * 480, pulses[1]);
    TEST_ASSERT_EQUAL_INT64(IDLE_NS, pulses[2]);
}

void test_a_change_at_any_instant_of_the_period_makes_no_other_pulse_than_the_two(void)
{
    for (sim_time_t at = 0; at < PERIOD_NS; at += 10 * SIM_US + 7) {
        setUp();
        run_until(at);
        bsp_throttle_set_pulse_us(1200.0F);
        run_until(40 * SIM_MS);
        TEST_ASSERT_EQUAL_INT64(IDLE_NS, pulses[0]);
        TEST_ASSERT_EQUAL_INT64(1200 * SIM_US, pulses[1]);
        TEST_ASSERT_EQUAL_INT64(1200 * SIM_US, pulses[2]);
    }
}

void test_every_width_is_the_nearest_count_within_the_two_ends(void)
{
    uint32_t last = 0;
    for (int i = 0; i <= 300000; i++) {
        const float pulse_us = 800.0F + (float)i * 0.005F;
        const double counts = fmin(fmax((double)pulse_us / 0.48, 2082.0), 4166.0);
        bsp_throttle_set_pulse_us(pulse_us);
        const uint32_t compare = chip_register("EPWM2.CMPA");
        TEST_ASSERT_DOUBLE_WITHIN(0.5005, counts, (double)compare);
        TEST_ASSERT_TRUE(compare >= last);
        last = compare;
    }
    TEST_ASSERT_EQUAL_UINT32(4166, last);
}

void test_what_is_no_number_or_out_of_range_ends_at_the_ends(void)
{
    static const struct {
        float pulse_us;
        uint32_t compare;
    } CASES[] = {{1999.68F, 4166}, {1999.45F, 4166}, {1999.43F, 4165}, {2000.0F, 4166},
                 {1e30F, 4166},    {INFINITY, 4166}, {NAN, 4166},      {-NAN, 4166},
                 {999.36F, 2082},  {999.0F, 2082},   {0.0F, 2082},     {-1e30F, 2082}};
    for (unsigned i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        bsp_throttle_set_pulse_us(1500.0F);
        bsp_throttle_set_pulse_us(CASES[i].pulse_us);
        TEST_ASSERT_EQUAL_UINT32(CASES[i].compare, chip_register("EPWM2.CMPA"));
    }
}

void test_without_crystal_the_idle_pulse_is_never_under_two_milliseconds(void)
{
    power_up();
    sysctl_fail_crystal();
    bsp_throttle_init();
    run_until(100 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(8, pulse_count);
    for (unsigned i = 0; i < pulse_count; i++) {
        TEST_ASSERT_EQUAL_INT64(2060 * SIM_US,
                                pulses[i]); /* the oscillator is good for 3 %: 2.00 .. 2.12 ms */
        TEST_ASSERT_EQUAL_INT64(2060 * SIM_US + 13600 * SIM_US * (sim_time_t)i, ends[i]);
    }
}

void test_a_pin_that_is_not_yet_output_gives_no_pulse_at_the_hand_over(void)
{
    power_up();
    GPIO_setDirectionMode(2, GPIO_DIR_MODE_IN);
    TEST_ASSERT_TRUE(SysCtl_setClock(DEVICE_SETCLOCK_CFG));
    bsp_throttle_init();
    TEST_ASSERT_EQUAL_UINT(0, pulse_count);
}
