#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sim/devices/razor9dof.h"
#include "unity.h"

#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)
#define DEG (M_PI / 180.0)
#define G 9.80665
#define OCTET_NS 173611 /* 10 bits at 57600 */

static razor9dof_t *razor;
static razor_config_t exact; /* nothing random */
static razor_truth_t truth;
static unsigned samples;
static sim_time_t sampled_at;

static char text[256]; /* the frame that arrives */
static size_t length;
static sim_time_t first_octet_at;
static unsigned frames, octets;

typedef struct {
    double x, y, z, yaw, pitch, roll;
} decoded_t;
static decoded_t decoded;
static void (*on_frame)(void);

static razor_truth_t world(void *context)
{
    TEST_ASSERT_EQUAL_PTR(&truth, context);
    samples++;
    sampled_at = timeline_now();
    return truth;
}

static bool frame_ends(void)
{
    return length > 2 && text[length - 1] == '\n' && strstr(text, "#YPR=") != NULL;
}

static void sink(void *context, unsigned octet, double bit_ns)
{
    TEST_ASSERT_EQUAL_PTR(&octets, context);
    NEAR(0.1, 1e9 / 57600.0, bit_ns);
    octets++;
    if (length == 0) {
        first_octet_at = timeline_now();
    }
    TEST_ASSERT_TRUE(length + 1 < sizeof text);
    text[length++] = (char)octet;
    text[length] = '\0';
    if (!frame_ends()) {
        return;
    }
    int end = 0;
    if (exact.stock > 0.5) {
        TEST_ASSERT_NULL(strstr(text, "#A-C="));
        frames++;
        on_frame();
        length = 0;
        return;
    }
    const char *form = exact.joined ? "#A-C=%lf,%lf,%lf#YPR=%lf,%lf,%lf%n"
                                    : "#A-C=%lf,%lf,%lf\r\n#YPR=%lf,%lf,%lf%n";
    TEST_ASSERT_EQUAL_INT_MESSAGE(6,
                                  sscanf(text, form, &decoded.x, &decoded.y, &decoded.z, &decoded.yaw,
                                         &decoded.pitch, &decoded.roll, &end),
                                  text);
    TEST_ASSERT_EQUAL_STRING("\r\n", text + end);
    decoded.roll = -decoded.roll; /* to the vehicle's signs, in which the tests think */
    decoded.y = -decoded.y;
    frames++;
    if (on_frame != NULL) {
        on_frame();
    }
    length = 0;
}

void setUp(void)
{
    timeline_reset();
    razor = NULL;
    exact = razor_default;
    exact.angle_noise_rad = 0.0;
    exact.spike_probability = 0.0;
    exact.acceleration_noise_mps2 = 0.0;
    exact.acceleration_bias_mps2 = 0.0;
    truth = (razor_truth_t){0.0, 0.0, 0.0, 0.0, 0.0};
    samples = frames = octets = 0;
    length = 0;
    on_frame = NULL;
}

void tearDown(void)
{
    if (razor != NULL) {
        razor9dof_destroy(razor);
    }
}

static void start(unsigned long seed)
{
    razor = razor9dof_create(&exact, world, &truth, seed, sink, &octets);
    razor9dof_power(razor, true);
}

