#include "sim/timing/trace.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Task.h>

#include "sim/noise.h"
#include "unity.h"

static trace_t trace;
static FILE *out;
static char text[200000];
static GateMutexPri_Handle gate, other_gate;
static Semaphore_Handle due[3];
static Swi_Handle swi;

void setUp(void)
{
    timeline_reset();
    kernel_observe(NULL, NULL);
    out = tmpfile();
    trace_open(&trace, out);
}

void tearDown(void)
{
    kernel_observe(NULL, NULL);
    (void)fclose(out);
}

static void close_and_read(void)
{
    trace_close(&trace);
    rewind(out);
    text[fread(text, 1, sizeof text - 1, out)] = '\0';
}

static void assert_has(const char *line)
{
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, line), line);
}

static int count(const char *what)
{
    int found = 0;

    for (const char *at = strstr(text, what); at != NULL; at = strstr(at + 1, what)) {
        found++;
    }
    return found;
}

/* ---- a schedule computed by hand ---- */

static Void access_gate(UArg number, UArg unused)
{
    (void)unused;
    for (;;) {
        (void)Semaphore_pend(due[number], BIOS_WAIT_FOREVER);
        GateMutexPri_leave(gate, GateMutexPri_enter(gate));
    }
}

static Void quiet_swi(UArg unused0, UArg unused1)
{
    (void)unused0;
    (void)unused1;
    Semaphore_post(due[1]);
}

static Void post_hwi(UArg number)
{
    if (number == 1) {
        Swi_post(swi);
    } else {
        Semaphore_post(due[number]);
    }
}

static void create_task(const char *name, Int priority, UArg number, Task_FuncPtr function)
{
    Task_Params params;

    due[number] = Semaphore_create(0, NULL, NULL);
    Task_Params_init(&params);
    params.instance->name = name;
    params.priority = priority;
    params.arg0 = number;
    (void)Task_create(function, &params, NULL);
}

static void create_hwi(int interrupt, UArg number)
{
    Hwi_Params params;

    Hwi_Params_init(&params);
    params.arg = number;
    (void)Hwi_create(interrupt, post_hwi, &params, NULL);
}

static int schedule_main(void)
{
    GateMutexPri_Params gate_params;
    Swi_Params swi_params;

    GateMutexPri_Params_init(&gate_params);
    gate_params.instance->name = "server";
    gate = GateMutexPri_create(&gate_params, NULL);
    other_gate = GateMutexPri_create(NULL, NULL);
    create_task("low \"1\"", 1, 0, access_gate);
    create_task("high", 9, 1, access_gate);
    Swi_Params_init(&swi_params);
    swi_params.instance->name = "Swi";
    swi_params.priority = 2;
    swi = Swi_create(quiet_swi, &swi_params, NULL);
    create_hwi(96, 0);
    create_hwi(97, 1);
    BIOS_start();
    return 0;
}

static const kernel_cost_t jobs[] = {
    {"RX", 96, 10 * SIM_US}, {"TX", 97, 5 * SIM_US}, {"Swi", -1, 20 * SIM_US}};
static const kernel_costs_t costs = {jobs, sizeof jobs / sizeof jobs[0], 100 * SIM_US, 50 * SIM_US};

static void raise_interrupt(void *number)
{
    kernel_raise((int)(intptr_t)number);
}

static void run_schedule(void)
{
    kernel_boot(schedule_main, &costs);
    (void)kernel_run_until(50 * SIM_US);
    kernel_observe(trace_observe, &trace);
    (void)timeline_at(100 * SIM_US, raise_interrupt, (void *)(intptr_t)96);
    (void)timeline_at(200 * SIM_US, raise_interrupt, (void *)(intptr_t)97);
    (void)kernel_run_until(900 * SIM_US);
    kernel_observe(NULL, NULL);
    close_and_read();
}

/* 100 RX until 110; low switches until 160 and is in the gate, 40 of 100 done at 200. TX until 205, Swi until
 * 225, high switches until 275 and finds the gate held: low, at 9, 60 more until 335. High switches and
 * enters until 485. */
