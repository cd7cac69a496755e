/* The sensors of the family, told apart by PP alone: each is asked, ordered by its own limits, and its scans
 * are read. The sensors are written here from their limits; docs/scip.md says which limits came from a
 * sensor. */
#include "unity.h"

#include <stdio.h>
#include <string.h>

#include "drivers/scip_layout.h"
#include "drivers/urg.h"
#include "tests/support/scip_frames.h"

#define POINTS_MAX 1081U
#define FRAMES 3U

typedef struct {
    const char *name;
    scip_limits_t limits;
} member_t;

static const member_t members[] = {
    {"URG-04LX", {20U, 5600U, 1024U, 44U, 725U, 384U, 600U}},
    {"UTM-30LX", {23U, 60000U, 1440U, 0U, 1080U, 540U, 2400U}},
    {"UST-10LX", {20U, 30000U, 1440U, 0U, 1080U, 540U, 2400U}},
    /* of nobody: a little of everything */
    {"narrow and near", {1U, 4094U, 512U, 1U, 2U, 1U, 1U}},
    {"all around", {1000U, 65535U, 1080U, 0U, 1080U, 540U, 65535U}},
};

static urg_driver_t urg;
static scip_info_t info;
static uint16_t points[2U * POINTS_MAX];
static char data[3U * POINTS_MAX], text[3500];
static urg_output_t output;
static uint32_t now_us;

void setUp(void)
{
    now_us = 0U;
}

void tearDown(void) {}

static bool feed(const char *octets)
{
    bool complete = false;

    for (; *octets != '\0'; octets++) {
        const octet_t octet = (octet_t)*octets;
        complete = urg_feed(&urg, &octet, 1U) || complete;
    }
    return complete;
}

/* The next command; an empty one when there is none. */
static const char *step(void)
{
    static char sent[SCIP_REQUEST_MAX + 1U];

    now_us += 150000UL;
    urg_step(&urg, now_us);
    (void)urg_next_to_send(&urg, &output);
    for (uint16_t i = 0U; i < output.count; i++) {
        sent[i] = (char)output.octets[i];
    }
    sent[output.count] = '\0';
    return sent[0] == '\n' ? &sent[1] : sent;
}

static void tell(const char *key, unsigned long value)
{
    char line[24], summed[28];

    (void)snprintf(line, sizeof line, "%s:%lu", key, value);
    (void)scip_frames_summed(summed, line, strlen(line));
    memmove(&summed[strlen(line) + 1U], &summed[strlen(line)], 3U);
    summed[strlen(line)] = ';';
    (void)feed(summed);
}

static void answer_parameters(const scip_limits_t *limits)
{
    (void)feed("PP\n00P\n");
    tell("DMIN", limits->dmin_mm);
    tell("DMAX", limits->dmax_mm);
    tell("ARES", limits->ares);
    tell("AMIN", limits->amin);
    tell("AMAX", limits->amax);
    tell("AFRT", limits->afrt);
    tell("SCAN", limits->scan_rpm);
    (void)feed("\n");
}

/* As one on USB or Ethernet: SCIP2.0 from the start, any rate. */
static void reach_stream(const scip_limits_t *limits)
{
    for (unsigned steps = 0U; steps < 20U; steps++) {
        const char *command = step();
        char echo[SCIP_REQUEST_MAX + 1U];

        if (command[0] == 'M') {
            (void)snprintf(text, sizeof text, "%s00P\n\n", command);
            (void)feed(text);
            return;
        }
        (void)strcpy(echo, command);
        if (strcmp(echo, "PP\n") == 0) {
            answer_parameters(limits);
        } else if (echo[0] != '\0') {
            (void)snprintf(text, sizeof text, "%s%s\n\n", echo, strcmp(echo, "L0\n") == 0 ? "0Ee" : "00P");
            (void)feed(text);
        }
    }
    TEST_FAIL_MESSAGE("no stream");
}

static urg_config_t whole(const scip_limits_t *limits)
{
    const urg_config_t config = {.first_rate = 115200UL,
                                 .stream_rate = 115200UL,
                                 .stream = limits->dmax_mm > SCIP_FAR_2_MM ? SCIP_STREAM_3 : SCIP_STREAM_2,
                                 .range = {limits->amin, limits->amax, 1U, 0U, 0U},
                                 .last_step = limits->amax};
    return config;
}

/* Nearest and farthest, one too near, one too far, and so on around. */
static unsigned long distance_of(const scip_limits_t *limits, unsigned step)
{
    const unsigned long rows[] = {limits->dmin_mm, limits->dmax_mm, limits->dmin_mm - 1UL,
                                  limits->dmax_mm + 1UL};

    return rows[step % 4U];
}

