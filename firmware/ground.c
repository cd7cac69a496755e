#include "firmware/ground.h"

#include "firmware/servers.h"

static bool waits(const flight_outputs_t *flight)
{
    reference_sample_t reference;

    reference_server_read(&reference);
    return flight->state == FLIGHT_GROUND && flight->reference_m <= 0.0F && reference.reference_m <= 0.0F;
}

bool ground_idle(void)
{
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    return waits(&flight) && flight.thrust_n <= 0.0F;
}

bool ground_waits(void)
{
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    return waits(&flight) && flight.thrust_n <= flight.idle_n;
}

bool ground_left(void)
{
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    return flight.state != FLIGHT_GROUND && flight.state != FLIGHT_CUT;
}
