#include <string.h>

#include "cpu.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/model.h"
#include "sysctl.h"

#define WDDIS 0x40U
#define WDPS 0x07U
#define COUNTS 256
#define COUNT_NS 51200   /* 10 MHz / 512 */
#define NMI_PERIOD 65536 /* NMIWDPRD after reset, and one */

static struct {
    uint32_t wdcr;
    sim_time_t counted; /* ns since the count was 0, up to the anchor */
    sim_time_t anchor;
    timeline_id_t overflow;
} watchdog;

static struct {
    unsigned count;
    timeline_id_t expiry;
} nmi;

static uint32_t causes;
static uint32_t boot_rom_causes;
static void (*reset_callback)(void *context);
static void *reset_context;

static sim_time_t period(void)
{
    const uint32_t prescaler = watchdog.wdcr & WDPS;

    return (sim_time_t)COUNTS * COUNT_NS << (prescaler == 0 ? 0 : prescaler - 1);
}

static void bite(uint32_t cause)
{
    causes |= cause | SYSCTL_CAUSE_XRS;
    if (reset_callback != NULL) {
        reset_callback(reset_context);
    }
}

static void overflow(void *unused)
{
    (void)unused;
    watchdog.overflow = 0;
    bite(SYSCTL_CAUSE_WDRS);
}

static void nmi_expired(void *unused)
{
    (void)unused;
    nmi.expiry = 0;
    bite(SYSCTL_CAUSE_NMIWDRS);
}

void chip_nmi(void)
{
    nmi.count++;
    if (nmi.expiry == 0) {
        nmi.expiry = timeline_after(NMI_PERIOD * SIM_S / (sim_time_t)sysctl_sysclk_hz(), nmi_expired, NULL);
    }
}

unsigned chip_nmis(void)
{
    return nmi.count;
}

/* The part of the period that is over stays over under another prescaler. */
static void change(uint32_t wdcr, bool service)
{
    const sim_time_t before = period();
    const bool counting = timeline_cancel(watchdog.overflow);

    watchdog.counted = service ? 0 : watchdog.counted + (counting ? timeline_now() - watchdog.anchor : 0);
    watchdog.wdcr = wdcr;
    watchdog.counted = watchdog.counted / (before / COUNTS) * (period() / COUNTS);
    watchdog.anchor = timeline_now();
    watchdog.overflow = (wdcr & WDDIS) != 0 ? 0 : timeline_after(period() - watchdog.counted, overflow, NULL);
}

void watchdog_reset(void)
{
    timeline_cancel(nmi.expiry);
    nmi.expiry = 0;
    change(0, true);
}

void watchdog_power_on(void)
{
    causes = SYSCTL_CAUSE_POR | SYSCTL_CAUSE_XRS;
    boot_rom_causes = causes;
    nmi.count = 0;
    watchdog_reset();
}

void chip_watchdog_connect(void (*reset)(void *context), void *context)
{
    reset_callback = reset;
    reset_context = context;
}

bool watchdog_register(const char *name, uint32_t *value)
{
    if (strcmp(name, "WDCR") != 0) {
        return false;
    }
    *value = watchdog.wdcr;
    return true;
}

void SysCtl_setWatchdogMode(SysCtl_WDMode mode)
{
    EALLOW;
    if (mode != SYSCTL_WD_MODE_RESET) {
        chip_unmodelled("the watchdog's interrupt");
    }
    EDIS;
}

void SysCtl_setWatchdogPrescaler(SysCtl_WDPrescaler prescaler)
{
    EALLOW;
    change((watchdog.wdcr & ~WDPS) | prescaler, false);
    EDIS;
}

void SysCtl_enableWatchdog(void)
{
    EALLOW;
    change(watchdog.wdcr & ~WDDIS, false);
    EDIS;
}

void SysCtl_disableWatchdog(void)
{
    EALLOW;
    change(watchdog.wdcr | WDDIS, false);
    EDIS;
}

void SysCtl_serviceWatchdog(void)
{
    EALLOW;
    change(watchdog.wdcr, true);
    EDIS;
}

uint32_t SysCtl_getResetCause(void)
{
    return causes | boot_rom_causes;
}

void SysCtl_clearResetCause(uint32_t rstCauses)
{
    causes &= ~rstCauses;
}
