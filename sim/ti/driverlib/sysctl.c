#include "sysctl.h"

#include <string.h>

#include "cpu.h"
#include "sim/ti/driverlib/model.h"

#define CRYSTAL_HZ 10000000U
#define PCLKCR_COUNT 32U
#define PLL_ON 3U /* PLLEN and PLLCLKEN */
/* What the check of the new SYSCLK leaves in CPU timers 1 and 2: it counts 0x800 periods of the crystal. */
#define TIMER1_AFTER (0xF0000000U - 0x800U * 20U)
#define TIMER2_AFTER 0x800U

static struct {
    uint32_t clksrcctl1, syspllmult, syspllctl1, sysclkdivsel, lospcp, perclkdivsel;
    uint32_t pclkcr[PCLKCR_COUNT];
    bool crystal_failed;
} sys;

/* SYSCLK as the boot ROM leaves it: internal oscillator 2, PLL off, divided by 1. */
void sysctl_reset(void)
{
    memset(&sys, 0, sizeof sys);
    sys.lospcp = 2;
    sys.perclkdivsel = 0x51;
    sys.pclkcr[0] = 0x38;
}

void sysctl_fail_crystal(void)
{
    sys.crystal_failed = true;
}

static void change(uint32_t *word, uint32_t value)
{
    epwm_clocks_change();
    cputimer_clocks_change();
    *word = value;
    epwm_clocks_changed();
}

uint32_t SysCtl_getClock(uint32_t clockInHz)
{
    uint32_t hz = (sys.clksrcctl1 == SYSCTL_OSCSRC_XTAL >> SYSCTL_OSCSRC_S) ? clockInHz
                                                                            : SYSCTL_DEFAULT_OSC_FREQ;
    if (sys.crystal_failed) {
        return SYSCTL_DEFAULT_OSC_FREQ;
    }
    if (sys.syspllctl1 == PLL_ON) {
        hz = hz * (sys.syspllmult & 0x7FU) + hz * (sys.syspllmult >> 8) / 4;
    }
    return sys.sysclkdivsel == 0 ? hz : hz / (2 * sys.sysclkdivsel);
}

uint32_t sysctl_sysclk_hz(void)
{
    return SysCtl_getClock(CRYSTAL_HZ);
}

uint32_t sysctl_lspclk_hz(void)
{
    return sys.lospcp == 0 ? sysctl_sysclk_hz() : sysctl_sysclk_hz() / (2 * sys.lospcp);
}

uint32_t sysctl_epwmclk_hz(void)
{
    return sysctl_sysclk_hz() >> (sys.perclkdivsel & 3U);
}

bool SysCtl_setClock(uint32_t config)
{
    EALLOW;
    if (sys.crystal_failed) {
        EDIS;
        return false;
    }
    change(&sys.clksrcctl1, (uint32_t)((config & SYSCTL_OSCSRC_M) >> SYSCTL_OSCSRC_S));
    change(&sys.syspllctl1, 0);
    change(&sys.sysclkdivsel, (uint32_t)((config & SYSCTL_SYSDIV_M) >> SYSCTL_SYSDIV_S));
    if ((config & SYSCTL_PLL_ENABLE) != 0) {
        const uint32_t quarters = (uint32_t)((config & SYSCTL_FMULT_M) >> SYSCTL_FMULT_S);
        change(&sys.syspllmult, (uint32_t)(config & SYSCTL_IMULT_M) | quarters << 8);
        change(&sys.syspllctl1, PLL_ON);
    }
    cputimer_disturb(1, TIMER1_AFTER);
    cputimer_disturb(2, TIMER2_AFTER);
    EDIS;
    return true;
}

void SysCtl_setPLLSysClk(uint16_t divider)
{
    EALLOW;
    change(&sys.sysclkdivsel, divider);
    EDIS;
}

void SysCtl_setLowSpeedClock(SysCtl_LSPCLKPrescaler prescaler)
{
    EALLOW;
    sys.lospcp = prescaler;
    EDIS;
}

void SysCtl_setEPWMClockDivider(SysCtl_EPWMCLKDivider divider)
{
    EALLOW;
    change(&sys.perclkdivsel, (sys.perclkdivsel & ~3U) | divider);
    EDIS;
}

void SysCtl_enablePeripheral(SysCtl_PeripheralPCLOCKCR peripheral)
{
    EALLOW;
    uint32_t *word = &sys.pclkcr[peripheral & 0x1F];
    change(word, *word | 1U << (peripheral >> 8));
    EDIS;
}

void SysCtl_disablePeripheral(SysCtl_PeripheralPCLOCKCR peripheral)
{
    EALLOW;
    uint32_t *word = &sys.pclkcr[peripheral & 0x1F];
    change(word, *word & ~(1U << (peripheral >> 8)));
    EDIS;
}

bool sysctl_clocked(uint32_t peripheral)
{
    return (sys.pclkcr[peripheral & 0x1F] >> (peripheral >> 8) & 1U) != 0;
}

bool sysctl_register(const char *name, uint32_t *value)
{
    const struct {
        const char *name;
        uint32_t value;
    } words[] = {
        {"CLKSRCCTL1", sys.clksrcctl1}, {"SYSPLLMULT", sys.syspllmult},
        {"SYSPLLCTL1", sys.syspllctl1}, {"SYSCLKDIVSEL", sys.sysclkdivsel},
        {"LOSPCP", sys.lospcp},         {"PERCLKDIVSEL", sys.perclkdivsel},
        {"PCLKCR0", sys.pclkcr[0]},     {"PCLKCR2", sys.pclkcr[2]},
        {"PCLKCR7", sys.pclkcr[7]},
    };
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (strcmp(name, words[i].name) == 0) {
            *value = words[i].value;
            return true;
        }
    }
    return false;
}
