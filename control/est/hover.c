/* Two estimates of the needed thrust. The hover thrust is a one-state Kalman filter, slow, with a variance,
 * as PX4's hover thrust estimator. The gust thrust is quick, with a fixed gain, and decays in 0.8 s. What
 * breaks: with one estimate alone, either the hover thrust follows gusts and the vehicle sinks when they end,
 * or the filter needs seconds to find the mass. Constants marked "fitted": docs/control.md; make tune LAW=EST
 * ARGS="--constants est" searches them again. */
#include "control/est/hover.h"

#include "control/between.h"

#define DRIFT_N2_PER_S 0.00038F /* fitted: battery and mass, 20 mN per root second */
#define SLOW_SHARE 6.6F         /* fitted: noise counts more here than among gusts */
#define GUST_RATE_PER_S 2.1F    /* fitted */
#define GUST_NOISE_N 0.48F      /* fitted: above this noise gusts are followed less */
#define GUST_TIME_S 0.76F       /* fitted: how long a gust lasts */
#define GUST_MAX_N 1.07F /* five sigma of the strongest air of plan.py: 5 * 0.3 m/s2 * 7 N / 9.81 m/s2 */

void hover_init(hover_t *hover, float thrust_n, float sigma_n, float least_n, float most_n)
{
    *hover = (hover_t){
        .thrust_n = between(least_n, thrust_n, most_n),
        .variance_n2 = sigma_n * sigma_n,
        .least_n = least_n,
        .most_n = most_n,
    };
}

void hover_fade_gust(hover_t *hover, float dt_s)
{
    hover->gust_n *= at_least(1.0F - dt_s / GUST_TIME_S, 0.0F);
}

void hover_step(hover_t *hover, float seen_n, float noise_n, float dt_s)
{
    const float noise_n2 = SLOW_SHARE * noise_n * noise_n;
    const float unexplained_n = seen_n - hover->thrust_n - hover->gust_n;
    const float quiet = at_most(GUST_NOISE_N * GUST_NOISE_N / (noise_n * noise_n), 1.0F);
    const float gust_share = at_most(GUST_RATE_PER_S * quiet * dt_s, 1.0F);

    hover->variance_n2 += DRIFT_N2_PER_S * dt_s;
    const float gain = hover->variance_n2 / (hover->variance_n2 + noise_n2);
    hover->thrust_n = between(hover->least_n, hover->thrust_n + gain * (seen_n - hover->thrust_n),
                              hover->most_n);
    hover->variance_n2 *= 1.0F - gain;
    hover->gust_n = between(-GUST_MAX_N, hover->gust_n + gust_share * unexplained_n, GUST_MAX_N);
    hover_fade_gust(hover, dt_s);
}

void hover_nudge(hover_t *hover, float more_n)
{
    hover->gust_n = between(-GUST_MAX_N, hover->gust_n + more_n, GUST_MAX_N);
}
