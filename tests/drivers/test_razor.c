#include "drivers/razor.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "unity.h"

#pragma GCC diagnostic ignored "-Wmissing-prototypes" /* the generated runner declares the tests */

#define SEED 9025UL
#define DEGREE 0.017453292519943295
#define G_MPS2 9.80665
#define FRAMES_MAX 64U

typedef struct {
    uint16_t ok;
    uint16_t malformed;
    uint16_t out_of_range;
    razor_frame_t frame[FRAMES_MAX];
} stream_t;

static razor_collector_t collector;
static stream_t stream;
static uint32_t random_state;

void setUp(void)
{
    memset(&collector, 0x5A, sizeof collector);
    razor_collector_init(&collector);
    memset(&stream, 0, sizeof stream);
    random_state = SEED;
}

void tearDown(void) {}

/* xorshift32 (Marsaglia 2003) */
static uint32_t random_bits(void)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 17;
    random_state ^= random_state << 5;
    return random_state;
}

static void feed_octet(octet_t octet)
{
    razor_frame_t frame;

    if (!razor_collect(&collector, octet)) {
        return;
    }
    switch (razor_parse(&collector.gathered, &frame)) {
    case RAZOR_OK:
        stream.frame[stream.ok % FRAMES_MAX] = frame;
        stream.ok++;
        break;
    case RAZOR_MALFORMED:
        stream.malformed++;
        break;
    case RAZOR_OUT_OF_RANGE:
        stream.out_of_range++;
        break;
    }
}

static void feed_octets(const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        feed_octet(octet_of((uint16_t)text[i]));
    }
}

static void feed(const char *text)
{
    feed_octets(text, strlen(text));
}

static void feed_file(const char *name)
{
    char path[512];
    FILE *file;
    int octet;

    (void)snprintf(path, sizeof path, "%s/razor/%s", FIXTURES, name);
    file = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    while ((octet = fgetc(file)) != EOF) {
        feed_octet(octet_of((uint16_t)octet));
    }
    (void)fclose(file);
}

static void assert_counts(uint16_t ok, uint16_t malformed, uint32_t cut, uint32_t overlong)
{
    TEST_ASSERT_EQUAL(ok, stream.ok);
    TEST_ASSERT_EQUAL(malformed, stream.malformed);
    TEST_ASSERT_EQUAL(0U, stream.out_of_range);
    TEST_ASSERT_EQUAL(cut, collector.cut);
    TEST_ASSERT_EQUAL(overlong, collector.overlong);
}

static void assert_angles(double yaw, double pitch, double roll, const razor_frame_t *frame)
{
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, (float)(yaw * DEGREE), frame->yaw_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, (float)(pitch * DEGREE), frame->pitch_rad);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, (float)(roll * DEGREE), frame->roll_rad);
}

static void assert_acceleration(double x, double y, double z, const razor_frame_t *frame)
{
    TEST_ASSERT_TRUE(frame->has_acceleration);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, (float)x, frame->x_counts);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, (float)y, frame->y_counts);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, (float)z, frame->z_counts);
}

static razor_text_t text_of(const char *text)
{
    razor_text_t result;
    memset(&result, 0x5A, sizeof result);
    result.length = (uint16_t)strlen(text);
    memcpy(result.text, text, strlen(text));
    return result;
}

static razor_status_t parse(const char *text, razor_frame_t *frame)
{
    razor_text_t gathered = text_of(text);
    return razor_parse(&gathered, frame);
}

static void assert_refused(razor_status_t status, const char *text)
{
    razor_frame_t frame;
    razor_frame_t before;

    memset(&frame, 0x3C, sizeof frame);
    before = frame;
    TEST_ASSERT_EQUAL_MESSAGE(status, parse(text, &frame), text);
    TEST_ASSERT_EQUAL_MESSAGE(0, memcmp(&before, &frame, sizeof frame), text);
}

/* --- the numbers --- */

void test_degrees_become_radians_in_the_order_yaw_pitch_roll(void)
{
    razor_frame_t frame;
    TEST_ASSERT_EQUAL(RAZOR_OK, parse("#YPR=90.00,-30.50,4.25", &frame));
    assert_angles(90.0, -30.5, 4.25, &frame);
}

