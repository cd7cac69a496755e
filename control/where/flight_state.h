/* Flight states, conditions, and the table of transitions. docs/flight_states.md shows the same table. The
 * supervisor evaluates the conditions (supervisor.h). The flags tell the operator what it found. Pure. */
#ifndef CONTROL_FLIGHT_STATE_H
#define CONTROL_FLIGHT_STATE_H

#include <stdint.h>

typedef enum {
    FLIGHT_GROUND,     /* on the ground: no thrust */
    FLIGHT_TAKEOFF,    /* a reference is set; on the ground or just leaving it; the law acts */
    FLIGHT_FLYING,     /* the law acts */
    FLIGHT_FLOATING,   /* in the air without a reference, or the pilot has the throttle: feed-forward */
    FLIGHT_COASTING,   /* no fresh height for a short time: the thrust settles to the hover thrust */
    FLIGHT_DESCENDING, /* no fresh height for a long time: limited descent without heights; only the
                        * ground ends it */
    FLIGHT_LANDING,    /* #SETR 0 in flight, or link lost: limited descent to the ground */
    FLIGHT_LOWERING,   /* above reference + 0.8 m: limited descent until below it again */
    FLIGHT_CUT,        /* tilted over 45 degrees: no thrust until level and at rest on the ground */
    FLIGHT_STATE_COUNT
} flight_state_t;

#define FLIGHT_FLAG_HEIGHT 1U   /* no fresh height, or never one */
#define FLIGHT_FLAG_ATTITUDE 2U /* no fresh IMU frame, or its offset is not known */
#define FLIGHT_FLAG_DISAGREE 4U /* the mirrors' heights disagree */
#define FLIGHT_FLAG_TOO_HIGH 8U /* above reference + 0.8 m, or LOWERING */
#define FLIGHT_FLAG_LINK 16U    /* link supervision is on and the link is silent */
#define FLIGHT_FLAG_TILT 32U    /* tilted over 45 degrees, or CUT */
#define FLIGHT_FLAG_PILOT 64U   /* the pilot has the throttle */
#define FLIGHT_FLAG_SIGHT 256U  /* doubt SIGHT: heights are not believed, facts.h */
/* doubt IMU: accelerations are not believed; or law EST gets none and flies without them */
#define FLIGHT_FLAG_IMU 512U
#define FLIGHT_FLAG_THRUST 1024U /* doubt THRUST: commands have no effect */
#define FLIGHT_FLAG_STICK 2048U  /* STICK PIN, and the stick does not count; set by task_control.c */
/* at rest a mirror does not show the ground, or the mirrors show another tilt than the IMU tells, or the
 * vehicle stands and its height is above 0.09 m */
#define FLIGHT_FLAG_MIRRORS 4096U
/* the reference is not reached: over 0.1 m off for 3 s, and no nearer; or a landing does not sink; set by
 * flight.c */
#define FLIGHT_FLAG_REACH 128U

/* Name as in the telemetry: "GROUND" and so on. Zero-terminated, static. */
const char *flight_state_name(flight_state_t state);

/* Conditions, as bits of one word. */
#define FLIGHT_IF_REFERENCE 1U   /* a reference above 0 is in force */
#define FLIGHT_IF_READY 2U       /* the IMU's offset is known, and its frames are fresh */
#define FLIGHT_IF_HEIGHT 4U      /* the latest valid height is at most 0.3 s old */
#define FLIGHT_IF_LOST 8U        /* the latest valid height is more than 1.5 s old, or there never was one */
#define FLIGHT_IF_OFF_GROUND 16U /* fresh height above 0.09 m */
/* fresh heights above 0.09 m and level (see below) for 1 s, and the tilt moves as in flight */
#define FLIGHT_IF_ALOFT 32U
/* fresh heights below 0.05 m that did not fall by 0.02 m, for 1 s in the present state. In LANDING and
 * DESCENDING also: for 0.6 s too little thrust to fly, and no measured fall */
#define FLIGHT_IF_AT_REST 64U
/* the vehicle will go above reference + 0.8 m. With an estimate: after 0.22 s more of the present climb and a
 * braking of 4 m/s2. From heights: two in a row; each with its own climb for 0.4 s more when there has been
 * no estimate for 0.35 s */
#define FLIGHT_IF_TOO_HIGH 128U
/* fresh height, and the predicted end of the motion (if there is an estimate) is below reference + 0.3 m */
#define FLIGHT_IF_RECOVERED 256U
#define FLIGHT_IF_LAND 512U             /* #SETR 0 arrived in this cycle */
#define FLIGHT_IF_DESCENT_TIMEOUT 1024U /* 45 s in DESCENDING: its thrust has fallen to 0 */
#define FLIGHT_IF_TILTED 2048U          /* three fresh attitudes in a row over 45 degrees */
#define FLIGHT_IF_LEVEL 4096U           /* fresh attitude within 18 degrees */
/* third LOWERING since the reference was set, or since 20 s of FLYING: the law cannot fly this vehicle */
#define FLIGHT_IF_LOWERING_LIMIT 8192U
#define FLIGHT_IF_HAS_THROTTLE 16384U /* the pilot does not have the throttle */
/* #ARM was given on the ground, there is no height, the tilt moves as in flight, and the pilot gave the
 * throttle back in this cycle; without a pin he may have */
#define FLIGHT_IF_HANDED_OVER 32768U
#define FLIGHT_IF_ALL 65535U

typedef struct {
    flight_state_t from;
    uint16_t all_of;  /* all of these must be true */
    uint16_t none_of; /* all of these must be false */
    flight_state_t to;
} flight_transition_t;

#define FLIGHT_TRANSITION_COUNT 43U
extern const flight_transition_t flight_transitions[FLIGHT_TRANSITION_COUNT];

/* Returns the target of the first row that applies, or `from` when none does. */
flight_state_t flight_next_state(flight_state_t from, uint16_t conditions);

#endif
