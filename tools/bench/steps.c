/* What each task and interrupt of the firmware does with one message, as it does it. `steps NAME` runs the
 * step NAME, first twice for practice (caches of the dynamic linker), then once inside measured(), which is
 * what callgrind counts. `steps` alone lists the names; `steps --memory` prints the driver's RAM. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control/altitude.h"
#include "control/attitude.h"
#include "drivers/decimal.h"
#include "control/flight.h"
#include "control/parameters.h"
#include "drivers/razor.h"
#include "drivers/scip_layout.h"
#include "drivers/telecommand.h"
#include "firmware/published.h"
#include "drivers/urg.h"

#define REQUIRE(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "steps: %s does not hold\n", #condition); \
            exit(2); \
        } \
    } while (0)

/* ---- the scanner: one MS frame by urg_feed() and urg_take_scan() to the mean distance: of 35 points, 101
 * octets; and of three mirrors, 136 points, 309 octets, to the scan ---- */

#define FRAME_N 101
#define THREE_N 309
#define THREE_POINTS 136U
#define FRONT (&scip_layouts[SCIP_LAYOUT_FRONT].groups[0])
#define THREE (&scip_layouts[SCIP_LAYOUT_THREE_MIRRORS])

static octet_t frame[THREE_N] __attribute__((aligned(64))); /* as the C library's copying depends on it */
static uint32_t stamp_ms;
static bool leg; /* in front of a fifth of the rays */
static urg_driver_t urg __attribute__((aligned(64)));
static scip_scan_t scan __attribute__((aligned(64)));
static uint16_t points[2 * THREE_POINTS] __attribute__((aligned(64)));
static char order[16]; /* of the stream, as the sensor echoes it */
static unsigned frame_points;
static volatile float mean_mm;

static size_t put_sum(size_t from, size_t to)
{
    unsigned sum = 0;

    for (size_t i = from; i < to; i++) {
        sum += frame[i];
    }
    frame[to] = (octet_t)(sum % 64 + 48);
    frame[to + 1] = '\n';
    return to + 2;
}

static size_t put_value(size_t at, uint32_t value, unsigned width)
{
    for (unsigned i = width; i-- > 0; value /= 64) {
        frame[at + i] = (octet_t)(value % 64 + 48);
    }
    return at + width;
}

/* Ground with noise, 20 mm from the least to the most; or a leg in front of seven rays. */
static unsigned ray_mm(unsigned i)
{
    return leg && i < 7 ? 300 + i : 607 + i * 13 % 21;
}

static void next_frame(void)
{
    size_t at = 20, block = 26;

    memcpy(frame, order, 15);
    memcpy(&frame[15], "\n99b\n", 5);
    stamp_ms += 100;
    at = put_sum(20, put_value(at, stamp_ms, 4));
    for (unsigned i = 0; i < frame_points; i++) {
        at = put_value(at, ray_mm(i), 2);
        if (i % 32 == 31 || i + 1 == frame_points) {
            block = at = put_sum(block, at);
        }
    }
    frame[at++] = '\n';
    REQUIRE(at == (frame_points == 35 ? FRAME_N : THREE_N));
}

/* What was sent, as the sensor answers it: the first two commands as SCIP1.1. */
static void answer(const urg_output_t *output, bool legacy)
{
    octet_t reply[SCIP_REQUEST_MAX + 5];
    size_t count = 0;

    for (uint16_t i = output->octets[0] == '\n' ? 1 : 0; i < output->count; i++) {
        reply[count++] = output->octets[i];
    }
    memcpy(&reply[count], legacy ? "0\n\n" : "00P\n\n", legacy ? 3 : 5);
    (void)urg_feed(&urg, reply, count + (legacy ? 3 : 5));
}

static bool streams(void)
{
    urg_report_t report;

    urg_report(&urg, &report);
    return report.status == URG_STREAM && report.seen.reply_kind == SCIP_STREAM_2;
}

