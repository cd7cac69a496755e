#include "sim/costs.h"

#include <string.h>

#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

/* Annex IV, Figura A4.1, in ns; interrupt numbers are those of the chip (timer 0, SCIC, SCIA, SCIB).
 * Clock_swi: two receive interrupts. */
void test_the_costs_are_annex_ivs(void)
{
    static const kernel_cost_t annex[] = {
        {"Clock", 38, 15000},
        {"SCIA_RX", 96, 2400},
        {"SCIA_TX", 97, 2000},
        {"SCIB_RX", 98, 2400},
        {"SCIB_TX", 99, 2000},
        {"SCIC_RX", 92, 2400},
        {"SCIC_TX", 93, 2000},
        {"Clock_swi", -1, 7200},
        {"IMU_SWI", -1, 81000},
        {"Laser_SWI", -1, 302000},
        {"XBee_SWI", -1, 124000},
        {"TaskIMU", -1, 160000},
        {"TaskReceiveLaser", -1, 1020000},
        {"TaskControl", -1, 400000},
        {"TaskSendLaser", -1, 6800},
        {"TaskSendComm", -1, 1000000},
        {"TaskReceiveComm", -1, 830000},
    };

    TEST_ASSERT_EQUAL_INT(sizeof annex / sizeof annex[0], costs_annex_iv.job_count);
    for (int i = 0; i < costs_annex_iv.job_count; i++) {
        TEST_ASSERT_EQUAL_STRING(annex[i].name, costs_annex_iv.jobs[i].name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(annex[i].interrupt, costs_annex_iv.jobs[i].interrupt, annex[i].name);
        TEST_ASSERT_EQUAL_INT64_MESSAGE(annex[i].job, costs_annex_iv.jobs[i].job, annex[i].name);
    }
    TEST_ASSERT_EQUAL_INT64(9300, costs_annex_iv.gate_access);
    TEST_ASSERT_EQUAL_INT64(57000, costs_annex_iv.switches);
}

void test_stretching_takes_every_cost_and_leaves_the_original(void)
{
    static costs_stretched_t stretched;
    const kernel_costs_t *costs = costs_stretch(&stretched, &costs_annex_iv, 2.5);

    TEST_ASSERT_EQUAL_INT(costs_annex_iv.job_count, costs->job_count);
    for (int i = 0; i < costs->job_count; i++) {
        TEST_ASSERT_EQUAL_STRING(costs_annex_iv.jobs[i].name, costs->jobs[i].name);
        TEST_ASSERT_EQUAL_INT(costs_annex_iv.jobs[i].interrupt, costs->jobs[i].interrupt);
        TEST_ASSERT_EQUAL_INT64(costs_annex_iv.jobs[i].job * 5 / 2, costs->jobs[i].job);
    }
    TEST_ASSERT_EQUAL_INT64(23250, costs->gate_access);
    TEST_ASSERT_EQUAL_INT64(142500, costs->switches);
    TEST_ASSERT_EQUAL_INT64(9300, costs_annex_iv.gate_access);
}

void test_stretched_costs_are_rounded_to_the_nearest_ns(void)
{
    static costs_stretched_t stretched;
    static const kernel_cost_t jobs[] = {{"a", -1, 10}, {"b", -1, 0}};
    static const kernel_costs_t costs = {jobs, sizeof jobs / sizeof jobs[0], 14, 15};
    const kernel_costs_t *result = costs_stretch(&stretched, &costs, 0.1);

    TEST_ASSERT_EQUAL_INT64(1, result->jobs[0].job);
    TEST_ASSERT_EQUAL_INT64(0, result->jobs[1].job);
    TEST_ASSERT_EQUAL_INT64(1, result->gate_access);
    TEST_ASSERT_EQUAL_INT64(2, result->switches);
}
