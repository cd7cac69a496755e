/* The stream of pulses: one line a cycle while it is on, nothing else. */
#include "firmware/pulse_stream.h"

#include <string.h>

#include "mock_xbee_port.h"
#include "unity.h"

static char sent[32];
static unsigned sends;

static void radio(const telemetry_line_t *line, int calls)
{
    (void)calls;
    (void)memcpy(sent, line->text, line->length);
    sent[line->length] = '\0';
    sends++;
}

void setUp(void)
{
    sends = 0;
    sent[0] = '\0';
    pulse_stream_set(false);
    xbee_port_stream_Stub(radio);
}

void tearDown(void) {}

void test_it_is_off_until_somebody_asks(void)
{
    pulse_stream_take(1999.68F);
    TEST_ASSERT_FALSE(pulse_stream_on());
    TEST_ASSERT_EQUAL_UINT(0, sends);
}

void test_every_cycle_is_one_short_line_with_tenths_of_a_microsecond(void)
{
    pulse_stream_set(true);
    TEST_ASSERT_TRUE(pulse_stream_on());
    pulse_stream_take(1999.68F);
    TEST_ASSERT_EQUAL_STRING("P19997\r\n", sent);
    pulse_stream_take(999.36F);
    TEST_ASSERT_EQUAL_STRING("P9994\r\n", sent);
    TEST_ASSERT_EQUAL_UINT(2, sends);
    pulse_stream_set(false);
    pulse_stream_take(1500.0F);
    TEST_ASSERT_EQUAL_UINT(2, sends);
}
