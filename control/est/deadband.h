/* Dead band of the throttle. An autopilot that commands the climb rate holds its height in the middle of
 * the stick. There a command has no effect when it is within band_n of the neutral command. Outside, the
 * effect is smaller than the command by band_n. The width of the band is learned in flight.
 *
 * Newtons per motor. neutral_n is the command in the middle of the stick. Pure; the caller owns the state. */
#ifndef CONTROL_DEADBAND_H
#define CONTROL_DEADBAND_H

typedef struct {
    float band_n; /* half the width of the band, >= 0 */
} deadband_t;

void deadband_init(deadband_t *deadband);

/* Inverse of deadband_effect(). effect_n: the command that would be right without a band. Returns the
 * command to give. Near neutral_n it changes steeply, but it does not jump. */
float deadband_compensate(const deadband_t *deadband, float neutral_n, float effect_n);
/* Effect of a command. Returns the command that would have the same effect if there were no band:
 * command_n without the band's width, or neutral_n inside the band. */
float deadband_effect(const deadband_t *deadband, float neutral_n, float command_n);

/* One sample, dt_s > 0 after the one before. off_n: the effect that was commanded, relative to neutral_n.
 * missing_n: the part of it that the motion did not show. With the sign of off_n it widens the band, with
 * the other sign it makes the band narrower. */
void deadband_learn(deadband_t *deadband, float off_n, float missing_n, float dt_s);

#endif
