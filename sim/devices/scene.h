/* What the scanner's rays hit: mirrors on their arms, the ground under the tilted vehicle, and between the
 * mirrors what stands around in its place; without a place nothing in reach. In a place each ray goes its own
 * way, by geometry: a mirror's rays are a fan, and the three mirrors see three spots. Without one they all
 * measure under the vehicle's centre. Adds the sensor's noise. The geometry is written from the bracket's
 * drawing (seed document, figures 5.7 and 5.8, Annex III), independently of the product's correction. */
#ifndef SIM_DEVICES_SCENE_H
#define SIM_DEVICES_SCENE_H

#include "sim/devices/quadrotor.h"
#include "sim/devices/span.h"
#include "sim/noise.h"

#define SCENE_STEPS 769

typedef struct {
    double ray_sigma_mm;       /* each ray, 5 */
    double common_sigma_mm;    /* all rays of a scan, 3 */
    double glitch_probability; /* per scan, 0; half of them break every second ray, half lift all rays by 350
                                  mm */
    double rays_lost; /* share of the rays, each scan others, that find too little light: a code below 20 */
    span_t rays_lost_span; /* since power-on */
    double sight_blocked;  /* share of the rays asked for on a mirror, always the first ones, that see a thing
                            * in  front of it (a leg, a rope, dirt) at block_mm, with the noise of a ray */
    double block_mm;       /* 150 */
    span_t sight_blocked_span; /* since power-on */
    span_t frozen; /* the sensor gives the distances of its latest scan again and again; its clock runs on.
                    * Never */
    double struck_beam; /* 0: the three before act on every beam; 1: on the front mirror's alone, 2: on that
                         * of mirror 1, aft; 3: of mirror 2, fore */
    double edge_m; /* what the beam sees lies that much higher than what the gear will stand on; < 0: beyond
                    * the edge of a table */
    double edge_start_s; /* 0 */
} scene_config_t;

extern const scene_config_t scene_default;

typedef struct {
    scene_config_t config;
    quadrotor_t *quadrotor;
    noise_t ray_noise, common_noise, glitch_noise, lost_noise;
    int latest_mm[SCENE_STEPS]; /* of each step, as told last */
} scene_t;

void scene_init(scene_t *scene, const scene_config_t *config, quadrotor_t *quadrotor, unsigned long seed);

/* True height of the gear above what the beam sees. */
double scene_height_m(const scene_t *scene);

/* urg_world_t shape; context is a scene_t. */
void scene_scan(void *context, int first_step, int last_step, int *distance_mm);

#endif
