#include "sim/devices/scene.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "sim/devices/echo.h"

const scene_config_t scene_default = {.ray_sigma_mm = 5.0,
                                      .ray_correlation = 0.0,
                                      .common_sigma_mm = 3.0,
                                      .mirror_sigma_mm = 0.0,
                                      .wander_sigma_mm = 0.0,
                                      .wander_tau_s = 3.0,
                                      .warm_up_mm = 0.0,
                                      .warm_up_s = 1800.0,
                                      .glitch_probability = 0.0,
                                      .outlier_mm = 0.0,
                                      .outlier_run = 4.0,
                                      .outlier_every = 20.0,
                                      .outlier_start_s = 0.0,
                                      .rays_lost = 0.0,
                                      .rays_lost_span = {SPAN_POWER_ON_S, SPAN_FOR_GOOD_S},
                                      .sight_blocked = 0.0,
                                      .block_mm = 150.0,
                                      .sight_blocked_span = {SPAN_POWER_ON_S, SPAN_FOR_GOOD_S},
                                      .frozen = {SPAN_FOR_GOOD_S, SPAN_FOR_GOOD_S},
                                      .struck_beam = 0.0,
                                      .missing_mirror = 0.0,
                                      .around_lost = 0.0,
                                      .around_garbage = 0.0,
                                      .around_holder_mm = 0.0,
                                      .spot_rad = 0.0,
                                      .sunlight = 0.0,
                                      .edge_m = 0.0,
                                      .edge_start_s = 0.0};

#define GLITCH_LIFT_MM 350.0
#define FAR_CODE 0      /* nothing in reach */
#define DAZZLED_CODE 18 /* too much light */
#define NEIGHBOURS_CODE 7
#define GARBAGE_FROM_MM 20.0 /* a distance, and no code */
#define GARBAGE_TO_MM 4094.0
#define HOLDER_FIRST 460 /* chosen: a third of what the rays between two mirrors see */
#define HOLDER_LAST 530
#define SKYWARD 0.1         /* cosine from which on an edge is no nearer */
#define EDGE_LOST (3.0 / 9) /* the recording in scene.h */

void scene_init(scene_t *scene, const scene_config_t *config, quadrotor_t *quadrotor, unsigned long seed)
{
    scene->config = *config;
    scene->quadrotor = quadrotor;
    noise_init(&scene->ray_noise, seed, "laser rays");
    noise_init(&scene->common_noise, seed, "laser common");
    noise_init(&scene->mirror_noise, seed, "laser mirrors");
    noise_init(&scene->wander_noise, seed, "laser wander");
    noise_init(&scene->glitch_noise, seed, "laser glitches");
    noise_init(&scene->lost_noise, seed, "laser lost rays");
    noise_init(&scene->around_noise, seed, "laser around");
    noise_init(&scene->surface_noise, seed, "laser surfaces");
    scene->wander_mm = config->wander_sigma_mm * noise_gauss(&scene->wander_noise);
    scene->wandered_s = 0.0;
    scene->turns = 0;
    memset(&scene->turn, 0, sizeof scene->turn);
    memset(scene->latest_mm, 0, sizeof scene->latest_mm);
}

/* The rays that are measured now. */
typedef struct {
    const urg_rays_t *asked;
    bracket_pose_t pose;
    double t_s, slow_mm; /* slow_mm: all that drifts */
} look_t;

/* What the sensor tells of a ray that comes back too weak: the codes that real ones show (low intensity,
 * neighbouring steps in error, the same step failed twice), 0 above all. */
static int lost_code(scene_t *scene)
{
    static const int codes[] = {0, 0, 0, 0, 0, 1, 7, 9};

    return codes[noise_bits(&scene->lost_noise) % (sizeof codes / sizeof codes[0])];
}

static double sunlight_at(const scene_t *scene, const bracket_ray_t *ray, double mm)
{
    const double along = mm - ray->before_mm;

    return fmax(scene->config.sunlight, place_sunlight(quadrotor_place(scene->quadrotor),
                                                       0.001 * (ray->from.x + along * ray->direction.x),
                                                       0.001 * (ray->from.y + along * ray->direction.y)));
}

static bool happens(noise_t *noise, double probability)
{
    return probability > 0.0 && noise_uniform(noise, 0.0, 1.0) < probability;
}

/* The noise of a ray, or of what lies between: shared with others, and its own. */
typedef struct {
    double shared_mm, own_mm;
} ray_noise_t;

static double edge_m(const scene_t *scene, double t_s)
{
    return t_s >= scene->config.edge_start_s ? scene->config.edge_m : 0.0;
}

/* Nearer by so much: the beam's ground lies higher. */
static double nearer_mm(const scene_t *scene, const look_t *look, int mirror, const bracket_ray_t *ray)
{
    return mirror >= 0 ? 1000.0 * edge_m(scene, look->t_s) / fmax(-ray->direction.z, SKYWARD) : 0.0;
}

