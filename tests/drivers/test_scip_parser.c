#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/scip_parser.h"
#include "tests/support/scip_frames.h"

#define WIRE_MAX 3500
#define POINTS_MAX 1081
#define SCANS_MAX 40

/* --- the sensor's side, written apart from the product
 * ------------------------------------------------------------ */

typedef struct {
    unsigned octets[WIRE_MAX];
    size_t length;
} wire_t;

static void put(wire_t *wire, unsigned octet)
{
    TEST_ASSERT_LESS_THAN_size_t(WIRE_MAX, wire->length);
    wire->octets[wire->length++] = octet;
}

static void put_text(wire_t *wire, const char *text)
{
    while (*text != '\0') {
        put(wire, (unsigned)*text++);
    }
}

typedef struct {
    char symbol[3]; /* MS MD GS GD */
    unsigned first, last, cluster, interval, count;
} order_t;

static unsigned width_of(const order_t *order)
{
    return order->symbol[1] == 'S' ? 2 : 3;
}

static unsigned points_of(const order_t *order)
{
    unsigned steps = order->last - order->first + 1;
    return steps / order->cluster + (steps % order->cluster != 0);
}

static void write_echo(char *text, size_t size, const order_t *order, unsigned remaining)
{
    const int used = snprintf(text, size, "%s%04u%04u%02u", order->symbol, order->first, order->last,
                              order->cluster);
    if (order->symbol[0] == 'M') {
        snprintf(text + used, size - (size_t)used, "%u%02u", order->interval, remaining);
    }
}

static void put_echo(wire_t *wire, const order_t *order, unsigned remaining)
{
    char text[40];
    write_echo(text, sizeof text, order, remaining);
    put_text(wire, text);
    put(wire, '\n');
}

static void put_answer(wire_t *wire, const order_t *order, const char *status)
{
    char text[5];
    put_echo(wire, order, order->count);
    scip_frames_summed(text, status, 2);
    put_text(wire, text);
    put(wire, '\n');
}

static void put_summed(wire_t *wire, const char *characters, size_t count)
{
    char line[SCIP_FRAMES_BLOCK + 3];
    scip_frames_summed(line, characters, count);
    put_text(wire, line);
}

static void put_frame(wire_t *wire, const order_t *order, unsigned remaining, unsigned long stamp,
                      const unsigned long *values)
{
    const unsigned width = width_of(order);
    char block[SCIP_FRAMES_BLOCK], value[4];
    size_t count = 0;
    put_echo(wire, order, remaining);
    put_summed(wire, order->symbol[0] == 'M' ? "99" : "00", 2);
    scip_frames_encode(value, stamp, 4);
    put_summed(wire, value, 4);
    for (unsigned i = 0; i < points_of(order); i++) {
        scip_frames_encode(value, values[i], width);
        for (unsigned k = 0; k < width; k++) {
            block[count++] = value[k];
            if (count == SCIP_FRAMES_BLOCK || (i == points_of(order) - 1 && k == width - 1)) {
                put_summed(wire, block, count);
                count = 0;
            }
        }
    }
    put(wire, '\n');
}

/* --- the product's side
 * ------------------------------------------------------------------------------------------- */

static const order_t front = {"MS", 372, 406, 1, 0, 0};
static const order_t wide = {"MD", 384, 405, 1, 0, 0}; /* 22 points of 3: one straddles two blocks */
static const order_t counted = {"MS", 372, 406, 1, 0, 5};

static scip_parser_t parser;
static scip_scan_t scan;
static uint16_t points[POINTS_MAX];
static scip_request_t request;
static wire_t wire;
static wire_t faulty; /* the wire with a fault */
static unsigned long values[POINTS_MAX];

static struct {
    unsigned events[SCIP_DAMAGED + 1];
    unsigned scans;
    uint32_t stamp[SCANS_MAX];
    uint16_t remaining[SCANS_MAX];
    uint16_t distance[SCANS_MAX][40];
} seen;

static void expect_order(const order_t *order)
{
    static const char *const symbols[] = {"MS", "MD", "GS", "GD"};
    const scip_range_t range = {(uint16_t)order->first, (uint16_t)order->last, (uint16_t)order->cluster,
                                (uint16_t)order->interval, (uint16_t)order->count};
    int kind = SCIP_STREAM_2;
    while (strcmp(symbols[kind - SCIP_STREAM_2], order->symbol) != 0) {
        kind++;
    }
    TEST_ASSERT_TRUE(scip_request_scan(&request, (scip_kind_t)kind, &range));
    scip_parser_expect(&parser, &request);
}

static void expect_plain(scip_kind_t kind)
{
    TEST_ASSERT_TRUE(scip_request(&request, kind));
    scip_parser_expect(&parser, &request);
}

static scip_event_t feed(unsigned octet)
{
    scip_event_t event = scip_parser_feed(&parser, (octet_t)octet);
    seen.events[event]++;
    if (event == SCIP_SCAN) {
        TEST_ASSERT_LESS_THAN_UINT(SCANS_MAX, seen.scans);
        seen.stamp[seen.scans] = scan.timestamp_ms;
        seen.remaining[seen.scans] = scan.remaining;
        for (unsigned i = 0; i < scan.points && i < 40; i++) {
            seen.distance[seen.scans][i] = scan.distance_mm[i];
        }
        seen.scans++;
    }
    return event;
}

static scip_event_t feed_range(const wire_t *w, size_t begin, size_t end)
{
    scip_event_t last = SCIP_NOTHING;
    for (size_t i = begin; i < end; i++) {
        scip_event_t event = feed(w->octets[i]);
        last = event != SCIP_NOTHING ? event : last;
    }
    return last;
}

/* The last event other than SCIP_NOTHING. */
static scip_event_t feed_text(const char *text)
{
    scip_event_t last = SCIP_NOTHING;
    while (*text != '\0') {
        const scip_event_t event = feed((unsigned)*text++);
        last = event != SCIP_NOTHING ? event : last;
    }
    return last;
}

static void start(void)
{
    memset(&seen, 0, sizeof seen);
    for (unsigned i = 0; i < POINTS_MAX; i++) {
        points[i] = 0xEEEE;
    }
    scan = (scip_scan_t){.distance_mm = points, .capacity = POINTS_MAX};
    scip_parser_init(&parser);
    scip_parser_scan_into(&parser, &scan);
}

void setUp(void)
{
    start();
    wire.length = 0;
}

void tearDown(void) {}

static uint32_t damages(void)
{
    uint32_t sum = 0;
    for (int cause = 0; cause < SCIP_DAMAGE_COUNT; cause++) {
        sum += parser.counters.damaged[cause];
    }
    return sum;
}

static unsigned long value_of(unsigned frame, unsigned point, unsigned width)
{
    unsigned long value = 20 + (frame * 1009UL + point * 157UL) % 4000;
    return width == 3 ? value + 1500 : value;
}

static void put_numbered_frame(wire_t *w, const order_t *order, unsigned frame)
{
    for (unsigned i = 0; i < points_of(order); i++) {
        values[i] = value_of(frame, i, width_of(order));
    }
    put_frame(w, order, order->count == 0 ? 0 : order->count - 1 - frame, 100000 + 100UL * frame, values);
}

static void assert_numbered_scan(unsigned index, const order_t *order, unsigned frame)
{
    TEST_ASSERT_EQUAL_UINT32(100000 + 100UL * frame, seen.stamp[index]);
    for (unsigned i = 0; i < points_of(order); i++) {
        TEST_ASSERT_EQUAL_UINT16(value_of(frame, i, width_of(order)), seen.distance[index][i]);
    }
}

/* --- vectors
 * ------------------------------------------------------------------------------------------------------ */

/* Hokuyo C-42-03320B, section "data encoding": CB = 1234, m2@0 = 16 000 000. */
void test_two_character_values_and_time_stamps_decode_as_in_the_specification(void)
{
    const order_t one = {"GS", 384, 384, 1, 0, 0};
    expect_order(&one);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_text("GS0384038401\n00P\nm2@0?\nCB5\n\n"));
    TEST_ASSERT_EQUAL_UINT16(1234, points[0]);
    TEST_ASSERT_EQUAL_UINT32(16000000, scan.timestamp_ms);
}

/* Hokuyo C-42-03320B: 1Dh = 5432; oooo is the largest time stamp. */
void test_three_character_values_decode_as_in_the_specification(void)
{
    const order_t one = {"GD", 384, 384, 1, 0, 0};
    expect_order(&one);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_text("GD0384038401\n00P\nooool\n1DhM\n\n"));
    TEST_ASSERT_EQUAL_UINT16(5432, points[0]);
    TEST_ASSERT_EQUAL_UINT32(16777215, scan.timestamp_ms);
}

/* Typed frame: 1 point of 1234 at 1 ms. Made from the specification. */
void test_a_typed_frame_of_one_point(void)
{
    const order_t one = {"MS", 384, 384, 1, 0, 0};
    expect_order(&one);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_text("MS0384038401000\n99b\n00011\nCB5\n\n"));
    TEST_ASSERT_EQUAL_UINT16(1234, points[0]);
    TEST_ASSERT_EQUAL_UINT32(1, scan.timestamp_ms);
    TEST_ASSERT_EQUAL_UINT16(1, scan.points);
    TEST_ASSERT_EQUAL_UINT16(2, scan.characters);
    TEST_ASSERT_EQUAL_UINT16(384, scan.first_step);
    TEST_ASSERT_EQUAL_UINT16(1, scan.cluster);
}

/* Typed frame: 32 points 1000..1031 fill one block of 64 characters exactly. Made from the specification. */
void test_a_typed_frame_that_fills_its_block(void)
{
    const order_t block = {"MS", 369, 400, 1, 0, 0};
    expect_order(&block);
    TEST_ASSERT_EQUAL(SCIP_SCAN,
                      feed_text("MS0369040001000\n99b\nooool\n"
                                "?X?Y?Z?[?\\?]?^?_?`?a?b?c?d?e?f?g?h?i?j?k?l?m?n?o@0@1@2@3@4@5@6@7H\n\n"));
    for (uint16_t i = 0; i < 32; i++) {
        TEST_ASSERT_EQUAL_UINT16(1000 + i, points[i]);
    }
}

/* Typed frame: 35 points 20, 120, .. 3420 at 16 000 000 ms, blocks of 64 and 6. Made from the specification.
 */
void test_a_typed_frame_of_two_blocks(void)
{
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_SCAN,
                      feed_text("MS0372040601000\n99b\nm2@0?\n"
                                "0D1h3L506T889\\;@<d>H?lAPC4DXF<G`IDJhLLN0OTQ8R\\T@UdWHXlZP\\4]X_<``2\n"
                                "bDcheLR\n\n"));
    for (uint16_t i = 0; i < 35; i++) {
        TEST_ASSERT_EQUAL_UINT16(20 + 100 * i, points[i]);
    }
}

/* Typed frame: 22 points 5000..5021 of three characters, the last split 64 | 2. Made from the specification.
 */
void test_a_typed_frame_whose_last_value_straddles_two_blocks(void)
{
    expect_order(&wide);
    TEST_ASSERT_EQUAL(
        SCIP_SCAN, feed_text("MD0384040501000\n99b\n001TU\n"
                             "1>81>91>:1>;1><1>=1>>1>?1>@1>A1>B1>C1>D1>E1>F1>G1>H1>I1>J1>K1>L1f\n>M;\n\n"));
    for (uint16_t i = 0; i < 22; i++) {
        TEST_ASSERT_EQUAL_UINT16(5000 + i, points[i]);
    }
    TEST_ASSERT_EQUAL_UINT16(3, scan.characters);
}

