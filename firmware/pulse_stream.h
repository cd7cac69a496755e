/* Sends the throttle pulse of every control cycle over the radio. It is for a test bench that simulates
 * the vehicle and has no other way to know the pulse (docs/acceptance.md). While it runs, no periodic
 * telemetry is sent: a pulse behind a telemetry line would be 80 ms late. Off after every reset. */
#ifndef FIRMWARE_PULSE_STREAM_H
#define FIRMWARE_PULSE_STREAM_H

#include <stdbool.h>

/* Switches the stream on or off from the next control cycle on. Any task. */
void pulse_stream_set(bool on);
bool pulse_stream_on(void);

/* Sends the pulse of this cycle, in microseconds, when the stream is on. TaskControl. */
void pulse_stream_take(float pulse_us);

#endif
