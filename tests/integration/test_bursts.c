/* Whatever is typed in the air, a hover loses 0.1 m at most: bursts of lines for every parameter, in both
 * directions, as many as the radio carries, with each law. A burst knows the value in force, and asks for as
 * much of the way to the limit as the firmware takes.
 *
 * A mixed burst asks for a drawn parameter with each line.
 *
 * BURSTS_SEEDS flights for each parameter, law and direction, and ten mixed ones for each law; without it one
 * flight for each parameter and direction, with one law after the other. BURSTS_FIRST: the first seed; "new"
 * draws it. */
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
#define HOVERS_S 12 /* after the reference */
#define BURST_S 2
#define WATCHED_S 12 /* from the burst's first line on */
#define LINES_PER_S 20
#define COST_M 0.1

typedef struct {
    unsigned long seed;
    const char *law;
    parameter_id_t id; /* PARAMETER_COUNT: mixed */
    int way;           /* 1: to the limit above, -1: below; 0: no burst */
    unsigned long mix;
} burst_t;

typedef struct {
    double low_m, high_m;
    float from, to; /* the value in force, before and after */
    flight_state_t state;
} seen_t;

static unsigned long seeds, first_seed;
static const char *const laws[] = {"EST", "PID", "PIDT", "PD"};
#define LAW_COUNT (sizeof laws / sizeof laws[0])

static unsigned long drawn_seed(void)
{
    const char *given = getenv("SOAK_SEED");
    const unsigned long seed = given != NULL ? strtoul(given, NULL, 10)
                                             : (unsigned long)time(NULL) % 1000000UL;

    printf("SOAK_SEED=%lu repeats this run\n", seed);
    return 100UL * seed;
}

void setUp(void)
{
    const char *count = getenv("BURSTS_SEEDS"), *first = getenv("BURSTS_FIRST");

    seeds = count != NULL ? strtoul(count, NULL, 10) : 0UL;
    first_seed = first == NULL ? 1UL : strcmp(first, "new") == 0 ? drawn_seed() : strtoul(first, NULL, 10);
}

void tearDown(void) {}

static void type(const char *name, const char *value)
{
    char line[48];

    board_type(line, (size_t)snprintf(line, sizeof line, "#%s %s\n", name, value));
}

static noise_t noise;

static int below(int count)
{
    return (int)noise_uniform(&noise, 0.0, (double)count - 1e-9);
}

/* #LINK and #SUM together lock the operator out, and the vehicle lands as ordered. */
static burst_t drawn(const burst_t *burst)
{
    burst_t one = *burst;

    do {
        one.id = (parameter_id_t)below(PARAMETER_COUNT);
    } while (one.id == PARAMETER_LINK || one.id == PARAMETER_SUM);
    one.way = below(2) == 0 ? 1 : -1;
    return one;
}

/* The whole way to the limit first, then less and less of it. */
static void ask(const burst_t *order, int number)
{
    static const double shares[] = {1.0, 0.5, 0.25, 0.1, 0.05, 0.02};
    const burst_t one = order->id == PARAMETER_COUNT ? drawn(order) : *order;
    const burst_t *burst = &one;
    const parameter_row_t *row = &parameter_table[burst->id];
    const double now = (double)probe_parameters->value[burst->id];
    const double limit = (double)(burst->way > 0 ? row->maximum : row->minimum);
    char value[16];

    if (row->choices != NULL) { /* every choice, up or down */
        const int count = (int)row->maximum + 1;
        const int choice = burst->way > 0 ? number % count : count - 1 - number % count;

        type(row->name, row->choices[choice]);
    } else {
        snprintf(value, sizeof value, "%.6f",
                 now + (limit - now) * shares[order->id == PARAMETER_COUNT ? below(6) : number % 6]);
        type(row->name, value);
    }
}

static void watch(const burst_t *burst, seen_t *seen)
{
    for (int i = 0; i < WATCHED_S * STEPS_PER_S; i++) {
        if (burst->way != 0 && i < BURST_S * STEPS_PER_S && i % (STEPS_PER_S / LINES_PER_S) == 0) {
            ask(burst, i / (STEPS_PER_S / LINES_PER_S));
        } else if (i % STEPS_PER_S == 50) {
            type("PING", "1"); /* the operator is there: #LINK lands without him */
        }
        (void)kernel_run_until(timeline_now() + STEP);
        const double height_m = quadrotor_state(board_quadrotor())->height_m;

        seen->low_m = fmin(seen->low_m, height_m);
        seen->high_m = fmax(seen->high_m, height_m);
    }
}

