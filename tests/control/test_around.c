/* What stands around, by rays that no mirror bends. */
#include "control/around.h"

#include <math.h>
#include <string.h>

#include "unity.h"

#define DEG 0.0174532925F
#define RAYS 136U

static parameters_t parameters;
static around_look_t look, before, confirmed;
static around_place_t place;
static uint16_t sectors[AROUND_SECTORS];

static void put(uint16_t ray, uint16_t mm)
{
    look.mm[ray] = mm;
}

/* A look of three mirrors over what no mirror hides, at 60 cm above the floor, level. */
void setUp(void)
{
    parameters_init(&parameters);
    around_begin(&look, &parameters, 112.5F, 4U, RAYS);
    for (uint16_t i = 0U; i < RAYS; ++i) {
        put(i, AROUND_UNSEEN);
    }
    before = (around_look_t){.count = 0U};
    place = around_place(&parameters, 600.0F, 0.0F, 0.0F);
}

void tearDown(void) {}

/* Ray whose bearing is nearest. */
static uint16_t at(float degrees)
{
    uint16_t best = 0U;

    for (uint16_t i = 1U; i < RAYS; ++i) {
        if (fabsf(around_ray_rad(&look, i) - degrees * DEG) <
            fabsf(around_ray_rad(&look, best) - degrees * DEG)) {
            best = i;
        }
    }
    return best;
}

static uint16_t seen(uint16_t ray)
{
    return look.mm[ray];
}

static uint16_t kept(uint16_t ray)
{
    return confirmed.mm[ray];
}

static void confirm(void)
{
    around_confirm(&confirmed, &look, &before);
}

static void assert_bearing(float degrees, float step)
{
    around_begin(&look, &parameters, step, 1U, 1U);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, degrees, around_ray_rad(&look, 0U) / DEG);
}

void test_the_scanner_looks_to_the_right_and_turns_towards_the_nose(void)
{
    assert_bearing(90.0F, 384.0F);
    assert_bearing(0.0F, 640.0F);
    assert_bearing(-15.82F, 685.0F);
    assert_bearing(179.65F, 129.0F);
    assert_bearing(-174.02F, 111.0F);
}

void test_a_scanner_that_is_mounted_turned_is_known_by_where_its_mirrors_were_found(void)
{
    parameters.value[PARAMETER_SF] += 20.0F;
    parameters.value[PARAMETER_S1] += 20.0F;
    parameters.value[PARAMETER_S2] += 20.0F;
    assert_bearing(90.0F, 404.0F);
}

void test_the_bracket_of_two_mirrors_is_not_turned(void)
{
    parameters.value[PARAMETER_S1] = 263.0F;
    parameters.value[PARAMETER_S2] = 505.0F;
    assert_bearing(90.0F, 384.0F);
}

void test_a_level_ray_keeps_its_length(void)
{
    put(at(45.0F), 2000U);
    around_level(&look, &place);
    TEST_ASSERT_EQUAL_UINT16(2000U, seen(at(45.0F)));
    TEST_ASSERT_EQUAL_UINT16(AROUND_UNSEEN, seen(at(46.5F)));
}

void test_a_tilted_ray_tells_its_level_length(void)
{
    place = around_place(&parameters, 2000.0F, 0.0F, 15.0F * DEG); /* nose up */
    put(at(0.0F), 2000U);
    around_level(&look, &place);
    TEST_ASSERT_UINT16_WITHIN(1U, 1932U, seen(at(0.0F)));
}

/* Nose down by 12 degrees at 70 cm, the floor is met ahead at 3.37 m, and as near as 2.90 m with a tilt that
 * is 2 degrees wrong. */
void test_a_vehicle_that_leans_forward_does_not_take_the_floor_for_a_wall(void)
{
    place = around_place(&parameters, 600.0F, 0.0F, -12.0F * DEG);
    put(at(0.5F), 3370U);
    put(at(2.0F), 2950U);
    put(at(5.0F), 2700U);
    around_level(&look, &place);
    TEST_ASSERT_EQUAL_UINT16(AROUND_NOTHING, seen(at(0.5F)));
    TEST_ASSERT_EQUAL_UINT16(AROUND_NOTHING, seen(at(2.0F)));
    TEST_ASSERT_UINT16_WITHIN(10U, 2641U, seen(at(5.0F)));
}

void test_a_lean_to_the_right_finds_its_floor_on_the_right(void)
{
    place = around_place(&parameters, 600.0F, -12.0F * DEG, 0.0F);
    put(at(70.0F), 3370U);
    put(at(10.0F), 3370U);
    around_level(&look, &place);
    TEST_ASSERT_EQUAL_UINT16(AROUND_NOTHING, seen(at(70.0F)));
    TEST_ASSERT_NOT_EQUAL(AROUND_NOTHING, seen(at(10.0F)));
}

