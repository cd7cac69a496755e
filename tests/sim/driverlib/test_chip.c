/* The chip model against data sheet figures and the traps of the real peripherals. SCIC on GPIO89/90 unless
 * said. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/model.h"
#include "sim/timeline.h"
#include "unity.h"

#define LSPCLK 100000000U
#define FORMAT (SCI_CONFIG_WLEN_8 | SCI_CONFIG_STOP_ONE | (uint32_t)SCI_CONFIG_PAR_NONE)
#define RX_INT 92
#define TX_INT 93
#define BIT_9600 104160.0 /* (1301 + 1) * 80 ns */
#define LOG 64

static int raised[256];
static unsigned sent[LOG], sent_count;
static sim_time_t sent_at[LOG];
static double sent_bit_ns;
static sim_time_t pulses[LOG], pulse_end[LOG];
static unsigned pulse_count;

static void raise_line(int interrupt)
{
    raised[interrupt]++;
}

static void on_sent(void *context, unsigned octet, double bit_ns)
{
    TEST_ASSERT_EQUAL_PTR(&sent, context);
    TEST_ASSERT_LESS_THAN(LOG, sent_count);
    sent[sent_count] = octet;
    sent_at[sent_count] = timeline_now();
    sent_bit_ns = bit_ns;
    sent_count++;
}

static void on_pulse(void *context, sim_time_t high_ns)
{
    TEST_ASSERT_EQUAL_PTR(&pulses, context);
    if (pulse_count < LOG) {
        pulses[pulse_count] = high_ns;
        pulse_end[pulse_count] = timeline_now();
    }
    pulse_count++;
}

static void run_until(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

static void run_for(sim_time_t delay)
{
    run_until(timeline_now() + delay);
}

static void open_sci(uint32_t base, uint32_t rate)
{
    SCI_setConfig(base, LSPCLK, rate, FORMAT);
    SCI_setBaud(base, LSPCLK, rate);
    SCI_enableFIFO(base);
    SCI_setFIFOInterruptLevel(base, SCI_FIFO_TX0, SCI_FIFO_RX1);
    SCI_performSoftwareReset(base);
    SCI_clearInterruptStatus(base, SCI_INT_RXFF | SCI_INT_TXFF);
}

static void clocks_200_mhz(void)
{
    TEST_ASSERT_TRUE(SysCtl_setClock(DEVICE_SETCLOCK_CFG));
    SysCtl_setLowSpeedClock(SYSCTL_LSPCLK_PRESCALE_2);
}

void setUp(void)
{
    timeline_reset();
    chip_reset(raise_line);
    chip_drive_pin(90, true);
    chip_sci_connect(SCIC_BASE, on_sent, &sent);
    chip_pwm_connect(on_pulse, &pulses);
    memset(raised, 0, sizeof raised);
    sent_count = pulse_count = 0;
    clocks_200_mhz();
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_SCIC);
    GPIO_setPinConfig(GPIO_89_SCITXDC);
    GPIO_setPinConfig(GPIO_90_SCIRXDC);
    open_sci(SCIC_BASE, 9600);
}

void tearDown(void) {}

static void arrive(unsigned octet)
{
    run_for(llround(10 * BIT_9600));
    chip_sci_receive(SCIC_BASE, octet, BIT_9600);
}

/* ---- clocks ---- */

void test_after_reset_the_chip_runs_on_ten_megahertz(void)
{
    chip_reset(raise_line);
    TEST_ASSERT_EQUAL_UINT32(10000000, SysCtl_getClock(DEVICE_OSCSRC_FREQ));
    TEST_ASSERT_EQUAL_UINT32(2500000, sysctl_lspclk_hz());
    TEST_ASSERT_EQUAL_UINT32(5000000, sysctl_epwmclk_hz());
    TEST_ASSERT_EQUAL_UINT32(2, chip_register("LOSPCP"));
    TEST_ASSERT_EQUAL_UINT32(0x51, chip_register("PERCLKDIVSEL"));
    TEST_ASSERT_EQUAL_UINT32(0x38, chip_register("PCLKCR0"));
    TEST_ASSERT_EQUAL_UINT32(0x0083, chip_register("EPWM2.TBCTL"));
    TEST_ASSERT_EQUAL_UINT32(0xA000, chip_register("SCIA.FFTX"));
    TEST_ASSERT_EQUAL_UINT32(0x201F, chip_register("SCIA.FFRX"));
    TEST_ASSERT_EQUAL_UINT32(0xC0, chip_register("SCIA.CTL2"));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("GPIO64.PUD"));
}

void test_the_pll_word_of_the_launchpad_gives_200_megahertz(void)
{
    TEST_ASSERT_EQUAL_UINT32(200000000, SysCtl_getClock(DEVICE_OSCSRC_FREQ));
    TEST_ASSERT_EQUAL_UINT32(0x0028, chip_register("SYSPLLMULT"));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("SYSCLKDIVSEL"));
    TEST_ASSERT_EQUAL_UINT32(3, chip_register("SYSPLLCTL1"));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("CLKSRCCTL1"));
    TEST_ASSERT_EQUAL_INT64(0, timeline_now());
}

void test_fractional_multiplier_and_bypass(void)
{
    const uint32_t half = 0x4000U;
    TEST_ASSERT_TRUE(
        SysCtl_setClock(SYSCTL_OSCSRC_XTAL | SYSCTL_IMULT(20) | half | SYSCTL_SYSDIV(2) | SYSCTL_PLL_ENABLE));
    TEST_ASSERT_EQUAL_UINT32(102500000, SysCtl_getClock(DEVICE_OSCSRC_FREQ));
    TEST_ASSERT_TRUE(SysCtl_setClock(SYSCTL_OSCSRC_OSC2 | SYSCTL_SYSDIV(4) | SYSCTL_PLL_DISABLE));
    TEST_ASSERT_EQUAL_UINT32(2500000, SysCtl_getClock(DEVICE_OSCSRC_FREQ));
}

void test_a_failed_crystal_is_reported_and_leaves_ten_megahertz(void)
{
    sysctl_fail_crystal();
    TEST_ASSERT_FALSE(SysCtl_setClock(DEVICE_SETCLOCK_CFG));
    TEST_ASSERT_EQUAL_UINT32(10000000, SysCtl_getClock(DEVICE_OSCSRC_FREQ));
}

