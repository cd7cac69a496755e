/* The scanner's port with the real driver, stepped as TaskSendLaser does it and fed as the receive Hwi is:
 * the sensor's side is written here after its protocol (Hokuyo C-42-03320B). */
#include "firmware/laser_port.h"

#include <string.h>

#include "jobs.h"
#include "kernel.h"
#include "mock_cpu_time.h"
#include "mock_timebase.h"
#include "mock_uart_port.h"
#include "mock_usb_port.h"
#include "tests/support/scip_frames.h"
#include "unity.h"

#define POINTS 35U   /* steps 372..406 */
#define OCTET_US 40U /* ten bits at 250000 */

static uart_port_received_t receiver;
static uint32_t now_us;
static uint32_t reopened_at;
static char sent[64];
static uint16_t sent_count;
static const char *answer_while_sending; /* comes before uart_port_send() returns, or NULL */
static unsigned usb_starts, usb_lines;   /* of the USB port, which shares the transmitter */
static bool usb_ended;
static uint16_t level; /* octets until the port wants to be called again */
static laser_message_t message;
static laser_statistics_t now;
static laser_statistics_t before;
static const urg_config_t config = {
    .first_rate = 115200U,
    .stream_rate = 250000U,
    .fastest_rate = 250000U,
    .stream = SCIP_STREAM_2,
    .range = {.first_step = 372U, .last_step = 406U, .cluster = 1U},
};

static void port_create(bsp_uart_t uart, uint32_t bit_rate, uart_port_received_t received, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL(BSP_UART_LASER, uart);
    TEST_ASSERT_EQUAL_UINT32(115200, bit_rate);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.swi.created);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.semaphore.created);
    receiver = received;
    kernel_note("create");
}

static void port_reopen(bsp_uart_t uart, uint32_t bit_rate, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL(BSP_UART_LASER, uart);
    kernel_no_lock();
    kernel_note("reopen");
    reopened_at = bit_rate;
}

static uint32_t time_us(int calls)
{
    (void)calls;
    return now_us;
}

/* As the Hwi does it, without the Swi. */
static void octet(uint16_t cell)
{
    bsp_uart_burst_t burst = {.count = 1U, .octets = {cell}};

    TEST_ASSERT_EQUAL(0, kernel.hwi.depth);
    now_us += OCTET_US;
    level = receiver(&burst);
}

static void feed_only(const char *text)
{
    for (; *text != '\0'; text++) {
        octet((uint16_t)*text);
    }
}

static void feed(const char *text)
{
    for (; *text != '\0'; text++) {
        octet((uint16_t)*text);
        kernel_run_swi();
    }
}

static void feed_broken(const char *text, bool overrun, bool framing)
{
    bsp_uart_burst_t burst = {.overrun = overrun, .framing = framing};

    for (; *text != '\0'; text++) {
        TEST_ASSERT_LESS_THAN(BSP_UART_FIFO_DEPTH, burst.count);
        burst.octets[burst.count++] = (uint16_t)*text;
    }
    level = receiver(&burst);
    kernel_run_swi();
}

static bool port_send(bsp_uart_t uart, const char *text, uint16_t count, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL(BSP_UART_LASER, uart);
    TEST_ASSERT_LESS_THAN(sizeof sent, count);
    TEST_ASSERT_TRUE_MESSAGE(usb_ended, "the USB port would hear it, not the scanner");
    kernel_no_lock();
    kernel_note("send");
    (void)memcpy(sent, text, count);
    sent[count] = '\0';
    sent_count = count;
    if (answer_while_sending != NULL) {
        feed(answer_while_sending);
    }
    return true;
}

static void usb_start(int calls)
{
    (void)calls;
    TEST_ASSERT_NOT_NULL_MESSAGE(receiver, "before its UART is open");
    usb_starts++;
}

static void usb_step(int calls)
{
    (void)calls;
    usb_lines++;
}

