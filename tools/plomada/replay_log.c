#include "replay_log.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control/flight.h"
#include "firmware/schedule.h"
#include "replay_mirrors.h"

#define LINE_MAX_OCTETS 512
#define COLUMNS_MAX 64
#define FRAMES 16U
#define GRAVITY_MPS2 9.80665
#define TELEMETRY_PERIOD_S 0.2
#define AGE_USUAL_S 0.0705 /* of the front mirror's rays at 250000 bit/s, when their scan arrives */
#define NEW_RAYS_S 0.02    /* less is rounding */
#define STAND_S 2.0
#define CLIMB_S 2.0
#define RAMP_S 0.6 /* of the take-off, until it leaves the ground */
#define ALOFT_M 0.15
#define GAP_S 1.0 /* longer ones stay gaps */
#define FRAME_S 0.025
#define FRAMES_A_SCAN 4U
#define TIME_MOST_S 1e6                /* eleven days */
#define BYTE_ORDER_MARK "\xEF\xBB\xBF" /* some programs begin a text with it */

typedef enum { T_S, MEAS_M, REF_M, THRUST_N, ROLL_RAD, PITCH_RAD, UP_MPS2, AGE_S, MIRRORS } field_t;
#define FIELD_COUNT (MIRRORS + REPLAY_MIRRORS_CELLS)
static const char *const fields[FIELD_COUNT] = {
    "t_s", "meas_m", "ref_m", "thrust_n", "roll_rad", "pitch_rad", "up_mps2", "age_s", REPLAY_MIRRORS_TITLES};

typedef struct {
    double value[FIELD_COUNT]; /* NAN: not there */
} row_t;

static struct {
    int place[FIELD_COUNT]; /* of each field among the columns; -1: none */
    bool telemetry;
    parameters_t parameters;
    flight_t flight;
    flight_inputs_t in;
    flight_outputs_t out;
    imu_sample_t frames[FRAMES];
    altitude_t mirrors[MIRROR_COUNT];
    bool several; /* more than one mirror is in the log */
    double rays_s, cycle_s, reference_m;
    uint32_t sequence; /* of the frames */
    unsigned long rows, heights, accelerations, settled;
    int columns;        /* of the titles */
    double last_s;      /* time of the row before */
    unsigned long line; /* that is read */
    bool torn;          /* by a NUL or by its length */
    char message[120];
} replay;

/* A row of a dump of #LOG; row 0 has its titles. */
static bool is_record(const char *line)
{
    return strncmp(line, "OK LOG ", 7) == 0 && strtol(line + 7, NULL, 10) > 0;
}

bool replay_log_reads(FILE *in)
{
    char line[LINE_MAX_OCTETS];
    bool found = false;

    for (int i = 0; i < 1000 && !found && fgets(line, sizeof line, in) != NULL; i++) {
        const char *text = line + (i == 0 && strncmp(line, BYTE_ORDER_MARK, 3) == 0 ? 3 : 0);

        found = strncmp(text, "t_s,", 4) == 0 || strncmp(text, "alt:", 4) == 0 || is_record(text);
    }
    rewind(in);
    return found;
}

static const char *wrong(const char *what, const char *subject)
{
    snprintf(replay.message, sizeof replay.message, "line %lu: %s: %s", replay.line, subject, what);
    return replay.message;
}

/* NAN: nothing there. False: something, and no number. */
static bool read_number(const char *text, double *value)
{
    char *end;

    *value = strtod(text, &end);
    if (*text == '\0') {
        *value = NAN;
    }
    return *text == '\0' || (end != text && *end == '\0' && isfinite(*value));
}

static void read_titles(char *line)
{
    char *rest = line;
    int place = 0;

    for (int f = 0; f < FIELD_COUNT; f++) {
        replay.place[f] = -1;
    }
    for (char *title; (title = strsep(&rest, ",")) != NULL; place++) {
        for (int f = 0; f < FIELD_COUNT; f++) {
            replay.place[f] = strcmp(title, fields[f]) == 0 ? place : replay.place[f];
        }
    }
    replay.columns = place;
}

static const char *read_cells(char *line, const char *cells[COLUMNS_MAX])
{
    char *rest = line;
    int count = 0;

    for (; count < COLUMNS_MAX && rest != NULL; count++) {
        cells[count] = strsep(&rest, ",");
    }
    return count == replay.columns ? NULL : wrong("not as many cells as titles", "row");
}

