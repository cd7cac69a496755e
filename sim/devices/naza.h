/* The autopilot's own rules for motors and modes (DJI NAZA-M: user manuals of 2012 and 2013, assistant's help
 * text):
 *
 * - no throttle starts motors: a combination stick command does (both sticks in the lower corners, throttle
 * under 10 %); it also stops them;
 * - after a start the throttle must go over 10 % within 3 s, or they stop;
 * - Stop Type *Immediately*: under 10 %, after it was over it, they stop at once, in any mode, in the air
 * too; over 10 % again within 5 s they run again, later not;
 * - Stop Type *Intelligent*: *Manual*: the throttle never stops them; *Attitude*: 3 s under 10 % on the
 * ground, or a tilt of more than 70 degrees, does;
 * - *Manual*: the throttle is thrust. *Attitude*: thrust or a climb rate (which of the two is told by
 * quadrotor.h);
 * - without a receiver's pulses (failsafe): the height is held, then it lands, whatever the throttle. */
#ifndef SIM_DEVICES_NAZA_H
#define SIM_DEVICES_NAZA_H

#include <stdbool.h>

#define NAZA_IMMEDIATELY 0.0
#define NAZA_INTELLIGENT 1.0
#define NAZA_ALWAYS_ARMED (-1.0) /* none of these rules: the motors always run, and the mode is Attitude */

typedef struct {
    double stop_type; /* one of the above */
} naza_config_t;

typedef struct {
    double throttle; /* share of the stick, 0..1; without pulses 0 */
    bool pulses;     /* the receiver is heard */
    bool corners;    /* both sticks are held in the lower corners */
    bool manual;     /* the mode switch */
    bool on_ground;
    double tilt_rad;
} naza_inputs_t;

typedef struct {
    naza_config_t config;
    bool running;               /* the motors */
    bool opened;                /* the throttle was over 10 % since the start */
    bool held;                  /* the stick command acts once */
    double started_s, closed_s; /* since the start; since the throttle went under 10 % */
    double stopped_s;           /* since the throttle stopped them */
    bool stopped_by_throttle;
    double silent_s; /* without pulses */
} naza_t;

void naza_init(naza_t *naza, const naza_config_t *config);
void naza_step(naza_t *naza, const naza_inputs_t *in, double dt_s);

/* Manual, as the rules have it. */
bool naza_is_manual(const naza_t *naza, bool manual);
/* The receiver is lost: the climb rate that the autopilot wants by itself, m/s. */
bool naza_failsafe(const naza_t *naza, double *climb_mps);

#endif
