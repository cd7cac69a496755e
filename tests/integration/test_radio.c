/* The operator's side of the running firmware: what is typed on the radio and what comes back. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "firmware/probe.h"
#include "sim/noise.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

typedef struct {
    child_terminal_t terminal;
    float at_s[CHILD_TERMINAL_MAX]; /* when each character came */
    parameters_t parameters;
    float reference_m;
    double sent_s;
} talk_t;

static talk_t talk;

static void take(void *terminal, unsigned octet)
{
    talk_t *t = terminal;

    t->at_s[t->terminal.length] = (float)timeline_now() * 1e-9F;
    child_terminal_take(&t->terminal, octet);
}

typedef struct {
    const char *text;
    size_t count;
    double spacing_s; /* between lines; 0: as fast as the link goes */
    double listen_s;
} script_t;

static void run_script(void *argument, void *result)
{
    const script_t *script = argument;
    talk_t *t = result;
    board_config_t config = board_config(1);
    const char *next = script->text, *end = script->text + script->count;

    board_power_on(&config, take, t);
    kernel_run_until(500 * SIM_MS);
    while (next < end) {
        const char *lf = memchr(next, '\n', (size_t)(end - next));
        size_t count = script->spacing_s > 0.0 && lf != NULL ? (size_t)(lf - next) + 1 : (size_t)(end - next);

        count = count > 64 && script->spacing_s <= 0.0 ? 64 : count;
        board_type(next, count);
        next += count;
        kernel_run_until(timeline_now() + (sim_time_t)(script->spacing_s > 0.0 ? script->spacing_s * 1e9
                                                                               : (double)count * 1.05e6));
    }
    t->sent_s = (double)timeline_now() * 1e-9;
    kernel_run_until(timeline_now() + (sim_time_t)(script->listen_s * 1e9));
    t->parameters = *probe_parameters;
    t->reference_m = probe_reference->reference_m;
    if (kernel_halt_reason() != NULL) {
        abort();
    }
}

static void type(const char *text, size_t count, double spacing_s, double listen_s)
{
    script_t script = {text, count, spacing_s, listen_s};

    memset(&talk, 0, sizeof talk);
    child_run(run_script, &script, &talk, sizeof talk);
}

static void type_line(const char *text)
{
    type(text, strlen(text), 0.0, 1.0);
}

static bool answered(const char *line)
{
    char needle[128];

    snprintf(needle, sizeof needle, "%s\r\n", line);
    for (const char *found = strstr(talk.terminal.text, needle); found != NULL;
         found = strstr(found + 1, needle)) {
        if (found == talk.terminal.text || found[-1] == '\n') {
            return true;
        }
    }
    return false;
}

static int count_of(const char *prefix)
{
    int count = strncmp(talk.terminal.text, prefix, strlen(prefix)) == 0;
    char needle[64];

    snprintf(needle, sizeof needle, "\n%s", prefix);
    for (const char *found = strstr(talk.terminal.text, needle); found != NULL;
         found = strstr(found + 1, needle)) {
        count++;
    }
    return count;
}

static void assert_nothing_changed(void)
{
    parameters_t untouched;

    parameters_init(&untouched);
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        TEST_ASSERT_EQUAL_FLOAT(untouched.value[i], talk.parameters.value[i]);
    }
    TEST_ASSERT_EQUAL_UINT32(untouched.generation, talk.parameters.generation);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, talk.reference_m);
}

void test_radio_and_telemetry_live_during_the_sensor_wait(void)
{
    type_line("#PING 42\n");
    TEST_ASSERT_TRUE(answered("OK PING 42"));
    TEST_ASSERT_TRUE(answered("alt:- ref:0.000 laser:WAIT thr:0.00 state:GROUND flags:3") ||
                     answered("alt:- ref:0.000 laser:WAIT thr:0.00 state:GROUND flags:1"));
}

void test_every_command_of_annex_ii_takes_effect_and_is_answered(void)
{
    type_line("#LAW PID\n#KP 0.02\n#KD 0.009\n#KI 0.00\n#USAT 1.5\n#DSAT 0.25\n#GRAV 6.4\n#SETR 0.5\n");
    TEST_ASSERT_TRUE(answered("OK KP 0.02"));
    TEST_ASSERT_TRUE(answered("OK KD 0.009"));
    TEST_ASSERT_TRUE(answered("OK KI 0"));
    TEST_ASSERT_TRUE(answered("OK USAT 1.5"));
    TEST_ASSERT_TRUE(answered("OK DSAT 0.25"));
    TEST_ASSERT_TRUE(answered("OK GRAV 6.4"));
    TEST_ASSERT_TRUE(answered("OK SETR 0.5"));
    TEST_ASSERT_EQUAL_FLOAT(0.02F, talk.parameters.value[PARAMETER_KP]);
    TEST_ASSERT_EQUAL_FLOAT(6.4F, talk.parameters.value[PARAMETER_GRAV]);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, talk.reference_m);
}

