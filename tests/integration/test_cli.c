/* The plomada program as its users call it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "child.h"
#include "control/parameters.h"
#include "unity.h"
#include "firmware/version.h"

void setUp(void) {}
void tearDown(void) {}

static char output[200000];

static int run(const char *arguments)
{
    char line[1024];

    snprintf(line, sizeof line, "%s 2>&1", arguments);
    return child_plomada(line, output, sizeof output);
}

void test_usage_errors_exit_2_and_help_exits_0(void)
{
    TEST_ASSERT_EQUAL_INT(2, run(""));
    TEST_ASSERT_EQUAL_INT(2, run("glide"));
    TEST_ASSERT_EQUAL_INT(2, run("fly"));
    TEST_ASSERT_EQUAL_INT(2, run("fly no-such-flight"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --set NOPE=1"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --set plant.nope=1"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --set KP=nan"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --set KP=1e9"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --set plant.tau=fast"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --set plant.rays_lost=1.2"));
    TEST_ASSERT_NOT_NULL(strstr(output, "out of range, see `plomada list --plant`"));
    TEST_ASSERT_EQUAL_INT(2, run("list --world"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --duration 0.5"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --until-down 0"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --fault melt@7"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --laser pty --until-down 9"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --seed x"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --bogus"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --realtime"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --csv /no/such/directory/x.csv"));
    TEST_ASSERT_EQUAL_INT(0, run("--help"));
    TEST_ASSERT_EQUAL_INT(0, run("fly --help"));
    TEST_ASSERT_NOT_NULL(strstr(output, "plant.hover_thrust"));
    TEST_ASSERT_EQUAL_INT(0, run("list --help"));
    TEST_ASSERT_EQUAL_INT(0, run("params --help"));
    TEST_ASSERT_EQUAL_INT(0, run("--version"));
    TEST_ASSERT_EQUAL_STRING("plomada " PLOMADA_VERSION "\n", output);
}

void test_list_and_params_name_everything(void)
{
    TEST_ASSERT_EQUAL_INT(0, run("list"));
    for (int i = 0; i < scenario_count; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, scenarios[i].name), scenarios[i].name);
    }
    TEST_ASSERT_EQUAL_INT(0, run("params"));
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        TEST_ASSERT_NOT_NULL(strstr(output, parameter_table[i].name));
    }
}

void test_params_tells_the_choices_of_the_parameter_that_is_named(void)
{
    TEST_ASSERT_EQUAL_INT(0, run("params law"));
    TEST_ASSERT_NOT_NULL(strstr(output, "\none of: PD|PID|PIDT|EST\n"));
    TEST_ASSERT_NULL(strstr(output, "GRAV"));
    TEST_ASSERT_EQUAL_INT(0, run("params GRAV"));
    TEST_ASSERT_NULL(strstr(output, "one of"));
    TEST_ASSERT_EQUAL_INT(2, run("params LAWS"));
    TEST_ASSERT_EQUAL_INT(2, run("params LAW GRAV"));
    TEST_ASSERT_EQUAL_INT(2, run("params --law"));
}

void test_the_plant_figures_are_listed_with_their_values_as_in_the_help_of_fly(void)
{
    static char listed[40000];
    const char *figures;

    TEST_ASSERT_EQUAL_INT(0, run("list --plant"));
    figures = strstr(output, "  plant.airframe");
    TEST_ASSERT_NOT_NULL(figures);
    snprintf(listed, sizeof listed, "%s", figures);
    TEST_ASSERT_NOT_NULL(
        strstr(listed, "  plant.hover_thrust           N           7.4  hover thrust per motor TH0\n"));
    TEST_ASSERT_NOT_NULL(strstr(listed, "  plant.scan_frozen_start      s         never"));
    TEST_ASSERT_EQUAL_INT(0, run("fly --help"));
    TEST_ASSERT_NOT_NULL(strstr(output, listed));
}

static double column(const char *line, int number)
{
    while (number-- > 0) {
        line = strchr(line, ',') + 1;
    }
    return strtod(line, NULL);
}

/* The landing command moves with --duration, and --until-down ends the log one second after the motors have
 * stopped. */
