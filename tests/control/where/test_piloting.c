#include "control/credible.h"
#include "control/where/piloting.h"
#include "unity.h"

#include <string.h>

#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, expected, actual)

static pilot_state_t pilot;
static pilot_signs_t signs;

/* FLYING at 0.5 m with the hover thrust, cycles of 0.1 s, no pin. */
void setUp(void)
{
    memset(&pilot, 0, sizeof pilot);
    signs = (pilot_signs_t){.state = FLIGHT_FLYING,
                            .has_throttle = true,
                            .step_s = 0.1F,
                            .height_mm = 500.0F,
                            .thrust_n = 7.0F,
                            .hover_n = 7.0F,
                            .felt = true};
}

void tearDown(void) {}

static pilot_news_t step(flight_state_t state)
{
    signs.state = state;
    return pilot_step(&pilot, &signs);
}

void test_floating_without_a_pin_is_unknown(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        signs.has_pin = i == 2;
        signs.has_throttle = i != 3;
        (void)step((i == 1) ? FLIGHT_FLYING : FLIGHT_FLOATING);
        TEST_ASSERT_EQUAL(i == 0, pilot_is_unknown(&pilot));
        TEST_ASSERT_EQUAL((i == 0)   ? THROTTLE_UNKNOWN
                          : (i == 3) ? THROTTLE_PILOT
                                     : THROTTLE_OURS,
                          pilot.throttle);
    }
}

void test_its_end_off_the_ground_is_news(void)
{
    static const struct {
        flight_state_t before, then;
        pilot_news_t news;
    } rows[] = {{FLIGHT_FLOATING, FLIGHT_FLYING, PILOT_IS_SURE},
                {FLIGHT_FLYING, FLIGHT_FLYING, PILOT_NO_NEWS},
                {FLIGHT_FLOATING, FLIGHT_GROUND, PILOT_NO_NEWS},
                {FLIGHT_FLOATING, FLIGHT_FLOATING, PILOT_NO_NEWS}};
    for (int i = 0; i < 4; i++) {
        setUp();
        TEST_ASSERT_EQUAL(PILOT_NO_NEWS, step(rows[i].before));
        TEST_ASSERT_EQUAL(rows[i].news, step(rows[i].then));
    }
}

/* In frame i the accelerometer measures what the commands ask for. */
static void obeys(int i)
{
    signs.frame_us += 25000U;
    signs.pushed_mps2 = 1.4F * (7.0F + 0.5F * (float)(i % 3));
    signs.felt_mps2 = signs.pushed_mps2 - 9.0F;
}

/* One frame of FLOATING without a pin. */
static pilot_news_t float_a_frame(uint32_t step_us, bool felt)
{
    signs.frame_us += step_us;
    signs.felt = felt;
    return step(FLIGHT_FLOATING);
}

/* Frames until the commands show an effect, 100 at most. */
static pilot_news_t obey(void)
{
    pilot_news_t news = PILOT_NO_NEWS;

    for (int i = 0; i < 100 && news == PILOT_NO_NEWS; i++) {
        obeys(i);
        news = float_a_frame(0U, true);
        TEST_ASSERT_EQUAL(news == PILOT_SHOWS_EFFECT, pilot_shows_effect(&pilot));
    }
    return news;
}

void test_a_vehicle_that_obeys_shows_that_the_throttle_is_ours_once(void)
{
    (void)float_a_frame(25000U, true);
    TEST_ASSERT_TRUE(pilot_is_unknown(&pilot) && !pilot_shows_effect(&pilot));
    TEST_ASSERT_EQUAL(PILOT_SHOWS_EFFECT, obey());
    TEST_ASSERT_EQUAL(PILOT_NO_NEWS, float_a_frame(0U, true)); /* no new frame */
    TEST_ASSERT_EQUAL(PILOT_NO_NEWS, float_a_frame(25000U, true));
    TEST_ASSERT_TRUE(pilot_shows_effect(&pilot));
}

void test_an_effect_is_shown_anew_after_a_gap_of_frames_or_of_accelerations_and_in_each_turn(void)
{
    for (int why = 0; why < 4; why++) {
        setUp();
        (void)float_a_frame(25000U, true);
        TEST_ASSERT_EQUAL(PILOT_SHOWS_EFFECT, obey());
        if (why < 2) {
            (void)float_a_frame((why == 0) ? FRAME_GAP_US + 1U : 25000U, why == 0);
            TEST_ASSERT_FALSE(pilot_shows_effect(&pilot));
        } else if (why == 2) {
            (void)step(FLIGHT_FLYING);
            TEST_ASSERT_FALSE(pilot_shows_effect(&pilot)); /* it is not unknown */
            (void)float_a_frame(25000U, true);
            TEST_ASSERT_FALSE(pilot_shows_effect(&pilot));
        } else { /* out of the pilot's hands without heights */
            signs.entered = signs.handed_over = true;
            (void)step(FLIGHT_DESCENDING);
            TEST_ASSERT_TRUE(pilot_is_unknown(&pilot) && !pilot_shows_effect(&pilot));
        }
    }
    setUp();
    (void)float_a_frame(25000U, true);
    TEST_ASSERT_EQUAL(PILOT_SHOWS_EFFECT, obey());
    (void)float_a_frame(FRAME_GAP_US, true); /* a gap of just that is none */
    TEST_ASSERT_TRUE(pilot_shows_effect(&pilot));
}

