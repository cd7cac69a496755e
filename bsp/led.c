#include "bsp/led.h"

#include "device.h"

#define RED_PIN DEVICE_GPIO_PIN_LED1
#define BLUE_PIN DEVICE_GPIO_PIN_LED2
#define LIT 0U
#define DARK 1U

static void open_pin(uint32_t pin, uint32_t pin_config)
{
    GPIO_writePin(pin, DARK);
    GPIO_setPadConfig(pin, GPIO_PIN_TYPE_STD);
    GPIO_setPinConfig(pin_config);
    GPIO_setDirectionMode(pin, GPIO_DIR_MODE_OUT);
}

void bsp_led_init(void)
{
    open_pin(RED_PIN, DEVICE_GPIO_CFG_LED1);
    open_pin(BLUE_PIN, DEVICE_GPIO_CFG_LED2);
}

void bsp_led_red(bool on)
{
    GPIO_writePin(RED_PIN, on ? LIT : DARK);
}

void bsp_led_blue(bool on)
{
    GPIO_writePin(BLUE_PIN, on ? LIT : DARK);
}
