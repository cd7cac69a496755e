/* Events: masks, what a wait consumes. */
#include "tests/sim/sysbios/kernel_helper.h"

#include <stdio.h>

#include "unity.h"

void setUp(void)
{
    kernel_helper_start();
}

static const struct {
    UInt posted, and_mask, or_mask;
    UInt matched, left;
} event_cases[] = {
    {0x0, 0x1, 0x0, 0x0, 0x0},
    {0x1, 0x1, 0x0, 0x1, 0x0},
    {0x1, 0x3, 0x0, 0x0, 0x1}, /* half of an and-mask is not consumed */
    {0x3, 0x3, 0x0, 0x3, 0x0},
    {0x7, 0x3, 0x0, 0x3, 0x4}, /* what was not asked for stays */
    {0x6, 0x0, 0x3, 0x2, 0x4},
    {0x7, 0x0, 0x3, 0x3, 0x4}, /* all of the or-mask that is there */
    {0x4, 0x3, 0x4, 0x4, 0x0},
    {0x5, 0x3, 0x4, 0x4, 0x1}, /* or matches, and does not: its half stays */
    {0x7, 0x3, 0x4, 0x7, 0x0},
    {0x8001, 0x8000, 0x1, 0x8001, 0x0}, /* sixteen events */
    {0xFFFF, 0x0, 0xFFFF, 0xFFFF, 0x0},
};
#define EVENT_CASES (sizeof event_cases / sizeof event_cases[0])

static UInt matched;
static size_t event_case;
static bool event_wait;

static Void post_case(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    if (event_cases[event_case].posted != 0) {
        Event_post(event, event_cases[event_case].posted);
    }
}

static Void event_waiter(UArg a0, UArg a1)
{
    if (!event_wait) {
        post_case(a0, a1);
    }
    matched = Event_pend(event, event_cases[event_case].and_mask, event_cases[event_case].or_mask,
                         event_wait ? 5 : BIOS_NO_WAIT);
}

static int event_main(void)
{
    event = Event_create(NULL, NULL);
    (void)task("waiter", 5, event_waiter);
    if (event_wait) {
        (void)task("poster", 4, post_case);
    }
    BIOS_start();
    return 0;
}

TEST_CASE(false)
TEST_CASE(true)
void test_event_masks_match_and_consume_as_documented(bool wait)
{
    event_wait = wait;
    for (event_case = 0; event_case < EVENT_CASES; event_case++) {
        char message[32];

        (void)snprintf(message, sizeof message, "case %zu", event_case);
        timeline_reset();
        matched = 0xDEAD;
        boot_and_run_ms(event_main, 10);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(event_cases[event_case].matched, matched, message);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(event_cases[event_case].left, Event_getPostedEvents(event), message);
    }
}

static Void event_sequence(UArg a0, UArg a1)
{
    (void)a0;
    (void)a1;
    say("%x", Event_pend(event, Event_Id_00 | Event_Id_01, Event_Id_NONE, BIOS_WAIT_FOREVER));
    say("%x", Event_pend(event, Event_Id_NONE, Event_Id_02, 2));
    say("%x", Event_pend(event, Event_Id_NONE, Event_Id_15, 9));
}

static Void post_event(UArg number)
{
    Event_post(event, (UInt)1 << (number - 96));
}

static int event_sequence_main(void)
{
    event = Event_create(NULL, NULL);
    for (Int number = 96; number < 96 + 16; number++) {
        hwi(number, post_event);
    }
    (void)task("waiter", 5, event_sequence);
    BIOS_start();
    return 0;
}

/* The and-mask is complete at 1.7 ms; then two ticks from 1.7 end at 3.0; event 15 at 4.2. */
void test_event_pend_waits_for_the_whole_and_mask_and_times_out_with_0(void)
{
    raise_at_us(300, 96);
    raise_at_us(900, 96);
    raise_at_us(1700, 97);
    raise_at_us(4200, 111);
    boot_and_run_ms(event_sequence_main, 10);
    TEST_ASSERT_EQUAL_STRING("3@1700 0@3000 8000@4200 ", trace);
}
