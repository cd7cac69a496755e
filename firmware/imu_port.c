#include "firmware/imu_port.h"

#include <stddef.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <xdc/std.h>

#include "firmware/cpu_time.h"
#include "firmware/monitor.h"
#include "firmware/schedule.h"
#include "bsp/timebase.h"
#include "firmware/uart_port.h"

#define IMU_BIT_RATE 57600UL

static razor_collector_t collector; /* receive Hwi only */
static imu_message_t fresh;         /* written by the receive Hwi, read by IMU_SWI at once */
static imu_message_t mailbox;       /* written by IMU_SWI, read by TaskIMU with Swis off */
static Swi_Handle imu_swi;
static Semaphore_Handle imu_ready;

/* A frame has no sum of its own: with an error, whichever octet it hit, nothing of the burst is believed. */
static uint16_t received(const bsp_uart_burst_t *burst)
{

    if (burst->framing || burst->overrun) {
        razor_collector_broken(&collector);
        return UART_PORT_BURST;
    }
    for (uint16_t i = 0U; i < burst->count; ++i) {
        if (razor_collect(&collector, octet_of(burst->octets[i]))) {
            fresh.text = collector.gathered;
            fresh.arrival_us = bsp_time_us();
            /* At the frame's last octet, so that the response of TaskIMU has all waits in it. */
            monitor_released(MONITOR_IMU, fresh.arrival_us);
            Swi_post(imu_swi);
        }
    }
    return UART_PORT_BURST;
}

static Void imu_swi_run(UArg unused0, UArg unused1)
{
    (void)unused0;
    (void)unused1;
    mailbox = fresh;
    Semaphore_post(imu_ready);
}

void imu_port_create(void)
{
    Swi_Params swi;
    Semaphore_Params semaphore;

    razor_collector_init(&collector);
    Semaphore_Params_init(&semaphore);
    semaphore.mode = Semaphore_Mode_BINARY;
    imu_ready = Semaphore_create(0, &semaphore, NULL);
    Swi_Params_init(&swi);
    swi.instance->name = "IMU_SWI";
    swi.priority = IMU_SWI_PRIORITY;
    imu_swi = Swi_create(imu_swi_run, &swi, NULL);
    cpu_time_watch(CPU_TIME_IMU_SWI, imu_swi);
    uart_port_create(BSP_UART_IMU, IMU_BIT_RATE, received);
    /* Continuous output. The stock firmware streams by itself; one that was switched off over its own
     * line would stay silent for ever. */
    (void)uart_port_send(BSP_UART_IMU, "#o1", 3U);
}

void imu_port_wait(imu_message_t *message)
{

    (void)Semaphore_pend(imu_ready, BIOS_WAIT_FOREVER);
    const UInt key = Swi_disable();
    *message = mailbox;
    Swi_restore(key);
}