static const char *read_row(char *line, row_t *row)
{
    const char *cells[COLUMNS_MAX];
    const char *error = read_cells(line, cells);

    for (int f = 0; f < FIELD_COUNT && error == NULL; f++) {
        row->value[f] = NAN;
        if (replay.place[f] >= 0 && !read_number(cells[replay.place[f]], &row->value[f])) {
            error = wrong("not a number", fields[f]);
        }
    }
    if (error == NULL && !(row->value[T_S] >= -TIME_MOST_S && row->value[T_S] <= TIME_MOST_S)) {
        error = wrong("no time of a flight", fields[T_S]);
    }
    if (error == NULL && replay.rows > 0U && row->value[T_S] < replay.last_s) {
        error = wrong("before the row before it", fields[T_S]);
    }
    replay.last_s = row->value[T_S];
    return error;
}

static double told(const char *line, const char *key)
{
    const char *at = strstr(line, key);
    char *end;
    const double value = at == NULL ? NAN : strtod(at + strlen(key), &end);

    return at == NULL || end == at + strlen(key) || !isfinite(value) ? NAN : value;
}

/* The time of a line of telemetry is its place. */
static row_t read_telemetry(const char *line)
{
    row_t row;

    for (int f = 0; f < FIELD_COUNT; f++) {
        row.value[f] = NAN;
    }
    row.value[T_S] = (double)replay.rows * TELEMETRY_PERIOD_S;
    row.value[MEAS_M] = told(line, "alt:");
    row.value[REF_M] = told(line, "ref:");
    row.value[THRUST_N] = told(line, "thr:");
    row.value[AGE_S] = AGE_USUAL_S;
    return row;
}

static uint32_t microseconds(double t_s)
{
    return (uint32_t)(long long)llround(t_s * 1e6);
}

/* A row of nobody's, or of a log without the mirrors' columns, has the height alone. */
static void take_mirrors(const row_t *row, double roll_rad, double pitch_rad)
{
    const altitude_geometry_t places = altitude_geometry_of(&replay.parameters);
    const attitude_t tilt = {.roll_rad = (float)roll_rad, .pitch_rad = (float)pitch_rad};

    if (replay_mirrors_told(&row->value[MIRRORS]) > 0) {
        const mirror_windows_t windows = altitude_windows_of(&replay.parameters);

        replay_mirrors_read(replay.mirrors, &row->value[MIRRORS], row->value[AGE_S], &places, &windows,
                            &tilt);
    } else {
        replay_mirrors_make(replay.mirrors, row->value[MEAS_M], replay.several, &places, &tilt);
    }
}

static bool take_height(const row_t *row, double roll_rad, double pitch_rad)
{
    const double rays_s = row->value[T_S] - row->value[AGE_S];

    replay.in.height_valid = !isnan(row->value[MEAS_M]);
    if (!replay.in.height_valid || isnan(rays_s) || rays_s < replay.rays_s + NEW_RAYS_S) {
        return false;
    }
    replay.rays_s = rays_s;
    replay.heights++;
    take_mirrors(row, roll_rad, pitch_rad);
    replay.in.altitude = altitude_mean(replay.mirrors, altitude_weights_equal, MIRROR_COUNT);
    replay.in.mirrors = replay.several ? replay.mirrors : NULL;
    replay.in.height_time_us = microseconds(row->value[T_S]);
    replay.in.height_age_us = microseconds(row->value[AGE_S]);
    replay.in.height_stamp_ms = (uint32_t)llround(rays_s * 1e3) & UINT32_C(0xFFFFFF);
    replay.in.height_sequence++;
    return true;
}

/* The specific force stands upright: along the earth the vehicle is hardly pushed. */
static bool take_frame(const row_t *row, double roll_rad, double pitch_rad)
{
    const double force_mps2 = row->value[UP_MPS2] + GRAVITY_MPS2;
    const attitude_t tilt = {.roll_rad = (float)roll_rad, .pitch_rad = (float)pitch_rad};

    if (isnan(row->value[UP_MPS2]) && !replay.telemetry) {
        return false;
    }
    replay.sequence++;
    replay.accelerations += !replay.telemetry;
    memmove(replay.frames, replay.frames + 1, sizeof replay.frames - sizeof replay.frames[0]);
    replay.frames[FRAMES - 1U] = (imu_sample_t){
        .sequence = replay.sequence,
        .arrival_us = microseconds(row->value[T_S]),
        .ready = true,
        .level = tilt,
        .median = tilt,
        .tilt_roll_rad = (float)roll_rad,
        .tilt_pitch_rad = (float)pitch_rad,
        .has_acceleration = !replay.telemetry,
        .forward_mps2 = (float)(-force_mps2 * sin(pitch_rad)),
        .right_mps2 = (float)(force_mps2 * cos(pitch_rad) * sin(roll_rad)),
        .down_mps2 = (float)(force_mps2 * cos(pitch_rad) * cos(roll_rad)),
    };
    replay.in.frame_count = (uint16_t)(replay.sequence < FRAMES ? replay.sequence : FRAMES);
    replay.in.frames = replay.frames + FRAMES - replay.in.frame_count;
    replay.in.attitude_ready = true;
    replay.in.attitude_time_us = microseconds(row->value[T_S]);
    return true;
}

