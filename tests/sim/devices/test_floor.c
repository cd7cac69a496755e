#include "sim/devices/floor.h"

#include <math.h>

#include "unity.h"

#define STEP_S 0.0005
#define NEAR(tolerance, expected, actual) TEST_ASSERT_DOUBLE_WITHIN(tolerance, expected, actual)

static floor_config_t config;
static floor_t under;

void setUp(void)
{
    config = (floor_config_t)FLOOR_DEFAULT;
}

void tearDown(void) {}

static void start(void)
{
    floor_init(&under, &config, STEP_S, 1);
}

static void pass(double seconds)
{
    for (long n = lround(seconds / STEP_S); n > 0; n--) {
        floor_pass(&under);
    }
}

void test_unless_told_the_floor_is_even(void)
{
    start();
    for (int i = 0; i < 100; i++) {
        pass(0.05);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, floor_height_m(&under));
        TEST_ASSERT_EQUAL_DOUBLE(0.0, under.rate_mps);
    }
}

TEST_CASE(0.03, 0.5)
TEST_CASE(0.1, 2.0)
void test_an_uneven_floor_has_its_deviation_correlation_time_and_slope(double rms_m, double tau_s)
{
    double squares = 0.0, lagged = 0.0, slopes = 0.0, before_m = 0.0;
    const int n = (int)(5000.0 / tau_s * 0.5);

    config.rms_m = rms_m;
    config.tau_s = tau_s;
    start();
    pass(10.0 * tau_s);
    for (int i = 0; i < n; i++) {
        before_m = floor_height_m(&under);
        pass(tau_s);
        squares += before_m * before_m;
        lagged += before_m * floor_height_m(&under);
        slopes += under.rate_mps * under.rate_mps;
    }
    NEAR(0.06 * rms_m, rms_m, sqrt(squares / n));
    /* (1 + w t) exp(-w t) with w t = 2 */
    NEAR(0.06, 3.0 * exp(-2.0), lagged / squares);
    NEAR(0.06 * 2.0 * rms_m / tau_s, 2.0 * rms_m / tau_s, sqrt(slopes / n));
}

void test_bars_come_in_their_period_and_share(void)
{
    int raised = 0, edges = 0;
    double before_m = 0.0;

    config.bars_m = 0.06;
    config.bars_period_s = 0.4;
    config.bars_share = 0.25;
    start();
    for (int i = 0; i < 8000; i++) { /* 4 s */
        pass(STEP_S);
        const double height_m = floor_height_m(&under);

        TEST_ASSERT_TRUE(height_m == 0.0 || height_m == 0.06);
        raised += height_m > 0.0;
        edges += height_m > before_m;
        before_m = height_m;
    }
    NEAR(20.0, 2000.0, raised);
    TEST_ASSERT_EQUAL_INT(10, edges);
}

void test_bars_lie_on_the_uneven_floor(void)
{
    double sum = 0.0;

    config.rms_m = 0.005;
    config.bars_m = 1.0;
    config.bars_share = 0.5;
    start();
    for (int i = 0; i < 8000; i++) {
        pass(STEP_S);
        sum += floor_height_m(&under) > 0.5;
        TEST_ASSERT_TRUE(fabs(floor_height_m(&under)) < 0.05 || fabs(floor_height_m(&under) - 1.0) < 0.05);
    }
    NEAR(20.0, 4000.0, sum);
}
