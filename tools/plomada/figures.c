#include "figures.h"

#include <math.h>

/* What a figure is, and what is good. METRIC_... in sim/scenarios/metrics.h has the exact words. */
static const char *const meanings[METRIC_COUNT] = {
    [METRIC_RISE_TIME_S] = "climb from 10 to 90 % of the reference; short is good",
    [METRIC_OVERSHOOT_MM] = "highest above the reference after take-off; 0 is best",
    [METRIC_HOVER_RMS_MM] = "distance from the reference in the hover, rms; 0 is best",
    [METRIC_HOVER_MEAN_ERROR_MM] = "the mean of it; above 0: hovers too high",
    [METRIC_TERRAIN_RMS_MM] = "the same over ramp and platform, rms; 0 is best",
    [METRIC_RECOVERY_S] = "from the platform's edge until it stays within 50 mm; 3.97 and more: never did",
    [METRIC_UNDERSHOOT_MM] = "deepest below the reference after the edge; 0 is best",
    [METRIC_GROUND_CONTACTS] = "times that it touched the ground in flight; must be 0 of a good law",
    [METRIC_THRUST_STD_N] = "how much the thrust moves in the hover; little is good",
    [METRIC_SCANS] = "scans that the firmware used; ten a second",
    [METRIC_SCANS_REJECTED] = "damaged scans; 0 on a good line",
    [METRIC_COMMANDS_OK] = "commands that were obeyed",
    [METRIC_COMMANDS_ERR] = "commands that were refused; 0 is good",
    [METRIC_MAX_ERROR_MM] = "largest distance from the reference, from 6 s to the landing command",
    [METRIC_HIGHEST_MM] = "highest above the reference in the whole flight",
    [METRIC_TOUCH_SPEED_MPS] = "speed of the hardest touch; a soft landing has 0.2",
    [METRIC_TAKEOVERS] = "times that the supervisor took the vehicle from the law; 0 is good",
    [METRIC_CUTS] = "times that the thrust was cut in the air; 0 is good",
    [METRIC_OFF_ALOFT] = "times that the motors were off in the air unasked; 0 is good",
    [METRIC_DOWN_S] = "from the landing command until it stands; -: it never came down",
    [METRIC_STOPPED_S] = "and until the motors are off",
    [METRIC_DECEIVED_S] = "longest time with a height 0.3 m wrong and no flag; 0 is good",
    [METRIC_FLAGGED_S] = "time with a flag in the air; 0: nothing was in doubt",
    [METRIC_AGAIN_RMS_MM] = "hover_rms_mm after the second take-off",
    [METRIC_BY_EYE_RMS_MM] = "the same while the pilot holds the height by eye",
    [METRIC_MOTOR_STOPS] = "times that the autopilot stopped the motors in the air; 0 is good",
    [METRIC_MOTORS_AT_END] = "1: the motors still run at the end",
};

static int decimals(metric_t metric)
{
    switch (metric) {
    case METRIC_GROUND_CONTACTS:
    case METRIC_SCANS:
    case METRIC_SCANS_REJECTED:
    case METRIC_COMMANDS_OK:
    case METRIC_COMMANDS_ERR:
    case METRIC_TAKEOVERS:
    case METRIC_CUTS:
    case METRIC_OFF_ALOFT:
    case METRIC_MOTOR_STOPS:
    case METRIC_MOTORS_AT_END:
        return 0;
    default:
        return 3;
    }
}

static const expectation_t *expected(const scenario_t *scenario, metric_t metric)
{
    for (int i = 0; i < scenario->expectation_count; i++) {
        if (scenario->expectations[i].metric == metric) {
            return &scenario->expectations[i];
        }
    }
    return NULL;
}

static bool broken(const expectation_t *e, double value)
{
    return e != NULL && !(value >= e->minimum && value <= e->maximum);
}

/* Motors can stop in the air where the autopilot has its rules for them only. */
static bool applies(metric_t metric, const metrics_t *metrics)
{
    if (metric == METRIC_MOTOR_STOPS || metric == METRIC_MOTORS_AT_END) {
        return metrics->value[METRIC_MOTOR_STOPS] > 0.0;
    }
    return !isnan(metrics->value[metric]) || metric == METRIC_DOWN_S;
}

static void print_row(FILE *out, metric_t metric, double value, const expectation_t *must)
{
    char found[32] = "-", range[40] = "";

    if (!isnan(value)) {
        snprintf(found, sizeof found, "%.*f", decimals(metric), value);
    }
    if (must != NULL) {
        snprintf(range, sizeof range, "%g..%g", must->minimum, must->maximum);
    }
    fprintf(out, "%c %-20s %-9s %-12s %s\n", broken(must, value) ? '!' : ' ', metric_names[metric], found,
            range, meanings[metric]);
}

void figures_print(FILE *out, const scenario_t *scenario, const metrics_t *metrics, bool (*judged)(metric_t))
{
    if (scenario->expectation_count > 0) {
        fprintf(out, "  %-20s %-9s %-12s %s\n", "figure", "found", "must be",
                "meaning; ! is not as it must be");
    }
    for (int i = 0; i < METRIC_COUNT; i++) {
        const metric_t metric = (metric_t)i;
        const expectation_t *must = expected(scenario, metric);

        if ((judged == NULL || judged(metric)) && (must != NULL || applies(metric, metrics))) {
            print_row(out, metric, metrics->value[i], must);
        }
    }
}

static void tell_broken(FILE *out, const scenario_t *scenario, const metrics_t *metrics)
{
    for (int i = 0; i < scenario->expectation_count; i++) {
        const expectation_t *e = &scenario->expectations[i];

        if (broken(e, metrics->value[e->metric])) {
            fprintf(out, "NOT MET: %s is not within %g..%g\n", metric_names[e->metric], e->minimum,
                    e->maximum);
        }
    }
}

bool figures_judge(FILE *out, const scenario_t *scenario, const metrics_t *metrics)
{
    const expectation_t *first;

    if (scenario_met(scenario, metrics, &first)) {
        return true;
    }
    if (first != NULL) {
        tell_broken(out, scenario, metrics);
    } else {
        fprintf(out, "NOT MET: %s\n", metrics->failed ? metrics->failure : "it was to fail, and did not");
    }
    fprintf(out,
            "NOT MET means: this flight was not what the scenario says that it must look like.\nThat is no "
            "crash by "
            "itself: the scenarios of the thesis expect its swinging, so a better flight is NOT MET too.\n");
    return false;
}
