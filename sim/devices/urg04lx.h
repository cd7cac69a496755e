/* Model of the Hokuyo URG-04LX: SCIP1.1 and SCIP2.0 over a serial line, a mirror that turns once in 100 ms.
 * Written from the protocol alone; shares no encoder, table or parser with the product. Strict about
 * malformed commands.
 *
 * Where the protocol is silent: an empty line is not answered. L0 is always `0`; a bad rate in S, a bad range
 * in G and anything unknown in SCIP1.1 is `E`. SCIP2.0 refuses, in this order: octets outside 20H..7EH or `$`
 * 0H, one letter 0D, unknown symbol 0E, too few parameter characters 0C, too many 0D, nothing behind `;` 0C,
 * string over 16 characters 0G, its letters 0H, same symbol as the command before while that one is
 * unanswered 0B, time mode 0E. end == start is a scan of one step. Commands wait for the answer of the one
 * before; GD, GS and G are answered at the end of a revolution. A full queue of commands loses the next one;
 * a command is echoed up to 80 characters. A stream's frame that finds the line busy is given up with its
 * revolution. The firmware is 3.1.04: no HS (0C), no DB; the motor has one speed (CR01..CR10 are 04). */
#ifndef SIM_DEVICES_URG04LX_H
#define SIM_DEVICES_URG04LX_H

#include <stdbool.h>

#include "sim/devices/serial.h"
#include "sim/noise.h"

/* The mirror turns past some steps: half a millisecond of them at a time, which is the airframe's step. */
#define URG_RAYS_AT_ONCE 5
typedef struct {
    int first_step, last_step; /* asked for in this revolution */
    int from_step, to_step;    /* whose instant is now; the revolution begins with from_step == first_step */
} urg_rays_t;

/* Distances of the steps from_step..to_step in mm as the sensor would report them (codes below 20 included),
 * taken at the instant of the call. distance_mm[0] is from_step's. Outside 44..725 the sensor itself puts
 * code 19. */
typedef void (*urg_world_t)(void *context, const urg_rays_t *rays, int *distance_mm);

typedef struct urg04lx urg04lx_t;

typedef struct {
    double power_up_rate;   /* bits per second, 115200 on the seed's sensor (factory 19200) */
    sim_time_t boot;        /* power to the first octet that is heard */
    sim_time_t latency;     /* a command's turn (its terminator, or the answer before) to its answer, 8 ms */
    bool answers_in_turn;   /* false: always so. true: as recorded. SCIP1.1, TM, GD and GS so; other commands
                             * once   a revolution, at its end, which is 90 to 115 ms after a command that
                             * follows   an   answer; the first since power-up after 381 ms */
    sim_time_t revolution;  /* 100 ms */
    sim_time_t phase;       /* start of the first revolution after power-up */
    sim_time_t ray_instant; /* of step 389, the middle of 372..406, after the start of a revolution: 34 ms.
                             * The others come as the mirror turns, 97.66 us from step to step */
    sim_time_t late;    /* a stream's frame leaves so long after the end of its revolution, 0. It stands for
                         * a longer answer, whose last octet comes so much later */
    double clock_ratio; /* sensor clock against true time, 1.0 */
    bool rounds_down;   /* steps that fill no cluster make no point; else they make the last one */
} urg04lx_config_t;

extern const urg04lx_config_t urg04lx_default;

/* Several may exist. Starts without power. `sink` receives what the sensor sends. Caller frees with
 * urg04lx_destroy. */
urg04lx_t *urg04lx_create(const urg04lx_config_t *config, urg_world_t world, void *world_context,
                          serial_sink_t sink, void *sink_context);
void urg04lx_destroy(urg04lx_t *urg);
/* Off loses all but the counters; on boots in SCIP1.1. */
void urg04lx_power(urg04lx_t *urg, bool on);
/* Octet from the host, at its stop bit. */
void urg04lx_receive(urg04lx_t *urg, unsigned octet, double bit_ns);

/* Hardware trouble, reported in place of the next scan asked for. 50..97: the measurement ends, the laser
 * goes off; a stream reports it by a frame without data, GD and GS answer it. 21..49, streams only: the
 * sensor stops to verify the error and reports ten revolutions later how that went: by 98, after which it
 * goes on, or by another code of trouble given meanwhile. 98 alone: reported, streams only. */
void urg04lx_trouble(urg04lx_t *urg, unsigned code);

/* For harnesses and tests. */
typedef struct {
    bool powered, scip2, streaming, time_mode, laser_on;
    double rate;
    unsigned scans_sent;          /* MS/MD/GS/GD/G data frames completely handed to the line */
    unsigned revolutions_skipped; /* a stream's frames that found the line busy */
    unsigned octets_mismatched;   /* host octets at another bit rate, ignored */
    unsigned commands, refused;   /* answered; answered with another status than 00 (SCIP1.1: 0) */
} urg04lx_state_t;
urg04lx_state_t urg04lx_state(const urg04lx_t *urg);

#endif