void test_positive_roll_and_pitch_on_the_wire_are_positive_on_the_vehicle(void)
{
    razor_frame_t frame;
    TEST_ASSERT_EQUAL(RAZOR_OK, parse("#YPR=10.00,20.00,30.00", &frame));
    TEST_ASSERT_TRUE(frame.yaw_rad > 0.0F);
    TEST_ASSERT_TRUE(frame.pitch_rad > 0.0F);
    TEST_ASSERT_TRUE(frame.roll_rad > 0.0F);
}

void test_at_rest_and_level_the_acceleration_is_one_g_down(void)
{
    razor_frame_t frame;
    TEST_ASSERT_EQUAL(RAZOR_OK, parse("#A-C=0.00,0.00,256.00\n#YPR=0.00,0.00,0.00", &frame));
    TEST_ASSERT_TRUE(frame.has_acceleration);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.0F, frame.x_counts);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 0.0F, frame.y_counts);
    TEST_ASSERT_FLOAT_WITHIN(2e-6F, 256.0F, frame.z_counts);
}

void test_256_counts_are_one_g_on_every_axis(void)
{
    razor_frame_t frame;
    TEST_ASSERT_EQUAL(RAZOR_OK, parse("#A-C=256,-512,128#YPR=1,2,3", &frame));
    assert_acceleration(256.0, -512.0, 128.0, &frame);
    assert_angles(1.0, 2.0, 3.0, &frame);
}

void test_angles_alone_have_no_acceleration(void)
{
    razor_frame_t frame;
    memset(&frame, 0x3C, sizeof frame);
    TEST_ASSERT_EQUAL(RAZOR_OK, parse("#YPR=-103.49,2.74,4.74", &frame));
    TEST_ASSERT_FALSE(frame.has_acceleration);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, frame.x_counts);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, frame.y_counts);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, frame.z_counts);
}

void test_one_separator_may_stand_between_the_parts(void)
{
    static const char *const texts[] = {
        "#A-C=1.00,2.00,3.00#YPR=4.00,5.00,6.00", "#A-C=1.00,2.00,3.00,#YPR=4.00,5.00,6.00",
        "#A-C=1.00,2.00,3.00 #YPR=4.00,5.00,6.00", "#A-C=1.00,2.00,3.00\n#YPR=4.00,5.00,6.00"};
    for (uint16_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        razor_frame_t frame;
        TEST_ASSERT_EQUAL_MESSAGE(RAZOR_OK, parse(texts[i], &frame), texts[i]);
        assert_acceleration(1.0, 2.0, 3.0, &frame);
        assert_angles(4.0, 5.0, 6.0, &frame);
    }
}

void test_minus_zero_is_zero(void)
{
    razor_frame_t frame;
    TEST_ASSERT_EQUAL(RAZOR_OK, parse("#A-C=-0.00,-0.00,256.00#YPR=-0.00,-0.00,-0.00", &frame));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, frame.roll_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, frame.x_counts);
}

void test_malformed_texts_are_refused_and_the_frame_is_untouched(void)
{
    static const char *const texts[] = {"",
                                        "#",
                                        "#YPR",
                                        "#YPR=",
                                        "#YPR=,",
                                        "#YPR=,,",
                                        "#YPR=1",
                                        "#YPR=1,2",
                                        "#YPR=1,2,",
                                        "#YPR=,2,3",
                                        "#YPR=1,,3",
                                        "#YPR=1,2,3,",
                                        "#YPR=1,2,3,4",
                                        "#YPR=1,2,3 ",
                                        "#YPR= 1,2,3",
                                        "#YPR=1, 2,3",
                                        "#YPR=1;2;3",
                                        "#YPR=1,2,3\n",
                                        "#YPR=nan,nan,nan",
                                        "#YPR=1,nan,3",
                                        "#YPR=1,2,inf",
                                        "#YPR=ovf,2,3",
                                        "#YPR=-inf,2,3",
                                        "#YPR=1,2,1e39",
                                        "#YPR=1.2.3,2,3",
                                        "#YPR=1,2,0x3",
                                        "YPR=1,2,3",
                                        "#ypr=1,2,3",
                                        "#YPRAG=1,2,3",
                                        "!ANG:1,2,3",
                                        "#YPR=1,2,#YPR=1,2,3",
                                        "#A-C=",
                                        "#A-C=1,2,3",
                                        "#A-C=1,2,3\n",
                                        "#A-C=1,2,3\n#",
                                        "#A-C=1,2,3\n#YPR",
                                        "#A-C=1,2,3\n#YPR=",
                                        "#A-C=#YPR=1,2,3",
                                        "#A-C=,#YPR=1,2,3",
                                        "#A-C=1,2#YPR=1,2,3",
                                        "#A-C=1,2,#YPR=1,2,3",
                                        "#A-C=1,2,3,4#YPR=1,2,3",
                                        "#A-C=1,2,3,,#YPR=1,2,3",
                                        "#A-C=1,2,3,\n#YPR=1,2,3",
                                        "#A-C=1,2,3\n\n#YPR=1,2,3",
                                        "#A-C=nan,2,3#YPR=1,2,3",
                                        "#A-C=1,2,ovf\n#YPR=1,2,3",
                                        "#A-C=1,2,3#M-C=1,2,3",
                                        "#A-C=1,2,3#A-C=1,2,3",
                                        "#A-C=1,2,3;#YPR=1,2,3",
                                        "#A-R=1,2,3#YPR=1,2,3",
                                        "#YPR=1,2,3#A-C=1,2,3"};
    for (uint16_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        assert_refused(RAZOR_MALFORMED, texts[i]);
    }
}

