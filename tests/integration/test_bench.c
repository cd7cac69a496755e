/* The bench: the vehicle stands still at a known height, so every height that the firmware publishes can be
 * judged, whatever happens on the scanner's line. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "firmware/probe.h"
#include "unity.h"

#define NOISE_MM \
    25.0 /* 3 mm common to a scan and what the attitude's noise makes of it, seven deviations \
          */

void setUp(void) {}
void tearDown(void) {}

/* ---- the command line ---- */

static char output[200000];

static int run(const char *arguments)
{
    char line[1024];

    snprintf(line, sizeof line, "fly bench %s", arguments);
    return child_plomada(line, output, sizeof output);
}

static const char *last_line(void)
{
    const char *last = output;

    for (const char *p = output; (p = strchr(p, '\n')) != NULL && p[1] != '\0'; p++) {
        last = p + 1;
    }
    return last;
}

static int telemetry_lines(double height_m, double *worst_m)
{
    int with_height = 0;
    double height;

    *worst_m = 0.0;
    for (const char *p = output; p != NULL; p = strchr(p, '\n') == NULL ? NULL : strchr(p, '\n') + 1) {
        if (sscanf(p, "alt:%lf", &height) == 1) {
            with_height++;
            *worst_m = fmax(*worst_m, fabs(height - height_m));
        }
    }
    return with_height;
}

void test_the_telemetry_shows_the_height_and_the_answer_to_laser_comes_last(void)
{
    static const double heights[] = {0.0, 0.4, 1.5, 3.2};

    for (size_t i = 0; i < sizeof heights / sizeof heights[0]; i++) {
        char arguments[64];
        double worst_m;

        snprintf(arguments, sizeof arguments, "--height %g --seed %zu", heights[i], i + 1);
        TEST_ASSERT_EQUAL_INT(0, run(arguments));
        TEST_ASSERT_INT_WITHIN(15, 90, telemetry_lines(heights[i], &worst_m));
        TEST_ASSERT_TRUE_MESSAGE(worst_m < NOISE_MM * 1e-3, last_line());
        TEST_ASSERT_EQUAL_STRING_LEN("OK LASER ", last_line(), 9);
        TEST_ASSERT_NOT_NULL(strstr(output, "\nOK LASER state:OK"));
        TEST_ASSERT_NULL(strchr(output, '\r'));
        TEST_ASSERT_NULL(strstr(output, "MET"));
    }
}

void test_the_duration_ends_it_in_virtual_seconds(void)
{
    double worst_m;

    TEST_ASSERT_EQUAL_INT(0, run("--duration 3"));
    TEST_ASSERT_EQUAL_INT(0, telemetry_lines(0.0, &worst_m));
    TEST_ASSERT_NOT_NULL(strstr(output, "laser:WAIT"));
    TEST_ASSERT_EQUAL_STRING_LEN("OK LASER ", last_line(), 9);
    TEST_ASSERT_EQUAL_INT(0, run("--duration 60"));
    TEST_ASSERT_INT_WITHIN(15, 240, telemetry_lines(0.0, &worst_m));
}

void test_settings_are_typed_and_the_vehicle_still_stands(void)
{
    double worst_m;

    TEST_ASSERT_EQUAL_INT(0,
                          run("--height 0.4 --set SETR=0.6 --set KP=0.02 --csv bench.csv --json bench.json"));
    TEST_ASSERT_NOT_NULL(strstr(output, "OK SETR 0.6"));
    TEST_ASSERT_NOT_NULL(strstr(output, "OK KP 0.02"));
    TEST_ASSERT_NOT_NULL(strstr(output, "ref:0.600"));
    TEST_ASSERT_TRUE(telemetry_lines(0.4, &worst_m) > 70);
    TEST_ASSERT_TRUE(worst_m < NOISE_MM * 1e-3);
}

