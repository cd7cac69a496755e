#include "sim/wasm/vehicle.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "sim/board.h"
#include "sim/ti/f021/flash.h"
#include "sim/timeline.h"
#include "tools/plomada/commands.h"

#define EXPORT(name) __attribute__((export_name(name)))
#define ARGUMENTS_MAX 64
#define HEARD_MAX 32768
#define RAMP_AHEAD (6300 * SIM_MS) /* the ramp of the seed's flight begins at 7.3 s */
#define STICK_MIDDLE (1500 * SIM_US)

static char room[VEHICLE_ROOM];
static char heard[HEARD_MAX];
static int heard_count;
static bool on;
static vehicle_truth_t truth;

EXPORT("vehicle_room") char *vehicle_room(void)
{
    return room;
}

EXPORT("vehicle_fly") int vehicle_fly(int size)
{
    static char *arguments[ARGUMENTS_MAX + 1];
    int count = 1, status;

    arguments[0] = "fly";
    for (int at = 0; at < size && count < ARGUMENTS_MAX; at += (int)strlen(&room[at]) + 1) {
        arguments[count++] = &room[at];
    }
    arguments[count] = NULL;
    status = command_fly(count, arguments);
    fflush(stdout); /* no exit of the program does it */
    return status;
}

/* Drops what nobody fetches: the newest is lost, as on a full buffer of a terminal. */
static void terminal(void *context, unsigned octet)
{
    (void)context;
    if (heard_count < HEARD_MAX) {
        heard[heard_count++] = (char)octet;
    }
}

EXPORT("vehicle_power_on") void vehicle_power_on(unsigned seed)
{
    board_config_t config = board_config(seed);

    if (on) {
        board_power_off();
    }
    config.terrain = terrain_platform;
    config.quadrotor.sag_per_s = 0.0; /* a page has no battery to change */
    heard_count = 0;
    board_power_on(&config, terminal, NULL);
    board_stick(STICK_MIDDLE);
    on = true;
}

EXPORT("vehicle_blank_storage") void vehicle_blank_storage(void)
{
    flash_blank();
}

EXPORT("vehicle_step") int vehicle_step(int milliseconds)
{
    return kernel_run_until(timeline_now() + (sim_time_t)milliseconds * SIM_MS) ? 1 : 0;
}

EXPORT("vehicle_type") void vehicle_type(int size)
{
    board_type(room, (size_t)size);
}

EXPORT("vehicle_heard") int vehicle_heard(void)
{
    const int count = heard_count;

    memcpy(room, heard, (size_t)count);
    heard_count = 0;
    return count;
}

EXPORT("vehicle_truth") const vehicle_truth_t *vehicle_truth(void)
{
    const quadrotor_state_t *state = quadrotor_state(board_quadrotor());

    truth = (vehicle_truth_t){
        .time_s = (double)timeline_now() * 1e-9,
        .height_m = state->height_m,
        .altitude_m = state->altitude_m,
        .terrain_m = state->terrain_m,
        .speed_mps = state->speed_mps,
        .thrust_n = state->thrust_n,
        .roll_rad = state->roll_rad,
        .pitch_rad = state->pitch_rad,
        .pulse_us = board_pulse_us(),
        .contacts = state->contacts,
    };
    return &truth;
}

EXPORT("vehicle_power_laser") void vehicle_power_laser(int is_on)
{
    board_power_laser(is_on != 0);
}

EXPORT("vehicle_power_imu") void vehicle_power_imu(int is_on)
{
    board_power_imu(is_on != 0);
}

EXPORT("vehicle_trouble_laser") void vehicle_trouble_laser(int code)
{
    board_trouble_laser((unsigned)code);
}

EXPORT("vehicle_select") void vehicle_select(int firmware)
{
    board_select(firmware != 0);
}

EXPORT("vehicle_meet_ramp") void vehicle_meet_ramp(void)
{
    quadrotor_set_origin(board_quadrotor(), timeline_now() - RAMP_AHEAD);
}