void test_low_speed_and_pwm_clocks_follow_their_dividers(void)
{
    static const uint32_t HZ[] = {200000000, 100000000, 50000000, 33333333,
                                  25000000,  20000000,  16666666, 14285714};
    for (unsigned i = 0; i < 8; i++) {
        SysCtl_setLowSpeedClock((SysCtl_LSPCLKPrescaler)i);
        TEST_ASSERT_EQUAL_UINT32(HZ[i], sysctl_lspclk_hz());
    }
    TEST_ASSERT_EQUAL_UINT32(100000000, sysctl_epwmclk_hz());
    SysCtl_setEPWMClockDivider(SYSCTL_EPWMCLK_DIV_1);
    TEST_ASSERT_EQUAL_UINT32(200000000, sysctl_epwmclk_hz());
    TEST_ASSERT_EQUAL_UINT32(0x50, chip_register("PERCLKDIVSEL"));
}

/* ---- timers ---- */

void test_a_timer_counts_down_at_sysclk_over_prescaler_plus_one(void)
{
    CPUTimer_setPeriod(CPUTIMER0_BASE, 0xFFFFFFFFU);
    CPUTimer_setPreScaler(CPUTIMER0_BASE, 199);
    TEST_ASSERT_EQUAL_UINT32(0xFFFF,
                             CPUTimer_getTimerCount(CPUTIMER0_BASE)); /* a period waits for the reload */
    CPUTimer_startTimer(CPUTIMER0_BASE);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFFFFU, CPUTimer_getTimerCount(CPUTIMER0_BASE));
    run_for(999);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFFFFU, CPUTimer_getTimerCount(CPUTIMER0_BASE));
    run_for(1);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFFFEU, CPUTimer_getTimerCount(CPUTIMER0_BASE));
    run_for(3600 * SIM_S);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFFFEU - 3600000000U, CPUTimer_getTimerCount(CPUTIMER0_BASE));
}

void test_a_timer_reloads_its_period_after_zero_and_stops(void)
{
    CPUTimer_setPeriod(CPUTIMER2_BASE, 9);
    CPUTimer_setPreScaler(CPUTIMER2_BASE, 0);
    CPUTimer_startTimer(CPUTIMER2_BASE);
    run_for(9 * 5);
    TEST_ASSERT_EQUAL_UINT32(0, CPUTimer_getTimerCount(CPUTIMER2_BASE));
    run_for(5);
    TEST_ASSERT_EQUAL_UINT32(9, CPUTimer_getTimerCount(CPUTIMER2_BASE));
    run_for(1004 * 5);
    TEST_ASSERT_EQUAL_UINT32(5, CPUTimer_getTimerCount(CPUTIMER2_BASE));
    CPUTimer_stopTimer(CPUTIMER2_BASE);
    run_for(SIM_MS);
    TEST_ASSERT_EQUAL_UINT32(5, CPUTimer_getTimerCount(CPUTIMER2_BASE));
    CPUTimer_resumeTimer(CPUTIMER2_BASE);
    run_for(2 * 5);
    TEST_ASSERT_EQUAL_UINT32(3, CPUTimer_getTimerCount(CPUTIMER2_BASE));
    SysCtl_disablePeripheral(SYSCTL_PERIPH_CLK_TIMER2);
    run_for(SIM_MS);
    TEST_ASSERT_EQUAL_UINT32(3, CPUTimer_getTimerCount(CPUTIMER2_BASE));
}

void test_setting_the_clock_spoils_the_counts_of_timers_1_and_2_only(void)
{
    const uint32_t bases[] = {CPUTIMER0_BASE, CPUTIMER1_BASE, CPUTIMER2_BASE};
    for (unsigned i = 0; i < 3; i++) {
        CPUTimer_setPeriod(bases[i], 1000000);
        CPUTimer_startTimer(bases[i]);
    }
    clocks_200_mhz();
    TEST_ASSERT_EQUAL_UINT32(1000000, CPUTimer_getTimerCount(CPUTIMER0_BASE));
    TEST_ASSERT_NOT_EQUAL_UINT32(1000000, CPUTimer_getTimerCount(CPUTIMER1_BASE));
    TEST_ASSERT_NOT_EQUAL_UINT32(1000000, CPUTimer_getTimerCount(CPUTIMER2_BASE));
    for (unsigned i = 0; i < 3; i++) {
        CPUTimer_reloadTimerCounter(bases[i]);
        TEST_ASSERT_EQUAL_UINT32(1000000, CPUTimer_getTimerCount(bases[i]));
    }
}

/* ---- baud rate ---- */

/* TI's own code on simulated registers: truncated 107 49 216 1301, rounded 108 49 216 1301 at LSPCLK 100 MHz.
 */
void test_set_config_truncates_and_set_baud_rounds(void)
{
    static const uint32_t RATE[] = {115200, 250000, 57600, 9600};
    static const uint32_t TRUNCATED[] = {107, 49, 216, 1301}, ROUNDED[] = {108, 49, 216, 1301};
    for (unsigned i = 0; i < 4; i++) {
        SCI_setConfig(SCIC_BASE, LSPCLK, RATE[i], FORMAT);
        TEST_ASSERT_EQUAL_UINT32(TRUNCATED[i], chip_register("SCIC.BRR"));
        SCI_setBaud(SCIC_BASE, LSPCLK, RATE[i]);
        TEST_ASSERT_EQUAL_UINT32(ROUNDED[i], chip_register("SCIC.BRR"));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * RATE[i], 1e8 / (8.0 * (ROUNDED[i] + 1)), chip_sci_rate(SCIC_BASE));
    }
}

void test_the_rate_follows_lspclk_and_is_zero_in_reset(void)
{
    SysCtl_setLowSpeedClock(SYSCTL_LSPCLK_PRESCALE_4);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 4800.307, chip_sci_rate(SCIC_BASE));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chip_sci_rate(SCIB_BASE));
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_SCIB);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, chip_sci_rate(SCIB_BASE));
}

/* ---- transmitter ---- */

void test_octets_leave_back_to_back_to_the_nanosecond(void)
{
    open_sci(SCIC_BASE, 115200);
    run_for(12345);
    for (unsigned i = 0; i < 3; i++) {
        SCI_writeCharNonBlocking(SCIC_BASE, (uint16_t)(0xFF00U | (0x55U + i)));
    }
    run_for(SIM_MS);
    TEST_ASSERT_EQUAL_UINT(3, sent_count);
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_HEX16(0x55U + i, sent[i]);
        TEST_ASSERT_EQUAL_INT64(12345 + 87200 * (i + 1), sent_at[i]); /* 10 * 109 * 80 ns */
    }
    TEST_ASSERT_EQUAL_DOUBLE(8720.0, sent_bit_ns);
}

