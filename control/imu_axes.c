/* Compares two tilts once a frame: the mean of the IMU's angles, and the tilt by the mean of the measured
 * gravity. A disagreement that lasts is a fault. Its name is the first change of sign or of axis that would
 * remove it. So a tilt about one axis alone names that axis.
 * What breaks: use the angles with their offset, because the measured gravity contains it too. */
#include "control/imu_axes.h"

#include <math.h>

#include "control/credible.h"

#define SHARE_OF_TILT 0.2F /* chosen: a wrong sign makes 2, a wrong axis 1, a moving hand less than 0.2 */
/* Halfway between a change that removes all of the disagreement and one that removes nothing: the noise of
 * both is the same, so this is the likeliest border. */
#define MENDED_SHARE 0.5F
#define NOISE_RAD_PER_MPS2 0.04F /* five sigma of the mean: 5 sqrt(25 ms / 4 s) / g */

typedef struct {
    float roll_rad, pitch_rad;
} tilt_t;

void imu_axes_init(imu_axes_t *axes)
{
    *axes = (imu_axes_t){.fault = IMU_SOUND};
}

static float apart_rad(tilt_t a, tilt_t b)
{
    return fmaxf(fabsf(a.roll_rad - b.roll_rad), fabsf(a.pitch_rad - b.pitch_rad));
}

static float size_rad(tilt_t tilt)
{
    return fmaxf(fabsf(tilt.roll_rad), fabsf(tilt.pitch_rad));
}

/* Which change of the angles would make them agree with gravity. Angles below a tenth (chosen) of gravity's
 * tilt are radians that were read as degrees: that makes 1/57. */
static imu_fault_t name_of(tilt_t told, tilt_t felt, float left_rad)
{
    const tilt_t changed[IMU_FAULT_COUNT] = {
        [IMU_ROLL] = {-told.roll_rad, told.pitch_rad},
        [IMU_PITCH] = {told.roll_rad, -told.pitch_rad},
        [IMU_BOTH] = {-told.roll_rad, -told.pitch_rad},
    };
    const tilt_t other = {told.pitch_rad, told.roll_rad};
    const tilt_t opposite = {-told.pitch_rad, -told.roll_rad};
    const tilt_t crossed = {told.pitch_rad, -told.roll_rad};
    const tilt_t back = {-told.pitch_rad, told.roll_rad};

    for (uint16_t i = IMU_ROLL; i <= IMU_BOTH; ++i) {
        if (apart_rad(changed[i], felt) <= left_rad) {
            return (imu_fault_t)i;
        }
    }
    if (fminf(fminf(apart_rad(other, felt), apart_rad(opposite, felt)),
              fminf(apart_rad(crossed, felt), apart_rad(back, felt))) <= left_rad) {
        return IMU_SWAPPED;
    }
    return (size_rad(told) < 0.1F * size_rad(felt)) ? IMU_RADIANS : IMU_OTHER;
}

static imu_fault_t judge(const imu_axes_t *axes, float noise_mps2)
{
    const float level_mps2 = hypotf(axes->right_mps2, axes->down_mps2);
    const float size_mps2 = hypotf(axes->forward_mps2, level_mps2);
    const tilt_t told = {axes->roll_rad, axes->pitch_rad};
    const tilt_t felt = {atan2f(axes->right_mps2, axes->down_mps2), atan2f(-axes->forward_mps2, level_mps2)};
    const float apart = apart_rad(told, felt);
    const float least_rad = fmaxf(IMU_OFFSET_RAD, NOISE_RAD_PER_MPS2 * noise_mps2);

    if (fabsf(size_mps2 - IMU_GRAVITY_MPS2) > IMU_UNIT_SHARE * IMU_GRAVITY_MPS2) {
        return IMU_UNIT;
    }
    if (axes->down_mps2 < 0.0F) {
        return IMU_DOWN;
    }
    if (apart <= least_rad + SHARE_OF_TILT * size_rad(felt) || size_rad(felt) > IMU_STEEP_RAD) {
        return IMU_SOUND;
    }
    return name_of(told, felt, fmaxf(MENDED_SHARE * apart, least_rad));
}

