#include "sim/board.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "firmware/cpu_time.h"
#include "firmware/fault.h"
#include "sim/costs.h"
#include "sim/devices/rc_mux.h"
#include "sim/devices/xbee.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/driverlib.h"
#include "sim/variables.h"

#define SELECTOR_PIN 3U
#define STICK_PIN 10U
#define BATTERY_CHANNEL 0U
#define BATTERY_OHM 1350.0 /* 13.7 kOhm and 1.5 kOhm of the module: 10.1 to 1 */
#define BATTERY_STEP (20 * SIM_MS)

int firmware_main(void);

/* One UART of the firmware and the real device on it, if any. */
typedef struct {
    uint32_t base;
    void (*out)(void *context, unsigned octet); /* NULL: the model is on the wire */
    void *context;
    serial_t far_end;
} wire_t;

static struct {
    wire_t wires[BOARD_WIRES];
    quadrotor_t *quadrotor;
    scene_t scene;
    line_fault_t *laser_faults;
    urg04lx_t *laser;
    razor9dof_t *imu;
    xbee_t *xbee;
    rc_mux_t mux;
    pilot_t *pilot;
    board_pin_t pin;
    stick_wire_t stick;
    lipo_t battery;
    double hover_n;
    board_terminal_t terminal;
    void *terminal_context;
    const kernel_costs_t *costs;
    sim_time_t pulse;
} board;
static const uint32_t wire_bases[BOARD_WIRES] = {SCIA_BASE, SCIB_BASE, SCIC_BASE};
static board_probes_t probes[BOARD_PROBES];
/* As ccs_project/app.cfg names them. */
static const kernel_hooks_t processor_time = {cpu_time_hwi_begin, cpu_time_hwi_end, cpu_time_swi_begin,
                                              cpu_time_swi_end, cpu_time_task_switch};

board_config_t board_config(unsigned long seed)
{
    board_config_t config = {
        .seed = seed,
        .quadrotor = quadrotor_default,
        .scene = scene_default,
        .laser = urg04lx_default,
        .imu = razor_default,
        .pilot = PILOT_DEFAULT,
        .stick = STICK_WIRE_DEFAULT,
        .battery = LIPO_DEFAULT,
        .costs = &costs_annex_iv,
    };
    noise_t phases;

    noise_init(&phases, seed, "phases");
    config.laser.phase = (sim_time_t)noise_uniform(&phases, 0.0, (double)config.laser.revolution);
    config.imu.phase = config.imu.period + (sim_time_t)noise_uniform(&phases, 0.0, (double)config.imu.period);
    return config;
}

static void deliver(board_wire_t wire, unsigned octet, double bit_ns)
{
    chip_sci_receive(wire_bases[wire], octet, bit_ns);
    for (int i = 0; i < BOARD_PROBES; i++) {
        if (probes[i].octet != NULL) {
            probes[i].octet(wire, octet, bit_ns);
        }
    }
}

static void to_firmware(void *wire, unsigned octet, double bit_ns)
{
    deliver((board_wire_t)(uintptr_t)wire, octet, bit_ns);
}

static void from_firmware(void *context, unsigned octet, double bit_ns)
{
    const wire_t *wire = context;

    if (wire->out != NULL) {
        wire->out(wire->context, octet);
    } else if (wire == &board.wires[BOARD_LASER]) {
        urg04lx_receive(board.laser, octet, bit_ns);
    } else if (wire == &board.wires[BOARD_RADIO]) {
        xbee_from_firmware(board.xbee, octet, bit_ns);
    }
}

static void restart_laser(void *context)
{
    (void)context;
    urg04lx_power(board.laser, false);
    urg04lx_power(board.laser, true);
}

static void trouble_laser(void *context, unsigned code)
{
    (void)context;
    urg04lx_trouble(board.laser, code);
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
    for (int i = 0; i < BOARD_PROBES; i++) {
        if (probes[i].pulse != NULL) {
            probes[i].pulse(high_ns);
        }
    }
}

static void autopilot_pulse(void *context, sim_time_t high_ns)
{
    (void)context;
    quadrotor_pulse(board.quadrotor, high_ns);
}

static razor_truth_t motion(void *context)
{
    const quadrotor_state_t *state = quadrotor_state(board.quadrotor);
    razor_truth_t truth = {state->roll_rad, state->pitch_rad, state->yaw_rad, state->acceleration_mps2,
                           quadrotor_scenario_s(board.quadrotor)};

    (void)context;
    return truth;
}

static pilot_view_t pilots_view(void *context)
{
    const quadrotor_state_t *state = quadrotor_state(board.quadrotor);
    pilot_view_t view = {quadrotor_scenario_s(board.quadrotor), state->height_m, state->speed_mps};

    (void)context;
    return view;
}