/* Typed frame: codes 0..19 and the smallest distance 20. Made from the specification. */
void test_codes_below_twenty_are_delivered_as_they_are(void)
{
    const order_t codes = {"GS", 384, 404, 1, 0, 0};
    expect_order(&codes);
    TEST_ASSERT_EQUAL(SCIP_SCAN,
                      feed_text("GS0384040401\n00P\n00077\n000102030405060708090:0;0<0=0>0?0@0A0B0C0Db\n\n"));
    for (uint16_t i = 0; i < 21; i++) {
        TEST_ASSERT_EQUAL_UINT16(i, points[i]);
    }
}

void test_three_characters_saturate_at_what_sixteen_bits_hold(void)
{
    static const unsigned long sent[] = {65534, 65535, 65536, 262143};
    const order_t four = {"GD", 10, 13, 1, 0, 0};
    put_frame(&wire, &four, 0, 5, sent);
    expect_order(&four);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_range(&wire, 0, wire.length));
    TEST_ASSERT_EQUAL_UINT16(65534, points[0]);
    for (uint16_t i = 1; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT16(65535, points[i]);
    }
}

/* --- recordings, see tests/fixtures/scip/README.md
 * ---------------------------------------------------------------- */

/* A number of a table and the character behind it, which is returned. */
static int read_cell(FILE *table, unsigned long *number)
{
    int character = fgetc(table);
    *number = 0;
    while (character >= '0' && character <= '9') {
        *number = 10 * *number + (unsigned long)(character - '0');
        character = fgetc(table);
    }
    return character;
}

static unsigned replay(const char *name, const order_t *order, uint32_t replies)
{
    char path[300];
    snprintf(path, sizeof path, FIXTURES "/scip/%s.bin", name);
    FILE *octets = fopen(path, "rb");
    snprintf(path, sizeof path, FIXTURES "/scip/%s.csv", name);
    FILE *said = fopen(path, "r");
    unsigned scans = 0;
    TEST_ASSERT_NOT_NULL(octets);
    TEST_ASSERT_NOT_NULL(said);
    expect_order(order);
    for (int octet = fgetc(octets); octet != EOF; octet = fgetc(octets)) {
        if (scip_parser_feed(&parser, (octet_t)octet) != SCIP_SCAN) {
            continue;
        }
        scans++;
        unsigned long number;
        TEST_ASSERT_EQUAL(',', read_cell(said, &number));
        TEST_ASSERT_EQUAL_UINT32(number, scan.timestamp_ms);
        int behind = read_cell(said, &number);
        TEST_ASSERT_EQUAL_UINT16(number, scan.points);
        for (uint16_t i = 0; i < scan.points; i++) {
            TEST_ASSERT_EQUAL(',', behind);
            behind = read_cell(said, &number);
            TEST_ASSERT_EQUAL_UINT16(number > 65535 ? 65535 : number, scan.distance_mm[i]);
        }
        TEST_ASSERT_EQUAL('\n', behind);
    }
    TEST_ASSERT_EQUAL(EOF, fgetc(said));
    TEST_ASSERT_EQUAL_UINT32(0, damages());
    TEST_ASSERT_EQUAL_UINT32(replies, parser.counters.replies);
    fclose(octets);
    fclose(said);
    return scans;
}

/* One frame from the middle of a counted run; its answer was not captured. */
void test_a_real_frame_of_the_whole_circle_is_read_whole(void)
{
    const order_t circle = {"MS", 44, 725, 1, 0, 9};
    TEST_ASSERT_EQUAL_UINT(1, replay("real_ms_0044_0725", &circle, 0));
    TEST_ASSERT_EQUAL_UINT16(682, scan.points);
    TEST_ASSERT_EQUAL_UINT16(3, scan.remaining);
}

void test_a_recording_of_the_front_is_read_whole(void)
{
    TEST_ASSERT_EQUAL_UINT(30, replay("ms_front", &front, 1));
}

void test_a_recording_of_three_characters_is_read_whole(void)
{
    const order_t beams = {"MD", 249, 519, 1, 0, 0};
    TEST_ASSERT_EQUAL_UINT(8, replay("md_beams", &beams, 1));
}

void test_a_recording_with_clusters_is_read_whole(void)
{
    const order_t cluster = {"MD", 44, 725, 5, 0, 0};
    TEST_ASSERT_EQUAL_UINT(8, replay("md_cluster", &cluster, 1));
    TEST_ASSERT_EQUAL_UINT16(5, scan.cluster);
    TEST_ASSERT_EQUAL_UINT16(44, scan.first_step);
}

/* --- replies without points
 * --------------------------------------------------------------------------------------- */

static void assert_reply(scip_kind_t kind, const char *text, const char *status, bool legacy)
{
    start();
    expect_plain(kind);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text(text));
    TEST_ASSERT_EQUAL_UINT16((uint16_t)status[0], parser.reply.status[0]);
    TEST_ASSERT_EQUAL_UINT16((uint16_t)status[1], parser.reply.status[1]);
    TEST_ASSERT_EQUAL(legacy, parser.reply.legacy);
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.replies);
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_replies_of_the_start_up_in_both_protocols(void)
{
    assert_reply(SCIP_LASER_OFF_1, "L0\n0\n\n", "0", true);
    assert_reply(SCIP_LASER_OFF_1, "L0\n2\n\n", "2", true);
    assert_reply(SCIP_LASER_OFF_1, "L0\n0Ee\n\n", "0E", false);
    assert_reply(SCIP_SWITCH, "SCIP2.0\n0\n\n", "0", true);
    assert_reply(SCIP_SWITCH, "SCIP2.0\n0Ee\n\n", "0E", false);
    assert_reply(SCIP_STOP, "QT\n00P\n\n", "00", false);
    assert_reply(SCIP_STOP, "QT\n0Ee\n\n", "0E", false);
    assert_reply(SCIP_LASER_ON, "BM\n02R\n\n", "02", false);
    assert_reply(SCIP_RESET, "RS\n00P\n\n", "00", false);
    assert_reply(SCIP_TIME_ENTER, "TM0\n00P\n\n", "00", false);
    assert_reply(SCIP_TIME_LEAVE, "TM2\n03S\n\n", "03", false);
}

void test_a_rate_change_is_answered_under_its_full_echo(void)
{
    TEST_ASSERT_TRUE(scip_request_bit_rate(&request, 250000));
    scip_parser_expect(&parser, &request);
    feed_text("SS115200\n00P\n\n");
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.replies);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("SS250000\n03S\n\n"));
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_the_sensor_clock_is_read(void)
{
    assert_reply(SCIP_TIME_READ, "TM1\n00P\nm2@0?\n\n", "00", false);
    TEST_ASSERT_EQUAL_UINT32(16000000, parser.reply.timestamp_ms);
    assert_reply(SCIP_TIME_READ, "TM1\n04T\n\n", "04", false);
    TEST_ASSERT_EQUAL_UINT32(0, parser.reply.timestamp_ms);
}

void test_a_reply_is_delivered_once_and_a_second_one_is_skipped(void)
{
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("QT\n00P\n\n"));
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_text("QT\n00P\n\n"));
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.replies);
    TEST_ASSERT_EQUAL_UINT32(2, parser.counters.skipped_lines);
}

void test_the_reply_to_an_earlier_request_is_skipped(void)
{
    expect_plain(SCIP_LASER_OFF_1);
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("L0\n0Ee\n\nQT\n00P\n\n"));
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.replies);
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_a_reply_that_is_in_the_line_when_it_becomes_awaited_is_taken(void)
{
    feed_text("xQ");
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("T\n00P\n\n"));
}

void test_frames_under_way_are_drained_until_the_stop_is_answered(void)
{
    expect_order(&front);
    put_answer(&wire, &front, "00");
    put_numbered_frame(&wire, &front, 0);
    feed_range(&wire, 0, wire.length);
    put_numbered_frame(&wire, &front, 1);
    feed_range(&wire, wire.length - 101, wire.length - 60);
    expect_plain(SCIP_STOP);
    feed_range(&wire, wire.length - 60, wire.length);
    put_numbered_frame(&wire, &front, 2);
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_range(&wire, wire.length - 101, wire.length));
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("QT\n00P\n\n"));
    TEST_ASSERT_EQUAL_UINT(1, seen.scans);
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_each_fault_of_a_reply_is_counted_by_its_cause(void)
{
    static const struct {
        const char *text;
        scip_damage_t cause;
    } rows[] = {
        {"QT\n00Q\n\n", SCIP_DAMAGE_SUM},       {"QT\n00\n\n", SCIP_DAMAGE_LENGTH},
        {"QT\n00PP\n\n", SCIP_DAMAGE_LENGTH},   {"QT\n\n", SCIP_DAMAGE_LENGTH},
        {"QT\n0\n\n", SCIP_DAMAGE_LENGTH},      {"QT\n0pP\n\n", SCIP_DAMAGE_CHARACTER},
        {"QT\n/0P\n\n", SCIP_DAMAGE_CHARACTER}, {"QT\n00P\nx\n", SCIP_DAMAGE_LENGTH},
        {"QT\nE\nx\n", SCIP_DAMAGE_LENGTH},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        start();
        expect_plain(SCIP_STOP);
        TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text(rows[i].text));
        TEST_ASSERT_EQUAL(rows[i].cause, parser.last_damage);
        TEST_ASSERT_EQUAL_UINT32(1, parser.counters.damaged[rows[i].cause]);
        TEST_ASSERT_EQUAL_UINT32(1, damages());
        TEST_ASSERT_EQUAL_UINT32(0, parser.counters.replies);
        TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("QT\n00P\n\n"));
    }
}

void test_the_clock_reply_checks_length_characters_and_sum(void)
{
    static const struct {
        const char *text;
        scip_damage_t cause;
    } rows[] = {
        {"TM1\n00P\nm2@0>\n\n", SCIP_DAMAGE_SUM},
        {"TM1\n00P\nm2@0\n\n", SCIP_DAMAGE_LENGTH},
        {"TM1\n00P\nm2@p?\n\n", SCIP_DAMAGE_CHARACTER},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        start();
        expect_plain(SCIP_TIME_READ);
        TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text(rows[i].text));
        TEST_ASSERT_EQUAL(rows[i].cause, parser.last_damage);
    }
}

/* --- VV PP II
 * ----------------------------------------------------------------------------------------------------- */

static void assert_line(const char *octets, const char *text, bool proved)
{
    TEST_ASSERT_EQUAL(SCIP_TEXT, feed_text(octets));
    TEST_ASSERT_EQUAL_UINT16(strlen(text), parser.text_length);
    TEST_ASSERT_EQUAL_UINT16(strlen(octets) - 1, parser.line_length);
    for (uint16_t i = 0; i < parser.text_length; i++) {
        TEST_ASSERT_EQUAL_UINT16((uint16_t)text[i], parser.line[i]);
    }
    TEST_ASSERT_EQUAL(proved, parser.text_proved);
}

/* Lines of VV and PP as a URG-04LX sends them; sums recomputed (the specification's print has wrong ones). */
void test_information_lines_come_one_by_one(void)
{
    static const scip_kind_t kinds[] = {SCIP_VERSION, SCIP_PARAMETERS, SCIP_STATE};
    static const char *const echoes[] = {"VV\n00P\n", "PP\n00P\n", "II\n00P\n"};
    for (unsigned i = 0; i < 3; i++) {
        start();
        expect_plain(kinds[i]);
        TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_text(echoes[i]));
        assert_line("VEND:Hokuyo Automatic Co.,Ltd.;[\n", "VEND:Hokuyo Automatic Co.,Ltd.", true);
        assert_line("PROT:SCIP 2.0;N\n", "PROT:SCIP 2.0", true);
        assert_line("ARES:1024;\\\n", "ARES:1024", true);
        assert_line("MODL:URG-04LX(Hokuyo Automatic Co.,Ltd.);N\n",
                    "MODL:URG-04LX(Hokuyo Automatic Co.,Ltd.)", true);
        TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("\n"));
        TEST_ASSERT_EQUAL_UINT16('0', parser.reply.status[0]);
        TEST_ASSERT_EQUAL_UINT32(0, damages());
    }
}

