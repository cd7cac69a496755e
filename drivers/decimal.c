/* Exact conversion between decimal text and 32-bit float. The reader keeps the number as a large integer in
 * limbs of 16 bits. It scales the integer by powers of five; powers of two are shifts. `more` means that a
 * division left a remainder. It rounds once, at the end, to 24 bits, ties to even (exact integer arithmetic
 * as in Clinger, "How to Read Floating Point Numbers Accurately", 1990). The writer scales the mantissa by
 * 5^decimals in 64 bits and also rounds once. What breaks: with products of floats the number is rounded
 * several times, so a parameter that is written and read back can differ in its last bit. DIGITS_KEPT,
 * ORDER_MIN and LIMBS belong together: 32 digits at 10^-37 are divided by five 69 times, and need 14 limbs.
 * tests/drivers/test_decimal.c compares with the PC's strtof(), tests/prove/decimal.c proves the limbs. */
#include "drivers/decimal.h"

#include <math.h>
#include <string.h>

/* The longest line of a telecommand has 32 characters. Of later digits only counts whether one is not 0. So a
 * text is read exactly, unless its first 32 digits are those of a longer midpoint between two floats. */
#define DIGITS_KEPT 32

#define ORDER_MAX 39    /* 10^39 is beyond the largest float */
#define ORDER_MIN (-37) /* 10^-38 is below the smallest normal float */
#define EXPONENT_MAX 1000000L

#define MANTISSA_END 0x1000000UL /* 2^24 */
#define UNIT_MAX 104             /* the largest float is (2^24 - 1) 2^104 */
#define UNIT_MIN (-149)          /* the smallest normal float is 2^23 2^-149 */

#define WRITE_END 4294967.0F
#define WRITE_SHORTEST_MIN 1e-7F
#define FIXED_DECIMALS_MAX 6U
#define SHORTEST_DECIMALS_MAX 15U /* nine significant digits of the smallest value: always enough */
#define WRITTEN_MAX 22U           /* 64 bits have 20 digits; a point and a sign */

#define LIMB_BITS 16
#define LIMBS 14U

/* A natural number, least significant limb first; the limb at used - 1 is not zero. */
typedef struct {
    uint16_t limb[LIMBS];
    uint16_t used;
} wide_t;

typedef struct {
    wide_t digits;
    int32_t digit_count; /* of `digits` */
    int32_t exponent;    /* the number is digits * 10^exponent */
    bool more;           /* and something smaller than the last digit kept */
} number_t;

typedef struct {
    const char *at;
    const char *end;
} reader_t;

#define FIVES_MAX 6
static const uint16_t power_of_five[] = {1U, 5U, 25U, 125U, 625U, 3125U, 15625U};

static void wide_multiply_add(wide_t *wide, uint16_t factor, uint16_t addend)
{
    uint32_t carry = addend;

    for (uint16_t i = 0U; i < wide->used; ++i) {
        carry += (uint32_t)wide->limb[i] * factor;
        wide->limb[i] = (uint16_t)(carry & 0xFFFFU);
        carry >>= LIMB_BITS;
    }
    if (carry != 0U) {
        wide->limb[wide->used++] = (uint16_t)carry;
    }
}

/* Returns whether a remainder was lost. */
static bool wide_divide(wide_t *wide, uint16_t divisor)
{
    uint32_t remainder = 0U;

    for (uint16_t i = wide->used; i-- > 0U;) {
        remainder = (remainder << LIMB_BITS) | wide->limb[i];
        wide->limb[i] = (uint16_t)(remainder / divisor);
        remainder %= divisor;
    }
    while (wide->used > 0U && wide->limb[wide->used - 1U] == 0U) {
        --wide->used;
    }
    return remainder != 0U;
}

/* Puts zero limbs below the number until it has at least `used`; returns how many. */
static uint16_t wide_raise_to(wide_t *wide, uint16_t used)
{
    const uint16_t raised = (used > wide->used) ? used : wide->used;
    const uint16_t raise = (uint16_t)(raised - wide->used);

    wide->used = raised;
    for (uint16_t i = wide->used; i-- > 0U;) {
        wide->limb[i] = i >= raise ? wide->limb[i - raise] : 0U;
    }
    return raise;
}

