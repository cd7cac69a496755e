/* The middle of the stick, where an autopilot that commands the climb rate holds its height: a command within band_n of
 * the neutral one has no effect, and one beyond it lacks band_n. The band is found in flight. Newtons per motor. Pure; the
 * caller owns the state. */
#ifndef CONTROL_DEADBAND_H
#define CONTROL_DEADBAND_H

typedef struct {
    float band_n;           /* to either side of neutral, >= 0 */
} deadband_t;

void deadband_init(deadband_t *deadband);

/* Command for the effect of one without a band. Near neutral it grows steeply instead of jumping. */
float deadband_compensate(const deadband_t *deadband, float neutral_n, float effect_n);
/* The command without a band that has the effect of command_n. */
float deadband_effect(const deadband_t *deadband, float neutral_n, float command_n);

/* One sample: while off_n from neutral should have an effect, missing_n (same sign) of it did not. */
void deadband_learn(deadband_t *deadband, float off_n, float missing_n, float dt_s);

#endif
