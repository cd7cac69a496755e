#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "bsp/start.h"
#include "unity.h"

#define CELLS 37
#define MARGIN 4
#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)

/* What the linker command file defines on the target: an array, and a number as the address of a name. */
uint16_t ebss_start[CELLS + MARGIN];
__asm__(".globl ebss_size\n.set ebss_size, " TEXT(CELLS));

static unsigned watchdog_off;
static uint16_t first_cell_then;

void SysCtl_disableWatchdog(void)
{
    watchdog_off++;
    first_cell_then = ebss_start[0];
}

void setUp(void)
{
    watchdog_off = 0;
    memset(ebss_start, 0xA5, sizeof ebss_start);
    bsp_start();
}

void tearDown(void) {}

void test_every_cell_of_the_section_is_zero(void)
{
    for (size_t i = 0; i < CELLS; i++) {
        TEST_ASSERT_EQUAL_HEX16(0, ebss_start[i]);
    }
}

void test_no_cell_behind_the_section_is_touched(void)
{
    for (size_t i = CELLS; i < CELLS + MARGIN; i++) {
        TEST_ASSERT_EQUAL_HEX16(0xA5A5, ebss_start[i]);
    }
}

void test_the_watchdog_is_off_before_the_work_begins(void)
{
    TEST_ASSERT_EQUAL_UINT(1, watchdog_off);
    TEST_ASSERT_EQUAL_HEX16(0xA5A5, first_cell_then);
}