void test_the_fifo_holds_16_beside_the_one_on_the_wire(void)
{
    for (unsigned i = 0; i < 18; i++) {
        SCI_writeCharNonBlocking(SCIC_BASE, (uint16_t)i);
    }
    TEST_ASSERT_EQUAL_INT(SCI_FIFO_TX16, SCI_getTxFIFOStatus(SCIC_BASE));
    TEST_ASSERT_EQUAL_UINT32(0, HWREGH(SCIC_BASE + SCI_O_CTL2) & SCI_CTL2_TXRDY);
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(17, sent_count);
    TEST_ASSERT_EQUAL_UINT(16, sent[16]);
}

void test_transmitter_busy_sees_the_fifo_only_but_txempty_the_wire(void)
{
    SCI_writeCharNonBlocking(SCIC_BASE, 'a');
    TEST_ASSERT_FALSE(SCI_isTransmitterBusy(SCIC_BASE));
    TEST_ASSERT_EQUAL_UINT32(0, HWREGH(SCIC_BASE + SCI_O_CTL2) & SCI_CTL2_TXEMPTY);
    SCI_writeCharNonBlocking(SCIC_BASE, 'b');
    TEST_ASSERT_TRUE(SCI_isTransmitterBusy(SCIC_BASE));
    run_for(llround(20 * BIT_9600) - 1);
    TEST_ASSERT_EQUAL_UINT32(0, HWREGH(SCIC_BASE + SCI_O_CTL2) & SCI_CTL2_TXEMPTY);
    run_for(1);
    TEST_ASSERT_NOT_EQUAL_UINT32(0, HWREGH(SCIC_BASE + SCI_O_CTL2) & SCI_CTL2_TXEMPTY);
}

void test_the_transmit_pin_shows_the_bits(void)
{
    TEST_ASSERT_TRUE(chip_pin(89));
    SCI_writeCharNonBlocking(SCIC_BASE, 0xA5);
    run_for(llround(BIT_9600 / 2));
    unsigned bits = 0;
    for (unsigned i = 0; i < 10; i++) {
        bits |= (unsigned)chip_pin(89) << i;
        run_for(llround(BIT_9600));
    }
    TEST_ASSERT_EQUAL_HEX16(0x34A, bits); /* 0, LSB first, 1 */
    TEST_ASSERT_TRUE(chip_pin(89));
}

void test_an_unmuxed_transmit_pin_sends_nothing(void)
{
    GPIO_setPinConfig(GPIO_89_GPIO89);
    SCI_writeCharNonBlocking(SCIC_BASE, 'a');
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    TEST_ASSERT_NOT_EQUAL_UINT32(0, HWREGH(SCIC_BASE + SCI_O_CTL2) & SCI_CTL2_TXEMPTY);
}

void test_a_software_reset_cuts_the_octet_on_the_wire_short_and_keeps_the_fifo(void)
{
    SCI_writeCharNonBlocking(SCIC_BASE, 0x00);
    SCI_writeCharNonBlocking(SCIC_BASE, 0x42);
    run_for(llround(4.5 * BIT_9600)); /* three of the eight bits are out whole */
    SCI_performSoftwareReset(SCIC_BASE);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    TEST_ASSERT_EQUAL_HEX16(0xF8, sent[0]);
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    TEST_ASSERT_EQUAL_HEX16(0x42, sent[1]);
}

void test_the_transmit_interrupt_comes_back_while_the_fifo_is_empty(void)
{
    SCI_enableInterrupt(SCIC_BASE, SCI_INT_TXFF);
    TEST_ASSERT_EQUAL_INT(1, raised[TX_INT]);
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_TXFF);
    TEST_ASSERT_EQUAL_INT(2, raised[TX_INT]);
    for (unsigned i = 0; i < 3; i++) {
        SCI_writeCharNonBlocking(SCIC_BASE, 'x');
    }
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_TXFF);
    TEST_ASSERT_EQUAL_INT(2, raised[TX_INT]);
    run_for(llround(20 * BIT_9600) - 1);
    TEST_ASSERT_EQUAL_INT(2, raised[TX_INT]);
    run_for(1); /* the third goes to the wire */
    TEST_ASSERT_EQUAL_INT(3, raised[TX_INT]);
    SCI_disableInterrupt(SCIC_BASE, SCI_INT_TXFF);
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_TXFF);
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_INT(3, raised[TX_INT]);
    TEST_ASSERT_EQUAL_INT(0, raised[RX_INT]);
}

/* ---- receiver ---- */

void test_every_octet_arrives_as_sent_within_the_tolerance_of_the_rate(void)
{
    static const double OFF[] = {0.0, 0.01, -0.01, 0.044, -0.044};
    for (unsigned i = 0; i < 5; i++) {
        for (unsigned octet = 0; octet < 256; octet++) {
            run_for(2 * SIM_MS);
            chip_sci_receive(SCIC_BASE, octet, BIT_9600 * (1.0 + OFF[i]));
            TEST_ASSERT_EQUAL_INT(SCI_FIFO_RX1, SCI_getRxFIFOStatus(SCIC_BASE));
            TEST_ASSERT_EQUAL_HEX16(octet, SCI_readCharNonBlocking(SCIC_BASE));
            TEST_ASSERT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE));
        }
    }
}

void test_back_to_back_octets_of_a_slightly_fast_or_slow_sender_all_arrive(void)
{
    static const double OFF[] = {0.03, -0.03};
    for (unsigned i = 0; i < 2; i++) {
        const double bit = BIT_9600 * (1.0 + OFF[i]);
        for (unsigned octet = 0; octet < 256; octet++) {
            run_for(llround(10 * bit));
            chip_sci_receive(SCIC_BASE, octet, bit);
            TEST_ASSERT_EQUAL_HEX16(octet, SCI_readCharNonBlocking(SCIC_BASE));
            TEST_ASSERT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE));
        }
    }
}