static void usb_end(int calls)
{
    (void)calls;
    usb_ended = true;
}

static void wait(void)
{
    laser_port_wait(&message);
}

static void look(void)
{
    laser_port_statistics(&now);
}

/* 150 ms later. What is sent is in `sent`; nothing is an empty text. */
static void step(void)
{
    now_us += 150000U;
    sent[0] = '\0';
    sent_count = 0U;
    laser_port_step(&now);
}

static void expect_sent(const char *text)
{
    step();
    TEST_ASSERT_EQUAL_STRING(text, sent);
    TEST_ASSERT_EQUAL_UINT16(strlen(text), sent_count);
}

/* The sensor has been asked for another rate. */
static void until_rate(void)
{
    expect_sent("\nL0\n");
    feed("L0\n0\n\n");
    expect_sent("SCIP2.0\n");
    feed("SCIP2.0\n0\n\n");
    expect_sent("SS250000\n");
    look();
    before = now;
}

static void until_stop(void)
{
    until_rate();
    feed("SS250000\n00P\n\n");
    expect_sent("");
    expect_sent("\nQT\n");
    TEST_ASSERT_EQUAL_UINT32(250000, reopened_at);
    look();
    before = now;
}

static void start_stream(void)
{
    until_stop();
    feed("QT\n00P\n\n");
    expect_sent("MS0372040601000\n");
    feed("MS0372040601000\n00P\n\n");
    look();
    TEST_ASSERT_EQUAL_UINT32(5, now.urg.seen.reply_count);
    TEST_ASSERT_EQUAL(URG_STREAM, now.urg.status);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.swi.posts);
    before = now;
}

void setUp(void)
{
    kernel_reset();
    now_us = 5000U;
    reopened_at = 0U;
    answer_while_sending = NULL;
    uart_port_create_Stub(port_create);
    uart_port_reopen_Stub(port_reopen);
    uart_port_send_Stub(port_send);
    bsp_time_us_Stub(time_us);
    usb_port_start_Stub(usb_start);
    usb_port_step_Stub(usb_step);
    usb_port_end_Stub(usb_end);
    usb_starts = usb_lines = 0U;
    usb_ended = false;
    jobs_reset();
    cpu_time_watch_Expect(CPU_TIME_LASER_SWI, NULL);
    cpu_time_watch_IgnoreArg_handle();
    laser_port_create(&config);
}

void tearDown(void)
{
    kernel_check();
}

/* One frame of the stream 372..406: distances first_mm, first_mm + 1, ... */
static const char *scan_text(uint32_t stamp_ms, uint16_t first_mm)
{
    static char text[256];
    char data[2U * POINTS];

    for (uint16_t i = 0; i < POINTS; i++) {
        scip_frames_encode(&data[2U * i], (unsigned long)first_mm + i, 2U);
    }
    (void)scip_frames_frame(text, "MS0372040601000", stamp_ms, data, sizeof data);
    return text;
}

static void assert_scan(uint32_t stamp_ms, uint16_t first_mm)
{
    TEST_ASSERT_EQUAL_UINT16(POINTS, message.scan.points);
    TEST_ASSERT_EQUAL_UINT16(372, message.scan.first_step);
    TEST_ASSERT_EQUAL_UINT32(stamp_ms, message.scan.timestamp_ms);
    TEST_ASSERT_EQUAL_PTR(message.distance_mm, message.scan.distance_mm);
    for (uint16_t i = 0; i < POINTS; i++) {
        TEST_ASSERT_EQUAL_UINT16(first_mm + i, message.distance_mm[i]);
    }
}

void test_create_makes_the_swi_and_a_binary_semaphore_then_the_uart(void)
{
    TEST_ASSERT_EQUAL_STRING_LEN("create ", kernel.notes, 7);
    TEST_ASSERT_EQUAL_STRING("Laser_SWI", kernel.swi.name);
    TEST_ASSERT_EQUAL_UINT(2, kernel.swi.params.priority);
    TEST_ASSERT_EQUAL(Semaphore_Mode_BINARY, kernel.semaphore.mode);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.semaphore.created);
}

