/* Which rays of a scan look past the mirrors, and what they tell. */
#include "drivers/scip_free.h"

#include <string.h>

#include "unity.h"

static uint16_t points[SCIP_LAYOUT_POINTS_MAX];
static uint16_t ranges[SCIP_LAYOUT_POINTS_MAX];
static scip_scan_t scan;

void setUp(void)
{
    const scip_range_t range = scip_layout_range(&scip_layouts[SCIP_LAYOUT_THREE_MIRRORS], 250000U);

    (void)memset(&scan, 0, sizeof scan);
    scan.distance_mm = points;
    scan.capacity = SCIP_LAYOUT_POINTS_MAX;
    scan.first_step = range.first_step;
    scan.cluster = range.cluster;
    scan.characters = 2U;
    scan.points = (uint16_t)((range.last_step - range.first_step + 1U) / range.cluster);
    for (uint16_t i = 0U; i < SCIP_LAYOUT_POINTS_MAX; ++i) {
        points[i] = 1500U;
        ranges[i] = 4711U;
    }
}

void tearDown(void) {}

static void look(scip_layout_id_t layout)
{
    scip_free_ranges(ranges, &scan, &scip_layouts[layout]);
}

/* Point that has this step in it. */
static uint16_t at(uint16_t step)
{
    return (uint16_t)((step - scan.first_step) / scan.cluster);
}

void test_the_rays_between_three_mirrors_tell_and_those_of_a_mirror_or_its_edge_do_not(void)
{
    look(SCIP_LAYOUT_THREE_MIRRORS);
    TEST_ASSERT_EQUAL_UINT16(SCIP_FREE_UNSEEN, ranges[at(111U)]);
    TEST_ASSERT_EQUAL_UINT16(SCIP_FREE_UNSEEN, ranges[at(155U)]); /* 10 steps behind the window's end */
    TEST_ASSERT_EQUAL_UINT16(1500U, ranges[at(156U) + 1U]);
    TEST_ASSERT_EQUAL_UINT16(1500U, ranges[at(361U) - 1U]);
    TEST_ASSERT_EQUAL_UINT16(SCIP_FREE_UNSEEN, ranges[at(362U)]); /* 10 before the window */
    TEST_ASSERT_EQUAL_UINT16(SCIP_FREE_UNSEEN, ranges[at(389U)]);
    TEST_ASSERT_EQUAL_UINT16(1500U, ranges[at(500U)]);
    TEST_ASSERT_EQUAL_UINT16(SCIP_FREE_UNSEEN, ranges[scan.points - 1U]);
}

void test_no_ray_is_left_out_and_none_written_beyond_the_scan(void)
{
    look(SCIP_LAYOUT_THREE_MIRRORS);
    for (uint16_t i = 0U; i < scan.points; ++i) {
        TEST_ASSERT_NOT_EQUAL(4711U, ranges[i]);
    }
    TEST_ASSERT_EQUAL_UINT16(4711U, ranges[scan.points]);
}

void test_of_one_mirror_no_ray_is_free(void)
{
    scan.first_step = 372U;
    scan.cluster = 1U;
    scan.points = 35U;
    look(SCIP_LAYOUT_FRONT);
    for (uint16_t i = 0U; i < scan.points; ++i) {
        TEST_ASSERT_EQUAL_UINT16(SCIP_FREE_UNSEEN, ranges[i]);
    }
}

void test_a_code_is_nothing_and_so_is_what_is_too_far(void)
{
    points[at(200U)] = 0U;
    points[at(204U)] = 19U;
    points[at(208U)] = 20U;
    points[at(212U)] = 4094U;
    points[at(216U)] = 4095U;
    look(SCIP_LAYOUT_THREE_MIRRORS);
    TEST_ASSERT_EQUAL_UINT16(SCIP_FREE_NOTHING, ranges[at(200U)]);
    TEST_ASSERT_EQUAL_UINT16(SCIP_FREE_NOTHING, ranges[at(204U)]);
    TEST_ASSERT_EQUAL_UINT16(20U, ranges[at(208U)]);
    TEST_ASSERT_EQUAL_UINT16(4094U, ranges[at(212U)]);
    TEST_ASSERT_EQUAL_UINT16(SCIP_FREE_NOTHING, ranges[at(216U)]);
}

void test_three_characters_reach_further(void)
{
    scan.characters = 3U;
    points[at(200U)] = SCIP_DMAX_MM;
    points[at(204U)] = SCIP_DMAX_MM + 1U;
    look(SCIP_LAYOUT_THREE_MIRRORS);
    TEST_ASSERT_EQUAL_UINT16(SCIP_DMAX_MM, ranges[at(200U)]);
    TEST_ASSERT_EQUAL_UINT16(SCIP_FREE_NOTHING, ranges[at(204U)]);
}

void test_a_point_stands_in_the_middle_of_its_steps(void)
{
    TEST_ASSERT_EQUAL_FLOAT(112.5F, scip_free_step(&scan, 0U));
    TEST_ASSERT_EQUAL_FLOAT(116.5F, scip_free_step(&scan, 1U));
    TEST_ASSERT_EQUAL_UINT16(4U, scip_free_every(&scan));
    scan.cluster = 0U; /* one of 1, by the protocol */
    TEST_ASSERT_EQUAL_FLOAT(111.0F, scip_free_step(&scan, 0U));
    TEST_ASSERT_EQUAL_UINT16(1U, scip_free_every(&scan));
}
