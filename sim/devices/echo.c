#include "sim/devices/echo.h"

#include <math.h>

#define EDGE_MM 30.0 /* chosen: parts of one spot that differ by more light two things */
#define PANES 3      /* chosen: a ray goes on through so many surfaces at most */
#define BEHIND_M 1e-6
#define RIM 4

static void add(echo_t *sum, double signal, double mm)
{
    if (signal > 0.0) {
        sum->mm = (sum->signal * sum->mm + signal * mm) / (sum->signal + signal);
        sum->signal += signal;
    }
}

static place_vector_t along(place_vector_t from, double times, place_vector_t direction)
{
    return (place_vector_t){from.x + times * direction.x, from.y + times * direction.y,
                            from.z + times * direction.z};
}

/* From one surface to the next behind it, as long as they let light through. */
static echo_t of_line(const place_t *place, const bracket_ray_t *ray, place_vector_t direction, double t_s,
                      noise_t *noise)
{
    const place_vector_t origin = {0.0, 0.0, 0.0};
    const double reach_m = 0.001 * ECHO_REACH_MM;
    echo_t echo = {.plain = true};
    place_vector_t from = along(origin, 0.001, ray->from);
    double passed = 1.0, gone_m = 0.0;
    place_hit_t hit;

    for (int i = 0; i < PANES && passed > 0.0 && gone_m < reach_m; i++) {
        if (!place_cast(place, from, direction, reach_m - gone_m, t_s, &hit)) {
            break;
        }
        const surface_t *surface = hit.surface;
        const double deep_mm = surface->depth_mm > 0.0 ? noise_uniform(noise, 0.0, surface->depth_mm) : 0.0;

        gone_m += hit.distance_m;
        add(&echo, passed * surface_signal(surface, hit.incidence_cos),
            ray->before_mm + 1000.0 * gone_m + surface->offset_mm + deep_mm);
        echo.dazzle += passed * surface_dazzles(surface, hit.incidence_cos);
        echo.plain = echo.plain && surface == &surface_plain;
        passed *= surface->clear * surface->clear; /* there and back */
        from = along(hit.at, BEHIND_M, direction);
        gone_m += BEHIND_M;
    }
    return echo;
}

/* A direction off the ray's, by tangents. */
static place_vector_t aside(const bracket_ray_t *ray, double across, double other)
{
    const place_vector_t origin = {0.0, 0.0, 0.0}, a = ray->across, d = ray->direction;
    const place_vector_t b = {d.y * a.z - d.z * a.y, d.z * a.x - d.x * a.z, d.x * a.y - d.y * a.x};
    const place_vector_t sum = along(along(d, across, a), other, b);

    return along(origin, 1.0 / sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z), sum);
}

/* The middle of the spot and four points of its rim. */
echo_t echo_of(const place_t *place, const bracket_ray_t *ray, double spot_rad, double t_s, noise_t *noise)
{
    const double r = spot_rad, rim[RIM][2] = {{r, 0.0}, {-r, 0.0}, {0.0, r}, {0.0, -r}};
    const echo_t middle = of_line(place, ray, ray->direction, t_s, noise);
    echo_t sum = middle;

    for (int i = 0; r > 0.0 && i < RIM; i++) {
        const echo_t part = of_line(place, ray, aside(ray, rim[i][0], rim[i][1]), t_s, noise);
        const bool both = part.signal > 0.0 && middle.signal > 0.0;

        sum.edged = sum.edged || (part.signal > 0.0) != (middle.signal > 0.0) ||
                    (both && fabs(part.mm - middle.mm) > EDGE_MM);
        add(&sum, part.signal, part.mm);
        sum.dazzle += part.dazzle;
        sum.plain = sum.plain && part.plain;
    }
    sum.signal /= r > 0.0 ? 1.0 + RIM : 1.0;
    sum.dazzle /= r > 0.0 ? 1.0 + RIM : 1.0;
    return sum;
}
