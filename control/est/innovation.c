/* Where the filter and a height differ, the filter is wrong or the ground has stepped. The filter alone
 * cannot tell which; the belief compares the mirrors with each other and with the thrust.
 * What breaks: a test without a reset rejects heights for ever once the state is wrong (in simulation the
 * vehicle flew away to 11 m). One that does not ask the belief takes the word of an accelerometer that lies
 * against three mirrors: the estimate sank while the vehicle climbed by 3 m. "fitted": docs/control.md;
 * make tune LAW=EST ARGS="--constants est" searches it again. */
#include "control/est/innovation.h"

#include <math.h>
#include <stdbool.h>

#include "control/between.h"
#include "control/est/roughness.h"

#define FLOOR_SIGMAS 6.0F /* tried 3 and 4: on a ramp the rejected heights made it climb 0.14 m too high */
#define INNOVATION_LIMIT_MIN_M 0.053F /* fitted */
#define INNOVATION_LIMIT_SIGMAS 3.0F  /* usual */
#define REJECTIONS_MAX 3U /* the third height in a row is used: then none is fresh, HEIGHT_FRESH_US */

static bool is_accepted(float innovation_m, float variance_m2, float floor_m)
{
    const float of_floor_m = (floor_m > ROUGHNESS_SMOOTH_M) ? FLOOR_SIGMAS * floor_m : 0.0F;
    const float limit_m = between(INNOVATION_LIMIT_MIN_M, INNOVATION_LIMIT_SIGMAS * sqrtf(variance_m2),
                                  INNOVATION_LIMIT_MAX_M);

    return fabsf(innovation_m) <= at_least(limit_m, of_floor_m);
}

static void take(innovation_test_t *test, uint16_t ground)
{
    test->rejected = 0U;
    test->ground = ground;
}

void innovation_untested(innovation_test_t *test, uint16_t ground)
{
    dips_scan(&test->dips);
    dips_over(&test->dips, test->rejected, test->latest_m);
    take(test, ground);
}

static height_outcome_t reject(innovation_test_t *test, float innovation_m, uint16_t ground)
{
    const float apart_m = fabsf(innovation_m - test->latest_m);
    const uint16_t wait = dips_wait(&test->dips, innovation_m);
    const bool lasts = test->rejected > 0U && test->rejected >= wait;

    ++test->rejected;
    test->latest_m = innovation_m;
    if (lasts && apart_m <= INNOVATION_LIMIT_MIN_M) {
        dips_step(&test->dips, innovation_m);
        take(test, ground);
        return HEIGHT_TERRAIN_STEP;
    }
    if (test->rejected >= REJECTIONS_MAX + wait) {
        take(test, ground);
        return HEIGHT_RESET;
    }
    return HEIGHT_REJECTED;
}

height_outcome_t innovation_test(innovation_test_t *test, float innovation_m, float variance_m2,
                                 float floor_m, uint16_t ground)
{
    const bool same_ground = ground != 0U && ground == test->ground;

    dips_scan(&test->dips);
    if (!same_ground && !is_accepted(innovation_m, variance_m2, floor_m)) {
        return reject(test, innovation_m, ground);
    }
    dips_over(&test->dips, test->rejected, test->latest_m);
    take(test, ground);
    return HEIGHT_FUSED;
}