static void take_reference(const row_t *row)
{
    if (!isnan(row->value[REF_M]) && row->value[REF_M] != replay.reference_m) {
        replay.reference_m = row->value[REF_M];
        replay.in.reference_m = (float)replay.reference_m;
        replay.in.reference_sequence++;
    }
}

static void write_cell(FILE *csv, double value, int decimals)
{
    fputc(',', csv);
    if (!isnan(value)) {
        fprintf(csv, "%.*f", decimals, value);
    }
}

static void write_row(FILE *csv, const row_t *row)
{
    fprintf(csv, "%.3f", row->value[T_S]);
    write_cell(csv, row->value[MEAS_M], 3);
    write_cell(csv, (double)replay.out.estimate_mm * 1e-3, 3);
    fputc(',', csv); /* no innovation */
    write_cell(csv, row->value[REF_M], 3);
    write_cell(csv, (double)replay.out.thrust_n, 3);
    write_cell(csv, row->value[ROLL_RAD], 4);
    write_cell(csv, row->value[PITCH_RAD], 4);
    fprintf(csv, ",%s,%u", flight_state_name(replay.out.state), (unsigned)replay.out.flags);
    write_cell(csv, row->value[THRUST_N], 3);
    fputc('\n', csv);
}

/* One row: the firmware's cycle, when what is new in it releases one. */
static void step(const row_t *row)
{
    const double roll_rad = isnan(row->value[ROLL_RAD]) ? 0.0 : row->value[ROLL_RAD];
    const double pitch_rad = isnan(row->value[PITCH_RAD]) ? 0.0 : row->value[PITCH_RAD];
    const double since_s = row->value[T_S] - replay.cycle_s;
    const uint16_t releases = replay.out.releases;
    const unsigned news = (take_height(row, roll_rad, pitch_rad) ? FLIGHT_RELEASE_HEIGHT : 0U) |
                          (take_frame(row, roll_rad, pitch_rad) ? FLIGHT_RELEASE_FRAME : 0U) |
                          (since_s >= CONTROL_PERIOD_MS * 1e-3 ? FLIGHT_RELEASE_PERIOD : 0U);

    take_reference(row);
    if ((news & releases) == 0U && since_s < CONTROL_TIMEOUT_MS * 1e-3) {
        return;
    }
    replay.cycle_s = row->value[T_S];
    replay.in.now_us = microseconds(row->value[T_S]);
    replay.in.roll_rad = (float)roll_rad;
    replay.in.pitch_rad = (float)pitch_rad;
    flight_step(&replay.flight, &replay.parameters, &replay.in, &replay.out);
    /* The next heights and accelerations answer to the flown thrust. By the one of this replay the estimator
     * would take its own error for another hover thrust, and keep it. */
    if (!isnan(row->value[THRUST_N])) {
        replay.flight.thrust_n = (float)row->value[THRUST_N];
    }
}

/* A row of nobody's: what the one it is made of says of tilt, at this time and height. age_s: of its rays. */
static void step_between(const row_t *like, double t_s, double height_m, double up_mps2, double age_s)
{
    row_t row = *like;

    row.value[T_S] = t_s;
    row.value[MEAS_M] = height_m;
    row.value[UP_MPS2] = up_mps2;
    row.value[AGE_S] = age_s;
    for (int f = MIRRORS; f < FIELD_COUNT; f++) {
        row.value[f] = NAN;
    }
    step(&row);
}

/* A log may begin in the air. Before it the vehicle stands, and climbs to where the log begins, so that the
 * law has taken off by then. */
static void settle(const row_t *first)
{
    const double to_m = isnan(first->value[MEAS_M]) ? 0.0 : first->value[MEAS_M];
    const bool aloft = to_m > ALOFT_M;
    const double turn = M_PI / CLIMB_S, before_s = STAND_S + (aloft ? CLIMB_S + STAND_S : 0.0);
    row_t row = *first;

    row.value[REF_M] = 0.0;
    row.value[THRUST_N] = NAN;
    for (unsigned long i = 0; (double)i * FRAME_S < before_s; i++) {
        const double s = (double)i * FRAME_S, age_s = AGE_USUAL_S + (double)(i % FRAMES_A_SCAN) * FRAME_S;
        const double done = fmin(fmax((s - STAND_S) / CLIMB_S, 0.0), 1.0);
        const double climb_m = 0.5 * to_m * (1.0 - cos(M_PI * fmax(done - age_s / CLIMB_S, 0.0)));
        const double up_mps2 = done > 0.0 && done < 1.0 ? 0.5 * to_m * turn * turn * cos(M_PI * done) : 0.0;

        row.value[REF_M] = aloft && s >= STAND_S - RAMP_S ? first->value[REF_M] : 0.0;
        step_between(&row, first->value[T_S] - before_s + s, aloft ? climb_m : to_m,
                     replay.telemetry ? NAN : up_mps2, age_s);
    }
    replay.heights = 0;
    replay.settled = replay.accelerations;
}

