/* State machine of the scanner's link. It assumes nothing about the sensor: each answer, or a time-out
 * without an answer, decides the next command. Every command has a time-out, so the machine cannot stop in
 * any state. The order of the first start is the seed document's.
 *
 * A stream stops for one of three likely causes. The recovery from one must not delay that from another:
 *
 *   1. The cable is interrupted, and the sensor still streams. Its scans count again as soon as they are
 *      received. So the link must listen at the stream's rate whenever a frame may come, and send nothing
 *      there: QT ends a stream, and MS restarts it, which costs one frame.
 *   2. The sensor has lost its power. It boots for seconds, then waits in SCIP1.1 at its first rate. So the
 *      link repeats SCIP2.0 at that rate, where a frame of the other rate would be lost.
 *   3. The sensor has lost its stream, but not its rate. It needs the repeated scan request.
 *
 * Frames come at equal distances. So for SEARCH_KNOWN_US the link is at the stream's rate when a frame is due
 * and at the first rate between two frames. It sends the request seldom. Where the times are not known, or
 * the frames leave no time, it is at the first rate for most of the time, and what it hears there at a wrong
 * rate leads it back. After SEARCH_KNOWN_US all rates are tried, with QT and longer time-outs. What breaks:
 * the recovery times. `scip_start --outages` prints the longest times without scans. */
#include "drivers/urg_link.h"

#define REVOLUTION_US 100000U     /* data sheet, 600 rpm */
#define FIRST_REPLY_US 400000U    /* real sensors were seen to take 381 ms */
#define SCAN_MARGIN_US 250000U    /* chosen: two and a half revolutions */
#define SETTLE_US 3000000U        /* chosen: what a laser or a motor may need before the first scan */
#define VERIFY_US 2000000U        /* chosen: at statuses 21..49 the sensor tests itself */
#define POWER_CYCLE_US 20000000U  /* chosen: time without a scan, well above the 8 s of a boot */
#define KNOCK_US 130000U          /* chosen: real sensors mostly answer within 110 ms */
#define LISTEN_US 160000U         /* chosen: a revolution, and its octets */
#define TURN_US 40000U            /* chosen: least time at one rate; see urg_link_pause_us() */
#define FIRST_RATE_US 60000U      /* what a revolution leaves beside TURN_US */
#define PHASE_US 15000U           /* chosen: the latency of the scans' times and of the steps */
#define DRIFT 512U                /* chosen: 0.2 %; recorded revolutions take 99.88 ms in place of 100 */
#define SETTLE_RATE_US 90000U     /* chosen: two steps of 50 ms, less their jitter */
#define SEARCH_KNOWN_US 12000000U /* chosen: above the 8 s that a sensor boots */
#define REQUEST_US 1000000U       /* chosen: its scans come within the 1.5 s after which a flight is over */
#define HEARD_OCTETS 64U          /* chosen: so many octets in WAIT mean that the sensor already streams */
#define WRONG_RATE_SIGNS 8U       /* chosen: since a command; more than noise makes */
#define STREAM_SIGNS 3U /* chosen: between two commands of the search; a wrong guess costs one turn only */
#define LADDER_TOP 3U   /* steps of the recovery: QT and MS, TM2, RS */

typedef struct {
    urg_link_t *link;
    const urg_seen_t *seen;
    uint32_t now_us;
    urg_action_t *action;
} step_t;

static const char *const status_names[] = {
    "WAIT", "STOP1", "SWITCH", "RATE", "STOP2", "STREAM", "OK", "LOST", "OLD",
};
typedef char
    every_status_has_a_name[(sizeof status_names / sizeof status_names[0] == URG_STATUS_COUNT) ? 1 : -1];

#define PROBE_STREAM 0U /* the probe begins with the configured rates */
#define PROBE_FIRST 1U
#define PROBES (2U + SCIP_BIT_RATES)

static uint32_t probe_rate(const urg_link_t *link, uint16_t index)
{
    if (index == PROBE_STREAM) {
        return link->config.stream_rate;
    }
    return index == PROBE_FIRST ? link->config.first_rate : scip_bit_rates[index - 2U];
}

