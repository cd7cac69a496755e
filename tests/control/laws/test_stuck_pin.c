#include "control/laws/stuck_pin.h"

#include "flight_case.h"

static stuck_pin_t pin;

/* The pin says that the pilot flies; hover thrust 7 N, cycles of 0.1 s. */
void setUp(void)
{
    begin();
    memset(&pin, 0, sizeof pin);
    in_state(FLIGHT_FLOATING);
    flagged(FLIGHT_FLAG_PILOT);
    mode_is(FLIGHT_MODE_HOVER);
    height_is(500.0F, 0.0F, 100000U, false);
}

void tearDown(void) {}

static float added_n(void)
{
    stuck_pin_step(&pin, &now);
    return stuck_pin_added_n(&pin);
}

/* It says so for so many cycles, and the vehicle hangs still. */
static void said_for(int cycles)
{
    height_is(500.0F, 0.0F, 100000U, true);
    for (int i = 0; i < cycles; i++) {
        (void)added_n();
    }
}

/* Heights that sink by 0.1 m/s. */
static float sinks_n(void)
{
    height_is(500.0F, -100.0F, 100000U, true);
    return added_n();
}

void test_for_five_seconds_the_output_only_holds_the_height(void)
{
    said_for(45);
    const float before_n = stuck_pin_added_n(&pin);
    TEST_ASSERT_FLOAT_WITHIN(0.3F, 0.0F, before_n); /* it wants 0.03 m/s */
    const float held_n = sinks_n();
    TEST_ASSERT_FLOAT_WITHIN(0.02F, 0.2F, held_n - before_n); /* against 0.1 m/s */
    height_is_new(false, 0U);
    NEAR(held_n, added_n()); /* as before */
    said_for(2);
    TEST_ASSERT_FLOAT_WITHIN(0.005F, before_n + 0.03F,
                             stuck_pin_added_n(&pin)); /* 4.9 s; for the 10 mm that it sank */
    said_for(10);
    TEST_ASSERT_TRUE(stuck_pin_added_n(&pin) < before_n - 0.5F); /* then it sinks */
}

void test_an_order_to_land_counts_at_once(void)
{
    said_for(10);
    ordered_m(0.0F);
    said_for(10);
    TEST_ASSERT_TRUE(stuck_pin_added_n(&pin) < -0.5F);
}

void test_without_heights_it_holds_and_then_falls_as_a_blind_descent(void)
{
    static const struct {
        int cycles;
        bool land;
        uint32_t age_us;
        float added_n;
    } rows[] = {{10, false, 2000000U, 0.0F},
                {10, true, 2000000U, -0.527F}, /* 7.3 % and the fade of 2 s */
                {60, false, 2000000U, -0.527F},
                {60, false, 60000000U, -2.0F}};

    for (int i = 0; i < 4; i++) {
        setUp();
        said_for(rows[i].cycles);
        ordered_m(rows[i].land ? 0.0F : 0.6F);
        height_is_new(false, rows[i].age_us);
        TEST_ASSERT_FLOAT_WITHIN(0.005F, rows[i].added_n, added_n());
    }
}

void test_what_is_added_is_limited(void)
{
    said_for(60);
    height_is(500.0F, -1500.0F, 100000U, true);
    NEAR(1.0F, added_n());
    height_is(500.0F, 3000.0F, 100000U, true);
    NEAR(-2.0F, added_n());
    now.idle_n = 5.5F;
    NEAR(-1.5F, added_n()); /* the idle is the least */
    now.idle_n = 0.0F;
    for (int i = 0; i < 60; i++) { /* it lies on the ground */
        height_is(10.0F, 0.0F, 100000U, true);
        (void)added_n();
    }
    NEAR(-7.0F, added_n());
    now.idle_n = 0.6F;
    NEAR(-6.4F, added_n());
}

void test_a_gap_of_heights_counts_as_0_3_s(void)
{
    float thrust_n[2];

    for (uint32_t i = 0U; i < 2U; i++) {
        setUp();
        said_for(60);
        height_is(500.0F, 100.0F, 300000U + 4700000U * i, true);
        (void)added_n();
        thrust_n[i] = sinks_n();
    }
    NEAR(thrust_n[0], thrust_n[1]);
}

