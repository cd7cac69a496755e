/* Scenarios from a file, as their users write them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "control/parameters.h"
#include "unity.h"

static char output[100000];
static const char path[] = SCRATCH "/own.scenario";

void setUp(void) {}

void tearDown(void)
{
    remove(path);
}

static int fly(const char *text, const char *options)
{
    FILE *file = fopen(path, "w");
    char line[512];

    TEST_ASSERT_NOT_NULL(file);
    fputs(text, file);
    fclose(file);
    snprintf(line, sizeof line, "fly %s %s 2>&1", path, options);
    return child_plomada(line, output, sizeof output);
}

static double figure(const char *name)
{
    const char *at = strstr(output, name);

    TEST_ASSERT_NOT_NULL_MESSAGE(at, output);
    return atof(at + strlen(name));
}

static void refused(const char *text, const char *reason)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(2, fly(text, ""), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, reason), output);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, path), output);
}

#define FLIGHT "reference 0.5\nland 12\nend 18\n"

void test_a_flight_as_the_file_says(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        0,
        fly("# up, and higher\n" FLIGHT
            "name mine\nset LAW EST\nset plant.turbulence 0\nat 6 SETR 0.9 # a step\n"
            "expect altitude_error_mm 380 500\nexpect max_error_mm 1 60\nexpect ground_contacts 0 0\nfate "
            "succeeds\n",
            "--seed 4"),
        output);
    TEST_ASSERT_NOT_NULL(strstr(output, "mine, seed 4"));
    TEST_ASSERT_NOT_NULL(strstr(output, "MET: all expectations of mine"));
}

/* Octet for octet: what is copied must fly. */
void test_the_scenario_of_the_page_is_met(void)
{
    static char page[100000];
    FILE *file = fopen(PAGES "/campaign.md", "r");

    TEST_ASSERT_NOT_NULL(file);
    page[fread(page, 1, sizeof page - 1, file)] = '\0';
    fclose(file);
    char *text = strstr(page, "like est-60cm-ramp");
    TEST_ASSERT_NOT_NULL(text);
    *strstr(text, "```") = '\0';
    for (int seed = 1; seed <= 3; seed++) {
        char option[16];

        snprintf(option, sizeof option, "--seed %d", seed);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, fly(text, option), output);
    }
}

void test_an_expectation_that_does_not_hold_is_named(void)
{
    TEST_ASSERT_EQUAL_INT(1, fly(FLIGHT "expect max_error_mm 380 500\n", ""));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "NOT MET: max_error_mm is not within 380..500"), output);
}

void test_a_file_that_is_like_a_scenario_flies_as_it_does(void)
{
    fly("like pid-60cm-ramp\n", "");
    const double own_mm = figure("hover_rms_mm");
    TEST_ASSERT_TRUE(child_plomada("fly pid-60cm-ramp 2>&1", output, sizeof output) == 0);
    TEST_ASSERT_EQUAL_DOUBLE(figure("hover_rms_mm"), own_mm);
    fly("like pid-60cm-ramp\nset LAW EST\n", "");
    TEST_ASSERT_TRUE(figure("hover_rms_mm") < 0.5 * own_mm);
}

#define OVER_A_TABLE FLIGHT "set LAW EST\nplace table 2 0 1 1 0.25\nplace go 4 4 0 0.5\n"

/* The table is 1 m wide at 0.5 m/s: heights and ground are its for some 2 s. */
void test_a_place_is_flown_through(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        0, fly(OVER_A_TABLE "expect ground_contacts 0 0\nexpect cuts 0 0\n", "--csv " SCRATCH "/place.csv"),
        output);
    FILE *csv = fopen(SCRATCH "/place.csv", "r");
    char line[1000];
    unsigned over = 0, rows = 0;
    double x_m = 0.0;

    TEST_ASSERT_NOT_NULL(csv);
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, csv));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(line, "height_m,abs_m,terrain_m,x_m,y_m,heading_rad"), line);
    while (fgets(line, sizeof line, csv) != NULL) {
        double last[4];
        char *at = strrchr(line, ',');

        for (int i = 3; i >= 0; i--, at = strrchr(line, ',')) {
            last[i] = atof(at + 1);
            *at = '\0';
        }
        over += last[0] > 0.2;
        x_m = last[1];
        rows++;
    }
    fclose(csv);
    TEST_ASSERT_GREATER_THAN_UINT(1500, rows);
    TEST_ASSERT_UINT_WITHIN(80, 200, over);
    TEST_ASSERT_DOUBLE_WITHIN(0.6, 4.0, x_m);
}