/* Position of a rate in the search, the first one if there are several. The UART never has another rate. */
static uint16_t probe_index(const urg_link_t *link, uint32_t rate)
{
    uint16_t index = 0U;
    while (probe_rate(link, index) != rate) {
        index++;
    }
    return index;
}

static bool is_possible(const urg_config_t *config, uint32_t rate)
{
    return config->fastest_rate == 0U || rate <= config->fastest_rate;
}

/* A sensor refuses a range beyond its last step for ever. */
static bool is_within(const urg_config_t *config)
{
    const uint16_t last = config->last_step == 0U ? SCIP_STEP_MAX_URG04LX : config->last_step;
    return config->range.last_step <= last;
}

/* Next position of the search. Leaves out rates that come earlier in it, and rates too high for the UART. */
static uint16_t next_probe(const urg_link_t *link, uint16_t index)
{
    uint32_t rate;
    do {
        index = (uint16_t)((index + 1U) % PROBES);
        rate = probe_rate(link, index);
    } while (probe_index(link, rate) != index || !is_possible(&link->config, rate));
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

/* On the line. */
static uint32_t frame_us(const urg_link_t *link)
{
    return link->scan_octets * (10000000U / link->config.stream_rate + 1U);
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
        timeout_us += 2U * scan_period_us(link) + (link->failures >= LADDER_TOP ? SETTLE_US : 0U);
    }
    return timeout_us + wire_us(link, octets);
}

static void set_status(const step_t *step, urg_status_t status)
{
    if (step->link->status != status) {
        step->link->status = status;
        step->link->since_us = step->now_us;
    }
}

static bool build_request(const urg_link_t *link, scip_kind_t kind, scip_request_t *request)
{
    if (kind == SCIP_BIT_RATE) {
        return scip_request_bit_rate(request, link->config.stream_rate);
    }
    if (kind == link->config.stream) {
        return scip_request_scan(request, kind, &link->config.range);
    }
    return scip_request(request, kind);
}

/* Octets that this UART cannot have received from a sensor at its own rate. */
static uint32_t wrong_rate_signs(const urg_seen_t *seen)
{
    return seen->framing_count + seen->strange_count;
}

static bool wrong_rate(const step_t *step, uint32_t signs)
{
    return wrong_rate_signs(step->seen) - step->link->sent_signs >= signs;
}

static void expect_reply(const step_t *step, scip_kind_t kind)
{
    urg_link_t *link = step->link;
    step->action->expect = build_request(link, kind, &step->action->request);
    link->waiting = true;
    link->command = kind;
    link->sent_us = step->now_us;
    link->timeout_us = reply_timeout_us(link, &step->action->request);
    link->sent_octets = step->seen->octet_count;
    link->sent_signs = wrong_rate_signs(step->seen);
}

static void send_command(const step_t *step, scip_kind_t kind)
{
    expect_reply(step, kind);
    step->action->send = true;
    if (step->link->line_unknown) {
        scip_request_end_line_first(&step->action->request);
        step->link->timeout_us = reply_timeout_us(step->link, &step->action->request);
    }
    step->link->line_unknown = false;
}

static void start_command(const step_t *step, urg_status_t status, scip_kind_t kind)
{
    set_status(step, status);
    step->link->attempt = 1U;
    step->link->knocking = false;
    step->link->listening = false;
    send_command(step, kind);
}

static void repeat_command(const step_t *step)
{
    step->link->attempt++;
    step->link->line_unknown = true;
    send_command(step, step->link->command);
}

static void set_rate(const step_t *step, uint32_t rate)
{
    if (step->link->rate != rate) {
        step->link->rate = rate;
        step->action->set_rate = true;
    }
    step->link->line_unknown = true;
}

/* In a first start: the sensor has answered, so it is at the stream's rate or at the first one. */
static bool has_answered(const step_t *step)
{
    const urg_link_t *link = step->link;
    return link->answered && link->good_rate == 0U && step->now_us - link->answered_us < SEARCH_KNOWN_US;
}

