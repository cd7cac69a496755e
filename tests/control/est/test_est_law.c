#include "noisy_plant.h"
#include "control/thrust.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>

#define SEEDS 30U

static noisy_t world;
static flight_t flight;
static parameters_t parameters;
static flight_inputs_t in;
static flight_outputs_t out;
static uint32_t clock_us;
static double highest_m, largest_error_m, least_n, sum, sum_of_squares, thrust_sum, thrust_squares;
static long samples;

static void set(parameter_id_t id, float value)
{
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, id, value));
}

static void board(uint32_t seed)
{
    world = noisy_on_ground(seed);
    flight_init(&flight);
    parameters_init(&parameters);
    set(PARAMETER_LAW, LAW_EST);
    memset(&in, 0, sizeof in);
    memset(&out, 0, sizeof out);
    in.attitude_ready = true;
    in.has_throttle = true;
    clock_us = 0xFFC00000U; /* wraps 4 s later */
    highest_m = 0.0;
    least_n = 99.0;
}

void setUp(void)
{
    board(1U);
}

void tearDown(void) {}

static void setr(float reference_m)
{
    in.reference_m = reference_m;
    in.reference_sequence++;
}

static double height_m(void)
{
    return world.body.height_m - world.body.terrain_m;
}

static void advance(void)
{
    noisy_step(&world, &in, clock_us);
    if (world.released || world.body.time_us % 150000U == 0U) {
        flight_step(&flight, &parameters, &in, &out);
        world.body.command_n = (double)thrust_from_pulse_us(out.pulse_us);
        if (out.state != FLIGHT_GROUND && out.state != FLIGHT_CUT) {
            least_n = fmin(least_n, (double)out.thrust_n);
        }
    }
    highest_m = fmax(highest_m, height_m());
}

static void run(double seconds)
{
    for (long i = lround(seconds * 2000.0); i > 0; i--) {
        advance();
    }
}

static void run_until(flight_state_t state, double at_most_s)
{
    for (long i = lround(at_most_s * 2000.0); i > 0 && out.state != state; i--) {
        advance();
    }
    TEST_ASSERT_EQUAL_STRING(flight_state_name(state), flight_state_name(out.state));
}

static void measure(double seconds, double reference_m)
{
    sum = sum_of_squares = thrust_sum = thrust_squares = largest_error_m = 0.0;
    samples = lround(seconds * 2000.0);
    for (long i = samples; i > 0; i--) {
        advance();
        const double error_m = height_m() - reference_m;
        largest_error_m = fmax(largest_error_m, fabs(error_m));
        sum += error_m;
        sum_of_squares += error_m * error_m;
        thrust_sum += (double)out.thrust_n;
        thrust_squares += (double)out.thrust_n * (double)out.thrust_n;
    }
}

static double rms_mm(void)
{
    return 1000.0 * sqrt(sum_of_squares / (double)samples);
}

static double activity_n(void)
{
    const double mean = thrust_sum / (double)samples;
    return sqrt(fmax(thrust_squares / (double)samples - mean * mean, 0.0));
}

