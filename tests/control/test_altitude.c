#include "control/altitude.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>

#define DEGREE 0.017453292519943295

static altitude_geometry_t geometry;

void setUp(void)
{
    geometry = altitude_geometry_default();
}

void tearDown(void) {}

typedef struct {
    double x, y, z; /* fore, mirror's side, up */
} vector_t;

/* Body to world: roll about the fore axis (mirror's side up), then pitch about the lateral one (nose up). */
static vector_t turned(vector_t b, double roll, double pitch)
{
    const vector_t rolled = {b.x, b.y * cos(roll) - b.z * sin(roll), b.y * sin(roll) + b.z * cos(roll)};
    const vector_t world = {rolled.x * cos(pitch) - rolled.z * sin(pitch), rolled.y,
                            rolled.x * sin(pitch) + rolled.z * cos(pitch)};
    return world;
}

/* Where the seed's Annex III puts the mirrors: the sensor on the lateral axis 115 mm from the centre, looking
 * outwards; the front mirror 105 mm further out, mirror 2 (d 107, l 105) to the sensor's left, which is fore,
 * mirror 1 (d 115, l 98) to its right. Origin: gear's lowest level under the vehicle's centre. */
typedef struct {
    mirror_t mirror;
    vector_t reflection;
} place_t;

static const place_t places[] = {
    {MIRROR_FRONT, {0.0, 220.0, 100.0}},
    {MIRROR_FORE, {107.0, 115.0, 105.0}},
    {MIRROR_AFT, {-115.0, 115.0, 98.0}},
};

/* Length of the ray sensor - mirror - flat ground, with the origin of the vehicle height_mm above the ground.
 */
static double ray_from_mm(double sensor_mm, const place_t *place, double height_mm, double roll, double pitch)
{
    const vector_t sensor = {0.0, sensor_mm, place->reflection.z};
    const vector_t down = turned((vector_t){0.0, 0.0, -1.0}, roll, pitch);
    const vector_t point = turned(place->reflection, roll, pitch);
    const double to_mirror = hypot(place->reflection.x - sensor.x, place->reflection.y - sensor.y);
    return to_mirror + (height_mm + point.z) / -down.z;
}

static double ray_mm(const place_t *place, double height_mm, double roll, double pitch)
{
    return ray_from_mm(115.0, place, height_mm, roll, pitch);
}

/* What the seed's formula leaves out: cos(pitch) on L sin(roll), cos(pitch) cos(roll) on l. */
static double seeds_error_mm(const place_t *place, double roll, double pitch)
{
    return -place->reflection.y * sin(roll) * (1.0 - cos(pitch)) -
           place->reflection.z * (1.0 - cos(roll) * cos(pitch));
}

void test_level_heights_are_slant_less_distance_less_leg(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 600.0F,
                             altitude_under_mirror(&geometry.mirror[MIRROR_FRONT], 805.0F, 0.0F, 0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 600.0F,
                             altitude_under_mirror(&geometry.mirror[MIRROR_FORE], 812.0F, 0.0F, 0.0F));
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 600.0F,
                             altitude_under_mirror(&geometry.mirror[MIRROR_AFT], 813.0F, 0.0F, 0.0F));
}

/* Seed document eq. 31 by hand: 1000 mm, roll 10, pitch 5 degrees:
 * 895 * 0.9961947 * 0.9848078 - 220 * 0.1736482 - 100 = 739.85 */
void test_equation_31_by_hand(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 739.85F,
                             altitude_under_mirror(&geometry.mirror[MIRROR_FRONT], 1000.0F,
                                                   (float)(10.0 * DEGREE), (float)(5.0 * DEGREE)));
}

void test_every_mirror_agrees_with_a_ray_model_but_for_the_seeds_two_cosines(void)
{
    for (unsigned i = 0; i < sizeof places / sizeof places[0]; i++) {
        for (int roll = -30; roll <= 30; roll += 3) {
            for (int pitch = -30; pitch <= 30; pitch += 3) {
                for (int height = 0; height <= 3000; height += 500) {
                    const double r = roll * DEGREE, p = pitch * DEGREE;
                    const float slant_mm = (float)ray_mm(&places[i], height, r, p);
                    const float found_mm = altitude_under_mirror(&geometry.mirror[places[i].mirror], slant_mm,
                                                                 (float)r, (float)p);
                    char where[64];
                    snprintf(where, sizeof where, "mirror %u roll %d pitch %d height %d", i, roll, pitch,
                             height);
                    const float expected_mm = (float)(height + seeds_error_mm(&places[i], r, p));
                    TEST_ASSERT_FLOAT_WITHIN_MESSAGE(0.01F, expected_mm, found_mm, where);
                }
            }
        }
    }
}

/* A vehicle of other measures: each of the seven parameters is another, and acts where the ray model has it.
 */
