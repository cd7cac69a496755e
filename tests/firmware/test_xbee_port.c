/* From the octets of a receive interrupt to the queue of TaskReceiveComm, and lines out through a bounded
 * buffer. */
#include "firmware/xbee_port.h"

#include <stdio.h>
#include <string.h>

#include "kernel.h"
#include "mock_cpu_time.h"
#include "mock_timebase.h"
#include "mock_uart_port.h"
#include "unity.h"

static uart_port_received_t receiver;
static uint32_t now_us;
static uint16_t room;
static char sent[1024];
static uint16_t sends;
static xbee_message_t message;

static void port_create(bsp_uart_t uart, uint32_t bit_rate, uart_port_received_t received, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL(BSP_UART_XBEE, uart);
    TEST_ASSERT_EQUAL_UINT32(9600, bit_rate);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.swi.created);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.semaphore.created);
    receiver = received;
}

static bool port_send(bsp_uart_t uart, const char *text, uint16_t count, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL(BSP_UART_XBEE, uart);
    kernel_no_lock();
    sends++;
    if (count > room) {
        return false;
    }
    room = (uint16_t)(room - count);
    (void)strncat(sent, text, count);
    return true;
}

static uint16_t port_room(bsp_uart_t uart, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL(BSP_UART_XBEE, uart);
    return room;
}

static uint32_t time_us(int calls)
{
    (void)calls;
    return now_us;
}

static uint16_t missed;

static void wait(void)
{
    missed = xbee_port_wait(&message);
}

void setUp(void)
{
    kernel_reset();
    now_us = 0U;
    room = UART_PORT_TRANSMIT_CELLS;
    sent[0] = '\0';
    sends = 0U;
    uart_port_create_Stub(port_create);
    uart_port_send_Stub(port_send);
    uart_port_room_Stub(port_room);
    bsp_time_us_Stub(time_us);
    cpu_time_watch_Expect(CPU_TIME_XBEE_SWI, NULL);
    cpu_time_watch_IgnoreArg_handle();
    xbee_port_create();
}

/* The queue outlives a test: leave it empty. */
void tearDown(void)
{
    while (!kernel_blocks(wait)) {
    }
    kernel_check();
}

static void octet(uint16_t cell)
{
    bsp_uart_burst_t burst = {.count = 1U, .octets = {cell}};

    now_us += 1042U;                               /* ten bits at 9600 */
    TEST_ASSERT_EQUAL_UINT16(1, receiver(&burst)); /* every octet interrupts */
    kernel_run_swi();
}

static void feed(const char *text)
{
    for (; *text != '\0'; text++) {
        octet((uint16_t)*text);
    }
}

static void feed_numbered(unsigned n)
{
    char text[24];

    (void)snprintf(text, sizeof text, "#PING %u\n", n);
    feed(text);
}

static void assert_line(const char *expected)
{
    TEST_ASSERT_EQUAL_UINT16(strlen(expected), message.line.length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, message.line.text, message.line.length);
}

static void assert_numbered(unsigned n)
{
    char text[24];

    (void)snprintf(text, sizeof text, "#PING %u", n);
    assert_line(text);
}

static telemetry_line_t line_of(const char *text)
{
    telemetry_line_t line;

    telemetry_begin(&line);
    telemetry_text(&line, text);
    return line;
}

void test_create_makes_the_swi_and_a_counting_semaphore_then_the_uart(void)
{
    TEST_ASSERT_NOT_NULL(receiver);
    TEST_ASSERT_EQUAL_STRING("XBee_SWI", kernel.swi.name);
    TEST_ASSERT_EQUAL_UINT(1, kernel.swi.params.priority);
    TEST_ASSERT_EQUAL(Semaphore_Mode_COUNTING, kernel.semaphore.mode);
    TEST_ASSERT_EQUAL_INT(0, kernel.semaphore.count);
}

