/* An autopilot whose throttle commands a climb rate: how well law EST flies it, how wrong CRATE, GRAV and
 * PLANT may be, and the two tests that tell which autopilot one has. The figures of docs/control.md, "What
 * does the throttle command?", are the bounds of these tests, of means over pinned seeds. How often a flight
 * keeps what is required, over seeds drawn anew, is asked by test_rates.py. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "child.h"
#include "unity.h"

#define SEEDS 20
#define ROWS 4000

void setUp(void) {}
void tearDown(void) {}

/* ---- many flights */

static double mean[METRIC_COUNT], least[METRIC_COUNT], most[METRIC_COUNT];
static int failures;

static void fly_seeds(const char *scenario, const char *const *assignments, unsigned long seeds)
{
    static flight_result_t result;

    failures = 0;
    for (int i = 0; i < METRIC_COUNT; i++) {
        mean[i] = 0.0;
        least[i] = INFINITY;
        most[i] = -INFINITY;
    }
    for (unsigned long seed = 1; seed <= seeds; seed++) {
        child_fly(scenario, seed, assignments, &result);
        TEST_ASSERT_NULL(result.halt);
        failures += result.metrics.failed;
        for (int i = 0; i < METRIC_COUNT; i++) {
            mean[i] += result.metrics.value[i] / (double)seeds;
            least[i] = fmin(least[i], result.metrics.value[i]);
            most[i] = fmax(most[i], result.metrics.value[i]);
        }
    }
    printf("%s %s %s:", scenario, assignments[0] != NULL ? assignments[0] : "",
           assignments[0] != NULL && assignments[1] != NULL ? assignments[1] : "");
    for (int i = 0; i < METRIC_COUNT; i++) {
        printf(" %s %.3g [%.3g..%.3g]", metric_names[i], mean[i], least[i], most[i]);
    }
    printf(" failures %d\n", failures);
}

static void between(double minimum, double maximum, double actual, const char *what)
{
    char message[96];

    snprintf(message, sizeof message, "%s: %.4g, expected %.4g to %.4g", what, actual, minimum, maximum);
    TEST_ASSERT_TRUE_MESSAGE(actual >= minimum && actual <= maximum, message);
}

/* A flight's --set texts, and the bounds of what is looked at. */
typedef struct {
    const char *first, *second;
    double least, most;
} case_t;
#define COUNT(cases) (sizeof(cases) / sizeof(cases)[0])

static void never_dangerous(void)
{
    between(-INFINITY, 1200.0, most[METRIC_HIGHEST_MM], "highest above the reference");
    between(0.0, 0.0, most[METRIC_CUTS], "cuts");
    between(0.05, 0.5, most[METRIC_TOUCH_SPEED_MPS], "hardest touch");
}

static void no_incident(void)
{
    never_dangerous();
    TEST_ASSERT_EQUAL_INT(0, failures);
    between(0.0, 0.0, most[METRIC_TAKEOVERS], "take-overs");
    between(0.0, 0.0, most[METRIC_GROUND_CONTACTS], "contacts");
}

static const char *const nothing[] = {NULL};

void test_twenty_flights_are_as_good_as_with_thrust(void)
{
    fly_seeds("climb-rate", nothing, SEEDS);
    no_incident();
    between(0.65, 0.90, mean[METRIC_RISE_TIME_S], "rise");
    between(15.0, 38.0, mean[METRIC_OVERSHOOT_MM], "overshoot");
    between(8.0, 12.0, mean[METRIC_HOVER_RMS_MM], "hover RMS");
    between(-3.0, 5.0, mean[METRIC_HOVER_MEAN_ERROR_MM], "mean error");
    between(65.0, 76.0, mean[METRIC_TERRAIN_RMS_MM], "terrain RMS");
    between(0.55, 0.85, mean[METRIC_RECOVERY_S], "recovery");
    between(8.0, 26.0, mean[METRIC_UNDERSHOOT_MM], "undershoot");
    between(0.35, 0.6, mean[METRIC_THRUST_STD_N], "activity");
}

void test_wrong_figures_are_borne(void)
{
    static const case_t cases[] = {
        {"plant.climb_deadband=0", NULL, 6.0, 11.0},
        {"plant.climb_deadband=1", NULL, 9.0, 18.0},
        {"CRATE=1.6", NULL, 8.0, 14.0},
        {"CRATE=0.625", NULL, 8.0, 14.0},
        {"CRATE=0.53", NULL, 8.0, 14.0},
        {"plant.tdelay=0.03", NULL, 8.0, 15.0},
        {"plant.climb_lag=0.4", NULL, 8.0, 16.0},
        {"plant.climb_lag=0.15", NULL, 8.0, 14.0},
        {"plant.hover_thrust=8.8", NULL, 8.0, 15.0},
        {"GRAV=6.2", NULL, 8.0, 19.0},
        {"GRAV=5.56", NULL, 8.0, 14.0},
    };

    for (size_t i = 0; i < COUNT(cases); i++) {
        const char *const assignments[] = {cases[i].first, NULL};

        fly_seeds("climb-rate", assignments, 10);
        no_incident();
        between(cases[i].least, cases[i].most, mean[METRIC_HOVER_RMS_MM], "hover RMS");
        between(60.0, 90.0, mean[METRIC_TERRAIN_RMS_MM], "terrain RMS");
    }
}