static void begin_stream_of(scip_range_t range, unsigned count)
{
    const urg_config_t config = {0, 115200, 115200, 0, SCIP_STREAM_2, range, 0, false};
    scip_request_t request;
    urg_output_t output;

    REQUIRE(scip_request_scan(&request, SCIP_STREAM_2, &range));
    for (unsigned i = 0; i < 15; i++) {
        order[i] = (char)request.text[i];
    }
    frame_points = count;
    REQUIRE(urg_init(&urg, &config, points, 2 * count, 0));
    for (uint32_t steps_done = 1; !streams(); steps_done++) {
        REQUIRE(steps_done < 20);
        urg_step(&urg, steps_done * 150000U);
        if (urg_next_to_send(&urg, &output) && output.count > 0) {
            answer(&output, steps_done <= 2);
        }
    }
    next_frame();
}

static void begin_stream(void)
{
    begin_stream_of((scip_range_t){372, 406, 1, 0, 0}, 35);
}

static void begin_stream_of_three(void)
{
    begin_stream_of(scip_layout_range(THREE, 250000), THREE_POINTS);
}

static void use_scan(void)
{
    (void)urg_take_scan(&urg, &scan);
    mean_mm = scip_group_mean(&scan, FRONT).mean_mm;
}

static void scip_frame(void)
{
    if (urg_feed(&urg, frame, FRAME_N)) {
        use_scan();
    }
}

static void scip_frame_by_16(void)
{
    for (size_t from = 0; from < FRAME_N; from += 16) {
        if (urg_feed(&urg, &frame[from], from + 16 < FRAME_N ? 16 : FRAME_N - from)) {
            use_scan();
        }
    }
}

static void scip_frame_by_octet(void)
{
    for (unsigned i = 0; i < FRAME_N; i++) {
        if (urg_feed(&urg, &frame[i], 1)) {
            use_scan();
        }
    }
}

static void scip_three(void)
{
    if (urg_feed(&urg, frame, THREE_N)) {
        (void)urg_take_scan(&urg, &scan);
    }
}

static void scip_three_by_octet(void)
{
    for (unsigned i = 0; i < THREE_N; i++) {
        if (urg_feed(&urg, &frame[i], 1)) {
            (void)urg_take_scan(&urg, &scan);
        }
    }
}

static void begin_stream_with_leg(void)
{
    leg = true;
    begin_stream();
}

static void next_scip_frame(void)
{
    REQUIRE(mean_mm > 616.0F && mean_mm < 618.0F);
    mean_mm = 0.0F;
    next_frame();
}

/* A point of four steps tells the nearest; the mean is raised by what that takes away. */
static void next_three(void)
{
    for (unsigned i = 0; i < THREE->group_count; i++) {
        const float three_mm = scip_group_mean(&scan, &THREE->groups[i]).mean_mm;
        REQUIRE(three_mm > 616.0F && three_mm < 630.0F);
    }
    scan.points = 0;
    next_frame();
}

/* ---- TaskReceiveLaser: from a scan to a height ---- */

static altitude_t altitude;
static altitude_geometry_t geometry;

static void prepare_altitude(void)
{
    geometry = altitude_geometry_default();
    begin_stream();
    scip_frame();
}

static void receive_laser(void)
{
    const scip_group_mean_t mean = scip_group_mean(&scan, FRONT);
    const scip_group_steps_t steps = scip_group_steps(&scan, FRONT, &mean);
    const mirror_range_t range = {.mirror = MIRROR_FRONT,
                                  .valid = mean.valid,
                                  .slant_mm = mean.mean_mm,
                                  .spread_mm = mean.spread_mm,
                                  .good_rays = mean.good_rays,
                                  .aside_steps = steps.mean - SCANNER_RIGHT_STEP,
                                  .wide_steps2 = steps.variance};

    altitude = altitude_from_ranges(&geometry, &range, 1, 0.05F, -0.03F);
}

/* ---- TaskSendLaser: supervision of a stream ---- */

static urg_link_t link_;
static urg_seen_t seen;
static urg_action_t action;
static uint32_t now_us;

static void send_laser(void)
{
    urg_link_step(&link_, &seen, now_us, &action);
}

