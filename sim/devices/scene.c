#include "sim/devices/scene.h"

#include <math.h>
#include <stddef.h>

const scene_config_t scene_default = {.ray_sigma_mm = 5.0, .common_sigma_mm = 3.0, .glitch_probability = 0.0};

#define GLITCH_LIFT_MM 350.0
#define FAR_CODE 0 /* nothing in reach */

/* One mirror: the steps that look into it, and the place of reflection in vehicle axes with the vehicle level: `out`
 * along the lateral axis towards the mirror's side, `fore` along the nose, `up` above the gear's lowest point. */
typedef struct {
    int first_step, last_step;
    double path_mm;
    double out_mm, fore_mm, up_mm;
} scene_mirror_t;

/* The sensor stands 115 mm out (220 - 105) and looks outwards at step 384; larger steps turn towards the nose. */
static const scene_mirror_t mirrors[] = {
    {367, 411, 105.0, 220.0, 0.0, 100.0},
    {106, 150, 115.0, 115.0, -115.0, 98.0},
    {618, 662, 107.0, 115.0, 107.0, 105.0},
};

void scene_init(scene_t *scene, const scene_config_t *config, quadrotor_t *quadrotor, unsigned long seed)
{
    scene->config = *config;
    scene->quadrotor = quadrotor;
    noise_init(&scene->ray_noise, seed, "laser rays");
    noise_init(&scene->common_noise, seed, "laser common");
    noise_init(&scene->glitch_noise, seed, "laser glitches");
}

/* The ray leaves the mirror along the vehicle's own "down". The lowest point of the gear under the vehicle's centre is
 * at `height` above the ground when level; tilt turns about the point on the gear plane under the centre, as the seed
 * draws it. */
static double slant_mm(const scene_mirror_t *mirror, const quadrotor_state_t *state)
{
    double down = cos(state->roll_rad) * cos(state->pitch_rad);
    double point_mm = state->height_m * 1000.0 + mirror->up_mm * down + mirror->out_mm * sin(state->roll_rad) +
                      mirror->fore_mm * sin(state->pitch_rad);

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

void scene_scan(void *context, int first_step, int last_step, int *distance_mm)
{
    scene_t *scene = context;
    const quadrotor_state_t *state = quadrotor_state(scene->quadrotor);
    double common = scene->config.common_sigma_mm * noise_gauss(&scene->common_noise);
    int broken_rays = 0;

    if (scene->config.glitch_probability > 0.0 &&
        noise_uniform(&scene->glitch_noise, 0.0, 1.0) < scene->config.glitch_probability) {
        broken_rays = noise_uniform(&scene->glitch_noise, 0.0, 1.0) < 0.5;
        common += broken_rays ? 0.0 : GLITCH_LIFT_MM;
    }
    for (int step = first_step; step <= last_step; step++) {
        const scene_mirror_t *mirror = mirror_at(step);
        int *distance = &distance_mm[step - first_step];

        if (mirror == NULL) {
            *distance = FAR_CODE;
        } else if (broken_rays && (step - first_step) % 2 == 1) {
            *distance = (int)noise_uniform(&scene->glitch_noise, 0.0, 19.0);
        } else {
            *distance = (int)lround(slant_mm(mirror, state) + common +
                                    scene->config.ray_sigma_mm * noise_gauss(&scene->ray_noise));
        }
    }
}
