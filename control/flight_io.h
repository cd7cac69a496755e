/* Inputs and outputs of one control cycle. TaskControl fills the inputs from the servers, and publishes
 * the outputs unchanged. */
#ifndef CONTROL_FLIGHT_IO_H
#define CONTROL_FLIGHT_IO_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/where/flight_state.h"
#include "control/imu_axes.h"
#include "control/imu_sample.h"
#include "control/signal.h"
#include "control/thrust.h"

/* Highest reference. State LOWERING begins 0.8 m above the reference: that is within the scanner's
 * 4.095 m. */
#define FLIGHT_REFERENCE_MAX_M 3.0F

/* Inputs of one cycle, copied from the servers. Times are in microseconds on one wrapping 32-bit clock. A
 * time slightly later than now_us counts as now_us. Two cycles must not be more than 71 minutes apart. */
typedef struct {
    uint32_t now_us;
    bool height_valid;          /* the latest scan gave a height; false: altitude is not read */
    altitude_t altitude;        /* a height outside -50 .. 5000 mm, or NaN, counts as not valid */
    const altitude_t *mirrors;  /* by mirror_t, each mirror's own; `altitude` is their mean. Borrowed for
                                 * the call; NULL: `altitude` is the only one */
    uint32_t height_time_us;    /* arrival of the latest valid height; undefined before the first */
    uint32_t height_sequence;   /* +1 per valid height; 0 = never one */
    bool attitude_ready;        /* the offset of the angles is known */
    float roll_rad;             /* median of the latest five frames, > 0: mirror's side up; not used by
                                 * laws PD and PID */
    float pitch_rad;            /* as roll_rad, > 0: nose up */
    uint16_t tilted_frames;     /* consecutive frames over 45 degrees; not read when frames is NULL */
    uint32_t attitude_time_us;  /* arrival of the latest IMU frame */
    uint32_t height_stamp_ms;   /* 24-bit sensor time of that scan; for laws PIDT and EST */
    uint32_t height_age_us;     /* from its rays to its arrival, when nothing delays it; for PIDT and
                                 * EST */
    const imu_sample_t *frames; /* latest frames, oldest first, for law EST. May contain frames of
                                 * earlier cycles. Borrowed for the call; NULL when frame_count is 0 */
    uint16_t frame_count;
    float reference_m;           /* metres, read when reference_sequence changes; ignored outside 0 ..
                                  * FLIGHT_REFERENCE_MAX_M */
    uint32_t reference_sequence; /* +1 per accepted #SETR, 0 m included */
    uint32_t link_time_us;       /* arrival of the latest complete valid command line */
    uint32_t link_sequence;      /* +1 per such line; 0 = never one */
    bool arm;                    /* latest request to arm (or disarm); read when arm_sequence changes */
    uint32_t arm_sequence;
    bool has_throttle; /* false: the pilot has the throttle (from the pin); always true without
                        * the pin */
} flight_inputs_t;

/* Events that can release the next cycle, as bits of one word. A cycle also runs after a time-out. */
#define FLIGHT_RELEASE_PERIOD 1U /* the control period */
#define FLIGHT_RELEASE_HEIGHT 2U /* a scan, with a height or without one */
#define FLIGHT_RELEASE_FRAME 4U  /* an IMU frame */

/* What three mirrors show of themselves and of the IMU; LAYOUT THREE alone. */
typedef struct {
    float rest_mm[MIRROR_COUNT]; /* height by each mirror at the latest rest; NAN: none */
    uint16_t wrong;              /* bits by mirror_t: at rest it did not show the ground */
    imu_fault_t imu;             /* of the IMU, sense/plane.h */
    float off_roll_rad; /* angle that the IMU tells, less the one that the mirrors show; NAN: not known */
    float off_pitch_rad;
} flight_mirrors_t;

/* True when two mirrors would outvote the one that is right. A single one is outvoted itself. */
static inline bool flight_mirrors_outvote(const flight_mirrors_t *mirrors)
{
    return (mirrors->wrong & (uint16_t)(mirrors->wrong - 1U)) != 0U;
}

typedef struct {
    float thrust_n; /* commanded, newtons per motor, 0 .. THRUST_MAX_N */
    float pulse_us; /* throttle pulse, thrust.h */
    float idle_n;   /* minimum of thrust_n: the idle while armed, else 0 */
    float hover_n;  /* hover thrust as far as it is known, where/hover_thrust.h */
    flight_state_t state;
    uint16_t flags;        /* FLIGHT_FLAG_* */
    uint16_t reason;       /* of the first doubt, verdict_reason_t of sense/verdict.h; 0: none */
    uint16_t bound;        /* that holds the thrust, bound_t of bounds.h; 0: none */
    imu_fault_t imu_fault; /* by gravity, or by the mirrors */
    flight_mirrors_t mirrors;
    bool stands_high;         /* GROUND, and its height does not show the ground it stands on */
    float reference_m;        /* reference in force, 0 = none */
    float height_mm;          /* of the latest scan, believed or not; NAN: that scan gave none */
    float estimate_mm;        /* height that the law uses; NAN: not known */
    float innovation_mm;      /* latest height minus predicted height; NAN where nothing is predicted */
    float stick_us;           /* pulse of the pilot's stick; NAN: none to believe; set by task_control.c */
    uint16_t battery;         /* battery_verdict_t of battery.h; this and the next set by task_control.c */
    float battery_v;          /* NAN: not measured */
    uint16_t releases;        /* FLIGHT_RELEASE_*: events that release the next cycle */
    float lies[MIRROR_COUNT]; /* probability that this mirror lies, by mirror_t; NAN: nobody asked, LAYOUT has
                               * one mirror */
    uint16_t left_out; /* bits: mirrors of the latest scan that gave a height, and that the vote left out */
    scan_signal_t signal; /* of the latest scan; set by task_control.c */
} flight_outputs_t;

/* True when the mirrors show too little of the ground to take off by them. */
static inline bool flight_mirrors_forbid(const flight_outputs_t *flight)
{
    return flight->stands_high || flight_mirrors_outvote(&flight->mirrors);
}

/* Before the first cycle. */
#define FLIGHT_OUTPUTS_INITIAL \
    { \
        .pulse_us = THRUST_IDLE_PULSE_US, .height_mm = NAN, .estimate_mm = NAN, .innovation_mm = NAN, \
        .stick_us = NAN, .battery_v = NAN, .lies = {NAN, NAN, NAN}, .mirrors = { \
            .rest_mm = {NAN, NAN, NAN}, \
            .off_roll_rad = NAN, \
            .off_pitch_rad = NAN \
        } \
    }

#endif
