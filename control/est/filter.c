/* The update is Joseph's form, because the short form loses its symmetry in 32-bit floats. Theory: any text
 * on Kalman filters. What breaks: a covariance that is not symmetric or not bounded lets a state diverge.
 * Constants marked "fitted": docs/control.md; make tune LAW=EST ARGS="--constants est" searches them again.
 */
#include "control/est/filter.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"

#define HEIGHT_DRIFT_M 0.0047F /* fitted; m per root second */
#define TERRAIN_TIME_S 1.0F    /* chosen: a slope lasts about a second */
#define REST_SIGMA_MPS 0.02F   /* chosen: a vehicle on the ground may shake */
#define VARIANCE_MIN \
    1.0e-7F /* of any state: the rounding of 32-bit floats, FLT_EPSILON, of one of 1 \
             */

/* Variance of a figure of which nothing is known but that it lies within -most .. most. */
#define UNIFORM(most) ((most) * (most) / 3.0F)

/* Of height (m2), speed (m2/s2), bias (m2/s4), terrain rate (m2/s2): within what they can be (credible.h);
 * the height within 0 .. HEIGHT_MAX_MM. */
static const float variance_max[FILTER_STATES] = {UNIFORM(0.5e-3F * HEIGHT_MAX_MM), UNIFORM(SPEED_MAX_MPS),
                                                  UNIFORM(BIAS_MAX_MPS2), UNIFORM(SPEED_MAX_MPS)};
/* chosen: 1 cm, 0.2 m/s, 0.3 m/s2, 0.05 m/s */
static const float variance_start[FILTER_STATES] = {1.0e-4F, 0.04F, 0.09F, 0.0025F};

static inline float *covariance_of(float p[FILTER_STATES][FILTER_STATES], uint16_t i, uint16_t j)
{
    return (i < j) ? &p[i][j] : &p[j][i];
}

/* Gives one state a new variance and removes its covariances with the other states. */
void filter_reset_variance(filter_t *filter, filter_state_t state, float variance)
{
    for (uint16_t i = 0U; i < FILTER_STATES; ++i) {
        *covariance_of(filter->covariance, (uint16_t)state, i) = 0.0F;
    }
    filter->covariance[state][state] = variance;
}

void filter_reset_covariance(filter_t *filter)
{
    for (uint16_t i = 0U; i < FILTER_STATES; ++i) {
        filter_reset_variance(filter, (filter_state_t)i, variance_start[i]);
    }
}

static void bound_states(estimate_t *x)
{
    x->speed_mps = between(-SPEED_MAX_MPS, x->speed_mps, SPEED_MAX_MPS);
    x->bias_mps2 = between(-BIAS_MAX_MPS2, x->bias_mps2, BIAS_MAX_MPS2);
    x->terrain_mps = between(-SPEED_MAX_MPS, x->terrain_mps, SPEED_MAX_MPS);
}

estimate_t filter_moved(const estimate_t *estimate, const motion_t *motion, float dt_s)
{
    const float acceleration_mps2 = motion->up_mps2 - motion->share * estimate->bias_mps2;
    estimate_t x = *estimate;

    x.height_m += (x.speed_mps - x.terrain_mps + 0.5F * acceleration_mps2 * dt_s) * dt_s;
    x.speed_mps += acceleration_mps2 * dt_s;
    x.terrain_mps *= at_least(1.0F - dt_s / TERRAIN_TIME_S, 0.0F);
    bound_states(&x);
    return x;
}

static float limit_variance(float p[FILTER_STATES][FILTER_STATES], uint16_t state)
{
    const float scale = sqrtf(variance_max[state] / p[state][state]);

    for (uint16_t j = 0U; j < FILTER_STATES; ++j) {
        *covariance_of(p, state, j) *= scale;
    }
    return p[state][state] * scale;
}

/* Row and column are scaled together, so that the matrix stays positive. */
static inline void bound_variance(float p[FILTER_STATES][FILTER_STATES], uint16_t state)
{
    float variance = p[state][state];

    if (variance > variance_max[state]) {
        variance = limit_variance(p, state);
    }
    p[state][state] = at_least(variance, VARIANCE_MIN);
}

static inline void bound_covariance(float p[FILTER_STATES][FILTER_STATES])
{
    bound_variance(p, FILTER_HEIGHT);
    bound_variance(p, FILTER_SPEED);
    bound_variance(p, FILTER_BIAS);
    bound_variance(p, FILTER_TERRAIN);
}

/* P = F P F' + Q, on one half of the symmetric matrix. Row of F: height 1, dt, -half, -dt; speed 0, 1,
 * -slope, 0; bias 0, 0, 1, 0; terrain 0, 0, 0, decay. */