static void next_tick(void)
{
    seen.scan_count++;
    now_us += 150000U;
}

static void prepare_link(void)
{
    (void)urg_link_init(
        &link_, &(urg_config_t){0, 115200, 115200, 0, SCIP_STREAM_2, {372, 406, 1, 0, 0}, 0, false}, 0);
    for (unsigned i = 0; i < 100 && link_.status != URG_OK; i++) {
        now_us += 150000U;
        send_laser();
        seen.reply_count++;
        seen.reply_kind = link_.command;
        seen.reply = (scip_reply_t){.status = {'0', '0'}, .legacy = link_.command == SCIP_SWITCH};
        seen.scan_count += link_.status == URG_STREAM;
    }
    REQUIRE(link_.status == URG_OK);
    next_tick();
}

/* ---- TaskIMU: a frame's text to filtered angles ---- */

static const char imu_text[] = "#A-C=-3.00,12.50,255.75#YPR=-123.45,-1.62,2.04";
static razor_text_t razor_text;
static razor_collector_t collector;
static attitude_filter_t filter;
static attitude_t level, median;

static void imu(void)
{
    razor_frame_t razor;
    attitude_t raw;

    if (razor_parse(&razor_text, &razor) == RAZOR_OK) {
        raw = (attitude_t){razor.roll_rad, razor.pitch_rad, razor.yaw_rad};
        (void)attitude_step(&filter, &raw, &level, &median);
    }
}

static void prepare_imu(void)
{
    razor_text.length = sizeof imu_text - 1;
    memcpy(razor_text.text, imu_text, razor_text.length);
    attitude_init(&filter);
    for (unsigned i = 0; i < 30; i++) {
        imu();
    }
    REQUIRE(filter.ready);
}

static void imu_octets(void)
{
    for (const char *octet = imu_text; *octet != '\0'; octet++) {
        (void)razor_collect(&collector, (octet_t)*octet);
    }
    REQUIRE(razor_collect(&collector, '\n'));
}

static void prepare_imu_octets(void)
{
    razor_collector_init(&collector);
}

/* ---- TaskControl: one cycle in flight with a new height, under the seed's law and under the default's ----
 */

static parameters_t parameters;
static flight_t flight;
static flight_inputs_t in;
static flight_outputs_t out;

static void control(void)
{
    flight_step(&flight, &parameters, &in, &out);
}

static void see(float height_mm)
{
    in.altitude.valid = true;
    in.altitude.height_mm = height_mm;
    in.altitude.slant_mm = height_mm + 100.0F; /* the legs of the mirror */
}

/* The vehicle of law EST: what does not obey the thrust is held, and that is another flight. */
static float height_m, speed_mps, up_mps2;

static void fly(float dt_s)
{
    const float drag_mps2 = parameters.value[PARAMETER_DAMP] * speed_mps;

    up_mps2 = (out.thrust_n / parameters.value[PARAMETER_GRAV] - 1.0F) * 9.81F - drag_mps2;
    speed_mps += up_mps2 * dt_s;
    height_m += speed_mps * dt_s;
}

/* No copy of the one before: two millimetres more in every second one. */
static float ripple_mm(void)
{
    return (in.height_sequence & 1U) != 0U ? 2.0F : 0.0F;
}

static void next_cycle(void)
{
    in.now_us += 108000U;
    in.height_time_us = in.now_us - 20000U;
    in.height_sequence++;
    see(in.altitude.height_mm < 600.0F ? in.altitude.height_mm + 10.0F : 595.0F);
    in.attitude_time_us = in.now_us - 10000U;
}

static void prepare_control(void)
{
    parameters_init(&parameters);
    parameters.value[PARAMETER_LAW] = (float)LAW_PID;
    flight_init(&flight);
    in = (flight_inputs_t){.height_valid = true, .attitude_ready = true, .has_throttle = true};
    for (unsigned i = 0; i < 200; i++) {
        in.reference_m = 0.6F;
        in.reference_sequence = i < 20 ? 0 : 1;
        next_cycle();
        if (i < 20U) {
            see((i % 2U == 0U) ? 20.0F : 17.0F);
        }
        control();
    }
    REQUIRE(out.state == FLIGHT_FLYING && out.flags == 0);
}