void test_while_the_scanner_starts_up_the_usb_port_speaks_with_each_step_and_never_again(void)
{
    urg_config_t waiting = config;

    TEST_ASSERT_EQUAL_UINT_MESSAGE(0U, usb_starts, "nothing waits");
    waiting.wait_us = 1000000U;
    kernel_reset();
    cpu_time_watch_Expect(CPU_TIME_LASER_SWI, NULL);
    cpu_time_watch_IgnoreArg_handle();
    laser_port_create(&waiting);
    TEST_ASSERT_EQUAL_UINT(1U, usb_starts);
    for (unsigned i = 1U; i <= 6U; i++) {
        step();
        TEST_ASSERT_EQUAL_UINT(i, usb_lines);
        TEST_ASSERT_FALSE(usb_ended);
    }
    step();
    TEST_ASSERT_EQUAL_UINT(6U, usb_lines);
    TEST_ASSERT_TRUE(usb_ended);
    TEST_ASSERT_NOT_EQUAL_UINT(0U, sent_count);
}

void test_the_task_waits_while_nothing_is_complete(void)
{
    TEST_ASSERT_TRUE(kernel_blocks(wait));
    start_stream();
    feed("MS0372040601000\n99b\n");
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_a_step_sends_what_the_link_asks_for_and_sets_the_rate_before(void)
{
    until_rate();
    feed("SS250000\n00P\n\n");
    expect_sent("");
    TEST_ASSERT_EQUAL_UINT32(0, reopened_at);
    kernel.notes[0] = '\0';
    expect_sent("\nQT\n");
    TEST_ASSERT_EQUAL_UINT32(250000, reopened_at);
    TEST_ASSERT_EQUAL_STRING("reopen send ", kernel.notes);
    TEST_ASSERT_EQUAL_UINT32(250000, now.urg.rate);
}

void test_a_reply_is_awaited_before_the_request_is_on_the_wire(void)
{
    answer_while_sending = "L0\n0\n\n";
    expect_sent("\nL0\n");
    look();
    TEST_ASSERT_EQUAL_UINT32(1, now.urg.seen.reply_count);
    TEST_ASSERT_EQUAL(SCIP_LASER_OFF_1, now.urg.seen.reply_kind);
}

void test_a_reply_is_counted_with_its_kind_and_status(void)
{
    until_rate();
    feed("SS250000\n03S\n\n");
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.reply_count + 1U, now.urg.seen.reply_count);
    TEST_ASSERT_EQUAL(SCIP_BIT_RATE, now.urg.seen.reply_kind);
    TEST_ASSERT_EQUAL_HEX16('0', now.urg.seen.reply.status[0]);
    TEST_ASSERT_EQUAL_HEX16('3', now.urg.seen.reply.status[1]);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.swi.posts);
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.octet_count + 14U, now.urg.seen.octet_count);
}

void test_the_reply_of_an_older_request_is_not_taken_for_the_present_one(void)
{
    until_rate();
    feed("QT\n00P\n\n");
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.reply_count, now.urg.seen.reply_count);
    feed("SS250000\n00P\n\n");
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.reply_count + 1U, now.urg.seen.reply_count);
}

void test_a_scip11_refusal_is_counted(void)
{
    until_stop();
    feed("QT\nE\n\n");
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.legacy_count + 1U, now.urg.seen.legacy_count);
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.reply_count, now.urg.seen.reply_count);
}