void test_without_a_height_the_gear_counts_as_on_the_floor(void)
{
    const around_place_t unknown = around_place(&parameters, NAN, 0.0F, 0.0F);
    const around_place_t sunk = around_place(&parameters, -40.0F, 0.0F, 0.0F);

    TEST_ASSERT_EQUAL_FLOAT(100.0F, unknown.above_floor_mm);
    TEST_ASSERT_EQUAL_FLOAT(100.0F, sunk.above_floor_mm);
}

void test_a_single_ray_is_no_thing(void)
{
    put(at(44.0F), 3000U);
    put(at(47.0F), 3000U);
    put(at(45.5F), 700U);
    confirm();
    TEST_ASSERT_EQUAL_UINT16(AROUND_NOTHING, kept(at(45.5F)));
}

void test_two_neighbours_are_one(void)
{
    put(at(44.0F), 700U);
    put(at(44.0F) + 1U, 780U);
    confirm();
    TEST_ASSERT_EQUAL_UINT16(700U, kept(at(44.0F)));
    TEST_ASSERT_EQUAL_UINT16(780U, kept(at(44.0F) + 1U));
}

void test_a_thin_post_is_one_from_the_second_look_on_also_when_the_vehicle_turns(void)
{
    put(at(44.0F), 700U);
    before = look;
    confirm();
    TEST_ASSERT_EQUAL_UINT16(700U, kept(at(44.0F)));
    put(at(44.0F), AROUND_NOTHING);
    put(at(44.0F) + 1U, 650U);
    confirm();
    TEST_ASSERT_EQUAL_UINT16(650U, kept(at(44.0F) + 1U));
}

void test_a_look_of_other_rays_confirms_nothing(void)
{
    put(at(44.0F), 700U);
    before = look;
    before.first_rad += 0.1F;
    confirm();
    TEST_ASSERT_EQUAL_UINT16(AROUND_NOTHING, kept(at(44.0F)));
}

void test_the_first_and_the_last_ray_have_one_neighbour(void)
{
    put(0, 700U);
    put(RAYS - 1U, 900U);
    confirm();
    TEST_ASSERT_EQUAL_UINT16(AROUND_NOTHING, kept(0));
    TEST_ASSERT_EQUAL_UINT16(AROUND_NOTHING, kept(RAYS - 1U));
}

void test_noise_close_by_is_the_same_thing_and_an_eighth_further_is_too(void)
{
    TEST_ASSERT_TRUE(around_same(110U, 140U));
    TEST_ASSERT_FALSE(around_same(110U, 141U));
    TEST_ASSERT_TRUE(around_same(2250U, 2000U));
    TEST_ASSERT_FALSE(around_same(2000U, 2251U));
    TEST_ASSERT_FALSE(around_same(AROUND_NOTHING, AROUND_NOTHING));
    TEST_ASSERT_FALSE(around_same(AROUND_UNSEEN, AROUND_UNSEEN));
}

static void to_sectors(void)
{
    around_sectors(sectors, &look);
}

void test_a_sector_tells_its_nearest(void)
{
    put(at(45.5F), 900U);
    put(at(46.9F), 800U);
    put(at(48.3F), AROUND_NOTHING);
    to_sectors();
    TEST_ASSERT_EQUAL_UINT16(800U, sectors[9]);
}

void test_a_sector_that_is_looked_into_and_empty_is_not_one_that_nobody_looks_into(void)
{
    put(at(47.5F), AROUND_NOTHING);
    to_sectors();
    TEST_ASSERT_EQUAL_UINT16(AROUND_NOTHING, sectors[9]);
    TEST_ASSERT_EQUAL_UINT16(AROUND_UNSEEN, sectors[8]);
    TEST_ASSERT_EQUAL_UINT16(AROUND_UNSEEN, sectors[60]);
}

void test_a_bearing_on_the_left_is_one_of_the_last_sectors(void)
{
    around_begin(&look, &parameters, 685.0F, 4U, 1U); /* 15.8 degrees to the left of the nose */
    put(0, 1234U);
    to_sectors();
    TEST_ASSERT_EQUAL_UINT16(1234U, sectors[68]);
}

void test_no_bearing_leaves_the_sectors(void)
{
    for (uint16_t step = 0U; step < 1024U; ++step) {
        around_begin(&look, &parameters, (float)step, 4U, 1U);
        put(0, 1000U);
        to_sectors();
        uint16_t told = 0U;
        for (uint16_t s = 0U; s < AROUND_SECTORS; ++s) {
            told = (uint16_t)(told + (sectors[s] == 1000U ? 1U : 0U));
        }
        TEST_ASSERT_EQUAL_UINT16(1U, told);
    }
}