static void pilot_takes(void *context, bool take)
{
    (void)context;
    board_select(!take);
}

static void pilot_corners(void *context, bool held)
{
    (void)context;
    quadrotor_hold_corners(board.quadrotor, held);
}

static void pilot_moves(void *context, sim_time_t high_ns)
{
    (void)context;
    board_stick(high_ns);
}

static pilot_t *seat_pilot(const board_config_t *config)
{
    const pilot_hands_t hands = {pilots_view, pilot_takes, pilot_moves, pilot_corners, NULL};

    return pilot_create(&config->pilot, &hands, config->seed);
}

static void lay_wires(void)
{
    chip_usb_connect(NULL, NULL);
    for (int i = 0; i < BOARD_WIRES; i++) {
        board.wires[i].base = wire_bases[i];
        serial_init(&board.wires[i].far_end, 1.0, to_firmware, (void *)(uintptr_t)i);
        chip_sci_connect(wire_bases[i], from_firmware, &board.wires[i]);
    }
}

static void create_laser(const board_config_t *config)
{
    const line_fault_ends_t ends = {to_firmware, (void *)(uintptr_t)BOARD_LASER, restart_laser, trouble_laser,
                                    NULL};

    board.laser_faults = line_fault_create(config->laser_faults, config->laser_fault_count, config->seed,
                                           &ends);
    board.laser = urg04lx_create(&config->laser, scene_scan, &board.scene, line_fault_octet,
                                 board.laser_faults);
}

static void battery_goes_on(void *unused)
{
    const quadrotor_state_t *state = quadrotor_state(board.quadrotor);
    const double terminal_v = lipo_draw(&board.battery, state->thrust_n / board.hover_n,
                                        (double)BATTERY_STEP * 1e-9);

    (void)unused;
    quadrotor_set_volts(board.quadrotor, lipo_share(&board.battery, terminal_v));
    if (board.battery.config.connected >= 0.5) {
        board_battery_pin(
            lround(lipo_pin_v(&board.battery, quadrotor_scenario_s(board.quadrotor), terminal_v) * 1e6));
    }
    timeline_after(BATTERY_STEP, battery_goes_on, NULL);
}

static void connect_battery(const board_config_t *config)
{
    lipo_init(&board.battery, &config->battery, config->seed);
    board.hover_n = config->quadrotor.hover_thrust_n;
    chip_drive_analog(BATTERY_CHANNEL, 0.0, BATTERY_OHM);
    if (config->battery.connected >= 0.5 || config->quadrotor.volts_power > 0.0) {
        battery_goes_on(NULL);
    }
}

/* The world goes on, and so does what is on the wires. */
static void restart(void *unused)
{
    (void)unused;
    chip_restart();
    variables_reset();
    kernel_boot(firmware_main, board.costs);
}

void board_power_on(const board_config_t *config, board_terminal_t terminal, void *terminal_context)
{
    memset(&board, 0, sizeof board);
    board.terminal = terminal;
    board.terminal_context = terminal_context;
    timeline_reset();
    chip_reset(kernel_raise);
    board.quadrotor = quadrotor_create(&config->quadrotor, config->place, config->course, config->seed);
    scene_init(&board.scene, &config->scene, board.quadrotor, config->seed);
    create_laser(config);
    board.imu = razor9dof_create(&config->imu, motion, NULL, config->seed, to_firmware,
                                 (void *)(uintptr_t)BOARD_IMU);
    board.xbee = xbee_create(to_firmware, (void *)(uintptr_t)BOARD_RADIO, to_terminal, NULL);
    rc_mux_init(&board.mux, autopilot_pulse, NULL);
    board.pilot = seat_pilot(config);
    board.pin = BOARD_PIN_HONEST;
    chip_drive_pin(SELECTOR_PIN, true);
    stick_wire_init(&board.stick, &config->stick, config->seed);
    board_stick_pin(config->stick.connected < 0.5);
    connect_battery(config);
    lay_wires();
    chip_pwm_connect(throttle_pulse, NULL);
    urg04lx_power(board.laser, true);
    razor9dof_power(board.imu, true);
    board.costs = config->costs;
    chip_watchdog_connect(restart, NULL);
    variables_reset();
    kernel_set_fault_hook(fault_make_safe);
    kernel_set_hooks(&processor_time);
    kernel_boot(firmware_main, config->costs);
}

void board_power_off(void)
{
    for (int i = 0; i < BOARD_WIRES; i++) {
        serial_flush(&board.wires[i].far_end);
    }
    urg04lx_destroy(board.laser);
    line_fault_destroy(board.laser_faults);
    razor9dof_destroy(board.imu);
    xbee_destroy(board.xbee);
    pilot_destroy(board.pilot);
    quadrotor_destroy(board.quadrotor);
    memset(&board, 0, sizeof board);
}