void test_a_flight_can_be_made_shorter_and_ends_when_it_is_down(void)
{
    static char csv[2000000];
    const char *last;

    TEST_ASSERT_EQUAL_INT(
        0, run("fly est-60cm-ramp --set plant.platform=0 --duration 8 --until-down 60 --csv short.csv") & 2);
    child_read_file("short.csv", csv, sizeof csv);
    csv[strlen(csv) - 1] = '\0';
    last = strrchr(csv, '\n') + 1;
    TEST_ASSERT_DOUBLE_WITHIN(1.5, 8.0 + 4.5 + 1.0, column(last, 0));
    TEST_ASSERT_DOUBLE_WITHIN(0.001, 0.0, column(last, 5)); /* thrust_n */
    TEST_ASSERT_NOT_NULL(strstr(last, "GROUND"));
}

void test_faults_of_the_scanners_line_strike_in_flight(void)
{
    run("fly est-60cm-ramp");
    TEST_ASSERT_NOT_NULL(strstr(output, "  scans_rejected       0 "));
    run("fly est-60cm-ramp --fault drop@15000 --fault flip@17000");
    TEST_ASSERT_NOT_NULL(strstr(output, "  scans_rejected       2 "));
}

void test_the_same_seed_gives_the_same_csv_and_another_seed_another(void)
{
    static char first[2000000], second[2000000];
    size_t count;

    TEST_ASSERT_EQUAL_INT(0, run("fly pid-40cm --seed 7 --csv a.csv"));
    TEST_ASSERT_EQUAL_INT(0, run("fly pid-40cm --seed 7 --csv b.csv"));
    TEST_ASSERT_EQUAL_INT(0, run("fly pid-40cm --seed 8 --csv c.csv"));
    count = child_read_file("a.csv", first, sizeof first);
    TEST_ASSERT_EQUAL_size_t(count, child_read_file("b.csv", second, sizeof second));
    TEST_ASSERT_EQUAL_INT(0, memcmp(first, second, count));
    child_read_file("c.csv", second, sizeof second);
    TEST_ASSERT_NOT_EQUAL(0, strcmp(first, second));
    TEST_ASSERT_EQUAL_INT(0, strncmp(first, "t_s,", 4));
}

void test_a_broken_expectation_exits_1_and_still_writes_both_files(void)
{
    static char text[2000000];

    remove(SCRATCH "/low.csv");
    remove(SCRATCH "/low.json");
    TEST_ASSERT_EQUAL_INT(1, run("fly pid-40cm --set GRAV=1 --csv low.csv --json low.json"));
    TEST_ASSERT_NOT_NULL(strstr(output, "NOT MET"));
    TEST_ASSERT_TRUE(child_read_file("low.csv", text, sizeof text) > 100000);
    child_read_file("low.json", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "\"rise_time_s\": null"));
    TEST_ASSERT_NOT_NULL(strstr(text, "\"met\": false"));
    for (int i = 0; i < METRIC_COUNT; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, metric_names[i]), metric_names[i]);
    }
}

void test_each_row_of_a_flight_says_what_it_must_be_and_what_it_means(void)
{
    TEST_ASSERT_EQUAL_INT(0, run("fly est-60cm-ramp"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, " 0.6..1       climb from 10 to 90 % of the reference"),
                                 output);
    for (const char *row = strstr(output, "\n  "); row != NULL; row = strstr(row + 1, "\n  ")) {
        const char *end = strchr(row + 1, '\n');

        TEST_ASSERT_TRUE_MESSAGE(end - row > 50, row); /* a meaning stands at its end */
    }
    TEST_ASSERT_NULL_MESSAGE(strstr(output, "\n!"), output);
    TEST_ASSERT_NULL_MESSAGE(strstr(output, "(null)"), output);
}

void test_rows_that_do_not_apply_are_hidden_unless_they_are_expected(void)
{
    TEST_ASSERT_EQUAL_INT(0, run("fly est-60cm-ramp"));
    TEST_ASSERT_NULL_MESSAGE(strstr(output, "again_rms_mm"), output);
    TEST_ASSERT_NULL_MESSAGE(strstr(output, "motor_stops"), output);
    TEST_ASSERT_NULL_MESSAGE(strstr(output, " - "), output);
    TEST_ASSERT_EQUAL_INT(0, run("fly field-day"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "\n  again_rms_mm"), output);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "\n  motor_stops          0         0..0"), output);
    TEST_ASSERT_NULL_MESSAGE(strstr(output, "terrain_rms_mm"), output);
}

