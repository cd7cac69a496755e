/* Section .retained: the linker command file places it in RAM that neither the boot ROM nor the C start-up
 * code touches. */
#include "bsp/retained.h"

#define MAGIC 0x506C6F6DUL      /* "Plom": changes with the layout */
#define POLYNOMIAL 0xEDB88320UL /* CRC-32, IEEE 802.3 */
#define FULL 0xFFFFFFFFUL

typedef struct {
    uint32_t words[BSP_RETAINED_WORDS];
    uint32_t sum;
} block_t;

static block_t block __attribute__((section(".retained")));

static uint32_t add(uint32_t sum, uint32_t word)
{

    sum ^= word;
    for (uint16_t bit = 0U; bit < 32U; ++bit) {
        sum = ((sum & 1U) != 0U) ? ((sum >> 1) ^ POLYNOMIAL) : (sum >> 1);
    }
    return sum;
}

static uint32_t sum_of(const uint32_t words[BSP_RETAINED_WORDS])
{
    uint32_t sum = add(FULL, MAGIC);

    for (uint16_t i = 0U; i < BSP_RETAINED_WORDS; ++i) {
        sum = add(sum, words[i]);
    }
    return sum ^ FULL;
}

bool bsp_retained_load(uint32_t words[BSP_RETAINED_WORDS])
{
    const block_t stored = block;

    if (stored.sum != sum_of(stored.words)) {
        return false;
    }
    for (uint16_t i = 0U; i < BSP_RETAINED_WORDS; ++i) {
        words[i] = stored.words[i];
    }
    return true;
}

void bsp_retained_store(const uint32_t words[BSP_RETAINED_WORDS])
{

    for (uint16_t i = 0U; i < BSP_RETAINED_WORDS; ++i) {
        block.words[i] = words[i];
    }
    block.sum = sum_of(words);
}
