/* The throttle pulse of every control cycle on the radio's line, for a bench that plays the vehicle and has no other way to
 * know it (docs/acceptance.md). While it runs the periodic telemetry line stays away: a pulse behind it would be 80 ms old.
 * Off after every reset. */
#ifndef FIRMWARE_PULSE_STREAM_H
#define FIRMWARE_PULSE_STREAM_H

#include <stdbool.h>

/* Any task; in force from the next control cycle on. */
void pulse_stream_set(bool on);
bool pulse_stream_on(void);

/* The pulse of this cycle: sends its line when the stream is on. TaskControl. */
void pulse_stream_take(float pulse_us);

#endif
