#include "drivers/urg.h"

bool urg_init(urg_driver_t *urg, const urg_config_t *config, uint16_t *distance_mm, uint16_t values,
              uint32_t now_us)
{
    scip_request_t stream;
    urg_link_t link;
    if (!urg_link_init(&link, config, now_us)) {
        return false;
    }
    (void)scip_request_scan(&stream, config->stream, &config->range); /* which the link has asked for too */
    if (values / 2U < stream.points) {
        return false;
    }
    *urg = (urg_driver_t){.link = link};
    for (uint16_t i = 0U; i < 2U; i++) {
        urg->scans[i].distance_mm = &distance_mm[i * stream.points];
        urg->scans[i].capacity = stream.points;
    }
    scip_parser_init(&urg->parser);
    scip_parser_scan_into(&urg->parser, &urg->scans[0]);
    return true;
}

static void change_scans(urg_driver_t *urg)
{
    urg->fresh = true;
    urg->filling ^= 1U;
    scip_parser_scan_into(&urg->parser, &urg->scans[urg->filling]);
}

bool urg_take_event(urg_driver_t *urg, scip_event_t event)
{
    urg_seen_event(&urg->seen, &urg->parser, event);
    if (event != SCIP_SCAN) {
        return false;
    }
    change_scans(urg);
    return true;
}

bool urg_feed_all(urg_driver_t *urg, const octet_t *octets, size_t count)
{
    bool complete = false;
    while (count > 0U) {
        scip_event_t event;
        const size_t taken = scip_parser_feed_run(&urg->parser, octets, count, &event);
        octets += taken;
        count -= taken;
        if (event != SCIP_NOTHING && urg_take_event(urg, event)) {
            complete = true;
        }
    }
    return complete;
}

void urg_line_broken(urg_driver_t *urg, uint32_t framing_errors)
{
    scip_parser_line_broken(&urg->parser);
    urg->seen.framing_count += framing_errors;
}

void urg_step(urg_driver_t *urg, uint32_t now_us)
{
    urg_seen_octets(&urg->seen, &urg->parser);
    urg_link_step(&urg->link, &urg->seen, now_us, &urg->action);
    if (urg->action.expect) {
        scip_parser_expect(&urg->parser, &urg->action.request);
    }
}

void urg_scan_at(urg_driver_t *urg, uint32_t now_us)
{
    urg_link_scan_at(&urg->link, now_us);
}

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
    for (uint16_t i = 0U; i < output->count; i++) {
        output->octets[i] = action->request.text[i];
    }
    urg->action = (urg_action_t){.send = false};
    return some;
}

bool urg_take_scan(urg_driver_t *urg, scip_scan_t *scan)
{
    const bool fresh = urg->fresh;
    if (fresh) {
        *scan = urg->scans[urg->filling ^ 1U];
        urg->fresh = false;
    }
    return fresh;
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
        .restarts = urg->link.restarts,
        .timeouts = urg->link.timeouts,
        .pause_us = urg_link_pause_us(&urg->link, &seen),
        .seen = seen,
        .scip = urg->parser.counters,
        .last_damage = urg->parser.last_damage,
    };
}
