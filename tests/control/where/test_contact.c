#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

/* Whether a vehicle that lifts is still taken to stand on the ground. */
static bool lifting_still(void)
{
    const situation_t now = situation();
    const contact_signs_t signs = signs_of_contact(&now);
    contact_t contact = f.where.contact;

    contact.lifting = true;
    contact_step(&contact, &signs);
    return contact.lifting;
}

void test_it_has_risen_and_may_stand_by_heights_above_the_ground(void)
{
    f.est.ground_m = 0.1F;
    f.where.supervisor.height.height_mm = 181.0F;
    TEST_ASSERT_TRUE(situation().risen);
    f.where.supervisor.height.height_mm = 179.0F;
    TEST_ASSERT_FALSE(situation().risen);
    TEST_ASSERT_FALSE(lifting_still()); /* flying */
    f.where.contact.lifting = true;
    TEST_ASSERT_FALSE(lifting_still()); /* and airborne */
    f.est.airborne = false;
    TEST_ASSERT_TRUE(lifting_still());
    f.where.supervisor.state = FLIGHT_FLOATING;
    TEST_ASSERT_TRUE(lifting_still());
    sway(true);
    TEST_ASSERT_FALSE(lifting_still());
    sway(false);
    f.where.supervisor.height.height_mm = 181.0F;
    TEST_ASSERT_FALSE(lifting_still());
}

void test_a_second_of_a_landing_without_thrust_is_counted(void)
{
    f.where.supervisor.state = FLIGHT_LANDING;
    f.idle_n = f.thrust_n = 0.8F;
    (void)landing_n(8.0F);
    (void)landing_n(8.0F);
    NEAR(0.2F, f.where.contact.unpowered_s);
    f.thrust_n = 0.81F;
    (void)landing_n(8.0F);
    NEAR(0.0F, f.where.contact.unpowered_s);
}

void test_a_landing_ends_after_more_than_a_second_without_thrust(void)
{
    static const float unpowered_s[] = {0.99F, 1.01F, 1.01F};
    for (int i = 0; i < 3; i++) {
        setUp();
        f.where.supervisor.state = FLIGHT_LANDING;
        f.where.contact.unpowered_s = unpowered_s[i];
        f.where.contact.touching_s = (i == 2) ? 0.0F : 4.0F;
        f.thrust_n = f.idle_n = 0.8F;
        const situation_t now = situation();
        TEST_ASSERT_EQUAL(i == 1, signs_of_vertical(&now, false).stands);
    }
}

void test_a_take_off_that_ends_on_the_ground_stops_there(void)
{
    f.where.supervisor.state = FLIGHT_TAKEOFF;
    f.est.airborne = false;
    f.where.supervisor.state_us = 2999999U;
    TEST_ASSERT_FALSE(stops_on_ground());
    TEST_ASSERT_TRUE(f.where.contact.gave_up);
    static const flight_state_t states[] = {FLIGHT_COASTING, FLIGHT_DESCENDING, FLIGHT_LANDING, FLIGHT_FLYING,
                                            FLIGHT_GROUND};
    for (int i = 0; i < 5; i++) {
        f.where.contact.gave_up = true;
        f.where.supervisor.state = states[i];
        TEST_ASSERT_EQUAL(i < 3, stops_on_ground());
        TEST_ASSERT_EQUAL(i < 3, f.where.contact.gave_up);
    }
    f.where.supervisor.state = FLIGHT_TAKEOFF;
    f.where.supervisor.state_us = 3000000U;
    f.where.contact.gave_up = true;
    (void)stops_on_ground();
    TEST_ASSERT_FALSE(f.where.contact.gave_up);
    f.where.supervisor.state_us = 0U;
    f.est.airborne = true;
    (void)stops_on_ground();
    TEST_ASSERT_FALSE(f.where.contact.gave_up);
    f.where.supervisor.state = FLIGHT_LANDING;
    TEST_ASSERT_FALSE(stops_on_ground());
}
