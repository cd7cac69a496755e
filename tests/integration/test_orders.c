/* Nothing moves without an order: since power-on and after every landing no thrust above the armed idle,
 * however the vehicle is rocked, whatever its sensors miss, and whatever the selector's pin says.
 *
 * Vehicles are drawn, ORDERS_VEHICLES of them, from ORDERS_SEED on; "new" draws that seed too, as each run of
 * the soak does, and SOAK_SEED repeats that run. A failure names the seed: ORDERS_SEED=N ORDERS_VEHICLES=1
 * repeats it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "child.h"
#include "firmware/probe.h"
#include "sim/noise.h"
#include "unity.h"

#define STEP (10 * SIM_MS)
#define STEPS_PER_S 100
#define ABOVE_N 0.001
#define ROCKED_S 40 /* before the order */
#define AFTER_S 25  /* a landing */

typedef enum { SIGHT_SEEN, SIGHT_NEVER, SIGHT_NOW_AND_THEN, SIGHTS } sight_t;
typedef enum { PIN_HONEST, PIN_SAYS_PILOT, PIN_LOOSE, PIN_SWITCHED, PINS } pin_t;
typedef enum { IMU_WELL, IMU_GAPS, IMU_SPIKES, IMU_GARBLED, IMUS } imu_t;

typedef struct {
    unsigned long seed;
    double rms_rad, period_s, hover_n, airframe;
    sight_t sight;
    pin_t pin;
    imu_t imu;
    bool selects; /* SEL PIN */
    bool arms;
    bool stands; /* still for a second at power-on; else it is in a moving hand */
    const char *law;
} vehicle_t;

typedef struct {
    double most_n, after_n; /* above the idle: before the order, and after the landing */
    flight_state_t state;   /* at the first thrust that was not ordered */
    double at_s;
    bool flew, landed;
    double highest_m; /* as measured */
} seen_t;

static const span_t for_good = {SPAN_POWER_ON_S, SPAN_FOR_GOOD_S};

static unsigned vehicles;
static unsigned long first_seed;

static unsigned long drawn_seed(void)
{
    const char *given = getenv("SOAK_SEED");
    const unsigned long seed = given != NULL ? strtoul(given, NULL, 10)
                                             : (unsigned long)time(NULL) % 1000000UL;

    printf("SOAK_SEED=%lu repeats this run\n", seed);
    return 1000UL * seed;
}

void setUp(void)
{
    const char *count = getenv("ORDERS_VEHICLES"), *seed = getenv("ORDERS_SEED");

    vehicles = count != NULL ? (unsigned)strtoul(count, NULL, 10) : 30U;
    first_seed = seed == NULL ? 1UL : strcmp(seed, "new") == 0 ? drawn_seed() : strtoul(seed, NULL, 10);
}

void tearDown(void) {}

static unsigned one_of(noise_t *noise, unsigned count)
{
    return (unsigned)noise_uniform(noise, 0.0, (double)count - 1e-9);
}

static vehicle_t draw(unsigned long seed)
{
    static const char *const laws[] = {"EST", "PID", "PIDT", "PD"};
    noise_t noise;

    noise_init(&noise, seed, "orders");
    vehicle_t v = {.seed = seed,
                   .rms_rad = noise_uniform(&noise, 0.02, 0.3),
                   .period_s = 0.3 * pow(10.0 / 0.3, noise_uniform(&noise, 0.0, 1.0)),
                   .hover_n = noise_uniform(&noise, 5.0, 7.8),
                   .airframe = one_of(&noise, 2),
                   .sight = (sight_t)one_of(&noise, SIGHTS),
                   .pin = (pin_t)one_of(&noise, PINS),
                   .imu = (imu_t)one_of(&noise, IMUS),
                   .selects = one_of(&noise, 2) == 1U,
                   .stands = one_of(&noise, 2) == 1U,
                   .law = laws[one_of(&noise, 4)]};
    /* #ARM and then a hand-over is an order. Without a pin and without heights nothing tells a hand-over
     * from a vehicle that somebody rocks, so an armed one is not asked. */
    const bool hands_over = v.selects ? v.pin != PIN_HONEST : v.sight != SIGHT_SEEN;
    v.arms = one_of(&noise, 2) == 1U && !hands_over;
    return v;
}

