/* What a row of spots makes of a ramp: which mirror may join or leave it, and what ground it stands on then.
 */
#include "control/est/terrain_ramp.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define ALL 7U
#define BIT(mirror) ((uint16_t)(1U << (uint16_t)(mirror)))
#define GAP_S 0.1F

static const float fore_m[MIRROR_COUNT] = {
    [MIRROR_FRONT] = 0.0F, [MIRROR_FORE] = 0.11F, [MIRROR_AFT] = -0.12F};
static const float no_step_m[MIRROR_COUNT];
static terrain_hypothesis_t h;

void setUp(void)
{
    memset(&h, 0, sizeof h);
    h.share = 1.0F;
    h.x[TERRAIN_ALTITUDE] = 0.7F;
    h.x[TERRAIN_SLOPE] = 1.0F;
    for (uint16_t i = 0U; i < (uint16_t)TERRAIN_STATES; i++) {
        h.p[i][i] = 1.0e-4F;
    }
}

void tearDown(void) {}

static terrain_passage_t going(float speed_mps, float sigma_mps, uint16_t ramps)
{
    h.ramps = ramps;
    h.x[TERRAIN_GROUND_SPEED] = speed_mps;
    h.p[TERRAIN_GROUND_SPEED][TERRAIN_GROUND_SPEED] = sigma_mps * sigma_mps;
    return terrain_ramp_passage(&h, ALL, 0.0F, GAP_S);
}

static void stand_at(float front_m, float fore_ground_m, float aft_m)
{
    h.x[terrain_ground_of(MIRROR_FRONT)] = front_m;
    h.x[terrain_ground_of(MIRROR_FORE)] = fore_ground_m;
    h.x[terrain_ground_of(MIRROR_AFT)] = aft_m;
}

void test_the_direction_is_as_sure_as_the_speed(void)
{
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.5F, going(0.0F, 0.3F, 0U).fore);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.84F, going(0.3F, 0.3F, 0U).fore);
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.16F, going(-0.3F, 0.3F, 0U).fore);
    TEST_ASSERT_TRUE(going(1.0F, 0.1F, 0U).fore > 0.999F);
    h.x[TERRAIN_GROUND_SPEED] = 0.0F;
    TEST_ASSERT_TRUE(terrain_ramp_passage(&h, ALL, 0.1F, GAP_S).fore > 0.99F); /* 1 m/s by the tilt */
    TEST_ASSERT_FALSE(isnan(going(1.0e6F, 0.0F, 0U).fore));
}

void test_all_that_may_happen_before_a_scan_adds_up_to_one(void)
{
    for (uint16_t told = 1U; told <= ALL; told++) {
        for (uint16_t ramps = 0U; ramps <= ALL; ramps++) {
            for (float speed_mps = -0.6F; speed_mps < 0.7F; speed_mps += 0.3F) {
                terrain_passage_t passage = going(speed_mps, 0.3F, ramps);
                float in_a_row = 0.0F;
                float oblique = 0.0F;

                passage.told = told;
                for (uint16_t rising = 0U; rising <= ALL; rising++) {
                    if ((rising & (uint16_t)~told) == 0U) {
                        in_a_row += terrain_ramp_prior(&passage, rising, false);
                        oblique += (ramps != 0U || rising != 0U) ? terrain_ramp_prior(&passage, rising, true)
                                                                 : 0.0F;
                    }
                }
                if (ramps != 0U) { /* what it is stays so */
                    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 1.0F, in_a_row);
                    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 1.0F, oblique);
                } else { /* one or the other begins; each begins a ramp by nearly the same share */
                    TEST_ASSERT_FLOAT_WITHIN(0.003F, 1.0F, in_a_row + oblique);
                }
            }
        }
    }
}

