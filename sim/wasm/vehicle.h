/* The simulated vehicle as one WebAssembly module: what a page, or any machine that runs WebAssembly, may
 * call. Strings and results pass through one room in the module's memory. Two uses, not at the same time:
 * vehicle_fly() flies a scenario as `plomada fly` does; the others keep a vehicle alive step by step, with an
 * operator at its radio. */
#ifndef SIM_WASM_VEHICLE_H
#define SIM_WASM_VEHICLE_H

#include "sim/devices/view.h"

#define VEHICLE_ROOM 65536

/* Where arguments and typed text are put, and what was heard is found. */
char *vehicle_room(void);

/* `plomada fly` with the arguments in the room, each ended by a zero, `size` octets in all; its exit status.
 * Files and standard output are the machine's, by WASI. */
int vehicle_fly(int size);

/* Power on; a vehicle that is on is switched off first. What #SAVE has stored and vehicle_set() has set
 * stays. Scenario time is the time since power-on. */
void vehicle_power_on(unsigned seed);
void vehicle_blank_storage(void);

/* Lets so much time pass. 0: the firmware has stopped for good. */
int vehicle_step(int milliseconds);

/* The operator's terminal sends `size` octets of the room. */
void vehicle_type(int size);

/* Octets that the terminal has received since the last call, moved to the room: how many. */
int vehicle_heard(void);

/* The truth, for pictures: valid until the next call. */
typedef struct {
    double time_s; /* since power-up */
    double height_m, altitude_m, terrain_m, speed_mps, thrust_n, roll_rad, pitch_rad, pulse_us;
    double contacts; /* with the ground, after take-off */
} vehicle_truth_t;
const vehicle_truth_t *vehicle_truth(void);

/* The figures of `plomada list --plant`, moved to the room: how many octets. A line for each: name, unit,
 * least, most, value, 1 or 0, meaning, with tabs between. 0: it counts from the next power-on. */
int vehicle_plant(void);
/* Sets one of them by `NAME=VALUE`, `size` octets in the room. 0: no such figure, or out of its limits. The
 * scanner's outage and restart and the loss of the radio are planned anew with each call that names them. */
int vehicle_set(int size);

/* Things go wrong, and right again. */
void vehicle_power_laser(int on);
void vehicle_power_imu(int on);
void vehicle_trouble_laser(int code);
/* The pilot's switch: 1 the firmware has the throttle, 0 the pilot, whose stick is in the middle. */
void vehicle_select(int firmware);
/* The radio pair in or out of each other's reach. */
void vehicle_reach(int in_reach);
/* The place that the next power-on is in: a place file (place_file.h), `size` octets in the room; 0: an even
 * floor. 0: it is one. Else octets of what is wrong with it, moved to the room; the place before stays. */
int vehicle_lay(int size);
/* The vehicle goes its way, from now on: that of the place that was laid; else over the ramp and platform of
 * the seed, which come by, the ramp in a second. */
void vehicle_go(void);

/* The place as it is now, seen from above, moved to the room: how many octets. A line for each block:
 * `block`, x, y, heading in radians, length, width, bottom, near top, far top in metres; and for each leg of
 * the way: `leg`, x, y. */
int vehicle_map(void);

/* Where the vehicle is, the ground along its nose and its beams (sim/devices/view.h): valid until the next
 * call. */
typedef struct {
    double x_m, y_m, heading_rad;
    double ground_m[VIEW_POINTS];
    struct {
        double from_x_m, from_y_m, from_z_m, to_x_m, to_y_m, to_z_m;
        double meets; /* 0: nothing in the sensor's reach */
    } beam[VIEW_BEAMS];
} vehicle_view_t;
const vehicle_view_t *vehicle_view(void);

#endif