void test_the_place_of_the_page_is_flown_through(void)
{
    static const char command[] = "fly est-60cm-ramp --place " PAGES
                                  "/examples/hall.place --set plant.platform=0 "
                                  "--duration 36 2>&1";

    TEST_ASSERT_EQUAL_INT_MESSAGE(0, child_plomada(command, output, sizeof output), output);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, figure("ground_contacts"));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, figure("cuts"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "\nNot judged, for --place is another course: overshoot_mm, "
                                                "hover_rms_mm, hover_mean_error_mm, terrain_rms_mm, "
                                                "recovery_s, undershoot_mm, thrust_std_n\nMET: what could be "
                                                "judged of est-60cm-ramp\n"),
                                 output);
    TEST_ASSERT_NULL_MESSAGE(strstr(output, "  recovery_s "), output);
}

void test_who_expects_nothing_has_met_nothing(void)
{
    TEST_ASSERT_EQUAL_INT(0, fly(FLIGHT "name mine\n", ""));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "\nNothing was judged: mine expects nothing\n"), output);
    TEST_ASSERT_NULL_MESSAGE(strstr(output, "MET"), output);
    TEST_ASSERT_EQUAL_INT(2, fly(FLIGHT, "--duration 1"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "--duration: must be more than 1 s"), output);
}

void test_what_is_wrong_in_a_place_is_told_with_its_line(void)
{
    refused(FLIGHT "place box 1 1\n", ":4: place: box: no such word");
    refused(FLIGHT "place block 1 0 1 1\n", "block: HEIGHT: missing");
    TEST_ASSERT_EQUAL_INT(2, child_plomada("fly bench --place /dev/null/none 2>&1", output, sizeof output));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "/dev/null/none: Not a directory"), output);
    TEST_ASSERT_EQUAL_INT(2, child_plomada("fly bench --place /dev/zero 2>&1", output, sizeof output));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "/dev/zero: "), output);
    FILE *file = fopen(path, "w");
    TEST_ASSERT_NOT_NULL(file);
    fputs("# a hall\ngo 1 2 3\n", file);
    fclose(file);
    snprintf(output, sizeof output, "fly est-60cm-ramp --place %s 2>&1", path);
    char command[300];
    snprintf(command, sizeof command, "%.280s", output);
    TEST_ASSERT_EQUAL_INT(2, child_plomada(command, output, sizeof output));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, ":2: go: SPEED: missing"), output);
}

void test_a_set_of_the_command_line_wins(void)
{
    fly(FLIGHT "set LAW PD\nset plant.hover_thrust 9\n", "");
    const double own_mm = figure("hover_rms_mm");
    fly(FLIGHT "set LAW PD\nset plant.hover_thrust 9\n", "--set LAW=EST --set plant.hover_thrust=7");
    TEST_ASSERT_TRUE(figure("hover_rms_mm") < 0.5 * own_mm);
}

