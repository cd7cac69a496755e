/* From the octets of a receive interrupt to the message of TaskIMU. */
#include "firmware/imu_port.h"

#include <string.h>

#include "jobs.h"
#include "kernel.h"
#include "mock_cpu_time.h"
#include "mock_timebase.h"
#include "mock_uart_port.h"
#include "unity.h"

#define FRAME "#A-C=1.00,-2.00,256.00\r\n#YPR=10.00,-5.25,3.50\r\n"
#define FRAME_TEXT "#A-C=1.00,-2.00,256.00\n#YPR=10.00,-5.25,3.50"
#define ANGLES "#YPR=1.00,2.00,3.00\r\n"
#define ANGLES_TEXT "#YPR=1.00,2.00,3.00"

static uart_port_received_t receiver;
static uint32_t now_us;
static imu_message_t message;

static void port_create(bsp_uart_t uart, uint32_t bit_rate, uart_port_received_t received, int calls)
{
    TEST_ASSERT_EQUAL_INT(0, calls);
    TEST_ASSERT_EQUAL(BSP_UART_IMU, uart);
    TEST_ASSERT_EQUAL_UINT32(57600, bit_rate);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.swi.created);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.semaphore.created);
    receiver = received;
    kernel_note("create");
}

static bool port_send(bsp_uart_t uart, const char *text, uint16_t count, int calls)
{
    TEST_ASSERT_EQUAL_INT(0, calls);
    TEST_ASSERT_EQUAL(BSP_UART_IMU, uart);
    TEST_ASSERT_EQUAL_UINT16(3, count);
    TEST_ASSERT_EQUAL_STRING_LEN("#o1", text, 3);
    kernel_note("send");
    return true;
}

static uint32_t time_us(int calls)
{
    (void)calls;
    return now_us;
}

void setUp(void)
{
    kernel_reset();
    now_us = 1000U;
    (void)memset(&message, 0x5A, sizeof message);
    uart_port_create_Stub(port_create);
    uart_port_send_Stub(port_send);
    bsp_time_us_Stub(time_us);
    jobs_reset();
    cpu_time_watch_Expect(CPU_TIME_IMU_SWI, NULL);
    cpu_time_watch_IgnoreArg_handle();
    imu_port_create();
}

void tearDown(void)
{
    kernel_check();
}

static void octet(uint16_t cell)
{
    bsp_uart_burst_t burst = {.count = 1U, .octets = {cell}};

    now_us += 174U;                                              /* ten bits at 57600 */
    TEST_ASSERT_EQUAL_UINT16(UART_PORT_BURST, receiver(&burst)); /* the tick brings the end of a frame */
    kernel_run_swi();
}

static void feed(const char *text)
{
    for (; *text != '\0'; text++) {
        octet((uint16_t)*text);
    }
}

/* One interrupt, up to 16 octets. */
static void feed_burst(const char *text, bool overrun, bool framing)
{
    bsp_uart_burst_t burst = {.overrun = overrun, .framing = framing};

    for (; *text != '\0'; text++) {
        TEST_ASSERT_LESS_THAN(BSP_UART_FIFO_DEPTH, burst.count);
        burst.octets[burst.count++] = (uint16_t)*text;
    }
    TEST_ASSERT_EQUAL_UINT16(UART_PORT_BURST, receiver(&burst));
    kernel_run_swi();
}

static void wait(void)
{
    imu_port_wait(&message);
}

static void assert_text(const char *expected)
{
    TEST_ASSERT_EQUAL_UINT16(strlen(expected), message.text.length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, message.text.text, message.text.length);
}

void test_create_makes_the_swi_and_a_binary_semaphore_then_the_uart_then_asks_for_the_stream(void)
{
    TEST_ASSERT_EQUAL_STRING("create send ", kernel.notes);
    TEST_ASSERT_EQUAL_STRING("IMU_SWI", kernel.swi.name);
    TEST_ASSERT_EQUAL_UINT(3, kernel.swi.params.priority);
    TEST_ASSERT_EQUAL(Semaphore_Mode_BINARY, kernel.semaphore.mode);
    TEST_ASSERT_EQUAL_INT(0, kernel.semaphore.count);
}

