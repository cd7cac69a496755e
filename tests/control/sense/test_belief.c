#include "control/sense/belief.h"

#include <math.h>
#include <string.h>

#include "unity.h"

#define GAP_S 0.1F

/* A vehicle as the three mirrors see it, by geometry of its own: an arm of 200 mm to the side for all of
 * them, and 107 mm fore and aft. */
static belief_t belief;
static struct {
    unsigned long seed;
    float height_mm, rate_mm_s, roll_rad, pitch_rad;
    float terrain_mm[MIRROR_COUNT]; /* under each mirror */
    float blocked_mm[MIRROR_COUNT]; /* 0: not */
    float own_mm, shared_mm;        /* noise */
    float gust_mm_s2, sway_rad;
    bool alone; /* only the front mirror tells */
} world;

static belief_beam_t beams[MIRROR_COUNT];
static belief_felt_t felt;

static float uniform(void)
{
    world.seed = (world.seed * 1103515245UL + 12345UL) & 0x7fffffffUL;
    return (float)(world.seed >> 8) / 8388608.0F;
}

static float normal(void)
{
    float sum = 0.0F;

    for (int k = 0; k < 12; k++) {
        sum += uniform();
    }
    return sum - 6.0F;
}

static void begin(unsigned long seed)
{
    memset(&belief, 0, sizeof belief);
    memset(&felt, 0, sizeof felt);
    memset(&world, 0, sizeof world);
    world.seed = seed;
    world.height_mm = 600.0F;
    world.own_mm = 3.0F;
    world.gust_mm_s2 = 500.0F;
    world.sway_rad = 0.04F;
}

void setUp(void)
{
    begin(1UL);
}

void tearDown(void) {}

/* Hovers: it returns to 600 mm, gusts move it, and it sways. Returns how far it went. */
static void fly(void)
{
    const float pull_mm_s2 = -4.0F * (world.height_mm - 600.0F) - 3.0F * world.rate_mm_s;

    world.rate_mm_s += (pull_mm_s2 + world.gust_mm_s2 * normal()) * GAP_S;
    world.height_mm += world.rate_mm_s * GAP_S;
    world.roll_rad += 0.4F * (world.sway_rad * normal() - world.roll_rad);
    world.pitch_rad += 0.4F * (world.sway_rad * normal() - world.pitch_rad);
}

static void scan_after(float gap_s)
{
    static const float fore_mm[MIRROR_COUNT] = {[MIRROR_FORE] = 107.0F, [MIRROR_AFT] = -107.0F};
    const float shared_mm = world.shared_mm * normal();

    for (int m = 0; m < MIRROR_COUNT; m++) {
        const float upright = cosf(world.roll_rad) * cosf(world.pitch_rad);
        const float lifted_mm = 200.0F * sinf(world.roll_rad) + fore_mm[m] * sinf(world.pitch_rad);
        const float true_mm = (world.height_mm - world.terrain_mm[m] + lifted_mm) / upright;
        const float slant_mm = (world.blocked_mm[m] > 0.0F ? world.blocked_mm[m] : true_mm) + shared_mm +
                               world.own_mm * normal();

        beams[m] = (belief_beam_t){!world.alone || m == MIRROR_FRONT, slant_mm,
                                   slant_mm * upright - lifted_mm};
    }
    belief_scan(&belief, beams, gap_s, felt);
}

static void scan(void)
{
    scan_after(GAP_S);
}

static void hover(int scans)
{
    while (scans-- > 0) {
        fly();
        scan();
    }
}

/* Scans until the liars are these, and no other; -1: not within `most`. */
static int scans_until(uint16_t liars, int most)
{
    for (int k = 1; k <= most; k++) {
        bool so = true;

        hover(1);
        for (int m = 0; m < MIRROR_COUNT; m++) {
            const bool lies = belief_of_lie(&belief, (mirror_t)m) > 0.5F;
            so = so && lies == ((liars & 1U << (unsigned)m) != 0U);
        }
        if (so) {
            return k;
        }
    }
    return -1;
}

