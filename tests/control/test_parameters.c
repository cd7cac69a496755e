#include "control/parameters.h"
#include "control/thrust.h"
#include "unity.h"

#include <math.h>
#include <string.h>

static parameters_t parameters;

void setUp(void)
{
    parameters_init(&parameters);
}

void tearDown(void) {}

static parameter_id_t find(const char *name)
{
    return parameter_find(name, strlen(name));
}

static void refused(parameter_id_t id, float value)
{
    const parameters_t before = parameters;
    TEST_ASSERT_EQUAL(PARAMETER_OUT_OF_RANGE, parameters_set(&parameters, id, value));
    TEST_ASSERT_EQUAL_MEMORY(&before, &parameters, sizeof before);
}

static void accepted(parameter_id_t id, float value)
{
    const uint32_t generation = parameters.generation;
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, id, value));
    TEST_ASSERT_EQUAL_FLOAT(value, parameters.value[id]);
    TEST_ASSERT_EQUAL_UINT32(generation + 1U, parameters.generation);
}

/* Best flown values, seed document, Annex III. */
void test_the_defaults_are_the_seeds_best_values_but_for_the_law(void)
{
    TEST_ASSERT_EQUAL_FLOAT(0.015F, parameters.value[PARAMETER_KP]);
    TEST_ASSERT_EQUAL_FLOAT(0.008F, parameters.value[PARAMETER_KD]);
    TEST_ASSERT_EQUAL_FLOAT(0.01F, parameters.value[PARAMETER_KI]);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, parameters.value[PARAMETER_USAT]);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, parameters.value[PARAMETER_DSAT]);
    TEST_ASSERT_EQUAL_FLOAT(7.0F, parameters.value[PARAMETER_GRAV]);
    TEST_ASSERT_EQUAL_FLOAT((float)LAW_EST, parameters.value[PARAMETER_LAW]);
    TEST_ASSERT_EQUAL_FLOAT((float)RELEASE_FREE, parameters.value[PARAMETER_RELEASE]);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, parameters.value[PARAMETER_LINK]);
    TEST_ASSERT_EQUAL_FLOAT((float)SEL_NONE, parameters.value[PARAMETER_SEL]);
    TEST_ASSERT_EQUAL_UINT32(0, parameters.generation);
}

/* Ground stations and stored sets rely on them. The seed's: Annex III. */
void test_the_limits_and_defaults_are_those_that_were_released(void)
{
    static const struct {
        const char *name;
        float least, most, initial;
    } rows[] = {
        {"KP", 0, 1, 0.015F},
        {"KD", 0, 1, 0.008F},
        {"KI", 0, 1, 0.01F},
        {"PKP", 0, 50, 6},
        {"PKI", 0, 50, 1.4F},
        {"PKD", 0, 50, 2.6F},
        {"POSK", 0.25F, 6, 2.3F},
        {"VELK", 0.5F, 12, 8},
        {"VUP", 0.125F, 1.5F, 0.7F},
        {"VDN", 0.125F, 1.5F, 1.1F},
        {"CRATE", 0.125F, 5, 1},
        {"GAIN", 0.4F, 2.5F, 1},
        {"LAG", 0.03F, 0.5F, 0.12F},
        {"DELAY", 0.008F, 0.12F, 0.0185F},
        {"DAMP", 0.5F, 6, 2.5F},
        {"CLAG", 0.1F, 1, 0.25F},
        {"LINK", 0, 60, 0},
        {"IDLE", 0, 25, 15},
        {"IUNIT", 0.5F, 5000, 256},
        {"DF", 0, 500, 105},
        {"LF", 0, 500, 100},
        {"L", 0, 500, 220},
        {"D1", 0, 500, 115},
        {"L1", 0, 500, 98},
        {"D2", 0, 500, 107},
        {"L2", 0, 500, 105},
        {"GRAV", 0, THRUST_MAX_N, 7},
        {"USAT", 0, THRUST_MAX_N, 1},
        {"DSAT", 0, THRUST_MAX_N, 0},
        {"SF", 345, 423, 389},
        {"S1", 64, 304, 128},
        {"S2", 464, 705, 640},
        {"SW", 2, 20, 17},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const parameter_row_t *row = &parameter_table[find(rows[i].name)];
        TEST_ASSERT_EQUAL_FLOAT_MESSAGE(rows[i].least, row->minimum, rows[i].name);
        TEST_ASSERT_EQUAL_FLOAT_MESSAGE(rows[i].most, row->maximum, rows[i].name);
        TEST_ASSERT_EQUAL_FLOAT_MESSAGE(rows[i].initial, row->initial, rows[i].name);
    }
}

void test_a_choice_goes_from_its_first_name_to_its_last(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_row_t *row = &parameter_table[i];
        if (row->choices != NULL) {
            TEST_ASSERT_EQUAL_FLOAT_MESSAGE(0.0F, row->minimum, row->name);
            TEST_ASSERT_EQUAL_FLOAT_MESSAGE(roundf(row->maximum), row->maximum, row->name);
        }
    }
    TEST_ASSERT_EQUAL_FLOAT((float)LAW_COUNT - 1.0F, parameter_table[PARAMETER_LAW].maximum);
    TEST_ASSERT_EQUAL_FLOAT((float)AXIS_COUNT - 1.0F, parameter_table[PARAMETER_IPITCH].maximum);
}

