/* A set of values as it is stored: the layout of one copy in 16-bit cells. Pure.
 *
 *   cell 0       504CH
 *   cell 1       version of this layout, PARAMETER_IMAGE_VERSION
 *   cell 2       number of values n, 1..PARAMETER_IMAGE_VALUES_MAX
 *   cells 3, 4   names: which values these are, parameter_image_name()
 *   cells 5, 6   generation
 *   cells 7 ...  n values of two cells, each the bit pattern of an IEEE 754 single
 *   two cells    CRC-32 (04C11DB7H reflected, FFFFFFFFH before and after) of the cells before, low octet of a
 * cell first the rest     FFFFH, up to a multiple of PARAMETER_IMAGE_BLOCK cells
 *
 * Of each 32-bit number the low cell comes first. */
#ifndef DRIVERS_PARAMETER_IMAGE_H
#define DRIVERS_PARAMETER_IMAGE_H

#include <stdbool.h>
#include <stdint.h>

#define PARAMETER_IMAGE_VERSION 1U
#define PARAMETER_IMAGE_VALUES_MAX 64U
#define PARAMETER_IMAGE_BLOCK 8U
#define PARAMETER_IMAGE_CELLS_MAX 144U /* 7 + 2 * 64 + 2, whole blocks */

typedef struct {
    uint32_t names;
    uint32_t generation; /* +1 from copy to copy, wraps */
    uint16_t count;
    float values[PARAMETER_IMAGE_VALUES_MAX];
} parameter_image_t;

typedef enum {
    PARAMETER_IMAGE_GOOD,
    PARAMETER_IMAGE_NONE, /* erased: nothing was ever stored there */
    PARAMETER_IMAGE_VERSION_UNKNOWN,
    PARAMETER_IMAGE_DAMAGED /* anything else, a copy that was cut off included */
} parameter_image_status_t;

/* image->count: 1..PARAMETER_IMAGE_VALUES_MAX. Fills whole blocks and returns how many cells they are. */
uint16_t parameter_image_write(uint16_t cells[PARAMETER_IMAGE_CELLS_MAX], const parameter_image_t *image);

/* Any PARAMETER_IMAGE_CELLS_MAX cells. *image is written only when the result is GOOD; what the values mean
 * and whether they are allowed is not looked at (they may be NaN). */
parameter_image_status_t parameter_image_read(parameter_image_t *image,
                                              const uint16_t cells[PARAMETER_IMAGE_CELLS_MAX]);

/* Folds one more zero-terminated name into `names`, which starts at 0. The result tells one list of names, in
 * its order, from another. */
uint32_t parameter_image_name(uint32_t names, const char *name);

/* True when a generation came after the other; they are less than 2^31 apart. */
bool parameter_image_newer(uint32_t generation, uint32_t than);

#endif
