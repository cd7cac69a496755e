/* The filter against its own equations, one step at a time: Kalman's, written with full matrices as a text
 * book has them, and each limit from both sides. */
#include "control/est/filter.h"
#include "unity.h"

#include <string.h>

#define N FILTER_STATES
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected, actual)

static filter_t filter;

/* Small variances without correlations. */
void setUp(void)
{
    memset(&filter, 0, sizeof filter);
    filter_reset_covariance(&filter);
}

void tearDown(void) {}

static void predict(float dt_s, float up_mps2, float share)
{
    const motion_t motion = {.up_mps2 = up_mps2, .share = share};
    const filter_drift_t drift = {0.095F, 0.053F};

    filter_predict(&filter, &motion, dt_s, &drift);
}

void test_it_begins_with_nothing_but_assumptions(void)
{
    static const float start[N] = {1.0e-4F, 0.04F, 0.09F, 0.0025F};

    memset(&filter, 0x55, sizeof filter);
    filter_reset_covariance(&filter);
    for (uint16_t i = 0U; i < N; i++) {
        TEST_ASSERT_EQUAL_FLOAT(start[i], filter_variance_start((filter_state_t)i));
        for (uint16_t j = i; j < N; j++) {
            TEST_ASSERT_EQUAL_FLOAT((i == j) ? start[i] : 0.0F, filter.covariance[i][j]);
        }
    }
}

/* P = F P F' + Q. */
static void textbook(float p[N][N], float share, float dt, const float q[N])
{
    const float f[N][N] = {{1.0F, dt, -0.5F * share * dt * dt, -dt},
                           {0.0F, 1.0F, -share * dt, 0.0F},
                           {0.0F, 0.0F, 1.0F, 0.0F},
                           {0.0F, 0.0F, 0.0F, 1.0F - dt}};
    float fp[N][N] = {{0.0F}};

    for (unsigned i = 0; i < N; i++) {
        for (unsigned j = 0; j < N; j++) {
            for (unsigned k = 0; k < N; k++) {
                fp[i][j] += f[i][k] * p[k][j];
            }
        }
    }
    for (unsigned i = 0; i < N; i++) {
        for (unsigned j = 0; j < N; j++) {
            p[i][j] = (i == j) ? q[i] : 0.0F;
            for (unsigned k = 0; k < N; k++) {
                p[i][j] += fp[i][k] * f[j][k];
            }
        }
    }
}

static const float correlated[N][N] = {{0.30F, 0.08F, -0.05F, 0.06F},
                                       {0.08F, 0.25F, 0.07F, -0.04F},
                                       {-0.05F, 0.07F, 0.15F, 0.03F},
                                       {0.06F, -0.04F, 0.03F, 0.12F}};

void test_the_covariance_is_propagated_as_the_text_book_says(void)
{
    static const float bias_drifts[] = {0.095F, 0.4F};

    for (unsigned k = 0; k < 2U; k++) {
        const motion_t motion = {.up_mps2 = 0.7F, .share = 0.8F, .drift = 0.05F};
        const float q[N] = {0.0047F * 0.0047F * 0.2F, 0.05F * 0.2F, bias_drifts[k] * bias_drifts[k] * 0.2F,
                            0.053F * 0.053F * 0.2F};
        float p[N][N];

        memcpy(p, correlated, sizeof p);
        memcpy(filter.covariance, correlated, sizeof p);
        filter_predict(&filter, &motion, 0.2F, &(filter_drift_t){bias_drifts[k], 0.053F});
        textbook(p, 0.8F, 0.2F, q);
        for (unsigned i = 0; i < N; i++) {
            for (unsigned j = i; j < N; j++) {
                TEST_ASSERT_FLOAT_WITHIN(5.0e-7F, p[i][j], filter.covariance[i][j]);
            }
        }
    }
}

void test_the_state_moves_as_its_equations_say(void)
{
    filter.estimate = (estimate_t){
        .height_m = 0.5F, .speed_mps = 0.3F, .bias_mps2 = 0.2F, .terrain_mps = 0.1F};
    predict(0.2F, 1.0F, 0.5F);
    NEAR(0.5F + (0.3F - 0.1F) * 0.2F + 0.5F * 0.9F * 0.04F, filter.estimate.height_m);
    NEAR(0.3F + 0.9F * 0.2F, filter.estimate.speed_mps);
    NEAR(0.2F, filter.estimate.bias_mps2);
    NEAR(0.08F, filter.estimate.terrain_mps);
}

void test_after_more_than_a_second_nothing_of_a_slope_is_left(void)
{
    filter.estimate.terrain_mps = 0.4F;
    filter.covariance[FILTER_TERRAIN][FILTER_TERRAIN] = 0.2F;
    predict(1.2F, 0.0F, 1.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, filter.estimate.terrain_mps);
    NEAR(0.053F * 0.053F * 1.2F, filter.covariance[FILTER_TERRAIN][FILTER_TERRAIN]);
}

