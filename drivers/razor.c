#include "drivers/razor.h"

#include <math.h>
#include <string.h>

#include "drivers/decimal.h"

#define RAD_PER_DEGREE 0.017453293F             /* pi / 180 */
#define ANGLE_MAX_DEGREE 360.0F                 /* one turn */
#define ACCELERATION_MAX_COUNT (16.0F * 256.0F) /* range of the accelerometer: 16 g, 256 counts per g */

#define TITLE_LENGTH 5U
static const char acceleration_title[] = "#A-C=";
static const char angles_title[] = "#YPR=";

/* What is being received: nothing of interest; the same, and the frame before may be read; the first
 * characters behind a #; the numbers of an A-C line; those of a YPR line, which ends the frame. */
enum { PASSING, DELIVERED, TITLE, ACCELERATION, ANGLES };

void razor_collector_init(razor_collector_t *collector)
{
    *collector = (razor_collector_t){.state = PASSING};
}

void razor_collector_broken(razor_collector_t *collector)
{
    collector->gathered.length = 0U;
    collector->state = PASSING;
}

/* Longer than any frame: what is gathered cannot be one. */
static void keep(razor_collector_t *collector, char character)
{
    razor_text_t *gathered = &collector->gathered;

    if (gathered->length == RAZOR_FRAME_MAX) {
        ++collector->overlong;
        razor_collector_broken(collector);
    } else {
        gathered->text[gathered->length++] = character;
    }
}

/* The line is another one, or was cut short: an A-C line before it stays, its YPR line may come behind. */
static void drop_part(razor_collector_t *collector)
{
    collector->gathered.length = collector->part_start;
    collector->state = PASSING;
}

/* A # within a title or within numbers begins anew: the line end before it was lost. */
static void begin_part(razor_collector_t *collector)
{
    if (collector->state == TITLE) {
        drop_part(collector);
    } else if (collector->state == ANGLES) {
        ++collector->cut;
        collector->gathered.length = 0U;
    } else if (collector->state == DELIVERED) {
        collector->gathered.length = 0U;
    }
    collector->part_start = collector->gathered.length;
    collector->state = TITLE;
    keep(collector, '#');
}

/* Five characters decide; lines with other titles (#YPRAMG, texts) are passed over. */
static void end_title(razor_collector_t *collector)
{
    razor_text_t *gathered = &collector->gathered;
    char *title = &gathered->text[collector->part_start];

    if (memcmp(title, angles_title, TITLE_LENGTH) == 0) {
        collector->state = ANGLES;
    } else if (memcmp(title, acceleration_title, TITLE_LENGTH) == 0) {
        gathered->length = TITLE_LENGTH; /* an earlier part, if any, began with the same title */
        collector->state = ACCELERATION;
    } else {
        drop_part(collector);
    }
}

/* A YPR line completes a frame. The end of an A-C line is kept as its separator, and so is none of a title.
 */
static bool end_line(razor_collector_t *collector)
{
    switch (collector->state) {
    case ANGLES:
        collector->state = DELIVERED;
        return true;
    case ACCELERATION:
        collector->state = PASSING;
        keep(collector, '\n');
        return false;
    case TITLE:
        drop_part(collector);
        return false;
    default:
        return false;
    }
}

static void gather(razor_collector_t *collector, char character)
{
    if (collector->state == PASSING || collector->state == DELIVERED) {
        return;
    }
    keep(collector, character);
    if (collector->state == TITLE && collector->gathered.length == collector->part_start + TITLE_LENGTH) {
        end_title(collector);
    }
}

/* CR and LF both end a line, so CR LF ends it twice, the second time without an effect. */
bool razor_collect(razor_collector_t *collector, octet_t octet)
{
    char character = (char)octet;

    if (character == '\r' || character == '\n') {
        return end_line(collector);
    }
    if (character == '#') {
        begin_part(collector);
    } else {
        gather(collector, character);
    }
    return false;
}

static bool has_title(const char *text, const char *end, const char *title)
{
    return (size_t)(end - text) >= TITLE_LENGTH && memcmp(text, title, TITLE_LENGTH) == 0;
}

static bool is_separator(char character)
{
    return character == '\n' || character == ',' || character == ' ';
}

/* Exactly three numbers with commas between. */
static bool read_triple(const char *text, const char *end, float triple[3])
{
    for (uint16_t i = 0U; i < 2U; ++i) {
        const char *stop = memchr(text, ',', (size_t)(end - text));

        if (stop == NULL || !decimal_read(text, (size_t)(stop - text), &triple[i])) {
            return false;
        }
        text = stop + 1;
    }
    return decimal_read(text, (size_t)(end - text), &triple[2]);
}

/* Reads what stands behind the title of A-C, which does not end in a separator. Returns where the next part
 * begins, NULL when malformed. */
static const char *read_acceleration(const char *body, const char *end, float xyz[3])
{
    const char *next = memchr(body, '#', (size_t)(end - body));
    const char *stop = next;

    if (next == NULL) {
        return NULL;
    }
    /* There is a character before it: the title is. */
    if (is_separator(stop[-1])) {
        --stop;
    }
    return read_triple(body, stop, xyz) ? next : NULL;
}

/* NaN is not within. */
static bool within(const float triple[3], float limit)
{
    return fabsf(triple[0]) <= limit && fabsf(triple[1]) <= limit && fabsf(triple[2]) <= limit;
}

razor_status_t razor_parse(const razor_text_t *text, razor_frame_t *frame)
{
    const char *angles = text->text;
    const char *end = text->text + text->length;
    bool has_acceleration = has_title(angles, end, acceleration_title);
    float xyz[3] = {0.0F, 0.0F, 0.0F};
    float ypr[3];

    if (has_acceleration) {
        angles = read_acceleration(angles + TITLE_LENGTH, end, xyz);
    }
    if (angles == NULL || !has_title(angles, end, angles_title) ||
        !read_triple(angles + TITLE_LENGTH, end, ypr)) {
        return RAZOR_MALFORMED;
    }
    if (!within(ypr, ANGLE_MAX_DEGREE) || !within(xyz, ACCELERATION_MAX_COUNT)) {
        return RAZOR_OUT_OF_RANGE;
    }
    frame->yaw_rad = RAD_PER_DEGREE * ypr[0];
    frame->pitch_rad = RAD_PER_DEGREE * ypr[1];
    frame->roll_rad = RAD_PER_DEGREE * ypr[2];
    frame->has_acceleration = has_acceleration;
    frame->x_counts = xyz[0];
    frame->y_counts = xyz[1];
    frame->z_counts = xyz[2];
    return RAZOR_OK;
}
