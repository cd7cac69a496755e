#include "bench_flight.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "sim/noise.h"
#include "sim/scenarios/flight.h"
#include "terminal.h"
#include "world.h"

#define DAMAGED_MOST 3 /* frames of a flight: a plug that was touched */
#define SAMPLE (10 * SIM_MS)
#define COUNTS_PER_US (1.0 / 0.48)
#define IDLE_COUNTS 4166.0
#define COUNTS_PER_N 177.21
#define IDLE_N 0.02 /* less is none: an analyser sees a pulse to some 2 us */
#define DOWN_N 6.9  /* the model hovers at 7.4 N */
#define DOWN_FOR (2 * SIM_S)
#define LANDING_PATIENCE (20 * SIM_S)
#define LATE_MS 100.0
#define LATE_SCANS 1  /* that may be on their way when the scanner is silenced */
#define LATE_FRAMES 3 /* the same of the IMU */
#define SETTLE_S 20.0
#define LATE_ANSWER (400 * SIM_MS) /* two telemetry lines may go before it */
#define SEEDS 5
#define PLANT_DELAY_S 0.010

static metrics_record_t record;
static const char *const wires[] = {"laser", "imu", "xbee"};
_Static_assert(sizeof wires / sizeof wires[0] == BOARD_WIRES, "every wire has a name");

