/* The scanner's driver, by its five calls alone, against the second model of the sensor (sensor.h): how long
 * it is blind after power cycles of sensors with other power-up rates, after damaged octets, after a sensor
 * that stopped by itself, and how long a first scan takes. Exit status 1 when a bound does not hold, a scan
 * is wrong or the power pin would have been needed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/urg.h"
#include "sensor.h"
#include "wire.h"

#define HOST_TICK (10 * MS)
#define BOOTED (9 * S) /* longer than any boot here */
#define PATIENCE (40 * S)
#define POINTS 35

static struct {
    sensor_t *sensor;
    uart_t to_sensor, to_host;
    urg_driver_t urg;
    uint16_t points[2 * POINTS];
    ns_t now, stepped_at, latest_scan, longest_gap;
    bool running, out;
    unsigned damaged_percent;
    dice_t dice;
    unsigned scans, wrong, power_cycles;
} host;

static bool holds = true;

/* ---- the line ---- */

static bool hit(void)
{
    return host.damaged_percent > 0 && dice_below(&host.dice, 100) < host.damaged_percent;
}

static void sensor_octet(void *context, unsigned octet, bool framing_error)
{
    (void)context;
    if (!host.out) {
        sensor_hears(host.sensor, hit() ? octet ^ (1U << dice_below(&host.dice, 8)) : octet, framing_error,
                     host.now);
    }
}

static void check_scan(void)
{
    scip_scan_t scan;
    if (!urg_take_scan(&host.urg, &scan)) {
        host.wrong++;
        return;
    }
    host.scans++;
    if (host.latest_scan != 0 && host.now - host.latest_scan > host.longest_gap) {
        host.longest_gap = host.now - host.latest_scan;
    }
    host.latest_scan = host.now;
    urg_scan_at(&host.urg, (uint32_t)(host.now / US));
    for (unsigned i = 0; i < scan.points; i++) {
        host.wrong += scan.distance_mm[i] != sensor_distance_mm(scan.first_step + i);
    }
}

static void host_octet(void *context, unsigned octet, bool framing_error)
{
    const octet_t heard = (octet_t)(hit() ? octet ^ (1U << dice_below(&host.dice, 8)) : octet);
    (void)context;
    if (host.out || !host.running) {
        return;
    }
    if (framing_error) {
        urg_line_broken(&host.urg, 1);
    }
    if (urg_feed(&host.urg, &heard, 1)) {
        check_scan();
    }
}

/* ---- the host ---- */

static void step(void)
{
    urg_output_t output;
    const ns_t now = host.now;
    urg_step(&host.urg, (uint32_t)(now / US));
    host.stepped_at = now;
    if (!urg_next_to_send(&host.urg, &output)) {
        return;
    }
    host.power_cycles += output.cycle_power;
    if (output.set_rate) {
        uart_flush(&host.to_sensor, now);
        uart_sender_rate(&host.to_sensor, output.rate);
        uart_receiver_rate(&host.to_host, output.rate, now);
    }
    uart_send(&host.to_sensor, (const char *)output.octets, output.count);
}

static ns_t up_to(ns_t when, ns_t grid)
{
    return (when + grid - 1) / grid * grid;
}

static ns_t least(ns_t a, ns_t b)
{
    return a < b ? a : b;
}

static ns_t step_due(void)
{
    const ns_t due = host.stepped_at + (ns_t)urg_pause_us(&host.urg) * US;
    return host.running ? up_to(due > host.now ? due : host.now + 1, HOST_TICK) : NEVER;
}

/* The next tick at which anything happens, or the one that ends a span: most of a trial is silence. */
static ns_t next_tick(ns_t end)
{
    const ns_t lines = least(uart_due(&host.to_sensor), uart_due(&host.to_host));
    const ns_t due = least(least(lines, sensor_due(host.sensor, host.now)), least(step_due(), end));
    return up_to(due > host.now ? due : host.now + 1, TICK);
}

