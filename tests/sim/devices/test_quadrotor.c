#include <math.h>
#include <stddef.h>

#include "sim/devices/quadrotor.h"
#include "unity.h"

#define G 9.80665
#define H 0.0005 /* the model's step */
#define PWM ((sim_time_t)13600000)
#define DEG (M_PI / 180.0)
#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

static quadrotor_t *quad;
static quadrotor_config_t calm; /* nothing random */
static place_t lifting;         /* a floor that rises by 0.25 m from 7.3 to 8 s, and is gone at 11 s */
static const course_t *way;

void setUp(void)
{
    timeline_reset();
    quad = NULL;
    way = NULL;
    place_init(&lifting);
    place_add(&lifting, &(place_block_t){.length_m = 100.0,
                                         .width_m = 100.0,
                                         .bottom_m = -1.0,
                                         .travel_m = 0.25,
                                         .travel_mps = 0.25 / 0.7,
                                         .travel_start_s = 7.3,
                                         .stay_s = 100.0,
                                         .there = {-1e12, 1e12 + 11.0}});
    calm = quadrotor_default;
    calm.turbulence_mps2 = 0.0;
    calm.attitude_rms_rad = 0.0;
}

void tearDown(void)
{
    quadrotor_destroy(quad);
}

static void start(const quadrotor_config_t *config, const place_t *place, unsigned long seed)
{
    quadrotor_destroy(quad);
    timeline_reset();
    quad = quadrotor_create(config, place, way, seed);
}

/* Of lifting. */
static double lifted_m(double t_s)
{
    return t_s < 11.0 ? fmin(fmax(0.25 * (t_s - 7.3) / 0.7, 0.0), 0.25) : 0.0;
}

static void wait(sim_time_t duration)
{
    timeline_move_to(timeline_now() + duration);
}

static quadrotor_state_t now(void)
{
    return *quadrotor_state(quad);
}

/* Seed eq. 5: compare = 4166 - 177.21 T, counts of 480 ns. */
static sim_time_t width(double thrust_n)
{
    return (sim_time_t)llround((4166.0 - 177.21 * thrust_n) * 480.0);
}

static void fly(double seconds, double thrust_n)
{
    for (long n = lround(seconds * 1e9 / (double)PWM); n > 0; n--) {
        wait(PWM);
        quadrotor_pulse(quad, width(thrust_n));
    }
}

/* A pilot who holds an altitude, until virtual time `end_s`. */
static void hold(double altitude_m, double end_s)
{
    while (timeline_now() < (sim_time_t)(end_s * 1e9)) {
        wait(PWM);
        const quadrotor_state_t s = now();
        quadrotor_pulse(quad, width(7.4 + 4.0 * (altitude_m - s.altitude_m) - 3.0 * s.speed_mps));
    }
}

/* What the motors gave in the last step, from the motion alone: the drag acted on the speed before it. */
static double lift(const quadrotor_state_t *s)
{
    const double speed_before = s->speed_mps - H * s->acceleration_mps2;
    return s->acceleration_mps2 + G + 2.4 * speed_before;
}

void test_defaults_are_the_plant_of_the_study(void)
{
    const quadrotor_config_t *d = &quadrotor_default;
    NEAR(1e-12, 1.0, d->gain);
    NEAR(1e-12, 0.12, d->tau_s);
    NEAR(1e-12, 2.4, d->damping_per_s);
    NEAR(1e-12, 7.4, d->hover_thrust_n);
    NEAR(1e-12, 0.001, d->sag_per_s);
    NEAR(1e-12, 0.2, d->turbulence_mps2);
    NEAR(1e-12, 0.5, d->turbulence_tau_s);
    NEAR(1e-7, 0.0349066, d->attitude_rms_rad);
    NEAR(1e-12, 0.010, d->actuator_delay_s);
    NEAR(1e-12, 0.0, d->climb_rate_mps_per_n);
    NEAR(1e-12, 5.88, d->climb_neutral_n);
    NEAR(1e-12, 0.47, d->climb_deadband_n);
    NEAR(1e-12, 0.25, d->climb_lag_s);
    NEAR(1e-12, 6.0, d->climb_ceiling_mps);
    NEAR(1e-12, 0.0, d->tug_rate_per_s);
    NEAR(1e-12, -1.5, d->tug_mps2);
    TEST_ASSERT_FALSE(d->anchored);
}

void test_without_a_pulse_it_rests_on_the_ground(void)
{
    start(&quadrotor_default, NULL, 1);
    for (int k = 0; k < 500; k++) {
        wait(10 * SIM_MS);
        const quadrotor_state_t s = now();
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.altitude_m);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.height_m);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.speed_mps);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.acceleration_mps2);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.thrust_n);
        TEST_ASSERT_TRUE(s.on_ground);
        TEST_ASSERT_EQUAL_UINT(0, s.contacts);
    }
}

void test_it_stands_on_what_there_is_at_the_origin(void)
{
    static place_t place;

    place_init(&place);
    place_add(&place, &(place_block_t){.length_m = 0.7, .width_m = 0.7, .near_top_m = 0.4, .far_top_m = 0.4});
    start(&calm, &place, 1);
    fly(2.0, 3.0);
    NEAR(1e-9, 0.4, now().altitude_m);
    NEAR(1e-9, 0.0, now().height_m);
    TEST_ASSERT_FALSE(now().collided);
    fly(1.0, 8.0);
    TEST_ASSERT_TRUE(now().altitude_m > 0.41);
    TEST_ASSERT_FALSE(now().collided);
}

void test_a_sway_about_one_axis_leaves_the_other_at_rest(void)
{
    quadrotor_config_t one = quadrotor_default;
    double roll = 0.0, pitch = 0.0;

    one.pitch_sway = 0.0;
    one.ground_sway = 1.0;
    start(&one, NULL, 3);
    for (int k = 0; k < 500; k++) {
        wait(10 * SIM_MS);
        roll = fmax(roll, fabs(now().roll_rad));
        pitch = fmax(pitch, fabs(now().pitch_rad));
    }
    TEST_ASSERT_TRUE(roll > 1.0 * DEG);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, pitch);
}

void test_thrust_below_the_weight_does_not_lift(void)
{
    start(&calm, NULL, 1);
    fly(5.0, 7.2); /* 7.21 N hover at the ground: 7.4 / 1.0264 */
    TEST_ASSERT_TRUE(now().on_ground);
    NEAR(1e-4, 7.2, now().thrust_n);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, now().altitude_m);
    fly(5.0, 7.22);
    TEST_ASSERT_FALSE(now().on_ground);
    TEST_ASSERT_TRUE(now().altitude_m > 0.0);
}

void test_hover_thrust_holds_and_a_tenth_more_climbs(void)
{
    start(&calm, NULL, 1);
    fly(10.0, 9.0);
    fly(10.0, 7.4);
    NEAR(2e-4, 0.0, now().speed_mps);
    NEAR(2e-4, 0.0, now().acceleration_mps2);
    fly(10.0, 7.5);
    NEAR(3e-4, 0.1 / 7.4 * G / 2.4, now().speed_mps);
    fly(10.0, 7.3);
    NEAR(3e-4, -0.1 / 7.4 * G / 2.4, now().speed_mps);
}