void test_speed_bias_and_slope_have_limits(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        filter.estimate = (estimate_t){
            .speed_mps = 4.1F * side, .bias_mps2 = 1.6F * side, .terrain_mps = 4.1F * side};
        predict(1.0e-6F, 0.0F, 0.0F);
        NEAR(4.0F * side, filter.estimate.speed_mps);
        NEAR(1.5F * side, filter.estimate.bias_mps2);
        NEAR(4.0F * side, filter.estimate.terrain_mps);
        filter.estimate = (estimate_t){
            .speed_mps = 3.9F * side, .bias_mps2 = 1.4F * side, .terrain_mps = 0.49F * side};
        filter_bound(&filter);
        NEAR(3.9F * side, filter.estimate.speed_mps);
        NEAR(1.4F * side, filter.estimate.bias_mps2);
        NEAR(0.49F * side, filter.estimate.terrain_mps);
        filter.estimate.speed_mps = 4.1F * side;
        filter_bound(&filter);
        NEAR(4.0F * side, filter.estimate.speed_mps);
    }
}

/* Row and column shrink together: a variance of 1.44 times its limit by 1.44, its covariances by 1.2. */
void test_a_variance_has_limits_and_shrinks_with_its_row(void)
{
    for (unsigned state = 0; state < N; state++) {
        const float most = filter_variance_most((filter_state_t)state);

        for (unsigned i = 0; i < N; i++) {
            for (unsigned j = i; j < N; j++) {
                filter.covariance[i][j] = (i == j) ? 0.05F : 0.012F;
            }
        }
        filter.covariance[state][state] = 1.44F * most;
        predict(1.0e-7F, 0.0F, 0.0F);
        for (unsigned i = 0; i < N; i++) {
            for (unsigned j = i; j < N; j++) {
                const float other = (i == state || j == state) ? 0.01F : 0.012F;
                TEST_ASSERT_FLOAT_WITHIN(3.0e-6F,
                                         (i != j)       ? other
                                         : (i == state) ? most
                                                        : 0.05F,
                                         filter.covariance[i][j]);
            }
        }
        memset(filter.covariance, 0, sizeof filter.covariance);
        predict(1.0e-7F, 0.0F, 0.0F);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-10F, 1.0e-7F, filter.covariance[state][state]);
    }
    TEST_ASSERT_EQUAL_FLOAT(2.5F * 2.5F / 3.0F,
                            filter_variance_most(FILTER_HEIGHT)); /* anywhere within 0 .. 5 m */
    TEST_ASSERT_EQUAL_FLOAT(16.0F / 3.0F, filter_variance_most(FILTER_TERRAIN));
}

/* As sure as the filter: half of it, and what is correlated follows. */
void test_a_correction_is_shared_by_the_variances(void)
{
    memset(filter.covariance, 0, sizeof filter.covariance);
    filter.estimate.height_m = 0.5F;
    filter.covariance[FILTER_HEIGHT][FILTER_HEIGHT] = 1.0e-4F;
    filter.covariance[FILTER_HEIGHT][FILTER_SPEED] = 1.0e-5F;
    filter.covariance[FILTER_SPEED][FILTER_SPEED] = 0.04F;
    filter_correct(&filter, FILTER_HEIGHT, 0.01F, 1.0e-4F);
    NEAR(0.505F, filter.estimate.height_m);
    NEAR(0.01F * 0.05F, filter.estimate.speed_mps);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-9F, 0.5e-4F, filter.covariance[FILTER_HEIGHT][FILTER_HEIGHT]);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-9F, 0.5e-5F, filter.covariance[FILTER_HEIGHT][FILTER_SPEED]);
}

void test_a_correction_leaves_each_variance_a_least_one(void)
{
    memset(filter.covariance, 0, sizeof filter.covariance);
    filter_correct(&filter, FILTER_HEIGHT, 0.0F, 1.0e-6F);
    for (unsigned i = 0; i < N; i++) {
        TEST_ASSERT_FLOAT_WITHIN(1.0e-9F, 1.0e-7F, filter.covariance[i][i]);
    }
}

void test_a_reset_variance_has_no_correlations_left(void)
{
    memcpy(filter.covariance, correlated, sizeof filter.covariance);
    filter_reset_variance(&filter, FILTER_BIAS, 0.03F);
    for (unsigned i = 0; i < N; i++) {
        for (unsigned j = i; j < N; j++) {
            const float expected = (i != FILTER_BIAS && j != FILTER_BIAS) ? correlated[i][j] : 0.0F;
            TEST_ASSERT_EQUAL_FLOAT((i == FILTER_BIAS && j == i) ? 0.03F : expected, filter.covariance[i][j]);
        }
    }
}