static float likeliest_lie(void)
{
    float most = 0.0F;

    for (int m = 0; m < MIRROR_COUNT; m++) {
        most = fmaxf(most, belief_of_lie(&belief, (mirror_t)m));
    }
    return most;
}

void test_before_the_first_scan_nobody_lies_and_after_it_hardly_anybody(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.0F, likeliest_lie());
    scan();
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 1.0e-3F, likeliest_lie());
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, 1.0F, belief_of_honest(&belief, 7U, 2U));
}

/* Any mirror, near and far, with noise that the mirrors share and with noise of their own. */
void test_one_mirror_that_is_blocked_is_found_within_three_seconds_and_mostly_in_one(void)
{
    int quick = 0;

    for (unsigned long seed = 1UL; seed <= 60UL; seed++) {
        const int m = (int)(seed % 3UL);

        begin(seed);
        world.own_mm = (seed & 1UL) != 0UL ? 4.0F : 1.0F;
        world.shared_mm = (seed & 1UL) != 0UL ? 0.0F : 3.0F;
        hover(30);
        world.blocked_mm[m] = 60.0F + 2900.0F * uniform();
        const int scans = scans_until((uint16_t)(1U << m), 31);
        TEST_ASSERT_INT_WITHIN(15, 16, scans);
        quick += scans <= 10;
    }
    TEST_ASSERT_INT_WITHIN(15, 45, quick);
}

/* The third one flies, and is right. That two lie is far less probable than that one does, and so it takes
 * longer to be sure of. */
void test_two_mirrors_blocked_at_one_length_do_not_outvote_the_third(void)
{
    int quick = 0;

    for (unsigned long seed = 1UL; seed <= 60UL; seed++) {
        const int honest = (int)(seed % 3UL);

        begin(seed);
        hover(30);
        for (int m = 0; m < MIRROR_COUNT; m++) {
            world.blocked_mm[m] = (m == honest) ? 0.0F : 300.0F + 5.0F * (float)seed;
        }
        const int scans = scans_until((uint16_t)(7U & ~(1U << honest)), 60);

        TEST_ASSERT_GREATER_THAN_INT(0, scans);
        quick += scans <= 30;
    }
    TEST_ASSERT_GREATER_THAN_INT(50, quick);
}

/* An hour of flight: every 3 s an edge passes under the mirrors, one after the other, up or down by up to 0.4
 * m. */
void test_in_a_healthy_flight_over_steps_hardly_a_scan_disbelieves_a_mirror(void)
{
    int scans = 0, disbelieved = 0, alone = 0;

    for (unsigned long seed = 1UL; seed <= 12UL; seed++) {
        begin(seed);
        world.shared_mm = (seed & 1UL) != 0UL ? 3.0F : 0.0F;
        for (int k = 0; k < 100; k++) {
            const float step_mm = 800.0F * (uniform() - 0.5F);

            for (int m = 0; m < 30; m++) {
                if (m < 6) {
                    world.terrain_mm[m / 2] = step_mm;
                }
                hover(1);
                scans++;
                disbelieved += likeliest_lie() > 0.5F;
                alone += belief_of_honest(&belief, 7U, 2U) < 0.99F;
            }
        }
    }
    TEST_ASSERT_INT_WITHIN(500, 36000, scans);
    TEST_ASSERT_INT_WITHIN(18, 18, disbelieved); /* one in a thousand */
    TEST_ASSERT_INT_WITHIN(18, 18, alone);
}

/* All slants are constants then. Ten minutes. */
void test_at_rest_nobody_becomes_a_liar(void)
{
    float most = 0.0F;

    world.height_mm = 0.0F;
    for (int k = 0; k < 6000; k++) {
        scan();
        most = fmaxf(most, likeliest_lie());
    }
    TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.0F, most);
}

void test_a_mirror_that_is_free_again_is_believed_again(void)
{
    for (unsigned long seed = 1UL; seed <= 30UL; seed++) {
        begin(seed);
        hover(30);
        world.blocked_mm[MIRROR_FRONT] = 400.0F;
        hover(60);
        TEST_ASSERT_FLOAT_WITHIN(0.5F, 1.0F, belief_of_lie(&belief, MIRROR_FRONT));
        world.blocked_mm[MIRROR_FRONT] = 0.0F;
        TEST_ASSERT_INT_WITHIN(25, 26, scans_until(0U, 51));
    }
}