static void trouble(bench_flight_t *flight, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void trouble(bench_flight_t *flight, const char *format, ...)
{
    va_list arguments;

    if (flight->trouble_count < BENCH_TROUBLES_MAX) {
        va_start(arguments, format);
        vsnprintf(flight->trouble[flight->trouble_count++], sizeof flight->trouble[0], format, arguments);
        va_end(arguments);
    }
}

/* ---- before the flight ---- */

static bool has_height(void)
{
    char height[16], laser[16];
    sim_time_t when;

    (void)terminal_telemetry(&when);
    terminal_field("alt:", height, sizeof height);
    terminal_field("laser:", laser, sizeof laser);
    return timeline_now() - when < SIM_S && height[0] != '\0' && strcmp(height, "-") != 0 &&
           strcmp(laser, "OK") == 0;
}

static void say_what_is_missing(bench_flight_t *flight)
{
    const urg04lx_state_t laser = urg04lx_state(world_laser());
    sim_time_t when;
    char flags[16], state[16];

    if (terminal_telemetry(&when)[0] == '\0') {
        trouble(flight, "xbee: %s",
                world_wire(BOARD_RADIO).octets_in == 0 ? "nothing comes from the board"
                                                       : "garbled: what comes from the board means nothing");
        return;
    }
    terminal_field("laser:", state, sizeof state);
    terminal_field("flags:", flags, sizeof flags);
    if (laser.commands == 0) {
        trouble(flight, "laser: %s",
                world_wire(BOARD_LASER).octets_in == 0 ? "no command comes from the board"
                                                       : "garbled: what comes from the board is no command");
    } else if (strcmp(state, "OK") != 0) {
        trouble(flight, "laser: the board says laser:%s; %u scans were sent", state, laser.scans_sent);
    } else if ((strtoul(flags, NULL, 10) & 2U) != 0) {
        trouble(flight, "imu: the board knows no attitude (flags:%s)", flags);
    } else {
        trouble(flight, "laser: scans arrive, and the board has no height (flags:%s)", flags);
    }
}

bool bench_await_heights(double patience_s, bench_flight_t *flight)
{
    const sim_time_t end = timeline_now() + (sim_time_t)(patience_s * 1e9);
    int seen = 0;

    world_type("#STREAM OFF");
    while (seen < 10 && timeline_now() < end) {
        if (!world_run_until(timeline_now() + 100 * SIM_MS)) {
            flight->interrupted = true;
            return false;
        }
        seen = has_height() ? seen + 1 : 0;
    }
    if (seen < 10) {
        say_what_is_missing(flight);
    }
    return seen >= 10;
}

static bool command(bench_flight_t *flight, const char *text)
{
    char answer[160];

    const sim_time_t begun = timeline_now();
    const bool fine = terminal_ask(text, answer, sizeof answer);

    if (fine && timeline_now() - begun > LATE_ANSWER) {
        trouble(flight, "xbee: late: %.0f ms until #%s was answered", (double)(timeline_now() - begun) * 1e-6,
                text);
    }
    if (fine) {
        return true;
    }
    trouble(flight, "xbee: #%s: %s", text, answer[0] != '\0' ? answer : "no answer");
    return false;
}

/* A figure of the board's answer to a command. */
static unsigned long count_of(const char *command, const char *name)
{
    char answer[200];
    const char *at;

    if (!terminal_ask(command, answer, sizeof answer)) {
        return 0;
    }
    at = strstr(terminal_rest(SIM_S / 2), name);
    return at != NULL ? strtoul(at + strlen(name), NULL, 10) : 0;
}

/* A sensor is silenced: what the board still hears was late. The first count is asked for at once; the board
 * takes it some 0.1 s later, the IMU's 0.2 s. */
static void time_sensor(board_wire_t wire, const char *command, unsigned long few, bench_flight_t *flight)
{
    unsigned long frames;

    world_mute(wire, true);
    frames = count_of(command, "frames:");
    (void)world_run_until(timeline_now() + SIM_S / 2);
    frames = count_of(command, "frames:") - frames;
    world_mute(wire, false);
    if (frames > few) {
        trouble(flight, "%s: late: %lu frames came more than 0.2 s after they were sent", wires[wire],
                frames);
    }
}

static void time_sensors(bench_flight_t *flight)
{
    time_sensor(BOARD_LASER, "LASER", LATE_SCANS, flight);
    time_sensor(BOARD_IMU, "IMU", LATE_FRAMES, flight);
    (void)bench_await_heights(SETTLE_S, flight);
}

static bool settings(const scenario_t *scenario, bench_flight_t *flight)
{
    for (int i = 0; i < SCENARIO_SETTINGS_MAX && scenario->settings[i] != NULL; i++) {
        if (!command(flight, scenario->settings[i])) {
            return false;
        }
    }
    return command(flight, "PERF RESET") && command(flight, "STREAM PULSE");
}

/* ---- the flight ---- */

/* By the newest pulse; no pulse yet: none. */
static double commanded_n(void)
{
    sim_time_t when;
    const double pulse_us = world_pulse_us(&when);
    const double thrust_n = (IDLE_COUNTS - pulse_us * COUNTS_PER_US) / COUNTS_PER_N;

    return pulse_us > 0.0 && thrust_n > IDLE_N ? thrust_n : 0.0;
}

/* The vehicle is a model of this PC, and nothing but the board's pulse moves it: what follows from vehicle,
 * pulse and reference is known. What the firmware believes is not. */
static void sample(sim_time_t origin)
{
    const quadrotor_state_t *state = quadrotor_state(world_quadrotor());
    const metrics_sample_t seen = {.t_s = (double)(timeline_now() - origin) * 1e-9,
                                   .height_m = state->height_m,
                                   .speed_mps = state->speed_mps,
                                   .thrust_n = commanded_n(),
                                   .clearance_m = state->clearance_m,
                                   .on_ground = state->on_ground,
                                   .ours = true,
                                   .may_cut = true,
                                   .estimate_m = NAN,
                                   .seen_m = state->height_m,
                                   .altitude_m = state->altitude_m};

    metrics_add(&record, &seen);
}

static void type_event(void *text)
{
    world_type(text);
    free(text);
}

/* Complete at the board at t_s: ten bits an octet at 9600. */
static void type_at(sim_time_t origin, double t_s, const char *name, const char *value)
{
    const size_t size = strlen(name) + strlen(value) + 3;
    char *text = malloc(size);

    if (text == NULL) {
        abort();
    }
    snprintf(text, size, "#%s %s", name, value);
    timeline_at(origin + (sim_time_t)((t_s - (double)(strlen(text) + 1) / 960.0) * 1e9), type_event, text);
}

static void refer(void *line)
{
    const later_line_t *order = line;

    metrics_order(&record, order->t_s, scenario_reference_m(order));
}

/* The scenario's own reference, after one that was ordered before it. */
static void refer_first(void *unused)
{
    (void)unused;
    metrics_order(&record, METRICS_REFERENCE_S, record.reference_m);
}

static void landing(void *unused)
{
    (void)unused;
    quadrotor_stop_counting_contacts(world_quadrotor());
}

static sim_time_t plan(const scenario_t *scenario, unsigned long seed)
{
    noise_t phase;
    char reference[16];
    sim_time_t origin;

    noise_init(&phase, seed, "origin");
    origin = timeline_now() + 300 * SIM_MS + (sim_time_t)noise_uniform(&phase, 0.0, 108e6);
    quadrotor_set_origin(world_quadrotor(), origin);
    snprintf(reference, sizeof reference, "%g", scenario->reference_m);
    type_at(origin, METRICS_REFERENCE_S, "SETR", reference);
    for (const later_line_t *line = scenario->later; line->name != NULL; line++) {
        type_at(origin, line->t_s, line->name, line->value);
        if (!isnan(scenario_reference_m(line))) {
            timeline_at(origin + (sim_time_t)(line->t_s * 1e9), refer, (void *)(uintptr_t)line);
            if (line->t_s < METRICS_REFERENCE_S) {
                timeline_at(origin + (sim_time_t)(METRICS_REFERENCE_S * 1e9), refer_first, NULL);
            }
        }
    }
    type_at(origin, scenario->land_s, "SETR", "0");
    timeline_at(origin + (sim_time_t)(scenario->land_s * 1e9), landing, NULL);
    return origin;
}

/* Until the end, or until nobody knows the pulse any more. */
static bool fly(const scenario_t *scenario, sim_time_t origin, bench_flight_t *flight)
{
    const long steps = lround(scenario->end_s * 100.0);

    for (long i = 0; i <= steps; i++) {
        if (!world_run_until(origin + (sim_time_t)i * SAMPLE)) {
            flight->interrupted = true;
            return false;
        }
        sample(origin);
        if (world_silent()) {
            trouble(flight, "xbee: silent: no pulse for 0.5 s at t = %.2f s", (double)i * 0.01);
            return false;
        }
    }
    return true;
}

/* ---- after it ---- */

/* On the ground, and not about to leave it: without a scanner the board does not know that it has landed, and
 * goes on with the thrust of its descent. */
static bool is_down(void)
{
    sim_time_t when;
    const double thrust_n = (IDLE_COUNTS - world_pulse_us(&when) * COUNTS_PER_US) / COUNTS_PER_N;

    return quadrotor_state(world_quadrotor())->on_ground && thrust_n < DOWN_N;
}

static void end_safe(bench_flight_t *flight)
{
    const sim_time_t end = timeline_now() + LANDING_PATIENCE;
    sim_time_t down = timeline_now();

    world_type("#SETR 0");
    while (timeline_now() - down < DOWN_FOR && !world_silent() && timeline_now() < end &&
           world_run_until(timeline_now() + 100 * SIM_MS)) {
        down = is_down() ? down : timeline_now();
    }
    flight->radio_lost = world_silent();
    flight->safe = timeline_now() - down >= DOWN_FOR && !flight->radio_lost;
    flight->last_pulse_us = world_pulse_us(&down);
    world_type("#STREAM OFF");
}

/* Frames that the board found damaged, and what from it meant nothing here. */
typedef struct {
    unsigned long laser, imu, strange[BOARD_WIRES];
} damage_t;

static damage_t damage(void)
{
    damage_t now = {.laser = bench_damaged_frames(), .imu = bench_refused_frames()};

    for (int i = 0; i < BOARD_WIRES; i++) {
        now.strange[i] = world_wire((board_wire_t)i).strange;
    }
    return now;
}

static void report_wires(sim_time_t origin, const damage_t *before, bench_flight_t *flight)
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        const world_wire_t wire = world_wire((board_wire_t)i);

        if (wire.lost) {
            trouble(flight, "%s: gone: the adapter was lost at t = %.1f s", wires[i],
                    (double)(wire.lost_at - origin) * 1e-9);
        } else if (wire.refused > 0) {
            trouble(flight, "%s: late: the adapter did not take %lu octets", wires[i], wire.refused);
        }
        if (wire.strange > before->strange[i]) {
            trouble(flight, "%s: garbled: %lu %s from the board mean nothing", wires[i],
                    wire.strange - before->strange[i], i == BOARD_RADIO ? "lines" : "commands or octets");
        }
    }
    if (flight->has_delay && flight->delay_ms > LATE_MS) {
        trouble(flight, "laser: late: %.0f ms from a scan to its pulse", flight->delay_ms);
    }
}