void test_angles_are_accepted_up_to_one_turn_and_accelerations_up_to_16_g(void)
{
    razor_frame_t frame;
    TEST_ASSERT_EQUAL(RAZOR_OK, parse("#A-C=4096,-4096,4096#YPR=360,-360,360.00", &frame));
    assert_refused(RAZOR_OUT_OF_RANGE, "#YPR=360.01,0,0");
    assert_refused(RAZOR_OUT_OF_RANGE, "#YPR=0,-360.01,0");
    assert_refused(RAZOR_OUT_OF_RANGE, "#YPR=0,0,1e30");
    assert_refused(RAZOR_OUT_OF_RANGE, "#A-C=4096.01,0,0#YPR=0,0,0");
    assert_refused(RAZOR_OUT_OF_RANGE, "#A-C=0,-4096.01,0#YPR=0,0,0");
    assert_refused(RAZOR_OUT_OF_RANGE, "#A-C=0,0,99999.99\n#YPR=0,0,0");
}

void test_every_hundredth_of_a_degree_is_read_to_the_last_bit_but_one(void)
{
    for (int32_t hundredths = -36000; hundredths <= 36000; hundredths += 7) {
        char text[64];
        razor_frame_t frame;
        (void)snprintf(text, sizeof text, "#YPR=%.2f,0.00,%.2f", hundredths / 100.0, -hundredths / 100.0);
        TEST_ASSERT_EQUAL(RAZOR_OK, parse(text, &frame));
        assert_angles(hundredths / 100.0, 0.0, -hundredths / 100.0, &frame);
    }
}

/* --- the collector --- */

void test_a_frame_is_gathered_from_its_first_sharp_with_one_lf_inside(void)
{
    static const char expected[] = "#A-C=1.00,2.00,3.00\n#YPR=4.00,5.00,6.00";
    feed("#A-C=1.00,2.00,3.00\r\n#YPR=4.00,5.00,6.00\r");
    assert_counts(1U, 0U, 0U, 0U);
    TEST_ASSERT_EQUAL(strlen(expected), collector.gathered.length);
    TEST_ASSERT_EQUAL(0, memcmp(expected, collector.gathered.text, strlen(expected)));
}

void test_a_frame_is_delivered_once_at_lf_cr_or_cr_lf(void)
{
    feed("#YPR=1,2,3\n#YPR=1,2,3\r#YPR=1,2,3\r\n\r\n\n\r");
    assert_counts(3U, 0U, 0U, 0U);
}

void test_a_delivered_frame_never_lends_its_acceleration_to_the_next(void)
{
    feed("#A-C=1,2,3\r\n#YPR=1,2,3\r\n#YPR=4,5,6\r\n");
    assert_counts(2U, 0U, 0U, 0U);
    TEST_ASSERT_TRUE(stream.frame[0].has_acceleration);
    TEST_ASSERT_FALSE(stream.frame[1].has_acceleration);
}

