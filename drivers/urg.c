#include "drivers/urg.h"

static const char *const refusal_texts[] = {
    "accepted",
    "stream is neither MS nor MD",
    "first_rate is not a rate of SCIP",
    "stream_rate is not a rate of SCIP",
    "a rate is above fastest_rate",
    "the range ends beyond the sensor's last step",
    "steps, cluster, interval or count of the range are impossible",
    "the memory is too small for two scans",
};
typedef char
    every_refusal_has_a_text[(sizeof refusal_texts / sizeof refusal_texts[0] == URG_REFUSAL_COUNT) ? 1 : -1];

urg_refusal_t urg_refusal(const urg_config_t *config, uint16_t values)
{
    scip_request_t stream;
    const urg_refusal_t refusal = urg_link_refusal(config);
    if (refusal != URG_ACCEPTED) {
        return refusal;
    }
    (void)scip_request_scan(&stream, config->stream, &config->range);
    return values / 2U < stream.points ? URG_MEMORY : URG_ACCEPTED;
}

const char *urg_refusal_text(urg_refusal_t refusal)
{
    return refusal_texts[refusal];
}

bool urg_init(urg_driver_t *urg, const urg_config_t *config, uint16_t *distance_mm, uint16_t values,
              uint32_t now_us)
{
    if (urg_refusal(config, values) != URG_ACCEPTED) {
        return false;
    }
    *urg = (urg_driver_t){.fresh = false};
    (void)urg_link_init(&urg->link, config, now_us);
    for (uint16_t i = 0U; i < 2U; ++i) {
        urg->scans[i].distance_mm = &distance_mm[i * (values / 2U)];
        urg->scans[i].capacity = values / 2U;
    }
    scip_parser_init(&urg->parser);
    scip_parser_scan_into(&urg->parser, &urg->scans[0]);
    return true;
}

/* The complete one waits for urg_take_scan(); the parser may fill the other at once, so no scan waits for the
 * reader. */
static void change_scans(urg_driver_t *urg)
{
    urg->fresh = true;
    urg->filling ^= 1U;
    scip_parser_scan_into(&urg->parser, &urg->scans[urg->filling]);
}

/* Inline: a call more would be a hundredth of a scan's instructions. */
static inline bool take_event(urg_driver_t *urg, scip_event_t event)
{
    urg_seen_event(&urg->seen, &urg->parser, event);
    if (event == SCIP_SCAN) {
        change_scans(urg);
        return true;
    }
    if (event == SCIP_TEXT) { /* awaited since urg_ask() alone, which has told where to */
        scip_info_take(urg->info, &urg->parser);
    }
    return false;
}

bool urg_take_event(urg_driver_t *urg, scip_event_t event)
{
    return take_event(urg, event);
}

/* A burst may hold the end of one scan and the whole of the next: then the next is the one to be taken. */
bool urg_feed_all(urg_driver_t *urg, const octet_t *octets, size_t count)
{
    bool complete = false;
    while (count > 0U) {
        scip_event_t event;
        const size_t taken = scip_parser_feed_run(&urg->parser, octets, count, &event);
        octets += taken;
        count -= taken;
        if (event != SCIP_NOTHING && take_event(urg, event)) {
            complete = true;
        }
    }
    return complete;
}

/* Framing errors alone tell of a wrong rate; an overrun does not. */
void urg_line_broken(urg_driver_t *urg, uint32_t framing_errors)
{
    scip_parser_line_broken(&urg->parser);
    urg->seen.framing_count += framing_errors;
}

void urg_step(urg_driver_t *urg, uint32_t now_us)
{
    urg_seen_octets(&urg->seen, &urg->parser);
    urg_link_step(&urg->link, &urg->seen, now_us, &urg->action);
    /* Before it is sent: the answer may be there while the last octet leaves. */
    if (urg->action.expect) {
        scip_parser_expect(&urg->parser, &urg->action.request);
    }
}

void urg_scan_at(urg_driver_t *urg, uint32_t now_us)
{
    urg_link_scan_at(&urg->link, now_us);
}

/* With what was fed since the step: an answer makes the pause shorter. */
uint32_t urg_pause_us(const urg_driver_t *urg)
{
    urg_seen_t seen = urg->seen;
    if (urg->link.status == URG_OK) { /* asked often, and here the number is enough */
        seen.octet_count = scip_parser_octets(&urg->parser);
    } else {
        urg_seen_octets(&seen, &urg->parser);
    }
    return urg_link_pause_us(&urg->link, &seen);
}

bool urg_next_to_send(urg_driver_t *urg, urg_output_t *output)
{
    const urg_action_t *action = &urg->action;
    const bool some = action->send || action->set_rate || action->cycle_power;
    *output = (urg_output_t){
        .cycle_power = action->cycle_power, .set_rate = action->set_rate, .rate = urg->link.rate};
    if (action->send) {
        output->count = action->request.text_length;
    }
    for (uint16_t i = 0U; i < output->count; ++i) {
        output->octets[i] = action->request.text[i];
    }
    /* Once: a second call must not send it again. */
    urg->action = (urg_action_t){.send = false};
    return some;
}

/* The one that is not being filled. */
bool urg_take_scan(urg_driver_t *urg, scip_scan_t *scan)
{
    const bool fresh = urg->fresh;
    if (fresh) {
        *scan = urg->scans[urg->filling ^ 1U];
        urg->fresh = false;
    }
    return fresh;
}

bool urg_order(urg_driver_t *urg, const scip_range_t *range)
{
    urg_config_t config = urg->link.config;
    config.range = *range;
    if (urg_refusal(&config, (uint16_t)(2U * urg->scans[0].capacity)) != URG_ACCEPTED) {
        return false;
    }
    urg_link_order(&urg->link, range);
    return true;
}

void urg_ask(urg_driver_t *urg, scip_info_t *info)
{
    scip_info_init(info);
    urg->info = info;
    urg_link_ask(&urg->link);
}

bool urg_told(const urg_driver_t *urg)
{
    return urg_link_told(&urg->link) == URG_QUESTIONS;
}

uint16_t urg_expected(const urg_driver_t *urg)
{
    return scip_parser_expected(&urg->parser);
}

void urg_report(const urg_driver_t *urg, urg_report_t *report)
{
    urg_seen_t seen = urg->seen;
    urg_seen_octets(&seen, &urg->parser);
    *report = (urg_report_t){
        .status = urg->link.status,
        .rate = urg->link.rate,
        .first_rate = urg->link.config.first_rate,
        .first_rate_known = urg->link.config.first_rate_known,
        .restarts = urg->link.restarts,
        .timeouts = urg->link.timeouts,
        .pause_us = urg_link_pause_us(&urg->link, &seen),
        .seen = seen,
        .scip = urg->parser.counters,
        .last_damage = urg->parser.last_damage,
    };
}
