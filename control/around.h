/* What stands around the vehicle, by the scanner's rays that no mirror bends.
 *
 * A bearing goes clockwise from the nose, seen from above: 0 ahead, pi/2 to the right. Ranges are level
 * distances from the scanner, which stands on the vehicle's right side. Millimetres and radians. Pure; the
 * caller owns the state. Context: one at a time. */
#ifndef CONTROL_AROUND_H
#define CONTROL_AROUND_H

#include <stdint.h>

#include "control/parameters.h"

#define AROUND_SECTORS 72U   /* of 5 degrees, from the nose clockwise */
#define AROUND_RAYS_MAX 171U /* as many as a scan of several mirrors has */
#define AROUND_NOTHING 0U    /* nothing in reach, or the ray was lost, or it may be the floor */
#define AROUND_UNSEEN 0xFFFFU

/* One look round: `count` rays, `turn_rad` from one to the next. */
typedef struct {
    uint16_t count;
    float first_rad;              /* bearing of ray 0; may be beyond pi */
    float turn_rad;               /* below 0: the scanner turns counter-clockwise */
    uint16_t mm[AROUND_RAYS_MAX]; /* or AROUND_NOTHING, AROUND_UNSEEN */
} around_look_t;

/* Where the vehicle is while it looks. */
typedef struct {
    float roll_rad, pitch_rad; /* attitude.h */
    float above_floor_mm;      /* the scanner */
} around_place_t;

/* Sets count and bearings of a look whose rays lie at this step and then every so many steps. Step 384 looks
 * to the right; how far the mount is turned from that is told by where its mirrors were found. */
void around_begin(around_look_t *look, const parameters_t *parameters, float first_step, uint16_t every,
                  uint16_t count);

/* Place of the scanner, from the gear's height. NAN: not known, then it counts as 0. */
around_place_t around_place(const parameters_t *parameters, float height_mm, float roll_rad, float pitch_rad);

/* Makes level distances of the ranges, and takes out what may be the floor, which a tilted vehicle sees. */
void around_level(around_look_t *look, const around_place_t *place);

/* Takes out what no second ray tells: its neighbour, or one of the same direction in the look before. So the
 * sun's or a fault's single rays are no thing, and a thin post is one from the second look on. before: the
 * look before this one, as around_level() left it; its count is 0 where there is none. */
void around_confirm(around_look_t *confirmed, const around_look_t *look, const around_look_t *before);

/* The nearest of each sector: mm, AROUND_NOTHING, or AROUND_UNSEEN where no ray looks. */
void around_sectors(uint16_t sectors[AROUND_SECTORS], const around_look_t *look);

/* The bearing of ray `index`, -pi .. pi. */
float around_ray_rad(const around_look_t *look, uint16_t index);

/* Whether two ranges may be of one thing that neighbouring rays see. */
bool around_same(uint16_t a_mm, uint16_t b_mm);

#endif
