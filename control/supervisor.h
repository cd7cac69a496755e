/* Who decides: the flight states, the conditions observed in each control cycle, and the table of transitions between
 * the states. docs/flight_states.md shows the same table. Pure; time is an argument, the caller owns the state. Task
 * context, TaskControl only (through flight.h). */
#ifndef CONTROL_SUPERVISOR_H
#define CONTROL_SUPERVISOR_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/est/estimator.h"

typedef enum {
    FLIGHT_GROUND,      /* on the ground: no thrust */
    FLIGHT_TAKEOFF,     /* reference set, still on the ground or just leaving it: the law acts */
    FLIGHT_FLYING,      /* the law acts */
    FLIGHT_FLOATING,    /* airborne, without a reference or with a pilot who has the throttle: feed-forward */
    FLIGHT_COASTING,    /* height stale for a short time: last thrust settles to the hover thrust */
    FLIGHT_DESCENDING,  /* height stale for long: bounded descent without a height, latched */
    FLIGHT_LANDING,     /* #SETR 0 in flight, or link lost: bounded descent to the ground */
    FLIGHT_LOWERING,    /* above reference + 0.8 m: bounded descent until back below */
    FLIGHT_CUT,         /* tilted over 45 degrees: no thrust until level and at rest on the ground */
    FLIGHT_STATE_COUNT
} flight_state_t;

#define FLIGHT_FLAG_HEIGHT 1U       /* height stale or never valid */
#define FLIGHT_FLAG_ATTITUDE 2U     /* IMU stale or its offset unknown */
#define FLIGHT_FLAG_DISAGREE 4U     /* mirrors disagree */
#define FLIGHT_FLAG_TOO_HIGH 8U     /* above reference + 0.8 m, or LOWERING */
#define FLIGHT_FLAG_LINK 16U        /* armed link is silent */
#define FLIGHT_FLAG_TILT 32U        /* tilted over 45 degrees, or CUT */
#define FLIGHT_FLAG_PILOT 64U       /* the pilot has the throttle */
#define FLIGHT_FLAG_REACH 128U      /* the reference is not reached: over 0.1 m off for 3 s and no nearer; from flight.h */

/* What the cycle knows, copied from the servers. Times in microseconds on one wrapping 32-bit clock; a time slightly
 * later than now_us counts as now. Steps may not be more than 71 minutes apart. */
typedef struct {
    uint32_t now_us;
    bool height_valid;              /* the latest scan gave a height; false: altitude is not looked at */
    altitude_t altitude;            /* a height outside -500 .. 5000 mm or NaN is treated as not valid */
    uint32_t height_time_us;        /* arrival of the latest valid height; meaningless before the first */
    uint32_t height_sequence;       /* +1 per valid height; 0 = never one */
    bool attitude_ready;            /* offset known */
    float roll_rad;                 /* median of the latest five frames; not used by laws PD and PID */
    float pitch_rad;                /* likewise */
    uint32_t attitude_time_us;      /* arrival of the latest IMU frame */
    uint32_t height_stamp_ms;       /* 24-bit sensor time of that scan; for laws PIDT and EST */
    const motion_frame_t *frames;   /* the latest frames, oldest first, old ones again or not; for law EST; borrowed for
                                     * the call, NULL when frame_count is 0 */
    uint16_t frame_count;
    float reference_m;              /* looked at when its sequence changes; outside the limits of SETR: ignored */
    uint32_t reference_sequence;    /* +1 per accepted #SETR, 0 m included */
    uint32_t link_time_us;          /* arrival of the latest complete valid command line */
    uint32_t link_sequence;         /* +1 per such line; 0 = never one */
    bool has_throttle;             /* false: the pilot has it, as a pin says; true when nothing says it */
} flight_inputs_t;

/* What an estimator knows of the height above the terrain, now. */
typedef struct {
    bool known;                     /* false: the rest is not looked at */
    float height_mm;
    float climb_mm_s;               /* upwards, against the terrain */
} vertical_estimate_t;

/* Conditions, as bits of one word. */
#define FLIGHT_IF_REFERENCE 1U      /* a reference above 0 is in force */
#define FLIGHT_IF_READY 2U          /* the IMU's offset is known */
#define FLIGHT_IF_HEIGHT 4U         /* the latest valid height is at most 0.3 s old */
#define FLIGHT_IF_LOST 8U           /* the latest valid height is more than 1.0 s old, or there never was one */
#define FLIGHT_IF_OFF_GROUND 16U    /* fresh height above 0.15 m */
#define FLIGHT_IF_ALOFT 32U         /* fresh heights above 0.15 m for 1 s */
#define FLIGHT_IF_AT_REST 64U       /* fresh heights below 0.05 m that did not fall by 0.02 m for 1.2 s in the present
                                     * state */
#define FLIGHT_IF_TOO_HIGH 128U     /* an estimate from where the present climb, 0.25 s long and then braked by 4 m/s2, ends
                                     * above reference + 0.8 m; or two heights in a row, their own climb 0.15 s long, or
                                     * 0.4 s when there has been no estimate for 0.35 s */
#define FLIGHT_IF_RECOVERED 256U    /* fresh height, and estimate if known, from where it ends below reference + 0.3 m */
#define FLIGHT_IF_LAND 512U         /* #SETR 0 arrived in this cycle */
#define FLIGHT_IF_DESCENT_TIMEOUT 1024U       /* 45 s in DESCENDING: its thrust has faded out */
#define FLIGHT_IF_TILTED 2048U      /* three fresh attitudes in a row over 45 degrees */
#define FLIGHT_IF_LEVEL 4096U       /* fresh attitude within 20 degrees */
#define FLIGHT_IF_LOWERING_LIMIT 8192U       /* the third LOWERING since the reference was set or 20 s of FLYING: the law cannot fly
                                     * this vehicle */
#define FLIGHT_IF_HAS_THROTTLE 16384U       /* the pilot does not have the throttle */
#define FLIGHT_IF_ALL 32767U

typedef struct {
    flight_state_t from;
    uint16_t all_of;                /* conditions that must hold */
    uint16_t none_of;               /* conditions that must not hold */
    flight_state_t to;
} flight_transition_t;

#define FLIGHT_TRANSITION_COUNT 40U
extern const flight_transition_t flight_transitions[FLIGHT_TRANSITION_COUNT];

/* The first row of the table that applies, else the same state. */
flight_state_t flight_next_state(flight_state_t from, uint16_t conditions);

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

/* "GROUND", ... as shown by the telemetry. */
const char *flight_state_name(flight_state_t state);

#endif
