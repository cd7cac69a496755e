/* Hover calibration on the bench: with the vehicle tied down, the throttle's compare value is lowered step by step, so
 * that the thrust at which the ropes go tight can be read off (seed document, found so: 6.4 to 7 N with the battery). An
 * overlay on the control cycle: it acts in GROUND alone, never on what flies. Pure; the caller owns the state, which starts
 * as all zero. Task context, TaskControl only. */
#ifndef CONTROL_CALIBRATION_H
#define CONTROL_CALIBRATION_H

#include <stdbool.h>
#include <stdint.h>

#include "control/flight.h"

#define CALIBRATION_STEP_COUNTS 30U     /* the seed's, 0.17 N */
#define CALIBRATION_STEP_COUNTS_MAX 200U
#define CALIBRATION_PERIOD_S 5U         /* the seed's */
#define CALIBRATION_PERIOD_MAX_S 60U

/* What the operator wants. */
typedef struct {
    uint16_t sequence;      /* +1 with every start and every stop */
    bool run;
    float idle_percent;     /* of the throttle's range: one step above it is the first */
    uint16_t step_counts;   /* 1..CALIBRATION_STEP_COUNTS_MAX, counts of THRUST_STEP_US */
    uint16_t period_s;      /* 1..CALIBRATION_PERIOD_MAX_S */
} calibration_request_t;

typedef enum {
    CALIBRATION_NONE,       /* never run */
    CALIBRATION_RUNNING,
    CALIBRATION_STOPPED,    /* by the operator */
    CALIBRATION_LIMIT,      /* another step would be above 8.5 N */
    CALIBRATION_LINK,       /* the link was lost, or is not armed */
    CALIBRATION_LIFTED,     /* a height above 0.1 m, or none: a rope gave way, or nobody can tell */
    CALIBRATION_STATE       /* the flight state left GROUND */
} calibration_end_t;

typedef struct {
    calibration_end_t end;
    uint16_t steps;         /* made so far */
    uint16_t compare_counts;/* in force, or the last that was */
    float thrust_n;         /* likewise, newtons per motor */
    uint16_t sequence;      /* of the latest request seen */
    uint32_t step_us;       /* time within the step, stops at a minute */
    uint32_t now_us;
} calibration_t;

/* One control cycle, after flight_step(): while it runs, the thrust and the pulse of *out are replaced. It starts one step
 * above the idle that keeps motors turning, makes another after each period, and ends, at once and with idle, for the reasons above. link_s: the
 * armed silence of the link, 0 = not armed. */
void calibration_step(calibration_t *calibration, const calibration_request_t *request, float link_s,
                      const flight_inputs_t *in, flight_outputs_t *out);

/* What to set GRAV to when that thrust has just tightened the ropes. */
float calibration_gravity_n(const parameters_t *parameters, float thrust_n);

#endif
