/* How the scanner is used on this vehicle: ray layout and bit rate. For another layout or bit rate change
 * the line here. */
#ifndef FIRMWARE_MOUNTING_H
#define FIRMWARE_MOUNTING_H

#include "control/altitude.h"
#include "drivers/scip_layout.h"

#define LASER_LAYOUT SCIP_LAYOUT_FRONT
#define LASER_FIRST_RATE 115200UL  /* bits per second after power-up, where none is stored */
#define LASER_STREAM_RATE 250000UL /* bits per second; the MAX3222's limit, no higher rate is tried */
#define LASER_WAIT_US 10000000UL   /* start-up time of sensor and RS232 adapter, seed document 5.2.1.3 */

/* The mirror of each group of rays, for each layout. */
static const mirror_t laser_mirrors[][SCIP_GROUPS_MAX] = {
    {MIRROR_FRONT, MIRROR_FRONT, MIRROR_FRONT},
    {MIRROR_AFT, MIRROR_FORE, MIRROR_FRONT},
    {MIRROR_AFT, MIRROR_FRONT, MIRROR_FORE},
};
typedef char
    every_layout_has_its_mirrors[(sizeof laser_mirrors / sizeof laser_mirrors[0] == SCIP_LAYOUT_COUNT) ? 1
                                                                                                       : -1];

#endif