void test_a_new_acceleration_restarts_the_frame(void)
{
    feed("#A-C=1,2,3\r\n#A-C=4,5,6\r\n#YPR=1,2,3\r\n");
    feed("#A-C=1,2,3#A-C=7,8,9#YPR=1,2,3\r\n");
    feed("#A-C=1,#A-C=10,11,12\r\n#YPR=1,2,3\r\n");
    assert_counts(3U, 0U, 0U, 0U);
    assert_acceleration(4.0, 5.0, 6.0, &stream.frame[0]);
    assert_acceleration(7.0, 8.0, 9.0, &stream.frame[1]);
    assert_acceleration(10.0, 11.0, 12.0, &stream.frame[2]);
}

void test_lines_of_other_sensors_between_the_parts_are_passed_over(void)
{
    feed("#A-C=1,2,3\r\n#M-C=9,9,9\r\n#G-C=8,8,8\r\n!ANG:1,2,3\r\n#\r\n#A\r\n\r\n#YPR=4,5,6\r\n");
    feed("#A-C=1,2,3,#M-C=9,9,9,#G-C=8,8,8,#YPR=4,5,6\r\n");
    feed("#A-C=1,2,3##M-C#YPR=4,5,6\r\n");
    assert_counts(3U, 0U, 0U, 0U);
    for (uint16_t i = 0; i < 3U; i++) {
        assert_acceleration(1.0, 2.0, 3.0, &stream.frame[i]);
        assert_angles(4.0, 5.0, 6.0, &stream.frame[i]);
    }
}

void test_a_title_cut_by_a_line_end_does_not_go_on_in_the_next_line(void)
{
    feed("#YP\nR=1.00,2.00,3.00\n");
    assert_counts(0U, 0U, 0U, 0U);
}

void test_other_firmwares_are_never_guessed_at(void)
{
    /* formats of Razor_AHRS and its forks */
    feed("!ANG:1.00,2.00,3.00\r\n#YPRAG=1,2,3,4,5,6,7,8,9\r\n#A-R=1,2,3\r\n#SYNCH00\r\n#A-B=1,2,3\r\n");
    feed("accel x,y,z (min/max) = -5.00/-1.00  25.00/29.00  225.00/232.00\r\n$1,2,3,4,5,6,7,8,9#\r\n");
    feed("1.00, 2.00, 3.00, 4.00, 5.00, 6.00\r\n!ERR: reading accelerometer\r\n");
    assert_counts(0U, 0U, 0U, 0U);
}

void test_a_frame_without_end_is_dropped_and_counted_and_the_next_is_whole(void)
{
    char digits[300];

    memset(digits, '1', sizeof digits);
    feed("#YPR=");
    feed_octets(digits, sizeof digits);
    feed("\r\n");
    assert_counts(0U, 0U, 0U, 1U);
    feed("#A-C=");
    feed_octets(digits, RAZOR_FRAME_MAX - 5U); /* full: the LF does not fit */
    TEST_ASSERT_EQUAL(1U, collector.overlong);
    feed("\r\n");
    assert_counts(0U, 0U, 0U, 2U);
    feed("#A-C=");
    feed_octets(digits, RAZOR_FRAME_MAX - 5U); /* full: the next '#' does not fit */
    feed("#YPR=1,2,3\r\n");
    assert_counts(0U, 0U, 0U, 3U);
    feed("#A-C=1,2,3\r\n#YPR=4,5,6\r\n");
    assert_counts(1U, 0U, 0U, 3U);
}

/* A text of the sensor's menu; the accelerations before it stay. */
void test_a_line_with_another_title_may_be_of_any_length(void)
{
    char text[RAZOR_FRAME_MAX + 1U];

    memset(text, '1', sizeof text);
    feed("#A-C=1,2,3\r\n#TEXT ");
    feed_octets(text, sizeof text);
    feed("\r\n#YPR=4,5,6\r\n");
    assert_counts(1U, 0U, 0U, 0U);
    assert_acceleration(1.0, 2.0, 3.0, &stream.frame[0]);
}

void test_the_longest_frame_that_fits_is_accepted(void)
{
    char text[RAZOR_FRAME_MAX + 1U];

    memset(text, '0', sizeof text);
    memcpy(text, "#A-C=1,2,3\n#YPR=1,2,", 20);
    feed_octets(text, RAZOR_FRAME_MAX);
    feed("\r\n");
    assert_counts(1U, 0U, 0U, 0U);
    feed_octets(text, RAZOR_FRAME_MAX + 1U);
    feed("\r\n");
    assert_counts(1U, 0U, 0U, 1U);
}

