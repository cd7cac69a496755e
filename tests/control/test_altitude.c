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

static double dot(vector_t a, vector_t b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vector_t plus(vector_t a, double times, vector_t b)
{
    return (vector_t){a.x + times * b.x, a.y + times * b.y, a.z + times * b.z};
}

/* Length of the ray of one step, 1024 in a turn, 384 outwards, to the nose first, by reflection: the mirror
 * turns what comes from the sensor along the line to its place of reflection straight down. */
static double ray_of_step_mm(const place_t *place, int step, double height_mm, double roll, double pitch)
{
    const double turn = (step - 384) * 360.0 / 1024.0 * DEGREE;
    const vector_t sensor = {0.0, 115.0, place->reflection.z}, ray = {sin(turn), cos(turn), 0.0};
    const vector_t to_mirror = plus(place->reflection, -1.0, sensor);
    const vector_t normal = {to_mirror.x / sqrt(2.0 * dot(to_mirror, to_mirror)),
                             to_mirror.y / sqrt(2.0 * dot(to_mirror, to_mirror)), sqrt(0.5)};
    const double before = dot(to_mirror, normal) / dot(ray, normal);
    const vector_t at = plus(sensor, before, ray), bent = plus(ray, -2.0 * dot(ray, normal), normal);

    return before + (height_mm + turned(at, roll, pitch).z) / -turned(bent, roll, pitch).z;
}

static mirror_range_t along_axis(mirror_t mirror, bool valid, float slant_mm, float spread_mm, uint16_t rays)
{
    return (mirror_range_t){
        .mirror = mirror, .valid = valid, .slant_mm = slant_mm, .spread_mm = spread_mm, .good_rays = rays};
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

/* Of the rays from one step to another. */
static mirror_range_t fan_of(const place_t *place, int first, int last, float axis, double height_mm,
                             double roll, double pitch)
{
    const double rays = last - first + 1;
    double slants = 0.0;

    for (int step = first; step <= last; step++) {
        slants += ray_of_step_mm(place, step, height_mm, roll, pitch);
    }
    return (mirror_range_t){.mirror = place->mirror,
                            .valid = true,
                            .slant_mm = (float)(slants / rays),
                            .good_rays = (uint16_t)rays,
                            .aside_steps = (float)(0.5 * (first + last)) - axis,
                            .wide_steps2 = (float)((rays * rays - 1.0) / 12.0)};
}

static const place_t *place_of(mirror_t mirror)
{
    const place_t *place = places;

    while (place->mirror != mirror) {
        place++;
    }
    return place;
}

/* The default groups, and their lower and upper halves: what is left of a beam of which the other half is
 * lost. As one ray, the mean of 35 is up to 10 mm off at 2 m: its fan, and its side by the tilt. */
void test_a_fan_of_rays_tells_the_height_of_the_ray_along_the_axis(void)
{
    parameters_t parameters;

    parameters_init(&parameters);
    const mirror_windows_t windows = altitude_windows_of(&parameters);
    TEST_ASSERT_EQUAL_UINT16(3U, windows.count);
    for (int part = 0; part < 3; part++) {
        for (uint16_t i = 0; i < windows.count; i++) {
            const place_t *const place = place_of(windows.mirror[i]);
            const int first = windows.middle[i] - (part == 2 ? 0 : windows.reach);
            const int last = windows.middle[i] + (part == 1 ? 0 : windows.reach);

            for (int tilt = 0; tilt < 21 * 21; tilt++) {
                const double r = (tilt % 21 - 10) * DEGREE, p = (tilt / 21 - 10) * DEGREE;

                for (int height = 0; height <= 2000; height += 400) {
                    const mirror_range_t range = fan_of(place, first, last, windows.axis[i], height, r, p);
                    const altitude_t altitude = altitude_from_ranges(&geometry, &range, 1, (float)r,
                                                                     (float)p);
                    const float off_mm = altitude.height_mm - (float)(height + seeds_error_mm(place, r, p));
                    char where[64];

                    snprintf(where, sizeof where, "mirror %d part %d tilt %d height %d", (int)place->mirror,
                             part, tilt, height);
                    TEST_ASSERT_FLOAT_WITHIN_MESSAGE(1.0F, 0.0F, off_mm, where);
                    TEST_ASSERT_FLOAT_WITHIN(0.01F, altitude.height_mm,
                                             altitude_at_tilt(&altitude, (float)r, (float)p));
                }
            }
        }
    }
}

void test_level_a_fan_is_right_within_a_tenth_of_a_millimetre_at_two_metres(void)
{
    parameters_t parameters;

    parameters_init(&parameters);
    const mirror_windows_t windows = altitude_windows_of(&parameters);
    for (uint16_t i = 0; i < windows.count; i++) {
        const place_t *const place = place_of(windows.mirror[i]);
        const mirror_range_t range = fan_of(place, windows.middle[i] - windows.reach,
                                            windows.middle[i] + windows.reach, windows.axis[i], 2000.0, 0.0,
                                            0.0);
        const altitude_t altitude = altitude_from_ranges(&geometry, &range, 1, 0.0F, 0.0F);

        TEST_ASSERT_FLOAT_WITHIN(0.1F, 2000.0F, altitude.height_mm);
        TEST_ASSERT_TRUE(range.slant_mm > altitude.slant_mm + 3.5F); /* what it was taken for before */
    }
}

/* A scanner that is turned on its bracket: the same rays have other numbers. */
void test_the_axis_of_a_mirror_goes_with_the_middle_of_its_rays(void)
{
    parameters_t parameters;

    parameters_init(&parameters);
    const mirror_windows_t drawn = altitude_windows_of(&parameters);
    parameters.value[PARAMETER_SF] += 7.0F;
    parameters.value[PARAMETER_S1] += 7.0F;
    parameters.value[PARAMETER_S2] += 7.0F;
    const mirror_windows_t aside = altitude_windows_of(&parameters);
    TEST_ASSERT_EQUAL_FLOAT(384.0F, drawn.axis[1]);
    for (uint16_t i = 0; i < drawn.count; i++) {
        TEST_ASSERT_EQUAL_FLOAT(drawn.axis[i] + 7.0F, aside.axis[i]);
        TEST_ASSERT_EQUAL_UINT16(drawn.middle[i] + 7U, aside.middle[i]);
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
                mirror_range_t range = along_axis(other[i].mirror, true, 0.0F, 4.0F, 35U);

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
    return along_axis(place->mirror, true, (float)ray_mm(place, height_mm, roll, pitch), 4.0F, 35U);
}

void test_three_mirrors_give_one_height_under_tilt(void)
{
    mirror_range_t ranges[3];
    for (unsigned i = 0; i < 3; i++) {
        ranges[i] = range_at(&places[i], 700.0, 0.1, -0.08);
    }
    const altitude_t altitude = altitude_from_ranges(&geometry, ranges, 3, 0.1F, -0.08F);
    TEST_ASSERT_TRUE(altitude.valid);
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
        along_axis(MIRROR_FRONT, false, 9999.0F, 900.0F, 3U),
        along_axis(MIRROR_FORE, true, 512.0F, 7.0F, 20U),
        along_axis(MIRROR_AFT, true, 533.0F, 11.0F, 15U),
    };
    const altitude_t altitude = altitude_from_ranges(&geometry, ranges, 3, 0.0F, 0.0F);
    TEST_ASSERT_TRUE(altitude.valid);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 310.0F, altitude.height_mm); /* 300 and 320 */
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 522.5F, altitude.slant_mm);
    TEST_ASSERT_EQUAL_FLOAT(11.0F, altitude.spread_mm);
    TEST_ASSERT_EQUAL_UINT16(35, altitude.good_rays);
}

void test_a_group_far_below_zero_is_a_height(void)
{
    const mirror_range_t range = along_axis(MIRROR_FRONT, true, 100.0F, 1.0F, 35U);
    const altitude_t altitude = altitude_from_ranges(&geometry, &range, 1, 0.0F, 0.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, -105.0F, altitude.height_mm);
}

void test_no_valid_group_is_no_height_and_zeros(void)
{
    const mirror_range_t ranges[] = {along_axis(MIRROR_FRONT, false, 805.0F, 4.0F, 35U),
                                     along_axis(MIRROR_FORE, false, 805.0F, 4.0F, 35U)};
    for (size_t count = 0; count <= 2; count++) {
        const altitude_t altitude = altitude_from_ranges(&geometry, ranges, count, 0.1F, 0.1F);
        TEST_ASSERT_FALSE(altitude.valid);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, altitude.height_mm);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, altitude.slant_mm);
        TEST_ASSERT_EQUAL_FLOAT(0.0F, altitude.spread_mm);
        TEST_ASSERT_EQUAL_UINT16(0, altitude.good_rays);
    }
}
