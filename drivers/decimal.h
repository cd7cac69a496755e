/* Decimal numbers as text: the one reader and the one writer of the project. No printf, no strtod, no double.
 * Any context; no static state. */
#ifndef DRIVERS_DECIMAL_H
#define DRIVERS_DECIMAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Longest text that decimal_write and decimal_write_shortest produce, without a terminator. */
#define DECIMAL_TEXT_MAX 20U

/* Reads `length` characters as one decimal number: [+-] digits [. digits] [e|E [+-] digits]; at least one
 * digit in the mantissa; no blanks, no "nan", no "inf", no hexadecimal, nothing behind the number. The result
 * is the float nearest to the text (ties to even) when it has up to 32 digits, zeros in front not counted; of
 * more, the rest only counts as "something behind". True: *value is written and finite. False: *value is
 * untouched (syntax, or magnitude beyond what a float holds). What, rounded to 24 bits, is less than the
 * smallest normal float reads as zero; zero has no sign: "-0" reads as 0. */
bool decimal_read(const char *text, size_t length, float *value);

/* Writes value with exactly `decimals` digits behind the point (0..6; none: no point either). What is rounded
 * is the exact binary value, a tie away from zero: 0.125 gives "0.13" with two digits, but 0.0005F, which is
 * a little above 0.0005, "0.001" and 0.0025F, a little below 0.0025, "0.002" with three. A result of zero has
 * no sign: "0.000", not "-0.000". Writes no terminator. Returns the number of characters; 0 when it does not
 * fit in capacity, when value is not finite, when |value| >= 4294967, or when decimals > 6. */
size_t decimal_write(char *text, size_t capacity, float value, uint16_t decimals);

/* Writes the shortest plain decimal (no exponent, trailing zeros trimmed) that decimal_read turns back into
 * the same float; -0.0 gives "0". |value| must be 0 or within [1e-7, 4294967). Returns as decimal_write does.
 */
size_t decimal_write_shortest(char *text, size_t capacity, float value);

#endif
