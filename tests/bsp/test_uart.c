/* The UARTs on the chip model: registers, octets, errors, interrupt lines. */
#include "bsp/uart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/timeline.h"
#include "unity.h"

#define LOG 4096

static const struct {
    uint32_t base;
    SysCtl_PeripheralPCLOCKCR clock;
    uint32_t transmit_pin, receive_pin, receive_gpio;
    int receive_interrupt, transmit_interrupt;
} WIRES[BSP_UART_COUNT] = {
    {SCIA_BASE, SYSCTL_PERIPH_CLK_SCIA, GPIO_65_SCITXDA, GPIO_64_SCIRXDA, 64, 96, 97},
    {SCIB_BASE, SYSCTL_PERIPH_CLK_SCIB, GPIO_86_SCITXDB, GPIO_87_SCIRXDB, 87, 98, 99},
    {SCIC_BASE, SYSCTL_PERIPH_CLK_SCIC, GPIO_89_SCITXDC, GPIO_90_SCIRXDC, 90, 92, 93},
};

static int raised[256];
static unsigned sent[LOG], sent_count;
static bsp_uart_burst_t burst;

static void raise_line(int interrupt)
{
    raised[interrupt]++;
}

static void on_sent(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    (void)bit_ns;
    TEST_ASSERT_LESS_THAN(LOG, sent_count);
    sent[sent_count] = octet;
    sent_count++;
}

static void run_for(sim_time_t delay)
{
    const sim_time_t end = timeline_now() + delay;
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
    memset(raised, 0, sizeof raised);
    sent_count = 0;
    TEST_ASSERT_TRUE(SysCtl_setClock(DEVICE_SETCLOCK_CFG));
    SysCtl_setLowSpeedClock(SYSCTL_LSPCLK_PRESCALE_2);
    for (unsigned i = 0; i < BSP_UART_COUNT; i++) {
        SysCtl_enablePeripheral(WIRES[i].clock);
        GPIO_setPinConfig(WIRES[i].transmit_pin);
        GPIO_setPinConfig(WIRES[i].receive_pin);
        chip_sci_connect(WIRES[i].base, on_sent, NULL);
        chip_drive_pin(WIRES[i].receive_gpio, true);
    }
}

void tearDown(void) {}

static double bit_of(uint32_t rate)
{
    return 1e9 / rate;
}

static void arrive(bsp_uart_t uart, unsigned octet, uint32_t rate)
{
    run_for(llround(10 * bit_of(rate)));
    chip_sci_receive(WIRES[uart].base, octet, bit_of(rate));
}

static int receive_interrupts(bsp_uart_t uart)
{
    return raised[WIRES[uart].receive_interrupt];
}

/* ---- opening ---- */

void test_the_rate_register_is_the_nearest(void)
{
    static const struct {
        uint32_t rate, brr;
    } RATES[] = {{115200, 108}, {250000, 49}, {57600, 216}, {9600, 1301}, {19200, 650}, {38400, 325}};
    for (unsigned i = 0; i < sizeof RATES / sizeof RATES[0]; i++) {
        bsp_uart_open(BSP_UART_LASER, RATES[i].rate);
        TEST_ASSERT_EQUAL_UINT32(RATES[i].brr, chip_register("SCIA.BRR"));
        TEST_ASSERT_DOUBLE_WITHIN(0.0046 * RATES[i].rate, RATES[i].rate, chip_sci_rate(SCIA_BASE));
    }
}

void test_each_uart_is_its_own_sci(void)
{
    bsp_uart_open(BSP_UART_LASER, 115200);
    bsp_uart_open(BSP_UART_IMU, 57600);
    bsp_uart_open(BSP_UART_XBEE, 9600);
    TEST_ASSERT_EQUAL_UINT32(108, chip_register("SCIA.BRR"));
    TEST_ASSERT_EQUAL_UINT32(216, chip_register("SCIB.BRR"));
    TEST_ASSERT_EQUAL_UINT32(1301, chip_register("SCIC.BRR"));
    TEST_ASSERT_EQUAL_HEX32(0x07, chip_register("SCIA.CCR"));  /* 8N1 */
    TEST_ASSERT_EQUAL_HEX32(0x63, chip_register("SCIA.CTL1")); /* running, receive-error interrupt on */
    TEST_ASSERT_EQUAL_HEX32(0x2021,
                            chip_register("SCIA.FFRX")); /* interrupt on at one octet, nothing pending */
    TEST_ASSERT_EQUAL_HEX32(0xE080, chip_register("SCIA.FFTX")); /* FIFOs on, interrupt at empty but off */
}