static void probe(const step_t *step, uint16_t index)
{
    step->link->rate_refused = false;
    set_rate(step, probe_rate(step->link, index));
    start_command(step, URG_LOST, SCIP_STOP);
    step->link->timeout_us = has_answered(step) ? KNOCK_US : step->link->timeout_us;
}

static void probe_next(const step_t *step)
{
    const uint16_t index = probe_index(step->link, step->link->rate);
    const uint16_t other = index == PROBE_STREAM ? (uint16_t)PROBE_FIRST : (uint16_t)PROBE_STREAM;
    probe(step, has_answered(step) ? other : next_probe(step->link, index));
}

/* ---- the search for a sensor that has streamed before ---- */

/* A slow answer does not need the knock's time: it is heard as signs of a wrong rate, or the next knock is
 * answered. */
static void knock(const step_t *step, uint32_t rate, scip_kind_t kind, uint32_t timeout_us)
{
    set_rate(step, rate);
    start_command(step, URG_LOST, kind);
    step->link->timeout_us = timeout_us;
    step->link->knocking = true;
}

static void knock_at_stream_rate(const step_t *step)
{
    knock(step, step->link->good_rate, step->link->config.stream, KNOCK_US);
}

/* At the stream's rate, without a command. */
static void listen(const step_t *step, uint32_t timeout_us)
{
    set_rate(step, step->link->good_rate);
    set_status(step, URG_LOST);
    expect_reply(step, step->link->config.stream);
    step->link->timeout_us = timeout_us;
    step->link->knocking = true;
    step->link->listening = true;
}

/* Something that is no answer was heard at the first rate: the stream, most likely. It needs no command. */
static void listen_to_stream(const step_t *step)
{
    listen(step, LISTEN_US);
}

/* By how much the time of the next frame may be wrong. */
static uint32_t phase_us(const step_t *step)
{
    return PHASE_US + (step->now_us - step->link->frame_us) / DRIFT;
}

/* Time of a period in which no frame is on the line; 0 when too short, or unknown. */
static uint32_t free_us(const step_t *step)
{
    const uint32_t busy_us = frame_us(step->link) + 2U * phase_us(step);
    const uint32_t period_us = scan_period_us(step->link);
    return step->link->timed && busy_us + TURN_US <= period_us ? period_us - busy_us : 0U;
}

static uint32_t turn_us(uint32_t left_us)
{
    return left_us > TURN_US ? left_us : TURN_US;
}

/* With what is left of the time without frames. */
static void try_first_rate(const step_t *step, uint32_t left_us)
{
    const uint32_t rate = step->link->config.first_rate;
    knock(step, rate, SCIP_SWITCH, turn_us(left_us < FIRST_RATE_US ? left_us : FIRST_RATE_US));
}

/* At the first rate while no frame of the stream can come, else at the stream's; never twice at the latter.
 */
static void take_turn(const step_t *step)
{
    const urg_link_t *link = step->link;
    const bool was_listening = link->listening && link->timeout_us < LISTEN_US;
    const uint32_t period_us = scan_period_us(link);
    const uint32_t gap_us = free_us(step);
    const uint32_t past_us = (step->now_us - link->frame_us + period_us - phase_us(step)) % period_us;
    const uint32_t left_us = period_us - past_us;
    if (was_listening || past_us + TURN_US <= gap_us) {
        try_first_rate(step, past_us < gap_us ? gap_us - past_us : 0U);
    } else {
        listen(step, left_us < TURN_US / 2U ? left_us + period_us : turn_us(left_us));
    }
}

/* At the first rate it is the stream, most likely; at the stream's rate, the answer to SCIP2.0. */
static bool hears_other_rate(const step_t *step)
{
    return step->link->knocking && wrong_rate(step, STREAM_SIGNS);
}

/* After 1, 2, 4 and 8 s without a scan. */
static bool is_request_due(const step_t *step)
{
    urg_link_t *link = step->link;
    const bool due = step->now_us - link->scan_us >= link->request_us;
    link->request_us *= due ? 2U : 1U;
    return due;
}