static void decide(imu_axes_t *axes, imu_fault_t seen, float dt_s)
{
    axes->suspected_s = (seen == axes->suspected) ? axes->suspected_s + dt_s : 0.0F;
    axes->suspected = seen;
    if (axes->suspected_s > REST_HELD_S) {
        axes->suspected_s = REST_HELD_S;
        axes->fault = seen;
    }
}

static void average(imu_axes_t *axes, const imu_sample_t *frame, float noise_mps2)
{
    const float dt_s = (float)(frame->arrival_us - axes->time_us) * 1.0e-6F;

    axes->time_us = frame->arrival_us;
    axes->seen_s = (dt_s <= FRAME_GAP_S) ? fminf(axes->seen_s + dt_s, IMU_AXES_SEEN_S) : 0.0F;
    const float share = (axes->seen_s > 0.0F) ? fminf(dt_s / fminf(axes->seen_s, REST_TIME_S), 1.0F) : 1.0F;
    axes->forward_mps2 += share * (frame->forward_mps2 - axes->forward_mps2);
    axes->right_mps2 += share * (frame->right_mps2 - axes->right_mps2);
    axes->down_mps2 += share * (frame->down_mps2 - axes->down_mps2);
    axes->roll_rad += share * (frame->tilt_roll_rad - axes->roll_rad);
    axes->pitch_rad += share * (frame->tilt_pitch_rad - axes->pitch_rad);
    if (axes->seen_s >= IMU_AXES_SEEN_S) {
        decide(axes, judge(axes, noise_mps2), dt_s);
    }
}

void imu_axes_step(imu_axes_t *axes, const imu_sample_t *frames, uint16_t count, bool grounded,
                   float noise_mps2)
{
    for (uint16_t i = imu_first_after(frames, count, axes->sequence); i < count; ++i) {
        const imu_sample_t *frame = &frames[i];

        axes->sequence = frame->sequence;
        if (grounded && frame->ready && frame->has_acceleration) {
            average(axes, frame, noise_mps2);
        } else {
            axes->seen_s = 0.0F;
            axes->suspected_s = 0.0F;
        }
    }
}

static const char *const names[] = {
    [IMU_SOUND] = "-",         [IMU_UNIT] = "UNIT",   [IMU_DOWN] = "DOWN",       [IMU_OFFSET] = "OFFSET",
    [IMU_ROLL] = "ROLL",       [IMU_PITCH] = "PITCH", [IMU_BOTH] = "ROLL+PITCH", [IMU_SWAPPED] = "SWAPPED",
    [IMU_RADIANS] = "RADIANS", [IMU_OTHER] = "ANGLES"};
typedef char every_fault_has_a_name[(sizeof names / sizeof names[0] == IMU_FAULT_COUNT) ? 1 : -1];

const char *imu_fault_name(imu_fault_t fault)
{
    return names[fault];
}

imu_fault_t imu_axes_worse(imu_fault_t by_gravity, imu_fault_t by_mirrors)
{
    const bool instead = by_gravity == IMU_SOUND || (by_gravity < IMU_ROLL && by_mirrors >= IMU_ROLL);

    return instead ? by_mirrors : by_gravity;
}

bool imu_axes_forbid(imu_fault_t fault, const parameters_t *parameters)
{
    const float *value = parameters->value;
    const bool delivered = value[PARAMETER_IROLL] == parameter_table[PARAMETER_IROLL].initial &&
                           value[PARAMETER_IPITCH] == parameter_table[PARAMETER_IPITCH].initial;

    return parameters_choice(parameters, PARAMETER_IAXES) == AXES_ASSUMED &&
           (fault >= IMU_ROLL || !delivered);
}
