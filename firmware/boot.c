#include "firmware/boot.h"

#include <stdint.h>
#include <string.h>

#include "bsp/retained.h"
#include "bsp/reset.h"

static bsp_reset_t cause;

void boot_init(void)
{
    cause = bsp_reset_cause();
}

const char *boot_cause(void)
{
    static const char *const names[] = {
        [BSP_RESET_POWER] = "POWER", [BSP_RESET_PIN] = "PIN",     [BSP_RESET_WATCHDOG] = "WATCHDOG",
        [BSP_RESET_NMI] = "NMI",     [BSP_RESET_OTHER] = "OTHER",
    };

    return names[cause];
}

/* These two come while the vehicle may be in the air. The reset pin is a person at the LaunchPad, so
 * that start is one from the ground. */
bool boot_is_restart(void)
{
    return cause == BSP_RESET_WATCHDOG || cause == BSP_RESET_NMI;
}

/* A copy of the bits. A cast would round them, and a union is not defined by the language. */
static uint32_t word_of(float value)
{
    uint32_t word;

    (void)memcpy(&word, &value, sizeof word);
    return word;
}

static float value_of(uint32_t word)
{
    float value;

    (void)memcpy(&value, &word, sizeof value);
    return value;
}

void boot_keep_offset(const attitude_t *offset)
{
    uint32_t words[BSP_RETAINED_WORDS] = {word_of(offset->roll_rad), word_of(offset->pitch_rad),
                                          word_of(offset->yaw_rad)};

    bsp_retained_store(words);
}

/* After power-on the retained memory is anything, and the vehicle stands: the offset is taken anew. */
bool boot_kept_offset(attitude_t *offset)
{
    uint32_t words[BSP_RETAINED_WORDS];

    if (!boot_is_restart() || !bsp_retained_load(words)) {
        return false;
    }
    offset->roll_rad = value_of(words[0]);
    offset->pitch_rad = value_of(words[1]);
    offset->yaw_rad = value_of(words[2]);
    return true;
}
