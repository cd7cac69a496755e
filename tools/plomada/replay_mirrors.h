/* Each mirror's height, from the columns that a log has of it. */
#ifndef PLOMADA_REPLAY_MIRRORS_H
#define PLOMADA_REPLAY_MIRRORS_H

#include <stdbool.h>

#include "control/altitude.h"
#include "control/attitude.h"

/* The columns of one mirror after the other; drivers/flight_beams.h has their meaning. */
#define REPLAY_MIRRORS_TITLES \
    "mf_rays", "mf_mm", "mf_spread_mm", "mf_ms", "m1_rays", "m1_mm", "m1_spread_mm", "m1_ms", "m2_rays", \
        "m2_mm", "m2_spread_mm", "m2_ms"
#define REPLAY_MIRRORS_CELLS 12

/* How many mirrors saw something. cells: of one row; NAN is an empty one. */
int replay_mirrors_told(const double cells[REPLAY_MIRRORS_CELLS]);

/* Writes the MIRROR_COUNT heights that the cells and this tilt make. age_s: of their mean, as the row has it.
 * Slants are told along the axis; windows: how far aside of it their rays were. */
void replay_mirrors_read(altitude_t *mirrors, const double cells[REPLAY_MIRRORS_CELLS], double age_s,
                         const altitude_geometry_t *places, const mirror_windows_t *windows,
                         const attitude_t *tilt);

/* Writes the heights of mirrors over level ground, where the log has the height alone. several: of all
 * mirrors; else of the front mirror. It has no rays: so good_rays is 0, and nothing is concluded from how
 * little the slant varies (sense/mirrors.h). */
void replay_mirrors_make(altitude_t *mirrors, double height_m, bool several,
                         const altitude_geometry_t *places, const attitude_t *tilt);

#endif
