#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

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
        f.est.airborne = false;
        f.where.supervisor.state = rows[i].state;
        f.where.contact.lifting = rows[i].lifting;
        f.thrust_n = 6.6F;
        f.where.hover.thrust_n = 7.2F;
        change_mode(rows[i].before, rows[i].now);
        TEST_ASSERT_EQUAL(rows[i].engaged, f.est.airborne);
        if (rows[i].engaged) {
            NEAR(6.6F, f.est.cascade.thrust_n);
            NEAR(7.2F, f.est.hover.thrust_n);
        }
    }
}

void test_a_hover_thrust_learned_in_this_flight_is_not_learned_anew_after_another_law(void)
{
    for (int i = 0; i < 2; i++) {
        setUp();
        f.est.airborne = i == 1;
        f.est.hover.thrust_n = 7.4F;
        f.est.hover.variance_n2 = 0.01F;
        f.where.hover.thrust_n = 6.9F;
        change_mode(FLIGHT_MODE_LAW, FLIGHT_MODE_EST_HOLD);
        NEAR((i == 1) ? 7.4F : 6.9F, f.est.hover.thrust_n);
        NEAR((i == 1) ? 0.01F : 0.25F, f.est.hover.variance_n2);
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
        f.est.ground_m = 0.0F;
        f.where.supervisor.state = rows[i].state;
        f.where.contact.lifting = rows[i].lifting;
        f.where.supervisor.height.height_mm = rows[i].height_mm;
        f.evidence.felt_mps = rows[i].felt_mps;
        f.evidence.shaken = rows[i].shaken;
        f.mode = FLIGHT_MODE_LAW;
        f.est.airborne = false;
        const situation_t now = situation();
        handover_contact(&f.est, &f.where, &now, true);
        TEST_ASSERT_EQUAL(rows[i].flies, f.est.airborne);
    }
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
        f.where.contact.gave_up = true;
        f.where.hover.learned = false;
        f.est.airborne = false;
        f.where.supervisor.state = rows[i].state;
        feel(rows[i].felt_mps);
        if (!rows[i].estimated) {
            lose_the_estimate();
        }
        update_estimator();
        TEST_ASSERT_EQUAL(rows[i].flies, !f.where.contact.gave_up);
        TEST_ASSERT_EQUAL(rows[i].flies, f.where.hover.learned);
        TEST_ASSERT_EQUAL(rows[i].flies, f.est.airborne);
    }
}

/* What law EST is engaged with when law PID has left the ground. */
static float first_hover_n(void)
{
    f.mode = FLIGHT_MODE_LAW;
    f.est.airborne = false;
    f.est.hover.least_n = 0.0F;
    f.est.hover.most_n = THRUST_MAX_N;
    f.est.hover.thrust_n = 7.0F;
    const situation_t now = situation();
    handover_contact(&f.est, &f.where, &now, true);
    TEST_ASSERT_TRUE(f.est.airborne);
    return f.est.hover.thrust_n;
}

void test_the_first_hover_thrust_of_another_law_is_newtons(void)
{
    f.est.actuator.thrust_n = 8.0F;
    f.est.lift_mps2 = 0.6F;
    f.evidence.felt_mps = 0.2F;
    f.where.hover.thrust_n = 6.9F;
    NEAR(8.0F - 1.1F * 7.0F / 9.80665F, first_hover_n());
    f.est.actuator.thrust_n = 11.0F;
    NEAR(8.5F, first_hover_n());
    f.est.actuator.thrust_n = 4.0F;
    NEAR(5.5F, first_hover_n());
    f.est.estimator.felt = false;
    NEAR(6.9F, first_hover_n());
    f.est.estimator.felt = true;
    lose_the_estimate();
    NEAR(6.9F, first_hover_n());
}

void test_a_doubt_of_the_sight_corrects_the_estimate_by_the_error_found(void)
{
    f.evidence.doubts = DOUBT_SIGHT;
    f.evidence.lost_m = -0.4F;
    f.evidence.speed_mps = 0.3F;
    f.evidence.bias_mps2 = 0.15F;
    f.thrust_n = 7.7F;
    f.where.hover.thrust_n = 7.1F;
    change_doubts();
    NEAR(0.9F, f.est.estimator.now.height_m);
    NEAR(0.3F, f.est.estimator.now.speed_mps);
    NEAR(0.15F, f.est.estimator.now.bias_mps2);
    NEAR(7.1F, f.est.hover.thrust_n);
    NEAR(7.7F, f.est.cascade.thrust_n);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, f.handover.doubts);
    f.evidence.lost_m = 0.4F;
    f.est.hover.thrust_n = 6.5F;
    change_doubts(); /* once */
    NEAR(0.9F, f.est.estimator.now.height_m);
    NEAR(6.5F, f.est.hover.thrust_n);
}

