#include <limits.h>
#include <string.h>

#include "sim/ti/sysbios/core.h"

#define FIRST_PIE 32
#define FIRST_UPPER 128
#define GROUP 8
#define NUMBERS 224
#define WORDS ((NUMBERS + 63) / 64)

struct Hwi_Object {
    job_t job;
    Hwi_FuncPtr function; /* NULL: number not taken */
    UArg argument;
    sim_time_t raised_at;
};

static struct Hwi_Object hwis[NUMBERS];
static uint64_t raised[WORDS];
static uint64_t enabled[WORDS];
static unsigned masked; /* bits of the IER, whose Hwis are in hand */

static bool is_on(const uint64_t *set, int number)
{
    return (set[number / 64] >> (number % 64) & 1u) != 0;
}

static void turn_on(uint64_t *set, int number)
{
    set[number / 64] |= (uint64_t)1 << (number % 64);
}

void hwi_module_reset(void)
{
    memset(hwis, 0, sizeof hwis);
    memset(raised, 0, sizeof raised);
    memset(enabled, 0, sizeof enabled);
    masked = 0;
}

/* The bit of the IER: a group of the PIE has the same for both halves of its numbers. */
static unsigned mask_of(int number)
{
    if (number < FIRST_PIE) {
        return 1u << (number - 1);
    }
    return 1u << ((number < FIRST_UPPER ? number - FIRST_PIE : number - FIRST_UPPER) / GROUP);
}

static void release(int number)
{
    hwis[number].raised_at = timeline_now();
    kernel_observed(KERNEL_RELEASED, &hwis[number].job, number);
}

void kernel_raise(int interrupt)
{
    kernel_require(interrupt >= 0 && interrupt < NUMBERS, "kernel_raise: no such interrupt");
    if (!is_on(raised, interrupt)) {
        turn_on(raised, interrupt);
        if (is_on(enabled, interrupt)) {
            release(interrupt);
        }
    }
}

static int first_waiting(void)
{
    for (int word = 0; word < WORDS; word++) {
        for (uint64_t waiting = raised[word] & enabled[word]; waiting != 0; waiting &= waiting - 1) {
            const int number = word * 64 + __builtin_ctzll(waiting);

            if ((masked & mask_of(number)) == 0) {
                return number;
            }
        }
    }
    return -1;
}

bool hwi_waiting(void)
{
    return first_waiting() >= 0;
}

job_t *hwi_take(void)
{
    int number = first_waiting();

    raised[number / 64] &= ~((uint64_t)1 << (number % 64));
    hwis[number].job.remaining = hwis[number].job.cost;
    hwis[number].job.id.released = hwis[number].raised_at;
    masked |= mask_of(number);
    kernel_hooks()->hwi_begin(&hwis[number]);
    return &hwis[number].job;
}

void hwi_run(job_t *job)
{
    struct Hwi_Object *hwi = &hwis[job->rank];

    hwi->function(hwi->argument);
    kernel_hooks()->hwi_end(hwi);
    masked &= ~mask_of(job->rank);
}

static Hwi_Handle create(Int number, Hwi_FuncPtr function, UArg argument, const char *name)
{
    const kernel_cost_t *cost = kernel_cost_of_interrupt(number);
    bool needs_name = name[0] == '\0' && cost != NULL && cost->name != NULL;

    hwis[number] = (struct Hwi_Object){
        .job = {.id = {KERNEL_HWI, needs_name ? cost->name : name, number, number, 0},
                .rank = number,
                .cost = cost != NULL ? cost->job : 0},
        .function = function,
        .argument = argument};
    return &hwis[number];
}

static void enable(int number)
{
    if (!is_on(enabled, number)) {
        turn_on(enabled, number);
        if (is_on(raised, number)) {
            release(number);
            kernel_reschedule();
        }
    }
}

void hwi_create_internal(Int number, Hwi_FuncPtr function, const char *name)
{
    (void)create(number, function, 0, name);
    enable(number);
}

static bool valid(Int number)
{
    return (number >= 1 && number <= 15) || (number >= FIRST_PIE && number < NUMBERS);
}

Hwi_Handle Hwi_create(Int intNum, Hwi_FuncPtr hwiFxn, const Hwi_Params *params, Error_Block *eb)
{
    Hwi_Params defaults;

    kernel_require_create_context("Hwi_create");
    kernel_require(valid(intNum), "Hwi_create: interrupt number out of range");
    if (params == NULL) {
        Hwi_Params_init(&defaults);
        params = &defaults;
    }
    if (hwis[intNum].function != NULL) {
        return kernel_create_failed(eb, "Hwi_create: interrupt number already taken");
    }
    Hwi_Handle hwi = create(intNum, hwiFxn, params->arg, kernel_name(params->instance));

    if (params->enableInt) {
        enable(intNum);
    }
    return hwi;
}

UInt Hwi_disable(Void)
{
    job_t *self = kernel_thread();

    if (self == NULL || self->interrupts_off) {
        return 1;
    }
    self->interrupts_off = true;
    return 0;
}

Void Hwi_restore(UInt key)
{
    job_t *self = kernel_thread();

    if (key == 0 && self != NULL) {
        self->interrupts_off = false;
        kernel_reschedule();
    }
}

UInt Hwi_enableInterrupt(UInt intNum)
{
    kernel_require(intNum <= INT_MAX && valid((Int)intNum),
                   "Hwi_enableInterrupt: interrupt number out of range");
    kernel_require(hwis[intNum].function != NULL, "Hwi_enableInterrupt: no Hwi of this number");
    bool was_on = is_on(enabled, (int)intNum);

    enable((int)intNum);
    return was_on ? 1 : 0;
}

Void Hwi_plug(UInt intNum, Hwi_PlugFuncPtr fxn)
{
    (void)fxn;
    kernel_halt("Hwi_plug: vector %u: below the simulated dispatcher", intNum);
}

Bits16 Hwi_enableIER(Bits16 mask)
{
    kernel_halt("Hwi_enableIER: mask %u: below the simulated dispatcher", mask);
}

Bits16 Hwi_enablePIEIER(UInt groupNum, Bits16 pieMask)
{
    kernel_halt("Hwi_enablePIEIER: group %u, mask %u: below the simulated dispatcher", groupNum, pieMask);
}
