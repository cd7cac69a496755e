/* What a flight was like: figures of the true height, from 100 Hz samples in scenario time (t = 1.0 s: #SETR
 * complete at the receiver).
 *
 * "reference" is the one in force. For 5 s after another one was ordered, and without one, the vehicle is on
 * its way: such samples count neither in the windows of overshoot, hover, terrain and recovery, nor in the
 * largest error, nor in `failed`. */
#ifndef SIM_SCENARIOS_METRICS_H
#define SIM_SCENARIOS_METRICS_H

#include <stdbool.h>
#include <stddef.h>

#define METRICS_REFERENCE_S 1.0 /* the reference arrives */
#define METRICS_EDGE_S 11.02    /* recovery counts from here */
#define METRICS_RECOVERY_END_S 15.0

/* Sources that the firmware may doubt, as bits. */
#define METRICS_SIGHT 1U
#define METRICS_IMU 2U
#define METRICS_THRUST 4U
#define METRICS_SOURCES 3

typedef struct {
    double t_s, height_m, speed_mps, thrust_n; /* thrust: commanded */
    bool taken_over;    /* the supervisor has taken the vehicle from the law: LOWERING or DESCENDING */
    bool coming_down;   /* by the supervisor's order, and nothing but a new reference ends it: DESCENDING,
                           LANDING */
    double clearance_m; /* between the gear and what carries it */
    bool on_ground;
    bool ours;         /* the firmware has the throttle */
    unsigned doubts;   /* sources that it doubts */
    bool may_cut;      /* the firmware has the throttle, and the vehicle is not truly tilted by more than 45
                          degrees */
    bool flagged;      /* the firmware doubts something, and says so */
    double estimate_m; /* the height that the law acts on; NAN: none */
    double seen_m;     /* the true height above what the beam sees */
    double altitude_m; /* above the floor, whatever stands on it */
} metrics_sample_t;

typedef enum {
    METRIC_RISE_TIME_S,  /* 10 to 90 % of the first reference */
    METRIC_OVERSHOOT_MM, /* highest above the reference, 1-5.5 s, at least 0 */
    METRIC_HOVER_RMS_MM, /* of height - reference over the hover windows */
    METRIC_HOVER_MEAN_ERROR_MM,
    METRIC_TERRAIN_RMS_MM, /* 7.2-15 s */
    METRIC_RECOVERY_S, /* last instant in 11.02-15 s with |error| > 50 mm, minus 11.02; 3.98 if never within
                        */
    METRIC_SETTLED_S, /* after the edge: the last instant with |error| > 50 mm before half a second within it,
                       * minus 11.02. A later gust is not the edge's */
    METRIC_UNDERSHOOT_MM, /* deepest below the reference, 11.02-15 s, at least 0 */
    METRIC_GROUND_CONTACTS,
    METRIC_THRUST_STD_N, /* of the commanded thrust over the hover windows */
    METRIC_SCANS,
    METRIC_SCANS_REJECTED,
    METRIC_COMMANDS_OK,
    METRIC_COMMANDS_ERR,
    METRIC_MAX_ERROR_MM, /* largest |height - reference|, 6 s to the landing command; NAN: always on its way
                          */
    METRIC_ALTITUDE_ERROR_MM, /* largest |altitude above the floor - reference|, likewise, on its way too */
    METRIC_HIGHEST_MM, /* above the highest reference ordered so far, from the first one to the end of the
                          flight */
    METRIC_TOUCH_SPEED_MPS, /* hardest touch: fastest fall within the last 30 mm; NAN when it never came down
                             */
    METRIC_TAKEOVERS, /* times that the supervisor took over before the landing command; on the way down to a
                       * lower reference it may */
    METRIC_CUTS,      /* times that the thrust was cut above 30 mm, landing included */
    METRIC_OFF_ALOFT, /* times that the motors were off for 0.2 s above 0.3 m, and nothing had ordered it */
    METRIC_DOWN_S,    /* on the ground for good, after the landing command or a descent by the supervisor that
                       * was not called off, whichever comes first; NAN: never */
    METRIC_STOPPED_S, /* and with the motors off; NAN: never */
    METRIC_DECEIVED_S, /* longest time for which the height that the law acts on was wrong by more than 0.3 m
                        * in the air without a flag */
    METRIC_FLAGGED_S,  /* time with a flag in the air, before the landing command */
    METRIC_AGAIN_RMS_MM,     /* of height - first reference, 5 to 8 s after the field day's second take-off */
    METRIC_BY_EYE_RMS_MM,    /* likewise while its pilot holds the height */
    METRIC_MOTOR_STOPS,      /* times that the autopilot stopped the motors in the air */
    METRIC_MOTORS_AT_END,    /* 1: they still run */
    METRIC_LANDED_UNORDERED, /* times that a flight ended by itself: on the ground for a second, with a
                              * reference in force and the firmware's the throttle */
    METRIC_SIGHT_DOUBTS,  /* times that the firmware began to doubt the heights, in the air before the landing
                             command, the throttle being its own */
    METRIC_IMU_DOUBTS,    /* the accelerations */
    METRIC_THRUST_DOUBTS, /* the effect of its commands */
    METRIC_OFF_S,    /* longest time for which it was more than 0.3 m off the reference in force, to the same
                      * side; counted once that was reached, or ordered 8 s ago */
    METRIC_ALOFT_S,  /* time in the air before the landing command, the throttle being the firmware's */
    METRIC_COLLIDED, /* 1: has flown into something */
    METRIC_COUNT
} metric_t;

