#include "control/approach.h"

#include <math.h>
#include <stddef.h>

#include "control/angle.h"

/* An acceleration that nobody tells: 3 degrees of tilt push by g sin 3 degrees. */
#define PUSH_MMPS2 513.0F
/* Of a wall that is seen for the first time: a person walks at 1.4 m/s, and a vehicle that he watches flies
 * no faster. */
#define SPEED_MMPS 1400.0F
#define LIMIT2 9.0F          /* three sigmas: what is further off is another wall */
#define TURN_RAD 0.262F      /* 15 degrees: in 0.2 s, a vehicle that turns by 75 degrees a second */
#define APART_SIN 0.259F     /* sin 15 degrees: beyond it the component across has four times the error */
#define LOOKS_LEAST 3U       /* two tell a speed, and the third confirms it */
#define MISSED_MOST 2U       /* then it is forgotten */
#define SURE 3.0F            /* sigmas */
#define COMING_LEAST 2U      /* looks: the noise of one makes the next one's speed wrong to the other side */
#define TOLD_S 0.6F          /* the rays are 0.13 s old, a look comes each 0.2 s, and the line takes 0.06 s */
#define REACTION_S 1.5F      /* to what comes as a surprise (Green 2000, of drivers) */
#define BRAKES_MMPS2 1025.0F /* 6 degrees of tilt: g sin 6 degrees */
#define HALF_WIDTH_MM 352.0F /* as in control/walls.c */

void approach_reset(approach_t *approach)
{
    for (uint16_t i = 0U; i < WALLS_MAX; ++i) {
        approach->walls[i] = (approach_wall_t){.looks = 0U};
    }
}

/* The state is distance and its growth, which is -mmps. */
static void predict(approach_wall_t *wall, float dt_s)
{
    const float push2 = PUSH_MMPS2 * PUSH_MMPS2 * dt_s * dt_s;

    wall->mm -= wall->mmps * dt_s;
    wall->var_mm2 += dt_s * (dt_s * wall->var_mmps2 - 2.0F * wall->cov) + 0.25F * push2 * dt_s * dt_s;
    wall->cov -= dt_s * wall->var_mmps2 + 0.5F * push2 * dt_s;
    wall->var_mmps2 += push2;
}

static float off2_of(const approach_wall_t *wall, const wall_t *seen)
{
    const float off_mm = seen->mm - wall->mm;

    return off_mm * off_mm / (wall->var_mm2 + seen->sigma_mm * seen->sigma_mm);
}

static void update(approach_wall_t *wall, const wall_t *seen)
{
    const float var_mm2 = wall->var_mm2 + seen->sigma_mm * seen->sigma_mm;
    const float gain = wall->var_mm2 / var_mm2;
    const float gain_per_s = wall->cov / var_mm2;
    const float off_mm = seen->mm - wall->mm;

    wall->mm += gain * off_mm;
    wall->mmps += gain_per_s * off_mm;
    wall->var_mmps2 -= gain_per_s * wall->cov;
    wall->cov *= 1.0F - gain;
    wall->var_mm2 *= 1.0F - gain;
    wall->sigma_mmps = sqrtf(wall->var_mmps2);
    wall->bearing_rad = seen->bearing_rad;
    wall->faces = seen->faces;
    wall->missed = 0U;
    wall->looks = (uint16_t)(wall->looks + ((wall->looks < LOOKS_LEAST) ? 1U : 0U));
}

/* What is left between the rotors and the wall, over what stopping takes; below 0: it is too late. */
static float spare_mm(const approach_wall_t *wall)
{
    const float told_mm = wall->mmps * (TOLD_S + REACTION_S);
    const float brake_mm = 0.5F * wall->mmps * wall->mmps / BRAKES_MMPS2;

    return wall->mm - HALF_WIDTH_MM - told_mm - brake_mm;
}

static bool comes_too_fast(const approach_wall_t *wall)
{
    return wall->looks >= LOOKS_LEAST && wall->faces && wall->mmps > SURE * wall->sigma_mmps &&
           spare_mm(wall) < 0.0F;
}

static void count_coming(approach_wall_t *wall)
{
    if (!comes_too_fast(wall)) {
        wall->coming = 0U;
    } else if (wall->coming < COMING_LEAST) {
        ++wall->coming;
    }
}

