#include "flight_case.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

void test_it_begins_with_nothing_known(void)
{
    supervisor_t supervisor;
    supervisor_init(&supervisor);
    memset(&f, 0x55, sizeof f);
    flight_init(&f);
    TEST_ASSERT_EQUAL(supervisor.state, f.where.supervisor.state);
    TEST_ASSERT_EQUAL(supervisor.kept_state, f.where.supervisor.kept_state);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, f.sense.senses.accelerometer.shaken);
    TEST_ASSERT_EQUAL(IMU_SOUND, f.axes.fault);
    TEST_ASSERT_EQUAL_FLOAT(0.4F, f.est.estimator.credit.noise_mps2);
    TEST_ASSERT_EQUAL(FLIGHT_MODE_IDLE, f.mode);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, f.where.hover.thrust_n + f.thrust_n + f.laws.transfer_n +
                                      f.where.hover.learned_s);
}

/* The guard comes last: what is added against a wrong pin passes it too. */
void test_whatever_is_added_against_a_wrong_pin_the_output_is_between_idle_and_full_thrust(void)
{
    const float added_n[] = {100.0F, -100.0F, NAN, INFINITY, -INFINITY};

    for (size_t i = 0U; i < sizeof added_n / sizeof added_n[0]; ++i) {
        begin();
        f.pin.more_n = added_n[i];
        flight_step(&f, &parameters, &in, &out);
        TEST_ASSERT_TRUE(out.thrust_n >= f.idle_n);
        TEST_ASSERT_TRUE(out.thrust_n <= THRUST_MAX_N);
    }
}

void test_the_outputs_tell_thrust_height_and_flags(void)
{
    f.thrust_n = 6.5F;
    f.idle_n = 1.7F;
    f.where.supervisor.flags = FLIGHT_FLAG_HEIGHT;
    f.est.estimator.innovation_m = 0.012F;
    f.est.estimator.now.height_m = 0.52F;
    f.axes.fault = IMU_ROLL;
    write_outputs();
    NEAR(6.5F, out.thrust_n);
    NEAR(1.7F, out.idle_n);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, thrust_to_pulse_us(6.5F), out.pulse_us);
    TEST_ASSERT_EQUAL(FLIGHT_FLYING, out.state);
    TEST_ASSERT_EQUAL_UINT16(FLIGHT_FLAG_HEIGHT, out.flags);
    TEST_ASSERT_EQUAL(IMU_ROLL, out.imu_fault);
    NEAR(0.6F, out.reference_m);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 520.0F, out.estimate_mm);
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 12.0F, out.innovation_mm);
    TEST_ASSERT_EQUAL_UINT16(0U, out.doubts);
    f.mode = FLIGHT_MODE_LAW;
    write_outputs();
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 520.0F, out.estimate_mm);
    f.law = LAW_PID;
    write_outputs();
    TEST_ASSERT_EQUAL_FLOAT(500.0F, out.estimate_mm);
    TEST_ASSERT_TRUE(isnan(out.innovation_mm));
    f.where.supervisor.height.sequence = 0U;
    write_outputs();
    TEST_ASSERT_TRUE(isnan(out.estimate_mm));
    f.mode = FLIGHT_MODE_EST_LAND;
    write_outputs();
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 520.0F, out.estimate_mm);
}

void test_each_lack_has_its_flag(void)
{
    for (int i = 0; i < 6; i++) {
        setUp();
        f.est.frameless_s = (i == 1 || i == 5) ? 1.0F : 0.0F;
        f.est.estimator.felt = i != 2 && i != 5;
        f.aim.out_of_reach = i == 3;
        f.evidence.doubts = (uint16_t)((i == 4) ? (DOUBT_SIGHT | DOUBT_THRUST) : 0U);
        write_outputs();
        static const uint16_t flags[] = {0U,
                                         FLIGHT_FLAG_ATTITUDE,
                                         FLIGHT_FLAG_IMU,
                                         FLIGHT_FLAG_REACH,
                                         FLIGHT_FLAG_SIGHT * (DOUBT_SIGHT | DOUBT_THRUST),
                                         FLIGHT_FLAG_ATTITUDE};
        TEST_ASSERT_EQUAL_UINT16(flags[i], out.flags);
        TEST_ASSERT_EQUAL_UINT16(f.evidence.doubts, out.doubts);
    }
    setUp();
    set(PARAMETER_LAW, LAW_PID); /* it needs no IMU */
    f.est.frameless_s = 1.0F;
    write_outputs();
    TEST_ASSERT_EQUAL_UINT16(0U, out.flags);
    f.est.frameless_s = 0.0F;
    f.est.estimator.felt = false;
    write_outputs();
    TEST_ASSERT_EQUAL_UINT16(0U, out.flags);
}
