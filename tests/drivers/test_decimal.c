#include "drivers/decimal.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

#pragma GCC diagnostic ignored "-Wmissing-prototypes" /* the generated runner declares the tests */

#define SEED 20160609UL
#define UNTOUCHED 123.0F

static uint32_t random_state;

void setUp(void)
{
    random_state = SEED;
}

void tearDown(void) {}

/* xorshift32 (Marsaglia 2003) */
static uint32_t random_bits(void)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 17;
    random_state ^= random_state << 5;
    return random_state;
}

static void say_seed(const char *what)
{
    printf("%s: seed %lu\n", what, SEED);
}

static float float_of(uint32_t bits)
{
    union {
        uint32_t bits;
        float value;
    } both;
    both.bits = bits;
    return both.value;
}

static uint32_t bits_of(float value)
{
    union {
        uint32_t bits;
        float value;
    } both;
    both.value = value;
    return both.bits;
}

static float read_ok(const char *text)
{
    float value = UNTOUCHED;
    TEST_ASSERT_TRUE_MESSAGE(decimal_read(text, strlen(text), &value), text);
    return value;
}

static void assert_reads(float expected, const char *text)
{
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(bits_of(expected), bits_of(read_ok(text)), text);
}

static void assert_refused(const char *text, size_t length)
{
    float value = UNTOUCHED;
    TEST_ASSERT_FALSE_MESSAGE(decimal_read(text, length, &value), text);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(bits_of(UNTOUCHED), bits_of(value), text);
}

static void assert_writes(const char *expected, float value, uint16_t decimals)
{
    char text[DECIMAL_TEXT_MAX + 1U];
    size_t length = decimal_write(text, DECIMAL_TEXT_MAX, value, decimals);
    text[length] = '\0';
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static void assert_writes_shortest(const char *expected, float value)
{
    char text[DECIMAL_TEXT_MAX + 1U];
    size_t length = decimal_write_shortest(text, DECIMAL_TEXT_MAX, value);
    text[length] = '\0';
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

/* What decimal_read promises, told by strtof. */
static void assert_reads_as_strtof(const char *text)
{
    float expected = strtof(text, NULL);
    float value = UNTOUCHED;
    bool read = decimal_read(text, strlen(text), &value);

    TEST_ASSERT_EQUAL_MESSAGE(!isinf(expected), read, text);
    if (read) {
        expected = fabsf(expected) < FLT_MIN ? 0.0F : expected;
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(bits_of(expected), bits_of(value), text);
    }
}

/* The bit patterns are those of IEEE 754 binary32, computed by hand or taken from its definition. */
void test_known_numbers_read_to_known_bits(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x3DCCCCCDU, bits_of(read_ok("0.1")));
    TEST_ASSERT_EQUAL_HEX32(0xBF000000U, bits_of(read_ok("-0.5")));
    TEST_ASSERT_EQUAL_HEX32(0x3C75C28FU, bits_of(read_ok("0.015")));
    TEST_ASSERT_EQUAL_HEX32(0x413C28F6U, bits_of(read_ok("11.76")));
    TEST_ASSERT_EQUAL_HEX32(0x4B800000U, bits_of(read_ok("16777216")));
    TEST_ASSERT_EQUAL_HEX32(0x33D6BF95U, bits_of(read_ok("1e-7")));
    TEST_ASSERT_EQUAL_HEX32(0x7F7FFFFFU, bits_of(read_ok("3.4028234663852886e38")));
    TEST_ASSERT_EQUAL_HEX32(0x00800000U, bits_of(read_ok("1.1754943508222875e-38")));
}

void test_the_numbers_of_the_gains_read_as_the_compiler_reads_them(void)
{
    assert_reads(0.015F, "0.015");
    assert_reads(0.008F, "0.008");
    assert_reads(0.01F, "0.01");
    assert_reads(1e-3F, "1e-3");
    assert_reads(0.00018F, "0.00018");
    assert_reads(0.00466F, "0.00466");
    assert_reads(11.76F, "11.76");
    assert_reads(0.001F, "0.001");
    assert_reads(6.4F, "6.4");
}

void test_every_form_of_one_number_reads_the_same(void)
{
    static const char *const forms[] = {"12.5",         "+12.5",
                                        "012.5",        "12.50",
                                        "12.5e0",       "1.25e1",
                                        "1.25E+1",      "125e-1",
                                        "0.125e2",      ".125e+02",
                                        "0000.00125E4", "1250000e-5",
                                        "12.5e-0",      "12.5000000000000000000000000000000000000000"};
    for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++) {
        assert_reads(12.5F, forms[i]);
    }
    assert_reads(7.0F, "7.");
    assert_reads(-0.25F, "-.25");
}

