#include "sim/devices/razor9dof.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/noise.h"

#define RATE 57600.0
#define GRAVITY_MPS2 9.80665
#define COUNTS_PER_G 256.0
#define DEGREE_RAD (M_PI / 180.0)
#define FRAMES 16U /* sampled and not yet sent */
#define TEXT_MAX 96U

const razor_config_t razor_default = {.period = 25 * SIM_MS,
                                      .age = 15 * SIM_MS,
                                      .phase = 25 * SIM_MS,
                                      .angle_noise_rad = 0.25 * DEGREE_RAD,
                                      .spike_probability = 0.005,
                                      .spike_rad = 0.35,
                                      .acceleration_noise_mps2 = 0.4,
                                      .acceleration_bias_mps2 = 0.15,
                                      .mount_roll_rad = 0.0,
                                      .mount_pitch_rad = 0.0,
                                      .joined = false,
                                      .stock = 0.0,
                                      .acceleration_scale = 1.0,
                                      .acceleration_sign = 1.0,
                                      .roll_sign = 1.0,
                                      .pitch_sign = 1.0,
                                      .swapped = 0.0,
                                      .angle_scale = 1.0,
                                      .turned = 0.0,
                                      .acceleration_jump_mps2 = 0.0,
                                      .acceleration_jump_start_s = 10.0,
                                      .acceleration_alias_mps2 = 0.0,
                                      .acceleration_alias_hz = 2.0,
                                      .attitude_burst_rad = 0.0,
                                      .attitude_burst_radps = 0.0,
                                      .attitude_burst_turned_rad = 0.0,
                                      .attitude_burst = {10.0, 0.075},
                                      .mute = {10.0, 0.0},
                                      .frozen = {10.0, 0.0},
                                      .garbled = {10.0, 0.0},
                                      .garbled_share = 0.05};

typedef struct {
    char text[TEXT_MAX];
    size_t length;
    timeline_id_t departure;
} frame_t;

struct razor9dof {
    razor_config_t config;
    razor_world_t world;
    void *world_context;
    noise_t angle_noise, spike_noise, acceleration_noise, garble_noise;
    serial_t line;
    bool powered;
    timeline_id_t sampling;
    frame_t frames[FRAMES];
    unsigned sampled, sent;
    char latest[TEXT_MAX]; /* the frame composed last */
    size_t latest_length;
};

static void put_text(frame_t *frame, const char *text)
{
    const size_t length = strlen(text);
    memcpy(frame->text + frame->length, text, length);
    frame->length += length;
}

static void put_unsigned(frame_t *frame, unsigned long value)
{
    if (value >= 10) {
        put_unsigned(frame, value / 10);
    }
    frame->text[frame->length++] = (char)('0' + value % 10);
}

/* Arduino's Print::print(float): half a hundredth is added to the magnitude, the rest is cut. */
static void put_float(frame_t *frame, double value)
{
    float number = (float)value;
    if (number < 0.0F) {
        put_text(frame, "-");
        number = -number;
    }
    number += 0.005F;
    const unsigned long whole = (unsigned long)number;
    float rest = number - (float)whole;
    put_unsigned(frame, whole);
    put_text(frame, ".");
    for (int digit = 0; digit < 2; digit++) {
        rest *= 10.0F;
        const unsigned value_of_digit = (unsigned)rest;
        put_unsigned(frame, value_of_digit);
        rest -= (float)value_of_digit;
    }
}

static void put_triple(frame_t *frame, const char *name, double a, double b, double c)
{
    put_text(frame, name);
    put_float(frame, a);
    put_text(frame, ",");
    put_float(frame, b);
    put_text(frame, ",");
    put_float(frame, c);
}

static double printed_angle_deg(razor9dof_t *razor, double angle_rad)
{
    double seen_rad = angle_rad + razor->config.angle_noise_rad * noise_gauss(&razor->angle_noise);
    if (noise_uniform(&razor->spike_noise, 0.0, 1.0) < razor->config.spike_probability) {
        seen_rad += noise_uniform(&razor->spike_noise, -1.0, 1.0) < 0.0 ? -razor->config.spike_rad
                                                                        : razor->config.spike_rad;
    }
    return remainder(seen_rad, 2.0 * M_PI) / DEGREE_RAD;
}

/* The axes of the Razor_AHRS firmware: what a scale would feel, along nose, side and belly. */
static double acceleration_error_mps2(const razor_config_t *config, double t_s)
{
    const double jump_mps2 = t_s >= config->acceleration_jump_start_s ? config->acceleration_jump_mps2 : 0.0;

    return config->acceleration_bias_mps2 + jump_mps2 +
           config->acceleration_alias_mps2 *
               sin(2.0 * M_PI * config->acceleration_alias_hz * fmod(t_s, 1000.0));
}

static void put_acceleration(razor9dof_t *razor, frame_t *frame, const razor_truth_t *truth, double roll_rad,
                             double pitch_rad)
{
    const razor_config_t *config = &razor->config;
    const double felt_mps2 = GRAVITY_MPS2 + truth->up_mps2 + acceleration_error_mps2(config, truth->t_s) +
                             config->acceleration_noise_mps2 * noise_gauss(&razor->acceleration_noise);
    const double counts = config->acceleration_sign * config->acceleration_scale * COUNTS_PER_G * felt_mps2 /
                          GRAVITY_MPS2;
    put_triple(frame, "#A-C=", counts * -sin(pitch_rad), -counts * cos(pitch_rad) * sin(roll_rad),
               counts * cos(pitch_rad) * cos(roll_rad));
}