void test_a_wrong_rate_is_a_framing_error_or_nothing(void)
{
    static const double RATE[] = {4800, 9100, 10100, 19200, 57600, 115200, 250000};
    for (unsigned i = 0; i < sizeof RATE / sizeof RATE[0]; i++) {
        for (unsigned octet = 0; octet < 256; octet++) {
            run_for(10 * SIM_MS);
            chip_sci_receive(SCIC_BASE, octet, 1e9 / RATE[i]);
            if (SCI_getRxFIFOStatus(SCIC_BASE) != SCI_FIFO_RX0) {
                TEST_ASSERT_NOT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE) & SCI_RXSTATUS_FRAMING);
                TEST_ASSERT_NOT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE) & SCI_RXSTATUS_ERROR);
            } else {
                TEST_ASSERT_TRUE(RATE[i] > 9600 * 1.9); /* only a start bit that is too short */
            }
            SCI_resetRxFIFO(SCIC_BASE);
            SCI_performSoftwareReset(SCIC_BASE);
        }
    }
}

void test_the_limit_of_the_rate_is_four_and_a_half_percent(void)
{
    arrive('a');
    run_for(2 * SIM_MS);
    chip_sci_receive(SCIC_BASE, 'b', BIT_9600 * 1.0449);
    TEST_ASSERT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE) & SCI_RXSTATUS_ERROR);
    run_for(2 * SIM_MS);
    chip_sci_receive(SCIC_BASE, 'c', BIT_9600 * 1.0451);
    TEST_ASSERT_NOT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE) & SCI_RXSTATUS_ERROR);
}

void test_an_error_stays_latched_until_a_software_reset_and_costs_no_octet(void)
{
    arrive('a');
    run_for(2 * SIM_MS);
    chip_sci_receive(SCIC_BASE, 'b', BIT_9600 * 1.05);
    arrive('c');
    TEST_ASSERT_EQUAL_INT(SCI_FIFO_RX3, SCI_getRxFIFOStatus(SCIC_BASE)); /* reception went on */
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_RXFF);
    TEST_ASSERT_EQUAL_HEX16(SCI_RXSTATUS_ERROR | SCI_RXSTATUS_FRAMING | SCI_RXSTATUS_READY,
                            SCI_getRxStatus(SCIC_BASE));
    SCI_performSoftwareReset(SCIC_BASE);
    TEST_ASSERT_EQUAL_HEX16(SCI_RXSTATUS_READY, SCI_getRxStatus(SCIC_BASE));
    TEST_ASSERT_EQUAL_UINT32(1301, chip_register("SCIC.BRR"));
    TEST_ASSERT_EQUAL_HEX16('a', SCI_readCharNonBlocking(SCIC_BASE));
    TEST_ASSERT_EQUAL_HEX16('b', SCI_readCharNonBlocking(SCIC_BASE)); /* its flag bit is masked */
    TEST_ASSERT_EQUAL_HEX16('c', SCI_readCharNonBlocking(SCIC_BASE));
    TEST_ASSERT_EQUAL_HEX16(0, SCI_readCharNonBlocking(SCIC_BASE));
}

void test_the_seventeenth_octet_overflows_the_fifo_and_the_first_is_lost(void)
{
    for (unsigned i = 0; i < 16; i++) {
        arrive('A' + i);
    }
    TEST_ASSERT_FALSE(SCI_getOverflowStatus(SCIC_BASE));
    arrive('A' + 16);
    TEST_ASSERT_TRUE(SCI_getOverflowStatus(SCIC_BASE));
    TEST_ASSERT_EQUAL_INT(SCI_FIFO_RX16, SCI_getRxFIFOStatus(SCIC_BASE));
    TEST_ASSERT_EQUAL_HEX16('B', SCI_readCharNonBlocking(SCIC_BASE));
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_RXFF);
    TEST_ASSERT_TRUE(SCI_getOverflowStatus(SCIC_BASE));
    SCI_clearOverflowStatus(SCIC_BASE);
    TEST_ASSERT_FALSE(SCI_getOverflowStatus(SCIC_BASE));
}

void test_the_receive_interrupt_comes_back_while_octets_wait(void)
{
    SCI_enableInterrupt(SCIC_BASE, SCI_INT_RXFF);
    arrive('a');
    TEST_ASSERT_EQUAL_INT(1, raised[RX_INT]);
    arrive('b');
    TEST_ASSERT_EQUAL_INT(1, raised[RX_INT]); /* the flag is still set: no new edge */
    (void)SCI_readCharNonBlocking(SCIC_BASE);
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_RXFF);
    TEST_ASSERT_EQUAL_INT(2, raised[RX_INT]);
    (void)SCI_readCharNonBlocking(SCIC_BASE);
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_RXFF);
    TEST_ASSERT_EQUAL_INT(2, raised[RX_INT]);
    arrive('c');
    TEST_ASSERT_EQUAL_INT(3, raised[RX_INT]);
}

void test_the_receive_level_is_honoured_and_enabling_late_raises_at_once(void)
{
    SCI_setFIFOInterruptLevel(SCIC_BASE, SCI_FIFO_TX0, SCI_FIFO_RX3);
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_RXFF);
    SCI_enableInterrupt(SCIC_BASE, SCI_INT_RXFF);
    arrive('a');
    arrive('b');
    TEST_ASSERT_EQUAL_INT(0, raised[RX_INT]);
    SCI_disableInterrupt(SCIC_BASE, SCI_INT_RXFF);
    arrive('c');
    TEST_ASSERT_EQUAL_INT(0, raised[RX_INT]);
    SCI_enableInterrupt(SCIC_BASE, SCI_INT_RXFF);
    TEST_ASSERT_EQUAL_INT(1, raised[RX_INT]);
}

void test_an_overflow_silences_the_receive_interrupt_until_it_is_cleared(void)
{
    for (unsigned i = 0; i < 17; i++) {
        arrive(i);
    }
    SCI_enableInterrupt(SCIC_BASE, SCI_INT_RXFF);
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_RXFF);
    arrive('x');
    TEST_ASSERT_EQUAL_INT(0, raised[RX_INT]);
    SCI_clearOverflowStatus(SCIC_BASE);
    TEST_ASSERT_EQUAL_INT(1, raised[RX_INT]);
}

