#include "sim/noise.h"

#include <math.h>
#include <stdbool.h>

#define PARTS 0x1p53
#define HALF (UINT64_C(1) << 52)

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

/* In parts of PARTS. */
static uint64_t part(noise_t *noise)
{
    return noise_bits(noise) >> 11;
}

static double unit(noise_t *noise)
{
    return (double)part(noise) / PARTS;
}

double noise_uniform(noise_t *noise, double low, double high)
{
    return low + (high - low) * unit(noise);
}

/* True with probability exp(-p), 0 <= p <= 1, in parts, rounded up: the run p > u1 > u2 > ... has even length
 * (von Neumann 1951). */
static bool chance_exp(noise_t *noise, uint64_t p)
{
    bool even = true;

    for (uint64_t last = p;;) {
        const uint64_t u = part(noise);

        if (u >= last) {
            return even;
        }
        last = u;
        even = !even;
    }
}

static bool chances_exp(noise_t *noise, uint64_t p, int trials)
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

        while (chance_exp(noise, HALF)) {
            k++;
        }
        if (!chances_exp(noise, HALF, k * (k - 1))) {
            continue;
        }
        double x = unit(noise);

        if (chances_exp(noise, (uint64_t)ceil(x * (2 * k + x) / (2 * k + 2) * PARTS), k + 1)) {
            return (noise_bits(noise) >> 63) != 0 ? -(k + x) : k + x;
        }
    }
}
