/* The world's figures that `--set plant.NAME=VALUE` reaches: the vehicle, its sensors, the floor, and what
 * goes wrong with them. Left alone, they are the plant description's, and nothing goes wrong. Several at once
 * combine. */
#ifndef SIM_SCENARIOS_PLANT_H
#define SIM_SCENARIOS_PLANT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "sim/board.h"
#include "sim/scenarios/seed_course.h"

typedef struct {
    board_config_t board;
    double ray_instant_s;
    double clock_ppm; /* of the scanner */
    double scanner_answers, scanner_boot_s, scan_late_s;
    double imu_period_s, imu_age_s;
    double outage_start_s, outage_s;
    double restart_start_s; /* of the scanner */
    double radio_lost_start_s;
    double pin_stuck; /* of the selector, board_pin_t; < 0: honest */
    double pin_stuck_start_s, pin_stuck_length_s;
    double attitude_throttle;
    seed_course_t ground; /* of a flight that has no place of its own */
    place_t place;        /* it, laid; board points here */
    course_t course;
} plant_t;

void plant_init(plant_t *plant, unsigned long seed);

/* name is "plant.NAME". */
bool plant_known(const char *name);
/* NULL: a number that the figure may take; else what is wrong. The name must be known. */
const char *plant_check(const char *name, const char *text);
void plant_set(plant_t *plant, const char *name, double value);
/* What board's fields follow from the figures: its place and course are in *plant, which must outlive it. */
void plant_complete(plant_t *plant);

/* Plans what goes wrong at its scenario time, counted from origin: the scanner's line mute, its power lost
 * for a moment, the radio out of reach, the selector's pin stuck. Of these only the one whose figures `name`
 * belongs to; NULL: all. */
void plant_plan(const plant_t *plant, const char *name, sim_time_t origin);

/* Names, units, what they are when nobody sets them, and meanings. */
void plant_print(FILE *out);

/* One row of that table, with the figure's limits and what it is now. false: behind the last row. */
typedef struct {
    const char *name, *unit, *meaning; /* the name without "plant." */
    double least, most, value;
} plant_figure_t;
bool plant_figure(const plant_t *plant, size_t row, plant_figure_t *figure);

#endif
