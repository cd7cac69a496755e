#include "bsp/reset.h"

#include "device.h"

#define ALL_CAUSES \
    (SYSCTL_CAUSE_POR | SYSCTL_CAUSE_XRS | SYSCTL_CAUSE_WDRS | SYSCTL_CAUSE_NMIWDRS | SYSCTL_CAUSE_SCCRESET)

/* Both watchdogs pull the reset pin too, and the boot ROM's note of an earlier power-on may still be there.
 */
static bsp_reset_t cause_of(uint32_t causes)
{
    if ((causes & SYSCTL_CAUSE_NMIWDRS) != 0U) {
        return BSP_RESET_NMI;
    }
    if ((causes & SYSCTL_CAUSE_WDRS) != 0U) {
        return BSP_RESET_WATCHDOG;
    }
    if ((causes & SYSCTL_CAUSE_POR) != 0U) {
        return BSP_RESET_POWER;
    }
    return ((causes & SYSCTL_CAUSE_XRS) != 0U) ? BSP_RESET_PIN : BSP_RESET_OTHER;
}

bsp_reset_t bsp_reset_cause(void)
{
    const uint32_t causes = SysCtl_getResetCause();

    SysCtl_clearResetCause(ALL_CAUSES);
    return cause_of(causes);
}
