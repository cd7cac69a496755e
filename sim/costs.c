#include "sim/costs.h"

#include <stddef.h>

#define US(x) ((sim_time_t)((x) * 1000.0))

static const kernel_cost_t jobs[] = {
    {NULL, 38, US(15)}, /* Clock */
    {NULL, 96, US(2.4)}, {NULL, 97, US(2)}, /* SCIA receive, transmit */
    {NULL, 98, US(2.4)}, {NULL, 99, US(2)}, /* SCIB */
    {NULL, 92, US(2.4)}, {NULL, 93, US(2)}, /* SCIC */
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
