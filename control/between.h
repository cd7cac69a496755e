/* Limits of a value. Pure. */
#ifndef CONTROL_BETWEEN_H
#define CONTROL_BETWEEN_H

/* Used instead of fmaxf() and fminf(): those are calls that handle NaN with care, and law EST needs about a
 * hundred limits in each cycle. These are one comparison each. A NaN in `value` gives the limit. */
static inline float at_least(float value, float lowest)
{
    return (value > lowest) ? value : lowest;
}

static inline float at_most(float value, float highest)
{
    return (value < highest) ? value : highest;
}

/* Limits value to lowest .. highest. NaN gives lowest. If highest < lowest, the result is highest. */
static inline float between(float lowest, float value, float highest)
{
    return at_most(at_least(value, lowest), highest);
}

#endif
