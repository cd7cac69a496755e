/* Where the firmware stops for good, in flight: whatever stopped it, and wherever, the throttle is idle at
 * once and stays so until the watchdog resets the chip. */
#include <stdio.h>
#include <string.h>

#include <ti/sysbios/knl/Semaphore.h>
#include <xdc/runtime/System.h>

#include "child.h"
#include "firmware/probe.h"
#include "sim/ti/driverlib/chip.h"
#include "unity.h"

#define IDLE_COMPARE 4166U
#define IDLE_PULSE_US 1999.68
#define PULSE (14 * SIM_MS)
#define WATCHDOG \
    (600 * SIM_MS) /* it bites 0.84 s after the last service, which may be a cycle of 150 ms ago */

typedef void (*cause_t)(void);

/* In which job, at which of its events, it happens; no job: in an interrupt. */
typedef struct {
    cause_t cause;
    const char *job;
    kernel_event_t event;
    const char *expected;
} order_t;

typedef struct {
    uint32_t compare_before, compare_after, least_compare;
    double pulse_us, height_m;
    char reason[200];
} seen_t;

static const order_t *order;
static bool due;

void setUp(void) {}
void tearDown(void) {}

static void fail_an_assert(void)
{
    System_abort("as a failed assert would");
}

static void leave(void)
{
    System_exit(3);
}

static void create_in_an_interrupt(void)
{
    (void)Semaphore_create(0, NULL, NULL);
}

static void observe(void *unused, sim_time_t when, kernel_event_t event, const kernel_job_t *job, int detail)
{
    (void)unused;
    (void)when;
    (void)detail;
    if (due && event == order->event && strcmp(job->name, order->job) == 0) {
        due = false;
        order->cause();
    }
}

static void interrupt(void *unused)
{
    (void)unused;
    order->cause();
}

static void fly(void)
{
    static const char lines[] = "#LAW EST\n#SETR 0.6\n";
    const board_config_t config = board_config(2);

    board_power_on(&config, NULL, NULL);
    kernel_run_until(13 * SIM_S);
    board_type(lines, strlen(lines));
    kernel_run_until(20 * SIM_S);
}

static void fly_and_stop(void *argument, void *result)
{
    seen_t *seen = result;

    order = argument;
    kernel_observe(observe, NULL);
    fly();
    seen->compare_before = chip_register("EPWM2.CMPA");
    seen->height_m = quadrotor_state(board_quadrotor())->height_m;
    due = order->job != NULL;
    if (!due) {
        (void)timeline_after(SIM_MS, interrupt, NULL);
    }
    while (kernel_run_until(timeline_now() + SIM_MS) && timeline_now() < 25 * SIM_S) {
    }
    snprintf(seen->reason, sizeof seen->reason, "%s",
             kernel_halt_reason() != NULL ? kernel_halt_reason() : "it went on");
    seen->compare_after = seen->least_compare = chip_register("EPWM2.CMPA");
    for (const sim_time_t end = timeline_now() + WATCHDOG; timeline_now() < end;) {
        (void)kernel_run_until(timeline_now() + PULSE);
        if (chip_register("EPWM2.CMPA") < seen->least_compare) {
            seen->least_compare = chip_register("EPWM2.CMPA");
        }
    }
    seen->pulse_us = board_pulse_us();
}

static void stops_safely(cause_t cause, const char *job, kernel_event_t event, const char *expected)
{
    order_t what = {cause, job, event, expected};
    seen_t seen = {0};

    child_run(fly_and_stop, &what, &seen, sizeof seen);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(seen.reason, expected), seen.reason);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 0.6, seen.height_m);
    TEST_ASSERT_UINT32_WITHIN_MESSAGE(500, 2900, seen.compare_before, "it was not flying");
    TEST_ASSERT_EQUAL_UINT32(IDLE_COMPARE, seen.compare_after);
    TEST_ASSERT_EQUAL_UINT32(IDLE_COMPARE, seen.least_compare);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, IDLE_PULSE_US, seen.pulse_us);
}

void test_a_failed_assert_in_an_interrupt(void)
{
    stops_safely(fail_an_assert, NULL, KERNEL_RELEASED, "as a failed assert would");
}

void test_a_failed_assert_in_each_task(void)
{
    stops_safely(fail_an_assert, "TaskIMU", KERNEL_GATE_ENTERED, "as a failed assert would");
    stops_safely(fail_an_assert, "TaskReceiveLaser", KERNEL_GATE_ENTERED, "as a failed assert would");
    stops_safely(fail_an_assert, "TaskControl", KERNEL_GATE_ENTERED, "as a failed assert would");
    stops_safely(fail_an_assert, "TaskControl", KERNEL_GATE_LEFT, "as a failed assert would");
    stops_safely(fail_an_assert, "TaskSendLaser", KERNEL_GATE_ENTERED, "as a failed assert would");
    stops_safely(fail_an_assert, "TaskSendComm", KERNEL_GATE_ENTERED, "as a failed assert would");
}

void test_an_exit(void)
{
    stops_safely(leave, NULL, KERNEL_RELEASED, "System_exit: 3");
    stops_safely(leave, "TaskControl", KERNEL_GATE_LEFT, "System_exit: 3");
}

void test_a_broken_rule_of_the_kernel(void)
{
    stops_safely(create_in_an_interrupt, NULL, KERNEL_RELEASED, "not from a Hwi or Swi");
}