/* What the sensor tells of a ray: millimetres, or a code. */
static int told_mm(scene_t *scene, const look_t *look, int mirror, int step, ray_noise_t noise)
{
    const place_t *place = quadrotor_place(scene->quadrotor);
    const bracket_ray_t ray = bracket_ray(mirror, &look->pose, step);
    const echo_t echo = echo_of(place, &ray, scene->config.spot_rad, look->t_s, &scene->surface_noise);
    const double far_m = 0.001 * echo.mm;

    noise.shared_mm -= nearer_mm(scene, look, mirror, &ray);
    if (echo.signal <= 0.0) {
        return FAR_CODE;
    }
    if (echo.edged && happens(&scene->surface_noise, EDGE_LOST)) {
        return NEIGHBOURS_CODE;
    }
    if (echo.plain) {
        return (int)lround(echo.mm + noise.shared_mm + noise.own_mm);
    }
    const double sun = sunlight_at(scene, &ray, echo.mm);
    if (happens(&scene->surface_noise, echo.dazzle)) {
        return DAZZLED_CODE;
    }
    if (happens(&scene->surface_noise, surface_lost(echo.signal, far_m, sun))) {
        return lost_code(scene);
    }
    return (int)lround(echo.mm + noise.shared_mm + noise.own_mm * surface_noise(echo.signal, far_m, sun));
}

/* Whether a number of scene_config_t names this mirror, or all. */
static bool is_named(double which, int mirror)
{
    static const unsigned beams[] = {~0U,
                                     1U << BRACKET_FRONT,
                                     1U << BRACKET_AFT,
                                     1U << BRACKET_FORE,
                                     1U << BRACKET_FRONT | 1U << BRACKET_AFT,
                                     1U << BRACKET_FRONT | 1U << BRACKET_FORE,
                                     1U << BRACKET_AFT | 1U << BRACKET_FORE};

    return (beams[lround(which)] >> mirror & 1U) != 0U;
}

/* Whether a fault of the sight acts on this mirror's beam. */
static bool is_struck(const scene_t *scene, int mirror)
{
    return is_named(scene->config.struck_beam, mirror);
}

/* One bracket is mounted. Rays are asked for on the mirrors that it has, so it is the one of three when the
 * aft mirror's are among them, and then nothing stands where the other one has its two. */
static bool is_mounted(const urg_rays_t *asked, int mirror)
{
    const bool three = asked->first_step <= bracket_mirrors[BRACKET_AFT].last_step;

    return mirror <= BRACKET_FORE || !three;
}

/* The mirror that bends this ray; < 0: none. */
static int mirror_at(const scene_t *scene, const urg_rays_t *asked, int step)
{
    const int mirror = bracket_mirror_at(step);
    const double missing = scene->config.missing_mirror;
    const bool gone = missing >= 0.5 && mirror >= 0 && is_named(missing, mirror);

    return mirror >= 0 && !gone && is_mounted(asked, mirror) ? mirror : -1;
}

static bool lost(scene_t *scene, int mirror, double t_s)
{
    const scene_config_t *c = &scene->config;

    return is_struck(scene, mirror) && c->rays_lost > 0.0 && span_holds(&c->rays_lost_span, t_s) &&
           noise_uniform(&scene->lost_noise, 0.0, 1.0) < c->rays_lost;
}

/* Steps of the mirror from its first one asked for that something blocks. */
static int blocked_steps(const scene_t *scene, int number, const look_t *look)
{
    const scene_config_t *c = &scene->config;
    const bracket_mirror_t *mirror = &bracket_mirrors[number];
    const int asked_first = look->asked->first_step, asked_last = look->asked->last_step;
    const int first = asked_first > mirror->first_step ? asked_first : mirror->first_step;
    const int last = asked_last < mirror->last_step ? asked_last : mirror->last_step;

    return c->sight_blocked > 0.0 && is_struck(scene, number) && span_holds(&c->sight_blocked_span, look->t_s)
               ? first - mirror->first_step + (int)lround(c->sight_blocked * (last - first + 1))
               : 0;
}

double scene_height_m(const scene_t *scene)
{
    return quadrotor_state(scene->quadrotor)->height_m -
           edge_m(scene, quadrotor_scenario_s(scene->quadrotor));
}

/* Of a revolution: again and again so many in a row are too far. */
static double outlier_mm(scene_t *scene, double t_s)
{
    const scene_config_t *c = &scene->config;

    return c->outlier_mm != 0.0 && t_s >= c->outlier_start_s &&
                   fmod((double)scene->turns++, c->outlier_every) < c->outlier_run
               ? c->outlier_mm
               : 0.0;
}

/* A revolution's own draws. */
static void begin_turn(scene_t *scene, double t_s)
{
    const scene_config_t *c = &scene->config;

    scene->turn.common_mm = c->common_sigma_mm * noise_gauss(&scene->common_noise);
    scene->turn.lift_mm = 0.0;
    scene->turn.ray_step = -2;
    scene->turn.broken = false;
    for (int i = 0; i < BRACKET_MIRRORS; i++) {
        scene->turn.mirror_mm[i] = c->mirror_sigma_mm > 0.0
                                       ? c->mirror_sigma_mm * noise_gauss(&scene->mirror_noise)
                                       : 0.0;
    }
    if (c->glitch_probability > 0.0 &&
        noise_uniform(&scene->glitch_noise, 0.0, 1.0) < c->glitch_probability) {
        scene->turn.broken = noise_uniform(&scene->glitch_noise, 0.0, 1.0) < 0.5;
        scene->turn.lift_mm = scene->turn.broken ? 0.0 : GLITCH_LIFT_MM;
    }
    scene->turn.lift_mm += outlier_mm(scene, t_s);
}

