#include "sim/scenarios/flight.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "control/est/estimator.h"
#include "firmware/published.h"
#include "sim/firmware_view.h"
#include "sim/devices/xbee.h"
#include "sim/host/pace.h"
#include "sim/scenarios/plant.h"
#include "sim/scenarios/wires.h"
#include "sim/tape.h"

#define START_LIMIT (60 * SIM_S)
#define STEP (10 * SIM_MS)
#define UPRIGHT 0.70710678 /* cosine of the tilt from which on the firmware may cut */
#define PINGS_PER_LINK 3.0 /* of the link's time-out */
#define PINGS_START_S 0.5  /* past the settings */
#define FIELD_DAY_LEAD_S 10.0
#define LINE_SPACING_S 0.05
#define BENCH_SETTINGS_S 0.5
#define ANSWER_PATIENCE (3 * SIM_S)
#define ANSWER_END (300 * SIM_MS) /* of silence */
#define DUMP_PATIENCE (600 * SIM_S)
#define DOWN_PATIENCE (60 * SIM_S)

static struct {
    plant_t plant;
    metrics_record_t record;
    sim_time_t origin;
    FILE *telemetry;
    char line[256]; /* of the operator's terminal */
    size_t line_length;
    unsigned ok, err;
    bool dumped;         /* #LOG has been answered to its end */
    bool asked;          /* #LASER has been typed */
    char answer[1024];   /* to it */
    sim_time_t answered; /* its latest line; 0: none */
    bool recording, first_row_recorded;
    bool in_place;
    place_file_t place;   /* valid while in_place */
    bool open_loop;       /* the vehicle answers to the flight as flown */
    uint32_t shown_frame; /* sequence of the latest in the log */
    uint32_t shown_scan;
    unsigned pings;
    double ping_every_s;
    bool by_hand; /* people order, and nobody has planned what and when */
} flight;

/* Both texts stand until the next call. */
static const char *out_of_range(parameter_id_t id)
{
    static char text[64];

    snprintf(text, sizeof text, "out of range %g..%g %s", (double)parameter_table[id].minimum,
             (double)parameter_table[id].maximum, parameter_table[id].unit);
    return text;
}

static const char *no_such_choice(parameter_id_t id)
{
    static char text[96];
    size_t used = (size_t)snprintf(text, sizeof text, "no such choice; one of");

    for (int i = 0; i <= (int)parameter_table[id].maximum; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "%s %s", i == 0 ? "" : ",",
                                 parameter_table[id].choices[i]);
    }
    return text;
}

static const char *check_parameter(parameter_id_t id, const char *text)
{
    parameters_t parameters;
    char *end;
    float value;

    parameters_init(&parameters);
    if (parameter_table[id].choices != NULL) {
        return parameter_find_choice(id, text, strlen(text)) < 0 ? no_such_choice(id) : NULL;
    }
    value = strtof(text, &end);
    if (*text == '\0' || *end != '\0') {
        return "not a number";
    }
    return parameters_set(&parameters, id, value) == PARAMETER_ACCEPTED ? NULL : out_of_range(id);
}

static const char *check_reference(const char *text)
{
    char *end;
    float reference_m = strtof(text, &end);

    if (*text == '\0' || *end != '\0') {
        return "not a number";
    }
    return reference_m >= 0.0F && reference_m <= FLIGHT_REFERENCE_MAX_M ? NULL : "out of range 0..3 m";
}

const char *flight_check(const char *name, const char *value)
{
    const parameter_id_t id = parameter_find(name, strlen(name));

    if (strcasecmp(name, "SETR") == 0) {
        return check_reference(value);
    }
    if (id == PARAMETER_COUNT) {
        return plant_known(name) ? plant_check(name, value) : "unknown name";
    }
    return check_parameter(id, value);
}

bool flight_knows(const char *name)
{
    return strcasecmp(name, "SETR") == 0 || parameter_find(name, strlen(name)) != PARAMETER_COUNT ||
           plant_known(name);
}