static void hover_at(float reference_m)
{
    run(1.5);
    setr(reference_m);
    run(6.0);
    TEST_ASSERT_EQUAL_STRING("FLYING", flight_state_name(out.state));
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double p95(double *values, unsigned count)
{
    qsort(values, count, sizeof *values, ascending);
    return values[(unsigned)(0.95 * count)];
}

/* ---- a pilot's turn */

/* He has the throttle and flies up and down, 0.3 m to either side, whatever is commanded. */
static void flown_by_a_pilot(double seconds)
{
    in.has_throttle = false;
    run_until(FLIGHT_FLOATING, 0.1);
    const float learned_n = flight.est.hover.thrust_n;
    for (long i = 0; i < lround(seconds * 2000.0); i++) {
        advance();
        const double ahead = 6.2832 * (double)i * 0.0005 / 4.0;
        world.body.height_m = 0.8 + 0.3 * sin(ahead);
        world.body.speed_m_s = 0.3 * 1.5708 * cos(ahead);
        world.body.thrust_n = world.body.hover_n;
    }
    TEST_ASSERT_EQUAL_STRING("FLOATING", flight_state_name(out.state));
    TEST_ASSERT_EQUAL_FLOAT(learned_n, flight.est.hover.thrust_n);
    TEST_ASSERT_FALSE(flight.where.contact.airborne);
    in.has_throttle = true;
}

/* A low-pass of 80 ms, four frames of 20 ms: three quarters of what is missing are still missing a frame
 * later. */
void test_the_lift_off_acceleration_follows_the_accelerometer_with_80_ms(void)
{
    est_law_t law;
    imu_sample_t frame = {
        .arrival_us = 1000000UL, .ready = true, .has_acceleration = true, .down_mps2 = 9.81F + 2.0F};
    float missing = 2.0F;

    parameters_init(&parameters);
    est_law_init(&law);
    for (frame.sequence = 1U; frame.sequence <= 12U; frame.sequence++) {
        frame.arrival_us += 20000UL;
        est_law_predict(&law, &parameters, &(est_before_t){.airborne = false}, &frame, 1U, frame.arrival_us);
        if (frame.sequence > 1U) { /* the first one only starts the clock */
            missing *= 0.75F;
            TEST_ASSERT_FLOAT_WITHIN(0.02F, 2.0F - missing, law.lift.up_mps2);
        }
    }
}

void test_a_pilots_turn_teaches_no_hover_thrust_and_ends_within_half_a_newton_of_it(void)
{
    for (double hover_n = 5.6; hover_n < 8.45; hover_n += 0.7) {
        for (uint32_t seed = 1U; seed <= 4U; seed++) {
            board(seed);
            world.body.hover_n = hover_n;
            hover_at(0.6F);
            flown_by_a_pilot(3.0 + seed);
            TEST_ASSERT_FLOAT_WITHIN(0.35F, (float)hover_n, flight.thrust_n);
            TEST_ASSERT_FLOAT_WITHIN(2.4F, (float)hover_n, out.thrust_n); /* against a wrong pin */
            run_until(FLIGHT_FLYING, 0.1);
            TEST_ASSERT_FLOAT_WITHIN(0.5F, (float)hover_n, out.thrust_n);
            run(4.0);
            measure(4.0, 0.6);
            TEST_ASSERT_TRUE(rms_mm() <= 30.0);
            TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
        }
    }
}

/* ---- holding */

static double mean_rms_mm(void (*spoil)(void), unsigned seeds, double *activity)
{
    double total_mm = 0.0;
    *activity = 0.0;
    for (uint32_t seed = 1U; seed <= seeds; seed++) {
        board(seed);
        spoil();
        hover_at(0.6F);
        measure(8.0, 0.6);
        total_mm += rms_mm();
        *activity += activity_n() / seeds;
        TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
        TEST_ASSERT_EQUAL_UINT16(0, out.flags);
    }
    return total_mm / seeds;
}

static void nothing(void) {}

void test_the_hover_is_within_13_5_mm_at_half_a_newton_of_activity(void)
{
    double activity;
    const double mm = mean_rms_mm(nothing, SEEDS, &activity);
    TEST_ASSERT_TRUE(mm > 5.0 && mm <= 13.5);
    TEST_ASSERT_TRUE(activity > 0.1 && activity <= 0.5);
}

static void glitches(void)
{
    world.glitch = 0.015;
}

void test_glitches_hardly_change_it(void)
{
    double activity;
    TEST_ASSERT_TRUE(mean_rms_mm(glitches, SEEDS, &activity) <= 14.0);
}

static void shaken(void)
{
    world.acceleration_noise_m_s2 = 1.6;
}

void test_four_times_the_accelerometers_noise_is_borne_without_four_times_the_activity(void)
{
    double activity;
    TEST_ASSERT_TRUE(mean_rms_mm(shaken, SEEDS, &activity) <= 26.0);
    TEST_ASSERT_TRUE(activity <= 0.8);
    TEST_ASSERT_FLOAT_WITHIN(0.3F, 1.6F, flight.est.estimator.credit.noise_mps2);
}

void test_a_fifth_more_or_less_weight_needs_no_trim(void)
{
    for (double hover_n = 5.6; hover_n < 8.45; hover_n += 0.7) {
        for (uint32_t seed = 1U; seed <= 6U; seed++) {
            board(seed);
            world.body.hover_n = hover_n;
            world.body.damping_per_s = 1.5 + 0.3 * seed;
            hover_at(0.6F);
            TEST_ASSERT_TRUE(highest_m < 0.75);
            measure(6.0, 0.6);
            TEST_ASSERT_TRUE(rms_mm() <= 30.0);
            TEST_ASSERT_FLOAT_WITHIN(0.35F, (float)hover_n, flight.est.hover.thrust_n);
            TEST_ASSERT_EQUAL_INT(0, world.body.contacts);
            TEST_ASSERT_TRUE(least_n > 1.5);
        }
    }
}

void test_an_edge_of_25_cm_is_followed_within_a_second(void)
{
    double recovered_s[SEEDS];
    for (uint32_t seed = 1U; seed <= SEEDS; seed++) {
        board(seed);
        world.body.terrain_m = 0.25;
        world.body.height_m = 0.25;
        hover_at(0.6F);
        run(0.0031 * seed);
        world.body.terrain_m = 0.0;
        double lowest_m = 9.0;
        recovered_s[seed - 1U] = 0.0;
        for (int i = 0; i < 6000; i++) {
            advance();
            recovered_s[seed - 1U] = fabs(height_m() - 0.6) > 0.05 ? i * 0.0005 : recovered_s[seed - 1U];
            lowest_m = fmin(lowest_m, height_m());
        }
        TEST_ASSERT_TRUE(lowest_m > 0.54);
        TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
    }
    const double p95_s = p95(recovered_s, SEEDS);
    TEST_ASSERT_TRUE(recovered_s[SEEDS / 2U] > 0.4 && recovered_s[SEEDS / 2U] <= 0.9);
    TEST_ASSERT_TRUE(p95_s <= 1.0);
}

void test_ignoring_the_terrain_keeps_the_altitude_over_a_step(void)
{
    set(PARAMETER_TERRAIN, TERRAIN_IGNORE);
    hover_at(0.8F);
    world.body.terrain_m = 0.25;
    for (int i = 0; i < 4000; i++) {
        advance();
        TEST_ASSERT_FLOAT_WITHIN(0.12F, 0.8F, (float)world.body.height_m);
    }
    world.body.terrain_m = 0.0;
    for (int i = 0; i < 4000; i++) {
        advance();
        TEST_ASSERT_FLOAT_WITHIN(0.12F, 0.8F, (float)world.body.height_m);
    }
}

void test_ignoring_never_goes_below_15_cm_over_the_terrain(void)
{
    set(PARAMETER_TERRAIN, TERRAIN_IGNORE);
    hover_at(0.5F);
    world.body.terrain_m = 0.45;
    run(4.0);
    TEST_ASSERT_TRUE(height_m() > 0.1);
}

void test_a_new_reference_forgets_the_terrain_that_was_ignored(void)
{
    set(PARAMETER_TERRAIN, TERRAIN_IGNORE);
    hover_at(0.8F);
    world.body.terrain_m = 0.25;
    run(2.0);
    setr(0.7F);
    run(4.0);
    TEST_ASSERT_FLOAT_WITHIN(0.06F, 0.7F, (float)height_m());
}

/* ---- the vehicle that the parameters describe */

/* Rather low, so that a vehicle without heights sinks. Without the drag, or with a thrust later than the
 * acceleration, it comes out a third of a newton higher. */
void test_the_lift_off_tells_the_hover_thrust_and_rather_low(void)
{
    for (double hover_n = 6.0; hover_n < 8.45; hover_n += 0.8) {
        double off_n = 0.0;

        for (uint32_t seed = 1U; seed <= 6U; seed++) {
            board(seed);
            world.body.hover_n = hover_n;
            run(3.0);
            setr(0.6F);
            for (int i = 0; i < 8000 && !flight.where.contact.airborne; i++) {
                advance();
            }
            TEST_ASSERT_TRUE(flight.where.contact.airborne);
            off_n += ((double)flight.est.hover.thrust_n - hover_n) / 6.0;
        }
        printf("hover %.1f N: found at lift-off %+.2f N off\n", hover_n, off_n);
        TEST_ASSERT_FLOAT_WITHIN(0.22F, -0.25F, (float)off_n);
    }
}

static double lowest_thrust_over_an_edge_n(double edge_m)
{
    board(1U);
    hover_at(0.6F);
    world.body.terrain_m -= edge_m;
    least_n = 99.0;
    run(0.6);
    return least_n - world.body.hover_n;
}

void test_a_far_fall_of_the_terrain_is_followed_slowly_at_first(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.25F, -0.62F, (float)lowest_thrust_over_an_edge_n(0.6));
    TEST_ASSERT_TRUE(lowest_thrust_over_an_edge_n(0.25) < -2.0);
}

