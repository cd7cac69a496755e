#include "control/calibration.h"

#include "control/credible.h"
#include "control/thrust.h"
#include "control/where/hover_thrust.h"

#define COUNTS_PER_PERCENT 20.84F  /* 2084 counts from no thrust to full, thrust.h */
#define IDLE_COUNTS 4166U          /* 2 ms, seed eq. 4-5 */
#define LIMIT_N 8.5F               /* 1.5 N above the seed's largest hover thrust */
#define US_PER_S UINT32_C(1000000) /* microseconds */

static float thrust_of(uint16_t compare_counts)
{
    return thrust_from_pulse_us((float)compare_counts * THRUST_STEP_US);
}

static calibration_end_t reason_to_end(float link_s, const flight_inputs_t *in, const flight_outputs_t *out)
{
    const bool low = in->height_valid && in->altitude.height_mm <= LOW_MM;

    if (out->state != FLIGHT_GROUND || out->reference_m > 0.0F) {
        return CALIBRATION_STATE;
    }
    if (!(link_s > 0.0F) || (out->flags & FLIGHT_FLAG_LINK) != 0U) {
        return CALIBRATION_LINK;
    }
    return (low && (out->flags & FLIGHT_FLAG_HEIGHT) == 0U) ? CALIBRATION_RUNNING : CALIBRATION_LIFTED;
}

static void lower(calibration_t *calibration, uint16_t step_counts)
{
    const uint16_t next = (uint16_t)(calibration->compare_counts - step_counts);

    if (thrust_of(next) > LIMIT_N) {
        calibration->end = CALIBRATION_LIMIT;
        return;
    }
    calibration->compare_counts = next;
    calibration->thrust_n = thrust_of(next);
    ++calibration->steps;
}

static void obey(calibration_t *calibration, const calibration_request_t *request)
{
    if (request->sequence == calibration->sequence) {
        return;
    }
    calibration->sequence = request->sequence;
    if (request->run) {
        calibration->end = CALIBRATION_RUNNING;
        calibration->steps = 0U;
        calibration->step_us = 0U;
        calibration->compare_counts = (uint16_t)(IDLE_COUNTS -
                                                 (uint16_t)(request->idle_percent * COUNTS_PER_PERCENT));
        lower(calibration, request->step_counts);
    } else if (calibration->end == CALIBRATION_RUNNING) {
        calibration->end = CALIBRATION_STOPPED;
    }
}

static void advance(calibration_t *calibration, const calibration_request_t *request, uint32_t elapsed_us)
{
    const uint32_t period_us = (uint32_t)request->period_s * US_PER_S;
    const uint32_t most_us = period_us - calibration->step_us;

    if (elapsed_us < most_us) {
        calibration->step_us += elapsed_us;
    } else {
        calibration->step_us = 0U;
        lower(calibration, request->step_counts);
    }
}

void calibration_step(calibration_t *calibration, const calibration_request_t *request, float link_s,
                      const flight_inputs_t *in, flight_outputs_t *out)
{
    const uint32_t elapsed_us = in->now_us - calibration->now_us;
    const bool was_running = calibration->end == CALIBRATION_RUNNING;

    calibration->now_us = in->now_us;
    obey(calibration, request);
    if (calibration->end == CALIBRATION_RUNNING) {
        calibration->end = reason_to_end(link_s, in, out);
    }
    if (calibration->end == CALIBRATION_RUNNING && was_running) {
        advance(calibration, request, elapsed_us);
    }
    if (calibration->end == CALIBRATION_RUNNING) {
        out->thrust_n = calibration->thrust_n;
        out->pulse_us = thrust_to_pulse_us(calibration->thrust_n);
    }
}

float calibration_gravity_n(const parameters_t *parameters, float thrust_n)
{
    const uint16_t law = parameters_choice(parameters, PARAMETER_LAW);

    return (law == LAW_PD || law == LAW_PID) ? thrust_n - HOVER_THRUST_TRIM_N : thrust_n;
}
