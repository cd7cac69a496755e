/* What the firmware's jobs cost: execution times of the seed's Annex IV, measured there on the chip; of the
 * tick's Swi, which the seed had not, by analogy. */
#ifndef SIM_COSTS_H
#define SIM_COSTS_H

#include "sim/ti/sysbios/kernel.h"

#define COSTS_JOBS_MAX 32

extern const kernel_costs_t costs_annex_iv;

/* Every cost times `factor` (> 0), context switches and gate accesses included, to the nearest ns. The result
 * lies in *stretched, which must outlive the run. costs: at most COSTS_JOBS_MAX jobs, not itself in
 * *stretched. */
typedef struct {
    kernel_costs_t costs;
    kernel_cost_t jobs[COSTS_JOBS_MAX];
} costs_stretched_t;
const kernel_costs_t *costs_stretch(costs_stretched_t *stretched, const kernel_costs_t *costs, double factor);

#endif