void test_a_doubt_of_the_thrust_gives_none_on_the_ground(void)
{
    hover_at(0.6F);
    setr(0.0F);
    run_until(FLIGHT_GROUND, 15.0);
    flight.sense.verdict.doubts = DOUBT_THRUST;
    flight.sense.verdict.held_n = 7.3F;
    flight.sense.verdict.held_down = true;
    run(1.0);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, out.thrust_n);
}

void test_the_model_is_the_one_that_the_parameters_describe(void)
{
    board(1U);
    hover_at(0.6F);
    const float plain_mps2_per_n = est_law_vehicle(&flight.est, &parameters).authority_mps2_per_n;
    set(PARAMETER_GAIN, 1.25F);
    set(PARAMETER_DAMP, 1.5F);
    cascade_vehicle_t vehicle = est_law_vehicle(&flight.est, &parameters);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 1.25F * plain_mps2_per_n, vehicle.authority_mps2_per_n);
    TEST_ASSERT_EQUAL_FLOAT(1.5F, vehicle.damping_per_s);
    set(PARAMETER_PLANT, PLANT_CLIMB);
    set(PARAMETER_CRATE, 0.8F);
    set(PARAMETER_CLAG, 0.4F);
    vehicle = est_law_vehicle(&flight.est, &parameters);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.0F, vehicle.authority_mps2_per_n);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 2.5F, vehicle.damping_per_s);
    set(PARAMETER_LAG, 0.08F);
    set(PARAMETER_DELAY, 0.035F);
    run(0.1);
    TEST_ASSERT_EQUAL_FLOAT(0.08F, flight.est.actuator.lag_s);
    TEST_ASSERT_EQUAL_UINT32(35000U, flight.est.actuator.delay_us);
}

