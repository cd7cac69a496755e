#include "unity.h"

#include <string.h>

#include "drivers/scip_request.h"

static scip_request_t request;

void setUp(void)
{
    memset(&request, 0xA5, sizeof request);
}

void tearDown(void) {}

static void assert_text(const char *expected)
{
    TEST_ASSERT_EQUAL_UINT16(strlen(expected), request.text_length);
    for (uint16_t i = 0; i < request.text_length; i++) {
        TEST_ASSERT_EQUAL_UINT16((uint16_t)expected[i], request.text[i]);
    }
}

static void assert_untouched(void)
{
    scip_request_t untouched;
    memset(&untouched, 0xA5, sizeof untouched);
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &request, sizeof untouched);
}

static scip_range_t range_of(uint16_t first, uint16_t last, uint16_t cluster, uint16_t interval,
                             uint16_t scans)
{
    scip_range_t range = {first, last, cluster, interval, scans};
    return range;
}

/* Hokuyo C-42-03320B; reply lengths counted on the replies it prints. */
void test_plain_commands_have_the_text_and_reply_length_of_the_specification(void)
{
    static const struct {
        scip_kind_t kind;
        const char *text;
        uint16_t reply_octets;
    } rows[] = {
        {SCIP_LASER_OFF_1, "L0\n", 6}, {SCIP_SWITCH, "SCIP2.0\n", 11}, {SCIP_STOP, "QT\n", 8},
        {SCIP_LASER_ON, "BM\n", 8},    {SCIP_RESET, "RS\n", 8},        {SCIP_TIME_ENTER, "TM0\n", 9},
        {SCIP_TIME_READ, "TM1\n", 15}, {SCIP_TIME_LEAVE, "TM2\n", 9},  {SCIP_VERSION, "VV\n", 0},
        {SCIP_PARAMETERS, "PP\n", 0},  {SCIP_STATE, "II\n", 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_TRUE(scip_request(&request, rows[i].kind));
        assert_text(rows[i].text);
        TEST_ASSERT_EQUAL(rows[i].kind, request.kind);
        TEST_ASSERT_EQUAL_UINT16(rows[i].reply_octets, request.reply_octets);
        TEST_ASSERT_EQUAL_UINT16(strlen(rows[i].text) - 1, request.echo_length);
        TEST_ASSERT_EQUAL_UINT16(0, request.scan_octets);
        TEST_ASSERT_EQUAL_UINT16(0, request.characters);
        TEST_ASSERT_EQUAL_UINT16(0, request.points);
        TEST_ASSERT_EQUAL_UINT32(0, request.bit_rate);
    }
}

void test_commands_with_parameters_are_not_built_without_them(void)
{
    static const scip_kind_t kinds[] = {SCIP_BIT_RATE, SCIP_STREAM_2, SCIP_STREAM_3,
                                        SCIP_SINGLE_2, SCIP_SINGLE_3, SCIP_KIND_COUNT};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        TEST_ASSERT_FALSE(scip_request(&request, kinds[i]));
        assert_untouched();
    }
}

void test_every_rate_of_the_command_table_is_built_and_no_other(void)
{
    static const uint32_t good[] = {19200, 57600, 115200, 250000, 500000, 750000};
    static const char *const text[] = {"SS019200\n", "SS057600\n", "SS115200\n",
                                       "SS250000\n", "SS500000\n", "SS750000\n"};
    static const uint32_t bad[] = {0, 9600, 38400, 115201, 256000, 1000000, 4294967295UL};
    for (size_t i = 0; i < 6; i++) {
        TEST_ASSERT_TRUE(scip_request_bit_rate(&request, good[i]));
        assert_text(text[i]);
        TEST_ASSERT_EQUAL(SCIP_BIT_RATE, request.kind);
        TEST_ASSERT_EQUAL_UINT32(good[i], request.bit_rate);
        TEST_ASSERT_EQUAL_UINT16(14, request.reply_octets);
    }
    memset(&request, 0xA5, sizeof request);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE(scip_request_bit_rate(&request, bad[i]));
        assert_untouched();
    }
}

void test_the_front_layout_asks_as_the_seed_does(void)
{
    scip_range_t range = range_of(372, 406, 1, 0, 0);
    TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_STREAM_2, &range));
    assert_text("MS0372040601000\n");
    TEST_ASSERT_EQUAL_UINT16(15, request.echo_length);
    TEST_ASSERT_EQUAL_UINT16(21, request.reply_octets);
    TEST_ASSERT_EQUAL_UINT16(101, request.scan_octets);
    TEST_ASSERT_EQUAL_UINT16(2, request.characters);
    TEST_ASSERT_EQUAL_UINT16(35, request.points);
    TEST_ASSERT_EQUAL_MEMORY(&range, &request.range, sizeof range);
}

void test_all_fields_of_a_scan_request_reach_the_wire(void)
{
    scip_range_t range = range_of(9, 768, 87, 6, 54);
    TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_STREAM_3, &range));
    assert_text("MD0009076887654\n");
    TEST_ASSERT_EQUAL_UINT16(9, request.points); /* 760 / 87 = 8.7 */
    TEST_ASSERT_EQUAL_UINT16(27 + 27 + 2, request.scan_octets);
    TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_SINGLE_2, &range));
    assert_text("GS0009076887\n");
    TEST_ASSERT_EQUAL_UINT16(24 + 18 + 2, request.reply_octets);
    TEST_ASSERT_EQUAL_UINT16(0, request.scan_octets);
    TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_SINGLE_3, &range));
    assert_text("GD0009076887\n");
    TEST_ASSERT_EQUAL_UINT16(3, request.characters);
}

