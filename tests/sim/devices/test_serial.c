#include "sim/devices/serial.h"

#include <string.h>
#include "unity.h"

#define HEARD_N 20000

static serial_t line;
static unsigned heard[HEARD_N];
static sim_time_t heard_at[HEARD_N];
static double heard_bit[HEARD_N];
static size_t heard_n;
static double rate_in_sink;
static const char *reply_in_sink;
static bool flush_in_sink;

static void sink(void *context, unsigned octet, double bit_ns)
{
    TEST_ASSERT_EQUAL_PTR(&heard_n, context);
    TEST_ASSERT_TRUE(heard_n < HEARD_N);
    heard[heard_n] = octet;
    heard_at[heard_n] = timeline_now();
    heard_bit[heard_n] = bit_ns;
    heard_n++;
    if (rate_in_sink > 0.0) {
        serial_set_rate(&line, rate_in_sink);
        rate_in_sink = 0.0;
    }
    if (reply_in_sink != NULL) {
        const char *text = reply_in_sink;
        reply_in_sink = NULL;
        serial_send(&line, text, strlen(text));
    }
    if (flush_in_sink) {
        flush_in_sink = false;
        serial_flush(&line);
    }
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
    heard_n = 0;
    rate_in_sink = 0.0;
    reply_in_sink = NULL;
    flush_in_sink = false;
    serial_init(&line, 250000.0, sink, &heard_n);
}

void tearDown(void) {}

void test_an_octet_arrives_at_its_stop_bit_and_not_before(void)
{
    run_until(7);
    serial_send(&line, "A", 1);
    TEST_ASSERT_FALSE(serial_idle(&line));
    run_until(7 + 39999);
    TEST_ASSERT_EQUAL_UINT(0, heard_n);
    TEST_ASSERT_FALSE(serial_idle(&line));
    run_until(7 + 40000);
    TEST_ASSERT_EQUAL_UINT(1, heard_n);
    TEST_ASSERT_EQUAL_UINT16('A', heard[0]);
    TEST_ASSERT_EQUAL_INT64(40007, heard_at[0]);
    TEST_ASSERT_EQUAL_DOUBLE(4000.0, heard_bit[0]);
    TEST_ASSERT_TRUE(serial_idle(&line));
}

/* 10 bits: 1e10 / 115200 = 86805.56 ns, / 57600 = 173611.11 ns, / 19200 = 520833.33 ns, / 9600 = 1041666.67
 * ns. */
static void check_spacing(double rate, sim_time_t octet_ns)
{
    setUp();
    serial_set_rate(&line, rate);
    serial_send(&line, "0123456789", 10);
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_UINT(10, heard_n);
    for (size_t i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_UINT16('0' + i, heard[i]);
        TEST_ASSERT_EQUAL_INT64((sim_time_t)(i + 1) * octet_ns, heard_at[i]);
        TEST_ASSERT_DOUBLE_WITHIN(0.06, 1e9 / rate, heard_bit[i]);
    }
}

void test_octets_in_a_row_are_ten_bits_apart_at_every_rate(void)
{
    check_spacing(9600.0, 1041667);
    check_spacing(19200.0, 520833);
    check_spacing(57600.0, 173611);
    check_spacing(115200.0, 86806);
    check_spacing(250000.0, 40000);
    check_spacing(750000.0, 13333);
}

void test_octets_sent_while_the_line_is_busy_follow_without_a_gap(void)
{
    serial_send(&line, "ab", 2);
    run_until(55000);
    serial_send(&line, "c", 1);
    run_until(SIM_MS);
    TEST_ASSERT_EQUAL_UINT(3, heard_n);
    TEST_ASSERT_EQUAL_UINT16('c', heard[2]);
    TEST_ASSERT_EQUAL_INT64(120000, heard_at[2]);
}

void test_a_new_rate_begins_with_the_next_octet(void)
{
    serial_send(&line, "abc", 3);
    run_until(10000);
    serial_set_rate(&line, 125000.0);
    run_until(SIM_MS);
    TEST_ASSERT_EQUAL_INT64(40000, heard_at[0]);
    TEST_ASSERT_EQUAL_DOUBLE(4000.0, heard_bit[0]);
    TEST_ASSERT_EQUAL_INT64(120000, heard_at[1]);
    TEST_ASSERT_EQUAL_DOUBLE(8000.0, heard_bit[1]);
    TEST_ASSERT_EQUAL_INT64(200000, heard_at[2]);
}

