/* Hover thrust and gust thrust. The hover thrust is the thrust that holds the vehicle in calm air. The
 * gust thrust is what is needed on top of it at the moment. Both are estimated from one sample: the
 * delivered thrust, less the thrust that the measured acceleration needed.
 *
 * The hover thrust follows mass and battery: quick at first, then slow. It is one state with a variance.
 * The gust thrust has a fixed gain. All thrusts are in newtons per motor. Pure; the caller owns the state. */
#ifndef CONTROL_HOVER_H
#define CONTROL_HOVER_H

typedef struct {
    float thrust_n;
    float variance_n2;
    float gust_n;          /* needed on top of thrust_n; > 0: more thrust. Its mean is 0 in the long run */
    float least_n, most_n; /* limits of thrust_n */
} hover_t;

/* Starts at thrust_n, limited to least_n .. most_n. sigma_n is its standard deviation, >= 0. */
void hover_init(hover_t *hover, float thrust_n, float sigma_n, float least_n, float most_n);

/* One sample, dt_s > 0 after the one before. seen_n: the delivered thrust, less the thrust that the
 * acceleration needed. noise_n: rms noise of seen_n, > 0. */
void hover_step(hover_t *hover, float seen_n, float noise_n, float dt_s);

/* Without a sample: the gust ends as gusts do, dt_s later. */
void hover_fade_gust(hover_t *hover, float dt_s);

/* Adds more_n to the estimate. The caller has seen from the height that more thrust is needed (more_n >
 * 0), or less thrust (more_n < 0). */
void hover_nudge(hover_t *hover, float more_n);

#endif