/* ---- an autopilot whose throttle commands the climb rate */

void test_plant_climb_flies_climb_rate_autopilots(void)
{
    static const float rates[] = {0.6F, 1.0F, 1.6F};
    for (unsigned i = 0; i < 3; i++) {
        for (uint32_t seed = 1U; seed <= 5U; seed++) {
            board(seed);
            set(PARAMETER_PLANT, PLANT_CLIMB);
            set(PARAMETER_CRATE, rates[i]);
            world.body.climb_m_s_per_n = 1.0;
            hover_at(0.6F);
            TEST_ASSERT_TRUE(highest_m < 0.75);
            measure(6.0, 0.6);
            TEST_ASSERT_TRUE(rms_mm() <= 25.0);
            setr(0.0F);
            run_until(FLIGHT_GROUND, 10.0);
            TEST_ASSERT_TRUE(world.body.hardest_m_s <= 0.4);
        }
    }
}

/* ---- the scanner falls silent */

void test_half_a_second_without_a_height_is_hardly_seen(void)
{
    double errors_m[SEEDS];
    for (uint32_t seed = 1U; seed <= SEEDS; seed++) {
        board(seed);
        hover_at(0.6F);
        world.body.mute = true;
        measure(0.5, 0.6);
        errors_m[seed - 1U] = largest_error_m;
        TEST_ASSERT_EQUAL(FLIGHT_COASTING, out.state);
        world.body.mute = false;
        measure(1.0, 0.6);
        errors_m[seed - 1U] = fmax(errors_m[seed - 1U], largest_error_m);
        TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
    }
    const double p95_m = p95(errors_m, SEEDS);
    TEST_ASSERT_TRUE(p95_m > 0.01 && p95_m <= 0.09);
}

void test_three_seconds_without_a_height_land_from_60_cm(void)
{
    for (uint32_t seed = 1U; seed <= SEEDS; seed++) {
        board(seed);
        hover_at(0.6F);
        world.body.mute = true;
        run(3.0);
        TEST_ASSERT_EQUAL(FLIGHT_DESCENDING, out.state);
        TEST_ASSERT_TRUE(height_m() < 0.6);
        world.body.mute = false;
        run_until(FLIGHT_GROUND, 6.0);
        TEST_ASSERT_TRUE(world.body.contacts >= 1);
        TEST_ASSERT_TRUE(world.body.hardest_m_s > 0.02 && world.body.hardest_m_s <= 0.6);
        TEST_ASSERT_TRUE(highest_m < 0.85);
    }
}

void test_a_height_that_never_comes_back_ends_on_the_ground_without_thrust(void)
{
    for (float reference_m = 0.6F; reference_m < 1.9F; reference_m += 0.6F) {
        board((uint32_t)(reference_m * 10.0F));
        hover_at(reference_m);
        world.body.mute = true;
        run(15.0);
        TEST_ASSERT_TRUE(height_m() < 0.001);
        TEST_ASSERT_TRUE(world.body.hardest_m_s > 0.02 && world.body.hardest_m_s <= 0.7);
        run_until(FLIGHT_GROUND, 40.0);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, out.thrust_n);
    }
}

/* ---- the IMU falls silent */

void test_without_frames_pidt_takes_over_and_says_so(void)
{
    hover_at(0.6F);
    world.imu_mute = true;
    run(0.5);
    TEST_ASSERT_EQUAL(LAW_PIDT, flight.law);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_ATTITUDE, out.flags);
    measure(15.0, 0.6);
    TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
    TEST_ASSERT_TRUE(largest_error_m < 0.3);
    world.imu_mute = false;
    run(0.2);
    TEST_ASSERT_EQUAL(LAW_EST, flight.law);
    run(3.0);
    measure(6.0, 0.6);
    TEST_ASSERT_EQUAL_UINT16(0, out.flags);
    TEST_ASSERT_TRUE(rms_mm() < 30.0);
}

