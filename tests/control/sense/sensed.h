/* The sensors one by one, and the verdict on them, for the tests of sense/: one frame, one cycle, one height at a
 * time. How a cycle asks them: test_sense.c. */
#ifndef TESTS_CONTROL_SENSED_H
#define TESTS_CONTROL_SENSED_H

#include "control/sense/senses.h"
#include "control/sense/verdict.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define G_MPS2 9.80665F
#define DEGREE_RAD 0.0174532925F
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, expected, actual)
#define VERY_NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, expected, actual)

static senses_t senses;
static verdict_t verdict;

static inline void sensed_begin(void)
{
    senses_init(&senses);
    memset(&verdict, 0, sizeof verdict);
}

static inline void sensed_frames(const command_t *flown, const imu_sample_t *frames, uint16_t count)
{
    senses_frames(&senses, flown, frames, count);
    if (flown->grounded) {
        verdict_rest(&verdict, &senses.accelerometer);
    }
}

static inline void sensed_thrust(const command_t *flown)
{
    if (flown->ordered && flown->grounded) {
        verdict_order(&verdict, &senses);
    }
    senses_thrust(&senses, flown, (verdict.doubts & DOUBT_IMU) == 0U);
}

static inline void sensed_height(const command_t *flown, float height_m, float gap_s, float age_s)
{
    const height_change_t change = senses_height(&senses, height_m, gap_s, age_s,
                                                 (verdict.doubts & DOUBT_SIGHT) == 0U);
    verdict_height(&verdict, &senses, flown, &change);
}

static inline bool sensed_doubts(uint16_t doubt)
{
    return (verdict.doubts & doubt) != 0U;
}

static inline float sensed_felt_mps(void)
{
    const accelerometer_t *accelerometer = &senses.accelerometer;

    return verdict_felt_valid(&verdict, &senses) ? accelerometer->felt.speed_mps / accelerometer->shaken
                                                 : 0.0F;
}

#endif
