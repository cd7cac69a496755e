/* Tells from the power module's voltage how the battery is, and whether to believe the voltage.
 *
 * What is judged is the voltage under the load of a hover. A vehicle that keeps its height carries its weight
 * on average over seconds, so the mean current is that of a hover, and so is the sag; gusts make the voltage
 * dip for a moment only. So a slow mean and ten seconds are all that is needed, and no resistance has to be
 * known.
 *
 * What breaks: a divider that drifts slowly looks like a battery. So the warning comes first, and the
 * operator can switch all of this off (BAT NONE) in the air. Pure; the caller owns the state, all zero at
 * first. */
#ifndef CONTROL_BATTERY_H
#define CONTROL_BATTERY_H

#include <stdbool.h>
#include <stdint.h>

#include "control/parameters.h"

typedef enum {
    BATTERY_OFF,   /* BAT NONE */
    BATTERY_WAITS, /* not enough readings yet */
    BATTERY_GOOD,
    BATTERY_LOW,    /* below VLOW a cell for 10 s: a warning */
    BATTERY_EMPTY,  /* LOW, and below VLAND a cell for 10 s: it lands */
    BATTERY_ABSENT, /* from here on the voltage is not believed: too low for any battery that flies */
    BATTERY_HIGH,   /* more than a full battery of so many cells has */
    BATTERY_JUMPS,  /* changes by more than a load can cause */
    BATTERY_FROZEN, /* does not change at all in flight */
    BATTERY_VERDICT_COUNT
} battery_verdict_t;

typedef struct {
    float below_s; /* without a break */
    bool reached;
} battery_level_t;

typedef struct {
    float volts;    /* mean of the readings that may be this battery's; what they are compared with */
    float latest_v; /* reading, whatever it is; NAN: there is none */
    float good;     /* share of late readings that may be this battery's */
    bool believed;  /* most of them may */
    uint16_t why;   /* battery_verdict_t: what the latest other one was */
    float silent_s; /* since the latest reading */
    float least_v;  /* at the pin, in the present time of watching for a frozen one */
    float most_v;
    float watched_s;
    bool frozen;
    battery_level_t low, empty;
} battery_t;

/* One control cycle. came: the pin was read, pin_v. in_air: by the state of the flight. since_s: time since
 * the cycle before. */
void battery_step(battery_t *battery, const parameters_t *parameters, bool came, float pin_v, bool in_air,
                  float since_s);

/* Volts: the mean while they are believed, else what the latest reading tells. NAN: there is none. */
float battery_v(const battery_t *battery);

battery_verdict_t battery_verdict(const battery_t *battery, const parameters_t *parameters);

/* Whether it is a warning: low, empty, or not to be believed. */
bool battery_warns(battery_verdict_t verdict);

/* Name as in the telemetry: "LOW" and so on; BATTERY_OFF is "OFF". Zero-terminated, static. */
const char *battery_name(uint16_t verdict);

#endif
