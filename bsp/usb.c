/* GPIO84 also chooses the boot mode at reset, and must be high then. So it is an output only while it is
 * used, and is pulled up afterwards. The scanner's pin is a high output when the UART does not have it
 * (bsp/board.c). */
#include "bsp/usb.h"

#include "device.h"

#define USB_PIN DEVICE_GPIO_PIN_SCITXDA

static void take_pin(void)
{
    GPIO_setPinConfig(GPIO_65_GPIO65);
    GPIO_writePin(USB_PIN, 1U);
    GPIO_setPadConfig(USB_PIN, GPIO_PIN_TYPE_PULLUP);
    GPIO_setDirectionMode(USB_PIN, GPIO_DIR_MODE_OUT);
    GPIO_setPinConfig(DEVICE_GPIO_CFG_SCITXDA);
}

static void give_back(void)
{
    GPIO_setPinConfig(GPIO_84_GPIO84);
    GPIO_setDirectionMode(USB_PIN, GPIO_DIR_MODE_IN);
    GPIO_setPinConfig(GPIO_65_SCITXDA);
}

void bsp_usb_transmit(bool on)
{
    if (on) {
        take_pin();
    } else {
        give_back();
    }
}
