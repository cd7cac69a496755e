/* The order of start-up: throttle pin low first, PWM after the clocks, nothing between the clocks and the
 * PWM. */
#include "bsp/board.h"
#include "device.h"
#include "mock_gpio.h"
#include "mock_led.h"
#include "mock_receiver.h"
#include "mock_selector.h"
#include "mock_sysctl.h"
#include "mock_throttle.h"
#include "mock_timebase.h"
#include "mock_voltmeter.h"
#include "unity.h"

/* CMock's count of calls across all mocks: what makes their order strict. */
int GlobalExpectCount, GlobalVerifyOrder;

void setUp(void)
{
    GlobalExpectCount = GlobalVerifyOrder = 0;
}

void tearDown(void) {}

static void expect_uart(SysCtl_PeripheralPCLOCKCR clock, uint32_t tx, uint32_t tx_config, uint32_t rx,
                        uint32_t rx_config)
{
    SysCtl_enablePeripheral_Expect(clock);
    GPIO_writePin_Expect(tx, 1);
    GPIO_setPadConfig_Expect(tx, GPIO_PIN_TYPE_STD);
    GPIO_setDirectionMode_Expect(tx, GPIO_DIR_MODE_OUT);
    GPIO_setPinConfig_Expect(tx_config);
    GPIO_setPadConfig_Expect(rx, GPIO_PIN_TYPE_PULLUP);
    GPIO_setQualificationMode_Expect(rx, GPIO_QUAL_ASYNC);
    GPIO_setDirectionMode_Expect(rx, GPIO_DIR_MODE_IN);
    GPIO_setPinConfig_Expect(rx_config);
}

/* TI's masks, device.c of C2000Ware 26.01.00.00, Device_enableUnbondedGPIOPullupsFor100Pin(). */
static void expect_pull_ups(void)
{
    static const uint32_t masks[] = {0xFFC003E3U, 0x03FFF1FFU, 0xE10FBC18U,
                                     0xFFFFFFF7U, 0xFFFFFFFFU, 0x000001FFU};

    for (uint32_t pin = 0; pin < 6 * 32; pin++) {
        if ((masks[pin / 32] >> pin % 32 & 1U) != 0) {
            GPIO_setPadConfig_Expect(pin, GPIO_PIN_TYPE_PULLUP);
        }
    }
}

void test_the_whole_start_up_in_its_order(void)
{
    SysCtl_disableWatchdog_Expect();
    GPIO_writePin_Expect(2, 0);
    GPIO_setPadConfig_Expect(2, GPIO_PIN_TYPE_STD);
    GPIO_setPinConfig_Expect(GPIO_2_GPIO2);
    GPIO_setDirectionMode_Expect(2, GPIO_DIR_MODE_OUT);
    bsp_led_init_Expect();
    bsp_led_red_Expect(true);
    SysCtl_setClock_ExpectAndReturn(0x800100A8U, true); /* PLL on, crystal, /2, x 40 */
    SysCtl_setLowSpeedClock_Expect(SYSCTL_LSPCLK_PRESCALE_2);
    bsp_throttle_init_Expect();
    bsp_led_red_Expect(false);
    expect_uart(SYSCTL_PERIPH_CLK_SCIA, 65, GPIO_65_SCITXDA, 64, GPIO_64_SCIRXDA);
    expect_uart(SYSCTL_PERIPH_CLK_SCIB, 86, GPIO_86_SCITXDB, 87, GPIO_87_SCIRXDB);
    expect_uart(SYSCTL_PERIPH_CLK_SCIC, 89, GPIO_89_SCITXDC, 90, GPIO_90_SCIRXDC);
    bsp_selector_init_Expect();
    bsp_receiver_init_Expect();
    expect_pull_ups();
    SysCtl_enablePeripheral_Expect(SYSCTL_PERIPH_CLK_TIMER1);
    SysCtl_enablePeripheral_Expect(SYSCTL_PERIPH_CLK_TIMER2);
    bsp_time_init_Expect();
    bsp_voltmeter_init_Expect();
    bsp_board_init();
}
