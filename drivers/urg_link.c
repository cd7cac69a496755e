#include "drivers/urg_link.h"

#define REVOLUTION_US 100000U
#define FIRST_REPLY_US 400000U     /* real sensors were seen to take 381 ms */
#define SCAN_MARGIN_US 250000U
#define VERIFY_US 2000000U         /* statuses 21..49: the sensor examines itself, scans may come again */
#define POWER_CYCLE_US 20000000U   /* without a scan */
#define HEARD_OCTETS 64U           /* during WAIT: the sensor is already sending */
#define WRONG_RATE_FRAMING 8U      /* framing errors since a command that tell the wrong rate from noise */
#define LADDER_TOP 3U

typedef struct {
    urg_link_t *link;
    const urg_seen_t *seen;
    uint32_t now_us;
    urg_action_t *action;
} turn_t;

static const char *const status_names[URG_STATUS_COUNT] = {
    "WAIT", "STOP1", "SWITCH", "RATE", "STOP2", "STREAM", "OK", "LOST",
};

static const uint32_t known_rates[] = { 19200U, 57600U, 115200U, 250000U };
#define PROBE_STREAM 0U     /* the probe begins with the configured rates */
#define PROBE_FIRST 1U
#define PROBES (2U + sizeof known_rates / sizeof known_rates[0])

static uint32_t probe_rate(const urg_link_t *link, uint16_t index)
{
    if (index == PROBE_STREAM) {
        return link->config.stream_rate;
    }
    return index == PROBE_FIRST ? link->config.first_rate : known_rates[index - 2U];
}

/* First position of a rate that is one of the probe's: the own UART never has another. */
static uint16_t probe_index(const urg_link_t *link, uint32_t rate)
{
    uint16_t index = 0U;
    while (probe_rate(link, index) != rate) {
        index++;
    }
    return index;
}

/* The position after this one, without those whose rate has already had its turn. */
static uint16_t next_probe(const urg_link_t *link, uint16_t index)
{
    do {
        index = (uint16_t)((index + 1U) % PROBES);
    } while (probe_index(link, probe_rate(link, index)) != index);
    return index;
}

static uint32_t wire_us(const urg_link_t *link, uint32_t octets)
{
    return octets * (10000000U / link->rate + 1U);
}

static uint32_t scan_period_us(const urg_link_t *link)
{
    return REVOLUTION_US * ((uint32_t)link->config.range.interval + 1U);
}

static uint32_t scan_timeout_us(const urg_link_t *link)
{
    return 2U * scan_period_us(link) + wire_us(link, link->scan_octets) + SCAN_MARGIN_US;
}

static uint32_t reply_timeout_us(const urg_link_t *link, const scip_request_t *request)
{
    uint32_t octets = (uint32_t)request->text_length + request->reply_octets;
    uint32_t timeout_us = FIRST_REPLY_US;
    if (request->kind == SCIP_STOP) {
        octets += link->scan_octets;
    } else if (request->kind == link->config.stream) {
        octets += link->scan_octets;
        timeout_us += 2U * scan_period_us(link);
    }
    return timeout_us + wire_us(link, octets);
}

static void enter(const turn_t *turn, urg_status_t status)
{
    if (turn->link->status != status) {
        turn->link->status = status;
        turn->link->since_us = turn->now_us;
    }
}

static bool build(const urg_link_t *link, scip_kind_t kind, scip_request_t *request)
{
    if (kind == SCIP_BIT_RATE) {
        return scip_request_bit_rate(request, link->config.stream_rate);
    }
    if (kind == link->config.stream) {
        return scip_request_scan(request, kind, &link->config.range);
    }
    return scip_request(request, kind);
}

static void put(const turn_t *turn, scip_kind_t kind)
{
    urg_link_t *link = turn->link;
    urg_action_t *action = turn->action;
    action->send = build(link, kind, &action->request);
    if (link->line_unknown) {
        scip_request_end_line_first(&action->request);
    }
    link->line_unknown = false;
    link->waiting = true;
    link->command = kind;
    link->sent_us = turn->now_us;
    link->timeout_us = reply_timeout_us(link, &action->request);
    link->sent_octets = turn->seen->octet_count;
    link->sent_framing = turn->seen->framing_count;
}

static void ask(const turn_t *turn, urg_status_t status, scip_kind_t kind)
{
    enter(turn, status);
    turn->link->attempt = 1U;
    put(turn, kind);
}

static void ask_again(const turn_t *turn)
{
    turn->link->attempt++;
    turn->link->line_unknown = true;
    put(turn, turn->link->command);
}

static void set_rate(const turn_t *turn, uint32_t rate)
{
    if (turn->link->rate != rate) {
        turn->link->rate = rate;
        turn->action->set_rate = true;
    }
    turn->link->line_unknown = true;
}

static void probe(const turn_t *turn, uint16_t index)
{
    turn->link->rate_refused = false;
    set_rate(turn, probe_rate(turn->link, index));
    ask(turn, URG_LOST, SCIP_STOP);
}

