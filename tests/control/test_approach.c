/* Walls that come nearer, and those that do not. */
#include "control/approach.h"

#include <math.h>
#include <stddef.h>

#include "unity.h"

#define DT_S 0.2F
#define DEG 0.0174532925F

static approach_t approach;
static uint32_t random_state;

void setUp(void)
{
    approach_reset(&approach);
    random_state = 1U;
}

void tearDown(void) {}

static wall_t at(float bearing_deg, float mm)
{
    return (wall_t){.bearing_rad = bearing_deg * DEG, .mm = mm, .sigma_mm = 5.0F, .faces = true};
}

static float noise_mm(void)
{
    random_state = random_state * 1664525U + 1013904223U;
    return ((float)(random_state >> 8) / 16777216.0F - 0.5F) * 17.3F;
}

/* One wall, looks of a vehicle that flies at this speed towards it. Returns the distance at which the warning
 * came; 0: it never came until the wall was 30 cm off. */
static float fly(wall_t wall, float mmps, int looks)
{
    for (int i = 0; i < looks && wall.mm > 300.0F; ++i) {
        wall_t seen = wall;

        seen.mm += noise_mm();
        approach_step(&approach, &seen, 1U, DT_S);
        if (approach_warning(&approach) != NULL) {
            return wall.mm;
        }
        wall.mm -= mmps * DT_S;
    }
    return 0.0F;
}

static void assert_known(float bearing_deg, float mmps, float within_mmps)
{
    const approach_wall_t *known[APPROACH_KNOWN_MAX];

    TEST_ASSERT_EQUAL_UINT16(1U, approach_known(&approach, known));
    TEST_ASSERT_FLOAT_WITHIN(within_mmps, mmps, known[0]->mmps);
    TEST_ASSERT_FLOAT_WITHIN(1.0F * DEG, bearing_deg * DEG, known[0]->bearing_rad);
}

void test_at_first_no_speed_is_known(void)
{
    const approach_wall_t *known[APPROACH_KNOWN_MAX];

    TEST_ASSERT_EQUAL_UINT16(0U, approach_known(&approach, known));
    (void)fly(at(90.0F, 1500.0F), 0.0F, 2);
    TEST_ASSERT_EQUAL_UINT16(0U, approach_known(&approach, known));
    TEST_ASSERT_NULL(approach_warning(&approach));
}

void test_a_steady_speed_is_known_within_its_error(void)
{
    const approach_wall_t *known[APPROACH_KNOWN_MAX];

    (void)fly(at(90.0F, 3900.0F), 250.0F, 12);
    (void)approach_known(&approach, known);
    TEST_ASSERT_TRUE(known[0]->sigma_mmps < 110.0F);
    assert_known(90.0F, 250.0F, 2.5F * known[0]->sigma_mmps);
}

void test_a_wall_that_goes_away_has_a_speed_below_0_and_never_warns(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.0F, fly(at(20.0F, 500.0F), -300.0F, 20));
    assert_known(20.0F, -300.0F, 100.0F);
}

/* 2.1 s at this speed, then braking with 6 degrees of tilt, and half the vehicle. */
void test_it_warns_as_long_as_a_pilot_who_is_told_now_can_stop(void)
{
    for (float mmps = 400.0F; mmps <= 1000.0F; mmps += 200.0F) {
        setUp();
        const float warned_mm = fly(at(0.0F, 3900.0F), mmps, 100);
        const float needed_mm = 352.0F + 2.1F * mmps + 0.5F * mmps * mmps / 1025.0F;

        TEST_ASSERT_FLOAT_WITHIN(0.2F * mmps + 250.0F, needed_mm, warned_mm);
    }
}

void test_a_flight_along_a_wall_never_warns_however_near_it_is(void)
{
    for (float mm = 400.0F; mm <= 2000.0F; mm += 200.0F) {
        setUp();
        TEST_ASSERT_EQUAL_FLOAT(0.0F, fly(at(90.0F, mm), 0.0F, 1000));
    }
}

/* 10 cm to either side in 4 s, as a pilot holds it: 0.16 m/s at most. */
void test_a_vehicle_that_sways_beside_a_wall_does_not_warn(void)
{
    for (int i = 0; i < 500; ++i) {
        wall_t seen = at(90.0F, 800.0F + 100.0F * sinf(6.2832F * (float)i * DT_S / 4.0F) + noise_mm());

        approach_step(&approach, &seen, 1U, DT_S);
        TEST_ASSERT_NULL(approach_warning(&approach));
    }
}

