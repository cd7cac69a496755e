#include "flight_case.h"

static handover_t handover;

void setUp(void)
{
    begin();
    memset(&handover, 0, sizeof handover);
}

void tearDown(void) {}

static void change_mode(flight_mode_t before, flight_mode_t mode)
{
    mode_changes(before, mode);
    handover_mode(&est, &where, &now);
}

static void change_doubts(uint16_t doubted)
{
    evidence.doubts = doubted;
    handover_doubts(&handover, &est, &where, &now);
}

static void locate(void)
{
    handover_place(&est, &where, &now, &in, PILOT_NO_NEWS, 0.0F);
}

void test_law_est_is_engaged_where_it_takes_over_in_the_air(void)
{
    static const struct {
        flight_mode_t before, now;
        flight_state_t state;
        bool lifting, engaged;
    } rows[] = {{FLIGHT_MODE_LAW, FLIGHT_MODE_EST_HOLD, FLIGHT_FLYING, false, true},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_EST_LAND, FLIGHT_LANDING, false, true},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_EST_SINK, FLIGHT_DESCENDING, false, true},
                {FLIGHT_MODE_LAW, FLIGHT_MODE_EST_HOLD, FLIGHT_FLYING, true, false},
                {FLIGHT_MODE_IDLE, FLIGHT_MODE_EST_HOLD, FLIGHT_TAKEOFF, false, false},
                {FLIGHT_MODE_IDLE, FLIGHT_MODE_EST_SINK, FLIGHT_DESCENDING, false, true},
                {FLIGHT_MODE_EST_LAND, FLIGHT_MODE_EST_HOLD, FLIGHT_FLYING, false, false},
                {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_EST_SINK, FLIGHT_DESCENDING, false, false},
                {FLIGHT_MODE_EST_HOLD, FLIGHT_MODE_LAW, FLIGHT_FLYING, false, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        airborne(false);
        in_state(rows[i].state);
        lifting(rows[i].lifting);
        contact_step(&where.contact, &(contact_signs_t){.state = rows[i].state});
        now.thrust_n = 6.6F;
        hovers_at_n(7.2F);
        change_mode(rows[i].before, rows[i].now);
        TEST_ASSERT_EQUAL(rows[i].engaged, where.contact.airborne);
        if (rows[i].engaged) {
            NEAR(7.2F, est.hover.thrust_n);
        }
    }
}

void test_a_hover_thrust_learned_in_this_flight_is_not_learned_anew_after_another_law(void)
{
    for (int i = 0; i < 2; i++) {
        setUp();
        airborne(i == 1);
        est_hovers_at_n(7.4F);
        est.hover.variance_n2 = 0.01F;
        hovers_at_n(6.9F);
        change_mode(FLIGHT_MODE_LAW, FLIGHT_MODE_EST_HOLD);
        NEAR((i == 1) ? 7.4F : 6.9F, est.hover.thrust_n);
        NEAR((i == 1) ? 0.01F : 0.25F, est.hover.variance_n2);
    }
}