void board_type(const char *text, size_t count)
{
    if (board.wires[BOARD_RADIO].out != NULL) {
        board_receive(BOARD_RADIO, text, count);
    } else {
        xbee_from_operator(board.xbee, text, count);
    }
}

void board_connect(board_wire_t wire, void (*out)(void *context, unsigned octet), void *context)
{
    board.wires[wire].out = out;
    board.wires[wire].context = context;
    if (wire == BOARD_LASER) {
        urg04lx_power(board.laser, false);
    } else if (wire == BOARD_IMU) {
        razor9dof_power(board.imu, false);
    }
}

void board_connect_usb(void (*out)(void *context, unsigned octet, double bit_ns), void *context)
{
    chip_usb_connect(out, context);
}

void board_receive_at(board_wire_t wire, double rate, const void *octets, size_t count)
{
    serial_set_rate(&board.wires[wire].far_end, rate);
    serial_send(&board.wires[wire].far_end, octets, count);
}

void board_receive(board_wire_t wire, const void *octets, size_t count)
{
    double rate = board_rate(wire);

    if (rate > 0.0) {
        board_receive_at(wire, rate, octets, count);
    }
}

double board_rate(board_wire_t wire)
{
    return chip_sci_rate(board.wires[wire].base);
}

void board_octet(board_wire_t wire, unsigned octet, double bit_ns)
{
    deliver(wire, octet, bit_ns);
}

void board_probe(board_probe_t which, const board_probes_t *wanted)
{
    probes[which] = wanted != NULL ? *wanted : (board_probes_t){.pulse = NULL};
}

void board_power_laser(bool on)
{
    urg04lx_power(board.laser, on);
}

void board_power_imu(bool on)
{
    razor9dof_power(board.imu, on);
}

void board_trouble_laser(unsigned code)
{
    urg04lx_trouble(board.laser, code);
}

quadrotor_t *board_quadrotor(void)
{
    return board.quadrotor;
}

const urg04lx_t *board_laser(void)
{
    return board.laser;
}

line_fault_t *board_laser_faults(void)
{
    return board.laser_faults;
}

double board_seen_m(void)
{
    return scene_height_m(&board.scene);
}

bool board_selected(void)
{
    return board.mux.firmware_selected;
}

void board_change(const board_config_t *config)
{
    quadrotor_change(board.quadrotor, &config->quadrotor);
    board.hover_n = config->quadrotor.hover_thrust_n;
    board.scene.config = config->scene;
    razor9dof_change(board.imu, &config->imu);
}

void board_radio_reach(bool in_reach)
{
    xbee_reach(board.xbee, in_reach);
}

static void drive_selector(void)
{
    const bool level = board.pin == BOARD_PIN_HONEST ? board.mux.firmware_selected
                                                     : board.pin == BOARD_PIN_FIRMWARE;

    chip_drive_pin(SELECTOR_PIN, level);
    for (int i = 0; i < BOARD_PROBES; i++) {
        if (probes[i].selector != NULL) {
            probes[i].selector(level);
        }
    }
}

void board_select(bool firmware)
{
    rc_mux_select(&board.mux, firmware);
    quadrotor_set_manual(board.quadrotor, !firmware);
    drive_selector();
}

void board_pin(board_pin_t tells)
{
    board.pin = tells;
    drive_selector();
}

void board_stick_pin(bool high)
{
    chip_drive_pin(STICK_PIN, high);
    for (int i = 0; i < BOARD_PROBES; i++) {
        if (probes[i].stick != NULL) {
            probes[i].stick(high);
        }
    }
}

void board_battery_pin(long microvolts)
{
    chip_drive_analog(BATTERY_CHANNEL, (double)microvolts * 1e-6, BATTERY_OHM);
    for (int i = 0; i < BOARD_PROBES; i++) {
        if (probes[i].battery != NULL) {
            probes[i].battery(microvolts);
        }
    }
}

bool board_stick_level(void)
{
    return chip_pin(STICK_PIN);
}

static void stick_falls(void *unused)
{
    (void)unused;
    board_stick_pin(false);
}

void board_stick(sim_time_t high_ns)
{
    const sim_time_t told_ns = stick_wire_pulse(&board.stick, quadrotor_scenario_s(board.quadrotor), high_ns);

    rc_mux_receiver_pulse(&board.mux, high_ns);
    if (told_ns > 0) {
        board_stick_pin(true);
        timeline_after(told_ns, stick_falls, NULL);
    }
}

double board_pulse_us(void)
{
    return (double)board.pulse / 1000.0;
}
