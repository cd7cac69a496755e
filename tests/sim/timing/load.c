/* A program that does nothing but cost what a table says, on the simulated kernel. Usage: load LIMITS < TABLE
 *
 * The table's first line is: access_ns switches_ns run_ns. Then a row for each job, its times in ns:
 * kind name priority period cost gates offset. gates: which of the three a task enters at the end of its job,
 * a bit for each. The rows are released from LOAD_START on, each at its offset, and every period; Clock is
 * the kernel's own. */
#include <stdlib.h>
#include <string.h>

#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Task.h>

#include "sim/timing/timing.h"

#define CLOCK_HWI 38
#define FIRST_HWI 90
#define GATES 3
#define ROWS_MAX 32
/* A tick of the kernel: the Clock interrupt falls on the critical instant. */
#define LOAD_START (10 * SIM_MS)

typedef struct {
    char kind[8], name[32];
    int priority;
    long long period, cost, offset;
    unsigned gates;
    /* What it is on the kernel. */
    int interrupt;
    int waiting; /* raised and not begun: the chip would lose what the analysis counts */
    Swi_Handle swi;
    Semaphore_Handle due;
} row_t;

static row_t rows[ROWS_MAX];
static int row_count;
static kernel_cost_t costs[ROWS_MAX];
static GateMutexPri_Handle gates[GATES];

static bool is_clock(const row_t *row)
{
    return strcmp(row->name, "Clock") == 0;
}

/* ---- the program ---- */

static Void load_hwi(UArg row)
{
    rows[row].waiting--;
    if (rows[row].waiting > 0) {
        kernel_raise(rows[row].interrupt);
    }
}

static Void load_swi(UArg unused0, UArg unused1)
{
    (void)unused0;
    (void)unused1;
}

static Void load_task(UArg row, UArg unused)
{
    (void)unused;
    for (;;) {
        (void)Semaphore_pend(rows[row].due, BIOS_WAIT_FOREVER);
        for (int i = 0; i < GATES; i++) {
            if ((rows[row].gates >> i & 1u) != 0) {
                GateMutexPri_leave(gates[i], GateMutexPri_enter(gates[i]));
            }
        }
    }
}

static void create_hwi(int at)
{
    Hwi_Params params;

    rows[at].interrupt = FIRST_HWI + at;
    Hwi_Params_init(&params);
    params.arg = (UArg)at;
    (void)Hwi_create(rows[at].interrupt, load_hwi, &params, NULL);
}

static void create_swi(int at)
{
    Swi_Params params;

    Swi_Params_init(&params);
    params.instance->name = rows[at].name;
    params.priority = (UInt)(14 - at); /* in the order of the table */
    rows[at].swi = Swi_create(load_swi, &params, NULL);
}

static void create_task(int at)
{
    Task_Params params;

    rows[at].due = Semaphore_create(0, NULL, NULL);
    Task_Params_init(&params);
    params.instance->name = rows[at].name;
    params.priority = rows[at].priority;
    params.arg0 = (UArg)at;
    (void)Task_create(load_task, &params, NULL);
}

static int load_main(void)
{
    for (int i = 0; i < GATES; i++) {
        gates[i] = GateMutexPri_create(NULL, NULL);
    }
    for (int at = 0; at < row_count; at++) {
        if (strcmp(rows[at].kind, "swi") == 0) {
            create_swi(at);
        } else if (strcmp(rows[at].kind, "task") == 0) {
            create_task(at);
        } else if (!is_clock(&rows[at])) {
            create_hwi(at);
        }
    }
    BIOS_start();
    return 0;
}

/* ---- the world ---- */

static void release(void *context)
{
    row_t *row = context;

    if (row->interrupt != 0) {
        row->waiting++;
        kernel_raise(row->interrupt);
    } else if (row->swi != NULL) {
        Swi_post(row->swi);
    } else {
        Semaphore_post(row->due);
    }
    (void)timeline_after(row->period, release, row);
}

static bool read_row(row_t *row)
{
    return scanf("%7s %31s %d %lld %lld %u %lld", row->kind, row->name, &row->priority, &row->period,
                 &row->cost, &row->gates, &row->offset) == 7;
}

static bool read_limits(const char *path, timing_limits_t *limits, int *limit_count)
{
    FILE *in = fopen(path, "r");

    *limit_count = in == NULL ? -1 : timing_read_limits(in, limits);
    if (in != NULL) {
        fclose(in);
    }
    return *limit_count > 0;
}

static bool run(const kernel_costs_t *prices, timing_t *timing, sim_time_t end)
{
    timeline_reset();
    kernel_observe(timing_observe, timing);
    kernel_boot(load_main, prices);
    for (int at = 0; at < row_count; at++) {
        if (!is_clock(&rows[at])) {
            (void)timeline_at(LOAD_START + rows[at].offset, release, &rows[at]);
        }
    }
    if (!kernel_run_until(LOAD_START + end)) {
        fprintf(stderr, "load: %s\n", kernel_halt_reason());
        return false;
    }
    timing_conclude(timing);
    return true;
}

int main(int argc, char **argv)
{
    static timing_limits_t limits[TIMING_JOBS_MAX];
    static timing_t timing;
    long long access, switches, end;
    int limit_count;

    if (argc != 2 || !read_limits(argv[1], limits, &limit_count) ||
        scanf("%lld %lld %lld", &access, &switches, &end) != 3) {
        fprintf(stderr, "usage: load LIMITS < TABLE\n");
        return 2;
    }
    while (row_count < ROWS_MAX && read_row(&rows[row_count])) {
        const row_t *row = &rows[row_count];
        const int interrupt = is_clock(row) ? CLOCK_HWI : FIRST_HWI + row_count;

        costs[row_count] = (kernel_cost_t){row->name, strcmp(row->kind, "hwi") == 0 ? interrupt : -1,
                                           row->cost};
        row_count++;
    }
    timing_init(&timing, limits, limit_count);
    if (!run(&(kernel_costs_t){costs, row_count, access, switches}, &timing, end)) {
        return 2;
    }
    timing_print(&timing, stdout);
    return timing_print_broken(&timing, stdout) == 0 ? 0 : 1;
}