void test_zero_has_no_sign_and_any_exponent(void)
{
    assert_reads(0.0F, "0");
    assert_reads(0.0F, "-0");
    assert_reads(0.0F, "-0.00");
    assert_reads(0.0F, "0e99999");
    assert_reads(0.0F, "-.0e-99999");
    assert_reads(0.0F, "0000000000000000000000000000000000000000000000000000000000000000000");
}

void test_what_is_no_number_is_refused_and_the_value_untouched(void)
{
    static const char *const junk[] = {
        "",      "+",     "-",    ".",   "-.",   "e5",       ".e5", "1e",   "1e+", "1e-", "1e5.",
        "1e5.0", "--1",   "+-1",  "1-",  "1..2", "1.2.3",    " 1",  "1 ",   "1 2", "\t1", "1\n",
        "nan",   "NAN",   "-nan", "inf", "-inf", "infinity", "ovf", "0x10", "1f",  "1F",  "1,5",
        "1e5e5", "1_000", "O.5",  "l",   "/",    ":",        "1/",  "1:"};
    for (size_t i = 0; i < sizeof junk / sizeof junk[0]; i++) {
        assert_refused(junk[i], strlen(junk[i]));
    }
    assert_refused("1\0002", 3U);
    assert_refused("12\0", 3U);
    assert_refused("\xB1\xB2", 2U);
}

void test_only_the_given_length_is_read(void)
{
    float value = 0.0F;
    TEST_ASSERT_TRUE(decimal_read("12.5e9", 3U, &value));
    TEST_ASSERT_EQUAL_FLOAT(12.0F, value);
    assert_refused("12.5e9", 5U);
    assert_refused("5", 0U);
}

void test_no_single_character_but_a_digit_is_a_number(void)
{
    for (uint16_t code = 0; code < 256; code++) {
        char text[1] = {(char)code};
        float value = UNTOUCHED;
        bool digit = code >= '0' && code <= '9';
        TEST_ASSERT_EQUAL(digit, decimal_read(text, 1U, &value));
        TEST_ASSERT_EQUAL_FLOAT(digit ? (float)(code - '0') : UNTOUCHED, value);
    }
}

void test_too_large_is_refused_from_the_midpoint_behind_the_largest_float_on(void)
{
    /* (2 - 2^-24) 2^127 = 340282356779733661637539395458142568448: the tie goes to the even side, which is
     * beyond. */
    assert_reads(FLT_MAX, "340282356779733661637539395458142568447");
    assert_reads(FLT_MAX, "340282356779733661637539395458142568447.9999999");
    assert_reads(-FLT_MAX, "-340282356779733661637539395458142568447");
    assert_reads(FLT_MAX, "34028235677973366163753939545814e7");
    assert_refused("34028235677973366163753939545815e7", 34U);
    assert_refused("3.4028238e38", 12U); /* 2^128 and three quarters of a unit of 24 bits */
    assert_refused("3.5e38", 6U);
    assert_refused("-1e39", 5U);
    assert_refused("1e999999999999999999999", 23U);
    assert_refused("0.00001e4294967297", 18U);
}

void test_too_small_reads_as_zero(void)
{
    assert_reads(FLT_MIN, "1.17549435e-38");
    assert_reads(FLT_MIN, "1.1754944e-38"); /* and three quarters of a unit of 24 bits */
    /* 2^-126 - 2^-151 = 1.175494316e-38 is where rounding to 24 bits turns */
    assert_reads(FLT_MIN, "1.17549432e-38");
    assert_reads(0.0F, "1.17549431e-38");
    assert_reads(0.0F, "1.1e-38");
    assert_reads(0.0F, "-9.9e-39");
    assert_reads(0.0F, "1e-45");
    assert_reads(0.0F, "1e-999999999999999999999");
    assert_reads(0.0F, "100000e-4294967297");
}