/* First order, up to now. */
static double wandered_mm(scene_t *scene, double now_s)
{
    const scene_config_t *c = &scene->config;

    if (c->wander_sigma_mm <= 0.0) {
        return 0.0;
    }
    const double keep = exp(-(now_s - scene->wandered_s) / c->wander_tau_s);
    if (now_s > scene->wandered_s) {
        scene->wander_mm = keep * scene->wander_mm +
                           c->wander_sigma_mm * sqrt(1.0 - keep * keep) * noise_gauss(&scene->wander_noise);
        scene->wandered_s = now_s;
    }
    return scene->wander_mm;
}

static look_t look_now(scene_t *scene, const urg_rays_t *asked)
{
    const quadrotor_state_t *state = quadrotor_state(scene->quadrotor);
    const double now_s = (double)timeline_now() * 1e-9;

    return (look_t){.asked = asked,
                    .pose = bracket_pose(state),
                    .t_s = quadrotor_scenario_s(scene->quadrotor),
                    .slow_mm = wandered_mm(scene, now_s) +
                               scene->config.warm_up_mm * exp(-now_s / scene->config.warm_up_s)};
}

/* A ray goes together with the one before it, where that was measured. */
static ray_noise_t noise_of_ray(scene_t *scene, const look_t *look, int step)
{
    const double keep = step == scene->turn.ray_step + 1 ? scene->config.ray_correlation : 0.0;

    scene->turn.ray_step = step;
    scene->turn.ray_mm = keep * scene->turn.ray_mm + sqrt(1.0 - keep * keep) * scene->config.ray_sigma_mm *
                                                         noise_gauss(&scene->ray_noise);
    return (ray_noise_t){scene->turn.common_mm + look->slow_mm, scene->turn.ray_mm};
}

/* A ray through a mirror. */
static int bent_mm(scene_t *scene, const look_t *look, int mirror, int step)
{
    ray_noise_t noise = noise_of_ray(scene, look, step);

    noise.shared_mm += scene->turn.mirror_mm[mirror] + (is_struck(scene, mirror) ? scene->turn.lift_mm : 0.0);
    if (lost(scene, mirror, look->t_s)) {
        return lost_code(scene);
    }
    if (step - bracket_mirrors[mirror].first_step < blocked_steps(scene, mirror, look)) {
        return (int)lround(scene->config.block_mm + noise.shared_mm + noise.own_mm);
    }
    return told_mm(scene, look, mirror, step, noise);
}

/* A ray that goes straight on: what stands around, or a lie of it. */
static int free_mm(scene_t *scene, const look_t *look, int step)
{
    const scene_config_t *c = &scene->config;
    const ray_noise_t noise = noise_of_ray(scene, look, step);

    if (happens(&scene->around_noise, c->around_lost)) {
        return FAR_CODE;
    }
    if (happens(&scene->around_noise, c->around_garbage)) {
        return (int)noise_uniform(&scene->around_noise, GARBAGE_FROM_MM, GARBAGE_TO_MM);
    }
    if (c->around_holder_mm > 0.0 && step >= HOLDER_FIRST && step <= HOLDER_LAST) {
        return (int)lround(c->around_holder_mm + noise.shared_mm + noise.own_mm);
    }
    return told_mm(scene, look, -1, step, noise);
}

static int measured_mm(scene_t *scene, const look_t *look, int step)
{
    const int mirror = mirror_at(scene, look->asked, step);

    if (mirror < 0) {
        return free_mm(scene, look, step);
    }
    if (scene->turn.broken && is_struck(scene, mirror) && (step - look->asked->first_step) % 2 == 1) {
        return (int)noise_uniform(&scene->glitch_noise, 0.0, 19.0);
    }
    return bent_mm(scene, look, mirror, step);
}

static bool is_frozen(const scene_t *scene, double t_s, int step)
{
    const int mirror = bracket_mirror_at(step);

    return span_holds(&scene->config.frozen, t_s) &&
           (scene->config.struck_beam < 0.5 || (mirror >= 0 && is_struck(scene, mirror)));
}

void scene_scan(void *context, const urg_rays_t *rays, int *distance_mm)
{
    scene_t *scene = context;
    const look_t look = look_now(scene, rays);

    if (rays->from_step == rays->first_step) {
        begin_turn(scene, look.t_s);
    }
    for (int step = rays->from_step; step <= rays->to_step; step++) {
        if (!is_frozen(scene, look.t_s, step)) {
            scene->latest_mm[step] = measured_mm(scene, &look, step);
        }
        *distance_mm++ = scene->latest_mm[step];
    }
}
