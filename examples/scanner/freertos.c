/* board.h as a task of FreeRTOS: the UART's interrupt hands octets to a stream buffer, the task sleeps until
 * some are there. Of your board it needs uart_set_rate() and uart_write(), and that its receive interrupt
 * calls scanner_received(). */
#include <FreeRTOS.h>
#include <stream_buffer.h>
#include <task.h>

#include "board.h"

#define BUFFER 256U /* 10 ms at 250000 bit/s */
#define WAIT_MS 5U  /* less than an eighth of what urg_pause_us() asks for at least */
#define STACK 512U  /* words; the deepest call of the driver takes far less */

void uart_set_rate(uint32_t bit_rate);
void uart_write(const uint8_t *octets, size_t count);
void scanner_received(const uint8_t *octets, size_t count, uint32_t errors);
void scanner_create(UBaseType_t priority);
uint16_t scanner_distance_mm(void);

static StreamBufferHandle_t received;
static volatile uint32_t errors_seen;     /* written by the interrupt alone */
static volatile uint16_t distance_mm_now; /* 0: none */

/* In the UART's interrupt. */
void scanner_received(const uint8_t *octets, size_t count, uint32_t errors)
{
    BaseType_t woken = pdFALSE;

    if (xStreamBufferSendFromISR(received, octets, count, &woken) != count) {
        errors++; /* octets are lost: as bad as an overrun of the UART */
    }
    errors_seen += errors;
    portYIELD_FROM_ISR(woken);
}

/* The tick count wraps at 2^32, and so does a multiple of it. */
uint32_t board_time_us(void)
{
    return (uint32_t)xTaskGetTickCount() * (1000000U / configTICK_RATE_HZ);
}

void board_uart_open(uint32_t bit_rate)
{
    uart_set_rate(bit_rate);
}

size_t board_uart_read(octet_t *octets, size_t most)
{
    return xStreamBufferReceive(received, octets, most, pdMS_TO_TICKS(WAIT_MS));
}

void board_uart_write(const octet_t *octets, size_t count)
{
    uart_write(octets, count);
}

uint32_t board_uart_errors(void)
{
    static uint32_t told;
    const uint32_t fresh = errors_seen - told;

    told += fresh;
    return fresh;
}

void board_cycle_sensor_power(void) {}

void board_show(bool valid, uint16_t distance_mm)
{
    distance_mm_now = valid ? distance_mm : 0U;
}

bool board_runs(void)
{
    return true;
}

uint16_t scanner_distance_mm(void)
{
    return distance_mm_now;
}

static void task(void *parameter)
{
    const char *const refused = scanner_run();

    (void)parameter;
    (void)refused;
    configASSERT(refused == NULL);
    vTaskDelete(NULL);
}

/* Before the scheduler starts, and before the interrupt is enabled. */
void scanner_create(UBaseType_t priority)
{
    static uint8_t memory[BUFFER + 1U];
    static StaticStreamBuffer_t buffer;
    static StackType_t stack[STACK];
    static StaticTask_t control;

    received = xStreamBufferCreateStatic(BUFFER, 1U, memory, &buffer);
    (void)xTaskCreateStatic(task, "scanner", STACK, NULL, priority, stack, &control);
}
