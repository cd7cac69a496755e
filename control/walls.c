/* A row grows ray by ray, as long as the next one is near the line through those before it (total least
 * squares by running sums). What breaks it: a ray that tells nothing, a jump, or a corner. */
#include "control/walls.h"

#include <math.h>

#define RAYS_LEAST 6U
#define RAY_MM 5.0F    /* noise of one ray (sim/devices/scene.h) */
#define COMMON_MM 3.0F /* of all rays of a scan together */
#define OFF_MM 30.0F   /* six times the noise of one ray */
#define ROUGH_MM 15.0F /* three times it: what is rougher is no wall */
/* From the centre to a rotor's tip: half the diagonal of an F450, 225, and half a rotor of 10 inches, 127. */
#define HALF_WIDTH_MM 352.0F

typedef struct {
    float x, y; /* ahead, to the right; from the centre */
} point_t;

typedef struct {
    uint16_t rays;
    point_t first, last;
    float sx, sy, sxx, sxy, syy; /* of the differences to `first` */
    uint16_t mm;                 /* of the latest ray */
    bool opens_unseen;           /* nobody looks beside its first ray */
} row_t;

/* Through the middle of a row, with a unit vector along it. */
typedef struct {
    point_t middle, along;
    float long2, off2; /* mean squares along it and across */
} line_t;

static line_t line_of(const row_t *row)
{
    const float n = (float)row->rays;
    const float mx = row->sx / n;
    const float my = row->sy / n;
    const float xx = row->sxx / n - mx * mx;
    const float xy = row->sxy / n - mx * my;
    const float yy = row->syy / n - my * my;
    const float angle_rad = 0.5F * atan2f(2.0F * xy, xx - yy);
    const float half = sqrtf(0.25F * (xx - yy) * (xx - yy) + xy * xy);

    return (line_t){.middle = {row->first.x + mx, row->first.y + my},
                    .along = {cosf(angle_rad), sinf(angle_rad)},
                    .long2 = 0.5F * (xx + yy) + half,
                    .off2 = fmaxf(0.5F * (xx + yy) - half, 0.0F)};
}

static float across_mm(const line_t *line, point_t point)
{
    return (point.y - line->middle.y) * line->along.x - (point.x - line->middle.x) * line->along.y;
}

static float along_mm(const line_t *line, point_t point)
{
    return (point.x - line->middle.x) * line->along.x + (point.y - line->middle.y) * line->along.y;
}

static void begin(row_t *row, point_t point, uint16_t mm, bool opens_unseen)
{
    *row = (row_t){.rays = 1U, .first = point, .last = point, .mm = mm, .opens_unseen = opens_unseen};
}

static void add(row_t *row, point_t point, uint16_t mm)
{
    const float x = point.x - row->first.x;
    const float y = point.y - row->first.y;

    ++row->rays;
    row->last = point;
    row->mm = mm;
    row->sx += x;
    row->sy += y;
    row->sxx += x * x;
    row->sxy += x * y;
    row->syy += y * y;
}

static bool goes_on(const row_t *row, point_t point, uint16_t mm)
{
    if (row->rays == 0U || !around_same(row->mm, mm)) {
        return false;
    }
    if (row->rays < RAYS_LEAST) {
        return true;
    }
    const line_t line = line_of(row);
    return fabsf(across_mm(&line, point)) <= OFF_MM;
}

/* Whether 0, where the perpendicular from the centre meets the line, is on the row or less than half a
 * vehicle beside it; an end beside which nobody looks has no limit. */
static bool is_faced(const row_t *row, const line_t *line, float foot_mm, bool ends_unseen)
{
    const float first_mm = along_mm(line, row->first) - foot_mm;
    const float last_mm = along_mm(line, row->last) - foot_mm;
    const float ahead = (first_mm < last_mm) ? 1.0F : -1.0F;

    return (row->opens_unseen || ahead * first_mm <= HALF_WIDTH_MM) &&
           (ends_unseen || ahead * last_mm >= -HALF_WIDTH_MM);
}

static bool wall_of(wall_t *wall, const row_t *row, bool ends_unseen)
{
    const line_t line = line_of(row);
    const point_t centre = {0.0F, 0.0F};
    const float n = (float)row->rays;
    const float noise2 = fmaxf(line.off2 * n / (n - 2.0F), RAY_MM * RAY_MM);
    const float foot_mm = along_mm(&line, centre);
    const float across = -across_mm(&line, centre);

    wall->mm = fabsf(across);
    wall->bearing_rad = (across < 0.0F) ? atan2f(-line.along.x, line.along.y)
                                        : atan2f(line.along.x, -line.along.y);
    wall->sigma_mm = sqrtf(noise2 / n * (1.0F + foot_mm * foot_mm / line.long2) + COMMON_MM * COMMON_MM);
    wall->faces = is_faced(row, &line, foot_mm, ends_unseen);
    return noise2 <= ROUGH_MM * ROUGH_MM;
}

static uint16_t close_row(wall_t walls[WALLS_MAX], uint16_t count, row_t *row, bool ends_unseen)
{
    const bool found = row->rays >= RAYS_LEAST && count < WALLS_MAX &&
                       wall_of(&walls[count], row, ends_unseen);

    row->rays = 0U;
    return (uint16_t)(count + (found ? 1U : 0U));
}

/* Beyond the first and the last ray nobody looks either. */
static bool is_unseen(const around_look_t *look, uint16_t index)
{
    return index >= look->count || look->mm[index] == AROUND_UNSEEN;
}

uint16_t walls_find(wall_t walls[WALLS_MAX], const around_look_t *look, float abeam_mm)
{
    row_t row = {.rays = 0U};
    uint16_t count = 0U;

    for (uint16_t i = 0U; i < look->count; ++i) {
        const uint16_t mm = look->mm[i];
        const float bearing_rad = around_ray_rad(look, i);

        if (mm == AROUND_UNSEEN || mm == AROUND_NOTHING) {
            count = close_row(walls, count, &row, mm == AROUND_UNSEEN);
            continue;
        }
        const point_t point = {(float)mm * cosf(bearing_rad), (float)mm * sinf(bearing_rad) + abeam_mm};
        if (goes_on(&row, point, mm)) {
            add(&row, point, mm);
        } else {
            count = close_row(walls, count, &row, false);
            begin(&row, point, mm, i == 0U || is_unseen(look, (uint16_t)(i - 1U)));
        }
    }
    return close_row(walls, count, &row, true);
}