void test_angles_without_a_line_end_are_cut_and_counted(void)
{
    feed("#A-C=1,2,3\r\n#YPR=1,2,3#A-C=4,5,6\r\n#YPR=7,8,9\r\n");
    assert_counts(1U, 0U, 1U, 0U);
    assert_acceleration(4.0, 5.0, 6.0, &stream.frame[0]);
    assert_angles(7.0, 8.0, 9.0, &stream.frame[0]);
    feed("#YPR=1,2,#YPR=4,5,6\r\n");
    assert_counts(2U, 0U, 2U, 0U);
    assert_angles(4.0, 5.0, 6.0, &stream.frame[1]);
}

void test_lost_octets_drop_what_was_gathered_and_nothing_more(void)
{
    feed("#A-C=1,2,3\r\n#YPR=1,2");
    razor_collector_broken(&collector);
    feed(",3\r\n#A-C=1,2,3\r\n");
    assert_counts(0U, 0U, 0U, 0U);
    razor_collector_broken(&collector);
    feed("#YPR=1,2,3\r\n");
    assert_counts(1U, 0U, 0U, 0U);
    TEST_ASSERT_FALSE(stream.frame[0].has_acceleration);
}

void test_lost_octets_do_not_reset_the_counters(void)
{
    feed("#YPR=1#");
    razor_collector_broken(&collector);
    TEST_ASSERT_EQUAL(1U, collector.cut);
    razor_collector_init(&collector);
    TEST_ASSERT_EQUAL(0U, collector.cut);
}

/* --- resynchronisation --- */

void test_after_any_single_damaged_octet_the_second_next_frame_is_whole(void)
{
    static const char frame[] = "#A-C=1.00,2.00,256.00\r\n#YPR=4.00,5.00,6.00\r\n";
    static const size_t n = sizeof frame - 1U;

    for (size_t at = 0; at < n; at++) {
        for (uint16_t octet = 0; octet < 256U; octet++) {
            char damaged[sizeof frame];

            memcpy(damaged, frame, sizeof frame);
            damaged[at] = (char)octet;
            setUp();
            feed_octets(damaged, n);
            feed(frame);
            stream.ok = 0U;
            feed(frame);
            TEST_ASSERT_EQUAL(1U, stream.ok);
            assert_acceleration(1.0, 2.0, 256.0, &stream.frame[0]);
            assert_angles(4.0, 5.0, 6.0, &stream.frame[0]);
        }
    }
}

void test_after_a_start_or_a_loss_at_any_octet_the_next_frame_is_whole(void)
{
    static const char frame[] = "#A-C=1.00,2.00,256.00\r\n#YPR=4.00,5.00,6.00\r\n";
    static const size_t n = sizeof frame - 1U;

    for (size_t from = 0; from < n; from++) {
        setUp();
        feed_octets(&frame[from], n - from);
        stream.ok = 0U;
        feed(frame);
        TEST_ASSERT_EQUAL(1U, stream.ok);
        assert_acceleration(1.0, 2.0, 256.0, &stream.frame[0]);

        setUp();
        feed_octets(frame, from);
        stream.ok = 0U;
        feed(frame);
        TEST_ASSERT_EQUAL(1U, stream.ok);
        assert_acceleration(1.0, 2.0, 256.0, &stream.frame[0]);
    }
}

void test_random_octets_never_overrun_and_never_hide_a_later_frame(void)
{
    static const char alphabet[] = "#A-C=YPR.0123456789,\r\n ";

    printf("random octets: seed %lu\n", SEED);
    for (uint32_t i = 0; i < 200000UL; i++) {
        bool any = random_bits() % 8U == 0U;
        feed_octet(any ? octet_of((uint16_t)random_bits())
                       : octet_of((uint16_t)alphabet[random_bits() % 23U]));
        TEST_ASSERT_LESS_OR_EQUAL(RAZOR_FRAME_MAX, collector.gathered.length);
        if (i % 1000U == 0U) {
            feed("\r\n#A-C=1,2,3\r\n#YPR=4,5,6\r\n");
            stream.ok = 0U;
            feed("#A-C=1,2,3\r\n#YPR=4,5,6\r\n");
            TEST_ASSERT_EQUAL(1U, stream.ok);
            assert_acceleration(1.0, 2.0, 3.0, &stream.frame[0]);
        }
    }
}

