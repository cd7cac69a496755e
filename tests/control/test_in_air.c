/* What a line may change in the air. What bursts of them cost a hover: tests/integration/test_bursts.c. */
#include "control/in_air.h"

#include <string.h>

#include "unity.h"

#define HOVER_N 7.4F

static in_air_pace_t pace;
static parameters_t set;
static uint32_t now_us;

void setUp(void)
{
    memset(&pace, 0, sizeof pace);
    parameters_init(&set);
    now_us = 0xFFFFFF00U; /* the clock wraps */
}

void tearDown(void) {}

static in_air_t change(parameter_id_t id, float to)
{
    const in_air_t verdict = in_air_change(&pace, &set, id, to, HOVER_N, now_us);

    if (verdict == IN_AIR_FINE) {
        TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&set, id, to));
    }
    return verdict;
}

void test_newtons_change_by_a_fifth_of_one_within_ten_seconds_however_many_lines_come(void)
{
    parameters_set(&set, PARAMETER_DSAT, 1.0F);
    TEST_ASSERT_EQUAL(IN_AIR_TOO_MANY_N, change(PARAMETER_GRAV, 6.75F));
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_GRAV, 6.9F));
    now_us += 5000000U;
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_GRAV, 6.81F));
    TEST_ASSERT_EQUAL(IN_AIR_TOO_MANY_N, change(PARAMETER_GRAV, 6.75F));
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_GRAV, 7.0F)); /* back */
    now_us += 4999999U;
    TEST_ASSERT_EQUAL(IN_AIR_TOO_MANY_N, change(PARAMETER_GRAV, 7.3F));
    now_us += 1U;
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_GRAV, 7.19F));
    TEST_ASSERT_EQUAL_MESSAGE(IN_AIR_FINE, change(PARAMETER_USAT, 1.19F), "each has its own");
}

void test_a_gain_changes_by_a_quarter_and_none_comes_from_nothing(void)
{
    static const parameter_id_t gains[] = {PARAMETER_KP,   PARAMETER_KD,    PARAMETER_KI,   PARAMETER_PKP,
                                           PARAMETER_PKI,  PARAMETER_PKD,   PARAMETER_POSK, PARAMETER_VELK,
                                           PARAMETER_GAIN, PARAMETER_DELAY, PARAMETER_LAG,  PARAMETER_DAMP,
                                           PARAMETER_CLAG, PARAMETER_CRATE};

    for (size_t i = 0; i < sizeof gains / sizeof gains[0]; i++) {
        const float from = set.value[gains[i]];

        TEST_ASSERT_EQUAL(IN_AIR_OVER_QUARTER, change(gains[i], from * 0.74F));
        TEST_ASSERT_EQUAL(IN_AIR_OVER_QUARTER, change(gains[i], from * 1.26F));
        TEST_ASSERT_EQUAL(IN_AIR_FINE, change(gains[i], from * 0.76F));
        TEST_ASSERT_EQUAL(IN_AIR_OVER_QUARTER, change(gains[i], from * 0.7F));
        TEST_ASSERT_EQUAL_MESSAGE(IN_AIR_OVER_QUARTER, change(gains[i], from * 1.2F),
                                  "of what it is now too");
    }
    parameters_set(&set, PARAMETER_KI, 0.0F);
    now_us += 20000000U;
    TEST_ASSERT_EQUAL(IN_AIR_OVER_QUARTER, change(PARAMETER_KI, 0.001F));
}

void test_a_law_changes_once_within_ten_seconds_and_to_est_at_any_time(void)
{
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_LAW, (float)LAW_PID));
    TEST_ASSERT_EQUAL(IN_AIR_TOO_OFTEN, change(PARAMETER_LAW, (float)LAW_PD));
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_LAW, (float)LAW_EST));
    TEST_ASSERT_EQUAL(IN_AIR_TOO_OFTEN, change(PARAMETER_LAW, (float)LAW_PID));
    now_us += 10000000U;
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_LAW, (float)LAW_PD));
}