/* A climb of 3 m/s2 that the accelerometer tells, and one that nothing tells. */
void test_a_motion_that_the_accelerometer_tells_is_no_evidence_against_anybody(void)
{
    for (int m = 0; m < MIRROR_COUNT; m++) {
        beams[m] = (belief_beam_t){true, 500.0F + 100.0F * (float)m, 500.0F};
    }
    for (int k = 0; k < 8; k++) {
        for (int m = 0; m < MIRROR_COUNT; m++) {
            beams[m].height_mm += (float)k * 30.0F + 15.0F;
            beams[m].slant_mm += (float)k * 30.0F + 15.0F;
        }
        belief_scan(&belief, beams, GAP_S, (belief_felt_t){.gained_mps = 0.3F, .pushed_mps = 0.3F});
        TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F, likeliest_lie());
    }
    TEST_ASSERT_FLOAT_WITHIN(150.0F, 2400.0F, belief.worlds[0].rate_mm_s);
}

/* A vehicle in a hover, and an accelerometer that tells of another motion, which the thrust contradicts: for
 * one scan a touch of 9 m/s2, or from one scan on a bias of 2 to 10 m/s2. */
void test_an_accelerometer_that_lies_makes_no_mirror_a_liar(void)
{
    for (unsigned long seed = 1UL; seed <= 60UL; seed++) {
        const float jump_mps2 = ((seed & 1UL) != 0UL ? 1.0F : -1.0F) * (2.0F + (float)(seed % 9UL));
        const bool once = seed % 3UL == 0UL;

        begin(seed);
        hover(30);
        for (int k = 0; k < 50; k++) {
            const float told_mps2 = once ? (k == 0 ? 9.0F : 0.0F) : jump_mps2;

            fly();
            felt = (belief_felt_t){.gained_mps = told_mps2 * GAP_S, .dragged = 0.24F};
            scan();
            TEST_ASSERT_FLOAT_WITHIN(0.5F, 0.0F, likeliest_lie()); /* beyond it is left out: mirrors.c */
        }
        TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.0F, likeliest_lie());
    }
}

/* The same words, when the thrust says them too: then three slants that do not move are three lies. */
void test_a_motion_that_accelerometer_and_thrust_tell_finds_three_that_are_blocked(void)
{
    for (unsigned long seed = 1UL; seed <= 20UL; seed++) {
        bool found = false;
        float speed_mps = 0.0F;

        begin(seed);
        world.sway_rad = 0.0F;
        hover(30);
        for (int m = 0; m < MIRROR_COUNT; m++) {
            world.blocked_mm[m] = world.height_mm;
        }
        for (int k = 0; k < 60 && !found; k++) {
            felt = (belief_felt_t){.gained_mps = (k / 10 % 2 == 0) ? 0.2F : -0.2F, .dragged = 0.24F};
            felt.pushed_mps = felt.gained_mps + felt.dragged * (speed_mps + 0.5F * felt.gained_mps);
            speed_mps += felt.gained_mps;
            scan();
            found = belief_of_none(&belief, 7U) > 0.99F;
        }
        TEST_ASSERT_TRUE(found);
    }
}

/* It climbs on and on at one speed, by 0.38 m/s: no single one of them looks honest in turn, with a hover
 * thrust that is wrong. */
void test_three_that_are_blocked_lie_for_as_long_as_the_thrust_tells_a_climb(void)
{
    for (unsigned long seed = 1UL; seed <= 20UL; seed++) {
        float speed_mps = 0.0F;
        int sure = 0;

        begin(seed);
        hover(30);
        for (int m = 0; m < MIRROR_COUNT; m++) {
            world.blocked_mm[m] = 300.0F;
        }
        for (int k = 0; k < 200; k++) {
            felt = (belief_felt_t){.pushed_mps = 0.092F, .dragged = 0.24F};
            felt.gained_mps = (felt.pushed_mps - felt.dragged * speed_mps) / (1.0F + 0.5F * felt.dragged);
            speed_mps += felt.gained_mps;
            fly();
            scan();
            sure += k >= 100 && belief_of_none(&belief, 7U) > 0.99F;
        }
        TEST_ASSERT_INT_WITHIN(2, 98, sure);
    }
}

