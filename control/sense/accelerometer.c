/* A third-order observer, corrected slowly by the heights. It has a bias of its own: the estimator's bias
 * also contains errors of the thrust model, so with it a wrong thrust model would move both witnesses. What
 * breaks: a bias that is learned while something lies. So it follows in 8 s. */
#include "control/sense/accelerometer.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/sense/sway.h"

#define REST_UNFIT_MPS2 BIAS_MAX_MPS2          /* no estimate represents more */
#define REST_FIT_MPS2 (0.8F * REST_UNFIT_MPS2) /* chosen: hysteresis of a fifth */

#define SHAKEN_MPS2 0.9F     /* chosen: about twice the usual noise, CREDIT_NOISE_MPS2 in credit.h */
#define STANDING_TIME_S 1.0F /* chosen: on the ground the felt speed decays, the bias must not add up */
#define STANDING_WAY_S (2.0F * STANDING_TIME_S) /* nor its way: 0.1 m/s2 make 0.2 m */
#define FELT_LEAK_PER_S 1.8F   /* chosen: 2 x 0.9, critically damped without the bias, poles at 0.9 1/s */
#define FELT_PULL_PER_S2 0.81F /* 0.9 squared, see FELT_LEAK_PER_S */
#define BIAS_PULL_PER_S3 0.1F  /* chosen: the bias follows in 8 s, 0.81 / 0.1; slower than the verdicts */

#define IN_HANDS_MOST_S 2.0F /* the counter stops here */

void accelerometer_init(accelerometer_t *accelerometer)
{
    *accelerometer = (accelerometer_t){.shaken = 1.0F};
}

float accelerometer_mean_mps2(accelerometer_t *accelerometer, uint32_t time_us, float up_mps2,
                              uint32_t *gap_us)
{
    const float mean_mps2 = 0.5F * (accelerometer->up_mps2 + up_mps2);

    *gap_us = time_us - accelerometer->time_us;
    accelerometer->time_us = time_us;
    accelerometer->up_mps2 = up_mps2;
    return mean_mps2;
}

void accelerometer_restart(accelerometer_t *accelerometer, float speed_mps)
{
    accelerometer->rested_s = 0.0F;
    accelerometer->rest_mps2 = accelerometer->up_mps2;
    witness_start(&accelerometer->felt, speed_mps);
}

/* Keeps the bias of three to four seconds ago: the end of a rest is noticed late. */
static void keep_bias(accelerometer_t *accelerometer, float dt_s)
{
    accelerometer->block_s += dt_s;
    if (accelerometer->block_s > REST_HELD_S) {
        accelerometer->block_s = 0.0F;
        for (uint16_t k = 1U; k < ACCELEROMETER_BLOCKS; ++k) {
            accelerometer->kept_bias_mps2[k - 1U] = accelerometer->kept_bias_mps2[k];
        }
        accelerometer->kept_bias_mps2[ACCELEROMETER_BLOCKS - 1U] = accelerometer->bias_mps2;
    }
}

void accelerometer_rest(accelerometer_t *accelerometer, float dt_s)
{
    accelerometer->in_hands_s = accelerometer->beyond_s = 0.0F;
    keep_bias(accelerometer, dt_s);
    accelerometer->rested_s = at_most(accelerometer->rested_s + dt_s, REST_TIME_S);
    accelerometer->rest_mps2 += at_most(dt_s / accelerometer->rested_s, 1.0F) *
                                (accelerometer->up_mps2 - accelerometer->rest_mps2);
    accelerometer->measured = accelerometer->measured || accelerometer->rested_s > REST_HELD_S;
    if (!accelerometer->measured || accelerometer->rested_s > REST_HELD_S) {
        accelerometer->bias_mps2 = accelerometer->rest_mps2;
    }
    witness_start(&accelerometer->felt, 0.0F);
}

rest_t accelerometer_judge_rest(const accelerometer_t *accelerometer)
{
    if (accelerometer->rested_s > REST_HELD_S && fabsf(accelerometer->rest_mps2) > REST_UNFIT_MPS2) {
        return REST_UNFIT;
    }
    return (accelerometer->rested_s > REST_HELD_S && fabsf(accelerometer->rest_mps2) < REST_FIT_MPS2)
               ? REST_FIT
               : REST_UNKNOWN;
}

void accelerometer_in_hands(accelerometer_t *accelerometer, float mean_mps2, bool counts, float dt_s)
{
    witness_t *felt = &accelerometer->felt;

    accelerometer->in_hands_s = counts ? at_most(accelerometer->in_hands_s + dt_s, IN_HANDS_MOST_S) : 0.0F;
    if (accelerometer->rested_s > 0.0F) {
        accelerometer->bias_mps2 = accelerometer->kept_bias_mps2[0];
    }
    accelerometer->rested_s = 0.0F;
    const float mps2 = mean_mps2 - accelerometer->bias_mps2;
    felt->speed_mps += mps2 * dt_s - felt->speed_mps * dt_s / ACCELEROMETER_IN_HANDS_S;
    accelerometer->bias_mps2 += mps2 * dt_s / ACCELEROMETER_IN_HANDS_BIAS_S;
}

void accelerometer_was_lifted(accelerometer_t *accelerometer, float rise_mps)
{
    if (accelerometer->rested_s > 0.0F) {
        accelerometer->bias_mps2 = accelerometer->kept_bias_mps2[0];
        witness_start(&accelerometer->felt, rise_mps);
    }
}

void accelerometer_move(accelerometer_t *accelerometer, float mean_mps2, bool standing, float dt_s)
{
    witness_t *felt = &accelerometer->felt;

    accelerometer->rested_s = 0.0F;
    witness_move(felt, mean_mps2 - accelerometer->bias_mps2, dt_s);
    if (standing) {
        felt->speed_mps *= 1.0F - dt_s / STANDING_TIME_S;
        felt->off_m *= 1.0F - dt_s / STANDING_WAY_S;
        felt->running_s = 0.0F;
    }
}

void accelerometer_set_noise(accelerometer_t *accelerometer, float noise_mps2)
{
    const float shaken = at_least(noise_mps2 / SHAKEN_MPS2, 1.0F);

    accelerometer->shaken = shaken * sqrtf(shaken);
}

void accelerometer_compare(accelerometer_t *accelerometer, float rise_m, float gap_s, float age_s,
                           bool believed)
{
    witness_t *felt = &accelerometer->felt;
    const float age = felt->running_s / WITNESS_OLD_S;
    const float pull = believed ? age : 0.0F;

    witness_compare(felt, rise_m, gap_s, age_s, FELT_LEAK_PER_S * age, FELT_PULL_PER_S2 * pull);
    accelerometer->bias_mps2 -= BIAS_PULL_PER_S3 * pull * gap_s * felt->seen_m;
    accelerometer->beyond_s = (fabsf(accelerometer->bias_mps2) < BIAS_MAX_MPS2)
                                  ? 0.0F
                                  : at_most(accelerometer->beyond_s + gap_s, 2.0F * REST_HELD_S);
    accelerometer->bias_mps2 = between(-BIAS_MAX_MPS2, accelerometer->bias_mps2, BIAS_MAX_MPS2);
}

bool accelerometer_is_beyond(const accelerometer_t *accelerometer)
{
    return accelerometer->beyond_s > REST_HELD_S;
}

bool accelerometer_is_in_hands(const accelerometer_t *accelerometer)
{
    return accelerometer->in_hands_s > SWAY_TIME_S;
}
