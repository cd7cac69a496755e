/* Where the vehicle flies: a floor, things that stand on it, and walls.
 *
 * Axes: x, y along the floor, z up from it, metres; angles in radians, counter-clockwise from above, 0 along
 * x. Every thing is one convex block: a length along its heading, a width across, a level bottom, and a top
 * that is level or rises evenly from the near end to the far one. So a ramp is one block, a flight of stairs
 * is some, a table is a board on four legs, a wall is a thin high one.
 *
 * The floor between the things may have bars, and be rough: a sum of waves with the statistics of white noise
 * through two equal lags, in the plane (a Matern field of order 3/2: covariance rms^2 (1 + r/l) exp(-r/l) at
 * distance r, l half of the correlation length). Waves by Rahimi and Recht 2007: their vectors are drawn from
 * the field's spectrum, a bivariate t distribution with three degrees of freedom. */
#ifndef SIM_DEVICES_PLACE_H
#define SIM_DEVICES_PLACE_H

#include <stdbool.h>

#include "sim/devices/span.h"
#include "sim/devices/surface.h"

#define PLACE_BLOCKS_MAX 200
#define PLACE_SUNS_MAX 8
#define PLACE_WAVES 64
/* A surface that is higher than the gear by less carries it; a higher one is a wall. A vehicle that falls at
 * 10 m/s comes 5 mm deeper in a step of 0.5 ms; a kerb of 20 mm lifts the gear that slides over it. */
#define PLACE_CARRIES_M 0.02

typedef struct {
    double x, y, z;
} place_vector_t;

typedef struct {
    double x_m, y_m;    /* middle of its base */
    double heading_rad; /* of its length */
    double length_m, width_m;
    double bottom_m; /* above the floor */
    double near_top_m, far_top_m;
    span_t there;    /* scenario time in which it is there; a zeroed span: always */
    double travel_m; /* a lift: bottom and top rise by so much, < 0: sink, and come back after stay_s */
    double travel_mps;
    double travel_start_s, stay_s;
    surface_t surface; /* without a name: plain */
} place_block_t;

typedef struct {
    double rms_m;         /* 0: even */
    double correlation_m; /* the integral of its autocorrelation */
} place_rough_t;

/* Bars across the floor, one behind the other along x for ever. */
typedef struct {
    double height_m; /* < 0: grooves; 0: none */
    double period_m; /* from bar to bar */
    double share;    /* of it is a bar, the rest gap */
    double from_m;   /* there the first gap begins */
} place_bars_t;

/* Sunlight on everything over a part of the floor. */
typedef struct {
    double x_m, y_m, heading_rad, length_m, width_m;
    double strength; /* 0..1 */
} place_sun_t;

typedef struct {
    int count;
    place_block_t blocks[PLACE_BLOCKS_MAX];
    struct { /* of each block: its heading, and how far from its middle it ends */
        double cosine, sine, radius_m;
    } bounds[PLACE_BLOCKS_MAX];
    surface_t
        floor[2]; /* in squares like a chequer board's, a corner at the origin; the first only: tile_m 0 */
    double tile_m;
    int suns;
    place_sun_t sun[PLACE_SUNS_MAX];
    double level_m; /* of the floor; a pit is a lower floor between blocks */
    place_bars_t bars;
    place_rough_t rough;
    struct {
        double kx, ky, phase;
    } waves[PLACE_WAVES];
} place_t;

/* What a ray or the gear meets. */
typedef struct {
    double distance_m; /* along the ray, whose direction has length 1 */
    place_vector_t at;
    double slope_x, slope_y; /* of a top: rise per metre along x and y */
    double rises_mps;        /* of a lift */
    double incidence_cos;    /* cosine of the angle to the surface's normal, 0..1 */
    int block;               /* -1: the floor */
    const surface_t *surface;
} place_hit_t;

/* An even floor with nothing on it. */
void place_init(place_t *place);
/* False: full. The block is copied. */
bool place_add(place_t *place, const place_block_t *block);
/* False: full. */
bool place_shine(place_t *place, const place_sun_t *sun);
/* The waves of a rough floor by the seed. */
void place_roughen(place_t *place, const place_rough_t *rough, unsigned long seed);

/* The first surface that a ray meets at scenario time t_s; false: none within reach_m. direction: length 1.
 * A ray that begins inside a block leaves it unseen. */
bool place_cast(const place_t *place, place_vector_t from, place_vector_t direction, double reach_m,
                double t_s, place_hit_t *hit);

/* Sunlight at (x, y). */
double place_sunlight(const place_t *place, double x_m, double y_m);

/* The highest surface at (x, y) that is not more than PLACE_CARRIES_M above z_m; there is always the floor.
 */
place_hit_t place_below(const place_t *place, double x_m, double y_m, double z_m, double t_s);

/* The block of that number as it is at t_s, lifted; false: it is not there. */
bool place_block_at(const place_t *place, int number, double t_s, place_block_t *block);

/* True in a block, deeper than a surface may be and still carry: where only a collision leads. */
bool place_inside(const place_t *place, place_vector_t point, double t_s);

#endif