void test_what_was_not_met_is_told_whole_and_explained(void)
{
    TEST_ASSERT_EQUAL_INT(1, run("fly pid-40cm --set GRAV=1"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "\n! rise_time_s          -         0.6..2.1"), output);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "\n  ground_contacts      0         0..0"), output);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "NOT MET: rise_time_s is not within"), output);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "NOT MET: hover_rms_mm is not within"), output);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "NOT MET means: "), output);
}

void test_overrides_reach_the_firmware_and_the_plant(void)
{
    static char text[4000];

    TEST_ASSERT_EQUAL_INT(0, run("fly pid-40cm --json plain.json"));
    child_read_file("plain.json", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "\"commands_err\": 0"));
    TEST_ASSERT_NOT_NULL(strstr(text, "\"terrain_rms_mm\": null"));
    run("fly pid-40cm --set SETR=0.8 --set plant.turbulence=0 --json other.json --csv other.csv");
    static char csv[2000000];
    child_read_file("other.csv", csv, sizeof csv);
    TEST_ASSERT_NOT_NULL(strstr(csv, ",0.800,"));
}

static void make_file(const char *name, size_t octets, int octet)
{
    char path[512];
    FILE *file;

    snprintf(path, sizeof path, SCRATCH "/%s", name);
    file = fopen(path, "wb");
    TEST_ASSERT_NOT_NULL(file);
    for (size_t i = 0; i < octets; i++) {
        fputc(octet, file);
    }
    fclose(file);
}

void test_a_storage_that_is_none_is_refused_by_name_and_left_as_it_is(void)
{
    static char text[40000];

    make_file("short.bin", 32767, 0xFF);
    TEST_ASSERT_EQUAL_INT(2, run("fly bench --storage short.bin"));
    TEST_ASSERT_EQUAL_STRING(
        "plomada fly: short.bin: no image of the storage: its length is not 32768 octets\n", output);
    TEST_ASSERT_EQUAL_size_t(32767, child_read_file("short.bin", text, sizeof text));
    make_file("long.bin", 32769, 0xFF);
    TEST_ASSERT_EQUAL_INT(2, run("fly bench --storage long.bin"));
    TEST_ASSERT_EQUAL_size_t(32769, child_read_file("long.bin", text, sizeof text));
    TEST_ASSERT_EQUAL_INT(2, run("fly bench --storage ."));
    TEST_ASSERT_EQUAL_STRING("plomada fly: .: Is a directory\n", output);
}

void test_a_storage_that_cannot_be_written_is_refused_before_the_flight(void)
{
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --storage no/such/directory/flash.bin --csv unflown.csv"));
    TEST_ASSERT_EQUAL_STRING("plomada fly: no/such/directory/flash.bin: No such file or directory\n", output);
    TEST_ASSERT_EQUAL_INT(0, run("list; ! test -e unflown.csv"));
}

void test_a_damaged_storage_is_told_at_power_on_and_the_defaults_fly(void)
{
    static char text[40000];

    make_file("zero.bin", 32768, 0);
    TEST_ASSERT_EQUAL_INT(0, run("fly bench --duration 2 --storage zero.bin"));
    TEST_ASSERT_NOT_NULL(strstr(output, "ERR LOAD stored set damaged\n"));
    TEST_ASSERT_EQUAL_size_t(32768, child_read_file("zero.bin", text, sizeof text));
    TEST_ASSERT_EACH_EQUAL_CHAR(0, text, 32768);
    remove(SCRATCH "/none.bin");
    TEST_ASSERT_EQUAL_INT(0, run("fly bench --duration 2 --storage none.bin"));
    TEST_ASSERT_NULL(strstr(output, "LOAD"));
    TEST_ASSERT_EQUAL_size_t(32768, child_read_file("none.bin", text, sizeof text));
    TEST_ASSERT_EACH_EQUAL_CHAR((char)0xFF, text, 32768);
}

void test_a_file_that_could_not_be_written_whole_is_named_and_ends_with_2(void)
{
    static const char *const options[] = {"--csv", "--json", "--trace"};

    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++) {
        char words[64];

        snprintf(words, sizeof words, "fly pid-40cm %s /dev/full", options[i]);
        TEST_ASSERT_EQUAL_INT(2, run(words));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "plomada: /dev/full: No space left on device"), output);
    }
}

