/* Means of the squares of roll and pitch, and the time since they last moved.
 * What breaks: between SWAY_RAD2 and SWAY_AIR_RAD2 neither the ground nor the air is certain, so a vehicle
 * that is neither calm nor swaying is common. */
#include "control/sense/sway.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"

#define SWAY_RAD2 2.5e-4F     /* chosen: 0.9 degrees rms, both angles together; in the air it sways more */
#define SWAY_AIR_RAD2 4.0e-4F /* chosen: 1.1 degrees rms; between this and SWAY_RAD2 neither is certain */
#define SWAY_HAND_RAD2 0.012F /* chosen: 6 degrees rms; who tilts a vehicle by hand tilts it more */
#define ROCKED_RAD 0.017F     /* 1 degree: four sigma of an angle's noise, 0.25 degrees, razor9dof.h */
#define ROCKED_BELOW_M LOW_M  /* as in touchdown.h */
#define ROCKED_S 0.8F         /* chosen: 32 frames; at 0.5 s 2 of 96 blocked flights rested in the air */

static void measure_sway(sway_t *sway, const imu_sample_t *frame, float dt_s)
{
    const float share = dt_s / SWAY_TIME_S; /* dt_s is at most FRAME_GAP_US */
    const float roll_rad = frame->median.roll_rad - sway->mean_rad[0];
    const float pitch_rad = frame->median.pitch_rad - sway->mean_rad[1];

    sway->mean_rad[0] += share * roll_rad;
    sway->mean_rad[1] += share * pitch_rad;
    const float rad2 = roll_rad * roll_rad + pitch_rad * pitch_rad;
    sway->sway_rad2 += share * (rad2 - sway->sway_rad2);
}

/* How long the tilt has stayed where it is, near the ground. This ends within a second of a touchdown, where
 * sway_rad2 takes three. */
static void measure_rocking(sway_t *sway, const imu_sample_t *frame, float dt_s)
{
    const bool moved = fabsf(frame->median.roll_rad - sway->anchor_rad[0]) > ROCKED_RAD ||
                       fabsf(frame->median.pitch_rad - sway->anchor_rad[1]) > ROCKED_RAD;

    sway->unrocked_s = moved ? 0.0F : at_most(sway->unrocked_s + dt_s, ROCKED_S);
    if (moved) {
        sway->anchor_rad[0] = frame->median.roll_rad;
        sway->anchor_rad[1] = frame->median.pitch_rad;
    }
}

void sway_frame(sway_t *sway, const imu_sample_t *frame, float height_m, float dt_s)
{
    measure_sway(sway, frame, dt_s);
    if (height_m < ROCKED_BELOW_M) {
        measure_rocking(sway, frame, dt_s);
    } else {
        sway->unrocked_s = 0.0F;
    }
}

void sway_frame_alone(sway_t *sway, const imu_sample_t *frame, float height_m)
{
    const uint32_t gap_us = frame->arrival_us - sway->alone_us;

    sway->alone_us = frame->arrival_us;
    if (gap_us <= FRAME_GAP_US) {
        sway_frame(sway, frame, height_m, (float)gap_us * 1.0e-6F);
    }
}

bool sway_as_in_the_air(const sway_t *sway)
{
    return sway->sway_rad2 > SWAY_AIR_RAD2;
}

bool sway_is_calm(const sway_t *sway)
{
    return sway->sway_rad2 < SWAY_RAD2;
}

bool sway_rocks(const sway_t *sway)
{
    return sway->unrocked_s < ROCKED_S && sway->sway_rad2 > SWAY_RAD2;
}

bool sway_is_no_hand(const sway_t *sway)
{
    return sway->sway_rad2 < SWAY_HAND_RAD2;
}
