/* A private plant for the tests of this directory: vertical motion alone, no noise, no tilt. Thrust follows
 * the command by a pulse every 13.6 ms, 10 ms of transport and a first-order lag; damping stands for the
 * autopilot. The scanner's rays are taken 34 ms into its 100 ms revolution and their height arrives 72.5 ms
 * later. */
#ifndef TESTS_CONTROL_VERTICAL_PLANT_H
#define TESTS_CONTROL_VERTICAL_PLANT_H

#include <stdbool.h>
#include <stdint.h>

#define PLANT_STEP_US 500U

typedef struct {
    double hover_n; /* thrust that carries the vehicle */
    double damping_per_s;
    double climb_m_s_per_n; /* not 0: thrust commands the climb rate, attained with 0.25 s */
    double terrain_m;
    uint32_t control_us; /* period of flight_step() */
    uint32_t phase_us;   /* of control against the scanner */
    bool mute;           /* the scanner gives no height */

    uint32_t time_us;
    double height_m; /* absolute */
    double speed_m_s;
    double thrust_n;
    double command_n;    /* set by the test */
    double latched_n[2]; /* latest latched, the one before */
    uint32_t latch_us;   /* time of the latest latch */
    double touch_m_s;    /* downward speed at the latest touch from above 30 mm */
    double hardest_m_s;  /* largest of them */
    int contacts;
    bool was_up;

    double ray_height_m; /* of the revolution under way */
    bool height_new;     /* a height arrived in the latest step */
    double seen_mm;
    uint32_t seen_us;
} plant_t;

static inline plant_t plant_on_ground(double hover_n, double damping_per_s)
{
    plant_t plant = {
        .hover_n = hover_n, .damping_per_s = damping_per_s, .control_us = 108000U, .phase_us = 20000U};
    return plant;
}

static inline void plant_touch(plant_t *p)
{
    if (p->was_up && p->speed_m_s < -0.02) {
        p->contacts++;
        p->touch_m_s = -p->speed_m_s;
        p->hardest_m_s = p->touch_m_s > p->hardest_m_s ? p->touch_m_s : p->hardest_m_s;
        p->was_up = false;
    }
    p->height_m = p->terrain_m;
    p->speed_m_s = p->speed_m_s < -0.02 ? -0.15 * p->speed_m_s : 0.0;
}

static inline void plant_move(plant_t *p, double dt_s)
{
    const double above_m = p->height_m - p->terrain_m;
    const double z_r = 0.127 / (4.0 * (above_m + 0.28));
    const double lift = p->thrust_n > 1.0 ? p->thrust_n / p->hover_n / (1.0 - 2.0 * z_r * z_r) : 0.0;
    const double thrust_only = 9.81 * (lift - 1.0) - p->damping_per_s * p->speed_m_s;
    const double climbing = 4.0 * (p->climb_m_s_per_n * (p->thrust_n - p->hover_n) - p->speed_m_s);
    const double acceleration = p->climb_m_s_per_n > 0.0 ? climbing : thrust_only;
    const uint32_t since_us = p->time_us - p->latch_us;

    p->thrust_n += ((since_us >= 11500U ? p->latched_n[0] : p->latched_n[1]) - p->thrust_n) * dt_s / 0.12;
    p->speed_m_s += acceleration * dt_s;
    p->height_m += p->speed_m_s * dt_s;
    p->was_up = p->was_up || p->height_m > p->terrain_m + 0.03;
    if (p->height_m <= p->terrain_m) {
        plant_touch(p);
    }
}

static inline void plant_step(plant_t *p)
{
    const uint32_t in_revolution_us = p->time_us % 100000U;

    if (p->time_us % 13500U == 0U) {
        p->latched_n[1] = p->latched_n[0];
        p->latched_n[0] = p->command_n;
        p->latch_us = p->time_us;
    }
    plant_move(p, PLANT_STEP_US * 1e-6);
    p->height_new = in_revolution_us == 6500U && p->time_us > 100000U && !p->mute;
    if (p->height_new) {
        p->seen_mm = p->ray_height_m * 1000.0;
        p->seen_us = p->time_us;
    }
    if (in_revolution_us == 34000U) {
        p->ray_height_m = p->height_m - p->terrain_m;
    }
    p->time_us += PLANT_STEP_US;
}

static inline bool plant_releases(const plant_t *p)
{
    return p->time_us % p->control_us == p->phase_us;
}

#endif