void test_it_flies_by_the_heights_or_by_a_felt_climb(void)
{
    static const struct {
        flight_state_t state;
        bool lifting;
        float height_mm, felt_mps, shaken;
        bool flies;
    } rows[] = {
        {FLIGHT_FLYING, false, 0.0F, 0.0F, 1.0F, true},    {FLIGHT_FLYING, true, 0.0F, 0.0F, 1.0F, false},
        {FLIGHT_FLYING, true, 81.0F, 0.0F, 1.0F, true},    {FLIGHT_FLYING, true, 0.0F, 0.26F, 1.0F, true},
        {FLIGHT_FLYING, true, 0.0F, 0.25F, 1.0F, false},   {FLIGHT_TAKEOFF, true, 0.0F, 0.26F, 1.0F, true},
        {FLIGHT_TAKEOFF, false, 81.0F, 0.0F, 1.0F, false}, {FLIGHT_FLYING, true, 0.0F, 0.49F, 2.0F, false},
        {FLIGHT_FLYING, true, 0.0F, 0.51F, 2.0F, true},    {FLIGHT_LANDING, false, 81.0F, 0.5F, 1.0F, false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        in_state(rows[i].state);
        lifting(rows[i].lifting);
        evidence.felt_mps = rows[i].felt_mps;
        evidence.shaken = rows[i].shaken;
        mode_is(FLIGHT_MODE_LAW);
        airborne(false);
        now.risen = rows[i].height_mm > 80.0F;
        locate();
        TEST_ASSERT_EQUAL(rows[i].flies, where.contact.airborne);
    }
}

/* The heights told 0.1 m/s, and are gone for 0.3 s; the accelerometer feels otherwise. */
static float speed_after_mps(float felt_mps, uint32_t age_us)
{
    setUp();
    airborne(true);
    in_state(FLIGHT_COASTING);
    cycle_takes_us(25000U);
    height_is_new(false, age_us);
    feel(felt_mps);
    evidence.bias_mps2 = 0.2F;
    estimated(0.6F, 0.1F, 0.0F);
    locate();
    NEAR(est.estimator.now.speed_mps - est.estimator.now.terrain_mps, 0.1F); /* the same above the ground */
    return est.estimator.now.speed_mps;
}

void test_heights_that_go_while_the_ground_rises_leave_the_speed_that_is_felt(void)
{
    NEAR(0.9F, speed_after_mps(0.9F, 300001U));
    NEAR(0.2F, est.estimator.now.bias_mps2);
    NEAR(-0.5F, speed_after_mps(-0.5F, 325000U));
    NEAR(0.1F, speed_after_mps(0.42F, 325000U)); /* as wrong as both may be */
    NEAR(0.1F, speed_after_mps(0.9F, 300000U));  /* still fresh */
    NEAR(0.1F, speed_after_mps(0.9F, 325001U));  /* once is enough */
}

void test_a_take_off_that_was_given_up_flies_when_a_climb_is_felt(void)
{
    static const struct {
        flight_state_t state;
        bool estimated;
        float felt_mps;
        bool flies;
    } rows[] = {{FLIGHT_LANDING, true, 0.26F, true},
                {FLIGHT_LANDING, true, 0.25F, false},
                {FLIGHT_LANDING, false, 0.26F, false},
                {FLIGHT_TAKEOFF, true, 0.26F, false}};
    for (int i = 0; i < 4; i++) {
        setUp();
        took_off_in_vain();
        nothing_learned();
        airborne(false);
        in_state(rows[i].state);
        feel(rows[i].felt_mps);
        if (!rows[i].estimated) {
            lose_the_estimate();
        }
        locate();
        TEST_ASSERT_EQUAL(rows[i].flies, !contact_stops(&where.contact, FLIGHT_LANDING));
        hover_thrust_step(&where.hover, &(hover_lesson_t){.gravity_n = 8.0F, .estimated_n = 7.0F});
        TEST_ASSERT_EQUAL(!rows[i].flies, where.hover.thrust_n == 8.0F); /* else it is of this flight */
        TEST_ASSERT_EQUAL(rows[i].flies, where.contact.airborne);
    }
}

/* What law EST is engaged with when law PID has left the ground. */
static float first_hover_n(void)
{
    mode_is(FLIGHT_MODE_LAW);
    airborne(false);
    est_hovers_at_n(7.0F);
    locate();
    TEST_ASSERT_TRUE(where.contact.airborne);
    return est.hover.thrust_n;
}

void test_the_first_hover_thrust_of_another_law_is_newtons(void)
{
    delivers_n(8.0F);
    lifts_at(0.6F);
    evidence.felt_mps = 0.2F;
    hovers_at_n(6.9F);
    NEAR(8.0F - 1.1F * 7.0F / 9.80665F, first_hover_n());
    delivers_n(11.0F);
    NEAR(8.5F, first_hover_n());
    delivers_n(4.0F);
    NEAR(5.5F, first_hover_n());
    accelerations_come(false);
    NEAR(6.9F, first_hover_n());
    accelerations_come(true);
    lose_the_estimate();
    NEAR(6.9F, first_hover_n());
}

void test_a_doubt_of_the_sight_corrects_the_estimate_by_the_worlds_in_which_all_lie(void)
{
    evidence.blind_height_m = 0.9F;
    evidence.speed_mps = 0.3F;
    evidence.bias_mps2 = 0.15F;
    now.thrust_n = 7.7F;
    hovers_at_n(7.1F);
    change_doubts(DOUBT_SIGHT);
    NEAR(0.9F, est.estimator.now.height_m);
    NEAR(0.3F, est.estimator.now.speed_mps);
    NEAR(0.15F, est.estimator.now.bias_mps2);
    NEAR(7.1F, est.hover.thrust_n);
    evidence.blind_height_m = 0.4F;
    est_hovers_at_n(6.5F);
    change_doubts(DOUBT_SIGHT); /* once */
    NEAR(0.9F, est.estimator.now.height_m);
    NEAR(6.5F, est.hover.thrust_n);
}

/* The heights that are doubted come to no estimate: neither does their rate. */
void test_a_doubt_of_the_imu_while_the_sight_is_doubted_keeps_the_height(void)
{
    evidence.blind_height_m = 0.9F;
    evidence.height_m = 0.3F;
    evidence.rise_mps = 0.0F;
    evidence.bias_mps2 = 0.15F;
    airborne(true);
    change_doubts(DOUBT_SIGHT);
    evidence.speed_mps = 0.5F;
    change_doubts(DOUBT_SIGHT | DOUBT_IMU);
    NEAR(0.9F, est.estimator.now.height_m);
    NEAR(0.5F, est.estimator.now.speed_mps);
    NEAR(0.0F, est.estimator.now.bias_mps2);
}

void test_the_end_of_a_doubt_of_the_sight_starts_the_estimate_from_the_heights(void)
{
    for (int flies = 0; flies < 2; flies++) {
        setUp();
        change_doubts(DOUBT_SIGHT);
        airborne(flies != 0);
        evidence.height_m = 0.45F;
        evidence.rise_mps = -0.6F;
        evidence.bias_mps2 = 0.15F;
        estimated(0.9F, 2.0F, 0.0F);
        est_hovers_at_n(6.5F);
        now.thrust_n = 4.5F;
        hovers_at_n(7.1F);
        change_doubts(0U);
        NEAR((flies != 0) ? 0.45F : 0.9F, est.estimator.now.height_m);
        NEAR((flies != 0) ? -0.6F : 2.0F, est.estimator.now.speed_mps);
        NEAR((flies != 0) ? 7.1F : 6.5F, est.hover.thrust_n);
        if (flies != 0) {
            NEAR(0.15F, est.estimator.now.bias_mps2);
        }
        evidence.height_m = 0.7F;
        change_doubts(0U); /* once */
        NEAR((flies != 0) ? 0.45F : 0.9F, est.estimator.now.height_m);
    }
}

void test_a_vehicle_that_flies_unseen_is_engaged_and_one_on_the_ground_is_not(void)
{
    for (int sways = 0; sways < 2; sways++) {
        setUp();
        airborne(false);
        sway(sways != 0);
        change_doubts(DOUBT_SIGHT);
        TEST_ASSERT_EQUAL(sways != 0, where.contact.airborne);
    }
    setUp();
    airborne(false);
    sway(true); /* and no doubt */
    change_doubts(DOUBT_THRUST);
    TEST_ASSERT_FALSE(where.contact.airborne);
    change_doubts(0U);
    TEST_ASSERT_FALSE(where.contact.airborne);
}

void test_a_doubt_of_the_imu_gives_up_what_was_learned_a_short_time(void)
{
    static const struct {
        int cycles;
        float hover_n;
    } rows[] = {{26, 7.6F}, {24, 7.0F}};
    for (int i = 0; i < 2; i++) {
        setUp();
        hovers_at_n(7.6F);
        const hover_lesson_t lesson = {.gravity_n = GRAV_N,
                                       .step_s = 0.1F,
                                       .flies = true,
                                       .sees = true,
                                       .estimated = true,
                                       .teaches = true,
                                       .estimated_n = 7.6F};
        for (int k = 0; k < rows[i].cycles; k++) {
            hover_thrust_step(&where.hover, &lesson);
        }
        evidence.height_m = 0.45F;
        evidence.rise_mps = -0.1F;
        estimated(0.5F, 0.0F, 0.7F);
        now.thrust_n = 6.8F;
        change_doubts(DOUBT_IMU);
        NEAR(rows[i].hover_n, where.hover.thrust_n);
        NEAR(0.45F, est.estimator.now.height_m);
        NEAR(-0.1F, est.estimator.now.speed_mps);
        NEAR(0.0F, est.estimator.now.bias_mps2);
        NEAR(rows[i].hover_n, est.hover.thrust_n);
        TEST_ASSERT_FALSE(est_law_has_acceleration(&est));
    }
    setUp();
    airborne(false);
    evidence.height_m = 0.45F;
    change_doubts(DOUBT_IMU);
    NEAR(0.5F, est.estimator.now.height_m);
    TEST_ASSERT_FALSE(where.contact.airborne);
}

void test_a_doubt_of_the_thrust_or_an_unsure_pilot_leaves_the_law_without_authority(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        unknown(i == 2);
        hovers_at_n(7.3F);
        est_law_predict(&est, &parameters, &(est_before_t){.airborne = true, .hover_n = 7.3F}, NULL, 0U,
                        FRAME_AGE_US + 1000U);
        est_hovers_at_n(6.8F);
        change_doubts((i == 1) ? DOUBT_THRUST : 0U);
        NEAR((i != 0) ? 7.3F : 6.8F, est.hover.thrust_n); /* the sure one, then */
    }
    setUp();
    for (int i = 0; i < 2; i++) { /* while it is only probable, the law goes on with what it knows */
        evidence.mirrors.no_effect = i == 0;
        est_hovers_at_n(6.8F);
        change_doubts(0U);
        TEST_ASSERT_EQUAL(evidence.mirrors.no_effect, est.doubted.no_effect);
        set(PARAMETER_PLANT, (float)PLANT_CLIMB); /* orders a rate: no acceleration is what it asks for */
        change_doubts(0U);
        TEST_ASSERT_FALSE(est.doubted.no_effect);
        set(PARAMETER_PLANT, (float)PLANT_THRUST);
        TEST_ASSERT_FALSE(est.doubted.without_authority);
        NEAR(6.8F, est.hover.thrust_n);
    }
    setUp();
    change_doubts(DOUBT_THRUST);
    hovers_at_n(7.4F);
    est_hovers_at_n(6.8F);
    change_doubts(0U); /* it has gone */
    NEAR(7.4F, est.hover.thrust_n);
}

