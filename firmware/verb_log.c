#include "drivers/decimal.h"
#include "firmware/flight_recorder.h"
#include "firmware/servers.h"
#include "firmware/verbs.h"
#include "firmware/xbee_port.h"

#define SECONDS_MAX 3600U

static struct {
    uint32_t number; /* next to send */
    uint32_t end;    /* first not to send */
    uint32_t sent;   /* lines, the titles not counted */
    bool titles;     /* still to send */
    bool active;
} dump;

static bool say(answer_t *answer, const char *text)
{
    answer_begin(answer);
    telemetry_text(&answer->line, text);
    answer_send(answer);
    return true;
}

static bool start(answer_t *answer, uint32_t first)
{
    dump.number = first;
    /* Fixed now: a dump in flight would otherwise chase the records that are being written, and never
     * end. */
    dump.end = flight_recorder_span().next;
    dump.sent = 0U;
    dump.titles = true;
    dump.active = true;
    answer_begin(answer);
    answer_count(answer, "records", dump.end - dump.number);
    answer_send(answer);
    return true;
}

bool verb_log(answer_t *answer)
{
    const telecommand_t *command = answer->command;
    float seconds;

    if (command->argument_length == 0U) {
        return start(answer, flight_recorder_span().oldest);
    }
    if (answer_argument_is(answer, "STOP")) {
        dump.active = false;
        return say(answer, " STOP");
    }
    /* The dump first: its numbers mean records that are gone then. */
    if (answer_argument_is(answer, "CLEAR")) {
        dump.active = false;
        flight_recorder_clear();
        return say(answer, " CLEAR");
    }
    if (answer_argument_is(answer, "RATE FAST") || answer_argument_is(answer, "RATE SLOW")) {
        const bool fast = answer_argument_is(answer, "RATE FAST");

        flight_recorder_set_rate(fast ? FLIGHT_RECORDER_FAST : FLIGHT_RECORDER_SLOW);
        return say(answer, fast ? " RATE FAST" : " RATE SLOW");
    }
    if (!decimal_read(command->argument, command->argument_length, &seconds)) {
        return answer_refuse(answer, "seconds, CLEAR, STOP or RATE FAST|SLOW");
    }
    if (!(seconds > 0.0F && seconds <= (float)SECONDS_MAX)) {
        return answer_refuse(answer, "out of range 0..3600 s");
    }
    return start(answer, flight_recorder_since((uint16_t)seconds));
}

/* Skips what was overwritten meanwhile. */
static bool next_record(published_t *record)
{
    const flight_recorder_span_t span = flight_recorder_span();

    if (span.oldest - dump.number < dump.end - dump.number) {
        dump.number = span.oldest;
    }
    return dump.number != dump.end && flight_recorder_read(dump.number, record);
}

/* "OK LOG 17 ", and at the end of the line its sum: what was cut or mangled on the way is told from what is
 * whole. */
static void begin_numbered(telemetry_line_t *line, uint32_t number)
{
    telemetry_begin_answer(line);
    telemetry_text(line, "OK LOG ");
    telemetry_count(line, number);
    telemetry_text(line, " ");
}

static bool send_numbered(telemetry_line_t *line)
{
    telemetry_sum(line);
    telemetry_end(line);
    return xbee_port_spare(line);
}

/* They are a numbered line like the others. So a reader knows whether they are whole. */
static bool send_titles(telemetry_line_t *line)
{
    begin_numbered(line, 0U);
    published_titles(line);
    dump.titles = !send_numbered(line);
    return !dump.titles;
}

static bool send_end(telemetry_line_t *line)
{
    telemetry_begin(line);
    telemetry_text(line, "OK LOG END lines:");
    telemetry_count(line, dump.sent);
    telemetry_end(line);
    dump.active = !xbee_port_spare(line);
    return false;
}

static bool send_row(telemetry_line_t *line)
{
    published_t record;

    if (!next_record(&record)) {
        return send_end(line);
    }
    begin_numbered(line, dump.sent + 1U);
    published_row(line, &record);
    if (!send_numbered(line)) {
        return false;
    }
    ++dump.number;
    ++dump.sent;
    return true;
}

bool verb_log_more(void)
{
    static telemetry_line_t line;

    while (dump.active && !xbee_port_waiting() && (dump.titles ? send_titles(&line) : send_row(&line))) {
    }
    return dump.active;
}
