/* The machine below a test: console, exit, reading of files, and what avr-libc lacks of C99. See machine.c.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "registers.h"

#define REGISTER(address) (*(volatile uint8_t *)(address))

extern char _end; /* of the linker: first address above the static variables */

int suite_main(void);
void board_putc(int character);

static FILE streams[FILES_MAX];

void board_putc(int character)
{
    REGISTER(REGISTER_SAY) = (uint8_t)character;
}

static int put(char character, FILE *unused)
{
    (void)unused;
    board_putc(character);
    return 0;
}

static int get(FILE *stream)
{
    int octet;

    REGISTER(REGISTER_SELECT) = (uint8_t)(stream - streams);
    octet = REGISTER(REGISTER_READ);
    return REGISTER(REGISTER_END) != 0 ? _FDEV_EOF : octet;
}

FILE *fopen(const char *path, const char *mode)
{
    static uint8_t next;
    const uint8_t number = next++ % FILES_MAX;

    (void)mode;
    do {
        REGISTER(REGISTER_NAME) = (uint8_t)*path;
    } while (*path++ != '\0');
    REGISTER(REGISTER_SELECT) = number;
    REGISTER(REGISTER_OPEN) = 1;
    if (REGISTER(REGISTER_OPEN) == 0) {
        return NULL;
    }
    fdev_setup_stream(&streams[number], NULL, get, _FDEV_SETUP_READ);
    return &streams[number];
}

float nextafterf(float from, float to)
{
    uint32_t bits;

    if (from == to || isnan(from) || isnan(to)) {
        return to;
    }
    memcpy(&bits, &from, sizeof bits);
    if (from == 0.0F) {
        bits = to > 0.0F ? 1UL : 0x80000001UL;
    } else {
        bits = (from < to) == (from > 0.0F) ? bits + 1UL : bits - 1UL;
    }
    memcpy(&from, &bits, sizeof from);
    return from;
}

int main(void)
{
    static FILE console;

    REGISTER(REGISTER_FLOOR_LOW) = (uint8_t)((uintptr_t)&_end & 0xFFU);
    REGISTER(REGISTER_FLOOR_HIGH) = (uint8_t)((uintptr_t)&_end >> 8);
    fdev_setup_stream(&console, put, NULL, _FDEV_SETUP_WRITE);
    stdout = &console;
    REGISTER(REGISTER_LEAVE) = suite_main() == 0 ? 0 : 1;
    for (;;) {
    }
}