static void frame(const scip_limits_t *limits, unsigned width, unsigned long stamp_ms)
{
    char echo[24];
    const unsigned count = (unsigned)limits->amax - limits->amin + 1U;

    for (unsigned i = 0U; i < count; i++) {
        scip_frames_encode(&data[width * i], distance_of(limits, i), width);
    }
    (void)snprintf(echo, sizeof echo, "M%c%04u%04u01000", width == 3U ? 'D' : 'S', (unsigned)limits->amin,
                   (unsigned)limits->amax);
    (void)scip_frames_frame(text, echo, stamp_ms, data, (size_t)width * count);
}

static void assert_points(const scip_limits_t *limits, const scip_scan_t *scan)
{
    for (uint16_t i = 0U; i < scan->points; i++) {
        const unsigned long sent = distance_of(limits, i);
        TEST_ASSERT_EQUAL_UINT16(sent > 65535UL ? 65535UL : sent, scan->distance_mm[i]);
    }
}

static void assert_good_rays_are_those_within(const scip_limits_t *limits, const scip_scan_t *scan)
{
    const scip_group_t all = {limits->amin, limits->amax};
    unsigned good = 0U;

    for (uint16_t i = 0U; i < scan->points; i++) {
        const bool most = limits->dmax_mm == 65535U &&
                          i % 4U == 3U; /* saturated, it looks like the farthest */
        good += (i % 4U < 2U || most) ? 1U : 0U;
    }
    TEST_ASSERT_EQUAL_UINT16(good, scip_group_mean_within(scan, &all, limits).good_rays);
}

static void assert_scans(const member_t *member)
{
    const scip_limits_t *limits = &member->limits;
    const unsigned width = limits->dmax_mm > SCIP_FAR_2_MM ? 3U : 2U;
    scip_scan_t scan;

    for (unsigned long k = 1U; k <= FRAMES; k++) {
        frame(limits, width, 25UL * k);
        TEST_ASSERT_TRUE_MESSAGE(feed(text), member->name);
    }
    TEST_ASSERT_TRUE(urg_take_scan(&urg, &scan));
    TEST_ASSERT_EQUAL_UINT16(limits->amax - limits->amin + 1U, scan.points);
    assert_points(limits, &scan);
    assert_good_rays_are_those_within(limits, &scan);
}

void test_each_sensor_tells_its_limits_and_is_ordered_by_them(void)
{
    for (size_t i = 0U; i < sizeof members / sizeof members[0]; i++) {
        const urg_config_t unknown = whole(&scip_limits_urg04lx);
        scip_limits_t told;
        urg_config_t config;

        TEST_ASSERT_TRUE(urg_init(&urg, &unknown, points, 2U * POINTS_MAX, now_us));
        urg_ask(&urg, &info);
        reach_stream(&members[i].limits);
        TEST_ASSERT_TRUE_MESSAGE(urg_told(&urg), members[i].name);
        told = scip_info_limits(&info);
        TEST_ASSERT_EQUAL_UINT16(members[i].limits.dmax_mm, told.dmax_mm);
        TEST_ASSERT_EQUAL_UINT16(members[i].limits.ares, told.ares);
        TEST_ASSERT_EQUAL_UINT16(members[i].limits.afrt, told.afrt);
        TEST_ASSERT_EQUAL_UINT16(members[i].limits.scan_rpm, told.scan_rpm);
        config = whole(&told);
        TEST_ASSERT_EQUAL(URG_ACCEPTED, urg_refusal(&config, 2U * POINTS_MAX));
        TEST_ASSERT_TRUE(urg_init(&urg, &config, points, 2U * POINTS_MAX, now_us));
        reach_stream(&told);
        assert_scans(&members[i]);
    }
}

/* 30 degrees to the left, whatever a step is. */
void test_a_direction_is_another_step_on_each_sensor(void)
{
    TEST_ASSERT_EQUAL_UINT16(469U, scip_limits_step(&members[0].limits, 30000L));
    TEST_ASSERT_EQUAL_UINT16(660U, scip_limits_step(&members[1].limits, 30000L));
    TEST_ASSERT_EQUAL_INT32(-135000L, scip_limits_mdeg(&members[1].limits, 0U));
    TEST_ASSERT_EQUAL_INT32(135000L, scip_limits_mdeg(&members[2].limits, 1080U));
    TEST_ASSERT_EQUAL_INT32(-119531L, scip_limits_mdeg(&members[0].limits, 44U));
}

/* Its first codes are others than the URG-04LX's, and all below its DMIN: C-42-03320B, table 4. */
void test_no_error_code_of_a_utm_30lx_is_a_distance(void)
{
    uint16_t row[8] = {1U, 2U, 3U, 4U, 5U, 22U, 60001U, 23U};
    const scip_scan_t scan = {
        .distance_mm = row, .capacity = 8U, .points = 8U, .characters = 3U, .cluster = 1U};
    const scip_group_t all = {0U, 7U};

    TEST_ASSERT_EQUAL_UINT16(1U, scip_group_mean_within(&scan, &all, &scip_limits_utm30lx).good_rays);
}
