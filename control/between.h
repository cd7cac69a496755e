/* Limits of a value. Pure. */
#ifndef CONTROL_BETWEEN_H
#define CONTROL_BETWEEN_H

/* fmaxf() and fminf() of the library are calls with a care for NaN that is not needed here: these are one
 * comparison, and there are a hundred of them in a cycle of law EST. A NaN in `value` gives the limit. */
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
