/* Every call to driverlib in its order. */
#include "device.h"
#include "mock_sysctl.h"
#include "unity.h"
#include "bsp/watchdog.h"

/* CMock's count of calls across all mocks: what makes their order strict. */
int GlobalExpectCount, GlobalVerifyOrder;

void setUp(void)
{
    GlobalExpectCount = GlobalVerifyOrder = 0;
}

void tearDown(void) {}

/* The prescaler before the start, and a service so that the first period is whole. */
void test_the_start(void)
{
    SysCtl_setWatchdogMode_Expect(SYSCTL_WD_MODE_RESET);
    SysCtl_setWatchdogPrescaler_Expect(SYSCTL_WD_PRESCALE_64);
    SysCtl_serviceWatchdog_Expect();
    SysCtl_enableWatchdog_Expect();
    bsp_watchdog_start();
}

void test_a_service(void)
{
    SysCtl_serviceWatchdog_Expect();
    bsp_watchdog_service();
}
