/* siso.h: linear equations from one input to one output, and their resolvent
 *
 *     x' = A x + b u,   y = c x + d u
 *
 * Matrices stand row by row. */
#ifndef COTREE_SIMULATE_ANALYSE_SISO_H
#define COTREE_SIMULATE_ANALYSE_SISO_H

#include "algebra/double_double.h"
#include "simulate/analyse/linear_equations.h"

typedef struct Siso {
    int n;
    double *a, *b, *c; /* n x n, n, n */
    double d;
    double *a_error, *b_error, *c_error; /* how far each may be off */
    double d_error;
} Siso;

/* The states that the input moves and the output sees, by the entries that aren't 0, scaled by
 * powers of 2 so that input, states and output balance. Free with siso_free(). */
Siso siso_new(const Linear *linear, int output, int input);
void siso_free(Siso *single);

/* c (s - A)^-1 b at one s after another, with A as a Hessenberg matrix (Laub 1981). */
typedef struct Resolvent Resolvent;
Resolvent *resolvent_new(const DoubleDouble *a, const DoubleDouble *b, const DoubleDouble *c,
                         int n);           /* new; O(n^3) */
void resolvent_free(Resolvent *resolvent); /* NULL is fine */
/* From now on at s; false: s is an eigenvalue, and the least that tells it from s stands in for 0.
 * O(n^2) */
bool resolvent_at(Resolvent *resolvent, DoubleDoubleComplex s);
/* c (s - A)^-1 b; then, if it is wanted, its derivative by s. O(n^2) */
DoubleDoubleComplex resolvent_value(Resolvent *resolvent);
DoubleDoubleComplex resolvent_slope(Resolvent *resolvent);
/* behind both: x = (s - A)^-1 b and y = (s - A)^-T c, to a double's rounding; O(n^2) */
void resolvent_vectors(const Resolvent *resolvent, double complex *x, double complex *y);

#endif