static void run_until(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

static void run_frames(unsigned count)
{
    const unsigned goal = frames + count;
    while (frames < goal) {
        run_until(timeline_next());
    }
}

/* Arrived text of one frame, kept before the collector forgets it. */
static char kept[256];

static void keep_text(void)
{
    memcpy(kept, text, length + 1);
}

static void expect_text(const char *expected)
{
    on_frame = keep_text;
    start(1);
    run_frames(1);
    TEST_ASSERT_EQUAL_STRING(expected, kept);
}

void test_defaults_are_the_plant_of_the_study(void)
{
    const razor_config_t *d = &razor_default;
    TEST_ASSERT_EQUAL_INT64(25 * SIM_MS, d->period);
    TEST_ASSERT_EQUAL_INT64(15 * SIM_MS, d->age);
    NEAR(1e-9, 0.25 * DEG, d->angle_noise_rad);
    NEAR(1e-12, 0.005, d->spike_probability);
    NEAR(1e-12, 0.35, d->spike_rad);
    NEAR(1e-12, 0.4, d->acceleration_noise_mps2);
    NEAR(1e-12, 0.15, d->acceleration_bias_mps2);
    NEAR(1e-12, 0.0, d->mount_roll_rad);
    NEAR(1e-12, 0.0, d->mount_pitch_rad);
    TEST_ASSERT_FALSE(d->joined);
}

void test_level_and_at_rest_it_prints_one_g_down(void)
{
    expect_text("#A-C=0.00,0.00,256.00\r\n#YPR=0.00,0.00,0.00\r\n");
}

/* The vehicle's right side raised by 60 deg is the Razor's roll of -60: 256 (-sin p, cos p sin r, cos p cos
 * r) for p = 30, r = -60 deg: -128, -192, 110.851. */
void test_a_tilted_sensor_prints_the_turned_gravity(void)
{
    truth = (razor_truth_t){.roll_rad = 60.0 * DEG, .pitch_rad = 30.0 * DEG, .yaw_rad = -120.5 * DEG};
    expect_text("#A-C=-128.00,-192.00,110.85\r\n#YPR=-120.50,30.00,-60.00\r\n");
}

void test_nose_down_and_left_the_signs_turn(void)
{
    truth = (razor_truth_t){.roll_rad = -60.0 * DEG, .pitch_rad = -30.0 * DEG};
    expect_text("#A-C=128.00,192.00,110.85\r\n#YPR=0.00,-30.00,60.00\r\n");
}

/* One g upwards doubles everything felt. */
void test_climbing_faster_adds_weight_along_all_axes(void)
{
    truth = (razor_truth_t){.roll_rad = 60.0 * DEG, .pitch_rad = 30.0 * DEG, .up_mps2 = G};
    expect_text("#A-C=-256.00,-384.00,221.70\r\n#YPR=0.00,30.00,-60.00\r\n");
}

void test_in_free_fall_it_feels_nothing(void)
{
    truth = (razor_truth_t){.roll_rad = 0.5, .pitch_rad = 0.5, .up_mps2 = -G};
    start(1);
    run_frames(1);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, decoded.x);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, decoded.y);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, decoded.z);
}

void test_both_parts_may_share_one_line(void)
{
    exact.joined = true;
    truth.yaw_rad = 10.0 * DEG;
    expect_text("#A-C=0.00,0.00,256.00#YPR=10.00,0.00,0.00\r\n");
}

/* Arduino adds half a hundredth to the magnitude and cuts, so a small negative number is -0.00. */
void test_angles_are_printed_with_two_decimals_within_half_a_turn(void)
{
    static const struct {
        double yaw_deg;
        const char *printed;
    } vector[] = {
        {-0.001, "-0.00"},  {0.001, "0.00"},     {0.0051, "0.01"},   {-0.0051, "-0.01"},
        {0.994, "0.99"},    {0.996, "1.00"},     {9.996, "10.00"},   {-179.244, "-179.24"},
        {100.05, "100.05"}, {179.999, "180.00"}, {190.0, "-170.00"}, {-190.25, "169.75"},
    };
    on_frame = keep_text;
    start(1);
    for (size_t k = 0; k < sizeof vector / sizeof vector[0]; k++) {
        char line[64];
        truth.yaw_rad = vector[k].yaw_deg * DEG;
        run_frames(2); /* the first was sampled before */
        snprintf(line, sizeof line, "#A-C=0.00,0.00,256.00\r\n#YPR=%s,0.00,0.00\r\n", vector[k].printed);
        TEST_ASSERT_EQUAL_STRING(line, kept);
    }
}

void test_a_frame_leaves_every_period_and_is_fifteen_milliseconds_old(void)
{
    exact.phase = 40 * SIM_MS;
    timeline_move_to(7 * SIM_MS);
    start(1);
    for (int k = 0; k < 50; k++) {
        const sim_time_t phase = (7 + 40 + 25 * k) * SIM_MS;
        run_until(phase - 1);
        TEST_ASSERT_EQUAL_INT64(phase - 15 * SIM_MS, sampled_at);
        TEST_ASSERT_EQUAL_UINT((unsigned)k + 1, samples);
        TEST_ASSERT_EQUAL_UINT((unsigned)k, frames);
        TEST_ASSERT_EQUAL_UINT(0, length);
        run_until(phase + OCTET_NS + 1);
        TEST_ASSERT_EQUAL_UINT(1, length);
        TEST_ASSERT_INT64_WITHIN(1, phase + OCTET_NS, first_octet_at);
    }
}