void test_a_rate_set_at_the_last_stop_bit_holds_for_what_is_sent_then(void)
{
    serial_send(&line, "a", 1);
    rate_in_sink = 125000.0;
    reply_in_sink = "b";
    run_until(SIM_MS);
    TEST_ASSERT_EQUAL_UINT(2, heard_n);
    TEST_ASSERT_EQUAL_INT64(40000, heard_at[0]);
    TEST_ASSERT_EQUAL_INT64(120000, heard_at[1]);
    TEST_ASSERT_EQUAL_DOUBLE(8000.0, heard_bit[1]);
}

void test_all_256_octets_pass_unchanged(void)
{
    unsigned char all[256];

    for (unsigned i = 0; i < 256; i++) {
        all[i] = (unsigned char)i;
    }
    serial_send(&line, all, sizeof all);
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_UINT(256, heard_n);
    for (unsigned i = 0; i < 256; i++) {
        TEST_ASSERT_EQUAL_UINT16(i, heard[i]);
    }
}

void test_nothing_sent_is_nothing_heard(void)
{
    serial_send(&line, "", 0);
    TEST_ASSERT_TRUE(serial_idle(&line));
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
}

void test_a_full_queue_drops_the_newest_and_counts_them(void)
{
    static unsigned char many[SERIAL_QUEUE + 5];

    for (size_t i = 0; i < sizeof many; i++) {
        many[i] = (unsigned char)(i % 251);
    }
    serial_send(&line, many, sizeof many);
    serial_send(&line, "xy", 2);
    TEST_ASSERT_EQUAL_UINT(7, line.dropped);
    run_until(40000);
    serial_send(&line, "zz", 2);
    TEST_ASSERT_EQUAL_UINT(8, line.dropped);
    run_until(SIM_S);
    TEST_ASSERT_EQUAL_UINT(SERIAL_QUEUE + 1, heard_n);
    for (size_t i = 0; i < SERIAL_QUEUE; i++) {
        TEST_ASSERT_EQUAL_UINT16(i % 251, heard[i]);
    }
    TEST_ASSERT_EQUAL_UINT16('z', heard[SERIAL_QUEUE]);
}

void test_the_ring_keeps_the_order_when_it_wraps(void)
{
    static unsigned char part[3000];
    size_t sent = 0;

    for (int round = 0; round < 6; round++) {
        for (size_t i = 0; i < sizeof part; i++) {
            part[i] = (unsigned char)(sent++ % 253);
        }
        serial_send(&line, part, sizeof part);
        run_until(timeline_now() + 110 * SIM_MS);
    }
    run_until(timeline_now() + SIM_S);
    TEST_ASSERT_EQUAL_UINT(sent, heard_n);
    for (size_t i = 0; i < sent; i++) {
        TEST_ASSERT_EQUAL_UINT16(i % 253, heard[i]);
    }
    TEST_ASSERT_EQUAL_UINT(0, line.dropped);
}

void test_a_flush_cuts_off_the_octet_on_the_line_as_well(void)
{
    serial_send(&line, "abc", 3);
    run_until(79999);
    serial_flush(&line);
    TEST_ASSERT_TRUE(serial_idle(&line));
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
    serial_send(&line, "d", 1);
    run_until(SIM_MS);
    TEST_ASSERT_EQUAL_UINT(2, heard_n);
    TEST_ASSERT_EQUAL_UINT16('a', heard[0]);
    TEST_ASSERT_EQUAL_UINT16('d', heard[1]);
    TEST_ASSERT_EQUAL_INT64(79999 + 40000, heard_at[1]);
}

void test_a_flush_of_a_silent_line_changes_nothing(void)
{
    serial_flush(&line);
    serial_send(&line, "a", 1);
    run_until(SIM_MS);
    serial_flush(&line);
    serial_send(&line, "b", 1);
    run_until(2 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(2, heard_n);
    TEST_ASSERT_EQUAL_INT64(SIM_MS + 40000, heard_at[1]);
}

void test_the_sink_may_flush_what_follows(void)
{
    serial_send(&line, "abc", 3);
    flush_in_sink = true;
    run_until(SIM_MS);
    TEST_ASSERT_EQUAL_UINT(1, heard_n);
    TEST_ASSERT_TRUE(serial_idle(&line));
}
