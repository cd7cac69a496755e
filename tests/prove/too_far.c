/* The fault that prove.py must see before it says anything. */
#include "prove.h"

typedef struct {
    uint16_t cells[4];
    uint16_t behind[4];
} pair_t;

void fill(pair_t *pair, uint16_t index);

void fill(pair_t *pair, uint16_t index)
{
    pair->cells[index] = 1U;
}
