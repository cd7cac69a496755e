#include "sim/devices/surface.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define WHITE 0.9
#define SURE_M 4.0  /* the seed, 2.4 */
#define BLIND_M 5.6 /* PP's DMAX */
#define NOISE_FROM_M 0.5
#define NOISE_PER_M 0.4
#define LOBE_RAD (5.0 * M_PI / 180.0) /* chosen: of what comes straight back from a polished floor */
#define SUN_SHORTENS 1.5              /* chosen: the sensor is sold for use indoors */
#define DARK_MM 10.0 /* chosen; the +-10 mm to 1 m that are told of a data sheet that could not be read */

const surface_t surface_plain = {"plain", WHITE, 0.0, 0.0, 0.0, 0.0};

/* Reflectances, gloss and depths are chosen but for glass. */
static const surface_t named[] = {
    {"white", WHITE, 0.0, 0.0, 0.0, 0.0},
    {"grey", 0.4, 0.0, 0.0, 0.0, 0.0},
    {"black", 0.06, 0.0, 0.0, DARK_MM, 0.0},
    {"foam", 0.03, 0.0, 0.0, DARK_MM, 20.0},
    {"wood", 0.5, 0.1, 0.0, 0.0, 0.0},
    {"tiles", 0.6, 0.2, 0.0, 0.0, 0.0},
    {"dark_tiles", 0.08, 0.2, 0.0, DARK_MM, 0.0},
    {"carpet", 0.3, 0.0, 0.0, 0.0, 8.0},
    {"deep_carpet", 0.3, 0.0, 0.0, 0.0, 30.0},
    {"wet", 0.06, 0.4, 0.0, 0.0, 0.0},
    {"metal", 0.15, 0.6, 0.0, 0.0, 0.0},
    {"glass", 0.02, 0.08, 0.9, 0.0, 0.0},
};

const surface_t *surface_find(const char *name)
{
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++) {
        if (strcmp(named[i].name, name) == 0) {
            return &named[i];
        }
    }
    return strcmp(name, surface_plain.name) == 0 ? &surface_plain : NULL;
}

/* The share of its gloss that comes back along the ray. */
static double glint(const surface_t *surface, double incidence_cos)
{
    if (surface->gloss <= 0.0) {
        return 0.0;
    }
    const double off = acos(fmin(incidence_cos, 1.0)) / LOBE_RAD;

    return surface->gloss * exp(-off * off);
}

double surface_signal(const surface_t *surface, double incidence_cos)
{
    return surface == &surface_plain
               ? 1.0
               : (surface->reflectance * incidence_cos + glint(surface, incidence_cos)) / WHITE;
}

/* The distance at which white paper gives as little. */
static double as_white_m(double signal, double distance_m, double sunlight)
{
    return signal > 0.0 ? distance_m * (1.0 + SUN_SHORTENS * sunlight) / sqrt(signal) : INFINITY;
}

double surface_lost(double signal, double distance_m, double sunlight)
{
    const double share = (as_white_m(signal, distance_m, sunlight) - SURE_M) / (BLIND_M - SURE_M);

    return fmin(fmax(share, 0.0), 1.0);
}

double surface_dazzles(const surface_t *surface, double incidence_cos)
{
    const double back = glint(surface, incidence_cos);

    return back * back;
}

double surface_noise(double signal, double distance_m, double sunlight)
{
    const double as_m = fmin(as_white_m(signal, distance_m, sunlight), BLIND_M);

    return 1.0 + NOISE_PER_M * fmax(as_m - NOISE_FROM_M, 0.0);
}
