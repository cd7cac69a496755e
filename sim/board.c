#include "sim/board.h"

#include <stdint.h>
#include <string.h>

#include "sim/costs.h"
#include "sim/devices/rc_mux.h"
#include "sim/devices/xbee.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/driverlib.h"

int firmware_main(void);

static struct {
    quadrotor_t *quadrotor;
    scene_t scene;
    urg04lx_t *laser;
    razor9dof_t *imu;
    xbee_t *xbee;
    rc_mux_t mux;
    board_terminal_t terminal;
    void *terminal_context;
    void (*radio_out)(void *context, unsigned octet);
    void *radio_context;
    sim_time_t pulse;
} board;

board_config_t board_config(unsigned long seed)
{
    board_config_t config = {
        .seed = seed,
        .quadrotor = quadrotor_default,
        .terrain = terrain_flat,
        .scene = scene_default,
        .laser = urg04lx_default,
        .imu = razor_default,
        .costs = &costs_annex_iv,
    };
    noise_t phases;

    noise_init(&phases, seed, "phases");
    config.laser.phase = (sim_time_t)noise_uniform(&phases, 0.0, (double)config.laser.revolution);
    config.imu.phase = config.imu.period + (sim_time_t)noise_uniform(&phases, 0.0, (double)config.imu.period);
    return config;
}

static void to_firmware(void *base, unsigned octet, double bit_ns)
{
    chip_sci_receive((uint32_t)(uintptr_t)base, octet, bit_ns);
}

static void to_laser(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    urg04lx_receive(board.laser, octet, bit_ns);
}

static void to_radio(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    if (board.radio_out != NULL) {
        board.radio_out(board.radio_context, octet);
    } else {
        xbee_from_firmware(board.xbee, octet, bit_ns);
    }
}

static void to_terminal(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    (void)bit_ns;
    if (board.terminal != NULL) {
        board.terminal(board.terminal_context, octet);
    }
}

static void throttle_pulse(void *context, sim_time_t high_ns)
{
    (void)context;
    board.pulse = high_ns;
    rc_mux_firmware_pulse(&board.mux, high_ns);
}

static void autopilot_pulse(void *context, sim_time_t high_ns)
{
    (void)context;
    quadrotor_pulse(board.quadrotor, high_ns);
}

static razor_truth_t motion(void *context)
{
    const quadrotor_state_t *state = quadrotor_state(board.quadrotor);
    razor_truth_t truth = {state->roll_rad, state->pitch_rad, state->yaw_rad, state->acceleration_mps2};

    (void)context;
    return truth;
}

void board_power_on(const board_config_t *config, board_terminal_t terminal, void *terminal_context)
{
    memset(&board, 0, sizeof board);
    board.terminal = terminal;
    board.terminal_context = terminal_context;
    timeline_reset();
    chip_reset(kernel_raise);
    board.quadrotor = quadrotor_create(&config->quadrotor, &config->terrain, config->seed);
    scene_init(&board.scene, &config->scene, board.quadrotor, config->seed);
    board.laser = urg04lx_create(&config->laser, scene_scan, &board.scene, to_firmware, (void *)(uintptr_t)SCIA_BASE);
    board.imu = razor9dof_create(&config->imu, motion, NULL, config->seed, to_firmware, (void *)(uintptr_t)SCIB_BASE);
    board.xbee = xbee_create(to_firmware, (void *)(uintptr_t)SCIC_BASE, to_terminal, NULL);
    rc_mux_init(&board.mux, autopilot_pulse, NULL);
    chip_sci_connect(SCIA_BASE, to_laser, NULL);
    chip_sci_connect(SCIC_BASE, to_radio, NULL);
    chip_pwm_connect(throttle_pulse, NULL);
    urg04lx_power(board.laser, true);
    razor9dof_power(board.imu, true);
    kernel_boot(firmware_main, config->costs);
}

void board_power_off(void)
{
    urg04lx_destroy(board.laser);
    razor9dof_destroy(board.imu);
    xbee_destroy(board.xbee);
    quadrotor_destroy(board.quadrotor);
    memset(&board, 0, sizeof board);
}

void board_type(const char *text, size_t count)
{
    xbee_from_operator(board.xbee, text, count);
}

void board_radio_connect(void (*out)(void *context, unsigned octet), void *context)
{
    board.radio_out = out;
    board.radio_context = context;
}

void board_radio_receive(unsigned octet)
{
    chip_sci_receive(SCIC_BASE, octet, 1e9 / 9600.0);
}

quadrotor_t *board_quadrotor(void)
{
    return board.quadrotor;
}

const urg04lx_t *board_laser(void)
{
    return board.laser;
}

double board_pulse_us(void)
{
    return (double)board.pulse / 1000.0;
}