void test_a_set_begins_as_the_first_generation(void)
{
    memset(&parameters, 0x55, sizeof parameters);
    parameters_init(&parameters);
    TEST_ASSERT_EQUAL_UINT32(0U, parameters.generation);
}

void test_every_row_is_complete_and_its_default_is_within_its_limits(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_row_t *row = &parameter_table[i];
        TEST_ASSERT_NOT_NULL(row->name);
        TEST_ASSERT_TRUE_MESSAGE(row->minimum < row->maximum, row->name);
        TEST_ASSERT_TRUE_MESSAGE(row->initial >= row->minimum && row->initial <= row->maximum, row->name);
        TEST_ASSERT_EQUAL_CHAR_MESSAGE('.', row->meaning[strlen(row->meaning) - 1], row->name);
        TEST_ASSERT_EQUAL_MESSAGE(row->choices != NULL, strcmp(row->unit, "-") == 0, row->name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(i, find(row->name), row->name);
    }
}

void test_every_choice_is_found_by_its_name(void)
{
    int choices = 0;
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_row_t *row = &parameter_table[i];
        for (int k = 0; row->choices != NULL && k <= (int)row->maximum; k++) {
            TEST_ASSERT_EQUAL_INT16(
                k, parameter_find_choice((parameter_id_t)i, row->choices[k], strlen(row->choices[k])));
            choices++;
        }
    }
    TEST_ASSERT_EQUAL_INT(LAW_COUNT + RELEASE_COUNT + TERRAIN_COUNT + PLANT_COUNT + SEL_COUNT + SUM_COUNT +
                              2 * AXIS_COUNT + DOWN_COUNT + AXES_COUNT + LAYOUT_COUNT + STICK_COUNT +
                              BAT_COUNT + (int)CELLS_CHOICES + WALLS_COUNT,
                          choices);
}

void test_names_are_found_in_any_case_and_only_whole(void)
{
    TEST_ASSERT_EQUAL(PARAMETER_KP, find("kp"));
    TEST_ASSERT_EQUAL(PARAMETER_GRAV, find("GrAv"));
    TEST_ASSERT_EQUAL(PARAMETER_KP, parameter_find("KPX", 2));
    TEST_ASSERT_EQUAL(PARAMETER_COUNT, find("K"));
    TEST_ASSERT_EQUAL(PARAMETER_COUNT, find("KPP"));
    TEST_ASSERT_EQUAL(PARAMETER_COUNT, find(""));
    TEST_ASSERT_EQUAL(PARAMETER_COUNT, find("K\xD0"));
    TEST_ASSERT_EQUAL(PARAMETER_COUNT, parameter_find("KP\0", 3));
}

void test_choices_are_found_in_any_case_and_only_whole(void)
{
    TEST_ASSERT_EQUAL_INT16(LAW_PD, parameter_find_choice(PARAMETER_LAW, "pd", 2));
    TEST_ASSERT_EQUAL_INT16(LAW_PID, parameter_find_choice(PARAMETER_LAW, "Pid", 3));
    TEST_ASSERT_EQUAL_INT16(RELEASE_SCAN, parameter_find_choice(PARAMETER_RELEASE, "scan", 4));
    TEST_ASSERT_EQUAL_INT16(-1, parameter_find_choice(PARAMETER_LAW, "P", 1));
    TEST_ASSERT_EQUAL_INT16(-1, parameter_find_choice(PARAMETER_LAW, "PIDS", 4));
    TEST_ASSERT_EQUAL_INT16(-1, parameter_find_choice(PARAMETER_LAW, "", 0));
    TEST_ASSERT_EQUAL_INT16(-1, parameter_find_choice(PARAMETER_KP, "PD", 2));
}

void test_the_limits_themselves_are_accepted_and_what_lies_beyond_is_not(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_row_t *row = &parameter_table[i];
        const parameter_id_t id = (parameter_id_t)i;
        accepted(id, row->minimum);
        accepted(id, row->maximum);
        refused(id, nextafterf(row->maximum, INFINITY));
        refused(id, nextafterf(row->minimum, -INFINITY));
    }
}

void test_what_is_no_finite_number_is_refused_everywhere(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        refused((parameter_id_t)i, NAN);
        refused((parameter_id_t)i, -NAN);
        refused((parameter_id_t)i, INFINITY);
        refused((parameter_id_t)i, -INFINITY);
        refused((parameter_id_t)i, 1.0e9F);
    }
}

void test_the_operators_mistakes_are_refused(void)
{
    refused(PARAMETER_KP, 15.0F); /* N/m */
    refused(PARAMETER_L, 501.0F);
    refused(PARAMETER_L2, -1.0F);
    refused(PARAMETER_USAT, -0.5F);
    refused(PARAMETER_GRAV, 12.0F);
}