/* That the told attitude is off by, for a while. */
static double burst_rad(const razor9dof_t *razor, double t_s)
{
    const razor_config_t *c = &razor->config;

    return span_holds(&c->attitude_burst, t_s)
               ? c->attitude_burst_rad + c->attitude_burst_radps * (t_s - c->attitude_burst.start_s)
               : 0.0;
}

static void compose(razor9dof_t *razor, frame_t *frame, const razor_truth_t *seen)
{
    const razor_truth_t truth = *seen;
    const double way = razor->config.turned >= 0.5 ? -1.0 : 1.0;
    const double roll_rad = way * truth.roll_rad + razor->config.mount_roll_rad;
    const double pitch_rad = way * truth.pitch_rad + razor->config.mount_pitch_rad;
    const double burst = burst_rad(razor, truth.t_s);
    frame->length = 0;
    if (razor->config.stock < 0.5) {
        put_acceleration(razor, frame, &truth, roll_rad, pitch_rad);
        put_text(frame, razor->config.joined ? "" : "\r\n");
    }
    const double yaw_deg = printed_angle_deg(razor, truth.yaw_rad);
    const double pitch_deg = razor->config.pitch_sign *
                             printed_angle_deg(
                                 razor, pitch_rad + burst * sin(razor->config.attitude_burst_turned_rad));
    const double roll_deg = -razor->config.roll_sign *
                            printed_angle_deg(
                                razor, roll_rad + burst * cos(razor->config.attitude_burst_turned_rad));
    const double scale = razor->config.angle_scale;
    const bool swapped = razor->config.swapped >= 0.5;
    put_triple(frame, "#YPR=", scale * yaw_deg, scale * (swapped ? roll_deg : pitch_deg),
               scale * (swapped ? pitch_deg : roll_deg));
    put_text(frame, "\r\n");
}

static void send(void *context)
{
    razor9dof_t *razor = context;
    const frame_t *frame = &razor->frames[razor->sent++ % FRAMES];
    serial_send(&razor->line, frame->text, frame->length);
}

/* The processor in the sensor hangs, its output goes on. */
static void compose_or_repeat(razor9dof_t *razor, frame_t *frame, const razor_truth_t *truth)
{
    if (span_holds(&razor->config.frozen, truth->t_s) && razor->latest_length > 0) {
        memcpy(frame->text, razor->latest, razor->latest_length);
        frame->length = razor->latest_length;
        return;
    }
    compose(razor, frame, truth);
    memcpy(razor->latest, frame->text, frame->length);
    razor->latest_length = frame->length;
}

static void garble(razor9dof_t *razor, frame_t *frame)
{
    for (size_t i = 0; i < frame->length; i++) {
        if (noise_uniform(&razor->garble_noise, 0.0, 1.0) < razor->config.garbled_share) {
            frame->text[i] = (char)((unsigned char)frame->text[i] ^
                                    1U << (noise_bits(&razor->garble_noise) & 7U));
        }
    }
}

static void sample(void *context)
{
    razor9dof_t *razor = context;
    frame_t *frame = &razor->frames[razor->sampled++ % FRAMES];
    const razor_truth_t truth = razor->world(razor->world_context);

    compose_or_repeat(razor, frame, &truth);
    if (span_holds(&razor->config.garbled, truth.t_s)) {
        garble(razor, frame);
    }
    if (span_holds(&razor->config.mute, truth.t_s)) {
        frame->length = 0;
    }
    frame->departure = timeline_after(razor->config.age, send, razor);
    razor->sampling = timeline_after(razor->config.period, sample, razor);
}

razor9dof_t *razor9dof_create(const razor_config_t *config, razor_world_t world, void *world_context,
                              unsigned long seed, serial_sink_t sink, void *sink_context)
{
    razor9dof_t *razor = calloc(1, sizeof *razor);
    if (razor == NULL || config->age >= (sim_time_t)FRAMES * config->period) {
        abort();
    }
    razor->config = *config;
    razor->world = world;
    razor->world_context = world_context;
    noise_init(&razor->angle_noise, seed, "razor angle");
    noise_init(&razor->spike_noise, seed, "razor spike");
    noise_init(&razor->acceleration_noise, seed, "razor acceleration");
    noise_init(&razor->garble_noise, seed, "razor garble");
    serial_init(&razor->line, RATE, sink, sink_context);
    return razor;
}

void razor9dof_change(razor9dof_t *razor, const razor_config_t *config)
{
    const razor_config_t before = razor->config;

    razor->config = *config;
    razor->config.period = before.period;
    razor->config.phase = before.phase;
    razor->config.age = before.age;
    razor->config.stock = before.stock;
}

void razor9dof_destroy(razor9dof_t *razor)
{
    razor9dof_power(razor, false);
    free(razor);
}

static void start(razor9dof_t *razor)
{
    sim_time_t departure = razor->config.phase;
    while (departure < razor->config.age) {
        departure += razor->config.period;
    }
    razor->sampling = timeline_after(departure - razor->config.age, sample, razor);
}

static void stop(razor9dof_t *razor)
{
    timeline_cancel(razor->sampling);
    for (; razor->sent != razor->sampled; razor->sent++) {
        timeline_cancel(razor->frames[razor->sent % FRAMES].departure);
    }
    serial_flush(&razor->line);
}

void razor9dof_power(razor9dof_t *razor, bool on)
{
    if (on == razor->powered) {
        return;
    }
    razor->powered = on;
    if (on) {
        start(razor);
    } else {
        stop(razor);
    }
}
