#include "figures.h"

#include <math.h>

/* What a figure is, and what is good; metrics.h has the exact words. A switch, so that the compiler names a
 * figure that nobody explains. */
static const char *meaning(metric_t metric)
{
    switch (metric) {
    case METRIC_RISE_TIME_S:
        return "climb from 10 to 90 % of the reference; short is good";
    case METRIC_OVERSHOOT_MM:
        return "highest above the reference after take-off; 0 is best";
    case METRIC_HOVER_RMS_MM:
        return "distance from the reference in force in the hover, rms; 0 is best";
    case METRIC_HOVER_MEAN_ERROR_MM:
        return "the mean of it; above 0: hovers too high";
    case METRIC_TERRAIN_RMS_MM:
        return "the same over ramp and platform, rms; 0 is best";
    case METRIC_RECOVERY_S:
        return "from the platform's edge until it stays within 50 mm; 3.97 and more: never did";
    case METRIC_SETTLED_S:
        return "the same until it has stayed within 50 mm for half a second";
    case METRIC_UNDERSHOOT_MM:
        return "deepest below the reference after the edge; 0 is best";
    case METRIC_GROUND_CONTACTS:
        return "times that it touched the ground in flight; must be 0 of a good law";
    case METRIC_THRUST_STD_N:
        return "how much the thrust moves in the hover; little is good";
    case METRIC_SCANS:
        return "scans that the firmware used; ten a second";
    case METRIC_SCANS_REJECTED:
        return "damaged scans; 0 on a good line";
    case METRIC_COMMANDS_OK:
        return "commands that were obeyed";
    case METRIC_COMMANDS_ERR:
        return "commands that were refused; 0 is good";
    case METRIC_MAX_ERROR_MM:
        return "largest distance from the reference in force, from 6 s to the landing command";
    case METRIC_ALTITUDE_ERROR_MM:
        return "the same above the floor, also on the way to another reference; for TERRAIN IGNORE";
    case METRIC_HIGHEST_MM:
        return "highest above the reference in the whole flight";
    case METRIC_TOUCH_SPEED_MPS:
        return "speed of the hardest touch; a soft landing has 0.2";
    case METRIC_TAKEOVERS:
        return "times that the supervisor took the vehicle from the law; 0 is good";
    case METRIC_CUTS:
        return "times that the thrust was cut in the air; 0 is good";
    case METRIC_OFF_ALOFT:
        return "times that the motors were off in the air unasked; 0 is good";
    case METRIC_DOWN_S:
        return "from the landing command until it stands; -: it never came down";
    case METRIC_STOPPED_S:
        return "and until the motors are off";
    case METRIC_DECEIVED_S:
        return "longest time with a height 0.3 m wrong and no flag; 0 is good";
    case METRIC_FLAGGED_S:
        return "time with a flag in the air; 0: nothing was in doubt";
    case METRIC_AGAIN_RMS_MM:
        return "hover_rms_mm after the second take-off";
    case METRIC_BY_EYE_RMS_MM:
        return "the same while the pilot holds the height by eye";
    case METRIC_MOTOR_STOPS:
        return "times that the autopilot stopped the motors in the air; 0 is good";
    case METRIC_MOTORS_AT_END:
        return "1: the motors still run at the end";
    case METRIC_LANDED_UNORDERED:
        return "flights that ended by themselves, with a reference in force; 0 is good";
    case METRIC_SIGHT_DOUBTS:
        return "times that it began to doubt the heights; 0 when they are true";
    case METRIC_IMU_DOUBTS:
        return "times that it began to doubt the accelerometer; 0 when it is true";
    case METRIC_THRUST_DOUBTS:
        return "times that it began to doubt the effect of its thrust; 0 is good";
    case METRIC_OFF_S:
        return "longest time more than 0.3 m off the reference, to one side";
    case METRIC_ALOFT_S:
        return "time in the air before the landing command";
    case METRIC_COLLIDED:
        return "1: it flew into something; 0 is good";
    case METRIC_COUNT:
        break;
    }
    return "";
}

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
    case METRIC_LANDED_UNORDERED:
    case METRIC_SIGHT_DOUBTS:
    case METRIC_IMU_DOUBTS:
    case METRIC_THRUST_DOUBTS:
    case METRIC_COLLIDED:
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
            range, meaning(metric));
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