void test_the_same_seed_gives_the_same_lines(void)
{
    static char first[sizeof output];

    TEST_ASSERT_EQUAL_INT(0, run("--height 0.4 --seed 5"));
    strcpy(first, output);
    TEST_ASSERT_EQUAL_INT(0, run("--height 0.4 --seed 5"));
    TEST_ASSERT_EQUAL_INT(0, strcmp(first, output));
    TEST_ASSERT_EQUAL_INT(0, run("--height 0.4 --seed 6"));
    TEST_ASSERT_NOT_EQUAL(0, strcmp(first, output));
}

void test_what_does_not_go_together_is_refused(void)
{
    TEST_ASSERT_EQUAL_INT(2, run("--height -0.1"));
    TEST_ASSERT_EQUAL_INT(2, run("--height 5.1"));
    TEST_ASSERT_EQUAL_INT(2, run("--height high"));
    TEST_ASSERT_EQUAL_INT(2, run("--height"));
    TEST_ASSERT_EQUAL_INT(2, run("--duration 0"));
    TEST_ASSERT_EQUAL_INT(2, run("--laser /no/such/device --duration 1 2>&1"));
    TEST_ASSERT_NOT_NULL(strstr(output, "--laser /no/such/device: No such file"));
    TEST_ASSERT_EQUAL_INT(2, run("--imu /dev/null --duration 1 2>&1"));
    TEST_ASSERT_NOT_NULL(strstr(output, "--imu /dev/null: not a serial port"));
}

/* ---- faults on the scanner's line ---- */

typedef struct {
    const char *faults[4];
    double height_m, until_s;
} trial_t;

typedef struct {
    double worst_mm;
    unsigned heights;      /* published */
    unsigned late_heights; /* of these in the last two seconds */
    unsigned strikes;
    bool ok; /* in the end */
    const char *halt;
} verdict_t;

static void judge_heights(verdict_t *v, const trial_t *trial)
{
    static uint32_t sequence;

    if (probe_altitude->sequence != sequence) {
        const double height_mm = (double)probe_altitude->altitude.height_mm;

        v->heights += probe_altitude->sequence - sequence;
        sequence = probe_altitude->sequence;
        v->worst_mm = fmax(v->worst_mm, fabs(height_mm - 1000.0 * trial->height_m));
        v->late_heights += (double)timeline_now() * 1e-9 > trial->until_s - 2.0;
    }
}

static void stand(void *argument, void *result)
{
    static line_fault_spec_t specs[4];
    const trial_t *trial = argument;
    board_config_t config = board_config(11);
    verdict_t *v = result;

    for (int i = 0; i < 4 && trial->faults[i] != NULL; i++) {
        if (line_fault_parse(&specs[i], trial->faults[i]) != NULL) {
            return;
        }
        config.laser_fault_count = i + 1;
    }
    config.laser_faults = specs;
    config.quadrotor.anchored = true;
    config.quadrotor.bench_height_m = trial->height_m;
    board_power_on(&config, NULL, NULL);
    while ((double)timeline_now() * 1e-9 < trial->until_s && kernel_run_until(timeline_now() + SIM_MS)) {
        judge_heights(v, trial);
    }
    for (int i = 0; i < LINE_FAULT_KIND_COUNT; i++) {
        v->strikes += line_fault_strikes(board_laser_faults(), (line_fault_kind_t)i);
    }
    v->ok = probe_laser->status == URG_OK;
    v->halt = kernel_halt_reason();
}

/* Every height that was published is right, and at the end heights come as ever. */
static verdict_t survives(const trial_t *trial)
{
    verdict_t v = {0};
    char message[160];

    child_run(stand, (void *)(uintptr_t)trial, &v, sizeof v);
    snprintf(message, sizeof message, "%s: worst %.1f mm, %u heights, %u late, %u strikes", trial->faults[0],
             v.worst_mm, v.heights, v.late_heights, v.strikes);
    TEST_ASSERT_NULL_MESSAGE(v.halt, message);
    TEST_ASSERT_TRUE_MESSAGE(v.strikes > 0, message);
    TEST_ASSERT_TRUE_MESSAGE(v.worst_mm < NOISE_MM, message);
    TEST_ASSERT_TRUE_MESSAGE(v.ok, message);
    TEST_ASSERT_TRUE_MESSAGE(v.late_heights >= 13, message);
    return v;
}

