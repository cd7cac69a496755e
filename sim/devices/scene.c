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
                                      .struck_beam = 0.0,
                                      .edge_m = 0.0,
                                      .edge_start_s = 0.0};

#define GLITCH_LIFT_MM 350.0
#define FAR_CODE 0 /* nothing in reach */
#define STEP_DEG (360.0 / 1024.0)
#define SENSOR_OUT_MM 115.0
#define SENSOR_UP_MM 100.0
#define OUTWARD_STEP 384.0
#define REACH_MM 5600.0 /* as far as the sensor tells distances; beyond 4095 its own affair */
#define SKYWARD 0.1     /* cosine of the tilt from which on the beam finds no ground */

/* One mirror: the steps that look into it, and the place of reflection in vehicle axes with the vehicle
 * level: `out` along the lateral axis towards the mirror's side, `fore` along the nose, `up` above the gear's
 * lowest point. */
typedef struct {
    int first_step, last_step;
    double path_mm;
    double out_mm, fore_mm, up_mm;
    double axis_step; /* the ray that meets its middle square */
} scene_mirror_t;

/* Directions and places in the place's axes, millimetres. */
typedef struct {
    place_vector_t centre, fore, right, up; /* centre: on the gear's plane */
} pose_t;

/* The sensor stands 115 mm out (220 - 105) and looks outwards at step 384; larger steps turn towards the
 * nose. */
