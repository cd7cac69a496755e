#include "firmware/parameter_store.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <xdc/std.h>

#include "drivers/parameter_image.h"
#include "drivers/scip_request.h"
#include "bsp/storage.h"

#define VALUES ((uint16_t)PARAMETER_COUNT)
#define LASER_RATE VALUES /* place of the scanner's power-up rate, behind the parameters */
#define SLOTS BSP_STORAGE_SLOTS
#define NO_SLOT SLOTS

typedef struct {
    parameter_image_status_t status;
    parameter_image_t image;
} copy_t;

static copy_t copies[SLOTS];
static uint16_t cells[PARAMETER_IMAGE_CELLS_MAX];
static uint16_t read_back[PARAMETER_IMAGE_CELLS_MAX];

/* The names belong to the sum as well: a choice is stored as its place, and another order of the names
 * is another meaning. */
static uint32_t names_of_choices(uint32_t names, const parameter_row_t *row)
{

    for (uint16_t i = 0U; row->choices != NULL && i <= (uint16_t)row->maximum; ++i) {
        names = parameter_image_name(names, row->choices[i]);
    }
    return names;
}

/* Of the first `count` parameters of the table. */
static uint32_t names_of(uint16_t count)
{
    uint32_t names = 0U;

    for (uint16_t id = 0U; id < count; ++id) {
        names = parameter_image_name(names, parameter_table[id].name);
        names = names_of_choices(names, &parameter_table[id]);
    }
    return names;
}

static uint32_t names_with_rate(uint16_t count)
{
    return parameter_image_name(names_of(count), "laser power-up rate");
}

/* New parameters stand at the end of the table, so an older copy holds its beginning; the oldest copies have
 * no rate behind it. Returns how many parameters it holds, 0 when it is of another firmware. */
static uint16_t parameters_in(const parameter_image_t *image)
{
    const uint16_t count = image->count;

    if (count <= LASER_RATE + 1U && image->names == names_with_rate((uint16_t)(count - 1U))) {
        return (uint16_t)(count - 1U);
    }
    return (count <= VALUES && image->names == names_of(count)) ? count : 0U;
}

/* Both copies each time. Nothing about the flash is remembered, so that a copy that was damaged
 * meanwhile is noticed. */
static void look(void)
{

    for (uint16_t slot = 0U; slot < SLOTS; ++slot) {
        bsp_storage_read(slot, cells, PARAMETER_IMAGE_CELLS_MAX);
        copies[slot].status = parameter_image_read(&copies[slot].image, cells);
    }
}

static bool usable(const copy_t *copy, bool foreign_too)
{
    return copy->status == PARAMETER_IMAGE_GOOD && (foreign_too || parameters_in(&copy->image) > 0U);
}

/* Of two good copies the newer one. Where a power failure cut the newer one short, the older one is
 * whole: it was not touched. */
static uint16_t newest(bool foreign_too)
{
    const bool first = usable(&copies[0], foreign_too);
    const bool second = usable(&copies[1], foreign_too);

    if (first && second) {
        return parameter_image_newer(copies[1].image.generation, copies[0].image.generation) ? 1U : 0U;
    }
    return first ? 0U : (second ? 1U : NO_SLOT);
}

/* The operator does different things: a set of another firmware can be typed again, a damaged one says
 * that the flash wears out. */
static parameter_store_status_t why_none(void)
{
    parameter_store_status_t why = PARAMETER_STORE_EMPTY;

    for (uint16_t slot = 0U; slot < SLOTS; ++slot) {
        const parameter_image_status_t status = copies[slot].status;

        if (status == PARAMETER_IMAGE_GOOD || status == PARAMETER_IMAGE_VERSION_UNKNOWN) {
            return PARAMETER_STORE_FOREIGN;
        }
        if (status == PARAMETER_IMAGE_DAMAGED) {
            why = PARAMETER_STORE_DAMAGED;
        }
    }
    return why;
}

/* Returns the first parameter that its limits refuse, PARAMETER_COUNT when there is none. */
static parameter_id_t accept_values(parameters_t *parameters, const parameter_image_t *image)
{
    const uint16_t count = parameters_in(image);

    for (uint16_t id = 0U; id < count; ++id) {
        if (parameters_set(parameters, (parameter_id_t)id, image->values[id]) != PARAMETER_ACCEPTED) {
            return (parameter_id_t)id;
        }
    }
    /* Parameters that the copy does not have get what the firmware of that time did. */
    parameters_set_older(parameters, count);
    return PARAMETER_COUNT;
}

