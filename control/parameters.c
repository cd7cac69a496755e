#include "control/parameters.h"

#include <math.h>

#include "control/thrust.h"

#define LAW_NAME(name, step, cycles) "" #name, /* a literal as all others, of the width of a char */
static const char *const law_names[] = {LAWS(LAW_NAME)};
#undef LAW_NAME
static const char *const release_names[] = {[RELEASE_FREE] = "FREE", [RELEASE_SCAN] = "SCAN"};
typedef char
    every_release_has_a_name[(sizeof release_names / sizeof release_names[0] == RELEASE_COUNT) ? 1 : -1];
static const char *const terrain_names[] = {[TERRAIN_FOLLOW] = "FOLLOW", [TERRAIN_IGNORE] = "IGNORE"};
typedef char
    every_terrain_has_a_name[(sizeof terrain_names / sizeof terrain_names[0] == TERRAIN_COUNT) ? 1 : -1];
static const char *const plant_names[] = {[PLANT_THRUST] = "THRUST", [PLANT_CLIMB] = "CLIMB"};
typedef char every_plant_has_a_name[(sizeof plant_names / sizeof plant_names[0] == PLANT_COUNT) ? 1 : -1];
static const char *const sum_names[] = {[SUM_OFF] = "OFF", [SUM_ON] = "ON"};
typedef char every_sum_has_a_name[(sizeof sum_names / sizeof sum_names[0] == SUM_COUNT) ? 1 : -1];
static const char *const sel_names[] = {[SEL_NONE] = "NONE", [SEL_PIN] = "PIN"};
typedef char every_sel_has_a_name[(sizeof sel_names / sizeof sel_names[0] == SEL_COUNT) ? 1 : -1];

static const char *const stick_names[] = {[STICK_NONE] = "NONE", [STICK_PIN] = "PIN"};
typedef char every_stick_has_a_name[(sizeof stick_names / sizeof stick_names[0] == STICK_COUNT) ? 1 : -1];

static const char *const bat_names[] = {[BAT_NONE] = "NONE", [BAT_PIN] = "PIN"};
typedef char every_bat_has_a_name[(sizeof bat_names / sizeof bat_names[0] == BAT_COUNT) ? 1 : -1];
static const char *const cells_names[] = {"2S", "3S", "4S", "5S", "6S"};
typedef char
    every_count_of_cells_has_a_name[(sizeof cells_names / sizeof cells_names[0] == CELLS_CHOICES) ? 1 : -1];

static const char *const walls_names[] = {[WALLS_OFF] = "OFF", [WALLS_ON] = "ON"};
typedef char every_walls_has_a_name[(sizeof walls_names / sizeof walls_names[0] == WALLS_COUNT) ? 1 : -1];

static const char *const axis_names[] = {
    [AXIS_ROLL] = "ROLL", [AXIS_MINUS_ROLL] = "-ROLL", [AXIS_PITCH] = "PITCH", [AXIS_MINUS_PITCH] = "-PITCH"};
typedef char every_axis_has_a_name[(sizeof axis_names / sizeof axis_names[0] == AXIS_COUNT) ? 1 : -1];
static const char *const down_names[] = {[DOWN_Z] = "Z", [DOWN_MINUS_Z] = "-Z"};
typedef char every_down_has_a_name[(sizeof down_names / sizeof down_names[0] == DOWN_COUNT) ? 1 : -1];
static const char *const axes_names[] = {[AXES_ASSUMED] = "ASSUMED", [AXES_PROVED] = "PROVED"};
typedef char every_axes_have_a_name[(sizeof axes_names / sizeof axes_names[0] == AXES_COUNT) ? 1 : -1];

static const char *const layout_names[] = {
    [LAYOUT_FRONT] = "FRONT", [LAYOUT_TWO] = "TWO", [LAYOUT_THREE] = "THREE"};
typedef char every_layout_has_a_name[(sizeof layout_names / sizeof layout_names[0] == LAYOUT_COUNT) ? 1 : -1];

