/* What a record, a row and a line tell of the beams, and that "not known" stays so on every way. */
#include "drivers/flight_beams.h"

#include <math.h>
#include <string.h>

#include "unity.h"

static flight_beams_t beams;
static telemetry_line_t line;

/* One mirror: the two others, and whether it lies, are not known. */
void setUp(void)
{
    beams = flight_beams_none();
    beams.beam[FLIGHT_BEAM_F] = (flight_beam_t){35.0F, 612.4F, 9.0F, 82500.0F, NAN};
}

void tearDown(void) {}

/* Three: the aft one blocked and taken for a liar, the fore one without rays. */
static void three(void)
{
    beams.beam[FLIGHT_BEAM_F].lie = 0.0004F;
    beams.beam[FLIGHT_BEAM_1] = (flight_beam_t){8.0F, 131.0F, 4.0F, 107000.0F, 0.992F};
    beams.beam[FLIGHT_BEAM_2] = (flight_beam_t){1.0F, NAN, NAN, NAN, 0.25F};
    beams.left_out = 1U << FLIGHT_BEAM_1;
}

static flight_beams_t recorded(void)
{
    uint16_t cells[FLIGHT_BEAMS_CELLS];

    memset(cells, 0x5A, sizeof cells);
    flight_beams_pack(cells, &beams);
    return flight_beams_unpack(cells);
}

static void assert_unknown(const flight_beam_t *beam)
{
    TEST_ASSERT_TRUE(isnan(beam->rays) && isnan(beam->slant_mm) && isnan(beam->spread_mm) &&
                     isnan(beam->age_us) && isnan(beam->lie));
}

static void assert_text(const char *expected)
{
    TEST_ASSERT_FALSE(line.overflowed);
    TEST_ASSERT_EQUAL(strlen(expected), line.length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, line.text, line.length);
}

static void assert_line(const char *expected)
{
    flight_beams_line(&line, &beams);
    assert_text(expected);
}

void test_with_one_mirror_the_others_and_the_vote_are_not_known_and_never_zero(void)
{
    const flight_beams_t kept = recorded();

    TEST_ASSERT_EQUAL_FLOAT(35.0F, kept.beam[FLIGHT_BEAM_F].rays);
    TEST_ASSERT_TRUE(isnan(kept.beam[FLIGHT_BEAM_F].lie));
    assert_unknown(&kept.beam[FLIGHT_BEAM_1]);
    assert_unknown(&kept.beam[FLIGHT_BEAM_2]);
    assert_line("mf:35,612,9,83,- m1:- m2:- out:-\r\n");
}

void test_where_nothing_is_known_nothing_is_told(void)
{
    beams = flight_beams_none();
    const flight_beams_t kept = recorded();

    assert_unknown(&kept.beam[FLIGHT_BEAM_F]);
    TEST_ASSERT_EQUAL_UINT16(0U, kept.left_out);
    assert_line("mf:- m1:- m2:- out:-\r\n");
}

void test_a_mirror_without_a_slant_tells_how_many_rays_it_has_and_no_more(void)
{
    beams.beam[FLIGHT_BEAM_F] = (flight_beam_t){0.0F, NAN, NAN, NAN, NAN};
    const flight_beams_t kept = recorded();

    TEST_ASSERT_EQUAL_FLOAT(0.0F, kept.beam[FLIGHT_BEAM_F].rays);
    TEST_ASSERT_TRUE(isnan(kept.beam[FLIGHT_BEAM_F].slant_mm) && isnan(kept.beam[FLIGHT_BEAM_F].age_us));
    assert_line("mf:0,-,-,-,- m1:- m2:- out:-\r\n");
}

void test_of_three_mirrors_it_is_told_who_is_left_out_and_how_probably_each_lies(void)
{
    three();
    assert_line("mf:35,612,9,83,0 m1:8,131,4,107,99 m2:1,-,-,-,25 out:m1\r\n");
}

