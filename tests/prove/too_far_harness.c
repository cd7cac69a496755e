#include "prove.h"

typedef struct {
    uint16_t cells[4];
    uint16_t behind[4];
} pair_t;

void fill(pair_t *pair, uint16_t index);

void one_too_far(void)
{
    pair_t pair;
    uint16_t index = nondet_cell();

    ASSUME(index <= 4U);
    fill(&pair, index);
}
