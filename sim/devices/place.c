#include "sim/devices/place.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "sim/noise.h"

#define FAR_M 1e4
#define LEVEL 1e-12

void place_init(place_t *place)
{
    memset(place, 0, sizeof *place);
    place->floor[0] = place->floor[1] = surface_plain;
}

bool place_add(place_t *place, const place_block_t *block)
{
    if (place->count == PLACE_BLOCKS_MAX) {
        return false;
    }
    place->bounds[place->count].cosine = cos(block->heading_rad);
    place->bounds[place->count].sine = sin(block->heading_rad);
    place->bounds[place->count].radius_m = 0.5 * hypot(block->length_m, block->width_m);
    place->blocks[place->count++] = *block;
    return true;
}

bool place_shine(place_t *place, const place_sun_t *sun)
{
    if (place->suns == PLACE_SUNS_MAX) {
        return false;
    }
    place->sun[place->suns++] = *sun;
    return true;
}

/* Three squared Gaussians: chi-squared with the three degrees of freedom of order 3/2. */
static double chi_squared_3(noise_t *noise)
{
    double sum = 0.0;

    for (int i = 0; i < 3; i++) {
        const double gauss = noise_gauss(noise);
        sum += gauss * gauss;
    }
    return sum;
}

void place_roughen(place_t *place, const place_rough_t *rough, unsigned long seed)
{
    noise_t noise;

    place->rough = *rough;
    noise_init(&noise, seed, "rough floor");
    for (int i = 0; i < PLACE_WAVES; i++) {
        const double lag_m = 0.5 * rough->correlation_m;
        const double scale = 1.0 / (lag_m * sqrt(chi_squared_3(&noise)));

        place->waves[i].kx = scale * noise_gauss(&noise);
        place->waves[i].ky = scale * noise_gauss(&noise);
        place->waves[i].phase = noise_uniform(&noise, 0.0, 2.0 * M_PI);
    }
}

static double roughness_m(const place_t *place, double x_m, double y_m, place_hit_t *hit)
{
    const double amplitude_m = place->rough.rms_m * sqrt(2.0 / PLACE_WAVES);
    double sum = 0.0;

    hit->slope_x = hit->slope_y = 0.0;
    if (place->rough.rms_m <= 0.0) {
        return 0.0;
    }
    for (int i = 0; i < PLACE_WAVES; i++) {
        const double phase = place->waves[i].kx * x_m + place->waves[i].ky * y_m + place->waves[i].phase;
        const double slope = -amplitude_m * sin(phase);

        sum += cos(phase);
        hit->slope_x += slope * place->waves[i].kx;
        hit->slope_y += slope * place->waves[i].ky;
    }
    return amplitude_m * sum;
}

/* How far a lift has come, and how fast it is. */
static double travelled_m(const place_block_t *block, double t_s, double *rises_mps)
{
    const double way_s = block->travel_mps > 0.0 ? fabs(block->travel_m) / block->travel_mps : 0.0;
    const double since_s = t_s - block->travel_start_s;
    const double back_s = since_s - way_s - block->stay_s;
    const double speed_mps = copysign(block->travel_mps, block->travel_m);

    *rises_mps = 0.0;
    if (way_s <= 0.0 || since_s <= 0.0 || back_s >= way_s) {
        return 0.0;
    }
    if (since_s < way_s) {
        *rises_mps = speed_mps;
        return speed_mps * since_s;
    }
    if (back_s > 0.0) {
        *rises_mps = -speed_mps;
        return block->travel_m - speed_mps * back_s;
    }
    return block->travel_m;
}

static bool is_there(const place_block_t *block, double t_s)
{
    return (block->there.start_s == 0.0 && block->there.length_s == 0.0) || span_holds(&block->there, t_s);
}

/* A ray in a block's own axes: u along its heading from the near end's middle, v across, w up. */
typedef struct {
    double u, v, w, du, dv, dw;
} local_t;

static local_t into(const place_t *place, int number, place_vector_t from, place_vector_t direction,
                    double lifted_m)
{
    const place_block_t *block = &place->blocks[number];
    const double c = place->bounds[number].cosine, s = place->bounds[number].sine;
    const double x = from.x - block->x_m, y = from.y - block->y_m;

    return (local_t){.u = c * x + s * y,
                     .v = -s * x + c * y,
                     .w = from.z - lifted_m,
                     .du = c * direction.x + s * direction.y,
                     .dv = -s * direction.x + c * direction.y,
                     .dw = direction.z};
}

/* Where a ray enters a convex body: the last of the planes that it crosses inwards, before the first
 * outwards. */
typedef struct {
    double enter_m, leave_m, cosine; /* of the incidence on the plane that it enters by */
    bool by_top, outside;
} crossing_t;

/* A half space: what lies behind the plane is `depth` inside; the depth grows by `rate` for a metre of ray.
 */
static inline void clip(crossing_t *crossing, double depth, double rate, double norm, bool top)
{
    if (fabs(rate) < LEVEL) {
        crossing->outside = crossing->outside || depth < 0.0;
        return;
    }
    const double at_m = -depth / rate;
    if (rate > 0.0 && at_m > crossing->enter_m) {
        crossing->enter_m = at_m;
        crossing->cosine = rate / norm;
        crossing->by_top = top;
    } else if (rate < 0.0 && at_m < crossing->leave_m) {
        crossing->leave_m = at_m;
    }
}

