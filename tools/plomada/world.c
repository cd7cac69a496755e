#include "world.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "pulses.h"
#include "sim/host/pace.h"
#include "sim/noise.h"

#define IMU_RATE 57600UL
#define RADIO_RATE 9600UL
#define QUIET (3 * SIM_MS) /* an adapter has sent what it took; then its rate may change */
#define PWM_PERIOD (13600 * SIM_US)
#define SHORTEST_DELAY \
    (8 * SIM_MS) /* a pulse's eight octets at 9600: a line before that belongs to another cycle */
#define DELAYS_MAX 4096
#define PULSE_PATIENCE (500 * SIM_MS)
#define LAG_THAT_COUNTS (30 * SIM_MS)
#define PIN_LOOK (2 * SIM_MS)
#define CHANNEL_LEAST_US 900.0 /* a servo channel has 1 to 2 ms */
#define CHANNEL_MOST_US 2100.0
#define OTHER_PULSE_US 1.0 /* twice the count of the compare register */

typedef struct {
    port_t port;
    unsigned long rate; /* set at the adapter */
    sim_time_t written;
    bool muted;
    unsigned damage_one_in, damage_count;
    world_wire_t seen;
} wire_t;

static struct {
    world_config_t config;
    wire_t wires[BOARD_WIRES];
    quadrotor_t *quadrotor;
    scene_t scene;
    urg04lx_t *laser;
    razor9dof_t *imu;
    noise_t nonsense;
    char line[160];
    size_t length;
    bool overlong;
    bool whole; /* a line has ended: what comes now was heard from its beginning */
    bool held;
    double pulse_us;
    sim_time_t pulse_at;
    sim_time_t heard_at; /* the board told a pulse */
    struct {
        int file; /* -1: nobody looks at the pin */
        pulse_reader_t reader;
        char line[80];
        size_t length;
        unsigned long strange;
    } pin;
    bool scan_waits; /* for the pulse that follows from it */
    unsigned last_octet;
    sim_time_t scan_end;
    sim_time_t lagged_at, worst_lag;
    double delays_ms[DELAYS_MAX];
    int delays;
} world;

/* ---- towards the board ---- */

static void put(board_wire_t index, const unsigned char *octets, size_t count)
{
    wire_t *wire = &world.wires[index];
    const size_t taken = pace_lost(&wire->port) ? 0 : port_write(&wire->port, octets, count);

    wire->seen.octets_out += taken;
    wire->seen.refused += count - taken;
    wire->written = timeline_now();
}

static void sensor_octet(board_wire_t index, unsigned octet)
{
    wire_t *wire = &world.wires[index];
    unsigned char c = (unsigned char)octet;

    if (wire->muted) {
        return;
    }
    wire->damage_count++;
    if (wire->damage_one_in != 0 && wire->damage_count % wire->damage_one_in == 0) {
        c ^= (unsigned char)(1U << (noise_bits(&world.nonsense) % 7U));
    }
    put(index, &c, 1);
}

/* A reply ends with an empty line. */
static void from_laser(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    (void)bit_ns;
    sensor_octet(BOARD_LASER, octet);
    if (octet == '\n' && world.last_octet == '\n' && urg04lx_state(world.laser).streaming) {
        world.scan_end = timeline_now();
        world.scan_waits = true;
    }
    world.last_octet = octet;
}

static void from_imu(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    (void)bit_ns;
    sensor_octet(BOARD_IMU, octet);
}

void world_type(const char *line)
{
    put(BOARD_RADIO, (const unsigned char *)line, strlen(line));
    put(BOARD_RADIO, (const unsigned char *)"\n", 1);
}

/* ---- from the board ---- */

static void to_laser(void *context, const unsigned char *octets, size_t count)
{
    wire_t *wire = context;

    wire->seen.octets_in += count;
    for (size_t i = 0; i < count; i++) {
        urg04lx_receive(world.laser, octets[i], 1e9 / (double)wire->rate);
    }
}

static void to_imu(void *context, const unsigned char *octets, size_t count)
{
    wire_t *wire = context;

    (void)octets;
    wire->seen.octets_in += count;
}

static bool is_pulse(const char *text)
{
    return text[0] == 'P' && text[1] != '\0' && strspn(text + 1, "0123456789") == strlen(text + 1);
}

/* answers: it may follow from the latest scan. */
static void take_pulse(double pulse_us, bool answers)
{
    const sim_time_t now = timeline_now();

    world.pulse_us = pulse_us;
    world.pulse_at = now;
    if (!world.held) {
        quadrotor_pulse(world.quadrotor, (sim_time_t)(pulse_us * 1000.0));
    }
    if (world.scan_waits && answers) {
        world.scan_waits = false;
        if (world.delays < DELAYS_MAX) {
            world.delays_ms[world.delays++] = (double)(now - world.scan_end) * 1e-6;
        }
    }
}

static void pulse_told(const char *digits)
{
    world.heard_at = timeline_now();
    if (world.pin.file < 0) {
        take_pulse(strtod(digits, NULL) * 0.1, timeline_now() - world.scan_end >= SHORTEST_DELAY);
    }
}

