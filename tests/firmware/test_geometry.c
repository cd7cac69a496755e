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
    geometry_t geometry;

    parameters_init(&parameters);
    (void)parameters_set(&parameters, PARAMETER_L, 325.0F);
    geometry_mount(&parameters);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.hwi.disabled);
    geometry_mounted(&geometry);
    TEST_ASSERT_EQUAL_UINT16(1, kernel.hwi.disabled);
    TEST_ASSERT_EQUAL_FLOAT(325.0F, geometry.places.mirror[MIRROR_FRONT].arm_mm);
    TEST_ASSERT_EQUAL_FLOAT(105.0F, geometry.places.mirror[MIRROR_FRONT].distance_mm);
    TEST_ASSERT_EQUAL_FLOAT(220.0F, geometry.places.mirror[MIRROR_FORE].arm_mm);
    TEST_ASSERT_EQUAL_FLOAT(98.0F, geometry.places.mirror[MIRROR_AFT].leg_mm);
}

static void assert_group(const geometry_t *geometry, uint16_t number, mirror_t mirror, uint16_t first,
                         uint16_t last)
{
    TEST_ASSERT_EQUAL(mirror, geometry->windows.mirror[number]);
    TEST_ASSERT_EQUAL_UINT16(first, geometry->layout.groups[number].first_step);
    TEST_ASSERT_EQUAL_UINT16(last, geometry->layout.groups[number].last_step);
}

static geometry_t with(control_layout_t layout, float front, float aft, float fore, float reach)
{
    parameters_t parameters;
    geometry_t geometry;

    parameters_init(&parameters);
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, PARAMETER_LAYOUT, (float)layout));
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, PARAMETER_SF, front));
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, PARAMETER_S1, aft));
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, PARAMETER_S2, fore));
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, PARAMETER_SW, reach));
    geometry_mount(&parameters);
    geometry_mounted(&geometry);
    return geometry;
}

void test_each_layout_has_its_mirrors_in_the_order_of_their_steps(void)
{
    geometry_t geometry = with(LAYOUT_FRONT, 389.0F, 128.0F, 640.0F, 17.0F);
    TEST_ASSERT_EQUAL_UINT16(1, geometry.layout.group_count);
    assert_group(&geometry, 0U, MIRROR_FRONT, 372, 406);
    geometry = with(LAYOUT_TWO, 389.0F, 263.0F, 505.0F, 14.0F); /* the bracket of two beams */
    TEST_ASSERT_EQUAL_UINT16(2, geometry.layout.group_count);
    assert_group(&geometry, 0U, MIRROR_AFT, 249, 277);
    assert_group(&geometry, 1U, MIRROR_FORE, 491, 519);
    geometry = with(LAYOUT_THREE, 389.0F, 128.0F, 640.0F, 17.0F);
    TEST_ASSERT_EQUAL_UINT16(3, geometry.layout.group_count);
    assert_group(&geometry, 0U, MIRROR_AFT, 111, 145);
    assert_group(&geometry, 1U, MIRROR_FRONT, 372, 406);
    assert_group(&geometry, 2U, MIRROR_FORE, 623, 657);
}

void test_a_middle_between_two_steps_is_the_nearer_one(void)
{
    geometry_t geometry = with(LAYOUT_FRONT, 389.4F, 128.0F, 640.0F, 16.6F);
    assert_group(&geometry, 0U, MIRROR_FRONT, 372, 406);
}

/* At every end of the limits: what the sensor measures, no window in another, and room for the points. */
void test_no_values_within_their_limits_make_a_layout_that_cannot_be_asked_for(void)
{
    static const parameter_id_t ids[] = {PARAMETER_SF, PARAMETER_S1, PARAMETER_S2, PARAMETER_SW};

    for (unsigned corner = 0U; corner < 16U; corner++) {
        float value[4];

        for (unsigned i = 0U; i < 4U; i++) {
            const parameter_row_t *row = &parameter_table[ids[i]];
            value[i] = (corner >> i & 1U) != 0U ? row->maximum : row->minimum;
        }
        for (uint16_t layout = 0U; layout < LAYOUT_COUNT; layout++) {
            const geometry_t geometry = with((control_layout_t)layout, value[0], value[1], value[2],
                                             value[3]);
            const scip_layout_t *l = &geometry.layout;
            const scip_range_t range = scip_layout_range(l, 250000U);

            TEST_ASSERT_GREATER_OR_EQUAL_UINT16(SCIP_STEP_FIRST, l->groups[0].first_step);
            TEST_ASSERT_LESS_OR_EQUAL_UINT16(SCIP_STEP_LAST, l->groups[l->group_count - 1U].last_step);
            for (uint16_t g = 1U; g < l->group_count; g++) {
                TEST_ASSERT_GREATER_THAN_UINT16(l->groups[g - 1U].last_step, l->groups[g].first_step);
            }
            TEST_ASSERT_LESS_OR_EQUAL_UINT16(SCIP_LAYOUT_POINTS_MAX,
                                             (range.last_step - range.first_step + 1U) / range.cluster);
        }
    }
}
