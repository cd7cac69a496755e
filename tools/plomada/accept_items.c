#include "accept.h"

#include <math.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench_flight.h"
#include "pulses.h"
#include "sim/scenarios/wires.h"
#include "terminal.h"
#include "world.h"

#define LOOK (100 * SIM_MS)
#define ATTITUDE_FLAG 2U /* docs/operator.md */
#define LOAD_MAX 40UL    /* percent; 6 on the PC board */
#define STEPS 10
#define STEP_COUNTS 100
#define COUNT_US 0.48
#define IDLE_US (4166 * COUNT_US)

static accept_verdict_t say(char *detail, bool pass, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static accept_verdict_t say(char *detail, bool pass, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(detail, ACCEPT_DETAIL_MAX, format, arguments);
    va_end(arguments);
    return pass ? ACCEPT_PASS : ACCEPT_FAIL;
}

static accept_verdict_t skip(char *detail, const char *why)
{
    (void)say(detail, false, "%s", why);
    return ACCEPT_SKIP;
}

/* ---- people ---- */

/* The world goes on while somebody thinks. */
static bool read_answer(char *answer, size_t size)
{
    struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};

    while (poll(&input, 1, 0) == 0) {
        if (!world_run_until(timeline_now() + LOOK)) {
            return false;
        }
    }
    return fgets(answer, (int)size, stdin) != NULL;
}

static accept_verdict_t question(const accept_means_t *means, const char *text, char *detail)
{
    char answer[16] = "";

    if (!means->ask) {
        return skip(detail, "nobody was asked");
    }
    printf("%s [y/n] ", text);
    fflush(stdout);
    if (!read_answer(answer, sizeof answer)) {
        return skip(detail, "no answer");
    }
    return say(detail, answer[0] == 'y' || answer[0] == 'Y', "answered %.1s", answer);
}

static accept_verdict_t supplies(const accept_means_t *means, char *detail)
{
    return question(means,
                    "Propellers off, JP1 to JP3 as docs/hardware.md says, 3.3 V on J1.1 within 3.2 to 3.4 V?",
                    detail);
}

static accept_verdict_t leds(const accept_means_t *means, char *detail)
{
    return question(means, "Red LED dark, blue LED lit or blinking?", detail);
}

static bool power_cycle(const accept_means_t *means)
{
    char answer[16];

    if (means->power != NULL) {
        return system(means->power) == 0;
    }
    if (!means->ask) {
        return false;
    }
    printf("Take the board's power away, give it back, then press Enter. ");
    fflush(stdout);
    return read_answer(answer, sizeof answer);
}

/* ---- what the board tells ---- */

static unsigned long flags(void)
{
    char text[16];

    terminal_field("flags:", text, sizeof text);
    return text[0] != '\0' ? strtoul(text, NULL, 10) : 0xFFFFUL;
}

static bool has_attitude(void)
{
    return (flags() & ATTITUDE_FLAG) == 0U;
}

static bool no_attitude(void)
{
    return !has_attitude();
}

static bool has_height(void)
{
    char height[16];

    terminal_field("alt:", height, sizeof height);
    return height[0] != '\0' && height[0] != '-';
}

static bool no_height(void)
{
    return !has_height();
}

/* `true_now` holds for so many telemetry lines in a row, each a new one, within so many seconds. */
static bool await(bool (*true_now)(void), int lines, double seconds)
{
    const sim_time_t end = timeline_now() + (sim_time_t)(seconds * 1e9);
    sim_time_t counted = timeline_now(), when;
    int seen = 0;

    while (seen < lines && timeline_now() < end && world_run_until(timeline_now() + LOOK / 5)) {
        (void)terminal_telemetry(&when);
        if (when > counted) {
            counted = when;
            seen = true_now() ? seen + 1 : 0;
        }
    }
    return seen >= lines;
}

static bool await_reset(const char *cause, sim_time_t since, double seconds)
{
    const sim_time_t end = timeline_now() + (sim_time_t)(seconds * 1e9);

    while (strcmp(terminal_reset(since), cause) != 0 && timeline_now() < end &&
           world_run_until(timeline_now() + LOOK)) {
    }
    return strcmp(terminal_reset(since), cause) == 0;
}

