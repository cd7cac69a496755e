#include "firmware/ground.h"

#include "firmware/servers.h"

/* Both references: the server's may be an order that TaskControl has not seen yet, the other one is
 * what it obeys. */
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

/* A vehicle that has turned over is not in state GROUND either, and nothing holds it up. */
bool ground_left(void)
{
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    return flight.state != FLIGHT_GROUND && flight.state != FLIGHT_CUT;
}