void test_the_leading_mirror_meets_a_ramp_and_the_others_follow_in_their_order(void)
{
    const terrain_passage_t level = going(0.5F, 0.1F, 0U);
    const terrain_passage_t first = going(0.5F, 0.1F, BIT(MIRROR_FORE));
    const terrain_passage_t back = going(-0.5F, 0.1F, BIT(MIRROR_FORE));
    const uint16_t two = BIT(MIRROR_FORE) | BIT(MIRROR_FRONT);

    TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.005F, 2.0F * terrain_ramp_prior(&level, BIT(MIRROR_FORE), false));
    TEST_ASSERT_TRUE(terrain_ramp_prior(&first, two, false) > 0.2F);
    TEST_ASSERT_TRUE(terrain_ramp_prior(&first, ALL, false) < 0.01F * terrain_ramp_prior(&first, two, false));
    TEST_ASSERT_TRUE(terrain_ramp_prior(&back, two, false) < 0.05F * terrain_ramp_prior(&first, two, false));
}

void test_none_leaves_a_ramp_before_the_one_in_front_of_it(void)
{
    const terrain_passage_t on = going(0.5F, 0.1F, ALL);

    TEST_ASSERT_TRUE(terrain_ramp_prior(&on, BIT(MIRROR_FRONT) | BIT(MIRROR_AFT), false) > 0.05F);
    TEST_ASSERT_TRUE(terrain_ramp_prior(&on, BIT(MIRROR_FORE) | BIT(MIRROR_FRONT), false) < 0.01F);
}

/* Ground of the aft one: 0. The plane of the others is 0.12 m below the front one's ground there. */
void test_a_mirror_joins_a_ramp_where_its_ground_and_the_plane_meet(void)
{
    const terrain_passage_t passage = going(0.3F, 0.1F, BIT(MIRROR_FORE) | BIT(MIRROR_FRONT));

    for (int at = 0; at < 2; at++) {
        setUp();
        stand_at((at == 0) ? 0.12F : 0.05F, (at == 0) ? 0.23F : 0.16F, 0.0F);
        h.ramps = ALL;
        terrain_ramp_settle(&h, &passage, 0U, no_step_m, fore_m);
        TEST_ASSERT_TRUE((at == 0) ? h.share > 0.8F : h.share < 0.05F);
    }
}

void test_mirrors_that_stay_on_a_ramp_are_bound_to_its_plane_at_no_cost(void)
{
    const terrain_passage_t passage = going(0.3F, 0.1F, ALL);

    stand_at(0.14F, 0.23F, 0.0F);
    h.ramps = ALL;
    terrain_ramp_settle(&h, &passage, 0U, no_step_m, fore_m);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, h.share);
    TEST_ASSERT_FLOAT_WITHIN(0.012F, 0.12F * h.x[TERRAIN_SLOPE],
                             h.x[terrain_ground_of(MIRROR_FRONT)] - h.x[terrain_ground_of(MIRROR_AFT)]);
}

void test_one_that_leaves_a_ramp_stands_on_the_ground_of_those_that_left_it_before(void)
{
    const terrain_passage_t passage = going(0.3F, 0.1F, BIT(MIRROR_FRONT) | BIT(MIRROR_AFT));

    for (int at = 0; at < 2; at++) {
        setUp();
        stand_at((at == 0) ? 0.25F : 0.18F, 0.25F, 0.13F);
        h.ramps = BIT(MIRROR_AFT);
        terrain_ramp_settle(&h, &passage, 0U, no_step_m, fore_m);
        TEST_ASSERT_TRUE((at == 0) ? h.share > 0.9F : h.share < 0.05F);
    }
}

/* The front mirror stands aside of the other two: flown to the right it meets the ramp first, or last. */
void test_a_ramp_that_is_met_obliquely_has_no_order(void)
{
    const terrain_passage_t on = going(0.5F, 0.1F, BIT(MIRROR_FRONT));
    const uint16_t with_aft = BIT(MIRROR_FRONT) | BIT(MIRROR_AFT);
    const uint16_t with_fore = BIT(MIRROR_FRONT) | BIT(MIRROR_FORE);

    TEST_ASSERT_EQUAL_FLOAT(terrain_ramp_prior(&on, with_aft, true),
                            terrain_ramp_prior(&on, with_fore, true));
    TEST_ASSERT_TRUE(terrain_ramp_prior(&on, ALL, true) > 50.0F * terrain_ramp_prior(&on, ALL, false));
}