TEST_CASE(1.0, 2.4, 7.4, 11.0)
TEST_CASE(0.8, 2.4, 7.4, 9.0)
TEST_CASE(1.2, 1.5, 5.6, 8.0)
TEST_CASE(1.0, 3.0, 8.4, 8.8)
void test_terminal_climb_is_excess_acceleration_over_damping(double gain, double damping, double hover,
                                                             double thrust)
{
    calm.gain = gain;
    calm.damping_per_s = damping;
    calm.hover_thrust_n = hover;
    start(&calm, NULL, 1);
    fly(30.0, thrust);
    const double expected = G * gain * (thrust - hover) / hover / damping;
    NEAR(0.002 * expected, expected, now().speed_mps);
    NEAR(0.001, 0.0, now().acceleration_mps2);
}

TEST_CASE(0.12)
TEST_CASE(0.09)
TEST_CASE(0.15)
void test_the_motors_lag_is_first_order(double tau)
{
    calm.tau_s = tau;
    calm.actuator_delay_s = 0.0;
    calm.anchored = true;
    start(&calm, NULL, 1);
    for (int k = 1; k <= 60; k++) {
        quadrotor_pulse(quad, width(8.0));
        wait(10 * SIM_MS);
        NEAR(1e-3, 8.0 * (1.0 - exp(-0.010 * k / tau)), now().thrust_n);
    }
}

TEST_CASE(0.010, 20)
TEST_CASE(0.005, 10)
TEST_CASE(0.020, 40)
TEST_CASE(0.0, 0)
void test_a_pulse_acts_its_delay_after_the_falling_edge(double delay_s, int steps)
{
    calm.actuator_delay_s = delay_s;
    start(&calm, NULL, 1);
    wait(50 * SIM_MS);
    quadrotor_pulse(quad, width(8.0));
    for (int k = 0; k < steps; k++) {
        wait(500 * SIM_US);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, now().thrust_n);
    }
    wait(500 * SIM_US);
    NEAR(1e-4, 8.0 * (1.0 - exp(-H / 0.12)), now().thrust_n);
}

void test_pulses_on_their_way_act_each_at_its_time(void)
{
    calm.actuator_delay_s = 0.020;
    calm.tau_s = 1e-6; /* motors that follow at once show the demand */
    start(&calm, NULL, 1);
    const double thrust[] = {2.0, 5.0, 3.0, 6.0};
    for (int k = 0; k < 4; k++) {
        quadrotor_pulse(quad, width(thrust[k]));
        wait(6 * SIM_MS);
    }
    wait(1 * SIM_MS); /* 25 ms: the first, born at 0, rules since 20 */
    NEAR(1e-4, 2.0, now().thrust_n);
    for (int k = 1; k < 4; k++) {
        wait(6 * SIM_MS);
        NEAR(1e-4, thrust[k], now().thrust_n);
    }
}

/* Seed: 2 ms is no thrust, 1 ms (2082 counts) is 11.76 N. */
TEST_CASE(999360, 11.76)
TEST_CASE(1404237, 7.0)
TEST_CASE(1999680, 0.0)
TEST_CASE(2200000, 0.0)
TEST_CASE(13600000, 0.0)
void test_the_pulse_width_says_the_thrust_and_never_less_than_none(int width_ns, double thrust_n)
{
    calm.anchored = true;
    start(&calm, NULL, 1);
    for (int k = 0; k < 200; k++) {
        wait(PWM);
        quadrotor_pulse(quad, width_ns);
    }
    NEAR(0.001, thrust_n, now().thrust_n);
}

void test_the_autopilot_cuts_after_a_tenth_of_a_second_without_pulses(void)
{
    start(&calm, NULL, 1);
    fly(3.0, 9.0);
    wait(100 * SIM_MS);
    NEAR(1e-3, 9.0, now().thrust_n);
    wait(1 * SIM_MS);
    const double cut = now().thrust_n;
    TEST_ASSERT_TRUE(cut < 8.99);
    TEST_ASSERT_TRUE(cut > 8.9);
    wait(400 * SIM_MS);
    NEAR(0.01, cut * exp(-0.4 / 0.12), now().thrust_n);
    quadrotor_pulse(quad, width(9.0)); /* the old demand does not come back before the new pulse acts */
    const double low = now().thrust_n;
    wait(10 * SIM_MS);
    TEST_ASSERT_TRUE(now().thrust_n < low);
    wait(100 * SIM_MS);
    TEST_ASSERT_TRUE(now().thrust_n > 4.0);
}

void test_a_flood_of_pulses_leaves_the_latest(void)
{
    calm.anchored = true;
    start(&calm, NULL, 1);
    for (int k = 0; k < 1000; k++) {
        quadrotor_pulse(quad, width(1.0 + 0.005 * k));
    }
    wait(99 * SIM_MS);
    NEAR(1e-3, 5.995 * (1.0 - exp(-0.089 / 0.12)), now().thrust_n);
}

void test_falling_speed_follows_the_damping(void)
{
    start(&calm, NULL, 1);
    fly(20.0, 11.0);
    fly(0.6, 0.0);
    const quadrotor_state_t s = now();
    TEST_ASSERT_TRUE(s.thrust_n < 1.0);
    wait(50 * SIM_MS);
    quadrotor_pulse(quad, width(0.0));
    wait(50 * SIM_MS);
    const double expected = -G / 2.4 + (s.speed_mps + G / 2.4) * exp(-2.4 * 0.1);
    NEAR(0.002 * fabs(expected), expected, now().speed_mps);
}