static void fly(void *argument, void *result)
{
    const burst_t *burst = argument;
    seen_t *seen = result;
    board_config_t config = board_config(burst->seed);

    noise_init(&noise, burst->seed * 100UL + burst->mix, "bursts");
    board_power_on(&config, NULL, NULL);
    (void)kernel_run_until(13 * SIM_S);
    type("LAW", burst->law);
    (void)kernel_run_until(timeline_now() + 500 * SIM_MS);
    type("SETR", "0.8");
    (void)kernel_run_until(timeline_now() + HOVERS_S * SIM_S);
    const parameter_id_t id = burst->id == PARAMETER_COUNT ? PARAMETER_LAW : burst->id;
    *seen = (seen_t){.low_m = 9.0, .from = probe_parameters->value[id]};
    watch(burst, seen);
    seen->to = probe_parameters->value[id];
    seen->state = probe_flight->state;
}

static seen_t flown(burst_t burst)
{
    seen_t seen = {0};

    child_run(fly, &burst, &seen, sizeof seen);
    return seen;
}

static unsigned dear; /* bursts that cost more */
static double dearest_m;

/* The burst may leave another law, which hovers in its own way. */
static void compare(burst_t burst, const seen_t *hover)
{
    const seen_t seen = flown(burst);
    seen_t without = *hover;
    const seen_t *quiet = &without;

    if (burst.id == PARAMETER_LAW || burst.id == PARAMETER_COUNT) {
        const char *law = parameter_table[PARAMETER_LAW].choices[(int)seen.to];
        const seen_t other = flown((burst_t){.seed = burst.seed, .law = law});

        without.low_m = fmin(without.low_m, other.low_m);
        without.high_m = fmax(without.high_m, other.high_m);
    }
    const double cost_m = fmax(quiet->low_m - seen.low_m, seen.high_m - quiet->high_m);

    dearest_m = fmax(dearest_m, cost_m);
    if (cost_m > COST_M || seen.state != quiet->state) {
        dear++;
        printf("LAW %s seed %lu: %s %lu from %g to %g costs %.2f m: %.2f to %.2f m, %.2f to %.2f m without "
               "it, %s\n",
               burst.law, burst.seed,
               burst.id == PARAMETER_COUNT ? "LAW, mixed" : parameter_table[burst.id].name, burst.mix,
               (double)seen.from, (double)seen.to, cost_m, seen.low_m, seen.high_m, quiet->low_m,
               quiet->high_m, flight_state_name(seen.state));
    }
}

static void bursts_of(const char *law, unsigned long seed, unsigned first, unsigned every)
{
    const seen_t quiet = flown((burst_t){.seed = seed, .law = law});

    TEST_ASSERT_EQUAL(FLIGHT_FLYING, quiet.state);
    for (unsigned id = first; id < PARAMETER_COUNT; id += every) {
        compare((burst_t){.seed = seed, .law = law, .id = (parameter_id_t)id, .way = 1}, &quiet);
        compare((burst_t){.seed = seed, .law = law, .id = (parameter_id_t)id, .way = -1}, &quiet);
    }
    for (unsigned long mix = 0; mix < 10UL; mix += every) {
        compare((burst_t){.seed = seed, .law = law, .id = PARAMETER_COUNT, .way = 1, .mix = mix}, &quiet);
    }
}

void test_a_burst_of_lines_costs_a_hover_a_tenth_of_a_metre_at_most(void)
{
    if (seeds == 0UL) {
        for (unsigned i = 0; i < LAW_COUNT; i++) {
            bursts_of(laws[i], first_seed + i, i, LAW_COUNT);
        }
    }
    for (unsigned long seed = first_seed; seed < first_seed + seeds; seed++) {
        for (unsigned i = 0; i < LAW_COUNT; i++) {
            bursts_of(laws[i], seed, 0U, 1U);
        }
    }
    printf("from BURSTS_FIRST=%lu on: the dearest burst costs %.3f m, %u more than %.1f m\n", first_seed,
           dearest_m, dear, COST_M);
    TEST_ASSERT_EQUAL_UINT(0U, dear);
}
