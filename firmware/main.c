#include <ti/sysbios/BIOS.h>
#include <xdc/std.h>

#include "bsp/board.h"
#include "firmware/boot.h"
#include "firmware/geometry.h"
#include "firmware/mounting.h"
#include "firmware/parameter_store.h"
#include "firmware/servers.h"
#include "firmware/tasks.h"
#include "firmware/uart_port.h"
#include "firmware/verbs.h"
#include "bsp/watchdog.h"

int main(void);

/* After a watchdog reset the scanner has power and streams: there is nothing to wait for, and perhaps
 * a vehicle in the air. */
static void laser_config(urg_config_t *config)
{
    const uint32_t stored = parameter_store_laser_rate();
    geometry_t geometry;

    config->wait_us = boot_is_restart() ? 0U : LASER_WAIT_US;
    config->first_rate_known = stored > 0U && stored <= LASER_STREAM_RATE;
    config->first_rate = config->first_rate_known ? stored : LASER_FIRST_RATE;
    config->fastest_rate = LASER_STREAM_RATE;
    config->stream_rate = LASER_STREAM_RATE;
    config->stream = SCIP_STREAM_2;
    geometry_mounted(&geometry);
    config->range = scip_layout_range(&geometry.layout, LASER_STREAM_RATE);
}

int main(void)
{
    static urg_config_t config;

    bsp_board_init();
    boot_init();
    servers_create();
    laser_config(&config);
    task_imu_create();
    task_receive_laser_create(&config);
    task_control_create();
    task_send_laser_create();
    task_send_comm_create();
    task_receive_comm_create();
    /* Behind all ports: the tick looks at each of them. Octets that come before BIOS_start() wait in
     * the FIFOs. */
    uart_port_start();
    /* It answers by the radio, so the port must be there; and the parameters must be in force before
     * the first control cycle. */
    verb_load_at_start();
    bsp_watchdog_start();
    BIOS_start();
    return 0;
}
