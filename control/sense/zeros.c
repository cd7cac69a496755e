/* What breaks: a vehicle in a hand passes the ground's height, too. So a mirror is wrong only while another
 * one shows the ground, in each scan of a second, and while both differ by more than two honest ones may. */
#include "control/sense/zeros.h"

#include <math.h>
#include <stddef.h>

#include "control/credible.h"

static void count(zero_t *zero, bool valid, float mm, zeros_place_t place)
{
    const bool within = valid && fabsf(mm) <= GROUND_WITHIN_MM;

    zero->within = within ? (uint16_t)(zero->within + (zero->within < ZEROS_SCANS)) : 0U;
    zero->off = within ? 0U : (uint16_t)(zero->off + (zero->off < ZEROS_SCANS));
    if (place != ZEROS_REST) {
        return;
    }
    if (!valid) {
        zero->counts = 0U;
        return;
    }
    /* Another length was typed, or the vehicle was moved: what it showed before does not count. */
    if (zero->counts > 0U && fabsf(mm - zero->mm) > GROUND_WITHIN_MM) {
        zero->counts = 0U;
    }
    zero->counts = (uint16_t)(zero->counts + (zero->counts < ZEROS_MEAN));
    zero->mm = (zero->counts == 1U) ? mm : zero->mm + (mm - zero->mm) / (float)zero->counts;
}

/* The mirror that has shown the ground for a second, or NULL. */
static const zero_t *sure_of(const zeros_t *zeros)
{
    const zero_t *sure = NULL;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const zero_t *zero = &zeros->zeros[m];

        if (zero->within == ZEROS_SCANS && (sure == NULL || fabsf(zero->mm) < fabsf(sure->mm))) {
            sure = zero;
        }
    }
    return sure;
}

static bool differs(const zero_t *zero, const zero_t *sure)
{
    return zero->counts == 0U || fabsf(zero->mm - sure->mm) > GROUND_WITHIN_MM;
}

/* A mirror that shows too little shows 0 on the way up: nothing is taken back there. */
static void judge(zeros_t *zeros, zeros_place_t place)
{
    const zero_t *const sure = sure_of(zeros);

    if (sure == NULL) {
        return;
    }
    zeros->stands = true;
    zeros->wrong = (place == ZEROS_REST) ? 0U : zeros->wrong;
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const zero_t *zero = &zeros->zeros[m];

        zeros->stands = zeros->stands && zero->within == ZEROS_SCANS;
        if (zero->off == ZEROS_SCANS && differs(zero, sure)) {
            zeros->wrong |= (uint16_t)(1U << m);
        }
    }
}

void zeros_scan(zeros_t *zeros, const altitude_t *shown, zeros_place_t place)
{
    if (place == ZEROS_REST && !zeros->rested) {
        *zeros = (zeros_t){.wrong = 0U};
    }
    zeros->rested = place == ZEROS_REST || (place == ZEROS_LIFTED && zeros->rested);
    if (!zeros->rested) {
        return;
    }
    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        count(&zeros->zeros[m], shown[m].valid, zeros_height_mm(&shown[m]), place);
    }
    judge(zeros, place);
}

uint16_t zeros_scans(const zeros_t *zeros)
{
    uint16_t least = ZEROS_MEAN;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const uint16_t counts = zeros->zeros[m].counts;

        least = (counts < least) ? counts : least;
    }
    return zeros->stands ? least : 0U;
}
