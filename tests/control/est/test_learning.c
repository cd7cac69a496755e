/* What one frame teaches, and what it must not. */
#include "control/est/learning.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected, actual)
#define AUTHORITY 1.4F /* m/s2 per N */

static hover_t hover, hover_before;
static deadband_t deadband;
static estimator_t e;
static lesson_t lesson;

void setUp(void)
{
    hover_init(&hover, 7.0F, 0.1F, 5.0F, 9.0F);
    hover_before = hover;
    deadband = (deadband_t){0.2F};
    estimator_init(&e);
    e.now.height_m = 0.5F;
    lesson = (lesson_t){
        .vehicle = {.authority_mps2_per_n = AUTHORITY,
                    .damping_per_s = 2.5F,
                    .need_n = 7.0F,
                    .upright = 1.0F},
        .delivered_n = 7.0F,
        .confirmed = true,
        .dt_s = 0.025F,
    };
}

void tearDown(void) {}

static void learn(float up_mps2)
{
    e.up_mps2 = up_mps2;
    learning_by_accelerations(&hover, &deadband, &e, &lesson);
}

/* Newton: thrust less what climb and drag took; its noise: the accelerometer's and 0.33 per m/s. */
void test_the_hover_thrust_is_learned_by_newton(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        setUp();
        e.now.speed_mps = 0.4F * side;
        e.now.bias_mps2 = -0.3F * side;
        lesson.vehicle.upright = 0.95F;
        learn(1.0F * side);
        hover_step(&hover_before, 7.0F * 0.95F - (1.3F * side + 2.5F * 0.4F * side) / AUTHORITY,
                   0.4F / AUTHORITY + 0.33F * 0.4F, 0.025F);
        NEAR(hover_before.thrust_n, hover.thrust_n);
        NEAR(hover_before.variance_n2, hover.variance_n2);
        TEST_ASSERT_TRUE(fabsf(hover.thrust_n - 7.0F) > 0.001F);
    }
}

void test_nothing_is_learned_that_no_height_confirms_and_gusts_are_forgotten(void)
{
    for (int why = 0; why < 2; why++) {
        setUp();
        hover.gust_n = 0.4F;
        lesson.confirmed = why != 0;
        e.unchecked_count = (why == 1) ? 1U : 0U;
        learn(1.0F);
        NEAR(7.0F, hover.thrust_n);
        NEAR(0.4F * (1.0F - 0.025F / 0.76F), hover.gust_n);
    }
}

void test_near_the_ground_only_more_thrust_is_believed(void)
{
    e.now.height_m = 0.035F;
    learn(1.0F);
    NEAR(7.0F, hover.thrust_n);
    learn(-1.0F);
    TEST_ASSERT_TRUE(hover.thrust_n > 7.001F);
    setUp();
    e.now.height_m = 0.045F;
    learn(1.0F);
    TEST_ASSERT_TRUE(hover.thrust_n < 6.999F);
}

/* The bias of the filter moves into the hover thrust within 3 s. */
void test_without_accelerations_the_models_error_becomes_hover_thrust(void)
{
    static const struct {
        bool confirmed;
        float most_n, moved_n;
    } rows[] = {{true, 9.0F, 0.025F / 3.0F * 0.6F / AUTHORITY}, {false, 9.0F, 0.0F}, {true, 7.001F, 0.001F}};

    for (int i = 0; i < 3; i++) {
        setUp();
        e.now.bias_mps2 = e.filter.estimate.bias_mps2 = 0.6F;
        lesson.confirmed = rows[i].confirmed;
        hover.most_n = rows[i].most_n;
        learning_by_model(&hover, &deadband, &e, &lesson);
        NEAR(7.0F + rows[i].moved_n, hover.thrust_n);
        NEAR(0.6F - rows[i].moved_n * AUTHORITY, e.now.bias_mps2);
    }
}

void test_the_dead_band_of_a_climb_rate_autopilot_is_learned_in_the_air(void)
{
    for (int low = 0; low < 2; low++) {
        for (int felt = 0; felt < 2; felt++) {
            deadband_t expected = {0.2F};

            setUp();
            lesson.is_climb = true;
            lesson.delivered_n = 7.4F;
            lesson.vehicle.need_n = 7.15F;
            e.now.height_m = (low != 0) ? 0.035F : 0.05F;
            e.now.bias_mps2 = (felt != 0) ? 0.0F : 0.6F;
            if (felt != 0) {
                learn(0.0F);
                deadband_learn(&expected, 7.4F - hover.thrust_n, 7.4F - hover.thrust_n, 0.025F);
            } else {
                learning_by_model(&hover, &deadband, &e, &lesson);
                deadband_learn(&expected, 0.4F, 0.15F, 0.1F * 0.025F);
                NEAR(7.0F + 0.025F / 3.0F * 0.6F / AUTHORITY, hover.thrust_n);
            }
            TEST_ASSERT_FLOAT_WITHIN(2.0e-5F, (low != 0) ? 0.2F : expected.band_n, deadband.band_n);
        }
    }
}

void test_a_plain_autopilot_has_no_dead_band_to_learn(void)
{
    learn(1.0F);
    NEAR(0.2F, deadband.band_n);
}
