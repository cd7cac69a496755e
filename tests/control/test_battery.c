/* How the battery is, and when its voltage is not believed. */
#include "control/battery.h"

#include <math.h>
#include <string.h>

#include "unity.h"

#define CYCLE_S 0.025F
#define DIVIDER 10.1F
#define STEP_V (3.3F / 4096.0F) /* of the converter, at the pin */

static battery_t battery;
static parameters_t parameters;
static bool in_air;
static uint32_t random_state;

void setUp(void)
{
    memset(&battery, 0, sizeof battery);
    parameters_init(&parameters);
    parameters.value[PARAMETER_BAT] = (float)BAT_PIN;
    in_air = true;
    random_state = 1U;
}

void tearDown(void) {}

/* -1 .. 1 */
static float noise(void)
{
    random_state = random_state * UINT32_C(1664525) + UINT32_C(1013904223);
    return (float)(random_state >> 8) / 8388608.0F - 1.0F;
}

static void read(float pack_v)
{
    battery_step(&battery, &parameters, true, pack_v / DIVIDER, in_air, CYCLE_S);
}

static battery_verdict_t verdict(void)
{
    return battery_verdict(&battery, &parameters);
}

/* As in flight: a converter's noise and that of the motors. */
static void hold(float cell_v, float for_s)
{
    for (float t_s = 0.0F; t_s < for_s - 1e-4F; t_s += CYCLE_S) {
        read(4.0F * cell_v + 0.05F * noise());
    }
}

static void expect(battery_verdict_t expected)
{
    TEST_ASSERT_EQUAL_STRING(battery_name((uint16_t)expected), battery_name((uint16_t)verdict()));
}

void test_without_one_it_is_off_whatever_the_pin_says(void)
{
    parameters.value[PARAMETER_BAT] = (float)BAT_NONE;
    expect(BATTERY_OFF);
    hold(3.0F, 60.0F);
    expect(BATTERY_OFF);
    TEST_ASSERT_FALSE(battery_warns(verdict()));
}

void test_it_waits_for_some_readings_and_then_tells_the_voltage(void)
{
    expect(BATTERY_WAITS);
    hold(3.9F, 0.5F);
    TEST_ASSERT_FALSE(battery_warns(verdict()));
    hold(3.9F, 2.0F);
    expect(BATTERY_GOOD);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 15.6F, battery_v(&battery));
}

void test_the_warning_comes_ten_seconds_after_vlow_and_the_landing_ten_after_vland(void)
{
    hold(3.7F, 20.0F);
    hold(3.59F, 9.0F);
    expect(BATTERY_GOOD);
    hold(3.59F, 10.0F); /* and what the mean lags behind */
    expect(BATTERY_LOW);
    hold(3.51F, 60.0F);
    expect(BATTERY_LOW);
    hold(3.49F, 9.0F);
    expect(BATTERY_LOW);
    hold(3.49F, 10.0F);
    expect(BATTERY_EMPTY);
}

/* However fast it empties, and whatever the operator has set. */
void test_the_warning_always_comes_first_by_ten_seconds(void)
{
    float warned_s = 0.0F;

    parameters.value[PARAMETER_VLOW] = 3.3F;
    parameters.value[PARAMETER_VLAND] = 3.5F;
    hold(3.7F, 10.0F);
    while (verdict() != BATTERY_EMPTY) {
        hold(3.2F, CYCLE_S);
        warned_s += (verdict() == BATTERY_LOW) ? CYCLE_S : 0.0F;
        TEST_ASSERT_TRUE(warned_s < 12.0F);
    }
    TEST_ASSERT_TRUE(warned_s > 9.9F);
}

/* Full throttle for a second takes 0.3 V of each cell, PX4's BAT1_V_LOAD_DROP; here each ten seconds. */
void test_a_voltage_that_dips_under_gusts_is_no_empty_one(void)
{
    hold(3.8F, 10.0F);
    for (int i = 0; i < 60; i++) {
        hold(3.45F, 1.5F);
        hold(3.75F, 8.5F);
        expect(BATTERY_GOOD);
    }
}

