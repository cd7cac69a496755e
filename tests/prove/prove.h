/* Values that CBMC chooses: a proof holds for all of them. */
#ifndef PROVE_H
#define PROVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef char size_t_has_32_bits[sizeof(size_t) == 4 ? 1 : -1];

bool nondet_bool(void);
float nondet_float(void);
size_t nondet_size(void);
uint16_t nondet_cell(void);

#define ASSUME(condition) __CPROVER_assume(condition)
#define PROVE(condition, text) __CPROVER_assert(condition, text)

/* The index of a member array: see prove.py. */
static inline size_t prove_at(size_t index, size_t elements)
{
    PROVE(index < elements, "within its own array");
    return index;
}

#endif
