/* ADC A, and what it refuses as the real one would, or TI's data sheet forbids. */
#include <setjmp.h>
#include <signal.h>

#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "unity.h"

static sigjmp_buf out;

static void aborted(int signal_number)
{
    (void)signal_number;
    siglongjmp(out, 1);
}

static void ignore(int interrupt)
{
    (void)interrupt;
}

static void wait(sim_time_t length)
{
    timeline_move_to(timeline_now() + length);
}

void setUp(void)
{
    timeline_reset();
    chip_reset(ignore);
    SysCtl_disableWatchdog();
    (void)SysCtl_setClock(DEVICE_SETCLOCK_CFG);
    chip_drive_analog(0, 1.65, 50.0);
    chip_drive_analog(1, 0.825, 50.0);
}

void tearDown(void) {}

typedef struct {
    ADC_ClkPrescale divider;
    uint32_t window;
    ADC_Channel channel;
    bool clocked, trimmed, late, powered, waits;
} steps_t;

static const steps_t right = {ADC_CLK_DIV_4_0, 15, ADC_CH_ADCIN0, true, true, true, true, true};

static void set_up(const steps_t *steps)
{
    if (steps->clocked) {
        SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_ADCA);
    }
    ADC_setPrescaler(ADCA_BASE, steps->divider);
    if (steps->trimmed) {
        ADC_setMode(ADCA_BASE, ADC_RESOLUTION_12BIT, ADC_MODE_SINGLE_ENDED);
    }
    if (steps->late) {
        ADC_setInterruptPulseMode(ADCA_BASE, ADC_PULSE_END_OF_CONV);
    }
    if (steps->powered) {
        ADC_enableConverter(ADCA_BASE);
    }
    wait(steps->waits ? 500 * SIM_US : 499 * SIM_US);
    ADC_setupSOC(ADCA_BASE, ADC_SOC_NUMBER0, ADC_TRIGGER_SW_ONLY, steps->channel, steps->window);
    ADC_setInterruptSource(ADCA_BASE, ADC_INT_NUMBER1, 0);
    ADC_enableInterrupt(ADCA_BASE, ADC_INT_NUMBER1);
}

static uint16_t convert(void)
{
    ADC_forceSOC(ADCA_BASE, ADC_SOC_NUMBER0);
    wait(3 * SIM_US);
    TEST_ASSERT_TRUE(ADC_getInterruptStatus(ADCA_BASE, ADC_INT_NUMBER1));
    ADC_clearInterruptStatus(ADCA_BASE, ADC_INT_NUMBER1);
    return ADC_readResult(ADCARESULT_BASE, ADC_SOC_NUMBER0);
}

void test_it_converts_the_channel_that_was_chosen(void)
{
    steps_t steps = right;

    set_up(&steps);
    TEST_ASSERT_EQUAL_UINT16(2048, convert());
    chip_drive_analog(0, -1.0, 50.0);
    TEST_ASSERT_EQUAL_UINT16(0, convert());
    chip_drive_analog(0, 9.0, 50.0);
    TEST_ASSERT_EQUAL_UINT16(4095, convert());
    steps.channel = ADC_CH_ADCIN1;
    set_up(&steps);
    TEST_ASSERT_EQUAL_UINT16(1024, convert());
}

/* 75 ns and 10.5 periods of 20 ns. */
void test_a_result_is_there_when_its_conversion_has_ended_and_not_before(void)
{
    set_up(&right);
    (void)convert();
    chip_drive_analog(0, 3.0, 50.0);
    ADC_forceSOC(ADCA_BASE, ADC_SOC_NUMBER0);
    wait(284);
    TEST_ASSERT_FALSE(ADC_getInterruptStatus(ADCA_BASE, ADC_INT_NUMBER1));
    TEST_ASSERT_EQUAL_UINT16(2048, ADC_readResult(ADCARESULT_BASE, ADC_SOC_NUMBER0));
    wait(1);
    TEST_ASSERT_TRUE(ADC_getInterruptStatus(ADCA_BASE, ADC_INT_NUMBER1));
    TEST_ASSERT_TRUE(ADC_readResult(ADCARESULT_BASE, ADC_SOC_NUMBER0) > 3700);
}

