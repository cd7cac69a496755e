/* What goes into one control cycle and what comes out of it. TaskControl fills the inputs from the servers and publishes
 * the outputs as they are. */
#ifndef CONTROL_FLIGHT_IO_H
#define CONTROL_FLIGHT_IO_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/flight_state.h"
#include "control/imu_sample.h"

/* Highest reference: the take-over at 0.8 m above it is still within the scanner's 4.095 m. */
#define FLIGHT_REFERENCE_MAX_M 3.0F

/* What the cycle knows, copied from the servers. Times in microseconds on one wrapping 32-bit clock; a time slightly
 * later than now_us counts as now. Steps may not be more than 71 minutes apart. */
typedef struct {
    uint32_t now_us;
    bool height_valid;              /* the latest scan gave a height; false: altitude is not looked at */
    altitude_t altitude;            /* a height outside -50 .. 5000 mm or NaN is treated as not valid */
    uint32_t height_time_us;        /* arrival of the latest valid height; meaningless before the first */
    uint32_t height_sequence;       /* +1 per valid height; 0 = never one */
    bool attitude_ready;            /* offset known */
    float roll_rad;                 /* median of the latest five frames; not used by laws PD and PID */
    float pitch_rad;                /* likewise */
    uint16_t tilted_frames;         /* frames in a row over 45 degrees, where they come faster than cycles; or 0 */
    uint32_t attitude_time_us;      /* arrival of the latest IMU frame */
    uint32_t height_stamp_ms;       /* 24-bit sensor time of that scan; for laws PIDT and EST */
    uint32_t height_age_us;         /* its rays to its arrival, when nothing hinders it; for the same laws */
    const imu_sample_t *frames;   /* the latest frames, oldest first, old ones again or not; for law EST; borrowed for
                                     * the call, NULL when frame_count is 0 */
    uint16_t frame_count;
    float reference_m;              /* looked at when its sequence changes; outside 0 .. FLIGHT_REFERENCE_MAX_M: ignored */
    uint32_t reference_sequence;    /* +1 per accepted #SETR, 0 m included */
    uint32_t link_time_us;          /* arrival of the latest complete valid command line */
    uint32_t link_sequence;         /* +1 per such line; 0 = never one */
    bool arm;                       /* the operator's latest wish; looked at when its sequence changes */
    uint32_t arm_sequence;
    bool has_throttle;             /* false: the pilot has it, as a pin says; true when nothing says it */
} flight_inputs_t;

/* Events that can release the next cycle, as bits of one word. It also runs after a time-out. */
#define FLIGHT_RELEASE_PERIOD 1U    /* the control period */
#define FLIGHT_RELEASE_HEIGHT 2U    /* a scan, with a height or without one */
#define FLIGHT_RELEASE_FRAME 4U     /* an IMU frame */

typedef struct {
    float thrust_n;                 /* commanded, newtons per motor, 0 .. THRUST_MAX_N */
    float pulse_us;                 /* throttle pulse, thrust.h */
    float idle_n;                   /* least thrust_n in force: the armed idle, or 0 */
    flight_state_t state;
    uint16_t flags;                 /* FLIGHT_FLAG_* */
    uint16_t doubts;                /* DOUBT_*, integrity.h */
    float reference_m;              /* reference in force, 0 = none */
    float estimate_mm;              /* height that the law acts on; NAN: none is known */
    float innovation_mm;            /* latest height less its prediction; NAN where nothing is predicted */
    uint16_t releases;              /* FLIGHT_RELEASE_*: what the next cycle waits for */
} flight_outputs_t;

#endif