void test_the_motors_lift_nothing_up_to_one_newton(void)
{
    calm.tau_s = 0.5;
    start(&calm, NULL, 1);
    fly(20.0, 11.0);
    unsigned above = 0, below = 0;
    for (int k = 0; k < 4000; k++) {
        if (k % 20 == 0) {
            quadrotor_pulse(quad, width(0.0));
        }
        wait(500 * SIM_US);
        const quadrotor_state_t s = now();
        if (s.thrust_n > 1.0) {
            NEAR(1e-3, G * s.thrust_n / 7.4, lift(&s));
            above++;
        } else {
            NEAR(1e-9, 0.0, lift(&s));
            below++;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(1000, above);
    TEST_ASSERT_GREATER_THAN_UINT(1000, below);
}

/* GE = 1 / (1 - 2 (0.127 / (4 (h + 0.28)))^2), worked out by hand. */
TEST_CASE(0.0, 1.026395)
TEST_CASE(0.1, 1.014160)
TEST_CASE(0.3, 1.006030)
TEST_CASE(0.6, 1.002610)
TEST_CASE(2.0, 1.000388)
void test_ground_effect_at_a_height(double height_m, double factor)
{
    start(&calm, NULL, 1);
    quadrotor_state_t s = now();
    for (unsigned k = 0; s.on_ground || s.height_m < height_m; k++) {
        if (k % 20 == 0) {
            quadrotor_pulse(quad, width(7.6));
        }
        wait(500 * SIM_US);
        s = now();
    }
    NEAR(1.5e-4, factor, lift(&s) / (G * s.thrust_n / 7.4));
}

void test_ground_effect_belongs_to_the_ground_below(void)
{
    start(&calm, &lifting, 1);
    quadrotor_set_origin(quad, 0);
    hold(0.5, 10.0);
    const quadrotor_state_t s = now();
    NEAR(0.03, 0.25, s.height_m);
    const double z = s.height_m + 0.28;
    const double hover = 7.4 * 1.01;
    NEAR(1e-3, 1.0 / (1.0 - 2.0 * pow(0.127 / (4.0 * z), 2.0)),
         lift(&s) / (G * (1.0 + (s.thrust_n - hover) / 7.4)));
}

void test_lift_is_lost_to_the_tilt(void)
{
    calm.attitude_rms_rad = 8.0 * DEG;
    start(&calm, NULL, 3);
    fly(20.0, 11.0);
    double least = 1.0;
    for (int k = 0; k < 3000; k++) {
        fly(0.0136, 7.5);
        const quadrotor_state_t s = now();
        const double tilt = cos(s.roll_rad) * cos(s.pitch_rad);
        NEAR(2e-4, G * s.thrust_n / 7.4 * tilt, lift(&s));
        least = fmin(least, tilt);
    }
    TEST_ASSERT_TRUE(least < 0.97); /* it did tilt */
}

TEST_CASE(-5.0, 7.4)
TEST_CASE(0.0, 7.4)
TEST_CASE(10.0, 7.474)
TEST_CASE(60.0, 7.844)
void test_the_battery_sags_from_the_origin_on(double t_s, double hover_n)
{
    start(&calm, NULL, 1);
    fly(20.0, 9.0);
    quadrotor_set_origin(quad, timeline_now() - (sim_time_t)(t_s * 1e9));
    wait(1 * SIM_MS);
    const quadrotor_state_t s = now();
    NEAR(5e-4, G * (1.0 + (s.thrust_n - hover_n) / 7.4), lift(&s));
}

/* At the same throttle. By the power 2 a tenth of the voltage less is 19 % of the thrust less. */
TEST_CASE(0.0, 0.9, 1.0)
TEST_CASE(1.0, 0.9, 0.9)
TEST_CASE(2.0, 0.9, 0.81)
TEST_CASE(2.0, 1.0, 1.0)
TEST_CASE(2.0, 0.0, 0.0)
void test_the_thrust_falls_with_the_voltage(double power, double volts, double lifts)
{
    quadrotor_config_t drained = calm;
    drained.volts_power = power;
    drained.sag_per_s = 0.0;
    start(&drained, NULL, 1);
    fly(3.0, 9.0);
    NEAR(1e-3, 9.0, now().thrust_n);
    quadrotor_set_volts(quad, volts);
    fly(3.0, 9.0);
    NEAR(1e-3, 9.0 * lifts, now().thrust_n);
}

/* On the other airframe too the thrust goes with the voltage, however it goes with the throttle. */
TEST_CASE(1.0)
TEST_CASE(1.5)
TEST_CASE(2.0)
void test_rotors_carry_less_with_less_voltage(double exponent)
{
    double rest_n[2];

    for (int low = 0; low < 2; low++) {
        quadrotor_config_t drained = calm;
        drained.airframe = 1.0;
        drained.rotors.exponent = exponent;
        drained.volts_power = 2.0;
        drained.sag_per_s = 0.0;
        start(&drained, NULL, 1);
        quadrotor_set_volts(quad, low ? 0.9 : 1.0);
        fly(3.0, 5.0); /* it stays on the ground: no climb changes the thrust */
        TEST_ASSERT_TRUE(now().on_ground);
        rest_n[low] = now().thrust_n;
    }
    NEAR(5e-3, 0.81, rest_n[1] / rest_n[0]);
}

TEST_CASE(9.98, 7.4)
TEST_CASE(10.02, 8.4)
void test_a_load_comes_at_its_time_and_stays(double t_s, double hover_n)
{
    quadrotor_config_t loaded = calm;
    loaded.hover_jump_n = 1.0;
    loaded.sag_per_s = 0.0;
    start(&loaded, NULL, 1);
    fly(20.0, 9.0);
    quadrotor_set_origin(quad, timeline_now() - (sim_time_t)(t_s * 1e9));
    wait(1 * SIM_MS);
    const quadrotor_state_t s = now();
    NEAR(5e-4, G * (1.0 + (s.thrust_n - hover_n) / 7.4), lift(&s));
}

static double mean_of(const double *x, size_t n)
{
    double sum = 0.0;
    for (size_t k = 0; k < n; k++) {
        sum += x[k];
    }
    return sum / (double)n;
}

static double covariance(const double *x, size_t n, size_t lag)
{
    const double mean = mean_of(x, n);
    double sum = 0.0;
    for (size_t k = lag; k < n; k++) {
        sum += (x[k] - mean) * (x[k - lag] - mean);
    }
    return sum / (double)(n - lag);
}

static double kurtosis(const double *x, size_t n)
{
    const double mean = mean_of(x, n), variance = covariance(x, n, 0);
    double sum = 0.0;
    for (size_t k = 0; k < n; k++) {
        sum += pow(x[k] - mean, 4.0);
    }
    return sum / (double)n / (variance * variance);
}

#define SAMPLES 75000U /* 1020 s */
static double record_a[SAMPLES], record_b[SAMPLES];

TEST_CASE(0.2, 0.5)
TEST_CASE(0.4, 0.25)
void test_turbulence_has_its_deviation_and_correlation_time(double rms, double tau)
{
    calm.turbulence_mps2 = rms;
    calm.turbulence_tau_s = tau;
    start(&calm, NULL, 5);
    fly(40.0, 11.0);
    for (size_t k = 0; k < SAMPLES; k++) {
        fly(0.0136, 7.4);
        const quadrotor_state_t s = now();
        record_a[k] = lift(&s) - G * s.thrust_n / 7.4;
    }
    const double variance = covariance(record_a, SAMPLES, 0);
    NEAR(0.05 * rms, rms, sqrt(variance));
    NEAR(0.1 * rms, 0.0, mean_of(record_a, SAMPLES));
    NEAR(0.5, 3.0, kurtosis(record_a, SAMPLES));
    for (size_t lag = 10; lag <= 40; lag += 10) {
        NEAR(0.07, exp(-(double)lag * 0.0136 / tau), covariance(record_a, SAMPLES, lag) / variance);
    }
}

void test_turbulence_is_at_work_from_the_first_step(void)
{
    double square = 0.0;
    calm.turbulence_mps2 = 0.2;
    calm.tau_s = 1e-6;
    calm.actuator_delay_s = 0.0;
    for (unsigned long seed = 0; seed < 400; seed++) {
        start(&calm, NULL, seed);
        quadrotor_pulse(quad, width(11.0));
        wait(500 * SIM_US);
        const quadrotor_state_t s = now();
        TEST_ASSERT_FALSE(s.on_ground);
        square += pow(lift(&s) - G * (s.thrust_n / 7.4) * 1.026395, 2.0) / 400.0;
    }
    NEAR(0.03, 0.2, sqrt(square));
}

static unsigned upward_crossings(const double *x, size_t n)
{
    unsigned crossings = 0;
    for (size_t k = 1; k < n; k++) {
        crossings += x[k - 1] < 0.0 && x[k] >= 0.0;
    }
    return crossings;
}

/* A second order system driven by white noise: Rice's rate of upward crossings is its natural frequency, and
 * its autocorrelation is exp(-z w t) (cos(wd t) + z / sqrt(1 - z^2) sin(wd t)). */
static void expect_swing(const double *x, double rms_rad)
{
    const double w = 2.0 * M_PI * 0.6, z = 0.4, wd = w * sqrt(1.0 - z * z);
    const double variance = covariance(x, SAMPLES, 0);
    NEAR(0.05 * rms_rad, rms_rad, sqrt(variance));
    NEAR(0.1 * rms_rad, 0.0, mean_of(x, SAMPLES));
    NEAR(0.5, 3.0, kurtosis(x, SAMPLES));
    NEAR(0.03, 0.6, upward_crossings(x, SAMPLES) / ((double)SAMPLES * 0.0136));
    for (size_t lag = 15; lag <= 105; lag += 15) {
        const double t = (double)lag * 0.0136;
        const double expected = exp(-z * w * t) * (cos(wd * t) + z / sqrt(1.0 - z * z) * sin(wd * t));
        NEAR(0.08, expected, covariance(x, SAMPLES, lag) / variance);
    }
}

static void record_attitude(double thrust_n)
{
    for (size_t k = 0; k < SAMPLES; k++) {
        fly(0.0136, thrust_n);
        record_a[k] = now().roll_rad;
        record_b[k] = now().pitch_rad;
    }
}

TEST_CASE(2.0)
TEST_CASE(3.0)
void test_roll_and_pitch_swing_as_said_in_the_air(double rms_deg)
{
    calm.attitude_rms_rad = rms_deg * DEG;
    start(&calm, NULL, 7);
    fly(40.0, 11.0);
    record_attitude(7.41);
    TEST_ASSERT_FALSE(now().on_ground);
    expect_swing(record_a, rms_deg * DEG);
    expect_swing(record_b, rms_deg * DEG);
    double cross = 0.0;
    for (size_t k = 0; k < SAMPLES; k++) {
        cross += record_a[k] * record_b[k];
    }
    NEAR(0.1, 0.0, cross / SAMPLES / pow(rms_deg * DEG, 2.0));
}

void test_on_the_ground_the_attitude_shakes_at_fifteen_percent(void)
{
    calm.attitude_rms_rad = 2.0 * DEG;
    start(&calm, NULL, 8);
    fly(5.0, 0.0);
    record_attitude(0.0);
    TEST_ASSERT_TRUE(now().on_ground);
    expect_swing(record_a, 0.3 * DEG);
    expect_swing(record_b, 0.3 * DEG);
}

/* At 0.4 m/s on a course that carries it: the lean that its drag asks for, 0.3 / s: atan(0.12 / g). */
void test_the_nose_goes_down_while_the_vehicle_advances(void)
{
    course_t course = {
        .carried = true, .count = 1, .legs = {{.start_s = 5.0, .x_m = 100.0, .speed_mps = 0.4}}};

    way = &course;
    start(&calm, NULL, 1);
    quadrotor_set_origin(quad, 0);
    fly(4.95, 8.0);
    NEAR(1e-9, 0.0, now().pitch_rad);
    NEAR(1e-9, 0.0, now().x_m);
    fly(5.0, 7.4);
    NEAR(2e-4, -atan(0.12 / G), now().pitch_rad);
    /* the last whole pulse ends up to 14 ms early; 53 mm are lost to taking up speed */
    NEAR(0.01, 0.4 * ((double)timeline_now() * 1e-9 - 5.0) - 0.0533, now().x_m);
}

void test_yaw_drifts_slowly_about_south_and_wraps(void)
{
    start(&calm, NULL, 11);
    fly(40.0, 11.0);
    unsigned positive = 0, negative = 0;
    double before = now().yaw_rad;
    for (int k = 0; k < 20000; k++) {
        fly(0.0136, 7.4);
        const double yaw = now().yaw_rad;
        TEST_ASSERT_TRUE(fabs(yaw) <= M_PI);
        NEAR(10.0 * DEG + 1e-9, 0.0, remainder(yaw - M_PI, 2.0 * M_PI));
        NEAR(2.0 * DEG, 0.0, remainder(yaw - before, 2.0 * M_PI));
        positive += yaw > 0.0;
        negative += yaw < 0.0;
        before = yaw;
    }
    TEST_ASSERT_GREATER_THAN_UINT(1000, positive);
    TEST_ASSERT_GREATER_THAN_UINT(1000, negative);
}

TEST_CASE(0.4, 300.0, 420.0)
TEST_CASE(4.0, 3000.0, 3800.0)
void test_tugs_come_at_their_rate_and_fade(double rate, double least, double most)
{
    calm.tug_rate_per_s = rate;
    start(&calm, NULL, 12);
    fly(40.0, 11.76);
    double before = 0.0;
    unsigned tugs = 0;
    for (int k = 0; k < 1800000; k++) {
        if (k % 27 == 0) {
            quadrotor_pulse(quad, width(7.4 + rate * 0.1359)); /* mean pull: rate x 1.5 x 0.12 s */
        }
        wait(500 * SIM_US);
        const quadrotor_state_t s = now();
        const double pull = lift(&s) - G * s.thrust_n / 7.4;
        if (pull < before - 0.75) {
            tugs++;
            NEAR(2e-4, before * exp(-H / 0.12) - 1.5, pull);
        } else {
            NEAR(2e-4, before * exp(-H / 0.12), pull);
        }
        before = pull;
    }
    TEST_ASSERT_FALSE(now().on_ground);
    NEAR((most - least) / 2.0, (most + least) / 2.0, tugs);
}

static void lift_off_to(double height_m, double thrust_n)
{
    while (now().height_m < height_m) {
        fly(0.0136, thrust_n);
    }
}

void test_each_fall_from_above_thirty_millimetres_is_one_contact(void)
{
    start(&calm, NULL, 1);
    for (unsigned fall = 1; fall <= 3; fall++) {
        lift_off_to(0.3, 9.0);
        fly(3.0, 0.0);
        TEST_ASSERT_TRUE(now().on_ground);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, now().acceleration_mps2);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, now().speed_mps);
        TEST_ASSERT_EQUAL_UINT(fall, now().contacts);
    }
}

