#include "sim/scenarios/seed_course.h"

#define WIDE_M 100.0
#define FAR_M 1e6
#define ADVANCE_S 2.0  /* chosen: on the way so long before the ramp and behind the edge */
#define TURN_RADPS 2.5 /* chosen: it has turned round before the ramp */
#define TAKE_OFF_S 1.0 /* the reference comes */
#define STANDS_M 0.5   /* chosen: the vehicle takes off from an even spot: half of its span, rounded up */

#define SEED_FLAT \
    .platform_m = 0.25, .ramp_start_s = 7.3, .ramp_end_s = 8.0, .edge_s = 11.0, \
    .speed_mps = SEED_COURSE_MPS, .rough_s = 0.5, .bars_s = 0.4, .bars_share = 0.3
const seed_course_t seed_course_flat = {.ramp = false, SEED_FLAT};
const seed_course_t seed_course_ramp = {.ramp = true, SEED_FLAT};

/* The way that a leg has come after a while (course.h). */
static double gone_m(const seed_course_t *wanted, double since_s)
{
    return wanted->speed_mps * (since_s - 0.5 * wanted->speed_mps / COURSE_MPS2);
}

static void put(place_t *place, double from_m, double to_m, double bottom_m, double near_m, double far_m)
{
    if (to_m > from_m) {
        place_add(place, &(place_block_t){.x_m = 0.5 * (from_m + to_m),
                                          .length_m = to_m - from_m,
                                          .width_m = WIDE_M,
                                          .bottom_m = bottom_m,
                                          .near_top_m = near_m,
                                          .far_top_m = far_m});
    }
}

/* Ramp and platform stand on the floor; a pit is a lower floor between two blocks and a ramp. */
static void put_ramp(const seed_course_t *wanted, double ramp_m, place_t *place)
{
    const double top_m = wanted->platform_m;
    const double begins_m = ramp_m + wanted->speed_mps * (wanted->ramp_end_s - wanted->ramp_start_s);
    const double ends_m = ramp_m + wanted->speed_mps * (wanted->edge_s - wanted->ramp_start_s);

    if (top_m > 0.0) {
        put(place, ramp_m, begins_m, 0.0, 0.0, top_m);
        put(place, begins_m, ends_m, 0.0, top_m, top_m);
    } else if (top_m < 0.0) {
        place->level_m = top_m;
        put(place, -FAR_M, ramp_m, top_m, 0.0, 0.0);
        put(place, ramp_m, begins_m, top_m, 0.0, top_m);
        put(place, ends_m, FAR_M, top_m, 0.0, 0.0);
    }
}

static void go(const seed_course_t *wanted, course_t *course, double start_s, double end_m)
{
    *course = (course_t){.carried = true,
                         .count = 1,
                         .legs = {{.start_s = start_s,
                                   .x_m = end_m,
                                   .speed_mps = wanted->speed_mps,
                                   .heading_rad = wanted->nose_rad,
                                   .turn_radps = TURN_RADPS}}};
}

/* A while beyond the edge. */
static double end_m(const seed_course_t *wanted, double ramp_m)
{
    return ramp_m + wanted->speed_mps * (wanted->edge_s - wanted->ramp_start_s + ADVANCE_S);
}

void seed_course_floor(const seed_course_t *wanted, unsigned long seed, place_t *place)
{
    if (wanted->rough_rms_m > 0.0) {
        const place_rough_t rough = {wanted->rough_rms_m, SEED_COURSE_MPS * wanted->rough_s};

        place_roughen(place, &rough, seed);
    }
    if (wanted->bars_m != 0.0) {
        place->bars = (place_bars_t){.height_m = wanted->bars_m,
                                     .period_m = SEED_COURSE_MPS * wanted->bars_s,
                                     .share = wanted->bars_share,
                                     .from_m = STANDS_M};
    }
}

void seed_course_lay(const seed_course_t *wanted, unsigned long seed, place_t *place, course_t *course)
{
    const bool passes = wanted->rough_rms_m > 0.0 || wanted->bars_m != 0.0;
    const double start_s = passes ? TAKE_OFF_S : wanted->ramp_start_s - ADVANCE_S;

    place_init(place);
    *course = (course_t){.count = 0};
    seed_course_floor(wanted, seed, place);
    const double ramp_m = gone_m(wanted, wanted->ramp_start_s - start_s);
    if (wanted->ramp) {
        put_ramp(wanted, ramp_m, place);
    }
    if (wanted->ramp || passes) {
        go(wanted, course, start_s, passes ? FAR_M : end_m(wanted, ramp_m));
    }
}

void seed_course_meet(const seed_course_t *wanted, double x_m, double start_s, double ahead_s, place_t *place,
                      course_t *course)
{
    const double ramp_m = x_m + gone_m(wanted, ahead_s);

    put_ramp(wanted, ramp_m, place);
    go(wanted, course, start_s, end_m(wanted, ramp_m));
}