parameter_store_result_t parameter_store_load(parameters_t *parameters)
{
    parameter_store_result_t result = {PARAMETER_STORE_DONE, 0U, PARAMETER_COUNT};
    static parameters_t wanted;

    look();
    const uint16_t slot = newest(false);
    if (slot == NO_SLOT) {
        result.status = why_none();
        return result;
    }
    /* All or nothing: a set with one value out of range is taken as a whole, or not at all. */
    wanted = *parameters;
    result.generation = copies[slot].image.generation;
    result.parameter = accept_values(&wanted, &copies[slot].image);
    if (result.parameter != PARAMETER_COUNT) {
        result.status = PARAMETER_STORE_RANGE;
    } else {
        *parameters = wanted;
    }
    return result;
}

/* A float that is exactly one of the rates. Anything else is no rate, and the scanner is searched. */
static uint32_t laser_rate_in(uint16_t slot)
{

    if (slot == NO_SLOT) {
        return 0U;
    }
    const uint16_t place = parameters_in(&copies[slot].image);
    if (copies[slot].image.count <= place) {
        return 0U;
    }
    for (uint16_t i = 0U; i < SCIP_BIT_RATES; ++i) {
        if (copies[slot].image.values[place] == (float)scip_bit_rates[i]) {
            return scip_bit_rates[i];
        }
    }
    return 0U;
}

uint32_t parameter_store_laser_rate(void)
{
    look();
    return laser_rate_in(newest(false));
}

static void fill(parameter_image_t *image, const parameters_t *parameters, uint32_t laser_rate)
{

    image->count = LASER_RATE + 1U;
    image->names = names_with_rate(VALUES);
    image->values[LASER_RATE] = (float)laser_rate;
    for (uint16_t id = 0U; id < (uint16_t)PARAMETER_COUNT; ++id) {
        image->values[id] = parameters->value[id];
    }
}

/* The flash bank cannot be read while it is changed, and the code of all interrupts lies in it. */
static bool erase(uint16_t slot)
{
    UInt key = Hwi_disable();
    bool erased = bsp_storage_erase(slot);

    Hwi_restore(key);
    return erased;
}

static bool program(uint16_t slot, uint16_t first)
{
    UInt key = Hwi_disable();
    bool programmed = bsp_storage_program(slot, first, &cells[first]);

    Hwi_restore(key);
    return programmed;
}

static bool write(uint16_t slot, const parameter_image_t *image)
{
    const uint16_t count = parameter_image_write(cells, image);
    bool written = erase(slot);

    for (uint16_t at = 0U; written && at < count; at = (uint16_t)(at + BSP_STORAGE_BLOCK)) {
        written = program(slot, at);
    }
    /* Read back: what counts is what the next start will find. */
    bsp_storage_read(slot, read_back, count);
    for (uint16_t at = 0U; written && at < count; ++at) {
        written = read_back[at] == cells[at];
    }
    return written;
}

parameter_store_result_t parameter_store_save(const parameters_t *parameters, uint32_t laser_rate)
{
    parameter_store_result_t result = {PARAMETER_STORE_DONE, 1U, PARAMETER_COUNT};
    static parameter_image_t image;

    look();
    const uint16_t latest = newest(true);
    uint16_t kept = newest(false);
    /* A scanner that was not seen to power up this time has not changed its rate: the stored one is
     * kept. */
    fill(&image, parameters, laser_rate > 0U ? laser_rate : laser_rate_in(kept));
    if (latest != NO_SLOT) {
        /* Above that of a foreign set too, or the firmware that wrote it would take its own old set
         * for the newer one. */
        result.generation = copies[latest].image.generation + 1U;
        kept = (kept != NO_SLOT) ? kept : latest;
    }
    image.generation = result.generation;
    /* Never over the copy that would be loaded if this one fails. */
    if (!write((kept == 0U) ? 1U : 0U, &image)) {
        result.status = PARAMETER_STORE_FAULT;
    }
    return result;
}