extern const char *const metric_names[]; /* METRIC_COUNT */

/* A metric that does not apply (never rose, no terrain) is NAN, and null in JSON. */
typedef struct {
    double value[METRIC_COUNT];
    bool untold[METRIC_COUNT]; /* its window was not over, or not begun, when the landing command came: NAN */
    bool failed;
    const char
        *failure; /* "never reached 90 %", "rose above reference + 1 m", "more than 0.55 m off", or NULL */
} metrics_t;

/* What the samples so far have told; private. Any number of them, in the order of their times. */
typedef struct {
    double n, sum, squares;
} metrics_moments_t;

typedef struct {
    double reference_m; /* the first one */
    bool terrain;   /* ramp and platform: hover is 4.5-7.2 s and 15-20 s; flat ground: 6 s to the landing */
    double land_s;  /* the landing command */
    bool field_day; /* set behind metrics_begin() */
    size_t count;
    metrics_sample_t before;
    metrics_moments_t hover, thrust, ramp, again, by_eye;
    double tenth_s, ninety_s; /* first time at 10 and 90 % of the reference; NAN: not yet */
    double overshoot_mm, undershoot_mm, last_off_s;
    double unsettled_s; /* last_off_s before half a second within */
    bool edge_seen;     /* a sample counted behind it */
    double largest_mm, altitude_mm, highest_mm;
    bool dropped; /* it stood without thrust on a platform that went away */
    double fall_mps, hardest_mps;
    bool airborne;
    double takeovers, cuts, off_aloft;
    double aloft_since_s; /* above 30 mm without a break; NAN: not */
    double off_since_s, wrong_since_s, deceived_s, flagged_s;
    double wanted_m, highest_wanted_m, ordered_s; /* the reference in force, and since when */
    double changed_s;                             /* since when it is another one than before */
    bool lowered;                                 /* it is lower than the one before */
    bool reached, flew;                           /* that reference; off the ground by it */
    double stood_since_s, landed_unordered;
    unsigned doubts;
    double doubted[METRICS_SOURCES];
    int off_side; /* of the reference: 1 above, -1 below */
    double aside_since_s, aside_s, in_air_s;
    double order_s, aloft_s,
        running_s; /* coming down since; last seen in the air; last seen with running motors */
    bool too_high, off_course;
} metrics_record_t;

void metrics_begin(metrics_record_t *record, double reference_m, bool terrain, double land_s);
/* Another reference than that of metrics_begin() is in force from t_s on; 0: it lands. */
void metrics_order(metrics_record_t *record, double t_s, double reference_m);
void metrics_add(metrics_record_t *record, const metrics_sample_t *sample);
/* After the landing command or a descent by the supervisor: on the ground, with the motors off, for a second.
 */
bool metrics_over(const metrics_record_t *record);

/* Whether the figure says something only of a flight whose orders and times were planned, and of none that
 * people fly: its window, or its beginning, is of the plan. */
bool metrics_needs_plan(metric_t metric);

/* Fills everything that follows from the samples; the counters are left at 0. */
void metrics_compute(const metrics_record_t *record, metrics_t *metrics);

#endif