static void knock_next(const step_t *step)
{
    const urg_link_t *link = step->link;
    const uint32_t first_rate = link->config.first_rate;
    if (link->good_rate == first_rate || is_request_due(step)) {
        knock_at_stream_rate(step);
    } else if (link->command == link->config.stream && hears_other_rate(step)) {
        knock(step, first_rate, SCIP_SWITCH, FIRST_REPLY_US);
    } else if (free_us(step) == 0U) {
        knock(step, first_rate, SCIP_SWITCH, KNOCK_US);
    } else {
        take_turn(step);
    }
}

/* A sensor that has told of trouble needs the request, and so does one at the end of a counted run. Any other
 * may stream still, and the request would cost a frame; its next one may be on the line now. */
static void begin_search(const step_t *step)
{
    if (step->link->timeout_us == 0U || step->link->config.range.scans != 0U) {
        knock_at_stream_rate(step);
    } else if (step->seen->octet_count != step->link->seen.octet_count) {
        listen_to_stream(step);
    } else {
        knock_next(step);
    }
}

static bool knows_rate(const step_t *step)
{
    return step->link->good_rate != 0U && step->now_us - step->link->scan_us < SEARCH_KNOWN_US;
}

/* Octets without a sign of a wrong rate. */
static bool heard_clean(const step_t *step)
{
    return step->seen->octet_count != step->link->sent_octets && !wrong_rate(step, 1U);
}

/* Octets at the stream's rate, but no scan: the end of a frame, whose next one comes. After a whole
 * revolution it may be the stream of a request that was damaged on its way: the next request mends it. */
static void hear_on(const step_t *step)
{
    if (step->link->listening && step->link->timeout_us == LISTEN_US) {
        knock_at_stream_rate(step);
    } else {
        listen_to_stream(step);
    }
}

static void search_on(const step_t *step)
{
    urg_link_t *link = step->link;
    if (!knows_rate(step)) {
        probe_next(step);
    } else if (link->rate == link->good_rate && heard_clean(step)) {
        hear_on(step);
    } else {
        knock_next(step);
    }
}

static void change_rate(const step_t *step)
{
    if (step->link->command == SCIP_SWITCH) {
        listen_to_stream(step);
    } else {
        search_on(step);
    }
}

/* The sensor has the new rate, or the old one: it is not known which octets were lost. */
static void rate_unknown(const step_t *step)
{
    if (knows_rate(step)) {
        knock_at_stream_rate(step);
    } else {
        probe(step, PROBE_STREAM);
    }
}

static void stop_sensor(const step_t *step)
{
    start_command(step, URG_STOP2, SCIP_STOP);
}

/* After a loss there is no need to stop the sensor first: what it may stream is what it is asked for. */
static void stop_or_stream(const step_t *step)
{
    if (step->link->good_rate != 0U) {
        start_command(step, URG_STREAM, step->link->config.stream);
    } else {
        stop_sensor(step);
    }
}

static void rate_or_stop(const step_t *step)
{
    if (step->link->rate == step->link->config.stream_rate) {
        stop_or_stream(step);
    } else {
        start_command(step, URG_RATE, SCIP_BIT_RATE);
    }
}

/* ---- the ladder: what to try when the sensor answers but does not scan ---- */

static void count_failure(urg_link_t *link)
{
    if (link->failures < LADDER_TOP) {
        link->failures++;
    }
}

static void leave_time_mode_or_reset(const step_t *step)
{
    if (step->link->failures < LADDER_TOP) {
        start_command(step, URG_STOP2, SCIP_TIME_LEAVE);
    } else {
        start_command(step, URG_LOST, SCIP_RESET);
    }
}

static void scans_missing(const step_t *step)
{
    count_failure(step->link);
    step->link->line_unknown = true;
    if (step->link->failures == 1U) {
        start_command(step, URG_STOP2, SCIP_STOP);
    } else {
        leave_time_mode_or_reset(step);
    }
}

/* The sensor answers, but refuses a command that it knows: time mode, or trouble. */
static void command_refused(const step_t *step)
{
    count_failure(step->link);
    step->link->rate_refused = false;
    leave_time_mode_or_reset(step);
}

