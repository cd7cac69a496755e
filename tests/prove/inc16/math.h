#ifndef PROVE_MATH_H
#define PROVE_MATH_H
#define NAN (0.0F / 0.0F)
#define isnan(value) ((value) != (value))
float fabsf(float value);
float floorf(float value);
float fminf(float one, float other);
float fmaxf(float one, float other);
float ldexpf(float value, int exponent);
float frexpf(float value, int *exponent);
#endif