void test_ties_go_to_even_and_one_digit_far_behind_decides(void)
{
    assert_reads(16777216.0F, "16777217");
    assert_reads(16777220.0F, "16777219");
    assert_reads(16777218.0F, "16777217.000000000000000000000000000000000000000000000000000001");
    assert_reads(16777216.0F, "16777216.999999999999999999999999999999999999999999999999999999");
    assert_reads(16777216.0F, "167772.17e2");
    assert_reads(16777218.0F, "16777217000000000000000000000000000000000000000000000001e-48");
    assert_reads(1.0F, "1.000000059604644775390625"); /* 1 + 2^-24 */
    assert_reads(1.0F + FLT_EPSILON,
                 "1.0000000596046447753906250000000000000000000000000000000000000000000000000000000"
                 "000000000000000000000000000000000000000000000000000000000000000000000000000000001");
    assert_reads(1.0F - FLT_EPSILON / 2.0F, "0.999999940395355224609375");
    assert_reads(
        2.0F,
        "1.99999994039535522460937500000000000000000000000000000000000000000000000000000000000000000000000"
        "000000000000000000000000000000000000000000000001");
}

void test_zeros_far_behind_a_tie_leave_it_a_tie(void)
{
    assert_reads(1.0F, "1.0000000596046447753906250000000000000000000000");
    assert_reads(18446744073709551616.0F, "18446745173221179392"); /* 2^64 and half a unit */
    assert_reads(18446746272732807168.0F, "18446745173221244928"); /* and 2^16 more */
}

void test_a_tie_of_33_digits_is_read_as_what_lies_just_below_it(void)
{
    const float below = ldexpf(16681887.0F, -35);

    assert_reads(below, "0.000485506825498305261135101318359375");
    assert_reads(nextafterf(below, 1.0F), "0.00048550682549830526113510131835938");
}

void test_many_digits_before_the_point_are_counted(void)
{
    char text[400];

    memset(text, '0', sizeof text);
    text[0] = '3';
    memcpy(&text[300], "e-299", 6);
    assert_reads(3.0F, text);
    text[299] = '1';
    assert_reads(3.0F, text);
    memset(text, '9', 200);
    memcpy(&text[200], "e-200", 6);
    assert_reads(1.0F, text);
    memset(text, '0', sizeof text);
    text[1] = '.';
    memcpy(&text[300], "1e299", 6);
    assert_reads(1.0F, text);
}

void test_random_floats_in_many_forms_read_as_strtof_reads_them(void)
{
    char text[200];

    say_seed("forms");
    for (uint32_t i = 0; i < 100000UL; i++) {
        float value = float_of(random_bits());
        if (isfinite(value)) {
            (void)snprintf(text, sizeof text, "%.*e", (int)(random_bits() % 20U), (double)value);
            assert_reads_as_strtof(text);
        }
    }
}

void test_midpoints_between_neighbours_and_beside_them_read_as_strtof_reads_them(void)
{
    char text[200];

    say_seed("midpoints");
    for (uint32_t i = 0; i < 20000UL; i++) {
        float value = float_of(random_bits());
        float next = nextafterf(value, INFINITY);
        if (isfinite(value) && isfinite(next)) {
            double middle = ((double)value + (double)next) / 2.0;
            (void)snprintf(text, sizeof text, "%.*e", i % 2U == 0U ? 31 : (int)(7U + random_bits() % 25U),
                           middle);
            assert_reads_as_strtof(text);
        }
    }
}

/* Every place of the point, every number of digits that fits. */
void test_any_line_of_32_characters_reads_as_strtof_reads_it(void)
{
    say_seed("lines");
    for (uint32_t i = 0; i < 100000UL; i++) {
        char text[33];
        const size_t length = 1U + random_bits() % 32U;
        const size_t point = random_bits() % 33U;
        const size_t zeros = random_bits() % 4U == 0U ? random_bits() % length : 0U;

        for (size_t k = 0; k < length; k++) {
            text[k] = (char)(k < zeros ? '0' : '0' + (int)(random_bits() % 10U));
        }
        if (point < length && length > 1U) {
            text[point] = '.';
        }
        if (length > 6U && random_bits() % 2U == 0U) {
            (void)snprintf(&text[length - 4U], 5U, "e%+03d", (int)(random_bits() % 199U) - 99);
            text[length] = '\0';
        }
        text[length] = '\0';
        assert_reads_as_strtof(text);
    }
}