const char *flight_override(flight_options_t *options, const char *assignment)
{
    const char *equals = strchr(assignment, '=');
    flight_override_t *o = &options->overrides[options->override_count];
    const char *error;

    if (equals == NULL || (size_t)(equals - assignment) >= sizeof o->name ||
        strlen(equals + 1) >= sizeof o->value) {
        return "not of the form NAME=VALUE";
    }
    if (options->override_count == FLIGHT_OVERRIDES_MAX) {
        return "too many --set";
    }
    snprintf(o->name, sizeof o->name, "%.*s", (int)(equals - assignment), assignment);
    snprintf(o->value, sizeof o->value, "%s", equals + 1);
    error = flight_check(o->name, o->value);
    options->override_count += error == NULL;
    return error;
}

static const char *overridden(const flight_options_t *options, const char *name)
{
    for (int i = options->override_count - 1; i >= 0; i--) {
        if (strcasecmp(options->overrides[i].name, name) == 0) {
            return options->overrides[i].value;
        }
    }
    return NULL;
}

/* The operator's terminal
 * ---------------------------------------------------------------------------------------- */

static bool begins(const char *text)
{
    return strncmp(flight.line, text, strlen(text)) == 0;
}

static void keep_answer(void)
{
    const size_t used = strlen(flight.answer);

    snprintf(flight.answer + used, sizeof flight.answer - used, "%s\n", flight.line);
    flight.answered = timeline_now();
}

static void line_complete(void)
{
    flight.ok += begins("OK ");
    flight.err += begins("ERR ");
    flight.dumped = flight.dumped || begins("OK LOG END");
    if (flight.asked && (begins("OK LASER") || begins("ERR LASER"))) {
        keep_answer();
    } else if (flight.telemetry != NULL) {
        fprintf(flight.telemetry, "%s\n", flight.line);
        fflush(flight.telemetry);
    }
}

static void hear(void *context, unsigned octet)
{
    (void)context;
    if (octet == '\n') {
        flight.line[flight.line_length] = '\0';
        flight.line_length = 0;
        line_complete();
    } else if (octet != '\r' && flight.line_length < sizeof flight.line - 1) {
        flight.line[flight.line_length++] = (char)octet;
    }
}

static void terminal(void *context, unsigned octet)
{
    wires_show(octet);
    hear(context, octet);
}

static void type_event(void *text)
{
    board_type(text, strlen(text));
    free(text);
}

static sim_time_t at(double t_s)
{
    return flight.origin + (sim_time_t)llround(t_s * 1e9);
}

static void type_at(sim_time_t when, const char *name, const char *value)
{
    size_t size = strlen(name) + strlen(value) + 4;
    char *text = malloc(size);

    if (text == NULL) {
        abort();
    }
    snprintf(text, size, "#%s %s\n", name, value);
    timeline_at(when, type_event, text);
}

/* What must happen before t = 0. */
static double lead_s(const scenario_t *scenario)
{
    return scenario->field_day ? FIELD_DAY_LEAD_S : 0.0;
}

double flight_soonest_s(const scenario_t *scenario, const char *name, const char *value)
{
    const sim_time_t takes = xbee_latency(strlen(name) + strlen(value) + 3);

    return (double)takes * 1e-9 - lead_s(scenario);
}

/* The line is complete at the firmware's pin at t_s. */
static void type_complete_at(double t_s, const char *name, const char *value)
{
    type_at(at(t_s) - xbee_latency(strlen(name) + strlen(value) + 3), name, value);
}

static void type_overrides(const flight_options_t *options, double t_s)
{
    for (parameter_id_t id = 0; id < PARAMETER_COUNT; id++) {
        const char *value = overridden(options, parameter_table[id].name);

        if (value != NULL) {
            type_at(at(t_s), parameter_table[id].name, value);
            t_s += LINE_SPACING_S;
        }
    }
}

