#include "control/sense/mounts.h"

#include <math.h>
#include <stddef.h>

#include "control/seconds.h"

#define LIES 0.5F         /* as in mirrors.c */
#define LEVEL_RAD 0.0873F /* 5 degrees move the front mirror, 220 mm aside, by 19 mm: 3 HEIGHT_SIGMA_M */
#define GAP_S 1.0F        /* any above GAP_LONG_S of plane.c, too long for the plane */

static bool is_honest(const belief_t *belief)
{
    bool honest = true;

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        honest = honest && belief_of_lie(belief, (mirror_t)m) <= LIES;
    }
    return honest;
}

/* Somebody who raises a side (#IMU RIGHT) lifts some mirrors and not others. Asked of any IMU: each wrong way
 * to mount it tells as much. */
static bool is_level(const flight_inputs_t *in)
{
    return fmaxf(fabsf(in->roll_rad), fabsf(in->pitch_rad)) < LEVEL_RAD;
}

static uint16_t axes_of(const parameters_t *parameters)
{
    return (uint16_t)((uint16_t)AXIS_COUNT * parameters_choice(parameters, PARAMETER_IROLL) +
                      parameters_choice(parameters, PARAMETER_IPITCH));
}

/* In TAKEOFF it stands, or is 0.09 m high at most. */
static zeros_place_t place_of(flight_state_t state)
{
    if (state == FLIGHT_GROUND) {
        return ZEROS_REST;
    }
    return (state == FLIGHT_TAKEOFF) ? ZEROS_LIFTED : ZEROS_AWAY;
}

static void look(mounts_t *mounts, const parameters_t *parameters, const flight_inputs_t *in,
                 const mirrors_t *mirrors, flight_state_t state)
{
    const plane_scan_t scan = {
        .shown = in->mirrors,
        .frames = in->frames,
        .frame_count = in->frame_count,
        .rays_us = in->height_time_us - in->height_age_us - (uint32_t)in->altitude.later_us,
        .gap_s = seconds_at_most(in->height_time_us - mounts->time_us, GAP_S),
        .honest = is_honest(&mirrors->belief),
        .rest = state == FLIGHT_GROUND,
        .zeros = &mounts->zeros,
        .axes = axes_of(parameters),
    };
    mounts->sequence = in->height_sequence;
    mounts->time_us = in->height_time_us;
    zeros_scan(&mounts->zeros, in->mirrors, is_level(in) ? place_of(state) : ZEROS_AWAY);
    plane_scan(&mounts->plane, &scan);
}

static flight_mirrors_t found_of(const mounts_t *mounts)
{
    flight_mirrors_t found = {
        .wrong = mounts->zeros.wrong,
        .imu = plane_fault(&mounts->plane),
        .off_roll_rad = mounts->plane.off_known ? mounts->plane.off_rad[0] : NAN,
        .off_pitch_rad = mounts->plane.off_known ? mounts->plane.off_rad[1] : NAN,
    };

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        const zero_t *zero = &mounts->zeros.zeros[m];

        found.rest_mm[m] = (zero->counts > 0U) ? zero->mm : NAN;
    }
    return found;
}

void mounts_step(mounts_t *mounts, const parameters_t *parameters, const flight_inputs_t *in,
                 const mirrors_t *mirrors, flight_outputs_t *out)
{
    const bool is_new = in->mirrors != NULL && in->height_valid && in->height_sequence != mounts->sequence;

    if (parameters_choice(parameters, PARAMETER_LAYOUT) != LAYOUT_THREE) {
        *mounts = (mounts_t){.sequence = in->height_sequence};
    } else if (is_new) {
        look(mounts, parameters, in, mirrors, out->state);
    }
    out->mirrors = found_of(mounts);
    out->imu_fault = imu_axes_worse(out->imu_fault, out->mirrors.imu);
    if (out->mirrors.wrong != 0U || out->mirrors.imu != IMU_SOUND) {
        out->flags |= FLIGHT_FLAG_MIRRORS;
    }
}
