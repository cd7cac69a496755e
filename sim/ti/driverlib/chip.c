#include "sim/ti/driverlib/chip.h"

#include <stdio.h>
#include <stdlib.h>

#include "cpu.h"
#include "sim/ti/driverlib/model.h"

_Noreturn void chip_unmodelled(const char *what)
{
    fprintf(stderr, "chip model: %s\n", what);
    abort();
}

static void (*raise_interrupt)(int interrupt);
static bool protected_writable;

void driverlib_eallow(void)
{
    protected_writable = true;
}

void driverlib_edis(void)
{
    protected_writable = false;
}

bool chip_protected_writable(void)
{
    return protected_writable;
}

static void reset_registers(void)
{
    protected_writable = false;
    sysctl_reset();
    cputimer_reset();
    gpio_reset();
    sci_reset(raise_interrupt);
    epwm_reset();
    ecap_reset();
    adc_reset();
}

void chip_reset(void (*raise)(int interrupt))
{
    raise_interrupt = raise;
    reset_registers();
    watchdog_power_on();
}

void chip_restart(void)
{
    reset_registers();
    watchdog_reset();
}

uint32_t chip_register(const char *name)
{
    uint32_t value;
    if (sysctl_register(name, &value) || gpio_register(name, &value) || sci_register(name, &value) ||
        epwm_register(name, &value) || watchdog_register(name, &value)) {
        return value;
    }
    chip_unmodelled(name);
}
