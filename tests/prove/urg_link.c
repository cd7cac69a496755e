/* One step from any sound state of the link, whatever was received, leaves it sound: then any number of steps
 * does. The source is included for its states. What a step sends is built by functions that are proved by
 * themselves; in the proofs of the steps they are replaced by what they need and what they were proved to
 * give (prove.py, APART). */
#include "drivers/urg_link.c"

#include "prove.h"

static urg_link_t link_;
static urg_seen_t seen;
static urg_action_t action;

static uint32_t any_time(void)
{
    return (uint32_t)nondet_size();
}

static bool is_one_of_scips(uint32_t rate)
{
    for (uint16_t i = 0U; i < SCIP_BIT_RATES; i++) {
        if (scip_bit_rates[i] == rate) {
            return true;
        }
    }
    return false;
}

/* A command that the link itself sends. */
static bool is_own(scip_kind_t kind)
{
    return kind == SCIP_LASER_OFF_1 || kind == SCIP_SWITCH || kind == SCIP_BIT_RATE || kind == SCIP_STOP ||
           kind == SCIP_RESET || kind == SCIP_TIME_LEAVE || is_question(kind) || kind == link_.config.stream;
}

static bool is_sound(void)
{
    return (uint32_t)link_.status < URG_STATUS_COUNT && is_own(link_.command) &&
           is_one_of_scips(link_.rate) && (link_.good_rate == 0U || is_one_of_scips(link_.good_rate)) &&
           (link_.good_rate != 0U || (link_.status != URG_OK && !link_.knocking)) &&
           is_one_of_scips(link_.asked_rate) && link_.asks_left <= URG_QUESTIONS &&
           (!is_question(link_.command) || (link_.asks_left > 0U && link_.status != URG_OK));
}

static void any_config(urg_config_t *config)
{
    urg_config_t any;

    *config = any;
}

/* ---- what is sent ---- */

#define OWN_MOST (SCIP_REQUEST_MAX - 5U) /* without what is put in front: LF, TM2, LF */

static bool build_request(const urg_link_t *link, scip_kind_t kind, scip_request_t *request)
{
    scip_request_t any;

    PROVE(link == &link_ && is_own(kind), "a command of the link");
    ASSUME(any.text_length > 1U && any.text_length <= OWN_MOST);
    *request = any;
    return true;
}

void scip_request_end_line_first(scip_request_t *request)
{
    PROVE(request == &action.request && request->text_length <= OWN_MOST, "room for a line end");
    request->text_length = (uint16_t)(request->text_length + (nondet_bool() ? 1U : 0U));
}

void scip_request_leave_time_first(scip_request_t *request)
{
    PROVE(request == &action.request && request->text_length <= OWN_MOST + 1U,
          "room for TM2 and two line ends");
    request->text_length = (uint16_t)(nondet_bool() ? request->text_length + 4U : OWN_MOST + 5U);
}

/* ---- times ---- */

/* Only comparisons ask for them: any time is proved for. Their divisors are. */
static uint32_t wire_us(const urg_link_t *link, uint32_t octets)
{
    (void)octets;
    PROVE(link == &link_ && is_one_of_scips(link->rate), "a rate of SCIP");
    return any_time();
}

static uint32_t frame_us(const urg_link_t *link)
{
    PROVE(link == &link_, "the link's own stream");
    return any_time();
}

static uint32_t scan_period_us(const urg_link_t *link)
{
    const uint32_t period_us = any_time();

    PROVE(link == &link_, "the link's own stream");
    ASSUME(period_us > 0U);
    return period_us;
}

static uint32_t past_us(const step_t *step)
{
    PROVE(step->link == &link_, "the link's own stream");
    return any_time();
}

static uint32_t late_us(const urg_link_t *link)
{
    PROVE(link == &link_, "the link's own stream");
    return any_time();
}

/* ---- the order of the search ---- */

static uint16_t any_place(void)
{
    const uint16_t place = nondet_cell();

    ASSUME(place < PROBES);
    return place;
}

static uint16_t probe_index(const urg_link_t *link, uint32_t rate)
{
    const uint16_t place = any_place();

    PROVE(link == &link_ && is_one_of_scips(rate), "a rate of the search");
    ASSUME(rate != link->config.stream_rate || place == PROBE_STREAM);
    return place;
}