void test_a_voltage_that_sinks_after_take_off_is_believed_and_good(void)
{
    in_air = false;
    hold(4.1F, 10.0F);
    in_air = true;
    for (int i = 0; i < 200; i++) {
        hold(3.87F, CYCLE_S);
        expect(BATTERY_GOOD);
    }
}

void test_a_landed_battery_that_recovers_is_still_empty_until_there_is_another(void)
{
    hold(3.4F, 60.0F);
    expect(BATTERY_EMPTY);
    in_air = false;
    hold(3.7F, 60.0F); /* at rest, 0.3 V more */
    expect(BATTERY_EMPTY);
    hold(4.15F, 10.0F);
    expect(BATTERY_GOOD);
}

void test_what_no_battery_of_so_many_cells_has_is_named_and_no_reason_to_land(void)
{
    static const struct {
        float pack_v;
        battery_verdict_t named;
    } rows[] = {{0.0F, BATTERY_ABSENT},  {0.5F, BATTERY_ABSENT},  {11.1F, BATTERY_ABSENT},
                {17.4F, BATTERY_HIGH},   {33.3F, BATTERY_HIGH},   {NAN, BATTERY_ABSENT},
                {-1.0F, BATTERY_ABSENT}, {INFINITY, BATTERY_HIGH}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        hold(3.8F, 5.0F);
        for (int cycle = 0; cycle < 4800; cycle++) {
            read(rows[i].pack_v);
            TEST_ASSERT_NOT_EQUAL(BATTERY_EMPTY, verdict());
            TEST_ASSERT_NOT_EQUAL(BATTERY_LOW, verdict());
        }
        expect(rows[i].named);
        TEST_ASSERT_TRUE(battery_warns(verdict()));
        hold(3.8F, 5.0F);
        expect(BATTERY_GOOD);
        TEST_ASSERT_FLOAT_WITHIN(0.1F, 15.2F, battery_v(&battery));
    }
}

/* So that VDIV can be found. */
void test_what_is_not_believed_is_told_all_the_same(void)
{
    for (int cycle = 0; cycle < 400; cycle++) {
        read(18.48F);
    }
    expect(BATTERY_HIGH);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 18.48F, battery_v(&battery));
}

void test_a_converter_that_falls_silent_is_absent(void)
{
    hold(3.8F, 10.0F);
    for (int cycle = 0; cycle < 4000; cycle++) {
        battery_step(&battery, &parameters, false, 0.0F, true, CYCLE_S);
    }
    expect(BATTERY_ABSENT);
    TEST_ASSERT_TRUE(isnan(battery_v(&battery)));
    hold(3.8F, 10.0F);
    expect(BATTERY_GOOD);
}

void test_one_cycle_without_a_reading_does_not_matter(void)
{
    hold(3.8F, 10.0F);
    for (int i = 0; i < 100; i++) {
        battery_step(&battery, &parameters, false, 0.0F, true, CYCLE_S);
        hold(3.8F, CYCLE_S);
        expect(BATTERY_GOOD);
    }
}

void test_a_loose_contact_is_no_empty_battery(void)
{
    static const uint32_t open_of_ten[] = {1U, 3U, 5U, 7U, 9U};

    for (size_t i = 0; i < sizeof open_of_ten / sizeof open_of_ten[0]; i++) {
        setUp();
        hold(3.8F, 10.0F);
        for (uint32_t cycle = 0U; cycle < 8000U; cycle++) {
            read((noise() < (float)open_of_ten[i] / 5.0F - 1.0F) ? 0.0F : 15.2F + 0.05F * noise());
            TEST_ASSERT_NOT_EQUAL(BATTERY_EMPTY, verdict());
            TEST_ASSERT_NOT_EQUAL(BATTERY_LOW, verdict());
        }
        expect(open_of_ten[i] < 3U ? BATTERY_GOOD : open_of_ten[i] > 4U ? BATTERY_ABSENT : verdict());
    }
}