/* The smallest and the largest numbers with as many digits as are kept. */
void test_32_digits_at_the_ends_of_the_range_read_as_strtof_reads_them(void)
{
    static const char *const texts[] = {
        "99999999999999999999999999999999e-69", "10000000000000000000000000000000e-69",
        "11754943508222875079687365372222e-69", "34028235677973366163753939545814e7",
        "34028235677973366163753939545815e7",   "99999999999999999999999999999999e6",
        "10000000000000000000000000000000e7",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        assert_reads_as_strtof(texts[i]);
    }
}

/* A midpoint of up to 114 digits that is cut at 32 is told from its neighbours by less than one unit. */
void test_longer_texts_are_never_off_by_more_than_one_unit_in_the_last_place(void)
{
    char text[200];

    say_seed("long midpoints");
    for (uint32_t i = 0; i < 20000UL; i++) {
        const float low = float_of(random_bits() & 0x7FFFFFFFU);
        const float next = nextafterf(low, INFINITY);
        if (low >= FLT_MIN && isfinite(next)) {
            float value = UNTOUCHED;
            (void)snprintf(text, sizeof text, "%.120e", ((double)low + (double)next) / 2.0);
            TEST_ASSERT_TRUE(decimal_read(text, strlen(text), &value));
            TEST_ASSERT_TRUE_MESSAGE(bits_of(value) == bits_of(low) || bits_of(value) == bits_of(next), text);
        }
    }
}

void test_random_characters_never_read_as_anything_else_than_strtof_says(void)
{
    static const char alphabet[] = "0123456789.+-e";
    say_seed("characters");
    for (uint32_t i = 0; i < 100000UL; i++) {
        char text[12];
        size_t length = random_bits() % 9U;
        char *end;
        float value = UNTOUCHED;

        for (size_t k = 0; k < length; k++) {
            text[k] = alphabet[random_bits() % 14U];
        }
        text[length] = '\0';
        (void)strtof(text, &end);
        if (length == 0U || *end != '\0') {
            TEST_ASSERT_FALSE_MESSAGE(decimal_read(text, length, &value), text);
        } else {
            assert_reads_as_strtof(text);
        }
    }
}

void test_fixed_decimals_are_written_with_all_their_zeros(void)
{
    assert_writes("0.598", 0.598F, 3U);
    assert_writes("0.600", 0.6F, 3U);
    assert_writes("7.12", 7.12F, 2U);
    assert_writes("-12.500000", -12.5F, 6U);
    assert_writes("0", 0.0F, 0U);
    assert_writes("0.00", 0.0F, 2U);
    assert_writes("100", 100.0F, 0U);
    assert_writes("0.000001", 1e-6F, 6U);
    assert_writes("0.05", 0.05F, 2U);
    assert_writes("9.05", 9.05F, 2U);
    assert_writes("1024.0", 1024.0F, 1U);
}

void test_rounding_is_of_the_exact_binary_value_and_ties_go_away_from_zero(void)
{
    /* ties: exact in binary */
    assert_writes("0.13", 0.125F, 2U);
    assert_writes("-0.13", -0.125F, 2U);
    assert_writes("0.4", 0.375F, 1U);
    assert_writes("3", 2.5F, 0U);
    assert_writes("-3", -2.5F, 0U);
    assert_writes("1", 0.5F, 0U);
    assert_writes("4194303.8", 4194303.75F, 1U);
    /* 0.0005F is 0.00050000002.., 0.0025F is 0.00249999994.., 1.005F is 1.00499999523.., 0.055F
     * 0.05499999970.. */
    assert_writes("0.001", 0.0005F, 3U);
    assert_writes("0.002", 0.0025F, 3U);
    assert_writes("1.00", 1.005F, 2U);
    assert_writes("0.05", 0.055F, 2U);
    /* beside a tie */
    assert_writes("0", nextafterf(0.5F, 0.0F), 0U);
    assert_writes("0.12", nextafterf(0.125F, 0.0F), 2U);
    /* the carry runs through */
    assert_writes("1.00", 0.999F, 2U);
    assert_writes("10.0", 9.96F, 1U);
    assert_writes("4294967", 4294966.5F, 0U);
}