static board_config_t rocked(const vehicle_t *v)
{
    board_config_t config = board_config(v->seed);

    config.quadrotor.airframe = v->airframe;
    config.quadrotor.hover_thrust_n = v->hover_n;
    config.quadrotor.attitude_rms_rad = v->rms_rad;
    config.quadrotor.attitude_hz = 1.0 / v->period_s;
    config.quadrotor.ground_sway = 1.0;
    config.imu.spike_probability = v->imu == IMU_SPIKES ? 0.05 : config.imu.spike_probability;
    config.imu.garbled = v->imu == IMU_GARBLED ? for_good : config.imu.garbled;
    config.scene.rays_lost = v->sight == SIGHT_NEVER ? 1.0 : 0.0;
    config.scene.rays_lost_span = for_good;
    return config;
}

static board_config_t calm(const vehicle_t *v)
{
    board_config_t config = board_config(v->seed);

    config.quadrotor.airframe = v->airframe;
    config.quadrotor.hover_thrust_n = v->hover_n;
    return config;
}

static void type(const char *line)
{
    board_type(line, strlen(line));
}

/* What goes wrong in the next second. */
static void trouble(const vehicle_t *v, noise_t *noise)
{
    const bool first = one_of(noise, 2) == 1U;

    if (v->imu == IMU_GAPS) {
        board_power_imu(one_of(noise, 3) > 0U);
    }
    if (v->sight == SIGHT_NOW_AND_THEN) {
        board_config_t config = rocked(v);

        config.scene.rays_lost = first ? 1.0 : 0.0;
        board_change(&config);
    }
    if (v->pin == PIN_LOOSE) {
        board_pin(first ? BOARD_PIN_PILOT : BOARD_PIN_FIRMWARE);
    } else if (v->pin == PIN_SWITCHED) {
        board_select(first);
    }
}

static void look(double *most_n, seen_t *seen)
{
    const double above_n = (double)(probe_flight->thrust_n - probe_flight->idle_n);

    if (above_n > ABOVE_N && seen->at_s == 0.0) {
        seen->at_s = (double)timeline_now() / 1e9;
        seen->state = probe_flight->state;
    }
    *most_n = fmax(*most_n, above_n);
}

static void rock(const vehicle_t *v, noise_t *noise, int seconds, double *most_n, seen_t *seen)
{
    const board_config_t config = rocked(v);

    board_change(&config);
    for (int i = 0; i < seconds * STEPS_PER_S; i++) {
        if (i % STEPS_PER_S == 0) {
            trouble(v, noise);
        }
        if (v->arms && i == 16 * STEPS_PER_S) {
            type("#ARM\n");
        }
        (void)kernel_run_until(timeline_now() + STEP);
        look(most_n, seen);
    }
}

/* The means of the IMU's angles forget a garbled line with a time constant of 2 s (REST_TIME_S). */
static void calm_down(const vehicle_t *v)
{
    const board_config_t config = calm(v);

    board_change(&config);
    board_power_imu(true);
    board_pin(BOARD_PIN_HONEST);
    board_select(true);
    (void)kernel_run_until(timeline_now() + 8 * SIM_S);
}

static void fly_and_land(seen_t *seen)
{
    type("#SETR 0.5\n");
    for (int i = 0; i < 10 * STEPS_PER_S; i++) {
        (void)kernel_run_until(timeline_now() + STEP);
        seen->flew = seen->flew || quadrotor_state(board_quadrotor())->height_m > 0.3;
    }
    type("#SETR 0\n");
    for (int i = 0; i < 40 * STEPS_PER_S && !seen->landed; i++) {
        (void)kernel_run_until(timeline_now() + STEP);
        seen->landed = probe_flight->state == FLIGHT_GROUND;
    }
}

static void live(void *argument, void *result)
{
    const vehicle_t *v = argument;
    seen_t *seen = result;
    const board_config_t config = v->stands ? calm(v) : rocked(v);
    char settings[64];
    noise_t noise;

    noise_init(&noise, v->seed, "troubles");
    board_power_on(&config, NULL, NULL);
    quadrotor_set_origin(board_quadrotor(), 0); /* what goes wrong goes by its time */
    board_pin(v->pin == PIN_SAYS_PILOT ? BOARD_PIN_PILOT : BOARD_PIN_HONEST);
    (void)kernel_run_until(v->stands ? 1500 * SIM_MS : 300 * SIM_MS);
    snprintf(settings, sizeof settings, "#SEL %s\n#LAW %s\n", v->selects ? "PIN" : "NONE", v->law);
    type(settings);
    rock(v, &noise, ROCKED_S, &seen->most_n, seen);
    if (v->stands) {
        calm_down(v);
        fly_and_land(seen);
    }
    if (seen->landed) {
        rock(v, &noise, AFTER_S, &seen->after_n, seen);
    }
}

