/* Flight supervisor. In each control cycle it evaluates the conditions of flight_state.h, and makes at
 * most one transition of its table.
 *
 * Pure: time is an argument; the caller owns the state. Context: Task, TaskControl only (through
 * flight.h). Times named _us are in microseconds. */
#ifndef CONTROL_SUPERVISOR_H
#define CONTROL_SUPERVISOR_H

#include <stdbool.h>
#include <stdint.h>

#include "control/flight_io.h"

/* Present estimate of the height above the terrain. */
typedef struct {
    bool known; /* false: height and climb are not read */
    float height_mm;
    float climb_mm_s; /* > 0 is up, relative to the terrain */
    float felt_mm_s;  /* vertical speed by the accelerometer, > 0 is up: the terrain is no part of it; valid
                       * also without `known` */
    bool tells_falls; /* felt_mm_s tells ground that falls from a climb: law EST flies, two mirrors agree, and
                       * the accelerometer is believed */
    bool stands;      /* too little thrust to fly, and no fall is measured; valid also
                       * without `known` */
    float upright;    /* cosine of the tilt of *in; valid also without `known` */
    bool sways;       /* the tilt moves as it does in flight; valid also without `known` */
    bool calm;        /* the tilt is still; between the two neither is certain; valid also without `known` */
    bool rocks;       /* the same within the last 0.8 s */
    bool hands_over;  /* #ARM lets the tilt alone tell a pilot's flight, arming.h */
    bool in_hands;    /* GROUND: no pin tells who has the throttle, there is no height, and a pilot flies;
                       * DESCENDING: it may be so yet */
} vertical_estimate_t;

/* The latest valid height. */
typedef struct {
    float height_mm;
    float rate_mm_s; /* from the previous height to this one. Limited to +-3000, and to a
                      * change of 10 m/s2, so that a step of the terrain has little effect;
                      * 0 when the previous height was lost */
    uint32_t gap_us; /* time between these two heights */
    uint32_t time_us;
    uint32_t sequence;
    uint32_t age_us; /* age of this height; at most one hour, so it does not wrap */
    bool is_new;     /* arrived after the previous step */
} height_track_t;

/* For how long a condition has been true without a break. */
typedef struct {
    bool on;
    uint32_t for_us; /* at most one hour */
} hold_t;

/* The tilt. */
typedef struct {
    uint32_t time_us, age_us; /* of the latest frame */
    uint16_t tilted_count;    /* frames in a row that were tilted over, as many as count */
    bool level;
} attitude_watch_t;

/* The commands' link. */
typedef struct {
    uint32_t sequence;
    uint32_t age_us; /* of the latest line */
} link_watch_t;

/* The ground below, by heights. */
typedef struct {
    hold_t aloft, rest;
    hold_t ours;          /* the firmware has the throttle */
    hold_t watched, high; /* it rests with a height above 0.09 m; and that height stays */
    bool stands_high;     /* so it stands, and its height does not show the ground */
    float rest_from_mm, high_from_mm;
    float height_mm; /* measured where it stands, when the height did not show that; else 0 */
    bool sought;     /* the vehicle stands, and no height was measured there yet */
} ground_watch_t;

/* Climbs over the reference. */
typedef struct {
    uint16_t too_high_count;
    uint16_t lowerings;      /* see FLIGHT_IF_LOWERING_LIMIT */
    float flown_mm;          /* above a descent at 0.3 m/s that began near the reference; at most FLOWN_MM */
    bool fallen;             /* its height above the reference was not flown: the ground has fallen */
    float estimated_peak_mm; /* predicted top of the motion, above the reference; NAN: no estimate */
    uint32_t estimate_age_us;
} climb_watch_t;

typedef struct {
    flight_state_t state;
    uint16_t flags;    /* FLIGHT_FLAG_* */
    float reference_m; /* reference in force, 0 = none */
    uint32_t step_us;  /* time since the previous step; 0 in the first one */
    uint32_t state_us; /* time in the present state, at most one hour */
    height_track_t height;
    bool started;
    uint32_t now_us;
    uint32_t reference_sequence;
    bool land;
    attitude_watch_t attitude;
    link_watch_t link;
    ground_watch_t ground;
    climb_watch_t climb;
    bool stands;
    /* The latest state and conditions that made no transition; FLIGHT_STATE_COUNT: none. */
    flight_state_t kept_state;
    uint16_t kept_conditions;
    bool rocks;  /* landing or descending, and the tilt moves as it does in flight */
    bool pilots; /* the pilot had the throttle in the previous cycle */
    bool sways;  /* the tilt moves as it does in flight */
    bool handed_over;
    bool in_hands;
} supervisor_t;

/* Starts in GROUND, with nothing known. */
void supervisor_init(supervisor_t *supervisor);

/* One cycle: evaluates the conditions, then makes at most one transition. link_s: the parameter LINK,
 * longest silence of the link in seconds; 0 = supervision is off.
 *
 * A #SETR sets the reference. These clear it, so that only a new #SETR flies again: a lost link; entering
 * GROUND, DESCENDING or CUT; a landing after the third LOWERING; standing with a height above 0.09 m. */
void supervisor_step(supervisor_t *supervisor, float link_s, const flight_inputs_t *in,
                     const vertical_estimate_t *estimate);

/* True when it stands on the ground, by state and heights. */
bool supervisor_is_at_rest(const supervisor_t *supervisor);

/* True when an estimate was known within the last 0.35 s. */
bool supervisor_has_estimate(const supervisor_t *supervisor);

#endif
