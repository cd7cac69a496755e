/* Memory that the start-up code does not clear. It keeps its content over a reset, but not over a loss of
 * power. main() or one task. */
#ifndef BSP_RETAINED_H
#define BSP_RETAINED_H

#include <stdbool.h>
#include <stdint.h>

#define BSP_RETAINED_WORDS 3U

/* Reads the stored words. Returns false, and does not write *words, when no complete words were stored since
 * power-up by this build or another one with the same layout. */
bool bsp_retained_load(uint32_t words[BSP_RETAINED_WORDS]);

/* Stores the words. */
void bsp_retained_store(const uint32_t words[BSP_RETAINED_WORDS]);

#endif