void test_a_request_can_be_built_from_its_own_range(void)
{
    scip_range_t range = range_of(249, 519, 1, 0, 5);
    TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_STREAM_2, &range));
    TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_STREAM_2, &request.range));
    assert_text("MS0249051901005\n");
}

/* Lengths from the length table of SCIP2.0 replies: two and three characters a point, streams and single
 * scans. */
void test_scan_lengths_agree_with_the_table(void)
{
    static const struct {
        uint16_t points, ms, md, gs, gd;
    } rows[] = {
        {1, 31, 32, 28, 29},           {21, 71, 92, 68, 89},           {22, 73, 97, 70, 94},
        {31, 91, 124, 88, 121},        {32, 93, 127, 90, 124},         {33, 97, 130, 94, 127},
        {35, 101, 136, 98, 133},       {64, 159, 225, 156, 222},       {65, 163, 230, 160, 227},
        {271, 587, 866, 584, 863},     {677, 1425, 2122, 1422, 2119},  {682, 1435, 2137, 1432, 2134},
        {769, 1615, 2408, 1612, 2405}, {1081, 2257, 3372, 2254, 3369},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_UINT16(rows[i].ms, scip_scan_octets(SCIP_STREAM_2, rows[i].points));
        TEST_ASSERT_EQUAL_UINT16(rows[i].md, scip_scan_octets(SCIP_STREAM_3, rows[i].points));
        TEST_ASSERT_EQUAL_UINT16(rows[i].gs, scip_scan_octets(SCIP_SINGLE_2, rows[i].points));
        TEST_ASSERT_EQUAL_UINT16(rows[i].gd, scip_scan_octets(SCIP_SINGLE_3, rows[i].points));
    }
    TEST_ASSERT_EQUAL_UINT16(0, scip_scan_octets(SCIP_STOP, 35));
}

void test_each_field_outside_its_range_is_refused(void)
{
    const scip_range_t bad[] = {
        range_of(400, 399, 1, 0, 0), range_of(0, 1081, 1, 0, 0),  range_of(0, 65535, 1, 0, 0),
        range_of(0, 768, 0, 0, 0),   range_of(0, 768, 100, 0, 0), range_of(0, 768, 1, 10, 0),
        range_of(0, 768, 1, 0, 100),
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE(scip_request_scan(&request, SCIP_STREAM_2, &bad[i]));
        assert_untouched();
    }
}

void test_the_limits_of_each_field_are_accepted(void)
{
    const scip_range_t good[] = {
        range_of(0, 0, 1, 0, 0),
        range_of(1080, 1080, 99, 9, 99),
        range_of(0, 768, 99, 9, 99),
        range_of(0, 1080, 1, 0, 1),
    };
    static const uint16_t points[] = {1, 1, 8, 1081};
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_STREAM_2, &good[i]));
        TEST_ASSERT_EQUAL_UINT16(points[i], request.points);
    }
}

void test_a_scan_request_is_only_built_for_a_scan_command(void)
{
    const scip_range_t range = range_of(372, 406, 1, 0, 0);
    for (int kind = 0; kind <= SCIP_KIND_COUNT; kind++) {
        bool scan = kind >= SCIP_STREAM_2 && kind < SCIP_KIND_COUNT;
        TEST_ASSERT_EQUAL(scan, scip_request_scan(&request, (scip_kind_t)kind, &range));
    }
}

void test_a_leading_line_end_leaves_echo_and_reply_as_they_are(void)
{
    const scip_range_t range = range_of(372, 406, 1, 0, 0);
    TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_STREAM_2, &range));
    scip_request_end_line_first(&request);
    assert_text("\nMS0372040601000\n");
    TEST_ASSERT_EQUAL_UINT16(15, request.echo_length);
    TEST_ASSERT_EQUAL_PTR(&request.text[1], scip_request_echo(&request));
    scip_request_end_line_first(&request);
    assert_text("\nMS0372040601000\n");
    TEST_ASSERT_TRUE(scip_request(&request, SCIP_STOP));
    TEST_ASSERT_EQUAL_PTR(&request.text[0], scip_request_echo(&request));
}

void test_a_request_may_leave_time_mode_first(void)
{
    const scip_range_t range = range_of(372, 406, 1, 0, 0);
    for (int ended = 0; ended < 2; ended++) {
        TEST_ASSERT_TRUE(scip_request_scan(&request, SCIP_STREAM_2, &range));
        if (ended == 1) {
            scip_request_end_line_first(&request);
        }
        scip_request_leave_time_first(&request);
        assert_text("\nTM2\nMS0372040601000\n");
        TEST_ASSERT_EQUAL_UINT16(SCIP_REQUEST_MAX, request.text_length);
        TEST_ASSERT_EQUAL_PTR(&request.text[5], scip_request_echo(&request));
    }
}
