#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

/* A wrong pin: what the output adds, from heights that sink by 0.1 m/s. */
void test_what_is_added_while_the_pin_says_pilot_depends_on_time_order_and_heights(void)
{
    static const struct {
        uint16_t flags;
        float piloted_s;
        bool land;
        uint32_t age_us;
        bool is_new;
        float added_n;
    } rows[] = {
        {0U, 3.0F, true, 0U, true, 0.0F},
        {FLIGHT_FLAG_PILOT, 1.0F, false, 0U, true, 0.0959F}, /* 0.03 m/s, for one height */
        {FLIGHT_FLAG_PILOT, 1.0F, true, 0U, true, -0.8359F}, /* the whole rate at once, 0.275 at 0.5 m */
        {FLIGHT_FLAG_PILOT, 5.0F, false, 0U, true, -0.8359F},
        {FLIGHT_FLAG_PILOT, 5.0F, false, 0U, false, -0.2F}, /* as before */
        {FLIGHT_FLAG_PILOT, 1.0F, false, 2000000U, false, 0.0F},
        {FLIGHT_FLAG_PILOT, 1.0F, true, 2000000U, false, -0.527F}, /* 7.3 % and the fade of 2 s */
        {FLIGHT_FLAG_PILOT, 9.0F, false, 60000000U, false, -2.0F},
    };
    for (int i = 0; i < 8; i++) {
        setUp();
        f.where.supervisor.state = FLIGHT_FLOATING;
        f.where.supervisor.flags = rows[i].flags;
        f.where.supervisor.land = rows[i].land;
        f.where.supervisor.height = (height_track_t){.height_mm = 500.0F,
                                                     .rate_mm_s = -100.0F,
                                                     .gap_us = 100000U,
                                                     .age_us = rows[i].age_us,
                                                     .is_new = rows[i].is_new};
        f.pin.descent.sink_mm_s = 300.0F;
        f.pin.piloted_s = rows[i].piloted_s;
        f.pin.more_n = -0.2F;
        step_stuck_pin();
        TEST_ASSERT_FLOAT_WITHIN(0.005F, rows[i].added_n, f.pin.more_n);
        NEAR((rows[i].flags != 0U) ? rows[i].piloted_s + 0.1F : 0.0F, f.pin.piloted_s);
        NEAR(7.0F, f.where.hover.thrust_n);
    }
}

void test_what_is_added_is_limited_and_ends_with_the_pilots_turn(void)
{
    static const struct {
        float rate_mm_s, near_ground_s, idle_n, added_n;
    } rows[] = {{-800.0F, 0.0F, 0.0F, 1.0F},
                {1500.0F, 0.0F, 0.0F, -2.0F},
                {0.0F, 4.0F, 0.0F, -7.0F}, /* lies on the ground */
                {0.0F, 4.0F, 0.6F, -6.4F}};
    for (int i = 0; i < 4; i++) {
        setUp();
        f.where.supervisor.flags = FLIGHT_FLAG_PILOT;
        f.where.supervisor.height = (height_track_t){
            .height_mm = 30.0F, .rate_mm_s = rows[i].rate_mm_s, .gap_us = 100000U, .is_new = true};
        f.where.supervisor.height.height_mm = (rows[i].near_ground_s > 0.0F) ? 30.0F : 500.0F;
        f.pin.descent.near_ground_s = rows[i].near_ground_s;
        f.idle_n = rows[i].idle_n;
        f.pin.piloted_s = 6.0F;
        step_stuck_pin();
        NEAR(rows[i].added_n, f.pin.more_n);
        write_outputs();
        NEAR(7.0F + rows[i].added_n, out.thrust_n);
        NEAR(thrust_to_pulse_us(7.0F + rows[i].added_n), out.pulse_us);
        change_mode(FLIGHT_MODE_HOVER, FLIGHT_MODE_EST_HOLD);
        NEAR(0.0F, f.pin.more_n + f.pin.piloted_s);
    }
}

void test_the_cycles_follow_the_frames_while_a_pilot_flies(void)
{
    set(PARAMETER_LAW, LAW_PID);
    f.mode = FLIGHT_MODE_HOVER;
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_PERIOD, flight_releases(&f, &parameters));
    f.pin.piloted_s = 0.1F; /* the pin is read in each of them */
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_RELEASE_HEIGHT | FLIGHT_RELEASE_FRAME, flight_releases(&f, &parameters));
}
