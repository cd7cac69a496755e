#include "pulses.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "input.h"

/* "; Samplerate: 1 MHz" */
static void read_rate(pulse_reader_t *reader, const char *line)
{
    double rate;
    char unit[8] = "";

    if (sscanf(line, "; Samplerate: %lf %7s", &rate, unit) == 2 && rate > 0.0) {
        rate *= unit[0] == 'G' ? 1e9 : unit[0] == 'M' ? 1e6 : unit[0] == 'k' ? 1e3 : 1.0;
        reader->sample_us = 1e6 / rate;
    }
}

/* "microseconds,logic", or "logic" */
static void read_titles(pulse_reader_t *reader, const char *line)
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

static bool read_row(pulse_reader_t *reader, const char *line, double *when_us, bool *level)
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

static bool take(pulse_reader_t *reader, double when_us, bool level, double *high_us, double *end_s)
{
    const bool ended = reader->any && !level && reader->high && !isnan(reader->rose_us);

    if (!reader->any) {
        reader->first_us = when_us;
    } else if (level && !reader->high) {
        reader->rose_us = when_us;
    }
    *high_us = when_us - reader->rose_us;
    *end_s = (when_us - reader->first_us) * 1e-6;
    reader->any = true;
    reader->high = level;
    return ended;
}

pulse_line_t pulse_line(pulse_reader_t *reader, const char *line, double *high_us, double *end_s)
{
    double when_us;
    bool level;

    if (line[0] == ';') {
        read_rate(reader, line);
    } else if (isalpha((unsigned char)line[0])) {
        read_titles(reader, line);
    } else if (!read_row(reader, line, &when_us, &level)) {
        return PULSE_NONSENSE;
    } else if (take(reader, when_us, level, high_us, end_s)) {
        return PULSE_ENDED;
    }
    return PULSE_NONE;
}

static const char *read_lines(FILE *file, pulses_t *pulses)
{
    pulse_reader_t reader = PULSE_READER;
    char line[256];

    while (fgets(line, sizeof line, file) != NULL && strchr(line, '\n') != NULL) { /* else: being written */
        double high_us, end_s;
        const pulse_line_t found = pulse_line(&reader, line, &high_us, &end_s);

        if (found == PULSE_NONSENSE) {
            return "not a recording of sigrok-cli -O csv (no sample rate, or not 0 and 1)";
        }
        if (found == PULSE_ENDED && pulses->count < PULSES_MAX) {
            pulses->high_us[pulses->count] = high_us;
            pulses->end_s[pulses->count++] = end_s;
        }
    }
    return reader.any ? NULL : "no samples";
}

const char *pulses_read(const char *path, pulses_t *pulses)
{
    FILE *file = input_open(path);
    const char *error;

    pulses->count = 0;
    if (file == NULL) {
        return strerror(errno);
    }
    error = read_lines(file, pulses);
    fclose(file);
    return error;
}

#define RUNS_LEAST 6    /* of high bits: a command to the IMU has as many */
#define RUN_MOST 9.5    /* bits; a longer one is a pause between characters */
#define PAUSE_US 1100.0 /* more than a character at 9600 bit/s: the rate may change */
#define NEAR 0.12       /* an oscillator that is 8 % off is told by its figure */

typedef struct {
    double bit_us, time_us, bits;
    size_t runs;
} rate_t;

static double shortest_us(const pulses_t *pulses, size_t from, size_t end)
{
    double least_us = INFINITY;

    for (size_t i = from; i < end; i++) {
        least_us = fmin(least_us, pulses->high_us[i]);
    }
    return least_us;
}

/* Which rate a stretch between two pauses has: its shortest high time is a bit. PULSES_RATES: none. */
static int rate_of(const pulses_t *pulses, size_t from, size_t end, const double nominal[PULSES_RATES])
{
    const double bit_us = shortest_us(pulses, from, end);
    int rate = 0;

    while (rate < PULSES_RATES && !(nominal[rate] > 0.0 && fabs(1e6 / bit_us / nominal[rate] - 1.0) < NEAR)) {
        rate++;
    }
    return rate;
}

static void add_stretch(const pulses_t *pulses, size_t from, size_t end, double bit_us, rate_t *rate)
{
    for (size_t i = from; i < end; i++) {
        if (pulses->high_us[i] < RUN_MOST * bit_us) {
            rate->time_us += pulses->high_us[i];
            rate->bits += round(pulses->high_us[i] / bit_us);
            rate->runs++;
        }
    }
}

/* Every stretch, with the bit times that are known so far. */
static void add_all(const pulses_t *pulses, const double nominal[PULSES_RATES], rate_t rates[PULSES_RATES])
{
    size_t from = 0;

    for (size_t end = 0; end <= pulses->count; end++) {
        if (end == pulses->count || pulses->high_us[end] > PAUSE_US) {
            const int rate = end > from ? rate_of(pulses, from, end, nominal) : PULSES_RATES;

            if (rate < PULSES_RATES) {
                const double known_us = rates[rate].bit_us;

                add_stretch(pulses, from, end, known_us > 0.0 ? known_us : shortest_us(pulses, from, end),
                            &rates[rate]);
            }
            from = end + 1;
        }
    }
}

void pulses_bit_rates(const pulses_t *pulses, const double nominal[PULSES_RATES], double found[PULSES_RATES])
{
    rate_t rates[PULSES_RATES] = {{.runs = 0}};

    for (int round_trip = 0; round_trip < 3; round_trip++) {
        for (int i = 0; i < PULSES_RATES; i++) {
            rates[i] = (rate_t){.bit_us = rates[i].bits > 0.0 ? rates[i].time_us / rates[i].bits : 0.0};
        }
        add_all(pulses, nominal, rates);
    }
    for (int i = 0; i < PULSES_RATES; i++) {
        found[i] = rates[i].runs >= RUNS_LEAST ? 1e6 * rates[i].bits / rates[i].time_us : 0.0;
    }
}