/* A counter of the answer to `#LASER`. */
static unsigned long laser_count(const char *name)
{
    static const char nothing[] = "";
    char answer[200];
    const char *at;

    if (!terminal_ask("LASER", answer, sizeof answer)) {
        return 0;
    }
    at = strstr(terminal_rest(SIM_S / 2), name);
    return strtoul(at != NULL ? at + strlen(name) : nothing, NULL, 10);
}

/* ---- the items ---- */

static accept_verdict_t radio(const accept_means_t *means, char *detail)
{
    const unsigned long before = world_wire(BOARD_RADIO).strange;
    sim_time_t when;
    unsigned long strange;

    (void)means;
    world_type("#STREAM OFF");
    (void)world_run_until(timeline_now() + 4 * SIM_S);
    strange = world_wire(BOARD_RADIO).strange - before;
    if (world_wire(BOARD_RADIO).octets_in == 0) {
        return say(detail, false,
                   "nothing comes from the board: no power, or TX and RX of J1.4 and J1.3 swapped");
    }
    if (terminal_telemetry(&when)[0] == '\0' || strange > 1) {
        return say(detail, false, "garbled: %lu lines mean nothing: not 9600 bit/s, or a bad contact",
                   strange);
    }
    return say(detail, true, "a telemetry line every 0.2 s");
}

static accept_verdict_t boot(const accept_means_t *means, char *detail)
{
    const sim_time_t before = timeline_now();

    if (!power_cycle(means)) {
        return skip(detail, "no way to take the power away");
    }
    return await_reset("POWER", before, 5.0) ? say(detail, true, "reset:POWER")
                                             : say(detail, false, "no line with reset:POWER within 5 s");
}

static accept_verdict_t version(const accept_means_t *means, char *detail)
{
    char answer[160];

    (void)means;
    if (terminal_ask("VERSION", answer, sizeof answer)) {
        return say(detail, true, "%s", answer);
    }
    return strstr(answer, "unknown") != NULL ? skip(detail, "this firmware does not tell it")
                                             : say(detail, false, "%s", answer);
}

static accept_verdict_t ping(const accept_means_t *means, char *detail)
{
    double longest_ms = 0.0;
    char command[16], answer[160], wanted[24];

    (void)means;
    for (int i = 1; i <= 10; i++) {
        const sim_time_t begun = timeline_now();

        snprintf(command, sizeof command, "PING %d", i);
        snprintf(wanted, sizeof wanted, "OK PING %d", i);
        if (!terminal_ask(command, answer, sizeof answer) || strcmp(answer, wanted) != 0) {
            return say(detail, false, "#%s: %s", command, answer[0] != '\0' ? answer : "no answer");
        }
        longest_ms = fmax(longest_ms, (double)(timeline_now() - begun) * 1e-6);
    }
    return say(detail, longest_ms < 400.0, "ten answers, the slowest after %.0f ms (0..400)", longest_ms);
}

static accept_verdict_t imu(const accept_means_t *means, char *detail)
{
    (void)means;
    return await(has_attitude, 25, 25.0)
               ? say(detail, true, "attitude known for 5 s")
               : say(detail, false, "no attitude for 5 s in a row (flags:%lu): J5.43, 57600 bit/s", flags());
}

static accept_verdict_t scanner(const accept_means_t *means, char *detail)
{
    const bool heights = await(has_height, 10, 60.0);
    const urg04lx_state_t state = urg04lx_state(world_laser());
    unsigned long before, damaged;

    (void)means;
    if (!heights) {
        return say(detail, false,
                   "no height for 2 s in a row: %u commands came, %u refused, %u octets at another rate, %u "
                   "scans sent",
                   state.commands, state.refused, state.octets_mismatched, state.scans_sent);
    }
    before = bench_damaged_frames();
    (void)world_run_until(timeline_now() + 5 * SIM_S);
    damaged = bench_damaged_frames() - before;
    return say(detail, damaged <= 1, "rate:%lu, %lu frames damaged in some 10 s (0..1)", laser_count("rate:"),
               damaged);
}

