#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_flight.h"
#include "commands.h"
#include "figures.h"
#include "lines.h"
#include "scenario_file.h"
#include "sim/scenarios/place_file.h"
#include "sim/scenarios/seed_course.h"
#include "sim/scenarios/wires.h"
#include "terminal.h"
#include "world.h"

static const char usage[] =
    "usage: plomada hil SCENARIO --laser DEVICE --imu DEVICE --xbee DEVICE [OPTION]...\n\n"
    "Flies a scenario with a real board: the PC plays scanner, IMU, operator and airframe over three serial "
    "adapters, in real\n"
    "time; the board runs its flight image unchanged and tells its throttle pulse by `#STREAM PULSE`. No "
    "motors, no propellers.\n"
    "SCENARIO: a name, or a file of your own with a dot or a slash in its name.\n"
    "docs/acceptance.md says how to wire it. `plomada board` is a board to try it on.\n\n"
    "  --seed N            noise and phases (default 1)\n"
    "  --pulses FILE       the pulse as a logic analyser sees it on the pin, by sigrok-cli -O csv into a "
    "FIFO or a "
    "growing file,\n"
    "                      in place of what the board tells\n"
    "  --patience S        how long the board may take until it has heights (default 40; the scanner waits "
    "10 s)\n\n"
    "A flight that needs a pilot, a battery or another vehicle is refused.\n\n"
    "Printed: the figures that are known from outside the board (a line names the others), what the loop "
    "through the\n"
    "adapters takes, troubles by line, the verdict. The "
    "expectations are the\n"
    "scenario's, widened by what the added delay costs in simulation: each to either side by the most that "
    "its metric changes\n"
    "over five seeds when the autopilot's delay is longer by the 95 % value of the loop's less what it is in "
    "simulation.\n\n"
    "Exit status: 0 the flight met the expectations and the board ended safe, 1 not, 2 usage or no such "
    "device, 3 this PC did not\n"
    "keep up with the wall clock (by more than 0.15 s): no verdict.\n";

enum { OPT_SEED = 1, OPT_PATIENCE };

static const struct option long_options[] = {
    {"seed", required_argument, NULL, OPT_SEED},
    {"patience", required_argument, NULL, OPT_PATIENCE},
    LINE_OPTIONS,
};

static struct {
    lines_t lines;
    const scenario_t *scenario;
    unsigned long seed;
    double patience_s;
} order;

static bool complain(const char *what, const char *subject)
{
    fprintf(stderr, "plomada hil: %s: %s\n", subject, what);
    return false;
}

static bool read_patience(const char *text)
{
    char *end;

    order.patience_s = strtod(text, &end);
    return (*text != '\0' && *end == '\0' && order.patience_s > 0.0 && isfinite(order.patience_s)) ||
           complain("not a number of seconds", text);
}

static bool read_seed(const char *text)
{
    char *end;

    order.seed = strtoul(text, &end, 10);
    return (*text >= '0' && *text <= '9' && *end == '\0') || complain("not a seed (0, 1, 2 ...)", text);
}

static bool read_option(int option, const char *argument)
{
    switch (option) {
    case OPT_SEED:
        return read_seed(argument);
    case OPT_PATIENCE:
        return read_patience(argument);
    default:
        return false;
    }
}

/* The airframe is the delivered one, its battery never empties, and no pilot stands beside it. */
static bool is_played(const char *subject)
{
    const scenario_t *scenario = order.scenario;

    if (scenario->plant[0] != NULL) {
        fprintf(stderr, "plomada hil: %s: sets %.*s, which the world of a real board does not have\n",
                subject, (int)strcspn(scenario->plant[0], " "), scenario->plant[0]);
        return false;
    }
    return !scenario->field_day ||
           complain("needs a pilot, whom the world of a real board does not have", subject);
}

static bool read_scenario(int argc, char **argv)
{
    if (optind + 1 != argc) {
        return complain("one SCENARIO is needed, see `plomada list`",
                        optind < argc ? argv[optind + 1] : "hil");
    }
    const bool own = scenario_file_named(argv[optind]);

    order.scenario = own ? scenario_file_read("hil", argv[optind]) : scenario_find(argv[optind]);
    if (own && order.scenario == NULL) {
        return false; /* said so */
    }
    if (order.scenario == NULL || order.scenario->bench) {
        return complain("no such flight, see `plomada list`", argv[optind]);
    }
    return is_played(argv[optind]);
}

static bool read_arguments(int argc, char **argv)
{
    memset(&order, 0, sizeof order);
    order.seed = 1;
    order.patience_s = 40.0;
    return lines_read("hil", argc, argv, long_options, read_option, &order.lines) &&
           (order.lines.help || read_scenario(argc, argv));
}

