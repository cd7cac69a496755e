/* Parameter table: every number and choice that the operator may set, with unit, limits, default and
 * meaning. One row feeds the validation, the answers of #GET and #HELP, `plomada params`, and the command
 * table of the README.
 *
 * A new row goes to the end, so that stored sets go on loading (firmware/parameter_store.h).
 *
 * Pure; the caller owns the set. In the firmware the parameter server owns it (firmware/servers.h). */
#ifndef CONTROL_PARAMETERS_H
#define CONTROL_PARAMETERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "control/laws/table.h"

typedef enum {
    PARAMETER_KP,      /* N/mm */
    PARAMETER_KD,      /* N/mm per sample */
    PARAMETER_KI,      /* N/mm per sample */
    PARAMETER_USAT,    /* N above GRAV */
    PARAMETER_DSAT,    /* N below GRAV */
    PARAMETER_GRAV,    /* N per motor */
    PARAMETER_LAW,     /* choice, control_law_t */
    PARAMETER_RELEASE, /* choice, control_release_t; of laws PD and PID */
    PARAMETER_PKP,     /* N/m, law PIDT */
    PARAMETER_PKI,     /* N/(m s) */
    PARAMETER_PKD,     /* N s/m */
    PARAMETER_POSK,    /* 1/s, law EST: height -> speed */
    PARAMETER_VELK,    /* 1/s, law EST: speed -> acceleration */
    PARAMETER_VUP,     /* m/s, law EST: fastest climb */
    PARAMETER_VDN,     /* m/s, law EST: fastest descent */
    PARAMETER_TERRAIN, /* choice, control_terrain_t; law EST */
    PARAMETER_PLANT,   /* choice, control_plant_t; law EST */
    PARAMETER_CRATE,   /* m/s per N, with PLANT CLIMB */
    PARAMETER_GAIN,    /* factor; vehicle model of law EST: this and the next four */
    PARAMETER_LAG,     /* s */
    PARAMETER_DELAY,   /* s */
    PARAMETER_DAMP,    /* 1/s */
    PARAMETER_CLAG,    /* s, with PLANT CLIMB */
    PARAMETER_LINK,    /* s, 0 = link supervision off */
    PARAMETER_SEL,     /* choice, control_sel_t */
    PARAMETER_SUM,     /* choice, control_sum_t */
    PARAMETER_IDLE,    /* % of the throttle's range, while armed */
    PARAMETER_IROLL,   /* choice, control_axis_t */
    PARAMETER_IPITCH,  /* likewise */
    PARAMETER_IDOWN,   /* choice, control_down_t */
    PARAMETER_IUNIT,   /* accelerometer counts per g */
    PARAMETER_IAXES,   /* choice, control_axes_t */
    PARAMETER_DF,      /* mm; places of the mirrors, control/altitude.h: front mirror */
    PARAMETER_LF,
    PARAMETER_L,
    PARAMETER_D1, /* aft mirror, the seed's mirror 1 */
    PARAMETER_L1,
    PARAMETER_D2, /* fore mirror, the seed's mirror 2 */
    PARAMETER_L2,
    PARAMETER_LAYOUT, /* choice, control_layout_t. From here on: not in sets that were stored before 0.2.0 */
    PARAMETER_SF,     /* steps of the scanner: middle of the rays that look at the front mirror */
    PARAMETER_S1,     /* aft */
    PARAMETER_S2,     /* fore */
    PARAMETER_SW,     /* steps to either side of each middle */
    PARAMETER_STICK,  /* choice, control_stick_t */
    PARAMETER_SMID,   /* us, pulse of the stick's middle */
    PARAMETER_SRATE,  /* m/s, at an end of the stick */
    PARAMETER_BAT,    /* choice, control_bat_t */
    PARAMETER_CELLS,  /* choice: CELLS_FEWEST and more */
    PARAMETER_VDIV,   /* volts of the battery per volt at the pin */
    PARAMETER_VLOW,   /* V a cell */
    PARAMETER_VLAND,  /* V a cell */
    PARAMETER_WALLS,  /* choice, control_walls_t */
    PARAMETER_COUNT
} parameter_id_t;

#define LAW_CHOICE(name, step, cycles) LAW_##name,
typedef enum { LAWS(LAW_CHOICE) LAW_COUNT } control_law_t;
#undef LAW_CHOICE
typedef enum { RELEASE_FREE, RELEASE_SCAN, RELEASE_COUNT } control_release_t;
typedef enum { TERRAIN_FOLLOW, TERRAIN_IGNORE, TERRAIN_COUNT } control_terrain_t;
typedef enum {
    PLANT_THRUST,
    PLANT_CLIMB,
    PLANT_COUNT
} control_plant_t;                                         /* what the autopilot's throttle
                                                            * commands: thrust or climb rate */