void test_a_hop_below_thirty_millimetres_is_no_contact(void)
{
    start(&calm, NULL, 1);
    double highest = 0.0;
    bool flew = false;
    lift_off_to(0.002, 7.6);
    for (int k = 0; k < 100; k++) {
        fly(0.0136, 0.0);
        highest = fmax(highest, now().height_m);
        flew |= !now().on_ground;
    }
    TEST_ASSERT_TRUE(flew);
    TEST_ASSERT_TRUE(highest < 0.03);
    TEST_ASSERT_TRUE(now().on_ground);
    TEST_ASSERT_EQUAL_UINT(0, now().contacts);
}

void test_a_soft_landing_is_no_contact(void)
{
    start(&calm, NULL, 1);
    lift_off_to(0.05, 7.6);
    double reference = now().altitude_m;
    while (!now().on_ground) {
        reference -= 0.005 * 0.0136;
        hold(reference, (double)timeline_now() / 1e9 + 0.0136);
    }
    TEST_ASSERT_EQUAL_UINT(0, now().contacts);
}

void test_the_rebound_keeps_fifteen_percent(void)
{
    start(&calm, NULL, 1);
    lift_off_to(0.5, 9.0);
    quadrotor_state_t before = now(), after = before;
    for (int k = 0; k < 8000; k++) {
        if (k % 20 == 0) {
            quadrotor_pulse(quad, width(0.0));
        }
        wait(500 * SIM_US);
        before = after;
        after = now();
        if (before.speed_mps < -0.5 && after.speed_mps > 0.0) {
            break;
        }
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.0, after.altitude_m);
    TEST_ASSERT_FALSE(after.on_ground);
    NEAR(0.01 * -before.speed_mps, 0.15 * -before.speed_mps, after.speed_mps);
}