void test_another_bracket_agrees_with_its_ray_model_by_its_seven_parameters(void)
{
    static const place_t other[] = {
        {MIRROR_FRONT, {0.0, 310.0, 80.0}},  /* DF 90, LF 80, L 310; the sensor at 220 */
        {MIRROR_FORE, {96.0, 220.0, 121.0}}, /* D2 96, L2 121 */
        {MIRROR_AFT, {-131.0, 220.0, 70.0}}, /* D1 131, L1 70 */
    };
    parameters_t parameters;

    parameters_init(&parameters);
    parameters.value[PARAMETER_DF] = 90.0F;
    parameters.value[PARAMETER_LF] = 80.0F;
    parameters.value[PARAMETER_L] = 310.0F;
    parameters.value[PARAMETER_D1] = 131.0F;
    parameters.value[PARAMETER_L1] = 70.0F;
    parameters.value[PARAMETER_D2] = 96.0F;
    parameters.value[PARAMETER_L2] = 121.0F;
    geometry = altitude_geometry_of(&parameters);
    for (unsigned i = 0; i < 3; i++) {
        for (int roll = -20; roll <= 20; roll += 10) {
            for (int pitch = -20; pitch <= 20; pitch += 10) {
                const double r = roll * DEGREE, p = pitch * DEGREE;
                mirror_range_t range = {other[i].mirror, true, 0.0F, 4.0F, 35U, 0};

                range.slant_mm = (float)ray_from_mm(220.0, &other[i], 600.0, r, p);
                const altitude_t altitude = altitude_from_ranges(&geometry, &range, 1, (float)r, (float)p);
                const float expected_mm = (float)(600.0 + seeds_error_mm(&other[i], r, p));
                TEST_ASSERT_FLOAT_WITHIN(0.01F, expected_mm, altitude.height_mm);
                TEST_ASSERT_FLOAT_WITHIN(0.01F, expected_mm, altitude_at_tilt(&altitude, (float)r, (float)p));
            }
        }
    }
}

void test_the_formula_is_within_the_documented_millimetres_up_to_ten_degrees(void)
{
    double worst_one = 0.0, worst_both = 0.0;
    for (unsigned i = 0; i < sizeof places / sizeof places[0]; i++) {
        for (int roll = -10; roll <= 10; roll++) {
            for (int pitch = -10; pitch <= 10; pitch++) {
                const double r = roll * DEGREE, p = pitch * DEGREE;
                const float slant_mm = (float)ray_mm(&places[i], 600.0, r, p);
                const float found_mm = altitude_under_mirror(&geometry.mirror[places[i].mirror], slant_mm,
                                                             (float)r, (float)p);
                const double off = fabs((double)found_mm - 600.0);
                worst_both = fmax(worst_both, off);
                worst_one = fmax(worst_one, (roll == 0 || pitch == 0) ? off : 0.0);
            }
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 1.6F, (float)worst_one);
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 3.6F, (float)worst_both);
}

void test_a_missing_correction_would_show(void)
{
    const double roll = 5.0 * DEGREE;
    for (unsigned i = 0; i < sizeof places / sizeof places[0]; i++) {
        const double pitch = (places[i].reflection.x < 0.0 ? -5.0 : 5.0) * DEGREE;
        const float slant_mm = (float)ray_mm(&places[i], 600.0, roll, pitch);
        const float level_mm = altitude_under_mirror(&geometry.mirror[places[i].mirror], slant_mm, 0.0F,
                                                     0.0F);
        TEST_ASSERT_TRUE(fabsf(level_mm - 600.0F) > 5.0F);
    }
}

void test_roll_up_on_the_mirrors_side_lengthens_the_ray(void)
{
    TEST_ASSERT_TRUE(ray_mm(&places[0], 600.0, 0.1, 0.0) > 805.0 + 15.0);
    TEST_ASSERT_TRUE(altitude_under_mirror(&geometry.mirror[MIRROR_FRONT], 805.0F, 0.1F, 0.0F) <
                     600.0F - 15.0F);
}

void test_nose_up_lengthens_the_fore_ray_and_shortens_the_aft_one(void)
{
    TEST_ASSERT_TRUE(altitude_under_mirror(&geometry.mirror[MIRROR_FORE], 812.0F, 0.0F, 0.1F) < 592.0F);
    TEST_ASSERT_TRUE(altitude_under_mirror(&geometry.mirror[MIRROR_AFT], 813.0F, 0.0F, 0.1F) > 606.0F);
}

static mirror_range_t range_at(const place_t *place, double height_mm, double roll, double pitch)
{
    const mirror_range_t range = {place->mirror, true, (float)ray_mm(place, height_mm, roll, pitch),
                                  4.0F,          35U,  0};
    return range;
}

