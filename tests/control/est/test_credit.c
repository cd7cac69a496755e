/* The weight of the accelerometer, from both sides of each limit. */
#include "control/est/credit.h"
#include "unity.h"

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected, actual)

static credit_t credit;
static modelled_motion_t model;

void setUp(void)
{
    credit_init(&credit);
    model = (modelled_motion_t){.known = true, .noise_mps2 = 0.8F};
}

void tearDown(void) {}

void test_noise_is_a_sixth_of_the_squared_second_difference_over_forty_frames(void)
{
    static const struct {
        float before_mps2, first, second, up_mps2, noise_mps2;
    } rows[] = {{0.4F, 1.0F, 0.5F, 2.0F, 0.396285F},  /* 0.16 + (0.25 / 6 - 0.16) / 40 */
                {0.4F, 0.0F, 0.0F, 50.0F, 0.469042F}, /* clipped at 16 times the variance */
                {0.0383F, 0.0F, 0.0F, 0.0F, 9.80665F / 256.0F},
                {5.0F, 0.0F, 0.0F, 150.0F, 5.86302F}};

    NEAR(0.4F, credit.noise_mps2);
    for (int i = 0; i < 4; i++) {
        credit.noise_mps2 = rows[i].before_mps2;
        credit_restart(&credit, rows[i].second);
        credit.previous_mps2[0] = rows[i].first;
        credit_measure_noise(&credit, rows[i].up_mps2);
        NEAR(rows[i].noise_mps2, credit.noise_mps2);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, rows[i].up_mps2, credit.previous_mps2[0]);
        NEAR(rows[i].first, credit.previous_mps2[1]);
    }
}

void test_the_weight_is_the_models_variance_in_both(void)
{
    NEAR(0.8F, credit_share(&credit, &model)); /* 0.64 / (0.64 + 0.16) */
    credit.noise_mps2 = 1.6F;
    NEAR(0.2F, credit_share(&credit, &model));
}

/* 0.64 / (0.64 + 0.09 + 0.16 / 40): the noise of a frame counts little where errors add up. */
void test_an_error_that_lasts_takes_the_place_of_the_noise(void)
{
    model.bias_mps2 = 0.3F;
    NEAR(0.871935F, credit_share(&credit, &model));
}

void test_without_a_model_the_accelerometer_has_all_the_weight(void)
{
    model.known = false;
    NEAR(1.0F, credit_share(&credit, &model));
}