void test_after_the_landing_command_no_contact_counts(void)
{
    start(&calm, NULL, 1);
    lift_off_to(0.3, 9.0);
    fly(2.0, 0.0);
    lift_off_to(0.3, 9.0);
    quadrotor_stop_counting_contacts(quad);
    fly(2.0, 0.0);
    TEST_ASSERT_TRUE(now().on_ground);
    lift_off_to(0.3, 9.0);
    fly(2.0, 0.0);
    TEST_ASSERT_EQUAL_UINT(1, now().contacts);
}

void test_the_rising_ramp_carries_a_resting_vehicle_and_the_edge_drops_it(void)
{
    start(&calm, &lifting, 1);
    quadrotor_set_origin(quad, 0);
    while (timeline_now() < (sim_time_t)(10.999e9)) {
        wait(1 * SIM_MS);
        const quadrotor_state_t s = now();
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.height_m);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.speed_mps);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.acceleration_mps2);
        NEAR(1e-9, lifted_m((double)timeline_now() / 1e9), s.altitude_m);
    }
    TEST_ASSERT_EQUAL_UINT(0, now().contacts);
    wait(2 * SIM_MS);
    TEST_ASSERT_FALSE(now().on_ground);
    NEAR(0.001, 0.25, now().height_m);
    wait(1 * SIM_S);
    TEST_ASSERT_TRUE(now().on_ground);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, now().altitude_m);
    TEST_ASSERT_EQUAL_UINT(1, now().contacts);
}

void test_the_ramp_strikes_a_vehicle_that_hovers_too_low(void)
{
    start(&calm, &lifting, 1);
    quadrotor_set_origin(quad, 0);
    hold(0.1, 7.4);
    TEST_ASSERT_EQUAL_UINT(0, now().contacts);
    while (timeline_now() < (sim_time_t)(9e9)) {
        hold(0.1, (double)timeline_now() / 1e9 + 0.0136);
        TEST_ASSERT_TRUE(now().height_m >= 0.0);
    }
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(1, now().contacts);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(3, now().contacts);
}

/* The ramp climbs 0.25 m in 0.7 s. */
void test_the_ramp_throws_off_what_it_strikes(void)
{
    start(&calm, &lifting, 1);
    hold(0.1, 10.0);
    quadrotor_set_origin(quad, timeline_now() - 7300 * SIM_MS);
    quadrotor_state_t before = now(), after = before;
    for (int k = 0; after.contacts == 0; k++) {
        if (k % 20 == 0) {
            quadrotor_pulse(quad, width(7.4));
        }
        wait(500 * SIM_US);
        before = after;
        after = now();
    }
    const double ramp_mps = 0.25 / 0.7;
    NEAR(0.1, 0.0, before.speed_mps);
    NEAR(0.002, ramp_mps + 0.15 * (ramp_mps - before.speed_mps), after.speed_mps);
    TEST_ASSERT_FALSE(after.on_ground);
}

void test_height_is_altitude_above_the_terrain(void)
{
    start(&calm, &lifting, 1);
    quadrotor_set_origin(quad, 0);
    hold(0.6, 7.0);
    while (timeline_now() < (sim_time_t)(12e9)) {
        hold(0.6, (double)timeline_now() / 1e9 + 0.0136);
        const quadrotor_state_t s = now();
        const double step_time = floor((double)timeline_now() / 500000.0) * H;
        NEAR(1e-9, lifted_m(step_time), s.terrain_m);
        NEAR(1e-12, s.altitude_m - s.terrain_m, s.height_m);
        NEAR(0.03, 0.6, s.altitude_m);
    }
}

void test_without_an_origin_the_terrain_waits(void)
{
    start(&calm, &lifting, 1);
    wait(9 * SIM_S);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, now().terrain_m);
    quadrotor_set_origin(quad, timeline_now() - 7200 * SIM_MS);
    wait(1 * SIM_S);
    NEAR(1e-9, 0.25, now().terrain_m);
}

void test_the_anchored_vehicle_stands_still_whatever_the_thrust(void)
{
    quadrotor_config_t bench = quadrotor_default;
    bench.anchored = true;
    bench.bench_height_m = 0.7;
    start(&bench, &lifting, 1);
    NEAR(1e-12, 0.7, now().height_m);
    quadrotor_set_origin(quad, 0);
    for (int k = 0; k < 700; k++) {
        fly(0.0136, k % 2 ? 11.0 : 3.0);
        const quadrotor_state_t s = now();
        TEST_ASSERT_EQUAL_DOUBLE(0.7, s.altitude_m);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.speed_mps);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.acceleration_mps2);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.roll_rad);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, s.pitch_rad);
    }
    NEAR(0.6, 7.0, now().thrust_n);
    NEAR(1e-9, 0.45, now().height_m); /* the platform came below it */
}

void test_who_holds_it_brings_it_where_he_wants_and_lets_it_go(void)
{
    quadrotor_config_t held = quadrotor_default;

    held.anchored = true;
    start(&held, NULL, 1);
    wait(SIM_S);
    held.bench_height_m = 0.5;
    held.bench_roll_rad = 0.2;
    held.bench_pitch_rad = -0.1;
    quadrotor_change(quad, &held);
    wait(SIM_S);
    NEAR(1e-12, 0.5, now().height_m);
    NEAR(1e-12, 0.2, now().roll_rad);
    NEAR(1e-12, -0.1, now().pitch_rad);
    held.anchored = false;
    quadrotor_change(quad, &held);
    wait(3 * SIM_S);
    NEAR(1e-3, 0.0, now().height_m);
    TEST_ASSERT_TRUE(now().on_ground);
}

static quadrotor_state_t flight(const quadrotor_config_t *config, unsigned long seed, sim_time_t query)
{
    start(config, &lifting, seed);
    quadrotor_set_origin(quad, 1 * SIM_S);
    for (int k = 0; k < 1000; k++) {
        for (sim_time_t t = query; query > 0 && t < PWM; t += query) {
            wait(query);
            now();
        }
        wait((k + 1) * PWM - timeline_now());
        quadrotor_pulse(quad, width(7.0 + k % 3));
    }
    return now();
}

