/* What the stick orders, and what it cannot do however it lies. */
#include "control/stick_orders.h"

#include <math.h>
#include <string.h>

#include "control/thrust.h"
#include "unity.h"

#define CYCLE_S 0.025F
#define CYCLE_US 25000U
#define MIDDLE_US 1500.0F
#define UP_US 1100.0F
#define DOWN_US 1900.0F
#define SHUT_US 2000.0F
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(2e-3F, expected, actual)

static parameters_t parameters;
static stick_t stick;
static stick_orders_t orders;
static flight_outputs_t before;
static flight_inputs_t in;
static uint32_t radio_references, radio_arms;
static float radio_reference_m;
static bool radio_arm;
static float follows; /* 1: the vehicle is where the reference is; 0: it does not move */

void setUp(void)
{
    parameters_init(&parameters);
    parameters.value[PARAMETER_STICK] = (float)STICK_PIN;
    parameters.value[PARAMETER_SEL] = (float)SEL_PIN;
    parameters.value[PARAMETER_IAXES] = (float)AXES_PROVED;
    memset(&stick, 0, sizeof stick);
    memset(&orders, 0, sizeof orders);
    memset(&in, 0, sizeof in);
    before = (flight_outputs_t)FLIGHT_OUTPUTS_INITIAL;
    before.idle_n = 1.76F;
    before.estimate_mm = 0.0F;
    in.has_throttle = true;
    radio_references = radio_arms = 0U;
    radio_reference_m = 0.0F;
    radio_arm = false;
    follows = 1.0F;
}

void tearDown(void) {}

/* One cycle; the vehicle obeys a reference at once, as far as it follows. Returns whether a reference was
 * ordered. */
static bool cycle(bool came, float pulse_us)
{
    const uint32_t latest = in.reference_sequence;

    in.now_us += CYCLE_US;
    in.reference_m = radio_reference_m;
    in.reference_sequence = radio_references;
    in.arm = radio_arm;
    in.arm_sequence = radio_arms;
    stick_step(&stick, came, pulse_us, CYCLE_S);
    stick_orders_step(&orders, &parameters, &stick, &before, &in);
    if (in.reference_sequence != latest && before.state != FLIGHT_GROUND) {
        before.reference_m = in.reference_m;
        before.estimate_mm += follows * (in.reference_m * 1000.0F - before.estimate_mm);
    }
    return in.reference_sequence != latest;
}

/* Returns how many references were ordered. */
static unsigned held(float pulse_us, float for_s)
{
    unsigned count = 0U;

    for (int i = 0; i < (int)(for_s / CYCLE_S + 0.5F); i++) {
        count += cycle(true, pulse_us);
    }
    return count;
}

static void fly_at(float reference_m)
{
    before.state = FLIGHT_FLYING;
    before.reference_m = reference_m;
    before.estimate_mm = 1000.0F * reference_m;
    (void)held(MIDDLE_US, 1.5F);
}

static uint16_t flag(void)
{
    return stick_orders_flag(&orders, &parameters, &stick, in.has_throttle);
}

void test_without_the_wire_the_radios_orders_pass_as_they_are(void)
{
    parameters.value[PARAMETER_STICK] = (float)STICK_NONE;
    for (int i = 0; i < 100; i++) {
        radio_references += (i % 10 == 0);
        radio_reference_m = 0.01F * (float)radio_references;
        radio_arms += (i % 7 == 0);
        radio_arm = (radio_arms % 2U) != 0U;
        TEST_ASSERT_EQUAL(i % 10 == 0, cycle(true, UP_US));
        TEST_ASSERT_EQUAL_FLOAT(radio_reference_m, in.reference_m);
        TEST_ASSERT_EQUAL_UINT32(radio_references, in.reference_sequence);
        TEST_ASSERT_EQUAL_UINT32(radio_arms, in.arm_sequence);
        TEST_ASSERT_EQUAL(radio_arm, in.arm);
        TEST_ASSERT_EQUAL_HEX16(0, flag());
    }
}

void test_the_middle_holds_the_height(void)
{
    fly_at(0.6F);
    TEST_ASSERT_EQUAL_UINT(0, held(MIDDLE_US, 10.0F));
    TEST_ASSERT_EQUAL_UINT(0, held(MIDDLE_US + 59.0F, 10.0F));
    TEST_ASSERT_EQUAL_UINT(0, held(MIDDLE_US - 59.0F, 10.0F));
    NEAR(0.6F, before.reference_m);
    TEST_ASSERT_EQUAL_HEX16(0, flag());
}

