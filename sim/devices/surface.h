/* What the scanner's light does where it meets a surface.
 *
 * How sure the figures are. Kneip et al. (ICRA 2009) and Okubo, Ye, Borenstein (SPIE 2009) measured this
 * sensor; only the abstract of the first and the first lines of the second could be read here. The first
 * says: the accuracy depends strongly on colour, brightness and material, so that one calibration does not
 * fit; measurements are wrong where little light comes back (dark surfaces, foam) and at steep angles on
 * shiny ones. It fixes the kinds of effects below, and no figure. Figures come from what could be read or
 * measured:
 *
 *   - the seed (2.4): 20 mm to 4 m; the sensor's own PP: DMAX 5600. So white paper met square is seen for
 *     certain up to 4 m, and not at all beyond 5.6 m;
 *   - the noise by distance: scene.h's recording. Its rays have 2.1 mm at 0.5 m, 2.6 at 0.85, 2.9 at 1.25,
 *     3.3 at 2.0: 0.4 more for each metre beyond 0.5;
 *   - light spreads, so that what comes back falls with the square of the distance and with the cosine of the
 *     incidence (Lambert);
 *   - glass throws back 4 % at each of its two faces (Fresnel, index 1.5);
 *   - what is marked "chosen" has no source. */
#ifndef SIM_DEVICES_SURFACE_H
#define SIM_DEVICES_SURFACE_H

#define SURFACE_NAME_N 16

typedef struct {
    char name[SURFACE_NAME_N];
    double reflectance; /* share of the light at 785 nm that it scatters; white paper 0.9 */
    double gloss;       /* share that it throws off as a mirror does */
    double clear;       /* share that goes through to what lies behind */
    double offset_mm;   /* is read too far by so much, by its colour */
    double depth_mm;    /* of a pile: each ray ends anywhere within it */
} surface_t;

/* The named ones; a name of NULL ends them. `plain` has no effects at all: it is what nothing else is said
 * of. */
extern const surface_t surface_plain;
const surface_t *surface_find(const char *name);

/* What comes back of a ray, white paper met square at the same distance being 1. incidence_cos: of the angle
 * to the surface's normal. Plain surfaces answer 1 at any angle. */
double surface_signal(const surface_t *surface, double incidence_cos);
/* Probability that such a ray finds too little light. sunlight: 0 none, 1 straight on the spot. */
double surface_lost(double signal, double distance_m, double sunlight);
/* Probability that it finds too much: the sensor's code 18. */
double surface_dazzles(const surface_t *surface, double incidence_cos);
/* Its noise in ray_noise's. */
double surface_noise(double signal, double distance_m, double sunlight);

#endif
