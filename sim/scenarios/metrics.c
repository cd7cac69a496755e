#include "sim/scenarios/metrics.h"

#include <math.h>
#include <string.h>

#define OVERSHOOT_END_S 5.5
#define SETTLED_S 5.0
#define CHANGED_S 5.0 /* after another reference: as long as from the first one to the hover at 6 s */
#define WITHIN_MM 50.0
#define SETTLED_FOR_S 0.5
#define MAX_ERROR_START_S 6.0
#define HOVER_END_S 7.2 /* before a ramp */
#define AGAIN_START_S 33.0
#define AGAIN_END_S 36.0
#define BY_EYE_START_S 38.0
#define BY_EYE_END_S 41.0
#define AIRBORNE_M 0.03
#define TOUCHED_M 0.003
#define ALOFT_M 0.3
#define MOTORS_TURN_N \
    1.2 /* a tenth of the throttle: under it the autopilot stops its motors or lets them idle */
#define OFF_S 0.2
#define WRONG_M 0.3
#define OVER_S 1.0
#define REACHED_M 0.1        /* where FLIGHT_FLAG_REACH ends too */
#define REACHED_WITHIN_S 8.0 /* twice what a climb of 3 m takes with VUP as delivered, 0.7 m/s */

const char *const metric_names[] = {
    "rise_time_s",     "overshoot_mm",
    "hover_rms_mm",    "hover_mean_error_mm",
    "terrain_rms_mm",  "recovery_s",
    "settled_s",       "undershoot_mm",
    "ground_contacts", "thrust_std_n",
    "scans",           "scans_rejected",
    "commands_ok",     "commands_err",
    "max_error_mm",    "altitude_error_mm",
    "highest_mm",      "touch_speed_mps",
    "takeovers",       "cuts",
    "off_aloft",       "down_s",
    "stopped_s",       "deceived_s",
    "flagged_s",       "again_rms_mm",
    "by_eye_rms_mm",   "motor_stops",
    "motors_at_end",   "landed_unordered",
    "sight_doubts",    "imu_doubts",
    "thrust_doubts",   "off_s",
    "aloft_s",         "collided",
};
_Static_assert(sizeof metric_names / sizeof metric_names[0] == METRIC_COUNT, "every metric has a name");

static void add(metrics_moments_t *moments, double x)
{
    moments->n += 1.0;
    moments->sum += x;
    moments->squares += x * x;
}

static double mean(const metrics_moments_t *m)
{
    return m->n > 0.0 ? m->sum / m->n : NAN;
}

static double rms(const metrics_moments_t *m)
{
    return m->n > 0.0 ? sqrt(m->squares / m->n) : NAN;
}

static double deviation(const metrics_moments_t *m)
{
    return m->n > 0.0 ? sqrt(fmax(0.0, m->squares / m->n - mean(m) * mean(m))) : NAN;
}

static bool hovering(const metrics_record_t *record, double t_s)
{
    if (record->terrain) {
        return (t_s >= 4.5 && t_s <= HOVER_END_S) || (t_s >= 15.0 && t_s <= 20.0);
    }
    return t_s >= 6.0 && t_s <= record->land_s;
}

/* From the reference in force. */
static double error_mm(const metrics_record_t *record, const metrics_sample_t *s)
{
    return (s->height_m - record->wanted_m) * 1000.0;
}

/* There is a reference, and the vehicle is not on its way from another one. The first one has windows of its
 * own. */
static bool settled(const metrics_record_t *record, const metrics_sample_t *s)
{
    return record->wanted_m > 0.0 && !(s->t_s < record->changed_s + CHANGED_S);
}

static void judge_course(metrics_record_t *record, const metrics_sample_t *s)
{
    const double error_m = s->height_m - record->wanted_m;

    if (!settled(record, s)) {
        return;
    }
    if (!record->off_course && error_m > 1.0) {
        record->too_high = true;
    }
    if (!record->too_high && s->t_s > SETTLED_S && s->t_s < record->land_s && fabs(error_m) > 0.55) {
        record->off_course = true;
    }
}

