/* Layout of one stored copy of the parameters, in 16-bit cells. Pure; any context.
 *
 *   cell 0       504CH
 *   cell 1       version of this layout, PARAMETER_IMAGE_VERSION
 *   cell 2       number of values n, 1..PARAMETER_IMAGE_VALUES_MAX
 *   cells 3, 4   names: identifies the list of values, parameter_image_name()
 *   cells 5, 6   generation
 *   cells 7 ...  n values of two cells, each the bit pattern of an IEEE 754 single
 *   two cells    CRC-32 of the cells before
 *   the rest     FFFFH, up to a multiple of PARAMETER_IMAGE_BLOCK cells
 *
 * The low cell of a 32-bit number comes first. The CRC-32 has the polynomial 04C11DB7H, reflected, and
 * FFFFFFFFH before and after; the low octet of a cell is processed first. */
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
    uint32_t generation; /* +1 with every copy, wraps */
    uint16_t count;
    float values[PARAMETER_IMAGE_VALUES_MAX];
} parameter_image_t;

typedef enum {
    PARAMETER_IMAGE_GOOD,
    PARAMETER_IMAGE_NONE, /* erased: nothing was ever stored there */
    PARAMETER_IMAGE_VERSION_UNKNOWN,
    PARAMETER_IMAGE_DAMAGED /* any other fault, for example an incomplete copy */
} parameter_image_status_t;

/* Writes an image as whole blocks. image->count: 1..PARAMETER_IMAGE_VALUES_MAX. Returns the number of cells.
 */
uint16_t parameter_image_write(uint16_t cells[PARAMETER_IMAGE_CELLS_MAX], const parameter_image_t *image);

/* Reads an image from PARAMETER_IMAGE_CELLS_MAX cells with any content. Writes *image only when the result is
 * PARAMETER_IMAGE_GOOD. Does not check the values: they may be NaN or outside their limits. */
parameter_image_status_t parameter_image_read(parameter_image_t *image,
                                              const uint16_t cells[PARAMETER_IMAGE_CELLS_MAX]);

/* Adds one zero-terminated name to `names`, which starts at 0, and returns the result. Another list of names,
 * or another order, gives another result. */
uint32_t parameter_image_name(uint32_t names, const char *name);

/* True when `generation` is later than `than`. They must be less than 2^31 apart. */
bool parameter_image_newer(uint32_t generation, uint32_t than);

#endif
