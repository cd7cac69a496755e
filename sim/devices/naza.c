#include "sim/devices/naza.h"

#include <math.h>

#define LOW 0.10
#define START_S 3.0
#define RESTART_S 5.0
#define LANDED_S 3.0
#define TURNED_OVER_RAD (70.0 * M_PI / 180.0)
#define FAILSAFE_S 0.1
#define FAILSAFE_HOLD_S 3.0      /* assumed */
#define FAILSAFE_SINK_MPS (-0.5) /* assumed */

void naza_init(naza_t *naza, const naza_config_t *config)
{
    *naza = (naza_t){.config = *config, .running = config->stop_type < 0.0};
}

static void stop(naza_t *naza, bool by_throttle)
{
    naza->running = false;
    naza->stopped_by_throttle = by_throttle;
    naza->stopped_s = 0.0;
}

static void start(naza_t *naza)
{
    naza->running = true;
    naza->opened = false;
    naza->started_s = 0.0;
    naza->closed_s = 0.0;
}

static void obey_sticks(naza_t *naza, const naza_inputs_t *in)
{
    const bool command = in->corners && in->throttle < LOW;

    if (command && !naza->held) {
        if (naza->running) {
            stop(naza, false);
        } else {
            start(naza);
        }
    }
    naza->held = command;
}

/* With the throttle under 10 %. */
static void close(naza_t *naza, const naza_inputs_t *in, double dt_s)
{
    const bool landed = naza->closed_s >= LANDED_S && in->on_ground;

    naza->closed_s += dt_s;
    if (!naza->opened) {
        if (naza->started_s >= START_S) {
            stop(naza, false);
        }
    } else if (naza->config.stop_type == NAZA_IMMEDIATELY) {
        stop(naza, true);
    } else if (!in->manual && landed) {
        stop(naza, false);
    }
}

static void run(naza_t *naza, const naza_inputs_t *in, double dt_s)
{
    naza->started_s += dt_s;
    if (in->throttle >= LOW) {
        naza->opened = true;
        naza->closed_s = 0.0;
    } else if (in->pulses) {
        close(naza, in, dt_s);
    }
    if (naza->running && naza->config.stop_type == NAZA_INTELLIGENT && !in->manual &&
        in->tilt_rad > TURNED_OVER_RAD) {
        stop(naza, false);
    }
}

static void rest(naza_t *naza, const naza_inputs_t *in, double dt_s)
{
    naza->stopped_s += dt_s;
    if (naza->stopped_by_throttle && in->throttle >= LOW && naza->stopped_s <= RESTART_S) {
        start(naza);
        naza->opened = true;
    }
}

void naza_step(naza_t *naza, const naza_inputs_t *in, double dt_s)
{
    if (naza->config.stop_type < 0.0) {
        return;
    }
    naza->silent_s = in->pulses ? 0.0 : naza->silent_s + dt_s;
    obey_sticks(naza, in);
    if (naza->running) {
        run(naza, in, dt_s);
    } else {
        rest(naza, in, dt_s);
    }
}

bool naza_is_manual(const naza_t *naza, bool manual)
{
    return naza->config.stop_type >= 0.0 && manual;
}

bool naza_failsafe(const naza_t *naza, double *climb_mps)
{
    *climb_mps = naza->silent_s > FAILSAFE_HOLD_S ? FAILSAFE_SINK_MPS : 0.0;
    return naza->config.stop_type >= 0.0 && naza->silent_s > FAILSAFE_S;
}