static void time_rise(metrics_record_t *record, const metrics_sample_t *s)
{
    if (s->t_s < METRICS_REFERENCE_S || s->t_s > record->land_s) {
        return;
    }
    if (isnan(record->tenth_s) && s->height_m >= 0.1 * record->reference_m) {
        record->tenth_s = s->t_s;
    }
    if (isnan(record->ninety_s) && s->height_m >= 0.9 * record->reference_m) {
        record->ninety_s = s->t_s;
    }
}

static void find_extremes(metrics_record_t *record, const metrics_sample_t *s)
{
    const double off_mm = error_mm(record, s);

    if (s->t_s >= METRICS_REFERENCE_S) {
        record->highest_mm = fmax(record->highest_mm, (s->height_m - record->highest_wanted_m) * 1000.0);
    }
    if (s->t_s >= MAX_ERROR_START_S && s->t_s <= record->land_s) {
        record->largest_mm = settled(record, s) ? fmax(record->largest_mm, fabs(off_mm)) : record->largest_mm;
        record->altitude_mm = fmax(record->altitude_mm, fabs(s->altitude_m - record->wanted_m) * 1000.0);
    }
}

/* A vehicle without thrust does not leave the ground: it stood on the platform, and that went away. What it
 * falls is no deed of the firmware. */
static void watch_touch(metrics_record_t *record, const metrics_sample_t *s)
{
    if (s->clearance_m > AIRBORNE_M) {
        const bool idle = record->before.thrust_n <= 0.0 && s->thrust_n <= 0.0 &&
                          s->speed_mps <= 0.0; /* else a pilot lifts it */
        record->dropped = record->airborne ? record->dropped : record->count > 0 && idle;
        record->airborne = true;
        record->fall_mps = 0.0;
    }
    record->fall_mps = fmax(record->fall_mps, -s->speed_mps);
    if (record->airborne && s->clearance_m <= TOUCHED_M) {
        record->airborne = false;
        record->hardest_mps = record->dropped ? record->hardest_mps
                                              : fmax(record->hardest_mps, record->fall_mps);
    }
}

/* The thrust went away in the air: for 0.3 s already, longer than the fall of a vehicle that stood on the
 * platform until that went away. Such a vehicle is not cut. */
static bool cut(const metrics_record_t *record, const metrics_sample_t *s)
{
    return s->thrust_n <= 0.0 && record->before.thrust_n > 0.0 && s->t_s - record->aloft_since_s > 0.295;
}

static void watch_ground(metrics_record_t *record, const metrics_sample_t *s)
{
    const bool was_aloft = record->count > 0 && record->before.clearance_m > AIRBORNE_M;

    if (s->clearance_m <= AIRBORNE_M) {
        record->aloft_since_s = NAN;
    } else if (!was_aloft) {
        record->aloft_since_s = s->t_s;
    }
}

static void count_incidents(metrics_record_t *record, const metrics_sample_t *s)
{
    const metrics_sample_t *before = &record->before;

    watch_ground(record, s);
    if (record->count > 0) {
        record->takeovers += s->taken_over && !before->taken_over && s->t_s < record->land_s &&
                             !(record->lowered && !record->reached);
        record->cuts += cut(record, s);
    }
}

static void watch_motors(metrics_record_t *record, const metrics_sample_t *s)
{
    if (s->height_m <= ALOFT_M || s->thrust_n > MOTORS_TURN_N || !s->may_cut) {
        record->off_since_s = NAN;
    } else if (isnan(record->off_since_s)) {
        record->off_since_s = s->t_s;
    } else if (s->t_s >= record->off_since_s + OFF_S) {
        record->off_aloft++;
        record->off_since_s = INFINITY; /* counted; until they turn again */
    }
}

static void watch_descent(metrics_record_t *record, const metrics_sample_t *s)
{
    if (!s->on_ground || s->clearance_m > AIRBORNE_M) {
        record->aloft_s = s->t_s;
    }
    if (s->thrust_n > MOTORS_TURN_N) {
        record->running_s = s->t_s;
    }
    if (s->t_s >= record->land_s) {
        record->order_s = fmin(record->order_s, record->land_s);
    } else if (s->coming_down) {
        record->order_s = fmin(record->order_s, s->t_s);
    } else if (s->thrust_n > MOTORS_TURN_N) {
        record->order_s = INFINITY; /* it flies again */
    }
}

