/* Quality of the scans: copies, range, and whether the slant distance moves as it does in flight.
 *
 * In the air the tilt raises and lowers the mirror, so the slant distance changes with it. The slant of a
 * blocked beam does not change: only white noise is left in it.
 *
 * Pure; the caller owns the state, all zero at first. Context: one Task. */
#ifndef CONTROL_SENSE_BEAM_H
#define CONTROL_SENSE_BEAM_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"

#define BEAM_SCANS 12U       /* chosen: 1.2 s at ten scans a second */
#define BEAM_STILL_SCANS 16U /* chosen: 1.6 s of scans; `rigid` and `still` stop here */
#define BEAM_WHITE_SCANS \
    40U /* tried: 120 healthy drawn flights reach 24, a blocked beam 40 within 4 to 6 s */

typedef struct {
    float slant_mm, spread_mm;   /* of the latest scan */
    bool below_ground;           /* heights so low that no noise explains them: the beam is blocked */
    float slants_mm[BEAM_SCANS]; /* latest slant distances, oldest first */
    uint16_t scans;              /* number of valid entries in slants_mm */
    bool flat;                   /* these vary by less than 8 mm rms, and the accelerometer is quiet */
    uint16_t rigid;              /* scans in a row whose slants vary less than those of any flying vehicle */
    uint16_t still;              /* scans in a row whose slants contain only white noise */
    uint16_t white; /* while the tilt sways: such scans, less those that contain more; 0 or above */
} beam_t;

/* One scan, exactly once. height_m: the height before. sways: the tilt sways as in the air. quiet: the
 * accelerometer is not noisy. Returns true when the scan's height may be used: it is within -50 .. 5000 mm,
 * and the scan is no copy of the one before. */
bool beam_scan(beam_t *beam, const altitude_t *altitude, float height_m, bool sways, bool quiet);

/* The height has made a step: that was no motion of the slant. */
void beam_forget_slants(beam_t *beam);

/* True when the slant distance of more than eight scans in a row has contained only white noise: the beam
 * may be blocked. */
bool beam_is_still(const beam_t *beam);

/* True when the slant changes by more than white noise, and no step made it so; or nothing is known. */
bool beam_lives(const beam_t *beam);

#endif
