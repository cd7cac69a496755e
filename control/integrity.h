/* Consistency check of the sensors. Three sources tell how the vehicle moves vertically: the heights, the
 * accelerometer, and the commanded thrust together with the vehicle's model. Each of them may be wrong. A
 * source is doubted when it contradicts the two others:
 *
 *   the heights contradict both others          DOUBT_SIGHT: treat the heights as lost
 *   the accelerometer contradicts both others   DOUBT_IMU: fly without accelerations
 *   the thrust contradicts both others          DOUBT_THRUST: a pilot flies, or something holds the vehicle;
 *                                               the thrust stays near the last known hover thrust
 *
 * A witness is a vertical speed by dead reckoning, from the accelerometer (`felt`) or from the thrust and the
 * vehicle's model (`pushed`). The heights only correct the first one, slowly. A witness's innovation is the
 * measured change of the height minus the change that this speed predicts. The innovation is summed up in a
 * leaky integrator. A sum that grows large means that the heights and this witness contradict each other.
 *
 * A single step of the height, however high, is a step of the terrain and adds nothing to these sums. A
 * blocked beam first looks like a step of the terrain too. But then the height stays constant while the
 * vehicle moves, and that shows in the sums.
 *
 * Three more checks. Identical scans are copies and are rejected. An accelerometer that does not measure g at
 * rest is doubted. A tilt that jumps is accepted only after it has lasted for some frames.
 *
 * Metres, seconds, newtons per motor, radians; positive is upwards. Times named _us are on one wrapping
 * 32-bit clock. Pure: no clock and no static state; the caller owns the state. Context: one Task, in the
 * order of flight_step(): tilt, frames, thrust, then scan and height when there is a new scan. No function
 * waits or reports an error; inputs that are not finite are rejected where the contract says so. */
#ifndef CONTROL_INTEGRITY_H
#define CONTROL_INTEGRITY_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/est/estimator.h"

#define INTEGRITY_SCANS 12U /* chosen: 1.2 s at ten scans a second */
#define INTEGRITY_BLOCKS 4U /* chosen: a pilot's lift-off is noticed after two seconds or three */

/* Bits of integrity_t.doubts. */
#define DOUBT_SIGHT 1U
#define DOUBT_IMU 2U
#define DOUBT_THRUST 4U

/* Vertical motion by dead reckoning from one source. */
typedef struct {
    float speed_mps; /* predicted vertical speed */
    float off_m;     /* leaky sum of the innovations: measured minus predicted change of the height */
    float seen_m;    /* off_m at the instant when the rays of the latest height were taken */
    float moved_m;   /* length of the predicted path since the sums were last cleared, >= 0 */
    float running_s; /* time since its start, at most 2 s */
} witness_t;

/* State of the flight, as far as the checks need it. Some fields are from the previous cycle, because the
 * present one is not yet decided. */
typedef struct {
    float step_s;    /* time since the previous cycle */
    bool grounded;   /* state GROUND: on the ground without thrust */
    bool standing;   /* take-off commanded; the vehicle has not left the ground, as far as is known */
    bool off_ground; /* only its own thrust carries the vehicle: the witness of the thrust is valid */
    bool ours;       /* false: the pilot has the throttle */
    bool ordered;    /* a new #SETR; on the ground it clears DOUBT_SIGHT and DOUBT_THRUST */
    float thrust_n;  /* commanded thrust, less the dead band */
    float authority_mps2_per_n, damping_per_s; /* vehicle model, as in cascade.h */
    float hover_n;                             /* sure hover thrust, see flight.h */
    float wanted_m;   /* reference minus height, > 0: the law wants to climb; NAN: no height is held */
    float noise_mps2; /* rms noise of the accelerometer, measured by the estimator */
} flown_t;

