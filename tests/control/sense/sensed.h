/* The sensors for the tests of sense/: one frame, one cycle, one height at a time, in the order of
 * sense_step(). */
#ifndef TESTS_CONTROL_SENSED_H
#define TESTS_CONTROL_SENSED_H

#include "control/sense/sense.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define G_MPS2 9.80665F
#define DEGREE_RAD 0.0174532925F
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, expected, actual)
#define VERY_NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, expected, actual)

static inline void sensed_frames(sense_t *it, const command_t *flown, const imu_sample_t *frames,
                                 uint16_t count)
{
    senses_frames(&it->senses, flown, frames, count);
    if (flown->grounded) {
        verdict_rest(&it->verdict, &it->senses.accelerometer);
    }
}

static inline void sensed_thrust(sense_t *it, const command_t *flown)
{
    if (flown->ordered && flown->grounded) {
        verdict_order(&it->verdict, &it->senses);
    }
    senses_thrust(&it->senses, flown, (it->verdict.doubts & DOUBT_IMU) == 0U);
}

static inline void sensed_height(sense_t *it, const command_t *flown, float height_m, float gap_s,
                                 float age_s)
{
    const height_change_t change = senses_height(&it->senses, height_m, gap_s, age_s,
                                                 (it->verdict.doubts & DOUBT_SIGHT) == 0U);
    verdict_height(&it->verdict, &it->senses, flown, &change);
}

static inline bool sensed_doubts(const sense_t *it, uint16_t doubt)
{
    return (it->verdict.doubts & doubt) != 0U;
}

static inline float sensed_felt_mps(const sense_t *it)
{
    const accelerometer_t *accelerometer = &it->senses.accelerometer;

    return verdict_felt_valid(&it->verdict, &it->senses)
               ? accelerometer->felt.speed_mps / accelerometer->shaken
               : 0.0F;
}

#endif
