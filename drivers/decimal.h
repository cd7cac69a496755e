/* Reads and writes decimal numbers as text, without printf, strtod or double. Used for every such text of the
 * project. Pure; any context. */
#ifndef DRIVERS_DECIMAL_H
#define DRIVERS_DECIMAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Longest text that decimal_write and decimal_write_shortest produce, without a terminator. */
#define DECIMAL_TEXT_MAX 20U

/* Reads `length` characters as one decimal number: [+-] digits [. digits] [e|E [+-] digits], with at least
 * one digit before the exponent. Refused are blanks, "nan", "inf", hexadecimal numbers, and anything after
 * the number.
 *
 * The result is the float nearest to the text, ties to even. This is exact for up to 32 digits without
 * leading zeros; of further digits only counts whether one of them is not 0. A magnitude that is less than
 * the smallest normal float, after rounding to 24 bits, gives 0. Zero has no sign: "-0" gives 0.
 *
 * Returns true when *value was written; it is finite. Returns false, and does not write *value, when the
 * syntax is wrong or the magnitude is too large for a float. */
bool decimal_read(const char *text, size_t length, float *value);

/* Writes value with exactly `decimals` digits after the point, 0..6; with 0 there is no point. The exact
 * binary value is rounded, ties away from zero: 0.125 with two digits gives "0.13". With three digits 0.0005F
 * gives "0.001", because this float is a little above 0.0005; 0.0025F is a little below 0.0025 and gives
 * "0.002". A zero has no sign: "0.000". Writes no terminator. Returns the number of characters. Returns 0
 * when they do not fit in capacity, value is not finite, |value| >= 4294967, or decimals > 6. */
size_t decimal_write(char *text, size_t capacity, float value, uint16_t decimals);

/* Writes the shortest decimal without exponent and trailing zeros that decimal_read() reads as the same
 * float. -0.0 gives "0". |value| must be 0 or within [1e-7, 4294967). Returns as decimal_write(). */
size_t decimal_write_shortest(char *text, size_t capacity, float value);

#endif
