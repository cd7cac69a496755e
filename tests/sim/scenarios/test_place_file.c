#include "sim/scenarios/place_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "unity.h"

#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

static place_file_t file;

void setUp(void) {}

void tearDown(void) {}

static void read(const char *text)
{
    TEST_ASSERT_TRUE_MESSAGE(place_file_read(&file, text, 1), file.message);
}

static void refuse(const char *text, unsigned line, const char *message)
{
    TEST_ASSERT_FALSE(place_file_read(&file, text, 1));
    TEST_ASSERT_EQUAL_UINT(line, file.line);
    TEST_ASSERT_EQUAL_STRING(message, file.message);
}

static double z_m(double x_m, double y_m)
{
    return place_below(&file.place, x_m, y_m, 10.0, 0.0).at.z;
}

void test_remarks_blanks_and_nothing_are_a_level_floor(void)
{
    read("");
    read("# a hall\n\n   \t\r\n# end");
    TEST_ASSERT_EQUAL_INT(0, file.place.count);
    TEST_ASSERT_EQUAL_INT(0, file.course.count);
}

void test_each_thing_stands_where_its_line_says(void)
{
    read("ramp 1 0 0.28 2 0 0.25\nblock 3 1 1 0.5 0.4 # a box\ntable 6 0 1.2 0.8 0.7\npost 9 0 0.03 0.45\n");
    NEAR(1e-9, 0.125, z_m(1.0, 0.0));
    NEAR(1e-9, 0.4, z_m(3.0, 1.0));
    NEAR(1e-9, 0.7, z_m(6.5, 0.3));
    NEAR(1e-9, 0.0, place_below(&file.place, 6.0, 0.0, 0.5, 0.0).at.z);
    NEAR(1e-9, 0.45, z_m(9.01, -0.01));
}

void test_stairs_rise_by_a_step_each(void)
{
    read("stairs 2 0 3 0.3 0.17 1.5");
    NEAR(1e-9, 0.0, z_m(1.99, 0.0));
    NEAR(1e-9, 0.17, z_m(2.15, 0.7));
    NEAR(1e-9, 0.34, z_m(2.45, 0.0));
    NEAR(1e-9, 0.51, z_m(2.75, 0.0));
    NEAR(1e-9, 0.0, z_m(2.91, 0.0));
}

void test_a_turned_thing_turns_about_its_own_place(void)
{
    read("stairs 2 1 2 0.3 0.2 1 turned 90");
    NEAR(1e-9, 0.2, z_m(2.0, 1.15));
    NEAR(1e-9, 0.4, z_m(2.0, 1.45));
    NEAR(1e-9, 0.0, z_m(2.45, 0.99));
}

void test_a_wall_stands_between_its_ends(void)
{
    place_hit_t hit;

    read("wall 4 -2 4 2 2.5");
    TEST_ASSERT_TRUE(
        place_cast(&file.place, (place_vector_t){0, 1.9, 1}, (place_vector_t){1, 0, 0}, 10, 0, &hit));
    NEAR(1e-9, 3.95, hit.distance_m);
    TEST_ASSERT_FALSE(
        place_cast(&file.place, (place_vector_t){0, 2.1, 1}, (place_vector_t){1, 0, 0}, 10, 0, &hit));
}

void test_a_lift_and_a_foot_have_their_times(void)
{
    read("lift 0 0 1 1 0.5 0.25 10 5\nfoot 3 0 0.3 0.1 0.12 20 2\n");
    NEAR(1e-9, 0.0, z_m(0.0, 0.0));
    NEAR(1e-9, 0.25, place_below(&file.place, 0, 0, 2, 11.0).at.z);
    NEAR(1e-9, 0.5, place_below(&file.place, 0, 0, 2, 16.0).at.z);
    NEAR(1e-9, 0.12, place_below(&file.place, 3, 0, 2, 21.0).at.z);
    NEAR(1e-9, 0.0, place_below(&file.place, 3, 0, 2, 22.5).at.z);
}

void test_a_rough_floor_is_the_seeds(void)
{
    read("rough 12 0.3");
    const double one = z_m(1.0, 1.0);
    NEAR(1e-9, 0.012, file.place.rough.rms_m);
    TEST_ASSERT_TRUE(one != 0.0);
    TEST_ASSERT_TRUE(place_file_read(&file, "rough 12 0.3", 2));
    TEST_ASSERT_TRUE(z_m(1.0, 1.0) != one);
}

void test_the_way_has_its_legs(void)
{
    read("go 5 7.5 0 0.4\ngo 30 0 0 0.8 turned 180\n");
    TEST_ASSERT_EQUAL_INT(2, file.course.count);
    NEAR(1e-12, 0.0, file.course.legs[0].turn_radps);
    NEAR(1e-12, M_PI, file.course.legs[1].heading_rad);
    TEST_ASSERT_TRUE(file.course.legs[1].turn_radps > 0.0);
    TEST_ASSERT_FALSE(file.course.carried);
    read("go 5 7.5 0 0.4\ncarried\n");
    TEST_ASSERT_TRUE(file.course.carried);
    refuse("carried 1", 1, "carried: 1: one word too many");
}

