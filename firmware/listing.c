#include "firmware/listing.h"

#include <stddef.h>

#include "firmware/xbee_port.h"

static struct {
    listing_line_t line; /* NULL: nothing to send */
    uint16_t number;
    telecommand_t command;
    answer_t answer;
} listing;

/* A new list takes the place of one that is being sent: the operator wants what he asked for last. The
 * command is copied, because its line is gone when the next one comes. */
bool listing_start(const answer_t *answer, listing_line_t line)
{
    listing.line = line;
    listing.number = 0U;
    listing.command = *answer->command;
    listing.answer.command = &listing.command;
    return true;
}

static void write_end(answer_t *answer)
{
    answer_begin(answer);
    telemetry_text(&answer->line, " END");
    answer_count(answer, "lines", listing.number);
}

/* True when it was sent. */
static bool send_next(void)
{
    answer_t *answer = &listing.answer;
    const bool more = listing.line(answer, listing.number);

    if (!more) {
        write_end(answer);
    }
    telemetry_end(&answer->line);
    /* It is made anew next time. A list has no memory but its number, so its values are those of the
     * instant at which they are sent. */
    if (!xbee_port_spare(&answer->line)) {
        return false;
    }
    ++listing.number;
    listing.line = more ? listing.line : NULL;
    return true;
}

bool listing_more(void)
{
    while (listing.line != NULL && send_next()) {
    }
    return listing.line != NULL;
}
