#include "drivers/telecommand.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

#pragma GCC diagnostic ignored "-Wmissing-prototypes" /* the generated runner declares the tests */

#define SEED 1977UL

static telecommand_collector_t collector;
static telecommand_t command;
static uint32_t random_state;

void setUp(void)
{
    memset(&collector, 0x5A, sizeof collector);
    memset(&command, 0x5A, sizeof command);
    telecommand_collector_init(&collector);
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

/* Feeds length octets; returns how many lines came. The latest stays in collector.line. */
static uint16_t feed_octets(const char *text, size_t length)
{
    uint16_t lines = 0;
    for (size_t i = 0; i < length; i++) {
        lines = (uint16_t)(lines + (telecommand_collect(&collector, octet_of((uint16_t)text[i])) ? 1U : 0U));
    }
    return lines;
}

static uint16_t feed(const char *text)
{
    return feed_octets(text, strlen(text));
}

static telecommand_status_t parse_line(const char *text)
{
    TEST_ASSERT_EQUAL_MESSAGE(1U, feed(text), text);
    return telecommand_parse(&collector.line, false, &command);
}

static void assert_command(const char *name, const char *argument)
{
    TEST_ASSERT_EQUAL(strlen(name), command.name_length);
    TEST_ASSERT_EQUAL(0, memcmp(name, command.name, strlen(name)));
    TEST_ASSERT_EQUAL(strlen(argument), command.argument_length);
    TEST_ASSERT_EQUAL(0, memcmp(argument, command.argument, strlen(argument)));
}

static void assert_parses(const char *text, const char *name, const char *argument)
{
    TEST_ASSERT_EQUAL_MESSAGE(TELECOMMAND_OK, parse_line(text), text);
    assert_command(name, argument);
}

static void assert_error(telecommand_status_t status, const char *text)
{
    TEST_ASSERT_EQUAL_MESSAGE(status, parse_line(text), text);
    TEST_ASSERT_EQUAL(0U, command.name_length);
    TEST_ASSERT_EQUAL(0U, command.argument_length);
}

void test_a_line_is_name_and_value(void)
{
    assert_parses("#SETR 0.6\n", "SETR", "0.6");
    assert_parses("#GET\n", "GET", "");
    assert_parses("#LAW PID\n", "LAW", "PID");
    assert_parses("#X 1\n", "X", "1");
    assert_parses("#Y\n", "Y", "");
    assert_parses("#Z  1 2 \n", "Z", "1 2");
    TEST_ASSERT_EQUAL(0U, collector.strays);
}

void test_the_collected_text_runs_from_the_sharp_to_before_the_line_end(void)
{
    TEST_ASSERT_EQUAL(1U, feed("#KP 0.015\r\n"));
    TEST_ASSERT_EQUAL(9U, collector.line.length);
    TEST_ASSERT_EQUAL(0, memcmp("#KP 0.015", collector.line.text, 9));
    TEST_ASSERT_FALSE(collector.line.overlong);
}

void test_lf_cr_and_cr_lf_end_one_line_each_and_cr_behind_lf_another(void)
{
    TEST_ASSERT_EQUAL(3U, feed("#A 1\n#B 2\r#C 3\r\n"));
    TEST_ASSERT_EQUAL(2U, feed("#D 4\n\r"));
    TEST_ASSERT_TRUE(collector.line.bare);
    TEST_ASSERT_EQUAL(1U, feed_octets("#E 5\r\0\n", 7U));
    TEST_ASSERT_EQUAL(2U, feed("#F 6\r\n\n")); /* one LF belongs to the CR, the next is a line */
    TEST_ASSERT_EQUAL(0U, collector.strays);
}

void test_a_line_without_a_sharp_is_bare_an_empty_one_too(void)
{
    static const char *const lines[] = {"KP 0.015\r\n", "stop\n", "\n", "\r\n", " \t \r", "x\x08\n"};

    for (uint16_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        assert_error(TELECOMMAND_BARE, lines[i]);
        TEST_ASSERT_EQUAL(0U, collector.line.length);
    }
    TEST_ASSERT_EQUAL(7U, feed("\r\n\r\n\n\r#E 5\r\r\n\n"));
    assert_parses("#KP 0.015\n", "KP", "0.015");
    TEST_ASSERT_FALSE(collector.line.bare);
}

void test_ctrl_c_drops_what_was_typed_and_is_a_bare_line_of_its_own(void)
{
    assert_error(TELECOMMAND_BARE, "\x03");
    assert_error(TELECOMMAND_BARE, "#SETR 0.6\x03");
    assert_error(TELECOMMAND_BARE, "#SETR 0.60000000000000000000000000000000000\x03");
    assert_parses("#GET\n", "GET", "");
}

void test_backspace_and_delete_take_back_one_character_each(void)
{
    assert_parses("#SETR 0.8\x08"
                  "6\n",
                  "SETR", "0.6");
    assert_parses("#KD\x7FP 0.2\x08\x08\x08"
                  "0.1\n",
                  "KP", "0.1");
    assert_error(TELECOMMAND_BARE, "#KP\x08\x08\x08\n");
    assert_error(TELECOMMAND_BARE, "\x08\x7F#\x08\x08KP 1\n");
    assert_error(TELECOMMAND_OVERLONG, "#KP 0.015000000000000000000000000\x08\x08\x08\n");
}

void test_the_line_is_complete_at_the_cr_and_still_there_after_the_lf(void)
{
    TEST_ASSERT_EQUAL(0U, feed("#SETR 0.6"));
    TEST_ASSERT_TRUE(telecommand_collect(&collector, '\r'));
    TEST_ASSERT_FALSE(telecommand_collect(&collector, '\n'));
    TEST_ASSERT_EQUAL(TELECOMMAND_OK, telecommand_parse(&collector.line, false, &command));
    assert_command("SETR", "0.6");
}

void test_blanks_and_tabs_around_name_and_value_do_not_matter(void)
{
    assert_parses("#SETR    0.6\n", "SETR", "0.6");
    assert_parses("#  SETR 0.6\n", "SETR", "0.6");
    assert_parses("#SETR 0.6   \r\n", "SETR", "0.6");
    assert_parses("#\tSETR\t0.6\t\n", "SETR", "0.6");
    assert_parses("# \t SETR \t 0.6 \t \n", "SETR", "0.6");
    assert_parses(" \t #GET\n", "GET", "");
    assert_parses("#GET \n", "GET", "");
    TEST_ASSERT_EQUAL(0U, collector.strays);
}

void test_lower_case_names_are_raised_and_values_kept_as_typed(void)
{
    assert_parses("#setr 0.6\n", "SETR", "0.6");
    assert_parses("#Law eSt\n", "LAW", "eSt");
    assert_parses("#az_09AZ 1e-3\n", "AZ_09AZ", "1e-3");
}

void test_blanks_inside_a_value_are_kept(void)
{
    assert_parses("#KP 0.015  0.2 x\n", "KP", "0.015  0.2 x");
}

void test_a_sharp_restarts_the_line(void)
{
    assert_parses("#SETR 0.#KP 0.015\n", "KP", "0.015");
    assert_parses("##GET\n", "GET", "");
    assert_parses("#KP 1 #\t#kd 2\n", "KD", "2");
}

void test_a_sharp_restarts_an_overlong_line_too(void)
{
    assert_parses("#SETR 0.600000000000000000000000000000000000#KP 2\n", "KP", "2");
}

void test_a_lone_sharp_is_empty(void)
{
    assert_error(TELECOMMAND_EMPTY, "#\n");
    assert_error(TELECOMMAND_EMPTY, "# \t \r\n");
}

void test_a_line_of_no_character_is_empty(void)
{
    telecommand_line_t line = {.length = 0U};
    TEST_ASSERT_EQUAL(TELECOMMAND_EMPTY, telecommand_parse(&line, false, &command));
}

void test_32_characters_are_a_line_and_33_are_too_many(void)
{
    assert_parses("#KP 0.01500000000000000000000000\n", "KP", "0.01500000000000000000000000");
    TEST_ASSERT_EQUAL(TELECOMMAND_LINE_MAX, collector.line.length);
    TEST_ASSERT_FALSE(collector.line.overlong);
    assert_error(TELECOMMAND_OVERLONG, "#KP 0.015000000000000000000000000\n");
    TEST_ASSERT_EQUAL(TELECOMMAND_LINE_MAX, collector.line.length);
    TEST_ASSERT_EQUAL(0,
                      memcmp("#KP 0.01500000000000000000000000", collector.line.text, TELECOMMAND_LINE_MAX));
}

void test_an_overlong_line_gives_one_error_and_the_next_line_is_whole(void)
{
    char text[600];

    memset(text, '7', sizeof text);
    memcpy(text, "#KP ", 4);
    TEST_ASSERT_EQUAL(0U, feed_octets(text, sizeof text));
    TEST_ASSERT_EQUAL(1U, feed("\r\n"));
    TEST_ASSERT_EQUAL(TELECOMMAND_OVERLONG, telecommand_parse(&collector.line, false, &command));
    TEST_ASSERT_EQUAL(0U, collector.strays);
    assert_parses("#KD 0.008\n", "KD", "0.008");
}

void test_trailing_blanks_do_not_make_a_line_too_long(void)
{
    assert_parses("#GET                             \n", "GET", "");
    assert_parses("#SETR 0                                     \n", "SETR", "0");
    assert_error(TELECOMMAND_OVERLONG, "#GET                             KP\n");
}

void test_text_of_any_length_and_kind_behind_a_stop_is_not_read(void)
{
    static const char *const lines[] = {"#LAND please come down now, it is odd\n", "#stop \xF1\x01\n",
                                        "#STOP 1234567890123456789012345678*0000\n",
                                        "# land                                 at once\n"};

    for (uint16_t i = 0U; i < sizeof lines / sizeof lines[0]; ++i) {
        TEST_ASSERT_EQUAL(1U, feed(lines[i]));
        TEST_ASSERT_TRUE(telecommand_is_urgent(&collector.line));
        TEST_ASSERT_EQUAL(TELECOMMAND_OK, telecommand_parse(&collector.line, true, &command));
        TEST_ASSERT_EQUAL(0U, command.argument_length);
    }
    assert_error(TELECOMMAND_OVERLONG, "#STOPS 12345678901234567890123456789\n");
    assert_error(TELECOMMAND_OVERLONG, "#SETR 0 please come down now, it is odd\n");
}

void test_nul_is_as_if_it_had_not_come(void)
{
    TEST_ASSERT_EQUAL(1U, feed_octets("\0#\0K\0P \0000.1\0\n\0", 14U));
    TEST_ASSERT_EQUAL(TELECOMMAND_OK, telecommand_parse(&collector.line, false, &command));
    assert_command("KP", "0.1");
    TEST_ASSERT_EQUAL(0U, collector.strays);
}

void test_what_is_outside_a_line_is_counted(void)
{
    TEST_ASSERT_EQUAL(1U, feed("KP 0.015\r\n")); /* 7 without the blank */
    TEST_ASSERT_EQUAL(7U, collector.strays);
    TEST_ASSERT_EQUAL(2U, feed("+++#GET\nx\x80\xFF\x01\t \r\n"));
    TEST_ASSERT_EQUAL(14U, collector.strays);
}

void test_characters_inside_a_line_are_no_strays(void)
{
    TEST_ASSERT_EQUAL(1U, feed("#KP 0.1\x80\n"));
    TEST_ASSERT_EQUAL(0U, collector.strays);
}

void test_control_and_high_characters_are_refused_wherever_they_stand(void)
{
    for (uint16_t code = 1; code < 256; code++) {
        bool legible = code == '\t' || (code >= 0x20 && code <= 0x7E);
        for (uint16_t place = 1; place < 8; place++) {
            char text[] = "#KP 0.1 \n";
            if (strchr("\n\r#\x03\x08\x7F", (int)code) != NULL) {
                continue;
            }
            text[place] = (char)code;
            (void)feed(text);
            if (!legible) {
                TEST_ASSERT_EQUAL(TELECOMMAND_CHARACTER, telecommand_parse(&collector.line, false, &command));
                TEST_ASSERT_EQUAL(0U, command.name_length);
                TEST_ASSERT_EQUAL(0U, command.argument_length);
            } else if (place > 3U) {
                TEST_ASSERT_EQUAL(TELECOMMAND_OK, telecommand_parse(&collector.line, false, &command));
            }
        }
    }
}

void test_names_are_letters_digits_and_underscore_only(void)
{
    for (uint16_t code = 0x21; code <= 0x7E; code++) {
        char text[] = "#K?P 1\n";
        bool name = (code >= 'A' && code <= 'Z') || (code >= 'a' && code <= 'z') ||
                    (code >= '0' && code <= '9') || code == '_';
        if (code == '#') {
            continue;
        }
        text[2] = (char)code;
        if (name) {
            TEST_ASSERT_EQUAL(TELECOMMAND_OK, parse_line(text));
            TEST_ASSERT_EQUAL(3U, command.name_length);
        } else {
            assert_error(TELECOMMAND_CHARACTER, text);
        }
    }
    assert_error(TELECOMMAND_CHARACTER, "#KP=0.015\n");
    assert_error(TELECOMMAND_CHARACTER, "#-1\n");
}

void test_a_name_that_is_too_long_is_cut_and_the_value_kept(void)
{
    assert_parses("#ABCDEFGHIJKL 1\n", "ABCDEFGHIJKL", "1");
    assert_parses("#ABCDEFGHIJKLMNOPQ 2\n", "ABCDEFGHIJKL", "2");
    assert_parses("#ABCDEFGHIJKLMNOPQRSTUVWXYZ01234\n", "ABCDEFGHIJKL", "");
}

void test_lines_in_one_breath_are_all_kept(void)
{
    static const char *const names[] = {"SETR", "KP", "KD", "KI", "USAT", "DSAT", "GRAV"};
    const char *text = "#SETR 1\r\n#KP 1\r\n#KD 1\r\n#KI 1\r\n#USAT 1\r\n#DSAT 1\r\n#GRAV 1\r\n";
    uint16_t lines = 0;

    for (; *text != '\0'; text++) {
        if (telecommand_collect(&collector, (octet_t)*text)) {
            TEST_ASSERT_EQUAL(TELECOMMAND_OK, telecommand_parse(&collector.line, false, &command));
            assert_command(names[lines], "1");
            lines++;
        }
    }
    TEST_ASSERT_EQUAL(7U, lines);
}

void test_a_broken_line_is_damaged_and_parses_to_nothing(void)
{
    TEST_ASSERT_EQUAL(0U, feed("#SETR "));
    telecommand_collector_broken(&collector);
    TEST_ASSERT_EQUAL(1U, feed("3\n"));
    TEST_ASSERT_TRUE(collector.line.damaged);
    TEST_ASSERT_EQUAL(TELECOMMAND_DAMAGED, telecommand_parse(&collector.line, false, &command));
    TEST_ASSERT_EQUAL(0U, command.name_length);
    TEST_ASSERT_EQUAL(0U, command.argument_length);
    assert_parses("#SETR 0.3\n", "SETR", "0.3");
}

void test_damage_is_told_before_any_other_fault(void)
{
    static const char *const rests[] = {"\n", "\x01\n", "KP=1\n", "PING 123456789 123456789 123456789\n"};

    for (uint16_t i = 0; i < sizeof rests / sizeof rests[0]; i++) {
        TEST_ASSERT_EQUAL(0U, feed("#"));
        telecommand_collector_broken(&collector);
        assert_error(TELECOMMAND_DAMAGED, rests[i]);
    }
}

void test_a_sharp_begins_an_undamaged_line(void)
{
    TEST_ASSERT_EQUAL(0U, feed("#SETR 0."));
    telecommand_collector_broken(&collector);
    assert_parses("#KP 0.1\n", "KP", "0.1");
}

void test_what_is_lost_between_lines_harms_none(void)
{
    telecommand_collector_broken(&collector);
    assert_parses("#KP 0.1\n", "KP", "0.1");
    telecommand_collector_broken(&collector);
    assert_error(TELECOMMAND_BARE, "\n");
    TEST_ASSERT_EQUAL(0U, feed("noise"));
    telecommand_collector_broken(&collector);
    assert_parses(" #KP 0.1\n", "KP", "0.1");
}

void test_a_new_collector_holds_no_damage(void)
{
    TEST_ASSERT_EQUAL(0U, feed("#KP 0."));
    telecommand_collector_broken(&collector);
    telecommand_collector_init(&collector);
    TEST_ASSERT_EQUAL(1U, feed("1\n"));
    assert_parses("#KP 0.1\n", "KP", "0.1");
}

/* Any octet lost, told by the UART at the same place: no other command may come of it. */
void test_a_line_that_lost_any_run_of_octets_never_parses(void)
{
    static const char text[] = "#SETR 0.3";
    const uint16_t length = (uint16_t)strlen(text);

    for (uint16_t from = 1; from < length; from++) {
        for (uint16_t to = (uint16_t)(from + 1U); to <= length; to++) {
            TEST_ASSERT_EQUAL(0U, feed_octets(text, from));
            telecommand_collector_broken(&collector);
            TEST_ASSERT_EQUAL(0U, feed_octets(&text[to], (size_t)(length - to)));
            TEST_ASSERT_TRUE(telecommand_collect(&collector, '\n'));
            TEST_ASSERT_EQUAL(TELECOMMAND_DAMAGED, telecommand_parse(&collector.line, false, &command));
        }
    }
}

void test_ten_thousand_random_octets_lose_no_later_command(void)
{
    printf("random octets: seed %lu\n", SEED);
    for (uint32_t i = 0; i < 10000UL; i++) {
        if (telecommand_collect(&collector, octet_of((uint16_t)random_bits()))) {
            TEST_ASSERT_TRUE(collector.line.bare || collector.line.text[0] == '#');
            TEST_ASSERT_LESS_OR_EQUAL(TELECOMMAND_LINE_MAX, collector.line.length);
            (void)telecommand_parse(&collector.line, false, &command);
        }
        if (i % 100U == 0U) {
            assert_parses("#KP 0.015\r\n", "KP", "0.015");
        }
    }
    TEST_ASSERT_GREATER_THAN(1000U, collector.strays);
}

/* Lines of the command alphabet: whatever is accepted is a clean name and a trimmed value that stand in the
 * line. */
void test_every_accepted_line_has_a_clean_name_and_a_trimmed_value(void)
{
    static const char alphabet[] = "# \tKpz_9.-e@=\x08";
    uint16_t accepted = 0;

    printf("random lines: seed %lu\n", SEED);
    for (uint32_t i = 0; i < 20000UL; i++) {
        uint16_t length = (uint16_t)(random_bits() % 36U);

        (void)telecommand_collect(&collector, '#');
        for (uint16_t k = 0; k < length; k++) {
            (void)telecommand_collect(&collector, octet_of((uint16_t)alphabet[random_bits() % 14U]));
        }
        TEST_ASSERT_TRUE(telecommand_collect(&collector, '\n'));
        if (telecommand_parse(&collector.line, false, &command) == TELECOMMAND_OK) {
            accepted++;
            TEST_ASSERT_FALSE(collector.line.overlong);
            TEST_ASSERT_TRUE(command.name_length >= 1U && command.name_length <= TELECOMMAND_NAME_MAX);
            for (uint16_t k = 0; k < command.name_length; k++) {
                TEST_ASSERT_NOT_NULL(strchr("KPZ_9E", command.name[k]));
            }
            if (command.argument_length > 0U) {
                TEST_ASSERT_NULL(strchr(" \t", command.argument[0]));
                TEST_ASSERT_NULL(strchr(" \t", command.argument[command.argument_length - 1U]));
            }
        }
    }
    TEST_ASSERT_GREATER_THAN(100U, accepted);
}

void test_a_stop_a_landing_and_a_reference_of_zero_are_urgent_however_written(void)
{
    static const char *const urgent[] = {
        "#STOP\n",     "# stop now \n", "#LAND\r",         "#land\n",
        "#SETR 0\n",   "#setr 0.0\n",   "#SETR -0\n",      "#SETR +.000\n",
        "#SETR 00.\n", "noise #STOP\n", "#SETR 0.#LAND\n", "#STOP 1234567890123456789012345678\n"};
    static const char *const others[] = {"#SETR 0.6\n",   "#SETR\n",     "#SETR .\n",   "#SETR -\n",
                                         "#SETR 0.0.0\n", "#SETR 0 1\n", "#SETR 0-\n",  "#STOPS\n",
                                         "#STO\n",        "#LANDING\n",  "#SETRX 0\n",  "#KP 0\n",
                                         "STOP\n",        "\n",          "#LOG STOP\n", "#STOP\x01\n"};

    for (uint16_t i = 0; i < sizeof urgent / sizeof urgent[0]; i++) {
        TEST_ASSERT_EQUAL(1U, feed(urgent[i]));
        TEST_ASSERT_TRUE_MESSAGE(telecommand_is_urgent(&collector.line), urgent[i]);
    }
    for (uint16_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        TEST_ASSERT_EQUAL(1U, feed(others[i]));
        TEST_ASSERT_FALSE_MESSAGE(telecommand_is_urgent(&collector.line), others[i]);
    }
}

void test_an_empty_line_behind_a_damaged_one_is_not_damaged(void)
{
    TEST_ASSERT_EQUAL(0U, feed("#A"));
    telecommand_collector_broken(&collector);
    TEST_ASSERT_EQUAL(TELECOMMAND_DAMAGED, parse_line("\n"));
    TEST_ASSERT_EQUAL(TELECOMMAND_BARE, parse_line("\n"));
}

void test_a_line_taken_back_to_its_sharp_goes_on(void)
{
    assert_parses("#KO\x08\x08STOP\n", "STOP", "");
}

void test_what_an_earlier_line_left_in_memory_is_not_read(void)
{
    assert_parses("#ABCD EFGHIJKLMNOP\n", "ABCD", "EFGHIJKLMNOP");
    assert_parses("#KP 1\n", "KP", "1");
    assert_error(TELECOMMAND_EMPTY, "#\n");
    assert_parses("#Y\n", "Y", "");
}

void test_a_damaged_line_is_never_urgent(void)
{
    TEST_ASSERT_EQUAL(0U, feed("#SETR "));
    telecommand_collector_broken(&collector);
    TEST_ASSERT_EQUAL(1U, feed("0\n"));
    TEST_ASSERT_FALSE(telecommand_is_urgent(&collector.line));
}

/* Sums by CRC-16/IBM-3740 of the CRC RevEng catalogue, whose check value is 29B1 for "123456789"; these by
 * Python's binascii.crc_hqx(text, 0xFFFF). */
static telecommand_status_t parse_with_sum(const char *text, bool required)
{
    telecommand_line_t line = {.length = (uint16_t)strlen(text)};

    memcpy(line.text, text, line.length);
    return telecommand_parse(&line, required, &command);
}

void test_a_line_with_its_sum_is_the_line_without_it(void)
{
    static const char *const lines[] = {"#SETR 0.6*9383", "#setr 0.6*BBA1", "#KP 0.015 *7FE5"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(TELECOMMAND_OK, parse_with_sum(lines[i], true), lines[i]);
        TEST_ASSERT_EQUAL_INT_MESSAGE(TELECOMMAND_OK, parse_with_sum(lines[i], false), lines[i]);
    }
    TEST_ASSERT_EQUAL_UINT16(5, command.argument_length);
    TEST_ASSERT_EQUAL_CHAR_ARRAY("0.015", command.argument, 5);
    TEST_ASSERT_EQUAL_UINT16(2, command.name_length);
}

void test_each_changed_character_of_a_line_with_a_sum_is_found(void)
{
    static const char good[] = "#GRAV 6.4*CD04";
    TEST_ASSERT_EQUAL_INT(TELECOMMAND_OK, parse_with_sum(good, true));
    for (size_t at = 1; at < strlen(good); at++) {
        for (int bit = 0; bit < 7; bit++) {
            char bad[] = "#GRAV 6.4*CD04";
            telecommand_status_t status;

            bad[at] = (char)(bad[at] ^ (1 << bit));
            status = parse_with_sum(bad, true);
            if (at > strlen("#GRAV 6.4*") - 1 && (bad[at] ^ 0x20) == good[at] && good[at] >= 'A') {
                continue; /* the other case of a digit */
            }
            TEST_ASSERT_NOT_EQUAL_MESSAGE(TELECOMMAND_OK, status, bad);
            TEST_ASSERT_EQUAL_UINT16(0, command.name_length);
            TEST_ASSERT_EQUAL_UINT16(0, command.argument_length);
        }
    }
    TEST_ASSERT_EQUAL_INT(TELECOMMAND_SUM_WRONG, parse_with_sum("#GRAV 6.5*CD04", false));
}

void test_a_missing_sum_is_refused_only_where_one_is_required(void)
{
    TEST_ASSERT_EQUAL_INT(TELECOMMAND_SUM_MISSING, parse_with_sum("#GRAV 6.4", true));
    TEST_ASSERT_EQUAL_INT(TELECOMMAND_SUM_MISSING, parse_with_sum("#PING *12", true));
    TEST_ASSERT_EQUAL_INT(TELECOMMAND_SUM_MISSING, parse_with_sum("#PING *12G4", true));
    TEST_ASSERT_EQUAL_INT(TELECOMMAND_OK, parse_with_sum("#PING *12G4", false));
    TEST_ASSERT_EQUAL_UINT16(5, command.argument_length);
    TEST_ASSERT_EQUAL_INT(TELECOMMAND_EMPTY, parse_with_sum("#*1234", true));
}

void test_a_stop_needs_no_sum_and_minds_no_wrong_one(void)
{
    static const char *const stops[] = {"#STOP",      "#LAND",        "#SETR 0",  "#STOP*0000",
                                        "#LAND*FFFF", "#SETR 0*1234", "#SETR 0.0"};
    for (size_t i = 0; i < sizeof stops / sizeof stops[0]; i++) {
        telecommand_line_t line = {.length = (uint16_t)strlen(stops[i])};

        memcpy(line.text, stops[i], line.length);
        TEST_ASSERT_EQUAL_INT_MESSAGE(TELECOMMAND_OK, telecommand_parse(&line, true, &command), stops[i]);
        TEST_ASSERT_TRUE_MESSAGE(telecommand_is_urgent(&line), stops[i]);
    }
    TEST_ASSERT_EQUAL_INT(TELECOMMAND_SUM_MISSING, parse_with_sum("#SETR 0.6", true));
}

void test_only_letters_a_to_z_have_an_upper_case(void)
{
    static const char other[] = "AZ09@[`{_- ~";

    TEST_ASSERT_EQUAL_CHAR('A', telecommand_upper('a'));
    TEST_ASSERT_EQUAL_CHAR('M', telecommand_upper('m'));
    TEST_ASSERT_EQUAL_CHAR('Z', telecommand_upper('z'));
    for (size_t i = 0U; other[i] != '\0'; i++) {
        TEST_ASSERT_EQUAL_CHAR(other[i], telecommand_upper(other[i]));
    }
}
