#include "firmware/pulse_stream.h"

#include "drivers/telemetry.h"
#include "firmware/xbee_port.h"

static bool streaming; /* one cell: read and written whole */

void pulse_stream_set(bool on)
{
    streaming = on;
}

bool pulse_stream_on(void)
{
    return streaming;
}

/* In TaskControl, so that there is one line for each pulse. The line is dropped, and nothing waits,
 * when the radio is busy. */
void pulse_stream_take(float pulse_us)
{
    static telemetry_line_t line;

    if (streaming) {
        telemetry_pulse(&line, pulse_us);
        xbee_port_stream(&line);
    }
}