/* The setting itself, or that of the same name for an autopilot whose throttle commands a climb. */
static const char *suited(const scenario_t *scenario, const char *setting)
{
    const size_t name = strcspn(setting, " ") + 1U;

    for (int i = 0;
         flight.plant.board.quadrotor.climb_rate_mps_per_n > 0.0 && scenario->climb_settings[i] != NULL;
         i++) {
        if (strncmp(scenario->climb_settings[i], setting, name) == 0) {
            return scenario->climb_settings[i];
        }
    }
    return setting;
}

static void type_settings(const scenario_t *scenario, const flight_options_t *options)
{
    char name[16];
    double t_s = -lead_s(scenario);

    if (options->dump) {
        type_at(at(t_s), "LOG", "RATE FAST");
        t_s += LINE_SPACING_S;
    }
    for (int i = 0; i < SCENARIO_SETTINGS_MAX && scenario->settings[i] != NULL; i++) {
        const char *setting = suited(scenario, scenario->settings[i]);
        const char *value = strchr(setting, ' ') + 1;

        snprintf(name, sizeof name, "%.*s", (int)(value - setting - 1), setting);
        if (overridden(options, name) == NULL) {
            type_at(at(t_s), name, value);
            t_s += LINE_SPACING_S;
        }
    }
    type_overrides(options, t_s);
}

static void landing(void *context)
{
    (void)context;
    quadrotor_stop_counting_contacts(board_quadrotor());
}

/* An operator's terminal that keeps an armed link alive. */
static void ping(void *context)
{
    char number[16];

    (void)context;
    snprintf(number, sizeof number, "%u", ++flight.pings % 1000U);
    type_at(timeline_now(), "PING", number);
    timeline_after((sim_time_t)llround(flight.ping_every_s * 1e9), ping, NULL);
}

static void plan_pings(const flight_options_t *options)
{
    const char *link_s = overridden(options, "LINK");

    if (link_s != NULL && strtod(link_s, NULL) > 0.0) {
        flight.ping_every_s = strtod(link_s, NULL) / PINGS_PER_LINK;
        timeline_at(at(PINGS_START_S), ping, NULL);
    }
}

static void refer(void *line)
{
    const later_line_t *order = line;

    metrics_order(&flight.record, order->t_s, scenario_reference_m(order));
}

/* The scenario's own reference, after one that was ordered before it. */
static void refer_first(void *context)
{
    (void)context;
    metrics_order(&flight.record, METRICS_REFERENCE_S, flight.record.reference_m);
}

/* The record of the flight hears of another reference when the firmware does. */
static void plan_reference(const later_line_t *line)
{
    if (!isnan(scenario_reference_m(line))) {
        timeline_at(at(line->t_s), refer, (void *)(uintptr_t)line);
        if (line->t_s < METRICS_REFERENCE_S) {
            timeline_at(at(METRICS_REFERENCE_S), refer_first, NULL);
        }
    }
}

static void plan(const scenario_t *scenario, const flight_options_t *options)
{
    char reference[32];

    snprintf(reference, sizeof reference, "%g", flight.record.reference_m);
    type_settings(scenario, options);
    if (!scenario->by_stick) {
        type_complete_at(METRICS_REFERENCE_S, "SETR", reference);
    }
    for (const later_line_t *line = scenario->later; line->name != NULL; line++) {
        type_complete_at(line->t_s, line->name, line->value);
        plan_reference(line);
    }
    if (!scenario->by_stick) {
        type_complete_at(flight.record.land_s, "SETR", "0");
    }
    timeline_at(at(flight.record.land_s), landing, NULL);
    plant_plan(&flight.plant, NULL, flight.origin);
    plan_pings(options);
}

/* The flight
 * ----------------------------------------------------------------------------------------------------- */

