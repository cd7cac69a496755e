/* Whom to believe. Three tell how the vehicle moves: its heights, its accelerometer, and the thrust that it
 * is given. Each may lie, and no one of them is believed against the other two:
 *
 *   heights against both of the others      doubt SIGHT: the heights count as lost
 *   accelerometer against both              doubt IMU: what needs accelerations is not flown
 *   thrust against both                     doubt THRUST: somebody else flies, or something holds the
 * vehicle: the thrust stays near the one that carries it
 *
 * Accelerometer and thrust each have a witness here: a speed that they foretell, corrected slowly by the
 * heights, and how far the heights have gone away from it. A step from one height to the next is terrain and
 * counts for nothing, be it as high as it likes; a beam that is blocked looks like terrain that rises with
 * the vehicle, and goes on doing so.
 *
 * Besides: a scan that repeats itself to the hundredth of a millimetre is a copy; an accelerometer that does
 * not feel g at rest is unfit; a tilt that comes in one jump is believed later than one that grows. Pure; the
 * caller owns the state. */
#ifndef CONTROL_INTEGRITY_H
#define CONTROL_INTEGRITY_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/est/estimator.h"

#define INTEGRITY_SCANS 12U

#define DOUBT_SIGHT 1U
#define DOUBT_IMU 2U
#define DOUBT_THRUST 4U

/* One of the two that foretell the motion. */
typedef struct {
    float speed_mps; /* upwards */
    float off_m;     /* height measured less height foretold; leaks */
    float seen_m;    /* the same at the rays of the latest height */
    float moved_m;   /* way that it has foretold since the last disagreement, leaks */
    float running_s; /* since its start, at most WITNESS_OLD_S */
} witness_t;

/* The flight as it is decided, and what it is decided from: of the cycle before, where it cannot be
 * otherwise. */
typedef struct {
    float step_s;    /* since the cycle before */
    bool grounded;   /* stands, no thrust */
    bool standing;   /* about to leave the ground, as far as one knows */
    bool off_ground; /* flown by its own thrust: the witness of the thrust counts */
    bool ours;       /* no pilot has the throttle */
    bool ordered;    /* a #SETR arrived: what is doubted on the ground is tried again */
    float thrust_n;  /* commanded */
    float authority_mps2_per_n, damping_per_s; /* what thrust does, as in cascade.h */
    float hover_n;    /* the thrust that carries it, as it has been known for some seconds */
    float wanted_m;   /* how far the law wants to climb (or sink); NAN: nothing to tell */
    bool displaced;   /* it holds a height, and is far from it */
    float noise_mps2; /* of the accelerometer, rms, as the estimator measures it */
    float bias_mps2;  /* of the accelerometer, as the estimator has found it */
} flown_t;