void test_the_schedule_is_written_as_it_happened(void)
{
    run_schedule();
    assert_has("{\"ph\": \"X\", \"pid\": 2, \"tid\": 96, \"name\": \"RX\", \"ts\": 100.000, \"dur\": 10.000, "
               "\"args\": {\"response_us\": 10.000, \"priority\": 96}}");
    assert_has(
        "{\"ph\": \"X\", \"pid\": 2, \"tid\": 1001, \"name\": \"Swi\", \"ts\": 205.000, \"dur\": 20.000, "
        "\"args\": {\"response_us\": 20.000, \"priority\": 2}}");
    assert_has(
        "{\"ph\": \"X\", \"pid\": 2, \"tid\": 2001, \"name\": \"high\", \"ts\": 225.000, \"dur\": 260.000, "
        "\"args\": {\"response_us\": 260.000, \"priority\": 9}}");
    assert_has("{\"ph\": \"X\", \"pid\": 2, \"tid\": 2001, \"name\": \"runs\", \"ts\": 225.000, \"dur\": "
               "50.000, \"args\": {}}");
    assert_has("{\"ph\": \"X\", \"pid\": 2, \"tid\": 2001, \"name\": \"waits for "
               "server\", \"ts\": 275.000, \"dur\": 60.000, \"args\": {}}");
    assert_has("{\"ph\": \"X\", \"pid\": 2, \"tid\": 2001, \"name\": \"runs\", \"ts\": 335.000, \"dur\": "
               "150.000, \"args\": {}}");
    assert_has("{\"ph\": \"X\", \"pid\": 1, \"tid\": 1, \"name\": \"low \\\"1\\\"\", \"ts\": 275.000, "
               "\"dur\": 60.000, "
               "\"args\": {\"priority\": 1}}");
    assert_has("{\"ph\": \"X\", \"pid\": 3, \"tid\": 1, \"name\": \"low \\\"1\\\"\", \"ts\": 160.000, "
               "\"dur\": 175.000, "
               "\"args\": {\"inherited_priority\": 9}}");
    assert_has(
        "{\"ph\": \"X\", \"pid\": 3, \"tid\": 1, \"name\": \"high\", \"ts\": 335.000, \"dur\": 150.000, "
        "\"args\": {\"inherited_priority\": 0}}");
    assert_has("{\"ph\": \"i\", \"pid\": 2, \"tid\": 2000, \"name\": \"priority "
               "9\", \"ts\": 275.000, \"s\": \"t\", \"args\": {}}");
    assert_has("{\"ph\": \"i\", \"pid\": 2, \"tid\": 2000, \"name\": \"priority "
               "1\", \"ts\": 335.000, \"s\": \"t\", \"args\": {}}");
    TEST_ASSERT_EQUAL_INT(8, count("\"pid\": 1, \"tid\": 1, \"name\"") - 1); /* and its label */
}

void test_tracks_are_named_with_kind_and_priority_and_sorted_by_precedence(void)
{
    run_schedule();
    assert_has("\"tid\": 96, \"name\": \"thread_name\", \"args\": {\"name\": \"Hwi 96 RX\"}");
    assert_has("\"tid\": 1001, \"name\": \"thread_name\", \"args\": {\"name\": \"Swi 2 Swi\"}");
    assert_has("\"tid\": 2001, \"name\": \"thread_name\", \"args\": {\"name\": \"Task 9 high\"}");
    assert_has("\"tid\": 2000, \"name\": \"thread_name\", \"args\": {\"name\": \"Task 1 low \\\"1\\\"\"}");
    assert_has("\"pid\": 3, \"tid\": 1, \"name\": \"thread_name\", \"args\": {\"name\": \"server\"}");
    assert_has("\"tid\": 96, \"name\": \"thread_sort_index\", \"args\": {\"sort_index\": 96}");
    assert_has("\"tid\": 1001, \"name\": \"thread_sort_index\", \"args\": {\"sort_index\": 998}");
    assert_has("\"tid\": 2001, \"name\": \"thread_sort_index\", \"args\": {\"sort_index\": 1991}");
    assert_has("\"tid\": 2000, \"name\": \"thread_sort_index\", \"args\": {\"sort_index\": 1999}");
}

void test_an_empty_trace_is_complete(void)
{
    static const char head[] = "{\n  \"displayTimeUnit\": \"ms\",\n  \"traceEvents\": [\n    {";

    close_and_read();
    TEST_ASSERT_EQUAL_STRING_LEN(head, text, sizeof head - 1);
    TEST_ASSERT_EQUAL_STRING("}\n  ]\n}\n", text + strlen(text) - 8);
}

/* ---- the wires ---- */

static void send(const char *octets)
{
    for (; *octets != '\0'; octets++) {
        timeline_move_to(timeline_now() + 40 * SIM_US);
        trace_laser_octet(&trace, (unsigned char)*octets, 4000.0);
    }
}

