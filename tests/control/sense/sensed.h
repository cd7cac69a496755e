/* The sensors one by one, and the verdict on them, for the tests of sense/: one frame, one cycle, one height
 * at a time. How a cycle asks them: test_sense.c. */
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
    memset(&senses, 0, sizeof senses);
    senses_init(&senses);
    memset(&verdict, 0, sizeof verdict);
}

/* ---- what they are taken to have shown */

static inline void sways_rad2(float sway_rad2)
{
    senses.sway.sway_rad2 = sway_rad2;
}

static inline void doubted(uint16_t doubts)
{
    verdict.doubts = doubts;
}

/* By the mirrors of the latest scan, with 99 %. */
static inline void all_lie(bool lie)
{
    senses.mirrors.blind = lie;
}

static inline void one_sees_a_motion(bool sees)
{
    senses.mirrors.sees = sees;
}

static inline void accelerometer_lies(bool lies)
{
    senses.mirrors.felt_lies = lies;
}

/* For so long no bias has explained what it tells. */
static inline void bias_is_beyond_s(float beyond_s)
{
    senses.accelerometer.bias_mps2 = 1.6F;
    senses.accelerometer.beyond_s = beyond_s;
}

static inline void has_no_effect(bool no_effect)
{
    senses.mirrors.unpushed = senses.mirrors.no_effect = no_effect;
}

static inline void stirs(bool stirs)
{
    senses.mirrors.stirs = stirs;
}

static inline void has_told_the_contrary_for_s(float contrary_s)
{
    verdict.contrary_s = contrary_s;
}

static inline void rises_mps(float rise_mps)
{
    senses.heights.rise_mps = rise_mps;
}

static inline void is_unconfirmed(bool unconfirmed)
{
    senses.confirmation.unconfirmed = unconfirmed;
}

static inline void is_proved(bool proved)
{
    senses.confirmation.proved = proved;
}

static inline void content_for_s(float quiet_s)
{
    senses.confirmation.quiet_s = quiet_s;
}

static inline void came_near_at_m(float near_m)
{
    senses.confirmation.near_m = near_m;
}

static inline void terrain_fell(bool fell)
{
    senses.confirmation.terrain_fell = fell;
}

static inline void pushes_n(float lagged_n)
{
    senses.push.lagged_n = lagged_n;
}

static inline void at_m(float height_m)
{
    senses.heights.height_m = height_m;
}

static inline void stands(bool standing)
{
    senses.standing = standing;
}

static inline void felt_is(witness_t felt)
{
    senses.accelerometer.felt = felt;
}

static inline void pushed_is(witness_t pushed)
{
    senses.push.pushed = pushed;
}

static inline void shaken_by(float shaken)
{
    senses.accelerometer.shaken = shaken;
}

static inline void has_rested_s(float rested_s)
{
    senses.accelerometer.rested_s = rested_s;
}

static inline void rests_at_mps2(float rest_mps2)
{
    senses.accelerometer.rest_mps2 = rest_mps2;
}

static inline void bias_is_mps2(float bias_mps2)
{
    senses.accelerometer.bias_mps2 = bias_mps2;
}

static inline void in_hands_for_s(float in_hands_s)
{
    senses.accelerometer.in_hands_s = in_hands_s;
}

static inline void calm_for_s(float calm_s)
{
    senses.stand.calm_s = calm_s;
}

static inline void stood_for_s(float stands_s)
{
    senses.stand.stands_s = stands_s;
}

static inline void unrocked_for_s(float unrocked_s)
{
    senses.sway.unrocked_s = unrocked_s;
}

/* ---- one frame, one cycle, one height */

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