/* The flight recorder's columns, then those that only the PC board can know. */
static void write_titles(FILE *csv)
{
    static telemetry_line_t line;

    telemetry_begin_answer(&line);
    published_titles(&line);
    fprintf(csv, "%.*s,height_m,abs_m,terrain_m,x_m,y_m,heading_rad%s\n", (int)line.length, line.text,
            flight.open_loop ? ",flown_n" : "");
}

static void write_number(FILE *csv, double value, int decimals)
{
    fputc(',', csv);
    if (!isnan(value)) {
        fprintf(csv, "%.*f", decimals, value);
    }
}

/* An acceleration is shown once. */
static bool new_frame(const imu_sample_t *frame)
{
    const bool unseen = frame->sequence != flight.shown_frame;

    flight.shown_frame = frame->sequence;
    return unseen && frame->ready && frame->has_acceleration;
}

static float height_age_us(const firmware_view_t *firmware)
{
    return (float)(firmware->now_us - firmware->altitude.arrival_us + firmware->altitude.age_us);
}

/* Of one mirror as it arrives, between two cycles too; of several what the latest cycle made of them. */
static float height_mm(const firmware_view_t *firmware)
{
    return firmware->altitude.mirror_count > 1U ? firmware->flight.height_mm
                                                : firmware->altitude.altitude.height_mm;
}

/* A scan is shown once, when the control cycle has it. */
static flight_beams_t new_beams(const firmware_view_t *firmware)
{
    const uint32_t scans = firmware->flight.signal.scans;
    const bool unseen = scans != flight.shown_scan;

    flight.shown_scan = scans;
    return unseen ? published_beams_of(&firmware->flight, firmware->now_us) : flight_beams_none();
}

/* As the firmware knows it at this instant, between two of its cycles too; the pulse as it is at the pin. */
static published_t published(void)
{
    const firmware_view_t firmware = firmware_view();
    const bool height = firmware.altitude.scan_valid, attitude = firmware.imu.ready;
    published_t now = {
        .height_mm = height ? height_mm(&firmware) : NAN,
        .age_us = height ? height_age_us(&firmware) : NAN,
        .roll_rad = attitude ? firmware.imu.median.roll_rad : NAN,
        .pitch_rad = attitude ? firmware.imu.median.pitch_rad : NAN,
        .up_mps2 = new_frame(&firmware.imu) ? imu_up_mps2(&firmware.imu) : NAN,
        .beams = new_beams(&firmware),
        .flight = firmware.flight,
    };

    now.flight.pulse_us = (float)board_pulse_us();
    return now;
}

static double in_column(double value, flight_log_scale_t scale)
{
    return scale == FLIGHT_LOG_MILLI ? value * 1e-3 : scale == FLIGHT_LOG_MICRO ? value * 1e-6 : value;
}

#define NUMBER(telemetry, decimals, column, log_decimals, csv_decimals, source, scale) \
    write_number(csv, in_column((double)now.source, scale), csv_decimals);
#define STATE(telemetry, column) fprintf(csv, ",%s", flight_state_name(now.flight.state));
#define FLAGS(telemetry, column) fprintf(csv, ",%u", (unsigned)now.flight.flags);
#define DERIVED(column, log_decimals, csv_decimals, source, function, of) \
    write_number(csv, (double)now.source, csv_decimals);
#define NAME(column, source, name_of, shift, bits) \
    fprintf(csv, ",%s", (now.source != 0U) ? name_of(now.source) : "");
#define TEXT(telemetry, source)
#define SET(column, source) fprintf(csv, ",%s", flight_beams_names(now.source));
#define BEAM(column, name) write_beam(csv, &now.beams.beam[name]);
static void write_beam(FILE *csv, const flight_beam_t *beam)
{
    write_number(csv, (double)beam->rays, 0);
    write_number(csv, (double)beam->slant_mm, 1);
    write_number(csv, (double)beam->spread_mm, 0);
    write_number(csv, (double)beam->age_us * 1e-3, 1);
    write_number(csv, (double)beam->lie * 100.0, 1);
}

