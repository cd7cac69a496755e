/* decimal.c, its own source included, in steps that are each proved for any number: a limb never leaves its
 * array because a number never outgrows the powers of ten that bound it. */
#include "drivers/decimal.c"

#include "prove.h"

#define DIGIT_LIMBS 7U  /* 10^32 has 107 bits */
#define SCALED_LIMBS 9U /* 10^39 has 130 bits */
#define TENS_MAX (DIGITS_KEPT - ORDER_MIN)

typedef __CPROVER_bitvector[160] large_t;

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

static bool is_sound(const wide_t *wide, uint16_t limbs)
{
    return wide->used <= limbs && (wide->used == 0U || wide->limb[wide->used - 1U] != 0U);
}

/* One more digit keeps a number of d digits below 10^d. */
void a_digit_more_fits(void)
{
    wide_t wide;
    int32_t count = nondet_cell();
    const uint16_t digit = nondet_cell();

    ASSUME(is_sound(&wide, DIGIT_LIMBS) && count < DIGITS_KEPT && value_of(&wide) < ten_to(count));
    ASSUME(digit <= 9U);
    wide_multiply_add(&wide, 10U, digit);
    PROVE(is_sound(&wide, DIGIT_LIMBS), "within the limbs of 32 digits");
    PROVE(value_of(&wide) < ten_to(count + 1), "below the next power of ten");
}

/* Scaling by five keeps a number below 10^39 as long as its order allows it. */
void scaling_up_fits(void)
{
    wide_t wide;
    const int32_t tens = nondet_cell();
    const uint16_t step = fives(tens);

    ASSUME(tens > 0 && tens <= ORDER_MAX && is_sound(&wide, SCALED_LIMBS));
    ASSUME(value_of(&wide) < ten_to(ORDER_MAX - tens));
    wide_multiply_add(&wide, power_of_five[step], 0U);
    PROVE(is_sound(&wide, SCALED_LIMBS), "within its limbs");
    PROVE(value_of(&wide) < ten_to(ORDER_MAX - tens + step), "below what its order allows");
}

void raising_fits(void)
{
    wide_t wide;
    const int32_t tens = nondet_cell();
    uint16_t raised, before;

    ASSUME(tens >= 0 && tens <= TENS_MAX && is_sound(&wide, SCALED_LIMBS) && wide.used > 0U);
    before = wide.used;
    raised = wide_raise_to(&wide, limbs_to_divide(tens));
    PROVE(wide.used == before + raised && wide.used >= limbs_to_divide(tens), "as many limbs as asked for");
    PROVE(is_sound(&wide, LIMBS), "within its limbs");
}

void dividing_fits(void)
{
    wide_t wide;
    const uint16_t step = nondet_cell();
    uint16_t before;

    ASSUME(is_sound(&wide, LIMBS) && step > 0U && step <= FIVES_MAX);
    before = wide.used;
    (void)wide_divide(&wide, power_of_five[step]);
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
            (void)wide_divide(&wide, power_of_five[fives(tens)]);
        }
        PROVE(wide.used >= 3U, "three limbs are left");
    }
}

void any_number_is_rounded(void)
{
    wide_t wide;
    const int32_t exponent = (int32_t)nondet_cell() - 32768;
    float magnitude;

    ASSUME(is_sound(&wide, LIMBS) && wide.used >= 3U);
    (void)round_to_float(&wide, nondet_bool(), exponent, &magnitude);
}

/* Any text of up to 40 characters: none outside of it is read, however it ends. */
void any_text_is_read(void)
{
    char text[40];
    const size_t length = nondet_size();
    reader_t reader = {text, text + length};
    number_t number = {.digit_count = DIGITS_KEPT}; /* from here on digits are counted only */

    ASSUME(length <= sizeof text);
    (void)read_sign(&reader);
    (void)read_digits(&reader, &number, 0);
    if (next_is(&reader, '.')) {
        reader.at++;
        (void)read_digits(&reader, &number, -1);
    }
    (void)read_exponent(&reader, &number);
    PROVE(reader.at >= text && reader.at <= text + length, "the reader stays within the text");
    PROVE(number.exponent > -20000000 && number.exponent < 20000000, "no exponent overflows");
}

void any_value_is_written(void)
{
    char text[DECIMAL_TEXT_MAX + 1U];
    const size_t capacity = nondet_size();
    const uint16_t decimals = nondet_cell();

    ASSUME(capacity <= DECIMAL_TEXT_MAX);
    text[capacity] = '~';
    PROVE(decimal_write(text, capacity, nondet_float(), decimals) <= capacity, "no more than fits");
    PROVE(text[capacity] == '~', "nothing behind it");
}
