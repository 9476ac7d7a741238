/* elementary.h: sine, cosine, exponential and logarithm, the same on every machine
 *
 * Only sums and products, each rounded: the result is the same in SIMD batches of two, four or
 * eight, and on any processor. Errors are within one unit in the last place over the whole range,
 * with angles of many turns and subnormal numbers. Infinities and NaN are as in C. */
#ifndef COTREE_ALGEBRA_ELEMENTARY_H
#define COTREE_ALGEBRA_ELEMENTARY_H

#include <stdbool.h>

double elementary_sin(double x);
double elementary_cos(double x);
double elementary_exp(double x);
double elementary_log(double x);

/* many at once, `count` of them; results are not where arguments are */
void elementary_sincos_all(const double *x, double *sine, double *cosine, int count);
void elementary_exp_all(const double *x, double *out, int count);
void elementary_log_all(const double *x, double *out, int count);
/* Sines and cosines with fused operations, where the processor has them, else the same as above:
 * within a unit in the last place too, in four fifths of the time, but not the same on every
 * machine. */
void elementary_sincos_fused_all(const double *x, double *sine, double *cosine, int count);
bool elementary_has_fused(void);

#endif
