/* plomada scip decode and mirrors, on streams that the scanner model makes and that are then damaged in every
 * way. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "sim/devices/scene.h"
#include "sim/devices/urg04lx.h"
#include "sim/noise.h"
#include "tests/support/scip_frames.h"
#include "tools/plomada/scip_reader.h"
#include "unity.h"

#define STREAM_MAX 600000
#define LINE_MAX_N 6000
#define FRAMES_MAX 400

/* ---- a stream and the truth about it ---- */

static unsigned char stream[STREAM_MAX];
static size_t stream_length;

typedef struct {
    long stamp_ms;
    int distance_mm[769]; /* of the steps asked for */
    int first, last;
} truth_t;

static truth_t truth[FRAMES_MAX];
static int truth_count;

static urg04lx_t *urg;
static noise_t world_noise;
static double rate;

static void hear(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    (void)bit_ns;
    TEST_ASSERT_TRUE(stream_length < STREAM_MAX);
    stream[stream_length++] = (unsigned char)octet;
}

/* Distances of every kind: codes, near, beyond two characters, up to DMAX. Revolutions begin at whole 100 ms.
 */
static void world(void *context, const urg_rays_t *rays, int *distance_mm)
{
    truth_t *t;

    (void)context;
    truth_count += rays->from_step == rays->first_step;
    TEST_ASSERT_TRUE(truth_count <= FRAMES_MAX);
    t = &truth[truth_count - 1];
    t->stamp_ms = (long)(timeline_now() / urg04lx_default.revolution) * 100L & 0xFFFFFFL;
    t->first = rays->first_step;
    t->last = rays->last_step;
    for (int i = 0; i <= rays->to_step - rays->from_step; i++) {
        const double kind = noise_uniform(&world_noise, 0.0, 1.0);

        distance_mm[i] = (int)noise_uniform(&world_noise, kind < 0.1 ? 0.0 : 20.0,
                                            kind < 0.1 ? 20.0 : 5601.0);
        t->distance_mm[rays->from_step - rays->first_step + i] = distance_mm[i];
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

static void say(const char *text, double wait_s)
{
    for (; *text != '\0'; text++) {
        run_until(timeline_now() + (sim_time_t)(1e10 / rate));
        urg04lx_receive(urg, (unsigned char)*text, 1e9 / rate);
    }
    run_until(timeline_now() + (sim_time_t)(wait_s * 1e9));
}

static void power_on(urg_world_t what, void *context)
{
    timeline_reset();
    stream_length = 0;
    truth_count = 0;
    rate = 115200.0;
    noise_init(&world_noise, 4, "world");
    urg = urg04lx_create(&urg04lx_default, what, context, hear, NULL);
    urg04lx_power(urg, true);
    run_until(9 * SIM_S);
}

static void to_scip2(void)
{
    say("SCIP2.0\n", 0.1);
    say("SS250000\n", 0.1);
    rate = 250000.0;
}

void setUp(void)
{
    urg = NULL;
}

void tearDown(void)
{
    if (urg != NULL) {
        urg04lx_destroy(urg);
    }
}

/* What decode must print of one truth. */
static int as_sent(const truth_t *t, int step, int largest)
{
    if (step < 44 || step > 725) {
        return 19;
    }
    return t->distance_mm[step - t->first] > largest ? largest : t->distance_mm[step - t->first];
}

static int cluster_as_sent(const truth_t *t, int from, int cluster, int largest)
{
    int value = as_sent(t, from, largest);

    for (int step = from + 1; step < from + cluster && step <= t->last; step++) {
        const int mm = as_sent(t, step, largest);

        if (mm >= 20 && (value < 20 || mm < value)) {
            value = mm;
        }
    }
    return value;
}

static void truth_line(const truth_t *t, int cluster, int largest, char *line)
{
    line += sprintf(line, "%ld,%d", t->stamp_ms, (t->last - t->first + cluster) / cluster);
    for (int step = t->first; step <= t->last; step += cluster) {
        line += sprintf(line, ",%d", cluster_as_sent(t, step, cluster, largest));
    }
}

/* ---- the reader itself ---- */

static char lines[FRAMES_MAX][LINE_MAX_N];
static int line_count;
static scip_reader_t reader;

static void take(void *context, const scip_scan_t *scan)
{
    char *line = lines[line_count++];

    TEST_ASSERT_EQUAL_PTR(lines, context);
    TEST_ASSERT_TRUE(line_count <= FRAMES_MAX);
    line += sprintf(line, "%lu,%u", (unsigned long)scan->timestamp_ms, scan->points);
    for (int i = 0; i < scan->points; i++) {
        line += sprintf(line, ",%u", scan->distance_mm[i]);
    }
}

static void read_stream(const unsigned char *octets, size_t count)
{
    line_count = 0;
    scip_reader_init(&reader, take, lines);
    scip_reader_feed(&reader, octets, count);
    scip_reader_end(&reader);
}

static void lines_are_the_truth(int first, int count, int cluster, int largest)
{
    static char expected[LINE_MAX_N];

    TEST_ASSERT_EQUAL_INT(count, line_count);
    for (int i = 0; i < count; i++) {
        truth_line(&truth[first + i], cluster, largest, expected);
        TEST_ASSERT_EQUAL_STRING(expected, lines[i]);
    }
}

static unsigned long damage(void)
{
    unsigned long sum = 0;

    for (int i = 0; i < SCIP_DAMAGE_COUNT; i++) {
        sum += reader.parser.counters.damaged[i];
    }
    return sum;
}

void test_every_kind_of_measurement_comes_out_as_it_went_in(void)
{
    static const struct {
        const char *command;
        int cluster, largest;
    } kinds[] = {
        {"MS0372040601000\n", 1, 4095},   {"MD0372040601000\n", 1, 262143}, {"MS0000076801000\n", 1, 4095},
        {"MD0000076801000\n", 1, 262143}, {"MD0044072505000\n", 5, 262143}, {"MS0044072599000\n", 99, 4095},
        {"MD0384038400000\n", 1, 262143}, {"MS0249051902000\n", 2, 4095},   {"MD0372040601200\n", 1, 262143},
        {"MS0372040601010\n", 1, 4095},   {"MD0372040601299\n", 1, 262143},
    };

    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        power_on(world, NULL);
        to_scip2();
        say(kinds[i].command, 2.0);
        say("QT\n", 0.5);
        read_stream(stream, stream_length);
        TEST_ASSERT_TRUE(line_count >= 5);
        lines_are_the_truth(0, line_count, kinds[i].cluster, kinds[i].largest);
        TEST_ASSERT_EQUAL_UINT32(0, damage());
        TEST_ASSERT_EQUAL_UINT32(1, reader.totals.answers);
        TEST_ASSERT_FALSE(reader.totals.unfinished);
        urg04lx_destroy(urg);
        urg = NULL;
    }
}

void test_single_scans_runs_and_endless_streams_may_follow_each_other(void)
{
    power_on(world, NULL);
    say("V\n", 0.3);
    to_scip2();
    say("VV\n", 0.3);
    say("BM\n", 0.3);
    say("GS0372040601\n", 0.4);
    say("GD0000076800\n", 0.4);
    say("GD0000076800\n", 0.4);
    say("PP\n", 0.3);
    say("MS0372040601003\n", 0.8);
    say("MS0372040601005\n", 1.0);
    say("MD0372040601005\n", 1.0);
    say("MD0040080001000\n", 0.4); /* refused: 04 */
    say("GS0400039901\n", 0.4);    /* refused: 05 */
    say("MD0372040601000\n", 0.5);
    say("MS0300040001000\n", 0.5);
    say("QT\n", 0.3);
    say("II\n", 0.3);
    read_stream(stream, stream_length);
    TEST_ASSERT_EQUAL_UINT32(0, damage());
    TEST_ASSERT_TRUE(line_count >= 3 + 3 + 5 + 5 + 3 + 3);
    TEST_ASSERT_TRUE(line_count == truth_count ||
                     line_count == truth_count - 1); /* one may be given up by a new stream */
    TEST_ASSERT_EQUAL_UINT32(6, reader.totals.answers);
    TEST_ASSERT_EQUAL_UINT32(9, reader.totals.skipped); /* V SCIP2.0 SS VV BM PP 05 QT II */
    for (int i = 0; i < 16; i++) {
        static const int largest[16] = {4095, 262143, 262143, 4095,   4095,   4095,   4095,   4095,
                                        4095, 4095,   4095,   262143, 262143, 262143, 262143, 262143};
        static char expected[LINE_MAX_N];

        truth_line(&truth[i], 1, largest[i], expected);
        TEST_ASSERT_EQUAL_STRING(expected, lines[i]);
    }
}

static size_t frame_starts[FRAMES_MAX];
static int frame_count;

/* Ten frames of 372..406 behind their answer. */
static void make_short_stream(const char *command, size_t frame_octets)
{
    size_t answer = strlen(command) + 5;

    power_on(world, NULL);
    to_scip2();
    stream_length = 0;
    say(command, 1.15);
    say("QT\n", 0.5);
    frame_count = 0;
    while (answer + (size_t)frame_count * frame_octets + frame_octets <= stream_length) {
        frame_starts[frame_count] = answer + (size_t)frame_count * frame_octets;
        frame_count++;
    }
    TEST_ASSERT_INT_WITHIN(2, 10, frame_count);
    read_stream(stream, stream_length);
    TEST_ASSERT_EQUAL_INT(frame_count, line_count);
}

static char good[FRAMES_MAX][LINE_MAX_N];

static void keep_good(void)
{
    memcpy(good, lines, (size_t)frame_count * sizeof good[0]);
}

/* Every line is one of the good ones, in their order, and only those of the frames lost_from..lost_to may be
 * missing. */
static void only_lost(int lost_from, int lost_to, const char *how, size_t where)
{
    char message[96];
    int next = 0;

    snprintf(message, sizeof message, "%s at octet %zu", how, where);
    for (int i = 0; i < line_count; i++) {
        while (next < frame_count && strcmp(lines[i], good[next]) != 0) {
            TEST_ASSERT_TRUE_MESSAGE(next >= lost_from && next <= lost_to, message);
            next++;
        }
        TEST_ASSERT_TRUE_MESSAGE(next < frame_count, message);
        next++;
    }
    TEST_ASSERT_TRUE_MESSAGE(next == frame_count || (next >= lost_from && frame_count - 1 <= lost_to),
                             message);
}

static int frame_at(size_t offset)
{
    int frame = -1;

    while (frame + 1 < frame_count && frame_starts[frame + 1] <= offset) {
        frame++;
    }
    return frame;
}

static unsigned char changed[STREAM_MAX];

static void drop_everywhere(void)
{
    for (size_t k = 0; k < stream_length; k++) {
        memcpy(changed, stream, k);
        memcpy(changed + k, stream + k + 1, stream_length - k - 1);
        read_stream(changed, stream_length - 1);
        only_lost(frame_at(k), frame_at(k), "drop", k);
    }
}

static void put_in_everywhere(int octet)
{
    for (size_t k = 0; k < stream_length; k++) {
        memcpy(changed, stream, k);
        changed[k] = (unsigned char)(octet < 0 ? stream[k] : octet);
        memcpy(changed + k + 1, stream + k, stream_length - k);
        read_stream(changed, stream_length + 1);
        /* between two frames it may be read as part of either */
        only_lost(frame_at(k == 0 ? 0 : k - 1), frame_at(k), octet < 0 ? "duplicate" : "stray", k);
    }
}

static void flip_everywhere(void)
{
    for (size_t k = 0; k < stream_length; k++) {
        for (int bit = 0; bit < 8; bit++) {
            memcpy(changed, stream, stream_length);
            changed[k] = (unsigned char)(changed[k] ^ 1U << bit);
            read_stream(changed, stream_length);
            only_lost(frame_at(k), frame_at(k), "flip", k);
        }
    }
}

static void begin_everywhere(void)
{
    for (size_t k = 0; k < stream_length; k++) {
        read_stream(stream + k, stream_length - k);
        only_lost(0, frame_at(k == 0 ? 0 : k - 1), "begin", k);
    }
}

void test_any_one_fault_costs_the_frame_that_it_hits_and_nothing_else(void)
{
    static const struct {
        const char *command;
        size_t frame;
    } streams[] = {{"MS0372040601000\n", 101}, {"MD0383040401000\n", 97}};

    for (size_t i = 0; i < 2; i++) {
        make_short_stream(streams[i].command, streams[i].frame);
        keep_good();
        drop_everywhere();
        put_in_everywhere(-1);
        put_in_everywhere('A');
        put_in_everywhere('\n');
        put_in_everywhere(0xFF);
        flip_everywhere();
        urg04lx_destroy(urg);
        urg = NULL;
    }
}

void test_a_recording_may_begin_anywhere(void)
{
    make_short_stream("MS0372040601000\n", 101);
    keep_good();
    begin_everywhere();
}

void test_a_recording_of_a_counted_run_may_begin_anywhere(void)
{
    make_short_stream("MD0372040601010\n", 136);
    TEST_ASSERT_EQUAL_INT(10, frame_count);
    keep_good();
    begin_everywhere();
}

void test_a_recording_may_end_anywhere(void)
{
    make_short_stream("MS0372040601000\n", 101);
    keep_good();
    for (size_t k = 0; k < stream_length; k++) {
        read_stream(stream, k);
        TEST_ASSERT_EQUAL_INT(k < frame_starts[0] + 101 ? 0 : frame_at(k - 101) + 1, line_count);
        TEST_ASSERT_EQUAL_UINT32(0, damage());
    }
}

void test_noise_makes_no_scan_and_no_crash(void)
{
    static unsigned char noise_octets[50000];
    noise_t noise;

    noise_init(&noise, 1, "noise");
    for (int round = 0; round < 20; round++) {
        for (size_t i = 0; i < sizeof noise_octets; i++) {
            const unsigned octet = (unsigned)(noise_bits(&noise) & (round % 2 == 0 ? 0xFFU : 0x3FU));

            noise_octets[i] = (unsigned char)(octet == 7 ? '\n' : octet);
        }
        read_stream(noise_octets, sizeof noise_octets);
        TEST_ASSERT_EQUAL_INT(0, line_count);
    }
}

void test_echoes_that_no_sensor_of_this_kind_answers_are_skipped(void)
{
    static const char *const foreign[] = {
        "MD0000108101000\n99b\nabcd?\nxxx\n\n", "MS0406037201000\n00P\n\n",
        "ME0000076801000\n99b\n00000\n00\n\n",  "GD00000768\n00P\n\n",
        "MS0372040601000;who\n99b\n\n",
    };

    for (size_t i = 0; i < sizeof foreign / sizeof foreign[0]; i++) {
        read_stream((const unsigned char *)foreign[i], strlen(foreign[i]));
        TEST_ASSERT_EQUAL_INT(0, line_count);
        TEST_ASSERT_EQUAL_UINT32(0, damage());
        TEST_ASSERT_EQUAL_UINT32(1, reader.totals.skipped);
    }
}

void test_hardware_trouble_is_a_notice(void)
{
    power_on(world, NULL);
    to_scip2();
    say("MS0372040601000\n", 0.5);
    urg04lx_trouble(urg, 21);
    run_until(timeline_now() + 2 * SIM_S);
    urg04lx_trouble(urg, 77);
    run_until(timeline_now() + SIM_S);
    read_stream(stream, stream_length);
    TEST_ASSERT_EQUAL_UINT32(3, reader.totals.notices);
    TEST_ASSERT_EQUAL_UINT32(0, damage());
    TEST_ASSERT_EQUAL_INT(truth_count - 3, line_count); /* these were given up for it */
}

/* ---- the program ---- */

static char output[400000];

static int run(const char *arguments)
{
    char line[1024];

    snprintf(line, sizeof line, "scip %s", arguments);
    return child_plomada(line, output, sizeof output);
}

static void write_stream(const char *name)
{
    char path[512];
    FILE *file;

    snprintf(path, sizeof path, SCRATCH "/%s", name);
    file = fopen(path, "wb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL_size_t(stream_length, fwrite(stream, 1, stream_length, file));
    fclose(file);
}

/* What decode prints of one scan of the whole circle: the time in seconds, then a cell for each step. */
static void wide_line(const truth_t *t, int largest, char *line)
{
    line += sprintf(line, "%ld.%03ld", t->stamp_ms / 1000, t->stamp_ms % 1000);
    for (int step = t->first; step <= t->last; step++) {
        line += sprintf(line, ",%d", as_sent(t, step, largest));
    }
}

void test_decode_prints_one_line_a_scan_and_a_summary(void)
{
    static char expected[LINE_MAX_N];
    char *line;
    int count = 0;

    power_on(world, NULL);
    to_scip2();
    say("MD0000076801007\n", 1.5);
    write_stream("md.bin");
    TEST_ASSERT_EQUAL_INT(0, run("decode md.bin 2>md.err"));
    line = strtok(output, "\n");
    TEST_ASSERT_EQUAL_STRING_LEN("time,step_0,step_1,step_2,", line, 26);
    TEST_ASSERT_EQUAL_STRING(",step_767,step_768", line + strlen(line) - 18);
    while ((line = strtok(NULL, "\n")) != NULL) {
        TEST_ASSERT_TRUE(count < 7);
        wide_line(&truth[count++], 65535, expected);
        TEST_ASSERT_EQUAL_STRING(expected, line);
    }
    TEST_ASSERT_EQUAL_INT(7, count);
    TEST_ASSERT_EQUAL_INT(0, run("decode - <md.bin 2>/dev/null | grep -c '^[0-9]'"));
    TEST_ASSERT_EQUAL_STRING("7\n", output);
    TEST_ASSERT_EQUAL_INT(0, run("decode md.bin 2>&1 >/dev/null"));
    TEST_ASSERT_NOT_NULL(strstr(output, "scans: 7\n"));
    TEST_ASSERT_NOT_NULL(strstr(output, "skipped packets: 2\n  SCIP2.0      1  from SCIP1.1 to SCIP2.0\n"
                                        "  SS           1  bit rate\n"));
}

void test_decode_long_has_one_line_a_point_with_its_angle(void)
{
    char *line;
    int count = 0;

    power_on(world, NULL);
    to_scip2();
    say("MS0300050004003\n", 1.0);
    write_stream("points.bin");
    TEST_ASSERT_EQUAL_INT(0, run("decode points.bin --long 2>/dev/null"));
    line = strtok(output, "\n");
    TEST_ASSERT_EQUAL_STRING("time,step,angle_deg,distance_mm", line);
    for (; (line = strtok(NULL, "\n")) != NULL; count++) {
        const truth_t *t = &truth[count / 51];
        double time_s, angle_deg;
        int step, mm;

        TEST_ASSERT_EQUAL_INT(4, sscanf(line, "%lf,%d,%lf,%d", &time_s, &step, &angle_deg, &mm));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, (double)t->stamp_ms / 1e3, time_s);
        TEST_ASSERT_EQUAL_INT(300 + 4 * (count % 51), step);
        TEST_ASSERT_DOUBLE_WITHIN(5.1e-4, (step - 384) * 360.0 / 1024.0, angle_deg);
        TEST_ASSERT_EQUAL_INT(cluster_as_sent(t, step, 4, 4095), mm);
    }
    TEST_ASSERT_EQUAL_INT(3 * 51, count);
}

/* Without its PP the steps alone tell that it is no URG-04LX. */
void test_a_scan_of_steps_0_to_1080_is_decoded_with_its_own_angles(void)
{
    static char data[3 * 1081], text[4000];
    char *line;
    int count = 0;

    for (unsigned i = 0; i < 1081; i++) {
        scip_frames_encode(&data[3 * i], 23 + 55 * i, 3);
    }
    stream_length = scip_frames_frame(text, "MD0000108001000", 25, data, sizeof data);
    memcpy(stream, text, stream_length);
    write_stream("far.bin");
    TEST_ASSERT_EQUAL_INT(0, run("decode far.bin 2>/dev/null | tail -n 1 | cut -d, -f1,2,1082"));
    TEST_ASSERT_EQUAL_STRING("0.025,23,59423\n", output);
    TEST_ASSERT_EQUAL_INT(0, run("decode far.bin --long 2>/dev/null"));
    line = strtok(output, "\n");
    for (; (line = strtok(NULL, "\n")) != NULL; count++) {
        char expected[60];

        sprintf(expected, "0.025,%d,%.3f,%d", count, (count - 540) * 0.25, 23 + 55 * count);
        TEST_ASSERT_EQUAL_STRING(expected, line);
    }
    TEST_ASSERT_EQUAL_INT(1081, count);
}

void test_scans_of_other_steps_share_the_columns_and_leave_cells_empty(void)
{
    power_on(world, NULL);
    to_scip2();
    say("MS0372037301001\n", 0.5);
    say("MS0373037401001\n", 0.5);
    write_stream("two.bin");
    TEST_ASSERT_EQUAL_INT(0, run("decode two.bin 2>/dev/null | head -n 1"));
    TEST_ASSERT_EQUAL_STRING("time,step_372,step_373,step_374\n", output);
    TEST_ASSERT_EQUAL_INT(0,
                          run("decode two.bin 2>/dev/null | grep -cE '^[0-9]+[.][0-9]{3},[0-9]+,[0-9]+,$'"));
    TEST_ASSERT_EQUAL_STRING("1\n", output);
    TEST_ASSERT_EQUAL_INT(0,
                          run("decode two.bin 2>/dev/null | grep -cE '^[0-9]+[.][0-9]{3},,[0-9]+,[0-9]+$'"));
    TEST_ASSERT_EQUAL_STRING("1\n", output);
}

/* One frame of three points: 19, 20, 4095. */
static const char three_points[] = "MS0383038501000\n99b\n00000\n0C0Doo5\n\n";

void test_cells_without_a_distance_stay_empty_where_that_is_asked_for(void)
{
    memcpy(stream, three_points, sizeof three_points - 1);
    stream_length = sizeof three_points - 1;
    write_stream("codes.bin");
    TEST_ASSERT_EQUAL_INT(0, run("decode codes.bin 2>/dev/null"));
    TEST_ASSERT_EQUAL_STRING("time,step_383,step_384,step_385\n0.000,19,20,4095\n", output);
    TEST_ASSERT_EQUAL_INT(0, run("decode codes.bin --no-codes 2>/dev/null"));
    TEST_ASSERT_EQUAL_STRING("time,step_383,step_384,step_385\n0.000,,20,\n", output);
    TEST_ASSERT_EQUAL_INT(0, run("decode codes.bin --no-codes --long 2>/dev/null"));
    TEST_ASSERT_EQUAL_STRING("time,step,angle_deg,distance_mm\n0.000,383,-0.352,\n0.000,384,0.000,20\n"
                             "0.000,385,0.352,\n",
                             output);
}

/* The stream as flexiport writes it: chunks of 1 to 40 octets behind heads of three numbers. */
static void as_flexiport_log(int width, int little)
{
    static unsigned char log[STREAM_MAX];
    size_t length = 0, at = 0;
    unsigned long us = 0;

    for (unsigned chunk = 1; at < stream_length; chunk = chunk % 40 + 1) {
        const size_t size = stream_length - at < chunk ? stream_length - at : chunk;
        const unsigned long numbers[3] = {us / 1000000, us % 1000000, size};

        for (int n = 0; n < 3; n++) {
            for (int i = 0; i < width; i++) {
                const int place = little ? i : width - 1 - i;

                log[length++] = (unsigned char)(place > 3 ? 0U : numbers[n] >> (8 * place) & 0xFFU);
            }
        }
        memcpy(log + length, stream + at, size);
        length += size;
        at += size;
        us += 1234;
        TEST_ASSERT_TRUE(length < STREAM_MAX - 100);
    }
    memcpy(stream, log, length);
    stream_length = length;
}

void test_decode_reads_both_forms_of_flexiport_logs(void)
{
    static char raw[sizeof output];

    for (int form = 0; form < 2; form++) {
        power_on(world, NULL);
        to_scip2();
        say("MD0044072501005\n", 1.5);
        write_stream("plain.bin");
        TEST_ASSERT_EQUAL_INT(0, run("decode plain.bin 2>&1"));
        strcpy(raw, output);
        as_flexiport_log(form == 0 ? 4 : 8, form);
        write_stream("log.logr");
        TEST_ASSERT_EQUAL_INT(0, run("decode log.logr 2>&1"));
        TEST_ASSERT_EQUAL_STRING(raw, output);
        stream_length -= 20; /* the recorder was killed within a chunk */
        write_stream("log.logr");
        TEST_ASSERT_EQUAL_INT(0, run("decode log.logr 2>/dev/null | grep -c '^[0-9]'"));
        TEST_ASSERT_EQUAL_STRING("4\n", output);
        urg04lx_destroy(urg);
        urg = NULL;
    }
}

void test_a_flexiport_log_that_is_broken_in_the_middle_is_refused(void)
{
    power_on(world, NULL);
    to_scip2();
    say("MD0000076801099\n", 10.5);
    as_flexiport_log(4, 0);
    TEST_ASSERT_TRUE(stream_length > 100000);
    memmove(stream + 90000, stream + 90001, stream_length - 90001);
    write_stream("broken.logr");
    TEST_ASSERT_EQUAL_INT(2, run("decode broken.logr 2>&1"));
    TEST_ASSERT_NOT_NULL(strstr(output, "broken.logr: a log of flexiport, broken in the middle"));
}

/* The answers of a UTM-30LX, shortened; the scan is one of intensities. */
void test_what_is_skipped_is_named_with_the_sensor_and_the_reason(void)
{
    static const char foreign[] =
        "PP\n00P\nMODL:UTM-30LX;Z\nARES:1440;?\nDMIN:23;1\n\nME0000108001000\n00P\n\n"
        "ME0000108001000\n99b\n00000\nabcd?\n\nME0000108001000\n99b\n00000\nabcd?\n\n"
        "MD0000108101000\n99b\n00000\nabcd?\n\n";

    memcpy(stream, foreign, sizeof foreign - 1);
    stream_length = sizeof foreign - 1;
    write_stream("foreign.bin");
    TEST_ASSERT_EQUAL_INT(1, run("decode foreign.bin 2>&1"));
    TEST_ASSERT_NOT_NULL(strstr(output, "sensor: UTM-30LX\n"));
    TEST_ASSERT_NOT_NULL(strstr(output, "skipped packets: 5\n  PP           1  its limits\n"));
    TEST_ASSERT_NOT_NULL(
        strstr(output, "  ME           3  distances with intensities, which are not read\n"));
    TEST_ASSERT_NOT_NULL(strstr(output, "  MD           1  of steps beyond 1080, or malformed\n"));
}

/* Typed in as measurements, see tests/fixtures/scip/README.md; one has an echo with cluster 00. */
void test_what_real_sensors_sent_decodes_to_what_was_measured(void)
{
    TEST_ASSERT_EQUAL_INT(0, run("decode '" FIXTURES "/scip/real_md_0384.bin' 2>/dev/null"));
    TEST_ASSERT_EQUAL_STRING("time,step_384\n6332.861,254\n", output);
    TEST_ASSERT_EQUAL_INT(
        0, run("decode '" FIXTURES "/scip/real_ms_0044_0725.bin' 2>/dev/null | tail -n 1 | cut -d, -f2- >got"
               " && cut -d, -f3- '" FIXTURES "/scip/real_ms_0044_0725.csv' | cmp - got 2>&1"));
    TEST_ASSERT_EQUAL_STRING("", output);
}

void test_decode_of_nothing_exits_1_and_of_an_unreadable_file_2(void)
{
    TEST_ASSERT_EQUAL_INT(1, run("decode - </dev/null 2>&1"));
    TEST_ASSERT_NOT_NULL(strstr(output, "scans: 0\n"));
    TEST_ASSERT_EQUAL_INT(2, run("decode no-such-file 2>&1"));
    TEST_ASSERT_NOT_NULL(strstr(output, "no-such-file"));
    TEST_ASSERT_EQUAL_INT(2, run("decode . 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("decode 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("decode a b 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("guess 2>&1"));
    TEST_ASSERT_EQUAL_INT(0, run("--help"));
    TEST_ASSERT_EQUAL_INT(0, run("decode --help"));
    TEST_ASSERT_EQUAL_INT(0, run("mirrors --help"));
    TEST_ASSERT_EQUAL_INT(0, run("record --help"));
}

/* ---- mirrors ---- */

static void record_scene(double height_m, const char *command, double seconds, const char *name)
{
    quadrotor_config_t config = quadrotor_default;
    quadrotor_t *quadrotor;
    scene_t scene;

    timeline_reset();
    config.anchored = true;
    config.bench_height_m = height_m;
    quadrotor = quadrotor_create(&config, NULL, NULL, 1);
    scene_init(&scene, &scene_default, quadrotor, 1);
    power_on(scene_scan, &scene);
    to_scip2();
    say(command, seconds);
    write_stream(name);
    urg04lx_destroy(urg);
    urg = NULL;
    quadrotor_destroy(quadrotor);
}

#define THREE "\n#LAYOUT THREE\n#S1 128\n#SF 389\n#S2 640\n#SW 17\n"

void test_the_three_mirrors_are_found_at_any_bench_height(void)
{
    static const double heights[] = {0.0, 0.4, 1.5, 3.0};
    static const char *const commands[] = {"MS0044072501000\n", "MD0000076801000\n"};

    for (size_t i = 0; i < 8; i++) {
        char arguments[128];

        record_scene(heights[i / 2], commands[i % 2], 5.0, "scene.bin");
        snprintf(arguments, sizeof arguments, "mirrors scene.bin --height %g 2>/dev/null", heights[i / 2]);
        TEST_ASSERT_EQUAL_INT(0, run(arguments));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, THREE), output);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "367..411"), output);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "106..150"), output);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "618..662"), output);
    }
}