void test_choices_blanks_lower_case_and_crlf_are_accepted(void)
{
    type_line("  #  law   pd  \r\n#release\tscan\r#kp 0.01\r\n");
    TEST_ASSERT_TRUE(answered("OK LAW PD"));
    TEST_ASSERT_TRUE(answered("OK RELEASE SCAN"));
    TEST_ASSERT_TRUE(answered("OK KP 0.01"));
    TEST_ASSERT_EQUAL_INT(3, count_of("OK "));
    TEST_ASSERT_EQUAL_INT(0, count_of("ERR "));
}

void test_bad_values_are_refused_by_name_and_change_nothing(void)
{
    type_line("#KP nan\n#KP 1e9\n#SETR -1\n#KP\n#KP 0.01x\n#LAW XYZ\n#FOO 1\n#GET FOO\n#\n#KP inf\n");
    TEST_ASSERT_EQUAL_INT(10, count_of("ERR "));
    TEST_ASSERT_EQUAL_INT(0, count_of("OK "));
    TEST_ASSERT_TRUE(answered("ERR KP not a number"));
    TEST_ASSERT_TRUE(answered("ERR KP value missing"));
    TEST_ASSERT_TRUE(answered("ERR LAW one of PD|PID|PIDT|EST"));
    TEST_ASSERT_TRUE(answered("ERR FOO unknown command, try #HELP"));
    TEST_ASSERT_TRUE(answered("ERR - empty command"));
    assert_nothing_changed();
}

void test_a_half_line_is_restarted_and_an_overlong_one_costs_one_error(void)
{
    type_line("#LAW PD\n#KP 0.0#KP 0.01\n#KP 0.00000000000000000000000000000000001\n#KD 0.001\n");
    TEST_ASSERT_TRUE(answered("OK KP 0.01"));
    TEST_ASSERT_TRUE(answered("ERR - line too long"));
    TEST_ASSERT_TRUE(answered("OK KD 0.001"));
    TEST_ASSERT_EQUAL_INT(1, count_of("ERR "));
    TEST_ASSERT_EQUAL_INT(3, count_of("OK "));
}

void test_get_alone_lists_every_parameter_once(void)
{
    char line[64];

    type("#GET\n", 5, 0.0, 2.0);
    TEST_ASSERT_EQUAL_INT(PARAMETER_COUNT + 2, count_of("OK ")); /* the reference, the end */
    TEST_ASSERT_TRUE(answered("OK KP 0.015"));
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        snprintf(line, sizeof line, "OK %s ", parameter_table[i].name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, count_of(line), line);
    }
}

#define HELP_S 9.0 /* 5.2 kB at 9600 bit/s, beside 360 octets of other lines in a second */

void test_help_names_every_parameter_and_verb(void)
{
    char line[64];

    type("#HELP\n", 6, 0.0, HELP_S);
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        snprintf(line, sizeof line, "OK HELP #%s ", parameter_table[i].name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, count_of(line), line);
    }
    TEST_ASSERT_EQUAL_INT(1, count_of("OK HELP #PING "));
    TEST_ASSERT_EQUAL_INT(0, count_of("ERR "));
}

#define REFUSED_MAX 200
#define SLOW_S 0.4 /* no answer waits for the one before it */

/* Lines that must be refused, and by whose name. */
static struct {
    char line[32], name[16];
} refused[REFUSED_MAX];
static int refused_count;

static void must_be_refused(const char *name, const char *value)
{
    TEST_ASSERT_LESS_THAN_INT(REFUSED_MAX, refused_count);
    TEST_ASSERT_TRUE(snprintf(refused[refused_count].name, sizeof refused[0].name, "%s", name) > 0);
    TEST_ASSERT_LESS_THAN_INT(
        sizeof refused[0].line,
        snprintf(refused[refused_count].line, sizeof refused[0].line, "#%s %s", name, value));
    refused_count++;
}

