#include "bsp/start.h"

#include <stdint.h>

#include "device.h"

/* The linker command file says where and how large: the address of ebss_size is the number of cells. */
extern uint16_t ebss_start[];
extern uint16_t ebss_size[];

void bsp_start(void)
{
    const uint32_t cells = (uint32_t)(uintptr_t)ebss_size;

    SysCtl_disableWatchdog();
    for (uint32_t i = 0U; i < cells; ++i) {
        ebss_start[i] = 0U;
    }
}