static const scene_mirror_t mirrors[] = {
    {367, 411, 105.0, 220.0, 0.0, 100.0, 384.0},
    {106, 150, 115.0, 115.0, -115.0, 98.0, 128.0},
    {618, 662, 107.0, 115.0, 107.0, 105.0, 640.0},
    /* The bracket of two beams, 42.5 degrees to either side, with the same distances along the ray. */
    {244, 282, 115.0, 199.8, -77.7, 98.0, 384.0 - 42.5 / STEP_DEG},
    {486, 524, 107.0, 193.9, 72.3, 105.0, 384.0 + 42.5 / STEP_DEG},
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

static place_vector_t add(place_vector_t a, double times, place_vector_t b)
{
    return (place_vector_t){a.x + times * b.x, a.y + times * b.y, a.z + times * b.z};
}

/* Heading, then pitch about the lateral axis, then roll about the nose. */
static pose_t pose_of(const quadrotor_state_t *state)
{
    const place_vector_t zenith = {0.0, 0.0, 1.0}, none = {0.0, 0.0, 0.0};
    const place_vector_t level_fore = {cos(state->heading_rad), sin(state->heading_rad), 0.0};
    const place_vector_t level_right = {sin(state->heading_rad), -cos(state->heading_rad), 0.0};
    const double cp = cos(state->pitch_rad), sp = sin(state->pitch_rad);
    const double cr = cos(state->roll_rad), sr = sin(state->roll_rad);
    const place_vector_t pitched_up = add(add(none, cp, zenith), -sp, level_fore);

    return (pose_t){.centre = {1000.0 * state->x_m, 1000.0 * state->y_m, 1000.0 * state->altitude_m},
                    .fore = add(add(none, cp, level_fore), sp, zenith),
                    .right = add(add(none, cr, level_right), sr, pitched_up),
                    .up = add(add(none, cr, pitched_up), -sr, level_right)};
}

/* A ray of the sensor, from where it leaves the mirror, or the sensor where there is none. */
typedef struct {
    place_vector_t from, direction; /* millimetres; length 1 */
    double before_mm;               /* its way up to there */
} ray_t;

/* The mirror stands at 45 degrees across its axis, and turns what comes along it straight down. A ray that
 * comes `aside` by an angle meets it later, and leaves it aside by the same angle: the rays of a mirror are a
 * fan. */
static ray_t ray_of(const scene_mirror_t *mirror, const pose_t *pose, int step)
{
    const place_vector_t none = {0.0, 0.0, 0.0};
    const double axis_step = mirror != NULL ? mirror->axis_step : (double)step;
    const double bearing = (axis_step - OUTWARD_STEP) * STEP_DEG * (M_PI / 180.0);
    const double aside = ((double)step - axis_step) * STEP_DEG * (M_PI / 180.0);
    const place_vector_t axis = add(add(none, cos(bearing), pose->right), sin(bearing), pose->fore);
    const place_vector_t across = add(add(none, -sin(bearing), pose->right), cos(bearing), pose->fore);
    const place_vector_t sensor = add(add(pose->centre, SENSOR_OUT_MM, pose->right),
                                      mirror != NULL ? mirror->up_mm : SENSOR_UP_MM, pose->up);

    if (mirror == NULL) {
        return (ray_t){sensor, axis, 0.0};
    }
    return (ray_t){add(add(sensor, mirror->path_mm, axis), mirror->path_mm * tan(aside), across),
                   add(add(none, -cos(aside), pose->up), sin(aside), across), mirror->path_mm / cos(aside)};
}

/* What the sensor would tell without noise; 0: nothing in reach. */
static double place_mm(const scene_t *scene, const scene_mirror_t *mirror, const pose_t *pose, int step,
                       double t_s)
{
    const ray_t ray = ray_of(mirror, pose, step);
    const place_vector_t none = {0.0, 0.0, 0.0};
    place_hit_t hit;

    return place_cast(quadrotor_place(scene->quadrotor), add(none, 0.001, ray.from), ray.direction,
                      0.001 * REACH_MM, t_s, &hit)
               ? ray.before_mm + 1000.0 * hit.distance_m
               : FAR_CODE;
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

/* Whether a fault of the sight acts on this mirror's beam. */
static bool is_struck(const scene_t *scene, const scene_mirror_t *mirror)
{
    const int beam = (int)lround(scene->config.struck_beam);

    return beam == 0 || mirror == &mirrors[beam - 1];
}

static bool lost(scene_t *scene, const scene_mirror_t *mirror, double t_s)
{
    const scene_config_t *c = &scene->config;

    return is_struck(scene, mirror) && c->rays_lost > 0.0 && span_holds(&c->rays_lost_span, t_s) &&
           noise_uniform(&scene->lost_noise, 0.0, 1.0) < c->rays_lost;
}

/* Steps of the mirror from its first one asked for that something blocks. */
static int blocked_steps(const scene_t *scene, const scene_mirror_t *mirror, int first_step, int last_step,
                         double t_s)
{
    const scene_config_t *c = &scene->config;
    const int first = first_step > mirror->first_step ? first_step : mirror->first_step;
    const int last = last_step < mirror->last_step ? last_step : mirror->last_step;

    return c->sight_blocked > 0.0 && is_struck(scene, mirror) && span_holds(&c->sight_blocked_span, t_s)
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

/* How a scan comes about: what all its rays share. */
typedef struct {
    const quadrotor_state_t *state;
    pose_t pose;
    double t_s, common_mm;
    int first_step, last_step;
    bool broken, skyward;
} sweep_t;

static double ground_mm(const scene_t *scene, const scene_mirror_t *mirror, const sweep_t *sweep, int step)
{
    const quadrotor_state_t *state = sweep->state;
    const double higher_mm = 1000.0 * edge_m(scene, sweep->t_s);

    if (quadrotor_place(scene->quadrotor) != NULL) {
        return place_mm(scene, mirror, &sweep->pose, step, sweep->t_s) - higher_mm;
    }
    return slant_mm(mirror, state) - higher_mm / (cos(state->roll_rad) * cos(state->pitch_rad));
}

static sweep_t begin_sweep(scene_t *scene, int first_step, int last_step, double t_s)
{
    const quadrotor_state_t *state = quadrotor_state(scene->quadrotor);
    sweep_t sweep = {.state = state,
                     .pose = pose_of(state),
                     .t_s = t_s,
                     .common_mm = scene->config.common_sigma_mm * noise_gauss(&scene->common_noise),
                     .first_step = first_step,
                     .last_step = last_step,
                     .skyward = cos(state->roll_rad) * cos(state->pitch_rad) < SKYWARD};

    if (scene->config.glitch_probability > 0.0 &&
        noise_uniform(&scene->glitch_noise, 0.0, 1.0) < scene->config.glitch_probability) {
        sweep.broken = noise_uniform(&scene->glitch_noise, 0.0, 1.0) < 0.5;
        sweep.common_mm += sweep.broken ? 0.0 : GLITCH_LIFT_MM;
    }
    return sweep;
}

/* A ray through a mirror. */
static int bent_mm(scene_t *scene, const scene_mirror_t *mirror, const sweep_t *sweep, int step)
{
    const double noise_mm = sweep->common_mm + scene->config.ray_sigma_mm * noise_gauss(&scene->ray_noise);
    const bool blocked = step - mirror->first_step <
                         blocked_steps(scene, mirror, sweep->first_step, sweep->last_step, sweep->t_s);

    if (lost(scene, mirror, sweep->t_s)) {
        return lost_code(scene);
    }
    if (blocked) {
        return (int)lround(scene->config.block_mm + noise_mm);
    }
    const double mm = sweep->skyward ? FAR_CODE : ground_mm(scene, mirror, sweep, step);
    return mm == FAR_CODE ? FAR_CODE : (int)lround(mm + noise_mm);
}

/* A ray between the mirrors: what stands around. */
static int straight_mm(scene_t *scene, const sweep_t *sweep, int step)
{
    if (quadrotor_place(scene->quadrotor) == NULL) {
        return FAR_CODE;
    }
    const double mm = place_mm(scene, NULL, &sweep->pose, step, sweep->t_s);
    return mm == FAR_CODE ? FAR_CODE
                          : (int)lround(mm + sweep->common_mm +
                                        scene->config.ray_sigma_mm * noise_gauss(&scene->ray_noise));
}

/* The scan as the sensor measures it. */
static void measure(scene_t *scene, int first_step, int last_step, double t_s)
{
    const sweep_t sweep = begin_sweep(scene, first_step, last_step, t_s);
    const bool frozen = span_holds(&scene->config.frozen, t_s);

    for (int step = first_step; step <= last_step; step++) {
        const scene_mirror_t *mirror = mirror_at(step);
        int *distance = &scene->latest_mm[step];

        if (frozen && mirror != NULL && is_struck(scene, mirror)) {
            continue;
        }
        if (mirror == NULL) {
            *distance = straight_mm(scene, &sweep, step);
        } else if (sweep.broken && (step - first_step) % 2 == 1) {
            *distance = (int)noise_uniform(&scene->glitch_noise, 0.0, 19.0);
        } else {
            *distance = bent_mm(scene, mirror, &sweep, step);
        }
    }
}

void scene_scan(void *context, int first_step, int last_step, int *distance_mm)
{
    scene_t *scene = context;
    const double t_s = quadrotor_scenario_s(scene->quadrotor);

    if (scene->config.struck_beam >= 0.5 || !span_holds(&scene->config.frozen, t_s)) {
        measure(scene, first_step, last_step, t_s);
    }
    memcpy(distance_mm, &scene->latest_mm[first_step],
           (size_t)(last_step - first_step + 1) * sizeof distance_mm[0]);
}
