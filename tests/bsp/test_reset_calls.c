/* Every call to driverlib in its order, and the causes that the chip model cannot make. */
#include "device.h"
#include "mock_sysctl.h"
#include "unity.h"
#include "bsp/reset.h"

/* CMock's count of calls across all mocks: what makes their order strict. */
int GlobalExpectCount, GlobalVerifyOrder;

void setUp(void)
{
    GlobalExpectCount = GlobalVerifyOrder = 0;
}

void tearDown(void) {}

static void assert_cause(bsp_reset_t expected, uint32_t causes)
{
    SysCtl_getResetCause_ExpectAndReturn(causes);
    SysCtl_clearResetCause_Expect(0x10FU);
    TEST_ASSERT_EQUAL(expected, bsp_reset_cause());
}

/* Bits of RESC: POR 1, XRS 2, WDRS 4, NMIWDRS 8, SCCRESET 100H. A watchdog sets XRS too; POR may be a note
 * from before. */
void test_the_most_particular_cause_is_told(void)
{
    assert_cause(BSP_RESET_POWER, 0x3U);
    assert_cause(BSP_RESET_POWER, 0x1U);
    assert_cause(BSP_RESET_PIN, 0x2U);
    assert_cause(BSP_RESET_WATCHDOG, 0x4U);
    assert_cause(BSP_RESET_WATCHDOG, 0x6U);
    assert_cause(BSP_RESET_WATCHDOG, 0x7U);
    assert_cause(BSP_RESET_NMI, 0x8U);
    assert_cause(BSP_RESET_NMI, 0xAU);
    assert_cause(BSP_RESET_NMI, 0xFU);
    assert_cause(BSP_RESET_OTHER, 0x0U);
    assert_cause(BSP_RESET_OTHER, 0x100U);
    assert_cause(BSP_RESET_PIN, 0x102U);
}