void test_it_ends_with_the_pilots_turn_and_begins_anew(void)
{
    said_for(60);
    TEST_ASSERT_TRUE(stuck_pin_acts(&pin) && stuck_pin_added_n(&pin) < -0.5F);
    mode_is(FLIGHT_MODE_EST_HOLD);
    const float before_n = stuck_pin_added_n(&pin);
    NEAR(before_n, added_n()); /* not in another mode: its change resets it */
    mode_changes(FLIGHT_MODE_HOVER, FLIGHT_MODE_EST_HOLD);
    NEAR(0.0F, added_n());
    TEST_ASSERT_FALSE(stuck_pin_acts(&pin));
    mode_is(FLIGHT_MODE_HOVER);
    said_for(10);
    TEST_ASSERT_FLOAT_WITHIN(0.15F, 0.0F, stuck_pin_added_n(&pin)); /* trusted again */
    said_for(60);
    flagged(0U); /* the pin says that nobody else flies */
    NEAR(0.0F, added_n());
    TEST_ASSERT_FALSE(stuck_pin_acts(&pin));
}

void test_near_the_ground_a_tilt_that_moves_makes_the_end_slow(void)
{
    float more_n[2];

    for (int rocks = 0; rocks < 2; rocks++) {
        setUp();
        now.rocks = rocks != 0;
        said_for(60);
        for (int i = 0; i < 20; i++) {
            height_is(10.0F, 0.0F, 100000U, true);
            more_n[rocks] = added_n();
        }
    }
    TEST_ASSERT_TRUE(more_n[1] > more_n[0] + 0.5F);
}

/* It wants to sink, and for a second has too little thrust to fly: somebody else holds the vehicle. */
void test_a_vehicle_that_does_not_sink_is_a_pilots_and_the_output_stays_near_the_hover_thrust(void)
{
    float least_n = 0.0F;

    said_for(60);
    for (int i = 0; i < 120; i++) {
        height_is(500.0F, 0.0F, 100000U, true);
        least_n = fminf(least_n, added_n());
    }
    TEST_ASSERT_TRUE(least_n < -1.5F);
    NEAR(-0.5F, stuck_pin_added_n(&pin));
    height_is(500.0F, -400.0F, 100000U, true); /* he descends */
    TEST_ASSERT_TRUE(added_n() >= -0.5F);
    height_is(500.0F, 0.0F, 100000U, true);
    NEAR(-0.5F, added_n());
}

static void told(int scans, float height_mm, float rate_mm_s)
{
    for (int i = 0; i < scans; i++) {
        height_is(height_mm, rate_mm_s, 100000U, true);
        (void)added_n();
    }
}

/* A pilot sways: every fourth scan shows that it sinks. It is doubted after as much more that does not. */
void test_a_moment_of_sinking_takes_back_a_moment(void)
{
    said_for(90);
    told(3, 500.0F, 0.0F);
    pin.vain_s = 0.3F;
    pin.more_n = -1.9F;
    told(1, 500.0F, -400.0F);
    NEAR(0.2F, pin.vain_s);
    pin.more_n = -1.9F;
    told(1, 500.0F, 0.0F);
    NEAR(0.3F, pin.vain_s);
    pin.more_n = -1.4F; /* enough to fly with */
    told(1, 500.0F, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, pin.vain_s);
}

/* He flies to and fro, at one height: the output does not run away from the hover thrust. */
void test_a_pilot_who_sways_about_one_height_does_not_lower_the_output(void)
{
    for (int i = 0; i < 48; i++) {
        height_is(500.0F, (i % 8 < 4) ? 300.0F : -300.0F, 100000U, true);
        (void)added_n();
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1F, 0.0F, pin.descent.trim_n);
}