static void probe_here(const turn_t *turn)
{
    probe(turn, probe_index(turn->link, turn->link->rate));
}

static void stop(const turn_t *turn)
{
    ask(turn, URG_STOP2, SCIP_STOP);
}

static void rate_or_stop(const turn_t *turn)
{
    if (turn->link->rate == turn->link->config.stream_rate) {
        stop(turn);
    } else {
        ask(turn, URG_RATE, SCIP_BIT_RATE);
    }
}

static void climb(urg_link_t *link)
{
    if (link->failures < LADDER_TOP) {
        link->failures++;
    }
}

static void leave_time_mode_or_reset(const turn_t *turn)
{
    if (turn->link->failures < LADDER_TOP) {
        ask(turn, URG_STOP2, SCIP_TIME_LEAVE);
    } else {
        ask(turn, URG_LOST, SCIP_RESET);
    }
}

/* The sensor answers, but scans do not come. */
static void no_scans(const turn_t *turn, urg_status_t status)
{
    climb(turn->link);
    turn->link->line_unknown = true;
    if (turn->link->failures == 1U) {
        ask(turn, status, SCIP_STOP);
    } else {
        leave_time_mode_or_reset(turn);
    }
}

/* The sensor answers, but refuses a command that it knows: time mode, or trouble. */
static void refused(const turn_t *turn)
{
    climb(turn->link);
    turn->link->rate_refused = false;
    leave_time_mode_or_reset(turn);
}

static bool is_status(const scip_reply_t *reply, char first, char second)
{
    return reply->status[0] == (octet_t)first && reply->status[1] == (octet_t)second;
}

/* "0A".."0Z": the command was not even considered. */
static bool is_refusal(const scip_reply_t *reply)
{
    return reply->status[0] == (octet_t)'0' && reply->status[1] >= (octet_t)'A';
}

static void on_switch_reply(const turn_t *turn)
{
    const scip_reply_t *reply = &turn->seen->reply;
    if (!reply->legacy || reply->status[0] == (octet_t)'0') {
        rate_or_stop(turn);
    }
}

static void on_rate_reply(const turn_t *turn)
{
    urg_link_t *link = turn->link;
    const scip_reply_t *reply = &turn->seen->reply;
    if (is_status(reply, '0', '0') || is_status(reply, '0', '3')) {
        link->waiting = false; /* the own UART follows at the next step */
    } else if (is_refusal(reply) && link->attempt == 1U) {
        ask_again(turn);
    } else {
        link->rate_refused = true;
        stop(turn);
    }
}

static void on_stop_reply(const turn_t *turn)
{
    urg_link_t *link = turn->link;
    if (is_refusal(&turn->seen->reply)) {
        refused(turn);
    } else if (link->rate == link->config.stream_rate || link->rate_refused) {
        ask(turn, URG_STREAM, link->config.stream);
    } else {
        ask(turn, URG_RATE, SCIP_BIT_RATE);
    }
}

static void on_stream_reply(const turn_t *turn)
{
    if (is_refusal(&turn->seen->reply)) {
        refused(turn);
    } else if (!is_status(&turn->seen->reply, '0', '0')) {
        no_scans(turn, URG_STOP2);
    }
}

static void on_reply(const turn_t *turn)
{
    switch (turn->link->command) {
    case SCIP_LASER_OFF_1:
        if (turn->seen->reply.legacy) {
            ask(turn, URG_SWITCH, SCIP_SWITCH);
        } else {
            stop(turn); /* in SCIP2.0 already, and perhaps streaming or in time mode */
        }
        break;
    case SCIP_SWITCH:
        on_switch_reply(turn);
        break;
    case SCIP_BIT_RATE:
        on_rate_reply(turn);
        break;
    case SCIP_STOP:
        on_stop_reply(turn);
        break;
    case SCIP_TIME_LEAVE:
        stop(turn);
        break;
    case SCIP_RESET:
        probe(turn, PROBE_FIRST);
        break;
    default:
        on_stream_reply(turn);
        break;
    }
}

static bool wrong_rate(const turn_t *turn)
{
    return turn->seen->framing_count - turn->link->sent_framing >= WRONG_RATE_FRAMING;
}

/* Octets without framing errors: the rate is right and only the answer was lost. */
static bool heard_clean(const turn_t *turn)
{
    return turn->seen->octet_count != turn->link->sent_octets && turn->seen->framing_count == turn->link->sent_framing;
}

static uint16_t attempts_allowed(const turn_t *turn)
{
    switch (turn->link->command) {
    case SCIP_LASER_OFF_1:
        return wrong_rate(turn) ? 1U : 2U;
    case SCIP_STOP:
        if (heard_clean(turn)) {
            return 3U;
        }
        return turn->link->status == URG_STOP2 ? 2U : 1U;
    case SCIP_SWITCH:
    case SCIP_TIME_LEAVE:
        return 2U;
    default:
        return 1U;
    }
}

