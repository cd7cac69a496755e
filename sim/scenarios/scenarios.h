/* The flights: the seed's, and what each must look like. A scenario pins law, gains, gravity and release; it
 * types them on the operator's terminal like anybody else. And the bench, without a flight. */
#ifndef SIM_SCENARIOS_SCENARIOS_H
#define SIM_SCENARIOS_SCENARIOS_H

#include <stdbool.h>

#include "sim/scenarios/metrics.h"

#define SCENARIO_SETTINGS_MAX 16
#define SCENARIO_EXPECTATIONS_MAX 10
#define SCENARIO_LATER_MAX 80
#define SCENARIO_PLANT_MAX 48 /* a drawn vehicle's fifteen, and those of three lies */

typedef struct {
    double t_s;               /* complete at the receiver */
    const char *name, *value; /* NULL: no line */
} later_line_t;

typedef struct {
    metric_t metric;
    double minimum, maximum; /* inclusive; a metric that does not apply breaks it */
} expectation_t;

/* What the judgement of metrics_t.failed must be. */
typedef enum { FATE_SUCCEEDS, FATE_FAILS, FATE_EITHER } scenario_fate_t;

typedef struct {
    const char *name;
    const char *summary;
    const char *settings[SCENARIO_SETTINGS_MAX]; /* "LAW PID", ... NULL ends */
    later_line_t later[SCENARIO_LATER_MAX]; /* typed in flight; --set does not reach them; no name ends */
    const char *plant[SCENARIO_PLANT_MAX];  /* "plant.tau 0.1", ... NULL ends; --set wins */
    bool bench; /* the vehicle stands still: no flight, no commands; ends at end_s */
    double reference_m;
    const char *place;     /* where it flies and its way, the text of a place file; NULL: as platform says */
    bool platform;         /* the seed's ramp and platform; else an endless even floor */
    double tug_rate_per_s; /* rope tugs; 0 = none */
    double climb_rate_mps_per_n; /* that the throttle commands; 0 = it commands thrust */
    bool field_day; /* the autopilot's rules for motors, and a pilot who starts them and hands over */
    bool by_stick;  /* a field day without a radio: the pilot's stick sets the height, from 1 s on, and lands
                       it */
    const char *climb_settings[SCENARIO_SETTINGS_MAX]; /* instead of those of their names, where the throttle
                                                          commands a climb */
    double land_s;                                     /* #SETR 0 */
    double end_s;
    scenario_fate_t fate;
    expectation_t expectations[SCENARIO_EXPECTATIONS_MAX];
    int expectation_count;
} scenario_t;

extern const scenario_t scenarios[];
extern const int scenario_count;

/* NULL when there is none of that name. */
const scenario_t *scenario_find(const char *name);

/* The reference that this line puts in force; 0: it lands, or takes the vehicle from the law. NAN: none. */
double scenario_reference_m(const later_line_t *line);

/* True when every expectation holds; otherwise the first broken one is returned through *broken. */
bool scenario_met(const scenario_t *scenario, const metrics_t *metrics, const expectation_t **broken);

#endif