void test_three_mirrors_give_one_height_under_tilt(void)
{
    mirror_range_t ranges[3];
    for (unsigned i = 0; i < 3; i++) {
        ranges[i] = range_at(&places[i], 700.0, 0.1, -0.08);
    }
    const altitude_t altitude = altitude_from_ranges(&geometry, ranges, 3, 0.1F, -0.08F);
    TEST_ASSERT_TRUE(altitude.valid);
    TEST_ASSERT_FALSE(altitude.disagree);
    TEST_ASSERT_FLOAT_WITHIN(1.5F, 700.0F, altitude.height_mm);
    TEST_ASSERT_EQUAL_UINT16(105, altitude.good_rays);
}

void test_the_mean_of_three_mirrors_can_be_tilted_anew(void)
{
    mirror_range_t ranges[3];
    for (unsigned i = 0; i < 3; i++) {
        ranges[i] = range_at(&places[i], 700.0, 0.1, -0.08);
    }
    const altitude_t as_it_was = altitude_from_ranges(&geometry, ranges, 3, 0.1F, -0.08F);
    const altitude_t tilted = altitude_from_ranges(&geometry, ranges, 3, -0.12F, 0.05F);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, as_it_was.height_mm, altitude_at_tilt(&as_it_was, 0.1F, -0.08F));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, tilted.height_mm, altitude_at_tilt(&as_it_was, -0.12F, 0.05F));
    TEST_ASSERT_TRUE(fabsf(tilted.height_mm - as_it_was.height_mm) > 1.0F);
}

void test_only_valid_groups_count(void)
{
    const mirror_range_t ranges[] = {
        {MIRROR_FRONT, false, 9999.0F, 900.0F, 3U, 0},
        {MIRROR_FORE, true, 512.0F, 7.0F, 20U, 0},
        {MIRROR_AFT, true, 533.0F, 11.0F, 15U, 0},
    };
    const altitude_t altitude = altitude_from_ranges(&geometry, ranges, 3, 0.0F, 0.0F);
    TEST_ASSERT_TRUE(altitude.valid);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 310.0F, altitude.height_mm); /* 300 and 320 */
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 522.5F, altitude.slant_mm);
    TEST_ASSERT_EQUAL_FLOAT(11.0F, altitude.spread_mm);
    TEST_ASSERT_EQUAL_UINT16(35, altitude.good_rays);
    TEST_ASSERT_FALSE(altitude.disagree);
}

void test_disagreement_is_more_than_50_mm_between_any_two(void)
{
    mirror_range_t ranges[] = {
        {MIRROR_FRONT, true, 505.0F, 1.0F, 35U, 0}, /* 300 */
        {MIRROR_FORE, true, 512.0F, 1.0F, 35U, 0},  /* 300 */
        {MIRROR_AFT, true, 562.5F, 1.0F, 35U, 0},   /* 349.5 */
    };
    TEST_ASSERT_FALSE(altitude_from_ranges(&geometry, ranges, 3, 0.0F, 0.0F).disagree);
    ranges[2].slant_mm = 563.5F; /* 350.5 */
    TEST_ASSERT_TRUE(altitude_from_ranges(&geometry, ranges, 3, 0.0F, 0.0F).disagree);
    ranges[2].slant_mm = 462.5F; /* 249.5 */
    TEST_ASSERT_TRUE(altitude_from_ranges(&geometry, ranges, 3, 0.0F, 0.0F).disagree);
    ranges[2].valid = false;
    TEST_ASSERT_FALSE(altitude_from_ranges(&geometry, ranges, 3, 0.0F, 0.0F).disagree);
}

void test_one_group_never_disagrees_even_far_below_zero(void)
{
    const mirror_range_t range = {MIRROR_FRONT, true, 100.0F, 1.0F, 35U, 0};
    const altitude_t altitude = altitude_from_ranges(&geometry, &range, 1, 0.0F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, -105.0F, altitude.height_mm);
    TEST_ASSERT_FALSE(altitude.disagree);
}

void test_no_valid_group_is_no_height_and_zeros(void)
{
    const mirror_range_t ranges[] = {{MIRROR_FRONT, false, 805.0F, 4.0F, 35U, 0},
                                     {MIRROR_FORE, false, 805.0F, 4.0F, 35U, 0}};
    for (size_t count = 0; count <= 2; count++) {
        const altitude_t altitude = altitude_from_ranges(&geometry, ranges, count, 0.1F, 0.1F);
        TEST_ASSERT_FALSE(altitude.valid);
        TEST_ASSERT_FALSE(altitude.disagree);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, altitude.height_mm);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, altitude.slant_mm);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, altitude.spread_mm);
        TEST_ASSERT_EQUAL_UINT16(0, altitude.good_rays);
    }
}