void test_on_the_ground_the_law_is_reset_and_with_a_pilot_disengaged(void)
{
    in_state(FLIGHT_GROUND);
    locate();
    TEST_ASSERT_FALSE(where.contact.airborne);
    setUp();
    in_state(FLIGHT_FLOATING);
    locate();
    TEST_ASSERT_TRUE(where.contact.airborne);
    in.has_throttle = false;
    locate();
    TEST_ASSERT_FALSE(where.contact.airborne);
    in_state(FLIGHT_FLYING);
    airborne(true);
    locate();
    TEST_ASSERT_TRUE(where.contact.airborne);
}

void test_other_laws_engage_the_estimate_when_they_fly(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        est_law_engage(&est, GRAV_N);
        mode_is((i == 1) ? FLIGHT_MODE_EST_HOLD : FLIGHT_MODE_LAW);
        airborne(i == 2);
        lifting(i == 3);
        now.risen = i != 3;
        now.thrust_n = 6.6F;
        locate();
        TEST_ASSERT_EQUAL(i == 0 || i == 2, where.contact.airborne);
    }
}

void test_a_descent_from_a_pilots_hands_starts_from_the_felt_speed(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        in_state((i == 1) ? FLIGHT_LANDING : FLIGHT_DESCENDING);
        evidence.felt_mps = 0.3F;
        evidence.bias_mps2 = 0.15F;
        change_mode((i == 2) ? FLIGHT_MODE_LAW : FLIGHT_MODE_IDLE, FLIGHT_MODE_EST_SINK);
        NEAR((i == 0) ? 0.3F : 0.0F, est.estimator.now.speed_mps);
        NEAR((i == 0) ? 0.15F : 0.0F, est.estimator.now.bias_mps2);
        NEAR((i == 0) ? 0.0F : 0.5F, est.estimator.now.height_m);
    }
}