/* The latest command before the gap may have been an answer to noise. */
void test_a_silent_imu_brings_the_thrust_to_hover_within_a_fifth_of_a_second(void)
{
    float widest_n = 0.0F;
    for (uint32_t seed = 1U; seed <= SEEDS; seed++) {
        board(seed);
        hover_at(0.6F);
        world.imu_mute = true;
        run(0.18);
        do { /* law PIDT takes over after 0.25 s */
            advance();
            const float off_n = fabsf(out.thrust_n - flight.where.hover.thrust_n);
            widest_n = (off_n > widest_n) ? off_n : widest_n;
        } while (flight.law != LAW_PIDT);
    }
    printf("at most %.2f N from hover\n", (double)widest_n);
    TEST_ASSERT_TRUE(widest_n > 0.2F && widest_n < 0.8F);
}

void test_heights_without_frames_tell_the_speed_and_do_not_bend_the_bias(void)
{
    hover_at(0.6F);
    world.imu_mute = true;
    run(0.4);
    const float bias_mps2 = flight.est.estimator.now.bias_mps2;
    run(3.0);
    TEST_ASSERT_EQUAL_FLOAT(bias_mps2, flight.est.estimator.now.bias_mps2);
    TEST_ASSERT_FLOAT_WITHIN(0.15F, (float)world.body.speed_m_s, flight.est.estimator.now.speed_mps);
    TEST_ASSERT_FLOAT_WITHIN(0.3F, 0.0F, (float)(height_m() - 0.6));
}

/* It climbs at 0.8 m/s when the frames come back; heights come or not. */
static float speed_error_after_a_gap(bool heights)
{
    hover_at(0.6F);
    world.imu_mute = true;
    run(1.0);
    setr(1.5F);
    run(0.8);
    world.body.mute = !heights;
    world.imu_mute = false;
    run(0.1);
    TEST_ASSERT_EQUAL(LAW_EST, flight.law);
    TEST_ASSERT_TRUE(world.body.speed_m_s > 0.3);
    return fabsf(flight.est.estimator.now.speed_mps - (float)world.body.speed_m_s);
}

void test_after_a_gap_of_the_imu_the_estimate_knows_how_fast_the_vehicle_moves(void)
{
    float sum_mps[2] = {0.0F, 0.0F};
    for (uint32_t seed = 1U; seed <= SEEDS; seed++) {
        board(seed);
        sum_mps[0] += speed_error_after_a_gap(true) / (float)SEEDS;
        board(seed);
        sum_mps[1] += speed_error_after_a_gap(false) / (float)SEEDS;
    }
    printf("off by %.2f m/s with heights, %.2f without\n", (double)sum_mps[0], (double)sum_mps[1]);
    TEST_ASSERT_TRUE(sum_mps[0] < 0.2F && sum_mps[1] < 0.2F);
}

/* ---- the flight before */

static bool flies_again_heavier(bool gravity_typed)
{
    board(1U);
    set(PARAMETER_GRAV, 5.5F);
    world.body.hover_n = 6.8;
    hover_at(0.6F);
    setr(0.0F);
    run(6.0);
    TEST_ASSERT_EQUAL_STRING("GROUND", flight_state_name(out.state));
    world.body.hover_n = 7.7; /* above 1.35 of GRAV */
    set(PARAMETER_GRAV, gravity_typed ? 5.51F : 5.5F);
    run(0.5);
    setr(0.6F);
    run(10.0);
    return height_m() > 0.4;
}

void test_what_carried_the_flight_before_bounds_the_next_take_off_until_grav_is_typed(void)
{
    TEST_ASSERT_TRUE(flies_again_heavier(false));
    TEST_ASSERT_FALSE(flies_again_heavier(true));
}

/* ---- frames without accelerations */

void test_without_accelerations_it_flies_by_the_thrust_model_and_the_heights_and_says_so(void)
{
    double rms[SEEDS], activity[SEEDS], highest[SEEDS];
    for (uint32_t seed = 1; seed <= SEEDS; seed++) {
        board(seed);
        world.no_acceleration = true;
        hover_at(0.6F);
        TEST_ASSERT_EQUAL(LAW_EST, flight.law);
        TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_IMU, out.flags);
        highest[seed - 1] = highest_m;
        measure(10.0, 0.6);
        rms[seed - 1] = rms_mm();
        activity[seed - 1] = activity_n();
        TEST_ASSERT_EQUAL(LAW_EST, flight.law);
    }
    qsort(rms, SEEDS, sizeof rms[0], ascending);
    qsort(activity, SEEDS, sizeof activity[0], ascending);
    qsort(highest, SEEDS, sizeof highest[0], ascending);
    printf("hover rms median %.1f, largest %.1f mm; activity %.2f N; highest %.3f m\n", rms[SEEDS / 2U],
           rms[SEEDS - 1U], activity[SEEDS / 2U], highest[SEEDS - 1U]);
    TEST_ASSERT_TRUE(rms[SEEDS / 2U] > 6.0 && rms[SEEDS / 2U] < 17.0);
    TEST_ASSERT_TRUE(rms[SEEDS - 1U] < 26.0);
    TEST_ASSERT_TRUE(activity[SEEDS / 2U] > 0.3 && activity[SEEDS / 2U] < 0.75);
    TEST_ASSERT_TRUE(highest[SEEDS - 1U] < 0.72);
}

