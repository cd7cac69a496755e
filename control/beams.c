#include "control/beams.h"

#include <math.h>

#define TOGETHER_MM 40.0F /* chosen: eight times the noise of a group, below ALTITUDE_DISAGREE_MM */

typedef struct {
    const mirror_range_t *range;
    float height_mm;
} seen_t;

static void swap_if_higher(seen_t *a, seen_t *b)
{
    const seen_t higher = *a;

    if (a->height_mm > b->height_mm) {
        *a = *b;
        *b = higher;
    }
}

/* Three at most. */
static void sort(seen_t *seen, uint16_t count)
{
    for (uint16_t turn = 1U; turn < count; ++turn) {
        for (uint16_t i = 0U; i + turn < count; ++i) {
            swap_if_higher(&seen[i], &seen[i + 1U]);
        }
    }
}

static bool lie_together(const seen_t *low, const seen_t *high)
{
    return high->height_mm - low->height_mm <= TOGETHER_MM;
}

/* Of three that do not all lie together: the nearer pair, or the middle one alone. */
static uint16_t keep_of_three(seen_t *seen)
{
    const bool upper = seen[2].height_mm - seen[1].height_mm < seen[1].height_mm - seen[0].height_mm;

    if (upper) {
        seen[0] = seen[1];
        seen[1] = seen[2];
    }
    if (lie_together(&seen[0], &seen[1])) {
        return 2U;
    }
    seen[0] = upper ? seen[0] : seen[1];
    return 1U;
}

static uint16_t keep_of_two(const beams_t *beams, seen_t *seen)
{
    const float from_low_mm = fabsf(seen[0].height_mm - beams->height_mm);
    const float from_high_mm = fabsf(seen[1].height_mm - beams->height_mm);

    if (beams->known && from_high_mm < from_low_mm) {
        seen[0] = seen[1];
    }
    return 1U;
}

/* Those that are believed come first. seen: sorted. */
static uint16_t keep(const beams_t *beams, seen_t *seen, uint16_t count)
{
    if (count < 2U || lie_together(&seen[0], &seen[count - 1U])) {
        return count;
    }
    return (count == 2U) ? keep_of_two(beams, seen) : keep_of_three(seen);
}

altitude_t beams_scan(beams_t *beams, const altitude_geometry_t *geometry, const mirror_range_t *ranges,
                      uint16_t count, float roll_rad, float pitch_rad)
{
    seen_t seen[MIRROR_COUNT];
    mirror_range_t kept[MIRROR_COUNT];
    uint16_t valid = 0U;

    for (uint16_t i = 0U; i < count; ++i) {
        if (ranges[i].valid) {
            seen[valid].range = &ranges[i];
            seen[valid].height_mm = altitude_under_mirror(&geometry->mirror[ranges[i].mirror],
                                                          ranges[i].slant_mm, roll_rad, pitch_rad);
            ++valid;
        }
    }
    sort(seen, valid);
    const bool disagree = valid > 1U && seen[valid - 1U].height_mm - seen[0].height_mm > ALTITUDE_DISAGREE_MM;
    const uint16_t used = keep(beams, seen, valid);
    for (uint16_t i = 0U; i < used; ++i) {
        kept[i] = *seen[i].range;
    }
    altitude_t altitude = altitude_from_ranges(geometry, kept, used, roll_rad, pitch_rad);
    altitude.disagree = disagree;
    beams->known = beams->known || altitude.valid;
    beams->height_mm = altitude.valid ? altitude.height_mm : beams->height_mm;
    return altitude;
}
