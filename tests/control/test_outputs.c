#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

static void tell(void)
{
    outputs_write(&now, false, 6.5F, &out);
}

void test_the_outputs_tell_thrust_height_and_flags(void)
{
    now.idle_n = 1.7F;
    hovers_at_n(7.2F);
    flagged(FLIGHT_FLAG_HEIGHT);
    innovation_is_m(0.012F);
    estimated(0.52F, 0.0F, 0.0F);
    tell();
    NEAR(6.5F, out.thrust_n);
    NEAR(1.7F, out.idle_n);
    NEAR(7.2F, out.hover_n);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, thrust_to_pulse_us(6.5F), out.pulse_us);
    TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_HEIGHT, out.flags);
    NEAR(0.6F, out.reference_m);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 520.0F, out.estimate_mm);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 12.0F, out.innovation_mm);
    mode_is(FLIGHT_MODE_LAW);
    tell();
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 520.0F, out.estimate_mm);
    now.law = LAW_PID;
    tell();
    TEST_ASSERT_EQUAL_FLOAT(500.0F, out.estimate_mm);
    TEST_ASSERT_TRUE(isnan(out.innovation_mm));
    no_height_has_come();
    tell();
    TEST_ASSERT_TRUE(isnan(out.estimate_mm));
    mode_is(FLIGHT_MODE_EST_LAND);
    tell();
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 520.0F, out.estimate_mm);
}

void test_each_lack_has_its_flag(void)
{
    for (int i = 0; i < 6; i++) {
        setUp();
        frame_was_s_ago((i == 1 || i == 5) ? 1.0F : 0.0F);
        accelerations_come(i != 2 && i != 5);
        evidence.doubts = (uint16_t)((i == 4) ? (DOUBT_SIGHT | DOUBT_THRUST) : 0U);
        outputs_write(&now, i == 3, 6.5F, &out);
        static const uint16_t flags[] = {0U,
                                         FLIGHT_FLAG_ATTITUDE,
                                         FLIGHT_FLAG_IMU,
                                         FLIGHT_FLAG_REACH,
                                         FLIGHT_FLAG_SIGHT * (DOUBT_SIGHT | DOUBT_THRUST),
                                         FLIGHT_FLAG_ATTITUDE};
        TEST_ASSERT_EQUAL_UINT16(flags[i], out.flags);
    }
    setUp();
    set(PARAMETER_LAW, LAW_PID); /* it needs no IMU */
    frame_was_s_ago(1.0F);
    tell();
    TEST_ASSERT_EQUAL_UINT16(0U, out.flags);
    frame_was_s_ago(0.0F);
    accelerations_come(false);
    tell();
    TEST_ASSERT_EQUAL_UINT16(0U, out.flags);
}
