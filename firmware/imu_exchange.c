/* TaskIMU preempts TaskReceiveComm and not the other way round: only TaskReceiveComm turns interrupts off for
 * its copies. */
#include "firmware/imu_exchange.h"

#include <stdbool.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <xdc/std.h>

static imu_mapping_t mounted;
static imu_view_t shown;
static uint32_t shown_us;

void imu_exchange_mount(const parameters_t *parameters)
{
    const imu_mapping_t mapping = imu_mapping_of(parameters);
    UInt key = Hwi_disable();

    mounted = mapping;
    Hwi_restore(key);
}

void imu_exchange_mounted(imu_mapping_t *mapping)
{
    *mapping = mounted;
}

/* A frame that could not be read is shown as well: its text tells what the sensor sends instead. Its
 * values are those of the frame before. */
void imu_exchange_show(const razor_text_t *text, razor_status_t status, const imu_raw_t *raw,
                       uint32_t arrival_us)
{
    shown.text = *text;
    shown.status = status;
    if (status == RAZOR_OK) {
        shown.raw = *raw;
        ++shown.frames;
        shown.period_us = arrival_us - shown_us;
        shown_us = arrival_us;
    }
}

void imu_exchange_look(imu_view_t *view)
{
    UInt key = Hwi_disable();

    *view = shown;
    Hwi_restore(key);
}
