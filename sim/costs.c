#include "sim/costs.h"

#include <math.h>

#define US(x) ((sim_time_t)((x)*1000.0))

static const kernel_cost_t jobs[] = {
    {"Clock", 38, US(15)},
    {"SCIA_RX", 96, US(2.4)},
    {"SCIA_TX", 97, US(2)},
    {"SCIB_RX", 98, US(2.4)},
    {"SCIB_TX", 99, US(2)},
    {"SCIC_RX", 92, US(2.4)},
    {"SCIC_TX", 93, US(2)},
    {"Clock_swi", -1, US(7.2)}, /* three UARTs looked at, each as by a receive interrupt */
    {"IMU_SWI", -1, US(81)},
    {"Laser_SWI", -1, US(302)},
    {"XBee_SWI", -1, US(124)},
    {"TaskIMU", -1, US(160)},
    {"TaskReceiveLaser", -1, US(1020)},
    {"TaskControl", -1, US(400)},
    {"TaskSendLaser", -1, US(6.8)},
    {"TaskSendComm", -1, US(1000)},
    {"TaskReceiveComm", -1, US(830)},
};

const kernel_costs_t costs_annex_iv = {
    .jobs = jobs,
    .job_count = sizeof jobs / sizeof jobs[0],
    .gate_access = US(9.3),
    .switches = US(57),
};

static sim_time_t stretch(sim_time_t cost, double factor)
{
    return (sim_time_t)llround((double)cost * factor);
}

const kernel_costs_t *costs_stretch(costs_stretched_t *stretched, const kernel_costs_t *costs, double factor)
{
    for (int i = 0; i < costs->job_count; i++) {
        stretched->jobs[i] = costs->jobs[i];
        stretched->jobs[i].job = stretch(costs->jobs[i].job, factor);
    }
    stretched->costs = (kernel_costs_t){
        .jobs = stretched->jobs,
        .job_count = costs->job_count,
        .gate_access = stretch(costs->gate_access, factor),
        .switches = stretch(costs->switches, factor),
    };
    return &stretched->costs;
}