void test_a_notice_of_the_stream_is_counted_with_its_status(void)
{
    char text[64] = "MS0372040601000\n";

    start_stream();
    (void)scip_frames_summed(text + strlen(text), "21", 2U);
    feed(strcat(text, "\n"));
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.notice_count + 1U, now.urg.seen.notice_count);
    TEST_ASSERT_EQUAL_HEX16('2', now.urg.seen.notice.status[0]);
    TEST_ASSERT_EQUAL_HEX16('1', now.urg.seen.notice.status[1]);
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.reply_count, now.urg.seen.reply_count);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.swi.posts);
}

void test_a_scan_is_handed_over_at_its_last_octet_with_the_time_of_that_octet(void)
{
    const char *text;

    start_stream();
    text = scan_text(123456U, 700U);
    while (text[1] != '\0') {
        octet((uint16_t)*text++);
        TEST_ASSERT_EQUAL_UINT16(0, kernel.swi.posts);
    }
    now_us = 1000000U;
    octet('\n');
    TEST_ASSERT_EQUAL_UINT16(1, kernel.swi.posts);
    now_us = 1500000U;
    kernel_run_swi();
    wait();
    assert_scan(123456U, 700U);
    TEST_ASSERT_EQUAL_UINT32(1000000U + OCTET_US, message.arrival_us);
    TEST_ASSERT_EQUAL_UINT32(250000U, message.bit_rate);
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.scan_count + 1U, now.urg.seen.scan_count);
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.octet_count + 101U,
                             now.urg.seen.octet_count); /* 27 + 2n + 2 ceil(2n / 64) */
}

void test_scans_alternate_between_the_two_buffers_and_all_arrive(void)
{
    start_stream();
    for (uint16_t n = 0; n < 7U; n++) {
        feed(scan_text(1000U + 100U * n, (uint16_t)(500U + 100U * n)));
        wait();
        assert_scan(1000U + 100U * n, (uint16_t)(500U + 100U * n));
        look();
        TEST_ASSERT_EQUAL_UINT32(before.urg.seen.scan_count + n + 1U, now.urg.seen.scan_count);
    }
}

void test_the_next_scan_in_reception_does_not_touch_the_complete_one(void)
{
    char half[80];

    start_stream();
    feed_only(scan_text(1000U, 700U));
    (void)memcpy(half, scan_text(1100U, 2000U), 79U);
    half[79] = '\0';
    feed_only(half); /* before Laser_SWI has run */
    kernel_run_swi();
    wait();
    assert_scan(1000U, 700U);
    feed(&scan_text(1100U, 2000U)[79]);
    wait();
    assert_scan(1100U, 2000U);
}

void test_a_message_copied_out_is_the_tasks_own(void)
{
    start_stream();
    feed(scan_text(1000U, 700U));
    wait();
    feed(scan_text(1100U, 2000U));
    feed(scan_text(1200U, 3000U));
    assert_scan(1000U, 700U);
}

void test_another_reader_gets_each_scan_once_and_takes_none_away(void)
{
    static laser_message_t other;

    (void)memset(&other, 0, sizeof other);
    start_stream();
    TEST_ASSERT_FALSE(laser_port_newer(&other));
    feed(scan_text(1000U, 700U));
    TEST_ASSERT_TRUE(laser_port_newer(&other));
    TEST_ASSERT_EQUAL_UINT16(700U, other.scan.distance_mm[0]);
    TEST_ASSERT_EQUAL_PTR(other.distance_mm, other.scan.distance_mm);
    TEST_ASSERT_FALSE(laser_port_newer(&other));
    TEST_ASSERT_EQUAL_UINT16(700U, other.scan.distance_mm[0]);
    wait();
    assert_scan(1000U, 700U);
    feed(scan_text(1100U, 2000U));
    TEST_ASSERT_TRUE(laser_port_newer(&other));
    TEST_ASSERT_EQUAL_UINT16(2000U, other.scan.distance_mm[0]);
    wait();
}