void test_information_lines_with_wrong_or_missing_sums_are_delivered_unproved(void)
{
    expect_plain(SCIP_VERSION);
    feed_text("VV\n00P\n");
    assert_line("SERI:H0706400;G\n", "SERI:H0706400", false);
    assert_line("SERI:H0706400;F\n", "SERI:H0706400", true);
    assert_line("I know nothing\n", "I know nothing", false);
    assert_line("x\n", "x", false);
    assert_line(";0\n", "", true);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("\n"));
    TEST_ASSERT_EQUAL_UINT(5, seen.events[SCIP_TEXT]);
}

void test_an_information_line_that_is_too_long_is_left_out(void)
{
    expect_plain(SCIP_VERSION);
    feed_text("VV\n00P\n");
    for (unsigned i = 0; i < SCIP_LINE_MAX; i++) {
        feed('a');
    }
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_text(";0\n"));
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.skipped_lines);
    assert_line("DMIN:20;4\n", "DMIN:20", true);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("\n"));
}

void test_a_refused_information_request_has_no_lines(void)
{
    assert_reply(SCIP_STATE, "II\n0Ee\n\n", "0E", false);
}

/* --- SCIP1.1 answers "E"
 * ------------------------------------------------------------------------------------------ */

void test_an_e_under_the_awaited_echo_tells_scip_1_1(void)
{
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_LEGACY, feed_text("QT\nE\n\n"));
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.legacy);
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.replies);
    TEST_ASSERT_EQUAL_UINT32(0, damages());
    expect_plain(SCIP_SWITCH);
    TEST_ASSERT_EQUAL(SCIP_LEGACY, feed_text("SCIP2.0\nE\n\n"));
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_LEGACY, feed_text("MS0372040601000\nE\n\n"));
}

void test_an_e_under_any_other_echo_tells_scip_1_1_too(void)
{
    TEST_ASSERT_EQUAL(SCIP_LEGACY, feed_text("RS;\nE\n\n"));
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_LEGACY, feed_text("\n\nSCIP2.0\nE\n\n"));
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.replies);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("QT\n00P\n\n"));
}

void test_an_e_without_echo_or_without_end_tells_nothing(void)
{
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_text("\nE\n\n"));
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_text("\nQT \nF\n\nEE\n\nxQ\n\nE\n\n"));
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text("x\nE\nx\n"));
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.legacy);
}

/* Inserting one line end before the sum 'E' of the last block gives "...", "E", "". */
void test_a_cut_block_of_a_running_stream_is_not_taken_for_scip_1_1(void)
{
    const order_t one = {"MS", 384, 384, 1, 0, 0};
    expect_order(&one);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_text("MS0384038401000\n00P\n\nMS0384038401000\n99b\n00011\nDQE\n\n"));
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text("MS0384038401000\n99b\n00022\nDQ\nE\n\n"));
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.legacy);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_text("MS0384038401000\n99b\n00033\nDQE\n\n"));
}

void test_a_stream_whose_answer_was_lost_is_not_taken_for_scip_1_1_either(void)
{
    const order_t one = {"MS", 384, 384, 1, 0, 0};
    expect_order(&one);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_text("MS0384038401000\n99b\n00011\nDQE\n\n"));
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text("MS0384038401000\n99b\n00022\nDQ\nE\n\n"));
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.legacy);
}

/* The echo may have been among the octets that were lost. */
void test_an_e_behind_a_broken_line_tells_nothing(void)
{
    expect_plain(SCIP_STOP);
    feed_text("Q?\n");
    scip_parser_line_broken(&parser);
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_text("E\n\n"));
    feed_text("Q?\n");
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_text("E\n\n"));
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.legacy);
}

/* The sensor lost its power in the stream. */
void test_an_e_tells_scip_1_1_after_a_stream_too(void)
{
    expect_order(&front);
    put_answer(&wire, &front, "00");
    put_numbered_frame(&wire, &front, 0);
    feed_range(&wire, 0, wire.length);
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_LEGACY, feed_text("Q?\nE\n\n"));
}

void test_behind_an_e_the_next_lines_are_read_as_ever(void)
{
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_LEGACY, feed_text("QT\nE\n\n"));
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_text("\n"));
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("QT\n00P\n\n"));
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.legacy);
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_an_e_behind_a_damaged_line_tells_scip_1_1_and_behind_an_empty_one_nothing(void)
{
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_LEGACY, feed_text("QT\n0\nE\n\n"));
    start();
    expect_plain(SCIP_STOP);
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text("QT\n\nE\n\n"));
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.legacy);
}

/* Nor before the first scan, when only its answer or a notice has come. */
void test_a_broken_line_of_a_stream_is_not_taken_for_scip_1_1(void)
{
    static const char *const statuses[] = {"00", "98"};
    for (unsigned i = 0; i < 2; i++) {
        start();
        wire.length = 0;
        expect_order(&front);
        put_answer(&wire, &front, statuses[i]);
        feed_range(&wire, 0, wire.length);
        TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text("MS03?\nE\n\n"));
        TEST_ASSERT_EQUAL_UINT32(0, parser.counters.legacy);
    }
}

/* --- streams
 * ------------------------------------------------------------------------------------------------------ */

void test_a_stream_is_answered_and_then_delivers_scan_by_scan(void)
{
    expect_order(&front);
    put_answer(&wire, &front, "00");
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_range(&wire, 0, wire.length));
    for (unsigned k = 0; k < 10; k++) {
        wire.length = 0;
        put_numbered_frame(&wire, &front, k);
        TEST_ASSERT_EQUAL_size_t(101, wire.length);
        TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_range(&wire, 0, 100));
        TEST_ASSERT_EQUAL(SCIP_SCAN, feed(wire.octets[100]));
        TEST_ASSERT_EQUAL_UINT16(0, scan.remaining);
        assert_numbered_scan(k, &front, k);
    }
    TEST_ASSERT_EQUAL_UINT32(10, parser.counters.scans);
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.replies);
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.skipped_lines);
}

void test_a_refused_stream_is_a_reply_and_nothing_follows(void)
{
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("MS0372040601000\n04T\n\n"));
    put_numbered_frame(&wire, &front, 0);
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_range(&wire, 0, wire.length));
}

/* Its echo's counter is not looked at. */
void test_a_refused_run_is_a_reply(void)
{
    expect_order(&counted);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("MS0372040601004\n0Ee\n\n"));
    TEST_ASSERT_EQUAL_UINT16('E', parser.reply.status[1]);
}

void test_a_refused_single_scan_is_a_reply(void)
{
    const order_t single = {"GS", 372, 406, 1, 0, 0};
    expect_order(&single);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("GS0372040601\n10Q\n\n"));
    TEST_ASSERT_EQUAL_UINT16('1', parser.reply.status[0]);
}

void test_a_single_scan_comes_once(void)
{
    const order_t single = {"GS", 372, 406, 1, 0, 0};
    expect_order(&single);
    put_numbered_frame(&wire, &single, 0);
    TEST_ASSERT_EQUAL_size_t(98, wire.length);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_range(&wire, 0, wire.length));
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_range(&wire, 0, wire.length));
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.scans);
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_hardware_notices_come_between_scans(void)
{
    expect_order(&front);
    put_answer(&wire, &front, "00");
    put_numbered_frame(&wire, &front, 0);
    put_answer(&wire, &front, "21");
    put_answer(&wire, &front, "98");
    put_numbered_frame(&wire, &front, 1);
    put_answer(&wire, &front, "50");
    TEST_ASSERT_EQUAL(SCIP_NOTICE, feed_range(&wire, 0, wire.length));
    TEST_ASSERT_EQUAL_UINT(3, seen.events[SCIP_NOTICE]);
    TEST_ASSERT_EQUAL_UINT32(3, parser.counters.notices);
    TEST_ASSERT_EQUAL_UINT(2, seen.scans);
    TEST_ASSERT_EQUAL_UINT16('5', parser.reply.status[0]);
    TEST_ASSERT_EQUAL_UINT16('0', parser.reply.status[1]);
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.replies);
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_behind_a_notice_the_next_scan_is_counted_down_from_its_echo_on(void)
{
    expect_order(&front);
    put_answer(&wire, &front, "00");
    put_answer(&wire, &front, "98");
    feed_range(&wire, 0, wire.length);
    TEST_ASSERT_EQUAL_UINT16(101, scip_parser_expected(&parser));
}

/* A notice may stand for a scan, or come between two. */
void test_the_counter_may_fall_by_two_over_a_notice(void)
{
    expect_order(&counted);
    put_answer(&wire, &counted, "00");
    put_numbered_frame(&wire, &counted, 0);
    put_echo(&wire, &counted, 3);
    put_text(&wire, "98a\n\n");
    put_numbered_frame(&wire, &counted, 2);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_range(&wire, 0, wire.length));
    TEST_ASSERT_EQUAL_UINT(2, seen.scans);
    TEST_ASSERT_EQUAL_UINT16(2, scan.remaining);
}

/* The latest frame of the run before was dropped; that excuses no frame of this one. */
void test_a_new_run_forgets_the_doubt_of_the_one_before(void)
{
    expect_order(&counted);
    put_answer(&wire, &counted, "00");
    put_numbered_frame(&wire, &counted, 1);
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_range(&wire, 0, wire.length));
    expect_order(&counted);
    wire.length = 0;
    put_answer(&wire, &counted, "00");
    put_numbered_frame(&wire, &counted, 2);
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_range(&wire, 0, wire.length));
    TEST_ASSERT_EQUAL_UINT(0, seen.scans);
}

void test_scans_of_a_stream_whose_answer_was_lost_are_delivered(void)
{
    expect_order(&counted);
    for (unsigned k = 0; k < 3; k++) {
        put_numbered_frame(&wire, &counted, k);
    }
    feed_range(&wire, 0, wire.length);
    TEST_ASSERT_EQUAL_UINT(3, seen.scans);
}

void test_a_counted_run_tells_the_remaining_scans(void)
{
    expect_order(&counted);
    put_answer(&wire, &counted, "00");
    for (unsigned k = 0; k < 5; k++) {
        put_numbered_frame(&wire, &counted, k);
    }
    feed_range(&wire, 0, wire.length);
    TEST_ASSERT_EQUAL_UINT(5, seen.scans);
    for (unsigned k = 0; k < 5; k++) {
        TEST_ASSERT_EQUAL_UINT16(4 - k, seen.remaining[k]);
    }
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_the_first_frame_behind_the_answer_must_be_the_first_of_the_run(void)
{
    expect_order(&counted);
    put_answer(&wire, &counted, "00");
    put_numbered_frame(&wire, &counted, 1);
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_range(&wire, 0, wire.length));
    TEST_ASSERT_EQUAL(SCIP_DAMAGE_SEQUENCE, parser.last_damage);
}

/* Its answer may be lost with frames behind it. */
void test_a_run_that_is_ordered_anew_may_begin_with_any_of_its_frames(void)
{
    for (unsigned first = 0; first < 5; first++) {
        start();
        wire.length = 0;
        put_answer(&wire, &counted, "00");
        put_numbered_frame(&wire, &counted, 0);
        put_numbered_frame(&wire, &counted, 1);
        expect_order(&counted);
        feed_range(&wire, 0, wire.length);
        TEST_ASSERT_EQUAL_UINT(2, seen.scans);
        expect_order(&counted);
        wire.length = 0;
        put_numbered_frame(&wire, &counted, first);
        TEST_ASSERT_EQUAL(SCIP_SCAN, feed_range(&wire, 0, wire.length));
        TEST_ASSERT_EQUAL_UINT16(4 - first, scan.remaining);
    }
}