void test_the_task_waits_until_a_line_is_complete(void)
{
    TEST_ASSERT_TRUE(kernel_blocks(wait));
    feed("noise #SETR 0.6");
    TEST_ASSERT_TRUE(kernel_blocks(wait));
    TEST_ASSERT_EQUAL_UINT16(0, kernel.swi.posts);
    feed("\n");
    wait();
    assert_line("#SETR 0.6");
    TEST_ASSERT_EQUAL_UINT16(0, missed);
}

void test_a_line_has_the_time_of_its_end(void)
{
    feed("#SETR 0.6");
    now_us = 500000U;
    octet('\r');
    now_us = 900000U;
    octet('\n');
    wait();
    TEST_ASSERT_EQUAL_UINT32(501042, message.arrival_us);
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_bursts_of_up_to_sixteen_octets_lose_nothing(void)
{
    static const char text[] = "#SETR 0.6\n#KP 0.0151234\r\n#GET";
    static const size_t ends[] = {4U, 20U, 26U, 30U};
    size_t at = 0;

    for (size_t b = 0; b < sizeof ends / sizeof ends[0]; b++) {
        bsp_uart_burst_t burst = {.count = 0U};

        while (at < ends[b]) {
            burst.octets[burst.count++] = (uint16_t)text[at++];
        }
        for (uint16_t i = burst.count; i < BSP_UART_FIFO_DEPTH; i++) {
            burst.octets[i] = '#'; /* not received */
        }
        (void)receiver(&burst);
        kernel_run_swi();
    }
    octet('\n');
    wait();
    assert_line("#SETR 0.6");
    wait();
    assert_line("#KP 0.0151234");
    wait();
    assert_line("#GET");
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_lines_are_taken_oldest_first_and_each_once(void)
{
    feed("#KP 1\n#KD 2\r\n#KI 3\r");
    wait();
    assert_line("#KP 1");
    wait();
    assert_line("#KD 2");
    wait();
    assert_line("#KI 3");
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_thirty_two_lines_wait_and_the_ones_after_are_counted_as_lost(void)
{
    for (unsigned n = 0; n < 32U + 5U; n++) {
        feed_numbered(n);
    }
    wait();
    assert_numbered(0);
    TEST_ASSERT_EQUAL_UINT16(5, missed);
    for (unsigned n = 1; n < 32U; n++) {
        wait();
        assert_numbered(n);
        TEST_ASSERT_EQUAL_UINT16(0, missed);
    }
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_the_thirty_second_line_is_not_lost(void)
{
    for (unsigned n = 0; n < 32U; n++) {
        feed_numbered(n);
    }
    for (unsigned n = 0; n < 32U; n++) {
        wait();
        assert_numbered(n);
        TEST_ASSERT_EQUAL_UINT16(0, missed);
    }
}

void test_one_line_taken_makes_room_for_one(void)
{
    for (unsigned n = 0; n < 32U; n++) {
        feed_numbered(n);
    }
    wait();
    feed_numbered(100);
    feed_numbered(101);
    for (unsigned n = 1; n < 32U; n++) {
        wait();
        assert_numbered(n);
        TEST_ASSERT_EQUAL_UINT16(n == 1U ? 1U : 0U, missed);
    }
    wait();
    assert_numbered(100);
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_the_queue_goes_round_without_mixing_lines(void)
{
    unsigned in = 0;
    unsigned out = 0;

    kernel_random_seed(99U);
    while (in < 1000U) {
        for (uint16_t n = kernel_random(8U); n > 0U && in - out < 32U; n--) {
            feed_numbered(in++);
        }
        for (uint16_t n = kernel_random(8U); n > 0U && out < in; n--) {
            wait();
            assert_numbered(out++);
            TEST_ASSERT_EQUAL_UINT16(0, missed);
        }
    }
}

void test_a_line_in_reception_does_not_touch_one_that_waits(void)
{
    feed("#SETR 0.6\n#KP 0.99999");
    wait();
    assert_line("#SETR 0.6");
}

void test_an_overlong_line_is_handed_over_as_such(void)
{
    feed("#PING 1234567890123456789012345678901234567890\n");
    wait();
    TEST_ASSERT_TRUE(message.line.overlong);
    feed("#PING\n");
    wait();
    TEST_ASSERT_FALSE(message.line.overlong);
}

void test_flag_bits_above_an_octet_are_dropped(void)
{
    for (const char *text = "#KP 1\n"; *text != '\0'; text++) {
        octet((uint16_t)((uint16_t)*text | 0xC000U));
    }
    wait();
    assert_line("#KP 1");
}

void test_the_copy_is_made_with_interrupts_off(void)
{
    feed("#KP 1\n");
    kernel.hwi.disabled = 0U;
    wait();
    TEST_ASSERT_EQUAL_UINT16(1, kernel.hwi.disabled);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.swi.disabled);
}

static void burst_of(const char *text, bool overrun, bool framing)
{
    bsp_uart_burst_t burst = {.overrun = overrun, .framing = framing};

    for (; *text != '\0'; text++) {
        TEST_ASSERT_LESS_THAN(BSP_UART_FIFO_DEPTH, burst.count);
        burst.octets[burst.count++] = (uint16_t)*text;
    }
    (void)receiver(&burst);
}

void test_two_lines_in_one_burst_are_both_kept(void)
{
    burst_of("#KP 1\n#KD 2\n", false, false);
    TEST_ASSERT_EQUAL_INT(0, kernel.semaphore.count);
    kernel_run_swi();
    wait();
    assert_line("#KP 1");
    wait();
    assert_line("#KD 2");
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_lines_of_several_bursts_before_the_swi_runs_are_all_kept(void)
{
    for (unsigned n = 0; n < 10U; n++) {
        char text[16];

        (void)snprintf(text, sizeof text, "#PING %u\n", n);
        burst_of(text, false, false);
    }
    kernel_run_swi();
    TEST_ASSERT_EQUAL_INT(10, kernel.semaphore.count);
    for (unsigned n = 0; n < 10U; n++) {
        wait();
        assert_numbered(n);
    }
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_a_swi_posted_for_lines_already_announced_announces_none_twice(void)
{
    feed("#KP 1\n");
    kernel.swi.posted = true;
    kernel_run_swi();
    TEST_ASSERT_EQUAL_INT(1, kernel.semaphore.count);
    wait();
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

/* A command, two bursts around the octets that were lost or mangled. */
static void assert_damaged(const char *before, const char *with_error, const char *after, bool overrun)
{
    feed(before);
    burst_of(with_error, overrun, !overrun);
    feed(after);
    kernel_run_swi();
    wait();
    TEST_ASSERT_TRUE_MESSAGE(message.line.damaged, after);
    feed("#KP 1\n");
    wait();
    assert_line("#KP 1");
    TEST_ASSERT_FALSE(message.line.damaged);
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

/* 0.3 m must not become 3 m. */
void test_a_reference_that_lost_its_decimal_point_is_damaged(void)
{
    for (uint16_t kind = 0; kind < 2U; kind++) {
        assert_damaged("#SETR ", "3", "\n", kind == 0U);
        assert_damaged("#SETR ", "", "3\n", kind == 0U);
        assert_damaged("#SETR ", "3\n", "", kind == 0U);
        assert_damaged("", "#SETR ", "3\n", kind == 0U);
        assert_damaged("", "#SETR 3\n", "", kind == 0U);
        assert_damaged("", "#", "SETR 3\n", kind == 0U);
        assert_damaged("#SETR 3", "\n", "", kind == 0U);
    }
}

void test_no_line_with_an_octet_in_a_damaged_burst_passes_for_whole(void)
{
    static const char text[] = "#SETR 0.3\n#SETR 0.3\n";
    const size_t length = strlen(text);

    for (size_t begin = 0; begin < length; begin++) {
        for (size_t size = 1; size <= BSP_UART_FIFO_DEPTH && begin + size <= length; size++) {
            char part[sizeof text];

            (void)memcpy(part, text, begin);
            part[begin] = '\0';
            feed(part);
            (void)memcpy(part, &text[begin], size);
            part[size] = '\0';
            burst_of(part, true, false);
            feed(&text[begin + size]);
            kernel_run_swi();
            wait();
            TEST_ASSERT_EQUAL(begin < 10U, message.line.damaged);
            wait();
            TEST_ASSERT_EQUAL(begin + size > 10U, message.line.damaged);
        }
    }
}

void test_an_answer_goes_out_at_once_when_there_is_room(void)
{
    const telemetry_line_t line = line_of("OK KP 0.015\r\n");

    room = 13U;
    xbee_port_answer(&line);
    TEST_ASSERT_EQUAL_STRING("OK KP 0.015\r\n", sent);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.task.sleeps);
}

static void ten_octets_leave(void)
{
    TEST_ASSERT_EQUAL_STRING("", sent);
    room = (uint16_t)(room + 10U);
}

void test_an_answer_sleeps_ten_ticks_at_a_time_until_it_fits_and_is_sent_once(void)
{
    const telemetry_line_t line = line_of("OK KP 0.0150123456789\r\n"); /* 23 */

    room = 0U;
    kernel.task.on_sleep = ten_octets_leave;
    xbee_port_answer(&line);
    TEST_ASSERT_EQUAL_STRING("OK KP 0.0150123456789\r\n", sent);
    TEST_ASSERT_EQUAL_UINT16(3, kernel.task.sleeps);
    TEST_ASSERT_EQUAL_UINT32(10, kernel.task.slept_ticks);
    TEST_ASSERT_EQUAL_UINT16(4, sends);
}

static void answer(void)
{
    const telemetry_line_t line = line_of("OK\r\n");

    xbee_port_answer(&line);
}

void test_an_answer_never_gives_up(void)
{
    room = 3U;
    TEST_ASSERT_TRUE(kernel_blocks(answer));
    TEST_ASSERT_EQUAL_STRING("", sent);
}

void test_a_report_needs_half_of_the_buffer_free(void)
{
    const telemetry_line_t line = line_of("alt:-\r\n");

    room = 511U;
    xbee_port_report(&line);
    TEST_ASSERT_EQUAL_STRING("", sent);
    TEST_ASSERT_EQUAL_UINT16(0, sends);
    room = 512U;
    xbee_port_report(&line);
    TEST_ASSERT_EQUAL_STRING("alt:-\r\n", sent);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.task.sleeps);
}

void test_a_line_of_a_stream_is_dropped_when_four_of_its_length_wait(void)
{
    const telemetry_line_t line = line_of("P19997\r\n");

    room = UART_PORT_TRANSMIT_CELLS - 33U;
    xbee_port_stream(&line);
    TEST_ASSERT_EQUAL_STRING("", sent);
    room = UART_PORT_TRANSMIT_CELLS - 32U;
    xbee_port_stream(&line);
    TEST_ASSERT_EQUAL_STRING("P19997\r\n", sent);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.task.sleeps);
}

void test_a_line_of_a_long_answer_leaves_at_most_a_fifth_of_a_second_to_go(void)
{
    const telemetry_line_t line = line_of("OK LOG 1\r\n");

    room = UART_PORT_TRANSMIT_CELLS - 192U + 9U;
    TEST_ASSERT_FALSE(xbee_port_spare(&line));
    TEST_ASSERT_EQUAL_STRING("", sent);
    TEST_ASSERT_EQUAL_UINT16(0, sends);
    room++;
    TEST_ASSERT_TRUE(xbee_port_spare(&line));
    TEST_ASSERT_EQUAL_STRING("OK LOG 1\r\n", sent);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.task.sleeps);
}

/* One of 256 characters never leaves so little behind it. */
void test_a_line_longer_than_that_goes_when_nothing_else_is_to_go(void)
{
    telemetry_line_t line;

    telemetry_begin_answer(&line);
    while (line.length < TELEMETRY_ANSWER_MAX) {
        telemetry_text(&line, "x");
    }
    room = UART_PORT_TRANSMIT_CELLS - 1U;
    TEST_ASSERT_FALSE(xbee_port_spare(&line));
    room = UART_PORT_TRANSMIT_CELLS;
    TEST_ASSERT_TRUE(xbee_port_spare(&line));
}

/* What is let in then, 256 characters at most, leaves a report the half of the buffer that it needs. */
void test_the_radio_is_clear_while_a_fifth_of_a_second_is_to_go(void)
{
    room = UART_PORT_TRANSMIT_CELLS - 193U;
    TEST_ASSERT_FALSE(xbee_port_clear());
    room++;
    TEST_ASSERT_TRUE(xbee_port_clear());
    TEST_ASSERT_GREATER_OR_EQUAL(UART_PORT_TRANSMIT_CELLS / 2U, room - TELEMETRY_ANSWER_MAX);
}

void test_an_urgent_line_goes_before_all_that_wait_and_marks_them_as_overtaken(void)
{
    feed("#SETR 0.6\n#GET\n");
    TEST_ASSERT_FALSE(xbee_port_pressing());
    feed("#SETR 0\n#PING 1\n");
    TEST_ASSERT_TRUE(xbee_port_pressing());
    wait();
    assert_line("#SETR 0");
    TEST_ASSERT_FALSE(message.overtaken);
    TEST_ASSERT_FALSE(xbee_port_pressing());
    wait();
    assert_line("#SETR 0.6");
    TEST_ASSERT_TRUE(message.overtaken);
    wait();
    assert_line("#GET");
    TEST_ASSERT_TRUE(message.overtaken);
    wait();
    assert_line("#PING 1");
    TEST_ASSERT_FALSE(message.overtaken);
    feed("#SETR 0.6\n");
    wait();
    TEST_ASSERT_FALSE(message.overtaken);
}

void test_a_full_queue_keeps_no_stop_out(void)
{
    for (unsigned n = 0; n < 32U + 5U; n++) {
        feed_numbered(n);
    }
    feed("#STOP\n#LAND\n");
    wait();
    assert_line("#STOP");
    TEST_ASSERT_EQUAL_UINT16(5, missed);
    wait();
    assert_line("#LAND");
    wait();
    assert_numbered(0);
}

void test_of_many_urgent_lines_the_newest_is_never_lost_and_none_counts_as_lost(void)
{
    feed("#STOP 1\n#STOP 2\n#STOP 3\n#STOP 4\n#STOP 5\n#LAND\n");
    wait();
    TEST_ASSERT_EQUAL_UINT16(0, missed);
    assert_line("#STOP 1");
    wait();
    assert_line("#STOP 2");
    wait();
    assert_line("#STOP 3");
    wait();
    assert_line("#LAND");
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_bare_lines_go_before_commands_and_are_one_however_many(void)
{
    feed("#PING 1\nstop\n\n\n");
    TEST_ASSERT_TRUE(xbee_port_pressing());
    wait();
    TEST_ASSERT_TRUE(message.line.bare);
    wait();
    assert_line("#PING 1");
    TEST_ASSERT_FALSE(message.line.bare);
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_a_complete_line_waits_until_it_is_taken(void)
{
    TEST_ASSERT_FALSE(xbee_port_waiting());
    feed("#PING");
    TEST_ASSERT_FALSE(xbee_port_waiting());
    feed("\n");
    TEST_ASSERT_TRUE(xbee_port_waiting());
    wait();
    TEST_ASSERT_FALSE(xbee_port_waiting());
}