/* ---- the wrong PLANT */

void test_thrust_set_on_a_climb_rate_flies(void)
{
    static const case_t cases[] = {
        {"PLANT=THRUST", "GRAV=5.88", 9.0, 18.0},
        {"PLANT=THRUST", "GRAV=7", 9.0, 18.0},
        {"PLANT=THRUST", "GRAV=5", 10.0, 20.0},
        {"PLANT=THRUST", "plant.climb_deadband=0", 10.0, 20.0},
    };

    for (size_t i = 0; i < COUNT(cases); i++) {
        const char *const assignments[] = {cases[i].first, cases[i].second, NULL};

        fly_seeds("climb-rate", assignments, 10);
        no_incident();
        between(cases[i].least, cases[i].most, mean[METRIC_HOVER_RMS_MM], "hover RMS");
    }
}

void test_climb_set_on_a_thrust_flies(void)
{
    static const case_t cases[] = {
        {"PLANT=CLIMB", "GRAV=7", 9.0, 20.0},
        {"PLANT=CLIMB", "CRATE=0.3", 9.0, 18.0},
        {"PLANT=CLIMB", "CRATE=3", 10.0, 25.0},
        {"PLANT=CLIMB", "plant.hover_thrust=8.4", 10.0, 25.0},
        {"PLANT=CLIMB", "plant.hover_thrust=5.6", 10.0, 25.0},
    };

    for (size_t i = 0; i < COUNT(cases); i++) {
        const char *const assignments[] = {cases[i].first, cases[i].second, NULL};

        fly_seeds("est-60cm-ramp", assignments, 10);
        no_incident();
        between(cases[i].least, cases[i].most, mean[METRIC_HOVER_RMS_MM], "hover RMS");
    }
}

/* Laws for thrust on a climb rate. Too much GRAV is a climb: the supervisor takes over, and lands it at the
 * third time. */
void test_the_other_laws_are_kept_within_bounds(void)
{
    static const case_t cases[] = {
        {"LAW=PID", "GRAV=5.88", 0.0, 0.0},
        {"LAW=PID", "GRAV=7", 1.5, 3.0},
        {"LAW=PD", "GRAV=7", 1.5, 3.0},
        {"LAW=PIDT", "GRAV=5.88", 0.0, 1.0},
    };
    static const double hover_rms_mm[COUNT(cases)][2] = {
        {100.0, 800.0}, {400.0, 700.0}, {400.0, 700.0}, {50.0, 95.0}};

    for (size_t i = 0; i < COUNT(cases); i++) {
        const char *const assignments[] = {cases[i].first, cases[i].second, NULL};

        fly_seeds("climb-rate", assignments, 10);
        never_dangerous();
        between(hover_rms_mm[i][0], hover_rms_mm[i][1], mean[METRIC_HOVER_RMS_MM], "hover RMS");
        between(cases[i].least, cases[i].most, mean[METRIC_TAKEOVERS], "take-overs");
    }
}

/* ---- which one is it? */

typedef struct {
    int count;
    struct {
        double measured_m, thrust_n;
    } row[ROWS]; /* 100 Hz, from scenario time 0 */
} log_t;

typedef struct {
    const char *scenario;
    const char *const *assignments;
    unsigned long seed;
} order_t;

/* The comma-separated field of that number, "" when there is none. */
static const char *field(const char *line, int number)
{
    while (number > 0 && (line = strchr(line, ',')) != NULL) {
        line++;
        number--;
    }
    return line != NULL ? line : "";
}

static int column(const char *titles, const char *title)
{
    for (int i = 0; *field(titles, i) != '\0'; i++) {
        if (strncmp(field(titles, i), title, strlen(title)) == 0) {
            return i;
        }
    }
    _exit(6);
}

/* A height that is not there is the one before. */
static void read_log(FILE *csv, log_t *log)
{
    char titles[256], line[256];
    double measured_m = 0.0;

    if (fgets(titles, sizeof titles, csv) == NULL) {
        _exit(7);
    }
    log->count = 0;
    while (fgets(line, sizeof line, csv) != NULL && log->count < ROWS) {
        sscanf(field(line, column(titles, "meas_m,")), "%lf", &measured_m);
        log->row[log->count].measured_m = measured_m;
        log->row[log->count].thrust_n = strtod(field(line, column(titles, "thrust_n,")), NULL);
        log->count++;
    }
}

