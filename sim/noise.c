#include "sim/noise.h"

#include <stdbool.h>

/* Only integer arithmetic and IEEE additions, products and divisions: no library function whose last digit
 * depends on the machine. */

void noise_init(noise_t *noise, uint64_t seed, const char *name)
{
    uint64_t hash = 0xCBF29CE484222325u; /* FNV-1a */

    for (; *name != '\0'; name++) {
        hash = (hash ^ (unsigned char)*name) * 0x100000001B3u;
    }
    noise->state = seed;
    noise->state = noise_bits(noise) ^ hash;
    noise->state = noise_bits(noise);
}

/* SplitMix64 (Steele, Lea, Flood 2014). */
uint64_t noise_bits(noise_t *noise)
{
    uint64_t z = noise->state += 0x9E3779B97F4A7C15u;

    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

static double unit(noise_t *noise)
{
    return (double)(noise_bits(noise) >> 11) * 0x1p-53;
}

double noise_uniform(noise_t *noise, double low, double high)
{
    return low + (high - low) * unit(noise);
}

/* True with probability exp(-p), 0 <= p <= 1: the run p > u1 > u2 > ... has even length (von Neumann 1951).
 */
static bool chance_exp(noise_t *noise, double p)
{
    bool even = true;

    for (double last = p;;) {
        double u = unit(noise);

        if (u >= last) {
            return even;
        }
        last = u;
        even = !even;
    }
}

static bool chances_exp(noise_t *noise, double p, int trials)
{
    while (trials > 0 && chance_exp(noise, p)) {
        trials--;
    }
    return trials == 0;
}

/* Exact rejection from the half normal, by whole part k and fraction x (Karney 2016, algorithm N). */
double noise_gauss(noise_t *noise)
{
    for (;;) {
        int k = 0;

        while (chance_exp(noise, 0.5)) {
            k++;
        }
        if (!chances_exp(noise, 0.5, k * (k - 1))) {
            continue;
        }
        double x = unit(noise);

        if (chances_exp(noise, x * (2 * k + x) / (2 * k + 2), k + 1)) {
            return (noise_bits(noise) >> 63) != 0 ? -(k + x) : k + x;
        }
    }
}
