/* The board of examples/scanner/scanner.c as a sequence of lines: what it does goes to stdout, what the world
 * does comes from stdin. So the program runs in the time of the other side (test_hokuyo.py), not in the
 * clock's:
 *
 *   open RATE | write HEX | cycle | show MM     to the other side
 *   read                                        answered by a line: microseconds, errors, HEX or "-"
 *
 * The other side ends it by the end of its own lines. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "board.h"

#define READ_MOST 32U /* scanner.c */

static uint32_t now_us, errors;
static bool ended;

uint32_t board_time_us(void)
{
    return now_us;
}

void board_uart_open(uint32_t bit_rate)
{
    printf("open %" PRIu32 "\n", bit_rate);
}

size_t board_uart_read(octet_t *octets, size_t most)
{
    char hex[2U * READ_MOST + 1U];
    uint32_t fresh;
    size_t count = 0;
    unsigned octet;

    printf("read\n");
    fflush(stdout);
    if (most != READ_MOST || scanf("%" SCNu32 " %" SCNu32 " %64s", &now_us, &fresh, hex) != 3) {
        ended = true;
        return 0;
    }
    errors += fresh;
    while (hex[0] != '-' && 2U * count < strlen(hex) && sscanf(&hex[2U * count], "%2x", &octet) == 1) {
        octets[count++] = (octet_t)octet;
    }
    return count;
}

void board_uart_write(const octet_t *octets, size_t count)
{
    if (count == 0U) {
        return;
    }
    printf("write ");
    for (size_t i = 0; i < count; i++) {
        printf("%02x", (unsigned)octets[i]);
    }
    printf("\n");
}

uint32_t board_uart_errors(void)
{
    const uint32_t fresh = errors;

    errors = 0U;
    return fresh;
}

void board_cycle_sensor_power(void)
{
    printf("cycle\n");
}

void board_show(bool valid, uint16_t distance_mm)
{
    printf("show %d\n", valid ? (int)distance_mm : -1);
}

bool board_runs(void)
{
    return !ended;
}

int main(void)
{
    const char *const refused = scanner_run();

    if (refused != NULL) {
        fprintf(stderr, "%s\n", refused);
    }
    return refused != NULL;
}
