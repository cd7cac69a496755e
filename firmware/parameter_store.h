/* Operator's parameters in the board's non-volatile storage. There are two copies; the newer good one is
 * valid. A save overwrites the other copy and reads it back. So one good copy exists even when the power
 * fails during a save. docs/operator.md tells why a copy can be refused. Context: main() or
 * TaskReceiveComm. */
#ifndef FIRMWARE_PARAMETER_STORE_H
#define FIRMWARE_PARAMETER_STORE_H

#include <stdint.h>

#include "control/parameters.h"

typedef enum {
    PARAMETER_STORE_DONE,
    PARAMETER_STORE_EMPTY,   /* nothing was stored yet */
    PARAMETER_STORE_DAMAGED, /* no copy is complete */
    PARAMETER_STORE_FOREIGN, /* the only complete copies are of a firmware with other parameters */
    PARAMETER_STORE_RANGE,   /* a stored value is outside today's limits */
    PARAMETER_STORE_FAULT    /* the written copy does not read back; the previous copy is unchanged */
} parameter_store_status_t;

typedef struct {
    parameter_store_status_t status;
    uint32_t generation;      /* DONE, RANGE: number of the copy; the first is 1 */
    parameter_id_t parameter; /* RANGE: the first parameter that was refused */
} parameter_store_result_t;

/* Loads the stored values into *parameters, which must already hold a valid set. Changes all values when
 * the status is DONE, else none. What an older firmware did not store becomes what vehicles flew with then,
 * parameters_set_older(). */
parameter_store_result_t parameter_store_load(parameters_t *parameters);

/* Saves the values, and the scanner's power-up rate, bits per second; 0: not known, a stored one is kept. On
 * the ground only: interrupts are disabled while the flash is busy (storage.h). */
parameter_store_result_t parameter_store_save(const parameters_t *parameters, uint32_t laser_rate);

/* The stored power-up rate of the scanner, one of SCIP's; 0: none was stored. */
uint32_t parameter_store_laser_rate(void);

#endif
