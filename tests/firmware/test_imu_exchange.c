/* What TaskIMU and TaskReceiveComm tell each other. */
#include "firmware/imu_exchange.h"

#include <string.h>

#include "kernel.h"
#include "unity.h"

void setUp(void)
{
    kernel_reset();
}

void tearDown(void)
{
    kernel_check();
}

void test_the_mapping_is_that_of_the_parameters_copied_with_interrupts_off(void)
{
    parameters_t parameters;
    imu_mapping_t mapping;

    parameters_init(&parameters);
    (void)parameters_set(&parameters, PARAMETER_IDOWN, (float)DOWN_MINUS_Z);
    imu_exchange_mount(&parameters);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.hwi.disabled);
    imu_exchange_mounted(&mapping);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.hwi.disabled);
    TEST_ASSERT_EQUAL_UINT16(AXIS_MINUS_ROLL, mapping.roll);
    TEST_ASSERT_EQUAL_UINT16(AXIS_PITCH, mapping.pitch);
    TEST_ASSERT_EQUAL_FLOAT(-256.0F, mapping.counts_per_g);
}

void test_the_latest_text_is_shown_and_of_the_good_frames_figures_number_and_period(void)
{
    const razor_text_t good = {.text = "#YPR=1,2,3", .length = 10U}, bad = {.text = "#YPR=nan", .length = 8U};
    const imu_raw_t raw = {.roll_rad = 0.5F}, other = {.roll_rad = 9.0F};
    imu_view_t view;

    imu_exchange_look(&view);
    const uint32_t before = view.frames;

    imu_exchange_show(&good, RAZOR_OK, &raw, 0xFFFFF000U);
    imu_exchange_show(&good, RAZOR_OK, &raw, 0xFFFFF000U + 25000U);
    imu_exchange_show(&bad, RAZOR_MALFORMED, &other, 60000U);
    imu_exchange_look(&view);
    TEST_ASSERT_EQUAL_UINT32(before + 2U, view.frames);
    TEST_ASSERT_EQUAL_UINT32(25000U, view.period_us);
    TEST_ASSERT_EQUAL(RAZOR_MALFORMED, view.status);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, view.raw.roll_rad);
    TEST_ASSERT_EQUAL_UINT16(8U, view.text.length);
    TEST_ASSERT_EQUAL_STRING_LEN("#YPR=nan", view.text.text, 8U);
}
