/* The throttle pin as a logic analyser has recorded it: the CSV that sigrok-cli writes (`-O csv`, with or
 * without time=true and dedup=true), of one channel, or of several with the pin on the first. */
#ifndef TOOLS_PLOMADA_PULSES_H
#define TOOLS_PLOMADA_PULSES_H

#include <stdbool.h>
#include <stddef.h>

#define PULSES_MAX 65536

typedef struct {
    size_t count;
    double high_us[PULSES_MAX];
    double end_s[PULSES_MAX]; /* since the first sample */
} pulses_t;

/* Whole pulses only. NULL when fine, else what is wrong with the file. */
const char *pulses_read(const char *path, pulses_t *pulses);

#define PULSES_RATES 3

/* Of a UART's transmit pin in place of the throttle's: the bit rates that it sent at, from the high times
 * within characters. For each nominal rate (0: none) the one within 12 % of it, 0 where there are too few
 * bits. Wants some samples a bit: at least 1 MHz for 57600 bit/s, 4 MHz for 250000. */
void pulses_bit_rates(const pulses_t *pulses, const double nominal[PULSES_RATES], double found[PULSES_RATES]);

/* The same line by line, while it is being recorded. Begins as PULSE_READER. */
typedef struct {
    double sample_us; /* from the head, 0: not told */
    double unit_us;   /* of the time column, 0: there is none */
    double row;       /* number of the sample */
    bool any, high;
    double rose_us, first_us; /* NAN: not seen to rise */
} pulse_reader_t;
#define PULSE_READER ((pulse_reader_t){.rose_us = NAN})

typedef enum { PULSE_NONE, PULSE_ENDED, PULSE_NONSENSE } pulse_line_t;

/* PULSE_ENDED: a pulse ended with this line; how long it was, and when it ended since the first sample. */
pulse_line_t pulse_line(pulse_reader_t *reader, const char *line, double *high_us, double *end_s);

#endif
