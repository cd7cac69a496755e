#include "parameters.h"

#include <math.h>

#include "thrust.h"

static const char *const law_names[LAW_COUNT] = {[LAW_PD] = "PD", [LAW_PID] = "PID"};
static const char *const release_names[RELEASE_COUNT] = {[RELEASE_FREE] = "FREE", [RELEASE_SCAN] = "SCAN"};

/* SETR ends at 3 m so that the take-over at 0.8 m above the reference is still within the sensor's 4.095 m. */
const parameter_row_t parameter_table[PARAMETER_COUNT] = {
    [PARAMETER_SETR] = {"SETR", "m", 0.0F, 3.0F, 0.0F, NULL, "Height reference; 0 lands."},
    [PARAMETER_KP] = {"KP", "N/mm", 0.0F, 1.0F, 0.015F, NULL, "Proportional gain."},
    [PARAMETER_KD] = {"KD", "N/mm", 0.0F, 1.0F, 0.008F, NULL, "Derivative gain per sample."},
    [PARAMETER_KI] = {"KI", "N/mm", 0.0F, 1.0F, 0.01F, NULL, "Integral gain per sample."},
    [PARAMETER_USAT] = {"USAT", "N", 0.0F, THRUST_MAX_N, 1.0F, NULL, "Most thrust above GRAV."},
    [PARAMETER_DSAT] = {"DSAT", "N", 0.0F, THRUST_MAX_N, 0.0F, NULL, "Most thrust below GRAV."},
    [PARAMETER_GRAV] = {"GRAV", "N", 0.0F, THRUST_MAX_N, 7.0F, NULL, "Gravity feed-forward per motor."},
    [PARAMETER_LAW] = {"LAW", "-", 0.0F, (float)(LAW_COUNT - 1), (float)LAW_PID, law_names, "Control law."},
    [PARAMETER_RELEASE] = {"RELEASE", "-", 0.0F, (float)(RELEASE_COUNT - 1), (float)RELEASE_FREE, release_names,
                            "The law runs every 108 ms or with each scan."},
    [PARAMETER_LINK] = {"LINK", "s", 0.0F, 60.0F, 0.0F, NULL, "Longest silence of the link; 0 disarms."},
};

void parameters_init(parameters_t *parameters)
{
    for (uint16_t i = 0U; i < (uint16_t)PARAMETER_COUNT; ++i) {
        parameters->value[i] = parameter_table[i].initial;
    }
    parameters->generation = 0U;
}

static char upper(char c)
{
    return (c >= 'a' && c <= 'z') ? (char)(c - 'a' + 'A') : c;
}

static bool same_name(const char *name, const char *text, size_t length)
{
    size_t i = 0;
    while (i < length && name[i] != '\0' && name[i] == upper(text[i])) {
        ++i;
    }
    return i == length && name[i] == '\0';
}

parameter_id_t parameter_find(const char *name, size_t length)
{
    uint16_t i = 0U;
    while (i < (uint16_t)PARAMETER_COUNT && !same_name(parameter_table[i].name, name, length)) {
        ++i;
    }
    return (parameter_id_t)i;
}

int16_t parameter_choice(parameter_id_t id, const char *name, size_t length)
{
    const parameter_row_t *row = &parameter_table[id];
    if (row->choices == NULL) {
        return -1;
    }
    for (int16_t i = 0; i <= (int16_t)row->maximum; ++i) {
        if (same_name(row->choices[i], name, length)) {
            return i;
        }
    }
    return -1;
}

parameter_status_t parameters_set(parameters_t *parameters, parameter_id_t id, float value)
{
    const parameter_row_t *row = &parameter_table[id];
    const bool inside = value >= row->minimum && value <= row->maximum;
    if (!inside || (row->choices != NULL && value != floorf(value))) {
        return PARAMETER_OUT_OF_RANGE;
    }
    parameters->value[id] = value + 0.0F;
    ++parameters->generation;
    return PARAMETER_ACCEPTED;
}