/* Cycles between two rows that are far apart, as between lines of telemetry. */
static void fill(const row_t *last, double until_s)
{
    for (double t_s = last->value[T_S] + FRAME_S; t_s < until_s - 0.5 * FRAME_S && until_s < t_s + GAP_S;
         t_s += FRAME_S) {
        step_between(last, t_s, last->value[MEAS_M], NAN, last->value[AGE_S] + t_s - last->value[T_S]);
    }
}

static const char *set_parameters(const flight_options_t *sets)
{
    parameters_init(&replay.parameters);
    for (int i = 0; i < sets->override_count; i++) {
        const flight_override_t *o = &sets->overrides[i];
        const parameter_id_t id = parameter_find(o->name, strlen(o->name));

        if (id == PARAMETER_COUNT) {
            return "a reference is what the log says";
        }
        const float value = parameter_table[id].choices != NULL
                                ? (float)parameter_find_choice(id, o->value, strlen(o->value))
                                : strtof(o->value, NULL);
        if (parameters_set(&replay.parameters, id, value) != PARAMETER_ACCEPTED) {
            return "out of range";
        }
    }
    return NULL;
}

static void tell(void)
{
    fprintf(stderr,
            "open loop over %lu rows: %lu heights, %lu accelerations%s%s. The vehicle did not answer to this "
            "thrust.\n"
            "Not in a log: the octets of scanner, IMU and radio, when each came, damaged frames, single "
            "rays%s; what was before its first row.\n",
            replay.rows, replay.heights, replay.accelerations - replay.settled,
            replay.telemetry ? ", level assumed" : "",
            replay.accelerations == replay.settled ? " (without them EST flies by thrust and heights)" : "",
            replay.several ? "" : ", each mirror's height");
}

/* *is_row: whether the line is one of the flight. */
static const char *read_line(char *line, row_t *row, bool *is_row)
{
    *is_row = false;
    if (is_record(line)) {
        return wrong("a dump of #LOG; type `plomada log` with this file, and replay the CSV that it makes",
                     "OK LOG");
    }
    if (strncmp(line, "t_s,", 4) == 0) {
        read_titles(line);
        replay.telemetry = false;
        return NULL;
    }
    if (strncmp(line, "alt:", 4) == 0) {
        *row = read_telemetry(line);
        *is_row = replay.telemetry = true;
        return NULL;
    }
    if (replay.place[T_S] != 0 || replay.telemetry || (*line == '\0' && !replay.torn)) {
        return NULL;
    }
    if (replay.torn) {
        return wrong("not text", "row");
    }
    *is_row = true;
    return read_row(line, row);
}

static char *next_line(FILE *in, char line[LINE_MAX_OCTETS])
{
    if (fgets(line, LINE_MAX_OCTETS, in) == NULL) {
        return NULL;
    }
    replay.line++;
    replay.torn = strchr(line, '\n') == NULL && feof(in) == 0;
    line[strcspn(line, "\r\n")] = '\0';
    return replay.line == 1U && strncmp(line, BYTE_ORDER_MARK, 3) == 0 ? line + 3 : line;
}

static void fly_row(FILE *csv, const row_t *row, row_t *last)
{
    replay.several = replay.several || replay_mirrors_told(&row->value[MIRRORS]) > 1;
    if (replay.rows++ == 0U) {
        settle(row);
    } else {
        fill(last, row->value[T_S]);
    }
    *last = *row;
    step(row);
    write_row(csv, row);
}

const char *replay_log(FILE *in, const flight_options_t *sets, FILE *csv)
{
    char room[LINE_MAX_OCTETS];
    row_t row, last;
    bool is_row;

    memset(&replay, 0, sizeof replay);
    replay.place[T_S] = -1;
    replay.rays_s = replay.cycle_s = -HUGE_VAL;
    replay.in.has_throttle = true;
    replay.out = (flight_outputs_t)FLIGHT_OUTPUTS_INITIAL;
    flight_init(&replay.flight);
    const char *error = set_parameters(sets);
    if (error != NULL) {
        return error;
    }
    replay.out.releases = flight_releases(&replay.flight, &replay.parameters);
    fputs("t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,flown_n\n", csv);
    for (char *line; error == NULL && (line = next_line(in, room)) != NULL;) {
        error = read_line(line, &row, &is_row);
        if (error == NULL && is_row) {
            fly_row(csv, &row, &last);
        }
    }
    if (error != NULL) {
        return error;
    }
    tell();
    return replay.rows == 0U ? "no row of a flight in it" : NULL;
}