typedef struct {
    uint16_t doubts; /* DOUBT_* */
    /* tilt */
    bool levelled;             /* a tilt has been believed */
    float roll_rad, pitch_rad; /* believed */
    uint16_t jumped;           /* tilts in a row that came in one jump */
    uint16_t tilted;           /* tilts over 45 degrees in a row */
    uint32_t tilt_time_us;
    uint32_t tilt_sequence;
    uint32_t unfit_sequence; /* frames up to this one rest on tilts that are not believed */
    /* scans */
    float slant_mm, spread_mm;
    uint16_t copies;                  /* in a row */
    float slants_mm[INTEGRITY_SCANS]; /* the latest, oldest first */
    uint16_t scans;                   /* in them */
    uint16_t rigid;                   /* scans in a row with slants as still as no flying vehicle's */
    uint16_t still;                   /* scans in a row with nothing but noise in the slants */
    /* heights */
    bool heard; /* height_m is the latest */
    float height_m;
    float rise_mps;   /* of the heights, low-passed, steps left out */
    float way_m;      /* that the heights have gone since the latest step, leaks */
    float unmoved_s;  /* since they went on and on */
    bool unconfirmed; /* the terrain came nearer in one step, and no climb has shown in the heights since */
    bool standing;    /* on the ground or about to leave it */
    bool proved;      /* a climb has shown in the heights since the ground */
    float near_m;     /* height after that step */
    float before_rise_m; /* height before the latest step away, so long ago: */
    float since_rise_s;
    float felt_least_m; /* how far the heights have stayed below the felt climb meanwhile, < 0 */
    float quiet_s;      /* for how long no climb has been wanted */
    float vain_s;       /* for how long the law has pushed and no height has moved */
    float lost_m;       /* how far the heights had gone away when doubt SIGHT rose */
    float steps;        /* recent, leaks */
    float agreed_s;     /* heights have agreed for so long, while doubted */
    /* accelerometer */
    uint32_t frame_sequence;
    uint32_t frame_time_us;
    float up_mps2;   /* of the latest frame, gravity removed */
    float rest_mps2; /* slow mean of it at rest */
    float rested_s;
    float bias_mps2;
    float shaken; /* the noise against the one that the limits are for, >= 1 */
    witness_t felt;
    /* thrust */
    float lagged_n;
    witness_t pushed;
    float held_n;   /* with doubt THRUST: the thrust that carried it when the doubt rose */
    bool held_down; /* and the law wanted it lower */
    /* stillness */
    float mean_rad[2]; /* slow, of roll and pitch */
    float sway_rad2;   /* slow mean square of what roll and pitch differ from it */
    float stands_s;
    float still_s; /* for how long the tilt has been stiller than in the air; no fall was felt meanwhile */
    float still_mps[2]; /* speeds felt and foretold by the thrust, slow, from when that began */
    float unheard_s;    /* since the latest height that is not in doubt, at most WITNESS_OLD_S */
} integrity_t;

void integrity_init(integrity_t *integrity);

/* The tilt that is believed, from the frames or, without any, from one sample. */
void integrity_tilt(integrity_t *integrity, const imu_sample_t *frames, uint16_t count, float roll_rad,
                    float pitch_rad, uint32_t time_us);

/* A scan's height may be used at all: within reach, and not the copy of an earlier one. Once per scan. */
bool integrity_scan(integrity_t *integrity, const altitude_t *altitude);

/* The frames of one cycle; those that were seen before change nothing. */
void integrity_frames(integrity_t *integrity, const flown_t *flown, const imu_sample_t *frames,
                      uint16_t count);

/* One cycle of thrust. */
void integrity_thrust(integrity_t *integrity, const flown_t *flown);

/* A new height, gap_s after the one before, its rays taken age_s ago; what is doubted is decided. */
void integrity_height(integrity_t *integrity, const flown_t *flown, float height_m, float gap_s, float age_s);

/* The accelerometer's speed, less of it the more it shakes; 0 where it is not asked. */
float integrity_felt_mps(const integrity_t *integrity);

/* The heights came nearer at once, as they do where something blocks the beam, and no climb has shown in them
 * since. */
bool integrity_unconfirmed(const integrity_t *integrity);

/* For a second nothing but noise has been in the beam's length: it may be blocked. */
bool integrity_still(const integrity_t *integrity);

/* The tilt moves as it does in the air. */
bool integrity_sways(const integrity_t *integrity);

/* It may stand: so still is nothing in the air. Less thrust would tell. */
bool integrity_may_stand(const integrity_t *integrity);

/* It gives too little thrust to fly, and does not fall: something carries it. */
bool integrity_stands(const integrity_t *integrity);

/* "SIGHT", "IMU", "THRUST", the first that there is, as shown by the telemetry; NULL: none. */
const char *integrity_doubt_name(uint16_t doubts);

bool integrity_doubts(const integrity_t *integrity, uint16_t doubt);

/* Fastest knowledge of the speed that does not rest on heights alone. */
float integrity_speed_mps(const integrity_t *integrity);

#endif