/* What asks for nothing gets something, what asks for a word gets that word and one more. */
static void spoil(const char *name, const char *words)
{
    static const char *const junk[] = {"0", "no", "1 x"};

    for (size_t i = strcmp(name, "SETR") == 0 ? 1 : 0; i < sizeof junk / sizeof junk[0]; i++) {
        must_be_refused(name, junk[i]);
    }
    for (const char *word = words; *word != '\0'; word += strspn(word, "[]|")) {
        char more[40];

        snprintf(more, sizeof more, "%.*s 0", (int)strcspn(word, "[]|"), word);
        if (strcspn(word, "[]|") > 0U) {
            must_be_refused(name, more);
        }
        word += strcspn(word, "[]|");
    }
}

/* From `OK HELP #NAME WORDS - meaning`, as the firmware tells its own table: no verb can be forgotten. Those
 * that are never refused and the one that takes any text are left out. */
static void spoil_every_verb(void)
{
    static const char begin[] = "\nOK HELP #";
    int verbs = 0;

    refused_count = 0;
    type("#HELP\n", 6, 0.0, HELP_S);
    for (const char *at = strstr(talk.terminal.text, begin); at != NULL; at = strstr(at + 1, begin)) {
        char name[16] = "", words[64] = "";

        TEST_ASSERT_GREATER_OR_EQUAL_INT(1, sscanf(at + strlen(begin), "%15s %63[^-]", name, words));
        if (parameter_find(name, (uint16_t)strlen(name)) != PARAMETER_COUNT) {
            continue;
        }
        verbs++;
        if (strcmp(name, "STOP") != 0 && strcmp(name, "LAND") != 0 && strcmp(name, "PING") != 0) {
            words[strlen(words) - (words[0] != '\0' ? 1U : 0U)] = '\0'; /* the blank before the dash */
            spoil(name, words);
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(15, verbs);
}

void test_no_verb_takes_a_value_that_it_does_not_ask_for(void)
{
    static char script[REFUSED_MAX * (sizeof refused[0].line + 1U)];
    const char *at;

    spoil_every_verb();
    script[0] = '\0';
    for (int i = 0; i < refused_count; i++) {
        strcat(strcat(script, refused[i].line), "\n");
    }
    type(script, strlen(script), SLOW_S, 1.0);
    at = talk.terminal.text;
    for (int i = 0; i < refused_count; i++) {
        char answer[24];

        snprintf(answer, sizeof answer, "\nERR %s ", refused[i].name);
        at = strstr(at, answer);
        TEST_ASSERT_NOT_NULL_MESSAGE(at, refused[i].line);
        at++;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, count_of("OK "), "a line was obeyed");
    TEST_ASSERT_NULL_MESSAGE(strstr(talk.terminal.text, "thr:1"), "armed");
    assert_nothing_changed();
}

void test_a_hundred_lines_ten_milliseconds_apart_are_all_kept(void)
{
    static char text[2000];
    size_t count = 0;

    for (int i = 0; i < 100; i++) {
        count += (size_t)snprintf(text + count, sizeof text - count, "#PING %d\n", i);
    }
    type(text, count, 0.010, 4.0);
    TEST_ASSERT_EQUAL_INT(100, count_of("OK PING "));
    for (int i = 0; i < 100; i++) {
        char line[32];

        snprintf(line, sizeof line, "OK PING %d", i);
        TEST_ASSERT_TRUE_MESSAGE(answered(line), line);
    }
}

void test_ten_thousand_random_octets_change_nothing_and_lose_no_later_command(void)
{
    static char text[10020];
    const char *last = "\n#PING 77\n";
    noise_t noise;

    noise_init(&noise, 20261121, "garbage");
    printf("seed 20261121\n");
    for (int i = 0; i < 10000; i++) {
        text[i] = (char)(noise_bits(&noise) & 0xFF);
    }
    memcpy(text + 10000, last, strlen(last));
    type(text, 10000 + strlen(last), 0.0, 3.0);
    assert_nothing_changed();
    TEST_ASSERT_TRUE(answered("OK PING 77"));
    TEST_ASSERT_TRUE_MESSAGE(count_of("ERR ") > 0, "no complete line in 10 000 random octets");
}

void test_telemetry_comes_five_times_a_second_in_lines_of_at_most_95_octets(void)
{
    size_t longest = 0, start = 0;

    type("", 0, 0.0, 10.0);
    for (size_t i = 0; i < talk.terminal.length; i++) {
        if (talk.terminal.text[i] == '\n') {
            longest = i + 1 - start > longest ? i + 1 - start : longest;
            start = i + 1;
        }
    }
    TEST_ASSERT_INT_WITHIN(2, 52, count_of("alt:"));
    TEST_ASSERT_TRUE(longest <= 95 && longest >= 50);
}

/* Thirty-two #GETs in one breath are half a minute of answers. */
static void storm_then(const char *last, double listen_s)
{
    static char text[400];

    text[0] = '\0';
    for (int i = 0; i < 32; i++) {
        strcat(text, "#GET\n");
    }
    strcat(text, last);
    type(text, strlen(text), 0.0, listen_s);
}

/* Longest time between the ends of two telemetry lines. */
static double longest_silence_s(void)
{
    double longest_s = 0.0, before_s = -1.0;
    const char *at = talk.terminal.text;

    while ((at = strstr(at, "\nalt:")) != NULL) {
        const double now_s = (double)talk.at_s[at + 1 - talk.terminal.text];

        longest_s = before_s >= 0.0 && now_s - before_s > longest_s ? now_s - before_s : longest_s;
        before_s = now_s;
        at++;
    }
    return longest_s;
}

void test_a_stop_is_obeyed_and_answered_within_half_a_second_of_a_storm_of_questions(void)
{
    static const struct {
        const char *line, *answer;
    } rows[] = {{"#STOP\n", "OK STOP"}, {"#LAND\n", "OK LAND"}, {"#SETR 0\n", "OK SETR 0"}};

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        storm_then(rows[i].line, 0.5);
        TEST_ASSERT_TRUE_MESSAGE(answered(rows[i].answer), rows[i].line);
    }
}

void test_a_reference_that_a_stop_overtakes_is_refused_and_not_flown_later(void)
{
    storm_then("#SETR 0.6\n#STOP\n", 60.0);
    TEST_ASSERT_TRUE(answered("OK STOP"));
    TEST_ASSERT_TRUE(answered("ERR SETR overtaken by a stop"));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, talk.reference_m);
}