void test_without_accelerations_a_vehicle_of_unknown_mass_is_found_by_the_heights(void)
{
    static const double masses[] = {0.8, 1.2};
    for (unsigned i = 0; i < 2; i++) {
        board(1U);
        world.body.hover_n *= masses[i];
        world.no_acceleration = true;
        hover_at(0.6F);
        TEST_ASSERT_TRUE_MESSAGE(highest_m < 0.75, "overshoot");
        measure(10.0, 0.6);
        TEST_ASSERT_TRUE_MESSAGE(rms_mm() < 26.0, "hover");
        TEST_ASSERT_FLOAT_WITHIN(0.25F, (float)world.body.hover_n, flight.est.hover.thrust_n);
    }
}

void test_accelerations_lost_in_flight_and_found_again_change_the_flag_and_not_the_height(void)
{
    hover_at(0.6F);
    world.no_acceleration = true;
    run(0.18);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(0, out.flags, "some frames without them are nothing");
    run(0.3);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_IMU, out.flags);
    measure(10.0, 0.6);
    TEST_ASSERT_TRUE(largest_error_m < 0.1);
    world.no_acceleration = false;
    run(0.2);
    TEST_ASSERT_EQUAL_UINT16(0, out.flags);
    measure(10.0, 0.6);
    TEST_ASSERT_TRUE(largest_error_m < 0.1);
    TEST_ASSERT_EQUAL(LAW_EST, flight.law);
}

/* 4 m/s2 from one frame to the next: the estimate has followed them until they are in doubt. */
void test_an_accelerometer_that_jumps_in_flight_is_doubted_and_the_thrust_model_flies_on(void)
{
    static const double jumps_mps2[] = {-4.0, -2.5, 2.5};
    for (unsigned i = 0; i < 3; i++) {
        board(1U + i);
        hover_at(0.6F);
        world.acceleration_bias_m_s2 += jumps_mps2[i];
        measure(3.0, 0.6);
        TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_IMU, out.flags);
        TEST_ASSERT_TRUE(largest_error_m < 0.45);
        measure(10.0, 0.6);
        TEST_ASSERT_EQUAL(LAW_EST, flight.law);
        TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
        TEST_ASSERT_TRUE(rms_mm() > 5.0 && rms_mm() < 30.0);
    }
}

void test_without_accelerations_and_without_heights_it_comes_down_by_the_thrust_alone(void)
{
    world.no_acceleration = true;
    hover_at(0.6F);
    world.body.mute = true;
    run(1.0);
    TEST_ASSERT_EQUAL_STRING("COASTING", flight_state_name(out.state));
    TEST_ASSERT_EQUAL(FLIGHT_MODE_HOVER, flight.mode);
    run_until(FLIGHT_DESCENDING, 2.0);
    TEST_ASSERT_EQUAL(FLIGHT_MODE_BLIND_DESCENT, flight.mode);
    run(20.0);
    TEST_ASSERT_TRUE(height_m() < 0.02);
    TEST_ASSERT_TRUE(highest_m < 1.0);
}

/* ---- taking over and giving away */

void test_laws_change_in_flight_without_a_jump(void)
{
    static const int laws[] = {LAW_PIDT, LAW_EST, LAW_PID, LAW_EST, LAW_PD, LAW_PIDT, LAW_PID, LAW_EST};
    set(PARAMETER_KP, 0.005F);
    set(PARAMETER_KD, 0.028F);
    set(PARAMETER_KI, 0.0005F);
    set(PARAMETER_USAT, 2.5F);
    set(PARAMETER_DSAT, 2.5F);
    set(PARAMETER_RELEASE, RELEASE_SCAN);
    hover_at(0.8F);
    for (unsigned i = 0; i < sizeof laws / sizeof laws[0]; i++) {
        const float before_n = out.thrust_n;
        set(PARAMETER_LAW, (float)laws[i]);
        do {
            advance();
        } while (!world.released);
        TEST_ASSERT_FLOAT_WITHIN(0.35F, before_n, out.thrust_n);
        measure(6.0, 0.8);
        TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
        TEST_ASSERT_TRUE(largest_error_m < 0.3);
    }
}