/* Scans are missed, and meanwhile something pushes it by 3 m/s2, of which nothing tells. It goes on at the
 * speed that it has then. */
void test_a_push_while_scans_were_missed_makes_no_liar(void)
{
    for (unsigned long seed = 1UL; seed <= 60UL; seed++) {
        const float missed_s = 0.2F + 0.1F * (float)(seed % 8UL);
        const float push_mm_s2 = (seed & 1UL) != 0UL ? 3000.0F : -3000.0F;
        float most = 0.0F;

        begin(seed);
        hover(30);
        const float rate_mm_s = push_mm_s2 * missed_s;
        float higher_mm = 0.5F * rate_mm_s * missed_s;
        const float from_mm = world.height_mm;

        for (int k = 0; k < 20; k++) {
            world.height_mm = from_mm + higher_mm;
            scan_after(k == 0 ? missed_s : GAP_S);
            most = fmaxf(most, likeliest_lie());
            higher_mm += rate_mm_s * GAP_S;
        }
        TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.0F, most);
    }
}

/* Scans until one mirror is found that is blocked, two seconds after a gap. */
static int scans_to_find_after(unsigned long seed, float gap_s)
{
    begin(seed);
    hover(30);
    fly();
    scan_after(gap_s);
    hover(20);
    world.blocked_mm[seed % 3UL] = 60.0F + 2900.0F * uniform();
    const int scans = scans_until((uint16_t)(1U << (seed % 3UL)), 31);

    TEST_ASSERT_INT_WITHIN(15, 16, scans);
    return scans;
}

void test_two_seconds_after_missed_scans_it_doubts_as_soon_as_ever(void)
{
    int after = 0, ever = 0;

    for (unsigned long seed = 1UL; seed <= 150UL; seed++) {
        after += scans_to_find_after(seed, 1.0F);
        ever += scans_to_find_after(seed, GAP_S);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 1.0F, (float)after / (float)ever);
}

/* Whatever is told, in whatever time. */
void test_the_probabilities_are_one_together_and_none_is_lost(void)
{
    for (unsigned long seed = 1UL; seed <= 2000UL; seed++) {
        float sum = 0.0F;

        world.seed = seed;
        for (int m = 0; m < MIRROR_COUNT; m++) {
            beams[m].valid = uniform() > 0.3F;
            beams[m].slant_mm = 20000.0F * (uniform() - 0.5F);
            beams[m].height_mm = 20000.0F * (uniform() - 0.5F);
        }
        belief_scan(&belief, beams, 0.02F + 10.0F * uniform() * uniform(),
                    (belief_felt_t){.untold = uniform() < 0.3F,
                                    .gained_mps = 40.0F * (uniform() - 0.5F),
                                    .pushed_mps = 40.0F * (uniform() - 0.5F),
                                    .dragged = uniform()});
        for (unsigned k = 0U; k < BELIEF_WORLDS; k++) {
            TEST_ASSERT_TRUE(belief.worlds[k].probability > 0.0F);
            sum += belief.worlds[k].probability;
        }
        TEST_ASSERT_FLOAT_WITHIN(1.0e-3F, 1.0F, sum);
    }
}

/* #LAYOUT FRONT for ten minutes, and then THREE: who has told nothing is no liar, and makes nobody one. */
void test_mirrors_that_join_late_are_believed_and_found_out_as_ever(void)
{
    for (unsigned long seed = 1UL; seed <= 10UL; seed++) {
        begin(seed);
        world.alone = true;
        hover(6000);
        TEST_ASSERT_TRUE(likeliest_lie() < 0.05F);
        world.alone = false;
        hover(1);
        for (unsigned k = 1U; k < BELIEF_WORLDS; k++) { /* without its lie, which is told from nothing yet */
            TEST_ASSERT_EQUAL_FLOAT(belief.worlds[k & (1U << MIRROR_FRONT)].rate_mm_s,
                                    belief.worlds[k].rate_mm_s);
        }
        hover(19);
        TEST_ASSERT_TRUE(likeliest_lie() < 0.05F);
        world.blocked_mm[MIRROR_FORE] = 400.0F;
        const int scans = scans_until(1U << MIRROR_FORE, 40);
        TEST_ASSERT_TRUE_MESSAGE(scans > 0 && scans <= 30,
                                 "one that joined late is found within three seconds");
    }
}