static void run_for(ns_t span)
{
    const ns_t end = host.now + span;
    while (host.now < end) {
        host.now = next_tick(end);
        uart_run(&host.to_sensor, host.now);
        sensor_run(host.sensor, host.now);
        uart_run(&host.to_host, host.now);
        if (host.running && host.now % HOST_TICK == 0 &&
            host.now - host.stepped_at >= (ns_t)urg_pause_us(&host.urg) * US) {
            step();
        }
    }
}

static void begin(const sensor_config_t *config, unsigned seed)
{
    memset(&host, 0, sizeof host);
    host.now = S;
    host.dice.state = 0x9E3779B97F4A7C15ULL + seed;
    uart_open(&host.to_sensor, 115200, sensor_octet, NULL);
    uart_open(&host.to_host, 115200, host_octet, NULL);
    host.sensor = sensor_create(config, &host.to_sensor, &host.to_host);
    sensor_power(host.sensor, true, host.now);
}

static void start_host(const urg_config_t *config)
{
    if (!urg_init(&host.urg, config, host.points, 2 * POINTS, (uint32_t)(host.now / US))) {
        abort();
    }
    uart_sender_rate(&host.to_sensor, config->first_rate);
    uart_receiver_rate(&host.to_host, config->first_rate, host.now);
    host.running = true;
    host.stepped_at = host.now;
}

static void complain(const char *what, const char *where, unsigned number)
{
    if (holds) {
        printf("FAILED: %s: %s %u\n", what, where, number);
    }
    holds = false;
}

/* To the next scan; negative when none comes. */
static double seconds_to_scan(void)
{
    const ns_t begun = host.now;
    const unsigned scans = host.scans;
    while (host.scans == scans && host.now < begun + PATIENCE) {
        run_for(MS);
    }
    return host.scans == scans ? -1.0 : (double)(host.now - begun) / 1e9;
}

static void end(const char *where, unsigned number)
{
    if (host.now - host.latest_scan > 400 * MS) {
        complain("no scans", where, number);
    }
    if (host.wrong != 0) {
        complain("wrong scans", where, number);
    }
    if (host.power_cycles != 0) {
        complain("the power pin was needed", where, number);
    }
    sensor_destroy(host.sensor);
}

/* ---- the trials ---- */

static const char *const answer_names[] = {
    "after 8 ms",  "at revolutions",        "after 90..115 ms", "so, and it hears early",
    "as recorded", "so, but first 90..400", "so, but first 381"};
static const uint32_t rates[] = {19200, 57600, 115200, 250000, 500000, 750000};
#define POWER_UP_RATES (sizeof rates / sizeof rates[0])
#define RATES 4U /* of a line as the flight firmware's */

static sensor_config_t sensor_of(uint32_t power_up_rate, answers_t answers, unsigned trial)
{
    return (sensor_config_t){.power_up_rate = power_up_rate,
                             .boot = 2500 * MS,
                             .turn = 99880 * US,
                             .phase = trial * 7919 % 100000 * US,
                             .settles = 10 * MS,
                             .answers = answers,
                             .seed = trial};
}

static urg_config_t order_of(uint32_t first_rate, uint32_t stream_rate)
{
    return (urg_config_t){.first_rate = first_rate,
                          .stream_rate = stream_rate,
                          .fastest_rate = 250000,
                          .stream = SCIP_STREAM_2,
                          .range = {372, 406, 1, 0, 0}};
}

/* The worst and the middle of n numbers. */
static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* What a recovery takes at most is the sum of who waits for whom. The sensor's parts are those of sensor.h:
 */
#define ANSWER_S 0.115       /* of a late sensor: to a command, and to each line that came before it */
#define FIRST_ANSWER_S 0.381 /* of a slow one, to the first line after power-up */
#define DRAWN_ANSWER_S 0.4   /* likewise, at most */
#define FIRST_SCAN_S 0.3     /* two revolutions until the laser is on, and the one that is measured */
/* The driver's, docs/scip.md, "Time without scans": */
#define TURN_S 0.2     /* between two questions at a known power-up rate */
#define RATE_S 0.3     /* for one of several rates */
#define NEW_RATE_S 0.1 /* from the answer to SS to the next command, in ticks of 10 ms */
#define IN_VAIN_S 0.4  /* an answer that was heard too late, sought at the rate asked last */
#define FASTER_S 0.42  /* one of a faster rate, taken for the stream's: two requests and a revolution */
#define PROBE_S 0.17   /* for one rate in a start, besides the octets */
#define L0_S 0.26
#define TICKS_S 0.02 /* in which the host notices the answers to SCIP2.0 and to SS */
#define STREAM_RATE 250000