void test_interrupt_numbers_are_those_of_sys_bios(void)
{
    for (unsigned i = 0; i < BSP_UART_COUNT; i++) {
        TEST_ASSERT_EQUAL_INT16(WIRES[i].receive_interrupt, bsp_uart_receive_interrupt((bsp_uart_t)i));
        TEST_ASSERT_EQUAL_INT16(WIRES[i].transmit_interrupt, bsp_uart_transmit_interrupt((bsp_uart_t)i));
    }
}

void test_opening_raises_no_interrupt(void)
{
    for (unsigned i = 0; i < BSP_UART_COUNT; i++) {
        bsp_uart_open((bsp_uart_t)i, 57600);
        bsp_uart_open((bsp_uart_t)i, 115200);
    }
    run_for(SIM_S);
    for (unsigned i = 0; i < 256; i++) {
        TEST_ASSERT_EQUAL_INT(0, raised[i]);
    }
}

void test_reopening_drops_both_fifos_and_old_errors(void)
{
    static const uint16_t TEXT[] = {'a', 'b', 'c'};
    bsp_uart_open(BSP_UART_LASER, 115200);
    for (unsigned i = 0; i < 17; i++) {
        arrive(BSP_UART_LASER, i, 115200);
    }
    arrive(BSP_UART_LASER, 'x', 100000);
    TEST_ASSERT_EQUAL_UINT16(3, bsp_uart_transmit(BSP_UART_LASER, TEXT, 3));
    bsp_uart_transmit_interrupt_enable(BSP_UART_LASER, true);
    bsp_uart_open(BSP_UART_LASER, 250000);
    memset(raised, 0, sizeof raised);
    bsp_uart_receive(BSP_UART_LASER, &burst);
    TEST_ASSERT_EQUAL_UINT16(0, burst.count);
    TEST_ASSERT_FALSE(burst.overrun);
    TEST_ASSERT_FALSE(burst.framing);
    sent_count = 0;
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    TEST_ASSERT_FALSE(bsp_uart_transmitting(BSP_UART_LASER));
    TEST_ASSERT_EQUAL_INT(0, raised[97]);
    arrive(BSP_UART_LASER, 'y', 250000);
    TEST_ASSERT_EQUAL_INT(1, receive_interrupts(BSP_UART_LASER));
}

/* ---- receiving ---- */

void test_an_octet_raises_its_interrupt_and_is_read(void)
{
    for (unsigned i = 0; i < BSP_UART_COUNT; i++) {
        const bsp_uart_t uart = (bsp_uart_t)i;
        bsp_uart_open(uart, 57600);
        arrive(uart, 0x80U + i, 57600);
        TEST_ASSERT_EQUAL_INT(1, receive_interrupts(uart));
        bsp_uart_receive(uart, &burst);
        TEST_ASSERT_EQUAL_UINT16(1, burst.count);
        TEST_ASSERT_EQUAL_HEX16(0x80U + i, burst.octets[0]);
        TEST_ASSERT_FALSE(burst.overrun);
        TEST_ASSERT_FALSE(burst.framing);
        TEST_ASSERT_EQUAL_INT(1, receive_interrupts(uart));
        arrive(uart, 'n', 57600);
        TEST_ASSERT_EQUAL_INT(2, receive_interrupts(uart));
    }
}

void test_reading_nothing_gives_nothing(void)
{
    bsp_uart_open(BSP_UART_IMU, 57600);
    memset(&burst, 0xFF, sizeof burst);
    bsp_uart_receive(BSP_UART_IMU, &burst);
    TEST_ASSERT_EQUAL_UINT16(0, burst.count);
    TEST_ASSERT_FALSE(burst.overrun);
    TEST_ASSERT_FALSE(burst.framing);
}

void test_a_full_fifo_is_read_in_one_burst(void)
{
    bsp_uart_open(BSP_UART_LASER, 250000);
    for (unsigned i = 0; i < 16; i++) {
        arrive(BSP_UART_LASER, 0xF0U + i, 250000);
    }
    bsp_uart_receive(BSP_UART_LASER, &burst);
    TEST_ASSERT_EQUAL_UINT16(16, burst.count);
    TEST_ASSERT_FALSE(burst.overrun);
    for (unsigned i = 0; i < 16; i++) {
        TEST_ASSERT_EQUAL_HEX16(0xF0U + i, burst.octets[i]);
    }
}