void test_the_task_waits_until_the_last_octet_of_a_frame(void)
{
    TEST_ASSERT_TRUE(kernel_blocks(wait));
    for (size_t i = 0; i + 2U < strlen(FRAME); i++) {
        octet((uint16_t)FRAME[i]);
        TEST_ASSERT_EQUAL_UINT16(0, kernel.swi.posts);
    }
    TEST_ASSERT_TRUE(kernel_blocks(wait));
    octet('\r');
    TEST_ASSERT_EQUAL_UINT16(1, kernel.swi.posts);
    wait();
    assert_text(FRAME_TEXT);
    octet('\n');
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_a_frame_has_the_time_of_its_last_octet(void)
{
    feed("#YPR=1.00,2.00,3.00");
    now_us = 70000U;
    octet('\r');
    now_us = 99000U;
    octet('\n');
    wait();
    TEST_ASSERT_EQUAL_UINT32(70174, message.arrival_us);
}

void test_each_frame_comes_once_and_in_turn(void)
{
    for (uint16_t n = 0; n < 5U; n++) {
        feed(FRAME);
        wait();
        assert_text(FRAME_TEXT);
        feed(ANGLES);
        wait();
        assert_text(ANGLES_TEXT);
        TEST_ASSERT_TRUE(kernel_blocks(wait));
    }
    TEST_ASSERT_EQUAL_UINT16(10, kernel.swi.posts);
}

void test_a_late_task_gets_the_newest_frame_once(void)
{
    feed(FRAME);
    feed(ANGLES);
    wait();
    assert_text(ANGLES_TEXT);
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_a_frame_in_reception_does_not_touch_the_one_that_waits(void)
{
    feed(FRAME);
    feed("#A-C=9.00,9.00,9.00\r\n#YPR=9.00");
    wait();
    assert_text(FRAME_TEXT);
}

void test_the_copy_is_made_with_swis_off(void)
{
    feed(FRAME);
    wait();
    TEST_ASSERT_EQUAL_UINT16(1, kernel.swi.disabled);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.swi.depth);
}

void test_flag_bits_above_an_octet_are_dropped(void)
{
    for (const char *text = ANGLES; *text != '\0'; text++) {
        octet((uint16_t)((uint16_t)*text | 0xC000U));
    }
    wait();
    assert_text(ANGLES_TEXT);
}

static void lose_a_part_of_a_frame(bool overrun, bool framing)
{
    feed("#YPR=1.0");
    feed_burst("0,2.00", overrun, framing);
    feed(",3.00\r\n");
    TEST_ASSERT_TRUE(kernel_blocks(wait));
    feed(ANGLES);
    wait();
    assert_text(ANGLES_TEXT);
}

void test_an_overrun_drops_the_frame_under_way_and_no_other(void)
{
    lose_a_part_of_a_frame(true, false);
}

void test_a_framing_error_drops_the_frame_under_way_and_no_other(void)
{
    lose_a_part_of_a_frame(false, true);
}

/* Which octet an error has hit is not known, and a frame without one of its digits may look right. */
void test_an_error_costs_the_frame_that_begins_in_the_same_burst_too(void)
{
    for (uint16_t kind = 0; kind < 2U; kind++) {
        feed("#YPR=7.00,7");
        feed_burst("#YPR=1", kind == 0U, kind == 1U);
        feed(".00,2.00,3.00\r\n");
        TEST_ASSERT_TRUE(kernel_blocks(wait));
        feed_burst("#YPR=1,2,3\r\n", kind == 0U, kind == 1U);
        TEST_ASSERT_TRUE(kernel_blocks(wait));
        feed(ANGLES);
        wait();
        assert_text(ANGLES_TEXT);
    }
}

/* How many "#YPR=...\r" of the text stand wholly outside begin..end. */
static uint16_t intact(const char *text, size_t begin, size_t end)
{
    uint16_t count = 0;

    for (const char *angles = strstr(text, "#Y"); angles != NULL; angles = strstr(angles + 1, "#Y")) {
        const size_t first = (size_t)(angles - text);
        const size_t last = first + strcspn(angles, "\r");

        count = (uint16_t)(count + ((end <= first || begin > last) ? 1U : 0U));
    }
    return count;
}

void test_wherever_a_burst_with_an_error_stands_the_frames_outside_it_come_and_no_other(void)
{
    static const char text[] = FRAME ANGLES FRAME;
    const size_t length = strlen(text);

    for (size_t begin = 0; begin < length; begin++) {
        for (size_t size = 1; size <= BSP_UART_FIFO_DEPTH && begin + size <= length; size++) {
            char part[sizeof text];

            kernel.swi.posts = 0U;
            (void)memcpy(part, text, begin);
            part[begin] = '\0';
            feed(part);
            (void)memcpy(part, &text[begin], size);
            part[size] = '\0';
            feed_burst(part, true, false);
            feed(&text[begin + size]);
            TEST_ASSERT_EQUAL_UINT16(intact(text, begin, begin + size), kernel.swi.posts);
        }
    }
}

void test_a_frame_in_bursts_of_sixteen_arrives_whole(void)
{
    feed_burst("#A-C=1.00,-2.00,", false, false);
    feed_burst("256.00\r\n#YPR=10.", false, false);
    feed_burst("00,-5.25,3.50\r\n", false, false);
    wait();
    assert_text(FRAME_TEXT);
}

void test_an_empty_burst_changes_nothing(void)
{
    feed("#YPR=1.00,2");
    feed_burst("", false, false);
    feed(".00,3.00\r\n");
    wait();
    assert_text(ANGLES_TEXT);
}

void test_the_task_is_released_by_the_last_octet_of_a_frame(void)
{
    feed("#YPR=1.00,2.00,3.00");
    TEST_ASSERT_EQUAL_UINT16(0, jobs[MONITOR_IMU].released);
    now_us = 70000U;
    octet('\r');
    TEST_ASSERT_EQUAL_UINT16(1, jobs[MONITOR_IMU].released);
    TEST_ASSERT_EQUAL_UINT32(70174, jobs[MONITOR_IMU].released_us);
}
