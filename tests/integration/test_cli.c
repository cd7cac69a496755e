/* The plomada program as its users call it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "child.h"
#include "parameters.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static char output[200000];

static int run(const char *arguments)
{
    char command[1024];
    FILE *pipe;
    size_t count;
    int status;

    snprintf(command, sizeof command, "cd '" SCRATCH "' && '" PLOMADA "' %s 2>&1", arguments);
    pipe = popen(command, "r");
    TEST_ASSERT_NOT_NULL(pipe);
    count = fread(output, 1, sizeof output - 1, pipe);
    output[count] = '\0';
    status = pclose(pipe);
    TEST_ASSERT_TRUE(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static size_t read_file(const char *name, char *text, size_t size)
{
    char path[512];
    FILE *file;
    size_t count;

    snprintf(path, sizeof path, SCRATCH "/%s", name);
    file = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    count = fread(text, 1, size - 1, file);
    text[count] = '\0';
    fclose(file);
    return count;
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
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --seed x"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --bogus"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --realtime"));
    TEST_ASSERT_EQUAL_INT(2, run("fly pid-40cm --csv /no/such/directory/x.csv"));
    TEST_ASSERT_EQUAL_INT(0, run("--help"));
    TEST_ASSERT_EQUAL_INT(0, run("fly --help"));
    TEST_ASSERT_NOT_NULL(strstr(output, "plant.hover_thrust"));
    TEST_ASSERT_EQUAL_INT(0, run("list --help"));
    TEST_ASSERT_EQUAL_INT(0, run("params --help"));
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

void test_the_same_seed_gives_the_same_csv_and_another_seed_another(void)
{
    static char first[2000000], second[2000000];
    size_t count;

    TEST_ASSERT_EQUAL_INT(0, run("fly pid-40cm --seed 7 --csv a.csv"));
    TEST_ASSERT_EQUAL_INT(0, run("fly pid-40cm --seed 7 --csv b.csv"));
    TEST_ASSERT_EQUAL_INT(0, run("fly pid-40cm --seed 8 --csv c.csv"));
    count = read_file("a.csv", first, sizeof first);
    TEST_ASSERT_EQUAL_size_t(count, read_file("b.csv", second, sizeof second));
    TEST_ASSERT_EQUAL_INT(0, memcmp(first, second, count));
    read_file("c.csv", second, sizeof second);
    TEST_ASSERT_NOT_EQUAL(0, strcmp(first, second));
    TEST_ASSERT_EQUAL_INT(0, strncmp(first, "t_s,height_m,abs_m,terrain_m,est_m,ref_m,thrust_n,pulse_us,state,flags\n0.00,",
                                     76));
}

void test_a_broken_expectation_exits_1_and_still_writes_both_files(void)
{
    static char text[2000000];

    remove(SCRATCH "/low.csv");
    remove(SCRATCH "/low.json");
    TEST_ASSERT_EQUAL_INT(1, run("fly pid-40cm --set GRAV=1 --csv low.csv --json low.json"));
    TEST_ASSERT_NOT_NULL(strstr(output, "NOT MET"));
    TEST_ASSERT_TRUE(read_file("low.csv", text, sizeof text) > 100000);
    read_file("low.json", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "\"rise_time_s\": null"));
    TEST_ASSERT_NOT_NULL(strstr(text, "\"met\": false"));
    for (int i = 0; i < METRIC_COUNT; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, metric_names[i]), metric_names[i]);
    }
}

void test_overrides_reach_the_firmware_and_the_plant(void)
{
    static char text[4000];

    TEST_ASSERT_EQUAL_INT(0, run("fly pid-40cm --json plain.json"));
    read_file("plain.json", text, sizeof text);
    TEST_ASSERT_NOT_NULL(strstr(text, "\"commands_err\": 0"));
    TEST_ASSERT_NOT_NULL(strstr(text, "\"terrain_rms_mm\": null"));
    run("fly pid-40cm --set SETR=0.8 --set plant.turbulence=0 --json other.json --csv other.csv");
    static char csv[2000000];
    read_file("other.csv", csv, sizeof csv);
    TEST_ASSERT_NOT_NULL(strstr(csv, ",0.800,"));
}