/* The scanner is silent for 8 s while the vehicle climbs by half a metre: where it is now is no evidence. */
void test_after_a_long_gap_nobody_is_suspected(void)
{
    for (unsigned long seed = 1UL; seed <= 30UL; seed++) {
        begin(seed);
        hover(30);
        world.height_mm += 500.0F;
        for (int m = 0; m < MIRROR_COUNT; m++) {
            beams[m].slant_mm += 500.0F;
            beams[m].height_mm += 500.0F;
        }
        belief_scan(&belief, beams, 8.0F, (belief_felt_t){.gained_mps = 0.4F});
        TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.0F, likeliest_lie());
    }
}

/* The rays of one mirror are lost for five minutes, and the accelerometer has a bias. */
void test_a_rate_that_no_mirror_tells_does_not_run_away(void)
{
    hover(30);
    for (int k = 0; k < 3000; k++) {
        beams[MIRROR_FRONT].valid = false;
        belief_scan(&belief, beams, GAP_S, (belief_felt_t){.gained_mps = 0.02F});
    }
    for (unsigned k = 0U; k < BELIEF_WORLDS; ++k) {
        TEST_ASSERT_FLOAT_WITHIN(1000.0F, 0.0F, belief.worlds[k].rate_mm_s);
    }
    hover(10);
    TEST_ASSERT_FLOAT_WITHIN(0.5F, 0.0F, belief_of_lie(&belief, MIRROR_FRONT));
}

void test_two_are_two_of_those_that_were_asked_for(void)
{
    begin(3UL);
    hover(30);
    world.blocked_mm[MIRROR_AFT] = 300.0F;
    hover(30);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 1.0F,
                             belief_of_honest(&belief, 1U << MIRROR_FRONT | 1U << MIRROR_FORE, 2U));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.0F,
                             belief_of_honest(&belief, 1U << MIRROR_FRONT | 1U << MIRROR_AFT, 2U));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, belief_of_honest(&belief, 1U << MIRROR_FRONT, 2U));
}

/* A vehicle that climbs at 0.6 m/s, and its latest scan: over level ground, or with a step under so many
 * mirrors. */
static float no_step_after(unsigned long seed, uint16_t stepped, float step_mm)
{
    begin(seed);
    hover(30);
    felt = (belief_felt_t){.gained_mps = 0.2F, .pushed_mps = 0.2F};
    for (int k = 0; k < 4; k++) {
        for (uint16_t m = 0U; m < MIRROR_COUNT; m++) {
            world.terrain_mm[m] = (k == 3 && m < stepped) ? step_mm : 0.0F;
        }
        world.rate_mm_s = 200.0F * (float)k + 100.0F;
        world.height_mm += world.rate_mm_s * GAP_S;
        scan();
    }
    return belief_of_motions(&belief).no_step;
}

/* A step under one of three leaves two that show the motion; that one of these has stepped too is not sure to
 * be wrong. */
void test_that_no_ground_stepped_is_sure_only_while_no_mirror_shows_a_step(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.0F, belief_of_motions(&belief).no_step);
    for (unsigned long seed = 1UL; seed <= 40UL; seed++) {
        TEST_ASSERT_FLOAT_WITHIN(0.005F, 0.995F, no_step_after(seed, 0U, 0.0F));
        TEST_ASSERT_FLOAT_WITHIN(0.05F, 0.94F, no_step_after(seed, 1U, 170.0F));
        TEST_ASSERT_FLOAT_WITHIN(0.005F, 0.005F, no_step_after(seed, 2U, 170.0F));
        TEST_ASSERT_FLOAT_WITHIN(0.005F, 0.005F, no_step_after(seed, 3U, 170.0F));
        TEST_ASSERT_FLOAT_WITHIN(0.005F, 0.005F, no_step_after(seed, 3U, -400.0F));
    }
}