/* What only the firmware knows, or the autopilot. */
static void name_unmeasured(void)
{
    const char *between = "not measured here: ";

    for (int i = 0; i < METRIC_COUNT; i++) {
        if (!bench_can_judge((metric_t)i)) {
            printf("%s%s", between, metric_names[i]);
            between = ", ";
        }
    }
    printf("\n");
}

static void print_metrics(const bench_flight_t *flight)
{
    scenario_t plain = *order.scenario;

    plain.expectation_count = 0; /* judge() has them, widened by the delay of the adapters */
    figures_print(stdout, &plain, &flight->metrics, bench_can_judge);
    name_unmeasured();
    if (flight->has_delay) {
        printf("loop: %.1f ms from a scan's last octet to its pulse (95 %%: %.1f; in simulation %.1f)\n",
               flight->delay_ms, flight->delay_most_ms, bench_simulated_delay_ms(order.scenario));
    }
}

/* Only what is known from outside is judged. */
static void leave_out(scenario_t *scenario)
{
    int kept = 0;

    for (int i = 0; i < scenario->expectation_count; i++) {
        if (bench_can_judge(scenario->expectations[i].metric)) {
            scenario->expectations[kept++] = scenario->expectations[i];
        } else {
            printf("not judged: %s\n", metric_names[scenario->expectations[i].metric]);
        }
    }
    scenario->expectation_count = kept;
}

static bool judge(const bench_flight_t *flight)
{
    scenario_t widened;
    const double added_ms = bench_widen(order.scenario, flight, &widened);

    printf("added delay: %.1f ms\n", added_ms);
    leave_out(&widened);
    return figures_judge(stdout, &widened, &flight->metrics);
}

static int conclude(const bench_flight_t *flight)
{
    bool met;

    for (int i = 0; i < flight->trouble_count; i++) {
        printf("%s\n", flight->trouble[i]);
    }
    if (flight->interrupted || !flight->started) {
        printf("NOT MET: %s\n", flight->interrupted ? "interrupted" : "the flight did not begin");
        return 1;
    }
    print_metrics(flight);
    printf("this PC was at most %.0f ms behind the wall clock\n", flight->lag_ms);
    if (flight->lag_ms > (double)WORLD_LAG_MAX * 1e-6) {
        printf("NO VERDICT: this was no real time\n");
        return 3;
    }
    met = judge(flight);
    if (flight->radio_lost) {
        printf("how the board ended is not known: no pulse is told any more\n");
    } else {
        printf("%s, pulse %.1f us\n",
               flight->safe ? "the board ended safe: on the ground" : "NOT SAFE: not down on the ground",
               flight->last_pulse_us);
    }
    if (met && flight->safe) {
        printf("MET: all expectations of %s, by a board on its wires\n", order.scenario->name);
    }
    return met && flight->safe ? 0 : 1;
}

static void lay_place(world_config_t *config)
{
    static place_file_t file;

    if (order.scenario->place != NULL) {
        (void)place_file_read(&file, order.scenario->place, order.seed); /* it was read before */
    } else {
        seed_course_lay(order.scenario->platform ? &seed_course_ramp : &seed_course_flat, order.seed,
                        &file.place, &file.course);
    }
    config->place = &file.place;
    config->course = &file.course;
}

static int run(void)
{
    static bench_flight_t flight;
    world_config_t config = {.seed = order.seed, .quadrotor = quadrotor_default, .line = terminal_line};
    board_wire_t failed;
    const char *error;

    memcpy(config.device, order.lines.path, sizeof config.device);
    config.pulses = order.lines.pulses;
    lay_place(&config);
    config.quadrotor.tug_rate_per_s = order.scenario->tug_rate_per_s;
    config.quadrotor.climb_rate_mps_per_n = order.scenario->climb_rate_mps_per_n;
    terminal_begin();
    error = world_open(&config, &failed);
    if (error != NULL) {
        fprintf(stderr, "plomada hil: --%s %s: %s\n", wire_names[failed], order.lines.path[failed], error);
        return 2;
    }
    if (!world_watch_pin()) {
        world_close();
        return 2;
    }
    if (bench_await_heights(order.patience_s, &flight)) {
        bench_fly(order.scenario, order.seed, stdout, &flight);
    }
    world_close();
    return conclude(&flight);
}

int command_hil(int argc, char **argv)
{
    if (!read_arguments(argc, argv)) {
        fprintf(stderr, "`plomada hil --help` tells more.\n");
        return 2;
    }
    if (order.lines.help) {
        fputs(usage, stdout);
        return 0;
    }
    return run();
}
