#include "sim/scenarios/metrics.h"

#include <math.h>
#include <string.h>

#define OVERSHOOT_END_S 5.5
#define SETTLED_S 5.0
#define WITHIN_MM 50.0
#define MAX_ERROR_START_S 6.0
#define AIRBORNE_M 0.03
#define TOUCHED_M 0.003

const char *const metric_names[METRIC_COUNT] = {
    "rise_time_s", "overshoot_mm", "hover_rms_mm", "hover_mean_error_mm", "terrain_rms_mm",
    "recovery_s", "undershoot_mm", "ground_contacts", "thrust_std_n", "scans",
    "scans_rejected", "commands_ok", "commands_err", "max_error_mm", "highest_mm",
    "touch_speed_mps", "takeovers", "cuts",
};

typedef struct {
    double n, sum, squares;
} moments_t;

static void add(moments_t *moments, double x)
{
    moments->n += 1.0;
    moments->sum += x;
    moments->squares += x * x;
}

static double mean(const moments_t *m)
{
    return m->n > 0.0 ? m->sum / m->n : NAN;
}

static double rms(const moments_t *m)
{
    return m->n > 0.0 ? sqrt(m->squares / m->n) : NAN;
}

static double deviation(const moments_t *m)
{
    return m->n > 0.0 ? sqrt(fmax(0.0, m->squares / m->n - mean(m) * mean(m))) : NAN;
}

static bool hovering(const metrics_record_t *record, double t_s)
{
    if (record->terrain) {
        return (t_s >= 4.5 && t_s <= 7.2) || (t_s >= 15.0 && t_s <= 20.0);
    }
    return t_s >= 6.0 && t_s <= record->land_s;
}

static double first_time_at(const metrics_record_t *record, double height_m)
{
    for (size_t i = 0; i < record->count; i++) {
        const metrics_sample_t *s = &record->samples[i];

        if (s->t_s >= METRICS_REFERENCE_S && s->t_s <= record->land_s && s->height_m >= height_m) {
            return s->t_s;
        }
    }
    return NAN;
}

static void judge(const metrics_record_t *record, metrics_t *metrics)
{
    if (isnan(first_time_at(record, 0.9 * record->reference_m))) {
        metrics->failure = "never reached 90 % of the reference";
    }
    for (size_t i = 0; i < record->count && metrics->failure == NULL; i++) {
        const metrics_sample_t *s = &record->samples[i];
        double error_m = s->height_m - record->reference_m;

        if (error_m > 1.0) {
            metrics->failure = "rose above the reference + 1 m";
        } else if (s->t_s > SETTLED_S && s->t_s < record->land_s && fabs(error_m) > 0.55) {
            metrics->failure = "more than 0.55 m off after 5 s";
        }
    }
    metrics->failed = metrics->failure != NULL;
}

static void find_extremes(const metrics_record_t *record, double *value)
{
    double largest = 0.0, highest = -INFINITY;

    for (size_t i = 0; i < record->count; i++) {
        const metrics_sample_t *s = &record->samples[i];
        double error_mm = (s->height_m - record->reference_m) * 1000.0;

        if (s->t_s >= METRICS_REFERENCE_S) {
            highest = fmax(highest, error_mm);
        }
        if (s->t_s >= MAX_ERROR_START_S && s->t_s <= record->land_s) {
            largest = fmax(largest, fabs(error_mm));
        }
    }
    value[METRIC_HIGHEST_MM] = isfinite(highest) ? highest : NAN;
    value[METRIC_MAX_ERROR_MM] = largest;
}

static double hardest_touch(const metrics_record_t *record)
{
    double hardest = NAN, fall = 0.0;
    bool airborne = false;

    for (size_t i = 0; i < record->count; i++) {
        const metrics_sample_t *s = &record->samples[i];

        if (s->height_m > AIRBORNE_M) {
            airborne = true;
            fall = 0.0;
        }
        fall = fmax(fall, -s->speed_mps);
        if (airborne && s->height_m <= TOUCHED_M) {
            airborne = false;
            hardest = fmax(hardest, fall);
        }
    }
    return hardest;
}

static bool cut(const metrics_sample_t *s)
{
    return s->height_m > AIRBORNE_M && s->thrust_n <= 0.0;
}

static void count_incidents(const metrics_record_t *record, double *value)
{
    double takeovers = 0.0, cuts = 0.0;

    for (size_t i = 1; i < record->count; i++) {
        const metrics_sample_t *before = &record->samples[i - 1], *s = &record->samples[i];

        takeovers += s->taken_over && !before->taken_over && s->t_s < record->land_s;
        cuts += cut(s) && !cut(before);
    }
    value[METRIC_TAKEOVERS] = takeovers;
    value[METRIC_CUTS] = cuts;
}

void metrics_compute(const metrics_record_t *record, metrics_t *metrics)
{
    moments_t hover = {0}, thrust = {0}, terrain = {0};
    double overshoot = 0.0, undershoot = 0.0, last_off_s = METRICS_EDGE_S;
    double *value = metrics->value;

    memset(metrics, 0, sizeof *metrics);
    for (size_t i = 0; i < record->count; i++) {
        double t = record->samples[i].t_s;
        double error_mm = (record->samples[i].height_m - record->reference_m) * 1000.0;

        if (hovering(record, t)) {
            add(&hover, error_mm);
            add(&thrust, record->samples[i].thrust_n);
        }
        if (t >= METRICS_REFERENCE_S && t <= OVERSHOOT_END_S) {
            overshoot = fmax(overshoot, error_mm);
        }
        if (t >= 7.2 && t <= METRICS_RECOVERY_END_S) {
            add(&terrain, error_mm);
        }
        if (t >= METRICS_EDGE_S && t <= METRICS_RECOVERY_END_S) {
            undershoot = fmax(undershoot, -error_mm);
            last_off_s = fabs(error_mm) > WITHIN_MM ? t : last_off_s;
        }
    }
    value[METRIC_RISE_TIME_S] =
        first_time_at(record, 0.9 * record->reference_m) - first_time_at(record, 0.1 * record->reference_m);
    value[METRIC_OVERSHOOT_MM] = overshoot;
    value[METRIC_HOVER_RMS_MM] = rms(&hover);
    value[METRIC_HOVER_MEAN_ERROR_MM] = mean(&hover);
    value[METRIC_THRUST_STD_N] = deviation(&thrust);
    value[METRIC_TERRAIN_RMS_MM] = record->terrain ? rms(&terrain) : NAN;
    value[METRIC_RECOVERY_S] = record->terrain ? last_off_s - METRICS_EDGE_S : NAN;
    value[METRIC_UNDERSHOOT_MM] = record->terrain ? undershoot : NAN;
    value[METRIC_TOUCH_SPEED_MPS] = hardest_touch(record);
    find_extremes(record, value);
    count_incidents(record, value);
    judge(record, metrics);
}
