#include "sim/devices/scene.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

const scene_config_t scene_default = {.ray_sigma_mm = 5.0,
                                      .common_sigma_mm = 3.0,
                                      .glitch_probability = 0.0,
                                      .rays_lost = 0.0,
                                      .rays_lost_span = {SPAN_POWER_ON_S, SPAN_FOR_GOOD_S},
                                      .sight_blocked = 0.0,
                                      .block_mm = 150.0,
                                      .sight_blocked_span = {SPAN_POWER_ON_S, SPAN_FOR_GOOD_S},
                                      .frozen = {SPAN_FOR_GOOD_S, SPAN_FOR_GOOD_S},
                                      .edge_m = 0.0,
                                      .edge_start_s = 0.0};

#define GLITCH_LIFT_MM 350.0
#define FAR_CODE 0  /* nothing in reach */
#define SKYWARD 0.1 /* cosine of the tilt from which on the beam finds no ground */

/* One mirror: the steps that look into it, and the place of reflection in vehicle axes with the vehicle
 * level: `out` along the lateral axis towards the mirror's side, `fore` along the nose, `up` above the gear's
 * lowest point. */
typedef struct {
    int first_step, last_step;
    double path_mm;
    double out_mm, fore_mm, up_mm;
} scene_mirror_t;

/* The sensor stands 115 mm out (220 - 105) and looks outwards at step 384; larger steps turn towards the
 * nose. */
static const scene_mirror_t mirrors[] = {
    {367, 411, 105.0, 220.0, 0.0, 100.0},
    {106, 150, 115.0, 115.0, -115.0, 98.0},
    {618, 662, 107.0, 115.0, 107.0, 105.0},
    /* The bracket of two beams, 42.5 degrees to either side, with the same distances along the ray. */
    {244, 282, 115.0, 199.8, -77.7, 98.0},
    {486, 524, 107.0, 193.9, 72.3, 105.0},
};

void scene_init(scene_t *scene, const scene_config_t *config, quadrotor_t *quadrotor, unsigned long seed)
{
    scene->config = *config;
    scene->quadrotor = quadrotor;
    noise_init(&scene->ray_noise, seed, "laser rays");
    noise_init(&scene->common_noise, seed, "laser common");
    noise_init(&scene->glitch_noise, seed, "laser glitches");
    noise_init(&scene->lost_noise, seed, "laser lost rays");
    memset(scene->latest_mm, 0, sizeof scene->latest_mm);
}

/* The ray leaves the mirror along the vehicle's own "down". The lowest point of the gear under the vehicle's
 * centre is at `height` above the ground when level; tilt turns about the point on the gear plane under the
 * centre, as the seed draws it. */
static double slant_mm(const scene_mirror_t *mirror, const quadrotor_state_t *state)
{
    double down = cos(state->roll_rad) * cos(state->pitch_rad);
    double point_mm = state->height_m * 1000.0 + mirror->up_mm * down +
                      mirror->out_mm * sin(state->roll_rad) + mirror->fore_mm * sin(state->pitch_rad);

    return mirror->path_mm + point_mm / down;
}

static const scene_mirror_t *mirror_at(int step)
{
    for (size_t i = 0; i < sizeof mirrors / sizeof mirrors[0]; i++) {
        if (step >= mirrors[i].first_step && step <= mirrors[i].last_step) {
            return &mirrors[i];
        }
    }
    return NULL;
}

/* What the sensor tells of a ray that comes back too weak: the codes that real ones show (low intensity,
 * neighbouring steps in error, the same step failed twice), 0 above all. */
static int lost_code(scene_t *scene)
{
    static const int codes[] = {0, 0, 0, 0, 0, 1, 7, 9};

    return codes[noise_bits(&scene->lost_noise) % (sizeof codes / sizeof codes[0])];
}

static bool lost(scene_t *scene, double t_s)
{
    const scene_config_t *c = &scene->config;

    return c->rays_lost > 0.0 && span_holds(&c->rays_lost_span, t_s) &&
           noise_uniform(&scene->lost_noise, 0.0, 1.0) < c->rays_lost;
}

/* Steps of the mirror from its first one asked for that something blocks. */
static int blocked_steps(const scene_t *scene, const scene_mirror_t *mirror, int first_step, int last_step,
                         double t_s)
{
    const scene_config_t *c = &scene->config;
    const int first = first_step > mirror->first_step ? first_step : mirror->first_step;
    const int last = last_step < mirror->last_step ? last_step : mirror->last_step;

    return c->sight_blocked > 0.0 && span_holds(&c->sight_blocked_span, t_s)
               ? first - mirror->first_step + (int)lround(c->sight_blocked * (last - first + 1))
               : 0;
}

static double edge_m(const scene_t *scene, double t_s)
{
    return t_s >= scene->config.edge_start_s ? scene->config.edge_m : 0.0;
}

double scene_height_m(const scene_t *scene)
{
    return quadrotor_state(scene->quadrotor)->height_m -
           edge_m(scene, quadrotor_scenario_s(scene->quadrotor));
}

static double ground_mm(const scene_t *scene, const scene_mirror_t *mirror, const quadrotor_state_t *state,
                        double t_s)
{
    const double higher_mm = 1000.0 * edge_m(scene, t_s);

    return slant_mm(mirror, state) - higher_mm / (cos(state->roll_rad) * cos(state->pitch_rad));
}

/* The scan as the sensor measures it. */
static void measure(scene_t *scene, int first_step, int last_step, double t_s)
{
    const quadrotor_state_t *state = quadrotor_state(scene->quadrotor);
    const bool skyward = cos(state->roll_rad) * cos(state->pitch_rad) < SKYWARD;
    double common = scene->config.common_sigma_mm * noise_gauss(&scene->common_noise);
    int broken_rays = 0;

    if (scene->config.glitch_probability > 0.0 &&
        noise_uniform(&scene->glitch_noise, 0.0, 1.0) < scene->config.glitch_probability) {
        broken_rays = noise_uniform(&scene->glitch_noise, 0.0, 1.0) < 0.5;
        common += broken_rays ? 0.0 : GLITCH_LIFT_MM;
    }
    for (int step = first_step; step <= last_step; step++) {
        const scene_mirror_t *mirror = mirror_at(step);
        int *distance = &scene->latest_mm[step];

        if (mirror == NULL) {
            *distance = FAR_CODE;
        } else if (broken_rays && (step - first_step) % 2 == 1) {
            *distance = (int)noise_uniform(&scene->glitch_noise, 0.0, 19.0);
        } else {
            const double ray_mm = scene->config.ray_sigma_mm * noise_gauss(&scene->ray_noise);
            const bool blocked = step - mirror->first_step <
                                 blocked_steps(scene, mirror, first_step, last_step, t_s);

            *distance = lost(scene, t_s) ? lost_code(scene)
                        : blocked        ? (int)lround(scene->config.block_mm + common + ray_mm)
                        : skyward        ? FAR_CODE
                                  : (int)lround(ground_mm(scene, mirror, state, t_s) + common + ray_mm);
        }
    }
}

void scene_scan(void *context, int first_step, int last_step, int *distance_mm)
{
    scene_t *scene = context;
    const double t_s = quadrotor_scenario_s(scene->quadrotor);

    if (!span_holds(&scene->config.frozen, t_s)) {
        measure(scene, first_step, last_step, t_s);
    }
    memcpy(distance_mm, &scene->latest_mm[first_step],
           (size_t)(last_step - first_step + 1) * sizeof distance_mm[0]);
}
