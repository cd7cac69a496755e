/* The vehicle of a file that `make fit` wrote. */
#ifndef PLOMADA_VEHICLE_H
#define PLOMADA_VEHICLE_H

#include "sim/scenarios/flight.h"

/* Adds what the file says of the plant to the overrides, `"plant.NAME": {"value": V ...}` each: as if typed
 * behind --set, in the place of this call. Returns NULL or what is wrong. */
const char *vehicle_read(flight_options_t *options, const char *path);

#endif