void test_long_answers_leave_the_telemetry_its_turn(void)
{
    storm_then("#HELP\n#PERF\n#LASER\n", 30.0);
    TEST_ASSERT_TRUE(count_of("OK GET END lines:") >= 20);
    printf("longest silence %.3f s\n", longest_silence_s());
    TEST_ASSERT_TRUE(longest_silence_s() > 0.19 && longest_silence_s() <= 0.4);
}

void test_lists_end_with_the_number_of_their_lines(void)
{
    static const char *const names[] = {"GET", "HELP", "PERF"};

    for (int i = 0; i < 3; i++) {
        char text[16], begin[16], end[40];

        snprintf(text, sizeof text, "#%s\n", names[i]);
        type(text, strlen(text), 0.0, 10.0);
        snprintf(begin, sizeof begin, "OK %s", i == 0 ? "" : names[i]);
        snprintf(end, sizeof end, "OK %s END lines:%d", names[i], count_of(begin) - 1);
        TEST_ASSERT_TRUE_MESSAGE(answered(end), end);
    }
}

void test_bare_lines_get_one_answer_a_second(void)
{
    type("stop\n\nhalt\r\n\x03SETR 0\n", 20, 0.0, 1.0);
    TEST_ASSERT_EQUAL_INT(1, count_of("ERR - commands begin with #\r"));
    type("a\nb\nc\nd\ne\n", 10, 0.5, 0.5);
    TEST_ASSERT_EQUAL_INT(3, count_of("ERR - commands begin with #\r"));
}

void test_typing_mistakes_are_taken_back_by_backspace(void)
{
    type_line("#LAW PD\n#KQ\x08P 0.02\x7F"
              "3\n");
    TEST_ASSERT_TRUE(answered("OK KP 0.03"));
    TEST_ASSERT_EQUAL_INT(0, count_of("ERR "));
}

void test_defaults_seed_is_the_seeds_law_in_one_line(void)
{
    type_line("#KP 0.5\n#SEL PIN\n#DEFAULTS SEED\n");
    TEST_ASSERT_TRUE(answered("OK DEFAULTS SEED"));
    TEST_ASSERT_EQUAL_FLOAT((float)LAW_PID, talk.parameters.value[PARAMETER_LAW]);
    TEST_ASSERT_EQUAL_FLOAT(0.015F, talk.parameters.value[PARAMETER_KP]);
    TEST_ASSERT_EQUAL_FLOAT((float)SEL_PIN, talk.parameters.value[PARAMETER_SEL]);
}