void test_a_line_held_low_is_a_framing_error_then_a_break_that_stops_reception(void)
{
    SCI_enableInterrupt(SCIC_BASE, SCI_INT_RXERR);
    chip_drive_pin(90, false);
    run_for(llround(9.5 * BIT_9600) - 1);
    TEST_ASSERT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE));
    run_for(1);
    TEST_ASSERT_EQUAL_INT(SCI_FIFO_RX1, SCI_getRxFIFOStatus(SCIC_BASE));
    TEST_ASSERT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE) & SCI_RXSTATUS_BREAK);
    TEST_ASSERT_EQUAL_INT(1, raised[RX_INT]);
    run_for(llround(10.2 * BIT_9600));
    TEST_ASSERT_NOT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE) & SCI_RXSTATUS_BREAK);
    chip_drive_pin(90, true);
    arrive('a');
    TEST_ASSERT_EQUAL_INT(SCI_FIFO_RX1, SCI_getRxFIFOStatus(SCIC_BASE));
    SCI_performSoftwareReset(SCIC_BASE);
    arrive('b');
    TEST_ASSERT_EQUAL_INT(SCI_FIFO_RX2, SCI_getRxFIFOStatus(SCIC_BASE));
}

void test_a_reset_while_the_line_is_still_low_meets_the_next_break(void)
{
    SCI_enableInterrupt(SCIC_BASE, SCI_INT_RXERR);
    chip_drive_pin(90, false);
    run_for(llround(20 * BIT_9600));
    SCI_performSoftwareReset(SCIC_BASE);
    TEST_ASSERT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE) & SCI_RXSTATUS_ERROR);
    run_for(llround(20 * BIT_9600));
    TEST_ASSERT_NOT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE) & SCI_RXSTATUS_BREAK);
    TEST_ASSERT_EQUAL_INT(2, raised[RX_INT]);
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_INT(2, raised[RX_INT]);
}

void test_a_short_low_on_the_line_is_no_break(void)
{
    chip_drive_pin(90, false);
    run_for(llround(9.0 * BIT_9600));
    chip_drive_pin(90, true);
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE));
}

void test_a_much_slower_sender_is_a_break(void)
{
    open_sci(SCIC_BASE, 250000);
    run_for(2 * SIM_MS);
    chip_sci_receive(SCIC_BASE, 0x55, BIT_9600);
    TEST_ASSERT_NOT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE) & SCI_RXSTATUS_BREAK);
}

void test_an_octet_under_way_at_a_reset_never_arrives_whole(void)
{
    run_for(llround(5.0 * BIT_9600)); /* the sender began 5 bits before */
    SCI_performSoftwareReset(SCIC_BASE);
    run_for(llround(5.0 * BIT_9600));
    chip_sci_receive(SCIC_BASE, 0xF7, BIT_9600); /* all ones after the reset: no start edge left */
    TEST_ASSERT_EQUAL_INT(SCI_FIFO_RX0, SCI_getRxFIFOStatus(SCIC_BASE));
    run_for(llround(BIT_9600));
    arrive(0x5A);
    TEST_ASSERT_EQUAL_HEX16(0x5A, SCI_readCharNonBlocking(SCIC_BASE));
}

void test_nothing_arrives_without_clock_mux_enable_or_fifo(void)
{
    GPIO_setPinConfig(GPIO_90_GPIO90);
    arrive('a');
    GPIO_setPinConfig(GPIO_90_SCIRXDC);
    SCI_disableModule(SCIC_BASE);
    arrive('b');
    SCI_enableModule(SCIC_BASE);
    arrive('c'); /* the FIFO is off */
    SCI_enableFIFO(SCIC_BASE);
    SysCtl_disablePeripheral(SYSCTL_PERIPH_CLK_SCIC);
    arrive('d');
    SCI_setBaud(SCIC_BASE, LSPCLK, 57600);
    TEST_ASSERT_EQUAL_HEX16(0, HWREGH(SCIC_BASE + SCI_O_CTL2));
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_SCIC);
    TEST_ASSERT_EQUAL_UINT32(1301, chip_register("SCIC.BRR"));
    TEST_ASSERT_EQUAL_INT(SCI_FIFO_RX0, SCI_getRxFIFOStatus(SCIC_BASE));
    arrive('e');
    TEST_ASSERT_EQUAL_HEX16('e', SCI_readCharNonBlocking(SCIC_BASE));
}

/* ---- pins ---- */

void test_output_pins_follow_the_latch_and_inputs_the_outside(void)
{
    chip_drive_pin(12, false);
    TEST_ASSERT_FALSE(chip_pin(12));
    GPIO_writePin(12, 1);
    TEST_ASSERT_FALSE(chip_pin(12));
    GPIO_setDirectionMode(12, GPIO_DIR_MODE_OUT);
    TEST_ASSERT_TRUE(chip_pin(12));
    GPIO_writePin(12, 0);
    TEST_ASSERT_FALSE(chip_pin(12));
    chip_drive_pin(12, true);
    TEST_ASSERT_FALSE(chip_pin(12));
    GPIO_setDirectionMode(12, GPIO_DIR_MODE_IN);
    TEST_ASSERT_TRUE(chip_pin(12));
}

void test_a_pin_is_read_as_it_is_driven(void)
{
    chip_drive_pin(3, false);
    TEST_ASSERT_EQUAL_UINT32(0, GPIO_readPin(3));
    chip_drive_pin(3, true);
    TEST_ASSERT_EQUAL_UINT32(1, GPIO_readPin(3));
    GPIO_setDirectionMode(3, GPIO_DIR_MODE_OUT);
    TEST_ASSERT_EQUAL_UINT32(0, GPIO_readPin(3));
    GPIO_writePin(3, 7);
    TEST_ASSERT_EQUAL_UINT32(1, GPIO_readPin(3));
}

void test_a_qualification_period_is_its_groups(void)
{
    GPIO_setQualificationPeriod(3, 510);
    GPIO_setQualificationPeriod(168, 2);
    TEST_ASSERT_EQUAL_UINT32(255, chip_register("GPIO0.QUALPRD"));
    TEST_ASSERT_EQUAL_UINT32(255, chip_register("GPIO7.QUALPRD"));
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO8.QUALPRD"));
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("GPIO168.QUALPRD"));
    GPIO_setQualificationPeriod(0, 1);
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO3.QUALPRD"));
    GPIO_setQualificationPeriod(0, 4);
    chip_reset(raise_line);
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO3.QUALPRD"));
}