void test_part_of_the_circle_shows_the_front_mirror_alone(void)
{
    record_scene(0.4, "MS0300048001000\n", 3.0, "front.bin");
    TEST_ASSERT_EQUAL_INT(0, run("mirrors front.bin --height 0.4 2>/dev/null"));
    TEST_ASSERT_NOT_NULL(strstr(output, "\n#LAYOUT FRONT\n#SF 389\n#SW 17\n"));
}

void test_the_side_mirrors_without_the_front_are_two_beams(void)
{
    record_scene(0.4, "MS0044030001030\n", 4.0, "aft.bin");
    TEST_ASSERT_EQUAL_INT(1, run("mirrors aft.bin --height 0.4 2>/dev/null"));
    TEST_ASSERT_NOT_NULL(strstr(output, "no LAYOUT"));
    record_scene(0.4, "MS0500072501030\n", 4.0, "fore.bin");
    TEST_ASSERT_EQUAL_INT(0, system("cd '" SCRATCH "' && cat aft.bin fore.bin >sides.bin"));
    TEST_ASSERT_EQUAL_INT(0, run("mirrors sides.bin --height 0.4 2>/dev/null"));
    TEST_ASSERT_NOT_NULL(strstr(output, "\n#LAYOUT TWO\n#S1 128\n#S2 640\n#SW 17\n"));
}

