/* Memory that the start-up code does not clear: it outlives a reset, but not a loss of power. main() or one
 * task. */
#ifndef BSP_RETAINED_H
#define BSP_RETAINED_H

#include <stdbool.h>
#include <stdint.h>

#define BSP_RETAINED_WORDS 3U

/* False, and *words untouched, unless whole words were stored since power came, by this build or another of
 * the same layout. */
bool bsp_retained_load(uint32_t words[BSP_RETAINED_WORDS]);

void bsp_retained_store(const uint32_t words[BSP_RETAINED_WORDS]);

#endif