void test_a_descent_handed_over_without_heights_is_the_pilots_to_its_end(void)
{
    static const struct {
        flight_state_t state;
        bool handed_over, entered, before, given_back;
    } rows[] = {{FLIGHT_DESCENDING, true, true, false, true},
                {FLIGHT_DESCENDING, true, false, false, false},
                {FLIGHT_DESCENDING, false, true, false, false},
                {FLIGHT_DESCENDING, false, false, true, true},
                {FLIGHT_LANDING, true, true, true, false}};
    for (int i = 0; i < 5; i++) {
        for (int pin = 0; pin < 2; pin++) {
            setUp();
            signs.has_pin = pin != 0;
            if (rows[i].before) {
                signs.entered = signs.handed_over = true;
                (void)step(FLIGHT_DESCENDING);
            }
            signs.entered = rows[i].entered;
            signs.handed_over = rows[i].handed_over;
            (void)step(rows[i].state);
            TEST_ASSERT_EQUAL(rows[i].given_back, pilot.given_back);
            TEST_ASSERT_EQUAL(rows[i].given_back, pilot_is_unknown(&pilot));
            if (rows[i].given_back) {
                NEAR((pin != 0) ? 0.2F : 0.06F, pilot.sink_n_per_s);
            }
        }
    }
}

/* 11 cycles of a landing: the first begins it, the others are a second. */
static bool in_vain(float thrust_n, float height_mm, float rise_mps)
{
    setUp();
    signs.thrust_n = thrust_n;
    signs.height_mm = height_mm;
    signs.rise_mps = rise_mps;
    signs.entered = true;
    (void)step(FLIGHT_LANDING);
    signs.entered = false;
    for (int i = 0; i < 9; i++) {
        (void)step(FLIGHT_LANDING);
        TEST_ASSERT_FALSE(pilot_holds_up(&pilot, FLIGHT_LANDING));
    }
    (void)step(FLIGHT_LANDING);
    (void)step(FLIGHT_LANDING);
    return pilot_holds_up(&pilot, FLIGHT_LANDING);
}

void test_a_landing_with_too_little_thrust_to_fly_that_does_not_sink_is_in_vain(void)
{
    TEST_ASSERT_TRUE(in_vain(5.4F, 100.0F, -0.29F));
    TEST_ASSERT_FALSE(pilot_holds_up(&pilot, FLIGHT_DESCENDING));
    TEST_ASSERT_FALSE(in_vain(5.6F, 100.0F, -0.29F));
    TEST_ASSERT_FALSE(in_vain(5.4F, 79.0F, -0.29F));
    TEST_ASSERT_FALSE(in_vain(5.4F, 100.0F, -0.31F));
    TEST_ASSERT_TRUE(in_vain(5.4F, 100.0F, -0.29F));
    signs.entered = true; /* another landing */
    (void)step(FLIGHT_LANDING);
    TEST_ASSERT_FALSE(pilot_holds_up(&pilot, FLIGHT_LANDING));
}

void test_a_landing_in_vain_that_obeys_shows_that_the_throttle_is_ours(void)
{
    pilot_news_t news = PILOT_NO_NEWS;

    TEST_ASSERT_TRUE(in_vain(5.0F, 500.0F, 0.0F));
    for (int i = 0; i < 100 && news == PILOT_NO_NEWS; i++) {
        TEST_ASSERT_FALSE(pilot_shows_effect(&pilot));
        obeys(i);
        news = step(FLIGHT_LANDING);
    }
    TEST_ASSERT_EQUAL(PILOT_SHOWS_EFFECT, news);
    TEST_ASSERT_TRUE(pilot_is_unknown(&pilot) && pilot_shows_effect(&pilot));
}

void test_without_a_pin_a_landing_in_vain_leaves_the_throttle_unknown(void)
{
    for (int pin = 0; pin < 2; pin++) {
        TEST_ASSERT_TRUE(in_vain(5.0F, 500.0F, 0.0F));
        signs.has_pin = pin != 0;
        (void)step(FLIGHT_LANDING);
        TEST_ASSERT_EQUAL(pin == 0, pilot_is_unknown(&pilot));
        signs.thrust_n = 7.0F; /* it stays so */
        (void)step(FLIGHT_LANDING);
        TEST_ASSERT_EQUAL(pin == 0, pilot_is_unknown(&pilot));
    }
}