void test_a_result_of_zero_is_written_without_sign(void)
{
    assert_writes("0.000", -0.0F, 3U);
    assert_writes("0.000", -0.0004F, 3U);
    assert_writes("-0.001", -0.0006F, 3U);
    assert_writes("0", -0.25F, 0U);
    assert_writes("0.000000", FLT_MIN, 6U);
    assert_writes("0.000000", float_of(1U), 6U);
    assert_writes("0.000000", -float_of(0x007FFFFFU), 6U);
    assert_writes_shortest("0", -0.0F);
    assert_writes_shortest("0", 0.0F);
}

void test_what_cannot_be_written_gives_no_character(void)
{
    static const float refused[] = {4294967.0F, -4294967.0F, 1e9F,      FLT_MAX,
                                    -FLT_MAX,   INFINITY,    -INFINITY, NAN};
    char text[DECIMAL_TEXT_MAX];

    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        TEST_ASSERT_EQUAL(0U, decimal_write(text, DECIMAL_TEXT_MAX, refused[i], 2U));
        TEST_ASSERT_EQUAL(0U, decimal_write_shortest(text, DECIMAL_TEXT_MAX, refused[i]));
    }
    TEST_ASSERT_EQUAL(0U, decimal_write(text, DECIMAL_TEXT_MAX, 1.0F, 7U));
    TEST_ASSERT_EQUAL(0U, decimal_write_shortest(text, DECIMAL_TEXT_MAX, 9.9e-8F));
    TEST_ASSERT_EQUAL(0U, decimal_write_shortest(text, DECIMAL_TEXT_MAX, -FLT_MIN));
    assert_writes("-4294966.500000", -4294966.5F, 6U);
}

void test_nothing_is_written_beyond_the_capacity(void)
{
    static const float values[] = {-12.5F, 0.1F, 4294966.5F, 1e-7F, 0.0F};

    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        char whole[DECIMAL_TEXT_MAX];
        size_t fixed = decimal_write(whole, DECIMAL_TEXT_MAX, values[i], 3U);
        size_t shortest = decimal_write_shortest(whole, DECIMAL_TEXT_MAX, values[i]);

        for (size_t capacity = 0; capacity <= DECIMAL_TEXT_MAX; capacity++) {
            char text[DECIMAL_TEXT_MAX + 1U];

            memset(text, '~', sizeof text);
            TEST_ASSERT_EQUAL(capacity < fixed ? 0U : fixed, decimal_write(text, capacity, values[i], 3U));
            TEST_ASSERT_EQUAL_INT16('~', text[capacity]);
            memset(text, '~', sizeof text);
            TEST_ASSERT_EQUAL(capacity < shortest ? 0U : shortest,
                              decimal_write_shortest(text, capacity, values[i]));
            TEST_ASSERT_EQUAL_INT16('~', text[capacity]);
        }
    }
}

void test_fixed_texts_of_random_floats_are_those_of_the_exact_arithmetic(void)
{
    static const double power[] = {1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6};

    say_seed("fixed");
    for (uint32_t i = 0; i < 50000UL; i++) {
        /* exponents 2^-20 .. 2^21 */
        float value = float_of((random_bits() & 0x807FFFFFU) | ((107U + random_bits() % 42U) << 23));
        uint16_t decimals = (uint16_t)(random_bits() % 7U);
        char text[DECIMAL_TEXT_MAX + 1U];
        char expected[40];
        /* 24 bits times 10^6 are 44 bits: exact in a double, and so is the half added */
        double number = floor(fabs((double)value) * power[decimals] + 0.5) / power[decimals];

        (void)snprintf(expected, sizeof expected, "%s%.*f", value < 0.0F && number > 0.0 ? "-" : "",
                       (int)decimals, number);
        text[decimal_write(text, DECIMAL_TEXT_MAX, value, decimals)] = '\0';
        TEST_ASSERT_EQUAL_STRING(expected, text);
    }
}

