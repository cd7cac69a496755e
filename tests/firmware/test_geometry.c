/* What TaskReceiveComm tells TaskReceiveLaser of the mirrors. */
#include "firmware/geometry.h"

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

void test_the_geometry_is_that_of_the_parameters_copied_with_interrupts_off(void)
{
    parameters_t parameters;
    altitude_geometry_t geometry;

    parameters_init(&parameters);
    (void)parameters_set(&parameters, PARAMETER_L, 325.0F);
    geometry_mount(&parameters);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.hwi.disabled);
    geometry_mounted(&geometry);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.hwi.disabled);
    TEST_ASSERT_EQUAL_FLOAT(325.0F, geometry.mirror[MIRROR_FRONT].arm_mm);
    TEST_ASSERT_EQUAL_FLOAT(105.0F, geometry.mirror[MIRROR_FRONT].distance_mm);
    TEST_ASSERT_EQUAL_FLOAT(220.0F, geometry.mirror[MIRROR_FORE].arm_mm);
    TEST_ASSERT_EQUAL_FLOAT(98.0F, geometry.mirror[MIRROR_AFT].leg_mm);
}
