/* What the firmware makes of the cause of a reset and of the memory that outlives it. */
#include "firmware/boot.h"

#include <string.h>

#include "mock_retained.h"
#include "mock_reset.h"
#include "unity.h"

static bool stored;
static uint32_t memory[BSP_RETAINED_WORDS];

static bool load(uint32_t *words, int calls)
{
    (void)calls;
    if (stored) {
        (void)memcpy(words, memory, sizeof memory);
    }
    return stored;
}

static void store(const uint32_t *words, int calls)
{
    (void)calls;
    (void)memcpy(memory, words, sizeof memory);
    stored = true;
}

void setUp(void)
{
    stored = false;
    (void)memset(memory, 0x5A, sizeof memory);
    bsp_retained_load_Stub(load);
    bsp_retained_store_Stub(store);
}

void tearDown(void) {}

static void boot_after(bsp_reset_t cause)
{
    bsp_reset_cause_ExpectAndReturn(cause); /* once: it forgets */
    boot_init();
}

void test_every_cause_has_its_name_and_only_the_watchdogs_are_restarts(void)
{
    static const struct {
        bsp_reset_t cause;
        const char *name;
        bool restart;
    } rows[] = {{BSP_RESET_POWER, "POWER", false},
                {BSP_RESET_PIN, "PIN", false},
                {BSP_RESET_WATCHDOG, "WATCHDOG", true},
                {BSP_RESET_NMI, "NMI", true},
                {BSP_RESET_OTHER, "OTHER", false}};

    for (uint16_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        boot_after(rows[i].cause);
        TEST_ASSERT_EQUAL_STRING(rows[i].name, boot_cause());
        TEST_ASSERT_EQUAL(rows[i].restart, boot_is_restart());
    }
}

void test_an_offset_kept_is_there_after_a_watchdog_reset(void)
{
    const attitude_t offset = {.roll_rad = 0.0123F, .pitch_rad = -0.0456F, .yaw_rad = 0.0F};
    attitude_t back = {0};

    boot_after(BSP_RESET_POWER);
    boot_keep_offset(&offset);
    boot_after(BSP_RESET_WATCHDOG);
    TEST_ASSERT_TRUE(boot_kept_offset(&back));
    TEST_ASSERT_EQUAL_MEMORY(&offset, &back, sizeof offset);
    boot_after(BSP_RESET_NMI);
    TEST_ASSERT_TRUE(boot_kept_offset(&back));
}

/* On the ground a new offset is better: somebody may have moved the sensor. */
void test_no_other_reset_uses_it(void)
{
    const attitude_t offset = {.roll_rad = 0.0123F};
    attitude_t back = {.roll_rad = 7.0F, .pitch_rad = 8.0F, .yaw_rad = 9.0F};
    const attitude_t untouched = back;

    boot_keep_offset(&offset);
    boot_after(BSP_RESET_POWER);
    TEST_ASSERT_FALSE(boot_kept_offset(&back));
    boot_after(BSP_RESET_PIN);
    TEST_ASSERT_FALSE(boot_kept_offset(&back));
    boot_after(BSP_RESET_OTHER);
    TEST_ASSERT_FALSE(boot_kept_offset(&back));
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &back, sizeof back);
}

void test_a_watchdog_reset_before_the_offset_was_known_gives_none(void)
{
    attitude_t back = {.roll_rad = 7.0F};

    boot_after(BSP_RESET_WATCHDOG);
    TEST_ASSERT_FALSE(boot_kept_offset(&back));
    TEST_ASSERT_EQUAL_FLOAT(7.0F, back.roll_rad);
}