/* As of a sensor that rounds the number of points down where the cluster does not divide the steps. */
void test_frames_with_another_number_of_points_are_never_scans(void)
{
    const order_t asked = {"MS", 100, 134, 2, 0, 0};
    for (unsigned n = 1; n < 70; n++) {
        const order_t sent = {"MS", 100, 99 + n, 1, 0, 0};
        char text[200], data[140];
        memset(data, '9', sizeof data);
        start();
        expect_order(&asked);
        for (unsigned k = 0; k < 3; k++) {
            scip_frames_frame(text, "MS0100013402000", 100 + 100 * k, data, 2U * points_of(&sent));
            (void)feed_text(text);
        }
        TEST_ASSERT_EQUAL_UINT(n == 18 ? 3 : 0, seen.scans);
        TEST_ASSERT_EQUAL_UINT32(n == 18 ? 0 : 3, damages());
    }
}

/* 2^16 ms are no whole number of revolutions: one scan is lost at the wrap. */
void test_a_clock_of_16_bits_costs_one_scan_at_its_wrap(void)
{
    expect_order(&front);
    for (unsigned k = 0; k < 40; k++) {
        wire.length = 0;
        put_frame(&wire, &front, 0, (63000 + 100UL * k) & 0xFFFF, values);
        (void)feed_range(&wire, 0, wire.length);
    }
    TEST_ASSERT_EQUAL_UINT32(39, parser.counters.scans);
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.damaged[SCIP_DAMAGE_SEQUENCE]);
}

void test_both_digits_of_the_remaining_scans_count(void)
{
    order_t many = counted;
    many.count = 35;
    expect_order(&many);
    put_answer(&wire, &many, "00");
    for (unsigned k = 0; k < 35; k++) {
        put_numbered_frame(&wire, &many, k);
        feed_range(&wire, 0, wire.length);
        wire.length = 0;
        TEST_ASSERT_EQUAL_UINT(k + 1U, seen.scans);
        TEST_ASSERT_EQUAL_UINT16(34 - k, seen.remaining[k]);
    }
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_an_answer_with_another_count_is_damaged(void)
{
    expect_order(&counted);
    put_echo(&wire, &counted, 4);
    put_text(&wire, "00P\n\n");
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_range(&wire, 0, wire.length));
    TEST_ASSERT_EQUAL(SCIP_DAMAGE_ECHO, parser.last_damage);
    wire.length = 0;
    put_echo(&wire, &counted, 5);
    put_text(&wire, "00P\n\n");
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_range(&wire, 0, wire.length));
}

void test_a_remaining_counter_that_is_no_number_is_no_echo(void)
{
    expect_order(&counted);
    feed_text("MS03720406010:4\n99b\nMS037204060100/\n99b\nMS037204060104:\n99b\n");
    TEST_ASSERT_EQUAL_UINT32(6, parser.counters.skipped_lines);
}

/* Feeds one counted frame with this remaining counter; stamps run on. */
static scip_event_t counted_frame(unsigned remaining, unsigned frame)
{
    wire.length = 0;
    put_frame(&wire, &counted, remaining, 5000 + 100UL * frame, values);
    return feed_range(&wire, 0, wire.length);
}

void test_a_counter_that_does_not_fall_by_one_costs_its_own_scan(void)
{
    static const unsigned wrong[] = {4, 5, 1, 99, 0};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        start();
        expect_order(&counted);
        feed_text("MS0372040601005\n00P\n\n");
        TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(4, 0));
        TEST_ASSERT_EQUAL(SCIP_DAMAGED, counted_frame(wrong[i], 1));
        TEST_ASSERT_EQUAL(SCIP_DAMAGE_SEQUENCE, parser.last_damage);
        TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(2, 2));
        TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(1, 3));
        TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(0, 4));
    }
}

/* The counter has no sum: after a loss any is taken, until two agree. */
void test_after_a_damaged_frame_the_counter_is_checked_again_once_two_agree(void)
{
    expect_order(&counted);
    feed_text("MS0372040601005\n00P\n\n");
    TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(4, 0));
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text("MS03720406\n"));
    TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(4, 2));
    TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(2, 3));
    TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(1, 4));
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, counted_frame(4, 5));
}

void test_a_counter_that_is_wrong_after_a_loss_costs_no_later_scan(void)
{
    static const unsigned wrong[] = {0, 1, 2, 4, 5, 99};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        start();
        expect_order(&counted);
        feed_text("MS0372040601005\n00P\n\n");
        TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text("MS03720406\n"));
        counted_frame(wrong[i], 1); /* 3 would be right */
        TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(2, 2));
        TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(1, 3));
        TEST_ASSERT_EQUAL(SCIP_SCAN, counted_frame(0, 4));
    }
}

void test_no_run_of_wrong_counters_silences_the_stream(void)
{
    expect_order(&counted);
    feed_text("MS0372040601005\n00P\n\n");
    for (unsigned k = 0; k < 10; k++) {
        counted_frame(3, k);
    }
    TEST_ASSERT_EQUAL_UINT(9, seen.scans);
}

/* --- time stamps
 * -------------------------------------------------------------------------------------------------- */

static scip_event_t stamped_frame(unsigned long stamp)
{
    wire.length = 0;
    put_frame(&wire, &front, 0, stamp, values);
    return feed_range(&wire, 0, wire.length);
}

void test_time_stamps_wrap_at_24_bits(void)
{
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(0xFFFFFF - 150));
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(0xFFFFFF - 50));
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(0xFFFFFF + 50));
    TEST_ASSERT_EQUAL_UINT32(49, scan.timestamp_ms);
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(149));
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_a_gap_of_ten_seconds_is_followed_and_a_longer_one_costs_a_scan(void)
{
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(1000));
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(11000));
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, stamped_frame(21001));
    TEST_ASSERT_EQUAL(SCIP_DAMAGE_SEQUENCE, parser.last_damage);
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(21101));
}

void test_a_sensor_clock_that_restarts_costs_one_scan(void)
{
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(500000));
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(500100));
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, stamped_frame(20));
    for (unsigned k = 1; k < 5; k++) {
        TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(20 + 100 * k));
    }
    TEST_ASSERT_EQUAL_UINT32(1, damages());
}

/* Whatever a wrong stamp says, believed or not: the frames that follow it are delivered. */
void test_a_wrong_stamp_harms_no_later_frame(void)
{
    static const unsigned long wrong[] = {0,      499999, 500000, 500001, 500099,  500101,  500250,
                                          505000, 510000, 510101, 600000, 8388608, 16777215};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        start();
        expect_order(&front);
        TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(500000));
        TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(500100));
        stamped_frame(wrong[i]);
        for (unsigned k = 3; k < 8; k++) {
            TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(500000 + 100 * k));
        }
    }
}

void test_a_repeated_frame_is_not_delivered_twice(void)
{
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(1000));
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(1100));
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, stamped_frame(1100));
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(1200));
}

void test_a_sensor_clock_that_stands_still_does_not_silence_the_stream(void)
{
    expect_order(&front);
    for (unsigned k = 0; k < 10; k++) {
        stamped_frame(7777);
    }
    TEST_ASSERT_EQUAL_UINT(5, seen.scans);
}

void test_a_new_request_forgets_the_old_time(void)
{
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(500000));
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(20));
    feed_text("MS0372040601000\n00P\n\n");
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(10));
}

void test_stamps_are_unwrapped(void)
{
    uint32_t time = 16777000;
    time = scip_unwrap_ms(time, 16777100);
    TEST_ASSERT_EQUAL_UINT32(16777100, time);
    time = scip_unwrap_ms(time, 16777100);
    TEST_ASSERT_EQUAL_UINT32(16777100, time);
    time = scip_unwrap_ms(time, 84);
    TEST_ASSERT_EQUAL_UINT32(16777300, time);
    for (unsigned k = 1; k <= 600; k++) {
        time = scip_unwrap_ms(time, (84 + k * 10000000UL) & 0xFFFFFF);
        TEST_ASSERT_EQUAL_UINT32((uint32_t)(16777300 + k * 10000000UL), time);
    }
}

/* --- the owner of the scan
 * ---------------------------------------------------------------------------------------- */

void test_a_scan_larger_than_its_memory_is_damage_and_writes_nothing(void)
{
    scan.capacity = 34;
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, stamped_frame(100));
    TEST_ASSERT_EQUAL(SCIP_DAMAGE_LENGTH, parser.last_damage);
    TEST_ASSERT_EQUAL_UINT16(0xEEEE, points[0]);
    scan.capacity = 35;
    TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(200));
    TEST_ASSERT_EQUAL_UINT16(0xEEEE, points[35]);
}

void test_without_memory_scans_are_checked_and_counted_only(void)
{
    scip_parser_scan_into(&parser, NULL);
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_NOTHING, stamped_frame(100));
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.scans);
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text("MS0372040601000\n99b\n00011\n00P\n\n"));
    expect_order(&wide);
    wire.length = 0;
    put_numbered_frame(&wire, &wide, 0);
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_range(&wire, 0, wire.length));
    TEST_ASSERT_EQUAL_UINT32(2, parser.counters.scans);
    TEST_ASSERT_EQUAL_UINT16(0xEEEE, points[0]);
}

