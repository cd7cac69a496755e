/* Places of the mirrors: exchange between TaskReceiveComm, which sets the parameters, and TaskReceiveLaser.
 */
#ifndef FIRMWARE_GEOMETRY_H
#define FIRMWARE_GEOMETRY_H

#include "control/altitude.h"

/* Sets the places from the parameters; valid from the next scan on. TaskReceiveComm or main(). */
void geometry_mount(const parameters_t *parameters);
/* Copies the present places. TaskReceiveLaser. */
void geometry_mounted(altitude_geometry_t *geometry);

#endif
