#include "control/angle.h"
#include "unity.h"

#pragma GCC diagnostic ignored "-Wmissing-prototypes" /* the generated runner declares the tests */

#define PI 3.14159265F
#define NEAR(expected, actual) TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, expected, actual)

void setUp(void) {}
void tearDown(void) {}

void test_a_turn_goes_the_short_way_and_keeps_its_sign(void)
{
    NEAR(0.2F, turn_rad(3.04159F, -3.04159F));
    NEAR(-0.2F, turn_rad(-3.04159F, 3.04159F));
    NEAR(3.0F, turn_rad(-1.5F, 1.5F));
    NEAR(-3.0F, turn_rad(1.5F, -1.5F));
    NEAR(2.0F * PI - 3.2F, turn_rad(1.6F, -1.6F));
    NEAR(0.0F, turn_rad(-PI, PI));
}

void test_an_arc_is_a_turn_without_its_sign(void)
{
    for (float from_rad = -3.0F; from_rad < 3.1F; from_rad += 0.5F) {
        for (float by_rad = -3.0F; by_rad < 3.1F; by_rad += 0.25F) {
            const float far_rad = from_rad + by_rad;
            const float to_rad = (far_rad > PI)    ? far_rad - 2.0F * PI
                                 : (far_rad < -PI) ? far_rad + 2.0F * PI
                                                   : far_rad;

            NEAR(by_rad, turn_rad(from_rad, to_rad));
            NEAR((by_rad < 0.0F) ? -by_rad : by_rad, arc_rad(from_rad, to_rad));
        }
    }
}
