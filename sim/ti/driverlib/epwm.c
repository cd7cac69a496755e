#include "epwm.h"

#include <string.h>

#include "sim/ti/driverlib/model.h"
#include "sysctl.h"

#define TBCTL_CTRMODE 0x0003U
#define TBCTL_PHSEN 0x0004U
#define TBCTL_PRDLD 0x0008U
#define TBCTL_HSPCLKDIV_S 7U
#define TBCTL_CLKDIV_S 10U
#define TBCTL_DIVIDERS 0x1F80U
#define TBCTL_FREE_SOFT_S 14U
#define TBCTL_FREE_SOFT 0xC000U
#define CMPCTL_LOADAMODE 0x0003U
#define CMPCTL_SHDWAMODE 0x0010U

typedef struct {
    uint32_t shadow, active;
} shadowed_t;

static struct {
    uint32_t tbctl, tbphs, cmpctl, aqctla;
    shadowed_t tbprd, cmpa;
    uint32_t counter; /* at the anchor; the actions for this value are done */
    sim_time_t anchor;
    bool counting;
    bool level;
    timeline_id_t event; /* one per period: the next match of compare A */
} pwm;

void epwm_reset(void)
{
    if (pwm.event != 0) {
        timeline_cancel(pwm.event);
    }
    memset(&pwm, 0, sizeof pwm);
    pwm.tbctl = 0x0083;
}

bool epwm_level(void)
{
    return pwm.level;
}

static bool may_count(void)
{
    return sysctl_clocked(SYSCTL_PERIPH_CLK_EPWM2) && sysctl_clocked(SYSCTL_PERIPH_CLK_TBCLKSYNC) &&
           (pwm.tbctl & TBCTL_CTRMODE) == EPWM_COUNTER_MODE_UP && pwm.tbprd.shadow > 0;
}

static int64_t clocks_per_tick(void)
{
    const uint32_t fast = pwm.tbctl >> TBCTL_HSPCLKDIV_S & 7U;
    return (int64_t)(fast == 0 ? 1U : 2U * fast) << (pwm.tbctl >> TBCTL_CLKDIV_S & 7U);
}

static sim_time_t ticks_ns(int64_t ticks)
{
    const int64_t hz = sysctl_epwmclk_hz();
    return (ticks * clocks_per_tick() * 1000000000 + hz / 2) / hz;
}

static bool period_shadowed(void)
{
    return (pwm.tbctl & TBCTL_PRDLD) == 0;
}

static bool compare_shadowed(void)
{
    return (pwm.cmpctl & CMPCTL_SHDWAMODE) == 0;
}

static void act(uint32_t event)
{
    switch (pwm.aqctla >> event & 3U) {
    case EPWM_AQ_OUTPUT_LOW:
        pwm.level = false;
        break;
    case EPWM_AQ_OUTPUT_HIGH:
        pwm.level = true;
        break;
    case EPWM_AQ_OUTPUT_TOGGLE:
        pwm.level = !pwm.level;
        break;
    default:
        break;
    }
}

/* The counter arrives at a value. Compare A outranks zero when both match. */
static void arrive(uint32_t counter, sim_time_t when)
{
    pwm.counter = counter;
    pwm.anchor = when;
    if (counter == 0) {
        pwm.tbprd.active = pwm.tbprd.shadow;
        pwm.cmpa.active = pwm.cmpa.shadow;
        act(EPWM_AQ_OUTPUT_ON_TIMEBASE_ZERO);
    }
    if (counter == pwm.cmpa.active) {
        act(EPWM_AQ_OUTPUT_ON_TIMEBASE_UP_CMPA);
    }
    gpio_throttle_changed(when);
}

static bool match_ahead(void)
{
    return pwm.cmpa.active > pwm.counter && pwm.cmpa.active <= pwm.tbprd.active;
}

/* A period that was written below the counter lets the counter run to its 16-bit end. */
static sim_time_t next_zero(void)
{
    const uint32_t last = pwm.counter <= pwm.tbprd.active ? pwm.tbprd.active : 0xFFFFU;
    return pwm.anchor + ticks_ns((int64_t)last + 1 - pwm.counter);
}

void epwm_catch_up(void)
{
    while (pwm.counting) {
        const bool match = match_ahead();
        const sim_time_t when = match ? pwm.anchor + ticks_ns((int64_t)pwm.cmpa.active - pwm.counter)
                                      : next_zero();
        if (when > timeline_now()) {
            return;
        }
        arrive(match ? pwm.cmpa.active : 0, when);
    }
}

static void schedule(void);

static void due(void *context)
{
    (void)context;
    pwm.event = 0;
    epwm_catch_up();
    schedule();
}

static void schedule(void)
{
    if (pwm.event != 0) {
        timeline_cancel(pwm.event);
        pwm.event = 0;
    }
    if (!pwm.counting) {
        return;
    }
    sim_time_t when = next_zero();
    if (match_ahead()) {
        when = pwm.anchor + ticks_ns((int64_t)pwm.cmpa.active - pwm.counter);
    } else if (pwm.cmpa.shadow <= pwm.tbprd.shadow) {
        when += ticks_ns(pwm.cmpa.shadow);
    }
    pwm.event = timeline_at(when, due, NULL);
}

/* Before a change of rate or gates: brings the counter up to now. */
void epwm_clocks_change(void)
{
    epwm_catch_up();
    if (pwm.counting) {
        const int64_t ticks = (timeline_now() - pwm.anchor) * (int64_t)sysctl_epwmclk_hz() /
                              (clocks_per_tick() * 1000000000);
        pwm.counter += (uint32_t)ticks;
        pwm.anchor += ticks_ns(ticks);
    }
}