void test_a_scan_comes_once(void)
{
    start_stream();
    feed(scan_text(1000U, 700U));
    wait();
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_only_scans_wake_the_task(void)
{
    char notice[64] = "MS0372040601000\n";
    char damaged[256];

    start_stream();
    (void)scip_frames_summed(notice + strlen(notice), "21", 2U);
    feed(strcat(notice, "\n"));
    (void)strcpy(damaged, scan_text(1000U, 700U));
    damaged[40] ^= 1;
    feed(damaged);
    feed("MS0372040601000\n00P\n\n");
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.notice_count + 1U, now.urg.seen.notice_count);
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.damage_count + 1U, now.urg.seen.damage_count);
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.reply_count + 1U, now.urg.seen.reply_count);
    TEST_ASSERT_EQUAL_UINT16(0, kernel.swi.posts);
    TEST_ASSERT_EQUAL_INT(0, kernel.semaphore.count);
}

void test_a_scan_that_waits_survives_a_reply_that_follows(void)
{
    start_stream();
    feed(scan_text(1000U, 700U));
    feed("MS0372040601000\n00P\n\n");
    wait();
    assert_scan(1000U, 700U);
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_a_late_task_gets_the_newest_scan_while_all_are_counted(void)
{
    start_stream();
    feed(scan_text(1000U, 700U));
    feed(scan_text(1100U, 800U));
    feed(scan_text(1200U, 900U));
    wait();
    assert_scan(1200U, 900U);
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.scan_count + 3U, now.urg.seen.scan_count);
    TEST_ASSERT_TRUE(kernel_blocks(wait));
}

void test_a_damaged_scan_is_counted_by_its_cause_gives_none_and_leaves_the_next_alone(void)
{
    char text[256];

    start_stream();
    (void)strcpy(text, scan_text(1000U, 700U));
    text[40] ^= 1;
    feed(text);
    TEST_ASSERT_TRUE(kernel_blocks(wait));
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.damage_count + 1U, now.urg.seen.damage_count);
    TEST_ASSERT_EQUAL_UINT32(before.urg.scip.damaged[SCIP_DAMAGE_SUM] + 1U,
                             now.urg.scip.damaged[SCIP_DAMAGE_SUM]);
    TEST_ASSERT_EQUAL(SCIP_DAMAGE_SUM, now.urg.last_damage);
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.scan_count, now.urg.seen.scan_count);
    feed(scan_text(1100U, 800U));
    wait();
    assert_scan(1100U, 800U);
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.scip.scans + 1U, now.urg.scip.scans);
    TEST_ASSERT_EQUAL(SCIP_DAMAGE_SUM, now.urg.last_damage);
}

void test_the_remaining_scans_of_a_counted_run_are_seen_and_its_end_orders_the_next(void)
{
    urg_config_t counted = config;
    char text[256];

    counted.range.scans = 2U;
    kernel_reset();
    cpu_time_watch_Ignore();
    laser_port_create(&counted);
    until_stop();
    feed("QT\n00P\n\n");
    expect_sent("MS0372040601002\n");
    feed("MS0372040601002\n00P\n\n");
    for (uint16_t left = 2U; left-- > 0U;) {
        (void)strcpy(text, scan_text(1000U + 100U * (2U - left), 700U));
        text[14] = (char)('0' + left);
        feed(text);
        wait();
        look();
        TEST_ASSERT_EQUAL_UINT16(left, now.urg.seen.scan_remaining);
    }
    expect_sent("MS0372040601002\n");
}

/* A burst with an error in the middle of a scan. */
static void break_a_scan(bool overrun, bool framing)
{
    char text[256];

    start_stream();
    (void)strcpy(text, scan_text(1000U, 700U));
    text[50] = '\0';
    feed(text);
    feed_broken("0", overrun, framing);
    feed(&text[51]);
    feed(scan_text(1100U, 800U));
    wait();
    assert_scan(1100U, 800U);
    TEST_ASSERT_TRUE(kernel_blocks(wait));
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.scan_count + 1U, now.urg.seen.scan_count);
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.framing_count + (framing ? 1U : 0U), now.urg.seen.framing_count);
    TEST_ASSERT_EQUAL_UINT32(before.overruns + (overrun ? 1U : 0U), now.overruns);
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.damage_count, now.urg.seen.damage_count);
}