/* The pin repeats its pulse: the first that is another one follows from the scan. */
static void pulse_seen(double high_us)
{
    if (high_us < CHANNEL_LEAST_US || high_us > CHANNEL_MOST_US) {
        world.pin.strange++;
    } else {
        take_pulse(high_us, fabs(high_us - world.pulse_us) > OTHER_PULSE_US);
    }
}

static void pin_line(void)
{
    double high_us, end_s;

    world.pin.line[world.pin.length] = '\0';
    world.pin.length = 0;
    switch (pulse_line(&world.pin.reader, world.pin.line, &high_us, &end_s)) {
    case PULSE_ENDED:
        pulse_seen(high_us);
        break;
    case PULSE_NONSENSE:
        world.pin.strange++;
        break;
    case PULSE_NONE:
        break;
    }
}

static void look_at_pin(void *context)
{
    char text[4096];
    ssize_t count;

    while ((count = read(world.pin.file, text, sizeof text)) > 0) {
        for (ssize_t i = 0; i < count; i++) {
            if (world.pin.length < sizeof world.pin.line - 2) {
                world.pin.line[world.pin.length++] = text[i];
            }
            if (text[i] == '\n') {
                pin_line();
            }
        }
    }
    timeline_after(PIN_LOOK, look_at_pin, context);
}

bool world_watch_pin(void)
{
    if (world.config.pulses != NULL) {
        world.pin.file = open(world.config.pulses, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
        if (world.pin.file < 0) {
            perror(world.config.pulses);
            return false;
        }
        world.pin.reader = PULSE_READER;
        timeline_after(PIN_LOOK, look_at_pin, NULL);
    }
    return true;
}

unsigned long world_strange_pulses(void)
{
    return world.pin.strange;
}

bool world_pin_still(void)
{
    return world.pin.file >= 0 && timeline_now() - world.pulse_at > PULSE_PATIENCE;
}

static bool means_something(const char *text)
{
    static const char *const begins[] = {"OK ", "ERR ", "alt:", "mf:", "w:", "drift:"};

    for (size_t i = 0; i < sizeof begins / sizeof begins[0]; i++) {
        if (strncmp(text, begins[i], strlen(begins[i])) == 0) {
            return strspn(text, " !\"#$%&'()*+,-./"
                                "0123456789:;<=>?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_`abcdefghijklmnopqrstuvwxyz"
                                "{|}~") == strlen(text);
        }
    }
    return false;
}

static void line_complete(void)
{
    world.line[world.length] = '\0';
    if (!world.whole) {
        world.whole = true;
    } else if (is_pulse(world.line) && !world.overlong) {
        pulse_told(world.line + 1);
    } else if (world.overlong || (world.length > 0 && !means_something(world.line))) {
        world.wires[BOARD_RADIO].seen.strange++;
    } else if (world.length > 0) {
        world.config.line(world.line);
    }
    world.length = 0;
    world.overlong = false;
}

static void to_terminal(void *context, const unsigned char *octets, size_t count)
{
    wire_t *wire = context;

    wire->seen.octets_in += count;
    for (size_t i = 0; i < count; i++) {
        if (octets[i] == '\n') {
            line_complete();
        } else if (octets[i] != '\r' && world.length < sizeof world.line - 1) {
            world.line[world.length++] = (char)octets[i];
        } else {
            world.overlong = world.overlong || octets[i] != '\r';
        }
    }
}

/* ---- the vehicle ---- */

static razor_truth_t motion(void *context)
{
    const quadrotor_state_t *state = quadrotor_state(world.quadrotor);

    (void)context;
    return (razor_truth_t){.roll_rad = state->roll_rad,
                           .pitch_rad = state->pitch_rad,
                           .yaw_rad = state->yaw_rad,
                           .up_mps2 = state->acceleration_mps2};
}

/* The pin repeats its pulse until it is told another; who hears nothing more knows of no pin. */
static void pwm_period(void *context)
{
    if (world.pin.file < 0 && world.pulse_us > 0.0 && !world.held && !world_silent() &&
        timeline_now() - world.pulse_at >= PWM_PERIOD) {
        quadrotor_pulse(world.quadrotor, (sim_time_t)(world.pulse_us * 1000.0));
    }
    timeline_after(PWM_PERIOD, pwm_period, context);
}

/* ---- life ---- */

static const char *open_ports(board_wire_t *failed)
{
    static const unsigned long rates[BOARD_WIRES] = {0, IMU_RATE, RADIO_RATE};

    for (int i = 0; i < BOARD_WIRES; i++) {
        const unsigned long rate = i == BOARD_LASER ? (unsigned long)urg04lx_default.power_up_rate : rates[i];
        const char *error = port_open_device(&world.wires[i].port, world.config.device[i], rate);

        world.wires[i].rate = rate;
        if (error != NULL) {
            *failed = (board_wire_t)i;
            while (--i >= 0) {
                port_close(&world.wires[i].port);
            }
            return error;
        }
    }
    return NULL;
}

static void create_models(void)
{
    const board_config_t phases = board_config(world.config.seed);

    timeline_reset();
    noise_init(&world.nonsense, world.config.seed, "nonsense");
    world.quadrotor = quadrotor_create(&world.config.quadrotor, world.config.place, world.config.course,
                                       world.config.seed);
    scene_init(&world.scene, &scene_default, world.quadrotor, world.config.seed);
    world.laser = urg04lx_create(&phases.laser, scene_scan, &world.scene, from_laser, NULL);
    world.imu = razor9dof_create(&phases.imu, motion, NULL, world.config.seed, from_imu, NULL);
    urg04lx_power(world.laser, true);
    razor9dof_power(world.imu, true);
    timeline_after(PWM_PERIOD, pwm_period, NULL);
}

const char *world_open(const world_config_t *config, board_wire_t *failed)
{
    static const pace_take_t takers[BOARD_WIRES] = {to_laser, to_imu, to_terminal};
    const char *error;

    memset(&world, 0, sizeof world);
    world.pin.file = -1;
    world.config = *config;
    error = open_ports(failed);
    if (error != NULL) {
        return error;
    }
    create_models();
    pace_begin();
    for (int i = 0; i < BOARD_WIRES; i++) {
        pace_watch(&world.wires[i].port, takers[i], &world.wires[i]);
    }
    return NULL;
}

void world_close(void)
{
    pace_end();
    if (world.pin.file >= 0) {
        (void)close(world.pin.file);
    }
    for (int i = 0; i < BOARD_WIRES; i++) {
        port_close(&world.wires[i].port);
    }
    urg04lx_destroy(world.laser);
    razor9dof_destroy(world.imu);
    quadrotor_destroy(world.quadrotor);
}

/* The scanner's adapter follows the scanner, once it has sent what it was given at the old rate. */
static void follow_laser(void)
{
    wire_t *wire = &world.wires[BOARD_LASER];
    const unsigned long rate = (unsigned long)urg04lx_state(world.laser).rate;
    int waiting = 0;

    if (rate == wire->rate || rate == 0 || timeline_now() - wire->written < QUIET ||
        (ioctl(wire->port.fd, TIOCOUTQ, &waiting) == 0 && waiting > 0)) {
        return;
    }
    if (port_set_rate(&wire->port, rate) == NULL) {
        wire->rate = rate;
    }
}

static void look_after_ports(void)
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        world_wire_t *seen = &world.wires[i].seen;

        if (pace_lost(&world.wires[i].port) && !seen->lost) {
            seen->lost = true;
            seen->lost_at = timeline_now();
        }
    }
}