/* ---- answers ---- */

static bool is_status(const scip_reply_t *reply, char first, char second)
{
    return reply->status[0] == (octet_t)first && reply->status[1] == (octet_t)second;
}

/* "0A".."0Z": the command was not even considered. */
static bool is_refusal(const scip_reply_t *reply)
{
    return reply->status[0] == (octet_t)'0' && reply->status[1] >= (octet_t)'A';
}

static void on_switch_reply(const step_t *step)
{
    const scip_reply_t *reply = &step->seen->reply;
    if (!reply->legacy || reply->status[0] == (octet_t)'0') {
        rate_or_stop(step);
    }
}

static void on_rate_reply(const step_t *step)
{
    urg_link_t *link = step->link;
    const scip_reply_t *reply = &step->seen->reply;
    if (is_status(reply, '0', '0') || is_status(reply, '0', '3')) {
        link->waiting = false; /* the own UART follows */
        link->sent_us = step->now_us;
    } else if (is_refusal(reply) && link->attempt == 1U) {
        repeat_command(step);
    } else {
        link->rate_refused = true;
        stop_sensor(step);
    }
}

static void on_stop_reply(const step_t *step)
{
    urg_link_t *link = step->link;
    if (is_refusal(&step->seen->reply)) {
        command_refused(step);
    } else if (link->rate == link->config.stream_rate || link->rate_refused) {
        start_command(step, URG_STREAM, link->config.stream);
    } else {
        start_command(step, URG_RATE, SCIP_BIT_RATE);
    }
}

/* A knock was heard. */
static void await_first_scan(const step_t *step)
{
    if (step->link->knocking) {
        step->link->knocking = false;
        set_status(step, URG_STREAM);
        step->link->timeout_us = scan_timeout_us(step->link);
    }
}

static void on_stream_reply(const step_t *step)
{
    if (is_refusal(&step->seen->reply)) {
        command_refused(step);
    } else if (is_status(&step->seen->reply, '0', '0')) {
        await_first_scan(step);
    } else {
        scans_missing(step);
    }
}

static void note_answer(const step_t *step)
{
    urg_link_t *link = step->link;
    link->answered = link->rate == link->config.first_rate || link->rate == link->config.stream_rate;
    link->answered_us = step->now_us;
}

static void on_reply(const step_t *step)
{
    note_answer(step);
    switch (step->link->command) {
    case SCIP_LASER_OFF_1:
        if (step->seen->reply.legacy) {
            start_command(step, URG_SWITCH, SCIP_SWITCH);
        } else {
            stop_sensor(step); /* in SCIP2.0 already, and perhaps streaming or in time mode */
        }
        break;
    case SCIP_SWITCH:
        on_switch_reply(step);
        break;
    case SCIP_BIT_RATE:
        on_rate_reply(step);
        break;
    case SCIP_STOP:
        on_stop_reply(step);
        break;
    case SCIP_TIME_LEAVE:
        stop_sensor(step);
        break;
    case SCIP_RESET:
        probe(step, PROBE_FIRST);
        break;
    default:
        on_stream_reply(step);
        break;
    }
}

/* "E": the sensor is in SCIP1.1. If that is its answer to SCIP2.0, twice, it knows nothing else. */
static void on_legacy(const step_t *step)
{
    urg_link_t *link = step->link;
    note_answer(step);
    if (link->command != SCIP_SWITCH) {
        start_command(step, URG_SWITCH, SCIP_SWITCH);
    } else if (link->attempt > 1U) {
        set_status(step, URG_OLD);
        link->attempt = 1U; /* asked for ever: the sensor may be replaced */
    }
}

/* ---- silence ---- */

static uint16_t attempts_allowed(const step_t *step)
{
    switch (step->link->command) {
    case SCIP_LASER_OFF_1:
        return wrong_rate(step, WRONG_RATE_SIGNS) ? 1U : 2U;
    case SCIP_STOP:
        if (heard_clean(step)) { /* only the answer was lost */
            return 3U;
        }
        return step->link->status == URG_STOP2 ? 2U : 1U;
    case SCIP_SWITCH:
        return step->link->knocking ? 1U : 2U;
    case SCIP_TIME_LEAVE:
        return 2U;
    default:
        return 1U;
    }
}

