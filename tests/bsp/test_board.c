/* The board after start-up on the chip model, and the throttle pin from power-on. */
#include "bsp/board.h"

#include <setjmp.h>
#include <signal.h>
#include <sys/time.h>

#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/model.h"
#include "sim/timeline.h"
#include "bsp/throttle.h"
#include "bsp/timebase.h"
#include "unity.h"

#define IDLE_NS 1999680
#define FULL_NS 999360
#define PERIOD_NS 13599840

static sim_time_t shortest, last_end, last_period;
static unsigned pulse_count;
static int raised_count;

static void on_pulse(void *context, sim_time_t high_ns)
{
    (void)context;
    shortest = high_ns < shortest ? high_ns : shortest;
    last_period = timeline_now() - last_end;
    last_end = timeline_now();
    pulse_count++;
}

static void raise_line(int interrupt)
{
    (void)interrupt;
    raised_count++;
}

static void run_until(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

void setUp(void)
{
    timeline_reset();
    chip_reset(raise_line);
    chip_pwm_connect(on_pulse, NULL);
    shortest = SIM_NEVER;
    pulse_count = 0;
    raised_count = 0;
    run_until(3 * SIM_MS);
}

void tearDown(void) {}

void test_clocks(void)
{
    bsp_board_init();
    TEST_ASSERT_EQUAL_UINT32(200000000, SysCtl_getClock(DEVICE_OSCSRC_FREQ));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("LOSPCP"));
    TEST_ASSERT_EQUAL_UINT32(100000000, sysctl_lspclk_hz());
    TEST_ASSERT_EQUAL_HEX32(0x51, chip_register("PERCLKDIVSEL"));
    TEST_ASSERT_EQUAL_UINT32(100000000, sysctl_epwmclk_hz());
    TEST_ASSERT_EQUAL_HEX32(0x40, chip_register("WDCR"));
    TEST_ASSERT_EQUAL_HEX32(0x7, chip_register("PCLKCR7"));
    TEST_ASSERT_EQUAL_HEX32(0x40038, chip_register("PCLKCR0"));
}

void test_pins_of_the_three_uarts(void)
{
    static const struct {
        const char *mux;
        uint32_t value;
        const char *pull_up, *qualification;
    } PINS[] = {
        {"GPIO65.MUX", 6, NULL, NULL}, {"GPIO64.MUX", 6, "GPIO64.PUD", "GPIO64.QSEL"},
        {"GPIO86.MUX", 5, NULL, NULL}, {"GPIO87.MUX", 5, "GPIO87.PUD", "GPIO87.QSEL"},
        {"GPIO89.MUX", 6, NULL, NULL}, {"GPIO90.MUX", 6, "GPIO90.PUD", "GPIO90.QSEL"},
    };
    bsp_board_init();
    for (unsigned i = 0; i < sizeof PINS / sizeof PINS[0]; i++) {
        TEST_ASSERT_EQUAL_UINT32(PINS[i].value, chip_register(PINS[i].mux));
        if (PINS[i].pull_up != NULL) {
            TEST_ASSERT_EQUAL_UINT32(0, chip_register(PINS[i].pull_up));
            TEST_ASSERT_EQUAL_UINT32(GPIO_QUAL_ASYNC, chip_register(PINS[i].qualification));
        }
    }
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO84.MUX")); /* the USB port and boot pin stay alone */
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO72.MUX"));
}

void test_the_selector_is_an_input(void)
{
    bsp_board_init();
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO3.PUD"));
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO3.DIR"));
    TEST_ASSERT_EQUAL_UINT32(GPIO_QUAL_6SAMPLE, chip_register("GPIO3.QSEL"));
}

void test_uarts_are_closed_and_quiet(void)
{
    bsp_board_init();
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chip_sci_rate(SCIA_BASE));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chip_sci_rate(SCIB_BASE));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chip_sci_rate(SCIC_BASE));
    TEST_ASSERT_TRUE(chip_pin(65));
    TEST_ASSERT_EQUAL_INT(0, raised_count);
}

/* Whoever listens there takes a start bit, and a wrong octet, from the shortest low. */
void test_no_transmit_pin_is_low_for_an_instant(void)
{
    bsp_board_init();
    TEST_ASSERT_EQUAL_UINT(0, chip_pin_falls(65));
    TEST_ASSERT_EQUAL_UINT(0, chip_pin_falls(86));
    TEST_ASSERT_EQUAL_UINT(0, chip_pin_falls(89));
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, chip_pin_falls(2), "the throttle pin is held low at first");
}

void test_pins_without_a_leg_are_pulled_up_and_the_others_are_as_they_were(void)
{
    bsp_board_init();
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO0.PUD"));
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO88.PUD"));
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO168.PUD"));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("GPIO2.PUD"));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("GPIO4.PUD"));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("GPIO84.PUD"));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("GPIO99.PUD"));
}

void test_leds_are_dark(void)
{
    bsp_board_init();
    TEST_ASSERT_TRUE(chip_pin(12));
    TEST_ASSERT_TRUE(chip_pin(13));
}

void test_time_starts_at_zero_and_runs(void)
{
    bsp_board_init();
    TEST_ASSERT_EQUAL_UINT32(0, bsp_time_us());
    run_until(3 * SIM_MS + 1234567);
    TEST_ASSERT_EQUAL_UINT32(1234, bsp_time_us());
}

void test_no_pulse_before_the_first_whole_idle_pulse(void)
{
    bsp_board_init();
    TEST_ASSERT_EQUAL_UINT(0, pulse_count);
    run_until(3 * SIM_MS + IDLE_NS - 1);
    TEST_ASSERT_EQUAL_UINT(0, pulse_count);
    TEST_ASSERT_TRUE(chip_pin(2));
    run_until(10 * SIM_S);
    TEST_ASSERT_EQUAL_UINT(735, pulse_count);
    TEST_ASSERT_EQUAL_INT64(IDLE_NS, shortest);
    TEST_ASSERT_EQUAL_INT64(PERIOD_NS, last_period);
}

void test_full_thrust_reaches_the_pin(void)
{
    bsp_board_init();
    bsp_throttle_set_pulse_us(900.0F);
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_INT64(FULL_NS, shortest);
}

static sigjmp_buf out;

static void escape(int signal_number)
{
    (void)signal_number;
    siglongjmp(out, 1);
}

/* The loop that never ends is left by a timer of the test. */
static void init_for_a_while(void)
{
    const struct itimerval soon = {{0, 0}, {0, 50000}};
    (void)signal(SIGALRM, escape);
    if (sigsetjmp(out, 1) == 0) {
        TEST_ASSERT_EQUAL_INT(0, setitimer(ITIMER_REAL, &soon, NULL));
        bsp_board_init();
        TEST_FAIL_MESSAGE("returned");
    }
}

void test_without_crystal_it_stays_with_idle_pulses_and_the_red_led(void)
{
    sysctl_fail_crystal();
    init_for_a_while();
    TEST_ASSERT_FALSE(chip_pin(12));
    TEST_ASSERT_TRUE(chip_pin(13));
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_UINT(74, pulse_count);
    TEST_ASSERT_EQUAL_INT64(2060 * SIM_US, shortest);
    TEST_ASSERT_EQUAL_INT64(13600 * SIM_US, last_period);
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO65.MUX"));
}
