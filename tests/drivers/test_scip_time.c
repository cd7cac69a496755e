#include "unity.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "drivers/scip_time.h"

#define STAMPS 0x1000000UL

static scip_time_t clock_;

void setUp(void)
{
    scip_time_init(&clock_);
}

void tearDown(void)
{
}

/* A sensor whose clock showed 0 at host time zero_us and needs 1000 + per_mille / 1000 host microseconds for its ms. */
static uint32_t zero_us;
static int32_t skew_ppm;

static uint32_t true_us(uint32_t ms)
{
    return zero_us + ms * 1000U + (uint32_t)((int32_t)(ms / 1000U) * skew_ppm + (int32_t)(ms % 1000U) * skew_ppm / 1000);
}

/* An exchange whose reply came so much later than the command took. */
static void sample(uint32_t ms, uint32_t there_us, uint32_t back_us)
{
    scip_time_sample(&clock_, true_us(ms) - there_us, true_us(ms) + back_us, ms % STAMPS);
}

static void settle_at(uint32_t ms)
{
    for (uint32_t i = 0; i < SCIP_TIME_SAMPLES; i++) {
        sample(ms + 3 * i, 500, 500);
    }
    TEST_ASSERT_TRUE(scip_time_settle(&clock_));
}

static void assert_knows(uint32_t ms, uint32_t within_us)
{
    const uint32_t host_us = scip_time_host_us(&clock_, ms % STAMPS);
    const uint32_t error_us = host_us - true_us(ms) + within_us;
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(2 * within_us, error_us);
}

void test_one_exchange_sets_the_clock_to_its_middle(void)
{
    scip_time_sample(&clock_, 7000, 8000, 1234);
    TEST_ASSERT_FALSE(clock_.known);
    TEST_ASSERT_TRUE(scip_time_settle(&clock_));
    TEST_ASSERT_TRUE(clock_.known);
    TEST_ASSERT_EQUAL_UINT32(7500, scip_time_host_us(&clock_, 1234));
    TEST_ASSERT_EQUAL_UINT32(8500, scip_time_host_us(&clock_, 1235));
    TEST_ASSERT_EQUAL_UINT32(6500, scip_time_host_us(&clock_, 1233));
}

void test_nothing_is_settled_without_exchanges(void)
{
    TEST_ASSERT_FALSE(scip_time_settle(&clock_));
    TEST_ASSERT_FALSE(clock_.known);
    settle_at(1000);
    const uint32_t before_us = clock_.host_us;
    TEST_ASSERT_FALSE(scip_time_settle(&clock_));
    TEST_ASSERT_EQUAL_UINT32(before_us, clock_.host_us);
}

/* Four of ten replies late by up to a third of a second: the median does not move. */
void test_late_replies_do_not_move_the_median(void)
{
    static const uint32_t back_us[] = { 500, 90500, 500, 500, 381000, 500, 500, 20500, 500, 300500 };
    zero_us = 123456789;
    skew_ppm = 0;
    for (uint32_t i = 0; i < 10; i++) {
        sample(5000 + 100 * i, 500, back_us[i]);
    }
    TEST_ASSERT_TRUE(scip_time_settle(&clock_));
    assert_knows(5000, 0);
    assert_knows(60000, 0);
}

void test_early_and_late_ones_are_put_in_order(void)
{
    static const uint32_t there_us[] = { 500, 9500, 2500, 7500, 4500 }; /* middles early by 0 4500 1000 3500 2000 */
    zero_us = 1000000;
    skew_ppm = 0;
    for (uint32_t i = 0; i < 5; i++) {
        sample(100 * i, there_us[i], 500);
    }
    TEST_ASSERT_TRUE(scip_time_settle(&clock_));
    TEST_ASSERT_EQUAL_UINT32(1000000 - 2000, scip_time_host_us(&clock_, 0));
}

void test_an_eleventh_exchange_is_left_out(void)
{
    zero_us = 0;
    skew_ppm = 0;
    for (uint32_t i = 0; i < SCIP_TIME_SAMPLES; i++) {
        sample(i, 500, 500);
    }
    for (uint32_t i = 0; i < 100; i++) {
        sample(20 + i, 500, 90000);
    }
    TEST_ASSERT_EQUAL_UINT16(SCIP_TIME_SAMPLES, clock_.samples);
    TEST_ASSERT_TRUE(scip_time_settle(&clock_));
    assert_knows(0, 0);
    TEST_ASSERT_EQUAL_UINT16(0, clock_.samples);
}