void test_at_its_end_it_moves_the_reference_by_srate_and_half_way_by_less(void)
{
    fly_at(0.6F);
    (void)held(UP_US, 1.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.9F, before.reference_m); /* two cycles late: the median */
    (void)held(MIDDLE_US, 1.0F);
    const float there_m = before.reference_m;
    (void)held(DOWN_US, 1.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, there_m - 0.3F, before.reference_m);
    (void)held(MIDDLE_US, 1.0F);
    const float here_m = before.reference_m;
    (void)held(MIDDLE_US - 230.0F, 1.0F); /* the half of what is beyond the dead band */
    TEST_ASSERT_FLOAT_WITHIN(0.015F, here_m + 0.15F, before.reference_m);
}

void test_one_push_up_raises_the_reference_by_a_metre_at_most(void)
{
    parameters.value[PARAMETER_SRATE] = 0.7F;
    fly_at(0.6F);
    (void)held(UP_US, 60.0F);
    NEAR(1.6F, before.reference_m);
    (void)held(MIDDLE_US, 0.1F);
    (void)held(UP_US, 60.0F);
    NEAR(2.6F, before.reference_m);
    (void)held(MIDDLE_US, 0.1F);
    (void)held(UP_US, 60.0F);
    NEAR(3.0F, before.reference_m);
}

void test_the_reference_stays_within_0_3_m_of_a_vehicle_that_does_not_follow(void)
{
    fly_at(1.0F);
    follows = 0.0F;
    (void)held(UP_US, 20.0F);
    NEAR(1.3F, before.reference_m);
    (void)held(DOWN_US, 20.0F);
    NEAR(0.7F, before.reference_m);
}

void test_a_reference_that_is_farther_off_by_radio_is_not_pulled_back(void)
{
    fly_at(0.4F);
    follows = 0.0F;
    radio_reference_m = 1.5F;
    radio_references++;
    TEST_ASSERT_TRUE(cycle(true, UP_US));
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 2.0F));
    NEAR(1.5F, before.reference_m);
    (void)held(DOWN_US, 1.0F);
    TEST_ASSERT_TRUE(before.reference_m < 1.3F); /* toward the vehicle it moves */
}

void test_a_stick_that_hangs_at_an_end_since_power_on_orders_nothing(void)
{
    static const float ends[] = {UP_US, DOWN_US, 1000.0F, 2000.0F};

    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        setUp();
        TEST_ASSERT_EQUAL_UINT(0, held(ends[i], 60.0F));
        before.state = FLIGHT_FLYING;
        before.reference_m = 0.6F;
        before.estimate_mm = 600.0F;
        TEST_ASSERT_EQUAL_UINT(0, held(ends[i], 60.0F));
        TEST_ASSERT_EQUAL_HEX16(FLIGHT_FLAG_STICK, flag());
    }
}

void test_a_touch_of_the_middle_is_not_enough(void)
{
    before.state = FLIGHT_FLYING;
    before.reference_m = 0.6F;
    before.estimate_mm = 600.0F;
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_UINT(0, held(MIDDLE_US, 0.9F));
        TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 2.0F));
    }
}

void test_after_it_was_missing_it_counts_only_from_the_middle_again(void)
{
    fly_at(0.6F);
    for (int i = 0; i < 40; i++) {
        TEST_ASSERT_FALSE(cycle(false, 0.0F));
    }
    TEST_ASSERT_EQUAL_HEX16(FLIGHT_FLAG_STICK, flag());
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 5.0F));
    (void)held(MIDDLE_US, 1.5F);
    TEST_ASSERT_EQUAL_HEX16(0, flag());
    TEST_ASSERT_TRUE(held(UP_US, 1.0F) > 10U);
}

void test_after_the_pilots_turn_it_counts_only_from_the_middle_again(void)
{
    fly_at(0.6F);
    in.has_throttle = false;
    before.state = FLIGHT_FLOATING;
    TEST_ASSERT_EQUAL_UINT(0, held(1300.0F, 5.0F));
    in.has_throttle = true;
    before.state = FLIGHT_FLYING;
    TEST_ASSERT_EQUAL_UINT(0, held(1300.0F, 5.0F));
    TEST_ASSERT_EQUAL_HEX16(FLIGHT_FLAG_STICK, flag());
}

void test_while_the_pilot_flies_his_stick_is_his_thrust(void)
{
    fly_at(0.6F);
    in.has_throttle = false;
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 2.0F) + held(MIDDLE_US, 2.0F) + held(DOWN_US, 2.0F));
    TEST_ASSERT_EQUAL_HEX16(0, flag());
}