void test_a_record_keeps_what_it_can_hold(void)
{
    three();
    const flight_beams_t kept = recorded();

    TEST_ASSERT_EQUAL_UINT16(1U << FLIGHT_BEAM_1, kept.left_out);
    for (uint16_t m = 0U; m < FLIGHT_BEAM_COUNT; m++) {
        const flight_beam_t *a = &beams.beam[m];
        const flight_beam_t *b = &kept.beam[m];

        TEST_ASSERT_EQUAL_FLOAT(a->rays, b->rays);
        TEST_ASSERT_TRUE(isnan(a->slant_mm) ? isnan(b->slant_mm) : fabsf(a->slant_mm - b->slant_mm) <= 0.5F);
        TEST_ASSERT_TRUE(isnan(a->spread_mm) ? isnan(b->spread_mm) : a->spread_mm == b->spread_mm);
        TEST_ASSERT_TRUE(isnan(a->age_us) ? isnan(b->age_us) : fabsf(a->age_us - b->age_us) <= 2000.0F);
        TEST_ASSERT_FLOAT_WITHIN(0.036F, a->lie, b->lie);
    }
}

/* A number that is too large for its place must not become "not known", nor another number. */
void test_every_slant_spread_age_and_count_is_kept_or_limited(void)
{
    for (uint32_t n = 0U; n < 6000U; n++) {
        const flight_beam_t told = {(float)(n % 100U), (float)n, (float)(n % 512U), (float)n * 100.0F,
                                    (float)(n % 15U) / 14.0F};

        beams = flight_beams_none();
        beams.beam[n % 3U] = told;
        const flight_beams_t kept = recorded();
        const flight_beam_t *beam = &kept.beam[n % 3U];

        TEST_ASSERT_EQUAL_FLOAT(fminf(told.rays, 62.0F), beam->rays);
        TEST_ASSERT_EQUAL_FLOAT(fminf(fmaxf(told.slant_mm, 1.0F), 4095.0F), beam->slant_mm);
        TEST_ASSERT_EQUAL_FLOAT(fminf(told.spread_mm, 254.0F), beam->spread_mm);
        TEST_ASSERT_FLOAT_WITHIN(2000.0F, fminf(told.age_us, 248000.0F), beam->age_us);
        TEST_ASSERT_FLOAT_WITHIN(0.001F, told.lie, beam->lie);
        assert_unknown(&kept.beam[(n + 1U) % 3U]);
        assert_unknown(&kept.beam[(n + 2U) % 3U]);
    }
}

void test_the_columns_are_whole_numbers_and_empty_where_nothing_is_known(void)
{
    three();
    telemetry_begin_answer(&line);
    flight_beams_titles(&line, FLIGHT_BEAM_1);
    flight_beams_columns(&line, &beams.beam[FLIGHT_BEAM_1]);
    flight_beams_columns(&line, &beams.beam[FLIGHT_BEAM_2]);
    assert_text(",m1_rays,m1_mm,m1_spread_mm,m1_ms,m1_lie,8,131,4,107,99,1,,,,25");
}

void test_the_longest_line_fits_a_radio_packet(void)
{
    for (uint16_t m = 0U; m < FLIGHT_BEAM_COUNT; m++) {
        beams.beam[m] = (flight_beam_t){62.0F, 1e9F, 1e9F, 4e9F, 1.0F};
    }
    beams.left_out = 7U;
    assert_line("mf:62,4095,4095,999,100 m1:62,4095,4095,999,100 m2:62,4095,4095,999,100 out:mf+m1+m2\r\n");
}

void test_every_set_of_mirrors_has_its_names(void)
{
    static const char *const one[] = {"mf", "m1", "m2"};

    for (uint16_t set = 0U; set < 8U; set++) {
        for (uint16_t m = 0U; m < FLIGHT_BEAM_COUNT; m++) {
            const bool named = strstr(flight_beams_names(set), one[m]) != NULL;

            TEST_ASSERT_EQUAL(((unsigned)set & (1U << m)) != 0U, named);
        }
    }
}