void test_an_overrun_is_told_once_and_reception_goes_on(void)
{
    bsp_uart_open(BSP_UART_LASER, 250000);
    for (unsigned i = 0; i < 20; i++) {
        arrive(BSP_UART_LASER, i, 250000);
    }
    bsp_uart_receive(BSP_UART_LASER, &burst);
    TEST_ASSERT_EQUAL_UINT16(16, burst.count);
    TEST_ASSERT_TRUE(burst.overrun);
    TEST_ASSERT_FALSE(burst.framing);
    const int before = receive_interrupts(BSP_UART_LASER);
    arrive(BSP_UART_LASER, 'a', 250000);
    TEST_ASSERT_EQUAL_INT(before + 1, receive_interrupts(BSP_UART_LASER));
    bsp_uart_receive(BSP_UART_LASER, &burst);
    TEST_ASSERT_EQUAL_UINT16(1, burst.count);
    TEST_ASSERT_FALSE(burst.overrun);
}

void test_a_framing_error_costs_no_good_octet(void)
{
    bsp_uart_open(BSP_UART_XBEE, 9600);
    arrive(BSP_UART_XBEE, 'a', 9600);
    run_for(SIM_MS);
    arrive(BSP_UART_XBEE, 'b', 9100); /* 5.5 % slow */
    run_for(SIM_MS);
    arrive(BSP_UART_XBEE, 'c', 9600);
    bsp_uart_receive(BSP_UART_XBEE, &burst);
    TEST_ASSERT_EQUAL_UINT16(3, burst.count);
    TEST_ASSERT_EQUAL_HEX16('a', burst.octets[0]);
    TEST_ASSERT_EQUAL_HEX16('c', burst.octets[2]);
    TEST_ASSERT_TRUE(burst.framing);
    TEST_ASSERT_FALSE(burst.overrun);
    const int before = receive_interrupts(BSP_UART_XBEE);
    arrive(BSP_UART_XBEE, 'd', 9600);
    TEST_ASSERT_EQUAL_INT(before + 1, receive_interrupts(BSP_UART_XBEE));
    bsp_uart_receive(BSP_UART_XBEE, &burst);
    TEST_ASSERT_EQUAL_UINT16(1, burst.count);
    TEST_ASSERT_FALSE(burst.framing);
}

/* The break is detected 10 bits after its only octet was read: without the error interrupt nobody would look
 * again. */
void test_a_break_is_noticed_after_its_octet_was_read_and_reception_goes_on(void)
{
    bsp_uart_open(BSP_UART_LASER, 115200);
    chip_drive_pin(64, false);
    run_for(90 * SIM_US);
    bsp_uart_receive(BSP_UART_LASER, &burst);
    TEST_ASSERT_TRUE(burst.framing);
    TEST_ASSERT_EQUAL_UINT16(1, burst.count);
    memset(raised, 0, sizeof raised);
    for (unsigned i = 0; i < 100; i++) {
        run_for(90 * SIM_US);
        if (receive_interrupts(BSP_UART_LASER) > 0) {
            raised[96] = 0;
            bsp_uart_receive(BSP_UART_LASER, &burst);
            TEST_ASSERT_TRUE(burst.framing);
        }
    }
    chip_drive_pin(64, true);
    run_for(SIM_MS);
    bsp_uart_receive(BSP_UART_LASER, &burst);
    raised[96] = 0;
    arrive(BSP_UART_LASER, 'a', 115200);
    TEST_ASSERT_EQUAL_INT(1, receive_interrupts(BSP_UART_LASER));
    bsp_uart_receive(BSP_UART_LASER, &burst);
    TEST_ASSERT_EQUAL_UINT16(1, burst.count);
    TEST_ASSERT_EQUAL_HEX16('a', burst.octets[0]);
    TEST_ASSERT_FALSE(burst.framing);
}