unsigned long bench_refused_frames(void)
{
    return count_of("IMU", "refused:");
}

unsigned long bench_damaged_frames(void)
{
    static const char *const causes[] = {"sum:", "length:", "echo:", "char:", "seq:", "framing:"};
    char answer[200];
    unsigned long sum = 0;

    if (!terminal_ask("LASER", answer, sizeof answer)) {
        return 0;
    }
    const char *rest = terminal_rest(SIM_S / 2);

    for (size_t i = 0; i < sizeof causes / sizeof causes[0]; i++) {
        const char *at = strstr(rest, causes[i]);

        sum += at != NULL ? strtoul(at + strlen(causes[i]), NULL, 10) : 0;
    }
    return sum;
}

/* What the board has found damaged since `before`: a few frames are those of its start. */
static void ask_board(damage_t before, bench_flight_t *flight)
{
    const damage_t now = damage();
    const damage_t found = {.laser = now.laser - before.laser, .imu = now.imu - before.imu};

    printf(
        "damaged: laser %lu and imu %lu frames found by the board; laser %lu commands and xbee %lu lines not "
        "understood here\n",
        found.laser, found.imu, now.strange[BOARD_LASER] - before.strange[BOARD_LASER],
        now.strange[BOARD_RADIO] - before.strange[BOARD_RADIO]);
    if (found.laser > DAMAGED_MOST) {
        trouble(flight, "laser: garbled: the board found %lu frames damaged", found.laser);
    }
    if (found.imu > DAMAGED_MOST) {
        trouble(flight, "imu: garbled: the board found %lu frames damaged", found.imu);
    }
}

