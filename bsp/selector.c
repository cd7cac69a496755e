#include "bsp/selector.h"

#include "device.h"

#define SELECTOR_PIN 3U
#define SAMPLE_DIVIDER 510U

void bsp_selector_init(void)
{
    GPIO_setPadConfig(SELECTOR_PIN, GPIO_PIN_TYPE_PULLUP);
    GPIO_setQualificationPeriod(SELECTOR_PIN, SAMPLE_DIVIDER);
    GPIO_setQualificationMode(SELECTOR_PIN, GPIO_QUAL_6SAMPLE);
    GPIO_setDirectionMode(SELECTOR_PIN, GPIO_DIR_MODE_IN);
    GPIO_setPinConfig(GPIO_3_GPIO3);
}

bool bsp_selector_ours(void)
{
    return GPIO_readPin(SELECTOR_PIN) != 0U;
}