void test_shortest_texts_of_the_gains_are_what_an_operator_types(void)
{
    assert_writes_shortest("0.015", 0.015F);
    assert_writes_shortest("0.008", 0.008F);
    assert_writes_shortest("0.01", 0.01F);
    assert_writes_shortest("0.001", 1e-3F);
    assert_writes_shortest("0.00018", 0.00018F);
    assert_writes_shortest("11.76", 11.76F);
    assert_writes_shortest("0.00466", 0.00466F);
    assert_writes_shortest("0.1", 0.1F);
    assert_writes_shortest("-0.5", -0.5F);
    assert_writes_shortest("0.0000001", 1e-7F);
    assert_writes_shortest("7", 7.0F);
    assert_writes_shortest("1000000", 1e6F);
    assert_writes_shortest("0.33333334", 1.0F / 3.0F);
    assert_writes_shortest("4294966.5", 4294966.5F);
}

static float random_writable(void)
{
    static const uint32_t first = 0x33D6BF95U; /* 1e-7F */
    static const uint32_t end = 0x4A83126EU;   /* 4294967 */
    return float_of((first + random_bits() % (end - first)) | (random_bits() & 0x80000000U));
}

static void assert_returns(float value)
{
    char text[DECIMAL_TEXT_MAX];
    size_t length = decimal_write_shortest(text, DECIMAL_TEXT_MAX, value);
    float back = UNTOUCHED;

    TEST_ASSERT_GREATER_THAN(0U, length);
    TEST_ASSERT_TRUE(decimal_read(text, length, &back));
    TEST_ASSERT_EQUAL_HEX32(bits_of(value), bits_of(back));
}

void test_the_ends_of_the_writable_range_are_what_they_are_said_to_be(void)
{
    assert_returns(float_of(0x33D6BF95U));
    TEST_ASSERT_EQUAL_HEX32(bits_of(1e-7F), 0x33D6BF95U);
    assert_returns(float_of(0x4A83126EU - 1U));
    TEST_ASSERT_EQUAL_HEX32(bits_of(4294967.0F), 0x4A83126EU);
}

void test_what_the_shortest_writer_writes_reads_back_to_the_same_bits(void)
{
    say_seed("round trip");
    for (uint32_t i = 0; i < 100000UL; i++) {
        assert_returns(random_writable());
    }
    for (uint32_t exponent = 104U; exponent < 149U; exponent++) {
        for (uint32_t k = 0; k < 3U; k++) {
            assert_returns(float_of((exponent << 23) - 1U + k));
        }
    }
}

/* Neither neighbour with one decimal less reads as the same float. */
static void assert_no_shorter_text(float value)
{
    char text[DECIMAL_TEXT_MAX];
    size_t length = decimal_write_shortest(text, DECIMAL_TEXT_MAX, value);
    const char *point = memchr(text, '.', length);
    int decimals = point == NULL ? 0 : (int)(text + length - point) - 1;

    TEST_ASSERT_TRUE(point == NULL || decimals > 0);
    for (int up = 0; decimals > 0 && up < 2; up++) {
        char shorter[40];
        double number = floor(fabs((double)value) * pow(10.0, decimals - 1)) + up;
        (void)snprintf(shorter, sizeof shorter, "%.0fe%d", number, 1 - decimals);
        TEST_ASSERT_TRUE_MESSAGE(strtof(shorter, NULL) != fabsf(value), shorter);
    }
}

void test_no_text_with_fewer_decimals_would_do(void)
{
    say_seed("shortest");
    for (uint32_t i = 0; i < 20000UL; i++) {
        assert_no_shorter_text(random_writable());
    }
    for (uint32_t exponent = 104U; exponent < 149U;
         exponent++) { /* the gap below a power of two is half the one above */
        assert_no_shorter_text(float_of(exponent << 23));
    }
}

void test_every_text_of_a_telecommand_number_survives_the_trip(void)
{
    char text[16];

    for (uint32_t thousandths = 0; thousandths < 12000UL; thousandths++) {
        char back[DECIMAL_TEXT_MAX + 1U];
        (void)snprintf(text, sizeof text, "%" PRIu32 ".%03" PRIu32, thousandths / 1000U, thousandths % 1000U);
        back[decimal_write(back, DECIMAL_TEXT_MAX, read_ok(text), 3U)] = '\0';
        TEST_ASSERT_EQUAL_STRING(text, back);
    }
}
