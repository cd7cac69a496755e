/* What the firmware holds at this instant of virtual time. The one place in sim/ that reads the firmware's
 * probe (firmware/probe.h): the log, the metrics and the latency figures come here. */
#ifndef SIM_FIRMWARE_VIEW_H
#define SIM_FIRMWARE_VIEW_H

#include <stdint.h>

#include "control/flight_io.h"
#include "control/imu_sample.h"
#include "firmware/servers.h"

typedef struct {
    altitude_sample_t altitude;
    imu_sample_t imu;
    flight_outputs_t flight;
    uint32_t scans, damages; /* since power-up */
    uint32_t now_us;         /* the firmware's clock, the one of the arrivals */
} firmware_view_t;

firmware_view_t firmware_view(void);

uint32_t firmware_view_heights(void);  /* so far */
uint16_t firmware_view_releases(void); /* FLIGHT_RELEASE_*: what TaskControl waits for */

#endif