/* What a UART of the other end takes: sampled in the middle of the tenth bit, 5 % off is half a bit; shared
 * by two. */
#define RATE_SHARE 0.02

/* Rates that the board sends at on each line; the scanner's is changed by the dialogue. */
static const double rates_of[BOARD_WIRES][PULSES_RATES] = {
    [BOARD_LASER] = {19200.0, 115200.0, 250000.0}, [BOARD_IMU] = {57600.0}, [BOARD_RADIO] = {9600.0}};

/* Appends what was measured on a line. False: a rate is off, or nothing could be measured. */
static bool measure_bits(board_wire_t wire, const char *path, char *measured, size_t size)
{
    static pulses_t pulses;
    double found[PULSES_RATES];
    const char *error = pulses_read(path, &pulses);
    bool any = false, right = true;

    if (error == NULL) {
        pulses_bit_rates(&pulses, rates_of[wire], found);
    }
    for (int i = 0; i < PULSES_RATES && error == NULL; i++) {
        if (found[i] > 0.0) {
            const double off = found[i] / rates_of[wire][i] - 1.0;
            const size_t length = strlen(measured);

            snprintf(measured + length, size - length, ", %s %.0f bit/s (%+.2f %%)", wire_names[wire],
                     found[i], 100.0 * off);
            right = right && fabs(off) <= RATE_SHARE;
            any = true;
        }
    }
    if (!any) {
        const size_t length = strlen(measured);

        snprintf(measured + length, size - length, ", %s: %s", wire_names[wire],
                 error != NULL ? error : "too few bits");
    }
    return any && right;
}

static accept_verdict_t rates(const accept_means_t *means, char *detail)
{
    const world_wire_t laser = world_wire(BOARD_LASER), terminal = world_wire(BOARD_RADIO);
    char measured[200] = "";
    bool right = true;

    for (int i = 0; i < BOARD_WIRES; i++) {
        const char *path = means->lines.bits[i];

        right = (path == NULL || measure_bits((board_wire_t)i, path, measured, sizeof measured)) && right;
    }
    return say(detail, right && laser.strange <= 8 && terminal.strange <= 2,
               "%lu octets of the scanner's line (%lu meant nothing), %lu of the radio's (%lu lines meant "
               "nothing); bit times %s",
               laser.octets_in, laser.strange, terminal.octets_in, terminal.strange,
               measured[0] != '\0' ? measured + 2 : "not measured");
}

static bool restart(void)
{
    const sim_time_t before = timeline_now();
    char answer[160];

    return terminal_ask("HANG TASK", answer, sizeof answer) && await_reset("WATCHDOG", before, 4.0);
}

static accept_verdict_t watchdog(const accept_means_t *means, char *detail)
{
    const sim_time_t before = timeline_now();
    char answer[160];

    if (!terminal_ask("HANG TASK", answer, sizeof answer)) {
        return say(detail, false, "#HANG TASK: %s", answer[0] != '\0' ? answer : "no answer");
    }
    if (await_reset("WATCHDOG", before, 4.0)) {
        return say(detail, true, "reset:WATCHDOG after a task hung");
    }
    (void)power_cycle(means); /* the rest is tried with a board that works */
    return say(detail, false, "a task hung, and no reset came within 4 s");
}

/* A host that used the scanner before. */
static void tell_laser(const char *commands)
{
    for (const char *c = commands; *c != '\0'; c++) {
        urg04lx_receive(world_laser(), (unsigned char)*c, 1e9 / urg04lx_state(world_laser()).rate);
        if (*c == '\n') {
            (void)world_run_until(timeline_now() + LOOK);
        }
    }
}

