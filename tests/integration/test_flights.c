/* The seed's flights against the baseline of an independent implementation of the same plant: means of 20
 * seeds there (study of the seed's law: rise, overshoot, RMS after 6 s, mean error, ground contacts), of
 * FLIGHTS_MEANS here, without it ten.
 *
 * Every scenario meets its expectations: FLIGHTS_SEEDS seeds of each, without it the first; test_cli flies
 * another of each. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "unity.h"

static unsigned long seeds; /* of a mean */

static unsigned long told(const char *name, unsigned long otherwise)
{
    const char *count = getenv(name);

    return count != NULL ? strtoul(count, NULL, 10) : otherwise;
}

void setUp(void)
{
    seeds = told("FLIGHTS_MEANS", 10UL);
}

void tearDown(void) {}

#define KEPT 32 /* seeds of a scenario */

/* What several tests ask for flies once: the same scenario and seed are the same flight. */
static const flight_result_t *flown(const char *scenario, unsigned long seed)
{
    static flight_result_t *kept;
    int i = 0;

    if (kept == NULL) {
        kept = calloc((size_t)scenario_count * KEPT, sizeof *kept);
        TEST_ASSERT_NOT_NULL(kept);
    }
    while (i < scenario_count && strcmp(scenarios[i].name, scenario) != 0) {
        i++;
    }
    TEST_ASSERT_TRUE_MESSAGE(i < scenario_count && seed < KEPT, scenario);
    flight_result_t *result = &kept[i * KEPT + (int)seed];
    if (!result->started) {
        child_fly(scenario, seed, NULL, result);
    }
    return result;
}

static double means[METRIC_COUNT];
static int failures;

static void fly_seeds(const char *scenario)
{
    memset(means, 0, sizeof means);
    failures = 0;
    for (unsigned long seed = 1; seed <= seeds; seed++) {
        const flight_result_t *result = flown(scenario, seed);

        TEST_ASSERT_NULL(result->halt);
        failures += result->metrics.failed;
        for (int i = 0; i < METRIC_COUNT; i++) {
            means[i] += result->metrics.value[i] / (double)seeds;
        }
    }
    printf("%s:", scenario);
    for (int i = 0; i < METRIC_COUNT; i++) {
        printf(" %s %.3g", metric_names[i], means[i]);
    }
    printf(" failures %d\n", failures);
}

static void within(double part, double expected, double actual, const char *what)
{
    char message[96];

    snprintf(message, sizeof message, "%s: %.4g, expected %.4g +-%.0f %%", what, actual, expected,
             part * 100.0);
    TEST_ASSERT_TRUE_MESSAGE(fabs(actual - expected) <= part * expected, message);
}

static void baseline(double rise_s, double overshoot_mm, double rms_mm, double mean_mm)
{
    within(0.25, rise_s, means[METRIC_RISE_TIME_S], "rise");
    within(0.25, overshoot_mm, means[METRIC_OVERSHOOT_MM], "overshoot");
    within(0.25, rms_mm, means[METRIC_HOVER_RMS_MM], "hover RMS");
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(15.0, mean_mm, means[METRIC_HOVER_MEAN_ERROR_MM], "mean error");
}

void test_p_only_at_30cm_bounces_on_the_ground(void)
{
    fly_seeds("p-only-30cm");
    baseline(0.43, 0.80 * 300.0, 173.0, -42.0);
    TEST_ASSERT_TRUE(means[METRIC_GROUND_CONTACTS] > 1.0);
}

void test_unsaturated_pd_at_30cm_oscillates_widely(void)
{
    fly_seeds("pd-unsaturated-30cm");
    baseline(0.41, 0.66 * 300.0, 119.0, -56.0);
}

void test_saturated_pd_at_35cm_stays_below_its_reference(void)
{
    fly_seeds("pd-35cm");
    baseline(0.93, 0.32 * 350.0, 74.0, -42.0);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, means[METRIC_GROUND_CONTACTS]);
}

void test_pid_at_40cm_limit_cycles_around_its_reference(void)
{
    fly_seeds("pid-40cm");
    baseline(1.03, 0.33 * 400.0, 73.0, 5.0);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, means[METRIC_GROUND_CONTACTS]);
}

void test_pid_at_60cm_follows_the_platform_as_the_seed_flew_it(void)
{
    fly_seeds("pid-60cm-ramp");
    baseline(1.46, 0.21 * 600.0, 73.0, 2.0);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, means[METRIC_GROUND_CONTACTS]);
    TEST_ASSERT_EQUAL_INT(0, failures);
    within(0.25, 130.0, means[METRIC_TERRAIN_RMS_MM], "terrain RMS");
    within(0.25, 124.0, means[METRIC_UNDERSHOOT_MM], "undershoot");
}

void test_rope_tugs_disturb_the_hover(void)
{
    double calm = 0.0, tugged = 0.0;

    for (unsigned long seed = 1; seed <= seeds; seed++) {
        const metrics_t *with_tugs = &flown("pid-40cm-tugs", seed)->metrics;

        calm += flown("pid-40cm", seed)->metrics.value[METRIC_HOVER_RMS_MM] / (double)seeds;
        tugged += with_tugs->value[METRIC_HOVER_RMS_MM] / (double)seeds;
        TEST_ASSERT_FALSE(with_tugs->failed);
    }
    TEST_ASSERT_TRUE_MESSAGE(tugged > calm, "the ropes went unnoticed");
}

void test_every_scenario_meets_its_expectations(void)
{
    const unsigned long each = told("FLIGHTS_SEEDS", 1UL);
    const expectation_t *broken;

    TEST_ASSERT_TRUE(each > 0UL);
    char message[128];

    for (int i = 0; i < scenario_count; i++) {
        for (unsigned long seed = 1; seed <= each; seed++) {
            const metrics_t *metrics = &flown(scenarios[i].name, seed)->metrics;
            const bool met = scenario_met(&scenarios[i], metrics, &broken);

            snprintf(message, sizeof message, "%s seed %lu: %s %g", scenarios[i].name, seed,
                     broken != NULL ? metric_names[broken->metric] : "failure",
                     broken != NULL ? metrics->value[broken->metric] : 0.0);
            TEST_ASSERT_TRUE_MESSAGE(met, message);
            TEST_ASSERT_TRUE(scenarios[i].expectation_count >= 2);
        }
    }
}

void test_expectations_are_two_sided_and_can_be_broken(void)
{
    for (int i = 0; i < scenario_count; i++) {
        metrics_t metrics = {.failed = scenarios[i].fate == FATE_FAILS};
        const expectation_t *broken;

        for (int k = 0; k < scenarios[i].expectation_count; k++) {
            const expectation_t *e = &scenarios[i].expectations[k];

            TEST_ASSERT_TRUE(isfinite(e->minimum) && isfinite(e->maximum) && e->minimum <= e->maximum);
            metrics.value[e->metric] = 0.5 * (e->minimum + e->maximum);
        }
        TEST_ASSERT_TRUE(scenario_met(&scenarios[i], &metrics, &broken));
        metrics.value[scenarios[i].expectations[0].metric] = scenarios[i].expectations[0].maximum + 1e-6;
        TEST_ASSERT_FALSE(scenario_met(&scenarios[i], &metrics, &broken));
        metrics.value[scenarios[i].expectations[0].metric] = scenarios[i].expectations[0].minimum - 1e-6;
        TEST_ASSERT_FALSE(scenario_met(&scenarios[i], &metrics, &broken));
    }
}
