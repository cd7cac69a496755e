/* As in telecommand.c: every step from any sound state to a sound one. decimal.c is replaced by
 * any answer. */
#include "drivers/razor.h"

#include "drivers/decimal.h"
#include "prove.h"

#define TITLE_STATE 2U /* the states of razor.c */
#define ACCELERATION_STATE 3U
#define ANGLES_STATE 4U
#define TITLE_LENGTH 5U

static razor_text_t frame_text;

static bool is_in_frame(const char *text, size_t size)
{
    const size_t at = (size_t)(text - frame_text.text);

    return at <= frame_text.length && size <= frame_text.length - at;
}

bool decimal_read(const char *text, size_t length, float *value)
{
    const bool read = nondet_bool();

    PROVE(is_in_frame(text, length), "only characters of the frame are read");
    if (read) {
        *value = nondet_float();
    }
    return read;
}

/* Any of the places that it may find, or none. */
void *memchr(const void *text, int character, size_t size)
{
    const char *at = text;
    const size_t where = nondet_size();

    PROVE(is_in_frame(at, size), "only characters of the frame are searched");
    if (nondet_bool()) {
        return NULL;
    }
    ASSUME(where < size && at[where] == (char)character);
    return (void *)&at[where];
}

static bool is_sound(const razor_collector_t *collector)
{
    const uint16_t length = collector->gathered.length;
    const uint16_t part = collector->part_start;

    return length <= RAZOR_FRAME_MAX && collector->state <= ANGLES_STATE &&
           (collector->state != TITLE_STATE || (part < length && length < part + TITLE_LENGTH)) &&
           (collector->state != ACCELERATION_STATE || length >= TITLE_LENGTH);
}

void collector_starts_sound(void)
{
    razor_collector_t collector;

    razor_collector_init(&collector);
    PROVE(is_sound(&collector), "sound from the start");
}

void collector_stays_sound(void)
{
    razor_collector_t collector;

    ASSUME(is_sound(&collector));
    if (nondet_bool()) {
        razor_collector_broken(&collector);
    }
    (void)razor_collect(&collector, nondet_cell());
    PROVE(is_sound(&collector), "sound after any octet");
}

void any_frame_is_parsed(void)
{
    razor_text_t any;
    razor_frame_t frame;

    frame_text = any;
    ASSUME(frame_text.length <= RAZOR_FRAME_MAX);
    (void)razor_parse(&frame_text, &frame);
}