void test_a_framing_error_costs_the_scan_under_way_and_is_counted_as_framing(void)
{
    break_a_scan(false, true);
}

void test_an_overrun_costs_the_scan_under_way_and_is_counted_as_overrun(void)
{
    break_a_scan(true, false);
}

void test_both_errors_in_one_burst_are_counted_each(void)
{
    break_a_scan(true, true);
}

void test_octets_are_counted_as_they_come_not_at_line_ends(void)
{
    until_rate();
    feed("abc");
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.octet_count + 3U, now.urg.seen.octet_count);
}

void test_what_was_read_after_an_overrun_is_taken(void)
{
    start_stream();
    feed("MS0372040601");
    feed_broken("MS0372040601", true, false);
    feed(&scan_text(1000U, 700U)[12]);
    wait();
    assert_scan(1000U, 700U);
}

void test_flag_bits_above_an_octet_are_dropped(void)
{
    start_stream();
    for (const char *text = scan_text(1000U, 700U); *text != '\0'; text++) {
        octet((uint16_t)((uint16_t)*text | 0xC000U));
    }
    kernel_run_swi();
    wait();
    assert_scan(1000U, 700U);
}

void test_scans_in_bursts_of_any_size_arrive_whole(void)
{
    start_stream();
    kernel_random_seed(11U);
    for (uint16_t n = 0; n < 200U; n++) {
        const char *text = scan_text(1000U + 100U * n, (uint16_t)(20U + 20U * n));

        while (*text != '\0') {
            bsp_uart_burst_t burst = {.count = 0U};
            const uint16_t size = (uint16_t)(1U + kernel_random(BSP_UART_FIFO_DEPTH));

            while (burst.count < size && *text != '\0') {
                burst.octets[burst.count++] = (uint16_t)*text++;
            }
            level = receiver(&burst);
            if (kernel_random(3U) == 0U) {
                kernel_run_swi();
            }
        }
        kernel_run_swi();
        wait();
        assert_scan(1000U + 100U * n, (uint16_t)(20U + 20U * n));
    }
}

void test_what_was_in_reception_at_a_new_rate_is_forgotten(void)
{
    until_rate();
    feed("SS250000\n00P\n\nQT\n00");
    step();
    step();
    TEST_ASSERT_EQUAL_UINT32(250000, reopened_at);
    look();
    before = now;
    feed("QT\n00P\n\n"); /* would be a damaged line, had the status been kept */
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.reply_count + 1U, now.urg.seen.reply_count);
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.damage_count, now.urg.seen.damage_count);
}

void test_statistics_are_copied_with_interrupts_off(void)
{
    kernel.hwi.disabled = 0U;
    look();
    TEST_ASSERT_EQUAL_UINT16(1, kernel.hwi.disabled);
}

void test_the_copy_to_the_task_is_made_with_swis_off_and_the_parser_touched_with_interrupts_off(void)
{
    start_stream();
    kernel.swi.disabled = 0U;
    kernel.hwi.disabled = 0U;
    feed(scan_text(1000U, 700U));
    TEST_ASSERT_EQUAL_UINT16(1, kernel.hwi.disabled); /* Laser_SWI */
    wait();
    TEST_ASSERT_EQUAL_UINT16(1, kernel.swi.disabled);
    step();
    TEST_ASSERT_EQUAL_UINT16(2, kernel.hwi.disabled);
}

void test_the_task_is_released_by_the_last_octet_of_a_scan(void)
{
    start_stream();
    feed(scan_text(1000U, 700U));
    TEST_ASSERT_EQUAL_UINT16(1, jobs[MONITOR_RECEIVE_LASER].released);
    TEST_ASSERT_EQUAL_UINT32(now_us, jobs[MONITOR_RECEIVE_LASER].released_us);
}

