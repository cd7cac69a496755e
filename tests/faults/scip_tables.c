/* Tables of docs/scip.md, from the driver itself: lengths and durations of scans, and the time-outs of the
 * link. */
#include <stdio.h>
#include <string.h>

#include "drivers/scip_request.h"
#include "drivers/urg_link.h"

static const uint32_t rates[] = {19200, 57600, 115200, 250000};
#define RATES (sizeof rates / sizeof rates[0])
#define TICK_US 150000U

static void print_lengths(void)
{
    static const scip_range_t ranges[] = {{384, 384, 1, 0, 0}, {372, 403, 1, 0, 0}, {372, 406, 1, 0, 0},
                                          {249, 519, 1, 0, 0}, {111, 657, 1, 0, 0}, {44, 725, 1, 0, 0},
                                          {44, 725, 3, 0, 0}};
    static const scip_kind_t kinds[] = {SCIP_STREAM_2, SCIP_STREAM_3, SCIP_SINGLE_2, SCIP_SINGLE_3};

    printf("%-12s %6s %5s %5s %5s %5s   MS takes, ms, at %-6u %6u %6u %6u\n", "steps", "points", "MS", "MD",
           "GS", "GD", (unsigned)rates[0], (unsigned)rates[1], (unsigned)rates[2], (unsigned)rates[3]);
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        const scip_range_t *range = &ranges[i];
        scip_request_t request;
        unsigned octets[4];
        for (size_t k = 0; k < 4; k++) {
            scip_request_scan(&request, kinds[k], range);
            octets[k] = scip_scan_octets(kinds[k], request.points);
        }
        printf("%3u..%3u /%-2u %7u %5u %5u %5u %5u %20s", range->first_step, range->last_step, range->cluster,
               request.points, octets[0], octets[1], octets[2], octets[3], "");
        for (size_t k = 0; k < RATES; k++) {
            printf(" %6.1f", octets[0] * 1e4 / rates[k]);
        }
        printf("\n");
    }
}

/* A link on a line where every command is answered by the same status. */
typedef struct {
    urg_link_t link;
    urg_seen_t seen;
    uint32_t now_us;
} line_t;

static void open_line(line_t *line, uint32_t first_rate, uint32_t stream_rate)
{
    const urg_config_t config = {0, first_rate, stream_rate, 0, SCIP_STREAM_2, {372, 406, 1, 0, 0}, 0, false};

    memset(line, 0, sizeof *line);
    (void)urg_link_init(&line->link, &config, 0);
}

static void tick(line_t *line)
{
    urg_action_t action;

    line->now_us += TICK_US;
    urg_link_step(&line->link, &line->seen, line->now_us, &action);
}

static void answer(line_t *line, const char *status)
{
    const scip_kind_t kind = line->link.command;

    line->seen.reply_count++;
    line->seen.reply_kind = kind;
    line->seen.reply = (scip_reply_t){.status = {(octet_t)status[0], (octet_t)status[1]},
                                      .legacy = kind == SCIP_LASER_OFF_1 || kind == SCIP_SWITCH};
}

/* Time-out of the first command of this kind, ms, when all others are answered so; to the stream's first scan
 * if wanted. */
static double timeout_ms(scip_kind_t kind, uint32_t rate, bool other_rate, const char *status)
{
    line_t line;

    open_line(&line, rate, !other_rate ? rate : rate == 115200 ? 250000 : 115200);
    for (unsigned ticks = 0; ticks < 100; ticks++) {
        tick(&line);
        if (line.link.waiting && line.link.command == kind) {
            return line.link.timeout_us / 1000.0;
        }
        answer(&line, line.link.command == SCIP_STOP ? status : "00");
    }
    return -1.0;
}

static double scan_timeout_ms(uint32_t rate)
{
    line_t line;

    open_line(&line, rate, rate);
    while (line.link.status != URG_OK) {
        tick(&line);
        answer(&line, "00");
        line.seen.scan_count += line.link.status == URG_STREAM;
    }
    return line.link.timeout_us / 1000.0;
}

static void print_timeouts(void)
{
    static const struct {
        const char *name, *status;
        scip_kind_t kind;
        bool other_rate;
    } rows[] = {
        {"L0", "00", SCIP_LASER_OFF_1, true}, {"SCIP2.0", "00", SCIP_SWITCH, true},
        {"SS", "00", SCIP_BIT_RATE, true},    {"QT", "00", SCIP_STOP, false},
        {"MS", "00", SCIP_STREAM_2, false},   {"TM2", "0E", SCIP_TIME_LEAVE, false},
        {"RS", "0E", SCIP_RESET, false},
    };

    printf("%-12s %7s %7s %7s %7s\n", "time-out, ms", "19200", "57600", "115200", "250000");
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        printf("%-12s", rows[i].name);
        for (size_t k = 0; k < RATES; k++) {
            printf(" %7.1f", timeout_ms(rows[i].kind, rates[k], rows[i].other_rate, rows[i].status));
        }
        printf("\n");
    }
    printf("%-12s", "next scan");
    for (size_t k = 0; k < RATES; k++) {
        printf(" %7.1f", scan_timeout_ms(rates[k]));
    }
    printf("\n");
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "lengths") == 0) {
        print_lengths();
    } else if (argc == 2 && strcmp(argv[1], "timeouts") == 0) {
        print_timeouts();
    } else {
        fprintf(stderr, "usage: scip_tables lengths|timeouts\n");
        return 2;
    }
    return 0;
}