/* On the line: SCIP2.0 and SS with their answers, then MS with its answer and a frame. */
static double line_s(uint32_t rate)
{
    return 45 * 10.0 / rate + 139 * 10.0 / STREAM_RATE;
}

/* Where the sensor powers up at the stream's rate, MS itself is the question: SCIP1.1 refuses it. */
static double to_stream_s(uint32_t rate)
{
    const double other_s = rate == STREAM_RATE ? ANSWER_S : ANSWER_S + NEW_RATE_S;
    return other_s + ANSWER_S + FIRST_SCAN_S + line_s(rate) + TICKS_S;
}

static bool is_slow(answers_t answers)
{
    return answers >= ANSWERS_DRAWN;
}

static double first_answer_s(answers_t answers)
{
    const double slow_s = answers == ANSWERS_DRAWN ? DRAWN_ANSWER_S : FIRST_ANSWER_S;
    return is_slow(answers) ? slow_s : ANSWER_S;
}

/* A question comes; a slow sensor hears the next one too, one above 0.38 s perhaps a third, and answers them
 * all. One that hears early has three of its last 0.381 s, answers the first at the end of its boot, and the
 * rest costs it less than the wait for a question. */
static double learnt_bound_s(answers_t answers, uint32_t rate)
{
    const double others_s = (answers == ANSWERS_DRAWN ? 2 : is_slow(answers) ? 1 : 0) * ANSWER_S;
    return TURN_S + first_answer_s(answers) + others_s + to_stream_s(rate);
}

/* Each rate has its turn, and leaves a line to be answered. The host does not stay for a slow first answer:
 * it is taken for another's, and that of the second round is heard. */
static double unlearned_bound_s(answers_t answers, uint32_t rate)
{
    const size_t others = (rate > STREAM_RATE ? POWER_UP_RATES : RATES) - 1;
    const double round_s = TURN_S + (double)others * RATE_S;
    const double in_vain_s = IN_VAIN_S + (rate > STREAM_RATE ? FASTER_S : 0.0);
    return (is_slow(answers) ? 2 * round_s + in_vain_s : round_s) + 2 * ANSWER_S + to_stream_s(rate);
}

static double power_bound_s(answers_t answers, uint32_t rate, bool learnt)
{
    return learnt ? learnt_bound_s(answers, rate) : unlearned_bound_s(answers, rate);
}

/* The must, from an idle sensor. Where it is the first answer of all that is slow, the second round through
 * the rates has it; QT and SCIP2.0 are two answers more. A probe waits for 120 octets too. */
static double start_bound_s(answers_t answers, bool scip2)
{
    const double octets_s = 1200.0 * (1.0 / 19200 + 1.0 / 57600 + 1.0 / 115200 + 1.0 / 250000 + 1.0 / 500000 +
                                      1.0 / 750000);
    const double round_s = POWER_UP_RATES * PROBE_S + octets_s;
    return scip2 || !is_slow(answers) ? 2.0 : L0_S + 2 * round_s + 2 * ANSWER_S + to_stream_s(19200);
}

static const double damage_most_s = 0.5, stop_most_s = 0.8;

static void show(const char *what, double *seconds, size_t n, double most_s)
{
    size_t beyond = 0;
    for (size_t i = 0; i < n; i++) {
        beyond += seconds[i] > most_s;
    }
    qsort(seconds, n, sizeof seconds[0], by_size);
    printf("%-60s %5zu %7.2f %7.2f %7.2f %7.2f %7zu\n", what, n, seconds[n / 2], seconds[n * 19 / 20],
           seconds[n - 1], most_s, beyond);
    holds = holds && beyond == 0;
}

