#include "control/sense/sway.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define FRAME_S 0.025F

static sway_t sway;
static imu_sample_t frame;

void setUp(void)
{
    memset(&sway, 0, sizeof sway);
    memset(&frame, 0, sizeof frame);
}

void tearDown(void) {}

/* One frame near the ground. */
static void tilt(float roll_rad, float pitch_rad)
{
    frame.median.roll_rad = roll_rad;
    frame.median.pitch_rad = pitch_rad;
    sway_frame(&sway, &frame, 0.05F, FRAME_S);
}

/* Ten seconds to and fro by that much, both angles together, to either side of a mean. */
static void swing(float rms_rad, float mean_rad)
{
    setUp();
    for (int i = 0; i < 400; i++) {
        const float rad = (i % 2 == 0) ? rms_rad : -rms_rad;
        tilt(mean_rad + 0.8F * rad, 0.6F * rad - mean_rad);
    }
}

void test_the_sway_of_both_angles_together_is_that_of_the_air_beyond_1_1_degrees_rms(void)
{
    swing(0.0198F, 0.0F);
    TEST_ASSERT_FALSE(sway_as_in_the_air(&sway) || sway_is_calm(&sway));
    swing(0.0204F, 0.0F);
    TEST_ASSERT_TRUE(sway_as_in_the_air(&sway));
    swing(0.0154F, 0.0F); /* below 0.9 degrees it is calm; between, neither is sure */
    TEST_ASSERT_TRUE(sway_is_calm(&sway));
    swing(0.0162F, 0.0F);
    TEST_ASSERT_FALSE(sway_is_calm(&sway));
    swing(0.10F, 0.0F); /* a hand tilts it by more than six */
    TEST_ASSERT_TRUE(sway_is_no_hand(&sway));
    swing(0.12F, 0.0F);
    TEST_ASSERT_FALSE(sway_is_no_hand(&sway));
}

void test_a_lasting_tilt_is_no_sway(void)
{
    swing(0.01F, 0.03F);
    TEST_ASSERT_TRUE(sway_is_calm(&sway));
}

/* 1.5 s: after that time from standstill 1 - 1/e of the square is there. */
void test_a_sway_shows_in_a_second_and_a_half(void)
{
    for (int frames = 50; frames <= 70; frames += 20) {
        setUp();
        for (int i = 0; i < frames; i++) {
            tilt((i % 2 == 0) ? 0.0252F : -0.0252F, 0.0F);
        }
        TEST_ASSERT_EQUAL(frames == 70, sway_as_in_the_air(&sway));
    }
}

/* Frames of noise after the sway has gone: how many are needed until it does not rock. */
static int frames_until_still(float roll_rad, float pitch_rad)
{
    int frames = 0;

    while (sway_rocks(&sway) && frames < 200) {
        tilt(roll_rad, pitch_rad);
        frames++;
    }
    return frames;
}

void test_it_rocks_for_0_8_s_after_a_move_of_a_degree_of_either_angle(void)
{
    static const struct {
        float roll_rad, pitch_rad;
        bool rocks;
    } rows[] = {{0.0165F, 0.0F, false},
                {0.0175F, 0.0F, true},
                {0.0F, -0.0165F, false},
                {0.0F, -0.0175F, true},
                {-0.0175F, 0.0F, true}};
    for (int i = 0; i < 5; i++) {
        swing(0.1F, 0.0F);
        tilt(0.0F, 0.0F);
        for (int k = 0; k < 20; k++) {
            tilt(0.0F, 0.0F);
        }
        TEST_ASSERT_TRUE(sway_rocks(&sway));
        const int frames = frames_until_still(rows[i].roll_rad, rows[i].pitch_rad);
        TEST_ASSERT_INT_WITHIN(1, rows[i].rocks ? 33 : 12, frames);
    }
}

void test_the_next_move_is_measured_from_where_it_has_come_to(void)
{
    swing(0.1F, 0.0F);
    tilt(0.0F, 0.0F);
    for (int i = 1; i <= 60; i++) { /* creeping: each degree is a move */
        tilt(0.002F * (float)i, 0.0F);
        TEST_ASSERT_TRUE(sway_rocks(&sway));
    }
}

void test_a_calm_tilt_does_not_rock(void)
{
    swing(0.0154F, 0.0F);
    tilt(0.05F, 0.0F);
    TEST_ASSERT_FALSE(sway_rocks(&sway) && sway_is_calm(&sway));
    for (int i = 0; i < 400; i++) {
        tilt(0.05F, 0.0F);
    }
    TEST_ASSERT_FALSE(sway_rocks(&sway));
}

/* Higher than a decimetre what sways rocks. */
void test_the_moves_are_looked_at_near_the_ground_alone(void)
{
    for (int high = 0; high < 2; high++) {
        swing(0.1F, 0.0F);
        frame.median.roll_rad = frame.median.pitch_rad = 0.0F;
        for (int i = 0; i < 60; i++) {
            sway_frame(&sway, &frame, (high != 0) ? 0.09F : 0.089F, FRAME_S);
        }
        TEST_ASSERT_TRUE(sway_as_in_the_air(&sway));
        TEST_ASSERT_EQUAL(high != 0, sway_rocks(&sway));
    }
}

void test_frames_without_accelerations_have_a_clock_of_their_own(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        setUp();
        frame.arrival_us = 1000000U;
        frame.median.roll_rad = 0.5F;
        sway_frame_alone(&sway, &frame, 0.05F);
        TEST_ASSERT_TRUE(sway_is_calm(&sway)); /* the first after long */
        frame.arrival_us += 300000U + more_us;
        sway_frame_alone(&sway, &frame, 0.05F);
        TEST_ASSERT_EQUAL(more_us == 0U, sway_as_in_the_air(&sway));
    }
}