void test_frames_go_from_the_first_start_bit_to_the_last_stop_bit(void)
{
    timeline_move_to(1000 * SIM_US);
    send("MS\n99b\n\n");
    timeline_move_to(5000 * SIM_US);
    send("Q\n\n");
    send("half");
    close_and_read();
    assert_has(
        "{\"ph\": \"X\", \"pid\": 4, \"tid\": 1, \"name\": \"frame\", \"ts\": 1000.000, \"dur\": 320.000, "
        "\"args\": {\"octets\": 8}}");
    assert_has(
        "{\"ph\": \"X\", \"pid\": 4, \"tid\": 1, \"name\": \"frame\", \"ts\": 5000.000, \"dur\": 120.000, "
        "\"args\": {\"octets\": 3}}");
    TEST_ASSERT_EQUAL_INT(2, count("\"name\": \"frame\""));
}

void test_pulses_say_whether_they_differ_from_the_one_before(void)
{
    static const sim_time_t pulses[] = {1500 * SIM_US, 1500 * SIM_US, 1499 * SIM_US + 500};

    for (int i = 0; i < 3; i++) {
        timeline_move_to((i + 1) * 10000 * SIM_US);
        trace_pulse(&trace, pulses[i]);
    }
    close_and_read();
    assert_has(
        "\"name\": \"1500.0 us\", \"ts\": 8500.000, \"dur\": 1500.000, \"args\": {\"changed\": true}}");
    assert_has(
        "\"name\": \"1500.0 us\", \"ts\": 18500.000, \"dur\": 1500.000, \"args\": {\"changed\": false}}");
    assert_has(
        "\"name\": \"1499.5 us\", \"ts\": 28500.500, \"dur\": 1499.500, \"args\": {\"changed\": true}}");
}

void test_an_answer_is_an_instant_with_its_latency(void)
{
    timeline_move_to(3 * SIM_MS);
    trace_answer(&trace, 3 * SIM_MS - 1937400, 3042);
    close_and_read();
    assert_has("{\"ph\": \"i\", \"pid\": 4, \"tid\": 2, \"name\": \"compare "
               "3042\", \"ts\": 3000.000, \"s\": \"t\", \"args\": {\"after_scan_us\": 1937.400}}");
}

/* ---- a crowd, for check_trace.py ---- */

static noise_t dice;

static Void crowd_task(UArg number, UArg unused)
{
    (void)unused;
    for (;;) {
        (void)Semaphore_pend(due[number], 1 + (UInt32)(noise_bits(&dice) % 4));
        IArg key = GateMutexPri_enter(gate);

        if (noise_bits(&dice) % 2 == 0) {
            GateMutexPri_leave(other_gate, GateMutexPri_enter(other_gate));
        }
        GateMutexPri_leave(gate, key);
    }
}

static int crowd_main(void)
{
    static const char *const names[] = {"bottom", "middle", "top"};
    Swi_Params params;

    gate = GateMutexPri_create(NULL, NULL);
    other_gate = GateMutexPri_create(NULL, NULL);
    for (UArg i = 0; i < 3; i++) {
        create_task(names[i], 1 + 2 * (Int)i, i, crowd_task);
        create_hwi(96 + (int)i, i);
    }
    Swi_Params_init(&params);
    params.instance->name = "Swi";
    swi = Swi_create(quiet_swi, &params, NULL);
    BIOS_start();
    return 0;
}

static void crowd_world(void *unused)
{
    (void)unused;
    kernel_raise(96 + (int)(noise_bits(&dice) % 3));
    (void)timeline_after((sim_time_t)(noise_bits(&dice) % 1500000), crowd_world, NULL);
}

static const kernel_cost_t crowd_jobs[] = {
    {"RX", 96, 10 * SIM_US},      {"TX", 97, 5 * SIM_US},    {NULL, 98, 30 * SIM_US},
    {"Clock", 38, 15 * SIM_US},   {"Swi", -1, 100 * SIM_US}, {"bottom", -1, 200 * SIM_US},
    {"middle", -1, 150 * SIM_US}, {"top", -1, 80 * SIM_US},
};
static const kernel_costs_t crowd_costs = {crowd_jobs, sizeof crowd_jobs / sizeof crowd_jobs[0], 90 * SIM_US,
                                           20 * SIM_US};

void test_a_crowd_is_written_for_the_checker(void)
{
    FILE *file = fopen(SCRATCH "/crowd.json", "w");

    TEST_ASSERT_NOT_NULL(file);
    trace_open(&trace, file);
    noise_init(&dice, 4, "crowd");
    kernel_observe(trace_observe, &trace);
    (void)timeline_at(0, crowd_world, NULL);
    kernel_boot(crowd_main, &crowd_costs);
    TEST_ASSERT_TRUE_MESSAGE(kernel_run_until(2 * SIM_S), kernel_halt_reason());
    trace_close(&trace);
    TEST_ASSERT_EQUAL_INT(0, fclose(file));
}
