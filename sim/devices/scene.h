/* What the scanner's rays hit: mirrors on their arms, the ground under the tilted vehicle, and between the
 * mirrors what stands around in its place; without a place nothing in reach. In a place each ray goes its own
 * way, by geometry (bracket.h), at its own instant: a mirror's rays are a fan, and the three mirrors see
 * three spots, 25 ms apart. Without one they all measure under the vehicle's centre. Adds the sensor's noise.
 *
 * What a real sensor's noise is: a recorded URG-04LX that stands still (Player, server/drivers/ranger/
 * hokuyo_aist.logr, 47 of its 121 scans) has 2.1 mm for each ray at 0.3 to 0.7 m and 3.0 mm at 1 to 1.5 m.
 * Neighbouring rays go together (correlation 0.48, then 0.25, 0.11). The means of 35 rays in different
 * directions have 0.4 to 1.0 mm and hardly go together (0.06): the noise is each mirror's own. All
 * directions drift together by up to 1 mm in a second. So the figures by default ask more of the laws than
 * that sensor does; `ray_noise 2.4`, `ray_correlation 0.5`, `common_noise 0`, `wander 2` are as recorded.
 *
 * Mixed pixels: in the same recording the rays at 4 of 9 edges between two things are sharp, at 2 one or two
 * tell something in between, at 3 three or four in a row are lost. So a ray that lights both sides of an edge
 * (spot_rad) tells the mean by the light that comes back, or, one in three, a code. */
#ifndef SIM_DEVICES_SCENE_H
#define SIM_DEVICES_SCENE_H

#include "sim/devices/bracket.h"
#include "sim/devices/quadrotor.h"
#include "sim/devices/span.h"
#include "sim/devices/urg04lx.h"
#include "sim/noise.h"

#define SCENE_STEPS 769

typedef struct {
    double ray_sigma_mm;    /* each ray, 5 */
    double ray_correlation; /* of neighbouring rays' noise, 0; the next but one's is its square, and so on */
    double common_sigma_mm; /* all rays of a scan, 3 */
    double mirror_sigma_mm; /* all rays of a mirror in a scan, each mirror its own, 0 */
    double wander_sigma_mm; /* all rays, from scan to scan: a slow drift, correlated over wander_tau_s; 0 */
    double wander_tau_s;    /* 3 */
    double warm_up_mm;      /* 0: too far by so much at power-on, and less by 1/e in each warm_up_s */
    double warm_up_s;       /* 1800 */
    double glitch_probability; /* per scan, 0; half of them break every second ray, half lift all rays by 350
                                  mm */
    double outlier_mm; /* 0; the struck beams tell that much too far, in outlier_run scans of outlier_every */
    double outlier_run;     /* 4 */
    double outlier_every;   /* 20 */
    double outlier_start_s; /* 0 */
    double rays_lost; /* share of the rays, each scan others, that find too little light: a code below 20 */
    span_t rays_lost_span; /* since power-on */
    double sight_blocked;  /* share of the rays asked for on a mirror, always the first ones, that see a thing
                            * in  front of it (a leg, a rope, dirt) at block_mm, with the noise of a ray */
    double block_mm;       /* 150 */
    span_t sight_blocked_span; /* since power-on */
    span_t frozen; /* the sensor gives the distances of its latest scan again and again; its clock runs on.
                    * Never */
    double struck_beam;    /* 0: the four before act on every beam; 1: on the front mirror's alone, 2: on that
                            * of mirror 1, aft; 3: of mirror 2, fore; 4: front and aft; 5: front and fore; 6: aft
                            * and fore */
    double missing_mirror; /* 0: none; else as struck_beam: these are not there, or the rays asked for pass
                            * beside them. What they should bend goes straight on, to what stands around */
    double
        around_lost; /* share of the rays that no mirror bends, each scan others, that come back too weak */
    double around_garbage;   /* share of them that tell any distance: sunlight */
    double around_holder_mm; /* 0: none; a holder or a leg of the vehicle stands so far off before a third of
                              * those between the front and the fore mirror */
    double spot_rad;         /* half the width of what a ray lights, 0: a line. Recorded: 6e-3, one step */
    double sunlight;         /* 0..1, everywhere */
    double edge_m; /* what the beam sees lies that much higher than what the gear will stand on; < 0: beyond
                    * the edge of a table */
    double edge_start_s; /* 0 */
} scene_config_t;

extern const scene_config_t scene_default;

typedef struct {
    scene_config_t config;
    quadrotor_t *quadrotor;
    noise_t ray_noise, common_noise, mirror_noise, wander_noise, glitch_noise, lost_noise, surface_noise,
        around_noise;
    double wander_mm, wandered_s;
    long turns; /* revolutions since the first outlier could come */
    struct {    /* what the rays of this revolution share */
        double common_mm, mirror_mm[BRACKET_MIRRORS];
        double lift_mm; /* of a glitch, or an outlier */
        bool broken;    /* by one */
        int ray_step;   /* measured last, */
        double ray_mm;  /* its noise */
    } turn;
    int latest_mm[SCENE_STEPS]; /* of each step, as told last */
} scene_t;

void scene_init(scene_t *scene, const scene_config_t *config, quadrotor_t *quadrotor, unsigned long seed);

/* True height of the gear above what the beam sees. */
double scene_height_m(const scene_t *scene);

/* urg_world_t shape; context is a scene_t. */
void scene_scan(void *context, const urg_rays_t *rays, int *distance_mm);

#endif