void test_the_end_of_a_doubt_of_the_sight_starts_the_estimate_from_the_heights(void)
{
    for (int airborne = 0; airborne < 2; airborne++) {
        setUp();
        f.est.airborne = airborne != 0;
        f.handover.doubts = DOUBT_SIGHT;
        f.evidence.height_m = 0.45F;
        f.evidence.rise_mps = -0.6F;
        f.evidence.bias_mps2 = 0.15F;
        f.est.estimator.filter.estimate.height_m = f.est.estimator.now.height_m = 0.9F;
        f.est.estimator.filter.estimate.speed_mps = f.est.estimator.now.speed_mps = 2.0F;
        f.est.hover.thrust_n = 6.5F;
        f.thrust_n = 4.5F;
        f.where.hover.thrust_n = 7.1F;
        change_doubts();
        NEAR((airborne != 0) ? 0.45F : 0.9F, f.est.estimator.now.height_m);
        NEAR((airborne != 0) ? -0.6F : 2.0F, f.est.estimator.now.speed_mps);
        NEAR((airborne != 0) ? 7.1F : 6.5F, f.est.hover.thrust_n);
        if (airborne != 0) {
            NEAR(0.15F, f.est.estimator.now.bias_mps2);
            NEAR(4.5F, f.est.cascade.thrust_n);
        }
        TEST_ASSERT_EQUAL_UINT16(0U, f.handover.doubts);
    }
}

void test_a_vehicle_that_flies_unseen_is_engaged_and_one_on_the_ground_is_not(void)
{
    for (int sways = 0; sways < 2; sways++) {
        setUp();
        f.est.airborne = false;
        f.evidence.doubts = DOUBT_SIGHT;
        sway(sways != 0);
        change_doubts();
        TEST_ASSERT_EQUAL(sways != 0, f.est.airborne);
    }
    setUp();
    f.est.airborne = false;
    sway(true); /* and no doubt */
    f.evidence.doubts = DOUBT_THRUST;
    change_doubts();
    TEST_ASSERT_FALSE(f.est.airborne);
    f.evidence.doubts = 0U;
    change_doubts();
    TEST_ASSERT_FALSE(f.est.airborne);
}

void test_a_doubt_of_the_imu_gives_up_what_was_learned_a_short_time(void)
{
    static const struct {
        float learned_s, hover_n;
    } rows[] = {{2.5F, 7.6F}, {2.4F, 7.0F}};
    for (int i = 0; i < 2; i++) {
        setUp();
        f.where.hover.thrust_n = 7.6F;
        f.where.hover.learned_s = rows[i].learned_s;
        f.evidence.doubts = DOUBT_IMU;
        f.evidence.height_m = 0.45F;
        f.evidence.rise_mps = -0.1F;
        f.est.estimator.now.bias_mps2 = f.est.estimator.filter.estimate.bias_mps2 = 0.7F;
        f.thrust_n = 6.8F;
        change_doubts();
        NEAR(rows[i].hover_n, f.where.hover.thrust_n);
        TEST_ASSERT_EQUAL_FLOAT((i == 0) ? 2.5F : 0.0F, f.where.hover.learned_s);
        NEAR(0.45F, f.est.estimator.now.height_m);
        NEAR(-0.1F, f.est.estimator.now.speed_mps);
        NEAR(0.0F, f.est.estimator.now.bias_mps2);
        NEAR(rows[i].hover_n, f.est.hover.thrust_n);
        NEAR(6.8F, f.est.cascade.thrust_n);
        TEST_ASSERT_TRUE(f.est.accelerations_doubted);
        TEST_ASSERT_FALSE(est_law_has_acceleration(&f.est));
    }
    setUp();
    f.est.airborne = false;
    f.evidence.doubts = DOUBT_IMU;
    f.evidence.height_m = 0.45F;
    change_doubts();
    NEAR(0.5F, f.est.estimator.now.height_m);
    TEST_ASSERT_FALSE(f.est.airborne);
}

void test_a_doubt_of_the_thrust_or_an_unsure_pilot_leaves_the_law_without_authority(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        f.evidence.doubts = (i == 1) ? DOUBT_THRUST : 0U;
        unknown(i == 2);
        change_doubts();
        TEST_ASSERT_EQUAL(i != 0, f.est.without_authority);
    }
    setUp();
    f.handover.doubts = DOUBT_THRUST; /* it has gone */
    f.where.hover.thrust_n = 7.3F;
    change_doubts();
    NEAR(7.3F, f.est.hover.thrust_n);
    sway(true);
    TEST_ASSERT_FALSE(f.est.rocks);
    change_doubts();
    TEST_ASSERT_TRUE(f.est.rocks);
}

void test_on_the_ground_the_law_is_reset_and_with_a_pilot_disengaged(void)
{
    f.where.supervisor.state = FLIGHT_GROUND;
    update_estimator();
    TEST_ASSERT_TRUE(f.where.contact.lifting);
    TEST_ASSERT_FALSE(f.est.airborne);
    setUp();
    f.where.supervisor.state = FLIGHT_FLOATING;
    f.where.contact.lifting = true;
    update_estimator();
    TEST_ASSERT_FALSE(f.where.contact.lifting); /* it has risen */
    TEST_ASSERT_TRUE(f.est.airborne);
    in.has_throttle = false;
    update_estimator();
    TEST_ASSERT_FALSE(f.est.airborne);
    f.where.supervisor.state = FLIGHT_FLYING;
    f.est.airborne = true;
    update_estimator();
    TEST_ASSERT_TRUE(f.est.airborne);
}