static void stream_for_a_while(const char *where, const urg_config_t *order, unsigned trial)
{
    run_for(BOOTED);
    start_host(order);
    if (seconds_to_scan() < 0.0) {
        complain("no start", where, trial);
    }
    run_for(2 * S + trial * 3719 % 150000 * US);
    host.longest_gap = 0;
}

#define POWER_TRIALS 60U
#define POWER_TRIALS_MOST 600U
#define POWER_OFF (100 * MS)

/* Whether this host knows the sensor's power-up rate: it saw the sensor boot, or the host before it did and
 * has stored that; or it found the sensor at work. */
typedef enum { RATE_LEARNT, RATE_STORED, RATE_UNKNOWN, KNOWLEDGE_COUNT } knowledge_t;
static const char *const knowledge_names[] = {"", ", stored rate", ", never seen to boot"};

/* 2 to 8 s, in no order: the search must not know when a sensor is ready. */
static ns_t boot_of(unsigned trial)
{
    return 2 * S + trial * 3571 % 6001 * MS;
}

/* Blind beyond the outage and the boot. */
static double after_power_cycle_s(uint32_t power_up_rate, answers_t answers, unsigned trial,
                                  knowledge_t knowledge)
{
    sensor_config_t config = sensor_of(power_up_rate, answers, trial);
    urg_config_t order = order_of(knowledge == RATE_STORED ? power_up_rate : 115200, 250000);
    double seconds;
    config.boot = boot_of(trial);
    begin(&config, trial);
    order.fastest_rate = power_up_rate > order.fastest_rate ? 0U : order.fastest_rate;
    order.first_rate_known = knowledge == RATE_STORED;
    if (knowledge != RATE_LEARNT) {
        run_for(BOOTED);
        sensor_leave_in_scip2(host.sensor, 250000, host.now);
    }
    stream_for_a_while("power", &order, trial);
    sensor_power(host.sensor, false, host.now);
    run_for(POWER_OFF);
    sensor_power(host.sensor, true, host.now);
    run_for(config.boot);
    seconds = seconds_to_scan();
    run_for(2 * S);
    end("power", trial);
    return seconds < 0.0 ? 99.0 : seconds;
}

static void print_power(unsigned trials)
{
    double seconds[POWER_TRIALS_MOST];
    char what[80];
    for (knowledge_t knowledge = 0; knowledge < KNOWLEDGE_COUNT; knowledge++) {
        for (answers_t answers = 0; answers < ANSWERS_COUNT; answers++) {
            for (size_t i = 0; i < POWER_UP_RATES; i++) {
                for (unsigned trial = 0; trial < trials; trial++) {
                    seconds[trial] = after_power_cycle_s(rates[i], answers, trial, knowledge);
                }
                snprintf(what, sizeof what, "boots at %u, answers %s%s", (unsigned)rates[i],
                         answer_names[answers], knowledge_names[knowledge]);

                show(what, seconds, trials, power_bound_s(answers, rates[i], knowledge != RATE_UNKNOWN));
            }
        }
    }
}

#define DAMAGE_TRIALS 2500U

/* From the end of the damage to the next scan. */
static double after_damage_s(answers_t answers, unsigned trial)
{
    const sensor_config_t config = sensor_of(115200, answers, trial);
    const urg_config_t order = order_of(115200, 250000);
    double seconds;
    begin(&config, trial);
    stream_for_a_while("damage", &order, trial);
    host.damaged_percent = 5 + dice_below(&host.dice, 46);
    run_for(200 * MS + dice_below(&host.dice, 5000) * MS);
    host.damaged_percent = 0;
    host.wrong = 0;
    seconds = seconds_to_scan();
    run_for(3 * S);
    end("damage", trial);
    return seconds < 0.0 ? 99.0 : seconds;
}

static void print_damage(unsigned trials)
{
    double *seconds = calloc(trials, sizeof *seconds);
    char what[80];
    for (answers_t answers = 0; answers < ANSWERS_COUNT; answers++) {
        for (unsigned trial = 0; trial < trials; trial++) {
            seconds[trial] = after_damage_s(answers, trial);
        }
        snprintf(what, sizeof what, "5 to 50 %% of the octets wrong, answers %s", answer_names[answers]);
        show(what, seconds, trials, damage_most_s);
    }
    free(seconds);
}