static void report_pin(bench_flight_t *flight)
{
    if (world_strange_pulses() > 0) {
        trouble(flight, "pin: %lu pulses are not of 0.9 to 2.1 ms", world_strange_pulses());
    }
    if (world_pin_still()) {
        trouble(flight, "pin: no pulse");
    }
}

void bench_fly(const scenario_t *scenario, unsigned long seed, FILE *progress, bench_flight_t *flight)
{
    sim_time_t origin;

    metrics_begin(&record, scenario->reference_m, scenario->platform, scenario->land_s);
    time_sensors(flight);
    const damage_t before = damage();

    flight->started = settings(scenario, flight);
    if (!flight->started) {
        world_type("#STREAM OFF");
        return;
    }
    if (progress != NULL) {
        fprintf(progress, "%s: the board flies, %.0f s\n", scenario->name, scenario->end_s);
        fflush(progress);
    }
    world_delay_reset();
    origin = plan(scenario, seed);
    (void)fly(scenario, origin, flight);
    flight->has_delay = world_delay_ms(&flight->delay_ms, &flight->delay_most_ms);
    flight->lag_ms = (double)world_worst_lag() * 1e-6;
    end_safe(flight);
    report_wires(origin, &before, flight);
    report_pin(flight);
    if (!flight->interrupted && !flight->radio_lost) {
        ask_board(before, flight);
    }
    metrics_compute(&record, &flight->metrics);
    flight->metrics.value[METRIC_GROUND_CONTACTS] = quadrotor_state(world_quadrotor())->contacts;
    flight->metrics.value[METRIC_COLLIDED] = quadrotor_state(world_quadrotor())->collided;
}