const parameter_row_t parameter_table[] = {
    [PARAMETER_KP] = {"KP", "N/mm", 0.0F, 1.0F, 0.015F, NULL, PARAMETERS_PD_PID,
                      "PD, PID: proportional gain."},
    [PARAMETER_KD] = {"KD", "N/mm", 0.0F, 1.0F, 0.008F, NULL, PARAMETERS_PD_PID,
                      "PD, PID: derivative gain per sample."},
    [PARAMETER_KI] = {"KI", "N/mm", 0.0F, 1.0F, 0.01F, NULL, PARAMETERS_PD_PID,
                      "PID: integral gain per sample."},
    [PARAMETER_USAT] = {"USAT", "N", 0.0F, THRUST_MAX_N, 1.0F, NULL, PARAMETERS_PD_PID,
                        "PD, PID: most thrust above GRAV."},
    [PARAMETER_DSAT] = {"DSAT", "N", 0.0F, THRUST_MAX_N, 0.0F, NULL, PARAMETERS_PD_PID,
                        "PD, PID: most thrust below GRAV."},
    [PARAMETER_GRAV] = {"GRAV", "N", 0.0F, THRUST_MAX_N, 7.0F, NULL, PARAMETERS_LAWS,
                        "Gravity feed-forward per motor."},
    [PARAMETER_LAW] = {"LAW", "-", 0.0F, (float)(LAW_COUNT - 1), (float)LAW_EST, law_names, PARAMETERS_LAWS,
                       "Control law."},
    [PARAMETER_RELEASE] = {"RELEASE", "-", 0.0F, (float)(RELEASE_COUNT - 1), (float)RELEASE_FREE,
                           release_names, PARAMETERS_PD_PID, "PD, PID: every 108 ms or with each scan."},
    [PARAMETER_PKP] = {"PKP", "N/m", 0.0F, 50.0F, 6.0F, NULL, PARAMETERS_PIDT, "PIDT: proportional gain."},
    [PARAMETER_PKI] = {"PKI", "N/m/s", 0.0F, 50.0F, 1.4F, NULL, PARAMETERS_PIDT, "PIDT: integral gain."},
    [PARAMETER_PKD] = {"PKD", "N*s/m", 0.0F, 50.0F, 2.6F, NULL, PARAMETERS_PIDT, "PIDT: derivative gain."},
    [PARAMETER_POSK] = {"POSK", "1/s", 0.25F, 6.0F, 2.3F, NULL, PARAMETERS_EST,
                        "EST: speed per metre off the reference."},
    [PARAMETER_VELK] = {"VELK", "1/s", 0.5F, 12.0F, 8.0F, NULL, PARAMETERS_EST,
                        "EST: acceleration per metre per second off."},
    [PARAMETER_VUP] = {"VUP", "m/s", 0.125F, 1.5F, 0.7F, NULL, PARAMETERS_EST, "EST: fastest climb."},
    [PARAMETER_VDN] = {"VDN", "m/s", 0.125F, 1.5F, 1.1F, NULL, PARAMETERS_EST,
                       "EST: fastest descent to a reference."},
    [PARAMETER_TERRAIN] = {"TERRAIN", "-", 0.0F, (float)(TERRAIN_COUNT - 1), (float)TERRAIN_FOLLOW,
                           terrain_names, PARAMETERS_EST,
                           "EST: keeps the height above the terrain, or its altitude."},
    [PARAMETER_PLANT] = {"PLANT", "-", 0.0F, (float)(PLANT_COUNT - 1), (float)PLANT_THRUST, plant_names,
                         PARAMETERS_EST_MODEL, "EST: what the autopilot's throttle commands."},
    [PARAMETER_CRATE] = {"CRATE", "m/s/N", 0.125F, 5.0F, 1.0F, NULL, PARAMETERS_EST_MODEL,
                         "EST: climb rate per newton with PLANT CLIMB."},
    /* Model of the vehicle. Limits: what vehicles of this kind have, twice over. Defaults: lag assumed of
     * motors and rotors of this size; delay half a pulse period 6.8, pulse 1.5, autopilot 10 ms (assumed);
     * with a damping of 2 to 3 the model repeats the seed's flights; lag of an autopilot's climb rate
     * assumed. `make fit` finds them. */
    [PARAMETER_GAIN] = {"GAIN", "times", 0.4F, 2.5F, 1.0F, NULL, PARAMETERS_EST_MODEL,
                        "EST: effect of a newton, 1 as the hover thrust tells."},
    [PARAMETER_LAG] = {"LAG", "s", 0.03F, 0.5F, 0.12F, NULL, PARAMETERS_EST_MODEL, "EST: lag of the motors."},
    [PARAMETER_DELAY] = {"DELAY", "s", 0.008F, 0.12F, 0.0185F, NULL, PARAMETERS_EST_MODEL,
                         "EST: from a command to the motors."},
    [PARAMETER_DAMP] = {"DAMP", "1/s", 0.5F, 6.0F, 2.5F, NULL, PARAMETERS_EST_MODEL,
                        "EST: damping of a climb by the air."},
    [PARAMETER_CLAG] = {"CLAG", "s", 0.1F, 1.0F, 0.25F, NULL, PARAMETERS_EST_MODEL,
                        "EST: lag of the autopilot's climb rate with PLANT CLIMB."},
    [PARAMETER_LINK] = {"LINK", "s", 0.0F, 60.0F, 0.0F, NULL, PARAMETERS_RADIO,
                        "Longest silence of the link; 0 turns the watch off."},
    [PARAMETER_SUM] = {"SUM", "-", 0.0F, (float)(SUM_COUNT - 1), (float)SUM_OFF, sum_names, PARAMETERS_RADIO,
                       "Whether every command line must have its sum."},
    [PARAMETER_SEL] = {"SEL", "-", 0.0F, (float)(SEL_COUNT - 1), (float)SEL_NONE, sel_names,
                       PARAMETERS_THROTTLE, "Whether a pin tells that the pilot has the throttle."},
    [PARAMETER_IDLE] = {"IDLE", "%", 0.0F, 25.0F, 15.0F, NULL, PARAMETERS_THROTTLE,
                        "Least throttle while armed: keeps the motors turning."},
    [PARAMETER_IROLL] = {"IROLL", "-", 0.0F, (float)(AXIS_COUNT - 1), (float)AXIS_MINUS_ROLL, axis_names,
                         PARAMETERS_IMU, "The IMU's angle that is the vehicle's roll, right side up."},
    [PARAMETER_IPITCH] = {"IPITCH", "-", 0.0F, (float)(AXIS_COUNT - 1), (float)AXIS_PITCH, axis_names,
                          PARAMETERS_IMU, "The IMU's angle that is the vehicle's pitch, nose up."},
    [PARAMETER_IDOWN] = {"IDOWN", "-", 0.0F, (float)(DOWN_COUNT - 1), (float)DOWN_Z, down_names,
                         PARAMETERS_IMU, "Where the IMU's accelerometer feels gravity."},
    [PARAMETER_IUNIT] = {"IUNIT", "1/g", 0.5F, 5000.0F, 256.0F, NULL, PARAMETERS_IMU,
                         "Counts of the IMU's accelerometer per g."},
    [PARAMETER_IAXES] = {"IAXES", "-", 0.0F, (float)(AXES_COUNT - 1), (float)AXES_ASSUMED, axes_names,
                         PARAMETERS_IMU, "Whether tilting by hand has proved IROLL and IPITCH."},
    /* The seed's Annex III. Up to 500 mm: longer than any arm of a vehicle of this size. */
    [PARAMETER_DF] = {"DF", "mm", 0.0F, 500.0F, 105.0F, NULL, PARAMETERS_MIRRORS,
                      "Scanner to the front mirror."},
    [PARAMETER_LF] = {"LF", "mm", 0.0F, 500.0F, 100.0F, NULL, PARAMETERS_MIRRORS,
                      "Front mirror to the lowest point of the landing gear."},
    [PARAMETER_L] = {"L", "mm", 0.0F, 500.0F, 220.0F, NULL, PARAMETERS_MIRRORS,
                     "Vehicle's centre to the front mirror, to the right."},
    [PARAMETER_D1] = {"D1", "mm", 0.0F, 500.0F, 115.0F, NULL, PARAMETERS_MIRRORS,
                      "Scanner to mirror 1, aft."},
    [PARAMETER_L1] = {"L1", "mm", 0.0F, 500.0F, 98.0F, NULL, PARAMETERS_MIRRORS,
                      "Mirror 1 to the lowest point of the landing gear."},
    [PARAMETER_D2] = {"D2", "mm", 0.0F, 500.0F, 107.0F, NULL, PARAMETERS_MIRRORS,
                      "Scanner to mirror 2, fore."},
    [PARAMETER_L2] = {"L2", "mm", 0.0F, 500.0F, 105.0F, NULL, PARAMETERS_MIRRORS,
                      "Mirror 2 to the lowest point of the landing gear."},
    [PARAMETER_LAYOUT] = {"LAYOUT", "-", 0.0F, (float)(LAYOUT_COUNT - 1), (float)LAYOUT_THREE, layout_names,
                          PARAMETERS_MIRRORS, "Mirrors read in each scan: front, the other two, or all."},
    /* Limits: within these no two windows meet, and none leaves the steps that the scanner measures.
     * Defaults: measured on the vehicle, 5 steps inside each mirror's edges. */
    [PARAMETER_SF] = {"SF", "step", 345.0F, 423.0F, 389.0F, NULL, PARAMETERS_MIRRORS,
                      "Middle of the rays on the front mirror."},
    [PARAMETER_S1] = {"S1", "step", 64.0F, 304.0F, 128.0F, NULL, PARAMETERS_MIRRORS,
                      "Middle of the rays on mirror 1, aft."},
    [PARAMETER_S2] = {"S2", "step", 464.0F, 705.0F, 640.0F, NULL, PARAMETERS_MIRRORS,
                      "Middle of the rays on mirror 2, fore."},
    [PARAMETER_SW] = {"SW", "steps", 2.0F, 20.0F, 17.0F, NULL, PARAMETERS_MIRRORS,
                      "Rays to either side of each middle."},
    [PARAMETER_STICK] = {"STICK", "-", 0.0F, (float)(STICK_COUNT - 1), (float)STICK_NONE, stick_names,
                         PARAMETERS_THROTTLE,
                         "Whether the pilot's stick sets the height, by a pin; with SEL PIN."},
    /* Limits: a stick's middle is trimmed by a quarter of its way. A receiver's middle is 1.5 ms; remote
     * controls of some makers have 1.52 ms, which the dead band takes in. */
    [PARAMETER_SMID] = {"SMID", "us", 1400.0F, 1600.0F, 1500.0F, NULL, PARAMETERS_THROTTLE,
                        "Pulse of the stick's middle."},
    /* Limits: law EST climbs by VUP at most, 0.7 m/s. Default: a reaction of 0.3 s is 9 cm then. */
    [PARAMETER_SRATE] = {"SRATE", "m/s", 0.05F, 0.7F, 0.3F, NULL, PARAMETERS_THROTTLE,
                         "How fast the stick moves the reference, at its end."},
    [PARAMETER_BAT] = {"BAT", "-", 0.0F, (float)(BAT_COUNT - 1), (float)BAT_NONE, bat_names,
                       PARAMETERS_BATTERY, "Whether the battery's voltage is measured, by a pin."},
    /* The vehicle's battery is 4S, and the 3DR module takes 18 V at most. */
    [PARAMETER_CELLS] = {"CELLS", "-", 0.0F, (float)(CELLS_CHOICES - 1U), (float)(4U - CELLS_FEWEST),
                         cells_names, PARAMETERS_BATTERY, "Cells of the battery, in series."},
    /* Default: ArduPilot's BATT_VOLT_MULT for this module. Limits: half and twice that. */
    [PARAMETER_VDIV] = {"VDIV", "times", 5.0F, 20.0F, 10.1F, NULL, PARAMETERS_BATTERY,
                        "Divider of the power module, as a voltmeter tells."},
    /* Defaults: ArduPilot's of a LiPo, 0.3 V and 0.2 V above the 3.3 V that damage it. Limits: those 3.3 V,
     * and the 3.9 V of a battery that is two thirds full. */
    [PARAMETER_VLOW] = {"VLOW", "V", 3.3F, 3.9F, 3.6F, NULL, PARAMETERS_BATTERY,
                        "Voltage of a cell in flight below which it warns."},
    [PARAMETER_VLAND] = {"VLAND", "V", 3.3F, 3.9F, 3.5F, NULL, PARAMETERS_BATTERY,
                         "Voltage of a cell in flight below which it lands."},
    /* OFF: five lines more in a second are in the way of who reads them in a terminal. */
    [PARAMETER_WALLS] = {"WALLS", "-", 0.0F, (float)(WALLS_COUNT - 1), (float)WALLS_OFF, walls_names,
                         PARAMETERS_RADIO, "Whether the radio tells what the rays between the mirrors meet."},
};
typedef char
    every_parameter_has_its_row[(sizeof parameter_table / sizeof parameter_table[0] == PARAMETER_COUNT) ? 1
                                                                                                        : -1];