void test_other_laws_engage_the_estimate_when_they_fly(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        f.mode = (i == 1) ? FLIGHT_MODE_EST_HOLD : FLIGHT_MODE_LAW;
        f.est.airborne = i == 2;
        f.where.contact.lifting = i == 3;
        f.where.supervisor.height.height_mm = (i == 3) ? 50.0F : 500.0F;
        f.est.ground_m = 0.0F;
        f.thrust_n = 6.6F;
        f.est.cascade.thrust_n = 1.0F;
        update_estimator();
        NEAR((i == 0) ? 6.6F : 1.0F, f.est.cascade.thrust_n);
        TEST_ASSERT_EQUAL(i == 0 || i == 2, f.est.airborne);
    }
}

void test_a_new_height_is_fused_and_on_the_ground_at_rest(void)
{
    for (int i = 0; i < 4; i++) {
        setUp();
        f.where.supervisor.state = (i == 1) ? FLIGHT_FLYING : FLIGHT_GROUND;
        f.where.supervisor.rest.on = i != 2;
        f.where.supervisor.height.is_new = i != 3;
        f.est.estimator.filter.estimate.speed_mps = 0.2F;
        in.altitude = (altitude_t){.valid = true, .slant_mm = 500.0F};
        in.height_stamp_ms = 4000U;
        in.height_time_us = 2000000U;
        in.height_age_us = 60000U;
        f.est.estimator.delayed_us = 1940000U;
        update_estimator();
        TEST_ASSERT_EQUAL_UINT32((i != 3) ? 1940000U : 0U, f.est.rays_us);
        TEST_ASSERT_EQUAL(i == 0, f.est.estimator.filter.estimate.speed_mps < 0.05F);
    }
}

void test_a_descent_from_a_pilots_hands_starts_from_the_felt_speed(void)
{
    for (int i = 0; i < 3; i++) {
        setUp();
        f.where.supervisor.state = (i == 1) ? FLIGHT_LANDING : FLIGHT_DESCENDING;
        f.evidence.felt_mps = 0.3F;
        f.evidence.bias_mps2 = 0.15F;
        change_mode((i == 2) ? FLIGHT_MODE_LAW : FLIGHT_MODE_IDLE, FLIGHT_MODE_EST_SINK);
        NEAR((i == 0) ? 0.3F : 0.0F, f.est.estimator.now.speed_mps);
        NEAR((i == 0) ? 0.15F : 0.0F, f.est.estimator.now.bias_mps2);
        NEAR((i == 0) ? 0.0F : 0.5F, f.est.estimator.now.height_m);
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
        f.est.airborne = rows[i].airborne;
        f.est.frameless_s = rows[i].frames ? 0.0F : 1.0F;
        f.est.estimator.felt = rows[i].felt;
        f.evidence.doubts = rows[i].doubted ? DOUBT_SIGHT : 0U;
        f.evidence.height_m = 0.7F;
        f.evidence.bias_mps2 = 0.25F;
        f.evidence.pushed_mps = 0.24F;
        f.evidence.moved_m = 0.05F;
        update_estimator();
        TEST_ASSERT_EQUAL(rows[i].starts, f.est.estimator.initialised);
        if (rows[i].starts) {
            NEAR(rows[i].doubted ? 0.5F : 0.75F, f.est.estimator.now.height_m);
            NEAR(0.24F, f.est.estimator.now.speed_mps);
            NEAR(rows[i].felt ? 0.25F : 0.0F, f.est.estimator.now.bias_mps2);
        }
    }
}

void test_a_hover_thrust_learned_in_this_flight_survives_a_law_without_the_estimate(void)
{
    static const struct {
        flight_mode_t before;
        bool airborne, knows;
    } rows[] = {
        {FLIGHT_MODE_LAW, true, true}, {FLIGHT_MODE_LAW, false, false}, {FLIGHT_MODE_FLOAT, true, false}};
    for (int i = 0; i < 3; i++) {
        setUp();
        f.est.airborne = rows[i].airborne;
        f.est.hover.thrust_n = 7.6F;
        f.est.hover.variance_n2 = 0.02F;
        f.where.hover.thrust_n = 7.2F;
        change_mode(rows[i].before, FLIGHT_MODE_EST_HOLD);
        NEAR(rows[i].knows ? 7.6F : 7.2F, f.est.hover.thrust_n);
        NEAR(rows[i].knows ? 0.02F : 0.25F, f.est.hover.variance_n2);
        TEST_ASSERT_TRUE(f.est.airborne);
    }
}
