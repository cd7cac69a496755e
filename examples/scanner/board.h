/* What scanner.c needs of a board. posix.c, windows.c and freertos.c are boards; yours is the next one. All
 * of it is called from one loop. */
#ifndef BOARD_H
#define BOARD_H

#include <plomada/octet.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* scanner.c: runs until board_runs() says no; the board's main() or task calls it. NULL, or why it could not
 * begin. */
const char *scanner_run(void);

/* A microsecond counter that wraps at 2^32. */
uint32_t board_time_us(void);

/* The sensor's UART, 8N1: opened (or reopened) at a rate; up to `most` octets that have come, after a wait of
 * some milliseconds at most; octets to be sent; and how many framing errors and overruns there were since the
 * last call. */
void board_uart_open(uint32_t bit_rate);
size_t board_uart_read(octet_t *octets, size_t most);
void board_uart_write(const octet_t *octets, size_t count);
uint32_t board_uart_errors(void);

/* Power of the sensor off and on, where the board can; otherwise empty. */
void board_cycle_sensor_power(void);

/* What the application is for: `true` and a distance, or `false` when there is none. */
void board_show(bool valid, uint16_t distance_mm);

/* False ends the example; on a microcontroller always true. */
bool board_runs(void);

#endif
