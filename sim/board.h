/* The PC board: the chip, the kernel and every device wired together as on the vehicle, with the unmodified firmware
 * running on it. One board per process at a time. */
#ifndef SIM_BOARD_H
#define SIM_BOARD_H

#include <stddef.h>

#include "sim/devices/quadrotor.h"
#include "sim/devices/razor9dof.h"
#include "sim/devices/scene.h"
#include "sim/devices/urg04lx.h"
#include "sim/ti/sysbios/kernel.h"

typedef struct {
    unsigned long seed;
    quadrotor_config_t quadrotor;
    terrain_t terrain;
    scene_config_t scene;
    urg04lx_config_t laser;
    razor_config_t imu;
    const kernel_costs_t *costs;
} board_config_t;

/* The vehicle of the plant description; phases of scanner and IMU drawn from the seed. */
board_config_t board_config(unsigned long seed);

/* Octets that the firmware's radio puts out, after the radio link, as the operator's terminal receives them. */
typedef void (*board_terminal_t)(void *context, unsigned octet);

/* Power on and boot the firmware up to BIOS_start(). */
void board_power_on(const board_config_t *config, board_terminal_t terminal, void *terminal_context);
void board_power_off(void);

/* The operator's terminal sends; octets go through the radio pair. */
void board_type(const char *text, size_t count);

/* With a real radio module instead of the pair: octets to and from its UART. */
void board_radio_connect(void (*out)(void *context, unsigned octet), void *context);
void board_radio_receive(unsigned octet);

quadrotor_t *board_quadrotor(void);
const urg04lx_t *board_laser(void);
double board_pulse_us(void);    /* latest throttle pulse, 0 before the first */

#endif