static void watch_estimate(metrics_record_t *record, const metrics_sample_t *s)
{
    const bool aloft = s->clearance_m > AIRBORNE_M && s->t_s >= METRICS_REFERENCE_S;

    if (aloft && s->flagged && s->t_s < record->land_s && record->count > 0) {
        record->flagged_s += s->t_s - record->before.t_s;
    }
    if (!aloft || s->flagged || !(fabs(s->estimate_m - s->seen_m) > WRONG_M)) {
        record->wrong_since_s = NAN;
    } else if (isnan(record->wrong_since_s)) {
        record->wrong_since_s = s->t_s;
    } else {
        record->deceived_s = fmax(record->deceived_s, s->t_s - record->wrong_since_s);
    }
}

/* Whether the firmware is to keep a height now. */
static bool held(const metrics_record_t *record, const metrics_sample_t *s)
{
    return s->ours && record->wanted_m > 0.0 && s->t_s >= METRICS_REFERENCE_S && s->t_s < record->land_s;
}

/* A flight that ends by itself. What the pilot has landed is not one. */
static void watch_landing(metrics_record_t *record, const metrics_sample_t *s)
{
    record->flew = held(record, s) && (record->flew || s->height_m > 0.5 * record->wanted_m);
    if (!s->on_ground || !record->flew) {
        record->stood_since_s = s->t_s;
    } else if (s->t_s - record->stood_since_s >= OVER_S) {
        record->landed_unordered++;
        record->flew = false;
    }
}

/* A doubt that began before, on the ground, counts with the take-off; one that began in a pilot's hands does
 * not. */
static void watch_doubts(metrics_record_t *record, const metrics_sample_t *s)
{
    const bool aloft = s->clearance_m > AIRBORNE_M && s->t_s >= METRICS_REFERENCE_S &&
                       s->t_s < record->land_s;
    const unsigned risen = s->doubts & ~record->doubts;

    if (aloft && s->ours) {
        record->in_air_s += record->count > 0 ? s->t_s - record->before.t_s : 0.0;
        for (int i = 0; i < METRICS_SOURCES; i++) {
            record->doubted[i] += (risen >> i) & 1U;
        }
    }
    record->doubts = aloft ? s->doubts : 0U;
}

static void watch_reference(metrics_record_t *record, const metrics_sample_t *s)
{
    const double off_m = s->height_m - record->wanted_m;
    const int side = off_m > WRONG_M ? 1 : off_m < -WRONG_M ? -1 : 0;

    if (!held(record, s)) { /* it begins anew with what it gets back */
        record->reached = false;
        record->ordered_s = fmax(s->t_s, record->ordered_s);
    }
    record->reached = record->reached || fabs(off_m) < REACHED_M ||
                      s->t_s > record->ordered_s + REACHED_WITHIN_S;
    if (side == 0 || side != record->off_side || !held(record, s) || !record->reached) {
        record->aside_since_s = s->t_s;
    }
    record->off_side = side;
    record->aside_s = fmax(record->aside_s, s->t_s - record->aside_since_s);
}

/* The platform's edge. */
static void watch_recovery(metrics_record_t *record, double t_s, double off_mm)
{
    record->edge_seen = true;
    record->undershoot_mm = fmax(record->undershoot_mm, -off_mm);
    record->last_off_s = fabs(off_mm) > WITHIN_MM ? t_s : record->last_off_s;
    record->unsettled_s = t_s < record->unsettled_s + SETTLED_FOR_S ? record->last_off_s
                                                                    : record->unsettled_s;
}

static void gather_settled(metrics_record_t *record, const metrics_sample_t *s)
{
    const double t = s->t_s, off_mm = error_mm(record, s);

    if (hovering(record, t)) {
        add(&record->hover, off_mm);
        add(&record->thrust, s->thrust_n);
    }
    if (t >= METRICS_REFERENCE_S && t <= OVERSHOOT_END_S) {
        record->overshoot_mm = fmax(record->overshoot_mm, off_mm);
    }
    if (t >= HOVER_END_S && t <= METRICS_RECOVERY_END_S) {
        add(&record->ramp, off_mm);
    }
    if (t >= METRICS_EDGE_S && t <= METRICS_RECOVERY_END_S) {
        watch_recovery(record, t, off_mm);
    }
}