void test_two_memories_take_turns_without_copying(void)
{
    static uint16_t memory[2][35];
    scip_scan_t scans[2] = {{.distance_mm = memory[0], .capacity = 35},
                            {.distance_mm = memory[1], .capacity = 35}};
    unsigned filling = 0;
    scip_parser_scan_into(&parser, &scans[filling]);
    expect_order(&front);
    for (unsigned k = 0; k < 6; k++) {
        wire.length = 0;
        put_numbered_frame(&wire, &front, k);
        for (size_t i = 0; i < wire.length; i++) {
            if (scip_parser_feed(&parser, (octet_t)wire.octets[i]) == SCIP_SCAN) {
                TEST_ASSERT_EQUAL_UINT32(100000 + 100 * k, scans[filling].timestamp_ms);
                TEST_ASSERT_EQUAL_UINT16(value_of(k, 34, 2), memory[filling][34]);
                filling = 1 - filling;
                scip_parser_scan_into(&parser, &scans[filling]);
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT32(6, parser.counters.scans);
}

void test_changing_the_memory_inside_a_scan_gives_that_scan_up(void)
{
    for (size_t at = 0; at < 101; at++) {
        start();
        expect_order(&counted);
        wire.length = 0;
        for (unsigned k = 0; k < 3; k++) {
            put_numbered_frame(&wire, &counted, k);
        }
        feed_range(&wire, 0, 101 + at);
        memset(points, 0, sizeof points);
        scip_parser_scan_into(&parser, &scan);
        feed_range(&wire, 101 + at, wire.length);
        TEST_ASSERT_EQUAL_UINT(at < 26 ? 3 : 2, seen.scans); /* 26: echo, status and time stamp lines */
        assert_numbered_scan(seen.scans - 1, &counted, 2);
        TEST_ASSERT_EQUAL_UINT32(0, damages());
    }
}

void test_a_parser_and_a_scan_of_271_points_fit_2_kib(void)
{
    TEST_ASSERT_LESS_OR_EQUAL_size_t(2048,
                                     sizeof(scip_parser_t) + sizeof(scip_scan_t) + 271 * sizeof(uint16_t));
}

static octet_t burst_octets[WIRE_MAX];

/* In memory of its own: sanitizers see a look beyond its ends. */
static size_t feed_alone(const octet_t *octets, size_t count, scip_event_t *event)
{
    octet_t *copy = malloc(count * sizeof *copy);
    TEST_ASSERT_NOT_NULL(copy);
    memcpy(copy, octets, count * sizeof *copy);
    const size_t taken = scip_parser_feed_run(&parser, copy, count, event);
    free(copy);
    return taken;
}

static scip_event_t feed_run_text(const octet_t *octets, size_t count, size_t burst, unsigned *events)
{
    scip_event_t event = SCIP_NOTHING, last = SCIP_NOTHING;
    while (count > 0) {
        const size_t given = count < burst ? count : burst;
        size_t taken = feed_alone(octets, given, &event);
        TEST_ASSERT_GREATER_THAN_size_t(0, taken);
        TEST_ASSERT_TRUE(taken <= given);
        TEST_ASSERT_TRUE(event == SCIP_NOTHING || (octets[taken - 1] & 0xFF) == '\n');
        octets += taken;
        count -= taken;
        events[event]++;
        last = event != SCIP_NOTHING ? event : last;
    }
    return last;
}

/* --- faults
 * ------------------------------------------------------------------------------------------------------- */

#define FRAMES 4

static size_t begins[FRAMES + 1];

static void put_run(const order_t *order)
{
    wire.length = 0;
    put_answer(&wire, order, "00");
    for (unsigned k = 0; k < FRAMES; k++) {
        begins[k] = wire.length;
        put_numbered_frame(&wire, order, k);
    }
    begins[FRAMES] = wire.length;
}

/* Feeds a run with a fault inside the octets [at, at + reach) of it: no wrong scan, and every frame that the
 * fault does not touch is delivered, in order. */
static void assert_run_survives(const order_t *order, const wire_t *w, size_t at, size_t reach)
{
    unsigned next = 0;
    start();
    expect_order(order);
    feed_range(w, 0, w->length);
    for (unsigned k = 0; k < FRAMES; k++) {
        bool touched = at < begins[k + 1] && at + reach > begins[k];
        if (next < seen.scans && seen.stamp[next] == 100000 + 100 * k) {
            assert_numbered_scan(next, order, k);
            next++;
        } else {
            char where[60];
            snprintf(where, sizeof where, "frame %u lost, fault at %u", k, (unsigned)at);
            TEST_ASSERT_TRUE_MESSAGE(touched, where);
        }
    }
    TEST_ASSERT_EQUAL_UINT(next, seen.scans);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(2, damages());
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.legacy);
}

static const order_t *const runs[] = {&front, &counted, &wide};
#define RUNS (sizeof runs / sizeof runs[0])

/* A single flipped bit never escapes: bits 0..5 change the six-bit sum, bits 6 and 7 leave 30H..6FH, and what
 * has no sum (echo, line ends) is compared. */
void test_no_flipped_bit_yields_a_distance_or_costs_another_frame(void)
{
    for (size_t r = 0; r < RUNS; r++) {
        put_run(runs[r]);
        for (size_t at = 0; at < wire.length; at++) {
            for (unsigned bit = 0; bit < 8; bit++) {
                wire.octets[at] ^= 1U << bit;
                assert_run_survives(runs[r], &wire, at, 1);
                TEST_ASSERT_LESS_OR_EQUAL_UINT(at < begins[0] ? FRAMES : FRAMES - 1, seen.scans);
                wire.octets[at] ^= 1U << bit;
            }
        }
    }
}

void test_no_dropped_octet_yields_a_distance_or_costs_another_frame(void)
{
    for (size_t r = 0; r < RUNS; r++) {
        put_run(runs[r]);
        for (size_t at = 0; at < wire.length; at++) {
            faulty.length = 0;
            for (size_t i = 0; i < wire.length; i++) {
                if (i != at) {
                    put(&faulty, wire.octets[i]);
                }
            }
            assert_run_survives(runs[r], &faulty, at, 1);
        }
    }
}

static void assert_insertion_survives(const order_t *order, size_t at, unsigned octet)
{
    faulty.length = 0;
    for (size_t i = 0; i < wire.length; i++) {
        if (i == at) {
            put(&faulty, octet);
        }
        put(&faulty, wire.octets[i]);
    }
    assert_run_survives(order, &faulty, at, 1);
}

void test_no_inserted_octet_yields_a_distance_or_costs_another_frame(void)
{
    static const unsigned inserted[] = {'\n', '\r', 0x00, 0xFF, '0', 'M', 'E', 'o', 0x8A, '9'};
    for (size_t r = 0; r < RUNS; r++) {
        put_run(runs[r]);
        for (size_t at = 0; at < wire.length; at++) {
            for (size_t i = 0; i < sizeof inserted / sizeof inserted[0]; i++) {
                assert_insertion_survives(runs[r], at, inserted[i]);
            }
            assert_insertion_survives(runs[r], at, wire.octets[at]); /* duplicated */
        }
    }
}

void test_an_octet_before_an_echo_and_line_ends_between_frames_cost_nothing(void)
{
    put_run(&front);
    for (unsigned k = 0; k < FRAMES; k++) {
        assert_insertion_survives(&front, begins[k], 'x');
        TEST_ASSERT_EQUAL_UINT(FRAMES, seen.scans);
        assert_insertion_survives(&front, begins[k], '\n');
        TEST_ASSERT_EQUAL_UINT(FRAMES, seen.scans);
        TEST_ASSERT_EQUAL_UINT32(0, damages());
    }
}

void test_a_frame_cut_short_anywhere_costs_only_itself(void)
{
    for (size_t r = 0; r < RUNS; r++) {
        put_run(runs[r]);
        for (size_t at = begins[1]; at < begins[2]; at++) {
            faulty.length = 0;
            for (size_t i = 0; i < wire.length; i++) {
                if (i < at || i >= begins[2]) {
                    put(&faulty, wire.octets[i]);
                }
            }
            if (at > begins[1] || runs[r]->count == 0) {
                assert_run_survives(runs[r], &faulty, at, begins[2] - at);
                TEST_ASSERT_EQUAL_UINT(FRAMES - 1, seen.scans);
            }
        }
    }
}

/* What is left of a block, with the next frame's echo behind it, may have a block's length and, once in 64
 * times, a right sum: the last octet of the echo. The next frame is not lost for that. */
void test_an_echo_that_makes_a_cut_block_whole_is_still_an_echo(void)
{
    static const char echo[] = "MS0372040601000";
    unsigned found = 0;
    put_run(&front);
    for (unsigned c = 0; c < 64; c++) {
        unsigned sum = 0;
        size_t begin = begins[1] + 26, cut = begin + 65 - 15;
        wire.octets[begin] = '0' + c;
        for (size_t i = begin; i < cut; i++) {
            sum += wire.octets[i];
        }
        for (unsigned i = 0; i < 14; i++) {
            sum += (unsigned)echo[i];
        }
        found += (sum & 63) == 0;
        start();
        expect_order(&front);
        feed_range(&wire, 0, cut);
        feed_range(&wire, begins[2], wire.length);
        TEST_ASSERT_EQUAL_UINT(3, seen.scans);
        assert_numbered_scan(1, &front, 2);
        TEST_ASSERT_EQUAL_UINT32(1, parser.counters.damaged[SCIP_DAMAGE_LENGTH] +
                                        parser.counters.damaged[SCIP_DAMAGE_SUM]);
    }
    TEST_ASSERT_EQUAL_UINT(1, found);
}

/* 39 points: the last block has 14 characters and a sum, as many as an echo, and with these steps the echo's
 * sum is right too. */
void test_an_echo_in_place_of_the_last_block_is_still_an_echo(void)
{
    order_t order = {"MS", 0, 38, 1, 0, 0};
    char echo[40];
    unsigned sum = 1;
    while (sum != 0) {
        order.first++;
        order.last++;
        write_echo(echo, sizeof echo, &order, 0);
        sum = 0;
        for (unsigned i = 0; i < 14; i++) {
            sum = (sum + (unsigned)echo[i]) & 63;
        }
    }
    for (unsigned burst = 0; burst < 2; burst++) {
        unsigned events[SCIP_DAMAGED + 1] = {0};
        start();
        wire.length = 0;
        put_answer(&wire, &order, "00");
        put_numbered_frame(&wire, &order, 0);
        wire.length -= 17; /* the last block, its LF, the empty line */
        put_numbered_frame(&wire, &order, 1);
        expect_order(&order);
        for (size_t i = 0; i < wire.length; i++) {
            burst_octets[i] = (octet_t)wire.octets[i];
        }
        (void)feed_run_text(burst_octets, wire.length, burst == 0 ? 1 : wire.length, events);
        TEST_ASSERT_EQUAL_UINT(1, events[SCIP_SCAN]);
        TEST_ASSERT_EQUAL_UINT32(100100, scan.timestamp_ms);
        TEST_ASSERT_EQUAL_UINT32(1, parser.counters.damaged[SCIP_DAMAGE_LENGTH]);
    }
}

/* Of a counted run the frame after one that vanished without a trace is dropped: its counter fell by two. */
void test_a_whole_frame_lost_without_a_trace_shows_in_the_counter(void)
{
    put_run(&counted);
    expect_order(&counted);
    feed_range(&wire, 0, begins[1]);
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_range(&wire, begins[2], begins[3]));
    TEST_ASSERT_EQUAL(SCIP_DAMAGE_SEQUENCE, parser.last_damage);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_range(&wire, begins[3], begins[4]));
}

void test_a_broken_line_at_any_octet_costs_only_its_frame(void)
{
    for (size_t r = 0; r < RUNS; r++) {
        put_run(runs[r]);
        for (size_t at = begins[1]; at < begins[2]; at++) {
            start();
            expect_order(runs[r]);
            feed_range(&wire, 0, at);
            scip_parser_line_broken(&parser);
            feed_range(&wire, at + 1, wire.length);
            TEST_ASSERT_EQUAL_UINT(FRAMES - 1, seen.scans);
            assert_numbered_scan(0, runs[r], 0);
            assert_numbered_scan(1, runs[r], 2);
            TEST_ASSERT_EQUAL_UINT32(0, damages());
        }
    }
}

void test_the_echo_is_found_when_both_line_ends_before_it_are_lost(void)
{
    put_run(&front);
    expect_order(&front);
    feed_range(&wire, 0, begins[1] - 2);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_range(&wire, begins[1], begins[2]));
    assert_numbered_scan(0, &front, 1);
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.damaged[SCIP_DAMAGE_LENGTH]);
    TEST_ASSERT_EQUAL_UINT32(1, damages());
}

void test_the_echo_is_found_at_the_end_of_a_line_of_any_length(void)
{
    put_run(&front);
    for (unsigned length = 0; length < 400; length++) {
        start();
        expect_order(&front);
        feed_range(&wire, 0, begins[1]);
        for (unsigned i = 0; i < length; i++) {
            feed('M');
        }
        TEST_ASSERT_EQUAL(SCIP_SCAN, feed_range(&wire, begins[1], begins[2]));
    }
}

/* 97 + 64 k octets: the cut line happens to have as many left as a block. */
void test_a_line_that_was_cut_is_never_taken_for_a_block(void)
{
    const order_t block = {"MS", 369, 400, 1, 0, 0};
    for (unsigned extra = 1; extra < 200; extra++) {
        start();
        expect_order(&block);
        TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_text("MS0369040001000\n99b\n00011\n"));
        for (unsigned i = 0; i < extra; i++) {
            feed('0');
        }
        TEST_ASSERT_EQUAL(SCIP_DAMAGED,
                          feed_text("0000000000000000000000000000000000000000000000000000000000000000"
                                    "0\n"));
        TEST_ASSERT_EQUAL(SCIP_DAMAGE_LENGTH, parser.last_damage);
    }
}