void test_without_a_pin_for_the_switch_it_never_counts(void)
{
    parameters.value[PARAMETER_SEL] = (float)SEL_NONE;
    fly_at(0.6F);
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 2.0F));
    TEST_ASSERT_EQUAL_HEX16(FLIGHT_FLAG_STICK, flag());
}

void test_noise_about_the_middle_does_not_move_the_reference_away(void)
{
    uint32_t lot = 1U;

    fly_at(0.6F);
    for (int i = 0; i < 40 * 60; i++) { /* a minute, evenly within 120 us to both sides */
        lot = lot * 1664525U + 1013904223U;
        (void)cycle(true, MIDDLE_US + 120.0F * ((float)(lot >> 8) / 8388608.0F - 1.0F));
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.6F, before.reference_m);
}

void test_up_takes_off_an_armed_vehicle_once(void)
{
    (void)held(MIDDLE_US, 1.5F);
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 1.0F)); /* two cycles late, and a second */
    TEST_ASSERT_EQUAL_UINT(1, held(UP_US, 10.0F));
    NEAR(0.3F, in.reference_m);
}

void test_it_takes_off_neither_an_unarmed_vehicle_nor_one_whose_imu_is_against_gravity(void)
{
    before.idle_n = 0.0F;
    (void)held(MIDDLE_US, 1.5F);
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 5.0F));
    before.idle_n = 1.76F;
    parameters.value[PARAMETER_IAXES] = (float)AXES_ASSUMED;
    before.imu_fault = IMU_ROLL;
    (void)held(MIDDLE_US, 1.5F);
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 5.0F));
}

void test_one_mirror_without_ground_takes_off_and_two_or_their_height_do_not(void)
{
    before.idle_n = 1.76F;
    before.mirrors.wrong = 1U << MIRROR_FORE | 1U << MIRROR_AFT;
    (void)held(MIDDLE_US, 1.5F);
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 5.0F));
    before.mirrors.wrong = 1U << MIRROR_AFT;
    before.stands_high = true;
    (void)held(MIDDLE_US, 1.5F);
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 0.8F));
    before.stands_high = false; /* somebody frees the mirrors, and the stick is up yet */
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 5.0F));
    (void)held(MIDDLE_US, 1.5F);
    TEST_ASSERT_EQUAL_UINT(1, held(UP_US, 5.0F));
}

void test_down_sinks_to_the_lowest_reference_and_held_there_lands(void)
{
    fly_at(0.6F);
    (void)held(DOWN_US, 1.5F);
    NEAR(STICK_LEAST_M, before.reference_m);
    TEST_ASSERT_EQUAL_UINT(0, held(DOWN_US, 0.7F));
    TEST_ASSERT_EQUAL_UINT(1, held(DOWN_US, 1.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, in.reference_m);
}

void test_at_the_lowest_reference_the_middle_does_not_land(void)
{
    fly_at(STICK_LEAST_M);
    TEST_ASSERT_EQUAL_UINT(0, held(MIDDLE_US, 30.0F));
    TEST_ASSERT_EQUAL_UINT(0, held(DOWN_US, 0.6F) + held(MIDDLE_US, 1.0F) + held(DOWN_US, 0.6F));
}

void test_up_ends_a_landing_that_the_stick_ordered_and_no_other(void)
{
    fly_at(STICK_LEAST_M);
    (void)held(DOWN_US, 1.5F);
    before.state = FLIGHT_LANDING;
    (void)held(MIDDLE_US, 0.2F);
    TEST_ASSERT_EQUAL_UINT(1, held(UP_US, 1.5F));
    NEAR(0.3F, in.reference_m);
    radio_reference_m = 0.0F;
    radio_references++;
    TEST_ASSERT_TRUE(cycle(true, MIDDLE_US));
    (void)held(MIDDLE_US, 0.2F);
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 5.0F));
}

/* It was ordered once, and is over: another landing is not the stick's. */
void test_up_does_not_end_a_landing_for_another_reason_after_one_by_stick(void)
{
    fly_at(STICK_LEAST_M);
    (void)held(DOWN_US, 1.5F);
    before.state = FLIGHT_GROUND;
    (void)held(MIDDLE_US, 1.0F);
    TEST_ASSERT_EQUAL_UINT(1, held(UP_US, 1.5F));
    before.state = FLIGHT_LANDING; /* a link that is lost */
    (void)held(MIDDLE_US, 1.0F);
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 5.0F));
}