void test_an_imu_that_is_back_starts_the_estimate_from_thrust_and_heights(void)
{
    static const struct {
        bool airborne, frames, felt, doubted, starts;
    } rows[] = {{true, true, true, false, true},
                {false, true, true, false, false},
                {true, false, true, false, false},
                {true, true, false, false, true},
                {true, true, true, true, true}};
    for (int i = 0; i < 5; i++) {
        setUp();
        lose_the_estimate();
        airborne(rows[i].airborne);
        frame_was_s_ago(rows[i].frames ? 0.0F : 1.0F);
        accelerations_come(rows[i].felt);
        evidence.doubts = rows[i].doubted ? DOUBT_SIGHT : 0U;
        evidence.height_m = 0.7F;
        evidence.bias_mps2 = 0.25F;
        evidence.pushed_mps = 0.24F;
        evidence.speed_mps = -0.3F;
        evidence.moved_m = 0.05F;
        locate();
        TEST_ASSERT_EQUAL(rows[i].starts, est.estimator.initialised);
        if (rows[i].starts) {
            NEAR(rows[i].doubted ? 0.5F : 0.75F, est.estimator.now.height_m);
            NEAR(rows[i].doubted ? -0.3F : 0.24F, est.estimator.now.speed_mps);
            NEAR(rows[i].felt ? 0.25F : 0.0F, est.estimator.now.bias_mps2);
        }
    }
}