/* Where PD and PID cannot give the hover thrust they fall or climb away. */
void test_the_hover_thrust_stays_between_what_the_seeds_laws_can_give(void)
{
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_GRAV, 7.05F));
    TEST_ASSERT_EQUAL_MESSAGE(IN_AIR_OFF_HOVER, change(PARAMETER_GRAV, 7.15F), "0.25 N left below");
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_USAT, 0.81F));
    now_us += 10000000U;
    TEST_ASSERT_EQUAL_MESSAGE(IN_AIR_OFF_HOVER, change(PARAMETER_USAT, 0.62F), "0.27 N left above");
    parameters_set(&set, PARAMETER_GRAV, 6.3F); /* on the ground: out of reach already */
    TEST_ASSERT_EQUAL(IN_AIR_OFF_HOVER, change(PARAMETER_GRAV, 6.2F));
    TEST_ASSERT_EQUAL(IN_AIR_OFF_HOVER, change(PARAMETER_USAT, 0.7F));
    TEST_ASSERT_EQUAL_MESSAGE(IN_AIR_FINE, change(PARAMETER_USAT, 1.0F), "nearer");
}

void test_with_no_window_gravity_may_step_within_reach_of_the_hover_thrust(void)
{
    parameters_set(&set, PARAMETER_USAT, 0.0F);
    parameters_set(&set, PARAMETER_DSAT, 0.0F);
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_GRAV, 7.4F));
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_GRAV, 6.0F));
    TEST_ASSERT_EQUAL(IN_AIR_OFF_HOVER, change(PARAMETER_GRAV, 5.8F));
    TEST_ASSERT_EQUAL(IN_AIR_OFF_HOVER, change(PARAMETER_GRAV, 9.0F));
    TEST_ASSERT_EQUAL(IN_AIR_TOO_MANY_N, change(PARAMETER_USAT, 1.0F));
}

/* A battery has taken the hover thrust 2 N away from GRAV. */
void test_gravity_may_come_nearer_to_a_hover_thrust_that_went_away(void)
{
    TEST_ASSERT_EQUAL(IN_AIR_OFF_HOVER, in_air_change(&pace, &set, PARAMETER_GRAV, 6.8F, 9.4F, now_us));
    TEST_ASSERT_EQUAL(IN_AIR_FINE, in_air_change(&pace, &set, PARAMETER_GRAV, 7.1F, 9.4F, now_us));
}

void test_the_throttles_owner_the_imus_axes_and_the_mirrors_places_wait_for_the_ground(void)
{
    TEST_ASSERT_EQUAL(IN_AIR_NEVER, change(PARAMETER_SEL, (float)SEL_PIN));
    TEST_ASSERT_EQUAL(IN_AIR_NEVER, change(PARAMETER_IROLL, (float)AXIS_ROLL));
    TEST_ASSERT_EQUAL(IN_AIR_NEVER, change(PARAMETER_IPITCH, (float)AXIS_ROLL));
    TEST_ASSERT_EQUAL(IN_AIR_NEVER, change(PARAMETER_IDOWN, (float)DOWN_MINUS_Z));
    TEST_ASSERT_EQUAL(IN_AIR_NEVER, change(PARAMETER_IUNIT, 255.0F));
    for (int id = PARAMETER_DF; id <= PARAMETER_SW; id++) {
        const float value = set.value[id];

        TEST_ASSERT_EQUAL(IN_AIR_NEVER, change((parameter_id_t)id, value + 1.0F));
        TEST_ASSERT_EQUAL(IN_AIR_FINE, change((parameter_id_t)id, value));
    }
}

void test_what_does_not_move_a_hover_is_free(void)
{
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_VUP, 1.5F));
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_VUP, 0.2F));
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_TERRAIN, (float)TERRAIN_IGNORE));
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_RELEASE, (float)RELEASE_SCAN));
    TEST_ASSERT_EQUAL(IN_AIR_FINE, change(PARAMETER_LINK, 5.0F));
}