static void fly_logged(void *argument, void *result)
{
    static flight_options_t options;
    static flight_result_t flown;
    const order_t *order = argument;

    options = (flight_options_t){.seed = order->seed, .csv = tmpfile()};
    for (int i = 0; order->assignments[i] != NULL; i++) {
        if (flight_override(&options, order->assignments[i]) != NULL) {
            _exit(4);
        }
    }
    if (flight_prepare(scenario_find(order->scenario), &options) != NULL) {
        _exit(5);
    }
    flight_run(scenario_find(order->scenario), &options, &flown);
    rewind(options.csv);
    read_log(options.csv, result);
}

static const log_t *logged(const char *scenario, const char *const *assignments, unsigned long seed)
{
    static log_t log;
    order_t order = {scenario, assignments, seed};

    child_run(fly_logged, &order, &log, sizeof log);
    TEST_ASSERT_TRUE(log.count > 2000);
    return &log;
}

/* Falls of five step tests: second second over first, less what it fell in the second before. */
static double step_ratio(const char *scenario, const char *const *assignments, unsigned long first_seed)
{
    double fall_m[3] = {0.0};

    for (unsigned long seed = first_seed; seed < first_seed + 5; seed++) {
        const log_t *log = logged(scenario, assignments, seed);

        for (int k = 0; k < 3; k++) {
            fall_m[k] += (log->row[1310 + 100 * k].measured_m - log->row[1410 + 100 * k].measured_m) / 5.0;
        }
    }
    printf("%s: fell %.3f, %.3f, %.3f m, ratio %.2f\n", scenario, fall_m[0], fall_m[1], fall_m[2],
           (fall_m[2] - fall_m[0]) / (fall_m[1] - fall_m[0]));
    between(-0.2, 0.2, fall_m[0], "fall before the step");
    return (fall_m[2] - fall_m[0]) / (fall_m[1] - fall_m[0]);
}

static void step_tests(const char *scenario, const char *figure, double least_ratio, double most_ratio)
{
    const char *const assignments[] = {figure, NULL};

    for (unsigned long seed = 1; seed <= 20; seed += 5) {
        between(least_ratio, most_ratio, step_ratio(scenario, assignments, seed), "second over first second");
    }
}

void test_the_step_test_tells_thrust(void)
{
    step_tests("step-thrust", "plant.damping=2.4", 1.75, 4.0);
    step_tests("step-thrust", "plant.damping=1", 2.0, 5.0);
}

void test_the_step_test_tells_climb_rate(void)
{
    step_tests("step-climb", "plant.climb_deadband=0.47", 1.2, 1.7);
    step_tests("step-climb", "plant.climb_deadband=0", 1.2, 1.7);
    step_tests("step-climb", "plant.climb_lag=0.15", 1.1, 1.5);
}

void test_the_step_test_hardly_tells_strong_damping_from_a_slow_autopilot(void)
{
    step_tests("step-thrust", "plant.damping=3", 1.7, 2.5);
    step_tests("step-climb", "plant.climb_lag=0.4", 1.6, 2.2);
}

/* The rate that the step test gives: that of its second second. A deadband makes it too small, and CRATE with
 * it. */
void test_the_step_test_gives_the_rate(void)
{
    static const case_t cases[] = {{"plant.climb_deadband=0", NULL, 0.93, 1.07},
                                   {"plant.climb_deadband=0.47", NULL, 0.47, 0.59}};

    for (size_t i = 0; i < COUNT(cases); i++) {
        const char *const assignments[] = {cases[i].first, NULL};

        for (unsigned long seed = 1; seed <= 10; seed++) {
            const log_t *log = logged("step-climb", assignments, seed);

            between(cases[i].least, cases[i].most, log->row[1510].measured_m - log->row[1610].measured_m,
                    "rate");
        }
    }
}

static double hover_n(const char *autopilot, const char *weight, unsigned long seed)
{
    const char *const assignments[] = {"plant.platform=0", autopilot, weight, NULL};
    const log_t *log = logged("est-60cm-ramp", assignments, seed);
    double sum = 0.0;

    for (int i = 600; i < 1900; i++) {
        sum += log->row[i].thrust_n / 1300.0;
    }
    return sum;
}

void test_a_tenth_more_weight_tells_which(void)
{
    static const case_t cases[] = {{"plant.climb_rate=0", NULL, 0.06, 0.14},
                                   {"plant.climb_rate=1", NULL, -0.04, 0.04}};

    for (size_t i = 0; i < COUNT(cases); i++) {
        /* Not 4: one such flight in 200 ends early, because SIGHT/still doubts the heights (wrong PLANT). */
        for (unsigned long seed = 5; seed <= 14; seed++) {
            const double before_n = hover_n(cases[i].first, "plant.hover_thrust=7.4", seed);
            const double after_n = hover_n(cases[i].first, "plant.hover_thrust=8.14", seed + 100);

            between(cases[i].least, cases[i].most, after_n / before_n - 1.0, "growth of thr");
        }
    }
}