/* --- streams; the counts stand in tests/fixtures/razor/README.md too --- */

static void assert_flight_values(uint16_t frames)
{
    for (uint16_t k = 0; k < frames; k++) {
        double t = 0.025 * k;
        double roll = 4.0 * sin(6.283185307 * 1.1 * t);
        double pitch = -3.0 * sin(6.283185307 * 0.8 * t + 0.4);
        TEST_ASSERT_FLOAT_WITHIN(1e-4F, (float)(roll * DEGREE), stream.frame[k].roll_rad);
        TEST_ASSERT_FLOAT_WITHIN(1e-4F, (float)(pitch * DEGREE), stream.frame[k].pitch_rad);
        if (stream.frame[k].has_acceleration) {
            TEST_ASSERT_FLOAT_WITHIN(0.03F, (float)(-256.0 * sin(pitch * DEGREE)), stream.frame[k].x_counts);
            TEST_ASSERT_FLOAT_WITHIN(0.03F, (float)(256.0 * sin(roll * DEGREE)), stream.frame[k].y_counts);
            TEST_ASSERT_FLOAT_WITHIN(0.03F, (float)(256.0 * cos(roll * DEGREE) * cos(pitch * DEGREE)),
                                     stream.frame[k].z_counts);
        }
    }
}

void test_the_stream_of_separate_lines(void)
{
    feed_file("separate_lines.txt");
    assert_counts(20U, 0U, 0U, 0U);
    TEST_ASSERT_TRUE(stream.frame[19].has_acceleration);
    assert_flight_values(20U);
}

void test_the_stream_of_joined_lines_says_the_same(void)
{
    stream_t separate;

    feed_file("separate_lines.txt");
    separate = stream;
    setUp();
    feed_file("joined.txt");
    assert_counts(20U, 0U, 0U, 0U);
    TEST_ASSERT_EQUAL(0, memcmp(&separate, &stream, sizeof stream));
}

void test_the_stream_of_angles_alone(void)
{
    feed_file("ypr_only.txt");
    assert_counts(20U, 0U, 0U, 0U);
    for (uint16_t k = 0; k < 20U; k++) {
        TEST_ASSERT_FALSE(stream.frame[k].has_acceleration);
    }
    assert_flight_values(20U);
}

void test_the_stream_with_a_boot_banner(void)
{
    feed_file("boot_banner.txt");
    assert_counts(3U, 0U, 0U, 0U);
    assert_flight_values(3U);
}

void test_the_stream_with_lines_of_other_sensors(void)
{
    feed_file("other_lines.txt");
    assert_counts(5U, 0U, 0U, 0U);
    TEST_ASSERT_TRUE(stream.frame[2].has_acceleration);
    assert_flight_values(5U);
}

void test_the_stream_of_half_lines(void)
{
    feed_file("half_lines.txt");
    assert_counts(6U, 2U, 1U, 1U);
    TEST_ASSERT_FALSE(stream.frame[0].has_acceleration);
    assert_angles(178.5, -1.17, 0.0, &stream.frame[0]);
    assert_acceleration(9.40, 8.85, 255.67, &stream.frame[2]);
    assert_acceleration(11.48, 13.58, 255.38, &stream.frame[3]);
    assert_acceleration(13.39, 17.86, 255.03, &stream.frame[4]);
    TEST_ASSERT_FALSE(stream.frame[5].has_acceleration);
}

void test_the_stream_with_nuls(void)
{
    feed_file("nul_octets.txt");
    assert_counts(3U, 3U, 0U, 0U);
    TEST_ASSERT_TRUE(stream.frame[0].has_acceleration);
    TEST_ASSERT_FALSE(stream.frame[1].has_acceleration);
    TEST_ASSERT_TRUE(stream.frame[2].has_acceleration);
}

void test_the_stream_with_nan_inf_and_ovf(void)
{
    feed_file("nan_lines.txt");
    assert_counts(6U, 8U, 0U, 0U);
}