#define FRAMES 16U
static imu_sample_t frames[FRAMES];

/* Frames every 25 ms; those of the 15 before come again, as from the IMU's history. */
static void next_motion(void)
{
    memmove(frames, frames + 1, (FRAMES - 1U) * sizeof frames[0]);
    in.now_us += 25000U;
    fly(0.025F);
    frames[FRAMES - 1U] = (imu_sample_t){.sequence = frames[FRAMES - 2U].sequence + 1U,
                                         .arrival_us = in.now_us,
                                         .ready = true,
                                         .has_acceleration = true,
                                         .down_mps2 = 9.81F + up_mps2};
    in.attitude_time_us = in.now_us;
}

static void next_est_cycle(void)
{
    for (unsigned i = 0; i < 3U; i++) {
        next_motion();
        control();
    }
    next_motion();
    in.height_time_us = in.now_us - 1000U;
    in.height_age_us = 70500U;
    in.height_stamp_ms += 100U;
    in.height_sequence++;
    see(1000.0F * (height_m - 0.0705F * speed_mps) + ripple_mm());
}

static void prepare_est_control(void)
{
    prepare_control();
    parameters.value[PARAMETER_LAW] = (float)LAW_EST;
    in.frames = frames;
    in.frame_count = FRAMES;
    height_m = 0.6F;
    for (unsigned i = 0; i < 200U; i++) {
        next_est_cycle();
        control();
    }
    REQUIRE(flight.mode == FLIGHT_MODE_EST_HOLD && out.flags == 0);
}

/* The same with three mirrors, whose heights are judged first. */
static altitude_t mirrors[MIRROR_COUNT];
static float ground_mm[MIRROR_COUNT];

static void next_three_cycle(void)
{
    static const mirror_range_t seen = {.valid = true, .good_rays = 8U};
    mirror_range_t ranges[MIRROR_COUNT];

    next_est_cycle();
    for (uint16_t m = 0U; m < MIRROR_COUNT; m++) {
        ranges[m] = seen;
        ranges[m].mirror = (mirror_t)m;
        ranges[m].slant_mm = in.altitude.height_mm - ground_mm[m] + geometry.mirror[m].distance_mm +
                             geometry.mirror[m].leg_mm;
        ranges[m].spread_mm = 11.0F + ripple_mm();
    }
    altitude_of_mirrors(mirrors, &geometry, ranges, MIRROR_COUNT, 0.0F, 0.0F);
    in.altitude = altitude_mean(mirrors, altitude_weights_equal, MIRROR_COUNT);
}

static void prepare_three_control(void)
{
    geometry = altitude_geometry_default();
    prepare_est_control();
    in.mirrors = mirrors;
    for (unsigned i = 0; i < 200U; i++) {
        next_three_cycle();
        control();
    }
    REQUIRE(flight.mode == FLIGHT_MODE_EST_HOLD && out.flags == 0);
}

/* The same by TERRAIN IGNORE, on the seed's ramp, 250 mm in 280 mm, at 0.4 m/s. The fore mirror meets it
 * first. */
static float way_mm;

static void next_ignore_cycle(void)
{
    static const float ahead_mm[MIRROR_COUNT] = {
        [MIRROR_FRONT] = 0.0F, [MIRROR_FORE] = 107.0F, [MIRROR_AFT] = -115.0F};

    way_mm += 40.0F;
    for (uint16_t m = 0U; m < MIRROR_COUNT; m++) {
        const float on_mm = fmaxf(0.0F, fminf(280.0F, way_mm + ahead_mm[m]));

        ground_mm[m] = on_mm * 250.0F / 280.0F;
    }
    next_three_cycle();
}