static accept_verdict_t starts(const accept_means_t *means, char *detail)
{
    static const struct {
        const char *name, *commands; /* NULL: power taken away and given back */
    } states[] = {{"just powered", NULL},
                  {"streaming", ""},
                  {"SCIP2.0 at 19200", "QT\nSS019200\n"},
                  {"in time mode", "QT\nTM0\n"}};

    (void)means;
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++) {
        if (states[i].commands == NULL) {
            urg04lx_power(world_laser(), false);
            urg04lx_power(world_laser(), true);
        } else {
            tell_laser(states[i].commands);
        }
        if (!restart()) {
            return say(detail, false, "scanner %s: the board did not restart", states[i].name);
        }
        if (!await(has_height, 5, 30.0)) {
            return say(detail, false, "scanner %s: no heights within 30 s of a restart", states[i].name);
        }
    }
    return say(detail, true,
               "heights after a restart with the scanner just powered, streaming, at 19200, in time mode");
}

static const char *wire_fault(board_wire_t wire, bool (*gone)(void), bool (*back)(void))
{
    bool noticed, recovered;

    world_mute(wire, true);
    noticed = await(gone, 1, 4.0);
    world_mute(wire, false);
    recovered = await(back, 5, 30.0);
    return !noticed ? "silence is not noticed" : !recovered ? "it does not recover" : NULL;
}

static accept_verdict_t faults(const accept_means_t *means, char *detail)
{
    const char *error = wire_fault(BOARD_LASER, no_height, has_height);
    char answer[160];
    unsigned long before;

    (void)means;
    if (error != NULL) {
        return say(detail, false, "laser: %s", error);
    }
    error = wire_fault(BOARD_IMU, no_attitude, has_attitude);
    if (error != NULL) {
        return say(detail, false, "imu: %s", error);
    }
    before = bench_damaged_frames();
    world_damage(BOARD_LASER, 350);
    (void)world_run_until(timeline_now() + 5 * SIM_S);
    world_damage(BOARD_LASER, 0);
    if (bench_damaged_frames() == before || !await(has_height, 5, 10.0)) {
        return say(detail, false, "laser: damaged octets are not found, or leave the board without heights");
    }
    before = bench_refused_frames();
    world_damage(BOARD_IMU, 350);
    (void)world_run_until(timeline_now() + 5 * SIM_S);
    world_damage(BOARD_IMU, 0);
    if (bench_refused_frames() == before || !await(has_attitude, 5, 10.0)) {
        return say(detail, false, "imu: damaged octets are not found, or leave the board without attitude");
    }
    world_type("\x01\x7F#KP abc");
    return terminal_ask("PING faults", answer, sizeof answer) &&
                   strstr(terminal_rest(SIM_S / 2), "OK PING faults") != NULL
               ? say(detail, true, "silence and damage are noticed on each line, and end")
               : say(detail, false, "xbee: no answer after a line of nonsense");
}

/* ---- the pulse ---- */

static double expected_us(int step)
{
    return IDLE_US - step * STEP_COUNTS * COUNT_US;
}

/* Up to which of the widths from..STEPS the board tells them, one after the other. */
static int told_steps(int from, int to)
{
    sim_time_t when;
    const sim_time_t end = timeline_now() + (to - from + 4) * SIM_S;
    int next = from;

    while (next <= to && timeline_now() < end && world_run_until(timeline_now() + LOOK / 5)) {
        if (fabs(world_pulse_us(&when) - expected_us(next)) < 0.3) {
            next++;
        }
    }
    return next - 1;
}

static accept_verdict_t judge_recording(const char *path, char *detail)
{
    static pulses_t pulses;
    const char *error = pulses_read(path, &pulses);
    double worst_us = 0.0;

    if (error != NULL) {
        return say(detail, false, "%s: %s", path, error);
    }
    for (int step = 0; step <= STEPS; step++) {
        double nearest_us = INFINITY;

        for (size_t i = 0; i < pulses.count; i++) {
            if (fabs(pulses.high_us[i] - expected_us(step)) < fabs(nearest_us - expected_us(step))) {
                nearest_us = pulses.high_us[i];
            }
        }
        if (!(fabs(nearest_us - expected_us(step)) <= 2.0)) {
            return say(detail, false,
                       "measured: no pulse of %.1f us (nearest %.1f) among %zu: inverted, wrong clock, or "
                       "not connected",
                       expected_us(step), nearest_us, pulses.count);
        }
        worst_us = fmax(worst_us, fabs(nearest_us - expected_us(step)));
    }
    return say(detail, pulses.high_us[0] > IDLE_US - 2.0,
               "measured: first %.1f us, ten widths within %.1f us", pulses.high_us[0], worst_us);
}

