#include "control/around.h"

#include <math.h>
#include <stdbool.h>

#include "control/altitude.h"
#include "control/angle.h"

#define RIGHT_RAD 1.57079633F    /* pi / 2 */
#define SECTOR_RAD 0.0872664626F /* 5 degrees */
/* Two degrees. A vehicle that sways by 2 degrees rms at 0.6 Hz turns by 0.3 rms in the 40 ms by which the
 * rays of an end of the scan are older or younger than its middle; three sigmas of that are one, and the zero
 * of the IMU's mounting is another. What may be the floor then is left out. */
#define TILT_WRONG_RAD 0.035F
/* Neighbouring rays, 1.4 degrees apart, tell lengths that differ by an eighth on a wall that is seen at 10
 * degrees. Two looks, 0.2 s apart, do so for a thing at 1 m that comes by 0.6 m/s. */
#define SAME_SHARE 8U
#define SAME_LEAST_MM 30U /* six times the noise of one ray, 5 mm */

typedef char three_mirrors_stand_in_a_row[((int)PARAMETER_S2 - (int)PARAMETER_SF == 2) ? 1 : -1];

/* Mean over the mirrors of LAYOUT: each was mounted a little aside of its place. */
static float turned_steps(const parameters_t *parameters)
{
    float sum = 0.0F;

    for (uint16_t i = (uint16_t)PARAMETER_SF; i <= (uint16_t)PARAMETER_S2; ++i) {
        sum += parameters->value[i] - parameter_table[i].initial;
    }
    return sum / 3.0F;
}

void around_begin(around_look_t *look, const parameters_t *parameters, float first_step, uint16_t every,
                  uint16_t count)
{
    look->count = count;
    look->first_rad = RIGHT_RAD -
                      (first_step - SCANNER_RIGHT_STEP - turned_steps(parameters)) * SCANNER_STEP_RAD;
    look->turn_rad = -SCANNER_STEP_RAD * (float)every;
}

around_place_t around_place(const parameters_t *parameters, float height_mm, float roll_rad, float pitch_rad)
{
    const float gear_mm = isnan(height_mm) ? 0.0F : fmaxf(height_mm, 0.0F);

    return (around_place_t){
        .roll_rad = roll_rad,
        .pitch_rad = pitch_rad,
        .above_floor_mm = gear_mm + parameters->value[PARAMETER_LF] +
                          (parameters->value[PARAMETER_L] - parameters->value[PARAMETER_DF]) * sinf(roll_rad),
    };
}

float around_ray_rad(const around_look_t *look, uint16_t index)
{
    return turn_rad(0.0F, look->first_rad + look->turn_rad * (float)index);
}

static bool is_told(uint16_t mm)
{
    return mm != AROUND_NOTHING && mm != AROUND_UNSEEN;
}

/* The nearest range at which a ray may meet the floor that points up by the angle of this sine and cosine. */
static float floor_mm(const around_place_t *place, float up, float level)
{
    const float down = sinf(TILT_WRONG_RAD) * level - cosf(TILT_WRONG_RAD) * up;

    return (down > 0.0F) ? place->above_floor_mm / down : INFINITY;
}

static uint16_t level_mm(uint16_t mm, const around_place_t *place, float bearing_rad)
{
    const float up = cosf(bearing_rad) * sinf(place->pitch_rad) +
                     sinf(bearing_rad) * cosf(place->pitch_rad) * sinf(place->roll_rad);
    const float level = sqrtf(fmaxf(1.0F - up * up, 0.0F));

    return ((float)mm < floor_mm(place, up, level)) ? (uint16_t)((float)mm * level + 0.5F)
                                                    : (uint16_t)AROUND_NOTHING;
}

void around_level(around_look_t *look, const around_place_t *place)
{
    for (uint16_t i = 0U; i < look->count; ++i) {
        if (is_told(look->mm[i])) {
            look->mm[i] = level_mm(look->mm[i], place, around_ray_rad(look, i));
        }
    }
}

bool around_same(uint16_t a_mm, uint16_t b_mm)
{
    const uint16_t near_mm = (a_mm < b_mm) ? a_mm : b_mm;
    const uint16_t apart_mm = (uint16_t)((a_mm < b_mm) ? b_mm - a_mm : a_mm - b_mm);
    const uint16_t share_mm = near_mm / SAME_SHARE;

    return is_told(a_mm) && is_told(b_mm) &&
           apart_mm <= ((share_mm > SAME_LEAST_MM) ? share_mm : SAME_LEAST_MM);
}

static bool has(const around_look_t *look, int16_t index, uint16_t mm)
{
    return index >= 0 && index < (int16_t)look->count && around_same(look->mm[index], mm);
}

static bool same_rays(const around_look_t *a, const around_look_t *b)
{
    return a->count == b->count && a->first_rad == b->first_rad && a->turn_rad == b->turn_rad;
}

void around_confirm(around_look_t *confirmed, const around_look_t *look, const around_look_t *before)
{
    const bool twice = same_rays(look, before);

    *confirmed = *look;
    for (uint16_t i = 0U; i < look->count; ++i) {
        const int16_t at = (int16_t)i;
        const uint16_t mm = look->mm[i];
        const bool beside = has(look, (int16_t)(at - 1), mm) || has(look, (int16_t)(at + 1), mm);
        const bool again = twice && (has(before, (int16_t)(at - 1), mm) || has(before, at, mm) ||
                                     has(before, (int16_t)(at + 1), mm));

        if (is_told(mm) && !beside && !again) {
            confirmed->mm[i] = AROUND_NOTHING;
        }
    }
}

static uint16_t sector_of(float bearing_rad)
{
    const int16_t sector = (int16_t)floorf(bearing_rad / SECTOR_RAD);

    return (uint16_t)((uint16_t)(sector + 2 * (int16_t)AROUND_SECTORS) % AROUND_SECTORS);
}

static uint16_t nearer(uint16_t a_mm, uint16_t b_mm)
{
    if (!is_told(a_mm) || !is_told(b_mm)) {
        return (is_told(a_mm) || b_mm == AROUND_UNSEEN) ? a_mm : b_mm;
    }
    return (a_mm < b_mm) ? a_mm : b_mm;
}

void around_sectors(uint16_t sectors[AROUND_SECTORS], const around_look_t *look)
{
    for (uint16_t s = 0U; s < AROUND_SECTORS; ++s) {
        sectors[s] = AROUND_UNSEEN;
    }
    for (uint16_t i = 0U; i < look->count; ++i) {
        uint16_t *const sector = &sectors[sector_of(around_ray_rad(look, i))];

        *sector = nearer(*sector, look->mm[i]);
    }
}
