/* Hover calibration on the bench. The vehicle is tied down with ropes. The throttle's compare value is
 * lowered step by step, which raises the thrust. The operator reads the thrust at which the ropes become
 * tight (in the seed document: 6.4 to 7 N, with the battery).
 *
 * It replaces the outputs of the control cycle in state GROUND only, so it never acts in flight. Pure; the
 * caller owns the state, all zero at first. Context: Task, TaskControl only. */
#ifndef CONTROL_CALIBRATION_H
#define CONTROL_CALIBRATION_H

#include <stdbool.h>
#include <stdint.h>

#include "control/flight.h"

#define CALIBRATION_STEP_COUNTS 30U /* the seed's, 0.17 N */
#define CALIBRATION_STEP_COUNTS_MAX 200U
#define CALIBRATION_PERIOD_S 5U /* the seed's */
#define CALIBRATION_PERIOD_MAX_S 60U

/* The operator's request. */
typedef struct {
    uint16_t sequence; /* +1 with every start and every stop */
    bool run;
    float idle_percent;   /* percent of the throttle's range; the first step is one step above it */
    uint16_t step_counts; /* 1..CALIBRATION_STEP_COUNTS_MAX, counts of THRUST_STEP_US */
    uint16_t period_s;    /* 1..CALIBRATION_PERIOD_MAX_S */
} calibration_request_t;

typedef enum {
    CALIBRATION_NONE, /* never run */
    CALIBRATION_RUNNING,
    CALIBRATION_STOPPED, /* the operator stopped it */
    CALIBRATION_LIMIT,   /* the next step would be above 8.5 N */
    CALIBRATION_LINK,    /* the link is silent, or link supervision is off */
    CALIBRATION_LIFTED,  /* height above 0.1 m, or no height: a rope may have broken */
    CALIBRATION_STATE    /* the flight state left GROUND, or a reference was set */
} calibration_end_t;

typedef struct {
    calibration_end_t end;
    uint16_t steps;          /* steps so far */
    uint16_t compare_counts; /* present compare value, or the last one */
    float thrust_n;          /* thrust of compare_counts, newtons per motor */
    uint16_t sequence;       /* latest request that was processed */
    uint32_t step_us;        /* time since the step began, at most one minute */
    uint32_t now_us;
} calibration_t;

/* One control cycle, after flight_step(). While the calibration runs, this replaces thrust and pulse in
 * *out. It starts one step above idle_percent, the idle that keeps the motors running. It makes one more
 * step after each period. It ends at once, with the idle, for the reasons in calibration_end_t. link_s:
 * the parameter LINK, longest silence of the link in seconds; 0 = supervision is off. */
void calibration_step(calibration_t *calibration, const calibration_request_t *request, float link_s,
                      const flight_inputs_t *in, flight_outputs_t *out);

/* Value for the parameter GRAV, newtons per motor, when thrust_n has just made the ropes tight. */
float calibration_gravity_n(const parameters_t *parameters, float thrust_n);

#endif