void test_a_choice_is_whole(void)
{
    refused(PARAMETER_LAW, 0.5F);
    refused(PARAMETER_RELEASE, 0.999F);
    refused(PARAMETER_LAW, -1.0F);
    refused(PARAMETER_LAW, (float)LAW_COUNT);
    accepted(PARAMETER_LAW, (float)LAW_PD);
}

void test_minus_zero_is_stored_as_zero(void)
{
    TEST_ASSERT_EQUAL(PARAMETER_ACCEPTED, parameters_set(&parameters, PARAMETER_KP, -0.0F));
    TEST_ASSERT_EQUAL_INT(0, signbit(parameters.value[PARAMETER_KP]) != 0);
}

void test_a_value_changes_nothing_but_itself(void)
{
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        parameters_init(&parameters);
        accepted((parameter_id_t)i, parameter_table[i].maximum);
        for (int k = 0; k < PARAMETER_COUNT; k++) {
            if (k != i) {
                TEST_ASSERT_EQUAL_FLOAT(parameter_table[k].initial, parameters.value[k]);
            }
        }
    }
}

void test_the_seeds_set_is_its_law_and_gains_and_nothing_else(void)
{
    parameters_t expected;

    for (int i = 0; i < PARAMETER_COUNT; i++) {
        parameters.value[i] = parameter_table[i].maximum;
    }
    expected = parameters;
    expected.generation++;
    expected.value[PARAMETER_LAW] = (float)LAW_PID;
    expected.value[PARAMETER_RELEASE] = (float)RELEASE_FREE;
    expected.value[PARAMETER_KP] = 0.015F;
    expected.value[PARAMETER_KD] = 0.008F;
    expected.value[PARAMETER_KI] = 0.01F;
    expected.value[PARAMETER_USAT] = 1.0F;
    expected.value[PARAMETER_DSAT] = 0.0F;
    expected.value[PARAMETER_GRAV] = 7.0F;
    expected.value[PARAMETER_LAYOUT] = (float)LAYOUT_FRONT;
    parameters_set_seed(&parameters);
    TEST_ASSERT_EQUAL_MEMORY(&expected, &parameters, sizeof expected);
}

/* Each row's meaning begins with the laws that it is for. */
void test_a_gain_is_used_by_the_laws_that_its_meaning_names(void)
{
    TEST_ASSERT_TRUE(parameter_is_used(PARAMETER_KP, LAW_PD) && parameter_is_used(PARAMETER_KP, LAW_PID));
    TEST_ASSERT_FALSE(parameter_is_used(PARAMETER_KP, LAW_PIDT) || parameter_is_used(PARAMETER_KP, LAW_EST));
    TEST_ASSERT_FALSE(parameter_is_used(PARAMETER_KI, LAW_PD));
    TEST_ASSERT_TRUE_MESSAGE(parameter_is_used(PARAMETER_PKP, LAW_EST), "PIDT stands in for EST");
    TEST_ASSERT_FALSE(parameter_is_used(PARAMETER_PKP, LAW_PID));
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const bool of_the_seed = strncmp(parameter_table[i].meaning, "PD, PID: ", 9) == 0 ||
                                 strncmp(parameter_table[i].meaning, "PID: ", 5) == 0;

        TEST_ASSERT_EQUAL_MESSAGE(!of_the_seed, parameter_is_used((parameter_id_t)i, LAW_EST),
                                  parameter_table[i].name);
    }
}

/* And the group says the same, so that a page that sorts by it does not contradict the sentence beside it. */
void test_a_parameter_stands_in_the_group_of_its_meaning_and_no_group_is_empty(void)
{
    static const struct {
        const char *begin;
        parameter_group_t first, last;
    } laws[] = {{"PD, PID: ", PARAMETERS_PD_PID, PARAMETERS_PD_PID},
                {"PID: ", PARAMETERS_PD_PID, PARAMETERS_PD_PID},
                {"PIDT: ", PARAMETERS_PIDT, PARAMETERS_PIDT},
                {"EST: ", PARAMETERS_EST, PARAMETERS_EST_MODEL}};
    int members[PARAMETER_GROUP_COUNT] = {0};

    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_group_t group = parameter_table[i].group;
        bool of_a_law = false;

        TEST_ASSERT_LESS_THAN_MESSAGE(PARAMETER_GROUP_COUNT, group, parameter_table[i].name);
        members[group]++;
        for (size_t k = 0; k < sizeof laws / sizeof laws[0]; k++) {
            if (strncmp(parameter_table[i].meaning, laws[k].begin, strlen(laws[k].begin)) == 0) {
                of_a_law = true;
                TEST_ASSERT_TRUE_MESSAGE(group >= laws[k].first && group <= laws[k].last,
                                         parameter_table[i].name);
            }
        }
        TEST_ASSERT_EQUAL_MESSAGE(of_a_law, group >= PARAMETERS_PD_PID && group <= PARAMETERS_EST_MODEL,
                                  parameter_table[i].name);
    }
    for (int group = 0; group < PARAMETER_GROUP_COUNT; group++) {
        TEST_ASSERT_GREATER_THAN(0, members[group]);
    }
}
