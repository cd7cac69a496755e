#include "flexiport.h"

#include <string.h>

#define SIZE_MAX_OCTETS 1000000ULL /* one read() of a serial port has far less */
#define SECONDS_MAX 100000000ULL   /* three years: the times are counted from the log's begin */
#define MICROSECONDS 1000000ULL

static unsigned long long number(const flexiport_t *log, size_t index)
{
    const unsigned char *octets = log->head + index * log->width;
    unsigned long long value = 0;

    for (size_t i = 0; i < log->width; i++) {
        value = value << 8 | octets[log->width == 8 ? log->width - 1 - i : i];
    }
    return value;
}

static bool head_is_sound(const flexiport_t *log)
{
    return number(log, 0) <= SECONDS_MAX && number(log, 1) < MICROSECONDS && number(log, 2) > 0 &&
           number(log, 2) <= SIZE_MAX_OCTETS;
}

static size_t least(size_t a, unsigned long long b)
{
    return b < a ? (size_t)b : a;
}

static void ignore(void *context, const unsigned char *octets, size_t count)
{
    (void)context;
    (void)octets;
    (void)count;
}

static bool fits(flexiport_t *log, size_t width, const unsigned char *octets, size_t count)
{
    memset(log, 0, sizeof *log);
    log->width = width;
    return count >= 3 * width && flexiport_feed(log, octets, count, ignore, NULL);
}

bool flexiport_begin(flexiport_t *log, const unsigned char *octets, size_t count)
{
    const size_t width = fits(log, 4, octets, count) ? 4 : fits(log, 8, octets, count) ? 8 : 0;

    memset(log, 0, sizeof *log);
    log->width = width;
    return width > 0;
}

bool flexiport_feed(flexiport_t *log, const unsigned char *octets, size_t count, flexiport_take_t take,
                    void *context)
{
    while (count > 0 && !log->broken) {
        const size_t part = log->left > 0 ? least(count, log->left)
                                          : least(count, 3 * log->width - log->head_length);

        if (log->left > 0) {
            take(context, octets, part);
            log->left -= part;
        } else {
            memcpy(log->head + log->head_length, octets, part);
            log->head_length += part;
        }
        if (log->head_length == 3 * log->width) {
            log->broken = !head_is_sound(log);
            log->left = number(log, 2);
            log->head_length = 0;
        }
        octets += part;
        count -= part;
    }
    return !log->broken;
}
