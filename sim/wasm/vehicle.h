/* The simulated vehicle as one WebAssembly module: what a page, or any machine that runs WebAssembly, may
 * call. Strings and results pass through one room in the module's memory. Two uses, not at the same time:
 * vehicle_fly() flies a scenario as `plomada fly` does; the others keep a vehicle alive step by step, with an
 * operator at its radio. */
#ifndef SIM_WASM_VEHICLE_H
#define SIM_WASM_VEHICLE_H

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
/* The ramp and platform of the seed come by, the ramp in a second. */
void vehicle_meet_ramp(void);

#endif