/* Read doubts, tilt and the fields that flight.c uses; written only by the functions below. */
typedef struct {
    uint16_t doubts; /* DOUBT_* */
    /* tilt */
    bool levelled;             /* at least one tilt was accepted */
    float roll_rad, pitch_rad; /* latest accepted tilt */
    float upright;             /* its cosine */
    uint16_t jumped;           /* tilts in a row that were rejected because they jumped */
    float told_rad[2];         /* roll and pitch of the latest of them */
    uint16_t tilted;           /* frames in a row above 45 degrees, their accepted tilt too */
    uint32_t tilt_time_us;     /* arrival of the latest tilt, accepted or not */
    uint32_t tilt_sequence;    /* latest frame that integrity_tilt() processed */
    uint32_t unfit_sequence;   /* frames up to this one must not be used: their tilt was rejected */
    /* scans */
    float slant_mm, spread_mm;        /* of the latest scan */
    bool below_ground;                /* heights so low that no noise explains them: the beam is blocked */
    uint16_t copies;                  /* scans in a row that repeat the scan before */
    float slants_mm[INTEGRITY_SCANS]; /* latest slant distances, oldest first */
    uint16_t scans;                   /* number of valid entries in slants_mm */
    bool flat;                        /* these vary by less than 8 mm rms, and the accelerometer is quiet */
    uint16_t rigid; /* scans in a row whose slants vary less than those of any flying vehicle */
    uint16_t still; /* scans in a row whose slants contain only white noise */
    uint16_t white; /* while the tilt sways: such scans, less those that contain more; 0 or above */
    /* heights */
    bool has_height;      /* at least one height was received */
    float height_m;       /* latest height */
    float rise_mps;       /* low-passed rate of the heights, without steps */
    float slower_mps;     /* speed of the slower witness, low-passed like rise_mps */
    float way_m;          /* leaky sum of the height changes since the latest step */
    float unmoved_s;      /* time since way_m was last large, at most 1 s; 1 s after a step */
    bool unconfirmed;     /* after a take-off or a step of the terrain towards the vehicle: no climb has shown
                           * in the heights since. The beam may be blocked */
    bool standing;        /* on the ground, or take-off commanded and not yet off the ground */
    bool proved;          /* the heights have confirmed a climb since the ground */
    bool terrain_fell;    /* the terrain has fallen far, and no descent has shown in the heights since */
    float after_fall_m;   /* height after that step */
    float ground_m;       /* latest height in state GROUND, at most 0: a pilot may lift it there */
    uint16_t sunk;        /* heights in a row below that while the law wants to climb, at most 3 */
    float near_m;         /* height after the step that made `unconfirmed` true */
    float before_rise_m;  /* height before the latest upward step of the height */
    float since_rise_s;   /* time since that step, at most 1.5 s */
    float felt_least_m;   /* smallest seen_m of the accelerometer's witness while `unconfirmed`, <= 0 */
    float quiet_s;        /* how long the law has not wanted to climb */
    float swaying_s;      /* how long the tilt has swayed and the slant not, while `standing` */
    float swaying_from_m; /* height at its start */
    float vain_s;         /* how long the law has pushed while no height moved */
    float lost_m;         /* error of the height when DOUBT_SIGHT rose: measured minus predicted */
    float steps;          /* leaky count of the steps */
    float agreed_s;       /* how long heights and witnesses have agreed during a doubt */
    /* accelerometer */
    uint32_t frame_sequence; /* latest frame that integrity_frames() processed */
    uint32_t frame_time_us;
    float up_mps2;                          /* upward acceleration in the latest frame, gravity removed */
    float rest_mps2;                        /* its mean at rest */
    float rested_s;                         /* time at rest that this mean covers, at most 2 s */
    float kept_bias_mps2[INTEGRITY_BLOCKS]; /* that mean at the end of the latest seconds, oldest first */
    uint32_t tilt_alone_us;                 /* latest frame without accelerations */
    float block_s;                          /* time since the latter was taken */
    float bias_mps2; /* of the accelerometer: at rest its mean, in the air corrected by the heights */
    float shaken;    /* >= 1: divides the witness's innovation when the accelerometer is noisy */
    float
        pulled_m_s; /* leaky sum of seen_m over time, metres times seconds: what has corrected the witness */
    witness_t felt;
    /* thrust */
    float lagged_n; /* commanded thrust through the lag of the motors */
    witness_t pushed;
    float held_n;   /* hover thrust when DOUBT_THRUST rose */
    bool held_down; /* the law wanted to descend at that instant */
    /* standing on the ground */
    float mean_rad[2];   /* low-passed roll and pitch */
    float anchor_rad[2]; /* roll and pitch when they last moved */
    float unrocked_s;    /* time since then */
    float swing_rad2;    /* low-passed mean square of roll and pitch around mean_rad */
    float sway_rad2;     /* the same; while it stands one wrong frame counts little */
    float unseen_s;      /* time on the ground since the latest height, at most 2 s */
    float carried_s;    /* how long it has been carried on the ground, see integrity_carried(); at most 2 s */
    float stands_s;     /* how long the vehicle has shown the signs of integrity_stands() */
    float still_s;      /* how long the tilt has swayed less than in the air, without a felt fall */
    float still_mps[2]; /* low-passed speeds of the two witnesses (felt, pushed) since then */
} integrity_t;

/* Clears the state: no doubt, nothing known. Call once before the first cycle. */
void integrity_init(integrity_t *integrity);

/* Checks the tilt, once in each cycle. frames: oldest first, borrowed for the call; frames that were
 * processed before change nothing. When count is 0, roll_rad, pitch_rad and time_us (arrival) are one sample
 * instead. A tilt that jumps by more than 20 degrees is rejected until six in a row were rejected, or until
 * they show a steady turn. Angles
 * that are NaN or beyond 7 rad are rejected. Writes roll_rad, pitch_rad, tilted and unfit_sequence. */
