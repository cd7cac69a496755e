/* Any cells are read, any set is written. */
#include "drivers/parameter_image.h"

#include "prove.h"

void any_cells_are_read(void)
{
    uint16_t cells[PARAMETER_IMAGE_CELLS_MAX];
    parameter_image_t image;

    if (parameter_image_read(&image, cells) == PARAMETER_IMAGE_GOOD) {
        PROVE(image.count >= 1U && image.count <= PARAMETER_IMAGE_VALUES_MAX, "the values fit");
    }
}

void any_set_is_written(void)
{
    uint16_t cells[PARAMETER_IMAGE_CELLS_MAX];
    parameter_image_t image;
    uint16_t used;

    ASSUME(image.count >= 1U && image.count <= PARAMETER_IMAGE_VALUES_MAX);
    used = parameter_image_write(cells, &image);
    PROVE(used <= PARAMETER_IMAGE_CELLS_MAX && used % PARAMETER_IMAGE_BLOCK == 0U, "whole blocks that fit");
}