void test_a_reference_given_to_a_floating_vehicle_starts_within_half_a_newton_of_hover(void)
{
    for (uint32_t seed = 1U; seed <= 10U; seed++) {
        board(seed);
        for (int i = 0; i < 4000; i++) { /* a pilot holds it */
            advance();
            world.body.height_m = 0.5;
            world.body.speed_m_s = 0.0;
            world.body.thrust_n = world.body.hover_n;
        }
        TEST_ASSERT_EQUAL(FLIGHT_FLOATING, out.state);
        TEST_ASSERT_FLOAT_WITHIN(0.5F, 7.0F, out.thrust_n); /* whatever it would like to do */
        setr(0.7F);
        run_until(FLIGHT_FLYING, 0.2);
        TEST_ASSERT_FLOAT_WITHIN(1.7F, 7.4F, out.thrust_n);
        run(4.0);
        measure(4.0, 0.7);
        TEST_ASSERT_TRUE(rms_mm() < 60.0);
    }
}

/* ---- landing */

void test_landing_touches_softly(void)
{
    for (double hover_n = 5.6; hover_n < 8.45; hover_n += 1.4) {
        for (uint32_t seed = 1U; seed <= 5U; seed++) {
            board(seed);
            world.body.hover_n = hover_n;
            hover_at(0.4F + 0.2F * (float)seed);
            setr(0.0F);
            run_until(FLIGHT_GROUND, 10.0);
            TEST_ASSERT_TRUE(height_m() < 0.01);
            TEST_ASSERT_TRUE(world.body.hardest_m_s > 0.02 && world.body.hardest_m_s <= 0.35);
        }
    }
}

/* Near the ground a tenth less thrust carries it: it would lift off again, and be cut in the air. */
void test_a_landing_never_leaves_the_ground_again(void)
{
    double hop_m = 0.0, hardest_m_s = 0.0;
    for (uint32_t seed = 1U; seed <= 60U; seed++) {
        const double hover_n = 5.6 + 0.047 * seed;
        board(seed);
        world.body.hover_n = hover_n;
        world.turbulence_m_s2 = 0.35;
        world.height_noise_mm *= 2.0;
        hover_at(0.6F);
        setr(0.0F);
        for (long i = 0; i < 20000 && out.state != FLIGHT_GROUND; i++) {
            advance();
            world.body.hover_n = (world.body.contacts > 0 || height_m() < 0.05) ? 0.9 * hover_n : hover_n;
            hop_m = world.body.contacts > 0 ? fmax(hop_m, height_m()) : hop_m;
        }
        TEST_ASSERT_EQUAL(FLIGHT_GROUND, out.state);
        hardest_m_s = fmax(hardest_m_s, world.body.hardest_m_s);
    }
    TEST_ASSERT_TRUE(hop_m > 0.0 && hop_m < 0.03);
    TEST_ASSERT_TRUE(hardest_m_s > 0.1 && hardest_m_s < 0.45);
}

void test_setr_0_before_the_lift_off_takes_the_thrust_away(void)
{
    run(1.5);
    setr(0.6F);
    run(0.3);
    TEST_ASSERT_EQUAL(FLIGHT_TAKEOFF, out.state);
    setr(0.0F);
    run(0.06);
    const float before_n = out.thrust_n;
    TEST_ASSERT_TRUE(before_n > 3.0F);
    run(0.3);
    TEST_ASSERT_TRUE(out.thrust_n < before_n - 0.4F && out.thrust_n > before_n - 0.8F);
    run_until(FLIGHT_GROUND, 1.5);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, (float)highest_m);
}

/* ---- under the other laws */

/* The seed's window begins at GRAV: a vehicle that needs less cannot come down by that law. */
void test_a_law_that_cannot_come_down_is_caught_by_the_estimate_and_landed_at_the_third_time(void)
{
    for (uint32_t seed = 1U; seed <= 20U; seed++) {
        board(seed);
        set(PARAMETER_LAW, LAW_PID);
        world.body.hover_n = 5.6;
        run(1.5);
        setr(0.6F);
        run_until(FLIGHT_LOWERING, 5.0);
        TEST_ASSERT_EQUAL_HEX16(FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME, out.releases);
        run_until(FLIGHT_FLYING, 5.0);
        TEST_ASSERT_EQUAL_HEX16(FLIGHT_RELEASE_PERIOD, out.releases);
        run_until(FLIGHT_LANDING, 20.0);
        run_until(FLIGHT_GROUND, 15.0);
        TEST_ASSERT_TRUE(highest_m > 0.6 + 0.5 && highest_m < 0.6 + 1.1);
        TEST_ASSERT_TRUE(world.body.hardest_m_s > 0.02 && world.body.hardest_m_s < 0.4);
    }
}