void test_a_fault_is_named_with_its_line(void)
{
    refuse("block 1 0 1 1 0.3\nbox 1 1", 2, "box: no such word");
    refuse("\n\nblock 1 0 1 x 0.3", 3, "block: WIDTH: not a number");
    refuse("block 1 0 1 1", 1, "block: HEIGHT: missing");
    refuse("block 1 0 1 -1 0.3", 1, "block: WIDTH: out of range 0.001..100");
    refuse("block 1 0 1 nan 0.3", 1, "block: WIDTH: out of range 0.001..100");
    refuse("block 1 0 1 1 0.3 0.4", 1, "block: 0.4: one word too many");
    refuse("block 1 0 1 1 0.3 turned", 1, "block: turned: wants one angle, in degrees");
    refuse("block 1 0 1 1 0.3 turned x", 1, "block: turned: not a number");
    refuse("wall 0 0 1 1 2 turned 4", 1, "wall: turned: one word too many");
    refuse("go 1 1 1 0", 1, "go: SPEED: out of range 0.01..10");
    refuse("go 1 1 1 1 turned 1 2 3 4 5 6 7 8", 1, "go: 2: one word too many");
    refuse("go 1 1 1 1 turned 1 2 3 4 5 6 7 8 9 10 11", 1, "go: 11: one word too many");
}

void test_too_much_is_refused(void)
{
    static char text[40 * 300];

    for (int i = 0; i < 41; i++) {
        strcat(text, "table 1 1 1 1 1\n");
    }
    refuse(text, 41, "table: more than 200 blocks");
    text[0] = '\0';
    for (int i = 0; i < 65; i++) {
        strcat(text, "go 1 1 1 1\n");
    }
    refuse(text, 65, "go: more than 64 legs");
    memset(text, ' ', 201);
    text[201] = '\0';
    refuse(text, 1, "longer than 200 characters");
}

static const char *surface_at(double x_m, double y_m)
{
    return place_below(&file.place, x_m, y_m, 10.0, 0.0).surface->name;
}

void test_things_are_of_the_surfaces_that_their_lines_name(void)
{
    read("floor carpet\nblock 3 0 1 1 0.4 of black\ntable 6 0 1 1 0.7 of glass turned 90\n"
         "stairs 9 0 2 0.3 0.1 1 turned 0 of wood\nblock 12 0 1 1 0.1\nwall 20 -1 20 1 2 of white");
    TEST_ASSERT_EQUAL_STRING("carpet", surface_at(0.0, 0.0));
    TEST_ASSERT_EQUAL_STRING("black", surface_at(3.0, 0.0));
    TEST_ASSERT_EQUAL_STRING("glass", surface_at(6.0, 0.0));
    TEST_ASSERT_EQUAL_STRING("wood", surface_at(9.45, 0.0));
    TEST_ASSERT_EQUAL_STRING("plain", surface_at(12.0, 0.0));
    TEST_ASSERT_EQUAL_STRING("white", surface_at(20.0, 0.0));
}

void test_tiles_are_a_chequer_board_with_a_corner_at_the_origin(void)
{
    read("tiles white black 0.3");
    TEST_ASSERT_EQUAL_STRING("white", surface_at(0.1, 0.1));
    TEST_ASSERT_EQUAL_STRING("black", surface_at(0.4, 0.1));
    TEST_ASSERT_EQUAL_STRING("black", surface_at(-0.1, 0.1));
    TEST_ASSERT_EQUAL_STRING("white", surface_at(-0.1, -0.1));
}

void test_a_file_may_have_surfaces_of_its_own(void)
{
    read("surface parquet 0.4 0.2 0 3 0\nsurface black 0.02 0 0 15 0\nfloor parquet\nblock 3 0 1 1 1 of "
         "black");
    NEAR(1e-12, 3.0, place_below(&file.place, 0.0, 0.0, 1.0, 0.0).surface->offset_mm);
    NEAR(1e-12, 15.0, place_below(&file.place, 3.0, 0.0, 2.0, 0.0).surface->offset_mm);
}

void test_the_sun_shines_where_its_line_says(void)
{
    read("sun 2 0 2 1 0.8\nsun 5 0 2 1 0.5 turned 90");
    NEAR(1e-12, 0.8, place_sunlight(&file.place, 2.9, 0.4));
    NEAR(1e-12, 0.0, place_sunlight(&file.place, 2.9, 0.6));
    NEAR(1e-12, 0.5, place_sunlight(&file.place, 5.0, 0.9));
    NEAR(1e-12, 0.0, place_sunlight(&file.place, 5.9, 0.0));
}

void test_surfaces_that_are_wrong_are_told(void)
{
    refuse("floor", 1, "floor: NAME: missing");
    refuse("\nfloor cheese", 2, "floor: no surface cheese");
    refuse("tiles white", 1, "tiles: NAME: missing");
    refuse("tiles white black", 1, "tiles: SIZE: missing");
    refuse("block 1 1 1 1 1 of", 1, "block: of: wants a surface");
    refuse("block 1 1 1 1 1 of black of white", 1, "block: of: one word too many");
    refuse("go 1 1 1 1 of black", 1, "go: of: one word too many");
    refuse("sun 0 0 1 1 2", 1, "sun: STRENGTH: out of range 0..1");
    refuse("surface shiny 0.5 0.6 0 0 0", 1,
           "surface: at most 16, names shorter than 16 and not plain, light shared out at most once");
}

void test_bars_and_grooves_lie_across_the_way(void)
{
    read("bars 50 0.4 0.25");
    NEAR(1e-12, 0.0, z_m(0.3, 0.0));
    NEAR(1e-12, 0.0, z_m(0.7, 0.0));
    NEAR(1e-12, 0.05, z_m(0.85, 3.0));
    read("bars -30 0.4 0.25");
    NEAR(1e-12, -0.03, z_m(0.85, 0.0));
}
