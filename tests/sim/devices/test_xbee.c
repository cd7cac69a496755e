#include <math.h>
#include <string.h>

#include "sim/devices/xbee.h"
#include "unity.h"

#define BIT_NS (1e9 / 9600.0)
#define C ((sim_time_t)1041667) /* one character at 9600 */
#define AIR(n) ((sim_time_t)2000000 + (sim_time_t)(n)*32000)
#define MAX 4096

typedef struct {
    unsigned char octet[MAX];
    sim_time_t at[MAX];
    size_t count;
} received_t;

static received_t firmware, terminal;
static xbee_t *xbee;

static void receive(void *context, unsigned octet, double bit_ns)
{
    received_t *received = context;
    TEST_ASSERT_DOUBLE_WITHIN(0.1, BIT_NS, bit_ns);
    TEST_ASSERT_TRUE(received->count < MAX);
    received->octet[received->count] = (unsigned char)octet;
    received->at[received->count++] = timeline_now();
}

void setUp(void)
{
    timeline_reset();
    firmware.count = terminal.count = 0;
    xbee = xbee_create(receive, &firmware, receive, &terminal);
}

void tearDown(void)
{
    if (xbee != NULL) {
        xbee_destroy(xbee);
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

static void run_out(void)
{
    while (timeline_next() != SIM_NEVER) {
        run_until(timeline_next());
    }
}

static unsigned char pattern(size_t k)
{
    return (unsigned char)((k * 31 + k / 251 * 7 + 13) & 0xFF);
}

static void operator_writes(size_t count)
{
    unsigned char octets[MAX];
    for (size_t k = 0; k < count; k++) {
        octets[k] = pattern(k);
    }
    xbee_from_operator(xbee, octets, count);
}

static void expect_pattern(const received_t *received, size_t count)
{
    TEST_ASSERT_EQUAL_size_t(count, received->count);
    for (size_t k = 0; k < count; k++) {
        TEST_ASSERT_EQUAL_UINT(pattern(k), received->octet[k]);
    }
}

/* `count` octets at the wire's pace, the first one's stop bit a character from now. */
static void firmware_writes(size_t first, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        run_until(timeline_now() + C);
        xbee_from_firmware(xbee, pattern(first + k), BIT_NS);
    }
}

void test_a_line_reaches_the_firmware_whole_and_in_order(void)
{
    xbee_from_operator(xbee, "#SETR 0.6\n", 10);
    run_out();
    TEST_ASSERT_EQUAL_size_t(10, firmware.count);
    TEST_ASSERT_EQUAL_INT(0, memcmp("#SETR 0.6\n", firmware.octet, 10));
    TEST_ASSERT_EQUAL_size_t(0, terminal.count);
}

void test_a_line_reaches_the_operator_whole_and_in_order(void)
{
    firmware_writes(0, 60);
    run_out();
    expect_pattern(&terminal, 60);
    TEST_ASSERT_EQUAL_size_t(0, firmware.count);
}

void test_every_octet_value_passes(void)
{
    unsigned char octets[256];
    for (unsigned k = 0; k < 256; k++) {
        octets[k] = (unsigned char)k;
    }
    xbee_from_operator(xbee, octets, 256);
    run_out();
    TEST_ASSERT_EQUAL_size_t(256, firmware.count);
    TEST_ASSERT_EQUAL_INT(0, memcmp(octets, firmware.octet, 256));
}

/* By hand, 10 octets: 10 C in, 3 C of silence, 2 ms + 10 x 32 us on air, 10 C out. */
TEST_CASE(1, 7240335)
TEST_CASE(10, 26278341)
TEST_CASE(99, 214543067)
TEST_CASE(100, 213533400)
TEST_CASE(200, 317700100)
void test_the_latency_of_a_line(int count, int expected_ns)
{
    TEST_ASSERT_EQUAL_INT64(expected_ns, xbee_latency((size_t)count));
}

void test_the_latency_is_exact_for_every_length(void)
{
    for (size_t count = 1; count <= 420; count++) {
        const sim_time_t start = timeline_now();
        firmware.count = 0;
        operator_writes(count);
        run_out();
        expect_pattern(&firmware, count);
        TEST_ASSERT_EQUAL_INT64(start + xbee_latency(count), firmware.at[count - 1]);
        run_until(timeline_now() + 5 * C);
    }
}

void test_nothing_written_takes_no_time(void)
{
    xbee_from_operator(xbee, "", 0);
    run_out();
    TEST_ASSERT_EQUAL_size_t(0, firmware.count);
    TEST_ASSERT_EQUAL_INT64(0, xbee_latency(0));
}

void test_octets_leave_the_vehicles_module_one_character_apart(void)
{
    operator_writes(30);
    run_out();
    for (size_t k = 1; k < 30; k++) {
        TEST_ASSERT_EQUAL_INT64(C, firmware.at[k] - firmware.at[k - 1]);
    }
}

void test_ninety_nine_octets_wait_for_the_silence_and_a_hundred_do_not(void)
{
    firmware_writes(0, 99);
    run_out();
    TEST_ASSERT_EQUAL_INT64(99 * C + 3 * C + AIR(99) + C, terminal.at[0]);

    terminal.count = 0;
    const sim_time_t start = timeline_now();
    firmware_writes(0, 100);
    run_out();
    TEST_ASSERT_EQUAL_INT64(start + 100 * C + AIR(100) + C, terminal.at[0]);
}

void test_a_pause_below_three_characters_keeps_the_packet_whole(void)
{
    firmware_writes(0, 5);
    run_until(timeline_now() + 2 * C - 1000);
    firmware_writes(5, 5);
    const sim_time_t end = timeline_now();
    run_out();
    expect_pattern(&terminal, 10);
    TEST_ASSERT_EQUAL_INT64(end + 3 * C + AIR(10) + C, terminal.at[0]);
}

void test_a_pause_above_three_characters_splits_the_packet(void)
{
    firmware_writes(0, 5);
    const sim_time_t first_end = timeline_now();
    run_until(timeline_now() + 2 * C + 1000);
    firmware_writes(5, 5);
    const sim_time_t second_end = timeline_now();
    run_out();
    expect_pattern(&terminal, 10);
    TEST_ASSERT_EQUAL_INT64(first_end + 3 * C + AIR(5) + C, terminal.at[0]);
    const sim_time_t landed = second_end + 3 * C + AIR(5);
    const sim_time_t line_free = terminal.at[4];
    TEST_ASSERT_EQUAL_INT64((landed > line_free ? landed : line_free) + C, terminal.at[5]);
}

/* The hundredth octet flies at once; one more is ripe 4.17 ms later, when 5.2 ms on air are not over. */
void test_a_packet_waits_until_the_air_is_free(void)
{
    firmware_writes(0, 101);
    const sim_time_t full = timeline_now() - C;
    run_out();
    expect_pattern(&terminal, 101);
    TEST_ASSERT_EQUAL_INT64(full + AIR(100) + C, terminal.at[0]);
    TEST_ASSERT_EQUAL_INT64(full + AIR(100) + 101 * C, terminal.at[100]);
}

void test_both_directions_do_not_disturb_each_other(void)
{
    operator_writes(50);
    firmware_writes(0, 70);
    run_out();
    expect_pattern(&firmware, 50);
    expect_pattern(&terminal, 70);
    TEST_ASSERT_EQUAL_INT64(xbee_latency(50), firmware.at[49]);
    TEST_ASSERT_EQUAL_INT64(xbee_latency(70), terminal.at[69]);
}

void test_lines_written_during_a_flight_follow_in_order(void)
{
    for (size_t k = 0; k < 40; k++) {
        unsigned char octets[17];
        for (size_t i = 0; i < sizeof octets; i++) {
            octets[i] = pattern(k * sizeof octets + i);
        }
        xbee_from_operator(xbee, octets, sizeof octets);
        run_until(timeline_now() + (sim_time_t)(k % 7) * 5 * SIM_MS);
    }
    run_out();
    expect_pattern(&firmware, 40 * 17);
}

TEST_CASE(0.957, true)
TEST_CASE(0.96, true)
TEST_CASE(1.0, true)
TEST_CASE(1.04, true)
TEST_CASE(1.044, true)
TEST_CASE(0.954, false)
TEST_CASE(1.046, false)
TEST_CASE(0.5, false)
TEST_CASE(2.0, false)
void test_octets_at_another_rate_are_lost(double ratio, bool heard)
{
    xbee_from_firmware(xbee, 'a', BIT_NS);
    xbee_from_firmware(xbee, 'b', BIT_NS * ratio);
    xbee_from_firmware(xbee, 'c', BIT_NS);
    run_out();
    TEST_ASSERT_EQUAL_size_t(heard ? 3 : 2, terminal.count);
    TEST_ASSERT_EQUAL_UINT('a', terminal.octet[0]);
    TEST_ASSERT_EQUAL_UINT(heard ? 'b' : 'c', terminal.octet[1]);
    TEST_ASSERT_EQUAL_UINT('c', terminal.octet[terminal.count - 1]);
}

/* 100 are on air, 202 gather behind them, the rest finds no room. */
void test_a_full_buffer_loses_what_comes_after(void)
{
    for (size_t k = 0; k < 400; k++) {
        xbee_from_firmware(xbee, pattern(k), BIT_NS);
    }
    run_out();
    expect_pattern(&terminal, 302);
    terminal.count = 0;
    firmware_writes(0, 20);
    run_out();
    expect_pattern(&terminal, 20);
}

void test_out_of_reach_packets_are_lost_both_ways_and_in_reach_they_come_again(void)
{
    xbee_reach(xbee, false);
    operator_writes(20);
    for (unsigned k = 0; k < 20; k++) {
        xbee_from_firmware(xbee, k, BIT_NS);
    }
    run_out();
    TEST_ASSERT_EQUAL_size_t(0, firmware.count);
    TEST_ASSERT_EQUAL_size_t(0, terminal.count);
    xbee_reach(xbee, true);
    operator_writes(20);
    run_out();
    expect_pattern(&firmware, 20);
}

void test_a_destroyed_pair_leaves_nothing_behind(void)
{
    for (sim_time_t when = 0; when < 60 * SIM_MS; when += 700 * SIM_US) {
        xbee_from_operator(xbee, "#GET\n", 5);
        xbee_from_firmware(xbee, 'x', BIT_NS);
        run_until(timeline_now() + when);
        xbee_destroy(xbee);
        TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
        xbee = xbee_create(receive, &firmware, receive, &terminal);
        firmware.count = terminal.count = 0;
    }
}