void test_every_law_lands_by_the_estimate_and_coasts_by_it(void)
{
    for (int law = LAW_PD; law <= LAW_PIDT; law++) {
        board(3U);
        set(PARAMETER_LAW, (float)law);
        set(PARAMETER_RELEASE, RELEASE_SCAN);
        hover_at(0.6F);
        TEST_ASSERT_EQUAL(FLIGHT_MODE_LAW, flight.mode);
        world.body.mute = true;
        run_until(FLIGHT_COASTING, 0.6);
        TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_HOLD, flight.mode);
        run_until(FLIGHT_DESCENDING, 1.5);
        TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_SINK, flight.mode);
        world.body.mute = false;
        run_until(FLIGHT_LANDING, 0.5);
        TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_LAND, flight.mode);
        run_until(FLIGHT_GROUND, 8.0);
        TEST_ASSERT_TRUE(world.body.hardest_m_s > 0.02 && world.body.hardest_m_s < 0.4);
    }
}

void test_a_landing_whose_estimate_is_contradicted_goes_on_by_the_heights(void)
{
    set(PARAMETER_LAW, LAW_PID);
    hover_at(1.5F);
    setr(0.0F);
    run(0.2);
    TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_LAND, flight.mode);
    static const double chasms_m[] = {-0.3, -0.6, -0.2, -0.9, -0.4, -0.7};
    for (size_t i = 0; i < sizeof chasms_m / sizeof chasms_m[0]; i++) {
        world.body.terrain_m = chasms_m[i];
        run(0.1);
    }
    TEST_ASSERT_EQUAL(FLIGHT_MODE_DESCENT, flight.mode);
    world.body.terrain_m = 0.0;
    run(1.0);
    TEST_ASSERT_EQUAL(FLIGHT_MODE_EST_LAND, flight.mode);
    run_until(FLIGHT_GROUND, 8.0);
}

void test_it_flies_again_after_a_landing(void)
{
    hover_at(0.6F);
    setr(0.0F);
    run_until(FLIGHT_GROUND, 10.0);
    run(1.0);
    highest_m = 0.0;
    hover_at(0.6F);
    TEST_ASSERT_TRUE(highest_m < 0.72);
    measure(4.0, 0.6);
    TEST_ASSERT_TRUE(rms_mm() < 30.0);
}

/* ---- what it must never do */

/* The study's fly-away: a scan that catches the edge half-way, then the edge, then noise that agrees with
 * nothing. */
void test_scans_that_disagree_never_make_it_fly_away(void)
{
    for (uint32_t seed = 1U; seed <= 20U; seed++) {
        board(seed);
        world.body.terrain_m = 0.25;
        world.body.height_m = 0.25;
        hover_at(0.6F);
        for (int scan = 0; scan < 6; scan++) {
            world.body.terrain_m = scan < 2 ? 0.125 : 0.0;
            world.glitch = scan % 2 == 0 ? 0.9 : 0.4;
            run(0.1);
        }
        world.glitch = 0.0;
        run(1.5);
        TEST_ASSERT_TRUE(highest_m < 0.6 + 0.8);
        measure(3.0, 0.6);
        TEST_ASSERT_TRUE(largest_error_m < 0.25);
        TEST_ASSERT_TRUE(world.body.contacts == 0 && least_n > 1.5);
    }
}

void test_a_law_that_starts_with_a_wrong_speed_recovers(void)
{
    hover_at(0.6F);
    flight.est.estimator.filter.estimate.speed_mps = 3.0F;
    flight.est.estimator.now.speed_mps = 3.0F;
    run(3.0);
    measure(3.0, 0.6);
    TEST_ASSERT_TRUE(largest_error_m < 0.1);
    TEST_ASSERT_EQUAL_INT(0, world.body.contacts);
}

void test_a_tilt_over_45_degrees_cuts(void)
{
    hover_at(0.6F);
    world.tilt_rad = 0.0;
    world.fallen_rad = 1.0;
    run(0.18); /* in one jump */
    TEST_ASSERT_NOT_EQUAL(FLIGHT_CUT, out.state);
    run(0.11);
    TEST_ASSERT_EQUAL(FLIGHT_CUT, out.state);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, out.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(THRUST_IDLE_PULSE_US, out.pulse_us);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_TILT, out.flags & FLIGHT_FLAG_TILT);
}

void test_a_tilt_over_45_degrees_that_the_rays_do_not_show_does_not_cut(void)
{
    hover_at(0.6F);
    world.tilt_rad = 0.0;
    world.lied_rad = 1.0;
    run(3.0);
    TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
    measure(3.0, 0.6);
    TEST_ASSERT_TRUE(largest_error_m < 0.2);
    world.lied_rad = 0.0;
    measure(3.0, 0.6);
    TEST_ASSERT_TRUE(largest_error_m < 0.2);
    TEST_ASSERT_EQUAL_INT(0, world.body.contacts);
}
