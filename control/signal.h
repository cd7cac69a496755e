/* How good the latest scan was, mirror by mirror. For people: nothing is decided by it. */
#ifndef CONTROL_SIGNAL_H
#define CONTROL_SIGNAL_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"

typedef struct {
    bool looked;        /* LAYOUT has this mirror; false: the other members say nothing */
    bool told;          /* enough good rays for a slant; false: the members below say nothing */
    uint16_t good_rays; /* points of the scan that have a distance, whether it told or not */
    float slant_mm;     /* when it told: their mean */
    float spread_mm;    /* largest minus smallest of them */
    uint32_t age_us;    /* of its rays, when the scan had arrived */
} beam_signal_t;

typedef struct {
    uint32_t scans; /* so far, with a height or without one; 0: none yet */
    uint32_t arrival_us;
    beam_signal_t beams[MIRROR_COUNT]; /* by mirror_t */
} scan_signal_t;

#endif