void test_a_dash_writes_the_log_to_stdout_alone_and_the_table_to_stderr(void)
{
    static char dash[2000000], file[2000000];

    TEST_ASSERT_EQUAL_INT(0,
                          child_plomada("fly pid-40cm --csv - 2>table.txt >dash.csv", output, sizeof output));
    TEST_ASSERT_EQUAL_INT(0, run("fly pid-40cm --csv file.csv"));
    const size_t count = child_read_file("file.csv", file, sizeof file);
    TEST_ASSERT_EQUAL_size_t(count, child_read_file("dash.csv", dash, sizeof dash));
    TEST_ASSERT_EQUAL_INT(0, memcmp(dash, file, count));
    child_read_file("table.txt", dash, sizeof dash);
    TEST_ASSERT_NOT_NULL(strstr(dash, "MET: all expectations of pid-40cm"));
}

void test_a_misspelt_scenario_is_answered_by_the_nearest(void)
{
    TEST_ASSERT_EQUAL_INT(2, run("fly PID40cm"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "PID40cm: no such scenario; did you mean pid-40cm?"), output);
    TEST_ASSERT_EQUAL_INT(2, run("fly est-60cm-rmap"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "did you mean est-60cm-ramp?"), output);
    TEST_ASSERT_EQUAL_INT(2, run("fly zzz"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "zzz: no such scenario, see `plomada list`"), output);
}

void test_what_is_out_of_range_is_told_with_its_limits(void)
{
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --set KP=5"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "KP=5: out of range 0..1 N/mm"), output);
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --set LAW=X"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "LAW=X: no such choice; one of PD, PID, PIDT, EST"), output);
}

/* Of the flight before, or of the run before: none is overwritten. */
static void forget_recording(void)
{
    remove(SCRATCH "/recording/flight.plomada");
}

/* As released that is every scenario, so that each meets its expectations with this seed too; test_flights
 * flies the first one. */
void test_a_replay_gives_the_log_of_every_scenario_octet_for_octet(void)
{
    static char flown[2000000], again[2000000];
    const int step = FULL_SPEED ? 1 : 7; /* every scenario as released; under the sanitizers some of them */

    for (int i = 0; i < scenario_count; i += step) {
        char words[160];

        snprintf(words, sizeof words, "fly %s --seed 3 --csv flown.csv --record recording >metrics.txt",
                 scenarios[i].name);
        forget_recording();
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, run(words), output);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, run("replay recording --csv again.csv"), output);
        const size_t count = child_read_file("flown.csv", flown, sizeof flown);
        TEST_ASSERT_GREATER_THAN_size_t_MESSAGE(100000, count, scenarios[i].name);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(count, child_read_file("again.csv", again, sizeof again),
                                         scenarios[i].name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, memcmp(flown, again, count), scenarios[i].name);
    }
}

void test_a_replay_with_another_law_says_that_nothing_answers_to_it(void)
{
    static char again[2000000];

    forget_recording();
    TEST_ASSERT_EQUAL_INT(0, run("fly est-60cm-ramp --record recording"));
    TEST_ASSERT_EQUAL_INT(0, run("replay recording --set LAW=PID --csv again.csv"));
    TEST_ASSERT_NOT_NULL_MESSAGE(
        strstr(output, "replayed est-60cm-ramp, seed 1: 2601 rows; open loop with LAW=PID\n"), output);
    TEST_ASSERT_GREATER_THAN_size_t(100000, child_read_file("again.csv", again, sizeof again));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(again, ",terrain_m,x_m,y_m,heading_rad,flown_n\n"), again);
    TEST_ASSERT_EQUAL_INT(2, run("replay recording --set plant.tau=1"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "no vehicle flies in a replay"), output);
    TEST_ASSERT_EQUAL_INT(2, run("replay no-such-recording"));
    TEST_ASSERT_EQUAL_INT(0, run("replay again.csv --csv open.csv"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(output, "open loop over 2601 rows"), output);
}

static double cpu_s(void)
{
    struct rusage used;

    getrusage(RUSAGE_CHILDREN, &used);
    return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec) * 1e-6;
}

/* Processor time, so that what else the machine does does not count. */
void test_a_minute_of_flight_takes_less_than_half_a_second(void)
{
    const double before_s = cpu_s();

    TEST_ASSERT_EQUAL_INT(0, run("fly hover-60s"));
    const double taken_s = cpu_s() - before_s;

    printf("fly hover-60s: %.2f s of processor time\n", taken_s);
    TEST_ASSERT_TRUE(taken_s > 0.0);
    if (FULL_SPEED) {
        TEST_ASSERT_TRUE_MESSAGE(taken_s < 0.5, "slower than it was");
    }
}
