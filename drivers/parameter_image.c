#include "drivers/parameter_image.h"

#include <stddef.h>

/* "PL"; neither erased nor programmed to zero, so a blank sector is not taken for a copy. */
#define MARK 0x504CU
/* A cell of flash that was erased and not programmed since. */
#define ERASED 0xFFFFU
#define CRC_START UINT32_C(0xFFFFFFFF)
#define CRC_POLYNOMIAL UINT32_C(0xEDB88320) /* 04C11DB7H reflected */

enum { CELL_MARK, CELL_VERSION, CELL_COUNT, CELL_NAMES, CELL_GENERATION = 5, CELL_VALUES = 7 };

typedef union {
    float number;
    uint32_t bits;
} pattern_t;

/* Bit by bit: a table would cost 1 KiB of flash, and a copy is checked at power-up and #SAVE alone. */
static uint32_t crc_octet(uint32_t crc, uint16_t octet)
{

    crc ^= (uint32_t)(octet & 0xFFU);
    for (uint16_t bit = 0U; bit < 8U; ++bit) {
        crc = (crc >> 1) ^ (((crc & 1U) != 0U) ? CRC_POLYNOMIAL : UINT32_C(0));
    }
    return crc;
}

/* A cell counts as two octets, the low one first, so that a tool on a PC gets the same from the bytes. */
static uint32_t crc_of(const uint16_t *cells, uint16_t count)
{
    uint32_t crc = CRC_START;

    for (uint16_t i = 0U; i < count; ++i) {
        crc = crc_octet(crc, cells[i]);
        crc = crc_octet(crc, (uint16_t)(cells[i] >> 8));
    }
    return crc ^ CRC_START;
}

static void put(uint16_t *cells, uint32_t number)
{
    cells[0] = (uint16_t)(number & 0xFFFFU);
    cells[1] = (uint16_t)(number >> 16);
}

static uint32_t get(const uint16_t *cells)
{
    return (uint32_t)cells[0] | ((uint32_t)cells[1] << 16);
}

/* Cells under the sum, which is also where it lies; of value i, where that value lies. */
static uint16_t checked_cells(uint16_t count)
{
    return (uint16_t)(CELL_VALUES + 2U * count);
}

uint16_t parameter_image_write(uint16_t cells[PARAMETER_IMAGE_CELLS_MAX], const parameter_image_t *image)
{
    const uint16_t checked = checked_cells(image->count);
    uint16_t used = (uint16_t)(checked + 2U);

    cells[CELL_MARK] = MARK;
    cells[CELL_VERSION] = PARAMETER_IMAGE_VERSION;
    cells[CELL_COUNT] = image->count;
    put(&cells[CELL_NAMES], image->names);
    put(&cells[CELL_GENERATION], image->generation);
    /* Bit patterns, not numbers: a NaN or a -0 comes back as it was. */
    for (uint16_t i = image->count; i-- > 0U;) {
        pattern_t pattern;

        pattern.number = image->values[i];
        put(&cells[checked_cells(i)], pattern.bits);
    }
    put(&cells[checked], crc_of(cells, checked));
    for (; used % PARAMETER_IMAGE_BLOCK != 0U; ++used) {
        cells[used] = ERASED;
    }
    return used;
}

/* A power failure while the sector is erased or programmed leaves some cells ERASED: that is damage, and only
 * a sector without any head is none at all. The count is looked at before it says where the sum lies. */
static parameter_image_status_t look(const uint16_t *cells)
{
    const uint16_t count = cells[CELL_COUNT];

    if (cells[CELL_MARK] == ERASED && cells[CELL_VERSION] == ERASED && count == ERASED) {
        return PARAMETER_IMAGE_NONE;
    }
    if (cells[CELL_MARK] == MARK && cells[CELL_VERSION] != PARAMETER_IMAGE_VERSION &&
        cells[CELL_VERSION] != ERASED) {
        return PARAMETER_IMAGE_VERSION_UNKNOWN;
    }
    if (cells[CELL_MARK] != MARK || cells[CELL_VERSION] == ERASED || count == 0U ||
        count > PARAMETER_IMAGE_VALUES_MAX) {
        return PARAMETER_IMAGE_DAMAGED;
    }
    return (get(&cells[checked_cells(count)]) == crc_of(cells, checked_cells(count)))
               ? PARAMETER_IMAGE_GOOD
               : PARAMETER_IMAGE_DAMAGED;
}

parameter_image_status_t parameter_image_read(parameter_image_t *image,
                                              const uint16_t cells[PARAMETER_IMAGE_CELLS_MAX])
{
    const parameter_image_status_t status = look(cells);

    if (status != PARAMETER_IMAGE_GOOD) {
        return status;
    }
    image->names = get(&cells[CELL_NAMES]);
    image->generation = get(&cells[CELL_GENERATION]);
    image->count = cells[CELL_COUNT];
    for (uint16_t i = image->count; i-- > 0U;) {
        pattern_t pattern;

        pattern.bits = get(&cells[checked_cells(i)]);
        image->values[i] = pattern.number;
    }
    return status;
}

uint32_t parameter_image_name(uint32_t names, const char *name)
{

    for (size_t i = 0U; name[i] != '\0'; ++i) {
        names = crc_octet(names, (uint16_t)name[i]);
    }
    /* Between two names, where no character can stand: "AB","C" is not "A","BC". */
    return crc_octet(names, ERASED);
}

bool parameter_image_newer(uint32_t generation, uint32_t than)
{
    /* Wraps: half of all numbers are ahead. */
    const uint32_t ahead = generation - than;

    return ahead != 0U && ahead < UINT32_C(0x80000000);
}