static void prepare_ignore_control(void)
{
    prepare_three_control();
    parameters.value[PARAMETER_TERRAIN] = (float)TERRAIN_IGNORE;
    for (unsigned i = 0; i < 100U; i++) {
        next_three_cycle();
        control();
    }
    way_mm = -160.0F;
    for (unsigned i = 0; i < 4U; i++) {
        next_ignore_cycle();
        control();
    }
    next_ignore_cycle();
    REQUIRE(flight.mode == FLIGHT_MODE_EST_HOLD && flight.est.estimator.passes_over);
}

/* ---- TaskSendComm, TaskReceiveComm: a telemetry line; a command, and the answer to it ---- */

static telemetry_line_t line;

static void send_comm(void)
{
    const published_t now = {
        .height_mm = 598.43F,
        .laser = "OK",
        .flight = {.reference_m = 0.6F, .thrust_n = 7.1234F, .state = FLIGHT_FLYING},
    };

    published_telemetry(&line, &now);
}

static telecommand_collector_t commands;

static void receive_comm(void)
{
    telecommand_t command;
    float value = 0.0F;

    (void)telecommand_parse(&commands.line, false, &command);
    const parameter_id_t id = parameter_find(command.name, command.name_length);
    REQUIRE(id != PARAMETER_COUNT && decimal_read(command.argument, command.argument_length, &value));
    (void)parameters_set(&parameters, id, value);
    telemetry_begin_answer(&line);
    telemetry_text(&line, "OK ");
    telemetry_text(&line, parameter_table[id].name);
    telemetry_text(&line, " ");
    telemetry_number(&line, parameters.value[id]);
    telemetry_end(&line);
}

static void prepare_command(void)
{
    const char *text = "#KP 0.0155\n";

    parameters_init(&parameters);
    telecommand_collector_init(&commands);
    while (!telecommand_collect(&commands, (octet_t)*text)) {
        text++;
    }
}

static void nothing(void) {}

static const struct {
    const char *name;
    void (*prepare)(void);
    void (*step)(void);
    void (*next)(void); /* between two runs */
} steps[] = {
    {"scip_frame", begin_stream, scip_frame, next_scip_frame},
    {"scip_frame_with_leg", begin_stream_with_leg, scip_frame, next_scip_frame},
    {"scip_frame_by_16", begin_stream, scip_frame_by_16, next_scip_frame},
    {"scip_frame_by_octet", begin_stream, scip_frame_by_octet, next_scip_frame},
    {"scip_three", begin_stream_of_three, scip_three, next_three},
    {"scip_three_by_octet", begin_stream_of_three, scip_three_by_octet, next_three},
    {"imu_octets", prepare_imu_octets, imu_octets, nothing},
    {"TaskIMU", prepare_imu, imu, nothing},
    {"TaskReceiveLaser", prepare_altitude, receive_laser, nothing},
    {"TaskControl", prepare_control, control, next_cycle},
    {"TaskControl_EST", prepare_est_control, control, next_est_cycle},
    {"TaskControl_THREE", prepare_three_control, control, next_three_cycle},
    {"TaskControl_IGNORE", prepare_ignore_control, control, next_ignore_cycle},
    {"TaskSendLaser", prepare_link, send_laser, next_tick},
    {"TaskSendComm", nothing, send_comm, nothing},
    {"TaskReceiveComm", prepare_command, receive_comm, nothing},
};

void measured(void (*step)(void));

__attribute__((noinline)) void measured(void (*step)(void))
{
    step();
}

static void print_memory(void)
{
    const size_t two_scans = 2 * 35 * sizeof points[0];

    printf("urg_driver_t %zu, two scans of 35 points %zu: %zu octets\n", sizeof(urg_driver_t), two_scans,
           sizeof(urg_driver_t) + two_scans);
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--memory") == 0) {
        print_memory();
        return 0;
    }
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        if (argc == 1) {
            printf("%s\n", steps[i].name);
        } else if (strcmp(argv[1], steps[i].name) == 0) {
            steps[i].prepare();
            steps[i].step();
            steps[i].next();
            steps[i].step();
            steps[i].next();
            measured(steps[i].step);
            return 0;
        }
    }
    return argc == 1 ? 0 : 2;
}