void test_both_clocks_may_wrap_at_any_moment(void)
{
    skew_ppm = 0;
    for (uint32_t back_ms = 0; back_ms < 120; back_ms++) {
        scip_time_init(&clock_);
        zero_us = (uint32_t)-(STAMPS - 60) * 1000U;  /* the host wraps 60 ms before the sensor does */
        settle_at(STAMPS - back_ms);
        assert_knows(STAMPS - back_ms, 0);
        assert_knows(STAMPS - back_ms + 200, 0);
        assert_knows(STAMPS + 1500000, 0);
        assert_knows(STAMPS - 1500000, 0);
    }
}

/* 2820 ppm is what one published driver corrects for. */
void test_a_second_settling_measures_the_skew(void)
{
    static const int32_t skews_ppm[] = { 2820, -2820, 1, 0, 9900, -9900 };
    zero_us = 4000000000UL;
    for (uint32_t i = 0; i < 6; i++) {
        scip_time_init(&clock_);
        skew_ppm = skews_ppm[i];
        settle_at(1000);
        TEST_ASSERT_EQUAL_INT32(0, clock_.skew_ppm);
        settle_at(301000);
        TEST_ASSERT_INT32_WITHIN(1, skews_ppm[i], clock_.skew_ppm);
        assert_knows(301000, 1);
        assert_knows(601000, 700); /* one ppm of 300 s, and rounding */
        assert_knows(601999, 700);
        assert_knows(299500, 2);
    }
}

void test_skew_is_measured_from_half_a_minute_to_half_an_hour_apart(void)
{
    static const struct {
        uint32_t apart_ms;
        bool measured;
    } rows[] = { { 29999, false }, { 30000, true }, { 1800000, true }, { 1800001, false } };
    zero_us = 77;
    skew_ppm = 1000;
    for (uint32_t i = 0; i < 4; i++) {
        scip_time_init(&clock_);
        settle_at(5);
        settle_at(5 + rows[i].apart_ms);
        TEST_ASSERT_INT32_WITHIN(1, rows[i].measured ? 1000 : 0, clock_.skew_ppm);
        assert_knows(5 + rows[i].apart_ms, rows[i].measured ? 1 : 16);
    }
}

/* A sensor that restarted counts from 0 again: the new pair holds, the skew stays. */
void test_a_restarted_clock_gives_no_skew(void)
{
    zero_us = 0;
    skew_ppm = 1500;
    settle_at(100000);
    settle_at(200000);
    TEST_ASSERT_INT32_WITHIN(1, 1500, clock_.skew_ppm);
    const int32_t before_ppm = clock_.skew_ppm;
    scip_time_sample(&clock_, 299999000, 300001000, 250000); /* 1.5 s off in 50 s: 30000 ppm */
    TEST_ASSERT_TRUE(scip_time_settle(&clock_));
    TEST_ASSERT_EQUAL_INT32(before_ppm, clock_.skew_ppm);
    TEST_ASSERT_EQUAL_UINT32(300000000, scip_time_host_us(&clock_, 250000));
    scip_time_sample(&clock_, 100000000, 100000000, 310000); /* the other way */
    TEST_ASSERT_TRUE(scip_time_settle(&clock_));
    TEST_ASSERT_EQUAL_INT32(before_ppm, clock_.skew_ppm);
    scip_time_sample(&clock_, 500000000, 500000000, 100); /* and back in time */
    TEST_ASSERT_TRUE(scip_time_settle(&clock_));
    TEST_ASSERT_EQUAL_INT32(before_ppm, clock_.skew_ppm);
}

/* 600 revolutions a minute and 1024 steps: 97.65625 us a step. */
void test_rays_are_sampled_step_after_step(void)
{
    static const scip_limits_t utm = { 23, 30000, 1440, 0, 1080, 540, 2400 };
    static const scip_limits_t slow = { 20, 5600, 4095, 0, 4095, 0, 1 };
    TEST_ASSERT_EQUAL_UINT32(0, scip_time_step_us(&scip_limits_urg04lx, 0));
    TEST_ASSERT_EQUAL_UINT32(97, scip_time_step_us(&scip_limits_urg04lx, 1));
    TEST_ASSERT_EQUAL_UINT32(3125, scip_time_step_us(&scip_limits_urg04lx, 32));
    TEST_ASSERT_EQUAL_UINT32(37500, scip_time_step_us(&scip_limits_urg04lx, 384));
    TEST_ASSERT_EQUAL_UINT32(70800, scip_time_step_us(&scip_limits_urg04lx, 725));
    TEST_ASSERT_EQUAL_UINT32(100000, scip_time_step_us(&scip_limits_urg04lx, 1024));
    TEST_ASSERT_EQUAL_UINT32(18750, scip_time_step_us(&utm, 1080));
    TEST_ASSERT_EQUAL_UINT32(60000000, scip_time_step_us(&slow, 4095));
}
