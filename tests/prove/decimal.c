/* decimal.c, its own source included. Every function is proved by itself, for anything that its callers may
 * give it; in their proofs a call of it is replaced by what it needs and what it was proved to give
 * (prove.py, APART). A limb never leaves its array because a number never outgrows the powers of ten that
 * bound it. */
#include "drivers/decimal.c"

#include "prove.h"

#define TEXT_MOST 40U   /* characters read: the longest line of a telecommand has 32 */
#define DIGIT_LIMBS 7U  /* 10^32 has 107 bits */
#define SCALED_LIMBS 9U /* 10^39 has 130 bits */
#define TENS_MAX (DIGITS_KEPT - ORDER_MIN)
#define EXPONENT_MOST 20000000L

typedef __CPROVER_bitvector[160] large_t;

static int32_t up;   /* powers of ten that make_binary() must still multiply by */
static int32_t down; /* and divide by */

/* As C99 has them, for the numbers that decimal.c hands over; any result where its value does not matter. */
float frexpf(float value, int *exponent)
{
    const float fraction = nondet_float();

    *exponent = (int)nondet_cell();
    ASSUME(*exponent >= -148 && *exponent <= 128 && (!(value < WRITE_END) || *exponent <= 23));
    ASSUME(value > 0.0F ? fraction >= 0.5F && fraction < 1.0F : fraction == 0.0F && *exponent == 0);
    return fraction;
}

float ldexpf(float fraction, int exponent)
{
    const float result = nondet_float();

    ASSUME(exponent != 24 ||
           (fraction > 0.0F ? result >= 8388608.0F && result < 16777216.0F : result == 0.0F));
    return result;
}

static bool is_sound(const wide_t *wide, uint16_t limbs)
{
    return wide->used <= limbs && (wide->used == 0U || wide->limb[wide->used - 1U] != 0U);
}

static void any_sound(wide_t *wide, uint16_t limbs)
{
    wide_t any;

    ASSUME(is_sound(&any, limbs));
    *wide = any;
}

/* ---- what each part needs, and gives ---- */

/* The number of a text is below 10^digit_count; the number to be scaled is below 10^(39 - up). */
static void wide_multiply_add(wide_t *wide, uint16_t factor, uint16_t addend)
{
    if (up > 0) {
        PROVE(factor == power_of_five[fives(up)] && addend == 0U, "a step of scaling up");
        up -= fives(up);
        any_sound(wide, SCALED_LIMBS);
        ASSUME(wide->used > 0U);
    } else {
        PROVE(((number_t *)wide)->digit_count < DIGITS_KEPT, "a digit that is kept");
        PROVE(factor == 10U && addend <= 9U, "a digit");
        wide->used = nondet_cell(); /* no limb of it is looked at before to_float() */
        ASSUME(wide->used <= DIGIT_LIMBS);
    }
}

static uint16_t wide_raise_to(wide_t *wide, uint16_t used)
{
    const uint16_t raise = nondet_cell();

    PROVE(up == 0 && is_sound(wide, SCALED_LIMBS) && wide->used > 0U, "a scaled number");
    PROVE(down >= 0 && down <= TENS_MAX && used == limbs_to_divide(down), "limbs for the divisions to come");
    ASSUME(raise <= LIMBS);
    any_sound(wide, LIMBS);
    ASSUME(wide->used >= used);
    return raise;
}

static bool wide_divide(wide_t *wide, uint16_t divisor)
{
    PROVE(down > 0 && divisor == power_of_five[fives(down)], "a step of scaling down");
    down -= fives(down);
    any_sound(wide, LIMBS);
    ASSUME(down > 0 || wide->used >= 3U);
    return nondet_bool();
}

static int32_t make_binary(number_t *number)
{
    const int32_t exponent = (int32_t)nondet_cell() - 32768;

    PROVE(is_sound(&number->digits, DIGIT_LIMBS) && number->digits.used > 0U, "digits");
    PROVE(number->exponent + number->digit_count <= ORDER_MAX && number->exponent < ORDER_MAX,
          "below what the limbs allow");
    PROVE(number->exponent >= -TENS_MAX, "above what the limbs allow");
    any_sound(&number->digits, LIMBS);
    ASSUME(number->digits.used >= 3U && exponent >= -1000 && exponent <= 1000);
    return exponent;
}

static bool round_to_float(const wide_t *wide, bool more, int32_t exponent, float *magnitude)
{
    (void)more;
    PROVE(is_sound(wide, LIMBS) && wide->used >= 3U, "three limbs at least");
    PROVE(exponent >= -1000 && exponent <= 1000, "an exponent that has room");
    *magnitude = nondet_float();
    return nondet_bool();
}

