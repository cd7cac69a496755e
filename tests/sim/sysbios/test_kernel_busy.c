#include "tests/sim/sysbios/kernel_helper.h"

#include <stdio.h>
#include <string.h>

#include "sim/noise.h"
#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

/* ---- a busy system: the same twice, the same in pieces, and never two tasks in one gate ---- */

static noise_t dice;
static uint64_t hash;
static long observed;
static int inside[2], overlaps;
static GateMutexPri_Handle busy_gates[2];
static Semaphore_Handle busy_sems[3];

static void observe_hash(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job,
                         int detail)
{
    (void)context;
    hash = (hash ^ (uint64_t)when) * 0x100000001B3u;
    hash = (hash ^ (uint64_t)what) * 0x100000001B3u;
    hash = (hash ^ (uint64_t)(unsigned char)job->name[0]) * 0x100000001B3u;
    hash = (hash ^ (uint64_t)detail) * 0x100000001B3u;
    observed++;
}

static void use_gate(uint64_t which)
{
    IArg key = GateMutexPri_enter(busy_gates[which]);

    overlaps += inside[which]++ != 0;
    if (noise_bits(&dice) % 4 == 0) {
        IArg nested = GateMutexPri_enter(busy_gates[which]);

        GateMutexPri_leave(busy_gates[which], nested);
    }
    if (which == 0 && noise_bits(&dice) % 4 == 0) { /* always in this order: no deadlock */
        use_gate(1);
    }
    overlaps += --inside[which] != 0;
    GateMutexPri_leave(busy_gates[which], key);
}

static Void busy_task(UArg a0, UArg a1)
{
    (void)a1;
    for (;;) {
        switch (noise_bits(&dice) % 6) {
        case 0:
            Task_sleep((UInt32)(1 + noise_bits(&dice) % 4));
            break;
        case 1:
            (void)Semaphore_pend(busy_sems[a0 % 3], (UInt32)(1 + noise_bits(&dice) % 5));
            break;
        case 2:
            Semaphore_post(busy_sems[noise_bits(&dice) % 3]);
            break;
        case 3:
            use_gate(noise_bits(&dice) % 2);
            break;
        case 4:
            Swi_post(noise_bits(&dice) % 2 == 0 ? swi_low : swi_high);
            break;
        default:
            (void)Event_pend(event, 0, (UInt)1 << a0, BIOS_NO_WAIT);
            Task_sleep(1);
            break;
        }
    }
}

static Void busy_hwi(UArg number)
{
    Semaphore_post(busy_sems[number % 3]);
    Swi_post(swi_mid);
}

static Void busy_swi(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    Semaphore_post(busy_sems[noise_bits(&dice) % 3]);
    Event_post(event, 1u << (noise_bits(&dice) % 8));
}

static void busy_world(void *unused)
{
    (void)unused;
    kernel_raise((int)(92 + noise_bits(&dice) % 8));
    (void)timeline_after((sim_time_t)(noise_bits(&dice) % 700000), busy_world, NULL);
}

static const kernel_cost_t busy_jobs[] = {
    {"0", -1, 91 * SIM_US}, {"1", -1, 83 * SIM_US},   {"2", -1, 77 * SIM_US},   {"3", -1, 65 * SIM_US},
    {"4", -1, 51 * SIM_US}, {"low", -1, 21 * SIM_US}, {"mid", -1, 13 * SIM_US}, {"high", -1, 7 * SIM_US},
    {NULL, 38, 4 * SIM_US}, {NULL, 92, 11 * SIM_US},  {NULL, 96, 25 * SIM_US},  {NULL, 99, 3 * SIM_US},
};
static const kernel_costs_t busy_costs = {busy_jobs, sizeof busy_jobs / sizeof busy_jobs[0], 9 * SIM_US,
                                          5 * SIM_US};

static int busy_main(void)
{
    static const char *const names[] = {"0", "1", "2", "3", "4"};

    event = Event_create(NULL, NULL);
    for (int i = 0; i < 3; i++) {
        busy_sems[i] = semaphore(0, i == 0 ? Semaphore_Mode_BINARY : Semaphore_Mode_COUNTING_PRIORITY);
    }
    for (int i = 0; i < 2; i++) {
        busy_gates[i] = GateMutexPri_create(NULL, NULL);
        inside[i] = 0;
    }
    swi_low = swi("low", 1, busy_swi);
    swi_mid = swi("mid", 2, busy_swi);
    swi_high = swi("high", 15, busy_swi);
    for (Int number = 92; number < 100; number++) {
        hwi(number, busy_hwi);
    }
    for (int i = 0; i < 5; i++) {
        Task_Params params;

        Task_Params_init(&params);
        params.instance->name = names[i];
        params.priority = i < 2 ? 1 : 2 * i;
        params.arg0 = (UArg)i;
        (void)Task_create(busy_task, &params, NULL);
    }
    BIOS_start();
    return 0;
}