static void end_of_run(void *context)
{
    (void)context;
}

/* The board may be one of this PC's programs, and have waited as well. */
static void look_at_the_clock(void)
{
    const sim_time_t lag = pace_lag();

    if (lag > LAG_THAT_COUNTS) {
        world.lagged_at = timeline_now();
    }
    if (lag > world.worst_lag) {
        world.worst_lag = lag;
    }
}

bool world_silent(void)
{
    const sim_time_t since = world.heard_at > world.lagged_at ? world.heard_at : world.lagged_at;

    return timeline_now() - since > PULSE_PATIENCE;
}

sim_time_t world_worst_lag(void)
{
    return world.worst_lag;
}

bool world_run_until(sim_time_t end)
{
    timeline_at(end, end_of_run, NULL);
    while (timeline_now() < end && !pace_interrupted()) {
        follow_laser();
        pace_run();
        look_at_the_clock();
        look_after_ports();
    }
    return !pace_interrupted();
}

double world_pulse_us(sim_time_t *when)
{
    *when = world.pulse_at;
    return world.pulse_us;
}

world_wire_t world_wire(board_wire_t wire)
{
    world_wire_t seen = world.wires[wire].seen;

    if (wire == BOARD_LASER) {
        const urg04lx_state_t state = urg04lx_state(world.laser);

        seen.strange = state.refused + state.octets_mismatched;
    }
    return seen;
}

static int in_order(const void *a, const void *b)
{
    const double left = *(const double *)a, right = *(const double *)b;

    return (left > right) - (left < right);
}

bool world_delay_ms(double *median, double *most)
{
    if (world.delays < 5) {
        return false;
    }
    qsort(world.delays_ms, (size_t)world.delays, sizeof world.delays_ms[0], in_order);
    *median = world.delays_ms[world.delays / 2];
    *most = world.delays_ms[world.delays * 95 / 100];
    return true;
}

void world_delay_reset(void)
{
    world.delays = 0;
    world.worst_lag = 0;
}

void world_hold(bool on)
{
    world.held = on;
}

quadrotor_t *world_quadrotor(void)
{
    return world.quadrotor;
}

urg04lx_t *world_laser(void)
{
    return world.laser;
}

razor9dof_t *world_imu(void)
{
    return world.imu;
}

void world_mute(board_wire_t wire, bool on)
{
    world.wires[wire].muted = on;
}

void world_damage(board_wire_t wire, unsigned one_in)
{
    world.wires[wire].damage_one_in = one_in;
}