static void predict_covariance(filter_t *filter, const motion_t *motion, float dt_s,
                               const filter_drift_t *drift)
{
    float(*const p)[FILTER_STATES] = filter->covariance;
    const float decay = at_least(1.0F - dt_s / TERRAIN_TIME_S, 0.0F);
    const float slope = motion->share * dt_s;
    const float half = 0.5F * slope * dt_s;
    const float speed_bias = p[FILTER_SPEED][FILTER_BIAS] - slope * p[FILTER_BIAS][FILTER_BIAS];
    const float height_speed = p[FILTER_HEIGHT][FILTER_SPEED] +
                               dt_s * (p[FILTER_SPEED][FILTER_SPEED] - p[FILTER_SPEED][FILTER_TERRAIN]) -
                               half * p[FILTER_SPEED][FILTER_BIAS];
    const float height_bias = p[FILTER_HEIGHT][FILTER_BIAS] +
                              dt_s * (p[FILTER_SPEED][FILTER_BIAS] - p[FILTER_BIAS][FILTER_TERRAIN]) -
                              half * p[FILTER_BIAS][FILTER_BIAS];
    const float height_terrain = p[FILTER_HEIGHT][FILTER_TERRAIN] +
                                 dt_s *
                                     (p[FILTER_SPEED][FILTER_TERRAIN] - p[FILTER_TERRAIN][FILTER_TERRAIN]) -
                                 half * p[FILTER_BIAS][FILTER_TERRAIN];

    p[FILTER_HEIGHT][FILTER_HEIGHT] += dt_s * (p[FILTER_HEIGHT][FILTER_SPEED] -
                                               p[FILTER_HEIGHT][FILTER_TERRAIN]) -
                                       half * p[FILTER_HEIGHT][FILTER_BIAS] +
                                       dt_s * (height_speed - height_terrain) - half * height_bias +
                                       HEIGHT_DRIFT_M * HEIGHT_DRIFT_M * dt_s;
    p[FILTER_HEIGHT][FILTER_SPEED] = height_speed - slope * height_bias;
    p[FILTER_HEIGHT][FILTER_BIAS] = height_bias;
    p[FILTER_HEIGHT][FILTER_TERRAIN] = height_terrain * decay;
    p[FILTER_SPEED][FILTER_SPEED] += motion->drift * dt_s -
                                     slope * (p[FILTER_SPEED][FILTER_BIAS] + speed_bias);
    p[FILTER_SPEED][FILTER_TERRAIN] = (p[FILTER_SPEED][FILTER_TERRAIN] -
                                       slope * p[FILTER_BIAS][FILTER_TERRAIN]) *
                                      decay;
    p[FILTER_SPEED][FILTER_BIAS] = speed_bias;
    p[FILTER_BIAS][FILTER_BIAS] += drift->bias_mps2 * drift->bias_mps2 * dt_s;
    p[FILTER_BIAS][FILTER_TERRAIN] *= decay;
    p[FILTER_TERRAIN][FILTER_TERRAIN] = p[FILTER_TERRAIN][FILTER_TERRAIN] * decay * decay +
                                        drift->terrain_mps * drift->terrain_mps * dt_s;
    bound_covariance(p);
}

/* One row of P - K row' + K (R K - (row - K row))'. */
static inline void correct_row(float *p, uint16_t i, const float *row, const float *gain, uint16_t state,
                               float variance)
{
    const float more = variance * gain[i] - (row[i] - gain[i] * row[state]);

    for (uint16_t j = i; j < FILTER_STATES; ++j) {
        p[j] += gain[j] * more - gain[i] * row[j];
    }
}

/* A measurement of one state: Joseph's form, which keeps the covariance positive in spite of rounding. Only
 * one half of the symmetric matrix is kept, so it stays symmetric. */
void filter_correct(filter_t *filter, filter_state_t state, float innovation, float variance)
{
    float(*const p)[FILTER_STATES] = filter->covariance;
    const float per_sum = 1.0F / (p[state][state] + variance);
    float row[FILTER_STATES];
    float gain[FILTER_STATES];

    for (uint16_t i = 0U; i < FILTER_STATES; ++i) {
        row[i] = *covariance_of(p, (uint16_t)state, i);
        gain[i] = row[i] * per_sum;
    }
    filter->estimate.height_m += gain[FILTER_HEIGHT] * innovation;
    filter->estimate.speed_mps += gain[FILTER_SPEED] * innovation;
    filter->estimate.bias_mps2 += gain[FILTER_BIAS] * innovation;
    filter->estimate.terrain_mps += gain[FILTER_TERRAIN] * innovation;
    correct_row(p[FILTER_HEIGHT], FILTER_HEIGHT, row, gain, (uint16_t)state, variance);
    correct_row(p[FILTER_SPEED], FILTER_SPEED, row, gain, (uint16_t)state, variance);
    correct_row(p[FILTER_BIAS], FILTER_BIAS, row, gain, (uint16_t)state, variance);
    correct_row(p[FILTER_TERRAIN], FILTER_TERRAIN, row, gain, (uint16_t)state, variance);
    bound_states(&filter->estimate);
    bound_covariance(p);
}

void filter_predict(filter_t *filter, const motion_t *motion, float dt_s, const filter_drift_t *drift)
{
    filter->estimate = filter_moved(&filter->estimate, motion, dt_s);
    predict_covariance(filter, motion, dt_s, drift);
}

void filter_bound(filter_t *filter)
{
    bound_states(&filter->estimate);
}

float filter_variance_start(filter_state_t state)
{
    return variance_start[state];
}

float filter_variance_most(filter_state_t state)
{
    return variance_max[state];
}

void filter_stand(filter_t *filter)
{
    const float variance = REST_SIGMA_MPS * REST_SIGMA_MPS;

    filter_correct(filter, FILTER_SPEED, -filter->estimate.speed_mps, variance);
    filter_correct(filter, FILTER_TERRAIN, -filter->estimate.terrain_mps, variance);
}