/* A calibration begins one step above the idle: with none it goes through every width from 2 ms on. The
 * board's own idle is put back by the line that `restore` gets. */
static bool without_idle(char *restore, size_t size)
{
    char answer[160];

    if (!terminal_ask("GET IDLE", answer, sizeof answer) || strncmp(answer, "OK IDLE ", 8) != 0) {
        return false;
    }
    snprintf(restore, size, "%.32s", answer + 3);
    return terminal_ask("IDLE 0", answer, sizeof answer);
}

static accept_verdict_t pulse(const accept_means_t *means, char *detail)
{
    char answer[160], idle[40];
    int reached;

    if (!await(has_height, 3, 40.0)) {
        return say(detail, false, "no heights: without them #CALIBRATE does not run");
    }
    if (!without_idle(idle, sizeof idle)) {
        return say(detail, false, "#IDLE: no answer");
    }
    world_hold(true);
    if (!terminal_ask("LINK 60", answer, sizeof answer) ||
        !terminal_ask("STREAM PULSE", answer, sizeof answer) || told_steps(0, 0) < 0 ||
        !terminal_ask("CALIBRATE 100 1", answer, sizeof answer)) {
        world_hold(false);
        return say(detail, false, "%s",
                   strncmp(answer, "OK ", 3) == 0 ? "told: no idle pulse on the ground"
                   : answer[0] != '\0'            ? answer
                                                  : "no answer");
    }
    reached = told_steps(1, STEPS);
    (void)world_run_until(timeline_now() + SIM_S / 2);
    (void)terminal_ask("STREAM OFF", answer, sizeof answer);
    (void)terminal_ask("LINK 0", answer, sizeof answer);
    (void)terminal_ask(idle, answer, sizeof answer);
    world_hold(false);
    if (reached < STEPS) {
        return say(detail, false, "told: the width of command %d of %d did not come", reached + 1, STEPS);
    }
    if (means->lines.pulses == NULL) {
        return say(detail, true, "told: idle %.1f us, ten widths from %.1f to %.1f us; not measured", IDLE_US,
                   expected_us(1), expected_us(STEPS));
    }
    return judge_recording(means->lines.pulses, detail);
}

/* ---- the rest ---- */

static accept_verdict_t save(const accept_means_t *means, char *detail)
{
    char before[160], answer[160];
    sim_time_t cut;

    if (means->power == NULL && !means->ask) {
        return skip(detail, "no way to take the power away");
    }
    if (!terminal_ask("GET KP", before, sizeof before) || !terminal_ask("KP 0.0123", answer, sizeof answer)) {
        return say(detail, false, "#KP: no answer");
    }
    if (!terminal_ask("SAVE", answer, sizeof answer)) {
        return say(detail, false, "#SAVE: %s", answer[0] != '\0' ? answer : "no answer");
    }
    cut = timeline_now();
    if (!power_cycle(means) || !await_reset("POWER", cut, 5.0) ||
        !terminal_ask("GET KP", answer, sizeof answer)) {
        return say(detail, false, "the board did not come back after the power cycle");
    }
    if (strncmp(answer, "OK KP 0.0123", 12) != 0) {
        return say(detail, false, "after the power cycle: %s, not 0.0123", answer);
    }
    snprintf(answer, sizeof answer, "KP %.*s", (int)strcspn(before + strlen("OK KP "), " "),
             before + strlen("OK KP "));
    return terminal_ask(answer, before, sizeof before) && terminal_ask("SAVE", answer, sizeof answer)
               ? say(detail, true, "a parameter outlived a power cycle")
               : say(detail, false, "the old value could not be stored again: %s", answer);
}