/* Anything between the ends, at each reading. */
void test_a_voltage_that_jumps_is_not_believed(void)
{
    hold(3.8F, 10.0F);
    for (int cycle = 0; cycle < 4000; cycle++) {
        read(14.2F + 2.9F * noise());
        TEST_ASSERT_NOT_EQUAL(BATTERY_EMPTY, verdict());
    }
    expect(BATTERY_JUMPS);
    hold(3.8F, 5.0F);
    expect(BATTERY_GOOD);
}

/* Half a volt of noise around a good battery and around an empty one. */
void test_noise_of_the_motors_changes_nothing(void)
{
    static const struct {
        float cell_v;
        battery_verdict_t named;
    } rows[] = {{3.63F, BATTERY_GOOD}, {3.55F, BATTERY_LOW}, {3.45F, BATTERY_EMPTY}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        for (int cycle = 0; cycle < 4000; cycle++) {
            read(4.0F * rows[i].cell_v + 0.5F * noise());
        }
        expect(rows[i].named);
    }
}

void test_a_voltage_that_does_not_change_in_flight_is_frozen_before_it_could_land(void)
{
    hold(3.45F, 8.0F);
    for (int cycle = 0; cycle < 4000; cycle++) {
        read(13.8F + (((cycle & 1) == 0) ? STEP_V * DIVIDER : 0.0F)); /* a converter's own noise */
        TEST_ASSERT_NOT_EQUAL(BATTERY_EMPTY, verdict());
    }
    expect(BATTERY_FROZEN);
    hold(3.45F, 60.0F);
    expect(BATTERY_EMPTY);
}

/* The switch is on, the motors are not: nothing draws. */
void test_on_the_ground_it_may_stand_still(void)
{
    in_air = false;
    for (int cycle = 0; cycle < 4000; cycle++) {
        read(16.0F);
    }
    expect(BATTERY_GOOD);
}

void test_the_number_of_cells_and_the_divider_count(void)
{
    parameters.value[PARAMETER_CELLS] = 1.0F; /* 3S */
    parameters.value[PARAMETER_VDIV] = 5.05F;
    for (int cycle = 0; cycle < 400; cycle++) {
        read(22.8F + 0.05F * noise()); /* half of which the divider makes it */
    }
    expect(BATTERY_GOOD);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 11.4F, battery_v(&battery));
}

/* A cycle of 108 ms or of 25: the times are the same. */
void test_it_counts_seconds_not_cycles(void)
{
    float at_s[2] = {0.0F, 0.0F};

    for (int slow = 0; slow < 2; slow++) {
        const float cycle_s = (slow == 1) ? 0.108F : CYCLE_S;

        setUp();
        while (verdict() != BATTERY_EMPTY && at_s[slow] < 100.0F) {
            battery_step(&battery, &parameters, true, (13.6F + 0.05F * noise()) / DIVIDER, true, cycle_s);
            at_s[slow] += cycle_s;
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(0.5F, at_s[0], at_s[1]);
    TEST_ASSERT_FLOAT_WITHIN(2.0F, 21.5F, at_s[0]);
}

/* The clock's first step, or a pause. */
void test_one_long_cycle_lands_nothing(void)
{
    hold(3.45F, 8.0F);
    battery_step(&battery, &parameters, true, 13.8F / DIVIDER, true, 4000.0F);
    TEST_ASSERT_NOT_EQUAL(BATTERY_EMPTY, verdict());
    TEST_ASSERT_NOT_EQUAL(BATTERY_LOW, verdict());
}

void test_every_verdict_has_a_name_of_its_own(void)
{
    for (uint16_t i = 0U; i < (uint16_t)BATTERY_VERDICT_COUNT; i++) {
        for (uint16_t j = 0U; j < i; j++) {
            TEST_ASSERT_TRUE(strcmp(battery_name(i), battery_name(j)) != 0);
        }
    }
    TEST_ASSERT_EQUAL_STRING("?", battery_name((uint16_t)BATTERY_VERDICT_COUNT));
}
