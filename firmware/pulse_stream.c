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

void pulse_stream_take(float pulse_us)
{
    static telemetry_line_t line;

    if (streaming) {
        telemetry_pulse(&line, pulse_us);
        xbee_port_stream(&line);
    }
}