/* A break seen only once it is over and read late: the handler was not run before the break was complete. */
void test_a_whole_break_between_two_reads_does_not_stop_reception(void)
{
    bsp_uart_open(BSP_UART_LASER, 250000);
    chip_drive_pin(64, false);
    run_for(SIM_MS);
    chip_drive_pin(64, true);
    run_for(SIM_MS);
    TEST_ASSERT_GREATER_THAN_INT(0, receive_interrupts(BSP_UART_LASER));
    bsp_uart_receive(BSP_UART_LASER, &burst);
    TEST_ASSERT_TRUE(burst.framing);
    arrive(BSP_UART_LASER, 0x31, 250000);
    bsp_uart_receive(BSP_UART_LASER, &burst);
    TEST_ASSERT_EQUAL_UINT16(1, burst.count);
    TEST_ASSERT_EQUAL_HEX16(0x31, burst.octets[0]);
}

static uint32_t random_state;

static uint32_t random_below(uint32_t limit)
{
    random_state = random_state * 1664525U + 1013904223U;
    return (random_state >> 8) % limit;
}

/* A handler that is up to 600 us late (15 octets of 40 us) loses nothing of a stream without gaps. */
void test_a_late_handler_loses_nothing_of_a_gapless_stream(void)
{
    static unsigned wanted[LOG], got[LOG];
    unsigned got_count = 0;
    sim_time_t handler = SIM_NEVER;
    int seen = 0;
    random_state = 20177;
    printf("seed %lu\n", (unsigned long)random_state);
    bsp_uart_open(BSP_UART_LASER, 250000);
    for (unsigned i = 0; i < LOG; i++) {
        wanted[i] = random_below(256);
        const sim_time_t at = 40 * SIM_US * (sim_time_t)(i + 1);
        if (handler < at) {
            run_for(handler - timeline_now());
            handler = SIM_NEVER;
            bsp_uart_receive(BSP_UART_LASER, &burst);
            TEST_ASSERT_FALSE(burst.overrun || burst.framing);
            for (unsigned k = 0; k < burst.count; k++) {
                got[got_count] = burst.octets[k];
                got_count++;
            }
        }
        run_for(at - timeline_now());
        chip_sci_receive(SCIA_BASE, wanted[i], 4000.0);
        if (receive_interrupts(BSP_UART_LASER) != seen) {
            seen = receive_interrupts(BSP_UART_LASER);
            handler = at + (sim_time_t)random_below(600) * SIM_US;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(LOG - 17, got_count);
    for (unsigned i = 0; i < got_count; i++) {
        TEST_ASSERT_EQUAL_HEX16(wanted[i], got[i]);
    }
}

/* ---- transmitting ---- */

void test_what_fits_is_taken_and_leaves_in_order_with_eight_bits(void)
{
    uint16_t octets[40];
    for (unsigned i = 0; i < 40; i++) {
        octets[i] = (uint16_t)(0xAB00U + i * 7);
    }
    bsp_uart_open(BSP_UART_XBEE, 9600);
    TEST_ASSERT_EQUAL_UINT16(
        17, bsp_uart_transmit(BSP_UART_XBEE, octets, 40)); /* one goes straight to the wire */
    TEST_ASSERT_EQUAL_UINT16(0, bsp_uart_transmit(BSP_UART_XBEE, octets + 17, 23));
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(17, sent_count);
    for (unsigned i = 0; i < 17; i++) {
        TEST_ASSERT_EQUAL_HEX16(octets[i] & 0xFFU, sent[i]);
    }
    TEST_ASSERT_EQUAL_UINT16(0, bsp_uart_transmit(BSP_UART_XBEE, octets, 0));
}

void test_transmitting_until_the_last_stop_bit_is_out(void)
{
    static const uint16_t TEXT[] = {'Q', 'T', '\n'};
    bsp_uart_open(BSP_UART_LASER, 115200);
    TEST_ASSERT_FALSE(bsp_uart_transmitting(BSP_UART_LASER));
    TEST_ASSERT_EQUAL_UINT16(3, bsp_uart_transmit(BSP_UART_LASER, TEXT, 3));
    run_for(3 * 87200 - 1);
    TEST_ASSERT_TRUE(bsp_uart_transmitting(BSP_UART_LASER));
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    run_for(1);
    TEST_ASSERT_FALSE(bsp_uart_transmitting(BSP_UART_LASER));
    TEST_ASSERT_EQUAL_UINT(3, sent_count);
}

void test_the_transmit_interrupt_pumps_a_long_message_out(void)
{
    uint16_t message[100];
    uint16_t next = 0;
    int seen = 0;
    for (uint16_t i = 0; i < 100; i++) {
        message[i] = i;
    }
    bsp_uart_open(BSP_UART_IMU, 57600);
    bsp_uart_transmit_interrupt_enable(BSP_UART_IMU, true);
    for (unsigned guard = 0; next < 100 && guard < 10000; guard++) {
        if (raised[99] != seen) {
            seen = raised[99];
            next = (uint16_t)(next + bsp_uart_transmit(BSP_UART_IMU, message + next, (uint16_t)(100 - next)));
            bsp_uart_transmit_acknowledge(BSP_UART_IMU);
        }
        run_for(10 * SIM_US);
    }
    bsp_uart_transmit_interrupt_enable(BSP_UART_IMU, false);
    seen = raised[99];
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_INT(seen, raised[99]);
    TEST_ASSERT_EQUAL_UINT(100, sent_count);
    for (unsigned i = 0; i < 100; i++) {
        TEST_ASSERT_EQUAL_HEX16(i, sent[i]);
    }
    TEST_ASSERT_EQUAL_INT(0, raised[98]);
}

/* ---- receive level ---- */

void test_the_interrupt_comes_with_the_octet_that_fills_the_level(void)
{
    for (uint16_t level = 1; level <= BSP_UART_FIFO_DEPTH; level++) {
        bsp_uart_open(BSP_UART_LASER, 250000);
        bsp_uart_set_receive_level(BSP_UART_LASER, level);
        raised[96] = 0;
        for (uint16_t i = 1; i <= level; i++) {
            TEST_ASSERT_EQUAL_INT(0, receive_interrupts(BSP_UART_LASER));
            arrive(BSP_UART_LASER, i, 250000);
        }
        TEST_ASSERT_EQUAL_INT(1, receive_interrupts(BSP_UART_LASER));
        bsp_uart_receive(BSP_UART_LASER, &burst);
        TEST_ASSERT_EQUAL_UINT16(level, burst.count);
        TEST_ASSERT_FALSE(burst.overrun);
    }
}

void test_fewer_octets_wait_and_are_there_for_whoever_looks(void)
{
    bsp_uart_open(BSP_UART_IMU, 57600);
    bsp_uart_set_receive_level(BSP_UART_IMU, 12U);
    for (unsigned i = 0; i < 11; i++) {
        arrive(BSP_UART_IMU, 'a' + i, 57600);
    }
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_INT(0, receive_interrupts(BSP_UART_IMU));
    bsp_uart_receive(BSP_UART_IMU, &burst);
    TEST_ASSERT_EQUAL_UINT16(11, burst.count);
    TEST_ASSERT_EQUAL_HEX16('k', burst.octets[10]);
    for (unsigned i = 0; i < 12; i++) {
        arrive(BSP_UART_IMU, 'a' + i, 57600);
    }
    TEST_ASSERT_EQUAL_INT(1, receive_interrupts(BSP_UART_IMU));
}

void test_a_level_below_what_is_there_interrupts_at_once(void)
{
    bsp_uart_open(BSP_UART_LASER, 250000);
    bsp_uart_set_receive_level(BSP_UART_LASER, 12U);
    arrive(BSP_UART_LASER, 'a', 250000);
    arrive(BSP_UART_LASER, 'b', 250000);
    TEST_ASSERT_EQUAL_INT(0, receive_interrupts(BSP_UART_LASER));
    bsp_uart_set_receive_level(BSP_UART_LASER, 2U);
    TEST_ASSERT_EQUAL_INT(1, receive_interrupts(BSP_UART_LASER));
}

void test_an_error_interrupts_below_the_level_too(void)
{
    bsp_uart_open(BSP_UART_LASER, 250000);
    bsp_uart_set_receive_level(BSP_UART_LASER, 12U);
    arrive(BSP_UART_LASER, 'a', 250000);
    run_for(llround(10 * bit_of(19200)));
    chip_sci_receive(SCIA_BASE, 0, bit_of(19200));
    TEST_ASSERT_GREATER_THAN_INT(0, receive_interrupts(BSP_UART_LASER));
    bsp_uart_receive(BSP_UART_LASER, &burst);
    TEST_ASSERT_TRUE(burst.framing);
}

void test_a_new_open_interrupts_at_every_octet_again(void)
{
    bsp_uart_open(BSP_UART_LASER, 115200);
    bsp_uart_set_receive_level(BSP_UART_LASER, 12U);
    bsp_uart_open(BSP_UART_LASER, 250000);
    arrive(BSP_UART_LASER, 'a', 250000);
    TEST_ASSERT_EQUAL_INT(1, receive_interrupts(BSP_UART_LASER));
}