/* Its second take-off is to the first reference, and its pilot keeps that. */
static void gather_field_day(metrics_record_t *record, const metrics_sample_t *s)
{
    const double off_mm = (s->height_m - record->reference_m) * 1000.0;

    if (record->field_day && s->t_s >= AGAIN_START_S && s->t_s <= AGAIN_END_S) {
        add(&record->again, off_mm);
    }
    if (record->field_day && s->t_s >= BY_EYE_START_S && s->t_s <= BY_EYE_END_S) {
        add(&record->by_eye, off_mm);
    }
}

static void gather(metrics_record_t *record, const metrics_sample_t *s)
{
    if (settled(record, s) && s->t_s <= record->land_s) {
        gather_settled(record, s);
    }
    gather_field_day(record, s);
}

void metrics_begin(metrics_record_t *record, double reference_m, bool terrain, double land_s)
{
    *record = (metrics_record_t){.reference_m = reference_m,
                                 .wanted_m = reference_m,
                                 .highest_wanted_m = reference_m,
                                 .ordered_s = METRICS_REFERENCE_S,
                                 .changed_s = -INFINITY,
                                 .largest_mm = NAN,
                                 .stood_since_s = -INFINITY,
                                 .aside_since_s = -INFINITY,
                                 .terrain = terrain,
                                 .land_s = land_s,
                                 .tenth_s = NAN,
                                 .ninety_s = NAN,
                                 .last_off_s = METRICS_EDGE_S,
                                 .unsettled_s = METRICS_EDGE_S,
                                 .highest_mm = -INFINITY,
                                 .hardest_mps = NAN,
                                 .off_since_s = NAN,
                                 .wrong_since_s = NAN,
                                 .order_s = INFINITY,
                                 .aloft_s = -INFINITY,
                                 .running_s = -INFINITY};
}

void metrics_order(metrics_record_t *record, double t_s, double reference_m)
{
    if (reference_m != record->wanted_m && t_s > METRICS_REFERENCE_S) {
        record->changed_s = t_s;
    }
    record->lowered = reference_m < record->wanted_m;
    record->wanted_m = reference_m;
    record->highest_wanted_m = fmax(record->highest_wanted_m, reference_m);
    record->ordered_s = t_s;
    record->reached = false;
}

void metrics_add(metrics_record_t *record, const metrics_sample_t *sample)
{
    gather(record, sample);
    judge_course(record, sample);
    time_rise(record, sample);
    find_extremes(record, sample);
    watch_touch(record, sample);
    count_incidents(record, sample);
    watch_motors(record, sample);
    watch_descent(record, sample);
    watch_estimate(record, sample);
    watch_landing(record, sample);
    watch_doubts(record, sample);
    watch_reference(record, sample);
    record->before = *sample;
    record->count++;
}

bool metrics_over(const metrics_record_t *record)
{
    const double since_s = fmax(fmax(record->aloft_s, record->running_s), record->order_s);

    return record->count > 0 && record->before.t_s > since_s + OVER_S;
}

static void judge(const metrics_record_t *record, metrics_t *metrics)
{
    metrics->failure = isnan(record->ninety_s) ? "never reached 90 % of the reference"
                       : record->too_high      ? "rose above the reference + 1 m"
                       : record->off_course    ? "more than 0.55 m off after 5 s"
                                               : NULL;
    metrics->failed = metrics->failure != NULL;
}

/* From the order to come down until `last_s` was over; NAN when it was not over by the end. */
static double after_order(const metrics_record_t *record, double last_s)
{
    const bool over = isfinite(record->order_s) && last_s < record->before.t_s;

    return over ? fmax(last_s - record->order_s, 0.0) : NAN;
}

/* It was not on its way to another reference there. */
static bool knows_edge(const metrics_record_t *record)
{
    return record->terrain && (record->edge_seen || isinf(record->changed_s));
}

/* The earliest landing command with which a flight has the figure: its window is over, of a hover's two the
 * first one. */