void test_pin_words_decode_to_pin_and_mux(void)
{
    static const struct {
        uint32_t word;
        const char *name;
        uint32_t mux;
    } PINS[] = {{GPIO_2_EPWM2A, "GPIO2.MUX", 1},     {GPIO_3_GPIO3, "GPIO3.MUX", 0},
                {GPIO_42_SCITXDA, "GPIO42.MUX", 15}, {GPIO_64_SCIRXDA, "GPIO64.MUX", 6},
                {GPIO_65_SCITXDA, "GPIO65.MUX", 6},  {GPIO_84_SCITXDA, "GPIO84.MUX", 5},
                {GPIO_86_SCITXDB, "GPIO86.MUX", 5},  {GPIO_87_SCIRXDB, "GPIO87.MUX", 5},
                {GPIO_89_SCITXDC, "GPIO89.MUX", 6},  {GPIO_90_SCIRXDC, "GPIO90.MUX", 6}};
    chip_reset(raise_line);
    for (unsigned i = 0; i < sizeof PINS / sizeof PINS[0]; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, chip_register(PINS[i].name));
        GPIO_setPinConfig(PINS[i].word);
        TEST_ASSERT_EQUAL_UINT32(PINS[i].mux, chip_register(PINS[i].name));
    }
}

void test_pad_and_qualification_are_kept(void)
{
    GPIO_setPadConfig(64, GPIO_PIN_TYPE_PULLUP);
    GPIO_setQualificationMode(64, GPIO_QUAL_ASYNC);
    TEST_ASSERT_EQUAL_UINT32(0, chip_register("GPIO64.PUD"));
    TEST_ASSERT_EQUAL_UINT32(3, chip_register("GPIO64.QSEL"));
    GPIO_setPadConfig(64, GPIO_PIN_TYPE_STD);
    TEST_ASSERT_EQUAL_UINT32(1, chip_register("GPIO64.PUD"));
}

/* ---- throttle PWM ---- */

static void start_pwm(uint16_t period, uint16_t compare)
{
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_EPWM2);
    EPWM_setClockPrescaler(EPWM2_BASE, EPWM_CLOCK_DIVIDER_8, EPWM_HSCLOCK_DIVIDER_6);
    EPWM_setTimeBasePeriod(EPWM2_BASE, period);
    EPWM_setCounterCompareShadowLoadMode(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, EPWM_COMP_LOAD_ON_CNTR_ZERO);
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, compare);
    EPWM_setActionQualifierAction(EPWM2_BASE, EPWM_AQ_OUTPUT_A, EPWM_AQ_OUTPUT_HIGH,
                                  EPWM_AQ_OUTPUT_ON_TIMEBASE_ZERO);
    EPWM_setActionQualifierAction(EPWM2_BASE, EPWM_AQ_OUTPUT_A, EPWM_AQ_OUTPUT_LOW,
                                  EPWM_AQ_OUTPUT_ON_TIMEBASE_UP_CMPA);
    EPWM_setTimeBaseCounterMode(EPWM2_BASE, EPWM_COUNTER_MODE_UP);
    GPIO_setPinConfig(GPIO_2_EPWM2A);
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_TBCLKSYNC);
}

void test_pulses_and_period_to_the_nanosecond(void)
{
    start_pwm(28332, 4166);
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(74, pulse_count);
    for (unsigned i = 0; i < LOG; i++) {
        TEST_ASSERT_EQUAL_INT64(1999680, pulses[i]);
        TEST_ASSERT_EQUAL_INT64(1999680 + 13599840 * (sim_time_t)i, pulse_end[i]);
    }
    TEST_ASSERT_EQUAL_UINT32(0x0012, chip_register("EPWM2.AQCTLA"));
}

void test_one_event_a_period_is_all_the_pwm_asks(void)
{
    unsigned events = 0;
    start_pwm(28332, 4166);
    while (timeline_next() <= 10 * SIM_S) {
        timeline_move_to(timeline_next());
        timeline_run_due();
        events++;
    }
    TEST_ASSERT_UINT_WITHIN(1, 736, events);
}

void test_a_new_compare_takes_effect_at_the_next_zero_only(void)
{
    start_pwm(28332, 4166);
    run_until(1000 * SIM_US); /* in the pulse */
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, 2082);
    TEST_ASSERT_EQUAL_UINT32(2082, chip_register("EPWM2.CMPA"));
    run_until(10 * SIM_MS);
    TEST_ASSERT_EQUAL_INT64(1999680, pulses[0]);
    run_until(13599840 - 1);
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, 3000);
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, 3100);
    run_until(13599840);
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, 2500); /* too late for this one */
    run_until(40 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(3, pulse_count);
    TEST_ASSERT_EQUAL_INT64(3100 * 480, pulses[1]);
    TEST_ASSERT_EQUAL_INT64(2500 * 480, pulses[2]);
    TEST_ASSERT_EQUAL_INT64(13599840 + 3100 * 480, pulse_end[1]);
}

void test_a_direct_compare_takes_effect_at_once(void)
{
    start_pwm(28332, 4166);
    run_until(1000 * SIM_US);
    EPWM_disableCounterCompareShadowLoadMode(EPWM2_BASE, EPWM_COUNTER_COMPARE_A);
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, 2200);
    run_until(2 * SIM_MS);
    TEST_ASSERT_EQUAL_INT64(2200 * 480, pulses[0]);
}

void test_the_time_base_stands_without_either_clock_gate(void)
{
    start_pwm(28332, 4166);
    run_until(500 * SIM_US);
    SysCtl_disablePeripheral(SYSCTL_PERIPH_CLK_TBCLKSYNC);
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_UINT(0, pulse_count);
    TEST_ASSERT_TRUE(chip_pin(2));
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_TBCLKSYNC);
    run_until(SIM_S + 2 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(1, pulse_count);
    TEST_ASSERT_INT64_WITHIN(480, SIM_S + 1999680 - 500000, pulse_end[0]);
    SysCtl_disablePeripheral(SYSCTL_PERIPH_CLK_EPWM2);
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, 1);
    TEST_ASSERT_EQUAL_UINT32(4166, chip_register("EPWM2.CMPA"));
    run_until(2 * SIM_S);
    TEST_ASSERT_EQUAL_UINT(1, pulse_count);
}

void test_a_faster_clock_in_mid_pulse_makes_the_short_pulse_it_would_make(void)
{
    TEST_ASSERT_TRUE(SysCtl_setClock(SYSCTL_OSCSRC_XTAL | SYSCTL_PLL_DISABLE));
    start_pwm(28332, 4166);
    run_until(480 * 100 * 20); /* 100 counts of 20 * 0.48 us */
    clocks_200_mhz();
    run_for(10 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(1, pulse_count);
    TEST_ASSERT_EQUAL_INT64(480 * (100 * 20 + 4066), pulses[0]);
}

void test_an_unrelated_gate_leaves_a_running_pulse_alone(void)
{
    start_pwm(28332, 4166);
    for (unsigned i = 0; i < 50; i++) {
        run_for(33333);
        SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_SCIA);
    }
    run_until(3 * SIM_MS);
    TEST_ASSERT_EQUAL_INT64(1999680, pulses[0]);
}