/* ---- the judgement ---- */

bool bench_can_judge(metric_t metric)
{
    switch (metric) {
    case METRIC_SCANS:
    case METRIC_SCANS_REJECTED:
    case METRIC_COMMANDS_OK:
    case METRIC_COMMANDS_ERR:
    case METRIC_TAKEOVERS:
    case METRIC_DOWN_S:
    case METRIC_STOPPED_S:
    case METRIC_DECEIVED_S:
    case METRIC_FLAGGED_S:
    case METRIC_SIGHT_DOUBTS:
    case METRIC_IMU_DOUBTS:
    case METRIC_THRUST_DOUBTS:
    case METRIC_MOTOR_STOPS:
    case METRIC_MOTORS_AT_END:
        return false;
    default:
        return true;
    }
}

static bool simulate(const scenario_t *scenario, unsigned long seed, double delay_s, metrics_t *metrics)
{
    static flight_options_t options;
    static flight_result_t result;
    char setting[32];

    options = (flight_options_t){.seed = seed};
    snprintf(setting, sizeof setting, "plant.tdelay=%.4f", delay_s);
    if (flight_override(&options, setting) != NULL || flight_prepare(scenario, &options) != NULL) {
        return false;
    }
    flight_run(scenario, &options, &result);
    *metrics = result.metrics;
    return result.started;
}

static void widen_by(scenario_t *widened, const metrics_t *without, const metrics_t *with)
{
    for (int i = 0; i < widened->expectation_count; i++) {
        expectation_t *e = &widened->expectations[i];
        const double shift = with->value[e->metric] - without->value[e->metric];

        e->maximum += isnan(shift) ? 0.0 : fmax(shift, 0.0);
        e->minimum += isnan(shift) ? 0.0 : fmin(shift, 0.0);
    }
}

double bench_simulated_delay_ms(const scenario_t *scenario)
{
    double period_ms = 0.0;

    for (int i = 0; i < SCENARIO_SETTINGS_MAX && scenario->settings[i] != NULL; i++) {
        period_ms = strcmp(scenario->settings[i], "RELEASE FREE") == 0 ? 108.0 : period_ms;
    }
    return 10.3 + 0.95 * period_ms;
}

double bench_widen(const scenario_t *scenario, const bench_flight_t *flight, scenario_t *widened)
{
    const double added_ms = flight->has_delay ? flight->delay_most_ms - bench_simulated_delay_ms(scenario)
                                              : 0.0;
    scenario_t widest = *scenario;

    *widened = *scenario;
    for (unsigned long seed = 1; added_ms >= 1.0 && seed <= SEEDS; seed++) {
        scenario_t one = *scenario;
        metrics_t without, with;

        if (!simulate(scenario, seed, PLANT_DELAY_S, &without) ||
            !simulate(scenario, seed, PLANT_DELAY_S + added_ms * 1e-3, &with)) {
            continue;
        }
        widen_by(&one, &without, &with);
        for (int i = 0; i < widest.expectation_count; i++) {
            widest.expectations[i].maximum = fmax(widest.expectations[i].maximum,
                                                  one.expectations[i].maximum);
            widest.expectations[i].minimum = fmin(widest.expectations[i].minimum,
                                                  one.expectations[i].minimum);
        }
    }
    *widened = widest;
    return fmax(added_ms, 0.0);
}
