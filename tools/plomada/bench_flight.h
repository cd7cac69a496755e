/* A scenario flown by a real board in the world of world.h. */
#ifndef TOOLS_PLOMADA_BENCH_FLIGHT_H
#define TOOLS_PLOMADA_BENCH_FLIGHT_H

#include <stdbool.h>
#include <stdio.h>

#include "sim/scenarios/scenarios.h"

#define BENCH_TROUBLES_MAX 12

typedef struct {
    bool started; /* the board had heights, and took every setting */
    bool interrupted;
    bool safe; /* at the end: on the ground, without the thrust to leave it */
    double last_pulse_us;
    bool radio_lost; /* whether it ended safe is not known */
    double lag_ms;   /* longest time that this PC was behind the wall clock in flight */
    metrics_t metrics;
    bool has_delay;
    double delay_ms, delay_most_ms; /* of the loop: world_delay_ms() */
    int trouble_count;
    char trouble[BENCH_TROUBLES_MAX][96]; /* each begins with its line: laser, imu, xbee or pin */
} bench_flight_t;

/* The 95 % value of the same way on the PC board in virtual time, ms: Laser_SWI 0.36, TaskReceiveLaser 1.1,
 * TaskControl 0.5 with their switches, half a period of the pulses 6.8, the pulse itself 1.5; before it 95 %
 * of the control period, where that is free-running. */
double bench_simulated_delay_ms(const scenario_t *scenario);

/* Waits up to `patience_s` until the board has heights; what is missing is added to *flight. */
bool bench_await_heights(double patience_s, bench_flight_t *flight);

/* Types the settings, flies, lands. progress: what is being done, or NULL. */
void bench_fly(const scenario_t *scenario, unsigned long seed, FILE *progress, bench_flight_t *flight);

/* A scenario's expectations, widened: by the most that each metric changed to either side, over five seeds in
 * virtual time, when the autopilot's delay was longer by what the loop took longer (95 % value), if that is 1
 * ms or more. Not while a world is open. Returns the added delay in ms. */
double bench_widen(const scenario_t *scenario, const bench_flight_t *flight, scenario_t *widened);

/* What the board counts of damaged frames of its scanner, in its answer to `#LASER`. */
unsigned long bench_damaged_frames(void);

/* What it counts of damaged frames of its IMU, in its answer to `#IMU`. */
unsigned long bench_refused_frames(void);

/* Metrics that are known without the board's memory. */
bool bench_can_judge(metric_t metric);

#endif
