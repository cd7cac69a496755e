/* The sum at the end of a line, `*5A1F`: CRC-16 of the characters before the '*' (polynomial 1021H, from
 * FFFFH, no reflection; "CRC-16/CCITT-FALSE"), four hexadecimal digits. Pure. */
#ifndef DRIVERS_LINE_SUM_H
#define DRIVERS_LINE_SUM_H

#include <stdint.h>

#define LINE_SUM_DIGITS 4U

/* CRC-16 of `length` characters. */
uint16_t line_sum(const char *text, uint16_t length);

/* Writes the sum as hexadecimal digits in upper case, without terminator. */
void line_sum_write(char digits[LINE_SUM_DIGITS], uint16_t sum);

#endif
