/* The USB serial port on the chip model: whom the scanner's UART reaches. */
#include "bsp/usb.h"

#include "bsp/board.h"
#include "bsp/uart.h"
#include "device.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/timeline.h"
#include "unity.h"

static unsigned heard_by_usb, heard_by_scanner; /* latest octet, 0: none */

static void usb(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    TEST_ASSERT_DOUBLE_WITHIN(50.0, 1e9 / 115200.0, bit_ns);
    heard_by_usb = octet;
}

static void scanner(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    (void)bit_ns;
    heard_by_scanner = octet;
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

static void transmit(uint16_t octet)
{
    heard_by_usb = heard_by_scanner = 0U;
    TEST_ASSERT_EQUAL_UINT16(1U, bsp_uart_transmit(BSP_UART_LASER, &octet, 1U));
    run_until(timeline_now() + SIM_MS);
    TEST_ASSERT_FALSE(bsp_uart_transmitting(BSP_UART_LASER));
}

static uint16_t receive(uint16_t octet)
{
    bsp_uart_burst_t burst;

    run_until(timeline_now() + SIM_MS);
    chip_sci_receive(SCIA_BASE, octet, 1e9 / 115200.0);
    bsp_uart_receive(BSP_UART_LASER, &burst);
    return burst.count == 1U && !burst.framing ? burst.octets[0] : 0U;
}

void setUp(void)
{
    timeline_reset();
    chip_reset(ignore);
    chip_sci_connect(SCIA_BASE, scanner, NULL);
    chip_usb_connect(usb, NULL);
    bsp_board_init();
    bsp_uart_open(BSP_UART_LASER, 115200U);
    run_until(SIM_MS);
}

void tearDown(void)
{
    chip_usb_connect(NULL, NULL);
}

void test_at_first_the_scanner_hears_the_uart_and_the_usb_port_is_silent(void)
{
    transmit('a');
    TEST_ASSERT_EQUAL_UINT('a', heard_by_scanner);
    TEST_ASSERT_EQUAL_UINT(0U, heard_by_usb);
}

void test_the_usb_port_hears_it_and_then_the_scanner_does_not(void)
{
    bsp_usb_transmit(true);
    transmit('b');
    TEST_ASSERT_EQUAL_UINT('b', heard_by_usb);
    TEST_ASSERT_EQUAL_UINT(0U, heard_by_scanner);
    bsp_usb_transmit(false);
    transmit('c');
    TEST_ASSERT_EQUAL_UINT('c', heard_by_scanner);
    TEST_ASSERT_EQUAL_UINT(0U, heard_by_usb);
}

void test_the_scanner_is_received_all_the_time(void)
{
    TEST_ASSERT_EQUAL_HEX16('d', receive('d'));
    bsp_usb_transmit(true);
    TEST_ASSERT_EQUAL_HEX16('e', receive('e'));
    bsp_usb_transmit(false);
    TEST_ASSERT_EQUAL_HEX16('f', receive('f'));
}

/* A low on the scanner's pin is a start bit; one on GPIO84 at a reset is another boot mode. */
void test_neither_pin_is_low_for_an_instant(void)
{
    bsp_usb_transmit(true);
    TEST_ASSERT_TRUE(chip_pin(65));
    TEST_ASSERT_TRUE(chip_pin(84));
    bsp_usb_transmit(false);
    TEST_ASSERT_TRUE(chip_pin(65));
    TEST_ASSERT_EQUAL_UINT(0U, chip_pin_falls(65));
    TEST_ASSERT_EQUAL_UINT(0U, chip_pin_falls(84));
}

void test_afterwards_the_boot_pin_is_an_input_with_pull_up(void)
{
    bsp_usb_transmit(true);
    bsp_usb_transmit(false);
    TEST_ASSERT_EQUAL_UINT32(0U, chip_register("GPIO84.MUX"));
    TEST_ASSERT_EQUAL_UINT32(GPIO_DIR_MODE_IN, chip_register("GPIO84.DIR"));
    TEST_ASSERT_EQUAL_UINT32(0U, chip_register("GPIO84.PUD"));
}