void parameters_init(parameters_t *parameters)
{
    for (uint16_t i = 0U; i < (uint16_t)PARAMETER_COUNT; ++i) {
        parameters->value[i] = parameter_table[i].initial;
    }
    parameters->generation = 0U;
}

void parameters_set_seed(parameters_t *parameters)
{
    static const parameter_id_t seed[] = {PARAMETER_KP,   PARAMETER_KD,   PARAMETER_KI,     PARAMETER_USAT,
                                          PARAMETER_DSAT, PARAMETER_GRAV, PARAMETER_RELEASE};

    for (uint16_t i = 0U; i < sizeof seed / sizeof seed[0]; ++i) {
        parameters->value[seed[i]] = parameter_table[seed[i]].initial;
    }
    parameters->value[PARAMETER_LAW] = (float)LAW_PID;
    parameters->value[PARAMETER_LAYOUT] = (float)LAYOUT_FRONT;
    ++parameters->generation;
}

void parameters_set_older(parameters_t *parameters, uint16_t count)
{
    for (uint16_t i = count; i < (uint16_t)PARAMETER_COUNT; ++i) {
        parameters->value[i] = parameter_table[i].initial;
    }
    if (count <= (uint16_t)PARAMETER_LAYOUT) {
        parameters->value[PARAMETER_LAYOUT] = (float)LAYOUT_FRONT;
    }
    ++parameters->generation;
}

bool parameter_is_used(parameter_id_t id, control_law_t law)
{
    switch (parameter_table[id].group) {
    case PARAMETERS_PD_PID:
        return law == LAW_PID || (law == LAW_PD && id != PARAMETER_KI);
    case PARAMETERS_PIDT:
        return law == LAW_PIDT || law == LAW_EST;
    default:
        return true;
    }
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

int16_t parameter_find_choice(parameter_id_t id, const char *name, size_t length)
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
