/* The battery, what it sags by, and how its wire lies. */
#include "sim/devices/lipo.h"

#include <math.h>

#include "unity.h"

#define DAMAGED_V 3.3 /* ArduPilot's wiki, of a LiPo's cell */

static lipo_t lipo;
static lipo_config_t config;

void setUp(void)
{
    config = (lipo_config_t)LIPO_DEFAULT;
    config.connected = 1.0;
    config.noise_v = 0.0;
    lipo_init(&lipo, &config, 1);
}

void tearDown(void) {}

void test_a_full_battery_at_rest_has_what_the_hardware_page_says(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 16.8, lipo_draw(&lipo, 0.0, 0.0));
}

void test_its_cells_only_fall_with_the_charge_and_steeply_at_the_end(void)
{
    double before_v = lipo_cell_v(1.0);

    for (int i = 999; i >= 0; i--) {
        const double cell_v = lipo_cell_v(i / 1000.0);

        TEST_ASSERT_TRUE(cell_v <= before_v);
        before_v = cell_v;
    }
    TEST_ASSERT_TRUE(lipo_cell_v(0.0) < DAMAGED_V);
    TEST_ASSERT_TRUE(lipo_cell_v(0.05) - lipo_cell_v(0.0) > 5.0 * (lipo_cell_v(0.55) - lipo_cell_v(0.5)));
    TEST_ASSERT_EQUAL_DOUBLE(lipo_cell_v(0.0), lipo_cell_v(-1.0));
    TEST_ASSERT_EQUAL_DOUBLE(lipo_cell_v(1.0), lipo_cell_v(2.0));
}

void test_it_sags_with_the_current_and_recovers_at_once(void)
{
    const double rest_v = lipo_draw(&lipo, 0.0, 0.0);
    const double hover_v = lipo_draw(&lipo, 1.0, 0.0);
    const double full_v = lipo_draw(&lipo, 11.76 / 7.4, 0.0);

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, config.hover_a * config.resistance_ohm, rest_v - hover_v);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, pow(11.76 / 7.4, 1.5) * (rest_v - hover_v), rest_v - full_v);
    TEST_ASSERT_EQUAL_DOUBLE(rest_v, lipo_draw(&lipo, 0.0, 0.0));
}

void test_its_share_is_one_when_it_is_full_and_hovers(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 1.0, lipo_share(&lipo, lipo_draw(&lipo, 1.0, 0.0))); /* and 1.3 A */
    TEST_ASSERT_TRUE(lipo_share(&lipo, lipo_draw(&lipo, 0.0, 0.0)) > 1.03);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0 * lipo_share(&lipo, 7.0), lipo_share(&lipo, 14.0));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, lipo_share(&lipo, -1.0));
}

void test_one_that_gives_no_current_has_no_share(void)
{
    config.resistance_ohm = 0.5;
    config.hover_a = 200.0;
    lipo_init(&lipo, &config, 1);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, lipo_share(&lipo, lipo_draw(&lipo, 1.0, 0.0)));
}

/* 5 Ah by 32.3 A. */
void test_a_hover_empties_it_in_nine_minutes(void)
{
    int seconds = 0;

    while (lipo_draw(&lipo, 1.0, 1.0) > 4.0 * 3.5 && seconds < 3600) {
        seconds++;
    }
    TEST_ASSERT_INT_WITHIN(60, 9 * 60, seconds);
}

void test_the_divider_brings_it_to_the_pin_and_noise_is_of_the_battery(void)
{
    double sum = 0.0, squares = 0.0;

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 16.0 / 10.1, lipo_pin_v(&lipo, 0.0, 16.0));
    config.noise_v = 0.5;
    lipo_init(&lipo, &config, 1);
    for (int i = 0; i < 10000; i++) {
        const double off_v = 10.1 * lipo_pin_v(&lipo, 0.0, 16.0) - 16.0;
        sum += off_v;
        squares += off_v * off_v;
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.02, 0.0, sum / 10000.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, 0.5, sqrt(squares / 10000.0));
}

void test_an_open_wire_is_nought(void)
{
    config.lost = (span_t){5.0, 2.0};
    lipo_init(&lipo, &config, 1);
    TEST_ASSERT_TRUE(lipo_pin_v(&lipo, 4.9, 16.0) > 1.5);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, lipo_pin_v(&lipo, 5.0, 16.0));
    TEST_ASSERT_TRUE(lipo_pin_v(&lipo, 7.0, 16.0) > 1.5);
    config.connected = 0.0;
    lipo_init(&lipo, &config, 1);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, lipo_pin_v(&lipo, 0.0, 16.0));
}

void test_a_frozen_reading_is_that_of_its_beginning(void)
{
    config.frozen = (span_t){5.0, 2.0};
    lipo_init(&lipo, &config, 1);
    const double before_v = lipo_pin_v(&lipo, 4.9, 16.0);
    TEST_ASSERT_EQUAL_DOUBLE(before_v, lipo_pin_v(&lipo, 5.5, 12.0));
    TEST_ASSERT_TRUE(lipo_pin_v(&lipo, 7.5, 12.0) < before_v);
}

void test_a_stuck_one_tells_what_it_likes(void)
{
    config.stuck = (span_t){SPAN_POWER_ON_S, SPAN_FOR_GOOD_S};
    config.stuck_v = 10.1;
    lipo_init(&lipo, &config, 1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, lipo_pin_v(&lipo, 0.0, 16.0));
}

void test_a_loose_contact_is_open_as_often_as_it_is_told(void)
{
    int open = 0;

    config.loose = 0.3;
    lipo_init(&lipo, &config, 1);
    for (int i = 0; i < 10000; i++) {
        open += lipo_pin_v(&lipo, 0.0, 16.0) == 0.0;
    }
    TEST_ASSERT_INT_WITHIN(200, 3000, open);
}