static void write_row(FILE *csv, double t_s, const tape_truth_t *truth)
{
    const published_t now = published();

    fprintf(csv, "%.2f", t_s);
    PUBLISHED(NUMBER, DERIVED, STATE, FLAGS, NAME, TEXT, BEAM, SET)
    fprintf(csv, ",%.4f,%.4f,%.4f", truth->height_m, truth->altitude_m, truth->terrain_m);
    write_number(csv, truth->x_m, 4);
    write_number(csv, truth->y_m, 4);
    write_number(csv, truth->heading_rad, 4);
    if (flight.open_loop) {
        write_number(csv, truth->thrust_n, 3);
    }
    fputc('\n', csv);
}

static void record_number(const char *key, sim_time_t value)
{
    char text[24];

    snprintf(text, sizeof text, "%lld", (long long)value);
    tape_key(key, text);
}

/* The first row tells when the log begins, and what its time is counted from. */
static void record_row(const tape_truth_t *truth)
{
    if (!flight.first_row_recorded) {
        flight.first_row_recorded = true;
        record_number("origin_ns", flight.origin);
        record_number("first_row_ns", timeline_now());
    }
    tape_truth(truth);
}

/* What the firmware says that it doubts. */
static unsigned doubts_of(uint16_t flags)
{
    return ((flags & FLIGHT_FLAG_SIGHT) != 0U ? METRICS_SIGHT : 0U) |
           ((flags & FLIGHT_FLAG_IMU) != 0U ? METRICS_IMU : 0U) |
           ((flags & FLIGHT_FLAG_THRUST) != 0U ? METRICS_THRUST : 0U);
}

static metrics_sample_t look(double t_s, const quadrotor_state_t *truth)
{
    const flight_outputs_t out = firmware_view().flight;
    const flight_state_t phase = out.state;

    return (metrics_sample_t){.t_s = t_s,
                              .height_m = truth->height_m,
                              .speed_mps = truth->speed_mps,
                              .thrust_n = (double)out.thrust_n,
                              .taken_over = phase == FLIGHT_LOWERING || phase == FLIGHT_DESCENDING,
                              .coming_down = phase == FLIGHT_DESCENDING || phase == FLIGHT_LANDING,
                              .clearance_m = truth->clearance_m,
                              .on_ground = truth->on_ground,
                              .ours = board_selected(),
                              .doubts = doubts_of(out.flags),
                              .may_cut = board_selected() &&
                                         cos(truth->roll_rad) * cos(truth->pitch_rad) > UPRIGHT,
                              .flagged = out.flags != 0U,
                              .estimate_m = (double)out.estimate_mm * 1e-3,
                              .seen_m = board_seen_m(),
                              .altitude_m = truth->altitude_m};
}

/* Nobody planned when people order what: the firmware says what is in force. */
static void hear_reference(double t_s)
{
    const double reference_m = (double)firmware_view().flight.reference_m;

    if (reference_m != flight.record.wanted_m) {
        metrics_order(&flight.record, t_s, reference_m);
    }
}

static void sample(FILE *csv)
{
    const quadrotor_state_t *state = quadrotor_state(board_quadrotor());
    double t_s = (double)(timeline_now() - flight.origin) * 1e-9;
    const metrics_sample_t seen = look(t_s, state);

    if (flight.by_hand) {
        hear_reference(t_s);
    }
    metrics_add(&flight.record, &seen);
    const tape_truth_t truth = {.height_m = state->height_m,
                                .altitude_m = state->altitude_m,
                                .terrain_m = state->terrain_m,
                                .thrust_n = seen.thrust_n,
                                .x_m = state->x_m,
                                .y_m = state->y_m,
                                .heading_rad = state->heading_rad};

    if (flight.recording) {
        record_row(&truth);
    }
    if (csv != NULL) {
        write_row(csv, t_s, &truth);
    }
}

