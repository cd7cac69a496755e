/* The operator's parameters in the board's storage: two copies, of which the newer good one counts. A copy
 * is written over the other one and read back, so that one good copy is there whenever the power fails. main() or
 * TaskReceiveComm. docs/operator.md has what refuses a copy. */
#ifndef FIRMWARE_PARAMETER_STORE_H
#define FIRMWARE_PARAMETER_STORE_H

#include <stdint.h>

#include "control/parameters.h"

typedef enum {
    PARAMETER_STORE_DONE,
    PARAMETER_STORE_EMPTY,      /* nothing was ever stored */
    PARAMETER_STORE_DAMAGED,    /* no copy is whole */
    PARAMETER_STORE_FOREIGN,    /* the only whole copies are of a firmware with other parameters */
    PARAMETER_STORE_RANGE,      /* a stored value is outside today's limits */
    PARAMETER_STORE_FAULT       /* what was written does not read back; the copy before is untouched */
} parameter_store_status_t;

typedef struct {
    parameter_store_status_t status;
    uint32_t generation;        /* DONE, RANGE: of the copy; the first is 1 */
    parameter_id_t parameter;   /* RANGE: the first that is refused */
} parameter_store_result_t;

/* Puts the stored values into *parameters, which already holds a set: all of them, or none unless DONE. */
parameter_store_result_t parameter_store_load(parameters_t *parameters);

/* Stores the values. Interrupts are off while the flash is busy (storage.h): on the ground only. */
parameter_store_result_t parameter_store_save(const parameters_t *parameters);

#endif
