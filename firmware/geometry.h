/* Places of the mirrors, and the rays that look at them: exchange between TaskReceiveComm, which sets the
 * parameters, and the scanner's two tasks. */
#ifndef FIRMWARE_GEOMETRY_H
#define FIRMWARE_GEOMETRY_H

#include "control/altitude.h"
#include "drivers/scip_layout.h"

typedef struct {
    altitude_geometry_t places;
    mirror_windows_t windows;
    scip_layout_t layout; /* the same, for the scanner */
} geometry_t;

/* Sets all from the parameters; valid from the next scan on. TaskReceiveComm or main(). */
void geometry_mount(const parameters_t *parameters);
/* Copies what is mounted. TaskReceiveLaser, TaskSendLaser or main(). */
void geometry_mounted(geometry_t *geometry);

#endif
