/* The private plant with what makes it hard: turbulence, noise of scanner and accelerometer, attitude motion.
 * Frames of the IMU come every 25 ms, their content 23.6 ms old; heights come 70.5 ms after their rays.
 * Everything that flight_step() wants of them is filled into its inputs. */
#ifndef TESTS_CONTROL_NOISY_PLANT_H
#define TESTS_CONTROL_NOISY_PLANT_H

#include <math.h>
#include <string.h>

#include "control/altitude.h"
#include "control/flight.h"
#include "vertical_plant.h"

#define NOISY_FRAMES 8U
#define NOISY_FRAME_US 25000U
#define NOISY_FRAME_AGE_US 23500U

typedef struct {
    plant_t body;
    uint32_t random;
    double turbulence_m_s2; /* rms, correlation time 0.5 s */
    double gust_m_s2;
    double acceleration_noise_m_s2;
    double acceleration_bias_m_s2;
    double height_noise_mm;
    double tilt_rad;   /* amplitude of roll, 0.6 Hz */
    double fallen_rad; /* of the roll: the IMU tells it, and the rays go that way */
    double lied_rad;   /* added to the roll that the IMU tells */
    double glitch;     /* probability of a height 350 mm off */
    bool imu_mute;
    bool no_acceleration;
    imu_sample_t frames[NOISY_FRAMES];
    uint16_t frame_count;
    double felt_m_s2[48]; /* accelerations of the latest steps, for the age of a frame */
    double before_m_s;
    uint32_t steps;
    bool released; /* a frame or a height came in the latest step */
} noisy_t;

static inline double noisy_uniform(noisy_t *n)
{
    n->random = n->random * 1664525U + 1013904223U;
    return (double)(n->random >> 8) / 16777216.0;
}

static inline double noisy_gauss(noisy_t *n)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += noisy_uniform(n);
    }
    return sum;
}

static inline noisy_t noisy_on_ground(uint32_t seed)
{
    noisy_t n;
    memset(&n, 0, sizeof n);
    n.body = plant_on_ground(7.4, 2.4);
    n.random = seed * 2654435761U + 12345U;
    n.turbulence_m_s2 = 0.2;
    n.acceleration_noise_m_s2 = 0.4;
    n.acceleration_bias_m_s2 = 0.15;
    n.height_noise_mm = 3.1;
    n.tilt_rad = 0.035;
    return n;
}

static inline double noisy_roll(const noisy_t *n, uint32_t ago_us)
{
    return n->body.height_m > 0.0 ? n->tilt_rad * sin(3.77 * (n->body.time_us - ago_us) * 1e-6) : 0.0;
}

static inline void noisy_frame(noisy_t *n, uint32_t clock_us)
{
    imu_sample_t *f = &n->frames[NOISY_FRAMES - 1U];
    const double roll = noisy_roll(n, NOISY_FRAME_AGE_US);
    const double felt = 9.80665 + n->felt_m_s2[(n->steps - 1U - NOISY_FRAME_AGE_US / PLANT_STEP_US) % 48U] +
                        n->acceleration_bias_m_s2 + n->acceleration_noise_m_s2 * noisy_gauss(n);
    memmove(n->frames, n->frames + 1, sizeof n->frames - sizeof n->frames[0]);
    f->sequence++;
    f->arrival_us = n->body.time_us + clock_us;
    f->ready = true;
    f->has_acceleration = !n->no_acceleration;
    f->forward_mps2 = 0.0F;
    f->right_mps2 = (float)(felt * sin(roll));
    f->down_mps2 = (float)(felt * cos(roll));
    f->median.roll_rad = (float)noisy_roll(n, NOISY_FRAME_AGE_US + 50000U) +
                         (float)(n->fallen_rad + n->lied_rad);
    f->median.pitch_rad = 0.0F;
    f->level = f->median;
    f->tilt_roll_rad = f->median.roll_rad;
}

static inline void noisy_height(noisy_t *n, flight_inputs_t *in, uint32_t clock_us)
{
    const double roll = noisy_roll(n, 72500U) + n->fallen_rad;
    const double wrong_mm = noisy_uniform(n) < n->glitch ? 350.0 : 0.0;
    const altitude_geometry_t geometry = altitude_geometry_default();
    mirror_range_t range = {.mirror = MIRROR_FRONT, .valid = true, .good_rays = 35U};

    range.slant_mm = (float)(105.0 + (n->body.seen_mm + wrong_mm + 100.0 + 220.0 * sin(roll)) / cos(roll) +
                             n->height_noise_mm * noisy_gauss(n));
    in->altitude = altitude_from_ranges(&geometry, &range, 1, n->frames[NOISY_FRAMES - 1U].median.roll_rad,
                                        0.0F);
    in->height_valid = true;
    in->height_time_us = n->body.time_us - 2000U +
                         clock_us; /* the plant's height comes 2 ms after its last octet */
    in->height_age_us = 70500U;
    in->height_stamp_ms = ((n->body.time_us - 106500U) / 1000U + 77U) & 0xFFFFFFU;
    in->height_sequence++;
}

/* One step of 0.5 ms. clock_us: the firmware's clock at the plant's zero. */
static inline void noisy_step(noisy_t *n, flight_inputs_t *in, uint32_t clock_us)
{
    const double keep = exp(-1e-6 * PLANT_STEP_US / 0.5);

    n->gust_m_s2 = keep * n->gust_m_s2 + n->turbulence_m_s2 * sqrt(1.0 - keep * keep) * noisy_gauss(n);
    n->before_m_s = n->body.speed_m_s;
    plant_step(&n->body);
    if (n->body.height_m > n->body.terrain_m) {
        n->body.speed_m_s += n->gust_m_s2 * PLANT_STEP_US * 1e-6;
    }
    n->felt_m_s2[n->steps++ % 48U] = (n->body.speed_m_s - n->before_m_s) / (PLANT_STEP_US * 1e-6);
    n->released = false;
    if (n->body.time_us % NOISY_FRAME_US == 3000U && !n->imu_mute) {
        noisy_frame(n, clock_us);
        n->released = true;
        in->attitude_time_us = n->body.time_us + clock_us;
        in->roll_rad = n->frames[NOISY_FRAMES - 1U].median.roll_rad;
    }
    if (n->body.height_new) {
        noisy_height(n, in, clock_us);
        n->released = true;
    }
    in->frames = n->frames;
    in->frame_count = NOISY_FRAMES;
    in->now_us = n->body.time_us + clock_us;
}

#endif
