/* Statistics over the latest scans. Identical scans are copies and are rejected: with a sensor noise of 3 mm,
 * chance makes two scans with the same digits once in some thousands.
 * What breaks: a height of one ray. altitude_from_ranges() refuses it; examples/one_ray makes groups of
 * single readings. */
#include "control/sense/beam.h"

#include <math.h>

#include "control/credible.h"

#define HEIGHT_BACK_MM (HEIGHT_MIN_MM + 3000.0F * HEIGHT_SIGMA_M) /* hysteresis of three sigma */

/* Tried: 960 healthy flights; in none does the thrust contradict the heights while the slant is so still. */
#define STILL_MM2 4.0F /* tried, see above: 2 mm rms */
#define STILL_MOST_MM2 \
    64.0F /* chosen: 8 mm rms, above the noise of any drawn sensor; bars on a floor make more */
#define STILL_SHARE 0.4F /* chosen: white noise alone makes 1, a swinging slant next to 0 */

/* Sample variance of BEAM_SCANS values. Differences from the first value keep the squares small. */
static float variance(const float *value)
{
    float sum = 0.0F;
    float square = 0.0F;

    for (uint16_t k = 1U; k < BEAM_SCANS; ++k) {
        const float off = value[k] - value[0];
        sum += off;
        square += off * off;
    }
    return (square - sum * sum / (float)BEAM_SCANS) / (float)(BEAM_SCANS - 1U);
}

/* Variance of the white noise in the values: the second difference of white noise has six times its
 * variance, and a smooth motion adds little. */
static float noise(const float *value)
{
    float square = 0.0F;

    for (uint16_t k = 2U; k < BEAM_SCANS; ++k) {
        const float bend = value[k] - 2.0F * value[k - 1U] + value[k - 2U];
        square += bend * bend;
    }
    return square / (6.0F * (float)(BEAM_SCANS - 2U));
}

static uint16_t counted(uint16_t count, bool one_more, uint16_t most)
{
    return one_more ? (uint16_t)(count + (count < most)) : 0U;
}

static void keep_slant(beam_t *beam, float slant_mm)
{
    for (uint16_t k = 1U; k < BEAM_SCANS; ++k) {
        beam->slants_mm[k - 1U] = beam->slants_mm[k];
    }
    beam->slants_mm[BEAM_SCANS - 1U] = slant_mm;
    beam->scans = (uint16_t)(beam->scans + (beam->scans < BEAM_SCANS));
}

static void watch_slant(beam_t *beam, float slant_mm, float height_m, bool sways, bool quiet)
{
    keep_slant(beam, slant_mm);
    const bool full = beam->scans == BEAM_SCANS;
    const float slant_mm2 = variance(beam->slants_mm);
    const bool still = full && slant_mm2 < STILL_MOST_MM2 &&
                       (slant_mm2 < STILL_MM2 || noise(beam->slants_mm) > STILL_SHARE * slant_mm2);

    beam->flat = full && slant_mm2 < STILL_MOST_MM2 && quiet;
    beam->rigid = counted(beam->rigid, full && slant_mm2 < STILL_MM2, BEAM_STILL_SCANS);
    beam->still = counted(beam->still, still, BEAM_STILL_SCANS);
    if (!sways || height_m < LOW_M) {
        beam->white = 0U;
    } else if (still) {
        beam->white = counted(beam->white, true, BEAM_WHITE_SCANS);
    } else {
        beam->white = (uint16_t)(beam->white - (beam->white > 0U));
    }
}

bool beam_scan(beam_t *beam, const altitude_t *altitude, float height_m, bool sways, bool quiet)
{
    const bool copy = altitude->good_rays > 1U && altitude->slant_mm == beam->slant_mm &&
                      altitude->spread_mm == beam->spread_mm;

    beam->slant_mm = altitude->slant_mm;
    beam->spread_mm = altitude->spread_mm;
    if (altitude->good_rays > 1U && fabsf(altitude->height_mm) <= HEIGHT_MAX_MM) {
        watch_slant(beam, altitude->slant_mm, height_m, sways, quiet);
    }
    beam->below_ground = !(altitude->height_mm >= (beam->below_ground ? HEIGHT_BACK_MM : HEIGHT_MIN_MM));
    return !copy && !beam->below_ground && altitude->height_mm <= HEIGHT_MAX_MM;
}

void beam_forget_slants(beam_t *beam)
{
    beam->scans = (beam->scans > 1U) ? 1U : beam->scans;
}

bool beam_is_still(const beam_t *beam)
{
    return beam->still > BEAM_STILL_SCANS / 2U;
}

bool beam_lives(const beam_t *beam)
{
    return beam->still == 0U && (beam->scans == BEAM_SCANS || beam->scans == 0U);
}
