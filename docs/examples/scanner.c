/* The scanner's driver in an application of its own: no operating system, no heap, one loop. From whatever state the sensor
 * is in it is brought to stream, and after any loss again; each scan's mean distance straight ahead is shown.
 *
 * Needs of Plomada: drivers/octet.h, drivers/scip_*.h and .c, drivers/urg_link.h and .c; nothing else. */
#include "board.h"
#include "drivers/scip_layout.h"
#include "drivers/scip_parser.h"
#include "drivers/urg_link.h"

#define FIRST_STEP 367U     /* 384 is straight ahead; 1024 steps make a turn */
#define LAST_STEP 401U
#define POINTS (LAST_STEP - FIRST_STEP + 1U)
#define STEP_US 150000U     /* the link is stepped every 150 ms */

static const urg_config_t config = {
    .wait_us = 10000000U,   /* the sensor's own power-up; ends early when it is heard */
    .first_rate = 19200U,   /* as delivered */
    .stream_rate = 115200U,
    .stream = SCIP_STREAM_2,
    .range = { .first_step = FIRST_STEP, .last_step = LAST_STEP, .cluster = 1U, .interval = 0U, .scans = 0U },
};

static scip_parser_t parser;
static uint16_t points[POINTS];
static scip_scan_t scan = { .distance_mm = points, .capacity = POINTS };
static urg_link_t link;
static urg_seen_t seen;
static uint32_t stepped_us;

static void use_scan(void)
{
    const scip_group_t ahead = { FIRST_STEP, LAST_STEP };
    const scip_group_mean_t mean = scip_group_mean(&scan, &ahead);

    board_show(mean.valid, (uint16_t)(mean.mean_mm + 0.5F));
}

/* What the parser found is counted for the link, which looks at it in its next step. */
static void note(scip_event_t event)
{
    switch (event) {
    case SCIP_SCAN:
        seen.scan_count++;
        seen.scan_remaining = scan.remaining;
        use_scan();
        break;
    case SCIP_REPLY:
        seen.reply_count++;
        seen.reply_kind = parser.awaited.kind;
        seen.reply = parser.reply;
        break;
    case SCIP_NOTICE:
        seen.notice_count++;
        seen.notice = parser.reply;
        break;
    case SCIP_LEGACY:
        seen.legacy_count++;
        break;
    case SCIP_DAMAGED:
        seen.damage_count++;
        break;
    default:
        break;
    }
}

static void receive(void)
{
    octet_t octets[32];
    const size_t count = board_uart_read(octets, sizeof octets / sizeof octets[0]);
    const uint32_t errors = board_uart_errors();
    size_t taken = 0U;

    if (errors > 0U) {
        scip_parser_line_broken(&parser);
        seen.framing_count += errors;
    }
    seen.octet_count += (uint32_t)count;
    while (taken < count) {
        scip_event_t event;
        taken += scip_parser_feed_run(&parser, &octets[taken], count - taken, &event);
        note(event);
    }
}

static void supervise(void)
{
    urg_action_t action;

    urg_link_step(&link, &seen, board_time_us(), &action);
    if (action.cycle_power) {
        board_cycle_sensor_power();
    }
    if (action.set_rate) {
        scip_parser_line_broken(&parser);
        board_uart_open(action.rate);
    }
    if (action.expect) {
        scip_parser_expect(&parser, &action.request);
    }
    if (action.send) {
        board_uart_write(action.request.text, action.request.text_length);
    }
}

int main(void)
{
    scip_parser_init(&parser);
    scip_parser_scan_into(&parser, &scan);
    (void)urg_link_init(&link, &config, board_time_us());
    board_uart_open(config.first_rate);
    stepped_us = board_time_us();
    while (board_runs()) {
        receive();
        if (board_time_us() - stepped_us >= STEP_US) {
            stepped_us += STEP_US;
            supervise();
        }
    }
    return 0;
}