void epwm_clocks_changed(void)
{
    const bool was_counting = pwm.counting;
    pwm.counting = may_count();
    if (pwm.counting && !was_counting) {
        arrive(pwm.counter, timeline_now());
    }
    schedule();
}

static bool writable(uint32_t base)
{
    if (base != EPWM2_BASE) {
        chip_unmodelled("only EPWM2");
    }
    epwm_catch_up();
    return sysctl_clocked(SYSCTL_PERIPH_CLK_EPWM2);
}

static void write_tbctl(uint32_t base, uint32_t mask, uint32_t bits)
{
    if (writable(base)) {
        epwm_clocks_change();
        pwm.tbctl = (pwm.tbctl & ~mask) | bits;
        epwm_clocks_changed();
    }
}

void EPWM_setClockPrescaler(uint32_t base, EPWM_ClockDivider prescaler,
                            EPWM_HSClockDivider highSpeedPrescaler)
{
    write_tbctl(base, TBCTL_DIVIDERS,
                (uint32_t)prescaler << TBCTL_CLKDIV_S | (uint32_t)highSpeedPrescaler << TBCTL_HSPCLKDIV_S);
}

void EPWM_setEmulationMode(uint32_t base, EPWM_EmulationMode emulationMode)
{
    write_tbctl(base, TBCTL_FREE_SOFT, (uint32_t)emulationMode << TBCTL_FREE_SOFT_S);
}

void EPWM_setTimeBaseCounterMode(uint32_t base, EPWM_TimeBaseCountMode counterMode)
{
    if (counterMode != EPWM_COUNTER_MODE_UP && counterMode != EPWM_COUNTER_MODE_STOP_FREEZE) {
        chip_unmodelled("only up-count");
    }
    write_tbctl(base, TBCTL_CTRMODE, counterMode);
}

void EPWM_setPeriodLoadMode(uint32_t base, EPWM_PeriodLoadMode loadMode)
{
    write_tbctl(base, TBCTL_PRDLD, loadMode == EPWM_PERIOD_DIRECT_LOAD ? TBCTL_PRDLD : 0);
}

void EPWM_disablePhaseShiftLoad(uint32_t base)
{
    write_tbctl(base, TBCTL_PHSEN, 0);
}

void EPWM_setPhaseShift(uint32_t base, uint16_t phaseCount)
{
    if (writable(base)) {
        pwm.tbphs = (uint32_t)phaseCount << 16;
    }
}

void EPWM_setTimeBasePeriod(uint32_t base, uint16_t periodCount)
{
    if (writable(base)) {
        epwm_clocks_change();
        pwm.tbprd.shadow = periodCount;
        if (!period_shadowed()) {
            pwm.tbprd.active = periodCount;
        }
        epwm_clocks_changed();
    }
}

void EPWM_setTimeBaseCounter(uint32_t base, uint16_t count)
{
    if (writable(base)) {
        pwm.counter = count;
        pwm.counting = false;
        epwm_clocks_changed();
    }
}

static void check_compare(EPWM_CounterCompareModule compModule)
{
    if (compModule != EPWM_COUNTER_COMPARE_A) {
        chip_unmodelled("only compare A");
    }
}

void EPWM_setCounterCompareShadowLoadMode(uint32_t base, EPWM_CounterCompareModule compModule,
                                          EPWM_CounterCompareLoadMode loadMode)
{
    check_compare(compModule);
    if (loadMode != EPWM_COMP_LOAD_ON_CNTR_ZERO) {
        chip_unmodelled("only compare loads at zero");
    }
    if (writable(base)) {
        pwm.cmpctl &= ~(CMPCTL_SHDWAMODE | CMPCTL_LOADAMODE);
    }
}

void EPWM_disableCounterCompareShadowLoadMode(uint32_t base, EPWM_CounterCompareModule compModule)
{
    check_compare(compModule);
    if (writable(base)) {
        pwm.cmpctl |= CMPCTL_SHDWAMODE;
    }
}

void EPWM_setCounterCompareValue(uint32_t base, EPWM_CounterCompareModule compModule, uint16_t compCount)
{
    check_compare(compModule);
    if (writable(base)) {
        pwm.cmpa.shadow = compCount;
        if (!compare_shadowed()) {
            pwm.cmpa.active = compCount;
        }
        schedule();
    }
}

void EPWM_setActionQualifierAction(uint32_t base, EPWM_ActionQualifierOutputModule epwmOutput,
                                   EPWM_ActionQualifierOutput output, EPWM_ActionQualifierOutputEvent event)
{
    if (epwmOutput != EPWM_AQ_OUTPUT_A ||
        (event != EPWM_AQ_OUTPUT_ON_TIMEBASE_ZERO && event != EPWM_AQ_OUTPUT_ON_TIMEBASE_UP_CMPA)) {
        chip_unmodelled("only output A, at zero and at compare A going up");
    }
    if (writable(base)) {
        pwm.aqctla = (pwm.aqctla & ~(3U << event)) | (uint32_t)output << event;
    }
}

bool epwm_register(const char *name, uint32_t *value)
{
    const struct {
        const char *name;
        uint32_t value;
    } words[] = {
        {"EPWM2.TBCTL", pwm.tbctl},      {"EPWM2.TBPRD", pwm.tbprd.shadow}, {"EPWM2.TBPHS", pwm.tbphs},
        {"EPWM2.CMPA", pwm.cmpa.shadow}, {"EPWM2.CMPCTL", pwm.cmpctl},      {"EPWM2.AQCTLA", pwm.aqctla},
    };
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (strcmp(name, words[i].name) == 0) {
            *value = words[i].value;
            return true;
        }
    }
    return false;
}