/* Everything that the recorder holds comes by radio. While the motors turn it still records, and the oldest
 * rows would be lost on the way. */
static void dump(void)
{
    const sim_time_t down = timeline_now() + DOWN_PATIENCE;

    while (quadrotor_state(board_quadrotor())->motors && timeline_now() < down &&
           kernel_run_until(timeline_now() + STEP)) {
    }
    const sim_time_t end = timeline_now() + DUMP_PATIENCE;

    type_at(timeline_now(), "LOG", "");
    while (!flight.dumped && timeline_now() < end && kernel_run_until(timeline_now() + STEP)) {
    }
}

static void set_plant(const char *setting)
{
    char name[32];
    const size_t length = strcspn(setting, " ");

    snprintf(name, sizeof name, "%.*s", (int)length, setting);
    plant_set(&flight.plant, name, strtod(setting + length, NULL));
}

static void configure(const scenario_t *scenario, const flight_options_t *options)
{
    board_config_t *board = &flight.plant.board;

    plant_init(&flight.plant, options->seed);
    flight.plant.ground.ramp = scenario->platform;
    board->quadrotor.tug_rate_per_s = scenario->tug_rate_per_s;
    board->quadrotor.climb_rate_mps_per_n = scenario->climb_rate_mps_per_n;
    if (flight.record.land_s > scenario->land_s) { /* the battery lasts as long */
        board->quadrotor.sag_per_s *= scenario->land_s / flight.record.land_s;
    }
    board->pilot.field_day = scenario->field_day;
    board->pilot.by_stick = scenario->by_stick;
    if (scenario->field_day) {
        board->quadrotor.naza.stop_type = NAZA_IMMEDIATELY;
        board->quadrotor.barometer_mps = 0.05;
        board->pilot.trim_n = board->quadrotor.hover_thrust_n;
    }
    for (int i = 0; scenario->plant[i] != NULL; i++) {
        set_plant(scenario->plant[i]);
    }
    for (int i = 0; i < options->override_count; i++) {
        if (plant_known(options->overrides[i].name)) {
            plant_set(&flight.plant, options->overrides[i].name, strtod(options->overrides[i].value, NULL));
        }
    }
    plant_complete(&flight.plant);
    if (options->costs != NULL) {
        board->costs = options->costs;
    }
    board->laser_faults = options->faults;
    board->laser_fault_count = options->fault_count;
    if (flight.in_place) {
        seed_course_floor(&flight.plant.ground, options->seed, &flight.place.place);
        board->place = &flight.place.place;
        board->course = &flight.place.course;
    }
    board->quadrotor.anchored = scenario->bench;
    board->quadrotor.bench_height_m = options->height_m;
}

/* Everything that a reader needs to know how the recording came about. */
static void record_origin(const scenario_t *scenario, const flight_options_t *options)
{
    char text[80];

    tape_record(options->record);
    tape_key("scenario", scenario->name);
    record_number("seed", (sim_time_t)options->seed);
    for (int i = 0; i < options->override_count; i++) {
        snprintf(text, sizeof text, "%s=%s", options->overrides[i].name, options->overrides[i].value);
        tape_key("set", text);
    }
}

static void power_on(const scenario_t *scenario, const flight_options_t *options)
{
    board_power_on(&flight.plant.board, terminal, NULL);
    flight.recording = options->record != NULL;
    if (flight.recording) {
        record_origin(scenario, options);
    }
    if (options->realtime) {
        pace_begin();
        wires_connect(hear, NULL);
        kernel_set_pacer(wires_pace);
    }
}

static void power_off(const flight_options_t *options)
{
    if (flight.recording) {
        tape_stop();
    }
    board_power_off();
    if (options->realtime) {
        kernel_set_pacer(NULL);
        pace_end();
        wires_close();
    }
}

/* Runs until scans arrive and the IMU's offset is known; then sets the origin of scenario time, at a phase
 * against the control loop that the seed draws. */
