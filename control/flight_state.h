/* The flight states, the conditions of a change and the table of transitions between them. docs/flight_states.md shows
 * the same table. The supervisor observes the conditions (supervisor.h); a flag tells the operator what it saw. Pure. */
#ifndef CONTROL_FLIGHT_STATE_H
#define CONTROL_FLIGHT_STATE_H

#include <stdint.h>

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
#define FLIGHT_FLAG_SIGHT 256U      /* heights are in doubt, integrity.h */
#define FLIGHT_FLAG_IMU 512U        /* accelerations are */
#define FLIGHT_FLAG_THRUST 1024U    /* commands have no effect */
#define FLIGHT_FLAG_REACH 128U      /* the reference is not reached: over 0.1 m off for 3 s and no nearer; from flight.h */

/* "GROUND", ... as shown by the telemetry. */
const char *flight_state_name(flight_state_t state);

/* Conditions, as bits of one word. */
#define FLIGHT_IF_REFERENCE 1U      /* a reference above 0 is in force */
#define FLIGHT_IF_READY 2U          /* the IMU's offset is known */
#define FLIGHT_IF_HEIGHT 4U         /* the latest valid height is at most 0.3 s old */
#define FLIGHT_IF_LOST 8U           /* the latest valid height is more than 1.5 s old, or there never was one */
#define FLIGHT_IF_OFF_GROUND 16U    /* fresh height above 0.15 m */
#define FLIGHT_IF_ALOFT 32U         /* fresh heights above 0.15 m for 1 s */
#define FLIGHT_IF_AT_REST 64U       /* fresh heights below 0.05 m that did not fall by 0.02 m for 1.2 s in the present
                                     * state; or, in LANDING and DESCENDING, less thrust than flies for 0.6 s,
                                     * and no fall is measured */
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
#define FLIGHT_IF_HANDED_OVER 32768U         /* the pilot gave the throttle back in this cycle, there is no height, and
                                     * the tilt sways as it does in the air */
#define FLIGHT_IF_ALL 65535U

typedef struct {
    flight_state_t from;
    uint16_t all_of;                /* conditions that must hold */
    uint16_t none_of;               /* conditions that must not hold */
    flight_state_t to;
} flight_transition_t;

#define FLIGHT_TRANSITION_COUNT 43U
extern const flight_transition_t flight_transitions[FLIGHT_TRANSITION_COUNT];

/* The first row of the table that applies, else the same state. */
flight_state_t flight_next_state(flight_state_t from, uint16_t conditions);

#endif