static bool same(const quadrotor_state_t *a, const quadrotor_state_t *b)
{
    return a->altitude_m == b->altitude_m && a->speed_mps == b->speed_mps && a->roll_rad == b->roll_rad &&
           a->pitch_rad == b->pitch_rad && a->yaw_rad == b->yaw_rad && a->thrust_n == b->thrust_n &&
           a->acceleration_mps2 == b->acceleration_mps2 && a->contacts == b->contacts;
}

void test_a_seed_repeats_its_flight_however_often_it_is_looked_at(void)
{
    const quadrotor_state_t never = flight(&quadrotor_default, 42, 0);
    const quadrotor_state_t often = flight(&quadrotor_default, 42, 333 * SIM_US);
    const quadrotor_state_t again = flight(&quadrotor_default, 42, 7 * SIM_MS);
    TEST_ASSERT_TRUE(same(&never, &often));
    TEST_ASSERT_TRUE(same(&never, &again));
}

void test_another_seed_flies_another_flight(void)
{
    const quadrotor_state_t a = flight(&quadrotor_default, 42, 0);
    const quadrotor_state_t b = flight(&quadrotor_default, 43, 0);
    TEST_ASSERT_TRUE(a.altitude_m != b.altitude_m);
    TEST_ASSERT_TRUE(a.roll_rad != b.roll_rad);
    TEST_ASSERT_TRUE(a.pitch_rad != b.pitch_rad);
    TEST_ASSERT_TRUE(a.yaw_rad != b.yaw_rad);
    TEST_ASSERT_TRUE(a.roll_rad != a.pitch_rad);
}

void test_every_stream_of_noise_has_its_own_seeds(void)
{
    quadrotor_state_t rest[2];
    for (unsigned long seed = 0; seed < 2; seed++) {
        start(&quadrotor_default, NULL, seed);
        wait(1 * SIM_S);
        rest[seed] = now();
    }
    TEST_ASSERT_TRUE(rest[0].roll_rad != rest[1].roll_rad);
    TEST_ASSERT_TRUE(rest[0].pitch_rad != rest[1].pitch_rad);
}

/* Gravel of healthy.toml: its feet stand on stones. A vehicle that turned there by itself stepped down from
 * each, and its accelerometer told a fall for half a second (gravel/32/EST, seed 2620). */
void test_at_rest_on_gravel_it_neither_turns_nor_falls(void)
{
    place_t rough;
    place_init(&rough);
    for (unsigned long seed = 1; seed <= 20; seed++) {
        place_roughen(&rough, &(place_rough_t){0.011, 0.00134}, seed);
        start(&quadrotor_default, &rough, seed);
        wait(SIM_S / 10);
        const quadrotor_state_t stood = now();
        for (int i = 0; i < 1000; i++) {
            wait(SIM_S / 1000);
            TEST_ASSERT_EQUAL_DOUBLE(0.0, now().acceleration_mps2);
        }
        TEST_ASSERT_EQUAL_DOUBLE(stood.yaw_rad, now().yaw_rad);
        TEST_ASSERT_EQUAL_DOUBLE(stood.altitude_m, now().altitude_m);
    }
}

void test_a_rope_holds_the_vehicle_where_it_is_taut_and_never_pushes_it(void)
{
    calm.rope_m = 0.5;
    start(&calm, NULL, 12);
    fly(4.0, 8.4); /* a newton more than hovers */
    const quadrotor_state_t s = now();
    NEAR(0.01, 0.5 + G * 1.0 / 7.4 / 60.0, s.altitude_m); /* where its pull is the newton's push */
    NEAR(0.02, 0.0, s.speed_mps);
    fly(0.5, 6.9);
    TEST_ASSERT_TRUE(now().altitude_m < 0.5); /* slack: it falls as without */
    TEST_ASSERT_TRUE(now().speed_mps < 0.0);
}

void test_a_rope_from_above_holds_the_vehicle_while_it_is_tied_and_never_pushes_it(void)
{
    calm.hang_m = 0.5;
    calm.hang = (span_t){2.0, 3.0};
    start(&calm, NULL, 12);
    quadrotor_set_origin(quad, 0);
    fly(1.9, 8.4);
    TEST_ASSERT_TRUE(now().altitude_m > 0.6);
    fly(3.0, 6.4); /* a newton less than hovers */
    NEAR(0.01, 0.5 - G * 1.0 / 7.4 / 60.0,
         now().altitude_m); /* where its pull is the newton that is missing */
    NEAR(0.02, 0.0, now().speed_mps);
    fly(0.5, 6.4);
    TEST_ASSERT_TRUE(now().altitude_m < 0.4); /* untied */
    TEST_ASSERT_TRUE(now().speed_mps < -0.2);
}

/* At 0.2 m/s, from where it catches it: it throws nothing up. */
void test_a_hand_lifts_the_vehicle_from_where_it_catches_it(void)
{
    calm.hang_m = 3.0;
    calm.hang = (span_t){1.5, 3.0};
    start(&calm, NULL, 12);
    quadrotor_set_origin(quad, 0);
    fly(1.5, 8.4);
    const double caught_m = now().altitude_m;
    TEST_ASSERT_TRUE(caught_m > 0.2);
    fly(2.5, 6.4);
    NEAR(0.05, caught_m + 0.5 - G * 1.0 / 7.4 / 60.0, now().altitude_m);
    NEAR(0.05, 0.2, now().speed_mps);
}

void test_tugs_leave_the_other_noises_alone(void)
{
    quadrotor_config_t tugged = quadrotor_default;
    tugged.tug_rate_per_s = 0.4;
    const quadrotor_state_t a = flight(&quadrotor_default, 42, 0);
    const quadrotor_state_t b = flight(&tugged, 42, 0);
    TEST_ASSERT_EQUAL_DOUBLE(a.roll_rad, b.roll_rad);
    TEST_ASSERT_EQUAL_DOUBLE(a.pitch_rad, b.pitch_rad);
    TEST_ASSERT_TRUE(a.altitude_m != b.altitude_m);
}

/* ---- an autopilot whose throttle commands a climb rate */

static void start_climb(double rate_mps_per_n)
{
    calm.climb_rate_mps_per_n = rate_mps_per_n;
    start(&calm, NULL, 1);
}

TEST_CASE(1.0, 6.88, 0.53)
TEST_CASE(1.0, 4.88, -0.53)
TEST_CASE(0.5, 6.88, 0.265)
TEST_CASE(2.0, 7.35, 2.0)
TEST_CASE(1.0, 6.45, 0.10)
void test_the_throttle_beyond_its_deadband_commands_the_climb_rate(double rate, double throttle_n,
                                                                   double climb_mps)
{
    start_climb(rate);
    fly(30.0, 8.0);
    fly(4.0, throttle_n);
    NEAR(0.002, climb_mps, now().speed_mps);
}