void test_a_wrong_height_finds_no_mirror(void)
{
    record_scene(0.4, "MS0044072501000\n", 3.0, "wrong.bin");
    TEST_ASSERT_EQUAL_INT(1, run("mirrors wrong.bin --height 0.5 2>/dev/null"));
    TEST_ASSERT_EQUAL_INT(1, run("mirrors wrong.bin --height 0.3 2>/dev/null"));
    TEST_ASSERT_EQUAL_INT(0, run("mirrors wrong.bin --height 0.5 --tolerance 150 2>/dev/null"));
    TEST_ASSERT_EQUAL_INT(1, run("mirrors wrong.bin --height 0.4 --tolerance 0 2>/dev/null"));
}

void test_few_scans_and_clusters_tell_nothing(void)
{
    record_scene(0.4, "MS0044072501009\n", 3.0, "few.bin");
    TEST_ASSERT_EQUAL_INT(1, run("mirrors few.bin --height 0.4 2>/dev/null"));
    record_scene(0.4, "MS0044072502000\n", 3.0, "cluster.bin");
    TEST_ASSERT_EQUAL_INT(1, run("mirrors cluster.bin --height 0.4 2>/dev/null"));
}

void test_mirrors_needs_a_source_and_a_height(void)
{
    TEST_ASSERT_EQUAL_INT(2, run("mirrors 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("mirrors md.bin 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("mirrors --height 0.4 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("mirrors md.bin --height 4 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("mirrors md.bin --height x 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("mirrors no-such-file --height 0.4 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("mirrors /dev/null --height 0.4 2>&1"));
}

void test_record_refuses_what_it_cannot_do(void)
{
    TEST_ASSERT_EQUAL_INT(2, run("record 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("record /dev/null 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("record /dev/null x.bin 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("record /dev/null x.bin --rate 38400 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("record /dev/null x.bin --steps 5 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("record /dev/null x.bin --steps 5..769 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("record /dev/null x.bin --steps 9..5 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("record /dev/null x.bin --seconds 0 2>&1"));
    TEST_ASSERT_EQUAL_INT(2, run("record /no/such/device x.bin 2>&1"));
}