/* 44 octets of the level frame. */
void test_octets_follow_each_other_at_the_line_rate(void)
{
    start(1);
    run_until(25 * SIM_MS + 43 * OCTET_NS + 1000);
    TEST_ASSERT_EQUAL_UINT(0, frames);
    TEST_ASSERT_EQUAL_UINT(43, length);
    run_until(25 * SIM_MS + 44 * OCTET_NS + 1000);
    TEST_ASSERT_EQUAL_UINT(1, frames);
}

void test_the_content_is_that_of_the_sampling_instant(void)
{
    exact.phase = 25 * SIM_MS;
    start(1);
    run_until(10 * SIM_MS - 1);
    truth.roll_rad = 5.0 * DEG;
    run_until(10 * SIM_MS);
    truth.roll_rad = 7.0 * DEG;
    run_frames(1);
    NEAR(0.005, 5.0, decoded.roll);
    run_frames(1);
    NEAR(0.005, 7.0, decoded.roll);
}

void test_a_first_frame_whose_content_would_precede_power_is_left_out(void)
{
    exact.phase = 14 * SIM_MS;
    start(1);
    run_until(38 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(0, octets);
    TEST_ASSERT_EQUAL_INT64(24 * SIM_MS, sampled_at);
    run_until(39 * SIM_MS + OCTET_NS + 1);
    TEST_ASSERT_EQUAL_UINT(1, octets);
}

void test_content_may_be_older_than_a_period(void)
{
    exact.age = 60 * SIM_MS;
    exact.phase = 60 * SIM_MS;
    start(1);
    for (int k = 0; k < 40; k++) {
        truth.roll_rad = k * DEG;
        run_until(k * 25 * SIM_MS);
        if (frames > 0) {
            const sim_time_t departed = ((first_octet_at - OCTET_NS + 500) / 1000) * 1000;
            NEAR(0.006, (double)(departed - 60 * SIM_MS) / 25e6, decoded.roll);
        }
    }
    TEST_ASSERT_EQUAL_UINT(37, frames);
}

void test_without_power_it_is_silent(void)
{
    razor = razor9dof_create(&exact, world, &truth, 1, sink, &octets);
    run_until(1 * SIM_S);
    TEST_ASSERT_EQUAL_UINT(0, octets);
    TEST_ASSERT_EQUAL_UINT(0, samples);
    razor9dof_power(razor, true);
    run_until(2 * SIM_S);
    TEST_ASSERT_UINT_WITHIN(1, 40, frames);
}

/* Every millisecond of a period: sampling, waiting and sending are all cut short. */
void test_a_power_cut_silences_at_once_and_power_starts_afresh(void)
{
    for (int ms = 0; ms < 50; ms++) {
        timeline_reset();
        length = 0;
        start(1);
        run_until(ms * SIM_MS + 100 * SIM_US);
        razor9dof_power(razor, false);
        const unsigned before = octets, before_samples = samples;
        run_until(400 * SIM_MS);
        TEST_ASSERT_EQUAL_UINT(before, octets);
        TEST_ASSERT_EQUAL_UINT(before_samples, samples);
        TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
        length = 0;
        razor9dof_power(razor, true);
        run_until(425 * SIM_MS + OCTET_NS + 1);
        TEST_ASSERT_EQUAL_UINT(before + 1, octets);
        TEST_ASSERT_EQUAL_UINT('#', (unsigned)text[0]);
        razor9dof_destroy(razor);
        razor = NULL;
    }
}

void test_power_on_twice_is_power_on_once(void)
{
    start(1);
    run_until(20 * SIM_MS);
    razor9dof_power(razor, true);
    run_until(1 * SIM_S);
    TEST_ASSERT_UINT_WITHIN(1, 39, frames);
}

void test_a_destroyed_sensor_leaves_nothing_behind(void)
{
    start(1);
    run_until(26 * SIM_MS);
    razor9dof_destroy(razor);
    razor = NULL;
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
}

void test_a_crooked_mount_shows_in_the_angles_and_in_the_felt_gravity(void)
{
    exact.mount_roll_rad = 3.0 * DEG;
    exact.mount_pitch_rad = -2.0 * DEG;
    start(1);
    run_frames(1);
    NEAR(0.006, 3.0, decoded.roll);
    NEAR(0.006, -2.0, decoded.pitch);
    NEAR(0.006, 0.0, decoded.yaw);
    NEAR(0.006, 256.0 * 0.0348995, decoded.x);
    NEAR(0.006, 256.0 * 0.9993908 * 0.0523360, decoded.y);
    NEAR(0.006, 256.0 * 0.9993908 * 0.9986295, decoded.z);
}

/* What P. Bartz' firmware prints as it comes. */
void test_a_stock_one_prints_angles_alone(void)
{
    exact.stock = 1.0;
    truth = (razor_truth_t){.roll_rad = 60.0 * DEG, .pitch_rad = 30.0 * DEG};
    expect_text("#YPR=0.00,30.00,-60.00\r\n");
}

/* ---- what goes wrong ---- */

/* 1 g of 256 counts told in g; upside down. */
void test_another_unit_and_the_other_sign_are_on_all_axes(void)
{
    truth = (razor_truth_t){.roll_rad = 60.0 * DEG, .pitch_rad = 30.0 * DEG};
    exact.acceleration_scale = 1.0 / 64.0;
    exact.acceleration_sign = -1.0;
    expect_text("#A-C=2.00,3.00,-1.73\r\n#YPR=0.00,30.00,-60.00\r\n");
}

void test_a_bias_jumps_at_its_time(void)
{
    exact.acceleration_jump_mps2 = -G / 2.0;
    exact.acceleration_jump_start_s = 2.0;
    truth.t_s = 1.999;
    start(1);
    run_frames(2);
    NEAR(0.006, 256.0, decoded.z);
    truth.t_s = 2.0;
    run_frames(2);
    NEAR(0.006, 128.0, decoded.z);
}

void test_errors_change_while_it_sends_and_its_period_and_kind_do_not(void)
{
    razor_config_t wrong = exact;

    start(1);
    run_frames(2);
    NEAR(0.006, 256.0, decoded.z);
    wrong.acceleration_bias_mps2 = -G / 2.0;
    wrong.period = 2 * exact.period;
    wrong.stock = 1.0;
    razor9dof_change(razor, &wrong);
    run_frames(2);
    NEAR(0.006, 128.0, decoded.z);
    const sim_time_t at = sampled_at;
    run_frames(1);
    TEST_ASSERT_EQUAL_INT64(exact.period, sampled_at - at);
}

void test_an_aliased_vibration_oscillates_with_its_amplitude(void)
{
    exact.acceleration_alias_mps2 = G / 4.0;
    exact.acceleration_alias_hz = 0.5;
    start(1);
    for (int k = 0; k < 8; k++) {
        static const double sine[] = {0.0, 0.70711, 1.0, 0.70711, 0.0, -0.70711, -1.0, -0.70711};

        truth.t_s = 12.0 + k * 0.25;
        run_frames(2);
        NEAR(0.01, 256.0 + 64.0 * sine[k], decoded.z);
    }
}

void test_a_burst_of_bad_attitudes_is_in_the_roll_alone_and_ends(void)
{
    exact.attitude_burst_rad = 60.0 * DEG;
    exact.attitude_burst = (span_t){5.0, 0.075};
    truth.roll_rad = 2.0 * DEG;
    truth.t_s = 5.05;
    start(1);
    run_frames(1);
    NEAR(0.006, 62.0, decoded.roll);
    NEAR(0.006, 0.0, decoded.pitch);
    NEAR(0.006, 256.0 * sin(2.0 * DEG), decoded.y);
    truth.t_s = 5.08;
    run_frames(2);
    NEAR(0.006, 2.0, decoded.roll);
}

TEST_CASE(90.0, 0.0, 60.0)
TEST_CASE(-90.0, 0.0, -60.0)
TEST_CASE(30.0, 51.96, 30.0)
void test_a_burst_of_bad_attitudes_leans_to_the_side_that_is_asked_for(double turned_deg, double roll_deg,
                                                                       double pitch_deg)
{
    exact.attitude_burst_rad = 60.0 * DEG;
    exact.attitude_burst_turned_rad = turned_deg * DEG;
    exact.attitude_burst = (span_t){5.0, 0.075};
    truth.t_s = 5.05;
    start(1);
    run_frames(1);
    NEAR(0.01, roll_deg, decoded.roll);
    NEAR(0.01, pitch_deg, decoded.pitch);
}

void test_a_mute_sensor_sends_nothing_and_comes_back_with_whole_frames(void)
{
    exact.mute = (span_t){1.0, 0.5};
    truth.t_s = 0.5;
    start(1);
    run_until(1 * SIM_S);
    const unsigned before = frames;
    TEST_ASSERT_UINT_WITHIN(1, 39, before);
    truth.t_s = 1.0;
    run_until(1100 * SIM_MS);
    const unsigned silent = octets;
    run_until(3 * SIM_S);
    TEST_ASSERT_EQUAL_UINT(silent, octets);
    truth.t_s = 1.5;
    run_until(4 * SIM_S);
    TEST_ASSERT_UINT_WITHIN(2, before + 40, frames);
}

/* Noise and all, to the last character, at the same pace. */
void test_a_frozen_sensor_repeats_its_latest_frame(void)
{
    char latest[sizeof kept];

    exact = razor_default;
    exact.frozen = (span_t){1.0, 10.0};
    on_frame = keep_text;
    start(1);
    run_frames(3);
    truth = (razor_truth_t){.roll_rad = 1.0, .t_s = 1.0};
    run_frames(2);
    memcpy(latest, kept, sizeof latest);
    for (int k = 0; k < 20; k++) {
        const sim_time_t from = timeline_now();

        run_frames(1);
        TEST_ASSERT_EQUAL_STRING(latest, kept);
        TEST_ASSERT_INT64_WITHIN(SIM_MS, 25 * SIM_MS, timeline_now() - from);
    }
    truth.t_s = 11.0;
    run_frames(2);
    TEST_ASSERT_TRUE(strcmp(latest, kept) != 0);
    NEAR(1.5, 1.0 / DEG, decoded.roll);
}

static char garbled[20000];
static size_t garbled_count;

static void gather(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    (void)bit_ns;
    if (garbled_count < sizeof garbled) {
        garbled[garbled_count++] = (char)octet;
    }
}

/* The level frame, octet by octet: of a struck one exactly one bit is wrong, be it a digit, a comma or the
 * line's end. */
void test_a_garbled_sensor_flips_one_bit_of_some_octets(void)
{
    static const char clean[] = "#A-C=0.00,0.00,256.00\r\n#YPR=0.00,0.00,0.00\r\n";
    const size_t length_of_clean = sizeof clean - 1;
    unsigned struck = 0, above = 0;

    exact.garbled = (span_t){0.0, 1000.0};
    garbled_count = 0;
    razor = razor9dof_create(&exact, world, &truth, 1, gather, NULL);
    razor9dof_power(razor, true);
    run_until(8 * SIM_S);
    TEST_ASSERT_TRUE(garbled_count > 13000);
    for (size_t i = 0; i < garbled_count; i++) {
        const unsigned wrong = ((unsigned char)garbled[i] ^ (unsigned char)clean[i % length_of_clean]) &
                               0xFFU;

        TEST_ASSERT_TRUE_MESSAGE((wrong & (wrong - 1U)) == 0U, "one bit at most");
        struck += wrong != 0U;
        above += wrong == 128U;
    }
    NEAR(0.01, 0.05, (double)struck / (double)garbled_count);
    NEAR(0.04, 0.125, (double)above / struck);
}

typedef struct {
    double sum, square;
    unsigned n;
} tally_t;
static tally_t yaw_tally, pitch_tally, roll_tally, z_tally;
static unsigned spikes, spikes_up, spikes_of[3];
static double products;

static void add(tally_t *tally, double value)
{
    tally->sum += value;
    tally->square += value * value;
    tally->n++;
}

static double mean(const tally_t *tally)
{
    return tally->sum / tally->n;
}

static double deviation(const tally_t *tally)
{
    return sqrt(tally->square / tally->n - mean(tally) * mean(tally));
}

static void count_frame(void)
{
    const double angle[3] = {decoded.yaw, decoded.pitch, decoded.roll};
    tally_t *const tally[3] = {&yaw_tally, &pitch_tally, &roll_tally};
    for (int k = 0; k < 3; k++) {
        if (fabs(angle[k]) > 10.0) {
            NEAR(1.5, 0.35 / DEG, fabs(angle[k]));
            spikes++;
            spikes_of[k]++;
            spikes_up += angle[k] > 0.0;
        } else {
            add(tally[k], angle[k]);
        }
    }
    products += fabs(angle[1]) < 10.0 && fabs(angle[2]) < 10.0 ? angle[1] * angle[2] : 0.0;
    add(&z_tally, (decoded.z / 256.0 - 1.0) * G);
}

static void tally_frames(unsigned count)
{
    yaw_tally = pitch_tally = roll_tally = z_tally = (tally_t){.n = 0};
    spikes = spikes_up = 0;
    memset(spikes_of, 0, sizeof spikes_of);
    products = 0.0;
    on_frame = count_frame;
    start(3);
    run_frames(count);
}

void test_noise_spikes_and_bias_are_as_large_as_said(void)
{
    exact = razor_default;
    tally_frames(20000);
    NEAR(0.01, 0.25, deviation(&yaw_tally));
    NEAR(0.01, 0.25, deviation(&pitch_tally));
    NEAR(0.01, 0.25, deviation(&roll_tally));
    NEAR(0.01, 0.0, mean(&yaw_tally));
    NEAR(0.01, 0.0, mean(&pitch_tally));
    NEAR(0.01, 0.0, mean(&roll_tally));
    NEAR(0.03 * 0.0625, 0.0, products / 20000.0);
    NEAR(0.01, 0.15, mean(&z_tally));
    NEAR(0.01, 0.4, deviation(&z_tally));
    NEAR(60.0, 300.0, spikes); /* 3 x 20000 x 0.005, 3.5 sigma */
    NEAR(35.0, spikes / 2.0, spikes_up);
    for (int k = 0; k < 3; k++) {
        NEAR(35.0, 100.0, spikes_of[k]);
    }
}

TEST_CASE(0.0, 0.0)
TEST_CASE(0.5, 0.8)
TEST_CASE(-0.25, 0.0)
void test_bias_and_noise_act_along_the_vertical_before_the_turn(double bias, double noise)
{
    exact.acceleration_bias_mps2 = bias;
    exact.acceleration_noise_mps2 = noise;
    truth.roll_rad = 0.4;
    truth.pitch_rad = -0.3;
    start(5);
    double sum = 0.0, square = 0.0;
    for (int k = 0; k < 4000; k++) {
        run_frames(1);
        const double felt = sqrt(decoded.x * decoded.x + decoded.y * decoded.y + decoded.z * decoded.z);
        NEAR(1e-3, sin(0.3), decoded.x / felt);
        NEAR(1e-3, cos(0.3) * sin(0.4), decoded.y / felt);
        const double up = (felt / 256.0 - 1.0) * G;
        sum += up;
        square += up * up;
    }
    NEAR(0.002 + 0.05 * noise, bias, sum / 4000.0);
    NEAR(0.002 + 0.05 * noise, noise, sqrt(fmax(square / 4000.0 - pow(sum / 4000.0, 2.0), 0.0)));
}

void test_a_spike_crosses_the_half_turn_correctly(void)
{
    exact.spike_probability = 1.0;
    truth.yaw_rad = M_PI;
    start(2);
    unsigned up = 0, down = 0;
    for (int k = 0; k < 200; k++) {
        run_frames(1);
        NEAR(0.006, 180.0 - 0.35 / DEG, fabs(decoded.yaw));
        up += decoded.yaw < 0.0;
        down += decoded.yaw > 0.0;
        NEAR(0.006, 0.35 / DEG, fabs(decoded.roll));
    }
    TEST_ASSERT_UINT_WITHIN(30, 100, up);
    TEST_ASSERT_EQUAL_UINT(200, up + down);
}

static unsigned long digest;

static void digest_frame(void)
{
    for (size_t k = 0; k < length; k++) {
        digest = (digest ^ (unsigned char)text[k]) * 16777619UL % 4294967291UL;
    }
}

static unsigned long digest_of(unsigned long seed)
{
    timeline_reset();
    digest = 2166136261UL;
    on_frame = digest_frame;
    start(seed);
    run_frames(200);
    razor9dof_destroy(razor);
    razor = NULL;
    length = 0;
    return digest;
}

void test_a_seed_repeats_its_octets_and_another_seed_does_not(void)
{
    for (int source = 0; source < 3; source++) {
        exact.angle_noise_rad = source == 0 ? 0.01 : 0.0;
        exact.spike_probability = source == 1 ? 0.5 : 0.0;
        exact.acceleration_noise_mps2 = source == 2 ? 0.4 : 0.0;
        const unsigned long first = digest_of(1);
        TEST_ASSERT_TRUE(first == digest_of(1));
        TEST_ASSERT_TRUE(first != digest_of(2));
    }
}

void test_the_longest_frame_fits_the_period(void)
{
    truth = (razor_truth_t){-179.99 * DEG, -80.5 * DEG, -170.25 * DEG, 8.0 * G, 0.0};
    on_frame = keep_text;
    start(1);
    run_frames(3);
    TEST_ASSERT_TRUE((double)strlen(kept) * OCTET_NS < 25e6);
    TEST_ASSERT_EQUAL_INT64(75 * SIM_MS + OCTET_NS, first_octet_at);
}