typedef struct {
    unsigned long seed;
    double edge_m;  /* the beam looks past the edge of what the vehicle stands on */
    double hand_mm; /* 0: none; else a hand passes below the mirror, for three seconds of five */
} stand_t;

/* It stands still, not armed, for a minute. */
static void stand(void *argument, void *result)
{
    const stand_t *order = argument;
    board_config_t config = board_config(order->seed);
    seen_t *seen = result;

    config.quadrotor.hover_thrust_n = 5.9;
    config.scene.edge_m = order->edge_m;
    config.scene.edge_start_s = SPAN_POWER_ON_S;
    board_power_on(&config, NULL, NULL);
    quadrotor_set_origin(board_quadrotor(), 0); /* what goes wrong goes by its time */
    for (int i = 0; i < 60 * STEPS_PER_S; i++) {
        config.scene.sight_blocked = order->hand_mm > 0.0 && i % 500 < 300 ? 1.0 : 0.0;
        config.scene.sight_blocked_span = for_good;
        config.scene.block_mm = order->hand_mm;
        board_change(&config);
        (void)kernel_run_until(timeline_now() + STEP);
        seen->highest_m = fmax(seen->highest_m, (double)probe_altitude->altitude.height_mm * 0.001);
        look(&seen->most_n, seen);
    }
}

void test_heights_alone_start_no_motor_of_a_vehicle_that_stands(void)
{
    static const stand_t stands[] = {{1, -0.4, 0.0}, {2, -1.5, 0.0}, {3, 0.0, 450.0}, {4, 0.0, 700.0}};

    for (unsigned i = 0; i < sizeof stands / sizeof stands[0]; i++) {
        stand_t order = stands[i];
        seen_t seen = {0};

        child_run(stand, &order, &seen, sizeof seen);
        TEST_ASSERT_TRUE(seen.highest_m > 0.15);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, seen.most_n);
    }
}

static void report(const vehicle_t *v, const seen_t *seen)
{
    static const char *const sights[] = {"heights", "no heights", "heights now and then"};
    static const char *const pins[] = {"honest pin", "pin stuck at pilot", "loose pin", "switched"};
    static const char *const imus[] = {"IMU well", "IMU gaps", "IMU spikes", "IMU garbled"};

    printf(
        "ORDERS_SEED=%lu: %.2f N and %.2f N after a landing, %s at %.1f s: tilt %.3f rad %.2f s, %s, SEL %s "
        "%s, %s, %s, LAW %s\n",
        v->seed, seen->most_n, seen->after_n, flight_state_name(seen->state), seen->at_s, v->rms_rad,
        v->period_s, sights[v->sight], v->selects ? "PIN" : "NONE", pins[v->pin], imus[v->imu],
        v->arms ? "armed" : "not armed", v->law);
}

void test_no_drawn_vehicle_has_thrust_above_the_idle_without_an_order(void)
{
    unsigned moved = 0, planned = 0, landed = 0, armed = 0;

    printf("%u vehicles from ORDERS_SEED=%lu on\n", vehicles, first_seed);
    for (unsigned i = 0; i < vehicles; i++) {
        vehicle_t v = draw(first_seed + i);
        seen_t seen = {0};

        child_run(live, &v, &seen, sizeof seen);
        planned += v.stands;
        landed += seen.flew && seen.landed;
        armed += v.arms;
        if (seen.at_s > 0.0) {
            moved++;
            report(&v, &seen);
        }
    }
    printf("%u of %u had thrust without an order; %u armed; %u of %u flew and landed by order\n", moved,
           vehicles, armed, landed, planned);
    TEST_ASSERT_EQUAL_UINT(0U, moved);
    TEST_ASSERT_TRUE(landed >= planned - planned / 10U); /* else the second half asked nothing */
}
