/* TaskReceiveLaser preempts TaskReceiveComm and not the other way round: only TaskReceiveComm turns
 * interrupts off for its copy. No gate, so that a scan waits for nobody's parameters. */
#include "firmware/geometry.h"

#include <ti/sysbios/family/c28/Hwi.h>
#include <xdc/std.h>

static altitude_geometry_t mounted;

void geometry_mount(const parameters_t *parameters)
{
    const altitude_geometry_t geometry = altitude_geometry_of(parameters);
    UInt key = Hwi_disable();

    mounted = geometry;
    Hwi_restore(key);
}

void geometry_mounted(altitude_geometry_t *geometry)
{
    *geometry = mounted;
}