void test_a_hover_thrust_learned_in_this_flight_survives_a_law_without_the_estimate(void)
{
    static const struct {
        flight_mode_t before;
        bool airborne, knows;
    } rows[] = {{FLIGHT_MODE_LAW, true, true},
                {FLIGHT_MODE_LAW, false, false},
                {FLIGHT_MODE_DESCENT, true, true},
                {FLIGHT_MODE_DESCENT, false, false},
                {FLIGHT_MODE_FLOAT, true, false}};
    for (int i = 0; i < 5; i++) {
        setUp();
        airborne(rows[i].airborne);
        est_hovers_at_n(7.6F);
        est.hover.variance_n2 = 0.02F;
        hovers_at_n(7.2F);
        change_mode(rows[i].before, FLIGHT_MODE_EST_HOLD);
        NEAR(rows[i].knows ? 7.6F : 7.2F, est.hover.thrust_n);
        NEAR(rows[i].knows ? 0.02F : 0.25F, est.hover.variance_n2);
        TEST_ASSERT_TRUE(where.contact.airborne);
    }
}

/* In a descent out of a pilot's hands, in 0.1 of 2 s. */
void test_what_was_felt_for_long_is_forgotten_as_a_bias(void)
{
    given_back(0.06F);
    estimated(0.5F, 0.3F, 0.2F);
    handover_given_back(&est, &now);
    NEAR(0.285F, est.estimator.now.speed_mps);
    NEAR(0.20075F, est.estimator.now.bias_mps2);
    NEAR(0.0F, est.estimator.now.height_m);
}

/* The end of a landing, which is slow while the tilt moves as in flight. */
void test_law_est_is_told_that_the_tilt_moves(void)
{
    float thrust_n[2];

    for (int rocks = 0; rocks < 2; rocks++) {
        setUp();
        sway(rocks != 0);
        change_doubts(0U);
        for (uint32_t i = 1U; i <= 20U; i++) {
            estimated(0.01F, 0.0F, 0.0F);
            est_predicts(true, NULL, 0U, FRAME_AGE_US + 100000U * i);
            thrust_n[rocks] = est_flies_n(true, EST_MODE_LAND, 0.0F);
        }
    }
    TEST_ASSERT_TRUE(thrust_n[1] > thrust_n[0] + 0.5F);
}
