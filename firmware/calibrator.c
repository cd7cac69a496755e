/* TaskControl preempts TaskReceiveComm and not the other way round: only TaskReceiveComm turns interrupts off for its
 * copies. */
#include "firmware/calibrator.h"

#include <ti/sysbios/family/c28/Hwi.h>
#include <xdc/std.h>

static calibration_request_t request;
static calibration_t calibration;

static uint16_t ask(bool run, uint16_t step_counts, uint16_t period_s)
{
    const calibration_request_t next = {(uint16_t)(request.sequence + 1U), run, step_counts, period_s};
    UInt key = Hwi_disable();

    request = next;
    Hwi_restore(key);
    return next.sequence;
}

uint16_t calibrator_start(uint16_t step_counts, uint16_t period_s)
{
    return ask(true, step_counts, period_s);
}

void calibrator_stop(void)
{
    if (request.run) {
        (void)ask(false, request.step_counts, request.period_s);
    }
}

void calibrator_look(calibration_t *progress)
{
    UInt key = Hwi_disable();

    *progress = calibration;
    Hwi_restore(key);
}

void calibrator_overlay(float link_s, const flight_inputs_t *in, flight_outputs_t *out)
{
    calibration_step(&calibration, &request, link_s, in, out);
}
