/* Walls in a look round, made by geometry that knows nothing of the fit. */
#include "control/walls.h"

#include <math.h>
#include <stddef.h>

#include "unity.h"

#define DEG 0.0174532925F
#define RAYS 136U
#define ABEAM_MM 115.0F

static parameters_t parameters;
static around_look_t look;
static wall_t walls[WALLS_MAX];
static uint16_t count;
static uint32_t random_state;

void setUp(void)
{
    parameters_init(&parameters);
    around_begin(&look, &parameters, 112.5F, 4U, RAYS);
    for (uint16_t i = 0U; i < RAYS; ++i) {
        look.mm[i] = AROUND_NOTHING;
    }
    count = 0U;
    random_state = 1U;
}

void tearDown(void) {}

/* Uniform, with a standard deviation of 5 mm. */
static float noise_mm(void)
{
    random_state = random_state * 1664525U + 1013904223U;
    return ((float)(random_state >> 8) / 16777216.0F - 0.5F) * 17.3F;
}

static bool in_arc(float bearing_rad, float from_deg, float to_deg)
{
    return bearing_rad >= from_deg * DEG && bearing_rad <= to_deg * DEG;
}

/* A wall whose perpendicular from the vehicle's centre has this bearing and length, seen between two
 * bearings; nearer things stay before it. noise: 0 or 1. */
static void build(float bearing_deg, float mm, float from_deg, float to_deg, float noise)
{
    for (uint16_t i = 0U; i < RAYS; ++i) {
        const float ray_rad = around_ray_rad(&look, i);
        const float towards = cosf(ray_rad - bearing_deg * DEG);
        /* The scanner stands to the right of the centre. */
        const float range_mm = (mm - ABEAM_MM * sinf(bearing_deg * DEG)) / towards + noise * noise_mm();

        if (in_arc(ray_rad, from_deg, to_deg) && towards > 0.05F && range_mm < 4000.0F &&
            (look.mm[i] == AROUND_NOTHING || range_mm < (float)look.mm[i])) {
            look.mm[i] = (uint16_t)(range_mm + 0.5F);
        }
    }
}

static void hide(float from_deg, float to_deg)
{
    for (uint16_t i = 0U; i < RAYS; ++i) {
        if (in_arc(around_ray_rad(&look, i), from_deg, to_deg)) {
            look.mm[i] = AROUND_UNSEEN;
        }
    }
}

static void find(void)
{
    count = walls_find(walls, &look, ABEAM_MM);
}

static void assert_wall(const wall_t *wall, float bearing_deg, float mm)
{
    TEST_ASSERT_FLOAT_WITHIN(4.0F * wall->sigma_mm, mm, wall->mm);
    TEST_ASSERT_FLOAT_WITHIN(2.0F * DEG, bearing_deg * DEG, wall->bearing_rad);
}

void test_nothing_has_no_wall(void)
{
    find();
    TEST_ASSERT_EQUAL_UINT16(0U, count);
}

void test_a_wall_is_found_from_the_vehicle_s_centre(void)
{
    build(90.0F, 1500.0F, 40.0F, 140.0F, 0.0F);
    find();
    TEST_ASSERT_EQUAL_UINT16(1U, count);
    assert_wall(&walls[0], 90.0F, 1500.0F);
    TEST_ASSERT_TRUE(walls[0].faces);
    TEST_ASSERT_TRUE(walls[0].sigma_mm < 5.0F);
}

void test_a_wall_ahead_is_known_where_its_nearest_point_is_behind_a_mirror(void)
{
    build(0.0F, 2000.0F, 10.0F, 45.0F, 1.0F);
    hide(-20.0F, 10.0F);
    find();
    TEST_ASSERT_EQUAL_UINT16(1U, count);
    assert_wall(&walls[0], 0.0F, 2000.0F);
    TEST_ASSERT_TRUE(walls[0].faces);
}

void test_walls_lie_in_their_own_direction_on_every_side(void)
{
    for (int degrees = 10; degrees <= 170; degrees += 10) {
        setUp();
        build((float)degrees, 1200.0F, (float)degrees - 20.0F, (float)degrees + 20.0F, 1.0F);
        find();
        TEST_ASSERT_EQUAL_UINT16(1U, count);
        assert_wall(&walls[0], (float)degrees, 1200.0F);
    }
}