static bool start_up(const scenario_t *scenario, const flight_options_t *options)
{
    const sim_time_t lead = (sim_time_t)(lead_s(scenario) * 1e9);
    noise_t phase;

    while (!(firmware_view().scans >= 3U && firmware_view().imu.ready)) {
        if (timeline_now() >= START_LIMIT || !kernel_run_until(timeline_now() + STEP)) {
            return false;
        }
    }
    noise_init(&phase, options->seed, "origin");
    flight.origin = timeline_now() + 300 * SIM_MS + (sim_time_t)noise_uniform(&phase, 0.0, 108e6) + lead;
    quadrotor_set_origin(board_quadrotor(), flight.origin);
    return kernel_run_until(flight.origin - lead);
}

static void fly(const scenario_t *scenario, const flight_options_t *options)
{
    const double rest_s = options->patience_s > 0.0 ? options->patience_s
                                                    : scenario->end_s - scenario->land_s;
    long steps = lround((flight.record.land_s + rest_s) * 100.0);

    for (long i = -lround(lead_s(scenario) * 100.0);
         i <= steps && kernel_run_until(flight.origin + (sim_time_t)i * STEP); i++) {
        sample(options->csv);
        if (options->patience_s > 0.0 && metrics_over(&flight.record)) {
            return;
        }
    }
}

static void run_by_hand(const flight_options_t *options, double duration_s)
{
    sim_time_t end = duration_s > 0.0 ? (sim_time_t)(duration_s * 1e9) : SIM_NEVER;
    sim_time_t start = timeline_now() / STEP * STEP;

    for (long i = 1; !(options->realtime && pace_interrupted()) && timeline_now() < end; i++) {
        if (!kernel_run_until(start + (sim_time_t)i * STEP)) {
            return;
        }
        sample(options->csv);
    }
}

static void ask_laser(void)
{
    static const char question[] = "#LASER\n";
    sim_time_t end = timeline_now() + ANSWER_PATIENCE;

    flight.asked = true;
    board_type(question, strlen(question));
    while (timeline_now() < end && (flight.answered == 0 || timeline_now() < flight.answered + ANSWER_END) &&
           kernel_run_until(timeline_now() + STEP)) {
    }
    if (flight.telemetry != NULL) {
        fputs(flight.answer, flight.telemetry);
    }
}

static void stand(const scenario_t *scenario, const flight_options_t *options)
{
    double duration_s = options->duration_s;

    if (duration_s == 0.0 && !options->realtime) {
        duration_s = scenario->end_s;
    }
    if (overridden(options, "SETR") != NULL) {
        type_at(at(BENCH_SETTINGS_S), "SETR", overridden(options, "SETR"));
    }
    type_overrides(options, BENCH_SETTINGS_S + LINE_SPACING_S);
    run_by_hand(options, duration_s);
    ask_laser();
}

static void conclude(flight_result_t *result)
{
    double *value;

    metrics_compute(&flight.record, &result->metrics);
    value = result->metrics.value;
    value[METRIC_GROUND_CONTACTS] = quadrotor_state(board_quadrotor())->contacts;
    value[METRIC_MOTOR_STOPS] = quadrotor_state(board_quadrotor())->motor_stops;
    value[METRIC_MOTORS_AT_END] = quadrotor_state(board_quadrotor())->motors;
    value[METRIC_COLLIDED] = quadrotor_state(board_quadrotor())->collided;
    value[METRIC_SCANS] = firmware_view().scans;
    value[METRIC_SCANS_REJECTED] = (double)firmware_view().damages + firmware_view().altitude.heightless;
    value[METRIC_COMMANDS_OK] = flight.ok;
    value[METRIC_COMMANDS_ERR] = flight.err;
    for (int i = 0; i < METRIC_COUNT && flight.by_hand; i++) {
        value[i] = metrics_needs_plan((metric_t)i) ? NAN : value[i];
    }
    result->halt = kernel_halt_reason();
}