/* Heights that stand show no motion, so they do not tell the ground from a block. */
void test_heights_that_stand_do_not_show_that_no_ground_stepped(void)
{
    begin(1UL);
    world.gust_mm_s2 = world.sway_rad = 0.0F;
    hover(60);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.1F, belief_of_motions(&belief).no_step);
}

void test_a_scan_in_which_no_mirror_tells_shows_no_ground(void)
{
    belief_beam_t nothing[MIRROR_COUNT] = {{.valid = false}};

    TEST_ASSERT_TRUE(no_step_after(1UL, 0U, 0.0F) > 0.5F);
    belief_scan(&belief, nothing, GAP_S, felt);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, belief_of_motions(&belief).no_step);
}

/* One thing comes before all three mirrors, farther than the ground: these show it a scan before the others.
 * How probable it is then, that all three lie. */
static float blocked_after(unsigned long seed, uint16_t first)
{
    begin(seed);
    hover(30);
    for (int k = 0; k < 2; k++) {
        for (uint16_t m = 0U; m < MIRROR_COUNT; m++) {
            world.blocked_mm[m] = (k == 1 || belief_has(first, m)) ? 900.0F : 0.0F;
        }
        hover(1);
    }
    return belief_of_none(&belief, 7U);
}

/* Rays are taken aft, front, fore. What comes after the aft rays is seen by front and fore, and by aft a scan
 * later; no thing is seen the other way round. */
void test_a_block_that_comes_between_the_rays_is_as_likely_as_one_that_comes_between_the_scans(void)
{
    static const uint16_t in_order[] = {1U << MIRROR_FORE, 1U << MIRROR_FORE | 1U << MIRROR_FRONT};
    static const uint16_t against[] = {1U << MIRROR_AFT, 1U << MIRROR_AFT | 1U << MIRROR_FRONT};

    float between = 0.0F;
    float otherwise = 0.0F;

    for (unsigned long seed = 1UL; seed <= 40UL; seed++) {
        const float at_once = blocked_after(seed, 7U);

        for (int k = 0; k < 2; k++) {
            const float then = blocked_after(seed, in_order[k]);

            TEST_ASSERT_TRUE(then > 0.05F * at_once && then < 5.0F * at_once);
            between += then;
            otherwise += blocked_after(seed, against[k]);
        }
    }
    TEST_ASSERT_TRUE(otherwise < 0.2F * between);
}

/* ---- if all mirrors lie ---- */

static void block_all(void)
{
    for (int m = 0; m < MIRROR_COUNT; m++) {
        world.blocked_mm[m] = world.height_mm;
    }
    world.roll_rad = world.pitch_rad = world.rate_mm_s = 0.0F;
}

/* From rest to 0.5 m/s in two scans, and on; the mirrors do not show it. */
static void climb(int scans)
{
    for (int k = 0; k < scans; k++) {
        felt = (belief_felt_t){.gained_mps = (k < 2) ? 0.25F : 0.0F, .pushed_mps = 0.12F, .dragged = 0.24F};
        scan();
    }
}

void test_a_climb_that_no_mirror_shows_is_flown_on_from_the_height_before(void)
{
    for (unsigned long seed = 1UL; seed <= 20UL; seed++) {
        begin(seed);
        hover(100);
        const float before_mm = world.height_mm;

        block_all();
        climb(20);
        TEST_ASSERT_FLOAT_WITHIN(150.0F, 500.0F, belief_blind(&belief).rate_mm_s);
        /* by 950 mm, and 150 mm/s for 2 s */
        TEST_ASSERT_FLOAT_WITHIN(300.0F, before_mm + 950.0F, belief_blind(&belief).height_mm);
    }
}

