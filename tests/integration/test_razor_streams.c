/* The Razor's octets from the files of tests/fixtures/razor, on the running firmware's IMU line: what becomes
 * of them there. Heights and angles are computed here anew, in double. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "firmware/probe.h"
#include "unity.h"

#define DEG (M_PI / 180.0)
#define FRAME_S 0.020 /* stock */
#define STARTED_S 13.0
#define HEIGHT_M 0.5
#define LINES_MAX 220
#define OFFSET_LINES 20
#define HOLD_LINES 80 /* at the end of stock_hold.txt the tilt stays */

void setUp(void) {}
void tearDown(void) {}

typedef struct {
    const char *file;
    size_t length;
    char octets[16384];
} stream_t;

typedef struct {
    imu_sample_t imu;
    flight_outputs_t flight;
    double height_mm;
    unsigned heights;
} seen_t;

static stream_t stream;

static void load(const char *file)
{
    char path[256];
    FILE *in;

    (void)snprintf(path, sizeof path, "%s/razor/%s", FIXTURES, file);
    in = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(in, path);
    memset(&stream, 0, sizeof stream);
    stream.file = file;
    stream.length = fread(stream.octets, 1, sizeof stream.octets, in);
    (void)fclose(in);
    TEST_ASSERT_TRUE(stream.length > 0 && stream.length < sizeof stream.octets);
}

static void look(seen_t *seen, uint32_t *sequence, bool count)
{
    if (count && probe_altitude->scan_valid && probe_altitude->sequence != *sequence) {
        seen->height_mm += (double)probe_altitude->altitude.height_mm;
        seen->heights++;
    }
    *sequence = probe_altitude->sequence;
}

/* A line every 20 ms, at the wire's own rate; heights of the last second count. */
static void play(void *argument, void *result)
{
    const stream_t *s = argument;
    seen_t *seen = result;
    board_config_t config = board_config(4);
    const char *next = s->octets, *end = s->octets + s->length;
    uint32_t sequence = 0U;

    config.quadrotor.anchored = true;
    config.quadrotor.bench_height_m = HEIGHT_M;
    board_power_on(&config, NULL, NULL);
    board_connect(BOARD_IMU, NULL, NULL);
    kernel_run_until(500 * SIM_MS);
    board_type("#LAYOUT FRONT\n", strlen("#LAYOUT FRONT\n")); /* the height of one mirror has a formula */
    kernel_run_until((sim_time_t)(STARTED_S * 1e9));
    while (next < end) {
        const char *lf = memchr(next, '\n', (size_t)(end - next));
        const size_t count = lf != NULL ? (size_t)(lf - next) + 1U : (size_t)(end - next);

        board_receive(BOARD_IMU, next, count);
        next += count;
        kernel_run_until(timeline_now() + (sim_time_t)(FRAME_S * 1e9));
        look(seen, &sequence, end - next < 25 * 50);
    }
    kernel_run_until(timeline_now() + 20 * SIM_MS);
    seen->imu = *probe_imu;
    seen->flight = *probe_flight;
    seen->height_mm /= seen->heights > 0 ? seen->heights : 1;
    if (kernel_halt_reason() != NULL) {
        abort();
    }
}

static seen_t played(const char *file)
{
    seen_t seen = {0};

    load(file);
    child_run(play, &stream, &seen, sizeof seen);
    return seen;
}

typedef struct {
    double roll_deg, pitch_deg;
} tilt_t;

/* Mean of lines `from` up to `to` of the file that was loaded last, the IMU's own angles. */
static tilt_t mean_of(int from, int to)
{
    tilt_t sum = {0.0, 0.0};
    const char *line = stream.octets;

    for (int i = 0; i < to; i++, line = strchr(line, '\n') + 1) {
        double yaw, pitch, roll;
        TEST_ASSERT_EQUAL_INT(3, sscanf(line, "#YPR=%lf,%lf,%lf", &yaw, &pitch, &roll));
        sum.roll_deg += i >= from ? roll / (to - from) : 0.0;
        sum.pitch_deg += i >= from ? pitch / (to - from) : 0.0;
    }
    return sum;
}

void test_a_stock_razors_text_becomes_the_vehicles_tilt_and_height(void)
{
    const seen_t seen = played("stock_hold.txt");
    const tilt_t zero = mean_of(0, OFFSET_LINES), held = mean_of(200 - HOLD_LINES, 200);
    const double roll = -(held.roll_deg - zero.roll_deg) * DEG,
                 pitch = (held.pitch_deg - zero.pitch_deg) * DEG;
    /* level, the scanner sees d + h + l; tilted by the text alone, eq. 29 makes this of it */
    const double height_mm = (1000.0 * HEIGHT_M + 100.0) * cos(pitch) * cos(roll) - 220.0 * sin(roll) - 100.0;

    TEST_ASSERT_EQUAL_UINT32(200, seen.imu.sequence);
    TEST_ASSERT_EQUAL_UINT32(0, seen.imu.malformed);
    TEST_ASSERT_TRUE(seen.imu.ready);
    TEST_ASSERT_FALSE(seen.imu.has_acceleration);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 11.9F, (float)(roll / DEG));
    TEST_ASSERT_FLOAT_WITHIN(0.1F, (float)(roll / DEG), seen.imu.median.roll_rad * (float)(1.0 / DEG));
    TEST_ASSERT_FLOAT_WITHIN(0.1F, (float)(pitch / DEG), seen.imu.median.pitch_rad * (float)(1.0 / DEG));
    TEST_ASSERT_UINT_WITHIN(3, 8, seen.heights);
    TEST_ASSERT_FLOAT_WITHIN(4.0F, (float)height_mm, (float)seen.height_mm);
}

/* The counts of the table in tests/fixtures/razor/README.md. */
void test_every_file_gives_the_firmware_the_frames_that_its_certificate_tells(void)
{
    static const struct {
        const char *file;
        uint32_t frames, malformed;
    } rows[] = {{"separate_lines.txt", 20, 0}, {"joined.txt", 20, 0},     {"ypr_only.txt", 20, 0},
                {"boot_banner.txt", 3, 0},     {"other_lines.txt", 5, 0}, {"half_lines.txt", 6, 2},
                {"nul_octets.txt", 3, 3},      {"nan_lines.txt", 6, 8}};

    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const seen_t seen = played(rows[i].file);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(rows[i].frames, seen.imu.sequence, rows[i].file);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(rows[i].malformed, seen.imu.malformed, rows[i].file);
    }
}

void test_lines_of_other_firmwares_are_no_frames_and_the_flag_says_so(void)
{
    const seen_t seen = played("foreign_lines.txt");

    TEST_ASSERT_EQUAL_UINT32(0, seen.imu.sequence);
    TEST_ASSERT_NOT_EQUAL(0, seen.flight.flags & FLIGHT_FLAG_ATTITUDE);
    TEST_ASSERT_FALSE(seen.imu.ready);
}
