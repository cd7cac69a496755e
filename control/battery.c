#include "control/battery.h"

#include <math.h>

#include "control/between.h"
#include "control/seconds.h"

/* A cell. Below 2.8 V it is not in flight any more: PX4, BAT1_V_EMPTY, has "the steep dropoff to 2.8V". A
 * full one has 4.2 V; a charger ends within 0.05 V, and a divider is calibrated to 1 %. */
#define CELL_LEAST_V 2.8F
#define CELL_MOST_V 4.3F /* 1.01 * (4.2 + 0.05), rounded up */
#define CELL_LOAD_V 0.3F /* PX4, BAT1_V_LOAD_DROP: from a light load to full throttle */

#define LOW_S 10.0F /* ArduPilot, BATT_LOW_TIMER */
#define MEAN_S \
    1.0F /* PX4, battery.cpp: the filter of the voltage. Readings are good or bad over the same time */
#define BELIEVE_SHARE 0.75F /* three good readings of four */
#define DOUBT_SHARE 0.5F    /* as many others as good ones */

#define FROZEN_S 5.0F    /* half of LOW_S: told before it could land */
#define FROZEN_V 0.0024F /* at the pin: three steps of 3.3 V / 4096, a converter's own noise */

static const char *const names[] = {
    [BATTERY_OFF] = "OFF",   [BATTERY_WAITS] = "WAITS", [BATTERY_GOOD] = "GOOD",
    [BATTERY_LOW] = "LOW",   [BATTERY_EMPTY] = "EMPTY", [BATTERY_ABSENT] = "ABSENT",
    [BATTERY_HIGH] = "HIGH", [BATTERY_JUMPS] = "JUMPS", [BATTERY_FROZEN] = "FROZEN",
};
typedef char every_verdict_has_a_name[(sizeof names / sizeof names[0] == BATTERY_VERDICT_COUNT) ? 1 : -1];

static float cells_of(const parameters_t *parameters)
{
    return (float)(parameters_choice(parameters, PARAMETER_CELLS) + CELLS_FEWEST);
}

static float share_of(float step_s, float time_s)
{
    return step_s / (time_s + step_s);
}

static battery_verdict_t judge(const battery_t *battery, float volts, float cells)
{
    /* In this form NaN is none as well. */
    if (!(volts >= CELL_LEAST_V * cells)) {
        return BATTERY_ABSENT;
    }
    if (volts > CELL_MOST_V * cells) {
        return BATTERY_HIGH;
    }
    const bool first = battery->volts == 0.0F;
    return (!first && fabsf(volts - battery->volts) > CELL_LOAD_V * cells) ? BATTERY_JUMPS : BATTERY_GOOD;
}

static void count(battery_t *battery, battery_verdict_t verdict, float step_s)
{
    const float is_good = (verdict == BATTERY_GOOD) ? 1.0F : 0.0F;

    battery->good += share_of(step_s, MEAN_S) * (is_good - battery->good);
    battery->believed = battery->good > (battery->believed ? DOUBT_SHARE : BELIEVE_SHARE);
    if (verdict != BATTERY_GOOD) {
        battery->why = (uint16_t)verdict;
    }
}

static void read(battery_t *battery, float volts, float cells, float step_s)
{
    const battery_verdict_t verdict = judge(battery, volts, cells);

    count(battery, verdict, step_s);
    battery->latest_v = volts;
    if (verdict == BATTERY_GOOD && battery->believed) {
        battery->volts += share_of(step_s, MEAN_S) * (volts - battery->volts);
    } else if (verdict == BATTERY_GOOD || (verdict == BATTERY_JUMPS && !battery->believed)) {
        battery->volts = volts; /* what follows is compared with it: another battery is believed soon */
    }
}

static void begin_watch(battery_t *battery, float pin_v)
{
    battery->least_v = pin_v;
    battery->most_v = pin_v;
    battery->watched_s = 0.0F;
}

/* In flight the current changes all the time, and the charge falls. */
static void watch(battery_t *battery, float pin_v, bool in_air, float step_s)
{
    if (!in_air || battery->watched_s == 0.0F) {
        begin_watch(battery, pin_v);
    }
    battery->least_v = at_most(battery->least_v, pin_v);
    battery->most_v = at_least(battery->most_v, pin_v);
    if (battery->most_v - battery->least_v > FROZEN_V) {
        battery->frozen = false;
        begin_watch(battery, pin_v);
    }
    battery->watched_s = in_air ? battery->watched_s + step_s : 0.0F;
    battery->frozen = in_air && (battery->frozen || battery->watched_s >= FROZEN_S);
}

/* From below_v for LOW_S on until it is above that by what a load takes: a battery that rests recovers. */
static void compare(battery_level_t *level, float cell_v, float below_v, float step_s)
{
    level->below_s = (cell_v < below_v) ? at_most(level->below_s + step_s, LOW_S) : 0.0F;
    if (level->below_s >= LOW_S) {
        level->reached = true;
    } else if (cell_v > below_v + CELL_LOAD_V) {
        level->reached = false;
    }
}

static void judge_charge(battery_t *battery, const parameters_t *parameters, float step_s)
{
    const float cell_v = battery->volts / cells_of(parameters);
    const float land_v = parameters->value[PARAMETER_VLAND];

    if (!battery->believed || battery->frozen) {
        battery->low.below_s = 0.0F;
        battery->empty.below_s = 0.0F;
        return;
    }
    compare(&battery->low, cell_v, at_least(parameters->value[PARAMETER_VLOW], land_v), step_s);
    if (battery->low.reached) { /* the warning comes first */
        compare(&battery->empty, cell_v, land_v, step_s);
    } else {
        battery->empty = (battery_level_t){.reached = false};
    }
}

void battery_step(battery_t *battery, const parameters_t *parameters, bool came, float pin_v, bool in_air,
                  float since_s)
{
    const float step_s = at_most(since_s, CYCLE_MAX_S);

    battery->silent_s = came ? 0.0F : at_most(battery->silent_s + step_s, MEAN_S);
    if (came) {
        read(battery, pin_v * parameters->value[PARAMETER_VDIV], cells_of(parameters), step_s);
        watch(battery, pin_v, in_air, step_s);
    } else if (battery->silent_s >= MEAN_S) {
        count(battery, BATTERY_ABSENT, step_s);
        battery->latest_v = NAN;
    }
    judge_charge(battery, parameters, step_s);
}

float battery_v(const battery_t *battery)
{
    return battery->believed ? battery->volts : battery->latest_v;
}

battery_verdict_t battery_verdict(const battery_t *battery, const parameters_t *parameters)
{
    if (parameters_choice(parameters, PARAMETER_BAT) == BAT_NONE) {
        return BATTERY_OFF;
    }
    if (!battery->believed) {
        const bool doubted = battery->why > (uint16_t)BATTERY_EMPTY;
        return doubted ? (battery_verdict_t)battery->why : BATTERY_WAITS;
    }
    if (battery->frozen) {
        return BATTERY_FROZEN;
    }
    if (battery->empty.reached) {
        return BATTERY_EMPTY;
    }
    return battery->low.reached ? BATTERY_LOW : BATTERY_GOOD;
}

bool battery_warns(battery_verdict_t verdict)
{
    return verdict > BATTERY_GOOD;
}

const char *battery_name(uint16_t verdict)
{
    return (verdict < (uint16_t)BATTERY_VERDICT_COUNT) ? names[verdict] : "?";
}
