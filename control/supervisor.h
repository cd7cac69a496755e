/* Who decides: observes the conditions of flight_state.h in each control cycle and follows its table from state to state.
 * Pure; time is an argument, the caller owns the state. Task context, TaskControl only (through flight.h). */
#ifndef CONTROL_SUPERVISOR_H
#define CONTROL_SUPERVISOR_H

#include <stdbool.h>
#include <stdint.h>

#include "control/flight_io.h"

/* What an estimator knows of the height above the terrain, now. */
typedef struct {
    bool known;                     /* false: the rest is not looked at */
    float height_mm;
    float climb_mm_s;               /* upwards, against the terrain */
    bool stands;                    /* known or not: too little thrust to fly, and no fall is measured */
    bool sways;                     /* likewise: the tilt moves as it does in the air */
} vertical_estimate_t;

/* The latest valid height. */
typedef struct {
    float height_mm;
    float rate_mm_s;                /* from the height before, within +-3000 and changing by at most 10 m/s2, so that a
                                     * step of the terrain counts little; 0 when the height before was lost */
    uint32_t gap_us;                /* between the two */
    uint32_t time_us;
    uint32_t sequence;
    uint32_t age_us;                /* grows from step to step and stops at one hour: no wrap */
    bool is_new;                    /* arrived since the previous step */
} height_track_t;

/* For how long something has been true, step after step. */
typedef struct {
    bool on;
    uint32_t for_us;                /* stops at one hour */
} hold_t;

typedef struct {
    flight_state_t state;
    uint16_t flags;                 /* FLIGHT_FLAG_* */
    float reference_m;              /* in force, 0 = none */
    uint32_t step_us;               /* time from the previous step to this one; 0 in the first */
    uint32_t state_us;              /* time since the state was entered, stops at one hour */
    height_track_t height;
    bool started;
    uint32_t now_us;
    uint32_t reference_sequence;
    bool land;
    uint32_t attitude_time_us;
    uint32_t attitude_age_us;
    uint32_t link_sequence;
    uint32_t link_age_us;
    hold_t aloft;
    hold_t rest;
    float rest_from_mm;
    uint16_t too_high_count;
    uint16_t lowerings;             /* see FLIGHT_IF_LOWERING_LIMIT */
    float estimated_peak_mm;        /* above the reference; NAN: no estimate */
    uint32_t estimate_age_us;
    uint16_t tilted_count;
    bool stands;
    bool pilots;                    /* the pilot had the throttle in the cycle before */
    bool handed_over;
    bool level;
} supervisor_t;

/* GROUND, nothing known. */
void supervisor_init(supervisor_t *supervisor);

/* One cycle: observes, then makes at most one transition. A #SETR puts its reference in force; a lost link withdraws
 * it, and so does entering GROUND, DESCENDING or CUT, and a landing after the third LOWERING, so that nothing but a new
 * #SETR flies again.
 * link_s: longest silence of the link, 0 = not armed. */
void supervisor_step(supervisor_t *supervisor, float link_s, const flight_inputs_t *in,
                     const vertical_estimate_t *estimate);

/* An estimate was known within the last 0.35 s. */
bool supervisor_has_estimate(const supervisor_t *supervisor);

#endif