void integrity_tilt(integrity_t *integrity, const imu_sample_t *frames, uint16_t count, float roll_rad,
                    float pitch_rad, uint32_t time_us);

/* Checks one scan. Call exactly once for each new scan, before integrity_height(). Returns true when its
 * height may be used: height within -50 .. 5000 mm, and the scan is no copy of the one before. */
bool integrity_scan(integrity_t *integrity, const altitude_t *altitude);

/* Moves the accelerometer's witness, once in each cycle. frames: oldest first, borrowed for the call; frames
 * that were processed before, or whose tilt was rejected, change nothing. On the ground it measures the bias,
 * and sets or clears DOUBT_IMU: more than 1.5 m/s2 off g for 1 s sets it, less than 1.2 m/s2 clears it. */
void integrity_frames(integrity_t *integrity, const flown_t *flown, const imu_sample_t *frames,
                      uint16_t count);

/* Moves the thrust's witness, once in each cycle. flown->ordered on the ground clears DOUBT_SIGHT and
 * DOUBT_THRUST. */
void integrity_thrust(integrity_t *integrity, const flown_t *flown);

/* Compares one accepted height with both witnesses, then sets or clears the doubts. height_m: the height.
 * gap_s: time since the height before, > 0. age_s: time since its rays were taken. Nothing is judged while
 * flown->grounded is true or the pilot has the throttle. */
void integrity_height(integrity_t *integrity, const flown_t *flown, float height_m, float gap_s, float age_s);

/* Speed of the accelerometer's witness, divided by `shaken`. 0 in its first 0.5 s and while DOUBT_IMU is set.
 */
float integrity_felt_mps(const integrity_t *integrity);

/* True after a take-off or a step of the terrain towards the vehicle, until the heights show a climb. Until
 * then the beam may be blocked: keep climbs slow. */
static inline bool integrity_unconfirmed(const integrity_t *integrity)
{
    return integrity->unconfirmed;
}

/* True after a step of the terrain of more than 0.4 m away from the vehicle, until the heights show a
 * descent. Until then the heights may be wrong: keep descents slow. */
static inline bool integrity_terrain_fell(const integrity_t *integrity)
{
    return integrity->terrain_fell;
}

/* True when the slant distance of more than eight scans in a row has contained only white noise: the beam
 * may be blocked. */
bool integrity_still(const integrity_t *integrity);

/* True when the speed of the accelerometer's witness and the rate of the heights differ by more than 0.5 m/s:
 * learn nothing from them. */
bool integrity_apart(const integrity_t *integrity);

/* True when roll and pitch sway as in the air: more than 1.1 degrees rms together. */
bool integrity_sways(const integrity_t *integrity);

/* True when they sway less than that: below 0.9 degrees rms, as on the ground. */
bool integrity_calm(const integrity_t *integrity);

/* The same with less delay, for the end of a landing: the tilt has moved by a degree within the last
 * 0.8 s. */
bool integrity_rocks(const integrity_t *integrity);

/* True in state GROUND without heights, when the tilt has swayed as in the air and gone on moving for 1.5 s:
 * a pilot flies it, or somebody carries it; a nudge or a wrong frame is over sooner.
 * Then the speed of the accelerometer's witness is valid. */
bool integrity_carried(const integrity_t *integrity);

/* True when the tilt has swayed less than in the air for 1 s: the vehicle may stand on the ground. Lower the
 * thrust to find out. */
bool integrity_may_stand(const integrity_t *integrity);

/* True when the vehicle stands: for 0.6 s the thrust has been too low to fly, the accelerometer has felt no
 * fall, and the tilt has been still. */
bool integrity_stands(const integrity_t *integrity);

/* Name for the telemetry: "SIGHT", "IMU" or "THRUST", of several the first in this order; NULL: no doubt. */
const char *integrity_doubt_name(uint16_t doubts);

/* True when at least one of the given DOUBT_* bits is set. */
static inline bool integrity_doubts(const integrity_t *integrity, uint16_t doubt)
{
    return (integrity->doubts & doubt) != 0U;
}

/* Vertical speed by the thrust, less the error that the heights have shown of it. Where the thrust does not
 * tell, the rate of the heights. */
float integrity_pushed_mps(const integrity_t *integrity);

/* Way since the rays of the latest height, by the thrust; > 0: upwards. */
float integrity_moved_m(const integrity_t *integrity);

/* Vertical speed without the heights: the mean of both witnesses, or the one that is valid and not doubted; 0
 * when there is none. */
float integrity_speed_mps(const integrity_t *integrity);

#endif