static double slope_of(const place_block_t *block)
{
    return block->length_m > 0.0 ? (block->far_top_m - block->near_top_m) / block->length_m : 0.0;
}

/* Planes that are crossed later never bring it back. */
static bool misses(crossing_t *crossing)
{
    crossing->outside = crossing->outside || crossing->enter_m >= crossing->leave_m;
    return crossing->outside;
}

static crossing_t cross(const place_block_t *block, const local_t *ray)
{
    crossing_t crossing = {.enter_m = -INFINITY, .leave_m = INFINITY};
    const double half_m = 0.5 * block->length_m, wide_m = 0.5 * block->width_m;

    clip(&crossing, half_m - ray->u, -ray->du, 1.0, false);
    clip(&crossing, half_m + ray->u, ray->du, 1.0, false);
    if (misses(&crossing)) {
        return crossing;
    }
    clip(&crossing, wide_m - ray->v, -ray->dv, 1.0, false);
    clip(&crossing, wide_m + ray->v, ray->dv, 1.0, false);
    if (misses(&crossing)) {
        return crossing;
    }
    const double slope = slope_of(block), middle_m = 0.5 * (block->near_top_m + block->far_top_m);

    clip(&crossing, ray->w - block->bottom_m, ray->dw, 1.0, false);
    clip(&crossing, middle_m + slope * ray->u - ray->w, slope * ray->du - ray->dw, sqrt(1.0 + slope * slope),
         true);
    (void)misses(&crossing);
    return crossing;
}

static place_vector_t along(place_vector_t from, place_vector_t direction, double distance_m)
{
    return (place_vector_t){from.x + distance_m * direction.x, from.y + distance_m * direction.y,
                            from.z + distance_m * direction.z};
}

/* Plain ones are one object, which surface_signal() knows. */
static const surface_t *own_or_plain(const surface_t *surface)
{
    return surface->name[0] == '\0' || strcmp(surface->name, surface_plain.name) == 0 ? &surface_plain
                                                                                      : surface;
}

static const surface_t *floor_at(const place_t *place, double x_m, double y_m)
{
    const bool odd = place->tile_m > 0.0 &&
                     fmod(fabs(floor(x_m / place->tile_m) + floor(y_m / place->tile_m)), 2.0) > 0.5;

    return own_or_plain(&place->floor[odd ? 1 : 0]);
}

/* Whether (x, any y) lies on the higher of the floor's two levels. */
static bool is_upper(const place_bars_t *bars, double x_m)
{
    const double along_m = x_m - bars->from_m;
    const bool bar = along_m >= 0.0 && fmod(along_m, bars->period_m) >= (1.0 - bars->share) * bars->period_m;

    return bars->height_m > 0.0 ? bar : !bar;
}

/* How far ahead of x, towards dx, the higher level begins; infinite: nowhere. */
static double step_up_m(const place_bars_t *bars, double x_m, double dx)
{
    const bool at_a_bars_start = (bars->height_m > 0.0) == (dx > 0.0);
    const double offset_m = bars->from_m + (at_a_bars_start ? (1.0 - bars->share) * bars->period_m : 0.0);
    const double periods = (x_m - offset_m) / bars->period_m;
    const double next = dx > 0.0 ? ceil(periods) : floor(periods);
    const double first = at_a_bars_start ? 0.0 : 1.0;

    if (next < first) {
        return dx > 0.0 ? offset_m + first * bars->period_m - x_m : INFINITY;
    }
    return fabs(offset_m + next * bars->period_m - x_m);
}

/* The floor without its roughness: straight down at the higher level, at a bar's side, or at the lower level.
 */
static place_hit_t cast_bars(const place_t *place, place_vector_t from, place_vector_t direction)
{
    const place_bars_t *bars = &place->bars;
    const double upper_m = place->level_m + fmax(bars->height_m, 0.0);
    const double lower_m = place->level_m + fmin(bars->height_m, 0.0);
    const double upper_at_m = (upper_m - from.z) / direction.z;
    const double upper_x_m = from.x + fmax(upper_at_m, 0.0) * direction.x;
    place_hit_t floor = {.block = -1, .incidence_cos = -direction.z, .distance_m = upper_at_m};

    if (bars->height_m == 0.0 || is_upper(bars, upper_x_m)) {
        return floor;
    }
    floor.distance_m = (lower_m - from.z) / direction.z;
    if (fabs(direction.x) > LEVEL) {
        const double side_m = fmax(upper_at_m, 0.0) +
                              step_up_m(bars, upper_x_m, direction.x) / fabs(direction.x);
        if (side_m < floor.distance_m) {
            floor.distance_m = side_m;
            floor.incidence_cos = fabs(direction.x);
        }
    }
    return floor;
}

/* A rough floor is met where the ray crosses its height below the crossing of the even one: exact for a ray
 * straight down, and for any other as far as the floor does not change within the difference. */