typedef enum { SUM_OFF, SUM_ON, SUM_COUNT } control_sum_t; /* whether every command line must have its sum */
typedef enum {
    SEL_NONE,
    SEL_PIN,
    SEL_COUNT
} control_sel_t; /* how the firmware knows whether the pilot
                  * has the throttle: not at all, or by a pin */

/* How the firmware hears the pilot's throttle stick: not at all, or by a pin. */
typedef enum { STICK_NONE, STICK_PIN, STICK_COUNT } control_stick_t;

/* How the firmware measures the battery: not at all, or by a pin. */
typedef enum { BAT_NONE, BAT_PIN, BAT_COUNT } control_bat_t;
#define CELLS_FEWEST 2U /* value 0 of CELLS */
#define CELLS_CHOICES 5U

/* Whether the radio tells what stands around. */
typedef enum { WALLS_OFF, WALLS_ON, WALLS_COUNT } control_walls_t;

/* Which angle of the IMU is the vehicle's roll (or pitch), and which end of the IMU's z axis points down. */
typedef enum { AXIS_ROLL, AXIS_MINUS_ROLL, AXIS_PITCH, AXIS_MINUS_PITCH, AXIS_COUNT } control_axis_t;
typedef enum { DOWN_Z, DOWN_MINUS_Z, DOWN_COUNT } control_down_t;
/* Whether IROLL and IPITCH are assumed, or proved by tilting the vehicle by hand. */
typedef enum { AXES_ASSUMED, AXES_PROVED, AXES_COUNT } control_axes_t;

/* Which mirrors are read in each scan: the front one; those aft and fore; all. */
typedef enum { LAYOUT_FRONT, LAYOUT_TWO, LAYOUT_THREE, LAYOUT_COUNT } control_layout_t;

/* What a parameter is for, so that forty of them are found. */
typedef enum {
    PARAMETERS_LAWS,      /* for every law, and which one */
    PARAMETERS_PD_PID,    /* laws PD and PID */
    PARAMETERS_PIDT,      /* law PIDT, and EST without an estimate */
    PARAMETERS_EST,       /* law EST */
    PARAMETERS_EST_MODEL, /* the vehicle that law EST computes with */
    PARAMETERS_THROTTLE,  /* who has it, and the motors' idle */
    PARAMETERS_RADIO,
    PARAMETERS_IMU,
    PARAMETERS_MIRRORS,
    PARAMETERS_BATTERY,
    PARAMETER_GROUP_COUNT
} parameter_group_t;

typedef struct {
    const char *name; /* as typed after '#', upper case */
    const char *unit; /* "m", "N/mm", "N", "s", or "-" for a choice */
    float minimum;
    float maximum;
    float initial;
    const char *const *choices; /* NULL for a number; else maximum + 1 names, the value is an index */
    parameter_group_t group;
    const char *meaning; /* one sentence */
} parameter_row_t;

extern const parameter_row_t parameter_table[]; /* PARAMETER_COUNT */

typedef struct {
    float value[PARAMETER_COUNT];
    uint32_t generation; /* +1 with every accepted value, also an unchanged one */
} parameters_t;

typedef enum { PARAMETER_ACCEPTED, PARAMETER_OUT_OF_RANGE } parameter_status_t;

void parameters_init(parameters_t *parameters);

/* Sets the seed's law PID as it flew: LAW, RELEASE, KP, KD, KI, USAT, DSAT, GRAV and LAYOUT. Other parameters
 * do not change. */
void parameters_set_seed(parameters_t *parameters);

/* The parameters from number `count` on become what vehicles flew with before these existed: for a set that
 * was stored then. */
void parameters_set_older(parameters_t *parameters, uint16_t count);

/* Whether this law uses the parameter. The gains of PIDT count as used by EST too, because PIDT replaces
 * EST without an estimate. */
bool parameter_is_used(parameter_id_t id, control_law_t law);

/* Finds a parameter by the first `length` characters of name, upper or lower case. Returns PARAMETER_COUNT
 * when there is none. */
parameter_id_t parameter_find(const char *name, size_t length);

/* Finds a choice by its name, upper or lower case. Returns its value, or -1 when the parameter is not a
 * choice or has no such name. */
int16_t parameter_find_choice(parameter_id_t id, const char *name, size_t length);

/* Value of a choice: the index of its name. */
static inline uint16_t parameters_choice(const parameters_t *parameters, parameter_id_t id)
{
    return (uint16_t)parameters->value[id];
}

/* Stores value and returns PARAMETER_ACCEPTED when it is finite and within the row's limits; for a choice
 * it must also be whole. Otherwise nothing changes. -0 is stored as 0. */
parameter_status_t parameters_set(parameters_t *parameters, parameter_id_t id, float value);

#endif
