/* The world's figures that `--set plant.NAME=VALUE` reaches: the vehicle, its sensors, the floor, and what
 * goes wrong with them. Left alone, they are the plant description's, and nothing goes wrong. Several at once
 * combine. */
#ifndef SIM_SCENARIOS_PLANT_H
#define SIM_SCENARIOS_PLANT_H

#include <stdbool.h>
#include <stdio.h>

#include "sim/board.h"

typedef struct {
    board_config_t board;
    double ray_instant_s;
    double clock_ppm; /* of the scanner */
    double outage_start_s, outage_s;
    double restart_start_s; /* of the scanner */
    double radio_lost_start_s;
    double attitude_throttle;
} plant_t;

void plant_init(plant_t *plant, unsigned long seed);

/* name is "plant.NAME". */
bool plant_known(const char *name);
/* NULL: a number that the figure may take; else what is wrong. The name must be known. */
const char *plant_check(const char *name, const char *text);
void plant_set(plant_t *plant, const char *name, double value);
/* What board's fields follow from the figures. */
void plant_complete(plant_t *plant);

/* Names, units, what they are when nobody sets them, and meanings. */
void plant_print(FILE *out);

#endif
