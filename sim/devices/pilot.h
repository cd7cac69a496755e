/* The pilot on the ground with the remote control: at given times takes the throttle through the multiplexer
 * and holds a height by eye. Sees the vehicle late, wants a climb in proportion to what is missing, and moves
 * the stick with some inertia and unrest. The receiver repeats the stick every 20 ms. */
#ifndef SIM_DEVICES_PILOT_H
#define SIM_DEVICES_PILOT_H

#include <stdbool.h>

#include "sim/devices/rc_mux.h"
#include "sim/devices/span.h"

typedef struct {
    double t_s; /* scenario time */
    double height_m, climb_mps;
} pilot_view_t;

typedef struct {
    span_t turn;          /* 10 s, for 0 s: never takes it */
    double every_s;       /* 0: once; else again, so long after the start of the turn before */
    double until_s;       /* no turn begins later; never */
    double height_m;      /* 0.6; 0: lands it and leaves the throttle down */
    double trim_n;        /* 7: where the stick is when the turn begins */
    double delay_s;       /* 0.2, eye to hand */
    double unrest_n;      /* 0.05 rms */
    bool field_day;       /* the whole day instead of turns: see pilot_day_t */
    bool by_stick;        /* field day: alone, without a radio: the stick sets the height, see below */
    bool stops_by_sticks; /* field day: how he stops the motors, by the autopilot's Stop Type */
} pilot_config_t;

/* A field day, by scenario time: at first the throttle is the pilot's, and down. */
#define PILOT_DAY_START_S (-8.0) /* the stick command, for a second; then the stick at a fifth */
#define PILOT_DAY_GIVE_S (-5.0)  /* he gives the throttle to the firmware */
#define PILOT_DAY_TAKE_S \
    36.0 /* and takes it back in the air, with the stick at trim_n: holds height_m by eye */
#define PILOT_DAY_LAND_S 41.0 /* lands by eye */
#define PILOT_DAY_STOP_S 47.0 /* stops the motors */

/* The same day by stick: after he gave the throttle, the stick goes to the middle. He flies to height_m and
 * stays there, holds the stick down to land, and takes the throttle back with the stick down, which stops the
 * motors. */
#define PILOT_STICK_MIDDLE_S (-4.0)
#define PILOT_STICK_FLY_S 1.0
#define PILOT_STICK_LAND_S 20.0
#define PILOT_STICK_TAKE_S 30.0

#define PILOT_DEFAULT \
    { \
        .turn = {10.0, 0.0}, .every_s = 0.0, .until_s = SPAN_FOR_GOOD_S, .height_m = 0.6, .trim_n = 7.0, \
        .delay_s = 0.2, .unrest_n = 0.05 \
    }

typedef struct {
    pilot_view_t (*look)(void *context);
    void (*take)(void *context, bool take);    /* the switch: true: the throttle is the pilot's */
    rc_pulse_t stick;                          /* a pulse of the receiver */
    void (*corners)(void *context, bool held); /* both sticks in the lower corners; NULL: not connected */
    void *context;
} pilot_hands_t;

typedef struct pilot pilot_t;

pilot_t *pilot_create(const pilot_config_t *config, const pilot_hands_t *hands, unsigned long seed);
void pilot_destroy(pilot_t *pilot); /* NULL: nothing */

#endif