static uint16_t next_probe(const urg_link_t *link, uint16_t index)
{
    (void)index;
    PROVE(link == &link_, "the link's own search");
    return any_place();
}

void starts_sound(void)
{
    urg_config_t config;

    any_config(&config);
    if (urg_link_init(&link_, &config, any_time())) {
        PROVE(is_sound(), "sound from the start on");
        PROVE(is_one_of_scips(config.first_rate) && is_one_of_scips(config.stream_rate), "rates of SCIP");
    }
}

static void any_sound_link(void)
{
    urg_link_t any, accepted;
    urg_config_t config;

    any_config(&config);
    ASSUME(urg_link_init(&accepted, &config, 0U));
    link_ = any;
    link_.config = config;
    link_.scan_octets = accepted.scan_octets;
}

static void step_from(urg_status_t status)
{
    urg_seen_t any_seen;

    any_sound_link();
    link_.status = status;
    seen = any_seen;
    ASSUME(is_sound());
    urg_link_step(&link_, &seen, any_time(), &action);
    PROVE(is_sound(), "sound after any step");
    PROVE(action.request.text_length <= SCIP_REQUEST_MAX, "a request within its memory");
    PROVE(!action.send || (action.expect && action.request.text_length > 1U), "what is sent is awaited");
    PROVE(action.rate == link_.rate, "the rate is told");
}

void steps_in_wait(void)
{
    step_from(URG_WAIT);
}

void steps_in_a_stream(void)
{
    step_from(URG_OK);
}

void steps_in_a_dialogue(void)
{
    const urg_status_t status = (urg_status_t)nondet_cell();

    ASSUME(status < URG_STATUS_COUNT && status != URG_WAIT && status != URG_OK);
    step_from(status);
}

void any_octets_have_their_time(void)
{
    any_sound_link();
    ASSUME(is_one_of_scips(link_.rate));
    (void)wire_us_itself(&link_, any_time());
}

void any_stream_has_its_times(void)
{
    const step_t step = {&link_, &seen, any_time(), &action};

    any_sound_link();
    (void)frame_us_itself(&link_);
    PROVE(scan_period_us_itself(&link_) > 0U, "a period");
    (void)past_us_itself(&step);
    (void)late_us_itself(&link_);
}

void any_request_is_built(void)
{
    const scip_kind_t kind = (scip_kind_t)nondet_cell();
    scip_request_t request;

    any_sound_link();
    ASSUME(is_own(kind));
    PROVE(build_request_itself(&link_, kind, &request), "every command of the link");
    PROVE(request.text_length > 1U && request.text_length <= OWN_MOST, "with room for what is put in front");
}

static void any_request(uint16_t most)
{
    scip_request_t any;

    action.request = any;
    ASSUME(action.request.text_length > 1U && action.request.text_length <= most);
}

void any_request_has_a_line_end_first(void)
{
    any_request(OWN_MOST + 1U);
    const uint16_t before = action.request.text_length;
    scip_request_end_line_first_itself(&action.request);
    PROVE(action.request.text[0] == SCIP_LINE_FEED, "a line end");
    PROVE(action.request.text_length == before || action.request.text_length == before + 1U, "and no more");
}

void any_request_leaves_time_mode_first(void)
{
    any_request(OWN_MOST);
    scip_request_leave_time_first_itself(&action.request);
    PROVE(action.request.text_length <= SCIP_REQUEST_MAX, "within its memory");
}

void any_rate_has_its_place(void)
{
    const uint32_t rate = (uint32_t)nondet_size();

    any_sound_link();
    ASSUME(is_one_of_scips(rate));
    const uint16_t place = probe_index_itself(&link_, rate);
    PROVE(place < PROBES, "a place");
    PROVE(rate != link_.config.stream_rate || place == PROBE_STREAM, "the stream's rate is the first one");
}

/* The stream's rate is possible, and first of its places: so the loop ends. */
void any_place_has_a_next_one(void)
{
    any_sound_link();
    PROVE(next_probe_itself(&link_, nondet_cell()) < PROBES, "a place");
}
