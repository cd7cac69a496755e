/* The items of `plomada accept`: what each does to the board in the world of world.h, and what it found. */
#ifndef TOOLS_PLOMADA_ACCEPT_H
#define TOOLS_PLOMADA_ACCEPT_H

#include <stdbool.h>
#include <stddef.h>

#include "lines.h"

typedef enum { ACCEPT_OPEN, ACCEPT_PASS, ACCEPT_FAIL, ACCEPT_SKIP } accept_verdict_t;

typedef struct {
    lines_t lines;
    const char *power; /* command that takes the board's power away and gives it back, NULL: asks */
    bool ask;          /* somebody is there */
    double flight_s;
} accept_means_t;

#define ACCEPT_DETAIL_MAX 320

typedef struct {
    const char *name, *title;
    bool needs_radio;
    accept_verdict_t (*run)(const accept_means_t *means, char *detail);
} accept_item_t;

extern const accept_item_t accept_items[];
extern const int accept_item_count;

#endif