static accept_verdict_t flight(const accept_means_t *means, char *detail)
{
    static bench_flight_t flown;
    scenario_t scenario = *scenario_find("est-60cm-ramp"), widened;
    const expectation_t *broken;

    scenario.name = "acceptance flight";
    scenario.platform = false;
    scenario.land_s = 1.0 + means->flight_s;
    scenario.end_s = scenario.land_s + 6.0;
    scenario.expectation_count = 3;
    scenario.expectations[0] = (expectation_t){METRIC_RISE_TIME_S, 0.6, 1.0};
    scenario.expectations[1] = (expectation_t){METRIC_HOVER_RMS_MM, 3.0, 25.0};
    scenario.expectations[2] = (expectation_t){METRIC_GROUND_CONTACTS, 0.0, 0.0};
    memset(&flown, 0, sizeof flown);
    if (!bench_await_heights(40.0, &flown)) {
        return say(detail, false, "%s", flown.trouble_count > 0 ? flown.trouble[0] : "interrupted");
    }
    bench_fly(&scenario, 1, NULL, &flown);
    widened = scenario;
    if (flown.lag_ms * 1e6 > (double)WORLD_LAG_MAX) {
        return skip(detail, "this PC did not keep up with the wall clock");
    }
    if (!flown.started || !flown.safe || !scenario_met(&widened, &flown.metrics, &broken)) {
        return say(detail, false, "%s",
                   flown.trouble_count > 0 ? flown.trouble[0]
                   : !flown.safe           ? "it did not end on the ground"
                   : broken != NULL        ? metric_names[broken->metric]
                                           : "failed");
    }
    return say(detail, true, "%.0f s at 0.6 m, hover rms %.1f mm, loop %.1f ms (95 %%: %.1f)",
               means->flight_s, flown.metrics.value[METRIC_HOVER_RMS_MM], flown.delay_ms,
               flown.delay_most_ms);
}

static accept_verdict_t perf(const accept_means_t *means, char *detail)
{
    char answer[160];
    const char *lines, *load;
    int tasks = 0;

    (void)means;
    if (!terminal_ask("PERF", answer, sizeof answer)) {
        return say(detail, false, "#PERF: %s", answer[0] != '\0' ? answer : "no answer");
    }
    lines = terminal_rest(3 * SIM_S);
    load = strstr(lines, "load:");
    if (load == NULL || strtoul(load + strlen("load:"), NULL, 10) > LOAD_MAX) {
        return say(detail, false, "the processor's %.*s percent (0..%lu)",
                   load != NULL ? (int)strcspn(load, "\n") : 4, load != NULL ? load : "load", LOAD_MAX);
    }
    for (const char *at = strstr(lines, "late:"); at != NULL; at = strstr(at + 1, "late:")) {
        const char *name = at;

        while (name > lines && strncmp(name, "Task", 4) != 0) {
            name--;
        }
        if (strtoul(at + strlen("late:"), NULL, 10) > 0) {
            return say(detail, false, "deadlines missed: %.*s", (int)strcspn(name, "\n"), name);
        }
        tasks++;
    }
    return say(detail, tasks == 6, "%d tasks, no deadline missed", tasks);
}

const accept_item_t accept_items[] = {
    {"supplies", "Supplies and jumpers", false, supplies},
    {"radio", "Radio line", false, radio},
    {"boot", "Boot line", true, boot},
    {"leds", "LEDs", false, leds},
    {"version", "Version", true, version},
    {"ping", "#PING", true, ping},
    {"imu", "IMU line", true, imu},
    {"scanner", "Scanner line", true, scanner},
    {"rates", "Bit rates", true, rates},
    {"watchdog", "Watchdog", true, watchdog},
    {"starts", "Start-up dialogue in every start state", true, starts},
    {"faults", "Faults on each line", true, faults},
    {"pulse", "Throttle pulse", true, pulse},
    {"save", "#SAVE over a power cycle", true, save},
    {"flight", "Flight", true, flight},
    {"perf", "#PERF", true, perf},
};
const int accept_item_count = sizeof accept_items / sizeof accept_items[0];
