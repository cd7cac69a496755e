/* A condition of the world that holds for a while of scenario time. */
#ifndef SIM_DEVICES_SPAN_H
#define SIM_DEVICES_SPAN_H

#include <stdbool.h>

#define SPAN_POWER_ON_S (-1000.0) /* a start so early: from power-on */
#define SPAN_FOR_GOOD_S 1e9       /* a length without an end; as a start: never */

typedef struct {
    double start_s, length_s;
} span_t;

static inline bool span_holds(const span_t *span, double t_s)
{
    return t_s >= span->start_s && t_s < span->start_s + span->length_s;
}

#endif