TEST_CASE(0.8, 2.4, 7.4, 1.0)
TEST_CASE(1.2, 1.5, 5.6, 1.0)
TEST_CASE(1.0, 3.0, 8.8, 1.0)
void test_the_climb_rate_knows_no_weight_drag_and_motors(double gain, double damping, double hover,
                                                         double climb_mps)
{
    calm.gain = gain;
    calm.damping_per_s = damping;
    calm.hover_thrust_n = hover;
    start_climb(1.0);
    fly(20.0, 5.88 + 0.47 + 1.0);
    NEAR(0.005, climb_mps, now().speed_mps);
    fly(6.0, 5.88);
    NEAR(0.005, 0.0, now().speed_mps);
}

void test_within_the_deadband_it_stays_where_it_is(void)
{
    start_climb(1.0);
    fly(6.0, 7.0);
    fly(4.0, 5.88);
    const double height_m = now().height_m;
    for (int k = 0; k < 50; k++) {
        fly(0.3, k % 2 == 0 ? 5.88 + 0.46 : 5.88 - 0.46);
        NEAR(0.002, height_m, now().height_m);
    }
    fly(2.0, 5.88 + 0.50);
    TEST_ASSERT_TRUE(now().height_m > height_m + 0.03);
    fly(4.0, 5.88 - 0.50);
    TEST_ASSERT_TRUE(now().height_m < height_m);
}

/* 63 % of the rate comes after the lag and what the motors and the delay add, 90 % soon after; it hardly
 * overshoots. */
TEST_CASE(0.25, 0.30, 0.40)
TEST_CASE(0.40, 0.44, 0.58)
TEST_CASE(0.15, 0.22, 0.31)
void test_the_climb_rate_is_attained_with_the_lag(double lag, double earliest, double latest)
{
    double attained = NAN, fastest = 0.0;

    calm.climb_lag_s = lag;
    start_climb(1.0);
    fly(6.0, 7.0);
    fly(4.0, 5.88);
    for (int k = 1; k <= 300; k++) {
        fly(0.0136, 6.85);
        const double share = now().speed_mps / 0.5;
        attained = isnan(attained) && share >= 0.632 ? k * 0.0136 : attained;
        fastest = fmax(fastest, share);
    }
    TEST_ASSERT_TRUE_MESSAGE(attained >= earliest && attained <= latest, "63 % too early or too late");
    TEST_ASSERT_TRUE(fastest >= 1.0 && fastest <= 1.2);
}

void test_climb_and_descent_end_at_the_ceiling(void)
{
    calm.climb_ceiling_mps = 0.8;
    start_climb(1.0);
    fly(30.0, 11.0);
    NEAR(0.003, 0.8, now().speed_mps);
    fly(4.0, 0.0);
    NEAR(0.003, -0.8, now().speed_mps);
}

TEST_CASE(0.0)
TEST_CASE(5.88)
TEST_CASE(6.34)
void test_on_the_ground_the_motors_idle_until_a_climb_is_wanted(double throttle_n)
{
    calm.turbulence_mps2 = 0.2;
    start_climb(1.0);
    for (int k = 0; k < 100; k++) {
        fly(0.1, throttle_n);
        TEST_ASSERT_TRUE(now().on_ground);
        TEST_ASSERT_TRUE(now().thrust_n <= 1.0);
    }
    NEAR(0.01, 1.0, now().thrust_n);
    fly(3.0, 6.85);
    TEST_ASSERT_FALSE(now().on_ground);
    TEST_ASSERT_TRUE(now().height_m > 0.5 && now().height_m < 1.5);
}

void test_the_motors_spin_up_before_they_lift(void)
{
    double lifted_s = 0.0;

    start_climb(1.0);
    fly(2.0, 5.88);
    for (; now().on_ground && lifted_s < 5.0; lifted_s += 0.0136) {
        fly(0.0136, 5.88 + 0.47 + 0.3);
    }
    TEST_ASSERT_TRUE(lifted_s > 0.5 && lifted_s < 1.2);
}

void test_a_descent_to_the_ground_ends_with_idle_motors(void)
{
    start_climb(1.0);
    fly(4.0, 6.85);
    fly(15.0, 5.88 - 0.47 - 0.2);
    TEST_ASSERT_TRUE(now().on_ground);
    NEAR(0.01, 1.0, now().thrust_n);
    TEST_ASSERT_EQUAL_UINT(1, now().contacts);
}

/* An autopilot does not drop its vehicle. */
void test_lost_signals_are_a_descent_at_the_ceiling(void)
{
    calm.climb_ceiling_mps = 1.0;
    start_climb(1.0);
    fly(12.0, 7.35);
    wait(5 * SIM_S);
    NEAR(0.01, -1.0, now().speed_mps);
    TEST_ASSERT_TRUE(now().height_m > 1.0);
}

/* ---- the second airframe, and what else may be told ---- */

void test_the_second_airframe_hovers_at_the_hover_thrust_and_climbs_above_it(void)
{
    calm.airframe = 1.0;
    calm.ground_effect = 0.0;
    calm.sag_per_s = 0.0;
    start(&calm, NULL, 1);
    fly(1.0, 7.4 * 1.2);
    TEST_ASSERT_TRUE(now().height_m > 0.3);
    fly(8.0, 7.4);
    NEAR(0.02, 0.0, now().speed_mps);
    NEAR(0.03, 7.4, now().thrust_n);
    fly(2.0, 7.4 * 1.1);
    TEST_ASSERT_TRUE(now().speed_mps > 0.5 && now().speed_mps < 2.5);
    fly(0.7, 0.0);
    TEST_ASSERT_TRUE(now().speed_mps < -2.0 && !now().on_ground);
}

/* In ratios: a tenth more throttle is 1.1 to the power of 1.5, not a tenth more thrust; and its damping is
 * another one. */
void test_the_second_airframe_is_not_the_first(void)
{
    double speed[2];

    for (int airframe = 0; airframe < 2; airframe++) {
        calm.airframe = airframe;
        start(&calm, NULL, 1);
        fly(6.0, 7.4 * 1.1);
        speed[airframe] = now().speed_mps;
    }
    TEST_ASSERT_TRUE(speed[1] > 1.5 * speed[0]);
}

void test_a_second_lag_comes_before_the_motors(void)
{
    calm.anchored = true;
    calm.tau_s = 0.12;
    calm.lag2_s = 0.12;
    start(&calm, NULL, 1);
    fly(2.0, 4.0);
    wait(PWM);
    quadrotor_pulse(quad, width(8.0));
    /* Two equal lags t after the step: 1 - (1 + t / tau) exp(-t / tau); the pulses go on. */
    fly(0.24 + 0.010, 8.0);
    NEAR(0.06, 4.0 + 4.0 * (1.0 - 3.0 * exp(-2.0)), now().thrust_n);
}

void test_ground_effect_can_be_taken_away_and_strengthened(void)
{
    double height_m[3];

    for (int i = 0; i < 3; i++) {
        calm.ground_effect = (double[]){0.0, 1.0, 4.0}[i];
        start(&calm, NULL, 1);
        fly(3.0, 7.5);
        height_m[i] = now().height_m;
    }
    TEST_ASSERT_TRUE(height_m[1] > height_m[0] + 0.01);
    TEST_ASSERT_TRUE(height_m[2] > height_m[1] + 0.03);
}

