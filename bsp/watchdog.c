#include "bsp/watchdog.h"

#include "device.h"

void bsp_watchdog_start(void)
{
    SysCtl_setWatchdogMode(SYSCTL_WD_MODE_RESET);
    SysCtl_setWatchdogPrescaler(SYSCTL_WD_PRESCALE_64);
    SysCtl_serviceWatchdog();
    SysCtl_enableWatchdog();
}

void bsp_watchdog_service(void)
{
    SysCtl_serviceWatchdog();
}