void test_over_a_ramp_that_is_met_obliquely_no_plane_and_no_level_is_known(void)
{
    const terrain_passage_t passage = going(0.3F, 0.1F, BIT(MIRROR_FORE) | BIT(MIRROR_FRONT));
    const terrain_hypothesis_t before = h;

    stand_at(0.05F, 0.16F, 0.0F); /* off the plane */
    h.oblique = true;
    h.ramps = ALL;
    terrain_ramp_settle(&h, &passage, 0U, no_step_m, fore_m);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.5F, h.share); /* one has joined, anywhere */
    TEST_ASSERT_EQUAL_FLOAT(0.0F, h.x[terrain_ground_of(MIRROR_AFT)]);
    TEST_ASSERT_EQUAL_MEMORY(before.p, h.p, sizeof h.p);

    h.share = 1.0F;
    h.ramps = BIT(MIRROR_FRONT); /* two have left it */
    terrain_ramp_settle(&h, &(terrain_passage_t){.ramps = ALL, .told = ALL}, 0U, no_step_m, fore_m);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6F, 0.25F, h.share);
}

/* Tail first down the slope, or nose first: what leads comes down to the ground of the start, 30 mm off. */
void test_what_comes_down_near_the_ground_of_the_start_stands_on_it(void)
{
    for (int at = 0; at < 3; at++) {
        setUp();
        const bool nose = at != 1;
        const uint16_t lead = BIT(nose ? MIRROR_FORE : MIRROR_AFT);
        const terrain_passage_t passage = going(nose ? 0.5F : -0.5F, 0.1F, ALL);
        const uint16_t ground = terrain_ground_of(nose ? (uint16_t)MIRROR_FORE : (uint16_t)MIRROR_AFT);

        h.x[TERRAIN_SLOPE] = (at == 0) ? -1.0F : 1.0F; /* the third climbs it */
        stand_at(nose ? 0.08F : 0.09F, nose ? -0.03F : 0.2F, nose ? 0.2F : -0.03F);
        h.p[ground][ground] = 0.03F * 0.03F;
        h.ramps = (uint16_t)(ALL & ~lead);
        terrain_ramp_settle(&h, &passage, 0U, no_step_m, fore_m);
        TEST_ASSERT_FLOAT_WITHIN(0.008F, (at == 2) ? -0.03F : 0.0F, h.x[ground]);
    }
}

/* LAYOUT TWO: the front mirror between them tells nothing, and its ground is not known. */
void test_a_mirror_that_tells_nothing_is_not_in_the_row(void)
{
    const uint16_t two = BIT(MIRROR_FORE) | BIT(MIRROR_AFT);
    terrain_passage_t passage = going(0.3F, 0.1F, BIT(MIRROR_AFT));

    passage.told = two;
    TEST_ASSERT_TRUE(terrain_ramp_prior(&passage, 0U, false) >
                     0.2F); /* it follows the fore one off the ramp */
    stand_at(-0.4F, 0.25F, 0.24F);
    h.ramps = 0U;
    terrain_ramp_settle(&h, &passage, 0U, no_step_m, fore_m);
    TEST_ASSERT_TRUE(h.share > 0.7F);
    TEST_ASSERT_EQUAL_FLOAT(-0.4F, h.x[terrain_ground_of(MIRROR_FRONT)]);
    TEST_ASSERT_FLOAT_WITHIN(0.008F, 0.0F,
                             h.x[terrain_ground_of(MIRROR_FORE)] - h.x[terrain_ground_of(MIRROR_AFT)]);
}

void test_what_steps_down_elsewhere_stands_where_it_is(void)
{
    static const float off_m[MIRROR_COUNT] = {[MIRROR_FORE] = 0.2F};
    const terrain_passage_t passage = going(0.5F, 0.1F, 0U);

    stand_at(0.3F, 0.1F, 0.3F);
    terrain_ramp_settle(&h, &passage, BIT(MIRROR_FORE), off_m, fore_m);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 0.1F, h.x[terrain_ground_of(MIRROR_FORE)]);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.5F, h.share);
}