void test_what_is_wrong_is_told_by_its_line(void)
{
    refused("land 12\nreferense 0.5\n", ":2: referense: no such word here; did you mean reference?");
    refused("reference high\n", ":1: high: not a number");
    refused("\n\nreference 9\n", ":3: 9: out of range 0..3 m");
    refused("set KQ 1\n", ":1: KQ: unknown name");
    refused("set KP 7\n", ":1: KP: out of range 0..1 N/mm");
    refused("set plant.tau 1e9\n", ":1: plant.tau: out of range");
    refused("set LAW\n", ":1: set NAME VALUE: that is its form");
    refused("at 5 SETR 4\n", ":1: SETR: out of range 0..3 m");
    refused("at soon SETR 1\n", ":1: soon: not a number");
    refused("at 0 SETR 0.9\n", ":1: 0: too early, that line takes until 0.027");
    refused("at 5 FOO\n", ":1: FOO: no such command");
    refused("\nat 5 LANDD\n", ":2: LANDD: no such command; did you mean LAND?");
    refused("at 5 VELKK 8\n", ":1: VELKK: no such command; did you mean VELK?");
    refused("at 5 plant.tau 0.1\n", ":1: plant.tau: a figure of the plant is not typed; set it");
    refused("set SETR 0.9\n", ":1: SETR: is no setting: reference, or at");
    refused("like bench\n", ":1: bench: has no flight to be like");
    refused("expect hover_mm 1 2\n", ":1: hover_mm: no such metric");
    refused("expect hover_rms_mm 5 2\n", ":1: 2: out of range");
    refused("like pid-60\n", ":1: pid-60: no such scenario");
    refused("fate good\n", ":1: good: succeeds, fails or either");
    refused("platform big\n", ":1: big: yes or no");
    refused("reference 0.5\nend 9\n", "no land");
    refused("land 9\nend 12\n", "no reference");
    refused("reference 0.5\nland 9\nend 8\n", "end is not after land");
    refused("reference 0.5\nat 18 LAND\nland 12\nend 18\n",
            ":2: at 18 LAND: not before the end, 18 s: it would never be typed");
    refused("like est-60cm-ramp\nat 5 SETR 0.4\nat 99 SETR 0.5\n", ":3: at 99 SETR: not before the end");
    TEST_ASSERT_EQUAL_INT(2, child_plomada("fly ./no-such-file 2>&1", output, sizeof output));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "./no-such-file: No such file"), output);
}

/* The firmware lists its commands itself. */
void test_each_command_of_the_firmware_may_stand_in_a_file_and_no_other(void)
{
    static char radio[200000];
    static char every[20000] = FLIGHT;
    int commands = 0;

    TEST_ASSERT_EQUAL_INT_MESSAGE(0, fly("reference 0.5\nland 60\nend 66\nat 2 HELP\n", "--radio help.txt"),
                                  output);
    child_read_file("help.txt", radio, sizeof radio);
    for (const char *at = radio; (at = strstr(at, "OK HELP #")) != NULL; commands++) {
        char name[32];

        at += strlen("OK HELP #");
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, " "), at);
        if (parameter_find(name, strlen(name)) == PARAMETER_COUNT) {
            snprintf(every + strlen(every), sizeof every - strlen(every), "at 17.9 %s%s\n", name,
                     strcmp(name, "SETR") == 0 ? " 0" : "");
        }
    }
    TEST_ASSERT_EQUAL_INT(PARAMETER_COUNT + 21, commands); /* and as many in scenario_file.c */
    TEST_ASSERT_NOT_EQUAL_INT_MESSAGE(2, fly(every, ""), output);
}

static void write_octets(const char *octets, size_t count)
{
    FILE *file = fopen(path, "w");

    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL_UINT(count, fwrite(octets, 1, count, file));
    fclose(file);
}

void test_what_is_no_text_is_refused_and_an_editors_mark_is_not(void)
{
    static const char nuls[] = "reference 0.5\n\0\0\0land 12\n", marked[] = "\xEF\xBB\xBF" FLIGHT;

    write_octets(nuls, sizeof nuls - 1);
    TEST_ASSERT_EQUAL_INT(2, child_plomada("fly " SCRATCH "/own.scenario 2>&1", output, sizeof output));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, ":2: not text"), output);
    write_octets(marked, sizeof marked - 1);
    TEST_ASSERT_EQUAL_INT(0, child_plomada("fly " SCRATCH "/own.scenario 2>&1", output, sizeof output));
    TEST_ASSERT_EQUAL_INT(2, child_plomada("fly ./ 2>&1", output, sizeof output));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "Is a directory"), output);
    TEST_ASSERT_EQUAL_INT(2, child_plomada("fly /dev/zero 2>&1", output, sizeof output));
}

void test_a_line_that_is_typed_at_the_soonest_flies(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, fly(FLIGHT "at 0.03 SETR 0.9\nexpect max_error_mm 1 100\n", ""), output);
}

void test_more_than_there_is_room_for_is_refused(void)
{
    static char text[8000];

    strcpy(text, FLIGHT);
    for (int i = 0; i < 100; i++) {
        strcat(text, "at 5 SETR 0.6\n");
    }
    refused(text, "too many");
    strcpy(text, FLIGHT "set KP ");
    memset(text + strlen(text), '1', 400);
    refused(text, ":4: line too long");
}
