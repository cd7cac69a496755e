/* What the firmware's jobs cost: execution times of the seed's Annex IV, measured there on the chip. */
#ifndef SIM_COSTS_H
#define SIM_COSTS_H

#include "sim/ti/sysbios/kernel.h"

extern const kernel_costs_t costs_annex_iv;

#endif