void test_a_corner_is_two_walls(void)
{
    build(90.0F, 1500.0F, 0.0F, 100.0F, 1.0F);
    build(0.0F, 2000.0F, 5.0F, 80.0F, 1.0F);
    find();
    TEST_ASSERT_EQUAL_UINT16(2U, count);
    assert_wall(&walls[0], 90.0F, 1500.0F); /* the scanner begins aft */
    assert_wall(&walls[1], 0.0F, 2000.0F);
}

/* A row of few rays has little length, and its bearing and the distance to what continues it are uncertain.
 * The noise is along the rays, which meet this wall at 37 degrees: across it there is less. */
void test_the_error_is_what_it_says_and_greater_for_a_wall_that_is_seen_aside(void)
{
    float squares = 0.0F;
    int found = 0;
    float told = 0.0F;

    for (uint32_t seed = 1U; seed <= 400U; ++seed) {
        setUp();
        random_state = seed * 7919U;
        build(0.0F, 2000.0F, 25.0F, 50.0F, 1.0F);
        find();
        if (count == 1U) {
            const float off_mm = walls[0].mm - 2000.0F;

            squares += off_mm * off_mm;
            told += walls[0].sigma_mm * walls[0].sigma_mm -
                    9.0F; /* but for what all rays share, which is 0 here */
            found++;
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(380, found);
    TEST_ASSERT_FLOAT_WITHIN(0.35F, 0.75F, squares / told);
    TEST_ASSERT_TRUE(sqrtf(told / (float)found) > 2.0F);
}

void test_a_wall_that_ends_before_the_way_does_not_face_it(void)
{
    build(0.0F, 2000.0F, 35.0F, 55.0F, 0.0F); /* from 1.5 m to the right on: the way ahead is free */
    find();
    TEST_ASSERT_EQUAL_UINT16(1U, count);
    assert_wall(&walls[0], 0.0F, 2000.0F);
    TEST_ASSERT_FALSE(walls[0].faces);
}

void test_a_wall_that_ends_less_than_half_a_vehicle_beside_the_way_faces_it(void)
{
    build(0.0F, 2000.0F, 5.0F, 40.0F, 0.0F); /* from 0.29 m to the right */
    find();
    TEST_ASSERT_TRUE(walls[0].faces);
}

void test_five_rays_are_no_wall_and_what_is_rough_is_none(void)
{
    build(60.0F, 1000.0F, 58.0F, 64.5F, 0.0F);
    find();
    TEST_ASSERT_EQUAL_UINT16(0U, count);
    setUp();
    build(90.0F, 1500.0F, 60.0F, 120.0F, 0.0F);
    for (uint16_t i = 0U; i < RAYS; ++i) {
        if (look.mm[i] != AROUND_NOTHING) {
            look.mm[i] = (uint16_t)(look.mm[i] + ((i / 2U) % 2U == 0U ? 50U : 0U));
        }
    }
    find();
    TEST_ASSERT_EQUAL_UINT16(0U, count);
}

void test_a_door_in_a_wall_makes_two_of_it(void)
{
    build(90.0F, 1500.0F, 60.0F, 85.0F, 1.0F);
    build(90.0F, 1500.0F, 95.0F, 120.0F, 1.0F);
    find();
    TEST_ASSERT_EQUAL_UINT16(2U, count);
    assert_wall(&walls[0], 90.0F, 1500.0F);
    assert_wall(&walls[1], 90.0F, 1500.0F);
}

void test_more_rows_than_there_is_room_for_are_left_out(void)
{
    for (int i = 0; i < 9; ++i) {
        build(10.0F + 18.0F * (float)i, 1000.0F + 400.0F * (float)(i % 2), 10.0F + 18.0F * (float)i - 8.0F,
              10.0F + 18.0F * (float)i + 8.0F, 0.0F);
    }
    find();
    TEST_ASSERT_EQUAL_UINT16(WALLS_MAX, count);
}