static bool wide_has_below(const wide_t *wide, uint16_t limb)
{
    for (uint16_t i = 0U; i < limb; ++i) {
        if (wide->limb[i] != 0U) {
            return true;
        }
    }
    return false;
}

/* The next step of scaling by 5^tens. */
static uint16_t fives(int32_t tens)
{
    return tens < FIVES_MAX ? (uint16_t)tens : (uint16_t)FIVES_MAX;
}

/* Limbs from which a division by 5^tens leaves more than 32 bits: 5^k < 2^(7 k / 3), which is 7 k / 48 limbs.
 */
static uint16_t limbs_to_divide(int32_t tens)
{
    return (uint16_t)(tens * 7 / 48 + 4);
}

/* Replaces digits * 10^exponent by digits * 2^(returned), more than 32 bits long, with `more` telling of what
 * is below. */
static int32_t make_binary(number_t *number)
{
    int32_t tens = number->exponent; /* to multiply by; if negative, to divide by */

    for (; tens > 0; tens -= fives(tens)) {
        wide_multiply_add(&number->digits, power_of_five[fives(tens)], 0U);
    }
    tens = -tens;
    const uint16_t raised = wide_raise_to(&number->digits, limbs_to_divide(tens));
    for (; tens > 0; tens -= fives(tens)) {
        number->more |= wide_divide(&number->digits, power_of_five[fives(tens)]);
    }
    return number->exponent - (int32_t)raised * LIMB_BITS;
}

/* The nearest float to (wide and, if more, a little) * 2^exponent, ties to even. Wide has three limbs at
 * least. */
static bool round_to_float(const wide_t *wide, bool more, int32_t exponent, float *magnitude)
{
    uint16_t low = (uint16_t)(wide->used - 3U);
    uint64_t window = ((uint64_t)wide->limb[low + 2U] << 32) | ((uint64_t)wide->limb[low + 1U] << 16) |
                      wide->limb[low];
    uint16_t drop = 0U;

    while ((window >> drop) >= MANTISSA_END) {
        ++drop;
    }
    uint32_t mantissa = (uint32_t)(window >> drop);
    const uint32_t rest = (uint32_t)(window & (((uint32_t)1U << drop) - 1U));
    const uint32_t half = (uint32_t)1U << (drop - 1U);
    more = more || wide_has_below(wide, low);
    if (rest > half || (rest == half && (more || (mantissa & 1U) != 0U))) {
        ++mantissa;
    }

    int32_t unit = exponent + (int32_t)low * LIMB_BITS + (int32_t)drop;
    if (mantissa == MANTISSA_END) {
        mantissa >>= 1;
        ++unit;
    }
    if (unit > UNIT_MAX) {
        return false;
    }
    *magnitude = unit < UNIT_MIN ? 0.0F : ldexpf((float)mantissa, (int)unit);
    return true;
}

static bool to_float(number_t *number, float *magnitude)
{
    int32_t order = number->digit_count + number->exponent;

    if (number->digits.used == 0U || order < ORDER_MIN) {
        *magnitude = 0.0F;
        return true;
    }
    if (order > ORDER_MAX) {
        return false;
    }
    const int32_t exponent = make_binary(number);
    return round_to_float(&number->digits, number->more, exponent, magnitude);
}

static bool next_is(const reader_t *reader, char character)
{
    return reader->at < reader->end && *reader->at == character;
}

static bool next_is_digit(const reader_t *reader)
{
    return reader->at < reader->end && *reader->at >= '0' && *reader->at <= '9';
}

/* Takes a sign if there is one; true when it is a minus. */
static bool read_sign(reader_t *reader)
{
    bool minus = next_is(reader, '-');

    if (minus || next_is(reader, '+')) {
        ++reader->at;
    }
    return minus;
}

/* Appends digits, each moving the exponent by `place` (-1 behind the point); true when there was one. */
static bool read_digits(reader_t *reader, number_t *number, int16_t place)
{
    bool any = false;

    for (; next_is_digit(reader); ++reader->at) {
        uint16_t digit = (uint16_t)(*reader->at - '0');

        any = true;
        if (number->digit_count < DIGITS_KEPT) {
            wide_multiply_add(&number->digits, 10U, digit);
            number->digit_count += number->digits.used > 0U ? 1 : 0;
            number->exponent += place;
        } else {
            number->more |= digit != 0U;
            number->exponent += 1 + place;
        }
    }
    return any;
}

