/* Three things lower the weight: noise on the accelerometer, a difference from the thrust model that lasts,
 * and heights that show the same difference. What breaks: the thrust model alone may be wrong in a gust, the
 * heights alone over a slope of the terrain. */
#include "control/est/credit.h"

#include <math.h>

#include "control/between.h"

#define OFF_MODEL_SHARE 0.4F  /* chosen: a mean over three frames */
#define OFF_MODEL_MPS2 2.0F   /* chosen: as ACCUSED_MPS2; full weight below it */
#define ACCUSED_MPS2 2.0F     /* chosen: as OFF_MODEL_MPS2; another airframe is off by 1.5 while it brakes */
#define ACCUSED_SIGMAS 1.5F   /* chosen: of the noise, on a mean of three frames: 3 sigma */
#define ACCUSED_NOISES 3.0F   /* chosen: of the heights' noise; rarer by chance on a mean */
#define ACCUSED_HEIGHTS 8U    /* chosen: an edge is corrected within 0.8 s */
#define ACCUSED_SHARE 0.5F    /* chosen: mean over two heights */
#define ACCUSED_CREDIT 0.02F  /* chosen: next to nothing */
#define CLEARED_FRAMES 32U    /* chosen: 0.8 s, until then doubt IMU has decided */
#define NOISE_START_MPS2 0.4F /* assumed of a Razor on a flying frame */
#define NOISE_MIN_MPS2 0.05F  /* chosen: a limit to the trust in the accelerometer */
#define NOISE_MAX_MPS2 5.0F   /* chosen: never quite ignored */
#define NOISE_SHARE 0.02F     /* chosen: mean over 50 frames */
#define NOISE_CLIP 16.0F      /* chosen: 4 sigma, so that one spike counts little */

void credit_init(credit_t *credit)
{
    *credit = (credit_t){.noise_mps2 = NOISE_START_MPS2};
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

    credit->noise_mps2 = between(NOISE_MIN_MPS2, sqrtf(variance + NOISE_SHARE * (seen - variance)),
                                 NOISE_MAX_MPS2);
    credit->previous_mps2[1] = credit->previous_mps2[0];
    credit->previous_mps2[0] = up_mps2;
}

void credit_new_source(credit_t *credit)
{
    credit->off_model_mps2 = 0.0F;
}

void credit_height(credit_t *credit, float innovation_m)
{
    credit->fused_count = (uint16_t)(credit->fused_count + (credit->fused_count < ACCUSED_HEIGHTS));
    if (credit->fused_count == ACCUSED_HEIGHTS) {
        credit->mean_innovation_m += ACCUSED_SHARE * (innovation_m - credit->mean_innovation_m);
    }
}

void credit_edge(credit_t *credit)
{
    credit->mean_innovation_m =
        0.0F; /* an edge, and the braking after it, say nothing about the accelerometer */
    credit->fused_count = 0U;
}

bool credit_accuses(const credit_t *credit)
{
    return credit->accused_frames > 0U;
}

static float share_by_noise(const credit_t *credit, const modelled_motion_t *model)
{
    const float measured = credit->noise_mps2 * credit->noise_mps2;
    const float modelled = model->noise_mps2 * model->noise_mps2;
    return model->known ? modelled / (modelled + measured) : 1.0F;
}

/* The accelerometer is wrong when thrust model and heights show the same error of it. */
static void accuse(credit_t *credit, float heights_noise_m)
{
    const float off_mps2 = at_least(ACCUSED_MPS2, ACCUSED_SIGMAS * credit->noise_mps2);
    const bool thrust_tells = fabsf(credit->off_model_mps2) > off_mps2;
    const bool heights_tell = fabsf(credit->mean_innovation_m) > ACCUSED_NOISES * heights_noise_m;

    if (thrust_tells && heights_tell && credit->mean_innovation_m * credit->off_model_mps2 < 0.0F) {
        credit->accused_frames = CLEARED_FRAMES;
    } else if (credit->accused_frames > 0U) {
        --credit->accused_frames;
    }
}

/* It falls when the low-passed difference between measured and modelled acceleration is large. When the
 * heights show the error too, it is next to 0 until doubt IMU is decided. */
static float share_by_model(const credit_t *credit, const modelled_motion_t *model)
{
    if (credit_accuses(credit) && model->known) {
        return ACCUSED_CREDIT;
    }
    const float excess = OFF_MODEL_MPS2 / at_least(fabsf(credit->off_model_mps2), OFF_MODEL_MPS2);
    return excess * excess * excess * excess;
}

float credit_share(credit_t *credit, const modelled_motion_t *model, float off_mps2, float heights_noise_m)
{
    credit->off_model_mps2 += OFF_MODEL_SHARE * (off_mps2 - credit->off_model_mps2);
    accuse(credit, heights_noise_m);
    return share_by_noise(credit, model) * share_by_model(credit, model);
}