void test_a_source_of_high_resistance_needs_a_longer_window(void)
{
    steps_t steps = right;

    chip_drive_analog(0, 1.65, 10000.0);
    set_up(&steps);
    TEST_ASSERT_TRUE(convert() < 1100);
    steps.window = 512;
    set_up(&steps);
    TEST_ASSERT_EQUAL_UINT16(2048, convert());
}

void test_without_its_clock_it_ignores_what_is_written_and_reads_as_nothing(void)
{
    steps_t steps = right;

    steps.clocked = false;
    set_up(&steps);
    ADC_forceSOC(ADCA_BASE, ADC_SOC_NUMBER0);
    wait(3 * SIM_US);
    TEST_ASSERT_FALSE(ADC_getInterruptStatus(ADCA_BASE, ADC_INT_NUMBER1));
    TEST_ASSERT_EQUAL_UINT16(0, ADC_readResult(ADCARESULT_BASE, ADC_SOC_NUMBER0));
}

void test_a_reset_switches_it_off_and_leaves_the_wires(void)
{
    set_up(&right);
    TEST_ASSERT_EQUAL_UINT16(2048, convert());
    chip_restart();
    TEST_ASSERT_EQUAL_UINT16(0, ADC_readResult(ADCARESULT_BASE, ADC_SOC_NUMBER0));
    (void)SysCtl_setClock(DEVICE_SETCLOCK_CFG);
    set_up(&right);
    TEST_ASSERT_EQUAL_UINT16(2048, convert());
}

static void run(const steps_t *steps)
{
    set_up(steps);
    ADC_forceSOC(ADCA_BASE, ADC_SOC_NUMBER0);
}

static void differential(void)
{
    ADC_setMode(ADCA_BASE, ADC_RESOLUTION_16BIT, ADC_MODE_DIFFERENTIAL);
}
static void other_module(void)
{
    ADC_enableConverter(0x7480U);
}
static void other_start(void)
{
    ADC_forceSOC(ADCA_BASE, ADC_SOC_NUMBER1);
}
static void by_a_timer(void)
{
    ADC_setupSOC(ADCA_BASE, ADC_SOC_NUMBER0, ADC_TRIGGER_CPU1_TINT0, ADC_CH_ADCIN0, 15);
}
static void too_long(void)
{
    ADC_setupSOC(ADCA_BASE, ADC_SOC_NUMBER0, ADC_TRIGGER_SW_ONLY, ADC_CH_ADCIN0, 513);
}
static void other_interrupt(void)
{
    ADC_enableInterrupt(ADCA_BASE, ADC_INT_NUMBER2);
}
static void other_result(void)
{
    (void)ADC_readResult(0xB20U, ADC_SOC_NUMBER0);
}
static void no_such_channel(void)
{
    chip_drive_analog(16, 1.0, 1.0);
}

static bool aborts(void (*call)(void), const steps_t *steps)
{
    void (*const before)(int) = signal(SIGABRT, aborted);
    volatile bool died = true;

    if (sigsetjmp(out, 1) == 0) {
        if (call != NULL) {
            call();
        } else {
            run(steps);
        }
        died = false;
    }
    (void)signal(SIGABRT, before);
    return died;
}

void test_what_the_data_sheet_forbids_aborts(void)
{
    steps_t wrong[7];

    for (int i = 0; i < 7; i++) {
        wrong[i] = right;
    }
    wrong[0].divider = ADC_CLK_DIV_2_0; /* 100 MHz */
    wrong[1].window = 14;
    wrong[2].trimmed = false;
    wrong[3].late = false;
    wrong[4].powered = false;
    wrong[5].waits = false;
    TEST_ASSERT_FALSE(aborts(NULL, &wrong[6]));
    for (int i = 0; i < 6; i++) {
        setUp();
        TEST_ASSERT_TRUE(aborts(NULL, &wrong[i]));
    }
}

void test_what_the_model_does_not_know_aborts(void)
{
    static void (*const CASES[])(void) = {differential, other_module,    other_start,  by_a_timer,
                                          too_long,     other_interrupt, other_result, no_such_channel};

    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_ADCA);
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        TEST_ASSERT_TRUE(aborts(CASES[i], NULL));
    }
}
