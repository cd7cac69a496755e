/* TaskReceiveLaser and TaskSendLaser preempt TaskReceiveComm and not the other way round: only
 * TaskReceiveComm turns interrupts off for its copy. No gate, so that a scan waits for nobody's parameters.
 */
#include "firmware/geometry.h"

#include <ti/sysbios/family/c28/Hwi.h>
#include <xdc/std.h>

typedef char every_mirror_has_a_group[((uint16_t)MIRROR_COUNT == SCIP_GROUPS_MAX) ? 1 : -1];

static geometry_t mounted;

void geometry_mount(const parameters_t *parameters)
{
    static geometry_t geometry;

    geometry.places = altitude_geometry_of(parameters);
    geometry.windows = altitude_windows_of(parameters);
    geometry.layout = scip_layout_around(geometry.windows.middle, geometry.windows.count,
                                         geometry.windows.reach);
    const UInt key = Hwi_disable();
    mounted = geometry;
    Hwi_restore(key);
}

void geometry_mounted(geometry_t *geometry)
{
    *geometry = mounted;
}
