#include "control/outputs.h"

#include <math.h>

#include "control/thrust.h"

static uint16_t flags(const situation_t *now, bool out_of_reach)
{
    const bool wants_imu = parameters_choice(now->parameters, PARAMETER_LAW) == LAW_EST;
    const bool imu_missing = wants_imu && !est_law_has_imu(now->est);
    const bool without_acceleration = wants_imu && !imu_missing && !est_law_has_acceleration(now->est);

    return (uint16_t)(now->where->supervisor.flags | (imu_missing ? FLIGHT_FLAG_ATTITUDE : 0U) |
                      (out_of_reach ? FLIGHT_FLAG_REACH : 0U) |
                      (without_acceleration ? FLIGHT_FLAG_IMU : 0U) |
                      now->evidence->doubts * FLIGHT_FLAG_SIGHT);
}

void outputs_write(const situation_t *now, bool out_of_reach, float thrust_n, flight_outputs_t *out)
{
    const supervisor_t *supervisor = &now->where->supervisor;
    const estimator_t *estimator = &now->est->estimator;
    const bool estimated = now->law == LAW_EST || modes_use_estimate(now->mode);
    const float measured_mm = (supervisor->height.sequence != 0U) ? supervisor->height.height_mm : NAN;

    out->idle_n = now->idle_n;
    out->hover_n = now->where->hover.thrust_n;
    out->state = supervisor->state;
    out->flags = flags(now, out_of_reach);
    out->reason = now->evidence->reason;
    out->stands_high = supervisor->ground.stands_high;
    out->reference_m = supervisor->reference_m;
    out->estimate_mm = estimated ? estimator->now.height_m * 1000.0F : measured_mm;
    out->innovation_mm = estimated ? estimator->innovation_m * 1000.0F : NAN;
    out->thrust_n = thrust_n;
    out->pulse_us = thrust_to_pulse_us(thrust_n);
}
