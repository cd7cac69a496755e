/* TaskControl preempts TaskReceiveComm and not the other way round: only TaskReceiveComm turns interrupts off
 * for its copies. */
#include "firmware/calibrator.h"

#include <ti/sysbios/family/c28/Hwi.h>
#include <xdc/std.h>

static calibration_request_t request;
static calibration_t calibration;

/* The number tells TaskControl that the request is another one, also where its values are the same. */
static uint16_t ask(calibration_request_t next)
{
    UInt key = Hwi_disable();

    next.sequence = (uint16_t)(request.sequence + 1U);
    request = next;
    Hwi_restore(key);
    return next.sequence;
}

uint16_t calibrator_start(float idle_percent, uint16_t step_counts, uint16_t period_s)
{
    return ask((calibration_request_t){
        .run = true, .idle_percent = idle_percent, .step_counts = step_counts, .period_s = period_s});
}

/* Called for every line: without the question each line would be a new request. */
void calibrator_stop(void)
{
    if (request.run) {
        (void)ask((calibration_request_t){
            .run = false, .step_counts = request.step_counts, .period_s = request.period_s});
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