static void give_up_command(const step_t *step)
{
    urg_link_t *link = step->link;
    switch (link->command) {
    case SCIP_LASER_OFF_1:
    case SCIP_BIT_RATE:
        rate_unknown(step);
        break;
    case SCIP_RESET:
        probe(step, PROBE_FIRST);
        break;
    case SCIP_STOP:
        search_on(step);
        break;
    case SCIP_SWITCH:
    case SCIP_TIME_LEAVE:
        probe(step, probe_index(link, link->rate));
        break;
    default:
        scans_missing(step);
        break;
    }
}

static void on_silence(const step_t *step)
{
    urg_link_t *link = step->link;
    link->timeouts++;
    if (link->attempt < attempts_allowed(step)) {
        repeat_command(step);
    } else if (link->knocking) {
        search_on(step);
    } else {
        give_up_command(step);
    }
}

/* Where nothing at all answers a scan request, the scans are not waited for. */
static uint32_t answer_timeout_us(const step_t *step)
{
    const urg_link_t *link = step->link;
    const bool mute = link->status == URG_STREAM && step->seen->octet_count == link->sent_octets;
    return mute ? FIRST_REPLY_US : link->timeout_us;
}

/* While the rate is only a guess, signs of a wrong one answer as well as a time-out. */
static bool is_silent(const step_t *step)
{
    const urg_link_t *link = step->link;
    const bool guessing = link->status == URG_STOP1 ||
                          (link->status == URG_LOST && link->command == SCIP_STOP);
    return step->now_us - link->sent_us >= answer_timeout_us(step) ||
           (guessing && wrong_rate(step, WRONG_RATE_SIGNS));
}

/* ---- the states ---- */

static void on_scan(const step_t *step)
{
    urg_link_t *link = step->link;
    set_status(step, URG_OK);
    link->knocking = false;
    link->failures = 0U;
    link->request_us = REQUEST_US;
    link->good_rate = link->rate;
    link->scan_us = step->now_us;
    link->frame_us = link->timed ? link->frame_us : step->now_us;
    link->timeout_us = scan_timeout_us(link);
    if (link->config.range.scans != 0U && step->seen->scan_remaining == 0U) {
        send_command(step, link->config.stream);
    }
}

static void cycle_power_in_time(const step_t *step)
{
    if (step->now_us - step->link->scan_us >= POWER_CYCLE_US) {
        step->link->scan_us = step->now_us;
        step->action->cycle_power = true;
    }
}

/* The sensor needs some time to change its rate. */
static void follow_rate(const step_t *step)
{
    if (step->now_us - step->link->sent_us >= SETTLE_RATE_US) {
        set_rate(step, step->link->config.stream_rate);
        stop_or_stream(step);
    }
}

static void step_dialogue(const step_t *step)
{
    urg_link_t *link = step->link;
    const urg_seen_t *seen = step->seen;
    cycle_power_in_time(step);
    if (!link->waiting) {
        follow_rate(step);
    } else if (seen->scan_count != link->seen.scan_count && link->command == link->config.stream) {
        on_scan(step);
    } else if (seen->reply_count != link->seen.reply_count && seen->reply_kind == link->command) {
        on_reply(step);
    } else if (seen->legacy_count != link->seen.legacy_count) {
        on_legacy(step);
    } else if (hears_other_rate(step)) {
        change_rate(step);
    } else if (is_silent(step)) {
        on_silence(step);
    }
}

static void step_wait(const step_t *step)
{
    urg_link_t *link = step->link;
    const uint32_t heard = step->seen->octet_count + step->seen->framing_count;
    link->scan_us = step->now_us;
    if (heard >= HEARD_OCTETS) {
        probe(step, wrong_rate(step, WRONG_RATE_SIGNS) ? (uint16_t)PROBE_STREAM : (uint16_t)PROBE_FIRST);
    } else if (step->now_us - link->since_us >= link->config.wait_us) {
        link->line_unknown = true;
        start_command(step, URG_STOP1, SCIP_LASER_OFF_1);
    }
}

