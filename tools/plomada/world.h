/* The world of a real board: scanner, IMU and airframe as models, the operator's terminal, each behind a
 * serial adapter of the PC, in real time. The throttle pulse comes back as lines of `#STREAM PULSE`, or as a
 * logic analyser sees it on the pin. One per process. */
#ifndef TOOLS_PLOMADA_WORLD_H
#define TOOLS_PLOMADA_WORLD_H

#include <stdbool.h>
#include <stddef.h>

#include "sim/board.h"

typedef struct {
    const char *device[BOARD_WIRES]; /* serial ports */
    unsigned long seed;
    const place_t *place; /* NULL: an endless even floor; both borrowed */
    const course_t *course;
    quadrotor_config_t quadrotor;
    const char *pulses; /* what the analyser records, by sigrok-cli -O csv: a FIFO or a growing file. NULL:
                           the pulse is what the board tells */
    void (*line)(const char *text); /* each line that the board sends, without its end; never a pulse's */
} world_config_t;

/* NULL when all three ports are open (then world_close()), else what failed, on wire *failed. Scanner and IMU
 * have power. SIGINT and SIGTERM end every wait below. */
const char *world_open(const world_config_t *config, board_wire_t *failed);
void world_close(void);

/* Lives until that virtual time. False when interrupted. */
bool world_run_until(sim_time_t end);

/* The operator sends a line, its end added. */
void world_type(const char *line);

/* False, and why on stderr, when config->pulses cannot be read. After world_open(). */
bool world_watch_pin(void);
/* Pulses on the pin that no throttle channel has (0.9 to 2.1 ms), lines that are none of sigrok-cli's. */
unsigned long world_strange_pulses(void);
/* No pulse on the pin for half a second, though it is watched. */
bool world_pin_still(void);

/* The newest pulse, microseconds, 0: none yet; and when its line was complete. */
double world_pulse_us(sim_time_t *when);
/* No pulse was told for half a second in which this PC kept up with the wall clock. */
bool world_silent(void);
/* The longest time that this PC was behind the wall clock since world_delay_reset(): beyond WORLD_LAG_MAX
 * what was flown was not flown in real time. */
sim_time_t world_worst_lag(void);
#define WORLD_LAG_MAX (150 * SIM_MS)

/* What the wires looked like from here. */
typedef struct {
    bool lost; /* the port is gone */
    sim_time_t lost_at;
    unsigned long octets_in, octets_out;
    unsigned long refused; /* octets that the port did not take: it is too slow, or nobody is behind it */
    unsigned long strange; /* lines or octets from the board that mean nothing */
} world_wire_t;
world_wire_t world_wire(board_wire_t wire);

/* From the last octet of a scan on the wire to the line of the pulse that follows from it, ms, over the run:
 * median and 95 %; false when there were fewer than five. */
bool world_delay_ms(double *median, double *most);
void world_delay_reset(void);

/* The vehicle is tied down: no pulse reaches it. */
void world_hold(bool on);

quadrotor_t *world_quadrotor(void);
urg04lx_t *world_laser(void);
razor9dof_t *world_imu(void);
/* Octets from the scanner or IMU are held back (nothing on that wire), or every so many-th is damaged; 0:
 * none. */
void world_mute(board_wire_t wire, bool on);
void world_damage(board_wire_t wire, unsigned one_in);

#endif