void test_a_gust_lifts_in_its_time_alone(void)
{
    calm.gust_mps2 = 3.0;
    calm.gust = (span_t){4.0, 0.5};
    calm.ground_effect = 0.0;
    calm.sag_per_s = 0.0;
    start(&calm, NULL, 1);
    quadrotor_set_origin(quad, 0);
    fly(1.0, 8.5);
    fly(2.9, 7.4);
    NEAR(0.05, 0.0, now().speed_mps);
    fly(0.6, 7.4);
    /* 3 / D (1 - exp(-D t)) */
    NEAR(0.08, 3.0 / 2.4 * (1.0 - exp(-2.4 * 0.5)) * exp(-2.4 * 0.02), now().speed_mps);
    fly(3.0, 7.4);
    NEAR(0.05, 0.0, now().speed_mps);
}

void test_a_tumbling_vehicle_turns_at_its_rate_until_it_lies_on_its_back(void)
{
    calm.tumble_radps = 400.0 * DEG;
    calm.tumble_start_s = 3.0;
    start(&calm, NULL, 1);
    quadrotor_set_origin(quad, 0);
    fly(2.9, 9.0);
    NEAR(0.001, 0.0, now().roll_rad);
    wait((sim_time_t)(3.1e9) - timeline_now());
    NEAR(0.01, 40.0 * DEG, now().roll_rad);
    fly(0.5, 9.0);
    NEAR(0.02, M_PI, now().roll_rad);
    TEST_ASSERT_TRUE(now().speed_mps < -2.0);
}

static const course_t along = {.carried = true, .count = 1, .legs = {{.x_m = 1000.0, .speed_mps = 0.4}}};

void test_the_floor_stands_still_under_a_standing_vehicle_and_passes_under_a_flying_one(void)
{
    double lowest_m = 9.0, highest_m = -9.0;
    place_t rough;

    place_init(&rough);
    place_roughen(&rough, &(place_rough_t){0.03, 0.2}, 1);
    way = &along;
    start(&calm, &rough, 1);
    quadrotor_set_origin(quad, 0);
    fly(5.0, 3.0);
    TEST_ASSERT_TRUE(now().on_ground);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, now().x_m);
    const double stood_m = now().terrain_m;
    fly(1.0, 3.0);
    NEAR(2e-3, stood_m, now().terrain_m); /* its yaw wanders, and its feet with it */
    fly(1.0, 8.5);
    for (int i = 0; i < 2000; i++) {
        fly(0.0136, 7.45);
        lowest_m = fmin(lowest_m, now().terrain_m);
        highest_m = fmax(highest_m, now().terrain_m);
        NEAR(1e-9, now().altitude_m - now().terrain_m, now().height_m);
    }
    TEST_ASSERT_TRUE(lowest_m > -0.15 && lowest_m < -0.03);
    TEST_ASSERT_TRUE(highest_m < 0.15 && highest_m > 0.03);
}

/* A course that carries goes on without a vehicle that stands, half a metre at most: it does not race after
 * it. */
void test_a_course_waits_for_a_vehicle_that_stands(void)
{
    way = &along;
    start(&calm, NULL, 1);
    quadrotor_set_origin(quad, 0);
    fly(20.0, 3.0);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, now().x_m);
    fly(3.0, 8.0);
    TEST_ASSERT_TRUE(now().x_m > 0.4 && now().x_m < 0.5 + 3.0 * 0.4);
}

/* Its feet, 0.15 m off the centre, stand on two blocks 6 cm high, the centre over the gap between them. */
void test_what_stands_on_its_feet_is_down_with_its_centre_over_a_gap(void)
{
    place_t blocks;

    place_init(&blocks);
    for (int side = -1; side <= 1; side += 2) {
        place_add(
            &blocks,
            &(place_block_t){
                .x_m = side * 0.15, .length_m = 0.1, .width_m = 1.0, .near_top_m = 0.06, .far_top_m = 0.06});
    }
    start(&calm, &blocks, 1);
    fly(1.0, 9.0);
    TEST_ASSERT_FALSE(now().on_ground);
    fly(4.0, 3.0);
    TEST_ASSERT_TRUE(now().on_ground);
    NEAR(1e-9, 0.06, now().altitude_m);
    NEAR(1e-9, 0.0, now().clearance_m);
    NEAR(1e-9, 0.06, now().height_m);
}

/* A step of the ground is not a speed of it. */
void test_a_bar_lifts_a_low_vehicle_and_does_not_throw_it(void)
{
    double highest_m = 0.0;
    place_t bars;

    place_init(&bars);
    bars.bars = (place_bars_t){.height_m = 0.06, .period_m = 0.16, .share = 0.3, .from_m = 0.5};
    way = &along;
    start(&calm, &bars, 1);
    quadrotor_set_origin(quad, 0);
    fly(0.6, 7.6);
    for (int i = 0; i < 400; i++) {
        fly(0.0136, 7.0);
        highest_m = fmax(highest_m, now().altitude_m);
    }
    TEST_ASSERT_TRUE(highest_m < 0.12);
    TEST_ASSERT_TRUE(now().on_ground);
}

/* It gives no more than half of the speed with which the vehicle moves onto it, and 15 % for the rebound. */
void test_a_floor_however_rough_throws_nothing_up_faster_than_it_came(void)
{
    double fastest_mps = 0.0;
    place_t rough;

    place_init(&rough);
    place_roughen(&rough, &(place_rough_t){0.06, 0.016}, 1);
    way = &along;
    start(&calm, &rough, 1);
    quadrotor_set_origin(quad, 0);
    fly(0.7, 7.6);
    for (int i = 0; i < 400; i++) {
        fly(0.0136, 7.3);
        const quadrotor_state_t s = now();
        fastest_mps = fmax(fastest_mps, s.speed_mps);
    }
    TEST_ASSERT_TRUE(now().x_m > 0.5);
    TEST_ASSERT_TRUE(fastest_mps > 0.0 && fastest_mps < 0.9);
}

void test_a_vehicle_and_its_ground_change_in_flight_and_it_flies_on_from_where_it_is(void)
{
    place_t floor;

    place_init(&floor);
    start(&calm, &floor, 1);
    hold(0.6, 10.0);
    const quadrotor_state_t before = now();
    quadrotor_set_origin(quad, 0);
    calm.hover_thrust_n = 8.4;
    quadrotor_change(quad, &calm);
    TEST_ASSERT_TRUE(place_add(
        &floor, &(place_block_t){.length_m = 9.0, .width_m = 9.0, .near_top_m = 0.25, .far_top_m = 0.25}));
    TEST_ASSERT_EQUAL_DOUBLE(before.altitude_m, now().altitude_m);
    TEST_ASSERT_EQUAL_DOUBLE(before.speed_mps, now().speed_mps);
    fly(0.1, 7.4);
    NEAR(1e-9, 0.25, now().terrain_m);
    NEAR(0.1, -G / 8.4 - 2.4 * now().speed_mps, now().acceleration_mps2);
}