/* Takes "e..." if there is one; false when it lacks its digits. */
static bool read_exponent(reader_t *reader, number_t *number)
{
    bool any = false;
    int32_t exponent = 0;

    if (!next_is(reader, 'e') && !next_is(reader, 'E')) {
        return true;
    }
    ++reader->at;
    const bool minus = read_sign(reader);
    for (; next_is_digit(reader); ++reader->at) {
        any = true;
        if (exponent < EXPONENT_MAX) {
            exponent = exponent * 10 + (*reader->at - '0');
        }
    }
    number->exponent += minus ? -exponent : exponent;
    return any;
}

bool decimal_read(const char *text, size_t length, float *value)
{
    reader_t reader = {text, text + length};
    number_t number = {.exponent = 0};
    bool minus = read_sign(&reader);
    bool any = read_digits(&reader, &number, 0);
    float magnitude;

    if (next_is(&reader, '.')) {
        ++reader.at;
        any = read_digits(&reader, &number, -1) || any;
    }
    if (!any || !read_exponent(&reader, &number) || reader.at != reader.end ||
        !to_float(&number, &magnitude)) {
        return false;
    }
    *value = minus && magnitude > 0.0F ? -magnitude : magnitude;
    return true;
}

/* magnitude * 10^decimals, rounded half up: the mantissa times 5^decimals, shifted by what is left of the
 * exponents. */
static uint64_t scaled(float magnitude, uint16_t decimals)
{
    int exponent;
    uint64_t product = (uint32_t)ldexpf(frexpf(magnitude, &exponent), 24);
    int16_t shift = (int16_t)(24 - exponent - (int16_t)decimals);

    for (uint16_t i = 0U; i < decimals; ++i) {
        product *= 5U;
    }
    if (shift <= 0) {
        return product << -shift;
    }
    if (shift > 62) {
        return 0U;
    }
    return (product + ((uint64_t)1U << (shift - 1))) >> shift;
}

/* Writes `number` with its last `decimals` digits behind a point; returns where the text begins in the
 * buffer. */
static size_t write_backwards(char buffer[WRITTEN_MAX], uint64_t number, uint16_t decimals, bool minus)
{
    size_t at = WRITTEN_MAX;

    for (uint16_t place = 0U; place <= decimals || number != 0U; ++place) {
        if (place == decimals && decimals > 0U) {
            buffer[--at] = '.';
        }
        buffer[--at] = (char)('0' + (int16_t)(number % 10U));
        number /= 10U;
    }
    if (minus) {
        buffer[--at] = '-';
    }
    return at;
}

static size_t write_decimals(char *text, size_t capacity, float value, uint16_t decimals)
{
    char buffer[WRITTEN_MAX];
    uint64_t number = scaled(fabsf(value), decimals);
    size_t begin = write_backwards(buffer, number, decimals, value < 0.0F && number != 0U);
    size_t length = WRITTEN_MAX - begin;

    if (length > capacity) {
        return 0U;
    }
    (void)memcpy(text, &buffer[begin], length);
    return length;
}

size_t decimal_write(char *text, size_t capacity, float value, uint16_t decimals)
{
    if (!(fabsf(value) < WRITE_END) || decimals > FIXED_DECIMALS_MAX) {
        return 0U;
    }
    return write_decimals(text, capacity, value, decimals);
}

static bool reads_back(const char *text, size_t length, float value)
{
    float back;

    return decimal_read(text, length, &back) && !(back < value) && !(back > value);
}

size_t decimal_write_shortest(char *text, size_t capacity, float value)
{
    float magnitude = fabsf(value);
    uint16_t decimals = 0U;

    if (!(magnitude < WRITE_END) || (magnitude > 0.0F && magnitude < WRITE_SHORTEST_MIN)) {
        return 0U;
    }
    size_t length = write_decimals(text, capacity, value, decimals);
    while (length > 0U && decimals < SHORTEST_DECIMALS_MAX && !reads_back(text, length, value)) {
        ++decimals;
        length = write_decimals(text, capacity, value, decimals);
    }
    return length;
}
