#include "firmware/ground.h"

#include "firmware/servers.h"

bool ground_idle(void)
{
    reference_sample_t reference;
    flight_outputs_t flight;

    reference_server_read(&reference);
    flight_status_server_read(&flight);
    return flight.state == FLIGHT_GROUND && flight.thrust_n <= 0.0F && flight.reference_m <= 0.0F
           && reference.reference_m <= 0.0F;
}