void test_a_wall_beside_the_way_never_warns(void)
{
    wall_t wall = at(0.0F, 3900.0F);

    wall.faces = false;
    TEST_ASSERT_EQUAL_FLOAT(0.0F, fly(wall, 800.0F, 100));
}

/* A door frame, a person behind a corner: what appears near is not what was far. */
void test_a_wall_that_appears_near_is_another_one(void)
{
    wall_t seen;

    (void)fly(at(30.0F, 3500.0F), 0.0F, 20);
    for (int i = 0; i < 20; ++i) {
        seen = at(30.0F, 900.0F + noise_mm());
        approach_step(&approach, &seen, 1U, DT_S);
        TEST_ASSERT_NULL(approach_warning(&approach));
    }
    assert_known(30.0F, 0.0F, 150.0F);
}

void test_a_turn_of_the_vehicle_is_no_speed(void)
{
    for (int i = 0; i < 6; ++i) {
        wall_t seen = at(150.0F - 14.0F * (float)i, 1000.0F + noise_mm());

        approach_step(&approach, &seen, 1U, DT_S);
        TEST_ASSERT_NULL(approach_warning(&approach));
    }
    assert_known(80.0F, 0.0F, 150.0F);
}

void test_a_wall_that_is_missed_twice_is_still_followed_and_then_forgotten(void)
{
    const approach_wall_t *known[APPROACH_KNOWN_MAX];
    const wall_t seen = at(90.0F, 1500.0F);

    (void)fly(seen, 0.0F, 5);
    approach_step(&approach, NULL, 0U, DT_S);
    TEST_ASSERT_EQUAL_UINT16(0U, approach_known(&approach, known)); /* not of now */
    approach_step(&approach, NULL, 0U, DT_S);
    approach_step(&approach, &seen, 1U, DT_S);
    TEST_ASSERT_EQUAL_UINT16(1U, approach_known(&approach, known));
    for (int i = 0; i < 3; ++i) {
        approach_step(&approach, NULL, 0U, DT_S);
    }
    approach_step(&approach, &seen, 1U, DT_S);
    TEST_ASSERT_EQUAL_UINT16(0U, approach_known(&approach, known));
}

void test_two_walls_that_are_parallel_tell_one_component_and_a_corner_tells_both(void)
{
    const approach_wall_t *known[APPROACH_KNOWN_MAX];
    wall_t seen[3] = {at(90.0F, 1500.0F), at(96.0F, 2500.0F), at(2.0F, 2000.0F)};

    for (int i = 0; i < 10; ++i) {
        approach_step(&approach, seen, 2U, DT_S);
    }
    TEST_ASSERT_EQUAL_UINT16(1U, approach_known(&approach, known));
    for (int i = 0; i < 10; ++i) {
        approach_step(&approach, seen, 3U, DT_S);
    }
    TEST_ASSERT_EQUAL_UINT16(2U, approach_known(&approach, known));
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 1.0F, fabsf(sinf(known[0]->bearing_rad - known[1]->bearing_rad)));
}

void test_of_two_walls_that_come_the_first_one_reached_is_told(void)
{
    wall_t seen[2] = {at(90.0F, 2000.0F), at(10.0F, 1700.0F)};
    const approach_wall_t *warned = NULL;

    for (int i = 0; i < 30 && warned == NULL; ++i) {
        approach_step(&approach, seen, 2U, DT_S);
        warned = approach_warning(&approach);
        seen[0].mm -= 500.0F * DT_S;
        seen[1].mm -= 500.0F * DT_S;
    }
    TEST_ASSERT_NOT_NULL(warned);
    TEST_ASSERT_FLOAT_WITHIN(1.0F * DEG, 10.0F * DEG, warned->bearing_rad);
}

void test_more_walls_than_there_is_room_for_do_no_harm(void)
{
    const approach_wall_t *known[APPROACH_KNOWN_MAX];
    wall_t seen[WALLS_MAX];

    for (int i = 0; i < 50; ++i) {
        for (uint16_t k = 0U; k < WALLS_MAX; ++k) {
            seen[k] = at(-170.0F + 50.0F * (float)k + 25.0F * (float)(i % 2), 1000.0F);
        }
        approach_step(&approach, seen, WALLS_MAX, DT_S);
        TEST_ASSERT_NULL(approach_warning(&approach));
    }
    TEST_ASSERT_TRUE(approach_known(&approach, known) <= APPROACH_KNOWN_MAX);
}
