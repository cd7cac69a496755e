#include "sim/wasm/vehicle.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sim/board.h"
#include "sim/scenarios/plant.h"
#include "sim/ti/f021/flash.h"
#include "sim/timeline.h"
#include "tools/plomada/commands.h"

#define EXPORT(name) __attribute__((export_name(name)))
#define ARGUMENTS_MAX 64
#define HEARD_MAX 32768
#define RAMP_AHEAD_S 1.0
#define STICK_MIDDLE (1500 * SIM_US)

static char room[VEHICLE_ROOM];
static char heard[HEARD_MAX];
static int heard_count;
static bool on;
static plant_t plant;                           /* its figures stay from one power-on to the next */
static double ramp_from_m, ramp_since_s = -1.0; /* where and when vehicle_meet_ramp() was called; < 0: not */
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

/* What plant_set() and plant_known() are called with. */
static const char *full_name(const char *name)
{
    static char text[64];

    snprintf(text, sizeof text, "plant.%s", name);
    return text;
}

/* A plant with the phases of this seed and the figures of the one before. */
static void prepare_plant(unsigned seed)
{
    plant_t fresh;
    plant_figure_t figure;

    plant_init(&fresh, seed);
    fresh.board.quadrotor.sag_per_s = 0.0; /* a page has no battery to change */
    for (size_t row = 0; plant.board.seed != 0 && plant_figure(&plant, row, &figure); row++) {
        plant_set(&fresh, full_name(figure.name), figure.value);
    }
    plant = fresh;
}

static const plant_t *completed(void)
{
    static plant_t now;

    now = plant;
    plant_complete(&now);
    if (ramp_since_s >= 0.0) {
        seed_course_meet(&now.ground, ramp_from_m, ramp_since_s, RAMP_AHEAD_S, &now.place, &now.course);
    }
    return &now;
}

EXPORT("vehicle_power_on") void vehicle_power_on(unsigned seed)
{
    if (on) {
        board_power_off();
    }
    prepare_plant(seed);
    ramp_since_s = -1.0;
    heard_count = 0;
    board_power_on(&completed()->board, terminal, NULL);
    quadrotor_set_origin(board_quadrotor(), timeline_now()); /* scenario time: since power-on */
    plant_plan(&plant, NULL, 0);
    board_stick(STICK_MIDDLE);
    on = true;
}

/* The scanner, the pilot and the kind of autopilot and IMU are those of power-on. */
static bool at_once(const char *name)
{
    static const char *const at_power_on[] = {
        "ray_instant", "clock_ppm", "scanner_answers", "scanner_rate",      "scanner_boot", "imu_stock",
        "imu_period",  "imu_age",   "stop_type",       "attitude_throttle", "pilot"};

    for (size_t i = 0; i < sizeof at_power_on / sizeof at_power_on[0]; i++) {
        if (strncmp(name, at_power_on[i], strlen(at_power_on[i])) == 0) {
            return false;
        }
    }
    return true;
}

EXPORT("vehicle_plant") int vehicle_plant(void)
{
    plant_figure_t figure;
    size_t used = 0;

    for (size_t row = 0; plant_figure(&plant, row, &figure) && used < sizeof room; row++) {
        used += (size_t)snprintf(&room[used], sizeof room - used, "%s\t%s\t%.9g\t%.9g\t%.9g\t%d\t%s\n",
                                 figure.name, figure.unit, figure.least, figure.most, figure.value,
                                 at_once(figure.name) ? 1 : 0, figure.meaning);
    }
    return (int)(used < sizeof room ? used : sizeof room - 1);
}

EXPORT("vehicle_set") int vehicle_set(int size)
{
    char *value = memchr(room, '=', (size_t)size);
    const char *name;

    if (value == NULL) {
        return 0;
    }
    room[size] = '\0';
    *value++ = '\0';
    name = full_name(room);
    if (!plant_known(name) || plant_check(name, value) != NULL) {
        return 0;
    }
    plant_set(&plant, name, strtod(value, NULL));
    if (on) {
        board_change(&completed()->board);
        plant_plan(&plant, name, 0);
    }
    return 1;
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

EXPORT("vehicle_reach") void vehicle_reach(int in_reach)
{
    board_radio_reach(in_reach != 0);
}

EXPORT("vehicle_meet_ramp") void vehicle_meet_ramp(void)
{
    const plant_t *now;

    ramp_from_m = quadrotor_state(board_quadrotor())->x_m;
    ramp_since_s = quadrotor_scenario_s(board_quadrotor());
    now = completed();
    quadrotor_follow(board_quadrotor(), now->board.course);
}