static bool is_read(const number_t *number)
{
    return number->digits.used <= DIGIT_LIMBS && number->digit_count >= (number->digits.used > 0U ? 1 : 0) &&
           number->digit_count <= DIGITS_KEPT && number->exponent > -EXPONENT_MOST &&
           number->exponent < EXPONENT_MOST;
}

static bool to_float(number_t *number, float *magnitude)
{
    PROVE(is_read(number), "a number as it is read");
    *magnitude = nondet_float();
    return nondet_bool();
}

bool decimal_read(const char *text, size_t length, float *value)
{
    PROVE(length <= TEXT_MOST && __CPROVER_r_ok(text, length), "a text of its own");
    *value = nondet_float();
    return nondet_bool();
}

static uint64_t scaled(float magnitude, uint16_t decimals)
{
    PROVE(magnitude >= 0.0F && magnitude < WRITE_END && decimals <= SHORTEST_DECIMALS_MAX, "can be scaled");
    return (uint64_t)nondet_size() << 32 | nondet_size();
}

static size_t write_backwards(char buffer[WRITTEN_MAX], uint64_t number, uint16_t decimals, bool minus)
{
    const size_t begin = nondet_size();

    (void)number;
    (void)minus;
    PROVE(__CPROVER_w_ok(buffer, WRITTEN_MAX) && decimals <= SHORTEST_DECIMALS_MAX, "any number has room");
    ASSUME(begin < WRITTEN_MAX);
    return begin;
}

static size_t write_decimals(char *text, size_t capacity, float value, uint16_t decimals)
{
    const size_t length = nondet_size();

    PROVE(__CPROVER_w_ok(text, capacity), "a text of its own");
    PROVE(fabsf(value) < WRITE_END && decimals <= SHORTEST_DECIMALS_MAX, "can be written");
    ASSUME(length <= capacity && length <= WRITTEN_MAX);
    return length;
}

/* ---- reading ---- */

static large_t value_of(const wide_t *wide)
{
    large_t value = 0;

    for (uint16_t i = SCALED_LIMBS; i-- > 0U;) {
        value = (value << 16) | (i < wide->used ? (large_t)wide->limb[i] : (large_t)0);
    }
    return value;
}

static large_t ten_to(int32_t exponent)
{
    large_t power = 1;

    for (int32_t i = 0; i < ORDER_MAX; i++) {
        power = i < exponent ? power * 10 : power;
    }
    return power;
}

/* One more digit keeps a number of d digits below 10^d. */
void a_digit_more_fits(void)
{
    wide_t wide;
    int32_t count = nondet_cell();
    const uint16_t digit = nondet_cell();

    ASSUME(is_sound(&wide, DIGIT_LIMBS) && count < DIGITS_KEPT && value_of(&wide) < ten_to(count));
    ASSUME(digit <= 9U);
    wide_multiply_add_itself(&wide, 10U, digit);
    PROVE(is_sound(&wide, DIGIT_LIMBS), "within the limbs of 32 digits");
    PROVE(value_of(&wide) < ten_to(count + 1), "below the next power of ten");
}

/* Scaling by five keeps a number below 10^39 as long as its order allows it. */
void scaling_up_fits(void)
{
    wide_t wide;
    const int32_t tens = nondet_cell();
    const uint16_t step = fives(tens);

    ASSUME(tens > 0 && tens <= ORDER_MAX && is_sound(&wide, SCALED_LIMBS) && wide.used > 0U);
    ASSUME(value_of(&wide) < ten_to(ORDER_MAX - tens));
    wide_multiply_add_itself(&wide, power_of_five[step], 0U);
    PROVE(is_sound(&wide, SCALED_LIMBS) && wide.used > 0U, "within its limbs");
    PROVE(value_of(&wide) < ten_to(ORDER_MAX - tens + step), "below what its order allows");
}

void raising_fits(void)
{
    wide_t wide;
    const int32_t tens = nondet_cell();
    uint16_t raised, before;

    ASSUME(tens >= 0 && tens <= TENS_MAX && is_sound(&wide, SCALED_LIMBS) && wide.used > 0U);
    before = wide.used;
    raised = wide_raise_to_itself(&wide, limbs_to_divide(tens));
    PROVE(wide.used == before + raised && wide.used >= limbs_to_divide(tens), "as many limbs as asked for");
    PROVE(is_sound(&wide, LIMBS) && raised <= LIMBS, "within its limbs");
}