void test_each_fault_of_a_frame_is_counted_by_its_cause(void)
{
    static const struct {
        const char *octets;
        scip_damage_t cause;
    } rows[] = {
        {"MS0384038401000\n99c\n00022\nCB5\n\n", SCIP_DAMAGE_SUM},
        {"MS0384038401000\n99b\n00023\nCB5\n\n", SCIP_DAMAGE_SUM},
        {"MS0384038401000\n99b\n00022\nCB6\n\n", SCIP_DAMAGE_SUM},
        {"MS0384038401000\n99b\n0002\nCB5\n\n", SCIP_DAMAGE_LENGTH},
        {"MS0384038401000\n99b\n00022\nCB\n\n", SCIP_DAMAGE_LENGTH},
        {"MS0384038401000\n99b\n00022\nCBC5\n\n", SCIP_DAMAGE_LENGTH},
        {"MS0384038401000\n99b\n00022\n\n", SCIP_DAMAGE_LENGTH},
        {"MS0384038401000\n99b\n00022\nCB5\nCB5\n\n", SCIP_DAMAGE_LENGTH},
        {"MS0384038401001\n99b\n00022\nCB5\n\n", SCIP_DAMAGE_ECHO},
        {"MD0384038401000\n99b\n00022\nCB5\n\n", SCIP_DAMAGE_ECHO},
        {"S0384038401000\n99b\n00022\nCB5\n\n", SCIP_DAMAGE_ECHO},
        {"MS0384038401000\n9yb\n00022\nCB5\n\n", SCIP_DAMAGE_CHARACTER},
        {"MS0384038401000\n99b\np0022\nCB5\n\n", SCIP_DAMAGE_CHARACTER},
        {"MS0384038401000\n99b\n00022\nC/5\n\n", SCIP_DAMAGE_CHARACTER},
        {"MS0384038401000\n99b\n00011\nCB5\n\n", SCIP_DAMAGE_SEQUENCE},
    };
    const order_t one = {"MS", 384, 384, 1, 0, 0};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        start();
        expect_order(&one);
        feed_text("MS0384038401000\n00P\n\nMS0384038401000\n99b\n00011\nCB5\n\n");
        TEST_ASSERT_EQUAL_UINT32(0, damages());
        TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_text(rows[i].octets));
        TEST_ASSERT_EQUAL(rows[i].cause, parser.last_damage);
        TEST_ASSERT_EQUAL_UINT32(1, parser.counters.damaged[rows[i].cause]);
        TEST_ASSERT_EQUAL_UINT32(1, damages());
        TEST_ASSERT_EQUAL(SCIP_SCAN, feed_text("MS0384038401000\n99b\n00033\nCB5\n\n"));
    }
}

/* What a six-bit sum cannot see, stated exactly: two changes in one block that cancel out modulo 64. */
void test_two_changes_that_cancel_out_in_one_sum_are_the_first_to_escape(void)
{
    const order_t one = {"MS", 384, 384, 1, 0, 0};
    expect_order(&one);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_text("MS0384038401000\n99b\n00011\nDA5\n\n")); /* was CB5 */
    TEST_ASSERT_EQUAL_UINT16(1297, points[0]);
}

void test_a_frame_inside_a_frame_is_delivered(void)
{
    put_run(&front);
    for (size_t at = begins[1]; at < begins[2]; at++) {
        start();
        expect_order(&front);
        feed_range(&wire, 0, at);
        feed_range(&wire, begins[2], begins[4]);
        TEST_ASSERT_EQUAL_UINT(3, seen.scans);
        assert_numbered_scan(1, &front, 2);
    }
}

/* --- properties
 * --------------------------------------------------------------------------------------------------- */

static unsigned long random_state;

static unsigned long random_below(unsigned long limit)
{
    random_state = (random_state * 1103515245UL + 12345UL) & 0x7FFFFFFFUL;
    return (random_state >> 8) % limit;
}

static void assert_round_trip(const order_t *order, unsigned long stamp)
{
    const unsigned long limit = width_of(order) == 2 ? 4096 : 262144;
    for (unsigned i = 0; i < points_of(order); i++) {
        values[i] = random_below(random_below(4) == 0 ? 30 : limit);
    }
    wire.length = 0;
    put_frame(&wire, order, 0, stamp, values);
    expect_order(order);
    TEST_ASSERT_EQUAL_size_t(wire.length,
                             order->symbol[0] == 'M' ? request.scan_octets : request.reply_octets);
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_range(&wire, 0, wire.length));
    seen.scans = 0;
    TEST_ASSERT_EQUAL_UINT16(points_of(order), scan.points);
    TEST_ASSERT_EQUAL_UINT32(stamp, scan.timestamp_ms);
    TEST_ASSERT_EQUAL_UINT16(order->cluster, scan.cluster);
    for (unsigned i = 0; i < scan.points; i++) {
        TEST_ASSERT_EQUAL_UINT16(values[i] > 65535 ? 65535 : values[i], points[i]);
    }
}

void test_whatever_the_sensor_encodes_is_decoded(void)
{
    static const char *const symbols[] = {"MS", "MD", "GS", "GD"};
    random_state = 20260801UL;
    printf("random seed %lu\n", random_state);
    for (unsigned n = 1; n <= 300; n++) {
        for (unsigned s = 0; s < 4; s++) {
            order_t order = {"", 0, 0, 1, 0, 0};
            memcpy(order.symbol, symbols[s], 2);
            order.first = (unsigned)random_below(769 - n);
            order.last = order.first + n - 1;
            order.cluster = random_below(2) == 0 ? 1 : 1 + (unsigned)random_below(99);
            order.interval = (unsigned)random_below(10);
            assert_round_trip(&order, random_below(16777216));
        }
    }
    assert_round_trip(&(order_t){"MD", 0, 768, 1, 0, 0}, 1);
    TEST_ASSERT_EQUAL_UINT32(0, damages());
}

void test_ten_times_ten_thousand_octets_of_noise_yield_nothing_and_stop_nothing(void)
{
    static const char alphabet[] = "\n\n\n0099bPEQTMS0372040601000oCB5 \r\xFF";
    random_state = 7051985UL;
    printf("random seed %lu\n", random_state);
    for (unsigned round = 0; round < 10; round++) {
        start();
        expect_order(&front);
        for (unsigned i = 0; i < 10000; i++) {
            feed(round % 2 == 0 ? (unsigned)random_below(256)
                                : (unsigned char)alphabet[random_below(sizeof alphabet)]);
        }
        TEST_ASSERT_EQUAL_UINT(0, seen.scans);
        TEST_ASSERT_EQUAL_UINT(0, seen.events[SCIP_REPLY]);
        TEST_ASSERT_EQUAL(SCIP_SCAN, stamped_frame(100 + round));
    }
}

/* Every octet of a stream replaced by any other one with a chance of 1 in 50: hardly a frame is whole, and
 * those are delivered. */
void test_in_heavy_noise_every_untouched_frame_is_delivered(void)
{
    unsigned whole = 0;
    random_state = 424242UL;
    printf("random seed %lu\n", random_state);
    expect_order(&front);
    for (unsigned k = 0; k < 400; k++) {
        bool touched = false;
        wire.length = 0;
        put_frame(&wire, &front, 0, 1000 + 100UL * k, values);
        for (size_t i = 0; i < wire.length; i++) {
            if (random_below(50) == 0) {
                unsigned changed = (unsigned)random_below(256);
                touched = touched || changed != wire.octets[i];
                wire.octets[i] = changed;
            }
        }
        unsigned before = seen.scans;
        feed_range(&wire, 0, wire.length);
        if (!touched) {
            whole++;
            TEST_ASSERT_EQUAL_UINT(before + 1, seen.scans);
        }
        seen.scans = 0;
    }
    TEST_ASSERT_GREATER_THAN_UINT(20, whole);
}

void test_dirty_high_bits_of_an_octet_do_not_matter(void)
{
    put_run(&front);
    expect_order(&front);
    for (size_t i = 0; i < wire.length; i++) {
        feed(wire.octets[i] | 0xA500U);
    }
    TEST_ASSERT_EQUAL_UINT(FRAMES, seen.scans);
    for (unsigned k = 0; k < FRAMES; k++) {
        assert_numbered_scan(k, &front, k);
    }
}

/* --- runs of octets
 * ----------------------------------------------------------------------------------------------- */

/* Of a UTM-30LX, whose furthest distance is 60000 mm; the last block has 43 characters. */
void test_a_scan_of_steps_0_to_1080_is_read_whole_in_any_portions(void)
{
    const order_t kinds[] = {{"MD", 0, 1080, 1, 0, 0}, {"GD", 0, 1080, 1, 0, 0}, {"MS", 0, 1080, 1, 0, 0}};
    const size_t lengths[] = {3372, 3369, 2257};
    for (unsigned k = 0; k < 3; k++) {
        for (unsigned i = 0; i < POINTS_MAX; i++) {
            values[i] = k < 2 ? 60000 - 55UL * i : 4095 - 3UL * i;
        }
        for (size_t portion = 1; portion < 4000; portion *= 15) {
            unsigned events[SCIP_DAMAGED + 1] = {0};
            start();
            wire.length = 0;
            put_frame(&wire, &kinds[k], 0, 7, values);
            TEST_ASSERT_EQUAL_size_t(lengths[k], wire.length);
            expect_order(&kinds[k]);
            for (size_t i = 0; i < wire.length; i++) {
                burst_octets[i] = (octet_t)wire.octets[i];
            }
            TEST_ASSERT_EQUAL(SCIP_SCAN, feed_run_text(burst_octets, wire.length, portion, events));
            TEST_ASSERT_EQUAL_UINT16(POINTS_MAX, scan.points);
            for (unsigned i = 0; i < POINTS_MAX; i++) {
                TEST_ASSERT_EQUAL_UINT16(values[i], points[i]);
            }
        }
    }
}

/* A run with a damaged frame, a line longer than the memory of a line and a refusal, in bursts of every size.
 */
void test_octets_in_bursts_make_the_same_events_as_one_by_one(void)
{
    put_run(&front);
    wire.octets[begins[1] + 30] ^= 1U;
    for (unsigned i = 0; i < 3 * SCIP_LINE_MAX + 5; i++) {
        put(&wire, 'x');
    }
    put_text(&wire, "MS0372040601000\n21S\n\n");
    expect_order(&front);
    feed_range(&wire, 0, wire.length);
    const scip_counters_t counters = parser.counters;
    unsigned expected[SCIP_DAMAGED + 1];
    memcpy(expected, seen.events, sizeof expected);
    for (size_t i = 0; i < wire.length; i++) {
        burst_octets[i] = (octet_t)wire.octets[i];
    }
    for (size_t burst = 1; burst <= wire.length; burst += burst < 120 ? 1 : 97) {
        unsigned events[SCIP_DAMAGED + 1] = {0};
        start();
        expect_order(&front);
        (void)feed_run_text(burst_octets, wire.length, burst, events);
        for (int event = SCIP_NOTHING + 1; event <= SCIP_DAMAGED; event++) {
            TEST_ASSERT_EQUAL_UINT(expected[event], events[event]);
        }
        TEST_ASSERT_EQUAL_MEMORY(&counters, &parser.counters, sizeof counters);
    }
}

/* Every octet of the second frame changed, lost or doubled: a burst that holds all of it, and one that ends
 * behind the change, make what single octets make. */
static void compare_ways(const wire_t *damaged, size_t burst)
{
    unsigned events[SCIP_DAMAGED + 1] = {0};
    start();
    expect_order(&front);
    feed_range(damaged, 0, damaged->length);
    const scip_counters_t counters = parser.counters;
    const scip_reply_t reply = parser.reply;
    for (size_t i = 0; i < damaged->length; i++) {
        burst_octets[i] = (octet_t)damaged->octets[i];
    }
    start();
    expect_order(&front);
    (void)feed_run_text(burst_octets, damaged->length, burst, events);
    TEST_ASSERT_EQUAL_MEMORY(&counters, &parser.counters, sizeof counters);
    TEST_ASSERT_EQUAL_MEMORY(reply.status, parser.reply.status, sizeof reply.status);
}

