/* What is told on the USB port, and when not. */
#include "firmware/usb_port.h"

#include <string.h>

#include "firmware/version.h"
#include "kernel.h"
#include "mock_uart_port.h"
#include "mock_usb.h"
#include "mock_verbs.h"
#include "unity.h"

#define PERF_LINES 3U

static char told[64];
static unsigned lines, borrows, returns;

static bool send(bsp_uart_t uart, const char *text, uint16_t count, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL(BSP_UART_LASER, uart);
    TEST_ASSERT_LESS_THAN(sizeof told, count);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(returns + 1U, borrows, "on the scanner's pin");
    (void)memcpy(told, text, count);
    told[count] = '\0';
    lines++;
    return true;
}

static void transmit(bool on, int calls)
{
    (void)calls;
    borrows += on;
    returns += !on;
}

static bool perf(answer_t *answer, uint16_t number, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_STRING_LEN("PERF", answer->command->name, answer->command->name_length);
    telemetry_begin_answer(&answer->line);
    telemetry_text(&answer->line, "line ");
    telemetry_count(&answer->line, number);
    return number < PERF_LINES;
}

void setUp(void)
{
    uart_port_send_Stub(send);
    bsp_usb_transmit_Stub(transmit);
    verb_perf_line_Stub(perf);
    usb_port_end(); /* of the test before */
    lines = borrows = returns = 0U;
    told[0] = '\0';
}

void tearDown(void) {}

void test_the_version_comes_at_once(void)
{
    usb_port_start();
    TEST_ASSERT_EQUAL_STRING("OK VERSION " PLOMADA_VERSION "\r\n", told);
    TEST_ASSERT_EQUAL_UINT(1U, lines);
}

void test_then_a_line_of_perf_with_each_step_and_all_over_again(void)
{
    static const char *const wanted[] = {"line 0\r\n", "line 1\r\n", "line 2\r\n",
                                         "OK VERSION " PLOMADA_VERSION "\r\n", "line 0\r\n"};

    usb_port_start();
    for (unsigned i = 0U; i < sizeof wanted / sizeof wanted[0]; i++) {
        usb_port_step();
        TEST_ASSERT_EQUAL_STRING(wanted[i], told);
        TEST_ASSERT_EQUAL_UINT(i + 2U, lines);
    }
}

void test_nothing_is_told_before_the_start_and_no_pin_is_touched(void)
{
    usb_port_step();
    usb_port_end();
    TEST_ASSERT_EQUAL_UINT(0U, lines + borrows + returns);
}

void test_the_transmitter_is_given_back_once_and_then_nothing_is_told(void)
{
    usb_port_start();
    usb_port_end();
    usb_port_end();
    TEST_ASSERT_EQUAL_UINT(1U, returns);
    usb_port_step();
    TEST_ASSERT_EQUAL_UINT(1U, lines);
}