#define STOP_TRIALS 100U

static double after_stop_s(stop_t how, answers_t answers, unsigned trial)
{
    const sensor_config_t config = sensor_of(115200, answers, trial);
    const urg_config_t order = order_of(115200, 250000);
    double seconds;
    begin(&config, trial);
    stream_for_a_while("stop", &order, trial);
    sensor_stop(host.sensor, how, host.now);
    seconds = seconds_to_scan();
    run_for(2 * S);
    seconds = fmax(seconds, (double)host.longest_gap / 1e9);
    end("stop", trial);
    return seconds < 0.0 ? 99.0 : seconds;
}

static void print_stops(void)
{
    static const char *const names[] = {"RS", "QT", "time mode", "other steps"};
    double seconds[STOP_TRIALS];
    char what[80];
    for (answers_t answers = 0; answers < ANSWERS_COUNT; answers++) {
        for (stop_t how = 0; how < STOP_COUNT; how++) {
            for (unsigned trial = 0; trial < STOP_TRIALS; trial++) {
                seconds[trial] = after_stop_s(how, answers, trial);
            }
            snprintf(what, sizeof what, "stops by itself: %s, answers %s", names[how], answer_names[answers]);
            show(what, seconds, STOP_TRIALS, stop_most_s);
        }
    }
}

#define START_TRIALS 40U

static double start_s(uint32_t rate, bool scip2, answers_t answers, unsigned trial)
{
    const sensor_config_t config = sensor_of(rate, answers, trial);
    urg_config_t order = order_of(19200, 115200); /* drivers/README.md */
    double seconds;
    order.fastest_rate = 0;
    order.range = (scip_range_t){367, 401, 1, 0, 0};
    begin(&config, trial);
    run_for(3 * S);
    if (scip2) {
        sensor_leave_in_scip2(host.sensor, rate, host.now);
    }
    start_host(&order);
    seconds = seconds_to_scan();
    run_for(2 * S);
    end("start", trial);
    return seconds < 0.0 ? 99.0 : seconds;
}

static void print_starts(void)
{
    double seconds[START_TRIALS];
    char what[80];
    for (answers_t answers = 0; answers < ANSWERS_COUNT; answers++) {
        for (size_t i = 0; i < RATES; i++) {
            for (int scip2 = 0; scip2 < 2; scip2++) {
                for (unsigned trial = 0; trial < START_TRIALS; trial++) {
                    seconds[trial] = start_s(rates[i], scip2, answers, trial);
                }
                snprintf(what, sizeof what, "first scan, idle in %s at %u, answers %s",
                         scip2 ? "SCIP2.0" : "SCIP1.1", (unsigned)rates[i], answer_names[answers]);
                show(what, seconds, START_TRIALS, start_bound_s(answers, scip2 != 0));
            }
        }
    }
}

int main(int argc, char **argv)
{
    const char *what = argc > 1 ? argv[1] : "";
    const unsigned trials = argc > 2 ? (unsigned)atoi(argv[2]) : 0;
    printf("Trial n: seed n of the octets' faults and of the answers' times.\n");
    printf("%-60s %5s %7s %7s %7s %7s %7s\n", "without scans beyond the trouble, s", "times", "median",
           "19 of 20", "most", "bound", "beyond");
    if (strcmp(what, "power") == 0) {
        print_power(trials > 0 && trials <= POWER_TRIALS_MOST ? trials : POWER_TRIALS);
    } else if (strcmp(what, "damage") == 0) {
        print_damage(trials > 0 ? trials : DAMAGE_TRIALS);
    } else if (strcmp(what, "stops") == 0) {
        print_stops();
    } else if (strcmp(what, "starts") == 0) {
        print_starts();
    } else {
        fprintf(stderr, "usage: scip_recovery power|damage [TRIALS] | stops|starts\n");
        return 2;
    }
    return holds ? 0 : 1;
}
