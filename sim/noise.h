/* Seeded random numbers, one independent stream per source of noise, so that a change in one model leaves the
 * draws of the others alone. Same seed, same numbers on every machine. */
#ifndef SIM_NOISE_H
#define SIM_NOISE_H

#include <stdint.h>

typedef struct {
    uint64_t state;
} noise_t;

/* `name` tells the streams of one seed apart. */
void noise_init(noise_t *noise, uint64_t seed, const char *name);
uint64_t noise_bits(noise_t *noise);
double noise_uniform(noise_t *noise, double low, double high);
double noise_gauss(noise_t *noise); /* mean 0, deviation 1 */

#endif
