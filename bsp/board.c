/* Why in this order. A throttle pulse shorter than 2 ms is thrust, 1 ms is full thrust; no pulse at all is a
 * lost receiver to the autopilot. So a missing pulse is safe and a short one is not:
 *  - the throttle pin becomes a plain output, low, before anything else. The PWM does not have it while the
 * clocks change: SYSCLK goes from 10 to 200 MHz, which would shrink a running 2 ms pulse to 0.1 ms;
 *  - the clocks are set next, some milliseconds. The red LED is lit meanwhile: driverlib waits for ever for a
 * crystal that never starts, with the LED lit and the pin low. When it reports a failed crystal instead, the
 * chip runs on its internal oscillator and the idle pulse is made from that;
 *  - the PWM starts as soon as the clocks are right, before UARTs and timers.
 * Interrupts are off throughout (before BIOS_start()), so nothing else can change a pulse. */
#include "bsp/board.h"

#include <stddef.h>

#include "device.h"
#include "bsp/voltmeter.h"
#include "bsp/led.h"
#include "bsp/receiver.h"
#include "bsp/selector.h"
#include "bsp/throttle.h"
#include "bsp/timebase.h"

#if DEVICE_OSCSRC_FREQ != 10000000U
#error "device.h describes another board: define _LAUNCHXL_F28377S"
#endif

#define THROTTLE_PIN 2U

typedef struct {
    SysCtl_PeripheralPCLOCKCR clock;
    uint32_t transmit_pin, transmit_config;
    uint32_t receive_pin, receive_config;
} uart_pins_t;

static const uart_pins_t UARTS[] = {
    {SYSCTL_PERIPH_CLK_SCIA, 65U, GPIO_65_SCITXDA, 64U, GPIO_64_SCIRXDA}, /* J5.47, J6.54 */
    {SYSCTL_PERIPH_CLK_SCIB, 86U, GPIO_86_SCITXDB, 87U, GPIO_87_SCIRXDB}, /* J5.44, J5.43 */
    {SYSCTL_PERIPH_CLK_SCIC, 89U, GPIO_89_SCITXDC, 90U, GPIO_90_SCIRXDC}, /* J1.4, J1.3 */
};
#define UART_COUNT (sizeof UARTS / sizeof UARTS[0])

/* Pins without a leg on the 100-pin package: an input that floats costs current. The ranges of TI's device.c.
 */
static const struct {
    uint16_t first, last;
} UNBONDED[] = {{0U, 1U},   {5U, 9U},   {22U, 40U}, {44U, 57U}, {67U, 68U},
                {74U, 77U}, {79U, 83U}, {88U, 88U}, {93U, 98U}, {100U, 168U}};
#define UNBONDED_COUNT (sizeof UNBONDED / sizeof UNBONDED[0])

static void hold_throttle_low(void)
{
    GPIO_writePin(THROTTLE_PIN, 0U);
    GPIO_setPadConfig(THROTTLE_PIN, GPIO_PIN_TYPE_STD);
    GPIO_setPinConfig(GPIO_2_GPIO2);
    GPIO_setDirectionMode(THROTTLE_PIN, GPIO_DIR_MODE_OUT);
}

static void set_clocks(void)
{
    if (!SysCtl_setClock(DEVICE_SETCLOCK_CFG)) {
        SysCtl_setPLLSysClk(0U);
        bsp_throttle_init();
        for (;;) {
        }
    }
    SysCtl_setLowSpeedClock(SYSCTL_LSPCLK_PRESCALE_2);
}

static void open_uart_pins(const uart_pins_t *pins)
{
    SysCtl_enablePeripheral(pins->clock);
    GPIO_writePin(pins->transmit_pin, 1U); /* mark: an output that is low, however shortly, is a start bit */
    GPIO_setPadConfig(pins->transmit_pin, GPIO_PIN_TYPE_STD);
    GPIO_setDirectionMode(pins->transmit_pin, GPIO_DIR_MODE_OUT);
    GPIO_setPinConfig(pins->transmit_config);
    GPIO_setPadConfig(pins->receive_pin, GPIO_PIN_TYPE_PULLUP);
    GPIO_setQualificationMode(pins->receive_pin, GPIO_QUAL_ASYNC);
    GPIO_setDirectionMode(pins->receive_pin, GPIO_DIR_MODE_IN);
    GPIO_setPinConfig(pins->receive_config);
}

static void pull_up_unbonded(void)
{

    for (size_t i = 0U; i < UNBONDED_COUNT; ++i) {
        for (uint16_t pin = UNBONDED[i].first; pin <= UNBONDED[i].last; ++pin) {
            GPIO_setPadConfig(pin, GPIO_PIN_TYPE_PULLUP);
        }
    }
}

void bsp_board_init(void)
{

    SysCtl_disableWatchdog();
    hold_throttle_low();
    bsp_led_init();
    bsp_led_red(true);
    set_clocks();
    bsp_throttle_init();
    bsp_led_red(false);
    for (size_t i = 0U; i < UART_COUNT; ++i) {
        open_uart_pins(&UARTS[i]);
    }
    bsp_selector_init();
    bsp_receiver_init();
    pull_up_unbonded();
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_TIMER1);
    SysCtl_enablePeripheral(SYSCTL_PERIPH_CLK_TIMER2);
    bsp_time_init();
    bsp_voltmeter_init();
}