/* The step to what blocks them was not flown, nor is it with two mirrors that have lied for long. */
void test_a_step_to_what_blocks_the_mirrors_was_not_flown(void)
{
    for (int liars = 0; liars < MIRROR_COUNT; liars++) {
        for (unsigned long seed = 1UL; seed <= 10UL; seed++) {
            begin(seed);
            hover(50);
            const float before_mm = world.height_mm;

            for (int m = 0; m < liars; m++) {
                world.blocked_mm[m] = 250.0F;
            }
            hover(100);
            for (int m = 0; m < MIRROR_COUNT; m++) {
                world.blocked_mm[m] = before_mm + 1500.0F;
            }
            felt = (belief_felt_t){.gained_mps = 0.0F};
            hover(3);
            TEST_ASSERT_FLOAT_WITHIN(150.0F, before_mm, belief_blind(&belief).height_mm); /* of 1500 */
        }
    }
}

void test_of_healthy_heights_the_blind_worlds_have_the_same(void)
{
    for (unsigned long seed = 1UL; seed <= 20UL; seed++) {
        begin(seed);
        for (int k = 0; k < 300; k++) {
            const float before_mm_s = world.rate_mm_s;

            fly();
            felt = (belief_felt_t){.gained_mps = 0.001F * (world.rate_mm_s - before_mm_s)};
            scan();
            if (k < 50) {
                continue; /* they begin at 0 */
            }
            TEST_ASSERT_FLOAT_WITHIN(250.0F, world.height_mm, belief_blind(&belief).height_mm);
        }
    }
}

/* Blocked while it climbs by a metre, free for 20 s, and blocked anew. */
void test_what_one_lie_has_lost_the_next_has_not(void)
{
    for (unsigned long seed = 1UL; seed <= 20UL; seed++) {
        begin(seed);
        hover(100);
        block_all();
        climb(20);
        memset(world.blocked_mm, 0, sizeof world.blocked_mm);
        felt = (belief_felt_t){.untold = true};
        hover(200);
        block_all();
        hover(2);
        TEST_ASSERT_FLOAT_WITHIN(200.0F, world.height_mm, belief_blind(&belief).height_mm);
    }
}

/* Of what may stand, the speed counts as probably as it moves. */
void test_what_stands_has_no_speed(void)
{
    belief.worlds[0] = (belief_world_t){.probability = 1.0F, .rate_mm_s = 400.0F, .height_mm = 300.0F};
    belief.worlds[0].motions[BELIEF_STANDS] = 0.75F;
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 100.0F, belief_blind(&belief).rate_mm_s);
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 300.0F, belief_blind(&belief).height_mm);
}

/* Two mirrors are known; only the first tells something. Where it lies, nobody told the truth. */
void test_mirrors_that_tell_nothing_in_a_scan_do_not_count_in_it(void)
{
    belief.known = 3U;
    belief.told = 1U;
    for (int k = 0; k < 4; k++) {
        belief.worlds[k] = (belief_world_t){.probability = 0.25F, .rate_mm_s = 100.0F * (float)k};
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 200.0F, belief_blind(&belief).rate_mm_s); /* of 100 and 300 */
    belief.told = 3U;
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 300.0F, belief_blind(&belief).rate_mm_s);
}

/* A mirror sees again: that world takes over what was learned of the thrust, too. */
void test_what_is_known_of_the_thrust_goes_on_when_the_mirrors_see_again(void)
{
    begin(1UL);
    hover(20);
    for (int k = 0; k < (int)BELIEF_WORLDS; k++) {
        belief.worlds[k].push_known = (k == (int)BELIEF_WORLDS - 1) ? 1.0F : 0.0F;
        belief.worlds[k].probability = (k == (int)BELIEF_WORLDS - 1) ? 1.0F : 1.0e-12F;
    }
    felt = (belief_felt_t){.untold = true};
    scan();
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 1.0F, belief.worlds[BELIEF_WORLDS - 2U].push_known);
}

void test_on_the_ground_the_height_is_0_and_the_thrust_is_not_known(void)
{
    belief.worlds[5] = (belief_world_t){
        .push_off_mps2 = 1.0F, .push_known = 1.0F, .height_mm = 300.0F, .rate_mm_s = 7.0F};
    belief_land(&belief);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, belief.worlds[5].push_off_mps2);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, belief.worlds[5].push_known);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, belief.worlds[5].height_mm);
    TEST_ASSERT_EQUAL_FLOAT(7.0F, belief.worlds[5].rate_mm_s);
}
