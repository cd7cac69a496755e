/* One step from any sound state of the link, whatever was received, leaves it sound: then any number of steps
 * does. The source is included for its states. */
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
           link_.asks_left <= URG_QUESTIONS &&
           (!is_question(link_.command) || (link_.asks_left > 0U && link_.status != URG_OK));
}

static void any_config(urg_config_t *config)
{
    urg_config_t any;

    *config = any;
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

static void step_from(urg_status_t status)
{
    urg_link_t any, accepted;
    urg_seen_t any_seen;
    urg_config_t config;

    any_config(&config);
    ASSUME(urg_link_init(&accepted, &config, 0U));
    link_ = any;
    link_.config = config;
    link_.status = status;
    link_.scan_octets = accepted.scan_octets;
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
