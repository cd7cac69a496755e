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
#define KNOCK_US 130000U          /* recorded sensors mostly answer 90 to 115 ms after a command */
#define SCAN_MARGIN_US 250000U    /* chosen: two and a half revolutions */
#define MUTE_MARGIN_US 30000U     /* chosen: recorded revolutions differ by 15 ms; the tick of 10 ms */
#define SETTLE_US 3000000U        /* chosen: what a laser or a motor may need before the first scan */
#define VERIFY_US 2000000U        /* chosen: at statuses 21..49 the sensor tests itself */
#define POWER_CYCLE_US 20000000U  /* chosen: time without a scan, well above the 8 s of a boot */
#define LISTEN_US 160000U         /* chosen: a revolution, and its octets */
#define TURN_US 40000U            /* chosen: least time at one rate; see urg_link_pause_us() */
#define PHASE_US 15000U           /* chosen: the latency of the scans' times and of the steps */
#define ANSWER_END_US 50000U      /* KNOCK_US behind a command that follows a frame's time at once */
#define DRIFT 800U                /* recorded revolutions take 99.88 ms in place of 100 */
#define SETTLE_RATE_US 90000U     /* chosen: two steps of 50 ms, less their jitter */
#define SEARCH_KNOWN_US 12000000U /* chosen: above the 8 s that a sensor boots */
#define REQUEST_US 400000U        /* chosen: four revolutions, after which the answer to one has its effect */
#define REQUEST_MAX_US 8000000U   /* chosen: a frame in eighty */
#define HEARD_OCTETS 64U          /* chosen: so many octets in WAIT mean that the sensor already streams */
#define WRONG_RATE_SIGNS 8U       /* chosen: since a command; more than noise makes */
#define STREAM_SIGNS 3U   /* chosen: between two commands of the search; a wrong guess costs one turn only */
#define ANSWER_OCTETS 48U /* chosen: two answers to a request; few frames have less */
#define SIGN_SHARE 4U     /* chosen: at a wrong rate most octets show it; of damaged ones one in eight does */
#define STRAYS \
    4U /* chosen: lines that the sensor has still to answer; a late first answer leaves two or three */
#define LADDER_TOP 3U    /* steps of the recovery: QT and MS, TM2, RS */
#define TEXT_OCTETS 400U /* recorded: II of a UTM-30LX 243, of a URG-04LX 209 */
#define HALF 0x80000000UL
#define LONG_US (2U * URG_STEP_US) /* nothing to wait for */
#define LONG_SWEEP 3U /* chosen: in every third sweep of a first search answers have FIRST_REPLY_US */

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

static const scip_kind_t questions[URG_QUESTIONS] = {SCIP_VERSION, SCIP_PARAMETERS, SCIP_STATE};

static bool is_question(scip_kind_t kind)
{
    return kind == SCIP_VERSION || kind == SCIP_PARAMETERS || kind == SCIP_STATE;
}

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
        ++index;
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

/* A sensor that has streamed before answers soon, or after what it has still to answer. L0 is the first word
 * to one whose rate is a guess: a later answer than that is heard at another rate, and the search comes back.
 */
static uint32_t first_reply_us(const urg_link_t *link, scip_kind_t kind)
{
    return link->good_rate != 0U || kind == SCIP_LASER_OFF_1 ? 2U * KNOCK_US : FIRST_REPLY_US;
}

