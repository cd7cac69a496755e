#include "sim/firmware_view.h"

#include "bsp/timebase.h"
#include "firmware/probe.h"

firmware_view_t firmware_view(void)
{
    return (firmware_view_t){*probe_altitude,
                             *probe_imu,
                             *probe_flight,
                             probe_laser->seen.scan_count,
                             probe_laser->seen.damage_count,
                             bsp_time_us()};
}

uint32_t firmware_view_heights(void)
{
    return probe_altitude->sequence;
}

uint16_t firmware_view_releases(void)
{
    return probe_flight->releases;
}