static void on_notice(const step_t *step)
{
    urg_link_t *link = step->link;
    const octet_t first = step->seen->notice.status[0];
    if (first < (octet_t)'5') {
        link->scan_us = step->now_us;
        link->timeout_us = VERIFY_US;
    } else if (!is_status(&step->seen->notice, '9', '8')) {
        link->timeout_us = 0U;
    }
}

static void step_stream(const step_t *step)
{
    urg_link_t *link = step->link;
    if (step->seen->scan_count != link->seen.scan_count) {
        on_scan(step);
    }
    if (step->seen->notice_count != link->seen.notice_count) {
        on_notice(step);
    }
    if (step->now_us - link->scan_us >= link->timeout_us) {
        link->restarts++;
        begin_search(step);
    }
}

const char *urg_status_name(urg_status_t status)
{
    return status_names[status];
}

void urg_seen_octets(urg_seen_t *seen, const octet_t *octets, size_t count)
{
    seen->octet_count += (uint32_t)count;
    for (size_t i = 0U; i < count; i++) {
        seen->strange_count += octet_of(octets[i]) > 0x7FU ? 1U : 0U;
    }
}

void urg_seen_event(urg_seen_t *seen, const scip_parser_t *parser, scip_event_t event)
{
    switch (event) {
    case SCIP_REPLY:
        seen->reply_count++;
        seen->reply_kind = parser->awaited.kind;
        seen->reply = parser->reply;
        break;
    case SCIP_SCAN:
        seen->scan_count++;
        seen->scan_remaining = parser->scan->remaining;
        break;
    case SCIP_NOTICE:
        seen->notice_count++;
        seen->notice = parser->reply;
        break;
    case SCIP_LEGACY:
        seen->legacy_count++;
        break;
    case SCIP_DAMAGED:
        seen->damage_count++;
        break;
    default:
        break;
    }
}

bool urg_link_init(urg_link_t *link, const urg_config_t *config, uint32_t now_us)
{
    scip_request_t stream;
    scip_request_t rate;
    if ((config->stream != SCIP_STREAM_2 && config->stream != SCIP_STREAM_3) || !is_within(config) ||
        !scip_request_scan(&stream, config->stream, &config->range) ||
        !scip_request_bit_rate(&rate, config->first_rate) ||
        !scip_request_bit_rate(&rate, config->stream_rate) || !is_possible(config, config->first_rate) ||
        !is_possible(config, config->stream_rate)) {
        return false;
    }
    *link = (urg_link_t){
        .config = *config, .status = URG_WAIT, .since_us = now_us, .rate = config->first_rate};
    link->scan_octets = stream.scan_octets;
    link->pause_us = URG_STEP_US;
    return true;
}

void urg_link_scan_at(urg_link_t *link, uint32_t now_us)
{
    link->frame_us = now_us;
    link->timed = true;
}

uint32_t urg_link_pause_us(const urg_link_t *link)
{
    return link->pause_us;
}

/* While the sensor is searched: to the end of the turn, or shorter where answers may come. */
static uint32_t pause_us(const step_t *step)
{
    const urg_link_t *link = step->link;
    const uint32_t left_us = link->timeout_us - (step->now_us - link->sent_us);
    if (link->good_rate == 0U || link->status == URG_OK) {
        return URG_STEP_US;
    }
    return link->knocking && left_us < 2U * TURN_US ? turn_us(left_us) : URG_SEARCH_STEP_US;
}

void urg_link_step(urg_link_t *link, const urg_seen_t *seen, uint32_t now_us, urg_action_t *action)
{
    const step_t step = {link, seen, now_us, action};
    *action = (urg_action_t){.send = false};
    switch (link->status) {
    case URG_WAIT:
        step_wait(&step);
        break;
    case URG_OK:
        step_stream(&step);
        break;
    default:
        step_dialogue(&step);
        break;
    }
    link->pause_us = pause_us(&step);
    link->seen = *seen;
    action->rate = link->rate;
}