/* The FIFO as the levels empty it: returns the interrupts for that text; what is left in the FIFO at its end
 * stays. */
static bsp_uart_burst_t fifo;

static uint16_t arrive(const char *text)
{
    uint16_t interrupts = 0;

    for (; *text != '\0'; text++) {
        fifo.octets[fifo.count++] = (uint16_t)*text;
        now_us += OCTET_US;
        if (fifo.count >= (level < UART_PORT_BURST ? level : UART_PORT_BURST)) {
            level = receiver(&fifo);
            kernel_run_swi();
            fifo.count = 0U;
            interrupts++;
        }
    }
    return interrupts;
}

static void tick(void)
{
    level = receiver(&fifo);
    kernel_run_swi();
    fifo.count = 0U;
}

void test_the_last_octet_of_every_scan_makes_its_interrupt(void)
{
    start_stream();
    fifo.count = 0U;
    for (uint16_t n = 0; n < 50U; n++) {
        TEST_ASSERT_EQUAL_UINT16(13,
                                 arrive(scan_text(1000U + 100U * n, (uint16_t)(500U + n)))); /* 12 * 8 + 5 */
        TEST_ASSERT_EQUAL_UINT16(0, fifo.count);
        wait();
        assert_scan(1000U + 100U * n, (uint16_t)(500U + n));
        TEST_ASSERT_EQUAL_UINT32(now_us, message.arrival_us);
    }
}

void test_ticks_anywhere_between_leave_the_last_octets_interrupt_where_it_is(void)
{
    start_stream();
    fifo.count = 0U;
    kernel_random_seed(21U);
    for (uint16_t n = 0; n < 300U; n++) {
        char text[256];
        char part[2] = {0};

        (void)strcpy(text, scan_text(1000U + 100U * n, (uint16_t)(500U + n)));
        for (const char *at = text; *at != '\0'; at++) {
            part[0] = *at;
            (void)arrive(part);
            if (kernel_random(25U) == 0U && at[1] != '\0') {
                tick();
            }
        }
        TEST_ASSERT_EQUAL_UINT16(0, fifo.count);
        wait();
        assert_scan(1000U + 100U * n, (uint16_t)(500U + n));
        TEST_ASSERT_EQUAL_UINT32(now_us, message.arrival_us);
    }
}

/* Any number of octets lost anywhere costs that scan, with what is left of it fetched by the tick, and no
 * other. */
void test_lost_octets_cost_their_scan_alone(void)
{
    uint32_t stamp_ms = 1000U;

    start_stream();
    fifo.count = 0U;
    for (size_t from = 0; from < 101U; from += 3U) {
        for (size_t lost = 1; lost <= 20U && from + lost <= 101U; lost += 4U) {
            char text[256];

            (void)strcpy(text, scan_text(stamp_ms, 700U));
            (void)memmove(&text[from], &text[from + lost], strlen(&text[from + lost]) + 1U);
            (void)arrive(text);
            tick();
            tick();
            (void)kernel_blocks(wait);
            stamp_ms += 100U;
            (void)arrive(scan_text(stamp_ms, 800U));
            tick();
            wait();
            assert_scan(stamp_ms, 800U);
            stamp_ms += 100U;
            (void)arrive(scan_text(stamp_ms, 900U));
            TEST_ASSERT_EQUAL_UINT16(0, fifo.count);
            wait();
            assert_scan(stamp_ms, 900U);
            stamp_ms += 100U;
        }
    }
}

void test_a_reply_is_complete_with_the_tick_after_it(void)
{
    until_stop();
    fifo.count = 0U;
    (void)arrive("QT\n00P\n\n");
    tick();
    look();
    TEST_ASSERT_EQUAL_UINT32(before.urg.seen.reply_count + 1U, now.urg.seen.reply_count);
}