static const char *open_devices(const flight_options_t *options)
{
    static char message[256];
    board_wire_t failed;
    const char *error = options->realtime ? wires_open(options->device, &failed) : NULL;

    if (error == NULL) {
        return NULL;
    }
    snprintf(message, sizeof message, "--%s %s: %s", wire_names[failed], options->device[failed], error);
    return message;
}

static void run(const scenario_t *scenario, const flight_options_t *options, flight_result_t *result)
{
    result->started = true;
    if (scenario->bench) {
        stand(scenario, options);
    } else if (options->realtime) {
        run_by_hand(options, options->duration_s);
    } else if (start_up(scenario, options)) {
        plan(scenario, options);
        fly(scenario, options);
        if (options->dump) {
            dump();
        }
    } else {
        result->started = false;
    }
}

/* Where it flies, if anywhere. */
static bool lay_place(const char *text, unsigned long seed)
{
    flight.in_place = text != NULL;
    return text == NULL || place_file_read(&flight.place, text, seed);
}

const char *flight_prepare(const scenario_t *scenario, const flight_options_t *options)
{
    const char *error = open_devices(options);

    memset(&flight, 0, sizeof flight);
    if (error == NULL &&
        !lay_place(options->place != NULL ? options->place : scenario->place, options->seed)) {
        error = flight.place.message;
    }
    return error;
}

void flight_run(const scenario_t *scenario, const flight_options_t *options, flight_result_t *result)
{
    const char *reference = overridden(options, "SETR");

    memset(result, 0, sizeof *result);
    flight.telemetry = options->telemetry;
    metrics_begin(&flight.record, reference != NULL ? strtod(reference, NULL) : scenario->reference_m,
                  scenario->platform && options->place == NULL, /* else the platform is not there */
                  !options->realtime && options->duration_s > 0.0 ? options->duration_s : scenario->land_s);
    flight.record.field_day = scenario->field_day && !scenario->by_stick;
    configure(scenario, options);
    flight.by_hand = options->realtime && !scenario->bench;
    if (flight.by_hand) {
        metrics_begin(&flight.record, 0.0, false, INFINITY);
    }
    power_on(scenario, options);
    if (options->csv != NULL) {
        write_titles(options->csv);
    }
    run(scenario, options, result);
    conclude(result);
    power_off(options);
}

/* Again
 * ----------------------------------------------------------------------------------------------------------
 */

static sim_time_t number_of(const tape_t *tape, const char *key)
{
    const char *text = tape_value(tape, key, 0);

    return text == NULL ? -1 : (sim_time_t)strtoll(text, NULL, 10);
}

static void replay_rows(const tape_t *tape, sim_time_t first, FILE *csv, size_t *rows)
{
    tape_truth_t truth;

    for (*rows = 0; tape_truth_row(tape, *rows, &truth) && kernel_run_until(first + (sim_time_t)*rows * STEP);
         (*rows)++) {
        write_row(csv, (double)(timeline_now() - flight.origin) * 1e-9, &truth);
    }
}

const char *flight_replay(const tape_t *tape, bool open_loop, FILE *csv, FILE *telemetry,
                          flight_replay_t *result)
{
    const sim_time_t first = number_of(tape, "first_row_ns");
    board_config_t config = board_config(1);

    memset(&flight, 0, sizeof flight);
    memset(result, 0, sizeof *result);
    if (first < 0 || first > tape_end(tape)) {
        return "the recording ends before its first row";
    }
    flight.origin = number_of(tape, "origin_ns");
    flight.telemetry = telemetry;
    flight.open_loop = open_loop;
    tape_restore_flash(tape);
    board_power_on(&config, NULL, NULL);
    tape_play(tape, hear, NULL);
    write_titles(csv);
    replay_rows(tape, first, csv, &result->rows);
    result->halt = kernel_halt_reason();
    result->end_s = (double)timeline_now() * 1e-9;
    board_power_off();
    return NULL;
}
