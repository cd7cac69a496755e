#include "pulses.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    double sample_us; /* from the head, 0: not told */
    double unit_us;   /* of the time column, 0: there is none */
    double row;       /* number of the sample */
    bool any, high;
    double rose_us, first_us; /* NAN: not seen to rise */
} reader_t;

/* "; Samplerate: 1 MHz" */
static void read_rate(reader_t *reader, const char *line)
{
    double rate;
    char unit[8] = "";

    if (sscanf(line, "; Samplerate: %lf %7s", &rate, unit) == 2 && rate > 0.0) {
        rate *= unit[0] == 'G' ? 1e9 : unit[0] == 'M' ? 1e6 : unit[0] == 'k' ? 1e3 : 1.0;
        reader->sample_us = 1e6 / rate;
    }
}

/* "microseconds,logic", or "logic" */
static void read_titles(reader_t *reader, const char *line)
{
    static const struct {
        const char *name;
        double us;
    } units[] = {{"seconds", 1e6}, {"milliseconds", 1e3}, {"microseconds", 1.0}, {"nanoseconds", 1e-3}};

    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        if (strncasecmp(line, units[i].name, strlen(units[i].name)) == 0) {
            reader->unit_us = units[i].us;
        }
    }
}

static bool read_level(const char *text, bool *level)
{
    *level = text[0] == '1';
    return (text[0] == '0' || text[0] == '1') && strchr(",\r\n", text[1]) != NULL;
}

static bool read_row(reader_t *reader, const char *line, double *when_us, bool *level)
{
    char *end;

    if (reader->unit_us == 0.0) {
        *when_us = reader->row * reader->sample_us;
        reader->row += 1.0;
        return reader->sample_us > 0.0 && read_level(line, level);
    }
    *when_us = strtod(line, &end) * reader->unit_us;
    return end != line && *end == ',' && read_level(end + 1, level);
}

static void take(reader_t *reader, double when_us, bool level, pulses_t *pulses)
{
    if (!reader->any) {
        reader->first_us = when_us;
    } else if (level && !reader->high) {
        reader->rose_us = when_us;
    } else if (!level && reader->high && !isnan(reader->rose_us) && pulses->count < PULSES_MAX) {
        pulses->high_us[pulses->count] = when_us - reader->rose_us;
        pulses->end_s[pulses->count++] = (when_us - reader->first_us) * 1e-6;
    }
    reader->any = true;
    reader->high = level;
}

static const char *read_lines(FILE *file, pulses_t *pulses)
{
    reader_t reader = {.rose_us = NAN};
    char line[256];
    double when_us;
    bool level;

    while (fgets(line, sizeof line, file) != NULL) {
        if (line[0] == ';') {
            read_rate(&reader, line);
        } else if (isalpha((unsigned char)line[0])) {
            read_titles(&reader, line);
        } else if (strchr(line, '\n') == NULL) {
            break; /* still being written */
        } else if (!read_row(&reader, line, &when_us, &level)) {
            return "not a recording of sigrok-cli -O csv (no sample rate, or not 0 and 1)";
        } else {
            take(&reader, when_us, level, pulses);
        }
    }
    return reader.any ? NULL : "no samples";
}

const char *pulses_read(const char *path, pulses_t *pulses)
{
    FILE *file = fopen(path, "r");
    const char *error;

    pulses->count = 0;
    if (file == NULL) {
        return strerror(errno);
    }
    error = read_lines(file, pulses);
    fclose(file);
    return error;
}
