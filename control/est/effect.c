#include "control/est/effect.h"

#include "control/between.h"

#define SLOW_S 0.2F         /* tried 0.1 to 0.3: the motions of a pilot are slower */
#define MEAN_S 1.5F         /* tried 1 to 2.5: 60 frames; a longer mean tells the hand-back later */
#define SHARE_ON 0.75F      /* chosen: a pilot's own motions make up to 0.6 for a moment */
#define SHARE_OFF 0.55F     /* chosen: below that */
#define SHARE_LEAST 0.45F   /* tried 0.4 to 0.6: half of what an effect makes */
#define CHANCE 0.03F        /* chosen: m2/s4; of small changes the share is uncertain by so much */
#define PRODUCT_MIN 0.01F   /* chosen: m2/s4; less tells nothing */
#define SWINGS_MOST 0.6F    /* tried: m2/s4; a pilot who swings it makes commands that go along with him */
#define CORRELATION_2 0.09F /* tried 0.06 to 0.16: a correlation of 0.3; below it the share may be chance */

void effect_init(effect_t *effect)
{
    *effect = (effect_t){.has_effect = false};
}

/* Least product that shows an effect. */
static float least_product(const effect_t *effect)
{
    const float changes = effect->pushed_2;

    if (effect->has_effect) {
        return SHARE_OFF * changes - CHANCE;
    }
    return at_least(at_least(SHARE_ON * changes - CHANCE, SHARE_LEAST * changes), PRODUCT_MIN);
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

    const bool sure = effect->running_s >= MEAN_S && effect->pushed_2 < SWINGS_MOST &&
                      effect->product * effect->product > CORRELATION_2 * effect->pushed_2 * effect->felt_2;
    effect->has_effect = effect->product > least_product(effect) && (effect->has_effect || sure);
}
