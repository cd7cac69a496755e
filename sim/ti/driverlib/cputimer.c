#include "cputimer.h"

#include "sim/ti/driverlib/model.h"
#include "sysctl.h"

#define TIMER_COUNT 3U

typedef struct {
    uint32_t count; /* at the anchor */
    uint32_t period;
    uint16_t prescaler;
    bool stopped;
    sim_time_t anchor;
} cputimer_t;

static cputimer_t timers[TIMER_COUNT];
static const uint32_t CLOCKS[TIMER_COUNT] = {SYSCTL_PERIPH_CLK_TIMER0, SYSCTL_PERIPH_CLK_TIMER1,
                                             SYSCTL_PERIPH_CLK_TIMER2};

/* The timers run from reset on. */
void cputimer_reset(void)
{
    for (unsigned i = 0; i < TIMER_COUNT; i++) {
        timers[i] = (cputimer_t){.count = 0xFFFF, .period = 0xFFFF, .anchor = timeline_now()};
    }
}

static uint32_t count_now(const cputimer_t *timer)
{
    const uint64_t ns = (uint64_t)(timeline_now() - timer->anchor);
    const uint64_t hz = sysctl_sysclk_hz();
    uint64_t ticks = (ns / 1000000000U * hz + ns % 1000000000U * hz / 1000000000U) / (timer->prescaler + 1U);
    if (timer->stopped || !sysctl_clocked(CLOCKS[timer - timers]) || ticks == 0) {
        return timer->count;
    }
    if (ticks <= timer->count) {
        return (uint32_t)(timer->count - ticks);
    }
    ticks = (ticks - timer->count - 1) % ((uint64_t)timer->period + 1);
    return (uint32_t)(timer->period - ticks);
}

static void settle(cputimer_t *timer)
{
    timer->count = count_now(timer);
    timer->anchor = timeline_now();
}

void cputimer_clocks_change(void)
{
    for (unsigned i = 0; i < TIMER_COUNT; i++) {
        settle(&timers[i]);
    }
}

void cputimer_disturb(unsigned timer, uint32_t count)
{
    settle(&timers[timer]);
    timers[timer].count = count;
}

static cputimer_t *at(uint32_t base)
{
    const uint32_t index = (base - CPUTIMER0_BASE) / (CPUTIMER1_BASE - CPUTIMER0_BASE);
    if (index >= TIMER_COUNT) {
        chip_unmodelled("no CPU timer at this base");
    }
    return &timers[index];
}

static cputimer_t *settled(uint32_t base)
{
    settle(at(base));
    return at(base);
}

void CPUTimer_stopTimer(uint32_t base)
{
    settled(base)->stopped = true;
}

void CPUTimer_resumeTimer(uint32_t base)
{
    settled(base)->stopped = false;
}

void CPUTimer_reloadTimerCounter(uint32_t base)
{
    cputimer_t *timer = settled(base);
    timer->count = timer->period;
}

void CPUTimer_startTimer(uint32_t base)
{
    CPUTimer_reloadTimerCounter(base);
    CPUTimer_resumeTimer(base);
}

void CPUTimer_setPeriod(uint32_t base, uint32_t periodCount)
{
    settled(base)->period = periodCount;
}

void CPUTimer_setPreScaler(uint32_t base, uint16_t prescaler)
{
    settled(base)->prescaler = prescaler;
}

uint32_t CPUTimer_getTimerCount(uint32_t base)
{
    return count_now(at(base));
}
