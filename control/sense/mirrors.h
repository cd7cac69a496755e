/* Which mirrors are believed in one scan, and the height that they show. A mirror that more probably lies
 * than not (belief.h), or repeats its scan, is left out.
 *
 * The height is a mean about the middle one of three, or that one of two that is nearer to the height before.
 * The farther a mirror's height is from that, the less it counts. So a slope and bars on the floor are a
 * mean, and an edge counts when the second beam has passed it. When all are left out, all are asked that do
 * not repeat their scan.
 *
 * Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_MIRRORS_H
#define CONTROL_SENSE_MIRRORS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/sense/belief.h"

#define MIRRORS_GAP_MOST_S 10.0F /* any above HEIGHT_LOST_S, from where on no change is fresh */

/* What a copy repeats. */
typedef struct {
    float slant_mm, spread_mm;
} mirror_digits_t;

/* A change since the latest scan, and what was left of the time before, because that scan's rays are older.
 */
typedef struct {
    float gained, left;
} mirrors_motion_t;

typedef struct {
    belief_t belief;
    altitude_t altitude; /* of the latest scan; not valid before the first */
    bool agree;          /* its height is that of two honest mirrors, with 99 % */
    bool sees;         /* with 99 % not all that told something in it lie, and it rather moves than stands */
    bool suspected;    /* all that told something in it may lie, with more than 1 % */
    bool blind;        /* all that told something in it lie, with 99 % */
    bool felt_may_lie; /* the accelerometer does, with 99 %, in this scan */
    bool felt_lies;    /* and where several mirrors count, in the scan before too */
    bool stirs;        /* the vehicle has moved, with 99 %, whatever the accelerometer tells */
    bool moves;        /* the vehicle does, or hangs, with 99 % */
    bool unpushed;     /* nothing moves it, or the thrust has no effect, with 99 % */
    bool no_effect;    /* the thrust has none, with 99 %: a pilot flies, or something holds the vehicle */
    uint16_t ground;   /* as in altitude.h; a scan that tells nothing is followed by another one */
    uint16_t left_out; /* bits: mirrors of that scan that told something, and do not count in altitude */
    float unseen_s;    /* since the latest scan that told something, at most 10 s */
    float lies[MIRROR_COUNT];               /* the probability that each lies */
    float disbelieved_s[MIRROR_COUNT];      /* how long each has been, at most 10 s */
    mirror_digits_t latest[MIRROR_COUNT];   /* of each mirror, to find copies */
    mirrors_motion_t felt, pushed, dragged; /* m/s by the accelerometer, by the thrust; share by the drag */
    mirrors_motion_t undelivered;           /* m/s of what is commanded and not delivered yet */
    mirrors_motion_t heard;                 /* s of which the accelerometer has told something */
    bool felt_told;                         /* what it told of the latest scan's motion was believed */
} mirrors_t;

/* Bits: mirrors that are disbelieved. lasting: for so long that no edge explains it; over one, the mirror
 * that shows what was before looks blocked beside the others. */
uint16_t mirrors_liars(const mirrors_t *mirrors, bool lasting);

/* One IMU frame: by the accelerometer the vertical speed has changed by so much in dt_s. */
void mirrors_frame(mirrors_t *mirrors, float gained_mps, float dt_s);

/* State GROUND, and nobody is known to carry it. unseen: no height is of use, and what has been felt is no
 * motion. */
void mirrors_rest(mirrors_t *mirrors, bool unseen);

/* Vertical speed now, if all mirrors lie: by the accelerometer, and the thrust. believed: the accelerometer
 * is. */
float mirrors_blind_mps(const mirrors_t *mirrors, bool believed);

/* One cycle in which the thrust alone carries the vehicle: by it the speed has changed by so much, and by the
 * drag by this share of the speed. undelivered_mps: by the thrust that is
 * commanded and not delivered yet, up or down. */
void mirrors_thrust(mirrors_t *mirrors, float gained_mps, float undelivered_mps, float dragged);

/* One cycle of step_s in which somebody else's thrust carries it, or a hand: by up to 1 g, up or down. */
void mirrors_carried(mirrors_t *mirrors, float step_s);

/* One cycle of step_s without a new scan. What the latest one told is forgotten when it is lost: then it
 * shows no motion of now, as one that tells nothing. */
void mirrors_wait(mirrors_t *mirrors, float step_s);

/* One scan: writes altitude and agree. Returns false when it tells nothing: each mirror repeats its digits,
 * or is out of reach (5000 mm). shown: one altitude for each mirror_t, not valid where it shows none. gap_s:
 * since the scan before, > 0. age_s: of its rays. felt: the accelerometer is believed; else, and
 * where its frames miss most of the gap, the thrust foretells the motion. held_up: the scan comes late, so
 * what was felt is not of its time. */
bool mirrors_scan(mirrors_t *mirrors, const altitude_t *shown, float gap_s, float age_s, bool felt,
                  bool held_up);

/* For people. Writes the probability that each mirror lies, and returns the mirrors that were left out, as
 * bits. */
uint16_t mirrors_tell(const mirrors_t *mirrors, float lies[MIRROR_COUNT]);

#endif