void dividing_fits(void)
{
    wide_t wide;
    const uint16_t step = nondet_cell();
    uint16_t before;

    ASSUME(is_sound(&wide, LIMBS) && step > 0U && step <= FIVES_MAX);
    before = wide.used;
    (void)wide_divide_itself(&wide, power_of_five[step]);
    PROVE(is_sound(&wide, LIMBS) && wide.used <= before, "no longer than before");
}

/* The smallest number of that many limbs, and so any other (a larger number has a larger quotient), keeps
 * more than 32 bits. */
void division_leaves_enough(void)
{
    for (int32_t k = 0; k <= TENS_MAX; k++) {
        wide_t wide = {.used = limbs_to_divide(k)};

        wide.limb[wide.used - 1U] = 1U;
        for (int32_t tens = k; tens > 0; tens -= fives(tens)) {
            (void)wide_divide_itself(&wide, power_of_five[fives(tens)]);
        }
        PROVE(wide.used >= 3U, "three limbs are left");
    }
}

void any_number_is_made_binary(void)
{
    number_t number;
    int32_t exponent;

    any_sound(&number.digits, DIGIT_LIMBS);
    ASSUME(number.digits.used > 0U && number.exponent >= -TENS_MAX && number.exponent < ORDER_MAX);
    up = number.exponent > 0 ? number.exponent : 0;
    down = number.exponent < 0 ? -number.exponent : 0;
    exponent = make_binary_itself(&number);
    PROVE(up == 0 && down == 0, "wholly scaled");
    PROVE(is_sound(&number.digits, LIMBS) && number.digits.used >= 3U, "three limbs at least");
    PROVE(exponent >= -1000 && exponent <= 1000, "an exponent that has room");
}

void any_number_is_rounded(void)
{
    wide_t wide;
    const int32_t exponent = (int32_t)nondet_cell() - 32768;
    float magnitude;

    any_sound(&wide, LIMBS);
    ASSUME(wide.used >= 3U && exponent >= -1000 && exponent <= 1000);
    (void)round_to_float_itself(&wide, nondet_bool(), exponent, &magnitude);
}

void any_number_is_converted(void)
{
    number_t number;
    float magnitude;

    any_sound(&number.digits, DIGIT_LIMBS);
    ASSUME(is_read(&number));
    (void)to_float_itself(&number, &magnitude);
}

/* None outside of the text is read, however it ends. */
void any_text_is_read(void)
{
    char text[TEXT_MOST];
    const size_t length = nondet_size();
    float value;

    ASSUME(length <= sizeof text);
    (void)decimal_read_itself(text, length, &value);
}

/* ---- writing ---- */

void any_value_is_scaled(void)
{
    const float magnitude = nondet_float();
    const uint16_t decimals = nondet_cell();

    ASSUME(magnitude >= 0.0F && magnitude < WRITE_END && decimals <= SHORTEST_DECIMALS_MAX);
    (void)scaled_itself(magnitude, decimals);
}

void any_digits_are_written(void)
{
    char buffer[WRITTEN_MAX];
    const uint64_t number = (uint64_t)nondet_size() << 32 | nondet_size();
    const uint16_t decimals = nondet_cell();

    ASSUME(decimals <= SHORTEST_DECIMALS_MAX);
    PROVE(write_backwards_itself(buffer, number, decimals, nondet_bool()) < WRITTEN_MAX,
          "one digit at least");
}

static char text_[WRITTEN_MAX + 2U];

static size_t any_capacity(void)
{
    const size_t capacity = nondet_size();

    ASSUME(capacity <= WRITTEN_MAX + 1U);
    text_[capacity] = '~';
    return capacity;
}

void any_decimals_are_written(void)
{
    const size_t capacity = any_capacity();
    const float value = nondet_float();
    const uint16_t decimals = nondet_cell();

    ASSUME(fabsf(value) < WRITE_END && decimals <= SHORTEST_DECIMALS_MAX);
    const size_t length = write_decimals_itself(text_, capacity, value, decimals);
    PROVE(length <= capacity && length <= WRITTEN_MAX, "no more than fits");
    PROVE(text_[capacity] == '~', "nothing behind it");
}

void any_value_is_written(void)
{
    const size_t capacity = any_capacity();

    PROVE(decimal_write(text_, capacity, nondet_float(), nondet_cell()) <= capacity, "no more than fits");
    PROVE(text_[capacity] == '~', "nothing behind it");
}

void any_value_is_written_shortest(void)
{
    const size_t capacity = any_capacity();

    PROVE(decimal_write_shortest(text_, capacity, nondet_float()) <= capacity, "no more than fits");
    PROVE(text_[capacity] == '~', "nothing behind it");
}