static uint32_t reply_timeout_us(const urg_link_t *link, const scip_request_t *request)
{
    uint32_t octets = (uint32_t)request->text_length + request->reply_octets;
    uint32_t timeout_us = first_reply_us(link, request->kind);
    if (request->kind == SCIP_STOP) {
        octets += link->scan_octets;
    } else if (request->kind == link->config.stream) {
        octets += link->scan_octets;
        timeout_us += link->good_rate != 0U ? 0U : 2U * scan_period_us(link);
        timeout_us += link->failures >= LADDER_TOP ? SETTLE_US : 0U;
    } else if (is_question(request->kind)) {
        octets += TEXT_OCTETS;
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

/* A reply, though to other than the awaited, proves the rate: what this sensor heard at another one, it
 * echoes. Not so amid framing errors, which no echo has: at half its rate a reply may end in two LF too. */
static bool proved_rate(const step_t *step)
{
    return step->seen->stray_count != step->link->sent_strays && !step->link->listening &&
           step->seen->framing_count - step->link->sent_framing < STREAM_SIGNS;
}

static bool wrong_rate(const step_t *step, uint32_t signs)
{
    const uint32_t shown = wrong_rate_signs(step->seen) - step->link->sent_signs;
    const uint32_t heard = step->seen->octet_count - step->link->sent_octets;
    return shown >= signs && shown >= heard / SIGN_SHARE && !proved_rate(step);
}

static void expect_reply(const step_t *step, scip_kind_t kind)
{
    urg_link_t *link = step->link;
    step->action->expect = build_request(link, kind, &step->action->request);
    link->waiting = true;
    link->to_order = link->to_order && kind != link->config.stream;
    link->acknowledged = false;
    link->command = kind;
    link->sent_us = step->now_us;
    link->timeout_us = reply_timeout_us(link, &step->action->request);
    link->sent_octets = step->seen->octet_count;
    link->sent_signs = wrong_rate_signs(step->seen);
    link->sent_framing = step->seen->framing_count;
    link->sent_strays = step->seen->stray_count;
    link->sent_foreign = step->seen->foreign_count;
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
    ++step->link->attempt;
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

/* In a first start, where alone rates are probed: the sensor has answered, so it is at the stream's rate or
 * at the first one. */
static bool has_answered(const step_t *step)
{
    const urg_link_t *link = step->link;
    return link->answered && step->now_us - link->answered_us < SEARCH_KNOWN_US;
}

/* Most answers come soon. Rates are many, so the later ones have their time in every third sweep only. */
static uint32_t probe_timeout_us(const step_t *step)
{
    const urg_link_t *link = step->link;
    const bool is_long = link->sweep % LONG_SWEEP == LONG_SWEEP - 1U;
    if (has_answered(step)) {
        return KNOCK_US;
    }
    return is_long ? link->timeout_us : link->timeout_us - FIRST_REPLY_US + KNOCK_US;
}

static void probe(const step_t *step, uint16_t index)
{
    step->link->rate_refused = false;
    set_rate(step, probe_rate(step->link, index));
    start_command(step, URG_LOST, SCIP_STOP);
    step->link->timeout_us = probe_timeout_us(step);
}

static void probe_next(const step_t *step)
{
    urg_link_t *link = step->link;
    const uint16_t index = probe_index(link, link->rate);
    const uint16_t other = index == PROBE_STREAM ? (uint16_t)PROBE_FIRST : (uint16_t)PROBE_STREAM;
    const uint16_t next = next_probe(link, index);
    link->sweep = (uint16_t)((link->sweep + (next <= index ? 1U : 0U)) % LONG_SWEEP);
    probe(step, has_answered(step) ? other : next);
}

/* ---- the search for a sensor that has streamed before ---- */

static void knock(const step_t *step, uint32_t rate, scip_kind_t kind, uint32_t timeout_us)
{
    set_rate(step, rate);
    start_command(step, URG_LOST, kind);
    step->link->timeout_us = timeout_us;
    step->link->knocking = true;
}

/* A mute sensor may be in time mode, which it must leave before. What it has made of a question at another
 * rate waits in its line, and is answered first: so the order to leave goes ahead, and ends that line. */
static void leave_time(const step_t *step)
{
    knock(step, step->link->good_rate, SCIP_TIME_LEAVE, KNOCK_US - TURN_US);
    step->link->asking = true;
}

static void knock_at_stream_rate(const step_t *step)
{
    urg_link_t *link = step->link;
    const bool first = link->request_us == 0U;
    if (first && link->command == SCIP_BIT_RATE) {
        leave_time(step);
        return;
    }
    const bool has_left = link->command == SCIP_TIME_LEAVE;
    knock(step, link->good_rate, link->config.stream, KNOCK_US);
    if (first && !has_left) {
        scip_request_leave_time_first(&step->action->request);
        link->timeout_us += KNOCK_US;
    }
    link->requested_us = step->now_us;
    link->request_us = first ? REQUEST_US : link->request_us;
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

/* Something that is no answer was heard at another rate: the stream, most likely. It needs no command. */
static void listen_to_stream(const step_t *step)
{
    step->link->asking = false;
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

/* Since the time of the latest frame is over. */
static uint32_t past_us(const step_t *step)
{
    const uint32_t period_us = scan_period_us(step->link);
    return (step->now_us - step->link->frame_us + period_us - phase_us(step)) % period_us;
}

/* Long enough for an answer, also over the time of one frame, but not into that of the next. */
static uint32_t asking_us(const step_t *step)
{
    const uint32_t gap_us = free_us(step);
    const uint32_t past = past_us(step);
    const uint32_t end_us = gap_us < ANSWER_END_US ? gap_us : ANSWER_END_US;
    if (gap_us == 0U || past + KNOCK_US <= gap_us) {
        return KNOCK_US;
    }
    return past < end_us + TURN_US ? scan_period_us(step->link) + end_us - past : KNOCK_US;
}

/* Until the next frame must be there. */
static uint32_t listening_us(const step_t *step)
{
    const uint32_t left_us = scan_period_us(step->link) - past_us(step);
    if (free_us(step) == 0U) {
        return LISTEN_US;
    }
    return left_us < TURN_US / 2U ? left_us + scan_period_us(step->link) : left_us;
}

static bool knows_power_up_rate(const step_t *step)
{
    return step->link->config.first_rate_known && step->now_us - step->link->scan_us < SEARCH_KNOWN_US;
}

/* The rate at which the sensor was seen to power up. Else one after the other, from the first one on. */
static uint32_t choose_rate(const step_t *step)
{
    urg_link_t *link = step->link;
    if (knows_power_up_rate(step)) {
        return link->config.first_rate;
    }
    link->asked = next_probe(link, link->asked);
    return probe_rate(link, link->asked);
}

static void ask_at(const step_t *step, uint32_t rate, scip_kind_t kind, uint32_t timeout_us)
{
    step->link->asking = true;
    step->link->asked_rate = rate;
    step->link->asked_kind = kind;
    step->link->asked_us = step->now_us;
    knock(step, rate, kind, timeout_us);
}

static void ask(const step_t *step)
{
    const uint32_t rate = choose_rate(step);
    if (rate == step->link->good_rate) {
        step->link->asking = true;
        knock_at_stream_rate(step);
    } else {
        ask_at(step, rate, SCIP_SWITCH, asking_us(step) + (knows_power_up_rate(step) ? 0U : REVOLUTION_US));
    }
}

/* At the stream's rate it is the late answer to what was asked, and at the asked rate the stream; strange
 * octets without a framing error may also be the echo of what the sensor has heard at another rate. */
static bool hears_other_rate(const step_t *step)
{
    const urg_link_t *link = step->link;
    const bool framing = step->seen->framing_count - link->sent_framing >= STREAM_SIGNS;
    const bool late = link->rate == link->good_rate && (link->listening || link->asked_kind == SCIP_BIT_RATE);
    return link->knocking && wrong_rate(step, STREAM_SIGNS) && (late || (link->asking && framing));
}

static void note_answer(const step_t *step)
{
    urg_link_t *link = step->link;
    link->answered = link->rate == link->config.first_rate || link->rate == link->config.stream_rate;
    link->answered_us = step->now_us;
    if (link->request_us > REQUEST_US) {
        link->request_us = REQUEST_US; /* it is there, so a request may be what it waits for */
    }
}

static bool has_answered_since(const step_t *step, uint32_t then_us)
{
    return step->now_us - step->link->answered_us < step->now_us - then_us;
}

/* A sensor that has answered since its stream ended waits for the request. One that has not, nor to two
 * requests, is without power, or out of hearing: and what it makes of a request while it boots, at another
 * rate, is one line more to be answered before SCIP2.0. */
static uint32_t next_request_us(const step_t *step)
{
    if (step->link->request_us == 0U) { /* the first one: at once */
        return 0U;
    }
    return has_answered_since(step, step->link->scan_us) ? REQUEST_US : REQUEST_MAX_US;
}

static void listen_or_request(const step_t *step)
{
    urg_link_t *link = step->link;
    const bool again = link->request_us != 0U;
    link->asking = false;
    if (step->now_us - link->requested_us < link->request_us) {
        listen(step, listening_us(step));
        return;
    }
    link->request_us = next_request_us(step);
    knock_at_stream_rate(step);
    if (again && knows_power_up_rate(step)) {
        link->timeout_us = TURN_US; /* its answer shows at the other rate too */
    }
}

/* A sensor that takes long to its first answer has to answer every question that was asked meanwhile, one
 * after the other. Two of them in the time of a late first answer cost least: a third costs an answer more,
 * and with one alone the sensor waits longer for it. */
static bool asks_too_soon(const step_t *step)
{
    return knows_power_up_rate(step) && step->now_us - step->link->asked_us < FIRST_REPLY_US / 2U - PHASE_US;
}

/* By turns: the stream's rate, where a frame or the answer to a request may come, and those of a power-up. */
static void knock_next(const step_t *step)
{
    if (step->link->asking) {
        listen_or_request(step);
    } else if (asks_too_soon(step)) {
        listen(step, listening_us(step));
    } else {
        ask(step);
    }
}

/* The sensor needs some time to change its rate; the own UART follows. */
static void await_new_rate(const step_t *step)
{
    step->link->waiting = false;
    step->link->sent_us = step->now_us;
}

/* It was heard at the stream's rate. To SS it means that the sensor has that rate now. To SCIP2.0, at the
 * rate of a power-up, that it has obeyed: SS is next, and saves the time of another answer. An unknown
 * power-up rate is learnt from an answer alone that is heard: the same again. */
static void on_late_answer(const step_t *step)
{
    urg_link_t *link = step->link;
    if (knows_power_up_rate(step)) { /* else it may be anything */
        note_answer(step);
    }
    if (link->asked_kind == SCIP_BIT_RATE) {
        link->asked_kind = SCIP_SWITCH;
        link->request_us = REQUEST_US;
        await_new_rate(step);
    } else if (link->asked_rate == link->good_rate) {
        knock_next(step);
    } else {
        ask_at(step, link->asked_rate, knows_power_up_rate(step) ? SCIP_BIT_RATE : SCIP_SWITCH,
               FIRST_REPLY_US);
    }
}

/* Nothing at all came in place of a frame: the sensor has stopped, or lost its power, or the cable is out. A
 * sensor that has reset itself is at its first rate and understands SS; it answers at once or never. */
static void begin_search_for_mute(const step_t *step)
{
    urg_link_t *link = step->link;
    link->request_us = 0U;
    if (link->good_rate == link->config.first_rate) {
        knock_at_stream_rate(step);
    } else {
        ask_at(step, link->config.first_rate, SCIP_BIT_RATE, TURN_US);
    }
}

/* The line is good, and the sensor streams what it was not asked for: news since the step before. */
static bool streams_other(const step_t *step)
{
    return step->seen->foreign_count != step->link->seen.foreign_count;
}

/* A sensor that has told of trouble needs the request, and so does one at the end of a counted run, or that
 * streams something else. Any other
 * may stream still, and the request would cost a frame; its next one may be on the line now. */
static void begin_search(const step_t *step)
{
    urg_link_t *link = step->link;
    link->request_us = REQUEST_US;
    link->heard = false;
    link->requested_us = step->now_us;
    link->asked_kind = SCIP_SWITCH;
    link->asked_rate = link->config.first_rate;
    if (link->timeout_us == 0U || link->config.range.scans != 0U || streams_other(step)) {
        knock_at_stream_rate(step);
    } else if (step->seen->octet_count == step->seen->octets_at_scan) {
        begin_search_for_mute(step);
    } else {
        listen_to_stream(step);
    }
}

static bool has_streamed(const step_t *step)
{
    return step->link->good_rate != 0U;
}

/* Octets without a sign of a wrong rate. */
static bool heard_clean(const step_t *step)
{
    return step->seen->octet_count != step->link->sent_octets && !wrong_rate(step, 1U);
}

static bool hears_few(const step_t *step)
{
    return step->seen->octet_count - step->link->sent_octets < ANSWER_OCTETS;
}

/* Nothing but a damaged answer to the latest request: the sensor does not stream. */
static bool hears_answer(const step_t *step)
{
    return !step->link->listening && hears_few(step);
}

static bool hears_foreign(const step_t *step)
{
    return step->seen->foreign_count != step->link->sent_foreign;
}

/* For longer than a revolution. */
static bool is_quiet(const step_t *step)
{
    return step->now_us - step->link->octets_us >= scan_period_us(step->link) + MUTE_MARGIN_US;
}

/* Octets at the stream's rate, but no scan. While they come, the line is most likely bad and the stream as it
 * was. A request is then worse than none: what damage makes of it may be another stream, or the end of one.
 */
static void hear_on(const step_t *step)
{
    urg_link_t *link = step->link;
    if (hears_foreign(step) || hears_answer(step) || is_quiet(step) ||
        step->now_us - link->requested_us >= REQUEST_MAX_US) {
        link->request_us = REQUEST_US;
        knock_at_stream_rate(step);
    } else {
        listen_to_stream(step);
    }
}

/* Octets at the stream's rate, and they are not those of another one. */
static bool hears_sensor(const step_t *step)
{
    return step->link->rate == step->link->good_rate && step->seen->octet_count != step->link->sent_octets &&
           !wrong_rate(step, 1U);
}

/* At the stream's rate an answer of twice that rate, or more, is a few octets, with or without a fault. Of a
 * frame there would be more. */
static bool hears_faster(const step_t *step)
{
    const urg_link_t *link = step->link;
    return knows_power_up_rate(step) && link->asked_rate > link->rate && link->rate == link->good_rate &&
           step->seen->octet_count != link->sent_octets && hears_few(step);
}

/* A sensor that was there just now, and is mute, has stopped. If one request has no answer either, that was
 * another rate. */
static bool was_there(const step_t *step)
{
    const bool was = step->link->heard;
    step->link->heard = false;
    return was;
}

static void search_on(const step_t *step)
{
    urg_link_t *link = step->link;
    if (!has_streamed(step)) {
        probe_next(step);
    } else if (hears_faster(step)) {
        on_late_answer(step);
    } else if (hears_sensor(step)) {
        link->heard = true;
        hear_on(step);
    } else if (was_there(step)) {
        knock_at_stream_rate(step);
    } else if (link->rate == link->good_rate && wrong_rate(step, STREAM_SIGNS)) {
        on_late_answer(step);
    } else {
        knock_next(step);
    }
}

static void change_rate(const step_t *step)
{
    if (step->link->rate == step->link->good_rate) {
        on_late_answer(step);
    } else {
        listen_to_stream(step);
    }
}

/* The sensor is at one rate or the other, and answers. */
static void search_again(const step_t *step, uint16_t index)
{
    if (has_streamed(step)) {
        ask(step);
    } else {
        probe(step, index);
    }
}

/* The sensor has the new rate, or the old one: it is not known which octets were lost. */
static void rate_unknown(const step_t *step)
{
    if (has_streamed(step)) {
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
    if (has_streamed(step)) {
        start_command(step, URG_STREAM, step->link->config.stream);
    } else {
        stop_sensor(step);
    }
}

/* A late answer to it is heard at the stream's rate. */
static void order_rate(const step_t *step)
{
    step->link->asked_kind = SCIP_BIT_RATE;
    step->link->asked_rate = step->link->rate;
    start_command(step, URG_RATE, SCIP_BIT_RATE);
}

static void rate_or_stop(const step_t *step)
{
    if (step->link->rate == step->link->config.stream_rate) {
        stop_or_stream(step);
    } else {
        order_rate(step);
    }
}

/* ---- the ladder: what to try when the sensor answers but does not scan ---- */

static void count_failure(urg_link_t *link)
{
    if (link->failures < LADDER_TOP) {
        ++link->failures;
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
        stop_or_stream(step);
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

/* Only a sensor that has just powered up speaks SCIP1.1, and it does so at the rate stored in it. */
static void learn_rate(const step_t *step)
{
    if (step->seen->reply.legacy) {
        step->link->config.first_rate = step->link->rate;
        step->link->config.first_rate_known = true;
    }
}

static void on_switch_reply(const step_t *step)
{
    const scip_reply_t *reply = &step->seen->reply;
    if (!reply->legacy || reply->status[0] == (octet_t)'0') {
        learn_rate(step);
        rate_or_stop(step);
    }
}

static void on_rate_reply(const step_t *step)
{
    urg_link_t *link = step->link;
    const scip_reply_t *reply = &step->seen->reply;
    if (is_status(reply, '0', '0') || is_status(reply, '0', '3')) {
        await_new_rate(step);
    } else if (is_refusal(reply) && link->attempt == 1U) {
        repeat_command(step);
    } else {
        link->rate_refused = true;
        stop_or_stream(step);
    }
}

static void ask_or_stream(const step_t *step)
{
    const urg_link_t *link = step->link;
    if (link->asks_left > 0U) {
        start_command(step, URG_STOP2, questions[URG_QUESTIONS - link->asks_left]);
    } else {
        start_command(step, URG_STREAM, link->config.stream);
    }
}

/* The sensor has stopped, so it has time for questions. */
static void on_stopped(const step_t *step)
{
    urg_link_t *link = step->link;
    if (link->to_ask) {
        link->to_ask = false;
        link->asks_left = URG_QUESTIONS;
    }
    ask_or_stream(step);
}

static void on_told(const step_t *step)
{
    if (is_status(&step->seen->reply, '0', '0')) {
        ++step->link->told;
    }
    --step->link->asks_left;
    ask_or_stream(step);
}

static void on_stop_reply(const step_t *step)
{
    urg_link_t *link = step->link;
    if (is_refusal(&step->seen->reply)) {
        command_refused(step);
    } else if (link->rate == link->config.stream_rate || link->rate_refused) {
        on_stopped(step);
    } else {
        order_rate(step);
    }
}

/* A knock was heard. */
static void await_first_scan(const step_t *step)
{
    urg_link_t *link = step->link;
    if (has_streamed(step)) {
        link->knocking = false;
        set_status(step, URG_STREAM);
        link->timeout_us = step->now_us - link->sent_us + scan_timeout_us(link);
    }
    link->acknowledged = true;
    link->acknowledged_octets = step->seen->octet_count;
}

/* The sensor had another one to answer, perhaps one that was damaged on its way; or has still. */
static void repeat_or_listen(const step_t *step)
{
    if (step->link->attempt == 1U) {
        repeat_command(step);
    } else {
        listen_to_stream(step);
    }
}

static void on_stream_reply(const step_t *step)
{
    if (has_streamed(step) && is_status(&step->seen->reply, '0', 'B')) {
        repeat_or_listen(step);
    } else if (is_refusal(&step->seen->reply)) {
        command_refused(step);
    } else if (is_status(&step->seen->reply, '0', '0')) {
        await_first_scan(step);
    } else {
        scans_missing(step);
    }
}

static void on_reply(const step_t *step)
{
    note_answer(step);
    switch (step->link->command) {
    case SCIP_LASER_OFF_1:
        if (step->seen->reply.legacy) {
            learn_rate(step);
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
        stop_or_stream(step);
        break;
    case SCIP_VERSION:
    case SCIP_PARAMETERS:
    case SCIP_STATE:
        on_told(step);
        break;
    case SCIP_RESET:
        search_again(step, PROBE_FIRST);
        break;
    default:
        on_stream_reply(step);
        break;
    }
}

/* The sensor answers one line after the other: behind the answer to an earlier one, perhaps damaged on its
 * way, comes the awaited one. A request that overtakes it is refused ("0B"). */
static bool hears_stray(const step_t *step)
{
    const urg_link_t *link = step->link;
    const uint32_t strays = step->seen->stray_count - link->seen.stray_count;
    const uint32_t frames = step->seen->foreign_count - link->seen.foreign_count;
    return has_streamed(step) && !link->listening && strays != frames &&
           step->now_us - link->sent_us < STRAYS * KNOCK_US;
}

static void wait_on(const step_t *step)
{
    step->link->timeout_us = step->now_us - step->link->sent_us + KNOCK_US;
}

/* "E": the sensor is in SCIP1.1. If that is its answer to SCIP2.0, twice, it knows nothing else. */
static void on_legacy(const step_t *step)
{
    urg_link_t *link = step->link;
    note_answer(step);
    if (link->command != SCIP_SWITCH) {
        start_command(step, URG_SWITCH, SCIP_SWITCH);
    } else if (has_streamed(step)) { /* it knows SCIP2.0: what it refuses is an earlier line */
        set_status(step, URG_SWITCH);
        link->knocking = false;
        wait_on(step);
    } else if (link->attempt > 1U) {
        set_status(step, URG_OLD);
        link->attempt = 1U; /* asked for ever: the sensor may be replaced */
    }
}

/* ---- silence ---- */

/* A sensor that has accepted the request may scan: a second one would cost a frame. */
static bool may_have_missed_request(const step_t *step)
{
    return has_streamed(step) && step->link->status == URG_STREAM && !step->link->acknowledged;
}

/* A sensor that may be at another rate is asked once. Where it was heard, only the answer was lost. */
static uint16_t stop_attempts(const step_t *step)
{
    const uint16_t unheard = step->link->status == URG_STOP2 ? 2U : 1U;
    return heard_clean(step) ? 3U : unheard;
}

static bool is_worth_repeating(const step_t *step)
{
    const scip_kind_t command = step->link->command;
    if (command == step->link->config.stream) {
        return may_have_missed_request(step);
    }
    if (command == SCIP_LASER_OFF_1) {
        return heard_clean(step);
    }
    return is_question(command) ||
           ((command == SCIP_SWITCH || command == SCIP_TIME_LEAVE) && !step->link->knocking);
}

static uint16_t attempts_allowed(const step_t *step)
{
    if (step->link->command == SCIP_STOP) {
        return stop_attempts(step);
    }
    return is_worth_repeating(step) ? 2U : 1U;
}

/* After a stream, octets that are no scan are a damaged one, and without an answer the request may be lost.
 */
static void scans_do_not_come(const step_t *step)
{
    const urg_link_t *link = step->link;
    const bool mute = link->acknowledged && link->acknowledged_octets == step->seen->octet_count;
    if (has_streamed(step) && !mute) {
        search_on(step);
    } else {
        scans_missing(step);
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
        search_again(step, PROBE_FIRST);
        break;
    case SCIP_STOP:
        search_on(step);
        break;
    case SCIP_SWITCH:
    case SCIP_TIME_LEAVE:
        search_again(step, probe_index(link, link->rate));
        break;
    case SCIP_VERSION:
    case SCIP_PARAMETERS:
    case SCIP_STATE:
        link->asks_left = 0U; /* it may have gone: the stream first */
        ask_or_stream(step);
        break;
    default:
        scans_do_not_come(step);
        break;
    }
}

static void on_silence(const step_t *step)
{
    urg_link_t *link = step->link;
    ++link->timeouts;
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
    const uint32_t most_us = has_streamed(step) ? KNOCK_US : FIRST_REPLY_US;
    return mute ? most_us : link->timeout_us;
}

/* An answer may begin with what the sensor heard when other rates were probed. Its end tells. */
static bool may_hear_echo(const step_t *step)
{
    return step->link->status == URG_LOST && step->seen->octet_count != step->link->seen.octet_count &&
           step->seen->framing_count == step->link->sent_framing;
}

/* While the rate is only a guess, signs of a wrong one answer as well as a time-out. */
static bool is_silent(const step_t *step)
{
    const urg_link_t *link = step->link;
    const uint32_t waited_us = step->now_us - link->sent_us;
    const bool guessing = link->status == URG_STOP1 ||
                          (link->status == URG_LOST && link->command == SCIP_STOP);
    if (guessing && may_hear_echo(step)) {
        return waited_us >= answer_timeout_us(step) + TURN_US;
    }
    return waited_us >= answer_timeout_us(step) || (guessing && wrong_rate(step, WRONG_RATE_SIGNS));
}

/* ---- the states ---- */

static void on_scan(const step_t *step)
{
    urg_link_t *link = step->link;
    set_status(step, URG_OK);
    link->knocking = false;
    link->asks_left = 0U;
    link->failures = 0U;
    link->good_rate = link->rate;
    link->scan_us = step->now_us;
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
    } else if (hears_stray(step)) {
        wait_on(step);
    } else if (link->listening && hears_foreign(step)) {
        search_on(step);
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

/* Time from a frame to where the next one is late. */
static uint32_t late_us(const urg_link_t *link)
{
    const uint32_t period_us = scan_period_us(link);
    return period_us * (frame_us(link) / period_us + 1U) + MUTE_MARGIN_US;
}

/* Not an octet since the latest frame. */
static bool is_mute(const step_t *step)
{
    const urg_link_t *link = step->link;
    return link->timed && step->seen->octet_count == step->seen->octets_at_scan &&
           step->now_us - link->frame_us >= late_us(link);
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
    if (step->now_us - link->scan_us >= link->timeout_us || is_mute(step) || streams_other(step)) {
        ++link->restarts;
        begin_search(step);
    } else if (link->to_ask) {
        link->to_ask = false; /* one interruption, whatever comes of it */
        link->asks_left = URG_QUESTIONS;
        stop_sensor(step);
    } else if (link->to_order) {
        stop_sensor(step);
    }
}

const char *urg_status_name(urg_status_t status)
{
    return status_names[status];
}

/* Of a long line the parser knows its end only, so what it tells may go back. */
static uint32_t later(uint32_t told, uint32_t known)
{
    return told - known < HALF ? told : known;
}

void urg_seen_octets(urg_seen_t *seen, const scip_parser_t *parser)
{
    seen->octet_count = later(scip_parser_octets(parser), seen->octet_count);
    seen->strange_count = later(scip_parser_strange(parser), seen->strange_count);
    seen->stray_count = parser->counters.stray;
    seen->foreign_count = parser->counters.foreign;
}

void urg_seen_event(urg_seen_t *seen, const scip_parser_t *parser, scip_event_t event)
{
    switch (event) {
    case SCIP_REPLY:
        ++seen->reply_count;
        seen->reply_kind = parser->awaited.kind;
        seen->reply = parser->reply;
        break;
    case SCIP_SCAN:
        ++seen->scan_count;
        seen->octets_at_scan = parser->counters.octets; /* a line has just ended */
        seen->scan_remaining = parser->scan->remaining;
        break;
    case SCIP_NOTICE:
        ++seen->notice_count;
        seen->notice = parser->reply;
        break;
    case SCIP_LEGACY:
        ++seen->legacy_count;
        break;
    case SCIP_DAMAGED:
        ++seen->damage_count;
        break;
    default:
        break;
    }
}

static urg_refusal_t rate_refusal(const urg_config_t *config)
{
    scip_request_t unused;
    if (!scip_request_bit_rate(&unused, config->first_rate)) {
        return URG_FIRST_RATE;
    }
    if (!scip_request_bit_rate(&unused, config->stream_rate)) {
        return URG_STREAM_RATE;
    }
    return is_possible(config, config->first_rate) && is_possible(config, config->stream_rate) ? URG_ACCEPTED
                                                                                               : URG_TOO_FAST;
}

urg_refusal_t urg_link_refusal(const urg_config_t *config)
{
    scip_request_t unused;
    const urg_refusal_t rate = rate_refusal(config);
    if (config->stream != SCIP_STREAM_2 && config->stream != SCIP_STREAM_3) {
        return URG_STREAM_KIND;
    }
    if (rate != URG_ACCEPTED) {
        return rate;
    }
    if (!is_within(config)) {
        return URG_LAST_STEP;
    }
    return scip_request_scan(&unused, config->stream, &config->range) ? URG_ACCEPTED : URG_RANGE;
}

bool urg_link_init(urg_link_t *link, const urg_config_t *config, uint32_t now_us)
{
    scip_request_t stream;
    if (urg_link_refusal(config) != URG_ACCEPTED) {
        return false;
    }
    (void)scip_request_scan(&stream, config->stream, &config->range);
    *link = (urg_link_t){
        .config = *config, .status = URG_WAIT, .since_us = now_us, .rate = config->first_rate};
    link->scan_octets = stream.scan_octets;
    link->asked = PROBE_STREAM;
    link->asked_rate = config->first_rate; /* also where a stream ends for questions, without a search */
    return true;
}

void urg_link_ask(urg_link_t *link)
{
    link->to_ask = true;
    link->told = 0U;
}

static bool is_same_range(const scip_range_t *a, const scip_range_t *b)
{
    return a->first_step == b->first_step && a->last_step == b->last_step && a->cluster == b->cluster &&
           a->interval == b->interval && a->scans == b->scans;
}

void urg_link_order(urg_link_t *link, const scip_range_t *range)
{
    scip_request_t stream;

    if (!is_same_range(range, &link->config.range)) {
        (void)scip_request_scan(&stream, link->config.stream, range);
        link->config.range = *range;
        link->scan_octets = stream.scan_octets;
        link->to_order = true;
    }
}

uint16_t urg_link_told(const urg_link_t *link)
{
    return link->told;
}

void urg_link_scan_at(urg_link_t *link, uint32_t now_us)
{
    link->frame_us = now_us;
    link->timed = true;
}

static bool has_news(const urg_link_t *link, const urg_seen_t *seen)
{
    return seen->reply_count != link->seen.reply_count || seen->scan_count != link->seen.scan_count ||
           seen->legacy_count != link->seen.legacy_count || seen->stray_count != link->seen.stray_count ||
           wrong_rate_signs(seen) - link->sent_signs >= STREAM_SIGNS;
}

/* From the latest step to where a frame is late, or a command without its answer. */
static uint32_t patience_us(const urg_link_t *link, const urg_seen_t *seen)
{
    if (link->status != URG_OK) {
        return link->waiting ? link->timeout_us - (link->stepped_us - link->sent_us)
                             : SETTLE_RATE_US - (link->stepped_us - link->sent_us);
    }
    return link->timed && seen->octet_count == seen->octets_at_scan
               ? link->frame_us + late_us(link) - link->stepped_us
               : LONG_US;
}

/* A start without trouble has the seed's tick. */
uint32_t urg_link_pause_us(const urg_link_t *link, const urg_seen_t *seen)
{
    const bool by_tick = link->status == URG_WAIT || (link->good_rate == 0U && link->timeouts == 0U);
    const uint32_t left_us = patience_us(link, seen);
    if (by_tick) {
        return URG_STEP_US;
    }
    if (left_us < TURN_US || (link->status != URG_OK && link->waiting && has_news(link, seen))) {
        return TURN_US;
    }
    if (left_us < URG_STEP_US || left_us >= URG_STEP_US + TURN_US) {
        return left_us < URG_STEP_US ? left_us : URG_STEP_US;
    }
    return left_us - TURN_US; /* or the step after this one would come too late */
}

void urg_link_step(urg_link_t *link, const urg_seen_t *seen, uint32_t now_us, urg_action_t *action)
{
    const step_t step = {link, seen, now_us, action};
    *action = (urg_action_t){.send = false};
    if (seen->octet_count != link->seen.octet_count) {
        link->octets_us = now_us;
    }
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
    link->stepped_us = now_us;
    link->seen = *seen;
    action->rate = link->rate;
}
