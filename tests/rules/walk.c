/* A flight whose calls are written down: take-off, hover, landing. walk.py builds it with the compiler's
 * hooks at each entry and exit of a function, and reads a line for each cycle of flight_step():
 *
 *   STATE >ADDRESS >ADDRESS < ...   an entry is told with the function's address */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control/flight.h"
#include "control/thrust.h"
#include "noisy_plant.h"

#define CALLS 8192U
#define EXIT ((uintptr_t)0)

void __cyg_profile_func_enter(void *function, void *site) __attribute__((no_instrument_function));
void __cyg_profile_func_exit(void *function, void *site) __attribute__((no_instrument_function));

static uintptr_t calls[CALLS];
static uint32_t count;
static bool on;

static __attribute__((no_instrument_function)) void note(uintptr_t call)
{
    if (on && count == CALLS) {
        fprintf(stderr, "a cycle has more than %u calls\n", CALLS);
        exit(1);
    }
    if (on) {
        calls[count] = call;
        ++count;
    }
}

void __cyg_profile_func_enter(void *function, void *site)
{
    (void)site;
    note((uintptr_t)function);
}

void __cyg_profile_func_exit(void *function, void *site)
{
    (void)function;
    (void)site;
    note(EXIT);
}

static void write_cycle(flight_state_t state)
{
    printf("%s", flight_state_name(state));
    for (uint32_t i = 0U; i < count; ++i) {
        if (calls[i] == EXIT) {
            printf(" <");
        } else {
            printf(" >%lx", (unsigned long)calls[i]);
        }
    }
    printf("\n");
}

#define PER_S 2000U /* steps of noisy_step() */
#define PERIOD 216U /* the control period, 108 ms */

int main(int argc, char **argv)
{
    noisy_t world = noisy_on_ground(1U);
    flight_t flight;
    parameters_t parameters;
    flight_inputs_t in;
    flight_outputs_t out = FLIGHT_OUTPUTS_INITIAL;

    memset(&in, 0, sizeof in);
    flight_init(&flight);
    parameters_init(&parameters);
    if (argc != 2 || parameters_set(&parameters, PARAMETER_LAW, (float)atoi(argv[1])) != PARAMETER_ACCEPTED) {
        fprintf(stderr, "wanted: the number of a law\n");
        return 2;
    }
    in.attitude_ready = in.has_throttle = true;
    out.releases = flight_releases(&flight, &parameters);
    for (uint32_t i = 0U; i < 16U * PER_S; ++i) {
        if (i == 3U * PER_S || i == 10U * PER_S) {
            in.reference_m = (i == 3U * PER_S) ? 0.6F : 0.0F;
            ++in.reference_sequence;
        }
        noisy_step(&world, &in, 0U);
        if ((world.released && (out.releases & FLIGHT_RELEASE_FRAME) != 0U) ||
            (world.body.height_new && (out.releases & FLIGHT_RELEASE_HEIGHT) != 0U) ||
            (i % PERIOD == 0U && (out.releases & FLIGHT_RELEASE_PERIOD) != 0U)) {
            count = 0U;
            on = true;
            flight_step(&flight, &parameters, &in, &out);
            on = false;
            world.body.command_n = (double)thrust_from_pulse_us(out.pulse_us);
            write_cycle(out.state);
        }
    }
    return 0;
}