void test_a_damaged_frame_in_one_burst_makes_what_single_octets_make(void)
{
    static const unsigned replacements[] = {'\n', '9', 'b', '0', 'o', 'p', 0x00, 0xFF};
    put_run(&front);
    for (size_t at = begins[1]; at < begins[2]; at++) {
        for (size_t i = 0; i < sizeof replacements / sizeof replacements[0]; i++) {
            faulty = wire;
            faulty.octets[at] = replacements[i];
            compare_ways(&faulty, faulty.length);
            compare_ways(&faulty, at + 1);
        }
        faulty = wire;
        memmove(&faulty.octets[at], &faulty.octets[at + 1], (wire.length - at - 1) * sizeof faulty.octets[0]);
        faulty.length--;
        compare_ways(&faulty, faulty.length);
        memmove(&faulty.octets[at + 1], &wire.octets[at], (wire.length - at) * sizeof faulty.octets[0]);
        faulty.octets[at] = wire.octets[at];
        faulty.length = wire.length + 1;
        compare_ways(&faulty, faulty.length);
    }
}

void test_a_frame_with_octets_too_many_or_too_few_in_one_burst_makes_what_single_octets_make(void)
{
    static const char *const inserted[] = {"ab", "9\n", "\n9", "\n\n", "abc", "ab\n", "99b\n"};
    put_run(&front);
    for (size_t at = begins[1]; at < begins[2]; at++) {
        for (size_t i = 0; i < sizeof inserted / sizeof inserted[0]; i++) {
            const size_t more = strlen(inserted[i]);
            faulty = wire;
            memmove(&faulty.octets[at + more], &wire.octets[at],
                    (wire.length - at) * sizeof faulty.octets[0]);
            for (size_t k = 0; k < more; k++) {
                faulty.octets[at + k] = (unsigned)inserted[i][k];
            }
            faulty.length = wire.length + more;
            compare_ways(&faulty, faulty.length);
        }
        for (size_t less = 2; less < 5; less++) {
            faulty = wire;
            memmove(&faulty.octets[at], &wire.octets[at + less],
                    (wire.length - at - less) * sizeof faulty.octets[0]);
            faulty.length = wire.length - less;
            compare_ways(&faulty, faulty.length);
        }
    }
}

static scip_event_t feed_whole(const char *text)
{
    octet_t octets[400];
    unsigned events[SCIP_DAMAGED + 1] = {0};
    const size_t count = strlen(text);
    for (size_t i = 0; i < count; i++) {
        octets[i] = (octet_t)text[i];
    }
    return feed_run_text(octets, count, count, events);
}

/* Every line of a frame with one octet too much in front of its LF. */
void test_a_line_that_is_one_octet_too_long_is_damage_in_a_burst_and_octet_by_octet(void)
{
    char text[256];
    put_run(&front);
    for (size_t at = begins[1] + 15; at < begins[2] - 1; at++) {
        if (wire.octets[at] == '\n') {
            faulty = wire;
            memmove(&faulty.octets[at + 1], &wire.octets[at], (wire.length - at) * sizeof wire.octets[0]);
            faulty.octets[at] = '1';
            faulty.length++;
            compare_ways(&faulty, faulty.length);
            TEST_ASSERT_EQUAL_UINT32(3, parser.counters.scans);
            TEST_ASSERT_EQUAL_UINT32(1, damages());
        }
    }
    snprintf(text, sizeof text, "MS0372040601000\n99b1\n");
    start();
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_whole(text));
    TEST_ASSERT_EQUAL(SCIP_DAMAGE_LENGTH, parser.last_damage);
}

/* What is in the line already belongs to what comes in the burst. */
void test_a_burst_goes_on_with_the_line_that_single_octets_began(void)
{
    char text[256] = "";
    put_run(&front);
    for (size_t i = begins[0]; i < begins[1]; i++) {
        text[i - begins[0]] = (char)wire.octets[i];
    }
    for (unsigned ahead = 1; ahead < 3; ahead++) {
        start();
        expect_order(&front);
        (void)feed_range(&wire, 0, begins[0]);
        for (unsigned i = 0; i < ahead; i++) {
            (void)feed('x');
        }
        TEST_ASSERT_EQUAL(SCIP_SCAN, feed_whole(text));
        TEST_ASSERT_EQUAL_UINT32(0, damages());
    }
}

/* The last block at the very beginning of a burst. */
void test_a_scan_may_be_cut_into_two_bursts_anywhere(void)
{
    put_run(&front);
    for (size_t i = 0; i < wire.length; i++) {
        burst_octets[i] = (octet_t)wire.octets[i];
    }
    for (size_t cut = 1; cut < begins[1]; cut++) {
        unsigned events[SCIP_DAMAGED + 1] = {0};
        start();
        expect_order(&front);
        (void)feed_run_text(burst_octets, cut, cut, events);
        (void)feed_run_text(&burst_octets[cut], begins[1] - cut, begins[1] - cut, events);
        TEST_ASSERT_EQUAL_UINT(1, events[SCIP_SCAN]);
        TEST_ASSERT_EQUAL_UINT32(0, damages());
        for (unsigned i = 0; i < 35; i++) {
            TEST_ASSERT_EQUAL_UINT16(value_of(0, i, 2), points[i]);
        }
    }
}

void test_single_replies_in_one_burst_are_read_as_octet_by_octet(void)
{
    TEST_ASSERT_TRUE(scip_request(&request, SCIP_TIME_READ));
    scip_parser_expect(&parser, &request);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_whole("TM1\n00P\n00101\n\n"));
    TEST_ASSERT_EQUAL_UINT32(64, parser.reply.timestamp_ms);
    scip_parser_expect(&parser, &request);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_whole("TM1\n99b\n\n"));
    TEST_ASSERT_EQUAL_HEX16('9', parser.reply.status[0]);
}

/* Where its echo could begin, a block holds the echo's first letter. */
void test_a_block_that_looks_like_an_echo_is_read_in_a_burst_too(void)
{
    for (unsigned i = 0; i < 35; i++) {
        values[i] = i == 25 ? 1860 : 700; /* "M4" */
    }
    wire.length = 0;
    put_answer(&wire, &front, "00");
    put_frame(&wire, &front, 0, 1000, values);
    compare_ways(&wire, wire.length);
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.scans);
    TEST_ASSERT_EQUAL_UINT16(1860, points[25]);
}

void test_a_scan_without_room_in_one_burst_is_damage_and_one_without_memory_is_counted(void)
{
    char text[256] = "";
    put_run(&front);
    for (size_t i = begins[0]; i < begins[1]; i++) {
        text[i - begins[0]] = (char)wire.octets[i];
    }
    expect_order(&front);
    scan.capacity = 34;
    TEST_ASSERT_EQUAL(SCIP_DAMAGED, feed_whole(text));
    TEST_ASSERT_EQUAL(SCIP_DAMAGE_LENGTH, parser.last_damage);
    scip_parser_scan_into(&parser, NULL);
    expect_order(&front);
    TEST_ASSERT_EQUAL(SCIP_NOTHING, feed_whole(text));
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.scans);
}

void test_a_burst_stops_behind_the_octet_that_makes_an_event(void)
{
    static octet_t octets[2 * 101 + 5];
    scip_event_t event = SCIP_DAMAGED;
    put_run(&front);
    for (size_t i = 0; i < 2 * 101 + 5; i++) {
        octets[i] = (octet_t)(wire.octets[begins[0] + i] | 0xA500U);
    }
    expect_order(&front);
    TEST_ASSERT_EQUAL_size_t(0, scip_parser_feed_run(&parser, octets, 0, &event));
    TEST_ASSERT_EQUAL(SCIP_NOTHING, event);
    TEST_ASSERT_EQUAL_size_t(101, scip_parser_feed_run(&parser, octets, 207, &event));
    TEST_ASSERT_EQUAL(SCIP_SCAN, event);
    TEST_ASSERT_EQUAL_size_t(101, scip_parser_feed_run(&parser, &octets[101], 106, &event));
    TEST_ASSERT_EQUAL(SCIP_SCAN, event);
    TEST_ASSERT_EQUAL_size_t(5, scip_parser_feed_run(&parser, &octets[202], 5, &event));
    TEST_ASSERT_EQUAL(SCIP_NOTHING, event);
}

/* --- octets still to come
 * ------------------------------------------------------------------------------------------ */

/* From octet `known` on the parser knows how many are left. */
static void assert_countdown(size_t known)
{
    for (size_t i = 0; i < wire.length; i++) {
        const size_t left = wire.length - i;

        if (i >= known) {
            TEST_ASSERT_EQUAL_size_t(left, scip_parser_expected(&parser));
        } else {
            TEST_ASSERT_LESS_OR_EQUAL_size_t(left, scip_parser_expected(&parser));
        }
        (void)feed(wire.octets[i]);
    }
}

void test_in_a_stream_the_octets_of_the_next_scan_are_known_from_its_first_to_its_last(void)
{
    static const order_t orders[] = {{"MS", 372, 406, 1, 0, 0}, {"MD", 384, 405, 1, 0, 0},
                                     {"MS", 0, 31, 1, 0, 0},    {"MS", 0, 32, 1, 0, 0},
                                     {"MS", 5, 5, 1, 0, 0},     {"MS", 0, 768, 2, 0, 0}};

    for (unsigned o = 0; o < sizeof orders / sizeof orders[0]; o++) {
        start();
        expect_order(&orders[o]);
        wire.length = 0;
        put_answer(&wire, &orders[o], "00");
        (void)feed_range(&wire, 0, wire.length);
        for (unsigned frame = 0; frame < 3; frame++) {
            wire.length = 0;
            put_numbered_frame(&wire, &orders[o], frame);
            TEST_ASSERT_EQUAL_size_t(request.scan_octets, wire.length);
            assert_countdown(0);
        }
        TEST_ASSERT_EQUAL_UINT(3, seen.events[SCIP_SCAN]);
    }
}

/* 129 characters: two blocks, and one character. */
void test_a_last_block_of_one_character_is_counted_down_too(void)
{
    const order_t order = {"MD", 384, 426, 1, 0, 0};
    expect_order(&order);
    put_answer(&wire, &order, "00");
    (void)feed_range(&wire, 0, wire.length);
    wire.length = 0;
    put_numbered_frame(&wire, &order, 1);
    assert_countdown(0);
    TEST_ASSERT_EQUAL_UINT(1, seen.events[SCIP_SCAN]);
}

void test_a_scan_found_in_noise_is_counted_down_from_its_status_on(void)
{
    expect_order(&front);
    put_numbered_frame(&wire, &front, 1);
    assert_countdown(16); /* echo and its LF */
    TEST_ASSERT_EQUAL_UINT(1, seen.events[SCIP_SCAN]);
}

void test_before_an_echo_nothing_is_expected(void)
{
    TEST_ASSERT_EQUAL_UINT16(0, scip_parser_expected(&parser));
    expect_order(&front);
    TEST_ASSERT_EQUAL_UINT16(0, scip_parser_expected(&parser));
    (void)feed_text("MS03720406010");
    TEST_ASSERT_EQUAL_UINT16(0, scip_parser_expected(&parser));
}

void test_text_replies_have_no_known_length(void)
{
    expect_plain(SCIP_VERSION);
    (void)feed_text("VV\n00P\nVEND:Hokuyo;0\n");
    TEST_ASSERT_EQUAL_UINT16(0, scip_parser_expected(&parser));
}

/* "GS0384038401", "00P", "m2@0?", "CB5" and an empty line. */
void test_a_single_scan_is_counted_down_from_its_data_on(void)
{
    const order_t one = {"GS", 384, 384, 1, 0, 0};

    expect_order(&one);
    (void)feed_text("GS0384038401\n");
    TEST_ASSERT_EQUAL_UINT16(0, scip_parser_expected(&parser));
    (void)feed_text("00P\n");
    TEST_ASSERT_EQUAL_UINT16(0, scip_parser_expected(&parser));
    (void)feed_text("m2@0?\n");
    TEST_ASSERT_EQUAL_UINT16(5, scip_parser_expected(&parser));
    TEST_ASSERT_EQUAL(SCIP_SCAN, feed_text("CB5\n\n"));
}

void test_the_end_of_a_plain_reply_is_one_octet_away(void)
{
    expect_plain(SCIP_STOP);
    (void)feed_text("QT\n00P\n");
    TEST_ASSERT_EQUAL_UINT16(1, scip_parser_expected(&parser));
}