static double told_from_s(const metrics_record_t *record, metric_t metric)
{
    switch (metric) {
    case METRIC_HOVER_RMS_MM:
    case METRIC_HOVER_MEAN_ERROR_MM:
    case METRIC_THRUST_STD_N:
        return record->terrain ? HOVER_END_S : MAX_ERROR_START_S;
    case METRIC_TERRAIN_RMS_MM:
    case METRIC_RECOVERY_S:
    case METRIC_SETTLED_S:
    case METRIC_UNDERSHOOT_MM:
        return record->terrain ? METRICS_RECOVERY_END_S : 0.0;
    case METRIC_MAX_ERROR_MM:
    case METRIC_ALTITUDE_ERROR_MM:
        return MAX_ERROR_START_S;
    default:
        return 0.0;
    }
}

static void leave_untold(const metrics_record_t *record, metrics_t *metrics)
{
    for (int i = 0; i < METRIC_COUNT; i++) {
        metrics->untold[i] = record->land_s < told_from_s(record, (metric_t)i);
        metrics->value[i] = metrics->untold[i] ? NAN : metrics->value[i];
    }
}

void metrics_compute(const metrics_record_t *record, metrics_t *metrics)
{
    double *value = metrics->value;

    memset(metrics, 0, sizeof *metrics);
    value[METRIC_RISE_TIME_S] = record->ninety_s - record->tenth_s;
    value[METRIC_OVERSHOOT_MM] = record->overshoot_mm;
    value[METRIC_HOVER_RMS_MM] = rms(&record->hover);
    value[METRIC_HOVER_MEAN_ERROR_MM] = mean(&record->hover);
    value[METRIC_THRUST_STD_N] = deviation(&record->thrust);
    value[METRIC_TERRAIN_RMS_MM] = record->terrain ? rms(&record->ramp) : NAN;
    value[METRIC_RECOVERY_S] = knows_edge(record) ? record->last_off_s - METRICS_EDGE_S : NAN;
    value[METRIC_SETTLED_S] = knows_edge(record) ? record->unsettled_s - METRICS_EDGE_S : NAN;
    value[METRIC_UNDERSHOOT_MM] = knows_edge(record) ? record->undershoot_mm : NAN;
    value[METRIC_TOUCH_SPEED_MPS] = record->hardest_mps;
    value[METRIC_HIGHEST_MM] = isfinite(record->highest_mm) ? record->highest_mm : NAN;
    value[METRIC_MAX_ERROR_MM] = record->largest_mm;
    value[METRIC_ALTITUDE_ERROR_MM] = record->altitude_mm;
    value[METRIC_TAKEOVERS] = record->takeovers;
    value[METRIC_CUTS] = record->cuts;
    value[METRIC_OFF_ALOFT] = record->off_aloft;
    value[METRIC_DOWN_S] = after_order(record, record->aloft_s);
    value[METRIC_STOPPED_S] = after_order(record, fmax(record->aloft_s, record->running_s));
    value[METRIC_DECEIVED_S] = record->deceived_s;
    value[METRIC_FLAGGED_S] = record->flagged_s;
    value[METRIC_AGAIN_RMS_MM] = rms(&record->again);
    value[METRIC_BY_EYE_RMS_MM] = rms(&record->by_eye);
    value[METRIC_LANDED_UNORDERED] = record->landed_unordered;
    value[METRIC_SIGHT_DOUBTS] = record->doubted[0];
    value[METRIC_IMU_DOUBTS] = record->doubted[1];
    value[METRIC_THRUST_DOUBTS] = record->doubted[2];
    value[METRIC_OFF_S] = record->aside_s;
    value[METRIC_ALOFT_S] = record->in_air_s;
    leave_untold(record, metrics);
    judge(record, metrics);
}

bool metrics_needs_plan(metric_t metric)
{
    switch (metric) {
    case METRIC_RISE_TIME_S:
    case METRIC_OVERSHOOT_MM:
    case METRIC_TERRAIN_RMS_MM:
    case METRIC_RECOVERY_S:
    case METRIC_SETTLED_S:
    case METRIC_UNDERSHOOT_MM:
    case METRIC_GROUND_CONTACTS:
    case METRIC_ALTITUDE_ERROR_MM:
    case METRIC_DOWN_S:
    case METRIC_STOPPED_S:
    case METRIC_AGAIN_RMS_MM:
    case METRIC_BY_EYE_RMS_MM:
        return true;
    default:
        return false;
    }
}
