/* The PC board: the chip, the kernel and every device wired together as on the vehicle, with the unmodified
 * firmware running on it. One board per process at a time. */
#ifndef SIM_BOARD_H
#define SIM_BOARD_H

#include <stdbool.h>
#include <stddef.h>

#include "sim/devices/lipo.h"
#include "sim/devices/line_fault.h"
#include "sim/devices/pilot.h"
#include "sim/devices/quadrotor.h"
#include "sim/devices/razor9dof.h"
#include "sim/devices/scene.h"
#include "sim/devices/stick_wire.h"
#include "sim/devices/urg04lx.h"
#include "sim/ti/sysbios/kernel.h"

typedef struct {
    unsigned long seed;
    quadrotor_config_t quadrotor;
    const place_t *place;   /* NULL: an endless even floor. Borrowed until power-off */
    const course_t *course; /* NULL: nobody steers */
    scene_config_t scene;
    urg04lx_config_t laser;
    const line_fault_spec_t *laser_faults; /* between the scanner model and the firmware */
    int laser_fault_count;
    razor_config_t imu;
    pilot_config_t pilot;
    stick_wire_config_t stick;
    lipo_config_t battery;
    const kernel_costs_t *costs;
} board_config_t;

/* The vehicle of the plant description; phases of scanner and IMU drawn from the seed. */
board_config_t board_config(unsigned long seed);

/* Octets that the firmware's radio puts out, after the radio link, as the operator's terminal receives them.
 */
typedef void (*board_terminal_t)(void *context, unsigned octet);

/* Power on and boot the firmware up to BIOS_start(). */
void board_power_on(const board_config_t *config, board_terminal_t terminal, void *terminal_context);
void board_power_off(void);

/* The operator's terminal sends; octets go through the radio pair. With a real radio they join those that it
 * sends. */
void board_type(const char *text, size_t count);

/* The firmware's three UARTs. */
typedef enum { BOARD_LASER, BOARD_IMU, BOARD_RADIO, BOARD_WIRES } board_wire_t;

/* A real device in place of the model on that wire, which is switched off. `out` gets each octet that the
 * firmware sends there, at the end of its stop bit. Between board_power_on() and the first run. */
void board_connect(board_wire_t wire, void (*out)(void *context, unsigned octet), void *context);
/* Somebody listens at the LaunchPad's USB serial port: `out` gets each octet that the firmware sends there.
 * After board_power_on(). */
void board_connect_usb(void (*out)(void *context, unsigned octet, double bit_ns), void *context);
/* The real device has sent: the octets arrive one after the other at the UART's present rate. */
void board_receive(board_wire_t wire, const void *octets, size_t count);
/* The same at the far end's own rate, bits per second: where the two differ by more than the UART bears, it
 * hears nonsense. */
void board_receive_at(board_wire_t wire, double rate, const void *octets, size_t count);
/* Bits per second that the firmware has set for its UART, 0 while it is closed. */
double board_rate(board_wire_t wire);

/* One octet straight onto the firmware's receive pin, its stop bit ending now. For a recording that is played
 * again. */
void board_octet(board_wire_t wire, unsigned octet, double bit_ns);

/* Probes: an octet for one of the firmware's UARTs has come, at its stop bit; the selector's or the stick's
 * pin has got a level, or the battery's another voltage; a throttle pulse has ended. NULL: none. They stay
 * through board_power_on() and _off().
 */
typedef struct {
    void (*octet)(board_wire_t wire, unsigned octet, double bit_ns);
    void (*selector)(bool firmware);
    void (*stick)(bool high);
    void (*battery)(long microvolts);
    void (*pulse)(sim_time_t high_ns);
} board_probes_t;
/* Two at most: the timing's and the recording's. */
typedef enum { BOARD_PROBE_TIMING, BOARD_PROBE_TAPE, BOARD_PROBES } board_probe_t;
void board_probe(board_probe_t which, const board_probes_t *probes);

/* The pilot's switch: whose throttle the multiplexer lets through, and the level on the firmware's selector
 * pin. After power-on it is the firmware's. */
void board_select(bool firmware);
/* What the pin tells: the switch, or always the same, as a broken wire or another threshold does. */
typedef enum { BOARD_PIN_PILOT, BOARD_PIN_FIRMWARE, BOARD_PIN_HONEST } board_pin_t;
void board_pin(board_pin_t tells);
/* A pulse of the receiver's throttle channel; reaches the autopilot while the pilot has the throttle, and the
 * firmware's pin by the wire, if it is connected. */
void board_stick(sim_time_t high_ns);
/* Level straight onto that pin, for a recording that is played again. */
void board_stick_pin(bool high);
bool board_stick_level(void); /* high too while nothing is connected */
/* Voltage on the battery's pin. While a battery is connected the board sets it by itself, every 20 ms. */
void board_battery_pin(long microvolts);

bool board_selected(void); /* the firmware has the throttle */

/* While it is on, vehicle, what the rays meet and the IMU's errors become those of config. The place and the
 * course stay, and whoever lent them may change what is in them. The scanner itself, the pilot, phases and
 * seeds are those of power-on. */
void board_change(const board_config_t *config);

/* The radio pair in or out of each other's reach: what is on air out of it is lost. */
void board_radio_reach(bool in_reach);

/* Somebody pulls a plug or puts it back, or the scanner has trouble of its own (urg04lx_trouble()). */
void board_power_laser(bool on);
void board_power_imu(bool on);
void board_trouble_laser(unsigned code);

quadrotor_t *board_quadrotor(void);
const urg04lx_t *board_laser(void);
line_fault_t *board_laser_faults(void);
double board_seen_m(void);   /* true height above what the scanner's beam sees */
double board_pulse_us(void); /* latest throttle pulse, 0 before the first */

#endif