void test_a_line_that_runs_on_beyond_its_scan_expects_nothing(void)
{
    expect_order(&front);
    put_numbered_frame(&wire, &front, 1);
    (void)feed_range(&wire, 0, 95); /* in the last block */
    (void)feed_text("0000000000");
    TEST_ASSERT_EQUAL_UINT16(0, scip_parser_expected(&parser));
}

/* Whatever was lost or came too much: never more than one scan, and the next one is counted down again. */
void test_the_count_is_never_more_than_a_scan_and_right_again_for_the_next_one(void)
{
    expect_order(&front);
    put_answer(&wire, &front, "00");
    (void)feed_range(&wire, 0, wire.length);
    for (size_t cut = 0; cut < 101; cut++) {
        wire.length = 0;
        put_numbered_frame(&wire, &front, 1);
        for (size_t i = 0; i < wire.length; i++) {
            if (i != cut) {
                (void)feed(wire.octets[i]);
                TEST_ASSERT_LESS_OR_EQUAL_UINT16(101, scip_parser_expected(&parser));
            }
        }
        (void)feed_text("\n\n");
        wire.length = 0;
        put_numbered_frame(&wire, &front, 2);
        assert_countdown(16);
        seen.scans = 0;
        parser.stamps = 0; /* the same two stamps all over */
    }
}

/* --- scans that were not asked for
 * -------------------------------------------------------------------------------- */

static const order_t other = {"MS", 372, 500, 1, 0, 0}; /* 129 points: five blocks, the last one short */

/* A frame of another order, without the octet at `lost`, and with the one at `changed` changed. */
static void feed_other(unsigned frame, size_t lost, size_t changed)
{
    wire.length = 0;
    put_numbered_frame(&wire, &other, frame);
    for (size_t i = 0; i < wire.length; i++) {
        if (i != lost) {
            (void)feed(i == changed ? wire.octets[i] ^ 1U : wire.octets[i]);
        }
    }
}

#define NOWHERE ((size_t)WIRE_MAX)

static void stream_front(void)
{
    setUp();
    expect_order(&front);
    put_answer(&wire, &front, "00");
    put_numbered_frame(&wire, &front, 0);
    (void)feed_range(&wire, 0, wire.length);
    TEST_ASSERT_EQUAL_UINT(1, seen.scans);
}

void test_the_second_whole_scan_of_another_request_in_a_row_is_counted_and_each_one_behind_it(void)
{
    for (unsigned hunting = 0; hunting < 2; hunting++) {
        stream_front();
        if (hunting == 1) {
            expect_order(&front);
        }
        for (unsigned k = 0; k < 4; k++) {
            TEST_ASSERT_EQUAL_UINT32(k < 2 ? 0 : k - 1, parser.counters.foreign);
            feed_other(k, NOWHERE, NOWHERE);
        }
        TEST_ASSERT_EQUAL_UINT32(3, parser.counters.foreign);
        TEST_ASSERT_EQUAL_UINT(1, seen.scans);
    }
}

/* Any octet behind the echo, which may be anything. One lost of a block passes the sum now and then. */
void test_a_damaged_scan_of_another_request_is_not_counted_nor_the_one_behind_it(void)
{
    stream_front();
    feed_other(0, NOWHERE, NOWHERE);
    const size_t length = wire.length;
    for (size_t at = 16; at < length; at++) {
        for (unsigned lost = 0; lost < (at < 26 ? 2U : 1U); lost++) {
            const uint32_t before = parser.counters.foreign;
            feed_other(1, lost == 1 ? at : NOWHERE, lost == 0 ? at : NOWHERE);
            (void)feed_text("\n"); /* for a lost or changed line end */
            TEST_ASSERT_EQUAL_UINT32(before, parser.counters.foreign);
            feed_other(2, NOWHERE, NOWHERE);
            TEST_ASSERT_EQUAL_UINT32(before, parser.counters.foreign);
            feed_other(1, NOWHERE, NOWHERE);
            TEST_ASSERT_EQUAL_UINT32(before + 1, parser.counters.foreign);
        }
    }
}

/* What damage makes of the awaited stream: nothing but the echo is hit, here and there. */
void test_awaited_scans_with_a_damaged_echo_are_no_other_stream(void)
{
    stream_front();
    for (unsigned k = 1; k < 20; k++) {
        wire.length = 0;
        put_numbered_frame(&wire, &front, k);
        wire.octets[5] ^= k % 2;
        (void)feed_range(&wire, 0, wire.length);
    }
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.foreign);
    TEST_ASSERT_EQUAL_UINT(10, seen.scans);
}

void test_a_broken_line_and_damage_within_a_scan_end_a_row_of_others(void)
{
    for (unsigned where = 0; where < 3; where++) { /* no line of the frame, one within it, its last one */
        stream_front();
        feed_other(0, NOWHERE, NOWHERE);
        if (where == 0) {
            scip_parser_line_broken(&parser);
        } else {
            wire.length = 0;
            put_numbered_frame(&wire, &front, 1);
            wire.octets[40] ^= where == 1 ? 1U : 0U;
            wire.length -= where == 2;
            (void)feed_range(&wire, 0, wire.length);
            (void)feed_text(where == 2 ? "x\n" : "");
        }
        feed_other(2, NOWHERE, NOWHERE);
        TEST_ASSERT_EQUAL_UINT32(0, parser.counters.foreign);
        feed_other(3, NOWHERE, NOWHERE);
        TEST_ASSERT_EQUAL_UINT32(1, parser.counters.foreign);
    }
}

void test_answers_without_points_are_no_scans_of_another_request(void)
{
    stream_front();
    expect_order(&front);
    for (unsigned k = 0; k < 3; k++) {
        (void)feed_text("MS0372050001000\n99b\n\nTM1\n00P\nm2@0?\n\nVV\n00P\n99b\nm2@0?\n\n");
    }
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.foreign);
}

void test_octets_that_scip_does_not_have_are_strange_and_all_others_are_not(void)
{
    for (unsigned octet = 0; octet < 256; octet++) {
        const uint32_t before = scip_parser_strange(&parser);
        (void)feed(octet);
        TEST_ASSERT_EQUAL_UINT32(octet == 0 || octet > 0x7F ? 1 : 0, scip_parser_strange(&parser) - before);
        (void)feed_text("\n");
        TEST_ASSERT_EQUAL_UINT32(octet == 0 || octet > 0x7F ? 1 : 0, scip_parser_strange(&parser) - before);
    }
}

/* In a frame's block; in a line longer than its memory, in its end and before; in a line that breaks. */
void test_strange_octets_stay_counted_once_however_their_line_ends(void)
{
    for (unsigned how = 0; how < 4; how++) {
        stream_front();
        wire.length = 0;
        put_numbered_frame(&wire, &front, 1);
        wire.octets[40] = 0x80U;
        if (how == 1 || how == 3) {
            for (unsigned i = 0; i < 300U; i++) {
                (void)feed(i == (how == 1 ? 290 : 200) ? 0x80U : 'x');
            }
        } else {
            (void)feed_range(&wire, 0, how == 0 ? wire.length : 45);
        }
        if (how == 2) {
            scip_parser_line_broken(&parser);
        }
        (void)feed_text("\nMS0372040601000\n");
        TEST_ASSERT_EQUAL_UINT32(1, scip_parser_strange(&parser));
    }
}

void test_of_a_line_that_never_ends_its_memory_is_counted(void)
{
    for (unsigned i = 1; i <= 600; i++) {
        (void)feed(i == 300 ? 0x80U : 'x');
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(i, scip_parser_octets(&parser));
    }
    TEST_ASSERT_EQUAL_UINT32(256, scip_parser_octets(&parser));
    TEST_ASSERT_EQUAL_UINT32(0, scip_parser_strange(&parser)); /* it has left the memory */
    (void)feed(0x80U);
    TEST_ASSERT_EQUAL_UINT32(1, scip_parser_strange(&parser));
    (void)feed_text("\nab\n");
    TEST_ASSERT_EQUAL_UINT32(257 + 3,
                             scip_parser_octets(&parser)); /* of the long line what was held, and its end */
}

/* A burst that ends with the echo, right, wrong in an octet, or without its line end. */
void test_a_burst_that_holds_an_echo_alone_is_taken_where_it_is_right(void)
{
    static const char *const lines[] = {"MS0372040601000\n", "MS0372040601001\n", "MS0372040601000x"};
    octet_t octets[16];
    for (unsigned k = 0; k < 3; k++) {
        scip_event_t event;
        stream_front();
        for (unsigned i = 0; i < 16; i++) {
            octets[i] = (octet_t)lines[k][i];
        }
        TEST_ASSERT_EQUAL_size_t(16, scip_parser_feed_run(&parser, octets, 16, &event));
        TEST_ASSERT_EQUAL(k == 1 ? SCIP_DAMAGED : SCIP_NOTHING, event);
        TEST_ASSERT_EQUAL_UINT16(k == 0 ? 85 : (k == 1 ? 0 : 85), scip_parser_expected(&parser));
    }
}

void test_octets_before_a_broken_line_are_counted_once(void)
{
    (void)feed_text("12345");
    scip_parser_line_broken(&parser);
    TEST_ASSERT_EQUAL_UINT32(5, scip_parser_octets(&parser));
    (void)feed_text("123456789\n");
    TEST_ASSERT_EQUAL_UINT32(15, scip_parser_octets(&parser));
}

/* What lies behind a burst in memory is not read: it may be an older one. */
void test_of_a_burst_that_ends_in_a_scan_no_octet_more_is_taken(void)
{
    const order_t two_blocks = {"MS", 372, 419, 1, 0, 0};
    octet_t octets[200];
    for (size_t cut = 1; cut < 100; cut++) {
        scip_event_t event;
        start();
        expect_order(&two_blocks);
        wire.length = 0;
        put_answer(&wire, &two_blocks, "00");
        (void)feed_range(&wire, 0, wire.length);
        wire.length = 0;
        put_numbered_frame(&wire, &two_blocks, 0);
        for (size_t i = 0; i < wire.length; i++) {
            octets[i] = (octet_t)wire.octets[i];
        }
        TEST_ASSERT_EQUAL_size_t(cut, scip_parser_feed_run(&parser, octets, cut, &event));
        TEST_ASSERT_EQUAL(SCIP_NOTHING, event);
        TEST_ASSERT_EQUAL_size_t(wire.length - cut,
                                 scip_parser_feed_run(&parser, &octets[cut], wire.length - cut, &event));
        TEST_ASSERT_EQUAL(SCIP_SCAN, event);
    }
}

/* 65 characters and their sum. */
void test_a_line_longer_than_a_block_is_of_no_scan(void)
{
    char line[70], text[120];
    memset(line, '0', 65);
    scip_frames_summed(text, line, 65);
    stream_front();
    for (unsigned k = 0; k < 3; k++) {
        (void)feed_text("MS0000100001000\n99b\nm2@0?\n");
        (void)feed_text(text);
        (void)feed_text("\n");
    }
    TEST_ASSERT_EQUAL_UINT32(0, parser.counters.foreign);
}

/* Also a scan of another request; not an empty line behind an empty one. */
void test_replies_to_other_requests_are_counted_as_strays(void)
{
    stream_front();
    expect_plain(SCIP_STOP);
    (void)feed_text("TM2\n00P\n\n\n\n");
    TEST_ASSERT_EQUAL_UINT32(1, parser.counters.stray);
    feed_other(0, NOWHERE, NOWHERE);
    TEST_ASSERT_EQUAL_UINT32(2, parser.counters.stray);
    TEST_ASSERT_EQUAL(SCIP_REPLY, feed_text("QT\n00P\n\n"));
    TEST_ASSERT_EQUAL_UINT32(2, parser.counters.stray);
}