void test_no_state_but_flying_and_the_ground_obeys_it(void)
{
    static const flight_state_t states[] = {FLIGHT_TAKEOFF, FLIGHT_COASTING, FLIGHT_DESCENDING,
                                            FLIGHT_LANDING, FLIGHT_LOWERING, FLIGHT_CUT};

    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++) {
        setUp();
        fly_at(0.6F);
        before.state = states[i];
        TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 5.0F) + held(MIDDLE_US, 1.0F) + held(DOWN_US, 5.0F));
    }
}

void test_a_vehicle_that_floats_is_held_where_it_is_from_the_middle(void)
{
    before.state = FLIGHT_FLOATING;
    before.estimate_mm = 850.0F;
    TEST_ASSERT_EQUAL_UINT(0, held(1300.0F, 2.0F));
    (void)held(MIDDLE_US, 1.1F);
    NEAR(0.85F, in.reference_m);
    setUp();
    before.state = FLIGHT_FLOATING;
    before.estimate_mm = NAN;
    TEST_ASSERT_EQUAL_UINT(0, held(MIDDLE_US, 5.0F));
}

void test_without_a_height_the_reference_does_not_move(void)
{
    fly_at(0.6F);
    before.estimate_mm = NAN;
    TEST_ASSERT_EQUAL_UINT(0, held(UP_US, 5.0F));
    NEAR(0.6F, before.reference_m);
}

void test_a_throttle_that_the_pilot_opens_before_the_hand_over_arms_and_shut_again_disarms(void)
{
    in.has_throttle = false;
    (void)held(SHUT_US, 2.0F);
    TEST_ASSERT_EQUAL_UINT32(0, in.arm_sequence);
    (void)held(1800.0F, 0.9F);
    TEST_ASSERT_EQUAL_UINT32(0, in.arm_sequence);
    (void)held(1800.0F, 1.0F);
    TEST_ASSERT_EQUAL_UINT32(1, in.arm_sequence);
    TEST_ASSERT_TRUE(in.arm);
    in.has_throttle = true;
    (void)held(MIDDLE_US, 5.0F);
    in.has_throttle = false;
    (void)held(SHUT_US, 1.5F);
    TEST_ASSERT_EQUAL_UINT32(2, in.arm_sequence);
    TEST_ASSERT_FALSE(in.arm);
}

/* Between 8 and 12 % nothing changes. */
void test_a_throttle_that_rests_at_ten_percent_neither_arms_nor_disarms(void)
{
    in.has_throttle = false;
    (void)held(1900.0F, 5.0F);
    TEST_ASSERT_EQUAL_UINT32(0, in.arm_sequence);
    (void)held(1800.0F, 1.5F);
    (void)held(1900.0F, 5.0F);
    TEST_ASSERT_EQUAL_UINT32(1, in.arm_sequence);
    TEST_ASSERT_TRUE(in.arm);
}

void test_a_shut_throttle_does_not_take_back_what_the_radio_armed(void)
{
    in.has_throttle = false;
    radio_arm = true;
    radio_arms++;
    (void)held(SHUT_US, 5.0F);
    TEST_ASSERT_EQUAL_UINT32(1, in.arm_sequence);
    TEST_ASSERT_TRUE(in.arm);
}

void test_the_pilots_throttle_arms_on_the_ground_only(void)
{
    in.has_throttle = false;
    before.state = FLIGHT_FLOATING;
    (void)held(1400.0F, 5.0F);
    TEST_ASSERT_EQUAL_UINT32(0, in.arm_sequence);
}

void test_a_radio_stop_wins_over_a_throttle_that_stays_open(void)
{
    in.has_throttle = false;
    (void)held(1800.0F, 2.0F);
    radio_arm = false;
    radio_arms++;
    (void)held(1800.0F, 5.0F);
    TEST_ASSERT_EQUAL_UINT32(2, in.arm_sequence);
    TEST_ASSERT_FALSE(in.arm);
}

void test_an_order_by_radio_is_never_lost_to_the_stick(void)
{
    fly_at(0.6F);
    for (int i = 0; i < 200; i++) {
        (void)held(UP_US, 0.1F);
        radio_references++;
        radio_reference_m = (i % 2 == 0) ? 0.0F : 0.5F;
        TEST_ASSERT_TRUE(cycle(true, UP_US));
        TEST_ASSERT_EQUAL_FLOAT(radio_reference_m, in.reference_m);
    }
}
