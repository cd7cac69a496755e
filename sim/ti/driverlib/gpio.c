#include "gpio.h"

#include <stdio.h>
#include <string.h>

#include "cpu.h"
#include "pin_map.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/model.h"

#define PIN_COUNT 169U
#define THROTTLE_PIN 2U
#define MUX_VALUE 0xFU
#define GROUP 8U
#define SAMPLE_DIVIDER_MAX 510U

typedef struct {
    uint32_t mux;
    GPIO_Direction direction;
    uint32_t pud; /* 1: pull-up off */
    GPIO_QualificationMode qualification;
    bool latch;
    bool held_low; /* from outside */
    bool low;      /* as the latest change by a GPIO function left it */
    unsigned falls;
} pin_t;

static pin_t pins[PIN_COUNT];
static uint32_t sample_dividers[PIN_COUNT / GROUP + 1];

static struct {
    chip_pulse_t pulse;
    void *context;
    bool level;
    sim_time_t rose;
} throttle;

/* Inputs without pull-up. What is wired to the pins stays. */
void gpio_reset(void)
{
    for (unsigned i = 0; i < PIN_COUNT; i++) {
        pins[i] = (pin_t){.pud = 1, .held_low = pins[i].held_low};
    }
    memset(sample_dividers, 0, sizeof sample_dividers);
    throttle.level = false;
}

static pin_t *at(uint32_t pin)
{
    if (pin >= PIN_COUNT) {
        chip_unmodelled("no such pin");
    }
    return &pins[pin];
}

uint32_t gpio_pin(uint32_t pin_config)
{
    const uint32_t offset = pin_config >> 16;
    const uint32_t upper_half = (offset & 0x3FU) == 8U ? 16U : 0U;
    return offset / 0x40U * 32U + upper_half + (pin_config >> 8 & 0xFFU) / 2U;
}

bool gpio_routed(uint32_t pin_config)
{
    return at(gpio_pin(pin_config))->mux == (pin_config & MUX_VALUE);
}

bool gpio_input(uint32_t pin_config)
{
    return !at(gpio_pin(pin_config))->held_low;
}

static bool drives(uint32_t pin, bool *level)
{
    if (at(pin)->mux == 0) {
        *level = pins[pin].latch;
        return pins[pin].direction == GPIO_DIR_MODE_OUT;
    }
    if (pin == THROTTLE_PIN && gpio_routed(GPIO_2_EPWM2A)) {
        *level = epwm_level();
        return true;
    }
    return sci_drives(pin, level);
}

void gpio_throttle_changed(sim_time_t when)
{
    bool level;
    level = drives(THROTTLE_PIN, &level) && level;
    if (level == throttle.level) {
        return;
    }
    throttle.level = level;
    if (level) {
        throttle.rose = when;
    } else if (throttle.pulse != NULL) {
        throttle.pulse(throttle.context, when - throttle.rose);
    }
}

void chip_pwm_connect(chip_pulse_t pulse, void *context)
{
    throttle.pulse = pulse;
    throttle.context = context;
}

bool chip_pin(uint32_t pin)
{
    bool level;
    epwm_catch_up();
    return drives(pin, &level) ? level : !at(pin)->held_low;
}

void chip_drive_pin(uint32_t pin, bool level)
{
    const bool changes = at(pin)->held_low == level;

    at(pin)->held_low = !level;
    sci_lines_changed();
    if (changes) {
        ecap_pin_changed(pin, level);
    }
}

unsigned chip_pin_falls(uint32_t pin)
{
    return at(pin)->falls;
}

static void changed(uint32_t pin)
{
    const bool low = !chip_pin(pin);
    pins[pin].falls += low && !pins[pin].low;
    pins[pin].low = low;
}

void GPIO_setPinConfig(uint32_t pinConfig)
{
    EALLOW;
    epwm_catch_up();
    at(gpio_pin(pinConfig))->mux = pinConfig & MUX_VALUE;
    gpio_throttle_changed(timeline_now());
    sci_lines_changed();
    changed(gpio_pin(pinConfig));
    EDIS;
}

void GPIO_setDirectionMode(uint32_t pin, GPIO_Direction pinIO)
{
    EALLOW;
    at(pin)->direction = pinIO;
    gpio_throttle_changed(timeline_now());
    changed(pin);
    EDIS;
}

void GPIO_setPadConfig(uint32_t pin, uint32_t pinType)
{
    EALLOW;
    if ((pinType & (GPIO_PIN_TYPE_INVERT | GPIO_PIN_TYPE_OD)) != 0) {
        chip_unmodelled("inverted and open-drain pins");
    }
    at(pin)->pud = (pinType & GPIO_PIN_TYPE_PULLUP) == 0;
    EDIS;
}

void GPIO_setQualificationMode(uint32_t pin, GPIO_QualificationMode qualification)
{
    EALLOW;
    at(pin)->qualification = qualification;
    EDIS;
}

void GPIO_setQualificationPeriod(uint32_t pin, uint32_t divider)
{
    EALLOW;
    if (divider == 0 || divider > SAMPLE_DIVIDER_MAX || (divider % 2U != 0 && divider != 1)) {
        chip_unmodelled("such a qualification period");
    }
    (void)at(pin);
    sample_dividers[pin / GROUP] = divider / 2U;
    EDIS;
}

uint32_t GPIO_readPin(uint32_t pin)
{
    return chip_pin(pin) ? 1U : 0U;
}

void GPIO_writePin(uint32_t pin, uint32_t outVal)
{
    at(pin)->latch = outVal != 0;
    gpio_throttle_changed(timeline_now());
    changed(pin);
}

bool gpio_register(const char *name, uint32_t *value)
{
    unsigned pin;
    char field[8];
    if (sscanf(name, "GPIO%u.%7s", &pin, field) != 2 || pin >= PIN_COUNT) {
        return false;
    }
    const struct {
        const char *name;
        uint32_t value;
    } fields[] = {
        {"MUX", pins[pin].mux},
        {"DIR", pins[pin].direction},
        {"PUD", pins[pin].pud},
        {"QSEL", pins[pin].qualification},
        {"QUALPRD", sample_dividers[pin / GROUP]},
        {"DAT", chip_pin(pin)},
    };
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        if (strcmp(field, fields[i].name) == 0) {
            *value = fields[i].value;
            return true;
        }
    }
    return false;
}