/* He has given it back, and the pin still says that he flies. */
void test_a_fall_out_of_a_pilots_hands_is_braked_in_the_next_scan(void)
{
    said_for(60);
    told(120, 500.0F, 0.0F);
    NEAR(-0.5F, stuck_pin_added_n(&pin));
    told(1, 450.0F, -700.0F);
    TEST_ASSERT_FLOAT_WITHIN(0.15F, 0.3F, stuck_pin_added_n(&pin));
    told(1, 400.0F, -1200.0F);
    NEAR(1.0F, stuck_pin_added_n(&pin));
    pin.descent.trim_n = 2.0F; /* from before it was known */
    told(1, 500.0F, 0.0F);
    NEAR(-0.5F, stuck_pin_added_n(&pin));
}

/* What comes before the beam looks like a fall, and is none. */
void test_a_step_of_the_height_moves_nothing(void)
{
    said_for(10);
    const float before_n = stuck_pin_added_n(&pin);

    evidence.stepped = true;
    told(1, 230.0F, -1000.0F);
    NEAR(before_n, stuck_pin_added_n(&pin));
    height_is_new(false, 0U);
    NEAR(before_n, added_n());
    evidence.stepped = false;
    told(1, 230.0F, -100.0F);
    TEST_ASSERT_TRUE(stuck_pin_added_n(&pin) > before_n + 0.1F);
}

/* Without accelerations nothing explains a fall at 1.3 m/s: each of its heights is a step. */
void test_two_steps_in_a_row_are_a_motion(void)
{
    said_for(10);
    const float before_n = stuck_pin_added_n(&pin);

    evidence.stepped = true;
    told(1, 360.0F, -1000.0F);
    NEAR(before_n, stuck_pin_added_n(&pin));
    told(1, 220.0F, -1000.0F);
    NEAR(1.0F, stuck_pin_added_n(&pin));
    flagged(0U); /* the next turn begins anew */
    (void)added_n();
    TEST_ASSERT_FALSE(pin.stepped);
}

void test_a_pilot_who_flies_off_a_table_does_not_obey(void)
{
    said_for(60);
    told(120, 500.0F, 0.0F);
    evidence.stepped = true;
    told(1, 900.0F, 1000.0F);
    evidence.stepped = false;
    told(5, 900.0F, 0.0F);
    NEAR(-0.5F, stuck_pin_added_n(&pin));
    TEST_ASSERT_FALSE(pin.obeys);
    told(1, 1201.0F, 100.0F);
    TEST_ASSERT_TRUE(pin.obeys);
}

void test_one_that_rises_by_0_3_m_when_the_thrust_returns_obeys_and_is_lowered_for_this_turn(void)
{
    said_for(60);
    told(120, 500.0F, 0.0F);
    NEAR(-0.5F, stuck_pin_added_n(&pin));
    told(5, 799.0F, 100.0F);
    NEAR(-0.5F, stuck_pin_added_n(&pin));
    where.supervisor.height = (height_track_t){.height_mm = 801.0F, .age_us = 400000U};
    (void)added_n();
    TEST_ASSERT_FALSE(pin.obeys); /* an old height */
    told(1, 801.0F, 100.0F);
    NEAR(-2.0F, stuck_pin_added_n(&pin));
    TEST_ASSERT_FLOAT_WITHIN(0.2F, -1.5F, pin.descent.trim_n); /* with so much less it did not sink */
    told(10, 900.0F, 100.0F);
    TEST_ASSERT_TRUE(pin.descent.trim_n < -1.9F); /* and it goes on from there */
    told(60, 500.0F, 0.0F);                       /* it was known before */
    NEAR(-2.0F, stuck_pin_added_n(&pin));
    flagged(0U);
    (void)added_n();
    TEST_ASSERT_FALSE(pin.obeys);
}

void test_one_that_sinks_is_not_a_pilots(void)
{
    said_for(60);
    for (int i = 0; i < 60; i++) { /* lighter by a newton: it needs so little */
        height_is(500.0F, (stuck_pin_added_n(&pin) < -1.5F) ? -310.0F : 100.0F, 100000U, true);
        (void)added_n();
    }
    TEST_ASSERT_TRUE(stuck_pin_added_n(&pin) < -1.0F);
}

void test_the_hover_thrust_is_not_its_business(void)
{
    said_for(60);
    NEAR(7.0F, where.hover.thrust_n);
}
