/* A witness tells the vertical speed by dead reckoning, from the accelerometer or from the thrust. Its
 * innovation is the measured change of the height minus the change that this speed predicts. The innovation
 * is summed up in a leaky integrator: a wrong sensor contradicts the others for seconds, and noise does not.
 * The leak also forgets the slow errors of a witness: bias, wrong hover thrust, wrong damping.
 *
 * Metres and seconds, upwards. Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_SENSE_WITNESS_H
#define CONTROL_SENSE_WITNESS_H

#include <stdbool.h>

#define WITNESS_OLD_S 2.0F /* chosen: full leak and correction after that time; running_s stops here */
/* A change in one scan: more than the estimate takes for a height, INNOVATION_LIMIT_MAX_M in roughness.h, and
 * three sigma of it: 99 mm. */
#define WITNESS_STEP_M 0.10F

typedef struct {
    float speed_mps; /* predicted vertical speed */
    float off_m;     /* leaky sum of the innovations: measured minus predicted change of the height */
    float seen_m;    /* off_m at the instant when the rays of the latest height were taken */
    float running_s; /* time since its start, at most WITNESS_OLD_S */
} witness_t;

/* Starts at a known speed, with empty sums. */
void witness_start(witness_t *witness, float speed_mps);

/* Dead reckoning over one step of dt_s. */
void witness_move(witness_t *witness, float mps2, float dt_s);

/* Adds one innovation to the leaky sum. rise_m: measured change of the height in gap_s. The height is age_s
 * old and the prediction is not, so seen_m leaves out the way predicted since then. pull_per_s2 > 0: the sum
 * corrects the speed. */
void witness_compare(witness_t *witness, float rise_m, float gap_s, float age_s, float leak_per_s,
                     float pull_per_s2);

/* Clears the sums. */
void witness_forget(witness_t *witness);

/* A witness is valid after its first 0.5 s. */
bool witness_counts(const witness_t *witness);

/* True when this witness explains the change of the height: then the change is no step of the terrain. */
bool witness_follows(const witness_t *witness, float rise_m, float gap_s);

#endif