void test_taking_the_pin_away_in_mid_pulse_cuts_the_pulse_short(void)
{
    start_pwm(28332, 4166);
    run_until(700 * SIM_US);
    TEST_ASSERT_TRUE(chip_pin(2));
    GPIO_setPinConfig(GPIO_2_GPIO2);
    TEST_ASSERT_EQUAL_UINT(1, pulse_count);
    TEST_ASSERT_EQUAL_INT64(700 * SIM_US, pulses[0]);
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_UINT(1, pulse_count);
}

void test_a_pulse_made_by_hand_on_the_throttle_pin_is_seen_too(void)
{
    GPIO_setDirectionMode(2, GPIO_DIR_MODE_OUT);
    GPIO_writePin(2, 1);
    run_for(1234);
    GPIO_writePin(2, 0);
    TEST_ASSERT_EQUAL_UINT(1, pulse_count);
    TEST_ASSERT_EQUAL_INT64(1234, pulses[0]);
}

void test_compare_beyond_the_period_stays_high_and_compare_zero_stays_low(void)
{
    start_pwm(28332, 30000);
    run_until(100 * SIM_MS);
    TEST_ASSERT_TRUE(chip_pin(2));
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, 0);
    run_until(200 * SIM_MS);
    TEST_ASSERT_FALSE(chip_pin(2));
    TEST_ASSERT_EQUAL_UINT(1, pulse_count);
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_A, 4166);
    run_until(300 * SIM_MS);
    TEST_ASSERT_EQUAL_INT64(1999680, pulses[1]);
}

void test_the_period_is_shadowed_too(void)
{
    start_pwm(28332, 4166);
    run_until(5 * SIM_MS);
    EPWM_setTimeBasePeriod(EPWM2_BASE, 9999);
    run_until(25 * SIM_MS);
    TEST_ASSERT_EQUAL_INT64(13599840 + 1999680, pulse_end[1]);
    TEST_ASSERT_EQUAL_INT64(13599840 + 4800000 + 1999680, pulse_end[2]);
}

void test_toggling_at_both_events_is_a_pulse_too(void)
{
    start_pwm(28332, 4166);
    EPWM_setActionQualifierAction(EPWM2_BASE, EPWM_AQ_OUTPUT_A, EPWM_AQ_OUTPUT_TOGGLE,
                                  EPWM_AQ_OUTPUT_ON_TIMEBASE_ZERO);
    EPWM_setActionQualifierAction(EPWM2_BASE, EPWM_AQ_OUTPUT_A, EPWM_AQ_OUTPUT_TOGGLE,
                                  EPWM_AQ_OUTPUT_ON_TIMEBASE_UP_CMPA);
    run_until(20 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(2, pulse_count);
    TEST_ASSERT_EQUAL_INT64(1999680, pulses[1]);
}

/* ---- the whole chip ---- */

void test_a_reset_in_mid_air_ends_everything_that_was_under_way(void)
{
    start_pwm(28332, 4166);
    SCI_writeCharNonBlocking(SCIC_BASE, 'a');
    chip_drive_pin(90, false);
    run_for(10 * SIM_US);
    chip_reset(raise_line);
    SysCtl_disableWatchdog(); /* it counts from reset on */
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    TEST_ASSERT_EQUAL_UINT(0, pulse_count);
}

void test_clearing_an_error_flag_is_a_software_reset(void)
{
    run_for(2 * SIM_MS);
    chip_sci_receive(SCIC_BASE, 'b', BIT_9600 * 1.05);
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_FE);
    TEST_ASSERT_EQUAL_HEX16(SCI_RXSTATUS_READY, SCI_getRxStatus(SCIC_BASE));
}

static sigjmp_buf out;

static void aborted(int signal_number)
{
    (void)signal_number;
    siglongjmp(out, 1);
}

static void unknown_register(void)
{
    (void)chip_register("EPWM2.NONE");
}
static void unknown_sci_register(void)
{
    (void)chip_register("SCIA.NONE");
}
static void unknown_pin_field(void)
{
    (void)chip_register("GPIO2.NONE");
}
static void unknown_pin(void)
{
    (void)chip_pin(169);
}
static void unknown_sci(void)
{
    SCI_enableFIFO(0x7230U);
}
static void unknown_epwm(void)
{
    EPWM_setTimeBasePeriod(0x4000U, 1);
}
static void unknown_timer(void)
{
    CPUTimer_stopTimer(0xC18U);
}
static void too_fast(void)
{
    SCI_setConfig(SCIC_BASE, LSPCLK, 6250001U, FORMAT);
}
static void seven_bits(void)
{
    SCI_setConfig(SCIC_BASE, LSPCLK, 9600U, 6U);
}
static void odd_interrupt(void)
{
    SCI_enableInterrupt(SCIC_BASE, SCI_INT_TXRDY);
}
static void down_count(void)
{
    EPWM_setTimeBaseCounterMode(EPWM2_BASE, EPWM_COUNTER_MODE_DOWN);
}
static void compare_b(void)
{
    EPWM_setCounterCompareValue(EPWM2_BASE, EPWM_COUNTER_COMPARE_B, 1);
}
static void open_drain(void)
{
    GPIO_setPadConfig(12, GPIO_PIN_TYPE_OD);
}

static void other_ecap(void)
{
    ECAP_startCounter(0x5020U);
}
static void continuous_capture(void)
{
    ECAP_setCaptureMode(ECAP1_BASE, ECAP_CONTINUOUS_CAPTURE_MODE, ECAP_EVENT_2);
}
static void four_events(void)
{
    ECAP_setCaptureMode(ECAP1_BASE, ECAP_ONE_SHOT_CAPTURE_MODE, ECAP_EVENT_4);
}
static void capture_without_a_mode(void)
{
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_ECAP1);
    ECAP_reArm(ECAP1_BASE);
}
static void other_input(void)
{
    XBAR_setInputPin((XBAR_InputNum)0, 10);
}

