#include "sim/wasm/vehicle.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sim/board.h"
#include "sim/scenarios/place_file.h"
#include "sim/scenarios/plant.h"
#include "sim/ti/f021/flash.h"
#include "sim/timeline.h"
#include "tools/plomada/commands.h"

#define EXPORT(name) __attribute__((export_name(name)))
#define ARGUMENTS_MAX 64
#define HEARD_MAX 32768
#define PLACE_TEXT_MAX 16384
#define RAMP_AHEAD_S 1.0
#define STICK_MIDDLE (1500 * SIM_US)

static char room[VEHICLE_ROOM];
static char heard[HEARD_MAX];
static int heard_count;
static bool on;
static plant_t plant; /* its figures stay from one power-on to the next */
static char place_text[PLACE_TEXT_MAX],
    next_place[PLACE_TEXT_MAX];           /* laid: now, and from the next power-on */
static place_file_t laid;                 /* place_text, read */
static double went_from_m, went_s = -1.0; /* where and when vehicle_go() was called; < 0: not */
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

/* The place that was laid, with the roughness and the bars of the figures, and its way from when it was
 * ordered. */
static void complete_place(plant_t *now)
{
    place_file_read(&laid, place_text, now->board.seed); /* vehicle_lay() has seen that it can be read */
    seed_course_floor(&now->ground, now->board.seed, &laid.place);
    now->board.place = &laid.place;
    now->course = (course_t){.count = 0};
    if (went_s >= 0.0) {
        now->course = laid.course;
        for (int i = 0; i < laid.course.count; i++) {
            now->course.legs[i].start_s += went_s - laid.course.legs[0].start_s;
        }
    }
}

static const plant_t *completed(void)
{
    static plant_t now;

    now = plant;
    plant_complete(&now);
    if (place_text[0] != '\0') {
        complete_place(&now);
    } else if (went_s >= 0.0) {
        seed_course_meet(&now.ground, went_from_m, went_s, RAMP_AHEAD_S, &now.place, &now.course);
    }
    return &now;
}

EXPORT("vehicle_power_on") void vehicle_power_on(unsigned seed)
{
    if (on) {
        board_power_off();
    }
    prepare_plant(seed);
    went_s = -1.0;
    memcpy(place_text, next_place, sizeof place_text);
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

EXPORT("vehicle_lay") int vehicle_lay(int size)
{
    static place_file_t tried;

    room[size < VEHICLE_ROOM ? size : VEHICLE_ROOM - 1] = '\0';
    if (size >= PLACE_TEXT_MAX) {
        return snprintf(room, sizeof room, "longer than %d octets", PLACE_TEXT_MAX - 1);
    }
    if (!place_file_read(&tried, room, 1)) {
        return snprintf(room, sizeof room, "line %u: %s", tried.line, tried.message);
    }
    memcpy(next_place, room, (size_t)size + 1);
    return 0;
}

EXPORT("vehicle_go") void vehicle_go(void)
{
    const plant_t *now;

    went_from_m = quadrotor_state(board_quadrotor())->x_m;
    went_s = quadrotor_scenario_s(board_quadrotor());
    now = completed();
    quadrotor_follow(board_quadrotor(), now->board.course);
}

EXPORT("vehicle_map") int vehicle_map(void)
{
    const place_t *place = quadrotor_place(board_quadrotor());
    const course_t *way = place_text[0] != '\0' ? &laid.course : completed()->board.course;
    const double t_s = quadrotor_scenario_s(board_quadrotor());
    size_t used = 0;

    for (int i = 0; i < place->count && used < sizeof room; i++) {
        place_block_t block;

        if (place_block_at(place, i, t_s, &block)) {
            used += (size_t)snprintf(&room[used], sizeof room - used,
                                     "block %.4f %.4f %.4f %.4f %.4f %.4f %.4f %.4f\n", block.x_m, block.y_m,
                                     block.heading_rad, block.length_m, block.width_m, block.bottom_m,
                                     block.near_top_m, block.far_top_m);
        }
    }
    for (int i = 0; i < way->count && used < sizeof room; i++) {
        used += (size_t)snprintf(&room[used], sizeof room - used, "leg %.4f %.4f\n", way->legs[i].x_m,
                                 way->legs[i].y_m);
    }
    return (int)(used < sizeof room ? used : sizeof room - 1);
}

EXPORT("vehicle_view") const vehicle_view_t *vehicle_view(void)
{
    static vehicle_view_t told;
    const quadrotor_state_t *state = quadrotor_state(board_quadrotor());
    const view_t view = view_of(quadrotor_place(board_quadrotor()), state,
                                quadrotor_scenario_s(board_quadrotor()));

    told.x_m = state->x_m;
    told.y_m = state->y_m;
    told.heading_rad = state->heading_rad;
    memcpy(told.ground_m, view.ground_m, sizeof told.ground_m);
    for (int i = 0; i < VIEW_BEAMS; i++) {
        const place_vector_t from = view.beam[i].from, to = view.beam[i].to;

        told.beam[i].from_x_m = from.x;
        told.beam[i].from_y_m = from.y;
        told.beam[i].from_z_m = from.z;
        told.beam[i].to_x_m = to.x;
        told.beam[i].to_y_m = to.y;
        told.beam[i].to_z_m = to.z;
        told.beam[i].meets = view.beam[i].meets ? 1.0 : 0.0;
    }
    return &told;
}
