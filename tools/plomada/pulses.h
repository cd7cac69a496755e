/* The throttle pin as a logic analyser has recorded it: the CSV that sigrok-cli writes (`-O csv`, with or
 * without time=true and dedup=true), of one channel, or of several with the pin on the first. */
#ifndef TOOLS_PLOMADA_PULSES_H
#define TOOLS_PLOMADA_PULSES_H

#include <stddef.h>

#define PULSES_MAX 65536

typedef struct {
    size_t count;
    double high_us[PULSES_MAX];
    double end_s[PULSES_MAX]; /* since the first sample */
} pulses_t;

/* Whole pulses only. NULL when fine, else what is wrong with the file. */
const char *pulses_read(const char *path, pulses_t *pulses);

#endif
