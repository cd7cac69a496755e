#include "control/est/effect.h"

#include <math.h>

#include "control/between.h"
#include "control/est/credit.h"

#define SLOW_S 0.2F      /* tried 0.1 to 0.3: the motions of a pilot are slower */
#define MEAN_S 1.5F      /* tried 1 to 2.5: 60 frames; a longer mean tells the hand-back later */
#define SWINGS_MOST 0.6F /* tried: m2/s4; a pilot who swings it makes commands that go along with him */
#define HALF 0.5F        /* of what an effect makes: as far from all of it as from none */
#define SURE_SIGMAS 2.0F /* to either side of it: 95 of 100 means by chance are within */

void effect_init(effect_t *effect)
{
    *effect = (effect_t){.has_effect = false};
}

/* Standard deviation of the product by chance: a mean of white noise that forgets in MEAN_S counts
 * 2 MEAN_S / dt_s samples. An accelerometer that shows less than its noise tells nothing. */
static float chance(const effect_t *effect, float dt_s)
{
    const float felt_2 = at_least(effect->felt_2, CREDIT_NOISE_MPS2 * CREDIT_NOISE_MPS2);

    return sqrtf(effect->pushed_2 * felt_2 * dt_s / (2.0F * MEAN_S));
}

void effect_step(effect_t *effect, float pushed_mps2, float felt_mps2, float dt_s)
{
    const float slow = (effect->running_s > 0.0F) ? at_most(dt_s / SLOW_S, 1.0F) : 1.0F;
    const float mean = at_most(dt_s / MEAN_S, 1.0F);

    effect->pushed_mps2 += slow * (pushed_mps2 - effect->pushed_mps2);
    effect->felt_mps2 += slow * (felt_mps2 - effect->felt_mps2);
    const float pushed = pushed_mps2 - effect->pushed_mps2;
    const float felt = felt_mps2 - effect->felt_mps2;
    effect->product += mean * (pushed * felt - effect->product);
    effect->pushed_2 += mean * (pushed * pushed - effect->pushed_2);
    effect->felt_2 += mean * (felt * felt - effect->felt_2);
    effect->running_s = at_most(effect->running_s + dt_s, MEAN_S);

    const float beyond_half = effect->product - HALF * effect->pushed_2;
    const float doubt = SURE_SIGMAS * chance(effect, dt_s);
    const bool may_show = effect->running_s >= MEAN_S && effect->pushed_2 < SWINGS_MOST;
    effect->has_effect = effect->has_effect ? beyond_half > -doubt : may_show && beyond_half > doubt;
}
