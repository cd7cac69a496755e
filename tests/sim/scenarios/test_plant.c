#include "sim/scenarios/plant.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

static plant_t plant;

void setUp(void)
{
    plant_init(&plant, 1);
}

void tearDown(void) {}

void test_a_figure_reaches_its_field_in_the_fields_unit(void)
{
    plant_set(&plant, "plant.hover_thrust", 6.5);
    plant_set(&plant, "plant.floor_rms_mm", 30.0);
    plant_set(&plant, "plant.attitude_burst_deg", -90.0);
    plant_set(&plant, "plant.ray_instant", 0.040);
    plant_set(&plant, "plant.clock_ppm", 50.0);
    plant_complete(&plant);
    NEAR(1e-12, 6.5, plant.board.quadrotor.hover_thrust_n);
    NEAR(1e-12, 0.030, plant.ground.rough_rms_m);
    NEAR(1e-12, -M_PI / 2.0, plant.board.imu.attitude_burst_rad);
    TEST_ASSERT_EQUAL_INT64(40 * SIM_MS, plant.board.laser.ray_instant);
    NEAR(1e-12, 1.00005, plant.board.laser.clock_ratio);
}

void test_only_plants_figures_are_known(void)
{
    TEST_ASSERT_TRUE(plant_known("plant.gain"));
    TEST_ASSERT_FALSE(plant_known("gain"));
    TEST_ASSERT_FALSE(plant_known("plant.nope"));
    TEST_ASSERT_FALSE(plant_known("plant."));
}

void test_a_value_is_a_number_in_its_range(void)
{
    TEST_ASSERT_NULL(plant_check("plant.rays_lost", "0"));
    TEST_ASSERT_NULL(plant_check("plant.rays_lost", "1"));
    TEST_ASSERT_NULL(plant_check("plant.edge_m", "-0.5"));
    TEST_ASSERT_EQUAL_STRING("not a number", plant_check("plant.gain", ""));
    TEST_ASSERT_EQUAL_STRING("not a number", plant_check("plant.gain", "1x"));
    TEST_ASSERT_EQUAL_STRING("not a number", plant_check("plant.gain", "inf"));
    TEST_ASSERT_NOT_NULL(strstr(plant_check("plant.rays_lost", "1.01"), "out of range"));
    TEST_ASSERT_NOT_NULL(strstr(plant_check("plant.rays_lost", "-0.01"), "out of range"));
    TEST_ASSERT_NOT_NULL(strstr(plant_check("plant.tau", "0"), "out of range"));
}

/* Every figure takes what it is already, so that --set with the listed value changes nothing. */
void test_the_printed_table_names_each_figure_once_with_a_value_that_it_takes(void)
{
    FILE *file = tmpfile();
    char line[256], name[64], unit[16], value[32];
    int lines = 0;

    plant_print(file);
    rewind(file);
    while (fgets(line, sizeof line, file) != NULL) {
        lines++;
        TEST_ASSERT_EQUAL_INT_MESSAGE(3, sscanf(line, "%63s %15s %31s", name, unit, value), line);
        TEST_ASSERT_TRUE_MESSAGE(plant_known(name), name);
        TEST_ASSERT_TRUE_MESSAGE(strlen(line) <= 122, line);
        if (strcmp(value, "never") != 0) {
            TEST_ASSERT_NULL_MESSAGE(plant_check(name, value), name);
        }
    }
    fclose(file);
    TEST_ASSERT_TRUE(lines >= 80);
}

void test_each_row_tells_its_figure_in_the_figures_unit(void)
{
    plant_figure_t figure;
    size_t rows = 0, found = 0;

    plant_set(&plant, "plant.floor_rms_mm", 30.0);
    for (; plant_figure(&plant, rows, &figure); rows++) {
        TEST_ASSERT_TRUE_MESSAGE(figure.least <= figure.value && figure.value <= figure.most, figure.name);
        if (strcmp(figure.name, "floor_rms_mm") == 0) {
            NEAR(1e-9, 30.0, figure.value);
            TEST_ASSERT_EQUAL_STRING("mm", figure.unit);
            found++;
        }
    }
    TEST_ASSERT_TRUE(rows >= 80);
    TEST_ASSERT_EQUAL_UINT(1, found);
}

void test_the_scanners_figures_reach_its_model(void)
{
    plant_set(&plant, "plant.scanner_answers", 1.0);
    plant_set(&plant, "plant.scanner_rate", 19200.0);
    plant_set(&plant, "plant.scanner_boot", 2.5);
    plant_complete(&plant);
    TEST_ASSERT_TRUE(plant.board.laser.answers_in_turn);
    NEAR(1e-9, 19200.0, plant.board.laser.power_up_rate);
    TEST_ASSERT_EQUAL_INT64(2500 * SIM_MS, plant.board.laser.boot);
}
