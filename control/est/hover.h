/* The thrust that carries the vehicle, and the gusts on top of it, both found from the thrust delivered and the
 * acceleration felt: what the former exceeds the latter's need by. One state with a variance for the hover thrust
 * (mass, battery: slow; quick at first), one with a fixed gain for the gusts. Newtons per motor. Pure; the caller owns
 * the state. */
#ifndef CONTROL_HOVER_H
#define CONTROL_HOVER_H

typedef struct {
    float thrust_n;
    float variance_n2;
    float gust_n;           /* more thrust than thrust_n is needed at the moment, 0 in the long run */
    float least_n, most_n;  /* bounds of thrust_n */
} hover_t;

/* sigma_n: how wrong thrust_n may be. */
void hover_init(hover_t *hover, float thrust_n, float sigma_n, float least_n, float most_n);

/* One sample: seen_n, the delivered thrust less what the acceleration took of it; noise_n its rms noise, > 0. */
void hover_step(hover_t *hover, float seen_n, float noise_n, float dt_s);

/* More (or less) thrust is needed than thought: the height tells. */
void hover_nudge(hover_t *hover, float more_n);

#endif
