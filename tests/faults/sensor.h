/* A second model of the URG-04LX, for the tests of the driver alone. Written from Hokuyo's page "SCIP2.0"
 * (C-42-03320B), from the digest of SCIP1.1 and from recordings of a real sensor of 2008; it shares no line
 * with sim/devices/urg04lx.c, and no belief with the driver:
 *
 *   - a recorded sensor answers a command of SCIP2.0 once a revolution, 84 to 115 ms later; in SCIP1.1 after
 *     8, 64 or 98 ms. One first answer took 380: docs/scip.md, "A late first answer", has what it may mean.
 *     Either the sensor hears what comes while it starts up, or its first answer is slow;
 *   - it powers up at the rate that it was told to store: 19200 as delivered;
 *   - at a wrong rate it hears what the levels on the wire give (uart.h), and that stays in its line;
 *   - the laser needs a revolution before the one that is measured;
 *   - it may stop by itself, without a word. */
#ifndef TESTS_FAULTS_SENSOR_H
#define TESTS_FAULTS_SENSOR_H

#include "uart.h"

typedef enum {
    ANSWERS_SOON,     /* 8 ms after the command, as in SCIP1.1 */
    ANSWERS_AT_TURN,  /* when the present revolution is over */
    ANSWERS_LATE,     /* 90 to 115 ms after the command */
    ANSWERS_HEARS,    /* so; what came in the last 381 ms of its boot is answered from the end of that on */
    ANSWERS_RECORDED, /* hears likewise; drawn from the recorded ones, those of SCIP1.1 and SCIP2.0 apart */
    ANSWERS_DRAWN,    /* 90 to 115 ms, and the first one after power-up 90 to 400 ms */
    ANSWERS_LATEST,   /* 90 to 115 ms, and the first one after power-up 381 ms */
    ANSWERS_COUNT
} answers_t;

typedef enum {
    STOP_RESET,
    STOP_QUIT,
    STOP_TIME,
    STOP_OTHER,
    STOP_COUNT
} stop_t; /* as after RS, QT, TM0, another MS */

typedef struct {
    uint32_t power_up_rate;
    ns_t boot, turn, phase;
    ns_t settles;  /* from the end of SS's reply to the new rate */
    uint32_t seed; /* of its answers' times */
    answers_t answers;
} sensor_config_t;

typedef struct sensor sensor_t;

/* from_host: its receiver is the sensor's; to_host: its sender. */
sensor_t *sensor_create(const sensor_config_t *config, uart_t *from_host, uart_t *to_host);
void sensor_destroy(sensor_t *sensor);
void sensor_power(sensor_t *sensor, bool on, ns_t now);
void sensor_stop(sensor_t *sensor, stop_t how, ns_t now);
/* Leaves it as another host would have: in SCIP2.0, at this rate. */
void sensor_leave_in_scip2(sensor_t *sensor, uint32_t rate, ns_t now);
/* An octet that its UART heard. */
void sensor_hears(sensor_t *sensor, unsigned octet, bool framing_error, ns_t now);
void sensor_run(sensor_t *sensor, ns_t now);
/* Before that time sensor_run() does nothing, unless it hears something first; NEVER. */
ns_t sensor_due(const sensor_t *sensor, ns_t now);
bool sensor_streams(const sensor_t *sensor);
unsigned sensor_distance_mm(unsigned step);

#endif