static uint64_t busy_run(uint64_t seed, sim_time_t piece)
{
    setUp();
    noise_init(&dice, seed, "busy");
    hash = 0xCBF29CE484222325u;
    observed = 0;
    overlaps = 0;
    kernel_observe(observe_hash, NULL);
    (void)timeline_at(0, busy_world, NULL);
    kernel_boot(busy_main, &busy_costs);
    for (sim_time_t end = piece; timeline_now() < 2 * SIM_S; end += piece) {
        TEST_ASSERT_TRUE_MESSAGE(kernel_run_until(end < 2 * SIM_S ? end : 2 * SIM_S), kernel_halt_reason());
    }
    return hash;
}

void test_a_busy_system_repeats_itself_and_does_not_depend_on_how_it_is_run(void)
{
    for (uint64_t seed = 1; seed <= 5; seed++) {
        uint64_t first = busy_run(seed, 2 * SIM_S);
        long first_observed = observed;

        TEST_ASSERT_GREATER_THAN(50000, first_observed);
        TEST_ASSERT_EQUAL_INT(0, overlaps);
        TEST_ASSERT_EQUAL_HEX64(first, busy_run(seed, 2 * SIM_S));
        TEST_ASSERT_EQUAL_HEX64(first, busy_run(seed, 333333));
        TEST_ASSERT_EQUAL_INT(first_observed, observed);
    }
    TEST_ASSERT_TRUE(busy_run(1, 2 * SIM_S) != busy_run(2, 2 * SIM_S));
}

/* ---- an independent look at the trace of the busy system ---- */

static struct {
    char name[8];
    sim_time_t used; /* processor time */
    long released, finished;
} accounts[24];
static int account_count;
static int running_account;
static sim_time_t running_since;
static int holders;

static int account_of(const char *name, int detail, bool is_hwi)
{
    char key[8];

    (void)snprintf(key, sizeof key, is_hwi ? "%.3s%d" : "%.6s", is_hwi ? "h" : name, detail);
    for (int i = 0; i < account_count; i++) {
        if (strcmp(accounts[i].name, key) == 0) {
            return i;
        }
    }
    (void)snprintf(accounts[account_count].name, sizeof accounts[0].name, "%s", key);
    return account_count++;
}

static void observe_accounts(void *context, sim_time_t when, kernel_event_t what, const kernel_job_t *job,
                             int detail)
{
    int account = account_of(job->name, job->number, strcmp(job->name, "hwi") == 0);

    (void)context;
    (void)detail;
    if (what == KERNEL_RELEASED) {
        accounts[account].released++;
    } else if (what == KERNEL_DISPATCHED) {
        holders += running_account >= 0;
        running_account = account;
        running_since = when;
    } else if (what == KERNEL_PREEMPTED || what == KERNEL_FINISHED || what == KERNEL_GATE_BLOCKED) {
        holders += running_account != account;
        accounts[account].used += when - running_since;
        accounts[account].finished += what == KERNEL_FINISHED;
        running_account = -1;
    }
}

/* At any time one job has the processor, and what Swis and Hwis used is their number of runs times their
 * cost. */
void test_processor_time_is_accounted_for_to_the_nanosecond(void)
{
    static const struct {
        const char *name;
        sim_time_t cost;
    } fixed[] = {{"low", 21 * SIM_US}, {"mid", 13 * SIM_US}, {"high", 7 * SIM_US}, {"h92", 11 * SIM_US},
                 {"h96", 25 * SIM_US}, {"h99", 3 * SIM_US},  {"h97", 0},           {"Clock", 4 * SIM_US}};

    setUp();
    memset(accounts, 0, sizeof accounts);
    account_count = 0;
    running_account = -1;
    holders = 0;
    noise_init(&dice, 99, "busy");
    kernel_observe(observe_accounts, NULL);
    (void)timeline_at(0, busy_world, NULL);
    kernel_boot(busy_main, &busy_costs);
    run_ms(2000);
    kernel_observe(NULL, NULL);
    TEST_ASSERT_EQUAL_INT(0, holders);
    for (size_t i = 0; i < sizeof fixed / sizeof fixed[0]; i++) {
        int account = account_of(fixed[i].name, 0, false);

        TEST_ASSERT_GREATER_THAN_MESSAGE(100, accounts[account].finished, fixed[i].name);
        TEST_ASSERT_INT64_WITHIN_MESSAGE((uint64_t)fixed[i].cost, accounts[account].finished * fixed[i].cost,
                                         accounts[account].used, fixed[i].name); /* one may be under way */
        TEST_ASSERT_INT_WITHIN_MESSAGE(1, accounts[account].released, accounts[account].finished,
                                       fixed[i].name);
    }
}