static void cast_floor(const place_t *place, place_vector_t from, place_vector_t direction, place_hit_t *hit)
{
    if (direction.z >= 0.0) {
        return;
    }
    place_hit_t floor = cast_bars(place, from, direction);
    const place_vector_t under = along(from, direction, floor.distance_m);

    floor.distance_m += roughness_m(place, under.x, under.y, &floor) / direction.z;
    if (floor.distance_m < hit->distance_m) {
        floor.at = along(from, direction, floor.distance_m);
        floor.surface = floor_at(place, floor.at.x, floor.at.y);
        *hit = floor;
    }
}

/* Seen from above: whether the ray's line comes near enough to the block, and not only behind its start. */
static bool may_meet(const place_t *place, int number, place_vector_t from, place_vector_t direction)
{
    const double x = place->blocks[number].x_m - from.x, y = place->blocks[number].y_m - from.y;
    const double radius_m = place->bounds[number].radius_m;
    const double level2 = direction.x * direction.x + direction.y * direction.y;
    const double across = x * direction.y - y * direction.x, ahead = x * direction.x + y * direction.y;

    return x * x + y * y <= radius_m * radius_m ||
           (across * across <= radius_m * radius_m * level2 && ahead > 0.0);
}

static void cast_block(const place_t *place, int number, place_vector_t from, place_vector_t direction,
                       double t_s, place_hit_t *hit)
{
    const place_block_t *block = &place->blocks[number];
    double rises_mps;

    if (!may_meet(place, number, from, direction) || !is_there(block, t_s)) {
        return;
    }
    const local_t ray = into(place, number, from, direction, travelled_m(block, t_s, &rises_mps));
    const crossing_t crossing = cross(block, &ray);
    if (crossing.outside || crossing.enter_m < 0.0 || crossing.enter_m >= hit->distance_m) {
        return;
    }
    const double slope = crossing.by_top ? slope_of(block) : 0.0;
    *hit = (place_hit_t){.distance_m = crossing.enter_m,
                         .at = along(from, direction, crossing.enter_m),
                         .slope_x = slope * place->bounds[number].cosine,
                         .slope_y = slope * place->bounds[number].sine,
                         .rises_mps = rises_mps,
                         .incidence_cos = crossing.cosine,
                         .block = number,
                         .surface = own_or_plain(&block->surface)};
}

bool place_cast(const place_t *place, place_vector_t from, place_vector_t direction, double reach_m,
                double t_s, place_hit_t *hit)
{
    *hit = (place_hit_t){.distance_m = reach_m, .block = -1, .surface = &surface_plain};
    cast_floor(place, from, direction, hit);
    for (int i = 0; i < place->count; i++) {
        cast_block(place, i, from, direction, t_s, hit);
    }
    return hit->distance_m < reach_m;
}

double place_sunlight(const place_t *place, double x_m, double y_m)
{
    double strongest = 0.0;

    for (int i = 0; i < place->suns; i++) {
        const place_sun_t *sun = &place->sun[i];
        const double c = cos(sun->heading_rad), s = sin(sun->heading_rad);
        const double x = x_m - sun->x_m, y = y_m - sun->y_m;

        if (fabs(c * x + s * y) <= 0.5 * sun->length_m && fabs(c * y - s * x) <= 0.5 * sun->width_m) {
            strongest = fmax(strongest, sun->strength);
        }
    }
    return strongest;
}

place_hit_t place_below(const place_t *place, double x_m, double y_m, double z_m, double t_s)
{
    const place_vector_t down = {0.0, 0.0, -1.0};
    const place_vector_t from = {x_m, y_m, fmax(z_m, place->level_m) + PLACE_CARRIES_M};
    place_hit_t hit;

    place_cast(place, from, down, FAR_M, t_s, &hit);
    return hit;
}

bool place_block_at(const place_t *place, int number, double t_s, place_block_t *block)
{
    double rises_mps;
    const double lifted_m = travelled_m(&place->blocks[number], t_s, &rises_mps);

    *block = place->blocks[number];
    block->bottom_m += lifted_m;
    block->near_top_m += lifted_m;
    block->far_top_m += lifted_m;
    return is_there(block, t_s);
}

static bool holds(const place_t *place, int number, place_vector_t point, double t_s)
{
    const place_block_t *block = &place->blocks[number];
    const place_vector_t none = {0.0, 0.0, 0.0};
    double rises_mps;
    const local_t at = into(place, number, point, none, travelled_m(block, t_s, &rises_mps));
    const double top_m = 0.5 * (block->near_top_m + block->far_top_m) + slope_of(block) * at.u;

    return fabs(at.u) < 0.5 * block->length_m && fabs(at.v) < 0.5 * block->width_m &&
           at.w > block->bottom_m && at.w < top_m - PLACE_CARRIES_M;
}

bool place_inside(const place_t *place, place_vector_t point, double t_s)
{
    for (int i = 0; i < place->count; i++) {
        if (may_meet(place, i, point, (place_vector_t){0.0, 0.0, 0.0}) && is_there(&place->blocks[i], t_s) &&
            holds(place, i, point, t_s)) {
            return true;
        }
    }
    return false;
}
