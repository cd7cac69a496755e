#include <setjmp.h>
#include <stdbool.h>
#include <string.h>

#include "firmware/fault.h"
#include "bsp/led.h"
#include "bsp/throttle.h"
#include "unity.h"

#include <ti/sysbios/family/c28/Hwi.h>

#define ROUNDS 3U

/* What the code under test called, one letter each: o interrupts off, I idle pulse, R and r red on and off, B
 * and b blue. */
static char calls[64];
static uint16_t idles;
static jmp_buf left;

static void called(char what)
{
    const size_t n = strlen(calls);

    TEST_ASSERT_LESS_THAN_UINT16(sizeof calls - 1U, (uint16_t)n);
    calls[n] = what;
}

UInt Hwi_disable(Void)
{
    called('o');
    return 0;
}

/* The only way out of the loop. */
void bsp_throttle_idle(void)
{
    if (idles == ROUNDS) {
        longjmp(left, 1);
    }
    idles++;
    called('I');
}

void bsp_led_red(bool on)
{
    called(on ? 'R' : 'r');
}

void bsp_led_blue(bool on)
{
    called(on ? 'B' : 'b');
}

void setUp(void)
{
    memset(calls, 0, sizeof calls);
    idles = 0U;
}

void tearDown(void) {}

#define ASSERT_STAYS_SAFE(call) \
    do { \
        if (setjmp(left) == 0) { \
            call; \
            TEST_FAIL_MESSAGE("it returned"); \
        } \
        TEST_ASSERT_EQUAL_STRING("oIRbIRbIRb", calls); \
    } while (0)

void test_an_error_of_the_kernel_turns_interrupts_off_then_idles_the_throttle_for_ever(void)
{
    Error_Block error = {0};

    ASSERT_STAYS_SAFE(fault_error(&error));
}

void test_the_error_hook_does_not_look_at_the_error(void)
{
    ASSERT_STAYS_SAFE(fault_error(NULL));
}

void test_a_system_abort_never_returns(void)
{
    ASSERT_STAYS_SAFE(fault_abort());
}

void test_a_system_exit_never_returns_whatever_its_status(void)
{
    ASSERT_STAYS_SAFE(fault_exit(0));
    setUp();
    ASSERT_STAYS_SAFE(fault_exit(-1));
}

void test_a_failed_assert_of_driverlib_never_returns(void)
{
    ASSERT_STAYS_SAFE(__error__("sci.c", 70000UL));
}

void test_the_hooks_have_the_types_that_the_kernel_calls_them_by(void)
{
    Void (*const raise_hook)(Error_Block *) = fault_error;
    Void (*const abort_function)(Void) = fault_abort;
    Void (*const exit_function)(Int) = fault_exit;

    TEST_ASSERT_TRUE(raise_hook != NULL && abort_function != NULL && exit_function != NULL);
}
