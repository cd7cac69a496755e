/* What examples/scanner/freertos.c uses of FreeRTOS, declared only, as FreeRTOS 11 declares it: the example
 * is compiled against it. */
#ifndef FREERTOS_H
#define FREERTOS_H

#include <stddef.h>
#include <stdint.h>

typedef long BaseType_t;
typedef unsigned long UBaseType_t;
typedef uint32_t TickType_t;
typedef uint32_t StackType_t;

#define pdFALSE ((BaseType_t)0)
#define configTICK_RATE_HZ ((TickType_t)1000)
#define pdMS_TO_TICKS(ms) ((TickType_t)(((uint64_t)(ms)*configTICK_RATE_HZ) / 1000U))
#define configASSERT(x) \
    do { \
        if (!(x)) { \
            vAssertCalled(); \
        } \
    } while (0)
#define portYIELD_FROM_ISR(woken) vPortYieldFromISR(woken)

void vAssertCalled(void);
void vPortYieldFromISR(BaseType_t woken);

#endif