static bool is_taken(const approach_wall_t *wall)
{
    return wall->looks > 0U && wall->missed == 0U;
}

/* The followed wall that this one is most likely to be, of those not found again yet. */
static approach_wall_t *match(approach_t *approach, const wall_t *seen)
{
    approach_wall_t *best = NULL;
    float least = LIMIT2;

    for (uint16_t i = 0U; i < WALLS_MAX; ++i) {
        approach_wall_t *const wall = &approach->walls[i];

        if (wall->looks > 0U && wall->missed > 0U &&
            arc_rad(wall->bearing_rad, seen->bearing_rad) <= TURN_RAD && off2_of(wall, seen) <= least) {
            least = off2_of(wall, seen);
            best = wall;
        }
    }
    return best;
}

static void begin(approach_t *approach, const wall_t *seen)
{
    for (uint16_t i = 0U; i < WALLS_MAX; ++i) {
        if (approach->walls[i].looks == 0U) {
            approach->walls[i] = (approach_wall_t){.bearing_rad = seen->bearing_rad,
                                                   .mm = seen->mm,
                                                   .sigma_mmps = SPEED_MMPS,
                                                   .faces = seen->faces,
                                                   .looks = 1U,
                                                   .var_mm2 = seen->sigma_mm * seen->sigma_mm,
                                                   .var_mmps2 = SPEED_MMPS * SPEED_MMPS};
            return;
        }
    }
}

void approach_step(approach_t *approach, const wall_t walls[], uint16_t count, float dt_s)
{
    uint32_t known = 0U; /* bits, by the place in `walls` */

    for (uint16_t i = 0U; i < WALLS_MAX; ++i) {
        approach_wall_t *const wall = &approach->walls[i];

        predict(wall, dt_s);
        ++wall->missed;
    }
    for (uint16_t k = 0U; k < count; ++k) {
        approach_wall_t *const wall = match(approach, &walls[k]);

        if (wall != NULL) {
            known |= (uint32_t)1U << k;
            update(wall, &walls[k]);
            count_coming(wall);
        }
    }
    for (uint16_t i = 0U; i < WALLS_MAX; ++i) {
        if (approach->walls[i].missed > MISSED_MOST) {
            approach->walls[i].looks = 0U;
        }
    }
    for (uint16_t k = 0U; k < count; ++k) {
        if (((known >> k) & 1U) == 0U) {
            begin(approach, &walls[k]);
        }
    }
}

static bool is_known(const approach_wall_t *wall)
{
    return is_taken(wall) && wall->looks >= LOOKS_LEAST;
}

static bool is_coming(const approach_wall_t *wall)
{
    return is_taken(wall) && wall->coming >= COMING_LEAST;
}

const approach_wall_t *approach_warning(const approach_t *approach)
{
    const approach_wall_t *first = NULL;

    for (uint16_t i = 0U; i < WALLS_MAX; ++i) {
        const approach_wall_t *const wall = &approach->walls[i];

        if (is_coming(wall) && (first == NULL || wall->mm * first->mmps < first->mm * wall->mmps)) {
            first = wall;
        }
    }
    return first;
}

static bool is_apart(const approach_wall_t *a, const approach_wall_t *b)
{
    return a == NULL || fabsf(sinf(a->bearing_rad - b->bearing_rad)) >= APART_SIN;
}

/* NULL: none that is known, in another direction than `other`. */
static const approach_wall_t *best_beside(const approach_t *approach, const approach_wall_t *other)
{
    const approach_wall_t *best = NULL;

    for (uint16_t i = 0U; i < WALLS_MAX; ++i) {
        const approach_wall_t *const wall = &approach->walls[i];

        if (is_known(wall) && is_apart(other, wall) &&
            (best == NULL || wall->sigma_mmps < best->sigma_mmps)) {
            best = wall;
        }
    }
    return best;
}

uint16_t approach_known(const approach_t *approach, const approach_wall_t *known[APPROACH_KNOWN_MAX])
{
    uint16_t count = 0U;

    known[0] = best_beside(approach, NULL);
    if (known[0] != NULL) {
        known[1] = best_beside(approach, known[0]);
        count = (known[1] != NULL) ? 2U : 1U;
    }
    return count;
}