static void open_ecap(void)
{
    XBAR_setInputPin(XBAR_INPUT7, 10);
    ECAP_setCaptureMode(ECAP1_BASE, ECAP_ONE_SHOT_CAPTURE_MODE, ECAP_EVENT_2);
    ECAP_setEventPolarity(ECAP1_BASE, ECAP_EVENT_2, ECAP_EVNT_FALLING_EDGE);
    ECAP_enableTimeStampCapture(ECAP1_BASE);
    ECAP_startCounter(ECAP1_BASE);
    ECAP_reArm(ECAP1_BASE);
}

static void high_for_a_millisecond(void)
{
    chip_drive_pin(10, true);
    run_for(SIM_MS);
    chip_drive_pin(10, false);
    run_for(SIM_MS);
}

void test_an_ecap_without_its_clock_ignores_what_is_written_and_reads_as_nothing(void)
{
    chip_drive_pin(10, false);
    open_ecap();
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_ECAP1);
    high_for_a_millisecond();
    TEST_ASSERT_EQUAL_HEX16(0, ECAP_getInterruptSource(ECAP1_BASE));
    open_ecap();
    high_for_a_millisecond();
    TEST_ASSERT_EQUAL_HEX16(6, ECAP_getInterruptSource(ECAP1_BASE));
    SysCtl_disablePeripheral(SYSCTL_PERIPH_CLK_ECAP1);
    TEST_ASSERT_EQUAL_HEX16(0, ECAP_getInterruptSource(ECAP1_BASE));
}

void test_an_ecap_stops_at_its_second_event_until_it_is_armed_again(void)
{
    chip_drive_pin(10, false);
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_ECAP1);
    open_ecap();
    high_for_a_millisecond();
    const uint32_t rose = ECAP_getEventTimeStamp(ECAP1_BASE, ECAP_EVENT_1);
    TEST_ASSERT_EQUAL_UINT32(200000, ECAP_getEventTimeStamp(ECAP1_BASE, ECAP_EVENT_2) - rose);
    high_for_a_millisecond();
    TEST_ASSERT_EQUAL_UINT32(rose, ECAP_getEventTimeStamp(ECAP1_BASE, ECAP_EVENT_1));
    ECAP_reArm(ECAP1_BASE);
    TEST_ASSERT_EQUAL_HEX16(6, ECAP_getInterruptSource(ECAP1_BASE)); /* only ECCLR clears */
    ECAP_clearInterrupt(ECAP1_BASE, 6);
    high_for_a_millisecond();
    TEST_ASSERT_EQUAL_UINT32(rose + 800000, ECAP_getEventTimeStamp(ECAP1_BASE, ECAP_EVENT_1));
    TEST_ASSERT_EQUAL_HEX16(6, ECAP_getInterruptSource(ECAP1_BASE));
}

void test_what_the_model_does_not_know_aborts(void)
{
    static void (*const CASES[])(void) = {unknown_register,
                                          unknown_sci_register,
                                          unknown_pin_field,
                                          unknown_pin,
                                          unknown_sci,
                                          unknown_epwm,
                                          unknown_timer,
                                          too_fast,
                                          seven_bits,
                                          odd_interrupt,
                                          down_count,
                                          compare_b,
                                          open_drain,
                                          other_ecap,
                                          continuous_capture,
                                          four_events,
                                          capture_without_a_mode,
                                          other_input};
    void (*const before)(int) = signal(SIGABRT, aborted);
    volatile unsigned count = 0;
    for (volatile unsigned i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        if (sigsetjmp(out, 1) == 0) {
            CASES[i]();
        } else {
            count++;
        }
    }
    (void)signal(SIGABRT, before);
    TEST_ASSERT_EQUAL_UINT(sizeof CASES / sizeof CASES[0], count);
}

/* The error rises after the status was read and before the flag is cleared: no edge is left to tell of it. */
void test_an_error_that_rises_before_the_flag_is_cleared_leaves_the_receiver_deaf_until_somebody_looks(void)
{
    SCI_enableInterrupt(SCIC_BASE, SCI_INT_RXFF | SCI_INT_RXERR);
    arrive('a');
    TEST_ASSERT_EQUAL_INT(1, raised[RX_INT]);
    (void)SCI_readCharNonBlocking(SCIC_BASE);
    TEST_ASSERT_EQUAL_HEX16(0, SCI_getRxStatus(SCIC_BASE) & SCI_RXSTATUS_ERROR);
    chip_drive_pin(90, false);
    run_for(3 * SIM_MS);
    chip_drive_pin(90, true);
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_RXFF);
    arrive('b');
    arrive('b');
    TEST_ASSERT_EQUAL_INT(1, raised[RX_INT]);
    SCI_resetRxFIFO(SCIC_BASE);
    SCI_performSoftwareReset(SCIC_BASE);
    SCI_clearInterruptStatus(SCIC_BASE, SCI_INT_RXFF);
    arrive('c');
    TEST_ASSERT_EQUAL_INT(2, raised[RX_INT]);
    TEST_ASSERT_EQUAL_HEX16('c', SCI_readCharNonBlocking(SCIC_BASE));
}

void test_protected_registers_are_open_between_eallow_and_edis_and_that_does_not_nest(void)
{
    TEST_ASSERT_FALSE(chip_protected_writable());
    EALLOW;
    EALLOW;
    TEST_ASSERT_TRUE(chip_protected_writable());
    EDIS;
    TEST_ASSERT_FALSE(chip_protected_writable());
    EALLOW;
    chip_restart();
    TEST_ASSERT_FALSE(chip_protected_writable());
}

void test_driverlibs_functions_that_store_in_protected_registers_leave_them_closed(void)
{
    static void (*const functions[])(void) = {SysCtl_serviceWatchdog, SysCtl_enableWatchdog,
                                              SysCtl_disableWatchdog};

    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) {
        EALLOW;
        functions[i]();
        TEST_ASSERT_FALSE(chip_protected_writable());
    }
    EALLOW;
    GPIO_setPinConfig(GPIO_2_GPIO2);
    TEST_ASSERT_FALSE(chip_protected_writable());
    EALLOW;
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_SCIA);
    TEST_ASSERT_FALSE(chip_protected_writable());
    EALLOW;
    SCI_performSoftwareReset(SCIA_BASE);
    TEST_ASSERT_TRUE_MESSAGE(chip_protected_writable(),
                             "the SCI's registers are not protected, TI's function leaves the bit");
}