static void survives_each(const char *kind, const char *argument, const unsigned *positions, size_t count,
                          double until_s)
{
    for (size_t i = 0; i < count; i++) {
        char text[48];
        trial_t trial = {{text}, 0.7, until_s};

        snprintf(text, sizeof text, "%s@%u%s", kind, positions[i], argument);
        survives(&trial);
    }
}

/* Start-up takes 60 octets: L0 6, SCIP2.0 11, SS 14, QT 8, MS 21; then come frames of 309. */
static const unsigned positions[] = {0,  1,  5,  7,  16, 20, 30,  31,  38,  39,   50,
                                     59, 60, 76, 79, 85, 90, 150, 368, 369, 1000, 5003};
#define POSITIONS (sizeof positions / sizeof positions[0])

void test_one_octet_lost_anywhere_costs_no_wrong_height(void)
{
    survives_each("drop", "", positions, POSITIONS, 25.0);
}

void test_one_octet_twice_anywhere_costs_no_wrong_height(void)
{
    survives_each("dup", "", positions, POSITIONS, 25.0);
}

void test_one_flipped_bit_anywhere_costs_no_wrong_height(void)
{
    survives_each("flip", "", positions, POSITIONS, 25.0);
}

void test_one_stray_octet_anywhere_costs_no_wrong_height(void)
{
    survives_each("stray", "", positions, POSITIONS, 25.0);
}

void test_a_sensor_that_restarts_anywhere_comes_back_without_help(void)
{
    survives_each("restart", "", positions, POSITIONS, 60.0);
}

void test_a_mute_sensor_comes_back_without_help(void)
{
    survives_each("mute", ":50", positions, POSITIONS, 30.0);
    survives_each("mute", ":700", positions, POSITIONS, 35.0);
    survives_each("mute", ":9000", &positions[POSITIONS - 2], 2, 45.0);
}

void test_delays_cost_no_wrong_height(void)
{
    survives_each("delay", ":30", positions, POSITIONS, 30.0);
    survives_each("delay", ":900", positions, POSITIONS, 35.0);
}

void test_hardware_trouble_is_overcome(void)
{
    survives_each("status", ":50", &positions[13], 9, 35.0);
    survives_each("status", ":21", &positions[13], 9, 35.0);
    survives_each("status", ":98", &positions[13], 9, 35.0);
}

void test_a_noisy_line_costs_frames_but_no_wrong_height(void)
{
    static const trial_t trials[] = {
        {{"flip:1e-3"}, 0.7, 60.0},
        {{"drop:1e-3"}, 0.7, 60.0},
        {{"dup:1e-3"}, 0.7, 60.0},
        {{"stray:1e-3"}, 0.7, 60.0},
        {{"flip:1e-4", "drop:1e-4", "dup:1e-4", "stray:1e-4"}, 2.0, 120.0},
    };

    for (size_t i = 0; i < sizeof trials / sizeof trials[0]; i++) {
        const verdict_t v = survives(&trials[i]);
        const unsigned frames = (unsigned)lround((trials[i].until_s - 11.0) * 10.0);

        TEST_ASSERT_LESS_THAN_UINT(frames, v.heights);
        TEST_ASSERT_GREATER_THAN_UINT(frames - v.strikes, v.heights);
    }
}

void test_one_lost_octet_costs_one_height(void)
{
    static const trial_t clean = {{"drop:0", "delay@4000:1"}, 0.7, 25.0}, hit = {{"drop@4000"}, 0.7, 25.0};
    const verdict_t all = survives(&clean);

    TEST_ASSERT_EQUAL_UINT(all.heights - 1, survives(&hit).heights);
}