static void on_silence(const turn_t *turn)
{
    urg_link_t *link = turn->link;
    link->timeouts++;
    if (link->attempt < attempts_allowed(turn)) {
        ask_again(turn);
        return;
    }
    switch (link->command) {
    case SCIP_LASER_OFF_1:
    case SCIP_BIT_RATE:
        probe(turn, PROBE_STREAM);
        break;
    case SCIP_STOP:
        probe(turn, next_probe(link, probe_index(link, link->rate)));
        break;
    case SCIP_RESET:
        probe(turn, PROBE_FIRST);
        break;
    case SCIP_SWITCH:
    case SCIP_TIME_LEAVE:
        probe_here(turn);
        break;
    default:
        no_scans(turn, URG_STOP2);
        break;
    }
}

/* While the rate is only a guess, a burst of framing errors answers as well as a time-out. */
static bool is_silent(const turn_t *turn)
{
    const urg_link_t *link = turn->link;
    const bool guessing = link->status == URG_STOP1 || (link->status == URG_LOST && link->command == SCIP_STOP);
    return turn->now_us - link->sent_us >= link->timeout_us || (guessing && wrong_rate(turn));
}

static void arrive(const turn_t *turn)
{
    urg_link_t *link = turn->link;
    enter(turn, URG_OK);
    link->failures = 0U;
    link->scan_us = turn->now_us;
    link->timeout_us = scan_timeout_us(link);
    if (link->config.range.scans != 0U && turn->seen->scan_remaining == 0U) {
        put(turn, link->config.stream);
    }
}

static void cycle_power_in_time(const turn_t *turn)
{
    if (turn->now_us - turn->link->scan_us >= POWER_CYCLE_US) {
        turn->link->scan_us = turn->now_us;
        turn->action->cycle_power = true;
    }
}

static void converse(const turn_t *turn)
{
    urg_link_t *link = turn->link;
    const urg_seen_t *seen = turn->seen;
    cycle_power_in_time(turn);
    if (!link->waiting) {
        set_rate(turn, link->config.stream_rate);
        stop(turn);
    } else if (seen->scan_count != link->seen.scan_count && link->command == link->config.stream) {
        arrive(turn);
    } else if (seen->reply_count != link->seen.reply_count && seen->reply_kind == link->command) {
        on_reply(turn);
    } else if (seen->legacy_count != link->seen.legacy_count && link->command != SCIP_SWITCH) {
        ask(turn, URG_SWITCH, SCIP_SWITCH);
    } else if (is_silent(turn)) {
        on_silence(turn);
    }
}

static void wait_for_sensor(const turn_t *turn)
{
    urg_link_t *link = turn->link;
    const uint32_t heard = turn->seen->octet_count + turn->seen->framing_count;
    link->scan_us = turn->now_us;
    if (heard >= HEARD_OCTETS) {
        probe(turn, wrong_rate(turn) ? (uint16_t)PROBE_STREAM : (uint16_t)PROBE_FIRST);
    } else if (turn->now_us - link->since_us >= link->config.wait_us) {
        link->line_unknown = true;
        ask(turn, URG_STOP1, SCIP_LASER_OFF_1);
    }
}

static void on_notice(const turn_t *turn)
{
    urg_link_t *link = turn->link;
    const octet_t first = turn->seen->notice.status[0];
    if (first < (octet_t)'5') {
        link->scan_us = turn->now_us;
        link->timeout_us = VERIFY_US;
    } else if (!is_status(&turn->seen->notice, '9', '8')) {
        link->timeout_us = 0U;
    }
}

static void watch(const turn_t *turn)
{
    urg_link_t *link = turn->link;
    if (turn->seen->scan_count != link->seen.scan_count) {
        arrive(turn);
    }
    if (turn->seen->notice_count != link->seen.notice_count) {
        on_notice(turn);
    }
    if (turn->now_us - link->scan_us >= link->timeout_us) {
        link->restarts++;
        no_scans(turn, URG_LOST);
    }
}

const char *urg_status_name(urg_status_t status)
{
    return status_names[status];
}

void urg_link_init(urg_link_t *link, const urg_config_t *config, uint32_t now_us)
{
    scip_request_t stream = { .scan_octets = 0U };
    (void)scip_request_scan(&stream, config->stream, &config->range);
    *link = (urg_link_t){ .config = *config, .status = URG_WAIT, .since_us = now_us, .rate = config->first_rate };
    link->scan_octets = stream.scan_octets;
    link->scan_us = now_us;
}

void urg_link_step(urg_link_t *link, const urg_seen_t *seen, uint32_t now_us, urg_action_t *action)
{
    const turn_t turn = { link, seen, now_us, action };
    *action = (urg_action_t){ .send = false };
    switch (link->status) {
    case URG_WAIT:
        wait_for_sensor(&turn);
        break;
    case URG_OK:
        watch(&turn);
        break;
    default:
        converse(&turn);
        break;
    }
    link->seen = *seen;
    action->rate = link->rate;
}
