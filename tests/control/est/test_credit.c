/* The weight of the accelerometer, from both sides of each limit. */
#include "control/est/credit.h"
#include "unity.h"

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected, actual)
#define SMOOTH_M 0.004F

static credit_t credit;
static modelled_motion_t model;

void setUp(void)
{
    credit_init(&credit);
    model = (modelled_motion_t){.known = true, .noise_mps2 = 0.8F};
}

void tearDown(void) {}

void test_noise_is_a_sixth_of_the_squared_second_difference_over_fifty_frames(void)
{
    static const struct {
        float before_mps2, first, second, up_mps2, noise_mps2;
    } rows[] = {{0.4F, 1.0F, 0.5F, 2.0F, 0.39703F},  /* 0.16 + 0.02 (0.25 / 6 - 0.16) */
                {0.4F, 0.0F, 0.0F, 50.0F, 0.45607F}, /* clipped at 16 times the variance */
                {0.05F, 0.0F, 0.0F, 0.0F, 0.05F},
                {5.0F, 0.0F, 0.0F, 150.0F, 5.0F}};

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

void test_the_weight_falls_with_the_fourth_power_beyond_two_metres_a_second_squared(void)
{
    static const struct {
        float before_mps2, off_mps2, mean_mps2, share;
    } rows[] = {{0.0F, 1.0F, 0.4F, 0.8F},           /* 0.64 / (0.64 + 0.16) */
                {3.0F, 5.5F, 4.0F, 0.8F * 0.0625F}, /* 3 + 0.4 (5.5 - 3) */
                {-3.0F, -5.5F, -4.0F, 0.8F * 0.0625F},
                {2.2F, 2.2F, 2.2F, 0.8F * 0.68301F}}; /* (2 / 2.2)^4 */

    for (int i = 0; i < 4; i++) {
        credit.off_model_mps2 = rows[i].before_mps2;
        NEAR(rows[i].share, credit_share(&credit, &model, rows[i].off_mps2, SMOOTH_M));
        NEAR(rows[i].mean_mps2, credit.off_model_mps2);
    }
    credit_new_source(&credit);
    NEAR(0.8F, credit_share(&credit, &model, 0.0F, SMOOTH_M));
}

void test_without_a_model_the_accelerometer_has_all_the_weight(void)
{
    model.known = false;
    NEAR(1.0F, credit_share(&credit, &model, 0.0F, SMOOTH_M));
}

/* A frame after which the mean difference from the model is off_mps2. */
static bool accused(float off_mps2, float innovation_m, float noise_mps2)
{
    credit_init(&credit);
    credit.off_model_mps2 = off_mps2;
    credit.mean_innovation_m = innovation_m;
    credit.noise_mps2 = noise_mps2;
    (void)credit_share(&credit, &model, off_mps2, SMOOTH_M);
    return credit_accuses(&credit);
}

void test_thrust_and_heights_accuse_together_and_of_the_same_error(void)
{
    TEST_ASSERT_TRUE(accused(2.01F, -0.0121F, 0.4F));
    NEAR(0.8F * 0.02F, credit_share(&credit, &model, 2.01F, SMOOTH_M));
    TEST_ASSERT_TRUE(accused(-2.01F, 0.0121F, 0.4F));
    TEST_ASSERT_FALSE(accused(1.99F, -0.0121F, 0.4F));
    TEST_ASSERT_FALSE(accused(2.01F, -0.0119F, 0.4F));
    TEST_ASSERT_FALSE(accused(2.01F, 0.0121F, 0.4F));
    TEST_ASSERT_FALSE(accused(2.99F, -0.0121F, 2.0F)); /* 1.5 sigma */
    TEST_ASSERT_TRUE(accused(3.01F, -0.0121F, 2.0F));
}

void test_an_accusation_lasts_32_frames(void)
{
    (void)accused(2.01F, -0.0121F, 0.4F);
    credit_edge(&credit); /* an edge says nothing about the accelerometer */
    for (int left = 31; left > 0; left--) {
        (void)credit_share(&credit, &model, 0.0F, SMOOTH_M);
        TEST_ASSERT_TRUE(credit_accuses(&credit));
    }
    (void)credit_share(&credit, &model, 0.0F, SMOOTH_M);
    TEST_ASSERT_FALSE(credit_accuses(&credit));
}

void test_an_accused_accelerometer_is_used_where_nothing_else_is_there_to_fly_by(void)
{
    (void)accused(2.01F, -0.0121F, 0.4F);
    model.known = false;
    TEST_ASSERT_TRUE(credit_share(&credit, &model, 0.0F, SMOOTH_M) > 0.9F);
    TEST_ASSERT_TRUE(credit_accuses(&credit));
}

void test_after_eight_fused_heights_half_of_an_innovation_counts_against_the_accelerometer(void)
{
    for (int round = 0; round < 2; round++) {
        credit.mean_innovation_m = 0.002F;
        for (int i = 1; i < 8; i++) {
            credit_height(&credit, 0.01F);
            NEAR(0.002F, credit.mean_innovation_m);
        }
        credit_height(&credit, 0.02F);
        NEAR(0.011F, credit.mean_innovation_m);
        credit_height(&credit, 0.01F);
        NEAR(0.0105F, credit.mean_innovation_m);
        credit_edge(&credit); /* and anew */
        TEST_ASSERT_EQUAL_FLOAT(0.0F, credit.mean_innovation_m);
    }
}
