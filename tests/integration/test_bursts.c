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

static void hover(const burst_t *burst)
{
    board_config_t config = board_config(burst->seed);

    board_power_on(&config, NULL, NULL);
    (void)kernel_run_until(13 * SIM_S);
    type("LAW", burst->law);
    (void)kernel_run_until(timeline_now() + 500 * SIM_MS);
    type("SETR", "0.8");
    (void)kernel_run_until(timeline_now() + HOVERS_S * SIM_S);
}

/* From a hover on, in a process of its own: each burst meets the same hover, which is flown once. */
static void go_on(void *argument, void *result)
{
    const burst_t *burst = argument;
    seen_t *seen = result;
    const parameter_id_t id = burst->id == PARAMETER_COUNT ? PARAMETER_LAW : burst->id;

    noise_init(&noise, burst->seed * 100UL + burst->mix, "bursts");
    *seen = (seen_t){.low_m = 9.0, .from = probe_parameters->value[id]};
    watch(burst, seen);
    seen->to = probe_parameters->value[id];
    seen->state = probe_flight->state;
}

static void fly(void *argument, void *result)
{
    hover(argument);
    go_on(argument, result);
}

static seen_t quiet[LAW_COUNT]; /* by law, without a burst */

static const seen_t *quiet_by(const char *law)
{
    for (size_t i = 0; i < LAW_COUNT; i++) {
        if (strcmp(laws[i], law) == 0) {
            return &quiet[i];
        }
    }
    TEST_FAIL_MESSAGE(law);
    return NULL;
}

typedef struct {
    unsigned dear; /* bursts that cost more */
    double dearest_m;
} cost_t;

/* The burst may leave another law, which hovers in its own way. */
static void compare(burst_t burst, cost_t *cost)
{
    seen_t without = *quiet_by(burst.law), seen = {0};

    child_run(go_on, &burst, &seen, sizeof seen);
    if (burst.id == PARAMETER_LAW || burst.id == PARAMETER_COUNT) {
        const seen_t *other = quiet_by(parameter_table[PARAMETER_LAW].choices[(int)seen.to]);

        without.low_m = fmin(without.low_m, other->low_m);
        without.high_m = fmax(without.high_m, other->high_m);
    }
    const double cost_m = fmax(without.low_m - seen.low_m, seen.high_m - without.high_m);

    cost->dearest_m = fmax(cost->dearest_m, cost_m);
    if (cost_m > COST_M || seen.state != without.state) {
        cost->dear++;
        printf("LAW %s seed %lu: %s %lu from %g to %g costs %.2f m: %.2f to %.2f m, %.2f to %.2f m without "
               "it, %s\n",
               burst.law, burst.seed,
               burst.id == PARAMETER_COUNT ? "LAW, mixed" : parameter_table[burst.id].name, burst.mix,
               (double)seen.from, (double)seen.to, cost_m, seen.low_m, seen.high_m, without.low_m,
               without.high_m, flight_state_name(seen.state));
    }
}

typedef struct {
    unsigned long seed;
    const char *law;
    unsigned first, every; /* of the parameters */
} share_t;

static void bursts_of(void *argument, void *result)
{
    const share_t *share = argument;
    burst_t burst = {.seed = share->seed, .law = share->law};

    hover(&burst);
    for (unsigned id = share->first; id < PARAMETER_COUNT; id += share->every) {
        burst.id = (parameter_id_t)id;
        for (burst.way = 1; burst.way >= -1; burst.way -= 2) {
            compare(burst, result);
        }
    }
    burst.id = PARAMETER_COUNT;
    burst.way = 1;
    for (burst.mix = 0; burst.mix < 10UL; burst.mix += share->every) {
        compare(burst, result);
    }
}

static void without_bursts(unsigned long seed)
{
    for (size_t i = 0; i < LAW_COUNT; i++) {
        burst_t none = {.seed = seed, .law = laws[i]};

        child_run(fly, &none, &quiet[i], sizeof quiet[i]);
        TEST_ASSERT_EQUAL(FLIGHT_FLYING, quiet[i].state);
    }
}

void test_a_burst_of_lines_costs_a_hover_a_tenth_of_a_metre_at_most(void)
{
    const unsigned every = seeds == 0UL ? LAW_COUNT : 1U;
    const unsigned long last_seed = first_seed + (seeds == 0UL ? 1UL : seeds);
    cost_t all = {0};

    for (unsigned long seed = first_seed; seed < last_seed; seed++) {
        without_bursts(seed);
        for (unsigned i = 0; i < LAW_COUNT; i++) {
            share_t share = {seed, laws[i], i % every, every};
            cost_t cost = {0};

            child_run(bursts_of, &share, &cost, sizeof cost);
            all.dear += cost.dear;
            all.dearest_m = fmax(all.dearest_m, cost.dearest_m);
        }
    }
    printf("from BURSTS_FIRST=%lu on: the dearest burst costs %.3f m, %u more than %.1f m\n", first_seed,
           all.dearest_m, all.dear, COST_M);
    TEST_ASSERT_EQUAL_UINT(0U, all.dear);
}
