/* Noise on the accelerometer lowers the weight. What breaks: the thrust model may be wrong in a gust, so the
 * accelerometer is never left out: doubt IMU of sense/ does that. */
#include "control/est/credit.h"

#include <math.h>

#include "control/between.h"
#include "control/imu_sample.h"

#define NOISE_MIN_MPS2 (IMU_GRAVITY_MPS2 / 256.0F) /* one count of the Razor */
#define FRAMES_IN_A_SECOND 40.0F                   /* of 25 ms; the noise is their mean */
#define NOISE_CLIP (4.0F * 4.0F) /* 4 sigma of what is measured, one in 16 000: a spike counts little */

void credit_init(credit_t *credit)
{
    *credit = (credit_t){.noise_mps2 = CREDIT_NOISE_MPS2};
}

void credit_restart(credit_t *credit, float up_mps2)
{
    credit->previous_mps2[0] = up_mps2;
    credit->previous_mps2[1] = up_mps2;
}

/* The second difference of white noise has six times its variance; what the vehicle does adds little to it.
 */
void credit_measure_noise(credit_t *credit, float up_mps2)
{
    const float difference_mps2 = up_mps2 - 2.0F * credit->previous_mps2[0] + credit->previous_mps2[1];
    const float variance = credit->noise_mps2 * credit->noise_mps2;
    const float seen = at_most(difference_mps2 * difference_mps2 / 6.0F, NOISE_CLIP * variance);

    credit->noise_mps2 = at_least(sqrtf(variance + (seen - variance) / FRAMES_IN_A_SECOND), NOISE_MIN_MPS2);
    credit->previous_mps2[1] = credit->previous_mps2[0];
    credit->previous_mps2[0] = up_mps2;
}

/* With heights an error counts until the next one, and the noise of a frame is the most of it. Without them
 * errors add up: those that last do, and of the noise the mean of a second is left. */
static float measured_variance(const credit_t *credit, const modelled_motion_t *model)
{
    const float noise = credit->noise_mps2 * credit->noise_mps2;
    const float bias = model->bias_mps2 * model->bias_mps2;

    return (bias > 0.0F) ? bias + noise / FRAMES_IN_A_SECOND : noise;
}

float credit_share(const credit_t *credit, const modelled_motion_t *model)
{
    const float measured = measured_variance(credit, model);
    const float modelled = model->noise_mps2 * model->noise_mps2;

    return model->known ? modelled / (modelled + measured) : 1.0F;
}
