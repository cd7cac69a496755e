/* What the scanner's rays hit: mirrors on their arms, the ground under the tilted vehicle, and between the mirrors
 * nothing in reach. Adds the sensor's noise. The geometry is written from the bracket's drawing (seed document, figures
 * 5.7 and 5.8, Annex III), independently of the product's correction. */
#ifndef SIM_DEVICES_SCENE_H
#define SIM_DEVICES_SCENE_H

#include "sim/devices/quadrotor.h"
#include "sim/noise.h"

typedef struct {
    double ray_sigma_mm;        /* each ray, 5 */
    double common_sigma_mm;     /* all rays of a scan, 3 */
    double glitch_probability;  /* per scan, 0; half of them break every second ray, half lift all rays by 350 mm */
} scene_config_t;

extern const scene_config_t scene_default;

typedef struct {
    scene_config_t config;
    quadrotor_t *quadrotor;
    noise_t ray_noise, common_noise, glitch_noise;
} scene_t;

void scene_init(scene_t *scene, const scene_config_t *config, quadrotor_t *quadrotor, unsigned long seed);

/* urg_world_t shape; context is a scene_t. */
void scene_scan(void *context, int first_step, int last_step, int *distance_mm);

#endif
