/* Between TaskReceiveComm, which takes the parameters, and TaskReceiveLaser: where the mirrors are. */
#ifndef FIRMWARE_GEOMETRY_H
#define FIRMWARE_GEOMETRY_H

#include "control/altitude.h"

/* TaskReceiveComm, main(): from the next scan on. */
void geometry_mount(const parameters_t *parameters);
/* TaskReceiveLaser. */
void geometry_mounted(altitude_geometry_t *geometry);

#endif
